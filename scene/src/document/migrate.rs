//! Scenes of version 0.1 in the words of today.
//!
//! Only the bytes of a name are replaced, so that comments, order and layout stay as they are.

use super::fault::Fault;
use super::moved::{self, COLUMNS, Edit, Found, Reach};
use super::read::Format;
use super::source::{Sources, Span};
use super::value::{Table, Value};
use super::{json, parameters, toml};
use std::ops::Range;

/// A scene in the words of today, and what was changed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Migrated {
    /// The text; that which was given where nothing is to be changed.
    pub text: String,
    /// What was changed, in the order of the file.
    pub changes: Vec<Rewrite>,
    /// What is left to be done by hand, each with its place.
    pub left: Vec<Fault>,
}

/// A change of a scene file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Rewrite {
    /// The line of the old text, from 1.
    pub line: usize,
    /// What stood there.
    pub was: String,
    /// What stands there now; empty if it went.
    pub now: String,
}

/// Writes a scene of version 0.1 in the words of today; `name` is what messages call it.
///
/// A scene that is in those words already stays as it is, byte for byte.
///
/// # Errors
/// The text is not TOML or JSON, or a scene that can't be rewritten with certainty.
pub fn migrate(text: &str, name: &str, format: Format) -> Result<Migrated, Fault> {
    // an editor's mark stays where it is
    let body = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mark = &text[..text.len() - body.len()];
    let mut sources = Sources::default();
    let source = sources.add(name, body);
    let tree = parse(body, source, format, &sources)?;
    let mut scene = Migration { text: body, format, edits: Vec::new(), left: Vec::new(), sources: &sources };
    if let Some(root) = tree.as_table() {
        scene.collect(root)?;
    }
    let Migration { edits, left, .. } = scene;
    if edits.is_empty() {
        return Ok(Migrated { text: text.to_string(), changes: Vec::new(), left });
    }
    let (new, changes) = apply(body, edits);
    let mut sources = Sources::default();
    let source = sources.add(name, &new);
    // a name that stands in several dotted keys is found at the first alone
    let again = parse(&new, source, format, &sources).map(|tree| tree.as_table().map_or(0, certain));
    match again {
        Ok(0) => Ok(Migrated { text: format!("{mark}{new}"), changes, left }),
        _ => Err(Fault::new(format!(
            "`{name}` can't be rewritten with certainty: write tables that stand in several pieces as one"
        ))),
    }
}

fn parse(text: &str, source: usize, format: Format, sources: &Sources) -> Result<Value, Fault> {
    match format {
        Format::Toml => toml::parse(text, source, sources),
        Format::Json => json::parse(text, source, sources),
    }
}

/// The lists of a scene that hold parts.
fn sections(root: &Table) -> impl Iterator<Item = (&str, &Value)> {
    const SECTIONS: [&str; 6] = ["elements", "constraints", "forces", "motions", "records", "processes"];
    let of_parts = |name: &&str| SECTIONS.contains(name);
    root.iter().map(|(key, value)| (key.name.as_str(), value)).filter(move |(name, _)| of_parts(name))
}

fn reach(root: &Table) -> Reach<'_> {
    const NONE: &Table = &Table(Vec::new());
    Reach { parameters: Some(root.get(parameters::TABLE).and_then(Value::as_table).unwrap_or(NONE)) }
}

/// How many names of version 0.1 are left that have one of today.
fn certain(root: &Table) -> usize {
    let reach = reach(root);
    let all = sections(root).flat_map(|(name, list)| moved::found(name, list, &reach));
    all.filter(|f| matches!(f.edit, Edit::Rename(_))).count()
}

struct Migration<'a> {
    text: &'a str,
    format: Format,
    edits: Vec<(Range<usize>, String)>,
    left: Vec<Fault>,
    sources: &'a Sources,
}

/// Where gravity was given: the key, its value, and whether the part has a `weight` instead now.
type Pull<'a> = (Span, &'a Value, bool);

