//! The spec of a flow.

use super::{Bore, InternalFlow};
use crate::time::TimeFunction;
use ropewalk_core::error::{finite, not_negative, positive};
use ropewalk_core::{BuildError, Hold, Signal};
use ropewalk_scene::quantity::{Setting, kind};
use ropewalk_scene::{Builder, ForceSpec, quantity, register_spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

fn yes() -> bool {
    true
}

/// A fluid that flows through a cable: its mass, its weight, its Coriolis and centrifugal forces, and the thrust where it
/// enters and leaves. A pipe held at both ends buckles where it flows too fast, one with a free outlet flutters.
///
/// The bore is full and keeps its volume however the cable is stretched. Then the tension of the cable is the effective
/// one, that of the wall less the inner pressure times the bore's area (plus the outer pressure times the outer area):
/// pressure and the fluid's friction by themselves move nothing. Damping of the cable isn't part of it, nor is the fluid's
/// mass in `section.mass`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct InternalFlowSpec {
    /// The cable that it flows through. Its length must not change.
    pub cable: String,
    /// Density of the fluid [kg/m³].
    #[serde(deserialize_with = "quantity::density")]
    pub density: f64,
    /// Inner diameter of the unstretched cable [m].
    #[serde(deserialize_with = "quantity::length")]
    pub bore: f64,
    /// Speed relative to the wall, towards the end of the cable [m/s]: the volume flow over the bore's area. Negative: towards
    /// its start. An input needs `join = "smooth"` or `"linear"`, since a flow that jumps would be a blow.
    #[serde(deserialize_with = "quantity::setting::speed")]
    pub speed: Setting,
    /// Factor of the speed as a function of time.
    #[serde(default)]
    pub time: TimeFunction,
    /// Diameter of the nozzle through which it leaves [m]. Default: that of the bore.
    #[serde(
        default,
        deserialize_with = "quantity::optional::length",
        skip_serializing_if = "Option::is_none"
    )]
    pub nozzle: Option<f64>,
    /// Pressure that it meets where it leaves, above that of the surroundings [Pa]; in a closed loop that at the start. Only
    /// the record `wall_tension` asks for it.
    #[serde(default, deserialize_with = "quantity::pressure")]
    pub outlet_pressure: f64,
    /// Darcy's friction factor, about 0.02 in a smooth hose. Only the record `wall_tension` asks for it.
    #[serde(default)]
    pub friction: f64,
    /// Whether the cable's end leads into its start, so that nothing enters or leaves.
    #[serde(default)]
    pub closed: bool,
    /// Whether the fluid has weight, of the scene's `gravity`.
    #[serde(default = "yes")]
    pub weight: bool,
}
register_spec!(Force, "internal_flow", InternalFlowSpec);

#[typetag::serde(name = "internal_flow")]
impl ForceSpec for InternalFlowSpec {
    fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
        positive("density", self.density)?;
        positive("bore", self.bore)?;
        let part = b.parts(std::slice::from_ref(&self.cable)).map_err(|e| e.of("cable"))?.remove(0);
        b.acts_once("internal_flow", &part).map_err(|e| e.of("cable"))?;
        let speed = b.signal("speed", &self.speed, &kind::SPEED)?;
        if let Signal::Input(input) = &speed
            && input.join() == Hold::Hold
        {
            let message = format!(
                "a flow can't jump, as the input `{}` does when it is set: give that `join = \"smooth\"` or \"linear\"",
                input.name()
            );
            return Err(BuildError::at("speed", message));
        }
        if matches!(self.time, TimeFunction::Input(_)) {
            return Err(BuildError::at("time", "let `speed` read the input"));
        }
        self.time.check()?;
        let mass = self.density * PI * self.bore.powi(2) / 4.0;
        let mut flow = InternalFlow::new(part.1.as_ref(), mass, speed).map_err(|e| e.of("cable"))?;
        flow.time = self.time.clone();
        flow.closed = self.closed;
        if let Some(nozzle) = self.nozzle {
            positive("nozzle", nozzle)?;
            if self.closed {
                return Err(BuildError::at(
                    "nozzle",
                    "nothing leaves a closed loop: leave `nozzle` or `closed` out",
                ));
            }
            flow.nozzle = (self.bore / nozzle).powi(2);
        }
        finite("outlet_pressure", &[self.outlet_pressure])?;
        not_negative("friction", self.friction)?;
        let around = b.water().ok().and_then(|water| Some((water.density, water.level?)));
        let g = b.gravity();
        let weight = g.iter().map(|g| g * g).sum::<f64>().sqrt();
        let outer = part.1.tips().first().map_or(0.0, |tip| tip.diameter);
        flow.bore = Some(Bore {
            diameter: self.bore,
            density: self.density,
            friction: self.friction,
            outlet: self.outlet_pressure,
            water: around.map(|(density, level)| [density * weight, level, outer]),
        });
        flow.steady = b.is_statics();
        if self.weight {
            flow.gravity = b.gravity();
        }
        b.term(Box::new(flow));
        Ok(())
    }
}
