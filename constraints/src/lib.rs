//! Ropewalk: constraints.
//!
//! Joints between markers, and the motions that drive them. A joint is a list of [`Equation`]s between two markers, in
//! closed form; a relation of another kind is written as a [`Relation`](ropewalk_core::Relation).

mod breaking;
mod check;
mod clamp;
mod connection;
mod coordinate;
mod direction;
mod distance;
mod driving;
pub mod motion;
pub mod package;
mod pair;
mod prismatic;
mod revolute;
mod spherical;
mod universal;
mod weld;
pub mod winch;

pub use breaking::BreakSpec;
pub use clamp::ClampSpec;
pub use connection::{Arrow, Connection, Equation};
pub use coordinate::{CoordinateSpec, coordinate};
pub use direction::{DirectionSpec, direction};
pub use distance::{DistanceSpec, distance};
pub use driving::{DrivingSpec, RotationSpec, SlideSpec, driving, rotation, slide};
pub use package::{Package, PackageSpec};
pub use prismatic::{
    CylindricalSpec, PointOnLineSpec, PointOnPlaneSpec, PrismaticSpec, cylindrical, point_on_line,
    point_on_plane, prismatic,
};
pub use revolute::{RevoluteSpec, revolute};
pub use spherical::{SphericalSpec, spherical};
pub use universal::{PerpendicularSpec, UniversalSpec, perpendicular, universal};
pub use weld::{WeldSpec, weld};
pub use winch::{EyeletSpec, LiftOffSpec, WinchSpec};
