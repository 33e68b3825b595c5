//! Sweeps as a user calls them: what they leave behind, what they compute again, what they say of failed runs.

use crate::program::{Said, program, run};
use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant, SystemTime};

/// A weight on a short cable; a hand may lead it away until the cable's rod can't follow.
pub const SWING: &str = r#"
title = "A swing"

[parameters]
mass = { default = "2 kg/m", description = "mass per length" }
n = { default = 3, description = "number of elements" }
speed = { default = "0 m/s", description = "speed of the hand" }
duration = "0.1 s"
law = "L4"

[run]
duration = "$duration"
output = "0.02 s"

[[elements]]
type = "cable"
name = "rope"
points = [[0, 0, 0], ["1 m", 0, 0]]
elements = "$n"
longitudinal = "$law"
section = { mass = "$mass", ea = "20 kN", ei = 1 }

[[constraints]]
type = "spherical"
name = "hook"
marker = "rope.start"

[[forces]]
type = "gravity"

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
speed = "$speed"
ramp = "0.05 s"

[[constraints]]
type = "coordinate"
name = "hand"
marker = "weight"
direction = [1, 0, 0]
motion = "away"

[[records]]
type = "position"
of = "rope.end"

[[records]]
type = "reaction"
of = "hook"
"#;

pub fn text(path: impl AsRef<Path>) -> String {
    let path = path.as_ref();
    fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// A folder with the scene in it.
pub fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("swing.toml"), SWING).unwrap();
    folder
}

/// `ropewalk sweep swing.toml` with more arguments, separated by blanks.
fn sweep(folder: &Path, arguments: &str) -> Said {
    let arguments: Vec<&str> =
        ["sweep", "swing.toml"].into_iter().chain(arguments.split_whitespace()).collect();
    run(folder, &arguments)
}

#[track_caller]
pub fn done(said: Said) -> String {
    assert_eq!(said.code, Some(0), "{}", said.stderr);
    said.stdout
}

/// A table: each row as heading and cell.
pub fn table(path: impl AsRef<Path>) -> Vec<HashMap<String, String>> {
    let text = text(path);
    assert!(text.ends_with('\n'));
    let mut lines = text.lines().map(cells);
    let headings = lines.next().unwrap();
    let row = |cells: Vec<String>| {
        assert_eq!(cells.len(), headings.len());
        headings.iter().cloned().zip(cells).collect()
    };
    lines.map(row).collect()
}

/// The cells of a line of CSV.
pub fn cells(line: &str) -> Vec<String> {
    let mut cells = vec![String::new()];
    let mut quoted = false;
    for c in line.chars() {
        match c {
            '"' => quoted = !quoted,
            ',' if !quoted => cells.push(String::new()),
            c => cells.last_mut().unwrap().push(c),
        }
    }
    cells
}

/// A pendulum swings on and a weight that is damped doesn't: the one is named, and its mean is that of its last tenth.
#[test]
fn last_values_that_are_not_steady_are_said_and_may_be_means() {
    const SCENE: &str = r#"
[parameters]
mass = { default = "1 kg", description = "mass of both" }
[run]
duration = "60 s"
output = "0.05 s"
[[elements]]
type = "point_mass"
name = "swinging"
marker = [1, 0, 0]
mass = "$mass"
[[elements]]
type = "point_mass"
name = "damped"
marker = [1, 0, 5]
mass = "$mass"
[[forces]]
type = "spring"
name = "free"
marker = "swinging"
to = [0, 0, 0]
stiffness = 10
length = 0.8
[[forces]]
type = "spring"
name = "braked"
marker = "damped"
to = [0, 0, 5]
stiffness = 10
damping = 5
length = 0.8
[[records]]
type = "position"
of = "swinging"
[[records]]
type = "position"
of = "damped"
"#;
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("swing.toml"), SCENE).unwrap();
    let report = done(sweep(folder.path(), "--vary mass=1,2"));
    assert!(report.contains("unsteady  swinging.x in 2 of 2 runs"), "{report}");
    assert!(report.contains("over the last 10 % of the run") && report.contains("--report mean"), "{report}");
    assert!(!report.contains("damped.x in") && !report.contains("swinging.y in"), "{report}");
    let out = folder.path().join("runs/swing-sweep");
    let rows = table(out.join("table.csv"));
    let value = |row: usize, what: &str| rows[row][&format!("{what} swinging.x [m]")].parse::<f64>().unwrap();
    for row in 0..2 {
        assert!(value(row, "tail max") - value(row, "tail min") > 0.3);
        assert!((value(row, "tail mean") - 0.8).abs() < 0.05, "{}", value(row, "tail mean"));
    }
    // nothing is computed again for another value of the same runs
    let before = times(&out);
    let report = done(sweep(folder.path(), "--vary mass=1,2 --report mean --over 50%"));
    assert_eq!(times(&out), before);
    assert!(!report.contains("unsteady") && report.contains("mean of the last 50 % of the run"), "{report}");
    let means = table(out.join("tables/swinging.x-mean.csv"));
    let again = table(out.join("table.csv"));
    assert_eq!(means[0]["swinging.x [m]"], again[0]["tail mean swinging.x [m]"]);
    assert!(out.join("plots/swinging.x-mean.svg").exists());
    let said = sweep(folder.path(), "--vary mass=1,2 --over 2");
    assert!(said.code == Some(2) && said.stderr.contains("expected a share of the run"), "{}", said.stderr);
}

