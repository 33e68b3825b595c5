//! `type = "winch"`.

use super::drive::Drive;
use super::{Feeding, Limit, Pull, Side, Zone};
use ropewalk_core::error::{finite, not_negative, positive};
use ropewalk_core::{BuildError, Feed, Model, Motion, Signal};
use ropewalk_scene::quantity::{Setting, kind};
use ropewalk_scene::{Builder, ConstraintSpec, MarkerRef, quantity, register_spec, split_marker};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

fn ramp() -> f64 {
    1.0
}
fn slip_speed() -> f64 {
    1e-3
}
fn fade() -> f64 {
    0.1
}
fn rest() -> f64 {
    f64::INFINITY
}

/// Pays out or reels in cable at one end. Mass, momentum and drag follow the changing length.
///
/// Position that end with another constraint, such as `spherical` or `driving`. Prescribe the payout rate with
/// `speed` or `motion`, or leave it free and give the resistance: `tension`, `brake`, `damping`, `inertia`. With
/// `speed = 0` the winch has no effect.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WinchSpec {
    /// Name; records and events refer to it.
    pub name: String,
    /// The end of the cable: `hose.start` or `hose.end`.
    pub marker: MarkerRef,
    /// Payout rate after the ramp [m/s]; negative reels in. With `final_length` the sign may be left positive. Of an input:
    /// the rate itself, without ramp, so the input needs `join = "linear"`.
    #[serde(
        default,
        deserialize_with = "quantity::setting::optional::speed",
        skip_serializing_if = "Option::is_none"
    )]
    pub speed: Option<Setting>,
    /// Start time [s].
    #[serde(default, deserialize_with = "quantity::time")]
    pub start: f64,
    /// Time in which the speed rises, and falls again at the stop [s].
    #[serde(default = "ramp", deserialize_with = "quantity::time")]
    pub ramp: f64,
    /// Time at which the speed begins to fall again [s]. Default: never.
    #[serde(default, deserialize_with = "quantity::optional::time", skip_serializing_if = "Option::is_none")]
    pub stop: Option<f64>,
    /// Length paid out when it stops [m], with the sign of the speed, instead of `stop`.
    #[serde(
        default,
        deserialize_with = "quantity::optional::length",
        skip_serializing_if = "Option::is_none"
    )]
    pub payout: Option<f64>,
    /// Length of the cable when it stops [m], instead of `stop` and `payout`.
    #[serde(
        default,
        deserialize_with = "quantity::optional::length",
        skip_serializing_if = "Option::is_none"
    )]
    pub final_length: Option<f64>,
    /// Name of a motion whose x component is the payout length, instead of `speed`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub motion: Option<String>,
    /// Constant tension of the winch [N], if the speed isn't prescribed.
    #[serde(
        default,
        deserialize_with = "quantity::setting::optional::force",
        skip_serializing_if = "Option::is_none"
    )]
    pub tension: Option<Setting>,
    /// Dry friction of the brake [N].
    #[serde(default, deserialize_with = "quantity::setting::force")]
    pub brake: Setting,
    /// Slip speed of the brake [m/s]: below it the brake creeps instead of sticking.
    #[serde(default = "slip_speed", deserialize_with = "quantity::speed")]
    pub slip_speed: f64,
    /// Linear damping: tension per payout rate [N s/m].
    #[serde(default, deserialize_with = "quantity::setting::damping")]
    pub damping: Setting,
    /// Tension per speed squared, added to `tension` [kg/m]. Measurements at eyelets often follow this law.
    #[serde(default, deserialize_with = "quantity::setting::mass_per_length")]
    pub per_speed2: Setting,
    /// Name of a motion whose speed along x `per_speed2` refers to. Default: the payout rate here. A tension that
    /// draws the cable and grows with its speed is unstable: then name a motion.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reference_speed: Option<String>,
    /// Moment of inertia of the drum over its radius squared [kg].
    #[serde(default, deserialize_with = "quantity::mass")]
    pub inertia: f64,
    /// Length of a wrap of the coil over whose end the cable is pulled [m]: each brings it a turn of twist, which needs a cable with
    /// torsion (`section.gj`). Negative of coils of the other hand, whose turns are left-handed. Default: it comes off a drum that
    /// turns, untwisted. An end that is held against twisting (`clamp`) keeps the twist in.
    #[serde(
        default,
        deserialize_with = "quantity::optional::length",
        skip_serializing_if = "Option::is_none"
    )]
    pub wrap: Option<f64>,
    /// What keeps a cable with torsion from turning about its own axis as it passes this end: torque over the spin of its material
    /// [N m s]. With much of it a cable that is reeled in takes its twist along; without, it can spin freely, unless the end is
    /// held (`clamp`): then only untwisted cable passes.
    #[serde(default, deserialize_with = "quantity::rotational_damping", skip_serializing_if = "is_nought")]
    pub grip: f64,
    /// Whether the cable comes from a pile at rest instead of a turning drum.
    #[serde(default)]
    pub pile: bool,
    /// Length stored on the spool at the start [m]. The run ends when it is paid out. Default: unlimited.
    #[serde(default = "rest", deserialize_with = "quantity::length", skip_serializing_if = "is_infinite")]
    pub stored_length: f64,
    /// Shortest length of the cable [m]; the run ends there. Default: 5 % of the initial length, at least two
    /// elements.
    #[serde(
        default,
        deserialize_with = "quantity::optional::length",
        skip_serializing_if = "Option::is_none"
    )]
    pub shortest: Option<f64>,
    /// Length of the elements that are added and removed at this end [m]. Default: all elements grow and shrink
    /// together. Smoother; suits length changes up to about tenfold.
    #[serde(
        default,
        deserialize_with = "quantity::optional::length",
        skip_serializing_if = "Option::is_none"
    )]
    pub element_length: Option<f64>,
    /// Fade time [s] of the strain that keeps the tension continuous when an element is added or removed.
    #[serde(default = "fade", deserialize_with = "quantity::time")]
    pub fade: f64,
}
register_spec!(Constraint, "winch", WinchSpec);

