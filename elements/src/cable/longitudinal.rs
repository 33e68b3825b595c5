//! Longitudinal models: what an element calls its axial strain.
//!
//! A model gives a strain ε at each point of a quadrature rule (or one for the whole element) as a function of the
//! natural variables; everything else follows from ε and its derivatives. Strain energy `½ EA ∫ ε² dx`, force
//! `EA ∫ ε ∂ε`, tangent `EA ∫ (∂ε ∂εᵀ + ε ∂²ε)`.

use super::quadrature::{Point, Quadrature};
use super::reduced::Reduced;
use super::shape::{Natural, combine, dot9};
use ropewalk_core::{Real, Share, V3, dot};

/// A longitudinal model: a type that makes kernels of its own, or a [`LongitudinalModel`](super::LongitudinalModel) that is
/// chosen at run time.
pub trait Longitudinal: Copy + Send + Sync + 'static {
    /// Whether it is known while compiling: the largest elements have wide copies for such models only.
    const KNOWN: bool = true;
    /// Strain with its derivatives.
    type Strain<R: Real>: Strain<R>;
    /// Short name, for labels.
    fn label(self) -> &'static str;
    /// Whether force is the derivative of an energy, and the tangent therefore symmetric.
    fn symmetric(self) -> bool {
        true
    }
    /// Axial force per stress `EA ε`, as the force goes with the stretch and the stress with the strain.
    fn lever(self, _eps: f64) -> f64 {
        1.0
    }
    /// Where the strain is taken: the points of `rule`, or [`WHOLE`](super::quadrature::WHOLE).
    #[inline(always)]
    fn points<Q: Quadrature>(self, rule: Q) -> &'static [Point] {
        rule.points()
    }
    /// The strain at one of these points.
    fn strain<R: Real>(self, q: &Natural<R>, at: &Point) -> Self::Strain<R>;
    /// Adds the part of the tangent that has no symmetry, times `material`: none, for a conservative model.
    #[inline(always)]
    fn add_unsymmetric<R: Real>(self, _material: R, _q: &Natural<R>, _il: R, _out: &mut Share<R, 12>) {}
}

/// A strain ε of the natural variables `q`, with its derivatives.
pub trait Strain<R: Real> {
    /// The strain itself.
    fn eps(&self) -> R;
    /// Direction of the force, `∂ε/∂q`.
    fn gradient(&self) -> Natural<R>;
    /// Rate `∂ε/∂q · v`.
    fn rate(&self, v: &Natural<R>) -> R;
    /// `∂²ε/∂q² · v`: how the gradient turns.
    fn turn(&self, v: &Natural<R>) -> Natural<R>;
    /// Adds `s ∂²ε/∂q²`.
    fn add_hessian(&self, s: R, out: &mut Reduced<R>);
    /// Adds `material ∂ε ∂εᵀ + stress ∂²ε`, so far as it is symmetric.
    #[inline(always)]
    fn add_stiffness(&self, material: R, stress: R, out: &mut Reduced<R>) {
        out.add_square(material, &self.gradient());
        self.add_hessian(stress, out);
    }
}

/// A strain that depends on the stretch of one vector `p`: the slope at a point, or the chord.
/// `∂ε/∂p = n p` and `∂²ε/∂p² = n I + h p pᵀ`.
#[derive(Clone, Copy, Debug)]
pub struct Stretch<R> {
    /// The vector.
    pub p: V3<R>,
    /// `∂p/∂q`, one number per natural variable.
    pub phi: [f64; 3],
    /// Strain.
    pub eps: R,
    /// First derivative.
    pub n: R,
    /// Second derivative.
    pub h: R,
}

impl<R: Real> Stretch<R> {
    /// Engineering strain `ε = |p| - 1`.
    #[inline(always)]
    pub fn engineering(q: &Natural<R>, phi: [f64; 3]) -> Self {
        let p = combine(&phi, q);
        let a = dot(&p, &p);
        let n = R::of(1.0) / a.sqrt();
        // (a - 1)/(√a + 1) instead of √a - 1: all digits of a - 1 survive
        let eps = (a - R::of(1.0)) / (a * n + R::of(1.0));
        Stretch { p, phi, eps, n, h: -(n * n * n) }
    }
    /// Green strain `ε = (p·p - 1)/2`.
    #[inline(always)]
    pub fn green(q: &Natural<R>, phi: [f64; 3]) -> Self {
        let p = combine(&phi, q);
        let eps = R::of(0.5) * (dot(&p, &p) - R::of(1.0));
        Stretch { p, phi, eps, n: R::of(1.0), h: R::zero() }
    }
    /// The natural force that a force `s v` on `p` makes.
    #[inline(always)]
    fn lift(&self, s: R, v: &V3<R>) -> Natural<R> {
        let mut g = [*v; 3];
        for i in 0..3 {
            let sf = s * R::of(self.phi[i]);
            for c in 0..3 {
                g[i][c] = sf * v[c];
            }
        }
        g
    }
    /// Adds `unit φφᵀ ⊗ I + square φφᵀ ⊗ ppᵀ`.
    #[inline(always)]
    fn add(&self, unit: R, square: R, out: &mut Reduced<R>) {
        let [_, f1, f2] = self.phi;
        let f = [1.0, f1, f2, f1 * f1, f1 * f2, f2 * f2].map(R::of);
        for r in 0..3 {
            let sp = square * self.p[r];
            for c in r..3 {
                let m = if r == c { sp.fma(self.p[c], unit) } else { sp * self.p[c] };
                for b in 0..6 {
                    out.k[b][r][c] = f[b].fma(m, out.k[b][r][c]);
                }
                if r != c {
                    for b in [1, 2, 4] {
                        out.k[b][c][r] = f[b].fma(m, out.k[b][c][r]);
                    }
                }
            }
        }
    }
}

