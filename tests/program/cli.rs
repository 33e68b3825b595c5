//! The program as a user calls it: what it says, what it leaves behind, how it ends.

use crate::program::{Said, program, run, signals};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// A short cable that swings, quickly computed.
const SWING: &str = r#"
title = "A swing"
description = "Half a second of it."

[parameters]
mass = { default = "2 kg/m", description = "mass per length" }
n = { default = 4, description = "number of elements" }

[run]
duration = "0.3 s"
output = "0.02 s"

[[elements]]
type = "cable"
name = "rope"
points = [[0, 0, 0], ["1 m", 0, 0]]
elements = "$n"
section = { mass = "$mass", ea = "20 kN", ei = 1 }

[[constraints]]
type = "spherical"
name = "hook"
marker = "rope.start"

[[forces]]
type = "gravity"

[[records]]
type = "position"
of = "rope.end"

[[records]]
type = "reaction"
of = "hook"

[[records]]
type = "energy"
"#;

fn text(path: impl AsRef<Path>) -> String {
    let path = path.as_ref();
    fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

fn json(path: impl AsRef<Path>) -> Value {
    serde_json::from_str(&text(path)).unwrap()
}

/// A folder with the scene in it.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("swing.toml"), SWING).unwrap();
    folder
}

#[track_caller]
fn done(said: Said) -> String {
    assert_eq!(said.code, Some(0), "{}", said.stderr);
    said.stdout
}

#[test]
fn a_run_leaves_a_complete_folder() {
    let folder = folder();
    let report = done(run(folder.path(), &["run", "swing.toml"]));
    for word in ["A swing", "finished", "t = 0.3 s", "Newton iterations", "energy", "rope.end", "runs/swing"]
    {
        assert!(report.contains(word), "no {word} in\n{report}");
    }
    let out = folder.path().join("runs/swing");

    let history = text(out.join("history.csv"));
    let mut rows = history.lines();
    let columns = "t [s],rope.end.x [m],rope.end.y [m],rope.end.z [m],hook.fx [N],hook.fy [N],hook.fz [N],hook.magnitude [N]";
    let header = rows.next().unwrap();
    assert!(header.starts_with(columns) && header.contains("[J]"), "{header}");
    let rows: Vec<Vec<f64>> = rows.map(|r| r.split(',').map(|x| x.parse().unwrap()).collect()).collect();
    assert_eq!(rows.len(), 16);
    assert!(rows.iter().all(|r| r.len() == header.split(',').count() && r.iter().all(|x| x.is_finite())));
    assert_eq!((rows[0][1], rows[15][0]), (1.0, 0.3));

    let summary = json(out.join("summary.json"));
    assert_eq!(summary["status"], "finished");
    // the same names as in the history
    let last: Vec<(String, f64)> =
        serde_json::from_value::<serde_json::Map<String, Value>>(summary["final"].clone())
            .unwrap()
            .into_iter()
            .map(|(name, value)| (name, value.as_f64().unwrap()))
            .collect();
    let named = header.split(',').map(|heading| heading.rsplit_once(" [").unwrap().0.to_string());
    assert_eq!(last, named.zip(rows[15].clone()).collect::<Vec<_>>());
    for count in ["steps", "rejected", "newton_iterations", "factorizations"] {
        assert!(summary["counts"][count].is_u64(), "{count}");
    }
    assert!(summary["counts"]["steps"].as_u64() > Some(2));
    for energy in ["kinetic", "potential", "supplied", "dissipated", "imbalance"] {
        assert!(summary["energy"][energy].is_f64(), "{energy}");
    }
    assert!(summary["cpu_s"].as_f64().is_some() && summary["wall_s"].as_f64() > Some(0.0));
    assert!(summary.get("profile").is_none());

    let manifest = json(out.join("manifest.json"));
    assert_eq!(manifest["title"], "A swing");
    assert_eq!(manifest["ropewalk"], env!("CARGO_PKG_VERSION"));
    assert_eq!(manifest["parts"][0], serde_json::json!(["rope", "cable"]));
    assert_eq!(manifest["constraints"][0], serde_json::json!(["hook", 3]));
    assert_eq!((&manifest["unknowns"], &manifest["multipliers"]), (&30.into(), &3.into()));
    assert!(manifest["non_zeros"].as_u64() > Some(30) && manifest["solver"].is_string());
    let terms = manifest["terms"].to_string();
    assert!(terms.contains("weight") && !terms.contains("drag"), "{terms}");

    for plot in ["rope.end", "hook.reaction", "shape_side"] {
        let svg = text(out.join(format!("plots/{plot}.svg")));
        assert!(svg.starts_with("<svg") || svg.starts_with("<?xml"), "{plot}");
        assert!(svg.trim_end().ends_with("</svg>"), "{plot}");
        well_formed(&svg);
        let labels =
            if plot.starts_with("shape") { ["A swing", "x [m]", "z [m]"] } else { ["of", "t [s]", "["] };
        for label in labels {
            assert!(texts(&svg).iter().any(|t| t.contains(label)), "{plot}: no {label} in {:?}", texts(&svg));
        }
    }
    assert!(text(out.join("plots/rope.end.svg")).contains("Position of rope.end"));
}

