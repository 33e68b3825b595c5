//! What can be varied in any scene at the price of accuracy: mesh, stiffness models, quadrature, scheme, step or
//! tolerance.
//!
//! A value that the scene takes from a parameter is changed by that parameter, so that all that depends on it follows
//! and `--set` gives the same; any other is changed where it stands.

use ropewalk_core::integrator::{Scheme, Stepping, Stopping};
use ropewalk_elements::cable::{CableModel, Integration, LongitudinalModel, TransverseModel, legal};
use ropewalk_scene::{Analysis, Fault, Kind, SceneFile, SceneText, Table, Value, quantity};
use serde::{Deserialize, Serialize};

/// One choice of everything that can be varied; what the scene doesn't have is none.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Settings {
    /// How many times as many elements as the scene has.
    pub mesh: Option<f64>,
    /// The models of all cables.
    pub models: Option<CableModel>,
    /// The scheme.
    pub scheme: Option<Scheme>,
    /// Step or tolerance.
    pub stepping: Option<Stepping>,
    /// Tolerance of Newton's method as a fraction of the default.
    #[serde(default)]
    pub newton: Option<f64>,
}

/// What can be varied in a scene.
pub struct Axes<'a> {
    text: &'a SceneText,
    set: Vec<String>,
    /// Number of elements of each part that has one, by its path.
    meshes: Vec<(String, u64)>,
    /// Lengths at the ends of graded meshes, by their paths [m].
    ends: Vec<(String, f64)>,
    /// The paths of the cables.
    cables: Vec<String>,
    /// The scene as it is.
    file: SceneFile,
    /// Its own settings.
    pub base: Settings,
    /// Duration and output interval of the scene, and the horizon of its error control [s].
    run: [f64; 3],
}

/// Changes of a scene: parameters as `--set` takes them, and values at paths.
#[derive(Default)]
struct Changes {
    set: Vec<String>,
    put: Vec<(String, String)>,
}

/// Where a part says how it is divided: in itself, and in each of its sections along a cable.
fn divided<'v>(path: &str, part: &'v Table) -> Vec<(String, &'v Table)> {
    let mut all = vec![(path.to_string(), part)];
    if let Some(Kind::Array(sections)) = part.get("sections").map(|v| &v.kind) {
        let own = sections.iter().enumerate().filter_map(|(i, v)| Some((i, v.as_table()?)));
        all.extend(own.map(|(i, table)| (format!("{path}.sections[{i}]"), table)));
    }
    all
}

impl<'a> Axes<'a> {
    /// Looks at a scene with these parameters, each `name=value`.
    ///
    /// # Errors
    /// Something is wrong with the scene or the parameters.
    pub fn new(text: &'a SceneText, set: &[String]) -> Result<Self, Fault> {
        let file = text.with(set)?;
        let scene = file.scene();
        let (mut meshes, mut ends, mut cables, mut models) = (Vec::new(), Vec::new(), Vec::new(), None);
        let elements = file.document().get("elements").map(|v| &v.kind);
        if let Some(Kind::Array(list)) = elements {
            for (k, table) in list.iter().enumerate().filter_map(|(k, v)| Some((k, v.as_table()?))) {
                let path = format!("elements[{k}]");
                for (path, table) in divided(&path, table) {
                    let graded = table.get("mesh").and_then(Value::as_table);
                    let counts =
                        [(table.get("elements"), ""), (graded.and_then(|m| m.get("elements")), ".mesh")];
                    for (value, inside) in counts {
                        if let Some(Kind::Integer(n)) = value.map(|v| &v.kind) {
                            meshes.push((format!("{path}{inside}.elements"), u64::try_from(*n).unwrap_or(1)));
                        }
                    }
                    for end in ["first", "last"] {
                        if let Some(l) = graded.and_then(|m| m.get(end)).and_then(length) {
                            ends.push((format!("{path}.mesh.{end}"), l));
                        }
                    }
                }
                if table.get("type").and_then(Value::as_str) == Some("cable") {
                    let own = |name| table.get(name).and_then(Value::as_str);
                    models.get_or_insert(CableModel {
                        longitudinal: named(own("longitudinal")),
                        transverse: named(own("transverse")),
                        integration: named(own("integration")),
                    });
                    cables.push(path);
                }
            }
        }
        let in_time = scene.run.analysis == Analysis::Dynamics && scene.processes.is_empty();
        let base = Settings {
            mesh: (!meshes.is_empty()).then_some(1.0),
            models,
            scheme: in_time.then_some(scene.solver.scheme),
            stepping: in_time.then_some(scene.solver.stepping),
            newton: in_time.then_some(scene.solver.newton_tolerance),
        };
        let horizon = if in_time && scene.solver.horizon == 0.0 { scene.run.duration } else { 0.0 };
        let run = [scene.run.duration, scene.run.interval(), horizon];
        Ok(Axes { text, set: set.to_vec(), meshes, ends, cables, file, base, run })
    }

