//! A case: its scenes, its references, and what a run of it says.

use super::builders;
use super::files::{REFERENCES, SCENES};
use super::quantity::{Measured, Quantity};
use crate::error::Error;
use crate::modes::modes_watched;
use crate::simulate::{How, compute};
use ropewalk_report::{Progress, ProgressMode, Stopwatch, Table, Watch};
use ropewalk_scene::{Fault, Format, SceneFile};
use serde::Deserialize;

/// A case as its file of references states it.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Case {
    /// Its name, that of its file.
    #[serde(skip)]
    pub name: &'static str,
    /// What it is about.
    pub title: String,
    /// Where the references come from.
    pub source: String,
    /// The CPU time that it should take at most [s].
    pub suggested_cpu_s: f64,
    #[serde(default)]
    runs: Vec<Run>,
    /// What isn't run, and why.
    #[serde(default)]
    pub left_out: Vec<LeftOut>,
}

/// A scene with values of its parameters, and what is looked at in its results.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Run {
    scene: String,
    /// Parameters, each `name=value`.
    #[serde(default)]
    set: Vec<String>,
    /// What completes the scene that its file doesn't say.
    #[serde(default)]
    completed_by: Option<String>,
    /// So many vibration modes instead of a run.
    #[serde(default)]
    modes: Option<usize>,
    quantities: Vec<Quantity>,
}

/// References that nothing is compared with.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LeftOut {
    /// Which.
    pub quantity: String,
    /// How many.
    pub count: usize,
    /// Why.
    pub reason: String,
}

/// What came out of a case.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The case.
    pub case: Case,
    /// What was compared.
    pub measured: Vec<Measured>,
    /// What couldn't be compared: a run that failed, a result that is missing.
    pub trouble: Vec<String>,
    /// CPU time of all its runs [s].
    pub cpu_s: f64,
    /// Whether Ctrl-C stopped it.
    pub interrupted: bool,
}

/// All cases, by name.
///
/// # Panics
/// Never: the tests read the same files.
pub fn cases() -> Vec<Case> {
    REFERENCES.iter().map(|(name, text)| Case::read(name, text)).map(Case::possible).collect()
}

/// The case of this name.
pub fn case(name: &str) -> Option<Case> {
    cases().into_iter().find(|c| c.name == name)
}

impl Case {
    fn read(name: &'static str, text: &str) -> Self {
        let case: Case = serde_json::from_str(text).unwrap_or_else(|e| panic!("{name}.json: {e}"));
        Case { name, ..case }
    }

    /// Leaves out what this program was built without.
    fn possible(mut self) -> Self {
        if cfg!(not(feature = "contact")) && self.name.starts_with("contact") {
            let reason =
                "needs the cargo feature `contact`, which this program was built without".to_string();
            let count = self.quantities();
            self.left_out.push(LeftOut { quantity: "all".into(), count, reason });
            self.runs.clear();
        }
        self
    }

    /// The scenes that it runs, each with its name and its whole text.
    ///
    /// # Panics
    /// Never: the tests complete the same files.
    pub fn scenes(&self) -> Vec<(&'static str, String)> {
        let of = |&(name, text): &(&'static str, &'static str)| {
            let run = self.runs.iter().find(|r| r.scene == name)?;
            Some((name, run.complete(text).unwrap_or_else(|e| panic!("{name}.toml: {e}"))))
        };
        SCENES.iter().filter_map(of).collect()
    }

    /// How many references are compared with.
    pub fn quantities(&self) -> usize {
        self.runs.iter().map(|r| r.quantities.len()).sum()
    }

    /// Runs its scenes and compares what they say with the references.
    pub fn run(self, progress: ProgressMode, watch: Watch) -> Outcome {
        let stopwatch = Stopwatch::start();
        let (mut measured, mut trouble, mut interrupted) = (Vec::new(), Vec::new(), false);
        for run in &self.runs {
            let results = run.results(progress, watch);
            interrupted = watch.is_interrupted();
            if interrupted {
                break;
            }
            match results {
                Err(e) => trouble.push(format!("{}: {e}", run.label())),
                Ok(results) => {
                    for found in run.quantities.iter().map(|q| q.measure(&results)) {
                        match found {
                            Ok(found) => measured.push(found),
                            Err(e) => trouble.push(format!("{}: {e}", run.label())),
                        }
                    }
                }
            }
        }
        Outcome { cpu_s: stopwatch.elapsed().cpu_s, case: self, measured, trouble, interrupted }
    }
}

impl Run {
    fn label(&self) -> String {
        [std::slice::from_ref(&self.scene), self.set.as_slice()].concat().join(" ")
    }

