//! Where a curve touches a shape, found for certain.
//!
//! The depth `δ(ξ) = r - d(p(ξ))` of a curve `p` of radius `r` below a surface at the distance `d` is known where it is
//! looked at; what it can be in between is bounded. The distance changes no faster than the point moves, so `|δ'| ≤ B`
//! with the largest speed `B` of the curve; and around solids without hollows it is convex, so `δ'' ≤ C` with the
//! largest `|p''|`, to which a hollow of curvature `η` adds `η B²`. Hence on a piece of length `h` the function
//! `δ + C ξ (h - ξ)/2` is concave: it lies above its chord and below its tangents. A piece that neither bound decides
//! is halved.
//!
//! What lies around a drum has `|p''|` of the drum's own curvature, and yet its depth hardly changes. Where the surface is
//! round, `δ'' = -n·p'' - p'·H p'` with the curvatures `H` of level surfaces is known where it is looked at, and it changes
//! no faster than `|p'''| + 3 η B |p''| + 3 η² B² |δ'|`, where no curvature is larger than `η`.
//!
//! Beside balls and flanks the sign of the depth is that of a polynomial, and nothing of this is needed ([`super::round`]).

use super::shape::Shape;
use ropewalk_core::{V3, dot};

/// A cubic over `ξ` from 0 to 1: its ends and its derivatives there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cubic(pub [V3<f64>; 4]);

/// Pieces shorter than this are taken for what their middle is.
pub(super) const SHORTEST: f64 = 1e-6;
/// Around hollows of any kind, such as the valleys of a mesh, what is smaller than this part of the radius isn't looked
/// for: between two places that far apart the depth changes by a thousandth of it.
pub(crate) const DETAIL: f64 = 0.125;

/// What depths are known to, in parts of the coordinates.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// A place that was looked at: depth, and its derivative by `ξ`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Look {
    pub xi: f64,
    pub x: V3<f64>,
    pub depth: f64,
    pub slope: f64,
    /// `δ''`, if it is known.
    pub second: Option<f64>,
}

/// What is known of a piece.
pub(crate) enum Piece {
    Free,
    Touches,
    /// It has one end of contact.
    Crosses,
    Unknown,
}

fn blend(w: [f64; 4], p: &[V3<f64>; 4]) -> V3<f64> {
    std::array::from_fn(|i| w[0] * p[0][i] + w[1] * p[1][i] + w[2] * p[2][i] + w[3] * p[3][i])
}

impl Cubic {
    pub fn at(&self, xi: f64) -> V3<f64> {
        let rest = 1.0 - xi;
        let s = xi * xi * (3.0 - 2.0 * xi);
        blend([1.0 - s, xi * rest * rest, s, -xi * xi * rest], &self.0)
    }
    pub fn slope(&self, xi: f64) -> V3<f64> {
        let s = 6.0 * xi * (1.0 - xi);
        blend([-s, (1.0 - xi) * (1.0 - 3.0 * xi), s, xi * (3.0 * xi - 2.0)], &self.0)
    }
    /// A bound of `|p'|`: that of the control points of its derivative.
    pub fn speed(&self) -> f64 {
        let [a, da, b, db] = &self.0;
        let middle: V3<f64> = std::array::from_fn(|i| 3.0 * (b[i] - a[i]) - da[i] - db[i]);
        dot(da, da).max(dot(&middle, &middle)).max(dot(db, db)).sqrt()
    }
    /// Its curvature in the middle towards the side that a normal comes from [1/m].
    pub fn curvature(&self, normal: &V3<f64>) -> f64 {
        let (slope, bend) = (self.slope(0.5), blend([0.0, -1.0, 0.0, 1.0], &self.0));
        -dot(&bend, normal) / dot(&slope, &slope)
    }
    /// `p''`
    pub fn second(&self, xi: f64) -> V3<f64> {
        let s = 12.0 * xi - 6.0;
        blend([s, 6.0 * xi - 4.0, -s, 6.0 * xi - 2.0], &self.0)
    }
    /// The largest `|p''|`, which is at an end.
    pub fn bend(&self) -> f64 {
        let (start, end) = (self.second(0.0), self.second(1.0));
        dot(&start, &start).max(dot(&end, &end)).sqrt()
    }
    /// `|p'''|`, which is the same all along.
    pub fn third(&self) -> f64 {
        let third = blend([12.0, 6.0, -12.0, 6.0], &self.0);
        dot(&third, &third).sqrt()
    }
    /// Its control points: it lies in their convex hull.
    pub fn controls(&self) -> [V3<f64>; 4] {
        let [a, da, b, db] = &self.0;
        [*a, std::array::from_fn(|i| a[i] + da[i] / 3.0), std::array::from_fn(|i| b[i] - db[i] / 3.0), *b]
    }
}

/// The depth along a curve: what the search looks at, and what is known in between.
pub(crate) trait Depth {
    /// A place; nothing where there is nothing to touch.
    fn look(&self, xi: f64) -> Option<Look>;
    /// A bound of `|δ'|`.
    fn speed(&self) -> f64;
    /// A bound of `δ''` on a piece; infinite if there is none.
    fn rise(&self, a: &Look, b: &Look) -> f64;

