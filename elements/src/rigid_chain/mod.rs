//! Chains of rigid links: hoses and chains that bend at joints only.
//!
//! Each link is a rigid cylinder with its frame's x axis from its start to its end; spherical joints hold them together.

mod bends;
pub(crate) mod lay;
mod part;
pub(crate) mod spec;

pub use bends::{Bend, Bends};
pub use lay::joints;
pub use part::ChainPart;
pub use spec::{LinkSection, RigidChainSpec, SpoolSpec};
