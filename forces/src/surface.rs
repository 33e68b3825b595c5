//! The surface of water, and how it cuts slender bodies and balls.
//!
//! A slender body is a stack of discs across its axis, of radius `r`. A disc whose middle lies at depth `s` is wet by
//! `φ(s/w)` of its area, `w = r √(1 - t_z²)` being half of its height; a station's cell from depth `s_a` to `s_b` by the
//! mean of that, which its integrals give exactly: `W = (Y(s_a) - Y(s_b)) / (s_a - s_b)` with `∂²Y/∂s² = φ`. `ρ g A W` is
//! the potential of buoyancy per length: its share `∂W/∂s` lifts, and what `W` changes by with the slope is the couple
//! of a tilted waterplane. Cells aren't centred on their stations: a cable's cell that lies deep has the depth of its
//! station for `W`, as else its couple, which cancels between elements alone, would turn the ends of a cable. In waves the
//! surface over a station's cell is taken as level, at the height that it has at the
//! station.

use ropewalk_core::{Real, Station, V3, dot};
use ropewalk_scene::{Sea, Swell, ball_below};
use ropewalk_sea::Top;
use std::f64::consts::PI;
use std::sync::Arc;

/// The surface of water.
#[derive(Clone, Debug, PartialEq)]
pub struct Surface {
    /// Its height where it is still [m].
    pub level: f64,
    /// The waves on it.
    pub sea: Option<Arc<Sea>>,
}

/// How a station's cell lies in the water.
#[derive(Clone, Copy, Debug)]
pub struct Wet<R> {
    /// `W`, the mean over the cell of the depth of what is wet [m]; deep down the depth of the station.
    pub depth: R,
    /// `∂W/∂r'` [m].
    pub depth_by_slope: V3<R>,
    /// `∂²W/∂r'²` [m].
    pub depth_by_slopes: [V3<R>; 3],
    /// `∂W/∂s`, the share of its weight in water that lifts it.
    pub lift: R,
    /// By height [1/m].
    pub lift_by_z: R,
    /// By slope.
    pub lift_by_slope: V3<R>,
    /// Share of its volume that is wet.
    pub share: R,
    /// By height [1/m].
    pub share_by_z: R,
    /// By slope.
    pub share_by_slope: V3<R>,
}

/// An upright disc has no height at all; this part of its radius lets the surface pass it smoothly.
const UPRIGHT: f64 = 0.01;
/// Cells whose ends differ in depth by less, in parts of `w`, are integrated by two points: the difference of the integrals
/// would be rounding.
const LEVEL: f64 = 0.02;
/// At a depth of so many lengths of its element a cell counts as centred on its station: over less, the blend would be felt
/// in the stiffness of a waterplane.
const DEEP: f64 = 3.0;
/// As many lanes as the widest carrier has.
const MOST: usize = 8;
/// Numbers that say how a cell is wet, with one to spare, and how it lies.
const WET: usize = 24;
const CELL: usize = 8;

impl Surface {
    /// That of still water at a height [m].
    pub const fn still(level: f64) -> Self {
        Surface { level, sea: None }
    }

    /// Its waves at a station, if it has some.
    #[inline(always)]
    pub fn swell<R: Real>(&self, t: f64, at: &Station<R>) -> Option<Swell<R>> {
        self.sea.as_ref().map(|sea| sea.along(t, at))
    }

    /// How it stands in waves above a station, if it has some.
    #[inline(always)]
    pub fn top<R: Real>(&self, t: f64, at: &Station<R>) -> Option<Top<R>> {
        self.swell(t, at).map(|swell| swell.top)
    }

    /// How it stands in waves above a place, if it has some.
    pub fn top_at<R: Real>(&self, t: f64, x: &V3<R>) -> Option<Top<R>> {
        self.sea.as_ref().map(|sea| sea.at(t, x).top)
    }

    /// How much of a step `h` follows it, as [`Law::reach`](ropewalk_core::Law::reach).
    pub(crate) fn reach(&self, h: f64) -> f64 {
        self.sea.as_ref().map_or(h, |sea| sea.reach(h))
    }

