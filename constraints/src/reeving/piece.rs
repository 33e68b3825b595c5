//! The straight piece of cable that is left between two spans where a cable only touches a wheel, or is off.
//!
//! It stretches, has mass, weight and damping as the arc has whose place it takes ([`Arc`](super::Arc)). With its slope
//! `s = (r_s - r_e)/A` the material at an end moves by `dr - s dP`, so a force `F` on it acts as `F` on the point and as
//! `-s·F` on the material coordinate.

use super::arc::{End, Instant, Residual};
use super::hold::{Mode, chord};
use super::inline::{each, three, two};
use num_dual::HyperDual64;
use ropewalk_core::rotation::along;
use ropewalk_core::{Assembly, At, Energy, Jet, MovingBoundary, Pattern, Term, V3};
use ropewalk_scene::Strand;

/// The numbers of a straight piece.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piece {
    /// The cable.
    pub strand: Strand,
    /// Acceleration of gravity, of a cable that has weight [m/s²].
    pub gravity: V3<f64>,
}

impl Piece {
    /// Evaluates all of it; `stored` is the unstretched length for material coordinates of 0.
    #[inline(always)]
    pub fn eval<S: Jet>(&self, stored: f64, ends: &[End<S>; 2]) -> (Residual<S>, Instant<S>) {
        let Strand { mass, ea, damping, .. } = self.strand;
        let length = ends[1].p[0] - ends[0].p[0] + stored;
        let lengthens = ends[1].p[1] - ends[0].p[1];
        let c: V3<S> = three!(|i| ends[1].r[0][i] - ends[0].r[0][i]);
        let size = along(&c, &c).sqrt();
        let (slope, t) = (each!(c, |x| x / length), each!(c, |x| x / size));
        let turns: V3<S> = three!(|i| (ends[1].r[1][i] - ends[0].r[1][i] - slope[i] * lengthens) / length);
        let stretch = size / length;
        let strained = (stretch - 1.0) * ea;
        let by_length = -(stretch * stretch - 1.0) * (0.5 * ea);
        // of the material at both ends
        let v: [V3<S>; 2] = two!(|k| three!(|i| ends[k].r[1][i] - slope[i] * ends[k].p[1]));
        let w: [V3<S>; 2] = two!(|k| {
            let [_, pd, pdd] = ends[k].p;
            three!(|i| ends[k].r[2][i] - slope[i] * pdd - turns[i] * pd * 2.0)
        });
        let m = length * mass;
        let rate = along(&t, &turns);
        let viscous = rate * damping;
        let mut r = [[S::zero(); 3]; 2];
        let mut p = [-by_length, by_length];
        let mut beside = [strained; 2];
        for k in 0..2 {
            let (own, other, sign) = (&w[k], &w[1 - k], if k == 0 { -1.0 } else { 1.0 });
            let push: V3<S> = three!(|i| {
                let inertia = own[i] / 3.0 + other[i] / 6.0 - 0.5 * self.gravity[i];
                m * inertia + t[i] * viscous * sign
            });
            r[k] = three!(|i| t[i] * strained * sign + push[i]);
            p[k] -= along(&slope, &push);
            beside[k] += along(&t, &push) * sign;
        }
        let kinetic = m * (along(&v[0], &v[0]) + along(&v[0], &v[1]) + along(&v[1], &v[1])) / 6.0;
        let height = (0..3)
            .fold(S::zero(), |sum, i| sum + (ends[0].r[0][i] + ends[1].r[0][i]) * (0.5 * self.gravity[i]));
        let excess = size - length;
        let zero = S::zero();
        let instant = Instant {
            wrap: zero,
            length,
            tension: strained,
            beside,
            speed: [along(&v[0], &t), along(&v[1], &t)],
            lift: [zero; 2],
            friction: [zero; 2],
            axle: [zero; 3],
            energy: [kinetic, excess * excess * ea / (length * 2.0) - m * height],
            dissipated: viscous * rate * length,
        };
        (Residual { r, p, centre: [zero; 3], groove: zero }, instant)
    }
}

/// What resists the kink over a cable that touches a wheel at a point: the bending of the piece, `EI φ²/(2 l)`.
pub(super) struct Stiff {
    pub name: String,
    /// Place of the internal variable with the [`Mode`].
    pub mode: usize,
    pub ends: [MovingBoundary; 2],
    /// Bending stiffness [N m²].
    pub ei: f64,
    /// Of the wheel [m].
    pub radius: f64,
}

impl Stiff {
    /// Energy with increments of both slopes; `φ²/2` is `1 - cos φ` up to what is small beside it.
    fn energy<S: Jet>(&self, at: &At<'_>, d: impl Fn(usize) -> S) -> S {
        if Mode::of(at.internal, self.mode) != Mode::Touches {
            return S::zero();
        }
        let slope =
            |k: usize| -> V3<S> { std::array::from_fn(|i| d(3 * k + i) + at.q[self.ends[k].end_q + 3 + i]) };
        let [a, b] = [slope(0), slope(1)];
        let cosine = along(&a, &b) / (along(&a, &a) * along(&b, &b)).sqrt();
        (-cosine + 1.0) * (self.ei / chord(self.radius))
    }

    fn dofs(&self) -> [usize; 6] {
        std::array::from_fn(|i| self.ends[i / 3].end_v + 3 + i % 3)
    }
}

impl Term for Stiff {
    fn label(&self) -> String {
        format!("{}: bending", self.name)
    }
    fn pattern(&self, p: &mut Pattern) {
        p.clique(self.dofs());
    }
    fn add(&self, at: &At<'_>, out: &mut Assembly<'_>) {
        if Mode::of(at.internal, self.mode) != Mode::Touches {
            return;
        }
        let (dofs, w) = (self.dofs(), out.weights());
        let mut block = [[0.0; 6]; 6];
        for i in 0..6 {
            for j in 0..=i {
                let one = |on: bool| if on { 1.0 } else { 0.0 };
                let u = self.energy(at, |k| HyperDual64::new(0.0, one(k == i), one(k == j), 0.0));
                if i == j {
                    out.add(dofs[i], u.eps1);
                }
                (block[i][j], block[j][i]) = (w.q * u.eps1eps2, w.q * u.eps1eps2);
            }
        }
        if out.wants_tangent() {
            out.add_square(0, &block);
        }
    }
    fn energy(&self, at: &At<'_>) -> Energy {
        Energy { potential: Stiff::energy(self, at, |_| 0.0), ..Energy::default() }
    }
}
