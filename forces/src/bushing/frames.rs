//! A wrench between two frames on rigid bodies or on sections of cables with torsion, with its exact tangent by forward
//! differentiation.

use num_dual::Dual64;
use ropewalk_core::error::need;
use ropewalk_core::held::{find, three};
use ropewalk_core::model::twist;
use ropewalk_core::rotation::{cross, from_matrix, matrix, skew, times, transposed_times};
use ropewalk_core::{Assembly, At, BuildError, Jet, Marker, Node, NodeKind, V3, dot};

/// Most unknowns that move two frames.
const MOST: usize = 14;

/// A frame fixed in space, on a rigid body, or on the section of a cable with torsion.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Mount {
    /// First coordinate and velocity of the body or the section; none in space.
    body: Option<(usize, usize)>,
    section: bool,
    /// Place and orientation of the frame on the body, or in space.
    point: V3<f64>,
    axes: [f64; 4],
}

/// Two frames between which something acts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Frames([Mount; 2]);

/// Where a frame is and how it moves, all in space.
pub(crate) struct Pose<S> {
    pub x: V3<S>,
    pub v: V3<S>,
    /// Angular velocity of its body.
    pub omega: V3<S>,
    /// Orientation of the frame.
    pub axes: [S; 4],
    /// Its body's own point.
    centre: V3<S>,
    turns: Turns<S>,
}

/// How a moment is seen by the unknowns that turn a frame.
enum Turns<S> {
    /// In the axes of a body with this orientation.
    Body([S; 4]),
    /// By the slope and the spin of a section with this slope.
    Section(V3<S>),
}

impl<S: Jet> Turns<S> {
    /// Generalised forces of a moment in space; the fourth is that on a spin.
    fn carry(&self, moment: &V3<S>) -> [S; 4] {
        match self {
            Turns::Body(q) => {
                let [x, y, z] = transposed_times(&matrix(q), moment);
                [x, y, z, S::zero()]
            }
            Turns::Section(p) => {
                let inverse = (p[0] * p[0] + p[1] * p[1] + p[2] * p[2]).sqrt().recip();
                let t = p.map(|p| p * inverse);
                let [x, y, z] = cross(moment, &t).map(|x| x * inverse);
                [x, y, z, moment[0] * t[0] + moment[1] * t[1] + moment[2] * t[2]]
            }
        }
    }
}

/// A law that says what acts on the second frame.
pub(crate) trait Wrench {
    /// Force at the second frame's point [N] and moment [N m] on its body, in space. The first body feels the opposite
    /// at the same point.
    fn wrench<S: Jet>(&self, pose: &[Pose<S>; 2]) -> (V3<S>, V3<S>);
}

pub(crate) fn quaternion_product<S: Jet>(a: &[S; 4], b: &[S; 4]) -> [S; 4] {
    [
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
        a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
        a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
    ]
}

impl Mount {
    fn new(nodes: &[Node], marker: &Marker, what: &str) -> Result<Self, BuildError> {
        // rows of axes are the axes: the columns of the matrix that turns the frame into space
        let turned =
            |axes: &[V3<f64>; 3]| from_matrix(&std::array::from_fn(|i| std::array::from_fn(|j| axes[j][i])));
        match marker {
            Marker::Ground { point, axes } => {
                Ok(Mount { body: None, section: false, point: *point, axes: turned(axes) })
            }
            Marker::Node { node, point, axes } => {
                let n = find(nodes, *node, what)?;
                need(n.kind.turns(), || {
                    format!(
                        "{what}: it needs rigid bodies, cables with torsion (`section.gj`) or points in space, which have \
                         axes; use a `spring` on others"
                    )
                })?;
                let section = n.kind == NodeKind::Twist;
                Ok(Mount { body: Some((n.q, n.v)), section, point: *point, axes: turned(axes) })
            }
        }
    }