    /// The period of its waves [s], as [`Law::period`](ropewalk_core::Law::period).
    pub(crate) fn period(&self) -> f64 {
        self.sea.as_ref().map_or(f64::INFINITY, |sea| sea.period())
    }

    /// How a station's cell lies in the water, which stands above it as [`Surface::top`] says.
    #[inline(always)]
    pub fn wet<R: Real>(&self, at: &Station<R>, top: Option<&Top<R>>) -> Wet<R> {
        if self.covers(at, top) {
            self.wet_below(at, top)
        } else {
            Wet::each(at, self.depth(at, top), radius(at))
        }
    }

    /// The same of cells that it covers.
    #[inline(always)]
    pub(crate) fn wet_below<R: Real>(&self, at: &Station<R>, top: Option<&Top<R>>) -> Wet<R> {
        Wet::below(at, self.depth(at, top), radius(at))
    }

    /// Whether the cells of all lanes lie below it as a whole.
    #[inline(always)]
    pub(crate) fn covers<R: Real>(&self, at: &Station<R>, top: Option<&Top<R>>) -> bool {
        all_below(at, self.depth(at, top), radius(at))
    }

    /// The same, if only the share is asked for: next to nothing is to be done where all is wet.
    #[inline(always)]
    pub(crate) fn share<R: Real>(&self, at: &Station<R>, top: Option<&Top<R>>) -> Wet<R> {
        let s = self.depth(at, top);
        if self.covers(at, top) { Wet::whole(s) } else { Wet::each(at, s, radius(at)) }
    }

    /// Depth of the axis at a station [m].
    #[inline(always)]
    fn depth<R: Real>(&self, at: &Station<R>, top: Option<&Top<R>>) -> R {
        let risen = top.map_or(R::zero(), |top| top.elevation);
        R::of(self.level) + risen - at.x[2]
    }

    /// Share of a ball's volume that is wet, and what it changes by with height [1/m]; `x` is its middle.
    pub fn ball<R: Real>(&self, t: f64, x: &V3<R>, radius: f64) -> (R, R) {
        match self.top_at(t, x) {
            None => ball_below(self.level, x[2], radius),
            Some(top) => ball_below(self.level, x[2] - top.elevation, radius),
        }
    }
}

/// Radius of the displaced section of a station [m].
#[inline(always)]
fn radius<R: Real>(at: &Station<R>) -> R {
    let of_area = (at.area / R::of(PI)).sqrt();
    at.area.if_gt(R::zero(), of_area, R::of(0.5) * at.diameter)
}

/// Whether the cells of all lanes lie below the surface as a whole.
#[inline(always)]
fn all_below<R: Real>(at: &Station<R>, s: R, radius: R) -> bool {
    let rise = at.slope[2];
    let [before, behind] = [s + at.before * rise, s - (at.weight - at.before) * rise];
    before.all_gt(radius) && behind.all_gt(radius)
}

impl<R: Real> Wet<R> {
    /// All of it is wet, at a depth; nothing else is told.
    #[inline(always)]
    fn whole(depth: R) -> Self {
        let (zero, one) = (R::zero(), R::of(1.0));
        Wet {
            depth,
            depth_by_slope: [zero; 3],
            depth_by_slopes: [[zero; 3]; 3],
            lift: one,
            lift_by_z: zero,
            lift_by_slope: [zero; 3],
            share: one,
            share_by_z: zero,
            share_by_slope: [zero; 3],
        }
    }

    /// Cells that lie below the surface, whose axis is at depth `s`: as [`Cell::wet`].
    #[inline(always)]
    fn below(at: &Station<R>, s: R, radius: R) -> Self {
        let (zero, one, rise) = (R::zero(), R::of(1.0), at.slope[2]);
        let lever = R::of(0.5) * (at.before - (at.weight - at.before));
        let deep = R::of(DEEP) * at.element + R::of(2.0) * radius;
        let u = s / deep;
        let u = u.if_gt(zero, u, zero);
        let u = u.if_gt(one, one, u);
        // what is rigid has no element
        let u = at.element.if_gt(zero, u, zero);
        let rest = one - u;
        let centred = u * u * u * (R::of(10.0) + u * (R::of(6.0) * u - R::of(15.0)));
        let by_s = R::of(30.0) * u * u * rest * rest / deep;
        let by_s_s = R::of(60.0) * u * rest * (one - R::of(2.0) * u) / (deep * deep);
        let mut wet = Wet::whole(s + lever * rise - lever * rise * centred);
        wet.depth_by_slope[2] = lever - lever * centred;
        wet.lift = one - lever * rise * by_s;
        wet.lift_by_z = lever * rise * by_s_s;
        wet.lift_by_slope[2] = -(lever * by_s);
        wet
    }