/// Every element is closed, in order.
fn well_formed(svg: &str) {
    let mut open = Vec::new();
    for tag in svg.split('<').skip(1).map(|t| t.split_once('>').expect("a tag that ends").0) {
        let name = tag.trim_start_matches('/').split([' ', '\n', '/']).next().unwrap();
        match (tag.starts_with('/'), tag.ends_with('/') || tag.starts_with(['?', '!'])) {
            (true, _) => assert_eq!(open.pop(), Some(name)),
            (false, true) => {}
            (false, false) => open.push(name),
        }
    }
    assert!(open.is_empty(), "{open:?}");
}

/// What an SVG says.
fn texts(svg: &str) -> Vec<&str> {
    let inner = |t: &'static str| move |s: &'_ str| s.find(t);
    let end = inner("</text>");
    svg.split("<text").skip(1).filter_map(|t| Some(t[t.find('>')? + 1..end(t)?].trim())).collect()
}

#[test]
fn a_run_from_what_another_left_behind_is_the_same() {
    let folder = folder();
    let set = ["run", "swing.toml", "--set", "mass=3 kg/m", "--set", "n=5", "--out", "first", "--quiet"];
    assert_eq!(done(run(folder.path(), &set)), "");
    done(run(folder.path(), &["run", "first/scene.toml", "--out", "second", "--quiet"]));
    let files = ["history.csv", "scene.toml", "manifest.json"];
    for file in files {
        assert!(
            text(folder.path().join("first").join(file)) == text(folder.path().join("second").join(file)),
            "{file}"
        );
    }
    let scene = text(folder.path().join("first/scene.toml"));
    assert!(scene.contains("3 kg/m") && !scene.contains('$'), "{scene}");
    // and setting parameters made a difference
    done(run(folder.path(), &["run", "swing.toml", "--out", "third", "--quiet"]));
    assert!(text(folder.path().join("first/history.csv")) != text(folder.path().join("third/history.csv")));
}

/// Files that a scene names come along: the folder holds all that the run was made of.
#[test]
fn a_run_goes_again_without_the_files_that_its_scene_named() {
    let here = folder();
    let scene = "[run]\nduration = 1\n[solver]\nproject = true\n[[elements]]\ntype = \"point_mass\"\nname = \"ball\"\nmarker = [0, 0, 0]\nmass = 1\n\
                 [[constraints]]\ntype = \"driving\"\nname = \"hand\"\nmarker = \"ball\"\nmotion = \"path\"\n\
                 [[motions]]\ntype = \"table\"\nname = \"path\"\nfile = \"path.csv\"\n\
                 [[records]]\ntype = \"position\"\nof = \"ball\"\n";
    fs::write(here.path().join("scene.toml"), scene).unwrap();
    fs::write(here.path().join("path.csv"), "t,x\n0,0\n0.25,0\n0.5,0.1\n1,0\n").unwrap();
    done(run(here.path(), &["run", "scene.toml", "--out", "one"]));
    fs::remove_file(here.path().join("path.csv")).unwrap();
    fs::rename(here.path().join("one"), here.path().join("elsewhere")).unwrap();
    done(run(here.path(), &["run", "elsewhere/scene.toml", "--out", "two"]));
    let history = |folder: &str| text(here.path().join(folder).join("history.csv"));
    assert_eq!(history("elsewhere"), history("two"));
    assert!(text(here.path().join("two/scene.toml")).contains("file = \"inputs/path.csv\""));
}

