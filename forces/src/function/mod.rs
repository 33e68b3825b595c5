//! Forces that a function gives which a program has written, to try laws out. Their derivatives are differences.

mod line;
mod point;

pub use line::FunctionLoad;
pub use point::FunctionForce;

use ropewalk_core::{BuildError, V3};
use ropewalk_scene::functions::{Called, Parameters};
use ropewalk_scene::{Builder, ForceSpec, MarkerRef, register_spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Relative size of a difference: half of the digits.
const HALF: f64 = 1.5e-8;
/// Speeds below this part of that of a free fall over the size of the model are as good as rest.
const SLOW: f64 = 1e-3;

/// How far unknowns are moved for differences.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scales {
    /// Size of the model [m].
    pub length: f64,
    /// Acceleration of gravity, or what else there is [m/s²].
    pub gravity: f64,
}

impl Scales {
    fn of(b: &Builder) -> Self {
        let gravity = b.gravity().iter().map(|g| g * g).sum::<f64>().sqrt();
        Scales { length: b.size(), gravity: if gravity > 0.0 { gravity } else { 1.0 } }
    }
    /// Difference of positions about these [m].
    fn position<'a>(&self, x: impl IntoIterator<Item = &'a V3<f64>>) -> f64 {
        HALF * largest(x).max(self.length)
    }
    /// Difference of velocities about these [m/s].
    fn velocity<'a>(&self, v: impl IntoIterator<Item = &'a V3<f64>>) -> f64 {
        HALF * largest(v).max(SLOW * (self.gravity * self.length).sqrt())
    }
}

fn largest<'a>(x: impl IntoIterator<Item = &'a V3<f64>>) -> f64 {
    x.into_iter().flatten().fold(0.0, |m, x| x.abs().max(m))
}

/// A force that a function gives, which the program that runs the scene has written, such as a script in Python: at a
/// `marker`, or along cables and what else carries distributed loads.
///
/// To try things out: each call takes microseconds, and a step takes tens of calls, since derivatives are differences. What
/// stays deserves a type of its own. All of its work counts as supplied from outside.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FunctionSpec {
    /// Name of the function that was registered; in Python the function itself. `type = "name"` says the same, with its
    /// parameters beside it.
    #[schemars(extend("format" = "function"))]
    pub function: String,
    /// Name, by which records ask for it. Default: that of the function.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// The marker on which it acts. Default: it acts along cables.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub marker: Option<MarkerRef>,
    /// Cables, chains and hulls that it acts along, without a marker. Default: all.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub on: Vec<String>,
    /// What the function is given besides the state, by name. A text that is a number with a unit becomes a number in SI
    /// units.
    #[serde(default, skip_serializing_if = "Parameters::is_empty")]
    pub parameters: Parameters,
}
register_spec!(Force, "function", FunctionSpec);

#[typetag::serde(name = "function")]
impl ForceSpec for FunctionSpec {
    fn markers(&self) -> Vec<&MarkerRef> {
        self.marker.iter().collect()
    }
    fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
        let called = Called::find(&self.function, &self.parameters)?;
        let (name, scales) = (self.name.clone().unwrap_or_else(|| self.function.clone()), Scales::of(b));
        if let Some(marker) = &self.marker {
            if !self.on.is_empty() {
                return Err(BuildError::at("on", "give either `marker` or `on`, not both"));
            }
            let marker = b.marker("marker", marker)?;
            let term = FunctionForce::new(name, b.nodes(), &marker, called, scales)?;
            b.term(Box::new(term));
            return Ok(());
        }
        let mut any = false;
        for (_, part) in b.parts(&self.on)? {
            let stations = part.stations().filter(|s| !s.is_empty());
            if let Some(stations) = stations {
                let label = format!("{}: {name}", part.name());
                b.term(Box::new(FunctionLoad::new(label, stations, called.clone(), scales)?));
                any = true;
            } else if !self.on.is_empty() {
                return Err(BuildError::at("on", format!("`{}` carries no distributed load", part.name())));
            }
        }
        let none = "no part of the scene carries a distributed load: give a `marker` to act on";
        if any { Ok(()) } else { Err(BuildError::at("function", none)) }
    }
}
