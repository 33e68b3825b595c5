//! What a run leaves behind for the eye: the page, the field record, files for ParaView; and `ropewalk view`.

use crate::program::{Said, program, run};
use ropewalk::report::{FieldRecord, Table, Watch};
use ropewalk::studies::run::page_of;
use ropewalk::{Leaves, RunOptions, SceneFile, Status};
use std::collections::HashMap;
use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::Stdio;
use std::time::Instant;

const SHORT: [&str; 5] = ["pendulum", "--set", "duration=0.1 s", "--set", "elements=8"];

fn done(said: Said) -> String {
    // slow machines say how far they are
    let errors: Vec<&str> = said.stderr.lines().filter(|l| !l.contains(" x real time")).collect();
    assert_eq!((said.code, errors), (Some(0), vec![]), "{}", said.stdout);
    said.stdout
}

fn pendulum(folder: &Path, more: &[&str]) -> String {
    done(run(folder, &[&["run"], &SHORT[..], more].concat()))
}

fn field(out: &Path) -> FieldRecord {
    FieldRecord::read_npy(&out.join("field.npy"), &out.join("bodies.npy")).unwrap()
}

/// Row of a table at a time.
fn row(table: &Table, t: f64) -> usize {
    table.columns[0].values.iter().position(|x| *x == t).unwrap()
}

