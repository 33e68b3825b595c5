//! The motion of the water in waves at a place, and how a pack of it stands in memory.

use super::memory::Rows;
use crate::current::Current;
use ropewalk_core::{Real, V3};
use ropewalk_sea::{Axes, Motion, Top, plus_product};

/// The motion of the water in waves at a place, over lanes. Above the surface it is that at the surface.
///
/// Gradients are matrices along its [axes](Swell::axes): those of space, or two in the plane of waves of one direction.
#[derive(Clone, Copy, Debug)]
pub struct Swell<R, const D: usize = 3> {
    /// The axes.
    pub axes: Axes<R, D>,
    /// Velocity [m/s].
    pub u: V3<R>,
    /// What it changes by with the place [1/s].
    pub by_x: [[R; D]; D],
    /// What it changes by with time at a fixed place [m/s²].
    pub by_t: V3<R>,
    /// `∂u/∂t` in the water; other than `by_t` above the surface [m/s²].
    pub rate: V3<R>,
    /// `G_ij = ∂u_i/∂x_j` in the water; other than `by_x` above the surface [1/s].
    pub gradient: [[R; D]; D],
    /// The acceleration that Morison's equation takes: `∂u/∂t` as one sees it who drifts with the current that carries the waves,
    /// without what the stretching of the column adds [m/s²].
    pub acceleration: V3<R>,
    /// What it changes by with the place, and the rate nearly so [1/s²].
    pub acceleration_by_x: [[R; D]; D],
    /// The surface above.
    pub top: Top<R>,
}

impl<R: Real, const D: usize> Swell<R, D> {
    /// Of the motion at places that are below the surface, or at it if they lie `above`: 1 if they do, else 0. There the motion
    /// follows the surface, and doesn't change with height.
    #[inline(always)]
    pub(super) fn new(axes: Axes<R, D>, motion: &Motion<R, D>, top: Top<R>, above: R) -> Self {
        let Motion { velocity, rate, acceleration, gradient, acceleration_gradient } = *motion;
        let (mut by_t, steep) = (rate, axes.along(&[top.slope[0], top.slope[1], R::zero()]));
        for i in 0..D {
            by_t[i] = (above * gradient[i][D - 1]).fma(top.rising, by_t[i]);
        }
        Swell {
            u: axes.vector(&velocity),
            by_x: followed(gradient, steep, above),
            by_t: axes.vector(&by_t),
            rate: axes.vector(&rate),
            gradient,
            acceleration: axes.vector(&acceleration),
            acceleration_by_x: followed(acceleration_gradient, steep, above),
            top,
            axes,
        }
    }

    /// Acceleration of the water along its path, `∂u/∂t + G u` with the velocity of waves and current at height `z` [m/s²];
    /// what it changes by with the place along the axes, but for the change of `G`; and with height as the current does.
    #[inline(always)]
    pub fn along_path(&self, current: &Current, z: R) -> (V3<R>, [[R; D]; D], V3<R>) {
        let (mut u, du) = current.at(z);
        for i in 0..3 {
            u[i] += self.u[i];
        }
        let (mut a, carried, by_z) = (self.rate, self.carried(&u), self.carried(&du));
        for i in 0..3 {
            a[i] += carried[i];
        }
        (a, plus_product(self.acceleration_by_x, &self.gradient, &self.by_x), by_z)
    }

    /// `G x`: what the velocity changes by over so far.
    #[inline(always)]
    pub fn carried(&self, x: &V3<R>) -> V3<R> {
        let (g, x) = (&self.gradient, self.axes.along(x));
        let mut out = [R::zero(); D];
        for i in 0..D {
            for j in 0..D {
                out[i] = g[i][j].fma(x[j], out[i]);
            }
        }
        self.axes.vector(&out)
    }
}

impl<R: Real> Swell<R, 2> {
    /// The same in space.
    #[inline(always)]
    pub(super) fn spread(&self) -> Swell<R> {
        let Swell { axes, u, by_t, rate, acceleration, top, .. } = *self;
        Swell {
            axes: Axes::space(),
            by_x: axes.matrix(&self.by_x),
            gradient: axes.matrix(&self.gradient),
            acceleration_by_x: axes.matrix(&self.acceleration_by_x),
            u,
            by_t,
            rate,
            acceleration,
            top,
        }
    }
}

impl<R: Real> Swell<R> {
    /// From the rows of a pack.
    #[inline(always)]
    pub(super) fn read(rows: &Rows) -> Self {
        Swell {
            axes: Axes::space(),
            u: three(rows, 0),
            by_x: nine(rows, 3),
            by_t: three(rows, 12),
            rate: three(rows, 15),
            gradient: nine(rows, 18),
            acceleration: three(rows, 27),
            acceleration_by_x: nine(rows, 30),
            top: Top {
                elevation: R::read(&rows[39]),
                slope: [R::read(&rows[40]), R::read(&rows[41])],
                rising: R::read(&rows[42]),
            },
        }
    }

    /// Into the rows of a pack, from a lane on.
    #[inline(always)]
    pub(super) fn write(&self, rows: &mut Rows, lane: usize) {
        let Swell { u, by_x, by_t, rate, gradient, acceleration, acceleration_by_x, top, .. } = self;
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
        let Top { elevation, slope, rising } = top;
        for (i, x) in [elevation, &slope[0], &slope[1], rising].into_iter().enumerate() {
            x.write(&mut rows[39 + i][lane..]);
        }
    }
}

/// What changes from place to place, of what follows the surface and doesn't change with height where it lies `above`.
#[inline(always)]
fn followed<R: Real, const D: usize>(of: [[R; D]; D], steep: [R; D], above: R) -> [[R; D]; D] {
    // most stations are under water
    if R::of(0.5).all_gt(above) {
        return of;
    }
    let (mut by_x, below) = (of, R::of(1.0) - above);
    for row in &mut by_x {
        let (up, follows) = (row[D - 1], above * row[D - 1]);
        for j in 0..D - 1 {
            row[j] = follows.fma(steep[j], row[j]);
        }
        row[D - 1] = below * up;
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
