//! Checks of what constraints and motions are made of.

use ropewalk_core::error::finite;
use ropewalk_core::{BuildError, V3};

/// A direction of length 1.
pub(crate) fn unit(name: &str, d: V3<f64>) -> Result<V3<f64>, BuildError> {
    finite(name, &d)?;
    let length = d.iter().map(|x| x * x).sum::<f64>().sqrt();
    if !(length > 0.0 && length.is_finite()) {
        let message = format!("`{name}` has no length that can be computed; give any vector along it");
        return Err(BuildError::at(name, message));
    }
    Ok(d.map(|x| x / length))
}
