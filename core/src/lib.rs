//! The core of Ropewalk: what a flexible multibody model is made of, and how it is solved.
//!
//! Nodes own coordinates; terms (pools of elements, fields on stations) add to a residual and its tangent;
//! constraints hold markers together; integrators and analyses move a [`State`] of an immutable [`Model`].
//!
//! Four floors, each standing on those before: [`algebra`] (lanes, rotations, interpolation), [`model`] (what the
//! equations are made of), [`solve`] (linear systems, integrators, equilibria, modes) and [`simulation`] (a run in time).

pub mod algebra;
pub mod error;
pub mod model;
pub mod simulation;
pub mod solve;
pub mod testing;

pub use algebra::gradient::{Gradient, Residuals, Seeds, tangent};
pub use algebra::interpolation::{EndSlope, Interpolation, Join};
pub use algebra::jet::Jet;
pub use algebra::lane::{Dual, LaneTask, Pack, Real, V3, Width, dot, run, scaled};
pub use algebra::rotation;
pub use algebra::scalar::Scalar;
pub use error::BuildError;
pub use model::assembly::{Spent, System};
pub use model::capability::{Couples, Foresees, Remembers, Shows, Timed};
pub use model::column::Column;
pub use model::constraint::{Constraint, RowKind};
pub use model::controller::Controller;
pub use model::dead::{DeadEntry, DeadLoad, DeadPull};
pub use model::event::{Action, Depends, Event};
pub use model::feed::{Feed, MovingBoundary};
pub use model::input::{Course, Driven, Hold, Input, InputError, Signal};
pub use model::joint::Joint;
pub use model::joint::equation::{Arrow, Equation};
pub use model::line::{Line, Quantity, Slender};
pub use model::marker::{Marker, Place};
pub use model::motion::{Motion, Moving, SteadyFrame};
pub use model::node::{Node, NodeId, NodeKind, difference, retract};
pub use model::part::{ContactPoint, Part, Per, Spot, Tip};
pub use model::pattern::Pattern;
pub use model::pool::{Batch, Element, Local, Pool, Share};
pub use model::redundancy::Redundancy;
pub use model::relation::{Related, Relation, lift};
pub use model::remesh::{Change, Mesh, MeshState, Plan, Prestrain, Remeshed};
pub use model::solid::{Attitude, Solid, Surface};
pub use model::span::{ContactSpan, SpanFlow, SpanLine};
pub use model::state::{At, Control, Relaxation, Relaxed, State};
pub use model::station::{
    FieldTerm, Gives, Joined, Law, Laws, Load, Station, StationElement, StationPool, Stations,
};
pub use model::structure::{Block, Columns, Structure};
pub use model::term::{Assembly, Energy, Leap, Power, Term, Weights};
pub use model::{Model, Recipe, Start, Switches, broken, held, reach};
pub use simulation::audit::{Audit, Created};
pub use simulation::layers::Layers;
pub use simulation::record::{Record, Sample};
pub use simulation::shock;
pub use simulation::{Checkpoint, End, Observer, Simulation, Unfit};
pub use solve::linear::{Chain, Dense as DenseSolver, Fronts, Guard, LinearSolver, Lu, SolveError};
pub use solve::linearise::{LineariseError, Linearised, Sparse, linearise};
pub use solve::redundancy::find_redundancy;
pub use solve::{integrator, modes, statics};