#[test]
fn results_are_never_overwritten() {
    let folder = folder();
    for k in 1..=2 {
        done(run(folder.path(), &["run", "swing.toml", "-q"]));
        assert_eq!(fs::read_dir(folder.path().join("runs")).unwrap().count(), k);
    }
    fs::create_dir(folder.path().join("mine")).unwrap();
    fs::write(folder.path().join("mine/letter.txt"), "dear").unwrap();
    let said = run(folder.path(), &["run", "swing.toml", "--out", "mine"]);
    said.refused(&["mine is not empty", "--out"]);
    assert_eq!(fs::read_dir(folder.path().join("mine")).unwrap().count(), 1);
    assert_eq!(text(folder.path().join("mine/letter.txt")), "dear");
}

#[test]
fn a_profile_tells_the_time_of_every_term() {
    let folder = folder();
    let report = done(run(folder.path(), &["run", "swing.toml", "--profile", "--out", "out"]));
    assert!(report.contains("profile") && report.contains(" %"), "{report}");
    let summary = json(folder.path().join("out/summary.json"));
    let profile = summary["profile"].as_array().unwrap();
    for label in ["cable", "weight", "constraints", "factorisation", "solution", "step control"] {
        let entry = profile.iter().find(|e| e["label"].as_str().unwrap().contains(label));
        let entry = entry.unwrap_or_else(|| panic!("no {label} in {profile:?}"));
        assert!(entry["calls"].as_u64() > Some(0) && entry["seconds"].as_f64() >= Some(0.0));
    }
    let shares: f64 = profile.iter().map(|e| e["share"].as_f64().unwrap()).sum();
    assert!((shares - 1.0).abs() < 1e-6, "{shares}");
}

#[test]
fn a_benchmark_tells_the_cost_by_phase_mesh_and_model() {
    let folder = tempfile::tempdir().unwrap();
    let quick = ["bench", "--seconds", "0", "--elements", "8,4,8"];
    let tables = done(run(folder.path(), &[&quick[..], &["--csv", "cost.csv", "--out", "out"]].concat()));
    for text in
        ["in air", "in water", "drag", "factorisation", "full Newton iteration", "step", "cable L2+T1"]
    {
        assert!(tables.contains(text), "no {text} in\n{tables}");
    }
    let csv = text(folder.path().join("cost.csv"));
    assert!(
        csv.starts_with("what,elements,quantity,value") && csv.contains("\ndry,4,full Newton iteration,")
    );
    assert!(csv.lines().skip(1).all(|l| l.rsplit(',').next().unwrap().parse::<f64>().unwrap() >= 0.0));
    assert_eq!(text(folder.path().join("out/bench.csv")), csv);
    well_formed(&text(folder.path().join("out/bench.svg")));
    let report = json(folder.path().join("out/bench.json"));
    assert_eq!(
        (report["dry"].as_array().unwrap().len(), report["variants"].as_array().unwrap().len()),
        (2, 15)
    );
    assert!(report["water"][1]["iteration_us"].as_f64() > Some(0.0) && report["memory"].is_null());
    for case in [report["dry"].clone(), report["water"].clone()] {
        assert_eq!((&case[0]["elements"], &case[1]["elements"]), (&4.into(), &8.into()));
        assert!(case[0]["fallbacks"] == 0 && case[0]["phases"].as_array().unwrap().len() >= 6);
    }
    let out = done(run(folder.path(), &[&quick[..], &["--lanes", "one", "--json"]].concat()));
    let report: Value = serde_json::from_str(&out).unwrap();
    assert_eq!(report["lanes"], 1);
}

#[test]
fn a_benchmark_is_refused_before_it_begins() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("mine.csv"), "dear").unwrap();
    let bench = |more: &[&str]| run(folder.path(), &[&["bench"], more].concat());
    bench(&["--csv", "mine.csv"]).refused(&["mine.csv exists", "--csv"]);
    bench(&["--csv", "no/such/folder/cost.csv"]).refused(&["no/such/folder/cost.csv"]);
    bench(&["--out", "."]).refused(&["not empty", "--out"]);
    bench(&["--seconds", "NaN"]).refused(&["--seconds"]);
    for wrong in [["--elements", "0"], ["--elements", "8,x"], ["--elements", ""], ["--lanes", "three"]] {
        bench(&wrong).refused(&[wrong[0]]);
    }
    assert_eq!(text(folder.path().join("mine.csv")), "dear");
}

