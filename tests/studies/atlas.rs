//! Atlases as a user calls them: what they leave behind, what is computed once, what goes on after a kill, and what is
//! said of mistakes before anything is computed.

use crate::program::{Said, program, run};
use std::fs;
use std::path::Path;
use std::process::Stdio;
use std::time::{Duration, Instant, SystemTime};

/// A swing of one rigid link: what it does is known, and it costs next to nothing.
const SWING: &str = r#"
title = "A swing"

[parameters]
length = { default = "1 m", description = "length of the rod" }
end = { default = ["1 m", 0, 0], description = "where the weight is let go" }
duration = "2 s"

[run]
duration = "$duration"
output = "0.02 s"
snapshots = 11

[[elements]]
type = "point_mass"
name = "weight"
marker = "$end"
mass = "1 kg"

[[constraints]]
type = "distance"
name = "rod"
marker = "weight"
to = [0, 0, 0]

[[forces]]
type = "gravity"

[[records]]
type = "position"
of = "weight"

[[records]]
type = "reaction"
of = "rod"
"#;

const ATLAS: &str = r#"
title = "Swings"

[names]
end = "from"

[[chapters]]
number = "1"
title = "Swinging"

[scenes.swing]
file = "swing.toml"
quick = { duration = "0.4 s" }

[layouts.way]
columns = 2
panels = [{ y = ["weight.x"], y_label = "x [m]" }, { y = ["weight.z"], y_label = "z [m]" }]

[[entries]]
type = "figure"
number = "1.1"
chapter = "1"
title = "Where the weight is"
runs = [{ scene = "swing", vary = { end = [["1 m", 0, 0], ["2 m", 0, 0]] } }]
layout = "way"

[[entries]]
type = "figure"
number = "1.2"
chapter = "1"
title = "What the rod bears"
runs = [{ scene = "swing", set = { end = ["1 m", 0, 0] } }]
panels = [{ y = ["rod.magnitude"], window = ["0.5 s", "2 s"], guides = [{ level = 29.43, label = "3 m g" }] }]

[[entries]]
type = "table"
number = "1.1"
chapter = "1"
title = "The end"
runs = [{ scene = "swing", vary = { end = [["1 m", 0, 0], ["2 m", 0, 0]] } }]
columns = [{ record = "weight.z", value = "least", share = 1 }, { quantity = "steps" }]

[[entries]]
type = "other"
number = "1.3"
chapter = "1"
title = "A child on it"
what = "photograph"
"#;

