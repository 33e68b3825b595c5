//! L1n: the frozen-strain form of L1. Not conservative; for comparison with old results only.

use super::longitudinal::{Longitudinal, MeanGreen, Strain, Stretch};
use super::quadrature::{Point, Quadrature, WHOLE};
use super::reduced::{Reduced, add_product};
use super::shape::Natural;
use ropewalk_core::{Real, Share};

/// **Not conservative.** Force `EA ε Ŝ e` with `ε` the strain of the chord and `Ŝ = ∫ S'ᵀS' dx`: a "stiffness
/// matrix" `K(e) = EA ε Ŝ` times `e`, as the equations were printed when the strain inside `K` was taken as known.
///
/// No energy has this force for its derivative, so its work around a closed loop isn't zero: energy drifts and a
/// soft cable can blow up. Its tangent is unsymmetric. A uniform stretch λ gives the tension `EA (λ - 1) λ`
/// instead of `EA (λ - 1)`. The energy reported for it is that of L1. Use [`L2`](super::L2) instead, which has the
/// same matrix and the strain that belongs to it.
#[derive(Clone, Copy, Debug)]
pub struct L1n;

impl Longitudinal for L1n {
    type Strain<R: Real> = Frozen<R>;
    fn label(self) -> &'static str {
        "L1n"
    }
    fn symmetric(self) -> bool {
        false
    }
    fn lever(self, eps: f64) -> f64 {
        1.0 + eps
    }
    #[inline(always)]
    fn points<Q: Quadrature>(self, _: Q) -> &'static [Point] {
        &WHOLE
    }
    #[inline(always)]
    fn strain<R: Real>(self, q: &Natural<R>, _: &Point) -> Frozen<R> {
        Frozen { chord: Stretch::engineering(q, WHOLE[0].phi), mean: MeanGreen::new(q) }
    }
    #[inline(always)]
    fn add_unsymmetric<R: Real>(self, material: R, q: &Natural<R>, il: R, out: &mut Share<R, 12>) {
        let Frozen { chord, mean } = self.strain(q, &WHOLE[0]);
        add_product(material, &mean.gradient(), &chord.gradient(), il, out);
    }
}

/// The strain of one measure along the force direction of another.
#[derive(Clone, Copy, Debug)]
pub struct Frozen<R> {
    chord: Stretch<R>,
    mean: MeanGreen<R>,
}

impl<R: Real> Strain<R> for Frozen<R> {
    #[inline(always)]
    fn eps(&self) -> R {
        self.chord.eps()
    }
    #[inline(always)]
    fn gradient(&self) -> Natural<R> {
        self.mean.gradient()
    }
    #[inline(always)]
    fn rate(&self, v: &Natural<R>) -> R {
        self.chord.rate(v)
    }
    #[inline(always)]
    fn turn(&self, v: &Natural<R>) -> Natural<R> {
        self.mean.turn(v)
    }
    #[inline(always)]
    fn add_hessian(&self, s: R, out: &mut Reduced<R>) {
        self.mean.add_hessian(s, out);
    }
    #[inline(always)]
    fn add_stiffness(&self, _: R, stress: R, out: &mut Reduced<R>) {
        self.mean.add_hessian(stress, out);
    }
}
