//! L3: Green strain at every point.

use super::longitudinal::{Longitudinal, Stretch};
use super::quadrature::Point;
use super::shape::Natural;
use ropewalk_core::Real;

/// `ε = (r'·r' - 1)/2` along the element (Gerstmayr & Shabana, Nonlinear Dyn. 45, 2006). Five Gauss points are exact.
///
/// The tension of a stretch λ is `EA λ (λ² - 1)/2`: it stiffens in tension, and in compression it is weakest at
/// `λ = 1/√3`, below which the material collapses.
#[derive(Clone, Copy, Debug)]
pub struct L3;

impl Longitudinal for L3 {
    type Strain<R: Real> = Stretch<R>;
    fn label(self) -> &'static str {
        "L3"
    }
    fn lever(self, eps: f64) -> f64 {
        (1.0 + 2.0 * eps).max(0.0).sqrt()
    }
    #[inline(always)]
    fn strain<R: Real>(self, q: &Natural<R>, at: &Point) -> Stretch<R> {
        Stretch::green(q, at.phi)
    }
}
