//! The core of Ropewalk: what a flexible multibody model is made of, and how it is solved.
//!
//! Nodes own coordinates; terms (pools of elements, fields on stations) add to a residual and its tangent;
//! constraints hold markers together; integrators and analyses move a [`State`] of an immutable [`Model`].

pub mod build;
mod constraint;
mod current;
mod dead;
mod dense;
mod feed;
pub mod file;
pub mod held;
pub mod integrator;
mod interpolation;
mod lane;
mod layers;
mod marker;
mod model;
pub mod modes;
mod motion;
mod node;
mod order;
mod part;
mod pattern;
mod pool;
mod process;
pub mod quantity;
pub mod reach;
mod record;
pub mod records;
mod redundancy;
mod remesh;
pub mod rotation;
mod scene;
mod simulation;
mod solver;
mod span;
mod spec;
mod state;
pub mod statics;
mod station;
mod structure;
mod term;
pub mod testing;
mod times;
mod water;

pub use build::{BuildError, Builder};
pub use constraint::{Constraint, Joint, Relation, RowKind, lift};
pub use current::Current;
pub use dead::{DeadEntry, DeadLoad, DeadPull};
pub use feed::{Feed, Front};
pub use interpolation::{EndSlope, Interpolation, Join};
pub use lane::{Dual, LaneTask, Pack, Real, V3, Width, dot, run, scaled};
pub use layers::Layers;
pub use marker::{Jet, Marker, Place};
pub use model::{Model, Start, Switches, System};
pub use motion::{Motion, Moving, SteadyFrame};
pub use node::{Node, NodeId, NodeKind, difference, retract};
pub use part::{ContactPoint, Part, Per, Quantity, Slender, Spot, Tip, split_marker};
pub use pattern::Pattern;
pub use pool::{Batch, Element, Local, Pool, Share};
pub use process::{Channel, Process, ProcessSpec, Surroundings};
pub use record::{Audit, Column, Created, Record, Sample};
pub use redundancy::Redundancy;
pub use remesh::{Change, Mesh, MeshState, Plan, Prestrain, Remeshed};
pub use scene::{Analysis, GRAVITY, Run, Scene, SceneError, ShapeTitles, TableSpec};
pub use simulation::{Action, Checkpoint, End, Event, Observer, Simulation, Unfit};
pub use solver::{Chain, Dense as DenseSolver, Fronts, Guard, LinearSolver, Lu, Scalar, SolveError};
pub use span::{ContactSpan, SpanFlow, SpanLine};
pub use spec::{
    ConstraintSpec, ElementSpec, ForceSpec, MarkerRef, MotionSpec, RecordSpec, SpecInfo, SpecKind, registered,
};
pub use state::{At, Control, Relaxation, Relaxed, State};
pub use station::{FieldTerm, Gives, Law, Laws, Load, Station, StationElement, StationPool, Stations};
pub use structure::{Block, Columns, Structure};
pub use term::{Assembly, Energy, Leap, Power, Term, Weights};
pub use times::Spent;
pub use water::{Air, Level, Water, ball_below};

#[doc(hidden)]
pub use inventory;
#[doc(hidden)]
pub use schemars;
