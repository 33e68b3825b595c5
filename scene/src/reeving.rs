//! What the route of a cable and the constraints that it runs over tell each other while a scene is built.
//!
//! Constraints that guide cables say so first ([`ConstraintSpec::guides`](crate::ConstraintSpec::guides)). A cable with a
//! route looks its guides up, lays its spans between them, and leaves a [`Passage`] at each; the constraint then makes the
//! equations of its passages.

use crate::marker::MarkerRef;
use ropewalk_core::{Marker, MovingBoundary, V3};

/// What a cable can run over or through: a wheel, or a ring.
#[derive(Clone, Debug, PartialEq)]
pub struct Guide {
    /// Name by which a route asks for it.
    pub name: String,
    /// Its centre.
    pub marker: MarkerRef,
    /// How far it stands beside that along its axis [m].
    pub beside: f64,
    /// Axis of a wheel in space at the start, of any length.
    pub axis: V3<f64>,
    /// Radius of a wheel to the middle of the cable [m]; 0 of a ring.
    pub radius: f64,
}

/// What runs over a wheel, per unstretched length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Strand {
    /// Mass [kg/m].
    pub mass: f64,
    /// Axial stiffness [N].
    pub ea: f64,
    /// Bending stiffness [N m²].
    pub ei: f64,
    /// Axial damping: force per rate of strain [N s].
    pub damping: f64,
    /// Whether it has weight.
    pub weighs: bool,
}

/// Where a cable goes from one of its spans to the next.
#[derive(Clone, Debug, PartialEq)]
pub struct Passage {
    /// The guide.
    pub guide: String,
    /// The spans before and behind it.
    pub spans: [String; 2],
    /// The end of the one and the start of the other.
    pub boundaries: [MovingBoundary; 2],
    /// The centre of the guide.
    pub marker: Marker,
    /// Axis in space at the start, a unit vector about which the cable turns by the right-hand rule.
    pub axis: V3<f64>,
    /// Radius to the middle of the cable [m]; 0 of a ring.
    pub radius: f64,
    /// Unstretched length between the spans at the start [m].
    pub stored: f64,
    /// What it is made of.
    pub strand: Strand,
}
