//! The book: every command that it shows is run, and what it shows of its output compared; every scene that it shows runs.
//!
//! A page `book/src/NAME.md` has its commands in blocks ```` ```console ````, and the files that they need in
//! `book/src/NAME.in/`; as there is a folder `NAME.out/` too, each page runs in a copy. `...` stands for lines and `[..]` for characters that differ
//! from run to run. `TRYCMD=overwrite cargo test --test book` writes the output of today into the pages: read the diff.

mod made;
mod shipped;

use std::path::{Path, PathBuf};

fn book() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("book")
}

fn files(folder: &Path, ending: &str, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files(&path, ending, found);
        } else if path.extension().is_some_and(|e| e == ending) {
            found.push(path);
        }
    }
}

#[test]
fn commands_of_the_book_say_what_it_shows() {
    trycmd::TestCases::new()
        // a slow machine shows no line more
        .env("ROPEWALK_PROGRESS", "none")
        .register_bin("ropewalk", Path::new(env!("CARGO_BIN_EXE_ropewalk")))
        .case("book/src/*.md");
}

#[test]
fn scenes_of_the_book_are_right() {
    let mut scenes = Vec::new();
    files(&book(), "toml", &mut scenes);
    scenes.retain(|path| path.file_name().is_some_and(|name| name != "book.toml"));
    assert!(!scenes.is_empty());
    for path in scenes {
        let scene = ropewalk::read(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        scene.build().unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    }
}

#[test]
fn scenes_that_are_also_in_the_gallery_are_the_same() {
    let mut scenes = Vec::new();
    files(&book().join("src"), "toml", &mut scenes);
    for path in scenes {
        let original =
            Path::new(env!("CARGO_MANIFEST_DIR")).join("models/gallery").join(path.file_name().unwrap());
        if original.exists() {
            let [here, there] = [&path, &original].map(|p| std::fs::read_to_string(p).unwrap());
            assert!(here == there, "{} differs from {}", path.display(), original.display());
        }
    }
}

/// The texts between `before` and `after`.
fn between<'a>(text: &'a str, before: &'a str, after: &'a str) -> impl Iterator<Item = &'a str> {
    text.split(before).skip(1).filter_map(move |rest| rest.split(after).next())
}

/// What the headings of a page are called in links.
fn anchors(text: &str) -> Vec<String> {
    let headings =
        text.lines().filter(|line| line.starts_with('#')).map(|line| line.trim_start_matches('#').trim());
    let of = |heading: &str| -> String {
        let kept = heading.chars().filter(|c| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_'));
        kept.map(|c| if c == ' ' { '-' } else { c.to_ascii_lowercase() }).collect()
    };
    headings.map(of).collect()
}

#[test]
fn pages_files_and_links_of_the_book_are_there() {
    let source = book().join("src");
    let mut pages = Vec::new();
    files(&source, "md", &mut pages);
    let summary = std::fs::read_to_string(source.join("SUMMARY.md")).unwrap();
    for page in pages {
        let name = page.strip_prefix(&source).unwrap().to_string_lossy().replace('\\', "/");
        assert!(
            name == "SUMMARY.md" || summary.contains(&format!("({name})")),
            "SUMMARY.md doesn't name {name}"
        );
        let text = std::fs::read_to_string(&page).unwrap();
        let folder = page.parent().unwrap();
        for link in between(&text, "](", ")") {
            let (target, anchor) = link.split_once('#').unwrap_or((link, ""));
            if target.contains("://") {
                continue;
            }
            let file = if target.is_empty() { page.clone() } else { folder.join(target) };
            assert!(file.exists(), "{name}: no {target}");
            if !anchor.is_empty() {
                let there = anchors(&std::fs::read_to_string(&file).unwrap());
                assert!(
                    there.iter().any(|a| a == anchor),
                    "{name}: no #{anchor} in {target}, only {there:?}"
                );
            }
        }
        for include in between(&text, "{{#include ", "}}") {
            let target = include.split(':').next().unwrap().trim();
            assert!(folder.join(target).exists(), "{name}: no {target}");
        }
    }
}

/// Programs of the pages for Rust developers must compile and run: `book/src` is included in the library's documentation
/// tests (`src/lib.rs`, `documents`).
#[test]
fn rust_pages_are_tested_as_documents() {
    let library = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("src/lib.rs")).unwrap();
    let mut pages = Vec::new();
    files(&book().join("src"), "md", &mut pages);
    for page in pages {
        if std::fs::read_to_string(&page).unwrap().contains("```rust") {
            let name = page.file_name().unwrap().to_string_lossy().into_owned();
            assert!(library.contains(&format!("book/src/{name}")), "src/lib.rs doesn't test {name}");
        }
    }
}
