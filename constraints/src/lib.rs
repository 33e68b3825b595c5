//! Ropewalk: constraints.
//!
//! Relations between markers (joints, clamps, driven points) and the motions that drive them.

mod check;
mod clamp;
mod coordinate;
mod distance;
mod driving;
pub mod motion;
mod spec;
mod spherical;

pub use clamp::{BodyClamp, Clamp};
pub use coordinate::Coordinate;
pub use distance::Distance;
pub use driving::Driving;
pub use spec::{ClampSpec, CoordinateSpec, DistanceSpec, DrivingSpec, SphericalSpec};
pub use spherical::Spherical;
