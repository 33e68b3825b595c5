//! Checkpoints: what goes on from one is to the last bit what never stopped, and a killed run loses nothing else.

use crate::program::{program, run};
use ropewalk::SceneFile;
use ropewalk::scene::Format;
use ropewalk_core::integrator::{Options, Scheme, Stepping};
use ropewalk_core::{Checkpoint, End, Model, Observer, Sample, Simulation, State, Unfit};
use ropewalk_scene::Scene;
use std::fs;
use std::ops::ControlFlow;
use std::path::Path;
use std::process::Stdio;
use std::time::{Duration, Instant};

/// Asks for a checkpoint every few steps, keeps one of them, and notes every sample.
#[derive(Default)]
struct Keeper {
    every: u64,
    steps: u64,
    keep: u64,
    kept: Option<Vec<u8>>,
    samples: Vec<u64>,
}

impl Observer for Keeper {
    fn step(&mut self, _: &Model, _: &State, _: &ropewalk_core::integrator::StepReport) -> ControlFlow<()> {
        self.steps += 1;
        ControlFlow::Continue(())
    }
    fn needs_forces(&self) -> bool {
        true
    }
    fn sample(&mut self, s: &Sample<'_>) -> ControlFlow<()> {
        let all = [
            &[s.at.t, s.audit.dissipated, s.audit.supplied][..],
            s.at.q,
            s.at.v,
            s.at.a,
            s.lambda,
            s.at.internal,
        ];
        self.samples.extend(all.iter().flat_map(|x| x.iter()).map(|x| x.to_bits()));
        ControlFlow::Continue(())
    }
    fn wants_checkpoint(&mut self) -> bool {
        self.steps.is_multiple_of(self.every)
    }
    fn checkpoint(&mut self, c: Checkpoint) -> ControlFlow<()> {
        self.keep = self.keep.saturating_sub(1);
        if self.keep == 0 && self.kept.is_none() {
            self.kept = Some(postcard::to_stdvec(&c).expect("plain data"));
            self.samples.clear();
        }
        ControlFlow::Continue(())
    }
}

/// Runs a scene with checkpoints, once in one go and once from the checkpoint number `keep`; says how many steps it took.
#[track_caller]
fn same_from_checkpoint(scene: &Scene, options: &Options, every: u64, keep: u64) -> u64 {
    let (duration, interval) = (scene.run.duration, scene.run.duration / 50.0);
    let mut whole = Simulation::new(scene.build().expect("model"), options, duration).expect("start");
    let mut keeper = Keeper { every, keep, ..Keeper::default() };
    assert_eq!(whole.advance(duration, interval, &mut keeper), Ok(End::Done));
    let bytes = keeper.kept.take().expect("a checkpoint on the way");
    let checkpoint: Checkpoint = postcard::from_bytes(&bytes).expect("read back");
    let steps = checkpoint.counts.steps;
    let mut rest =
        Simulation::restore(scene.build().expect("model"), options, duration, checkpoint).expect("restored");
    let mut again = Keeper { every, steps, keep: u64::MAX, ..Keeper::default() };
    assert_eq!(rest.go_on(duration, interval, &mut again), Ok(End::Done));
    assert!(!again.samples.is_empty(), "nothing was left to compute");
    assert_eq!(again.samples, keeper.samples, "samples after the checkpoint differ");
    assert_eq!(rest.state, whole.state);
    assert_eq!((rest.audit, rest.work.counts), (whole.audit, whole.work.counts));
    whole.work.counts.steps
}

fn bundled(name: &str, duration: f64) -> Scene {
    let mut scene = ropewalk::read(name).expect(name);
    scene.run.duration = duration;
    scene
}

#[test]
fn pendulum_goes_on_to_the_last_bit_with_every_scheme() {
    let scene = bundled("pendulum", 0.2);
    let controlled = Stepping::Controlled { tolerance: 1e-4 };
    for (scheme, stepping) in [
        (Scheme::default(), controlled),
        (Scheme::default(), Stepping::Fixed { h: 1e-3 }),
        (Scheme::Hht { alpha: -0.1 }, controlled),
        (Scheme::RadauIia5, controlled),
        (Scheme::RadauIia5, Stepping::Fixed { h: 5e-3 }),
    ] {
        let options = Options { scheme, stepping, ..Options::default() };
        let steps = same_from_checkpoint(&scene, &options, 5, 2);
        println!("{scheme:?} {stepping:?}: {steps} steps");
    }
}

