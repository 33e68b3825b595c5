//! Numbers: lanes that compute several elements at once, dual numbers, rotations, interpolation.

pub mod interpolation;
pub mod lane;
pub mod rotation;
pub mod scalar;