/// When files were written, by path below the folder of the runs.
fn times(out: &Path) -> HashMap<PathBuf, SystemTime> {
    let runs = fs::read_dir(out.join("runs")).unwrap().map(|e| e.unwrap().path());
    runs.map(|p| (p.clone(), fs::metadata(p.join("summary.json")).unwrap().modified().unwrap())).collect()
}

/// The table without what a clock says.
pub fn timeless(path: impl AsRef<Path>) -> Vec<Vec<String>> {
    let rows = text(path);
    let cpu = cells(rows.lines().next().unwrap()).iter().position(|h| h == "cpu [s]").unwrap();
    let without = |line| {
        let mut cells = cells(line);
        cells.remove(cpu);
        cells
    };
    rows.lines().map(without).collect()
}

const GRID: &str = "--vary mass=2kg/m,3 --vary n=2,3,4 --set duration=0.06";
const NAMES: [&str; 6] =
    ["mass=2kg_m,n=2", "mass=2kg_m,n=3", "mass=2kg_m,n=4", "mass=3,n=2", "mass=3,n=3", "mass=3,n=4"];

#[test]
fn every_combination_is_the_run_that_one_would_make_alone() {
    let folder = folder();
    let at = |path: &str| folder.path().join(path);
    let report = done(sweep(folder.path(), &format!("{GRID} --jobs 2")));
    for word in ["mass [kg/m]", "6 finished", "CPU time", "runs/swing-sweep", "table.csv"] {
        assert!(report.contains(word), "no {word} in\n{report}");
    }
    let rows = table(at("runs/swing-sweep/table.csv"));
    assert_eq!(rows.iter().map(|r| r["run"].as_str()).collect::<Vec<_>>(), NAMES);
    for (k, row) in rows.iter().enumerate() {
        assert_eq!((row["mass [kg/m]"].as_str(), row["status"].as_str()), (["2", "3"][k / 3], "finished"));
        assert_eq!(row["n"], ["2", "3", "4"][k % 3]);
        assert!(
            row["steps"].parse::<u64>().unwrap() > 0 && row["newton iterations"].parse::<u64>().unwrap() > 0
        );
        assert!(row["cpu [s]"].parse::<f64>().unwrap() > 0.0);
        let name = row["run"].as_str();
        let out = format!("alone/{k}");
        let sets = [format!("mass={}", ["2 kg/m", "3"][k / 3]), format!("n={}", row["n"])];
        done(run(
            folder.path(),
            &[
                "run",
                "swing.toml",
                "--set",
                &sets[0],
                "--set",
                &sets[1],
                "--set",
                "duration=0.06",
                "--out",
                &out,
                "-q",
            ],
        ));
        for file in ["history.csv", "manifest.json"] {
            let swept = text(at("runs/swing-sweep/runs").join(name).join(file));
            assert!(swept == text(at(&out).join(file)), "{name}: {file}");
        }
        // last, least and largest values are those of the history
        let history = text(at(&out).join("history.csv"));
        let z = cells(history.lines().next().unwrap()).iter().position(|h| h == "rope.end.z [m]").unwrap();
        let z: Vec<f64> = history.lines().skip(1).map(|l| cells(l)[z].parse().unwrap()).collect();
        let value = |what: &str| row[&format!("{what} rope.end.z [m]")].parse::<f64>().unwrap();
        assert_eq!(value("final"), *z.last().unwrap());
        assert_eq!(value("min"), z.iter().copied().fold(f64::INFINITY, f64::min));
        assert_eq!(value("max"), z.iter().copied().fold(f64::NEG_INFINITY, f64::max));
        assert_eq!(row["final t [s]"], "0.06");
    }
    for plot in ["rope.end.z", "rope.end.z-final", "hook.magnitude"] {
        let svg = text(at(&format!("runs/swing-sweep/plots/{plot}.svg")));
        for label in ["swing", "n=4"] {
            assert!(svg.starts_with("<svg") && svg.contains(label), "{plot}: no {label}");
        }
    }
    assert!(text(at("runs/swing-sweep/plots/rope.end.z-final.svg")).contains("mass [kg/m]"));
    // last values once more, by the first parameter
    let finals = table(at("runs/swing-sweep/tables/rope.end.z-final.csv"));
    for row in &rows {
        let own = finals.iter().find(|f| f["mass [kg/m]"] == row["mass [kg/m]"]).unwrap();
        assert_eq!(own[&format!("rope.end.z [m]: n={}", row["n"])], row["final rope.end.z [m]"]);
    }
    let manifest: serde_json::Value = serde_json::from_str(&text(at("runs/swing-sweep/sweep.json"))).unwrap();
    assert_eq!(manifest["ropewalk"], env!("CARGO_PKG_VERSION"));
    assert_eq!((&manifest["scenes"][0]["text"], &manifest["runs"]), (&SWING.into(), &6.into()));
    assert_eq!(manifest["vary"][0], serde_json::json!({ "name": "mass", "values": ["2kg/m", "3"] }));
}