    /// The scene as it is.
    pub fn file(&self) -> &SceneFile {
        &self.file
    }

    /// Whether there is anything to vary.
    pub fn is_empty(&self) -> bool {
        self.base.mesh.is_none() && self.base.stepping.is_none()
    }

    /// All models of cables that go together and differ, the scene's own first.
    pub(crate) fn models(&self) -> Vec<CableModel> {
        use {LongitudinalModel as L, TransverseModel as T};
        let Some(own) = self.base.models else { return Vec::new() };
        let mut all = vec![own];
        for integration in [Integration::LockingFree, Integration::Full] {
            for longitudinal in [L::L2, L::L4, L::L3, L::L1, L::L1n] {
                for transverse in [T::T1, T::T2, T::T3] {
                    let model = CableModel { longitudinal, transverse, integration };
                    let same = |m: &CableModel| {
                        let pair = (m.longitudinal, m.transverse) == (longitudinal, transverse);
                        pair && (m.integration == integration || closed(m))
                    };
                    if legal(longitudinal, transverse).is_ok() && !all.iter().any(same) {
                        all.push(model);
                    }
                }
            }
        }
        all
    }

    /// The scene's own scheme, and one of the other kind: Radau IIA, or generalized-α.
    pub(crate) fn schemes(&self) -> Vec<Scheme> {
        match self.base.scheme {
            None => Vec::new(),
            Some(Scheme::RadauIia5) => vec![Scheme::RadauIia5, Scheme::default()],
            Some(own) => vec![own, Scheme::RadauIia5],
        }
    }

    /// Steps from coarse to fine, each ten times tighter than the one before: for a fixed step, by a second-order scheme.
    pub(crate) fn level(&self, k: i32) -> Option<Stepping> {
        Some(match self.base.stepping? {
            Stepping::Controlled { .. } => {
                Stepping::Controlled { tolerance: rounded(1e-3 * 0.1_f64.powi(k)) }
            }
            Stepping::Fixed { h } => {
                Stepping::Fixed { h: rounded(4.0 * h * 0.1_f64.powf(0.5 * f64::from(k))) }
            }
        })
    }

    /// Ten times tighter.
    pub(crate) fn tighter(stepping: Stepping) -> Stepping {
        match stepping {
            Stepping::Controlled { tolerance } => {
                Stepping::Controlled { tolerance: rounded(0.1 * tolerance) }
            }
            Stepping::Fixed { h } => Stepping::Fixed { h: rounded(0.1_f64.sqrt() * h) },
        }
    }

    /// The coarsest mesh worth a try: two or three elements for the finest part, halves of the scene's.
    pub(crate) fn coarsest(&self) -> Option<f64> {
        let most = self.meshes.iter().map(|(_, n)| *n).max()?;
        let mut mesh = 1.0;
        while most as f64 * mesh >= 4.0 {
            mesh *= 0.5;
        }
        Some(mesh)
    }

    /// The numbers of elements with these settings.
    pub(crate) fn elements(&self, settings: &Settings) -> Vec<u64> {
        let mesh = settings.mesh.unwrap_or(1.0);
        self.meshes.iter().map(|(_, n)| ((*n as f64 * mesh).round() as u64).max(1)).collect()
    }

