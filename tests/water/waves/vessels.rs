//! Vessels that move by their responses to waves, or by tables.

use super::{refused, run, scene};
use ropewalk_core::{At, Model};
use serde_json::Value;
use std::fmt::Write;

fn read(name: &str) -> Value {
    let path = format!("{}/tests/data/sea/{name}.json", env!("CARGO_MANIFEST_DIR"));
    serde_json::from_str(&std::fs::read_to_string(path).expect("file")).expect("JSON")
}

fn number(v: &Value) -> f64 {
    v.as_f64().unwrap_or_else(|| panic!("{v} is no number"))
}

fn list(v: &Value) -> Vec<f64> {
    v.as_array().expect("a list").iter().map(number).collect()
}

const BODY: &str = r#"
    [[elements]]
    type = "rigid_body"
    name = "ship"
    mass = 1e6
    inertia = [1e7, 1e8, 1e8]
    "#;

/// The vessel of a reference case.
fn vessel(case: &Value, more: &str) -> String {
    let sea = &case["sea"];
    let [a, omega, phase, beta] = ["a", "omega", "phase", "beta_deg"].map(|k| list(&sea[k]));
    let mut components = String::new();
    for k in 0..a.len() {
        let _ = write!(
            components,
            "{{ amplitude = {}, period = {:e}, phase = {:e}, direction = \"{} deg\" }}, ",
            a[k],
            std::f64::consts::TAU / omega[k],
            phase[k],
            beta[k]
        );
    }
    let rao = &case["rao"];
    let headings: Vec<String> = list(&rao["headings_deg"]).iter().map(|h| format!("\"{h} deg\"")).collect();
    format!(
        r#"
        [run]
        duration = "60 s"
        output = "1 s"
        {more}
        [water]
        level = 0
        [water.waves]
        components = [{components}]
        depth = {}
        {BODY}
        position = {:?}
        angles = [0, 0, "{heading} deg"]
        points = {{ bow = [40, 0, 3], side = [-10, 12, -5] }}
        [[constraints]]
        type = "vessel"
        name = "course"
        marker = "ship"
        heading = "{heading} deg"
        [constraints.rao]
        headings = [{}]
        omegas = {:?}
        amplitude = {}
        lag = {}
        "#,
        number(&sea["h"]),
        list(&case["reference"]),
        headings.join(", "),
        list(&rao["omegas"]),
        rao["amp"],
        rao["lag_deg"],
        heading = number(&case["heading_deg"]),
    )
}

type M3 = [[f64; 3]; 3];

fn product(a: &M3, b: &M3) -> M3 {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum()))
}

fn times(a: &M3, x: &[f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| (0..3).map(|k| a[i][k] * x[k]).sum())
}