#[test]
fn what_would_have_no_effect_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let variants = |more: &[&str]| run(folder.path(), &[&["variants", "--only"], more].concat());
    variants(&["stiffness", "--finest", "4"]).refused(&["--finest", "--only"]);
    variants(&["stiffness", "--absolute", "1e-5"]).refused(&["--absolute"]);
    variants(&["scaling", "--seconds", "1"]).refused(&["--seconds"]);
    fs::write(folder.path().join("empty.so"), "").unwrap();
    fs::write(folder.path().join("swing.toml"), SWING).unwrap();
    run(folder.path(), &["export-fmu", "swing.toml", "--library", "empty.so"]).refused(&[
        "empty.so",
        "no function of FMI",
        "ropewalk-fmu",
    ]);
    assert!(!folder.path().join("swing.fmu").exists() && !folder.path().join("runs").exists());
}

#[test]
fn json_scenes_are_read_too() {
    let folder = folder();
    let scene = r#"{
        "title": "A weight in free fall",
        "run": { "duration": "1 s" },
        "elements": [{ "type": "point_mass", "name": "stone", "marker": [0, 0, 5], "mass": "2 kg" }],
        "forces": [{ "type": "gravity" }],
        "records": [{ "type": "position", "of": "stone" }]
    }"#;
    fs::write(folder.path().join("fall.json"), scene).unwrap();
    done(run(folder.path(), &["run", "fall.json", "--out", "out"]));
    let z = json(folder.path().join("out/summary.json"))["final"]["stone.z"].as_f64().unwrap();
    assert!((z - (5.0 - 0.5 * 9.81)).abs() < 1e-6, "{z}");
}

#[test]
fn list_shows_scenes_and_types() {
    let folder = folder();
    let list = done(run(folder.path(), &["list"]));
    for bundled in ropewalk::bundled() {
        assert!(
            list.lines().any(|l| l.trim_start().starts_with(bundled.name)),
            "no {} in\n{list}",
            bundled.name
        );
    }
    for t in ropewalk::scene::registered() {
        let line = list.lines().find(|l| l.trim_start().split(' ').next() == Some(t.name));
        let line = line.unwrap_or_else(|| panic!("no {} in\n{list}", t.name));
        assert!(line.trim().len() > t.name.len() + 5, "{line}");
    }
    assert!(!list.contains("[`"), "{list}");
}

#[test]
fn linearise_leaves_matrices_and_their_names() {
    let folder = folder();
    let said = done(run(folder.path(), &["linearise", "swing.toml", "--at", "0.1 s", "--out", "linear"]));
    assert!(said.contains("about the state at t = 0.1 s") && said.contains("stiffness.mtx"), "{said}");
    let read = |name: &str| fs::read_to_string(folder.path().join("linear").join(name)).expect(name);
    let names: Value = serde_json::from_str(&read("linearised.json")).expect("JSON");
    let unknowns = names["unknowns"].as_array().expect("names").len();
    // five nodes of position and slope
    assert_eq!((unknowns, names["constraints"].as_array().expect("names").len()), (30, 3));
    for file in ["mass", "damping", "gyroscopic", "stiffness", "kinematic"] {
        let text = read(&format!("{file}.mtx"));
        let mut lines = text.lines().skip_while(|l| l.starts_with('%'));
        let size: Vec<usize> =
            lines.next().expect("size").split(' ').map(|n| n.parse().expect("a number")).collect();
        assert_eq!((&size[..2], size[2]), (&[unknowns, unknowns][..], lines.count()), "{file}");
    }
    assert!(read("null_space.mtx").lines().nth(2).is_some_and(|l| l == "30 27"));
    for (at, expected) in [("never", "expected `equilibrium`"), ("1 h", "between 0 and 0.3 s")] {
        let refused = run(folder.path(), &["linearise", "swing.toml", "--at", at]);
        assert_eq!(refused.code, Some(2), "{at}");
        assert!(refused.stderr.contains(expected), "{}", refused.stderr);
    }
}

