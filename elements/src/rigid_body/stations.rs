//! Where distributed loads act on a rigid body: Gauss points along the axis of a cylinder.

use ropewalk_core::rotation::{cross, matrix, times, transposed_times};
use ropewalk_core::{
    Batch, Gives, Load, Local, Real, Share, Station, StationElement, V3, Weights, dot, scaled,
};
use ropewalk_scene::Water;
use std::f64::consts::PI;

/// Places and weights of four Gauss points on `[0, 1]`, exact up to degree seven.
const GAUSS: [(f64, f64); 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_92),
    (0.330_009_478_207_571_87, 0.326_072_577_431_273_07),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_92),
];

/// A straight cylinder on a rigid body, along which drag and added mass act.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hull<R = f64> {
    /// One end of its axis, from the centre of mass in the body's axes [m].
    pub from: V3<R>,
    /// The axis, from that end to the other [m].
    pub axis: V3<R>,
    /// Its length [m].
    pub length: R,
    /// Place of its start along a chain of bodies [m].
    pub s0: R,
    /// Hydrodynamic diameter [m].
    pub diameter: R,
    /// Area of the displaced volume per length [m²].
    pub area: R,
}

/// Most parts of a hull.
const PARTS: usize = 1000;
/// Where the surface cuts a part, it takes loads of a whole station: the error goes with the square of the part's length, and is a
/// thousandth of the load of the hull where this is the length over `√(l / k)`, with the reach `l` of waves along the hull.
const CUT: f64 = 0.15;

impl Hull {
    /// Its equal parts, with stations each: in still water one, in waves as many as are shorter than half of the shortest wave (there
    /// four Gauss points are right to 1e-5), and so short that a surface that moves may cut them. `whole` is
    /// the length of what it is a link of [m].
    pub(crate) fn parts(self, whole: f64, water: Option<&Water>) -> impl Iterator<Item = Hull> + use<> {
        let parts = water.and_then(|water| water.sea.as_ref()).map_or(1, |sea| {
            let (waves, l) = (sea.waves(), self.length);
            let [k, shortest] = [waves.median(), waves.shortest()];
            let cut = CUT * (whole.min(1.0 / k) / k).sqrt();
            ((l * shortest / PI).max(l / cut).ceil() as usize).clamp(1, PARTS)
        });
        let share = 1.0 / parts as f64;
        let (axis, length) = (self.axis.map(|x| share * x), share * self.length);
        (0..parts).map(move |k| Hull {
            from: std::array::from_fn(|i| self.from[i] + k as f64 * axis[i]),
            s0: self.s0 + k as f64 * length,
            axis,
            length,
            ..self
        })
    }
}

impl<R: Real> Hull<R> {
    /// The station number `k` in the body's axes [m].
    #[inline(always)]
    fn arm(&self, k: usize) -> V3<R> {
        let xi = R::of(GAUSS[k].0);
        let mut s = self.from;
        for i in 0..3 {
            s[i] = xi.fma(self.axis[i], s[i]);
        }
        s
    }
    #[inline(always)]
    fn direction(&self) -> V3<R> {
        let il = R::of(1.0) / self.length;
        [self.axis[0] * il, self.axis[1] * il, self.axis[2] * il]
    }
}

