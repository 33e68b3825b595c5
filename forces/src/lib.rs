//! Forces: weight, buoyancy, drag, added mass, loads, springs, latches, contact.
//!
//! ```
//! use ropewalk_core::{Simulation, integrator::Options};
//! use ropewalk_elements::{CableSpec, Section};
//! use ropewalk_forces::GravitySpec;
//! use ropewalk_scene::Scene;
//!
//! let mut scene = Scene::new();
//! scene
//!     .element(CableSpec::straight("line", [0.0; 3], [1.0, 0.0, 0.0], 2, Section::new(0.3, 1e5, 0.1)))
//!     .force(GravitySpec::default());
//! let mut falling = Simulation::new(scene.build()?, &Options::default(), 1.0)?;
//! falling.advance(1.0, f64::INFINITY, &mut ())?;
//! // it falls freely: g t² / 2
//! assert!((falling.state.q[2] + 0.5 * 9.81).abs() < 1e-3);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Distributed loads are laws on stations (drag, added mass, line loads); what acts at a point or between two points
//! is a term (point forces and moments, springs, bushings, latches).

mod added_mass;
mod all_round;
mod buoyancy;
mod bushing;
#[cfg(feature = "contact")]
pub mod contact;
mod drag;
mod drag_coefficient;
mod free_vessel;
mod froude_krylov;
mod function;
mod gauss;
mod gravity;
mod in_water;
mod in_waves;
mod internal_flow;
mod latch;
mod line_load;
mod moment;
mod point;
mod signals;
mod spring;
mod stress;
mod surface;
mod time;
mod tip;
mod vortex_shedding;
mod wall;
mod wetted;

pub use added_mass::{AddedMass, AddedMassSpec, Theory};
pub use all_round::AllRound;
pub use buoyancy::{Buoyancy, BuoyancySpec, Float};
pub use bushing::{Bushing, BushingSpec, RotationalSpring, RotationalSpringSpec};
pub use drag::{
    Drag, DragLaw, DragSpec, NormalLaw, PerLength, TangentialLaw, choo_casarella_cn,
    choo_casarella_ct_over_mu,
};
pub use drag_coefficient::DragCoefficientSpec;
pub use free_vessel::{FreeVessel, FreeVesselSpec, SixBySix, VesselInertia};
pub use froude_krylov::FroudeKrylov;
pub use function::{FunctionForce, FunctionLoad, FunctionSpec, Scales};
pub use gravity::GravitySpec;
pub use in_waves::InWaves;
pub use internal_flow::{Bore, InternalFlow, InternalFlowSpec, WallTensionSpec};
pub use latch::{Floor, FloorSpec, Latch, LatchSpec, Seat};
pub use line_load::{LineLoad, LineLoadSpec};
pub use moment::{PointMoment, PointMomentSpec};
pub use point::{PointForce, PointForceSpec};
pub use spring::{Spring, SpringSpec};
pub use stress::StressSpec;
pub use surface::{Surface, Wet};
pub use time::{TimeFunction, TimeTable};
pub use tip::{BluntEnd, EndDrag, FeedingEnd, TipLaw, at_tip};
pub use vortex_shedding::{VortexShedding, VortexSheddingSpec, WakeOscillator};
pub use wall::{Outside, Wall};
pub use wetted::{Immersed, Wetted};

/// What the tests of this crate see of its inside; no part of its interface.
#[cfg(feature = "contact")]
#[doc(hidden)]
pub mod testing {
    pub use crate::contact::level::below;
}
