//! Arnoldi's method with a queue: Krylov spaces of several start vectors, projected as a whole.
//!
//! Every vector of the basis waits for its turn to be multiplied; what is new in the product joins the queue (Ruhe,
//! Math. Comp. 33 (1979) 680). Several start vectors find eigenvalues that occur several times, and more of them may
//! be added at any time. All vectors are kept and orthogonalised twice.

use super::dense::{self, Eigenpair};
use crate::algebra::lane::{LaneTask, Real, Width, run};
use crate::algebra::noise::Noise;
use crate::model::structure::product::{add, sum};
use crate::solve::linear::SolveError;
use faer::linalg::solvers::Solve;
use faer::{Mat, Side, c64};

/// A linear operator and the inner product `xᵀ W y` in which its basis is orthonormal.
pub(super) trait Operator {
    /// Length of its vectors.
    fn len(&self) -> usize;
    /// `y = A x`.
    fn apply(&mut self, x: &[f64], y: &mut [f64]) -> Result<(), SolveError>;
    /// `y = W x`, symmetric and not negative.
    fn weigh(&mut self, x: &[f64], y: &mut [f64]);
    /// Takes out of a vector what the operator never makes, and as little as possible of the rest.
    fn restrict(&mut self, x: &mut [f64]) -> Result<(), SolveError>;
}

/// An orthonormal basis and what the operator makes of it.
#[derive(Default)]
pub(super) struct Arnoldi {
    basis: Vec<Vec<f64>>,
    /// Of each vector that has had its turn, the product in terms of the basis.
    columns: Vec<Vec<f64>>,
    /// Largest product so far, by which is told what is rounding.
    largest: f64,
    noise: Noise,
    scratch: Vec<f64>,
}

/// Takes the basis out of a vector once, and adds how much of it there was.
struct Removal<'a> {
    basis: &'a [Vec<f64>],
    /// The vector as it was, times the weight.
    weighed: &'a [f64],
    x: &'a mut [f64],
    sum: &'a mut [f64],
}

impl LaneTask for Removal<'_> {
    #[inline(always)]
    fn go<R: Real>(self) {
        for (v, all) in self.basis.iter().zip(self.sum) {
            let part = sum::<R>(v, self.weighed);
            *all += part;
            add::<R>(v, -part, self.x);
        }
    }
}

/// An eigenvalue of the projection.
#[derive(Clone, Debug)]
pub(super) struct Ritz {
    /// The eigenvalue, as real and imaginary part.
    pub value: [f64; 2],
    /// Its vector in terms of the basis.
    pub vector: [Vec<f64>; 2],
    /// `|A x - θ x|` of the vector of size 1.
    pub residual: f64,
}

impl Ritz {
    /// Absolute value of the eigenvalue.
    pub fn size(&self) -> f64 {
        self.value[0].hypot(self.value[1])
    }
}

/// What is left of a vector below this part of the operator's size is rounding.
const NOTHING: f64 = 1e-13;
/// What is left of a vector is little below this part of it.
const LITTLE: f64 = 0.7;

impl Arnoldi {
    /// How many vectors have had their turn.
    pub fn turns(&self) -> usize {
        self.columns.len()
    }
    /// Whether the queue is empty: the space holds all that the operator makes of it.
    pub fn is_closed(&self) -> bool {
        self.turns() == self.basis.len()
    }

    /// Adds a start vector without pattern; false if the basis spans everything already.
    pub fn start(&mut self, op: &mut dyn Operator) -> Result<bool, SolveError> {
        let n = op.len();
        let mut x: Vec<f64> = (0..n).map(|_| self.noise.draw()).collect();
        let whole = self.size(op, &x);
        op.restrict(&mut x)?;
        let size = self.size(op, &x);
        if !(size > 1e-10 * whole) {
            return if size.is_nan() { Err(SolveError::NotFinite) } else { Ok(false) };
        }
        x.iter_mut().for_each(|x| *x /= size);
        let (_, left) = self.orthogonalise(op, &mut x)?;
        if left <= 1e-8 {
            return Ok(false);
        }
        x.iter_mut().for_each(|x| *x /= left);
        self.basis.push(x);
        Ok(true)
    }

