//! Where distributed loads act on a cable element: four Gauss points, exact for loads up to degree four.

use super::quadrature::Gauss4;
use super::shape::{combine, hermite, hermite_slope, natural};
use ropewalk_core::{Batch, Gives, Load, Local, Real, Share, Station, StationElement, V3, Weights};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The stations of one cable element. Loads are per unstretched length.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CableStations<R = f64> {
    /// Unstretched length `L` [m].
    pub l: R,
    /// Unstretched arc length at the element's start [m].
    pub s0: R,
    /// Hydrodynamic diameter [m].
    pub diameter: R,
    /// Area of the displaced volume per length [m²].
    pub area: R,
}

/// How much of its cell lies before each station, in parts of the element: cells are as long as the weights.
pub(super) const BEFORE: [f64; 4] = {
    let (mut before, mut start, mut k) = ([0.0; 4], 0.0, 0);
    while k < 4 {
        before[k] = Gauss4::POINTS[k].xi - start;
        start += Gauss4::POINTS[k].w;
        k += 1;
    }
    before
};

/// `Σ S_i e_i`
#[inline(always)]
fn interpolate<R: Real>(s: &[R; 4], e: &[R; 12]) -> V3<R> {
    let mut x = [R::zero(); 3];
    for c in 0..3 {
        x[c] = s[0].fma(e[c], s[1].fma(e[3 + c], s[2].fma(e[6 + c], s[3] * e[9 + c])));
    }
    x
}

impl StationElement<12, 12, 4> for CableStations {
    const FIXED: bool = true;
    const COUPLES: bool = true;
    type Lanes<R: Real> = CableStations<R>;

    #[inline(always)]
    fn lanes<R: Real>(batch: &Batch<'_, Self>) -> CableStations<R> {
        CableStations {
            l: batch.get(|e| e.l),
            s0: batch.get(|e| e.s0),
            diameter: batch.get(|e| e.diameter),
            area: batch.get(|e| e.area),
        }
    }

    #[inline(always)]
    fn station<R: Real>(p: &CableStations<R>, x: &Local<R, 12, 12>, k: usize) -> Station<R> {
        let at = &Gauss4::POINTS[k];
        let il = R::of(1.0) / p.l;
        let s = hermite(at.xi, p.l);
        let v = interpolate(&s, &x.v);
        Station {
            x: interpolate(&s, &x.q),
            v,
            a: interpolate(&s, &x.a),
            slope: combine(&at.phi, &natural(&x.q, il)),
            slope_rate: combine(&at.phi, &natural(&x.v, il)),
            s: R::of(at.xi).fma(p.l, p.s0),
            weight: R::of(at.w) * p.l,
            before: R::of(BEFORE[k]) * p.l,
            element: p.l,
            diameter: p.diameter,
            area: p.area,
            who: 0,
        }
    }

    #[inline(always)]
    fn spread<R: Real, const TANGENT: bool>(
        p: &CableStations<R>,
        _: &Local<R, 12, 12>,
        loads: &[Load<R>; 4],
        gives: Gives,
        w: &Weights,
        out: &mut Share<R, 12>,
    ) {
        let il = R::of(1.0) / p.l;
        // shape functions and weights of the stations, with the sign that loads have in a residual
        let (mut s, mut d, mut weight) = ([[R::zero(); 4]; 4], [[R::zero(); 4]; 4], [R::zero(); 4]);
        for (k, at) in Gauss4::POINTS.iter().enumerate() {
            (s[k], d[k]) = (hermite(at.xi, p.l), hermite_slope(at.xi, il));
            weight[k] = R::of(-at.w) * p.l;
        }
        let mut force = [[R::zero(); 3]; 4];
        for k in 0..4 {
            let Load { f, g, .. } = &loads[k];
            for i in 0..4 {
                for c in 0..3 {
                    force[i][c] = s[k][i].fma(weight[k] * f[c], force[i][c]);
                }
            }
            if gives.couple {
                for i in 0..4 {
                    for c in 0..3 {
                        force[i][c] = d[k][i].fma(weight[k] * g[c], force[i][c]);
                    }
                }
            }
        }
        for i in 0..12 {
            out.r[i] = force[i / 3][i % 3];
        }
        if !TANGENT {
            return;
        }
        let (wq, wv, wa) = (R::of(w.q), R::of(w.v), R::of(w.a));
        let couples = gives.couple && (w.q != 0.0 || w.v != 0.0);
        for r in 0..3 {
            for c in 0..3 {
                let mut block = [[R::zero(); 4]; 4];
                for k in 0..4 {
                    let (load, mut by_x, mut by_slope) = (&loads[k], R::zero(), R::zero());
                    if gives.x {
                        by_x = wq * load.d_x[r][c];
                    }
                    if gives.v {
                        by_x = wv.fma(load.d_v[r][c], by_x);
                    }
                    if gives.a {
                        by_x = wa.fma(load.d_a[r][c], by_x);
                    }
                    if gives.slope {
                        by_slope = weight[k] * wq * load.d_slope[r][c];
                    }
                    if couples {
                        by_slope = (weight[k] * wv).fma(load.d_rate[r][c], by_slope);
                    }
                    by_x = weight[k] * by_x;
                    for j in 0..4 {
                        let column = s[k][j].fma(by_x, d[k][j] * by_slope);
                        for i in 0..4 {
                            block[i][j] = s[k][i].fma(column, block[i][j]);
                        }
                    }
                    if couples {
                        let by_x = weight[k] * wq.fma(load.g_x[r][c], wv * load.g_v[r][c]);
                        let by_slope = weight[k] * wq * load.g_slope[r][c];
                        for j in 0..4 {
                            let column = s[k][j].fma(by_x, d[k][j] * by_slope);
                            for i in 0..4 {
                                block[i][j] = d[k][i].fma(column, block[i][j]);
                            }
                        }
                    }
                }
                for i in 0..4 {
                    for j in 0..4 {
                        out.k[3 * i + r][3 * j + c] = block[i][j];
                    }
                }
            }
        }
    }
}
