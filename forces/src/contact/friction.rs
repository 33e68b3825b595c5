//! Dry friction that holds: bristles between fixed places on what touches and the shape.
//!
//! Each cell of a cable, and each ball, is tied to the place on the shape at which it touched first by an elastic bristle,
//! which gives way where its force reaches Coulomb's limit. The places are moved by accepted steps alone: what sticks
//! stays where it is for ever, and returns when it is let go. The stiffness doesn't depend on the normal force, so that
//! no cycle wins energy (see the return mapping of plasticity; Simo & Hughes 1998, Computational Inelasticity).

use super::block::{MOST, Slopes};
use ropewalk_core::error::{not_negative, positive};
use ropewalk_core::held::delta;
use ropewalk_core::rotation::M3;
use ropewalk_core::{BuildError, V3, Weights, dot};
use ropewalk_scene::quantity;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Coulomb's friction.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Friction {
    /// Coefficient.
    #[serde(deserialize_with = "quantity::number")]
    pub mu: f64,
    /// Coefficient across what is slender. Default: the same.
    #[serde(default, deserialize_with = "quantity::optional::number")]
    pub across: Option<f64>,
    /// How far it gives way before it slips, about, under what touches by its weight [m]. Default: a hundredth of its
    /// thickness, and less where that would smear out slip along a cable.
    #[serde(default, deserialize_with = "quantity::optional::length")]
    pub elastic_slip: Option<f64>,
    /// What it does at equilibria, which aren't unique with it.
    #[serde(default)]
    pub equilibrium: AtRest,
}

/// What dry friction does at equilibria.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum AtRest {
    /// Nothing: they are those without friction. In time it holds from there on.
    #[default]
    None,
    /// It takes hold where the first equilibrium of a load path lies, and holds what it can as the load changes: a line that was laid
    /// and then pulled. That first one is without friction, but for ground that slopes: it bears upright what is laid on it.
    Laid,
    /// It brakes each cable in full against being pulled by its higher end: a line that was laid under more tension than it has
    /// now. The tension on the ground falls by `μ` times the weight per length, down to nothing.
    Pulled,
}

impl Friction {
    /// The same in all directions.
    pub fn new(mu: f64) -> Self {
        Friction { mu, across: None, elastic_slip: None, equilibrium: AtRest::None }
    }

    pub(crate) fn check(&self) -> Result<(), BuildError> {
        not_negative("friction", self.mu)?;
        if let Some(across) = self.across {
            positive("friction", across).map_err(|_| {
                BuildError::at("friction", format!("`across` of friction must be positive, but is {across}"))
            })?;
        }
        if let Some(slip) = self.elastic_slip {
            positive("friction", slip).map_err(|_| {
                BuildError::at(
                    "friction",
                    format!("`elastic_slip` of friction must be positive, but is {slip}"),
                )
            })?;
        }
        Ok(())
    }
}

/// What holds one group: its bristles together.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Grip {
    /// Their stiffness [N/m].
    pub stiffness: f64,
    /// Their damping while they hold [N s/m].
    pub damping: f64,
    /// How a cable is braked at equilibria, if it is.
    pub brake: Option<Brake>,
}

/// Friction that is used up by the pull on one end of a cable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Brake {
    /// 1 where the end is pulled, -1 where the start is.
    pub way: f64,
    /// Axial strain from which on friction is used up: below, the line hardly pulls any more.
    pub strain: f64,
    /// The direction against gravity.
    pub up: V3<f64>,
}

impl Brake {
    /// The part of friction that a strain uses up, and its slope: rises as a parabola to its top.
    pub(crate) fn share(&self, strain: f64) -> (f64, f64) {
        let u = (strain / self.strain).clamp(-1.0, 1.0);
        (u * (2.0 - u.abs()), 2.0 * (1.0 - u.abs()) / self.strain)
    }
}

/// Cells on each slender piece.
pub(crate) const CELLS: usize = 4;
/// Numbers that are remembered of a bristle: whether it holds, its place on the shape, and how what touches was turned.
pub(crate) const MEMORY: usize = 8;
/// What a force may be beyond the limit and still be held: rounding of the limit itself.
const SLACK: f64 = 1e-7;

