//! Added mass of a floating body, as a constant matrix.

use super::Six;
use num_dual::Dual64;
use ropewalk_core::held::three;
use ropewalk_core::rotation::{cross, matrix, times, transposed_times};
use ropewalk_core::{Assembly, At, Energy, Jet, Pattern, Term, V3};
use ropewalk_sea::MOTIONS;

/// Inertia of the water around a body by Kirchhoff's equations (Lamb, *Hydrodynamics*, art. 121): with velocity `u` and angular velocity
/// `ω` in the axes of the body, its energy is `½ ν·Aν`, impulse and moment of it are `[p, h] = A ν`, and the body pushes the water by `ṗ + ω
/// × p` and turns it by `ḣ + ω × h + u × p`. No energy is lost.
pub struct VesselInertia {
    label: String,
    /// First coordinate and velocity of the body's node, at its centre of mass.
    q: usize,
    v: usize,
    /// About the centre of mass, in the body's axes; symmetric.
    matrix: Six,
}

fn product<S: Jet>(m: &Six, x: &[S; 6]) -> [V3<S>; 2] {
    let row = |i: usize| {
        let mut sum = S::zero();
        for (m, x) in m[i].iter().zip(x) {
            sum += *x * *m;
        }
        sum
    };
    [[row(0), row(1), row(2)], [row(3), row(4), row(5)]]
}

impl VesselInertia {
    /// Of the body whose node has its first coordinate and velocity at `q` and `v`: `added` is for the velocity of the place `point` in
    /// the body and its turning, both along `axes` there (each a unit vector).
    pub fn new(label: &str, [q, v]: [usize; 2], point: V3<f64>, axes: [V3<f64>; 3], added: &Six) -> Self {
        // ν there = T ν of the centre of mass: u + ω × point, along the axes
        let mut t = [[0.0; MOTIONS]; MOTIONS];
        for (i, axis) in axes.iter().enumerate() {
            let lever = cross(&point, axis);
            for j in 0..3 {
                (t[i][j], t[i][3 + j], t[3 + i][3 + j]) = (axis[j], lever[j], axis[j]);
            }
        }
        let matrix = std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                (0..MOTIONS)
                    .flat_map(|k| (0..MOTIONS).map(move |l| (k, l)))
                    .map(|(k, l)| t[k][i] * added[k][l] * t[l][j])
                    .sum()
            })
        });
        VesselInertia { label: label.into(), q, v, matrix }
    }

    /// What it takes to move the water: force in space, and moment in the axes of the body.
    fn residual<S: Jet>(&self, q: [S; 4], v: &[S; 6], a: &[S; 6]) -> [V3<S>; 2] {
        let r = matrix(&q);
        let (u, omega) = (transposed_times(&r, &[v[0], v[1], v[2]]), [v[3], v[4], v[5]]);
        let carried = cross(&omega, &u);
        let push = transposed_times(&r, &[a[0], a[1], a[2]]);
        let rate: V3<S> = std::array::from_fn(|i| push[i] - carried[i]);
        let [p, h] = product(&self.matrix, &[u[0], u[1], u[2], v[3], v[4], v[5]]);
        let [dp, dh] = product(&self.matrix, &[rate[0], rate[1], rate[2], a[3], a[4], a[5]]);
        let (turned, spun, munk) = (cross(&omega, &p), cross(&omega, &h), cross(&u, &p));
        let force = std::array::from_fn(|i| dp[i] + turned[i]);
        [times(&r, &force), std::array::from_fn(|i| dh[i] + spun[i] + munk[i])]
    }

    fn attitude(&self, at: &At<'_>) -> [f64; 4] {
        std::array::from_fn(|k| at.q[self.q + 3 + k])
    }
}

impl Term for VesselInertia {
    fn label(&self) -> String {
        format!("{}: added mass", self.label)
    }
    fn pattern(&self, p: &mut Pattern) {
        p.clique(self.v..self.v + MOTIONS);
    }
    fn symmetric(&self) -> bool {
        false
    }
    fn add(&self, at: &At<'_>, out: &mut Assembly<'_>) {
        let of = |x: &[f64]| -> [f64; MOTIONS] { std::array::from_fn(|k| x[self.v + k]) };
        let (q, v, a) = (self.attitude(at), of(at.v), of(at.a));
        let r = self.residual(q, &v, &a);
        for (k, r) in r.iter().flatten().enumerate() {
            out.add(self.v + k, *r);
        }
        if !out.wants_tangent() {
            return;
        }
        let w = out.weights();
        let mut block = [[0.0; MOTIONS]; MOTIONS];
        for j in 0..MOTIONS {
            let along = |x: &[f64; MOTIONS], weight: f64| -> [Dual64; MOTIONS] {
                std::array::from_fn(|k| Dual64::new(x[k], if k == j { weight } else { 0.0 }))
            };
            // a small turn about an axis of the body: q times [1, turn/2]
            let turn: V3<f64> = std::array::from_fn(|k| if k + 3 == j { 0.5 * w.q } else { 0.0 });
            let [qw, x] = [[q[0], 0.0, 0.0], [q[1], q[2], q[3]]];
            let (qw, side) = (qw[0], cross(&x, &turn));
            let inner: f64 = (0..3).map(|k| x[k] * turn[k]).sum();
            let dq = [-inner, qw * turn[0] + side[0], qw * turn[1] + side[1], qw * turn[2] + side[2]];
            let turned = std::array::from_fn(|k| Dual64::new(q[k], dq[k]));
            let column = self.residual(turned, &along(&v, w.v), &along(&a, w.a));
            for (i, r) in column.iter().flatten().enumerate() {
                block[i][j] = r.eps;
            }
        }
        out.add_square(0, &block);
    }
    fn energy(&self, at: &At<'_>) -> Energy {
        let u = transposed_times(&matrix(&self.attitude(at)), &three(at.v, self.v));
        let omega = three(at.v, self.v + 3);
        let [p, h] = product(&self.matrix, &[u[0], u[1], u[2], omega[0], omega[1], omega[2]]);
        let kinetic = 0.5 * (0..3).map(|k| u[k] * p[k] + omega[k] * h[k]).sum::<f64>();
        Energy { kinetic, ..Energy::default() }
    }
}
