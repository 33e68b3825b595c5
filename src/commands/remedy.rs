//! Where to read on about an error: a type, or a page of the book.

use ropewalk_core::integrator::StepError;
use ropewalk_core::modes::ModesError;
use ropewalk_scene::{Document, Fault, SECTIONS, lists};
pub use ropewalk_studies::Error;
use std::path::Path;

/// The command that prints what helps; nothing where the message says all.
pub(crate) fn see(e: &Error) -> Option<String> {
    let page = match e {
        Error::File(fault) => return about(fault).map(|what| format!("`ropewalk describe {what}`")),
        Error::Step(StepError::Contradiction { .. } | StepError::Inconsistent(_)) => "joints",
        Error::Step(_) => FAILED,
        Error::Statics(_) | Error::Modes(ModesError::Unsteady(_) | ModesError::Moving { .. }) => "equilibria",
        _ => return None,
    };
    Some(format!("`ropewalk book {page}`"))
}

/// The page about runs that end before their time.
pub(crate) const FAILED: &str = "failures";

/// The type or section that a fault of a scene is about.
fn about(fault: &Fault) -> Option<String> {
    let head = fault.path.split(['.', '[']).next().filter(|head| !head.is_empty())?;
    if SECTIONS.iter().chain(&lists()).any(|s| s.0 == head) {
        return Some(head.into());
    }
    // the part has to be looked up: the fault says where it stands, not what it is
    let number: usize = fault.path.strip_prefix(head)?.strip_prefix('[')?.split(']').next()?.parse().ok()?;
    // a type that isn't known has its guess
    if fault.path.ends_with(".type") {
        return None;
    }
    let document = Document::read(Path::new(&fault.place.as_ref()?.file), &[]).ok()?;
    let part = match &document.get(head)?.kind {
        ropewalk_scene::Kind::Array(parts) => parts.get(number)?,
        _ => return None,
    };
    part.as_table()?.get("type")?.as_str().map(str::to_string)
}

#[cfg(test)]
mod tests {
    use super::*;
    use ropewalk_scene::{Format, SceneFile};

    #[test]
    fn errors_lead_to_what_helps() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scene.toml");
        let see_of = |text: &str| {
            std::fs::write(&path, text).unwrap();
            let file = SceneFile::open(&path.to_string_lossy(), &[], &[]);
            see(&file.expect_err("a fault").into())
        };
        assert_eq!(see_of("[run]\nduratoin = 1\n").as_deref(), Some("`ropewalk describe run`"));
        let part = "[[forces]]\ntype = \"gravity\"\n[[forces]]\ntype = \"drag\"\ncnn = 1\n";
        assert_eq!(see_of(part).as_deref(), Some("`ropewalk describe drag`"));
        // these say all there is to say
        assert_eq!(see_of("[[forces]]\ntype = \"gravitation\"\n"), None);
        assert_eq!(see_of("[run\n"), None);
        let text = SceneFile::parse("runn = 1\n", "s", Format::Toml, &[]);
        assert_eq!(see(&text.expect_err("a fault").into()), None);
    }

    #[test]
    fn pages_are_there() {
        for page in [FAILED, "joints", "equilibria"] {
            assert!(super::super::book::page(page).is_some(), "{page}");
        }
    }
}