/// What presses a cell on the shape.
#[derive(Clone, Copy)]
pub(crate) struct Pressed {
    /// Normal force [N].
    pub normal: f64,
    /// Its direction, once [`Pressed::settle`]d.
    pub n: V3<f64>,
    /// The weighted derivative of the normal force by all unknowns of the group.
    pub by: [f64; MOST],
}

impl Pressed {
    pub const NONE: Pressed = Pressed { normal: 0.0, n: [0.0; 3], by: [0.0; MOST] };

    pub fn add(&mut self, force: f64, n: &V3<f64>) {
        self.normal += force;
        (0..3).for_each(|i| self.n[i] += force * n[i]);
    }
    /// The mean direction; whether anything presses.
    pub fn settle(&mut self) -> bool {
        let size = dot(&self.n, &self.n).sqrt();
        if !(self.normal > 0.0 && size > 0.0) {
            return false;
        }
        self.n = self.n.map(|n| n / size);
        true
    }
}

/// The force of a bristle, in the axes of the shape's body.
pub(crate) struct Hold {
    /// The force on what touches [N].
    pub f: V3<f64>,
    /// What it would be if the bristle held, however hard it is pulled [N].
    trial: V3<f64>,
    /// How far it is stretched elastically [m].
    pub stretch: V3<f64>,
    /// Whether its force is that of slip.
    pub slips: bool,
    /// `∂f/∂x`, `∂f/∂u` and the derivative by the normal force.
    pub by_x: M3,
    pub by_u: M3,
    pub by_normal: V3<f64>,
    /// What it takes up [W], the little that it stores included.
    pub heat: f64,
}

fn along(k: f64, x: &V3<f64>) -> V3<f64> {
    x.map(|x| k * x)
}

impl Friction {
    /// How much of the limit a force uses up: `√((f_a/μ_a)² + (f_c/μ_c)²)`, with its gradient.
    fn measure(&self, f: &V3<f64>, axis: Option<&V3<f64>>) -> (f64, V3<f64>) {
        let (mu, across) = (self.mu, self.across.unwrap_or(self.mu));
        let size = match axis {
            Some(a) if across != mu => {
                let fa = dot(f, a);
                let fc: V3<f64> = std::array::from_fn(|i| f[i] - fa * a[i]);
                let g = ((fa / mu).powi(2) + dot(&fc, &fc) / (across * across)).sqrt();
                let by = |i: usize| (fa * a[i] / (mu * mu) + fc[i] / (across * across)) / g;
                return (g, if g > 0.0 { std::array::from_fn(by) } else { [0.0; 3] });
            }
            _ => dot(f, f).sqrt(),
        };
        (size / mu, if size > 0.0 { along(1.0 / (mu * size), f) } else { [0.0; 3] })
    }

    /// The force of a bristle with the stretch `e` across the normal, whose place slips at `u`. `axis` is the direction of
    /// what is slender.
    pub(crate) fn hold(
        &self,
        grip: &Grip,
        pressed: &Pressed,
        e: &V3<f64>,
        u: &V3<f64>,
        axis: Option<&V3<f64>>,
    ) -> Hold {
        let n = &pressed.n;
        let across = |x: &V3<f64>| -> V3<f64> {
            let normal = dot(x, n);
            std::array::from_fn(|i| x[i] - normal * n[i])
        };
        let (e, u) = (across(e), across(u));
        if axis.is_none() {
            return self.hold_alike(grip, pressed, &e, &u);
        }
        let axis = axis.map(across).and_then(|a| {
            let size = dot(&a, &a).sqrt();
            (size > 1e-6).then(|| along(1.0 / size, &a))
        });
        let Grip { stiffness: k, damping: c, .. } = *grip;
        let trial: V3<f64> = std::array::from_fn(|i| -k * e[i] - c * u[i]);
        let (g, by) = self.measure(&trial, axis.as_ref());
        let (elastic, _) = self.measure(&along(k, &e), axis.as_ref());
        let stretch = if elastic > pressed.normal { along(pressed.normal / elastic, &e) } else { e };
        let slips = g > pressed.normal * (1.0 + SLACK);
        let (share, f, by_normal) = if slips {
            let share = pressed.normal / g;
            (share, along(share, &trial), along(1.0 / g, &trial))
        } else {
            (1.0, trial, [0.0; 3])
        };
        // along the force nothing more comes of a stretch once it slips
        let turn = |i: usize, j: usize| {
            if slips { share * (delta(i, j) - trial[i] * by[j] / g) } else { delta(i, j) }
        };
        let by_e: M3 = std::array::from_fn(|i| across(&std::array::from_fn(|j| turn(i, j))));
        let (by_x, by_u) = (by_e.map(|row| along(-k, &row)), by_e.map(|row| along(-c, &row)));
        let heat = -dot(&f, &u);
        Hold { f, trial, stretch, slips, by_x, by_u, by_normal, heat }
    }
}

