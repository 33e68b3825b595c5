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
    const LABEL: &'static str = "L4";
    const USUAL: bool = true;
    type Strain<R: Real> = Stretch<R>;
    #[inline(always)]
    fn strain<R: Real>(q: &Natural<R>, at: &Point) -> Stretch<R> {
        Stretch::engineering(q, at.phi)
    }
}
