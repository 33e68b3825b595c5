//! Everything that changes during a run, as plain data.

use crate::model::limit::Limit;

/// Time, configuration, velocities, multipliers and the memory of the integrator: what a checkpoint holds.
///
/// A `State` belongs to the [`Model`](crate::Model) that made it with [`Model::state`](crate::Model::state).
#[derive(Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct State {
    /// Time [s].
    pub t: f64,
    /// Configuration, node by node.
    pub q: Vec<f64>,
    /// Velocities.
    pub v: Vec<f64>,
    /// True accelerations v̇, those that equilibrium is written in.
    pub a: Vec<f64>,
    /// The auxiliary accelerations of the generalized-α family, which lag or lead [`State::a`]; for Radau IIA the
    /// accelerations as the equations of motion give them, round-off included, which [`State::a`] is smooth of.
    pub aux: Vec<f64>,
    /// Multipliers of the constraints, in the order of their rows.
    pub lambda: Vec<f64>,
    /// Internal variables of parts that latch, break or stick, which change at events and accepted states alone; named by the
    /// model.
    pub internal: Vec<f64>,
    /// What the step-size controller remembers between steps.
    pub control: Control,
}

/// Memory of the integrator and its step-size controller.
#[derive(Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Control {
    /// Size of the last accepted step [s]; 0 before the first.
    pub h_last: f64,
    /// Size of the first step under error control [s].
    #[cfg_attr(feature = "serde", serde(default))]
    pub h_start: f64,
    /// Size proposed for the next step [s]; 0 if none.
    pub h_next: f64,
    /// What keeps that from being longer.
    #[cfg_attr(feature = "serde", serde(default))]
    pub limit: Limit,
    /// No larger step until it has grown back after a failure of Newton's method [s]; 0 if free.
    pub h_cap: f64,
    /// What Newton's method expects its remaining error to be, in parts of its last correction.
    pub eta: f64,
    /// Convergence rate that the kept factors last showed; 0 if none was seen.
    pub theta: f64,
    /// For how many steps yet factors are made anew at every iteration, since kept ones didn't converge.
    pub renew: u32,
    /// For how many steps it was the last time.
    pub renew_next: u32,
    /// True accelerations one and two steps back, for the predictor.
    pub a_back: [Vec<f64>; 2],
    /// How many entries of `a_back` hold.
    pub backs: usize,
    /// Size of the accepted step before the last [s].
    pub h_before: f64,
    /// Order of the polynomial that would have predicted the last accelerations best.
    pub order: usize,
    /// The largest force in each part, which Newton's method measures residuals by [N].
    #[cfg_attr(feature = "serde", serde(default))]
    pub forces: Vec<f64>,
    /// Radau IIA: increments from the present configuration back to the start and to the first two stages of the last
    /// step. Empty at a start.
    #[cfg_attr(feature = "serde", serde(default))]
    pub stages: [Vec<f64>; 3],
    /// Radau IIA: multipliers of the stages of the last step.
    #[cfg_attr(feature = "serde", serde(default))]
    pub stage_lambda: [Vec<f64>; 3],
    /// Estimated error of the last step over the tolerance, as the next one was made for it.
    #[cfg_attr(feature = "serde", serde(default))]
    pub error: f64,
    /// By how much accelerations changed of late [1/s²], and what they added up to [1/s], relative to the part where that is
    /// largest: over each other the pace of the motion.
    #[cfg_attr(feature = "serde", serde(default))]
    pub pace: [f64; 2],
    /// For how many steps yet the scheme is one that takes away what swings from step to step.
    #[cfg_attr(feature = "serde", serde(default))]
    pub calm: u32,
    /// Whether the last step was made with that.
    #[cfg_attr(feature = "serde", serde(default))]
    pub calmed: bool,
}

