//! A scene document: from a file or a text, with parameters replaced, to be taken apart by whoever knows the parts.

use super::deserialize::{self, Form};
use super::fault::{Fault, did_you_mean, expected, quoted};
use super::parameters::{self, Parameter};
use super::source::{Sources, Span};
use super::value::{DEEPEST, Key, Kind, Table, Value};
use super::{json, moved, toml, write};
use serde::de::DeserializeOwned;
use std::io::{ErrorKind, Read};
use std::path::Path;

/// A scene file larger than this is surely none.
const LARGEST: u64 = 8 << 20;

/// How a scene is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// `scene.toml`
    Toml,
    /// `scene.json`
    Json,
}

impl Format {
    /// How the names of such files end, without the dot.
    pub fn extension(self) -> &'static str {
        match self {
            Format::Toml => "toml",
            Format::Json => "json",
        }
    }
}

/// A scene file that has been read and whose parameters are replaced by their values.
///
/// Parts are taken by name; in the end [`finish`](Self::finish) refuses what nobody took.
#[derive(Debug)]
pub struct Document {
    pub(super) root: Value,
    pub(super) sources: Sources,
    parameters: Vec<Parameter>,
    /// Names that were asked for, in that order: those that a scene can have.
    asked: Vec<String>,
}

impl Document {
    /// Reads a `.toml` or `.json` file; `overrides` are parameters set from outside, each `name=value`.
    ///
    /// # Errors
    /// If there is no such file, it is no text, or anything is wrong with it or with the overrides.
    pub fn read(path: &Path, overrides: &[String]) -> Result<Self, Fault> {
        let (text, format) = read_text(path)?;
        Self::parse(&text, &path.display().to_string(), format, overrides)
    }

    /// Reads a text; `name` is what messages call it.
    ///
    /// # Errors
    /// If anything is wrong with the text or with the overrides.
    pub fn parse(text: &str, name: &str, format: Format, overrides: &[String]) -> Result<Self, Fault> {
        // Windows editors put a mark there, which isn't part of the text
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        if text.trim().is_empty() {
            return Err(Fault::new(format!("{} is empty", quoted(name))));
        }
        let mut sources = Sources::default();
        let source = sources.add(name, text);
        let mut root = match format {
            Format::Toml => toml::parse(text, source, &sources)?,
            Format::Json => json::parse(text, source, &sources)?,
        };
        let parameters = match &mut root.kind {
            Kind::Table(table) if !table.0.is_empty() => parameters::resolve(table, overrides, &mut sources)?,
            _ => return Err(Fault::new(format!("{} is empty", quoted(name)))),
        };
        if root.depth_and_size().0 > DEEPEST {
            return Err(Fault::at("nested too deeply", root.span, &sources));
        }
        Ok(Self { root, sources, parameters, asked: Vec::new() })
    }

    fn table(&self) -> &Table {
        const NOTHING: &Table = &Table(Vec::new());
        self.root.as_table().unwrap_or(NOTHING)
    }

    /// The whole tree, parameters replaced: a table.
    #[must_use]
    pub fn root(&self) -> &Value {
        &self.root
    }