#[test]
fn describe_explains_scenes_types_and_sections() {
    let folder = folder();
    let describe = |what: &str| done(run(folder.path(), &["describe", what]));
    let inputs = describe("inputs");
    assert!(inputs.starts_with("[[inputs]]") && inputs.contains("Name, by which"), "{inputs}");
    let winch = describe("winch");
    assert!(winch.contains("speed: number in m/s, or text with a unit, or an input"), "{winch}");
    let scene = describe("swing.toml");
    for line in ["A swing", "Half a second of it.", "mass = 2 kg/m", "number of elements", "rope (cable)"] {
        assert!(scene.contains(line), "no {line} in\n{scene}");
    }
    let catenary = describe("catenary");
    let example = "    taut, shorter than the span           ropewalk run catenary --set length=99.9";
    assert!(catenary.lines().any(|line| line == example), "{catenary}");
    let hose = describe("hose-turn");
    assert!(hose.contains("speed = 25 kn") && hose.contains("radius = 25 m"), "{hose}");
    let cable = describe("cable");
    for line in ["type = \"cable\"", "`{ mass = …, ea = …, ei = … }`", "default \"locking-free\""] {
        assert!(cable.contains(line), "no {line} in\n{cable}");
    }
    let sections = describe("sections");
    assert!(sections.contains("number in kg/m, or text with a unit"), "{sections}");
    let solver = describe("solver");
    assert!(solver.contains("default { controlled = { tolerance = 0.0001 } }"), "{solver}");
    let water = describe("water");
    assert!(water.contains("z: number in m") && water.contains("velocity: list of 3"), "{water}");
    let along = describe("along");
    assert!(along.contains("one of \"start\", \"end\" or number in m"), "{along}");
    for t in ropewalk::scene::registered() {
        let text = describe(t.name);
        assert!(text.contains(&format!("[[{}]]", t.kind.list())), "{text}");
        assert!(!text.contains("[`") && !text.contains("::"), "{text}");
    }
    run(folder.path(), &["describe", "cabel"]).refused(&["did you mean `cable`?"]);
}

#[test]
fn migrate_rewrites_old_names_and_leaves_the_rest() {
    let folder = folder();
    let at = |name: &str| folder.path().join(name);
    let old = SWING.replace("ei = 1 }", "ei = 1, bending_damping = 0.01 } # kept");
    fs::write(at("old.toml"), &old).unwrap();
    run(folder.path(), &["check", "old.toml"])
        .refused(&["bending_retardation_time", "ropewalk migrate old.toml"]);
    assert_eq!(run(folder.path(), &["migrate", "old.toml", "--check"]).code, Some(1));
    assert_eq!(fs::read_to_string(at("old.toml")).unwrap(), old);
    done(run(folder.path(), &["migrate", "old.toml", "--backup"]));
    let new = old.replace("bending_damping", "bending_retardation_time");
    assert_eq!(fs::read_to_string(at("old.toml")).unwrap(), new);
    assert_eq!(fs::read_to_string(at("old.toml.bak")).unwrap(), old);
    done(run(folder.path(), &["check", "old.toml"]));
    assert_eq!(run(folder.path(), &["migrate", "old.toml", "--check"]).code, Some(0));
}

#[test]
fn check_builds_without_running() {
    let folder = folder();
    let check = done(run(folder.path(), &["check", "swing.toml", "--set", "n=7"]));
    for line in
        ["rope (cable)", "weight", "hook (3 equations)", "48, and 3 multipliers", "non-zeros", "rope.end.x"]
    {
        assert!(check.contains(line), "no {line} in\n{check}");
    }
    assert!(!folder.path().join("runs").exists());
    for bundled in ropewalk::bundled() {
        let said = run(folder.path(), &["check", bundled.name]);
        assert_eq!((said.code, said.stderr.as_str()), (Some(0), ""), "{}", bundled.name);
    }
}

#[test]
fn help_and_version_are_no_errors_and_wrong_usage_is() {
    let folder = folder();
    assert!(done(run(folder.path(), &["--help"])).contains("Exit codes: 0 done, 1 "));
    assert!(done(run(folder.path(), &["--version"])).contains(env!("CARGO_PKG_VERSION")));
    for wrong in [&["walk"][..], &["run"], &["run", "swing.toml", "--fast"], &[]] {
        let said = run(folder.path(), wrong);
        assert_eq!((said.code, said.stdout.as_str()), (Some(2), ""), "{wrong:?}");
        assert!(said.stderr.contains("Usage"), "{}", said.stderr);
    }
    run(folder.path(), &["run", "swing.toml", "--set", "lenght=3"]).refused(&["lenght", "mass"]);
}