    /// After the increment `d` of its body, with the velocities `v`.
    fn pose<S: Jet>(&self, q: &[f64], d: impl Fn(usize) -> S, v: impl Fn(usize) -> S) -> Pose<S> {
        let zero = [S::zero(); 3];
        let of = |x: &V3<f64>| x.map(S::from);
        let Some((at, _)) = self.body else {
            let axes = self.axes.map(S::from);
            let one = [S::one(), S::zero(), S::zero(), S::zero()];
            let turns = Turns::Body(one);
            return Pose { x: of(&self.point), v: zero, omega: zero, axes, centre: zero, turns };
        };
        if self.section {
            return self.on_section(&q[at..], d, v);
        }
        let quaternion = [q[at + 3], q[at + 4], q[at + 5], q[at + 6]].map(S::from);
        // to first order, all that a first derivative needs
        let turn = [S::one(), d(3) * 0.5, d(4) * 0.5, d(5) * 0.5];
        let body = quaternion_product(&quaternion, &turn);
        let r = matrix(&body);
        let centre: V3<S> = std::array::from_fn(|i| d(i) + q[at + i]);
        let (arm, spin) = (of(&self.point), [v(3), v(4), v(5)]);
        let (out, swing) = (times(&r, &arm), times(&r, &cross(&spin, &arm)));
        Pose {
            x: std::array::from_fn(|i| centre[i] + out[i]),
            v: std::array::from_fn(|i| v(i) + swing[i]),
            omega: times(&r, &spin),
            axes: quaternion_product(&body, &self.axes.map(S::from)),
            centre,
            turns: Turns::Body(body),
        }
    }

    /// The same on the section of a node with the coordinates `q`.
    fn on_section<S: Jet>(&self, q: &[f64], d: impl Fn(usize) -> S, v: impl Fn(usize) -> S) -> Pose<S> {
        let (p, r) = (three(q, 3), twist::section(q));
        let inverse = dot(&p, &p).sqrt().recip();
        let t = p.map(|p| S::from(inverse * p));
        // to first order: the smallest rotation of the tangent and the spin about it
        let side = cross(&t, &[d(3), d(4), d(5)]);
        let turn: V3<S> = std::array::from_fn(|i| side[i] * inverse + t[i] * d(6));
        let half = turn.map(|x| x * 0.5);
        let body = quaternion_product(&[S::one(), half[0], half[1], half[2]], &from_matrix(&r).map(S::from));
        let moved = |i: usize| d(i) + q[i];
        let slope = [moved(3), moved(4), moved(5)];
        let size = (slope[0] * slope[0] + slope[1] * slope[1] + slope[2] * slope[2]).sqrt();
        let tangent = slope.map(|p| p / size);
        let swing = cross(&tangent, &[v(3), v(4), v(5)]);
        let omega: V3<S> = std::array::from_fn(|i| swing[i] / size + tangent[i] * v(6));
        let centre = [moved(0), moved(1), moved(2)];
        let out = times(&matrix(&body), &self.point.map(S::from));
        let around = cross(&omega, &out);
        Pose {
            x: std::array::from_fn(|i| centre[i] + out[i]),
            v: std::array::from_fn(|i| v(i) + around[i]),
            omega,
            axes: quaternion_product(&body, &self.axes.map(S::from)),
            centre,
            turns: Turns::Section(slope),
        }
    }

    /// How many unknowns move it.
    fn size(&self) -> usize {
        match (self.body, self.section) {
            (None, _) => 0,
            (_, false) => 6,
            (_, true) => 7,
        }
    }
}

impl Frames {
    /// The frames of two markers.
    pub(crate) fn new(nodes: &[Node], between: &[Marker; 2], what: &str) -> Result<Self, BuildError> {
        let [a, b] = between;
        need(a.on() != b.on(), || {
            format!("{what}: its ends must be on two different bodies, or one in space")
        })?;
        Ok(Frames([Mount::new(nodes, a, what)?, Mount::new(nodes, b, what)?]))
    }

