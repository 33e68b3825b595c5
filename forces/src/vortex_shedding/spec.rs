//! What a scene says about vortex-induced vibration.

use super::{Fluid, MEMORY, VortexShedding, WakeOscillator};
use crate::buoyancy::surface;
use ropewalk_core::error::{not_negative, positive};
use ropewalk_core::{At, BuildError};
use ropewalk_scene::{Builder, ForceSpec, quantity, register_spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Lift of the vortices that cables, chains and hulls shed in water, as a wake oscillator at each station: vortex-induced vibration
/// across the flow, with lock-in.
///
/// The model and its numbers are those of Facchinetti, de Langre and Biolley (2004), with lift by the flow past the mean way of
/// the line. Damping of the vibration by the water is that of `drag` (the paper has `cn` = 2), its inertia that of `added_mass`. It
/// takes no part in equilibria; wakes begin with a small disturbance that differs from station to station, the same in each run.
/// A step is at most a sixteenth of a period of shedding. A record of type `force` for `LINE: vortex shedding` shows the largest
/// variable of a wake, amplitude and frequency along the line.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct VortexSheddingSpec {
    /// Strouhal number: frequency of shedding times diameter over speed.
    #[serde(default = "strouhal", deserialize_with = "quantity::number")]
    pub strouhal: f64,
    /// Amplitude of the lift coefficient of a cylinder at rest.
    #[serde(default = "lift", deserialize_with = "quantity::number")]
    pub lift: f64,
    /// How strongly acceleration drives the wake, `A` of the paper.
    #[serde(default = "coupling", deserialize_with = "quantity::number")]
    pub coupling: f64,
    /// How fast wakes come to their own amplitude, `ε` of the paper.
    #[serde(default = "epsilon", deserialize_with = "quantity::number")]
    pub epsilon: f64,
    /// Drag coefficient across of the line at rest: strumming adds `2.1 A/D` times it, with the amplitude `A` (Blevins 1990). Default:
    /// drag doesn't grow.
    #[serde(
        default,
        deserialize_with = "quantity::optional::number",
        skip_serializing_if = "Option::is_none"
    )]
    pub strumming: Option<f64>,
    /// Parts it acts on. Default: all that have a diameter along them.
    #[serde(default)]
    pub on: Vec<String>,
}
register_spec!(Force, "vortex_shedding", VortexSheddingSpec);

fn strouhal() -> f64 {
    WakeOscillator::default().strouhal
}
fn lift() -> f64 {
    WakeOscillator::default().lift
}
fn coupling() -> f64 {
    WakeOscillator::default().coupling
}
fn epsilon() -> f64 {
    WakeOscillator::default().epsilon
}

#[typetag::serde(name = "vortex_shedding")]
impl ForceSpec for VortexSheddingSpec {
    fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
        let wake = WakeOscillator {
            strouhal: positive("strouhal", self.strouhal)?,
            epsilon: positive("epsilon", self.epsilon)?,
            coupling: not_negative("coupling", self.coupling)?,
            lift: not_negative("lift", self.lift)?,
        };
        if let Some(cn) = self.strumming {
            not_negative("strumming", cn)?;
        }
        let mut any = false;
        for part in b.parts(&self.on)? {
            let Some(stations) = part.1.stations().filter(|s| !s.is_empty()) else { continue };
            let name = part.1.name().to_string();
            let (q, v) =
                (b.coordinates().to_vec(), vec![0.0; b.nodes().iter().map(|n| n.kind.velocities()).sum()]);
            let at = At { t: 0.0, q: &q, v: &v, a: &v, internal: &[], relaxed: None };
            let (mut count, mut least) = (0, f64::INFINITY);
            stations.each(&at, &mut |s| (count, least) = (count + 1, least.min(s.diameter)));
            if !(least > 0.0) {
                if self.on.is_empty() {
                    continue;
                }
                let message =
                    format!("vortices need a diameter, and `{name}` has none: give its section a `diameter`");
                return Err(BuildError::at("on", message));
            }
            if b.feeding(&name).iter().any(Option::is_some) {
                let message = format!(
                    "wakes belong to places of a line, and `{name}` feeds at an end: name in `on` the lines that don't"
                );
                return Err(BuildError::at("on", message));
            }
            b.acts_once("vortex_shedding", &part)?;
            let water = b.water()?;
            let fluid = Fluid {
                density: water.density,
                current: water.current()?,
                sea: water.sea.clone(),
                surface: surface(b)?,
            };
            let memory = b.memory(&format!("{name}: wake"), MEMORY * count);
            b.term(Box::new(VortexShedding::new(
                &name,
                stations,
                [memory, count],
                fluid,
                wake,
                self.strumming,
            )));
            any = true;
        }
        if any {
            return Ok(());
        }
        let message =
            "vortices are shed by cables, chains and hulls with a diameter, and the scene has none of them";
        Err(BuildError::at("on", message))
    }
}
