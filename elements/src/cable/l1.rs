//! L1: engineering strain of the chord.

use super::longitudinal::{Longitudinal, Stretch};
use super::quadrature::{Point, Quadrature, WHOLE};
use super::shape::Natural;
use ropewalk_core::Real;

/// `ε = |r₂ - r₁|/L - 1`, one strain for the element (the simplest assumption of Berzeri & Shabana 2000).
///
/// The slopes feel no axial force. A chord is shorter than its arc, so a bent cable comes out too long, by
/// `κ² L²/24`: the error falls only with the square of the element length. Goes with T1 alone.
#[derive(Clone, Copy, Debug)]
pub struct L1;

impl Longitudinal for L1 {
    type Strain<R: Real> = Stretch<R>;
    fn label(self) -> &'static str {
        "L1"
    }
    #[inline(always)]
    fn points<Q: Quadrature>(self, _: Q) -> &'static [Point] {
        &WHOLE
    }
    #[inline(always)]
    fn strain<R: Real>(self, q: &Natural<R>, _: &Point) -> Stretch<R> {
        Stretch::engineering(q, WHOLE[0].phi)
    }
}