impl<R: Real> Strain<R> for Stretch<R> {
    #[inline(always)]
    fn eps(&self) -> R {
        self.eps
    }
    #[inline(always)]
    fn gradient(&self) -> Natural<R> {
        self.lift(self.n, &self.p)
    }
    #[inline(always)]
    fn rate(&self, v: &Natural<R>) -> R {
        self.n * dot(&self.p, &combine(&self.phi, v))
    }
    #[inline(always)]
    fn turn(&self, v: &Natural<R>) -> Natural<R> {
        let d = combine(&self.phi, v);
        let along = self.h * dot(&self.p, &d);
        let mut turn = d;
        for c in 0..3 {
            turn[c] = along.fma(self.p[c], self.n * d[c]);
        }
        self.lift(R::of(1.0), &turn)
    }
    #[inline(always)]
    fn add_hessian(&self, s: R, out: &mut Reduced<R>) {
        self.add(s * self.n, s * self.h, out);
    }
    #[inline(always)]
    fn add_stiffness(&self, material: R, stress: R, out: &mut Reduced<R>) {
        self.add(stress * self.n, material.fma(self.n * self.n, stress * self.h), out);
    }
}

/// The mean of the Green strain over the element:
/// `ε = (|Δ|² - 1)/2 + (|α|² + |β|²)/15 - α·β/30`, a quadratic form.
#[derive(Clone, Copy, Debug)]
pub struct MeanGreen<R> {
    eps: R,
    gradient: Natural<R>,
}

impl<R: Real> MeanGreen<R> {
    /// At the natural variables `q`.
    #[inline(always)]
    pub fn new(q: &Natural<R>) -> Self {
        let gradient = Self::matrix(q);
        let eps = R::of(0.5) * (dot9(&gradient, q) - R::of(1.0));
        MeanGreen { eps, gradient }
    }
    /// The matrix of the quadratic form times `v`.
    #[inline(always)]
    fn matrix(v: &Natural<R>) -> Natural<R> {
        let (d, o) = (R::of(2.0 / 15.0), R::of(-1.0 / 30.0));
        let mut m = *v;
        for c in 0..3 {
            m[1][c] = d.fma(v[1][c], o * v[2][c]);
            m[2][c] = d.fma(v[2][c], o * v[1][c]);
        }
        m
    }
}

impl<R: Real> Strain<R> for MeanGreen<R> {
    #[inline(always)]
    fn eps(&self) -> R {
        self.eps
    }
    #[inline(always)]
    fn gradient(&self) -> Natural<R> {
        self.gradient
    }
    #[inline(always)]
    fn rate(&self, v: &Natural<R>) -> R {
        dot9(&self.gradient, v)
    }
    #[inline(always)]
    fn turn(&self, v: &Natural<R>) -> Natural<R> {
        Self::matrix(v)
    }
    #[inline(always)]
    fn add_hessian(&self, s: R, out: &mut Reduced<R>) {
        out.add_unit(0, 0, s);
        out.add_unit(1, 1, s * R::of(2.0 / 15.0));
        out.add_unit(2, 2, s * R::of(2.0 / 15.0));
        out.add_unit(1, 2, s * R::of(-1.0 / 30.0));
    }
}

/// Adds the axial force, and with `TANGENT` its derivative. `ea_l = EA L`.
#[inline(always)]
pub fn add_axial<L: Longitudinal, Q: Quadrature, R: Real, const TANGENT: bool>(
    model: L,
    rule: Q,
    ea_l: R,
    q: &Natural<R>,
    out: &mut Reduced<R>,
) {
    for at in model.points(rule) {
        let strain = model.strain(q, at);
        let c = ea_l * R::of(at.w);
        let stress = c * strain.eps();
        out.add_force(stress, &strain.gradient());
        if TANGENT {
            strain.add_stiffness(c, stress, out);
        }
    }
}

/// Strain energy of stretching, `½ EA L Σ w ε²`.
#[inline(always)]
pub fn axial_energy<L: Longitudinal, Q: Quadrature, R: Real>(
    model: L,
    rule: Q,
    ea_l: R,
    q: &Natural<R>,
) -> R {
    let mut sum = R::zero();
    for at in model.points(rule) {
        let eps = model.strain(q, at).eps();
        sum = (R::of(at.w) * eps).fma(eps, sum);
    }
    R::of(0.5) * ea_l * sum
}
