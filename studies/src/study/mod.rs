//! What studies of many runs share: their folder, what can be varied in a scene whatever it is, what of a run is looked
//! at, and running in memory.

mod axes;
mod folder;
mod measure;
mod runner;
mod target;

pub use axes::Axes;
pub(crate) use axes::{Settings, words};
pub(crate) use folder::{Study, StudyFolder, shortened};
pub use measure::Watch;
pub(crate) use measure::{Measured, measure, on_all_cores};
pub(crate) use runner::Runner;
pub use target::Target;
pub(crate) use target::difference;
