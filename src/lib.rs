//! Ropewalk: flexible multibody dynamics of cables, hoses and tethers.
pub mod output;
pub mod scene;
pub use ropewalk_core as core;
