//! The page of the book that shows what the scenes of the gallery give beside what is known about them.

use std::fmt::Write as _;
use std::path::PathBuf;

/// Results of two machines differ by rounding, and by what steps make of it where a part lets go: so many parts of a tolerance.
const NOISE: f64 = 1.0;

const HEAD: &str = "# What the gallery gives

Made by `UPDATE=1 cargo test --test gallery` from runs of all scenes of the [gallery](gallery.md), with the settings that they have.
The error is in parts of the tolerance that the scene names; a test compares all of them. Tolerances are those of the
scene's own mesh and steps: closer ones take finer meshes, which `ropewalk cost` finds.

| scene | quantity | known | computed | error | source |
| --- | --- | ---: | ---: | ---: | --- |
";

/// One quantity of a scene.
pub struct Row {
    pub scene: String,
    /// `bob.x @ end = 0.25 ± 1e-4   (why)`
    pub line: String,
    pub known: f64,
    pub tolerance: f64,
    pub got: f64,
}

impl Row {
    fn text(&self) -> String {
        let (what, rest) = self.line.split_once(" = ").expect("an expectation");
        let (known, why) = rest.split_once("   (").expect("a reason");
        // what is counted has no tolerance
        let decimals =
            if self.tolerance > 0.0 { (2.0 - self.tolerance.log10()).ceil().clamp(0.0, 9.0) } else { 0.0 };
        let decimals = decimals as usize;
        format!(
            "| [{0}](gallery.md#{0}) | {what} | {known} | {1:.decimals$} | {2:.2} | {3} |",
            self.scene,
            self.got,
            self.error(),
            why.trim().strip_suffix(')').unwrap_or(why).replace('|', "\\|"),
        )
    }

    fn error(&self) -> f64 {
        let off = (self.got - self.known).abs();
        if off == 0.0 { 0.0 } else { off / self.tolerance }
    }
}

fn file() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("book/src/measured.md")
}

/// Compares the page with these rows, but for the noise of machines; with `UPDATE` set, writes it.
pub fn check(rows: &[Row]) {
    let texts: Vec<String> = rows.iter().map(Row::text).collect();
    if std::env::var_os("UPDATE").is_some() {
        let mut page = String::from(HEAD);
        texts.iter().for_each(|text| writeln!(page, "{text}").expect("a text"));
        std::fs::write(file(), page).expect("the page");
    }
    let page = std::fs::read_to_string(file()).expect("the page");
    let stale = "book/src/measured.md is out of date: UPDATE=1 cargo test --test gallery";
    let shown: Vec<&str> = page.strip_prefix(HEAD).expect(stale).lines().collect();
    assert_eq!(shown.len(), rows.len(), "{stale}");
    for ((shown, text), row) in shown.iter().zip(&texts).zip(rows) {
        let cells = |text: &str| text.split(" | ").map(str::to_string).collect::<Vec<_>>();
        let (shown, now) = (cells(shown), cells(text));
        assert_eq!((&shown[..3], &shown[5..]), (&now[..3], &now[5..]), "{stale}");
        let before: f64 = shown[3].parse().expect(stale);
        assert!((before - row.got).abs() <= NOISE * row.tolerance, "{stale}\n{text}");
    }
}
