//! SVG plots of results, publishable as they are and readable on any machine: no font files, no
//! display, colours that colour-blind readers can tell apart.
//!
//! - [`LinePlot`]: quantities over time, or one over another.
//! - [`Panels`]: several of these as one picture.
//! - [`BarPlot`]: quantities side by side.
//! - [`ShapePlot`]: a cable in a plane at several times.
//! - [`Raster`]: PNG and PDF of them, where the program was built with the feature `raster`.

mod axis;
mod bars;
mod canvas;
mod clip;
mod colour;
mod frame;
mod line;
mod outline;
mod panels;
mod raster;
mod shape;
mod thin;

pub use bars::{Bar, BarPlot};
pub use line::{LinePlot, Mark, Series};
pub use panels::Panels;
pub use raster::Raster;
pub use shape::{Plane, ShapePlot, Snapshot};
