//! Vessels and buoys that float freely, against the solutions of their linear equations and other integrators.

use super::{refused, run, scene};
use ropewalk::History;
use std::f64::consts::{PI, TAU};

const SOLVER: &str = "[solver]\nscheme = \"radau-iia-5\"\nstepping = { controlled = { tolerance = 1e-9 } }";

/// A buoy about whose waterline coefficients are; its centre of mass is below.
fn buoy(run: &str, body: &str, water: &str, vessel: &str) -> String {
    format!(
        r#"
        run = {{ {run} }}
        {SOLVER}
        {water}
        [[elements]]
        type = "rigid_body"
        name = "buoy"
        position = [2, -3, 0]
        mass = 2000
        inertia = [900, 1100, 700]
        {body}
        [[forces]]
        type = "gravity"
        [[forces]]
        type = "free_vessel"
        name = "float"
        marker = "buoy"
        {vessel}
        [[records]]
        type = "force"
        of = "float"
        [[records]]
        type = "energy"
        "#
    )
}

fn column<'a>(h: &'a History, name: &str) -> &'a [f64] {
    h.column(name).unwrap_or_else(|| panic!("no {name}"))
}

/// Heave and roll decay as `e^(-δt) sin ωt`, with their periods `2π √((M + A)/K)`.
#[test]
fn heave_and_roll_decay_with_their_periods() {
    for (moving, name, inertia, stiffness, damping) in [
        ("velocity = [0, 0, 0.3]", "float.heave", 2000.0 + 1500.0, 3e4, 900.0),
        ("angular_velocity = [0.05, 0, 0]", "float.roll", 900.0 + 400.0, 5e3, 200.0),
    ] {
        let text = buoy(
            "duration = 20, output = 0.1",
            moving,
            "",
            "stiffness = [0, 0, 3e4, 5e3, 5e3, 0]\nadded_mass = [800, 800, 1500, 400, 300, 0]\ndamping = [0, 0, 900, 200, 200, 0]",
        );
        let h = run(&text);
        let decay = damping / (2.0 * inertia);
        let omega = f64::sqrt(stiffness / inertia - decay * decay);
        let start = if name == "float.heave" { 0.3 } else { 0.05 };
        for (t, x) in h.times().iter().zip(column(&h, name)) {
            let wanted = start / omega * (-decay * t).exp() * (omega * t).sin();
            assert!((x - wanted).abs() <= 1e-6 * start, "{name} at {t}: {x} {wanted}");
        }
        // the audit takes the trapezoidal rule for what is dissipated
        let imbalance = column(&h, "energy.imbalance");
        let most = 0.5 * inertia * start * start;
        assert!(imbalance.iter().all(|x| x.abs() <= 1e-4 * most), "{imbalance:?}");
    }
}

/// Damping by the square of the velocity, against the method of Runge and Kutta.
#[test]
fn quadratic_damping_is_that_of_the_equation() {
    let vessel = "stiffness = [0, 0, 3e4, 5e3, 5e3, 0]\nadded_mass = [0, 0, 1500, 0, 0, 0]\nquadratic_damping = [0, 0, 2500, 0, 0, 0]";
    let h = run(&buoy("duration = 15, output = 0.5", "velocity = [0, 0, 1.5]", "", vessel));
    let force = |x: f64, v: f64| -(3e4 * x + 2500.0 * v * v.abs()) / 3500.0;
    let (mut x, mut v, dt) = (0.0, 1.5, 1e-3);
    let heave = column(&h, "float.heave");
    for (k, found) in heave.iter().enumerate() {
        assert!((found - x).abs() <= 1e-6, "{k}: {found} {x}");
        for _ in 0..500 {
            let (v1, a1) = (v, force(x, v));
            let (v2, a2) = (v + 0.5 * dt * a1, force(x + 0.5 * dt * v1, v + 0.5 * dt * a1));
            let (v3, a3) = (v + 0.5 * dt * a2, force(x + 0.5 * dt * v2, v + 0.5 * dt * a2));
            let (v4, a4) = (v + dt * a3, force(x + dt * v3, v + dt * a3));
            x += dt / 6.0 * (v1 + 2.0 * v2 + 2.0 * v3 + v4);
            v += dt / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
        }
    }
}

