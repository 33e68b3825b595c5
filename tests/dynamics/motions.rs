//! Motions in scenes: tables from files, angles in degrees, sums, and what is said of those that can't be.

use ropewalk::scene::Format;
use ropewalk::{SceneFile, simulate};
use std::fs;
use std::path::Path;

/// A ball that follows the motion `path`, or a crank that does.
const DRIVEN: &str = r#"
[run]
duration = "2 s"
output = "0.1 s"
[[elements]]
type = "point_mass"
name = "ball"
marker = [0, 0, 0]
mass = 1
[[constraints]]
type = "driving"
name = "hand"
marker = "ball"
motion = "path"
[[records]]
type = "position"
of = "ball"
[[records]]
type = "reaction"
of = "hand"
"#;

fn history(folder: &Path, motions: &str) -> Result<ropewalk::History, String> {
    let file = folder.join("scene.toml");
    fs::write(&file, format!("{DRIVEN}{motions}")).unwrap();
    let scene = ropewalk::read(&file).map_err(|e| e.to_string())?;
    simulate(&scene).map_err(|e| e.to_string())
}

fn at(history: &ropewalk::History, column: &str, row: usize) -> f64 {
    history.column(column).expect(column)[row]
}

#[test]
fn a_table_of_displacements_is_read_from_a_file_with_its_units() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(
        folder.path().join("heave.csv"),
        "t [min],roll [deg],z [cm]\n0,1,0\n0.01,2,0\n0.02,3,150\n0.1,4,150\n",
    )
    .unwrap();
    let h = history(folder.path(), "[[motions]]\ntype = \"table\"\nname = \"path\"\nfile = \"heave.csv\"\n")
        .unwrap();
    assert!((at(&h, "ball.z", 6)).abs() < 1e-9 && (at(&h, "ball.z", 12) - 1.5).abs() < 1e-9);
    let highest = h.column("ball.z").unwrap().iter().fold(0.0_f64, |a, z| a.max(*z));
    assert!(highest < 1.5 + 1e-9, "{highest}");
    assert_eq!(at(&h, "ball.x", 12), 0.0);
}

/// 1 m until 2 s; the force is that of an acceleration of 1/2 m/s².
#[test]
fn a_table_of_speeds_moves_by_the_area_under_it() {
    let folder = tempfile::tempdir().unwrap();
    let speeds = "[[motions]]\ntype = \"speed_table\"\nname = \"path\"\nt = [0, 1, 2.5]\nv = [0, 0.5, 0.5]\n";
    let h = history(folder.path(), speeds).unwrap();
    assert!((at(&h, "ball.x", 10) - 0.25).abs() < 1e-9 && (at(&h, "ball.x", 20) - 0.75).abs() < 1e-9);
    for (row, force) in [(5, 0.5), (9, 0.5), (11, 0.0), (15, 0.0)] {
        let f = at(&h, "hand.fx", row);
        assert!((f.abs() - force).abs() < 1e-6, "{f} N at row {row}");
    }
}

#[test]
fn motions_add_up_whatever_their_order() {
    let folder = tempfile::tempdir().unwrap();
    let motions = r#"
[[motions]]
type = "sum"
name = "path"
motions = ["both", "swing"]
[[motions]]
type = "sum"
name = "both"
motions = ["run"]
[[motions]]
type = "straight"
name = "run"
speed = 1
ramp = 1
[[motions]]
type = "harmonic"
name = "swing"
amplitude = [0, 0, 0.5]
frequency = 1
ramp = 1
"#;
    let h = history(folder.path(), motions).unwrap();
    assert!((at(&h, "ball.x", 20) - 1.5).abs() < 1e-9, "{}", at(&h, "ball.x", 20));
    let z = 0.5 * (std::f64::consts::TAU * 1.7).sin();
    // rows of the history lie between steps
    assert!((at(&h, "ball.z", 17) - z).abs() < 1e-3, "{}", at(&h, "ball.z", 17));
}