impl Migration<'_> {
    fn collect(&mut self, root: &Table) -> Result<(), Fault> {
        let reach = reach(root);
        let mut pulls: Vec<Pull<'_>> = Vec::new();
        for (name, list) in sections(root) {
            for found in moved::found(name, list, &reach) {
                match found.edit {
                    Edit::Rename(new) => self.rename(found.span, new),
                    Edit::Gravity { key, value, weight } => pulls.push((key.span, value, weight)),
                    Edit::None => self.left.push(self.by_hand(&found)),
                }
            }
        }
        self.columns(root, &reach);
        self.gravity(root, &reach, &pulls);
        if !self.edits.is_empty() {
            self.lone_clamps(root, &reach);
        }
        Ok(())
    }

    fn by_hand(&self, found: &Found<'_>) -> Fault {
        let mut fault = Fault::at(&found.message, found.span, self.sources).with_path(&found.path);
        fault.help = found.help.map(str::to_string);
        fault
    }

    /// Replaces a name and leaves its quotes.
    fn rename(&mut self, span: Span, new: &str) {
        let range = span.range();
        let old = &self.text[range.clone()];
        let quote = old.chars().next().filter(|c| matches!(c, '"' | '\''));
        let new = quote.map_or_else(|| new.to_string(), |q| format!("{q}{new}{q}"));
        self.edit(range, new);
    }

    fn edit(&mut self, range: Range<usize>, new: String) {
        // a parameter that is used twice is written once
        if !self.edits.iter().any(|(r, _)| *r == range) {
            self.edits.push((range, new));
        }
    }

    /// Names of columns in the tables of the run.
    fn columns(&mut self, root: &Table, reach: &Reach<'_>) {
        let records = root.get("records").map(|list| reach.parts(list)).unwrap_or_default();
        let of_winches = records
            .into_iter()
            .map(|(_, part)| part)
            .filter(|part| reach.texts(part, "type").iter().any(|(kind, _)| *kind == "feeding"));
        let stems: Vec<String> = of_winches
            .flat_map(|part| {
                let names = reach.texts(part, "name");
                if names.is_empty() { reach.texts(part, "of") } else { names }
            })
            .map(|(stem, _)| stem.trim().to_string())
            .collect();
        let tables = root.get("run").and_then(Value::as_table).and_then(|run| run.get("tables"));
        for (_, table) in tables.map(|list| reach.parts(list)).unwrap_or_default() {
            let Some(columns) = table.get("columns") else { continue };
            let lists = reach.of(columns).into_iter().filter_map(|v| match &v.kind {
                super::Kind::Array(list) => Some(list),
                _ => None,
            });
            for column in lists.flatten().flat_map(|column| reach.of(column)) {
                let Some((stem, last)) = column.as_str().and_then(|text| text.rsplit_once('.')) else {
                    continue;
                };
                let new = COLUMNS.iter().find(|(old, _)| *old == last).map(|(_, new)| new);
                let range = column.span.range();
                // the quote behind it has one byte
                let (end, plain) = (range.end - 1, self.text[range.clone()].get(1..).unwrap_or_default());
                let plain = plain.starts_with(stem) && self.text[..end].ends_with(last);
                if let Some(new) = new.filter(|_| plain && stems.iter().any(|s| s == stem)) {
                    self.edit(end - last.len()..end, (*new).to_string());
                }
            }
        }
    }

    /// Moves the gravity of single parts to the scene, where all say the same.
    fn gravity(&mut self, root: &Table, reach: &Reach<'_>, pulls: &[Pull<'_>]) {
        let Some(&(first, value, _)) = pulls.first() else { return };
        let text = |v: &Value| self.text[v.span.range()].to_string();
        let kinds = ["gravity", "buoyancy"];
        let forces = root.get("forces").map(|list| reach.parts(list)).unwrap_or_default();
        let silent = forces.iter().any(|(_, part)| {
            let felt = reach.texts(part, "type").iter().any(|(kind, _)| kinds.contains(kind));
            felt && part.get("g").is_none()
        });
        let one = pulls.iter().all(|(_, v, _)| text(v) == text(value));
        let own = root.get("gravity").map(text);
        let clash = own.as_ref().is_some_and(|own| *own != text(value));
        if !one || silent || clash || value.used.is_some() {
            let message = "gravity belongs to the scene, and its parts don't all give the same one here";
            let help = "write `gravity = [0, 0, -9.81]` above the first section, and leave `g` out";
            self.left.push(Fault::at(message, first, self.sources).with_help(help));
            return;
        }
        for (key, value, weight) in pulls {
            let whole = key.range().start..value.span.range().end;
            if *weight {
                let quoted = if self.format == Format::Json { "\"weight\": true" } else { "weight = true" };
                self.edit(whole, quoted.into());
            } else {
                let range = without(self.text, whole);
                self.edit(range, String::new());
            }
        }
        if own.is_none() {
            self.add_gravity(root, &text(value));
        }
    }

    /// Writes the scene's gravity below the last of its own keys.
    fn add_gravity(&mut self, root: &Table, value: &str) {
        let text = self.text;
        let line = |at: usize| text[..at].rfind('\n').map_or(0, |i| i + 1);
        let end = if text.contains("\r\n") { "\r\n" } else { "\n" };
        let own = |name: &str| matches!(name, "title" | "description" | "$schema");
        let last =
            root.iter().filter(|(key, _)| own(&key.name)).max_by_key(|(key, _)| key.span.range().start);
        let (at, new) = match (self.format, last) {
            (Format::Toml, Some((_, v))) => {
                let from = v.span.range().end;
                let at = text[from..].find('\n').map_or(text.len(), |i| from + i + 1);
                (at, format!("gravity = {value}{end}"))
            }
            (Format::Toml, None) => {
                let first = root.iter().map(|(key, _)| line(key.span.range().start)).min().unwrap_or(0);
                (first, format!("gravity = {value}{end}{end}"))
            }
            (Format::Json, Some((key, v))) => {
                let start = key.span.range().start;
                let indent = &text[line(start)..start];
                let gap = if indent.trim().is_empty() { format!("{end}{indent}") } else { " ".into() };
                (v.span.range().end, format!(",{gap}\"gravity\": {value}"))
            }
            (Format::Json, None) => {
                let first = root.iter().map(|(key, _)| key.span.range().start).min().unwrap_or(0);
                (first, format!("\"gravity\": {value}, "))
            }
        };
        self.edit(at..at, new);
    }

    /// A clamp beside which nothing holds the position may have been a guide or not.
    fn lone_clamps(&mut self, root: &Table, reach: &Reach<'_>) {
        let parts = root.get("constraints").map(|list| reach.parts(list)).unwrap_or_default();
        for (i, part) in parts {
            for (kind, span) in reach.texts(part, "type") {
                if kind == "clamp" && !self.edits.iter().any(|(r, _)| *r == span.range()) {
                    let message = "a `clamp` holds the position as well now";
                    let help = "write `direction` if this one left the position free";
                    let fault = Fault::at(message, span, self.sources).with_path(format!("constraints[{i}]"));
                    self.left.push(fault.with_help(help));
                }
            }
        }
    }
}

