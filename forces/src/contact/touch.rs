//! One point and one shape: the force between them, and its derivative by all that moves either.

use super::block::{PAIR, Slopes};
use super::law::{ContactLaw, Normal};
use super::shape::Gap;
use ropewalk_core::rotation::{M3, cross, product, times, transposed_times};
use ropewalk_core::{V3, Weights, dot};

/// The force along the normal on a point at `s` in the axes of the shape's body, whose contact point moves at `u`.
pub(crate) struct Touch {
    pub gap: Gap,
    /// The force [N], in the body's axes.
    pub f: V3<f64>,
    /// How much it is, and its elastic part [N].
    pub normal: f64,
    pub elastic: f64,
    /// Depth [m] and its rate [m/s].
    pub depth: f64,
    pub rate: f64,
    /// Slip velocity.
    slip: V3<f64>,
    /// How it grows with depth [N/m] and rate [N s/m].
    pub by_depth: f64,
    pub by_rate: f64,
}

fn add(a: &V3<f64>, b: &V3<f64>) -> V3<f64> {
    std::array::from_fn(|i| a[i] + b[i])
}

fn minus(a: &V3<f64>, b: &V3<f64>) -> V3<f64> {
    std::array::from_fn(|i| a[i] - b[i])
}

fn scaled(k: f64, a: &V3<f64>) -> V3<f64> {
    a.map(|a| k * a)
}

impl Touch {
    /// The force where the ball of this radius and stiffness has the velocity `u` at its contact point.
    #[inline]
    pub fn new(law: &ContactLaw, gap: Gap, radius: f64, k: f64, u: &V3<f64>) -> Self {
        let n = gap.normal;
        let approach = dot(u, &n);
        let depth = radius - gap.distance;
        let Normal { force, by_depth, by_rate, elastic } = law.normal(k, depth, -approach);
        let slip = minus(u, &scaled(approach, &n));
        Touch {
            gap,
            f: scaled(force, &n),
            normal: force,
            elastic,
            depth,
            rate: -approach,
            slip,
            by_depth,
            by_rate,
        }
    }

    /// What lies on a plane of normal `n`, and is pressed so.
    pub fn lying(n: V3<f64>, by: &Normal, depth: f64, rate: f64) -> Self {
        let &Normal { force, by_depth, by_rate, elastic } = by;
        let gap = Gap::flat(-depth, n);
        let f = scaled(force, &n);
        Touch { gap, f, normal: force, elastic, depth, rate, slip: [0.0; 3], by_depth, by_rate }
    }

    /// A force `f` at a point, whatever its depth, where the normal is `n`.
    pub fn at_point(n: V3<f64>, f: V3<f64>) -> Self {
        let gap = Gap::flat(0.0, n);
        let [normal, elastic, depth, rate, by_depth, by_rate] = [0.0; 6];
        Touch { gap, f, normal, elastic, depth, rate, slip: [0.0; 3], by_depth, by_rate }
    }

    /// The derivative of the force: with `F(d, ḋ)` along the normal `n`, `∂n/∂s = H`:
    /// `∂f/∂s = n ⊗ ∂F/∂s + F H`, `∂f/∂u = n ⊗ ∂F/∂u`.
    #[inline]
    pub fn slopes(&self) -> Slopes {
        self.slopes_along(&self.gap.normal)
    }

    /// The same of a force `F` that acts in another direction than the normal, which doesn't turn with it.
    #[inline]
    pub fn slopes_along(&self, way: &V3<f64>) -> Slopes {
        let n = &self.gap.normal;
        // Hᵀ u = H u = H t
        let bent = self.gap.turn(&self.slip);
        let by_s: V3<f64> = std::array::from_fn(|i| -self.by_depth * n[i] - self.by_rate * bent[i]);
        let by_u = scaled(-self.by_rate, n);
        let (mut x, mut v) = ([[0.0; 3]; 3], [[0.0; 3]; 3]);
        for i in 0..3 {
            for j in 0..3 {
                x[i][j] = way[i] * by_s[j];
                v[i][j] = way[i] * by_u[j];
            }
        }
        for (kappa, t) in self.gap.bends.iter().filter(|b| b.0 != 0.0) {
            for i in 0..3 {
                for j in 0..3 {
                    x[i][j] += self.normal * kappa * t[i] * t[j];
                }
            }
        }
        Slopes { by_s: x, by_x: [[0.0; 3]; 3], by_u: v }
    }
}

/// What carries the point, and what carries the shape, in the axes of the shape's body.
pub(crate) struct Pair {
    /// Rotation matrix of the shape's body, its angular velocity in its own axes.
    pub r: M3,
    pub omega: V3<f64>,
    /// The centre of the ball from the body's node.
    pub s: V3<f64>,
    /// Velocity of the point's node relative to the body's.
    pub g: V3<f64>,
    /// Of a point on a body: the matrix from its axes to those of the shape's body, the arm and the angular velocity
    /// turned by it, and how far from its centre the ball is touched.
    pub carrier: Option<Carrier>,
}

/// The body that carries a point, in the axes of the shape's body.
pub(crate) struct Carrier {
    pub turn: M3,
    pub arm: V3<f64>,
    pub omega: V3<f64>,
    pub radius: f64,
}

