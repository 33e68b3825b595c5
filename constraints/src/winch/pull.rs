//! Feeding under a force: tension, brake, the inertia of a drum.

use ropewalk_core::{
    Assembly, At, Column, Energy, Motion, MovingBoundary, Pattern, Power, Shows, Signal, Term, Timed,
};
use std::sync::Arc;

/// What a winch that isn't driven pulls with, as force on the boundary: `P |r'|` with
/// `P = tension + brake u/√(u² + slip_speed²) + damping u + per_speed2 u² + pile`, and `inertia u̇` of its drum; `u` is the speed at which it
/// feeds out.
///
/// A brake is dry friction, so below its force the end creeps at a part of `slip_speed`. Cable picked up from a pile at rest
/// has to be set moving, which takes `ρA u²` for `u > 0` (without rebound; a drum that turns with the cable takes none).
#[derive(Clone)]
pub struct Pull {
    /// Name of the winch.
    pub name: String,
    /// The end that feeds.
    pub boundary: MovingBoundary,
    /// Constant part [N].
    pub tension: Signal,
    /// Friction of the brake [N].
    pub brake: Signal,
    /// Speed below which the brake creeps [m/s].
    pub slip_speed: f64,
    /// Linear damping: tension per payout rate [N s/m].
    pub damping: Signal,
    /// Tension by the square of the speed, whichever way it feeds [kg/m].
    pub per_speed2: Signal,
    /// The motion along x whose speed that is, if it isn't the speed at which this end feeds.
    pub reference: Option<Arc<dyn Motion>>,
    /// Moment of inertia of the drum over its radius squared [kg].
    pub inertia: f64,
    /// Whether the cable is picked up from rest.
    pub pile: bool,
}

impl Pull {
    fn signals(&self) -> [&Signal; 4] {
        [&self.tension, &self.brake, &self.damping, &self.per_speed2]
    }
    /// The part of the tension that is given from outside.
    fn given(&self, t: f64, u: f64) -> f64 {
        let reference = self.reference.as_ref().map_or(u, |motion| motion.at(t).v[0]);
        self.tension.at(t) + self.per_speed2.at(t) * reference * reference
    }
    /// The pull, and its derivative by the speed of feeding.
    fn pull(&self, t: f64, u: f64) -> (f64, f64) {
        let (brake, damping) = (self.brake.at(t), self.damping.at(t));
        let root = (u * u + self.slip_speed * self.slip_speed).sqrt();
        let pile = if self.pile && u > 0.0 { self.boundary.rho_a } else { 0.0 };
        let rho = pile + if self.reference.is_none() { self.per_speed2.at(t) } else { 0.0 };
        (
            self.given(t, u) + brake * u / root + damping * u + pile * u * u,
            brake * self.slip_speed * self.slip_speed / (root * root * root) + damping + 2.0 * rho * u,
        )
    }
    fn slope(&self, at: &At<'_>) -> [f64; 3] {
        std::array::from_fn(|i| at.q[self.boundary.end_q + 3 + i])
    }
}

impl Term for Pull {
    fn label(&self) -> String {
        self.name.clone()
    }
    fn pattern(&self, p: &mut Pattern) {
        p.clique([self.boundary.v].into_iter().chain((3..6).map(|i| self.boundary.end_v + i)));
    }
    fn symmetric(&self) -> bool {
        false
    }
    fn add(&self, at: &At<'_>, out: &mut Assembly<'_>) {
        let (boundary, slope) = (&self.boundary, self.slope(at));
        let (stretch, (pull, by_u)) = (boundary.stretch(at), self.pull(at.t, boundary.rate(at)));
        // feeding out moves the boundary by its sign, and the pull resists that
        out.add(boundary.v, boundary.sign * pull * stretch + self.inertia * at.a[boundary.v]);
        let w = out.weights();
        out.add_block(0, 4, |i, j| match (i, j) {
            (0, 0) => w.v * by_u * stretch + w.a * self.inertia,
            (0, j) => w.q * boundary.sign * pull * slope[j - 1] / stretch,
            _ => 0.0,
        });
    }
    fn energy(&self, at: &At<'_>) -> Energy {
        let u = self.boundary.rate(at);
        Energy { kinetic: 0.5 * self.inertia * u * u, ..Energy::default() }
    }
    fn power(&self, at: &At<'_>) -> Power {
        let (u, stretch) = (self.boundary.rate(at), self.boundary.stretch(at));
        let given = self.given(at.t, u) * u * stretch;
        Power { supplied: -given, dissipated: self.pull(at.t, u).0 * u * stretch - given, ..Power::default() }
    }
    fn timed(&self) -> Option<&dyn Timed> {
        let driven = self.signals().iter().any(|s| !s.is_constant());
        if driven || self.reference.is_some() { Some(self) } else { None }
    }
    fn shows(&self) -> Option<&dyn Shows> {
        Some(self)
    }
}

impl Timed for Pull {
    fn reach(&self, t: f64, h: f64) -> Option<f64> {
        let h = self.signals().iter().fold(h, |h, s| s.reach(t, h));
        self.reference.as_ref().map_or(Some(h), |motion| motion.reach(t, h))
    }
    fn period(&self, t: f64) -> f64 {
        self.reference.as_ref().map_or(f64::INFINITY, |motion| motion.period(t))
    }
}

impl Shows for Pull {
    fn columns(&self) -> Vec<Column> {
        vec![Column::new(format!("{}.pull", self.name), "N")]
    }
    fn observe(&self, at: &At<'_>, out: &mut Vec<f64>) {
        out.push(self.pull(at.t, self.boundary.rate(at)).0);
    }
}
