//! T3: how fast the tangent turns along the material.

use super::transverse::{Invariants, Square, Transverse};
use ropewalk_core::Real;

/// `K = |r' × r''|/|r'|²`, the angle by which the tangent turns per unstretched length (Gerstmayr & Irschik 2008).
/// The default.
///
/// Work-conjugate to the moment: pure bending leaves the strain at zero.
#[derive(Clone, Copy, Debug)]
pub struct T3;

impl Transverse for T3 {
    fn label(self) -> &'static str {
        "T3"
    }
    #[inline(always)]
    fn square<R: Real>(self, i: &Invariants<R>) -> Square<R> {
        let ia = R::of(1.0) / i.a;
        Square::quotient(2.0, ia, ia, i)
    }
}
