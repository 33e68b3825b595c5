//! Constraints: joints, prescribed motions, winches, eyelets and packages.
//!
//! ```
//! use ropewalk_constraints::SphericalSpec;
//! use ropewalk_elements::{CableSpec, Section};
//! use ropewalk_scene::Scene;
//!
//! let mut scene = Scene::new();
//! scene
//!     .element(CableSpec::straight("line", [0.0; 3], [4.0, 0.0, 0.0], 8, Section::new(0.3, 1e5, 0.1)))
//!     .constraint(SphericalSpec::pin("hook", "line.start"));
//! // a pin holds three coordinates
//! assert_eq!(scene.build()?.multipliers(), 3);
//! # Ok::<(), ropewalk_scene::SceneError>(())
//! ```
//!
//! Joints between markers, and the motions that drive them. Each kind of joint here makes a [`Joint`](ropewalk_core::Joint) of its equations.

mod axis;
mod breaking;
mod check;
mod clamp;
mod coordinate;
mod direction;
mod distance;
mod driving;
pub mod motion;
pub mod package;
mod pair;
mod prismatic;
pub mod reeving;
mod revolute;
mod spherical;
mod universal;
mod vessel;
mod weld;
pub mod winch;

pub use breaking::BreakSpec;
pub use clamp::ClampSpec;
pub use coordinate::{CoordinateSpec, coordinate};
pub use direction::{DirectionSpec, direction};
pub use distance::{DistanceSpec, distance};
pub use driving::{DrivingSpec, RotationSpec, SlideSpec, driving, rotation, slide};
pub use package::{Package, PackageSpec};
pub use prismatic::{
    CylindricalSpec, PointOnLineSpec, PointOnPlaneSpec, PrismaticSpec, cylindrical, point_on_line,
    point_on_plane, prismatic,
};
pub use reeving::{DrumRecordSpec, DrumSpec, SheaveRecordSpec, SheaveSpec};
pub use revolute::{RevoluteSpec, revolute};
pub use spherical::{SphericalSpec, spherical};
pub use universal::{PerpendicularSpec, UniversalSpec, perpendicular, universal};
pub use vessel::VesselSpec;
pub use weld::{WeldSpec, weld};
pub use winch::{EyeletSpec, LiftOffSpec, WinchSpec};

/// What the tests of this crate see of its inside; no part of its interface.
#[doc(hidden)]
pub mod testing {
    pub use crate::motion::function::{best_step, differences};
    pub use crate::reeving::drum::layers::Layers;
    pub use crate::reeving::drum::locked::Locked;
}