type Complex = (f64, f64);

fn times(a: Complex, b: Complex) -> Complex {
    (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0)
}

fn over(a: Complex, b: Complex) -> Complex {
    let size = b.0 * b.0 + b.1 * b.1;
    times(a, (b.0 / size, -b.1 / size))
}

/// `x` with `m x = b`, by elimination.
fn solved(mut m: [[Complex; 6]; 6], mut b: [Complex; 6]) -> [Complex; 6] {
    for k in 0..6 {
        for i in (0..6).filter(|i| *i != k) {
            let factor = over(m[i][k], m[k][k]);
            for j in k..6 {
                let less = times(factor, m[k][j]);
                m[i][j] = (m[i][j].0 - less.0, m[i][j].1 - less.1);
            }
            let less = times(factor, b[k]);
            b[i] = (b[i].0 - less.0, b[i].1 - less.1);
        }
    }
    std::array::from_fn(|k| over(b[k], m[k][k]))
}

fn rows(m: &[[f64; 6]; 6]) -> String {
    format!("{m:?}")
}

/// All six motions in a small wave aslant are those of `(K - ω²(M + A) - iωB) X = F`, with full matrices, a centre of mass below the
/// reference point, and a heading: `θ` falls with time, so that `e^{iθ}` has the rate `-iω`.
#[test]
fn motions_in_a_wave_are_those_of_the_linear_equation() {
    let wiggle = |i: usize, j: usize| ((1 + i + j + 3 * i * j) as f64).sin();
    let symmetric = |scale: [f64; 6], share: f64| -> [[f64; 6]; 6] {
        std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let own = if i == j { 1.0 } else { share * wiggle(i, j) };
                own * f64::sqrt(scale[i] * scale[j])
            })
        })
    };
    let stiffness = symmetric([1500.0, 1800.0, 3e4, 2e4, 2.2e4, 2e3], 0.1);
    let added = symmetric([1200.0, 1300.0, 1500.0, 400.0, 300.0, 200.0], 0.15);
    let damping = symmetric([2500.0, 2600.0, 6000.0, 4000.0, 4000.0, 900.0], 0.1);
    let (mass, inertia, depth) = (2000.0, [900.0, 1100.0, 700.0], 0.7);
    let amplitude = [3e3, 2e3, 2.5e4, 4e3, 6e3, 800.0];
    let lag = [-80.0, 70.0, 5.0, 100.0, -95.0, 30.0];
    let (height, period) = (1e-4, 5.0);
    let water = format!(
        "[water]\nlevel = 0\n[water.waves]\ncomponents = [{{ amplitude = {height}, period = {period}, direction = \"75 deg\", phase = 0.4 }}]\nramp = 20"
    );
    let vessel = format!(
        "heading = \"30 deg\"\nstiffness = {}\nadded_mass = {}\ndamping = {}\nloads = {{ headings = [0], omegas = [1], amplitude = \
         [[{amplitude:?}]], lag = [[{lag:?}]] }}",
        rows(&stiffness),
        rows(&added),
        rows(&damping)
    );
    let body = format!("centre = [0, 0, -{depth}]\nangles = [0, 0, \"30 deg\"]");
    let h = run(&buoy("duration = 150, output = 0.25", &body, &water, &vessel));
    // its own mass about the reference point: T = ½ m |v + ω × c|² + …
    let mut own = [[0.0; 6]; 6];
    for i in 0..3 {
        (own[i][i], own[3 + i][3 + i]) = (mass, inertia[i]);
    }
    for (i, j, sign) in [(0, 4, -1.0), (1, 3, 1.0)] {
        (own[i][j], own[j][i]) = (sign * mass * depth, sign * mass * depth);
    }
    for i in [3, 4] {
        own[i][i] += mass * depth * depth;
    }
    let omega = TAU / period;
    let matrix = std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            (stiffness[i][j] - omega * omega * (own[i][j] + added[i][j]), -omega * damping[i][j])
        })
    });
    let load = std::array::from_fn(|k| {
        let lag: f64 = f64::to_radians(lag[k]);
        (amplitude[k] * lag.cos(), amplitude[k] * lag.sin())
    });
    let response = solved(matrix, load);
    let k = omega * omega / 9.81;
    let direction = 75_f64.to_radians();
    let there = k * (2.0 * direction.cos() - 3.0 * direction.sin()) + 0.4;
    let names = ["surge", "sway", "heave", "roll", "pitch", "yaw"];
    for (name, (re, im)) in names.iter().zip(response) {
        let size = height * re.hypot(im);
        for (t, x) in h.times().iter().zip(column(&h, &format!("float.{name}"))).filter(|(t, _)| **t > 120.0)
        {
            let theta = there - omega * t;
            let wanted = height * (re * theta.cos() - im * theta.sin());
            assert!((x - wanted).abs() <= 2e-4 * size, "{name} at {t}: {x} {wanted}");
        }
    }
    let share =
        column(&h, "energy.imbalance").iter().fold(0.0, |m: f64, x| if x.abs() <= m { m } else { x.abs() });
    let most = column(&h, "energy.supplied").iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    assert!(share <= 1e-4 * most, "{share} of {most}");
}

