//! A page of a made-up run: a cable swings below a ship that rolls along, with a ball at its end.
//!
//! ```text
//! cargo run -p ropewalk-report --example page -- report.html
//! ```
//!
//! With a folder as second argument it writes files for ParaView there.

use std::f64::consts::TAU;
use std::path::PathBuf;

use ropewalk_core::rotation::exp;
use ropewalk_report::{
    BodyRecord, Column, Entry, Event, FieldRecord, ForceRecord, LineRecord, LineSnapshot, Listing, Mesh,
    OutputError, Page, Panel, Pose, Quantity, RangeGraph, Shape, Solid, Steps, Table, Wave, Waves, vtk,
};

const POINTS: usize = 161;
const SNAPSHOTS: usize = 361;
const LENGTH: f64 = 30.0;
const SPEED: f64 = 1.2;

/// Where the ship is [m].
fn ship(t: f64) -> [f64; 3] {
    [SPEED * t - 30.0, 6.0 * (0.08 * t).sin(), 1.2 + 0.3 * (TAU * t / 7.0).sin()]
}

/// The point of the cable at arc length `s`: a tow that trails behind and swings in two directions.
fn cable(s: f64, t: f64) -> [f64; 3] {
    let top = ship(t - 0.12 * s);
    let u = s / LENGTH;
    let swing = 3.5 * u * u * (TAU * t / 11.0 - 1.4 * u).sin();
    let wave = 0.35 * u * (TAU * (t / 3.1 - 1.6 * u)).sin();
    [top[0] - 0.45 * s + 0.004 * s * s, top[1] + swing + wave, top[2] * (1.0 - u) - 0.78 * s + 0.006 * s * s]
}

fn along(t: f64) -> LineSnapshot {
    let s: Vec<f64> = (0..POINTS).map(|k| LENGTH * k as f64 / (POINTS - 1) as f64).collect();
    let (h, dt) = (0.05, 1e-3);
    let length = |v: [f64; 3]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
    let difference = |a: [f64; 3], b: [f64; 3], d: f64| [0, 1, 2].map(|i| (b[i] - a[i]) / d);
    let speed = |s: &f64| length(difference(cable(*s, t - dt), cable(*s, t + dt), 2.0 * dt));
    let curvature = |s: &f64| {
        let (a, b, c) = (cable(s - h, t), cable(*s, t), cable(s + h, t));
        length(difference(difference(a, b, h), difference(b, c, h), h))
    };
    let tension =
        |s: &f64| 40.0 * (LENGTH - s) + 350.0 + 120.0 * (TAU * t / 7.0 - 0.1 * s).sin() * (1.0 - s / 60.0);
    LineSnapshot {
        position: s.iter().map(|s| cable(*s, t)).collect(),
        values: vec![
            s.iter().map(tension).collect(),
            s.iter().map(curvature).collect(),
            s.iter().map(speed).collect(),
        ],
        velocity: Vec::new(),
        s,
    }
}

