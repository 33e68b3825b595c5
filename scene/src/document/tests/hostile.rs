//! Whatever the text, the reader answers with a scene or with a fault.

use super::*;
use crate::document::source::boundary;
use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};

fn runner(cases: u32) -> TestRunner {
    TestRunner::new(Config { cases, failure_persistence: None, ..Config::default() })
}

/// Reads, shows what is wrong, and writes what is right.
fn exercise(text: &str, format: Format, set: &[String]) {
    match Document::parse(text, "s", format, set) {
        Err(fault) => assert!(!fault.to_string().is_empty()),
        Ok(mut document) => {
            let written = document.to_toml();
            if let Err(fault) = Document::parse(&written, "w", Format::Toml, &[]) {
                assert!(fault.message.ends_with("is empty"), "{text}\n---\n{written}\n---\n{fault}");
            }
            if let Err(fault) = scene(&mut document) {
                let shown = fault.to_string();
                assert!(!fault.message.is_empty() && fault.place.is_some(), "{shown}");
                assert!(fault.message.len() < 2000 && !fault.message.contains('\n'), "{shown}");
            }
            let _ = document.take::<HashMap<String, Vec<Shape>>>("solver").is_ok();
        }
    }
}

/// Cuts, copies and overwrites pieces of a text, at character boundaries.
fn mutated(text: &str, edits: &[(u8, usize, usize, &str)]) -> String {
    let mut text = text.to_string();
    for &(what, a, b, piece) in edits {
        let a = boundary(&text, a % (text.len() + 1));
        let b = boundary(&text, a + b % 20);
        match what % 4 {
            0 => text.replace_range(a..b, ""),
            1 => text.insert_str(a, piece),
            2 => text.replace_range(a..b, piece),
            _ => {
                let copy = text[a..b].to_string();
                text.insert_str(boundary(&text, (a + b) / 2), &copy);
            }
        }
    }
    text
}

fn edits() -> impl Strategy<Value = Vec<(u8, usize, usize, &'static str)>> {
    let pieces = vec![
        "\"",
        "'",
        "[",
        "]",
        "{",
        "}",
        "[[",
        "]]",
        "=",
        ",",
        ".",
        "$",
        "$$",
        "\n",
        "\r",
        "\0",
        "#",
        "é",
        "🚢",
        "\u{feff}",
        "\\u",
        "\\ud8",
        "nan",
        "inf",
        "-",
        "1e999",
        "null",
        "true",
        "type",
        "\"type\": ",
        "parameters",
        "\"$depth\"",
        "\"$a\"",
        "99999999999999999999",
        " ",
        ":",
        "[elements.section]\n",
        "\"\"\"",
        "1979-05-27",
        "/*",
        "//",
        "//\n",
    ];
    let edit = (any::<u8>(), any::<usize>(), any::<usize>(), prop::sample::select(pieces));
    prop::collection::vec(edit, 1..8)
}

#[test]
fn mutated_toml_never_panics() {
    runner(3_000)
        .run(&edits(), |edits| {
            exercise(&mutated(GOOD, &edits), Format::Toml, &[]);
            Ok(())
        })
        .unwrap();
}

#[test]
fn mutated_json_never_panics() {
    let good = r#"{ "parameters": { "a": 3, "depth": "2 m" }, "solver": { "step": "1 ms" }, "elements": [
        { "type": "cable", "name": "é\u00e9\ud83d\udea2", "from": [0, "$depth", "1 cm"], "section": { "ea": 1e4, "ei": 0.5,
          "shape": { "type": "tube", "bore": 1 } }, "motion": { "type": "sine", "amplitude": null } }, { "type": "weight", "mass": "$a" }] }"#;
    runner(3_000)
        .run(&edits(), |edits| {
            exercise(&mutated(good, &edits), Format::Json, &[]);
            Ok(())
        })
        .unwrap();
}

#[test]
fn any_text_and_any_override_gives_an_answer() {
    runner(1_000)
        .run(&("\\PC{0,60}", "[a-z$=\\[\\]{}\"'0-9. \n]{0,20}"), |(text, set)| {
            exercise(&text, Format::Toml, &[]);
            exercise(&text, Format::Json, &[]);
            exercise(GOOD, Format::Toml, &[format!("depth={set}"), set]);
            Ok(())
        })
        .unwrap_or_else(|e| panic!("{e}"));
}

#[test]
fn deep_and_long_texts_are_survived() {
    let n = 100_000;
    for text in [
        "a = ".to_string() + &"[".repeat(n),
        "a = ".to_string() + &"[".repeat(n) + &"]".repeat(n),
        "a = ".to_string() + &"{a=".repeat(n),
        "a.".repeat(n) + "a = 1",
        format!("[{}a]\nb = 1", "a.".repeat(n)),
        format!("[{}a]\n{}b = {}1{}", "a.".repeat(70), "b.".repeat(70), "[".repeat(70), "]".repeat(70)),
        format!("a = \"{}\"", "$".repeat(n)),
        (0..n).map(|i| format!("k{i} = {i}\n")).collect(),
    ] {
        exercise(&text, Format::Toml, &[]);
    }
    for text in
        ["[".repeat(n), "{\"a\":".repeat(n), format!("{{\"a\": {}1{}}}", "[".repeat(120), "]".repeat(120))]
    {
        exercise(&text, Format::Json, &[]);
    }
}
