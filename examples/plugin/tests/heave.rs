//! A crate of one's own adds an element, a force and a scene, without touching Ropewalk's sources.

use serde_json::Value;
use std::process::Command;

/// Runs a command and gives what it says, if it ends well.
fn said(command: &mut Command) -> String {
    let out = command.output().unwrap_or_else(|e| panic!("{command:?}: {e}"));
    let error = String::from_utf8_lossy(&out.stderr);
    assert!(out.status.success(), "{command:?}: {:?}\n{error}", out.status.code());
    String::from_utf8(out.stdout).unwrap()
}

/// Height of the float over time in closed form: a damped oscillator about its rest.
fn height(t: f64) -> f64 {
    let (mass, c, start) = (100.0, 40.0, -0.3);
    let k = 1025.0 * 9.81 * std::f64::consts::PI * 0.5_f64.powi(2) / 4.0;
    let rest = -mass * 9.81 / k;
    let decay: f64 = c / (2.0 * mass);
    let omega = (k / mass - decay * decay).sqrt();
    let (sin, cos) = (omega * t).sin_cos();
    rest + (start - rest) * (-decay * t).exp() * (cos + decay / omega * sin)
}

#[test]
fn plugin_adds_types_and_a_scene() {
    let run = |arguments: &[&str]| said(Command::new(env!("CARGO_BIN_EXE_harbour")).args(arguments));

    let list = run(&["list"]);
    for line in ["  heave ", "  hose-turn ", "  float ", "  cable ", "  waterplane ", "  gravity "] {
        assert!(list.lines().any(|l| l.starts_with(line)), "no {line} in\n{list}");
    }
    assert!(list.contains("A float that heaves"), "{list}");
    let float = run(&["describe", "float"]);
    assert!(float.contains("[[elements]]") && float.contains("resistance: number in N s/m"), "{float}");
    let force = run(&["describe", "waterplane"]);
    assert!(force.contains("[[forces]]") && force.contains("Diameter of the cylinder [m]."), "{force}");
    assert!(run(&["describe", "heave"]).contains("mass = 100 kg"));
    let check = run(&["check", "heave"]);
    assert!(check.contains("float (float)") && check.contains("`float`: lift"), "{check}");

    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("heave");
    run(&["run", "heave", "--quiet", "--out", out.to_str().unwrap()]);
    let history = std::fs::read_to_string(out.join("history.csv")).unwrap();
    let mut rows = history.lines();
    assert!(rows.next().unwrap().starts_with("t [s],float.x [m],float.y [m],float.z [m],float.vx [m/s]"));
    let mut worst = 0.0_f64;
    for row in rows {
        let x: Vec<f64> = row.split(',').map(|x| x.parse().unwrap()).collect();
        assert_eq!(x[1..3], [0.0; 2]);
        worst = worst.max((x[3] - height(x[0])).abs());
    }
    assert!(worst < 2e-5, "{worst}");
    let summary: Value = serde_json::from_slice(&std::fs::read(out.join("summary.json")).unwrap()).unwrap();
    assert_eq!(summary["status"], "finished");
    let lost =
        summary["energy"]["imbalance"].as_f64().unwrap() / summary["energy"]["dissipated"].as_f64().unwrap();
    assert!(lost.abs() < 1e-4, "{lost}");
}