#[test]
fn a_run_leaves_a_page_and_a_field_record_that_agree_with_its_tables() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let told = done(run(folder.path(), &["run", "hose-turn", "--set", "duration=60 s", "--out", "out"]));
    assert!(told.contains("report.html"), "{told}");
    let page = fs::read_to_string(out.join("report.html")).unwrap();
    assert!(page.len() < 2_000_000, "{}", page.len());
    assert!(page.contains("<title>A hose towed by a ship that starts to turn</title>"));

    let (mut field, history) = (field(&out), Table::read(&out.join("history.csv")).unwrap());
    field.read_forces_npy(&out.join("forces.npy")).unwrap();
    assert!((300..=361).contains(&field.times.len()), "{}", field.times.len());
    assert_eq!((field.times[0], *field.times.last().unwrap()), (0.0, 60.0));
    let hose = &field.lines[0];
    let names: Vec<&str> = hose.quantities.iter().map(|q| q.name.as_str()).collect();
    assert_eq!(
        (hose.name.as_str(), names),
        ("hose", vec!["tension", "curvature", "bending moment", "speed"])
    );
    let ship = field.bodies.iter().find(|b| b.name == "ship").unwrap();
    let column = |name: &str, k: usize| history.column(name).unwrap().values[k];
    for (k, t) in field.times.iter().enumerate() {
        let (row, snapshot) = (row(&history, *t), &hose.snapshots[k]);
        for (i, axis) in ["x", "y", "z"].iter().enumerate() {
            assert_eq!(snapshot.position.last().unwrap()[i], column(&format!("hose.end.{axis}"), row));
            let start = column(&format!("hose.start.{axis}"), row);
            assert!((ship.poses[k].position[i] - start).abs() < 1e-9, "the ship is where the hose begins");
        }
        assert_eq!(snapshot.values[0][0], column("hose.start.tension", row));
        let middle = snapshot.s.iter().position(|s| *s == 15.0).unwrap();
        assert_eq!(snapshot.values[0][middle], column("hose.middle.tension", row));
        assert_eq!(snapshot.values[1][middle], column("hose.middle.curvature", row));
        let v = snapshot.velocity[3];
        let speed = v.iter().map(|x| x * x).sum::<f64>().sqrt();
        assert_eq!(snapshot.values[3][3], speed);
    }
    // the ship looks where it goes: at right angles to the way to the middle of its circle
    let [w, _, _, z] = ship.poses.last().unwrap().orientation;
    let ahead = [1.0 - 2.0 * z * z, 2.0 * w * z];
    let x = &ship.poses.last().unwrap().position;
    assert!((ahead[0] * x[0] + ahead[1] * (x[1] - 25.0)).abs() < 1e-3 * 25.0, "{ahead:?} {x:?}");

    // the forces are those of the records, and of the scene
    let force = |name: &str| {
        let names: Vec<&str> = field.forces.iter().map(|f| f.name.as_str()).collect();
        field.forces.iter().find(|f| f.name == name).unwrap_or_else(|| panic!("{name} isn't in {names:?}"))
    };
    let (reaction, weight) = (force("reaction: ship"), force("weight: hose"));
    for (k, t) in field.times.iter().enumerate() {
        for (i, axis) in ["x", "y", "z"].iter().enumerate() {
            assert_eq!(reaction.forces[k][i], column(&format!("ship.f{axis}"), row(&history, *t)));
            assert_eq!(reaction.points[k][i], hose.snapshots[k].position[0][i]);
        }
        assert!((weight.forces[k][2] + 0.5 * 30.0 * 9.81).abs() < 1e-9 && weight.forces[k][0] == 0.0);
    }
    // drag holds back
    let drag = force("drag: hose").forces.last().unwrap();
    let middle = hose.snapshots.last().unwrap().velocity[hose.snapshots[0].s.len() / 2];
    assert!((0..3).map(|i| drag[i] * middle[i]).sum::<f64>() < 0.0);

    // steps and what limited them
    let steps = fs::read_to_string(out.join("steps.csv")).unwrap();
    assert!(steps.starts_with("t [s],least [s],greatest [s],limited by\n") && steps.contains(" error\n"));
    let summary: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(out.join("summary.json")).unwrap()).unwrap();
    let limits = summary["limits"].as_object().unwrap();
    let all: u64 = limits.values().map(|n| n.as_u64().unwrap()).sum();
    assert_eq!(Some(all), summary["counts"]["steps"].as_u64(), "{limits:?}");

    // the shapes are some of its snapshots
    let shapes = fs::read_to_string(out.join("shapes.csv")).unwrap();
    let mut lines = shapes.lines();
    let head = "t [s],part,s [m],x [m],y [m],z [m],vx [m/s],vy [m/s],vz [m/s],speed [m/s],tension [N],curvature [1/m],\
                bending moment [N m]";
    assert_eq!(lines.next(), Some(head));
    let mut points: HashMap<u64, usize> = HashMap::new();
    let mut compared = 0;
    for line in lines.filter(|line| line.split(',').nth(1) == Some("hose")) {
        let cells: Vec<&str> = line.split(',').collect();
        let number = |k: usize| cells[k].parse::<f64>().unwrap();
        let at = points.entry(number(0).to_bits()).or_default();
        if let Some(k) = field.times.iter().position(|t| *t == number(0)) {
            let (snapshot, i) = (&hose.snapshots[k], *at);
            assert_eq!([number(2), number(3)], [snapshot.s[i], snapshot.position[i][0]]);
            let values: Vec<f64> = snapshot.values.iter().map(|v| v[i]).collect();
            assert_eq!([number(10), number(11), number(12), number(9)], values[..]);
            compared += 1;
        }
        *at += 1;
    }
    assert_eq!((points.len(), compared), (25, 25 * hose.snapshots[0].s.len()));
}

