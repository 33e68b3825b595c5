//! Contact with shapes: penalty, damping, friction.
//!
//! Cables, links and hulls touch all along ([`ContactSpan`](ropewalk_core::ContactSpan)s), points by balls
//! ([`ContactPoint`](ropewalk_core::ContactPoint)s); a [`Shape`] tells how far away its surface is and how it is curved
//! there, a search finds the places that touch, the [`ContactLaw`] says what force follows, and [`Contact`] puts it all
//! into the equations of motion.

mod ahead;
mod bed;
mod block;
mod braked;
mod bristles;
mod candidates;
mod file;
mod flowing;
mod friction;
mod group;
mod heights;
mod hollows;
mod law;
pub(crate) mod level;
mod lines;
mod mesh;
mod pressing;
mod rest;
mod round;
mod search;
mod seat;
mod shape;
mod shape_spec;
mod shows;
mod spec;
mod stiffness;
mod term;
mod touch;

pub use bed::{BedSpec, GridSpec, HeightRow};
pub use file::read;
pub use friction::{AtRest, Brake, Friction, Grip};
pub use heights::Heights;
pub use law::{ContactLaw, Damping, Leaving};
pub use lines::{ClearanceSpec, Deepest, LineContact, LineContactSpec, Touching, nearest_points};
pub use mesh::{MOST_TRIANGLES, Mesh, Soup};
pub use shape::{Gap, Shape};
pub use shape_spec::ShapeSpec;
pub use spec::{ContactSpec, Overlap};
pub use stiffness::Stiffness;
pub use term::Contact;
