//! `ropewalk book [PAGE]`: the pages of the book, compiled in, as plain text.
//!
//! Not the gallery, which is `ropewalk list --gallery`, nor the reference, which is `ropewalk describe`.

use super::{Exit, say};
use ropewalk_models::gallery;
use ropewalk_scene::{Fault, did_you_mean, quoted};
pub use ropewalk_studies::Error;

/// A text and the path by which pages include it, or the name of a page.
type Text = (&'static str, &'static str);

/// `book/src/NAME.md`.
macro_rules! pages {
    ($($name:literal),* $(,)?) => {
        &[$(($name, include_str!(concat!("../../book/src/", $name, ".md")))),*]
    };
}

/// Files by their paths in `book/src`.
macro_rules! files {
    ($($path:literal),* $(,)?) => {
        &[$(($path, include_str!(concat!("../../book/src/", $path)))),*]
    };
}

/// In the order of the book.
const PAGES: &[Text] = pages![
    "index",
    "first-steps",
    "towed-line",
    "mooring",
    "mechanism",
    "flexible-arm",
    "controlled-crane",
    "rust",
    "questions",
    "winch",
    "reeving",
    "eyelet",
    "contact",
    "joints",
    "internal-flow",
    "equilibria",
    "sweeps",
    "accuracy",
    "effects",
    "checkpoints",
    "results",
    "python",
    "editors",
    "failures",
    "films",
    "thesis",
    "equations",
    "cable-theory",
    "water-theory",
    "contact-theory",
    "unwinding-theory",
    "coming-from",
    "comparison",
    "verification",
    "measured",
    "speed",
];

/// What pages include.
const INCLUDED: &[Text] = files![
    "controlled-crane.in/trolley.toml",
    "first-steps.in/line.toml",
    "flexible-arm.in/arm.toml",
    "joints.in/segments.toml",
    "mooring.in/chain.toml",
    "towed-line.in/steady.toml",
    "towed-line.in/tow.toml",
    "../../CONTRIBUTING.md",
];

/// Prints a page, those that speak of a word, or what pages there are.
pub(crate) fn book(wanted: Option<&str>) -> Result<Exit, Error> {
    let Some(wanted) = wanted else {
        let wide = PAGES.iter().map(|p| p.0.len()).max().unwrap_or(0);
        let list: Vec<String> =
            PAGES.iter().map(|(name, text)| format!("  {name:<wide$}  {}", title(text))).collect();
        say(format!(
            "{}\n\n`ropewalk book PAGE` prints one, `ropewalk book WORD` finds those that speak of a word.",
            list.join("\n")
        ));
        return Ok(Exit::Done);
    };
    let name = wanted.trim().trim_end_matches(".md");
    if let Some(text) = page(&name.to_lowercase()) {
        say(text.trim_end());
        return Ok(Exit::Done);
    }
    let found = places(name);
    if found.is_empty() {
        let names: Vec<&str> = PAGES.iter().map(|p| p.0).collect();
        let fault = Fault::new(format!("no page of the book is called {0} or speaks of it", quoted(name)));
        let help = did_you_mean(name, &names);
        return Err(fault.with_help(help.unwrap_or_else(|| "`ropewalk book` lists the pages".into())).into());
    }
    say(found.join("\n"));
    Ok(Exit::Done)
}

/// The text of a page, with what it includes.
pub(super) fn page(name: &str) -> Option<String> {
    let (_, text) = PAGES.iter().find(|p| p.0 == name)?;
    let mut out = String::new();
    // comments mark what is made
    for line in text.lines().filter(|line| !line.starts_with("<!--")) {
        match line.strip_prefix("{{#include ").and_then(|rest| rest.strip_suffix("}}")) {
            Some(what) => out += &included(what),
            None => out += line,
        }
        out.push('\n');
    }
    Some(out)
}

/// The pages that speak of a word, each with the headings under which they do.
fn places(word: &str) -> Vec<String> {
    let word = word.to_lowercase();
    let mut found = Vec::new();
    for (name, text) in PAGES.iter().filter(|_| !word.trim().is_empty()) {
        let (mut heading, mut headings) = ("", Vec::new());
        let mut fenced = false;
        for line in text.lines() {
            fenced ^= line.starts_with("```");
            if !fenced && line.starts_with('#') {
                heading = line.trim_start_matches('#').trim();
            }
            if line.to_lowercase().contains(&word) && headings.last() != Some(&heading) {
                headings.push(heading);
            }
        }
        if !headings.is_empty() {
            found.push(format!("ropewalk book {name:<18}{}", headings.join("; ")));
        }
    }
    found
}

fn title(text: &str) -> &str {
    text.lines().find_map(|line| line.strip_prefix("# ")).unwrap_or_default()
}

/// `path`, `path:from:to` by lines, or `path:anchor`.
fn included(what: &str) -> String {
    let mut parts = what.split(':');
    let path = parts.next().unwrap_or_default();
    // scenes of the gallery are in a crate of their own
    let scene = path.strip_prefix("../../models/gallery/").and_then(|name| name.strip_suffix(".toml"));
    let scene = scene.and_then(|name| gallery().iter().find(|b| b.name == name)).map(|b| b.text);
    let text = scene.or_else(|| INCLUDED.iter().find(|f| f.0 == path).map(|f| f.1));
    let Some(text) = text else { return format!("(see {what})") };
    let lines: Vec<&str> = text.lines().collect();
    let (from, to) = match (parts.next(), parts.next()) {
        (None, _) => (0, lines.len()),
        (Some(anchor), None) => {
            let at = |mark: String| lines.iter().position(|line| line.contains(&mark));
            let from = at(format!("ANCHOR: {anchor}")).map_or(0, |k| k + 1);
            (from, at(format!("ANCHOR_END: {anchor}")).unwrap_or(lines.len()))
        }
        (Some(from), Some(to)) => {
            let number = |text: &str| text.parse::<usize>().ok();
            (
                number(from).map_or(0, |k| k.saturating_sub(1)),
                number(to).unwrap_or(lines.len()).min(lines.len()),
            )
        }
    };
    lines.get(from..to).unwrap_or_default().join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    const SUMMARY: &str = include_str!("../../book/src/SUMMARY.md");

    #[test]
    fn all_pages_are_here_and_whole() {
        let pages =
            SUMMARY.split("](").skip(1).filter_map(|rest| rest.split_once(".md)")).map(|(name, _)| name);
        let pages: Vec<&str> =
            pages.filter(|name| *name != "gallery" && !name.starts_with("reference/")).collect();
        assert_eq!(pages, PAGES.iter().map(|p| p.0).collect::<Vec<_>>(), "in the order of SUMMARY.md");
        for (name, _) in PAGES {
            let text = page(name).expect("a page");
            assert!(text.starts_with("# ") && !text.contains("{{#include"), "{name}");
            assert!(!text.contains("\n(see "), "{name} includes what isn't in INCLUDED");
        }
    }

    #[test]
    fn parts_of_files_are_included() {
        assert_eq!(included("first-steps.in/line.toml:3:4").lines().count(), 2);
        let recipes = included("../../CONTRIBUTING.md:recipes");
        assert!(recipes.starts_with("## Add a force") && !recipes.contains("ANCHOR"), "{recipes}");
        assert_eq!(included("nowhere.toml"), "(see nowhere.toml)");
    }

    #[test]
    fn words_lead_to_pages() {
        assert!(places("payout").iter().any(|line| line.contains("ropewalk book winch")));
        assert!(places("  ").is_empty() && places("zeppelin").is_empty());
    }
}
