//! The points that terms act on: how they move with their nodes, and how forces on them come back.

use crate::algebra::lane::V3;
use crate::algebra::rotation::{M3, product, skew, times, transposed_times};
use crate::error::{BuildError, need};
use crate::model::lever::Lever;
use crate::model::marker::{Marker, frame};
use crate::model::node::{Node, NodeId, NodeKind};
use crate::model::state::At;
use crate::model::term::Assembly;

pub use crate::algebra::rotation::cross;

/// A point that forces can act on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Held {
    /// Fixed in space at this point.
    Ground(V3<f64>),
    /// Position at coordinate `q` and following, velocity at `v` and following.
    Moves {
        /// Index of its first coordinate.
        q: usize,
        /// Index of its first velocity.
        v: usize,
    },
    /// On a rigid body, beside its node's own point.
    Beside {
        /// Index of the body's first coordinate.
        q: usize,
        /// Index of its first velocity.
        v: usize,
        /// Where it is, in the body's axes [m].
        arm: V3<f64>,
    },
    /// On the section of a cable with torsion, beside its axis.
    Lever {
        /// Index of the first coordinate of its node.
        q: usize,
        /// Index of its first velocity.
        v: usize,
        /// Where it is, in the axes of the section [m].
        arm: V3<f64>,
    },
    /// Between two nodes of a cable: a sum of the vectors `r`, `r'` of both, each with its weight.
    Between {
        /// Index of the first coordinate of each vector.
        q: [usize; 4],
        /// Index of the first velocity of each vector.
        v: [usize; 4],
        /// Values of the shape functions.
        weight: [f64; 4],
    },
}

/// More unknowns than move one point.
pub const MOST: usize = 12;

/// The motion of a [`Held`] point, and what it depends on.
#[derive(Clone, Copy, Debug)]
pub struct Motion {
    /// Position [m].
    pub x: V3<f64>,
    /// Velocity [m/s].
    pub v: V3<f64>,
    /// How many unknowns move it.
    pub n: usize,
    /// Index of each unknown.
    pub dof: [usize; MOST],
    /// `∂x/∂q` (and `∂v/∂v`), by unknown.
    pub by_q: [V3<f64>; MOST],
    /// `∂v/∂q`, by unknown: of a turning body.
    pub v_by_q: [V3<f64>; MOST],
    /// Rotation matrix and arm, on a body.
    body: Option<(M3, V3<f64>)>,
    /// Beside the axis of a cable.
    lever: Option<Lever>,
}

