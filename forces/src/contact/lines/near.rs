//! Which pieces are near each other, and how long that is known for.
//!
//! The list holds for the state that it was made at and for all in which no piece has moved by more than half of the
//! margin against the mean of all: what isn't listed was farther apart than the margin. Pieces of a straight stretch of one
//! line can't touch each other whatever their distance; that they still lie in one is looked at anew.

use super::curve::{Curve, size};
use super::pieces::{Piece, Pieces};
use ropewalk_core::{At, V3, dot};

/// Two pieces that may come to touch.
#[derive(Clone, Debug)]
pub(crate) struct Couple {
    /// Their numbers, the smaller one first.
    pub pieces: [usize; 2],
    /// The unknowns of both, each once.
    pub dofs: Vec<usize>,
    /// Which of these each piece's own are.
    pub place: [Vec<usize>; 2],
}

/// The pieces that are near each other around a state.
#[derive(Clone, Debug)]
pub(crate) struct Near {
    /// Control points of all pieces there, and their mean.
    reference: Vec<[V3<f64>; 4]>,
    mean: V3<f64>,
    pub couples: Vec<Couple>,
    /// Pieces of the same line that are near each other on a straight stretch.
    straight: Vec<[usize; 2]>,
    /// Pieces that are near any.
    pub active: Vec<usize>,
}

/// On a stretch whose slopes all point this much in one direction, what is at least π/2 diameters apart along it can't be
/// nearer than a diameter.
const FORWARD: f64 = 2.0 / std::f64::consts::PI;
/// The same with something to spare, when the list is made.
const STRAIGHT: f64 = FORWARD + 0.15;
/// The part of the margin behind which the list is made anew.
const WORN: f64 = 0.25;
/// The part of it within which it holds.
const HOLDS: f64 = 0.5;

fn controls(piece: &Piece, at: &At<'_>) -> [V3<f64>; 4] {
    piece.span.controls().map(|held| held.x(at))
}

fn mean(all: &[[V3<f64>; 4]]) -> V3<f64> {
    let count = 4.0 * all.len() as f64;
    let sum = |i: usize| all.iter().flatten().map(|p| p[i]).sum::<f64>();
    std::array::from_fn(|i| sum(i) / count)
}

impl Couple {
    fn new(pieces: &Pieces, i: usize, j: usize) -> Self {
        let mut dofs: Vec<usize> = Vec::with_capacity(24);
        let place = [i, j].map(|k| {
            let own = pieces.all[k].span.held(0.5);
            let mut place = Vec::with_capacity(own.size());
            for dof in own.dofs() {
                place.push(dofs.iter().position(|d| *d == dof).unwrap_or_else(|| {
                    dofs.push(dof);
                    dofs.len() - 1
                }));
            }
            place
        });
        Couple { pieces: [i, j], dofs, place }
    }
}

impl Near {
    /// The list around a state.
    pub fn new(pieces: &Pieces, at: &At<'_>) -> Self {
        let reference: Vec<_> = pieces.all.iter().map(|p| controls(p, at)).collect();
        let (mut couples, mut straight) = (Vec::new(), Vec::new());
        for [i, j] in within(pieces, at, pieces.margin) {
            if pieces.all[i].line == pieces.all[j].line && forward(&reference[i..=j], STRAIGHT) {
                straight.push([i, j]);
            } else {
                couples.push(Couple::new(pieces, i, j));
            }
        }
        let mut active: Vec<usize> = couples.iter().flat_map(|c| c.pieces).collect();
        active.sort_unstable();
        active.dedup();
        Near { mean: mean(&reference), reference, couples, straight, active }
    }

    /// Whether the list is as good as new.
    pub fn is_fresh(&self, pieces: &Pieces, at: &At<'_>) -> bool {
        self.moved(pieces, at) <= WORN * pieces.margin && self.is_straight(pieces, at)
    }

    /// Whether nothing touches that isn't listed.
    pub fn holds(&self, pieces: &Pieces, at: &At<'_>) -> bool {
        self.moved(pieces, at) <= HOLDS * pieces.margin && self.is_straight(pieces, at)
    }

    /// Whether these are listed.
    pub fn lists(&self, pair: [usize; 2]) -> bool {
        self.couples.binary_search_by(|c| c.pieces.cmp(&pair)).is_ok()
    }

