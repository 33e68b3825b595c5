//! What loads on a station in waves change by with its place.

use ropewalk_core::{Load, Real, V3};
use ropewalk_scene::Swell;
use ropewalk_sea::plus_product;

/// The waves at a station, and what loads change by with the place on their account. That is gathered along the axes of the waves,
/// and goes into a load once for all laws.
#[derive(Clone, Copy, Debug)]
pub struct InWaves<R, const D: usize> {
    /// The motion of the water.
    pub swell: Swell<R, D>,
    /// Rows of `∂f/∂x`, and of `∂g/∂x`.
    f_by_x: [[R; D]; 3],
    g_by_x: [[R; D]; 3],
    /// Whether there is something of the second.
    couples: bool,
}

impl<R: Real, const D: usize> InWaves<R, D> {
    /// In these waves.
    #[inline(always)]
    pub fn of(swell: Swell<R, D>) -> Self {
        let none = [[R::zero(); D]; 3];
        InWaves { swell, f_by_x: none, g_by_x: none, couples: false }
    }

    /// Adds to `∂f/∂x` what follows from the derivative by the velocity relative to the water.
    #[inline(always)]
    pub(crate) fn drift(&mut self, f_by_w: &[V3<R>; 3]) {
        self.f_by_x = self.drifted(self.f_by_x, f_by_w);
    }

    /// The same of `g`.
    #[inline(always)]
    pub(crate) fn drift_couple(&mut self, g_by_w: &[V3<R>; 3]) {
        self.g_by_x = self.drifted(self.g_by_x, g_by_w);
        self.couples = true;
    }

    #[inline(always)]
    fn drifted(&self, by_x: [[R; D]; 3], by_w: &[V3<R>; 3]) -> [[R; D]; 3] {
        let mut by_u = [[R::zero(); D]; 3];
        for i in 0..3 {
            by_u[i] = self.swell.axes.along(&[-by_w[i][0], -by_w[i][1], -by_w[i][2]]);
        }
        plus_product(by_x, &by_u, &self.swell.by_x)
    }

    /// Adds to `∂f/∂x` a factor times a matrix along the axes.
    #[inline(always)]
    pub(crate) fn add(&mut self, factor: R, by_x: &[[R; D]; D]) {
        let rows = self.swell.axes.rows(by_x);
        for i in 0..3 {
            for j in 0..D {
                self.f_by_x[i][j] = factor.fma(rows[i][j], self.f_by_x[i][j]);
            }
        }
    }

    /// Adds `x yᵀ` to `∂f/∂x`, with `y` along the axes.
    #[inline(always)]
    pub(crate) fn add_outer(&mut self, x: &V3<R>, y: &[R; D]) {
        for i in 0..3 {
            for j in 0..D {
                self.f_by_x[i][j] = x[i].fma(y[j], self.f_by_x[i][j]);
            }
        }
    }

    /// Puts what has been gathered into the load that it belongs to.
    #[inline(always)]
    pub fn put(&self, out: &mut Load<R>) {
        let axes = &self.swell.axes;
        for i in 0..3 {
            let f = axes.vector(&self.f_by_x[i]);
            for j in 0..3 {
                out.d_x[i][j] += f[j];
            }
            if self.couples {
                let g = axes.vector(&self.g_by_x[i]);
                for j in 0..3 {
                    out.g_x[i][j] += g[j];
                }
            }
        }
    }
}
