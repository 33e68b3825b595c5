//! Scenes as units of a co-simulation by [FMI 3.0](https://fmi-standard.org): which variables they have, and the files that
//! describe them.
//!
//! `ropewalk export-fmu` writes what stands here into a `.fmu` file, beside the shared library of the crate `ropewalk-fmu`,
//! which reads it again.

mod description;

use crate::error::Error;
use crate::session::columns;
use crate::simulate::in_time;
use ropewalk_scene::{Document, Fault, Format, SceneText};
use std::fs;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Component, Path};

/// Name of the shared library, without what the system puts around it.
pub const LIBRARY: &str = "ropewalk_fmu";
/// The list of parameters in the folder of resources.
const SET: &str = "set.txt";
/// A line of it that is no parameter: the name of the scene.
const NAME: &str = "# ";

/// A variable of a co-simulation.
#[derive(Clone, Debug, PartialEq)]
pub struct Variable {
    /// Its number (`valueReference`).
    pub reference: u32,
    /// Its name: of the parameter, of the input, or of the record's column.
    pub name: String,
    /// What it is, for people.
    pub description: String,
    /// Unit; empty for none and for texts.
    pub unit: String,
    /// What may be done with it.
    pub kind: Kind,
}

/// What may be done with a variable.
#[derive(Clone, Debug, PartialEq)]
pub enum Kind {
    /// The independent variable, which has number 0.
    Time,
    /// A parameter of the scene as `--set` takes it: a text, since it may have a unit.
    Parameter {
        /// Its value unless it is set.
        start: String,
    },
    /// An input of the scene.
    Input {
        /// Its value unless it is set.
        start: f64,
        /// Least and greatest value.
        range: [f64; 2],
    },
    /// A column of a record.
    Output,
}

/// All variables of a scene, in the order of their numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Interface {
    name: String,
    title: String,
    variables: Vec<Variable>,
    /// Length of the run and time between its samples [s].
    experiment: [f64; 2],
    token: String,
}

/// Whether a scene asks for nothing that only this process knows.
fn self_contained(document: &Document) -> Result<(), Fault> {
    for list in ["forces", "motions"] {
        let mut k = 0;
        while let Some(part) = document.find(&format!("{list}[{k}]")).and_then(|p| p.as_table()) {
            if part.get("type").and_then(|t| t.as_str()) == Some("function") {
                let message = "an FMU can't take along a function of the program that exports it";
                return Err(document
                    .fault_at(&format!("{list}[{k}]"), message)
                    .with_help("use a built-in type"));
            }
            k += 1;
        }
    }
    Ok(())
}

impl Interface {
    /// The variables of a scene with these parameters, each `name=value`.
    ///
    /// # Errors
    /// The scene is wrong, or is no run in time.
    pub fn new(text: &SceneText, set: &[String]) -> Result<Self, Error> {
        let file = text.with(set)?;
        let mut variables =
            vec![(Kind::Time, "time".to_string(), "time of the co-simulation".to_string(), "s".to_string())];
        for p in file.document().parameters() {
            let start = p.value.to_text();
            variables.push((
                Kind::Parameter { start },
                p.name.clone(),
                p.description.clone().unwrap_or_default(),
                String::new(),
            ));
        }
        let (name, title) = (file.name().to_string(), file.title().to_string());
        let experiment = [file.scene().run.duration, file.scene().run.output];
        in_time(file.scene())?;
        self_contained(file.document())?;
        let model = file.build()?;
        for input in model.inputs() {
            let kind = Kind::Input { start: input.value(0.0), range: input.limits() };
            variables.push((kind, input.name().to_string(), String::new(), input.unit().to_string()));
        }
        for column in columns(&file.records(&model)?) {
            variables.push((Kind::Output, column.name, String::new(), column.unit));
        }
        let variable = |(reference, (kind, name, description, unit))| Variable {
            reference,
            name,
            description,
            unit,
            kind,
        };
        let variables: Vec<Variable> = (0..).zip(variables).map(variable).collect();
        let mut names: Vec<&str> = variables.iter().map(|v| v.name.as_str()).collect();
        names.sort_unstable();
        if let Some(twice) = names.windows(2).find(|w| w[0] == w[1]) {
            let fault = Fault::new(format!("`{}` is the name of two variables of the FMU", twice[0]));
            return Err(fault.with_help("rename the parameter, the input or the record").into());
        }
        let mut hash = DefaultHasher::new();
        (&text.text, set).hash(&mut hash);
        let token = format!("{{ropewalk-{}-{:016x}}}", env!("CARGO_PKG_VERSION"), hash.finish());
        Ok(Interface { name, title, variables, experiment, token })
    }

