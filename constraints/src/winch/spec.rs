//! `type = "winch"`.

use super::drive::Drive;
use super::{Feeding, Limit, Pull, Side, Zone};
use ropewalk_core::error::{finite, not_negative, positive};
use ropewalk_core::{BuildError, Feed, Model, Motion};
use ropewalk_scene::{Builder, ConstraintSpec, MarkerRef, quantity, register_spec, split_marker};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

fn ramp() -> f64 {
    1.0
}
fn slip() -> f64 {
    1e-3
}
fn release() -> f64 {
    0.1
}
fn rest() -> f64 {
    f64::INFINITY
}

/// Feeds out and reels in cable at one of its ends: the cable's length changes, with the right mass, momentum and drag.
///
/// Where that end is in space is told by another constraint, such as `spherical` or `driving`. Prescribe the speed by
/// `speed` or by `motion`; or leave the end free and give what holds it back: `tension`, `brake`, `damping`, `inertia`.
/// A winch whose `speed` is 0 is no winch: the cable is as it would be without.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WinchSpec {
    /// Name, by which records and events refer to it.
    pub name: String,
    /// The end of the cable: `hose.start` or `hose.end`.
    pub marker: MarkerRef,
    /// Speed at which it feeds out after the ramp [m/s]; negative reels in. Where `final_length` says which of the two it
    /// is, it may be positive for both.
    #[serde(
        default,
        deserialize_with = "quantity::optional::speed",
        skip_serializing_if = "Option::is_none"
    )]
    pub speed: Option<f64>,
    /// Time at which it starts [s].
    #[serde(default, deserialize_with = "quantity::time")]
    pub start: f64,
    /// Time in which the speed rises, and falls at the stop [s].
    #[serde(default = "ramp", deserialize_with = "quantity::time")]
    pub ramp: f64,
    /// Time at which it begins to slow down again [s]; left out, it goes on.
    #[serde(default, deserialize_with = "quantity::optional::time", skip_serializing_if = "Option::is_none")]
    pub stop: Option<f64>,
    /// Length that it feeds out in all before it stops [m], with the sign of the speed, instead of `stop`.
    #[serde(
        default,
        deserialize_with = "quantity::optional::length",
        skip_serializing_if = "Option::is_none"
    )]
    pub total: Option<f64>,
    /// Length of the cable at which it stops [m], instead of `stop` and `total`.
    #[serde(
        default,
        deserialize_with = "quantity::optional::length",
        skip_serializing_if = "Option::is_none"
    )]
    pub final_length: Option<f64>,
    /// Name of a motion whose x component is the length fed out, instead of `speed`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub motion: Option<String>,
    /// Tension that holds the end back where the speed isn't prescribed [N].
    #[serde(
        default,
        deserialize_with = "quantity::optional::force",
        skip_serializing_if = "Option::is_none"
    )]
    pub tension: Option<f64>,
    /// Dry friction of a brake [N].
    #[serde(default, deserialize_with = "quantity::force")]
    pub brake: f64,
    /// Speed below which the brake creeps instead of sticking [m/s].
    #[serde(default = "slip", deserialize_with = "quantity::speed")]
    pub slip: f64,
    /// Resistance per speed [N s/m].
    #[serde(default, deserialize_with = "quantity::damping")]
    pub damping: f64,
    /// Tension by the square of the speed, besides `tension` [kg/m]: what is measured at an eyelet often goes by it.
    #[serde(default, deserialize_with = "quantity::mass_per_length")]
    pub per_speed2: f64,
    /// Name of a motion along x whose speed `per_speed2` goes by; left out, the speed at which the cable runs here. A
    /// tension that draws, and grows with the speed to which it draws, drives itself: then name the motion that is meant.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pace: Option<String>,
    /// Inertia of the drum over the square of its radius [kg].
    #[serde(default, deserialize_with = "quantity::mass")]
    pub inertia: f64,
    /// Whether cable is picked up from a pile at rest, and not from a drum that turns with it.
    #[serde(default)]
    pub pile: bool,
    /// Length on the spool at the start [m]: once it is fed out, the run ends. Left out, there is always more.
    #[serde(default = "rest", deserialize_with = "quantity::length", skip_serializing_if = "is_infinite")]
    pub stock: f64,
    /// Shortest length that the cable is reeled in to [m], where the run ends; left out, a twentieth of its length at
    /// the start, or two elements.
    #[serde(
        default,
        deserialize_with = "quantity::optional::length",
        skip_serializing_if = "Option::is_none"
    )]
    pub shortest: Option<f64>,
    /// Length of elements [m] that are born and swallowed at this end; left out, all elements of the cable grow and
    /// shrink together, which is smoother and does for a change of length up to ten times or so.
    #[serde(
        default,
        deserialize_with = "quantity::optional::length",
        skip_serializing_if = "Option::is_none"
    )]
    pub element: Option<f64>,
    /// Time in which the strain fades that keeps the tension from jumping when an element is born or swallowed [s].
    #[serde(default = "release", deserialize_with = "quantity::time")]
    pub release: f64,
}
register_spec!(Constraint, "winch", WinchSpec);

