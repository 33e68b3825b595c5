//! Why a force can't be made.

/// A force that can't be made of the given numbers; the message says which one, and what it must be.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct Refused(pub String);

/// `Ok` if `holds`, else a refusal with this message.
pub(crate) fn need(holds: bool, message: impl FnOnce() -> String) -> Result<(), Refused> {
    if holds { Ok(()) } else { Err(Refused(message())) }
}

/// Refuses what is negative or not a finite number.
pub(crate) fn not_negative(name: &str, x: f64) -> Result<(), Refused> {
    need(x.is_finite() && x >= 0.0, || format!("{name} must be a finite number and not negative, not {x}"))
}

/// Refuses what is not finite.
pub(crate) fn finite(name: &str, x: &[f64]) -> Result<(), Refused> {
    need(x.iter().all(|x| x.is_finite()), || format!("{name} must be finite, not {x:?}"))
}
