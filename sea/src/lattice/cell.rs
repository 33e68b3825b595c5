//! Polynomials between the corners of a cell, and between the ends of an edge.

use super::SPOTS;
use num_complex::Complex64;
use ropewalk_core::Real;

/// Numbers at a corner: real and imaginary part of `f` and of its rate, and of `i` times both; then the same of the derivatives of
/// both by `ζ`.
pub(super) type Corner = [f64; 16];
/// Numbers at a spot at an instant: `f` and its rate, their first and their second derivatives.
pub(super) type Spot = [[f64; 4]; 3];
/// The surface at a place: elevation, slope, and how that changes; then the rates of these.
pub(super) type Top = [f64; 6];

/// The polynomials in a square cell of width 1, whose first corner is at `ζ = 0` and its second at 1; the others are below, and
/// downwards is `-i`.
#[derive(Clone, Debug)]
pub(super) struct Cell {
    /// At each spot, row by row, the value, first and second derivative of the polynomials that belong to `f` and `f'` of each
    /// corner.
    weights: Vec<[[Complex64; 8]; 3]>,
}

const CORNERS: [Complex64; 4] = [
    Complex64::new(0.0, 0.0),
    Complex64::new(1.0, 0.0),
    Complex64::new(0.0, -1.0),
    Complex64::new(1.0, -1.0),
];

impl Cell {
    pub fn new() -> Self {
        let all = polynomials();
        let spot = |k: usize| {
            let place = Complex64::new((k % SPOTS) as f64, -((k / SPOTS) as f64)) / SPOTS as f64;
            let at = all.map(|p| values(&p, place));
            std::array::from_fn(|d| std::array::from_fn(|m| at[m][d]))
        };
        Cell { weights: (0..SPOTS * SPOTS).map(spot).collect() }
    }

    /// What is at a spot of a cell of this width with these corners; over four lanes at most.
    #[inline(always)]
    pub fn spot<R: Real>(&self, [along, down]: [usize; 2], corners: [&Corner; 4], width: f64) -> Spot {
        let (weights, mut out) = (&self.weights[down * SPOTS + along], [[0.0; 4]; 3]);
        let (wide, per) = (R::of(width), R::of(1.0 / width));
        for first in (0..4).step_by(R::LANES) {
            // in two chains each, which don't wait for one another
            let mut sums = [[R::zero(); 2]; 3];
            for m in 0..8 {
                let numbers = &corners[m / 2][8 * (m % 2) + first..];
                let (mut of, mut turned) = (R::read(numbers), R::read(&numbers[4..]));
                if m % 2 == 1 {
                    (of, turned) = (wide * of, wide * turned);
                }
                for d in 0..3 {
                    let w = &weights[d][m];
                    sums[d] = [R::of(w.re).fma(of, sums[d][0]), R::of(w.im).fma(turned, sums[d][1])];
                }
            }
            let [f, by, bend] = [sums[0][0] + sums[0][1], sums[1][0] + sums[1][1], sums[2][0] + sums[2][1]];
            for (sum, out) in [f, per * by, per * per * bend].into_iter().zip(&mut out) {
                sum.write(&mut out[first..]);
            }
        }
        out
    }
}

/// Coefficients, the constant one first, of the polynomials of degree 7 that are 1 at a corner, or of slope 1, and meet nought
/// with slope nought at all others (Hermite).
fn polynomials() -> [[Complex64; 8]; 8] {
    let mut all = [[Complex64::ZERO; 8]; 8];
    for m in 0..4 {
        let (mut p, mut steep) = ([Complex64::ZERO; 8], Complex64::ZERO);
        p[0] = Complex64::ONE;
        for n in (0..4).filter(|n| *n != m) {
            let apart = CORNERS[m] - CORNERS[n];
            steep += 2.0 / apart;
            for _ in 0..2 {
                p = times(&p, -CORNERS[n] / apart, 1.0 / apart);
            }
        }
        all[2 * m] = times(&p, 1.0 + steep * CORNERS[m], -steep);
        all[2 * m + 1] = times(&p, -CORNERS[m], Complex64::ONE);
    }
    all
}

/// A polynomial times `a + b ζ`.
fn times(p: &[Complex64; 8], a: Complex64, b: Complex64) -> [Complex64; 8] {
    std::array::from_fn(|k| a * p[k] + if k > 0 { b * p[k - 1] } else { Complex64::ZERO })
}

/// Value, first and second derivative of a polynomial.
fn values(p: &[Complex64], place: Complex64) -> [Complex64; 3] {
    let [mut value, mut first, mut half] = [Complex64::ZERO; 3];
    for coefficient in p.iter().rev() {
        half = half * place + first;
        first = first * place + value;
        value = value * place + coefficient;
    }
    [value, first, 2.0 * half]
}

/// The polynomials of degree 5 on an edge of length 1 that meet values, slopes and second derivatives at both ends.
#[derive(Clone, Debug)]
pub(super) struct Edge {
    /// At each spot the value, first and second derivative of those that belong to the first end, and to the second.
    weights: [[[f64; 6]; 3]; SPOTS],
}

impl Edge {
    pub fn new() -> Self {
        const ALL: [[f64; 6]; 6] = [
            [1.0, 0.0, 0.0, -10.0, 15.0, -6.0],
            [0.0, 1.0, 0.0, -6.0, 8.0, -3.0],
            [0.0, 0.0, 0.5, -1.5, 1.5, -0.5],
            [0.0, 0.0, 0.0, 10.0, -15.0, 6.0],
            [0.0, 0.0, 0.0, -4.0, 7.0, -3.0],
            [0.0, 0.0, 0.0, 0.5, -1.0, 0.5],
        ];
        let weights = std::array::from_fn(|spot| {
            let x = spot as f64 / SPOTS as f64;
            let at = ALL.map(|p| values(&p.map(Complex64::from), Complex64::from(x)).map(|value| value.re));
            std::array::from_fn(|d| std::array::from_fn(|m| at[m][d]))
        });
        Edge { weights }
    }

    /// The surface at a spot of an edge of this length.
    #[inline(always)]
    pub fn spot(&self, along: usize, ends: [&Top; 2], length: f64) -> Top {
        let (mut out, mut per) = ([0.0; 6], 1.0);
        for (d, weights) in self.weights[along].iter().enumerate() {
            for rate in [0, 3] {
                for (end, w) in ends.iter().zip(weights.as_chunks::<3>().0) {
                    let [y, by, bend] = [end[rate], end[rate + 1] * length, end[rate + 2] * length * length];
                    out[rate + d] += per * (w[0] * y + w[1] * by + w[2] * bend);
                }
            }
            per /= length;
        }
        out
    }
}
