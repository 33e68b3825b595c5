//! What lies on a plane that is fixed in space, as most of a line does that lies on the sea floor.
//!
//! Heights above it are linear in the unknowns, and its normal is the same everywhere. So the control points of an element tell
//! whether it touches nowhere or all along, the roots of a cubic where it does if only in part, and the tangent of the normal
//! forces is `n ⊗ n` times a number for each pair of vectors that move it. All is as [`Contact`] has it for any shape, but for the
//! search.

use super::ahead::time;
use super::block::{Block, MOST};
use super::bristles::Bristle;
use super::friction::{CELLS, Pressed};
use super::group::{Ball, Group, Span, What};
use super::search::passage;
use super::seat::{Frame, Seat};
use super::shape::Shape;
use super::term::Contact;
use crate::gauss::gauss;
use ropewalk_core::held::{Held, three};
use ropewalk_core::{Assembly, At, SpanLine, V3, dot};

/// The part of the radius that an element may go on by in a step once it touches. Behind a plane there is nothing else: how exact
/// the step is its error tells.
const PRESS: f64 = 1.0;

/// The plane `n · x = height`.
pub(crate) struct Level {
    pub n: V3<f64>,
    height: f64,
}

/// How an element lies on it.
pub(crate) enum Lies<'a> {
    Above,
    Touches(Lying<'a>),
    /// It is to be searched as any shape.
    Unknown,
}

/// An element that touches.
pub(crate) struct Lying<'a> {
    span: &'a Span,
    /// The pieces of it that do, from `ξ` to `ξ`: a cubic has two at most.
    pieces: [[f64; 2]; 2],
    count: usize,
    /// How many of its cells rub.
    cells: usize,
    /// Height of the axis at which it begins to touch [m].
    above: f64,
    /// Of each vector of its nodes, and their rates.
    heights: [f64; 4],
    rates: [f64; 4],
}

impl Lying<'_> {
    /// Sees the points that stand for it: two in each cell that touches as a whole, if it rubs.
    pub fn each_point(&self, mut see: impl FnMut(Point)) {
        let Lying { span, cells, above, heights, rates, .. } = self;
        let border = |k: usize| k as f64 / *cells as f64;
        for piece in &self.pieces[..self.count] {
            for cell in 0..*cells {
                let (from, to) = (piece[0].max(border(cell)), piece[1].min(border(cell + 1)));
                let part = to - from;
                if !(part > 0.0) {
                    continue;
                }
                let whole = *cells > 1 && part * *cells as f64 > 1.0 - 1e-9;
                for (place, share) in gauss(if whole { 2 } else { span.points }) {
                    let weight = span.line.weights(from + part * place);
                    let (depth, rate) = (above - blend(&weight, heights), -blend(&weight, rates));
                    see(Point { weight, cell, k: span.k * part * share, depth, rate });
                }
            }
        }
    }

    /// The tips beyond its ends.
    pub fn tips(&self) -> impl Iterator<Item = &Ball> {
        self.span.tips.iter().flatten()
    }
}

/// One of them.
pub(crate) struct Point {
    /// What each vector of the element's nodes weighs there.
    weight: [f64; 4],
    pub cell: usize,
    /// Stiffness [N/m^p], depth [m] and its rate [m/s].
    pub k: f64,
    pub depth: f64,
    pub rate: f64,
}

fn blend(weight: &[f64; 4], of: &[f64; 4]) -> f64 {
    weight[0] * of[0] + weight[1] * of[1] + weight[2] * of[2] + weight[3] * of[3]
}

impl Level {
    /// The height above it of each vector of an element's nodes, which `first` says where to find in `of`.
    fn of(&self, first: &[usize; 4], of: &[f64]) -> [f64; 4] {
        first.map(|i| dot(&self.n, &three(of, i)))
    }