/// A crank that is turned by a quarter, told in degrees, in the scene and in a file.
#[test]
fn angles_are_given_in_degrees() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("turn.csv"), "t [s],angle [deg]\n0,0\n1,90\n2,90\n").unwrap();
    let crank = |table: &str| {
        format!(
            r#"
[run]
duration = "2 s"
output = "0.1 s"
[[elements]]
type = "rigid_body"
name = "crank"
position = [0, 0, 0]
mass = 1
inertia = [1, 1, 1]
points = {{ tip = [1, 0, 0] }}
[[constraints]]
type = "revolute"
name = "axle"
marker = "crank"
axis = [0, 0, 1]
[[constraints]]
type = "rotation"
name = "drive"
marker = "crank"
axis = [0, 0, 1]
motion = "turn"
[[motions]]
type = "table"
name = "turn"
{table}
[[records]]
type = "position"
of = "crank.tip"
"#
        )
    };
    for table in [
        "t = [0, 1, 2]\nangle = [0, \"90 deg\", \"90 deg\"]\nends = \"at-rest\"",
        "file = \"turn.csv\"\nends = \"at-rest\"",
    ] {
        let file = folder.path().join("crank.toml");
        fs::write(&file, crank(table)).unwrap();
        let h = simulate(&ropewalk::read(&file).unwrap_or_else(|e| panic!("{e}")))
            .unwrap_or_else(|e| panic!("{e}"));
        let tip = [at(&h, "crank.tip.x", 20), at(&h, "crank.tip.y", 20)];
        assert!(tip[0].abs() < 1e-4 && (tip[1] - 1.0).abs() < 1e-4, "{tip:?}");
    }
}

#[test]
fn motions_that_make_no_sense_are_refused_where_they_stand() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    write("none.csv", "t [s],roll [deg]\n0,0\n1,1\n");
    write("both.csv", "t [s],z [m],angle [deg]\n0,0,0\n1,1,1\n");
    write("unit.csv", "t [s],angle [m]\n0,0\n1,1\n");
    write("order.csv", "t [s],z\n0,0\n1,1\n\n1,2\n");
    write("kink.csv", "t [s],z\n0,0\n1,0\n2,3\n");
    let table = |rest: &str| format!("[[motions]]\ntype = \"table\"\nname = \"path\"\n{rest}\n");
    let sum =
        |name: &str, of: &str| format!("[[motions]]\ntype = \"sum\"\nname = \"{name}\"\nmotions = [{of}]\n");
    for (motions, line, holds) in [
        (
            table("file = \"none.csv\""),
            "file",
            &["none.csv, line 1", "no column `x`, `y`, `z` or `angle`"][..],
        ),
        (table("file = \"both.csv\""), "file", &["both.csv, line 1", "not both"]),
        (table("file = \"unit.csv\""), "file", &["unit.csv, line 1, column 7", "expected an angle"]),
        (table("file = \"order.csv\""), "file", &["order.csv, line 5", "times must ascend"]),
        (
            table("file = \"kink.csv\"\njoin = \"linear\""),
            "file",
            &["kink.csv, line 3", "velocity would jump at 1 s"],
        ),
        (table("file = \"none.csv\"\nt = [0, 1]"), "file", &["either a `file` or `t`"]),
        (table("t = [0, 1]\nz = [0, 1]\nangle = [0, 1]"), "angle", &["not both"]),
        (table("t = [0, 1]\nangle = [0, \"1 m\"]"), "angle", &["expected an angle"]),
        (
            table("t = [0, 1, 2]\nz = [0, 0, 3]\njoin = \"linear\""),
            "t",
            &["row 2", "monotone", "speed_table"],
        ),
        (
            table("t = [0, 1]\nz = [0, 1]\njoin = \"linear\"\nends = \"at-rest\""),
            "ends",
            &["leave `ends` out"],
        ),
        (sum("path", ""), "motions", &["name the motions to add"]),
        (sum("path", "\"heave\""), "motions", &["there is no motion `heave`; the motions are `path`"]),
        (sum("path", "\"path\""), "motions", &["`path` of `path` are made of each other"]),
        (
            sum("path", "\"a\"") + &sum("a", "\"b\"") + &sum("b", "\"path\""),
            "motions",
            &["`path` of `a` of `b` of `path` are made of each other"],
        ),
    ] {
        let text = format!("{DRIVEN}{motions}");
        let file = folder.path().join("scene.toml");
        fs::write(&file, &text).unwrap();
        let fault = match SceneFile::open(&file.to_string_lossy(), &[], &[]) {
            Err(fault) => fault,
            Ok(file) => file.build().err().unwrap_or_else(|| panic!("{motions} is accepted")),
        };
        let said = fault.to_string();
        assert!(holds.iter().all(|h| said.contains(h)), "{motions}: {said}");
        let place = fault.place.as_ref().unwrap_or_else(|| panic!("{said}"));
        let stands = text.lines().nth(place.line - 1).unwrap();
        assert!(stands.starts_with(line), "{motions} points at `{stands}`: {said}");
    }
    assert!(SceneFile::parse(DRIVEN, "x", Format::Toml, &[]).unwrap().build().is_err());
}

