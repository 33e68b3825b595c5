//! Time integration: schemes, Newton's method, step-size control, consistent starts.

mod adding;
mod alpha;
mod consistent;
mod controller;
mod convergence;
mod factors;
mod forces;
mod inertia;
mod newton;
mod norm;
mod options;
mod predictor;
mod radau;
mod scales;
mod scheme;
mod start;
mod step;
mod workspace;

pub use crate::model::limit::Limit;
pub use alpha::Alpha;
pub use consistent::consistent;
pub(crate) use consistent::{
    MOST_MOVES, accelerate, agree, agree_in_velocity, consistent_by_iteration, consistent_by_mass,
    move_velocities, way_back,
};
pub use forces::Strained;
pub(crate) use norm::{Group, Speeds};
pub use options::{ConstraintForm, Limits, NewtonPolicy, Options, Stepping};
pub use radau::Radau;
pub use scales::{Scales, Stopping, Units};
pub use scheme::{Coefficients, Scheme};
pub(crate) use start::restart;
pub use start::{Correction, prepare};
pub use step::{Integrator, StepError, StepReport};
pub(crate) use workspace::Which;
pub use workspace::{Counts, Workspace};

use crate::model::Model;

impl Options {
    /// The integrator that they describe. `duration` is the length of the run [s], over which errors add up unless
    /// [`Options::horizon`] says otherwise.
    ///
    /// # Errors
    /// The options are wrong, the run has no end, or the scheme doesn't suit the model.
    pub fn integrator(&self, model: &Model, duration: f64) -> Result<Box<dyn Integrator>, StepError> {
        self.check()?;
        self.check_work(model, duration)?;
        Ok(match self.scheme {
            Scheme::RadauIia5 => Box::new(Radau::new(self, duration)?),
            _ => Box::new(Alpha::new(self, model, duration)?),
        })
    }
}
