//! What makes a sweep the same as another.

use crate::study::{Study, shortened};
use ropewalk_report::plain;
use serde::{Deserialize, Serialize};

/// What a sweep is, as `sweep.json` holds it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct SweepManifest {
    /// Version of Ropewalk.
    pub ropewalk: String,
    /// Number of combinations.
    pub runs: usize,
    /// Parameters that all runs have, each `name=value`.
    pub set: Vec<String>,
    /// Parameters that vary, the last one fastest.
    pub vary: Vec<VariedCopy>,
    /// How some of them were drawn; these change together, faster than the others.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub samples: Option<Samples>,
    /// The scenes, as they were.
    pub scenes: Vec<SceneCopy>,
}

/// Values that were drawn from ranges.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Samples {
    /// Number of samples.
    pub count: usize,
    pub seed: u64,
    /// Whether they are a Latin hypercube.
    pub latin: bool,
    /// Names of the parameters.
    pub of: Vec<String>,
}

/// A parameter that varies.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct VariedCopy {
    pub name: String,
    pub values: Vec<String>,
}

/// A scene with its text.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct SceneCopy {
    pub name: String,
    pub text: String,
}

impl Study for SweepManifest {
    const KIND: &'static str = "sweep";
    fn name(&self) -> String {
        self.scenes.iter().map(|s| plain(&s.name)).collect::<Vec<_>>().join("+")
    }
    fn difference(&self, there: &Self) -> Option<String> {
        let names = |m: &Self| m.scenes.iter().map(|s| s.name.clone()).collect::<Vec<_>>().join(" and ");
        let varied = |m: &Self| {
            m.vary.iter().map(|v| format!("{}={}", v.name, v.values.join(","))).collect::<Vec<_>>().join(" ")
        };
        if names(self) != names(there) {
            Some(format!("of {}", names(there)))
        } else if self.scenes != there.scenes {
            Some(format!("of {} before the scene was changed", names(there)))
        } else if self.samples != there.samples {
            Some(match &there.samples {
                Some(s) => {
                    let kind = if s.latin { " of a Latin hypercube" } else { "" };
                    format!("of {} samples{kind} of {} with the seed {}", s.count, s.of.join(" and "), s.seed)
                }
                None => "without samples".into(),
            })
        } else if self.vary != there.vary {
            Some(format!("of {}", shortened(&varied(there))))
        } else if self.set != there.set {
            let set = if there.set.is_empty() { "no".into() } else { shortened(&there.set.join(" ")) };
            Some(format!("with {set} set parameters"))
        } else if self.ropewalk != there.ropewalk {
            Some(format!("by version {}", there.ropewalk))
        } else {
            (self != there).then(|| "of another kind".into())
        }
    }
}
