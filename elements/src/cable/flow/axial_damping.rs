//! Damping of stretching in a flowing cable, at the strain rate that its material sees.
//!
//! Material that runs along an element at `ṗ` is strained at `ε̇ = ∂ε/∂t - ṗ ε'`. The element has its strain at the points of
//! its quadrature only, so `ε'` is that of the polynomial through them: the curve itself stretches in between by about
//! `(κL)⁴`, which no force answers to, and `ṗ` times its derivative would be a strain rate that isn't there. Force on dofs
//! and boundaries is that of the dissipated power `∫ η EA ε̇² dx`, whose half is its potential by the rates.

use super::embedding::{Embedding, Grid};
use super::for_fronts;
use crate::cable::longitudinal::{Longitudinal, Strain};
use crate::cable::quadrature::{MOST, Point, Quadrature};
use crate::cable::reduced::Reduced;
use crate::cable::shape::{Natural, natural};
use ropewalk_core::{Batch, Dual, Element, Local, Power, Real, Share, Weights, dot};

/// Axial damping of an element through which material flows, for models with a strain at several points.
#[derive(Clone, Copy, Debug)]
pub struct FlowAxialDamping<L, Q, const F: usize> {
    /// `η EA` [N s].
    pub eta_ea: f64,
    /// Embedding of the element.
    pub by: Embedding<F>,
    /// Axial strain.
    pub model: L,
    /// Where it is taken.
    pub rule: Q,
}

impl<L, Q, const F: usize> FlowAxialDamping<L, Q, F> {
    /// The damping of an element with this embedding.
    pub fn new(eta_ea: f64, by: Embedding<F>, model: L, rule: Q) -> Self {
        FlowAxialDamping { eta_ea, by, model, rule }
    }
}

/// Derivative at point `i` of the polynomial that is one at point `k` and zero at the others.
fn slope(points: &[Point], i: usize, k: usize) -> f64 {
    let others = |m: usize| (0..points.len()).filter(move |&j| j != k && j != m);
    let x = |j: usize| points[j].xi;
    let product = |m: usize| others(m).map(|j| (x(i) - x(j)) / (x(k) - x(j))).product::<f64>();
    (0..points.len()).filter(|&m| m != k).map(|m| product(m) / (x(k) - x(m))).sum()
}

/// Strain rate at a point, with what it changes by.
#[derive(Clone, Copy)]
struct Rate<R> {
    value: R,
    /// By the rates of the natural variables.
    gradient: Natural<R>,
    /// By the rates of the material coordinates of both nodes.
    boundaries: [R; 2],
}

/// The strain rates of the material at all points.
#[inline(always)]
fn rates<L: Longitudinal, Q: Quadrature, R: Real>(
    (model, rule): (L, Q),
    g: &Grid<R>,
    q: &[R],
    v: &[R],
) -> [Option<Rate<R>>; MOST] {
    let take = |x: &[R]| std::array::from_fn::<R, 12, _>(|i| x[i]);
    let (q, mut rate) = (natural(&take(q), g.il), natural(&take(v), g.il));
    // the chord per length changes with the length as well
    let mut longer = [[R::zero(); 3]; 3];
    for c in 0..3 {
        let chord = g.il * q[0][c];
        longer[0][c] = -chord;
        longer[1][c] = chord;
        longer[2][c] = chord;
        for i in 0..3 {
            rate[i][c] += g.ld * longer[i][c];
        }
    }
    let points = model.points(rule);
    let mut eps = [R::zero(); MOST];
    for (eps, at) in eps.iter_mut().zip(points) {
        *eps = model.strain(&q, at).eps();
    }
    let mut out = [None; MOST];
    for (i, at) in points.iter().enumerate() {
        let strain = model.strain(&q, at);
        let gradient = strain.gradient();
        let mut along = R::zero();
        for k in 0..points.len() {
            along += R::of(slope(points, i, k)) * eps[k];
        }
        along = g.il * along;
        let by_length =
            dot(&gradient[0], &longer[0]) + dot(&gradient[1], &longer[1]) + dot(&gradient[2], &longer[2]);
        let boundaries = [-(R::of(1.0 - at.xi) * along) - by_length, by_length - R::of(at.xi) * along];
        let passing = R::of(1.0 - at.xi).fma(g.pd[0], R::of(at.xi) * g.pd[1]);
        out[i] = Some(Rate { value: strain.rate(&rate) - passing * along, gradient, boundaries });
    }
    out
}