/// A folder with the scene and the atlas in it, changed by these replacements.
fn folder(changes: &[(&str, &str)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let mut atlas = ATLAS.to_string();
    for (old, new) in changes {
        assert!(atlas.contains(old), "{old}");
        atlas = atlas.replacen(old, new, 1);
    }
    fs::write(folder.path().join("swing.toml"), SWING).unwrap();
    fs::write(folder.path().join("swings.toml"), atlas).unwrap();
    folder
}

/// `ropewalk atlas swings.toml` with more arguments, separated by blanks.
fn atlas(folder: &Path, arguments: &str) -> Said {
    let arguments: Vec<&str> =
        ["atlas", "swings.toml"].into_iter().chain(arguments.split_whitespace()).collect();
    run(folder, &arguments)
}

#[track_caller]
fn done(said: Said) -> String {
    assert_eq!(said.code, Some(0), "{}", said.stderr);
    said.stdout
}

fn text(path: impl AsRef<Path>) -> String {
    let path = path.as_ref();
    fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// The folders of the runs and when their summaries were written, by name.
fn runs(folder: &Path) -> Vec<(String, SystemTime)> {
    let entries = fs::read_dir(folder.join("runs")).unwrap().map(|e| e.unwrap());
    let written = |e: fs::DirEntry| {
        let about = fs::metadata(e.path().join("summary.json")).ok()?;
        Some((e.file_name().into_string().unwrap(), about.modified().unwrap()))
    };
    let mut all: Vec<_> = entries.filter_map(written).collect();
    all.sort();
    all
}

#[test]
fn figures_tables_and_page_are_made_and_shared_runs_computed_once() {
    let folder = folder(&[]);
    let at = |name: &str| folder.path().join("out").join(name);
    let said = done(atlas(folder.path(), "--out out"));
    assert!(said.contains("2 of 2, 0 of them from an earlier call"), "{said}");
    assert_eq!(runs(&at("")).len(), 2);

    // the curves are those of the runs, and the weight passes below its hook at 3 m g
    let csv = text(at("figures/1.1.csv"));
    let head = "t [s],\"x [m]: from [1 m, 0, 0]\",\"x [m]: from [2 m, 0, 0]\",\"z [m]: from [1 m, 0, 0]\"";
    assert!(csv.starts_with(head), "{}", csv.lines().next().unwrap());
    assert!(csv.lines().nth(1).unwrap().starts_with("0,1,2,0,0"));
    assert_eq!(csv.lines().count(), 102);
    let svg = text(at("figures/1.1.svg"));
    assert!(svg.contains(">\nFigure 1.1. Where the weight is\n<") && svg.contains(">\nz [m]\n<"), "{svg}");
    let force = text(at("figures/1.2.csv"));
    let rows = force.lines().skip(1).map(|l| l.split(',').map(|c| c.parse::<f64>().unwrap()));
    let rows: Vec<Vec<f64>> = rows.map(Iterator::collect).collect();
    assert!(rows[0][0] == 0.5 && rows.last().unwrap()[0] == 2.0, "{rows:?}");
    let largest = rows.iter().map(|r| r[1].abs()).fold(0.0, f64::max);
    assert!((largest / 29.43 - 1.0).abs() < 0.01, "{largest}");
    assert!(text(at("figures/1.2.svg")).contains("3 m g"));

    let table = text(at("tables/table-1.1.csv"));
    // what swings is marked in the last column
    assert!(table.starts_with("end,weight.z [m],steps,unsteady\n"), "{table}");
    let least: f64 = table.lines().nth(2).unwrap().rsplit(',').nth(2).unwrap().parse().unwrap();
    assert!((least + 2.0).abs() < 0.01, "{table}");
    let page = text(at("index.html"));
    for holds in [
        "<h2 id=\"chapter-1\">1 Swinging</h2>",
        "<img src=\"figures/1.1.svg\"",
        "<td class=\"number\">",
        "Not computed: this is a photograph.",
        "varied: end = [[1 m, 0, 0], [2 m, 0, 0]]",
    ] {
        assert!(page.contains(holds), "no {holds} in\n{page}");
    }

    // once more: nothing is computed; another title of an entry changes no run; another scene does
    let before = runs(&at(""));
    assert!(done(atlas(folder.path(), "--out out")).contains("2 of them from an earlier call"));
    fs::write(folder.path().join("swings.toml"), ATLAS.replace("What the rod bears", "Its force")).unwrap();
    done(atlas(folder.path(), "--out out --only 1.2"));
    assert_eq!(runs(&at("")), before);
    assert!(text(at("figures/1.2.svg")).contains("Its force"));
    assert!(text(at("index.html")).contains("Not asked for in this call."));
    fs::write(folder.path().join("swing.toml"), SWING.replace("1 kg", "2 kg")).unwrap();
    let said = done(atlas(folder.path(), "--out out --only 1.2"));
    assert!(said.contains("1 of 1, 0 of them from an earlier call"), "{said}");
}

#[test]
fn only_what_is_asked_for_is_computed_and_listing_computes_nothing() {
    let folder = folder(&[]);
    let said = done(atlas(folder.path(), "--list"));
    assert!(said.contains("1 Swinging\n  1.1        Where the weight is\n"), "{said}");
    assert!(said.contains("table-1.1  The end") && said.contains("(not computed: a photograph)"), "{said}");
    assert!(!folder.path().join("runs").exists());
    let said = done(atlas(folder.path(), "--only figure-1.2 --quiet"));
    assert!(said.is_empty());
    let out = folder.path().join("runs/swings-atlas");
    assert_eq!(runs(&out).len(), 1);
    assert!(out.join("figures/1.2.svg").exists() && !out.join("figures/1.1.svg").exists());
    // quick runs are others, and go into a folder of their own; here the window is too long for them
    let quick = atlas(folder.path(), "--only 1.2 --quick");
    quick.refused(&["the window from 0.5 to 2 s is not inside the run, which ends at 0.4 s"]);
    let said = done(atlas(folder.path(), "--only 1.1 --quick"));
    assert!(said.contains("runs/swings-quick-atlas"), "{said}");
    let mixed = atlas(folder.path(), "--only 1.1 --quick --out runs/swings-atlas");
    mixed.refused(&["made without --quick", "--fresh"]);
}

#[test]
fn a_measured_curve_is_laid_over() {
    let folder = folder(&[]);
    fs::write(folder.path().join("film.csv"), "t [s],weight.z [m]\n0,0\n0.3,-0.4\n0.6,-1\n").unwrap();
    let arguments = "--only 1.1,1.2 --out out --overlay 1.1=film.csv";
    done(atlas(folder.path(), arguments));
    let at = |name: &str| text(folder.path().join("out/figures").join(name));
    assert!(at("1.1.svg").contains(">\nfilm\n<") && at("1.1.svg").matches("<circle").count() >= 3);
    assert!(at("1.1.csv").contains("z [m]: film") && !at("1.2.svg").contains("film"));
    // in the file, by its path from there
    let inside = ATLAS.replace("layout = \"way\"", "layout = \"way\"\noverlay = [{ file = \"film.csv\" }]");
    fs::write(folder.path().join("swings.toml"), inside).unwrap();
    done(atlas(folder.path(), "--only 1.1 --out out"));
    assert!(at("1.1.csv").contains("z [m]: weight.z"));
    atlas(folder.path(), "--overlay 7=film.csv --out out").refused(&["there is no figure 7", "--list"]);
    atlas(folder.path(), "--overlay 1.1=none.csv --out out").refused(&["none.csv", "CSV"]);
    fs::write(folder.path().join("film.csv"), "t [s],height [m]\n0,0\n").unwrap();
    atlas(folder.path(), "--only 1.1 --out out").refused(&[
        "`height`",
        "weight.x, weight.z",
        "swings.toml:26:",
        "entries[0].overlay[0]",
    ]);
}

#[test]
fn mistakes_are_told_with_their_place_before_anything_is_computed() {
    for (old, new, holds) in [
        (
            "layout = \"way\"",
            "layuot = \"way\"",
            &["unknown field `layuot`", "swings.toml:25:1", "`layout`"][..],
        ),
        (
            "layout = \"way\"",
            "layout = \"wya\"",
            &["there is no layout `wya`", ":25:10", "did you mean `way`?"],
        ),
        (
            "scene = \"swing\", vary",
            "scene = \"swin\", vary",
            &["`swin`", "swings.toml:24:", "the atlas has swing"],
        ),
        (
            "\"rod.magnitude\"",
            "\"rod.magnitudes\"",
            &["no column `rod.magnitudes`", "swings.toml:33:", "did you mean `rod.magnitude`?"],
        ),
        ("[\"0.5 s\", \"2 s\"]", "[\"0.5 s\", \"20 s\"]", &["from 0.5 to 20 s", "ends at 2 s", ":33:"]),
        ("[\"0.5 s\", \"2 s\"]", "[\"0.5 m\", \"2 s\"]", &["0.5 m", "swings.toml:33:"]),
        ("set = { end", "set = { ende", &["unknown parameter `ende`", ":32:", "did you mean `end`?"]),
        ("set = { end = [\"1 m\", 0, 0]", "set = { end = [\"1 kg\", 0, 0]", &["1 kg", "swings.toml:32:"]),
        ("number = \"1.2\"", "number = \"1.1\"", &["there are two of Figure 1.1", "swings.toml:29:10"]),
        ("chapter = \"1\"\ntitle = \"Where", "chapter = \"9\"\ntitle = \"Where", &["no chapter `9`", ":22:"]),
        ("[\"weight.x\"]", "[\"weight.x\", \"rod.magnitude\"]", &["[m] and [N]", "layouts.way.panels[0].y"]),
        ("quantity = \"steps\"", "quantity = \"stpes\"", &["stpes", "swings.toml:41:", "steps"]),
        ("file = \"swing.toml\"", "file = \"swings/no.toml\"", &["there is no file", "no.toml", ":12:"]),
        (
            "vary = { end = [[\"1 m\", 0, 0], [\"2 m\", 0, 0]] } }]\nlayout",
            "vary = { end = 3 } }]\nlayout",
            &["a list", ":24:"],
        ),
        ("layout = \"way\"", "panels = [{ shapes = \"side\", count = 20 }]", &["20 shapes", "1 to 8"]),
        (
            "layout = \"way\"",
            "panels = [{ y = [\"weight.x\"], relative_to = \"ship\" }]",
            &["`ship.x`", ":25:"],
        ),
        (
            "layout = \"way\"",
            "panels = [{ y = [\"weight.x\"], shapes = \"top\" }]",
            &["either records or shapes"],
        ),
        ("share = 1", "share = 2", &["`share` must be above 0 and at most 1"]),
    ] {
        let folder = folder(&[(old, new)]);
        let said = atlas(folder.path(), "--out out");
        let lower: Vec<String> = holds.iter().map(|h| (*h).to_string()).collect();
        assert_eq!(said.code, Some(2), "{new}: {}", said.stderr);
        for text in lower {
            assert!(
                said.stderr.to_lowercase().contains(&text.to_lowercase()),
                "no {text} in\n{}",
                said.stderr
            );
        }
        said.refused(&[]);
        assert!(!folder.path().join("out").exists(), "{new}");
    }
    let folder = folder(&[]);
    atlas(folder.path(), "--only 1.4").refused(&["`swings` has no entry `1.4`"]);
    run(folder.path(), &["atlas", "thesys"]).refused(&["no bundled atlas", "did you mean `thesis`?"]);
    run(folder.path(), &["atlas", "none.toml"]).refused(&["there is no file `none.toml`"]);
}

/// The results of a call that was killed and of the one after it are those of a call that wasn't.
#[test]
fn a_kill_leaves_what_the_next_call_goes_on_with() {
    // thousands of quick runs could end before they are killed: one takes long
    let long = (
        "[[\"1 m\", 0, 0], [\"2 m\", 0, 0]] } }]\nlayout",
        "[[\"1 m\", 0, 0], [\"2 m\", 0, 0]], duration = [\"2 s\", \"60 s\"] } }]\nlayout",
    );
    let folder = folder(&[long]);
    let out = folder.path().join("out");
    let arguments = ["atlas", "swings.toml", "--out", "out", "--jobs", "1", "--quiet"];
    let mut child =
        program(folder.path(), &arguments).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    let start = Instant::now();
    while !out.join("runs").exists() || runs(&out).is_empty() {
        assert!(start.elapsed() < Duration::from_secs(60), "no run ends");
        std::thread::sleep(Duration::from_millis(2));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    let before = runs(&out);
    assert!(!before.is_empty());
    done(run(folder.path(), &arguments));
    let after = runs(&out);
    assert_eq!(after.len(), 4);
    assert!(before.iter().all(|run| after.contains(run)), "computed twice: {before:?} {after:?}");
    done(run(folder.path(), &["atlas", "swings.toml", "--out", "whole", "--quiet"]));
    for name in
        ["figures/1.1.csv", "figures/1.1.svg", "figures/1.2.csv", "tables/table-1.1.csv", "index.html"]
    {
        assert_eq!(text(out.join(name)), text(folder.path().join("whole").join(name)), "{name}");
    }
}

#[test]
fn a_run_that_fails_takes_only_its_figures_with_it() {
    let folder = folder(&[]);
    // a rod that is shorter than the way to the weight contradicts its start
    let scene = SWING.replace("to = [0, 0, 0]", "to = [0, 0, 0]\nlength = \"$length\"");
    fs::write(folder.path().join("swing.toml"), scene).unwrap();
    let said = atlas(folder.path(), "--out out");
    assert_eq!(said.code, Some(3), "{}", said.stderr);
    assert!(said.stderr.contains("1 of 2 runs have no result"), "{}", said.stderr);
    let page = text(folder.path().join("out/index.html"));
    assert!(
        page.contains("Missing: 1 of 2 runs have no result") && page.contains("figures/1.2.svg"),
        "{page}"
    );
}

#[test]
fn the_example_and_the_thesis_are_sound() {
    let folder = tempfile::tempdir().unwrap();
    let example = format!("{}/examples/atlas/beams.toml", env!("CARGO_MANIFEST_DIR"));
    let said = done(run(folder.path(), &["atlas", &example, "--quick", "--out", "out"]));
    assert!(said.contains("figures     3\n  tables      1\n"), "{said}");
    assert!(text(folder.path().join("out/figures/1.2.svg")).contains("elastica"));
    // every entry of the thesis is checked with all its runs before the first one is computed
    let said =
        done(run(folder.path(), &["atlas", "thesis", "--only", "table-E.1,G.1,1.1,L.3", "--out", "thesis"]));
    assert!(said.contains("figures     2\n  tables      1\n  others      1"), "{said}");
    let newmark = text(folder.path().join("thesis/tables/table-E.1.csv"));
    assert!(newmark.contains("central difference,0,0.5,2,2,"), "{newmark}");
    let list = done(run(folder.path(), &["atlas", "thesis", "--list"]));
    for name in [
        "2.6 ",
        "2.37",
        "2.39",
        "3.10",
        "3.26",
        "table-3.2",
        "4.5 ",
        "4.61",
        "table-4.11",
        "L.12",
        "table-L.6",
    ] {
        assert!(list.contains(&format!("\n  {name}")), "{name}\n{list}");
    }
}