    /// The scene with these settings, up to its end or to an earlier time [s].
    ///
    /// # Errors
    /// Settings that the scene refuses.
    pub fn with(&self, settings: &Settings, until: Option<f64>) -> Result<SceneFile, Fault> {
        let mut changes = self.changes(settings);
        if let Some(t) = until.filter(|t| *t < self.run[0]) {
            let mut put = |path: &str, x: f64| changes.put.push((path.into(), format!("{x:?}")));
            put("run.duration", t);
            put("run.output", self.run[1]);
            if self.run[2] > 0.0 {
                // errors are still to be those over the whole run
                put("solver.horizon", self.run[2]);
            }
            changes.put.push(("run.tables".into(), "[]".into()));
        }
        let set: Vec<String> = self.set.iter().chain(&changes.set).cloned().collect();
        self.text.edited(&set, &changes.put)
    }

    /// How a user gets these settings: options of the command, and what to change in the file where there is no
    /// parameter.
    pub fn recipe(&self, settings: &Settings) -> String {
        let changes = self.changes(settings);
        let set = changes.set.iter().map(|s| format!("--set {s}"));
        let put = changes.put.iter().map(|(path, value)| format!("{path} = {value}"));
        let all: Vec<String> = [set.collect::<Vec<_>>().join(" ")].into_iter().chain(put).collect();
        let all: Vec<String> = all.into_iter().filter(|s| !s.is_empty()).collect();
        if all.is_empty() { "the scene as it is".into() } else { all.join("; ") }
    }

    fn changes(&self, settings: &Settings) -> Changes {
        let mut changes = Changes::default();
        let document = self.file.document();
        let there = |path: &str, value: &str| {
            document.find(path).and_then(Value::as_str) == Some(value.trim_matches('"'))
        };
        let mut change = |path: &str, value: String| match document.parameter_at(path) {
            _ if there(path, &value) => {}
            Some(name) => {
                let text = format!("{name}={}", value.trim_matches('"'));
                if !changes.set.contains(&text) {
                    changes.set.push(text);
                }
            }
            None => changes.put.push((path.to_string(), value)),
        };
        if settings.mesh != self.base.mesh {
            for ((path, _), n) in self.meshes.iter().zip(self.elements(settings)) {
                change(path, n.to_string());
            }
            // elements at graded ends become shorter as all others do
            for (path, l) in &self.ends {
                change(path, format!("{:?}", l / settings.mesh.unwrap_or(1.0)));
            }
        }
        if let (Some(models), true) = (settings.models, settings.models != self.base.models) {
            for path in &self.cables {
                change(&format!("{path}.longitudinal"), format!("\"{:?}\"", models.longitudinal));
                change(&format!("{path}.transverse"), format!("\"{:?}\"", models.transverse));
                if !closed(&models) {
                    change(&format!("{path}.integration"), toml(&serde_json::json!(models.integration)));
                }
            }
        }
        if let (Some(scheme), true) = (settings.scheme, settings.scheme != self.base.scheme) {
            change("solver.scheme", toml(&serde_json::json!(scheme)));
        }
        if let (Some(newton), true) = (settings.newton, settings.newton != self.base.newton) {
            change("solver.newton_tolerance", format!("{newton:?}"));
            // which an absolute test doesn't know
            if self.file.scene().solver.stopping != Stopping::Relative {
                change("solver.stopping", toml(&serde_json::json!(Stopping::Relative)));
            }
        }
        if let (Some(stepping), true) = (settings.stepping, settings.stepping != self.base.stepping) {
            let (kind, field, x) = match stepping {
                Stepping::Controlled { tolerance } => ("controlled", "tolerance", tolerance),
                Stepping::Fixed { h } => ("fixed", "h", h),
            };
            let inside = [format!("solver.stepping.{kind}.{field}"), format!("solver.stepping.{field}")];
            match inside.iter().find(|path| document.parameter_at(path).is_some()) {
                Some(path) => change(path, format!("{x:?}")),
                None => change("solver.stepping", format!("{{ {kind} = {{ {field} = {x:?} }} }}")),
            }
        }
        changes
    }

