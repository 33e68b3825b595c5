//! What can go wrong between a scene and its results.

use crate::output::OutputError;
use crate::scene::Fault;
use ropewalk_core::SceneError;
use ropewalk_core::integrator::StepError;
use ropewalk_core::modes::ModesError;
use ropewalk_core::statics::StaticsError;

/// Why there are no results.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The scene file is wrong; the message shows the place.
    #[error("{0}")]
    File(#[from] Fault),
    /// The scene can't be built.
    #[error("error: {0}")]
    Scene(#[from] SceneError),
    /// A step could not be taken.
    #[error("error: {0}")]
    Step(#[from] StepError),
    /// A process could not go on.
    #[error("error: {0}")]
    Process(String),
    /// An equilibrium was not found.
    #[error("error: {0}")]
    Statics(#[from] StaticsError),
    /// The vibration modes could not be found.
    #[error("error: {0}")]
    Modes(#[from] ModesError),
    /// Ctrl-C was pressed before there was anything to keep.
    #[error("stopped by Ctrl-C")]
    Interrupted,
    /// Results could not be written.
    #[error("error: {0}")]
    Output(#[from] OutputError),
}

impl Error {
    /// Whether the scene or the command is to blame, not the solver: something has to be changed before the run
    /// can even begin.
    pub fn is_input(&self) -> bool {
        match self {
            Error::File(_) | Error::Scene(_) | Error::Output(_) => true,
            Error::Step(e) => matches!(e, StepError::Scheme(_) | StepError::Inconsistent(_)),
            Error::Statics(_) | Error::Process(_) | Error::Interrupted => false,
            Error::Modes(e) => matches!(
                e,
                ModesError::Massless { .. } | ModesError::Moving { .. } | ModesError::Held | ModesError::None
            ),
        }
    }
}
