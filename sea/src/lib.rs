//! Waves of the sea: linear (Airy) waves in water of any depth, one or many.
//!
//! - [`wavenumber`]: how long waves of a frequency are;
//! - [`Spectrum`] and [`Sampling`]: sea states as sums of regular waves, the same on every machine for the same seed;
//! - [`Waves`]: elevation, velocity, acceleration and their gradients at a place and a time, as sums over all waves;
//! - [`Lattice`]: the same from a table that is filled where it is looked at, for many waves at once;
//! - [`Responses`] and [`VesselResponse`]: the motions of a vessel by response amplitudes.
//!
//! Axes: `z` upwards, still water at `z = 0`, the bed at `-depth`. Directions are those that waves travel towards, in
//! radians from `x` to `y`. All units are SI.
//!
//! ```
//! use ropewalk_sea::{Regular, Stretching, Waves};
//!
//! // a wave 2 m high of 8 s, in water 30 m deep
//! let wave = Regular { amplitude: 1.0, omega: std::f64::consts::TAU / 8.0, phase: 0.0, direction: 0.0 };
//! let waves = Waves::new(&[wave], 30.0, 9.81, Stretching::Wheeler)?;
//! // its crest is at the origin, and water there moves ahead
//! let flow = waves.at([0.0, 0.0, -2.0], 0.0);
//! assert!((flow.elevation - 1.0).abs() < 1e-12 && flow.velocity[0] > 0.5);
//! # Ok::<(), ropewalk_sea::SeaError>(())
//! ```

mod axes;
mod dispersion;
mod error;
mod lattice;
mod measured;
mod motion;
mod random;
mod response;
mod sampling;
mod spectrum;
mod waves;

pub use axes::{Axes, plus_product, transposed_times};
pub use dispersion::{group_velocity, wavenumber, wavenumber_on_current};
pub use error::SeaError;
pub use lattice::{Instant, Lattice, Stations};
pub use measured::measured;
pub use motion::{Motion, Top};
pub use random::SplitMix64;
pub use response::{MOTIONS, Responses, VesselResponse};
pub use sampling::{Sampling, Spreading, sample};
pub use spectrum::Spectrum;
pub use waves::{Flow, Regular, Stretching, Waves};
