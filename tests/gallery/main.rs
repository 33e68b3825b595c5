//! The scenes of the gallery: each explains itself, runs, and gives what its last lines say is known about its answer.
//!
//! Such a line is a comment, so that the scene remains one that anybody can run:
//!
//! ```text
//! # expect: bob.x @ 0.5 s = 0.25 ± 1e-4   (why)      a column at a time that has a row
//! # expect: bob.x @ end = 0.25 ± 1e-4     (why)      its last value
//! # expect: max bob.x = 0.5 ± 1e-4        (why)      its largest value; min likewise
//! # expect: frequency 1 = 2.5 ± 1e-3      (why)      of a mode, in Hz
//! # expect: critical 1 = 0.987 ± 1e-3     (why)      load factor at which an equilibrium loses its stability
//! ```

mod measured;
mod page;

use ropewalk::{History, Modal, ModesOptions, Scene, modes, read, simulate};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// A line of what is known.
struct Expectation {
    what: What,
    value: f64,
    tolerance: f64,
    line: String,
}

enum What {
    At(String, Option<f64>),
    Largest(String),
    Least(String),
    Frequency(usize),
    Critical(usize),
}

impl Expectation {
    /// `bob.x @ end = 0.25 ± 1e-4   (why)`
    fn parse(line: &str) -> Option<Self> {
        let (what, rest) = line.split_once(" = ")?;
        let (value, rest) = rest.split_once(" ± ")?;
        let (tolerance, why) = rest.split_once(char::is_whitespace)?;
        let why = why.trim();
        if !(why.starts_with('(') && why.ends_with(')') && why.len() > 4) {
            return None;
        }
        Some(Expectation {
            what: What::parse(what.trim())?,
            value: value.trim().parse().ok()?,
            tolerance: tolerance.parse().ok()?,
            line: line.into(),
        })
    }
}

impl What {
    fn parse(text: &str) -> Option<Self> {
        if let Some((column, time)) = text.split_once(" @ ") {
            let time = match time {
                "end" => None,
                time => Some(time.strip_suffix(" s")?.parse().ok()?),
            };
            return Some(What::At(column.into(), time));
        }
        let (kind, of) = text.split_once(' ')?;
        Some(match kind {
            "max" => What::Largest(of.into()),
            "min" => What::Least(of.into()),
            "frequency" => What::Frequency(of.parse().ok()?),
            "critical" => What::Critical(of.parse().ok()?),
            _ => return None,
        })
    }

    /// What the scene gives; `None` if it has no such thing.
    fn of(&self, scene: &Scene, history: &History, modal: &OnceLock<Modal>) -> Option<f64> {
        match self {
            What::At(column, None) => history.last(column),
            What::At(column, Some(t)) => {
                let k = history.times().iter().position(|x| (x - t).abs() < 1e-6)?;
                history.column(column)?.get(k).copied()
            }
            What::Largest(column) => {
                history.column(column)?.iter().copied().reduce(|a, b| if a >= b { a } else { b })
            }
            What::Least(column) => {
                history.column(column)?.iter().copied().reduce(|a, b| if a <= b { a } else { b })
            }
            What::Frequency(n) => {
                let modal = modal
                    .get_or_init(|| modes(scene, &ModesOptions::default()).unwrap_or_else(|e| panic!("{e}")));
                modal.table().column("frequency")?.values.get(n.checked_sub(1)?).copied()
            }
            What::Critical(n) => history.critical.get(n.checked_sub(1)?).map(|c| c.load_factor),
        }
    }
}

fn scenes() -> BTreeMap<String, PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("models/gallery");
    let files = std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path());
    files
        .filter(|path| path.extension().is_some_and(|e| e == "toml"))
        .map(|path| (path.file_stem().unwrap().to_string_lossy().into_owned(), path))
        .collect()
}

fn expectations(name: &str, text: &str) -> Vec<Expectation> {
    text.lines()
        .filter_map(|line| line.strip_prefix("# expect: "))
        .map(|line| Expectation::parse(line).unwrap_or_else(|| panic!("{name}: not an expectation: {line}")))
        .collect()
}

#[test]
fn every_scene_gives_what_is_known_about_it() {
    let (mut off, mut rows) = (Vec::new(), Vec::new());
    for (name, path) in scenes() {
        let expected = expectations(&name, &std::fs::read_to_string(&path).unwrap());
        assert!(!expected.is_empty(), "{name} says nothing about its answer");
        let scene = read(&path).unwrap_or_else(|e| panic!("{name}: {e}"));
        let history = simulate(&scene).unwrap_or_else(|e| panic!("{name}: {e}"));
        let modal = OnceLock::new();
        for one in expected {
            let got = one.what.of(&scene, &history, &modal);
            println!("{name}: {} (got {got:?})", one.line);
            // a NaN is off as well
            if !got.is_some_and(|got| (got - one.value).abs() <= one.tolerance) {
                off.push(format!("{name}: {} (got {got:?})", one.line));
            }
            let (scene, known, tolerance) = (name.clone(), one.value, one.tolerance);
            rows.push(measured::Row {
                scene,
                line: one.line,
                known,
                tolerance,
                got: got.unwrap_or(f64::NAN),
            });
        }
    }
    assert!(off.is_empty(), "{}", off.join("\n"));
    measured::check(&rows);
}

#[test]
fn every_scene_says_what_it_shows_what_to_change_and_what_is_known() {
    let all = scenes();
    assert!(all.len() >= 30, "{}", all.len());
    for (name, path) in all {
        let scene = read(&path).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert!(!scene.title.is_empty(), "{name} has no title");
        for word in ["Shows: ", "Change: ", "Known: "] {
            assert!(scene.description.contains(word), "{name} has no `{word}`");
        }
    }
}

#[test]
fn an_expectation_that_is_off_is_seen() {
    let parse = |line| Expectation::parse(line);
    let at_end = parse("rope.end.z @ end = -1.25 ± 1e-3   (free fall)").unwrap();
    assert!(matches!(&at_end.what, What::At(column, None) if column == "rope.end.z"));
    assert_eq!((at_end.value, at_end.tolerance), (-1.25, 1e-3));
    let at_time = parse("rope.end.z @ 0.5 s = 1 ± 0   (rest)").unwrap();
    assert!(matches!(at_time.what, What::At(_, Some(t)) if t == 0.5));
    for wrong in [
        "rope.end.z @ end = 1",
        "rope.end.z @ end = 1 ± 1e-3",
        "rope.end.z @ 2 = 1 ± 1e-3   (why)",
        "mean a = 1 ± 1   (why)",
    ] {
        assert!(parse(wrong).is_none(), "{wrong}");
    }
}
