//! `index.html`: all entries by chapter, with the settings behind each.

use super::read::AtlasFile;
use super::spec::{Entry, Runs};
use super::table::{escaped, pairs};
use ropewalk_report::StillPage;
use std::path::Path;

/// What became of an entry.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Outcome {
    /// A picture, and what is to be said below it.
    Figure(Vec<String>),
    /// A table as HTML.
    Table(String),
    /// It isn't computed.
    NotComputed,
    /// It wasn't asked for.
    NotAsked,
    /// Some of its runs are missing, or it could not be drawn; and why.
    Missing(String),
}

/// The whole page; `outcomes` are those of the entries in the order of the file.
pub(super) fn page(file: &AtlasFile, outcomes: &[Outcome]) -> String {
    let atlas = &file.atlas;
    let mut page = StillPage::new(&atlas.title, format!("atlas · Ropewalk {}", env!("CARGO_PKG_VERSION")));
    let mut out = String::new();
    for paragraph in atlas.description.split("\n\n").map(str::trim).filter(|p| !p.is_empty()) {
        out += &format!("<p>{}</p>\n", escaped(paragraph));
    }
    if atlas.chapters.len() > 1 {
        out += "<nav aria-label=\"Chapters\">";
        for c in &atlas.chapters {
            out += &format!("<a href=\"#chapter-{0}\">{0} {1}</a> ", escaped(&c.number), escaped(&c.title));
        }
        out += "</nav>\n";
    }
    let mut chapter = None;
    for k in file.in_order() {
        let head = atlas.entries[k].head();
        if chapter != Some(head.chapter) {
            chapter = Some(head.chapter);
            let (number, title) = (escaped(head.chapter), escaped(&file.chapter_title(head.chapter)));
            if !title.is_empty() {
                out += &format!("<h2 id=\"chapter-{number}\">{title}</h2>\n");
            }
        }
        out += &entry(file, k, &outcomes[k]);
    }
    page.raw(&out);
    page.html()
}

fn entry(file: &AtlasFile, k: usize, outcome: &Outcome) -> String {
    let entry = &file.atlas.entries[k];
    let (head, name) = (entry.head(), escaped(&entry.name()));
    let mut out = format!(
        "<section class=\"card\" aria-labelledby=\"{name}\"><h3 id=\"{name}\">{}. {}</h3>\n",
        entry.caption(),
        escaped(head.title)
    );
    let csv = match (outcome, entry) {
        (Outcome::Figure(notes), _) => {
            out += &format!("<img src=\"figures/{name}.svg\" alt=\"{}\">\n", escaped(head.title));
            notes.iter().for_each(|n| out += &format!("<p class=\"note\">{}</p>\n", escaped(n)));
            Some(format!("figures/{name}.csv"))
        }
        (Outcome::Table(html), _) => {
            out += html;
            Some(format!("tables/{name}.csv"))
        }
        (Outcome::NotComputed, Entry::Other(other)) => {
            out += &format!("<p class=\"absent\">Not computed: this is {}.</p>\n", other.what.words());
            None
        }
        (Outcome::Missing(why), _) => {
            out += &format!("<p class=\"absent\">Missing: {}.</p>\n", escaped(why));
            None
        }
        _ => {
            out += "<p class=\"absent\">Not asked for in this call.</p>\n";
            None
        }
    };
    if !head.note.is_empty() {
        out += &format!("<p class=\"note\">{}</p>\n", escaped(head.note));
    }
    let mut settings: Vec<String> = entry.runs().iter().map(|runs| behind(file, runs)).collect();
    settings.extend(csv.map(|path| format!("numbers: <a href=\"{path}\">{path}</a>")));
    if !settings.is_empty() && !matches!(outcome, Outcome::NotAsked) {
        out += &format!("<p class=\"settings\">{}</p>\n", settings.join("<br>"));
    }
    out + "</section>\n"
}

/// The scene of a run and what is set in it.
fn behind(file: &AtlasFile, runs: &Runs) -> String {
    let shared = file.atlas.scenes.get(&runs.scene);
    // where a scene's file lies is nobody's business
    let file_name = |path: &str| Path::new(path).file_name().map(|n| n.to_string_lossy().into_owned());
    let named = shared.and_then(|s| s.scene.clone().or_else(|| file_name(s.file.as_deref()?)));
    let of = named.unwrap_or_else(|| runs.scene.clone());
    let mut parts: Vec<String> = Vec::new();
    for values in shared.iter().map(|s| &s.set).chain([&runs.set]).filter(|v| !v.is_empty()) {
        parts.push(pairs(values));
    }
    for values in shared.iter().map(|s| &s.edit).chain([&runs.edit]).filter(|v| !v.is_empty()) {
        parts.push(format!("changed: {}", pairs(values)));
    }
    if !runs.vary.is_empty() {
        parts.push(format!("varied: {}", pairs(&runs.vary)));
    }
    let scene = format!("scene <b>{}</b>", escaped(&of));
    if parts.is_empty() { scene } else { format!("{scene}: {}", escaped(&parts.join("; "))) }
}