/// A cable that hangs from a point which heaves, and what its run warns of.
fn heaved(ramp: &str, sections: &str) -> Vec<String> {
    let text = format!(
        r#"
        run = {{ duration = 0.2, output = 0.1 }}
        [[motions]]
        type = "harmonic"
        name = "heave"
        amplitude = [0, 0, 2]
        frequency = 0.1
        {ramp}
        [[elements]]
        type = "cable"
        name = "umbilical"
        points = [[0, 0, 0], [0, 0, -1000]]
        elements = 20
        {sections}
        [[constraints]]
        type = "driving"
        name = "top"
        marker = "umbilical.start"
        motion = "heave"
        [[forces]]
        type = "gravity"
        [[records]]
        type = "along"
        of = "umbilical"
        what = "tension"
        at = "start"
        "#
    );
    let file = SceneFile::parse(&text, "heave", Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}"));
    simulate(&file.into_scene()).unwrap_or_else(|e| panic!("{e}")).warnings
}

#[test]
fn a_cable_that_is_struck_at_the_start_is_told_with_its_shock() {
    let one = "section = { mass = 3, ea = 2e7, axial_retardation_time = 0.01 }";
    let warnings = heaved("ramp = 0", one);
    // 2 m at 0.1 Hz is 1.257 m/s, and √(EA μ) 7746 kg/s
    let told = warnings.iter().find(|w| w.contains("struck at its start"));
    assert!(told.is_some_and(|w| w.contains("1.3 m/s") && w.contains("9700 N")), "{warnings:?}");
    assert!(!heaved("", one).iter().any(|w| w.contains("struck")));
    // a splice is two nodes in one place
    let two = "sections = [{ to = 600, section = { mass = 3, ea = 2e7, axial_retardation_time = 0.01 } }, \
               { section = { mass = 4, ea = 3e7, axial_retardation_time = 0.01 } }]";
    let warnings = heaved("ramp = 0", two);
    assert!(warnings.iter().any(|w| w.contains("struck at its start")), "{warnings:?}");
}

/// A winch that suddenly pays out leaves a cable that hangs slack by as much, and does nothing to one that moves along with it.
#[test]
fn what_feeds_is_struck_if_its_material_is() {
    for (speed, told) in [(0.0, true), (-0.5, false)] {
        let text = format!(
            r#"
            run = {{ duration = 1e-3 }}
            [[elements]]
            type = "cable"
            name = "line"
            points = [[0, 0, 0], [0, 0, -1]]
            elements = 8
            velocity = [0, 0, {speed}]
            section = {{ mass = 0.01, ea = 1e4, axial_retardation_time = 1e-3 }}
            [[motions]]
            type = "speed_table"
            name = "out"
            direction = [1, 0, 0]
            t = [0, 100]
            v = [0.5, 0.5]
            [[constraints]]
            type = "spherical"
            name = "drum"
            marker = "line.start"
            [[constraints]]
            type = "winch"
            name = "winch"
            marker = "line.start"
            motion = "out"
            "#
        );
        let file = SceneFile::parse(&text, "fed", Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}"));
        let warnings = simulate(&file.into_scene()).unwrap_or_else(|e| panic!("{e}")).warnings;
        let struck = warnings.iter().find(|w| w.contains("struck at its start"));
        assert_eq!(struck.is_some(), told, "{warnings:?}");
        assert!(struck.is_none_or(|w| w.contains("0.5 m/s") && w.contains("5 N")), "{warnings:?}");
    }
}

