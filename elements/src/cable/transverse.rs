//! Transverse models: what an element calls its curvature.
//!
//! A model gives κ² as a function of the invariants `a = r'·r'`, `b = r'·r''`, `c = r''·r''` of the first two
//! derivatives of the curve. κ itself, with its root, is never differentiated: a straight element has κ = 0, and its
//! derivatives there are 0/0. Strain energy `½ EI ∫ κ² dx`.

use super::quadrature::{Point, Quadrature};
use super::reduced::{Reduced, block};
use super::shape::{Natural, combine, second};
use ropewalk_core::{Real, V3, dot};

/// A transverse model: a type, or a [`TransverseModel`](super::TransverseModel) that is chosen at run time.
pub trait Transverse: Copy + Send + Sync + 'static {
    /// Whether it is known while compiling; see [`Longitudinal::KNOWN`](super::longitudinal::Longitudinal::KNOWN).
    const KNOWN: bool = true;
    /// Short name, for labels.
    fn label(self) -> &'static str;
    /// κ² and its derivatives.
    fn square<R: Real>(self, i: &Invariants<R>) -> Square<R>;
    /// Adds the bending force, and with `TANGENT` its derivative; `il = 1/L`.
    #[inline(always)]
    fn add<Q: Quadrature, R: Real, const TANGENT: bool>(
        self,
        rule: Q,
        ei: R,
        l: R,
        il: R,
        q: &Natural<R>,
        out: &mut Reduced<R>,
    ) {
        add_bending::<Self, Q, R, TANGENT>(self, rule, ei, l, il, q, out);
    }
}

/// Adds the bending force by quadrature, and with `TANGENT` its derivative.
#[inline(always)]
pub fn add_bending<T: Transverse, Q: Quadrature, R: Real, const TANGENT: bool>(
    model: T,
    rule: Q,
    ei: R,
    l: R,
    il: R,
    q: &Natural<R>,
    out: &mut Reduced<R>,
) {
    for at in rule.points() {
        let curve = Curve::new(model, q, at, il);
        let s = ei * l * R::of(0.5 * at.w);
        curve.add_force(s, out);
        if TANGENT {
            curve.add_hessian(s, out);
        }
    }
}

/// Products of `p = r'` and `q = r''`.
#[derive(Clone, Copy, Debug)]
pub struct Invariants<R> {
    /// `r'·r'`
    pub a: R,
    /// `r'·r''`
    pub b: R,
    /// `r''·r''`
    pub c: R,
    /// `|r' × r''|² = a c - b²`, from the cross product: nothing cancels, and it is never negative.
    pub d: R,
}

/// `κ²(a, b, c)` and its derivatives; those not named are zero in all models.
#[derive(Clone, Copy, Debug)]
pub struct Square<R> {
    /// κ² [1/m²].
    pub value: R,
    /// By `a`.
    pub a: R,
    /// By `b`.
    pub b: R,
    /// By `c`.
    pub c: R,
    /// By `a` twice.
    pub aa: R,
    /// By `a` and `b`.
    pub ab: R,
    /// By `a` and `c`.
    pub ac: R,
    /// By `b` twice.
    pub bb: R,
}

impl<R: Real> Square<R> {
    /// `κ² = d/aᵖ` for `p` = 2 or 3, given `aᵖ⁻¹`'s inverse `i1` and `1/a`.
    #[inline(always)]
    pub fn quotient(n: f64, i1: R, ia: R, x: &Invariants<R>) -> Self {
        let ip = i1 * ia;
        let iq = ip * ia;
        let (value, p) = (x.d * ip, R::of(n));
        let slope = p * value * ia;
        Square {
            value,
            a: x.c.fma(ip, -slope),
            b: R::of(-2.0) * x.b * ip,
            c: i1,
            aa: R::of(-2.0 * n) * x.c * iq + R::of(n + 1.0) * slope * ia,
            ab: R::of(2.0 * n) * x.b * iq,
            ac: R::of(1.0 - n) * ip,
            bb: R::of(-2.0) * ip,
        }
    }
}

/// A point of the curve with its squared curvature, ready to be differentiated by the natural variables.
#[derive(Clone, Copy, Debug)]
pub struct Curve<R> {
    /// `r'`
    pub p: V3<R>,
    /// `r''`
    pub q: V3<R>,
    /// `∂r'/∂q`
    pub phi: [f64; 3],
    /// `L ∂r''/∂q` by `α` and `β`; `Δ` has no part in it.
    pub psi: [f64; 2],
    /// `1/L`
    pub il: R,
    /// Squared curvature.
    pub square: Square<R>,
}