    /// The text of its scene with what completes it.
    fn complete(&self, text: &str) -> Result<String, String> {
        match &self.completed_by {
            Some(by) => builders::complete(by, text),
            None => Ok(text.to_string()),
        }
    }

    /// The history of its scene, or its modes.
    fn results(&self, progress: ProgressMode, watch: Watch) -> Result<Table, Error> {
        let missing = || Fault::new(format!("there is no scene `{}`", self.scene));
        let (name, text) = SCENES.iter().find(|(name, _)| *name == self.scene).ok_or_else(missing)?;
        let text = self.complete(text).map_err(Fault::new)?;
        let scene = SceneFile::parse(&text, name, Format::Toml, &self.set)?.into_scene();
        if let Some(count) = self.modes {
            return Ok(modes_watched(&scene, count, watch)?.table());
        }
        let progress = Some(Progress::new(0.0, scene.run.duration, progress));
        Ok(compute(&scene, How { watch, progress, ..How::default() })?.complete()?.table)
    }
}

impl Outcome {
    /// The largest error in parts of its tolerance; infinite if something couldn't be compared.
    pub fn worst(&self) -> f64 {
        if !self.trouble.is_empty() {
            return f64::INFINITY;
        }
        self.measured.iter().map(Measured::ratio).fold(0.0, f64::max)
    }

    /// Whether all that it compares is within its tolerance.
    pub fn is_within(&self) -> bool {
        !self.interrupted && self.worst() <= 1.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::verify::{heading, lines, page};

    fn pendulum(change: impl Fn(&str) -> String) -> Outcome {
        let (name, text) = REFERENCES.iter().find(|(name, _)| name.starts_with("inconsistent")).unwrap();
        Case::read(name, &change(text)).run(ProgressMode::Quiet, Watch::default())
    }

    #[test]
    fn a_wrong_reference_is_outside_and_said_so() {
        let right = pendulum(str::to_string);
        assert!(right.is_within(), "{:?}", lines(&right));
        assert!(heading(&right).contains("within"));
        let wrong = pendulum(|text| text.replace("8.8474", "8.9474"));
        assert!(!wrong.is_within() && wrong.worst() > 1e6, "{}", wrong.worst());
        assert!(heading(&wrong).contains("OUTSIDE"));
        assert!(page(&[wrong], "x.svg").contains("**outside**"));
    }

    #[test]
    fn what_fails_is_told_and_the_rest_is_compared() {
        let missing = pendulum(|text| text.replace("\"mass.ax\"", "\"mass.jerk\""));
        assert_eq!((missing.measured.len(), missing.worst()), (3, f64::INFINITY));
        assert!(
            missing.trouble[0].contains("no column `mass.jerk`; there are t, mass.x"),
            "{:?}",
            missing.trouble
        );
        let late = pendulum(|text| text.replacen("{\"at\": 0.0}", "{\"at\": 7.0}", 1));
        assert!(late.trouble[0].contains("there is no sample at 7"), "{:?}", late.trouble);
        let refused =
            pendulum(|text| text.replace("\"quantities\":", "\"set\": [\"no=1\"], \"quantities\":"));
        assert_eq!((refused.measured.len(), refused.trouble.len()), (0, 1));
        assert!(!refused.is_within());
    }

    #[test]
    fn the_files_of_the_folder_are_those_of_the_suite() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/verification");
        let mut there: Vec<String> = std::fs::read_dir(folder)
            .unwrap()
            .map(|f| f.unwrap().file_name().into_string().unwrap())
            .collect();
        there.sort();
        let names = |all: &[(&str, &str)], ending: &str| -> Vec<String> {
            all.iter().map(|(name, _)| format!("{name}.{ending}")).collect()
        };
        let mut known = [names(REFERENCES, "json"), names(SCENES, "toml")].concat();
        known.sort();
        assert_eq!(there, known);
        // and each scene belongs to a case
        let used: Vec<&str> = cases().iter().flat_map(Case::scenes).map(|(name, _)| name).collect();
        assert!(SCENES.iter().all(|(name, _)| used.contains(name) || cfg!(not(feature = "contact"))));
    }

    #[test]
    fn every_scene_that_is_written_can_be_run() {
        for (name, text) in cases().iter().flat_map(Case::scenes) {
            let file =
                SceneFile::parse(&text, name, Format::Toml, &[]).unwrap_or_else(|e| panic!("{name}: {e}"));
            let model = file.build().unwrap_or_else(|e| panic!("{name}: {e}"));
            assert!(model.velocities() > 0 && file.document().unused_parameters().is_empty(), "{name}");
            file.records(&model).unwrap_or_else(|e| panic!("{name}: {e}"));
        }
    }
}
