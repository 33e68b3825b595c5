//! The records that come with Ropewalk: motion of a point and turning of a body, tension and the like along a cable, its length,
//! reaction of a constraint and how well it follows its motion, force of a contact or spring, where a line comes to lie, what has let go, inputs, momentum
//! and balance of energy.
//!
//! A record only looks: it never puts a node anywhere, so a scene moves in the same way with and without it.

mod along;
mod direction;
mod driving;
mod energy;
mod force;
mod input;
mod length;
mod momentum;
mod motion;
mod payout;
mod place;
mod reaction;
mod released;
mod touchdown;
mod turning;

pub use along::AlongSpec;
pub use direction::{DirectionSpec, tangent};
pub use driving::DrivingCheckSpec;
pub use energy::EnergySpec;
pub use force::ForceRecordSpec;
pub use input::InputRecordSpec;
pub use length::LengthSpec;
pub use momentum::MomentumSpec;
pub use motion::{AccelerationSpec, PositionSpec, VelocitySpec};
pub use payout::PayoutSpec;
pub use place::{SpaceAxis, Station as RecordPlace, check_places, off, part};
pub use reaction::{ReactionPart, ReactionSpec};
pub use released::ReleasedSpec;
pub use touchdown::TouchdownSpec;
pub use turning::{AngularVelocitySpec, OrientationSpec, SeenFrom};

/// `` `a`, `b` ``, or what is said instead if there is nothing.
fn listed<'a>(names: impl Iterator<Item = &'a str>, none: &str) -> String {
    let names: Vec<String> = names.map(|n| format!("`{n}`")).collect();
    if names.is_empty() { none.to_string() } else { names.join(", ") }
}

/// The name that a record was given, or the one that it has otherwise.
pub fn named(given: &Option<String>, otherwise: impl FnOnce() -> String) -> String {
    given.as_ref().map(|n| n.trim().to_string()).filter(|n| !n.is_empty()).unwrap_or_else(otherwise)
}

#[cfg(test)]
mod tests;
