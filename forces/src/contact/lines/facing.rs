//! One piece as it faces another: where along the first the second is nearer than both are thick.
//!
//! Neighbouring pieces of a line share the plane across their common node. What is nearest beyond it belongs to the
//! neighbour, so that nothing is counted twice; along a single line, what is nearer along it than a loop could be
//! isn't looked at. Where links of a chain meet at a corner the plane is that between both, in which all places are as far
//! from one as from the other.

use super::super::search::{Cubic, DETAIL, Depth, Look};
use super::super::seat::minus;
use super::curve::{Curve, size};
use ropewalk_core::rotation::around;
use ropewalk_core::{V3, dot};

/// How far a piece is continued beyond a node, so that what is opposite to a node isn't lost to rounding.
const BEYOND: f64 = 1e-6;
/// The same in parts of the thickness, of the plane that parts neighbours.
const SHIFT: f64 = 1e-9;

/// Which part of the second piece counts, seen from a place on the first: along one line what is far enough along it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Window {
    /// The border is at `at + rate ξ`.
    pub at: f64,
    pub rate: f64,
    /// Whether what is beyond the border counts, or what is before it.
    pub ahead: bool,
}

/// The first piece as it faces the second.
pub(crate) struct Facing<'a> {
    pub one: &'a Curve,
    pub other: &'a Curve,
    /// The sum of both radii [m].
    pub thick: f64,
    /// Whether the second ends at its ends, rather than going on.
    pub tips: [bool; 2],
    /// Where the second meets a neighbour at a corner, the direction across the plane that parts them.
    pub corners: [Option<V3<f64>>; 2],
    pub window: Option<Window>,
    /// The part of the first that counts.
    pub range: [f64; 2],
}

/// The nearest point of the second piece.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Nearest {
    pub t: f64,
    /// Whether it moves along the piece.
    pub free: bool,
}

impl Facing<'_> {
    /// Faces a piece in the window that its line leaves; nothing if that is empty.
    pub fn narrowed(mut self) -> Option<Self> {
        if let Some(Window { at, rate, ahead }) = self.window {
            // where the border is at the end of the second
            let last = if ahead { (1.0 - at) / rate } else { -at / rate };
            if ahead {
                self.range[1] = self.range[1].min(last);
            } else {
                self.range[0] = self.range[0].max(last);
            }
            let never =
                if ahead { at + rate * self.range[1] <= 0.0 } else { at + rate * self.range[0] >= 1.0 };
            if never {
                self.window = None;
            }
        }
        (self.range[0] < self.range[1]).then_some(self)
    }

    fn limits(&self, xi: f64) -> ([f64; 2], f64) {
        let beyond = [0, 1].map(|end| {
            let goes_on = !self.tips[end] && self.corners[end].is_none();
            if goes_on { BEYOND } else { 0.0 }
        });
        let [mut lo, mut hi] = [-beyond[0], 1.0 + beyond[1]];
        let mut border = f64::NAN;
        if let Some(Window { at, rate, ahead }) = self.window {
            let own = (at + rate * xi).clamp(lo, hi);
            if ahead && own > lo {
                (lo, border) = (own, own);
            } else if !ahead && own < hi {
                (hi, border) = (own, own);
            }
        }
        ([lo, hi], border)
    }

    /// The nearest point of the second from a place of the first, if it belongs to it.
    pub fn nearest(&self, xi: f64, x: &V3<f64>) -> Option<Nearest> {
        let ([lo, hi], border) = self.limits(xi);
        let t = self.other.nearest(x, [lo, hi]);
        if t == border {
            return None;
        }
        Some(Nearest { t, free: t > lo && t < hi })
    }

    /// The intervals of the first that touch what belongs to the second, put behind those in `found`.
    pub fn find(&self, scratch: &mut Scratch) {
        scratch.found.clear();
        if self.one.is_apart(self.other, self.thick) {
            return;
        }
        let [from, to] = self.range;
        let Some(middle) = self.look(0.5 * (from + to)) else { return };
        if middle.depth + 0.5 * self.speed() * (to - from) <= 0.0 {
            return;
        }
        self.find_between(self.range, &mut scratch.pieces, &mut scratch.found);
        if !scratch.found.is_empty() {
            self.cut(&mut scratch.found);
        }
    }

    /// Leaves what belongs to the second.
    fn cut(&self, found: &mut Vec<[f64; 2]>) {
        let Cubic([a, da, b, db]) = self.other.cubic;
        for (end, node, along) in [(0, a, da), (1, b, db)] {
            if self.tips[end] {
                continue;
            }
            let plane = self.plane(&node, &self.corners[end].unwrap_or(along));
            let whole = std::mem::take(found);
            for [from, to] in whole {
                let mut borders = plane.zeros(from, to);
                borders.push(to);
                let mut from = from;
                for border in borders {
                    let beyond = plane.at(0.5 * (from + border)) >= 0.0;
                    if beyond == (end == 0) && border > from {
                        match found.last_mut() {
                            Some(last) if last[1] == from => last[1] = border,
                            _ => found.push([from, border]),
                        }
                    }
                    from = border;
                }
            }
        }
        self.cut_at_corners(found);
    }

    /// How far the first is beyond the plane across a direction at a node.
    fn plane(&self, node: &V3<f64>, across: &V3<f64>) -> Heights {
        let Cubic([p0, d0, p1, d1]) = self.one.cubic;
        let shift = SHIFT * size(across) * self.thick;
        let height = |p: &V3<f64>| dot(&minus(p, node), across) + shift;
        Heights([height(&p0), dot(&d0, across), height(&p1), dot(&d1, across)])
    }

    /// Cuts where the corner itself begins to be the nearest place, from which on the distance is bent otherwise.
    fn cut_at_corners(&self, found: &mut Vec<[f64; 2]>) {
        let Cubic([a, da, b, db]) = self.other.cubic;
        for (end, node, along) in [(0, a, da), (1, b, db)] {
            if self.corners[end].is_none() {
                continue;
            }
            let plane = self.plane(&node, &along);
            for [mut from, to] in std::mem::take(found) {
                for border in plane.zeros(from, to).into_iter().filter(|x| *x < to) {
                    found.push([from, border]);
                    from = border;
                }
                found.push([from, to]);
            }
        }
    }
}

