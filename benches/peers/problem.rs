//! The problems, as the JSON files beside this one state them for both sides.

use ropewalk::core::integrator::{Options, Stepping};
use ropewalk::elements::cable::Integration;
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};
use std::collections::BTreeMap;

/// `pendulum.json`.
#[derive(Deserialize)]
pub struct Pendulum {
    pub title: String,
    pub cable: Cable,
    pub h: f64,
    pub rho_inf: f64,
    /// Of Ropewalk, so that what is left of the iteration doesn't show in the error.
    pub newton_tolerance: f64,
    pub meshes: Vec<Mesh>,
}

/// Length, mass per length, stiffness, gravity along -y; SI units.
#[derive(Deserialize)]
pub struct Cable {
    pub length: f64,
    pub mass: f64,
    pub ea: f64,
    pub ei: f64,
    pub g: f64,
}

#[derive(Deserialize)]
pub struct Mesh {
    pub elements: usize,
    pub steps: usize,
    pub repeats: usize,
    /// By how much the step of the converged run is smaller.
    pub finer: usize,
    pub exudyn: Value,
}

/// `workprec.json`.
#[derive(Deserialize)]
pub struct WorkPrecision {
    pub title: String,
    pub elements: usize,
    pub duration: f64,
    pub tips: BTreeMap<String, [f64; 2]>,
    pub errors: Vec<f64>,
    pub repeats: usize,
    pub exudyn: ExudynCurves,
    pub ropewalk: Vec<Curve>,
}

#[derive(Deserialize)]
pub struct ExudynCurves {
    pub h: Vec<f64>,
    pub rho_inf: f64,
    pub relative_tolerance: f64,
    pub absolute_tolerance: f64,
    pub schemes: Vec<String>,
}

/// Runs that differ by their step or their tolerance.
#[derive(Deserialize)]
pub struct Curve {
    pub label: String,
    /// As in the `solver` section of a scene.
    pub options: Value,
    #[serde(default)]
    pub h: Vec<f64>,
    #[serde(default)]
    pub tolerance: Vec<f64>,
}

impl Curve {
    /// The options of each run.
    pub fn runs(&self) -> Result<Vec<Options>, String> {
        let base = options(&self.options)?;
        let fixed = self.h.iter().map(|&h| Stepping::Fixed { h });
        let controlled = self.tolerance.iter().map(|&tolerance| Stepping::Controlled { tolerance });
        Ok(fixed.chain(controlled).map(|stepping| Options { stepping, ..base.clone() }).collect())
    }
}

/// `tow.json`.
#[derive(Deserialize)]
pub struct Tow {
    pub title: String,
    pub hose: Map<String, Value>,
    pub water: Map<String, Value>,
    pub ramp: f64,
    pub repeats: usize,
    pub steady: Steady,
    pub start: Start,
}

#[derive(Deserialize)]
pub struct Steady {
    pub duration: f64,
    pub interval: f64,
    pub cases: Vec<SteadyCase>,
    pub elements: Vec<usize>,
    pub converged: Converged,
    pub ropewalk: Value,
    pub moordyn: Map<String, Value>,
    pub cabledyn: Map<String, Value>,
}

#[derive(Deserialize)]
pub struct SteadyCase {
    pub speed_kn: f64,
    pub ea: f64,
}

#[derive(Deserialize)]
pub struct Converged {
    pub elements: usize,
    pub tolerance: f64,
}

#[derive(Deserialize)]
pub struct Start {
    pub speed_kn: f64,
    pub end_mass: f64,
    pub duration: f64,
    pub interval: f64,
    pub converged: Converged,
    pub ropewalk: OwnRuns,
    pub moordyn: PeerRuns,
    pub cabledyn: PeerRuns,
}

#[derive(Deserialize)]
pub struct OwnRuns {
    pub options: Value,
    pub runs: Vec<Converged>,
}

#[derive(Deserialize)]
pub struct PeerRuns {
    pub options: Map<String, Value>,
    pub runs: Vec<Map<String, Value>>,
}

/// Reads a problem.
pub fn read<T: DeserializeOwned>(name: &str) -> Result<T, String> {
    let path = format!("{}/benches/peers/{name}", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).map_err(|e| format!("{path}: {e}"))?;
    serde_json::from_str(&text).map_err(|e| format!("{path}: {e}"))
}

/// Options of the solver; what this version doesn't know is an error that says so.
pub fn options(value: &Value) -> Result<Options, String> {
    Options::deserialize(value).map_err(|e| format!("options {value}: {e}"))
}

/// A quadrature rule by its name in scenes.
pub fn integration(name: &str) -> Result<Integration, String> {
    Integration::deserialize(Value::from(name)).map_err(|e| e.to_string())
}
