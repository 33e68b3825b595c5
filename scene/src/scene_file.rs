//! From a scene file to a [`Scene`], and from what is wrong with the scene back to the place in the file.

use crate::document::{Document, Fault, Format, did_you_mean, quoted, read_text};
use crate::elsewhere::pointed;
use crate::functions;
use crate::scene::{GRAVITY, Scene, SceneError};
use crate::spec::SpecKind;
use ropewalk_core::{BuildError, Model, Record, V3};
use ropewalk_quantity as quantity;
use serde::Deserialize;
use std::path::{Path, PathBuf, is_separator};
use std::sync::Arc;

/// A scene that is known by its name.
///
/// A crate with scenes of its own makes more of these and hands them to the command line together with
/// the bundled ones.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bundled {
    /// Name, as in `ropewalk run NAME`.
    pub name: &'static str,
    /// The scene file, as TOML.
    pub text: &'static str,
}

/// The text of a scene, of which parameters make one scene or another.
#[derive(Clone, Debug)]
pub struct SceneText {
    /// Its bundled name, or that of its file without ending.
    pub name: String,
    /// The text itself.
    pub text: String,
    /// What messages call it.
    label: String,
    format: Format,
    /// Where the files that it names are, if it is a file itself.
    folder: Option<PathBuf>,
}

impl SceneText {
    /// A text that is no file, or no longer. `name` is what messages and run folders call it; files that the scene names
    /// are looked for in `folder`, or where the program runs.
    pub fn new(name: &str, text: String, format: Format, folder: Option<PathBuf>) -> Self {
        Self { name: name.into(), text, label: name.into(), format, folder }
    }

    /// Finds a scene as [`SceneFile::open`] does.
    pub fn open(scene: &str, bundled: &[Bundled]) -> Result<Self, Fault> {
        let path = Path::new(scene);
        let lower = scene.to_lowercase();
        if !(scene.contains(is_separator) || lower.ends_with(".toml") || lower.ends_with(".json")) {
            if let Some(b) = bundled.iter().find(|b| b.name == scene) {
                let (name, text) = (b.name.to_string(), b.text.to_string());
                return Ok(Self { label: name.clone(), name, text, format: Format::Toml, folder: None });
            }
            if !path.exists() {
                return Err(unknown(scene, bundled));
            }
        }
        let name = path.file_stem().map_or_else(|| scene.to_string(), |s| s.to_string_lossy().into_owned());
        let (text, format) = read_text(path)?;
        let folder = path.parent().map(Path::to_path_buf);
        Ok(Self { name, text, label: path.display().to_string(), format, folder })
    }

    /// Files that the scene names with these parameters: each as it is written there, and where it is.
    ///
    /// # Errors
    /// The text can't be read.
    pub fn files(&self, overrides: &[String]) -> Result<Vec<(String, PathBuf)>, Fault> {
        let document = Document::parse(&self.text, &self.label, self.format, overrides)?;
        let folder = self.folder.clone().unwrap_or_default();
        Ok(document.files().into_iter().map(|name| (name.to_string(), folder.join(name))).collect())
    }

    /// How it is written.
    pub fn format(&self) -> Format {
        self.format
    }

    /// The scene with these parameters, each `name=value`.
    pub fn with(&self, overrides: &[String]) -> Result<SceneFile, Fault> {
        self.edited(overrides, &[])
    }

    /// The same with other values at some places, each a path and a value as TOML.
    pub fn edited(&self, overrides: &[String], edits: &[(String, String)]) -> Result<SceneFile, Fault> {
        let mut document = Document::parse(&self.text, &self.label, self.format, overrides)?;
        if let Some(folder) = &self.folder {
            document.files_from(folder);
        }
        edits.iter().try_for_each(|(path, value)| document.put(path, value))?;
        SceneFile::of(document, self.name.clone())
    }
}