    /// Multiplies the vector whose turn it is.
    pub fn step(&mut self, op: &mut dyn Operator) -> Result<(), SolveError> {
        let mut y = vec![0.0; op.len()];
        op.apply(&self.basis[self.turns()], &mut y)?;
        let (mut column, left) = self.orthogonalise(op, &mut y)?;
        let size = column.iter().map(|h| h * h).sum::<f64>().sqrt().hypot(left);
        self.largest = self.largest.max(size);
        if left > NOTHING * self.largest {
            y.iter_mut().for_each(|y| *y /= left);
            self.basis.push(y);
            column.push(left);
        }
        self.columns.push(column);
        Ok(())
    }

    fn size(&mut self, op: &mut dyn Operator, x: &[f64]) -> f64 {
        self.scratch.resize(x.len(), 0.0);
        op.weigh(x, &mut self.scratch);
        let square = dot(x, &self.scratch);
        // rounding may make a tiny square negative; a NaN stays one
        if square < 0.0 { 0.0 } else { square.sqrt() }
    }

    /// Takes the basis out of a vector, and says how much of it there was and what size is left: once more where little
    /// is left, of which rounding is a part (Daniel, Gragg, Kaufman & Stewart, Math. Comp. 30 (1976) 772).
    fn orthogonalise(&mut self, op: &mut dyn Operator, x: &mut [f64]) -> Result<(Vec<f64>, f64), SolveError> {
        let mut sum = vec![0.0; self.basis.len()];
        let mut before = self.size(op, x);
        for _ in 0..2 {
            // the scratch holds the weighed vector as it was
            run(Width::Four, Removal { basis: &self.basis, weighed: &self.scratch, x, sum: &mut sum });
            let left = self.size(op, x);
            let little = left < LITTLE * before;
            before = left;
            if !little {
                break;
            }
        }
        if before.is_finite() { Ok((sum, before)) } else { Err(SolveError::NotFinite) }
    }

    fn projection(&self) -> Mat<f64> {
        let j = self.turns();
        Mat::from_fn(j, j, |r, c| self.columns[c].get(r).copied().unwrap_or(0.0))
    }

    fn residual(&self, s: &[Vec<f64>; 2]) -> f64 {
        let j = self.turns();
        let mut sum = 0.0;
        for s in s {
            let mut out = vec![0.0; self.basis.len() - j];
            for (column, s) in self.columns.iter().zip(s) {
                let beyond = column.iter().skip(j);
                out.iter_mut().zip(beyond).for_each(|(o, h)| *o += h * s);
            }
            sum += out.iter().map(|x| x * x).sum::<f64>();
        }
        sum.sqrt()
    }

    /// Eigenvalues of the projection, largest first; of complex pairs that with the positive imaginary part.
    /// `symmetric` says that the operator is, in its inner product; where it isn't, about the first `leading` are looked at
    /// closely.
    pub fn ritz(&self, symmetric: bool, leading: usize) -> Option<Vec<Ritz>> {
        let (h, j) = (self.projection(), self.turns());
        if j == 0 {
            return Some(Vec::new());
        }
        let mut all = Vec::with_capacity(j);
        let mut keep = |value: c64, vector: [Vec<f64>; 2]| {
            let residual = self.residual(&vector);
            all.push(Ritz { value: [value.re, value.im], vector, residual });
        };
        if symmetric {
            let h = Mat::from_fn(j, j, |r, c| 0.5 * (h[(r, c)] + h[(c, r)]));
            let eigen = h.self_adjoint_eigen(Side::Lower).ok()?;
            let values = eigen.S().column_vector();
            for k in 0..j {
                let vector = (0..j).map(|i| eigen.U()[(i, k)]).collect();
                keep(c64::new(values[k], 0.0), [vector, Vec::new()]);
            }
        } else {
            let mut pairs = dense::eigen(&h)?;
            pairs.sort_by(|a, b| b.0.norm().total_cmp(&a.0.norm()));
            mend(&h, &mut pairs, leading);
            for (value, vector) in &pairs {
                let size = norm(vector);
                let part = |f: fn(&c64) -> f64| vector.iter().map(|z| f(z) / size).collect::<Vec<f64>>();
                keep(*value, [part(|z| z.re), part(|z| z.im)]);
            }
        }
        if all.iter().any(|r| !(r.size().is_finite() && r.residual.is_finite())) {
            return None;
        }
        all.sort_by(|a, b| b.size().total_cmp(&a.size()));
        Some(all)
    }