#[test]
fn statics_call_their_first_column_load_factor_everywhere() {
    let folder = folder();
    let report = done(run(folder.path(), &["run", "catenary", "--set", "elements=6", "--out", "out"]));
    assert!(report.contains("at load factor 1\n"), "{report}");
    // the names of the history, and a unit for each kind of number
    let values = report.lines().find(|l| l.contains("left ")).unwrap_or_else(|| panic!("{report}"));
    assert!(values.contains("fx -") && values.contains("magnitude ") && values.ends_with(" N"), "{values}");
    let out = folder.path().join("out");
    assert!(text(out.join("history.csv")).starts_with("load factor [-],middle.x [m],"));
    let shapes = text(out.join("shapes.csv"));
    assert!(shapes.starts_with("load factor [-],part,s [m],x [m],y [m],z [m],"), "{shapes}");
    assert!(shapes.lines().nth(1).unwrap().starts_with("0,cable,0,"), "{shapes}");
    let summary = json(out.join("summary.json"));
    assert_eq!(summary["final"]["load factor"], 1.0);
    assert!(summary["final"]["left.fx"].as_f64() < Some(0.0) && summary["final"]["left.reaction"].is_null());
    let shapes = text(out.join("plots/shape_side.svg"));
    let labels = texts(&shapes);
    assert!(labels.contains(&"load factor 1") && !labels.iter().any(|l| l.ends_with(" s")), "{labels:?}");
}

#[test]
fn a_slack_line_that_could_lie_otherwise_is_said_once() {
    let folder = folder();
    for (name, how) in
        [("still", "analysis = \"statics\""), ("moves", "duration = 0.1, from_equilibrium = true")]
    {
        let scene = format!(
            r#"
            run = {{ {how} }}
            [[elements]]
            type = "cable"
            name = "line"
            points = [[0, 0, -60], [180, 0, -60], [200, 0, 0]]
            radius = 3
            length = 300
            elements = 30
            section = {{ mass = 43.5, ea = 2e8, diameter = 0.09 }}
            [[constraints]]
            type = "spherical"
            name = "anchor"
            marker = "line.start"
            [[constraints]]
            type = "spherical"
            name = "fairlead"
            marker = "line.end"
            [[forces]]
            type = "gravity"
            [[forces]]
            type = "bed"
            point = [0, 0, -60.045]
            stiffness = 1e6
            "#
        );
        let file = format!("{name}.toml");
        std::fs::write(folder.path().join(&file), scene).unwrap();
        let said = run(folder.path(), &["run", &file, "--no-report", "--no-plots"]);
        assert_eq!(
            (said.code, said.stderr.matches("could as well lie otherwise").count()),
            (Some(0), 1),
            "{}",
            said.stderr
        );
        assert!(said.stderr.contains("`ei`") && said.stderr.contains("\"laid\""), "{}", said.stderr);
        assert!(said.stderr.matches("warning").count() < 6, "{}", said.stderr);
    }
}

#[test]
fn shapes_tell_the_part_and_the_unstretched_arc_length_of_every_point() {
    let folder = folder();
    done(run(folder.path(), &["run", "swing.toml", "--out", "out"]));
    let shapes = text(folder.path().join("out/shapes.csv"));
    let mut rows = shapes.lines().map(|l| l.split(',').collect::<Vec<_>>());
    assert_eq!(rows.next().unwrap()[..6], ["t [s]", "part", "s [m]", "x [m]", "y [m]", "z [m]"]);
    let rows: Vec<_> = rows.collect();
    // 9 snapshots of 4 elements, each drawn by 8 pieces
    assert_eq!(rows.len(), 9 * 33);
    for (k, row) in rows.iter().enumerate() {
        let s: f64 = row[2].parse().unwrap();
        assert!(row[1] == "rope" && (s - (k % 33) as f64 / 32.0).abs() < 1e-12, "{row:?}");
    }
}

