//! A drum as a term of a model: its inertia with the cable on it, its motor and its brake.

use super::layers::Layers;
use super::locked::Locked;
use num_dual::Dual64;
use ropewalk_core::rotation::{cross, matrix, times};
use ropewalk_core::{
    Assembly, At, Column, Energy, Jet, Motion, MovingBoundary, Pattern, Power, Shows, Signal, Solid, Term,
    Timed, V3, dot,
};
use std::sync::Arc;

/// What turns a drum. Angles count in the sense that pays out.
#[derive(Clone)]
pub(super) enum Drive {
    /// Its angle is given.
    Given(Arc<dyn Motion>),
    /// Its angle is an unknown.
    Free(Free),
}

/// A drum that its cable, a motor and a brake turn.
#[derive(Clone)]
pub(super) struct Free {
    /// Place of the angle and of its rate.
    pub place: (usize, usize),
    /// Moment of inertia without cable [kg m²].
    pub inertia: f64,
    /// Moment of the motor [N m].
    pub torque: Signal,
    /// Moment of the brake [N m].
    pub brake: Signal,
    /// Rate below which the brake creeps [rad/s].
    pub creep: f64,
    /// Moment by rate [N m s/rad].
    pub damping: f64,
}

/// A drum with the cable on it.
#[derive(Clone)]
pub(super) struct Shaft {
    pub name: String,
    pub boundary: MovingBoundary,
    pub layers: Layers,
    /// Angle wound at the start [rad].
    pub wound: f64,
    /// Stretch of what is wound.
    pub locked: Locked,
    /// Mass per unstretched length of what is wound, or 0 where it isn't counted [kg/m].
    pub mass: f64,
    /// First coordinate and velocity of the rigid body that carries it, if one does.
    pub on: Option<(usize, usize)>,
    /// Its axis, in the axes of that.
    pub axis: V3<f64>,
    pub drive: Drive,
    pub solid: Solid,
}

/// Unknowns: the material coordinate, the angle of the drum, the turn of what carries it.
const MOST: usize = 5;

impl Shaft {
    /// Angle that is wound now, by what is fed out [rad].
    pub fn angle(&self, at: &At<'_>) -> f64 {
        let (all, fed) = (self.layers.at(self.wound).length, self.boundary.fed(at));
        self.layers.angle(all - self.locked.at(at.internal, fed).sum(fed))
    }

    /// Angle of the drum and its rate.
    fn turned(&self, at: &At<'_>) -> [f64; 2] {
        match &self.drive {
            Drive::Given(motion) => {
                let now = motion.at(at.t);
                [now.x[0], now.v[0]]
            }
            Drive::Free(free) => [at.q[free.place.0], at.v[free.place.1]],
        }
    }

    /// Angle of the cable against the plane of the drum where it leaves it [rad].
    pub fn fleet(&self, at: &At<'_>) -> f64 {
        let slope: V3<f64> = std::array::from_fn(|i| at.q[self.boundary.end_q + 3 + i]);
        let axis = match self.on {
            Some((q, _)) => times(&matrix(&[at.q[q + 3], at.q[q + 4], at.q[q + 5], at.q[q + 6]]), &self.axis),
            None => self.axis,
        };
        // the free cable goes on against the slope where it ends on the drum
        -self.boundary.sign * (dot(&axis, &slope) / dot(&slope, &slope).sqrt()).clamp(-1.0, 1.0).asin()
    }

    fn dofs(&self, free: &Free) -> Vec<usize> {
        let body = self.on.into_iter().flat_map(|(_, v)| v + 3..v + 6);
        [self.boundary.v, free.place.1].into_iter().chain(body).collect()
    }

    /// Moment of inertia of the wound cable [kg m²], and what a length more that is fed out takes from it [kg m].
    fn rope(&self, at: &At<'_>) -> [f64; 2] {
        if self.mass == 0.0 {
            return [0.0; 2];
        }
        let angle = self.angle(at);
        let radius = self.layers.at(angle).radius;
        let density = self.mass / self.locked.base(at.internal);
        let fed = self.boundary.fed(at);
        let passes = self.locked.at(at.internal, fed).per_length(fed);
        [density * self.layers.inertia(angle), density * passes * radius * radius]
    }

    /// Residual of its unknowns after the increment `p` of the material coordinate.
    fn eval<S: Jet>(
        &self,
        free: &Free,
        at: &At<'_>,
        rope: [f64; 2],
        p: S,
        v: &[S; MOST],
        a: &[S; MOST],
    ) -> [S; MOST] {
        let inertia = -p * (self.boundary.sign * rope[1]) + (free.inertia + rope[0]);
        let own = self.axis.map(S::from);
        let along = |x: &[S; MOST]| x[2] * own[0] + x[3] * own[1] + x[4] * own[2];
        let moment = inertia * (a[1] + along(a));
        let momentum = inertia * (v[1] + along(v));
        let rub = v[1] / (v[1] * v[1] + free.creep * free.creep).sqrt();
        let resists = rub * free.brake.at(at.t) + v[1] * free.damping;
        let swing = cross(&[v[2], v[3], v[4]], &own.map(|x| x * momentum));
        let body = |i: usize| own[i] * moment + swing[i];
        [S::zero(), moment + resists - free.torque.at(at.t), body(0), body(1), body(2)]
    }

