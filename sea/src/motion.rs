//! The motion of the water under waves: in space, or in the plane of waves that have one direction.

use crate::axes::Axes;
use ropewalk_core::Real;

/// The surface above a place, over lanes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Top<R> {
    /// Elevation `η` above still water [m].
    pub elevation: R,
    /// `∂η/∂x` and `∂η/∂y`.
    pub slope: [R; 2],
    /// `∂η/∂t` [m/s].
    pub rising: R,
}

impl<R: Real> Top<R> {
    /// How fast it rises where one moves with velocity `v`: `∂η/∂t + v·∇η` [m/s].
    #[inline(always)]
    pub fn rise(&self, v: &[R; 3]) -> R {
        self.slope[0].fma(v[0], self.slope[1].fma(v[1], self.rising))
    }
}

/// The motion at a place, over lanes, in `D` dimensions of which the last is upwards.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion<R, const D: usize> {
    /// Velocity [m/s].
    pub velocity: [R; D],
    /// `∂u/∂t` as one sees it who drifts with the current that carries the waves [m/s²].
    pub acceleration: [R; D],
    /// `∂u/∂t` at a fixed place, with what the stretching of the column adds [m/s²].
    pub rate: [R; D],
    /// `∂u_i/∂x_j` [1/s].
    pub gradient: [[R; D]; D],
    /// The same of the acceleration [1/s²].
    pub acceleration_gradient: [[R; D]; D],
}

impl<R: Real, const D: usize> Motion<R, D> {
    /// Of still water.
    #[inline(always)]
    pub(crate) fn still() -> Self {
        let (none, nothing) = ([R::zero(); D], [[R::zero(); D]; D]);
        Motion {
            velocity: none,
            acceleration: none,
            rate: none,
            gradient: nothing,
            acceleration_gradient: nothing,
        }
    }

    /// Makes what linear theory says at the stretched height, with its derivatives by that, the motion at the place itself. The
    /// stretched height changes `by_z` and `by_eta`, the elevation; the surface has this slope, and rises.
    #[inline(always)]
    pub(crate) fn stretch(&mut self, [by_z, by_eta]: [R; 2], slope: [R; D], rising: R, current: [R; D]) {
        let (last, rises) = (D - 1, by_eta * rising);
        for i in 0..D {
            let by = &self.gradient[i];
            let mut rate = rises.fma(by[last], self.acceleration[i]);
            for j in 0..last {
                rate -= by[j] * current[j];
            }
            self.rate[i] = rate;
        }
        for matrix in [&mut self.gradient, &mut self.acceleration_gradient] {
            for i in 0..D {
                let stretched = matrix[i][last] * by_eta;
                for j in 0..last {
                    matrix[i][j] = stretched.fma(slope[j], matrix[i][j]);
                }
                matrix[i][last] = matrix[i][last] * by_z;
            }
        }
    }

    /// Makes it that of waves that have risen so far, and do so at this rate [1/s].
    #[inline(always)]
    pub(crate) fn rise(&mut self, [risen, rising]: [f64; 2]) {
        if risen == 1.0 && rising == 0.0 {
            return;
        }
        let (risen, rising) = (R::of(risen), R::of(rising));
        for i in 0..D {
            let u = self.velocity[i];
            self.acceleration[i] = risen.fma(self.acceleration[i], rising * u);
            self.rate[i] = risen.fma(self.rate[i], rising * u);
            self.velocity[i] = risen * u;
            for j in 0..D {
                let by = self.gradient[i][j];
                self.acceleration_gradient[i][j] = risen.fma(self.acceleration_gradient[i][j], rising * by);
                self.gradient[i][j] = risen * by;
            }
        }
    }
}

impl<R: Real> Motion<R, 2> {
    /// The same in space.
    #[inline(always)]
    pub fn spread(&self, axes: &Axes<R, 2>) -> Motion<R, 3> {
        Motion {
            velocity: axes.vector(&self.velocity),
            acceleration: axes.vector(&self.acceleration),
            rate: axes.vector(&self.rate),
            gradient: axes.matrix(&self.gradient),
            acceleration_gradient: axes.matrix(&self.acceleration_gradient),
        }
    }
}