    /// Name of the scene.
    pub fn name(&self) -> &str {
        &self.name
    }
    /// All variables.
    pub fn variables(&self) -> &[Variable] {
        &self.variables
    }
    /// One of them by its number.
    pub fn variable(&self, reference: u32) -> Option<&Variable> {
        self.variables.get(reference as usize)
    }
    /// What the description and the scene of one FMU have in common, and no other has (`instantiationToken`).
    pub fn token(&self) -> &str {
        &self.token
    }
}

/// What lies in the folder `resources` of an FMU: the scene, and the parameters it was exported with.
#[derive(Debug)]
pub struct Resources {
    /// The scene.
    pub text: SceneText,
    /// Parameters, each `name=value`.
    pub set: Vec<String>,
}

impl Resources {
    /// The files: name and content of each. Files that the scene names come along.
    ///
    /// # Errors
    /// A parameter of several lines; a file that can't be read or lies outside of the scene's folder.
    pub fn files(&self) -> Result<Vec<(String, Vec<u8>)>, Error> {
        if let Some(long) = self.set.iter().find(|s| s.contains('\n')) {
            return Err(Fault::new(format!("the parameter {long:?} has several lines")).into());
        }
        let set = std::iter::once(format!("{NAME}{}", self.text.name)).chain(self.set.iter().cloned());
        let set: String = set.map(|line| line + "\n").collect();
        let scene = format!("scene.{}", self.text.format().extension());
        let mut all = vec![(scene, self.text.text.clone().into_bytes()), (SET.to_string(), set.into_bytes())];
        for (name, path) in self.text.files(&self.set)? {
            let inside =
                Path::new(&name).components().all(|c| matches!(c, Component::Normal(_) | Component::CurDir));
            if !inside {
                let fault =
                    Fault::new(format!("`{name}` can't go into the FMU: it is not below the scene's folder"));
                return Err(fault
                    .with_help("put it beside the scene, and name it by a relative path")
                    .into());
            }
            let content =
                fs::read(&path).map_err(|e| Fault::new(format!("can't read `{}`: {e}", path.display())))?;
            all.push((name, content));
        }
        Ok(all)
    }

    /// Reads them from a folder.
    ///
    /// # Errors
    /// A file is missing.
    pub fn read(folder: &Path) -> Result<Self, Error> {
        let read = |name: &str| {
            let path = folder.join(name);
            fs::read_to_string(&path).map_err(|e| Fault::new(format!("can't read `{}`: {e}", path.display())))
        };
        let formats = [Format::Toml, Format::Json];
        let found = formats.into_iter().find(|f| folder.join(format!("scene.{}", f.extension())).exists());
        let format = found.unwrap_or(Format::Toml);
        let text = read(&format!("scene.{}", format.extension()))?;
        let list = read(SET)?;
        let name = list.lines().find_map(|l| l.strip_prefix(NAME)).unwrap_or("scene");
        let set = list.lines().filter(|l| !l.starts_with(NAME)).map(String::from).collect();
        Ok(Resources { text: SceneText::new(name, text, format, Some(folder.to_path_buf())), set })
    }
}
