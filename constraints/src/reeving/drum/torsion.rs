//! The twist with which cable lies on a drum: as it was wound, it stays until it is paid out.

use super::locked::Locked;
use ropewalk_core::{Assembly, At, MovingBoundary, Part, Pattern, Power, Quantity, Remembers, Term};
use ropewalk_scene::Torsional;
use std::sync::Arc;

/// What the twist of cable changes by where it leaves the drum.
///
/// What is paid out takes the twist `K` of the free cable at once, instead of that with which it was wound, `K_w`. With the moment
/// `M = GJ (K - K₀)` that turns it, by length of the work `M (K - K_w)` as much is stored in it as its energy of twist grows from `K_w` to
/// `K`, and `GJ (K - K_w)²/2` becomes heat: the tension has no part in it. Where it is wound both twists are the same.
pub(super) struct Untwists {
    pub name: String,
    pub boundary: MovingBoundary,
    /// The free cable.
    pub span: Arc<dyn Part>,
    /// Twist of what is wound.
    pub locked: Locked,
    pub torsion: Torsional,
}

impl Untwists {
    /// Twist of the free cable at its end.
    fn free(&self, at: &At<'_>) -> f64 {
        let line = self.span.line();
        let end =
            |line: &dyn ropewalk_core::Line| if self.boundary.sign < 0.0 { 0.0 } else { line.length_now(at) };
        line.and_then(|line| line.observe(Quantity::Twist, end(line), at)).unwrap_or(0.0)
    }

    /// Twist of the free cable, and of what passes.
    fn twists(&self, at: &At<'_>) -> [f64; 2] {
        let fed = self.boundary.fed(at);
        [self.free(at), self.locked.at(at.internal, fed).per_length(fed)]
    }
}

impl Term for Untwists {
    fn label(&self) -> String {
        format!("{}: torsion", self.name)
    }
    fn pattern(&self, p: &mut Pattern) {
        p.clique([self.boundary.v]);
    }
    fn symmetric(&self) -> bool {
        false
    }
    // a small force that changes slowly: its tangent is left out
    fn add(&self, at: &At<'_>, out: &mut Assembly<'_>) {
        let [free, wound] = self.twists(at);
        let Torsional { gj, free: unstressed, .. } = self.torsion;
        out.add(self.boundary.v, self.boundary.sign * gj * (free - unstressed) * (free - wound));
    }
    fn power(&self, at: &At<'_>) -> Power {
        let ([free, wound], rate) = (self.twists(at), self.boundary.rate(at));
        let Torsional { gj, free: unstressed, .. } = self.torsion;
        let stored = |k: f64| gj * k * (0.5 * k - unstressed);
        let lost = 0.5 * gj * (free - wound).powi(2);
        Power { dissipated: lost * rate, carried: (stored(wound) - stored(free)) * rate, ..Power::default() }
    }
    fn remembers(&self) -> Option<&dyn Remembers> {
        Some(self)
    }
}

impl Remembers for Untwists {
    fn remember(&self, at: &At<'_>, memory: &mut [f64]) {
        let twist = self.free(&At { internal: memory, ..*at });
        self.locked.wind(memory, self.boundary.fed(at), twist);
    }
    fn rests(&self) -> bool {
        true
    }
    fn settle(&self, at: &At<'_>, memory: &mut [f64]) -> bool {
        self.remember(at, memory);
        false
    }
}
