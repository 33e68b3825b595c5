//! The reference of the book: a page for each list of a scene file, made from the schemas.

use super::describe::see_also;
use super::{examples, schema};
use ropewalk_models::Bundled;
use ropewalk_scene::schemars::Schema;
use ropewalk_scene::{SECTIONS, SpecKind, lists, registered};

/// Lists and what their pages say first.
const PAGES: [(SpecKind, &str, &str); 7] = [
    (SpecKind::Element, "Elements", "What has mass: cables, bodies and chains."),
    (SpecKind::Constraint, "Constraints", "What holds, joins or drives markers, and what feeds cable."),
    (SpecKind::Force, "Forces", "What acts on everything or on what `on` names, and between markers."),
    (SpecKind::Motion, "Motions", "Ways over time that constraints follow, by name."),
    (SpecKind::Record, "Records", "What is written down: columns of `history.csv`, each with a picture."),
    (SpecKind::Controller, "Controllers", "What sets an input by what records show, at regular instants."),
    (SpecKind::Process, "Processes", "Problems with equations of their own."),
];

const NOTE: &str = "Made from the program: `ropewalk describe NAME` says the same. A number with a unit may be a text that \
                    brings its own, such as `\"25 kn\"`; `\"$name\"` stands for a parameter.";

/// The pages of the reference, each with its path in the book.
pub(crate) fn pages(bundled: &[Bundled]) -> Vec<(String, String)> {
    let mut all = Vec::new();
    for (kind, title, about) in PAGES {
        let mut page =
            format!("# {title}\n\n{about} In a scene file they stand in `[[{}]]`.\n\n{NOTE}\n", kind.list());
        for s in registered().into_iter().filter(|s| s.kind == kind) {
            page += &entry(kind.list(), s.name, s.schema, bundled);
        }
        all.push((format!("reference/{}.md", kind.list()), page));
    }
    let about = "What a scene file has besides its lists of parts; all of it may be left out.";
    let mut page = format!("# Sections and inputs\n\n{about}\n\n{NOTE}\n");
    for (name, schema) in SECTIONS.iter().chain(&lists()) {
        page += &entry("", name, *schema, bundled);
    }
    all.push(("reference/sections.md".into(), page));
    all
}

fn entry(list: &str, name: &str, make: fn() -> Schema, bundled: &[Bundled]) -> String {
    let mut out = format!("\n## {name}\n\n");
    let text = schema::markdown(&make());
    let (about, fields) = text.split_once("\n\n- ").map_or((text.as_str(), None), |(a, f)| (a, Some(f)));
    out += about.trim_end();
    let example = examples::of(list, name);
    if let Some(e) = example {
        out += &format!("\n\n```toml\n{}\n```", e.text);
    }
    if let Some(fields) = fields {
        out += &format!("\n\n- {}", fields.trim_end());
    }
    let scenes = examples::scenes(list, name, bundled, 4);
    let also = see_also(example, &scenes, |page| format!("[the page `{page}`](../{page}.md)"));
    if !also.is_empty() {
        out += &format!("\n\nSee also: {also}.");
    }
    out.push('\n');
    out
}
