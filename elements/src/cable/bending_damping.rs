//! Kelvin–Voigt damping of bending.

use super::quadrature::{Point, Points, Quadrature};
use super::reduced::{Product, Reduced, add_products};
use super::shape::{Natural, combine, natural, second};
use super::transverse::lift;
use ropewalk_core::{Batch, Dual, Element, Local, Power, Real, Share, V3, Weights, dot};

/// Damping of bending: the moment `η EI` times the rate of the curvature vector, besides the elastic one.
///
/// The rate is that relative to a frame which turns with the tangent `t` and doesn't spin about it: with
/// `ṫ = P ṙ'/λ`, `P = I - t tᵀ` and `λ = |r'|` it is
///
/// `β = P ∂ṫ/∂x = [P ṙ'' - (t·r''/λ) P ṙ' - (t·ṙ'/λ) P r'']/λ`,
///
/// and the dissipated power is `∫ η EI |β|² dx`. Damping is the same for a straight cable and a bent one, in its plane and
/// out of it, however small the motion: small vibrations of a straight cable have damping ratios of `ηω/2`. A shape that
/// whirls about the line between its ends is damped too, for its fibres are strained to and fro. A bent cable that turns as
/// a rigid body loses nothing unless it turns about its own tangent, which its centre line can't tell from whirling: with torsion [`SectionDamping`](super::SectionDamping) can.
#[derive(Clone, Copy, Debug)]
pub struct BendingDamping {
    /// Unstretched length [m].
    pub l: f64,
    /// `η EI` [N m² s].
    pub eta_ei: f64,
    /// Where the curvature is taken.
    pub rule: Points,
}

/// Properties over lanes, and the quadrature of all of them.
#[derive(Clone, Copy, Debug)]
pub struct BendingDampingLanes<R> {
    /// Unstretched length.
    pub l: R,
    /// `η EI`.
    pub eta_ei: R,
    /// Where the curvature is taken.
    pub rule: Points,
}

impl BendingDamping {
    /// For an element of length `l`.
    pub fn new(l: f64, eta_ei: f64, rule: impl Quadrature) -> Self {
        BendingDamping { l, eta_ei, rule: Points::of(rule) }
    }
}

/// A point of the curve: `r'` and `r''`, and their rates.
struct Bend<R> {
    slope: V3<R>,
    second: V3<R>,
    slope_rate: V3<R>,
    second_rate: V3<R>,
}

impl<R: Real> Bend<R> {
    #[inline(always)]
    fn new(at: &Point, il: R, q: &Natural<R>, v: &Natural<R>) -> Self {
        Bend {
            slope: combine(&at.phi, q),
            second: second(&at.psi, il, q),
            slope_rate: combine(&at.phi, v),
            second_rate: second(&at.psi, il, v),
        }
    }

    /// `1/λ`, `t`, `t·r''` and `β`.
    #[inline(always)]
    fn rate(&self) -> (R, V3<R>, R, V3<R>) {
        let i = R::of(1.0) / dot(&self.slope, &self.slope).sqrt();
        let t = self.slope.map(|x| i * x);
        let (along, spread) = (dot(&t, &self.second), dot(&t, &self.slope_rate));
        let mut beta = self.second_rate;
        for c in 0..3 {
            beta[c] -= i * along.fma(self.slope_rate[c], spread * self.second[c]);
        }
        let axial = dot(&t, &beta);
        for c in 0..3 {
            beta[c] = i * (beta[c] - axial * t[c]);
        }
        (i, t, along, beta)
    }

    /// The forces `β ∂β/∂ṙ'` and `β ∂β/∂ṙ''`, conjugate to `r'` and `r''`.
    #[inline(always)]
    fn forces(&self) -> [V3<R>; 2] {
        let (i, t, along, beta) = self.rate();
        let bent = dot(&beta, &self.second);
        let (mut on_slope, mut on_second) = (beta, beta);
        for c in 0..3 {
            on_slope[c] = -(i * i) * along.fma(beta[c], bent * t[c]);
            on_second[c] = i * beta[c];
        }
        [on_slope, on_second]
    }

    /// Its derivatives by component `c` of `r'` (`which` = 0) or `r''`, with these weights of coordinates and rates.
    #[inline(always)]
    fn towards(&self, which: usize, c: usize, w: &Weights) -> Bend<Dual<R>> {
        let mut d = Bend {
            slope: Dual::constants(&self.slope),
            second: Dual::constants(&self.second),
            slope_rate: Dual::constants(&self.slope_rate),
            second_rate: Dual::constants(&self.second_rate),
        };
        let (x, rate) = match which {
            0 => (&mut d.slope, &mut d.slope_rate),
            _ => (&mut d.second, &mut d.second_rate),
        };
        (x[c].eps, rate[c].eps) = (R::of(w.q), R::of(w.v));
        d
    }
}

impl Element<12, 12> for BendingDamping {
    type Lanes<R: Real> = BendingDampingLanes<R>;

    fn label(&self) -> String {
        format!("bending damping {}", self.rule.label())
    }
    fn symmetric(&self) -> bool {
        false
    }
    fn has_tangent(w: &Weights) -> bool {
        w.q != 0.0 || w.v != 0.0
    }
    #[inline(always)]
    fn lanes<R: Real>(batch: &Batch<'_, Self>) -> Self::Lanes<R> {
        let rule = batch.first().rule;
        BendingDampingLanes { l: batch.get(|e| e.l), eta_ei: batch.get(|e| e.eta_ei), rule }
    }
    #[inline(always)]
    fn add<R: Real, const TANGENT: bool>(
        &BendingDampingLanes { l, eta_ei, rule }: &Self::Lanes<R>,
        x: &Local<R, 12, 12>,
        w: &Weights,
        out: &mut Share<R, 12>,
    ) {
        let il = R::of(1.0) / l;
        let (q, v) = (natural(&x.q, il), natural(&x.v, il));
        let mut local = Reduced::zero();
        for at in rule.points() {
            let bend = Bend::new(at, il, &q, &v);
            let s = eta_ei * l * R::of(at.w);
            let [on_slope, on_second] = bend.forces();
            local.add_force(s, &lift(at, il, &on_slope, &on_second));
            if TANGENT {
                let mut products = [None; 6];
                for (k, product) in products.iter_mut().enumerate() {
                    let (c, which) = (k / 2, k % 2);
                    let d = bend.towards(which, c, w).forces().map(|f| f.map(|x| x.eps));
                    let mut unit = [[R::zero(); 3]; 2];
                    unit[which][c] = R::of(1.0);
                    let (column, row) = (lift(at, il, &d[0], &d[1]), lift(at, il, &unit[0], &unit[1]));
                    *product = Product::new(s, &column, &row, il);
                }
                add_products(&products, out);
            }
        }
        local.spread_force::<false>(il, out);
    }
    #[inline(always)]
    fn power<R: Real>(
        &BendingDampingLanes { l, eta_ei, rule }: &Self::Lanes<R>,
        x: &Local<R, 12, 12>,
    ) -> Power<R> {
        let il = R::of(1.0) / l;
        let (q, v) = (natural(&x.q, il), natural(&x.v, il));
        let mut dissipated = R::zero();
        for at in rule.points() {
            let (_, _, _, beta) = Bend::new(at, il, &q, &v).rate();
            dissipated += eta_ei * l * R::of(at.w) * dot(&beta, &beta);
        }
        Power { dissipated, ..Power::zero() }
    }
}