fn cross(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// `x` with `m x = b`, by elimination.
fn solved(mut m: Vec<Vec<f64>>, mut b: Vec<f64>) -> Vec<f64> {
    let n = b.len();
    for k in 0..n {
        let pivot = (k..n).max_by(|i, j| m[*i][k].abs().total_cmp(&m[*j][k].abs())).expect("a row");
        m.swap(k, pivot);
        b.swap(k, pivot);
        for i in (0..n).filter(|i| *i != k) {
            let factor = m[i][k] / m[k][k];
            for j in k..n {
                m[i][j] -= factor * m[k][j];
            }
            b[i] -= factor * b[k];
        }
    }
    (0..n).map(|k| b[k] / m[k][k]).collect()
}

/// Pose from the six motions, and velocity and acceleration as the constraint asks for them.
fn moving(model: &Model, case: &Value, t: f64, dof: &[f64]) -> (M3, [f64; 3], Vec<f64>, Vec<f64>) {
    let heading = number(&case["heading_deg"]).to_radians();
    let about = |axis: usize, angle: f64| -> M3 {
        let (s, c) = angle.sin_cos();
        let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
        let mut r = [[0.0; 3]; 3];
        (r[axis][axis], r[i][i], r[j][j], r[i][j], r[j][i]) = (1.0, c, c, -s, s);
        r
    };
    let [roll, pitch, yaw] = [3, 4, 5].map(|k| dof[k].to_radians());
    let turn = product(&product(&about(2, heading + yaw), &about(1, pitch)), &about(0, roll));
    let moved = times(&about(2, heading), &[dof[0], dof[1], dof[2]]);
    let reference = list(&case["reference"]);
    let x: [f64; 3] = std::array::from_fn(|i| reference[i] + moved[i]);
    // unit quaternion of a rotation by less than half a turn
    let w = 0.5 * (1.0 + turn[0][0] + turn[1][1] + turn[2][2]).sqrt();
    let of = |i: usize, j: usize| (turn[i][j] - turn[j][i]) / (4.0 * w);
    let q = [x.to_vec(), vec![w, of(2, 1), of(0, 2), of(1, 0)]].concat();
    let course = model.constraints().iter().find(|c| c.name() == "course").expect("a course");
    let (nodes, mut v) = (model.nodes(), vec![0.0; 6]);
    let (mut g, mut jacobian, mut rate, mut bias) = ([0.0; 6], [0.0; 36], [0.0; 6], [0.0; 6]);
    let zero = [0.0; 6];
    let at = At { t, q: &q, v: &v, a: &zero, internal: &[], relaxed: None };
    course.jacobian(nodes, &at, &mut g, &mut jacobian);
    assert!(g.iter().all(|g| g.abs() < 1e-11), "{g:?}");
    course.rates(nodes, &at, &mut rate, &mut bias);
    let matrix: Vec<Vec<f64>> = jacobian.chunks(6).map(<[f64]>::to_vec).collect();
    v = solved(matrix.clone(), rate.iter().map(|x| -x).collect());
    let at = At { t, q: &q, v: &v, a: &zero, internal: &[], relaxed: None };
    course.rates(nodes, &at, &mut rate, &mut bias);
    let a = solved(matrix, bias.iter().map(|x| -x).collect());
    (turn, x, v, a)
}

#[test]
fn points_of_a_vessel_move_as_in_the_reference() {
    for case in read("vessel_rao")["cases"].as_array().expect("cases") {
        let model = scene(&vessel(&case["case"], "")).build().expect("a model");
        for row in case["rows"].as_array().expect("rows") {
            let (turn, x, v, a) = moving(&model, &case["case"], number(&row["t"]), &list(&row["dof"]));
            let (omega, alpha) = ([v[3], v[4], v[5]], [a[3], a[4], a[5]]);
            let points = case["case"]["points"].as_array().expect("points").iter();
            for (point, found) in points.zip(row["points"].as_array().expect("points")) {
                let s = <[f64; 3]>::try_from(list(point)).expect("a point");
                let swing = cross(&omega, &s);
                let centripetal = cross(&omega, &swing);
                let turned = cross(&alpha, &s);
                let arm = times(&turn, &s);
                let speed = times(&turn, &swing);
                let push = times(&turn, &[0, 1, 2].map(|i| turned[i] + centripetal[i]));
                for i in 0..3 {
                    assert!((x[i] + arm[i] - list(&found["x"])[i]).abs() < 1e-8);
                    assert!((v[i] + speed[i] - list(&found["v"])[i]).abs() < 1e-8);
                    // the reference has accelerations by differences
                    assert!((a[i] + push[i] - list(&found["a"])[i]).abs() < 3e-8);
                }
            }
        }
    }
}

/// In a run the body is where the constraint has it, and what moves it gives it its energy.
#[test]
fn a_body_follows_its_course() {
    let case = &read("vessel_rao")["cases"][1]["case"];
    // where the ramp ends the power jumps: what the audit's trapezoidal rule misses there goes with the step
    let solver = "[solver]\nscheme = \"radau-iia-5\"\nstepping = { controlled = { tolerance = 1e-8 } }\nh_max = \"1 ms\"";
    let text = vessel(case, solver).replace("components", "ramp = 20\n        components")
        + "[[records]]\ntype = \"position\"\nof = \"ship.bow\"\n[[records]]\ntype = \"energy\"\n";
    let h = run(&text);
    let model = scene(&text).build().expect("a model");
    assert!(h.warnings.is_empty(), "{:?}", h.warnings);
    let largest = |name: &str| {
        let column = h.column(name).expect("energy");
        column.iter().fold(0.0_f64, |most, x| if x.abs() <= most { most } else { x.abs() })
    };
    let (imbalance, most) = (largest("energy.imbalance"), largest("energy.kinetic"));
    println!("imbalance {imbalance:.1e} J of {most:.1e} J");
    assert!(imbalance < 1e-5 * most);
    assert_eq!(model.multipliers(), 6);
}

#[test]
fn a_table_moves_a_vessel() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("six.csv");
    let mut rows = String::from("t [s],heave [m],pitch [deg]\n");
    for k in 0..=200 {
        let t = 0.25 * f64::from(k);
        let rise = 0.5 * (1.0 - (0.4 * t).cos());
        let _ = writeln!(rows, "{t},{:e},{:e}", 2.0 * rise, 3.0 * rise);
    }
    std::fs::write(&path, rows).expect("written");
    let text = |file: &str| {
        format!(
            "[run]\nduration = 40\noutput = 1\n{BODY}\nposition = [5, 0, 0]\npoints = {{ bow = [40, 0, 0] }}\n\
             [[constraints]]\ntype = \"vessel\"\nname = \"course\"\nmarker = \"ship\"\n{file}\n\
             [[records]]\ntype = \"position\"\nof = \"ship.bow\"\n"
        )
    };
    let h = run(&text(&format!("file = {:?}", path.display().to_string())));
    let z = h.column("ship.bow.z").expect("a column");
    for (k, t) in h.times().iter().enumerate() {
        let rise = 0.5 * (1.0 - (0.4 * t).cos());
        let wanted = 2.0 * rise - 40.0 * (3.0 * rise).to_radians().sin();
        assert!((z[k] - wanted).abs() < 2e-4, "{t}: {} {wanted}", z[k]);
    }
    for (file, said) in [
        ("", "needs a `rao`, or a `file`"),
        ("file = \"nowhere.csv\"", "can't read nowhere.csv"),
        (
            "rao = { headings = [0], omegas = [1], amplitude = [[[1, 0, 0, 0, 0, 0]]], lag = [[[0, 0, 0, 0, 0, 0]]] }",
            "the scene has none",
        ),
        ("rao = { headings = [0], omegas = [1, 0.5], amplitude = [], lag = [] }", "ascend"),
        (
            "rao = { headings = [0], omegas = [1], amplitude = [], lag = [] }",
            "needs a row for each of 1 headings",
        ),
    ] {
        let error = refused(&text(file));
        assert!(error.contains(said), "{said}: {error}");
    }
}