    /// Cells some of which the surface cuts, or that are above it: each of those by itself.
    #[inline(always)]
    fn each(at: &Station<R>, s: R, radius: R) -> Self {
        let mut rows = [[0.0; MOST]; WET];
        Wet::below(at, s, radius).write(&mut rows);
        let mut cells = [[0.0; MOST]; CELL];
        let numbers = [s, at.slope[0], at.slope[1], at.slope[2], at.before, at.weight, at.element, radius];
        for k in 0..CELL {
            numbers[k].write(&mut cells[k]);
        }
        cut(R::LANES, &cells, &mut rows);
        Wet::read(&rows)
    }

    /// Its numbers, row by row.
    #[inline(always)]
    fn write(self, rows: &mut [[f64; MOST]; WET]) {
        let [a, b, c] = self.depth_by_slopes;
        let all = [
            [self.depth, self.lift, self.lift_by_z],
            self.depth_by_slope,
            a,
            b,
            c,
            self.lift_by_slope,
            self.share_by_slope,
            [self.share, self.share_by_z, R::zero()],
        ];
        for k in 0..WET {
            all[k / 3][k % 3].write(&mut rows[k]);
        }
    }

    #[inline(always)]
    fn read(rows: &[[f64; MOST]; WET]) -> Self {
        let mut all = [[R::zero(); 3]; WET / 3];
        for k in 0..WET {
            all[k / 3][k % 3] = R::read(&rows[k]);
        }
        let [[depth, lift, lift_by_z], depth_by_slope, a, b, c, lift_by_slope, share_by_slope, last] = all;
        let ([share, share_by_z, _], depth_by_slopes) = (last, [a, b, c]);
        Wet {
            depth,
            depth_by_slope,
            depth_by_slopes,
            lift,
            lift_by_z,
            lift_by_slope,
            share,
            share_by_z,
            share_by_slope,
        }
    }

    /// How fast the share changes as the station and the surface move [1/s].
    #[inline(always)]
    pub(crate) fn share_rate(&self, at: &Station<R>, top: Option<&Top<R>>) -> R {
        let still = self.share_by_z.fma(at.v[2], dot(&self.share_by_slope, &at.slope_rate));
        top.map_or(still, |top| still - self.share_by_z * top.rise(&at.v))
    }
}

impl Wet<f64> {
    const fn dry() -> Self {
        Wet {
            depth: 0.0,
            depth_by_slope: [0.0; 3],
            depth_by_slopes: [[0.0; 3]; 3],
            lift: 0.0,
            lift_by_z: 0.0,
            lift_by_slope: [0.0; 3],
            share: 0.0,
            share_by_z: 0.0,
            share_by_slope: [0.0; 3],
        }
    }
}

/// Puts the cells of some lanes that don't lie below the surface as a whole into their places of the rows.
#[inline(never)]
fn cut(lanes: usize, cells: &[[f64; MOST]; CELL], rows: &mut [[f64; MOST]; WET]) {
    for lane in 0..lanes {
        let [s, x, y, z, before, weight, element, radius] = [0, 1, 2, 3, 4, 5, 6, 7].map(|k| cells[k][lane]);
        let behind = weight - before;
        if s + before * z >= radius && s - behind * z >= radius {
            continue;
        }
        let mut own = [[0.0; MOST]; WET];
        Cell { s, slope: [x, y, z], before, behind, element, radius }.wet().write(&mut own);
        rows.iter_mut().zip(&own).for_each(|(row, own)| row[lane] = own[0]);
    }
}

/// The cell of a station: its axis at depth `s` there, and how far it reaches to either side.
struct Cell {
    s: f64,
    slope: V3<f64>,
    before: f64,
    behind: f64,
    element: f64,
    radius: f64,
}