#[test]
fn the_number_of_jobs_changes_nothing() {
    let folder = folder();
    for jobs in ["1", "2", "5"] {
        done(sweep(folder.path(), &format!("{GRID} --jobs {jobs} --out {jobs} --quiet")));
    }
    let at = |jobs: &str, file: &str| folder.path().join(jobs).join(file);
    for jobs in ["2", "5"] {
        assert_eq!(timeless(at("1", "table.csv")), timeless(at(jobs, "table.csv")));
        for name in NAMES {
            let file = format!("runs/{name}/history.csv");
            assert!(text(at("1", &file)) == text(at(jobs, &file)), "{file}");
        }
        assert!(text(at("1", "plots/rope.end.x.svg")) == text(at(jobs, "plots/rope.end.x.svg")));
    }
}

#[test]
fn what_is_complete_is_not_computed_again() {
    let folder = folder();
    let out = folder.path().join("out");
    let command = format!("{GRID} --out out");
    done(sweep(folder.path(), &command));
    let (first, before) = (timeless(out.join("table.csv")), times(&out));
    let report = done(sweep(folder.path(), &command));
    assert!(report.contains("6 of them were there already"), "{report}");
    assert_eq!(times(&out), before);

    // one is deleted, four are damaged, each in another way
    let at = |k: usize, file: &str| out.join("runs").join(NAMES[k]).join(file);
    fs::remove_dir_all(out.join("runs").join(NAMES[0])).unwrap();
    let history = text(at(1, "history.csv"));
    fs::write(at(1, "history.csv"), &history[..history.len() * 2 / 3]).unwrap();
    fs::remove_file(at(2, "summary.json")).unwrap();
    fs::write(at(3, "summary.json"), text(at(3, "summary.json")).replace("finished", "interrupted")).unwrap();
    fs::write(at(4, "scene.toml"), text(at(4, "scene.toml")).replace("20 kN", "21 kN")).unwrap();
    fs::write(out.join("table.csv"), "run,mass").unwrap();
    let report = done(sweep(folder.path(), &command));
    assert!(report.contains("1 of them were there already"), "{report}");
    assert_eq!(timeless(out.join("table.csv")), first);
    assert_eq!(text(at(1, "history.csv")), history);
    let after = times(&out);
    let kept: Vec<&PathBuf> = before.iter().filter(|(p, t)| after[*p] == **t).map(|(p, _)| p).collect();
    assert_eq!(kept, [&out.join("runs").join(NAMES[5])]);

    // and all of them when that is asked for
    fs::write(at(0, "mine.txt"), "mine").unwrap();
    let report = done(sweep(folder.path(), &format!("{command} --fresh")));
    assert!(!report.contains("already"), "{report}");
    assert_eq!(timeless(out.join("table.csv")), first);
    assert!(!at(0, "mine.txt").exists());
}

