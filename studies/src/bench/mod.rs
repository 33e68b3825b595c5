//! What computing costs on the machine at hand: the measurements behind `ropewalk bench` and `cargo bench`.
//!
//! One problem for all of them, a [`Pendulum`], dry or in water; and a chain of rigid [`Links`]. A [`FullIteration`] is what Newton's method repeats
//! (force, exact tangent, assembly, factors, solution), [`Steps`] what a run repeats; [`measure`] times both by the
//! shortest of many short samples, which is what a busy machine disturbs least.
//!
//! ```
//! use ropewalk_studies::bench::{FullIteration, Pendulum, measure::shortest};
//! use ropewalk_core::Width;
//! use std::time::Duration;
//!
//! let mut iteration = FullIteration::new(&Pendulum::new(8).in_water(), Width::best())?;
//! let seconds = shortest(Duration::from_millis(10), || iteration.run())?;
//! println!("{:.2} µs per element", 1e6 * seconds / 8.0);
//! # Ok::<(), ropewalk_studies::Error>(())
//! ```

pub mod measure;
mod problem;
pub mod report;

pub use problem::{FullIteration, Links, Pendulum, Steps, models};
pub use report::{Cost, Memory, Report, Share, StepCost, VariantCost};
