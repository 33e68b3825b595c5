//! What touches: single balls, and slender pieces whose places of contact are found anew at every evaluation.

use super::friction::Grip;
use super::search::{Cubic, Look, Search};
use super::seat::{Fixed, Frame};
use crate::gauss::gauss;
use ropewalk_core::held::Held;
use ropewalk_core::{At, SpanLine};
use std::sync::Arc;

/// A ball that can touch.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ball {
    pub held: Held,
    pub radius: f64,
    /// Stiffness of its contact [N/m^p].
    pub k: f64,
    /// The cell that it presses, of those of its group.
    pub cell: usize,
}

/// What the same unknowns move.
#[derive(Clone, Debug)]
pub(crate) struct Group {
    pub what: What,
    /// Its bristles, one for each cell.
    pub bristles: Option<Bristles>,
    /// Where it is on its part, if that is slender.
    pub place: Option<Place>,
}

/// Where a slender piece begins.
#[derive(Clone, Debug)]
pub(crate) struct Place {
    pub part: Arc<str>,
    /// Unstretched arc length [m].
    pub s: f64,
}

#[derive(Clone, Debug)]
pub(crate) enum What {
    Ball(Ball),
    Span(Box<Span>),
}

/// The bristles of a group.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bristles {
    /// One of them.
    pub grip: Grip,
    /// The place of what the first remembers.
    pub at: usize,
    pub cells: usize,
}

/// A slender piece.
#[derive(Clone, Debug)]
pub(crate) struct Span {
    pub line: SpanLine,
    pub radius: f64,
    /// Unstretched length [m].
    pub length: f64,
    /// Stiffness of its contact if all of it touches [N/m^p].
    pub k: f64,
    /// Its tips, as balls without radius a radius beyond its ends, which are told by their cells.
    pub tips: [Option<Ball>; 2],
    /// Points of the Gauss rule on each interval.
    pub points: usize,
}

/// What the search needs and finds.
#[derive(Default)]
pub(crate) struct Scratch {
    pieces: Vec<[Look; 2]>,
    /// The intervals of the last span that touch.
    pub found: Vec<[f64; 2]>,
    /// The balls that stand for them, or for a single one.
    pub balls: Vec<Ball>,
}

impl Group {
    /// A point of it, which all of its unknowns move.
    pub fn held(&self) -> Held {
        match &self.what {
            What::Ball(ball) => ball.held,
            What::Span(span) => span.line.held(0.5),
        }
    }

    /// The middle of a cell.
    pub fn station(&self, cell: usize) -> Held {
        match &self.what {
            What::Ball(ball) => ball.held,
            What::Span(span) => {
                let cells = self.bristles.map_or(1, |b| b.cells);
                span.line.held((cell as f64 + 0.5) / cells as f64)
            }
        }
    }

    pub fn radius(&self) -> f64 {
        match &self.what {
            What::Ball(ball) => ball.radius,
            What::Span(span) => span.radius,
        }
    }

    /// Puts the balls that may touch into `scratch`.
    pub fn gather(&self, fixed: &Fixed, frame: &Frame, at: &At<'_>, scratch: &mut Scratch) {
        scratch.balls.clear();
        scratch.found.clear();
        let span = match &self.what {
            What::Ball(ball) => return scratch.balls.push(*ball),
            What::Span(span) => span,
        };
        let cells = self.bristles.map_or(1, |b| b.cells);
        if span.is_near(fixed, frame, at) {
            let curve = span.curve(fixed, frame, at);
            let mut search = Search::new(&fixed.shape, &curve, span.radius);
            search.find_near(&mut scratch.pieces, &mut scratch.found);
        }
        for &[from, to] in &scratch.found {
            // cut where one cell ends and the next begins
            let borders = (1..cells).map(|c| c as f64 / cells as f64).filter(|&b| b > from && b < to);
            let mut from = from;
            for to in borders.chain([to]) {
                let part = to - from;
                let cell = ((0.5 * (from + to) * cells as f64) as usize).min(cells - 1);
                // a cell all of which touches is as good as straight
                let whole = cells > 1 && part * cells as f64 > 1.0 - 1e-9;
                let points = if whole { 2 } else { span.points };
                scratch.balls.extend(gauss(points).iter().map(|&(place, weight)| Ball {
                    held: span.line.held(from + part * place),
                    radius: span.radius,
                    k: span.k * part * weight,
                    cell,
                }));
                from = to;
            }
        }
        scratch
            .balls
            .extend(span.tips.iter().flatten().map(|tip| Ball { cell: tip.cell * (cells - 1), ..*tip }));
    }
}

impl Span {
    /// Whether it is nearer to the shape than it is long: for most pieces of a long cable it isn't, and this is all that
    /// they are asked.
    fn is_near(&self, fixed: &Fixed, frame: &Frame, at: &At<'_>) -> bool {
        let line = Cubic(self.line.place(at));
        let middle = fixed.inside(frame, &line.at(0.5));
        fixed.shape.gap(&middle, self.radius + 0.5 * line.speed()).is_some()
    }

    /// Its line in the shape's own axes.
    pub fn curve(&self, fixed: &Fixed, frame: &Frame, at: &At<'_>) -> Cubic {
        let [a, da, b, db] = self.line.place(at);
        let [a, b] = [a, b].map(|x| fixed.inside(frame, &x));
        let [da, db] = [da, db].map(|x| fixed.turned(frame, &x));
        Cubic([a, da, b, db])
    }
}
