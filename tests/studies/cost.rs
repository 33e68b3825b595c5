//! What accuracy costs, settings for an accuracy, and certificates, as a user calls them.

use crate::program::{Said, program, run};
use ropewalk::core::integrator::{Scheme, Stepping};
use ropewalk::{Scene, simulate};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

/// Two masses on rods, let go upside down: chaotic, and without a mesh. No parameters.
const DOUBLE: &str = r#"
title = "A double pendulum"

[parameters]
duration = "20 s"

[run]
duration = "$duration"
output = "0.05 s"

[[elements]]
type = "point_mass"
name = "upper"
marker = [1, 0, 0]
mass = "1 kg"

[[elements]]
type = "point_mass"
name = "lower"
marker = [1, 0, 1]
mass = "1 kg"

[[constraints]]
type = "distance"
name = "one"
marker = "upper"
to = [0, 0, 0]

[[constraints]]
type = "distance"
name = "two"
marker = "lower"
to = "upper"

[[forces]]
type = "gravity"

[[records]]
type = "position"
of = "lower"
"#;

/// A sagging cable whose numbers all stand in their fields, with a fixed step.
const PLAIN: &str = r#"
title = "A cable let go"

[run]
duration = "0.3 s"
output = "0.05 s"

[solver]
stepping = { fixed = { h = "1 ms" } }

[[elements]]
type = "cable"
name = "rope"
points = [[0, 0, 0], ["1 m", 0, 0]]
elements = 8
section = { mass = "2 kg/m", ea = "20 kN", ei = 1 }

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
type = "position"
of = "rope.start"
"#;

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("double.toml"), DOUBLE).unwrap();
    fs::write(folder.path().join("plain.toml"), PLAIN).unwrap();
    folder
}

#[track_caller]
fn done(folder: &Path, arguments: &[&str]) -> Said {
    let said = run(folder, arguments);
    assert_eq!(said.code, Some(0), "{}\n{}", said.stdout, said.stderr);
    said
}

fn json(path: &Path) -> Value {
    serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap()
}

/// The scene that a study advises for an accuracy.
fn advised(folder: &Path, accuracy: &str) -> Option<Scene> {
    let path = folder.join(format!("advice/{accuracy}.toml"));
    path.exists().then(|| ropewalk::read(path).unwrap())
}

fn last(scene: &Scene, columns: &[&str]) -> Vec<f64> {
    let history = simulate(scene).unwrap();
    columns.iter().map(|c| history.last(c).unwrap()).collect()
}

fn apart(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
}

const GOALS: [&str; 5] = ["1e-2", "1e-3", "1e-4", "1e-5", "1e-6"];

#[test]
fn advice_for_a_cantilever_holds_against_the_elastica() {
    let there = folder();
    let (out, at) = ("study", there.path());
    let said = done(at, &["cost", "cantilever", "--of", "beam.end@1", "--out", out]);
    // with EA L^2 / EI = 1.6e5 and F L^2 / EI = 3, by integration of the differential equation; the size is that of the
    // undeformed beam
    let exact = [0.745584361489, 0.0, 0.603264433707];
    for goal in GOALS {
        let scene =
            advised(&at.join(out), goal).unwrap_or_else(|| panic!("nothing for {goal}\n{}", said.stdout));
        let error = apart(&last(&scene, &["beam.end.x", "beam.end.y", "beam.end.z"]), &exact);
        println!("{goal}: {error:.2e}");
        assert!(error <= 2.0 * goal.parse::<f64>().unwrap(), "{goal}: {error:e}");
    }
    let advice = json(&at.join("study/advice.json"));
    let costs: Vec<f64> =
        advice["advice"].as_array().unwrap().iter().map(|a| a["cpu_s"].as_f64().unwrap()).collect();
    assert!(costs.windows(2).all(|w| w[0] <= w[1]), "{costs:?}");
    for what in ["for 1 %: ", "for 1e-6: ", "Pareto", "--set elements="] {
        assert!(said.stdout.contains(what), "no {what:?} in\n{}", said.stdout);
    }
    assert!(fs::read_to_string(at.join("study/plots/cost.svg")).unwrap().starts_with("<svg"));
    let table = fs::read_to_string(at.join("study/table.csv")).unwrap();
    assert!(table.lines().count() > 40 && table.contains("L2+T1") && table.contains("full"), "{table}");

    // the same command computes nothing again, but for what was lost
    let again = done(at, &["cost", "cantilever", "--of", "beam.end@1", "--out", out]);
    let runs = |said: &Said| said.stdout.lines().find(|l| l.starts_with("  runs")).unwrap().to_string();
    let count = runs(&again).split_whitespace().nth(1).unwrap().trim_matches(',').to_string();
    assert!(runs(&again).contains(&format!("{count}, {count} of them from before")), "{}", runs(&again));
    // one that isn't timed: what follows from times may differ
    let files = fs::read_dir(at.join("study/runs")).unwrap().map(|e| e.unwrap().path());
    let lost = files
        .into_iter()
        .find(|f| f.file_name().unwrap().to_str().unwrap().starts_with("reference"))
        .unwrap();
    fs::write(lost, "{ \"settings\":").unwrap();
    let again = done(at, &["cost", "cantilever", "--of", "beam.end@1", "--out", out]);
    let fewer = count.parse::<usize>().unwrap() - 1;
    assert!(runs(&again).contains(&format!("{count}, {fewer} of them from before")), "{}", runs(&again));
    // another study doesn't go there
    run(at, &["cost", "cantilever", "--of", "root.reaction", "--out", out])
        .refused(&["holds another cost, of the record"]);
}

