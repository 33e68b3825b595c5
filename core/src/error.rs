//! Why a model could not be built, and the checks of numbers that say so.

/// Why a model could not be built, said so that the author of the scene knows what to change.
///
/// ```
/// use ropewalk_core::BuildError;
/// let e = BuildError::at("mass", "`mass` must be positive, but is -1");
/// assert_eq!((e.field.as_deref(), e.to_string()), (Some("mass"), "`mass` must be positive, but is -1".to_string()));
/// ```
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{message}")]
pub struct BuildError {
    /// What is wrong and what to do.
    pub message: String,
    /// The field of the spec that is to blame, so that a message can point at its line; a name that is no field of
    /// the spec points at the spec as a whole. Of errors of the whole model: the name of a constraint, or a path such
    /// as `water.density`.
    pub field: Option<String>,
}

impl BuildError {
    /// An error of the part as a whole.
    pub fn new(message: impl Into<String>) -> Self {
        BuildError { message: message.into(), field: None }
    }
    /// An error of one field.
    pub fn at(field: impl Into<String>, message: impl Into<String>) -> Self {
        BuildError { message: message.into(), field: Some(field.into()) }
    }
    /// The same error, put down to another field: that of the spec which the number came from.
    #[must_use]
    pub fn of(self, field: impl Into<String>) -> Self {
        BuildError { field: Some(field.into()), ..self }
    }
}

/// Checks that a number is positive and finite.
///
/// ```
/// use ropewalk_core::error::positive;
/// assert!(positive("mass", 2.0).is_ok() && positive("mass", f64::NAN).is_err());
/// ```
pub fn positive(field: &str, x: f64) -> Result<f64, BuildError> {
    if x > 0.0 && x.is_finite() {
        Ok(x)
    } else {
        Err(BuildError::at(field, format!("`{field}` must be positive, but is {x}")))
    }
}

/// Checks that a number is finite and not negative.
pub fn not_negative(field: &str, x: f64) -> Result<f64, BuildError> {
    if x >= 0.0 && x.is_finite() {
        Ok(x)
    } else {
        Err(BuildError::at(field, format!("`{field}` must not be negative, but is {x}")))
    }
}

/// Checks that every number is finite.
///
/// ```
/// use ropewalk_core::error::finite;
/// assert!(finite("axis", &[1.0, 0.0]).is_ok() && finite("axis", &[f64::INFINITY]).is_err());
/// ```
pub fn finite(field: &str, x: &[f64]) -> Result<(), BuildError> {
    match x.iter().find(|x| !x.is_finite()) {
        None => Ok(()),
        Some(x) => Err(BuildError::at(field, format!("`{field}` holds {x}, which is not a finite number"))),
    }
}

/// `Ok` if `holds`, else an error with this message.
pub fn need(holds: bool, message: impl FnOnce() -> String) -> Result<(), BuildError> {
    if holds { Ok(()) } else { Err(BuildError::new(message())) }
}
