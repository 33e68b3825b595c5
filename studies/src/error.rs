//! What can go wrong between a scene and its results.

use ropewalk_core::broken::{self, Broken};
use ropewalk_core::integrator::StepError;
use ropewalk_core::modes::ModesError;
use ropewalk_core::statics::StaticsError;
use ropewalk_core::{BuildError, LineariseError};
use ropewalk_report::{Interrupt, OutputError};
use ropewalk_scene::{Fault, SceneError, SceneFile};
use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Why there are no results.
///
/// Its `Debug` is its message, which is what a `main` that returns it prints.
#[derive(thiserror::Error)]
pub enum Error {
    /// The scene file is wrong; the message shows the place.
    #[error("{0}")]
    File(#[from] Fault),
    /// The scene can't be built.
    #[error("{0}")]
    Scene(#[from] SceneError),
    /// A step could not be taken.
    #[error("{0}")]
    Step(StepError),
    /// A process could not go on.
    #[error("{0}")]
    Process(String),
    /// An equilibrium was not found.
    #[error("{0}")]
    Statics(StaticsError),
    /// The vibration modes could not be found.
    #[error("{0}")]
    Modes(ModesError),
    /// The equations could not be linearised.
    #[error("{0}")]
    Linearise(LineariseError),
    /// A function of the scene failed that was written elsewhere.
    #[error("{0}")]
    Function(Broken),
    /// Ctrl-C was pressed, or the system asked for the end, before there was anything to keep.
    #[error("stopped by {}", Interrupt::cause())]
    Interrupted,
    /// Results could not be written.
    #[error("{0}")]
    Output(#[from] OutputError),
}

impl From<StaticsError> for Error {
    fn from(e: StaticsError) -> Self {
        if e.interrupted { Error::Interrupted } else { Error::told(Error::Statics(e)) }
    }
}
impl From<StepError> for Error {
    fn from(e: StepError) -> Self {
        match e {
            StepError::Function(broken) => Error::Function(broken),
            e => Error::told(Error::Step(e)),
        }
    }
}
impl From<ModesError> for Error {
    fn from(e: ModesError) -> Self {
        Error::told(Error::Modes(e))
    }
}
impl From<LineariseError> for Error {
    fn from(e: LineariseError) -> Self {
        Error::told(Error::Linearise(e))
    }
}

impl Error {
    /// An error, or the function of the scene that it came of.
    fn told(e: Error) -> Error {
        broken::take().map_or(e, Error::Function)
    }

    /// Whether the scene or the command is to blame, not the solver: something has to be changed before the run
    /// can even begin.
    pub fn is_input(&self) -> bool {
        match self {
            Error::File(_) | Error::Scene(_) | Error::Output(_) => true,
            Error::Step(e) => Error::is_input_step(e),
            Error::Statics(_)
            | Error::Process(_)
            | Error::Function(_)
            | Error::Linearise(_)
            | Error::Interrupted => false,
            Error::Modes(e) => matches!(
                e,
                ModesError::Massless { .. } | ModesError::Moving { .. } | ModesError::Held | ModesError::None
            ),
        }
    }
}

impl Error {
    fn is_input_step(e: &StepError) -> bool {
        matches!(e, StepError::Options(_) | StepError::Inconsistent(_))
    }

    /// With the place in the file that is to blame, where it is known.
    #[must_use]
    pub fn in_file(self, file: &SceneFile) -> Self {
        match self {
            Error::Step(StepError::Options(e)) => Error::File(file.at_solver(&e)),
            Error::Step(e) if Error::is_input_step(&e) => {
                Error::File(file.at_solver(&BuildError::new(e.to_string())))
            }
            Error::Scene(e) => Error::File(file.fault(&e)),
            e => e,
        }
    }

    /// The message without the place in a file, which means nothing where several scenes are run.
    pub(crate) fn brief(&self) -> String {
        match self {
            Error::File(fault) => fault.message.clone(),
            Error::Scene(e) => e.error.message.clone(),
            other => other.to_string(),
        }
    }
}

/// Does this; a defect becomes an error, so that it takes nothing else with it.
pub(crate) fn caught<T>(work: impl FnOnce() -> Result<T, Error>) -> Result<T, Error> {
    let defect = || Err(Error::Process("an internal error, see above: please report it".into()));
    catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|_| defect())
}

impl fmt::Debug for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn a_main_that_returns_an_error_prints_what_a_user_can_read() {
        let e = crate::simulate::read("nowhere.toml").unwrap_err();
        assert_eq!(format!("Error: {e:?}"), "Error: there is no file `nowhere.toml`");
        let mut scene = ropewalk_scene::Scene::new();
        scene.run.duration = -1.0;
        let e = crate::simulate::simulate(&scene).err().unwrap();
        assert_eq!(format!("Error: {e:?}"), "Error: `duration` must be positive, but is -1");
    }
}
