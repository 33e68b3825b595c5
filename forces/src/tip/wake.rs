//! Wakes of blunt ends.

use super::TipLaw;
use crate::{AddedMass, Surface};
use ropewalk_core::{Real, V3, dot, scaled};
use ropewalk_scene::Sea;

/// Water that leaves a blunt end takes momentum along (Lighthill 1971).
///
/// Without it a cable would end as a tail that tapers to a point. Where water leaves at an end, with the outward tangent
/// `t_o` and `w·t_o < 0`, the wake takes
///
/// `F = (1 - f) m_a/λ [(w·t_o) n - ½ s |n|² t_o]`, `s = |w·t_o|/|w|`,
///
/// off the end: `f` = 1 for a tail that tapers, 0 for one that is cut off; between them as Païdoussis has it. `s` lets the
/// force vanish smoothly where the water comes from the side.
#[derive(Clone, Debug, PartialEq)]
pub struct BluntEnd {
    /// The water, and the added mass.
    pub added_mass: AddedMass,
    /// Hydrodynamic diameter of the cable [m].
    pub diameter: f64,
    /// Share of the momentum that a tapering tail gets back.
    pub taper: f64,
    /// Whether this is the first end, whose tangent leads inwards.
    pub first: bool,
    /// The surface of the water, if it has one: above it the end sheds nothing.
    pub surface: Option<Surface>,
}

impl TipLaw for BluntEnd {
    fn label(&self) -> &'static str {
        "wake of a blunt end"
    }
    fn sea(&self) -> Option<&Sea> {
        self.added_mass.sea.as_deref()
    }
    fn fluid<R: Real>(&self, t: f64, x: &V3<R>) -> V3<R> {
        self.added_mass.fluid(t, x)
    }
    fn force<R: Real>(&self, t: f64, x: &V3<R>, v: &V3<R>, slope: &V3<R>) -> V3<R> {
        let u = self.fluid(t, x);
        let w: V3<R> = std::array::from_fn(|i| v[i] - u[i]);
        let inverse = R::of(1.0) / dot(slope, slope).sqrt();
        let out = scaled(if self.first { -inverse } else { inverse }, slope);
        let (along, square) = (dot(&w, &out), dot(&w, &w));
        // far from where a long cable begins to move, velocities are so small that their squares are nothing
        if !(along.lane(0) < 0.0 && square.lane(0) >= f64::MIN_POSITIVE) {
            return [R::zero(); 3];
        }
        let speed = square.sqrt();
        let wet =
            self.surface.as_ref().map_or(R::of(1.0), |surface| surface.ball(t, x, 0.5 * self.diameter).0);
        let per = wet * R::of(1.0 - self.taper) * self.added_mass.mass(R::of(self.diameter)) * inverse;
        let n: V3<R> = std::array::from_fn(|i| w[i] - along * out[i]);
        let pull = R::of(0.5) * dot(&n, &n) * (-along / speed);
        std::array::from_fn(|i| per * (along * n[i] - pull * out[i]))
    }
}
