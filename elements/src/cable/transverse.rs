//! Transverse models: what an element calls its curvature.
//!
//! A model gives κ² as a function of the invariants `a = r'·r'`, `b = r'·r''`, `c = r''·r''` of the first two
//! derivatives of the curve. κ itself, with its root, is never differentiated: a straight element has κ = 0, and its
//! derivatives there are 0/0. Strain energy `½ EI ∫ κ² dx`.

use super::quadrature::{Point, Quadrature};
use super::reduced::{M3, Reduced};
use super::shape::{Natural, combine, second};
use ropewalk_core::{Real, V3, dot};

/// A transverse model.
pub trait Transverse: Copy + Send + Sync + 'static {
    /// Short name, for labels.
    const LABEL: &'static str;
    /// κ² and its derivatives.
    fn square<R: Real>(i: &Invariants<R>) -> Square<R>;
    /// Adds the bending force, and with `TANGENT` its derivative; `il = 1/L`.
    #[inline(always)]
    fn add<Q: Quadrature, R: Real, const TANGENT: bool>(
        ei: R,
        l: R,
        il: R,
        q: &Natural<R>,
        out: &mut Reduced<R>,
    ) {
        for at in Q::POINTS {
            let curve = Curve::new::<Self>(q, at, il);
            let s = ei * l * R::of(0.5 * at.w);
            curve.add_force(s, out);
            if TANGENT {
                curve.add_hessian(s, out);
            }
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
    /// `∂r''/∂q`; the first is zero.
    pub psi: [R; 3],
    /// Squared curvature.
    pub square: Square<R>,
}

impl<R: Real> Curve<R> {
    /// The point `at` of the curve with natural variables `nat`.
    #[inline(always)]
    pub fn new<T: Transverse>(nat: &Natural<R>, at: &Point, il: R) -> Self {
        let (p, q) = (combine(&at.phi, nat), second(&at.psi, il, nat));
        let x: V3<R> = [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]];
        let i = Invariants { a: dot(&p, &p), b: dot(&p, &q), c: dot(&q, &q), d: dot(&x, &x) };
        let psi = [R::zero(), il * R::of(at.psi[0]), il * R::of(at.psi[1])];
        Curve { p, q, phi: at.phi, psi, square: T::square(&i) }
    }

    /// The natural force of a force `gp` on `r'` and `gq` on `r''`.
    #[inline(always)]
    fn lift(&self, gp: &V3<R>, gq: &V3<R>) -> Natural<R> {
        let mut g = [*gp; 3];
        for i in 1..3 {
            for c in 0..3 {
                g[i][c] = R::of(self.phi[i]).fma(gp[c], self.psi[i] * gq[c]);
            }
        }
        g
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
        let mut dq = dp;
        for c in 0..3 {
            dq[c] = self.psi[1].fma(v[1][c], self.psi[2] * v[2][c]);
        }
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
        let (k, p, q) = (&self.square, &self.p, &self.q);
        let two = s + s;
        let (aa, ab, ac, bb) = ((two + two) * k.aa, two * k.ab, (two + two) * k.ac, s * k.bb);
        let (a, b, c) = (two * k.a, s * k.b, two * k.c);
        let mut pp: M3<R> = [[R::zero(); 3]; 3];
        let (mut pq, mut qq) = (pp, pp);
        for i in 0..3 {
            // rows of the three second derivatives by r' and r''
            let (up, uq) = (aa.fma(p[i], ab * q[i]), ab.fma(p[i], bb * q[i]));
            let (vp, vq, bp) = (ab.fma(p[i], bb * q[i]), ac * p[i], bb * p[i]);
            for j in 0..3 {
                pq[i][j] = vp.fma(p[j], vq * q[j]);
            }
            for j in i..3 {
                pp[i][j] = up.fma(p[j], uq * q[j]);
                qq[i][j] = bp * p[j];
                pp[j][i] = pp[i][j];
                qq[j][i] = qq[i][j];
            }
            pp[i][i] += a;
            pq[i][i] += b;
            qq[i][i] += c;
        }
        for r in 0..3 {
            for c in r..3 {
                out.k[0][0][r][c] += pp[r][c];
            }
        }
        for i in 1..3 {
            let (fi, si) = (R::of(self.phi[i]), self.psi[i]);
            let mut rows_p = pp;
            let mut rows_q = qq;
            for r in 0..3 {
                for c in 0..3 {
                    out.k[0][i][r][c] += fi.fma(pp[r][c], si * pq[r][c]);
                    rows_p[r][c] = fi.fma(pp[r][c], si * pq[c][r]);
                    rows_q[r][c] = fi.fma(pq[r][c], si * qq[r][c]);
                }
            }
            for j in i..3 {
                let (fj, sj) = (R::of(self.phi[j]), self.psi[j]);
                for r in 0..3 {
                    for c in (if i == j { r } else { 0 })..3 {
                        let k = &mut out.k[i][j][r][c];
                        *k = fj.fma(rows_p[r][c], sj.fma(rows_q[r][c], *k));
                    }
                }
            }
        }
    }
}

/// Strain energy of bending, `½ EI L Σ w κ²`.
#[inline(always)]
pub fn bending_energy<T: Transverse, Q: Quadrature>(ei: f64, l: f64, q: &Natural<f64>) -> f64 {
    let sum: f64 = Q::POINTS.iter().map(|at| at.w * Curve::new::<T>(q, at, 1.0 / l).square.value).sum();
    0.5 * ei * l * sum
}