#[test]
fn hose_behind_a_turning_ship_goes_on_to_the_last_bit() {
    let scene = bundled("hose-turn", 70.0);
    let options = scene.solver.clone();
    println!("{} steps", same_from_checkpoint(&scene, &options, 10, 3));
}

#[test]
fn vehicle_whose_pin_shears_goes_on_to_the_last_bit() {
    let scene = bundled("shear-pin", 0.3);
    let options = scene.solver.clone();
    println!("{} steps", same_from_checkpoint(&scene, &options, 20, 2));
}

/// What a motion leads brings in energy by velocities that are on the constraints: the balance goes on with that.
#[test]
fn linkage_that_a_motion_drives_goes_on_to_the_last_bit() {
    let scene = bundled("four-bar", 0.5);
    same_from_checkpoint(&scene, &scene.solver, 10, 2);
}

#[test]
fn ropes_over_wheels_go_on_to_the_last_bit() {
    let scene = bundled("four-falls", 1.5);
    same_from_checkpoint(&scene, &scene.solver, 20, 4);
}

/// The rope lifts off from its wheel and comes back.
#[test]
fn rope_that_lifts_off_from_its_wheel_goes_on_to_the_last_bit() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/lifting.toml");
    let mut scene = ropewalk::read(&path).expect("the scene");
    scene.run.duration = 0.4;
    let controlled = Stepping::Controlled { tolerance: 1e-4 };
    for (scheme, stepping, every) in [
        (Scheme::default(), controlled, 60),
        (Scheme::default(), Stepping::Fixed { h: 1e-3 }, 70),
        (Scheme::RadauIia5, controlled, 8),
    ] {
        let options = Options { scheme, stepping, ..Options::default() };
        same_from_checkpoint(&scene, &options, every, 3);
    }
}

#[test]
fn drum_that_its_motor_turns_goes_on_to_the_last_bit() {
    let text = r#"
        run = { duration = 1, output = 0.1 }
        [[elements]]
        type = "cable"
        name = "rope"
        section = { mass = 0.2, ea = "1 MN", axial_retardation_time = "5 ms" }
        tension = 49
        route = [{ wound = "drum" }, { end = [0.9, 0, -2] }]
        [[elements]]
        type = "point_mass"
        name = "load"
        marker = "rope.end"
        mass = 5
        [[constraints]]
        type = "drum"
        name = "drum"
        marker = [0, 0, 0]
        axis = [0, 1, 0]
        radius = 0.3
        torque = -20
        inertia = 0.5
        brake = 2
        wound = 30
        pitch = 0.02
        width = 0.2
        [[forces]]
        type = "gravity"
    "#;
    let file = SceneFile::parse(text, "drum", Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}"));
    let scene = file.into_scene();
    same_from_checkpoint(&scene, &scene.solver, 20, 4);
}

/// Picks up from a slack sling, hoists, brakes, slews, brakes, lowers, sets down, slack again.
#[test]
fn a_crane_operators_day_goes_on_to_the_last_bit() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/crane_day.toml");
    let scene = ropewalk::read(&path).expect("the scene");
    let history = ropewalk::simulate(&scene).unwrap_or_else(|e| panic!("{e}"));
    let at = |column: &str, t: f64| {
        let k =
            history.times().iter().position(|x| (x - t).abs() < 1e-6).unwrap_or_else(|| panic!("no {t} s"));
        history.column(column).unwrap_or_else(|| panic!("no {column}"))[k]
    };
    let weight = 2000.0 * 9.81;
    // on the ground and slack, in the air, on the ground and slack, and elsewhere
    for (t, lifted) in [(0.5, false), (6.5, true), (10.5, true), (20.0, false)] {
        let (normal, sling) = (at("ground.normal", t), at("sling.tension", t));
        if lifted {
            assert!(normal == 0.0 && sling > 0.5 * weight, "at {t} s: {normal} N, {sling} N");
        } else {
            assert!((normal / weight - 1.0).abs() < 0.01 && sling == 0.0, "at {t} s: {normal} N, {sling} N");
        }
    }
    let way = (at("load.x", 20.0) - 10.0).hypot(at("load.y", 20.0));
    assert!(way > 2.0, "{way} m");
    let [supplied, imbalance] = ["supplied", "imbalance"].map(|what| at(&format!("energy.{what}"), 20.0));
    assert!(imbalance.abs() < 0.01 * supplied, "{imbalance} J of {supplied} J");
    same_from_checkpoint(&scene, &scene.solver, 500, 4);
}

