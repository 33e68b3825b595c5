//! What long records say in few numbers: moments, crossings, cycles of fatigue, extremes.
//!
//! Records are values at equal intervals of time. Nothing here knows where they come from.
//!
//! ```
//! use ropewalk_report::statistics::{Moments, rainflow, total};
//!
//! let record = [-2.0, 1.0, -3.0, 5.0, -1.0, 3.0, -4.0, 4.0, -2.0];
//! assert_eq!(Moments::of(&record).map(|m| m.greatest), Some(5.0));
//! // four cycles, some of which are halves
//! assert_eq!(total(&rainflow(&record)), 4.0);
//! ```

mod extremes;
mod fatigue;
mod moments;
mod rainflow;
mod spectrum;

pub use extremes::{Gumbel, Interval, expected_maximum, most_probable_maximum, quantile_of_maximum};
pub use fatigue::{Life, dirlik, narrow_band};
pub use moments::{Crossings, Moments};
pub use rainflow::{Cycle, damage, equivalent_range, rainflow, total};
pub use spectrum::Spectrum;
