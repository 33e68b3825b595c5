//! The motion of the water in waves at a place, and how a pack of it stands in memory.

use super::memory::Rows;
use crate::current::Current;
use ropewalk_core::{Real, V3, dot};
use ropewalk_sea::Flow;

/// The motion of the water in waves at a place, over lanes. Above the surface it is that at the surface.
#[derive(Clone, Copy, Debug)]
pub struct Swell<R> {
    /// Velocity [m/s].
    pub u: V3<R>,
    /// What it changes by with the place [1/s].
    pub by_x: [V3<R>; 3],
    /// What it changes by with time at a fixed place [m/s²].
    pub by_t: V3<R>,
    /// `∂u/∂t` in the water; other than `by_t` above the surface [m/s²].
    pub rate: V3<R>,
    /// `G_ij = ∂u_i/∂x_j` in the water; other than `by_x` above the surface [1/s].
    pub gradient: [V3<R>; 3],
    /// The acceleration that Morison's equation takes: `∂u/∂t` as one sees it who drifts with the current that carries the waves,
    /// without what the stretching of the column adds [m/s²].
    pub acceleration: V3<R>,
    /// What it changes by with the place, and the rate nearly so [1/s²].
    pub acceleration_by_x: [V3<R>; 3],
    /// Elevation `η` of the surface above its level [m].
    pub elevation: R,
    /// `∂η/∂x` and `∂η/∂y`.
    pub slope: [R; 2],
    /// `∂η/∂t` [m/s].
    pub rising: R,
}

impl<R: Real> Swell<R> {
    /// Of a flow at places that are below the surface, or at it if they lie `above`: 1 if they do, else 0. There the motion follows
    /// the surface, and doesn't change with height.
    #[inline(always)]
    pub(super) fn new(flow: &Flow<R>, above: R) -> Self {
        let Flow { velocity, rate, acceleration, gradient, acceleration_gradient, .. } = *flow;
        let mut by_t = rate;
        for i in 0..3 {
            by_t[i] = (above * gradient[i][2]).fma(flow.rising, by_t[i]);
        }
        Swell {
            u: velocity,
            by_x: followed(gradient, flow.slope, above),
            by_t,
            rate,
            gradient,
            acceleration,
            acceleration_by_x: followed(acceleration_gradient, flow.slope, above),
            elevation: flow.elevation,
            slope: flow.slope,
            rising: flow.rising,
        }
    }

    /// From the rows of a pack.
    #[inline(always)]
    pub(super) fn read(rows: &Rows) -> Self {
        Swell {
            u: three(rows, 0),
            by_x: nine(rows, 3),
            by_t: three(rows, 12),
            rate: three(rows, 15),
            gradient: nine(rows, 18),
            acceleration: three(rows, 27),
            acceleration_by_x: nine(rows, 30),
            elevation: R::read(&rows[39]),
            slope: [R::read(&rows[40]), R::read(&rows[41])],
            rising: R::read(&rows[42]),
        }
    }

    /// Into the rows of a pack, from a lane on.
    #[inline(always)]
    pub(super) fn write(&self, rows: &mut Rows, lane: usize) {
        let Swell { u, by_x, by_t, rate, gradient, acceleration, acceleration_by_x, slope, .. } = self;
        for (first, vector) in [(0, u), (12, by_t), (15, rate), (27, acceleration)] {
            for i in 0..3 {
                vector[i].write(&mut rows[first + i][lane..]);
            }
        }
        for (first, matrix) in [(3, by_x), (18, gradient), (30, acceleration_by_x)] {
            for i in 0..9 {
                matrix[i / 3][i % 3].write(&mut rows[first + i][lane..]);
            }
        }
        for (i, x) in [self.elevation, slope[0], slope[1], self.rising].into_iter().enumerate() {
            x.write(&mut rows[39 + i][lane..]);
        }
    }

    /// How fast the surface rises where one moves with velocity `v`: `∂η/∂t + v·∇η` [m/s].
    #[inline(always)]
    pub fn rise(&self, v: &V3<R>) -> R {
        self.slope[0].fma(v[0], self.slope[1].fma(v[1], self.rising))
    }

    /// Acceleration of the water along its path, `∂u/∂t + G u` with the velocity of waves and current at height `z` [m/s²];
    /// and what it changes by with the place, but for the change of `G`.
    #[inline(always)]
    pub fn along_path(&self, current: &Current, z: R) -> (V3<R>, [V3<R>; 3]) {
        let (mut u, du) = current.at(z);
        for i in 0..3 {
            u[i] += self.u[i];
        }
        let (mut a, mut by_x) = (self.rate, self.acceleration_by_x);
        for i in 0..3 {
            a[i] += dot(&self.gradient[i], &u);
            for j in 0..3 {
                for k in 0..3 {
                    by_x[i][j] += self.gradient[i][k] * self.by_x[k][j];
                }
            }
            by_x[i][2] += dot(&self.gradient[i], &du);
        }
        (a, by_x)
    }
}

/// What changes from place to place, of what follows the surface and doesn't change with height where it lies `above`.
#[inline(always)]
fn followed<R: Real>(of: [V3<R>; 3], [sx, sy]: [R; 2], above: R) -> [V3<R>; 3] {
    // most stations are under water
    if R::of(0.5).all_gt(above) {
        return of;
    }
    let (mut by_x, below) = (of, R::of(1.0) - above);
    for row in &mut by_x {
        let follows = above * row[2];
        *row = [follows.fma(sx, row[0]), follows.fma(sy, row[1]), below * row[2]];
    }
    by_x
}

/// Three numbers from the rows of a pack, and nine.
#[inline(always)]
fn three<R: Real>(rows: &Rows, row: usize) -> V3<R> {
    [R::read(&rows[row]), R::read(&rows[row + 1]), R::read(&rows[row + 2])]
}
#[inline(always)]
fn nine<R: Real>(rows: &Rows, row: usize) -> [V3<R>; 3] {
    [three(rows, row), three(rows, row + 3), three(rows, row + 6)]
}
