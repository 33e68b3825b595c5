//! `ropewalk describe SCENE|TYPE`

use super::examples::{self, Example};
use super::words::{note_on, types_for};
use super::{Exit, first_line, say, schema, wrapped};
use ropewalk_models::Bundled;
use ropewalk_scene::{
    Document, Fault, Format, Kind, Parameter, SECTIONS, SceneFile, SpecInfo, Value, did_you_mean, lists,
    quoted, registered,
};
pub use ropewalk_studies::Error;
use serde_json::json;
use std::path::{Path, is_separator};

pub(crate) fn describe(what: &str, bundled: &[Bundled]) -> Result<Exit, Error> {
    let (text, fault) = explain(what, bundled)?;
    say(text);
    // what is wrong with the scene is said after what it is about
    fault.map_or(Ok(Exit::Done), |fault| Err(fault.into()))
}

/// The explanation, and what is wrong with a scene that is explained all the same.
pub(crate) fn explain(what: &str, bundled: &[Bundled]) -> Result<(String, Option<Fault>), Error> {
    let lower = what.to_lowercase();
    let is_path = what.contains(is_separator) || lower.ends_with(".toml") || lower.ends_with(".json");
    if !is_path && let Some(b) = bundled.iter().find(|b| b.name == what) {
        return Ok(scene(&Document::parse(b.text, b.name, Format::Toml, &[])?, what));
    }
    let types: Vec<&SpecInfo> = registered().into_iter().filter(|s| s.name == what).collect();
    if !is_path && !types.is_empty() {
        let texts: Vec<String> = types.into_iter().map(|s| of_type(s, bundled)).collect();
        return Ok((texts.join("\n\n\n"), None));
    }
    if !is_path && let Some((name, schema)) = SECTIONS.iter().find(|(name, _)| *name == what) {
        let text = format!("[{name}]\n\n{}", schema::explain(&schema()));
        return Ok((text + &beside("", name, bundled), None));
    }
    if !is_path && let Some((name, schema)) = lists().into_iter().find(|(name, _)| *name == what) {
        let text = format!("[[{name}]]\n\n{}", schema::explain(&schema()));
        return Ok((text + &beside("", name, bundled), None));
    }
    let see = types_for(what);
    if !is_path && let Some(first) = see.first() {
        let names: Vec<String> = see.iter().map(|name| format!("`{name}`")).collect();
        let (text, _) = explain(first, bundled)?;
        let note = note_on(what).map_or_else(String::new, |note| format!("\n{}", wrapped(note, 0)));
        return Ok((format!("{what}: see {}\n{note}\n{text}", names.join(", ")), None));
    }
    if !is_path && !Path::new(what).exists() {
        return Err(unknown(what, bundled).into());
    }
    Ok(scene(&Document::read(Path::new(what), &[])?, what))
}

/// Prints the JSON schemas of the types of a name, or of a section, or of all of them, each with its example.
pub(crate) fn schemas(what: Option<&str>, bundled: &[Bundled]) -> Result<Exit, Error> {
    let of = |names: &[&str]| -> Vec<serde_json::Value> {
        let wanted = |name: &str| names.is_empty() || names.contains(&name);
        let types = registered().into_iter().filter(|s| wanted(s.name)).map(|s| {
            let mut one = json!({"list": s.kind.list(), "type": s.name, "schema": (s.schema)()});
            add_example(&mut one, s.kind.list(), s.name, bundled);
            one
        });
        let lists = lists();
        let sections = SECTIONS.iter().chain(&lists).filter(|s| wanted(s.0)).map(|(name, schema)| {
            let mut one = json!({"section": name, "schema": schema()});
            add_example(&mut one, "", name, bundled);
            one
        });
        types.chain(sections).collect()
    };
    let found = match what {
        None => of(&[]),
        Some(what) => match of(&[what]) {
            none if none.is_empty() && !types_for(what).is_empty() => of(types_for(what)),
            found => found,
        },
    };
    match found.as_slice() {
        [] => Err(unknown(what.unwrap_or_default(), bundled).into()),
        [one] => {
            say(format!("{one:#}"));
            Ok(Exit::Done)
        }
        all => {
            say(format!("{:#}", json!(all)));
            Ok(Exit::Done)
        }
    }
}

fn add_example(one: &mut serde_json::Value, list: &str, name: &str, bundled: &[Bundled]) {
    if let Some(e) = examples::of(list, name) {
        one["example"] = json!(e.text);
        let scenes = examples::scenes(list, name, bundled, usize::MAX);
        one["see_also"] = json!({"types": e.see, "scenes": scenes, "page": e.page});
    }
}

fn of_type(s: &SpecInfo, bundled: &[Bundled]) -> String {
    let head = format!("[[{}]]\ntype = \"{}\"", s.kind.list(), s.name);
    let text = format!("{head}\n\n{}", schema::explain(&(s.schema)()));
    text + &beside(s.kind.list(), s.name, bundled)
}