#[test]
fn scenes_without_mesh_vary_their_steps_only() {
    let there = folder();
    let said = done(there.path(), &["cost", "double.toml", "--of", "lower@1s", "--out", "study"]);
    assert!(!said.stdout.contains("elements") && said.stdout.contains("they agree"), "{}", said.stdout);
    // a scheme that the study doesn't use
    let mut scene = ropewalk::read(there.path().join("double.toml")).unwrap();
    scene.run.duration = 1.0;
    scene.solver.scheme = Scheme::Hht { alpha: -0.05 };
    scene.solver.stepping = Stepping::Fixed { h: 2e-5 };
    let columns = ["lower.x", "lower.y", "lower.z"];
    let exact = last(&scene, &columns);
    for goal in GOALS {
        let mut scene = advised(&there.path().join("study"), goal).unwrap();
        (scene.run.duration, scene.solver.horizon) = (1.0, 20.0);
        // its size is about 2 m
        let error = apart(&last(&scene, &columns), &exact) / 2.0;
        println!("{goal}: {error:.2e}");
        assert!(error <= 2.0 * goal.parse::<f64>().unwrap(), "{goal}: {error:e}");
    }
}

#[test]
fn fields_without_parameters_are_varied_where_they_stand() {
    let there = folder();
    let said = done(
        there.path(),
        &["cost", "plain.toml", "--of", "rope.end.z@0.3", "--out", "study", "--budget", "6s"],
    );
    assert!(
        said.stdout.contains("elements[0].elements = ") && said.stdout.contains("step [s]"),
        "{}",
        said.stdout
    );
    let scene = advised(&there.path().join("study"), "1e-2").expect("advice");
    assert!(matches!(scene.solver.stepping, Stepping::Fixed { h } if h > 1e-3));
}

#[test]
fn an_accuracy_is_reached_and_certified() {
    let there = folder();
    let (at, columns) = (there.path(), ["cable.end.x", "cable.end.y", "cable.end.z"]);
    let set = ["--set", "duration=0.4 s"];
    let said = done(
        at,
        &[&["run", "pendulum", "--accuracy", "1e-3", "--of", "cable.end@0.4s", "--out", "a"][..], &set]
            .concat(),
    );
    assert!(said.stdout.contains("chosen: ") && said.stdout.contains("certified"), "{}", said.stdout);
    let certificate = &json(&at.join("a/summary.json"))["certificate"];
    let change = &certificate["records"][0];
    let sum = change["step"].as_f64().unwrap() + change["mesh"].as_f64().unwrap();
    assert!(sum > 0.0 && sum <= 1e-3 && certificate["sensitive"] == false, "{certificate}");
    // integration of the same model by DOP853, 64 elements
    let exact = [0.753529, 0.0, -0.828886];
    let error = apart(&last(&ropewalk::read(at.join("a/scene.toml")).unwrap(), &columns), &exact) / 1.2;
    println!("{error:.2e}, certified {sum:.2e}");
    assert!(error <= 2e-3);
}

#[test]
fn chaos_is_called_sensitive_and_a_swing_is_not() {
    let there = folder();
    let at = there.path();
    for (scene, duration, sensitive) in
        [("pendulum", "duration=0.4 s", false), ("double.toml", "duration=20 s", true)]
    {
        let said = done(at, &["run", scene, "--certify", "--set", duration]);
        assert_eq!(said.stdout.contains("\n  sensitive "), sensitive, "{}", said.stdout);
    }
    let summary = json(&at.join("runs/double/summary.json"));
    assert_eq!(
        (&summary["certificate"]["sensitive"], &summary["status"]),
        (&Value::Bool(true), &"finished".into())
    );
    let said = run(at, &["run", "double.toml", "--accuracy", "1e-3", "--of", "lower", "--budget", "3s"]);
    assert_eq!(said.code, Some(3), "{}", said.stderr);
    assert!(
        said.stderr.contains("was not reached") || said.stderr.contains("in the time given"),
        "{}",
        said.stderr
    );
}

