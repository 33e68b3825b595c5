//! Where distributed loads act on a cable through which material flows.

use super::element::nodal_dual;
use super::embedding::{Embedding, Grid};
use super::for_fronts;
use super::rule::close;
use super::transport::{Row, Transport, nodal, row_times};
use crate::cable::quadrature::{Gauss4, Point};
use crate::cable::shape::{hermite, hermite_slope};
use crate::cable::stations::BEFORE;
use ropewalk_core::{Batch, Dual, Gives, Load, Local, Real, Share, Station, StationElement, V3, Weights};

/// The stations of one element of a flowing cable. Loads are per unstretched length and see the velocity of the
/// material. The acceleration is that of the material where `slip` is zero; else that of the curve, taken at a fixed distance
/// along it from the end that feeds, which Morison's added mass asks for: water that a cable pushes aside doesn't see what
/// runs along inside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlowStations<const F: usize, R = f64> {
    /// Embedding of the element.
    pub by: Embedding<F, R>,
    /// By how much each boundary's feeding makes the material run along the curve here.
    pub slip: [R; F],
    /// Hydrodynamic diameter [m].
    pub diameter: R,
    /// Area of the displaced volume per length [m²].
    pub area: R,
}

/// Kinematics at a station.
struct Place<R> {
    /// Shape functions, and their derivatives along the material.
    s: Row<R>,
    ds: Row<R>,
    /// Second derivative of the curve by the dofs.
    bend: Row<R>,
    x: V3<R>,
    slope: V3<R>,
    slope_rate: V3<R>,
    v: V3<R>,
    a: V3<R>,
}

impl<R: Real> Place<R> {
    #[inline(always)]
    fn new(at: &Point, g: &Grid<R>, c: R, e: &[V3<R>; 4], t: &Transport<R>) -> Self {
        let (s, ds) = (hermite(at.xi, g.l), hermite_slope(at.xi, g.il));
        let both = R::of(at.psi[0] + at.psi[1]) * g.il * g.il;
        let bend = [both, R::of(at.psi[0]) * g.il, -both, R::of(at.psi[1]) * g.il];
        let (r2, v_p) = (row_times(&bend, e), row_times(&ds, &t.v));
        let mut a = row_times(&s, &t.a);
        for i in 0..3 {
            a[i] += c * (v_p[i] + v_p[i] + c * r2[i]);
        }
        Place {
            x: row_times(&s, e),
            slope: row_times(&ds, e),
            slope_rate: v_p,
            v: row_times(&s, &t.v),
            a,
            s,
            ds,
            bend,
        }
    }
}

/// The rate at which material runs along the curve.
#[inline(always)]
fn slip<R: Real, const F: usize, const N: usize>(p: &FlowStations<F, R>, x: &Local<R, N, N>) -> R {
    let mut c = R::zero();
    for k in 0..F {
        c = p.slip[k].fma(x.v[12 + k], c);
    }
    c
}

/// `m v` of a matrix of derivatives that is given, else nothing.
#[inline(always)]
fn add_times<R: Real>(m: &[V3<R>; 3], x: &V3<Dual<R>>, out: &mut V3<R>) {
    for r in 0..3 {
        for c in 0..3 {
            out[r] = m[r][c].fma(x[c].eps, out[r]);
        }
    }
}