/// Derived `Clone` for two types whose `clone_from` must not allocate: it runs at every step.
macro_rules! clone_in_place {
    ($type:ident { $($field:ident),* }) => {
        impl Clone for $type {
            fn clone(&self) -> Self {
                $type { $($field: self.$field.clone()),* }
            }
            fn clone_from(&mut self, other: &Self) {
                $(self.$field.clone_from(&other.$field);)*
            }
        }
    };
}
clone_in_place!(State { t, q, v, a, aux, lambda, internal, control });
clone_in_place!(Control {
    h_last,
    h_start,
    h_next,
    limit,
    h_cap,
    eta,
    theta,
    renew,
    renew_next,
    a_back,
    backs,
    h_before,
    order,
    forces,
    stages,
    stage_lambda,
    error,
    pace,
    calm,
    calmed
});

/// Where terms and constraints are evaluated: slices into a state, or into a trial of an integrator.
#[derive(Clone, Copy, Debug)]
pub struct At<'a> {
    /// Time [s].
    pub t: f64,
    /// Configuration.
    pub q: &'a [f64],
    /// Velocities.
    pub v: &'a [f64],
    /// True accelerations.
    pub a: &'a [f64],
    /// Internal variables of parts that latch, break or stick.
    pub internal: &'a [f64],
    /// How a search for equilibrium wants stiffness to be relaxed. `None` in dynamics and once it has been found.
    pub relaxed: Option<Relaxed<'a>>,
}

/// What a search for equilibrium asks of elements that are stiff in one way and soft in another, such as cables.
/// It changes the way to the equilibrium, not the equilibrium; an element may ignore it.
#[derive(Clone, Copy, Debug)]
pub struct Relaxed<'a> {
    /// The last increment of the iteration: geometric stiffness is to take its stress from the strain linearised
    /// there, which is already close to the final one where that of the present shape is far off.
    pub last: Option<&'a [f64]>,
    /// Numbers for the element.
    pub how: Relaxation,
}

/// The numbers of [`Relaxed`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Relaxation {
    /// Whether an iterate before is given, to linearise the strain at.
    pub smooth: bool,
    /// Cap on the stiff modulus as a multiple of what the load can use: it rises from iteration to iteration until
    /// it doesn't bind. Infinite without cap.
    pub ramp: f64,
    /// The same at the iteration before, which the stress for the geometric stiffness is taken with.
    pub ramp_before: f64,
    /// Size of the load [N].
    pub load: f64,
    /// Least tension for the geometric stiffness [N]: makes it positive where the shape is slack. Not set: as it is.
    pub floor: Option<f64>,
    /// Whether the tangent is to tell stable from unstable: an error of a model that makes it differ from its mirror image a
    /// little is better left out then.
    pub judges: bool,
}

impl Relaxed<'_> {
    /// The tangent of the forces, to tell stable from unstable.
    pub(crate) fn to_judge() -> Self {
        Relaxed { last: None, how: Relaxation { judges: true, ..Relaxation::check(false, 0.0) } }
    }
}

impl Relaxation {
    /// Whether the tangent is to be another than that of the forces.
    pub fn relaxes(&self) -> bool {
        let capped = self.ramp.is_finite() || self.ramp_before.is_finite();
        self.smooth || capped || self.floor.is_some()
    }

    /// Nothing is relaxed: an equilibrium is checked under a load [N]; `smooth` says that an iterate before is given. With a
    /// stiff modulus even there only the smooth stress is good enough to tell stable from unstable.
    pub(crate) fn check(smooth: bool, load: f64) -> Self {
        Relaxation {
            smooth,
            ramp: f64::INFINITY,
            ramp_before: f64::INFINITY,
            load,
            floor: None,
            judges: false,
        }
    }
}

impl State {
    /// The state as a place of evaluation.
    pub fn at(&self) -> At<'_> {
        At { t: self.t, q: &self.q, v: &self.v, a: &self.a, internal: &self.internal, relaxed: None }
    }
    /// Whether every number is finite.
    pub fn is_finite(&self) -> bool {
        self.t.is_finite()
            && [&self.q, &self.v, &self.a, &self.lambda].iter().all(|x| x.iter().all(|x| x.is_finite()))
    }
}
