//! What a run leaves behind, and what it shows while it computes.
//!
//! - [`RunFolder`]: the folder of a run; nothing in it is ever overwritten by a later run.
//! - [`Table`], [`TableWriter`]: time histories, as CSV.
//! - [`LinePlot`], [`Panels`], [`BarPlot`], [`ShapePlot`]: SVG pictures that need no fonts and no display.
//! - [`Page`]: all of a run as one page for the browser, with its motion in space.
//! - [`FieldRecord`]: what moved; [`vtk`] writes it for ParaView.
//! - [`Progress`], [`SweepProgress`], [`Interrupt`], [`Stopwatch`]: the progress bars, Ctrl-C, and CPU time.

mod columns;
mod error;
mod field;
mod folder;
mod interrupt;
mod number;
mod page;
pub mod plot;
mod progress;
mod stopwatch;
mod table;
pub mod vtk;

pub use columns::in_columns;
pub use error::OutputError;
pub use field::{BodyRecord, FieldRecord, LineRecord, LineSnapshot, Mesh, Pose, Quantity, Shape, Solid};
pub use folder::write_durable;
pub use folder::{RUNS, cannot_create, plain, write_json};
pub use folder::{RunFolder, write_atomic};
pub use interrupt::Interrupt;
pub use number::{number, rough};
pub use page::{Entry, Event, Page, Panel};
pub use plot::{Bar, BarPlot, LinePlot, Mark, Panels, Plane, Series, ShapePlot, Snapshot};
pub use progress::new_bar;
pub use progress::{Progress, ProgressMode, SweepProgress};
pub use stopwatch::{Elapsed, Stopwatch};
pub use table::{Column, Table, TableWriter};
pub use table::{cells, push_cell, push_number};