macro_rules! stations {
    ($boundaries:literal, $size:literal) => {
        impl StationElement<$size, $size, 4> for FlowStations<$boundaries> {
            const COUPLES: bool = true;
            type Lanes<R: Real> = FlowStations<$boundaries, R>;

            #[inline(always)]
            fn lanes<R: Real>(b: &Batch<'_, Self>) -> FlowStations<$boundaries, R> {
                let mut slip = [R::zero(); $boundaries];
                for k in 0..$boundaries {
                    slip[k] = b.get(|e| e.slip[k]);
                }
                FlowStations {
                    by: Embedding::lanes(|f, j| b.get(|e| f(&e.by, j))),
                    slip,
                    diameter: b.get(|e| e.diameter),
                    area: b.get(|e| e.area),
                }
            }

            #[inline(always)]
            fn station<R: Real>(
                p: &FlowStations<$boundaries, R>,
                x: &Local<R, $size, $size>,
                k: usize,
            ) -> Station<R> {
                let at = &Gauss4::POINTS[k];
                let (g, e, ed) = (Grid::new(&p.by, x), nodal(&x.q), nodal(&x.v));
                let t = Transport::new(&g, &e, &ed, &nodal(&x.a));
                let place = Place::new(at, &g, slip(p, x), &e, &t);
                Station {
                    x: place.x,
                    v: place.v,
                    a: place.a,
                    slope: place.slope,
                    slope_rate: place.slope_rate,
                    s: R::of(at.xi).fma(g.l, g.p),
                    weight: R::of(at.w) * g.l,
                    before: R::of(BEFORE[k]) * g.l,
                    element: g.l,
                    diameter: p.diameter,
                    area: p.area,
                    who: 0,
                }
            }

            #[inline(always)]
            fn spread<R: Real, const TANGENT: bool>(
                p: &FlowStations<$boundaries, R>,
                x: &Local<R, $size, $size>,
                loads: &[Load<R>; 4],
                gives: Gives,
                w: &Weights,
                out: &mut Share<R, $size>,
            ) {
                *out = Share::zero();
                let (g, c) = (Grid::new(&p.by, x), slip(p, x));
                let (e, ed, edd) = (nodal(&x.q), nodal(&x.v), nodal(&x.a));
                let t = Transport::new(&g, &e, &ed, &edd);
                let mut f = [[R::zero(); 3]; 4];
                let mut d_f = [f; $boundaries];
                let (p4, h4) = Transport::matrices(&g);
                let (wq, wv, wa) = (R::of(w.q), R::of(w.v), R::of(w.a));
                for (k, at) in Gauss4::POINTS.iter().enumerate() {
                    let (load, place) = (&loads[k], Place::new(at, &g, c, &e, &t));
                    let (force, couple) = (load.f, load.g);
                    let weight = R::of(-at.w) * g.l;
                    for i in 0..4 {
                        for d in 0..3 {
                            f[i][d] = (weight * place.s[i]).fma(force[d], f[i][d]);
                            if gives.couple {
                                f[i][d] = (weight * place.ds[i]).fma(couple[d], f[i][d]);
                            }
                        }
                    }
                    if !TANGENT {
                        continue;
                    }
                    let (s, ds) = (&place.s, &place.ds);
                    for j in 0..4 {
                        // velocity and acceleration by dof j, with the weights of the tangent
                        let mut v = wv * s[j];
                        let mut a = wa.fma(s[j], c * ((wv + wv) * ds[j] + c * wq * place.bend[j]));
                        let mut rate = wv * ds[j];
                        for i in 0..4 {
                            let by = wq * p4[i][j];
                            v -= s[i] * by;
                            rate -= ds[i] * by;
                            a += s[i] * (wq * h4[i][j] - (wv + wv) * p4[i][j]) - (c + c) * ds[i] * by;
                        }
                        for r in 0..3 {
                            for q in 0..3 {
                                let mut sum = R::zero();
                                if gives.x {
                                    sum = (wq * s[j]).fma(load.d_x[r][q], sum);
                                }
                                if gives.slope {
                                    sum = (wq * ds[j]).fma(load.d_slope[r][q], sum);
                                }
                                if gives.v {
                                    sum = v.fma(load.d_v[r][q], sum);
                                }
                                if gives.a {
                                    sum = a.fma(load.d_a[r][q], sum);
                                }
                                let mut couple = R::zero();
                                if gives.couple {
                                    sum = rate.fma(load.d_rate[r][q], sum);
                                    couple = (wq * s[j]).fma(load.g_x[r][q], v * load.g_v[r][q]);
                                    couple = (wq * ds[j]).fma(load.g_slope[r][q], couple);
                                }
                                for i in 0..4 {
                                    let k = &mut out.k[3 * i + r][3 * j + q];
                                    *k = (weight * s[i]).fma(sum, *k);
                                    if gives.couple {
                                        *k = (weight * ds[i]).fma(couple, *k);
                                    }
                                }
                            }
                        }
                    }
                }
                for i in 0..12 {
                    out.r[i] = f[i / 3][i % 3];
                }
                if TANGENT {
                    let (e, ed, edd) = (nodal_dual(&e), nodal_dual(&ed), nodal_dual(&edd));
                    for k in 0..$boundaries {
                        let g = g.towards(&p.by, k, w);
                        let c = Dual::new(c, wv * p.slip[k]);
                        let t = Transport::new(&g, &e, &ed, &edd);
                        for (station, at) in Gauss4::POINTS.iter().enumerate() {
                            let load = &loads[station];
                            let (force, own) = (load.f, load.g);
                            let place = Place::new(at, &g, c, &e, &t);
                            let mut d = [R::zero(); 3];
                            if gives.x {
                                add_times(&load.d_x, &place.x, &mut d);
                            }
                            if gives.slope {
                                add_times(&load.d_slope, &place.slope, &mut d);
                            }
                            if gives.v {
                                add_times(&load.d_v, &place.v, &mut d);
                            }
                            if gives.a {
                                add_times(&load.d_a, &place.a, &mut d);
                            }
                            let mut d_g = [R::zero(); 3];
                            if gives.couple {
                                add_times(&load.d_rate, &place.slope_rate, &mut d);
                                add_times(&load.g_x, &place.x, &mut d_g);
                                add_times(&load.g_slope, &place.slope, &mut d_g);
                                add_times(&load.g_v, &place.v, &mut d_g);
                            }
                            for i in 0..4 {
                                let weight = Dual::of(-at.w) * g.l;
                                let (share, couple) = (weight * place.s[i], weight * place.ds[i]);
                                for r in 0..3 {
                                    d_f[k][i][r] += share.eps * force[r] + share.re * d[r];
                                    if gives.couple {
                                        d_f[k][i][r] += couple.eps * own[r] + couple.re * d_g[r];
                                    }
                                }
                            }
                        }
                    }
                }
                close::<R, $boundaries, $size, TANGENT>(&p.by, &g, &x.q, &f, &d_f, w, out);
            }
        }
    };
}
for_fronts!((1, 13), (2, 14); stations);
