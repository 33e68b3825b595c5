//! Axes in which the motion of the water is written down: fewer numbers do for waves of one direction.

use ropewalk_core::Real;

/// The axes of a motion: the three of space, or the two of the plane of waves that have one direction, along them and upwards.
#[derive(Clone, Copy, Debug)]
pub struct Axes<R, const D: usize> {
    /// The direction of the waves in the plane; of no use in space.
    way: [R; 2],
}

impl<R: Real> Axes<R, 2> {
    /// Those of waves that go this way.
    #[inline(always)]
    pub fn plane(way: [f64; 2]) -> Self {
        Axes { way: [R::of(way[0]), R::of(way[1])] }
    }
}

impl<R: Real> Axes<R, 3> {
    /// Those of space.
    #[inline(always)]
    pub fn space() -> Self {
        Axes { way: [R::zero(); 2] }
    }
}

impl<R: Real, const D: usize> Axes<R, D> {
    /// What a vector of space is along them.
    #[inline(always)]
    pub fn along(&self, x: &[R; 3]) -> [R; D] {
        let mut out = [x[2]; D];
        if D == 2 {
            out[0] = x[0].fma(self.way[0], x[1] * self.way[1]);
        } else {
            (out[0], out[1]) = (x[0], x[1]);
        }
        out
    }

    /// The vector of space that is this along them.
    #[inline(always)]
    pub fn vector(&self, x: &[R; D]) -> [R; 3] {
        let (up, [cx, cy]) = (x[D - 1], self.way);
        if D == 2 { [x[0] * cx, x[0] * cy, up] } else { [x[0], x[1], up] }
    }

    /// The rows that a matrix has in space, each along the axes.
    #[inline(always)]
    pub fn rows(&self, m: &[[R; D]; D]) -> [[R; D]; 3] {
        let mut out = [m[D - 1]; 3];
        for j in 0..D {
            let mut column = [R::zero(); D];
            for i in 0..D {
                column[i] = m[i][j];
            }
            let column = self.vector(&column);
            (out[0][j], out[1][j]) = (column[0], column[1]);
        }
        out
    }

    /// A matrix of space.
    #[inline(always)]
    pub fn matrix(&self, m: &[[R; D]; D]) -> [[R; 3]; 3] {
        let rows = self.rows(m);
        [self.vector(&rows[0]), self.vector(&rows[1]), self.vector(&rows[2])]
    }
}

/// `to + a b`
#[inline(always)]
pub fn plus_product<R: Real, const D: usize, const N: usize>(
    mut to: [[R; D]; N],
    a: &[[R; D]; N],
    b: &[[R; D]; D],
) -> [[R; D]; N] {
    for i in 0..N {
        for j in 0..D {
            for k in 0..D {
                to[i][j] = a[i][k].fma(b[k][j], to[i][j]);
            }
        }
    }
    to
}

/// `mᵀ x`
#[inline(always)]
pub fn transposed_times<R: Real, const D: usize>(m: &[[R; D]; D], x: &[R; D]) -> [R; D] {
    plus_product([[R::zero(); D]], &[*x], m)[0]
}
