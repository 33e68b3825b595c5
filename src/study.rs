//! What studies of many runs share: their folder, what can be varied in a scene whatever it is, what of a run is looked
//! at, and running in memory.

mod axes;
mod folder;
mod measure;
mod runner;
mod target;

pub(crate) use axes::{Axes, Settings, words};
pub(crate) use folder::{Study, StudyFolder, shortened};
pub(crate) use measure::{Measured, Watch, measure, on_all_cores};
pub(crate) use runner::Runner;
pub(crate) use target::{Target, difference};