    /// What stands under a name of the top level, if anything.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<&Value> {
        self.table().get(name).filter(|value| value.kind != Kind::Null)
    }

    /// Paths of files that the scene names, under the key `file`.
    pub fn files(&self) -> Vec<&str> {
        let mut found = Vec::new();
        files(&self.root, &mut found);
        found
    }

    /// Makes the paths of files that the scene names, under the key `file`, start from this folder.
    pub fn files_from(&mut self, folder: &Path) {
        rename_files(&mut self.root, &mut |path| {
            let whole = folder.join(path);
            std::path::absolute(&whole).unwrap_or(whole).display().to_string()
        });
    }

    /// What stands at a path like `elements[2].section`, if anything does.
    #[must_use]
    pub fn find(&self, path: &str) -> Option<&Value> {
        self.root.find(path)
    }

    /// The parameter that stands at a path as `"$name"`, if that is how the value was written.
    #[must_use]
    pub fn parameter_at(&self, path: &str) -> Option<&str> {
        let name = self.sources.text(self.find(path)?.used?).trim_matches(['"', '\'']).strip_prefix('$')?;
        self.parameters.iter().find(|p| p.name == name).map(|p| p.name.as_str())
    }

    /// Puts another value, written as TOML, at a path like `elements[2].longitudinal`.
    ///
    /// # Errors
    /// If there is no such place, or the text is no value.
    pub(crate) fn put(&mut self, path: &str, text: &str) -> Result<(), Fault> {
        let source = self.sources.add(path, text);
        let value = toml::parse_value(text, 0, source, &self.sources)
            .unwrap_or_else(|| Err(Fault::new(format!("{} is no value", quoted(text)))))?;
        match self.root.put(path, value) {
            true => Ok(()),
            false => Err(Fault::new(format!("the scene has no place {}", quoted(path)))),
        }
    }

    /// Rewrites parts of a list whose `type` is the name of a function: keys that aren't the part's `own` are the function's
    /// parameters.
    pub(crate) fn call_functions(&mut self, list: &str, own: &[&str], is_function: &dyn Fn(&str) -> bool) {
        let Kind::Table(root) = &mut self.root.kind else { return };
        let Some((_, Value { kind: Kind::Array(parts), .. })) =
            root.0.iter_mut().find(|(key, _)| key.name == list)
        else {
            return;
        };
        for part in parts {
            let span = part.span;
            let Kind::Table(table) = &mut part.kind else { continue };
            let is_one = table.get("type").and_then(Value::as_str).is_some_and(is_function);
            if !is_one || table.get("function").is_some() {
                continue;
            }
            let Some((key, name)) = table.remove("type") else { continue };
            let all = std::mem::take(&mut table.0);
            let (mut kept, mut given): (Vec<_>, Vec<_>) =
                all.into_iter().partition(|(key, _)| own.contains(&key.name.as_str()));
            let named = |name: &str| Key { name: name.into(), span: key.span };
            kept.push((named("type"), Value { kind: Kind::String("function".into()), ..name.clone() }));
            kept.push((named("function"), name));
            if kept.iter().any(|(key, _)| key.name == "parameters") {
                kept.append(&mut given);
            }
            if !given.is_empty() {
                kept.push((named("parameters"), Value::new(Kind::Table(Table(given)), span)));
            }
            table.0 = kept;
        }
    }

    pub(super) fn ask(&mut self, name: &str) {
        if !self.asked.iter().any(|a| a == name) {
            self.asked.push(name.to_string());
        }
    }

    /// Reads the value under a name of the top level, as `[solver]`; none if it isn't there.
    ///
    /// # Errors
    /// If it is there but can't be read as a `T`.
    pub fn take<T: DeserializeOwned>(&mut self, name: &str) -> Result<Option<T>, Fault> {
        self.ask(name);
        let Some(value) = self.get(name) else { return Ok(None) };
        deserialize::read(value, Form::Plain, name, &self.sources).map(Some)
    }

    /// Reads the value under a name of the top level, which has to be there.
    ///
    /// # Errors
    /// If it isn't there or can't be read as a `T`.
    pub fn require<T: DeserializeOwned>(&mut self, name: &str) -> Result<T, Fault> {
        self.take(name)?.ok_or_else(|| {
            let names: Vec<&str> = self.table().iter().map(|(key, _)| key.name.as_str()).collect();
            let message = format!("missing {} in {}", quoted(name), quoted(self.sources.name(0)));
            // a name that nobody asks for and that is nearly the missing one is where the mistake is
            let near = |(key, _): &&(Key, Value)| {
                did_you_mean(name, &[&key.name]).is_some() && !self.asked.contains(&key.name)
            };
            match self.table().iter().find(near) {
                Some((key, _)) => {
                    self.fault(key.span, message).with_help(format!("is {} meant?", quoted(name)))
                }
                None if names.is_empty() => Fault::new(message),
                None => Fault::new(message).with_help(format!("the scene has {}", names.join(", "))),
            }
        })
    }

    /// Reads a list of parts, as `[[elements]]`; empty if it isn't there.
    ///
    /// `T` is a `Box` of a typetag trait (externally tagged) or an enum, chosen by the `type` of each part; or anything
    /// else that serde can read. Each part comes with its place, for faults found later.
    ///
    /// # Errors
    /// If it is there but no list, or a part can't be read as a `T`.
    pub fn take_list<T: DeserializeOwned>(&mut self, name: &str) -> Result<Vec<(T, Span)>, Fault> {
        self.ask(name);
        let Some(value) = self.get(name) else { return Ok(Vec::new()) };
        if let Some(found) = moved::found(name, value, &moved::Reach { parameters: None }).first() {
            return Err(self.moved(found));
        }
        let Kind::Array(list) = &value.kind else {
            let message = format!("{} is a list, found {}", quoted(name), value.describe());
            return Err(self
                .fault(value.span, message)
                .with_path(name)
                .with_help(format!("write `[[{name}]]`")));
        };
        let part = |(i, value): (usize, &Value)| {
            let path = format!("{name}[{i}]");
            Ok((deserialize::read(value, Form::Tagged, &path, &self.sources)?, value.span))
        };
        list.iter().enumerate().map(part).collect()
    }

    /// What a name of an older version is now, and the command that rewrites the scene.
    fn moved(&self, found: &moved::Found<'_>) -> Fault {
        let command = format!("`ropewalk migrate {}` rewrites the scene", self.sources.name(0));
        let fault = self.fault(found.span, &found.message).with_path(&found.path);
        match found.help {
            Some(help) => fault.with_help(help),
            None => fault.with_help(command),
        }
    }

    /// Refuses what stands at the top level and was never asked for.
    ///
    /// # Errors
    /// If there is such a name.
    pub fn finish(&self) -> Result<(), Fault> {
        // editors find a JSON file's schema by this key
        let known = |name: &str| name == "$schema" || self.asked.iter().any(|a| a == name);
        let Some((key, _)) = self.table().iter().find(|(key, _)| !known(&key.name)) else { return Ok(()) };
        let mut names = self.asked.clone();
        names.push(parameters::TABLE.to_string());
        let mut fault =
            self.fault(key.span, format!("unknown field {}, {}", quoted(&key.name), expected(&names)));
        fault.help = did_you_mean(&key.name, &names);
        Err(fault)
    }

    /// The scene's parameters and the values that they have, in the order of the file.
    #[must_use]
    pub fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    /// Names of parameters that are declared but that nothing in the scene uses: worth a warning.
    #[must_use]
    pub fn unused_parameters(&self) -> Vec<&str> {
        self.parameters.iter().filter(|p| !p.used).map(|p| p.name.as_str()).collect()
    }

    /// A fault at a place of this document, for what turns out only later.
    #[must_use]
    pub fn fault(&self, span: Span, message: impl Into<String>) -> Fault {
        Fault::at(message, span, &self.sources)
    }

    /// A fault at a path like `elements[2].section.ea`; it points at the nearest thing above that was written.
    #[must_use]
    pub fn fault_at(&self, path: &str, message: impl Into<String>) -> Fault {
        self.fault(self.root.nearest(path).span, message).with_path(path)
    }

    /// The document as it was read, parameters replaced, as TOML. It reads again to the same.
    #[must_use]
    pub fn to_toml(&self) -> String {
        write::document(self.table())
    }

    /// The same with other paths of the files that the scene names.
    pub fn to_toml_with_files(&self, rename: &mut dyn FnMut(&str) -> String) -> String {
        let mut root = self.root.clone();
        rename_files(&mut root, rename);
        root.as_table().map(write::document).unwrap_or_default()
    }
}