    /// The places that touch from `from` to `to`, each from `ξ` to `ξ`, in order, put behind those in `found`.
    fn find_between(&self, [from, to]: [f64; 2], pieces: &mut Vec<[Look; 2]>, found: &mut Vec<[f64; 2]>) {
        let (Some(first), Some(last)) = (self.look(from), self.look(to)) else { return };
        pieces.clear();
        pieces.push([first, last]);
        let mut since: Option<f64> = None;
        while let Some([a, b]) = pieces.pop() {
            match self.judge(&a, &b) {
                Piece::Free => found.extend(since.take().map(|from| [from, a.xi])),
                Piece::Touches => since = since.or(Some(a.xi)),
                Piece::Crosses => {
                    let end = self.end(&a, &b);
                    if a.depth > 0.0 {
                        found.push([since.take().unwrap_or(a.xi), end]);
                    } else {
                        found.extend(since.take().map(|from| [from, a.xi]));
                        since = Some(end);
                    }
                }
                Piece::Unknown => {
                    let Some(middle) = self.look(0.5 * (a.xi + b.xi)) else { return };
                    if b.xi - a.xi > SHORTEST {
                        pieces.extend([[middle, b], [a, middle]]);
                    } else if middle.depth > 0.0 {
                        since = since.or(Some(a.xi));
                    } else {
                        found.extend(since.take().map(|from| [from, a.xi]));
                    }
                }
            }
        }
        found.extend(since.map(|from| [from, to]));
    }

    /// The greatest depth on a piece that touches, as records show it: between the looks next to the deepest.
    fn deepest(&self, piece: [f64; 2]) -> f64 {
        self.deepest_at(piece).1
    }

    /// The place of the greatest depth on a piece, and the depth there.
    fn deepest_at(&self, [from, to]: [f64; 2]) -> (f64, f64) {
        const LOOKS: usize = 16;
        let depth = |xi: f64| self.look(xi).map_or(f64::NEG_INFINITY, |l| l.depth);
        let place = |k: usize| from + (to - from) * k as f64 / LOOKS as f64;
        let best = (0..=LOOKS).max_by(|&a, &b| depth(place(a)).total_cmp(&depth(place(b)))).unwrap_or(0);
        let (mut low, mut high) = (place(best.saturating_sub(1)), place((best + 1).min(LOOKS)));
        for _ in 0..40 {
            let third = (high - low) / 3.0;
            if depth(low + third) < depth(high - third) { low += third } else { high -= third }
        }
        let (inner, middle) = (depth(0.5 * (low + high)), depth(place(best)));
        if inner > middle { (0.5 * (low + high), inner) } else { (place(best), middle) }
    }

    /// Bounds of the depth on a piece: the most and the least.
    fn bounds(&self, a: &Look, b: &Look) -> (f64, f64) {
        self.bounds_with(self.rise(a, b), a, b)
    }

    fn bounds_with(&self, c: f64, a: &Look, b: &Look) -> (f64, f64) {
        let h = b.xi - a.xi;
        let (mean, way) = (0.5 * (a.depth + b.depth), 0.5 * self.speed() * h);
        let (mut most, mut least) = (mean + way, mean - way);
        if c.is_finite() {
            let (up, down) = (a.slope + 0.5 * c * h, b.slope - 0.5 * c * h);
            let tangents = if up <= 0.0 {
                a.depth
            } else if down >= 0.0 {
                b.depth
            } else {
                let at = ((b.depth - a.depth - down * h) / (up - down)).clamp(0.0, h);
                a.depth + up * at
            };
            most = most.min(tangents);
            least = least.max(a.depth.min(b.depth) - 0.125 * c * h * h);
        }
        (most, least)
    }

    fn judge(&self, a: &Look, b: &Look) -> Piece {
        let c = self.rise(a, b);
        let (most, least) = self.bounds_with(c, a, b);
        // what lies along a plane is no deeper than rounding says
        let size = a.x.iter().chain(&b.x).fold(0.0, |m: f64, x| m.max(x.abs()));
        if most <= ROUNDING * size {
            return Piece::Free;
        }
        if least >= 0.0 {
            return Piece::Touches;
        }
        let h = b.xi - a.xi;
        let (falls, rises) = (a.slope + c * h < 0.0, b.slope - c * h > 0.0);
        match (a.depth > 0.0, b.depth > 0.0) {
            (true, false) if falls => Piece::Crosses,
            (false, true) if rises => Piece::Crosses,
            (true, true) if falls || rises => Piece::Touches,
            (false, false) if falls || rises => Piece::Free,
            _ => Piece::Unknown,
        }
    }

    /// The place where the depth passes zero on a piece on which it falls or rises.
    fn end(&self, a: &Look, b: &Look) -> f64 {
        let straight = a.xi + (b.xi - a.xi) * a.depth / (a.depth - b.depth);
        let depth = |xi: f64| self.look(xi).map(|here| [here.depth, here.slope]);
        passage(depth, [a.xi, b.xi], straight, b.depth > 0.0)
    }
}