impl Depth for Facing<'_> {
    fn speed(&self) -> f64 {
        self.one.speed + self.window.map_or(0.0, |w| w.rate * self.other.speed)
    }

    fn look(&self, xi: f64) -> Option<Look> {
        let x = self.one.cubic.at(xi);
        let ([lo, hi], border) = self.limits(xi);
        let t = self.other.nearest(&x, [lo, hi]);
        let way = minus(&x, &self.other.cubic.at(t));
        let distance = size(&way);
        let mut slope = self.one.cubic.slope(xi);
        let normal = if distance > 0.0 { way.map(|w| w / distance) } else { around(slope)[1] };
        if let (Some(w), true) = (self.window, t == border) {
            let own = self.other.cubic.slope(t);
            (0..3).for_each(|i| slope[i] -= w.rate * own[i]);
        }
        Some(Look { xi, x, depth: self.thick - distance, slope: -dot(&normal, &slope), second: None })
    }

    fn rise(&self, a: &Look, b: &Look) -> f64 {
        let way = 0.5 * self.speed() * (b.xi - a.xi);
        // no place of the piece is farther away than this
        let reach = self.thick - 0.5 * (a.depth + b.depth) + way;
        let bent = self.other.curvature * reach;
        let mut rise = self.one.bend + self.window.map_or(0.0, |w| w.rate * w.rate * self.other.bend);
        if bent < 1.0 {
            rise += self.other.curvature / (1.0 - bent) * self.one.speed * self.one.speed;
        } else if way >= DETAIL * self.thick {
            return f64::INFINITY;
        }
        rise
    }
}

/// What the search needs and finds.
#[derive(Default)]
pub(crate) struct Scratch {
    pieces: Vec<[Look; 2]>,
    pub found: Vec<[f64; 2]>,
}

impl Scratch {
    /// Cuts what was found at the borders of so many equal cells.
    pub fn cut(&mut self, cells: usize) {
        let whole = std::mem::take(&mut self.found);
        for [mut from, to] in whole {
            for border in (1..cells).map(|k| k as f64 / cells as f64) {
                if from < border && border < to {
                    self.found.push([from, border]);
                    from = border;
                }
            }
            self.found.push([from, to]);
        }
    }
}

/// A cubic number: its values and its derivatives at 0 and 1.
struct Heights([f64; 4]);

impl Heights {
    fn at(&self, x: f64) -> f64 {
        let [a, da, b, db] = self.0;
        let (y, s) = (1.0 - x, x * x * (3.0 - 2.0 * x));
        (1.0 - s) * a + x * y * y * da + s * b - x * x * y * db
    }

    /// Where it changes its sign between `from` and `to`, in order.
    fn zeros(&self, from: f64, to: f64) -> Vec<f64> {
        let [a, da, b, db] = self.0;
        // its derivative is c₀ + c₁ x + c₂ x²
        let (c0, c1, c2) = (da, 6.0 * (b - a) - 4.0 * da - 2.0 * db, 6.0 * (a - b) + 3.0 * (da + db));
        let mut places = vec![from];
        let root = c1 * c1 - 4.0 * c0 * c2;
        if root > 0.0 {
            let q = -0.5 * (c1 + root.sqrt().copysign(c1));
            let mut turns = [q / c2, c0 / q];
            turns.sort_unstable_by(f64::total_cmp);
            places.extend(turns.into_iter().filter(|x| *x > from && *x < to));
        }
        places.push(to);
        let mut zeros = Vec::new();
        for w in places.windows(2) {
            let (mut low, mut high) = (w[0], w[1]);
            let rises = self.at(high) >= 0.0;
            if (self.at(low) >= 0.0) == rises {
                continue;
            }
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if (self.at(middle) >= 0.0) == rises { high = middle } else { low = middle }
            }
            zeros.push(high);
        }
        zeros
    }
}
