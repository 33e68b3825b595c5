//! L2: mean Green strain.

use super::longitudinal::{Longitudinal, MeanGreen};
use super::quadrature::{Point, Quadrature, WHOLE};
use super::shape::Natural;
use ropewalk_core::Real;

/// `ε = (eᵀŜe/L - 1)/2`, the Green strain averaged over the element, with `Ŝ = ∫ S'ᵀS' dx` (Berzeri & Shabana 2000).
///
/// The cheapest model that converges well: a closed form, no locking, error of fourth order in the element
/// length. One strain per element leaves the slopes' lengths to the bending energy, so it goes with T1 alone.
#[derive(Clone, Copy, Debug)]
pub struct L2;

impl Longitudinal for L2 {
    type Strain<R: Real> = MeanGreen<R>;
    fn label(self) -> &'static str {
        "L2"
    }
    fn lever(self, eps: f64) -> f64 {
        (1.0 + 2.0 * eps).max(0.0).sqrt()
    }
    #[inline(always)]
    fn points<Q: Quadrature>(self, _: Q) -> &'static [Point] {
        &WHOLE
    }
    #[inline(always)]
    fn strain<R: Real>(self, q: &Natural<R>, _: &Point) -> MeanGreen<R> {
        MeanGreen::new(q)
    }
}
