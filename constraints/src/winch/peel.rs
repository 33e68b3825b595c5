//! Peeling at a given energy: cable that sticks to its package.

use crate::package::Package;
use ropewalk_core::{Assembly, At, Column, MovingBoundary, Pattern, Power, Shows, Term, V3, dot};
use std::sync::Arc;

/// Holds back an end that lifts off by what peeling costs, as force on the boundary: `Γ - EI κ_w²/2 + ρA v²/2`.
///
/// Moving the lift-off point by `δσ` breaks a bond of the energy `Γ δσ`, and the free cable takes over `EI κ_w²/2 δσ` of
/// bending from the wound one, which lies unstretched and at rest. With the derivative of all of the strain energy of the
/// free cable (an end whose outside is `unstrained`) virtual work then says what fracture mechanics does: of a cable tangent
/// to the wound layer `EI |κ - κ_w|²/2 + T ε/2 = Γ`, with the curvatures of the free and of the wound cable as vectors and a
/// small part by the strain `ε`; of a flexible one at an angle `D` to the layer `(T - ρA u²) (1 - cos D) + T ε/2 = Γ`, where `ρA v²/2`
/// sets the cable moving that was at rest (Rivlin 1944; with inertia Burridge & Keller 1978).
///
/// The bond resists peeling only: cable that is laid on again doesn't stick, and one that is pulled less than it takes
/// creeps at a part of `slip_speed`.
#[derive(Clone, Debug)]
pub struct Peel {
    /// Name of the lift-off.
    pub name: String,
    /// The end that lifts off.
    pub boundary: MovingBoundary,
    /// What it lifts off from.
    pub package: Arc<Package>,
    /// Energy of the bond per length `Γ` [J/m].
    pub energy: f64,
    /// Speed below which it creeps [m/s].
    pub slip_speed: f64,
    /// Bending stiffness [N m²].
    pub ei: f64,
}

impl Peel {
    /// What the bond takes per length at a speed of peeling, and its derivative by that.
    fn bond(&self, u: f64) -> (f64, f64) {
        if u <= 0.0 {
            return (0.0, 0.0);
        }
        let root = u.hypot(self.slip_speed);
        (self.energy * u / root, self.energy * self.slip_speed * self.slip_speed / (root * root * root))
    }
    /// Bending energy per length of the wound cable where a length has been peeled.
    fn wound(&self, peeled: f64) -> f64 {
        // beyond the end of the package the run ends
        let lay = self.package.at(peeled.min(self.package.wound()));
        lay.map_or(f64::NAN, |lay| 0.5 * self.ei * dot(&lay.curvature, &lay.curvature))
    }
    /// By differences, since a package has two continuous derivatives only.
    fn wound_slope(&self, peeled: f64) -> f64 {
        let h = 1e-4 * self.package.spec().radius;
        (self.wound(peeled + h) - self.wound(peeled - h)) / (2.0 * h)
    }
    /// Slope of the cable at the end and velocity of its material there.
    fn motion(&self, at: &At<'_>) -> (V3<f64>, V3<f64>) {
        let slope: V3<f64> = std::array::from_fn(|i| at.q[self.boundary.end_q + 3 + i]);
        let v = std::array::from_fn(|i| at.v[self.boundary.end_v + i] - at.v[self.boundary.v] * slope[i]);
        (slope, v)
    }
}

impl Term for Peel {
    fn label(&self) -> String {
        format!("{}.peel", self.name)
    }
    fn pattern(&self, p: &mut Pattern) {
        p.clique([self.boundary.v].into_iter().chain((0..6).map(|i| self.boundary.end_v + i)));
    }
    fn symmetric(&self) -> bool {
        false
    }
    fn add(&self, at: &At<'_>, out: &mut Assembly<'_>) {
        let (boundary, peeled, (slope, v)) = (&self.boundary, self.boundary.fed(at), self.motion(at));
        let (bond, by_u) = self.bond(boundary.rate(at));
        let pull = bond - self.wound(peeled) + 0.5 * boundary.rho_a * dot(&v, &v);
        out.add(boundary.v, boundary.sign * pull);
        if !out.wants_tangent() {
            return;
        }
        let (w, by_peeled) = (out.weights(), -self.wound_slope(peeled));
        let momentum = v.map(|v| boundary.sign * boundary.rho_a * v);
        let rate = at.v[boundary.v];
        out.add_block(0, 7, |i, j| match (i, j) {
            (0, 0) => w.q * by_peeled + w.v * (by_u - dot(&momentum, &slope)),
            (0, 1..=3) => w.v * momentum[j - 1],
            (0, j) => -w.q * rate * momentum[j - 4],
            _ => 0.0,
        });
    }
    fn power(&self, at: &At<'_>) -> Power {
        let (u, (_, v)) = (self.boundary.rate(at), self.motion(at));
        // what comes in has the energy of wound cable at rest, and not that of the free one
        let carried = (self.wound(self.boundary.fed(at)) - 0.5 * self.boundary.rho_a * dot(&v, &v)) * u;
        Power { dissipated: self.bond(u).0 * u, carried, ..Power::default() }
    }
    fn shows(&self) -> Option<&dyn Shows> {
        Some(self)
    }
}

impl Shows for Peel {
    fn columns(&self) -> Vec<Column> {
        vec![Column::new(format!("{}.bond", self.name), "J/m")]
    }
    fn observe(&self, at: &At<'_>, out: &mut Vec<f64>) {
        out.push(self.bond(self.boundary.rate(at)).0);
    }
}