/// Three lifts: the block up from the ground with its rope slack, a load from a slack sling, hoisted, slewed, braked hard, set
/// down, and the block set down until its rope is slack.
#[test]
#[ignore = "600 s of a crane take minutes"]
fn a_long_day_of_a_crane_operator_goes_on_to_the_last_bit() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/crane_day_long.toml");
    let scene = ropewalk::read(&path).expect("the scene");
    let history = ropewalk::simulate(&scene).unwrap_or_else(|e| panic!("{e}"));
    let column = |name: &str| history.column(name).unwrap_or_else(|| panic!("no {name}"));
    let at = |name: &str, t: f64| {
        let k =
            history.times().iter().position(|x| (x - t).abs() < 1e-6).unwrap_or_else(|| panic!("no {t} s"));
        column(name)[k]
    };
    let weight = 2000.0 * 9.81;
    for lift in [0.0, 200.0, 400.0] {
        // hanging from the sling, and on the ground beside the block
        assert!(at("ground.normal", lift + 26.0) == 0.0 && at("sling.tension", lift + 26.0) > 0.5 * weight);
        assert!((at("ground.normal", lift + 5.0) / weight - 1.0).abs() < 0.05 || lift == 0.0);
    }
    // the block stands on its feet, and its rope is slack
    let stands = column("feet.normal").iter().filter(|f| **f > 1000.0).count();
    assert!(stands > 30, "{stands}");
    let [supplied, imbalance] = ["supplied", "imbalance"]
        .map(|what| column(&format!("energy.{what}")).iter().fold(0.0_f64, |most, x| most.max(x.abs())));
    println!("{imbalance} J of {supplied} J, {:?}", history.counts);
    assert!(imbalance < 0.01 * supplied, "{imbalance} J of {supplied} J");
    same_from_checkpoint(&scene, &scene.solver, 5000, 10);
}

#[test]
fn checkpoint_of_another_model_is_refused() {
    let (one, other) = (bundled("pendulum", 0.2), bundled("hose-turn", 0.2));
    let mut s = Simulation::new(one.build().expect("model"), &one.solver, 0.2).expect("start");
    s.advance(0.1, 0.05, &mut ()).expect("run");
    let checkpoint = s.checkpoint().expect("checkpoint");
    let e = Simulation::restore(other.build().expect("model"), &other.solver, 0.2, checkpoint)
        .err()
        .expect("refused");
    assert!(matches!(&e, Unfit::Other(_)), "{e}");
}

/// A cable that swings and is let go of while it does: long enough to be killed on its way.
const SWING: &str = r#"
[run]
duration = "1 s"
output = "0.01 s"
[solver]
stepping = { type = "fixed", h = "0.4 ms" }
[[run.tables]]
name = "ends"
columns = ["rope.end.x", "rope.end.z"]
[[elements]]
type = "cable"
name = "rope"
points = [[0, 0, 0], ["1 m", 0, 0]]
elements = 24
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
type = "reaction"
of = "hook"
[[records]]
type = "energy"
"#;