/// What resists can't push: an input needs `min = 0` or above.
pub(crate) fn resisting(field: &str, signal: Signal) -> Result<Signal, BuildError> {
    match &signal {
        Signal::Constant(x) => not_negative(field, *x).map(|_| signal),
        Signal::Input(input) if !(input.limits()[0] >= 0.0) => {
            let message =
                format!("`{field}` must not be negative: give the input `{}` a `min` of 0", input.name());
            Err(BuildError::at(field, message))
        }
        Signal::Input(_) => Ok(signal),
    }
}

fn is_nought(x: &f64) -> bool {
    *x == 0.0
}

fn is_infinite(x: &f64) -> bool {
    x.is_infinite()
}

impl WinchSpec {
    /// A winch that feeds out at a speed [m/s]; a negative one reels in.
    pub fn speed(name: &str, marker: impl Into<MarkerRef>, speed: f64) -> Self {
        WinchSpec { speed: Some(speed.into()), ..Self::new(name, marker) }
    }
    /// A winch that feeds by a motion.
    pub fn motion(name: &str, marker: impl Into<MarkerRef>, motion: &str) -> Self {
        WinchSpec { motion: Some(motion.into()), ..Self::new(name, marker) }
    }
    /// A winch that gives way to any tension above this one [N].
    pub fn tension(name: &str, marker: impl Into<MarkerRef>, tension: f64) -> Self {
        WinchSpec { tension: Some(tension.into()), ..Self::new(name, marker) }
    }
    pub(crate) fn new(name: &str, marker: impl Into<MarkerRef>) -> Self {
        WinchSpec {
            name: name.into(),
            marker: marker.into(),
            speed: None,
            start: 0.0,
            ramp: ramp(),
            stop: None,
            payout: None,
            final_length: None,
            motion: None,
            tension: None,
            brake: 0.0.into(),
            slip_speed: slip_speed(),
            damping: 0.0.into(),
            per_speed2: 0.0.into(),
            reference_speed: None,
            inertia: 0.0,
            wrap: None,
            grip: 0.0,
            pile: false,
            stored_length: rest(),
            shortest: None,
            element_length: None,
            fade: fade(),
        }
    }

