//! The runs that an atlas needs, each once.

use super::read::AtlasFile;
use super::spec::{Runs, SceneUse, Values};
use crate::run::Recorder;
use crate::sweep::Axis;
use ropewalk_models::Bundled;
use ropewalk_report::{Column, plain};
use ropewalk_scene::{Fault, SceneFile, SceneText, Varied, quoted};
use serde_json::Value;
use std::collections::{HashMap, HashSet};

/// More runs than this are surely a mistake.
const MOST_RUNS: usize = 10_000;
/// What tables call the label of `runs` where it goes across.
pub(super) const CASE: &str = "case";
/// Characters of a folder's name before its fingerprint.
const LONGEST_NAME: usize = 60;

/// A run.
pub(super) struct Case {
    /// What it is, for people.
    pub title: String,
    /// Name of its folder: the same and the fingerprint of its scene.
    pub name: String,
    pub file: SceneFile,
    /// Columns of its history, without values.
    pub columns: Vec<Column>,
    /// Length of an element of its first cable [m], and its bending time [s].
    pub bending: Option<(f64, f64)>,
}

/// A run in an entry.
#[derive(Clone)]
pub(super) struct Use {
    /// Number of the case.
    pub case: usize,
    /// Values of parameters that are set or varied there, by name.
    pub values: Vec<(String, String)>,
    /// What the atlas calls the runs to which it belongs, if there are others.
    pub own: Option<String>,
    /// Names of the parameters that are varied, and how legends show them with their values.
    pub shown: Vec<(String, String)>,
    /// What tells it from the other runs of the entry.
    pub label: String,
}

/// All runs of some entries.
pub(super) struct Plan {
    pub cases: Vec<Case>,
    /// The runs of each entry; empty for entries that aren't asked for.
    pub uses: Vec<Vec<Use>>,
}

impl Plan {
    /// Reads and builds the scenes of these entries with all their parameters.
    ///
    /// # Errors
    /// The first thing that is wrong, with its place in the atlas.
    pub(super) fn new(
        file: &AtlasFile,
        chosen: &[usize],
        quick: bool,
        bundled: &[Bundled],
    ) -> Result<Self, Fault> {
        let mut planner = Planner {
            file,
            quick,
            bundled,
            texts: HashMap::new(),
            known: HashMap::new(),
            plan: Plan { cases: Vec::new(), uses: vec![Vec::new(); file.atlas.entries.len()] },
        };
        for &k in chosen {
            let entry = &file.atlas.entries[k];
            let several = entry.runs().len() > 1;
            for (i, runs) in entry.runs().iter().enumerate() {
                planner.runs(k, i, runs, several).map_err(|fault| match &fault.place {
                    // of a scene's own fault one wants to know who uses it
                    Some(place) if place.file != file.document_name() => {
                        fault.with_note(format!("in runs[{i}] of {}", entry.caption()))
                    }
                    _ => fault,
                })?;
            }
            if planner.plan.uses[k].len() > MOST_RUNS {
                let message = format!("{} needs more than {MOST_RUNS} runs", entry.caption());
                return Err(file.fault(&format!("entries[{k}]"), message).with_help("vary less at once"));
            }
        }
        Ok(planner.plan)
    }
}

struct Planner<'a> {
    file: &'a AtlasFile,
    quick: bool,
    bundled: &'a [Bundled],
    texts: HashMap<String, SceneText>,
    /// Number of the case by the text of its scene.
    known: HashMap<String, usize>,
    plan: Plan,
}