#[test]
fn killed_run_is_resumed_and_leaves_the_results_of_one_that_was_not() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    fs::write(here.join("swing.toml"), SWING).unwrap();
    let start =
        ["run", "swing.toml", "--checkpoint", "50 steps", "--no-report", "--vtk", "--profile", "--out"];
    let whole = run(here, &[&start[..], &["whole"]].concat());
    assert_eq!(whole.code, Some(0), "{whole:?}");

    // killed at several moments, the last of them while it is resumed
    let mut seen = None;
    for (k, words) in [&[&start[..], &["killed"]].concat()[..], &["resume", "killed"], &["resume", "killed"]]
        .iter()
        .enumerate()
    {
        let mut child = program(here, words).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
        let begin = Instant::now();
        let stamp = || fs::read(here.join("killed/checkpoint")).ok();
        while stamp().is_none() || stamp() == seen {
            assert!(begin.elapsed() < Duration::from_secs(60), "no checkpoint");
            assert!(child.try_wait().unwrap().is_none(), "it ended before it could be killed, at {k}");
            std::thread::sleep(Duration::from_millis(5));
        }
        child.kill().unwrap();
        child.wait().unwrap();
        seen = stamp();
        assert!(!here.join("killed/summary.json").exists());
        let history = fs::read_to_string(here.join("killed/history.csv")).unwrap();
        assert!(history.starts_with("t [s],"), "{history}");
    }
    let done = run(here, &["resume", "killed"]);
    assert_eq!(done.code, Some(0), "{done:?}");
    for file in [
        "history.csv",
        "tables/ends.csv",
        "scene.toml",
        "manifest.json",
        "plots/rope.end.svg",
        "plots/shape_side.svg",
    ] {
        let bytes =
            |run: &str| fs::read(here.join(run).join(file)).unwrap_or_else(|e| panic!("{run}/{file}: {e}"));
        assert!(bytes("whole") == bytes("killed"), "{file} differs");
    }
    let summary = |run: &str| -> serde_json::Value {
        serde_json::from_str(&fs::read_to_string(here.join(run).join("summary.json")).unwrap()).unwrap()
    };
    for key in ["status", "rows", "final", "counts", "energy"] {
        assert_eq!(summary("whole")[key], summary("killed")[key], "{key}");
    }
    // what was asked for when it began still is
    assert!(here.join("killed/vtk.pvd").exists() && !here.join("killed/report.html").exists());
    assert!(summary("killed")["profile"].as_array().is_some_and(|p| !p.is_empty()), "{}", summary("killed"));
    assert!(!here.join("killed/checkpoint").exists() && !here.join("killed/.checkpoint.tmp").exists());
}

/// The same cable, drawn through a ring: elements are swallowed and born all the time.
fn drawn() -> String {
    let ring = "[[constraints]]\ntype = \"eyelet\"\nname = \"hook\"\nmarker = \"rope.start\"\nspeed = 1\nramp = 0.02\nelement_length = \"40 mm\"\n";
    let hook = "[[constraints]]\ntype = \"spherical\"\nname = \"hook\"\nmarker = \"rope.start\"\n";
    assert!(SWING.contains(hook));
    SWING.replace(hook, ring)
}

#[test]
fn a_resumed_run_tells_of_all_changes_of_the_mesh() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    fs::write(here.join("drawn.toml"), drawn()).unwrap();
    let start = ["run", "drawn.toml", "--checkpoint", "300 steps", "--out"];
    let whole = run(here, &[&start[..], &["whole"]].concat());
    assert_eq!(whole.code, Some(0), "{whole:?}");
    let mut child = program(here, &[&start[..], &["killed"]].concat())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    while !here.join("killed/checkpoint").exists() {
        assert!(child.try_wait().unwrap().is_none(), "it ended before it could be killed");
        std::thread::sleep(Duration::from_millis(5));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    let done = run(here, &["resume", "killed"]);
    assert_eq!(done.code, Some(0), "{done:?}");
    for file in ["history.csv", "shapes.csv", "tables/remeshing.csv"] {
        let text = |run: &str| fs::read_to_string(here.join(run).join(file)).unwrap();
        assert_eq!(text("whole"), text("killed"), "{file}");
    }
    let field = |run: &str| fs::read(here.join(run).join("field.npy")).unwrap();
    assert!(field("whole") == field("killed"), "the field record goes on as well");
    let changes: Vec<f64> = fs::read_to_string(here.join("killed/tables/remeshing.csv"))
        .unwrap()
        .lines()
        .skip(1)
        .map(|line| line.split(',').next().unwrap().parse().unwrap())
        .collect();
    // on both sides of the checkpoint, which is at 0.12 s or a little later
    assert!(
        changes[0] < 0.12 && changes.len() > 10 && changes.windows(2).all(|w| w[0] < w[1]),
        "{changes:?}"
    );
}

