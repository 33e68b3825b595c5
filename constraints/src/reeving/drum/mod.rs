//! Drums: ends of cables that are wound.
//!
//! What is free begins at the tangent point, and goes over into what is wound without slip ([`winding`]). The angle of the
//! drum is prescribed, or an unknown that a motor, a brake and the cable turn ([`shaft`]). The cable lies on it in a helix,
//! in one layer or several ([`layers`]), and keeps the stretch with which it was wound ([`locked`]).

mod events;
pub(crate) mod layers;
pub(crate) mod locked;
mod record;
mod shaft;
mod spec;
mod torsion;
mod winding;

pub use record::DrumRecordSpec;
pub use spec::DrumSpec;