/// Runs that are far off, each for another reason.
#[test]
fn certificates_name_the_cause() {
    let there = folder();
    let at = there.path();
    let cable = |elements: u32, solver: &str| {
        format!(
            "[run]\nduration = '0.5 s'\noutput = '0.01 s'\n[solver]\n{solver}\n[[elements]]\ntype = 'cable'\nname = 'c'\n\
             points = [[0, 0, 0], [1, 0, 0]]\nelements = {elements}\n\
             section = {{ mass = 1, ea = 1e4, ei = 0.1, axial_retardation_time = 0.01, bending_retardation_time = 0.01 }}\n\
             [[constraints]]\ntype = 'spherical'\nname = 'h'\nmarker = 'c.start'\n[[forces]]\ntype = 'gravity'\n\
             [[records]]\ntype = 'position'\nof = 'c.end'\n"
        )
    };
    let fixed = |h: f64| format!("stepping = {{ fixed = {{ h = {h} }} }}");
    for (name, text, cause) in [
        ("steps", cable(8, &fixed(5e-2)), "steps"),
        ("mesh", cable(1, &fixed(1e-4)), "mesh"),
        // half of its weight may be left; energy would say so
        (
            "newton",
            cable(8, &format!("stopping = {{ absolute = {{ residual = 5.0 }} }}\n{}", fixed(1e-2)))
                .replace("[solver]", "audit = false\n[solver]"),
            "newton",
        ),
        ("motion", DOUBLE.to_string(), "motion"),
    ] {
        fs::write(at.join(format!("{name}.toml")), text).unwrap();
        let said = done(at, &["run", &format!("{name}.toml"), "--certify", "--out", name]);
        let certificate = &json(&at.join(name).join("summary.json"))["certificate"];
        assert_eq!(certificate["cause"], cause, "{}{certificate}", said.stdout);
        assert!(said.stdout.contains("\n  cause "), "{}", said.stdout);
    }
}

#[test]
fn what_is_wrong_is_said_in_one_message() {
    let there = folder();
    let at = there.path();
    for (arguments, holds) in [
        (
            &["cost", "cantilever", "--of", "beam.ent"][..],
            &["no record `beam.ent`", "did you mean `beam.end`?"][..],
        ),
        (&["cost", "cantilever", "--of", ""], &["there is no record"]),
        (&["cost", "cantilever", "--of", "t"], &["there is no record `t`"]),
        (&["cost", "cantilever", "--of", "beam.end@2"], &["outside the run, which ends at 1", "help"]),
        (&["cost", "pendulum", "--of", "cable.end@2s"], &["outside the run, which ends at 1.2 s"]),
        (&["cost", "pendulum", "--of", "cable.end@-1"], &["outside the run"]),
        (&["cost", "pendulum", "--of", "cable.end@NaN"], &["outside the run"]),
        (&["cost", "pendulum", "--of", "cable.end@soon"], &["`soon` is no time", "record@2.5 s"]),
        (
            &["cost", "plain.toml", "--of", "rope.start"],
            &["zero or no number all the time", "choose another record"],
        ),
        (&["cost", "unwinding-paper", "--of", "cable.tension"], &["nothing to vary", "ropewalk sweep"]),
        (&["cost", "pendulm", "--of", "x"], &["did you mean `pendulum`?"]),
        (
            &["cost", "pendulum", "--of", "cable.end", "--set", "elephants=3"],
            &["unknown parameter `elephants`"],
        ),
        (&["run", "pendulum", "--accuracy", "0", "--of", "cable.end"], &["above 0 and below 1, not 0"]),
        (&["run", "pendulum", "--accuracy", "-1", "--of", "cable.end"], &["above 0 and below 1, not -1"]),
        (&["run", "pendulum", "--accuracy", "NaN", "--of", "cable.end"], &["above 0 and below 1, not NaN"]),
        (&["run", "pendulum", "--accuracy", "1e-3"], &["--of"]),
        (&["run", "pendulum", "--of", "cable.end"], &["`--of` belongs to"]),
        (&["run", "pendulum", "--certify", "--of", "cable.tail"], &["no record `cable.tail`"]),
        (&["cost", "pendulum", "--of", "cable.end", "--budget", "0s"], &["expected a time such as"]),
        (&["cost", "pendulum"], &["--of"]),
    ] {
        run(at, arguments).refused(holds);
    }
    assert!(!at.join("runs").exists(), "nothing was begun");
}

