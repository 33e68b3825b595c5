//! The storm of `examples/sea`, cut short: killed and resumed, and what the examples beside it say.

use crate::program::{program, run};
use std::fs;
use std::process::Stdio;
use std::time::Duration;

const STORM: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/sea/three-hours.toml");

/// Runs a storm twice, once killed on its way and resumed, and compares all that is left behind.
fn killed_and_resumed(duration: &str, elements: usize, checkpoint: &str) {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let (duration, elements) = (format!("duration={duration}"), format!("elements={elements}"));
    let sets = ["--set", &duration, "--set", &elements, "--set", "ramp=10 s"];
    let start = [&["run", STORM], &sets[..], &["--checkpoint", checkpoint, "--out"]].concat();
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
    for file in [
        "history.csv",
        "shapes.csv",
        "tables/range-chain.csv",
        "tables/statistics.csv",
        "tables/cycles-fairlead.magnitude.csv",
        "tables/spectrum-anchor.magnitude.csv",
    ] {
        let bytes =
            |run: &str| fs::read(here.join(run).join(file)).unwrap_or_else(|e| panic!("{run}/{file}: {e}"));
        assert!(bytes("whole") == bytes("killed"), "{file} differs");
    }
}

#[test]
fn a_killed_storm_is_resumed_to_the_last_bit() {
    killed_and_resumed("20 s", 16, "60 steps");
}

#[test]
#[ignore = "a minute or two: ten minutes of the storm on the mesh of the example"]
fn ten_minutes_of_the_storm_are_resumed_to_the_last_bit() {
    killed_and_resumed("600 s", 100, "2000 steps");
}

#[test]
fn the_chain_in_the_tank_has_its_equilibrium_and_its_data() {
    let folder = tempfile::tempdir().unwrap();
    let chain = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/sea/chain.toml");
    let ran =
        run(folder.path(), &["run", chain, "--set", "turns=0.1", "--set", "elements=12", "--out", "out"]);
    assert_eq!(ran.code, Some(0), "{}", ran.stderr);
    let text = fs::read_to_string(folder.path().join("out/history.csv")).unwrap();
    let first: Vec<f64> = text.lines().nth(1).unwrap().split(',').map(|x| x.parse().unwrap()).collect();
    // a catenary: from the bed to its end tension grows by the weight of as much chain as it is high, 3 m in water, 0.3 m above
    let (wet, dry) = ((0.0818 - 1000.0 * 1.0487e-5) * 9.81, 0.0818 * 9.81);
    let (fairlead, anchor) = (first[1], first[2]);
    assert!((fairlead - anchor - 3.0 * wet - 0.3 * dry).abs() < 0.01 * fairlead, "{fairlead} N, {anchor} N");
    assert!(anchor > 1.0 && anchor < fairlead);
    let measured = include_str!("../../examples/sea/tank.csv");
    assert_eq!(measured.lines().count(), 6);
}
