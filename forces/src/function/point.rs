//! A function as a force and moment at a marker.

use super::{HALF, Scales};
use crate::point::orientation;
use ropewalk_core::error::need;
use ropewalk_core::held::{cross, delta, find, three};
use ropewalk_core::rotation::{M3, exp, matrix, product, times, transposed_times};
use ropewalk_core::{
    Assembly, At, BuildError, Column, Marker, Node, NodeKind, Pattern, Power, Shows, Term, Timed, V3, dot,
};
use ropewalk_scene::functions::{Called, Seen};

/// A force at a marker, and a moment if that is on a body, which a function gives.
pub struct FunctionForce {
    label: String,
    function: Called,
    scales: Scales,
    /// First coordinate and velocity of its node.
    q: usize,
    v: usize,
    /// Where it is on a body, in its axes [m]; of other nodes nothing turns.
    arm: Option<V3<f64>>,
}

/// A node at an instant: place, velocity, attitude, angular velocity in its own axes.
#[derive(Clone, Copy)]
struct Pose {
    x: V3<f64>,
    v: V3<f64>,
    r: M3,
    omega: V3<f64>,
}

fn plus(a: V3<f64>, b: V3<f64>) -> V3<f64> {
    std::array::from_fn(|i| a[i] + b[i])
}

impl FunctionForce {
    /// A force at a marker.
    ///
    /// # Errors
    /// A marker on the ground or on a node without position; a function that looks at the attitude of what has none, or at
    /// the slope of a cable.
    pub fn new(
        label: String,
        nodes: &[Node],
        marker: &Marker,
        function: Called,
        scales: Scales,
    ) -> Result<Self, BuildError> {
        let Marker::Node { node, point, .. } = *marker else {
            return Err(BuildError::at(
                "marker",
                "a force on the ground moves nothing: name a marker that moves",
            ));
        };
        let n = find(nodes, node, &label)?;
        need(!matches!(n.kind, NodeKind::Scalars(_)), || {
            format!("{label}: node {} has no position", node.0)
        })?;
        need(n.kind != NodeKind::Twist || point == [0.0; 3], || {
            format!(
                "{label}: a function acts on the axis of a cable: weld a rigid body to the lever, and let it act there"
            )
        })?;
        let (turns, reads) = (n.kind == NodeKind::Frame, function.reads);
        if reads.slope {
            let message =
                "a function at a marker sees no `slope`: leave out `marker` for a load along the cable";
            return Err(BuildError::at("function", message));
        }
        if !turns && (reads.attitude || reads.angular_velocity) {
            let message =
                "only bodies have an `attitude` and an `angular_velocity`: the marker is on something else";
            return Err(BuildError::at("marker", message));
        }
        Ok(FunctionForce { label, function, scales, q: n.q, v: n.v, arm: turns.then_some(point) })
    }

    fn pose(&self, at: &At<'_>) -> Pose {
        let (x, v) = (three(at.q, self.q), three(at.v, self.v));
        match self.arm {
            Some(_) => Pose { x, v, r: matrix(&orientation(at, self.q)), omega: three(at.v, self.v + 3) },
            None => Pose { x, v, r: matrix(&[1.0, 0.0, 0.0, 0.0]), omega: [0.0; 3] },
        }
    }

    fn seen(&self, p: &Pose) -> Seen {
        let arm = self.arm.unwrap_or_default();
        Seen {
            position: plus(p.x, times(&p.r, &arm)),
            velocity: plus(p.v, times(&p.r, &cross(&p.omega, &arm))),
            attitude: p.r,
            angular_velocity: times(&p.r, &p.omega),
        }
    }

    /// What the function looks at of what it is shown; the rest is as good as nothing.
    fn looked_at(&self, seen: &Seen) -> Seen {
        let (reads, nothing) = (self.function.reads, [0.0; 3]);
        Seen {
            position: if reads.position { seen.position } else { nothing },
            velocity: if reads.velocity { seen.velocity } else { nothing },
            attitude: if reads.attitude { seen.attitude } else { [nothing; 3] },
            angular_velocity: if reads.angular_velocity { seen.angular_velocity } else { nothing },
        }
    }

