//! What all controllers of a scene have in common: a name, an input, an interval, and records that they look at.

use super::channels::{Bound, Channels};
use ropewalk_core::{BuildError, Controller, Sample};
use std::sync::Arc;

/// What a controller does at its instants.
pub(super) trait Act: Send + Sync + 'static {
    /// How many numbers it remembers.
    const MEMORY: usize = 0;
    /// The formulas that it looks at.
    fn sees(&self) -> Vec<&Bound>;
    /// As [`Controller::act`].
    fn act(&self, sample: &Sample<'_>, memory: &mut [f64]) -> f64;
}

/// A controller that acts at regular instants.
struct Sampled<A> {
    name: String,
    input: usize,
    every: f64,
    act: A,
}

/// Makes a controller of an input; it is called after that unless it has a name.
///
/// # Errors
/// There is no such input, or the interval is none.
pub(super) fn sampled<A: Act>(
    channels: &Channels<'_>,
    input: &str,
    name: &Option<String>,
    every: f64,
    act: A,
) -> Result<Arc<dyn Controller>, BuildError> {
    let name = name.clone().unwrap_or_else(|| input.to_string());
    Ok(Arc::new(Sampled { name, input: channels.input(input)?.0, every: channels.interval(every)?, act }))
}

impl<A: Act> Controller for Sampled<A> {
    fn name(&self) -> &str {
        &self.name
    }
    fn input(&self) -> usize {
        self.input
    }
    fn every(&self) -> f64 {
        self.every
    }
    fn memory(&self) -> usize {
        A::MEMORY
    }
    fn needs_forces(&self) -> bool {
        self.act.sees().iter().any(|b| b.needs_forces())
    }
    fn act(&self, sample: &Sample<'_>, memory: &mut [f64]) -> f64 {
        self.act.act(sample, memory)
    }
}
