//! Ropewalk: forces.
//!
//! Distributed loads are laws on stations (drag, added mass, line loads); what acts at a point or between two points
//! is a term (point forces and moments, springs, bushings, latches).

mod added_mass;
mod buoyancy;
mod bushing;
#[cfg(feature = "contact")]
pub mod contact;
mod drag;
mod drag_coefficient;
mod latch;
mod line_load;
mod moment;
mod point;
mod spec;
mod spring;
mod surface;
mod time;
mod tip;
mod wetted;

pub use added_mass::{AddedMass, Theory};
pub use buoyancy::{Buoyancy, Float};
pub use bushing::{Bushing, BushingSpec, RotationalSpring, RotationalSpringSpec};
pub use drag::{Drag, NormalLaw, PerLength, TangentialLaw, choo_casarella_cn, choo_casarella_ct_over_mu};
pub use drag_coefficient::DragCoefficientSpec;
pub use latch::{Floor, FloorSpec, Latch, LatchSpec, Seat};
pub use line_load::LineLoad;
pub use moment::PointMoment;
pub use point::PointForce;
pub use spec::{
    AddedMassSpec, BuoyancySpec, DragLaw, DragSpec, GravitySpec, LineLoadSpec, PointForceSpec,
    PointMomentSpec, SpringSpec,
};
pub use spring::Spring;
pub use surface::{Surface, Wet};
pub use time::{TimeFunction, TimeTable};
pub use tip::{BluntEnd, EndDrag, FeedingEnd, TipLaw, at_tip};
pub use wetted::Wetted;
