//! Elements: what has mass and stiffness.
//!
//! - [`cable`]: ANCF cables, 12 coordinates per element, whose longitudinal and transverse stiffness models are chosen by name;
//! - [`rigid_body`] and [`rigid_chain`]: bodies with an orientation, and hoses of links;
//! - [`PointMass`]: a mass at a marker of something else.
//!
//! Each has a spec, which a scene names and which builds it:
//!
//! ```
//! use ropewalk_elements::{CableSpec, PointMassSpec, Section};
//! use ropewalk_scene::Scene;
//!
//! let rope = Section::new(0.3, 1e5, 0.1); // mass per length [kg/m], EA [N], EI [N m²]
//! let mut scene = Scene::new();
//! scene
//!     .element(CableSpec::straight("line", [0.0; 3], [4.0, 0.0, 0.0], 8, rope))
//!     .element(PointMassSpec::new("bob", "line.end", 2.0));
//! let model = scene.build()?;
//! // nine nodes with position and slope
//! assert_eq!(model.velocities(), 9 * 6);
//! # Ok::<(), ropewalk_scene::SceneError>(())
//! ```

mod attachments;
pub mod cable;
mod path;
mod point_mass;
pub mod rigid_body;
pub mod rigid_chain;

pub use attachments::AttachmentsSpec;
pub use cable::{CableSpec, Section};
pub use path::Path;
pub use point_mass::{Across, PointMass, PointMassSpec};
pub use rigid_body::RigidBodySpec;
pub use rigid_chain::{LinkSection, RigidChainSpec};

/// What the tests of this crate see of its inside; no part of its interface.
#[doc(hidden)]
pub mod testing {
    pub use crate::cable::law::Curve;
    pub use crate::cable::mesh::{even, pinned};
    pub use crate::cable::route::{Side, Stop, lay, lay_closed};
    pub use crate::cable::transmitted::weights;
    pub use crate::cable::unfold::{Between, unfold};
    pub use crate::rigid_chain::lay::filling;
    pub use crate::rigid_chain::spec::orientations;
}