    fn is_straight(&self, pieces: &Pieces, at: &At<'_>) -> bool {
        if self.straight.is_empty() {
            return true;
        }
        let now: Vec<_> = pieces.all.iter().map(|p| controls(p, at)).collect();
        self.straight.iter().all(|&[i, j]| forward(&now[i..=j], FORWARD))
    }

    /// How far the piece that has moved most has moved against the mean of all [m].
    fn moved(&self, pieces: &Pieces, at: &At<'_>) -> f64 {
        self.each_moved(pieces, at).fold(0.0, |most, (_, moved)| if moved <= most { most } else { moved })
    }

    fn each_moved<'a>(
        &'a self,
        pieces: &'a Pieces,
        at: &'a At<'_>,
    ) -> impl Iterator<Item = (usize, f64)> + 'a {
        let now: Vec<_> = pieces.all.iter().map(|p| controls(p, at)).collect();
        let middle = mean(&now);
        let shift: V3<f64> = std::array::from_fn(|i| middle[i] - self.mean[i]);
        now.into_iter().zip(&self.reference).enumerate().map(move |(k, (now, then))| {
            let moved = now.iter().zip(then).map(|(a, b)| {
                let d: V3<f64> = std::array::from_fn(|i| a[i] - b[i] - shift[i]);
                dot(&d, &d)
            });
            (k, moved.fold(0.0, |m, x| if x <= m { m } else { x }).sqrt())
        })
    }

    /// What is left of the way of each piece while the list holds [m].
    pub fn left<'a>(&'a self, pieces: &'a Pieces, at: &'a At<'_>) -> impl Iterator<Item = (usize, f64)> + 'a {
        let whole = HOLDS * pieces.margin;
        // what has gone too far is taken back, not stopped for good
        self.each_moved(pieces, at).map(move |(k, moved)| (k, (whole - moved).max(0.1 * whole)))
    }
}

/// Whether neighbouring pieces, by their control points, all lead forward.
fn forward(pieces: &[[V3<f64>; 4]], least: f64) -> bool {
    let (first, last) = (pieces[0][0], pieces[pieces.len() - 1][3]);
    let chord: V3<f64> = std::array::from_fn(|i| last[i] - first[i]);
    let length = size(&chord);
    // stretched cables are straighter than that: slopes are compared with the largest of their piece
    pieces.iter().all(|p| {
        let ways: [V3<f64>; 3] = std::array::from_fn(|k| std::array::from_fn(|i| p[k + 1][i] - p[k][i]));
        let most = ways.iter().map(size).fold(0.0, f64::max);
        ways.iter().all(|w| dot(w, &chord) >= least * most * length)
    })
}

/// The pairs of pieces that can touch and are nearer than this, in order.
pub(crate) fn within(pieces: &Pieces, at: &At<'_>, margin: f64) -> Vec<[usize; 2]> {
    let curves: Vec<Curve> = pieces.all.iter().map(|p| Curve::of(&p.span, at)).collect();
    let spread = |i: usize| {
        let low = curves.iter().map(|c| c.low[i]).fold(f64::INFINITY, f64::min);
        curves.iter().map(|c| c.high[i]).fold(f64::NEG_INFINITY, f64::max) - low
    };
    let axis = (0..3).fold(0, |best, i| if spread(i) > spread(best) { i } else { best });
    let most = pieces.all.iter().map(|p| p.radius).fold(0.0, f64::max);
    let mut order: Vec<usize> = (0..curves.len()).collect();
    order.sort_by(|&i, &j| curves[i].low[axis].total_cmp(&curves[j].low[axis]));
    let mut found = Vec::new();
    for (k, &one) in order.iter().enumerate() {
        let end = curves[one].high[axis] + pieces.all[one].radius + most + margin;
        for &other in order[k..].iter().take_while(|&&other| curves[other].low[axis] <= end) {
            let (i, j) = (one.min(other), one.max(other));
            let reach = pieces.thick(i, j) + margin;
            if !pieces.may(i, j) || curves[i].is_apart(&curves[j], reach) {
                continue;
            }
            let (a, b) = (curves[i].cubic.at(0.5), curves[j].cubic.at(0.5));
            let way: V3<f64> = std::array::from_fn(|i| a[i] - b[i]);
            if size(&way) <= reach + 0.5 * (curves[i].speed + curves[j].speed) {
                found.push([i, j]);
            }
        }
    }
    found.sort_unstable();
    found
}
