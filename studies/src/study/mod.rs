//! What studies of many runs share: their folder, what can be varied in a scene whatever it is, what of a run is looked
//! at, and the runs, in memory or each in a folder of its own.

mod axes;
mod folder;
mod runner;
mod runs;
mod share;
mod target;

pub use axes::Axes;
pub(crate) use axes::{Settings, words};
pub(crate) use folder::{Study, StudyFolder, shortened};
pub(crate) use runner::{Runner, complete, lock, on_all_cores};
pub(crate) use runs::Run;
pub use runs::Runs;
pub use target::Target;
pub(crate) use target::{When, difference};