fn is_infinite(x: &f64) -> bool {
    x.is_infinite()
}

impl WinchSpec {
    /// A winch that feeds out at a speed [m/s]; a negative one reels in.
    pub fn speed(name: &str, marker: impl Into<MarkerRef>, speed: f64) -> Self {
        WinchSpec { speed: Some(speed), ..Self::new(name, marker) }
    }
    /// A winch that feeds by a motion.
    pub fn motion(name: &str, marker: impl Into<MarkerRef>, motion: &str) -> Self {
        WinchSpec { motion: Some(motion.into()), ..Self::new(name, marker) }
    }
    /// A winch that gives way to any tension above this one [N].
    pub fn tension(name: &str, marker: impl Into<MarkerRef>, tension: f64) -> Self {
        WinchSpec { tension: Some(tension), ..Self::new(name, marker) }
    }
    pub(super) fn new(name: &str, marker: impl Into<MarkerRef>) -> Self {
        WinchSpec {
            name: name.into(),
            marker: marker.into(),
            speed: None,
            start: 0.0,
            ramp: ramp(),
            stop: None,
            total: None,
            final_length: None,
            motion: None,
            tension: None,
            brake: 0.0,
            slip: slip(),
            damping: 0.0,
            per_speed2: 0.0,
            pace: None,
            inertia: 0.0,
            pile: false,
            stock: rest(),
            shortest: None,
            element: None,
            release: release(),
        }
    }

    /// The motion whose speed the tension goes by.
    fn pace(&self, b: &Builder) -> Result<Option<Arc<dyn Motion>>, BuildError> {
        let Some(name) = &self.pace else { return Ok(None) };
        let motion = b.motion(name).map_err(|e| e.of("pace"))?;
        if motion.range() != (f64::NEG_INFINITY, f64::INFINITY) {
            let message =
                format!("the speed of `{name}` is not defined for ever: take another motion, or longer");
            return Err(BuildError::at("pace", message));
        }
        Ok(Some(motion))
    }

    /// Whether it never feeds.
    fn idle(&self) -> bool {
        self.speed == Some(0.0) && self.motion.is_none()
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
        (!self.idle()).then_some((&self.marker, Feed { element: self.element, unstrained: false }))
    }
    fn notes(&self, model: &Model) -> Vec<String> {
        let (Some(speed), MarkerRef::Name(marker)) = (self.speed.filter(|v| *v != 0.0), &self.marker) else {
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
        for (name, x) in [("brake", self.brake), ("damping", self.damping), ("inertia", self.inertia)] {
            not_negative(name, x)?;
        }
        positive("slip", self.slip)?;
        let part = b.feeding_part(&self.marker)?;
        let whole = part.length();
        if self.idle() {
            // it adds nothing, but what is wrong with it is said all the same
            return self.drive(b, whole).map(drop);
        }
        let front = b.front(&self.marker, "give this winch something to do")?;
        match self.drive(b, whole)? {
            Drive::Motion(motion) => {
                let start = motion.at(0.0);
                if start.x[0] != 0.0 {
                    let message = format!("the motion has fed out {} m before the run begins", start.x[0]);
                    return Err(BuildError::at("motion", message));
                }
                b.start_feeding(&self.marker, front.sign * start.v[0])?;
                b.constraint(Feeding::new(&self.name, front, motion))?;
            }
            Drive::Held => {
                let tension = self.tension.unwrap_or(0.0);
                finite("tension", &[tension])?;
                let pace = self.pace(b)?;
                b.term(Box::new(Pull {
                    name: self.name.clone(),
                    front,
                    tension,
                    brake: self.brake,
                    slip: self.slip,
                    damping: self.damping,
                    per_speed2: self.per_speed2,
                    pace,
                    inertia: self.inertia,
                    pile: self.pile,
                }));
            }
        }
        let limit = |side, length| Limit {
            name: self.name.clone(),
            front,
            part: part.name().to_string(),
            side,
            length,
        };
        if self.stock.is_finite() {
            b.event(limit(Side::Empty, positive("stock", self.stock)?));
        }
        if self.element.is_some_and(|e| e >= 0.5 * whole) {
            let message =
                format!("the cable is {whole} m long at the start: take elements of less than half of that");
            return Err(BuildError::at("element", message));
        }
        // an element can't be swallowed by the last one
        let riding: f64 = [0, 1].map(|end| part.line().map_or(0.0, |line| line.riding(end))).iter().sum();
        let least = self.element.map_or(0.05 * whole, |e| (riding + 2.0 * e).max(0.05 * whole));
        let shortest = positive("shortest", self.shortest.unwrap_or(least))?;
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
        if let Some(element) = self.element {
            let (element, release) = (positive("element", element)?, positive("release", self.release)?);
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
                    end: usize::from(front.sign > 0.0),
                    element,
                    release,
                    grows,
                });
            }
        }
        Ok(())
    }
}
