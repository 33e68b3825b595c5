//! A sea from a record of its elevation.

use super::{refused, run};
use std::fs;
use std::path::Path;

/// A ball on a line in these waves.
fn ball(waves: &str) -> String {
    format!(
        r#"
        [run]
        duration = 12
        output = 0.5
        [water]
        level = 0
        [water.waves]
        depth = 30
        ramp = 4
        {waves}
        [[elements]]
        type = "point_mass"
        name = "ball"
        marker = [3, 0, -4]
        mass = 512.5
        volume = 0.5
        drag_area = 0.8
        added_mass = 250
        [[forces]]
        type = "gravity"
        [[forces]]
        type = "buoyancy"
        [[records]]
        type = "position"
        of = "ball"
        "#
    )
}

fn recorded(file: &Path) -> String {
    format!("measured = {{ file = {:?} }}", file.display().to_string())
}

#[test]
fn a_ball_in_a_measured_sea_goes_as_in_the_waves_that_made_it() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("eta.csv");
    let waves = [(1.2, 8.0, 0.4), (0.5, 5.0, 2.0)];
    // whole periods of both
    let row = |k: u32| {
        let t = 0.25 * f64::from(k);
        let eta: f64 = waves
            .iter()
            .map(|(a, period, phase)| a * (phase - std::f64::consts::TAU * t / period).cos())
            .sum();
        format!("{t},{eta}\n")
    };
    fs::write(&file, format!("t [s],eta [m]\n{}", (0..320).map(row).collect::<String>())).unwrap();
    let by_hand = "components = [{ amplitude = 1.2, period = 8, phase = 0.4 }, { amplitude = 0.5, period = 5, phase = 2.0 }]";
    let (measured, right) = (run(&ball(&recorded(&file))), run(&ball(by_hand)));
    for column in ["ball.x", "ball.z"] {
        let [a, b] = [&measured, &right].map(|h| h.column(column).expect("column").to_vec());
        for (a, b) in a.iter().zip(&b) {
            assert!((a - b).abs() < 1e-6, "{column}: {a} instead of {b}");
        }
        assert!(b.iter().any(|x| (x - b[0]).abs() > 0.1));
    }
    // 80 s of it repeat in a longer run
    let repeats = |duration: u32| {
        let text = ball(&recorded(&file)).replace("duration = 12", &format!("duration = {duration}"));
        run(&text).warnings.iter().any(|w| w.contains("measured for 80 s"))
    };
    assert!(repeats(81) && !repeats(80));
}

#[test]
fn records_that_are_none_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("eta.csv");
    let said = |text: &str| {
        fs::write(&file, text).unwrap();
        refused(&ball(&recorded(&file)))
    };
    assert!(said("t,eta\n0,1\n1,0\n3,1\n4,0\n").contains("equal intervals"));
    assert!(said("t,eta\n0,1\n1,x\n").contains("line 3"));
    assert!(said("t,eta\n0,1\n").contains("fewer than two rows"));
    assert!(said("0,1\n1,1\n2,1\n3,1\n4,1\n").contains("no waves of 2 s"));
    assert!(refused(&ball("measured = { file = \"nowhere.csv\" }")).contains("nowhere.csv"));
    let both = format!("{}\nregular = {{ height = 1, period = 8 }}", recorded(&file));
    assert!(refused(&ball(&both)).contains("more than one sea state"));
}