/// Acceleration of a station beside the centre of mass, in the body's axes: `α × s + ω × (ω × s)`.
#[inline(always)]
fn swing<R: Real>(omega: &V3<R>, alpha: &V3<R>, s: &V3<R>) -> V3<R> {
    let (a, b) = (cross(alpha, s), cross(omega, &cross(omega, s)));
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

#[inline(always)]
fn sum<R: Real>(a: V3<R>, b: V3<R>) -> V3<R> {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

impl StationElement<7, 6, 4> for Hull {
    const COUPLES: bool = true;
    type Lanes<R: Real> = Hull<R>;

    #[inline(always)]
    fn lanes<R: Real>(b: &Batch<'_, Self>) -> Hull<R> {
        let mut hull = Hull {
            from: [R::zero(); 3],
            axis: [R::zero(); 3],
            length: b.get(|e| e.length),
            s0: b.get(|e| e.s0),
            diameter: b.get(|e| e.diameter),
            area: b.get(|e| e.area),
        };
        for i in 0..3 {
            hull.from[i] = b.get(|e| e.from[i]);
            hull.axis[i] = b.get(|e| e.axis[i]);
        }
        hull
    }

    #[inline(always)]
    fn station<R: Real>(p: &Hull<R>, x: &Local<R, 7, 6>, k: usize) -> Station<R> {
        let r = matrix(&[x.q[3], x.q[4], x.q[5], x.q[6]]);
        let (omega, alpha) = ([x.v[3], x.v[4], x.v[5]], [x.a[3], x.a[4], x.a[5]]);
        let s = p.arm(k);
        let v = sum([x.v[0], x.v[1], x.v[2]], times(&r, &cross(&omega, &s)));
        Station {
            x: sum([x.q[0], x.q[1], x.q[2]], times(&r, &s)),
            v,
            a: sum([x.a[0], x.a[1], x.a[2]], times(&r, &swing(&omega, &alpha, &s))),
            slope: times(&r, &p.direction()),
            slope_rate: times(&r, &cross(&omega, &p.direction())),
            s: R::of(GAUSS[k].0).fma(p.length, p.s0),
            weight: R::of(GAUSS[k].1) * p.length,
            before: R::of(GAUSS[k].0 - GAUSS[..k].iter().map(|g| g.1).sum::<f64>()) * p.length,
            element: R::zero(),
            diameter: p.diameter,
            area: p.area,
            who: 0,
        }
    }

    #[inline(always)]
    fn spread<R: Real, const TANGENT: bool>(
        p: &Hull<R>,
        x: &Local<R, 7, 6>,
        loads: &[Load<R>; 4],
        gives: Gives,
        w: &Weights,
        out: &mut Share<R, 6>,
    ) {
        let r = matrix(&[x.q[3], x.q[4], x.q[5], x.q[6]]);
        let (omega, alpha) = ([x.v[3], x.v[4], x.v[5]], [x.a[3], x.a[4], x.a[5]]);
        let (wq, wv, wa) = (R::of(w.q), R::of(w.v), R::of(w.a));
        *out = Share::zero();
        for k in 0..4 {
            let (load, s) = (&loads[k], p.arm(k));
            let weight = R::of(-GAUSS[k].1) * p.length;
            let f = scaled(weight, &load.f);
            let own = transposed_times(&r, &f);
            let moment = cross(&s, &own);
            for i in 0..3 {
                out.r[i] += f[i];
                out.r[3 + i] += moment[i];
            }
            // a couple turns the axis
            let axis = p.direction();
            let mut couple = [R::zero(); 3];
            if gives.couple {
                couple = transposed_times(&r, &scaled(weight, &load.g));
                let moment = cross(&axis, &couple);
                for i in 0..3 {
                    out.r[3 + i] += moment[i];
                }
            }
            if !TANGENT {
                continue;
            }
            let (turning, centripetal) = (cross(&omega, &s), swing(&omega, &alpha, &s));
            for j in 0..6 {
                // what a change of unknown j changes the load by: by its place, slope, velocity, acceleration
                let (mut unit, mut by_slope) = ([R::zero(); 3], [R::zero(); 3]);
                let (mut v_by_q, mut a_by_v, mut a_by_q, mut rate_by_q) =
                    (by_slope, by_slope, by_slope, by_slope);
                unit[j % 3] = R::of(1.0);
                if j >= 3 {
                    let e = unit;
                    unit = times(&r, &cross(&e, &s));
                    by_slope = times(&r, &cross(&e, &p.direction()));
                    v_by_q = times(&r, &cross(&e, &turning));
                    rate_by_q = times(&r, &cross(&e, &cross(&omega, &axis)));
                    let (one, two) = (cross(&e, &turning), cross(&omega, &cross(&e, &s)));
                    a_by_v = times(&r, &sum(one, two));
                    a_by_q = times(&r, &cross(&e, &centripetal));
                }
                let mut d = [R::zero(); 3];
                for i in 0..3 {
                    if gives.x {
                        d[i] += wq * dot(&load.d_x[i], &unit);
                    }
                    if gives.slope {
                        d[i] += wq * dot(&load.d_slope[i], &by_slope);
                    }
                    if gives.v {
                        d[i] += wv * dot(&load.d_v[i], &unit) + wq * dot(&load.d_v[i], &v_by_q);
                    }
                    if gives.a {
                        d[i] += wa * dot(&load.d_a[i], &unit)
                            + wv * dot(&load.d_a[i], &a_by_v)
                            + wq * dot(&load.d_a[i], &a_by_q);
                    }
                    if gives.couple {
                        // the slope's rate by a velocity is what the slope is by a coordinate
                        d[i] += wv * dot(&load.d_rate[i], &by_slope) + wq * dot(&load.d_rate[i], &rate_by_q);
                    }
                    d[i] = weight * d[i];
                }
                let mut turn = transposed_times(&r, &d);
                let mut e = [R::zero(); 3];
                if j >= 3 {
                    // the load stays in space while the body turns under it
                    e[j - 3] = wq;
                    turn = sum(turn, cross(&own, &e));
                }
                let mut turn = cross(&s, &turn);
                if gives.couple {
                    let mut d = [R::zero(); 3];
                    for i in 0..3 {
                        d[i] = wq * (dot(&load.g_x[i], &unit) + dot(&load.g_slope[i], &by_slope))
                            + wv * dot(&load.g_v[i], &unit)
                            + wq * dot(&load.g_v[i], &v_by_q);
                        d[i] = weight * d[i];
                    }
                    turn = sum(turn, cross(&axis, &sum(transposed_times(&r, &d), cross(&couple, &e))));
                }
                for i in 0..3 {
                    out.k[i][j] += d[i];
                    out.k[3 + i][j] += turn[i];
                }
            }
        }
    }
}