#[test]
fn what_nobody_wants_is_left_away() {
    let folder = tempfile::tempdir().unwrap();
    pendulum(folder.path(), &["--no-report", "--no-plots", "--out", "out"]);
    let mut names: Vec<_> = fs::read_dir(folder.path().join("out"))
        .unwrap()
        .map(|e| e.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    assert_eq!(names, ["history.csv", "manifest.json", "scene.toml", "shapes.csv", "summary.json"]);
    // a view makes the page of what is there, and says what isn't
    let told = done(run(folder.path(), &["view", "out"]));
    assert_eq!(told.trim(), Path::new("out").join("report.html").display().to_string());
    let page = page_of(&folder.path().join("out")).unwrap();
    assert_eq!(page.history.rows(), 11);
    assert!(page.warnings[0].ends_with("field.npy"), "{:?}", page.warnings);
}

#[test]
fn a_run_that_is_stopped_has_a_page() {
    let folder = tempfile::tempdir().unwrap();
    let file = SceneFile::open("pendulum", &["duration=1 s".into()], ropewalk::bundled()).unwrap();
    let out = folder.path().join("stopped");
    let watch = Watch::default().until(Some(Instant::now()));
    let options = RunOptions { out: Some(out.clone()), watch, ..RunOptions::default() };
    let outcome = ropewalk::run(&file, &options, &mut |_| {}).unwrap();
    assert_eq!(
        (outcome.summary.status, outcome.page.unwrap().status.as_str()),
        (Status::Interrupted, "interrupted")
    );
    assert!(out.join("report.html").exists() && out.join("field.npy").exists());
}

#[test]
fn a_load_path_has_a_page_over_the_load_factor() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    done(run(folder.path(), &["run", "cantilever", "--out", "out"]));
    assert!(out.join("report.html").exists());
    let page = page_of(&out).unwrap();
    assert_eq!((page.history.columns[0].name.as_str(), page.status.as_str()), ("load factor", "finished"));
    assert_eq!((page.field.times.len(), *page.field.times.last().unwrap()), (11, 1.0));
    let names: Vec<&str> = page.field.lines[0].quantities.iter().map(|q| q.name.as_str()).collect();
    assert_eq!(names, ["tension", "curvature", "bending moment"], "nothing moves");
    assert_eq!(page.field.lines[0].quantities[2].unit, "N m");
    assert_eq!(page.panels[0].title, "Position of beam.end");
}

#[test]
fn a_view_of_nothing_ends_with_one_message() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("empty")).unwrap();
    fs::write(folder.path().join("file"), "").unwrap();
    for (name, words) in [
        ("empty", "holds neither history.csv nor field.npy"),
        ("none", "doesn't exist"),
        ("file", "is a file"),
    ] {
        run(folder.path(), &["view", name]).refused(&[name, words, "ropewalk run"]);
        run(folder.path(), &["view", "--serve", "0", name]).refused(&[name, words]);
    }
    fs::write(folder.path().join("empty/field.npy"), "no array").unwrap();
    run(folder.path(), &["view", "empty"]).refused(&["field.npy", "doesn't begin"]);
}

#[test]
fn two_runs_stand_side_by_side() {
    let folder = tempfile::tempdir().unwrap();
    pendulum(folder.path(), &["--out", "a"]);
    done(run(
        folder.path(),
        &["run", "pendulum", "--set", "duration=0.15 s", "--set", "elements=6", "--out", "b"],
    ));
    let told = done(run(folder.path(), &["view", "a", "b"]));
    assert_eq!(told.trim(), Path::new("a").join("compare-b.html").display().to_string());
    let [a, b] = ["a", "b"].map(|name| folder.path().join(name));
    assert!(fs::read_to_string(a.join("compare-b.html")).unwrap().contains("<title>a and b</title>"));
    let page = ropewalk::studies::run::compare([&a, &b]).unwrap();
    let own = Table::read(&a.join("history.csv")).unwrap();
    let both = page.history.column("cable.end.x · a").unwrap();
    for (t, x) in own.columns[0].values.iter().zip(&own.column("cable.end.x").unwrap().values) {
        assert_eq!(both.values[row(&page.history, *t)], *x);
    }
    assert!(both.values.last().unwrap().is_nan(), "a ends before b");
    assert!(page.panels.iter().any(|p| p.columns == ["cable.end.x · a", "cable.end.x · b"]));
    let names: Vec<&str> = page.field.lines.iter().map(|l| l.name.as_str()).collect();
    assert_eq!(names, ["a: cable", "b: cable"]);
    assert!(page.summary.iter().any(|e| e.name == "ended" && e.value == "at t = 0.1 s  |  at t = 0.15 s"));
}