/// How a type or section is written, and what to look at beside it; ends without a line break.
fn beside(list: &str, name: &str, bundled: &[Bundled]) -> String {
    let example = examples::of(list, name);
    let mut out = String::new();
    if let Some(e) = example {
        let lines: Vec<String> = e.text.lines().map(|line| format!("    {line}")).collect();
        out += &format!("\nExample:\n\n{}\n", lines.join("\n").replace("    \n", "\n"));
    }
    let also = see_also(example, &examples::scenes(list, name, bundled, 4), |page| {
        format!("`ropewalk book {page}`")
    });
    if !also.is_empty() {
        out += &format!("\nSee also: {}", wrapped(&also, 0));
    }
    out.trim_end().to_string()
}

/// Types, scenes and the page of the book, in words.
pub(super) fn see_also(example: Option<&Example>, scenes: &[&str], page: impl Fn(&str) -> String) -> String {
    let quoted = |names: &[&str]| names.iter().map(|n| format!("`{n}`")).collect::<Vec<_>>().join(", ");
    let mut parts = Vec::new();
    if let Some(e) = example {
        parts.push(quoted(&e.see));
    }
    match scenes {
        [] => {}
        [one] => parts.push(format!("the scene `{one}`")),
        many => parts.push(format!("the scenes {}", quoted(many))),
    }
    if let Some(e) = example {
        parts.push(page(e.page));
    }
    parts.join("; ")
}

/// Title, description, parameters and parts of a scene.
fn scene(document: &Document, name: &str) -> (String, Option<Fault>) {
    let text = |key: &str| document.get(key).and_then(Value::as_str).unwrap_or_default();
    let mut out = match text("title") {
        "" => format!("{name}\n"),
        title => format!("{title}\n"),
    };
    let description = text("description");
    if !description.trim().is_empty() {
        out += &format!("\n{}", wrapped(description.trim(), 0));
    }
    if !document.parameters().is_empty() {
        out += "\nparameters\n";
        let wide = document.parameters().iter().map(|p| label(p).chars().count()).max().unwrap_or(0);
        for p in document.parameters() {
            let description = p.description.as_deref().unwrap_or_default();
            out += format!("  {:<wide$}  {description}", label(p)).trim_end();
            out.push('\n');
        }
    }
    for list in
        ["elements", "constraints", "forces", "motions", "inputs", "controllers", "records", "processes"]
    {
        let Some(Kind::Array(parts)) = document.get(list).map(|v| &v.kind) else { continue };
        if !parts.is_empty() {
            out += &format!("\n{list}\n");
        }
        for part in parts {
            out += format!("  {}", of_part(part)).trim_end();
            out.push('\n');
        }
    }
    let sections: Vec<&str> = SECTIONS.iter().map(|s| s.0).filter(|s| document.get(s).is_some()).collect();
    if !sections.is_empty() {
        out += &format!("\nsections: {}\n", sections.join(", "));
    }
    let fault = SceneFile::parse(&document.to_toml(), name, Format::Toml, &[]).err();
    (out.trim_end().to_string(), fault)
}

fn label(p: &Parameter) -> String {
    format!("{} = {}", p.name, shown(&p.value))
}

/// A part by its type, its name, and what it holds or acts on.
fn of_part(part: &Value) -> String {
    let Some(table) = part.as_table() else { return String::new() };
    let get = |key: &str| table.get(key).map(shown);
    let kind = table.get("type").and_then(Value::as_str).unwrap_or("?");
    let mut line = match table.get("name").and_then(Value::as_str) {
        // entries of a list that holds one type have a name and no type
        Some(name) if table.get("type").is_none() => name.to_string(),
        Some(name) => format!("{name} ({kind})"),
        None => kind.to_string(),
    };
    for key in ["of", "marker", "to", "on", "between", "motion", "input", "unit"] {
        if let Some(value) = get(key) {
            line += &format!(", {key} {value}");
        }
    }
    line
}

/// A value on one line.
fn shown(value: &Value) -> String {
    match &value.kind {
        Kind::Null => "none".into(),
        Kind::Bool(b) => b.to_string(),
        Kind::Integer(i) => i.to_string(),
        Kind::Float(x) => format!("{x:?}"),
        Kind::String(s) => first_line(s),
        Kind::Array(list) => format!("[{}]", list.iter().map(shown).collect::<Vec<_>>().join(", ")),
        Kind::Table(table) => {
            let entries: Vec<String> =
                table.iter().map(|(k, v)| format!("{} = {}", k.name, shown(v))).collect();
            format!("{{ {} }}", entries.join(", "))
        }
    }
}

fn unknown(what: &str, bundled: &[Bundled]) -> Fault {
    let mut names: Vec<&str> = bundled.iter().map(|b| b.name).collect();
    names.extend(registered().iter().map(|s| s.name));
    names.extend(SECTIONS.iter().chain(&lists()).map(|s| s.0));
    let fault = Fault::new(format!("there is no scene, type or section {}", quoted(what)));
    match did_you_mean(what, &names) {
        Some(guess) => fault.with_help(guess),
        None => fault.with_help("`ropewalk list` shows what there is"),
    }
}
