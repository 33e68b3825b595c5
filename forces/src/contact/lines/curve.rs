//! One cubic piece as a thing that others come near: its nearest point, and where two of them are nearest.

use super::super::search::Cubic;
use super::super::seat::minus;
use ropewalk_core::{At, SpanLine, V3, dot};

/// A curve with what bounds it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Curve {
    pub cubic: Cubic,
    /// Bounds of `|p'|` and `|p''|`.
    pub speed: f64,
    pub bend: f64,
    /// A bound of the curvature [1/m]; infinite if there is none.
    pub curvature: f64,
    /// Chords from which the nearest point is looked for.
    chords: usize,
    /// The box around it.
    pub low: V3<f64>,
    pub high: V3<f64>,
}

/// Where two curves are nearest.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Closest {
    pub distance: f64,
    /// Place on each.
    pub xi: [f64; 2],
    /// From the second to the first [m].
    pub way: V3<f64>,
}

/// A hodograph within this part of its bound along the chord belongs to a curve that is nearly straight.
const STRAIGHT: f64 = 0.8;
/// Chords that a bent curve is cut into.
const CHORDS: usize = 6;
/// Chords of each of two curves, pairs of which are compared.
const SEEDS: usize = 4;

pub(crate) fn size(x: &V3<f64>) -> f64 {
    dot(x, x).sqrt()
}

impl Curve {
    /// The middle line of a slender piece.
    pub fn of(line: &SpanLine, at: &At<'_>) -> Self {
        Curve::new(Cubic(line.place(at)))
    }

    pub fn new(cubic: Cubic) -> Self {
        let Cubic([a, da, b, db]) = cubic;
        let chord = minus(&b, &a);
        let middle: V3<f64> = std::array::from_fn(|i| 3.0 * chord[i] - da[i] - db[i]);
        let along = |x: &V3<f64>| dot(x, &chord);
        let length = size(&chord);
        let least = along(&da).min(along(&middle)).min(along(&db)) / length;
        let (speed, bend) = (cubic.speed(), cubic.bend());
        // NaN where the ends are at the same place
        let curvature = if least > 0.0 { bend / (least * least) } else { f64::INFINITY };
        let chords = if least > STRAIGHT * speed { 1 } else { CHORDS };
        let (mut low, mut high) = (a, a);
        let controls =
            [std::array::from_fn(|i| a[i] + da[i] / 3.0), std::array::from_fn(|i| b[i] - db[i] / 3.0), b];
        for p in &controls {
            for i in 0..3 {
                (low[i], high[i]) = (low[i].min(p[i]), high[i].max(p[i]));
            }
        }
        Curve { cubic, speed, bend, curvature, chords, low, high }
    }

    /// Whether the boxes of two are farther apart than this.
    pub fn is_apart(&self, other: &Curve, distance: f64) -> bool {
        (0..3).any(|i| self.low[i] - other.high[i] > distance || other.low[i] - self.high[i] > distance)
    }

    /// The place from `lo` to `hi` that is nearest to a point.
    pub fn nearest(&self, x: &V3<f64>, [lo, hi]: [f64; 2]) -> f64 {
        let (mut best, mut t) = (f64::INFINITY, lo);
        let mut from = self.cubic.at(lo);
        for k in 1..=self.chords {
            let [t0, t1] = [k - 1, k].map(|k| lo + (hi - lo) * k as f64 / self.chords as f64);
            let to = self.cubic.at(t1);
            let (chord, way) = (minus(&to, &from), minus(x, &from));
            let square = dot(&chord, &chord);
            let share = if square > 0.0 { (dot(&way, &chord) / square).clamp(0.0, 1.0) } else { 0.0 };
            let off: V3<f64> = std::array::from_fn(|i| way[i] - share * chord[i]);
            let distance = dot(&off, &off);
            if distance < best {
                (best, t) = (distance, t0 + share * (t1 - t0));
            }
            from = to;
        }
        for _ in 0..30 {
            let (way, slope) = (minus(&self.cubic.at(t), x), self.cubic.slope(t));
            let square = dot(&slope, &slope);
            let mut steep = square + dot(&way, &self.cubic.second(t));
            if !(steep > 0.0) {
                steep = square;
            }
            let next = (t - dot(&way, &slope) / steep).clamp(lo, hi);
            let moved = (next - t).abs();
            t = next;
            if !(moved > 1e-15) {
                break;
            }
        }
        t
    }

    /// Where it is nearest to another.
    pub fn closest(&self, other: &Curve) -> Closest {
        let xi = polish([self, other], seed([self, other]));
        let way = minus(&self.cubic.at(xi[0]), &other.cubic.at(xi[1]));
        Closest { distance: size(&way), xi, way }
    }
}

