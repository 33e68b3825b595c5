//! Unwinding a cable from a package through an eyelet, by finite differences: a formulation of its own.
//!
//! The free cable between the eyelet and the lift-off point is an open system: material enters where it is peeled from
//! the package and leaves through the eyelet. An [`Unwinding`] says what is unwound and how; [`Unwinding::start`] makes a
//! consistent [`State`], [`Unwinding::run`] moves it by Newmark's method and gives a [`History`], and
//! [`Unwinding::steady`] finds the balloon that stands still in the turning frame.
//!
//! It solves the equation of motion of an inextensible cable of fourth order in the arc length with central differences
//! on nodes at fixed shares of the free length. Nothing of it is shared with the finite elements of Ropewalk but the
//! laws of drag, the motions and the geometry of the package: two formulations of one physics that can be compared.
//!
//! - The tension comes from the differentiated constraint of every segment, the discrete form of the elliptic tension
//!   equation; Baumgarte's terms keep the lengths, so that nothing drifts. Marching the tangential equation from the
//!   eyelet is left as a check ([`Row::marching`]).
//! - Everything is of second order in the mesh, and in time without numerical damping. A few nodes must lie in the
//!   boundary layers, whose length is `√(EI/T)`.
//! - Where bending stiffness, a tangent lift-off and a given tension come together, the tension hardly feels how fast
//!   the cable is peeled; then a little numerical damping (0.05) keeps the lift-off point from trembling.
//! - Speed and tension both given: the lift-off point is free. If the free length is given instead, the tension is an
//!   output. Under a tension that is too low or negative the run goes on and says so ([`Condition`]).
//!
//! ```
//! use ropewalk_constraints::{Package, PackageSpec, motion::Straight};
//! use ropewalk_models::unwinding::{Cable, Plan, Pull, Rule, Stepping, Unwinding};
//! use std::sync::Arc;
//!
//! let cable = Cable { mass: 1e-3, diameter: 0.9e-3, ei: 0.0, curvature_limit: 200.0 };
//! let spec = PackageSpec { origin: [0.0, 0.0, 0.1], ..PackageSpec::new(0.06, 0.2, 0.9e-3) };
//! let package = Arc::new(Package::new(&spec)?);
//! let draw = Arc::new(Straight::new([1.0, 0.0, 0.0], 2.57, 0.0, 0.1)?);
//! let rule = Rule::Tension(Pull::constant(0.15));
//! let unwinding = Unwinding::new(cable, package, draw, rule, 20);
//!
//! let start = unwinding.start(&[[0.0, 0.0, 0.0], [0.06, 0.0, 0.1]], 0.0, 0.0)?;
//! let plan = Plan { t_end: 0.02, every: 0.01, shapes: vec![] };
//! let history = unwinding.run(start, Stepping::new(1e-3), &plan)?;
//! assert!(history.stopped.is_none() && history.rows.len() == 3);
//! # Ok::<(), ropewalk_core::BuildError>(())
//! ```

mod bordered;
mod conditions;
mod ends;
mod equation;
mod history;
mod newmark;
mod path;
mod problem;
mod spec;
mod start;
mod state;
mod steady;
#[cfg(test)]
mod tests;

pub use conditions::{Condition, Kind};
pub use history::{History, Plan, Row, Running, Shape};
pub use newmark::{Stepping, Stopped};
pub use path::{Guide, Path, Ring};
pub use problem::{Cable, Eyelet, LiftOff, Pull, Rule, Unwinding};
pub use spec::{RuleSpec, UnwindingSpec};
pub use state::State;
pub use steady::{Balloon, SteadyError};
