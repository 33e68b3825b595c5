//! What stops a run from outside, what is kept, and what is left alone.

use ropewalk::scene::Format;
use ropewalk::{
    Error, ModesOptions, RunOptions, SceneFile, Status, Watch, modes, read, simulate_with, start,
};
use std::sync::atomic::AtomicBool;

static SET: AtomicBool = AtomicBool::new(true);

#[test]
fn a_flag_stops_every_analysis() {
    for name in ["pendulum", "cantilever", "unwinding-paper"] {
        let history = simulate_with(&read(name).unwrap(), Watch::flag(&SET)).unwrap();
        assert_eq!((history.status(), history.error().is_none()), (Status::Interrupted, true), "{name}");
        assert_eq!(history.summary().status, Status::Interrupted);
        // one step at most
        assert!(history.times().len() < 4, "{name}: {} rows", history.times().len());
    }
}

#[test]
fn a_flag_stops_the_search_for_the_start_and_modes() {
    let mut scene = read("catenary").unwrap();
    scene.run.analysis = ropewalk::scene::Analysis::Dynamics;
    scene.run.from_equilibrium = true;
    assert!(start(&scene, Watch::default()).is_ok());
    for stopped in [start(&scene, Watch::flag(&SET)).err(), simulate_with(&scene, Watch::flag(&SET)).err()] {
        assert!(matches!(stopped, Some(Error::Interrupted)), "{stopped:?}");
    }
    let options = ModesOptions { watch: Watch::flag(&SET), ..ModesOptions::default() };
    assert!(modes(&scene, &options).is_err_and(|e| e.to_string().contains("stopped")));
}

/// Two rods in a row that are pulled longer than they are.
const PULLED_APART: &str = r#"
run = { duration = "5 s", output = "0.05 s" }
elements = [
  { type = "point_mass", name = "elbow", marker = [0.8, 0.6, 0], mass = 1 },
  { type = "point_mass", name = "hand", marker = [1.6, 0, 0], mass = 1 },
]
motions = [{ type = "straight", name = "away", speed = 1, ramp = "0.1 s" }]
constraints = [
  { type = "distance", name = "upper", marker = "elbow", to = [0, 0, 0] },
  { type = "distance", name = "lower", marker = "hand", to = "elbow" },
  { type = "driving", name = "pull", marker = "hand", motion = "away" },
]
records = [{ type = "position", of = "elbow" }]
"#;

#[test]
fn what_was_computed_is_kept_when_the_solver_gives_up() {
    let file = SceneFile::parse(PULLED_APART, "pulled apart", Format::Toml, &[]).unwrap();
    let history = simulate_with(file.scene(), Watch::default()).unwrap();
    assert_eq!(history.status(), Status::Failed);
    let (last, message) = (history.last("t").unwrap(), history.error().unwrap().to_string());
    // the rods are straight after 0.45 s
    assert!(last > 0.3 && last < 0.5, "{last}");
    assert_eq!(history.summary().message.as_deref(), Some(message.as_str()));
    assert!(history.column("elbow.x").unwrap().iter().all(|x| x.is_finite()));
    assert_eq!(ropewalk::simulate(file.scene()).err().unwrap().to_string(), message);
}

#[test]
fn exit_codes_are_numbers() {
    for (arguments, code) in
        [(&["check", "pendulum"][..], 0), (&["check", "nothing"], 2), (&["--version"], 0)]
    {
        let all = ["ropewalk"].iter().chain(arguments);
        assert_eq!(ropewalk::cli::exit_from(ropewalk::bundled(), all), code, "{arguments:?}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_run_leaves_signals_alone() {
    let folder = tempfile::tempdir().unwrap();
    let file = SceneFile::open("pendulum", &["duration=0.01 s".into()], ropewalk::bundled()).unwrap();
    let options = RunOptions { out: Some(folder.path().join("run")), ..RunOptions::default() };
    assert_eq!(ropewalk::run(&file, &options, &mut |_| {}).unwrap().summary.status, Status::Finished);
    let status = std::fs::read_to_string("/proc/self/status").unwrap();
    let caught = status.lines().find_map(|l| l.strip_prefix("SigCgt:")).unwrap();
    let caught = u64::from_str_radix(caught.trim(), 16).unwrap();
    // Ctrl-C is the signal 2, SIGTERM 15, SIGHUP 1
    assert_eq!(caught & (1 << 1 | 1 << 14 | 1), 0);
}