    /// A vector of the projection in full; the imaginary part is empty where there is none.
    pub fn vector(&self, s: &[Vec<f64>; 2]) -> [Vec<f64>; 2] {
        let n = self.basis.first().map_or(0, Vec::len);
        [0, 1].map(|k| {
            if s[k].iter().all(|x| *x == 0.0) {
                return Vec::new();
            }
            let mut x = vec![0.0; n];
            for (v, s) in self.basis.iter().zip(&s[k]) {
                x.iter_mut().zip(v).for_each(|(x, v)| *x += s * v);
            }
            x
        })
    }
}

/// Eigenvalues that differ by less than this part of themselves are one.
const ONE: f64 = 1e-8;
/// What an eigenvector may leave of its equation, in parts of the largest eigenvalue.
const EXACT: f64 = 1e-12;

/// Computes eigenvectors anew that belong to one eigenvalue several times, or don't meet their equation: a decomposition
/// makes them nearly parallel, or anything. Inverse iteration from as many vectors as there are finds what they span.
/// The largest eigenvalues come first, of which the `leading` ones count.
fn mend(h: &Mat<f64>, pairs: &mut [Eigenpair], leading: usize) {
    let (j, leading) = (h.nrows(), pairs.len().min(leading));
    let largest = pairs.first().map_or(0.0, |(value, _)| value.norm());
    let mut done = vec![false; leading];
    for k in 0..leading {
        let value = pairs[k].0;
        let same: Vec<usize> =
            (k..leading).filter(|&i| !done[i] && (pairs[i].0 - value).norm() <= ONE * value.norm()).collect();
        if done[k] || same.len() == 1 && off(h, &pairs[k]) <= EXACT * largest {
            continue;
        }
        same.iter().for_each(|&i| done[i] = true);
        // beside the eigenvalue, where the matrix is only nearly singular
        let beside = value + c64::new(EXACT * largest, 0.0);
        let shifted = Mat::from_fn(j, j, |r, c| {
            c64::new(h[(r, c)], 0.0) - if r == c { beside } else { c64::new(0.0, 0.0) }
        });
        let lu = shifted.partial_piv_lu();
        let mut span = Mat::from_fn(j, same.len(), |r, c| c64::new(start(r, c), 0.0));
        for _ in 0..3 {
            span = lu.solve(&span).qr().compute_thin_Q();
        }
        for (c, &i) in same.iter().enumerate() {
            let new = (pairs[i].0, (0..j).map(|r| span[(r, c)]).collect());
            // what has fewer vectors than values keeps those of the decomposition
            if off(h, &new) <= off(h, &pairs[i]).max(1e-9 * value.norm()) {
                pairs[i] = new;
            }
        }
    }
}

/// An entry of a start vector without pattern.
fn start(r: usize, c: usize) -> f64 {
    (1.0 + 0.7 * r as f64 * (1.3 + c as f64) + 2.1 * c as f64).sin()
}

/// What an eigenvector leaves of its equation.
fn off(h: &Mat<f64>, (value, vector): &Eigenpair) -> f64 {
    let j = h.nrows();
    let row = |r: usize| (0..j).map(|c| vector[c] * h[(r, c)]).sum::<c64>() - *value * vector[r];
    norm(&(0..j).map(row).collect::<Vec<_>>()) / norm(vector)
}

fn norm(x: &[c64]) -> f64 {
    x.iter().map(|x| x.norm_sqr()).sum::<f64>().sqrt()
}

