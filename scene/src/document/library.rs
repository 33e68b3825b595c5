//! The library of sections: `[[sections]]` of a scene and of files, which parts refer to by name.
//!
//! ```toml
//! [[sections]]
//! name = "chain"
//! mass = "20 kg/m"
//! ea = "90 MN"
//!
//! [[sections]]
//! file = "ropes.toml"      # has [[sections]] of its own
//!
//! [[elements]]
//! type = "cable"
//! section = "chain"
//! ```
//!
//! A part's `section`, and that of each entry of its `sections`, may be such a name. The section takes its place before
//! anything is read, so that messages point at where the section was written.

use super::fault::{Fault, did_you_mean, quoted};
use super::read::{Document, Format, read_text};
use super::source::Sources;
use super::value::{Key, Kind, Table, Value};
use super::{json, toml};
use std::path::Path;

/// The list of the library, and of a part that has several sections.
const LIST: &str = "sections";

/// Fields of a part, or of one of its sections, that hold a section.
const USES: [&str; 2] = ["section", "end_section"];

/// Named sections, in the order of the scene.
struct Library {
    all: Vec<(Key, Value)>,
}

impl Document {
    /// Puts sections in place of their names.
    ///
    /// # Errors
    /// A section without a name or with that of another; a name without a section; a file that can't be read.
    pub(crate) fn name_sections(&mut self) -> Result<(), Fault> {
        self.ask(LIST);
        let list = self.get(LIST).cloned();
        let library = Library::read(list.as_ref(), &mut self.sources)?;
        let Kind::Table(root) = &mut self.root.kind else { return Ok(()) };
        let Some((_, Value { kind: Kind::Array(parts), .. })) =
            root.0.iter_mut().find(|(key, _)| key.name == "elements")
        else {
            return Ok(());
        };
        for part in parts {
            let Kind::Table(part) = &mut part.kind else { continue };
            library.fill(part, &self.sources)?;
            let Some((_, Value { kind: Kind::Array(along), .. })) =
                part.0.iter_mut().find(|(key, _)| key.name == LIST)
            else {
                continue;
            };
            for one in along {
                if let Kind::Table(one) = &mut one.kind {
                    library.fill(one, &self.sources)?;
                }
            }
        }
        Ok(())
    }
}

impl Library {
    /// The library of a scene.
    fn read(list: Option<&Value>, sources: &mut Sources) -> Result<Self, Fault> {
        let mut library = Library { all: Vec::new() };
        let Some(list) = list else { return Ok(library) };
        for entry in entries(list, sources)? {
            match entry.as_table().and_then(|t| t.get("file")) {
                Some(file) => library.read_file(entry, file, sources)?,
                None => library.add(entry, sources)?,
            }
        }
        Ok(library)
    }

    /// Adds a section with its name.
    fn add(&mut self, entry: &Value, sources: &Sources) -> Result<(), Fault> {
        let mut section = entry.clone();
        let named = match &mut section.kind {
            Kind::Table(table) => table.remove("name"),
            _ => return Err(Fault::at("a section is a table", entry.span, sources)),
        };
        let Some((key, name)) = named else {
            let fault = Fault::at("this section has no name", entry.span, sources);
            return Err(
                fault.with_help("parts refer to it by its `name`; or read a file: `file = \"ropes.toml\"`")
            );
        };
        let Some(text) = name.as_str() else {
            return Err(Fault::at("the name of a section is a text", name.span, sources));
        };
        if self.all.iter().any(|(key, _)| key.name == text) {
            return Err(Fault::at(
                format!("there are two sections named {}", quoted(text)),
                name.span,
                sources,
            ));
        }
        self.all.push((Key { name: text.to_string(), span: key.span }, section));
        Ok(())
    }

    /// Adds the sections of a file.
    fn read_file(&mut self, entry: &Value, file: &Value, sources: &mut Sources) -> Result<(), Fault> {
        let alone = entry.as_table().is_some_and(|t| t.iter().len() == 1);
        let Some(path) = file.as_str().filter(|_| alone) else {
            let message =
                "a file of sections stands alone: `file = \"ropes.toml\"`, and the sections are in it";
            return Err(Fault::at(message, entry.span, sources));
        };
        let place = |fault: Fault| Fault::at(fault.message, file.span, sources);
        let (text, format) = read_text(Path::new(path)).map_err(place)?;
        let text = text.trim_start_matches('\u{feff}');
        let source = sources.add(path, text);
        let root = match format {
            Format::Toml => toml::parse(text, source, sources)?,
            Format::Json => json::parse(text, source, sources)?,
        };
        let table =
            root.as_table().ok_or_else(|| Fault::at("a file of sections is a table", root.span, sources))?;
        if let Some((key, _)) = table.iter().find(|(key, _)| key.name != LIST) {
            let message =
                format!("a file of sections holds nothing but `[[sections]]`, not {}", quoted(&key.name));
            return Err(Fault::at(message, key.span, sources));
        }
        let Some(list) = table.get(LIST) else { return Ok(()) };
        for entry in entries(list, sources)? {
            self.add(entry, sources)?;
        }
        Ok(())
    }

    /// Puts sections in place of their names in a table.
    fn fill(&self, table: &mut Table, sources: &Sources) -> Result<(), Fault> {
        for (key, value) in &mut table.0 {
            let Kind::String(name) = &value.kind else { continue };
            if !USES.contains(&key.name.as_str()) {
                continue;
            }
            let Some((_, section)) = self.all.iter().find(|(key, _)| key.name == *name) else {
                return Err(self.unknown(name, value, sources));
            };
            *value = Value { used: Some(value.span), ..section.clone() };
        }
        Ok(())
    }

    fn unknown(&self, name: &str, value: &Value, sources: &Sources) -> Fault {
        let names: Vec<&str> = self.all.iter().map(|(key, _)| key.name.as_str()).collect();
        let fault = Fault::at(format!("there is no section {}", quoted(name)), value.span, sources);
        match did_you_mean(name, &names) {
            Some(guess) => fault.with_help(guess),
            None if names.is_empty() => {
                fault.with_help("sections with names stand in the list `[[sections]]`")
            }
            None => fault.with_help(format!("the sections are {}", names.join(", "))),
        }
    }
}

fn entries<'a>(list: &'a Value, sources: &Sources) -> Result<&'a [Value], Fault> {
    match &list.kind {
        Kind::Array(list) => Ok(list),
        _ => {
            let message = format!("`sections` is a list, found {}", list.describe());
            Err(Fault::at(message, list.span, sources).with_path(LIST).with_help("write `[[sections]]`"))
        }
    }
}
