//! Slender pieces of parts that touch shapes all along: elements of cables, links of chains, hulls of bodies.

use crate::algebra::lane::V3;
use crate::algebra::rotation::times;
use crate::model::held::{Held, three};
use crate::model::marker::frame;
use crate::model::state::At;

/// A round piece of a part along a curve, by which it touches shapes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactSpan {
    /// Its middle line.
    pub line: SpanLine,
    /// Its radius [m]; 0 if the part has none.
    pub radius: f64,
    /// Unstretched length that it stands for [m].
    pub length: f64,
    /// Where it begins on the part, as unstretched arc length [m].
    pub s: f64,
    /// Whether the part ends with it, at its start and at its end: there it has a tip.
    pub tips: [bool; 2],
    /// How material flows through it, if any does: its line and its length are then those at the start.
    pub flow: Option<SpanFlow>,
}

/// How the nodes of a piece stand on a cable whose ends feed: at `p_i = fixed_i + Σ_k by_ki π_k` with its boundaries `π`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpanFlow {
    /// Places of the coordinate and of the rate of each boundary.
    pub boundaries: [(usize, usize); 2],
    /// How many boundaries there are.
    pub count: usize,
    /// What doesn't move with any boundary [m].
    pub fixed: [f64; 2],
    /// Share of each boundary, by boundary and node.
    pub by: [[f64; 2]; 2],
}

impl SpanFlow {
    /// Material coordinates of both nodes [m].
    pub fn places(&self, q: &[f64]) -> [f64; 2] {
        std::array::from_fn(|i| {
            (0..self.count).fold(self.fixed[i], |p, k| p + self.by[k][i] * q[self.boundaries[k].0])
        })
    }
    /// Their rates [m/s].
    pub fn rates(&self, v: &[f64]) -> [f64; 2] {
        std::array::from_fn(|i| (0..self.count).map(|k| self.by[k][i] * v[self.boundaries[k].1]).sum())
    }
}

/// A line over `ξ` from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SpanLine {
    /// The cubic through two nodes of a cable: of `r`, `r'` of both.
    Cubic {
        /// Index of the first coordinate of each vector.
        q: [usize; 4],
        /// Index of the first velocity of each vector.
        v: [usize; 4],
        /// Unstretched length between the nodes [m].
        l: f64,
    },
    /// Straight on a rigid body.
    Straight {
        /// Index of the body's first coordinate.
        q: usize,
        /// Index of its first velocity.
        v: usize,
        /// Where it begins and ends, in the body's axes [m].
        ends: [V3<f64>; 2],
        /// Which way it goes there: a unit vector.
        along: V3<f64>,
    },
}

/// Values of the shape functions of a cubic of unstretched length `l` at `ξ`.
fn hermite(xi: f64, l: f64) -> [f64; 4] {
    let rest = 1.0 - xi;
    let s3 = xi * xi * (3.0 - 2.0 * xi);
    [1.0 - s3, l * xi * rest * rest, s3, -l * xi * xi * rest]
}

impl SpanLine {
    /// The point at `ξ`.
    #[inline]
    pub fn held(&self, xi: f64) -> Held {
        match *self {
            SpanLine::Cubic { q, v, l } => Held::Between { q, v, weight: hermite(xi, l) },
            SpanLine::Straight { q, v, ends: [a, b], .. } => {
                Held::Beside { q, v, arm: std::array::from_fn(|i| a[i] + xi * (b[i] - a[i])) }
            }
        }
    }

    /// What `r`, `r'` of both nodes weigh at `ξ` of a cubic; nothing of a straight piece.
    #[inline]
    pub fn weights(&self, xi: f64) -> [f64; 4] {
        match *self {
            SpanLine::Cubic { l, .. } => hermite(xi, l),
            SpanLine::Straight { .. } => [0.0; 4],
        }
    }

    /// The point that is `reach` beyond its start (`end` 0) or its end (`end` 1), straight on [m].
    pub fn beyond(&self, end: usize, reach: f64) -> Held {
        match *self {
            SpanLine::Cubic { q, v, .. } => {
                let weight = if end == 0 { [1.0, -reach, 0.0, 0.0] } else { [0.0, 0.0, 1.0, reach] };
                Held::Between { q, v, weight }
            }
            SpanLine::Straight { q, v, ends, along } => {
                let reach = if end == 0 { -reach } else { reach };
                Held::Beside { q, v, arm: std::array::from_fn(|i| ends[end][i] + reach * along[i]) }
            }
        }
    }

    /// Its control points: it lies in their convex hull, and so does its velocity in that of theirs.
    pub fn controls(&self) -> [Held; 4] {
        match *self {
            SpanLine::Cubic { q, v, l } => {
                let third = l / 3.0;
                let weights = [
                    [1.0, 0.0, 0.0, 0.0],
                    [1.0, third, 0.0, 0.0],
                    [0.0, 0.0, 1.0, -third],
                    [0.0, 0.0, 1.0, 0.0],
                ];
                weights.map(|weight| Held::Between { q, v, weight })
            }
            SpanLine::Straight { .. } => [0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0].map(|xi| self.held(xi)),
        }
    }

    /// Where its ends are, and its derivatives by `ξ` there: `[r₀, ∂r₀, r₁, ∂r₁]`.
    #[inline]
    pub fn place(&self, at: &At<'_>) -> [V3<f64>; 4] {
        match self {
            SpanLine::Cubic { q, l, .. } => std::array::from_fn(|n| {
                let x = three(at.q, q[n]);
                if n % 2 == 0 { x } else { x.map(|x| l * x) }
            }),
            SpanLine::Straight { q, ends, .. } => {
                let (r, x) = (frame(&at.q[*q..]), three(at.q, *q));
                let [a, b] = ends.map(|e| times(&r, &e)).map(|e| std::array::from_fn(|i| x[i] + e[i]));
                let way = std::array::from_fn(|i| b[i] - a[i]);
                [a, way, b, way]
            }
        }
    }
}