impl Cell {
    fn wet(&self) -> Wet<f64> {
        let rise = self.slope[2];
        let ends = [self.s + self.before * rise, self.s - self.behind * rise];
        if ends[0].max(ends[1]) <= -self.radius {
            return Wet::dry();
        }
        let lever = 0.5 * (self.before - self.behind);
        let mut wet = if ends[0].min(ends[1]) >= self.radius {
            let depth = self.s + lever * rise;
            Wet { depth, depth_by_slope: [0.0, 0.0, lever], lift: 1.0, share: 1.0, ..Wet::dry() }
        } else {
            self.cut(ends)
        };
        if self.element == 0.0 {
            return wet;
        }
        let deep = DEEP * self.element + 2.0 * self.radius;
        let [centred, by_s, by_s_s] = smooth(self.s / deep, deep);
        wet.depth -= lever * rise * centred;
        wet.depth_by_slope[2] -= lever * centred;
        wet.lift -= lever * rise * by_s;
        wet.lift_by_z += lever * rise * by_s_s;
        wet.lift_by_slope[2] -= lever * by_s;
        wet
    }

    /// A cell that the surface cuts.
    fn cut(&self, ends: [f64; 2]) -> Wet<f64> {
        let length = dot(&self.slope, &self.slope).sqrt();
        let t = self.slope.map(|x| x / length);
        let (r2, kappa) = (self.radius * self.radius, 1.0 - UPRIGHT * UPRIGHT);
        let w = (r2 * (1.0 - kappa * t[2] * t[2])).sqrt();
        let m = Mean::new(ends, w);
        // by the depth of the axis and its slope: the ends are s + before r'_z and s - behind r'_z
        let (a, b) = (self.before, -self.behind);
        let by_rise = a * m.a + b * m.b;
        let (s_s, s_rise) = (m.aa + 2.0 * m.ab + m.bb, a * m.aa + (a + b) * m.ab + b * m.bb);
        let rise_rise = a * a * m.aa + 2.0 * a * b * m.ab + b * b * m.bb;
        let (s_w, rise_w) = (m.aw + m.bw, a * m.aw + b * m.bw);
        // by the inclination τ = t_z: ∂τ/∂r' = (e_z - τ t)/|r'|
        let tau = t[2];
        let (w1, w2) = (-r2 * kappa * tau / w, -r2 * kappa / w - (r2 * kappa * tau).powi(2) / w.powi(3));
        let turn: V3<f64> = std::array::from_fn(|i| (up(i) - tau * t[i]) / length);
        let dw = turn.map(|x| w1 * x);
        let second = |i: usize, j: usize| {
            let across = f64::from(i == j) - t[i] * t[j];
            let ddtau = -(turn[i] * t[j] + t[i] * turn[j] + tau * across / length) / length;
            let ddw = w2 * turn[i] * turn[j] + w1 * ddtau;
            rise_rise * up(i) * up(j)
                + rise_w * (up(i) * dw[j] + dw[i] * up(j))
                + m.ww * dw[i] * dw[j]
                + m.w * ddw
        };
        let (share, share_by_z) = (m.a + m.b, -s_s);
        let share_by_slope = std::array::from_fn(|i| s_rise * up(i) + s_w * dw[i]);
        Wet {
            depth: m.value,
            depth_by_slope: std::array::from_fn(|i| by_rise * up(i) + m.w * dw[i]),
            depth_by_slopes: std::array::from_fn(|i| std::array::from_fn(|j| second(i, j))),
            lift: share,
            lift_by_z: share_by_z,
            lift_by_slope: share_by_slope,
            share,
            share_by_z,
            share_by_slope,
        }
    }
}

/// A step from 0 at `u = 0` to 1 at `u = 1` with two steady derivatives, and these by `u width`.
fn smooth(u: f64, width: f64) -> [f64; 3] {
    if u <= 0.0 {
        return [0.0; 3];
    }
    if u >= 1.0 {
        return [1.0, 0.0, 0.0];
    }
    let rest = 1.0 - u;
    [
        u * u * u * (10.0 + u * (6.0 * u - 15.0)),
        30.0 * u * u * rest * rest / width,
        60.0 * u * rest * (1.0 - 2.0 * u) / (width * width),
    ]
}