    /// How an element lies; `rubs` says how many cells it has that do, if any.
    pub fn lies<'a>(&self, span: &'a Span, rubs: Option<usize>, at: &At<'_>) -> Lies<'a> {
        let SpanLine::Cubic { q, v, l } = span.line else { return Lies::Unknown };
        // what presses its tips rubs its cells
        if rubs.is_some() && span.tips.iter().any(Option::is_some) {
            return Lies::Unknown;
        }
        let above = self.height + span.radius;
        let heights = self.of(&q, at.q);
        let [a, da, b, db] = heights;
        let third = l / 3.0;
        let controls = [a, a + third * da, b - third * db, b].map(|h| h - above);
        if controls.iter().all(|h| *h >= 0.0) {
            return Lies::Above;
        }
        let (pieces, count) = match controls.iter().all(|h| *h < 0.0) {
            true => ([[0.0, 1.0]; 2], 1),
            false => below(&controls),
        };
        let cells = rubs.unwrap_or(1);
        Lies::Touches(Lying { span, pieces, count, cells, above, heights, rates: self.of(&v, at.v) })
    }

    /// The longest step from here in which no control point gets deeper than a part of the radius unseen [s].
    pub fn free(&self, span: &Span, at: &At<'_>) -> Option<f64> {
        let SpanLine::Cubic { q, v, l } = span.line else { return None };
        let third = l / 3.0;
        let controls = |[a, da, b, db]: [f64; 4]| [a, a + third * da, b - third * db, b];
        let [x, u, a] = [self.of(&q, at.q), self.of(&v, at.v), self.of(&v, at.a)].map(controls);
        let press = PRESS * span.radius;
        let one = |i: usize| time((x[i] - self.height - span.radius).max(press), -u[i], -a[i]);
        Some((0..4).map(one).fold(f64::INFINITY, f64::min))
    }
}

/// Where a cubic with these control points is below zero, piece by piece and how many there are.
pub fn below(controls: &[f64; 4]) -> ([[f64; 2]; 2], usize) {
    let [a, b, c, d] = *controls;
    // by powers of ξ, and its turning points
    let powers = [a, 3.0 * (b - a), 3.0 * (a - 2.0 * b + c), d - a + 3.0 * (b - c)];
    let height = |xi: f64| powers.iter().rev().fold(0.0, |sum, p| sum * xi + p);
    let slope = |xi: f64| powers[1] + xi * (2.0 * powers[2] + xi * 3.0 * powers[3]);
    let both = |xi: f64| Some([height(xi), slope(xi)]);
    let half = powers[2] * powers[2] - 3.0 * powers[3] * powers[1];
    let mut ends = [0.0, 1.0, 1.0, 1.0];
    if half > 0.0 {
        // both roots without cancellation
        let sum = -(powers[2] + half.sqrt().copysign(powers[2]));
        ends[1] = inside(sum / (3.0 * powers[3]));
        ends[2] = inside(powers[1] / sum);
        if ends[1] > ends[2] {
            ends.swap(1, 2);
        }
    }
    let (mut pieces, mut count) = ([[0.0; 2]; 2], 0);
    let mut since = (a < 0.0).then_some(0.0);
    for pair in ends.windows(2) {
        let (low, high) = (height(pair[0]) < 0.0, height(pair[1]) < 0.0);
        if low == high {
            continue;
        }
        let root = passage(both, [pair[0], pair[1]], 0.5 * (pair[0] + pair[1]), low);
        match since.take() {
            None => since = Some(root),
            Some(from) if count < 2 => {
                pieces[count] = [from, root];
                count += 1;
            }
            Some(_) => {}
        }
    }
    if let Some(from) = since.filter(|_| count < 2) {
        pieces[count] = [from, 1.0];
        count += 1;
    }
    (pieces, count)
}

/// A turning point, or the end if it is elsewhere.
fn inside(xi: f64) -> f64 {
    if xi > 0.0 && xi < 1.0 { xi } else { 1.0 }
}

