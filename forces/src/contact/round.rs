//! Where a curve is nearer to a ball, or to an axis, than so much: the roots of a polynomial.
//!
//! The square of a distance from a point or from an axis is a polynomial of degree 6 along a cubic. Its Bernstein coefficients
//! bound it, and where they change their sign once it has one root, no more (Descartes); each halving brings them nearer to it by
//! a factor of four. What lies around a drum is decided at once: all coefficients are nearly the same there.

use super::search::{SHORTEST, passage};
use ropewalk_core::V3;

/// A polynomial over 0 … 1 by its Bernstein coefficients: it lies between the least and the largest of them. What is no larger
/// than its noise has no sign: else all of what lies along a flank without being pressed would be halved to the last piece.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sextic {
    coefficients: [f64; 7],
    noise: f64,
}

/// Rounding of a coefficient, in parts of the squares that it is the difference of.
const NOISE: f64 = 16.0 * f64::EPSILON;

impl Sextic {
    /// The square of the distance of a cubic, which has these control points, from the origin; or from the axis z if only two
    /// of its `dimensions` count.
    pub fn square(controls: &[V3<f64>; 4], dimensions: usize) -> Self {
        const BINOMIALS: [f64; 4] = [1.0, 3.0, 3.0, 1.0];
        const OF_SIX: [f64; 7] = [1.0, 6.0, 15.0, 20.0, 15.0, 6.0, 1.0];
        let mut all = [0.0; 7];
        for (i, (a, m)) in controls.iter().zip(BINOMIALS).enumerate() {
            for (j, (b, n)) in controls.iter().zip(BINOMIALS).enumerate() {
                let product: f64 = a.iter().zip(b).take(dimensions).map(|(a, b)| a * b).sum();
                all[i + j] += m * n * product;
            }
        }
        Sextic { coefficients: std::array::from_fn(|k| all[k] / OF_SIX[k]), noise: 0.0 }
    }

    /// `factor` times it, less a number.
    pub fn less(&self, number: f64, factor: f64) -> Self {
        let coefficients = self.coefficients.map(|c| factor * (c - number));
        Sextic { coefficients, noise: NOISE * (factor * number).abs() }
    }

    /// Value and slope.
    fn at(&self, xi: f64) -> [f64; 2] {
        let (mut c, rest) = (self.coefficients, 1.0 - xi);
        for last in (1..6).rev() {
            for k in 0..=last {
                c[k] = rest * c[k] + xi * c[k + 1];
            }
        }
        [rest * c[0] + xi * c[1], 6.0 * (c[1] - c[0])]
    }

    /// Its halves.
    fn halves(&self) -> [Self; 2] {
        let (mut left, mut right) = (self.coefficients, self.coefficients);
        for first in 1..7 {
            for k in (first..7).rev() {
                left[k] = 0.5 * (left[k - 1] + left[k]);
            }
            for k in 0..7 - first {
                right[k] = 0.5 * (right[k] + right[k + 1]);
            }
        }
        [left, right].map(|coefficients| Sextic { coefficients, ..*self })
    }

    /// Whether its coefficients are above zero, of those that have a sign.
    fn signs(&self) -> impl DoubleEndedIterator<Item = bool> + Clone {
        let noise = self.noise;
        self.coefficients.into_iter().filter(move |c| c.abs() > noise).map(|c| c > 0.0)
    }

    /// The places where it is above zero, from `ξ` to `ξ`, in order, put behind those in `found`.
    pub fn positive(&self, found: &mut Vec<[f64; 2]>) {
        let first = found.len();
        self.positive_in(0.0, 1.0, first, found);
    }

    fn positive_in(&self, from: f64, h: f64, first: usize, found: &mut Vec<[f64; 2]>) {
        let to = from + h;
        let mut add = |a: f64, b: f64| match found[first..].last_mut() {
            // pieces that adjoin are one
            Some(last) if last[1] == a => last[1] = b,
            _ => found.push([a, b]),
        };
        let last = self.signs().next_back() == Some(true);
        match self.signs().zip(self.signs().skip(1)).filter(|(a, b)| a != b).count() {
            0 if last => add(from, to),
            0 => {}
            1 => {
                let [a, .., b] = self.coefficients;
                let guess = if a == b { 0.5 } else { a / (a - b) };
                let root = from + h * passage(|xi| Some(self.at(xi)), [0.0, 1.0], guess, last);
                if last { add(root, to) } else { add(from, root) }
            }
            _ if h > SHORTEST => {
                let [left, right] = self.halves();
                left.positive_in(from, 0.5 * h, first, found);
                right.positive_in(from + 0.5 * h, 0.5 * h, first, found);
            }
            _ if self.at(0.5)[0] > 0.0 => add(from, to),
            _ => {}
        }
    }
}
