//! Reeving: cables that run over wheels.
//!
//! A cable with a `route` is several spans whose inner ends feed; a [`SheaveSpec`] joins two of them. The point at which a
//! span meets the wheel is held by a [`Tangent`]; what lies on the wheel is an [`Arc`], an elastic element with mass between the
//! two material coordinates. Nothing is integrated along the wheel and no length is created or lost: what leaves one span
//! is on the wheel or in the next.

mod arc;
mod at_rest;
pub(crate) mod drum;
mod events;
mod flank;
mod flank_spec;
mod fleet;
mod hold;
mod inline;
mod local;
mod piece;
mod record;
mod ring;
mod seat;
mod sheave;
mod spec;
mod tangent;
mod torsion;
mod turns;
mod twist;

pub use arc::{Arc, End, Grip, Instant, Residual, Wheel, direction};
pub use at_rest::Sliding;
pub use drum::{DrumRecordSpec, DrumSpec};
pub use hold::{Hold, Mode};
pub use piece::Piece;
pub use record::SheaveRecordSpec;
pub use ring::RingSpec;
pub use spec::{BearingSpec, SheaveSpec};
pub use tangent::{Tangency, Tangent};
