//! Controllers: what sets the inputs of a scene by what its records show.

mod channels;
mod expression;
mod pid;
mod sampled;
mod table;

pub use channels::{Bound, Channels};
pub use expression::ExpressionSpec;
pub use pid::PidSpec;
pub use table::ControlTableSpec;

use crate::spec::ControllerSpec;
use ropewalk_core::{BuildError, Controller, Model, Record};
use std::sync::Arc;

/// Makes the controllers of a scene for its model; an error tells the number of its spec.
pub(crate) fn build_all(
    specs: &[Arc<dyn ControllerSpec>],
    model: &Model,
    records: Vec<Box<dyn Record>>,
    duration: f64,
) -> Result<Vec<Arc<dyn Controller>>, (usize, BuildError)> {
    let channels = Channels::new(model, records, duration);
    let mut all: Vec<Arc<dyn Controller>> = Vec::with_capacity(specs.len());
    for (k, spec) in specs.iter().enumerate() {
        let controller = spec.build(&channels).map_err(|e| (k, e))?;
        if let Some(other) = all.iter().find(|c| c.input() == controller.input()) {
            let message = format!(
                "the input `{}` is set by another controller already, `{}`",
                spec.input(),
                other.name()
            );
            return Err((k, BuildError::at("input", message)));
        }
        all.push(controller);
    }
    Ok(all)
}