fn field() -> FieldRecord {
    let times: Vec<f64> = (0..SNAPSHOTS).map(|k| 60.0 * k as f64 / (SNAPSHOTS - 1) as f64).collect();
    let mut hose = LineRecord::new("hose", "cable", 0.06);
    hose.place = "scene.toml:4".into();
    hose.quantities =
        vec![Quantity::new("tension", "N"), Quantity::new("curvature", "1/m"), Quantity::new("speed", "m/s")];
    hose.snapshots = times.iter().map(|t| along(*t)).collect();

    let mut vessel = BodyRecord::new("ship", "rigid body");
    vessel.place = "scene.toml:12".into();
    let deck = Shape::new("deck house", Solid::Box { half: [1.0, 0.9, 0.8] }, Pose::at([1.6, 0.0, 1.4]));
    vessel.shapes = vec![Shape::between("hull", [-3.5, 0.0, 0.0], [3.5, 0.0, 0.0], 1.8), deck];
    let turn = |t: &f64| exp([0.15 * (TAU * t / 5.0).sin(), 0.0, (0.48 * (0.08 * t).cos() / SPEED).atan()]);
    vessel.poses = times.iter().map(|t| Pose { position: ship(*t), orientation: turn(t) }).collect();

    let mut ball = BodyRecord::new("weight", "rigid body");
    ball.shapes = vec![Shape::new("", Solid::Ball { radius: 0.5 }, Pose::default())];
    ball.poses = times.iter().map(|t| Pose::at(cable(LENGTH, *t))).collect();

    let mut buoy = BodyRecord::new("buoy", "point mass");
    buoy.poses = times.iter().map(|t| Pose::at([12.0, -6.0, 0.2 * (TAU * t / 6.0).sin()])).collect();

    let upright = Solid::Cylinder { radius: 0.8, half: 14.0 };
    let sideways = exp([TAU / 4.0, 0.0, 0.0]);
    let pipe = Solid::Tube { radius: 1.5, half: 8.0 };
    let (a, b) = (4.0, 3.0);
    let rock = Mesh {
        points: vec![[a, 0.0, 0.0], [0.0, a, 0.0], [-a, 0.0, 0.0], [0.0, -a, 0.0], [0.5, 0.3, b]],
        triangles: vec![[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4], [0, 3, 2], [0, 2, 1]],
    };
    let force = |name: &str, at: fn(f64) -> ([f64; 3], [f64; 3])| {
        let (points, forces) = times.iter().map(|t| at(*t)).unzip();
        ForceRecord { name: name.into(), points, forces }
    };
    let pull = |t: f64| (cable(0.0, t), [-300.0, 40.0 * (TAU * t / 7.0).sin(), -900.0]);
    let drag = |t: f64| (cable(0.5 * LENGTH, t), [-250.0, 0.0, 60.0 * (TAU * t / 3.1).sin()]);
    let weight = |t: f64| (cable(LENGTH, t), [0.0, 0.0, -400.0]);
    FieldRecord {
        forces: vec![
            force("reaction: bow", pull),
            force("drag: hose", drag),
            force("weight: weight", weight),
        ],
        times,
        lines: vec![hose],
        bodies: vec![vessel, ball, buoy],
        shapes: vec![
            Shape::new("pile", upright, Pose::at([20.0, 14.0, -14.0])),
            Shape::new("pipe", pipe, Pose { position: [-10.0, 10.0, -26.0], orientation: sideways }),
            Shape::new("rock", Solid::Mesh(rock), Pose::at([4.0, -8.0, -28.0])),
        ],
        water: Some(0.0),
        waves: Some(Waves {
            all: vec![
                Wave { amplitude: 0.5, k: [0.28, 0.05], omega: 1.66, phase: 0.0 },
                Wave { amplitude: 0.3, k: [0.4, -0.2], omega: 2.09, phase: 1.0 },
                Wave { amplitude: 0.1, k: [4.0, 0.0], omega: 6.26, phase: 2.0 },
            ],
            ramp: 10.0,
        }),
        bed: Some(-28.0),
    }
}

fn history() -> Result<Table, OutputError> {
    let names =
        ["hose.end.x", "hose.end.y", "hose.end.z", "hose.start.tension", "hose.middle.tension", "ship.z"];
    let units = ["m", "m", "m", "N", "N", "m"];
    let mut table = Table::new(names.iter().zip(units).map(|(n, u)| Column::new(*n, u)));
    for k in 0..=1800 {
        let t = f64::from(k) / 30.0;
        let end = cable(LENGTH, t);
        let pull =
            |s: f64| 40.0 * (LENGTH - s) + 350.0 + 120.0 * (TAU * t / 7.0 - 0.1 * s).sin() * (1.0 - s / 60.0);
        table.push_row(&[t, end[0], end[1], end[2], pull(0.0), pull(15.0), ship(t)[2]])?;
    }
    Ok(table)
}

