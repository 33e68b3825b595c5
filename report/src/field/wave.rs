//! The waves of a run, for a surface that moves.

/// A regular wave: `η = a cos(k·x - ω t + φ)` over still water.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wave {
    /// Amplitude `a` [m].
    pub amplitude: f64,
    /// Wavenumber `k` along x and y [1/m].
    pub k: [f64; 2],
    /// Angular frequency `ω` [rad/s].
    pub omega: f64,
    /// Phase `φ` at the origin at `t = 0` [rad]: 0 is a crest.
    pub phase: f64,
}

/// All waves of a sea: their sum is the elevation of its surface.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Waves {
    /// One by one.
    pub all: Vec<Wave>,
    /// Time in which they rise from still water, as `(1 - cos πt/ramp)/2` [s].
    pub ramp: f64,
}