#[test]
fn what_was_computed_is_kept_when_the_solver_gives_up() {
    let folder = folder();
    // a weight on a rod of 1 m is led sideways, at last farther than the rod is long
    let scene = SWING.replace("duration = \"0.3 s\"", "duration = \"2 s\"")
        + r#"
[[elements]]
type = "point_mass"
name = "weight"
marker = [0, 0, -1]
mass = "1 kg"

[[constraints]]
type = "distance"
name = "rod"
marker = "weight"
to = [0, 0, 0]

[[motions]]
type = "straight"
name = "away"
speed = "1 m/s"
ramp = "0.5 s"

[[constraints]]
type = "coordinate"
name = "hand"
marker = "weight"
direction = [1, 0, 0]
motion = "away"
"#;
    fs::write(folder.path().join("torn.toml"), scene).unwrap();
    let said = run(folder.path(), &["run", "torn.toml", "--out", "out"]);
    assert_eq!(said.code, Some(3), "{}", said.stderr);
    assert!(said.stderr.contains("error: ") && said.stderr.contains("out"), "{}", said.stderr);
    assert!(said.stdout.contains("failed"), "{}", said.stdout);
    let out = folder.path().join("out");
    let summary = json(out.join("summary.json"));
    assert_eq!(summary["status"], "failed");
    assert!(summary["message"].as_str().unwrap().contains("t = "), "{summary}");
    // the rod is level at 1.25 s
    let history = text(out.join("history.csv"));
    let t: f64 = history.lines().last().unwrap().split(',').next().unwrap().parse().unwrap();
    assert!((1.2..1.25).contains(&t), "{t}");
    for file in ["scene.toml", "manifest.json", "plots/rope.end.svg", "report.html", "field.npy"] {
        assert!(out.join(file).exists(), "{file}");
    }
}

#[cfg(unix)]
#[test]
fn signals_end_a_run_in_good_order() {
    for (signal, name, code) in signals() {
        stopped_by(signal, name, code);
    }
}

#[cfg(unix)]
fn stopped_by(signal: &str, name: &str, code: i32) {
    let folder = folder();
    let scene = SWING.replace("duration = \"0.3 s\"", "duration = \"10000 s\"");
    fs::write(folder.path().join("long.toml"), scene).unwrap();
    let arguments = ["run", "long.toml", "--out", "out"];
    let mut command = program(folder.path(), &arguments);
    let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    // rows are written while it runs
    let start = Instant::now();
    let history = folder.path().join("out/history.csv");
    let begun = || fs::metadata(&history).is_ok_and(|m| m.len() > 1000);
    while !begun() && start.elapsed() < Duration::from_secs(20) {
        std::thread::sleep(Duration::from_millis(20));
    }
    let kill = format!("kill -{signal} {}", child.id());
    assert!(Command::new("sh").args(["-c", &kill]).status().unwrap().success());
    let said = Said::of(child.wait_with_output().unwrap());
    assert!(start.elapsed() < Duration::from_secs(30));
    assert_eq!(said.code, Some(code), "{}", said.stderr);
    assert!(said.stdout.contains("interrupted"), "{}", said.stdout);
    let summary = json(folder.path().join("out/summary.json"));
    assert_eq!(summary["status"], "interrupted");
    assert_eq!(summary["message"], format!("stopped by {name}"));
    assert!(summary["counts"]["steps"].as_u64() > Some(0));
    let rows = text(&history);
    assert!(
        rows.ends_with('\n')
            && rows.lines().last().unwrap().split(',').count()
                == rows.lines().next().unwrap().split(',').count()
    );
    let t: f64 = rows.lines().last().unwrap().split(',').next().unwrap().parse().unwrap();
    assert!(t > 0.0 && t < 10000.0);
    for file in [
        "scene.toml",
        "manifest.json",
        "plots/rope.end.svg",
        "plots/shape_side.svg",
        "report.html",
        "field.npy",
    ] {
        assert!(folder.path().join("out").join(file).exists(), "{file}");
    }
}

#[test]
fn a_new_scene_keeps_the_format_of_the_one_it_comes_from() {
    let folder = folder();
    let said = run(folder.path(), &["new", "own.json", "--from", "swing.toml"]);
    assert_eq!(said.code, Some(2));
    assert!(said.stderr.contains("name the new scene `own.toml`"), "{}", said.stderr);
    assert!(!folder.path().join("own.json").exists());
}

/// On a full disk results were cut off without a word.
#[test]
#[cfg(target_os = "linux")]
fn what_cannot_be_written_to_standard_output_is_an_error() {
    let folder = folder();
    for args in [vec!["schema"], vec!["list"], vec!["completions", "bash"]] {
        let full = fs::OpenOptions::new().write(true).open("/dev/full").expect("a device that is full");
        let done =
            program(folder.path(), &args).stdout(full).stderr(Stdio::piped()).output().expect("it runs");
        let told = String::from_utf8_lossy(&done.stderr);
        assert_eq!(done.status.code(), Some(2), "{args:?}: {told}");
        assert!(told.contains("can't write to standard output"), "{args:?}: {told}");
    }
}
