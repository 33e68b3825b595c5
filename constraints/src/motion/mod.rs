//! Motions that drive constraints: what ships and vehicles do.
//!
//! All have two continuous derivatives from rest on, and are at rest at displacement zero before they start (a
//! [`Table`] or [`SpeedTable`] is what its rows say, and only for their time; what spins or swings without a ramp does so
//! from the first moment on).

mod circle;
pub(crate) mod csv;
mod driven;
pub(crate) mod function;
mod harmonic;
mod input;
mod plane;
mod rest;
mod rows;
pub(crate) mod smooth;
mod spec;
mod speed;
mod spin;
mod straight;
mod sum;
mod swing;
mod table;
mod turn;

pub use circle::Circle;
pub use driven::DrivenHarmonic;
pub use function::{FunctionMotion, FunctionMotionSpec};
pub use harmonic::Harmonic;
pub use input::{InputMotionSpec, SpeedInput};
pub use plane::Side;
pub use rest::Rest;
pub use smooth::Shape;
pub use spec::{CircleSpec, HarmonicSpec, RestSpec, StraightSpec, Towards, TurnSpec};
pub use speed::{SpeedTable, SpeedTableSpec};
pub use spin::{Spin, SpinSpec};
pub use straight::Straight;
pub use sum::{Sum, SumSpec};
pub use swing::SwingSpec;
pub use table::{Ends, Table, TableSpec};
pub use turn::{Manoeuvre, Turn};