/// An acceleration in space as a scene writes it [m/s²].
#[derive(Deserialize)]
#[serde(transparent)]
struct Acceleration(#[serde(deserialize_with = "quantity::vec3::acceleration")] V3<f64>);

/// A scene together with the file that it was read from, so that messages can point at lines.
#[derive(Debug)]
pub struct SceneFile {
    name: String,
    document: Document,
    scene: Scene,
}

impl SceneFile {
    /// Reads a scene by its bundled name or its path; `overrides` are parameters set from outside, each `name=value`.
    ///
    /// A name without path and without `.toml` or `.json` is looked for among the bundled scenes first.
    ///
    /// # Errors
    /// There is no such scene, or anything is wrong with it or with the overrides.
    pub fn open(scene: &str, overrides: &[String], bundled: &[Bundled]) -> Result<Self, Fault> {
        SceneText::open(scene, bundled)?.with(overrides)
    }

    /// Reads a scene from a text; `name` is what messages and run folders call it.
    ///
    /// # Errors
    /// If anything is wrong with the text or with the overrides.
    ///
    /// ```
    /// use ropewalk_scene::{Format, SceneFile};
    /// let text = "title = 'Nothing yet'\n[run]\nduration = '2 min'\n";
    /// let file = SceneFile::parse(text, "scene.toml", Format::Toml, &[])?;
    /// assert_eq!(file.scene().run.duration, 120.0);
    /// // what is wrong is shown with its place
    /// let fault = SceneFile::parse("[run]\nduratoin = 1\n", "scene.toml", Format::Toml, &[]).unwrap_err();
    /// assert!(fault.to_string().contains("scene.toml:2"));
    /// # Ok::<(), ropewalk_scene::Fault>(())
    /// ```
    pub fn parse(text: &str, name: &str, format: Format, overrides: &[String]) -> Result<Self, Fault> {
        Self::of(Document::parse(text, name, format, overrides)?, name.to_string())
    }

    fn of(mut document: Document, name: String) -> Result<Self, Fault> {
        functions::name_types(&mut document);
        document.name_sections()?;
        let scene = read(&mut document).map_err(pointed)?;
        Ok(SceneFile { name, document, scene })
    }

    /// The same under another name: of a scene that was copied into the folder of a run.
    pub fn named(self, name: &str) -> Self {
        SceneFile { name: name.to_string(), ..self }
    }

    /// Its bundled name, or that of its file without ending.
    pub fn name(&self) -> &str {
        &self.name
    }
    /// The scene.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }
    /// The scene, without the file.
    pub fn into_scene(self) -> Scene {
        self.scene
    }
    /// The file as it was read.
    pub fn document(&self) -> &Document {
        &self.document
    }
    /// The title, or the name of a scene that has none.
    pub fn title(&self) -> &str {
        if self.scene.title.is_empty() { &self.name } else { &self.scene.title }
    }

    /// Builds the model.
    ///
    /// # Errors
    /// The first thing that is wrong, with its place in the file.
    pub fn build(&self) -> Result<Model, Fault> {
        // asked here as well, since these messages have a section to point at
        self.scene.solver.check().map_err(|e| self.at_solver(&e))?;
        self.scene.build().map_err(|e| self.fault(&e))
    }

    /// The records of the scene for its model.
    ///
    /// # Errors
    /// The first record that can't be made, with its place in the file.
    pub fn records(&self, model: &Model) -> Result<Vec<Box<dyn Record>>, Fault> {
        self.scene.records(model).map_err(|e| self.fault(&e))
    }

    /// An error of building the scene, with its place in the file.
    pub fn fault(&self, e: &SceneError) -> Fault {
        let field = e.error.field.as_deref();
        let path = match (e.spec, field) {
            (Some((kind, k)), Some(field)) => {
                let part = format!("{}[{k}]", kind.list());
                let direct = format!("{part}.{field}");
                if self.document.find(&direct).is_some() {
                    direct
                } else {
                    // a field of a table inside the part, such as its section, is named without the table
                    self.inside(&part, field).unwrap_or(part)
                }
            }
            (Some((kind, k)), None) => format!("{}[{k}]", kind.list()),
            (None, Some(path)) => path.to_string(),
            (None, None) => return Fault::new(&e.error.message),
        };
        self.located(&path, &e.error.message)
    }

    /// A fault of the solver's options, with its place in the file.
    pub fn at_solver(&self, e: &BuildError) -> Fault {
        let path = e.field.as_ref().and_then(|field| self.inside("solver", field));
        self.located(path.as_deref().unwrap_or("solver"), &e.message)
    }

    /// A fault at what stands under this path, or of the whole scene if nothing does.
    fn located(&self, path: &str, message: &str) -> Fault {
        let first = path.split(['.', '[']).next().unwrap_or_default();
        match self.document.get(first) {
            Some(_) => self.document.fault_at(path, message),
            None => Fault::new(message).with_path(path),
        }
    }

    /// Path of a field of a table, or of the tables inside it.
    fn inside(&self, path: &str, field: &str) -> Option<String> {
        let table = self.document.find(path)?.as_table()?;
        if table.get(field).is_some() {
            return Some(format!("{path}.{field}"));
        }
        table.iter().find_map(|(key, _)| self.inside(&format!("{path}.{}", key.name), field))
    }
}

/// Reads the sections of a scene.
fn read(d: &mut Document) -> Result<Scene, Fault> {
    let scene = Scene {
        title: d.take("title")?.unwrap_or_default(),
        description: d.take("description")?.unwrap_or_default(),
        gravity: d.take("gravity")?.map_or(GRAVITY, |Acceleration(g)| g),
        water: d.take("water")?,
        air: d.take("air")?,
        run: d.take("run")?.unwrap_or_default(),
        solver: d.take("solver")?.unwrap_or_default(),
        statics: d.take("statics")?.unwrap_or_default(),
        elements: parts(d, SpecKind::Element)?,
        constraints: parts(d, SpecKind::Constraint)?,
        forces: parts(d, SpecKind::Force)?,
        motions: parts(d, SpecKind::Motion)?,
        records: parts(d, SpecKind::Record)?,
        inputs: d.take_list(SpecKind::Input.list())?.into_iter().map(|(input, _)| input).collect(),
        controllers: parts(d, SpecKind::Controller)?,
        processes: parts(d, SpecKind::Process)?,
    };
    d.finish()?;
    Ok(scene)
}

/// The list of a scene that holds this kind of part.
fn parts<T: ?Sized>(d: &mut Document, kind: SpecKind) -> Result<Vec<Arc<T>>, Fault>
where
    Box<T>: serde::de::DeserializeOwned,
{
    let all: Vec<(Box<T>, _)> = d.take_list(kind.list())?;
    Ok(all.into_iter().map(|(part, _)| part.into()).collect())
}

fn unknown(scene: &str, bundled: &[Bundled]) -> Fault {
    let names: Vec<&str> = bundled.iter().map(|b| b.name).collect();
    let message = format!("there is no bundled scene and no file {}", quoted(scene));
    let fault = match names.as_slice() {
        [] => Fault::new(message),
        few if few.len() <= 12 => {
            Fault::new(message).with_note(format!("the bundled scenes are {}", names.join(", ")))
        }
        _ => Fault::new(message)
            .with_note("`ropewalk list` and `ropewalk list --gallery` name those that there are"),
    };
    match did_you_mean(scene, &names) {
        Some(guess) => fault.with_help(guess),
        None => fault.with_help("give the path of a .toml or .json file"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BUNDLED: &[Bundled] =
        &[Bundled { name: "pendulum", text: "title = \"one\"\n[run]\nduration = \"2 s\"\n" }];

    #[test]
    fn bundled_names_are_found_and_guessed() {
        let file = SceneFile::open("pendulum", &[], BUNDLED).unwrap();
        assert_eq!((file.title(), file.scene().run.duration), ("one", 2.0));
        let fault = SceneFile::open("pendulm", &[], BUNDLED).unwrap_err();
        assert_eq!(fault.notes, ["the bundled scenes are pendulum"]);
        assert_eq!(fault.help.as_deref(), Some("did you mean `pendulum`?"));
        let fault = SceneFile::open("./pendulum", &[], BUNDLED).unwrap_err();
        assert!(fault.message.contains("there is no file"), "{fault}");
        let fault = SceneFile::open("pendulum.toml", &[], BUNDLED).unwrap_err();
        assert!(fault.message.contains("there is no file"), "{fault}");
    }

    #[test]
    fn errors_of_building_point_at_their_line() {
        for (text, line, message) in [
            ("title = \"x\"\n[run]\nduration = -1\n", Some(3), "`duration` must be positive"),
            ("title = \"x\"\n[solver]\nh_max = -1\n", Some(3), "`h_max` must be positive"),
            ("title = \"x\"\n[solver]\nstepping = { type = \"fixed\", h = 0 }\n", Some(3), "`h` must be"),
            ("title = \"x\"\n", None, "the scene is empty"),
            (
                "title = \"x\"\n[[records]]\ntype = \"energy\"\n[[records]]\ntype = \"energy\"\n",
                Some(4),
                "two records named `energy`",
            ),
        ] {
            let file = SceneFile::parse(text, "x", Format::Toml, &[]).unwrap();
            let fault = match file.build() {
                Err(fault) if !message.contains("records") => fault,
                _ => {
                    let model = empty();
                    file.records(&model).err().unwrap()
                }
            };
            assert!(fault.message.contains(message), "{fault}");
            assert_eq!(fault.place.as_ref().map(|p| p.line), line, "{fault}");
        }
    }

    fn empty() -> Model {
        Model::new(Vec::new(), Vec::new(), Vec::new(), Vec::new(), Default::default(), 1.0)
    }
}
