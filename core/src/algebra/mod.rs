//! Numbers: lanes that compute several elements at once, dual numbers, gradients, rotations, interpolation.

pub mod gradient;
pub mod interpolation;
pub mod jet;
pub mod lane;
pub(crate) mod noise;
pub mod rotation;
pub mod scalar;
