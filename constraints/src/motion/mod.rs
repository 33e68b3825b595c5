//! Motions that drive constraints: what ships and vehicles do.
//!
//! All have two continuous derivatives from rest on, and are at rest at displacement zero before they start (a
//! [`Table`] is what its rows say, and only for their time).

mod circle;
mod harmonic;
mod plane;
mod rest;
mod smooth;
mod spec;
mod straight;
mod table;
mod turn;

pub use circle::Circle;
pub use harmonic::Harmonic;
pub use plane::Side;
pub use rest::Rest;
pub use spec::{CircleSpec, HarmonicSpec, RestSpec, StraightSpec, TableEnds, TableSpec, Towards, TurnSpec};
pub use straight::Straight;
pub use table::{Ends, Table};
pub use turn::{Manoeuvre, Turn};
