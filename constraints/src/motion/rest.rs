//! No motion.

use ropewalk_core::{Motion, Moving, SteadyFrame};

/// Stays where it starts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rest;

impl Motion for Rest {
    fn at(&self, _: f64) -> Moving {
        Moving::default()
    }
    fn reach(&self, _: f64, h: f64) -> Option<f64> {
        Some(h)
    }
    fn steady(&self, _: f64) -> Option<SteadyFrame> {
        Some(SteadyFrame::default())
    }
}