/// A table says the same in every way of writing it.
#[test]
fn imports_of_other_conventions_are_the_same_table() {
    let own = "headings = [\"0 deg\", \"60 deg\", \"180 deg\", \"300 deg\"], omegas = [0.8, 1.5], \
               amplitude = [[[1,0,3,0,2,0],[2,0,2,0,1,0]],[[2,1,3,4,2,1],[1,1,2,3,1,2]],[[1,0,2,0,2,0],[2,0,1,0,1,0]],[[2,1,3,4,2,1],[1,1,2,3,1,2]]], \
               lag = [[[-80,0,5,0,-90,0],[-70,0,9,0,-99,0]],[[-70,-60,3,50,-80,30],[-40,-50,9,20,-10,60]],[[90,0,5,0,80,0],[80,0,9,0,90,0]],[[-70,120,3,230,-80,210],[-40,130,9,200,-10,240]]]";
    let other = "symmetry = \"xz\", phase = \"lead\", per = \"height\", headings = [\"0 deg\", \"60 deg\", \"180 deg\"], omegas = [0.8, 1.5], \
                 amplitude = [[[0.5,0,1.5,0,1,0],[1,0,1,0,0.5,0]],[[1,0.5,1.5,2,1,0.5],[0.5,0.5,1,1.5,0.5,1]],[[0.5,0,1,0,1,0],[1,0,0.5,0,0.5,0]]], \
                 lag = [[[80,0,-5,0,90,0],[70,0,-9,0,99,0]],[[70,60,-3,-50,80,-30],[40,50,-9,-20,10,-60]],[[-90,0,-5,0,-80,0],[-80,0,-9,0,-90,0]]]";
    let from = own
        .replace("[\"0 deg\", \"60 deg\", \"180 deg\", \"300 deg\"]", "[\"0 deg\", \"120 deg\", \"180 deg\", \"240 deg\"]")
        // rows by where waves come from: 0 is the head sea
        .replace("[[[1,0,3,0,2,0],[2,0,2,0,1,0]],[[2,1,3,4,2,1],[1,1,2,3,1,2]],[[1,0,2,0,2,0],[2,0,1,0,1,0]],", "[[[1,0,2,0,2,0],[2,0,1,0,1,0]],[[2,1,3,4,2,1],[1,1,2,3,1,2]],[[1,0,3,0,2,0],[2,0,2,0,1,0]],")
        .replace("[[[-80,0,5,0,-90,0],[-70,0,9,0,-99,0]],[[-70,-60,3,50,-80,30],[-40,-50,9,20,-10,60]],[[90,0,5,0,80,0],[80,0,9,0,90,0]],[[-70,120,3,230,-80,210],[-40,130,9,200,-10,240]]]",
                 "[[[90,0,5,0,80,0],[80,0,9,0,90,0]],[[-70,120,3,230,-80,210],[-40,130,9,200,-10,240]],[[-80,0,5,0,-90,0],[-70,0,9,0,-99,0]],[[-70,-60,3,50,-80,30],[-40,-50,9,20,-10,60]]]")
        + ", waves = \"from\"";
    let table = |rao: &str| -> ropewalk_scene::RaoSpec {
        let text =
            buoy("duration = 1", "", "", &format!("stiffness = [0, 0, 1, 1, 1, 0]\nloads = {{ {rao} }}"));
        let file = scene(&text);
        let value = serde_json::to_value(&*file.scene().forces[1]).expect("JSON");
        serde_json::from_value(value["free_vessel"]["loads"].clone()).expect("a table")
    };
    let wanted = table(own).loads("loads").expect("loads");
    for rao in [other, &from] {
        let found = table(rao).loads("loads").expect("loads");
        for k in 0..72 {
            let relative = PI / 36.0 * f64::from(k) + 0.01;
            for omega in [0.5, 0.9, 1.2, 2.0] {
                for (a, b) in wanted.at(relative, omega).iter().zip(found.at(relative, omega)) {
                    let turn = (a[1] - b[1] + PI).rem_euclid(TAU) - PI;
                    assert!(
                        (a[0] - b[0]).abs() <= 1e-12 && (turn * a[0]).abs() <= 1e-12,
                        "{relative} {omega}: {a:?} {b:?}"
                    );
                }
            }
        }
    }
}