pub(super) use crate::model::structure::product::sum_of_products as dot;

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use faer::linalg::solvers::DenseSolveCore;

    /// Diagonal blocks: `values` on the diagonal, and a turn between the first two.
    struct Blocks {
        values: Vec<f64>,
        turn: f64,
    }

    impl Operator for Blocks {
        fn len(&self) -> usize {
            self.values.len()
        }
        fn apply(&mut self, x: &[f64], y: &mut [f64]) -> Result<(), SolveError> {
            for i in 0..x.len() {
                y[i] = self.values[i] * x[i];
            }
            y[0] -= self.turn * x[1];
            y[1] += self.turn * x[0];
            Ok(())
        }
        fn weigh(&mut self, x: &[f64], y: &mut [f64]) {
            y.copy_from_slice(x);
        }
        fn restrict(&mut self, _: &mut [f64]) -> Result<(), SolveError> {
            Ok(())
        }
    }

    #[test]
    fn eigenvalues_that_occur_several_times_are_all_found() {
        let mut values = vec![9.0, 9.0, 9.0, 5.0, 5.0, 3.0];
        values.extend((0..60).map(|k| 1.0 / f64::from(k + 1)));
        let mut op = Blocks { values, turn: 0.0 };
        let mut space = Arnoldi::default();
        for _ in 0..4 {
            assert!(space.start(&mut op).unwrap());
        }
        for _ in 0..40 {
            space.step(&mut op).unwrap();
        }
        let found = space.ritz(true, 8).unwrap();
        for (ritz, exact) in found.iter().zip([9.0, 9.0, 9.0, 5.0, 5.0, 3.0, 1.0, 0.5]) {
            assert_relative_eq!(ritz.value[0], exact, max_relative = 1e-11);
            assert!(ritz.residual < 1e-6, "{ritz:?}");
        }
    }

    /// Pairs of turns at the same rate, in a basis that hides them: each has to come with as many vectors as there are turns.
    #[test]
    fn complex_eigenvalues_that_occur_several_times_have_vectors_of_their_own() {
        let rates = [9.0, 9.0, 9.0, 4.0, 4.0, 2.0];
        let j = 2 * rates.len();
        let turns = Mat::from_fn(j, j, |r, c| match (r / 2 == c / 2, r % 2, c % 2) {
            (true, 0, 1) => -rates[r / 2],
            (true, 1, 0) => rates[r / 2],
            _ => 0.0,
        });
        // neither orthogonal nor normal
        let basis = Mat::from_fn(j, j, |r, c| start(r, c) + if r == c { 4.0 } else { 0.0 });
        let h = &basis * &turns * basis.partial_piv_lu().inverse();
        let mut pairs = dense::eigen(&h).unwrap();
        pairs.sort_by(|a, b| b.0.norm().total_cmp(&a.0.norm()));
        mend(&h, &mut pairs, j);
        assert_eq!(pairs.len(), rates.len());
        for ((value, vector), rate) in pairs.iter().zip(rates) {
            assert_relative_eq!(value.im, rate, max_relative = 1e-9);
            assert!(off(&h, &(*value, vector.clone())) < 1e-8, "{value}");
        }
        for (a, b) in [(0, 1), (0, 2), (1, 2), (3, 4)] {
            let (x, y) = (&pairs[a].1, &pairs[b].1);
            let common = x.iter().zip(y).map(|(x, y)| x.conj() * y).sum::<c64>().norm();
            assert!(common < 1e-6 * norm(x) * norm(y), "{a} and {b}: {common}");
        }
    }

    #[test]
    fn a_space_that_is_used_up_is_closed_and_refuses_more() {
        let mut op = Blocks { values: vec![1.0, 1.0, 4.0], turn: 2.0 };
        let mut space = Arnoldi::default();
        while space.start(&mut op).unwrap() {}
        while !space.is_closed() {
            space.step(&mut op).unwrap();
        }
        assert!(!space.start(&mut op).unwrap());
        let found = space.ritz(false, 8).unwrap();
        assert_eq!(found.len(), 2);
        assert_relative_eq!(found[0].value[0], 4.0, max_relative = 1e-12);
        assert_relative_eq!(found[1].value[0], 1.0, max_relative = 1e-12);
        assert_relative_eq!(found[1].value[1], 2.0, max_relative = 1e-12);
        let [re, im] = space.vector(&found[1].vector);
        // the turn: (1, ∓i)
        assert_relative_eq!(re[0].hypot(re[1]), im[0].hypot(im[1]), max_relative = 1e-12);
        assert!(re[2].abs() + im[2].abs() < 1e-12);
    }
}