/// An array of a `.vtp` file by its name.
fn array(bytes: &[u8], name: &str) -> Vec<f64> {
    let mark = b"<AppendedData encoding=\"raw\">\n_";
    let raw = bytes.windows(mark.len()).position(|w| w == mark).unwrap() + mark.len();
    let head = String::from_utf8_lossy(&bytes[..raw]).into_owned();
    let tag = head.lines().find(|line| line.contains(&format!("Name=\"{name}\""))).unwrap();
    let offset: usize = tag.split("offset=\"").nth(1).unwrap().split('"').next().unwrap().parse().unwrap();
    let at = raw + offset;
    let length = u64::from_le_bytes(bytes[at..at + 8].try_into().unwrap()) as usize;
    bytes[at + 8..at + 8 + length].chunks(8).map(|b| f64::from_le_bytes(b.try_into().unwrap())).collect()
}

#[test]
fn files_for_paraview_hold_what_the_csv_holds() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    pendulum(folder.path(), &["--vtk", "--no-report", "--out", "out"]);
    assert!(!out.join("report.html").exists());
    let shapes = fs::read_to_string(out.join("shapes.csv")).unwrap();
    let list = fs::read_to_string(out.join("vtk.pvd")).unwrap();
    let files: Vec<(f64, String)> = list
        .lines()
        .filter(|line| line.contains("<DataSet"))
        .map(|line| {
            let of = |key: &str| {
                line.split(&format!("{key}=\"")).nth(1).unwrap().split('"').next().unwrap().to_string()
            };
            (of("timestep").parse().unwrap(), of("file"))
        })
        .collect();
    let mut compared = 0;
    for (t, file) in &files {
        let bytes = fs::read(out.join(file)).unwrap();
        let rows: Vec<Vec<f64>> = shapes
            .lines()
            .skip(1)
            .map(|line| line.split(',').filter_map(|cell| cell.parse().ok()).collect::<Vec<f64>>())
            .filter(|row| row[0] == *t)
            .collect();
        if rows.is_empty() {
            continue;
        }
        let of = |k: usize| rows.iter().map(|row| row[k]).collect::<Vec<f64>>();
        let places: Vec<f64> = rows.iter().flat_map(|row| row[2..5].to_vec()).collect();
        // behind the points of the line come those where forces act
        assert_eq!(array(&bytes, "Points")[..places.len()], places);
        let acting = array(&bytes, "Points").len() / 3 - rows.len();
        assert!(array(&bytes, "force [N]").chunks(3).filter(|f| **f != [0.0; 3]).count() == acting);
        let same = |name: &str, k: usize| assert_eq!(array(&bytes, name)[..rows.len()], of(k), "{name}");
        same("s [m]", 1);
        same("speed [m/s]", 8);
        same("tension [N]", 9);
        same("curvature [1/m]", 10);
        compared += 1;
    }
    assert_eq!((files.len(), compared), (11, 11));
}

#[test]
fn a_run_without_a_page_pays_for_none() {
    let folder = tempfile::tempdir().unwrap();
    let file = SceneFile::open("pendulum", &["duration=0.1 s".into()], ropewalk::bundled()).unwrap();
    let leaves = Leaves { report: false, plots: false, vtk: false };
    let options = RunOptions { out: Some(folder.path().join("out")), leaves, ..RunOptions::default() };
    let outcome = ropewalk::run(&file, &options, &mut |_| {}).unwrap();
    assert!(outcome.page.is_none() && outcome.pictures.is_empty());
    let shapes = fs::read_to_string(folder.path().join("out/shapes.csv")).unwrap();
    // what the guide says of shapes holds without a page as well
    assert!(!shapes.contains("NaN"), "{shapes}");
}