impl Held {
    /// The point of a marker; `what` names the force in messages.
    ///
    /// # Errors
    /// A node that isn't there or has no position.
    pub fn new(nodes: &[Node], marker: &Marker, what: &str) -> Result<Self, BuildError> {
        match *marker {
            Marker::Ground { point, .. } => Ok(Held::Ground(point)),
            Marker::Node { node, point, .. } => {
                let n = find(nodes, node, what)?;
                need(!matches!(n.kind, NodeKind::Scalars(_)), || {
                    format!("{what}: node {} has no position", node.0)
                })?;
                let (q, v, arm) = (n.q, n.v, point);
                Ok(match n.kind {
                    NodeKind::Frame if point != [0.0; 3] => Held::Beside { q, v, arm },
                    NodeKind::Twist if point != [0.0; 3] => Held::Lever { q, v, arm },
                    _ => Held::Moves { q, v },
                })
            }
        }
    }
    /// Its position [m].
    #[inline]
    pub fn x(&self, at: &At<'_>) -> V3<f64> {
        match *self {
            Held::Ground(x) => x,
            Held::Moves { q, .. } => three(at.q, q),
            Held::Beside { q, arm, .. } => sum(three(at.q, q), times(&frame(&at.q[q..]), &arm)),
            Held::Lever { q, arm, .. } => Lever::new(&at.q[q..], &arm).x(),
            Held::Between { q, weight, .. } => blend(at.q, &q, &weight),
        }
    }
    /// Its velocity [m/s].
    #[inline]
    pub fn velocity(&self, at: &At<'_>) -> V3<f64> {
        match *self {
            Held::Ground(_) => [0.0; 3],
            Held::Moves { v, .. } => three(at.v, v),
            Held::Beside { q, v, arm } => {
                let turning = cross(&three(at.v, v + 3), &arm);
                sum(three(at.v, v), times(&frame(&at.q[q..]), &turning))
            }
            Held::Lever { q, v, arm } => {
                sum(three(at.v, v), Lever::new(&at.q[q..], &arm).velocity(&at.v[v..]).0)
            }
            Held::Between { v, weight, .. } => blend(at.v, &v, &weight),
        }
    }
    /// Its acceleration, with all that a tangent needs.
    pub fn acceleration(&self, at: &At<'_>) -> Acceleration {
        let none = [[0.0; 3]; MOST];
        let a = match *self {
            Held::Ground(_) => [0.0; 3],
            Held::Moves { v, .. } | Held::Beside { v, .. } | Held::Lever { v, .. } => three(at.a, v),
            Held::Between { v, weight, .. } => blend(at.a, &v, &weight),
        };
        if let Held::Lever { q, v, arm } = *self {
            let (swing, by) = Lever::new(&at.q[q..], &arm).acceleration(&at.v[v..], &at.a[v..]);
            let [by_v, by_q] = by.map(|by| {
                let mut all = none;
                all[3..7].copy_from_slice(&by);
                all
            });
            return Acceleration { a: sum(a, swing), by_v, by_q };
        }
        let Held::Beside { q, v, arm } = *self else { return Acceleration { a, by_v: none, by_q: none } };
        let (r, omega) = (frame(&at.q[q..]), three(at.v, v + 3));
        let turning = cross(&omega, &arm);
        let swing = sum(cross(&three(at.a, v + 3), &arm), cross(&omega, &turning));
        let (mut by_v, mut by_q) = (none, none);
        for k in 0..3 {
            let e: V3<f64> = std::array::from_fn(|i| delta(i, k));
            by_v[3 + k] = times(&r, &sum(cross(&e, &turning), cross(&omega, &cross(&e, &arm))));
            by_q[3 + k] = times(&r, &cross(&e, &swing));
        }
        Acceleration { a: sum(a, times(&r, &swing)), by_v, by_q }
    }
    /// Number of unknowns that move it.
    #[inline]
    pub fn size(&self) -> usize {
        match self {
            Held::Ground(_) => 0,
            Held::Moves { .. } => 3,
            Held::Beside { .. } => 6,
            Held::Lever { .. } => 7,
            Held::Between { .. } => 12,
        }
    }
    /// Index of the unknown number `k` that moves it.
    #[inline]
    pub fn dof(&self, k: usize) -> usize {
        match *self {
            Held::Ground(_) => usize::MAX,
            Held::Moves { v, .. } | Held::Beside { v, .. } | Held::Lever { v, .. } => v + k,
            Held::Between { v, .. } => v[k / 3] + k % 3,
        }
    }
    /// The unknowns that move it.
    pub fn dofs(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.size()).map(|k| self.dof(k))
    }
    /// Its motion, with all that a tangent needs.
    pub fn motion(&self, at: &At<'_>) -> Motion {
        let none = [[0.0; 3]; MOST];
        let mut m = Motion {
            x: self.x(at),
            v: self.velocity(at),
            n: self.size(),
            dof: [0; MOST],
            by_q: none,
            v_by_q: none,
            body: None,
            lever: None,
        };
        for k in 0..m.n {
            m.dof[k] = self.dof(k);
            m.by_q[k][k % 3] = match self {
                Held::Between { weight, .. } => weight[k / 3],
                _ => 1.0,
            };
        }
        if let Held::Beside { q, v, arm } = *self {
            let r = frame(&at.q[q..]);
            let (turn, swing) =
                (product(&r, &skew(&arm)), product(&r, &skew(&cross(&three(at.v, v + 3), &arm))));
            for k in 0..3 {
                for i in 0..3 {
                    m.by_q[3 + k][i] = -turn[i][k];
                    m.v_by_q[3 + k][i] = -swing[i][k];
                }
            }
            m.body = Some((r, arm));
        }
        if let Held::Lever { q, v, arm } = *self {
            let lever = Lever::new(&at.q[q..], &arm);
            // of slope and spin the unit vectors on the diagonal are none
            m.by_q[3..7].copy_from_slice(&lever.by());
            m.v_by_q[3..7].copy_from_slice(&lever.velocity(&at.v[v..]).1);
            m.lever = Some(lever);
        }
        m
    }
}

/// The acceleration of a [`Held`] point [m/s²]; by accelerations it changes as its velocity does by velocities.
#[derive(Clone, Copy, Debug)]
pub struct Acceleration {
    /// The acceleration.
    pub a: V3<f64>,
    /// `∂a/∂v`, by unknown: of a turning body.
    pub by_v: [V3<f64>; MOST],
    /// `∂a/∂q`, by unknown.
    pub by_q: [V3<f64>; MOST],
}

