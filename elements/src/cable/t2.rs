//! T2: the curvature of the curve in space.

use super::transverse::{Invariants, Square, Transverse};
use ropewalk_core::Real;

/// `κ = |r' × r''|/|r'|³`, the curvature of geometry (Serret–Frenet; Gerstmayr & Shabana 2006).
///
/// Taken per length of the stretched curve, but integrated over the unstretched one: under a moment `M` it shows a
/// spurious strain of `+M²/(EA EI)`.
#[derive(Clone, Copy, Debug)]
pub struct T2;

impl Transverse for T2 {
    fn label(self) -> &'static str {
        "T2"
    }
    #[inline(always)]
    fn square<R: Real>(self, i: &Invariants<R>) -> Square<R> {
        let ia = R::of(1.0) / i.a;
        Square::quotient(3.0, ia * ia, ia, i)
    }
}
