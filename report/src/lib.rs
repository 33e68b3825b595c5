//! What a run leaves behind, and what it shows while it computes.
//!
//! - [`RunFolder`]: the folder of a run; nothing in it is ever overwritten by a later run. [`FolderLock`]: one at a time.
//! - [`Table`], [`TableWriter`]: time histories, as CSV; [`Csv`]: other tables; [`Sheet`]: reports for the terminal.
//! - [`LinePlot`], [`Panels`], [`BarPlot`], [`ShapePlot`]: SVG pictures that need no fonts and no display.
//! - [`Page`]: all of a run as one page for the browser, with its motion in space; [`StillPage`]: tables and pictures in the
//!   same look.
//! - [`statistics`]: moments, cycles of fatigue and extremes of records.
//! - [`FieldRecord`]: what moved; [`vtk`] writes it for ParaView.
//! - [`Progress`], [`SweepProgress`], [`Watch`], [`Interrupt`], [`Stopwatch`]: the progress bars, Ctrl-C and deadlines, CPU
//!   time.

mod error;
mod field;
mod folder;
mod interrupt;
mod lock;
mod number;
mod page;
pub mod plot;
mod progress;
mod sheet;
pub mod statistics;
mod stopwatch;
mod table;
pub mod vtk;
mod watch;

pub use error::OutputError;
pub use field::{
    BodyRecord, FieldRecord, ForceRecord, LineRecord, LineSnapshot, Mesh, Pose, Quantity, Shape, Solid, Wave,
    Waves,
};
pub(crate) use folder::write_atomic_bytes;
pub use folder::{RUNS, RunFolder, cannot_create, plain, write_atomic, write_durable, write_json};
pub use interrupt::Interrupt;
pub use lock::FolderLock;
pub use number::{number, rough};
pub use page::{Entry, Event, Listing, Page, Panel, RangeGraph, Section, Steps, StillPage, escaped};
pub use plot::{Bar, BarPlot, LinePlot, Mark, Panels, Plane, Series, ShapePlot, Snapshot};
pub use progress::{Progress, ProgressMode, SweepProgress, new_bar};
pub use sheet::{Sheet, TERMINAL};
pub use stopwatch::{Elapsed, Stopwatch};
pub use table::{Column, Csv, Table, TableWriter, cells, push_number};
pub use watch::Watch;
