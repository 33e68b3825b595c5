//! L4: engineering strain at every point.

use super::longitudinal::{Longitudinal, Stretch};
use super::quadrature::Point;
use super::shape::Natural;
use ropewalk_core::Real;

/// `ε = |r'| - 1` along the element (Gerstmayr & Irschik, J. Sound Vib. 318, 2008). The default.
///
/// Tension is `EA (λ - 1)` at any stretch λ. Singular only where the slope vanishes.
#[derive(Clone, Copy, Debug)]
pub struct L4;

impl Longitudinal for L4 {
    type Strain<R: Real> = Stretch<R>;
    fn label(self) -> &'static str {
        "L4"
    }
    #[inline(always)]
    fn strain<R: Real>(self, q: &Natural<R>, at: &Point) -> Stretch<R> {
        Stretch::engineering(q, at.phi)
    }
}