#[test]
fn what_is_wrong_with_a_free_vessel_is_said() {
    let still = "stiffness = [0, 0, 3e4, 5e3, 5e3, 0]";
    let loads = "loads = { headings = [0], omegas = [1], amplitude = [[[0, 0, 1, 0, 0, 0]]], lag = [[[0, 0, 0, 0, 0, 0]]] }";
    for (body, vessel, said) in [
        ("", format!("{still}\n{loads}"), "the scene has none"),
        ("volume = 2", still.into(), "leave its `volume` out"),
        ("", format!("{still}\nadded_mass = [0, 0, -1, 0, 0, 0]"), "less than no inertia"),
        ("", format!("{still}\ndamping = [0, 0, -1, 0, 0, 0]"), "drives a motion"),
        ("", format!("{still}\nquadratic_damping = [0, 0, -1, 0, 0, 0]"), "must not be negative"),
        (
            "",
            "stiffness = [[1,0,0,0,5,0],[0,1,0,0,0,0],[0,0,1,0,0,0],[0,0,0,1,0,0],[4,0,0,0,1,0],[0,0,0,0,0,1]]".into(),
            "must be symmetric",
        ),
        ("", "stiffness = [1, 2]".into(), "six rows of six numbers"),
    ] {
        let error = refused(&buoy("duration = 1", body, "", &vessel));
        assert!(error.contains(said), "{said}: {error}");
    }
}

/// What a run says of its table: the longest waves beside what stiffness makes of them.
#[test]
fn limits_of_long_waves_are_in_the_notes() {
    let text = buoy(
        "duration = 1",
        "",
        "[water]\nlevel = 0\n[water.waves]\ncomponents = [{ amplitude = 1, period = 8 }]",
        "stiffness = [0, 0, 3e4, 5e3, 5e3, 0]\nloads = { headings = [0], omegas = [0.5], amplitude = [[[10, 0, 2.9e4, 0, 130, 0]]], lag = [[[-90, 0, 1, 0, -91, 0]]] }",
    );
    let notes: Vec<String> = scene(&text).scene().forces.iter().flat_map(|f| f.notes()).collect();
    let note = notes.first().expect("a note");
    for said in [
        "of 12.6 s",
        "heave 2.900e4 with lag 1 deg (from stiffness 3.000e4 with 0 deg)",
        "pitch 1.300e2 with lag -91 deg",
    ] {
        assert!(note.contains(said), "{said}: {note}");
    }
}
