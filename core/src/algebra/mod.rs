//! Numbers: lanes that compute several elements at once, dual numbers, rotations, interpolation.

pub mod interpolation;
pub mod lane;
pub(crate) mod noise;
pub mod rotation;
pub mod scalar;