/// `e_z`
fn up(i: usize) -> f64 {
    f64::from(i == 2)
}

/// The mean depth `W(s_a, s_b, w)` of what is wet, with its derivatives by the depths `a` and `b` of the ends and by `w`.
struct Mean {
    value: f64,
    a: f64,
    b: f64,
    w: f64,
    aa: f64,
    ab: f64,
    bb: f64,
    aw: f64,
    bw: f64,
    ww: f64,
}

impl Mean {
    fn new([a, b]: [f64; 2], w: f64) -> Self {
        let d = a - b;
        if d.abs() < LEVEL * w { Mean::by_points(a, b, w) } else { Mean::by_ends(a, b, w) }
    }

    fn by_ends(a: f64, b: f64, w: f64) -> Self {
        let ([p, q], d) = ([Disc::new(a, w), Disc::new(b, w)], a - b);
        let value = (p.y - q.y) / d;
        let (by_a, by_b, by_w) = ((p.s - value) / d, (value - q.s) / d, (p.w - q.w) / d);
        Mean {
            value,
            a: by_a,
            b: by_b,
            w: by_w,
            aa: (p.ss - 2.0 * by_a) / d,
            ab: (by_a - by_b) / d,
            bb: (2.0 * by_b - q.ss) / d,
            aw: (p.sw - by_w) / d,
            bw: (by_w - q.sw) / d,
            ww: (p.ww - q.ww) / d,
        }
    }

    /// Gauss' rule of two points.
    fn by_points(a: f64, b: f64, w: f64) -> Self {
        let mut m =
            Mean { value: 0.0, a: 0.0, b: 0.0, w: 0.0, aa: 0.0, ab: 0.0, bb: 0.0, aw: 0.0, bw: 0.0, ww: 0.0 };
        for g in [0.211_324_865_405_187_1, 0.788_675_134_594_812_9] {
            let (near, disc) = (1.0 - g, Disc::new(a + g * (b - a), w));
            m.value += 0.5 * disc.s;
            m.a += 0.5 * near * disc.ss;
            m.b += 0.5 * g * disc.ss;
            m.w += 0.5 * disc.sw;
            m.aa += 0.5 * near * near * disc.sss;
            m.ab += 0.5 * near * g * disc.sss;
            m.bb += 0.5 * g * g * disc.sss;
            m.aw -= 0.5 * near * disc.u * disc.sss;
            m.bw -= 0.5 * g * disc.u * disc.sss;
            m.ww += 0.5 * disc.u * disc.u * disc.sss;
        }
        m
    }
}

/// `Y(s, w) = w² X(s/w)`, whose second derivative by the depth `s` is the wet share `φ(s/w)` of a disc, and its derivatives.
struct Disc {
    u: f64,
    y: f64,
    s: f64,
    w: f64,
    ss: f64,
    sw: f64,
    ww: f64,
    sss: f64,
}

impl Disc {
    fn new(s: f64, w: f64) -> Self {
        let u = s / w;
        if u <= -1.0 {
            return Disc { u, y: 0.0, s: 0.0, w: 0.0, ss: 0.0, sw: 0.0, ww: 0.0, sss: 0.0 };
        }
        if u >= 1.0 {
            let y = 0.5 * s * s + 0.125 * w * w;
            return Disc { u, y, s, w: 0.25 * w, ss: 1.0, sw: 0.0, ww: 0.25, sss: 0.0 };
        }
        let (angle, c) = ((-u).acos(), (1.0 - u * u).sqrt());
        let share = (angle + u * c) / PI;
        let once = (u * angle + c - c.powi(3) / 3.0) / PI;
        let twice = 1.0 / 16.0
            + (0.5 * u * u * angle + 0.125 * u.asin() + u * c * (0.75 - (5.0 - 2.0 * u * u) / 24.0)) / PI;
        Disc {
            u,
            y: w * w * twice,
            s: w * once,
            w: w * (2.0 * twice - u * once),
            ss: share,
            sw: once - u * share,
            ww: 2.0 * twice - 2.0 * u * once + u * u * share,
            sss: 2.0 * c / (PI * w),
        }
    }
}
