//! What is wrong with a sea.

use std::fmt;

/// A number that no sea can have, and what to do about it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SeaError {
    /// The quantity, as a scene calls it.
    pub field: &'static str,
    /// What is wrong with it.
    pub message: String,
}

impl SeaError {
    pub(crate) fn new(field: &'static str, message: impl Into<String>) -> Self {
        SeaError { field, message: message.into() }
    }
}

impl fmt::Display for SeaError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for SeaError {}

/// The number, if it is finite and above zero.
pub(crate) fn positive(field: &'static str, x: f64) -> Result<f64, SeaError> {
    if x.is_finite() && x > 0.0 {
        return Ok(x);
    }
    Err(SeaError::new(field, format!("`{field}` must be above 0, not {x}")))
}

/// The number, if it is finite.
pub(crate) fn finite(field: &'static str, x: f64) -> Result<f64, SeaError> {
    if x.is_finite() {
        return Ok(x);
    }
    Err(SeaError::new(field, format!("`{field}` must be a finite number, not {x}")))
}
