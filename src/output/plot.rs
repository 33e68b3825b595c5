//! SVG plots of results, publishable as they are and readable on any machine: no font files, no
//! display, colours that colour-blind readers can tell apart.
//!
//! - [`LinePlot`]: quantities over time, or one over another.
//! - [`ShapePlot`]: a cable in a plane at several times.
//! - [`BarPlot`]: one number for each of several things, on a logarithmic scale.

mod axis;
mod bar;
mod canvas;
mod colour;
mod frame;
mod line;
mod shape;
mod thin;

pub use bar::{BarPlot, NamedBar};
pub use line::{LinePlot, Mark, Series};
pub use shape::{Plane, ShapePlot, Snapshot};
