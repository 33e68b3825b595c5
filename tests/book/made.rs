//! Pages of the book that are made: the reference from the schemas, tables from the results that are kept with the source.
//!
//! `UPDATE=1 cargo test --test book` writes them.

use crate::book;
use ropewalk::verify::cases;
use serde_json::Value;
use std::fmt::Write as _;
use std::path::Path;

fn read(path: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
    std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

#[track_caller]
fn up_to_date(page: &str, text: &str) {
    let path = book().join("src").join(page);
    if std::env::var_os("UPDATE").is_some() {
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(&path, text).unwrap();
    }
    let there = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(there == text, "book/src/{page} is out of date: UPDATE=1 cargo test --test book");
}

#[test]
fn the_reference_is_that_of_the_schemas() {
    let pages = ropewalk::cli::reference(ropewalk::scenes());
    for s in ropewalk::scene::registered() {
        let page = format!("reference/{}.md", s.kind.list());
        let (_, text) = pages.iter().find(|(name, _)| *name == page).expect("a page for each list");
        let heading = format!("\n## {}\n", s.name);
        let entry = text.split(&heading).nth(1).unwrap_or_else(|| panic!("no {} in {page}", s.name));
        let entry = entry.split("\n## ").next().unwrap();
        for part in ["```toml\n", "\nSee also: "] {
            assert!(entry.contains(part), "{}: no {part}", s.name);
        }
        // pages are Markdown: what looks like a tag would be one
        let prose: String = entry.split('`').step_by(2).collect();
        assert!(!prose.contains('<'), "{}: a tag in\n{prose}", s.name);
    }
    for (page, text) in &pages {
        up_to_date(page, text);
    }
}

/// What stands between two comments of a page, which are lines of their own.
fn with_part(page: &str, name: &str, part: &str) -> String {
    let (begin, end) = (format!("<!-- made: {name} -->\n"), "<!-- end -->");
    let (before, rest) = page.split_once(&begin).unwrap_or_else(|| panic!("no {begin}"));
    let (_, after) = rest.split_once(end).expect("an end");
    format!("{before}{begin}\n{}\n\n{end}{after}", part.trim())
}

#[test]
fn verification_is_that_of_the_last_results() {
    let results = read("docs/verification.md");
    let runs: Vec<_> = cases().into_iter().filter(|c| c.quantities() > 0).collect();
    for c in &runs {
        let row = format!("| [{0}](#{0}) | {1} |", c.name, c.quantities());
        let stale = "docs/verification.md is out of date: ropewalk verify -o docs/verification.md";
        assert!(results.contains(&row), "{stale}: no {row}");
        assert!(
            results.contains(&format!("\n## {}\n\n{}. Source: {}.\n", c.name, c.title, c.source)),
            "{stale}"
        );
    }
    let mut table = String::from("| case | what | compared | largest error |\n| --- | --- | ---: | ---: |\n");
    for line in results.lines().filter(|line| line.starts_with("| [")) {
        let cells: Vec<&str> = line.split(" | ").collect();
        let name = cells[0].trim_start_matches("| [").split(']').next().unwrap();
        let case = runs.iter().find(|c| c.name == name).unwrap_or_else(|| panic!("no case {name}"));
        writeln!(table, "| {name} | {} | {} | {} |", case.title.replace('|', "\\|"), cells[1], cells[2])
            .unwrap();
    }
    up_to_date("verification.md", &with_part(&read("book/src/verification.md"), "cases", &table));
}

/// Rows of a table of costs: one for each mesh.
fn costs(list: &Value) -> String {
    let mut table = String::from(
        "| elements | full Newton iteration | residual alone | step |\n| ---: | ---: | ---: | ---: |\n",
    );
    for cost in list.as_array().expect("a list") {
        let us = |path: &str| cost.pointer(path).and_then(Value::as_f64).unwrap_or(f64::NAN);
        let [iteration, residual, step] = ["/iteration_us", "/residual_us", "/step/us"].map(us);
        writeln!(table, "| {} | {iteration:.2} | {residual:.3} | {step:.2} |", cost["elements"]).unwrap();
    }
    table
}

#[test]
fn speed_is_that_of_the_last_measurement() {
    let results: Value = serde_json::from_str(&read("benches/results/bench.json")).unwrap();
    let mut page = read("book/src/speed.md");
    for part in ["dry", "water", "links"] {
        page = with_part(&page, part, &costs(&results[part]));
    }
    up_to_date("speed.md", &page);
}