    /// The motion whose speed the tension goes by.
    fn reference_speed(&self, b: &Builder) -> Result<Option<Arc<dyn Motion>>, BuildError> {
        let Some(name) = &self.reference_speed else { return Ok(None) };
        let motion = b.motion(name).map_err(|e| e.of("reference_speed"))?;
        if motion.range() != (f64::NEG_INFINITY, f64::INFINITY) {
            let message =
                format!("the speed of `{name}` is not defined for ever: take another motion, or longer");
            return Err(BuildError::at("reference_speed", message));
        }
        Ok(Some(motion))
    }

    /// Whether it never feeds.
    fn idle(&self) -> bool {
        self.speed.as_ref().is_some_and(|v| v.is(0.0)) && self.motion.is_none()
    }
}

#[typetag::serde(name = "winch")]
impl ConstraintSpec for WinchSpec {
    fn name(&self) -> &str {
        &self.name
    }
    fn markers(&self) -> Vec<&MarkerRef> {
        vec![&self.marker]
    }
    fn feeds(&self) -> Option<(&MarkerRef, Feed)> {
        // what is wrong with it is said when it is built
        let twist =
            self.wrap.map_or(0.0, |wrap| if wrap == 0.0 { 0.0 } else { std::f64::consts::TAU / wrap });
        (!self.idle()).then(|| {
            (&self.marker, Feed { element: self.element_length, twist, grip: self.grip, ..Feed::default() })
        })
    }
    fn notes(&self, model: &Model) -> Vec<String> {
        let (Some(speed), MarkerRef::Name(marker)) =
            (self.speed.as_ref().and_then(Setting::number).filter(|v| *v != 0.0), &self.marker)
        else {
            return Vec::new();
        };
        let part = split_marker(marker).ok().and_then(|(name, _)| model.part(name));
        let slender = part.and_then(|p| Some((p, p.slender()?))).filter(|(_, s)| s.ei > 0.0);
        let Some((part, slender)) = slender else { return Vec::new() };
        let (element, time) = (slender.element, slender.bending_time());
        let in_or_out = match self.final_length {
            Some(last) if last < part.length() => "in",
            None if speed < 0.0 => "in",
            _ => "out",
        };
        let speed = speed.abs();
        vec![format!(
            "`{}` reels `{}` {in_or_out} at V = {speed} m/s, v = V T / L = {:.4} with T = L² √(ρA/EI) = {time:.4} s \
             and elements of L = {element:.4} m at the start",
            self.name,
            part.name(),
            speed * time / element
        )]
    }
    fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
        let signal = |field, x: &Setting, kind| b.signal(field, x, kind);
        let brake = resisting("brake", signal("brake", &self.brake, &kind::FORCE)?)?;
        let damping = resisting("damping", signal("damping", &self.damping, &kind::DAMPING)?)?;
        not_negative("inertia", self.inertia)?;
        positive("slip_speed", self.slip_speed)?;
        not_negative("grip", self.grip)?;
        if let Some(wrap) = self.wrap {
            positive("wrap", wrap.abs())?;
        }
        let part = b.feeding_part(&self.marker)?;
        let whole = part.length();
        if self.final_length.is_some() && part.name().contains('.') {
            let message =
                "a cable with a route goes on behind the span at this winch: give `payout` or `stop`";
            return Err(BuildError::at("final_length", message));
        }
        if self.idle() {
            // it adds nothing, but what is wrong with it is said all the same
            return self.drive(b, whole).map(drop);
        }
        let boundary = b.boundary(&self.marker, "give this winch something to do")?;
        match self.drive(b, whole)? {
            Drive::Motion(motion) => {
                let start = motion.at(0.0);
                if start.x[0] != 0.0 {
                    let message = format!("the motion has paid out {} m before the run begins", start.x[0]);
                    return Err(BuildError::at("motion", message));
                }
                b.start_feeding(&self.marker, boundary.sign * start.v[0])?;
                b.constraint(Feeding::new(&self.name, boundary, motion))?;
            }
            Drive::Held => {
                let tension = b.signal(
                    "tension",
                    self.tension.as_ref().unwrap_or(&Setting::Number(0.0)),
                    &kind::FORCE,
                )?;
                finite("tension", &[tension.at(0.0)])?;
                let per_speed2 = b.signal("per_speed2", &self.per_speed2, &kind::MASS_PER_LENGTH)?;
                finite("per_speed2", &[per_speed2.at(0.0)])?;
                let reference_speed = self.reference_speed(b)?;
                b.term(Box::new(Pull {
                    name: self.name.clone(),
                    boundary,
                    tension,
                    brake,
                    slip_speed: self.slip_speed,
                    damping,
                    per_speed2,
                    reference: reference_speed,
                    inertia: self.inertia,
                    pile: self.pile,
                }));
            }
        }
        let limit = |side, length| Limit {
            name: self.name.clone(),
            boundary,
            part: part.name().to_string(),
            side,
            length,
        };
        if self.stored_length.is_finite() {
            b.event(limit(Side::Empty, positive("stored_length", self.stored_length)?));
        }
        // an element can't be swallowed by the last one
        let riding: f64 = [0, 1].map(|end| part.line().map_or(0.0, |line| line.riding(end))).iter().sum();
        let kept = part.line().map_or(0.0, |line| line.kept(usize::from(boundary.sign > 0.0)));
        let own = whole - kept;
        if self.element_length.is_some_and(|e| e >= 0.5 * own) {
            let message = format!(
                "{own} m of what is fed are out at the start: take elements of less than half of that"
            );
            return Err(BuildError::at("element_length", message));
        }
        let least = kept + 0.05 * own;
        let least = self.element_length.map_or(least, |e| (kept + riding + 2.0 * e).max(least));
        let shortest = positive("shortest", self.shortest.unwrap_or(least))?;
        if shortest <= kept {
            let message = format!(
                "{kept} m lie behind the section that is fed here, which stay out: `shortest` must be more"
            );
            return Err(BuildError::at("shortest", message));
        }
        if shortest >= whole {
            let message = format!("the cable is {whole} m long at the start, and `shortest` must be less");
            return Err(BuildError::at("shortest", message));
        }
        if let Some(last) = self.final_length.filter(|last| *last <= shortest) {
            let message = format!(
                "the cable would become {last} m long, but the run ends at {shortest} m: give a smaller `shortest`"
            );
            return Err(BuildError::at("final_length", message));
        }
        b.event(limit(Side::Short, shortest));
        if let Some(element) = self.element_length {
            let (element, fade) = (positive("element_length", element)?, positive("fade", self.fade)?);
            if self.shortest.is_some_and(|s| s < riding + 2.0 * element) {
                let besides =
                    if riding > 0.0 { format!(", and {riding} m of graded mesh,") } else { String::new() };
                let message = format!(
                    "elements of {element} m leave no cable shorter than two of them{besides} but `shortest` does"
                );
                return Err(BuildError::at("shortest", message));
            }
            for grows in [true, false] {
                b.event(Zone {
                    winch: self.name.clone(),
                    part: part.name().to_string(),
                    end: usize::from(boundary.sign > 0.0),
                    element,
                    fade,
                    grows,
                });
            }
        }
        Ok(())
    }
}
