//! The unknowns of a term of a few nodes, as it moves.

use ropewalk_core::{At, Jet, Seeds, V3, Weights};

/// Increments, velocities and accelerations of `N` unknowns.
pub(super) struct Local<S, const N: usize> {
    pub d: [S; N],
    pub v: [S; N],
    pub a: [S; N],
}

impl<const N: usize> Local<f64, N> {
    /// Those at these places, as they are now; the rest is 0.
    pub fn of(dofs: &[usize], at: &At<'_>) -> Self {
        let mut x = Local { d: [0.0; N], v: [0.0; N], a: [0.0; N] };
        for (i, &dof) in dofs.iter().enumerate() {
            (x.v[i], x.a[i]) = (at.v[dof], at.a[dof]);
        }
        x
    }

    /// The same, each changing by these weights: see [`Residuals`](ropewalk_core::Residuals).
    #[inline(always)]
    pub fn along<S: Jet>(&self, w: Weights, seeds: &impl Seeds<S>) -> Local<S, N> {
        let mut x = Local { d: [S::zero(); N], v: [S::zero(); N], a: [S::zero(); N] };
        for i in 0..N {
            x.d[i] = seeds.of(i, self.d[i], w.q);
            x.v[i] = seeds.of(i, self.v[i], w.v);
            x.a[i] = seeds.of(i, self.a[i], w.a);
        }
        x
    }
}

/// Three numbers side by side.
#[inline(always)]
pub(super) fn from<S: Copy>(x: &[S], i: usize) -> V3<S> {
    [x[i], x[i + 1], x[i + 2]]
}