/// The nearest places on any two chords of both.
fn seed(curves: [&Curve; 2]) -> [f64; 2] {
    let points = curves
        .map(|c| -> [V3<f64>; SEEDS + 1] { std::array::from_fn(|k| c.cubic.at(k as f64 / SEEDS as f64)) });
    let (mut best, mut xi) = (f64::INFINITY, [0.0; 2]);
    for i in 0..SEEDS {
        for j in 0..SEEDS {
            let (u, v) = (minus(&points[0][i + 1], &points[0][i]), minus(&points[1][j + 1], &points[1][j]));
            let w = minus(&points[0][i], &points[1][j]);
            let (uu, uv, vv, uw, vw) = (dot(&u, &u), dot(&u, &v), dot(&v, &v), dot(&u, &w), dot(&v, &w));
            let det = uu * vv - uv * uv;
            let within = |x: f64| if x.is_nan() { 0.5 } else { x.clamp(0.0, 1.0) };
            let a = within(if det > 1e-12 * uu * vv { (uv * vw - vv * uw) / det } else { 0.5 });
            let b = within((uv * a + vw) / vv);
            let a = within((uv * b - uw) / uu);
            let off: V3<f64> = std::array::from_fn(|k| w[k] + a * u[k] - b * v[k]);
            let square = dot(&off, &off);
            if square < best {
                best = square;
                xi = [(i as f64 + a) / SEEDS as f64, (j as f64 + b) / SEEDS as f64];
            }
        }
    }
    xi
}

/// Newton's method on the square of the distance, within both pieces.
fn polish([one, other]: [&Curve; 2], mut xi: [f64; 2]) -> [f64; 2] {
    for _ in 0..30 {
        let [s, t] = xi;
        let w = minus(&one.cubic.at(s), &other.cubic.at(t));
        let (a, b) = (one.cubic.slope(s), other.cubic.slope(t));
        let g = [dot(&w, &a), -dot(&w, &b)];
        let mut h = [
            dot(&a, &a) + dot(&w, &one.cubic.second(s)),
            -dot(&a, &b),
            dot(&b, &b) - dot(&w, &other.cubic.second(t)),
        ];
        let free: [bool; 2] =
            std::array::from_fn(|k| !(xi[k] <= 0.0 && g[k] > 0.0 || xi[k] >= 1.0 && g[k] < 0.0));
        // the smaller eigenvalue has to be positive
        let (mean, half) = (0.5 * (h[0] + h[2]), 0.5 * (h[0] - h[2]));
        let least = mean - (half * half + h[1] * h[1]).sqrt();
        if least <= 0.0 {
            let raise = 1e-3 * h.iter().fold(0.0, |m: f64, x| m.max(x.abs())) - least;
            h[0] += raise;
            h[2] += raise;
        }
        let d = match free {
            [true, true] => {
                let det = h[0] * h[2] - h[1] * h[1];
                [(h[1] * g[1] - h[2] * g[0]) / det, (h[1] * g[0] - h[0] * g[1]) / det]
            }
            [true, false] => [-g[0] / h[0], 0.0],
            [false, true] => [0.0, -g[1] / h[2]],
            [false, false] => break,
        };
        let next: [f64; 2] = std::array::from_fn(|k| (xi[k] + d[k]).clamp(0.0, 1.0));
        let moved = (next[0] - s).abs().max((next[1] - t).abs());
        if moved.is_nan() {
            break;
        }
        xi = next;
        if moved < 1e-15 {
            break;
        }
    }
    xi
}

/// Where two cubic pieces are nearest: their distance [m], and the places `ξ` from 0 to 1. Each piece is told by its ends and
/// its derivatives by `ξ` there, `[r₀, ∂r₀, r₁, ∂r₁]`.
///
/// ```
/// # use ropewalk_forces::contact::nearest_points;
/// let along = |x: [f64; 3], d: [f64; 3]| [x, d, std::array::from_fn(|i| x[i] + d[i]), d];
/// let one = along([0.0; 3], [1.0, 0.0, 0.0]);
/// let other = along([0.25, -1.0, 0.5], [0.0, 2.0, 0.0]);
/// let (distance, [s, t]) = nearest_points(&one, &other);
/// assert!((distance - 0.5).abs() < 1e-12 && (s - 0.25).abs() < 1e-9 && (t - 0.5).abs() < 1e-9);
/// ```
pub fn nearest_points(one: &[V3<f64>; 4], other: &[V3<f64>; 4]) -> (f64, [f64; 2]) {
    let [one, other] = [one, other].map(|piece| Curve::new(Cubic(*piece)));
    let closest = one.closest(&other);
    (closest.distance, closest.xi)
}