/// What a table of responses doesn't reach, and what lies below the water, is told.
#[test]
fn seas_beyond_a_table_and_parts_below_the_bed_are_told() {
    let text = |omegas: &str, depth: f64| {
        format!(
            r#"
            run = {{ duration = 2, output = 1 }}
            [water]
            level = 0
            waves = {{ jonswap = {{ hs = 3, tp = 6 }}, depth = {depth}, ramp = 2 }}
            {BODY}
            position = [0, 0, 0]
            hull = {{ from = [-20, 0, -12], to = [20, 0, -12], diameter = 6 }}
            [[constraints]]
            type = "vessel"
            name = "course"
            marker = "ship"
            [constraints.rao]
            headings = [0]
            omegas = {omegas}
            amplitude = [[[0, 0, 1, 0, 0, 0], [0, 0, 1, 0, 0, 0]]]
            lag = [[[0, 0, 0, 0, 0, 0], [0, 0, 0, 0, 0, 0]]]
            [[forces]]
            type = "drag"
            "#
        )
    };
    let told = |omegas: &str, depth: f64, what: &str| {
        let warnings = run(&text(omegas, depth)).warnings;
        warnings.iter().any(|w| w.contains(what))
    };
    let beyond = "`course` has responses to waves of 13.96 to 15.71 s, and 100 % of the energy";
    assert!(told("[0.4, 0.45]", 40.0, beyond) && !told("[0.3, 4.5]", 40.0, "has responses to waves"));
    let below = "`ship` reaches down to 12.000 m under the surface, and the water is 10 m deep";
    assert!(told("[0.3, 4.5]", 10.0, below) && !told("[0.3, 4.5]", 40.0, "reaches down"));
    // also of what sinks there later
    let sinks = r#"
        run = { duration = 4, output = 1 }
        [water]
        level = 0
        waves = { regular = { height = 1, period = 6 }, depth = 30 }
        [[elements]]
        type = "rigid_body"
        name = "block"
        position = [0, 0, -10]
        mass = 1000
        inertia = [10, 10, 10]
        hull = { from = [-1, 0, 0], to = [1, 0, 0], diameter = 0.1 }
        [[forces]]
        type = "gravity"
        [[forces]]
        type = "drag"
        "#;
    let said = run(sinks).warnings.into_iter().filter(|w| w.contains("`block` reaches down")).count();
    assert_eq!(said, 1);
}