/// A chain whose damping makes a force of what the velocity of its driven end is moved by: its reaction is that of the motion, at
/// the ends of steps too.
#[test]
fn reactions_of_driven_chains_are_as_exact_as_asked() {
    let chain = include_str!("../../book/src/mooring.in/chain.toml").replace("60 s", "12 s");
    let pull = |tolerance: f64, force: f64| {
        let solver = format!(
            "[solver]\nstepping = {{ controlled = {{ tolerance = {tolerance} }} }}\nforce_tolerance = {force}\n"
        );
        let text = chain.replace("[run]", &format!("{solver}[run]"));
        let file = SceneFile::parse(&text, "chain", Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}"));
        let history = simulate(file.scene()).unwrap_or_else(|e| panic!("{e}"));
        history.column("fairlead.magnitude").expect("fairlead").to_vec()
    };
    let (coarse, fine) = (pull(1e-5, 1e-4), pull(1e-6, 1e-5));
    let largest = fine.iter().fold(0.0, |most: f64, pull| if *pull <= most { most } else { *pull });
    let off = coarse.iter().zip(&fine).map(|(a, b)| (a - b).abs() / largest);
    let off = off.fold(0.0, |worst: f64, off| if off <= worst { worst } else { off });
    println!("{off:.1e} of the largest force");
    // what the manual promises of tolerances
    assert!(off < 3.0 * 1e-4, "{off:.1e} of the largest force at worst, 1e-4 asked for");
}

/// A body that is shaken is where its motion has it, between steps as at their ends, and as fast; so is its energy.
#[test]
fn what_a_motion_leads_is_where_and_as_fast_as_it_says() {
    use std::f64::consts::TAU;
    for solver in ["", "solver = { scheme = \"radau-iia-5\" }"] {
        let text = format!(
            r#"
            run = {{ duration = "4 s", output = "7 ms" }}
            {solver}
            elements = [{{ type = "rigid_body", name = "b", position = [0, 0, 0], mass = 3, inertia = [1, 1, 1] }}]
            constraints = [{{ type = "driving", name = "d", marker = "b", motion = "m" }}]
            motions = [{{ type = "harmonic", name = "m", amplitude = [10, 0, 0], frequency = 2, ramp = 0.5 }}]
            records = [{{ type = "position", of = "b" }}, {{ type = "velocity", of = "b" }}, {{ type = "energy" }}]
            "#
        );
        let file = SceneFile::parse(&text, "shaken", Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}"));
        let h = simulate(file.scene()).unwrap_or_else(|e| panic!("{e}"));
        let mut worst = [0.0_f64; 3];
        for (k, t) in h.times().iter().enumerate().filter(|(_, t)| **t > 0.5) {
            let (sin, cos) = (2.0 * TAU * t).sin_cos();
            let (x, v) = (10.0 * sin, 20.0 * TAU * cos);
            for (worst, (column, right)) in
                worst.iter_mut().zip([("b.x", x), ("b.vx", v), ("energy.kinetic", 1.5 * v * v)])
            {
                let off = (at(&h, column, k) - right).abs();
                *worst = if off <= *worst { *worst } else { off };
            }
        }
        assert!(worst[0] < 1e-9 && worst[1] < 1e-8 && worst[2] < 1e-5, "{solver}: {worst:?}");
        // what shakes it brings in what it has
        let imbalance = h.column("energy.imbalance").expect("energy");
        assert!(imbalance.iter().all(|x| x.abs() < 1e-3 * 23687.0), "{solver}: {imbalance:?}");
    }
}

