//! The page of the gallery in the book, made from the scenes: text by a test, pictures on request.

use crate::scenes;
use ropewalk::read;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The page as it should be.
fn page() -> String {
    let mut page = std::fs::read_to_string(root().join("book/gallery-head.md")).unwrap();
    for (name, path) in scenes() {
        let scene = read(&path).unwrap_or_else(|e| panic!("{name}: {e}"));
        let description = scene
            .description
            .trim()
            .replace("\nChange: ", "\n\nChange: ")
            .replace("\nKnown: ", "\n\nKnown: ");
        write!(page, "\n## {name}\n\n**{}**\n\n![{0}](gallery/{name}.svg)\n\n{description}\n\n", scene.title)
            .unwrap();
        let text = std::fs::read_to_string(&path).unwrap();
        for (what, why) in text.lines().filter_map(|l| l.strip_prefix("# expect: ")?.split_once("   (")) {
            writeln!(page, "- `{what}` ({why}").unwrap();
        }
    }
    page
}

/// `UPDATE=1 cargo test --test gallery` writes it.
#[test]
fn the_page_of_the_book_is_that_of_the_scenes() {
    let file = root().join("book/src/gallery.md");
    if std::env::var_os("UPDATE").is_some() {
        std::fs::write(&file, page()).unwrap();
    }
    assert!(
        std::fs::read_to_string(&file).unwrap() == page(),
        "book/src/gallery.md is out of date: UPDATE=1 cargo test --test gallery"
    );
}

fn picture(name: &str) -> PathBuf {
    root().join(format!("book/src/gallery/{name}.svg"))
}

#[test]
fn every_scene_has_its_place_and_its_picture_in_the_book() {
    let head = std::fs::read_to_string(root().join("book/gallery-head.md")).unwrap();
    for name in scenes().keys() {
        assert!(head.contains(&format!("`{name}`")), "book/gallery-head.md doesn't name {name}");
        assert!(picture(name).exists(), "no picture of {name}: cargo test --test gallery -- --ignored");
    }
}

/// Runs all scenes and takes a picture of each: that of its line `# picture: NAME`, or else the shape from the side, from above,
/// from the end, or the first record.
#[test]
#[ignore = "writes the pictures of the book"]
fn make_the_pictures() {
    let folder = tempfile::tempdir().unwrap();
    for (name, path) in scenes() {
        let out = folder.path().join(&name);
        let mut program = Command::new(env!("CARGO_BIN_EXE_ropewalk"));
        program.arg("run").arg(&path).arg("--out").arg(&out).arg("--quiet");
        assert!(program.status().unwrap().success(), "{name}");
        let plots = out.join("plots");
        let text = std::fs::read_to_string(&path).unwrap();
        let asked = text.lines().filter_map(|line| line.strip_prefix("# picture: "));
        let shapes = asked.chain(["shape_side", "shape_top", "shape_end"]);
        let chosen = shapes
            .map(|name| plots.join(format!("{name}.svg")))
            .find(|plot| plot.exists())
            .unwrap_or_else(|| {
                let mut all: Vec<PathBuf> =
                    std::fs::read_dir(&plots).unwrap().map(|e| e.unwrap().path()).collect();
                all.sort();
                all.swap_remove(0)
            });
        std::fs::create_dir_all(root().join("book/src/gallery")).unwrap();
        std::fs::copy(chosen, picture(&name)).unwrap();
    }
}
