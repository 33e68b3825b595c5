//! What is unwound, through what and how: the data of the problem.

use super::path::Path;
use ropewalk_core::error::{finite, not_negative, positive};
use ropewalk_core::{BuildError, Law, Load, Motion, Station, V3, dot};
use ropewalk_forces::{AddedMass, Drag, TimeFunction};
use std::f64::consts::PI;
use std::sync::Arc;

/// More segments than rounding leaves any fourth derivatives of.
const MOST_SEGMENTS: usize = 20_000;

/// The cable, inextensible.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cable {
    /// Mass per length [kg/m].
    pub mass: f64,
    /// Diameter [m].
    pub diameter: f64,
    /// Bending stiffness [N m²]; 0 for a flexible cable.
    pub ei: f64,
    /// Largest curvature that it bears [1/m]; beyond, the run says so and goes on.
    pub curvature_limit: f64,
}

/// How the cable runs through the eyelet.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Eyelet {
    /// It may turn freely: no moment.
    #[default]
    Hinged,
    /// Along this unit vector, which points from the eyelet towards the package.
    Guided(V3<f64>),
}

/// How the cable leaves the package.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LiftOff {
    /// It may kink: no moment.
    #[default]
    Free,
    /// Tangent to the wound layer: the geometric constraint. Needs bending stiffness.
    Tangent,
}

/// What finds the lift-off point while the cable is drawn through the eyelet at a given speed.
#[derive(Clone, Debug, PartialEq)]
pub enum Rule {
    /// The tension at the eyelet is given: the lift-off point moves as the balloon demands.
    Tension(Pull),
    /// The free length is given, the same all the time: what is drawn at one end is peeled at the other. The tension
    /// is an output.
    Length,
    /// The cable sticks: it peels where `EI |κ - κ_w|²/2` at the lift-off point is this energy per length [J/m], `κ` and
    /// `κ_w` being the curvature vectors of the free and of the wound cable.
    Peel(f64),
}

/// A tension at the eyelet: `rest · f(t) + k V²`.
#[derive(Clone, Debug, PartialEq)]
pub struct Pull {
    /// Tension without speed [N].
    pub rest: f64,
    /// Factor that changes with time.
    pub time: TimeFunction,
    /// Tension per square of the speed [kg/m].
    pub per_speed2: f64,
}

impl Pull {
    /// The same tension at any time and speed.
    pub fn constant(tension: f64) -> Self {
        Pull { rest: tension, time: TimeFunction::default(), per_speed2: 0.0 }
    }
    /// The tension at a time and speed [N].
    pub fn at(&self, t: f64, speed: f64) -> f64 {
        self.rest * self.time.at(t) + self.per_speed2 * speed * speed
    }
}

/// A cable that is drawn from a package through a fixed eyelet.
#[derive(Clone, Debug)]
pub struct Unwinding {
    /// The cable.
    pub cable: Cable,
    /// Where it is wound.
    pub path: Arc<dyn Path>,
    /// Position of the eyelet [m].
    pub eyelet: V3<f64>,
    /// How it runs through the eyelet.
    pub through: Eyelet,
    /// How it leaves the package.
    pub lift_off: LiftOff,
    /// How it is drawn: the x component of the motion is the length drawn through the eyelet.
    pub feed: Arc<dyn Motion>,
    /// What finds the lift-off point.
    pub rule: Rule,
    /// Drag of the water.
    pub drag: Option<Drag>,
    /// Mass of water that the curve moves with it.
    pub added_mass: Option<AddedMass>,
    /// Weight minus buoyancy per length [N/m].
    pub weight: V3<f64>,
    /// Into how many segments the free cable is divided.
    pub elements: usize,
    /// Factor of the Coriolis term: -2. Tests put another, to see that they would notice.
    #[doc(hidden)]
    pub coriolis: f64,
}

impl Unwinding {
    /// A flexible cable without drag and weight.
    pub fn new(
        cable: Cable,
        path: Arc<dyn Path>,
        feed: Arc<dyn Motion>,
        rule: Rule,
        segments: usize,
    ) -> Self {
        Unwinding {
            cable,
            path,
            eyelet: [0.0; 3],
            through: Eyelet::Hinged,
            lift_off: LiftOff::Free,
            feed,
            rule,
            drag: None,
            added_mass: None,
            weight: [0.0; 3],
            elements: segments,
            coriolis: -2.0,
        }
    }

    /// Whether its numbers make sense.
    ///
    /// # Errors
    /// Numbers out of range; a tangent lift-off or a peel law without bending stiffness; too few segments.
    pub fn check(&self) -> Result<(), BuildError> {
        positive("mass", self.cable.mass)?;
        positive("diameter", self.cable.diameter)?;
        not_negative("ei", self.cable.ei)?;
        finite("eyelet", &self.eyelet)?;
        finite("weight", &self.weight)?;
        if !(self.cable.curvature_limit > 0.0) {
            return Err(BuildError::at("curvature_limit", "`curvature_limit` must be positive"));
        }
        if self.elements < 6 {
            let message =
                format!("{} segments are too few for fourth derivatives: give 6 at least", self.elements);
            return Err(BuildError::at("elements", message));
        }
        if self.elements > MOST_SEGMENTS {
            let message =
                format!("{} segments are more than the {MOST_SEGMENTS} there may be", self.elements);
            return Err(BuildError::at("elements", message));
        }
        if let Eyelet::Guided(d) = self.through
            && !((dot(&d, &d) - 1.0).abs() < 1e-9)
        {
            return Err(BuildError::at("through", "the direction of a guided eyelet must be a unit vector"));
        }
        let stiff = self.cable.ei > 0.0;
        if self.lift_off == LiftOff::Tangent && !stiff {
            let message = "a cable without bending stiffness can't be held tangent to the package: give `ei`, \
                           or leave the lift-off free";
            return Err(BuildError::at("lift_off", message));
        }
        if let Rule::Peel(energy) = self.rule {
            positive("peel", energy)?;
            if !(stiff && self.lift_off == LiftOff::Tangent) {
                let message = "peeling needs bending stiffness and a tangent lift-off";
                return Err(BuildError::at("peel", message));
            }
        }
        self.drag.as_ref().map_or(Ok(()), Drag::check)
    }

    /// Speed at which the cable is drawn, and its rate.
    pub fn speed(&self, t: f64) -> [f64; 2] {
        let m = self.feed.at(t);
        [m.v[0], m.a[0]]
    }

    /// Load per length at a point of the cable: weight, buoyancy, drag, with derivatives.
    pub(super) fn load(&self, t: f64, at: &Station<f64>) -> Load<f64> {
        let mut load = Load::zero();
        load.f = self.weight;
        if let Some(drag) = &self.drag {
            drag.load::<f64, true>(t, at, &mut load);
        }
        load
    }

    /// A point of the cable as distributed loads see it.
    pub(super) fn station(&self, x: V3<f64>, v: V3<f64>, slope: V3<f64>) -> Station<f64> {
        let d = self.cable.diameter;
        let area = PI / 4.0 * d * d;
        Station {
            x,
            v,
            a: [0.0; 3],
            slope,
            slope_rate: [0.0; 3],
            s: 0.0,
            weight: 1.0,
            before: 0.5,
            element: 0.0,
            diameter: d,
            area,
            who: 0,
        }
    }
}
