//! What drives a winch: its speed, a motion, or whatever pulls against what holds it back.

use super::WinchSpec;
use crate::motion::{SpeedInput, Straight};
use ropewalk_core::error::positive;
use ropewalk_core::{BuildError, Motion, Moving, Signal};
use ropewalk_scene::Builder;
use ropewalk_scene::quantity::{Setting, kind};
use std::sync::Arc;

/// What moves cable through an end.
pub(crate) enum Drive {
    /// The payout length follows a motion.
    Motion(Arc<dyn Motion>),
    /// The tension of the cable, against what holds it back.
    Held,
}

/// A speed that rises, and falls again later.
#[derive(Clone, Debug)]
struct Haul {
    rise: Straight,
    fall: Option<Straight>,
}

impl Motion for Haul {
    fn at(&self, t: f64) -> Moving {
        let mut x = self.rise.at(t);
        if let Some(fall) = &self.fall {
            let less = fall.at(t);
            (x.x[0], x.v[0], x.a[0]) = (x.x[0] - less.x[0], x.v[0] - less.v[0], x.a[0] - less.a[0]);
        }
        x
    }
    fn reach(&self, t: f64, h: f64) -> Option<f64> {
        [Some(&self.rise), self.fall.as_ref()].into_iter().flatten().try_fold(h, |h, m| m.reach(t, h))
    }
}

impl WinchSpec {
    /// The speed with its sign, and when it begins to fall, of a cable of this length.
    fn course(&self, speed: f64, whole: f64) -> Result<(f64, Option<f64>), BuildError> {
        if speed == 0.0 {
            return Ok((speed, None));
        }
        let total = match (self.stop, self.payout, self.final_length) {
            (None, None, None) => return Ok((speed, None)),
            (Some(stop), None, None) if stop < self.start + self.ramp => {
                let message = format!("it would stop at {stop} s, before its speed has risen");
                return Err(BuildError::at("stop", message));
            }
            (Some(stop), None, None) => return Ok((speed, Some(stop))),
            (None, Some(total), None) => total,
            (None, None, Some(last)) => positive("final_length", last)? - whole,
            (Some(_), ..) => {
                let field = if self.payout.is_some() { "payout" } else { "final_length" };
                let message = format!("give `stop` or `{field}`, not both: one follows from the other");
                return Err(BuildError::at(field, message));
            }
            _ => {
                let message = "give `payout` or `final_length`, not both: one follows from the other";
                return Err(BuildError::at("final_length", message));
            }
        };
        let field = if self.payout.is_some() { "payout" } else { "final_length" };
        // a length tells the direction as well
        let speed = if self.final_length.is_some() && speed > 0.0 { speed.copysign(total) } else { speed };
        let time = total / speed;
        if !(time > 0.0 && time.is_finite()) {
            let message = match self.final_length {
                Some(last) if total == 0.0 => format!("the cable is {last} m long already"),
                Some(last) => format!("a cable of {whole} m can't be reeled in to {last} m"),
                None => format!("at {speed} m/s it never pays out {total} m: their signs must be the same"),
            };
            return Err(BuildError::at(field, message));
        }
        if time < self.ramp {
            let message = format!(
                "{} m are over before the speed has risen to {} m/s: take a `ramp` of at most {} s, or less speed",
                total.abs(),
                speed.abs(),
                time
            );
            return Err(BuildError::at(field, message));
        }
        Ok((speed, Some(self.start + time)))
    }

    /// What drives it, on a cable of this length.
    ///
    /// # Errors
    /// Nothing does, or too much; a course that can't be run.
    pub(crate) fn drive(&self, b: &Builder, whole: f64) -> Result<Drive, BuildError> {
        let free =
            self.tension.is_some() || !self.brake.is(0.0) || !self.damping.is(0.0) || self.inertia != 0.0;
        match (&self.speed, &self.motion) {
            (Some(_), Some(_)) => Err(BuildError::at("motion", "give `speed` or `motion`, not both")),
            (Some(_), None) | (None, Some(_)) if free || self.pile => Err(BuildError::at(
                if self.tension.is_some() { "tension" } else { "brake" },
                "the speed of this winch is prescribed, so its tension is a result: leave out `tension`, `brake`, \
                 `damping`, `inertia` and `pile`, or the speed. A cable that also runs at its other end can have the \
                 tension here and the speed there, as in the scene `unwinding`",
            )),
            (Some(Setting::Input(_)), None) => {
                let ends = [
                    ("stop", self.stop.is_some()),
                    ("payout", self.payout.is_some()),
                    ("final_length", self.final_length.is_some()),
                ];
                if let Some((field, _)) = ends.iter().find(|(_, given)| *given) {
                    let message = format!(
                        "`{field}` says when a given speed ends; this one is what its input is set to"
                    );
                    return Err(BuildError::at(*field, message));
                }
                if self.start != 0.0 {
                    let message =
                        "a speed that is read from an input has no start: leave the input at 0 until then";
                    return Err(BuildError::at("start", message));
                }
                let speed = self.speed.as_ref().unwrap_or(&Setting::Number(0.0));
                match b.signal("speed", speed, &kind::SPEED)? {
                    Signal::Input(input) => {
                        Ok(Drive::Motion(Arc::new(SpeedInput::new([1.0, 0.0, 0.0], input)?)))
                    }
                    Signal::Constant(_) => Err(BuildError::at("speed", "it has no input")),
                }
            }
            (&Some(Setting::Number(speed)), None) => {
                let ahead = [1.0, 0.0, 0.0];
                // says what is wrong with speed, start and ramp first
                Straight::new(ahead, speed, self.start, self.ramp)?;
                let (speed, stop) = self.course(speed, whole)?;
                let rise = Straight::new(ahead, speed, self.start, self.ramp)?;
                let fall = stop.map(|stop| Straight::new(ahead, speed, stop, self.ramp)).transpose()?;
                Ok(Drive::Motion(Arc::new(Haul { rise, fall })))
            }
            (None, _) if [self.stop, self.payout, self.final_length].iter().any(Option::is_some) => {
                let field = match (self.stop, self.payout) {
                    (Some(_), _) => "stop",
                    (None, Some(_)) => "payout",
                    (None, None) => "final_length",
                };
                let message = format!("`{field}` says when a `speed` ends, and this winch has none");
                Err(BuildError::at(field, message))
            }
            (None, Some(motion)) => b.motion(motion).map(Drive::Motion),
            (None, None) if free => Ok(Drive::Held),
            (None, None) => Err(BuildError::at(
                "name",
                "a winch needs `speed` or `motion`, or a resistance: `tension`, `brake`, `damping` or `inertia`",
            )),
        }
    }
}
