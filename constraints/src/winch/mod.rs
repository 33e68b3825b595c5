//! Winches: ends of cables that feed out and reel in.

mod conditions;
mod drive;
mod eyelet;
mod feeding;
mod lift_off;
mod limit;
mod peel;
mod pull;
mod spec;
mod zone;

pub(crate) use drive::Drive;
pub use eyelet::EyeletSpec;
pub use feeding::Feeding;
pub use lift_off::{LiftOff, LiftOffSpec};
pub use limit::{Limit, Side};
pub use peel::Peel;
pub use pull::Pull;
pub use spec::WinchSpec;
pub(crate) use spec::resisting;
pub use zone::Zone;
