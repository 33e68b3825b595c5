//! What can touch what.

use super::curve::{Curve, size};
use super::facing::{Facing, Window};
use ropewalk_core::{SpanLine, V3};
use std::f64::consts::PI;

/// A slender piece of a line.
#[derive(Clone, Debug)]
pub(crate) struct Piece {
    /// The number of its line.
    pub line: usize,
    pub span: SpanLine,
    pub radius: f64,
    /// Unstretched length, and where it begins along the line [m].
    pub length: f64,
    pub s: f64,
    pub tips: [bool; 2],
    /// Parts of it that don't touch a certain other line, since both are tied to each other there: the line, and from
    /// where to where.
    pub tied: Vec<(usize, [f64; 2])>,
}

/// All pieces.
#[derive(Clone, Debug)]
pub(crate) struct Pieces {
    pub all: Vec<Piece>,
    /// Names of the lines.
    pub names: Vec<String>,
    /// Whether lines touch themselves.
    pub itself: bool,
    /// How far apart pieces are that are worth knowing of, in parts of their thickness and of their length [m].
    pub margin: f64,
}

/// Along a line what is nearer than this many diameters isn't looked at: the half circle that it can just be bent into.
/// A chord over as much of any curve that is bent less is no shorter than the diameter (Schur), so that nothing is missed,
/// and no force sets in with a jump.
pub(crate) const APART: f64 = 0.5 * PI;

impl Pieces {
    /// What two pieces have to be apart along their line [m].
    pub fn apart(&self, i: usize, j: usize) -> f64 {
        APART * self.thick(i, j)
    }

    /// The sum of the radii [m].
    pub fn thick(&self, i: usize, j: usize) -> f64 {
        self.all[i].radius + self.all[j].radius
    }

    /// Whether two pieces, `i` not behind `j`, can touch at all.
    pub fn may(&self, i: usize, j: usize) -> bool {
        let (a, b) = (&self.all[i], &self.all[j]);
        if a.line != b.line {
            return true;
        }
        self.itself && b.s + b.length - a.s > self.apart(i, j)
    }

    /// The neighbours of a link of a chain, before and behind it.
    pub fn links(&self, k: usize) -> [Option<usize>; 2] {
        let piece = &self.all[k];
        let link = matches!(piece.span, SpanLine::Straight { .. });
        [(link && !piece.tips[0]).then(|| k - 1), (link && !piece.tips[1]).then(|| k + 1)]
    }

    /// The directions across the planes that part a link from its neighbours.
    pub fn corners(&self, k: usize, curves: &[Option<Curve>]) -> [Option<V3<f64>>; 2] {
        let way = |k: usize| {
            let slope = curves[k].as_ref()?.cubic.slope(0.5);
            let length = size(&slope);
            Some(slope.map(|x| x / length))
        };
        self.links(k).map(|neighbour| {
            let (own, other) = (way(k)?, way(neighbour?)?);
            Some(std::array::from_fn(|i| own[i] + other[i]))
        })
    }

    /// The first piece as it faces the second; of one that faces itself, what is `ahead` or behind.
    pub fn facing<'a>(&self, [i, j]: [usize; 2], curves: [&'a Curve; 2], ahead: bool) -> Option<Facing<'a>> {
        let (a, b) = (&self.all[i], &self.all[j]);
        let window = (a.line == b.line).then(|| {
            let apart = if ahead { self.apart(i, j) } else { -self.apart(i, j) };
            Window { at: (a.s + apart - b.s) / b.length, rate: a.length / b.length, ahead }
        });
        let mut range = [0.0, 1.0];
        for (_, [from, to]) in a.tied.iter().filter(|(line, _)| *line == b.line) {
            // where lines are tied there is a node
            if *from <= 0.0 {
                range[0] = f64::max(range[0], *to);
            } else if *to >= 1.0 {
                range[1] = f64::min(range[1], *from);
            }
        }
        let [one, other] = curves;
        Facing { one, other, thick: self.thick(i, j), tips: b.tips, corners: [None; 2], window, range }
            .narrowed()
    }
}
