//! Moving boundaries: ends of parts that material flows through, at winches and eyelets.

use crate::model::node::NodeId;
use crate::model::state::At;

/// What a constraint that feeds asks of a part, before that is built.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Feed {
    /// Length of elements [m] that are born and swallowed at the end while the rest of the part stays on its material.
    /// Left out, all elements of the part grow and shrink together.
    pub element: Option<f64>,
    /// Whether what passes the end is free of strain energy outside, or what it has there is counted by others. Else it is
    /// strained outside as it is inside.
    pub unstrained: bool,
    /// Whether the cable goes on behind the end, round a wheel or through a ring.
    pub passes: bool,
    /// Whether a cable with torsion takes the energy of its twist along as it passes the end, being wound with it.
    pub wound: bool,
    /// Twist with which a cable with torsion comes in, per length [rad/m]: of one that is pulled over the end of a coil a turn
    /// per wrap. Else it comes in untwisted.
    pub twist: f64,
    /// What resists the turning of a cable with torsion about its own axis as it passes the end: torque over the spin of the
    /// material [N m s].
    pub grip: f64,
}

/// An end of a cable that feeds: the material coordinate there is an unknown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MovingBoundary {
    /// The node that carries the material coordinate.
    pub node: NodeId,
    /// Place of the coordinate and of its rate.
    pub q: usize,
    /// See [`MovingBoundary::q`].
    pub v: usize,
    /// -1 at the start of the cable, where feeding out moves the coordinate back, +1 at its end.
    pub sign: f64,
    /// The coordinate at the start of the run [m].
    pub home: f64,
    /// The node of the cable that stands there, and the place of its coordinates.
    pub end: NodeId,
    /// See [`MovingBoundary::end`].
    pub end_q: usize,
    /// See [`MovingBoundary::end`].
    pub end_v: usize,
    /// Mass per unstretched length of what is fed [kg/m].
    pub rho_a: f64,
}

impl MovingBoundary {
    /// Length fed out since the start [m].
    pub fn fed(&self, at: &At<'_>) -> f64 {
        self.sign * (at.q[self.q] - self.home)
    }
    /// Rate at which it is fed out [m/s].
    pub fn rate(&self, at: &At<'_>) -> f64 {
        self.sign * at.v[self.v]
    }
    /// Stretch of the cable where it is fed.
    pub fn stretch(&self, at: &At<'_>) -> f64 {
        at.q[self.end_q + 3..self.end_q + 6].iter().map(|x| x * x).sum::<f64>().sqrt()
    }
}
