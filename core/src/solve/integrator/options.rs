//! Options of time integration.

use super::scales::{Scales, Stopping};
use super::scheme::Scheme;
use crate::error::{BuildError, not_negative, positive};
use crate::model::Model;

/// How the step size is chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize, schemars::JsonSchema))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case", deny_unknown_fields))]
pub enum Stepping {
    /// Constant step size.
    Fixed {
        /// Step size [s].
        #[cfg_attr(feature = "serde", serde(deserialize_with = "ropewalk_quantity::time"))]
        h: f64,
    },
    /// Step size from an estimate of the error.
    Controlled {
        /// Error of positions that the run may accumulate, relative to the length of each part.
        tolerance: f64,
    },
}

/// Residual that fixed steps leave in the equations of motion, relative to the forces at work: far below the error of time.
const FIXED_FORCE: f64 = 1e-5;
/// A year [s].
const YEAR: f64 = 3.2e7;
/// Least time of a step for each unknown, on any machine [s].
const LEAST_WORK: f64 = 1e-7;

/// Bounds of the step size [s].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Smallest step before the run gives up.
    pub least: f64,
    /// Largest step.
    pub most: f64,
    /// First step, if it was asked for.
    pub start: Option<f64>,
    /// First step where the motion doesn't ask for a smaller one.
    pub guess: f64,
}

/// Share by which a fixed step grows to end on time rather than leave a tiny last step.
const STRETCH: f64 = 1e-3;

/// The fixed step `h` where at most `h_max` is left.
pub(super) fn fixed_step(h: f64, h_max: f64) -> f64 {
    if h_max <= (1.0 + STRETCH) * h { h_max } else { h }
}

/// When Newton's method computes a new iteration matrix.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize, schemars::JsonSchema))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum NewtonPolicy {
    /// When the iteration converges slowly.
    #[default]
    Modified,
    /// At every iteration.
    Full,
}

/// Form of the constraint equations.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize, schemars::JsonSchema))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum ConstraintForm {
    /// Satisfied by positions exactly, by velocities to the order of the scheme ("index 3").
    #[default]
    Positions,
    /// Satisfied by positions and velocities exactly: the stabilised form of Gear, Gupta & Leimkuhler (1985), for long
    /// runs. Costs a second linear solution per iteration.
    Ggl,
}

/// Options of time integration. The defaults suit cables from 8 to 8192 elements.
///
/// ```
/// use ropewalk_core::integrator::{Options, Stepping};
/// let fixed = Options { stepping: Stepping::Fixed { h: 1e-3 }, ..Options::default() };
/// assert!(fixed.check().is_ok());
/// assert!(Options { h_max: Some(-1.0), ..fixed }.check().is_err());
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize, schemars::JsonSchema))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
pub struct Options {
    /// Time integration scheme.
    pub scheme: Scheme,
    /// Constant steps or error control.
    pub stepping: Stepping,
    /// When Newton's method computes a new iteration matrix.
    pub newton: NewtonPolicy,
    /// Form of the constraint equations. Radau IIA always satisfies positions and velocities.
    pub constraints: ConstraintForm,
    /// Error of tensions and reactions, relative to the largest in the same part; of what goes to and fro with a period of a
    /// motion, a load or waves also relative to its swing.
    pub force_tolerance: f64,
    /// Accept a scheme that is unstable for constrained systems, with a warning.
    pub allow_unstable: bool,
    /// Largest step [s]. Default: a twentieth of the run.
    #[cfg_attr(
        feature = "serde",
        serde(
            deserialize_with = "ropewalk_quantity::optional::time",
            skip_serializing_if = "Option::is_none"
        )
    )]
    pub h_max: Option<f64>,
    /// Smallest step [s]; a run that needs a smaller one ends with an error. Default: 1e-12 of the run.
    #[cfg_attr(
        feature = "serde",
        serde(
            deserialize_with = "ropewalk_quantity::optional::time",
            skip_serializing_if = "Option::is_none"
        )
    )]
    pub h_min: Option<f64>,
    /// First step of error control [s]. Default: from the motion at the start.
    #[cfg_attr(
        feature = "serde",
        serde(
            deserialize_with = "ropewalk_quantity::optional::time",
            skip_serializing_if = "Option::is_none"
        )
    )]
    pub h_start: Option<f64>,
    /// Time over which step errors accumulate [s]. 0 means the whole run, without the time in which errors are negligible,
    /// or three times as long as the motion was measured to remember an error, if that is shorter.
    #[cfg_attr(feature = "serde", serde(deserialize_with = "ropewalk_quantity::time"))]
    pub horizon: f64,
    /// Project an inconsistent start onto the constraints, however far away it is.
    pub project: bool,
    /// Filter the initial accelerations by the stiffness, which fine meshes need, and start the scheme's own acceleration
    /// variable ahead of them, which its order needs. `false` is for textbook comparisons of the bare scheme.
    pub filter_start: bool,
    /// Most Newton iterations of a step before it is repeated with a smaller size. Radau IIA takes at most 10.
    pub max_iterations: u32,
    /// Newton tolerance as a multiple of the default: smaller is stricter.
    pub newton_tolerance: f64,
    /// Stopping test of Newton's method.
    pub stopping: Stopping,
    /// Scales that make the equations dimensionless before they are solved. With the `relative` stopping test they change
    /// nothing but rounding.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub scales: Option<Scales>,
}

