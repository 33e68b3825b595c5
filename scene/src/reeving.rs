//! What the route of a cable and the constraints that it runs over tell each other while a scene is built.
//!
//! Constraints that guide cables say so first ([`ConstraintSpec::guides`](crate::ConstraintSpec::guides)). A cable with a
//! route looks its guides up, lays its spans between them, and leaves a [`Passage`] at each; the constraint then makes the
//! equations of its passages.

use crate::marker::MarkerRef;
use ropewalk_core::{Marker, MovingBoundary, V3};

/// What a cable can run over, through or onto: a wheel, a ring, or a drum.
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
    /// Whole turns about a wheel besides the angle by which the cable turns there.
    pub turns: f64,
    /// Whether cable ends on it and is wound, as on a drum that pays out as it turns about its axis.
    pub winds: bool,
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
    /// Diameter, 0 if it isn't given [m].
    pub diameter: f64,
    /// Axial damping: force per rate of strain [N s].
    pub damping: f64,
    /// Whether it has weight.
    pub weighs: bool,
    /// Its torsion, if it has any.
    pub torsion: Option<Torsional>,
}

/// The torsion of what runs over a wheel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Torsional {
    /// Torsional stiffness [N m²].
    pub gj: f64,
    /// Damping of twist: moment per rate of twist per length [N m² s].
    pub damping: f64,
    /// Polar moment of inertia per length [kg m].
    pub inertia: f64,
    /// Twist per length when free of stress [rad/m].
    pub free: f64,
    /// Torque by strain of a laid rope [N m].
    pub lay: f64,
}

/// Where a cable goes from one of its spans to the next.
#[derive(Clone, Debug, PartialEq)]
pub struct Passage {
    /// The guide.
    pub guide: String,
    /// The spans before and behind it.
    pub spans: [String; 2],
    /// Whether a drum or a winch is at the start and at the end of the cable.
    pub fed: [bool; 2],
    /// The end of the one and the start of the other.
    pub boundaries: [MovingBoundary; 2],
    /// The centre of the guide.
    pub marker: Marker,
    /// Axis in space at the start, a unit vector about which the cable turns by the right-hand rule.
    pub axis: V3<f64>,
    /// Radius to the middle of the cable [m]; 0 of a ring.
    pub radius: f64,
    /// Angle by which it lies on a wheel at the start [rad].
    pub wrap: f64,
    /// Unstretched length between the spans at the start [m].
    pub stored: f64,
    /// Angle by which its section is turned there about itself at the start, of a cable with torsion [rad].
    pub twist: f64,
    /// What it is made of.
    pub strand: Strand,
}

/// An end of a cable that is wound on a drum.
#[derive(Clone, Debug, PartialEq)]
pub struct Winding {
    /// The drum.
    pub guide: String,
    /// The cable, and the span at this end.
    pub cable: String,
    /// See [`Winding::cable`].
    pub span: String,
    /// The end of the span.
    pub boundary: MovingBoundary,
    /// The middle of the drum.
    pub marker: Marker,
    /// Stretch of the cable at the start.
    pub stretch: f64,
    /// Twist per length with which it is laid, of a cable with torsion [rad/m].
    pub twist: f64,
    /// What it is made of.
    pub strand: Strand,
}