#[test]
fn without_a_folder_the_same_sweep_goes_on_and_another_has_a_number() {
    let folder = folder();
    let first = "--vary n=2,3 --set duration=0.02";
    assert!(done(sweep(folder.path(), first)).contains("runs/swing-sweep\n"));
    assert!(done(sweep(folder.path(), "--vary n=2,4 --set duration=0.02")).contains("runs/swing-sweep-2\n"));
    let again = done(sweep(folder.path(), first));
    assert!(
        again.contains("runs/swing-sweep\n") && again.contains("2 of them were there already"),
        "{again}"
    );
}

#[test]
fn a_folder_of_something_else_is_refused() {
    let folder = folder();
    let first = "--vary n=2,3 --set duration=0.02 --out out";
    done(sweep(folder.path(), first));
    let table = text(folder.path().join("out/table.csv"));
    for (arguments, difference) in [
        ("--vary n=2,4 --set duration=0.02", "of n=2,3"),
        ("--vary n=2,3 --vary mass=1 --set duration=0.02", "of n=2,3"),
        ("--vary n=2,3", "with duration=0.02 set parameters"),
    ] {
        let said = sweep(folder.path(), &format!("{arguments} --out out"));
        said.refused(&["out holds another sweep", difference, "--out", "--fresh"]);
    }
    fs::write(folder.path().join("swing.toml"), SWING.replace("20 kN", "30 kN")).unwrap();
    sweep(folder.path(), first).refused(&["another sweep, of swing before the scene was changed"]);
    fs::copy(folder.path().join("swing.toml"), folder.path().join("other.toml")).unwrap();
    let other = run(folder.path(), &["sweep", "other.toml", "--vary", "n=2,3", "--out", "out"]);
    other.refused(&["another sweep, of swing:"]);
    assert_eq!(text(folder.path().join("out/table.csv")), table);
    let manifest = text(folder.path().join("out/sweep.json"));
    fs::write(folder.path().join("out/sweep.json"), &manifest[..50]).unwrap();
    sweep(folder.path(), first).refused(&["damaged", "--fresh"]);

    fs::create_dir(folder.path().join("mine")).unwrap();
    fs::write(folder.path().join("mine/letter.txt"), "dear").unwrap();
    for more in ["", "--fresh"] {
        sweep(folder.path(), &format!("--vary n=2 --out mine {more}"))
            .refused(&["mine is not empty", "--out"]);
    }
    assert_eq!(text(folder.path().join("mine/letter.txt")), "dear");
    done(sweep(folder.path(), &format!("{first} --fresh -q")));
}

#[test]
fn a_failed_run_is_reported_and_the_others_are_kept() {
    let folder = folder();
    let arguments = "--vary speed=0,20m/s,0.1m/s --vary n=2,3 --out out --jobs 2";
    let said = sweep(folder.path(), arguments);
    assert_eq!(said.code, Some(3), "{}", said.stderr);
    for name in ["speed=20m_s,n=2", "speed=20m_s,n=3"] {
        assert!(said.stderr.contains(&format!("error: {name}: ")), "{}", said.stderr);
        assert!(
            said.stderr.contains(&format!("results until then are in out/runs/{name}")),
            "{}",
            said.stderr
        );
    }
    assert!(
        said.stderr.contains("2 of 6 runs failed") && !said.stderr.contains("panicked"),
        "{}",
        said.stderr
    );
    assert!(said.stdout.contains("4 finished, 2 failed"), "{}", said.stdout);
    let rows = table(folder.path().join("out/table.csv"));
    for (k, row) in rows.iter().enumerate() {
        let failed = k / 2 == 1;
        assert_eq!(row["status"], if failed { "failed" } else { "finished" });
        assert_eq!(row["message"].contains("t = "), failed, "{}", row["message"]);
        let t: f64 = row["final t [s]"].parse().unwrap();
        assert_eq!(t < 0.1, failed, "{t}");
    }
    // those that failed are tried again, the others are not
    let before = times(&folder.path().join("out"));
    let again = sweep(folder.path(), arguments);
    assert_eq!(again.code, Some(3), "{}", again.stderr);
    assert!(again.stdout.contains("4 of them were there already"), "{}", again.stdout);
    let after = times(&folder.path().join("out"));
    for (path, time) in before {
        assert_eq!(after[&path] == time, !path.to_string_lossy().contains("speed=20"), "{}", path.display());
    }
}