    /// Generalised force of force and moment in space, for the unknowns of the node.
    fn carried(&self, p: &Pose, [f, m]: &[V3<f64>; 2]) -> [f64; 6] {
        let turn = self
            .arm
            .map_or([0.0; 3], |arm| plus(cross(&arm, &transposed_times(&p.r, f)), transposed_times(&p.r, m)));
        [f[0], f[1], f[2], turn[0], turn[1], turn[2]]
    }

    /// The same pose with an unknown moved: a position or turn, or a velocity; and by how much.
    fn moved(&self, p: &Pose, k: usize, rate: bool) -> (Pose, f64) {
        let mut to = *p;
        let (linear, i) = (k < 3, k % 3);
        let move_by = |x: &mut f64, h: f64| {
            let before = *x;
            *x += h;
            *x - before
        };
        let speed = self.scales.velocity([&p.v]);
        let h = match (linear, rate) {
            (true, false) => move_by(&mut to.x[i], self.scales.position([&p.x])),
            (true, true) => move_by(&mut to.v[i], speed),
            (false, true) => move_by(&mut to.omega[i], speed / self.scales.length),
            (false, false) => {
                to.r = product(&p.r, &matrix(&exp(std::array::from_fn(|j| HALF * delta(i, j)))));
                HALF
            }
        };
        (to, h)
    }

    fn now(&self, at: &At<'_>) -> (Pose, [V3<f64>; 2]) {
        let pose = self.pose(at);
        (pose, self.function.force(at.t, &self.seen(&pose)))
    }
}

impl Term for FunctionForce {
    fn label(&self) -> String {
        self.label.clone()
    }
    fn pattern(&self, p: &mut Pattern) {
        p.clique(self.v..self.v + if self.arm.is_some() { 6 } else { 3 });
    }
    fn symmetric(&self) -> bool {
        let reads = self.function.reads;
        self.arm.is_none() && !(reads.position || reads.velocity)
    }
    fn is_load(&self) -> bool {
        true
    }
    fn add(&self, at: &At<'_>, out: &mut Assembly<'_>) {
        let (pose, force) = self.now(at);
        let (q, n) = (self.carried(&pose, &force), if self.arm.is_some() { 6 } else { 3 });
        (0..n).for_each(|i| out.add(self.v + i, -q[i]));
        if !out.wants_tangent() {
            return;
        }
        let (w, base) = (out.weights(), self.looked_at(&self.seen(&pose)));
        let mut k = [[0.0; 6]; 6];
        for (weight, rate) in [(w.q, false), (w.v, true)] {
            for j in (0..n).filter(|_| weight != 0.0) {
                let (to, h) = self.moved(&pose, j, rate);
                let seen = self.seen(&to);
                // what it doesn't look at doesn't change it
                let there =
                    if self.looked_at(&seen) == base { force } else { self.function.force(at.t, &seen) };
                let moved = self.carried(&to, &there);
                (0..n).for_each(|i| k[i][j] -= weight * (moved[i] - q[i]) / h);
            }
        }
        out.add_block(0, n, |i, j| k[i][j]);
    }
    fn power(&self, at: &At<'_>) -> Power {
        let (pose, [f, m]) = self.now(at);
        let seen = self.seen(&pose);
        Power { supplied: dot(&f, &seen.velocity) + dot(&m, &seen.angular_velocity), ..Power::default() }
    }
    fn timed(&self) -> Option<&dyn Timed> {
        if self.function.reads.time { Some(self) } else { None }
    }
    fn shows(&self) -> Option<&dyn Shows> {
        Some(self)
    }
}

impl Timed for FunctionForce {}

impl Shows for FunctionForce {
    fn columns(&self) -> Vec<Column> {
        ["fx", "fy", "fz"].map(|name| Column::new(name, "N")).to_vec()
    }
    fn observe(&self, at: &At<'_>, out: &mut Vec<f64>) {
        out.extend(self.now(at).1[0]);
    }
}