/// What goes with an entry of a table: its line, if nothing else stands there, or the comma beside it.
fn without(text: &str, entry: Range<usize>) -> Range<usize> {
    let Range { mut start, mut end } = entry;
    let spaces = |c: char| c == ' ' || c == '\t';
    let before = text[..start].trim_end_matches(spaces).len();
    let begins = before == 0 || text[..before].ends_with('\n');
    let comma = text[end..].trim_start().starts_with(',');
    if comma {
        end += text[end..].find(',').unwrap_or(0) + 1;
    } else if text[..start].trim_end().ends_with(',') {
        return text[..start].trim_end().len() - 1..end;
    }
    let rest = text[end..].split('\n').next().unwrap_or_default();
    if begins && rest.trim().is_empty() {
        start = before;
        end = (end + rest.len() + 1).min(text.len());
    } else if begins && rest.trim_start().starts_with('#') || comma {
        end += rest.len() - rest.trim_start_matches(spaces).len();
    }
    start..end
}

/// The text with its edits, and what they are for people.
fn apply(text: &str, mut edits: Vec<(Range<usize>, String)>) -> (String, Vec<Rewrite>) {
    edits.sort_by_key(|(range, _)| (range.start, range.end));
    let (mut new, mut changes, mut at) = (String::with_capacity(text.len()), Vec::new(), 0);
    for (range, now) in edits {
        new.push_str(&text[at..range.start]);
        new.push_str(&now);
        at = range.end;
        let was = &text[range.clone()];
        let line = text[..range.start + (was.len() - was.trim_start().len())].matches('\n').count() + 1;
        let plain = |text: &str| text.trim().trim_matches(['"', '\'', ',']).trim().to_string();
        changes.push(Rewrite { line, was: plain(was), now: plain(&now) });
    }
    new.push_str(&text[at..]);
    (new, changes)
}
