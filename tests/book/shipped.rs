//! What belongs to a release: versions that agree, licences of everything that is shipped, crates that can be packaged.

use std::collections::BTreeSet;
use std::path::Path;

const VERSION: &str = env!("CARGO_PKG_VERSION");

fn read(path: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
    std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// The value of `key = "value"` in a line.
fn value<'a>(line: &'a str, key: &str) -> Option<&'a str> {
    line.strip_prefix(key)?.trim_start().strip_prefix('=')?.trim().strip_prefix('"')?.split('"').next()
}

#[test]
fn licences_of_all_packages_are_listed() {
    let list = read("LICENSES-THIRD-PARTY.md");
    let rows: BTreeSet<(String, String)> = list
        .lines()
        .filter_map(|line| {
            let mut cells = line.strip_prefix("| ")?.split(" | ");
            let (name, version, licence) = (cells.next()?, cells.next()?, cells.next()?);
            assert!(!licence.trim_matches([' ', '|']).is_empty(), "{name} has no licence");
            Some((name.to_string(), version.to_string()))
        })
        .collect();
    let mut missing = Vec::new();
    for package in read("Cargo.lock").split("[[package]]").skip(1) {
        let of = |key| package.lines().find_map(|line| value(line, key));
        let (name, version) = (of("name").unwrap(), of("version").unwrap());
        if of("source").is_some() && !rows.contains(&(name.into(), version.into())) {
            missing.push(format!("{name} {version}"));
        }
    }
    let viewer: serde_json::Value = serde_json::from_str(&read("viewer/package.json")).unwrap();
    for (name, version) in viewer["dependencies"].as_object().unwrap() {
        if !rows.contains(&(name.clone(), version.as_str().unwrap().into())) {
            missing.push(format!("{name} {version}"));
        }
    }
    assert!(missing.is_empty(), "LICENSES-THIRD-PARTY.md is out of date, run .ci/licences: {missing:?}");
    let page = read("report/src/page/report.html");
    for name in viewer["dependencies"].as_object().unwrap().keys() {
        assert!(page.contains(&format!("npmjs.com/package/{name}")), "the page has no licence of {name}");
    }
}

#[test]
fn versions_agree() {
    assert!(read("CITATION.cff").lines().any(|line| line == format!("version: {VERSION}")));
    assert!(read("CHANGELOG.md").contains(&format!("\n## [{VERSION}]")));
    let python = read("python/pyproject.toml");
    assert_eq!(python.lines().find_map(|line| value(line, "version")), Some(VERSION));
    let root = read("Cargo.toml");
    for line in root.lines().filter(|line| line.starts_with("ropewalk") && line.contains("path = ")) {
        assert!(line.contains(&format!("version = \"{VERSION}\"")), "{line}");
    }
}

#[test]
fn crates_say_what_they_are_and_have_their_licences() {
    let root = read("Cargo.toml");
    let members = root.split("default-members = [").nth(1).unwrap().split(']').next().unwrap();
    let members = members.split(',').map(|m| m.trim().trim_matches('"'));
    // what is an example of a crate of one's own has nothing of the workspace
    let members: Vec<&str> =
        members.filter(|m| !matches!(*m, "" | ".") && !m.starts_with("examples/")).collect();
    assert!(members.len() > 5, "{members:?}");
    for member in members {
        let manifest = read(&format!("{member}/Cargo.toml"));
        let about = manifest.lines().find_map(|line| value(line, "description")).unwrap_or_default();
        assert!(about.len() > 20, "{member}: {about}");
        assert!(manifest.contains("license.workspace = true"), "{member}");
    }
    for copy in ["LICENSE-MIT", "LICENSE-APACHE", "LICENSES-THIRD-PARTY.md"] {
        assert_eq!(read(&format!("python/licences/{copy}")), read(copy), "copy {copy} to python/licences");
    }
}

/// Libraries whose unit tests aren't compiled have none: those would never run.
#[test]
fn no_test_is_left_out() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    for member in ["elements", "constraints", "forces", "sea"] {
        assert!(read(&format!("{member}/Cargo.toml")).contains("test = false"), "{member}");
        let mut folders = vec![root.join(member).join("src")];
        while let Some(folder) = folders.pop() {
            for entry in std::fs::read_dir(&folder).unwrap() {
                let path = entry.unwrap().path();
                if path.is_dir() {
                    folders.push(path);
                } else {
                    let text = std::fs::read_to_string(&path).unwrap();
                    assert!(
                        !text.contains("#[test]"),
                        "{}: it belongs into `{member}/tests`",
                        path.display()
                    );
                }
            }
        }
    }
}