    /// Settings in words: `8 elements L2+T1, tolerance 1e-3, Radau IIA 5`.
    pub fn words(&self, settings: &Settings) -> String {
        let mut words = Vec::new();
        let elements: Vec<String> = self.elements(settings).iter().map(u64::to_string).collect();
        let elements = match elements.as_slice() {
            [] => String::new(),
            [one] if one == "1" => "1 element".into(),
            all => format!("{} elements", all.join("+")),
        };
        let models = settings.models.map(words::models).unwrap_or_default();
        let mesh = [elements, models].into_iter().filter(|s| !s.is_empty()).collect::<Vec<_>>().join(" ");
        words.extend((!mesh.is_empty()).then_some(mesh));
        words.extend(settings.stepping.map(words::step));
        words.extend(settings.scheme.map(words::scheme));
        words.extend((settings.newton != self.base.newton).then(|| "solved to the end".to_string()));
        words.join(", ")
    }
}

/// Whether all parts of the models have closed forms, to which quadrature makes no difference.
fn closed(models: &CableModel) -> bool {
    use LongitudinalModel::{L1, L1n, L2};
    matches!(models.longitudinal, L1 | L1n | L2)
}

/// A length, as a number or as text with a unit.
fn length(value: &Value) -> Option<f64> {
    match &value.kind {
        Kind::Integer(n) => Some(*n as f64),
        Kind::Float(x) => Some(*x),
        _ => quantity::kind::LENGTH.parse(value.as_str()?).ok(),
    }
}

/// Two digits, so that the text of a step is the step.
fn rounded(x: f64) -> f64 {
    format!("{x:.1e}").parse().unwrap_or(x)
}

/// A choice by its name; what the scene leaves out is the default.
fn named<T: Default + serde::de::DeserializeOwned>(name: Option<&str>) -> T {
    name.and_then(|name| serde_json::from_value(name.into()).ok()).unwrap_or_default()
}

/// A value as TOML, on one line.
fn toml(value: &serde_json::Value) -> String {
    match value {
        serde_json::Value::Object(map) => {
            let inside: Vec<String> = map.iter().map(|(k, v)| format!("{k} = {}", toml(v))).collect();
            format!("{{ {} }}", inside.join(", "))
        }
        other => other.to_string(),
    }
}

impl Settings {
    /// The same with another mesh.
    pub(crate) fn meshed(self, mesh: Option<f64>) -> Self {
        Settings { mesh, ..self }
    }
    /// The same with another step or tolerance.
    pub(crate) fn stepped(self, stepping: Option<Stepping>) -> Self {
        Settings { stepping, ..self }
    }
    /// The tolerance, of a step that error control chooses.
    pub(crate) fn tolerance(&self) -> Option<f64> {
        match self.stepping? {
            Stepping::Controlled { tolerance } => Some(tolerance),
            Stepping::Fixed { .. } => None,
        }
    }
    /// How tight the steps are, as a tolerance or a step.
    pub(crate) fn tightness(&self) -> f64 {
        match self.stepping {
            Some(Stepping::Controlled { tolerance }) => tolerance,
            Some(Stepping::Fixed { h }) => h,
            None => 0.0,
        }
    }
}

/// Settings in words.
pub mod words {
    use super::closed;
    use ropewalk_core::integrator::{Scheme, Stepping};
    use ropewalk_elements::cable::{CableModel, Integration};

    /// `L4+T3`, `L4+T3 full`
    pub(crate) fn models(m: CableModel) -> String {
        let full = if m.integration == Integration::Full && !closed(&m) { " full" } else { "" };
        format!("{:?}+{:?}{full}", m.longitudinal, m.transverse)
    }

    /// `tolerance 1e-4`
    pub(crate) fn step(stepping: Stepping) -> String {
        match stepping {
            Stepping::Controlled { tolerance } => format!("tolerance {tolerance:e}"),
            Stepping::Fixed { h } => format!("step {h:e} s"),
        }
    }

    /// `generalized-alpha 0.8`
    pub(crate) fn scheme(scheme: Scheme) -> String {
        match scheme {
            Scheme::RadauIia5 => "Radau IIA 5".into(),
            Scheme::GeneralizedAlpha { rho_inf } => format!("generalized-alpha {rho_inf}"),
            Scheme::Hht { alpha } => format!("HHT {alpha}"),
            other => serde_json::to_string(&other)
                .unwrap_or_default()
                .replace(['"', '{', '}'], " ")
                .trim()
                .to_string(),
        }
    }
}
