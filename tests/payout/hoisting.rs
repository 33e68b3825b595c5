//! A rope that is wound in while it vibrates across itself, against the exact solution of the wave equation over a boundary that
//! moves.

use super::reeving::{at, run};
use super::winch::{go, steadily};
use crate::common::{data, number};
use ropewalk_constraints::{DrivingSpec, SphericalSpec, WinchSpec};
use ropewalk_core::integrator::Options;
use ropewalk_core::{Part, Simulation, State};
use ropewalk_elements::{CableSpec, Section};
use ropewalk_scene::Scene;

/// Places along the rope between which its energy across itself is summed.
const PLACES: usize = 400;

/// How many times higher than in the reference the rope is deflected: its tolerance is in parts of its length, and the equation
/// linear.
const HIGHER: f64 = 50.0;

/// Energy across itself [J] and the deflection in the middle [m] of a rope under this tension, with this mass per length.
fn across(rope: &dyn Part, state: &State, tension: f64, mass: f64) -> [f64; 2] {
    let mesh = rope.line().expect("a line").mesh_now(&state.at());
    let (from, to) = (mesh[0], mesh[mesh.len() - 1]);
    let at = |k: f64| rope.point(from + (to - from) * k / PLACES as f64, &state.at()).expect("a point");
    let energy = (0..PLACES).map(|k| {
        let [(a, _), (_, v), (b, _)] = [0.0, 0.5, 1.0].map(|x| at(k as f64 + x));
        let (dx, slope) = (b[0] - a[0], (b[1] - a[1]) / (b[0] - a[0]));
        0.5 * (mass * v[1] * v[1] + tension * slope * slope) * dx
    });
    [energy.sum(), at(0.5 * PLACES as f64).0[1]]
}

/// The derivative of values on an even grid, of fourth order.
fn derivative(y: &[f64], h: f64) -> Vec<f64> {
    let last = y.len() - 1;
    let forward = |i: usize, s: f64, y: &dyn Fn(usize) -> f64| {
        s * (-25.0 * y(i) + 48.0 * y(i + 1) - 36.0 * y(i + 2) + 16.0 * y(i + 3) - 3.0 * y(i + 4)) / (12.0 * h)
    };
    let one = |i: usize, s: f64, y: &dyn Fn(usize) -> f64| {
        s * (-3.0 * y(i - 1) - 10.0 * y(i) + 18.0 * y(i + 1) - 6.0 * y(i + 2) + y(i + 3)) / (12.0 * h)
    };
    let (there, back) = (|i: usize| y[i], |i: usize| y[last - i]);
    (0..=last)
        .map(|i| match (i, last - i) {
            (0, _) => forward(0, 1.0, &there),
            (1, _) => one(1, 1.0, &there),
            (_, 0) => forward(0, -1.0, &back),
            (_, 1) => one(1, -1.0, &back),
            _ => (y[i - 2] - 8.0 * y[i - 1] + 8.0 * y[i + 1] - y[i + 2]) / (12.0 * h),
        })
        .collect()
}

