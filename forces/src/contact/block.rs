//! The share of what the same unknowns move in the tangent.

use ropewalk_core::Assembly;
use ropewalk_core::V3;
use ropewalk_core::held::Held;
use ropewalk_core::rotation::M3;

/// Unknowns of a pair: translation and rotation of what carries the point, then of what carries the shape. Rotations
/// are in the bodies' own axes.
pub(crate) const PAIR: usize = 12;

/// The derivatives of a force in the axes of the shape's body.
pub(crate) struct Slopes {
    /// By the place of the centre of the ball.
    pub by_s: M3,
    /// By how far the ball has moved where it touches.
    pub by_x: M3,
    /// By its velocity there.
    pub by_u: M3,
}

/// Unknowns of a group: of a cable element and a body.
pub(crate) const MOST: usize = 18;

/// The block of a group: what has been added of it so far.
pub(crate) struct Block {
    /// Residual and tangent, by the unknowns of the group.
    pub r: [f64; MOST],
    pub k: [[f64; MOST]; MOST],
    any: [bool; 2],
}

impl Block {
    pub fn new() -> Self {
        Block { r: [0.0; MOST], k: [[0.0; MOST]; MOST], any: [false; 2] }
    }
    /// Puts it into the equations as that of clique `clique` with these unknowns, and is empty again.
    pub fn flush(&mut self, clique: usize, dofs: impl Iterator<Item = usize>, out: &mut Assembly<'_>) {
        let [force, tangent] = self.any;
        let mut n = 0;
        if force {
            for (dof, r) in dofs.zip(&self.r) {
                out.add(dof, *r);
                n += 1;
            }
            self.r = [0.0; MOST];
        }
        if tangent {
            out.add_square(clique, &self.k);
            self.k[..n].iter_mut().for_each(|row| row[..n].fill(0.0));
        }
        self.any = [false; 2];
    }
    /// Adds to the residual of one of its unknowns.
    pub fn add(&mut self, i: usize, r: f64) {
        self.any[0] = true;
        self.r[i] += r;
    }
    /// Adds the derivative of the force on a ball on the ground, in space.
    pub fn add_point(&mut self, held: &Held, d: &M3) {
        self.any[1] = true;
        let weights = weights(held);
        for (a, wa) in weights.iter().enumerate().filter(|w| *w.1 != 0.0) {
            for (b, wb) in weights.iter().enumerate().filter(|w| *w.1 != 0.0) {
                let w = wa * wb;
                for (row, d) in self.k[3 * a..3 * a + 3].iter_mut().zip(d) {
                    let row = &mut row[3 * b..3 * b + 3];
                    for j in 0..3 {
                        row[j] -= w * d[j];
                    }
                }
            }
        }
    }
    /// Adds a stiffness along the direction `n`, by pairs of the vectors that move a piece.
    pub fn add_along(&mut self, n: &V3<f64>, stiff: &[[f64; 4]; 4]) {
        self.any[1] = true;
        for (row, k) in self.k.iter_mut().enumerate().take(12) {
            let (a, i) = (row / 3, row % 3);
            for (b, s) in stiff[a].iter().enumerate() {
                (0..3).for_each(|j| k[3 * b + j] += s * n[i] * n[j]);
            }
        }
    }
    /// Adds the derivative of a force that acts on the unknowns like `force` and changes with them as `by` says.
    pub fn add_outer(&mut self, force: &[f64; MOST], by: &[f64; MOST]) {
        self.any[1] = true;
        for (row, f) in self.k.iter_mut().zip(force).filter(|(_, f)| **f != 0.0) {
            for (k, by) in row.iter_mut().zip(by) {
                *k -= f * by;
            }
        }
    }
    /// Adds the derivative of the forces of a pair, of whose unknowns the last six are left out on the ground.
    pub fn add_pair(&mut self, held: &Held, d: &[[f64; PAIR]; PAIR]) {
        self.any[1] = true;
        let n = held.size();
        if let Held::Beside { .. } = held {
            for i in 0..PAIR {
                for j in 0..PAIR {
                    self.k[i][j] -= d[i][j];
                }
            }
            return;
        }
        let weights = weights(held);
        self.add_point(held, &std::array::from_fn(|i| std::array::from_fn(|j| d[i][j])));
        for i in 0..6 {
            for j in 0..6 {
                self.k[n + i][n + j] -= d[6 + i][6 + j];
            }
            for (a, w) in weights.iter().enumerate() {
                for j in 0..3 {
                    self.k[n + i][3 * a + j] -= w * d[6 + i][j];
                    self.k[3 * a + j][n + i] -= w * d[j][6 + i];
                }
            }
        }
    }
}

/// By how much each of the vectors that move a point does so.
pub(crate) fn weights(held: &Held) -> &[f64] {
    match held {
        Held::Between { weight, .. } => weight,
        _ => &[1.0],
    }
}