/// Where something passes zero between two places, from a guess on; at the second of them it is positive if `rises` says so.
/// Newton's method between brackets, with the value and its slope; if there is none somewhere, it ends there.
pub(super) fn passage(
    at: impl Fn(f64) -> Option<[f64; 2]>,
    [from, to]: [f64; 2],
    guess: f64,
    rises: bool,
) -> f64 {
    let (mut low, mut high, mut xi) = (from, to, guess);
    for _ in 0..60 {
        let Some([value, slope]) = at(xi) else { break };
        if (value > 0.0) == rises {
            high = xi;
        } else {
            low = xi;
        }
        let mut next = xi - value / slope;
        if !(next > low && next < high) {
            next = 0.5 * (low + high);
        }
        let moved = (next - xi).abs();
        xi = next;
        if moved < 1e-9 * (to - from) || high - low < 1e-15 {
            break;
        }
    }
    xi
}

/// A curve with a thickness, in the axes of the shape that it may touch.
pub(crate) struct Search<'a> {
    pub shape: &'a Shape,
    pub curve: &'a Cubic,
    pub radius: f64,
    speed: f64,
    bend: f64,
    third: f64,
}

impl<'a> Search<'a> {
    pub fn new(shape: &'a Shape, curve: &'a Cubic, radius: f64) -> Self {
        Search { shape, curve, radius, speed: curve.speed(), bend: 0.0, third: 0.0 }
    }

    /// The places that touch, from `ξ` to `ξ`, in order, put behind those in `found`. A curve that is farther away than
    /// it is long costs one look.
    pub fn find(&mut self, pieces: &mut Vec<[Look; 2]>, found: &mut Vec<[f64; 2]>) {
        if self.shape.gap(&self.curve.at(0.5), self.radius + 0.5 * self.speed).is_some() {
            self.find_near(pieces, found);
        }
    }

    /// The same of a curve that is known not to be.
    pub fn find_near(&mut self, pieces: &mut Vec<[Look; 2]>, found: &mut Vec<[f64; 2]>) {
        if let Some(nearness) = self.shape.nearness(self.curve, self.radius) {
            return nearness.positive(found);
        }
        self.measure();
        self.find_between([0.0, 1.0], pieces, found);
    }

    fn measure(&mut self) {
        (self.bend, self.third) = (self.curve.bend(), self.curve.third());
    }

    /// A lower bound of the distance of the curve's surface from the shape [m].
    pub fn room(&mut self) -> f64 {
        let Some(gap) = self.shape.at_least(&self.curve.at(0.5)) else { return f64::INFINITY };
        let far = gap.distance - 0.5 * self.speed - self.radius;
        if far > 0.0 {
            return far;
        }
        self.measure();
        match (self.look(0.0), self.look(1.0)) {
            (Some(a), Some(b)) => far.max(-self.bounds(&a, &b).0),
            _ => f64::INFINITY,
        }
    }
}

impl Depth for Search<'_> {
    fn speed(&self) -> f64 {
        self.speed
    }

    fn look(&self, xi: f64) -> Option<Look> {
        let x = self.curve.at(xi);
        let mut gap = self.shape.gap(&x, f64::INFINITY)?;
        if gap.distance < 0.0 && self.shape.gap(&x, self.radius).is_none() {
            // beyond the box of a surface with borders there is no inside
            (gap.distance, gap.normal) = (-gap.distance, gap.normal.map(|n| -n));
        }
        let (slope, round) = (self.curve.slope(xi), self.shape.is_round());
        Some(Look {
            xi,
            x,
            depth: self.radius - gap.distance,
            slope: -dot(&gap.normal, &slope),
            second: round.then(|| -dot(&gap.normal, &self.curve.second(xi)) - dot(&slope, &gap.turn(&slope))),
        })
    }

    fn rise(&self, a: &Look, b: &Look) -> f64 {
        let h = b.xi - a.xi;
        let way = 0.5 * self.speed * h;
        let middle: V3<f64> = std::array::from_fn(|i| 0.5 * (a.x[i] + b.x[i]));
        // every point of the piece is within `way` of the middle of its chord
        let reach = (self.radius - 0.5 * (a.depth + b.depth)).abs() + way;
        let hollow = self.shape.hollow(&middle, way, reach);
        let anyhow = if hollow == 0.0 || hollow.is_infinite() && way < DETAIL * self.radius {
            self.bend
        } else {
            self.bend + hollow * self.speed * self.speed
        };
        let (Some(one), Some(other), Some(most)) = (a.second, b.second, self.shape.roundest(&middle, way))
        else {
            return anyhow;
        };
        let turn = most * self.speed;
        let slope = a.slope.abs().min(b.slope.abs()) + (self.bend + turn * self.speed) * h;
        let changes = self.third + 3.0 * turn * (self.bend + turn * slope.min(self.speed));
        anyhow.min((one.max(other) + 0.5 * changes * h).max(0.0))
    }
}