#[cfg(unix)]
#[test]
fn ctrl_c_keeps_what_was_computed() {
    let there = folder();
    let at = there.path();
    let arguments = ["cost", "pendulum", "--of", "cable.end", "--out", "study", "--quiet"];
    let mut child = program(at, &arguments).spawn().unwrap();
    let start = Instant::now();
    let count = || fs::read_dir(at.join("study/runs")).map_or(0, Iterator::count);
    while count() < 3 && start.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(20));
    }
    let kill = format!("kill -INT {}", child.id());
    assert!(Command::new("sh").args(["-c", &kill]).status().unwrap().success());
    assert_eq!(child.wait().unwrap().code(), Some(130));
    let kept = count();
    assert!(kept >= 3);
    // and is not computed again
    let names = |at: &Path| {
        let files = fs::read_dir(at.join("study/runs")).unwrap().map(|e| e.unwrap());
        files.map(|e| (e.file_name(), e.metadata().unwrap().modified().unwrap())).collect::<Vec<_>>()
    };
    let before = names(at);
    run(at, &[&arguments[..], &["--budget", "1s"]].concat());
    let after = names(at);
    assert!(before.iter().all(|b| after.contains(b)) && after.len() >= before.len());
}

/// Errors of the advised settings against another integrator on twice the mesh.
fn holds(
    scene: &str,
    of: &str,
    set: &[&str],
    columns: &[&str],
    goals: &[&str],
    mesh: [&str; 2],
    tolerance: f64,
    size: f64,
) {
    let there = folder();
    let at = there.path();
    let arguments = [&["cost", scene, "--of", of, "--out", "study", "--budget", "8 min"][..], set].concat();
    println!("{}", done(at, &arguments).stdout);
    let text = fs::read_to_string(at.join("study/advice/1e-2.toml")).unwrap();
    let line = text.lines().find(|l| l.starts_with(mesh[0])).map(str::to_string);
    let fine = line.map_or(text.clone(), |line| text.replacen(&line, &format!("{}{}", mesh[0], mesh[1]), 1));
    let base = ["longitudinal = ", "transverse = ", "integration = "].iter().fold(fine, |text, key| {
        let kept = text.lines().filter(|l| !l.starts_with(key)).collect::<Vec<_>>();
        kept.join("\n")
    });
    fs::write(at.join("fine.toml"), base).unwrap();
    let at_end = |scene: &mut Scene| {
        if let Some((_, t)) = of.split_once('@') {
            scene.solver.horizon = scene.run.duration;
            scene.run.duration = t.trim_end_matches('s').parse().unwrap();
            scene.run.tables.clear();
        }
    };
    let mut reference = ropewalk::read(at.join("fine.toml")).unwrap();
    at_end(&mut reference);
    reference.solver.scheme = Scheme::Hht { alpha: -0.1 };
    reference.solver.stepping = Stepping::Controlled { tolerance };
    let exact = simulate(&reference).unwrap();
    for goal in goals {
        let mut scene = advised(&at.join("study"), goal).unwrap_or_else(|| panic!("nothing for {goal}"));
        at_end(&mut scene);
        let found = simulate(&scene).unwrap();
        let rows = found.times().len().min(exact.times().len());
        let distance = |k: usize| {
            let of =
                |h: &ropewalk::History| columns.iter().map(|c| h.column(c).unwrap()[k]).collect::<Vec<_>>();
            apart(&of(&found), &of(&exact))
        };
        let from = if of.contains('@') { rows - 1 } else { 0 };
        let error =
            (from..rows).map(distance).fold(0.0, |m: f64, d| if d.is_nan() { d } else { m.max(d) }) / size;
        println!("{goal}: {error:.2e}");
        assert!(error <= 2.0 * goal.parse::<f64>().unwrap(), "{goal}: {error:e}");
    }
}

#[test]
#[ignore = "two minutes"]
fn advice_for_the_pendulum_holds() {
    let columns = ["cable.end.x", "cable.end.y", "cable.end.z"];
    holds("pendulum", "cable.end", &[], &columns, &GOALS, ["elements = ", "256"], 1e-7, 1.2);
}

#[test]
#[ignore = "minutes"]
fn advice_for_the_turning_hose_holds() {
    holds("hose-turn", "height@60s", &[], &["height.z"], &GOALS, ["elements = ", "80"], 1e-6, 23.7);
}

#[test]
#[ignore = "minutes"]
fn advice_for_the_shear_pin_holds() {
    let columns = ["hose.centre.x", "hose.centre.y", "hose.centre.z"];
    let set = ["--set", "links=60"];
    holds("shear-pin", "hose.centre", &set, &columns, &GOALS[..2], ["links = ", "60"], 1e-6, 15.0);
}