impl Motion {
    /// The generalised force of a force in space at the point, for its unknown number `k`.
    pub fn carry(&self, k: usize, f: &V3<f64>) -> f64 {
        let j = &self.by_q[k];
        j[0] * f[0] + j[1] * f[1] + j[2] * f[2]
    }
    /// How [`Motion::carry`] of a constant force changes with the orientation of the body: row and column count from
    /// the first of the three rotations. `None` where the way back is constant.
    pub fn turning(&self, f: &V3<f64>) -> Option<M3> {
        self.body.map(|(r, arm)| product(&skew(&arm), &skew(&transposed_times(&r, f))))
    }
    /// The same of what turns in whichever way, with the spin of a section as a fourth row and column: of a lever on a cable
    /// the symmetric second derivative.
    pub fn second(&self, f: &V3<f64>) -> Option<[[f64; 4]; 4]> {
        let padded = |m: M3| {
            let mut all = [[0.0; 4]; 4];
            (0..3).for_each(|i| all[i][..3].copy_from_slice(&m[i]));
            all
        };
        self.lever.map(|lever| lever.second(f)).or_else(|| self.turning(f).map(padded))
    }
}

/// A force at a point, or between two, with its derivatives: by the position of the second relative to the first, and
/// by its velocity.
#[derive(Clone, Copy, Debug, Default)]
pub struct Pull {
    /// Force on the second point; the first gets the opposite [N].
    pub f: V3<f64>,
    /// `∂f/∂(x_1 - x_0)`
    pub by_x: M3,
    /// `∂f/∂(v_1 - v_0)`
    pub by_v: M3,
}

/// The unknowns of two points in the order in which [`pull`] takes them.
pub fn dofs(ends: &[Held; 2]) -> impl Iterator<Item = usize> + '_ {
    ends[0].dofs().chain(ends[1].dofs())
}

/// Adds a force between two points to the residual, and its whole derivative to the block of clique `clique`, which
/// was declared with [`dofs`].
pub fn pull(ends: &[Held; 2], at: &At<'_>, pull: &Pull, clique: usize, out: &mut Assembly<'_>) {
    let m = [ends[0].motion(at), ends[1].motion(at)];
    let signs = [1.0, -1.0];
    for (m, sign) in m.iter().zip(signs) {
        for k in 0..m.n {
            out.add(m.dof[k], sign * m.carry(k, &pull.f));
        }
    }
    if !out.wants_tangent() {
        return;
    }
    let w = out.weights();
    let first = m[0].n;
    // what each unknown changes the force by
    let mut by = [[0.0; 3]; 2 * MOST];
    for (e, (m, sign)) in m.iter().zip(signs).enumerate() {
        for k in 0..m.n {
            let by_x = times(&pull.by_x, &m.by_q[k]);
            let (rate, turn) = (times(&pull.by_v, &m.by_q[k]), times(&pull.by_v, &m.v_by_q[k]));
            by[e * first + k] = std::array::from_fn(|i| -sign * (w.q * (by_x[i] + turn[i]) + w.v * rate[i]));
        }
    }
    let turning = [m[0].second(&pull.f), m[1].second(&pull.f)];
    out.add_block(clique, first + m[1].n, |i, j| {
        let (ei, ki) = if i < first { (0, i) } else { (1, i - first) };
        let mut k = signs[ei] * m[ei].carry(ki, &by[j]);
        if let Some(t) = &turning[ei]
            && ki >= 3
        {
            let kj = if ei == 0 { j } else { j.wrapping_sub(first) };
            if (3..7).contains(&kj) && (ei == 1 || j < first) {
                k += w.q * signs[ei] * t[ki - 3][kj - 3];
            }
        }
        k
    });
}

/// The node of that index.
pub fn find<'a>(nodes: &'a [Node], node: NodeId, what: &str) -> Result<&'a Node, BuildError> {
    nodes.get(node.0 as usize).ok_or_else(|| BuildError::new(format!("{what}: there is no node {}", node.0)))
}

/// Three numbers from an index on.
#[inline(always)]
pub fn three(x: &[f64], from: usize) -> V3<f64> {
    let x = &x[from..from + 3];
    [x[0], x[1], x[2]]
}

fn sum(a: V3<f64>, b: V3<f64>) -> V3<f64> {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

#[inline]
fn blend(x: &[f64], at: &[usize; 4], [w0, w1, w2, w3]: &[f64; 4]) -> V3<f64> {
    let [a, b, c, d] = [three(x, at[0]), three(x, at[1]), three(x, at[2]), three(x, at[3])];
    std::array::from_fn(|i| w0 * a[i] + w1 * b[i] + w2 * c[i] + w3 * d[i])
}

/// 1 on the diagonal, else 0.
pub fn delta(i: usize, j: usize) -> f64 {
    if i == j { 1.0 } else { 0.0 }
}