fn steps() -> Steps {
    let t: Vec<f64> = (1..=600).map(|k| 0.1 * f64::from(k)).collect();
    let size = |t: &f64| 0.03 * (1.2 + (TAU * t / 7.0).sin());
    Steps {
        least: t.iter().map(|t| 0.6 * size(t)).collect(),
        greatest: t.iter().map(size).collect(),
        cause: t.iter().map(|t| usize::from(size(t) < 0.03)).collect(),
        causes: ["position error", "force error"].map(String::from).to_vec(),
        counts: vec![2900, 3400],
        t,
    }
}

fn statistics() -> Listing {
    let strings = |all: &[&str]| all.iter().map(|s| (*s).to_string()).collect::<Vec<_>>();
    Listing {
        title: "Statistics".into(),
        headings: strings(&["record", "mean", "deviation", "least", "largest", "period [s]"]),
        rows: vec![
            strings(&["hose.start.tension [N]", "1550", "84.85", "1430", "1670", "7"]),
            strings(&["ship.z [m]", "1.2", "0.2121", "0.9", "-1.5", "7"]),
        ],
        note: "From 10 s to 60 s.".into(),
    }
}

/// The tension over whole periods, as it is made up.
fn range() -> RangeGraph {
    let s: Vec<f64> = (0..=60).map(|k| LENGTH * f64::from(k) / 60.0).collect();
    let over = |of: &dyn Fn(f64, f64) -> f64| -> Vec<f64> {
        s.iter().map(|s| of(40.0 * (LENGTH - s) + 350.0, 120.0 * (1.0 - s / 60.0))).collect()
    };
    RangeGraph {
        name: "hose".into(),
        quantity: "tension".into(),
        unit: "N".into(),
        window: [10.0, 60.0],
        start: over(&|mean, _| mean),
        least: over(&|mean, swing| mean - swing),
        mean: over(&|mean, _| mean),
        greatest: over(&|mean, swing| mean + swing),
        deviation: over(&|_, swing| swing / 2f64.sqrt()),
        t_least: over(&|_, _| 12.25),
        t_greatest: over(&|_, _| 15.75),
        s,
    }
}

fn main() -> Result<(), OutputError> {
    let mut arguments = std::env::args_os().skip(1).map(PathBuf::from);
    let path = arguments.next().unwrap_or_else(|| "report.html".into());
    let entry = Entry::new;
    let panel = |title: &str, columns: &[&str]| Panel {
        title: title.into(),
        columns: columns.iter().map(|c| (*c).to_string()).collect(),
    };
    let page = Page {
        title: "A weight towed by a ship that winds along".into(),
        subtitle: "made-up motion, no simulation".into(),
        status: "finished".into(),
        scene: include_str!("page.toml").into(),
        summary: vec![
            entry("steps", "1800"),
            entry("rejected steps", "12"),
            entry("Newton iterations", "4112"),
            entry("CPU time", "0.52 s"),
        ],
        warnings: vec!["the hose comes within 1.2 m of the rock: nothing keeps it out".into()],
        notes: vec!["the weight of the hose in water is 39.2 N/m".into()],
        events: vec![
            Event { t: 12.4, text: "the latch at the winch opens".into() },
            Event { t: 41.75, text: "hose touches the pipe".into() },
        ],
        settings: vec![
            entry("scheme", "generalized-alpha"),
            entry("tolerance", "1e-5"),
            entry("output", "every 1/30 s"),
        ],
        energy: vec![
            entry("kinetic", "1.31 kJ"),
            entry("potential", "−18.2 kJ"),
            entry("supplied", "9.44 kJ"),
            entry("dissipated", "8.13 kJ"),
            entry("imbalance", "0.21 J"),
        ],
        history: history()?,
        steps: Some(steps()),
        panels: vec![
            panel("End of the hose", &["hose.end.x", "hose.end.y", "hose.end.z"]),
            panel("Tension", &["hose.start.tension", "hose.middle.tension"]),
        ],
        field: field(),
        listings: vec![statistics()],
        ranges: vec![range()],
        ..Page::default()
    };
    page.write(&path)?;
    if let Some(folder) = arguments.next() {
        vtk::write(&page.field, &folder, "run")?;
    }
    Ok(())
}
