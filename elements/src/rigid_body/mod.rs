//! Rigid bodies: full inertia, points to hold them at, a hull for what the water does.

mod element;
mod part;
mod shape;
mod spec;
mod stations;

pub use element::Inertia;
pub use part::BodyPart;
pub use shape::{Shape, inertia};
pub use spec::{HullSpec, RigidBodySpec};
pub use stations::Hull;