fn files<'a>(value: &'a Value, found: &mut Vec<&'a str>) {
    match &value.kind {
        Kind::Table(table) => {
            for (key, value) in &table.0 {
                match &value.kind {
                    Kind::String(path) if key.name == "file" => found.push(path),
                    _ => files(value, found),
                }
            }
        }
        Kind::Array(list) => list.iter().for_each(|value| files(value, found)),
        _ => {}
    }
}

fn rename_files(value: &mut Value, rename: &mut dyn FnMut(&str) -> String) {
    match &mut value.kind {
        Kind::Table(table) => {
            for (key, value) in &mut table.0 {
                match &mut value.kind {
                    Kind::String(path) if key.name == "file" => *path = rename(path),
                    _ => rename_files(value, rename),
                }
            }
        }
        Kind::Array(list) => list.iter_mut().for_each(|value| rename_files(value, rename)),
        _ => {}
    }
}

/// Whether a path is that of a file which is open already, such as a pipe from another program: opening a pipe by name
/// waits for somebody to write into it.
fn is_descriptor(path: &Path) -> bool {
    path == Path::new("/dev/stdin") || path.starts_with("/dev/fd") || path.starts_with("/proc/self/fd")
}

/// Reads the text of a `.toml` or `.json` file, and tells which of them it is.
///
/// # Errors
/// If there is no such file, or it is no text.
pub fn read_text(path: &Path) -> Result<(String, Format), Fault> {
    let name = path.display().to_string();
    let quoted = format!("`{name}`");
    let fault = |e: std::io::Error| match e.kind() {
        ErrorKind::NotFound => Fault::new(format!("there is no file {quoted}")),
        ErrorKind::PermissionDenied => Fault::new(format!("{quoted} may not be read: permission denied")),
        _ => Fault::new(format!("{quoted} can't be read: {e}")),
    };
    let about = std::fs::metadata(path).map_err(fault)?;
    if about.is_dir() {
        return Err(Fault::new(format!("{quoted} is a directory, not a scene file")));
    }
    if !about.is_file() && !is_descriptor(path) {
        return Err(Fault::new(format!("{quoted} is a pipe or a device, not a scene file"))
            .with_help("what another program writes is read from `/dev/stdin`"));
    }
    let format = match path.extension().and_then(|e| e.to_str()).map(str::to_lowercase).as_deref() {
        Some("toml") => Some(Format::Toml),
        Some("json") => Some(Format::Json),
        // a pipe has no name worth reading
        None => None,
        Some(other) => {
            let message = format!("{quoted} is no scene file: `.{other}` is neither `.toml` nor `.json`");
            return Err(Fault::new(message));
        }
    };
    let mut bytes = Vec::new();
    let file = std::fs::File::open(path).map_err(fault)?;
    file.take(LARGEST + 1).read_to_end(&mut bytes).map_err(fault)?;
    if bytes.len() as u64 > LARGEST {
        return Err(Fault::new(format!("{quoted} is larger than {} MB, which no scene is", LARGEST >> 20)));
    }
    let Some(text) = String::from_utf8(bytes).ok().filter(|text| !text.contains('\0')) else {
        return Err(Fault::new(format!("{quoted} is not a text file (UTF-8)")));
    };
    let json = || text.trim_start_matches(['\u{feff}', ' ', '\t', '\r', '\n']).starts_with('{');
    let format = format.unwrap_or_else(|| if json() { Format::Json } else { Format::Toml });
    Ok((text, format))
}