#[test]
fn values_that_do_not_go_together_are_one_failed_run() {
    let folder = folder();
    // what one value leaves of a scene may not go with what another one leaves
    let scene = SWING.replace("section = {", "transverse = \"$bending\"\nsection = {");
    let scene =
        scene.replace("law = \"L4\"", "law = \"L4\"\nbending = \"T3\"").replace("1 kg\"", "$weight\"");
    let scene = scene.replace("duration = \"0.1 s\"", "duration = \"0.02 s\"\nweight = \"1 kg\"");
    fs::write(folder.path().join("swing.toml"), scene).unwrap();
    let said = sweep(folder.path(), "--vary law=L4,L1 --vary bending=T1,T3 --out out");
    assert_eq!(said.code, Some(3), "{}", said.stderr);
    assert!(said.stderr.contains("error: law=L1,bending=T3: "), "{}", said.stderr);
    let status: Vec<String> =
        table(folder.path().join("out/table.csv")).iter().map(|r| r["status"].clone()).collect();
    assert_eq!(status, ["finished", "finished", "finished", "refused"]);
}

#[test]
fn several_scenes_run_in_one_sweep() {
    let folder = folder();
    let other = SWING.replace("20 kN", "5 kN").replace("of = \"hook\"", "of = \"rod\"");
    fs::write(folder.path().join("soft.toml"), other).unwrap();
    let scenes = ["sweep", "swing.toml", "soft.toml", "--set", "duration=0.04", "--out", "out"];
    let with_n: Vec<&str> = scenes.into_iter().chain(["--vary", "n=2:3:1"]).collect();
    done(run(folder.path(), &with_n));
    let rows = table(folder.path().join("out/table.csv"));
    let names: Vec<&str> = rows.iter().map(|r| r["run"].as_str()).collect();
    assert_eq!(names, ["swing,n=2", "swing,n=3", "soft,n=2", "soft,n=3"]);
    assert_eq!((rows[3]["scene"].as_str(), rows[3]["n"].as_str()), ("soft", "3"));
    // what a scene doesn't record has no value
    assert_eq!(
        (rows[0]["final rod.magnitude [N]"].as_str(), rows[2]["final hook.fx [N]"].as_str()),
        ("", "")
    );
    assert!(rows[2]["final rod.magnitude [N]"].parse::<f64>().unwrap().is_finite());
    // and without any parameter
    let alone: Vec<&str> = scenes[..5].iter().copied().chain(["--out", "two", "-q"]).collect();
    assert_eq!(done(run(folder.path(), &alone)), "");
    assert_eq!(table(folder.path().join("two/table.csv"))[1]["run"], "soft");
}

#[test]
fn bad_input_is_refused_before_anything_runs() {
    let folder = folder();
    for (arguments, holds) in [
        ("", &["nothing is varied", "--vary speed=5kn,15kn"][..]),
        ("--vary spede=1", &["unknown parameter `spede`", "did you mean `speed`?", "--vary:1:1"]),
        ("--vary speed=1,2kg", &["\"2kg\" is a mass, expected a speed", "--vary:1:7"]),
        ("--vary n=2 --vary mass=2,3,x", &["\"x\" does not begin with a number", "--vary:1:6"]),
        ("--vary n=2,nan", &["nan is not a finite number"]),
        ("--vary n=2,-1", &["-1"]),
        ("--vary n=2,0", &["elements"]),
        ("--vary n", &["expected `name=value,value,...`"]),
        ("--vary n=", &["no value for `n`"]),
        ("--vary n=2,,3", &["an empty value for `n`"]),
        ("--vary n=2,3,2", &["`n` has the value `2` twice"]),
        ("--vary mass=1kg/m,1000g/m", &["`mass` has the value `1000g/m` twice"]),
        ("--vary n=2 --vary n=3", &["`n` is varied twice"]),
        ("--vary n=2,3 --set n=4", &["`n` is both set and varied"]),
        ("--vary n=2 --set spede=4", &["unknown parameter `spede`", "--set:1:1"]),
        ("--vary mass=1:1000:1 --vary speed=1:1000:1", &["1000000 combinations are more than 100000"]),
        ("--vary mass=0:1:1e-9", &["more than 100000 values"]),
        ("--vary mass=1:3:-1", &["steps never arrive"]),
        ("--vary law=L4,L5", &["L5"]),
        ("--vary n=2 --out swing.toml", &["is a file, not a folder"]),
        ("--vary n=2 --out swing.toml/x", &["is a file, not a folder"]),
    ] {
        sweep(folder.path(), arguments).refused(holds);
        let left = fs::read_dir(folder.path()).unwrap().count();
        assert_eq!(left, 1, "{arguments}");
    }
    for wrong in [&["sweep"][..], &["sweep", "swing.toml", "--vary", "n=2", "--jobs", "0"]] {
        let said = run(folder.path(), wrong);
        assert_eq!((said.code, said.stdout.as_str()), (Some(2), ""), "{}", said.stderr);
    }
    run(folder.path(), &["sweep", "swingg", "--vary", "n=2"]).refused(&["there is no bundled scene"]);
    run(folder.path(), &["sweep", "pendulum", "./swing.toml", "--vary", "n=2"])
        .refused(&["in the scene `pendulum`"]);
    let help = done(run(folder.path(), &["sweep", "--help"]));
    assert!(
        help.contains("ropewalk sweep hose-turn --vary speed=5kn,15kn,25kn --vary start=40,80,120"),
        "{help}"
    );
}