macro_rules! element {
    ($boundaries:literal, $size:literal) => {
        impl<L: Longitudinal, Q: Quadrature> FlowAxialDamping<L, Q, $boundaries> {
            #[inline(always)]
            fn force<R: Real>(
                (model, rule): (L, Q),
                eta_ea: R,
                by: &Embedding<$boundaries, R>,
                x: &Local<R, $size, $size>,
            ) -> [R; $size] {
                let g = Grid::new(by, x);
                let (mut local, mut out) = (Reduced::zero(), [R::zero(); $size]);
                for (rate, at) in
                    rates((model, rule), &g, &x.q, &x.v).iter().flatten().zip(model.points(rule))
                {
                    let force = eta_ea * g.l * R::of(at.w) * rate.value;
                    local.add_force(force, &rate.gradient);
                    for k in 0..$boundaries {
                        let moved = by.by[k][0].fma(rate.boundaries[0], by.by[k][1] * rate.boundaries[1]);
                        out[12 + k] += force * moved;
                    }
                }
                let mut own = Share::<R, 12>::zero();
                local.spread_force::<true>(g.il, &mut own);
                out[..12].copy_from_slice(&own.r);
                out
            }
        }

        impl<L: Longitudinal, Q: Quadrature> Element<$size, $size> for FlowAxialDamping<L, Q, $boundaries> {
            type Lanes<R: Real> = (R, Embedding<$boundaries, R>, L, Q);
            const WIDE: bool = false;

            fn label(&self) -> String {
                format!("axial damping {} {} of a flowing cable", self.model.label(), self.rule.label())
            }
            fn symmetric(&self) -> bool {
                false
            }
            #[inline(always)]
            fn lanes<R: Real>(b: &Batch<'_, Self>) -> Self::Lanes<R> {
                let &FlowAxialDamping { model, rule, .. } = b.first();
                (b.get(|e| e.eta_ea), Embedding::lanes(|f, j| b.get(|e| f(&e.by, j))), model, rule)
            }
            #[inline(always)]
            fn add<R: Real, const TANGENT: bool>(
                &(eta_ea, ref by, model, rule): &Self::Lanes<R>,
                x: &Local<R, $size, $size>,
                w: &Weights,
                out: &mut Share<R, $size>,
            ) {
                let force = Self::force((model, rule), eta_ea, by, x);
                for i in 0..$size {
                    out.r[i] += force[i];
                }
                if !TANGENT {
                    return;
                }
                let lift = |x: &[R; 2]| x.map(Dual::constant);
                let by = Embedding { fixed: lift(&by.fixed), by: by.by.each_ref().map(lift) };
                let mut at = Local {
                    q: Dual::constants(&x.q),
                    v: Dual::constants(&x.v),
                    a: Dual::constants(&x.a),
                    last: Dual::constants(&x.last),
                    relaxed: None,
                };
                for j in 0..$size {
                    (at.q[j].eps, at.v[j].eps) = (R::of(w.q), R::of(w.v));
                    let force = Self::force((model, rule), Dual::constant(eta_ea), &by, &at);
                    (at.q[j].eps, at.v[j].eps) = (R::zero(), R::zero());
                    for i in 0..$size {
                        out.k[i][j] += force[i].eps;
                    }
                }
            }
            #[inline(always)]
            fn power<R: Real>(
                &(eta_ea, ref by, model, rule): &Self::Lanes<R>,
                x: &Local<R, $size, $size>,
            ) -> Power<R> {
                let g = Grid::new(by, x);
                let mut dissipated = R::zero();
                for (rate, at) in
                    rates((model, rule), &g, &x.q, &x.v).iter().flatten().zip(model.points(rule))
                {
                    dissipated += eta_ea * g.l * R::of(at.w) * rate.value * rate.value;
                }
                Power { dissipated, ..Power::zero() }
            }
        }
    };
}
for_fronts!((1, 13), (2, 14); element);