impl Friction {
    /// The same where friction is alike in all directions, of a stretch and a velocity across the normal.
    fn hold_alike(&self, grip: &Grip, pressed: &Pressed, e: &V3<f64>, u: &V3<f64>) -> Hold {
        let (n, Grip { stiffness: k, damping: c, .. }) = (&pressed.n, *grip);
        let limit = self.mu * pressed.normal;
        let trial: V3<f64> = std::array::from_fn(|i| -k * e[i] - c * u[i]);
        let (size, elastic) = (dot(&trial, &trial).sqrt(), k * dot(e, e).sqrt());
        let stretch = if elastic > limit { along(limit / elastic, e) } else { *e };
        let slips = size > limit * (1.0 + SLACK);
        let (share, way, by_normal) = if slips {
            let way = along(1.0 / size, &trial);
            (limit / size, way, along(self.mu, &way))
        } else {
            (1.0, [0.0; 3], [0.0; 3])
        };
        let f = along(share, &trial);
        // along the force nothing more comes of a stretch once it slips
        let turn = |k: f64| -> M3 {
            std::array::from_fn(|i| {
                std::array::from_fn(|j| -k * share * (delta(i, j) - n[i] * n[j] - way[i] * way[j]))
            })
        };
        let heat = -dot(&f, u);
        Hold { f, trial, stretch, slips, by_x: turn(k), by_u: turn(c), by_normal, heat }
    }
}

impl Hold {
    pub(crate) fn slopes(&self) -> Slopes {
        Slopes { by_s: [[0.0; 3]; 3], by_x: self.by_x, by_u: self.by_u }
    }

    /// Whether a place that slips at `u` comes back while its bristle is still stretched beyond what it can hold: it has turned
    /// round on the way, where nobody looked.
    pub(crate) fn comes_back(&self, grip: &Grip, u: &V3<f64>) -> bool {
        let elastic: V3<f64> = std::array::from_fn(|i| self.trial[i] + grip.damping * u[i]);
        let held = along(-grip.stiffness, &self.stretch);
        dot(&elastic, u) > 0.0 && dot(&elastic, &elastic) > (1.0 + SLACK) * dot(&held, &held)
    }

    /// Whether the force that it would have if it stuck has turned round since an iteration at which its place moved less
    /// by `du`, where the iteration moves places and velocities by these weights.
    pub(crate) fn turned(&self, grip: &Grip, du: &V3<f64>, w: Weights) -> bool {
        let more = grip.stiffness * w.q / w.v + grip.damping;
        dot(&self.trial, &self.trial) + more * dot(&self.trial, du) < 0.0
    }

    /// Takes it for one that holds, however hard it is pulled.
    pub(crate) fn stick(&mut self, grip: &Grip, n: &V3<f64>) {
        let across =
            |k: f64| std::array::from_fn(|i| std::array::from_fn(|j| k * (delta(i, j) - n[i] * n[j])));
        (self.by_x, self.by_u) = (across(-grip.stiffness), across(-grip.damping));
        (self.f, self.by_normal) = (self.trial, [0.0; 3]);
    }
}