/// A sweep of which the last runs take for ever, once the first one is complete and the others compute.
#[cfg(unix)]
fn endless(folder: &Path) -> std::process::Child {
    let mut command = program(
        folder,
        &["sweep", "swing.toml", "--vary", "duration=0.02,10000,20000,30000", "--out", "out", "--jobs", "2"],
    );
    let (start, now) = (Instant::now(), SystemTime::now());
    let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let at = |file: &str| folder.join("out/runs").join(file);
    let begun = |d: &str| {
        fs::metadata(at(&format!("duration={d}/history.csv")))
            .is_ok_and(|m| m.len() > 1000 && m.modified().unwrap() > now)
    };
    while !(at("duration=0.02/summary.json").exists() && begun("10000") && begun("20000")) {
        assert!(start.elapsed() < Duration::from_secs(60));
        std::thread::sleep(Duration::from_millis(20));
    }
    child
}

#[cfg(unix)]
#[test]
fn ctrl_c_keeps_what_is_done_and_says_how_to_go_on() {
    let folder = folder();
    let child = endless(folder.path());
    let busy = run(
        folder.path(),
        &["sweep", "swing.toml", "--vary", "duration=0.02,10000,20000,30000", "--out", "out"],
    );
    busy.refused(&["another sweep is at work in out"]);
    let kill = format!("kill -INT {}", child.id());
    assert!(Command::new("sh").args(["-c", &kill]).status().unwrap().success());
    let said = Said::of(child.wait_with_output().unwrap());
    assert_eq!(said.code, Some(130), "{}", said.stderr);
    assert!(
        said.stderr.contains("1 of 4 runs are complete, the same command computes the others"),
        "{}",
        said.stderr
    );
    assert!(said.stdout.contains("1 finished, 2 interrupted, 1 not begun"), "{}", said.stdout);
    let rows = table(folder.path().join("out/table.csv"));
    let status: Vec<&str> = rows.iter().map(|r| r["status"].as_str()).collect();
    assert_eq!(status, ["finished", "interrupted", "interrupted"]);
    assert!(folder.path().join("out/plots/rope.end.z.svg").exists());
}

#[cfg(unix)]
#[test]
fn a_kill_leaves_nothing_broken() {
    let folder = folder();
    let mut child = endless(folder.path());
    let done_before = folder.path().join("out/runs/duration=0.02/history.csv");
    let history = text(&done_before);
    child.kill().unwrap();
    child.wait().unwrap();
    // the table may not be there yet, but then the runs are
    if folder.path().join("out/table.csv").exists() {
        assert_eq!(table(folder.path().join("out/table.csv"))[0]["status"], "finished");
    }
    assert_eq!(text(done_before), history);
    assert!(!folder.path().join("out/runs/duration=10000/summary.json").exists());
    let child = endless_again(folder.path());
    assert!(child.stdout.contains("1 of them were there already"), "{}", child.stdout);
}

/// The same sweep once more, stopped by Ctrl-C as soon as it computes.
#[cfg(unix)]
fn endless_again(folder: &Path) -> Said {
    let child = endless(folder);
    let kill = format!("kill -INT {}", child.id());
    assert!(Command::new("sh").args(["-c", &kill]).status().unwrap().success());
    Said::of(child.wait_with_output().unwrap())
}