fn kept(folder: &Path) -> Vec<u8> {
    fs::write(folder.join("swing.toml"), SWING).unwrap();
    let words = ["run", "swing.toml", "--checkpoint", "20 steps", "--out", "run"];
    let mut child = program(folder, &words).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    while !folder.join("run/checkpoint").exists() {
        assert!(child.try_wait().unwrap().is_none(), "it ended before it could be killed");
        std::thread::sleep(Duration::from_millis(5));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    fs::read(folder.join("run/checkpoint")).unwrap()
}

/// SIGTERM leaves a checkpoint of that very moment, though the first was to come in an hour.
#[cfg(unix)]
#[test]
fn an_interrupted_run_goes_on_from_where_it_was() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    fs::write(here.join("swing.toml"), SWING).unwrap();
    let words = ["run", "swing.toml", "--checkpoint", "1 h", "--out", "run"];
    let mut child = program(here, &words).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    let rows = || fs::read_to_string(here.join("run/history.csv")).map_or(0, |text| text.lines().count());
    while rows() < 5 {
        assert!(child.try_wait().unwrap().is_none(), "it ended before it could be interrupted");
        std::thread::sleep(Duration::from_millis(5));
    }
    let kill = format!("kill -TERM {}", child.id());
    assert!(std::process::Command::new("sh").args(["-c", &kill]).status().unwrap().success());
    assert_eq!(child.wait().unwrap().code(), Some(143));
    let summary = || -> serde_json::Value {
        serde_json::from_str(&fs::read_to_string(here.join("run/summary.json")).unwrap()).unwrap()
    };
    let (before, kept) = (summary(), fs::read_to_string(here.join("run/history.csv")).unwrap());
    assert_eq!(before["status"], "interrupted");
    let done = run(here, &["resume", "run"]);
    assert_eq!(done.code, Some(0), "{done:?}");
    let whole = fs::read_to_string(here.join("run/history.csv")).unwrap();
    assert!(whole.starts_with(&kept) && whole.lines().count() == 102, "{}", whole.lines().count());
    assert_eq!(summary()["status"], "finished");
    assert!(summary()["counts"]["steps"].as_u64() > before["counts"]["steps"].as_u64());
}

#[test]
fn what_cannot_be_resumed_is_refused_with_the_reason() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let good = kept(here);
    let file = here.join("run/checkpoint");
    let resume = || run(here, &["resume", "run"]);

    let mut bad = good.clone();
    let middle = bad.len() / 2;
    bad[middle] ^= 1;
    fs::write(&file, &bad).unwrap();
    resume().refused(&["it is damaged"]);
    fs::write(&file, &good[..good.len() - 9]).unwrap();
    resume().refused(&["it is damaged"]);
    fs::write(&file, b"hello").unwrap();
    resume().refused(&["not a checkpoint"]);
    fs::write(&file, b"ropewalk checkpoint 99.0.0\nabc").unwrap();
    resume().refused(&["version 99.0.0"]);
    fs::write(&file, &good).unwrap();
    let scene = fs::read_to_string(here.join("run/scene.toml")).unwrap();
    fs::write(here.join("run/scene.toml"), format!("{scene}\n# other\n")).unwrap();
    resume().refused(&["was changed after the checkpoint", "ropewalk run"]);
    fs::remove_file(&file).unwrap();
    resume().refused(&[
        "there is no checkpoint in run: that run is still at work, or was killed",
        "--checkpoint",
    ]);
    run(here, &["resume", "nowhere"]).refused(&["there is no checkpoint in nowhere: it doesn't exist"]);
    run(here, &["resume", "."]).refused(&["there is no checkpoint in .: it holds no run"]);
    for (status, said) in
        [("interrupted", "was interrupted before it wrote one"), ("failed", "failed before it wrote one")]
    {
        fs::write(here.join("run/summary.json"), format!("{{ \"status\": \"{status}\" }}")).unwrap();
        resume().refused(&[said, "ropewalk run"]);
    }
    fs::write(here.join("run/summary.json"), "{ \"status\": \"finished\" }").unwrap();
    resume().refused(&["there is nothing to resume in run: that run came to its end"]);
    run(here, &["run", "swing.toml", "--checkpoint", "often"]).code.filter(|c| *c == 2).expect("usage");
}