impl Default for Options {
    fn default() -> Self {
        Options {
            scheme: Scheme::default(),
            stepping: Stepping::Controlled { tolerance: 1e-4 },
            newton: NewtonPolicy::default(),
            constraints: ConstraintForm::default(),
            force_tolerance: 1e-2,
            allow_unstable: false,
            h_max: None,
            h_min: None,
            h_start: None,
            horizon: 0.0,
            project: false,
            filter_start: true,
            max_iterations: 20,
            newton_tolerance: 1.0,
            stopping: Stopping::default(),
            scales: None,
        }
    }
}

impl Options {
    /// What Newton's method may leave of the equations of motion, relative to the forces at work in each part.
    pub(crate) fn newton_force_tolerance(&self) -> f64 {
        match self.stepping {
            Stepping::Fixed { .. } => FIXED_FORCE,
            Stepping::Controlled { .. } => 0.1 * self.force_tolerance,
        }
    }

    /// Refuses a run without an end, and steps so short that it would surely take longer than a year.
    pub(super) fn check_work(&self, model: &Model, duration: f64) -> Result<(), BuildError> {
        if !duration.is_finite() {
            let message = format!(
                "the length of the run is a finite time, by which steps are bounded, but is {duration} s: guess it where it \
                 isn't known"
            );
            return Err(BuildError::at("duration", message));
        }
        let (name, h) = match self.stepping {
            Stepping::Fixed { h } => ("h", h),
            Stepping::Controlled { .. } => ("h_max", self.limits(duration).most),
        };
        let (steps, least) = (duration / h, YEAR / (LEAST_WORK * model.velocities().max(1) as f64));
        if steps > least {
            let message = format!(
                "`{name}` = {h:e} s makes {steps:.0e} steps of a run of {duration} s: more than a year of computing. \
                 Take a larger one"
            );
            return Err(BuildError::at(name, message));
        }
        Ok(())
    }

    /// Bounds of the step in a run of this length [s].
    pub(crate) fn limits(&self, duration: f64) -> Limits {
        // a run of no length says nothing of its steps
        let duration = if duration > 0.0 { duration } else { 1.0 };
        let least = self.h_min.unwrap_or(1e-12 * duration);
        let most = self.h_max.unwrap_or(duration / 20.0);
        Limits { least, most, start: self.h_start, guess: (1e-3 * duration).min(most) }
    }

    /// The time over which errors add up [s].
    pub(crate) fn horizon_in(&self, duration: f64) -> f64 {
        if self.horizon > 0.0 { self.horizon } else { duration.max(f64::MIN_POSITIVE) }
    }

    /// Checks the numbers.
    ///
    /// # Errors
    /// The first that is wrong, with the field that holds it.
    pub fn check(&self) -> Result<(), BuildError> {
        let estimate = match self.scheme {
            Scheme::RadauIia5 => true,
            _ => self.scheme.coefficients()?.error_constant().abs() >= 1e-6,
        };
        for (name, h) in [("h_max", self.h_max), ("h_min", self.h_min), ("h_start", self.h_start)] {
            h.map_or(Ok(()), |h| positive(name, h).map(drop))?;
        }
        positive("newton_tolerance", self.newton_tolerance)?;
        if let (Some(least), Some(most)) = (self.h_min, self.h_max)
            && least > most
        {
            let message = format!("`h_min` = {least} s must not be above `h_max` = {most} s");
            return Err(BuildError::at("h_min", message));
        }
        positive("force_tolerance", self.force_tolerance)?;
        not_negative("horizon", self.horizon)?;
        if self.max_iterations < 2 {
            return Err(BuildError::at("max_iterations", "`max_iterations` must be at least 2"));
        }
        self.stopping.check()?;
        if self.scheme == Scheme::RadauIia5 && (self.stopping != Stopping::Relative || self.scales.is_some())
        {
            let message =
                "Radau IIA has neither `scales` nor an `absolute` stopping test: take another scheme";
            return Err(BuildError::at("scheme", message));
        }
        match self.stepping {
            Stepping::Fixed { h } => positive("h", h).map(drop),
            Stepping::Controlled { tolerance } => {
                positive("tolerance", tolerance)?;
                if !estimate {
                    return Err(BuildError::at(
                        "scheme",
                        "this scheme has no error estimate: choose a fixed step",
                    ));
                }
                Ok(())
            }
        }
    }
}
