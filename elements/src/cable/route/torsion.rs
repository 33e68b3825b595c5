//! Which way the sections of a cable with torsion look behind a wheel or a ring.

use super::Waypoint;
use super::geometry::{Stop, Turn};
use crate::cable::CableSpec;
use crate::cable::twisted::torsional;
use ropewalk_core::model::twist::{carried, section};
use ropewalk_core::rotation::cross;
use ropewalk_core::{BuildError, MovingBoundary, V3, dot};
use ropewalk_scene::{Builder, Torsional};

/// What `1 + t·t'` of the tangents before and behind a ring must not fall below, as of those of an element.
const LEAST_OPEN: f64 = 0.1;

fn unit(x: &V3<f64>) -> V3<f64> {
    let size = dot(x, x).sqrt();
    x.map(|x| x / size)
}

/// From the axis of a wheel to a place, and a unit vector.
fn outwards(centre: &V3<f64>, axis: &V3<f64>, at: &V3<f64>) -> V3<f64> {
    let d: V3<f64> = std::array::from_fn(|i| at[i] - centre[i]);
    let beside = dot(&d, axis);
    unit(&std::array::from_fn(|i| d[i] - beside * axis[i]))
}

/// First director at the start of the span behind a stop, whose direction is this, where the span before ends like that and what
/// lies between is twisted by an angle [rad].
pub(super) fn behind(
    b: &Builder,
    before: &MovingBoundary,
    (stop, turn): (&Stop, &Turn),
    way: &V3<f64>,
    twist: f64,
) -> V3<f64> {
    let own = section(&b.coordinates()[before.end_q..before.end_q + 10]);
    let column = |c: usize| -> V3<f64> { [own[0][c], own[1][c], own[2][c]] };
    let t = unit(way);
    match stop {
        Stop::Point(_) => carried(&column(0), &column(2), &t),
        Stop::Wheel { centre, .. } => {
            let [from, to] = turn.at.map(|at| outwards(centre, &turn.axis, &at));
            // seen from the section, the direction away from the axis turns as the cable is twisted
            let angle = dot(&from, &column(0)).atan2(dot(&from, &column(1))) + twist;
            let (beside, (sin, cos)) = (cross(&to, &t), angle.sin_cos());
            std::array::from_fn(|i| cos * beside[i] + sin * to[i])
        }
    }
}

impl CableSpec {
    /// The torsion of a cable with a route, if it has any.
    pub(super) fn route_torsion(
        &self,
        closed: bool,
        stops: &[Stop],
    ) -> Result<Option<Torsional>, BuildError> {
        let torsion = torsional(&self.section, self.twist)?;
        if closed && torsion.is_some() && self.laid_twist != 0.0 {
            let message = "a closed belt is joined as its way turns its section: leave it out";
            return Err(BuildError::at("laid_twist", message));
        }
        let wound = self.route.iter().any(|w| matches!(w, Waypoint::Wound(_)));
        if wound && torsion.is_some_and(|t| t.lay != 0.0) {
            let message =
                "a rope that turns when it is pulled can't be wound on a drum yet: let it run from a `winch`";
            return Err(BuildError::at("section.torque_tension", message));
        }
        let ring = stops.iter().position(|s| matches!(s, Stop::Point(_)));
        if let Some(k) = ring.filter(|_| closed && torsion.is_some()) {
            let message = "a closed belt with torsion has a twist of its own by its way, which a ring at a point can't hold: let it \
                           run over a `sheave`";
            return Err(BuildError::at(format!("route[{k}]"), message));
        }
        Ok(torsion)
    }

    /// Refuses a ring at this waypoint in which a cable with torsion would double back.
    pub(super) fn check_kink(&self, k: usize, ways: [&V3<f64>; 2]) -> Result<(), BuildError> {
        let [before, behind] = ways.map(unit);
        let Some(Waypoint::Through(ring)) = self.route.get(k) else { return Ok(()) };
        if 1.0 + dot(&before, &behind) >= LEAST_OPEN {
            return Ok(());
        }
        let message = format!(
            "the cable doubles back at `{ring}`, where its twist can't be told: let it run over a `sheave`, or leave `gj` out"
        );
        Err(BuildError::at(format!("route[{k}]"), message))
    }
}