impl Contact {
    /// The plane that it is, if it is one and fixed in space.
    pub(super) fn level(&self) -> Option<Level> {
        match (&self.fixed.shape, self.fixed.seat) {
            (Shape::Plane, Seat::Ground) => {
                let n = self.fixed.axes[2];
                Some(Level { n, height: dot(&n, &self.fixed.origin) })
            }
            _ => None,
        }
    }

    /// The same where it is as stiff as it is: on the way to an equilibrium it may be softer.
    pub(super) fn level_in(&self, at: &At<'_>) -> Option<Level> {
        if at.relaxed.is_some_and(|r| r.how.relaxes()) { None } else { self.level() }
    }

    /// How a group lies on a plane.
    pub(super) fn lies<'a>(level: Option<&Level>, group: &'a Group, at: &At<'_>) -> Lies<'a> {
        match (level, &group.what) {
            (Some(level), What::Span(span)) => level.lies(span, group.bristles.map(|b| b.cells), at),
            _ => Lies::Unknown,
        }
    }

    /// Adds what a plane does to an element that touches it.
    pub(super) fn add_lying(
        &self,
        level: &Level,
        (group, lying): (&Group, &Lying<'_>),
        (frame, at): (&Frame, &At<'_>),
        out: &mut Assembly<'_>,
        block: &mut Block,
    ) {
        let tangent = out.wants_tangent().then(|| out.weights());
        let (mut force, mut stiff) = ([0.0; 4], [[0.0; 4]; 4]);
        // what presses each cell, and by which of the vectors that move the element
        let mut cells = [(0.0, [0.0; 4]); CELLS];
        lying.each_point(|point| {
            let normal = self.law.normal(point.k, point.depth, point.rate);
            let (pressed, by) = &mut cells[point.cell];
            *pressed += normal.force;
            let part = tangent.map_or(0.0, |w| w.q * normal.by_depth + w.v * normal.by_rate);
            for a in 0..4 {
                force[a] += point.weight[a] * normal.force;
                let part = part * point.weight[a];
                by[a] -= part;
                (0..4).for_each(|b| stiff[a][b] += part * point.weight[b]);
            }
        });
        for a in 0..4 {
            (0..3).for_each(|i| block.add(3 * a + i, -force[a] * level.n[i]));
        }
        if tangent.is_some() {
            block.add_along(&level.n, &stiff);
        }
        for tip in lying.tips() {
            self.add_ball(tip, frame, at, tangent, block, &mut []);
        }
        for cell in 0..group.bristles.map_or(0, |b| b.cells) {
            let (pressed, by) = &cells[cell];
            self.rub(level, group, (cell, *pressed, by), (frame, at), out, block);
        }
    }

    /// Adds the force of the bristle of a cell that is pressed so, by the vectors that move the element.
    fn rub(
        &self,
        level: &Level,
        group: &Group,
        (cell, normal, by): (usize, f64, &[f64; 4]),
        (frame, at): (&Frame, &At<'_>),
        out: &mut Assembly<'_>,
        block: &mut Block,
    ) {
        if !(normal > 0.0) {
            return;
        }
        let pressed = Pressed { normal, n: level.n, ..Pressed::NONE };
        let Some(Bristle { held, hold, .. }) = self.holding(group, cell, &pressed, (frame, at), out) else {
            return;
        };
        let Held::Between { weight, .. } = held else { return };
        for (a, w) in weight.iter().enumerate() {
            (0..3).for_each(|i| block.add(3 * a + i, -w * hold.f[i]));
        }
        if !out.wants_tangent() {
            return;
        }
        let w = out.weights();
        let entry = |i: usize, j: usize| w.q * hold.by_x[i][j] + w.v * hold.by_u[i][j];
        block.add_point(&held, &std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j))));
        if hold.by_normal != [0.0; 3] {
            let spread = |by: &[f64; 4], along: &V3<f64>| -> [f64; MOST] {
                let mut all = [0.0; MOST];
                (0..12).for_each(|k| all[k] = by[k / 3] * along[k % 3]);
                all
            };
            block.add_outer(&spread(&weight, &hold.by_normal), &spread(by, &level.n));
        }
    }
}
