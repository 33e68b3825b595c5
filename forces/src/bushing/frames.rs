//! A wrench between two frames on rigid bodies, with its exact tangent by forward differentiation.

use num_dual::Dual64;
use ropewalk_core::error::need;
use ropewalk_core::held::find;
use ropewalk_core::rotation::{cross, from_matrix, matrix, times, transposed_times};
use ropewalk_core::{Assembly, At, BuildError, Jet, Marker, Node, NodeKind, V3};

/// A frame fixed in space or on a rigid body.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Mount {
    /// First coordinate and velocity of the body; none in space.
    body: Option<(usize, usize)>,
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
    body: [S; 4],
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
            Marker::Ground { point, axes } => Ok(Mount { body: None, point: *point, axes: turned(axes) }),
            Marker::Node { node, point, axes } => {
                let n = find(nodes, *node, what)?;
                need(n.kind == NodeKind::Frame, || {
                    format!(
                        "{what}: it needs rigid bodies or points in space, which have axes; use a `spring` on others"
                    )
                })?;
                Ok(Mount { body: Some((n.q, n.v)), point: *point, axes: turned(axes) })
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
            return Pose { x: of(&self.point), v: zero, omega: zero, axes, centre: zero, body: one };
        };
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
            body,
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
        self.0.iter().filter_map(|m| m.body).flat_map(|(_, v)| v..v + 6)
    }

    fn poses<S: Jet>(&self, at: &At<'_>, d: impl Fn(usize) -> S, v: impl Fn(usize) -> S) -> [Pose<S>; 2] {
        let second = if self.0[0].body.is_some() { 6 } else { 0 };
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
        out: &mut [S; 12],
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
            let own = transposed_times(&matrix(&pose_k.body), &whole);
            for i in 0..3 {
                out[row + i] = force[i] * sign;
                out[row + 3 + i] = own[i] * sign;
            }
            row += 6;
        }
    }

    /// Adds a law to the equations, with its tangent, which is that of clique 0.
    pub(crate) fn add(&self, law: &impl Wrench, at: &At<'_>, out: &mut Assembly<'_>) {
        let dofs: Vec<usize> = self.dofs().collect();
        let n = dofs.len();
        let mut values = [0.0; 12];
        self.residual(law, at, |_| 0.0, |i| at.v[dofs[i]], &mut values);
        for (dof, r) in dofs.iter().zip(values) {
            out.add(*dof, r);
        }
        if !out.wants_tangent() {
            return;
        }
        let w = out.weights();
        let mut block = [[0.0; 12]; 12];
        let mut column = [Dual64::from(0.0); 12];
        for j in 0..n {
            let one = |i: usize| if i == j { 1.0 } else { 0.0 };
            let d = |i: usize| Dual64::new(0.0, w.q * one(i));
            self.residual(law, at, d, |i| Dual64::new(at.v[dofs[i]], w.v * one(i)), &mut column);
            for i in 0..n {
                block[i][j] = column[i].eps;
            }
        }
        out.add_block(0, n, |i, j| block[i][j]);
    }
}

/// The orientation of the second frame seen from the first.
pub(crate) fn between<S: Jet>(pose: &[Pose<S>; 2]) -> [S; 4] {
    let a = &pose[0].axes;
    quaternion_product(&[a[0], -a[1], -a[2], -a[3]], &pose[1].axes)
}