/// A drive that begins after a long rest, of which steps know nothing, brings in what the body has then.
#[test]
fn a_late_drive_brings_in_no_more_than_the_body_has() {
    for solver in ["", "solver = { scheme = \"radau-iia-5\" }"] {
        let text = format!(
            r#"
            run = {{ duration = "80 s", output = "10 ms" }}
            {solver}
            elements = [{{ type = "rigid_body", name = "b", position = [0, 0, 0], mass = 2, inertia = [1, 1, 1] }}]
            motions = [
                {{ type = "harmonic", name = "m", amplitude = [0.1, 0, 0], frequency = 2, start = 61.3, ramp = 0.05 }},
            ]
            records = [{{ type = "energy" }}]
            [[constraints]]
            type = "prismatic"
            name = "rail"
            marker = "b"
            axis = [1, 0, 0]
            [[constraints]]
            type = "slide"
            name = "drive"
            marker = "b"
            axis = [1, 0, 0]
            motion = "m"
            "#
        );
        let file = SceneFile::parse(&text, "late", Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}"));
        let h = simulate(file.scene()).unwrap_or_else(|e| panic!("{e}"));
        let column = |name: &str| h.column(name).expect("energy");
        let most = column("energy.kinetic").iter().fold(0.0, |m: f64, x| m.max(*x));
        assert!((4.0..5.0).contains(&most), "{most}");
        let imbalance = column("energy.imbalance");
        assert!(imbalance.iter().all(|x| x.abs() < 1e-2 * most), "{solver}: {imbalance:?}");
    }
}

/// A slider that a crank drives has the kinetic energy of its geometry, and the motor's work is what has become of it.
#[test]
fn a_driven_slider_crank_has_the_energy_of_its_geometry() {
    const SCENE: &str = r#"
        run = { duration = "2 s", output = "2 ms" }
        gravity = [0, 0, 0]
        motions = [{ type = "spin", name = "w", rate = 15, ramp = 0 }]
        elements = [
            { type = "rigid_body", name = "c", position = [0, 0, 0], mass = 1, inertia = [0.1, 0.1, 0.1],
              angular_velocity = [0, 0, 15], points = { e = [0.2, 0, 0] } },
            { type = "rigid_body", name = "k", position = [0.5, 0, 0], mass = 1, inertia = [0.006, 0.03, 0.03],
              velocity = [0, 1.5, 0], angular_velocity = [0, 0, -5], points = { a = [-0.3, 0, 0], b = [0.3, 0, 0] } },
            { type = "rigid_body", name = "s", position = [0.8, 0, 0], mass = 3, inertia = [0.1, 0.1, 0.1] },
        ]
        constraints = [
            { type = "revolute", name = "h", marker = "c", axis = [0, 0, 1] },
            { type = "rotation", name = "m", marker = "c", axis = [0, 0, 1], motion = "w" },
            { type = "revolute", name = "h1", marker = "k.a", to = "c.e", axis = [0, 0, 1] },
            { type = "spherical", name = "h2", marker = "k.b", to = "s" },
            { type = "prismatic", name = "p", marker = "s", axis = [1, 0, 0] },
        ]
        records = [{ type = "energy" }]
    "#;
    let file = SceneFile::parse(SCENE, "crank", Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}"));
    let h = simulate(file.scene()).unwrap_or_else(|e| panic!("{e}"));
    for (k, t) in h.times().iter().enumerate() {
        let (sin, cos) = (15.0 * t).sin_cos();
        let lean = -(sin / 3.0).asin();
        let (turns, (s, c)) = (-5.0 * cos / lean.cos(), lean.sin_cos());
        let (x, y, slide) =
            (-3.0 * sin - 0.3 * s * turns, 3.0 * cos + 0.3 * c * turns, -3.0 * sin - 0.6 * s * turns);
        let right = 0.5 * (0.1 * 225.0 + x * x + y * y + 0.03 * turns * turns + 3.0 * slide * slide);
        let found = at(&h, "energy.kinetic", k);
        // what steps do wrong of positions is 1e-6 of them
        assert!((found - right).abs() < 1e-4 * right, "{t}: {found} J, {right} J by geometry");
        let imbalance = at(&h, "energy.imbalance", k);
        assert!(imbalance.abs() < 2e-3 * 31.0, "{t}: {imbalance} J from nowhere");
    }
}
