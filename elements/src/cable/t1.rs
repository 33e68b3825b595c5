//! T1: the second derivative taken for the curvature.

use super::quadrature::Quadrature;
use super::reduced::Reduced;
use super::shape::Natural;
use super::transverse::{Invariants, Square, Transverse};
use ropewalk_core::Real;

/// `κ = |r''|` (Berzeri & Shabana 2000): a constant stiffness matrix, exact without quadrature.
///
/// True for small stretch. Otherwise it couples stretching and bending: it penalises a stretch that varies along
/// the element, and under a moment `M` shows a spurious strain of `-M²/(EA EI)`.
#[derive(Clone, Copy, Debug)]
pub struct T1;

impl Transverse for T1 {
    fn label(self) -> &'static str {
        "T1"
    }
    #[inline(always)]
    fn square<R: Real>(self, i: &Invariants<R>) -> Square<R> {
        let (zero, one) = (R::zero(), R::of(1.0));
        Square { value: i.c, a: zero, b: zero, c: one, aa: zero, ab: zero, ac: zero, bb: zero }
    }
    /// Closed form of the energy `(2 EI/L)(|α|² + α·β + |β|²)`.
    #[inline(always)]
    fn add<Q: Quadrature, R: Real, const TANGENT: bool>(
        self,
        _: Q,
        ei: R,
        _: R,
        il: R,
        q: &Natural<R>,
        out: &mut Reduced<R>,
    ) {
        let k = R::of(2.0) * ei * il;
        for c in 0..3 {
            out.g[1][c] += k * (q[1][c] + q[1][c] + q[2][c]);
            out.g[2][c] += k * (q[1][c] + q[2][c] + q[2][c]);
        }
        if TANGENT {
            out.add_unit(1, 1, k + k);
            out.add_unit(1, 2, k);
            out.add_unit(2, 2, k + k);
        }
    }
}