    /// Rate at which drum and carrier turn in space, about the axis [rad/s].
    fn spin(&self, at: &At<'_>) -> f64 {
        let carried = self.on.map_or(0.0, |(_, v)| (0..3).map(|i| at.v[v + 3 + i] * self.axis[i]).sum());
        self.turned(at)[1] + carried
    }
}

impl Term for Shaft {
    fn label(&self) -> String {
        self.name.clone()
    }
    fn pattern(&self, p: &mut Pattern) {
        if let Drive::Free(free) = &self.drive {
            p.clique(self.dofs(free));
        }
    }
    fn symmetric(&self) -> bool {
        matches!(self.drive, Drive::Given(_))
    }
    fn add(&self, at: &At<'_>, out: &mut Assembly<'_>) {
        let Drive::Free(free) = &self.drive else { return };
        let (dofs, rope, w) = (self.dofs(free), self.rope(at), out.weights());
        let pick = |x: &[f64]| -> [f64; MOST] { std::array::from_fn(|i| dofs.get(i).map_or(0.0, |d| x[*d])) };
        let (v, a) = (pick(at.v), pick(at.a));
        let residual = self.eval(free, at, rope, 0.0, &v, &a);
        for (dof, r) in dofs.iter().zip(residual) {
            out.add(*dof, r);
        }
        if !out.wants_tangent() {
            return;
        }
        let mut block = [[0.0; MOST]; MOST];
        for j in 0..dofs.len() {
            let towards = |x: &[f64; MOST], w: f64| -> [Dual64; MOST] {
                std::array::from_fn(|i| Dual64::new(x[i], if i == j { w } else { 0.0 }))
            };
            let p = Dual64::new(0.0, if j == 0 { w.q } else { 0.0 });
            let column = self.eval(free, at, rope, p, &towards(&v, w.v), &towards(&a, w.a));
            for i in 0..dofs.len() {
                block[i][j] = column[i].eps;
            }
        }
        // the axes of a body turn with it: its rotations are increments in its own axes, in which nothing here depends on them
        out.add_square(0, &block);
    }
    fn energy(&self, at: &At<'_>) -> Energy {
        let Drive::Free(free) = &self.drive else { return Energy::default() };
        let spin = self.spin(at);
        Energy { kinetic: 0.5 * (free.inertia + self.rope(at)[0]) * spin * spin, ..Energy::default() }
    }
    fn power(&self, at: &At<'_>) -> Power {
        let Drive::Free(free) = &self.drive else { return Power::default() };
        let (spin, rate) = (self.spin(at), at.v[free.place.1]);
        let rub = rate / (rate * rate + free.creep * free.creep).sqrt();
        Power {
            supplied: free.torque.at(at.t) * rate,
            dissipated: (free.brake.at(at.t) * rub + free.damping * rate) * rate,
            carried: -0.5 * self.rope(at)[1] * spin * spin * self.boundary.rate(at),
        }
    }
    fn timed(&self) -> Option<&dyn Timed> {
        match &self.drive {
            Drive::Free(free) if !(free.torque.is_constant() && free.brake.is_constant()) => Some(self),
            _ => None,
        }
    }
    fn shows(&self) -> Option<&dyn Shows> {
        Some(self)
    }
}

impl Timed for Shaft {
    fn reach(&self, t: f64, h: f64) -> Option<f64> {
        match &self.drive {
            Drive::Free(free) => Some(free.brake.reach(t, free.torque.reach(t, h))),
            Drive::Given(_) => Some(h),
        }
    }
}

/// What a drum shows; the last two, how far the cable travels along the axis and climbs by an angle, are for the moment on it.
pub(super) const COLUMNS: [(&str, &str); 9] = [
    ("angle", "rad"),
    ("spin", "rad/s"),
    ("payout", "m"),
    ("wound", "m"),
    ("layer", "1"),
    ("radius", "m"),
    ("fleet", "rad"),
    ("travel", "m/rad"),
    ("climb", "m/rad"),
];

impl Shows for Shaft {
    fn columns(&self) -> Vec<Column> {
        COLUMNS.into_iter().map(|(name, unit)| Column::new(name, unit)).collect()
    }
    fn observe(&self, at: &At<'_>, out: &mut Vec<f64>) {
        let angle = self.angle(at);
        let lies = self.layers.at(Dual64::new(angle, 1.0));
        let ([turned, rate], fed) = (self.turned(at), self.boundary.fed(at));
        let all = self.layers.at(self.wound).length;
        out.extend([turned, rate, fed, all / self.locked.base(at.internal) - fed]);
        out.extend([
            self.layers.number(angle) + 1.0,
            lies.radius.re,
            self.fleet(at),
            lies.x.eps,
            lies.radius.eps,
        ]);
    }
    fn solids(&self) -> Vec<Solid> {
        vec![self.solid.clone()]
    }
}