    /// The unknowns that it acts on.
    pub(crate) fn dofs(&self) -> impl Iterator<Item = usize> + '_ {
        self.0.iter().filter_map(|m| m.body.map(|(_, v)| v..v + m.size())).flatten()
    }

    fn poses<S: Jet>(&self, at: &At<'_>, d: impl Fn(usize) -> S, v: impl Fn(usize) -> S) -> [Pose<S>; 2] {
        let second = self.0[0].size();
        let first = self.0[0].pose(at.q, &d, &v);
        [first, self.0[1].pose(at.q, |i| d(second + i), |i| v(second + i))]
    }

    /// Where they are now.
    pub(crate) fn now(&self, at: &At<'_>) -> [Pose<f64>; 2] {
        let dofs: Vec<usize> = self.dofs().collect();
        self.poses(at, |_| 0.0, |i| at.v[dofs[i]])
    }

    /// The residual of all unknowns: minus the generalised force.
    fn residual<S: Jet>(
        &self,
        law: &impl Wrench,
        at: &At<'_>,
        d: impl Fn(usize) -> S,
        v: impl Fn(usize) -> S,
        out: &mut [S; MOST],
    ) {
        let pose = self.poses(at, d, v);
        let (force, moment) = law.wrench(&pose);
        let mut row = 0;
        for (k, (mount, pose_k)) in self.0.iter().zip(&pose).enumerate() {
            if mount.body.is_none() {
                continue;
            }
            let sign = if k == 0 { 1.0 } else { -1.0 };
            // the force acts at the second point, on both
            let arm = std::array::from_fn(|i| pose[1].x[i] - pose_k.centre[i]);
            let lever = cross(&arm, &force);
            let whole = std::array::from_fn(|i| moment[i] + lever[i]);
            let own = pose_k.turns.carry(&whole);
            for i in 0..mount.size() {
                out[row + i] = if i < 3 { force[i] } else { own[i - 3] } * sign;
            }
            row += mount.size();
        }
    }

    /// Adds a law to the equations, with its tangent, which is that of clique 0.
    pub(crate) fn add(&self, law: &impl Wrench, at: &At<'_>, out: &mut Assembly<'_>) {
        let dofs: Vec<usize> = self.dofs().collect();
        let n = dofs.len();
        let mut values = [0.0; MOST];
        self.residual(law, at, |_| 0.0, |i| at.v[dofs[i]], &mut values);
        for (dof, r) in dofs.iter().zip(values) {
            out.add(*dof, r);
        }
        if !out.wants_tangent() {
            return;
        }
        let w = out.weights();
        let mut block = [[0.0; MOST]; MOST];
        let mut column = [Dual64::from(0.0); MOST];
        for j in 0..n {
            let one = |i: usize| if i == j { 1.0 } else { 0.0 };
            let d = |i: usize| Dual64::new(0.0, w.q * one(i));
            self.residual(law, at, d, |i| Dual64::new(at.v[dofs[i]], w.v * one(i)), &mut column);
            for i in 0..n {
                block[i][j] = column[i].eps;
            }
        }
        let mut first = 0;
        for mount in &self.0 {
            if let (Some((q, _)), true) = (mount.body, mount.section) {
                // what all tangents leave out: half of the torque times the tangent
                let p = three(at.q, q + 3);
                let square = dot(&p, &p);
                let half = 0.5 * w.q * values[first + 6] / (square * square.sqrt());
                let cut = skew(&p.map(|p| half * p));
                for i in 0..3 {
                    for j in 0..3 {
                        block[first + 3 + i][first + 3 + j] -= cut[i][j];
                    }
                }
            }
            first += mount.size();
        }
        out.add_block(0, n, |i, j| block[i][j]);
    }
}

/// The orientation of the second frame seen from the first.
pub(crate) fn between<S: Jet>(pose: &[Pose<S>; 2]) -> [S; 4] {
    let a = &pose[0].axes;
    quaternion_product(&[a[0], -a[1], -a[2], -a[3]], &pose[1].axes)
}
