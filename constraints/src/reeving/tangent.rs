//! The point at which a cable meets or leaves a wheel.

use num_dual::Dual2_64;
use ropewalk_core::rotation::{IDENTITY, M3, cross, matrix, product, skew, times, transposed_times};
use ropewalk_core::{
    At, Constraint, Jet, Marker, Node, NodeId, NodeKind, Place, Related, Relation, RowKind, V3, dot,
};

/// The end of a span lies in the groove and is tangent to it: with `d = r - c` and the slope `s`, `a·d = 0`, `|d| = R` (of
/// the part normal to the axis) and `d·s = 0`.
///
/// The first marker is the end of the cable; the third axis of the second is that of the wheel. The cable may leave the
/// plane of the wheel: there is no equation for its fleet angle. No angle is an unknown.
#[derive(Clone, Copy, Debug)]
pub struct Tangent {
    /// Radius to the middle of the cable [m].
    pub radius: f64,
}

impl Relation for Tangent {
    fn rows(&self) -> Vec<RowKind> {
        vec![RowKind::Position, RowKind::Position, RowKind::Direction]
    }
    fn g<S: Jet>(&self, _t: S, at: &[Place<S>], g: &mut [S]) {
        let ([end, wheel], slope) = ([&at[0], &at[1]], &at[0].axes[0]);
        let axis = &wheel.axes[2];
        let d: [S; 3] = std::array::from_fn(|i| end.x[i] - wheel.x[i]);
        let along = |a: &[S; 3], b: &[S; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        g[0] = along(axis, &d);
        let flat: [S; 3] = std::array::from_fn(|i| d[i] - axis[i] * g[0]);
        g[1] = along(&flat, &flat).sqrt() - self.radius;
        g[2] = along(&d, slope) / self.radius;
    }
}

/// The end of a cable as relations here want it: its first axis lies along the cable, of one with torsion as a unit vector, and
/// the others are then the two directors of its section.
pub(super) fn end(nodes: &[Node], id: NodeId) -> Marker {
    match nodes[id.0 as usize].kind {
        NodeKind::Twist => Marker::Node {
            node: id,
            point: [0.0; 3],
            axes: [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        },
        _ => Marker::node(id),
    }
}

/// [`Tangent`] with its derivatives in closed form. The spin of a cable with torsion has no part in it.
///
/// In the axes of what carries the wheel, with its rotation `A`: `y = Aᵀ(r - o)` from its origin, `u = y - arm` from the
/// centre of the wheel, `σ = Aᵀ s`. A small rotation `θ` in these axes makes `(1 - [θ] + ½[θ]²) y` of `y`.
pub struct Tangency {
    inner: Related<Tangent>,
    end: NodeId,
    wheel: Marker,
    radius: f64,
}

/// What its derivatives are made of.
struct Local {
    /// Rotation and axis of the wheel.
    turn: M3,
    axis: V3<f64>,
    /// Of the cable's end, see [`Tangency`].
    y: V3<f64>,
    u: V3<f64>,
    sigma: V3<f64>,
    /// Direction from the axis to the end, and the distance [m].
    e: V3<f64>,
    rho: f64,
}

/// First columns of the end, of what carries the wheel, and their number; what carries it may turn or not.
struct Columns {
    end: usize,
    wheel: Option<(usize, bool)>,
    all: usize,
}

impl Tangency {
    /// Of the end of a cable on a wheel of this radius [m].
    pub fn new(name: impl Into<String>, end: NodeId, wheel: Marker, radius: f64) -> Self {
        let inner = Related::new(name, Tangent { radius }, vec![Marker::node(end), wheel]);
        Tangency { inner, end, wheel, radius }
    }

    fn local(&self, nodes: &[Node], at: &At<'_>) -> Local {
        let q = &at.q[nodes[self.end.0 as usize].coords()];
        let (origin, turn, arm, axis) = match self.wheel {
            Marker::Ground { point, axes } => (point, IDENTITY, [0.0; 3], axes[2]),
            Marker::Node { node, point, axes } => {
                let node = &nodes[node.0 as usize];
                let own = &at.q[node.coords()];
                let (turn, arm) = match node.kind {
                    NodeKind::Frame => (matrix(&[own[3], own[4], own[5], own[6]]), point),
                    _ => (IDENTITY, [0.0; 3]),
                };
                ([own[0], own[1], own[2]], turn, arm, axes[2])
            }
        };
        let y = transposed_times(&turn, &std::array::from_fn(|i| q[i] - origin[i]));
        let u: V3<f64> = std::array::from_fn(|i| y[i] - arm[i]);
        let beside = dot(&axis, &u);
        let flat: V3<f64> = std::array::from_fn(|i| u[i] - axis[i] * beside);
        let rho = dot(&flat, &flat).sqrt();
        let sigma = transposed_times(&turn, &[q[3], q[4], q[5]]);
        Local { turn, axis, y, u, sigma, e: flat.map(|x| x / rho), rho }
    }

    fn columns(&self, nodes: &[Node]) -> Columns {
        let size = |k: &NodeId| nodes[k.0 as usize].kind.velocities();
        let first = |k: NodeId| self.inner.nodes().iter().take_while(|n| **n != k).map(size).sum::<usize>();
        let turns = |k: NodeId| nodes[k.0 as usize].kind == NodeKind::Frame;
        let wheel = self.wheel.on().map(|k| (first(k), turns(k)));
        Columns { end: first(self.end), wheel, all: self.inner.nodes().iter().map(size).sum() }
    }
}

fn transposed(a: &M3) -> M3 {
    std::array::from_fn(|i| std::array::from_fn(|j| a[j][i]))
}

impl Constraint for Tangency {
    fn name(&self) -> &str {
        self.inner.name()
    }
    fn rows(&self) -> &[RowKind] {
        self.inner.rows()
    }
    fn markers(&self) -> &[Marker] {
        self.inner.markers()
    }
    fn nodes(&self) -> &[NodeId] {
        self.inner.nodes()
    }
    fn linear(&self) -> bool {
        false
    }
    fn is_steady(&self) -> bool {
        true
    }

    fn jacobian(&self, nodes: &[Node], at: &At<'_>, g: &mut [f64], jac: &mut [f64]) {
        let Local { turn, axis, y, u, sigma, e, rho } = self.local(nodes, at);
        let Columns { end, wheel, all } = self.columns(nodes);
        let r = self.radius;
        (g[0], g[1], g[2]) = (dot(&axis, &u), rho - r, dot(&u, &sigma) / r);
        jac.fill(0.0);
        // by the place, by the slope, by the rotation
        let lean = cross(&u, &sigma);
        let twist: V3<f64> = std::array::from_fn(|i| (cross(&sigma, &y)[i] + lean[i]) / r);
        let none = [0.0; 3];
        let rows = [
            (axis, none, cross(&axis, &y)),
            (e, none, cross(&e, &y)),
            (sigma.map(|x| x / r), u.map(|x| x / r), twist),
        ];
        for (row, (place, slope, rotation)) in jac.chunks_exact_mut(all).zip(rows) {
            let [place, slope] = [place, slope].map(|x| times(&turn, &x));
            row[end..end + 3].copy_from_slice(&place);
            row[end + 3..end + 6].copy_from_slice(&slope);
            if let Some((first, turns)) = wheel {
                row[first..first + 3].copy_from_slice(&place.map(|x| -x));
                if turns {
                    row[first + 3..first + 6].copy_from_slice(&rotation);
                }
            }
        }
    }

    fn geometric(&self, nodes: &[Node], at: &At<'_>, lambda: &[f64], h: &mut [f64]) {
        let Local { turn, axis, y, u, sigma, e, rho } = self.local(nodes, at);
        let Columns { end, wheel, all } = self.columns(nodes);
        let k = lambda[2] / self.radius;
        // derivatives of Σ λ g by u and by σ, and the second one by u; that by both is k
        let p: V3<f64> = std::array::from_fn(|i| lambda[0] * axis[i] + lambda[1] * e[i] + k * sigma[i]);
        let r = u.map(|x| k * x);
        let bend: M3 = std::array::from_fn(|i| {
            std::array::from_fn(|j| (IDENTITY[i][j] - axis[i] * axis[j] - e[i] * e[j]) * lambda[1] / rho)
        });
        h.fill(0.0);
        let mut put = |row: usize, column: usize, block: &M3| {
            for i in 0..3 {
                for j in 0..3 {
                    h[(row + i) * all + column + j] += block[i][j];
                }
            }
        };
        let mut both = |row: usize, column: usize, block: &M3| {
            put(row, column, block);
            put(column, row, &transposed(block));
        };
        let place = product(&product(&turn, &bend), &transposed(&turn));
        let slope = IDENTITY.map(|row| row.map(|x| k * x));
        both(end, end + 3, &slope);
        let Some((first, turns)) = wheel else {
            put(end, end, &place);
            return;
        };
        let minus = |a: &M3| a.map(|row| row.map(|x| -x));
        both(first, end + 3, &minus(&slope));
        both(end, first, &minus(&place));
        if turns {
            let (by_y, by_sigma) = (skew(&y), skew(&sigma));
            let [by_p, by_r] = [skew(&p), skew(&r)];
            let bent = product(&bend, &by_y);
            let moves = std::array::from_fn(|i| {
                std::array::from_fn(|j| bent[i][j] + k * by_sigma[i][j] - by_p[i][j])
            });
            let leans = std::array::from_fn(|i| std::array::from_fn(|j| k * by_y[i][j] - by_r[i][j]));
            let moves = product(&turn, &moves);
            both(end, first + 3, &moves);
            both(first, first + 3, &minus(&moves));
            both(end + 3, first + 3, &product(&turn, &leans));
            // of the rotation twice, and half of what the order of two rotations makes
            let [rigid, mixed] = [product(&transposed(&by_y), &bent), product(&transposed(&by_y), &by_sigma)];
            let slope: V3<f64> = std::array::from_fn(|i| cross(&p, &y)[i] + cross(&r, &sigma)[i]);
            let (order, trace) = (skew(&slope), dot(&p, &y) + dot(&r, &sigma));
            let spins = std::array::from_fn(|i| {
                std::array::from_fn(|j| {
                    let pairs = p[i] * y[j] + y[i] * p[j] + r[i] * sigma[j] + sigma[i] * r[j];
                    let twice = 0.5 * pairs - trace * IDENTITY[i][j];
                    rigid[i][j] + k * (mixed[i][j] + mixed[j][i]) + twice + 0.5 * order[i][j]
                })
            });
            put(first + 3, first + 3, &spins);
        }
        put(end, end, &place);
        put(first, first, &place);
    }

    fn rates(&self, nodes: &[Node], at: &At<'_>, rate: &mut [f64], bias: &mut [f64]) {
        let own = &nodes[self.end.0 as usize];
        if own.kind == NodeKind::Slope {
            return self.inner.rates(nodes, at, rate, bias);
        }
        // along the path that goes on with the present velocity
        let [x, slope] = [0, 3].map(|first| -> V3<Dual2_64> {
            std::array::from_fn(|i| Dual2_64::new(at.q[own.q + first + i], at.v[own.v + first + i], 0.0))
        });
        let nothing = [Dual2_64::from(0.0); 3];
        let first = self.wheel.on().map_or(0, |k| nodes[k.0 as usize].v);
        let moving = |i: usize| Dual2_64::new(0.0, at.v[first + i], 0.0);
        let wheel = self.wheel.place(nodes, at.q, moving);
        let mut g = nothing;
        self.inner.relation().g(
            Dual2_64::from(at.t),
            &[Place { x, axes: [slope, nothing, nothing] }, wheel],
            &mut g,
        );
        rate.fill(0.0);
        bias.iter_mut().zip(g).for_each(|(bias, g)| *bias = g.v2);
    }
}