impl<R: Real> Curve<R> {
    /// The point `at` of the curve with natural variables `nat`.
    #[inline(always)]
    pub fn new<T: Transverse>(model: T, nat: &Natural<R>, at: &Point, il: R) -> Self {
        let (p, q) = (combine(&at.phi, nat), second(&at.psi, il, nat));
        let x: V3<R> = [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]];
        let i = Invariants { a: dot(&p, &p), b: dot(&p, &q), c: dot(&q, &q), d: dot(&x, &x) };
        Curve { p, q, phi: at.phi, psi: at.psi, il, square: model.square(&i) }
    }

    #[inline(always)]
    fn lift(&self, gp: &V3<R>, gq: &V3<R>) -> Natural<R> {
        lift_by(&self.phi, &self.psi, self.il, gp, gq)
    }

    /// Gradient of κ².
    #[inline(always)]
    pub fn gradient(&self) -> Natural<R> {
        let s = &self.square;
        let (a, c) = (s.a + s.a, s.c + s.c);
        let (mut gp, mut gq) = (self.p, self.q);
        for i in 0..3 {
            gp[i] = a.fma(self.p[i], s.b * self.q[i]);
            gq[i] = c.fma(self.q[i], s.b * self.p[i]);
        }
        self.lift(&gp, &gq)
    }

    /// Adds `s` times the gradient of κ² to the force.
    #[inline(always)]
    pub fn add_force(&self, s: R, out: &mut Reduced<R>) {
        out.add_force(s, &self.gradient());
    }

    /// Second derivative of κ² times `v`.
    #[inline(always)]
    pub fn turn(&self, v: &Natural<R>) -> Natural<R> {
        let (s, p, q) = (&self.square, &self.p, &self.q);
        let dp = combine(&self.phi, v);
        let dq = second(&self.psi, self.il, v);
        let two = R::of(2.0);
        let (da, db, dc) = (two * dot(p, &dp), dot(&dp, q) + dot(p, &dq), two * dot(q, &dq));
        let va = two * (s.aa * da + s.ab * db + s.ac * dc);
        let vb = s.ab * da + s.bb * db;
        let vc = two * s.ac * da;
        let (a, c) = (two * s.a, two * s.c);
        let (mut gp, mut gq) = (dp, dq);
        for i in 0..3 {
            gp[i] = va.fma(p[i], vb.fma(q[i], a.fma(dp[i], s.b * dq[i])));
            gq[i] = vb.fma(p[i], vc.fma(q[i], s.b.fma(dp[i], c * dq[i])));
        }
        self.lift(&gp, &gq)
    }

    /// Adds `s` times the second derivative of κ².
    #[inline(always)]
    pub fn add_hessian(&self, s: R, out: &mut Reduced<R>) {
        let (k, p, q, il) = (&self.square, &self.p, &self.q, self.il);
        let two = s + s;
        let (aa, ab, ac, bb) = ((two + two) * k.aa, two * k.ab, (two + two) * k.ac, s * k.bb);
        // the second derivatives by r' and r'' are pp = u pᵀ + v qᵀ + a I, pq = (v pᵀ + ac p qᵀ + b I)/L and
        // qq = (bb p pᵀ + c I)/L², the powers of L being those of r'' by the natural variables
        let (a, b, c) = (two * k.a, s * k.b * il, two * k.c * il * il);
        let (mut u, mut v, mut vl, mut w, mut bp) = (*p, *p, *p, *p, *p);
        for i in 0..3 {
            u[i] = aa.fma(p[i], ab * q[i]);
            v[i] = ab.fma(p[i], bb * q[i]);
            vl[i] = il * v[i];
            w[i] = il * ac * p[i];
            bp[i] = il * il * bb * p[i];
        }
        let ([_, f1, f2], [s1, s2]) = (self.phi, self.psi);
        for i in 0..3 {
            for j in i..3 {
                let mut pp = u[i].fma(p[j], v[i] * q[j]);
                let mut qq = bp[i] * p[j];
                let (mut pq, mut qp) = (vl[i].fma(p[j], w[i] * q[j]), vl[j].fma(p[i], w[j] * q[i]));
                if i == j {
                    (pp, pq, qq) = (pp + a, pq + b, qq + c);
                    qp = pq;
                }
                let both = pq + qp;
                let mut add = |b: usize, i: usize, j: usize, x: R| out.k[b][i][j] += x;
                add(block(0, 0), i, j, pp);
                add(block(1, 1), i, j, blend(f1 * f1, pp, f1 * s1, both, s1 * s1, qq));
                add(block(2, 2), i, j, blend(f2 * f2, pp, f2 * s2, both, s2 * s2, qq));
                let common = R::of(f1 * f2).fma(pp, R::of(s1 * s2) * qq);
                for (r, c, pq, qp) in [(i, j, pq, qp), (j, i, qp, pq)] {
                    add(block(0, 1), r, c, R::of(f1).fma(pp, R::of(s1) * pq));
                    add(block(0, 2), r, c, R::of(f2).fma(pp, R::of(s2) * pq));
                    add(block(1, 2), r, c, R::of(f1 * s2).fma(pq, R::of(s1 * f2).fma(qp, common)));
                    if i == j {
                        break;
                    }
                }
            }
        }
    }
}

/// The natural force of a force `gp` on `r'` and `gq` on `r''` at a point.
#[inline(always)]
pub(super) fn lift<R: Real>(at: &Point, il: R, gp: &V3<R>, gq: &V3<R>) -> Natural<R> {
    lift_by(&at.phi, &at.psi, il, gp, gq)
}

#[inline(always)]
fn lift_by<R: Real>(phi: &[f64; 3], psi: &[f64; 2], il: R, gp: &V3<R>, gq: &V3<R>) -> Natural<R> {
    let mut g = [*gp; 3];
    for i in 1..3 {
        for c in 0..3 {
            g[i][c] = R::of(phi[i]).fma(gp[c], il * R::of(psi[i - 1]) * gq[c]);
        }
    }
    g
}

/// `a x + b y + c z`
#[inline(always)]
fn blend<R: Real>(a: f64, x: R, b: f64, y: R, c: f64, z: R) -> R {
    R::of(a).fma(x, R::of(b).fma(y, R::of(c) * z))
}

/// Strain energy of bending, `½ EI L Σ w κ²`.
#[inline(always)]
pub fn bending_energy<T: Transverse, Q: Quadrature, R: Real>(
    model: T,
    rule: Q,
    ei: R,
    l: R,
    il: R,
    q: &Natural<R>,
) -> R {
    let mut sum = R::zero();
    for at in rule.points() {
        sum = R::of(at.w).fma(Curve::new(model, q, at, il).square.value, sum);
    }
    R::of(0.5) * ei * l * sum
}