#[test]
fn energy_across_a_hoisted_rope_grows_as_it_becomes_shorter() {
    let data = data("reeving/hoist_string.json");
    let list = |group: &str, name: &str| -> Vec<f64> {
        serde_json::from_value(data[group][name].clone()).unwrap_or_else(|e| panic!("{name}: {e}"))
    };
    let [c, v, l0] = ["wave_speed", "v", "l0"].map(|k| number(&data["parameters"][k]));
    let [y, rate] = ["y0", "yt0"].map(|name| list("parameters", name));
    let elements = y.len() - 1;
    let (mass, stretch) = (1.0, 1.3);
    let tension = mass * c * c;
    let ea = tension / (stretch - 1.0);
    let mut scene = Scene::new();
    scene
        .element(
            CableSpec {
                velocity: [v, 0.0, 0.0],
                ..CableSpec::straight(
                    "rope",
                    [0.0; 3],
                    [l0, 0.0, 0.0],
                    elements,
                    Section::new(mass * stretch, ea, 0.0),
                )
            }
            .unstretched(l0 / stretch),
        )
        .constraint(SphericalSpec::new("eyelet", "rope.start", [0.0; 3]))
        .constraint(WinchSpec::motion("winch", "rope.start", "in"))
        .constraint(DrivingSpec::new("load", "rope.end", "up"))
        .motion(steadily("in", v / stretch))
        .motion(steadily("up", v));
    let model = scene.build().unwrap_or_else(|e| panic!("{e}"));
    let rope = model.part("rope").expect("rope").clone();
    let mut state = model.state();
    // the table counts from the end whose material stays
    let flip = |y: &[f64]| y.iter().rev().map(|y| HIGHER * y).collect::<Vec<f64>>();
    let (y, rate, seats) = (flip(&y), flip(&rate), rope.seats());
    let grid = l0 / elements as f64;
    let slopes = derivative(&y, grid);
    // of the nodes, which the material runs past
    let rates: Vec<f64> = (0..=elements).map(|k| rate[k] + (state.v[seats[k].1] - v) * slopes[k]).collect();
    let turns = derivative(&rates, grid);
    for (k, &(q, i)) in seats.iter().enumerate() {
        (state.q[q + 1], state.q[q + 4]) = (y[k], stretch * slopes[k]);
        (state.v[i + 1], state.v[i + 4]) = (rates[k], stretch * turns[k]);
    }
    let mut s = Simulation::from(model, state, &Options::default(), 3.0).unwrap_or_else(|e| panic!("{e}"));
    let mut first = None;
    let reference = list("reference", "t").into_iter().zip(list("reference", "energy_ratio"));
    for ((t, ratio), middle) in reference.zip(list("reference", "y_mid")) {
        go(&mut s, t);
        let [energy, y] = across(s.model.part("rope").expect("rope").as_ref(), &s.state, tension, mass);
        let y = y / HIGHER;
        let first = *first.get_or_insert(energy);
        println!("{t}: energy {:.5} for {ratio:.5}, middle {y:.6} for {middle:.6}", energy / first);
        assert!((energy / first / ratio - 1.0).abs() <= 0.005, "{t}: {} for {ratio}", energy / first);
        assert!((y - middle).abs() <= 0.02 * 1e-3, "{t}: {y} for {middle}");
    }
}

/// Velocity and acceleration at a place are those of the material there, wherever the mesh goes meanwhile.
#[test]
fn records_along_a_rope_that_is_paid_out_are_those_of_its_material() {
    let records = ["velocity", "acceleration"].map(|kind| {
        ["4m", "50%", "7m"].map(|at| format!("[[records]]\ntype = \"{kind}\"\nof = \"rope@{at}\"\n")).concat()
    });
    let scene = format!(
        r#"
        gravity = [0, 0, 0]
        run = {{ duration = 1, output = 0.25 }}
        [[elements]]
        type = "cable"
        name = "rope"
        points = [[0, 0, 0], [0, 0, -10]]
        elements = 5
        section = {{ mass = 1, ea = 1e8, axial_retardation_time = 1e-3 }}
        [[constraints]]
        type = "spherical"
        name = "eye"
        marker = "rope.start"
        [[constraints]]
        type = "winch"
        name = "winch"
        marker = "rope.start"
        motion = "out"
        [[motions]]
        type = "speed_table"
        name = "out"
        t = [0, 1]
        v = [0, 2]
        {}
        "#,
        records.concat()
    );
    let history = run(&scene);
    for t in [0.25, 0.5, 0.75] {
        for at_rope in ["4m", "50%", "7m"] {
            let [v, a] = ["vz", "az"].map(|what| at(&history, &format!("rope@{at_rope}.{what}"), t));
            assert!(
                (v + 2.0 * t).abs() < 1e-3 && (a + 2.0).abs() < 0.02,
                "{at_rope} at {t} s: {v} m/s, {a} m/s²"
            );
        }
    }
}
