//! Eigenvalues and eigenvectors of a small full matrix that isn't symmetric.

use faer::diag::Diag;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::evd::schur::SchurParams;
use faer::linalg::evd::{ComputeEigenvectors, EvdParams, evd_real, evd_scratch};
use faer::{Auto, Mat, Par, Spec, c64};

/// An eigenvalue and its vector.
pub(super) type Eigenpair = (c64, Vec<c64>);

/// The eigenvalues of a matrix and their vectors, of complex pairs those with the positive imaginary part, in no order; `None`
/// where the iteration doesn't converge.
pub(super) fn eigen(h: &Mat<f64>) -> Option<Vec<Eigenpair>> {
    let n = h.nrows();
    // faer 0.24 may sort what it deflates early round and round where eigenvalues differ by rounding: never, without blocks
    let whole = SchurParams { blocking_threshold: usize::MAX, ..Auto::<f64>::auto() };
    let how = || -> Spec<EvdParams, f64> { EvdParams { schur: whole, ..Auto::<f64>::auto() }.into() };
    let (left, right) = (ComputeEigenvectors::No, ComputeEigenvectors::Yes);
    let mut memory = MemBuffer::new(evd_scratch::<f64>(n, left, right, Par::Seq, how()));
    let (mut re, mut im, mut u) = (Diag::zeros(n), Diag::zeros(n), Mat::zeros(n, n));
    let stack = MemStack::new(&mut memory);
    evd_real(h.as_ref(), re.as_mut(), im.as_mut(), None, Some(u.as_mut()), Par::Seq, stack, how()).ok()?;
    let mut pairs = Vec::with_capacity(n);
    let mut k = 0;
    while k < n {
        let real = im[k] == 0.0;
        // the vector of a pair stands in two columns
        let vector = |i| c64::new(u[(i, k)], if real { 0.0 } else { u[(i, k + 1)] });
        pairs.push((c64::new(re[k], im[k]), (0..n).map(vector).collect()));
        k += if real { 1 } else { 2 };
    }
    Some(pairs)
}
