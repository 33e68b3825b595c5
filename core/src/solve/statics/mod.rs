//! Equilibria: at rest, along a load path, or relative to a frame that moves steadily.
//!
//! Newton's method with the remedies of [`Relaxed`](crate::Relaxed): geometric stiffness from the stress linearised at
//! the iterate before; a floor of tension where the tangent isn't positive; a cap of the stiff modulus at the first
//! iterations. An equilibrium is accepted if it is stable and not folded. Where Newton's method finds none, the model
//! creeps downhill to one, from the guess or from slack lines laid in arcs; along a path of loads it follows the arc through bends and leaves critical points for the
//! stable path behind them.

mod creep;
mod critical;
mod disturbance;
mod flow;
mod follow;
mod guess;
mod leap;
mod linear;
mod mirror;
mod naming;
mod neutral;
mod options;
mod outcome;
mod path;
mod problem;
mod search;
mod stability;
mod tangent;

pub use disturbance::Disturbance;
pub(crate) use linear::Linear;
pub use options::StaticsOptions;
pub use outcome::{Critical, CriticalKind, Found, Neutral, StaticsError};
pub use problem::Statics;

#[cfg(test)]
mod tests;