#[test]
fn the_page_of_a_run_is_served_to_this_machine_alone() {
    let folder = tempfile::tempdir().unwrap();
    pendulum(folder.path(), &["--no-report", "--out", "out"]);
    // as of a run that still goes on
    fs::remove_file(folder.path().join("out/summary.json")).unwrap();
    let mut child =
        program(folder.path(), &["view", "out", "--serve"]).stdout(Stdio::piped()).spawn().unwrap();
    let mut line = String::new();
    BufReader::new(child.stdout.take().unwrap()).read_line(&mut line).unwrap();
    let address = line.split("//").nth(1).unwrap().split('/').next().unwrap().to_string();
    assert!(address.starts_with("127.0.0.1:"), "{line}");
    let ask = |path: &str, host: &str| {
        let mut stream = TcpStream::connect(&address).unwrap();
        write!(stream, "GET {path} HTTP/1.1\r\nHost: {host}\r\n\r\n").unwrap();
        let mut text = String::new();
        stream.read_to_string(&mut text).unwrap();
        text
    };
    let page = ask("/", &address);
    let (head, body) = page.split_once("\r\n\r\n").unwrap();
    assert!(head.starts_with("HTTP/1.1 200 OK") && head.contains("\r\nRefresh: "), "{head}");
    assert!(body.contains("A flexible pendulum"), "{}", &body[..200]);
    assert!(ask("/", "elsewhere.example").starts_with("HTTP/1.1 403"));
    assert!(ask("/scene.toml", &address).starts_with("HTTP/1.1 404"));
    child.kill().unwrap();
    child.wait().unwrap();
}

#[test]
fn modes_and_sweeps_have_pages_too() {
    let folder = tempfile::tempdir().unwrap();
    done(run(folder.path(), &["modes", "pendulum", "--set", "elements=8", "--count", "3", "--out", "modes"]));
    let page = fs::read_to_string(folder.path().join("modes/report.html")).unwrap();
    assert!(page.contains("vibration modes</title>"));
    let sweep = [&["sweep"], &SHORT[..3], &["--vary", "elements=4,6", "--out", "sweep", "--quiet"]].concat();
    done(run(folder.path(), &sweep));
    let index = fs::read_to_string(folder.path().join("sweep/index.html")).unwrap();
    for words in ["runs/elements%3D4/", ">finished</td>", "plots/", "cable.end.x [m]"] {
        assert!(index.contains(words), "no {words} in\n{index}");
    }
    assert!(!folder.path().join("sweep/runs/elements=4/report.html").exists());
    let told = done(run(folder.path(), &["view", "sweep"]));
    assert_eq!(told.trim(), Path::new("sweep").join("index.html").display().to_string());
    run(folder.path(), &["view", "sweep", "modes"]).refused(&["sweep", "many runs"]);
    // and a page for one of its runs, asked for
    done(run(folder.path(), &["view", "sweep/runs/elements=4"]));
    assert!(folder.path().join("sweep/runs/elements=4/report.html").exists());
}

#[test]
fn figures_of_ones_own_are_drawn_from_runs() {
    let folder = tempfile::tempdir().unwrap();
    pendulum(folder.path(), &["--no-report", "--out", "out", "--watch", "cable.end.z"]);
    done(run(
        folder.path(),
        &["plot", "out", "cable.end.z", "--against", "cable.end.x", "--style", "paper", "-o", "path.svg"],
    ));
    let svg = fs::read_to_string(folder.path().join("path.svg")).unwrap();
    assert!(svg.starts_with("<svg") && svg.contains("cable.end.x [m]"));
    let told = done(run(folder.path(), &["plot", "out", "cable.end"]));
    assert_eq!(told.trim(), "cable.end.svg");
    run(folder.path(), &["plot", "out", "cable.ende"]).refused(&["no column `cable.ende`", "cable.end.x"]);
    run(folder.path(), &["plot", "out", "cable.end", "-o", "a.jpg"]).refused(&[".svg, .png or .pdf"]);
    if cfg!(feature = "raster") {
        done(run(folder.path(), &["plot", "out", "cable.end", "-o", "a.png"]));
        assert!(fs::read(folder.path().join("a.png")).unwrap().starts_with(b"\x89PNG"));
    } else {
        run(folder.path(), &["plot", "out", "cable.end", "-o", "a.pdf"]).refused(&[
            "feature `raster`",
            "--features raster",
            "rsvg-convert",
        ]);
    }
    run(folder.path(), &["plot", "nowhere", "x"]).refused(&["nowhere", "doesn't exist"]);
    let wrong =
        run(folder.path(), &[&["run"], &SHORT[..], &["--watch", "cable.end.w", "--out", "b"]].concat());
    wrong.refused(&["cable.end.w", "did you mean"]);
    assert!(!folder.path().join("b").exists());
}
