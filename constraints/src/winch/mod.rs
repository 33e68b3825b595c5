//! Winches: ends of cables that feed out and reel in.

mod feeding;
mod limit;
mod pull;
mod spec;
mod zone;

pub use feeding::Feeding;
pub use limit::{Limit, Side};
pub use pull::Pull;
pub use spec::WinchSpec;
pub use zone::Zone;
