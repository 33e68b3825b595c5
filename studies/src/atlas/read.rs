//! Reading an atlas, and choosing from it.

use super::spec::{Atlas, Entry};
use ropewalk_models::Bundled;
use ropewalk_scene::{Document, Fault, Format, did_you_mean, quoted, read_text};
use std::collections::HashMap;
use std::path::{Path, is_separator};

/// An atlas together with its file, so that messages can point at lines.
pub struct AtlasFile {
    /// Its bundled name, or that of its file without ending.
    pub name: String,
    pub(super) document: Document,
    pub(super) atlas: Atlas,
}

impl AtlasFile {
    /// Reads an atlas by its bundled name or its path.
    ///
    /// # Errors
    /// There is no such atlas, or its text is wrong as far as that can be told without its scenes.
    pub fn open(atlas: &str, bundled: &[Bundled]) -> Result<Self, Fault> {
        let path = Path::new(atlas);
        let lower = atlas.to_lowercase();
        let is_path = atlas.contains(is_separator) || lower.ends_with(".toml") || lower.ends_with(".json");
        match bundled.iter().find(|b| b.name == atlas).filter(|_| !is_path) {
            Some(b) => Self::parse(b.text, b.name, b.name, Format::Toml, None),
            None if !is_path && !path.exists() => {
                let names: Vec<&str> = bundled.iter().map(|b| b.name).collect();
                let message = format!("there is no bundled atlas and no file {}", quoted(atlas));
                let fault =
                    Fault::new(message).with_note(format!("the bundled atlases are {}", names.join(", ")));
                Err(match did_you_mean(atlas, &names) {
                    Some(guess) => fault.with_help(guess),
                    None => fault.with_help("give the path of a .toml or .json file"),
                })
            }
            None => {
                let (text, format) = read_text(path)?;
                let name = path.file_stem().map_or_else(String::new, |s| s.to_string_lossy().into_owned());
                Self::parse(&text, &name, &path.display().to_string(), format, path.parent())
            }
        }
    }

    fn parse(
        text: &str,
        name: &str,
        label: &str,
        format: Format,
        folder: Option<&Path>,
    ) -> Result<Self, Fault> {
        let mut document = Document::parse(text, label, format, &[])?;
        if let Some(folder) = folder {
            document.files_from(folder);
        }
        let d = &mut document;
        let atlas = Atlas {
            title: d.require("title")?,
            description: d.take("description")?.unwrap_or_default(),
            chapters: d.take_list("chapters")?.into_iter().map(|(c, _)| c).collect(),
            scenes: d.take("scenes")?.unwrap_or_default(),
            layouts: d.take("layouts")?.unwrap_or_default(),
            names: d.take("names")?.unwrap_or_default(),
            entries: d.take_list("entries")?.into_iter().map(|(e, _)| e).collect(),
        };
        document.finish()?;
        let file = Self { name: name.to_string(), document, atlas };
        file.numbers()?;
        Ok(file)
    }

    /// Every entry has a number of its own, and a chapter that there is.
    fn numbers(&self) -> Result<(), Fault> {
        if self.atlas.entries.is_empty() {
            return Err(Fault::new(format!("{} has no entries", quoted(&self.name)))
                .with_help("add `[[entries]]` with `type = \"figure\"` or `\"table\"`"));
        }
        let chapters: Vec<&str> = self.atlas.chapters.iter().map(|c| c.number.as_str()).collect();
        let mut seen: HashMap<String, usize> = HashMap::new();
        for (k, entry) in self.atlas.entries.iter().enumerate() {
            if let Some(first) = seen.insert(entry.name(), k) {
                return Err(self
                    .fault(&format!("entries[{k}].number"), format!("there are two of {}", entry.caption()))
                    .with_help(format!("give one of them another number; the first is entries[{first}]")));
            }
            let head = entry.head();
            if head.number.is_empty() || head.number.contains(|c: char| c == ',' || c.is_whitespace()) {
                let message = format!("{} is no number of an entry", quoted(head.number));
                let fault = self.fault(&format!("entries[{k}].number"), message);
                return Err(fault.with_help("write it without commas and blanks, as in `4.12`"));
            }
            let without = chapters.is_empty() && head.chapter.is_empty();
            if !without && !chapters.contains(&head.chapter) {
                let message = format!("there is no chapter {}", quoted(head.chapter));
                let fault = self.fault(&format!("entries[{k}].chapter"), message);
                return Err(match chapters.as_slice() {
                    [] => fault.with_help("add it to `[[chapters]]`, with `number` and `title`"),
                    _ => fault.with_help(format!("choose one of {}", chapters.join(", "))),
                });
            }
        }
        Ok(())
    }

    /// A fault at a path such as `entries[3].runs[0].set.speed`.
    pub(super) fn fault(&self, path: &str, message: impl Into<String>) -> Fault {
        self.document.fault_at(path, message)
    }

    /// The entries that are asked for, by number in the file; all of them without `only`.
    ///
    /// # Errors
    /// A name that no entry has.
    pub(crate) fn chosen(&self, only: &[String]) -> Result<Vec<usize>, Fault> {
        let names: Vec<String> = self.atlas.entries.iter().map(Entry::name).collect();
        if only.is_empty() {
            return Ok((0..names.len()).collect());
        }
        let mut chosen = vec![false; names.len()];
        for word in only {
            let wanted = word.strip_prefix("figure-").unwrap_or(word);
            match names.iter().position(|n| n == wanted) {
                Some(k) => chosen[k] = true,
                None => {
                    let fault = Fault::new(format!("{} has no entry {}", quoted(&self.name), quoted(word)));
                    let guess = did_you_mean(wanted, &names);
                    let other = || format!("`ropewalk atlas {} --list` shows all", self.name);
                    return Err(fault.with_help(guess.unwrap_or_else(other)));
                }
            }
        }
        Ok((0..names.len()).filter(|k| chosen[*k]).collect())
    }

    /// A line for each entry, by chapter.
    pub fn list(&self) -> String {
        let mut out = format!("{}\n", self.atlas.title);
        let wide = self.atlas.entries.iter().map(|e| e.name().chars().count()).max().unwrap_or(0);
        let mut chapter = None;
        for entry in self.in_order() {
            let head = self.atlas.entries[entry].head();
            if chapter != Some(head.chapter) {
                chapter = Some(head.chapter);
                out += &format!("\n{}\n", self.chapter_title(head.chapter));
            }
            let why = match &self.atlas.entries[entry] {
                Entry::Other(o) => format!(" (not computed: {})", o.what.words()),
                _ => String::new(),
            };
            out += &format!("  {:<wide$}  {}{why}\n", self.atlas.entries[entry].name(), head.title);
        }
        out
    }

    /// All entries, chapter by chapter.
    pub(super) fn in_order(&self) -> Vec<usize> {
        let all = &self.atlas.entries;
        let of =
            |chapter: &str| (0..all.len()).filter(|k| all[*k].head().chapter == chapter).collect::<Vec<_>>();
        let chapters = self.atlas.chapters.iter().map(|c| c.number.as_str());
        let without = Some("").filter(|_| self.atlas.chapters.is_empty());
        without.into_iter().chain(chapters).flat_map(of).collect()
    }

    /// `4 Evasive manoeuvres`
    pub(super) fn chapter_title(&self, number: &str) -> String {
        let found = self.atlas.chapters.iter().find(|c| c.number == number);
        found.map_or_else(String::new, |c| format!("{} {}", c.number, c.title))
    }
}