impl Planner<'_> {
    /// All runs of one `runs` of an entry.
    fn runs(&mut self, entry: usize, index: usize, runs: &Runs, several: bool) -> Result<(), Fault> {
        let path = format!("entries[{entry}].runs[{index}]");
        let varied = self.varied(&path, runs)?;
        let count = varied.iter().fold(1_usize, |n, v| n.saturating_mul(v.values.len()));
        if count > MOST_RUNS {
            let message = format!("{count} combinations are more than {MOST_RUNS}");
            return Err(self.file.fault(&path, message).with_help("vary less at once"));
        }
        for k in 0..count {
            let mut rest = k;
            let mut values: Vec<(String, String)> = Vec::new();
            for v in varied.iter().rev() {
                values.insert(0, (v.name.clone(), v.values[rest % v.values.len()].clone()));
                rest /= v.values.len();
            }
            let case = self.case(&path, runs, &values)?;
            let names = &self.file.atlas.names;
            let shown = |(name, value): &(String, String)| {
                let called = names.get(name).map_or(name.as_str(), String::as_str);
                let blank = if called.is_empty() { "" } else { " " };
                (name.clone(), format!("{called}{blank}{}", printed(value)))
            };
            let shown: Vec<(String, String)> = values.iter().map(shown).collect();
            let own = runs.label.clone().or_else(|| several.then(|| runs.scene.clone()));
            let own = own.filter(|own| !own.is_empty());
            let all = own.iter().chain(shown.iter().map(|(_, s)| s));
            let label = all.cloned().collect::<Vec<_>>().join(", ");
            values.extend(runs.set.iter().map(|(name, value)| (name.clone(), inline(value))));
            self.plan.uses[entry].push(Use { case, values, own, shown, label });
        }
        Ok(())
    }

    /// The parameters that vary, first slowest.
    fn varied(&self, path: &str, runs: &Runs) -> Result<Vec<Varied>, Fault> {
        let one = |(name, value): (&String, &Value)| {
            let at = format!("{path}.vary.{name}");
            let list = match value {
                Value::Array(list) if !list.is_empty() => list.iter().map(inline).collect::<Vec<_>>(),
                // a range, as on the command line
                Value::String(range) => {
                    let varied = Varied::parse(&format!("{name}={range}"));
                    varied.map_err(|fault| self.file.fault(&at, fault.message))?.values
                }
                _ => {
                    let message = format!("{} needs a list of values", quoted(name));
                    let help = format!("write `{name} = [1, 2, 3]` or `{name} = \"5:25:10 kn\"`");
                    return Err(self.file.fault(&at, message).with_help(help));
                }
            };
            Ok(Varied { name: name.clone(), values: list })
        };
        runs.vary.iter().map(one).collect()
    }

    /// The number of the run with these values of what is varied.
    fn case(&mut self, path: &str, runs: &Runs, varied: &[(String, String)]) -> Result<usize, Fault> {
        let shared = self.file.atlas.scenes.get(&runs.scene);
        let none = SceneUse::none();
        let scene = shared.unwrap_or(&none);
        let of = format!("scenes.{}", runs.scene);
        // what is said later counts
        let mut set: Vec<(String, String)> = settings(&scene.set, &format!("{of}.set"));
        if self.quick {
            set.extend(settings(&scene.quick, &format!("{of}.quick")));
        }
        set.extend(settings(&runs.set, &format!("{path}.set")));
        set.extend(varied.iter().map(|(n, v)| (format!("{n}={v}"), format!("{path}.vary.{n}"))));
        let edits: Vec<(String, String)> = scene
            .edit
            .iter()
            .chain(&runs.edit)
            .map(|(place, value)| (place.clone(), inline(value)))
            .collect();

        let overrides: Vec<String> = set.iter().map(|(text, _)| text.clone()).collect();
        let scene_text = self.text(path, &runs.scene)?;
        let file =
            scene_text.edited(&overrides, &edits).map_err(|fault| self.relocated(fault, path, &set))?;
        let text = file.document().to_toml();
        if let Some(case) = self.known.get(&text) {
            return Ok(*case);
        }
        let model = file.build().map_err(|fault| self.relocated(fault, path, &set))?;
        let records = file.records(&model).map_err(|fault| self.relocated(fault, path, &set))?;
        let columns = Recorder::new(file.scene(), records).table.columns;
        let slender = model.parts().iter().find_map(|p| p.slender());
        let bending = slender.map(|s| (s.element, s.bending_time()));
        let values: Vec<String> =
            runs.set.iter().map(|(n, v)| format!("{n}={}", text_of(v))).chain(of_varied(varied)).collect();
        let title: String = plain(&[vec![runs.scene.clone()], values].concat().join(","))
            .chars()
            .filter(|c| !c.is_whitespace())
            .take(LONGEST_NAME)
            .collect();
        let name = format!("{title}-{:016x}", fingerprint(&text));
        self.plan.cases.push(Case { title, name, file, columns, bending });
        self.known.insert(text, self.plan.cases.len() - 1);
        Ok(self.plan.cases.len() - 1)
    }

    /// The text of a scene of the atlas, or of a bundled one.
    fn text(&mut self, path: &str, name: &str) -> Result<&SceneText, Fault> {
        if !self.texts.contains_key(name) {
            let found = match self.file.atlas.scenes.get(name) {
                None => SceneText::open(name, self.bundled).map_err(|fault| {
                    let known: Vec<&str> = self.file.atlas.scenes.keys().map(String::as_str).collect();
                    let at = self.file.fault(&format!("{path}.scene"), fault.message);
                    let at = Fault { notes: fault.notes, help: fault.help, ..at };
                    match known.is_empty() {
                        true => at,
                        false => at.with_note(format!("the atlas has {}", known.join(", "))),
                    }
                }),
                Some(used) => {
                    let at = format!("scenes.{name}");
                    let (wanted, key) = match (&used.scene, &used.file) {
                        (Some(scene), None) => (scene.as_str(), "scene"),
                        (None, Some(file)) => (file.as_str(), "file"),
                        _ => {
                            let message = format!("{} needs either `scene` or `file`", quoted(name));
                            return Err(self.file.fault(&at, message).with_help(
                                "write `scene = \"hose-turn\"` for a bundled scene, or `file = \"mine.toml\"`",
                            ));
                        }
                    };
                    SceneText::open(wanted, self.bundled).map_err(|fault| match fault.place {
                        Some(_) => fault,
                        None => {
                            let here = self.file.fault(&format!("{at}.{key}"), fault.message);
                            Fault { notes: fault.notes, help: fault.help, ..here }
                        }
                    })
                }
            }?;
            self.texts.insert(name.to_string(), found);
        }
        Ok(&self.texts[name])
    }

    /// A fault of a value that the atlas sets, at its place in the atlas.
    fn relocated(&self, fault: Fault, path: &str, set: &[(String, String)]) -> Fault {
        let Some(place) = &fault.place else {
            let here = self.file.fault(path, fault.message);
            return Fault { notes: fault.notes, help: fault.help, ..here };
        };
        let at = match place.span.source() {
            0 => return fault,
            // overrides are the sources behind the scene's text, edits those behind them
            k => set.get(k - 1).map_or_else(|| format!("{path}.edit"), |(_, at)| at.clone()),
        };
        let here = self.file.fault(&at, fault.message);
        Fault { notes: fault.notes, help: fault.help, ..here }
    }
}

