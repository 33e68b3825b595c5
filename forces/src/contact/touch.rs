//! One point and one shape: the force between them, and its derivative by all that moves either.

use super::law::ContactLaw;
use super::shape::Gap;
use ropewalk_core::rotation::{M3, cross, product, times, transposed_times};
use ropewalk_core::{V3, Weights, dot};

/// A force on a point at `s` in the axes of the shape's body, whose contact point slips at `u`.
pub(crate) struct Touch {
    pub gap: Gap,
    /// The force [N], in the body's axes.
    pub f: V3<f64>,
    /// How much it is along the normal, and its elastic part [N].
    pub normal: f64,
    pub elastic: f64,
    /// Depth [m] and its rate [m/s].
    pub depth: f64,
    pub rate: f64,
    /// Slip velocity.
    pub slip: V3<f64>,
    /// Friction over normal force.
    pub pull: V3<f64>,
    /// Whether friction is that of a point that is held, however fast it slips.
    pub held: bool,
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

/// `∂f/∂s` and `∂f/∂u`
pub(crate) type Slopes = [M3; 2];

impl Touch {
    /// The force where the ball of this radius and stiffness has the velocity `u` at its contact point.
    #[inline]
    pub fn new(law: &ContactLaw, gap: Gap, radius: f64, k: f64, u: &V3<f64>) -> Self {
        let n = &gap.normal;
        let approach = dot(u, n);
        let depth = radius - gap.distance;
        let normal = law.normal(k, depth, -approach);
        let slip = minus(u, &scaled(approach, n));
        let pull = if law.friction > 0.0 { law.friction(&slip, false).pull } else { [0.0; 3] };
        let f = std::array::from_fn(|i| normal.force * (n[i] - pull[i]));
        let (force, elastic) = (normal.force, normal.elastic);
        Touch { gap, f, normal: force, elastic, depth, rate: -approach, slip, pull, held: false }
    }

    /// Takes friction for that of a point that is held.
    pub fn hold(&mut self, law: &ContactLaw) {
        self.held = true;
        self.pull = law.friction(&self.slip, true).pull;
        self.f = std::array::from_fn(|i| self.normal * (self.gap.normal[i] - self.pull[i]));
    }

    /// The derivative of the force: with `F(d, ḋ)` along the normal `n`, friction `-F p(t)`, `∂n/∂s = H`:
    /// `∂f/∂s = (n - p) ⊗ ∂F/∂s + F (H - ∂p/∂t ∂t/∂s)`, `∂f/∂u = (n - p) ⊗ ∂F/∂u - F ∂p/∂t (I - n ⊗ n)`.
    #[inline]
    pub fn slopes(&self, law: &ContactLaw, k: f64) -> Slopes {
        let n = &self.gap.normal;
        let normal = law.normal(k, self.depth, self.rate);
        // Hᵀ u = H u = H t
        let bent = self.gap.turn(&self.slip);
        let aim = minus(n, &self.pull);
        let by_s: V3<f64> = std::array::from_fn(|i| -normal.by_depth * n[i] - normal.by_rate * bent[i]);
        let by_u = scaled(-normal.by_rate, n);
        let (mut x, mut v) = ([[0.0; 3]; 3], [[0.0; 3]; 3]);
        for i in 0..3 {
            for j in 0..3 {
                x[i][j] = aim[i] * by_s[j];
                v[i][j] = aim[i] * by_u[j];
            }
        }
        let force = normal.force;
        for (kappa, t) in self.gap.bends.iter().filter(|b| b.0 != 0.0) {
            for i in 0..3 {
                for j in 0..3 {
                    x[i][j] += force * kappa * t[i] * t[j];
                }
            }
        }
        if law.friction > 0.0 {
            let p = law.friction(&self.slip, self.held);
            // ∂t/∂s = -(n ⊗ H u + (u·n) H), ∂t/∂u = I - n ⊗ n
            for i in 0..3 {
                for j in 0..3 {
                    x[i][j] += force * p.across * n[i] * bent[j];
                    v[i][j] -= force * (p.by_slip[i][j] - p.across * n[i] * n[j]);
                }
            }
            for (kappa, t) in self.gap.bends.iter().filter(|b| b.0 != 0.0) {
                let turned = times(&p.by_slip, t);
                for i in 0..3 {
                    for j in 0..3 {
                        x[i][j] -= force * self.rate * kappa * turned[i] * t[j];
                    }
                }
            }
        }
        [x, v]
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

/// Unknowns of a pair: translation and rotation of what carries the point, then of what carries the shape. Rotations
/// are in the bodies' own axes.
pub(crate) const PAIR: usize = 12;

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

    /// The generalised force on all unknowns of the pair.
    pub fn forces(&self, touch: &Touch) -> [f64; PAIR] {
        let (lever, contact) = self.levers(&touch.gap.normal);
        let f = times(&self.r, &touch.f);
        let twist =
            self.carrier.as_ref().map_or([0.0; 3], |c| transposed_times(&c.turn, &cross(&lever, &touch.f)));
        let back = cross(&touch.f, &contact);
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
        let [by_s, by_u] = slopes;
        let mut all = [[0.0; PAIR]; PAIR];
        // `ds`, `dv`: the change of place, and of velocity per rate; `psi`, `theta`: the relative and the body's rotation
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
                let (x, turning, rate) = (times(by_s, &ds), times(by_u, &du), times(by_u, &dv));
                std::array::from_fn(|i| w.q * (x[i] + turning[i]) + w.v * rate[i])
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