impl Pair {
    /// Velocity of the ball relative to the shape's body where they touch.
    pub fn velocity(&self, n: &V3<f64>) -> V3<f64> {
        let (lever, contact) = self.levers(n);
        let mut u = minus(&self.g, &cross(&self.omega, &contact));
        if let Some(c) = &self.carrier {
            u = add(&u, &cross(&c.omega, &lever));
        }
        u
    }

    /// Where they touch: from the node that carries the point, and from that of the shape.
    fn levers(&self, n: &V3<f64>) -> (V3<f64>, V3<f64>) {
        match &self.carrier {
            Some(c) => {
                let down = scaled(-c.radius, n);
                (add(&c.arm, &down), add(&self.s, &down))
            }
            None => ([0.0; 3], self.s),
        }
    }

    /// The generalised force of `f` where they touch, with the normal `n`, on all unknowns of the pair.
    pub fn forces(&self, n: &V3<f64>, f: &V3<f64>) -> [f64; PAIR] {
        let (lever, contact) = self.levers(n);
        let twist = self.carrier.as_ref().map_or([0.0; 3], |c| transposed_times(&c.turn, &cross(&lever, f)));
        let back = cross(f, &contact);
        let f = times(&self.r, f);
        std::array::from_fn(|i| match i / 3 {
            0 => f[i],
            1 => twist[i - 3],
            2 => -f[i - 6],
            _ => back[i - 9],
        })
    }

    /// The weighted derivative of [`Pair::forces`], rows first.
    ///
    /// With the rotation `ψ` of the carrier relative to the shape's body, the arm `α` and the angular velocity `Ω` of
    /// the carrier, and the contact point `c = s - ρ n` with `δc = δs - ρ H δs`:
    /// `δu = δg + δΩ × (α - ρ n) + Ω × (δα - ρ H δs) - ω × δc - δω × c`.
    pub fn derivative(&self, touch: &Touch, slopes: &Slopes, w: Weights) -> [[f64; PAIR]; PAIR] {
        let (lever, contact) = self.levers(&touch.gap.normal);
        let Slopes { by_s, by_x, by_u } = slopes;
        let mut all = [[0.0; PAIR]; PAIR];
        // `ds`, `dv`: how the centre moves, and what touches there; `psi`, `theta`: the relative and the body's rotation
        let mut column = |j: usize, ds: V3<f64>, dv: V3<f64>, psi: V3<f64>, theta: V3<f64>| {
            let (mut bent, mut du) = ([0.0; 3], [0.0; 3]);
            let mut arm = [0.0; 3];
            if let Some(c) = &self.carrier {
                bent = scaled(-c.radius, &touch.gap.turn(&ds));
                arm = add(&cross(&psi, &c.arm), &bent);
                du = add(&cross(&cross(&psi, &c.omega), &lever), &cross(&c.omega, &arm));
            }
            let moved = add(&ds, &bent);
            du = minus(&du, &add(&cross(&theta, &self.g), &cross(&self.omega, &moved)));
            let f: V3<f64> = {
                let (x, turning) = (times(by_s, &ds), times(by_u, &du));
                let (moved, rate) = (times(by_x, &dv), times(by_u, &dv));
                std::array::from_fn(|i| w.q * (x[i] + moved[i] + turning[i]) + w.v * rate[i])
            };
            let pull = times(&self.r, &add(&f, &scaled(w.q, &cross(&theta, &touch.f))));
            let back = minus(&scaled(w.q, &cross(&touch.f, &moved)), &cross(&contact, &f));
            let twist = self.carrier.as_ref().map_or([0.0; 3], |c| {
                let swung = minus(&cross(&arm, &touch.f), &cross(&psi, &cross(&lever, &touch.f)));
                transposed_times(&c.turn, &add(&cross(&lever, &f), &scaled(w.q, &swung)))
            });
            for i in 0..3 {
                all[i][j] = pull[i];
                all[3 + i][j] = twist[i];
                all[6 + i][j] = -pull[i];
                all[9 + i][j] = back[i];
            }
        };
        for k in 0..3 {
            let mut e = [0.0; 3];
            e[k] = 1.0;
            let along = self.r[k];
            column(k, along, along, [0.0; 3], [0.0; 3]);
            if let Some(c) = &self.carrier {
                let p: V3<f64> = std::array::from_fn(|i| c.turn[i][k]);
                column(3 + k, cross(&p, &c.arm), cross(&p, &lever), p, [0.0; 3]);
            }
            column(9 + k, cross(&self.s, &e), cross(&contact, &e), scaled(-1.0, &e), e);
        }
        for row in &mut all {
            for k in 0..3 {
                row[6 + k] = -row[k];
            }
        }
        all
    }

    /// The carrier of a point on a body with rotation matrix `of`, at `arm` and with angular velocity `omega` in its
    /// own axes.
    pub fn carried(r: &M3, of: &M3, arm: &V3<f64>, omega: &V3<f64>, radius: f64) -> Carrier {
        let back = std::array::from_fn(|i| std::array::from_fn(|j| r[j][i]));
        let turn = product(&back, of);
        Carrier { arm: times(&turn, arm), omega: times(&turn, omega), turn, radius }
    }
}
