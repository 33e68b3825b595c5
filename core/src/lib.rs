//! The core of Ropewalk: what a flexible multibody model is made of, and how it is solved.
//!
//! Nodes own coordinates; terms (pools of elements, fields on stations) add to a residual and its tangent;
//! constraints hold markers together; integrators and analyses move a [`State`] of an immutable [`Model`].

mod constraint;
mod lane;
mod marker;
mod motion;
mod node;
mod pattern;
mod pool;
mod state;
mod station;
mod term;
pub mod testing;

pub use constraint::{Constraint, Joint, Relation, RowKind, lift};
pub use lane::{LaneTask, Pack, Real, V3, Width, dot, run};
pub use marker::{Jet, Marker, Place};
pub use motion::{Motion, Moving, SteadyFrame};
pub use node::{Node, NodeId, NodeKind, retract};
pub use pattern::{Pattern, Structure};
pub use pool::{Batch, Element, Local, Pool, Share};
pub use state::{At, Control, State};
pub use station::{FieldTerm, Law, Laws, Load, Station, StationElement, StationPool, Stations};
pub use term::{Assembly, Energy, Power, Term, Weights};
