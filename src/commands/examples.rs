//! An example of every type and section, with what to look at beside it.
//!
//! Each file of `examples/` is a small scene, followed by examples that complete it, each behind a line
//! `# example: LIST.TYPE` (or `# example: SECTION`) and lines with what to see also: other types, and a page of the book.

use ropewalk_models::Bundled;
use ropewalk_scene::{Document, Format, Kind};
use std::sync::LazyLock;

/// `examples/NAME.toml`.
macro_rules! files {
    ($($name:literal),* $(,)?) => {
        &[$((include_str!(concat!("examples/", $name, ".toml")))),*]
    };
}

const FILES: &[&str] = files![
    "angles",
    "constraints",
    "control",
    "elements",
    "forces",
    "motions",
    "processes",
    "records",
    "sections",
    "unwinding",
];

/// How a type or section is written.
pub(super) struct Example {
    /// The list of the type, such as `constraints`; nothing for a section.
    pub list: &'static str,
    /// The type or section.
    pub name: &'static str,
    /// What it looks like in a scene, with what belongs to it.
    pub text: &'static str,
    /// Other types and sections.
    pub see: Vec<&'static str>,
    /// The page of the book that shows it in use.
    pub page: &'static str,
    /// The rest of a scene that it makes complete.
    #[cfg_attr(not(test), allow(dead_code))]
    pub before: &'static str,
}

/// All examples.
pub(super) fn all() -> &'static [Example] {
    static ALL: LazyLock<Vec<Example>> = LazyLock::new(|| FILES.iter().copied().flat_map(of_file).collect());
    &ALL
}

/// That of a type, by its list and its name, or of a section.
pub(super) fn of(list: &str, name: &str) -> Option<&'static Example> {
    all().iter().find(|e| e.list == list && e.name == name)
}

/// The scenes in which a type is used, at most so many, those of the gallery first: they are the small ones.
pub(super) fn scenes(list: &str, name: &str, bundled: &[Bundled], most: usize) -> Vec<&'static str> {
    let uses = |b: &Bundled| {
        // most of them needn't be parsed to know that they don't
        if !b.text.contains(&format!("\"{name}\"")) {
            return false;
        }
        let Ok(document) = Document::parse(b.text, b.name, Format::Toml, &[]) else { return false };
        let Some(Kind::Array(parts)) = document.get(list).map(|v| &v.kind) else { return false };
        parts.iter().any(|part| {
            part.as_table().and_then(|t| t.get("type")).and_then(|t| t.as_str()).is_some_and(|t| t == name)
        })
    };
    let (large, small): (Vec<&Bundled>, Vec<&Bundled>) =
        bundled.iter().partition(|b| ropewalk_models::bundled().iter().any(|large| large.name == b.name));
    small.into_iter().chain(large).filter(|b| uses(b)).map(|b| b.name).take(most).collect()
}

fn of_file(text: &'static str) -> Vec<Example> {
    let mut parts = text.split("# example: ");
    let before = parts.next().unwrap_or_default();
    parts.map(|part| one(before, part)).collect()
}

fn one(before: &'static str, part: &'static str) -> Example {
    let (title, rest) = part.split_once('\n').unwrap_or((part, ""));
    let (list, name) = title.trim().rsplit_once('.').unwrap_or(("", title.trim()));
    let (see, rest) = marked(rest, "# see: ");
    let (page, text) = marked(rest, "# page: ");
    let see = see.split(',').map(str::trim).filter(|s| !s.is_empty()).collect();
    Example { list, name, text: text.trim_end(), see, page, before }
}

/// What stands behind a mark in the first line, and the lines below; nothing if that line has no such mark.
fn marked<'a>(text: &'a str, mark: &str) -> (&'a str, &'a str) {
    text.strip_prefix(mark).map_or(("", text), |rest| rest.split_once('\n').unwrap_or((rest, "")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use ropewalk_core::{BuildError, V3};
    use ropewalk_scene::functions::{Function, Parameters, Reads, Seen, Trouble, Written, register_function};
    use ropewalk_scene::{SECTIONS, SceneFile, lists, registered};
    use ropewalk_studies::simulate::simulate;
    use std::sync::Arc;

    /// What the examples of functions ask for: no force, no motion.
    #[derive(Debug)]
    struct Nothing;

    impl Function for Nothing {
        fn reads(&self) -> Reads {
            Reads::default()
        }
        fn force(&self, _: f64, _: &Seen) -> Result<[V3<f64>; 2], Trouble> {
            Ok([[0.0; 3]; 2])
        }
        fn motion(&self, _: f64) -> Result<(V3<f64>, [Option<V3<f64>>; 2]), Trouble> {
            Ok(([0.0; 3], [Some([0.0; 3]); 2]))
        }
    }

    impl Written for Nothing {
        fn bind(&self, _: &Parameters) -> Result<Arc<dyn Function>, BuildError> {
            Ok(Arc::new(Nothing))
        }
    }

    #[test]
    #[cfg(feature = "contact")]
    fn every_type_and_section_has_an_example_that_runs() {
        for name in ["gust", "wobble"] {
            register_function(name, Arc::new(Nothing));
        }
        for e in all() {
            let text = format!("{}\n{}\n", e.before, e.text);
            let file = SceneFile::parse(&text, e.name, Format::Toml, &[]);
            let file = file.unwrap_or_else(|fault| panic!("{}: {fault}", e.name));
            let used = match file.document().get(if e.list.is_empty() { e.name } else { e.list }) {
                Some(_) if e.list.is_empty() => true,
                Some(list) => format!("{list:?}").contains(e.name),
                None => false,
            };
            assert!(used, "the example of {} isn't one", e.name);
            let history = simulate(file.scene()).unwrap_or_else(|fault| panic!("{}: {fault}", e.name));
            let last = history.times().last().copied().unwrap_or_default();
            assert!((last - file.scene().run.duration).abs() < 1e-9, "{}", e.name);
        }
        for s in registered() {
            assert!(of(s.kind.list(), s.name).is_some(), "no example of {}", s.name);
        }
        for (name, _) in SECTIONS.iter().chain(&lists()) {
            assert!(of("", name).is_some(), "no example of {name}");
        }
    }

    #[test]
    fn what_to_see_also_is_there() {
        let known = |name: &str| {
            registered().iter().any(|s| s.name == name)
                || SECTIONS.iter().chain(&lists()).any(|s| s.0 == name)
        };
        let without_contact = cfg!(not(feature = "contact"));
        for e in all() {
            assert!(!e.see.is_empty(), "nothing beside {}", e.name);
            for see in &e.see {
                let of_contact = ["contact", "line_contact", "clearance"];
                let fine = known(see) || without_contact && of_contact.contains(see);
                assert!(fine && *see != e.name, "{}: no {see}", e.name);
            }
            assert!(super::super::book::page(e.page).is_some(), "{}: no page {}", e.name, e.page);
        }
    }

    #[test]
    fn scenes_are_found_by_what_they_use() {
        let all = ropewalk_models::scenes();
        assert!(scenes("constraints", "winch", all, 9).contains(&"winch-hoist"));
        assert_eq!(scenes("elements", "cable", all, 2).len(), 2);
        assert!(scenes("forces", "winch", all, 9).is_empty());
    }
}
