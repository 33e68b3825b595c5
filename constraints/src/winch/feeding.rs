//! Feeding at a prescribed speed.

use ropewalk_core::{At, Constraint, Marker, Motion, MovingBoundary, Node, NodeId, RowKind};
use std::sync::Arc;

/// The length fed out at an end of a cable follows a motion: `X(t) - fed = 0`, one equation.
///
/// `X` is the motion's first component [m]. The multiplier is what the winch pulls with, tension times stretch [N].
#[derive(Clone, Debug)]
pub struct Feeding {
    name: String,
    boundary: MovingBoundary,
    nodes: [NodeId; 1],
    motion: Arc<dyn Motion>,
}

impl Feeding {
    /// Feeds by this motion.
    pub fn new(name: impl Into<String>, boundary: MovingBoundary, motion: Arc<dyn Motion>) -> Self {
        Feeding { name: name.into(), boundary, nodes: [boundary.node], motion }
    }
}

impl Constraint for Feeding {
    fn name(&self) -> &str {
        &self.name
    }
    fn rows(&self) -> &[RowKind] {
        &[RowKind::Position]
    }
    fn markers(&self) -> &[Marker] {
        &[]
    }
    fn nodes(&self) -> &[NodeId] {
        &self.nodes
    }
    fn linear(&self) -> bool {
        true
    }
    fn jacobian(&self, _: &[Node], at: &At<'_>, g: &mut [f64], jac: &mut [f64]) {
        g[0] = self.boundary.fed(at) - self.motion.at(at.t).x[0];
        jac[0] = self.boundary.sign;
    }
    fn geometric(&self, _: &[Node], _: &At<'_>, _: &[f64], h: &mut [f64]) {
        h[0] = 0.0;
    }
    fn rates(&self, _: &[Node], at: &At<'_>, rate: &mut [f64], bias: &mut [f64]) {
        let moving = self.motion.at(at.t);
        (rate[0], bias[0]) = (-moving.v[0], -moving.a[0]);
    }
    fn moves(&self) -> bool {
        true
    }
    fn reach(&self, t: f64, h: f64) -> Option<f64> {
        self.motion.reach(t, h)
    }
    fn period(&self, t: f64) -> f64 {
        self.motion.period(t)
    }
    fn prescribes(&self) -> Option<(usize, usize)> {
        Some((self.boundary.q, self.boundary.v))
    }
    fn prescribed(&self, t: f64) -> [f64; 3] {
        let (moving, sign) = (self.motion.at(t), self.boundary.sign);
        [self.boundary.home + sign * moving.x[0], sign * moving.v[0], sign * moving.a[0]]
    }
    fn range(&self) -> (f64, f64) {
        self.motion.range()
    }
}
