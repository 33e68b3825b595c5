//! `ropewalk list`

use super::{Exit, first_line, say, schema};
use ropewalk_models::{Bundled, atlases, gallery};
use ropewalk_scene::{Document, Format, SpecKind, registered};
pub use ropewalk_studies::Error;

/// The kinds of types, in the order of a scene file.
const KINDS: [SpecKind; 7] = [
    SpecKind::Element,
    SpecKind::Constraint,
    SpecKind::Force,
    SpecKind::Motion,
    SpecKind::Record,
    SpecKind::Controller,
    SpecKind::Process,
];

pub(crate) fn list(bundled: &[Bundled], of_gallery: bool) -> Result<Exit, Error> {
    let mut out = String::new();
    if of_gallery {
        let scenes: Vec<(&str, String)> = gallery().iter().map(|b| (b.name, title(b))).collect();
        section(&mut out, "gallery", &scenes);
        out += "`ropewalk describe NAME` explains one, `ropewalk run NAME` runs it, `ropewalk new MINE --from NAME` copies it.";
        say(out);
        return Ok(Exit::Done);
    }
    let own = bundled.iter().filter(|b| !gallery().iter().any(|g| g.name == b.name));
    let scenes: Vec<(&str, String)> = own.map(|b| (b.name, title(b))).collect();
    section(&mut out, "scenes", &scenes);
    let atlases: Vec<(&str, String)> = atlases().iter().map(|b| (b.name, title(b))).collect();
    section(&mut out, "atlases", &atlases);
    for kind in KINDS {
        let types = registered().into_iter().filter(|s| s.kind == kind);
        let types: Vec<(&str, String)> = types
            .map(|s| {
                let about = (s.schema)();
                let doc = about.get("description").and_then(|d| d.as_str()).unwrap_or_default().to_string();
                (s.name, first_line(&schema::plain(&doc)))
            })
            .collect();
        section(&mut out, kind.list(), &types);
    }
    out +=
        "`ropewalk describe NAME` explains a scene or a type, `ropewalk list --gallery` has smaller scenes.";
    say(out);
    Ok(Exit::Done)
}

fn title(b: &Bundled) -> String {
    let title = Document::parse(b.text, b.name, Format::Toml, &[])
        .ok()
        .and_then(|mut d| d.take::<String>("title").ok().flatten());
    title.unwrap_or_default()
}

fn section(out: &mut String, heading: &str, lines: &[(&str, String)]) {
    if lines.is_empty() {
        return;
    }
    let wide = lines.iter().map(|(name, _)| name.chars().count()).max().unwrap_or(0);
    *out += &format!("{heading}\n");
    for (name, text) in lines {
        *out += format!("  {name:<wide$}  {text}").trim_end();
        out.push('\n');
    }
    out.push('\n');
}