impl SceneUse {
    /// A scene as it is.
    fn none() -> Self {
        let (set, edit, quick) = (Values::new(), Values::new(), Values::new());
        SceneUse { scene: None, file: None, set, edit, quick }
    }
}

impl Use {
    /// What tells it from the other runs of the entry but for one parameter.
    pub(super) fn label_without(&self, name: &str) -> String {
        let others = self.shown.iter().filter(|(n, _)| n != name).map(|(_, shown)| shown);
        self.own.iter().chain(others).cloned().collect::<Vec<_>>().join(", ")
    }

    /// The value of a parameter, or as `case` what the atlas calls the runs to which it belongs.
    pub(super) fn value(&self, name: &str) -> Option<&str> {
        if name == CASE && self.own.is_some() {
            return self.own.as_deref();
        }
        self.values.iter().find(|(n, _)| n == name).map(|(_, v)| v.as_str())
    }
}

impl Plan {
    /// The numbers of the cases that have to be computed.
    pub(super) fn needed(&self, file: &AtlasFile) -> Vec<usize> {
        let entries = self.uses.iter().zip(&file.atlas.entries).filter(|(_, e)| e.needs_results());
        let used: HashSet<usize> = entries.flat_map(|(uses, _)| uses).map(|u| u.case).collect();
        (0..self.cases.len()).filter(|k| used.contains(k)).collect()
    }

    /// The values of a parameter in an entry's runs as numbers along an axis, in the unit in which they are written.
    pub(super) fn axis(&self, entry: usize, name: &str) -> Option<(Axis, Vec<usize>)> {
        let uses = &self.uses[entry];
        let mut values: Vec<String> = Vec::new();
        let mut of = Vec::new();
        for u in uses {
            let value = unquoted(u.value(name)?);
            let at = values.iter().position(|v| v == value).unwrap_or_else(|| {
                values.push(value.to_string());
                values.len() - 1
            });
            of.push(at);
        }
        let parameters = |u: &Use| self.cases[u.case].file.document().parameters();
        let default = uses.first().and_then(|u| parameters(u).iter().find(|p| p.name == name));
        let axis = Axis::new(&Varied { name: name.into(), values }, default.map(|p| &p.value));
        Some((axis, of))
    }
}

fn of_varied(varied: &[(String, String)]) -> impl Iterator<Item = String> {
    varied.iter().map(|(n, v)| format!("{n}={}", unquoted(v)))
}

/// `name=value` and the place in the atlas, of each.
fn settings(values: &Values, path: &str) -> Vec<(String, String)> {
    values.iter().map(|(n, v)| (format!("{n}={}", inline(v)), format!("{path}.{n}"))).collect()
}

fn text_of(value: &Value) -> String {
    unquoted(&inline(value)).to_string()
}

fn unquoted(text: &str) -> &str {
    text.strip_prefix('"').and_then(|t| t.strip_suffix('"')).unwrap_or(text)
}

/// A value as a legend shows it, with a true minus sign.
pub(super) fn printed(value: &str) -> String {
    let text = unquoted(value).replace('"', "");
    match text.strip_prefix('-').filter(|rest| rest.starts_with(|c: char| c.is_ascii_digit())) {
        Some(rest) => format!("−{rest}"),
        None => text,
    }
}

/// A value as TOML on one line.
pub(super) fn inline(value: &Value) -> String {
    match value {
        Value::Array(list) => format!("[{}]", list.iter().map(inline).collect::<Vec<_>>().join(", ")),
        Value::Object(table) => {
            let pair = |(key, value): (&String, &Value)| {
                format!("{} = {}", Value::from(key.as_str()), inline(value))
            };
            format!("{{ {} }}", table.iter().map(pair).collect::<Vec<_>>().join(", "))
        }
        other => other.to_string(),
    }
}

/// FNV-1a: tells scenes apart in names of folders; whether a folder holds the scene is read from its `scene.toml`.
fn fingerprint(text: &str) -> u64 {
    text.bytes().fold(0xcbf2_9ce4_8422_2325, |h, b| (h ^ u64::from(b)).wrapping_mul(0x100_0000_01b3))
}

impl AtlasFile {
    /// What messages call the file.
    pub(super) fn document_name(&self) -> String {
        let place = self.document.fault_at("title", "").place;
        place.map_or_else(String::new, |p| p.file.clone())
    }
}
