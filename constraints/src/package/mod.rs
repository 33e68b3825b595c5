//! Spool packages: cable wound in layers on a cylinder or against the inside of one, and the point where it lifts off.

mod geometry;
mod spec;
pub use geometry::{Lay, Package};
pub use spec::{Hand, PackageSpec, Side, Traverse};
