//! The point at which a cable leaves a drum, and the cable that this winds.

use super::layers::Layers;
use super::locked::Locked;
use crate::reeving::arc::angle;
use ropewalk_core::{
    At, Constraint, Jet, Marker, Motion, Node, NodeId, Place, Related, Relation, RowKind, lift,
};
use std::f64::consts::TAU;
use std::sync::Arc;

/// The cable is tangent to the drum where it leaves it, and what leaves was wound: no slip.
///
/// With `d = r - c`, the slope `s`, the angle `ψ` of the drum and `φ` of the tangent point about its axis since the start,
/// both in the sense that pays out: `a·d = x`, and of the part of `d` normal to the axis `|d| = R` and `d·s = 0`; and
/// `Λ(fed) = L(θ₀) - L(θ)`, where `θ = θ₀ - (ψ - φ)` is the angle that is still wound, `L(θ)` the length of cable in it, `x`
/// and `R` where it lies. `Λ` is what is fed out with the stretch that it was wound with. Turns of `φ` are counted by what is fed
/// out.
///
/// What is wound can't turn on the drum: of a cable with torsion the direction away from the axis is seen in the section at the
/// tangent point by the angle with which that part was wound.
///
/// The markers: the [`end`](crate::reeving::tangent::end) of the cable, the drum with its axis as the third, the material coordinate, and the angle if it is an
/// unknown.
#[derive(Clone)]
pub(super) struct Winding {
    pub layers: Layers,
    /// Where the marker of the drum is on its axis, as its layers count [m].
    pub offset: f64,
    /// Angle wound at the start [rad].
    pub wound: f64,
    /// Angle of the tangent point at the start [rad].
    pub phi: f64,
    /// The material coordinate at the start [m], and whether it grows or falls as cable is fed out.
    pub home: f64,
    pub sign: f64,
    /// Stretch of what is wound.
    pub locked: Locked,
    /// The angle of the drum, if it is prescribed.
    pub motion: Option<Arc<dyn Motion>>,
    /// Of a cable with torsion the angle at the start at which the direction away from the axis is seen in its section, and
    /// the twist of what is wound.
    pub twist: Option<(f64, Locked)>,
}

impl Relation for Winding {
    fn rows(&self) -> Vec<RowKind> {
        let mut rows = vec![RowKind::Position, RowKind::Position, RowKind::Direction, RowKind::Position];
        rows.extend(self.twist.map(|_| RowKind::Direction));
        rows
    }
    fn follows(&self) -> Option<&dyn Motion> {
        self.motion.as_deref()
    }
    fn g<S: Jet>(&self, t: S, at: &[Place<S>], g: &mut [S]) {
        self.recall(&[], t, at, g);
    }
    fn recall<S: Jet>(&self, internal: &[f64], t: S, at: &[Place<S>], g: &mut [S]) {
        let (end, drum, front) = (&at[0], &at[1], &at[2]);
        let [x, y, axis] = &drum.axes;
        let along = |a: &[S; 3], b: &[S; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let d: [S; 3] = std::array::from_fn(|i| end.x[i] - drum.x[i]);
        let beside = along(axis, &d);
        let flat: [S; 3] = std::array::from_fn(|i| d[i] - axis[i] * beside);
        let psi = match &self.motion {
            Some(motion) => {
                let now = motion.at(t.re());
                lift(t, [now.x[0], now.v[0], now.a[0]])
            }
            None => at[3].x[0],
        };
        let fed = (front.x[0] - self.home) * self.sign;
        let stretched = self.locked.at(internal, fed.re()).sum(fed);
        let all = self.layers.at(self.wound).length;
        let off = psi - angle(along(&flat, y), along(&flat, x)) + self.phi;
        let wanted = self.wound - self.layers.angle(all - stretched.re());
        let off = off - TAU * ((off.re() - wanted) / TAU).round();
        let lies = self.layers.at(-off + self.wound);
        g[0] = beside - lies.x + self.offset;
        g[1] = along(&flat, &flat).sqrt() - lies.radius;
        g[2] = along(&flat, &end.axes[0]) / self.layers.radius;
        g[3] = stretched + lies.length - all;
        if let Some((start, twist)) = &self.twist {
            let [_, d, n] = &end.axes;
            let seen = angle(along(&flat, d), along(&flat, n)) - *start;
            let off = seen - twist.at(internal, fed.re()).sum(fed) * self.sign;
            g[4] = off - TAU * (off.re() / TAU).round();
        }
    }
}

/// That as a constraint, of which only the end of the cable and the drum are places.
pub(super) struct Winds {
    inner: Related<Winding>,
}

impl Winds {
    pub fn new(name: String, winding: Winding, markers: Vec<Marker>) -> Self {
        let range = winding.motion.as_ref().map_or((f64::NEG_INFINITY, f64::INFINITY), |m| m.range());
        Winds { inner: Related::new(name, winding, markers).within(range) }
    }
}

impl Constraint for Winds {
    fn name(&self) -> &str {
        self.inner.name()
    }
    fn rows(&self) -> &[RowKind] {
        self.inner.rows()
    }
    fn markers(&self) -> &[Marker] {
        &self.inner.markers()[..2]
    }
    fn nodes(&self) -> &[NodeId] {
        self.inner.nodes()
    }
    fn linear(&self) -> bool {
        false
    }
    fn jacobian(&self, nodes: &[Node], at: &At<'_>, g: &mut [f64], jac: &mut [f64]) {
        self.inner.jacobian(nodes, at, g, jac);
    }
    fn geometric(&self, nodes: &[Node], at: &At<'_>, lambda: &[f64], h: &mut [f64]) {
        self.inner.geometric(nodes, at, lambda, h);
    }
    fn rates(&self, nodes: &[Node], at: &At<'_>, rate: &mut [f64], bias: &mut [f64]) {
        self.inner.rates(nodes, at, rate, bias);
    }
    fn moves(&self) -> bool {
        self.inner.moves()
    }
    fn reach(&self, t: f64, h: f64) -> Option<f64> {
        self.inner.reach(t, h)
    }
    fn period(&self, t: f64) -> f64 {
        self.inner.period(t)
    }
    fn range(&self) -> (f64, f64) {
        self.inner.range()
    }
}
