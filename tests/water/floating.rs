//! What floats against `tests/data/sea/floating.json`: draughts, stiffness and periods in closed form, and large oscillations of
//! hoses by integration of their own equation.

use ropewalk::scene::Format;
use ropewalk::{History, ModesOptions, SceneFile, modes, simulate};
use serde_json::Value;
use std::f64::consts::PI;

fn scene(text: &str) -> SceneFile {
    SceneFile::parse(text, "floating", Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}"))
}

fn run(text: &str) -> History {
    simulate(scene(text).scene()).unwrap_or_else(|e| panic!("{e}"))
}

fn reference() -> Value {
    serde_json::from_str(include_str!("../data/sea/floating.json")).expect("JSON")
}

fn number(v: &Value) -> f64 {
    v.as_f64().unwrap_or_else(|| panic!("{v} is no number"))
}

/// Where it stays at rest, and its longest period of small oscillations.
fn settled(body: &str, guide: &str) -> (f64, f64) {
    let statics = format!("[run]\nanalysis = \"statics\"\n{body}{guide}");
    let z = run(&statics).last("it.z").expect("a row");
    let there =
        scene(&format!("{body}{guide}").replace("position = [0, 0, 0]", &format!("position = [0, 0, {z}]")));
    let options = ModesOptions { count: 1, ..ModesOptions::default() };
    let found = modes(there.scene(), &options).unwrap_or_else(|e| panic!("{e}"));
    (z, 1.0 / found.modes[0].frequency())
}

const UPWARDS: &str = r#"
    [[constraints]]
    type = "prismatic"
    name = "guide"
    marker = "it"
    axis = [0, 0, 1]
    to = [0, 0, 0]
    "#;

/// A metre of a hose that lies in the water; `added` is a mass that moves with it and weighs nothing.
fn hose(case: &Value, z: f64, more: &str) -> String {
    let [radius, mass, density, g] = ["R", "m", "rho", "g"].map(|k| number(&case[k]));
    let added = number(&case["Ca_constant"]) * density * PI * radius * radius;
    format!(
        r#"
        {more}
        [[elements]]
        type = "rigid_body"
        name = "it"
        position = [0, 0, {z}]
        mass = {}
        inertia = [20, 300, 300]
        hull = {{ from = [-0.5, 0, 0], to = [0.5, 0, 0], diameter = {} }}
        volume = {}
        [water]
        density = {density}
        level = 0
        [[forces]]
        type = "gravity"
        [[forces]]
        type = "buoyancy"
        [[forces]]
        type = "point_force"
        marker = "it"
        force = [0, 0, {}]
        [[records]]
        type = "position"
        of = "it"
        "#,
        mass + added,
        2.0 * radius,
        PI * radius * radius,
        added * g,
    )
}

#[test]
fn hoses_float_and_swing_far_as_their_equation_says() {
    for case in reference()["hoses"].as_array().expect("hoses") {
        let (z, period) = settled(&hose(case, 0.0, ""), UPWARDS);
        let (depth, small) = (number(&case["axis_depth"]), number(&case["small_period"]));
        println!("axis {:.2e} m off, small period {:.1e}", z + depth, period / small - 1.0);
        assert!((z + depth).abs() < 1e-6 && (period / small - 1.0).abs() < 1e-5);
        for large in case["large"].as_array().expect("large") {
            let [from, lowest, period] = ["released_at", "lowest", "period"].map(|k| number(&large[k]));
            let steps = "[run]\nduration = 5\noutput = 0.002\n[solver]\nstepping = { controlled = { tolerance = 1e-6 } }\n";
            let h = run(&format!("{}{UPWARDS}", hose(case, from - depth, steps)));
            let (t, z) = (h.times(), h.column("it.z").expect("column"));
            let low = z.iter().fold(f64::INFINITY, |m, z| m.min(z + depth));
            // upwards through the middle, twice
            let up: Vec<f64> = (1..t.len())
                .filter(|&k| z[k - 1] < -depth && z[k] >= -depth)
                .map(|k| t[k - 1] + (t[k] - t[k - 1]) * (-depth - z[k - 1]) / (z[k] - z[k - 1]))
                .collect();
            // of the slow ones half a period: how long it is below
            let found = match up[..] {
                [a, b, ..] => b - a,
                _ => panic!("{up:?}"),
            };
            println!("from {from}: lowest {low:.6} for {lowest:.6}, period {found:.6} for {period:.6}");
            assert!((low / lowest - 1.0).abs() < 1e-3 && (found / period - 1.0).abs() < 1e-3);
        }
    }
}

/// An upright spar whose centre of mass is `kg` above its keel; a load hangs on it and a spring holds it.
fn spar(case: &Value, [mass, inertia]: [f64; 2], lift: f64) -> String {
    let of = |k: &str| number(&case[k]);
    let (d, density) = (of("D"), of("rho"));
    // its origin is its centre of mass
    let (keel, top) = (-of("KG"), 200.0);
    format!(
        r#"
        [[elements]]
        type = "rigid_body"
        name = "it"
        position = [0, 0, 0]
        mass = {mass}
        inertia = [{inertia}, {inertia}, {inertia}]
        hull = {{ from = [0, 0, {keel}], to = [0, 0, {top}], diameter = {d} }}
        volume = {}
        [water]
        density = {density}
        level = 0
        [[forces]]
        type = "gravity"
        [[forces]]
        type = "buoyancy"
        [[forces]]
        type = "point_force"
        marker = "it"
        force = [0, 0, {lift}]
        [[records]]
        type = "position"
        of = "it"
        "#,
        0.25 * PI * d * d * (top - keel),
    )
}

#[test]
fn spars_heave_and_pitch_by_their_waterplane_and_metacentre() {
    for spars in reference()["spars"].as_array().expect("spars") {
        let case = &spars["case"];
        let of = |k: &str| number(&case[k]);
        let [mass, added, stiffness, pull, g] = ["m", "a33", "Km", "V0", "g"].map(of);
        let right = |k: &str| number(&spars[k]);
        // the added mass moves with it and weighs nothing; a spring about the place where it floats has no force there
        let draught = right("draft");
        let body = spar(case, [mass + added, 1e6], added * g - pull);
        let spring = format!(
            "[[forces]]\ntype = \"bushing\"\nname = \"mooring\"\nmarker = \"it\"\nto = [0, 0, {}]\nstiffness = [0, 0, {stiffness}]\n",
            of("KG") - draught
        );
        let spring = if stiffness > 0.0 { spring } else { String::new() };
        let (z, period) = settled(&format!("{body}{spring}"), UPWARDS);
        let found = of("KG") - z;
        println!("draught {found:.9} for {draught:.9}, heave {period:.6} for {:.6}", right("heave_period"));
        assert!((found / draught - 1.0).abs() < 1e-6 && (period / right("heave_period") - 1.0).abs() < 1e-5);
        if let Some(pitch) = spars["pitch_period"].as_f64() {
            let about = r#"
            [[constraints]]
            type = "revolute"
            name = "guide"
            marker = "it"
            axis = [0, 1, 0]
            to = [0, 0, Z]
            "#
            .replace('Z', &z.to_string());
            let text = spar(case, [mass, of("I55") + of("a55")], 0.0)
                .replace("position = [0, 0, 0]", &format!("position = [0, 0, {z}]"));
            let options = ModesOptions { count: 1, ..ModesOptions::default() };
            let found =
                modes(scene(&format!("{text}{about}")).scene(), &options).unwrap_or_else(|e| panic!("{e}"));
            let period = 1.0 / found.modes[0].frequency();
            println!("pitch {period:.6} for {pitch:.6}");
            assert!((period / pitch - 1.0).abs() < 1e-4);
        }
    }
}

#[test]
fn a_ball_floats_and_heaves_by_its_waterplane() {
    for case in reference()["spheres"].as_array().expect("spheres") {
        let of = |k: &str| number(&case[k]);
        let body = format!(
            r#"
            [[elements]]
            type = "point_mass"
            name = "it"
            marker = [0, 0, 0]
            mass = {}
            volume = {}
            [water]
            density = {}
            level = 0
            [[forces]]
            type = "gravity"
            [[forces]]
            type = "buoyancy"
            [[records]]
            type = "position"
            of = "it"
            "#,
            of("m"),
            4.0 / 3.0 * PI * of("R").powi(3),
            of("rho"),
        );
        let guide = "[[constraints]]\ntype = \"point_on_line\"\nname = \"guide\"\nmarker = \"it\"\naxis = [0, 0, 1]\nto = [0, 0, 0]\n";
        let z = run(&format!("[run]\nanalysis = \"statics\"\n{body}{guide}")).last("it.z").expect("a row");
        let there =
            scene(&format!("{body}{guide}").replace("marker = [0, 0, 0]", &format!("marker = [0, 0, {z}]")));
        let options = ModesOptions { count: 1, ..ModesOptions::default() };
        let found = modes(there.scene(), &options).unwrap_or_else(|e| panic!("{e}"));
        let period = 1.0 / found.modes[0].frequency();
        println!("centre {z:.9} for {:.9}, period {period:.6}", -of("centre_depth"));
        assert!((z + of("centre_depth")).abs() < 1e-6);
        assert!((period / of("heave_period_no_added_mass") - 1.0).abs() < 1e-5);
    }
}

/// A cylinder whose centre of mass is above its metacentre heels until `GM + BM tan²φ/2 = 0`, by the formula of wall-sided ships: from
/// upright, where it lies in balance, and from a little beside.
#[test]
fn a_float_without_upright_stability_heels() {
    let (diameter, draught): (f64, f64) = (1.3, 0.5);
    let bm = diameter * diameter / (16.0 * draught);
    let gm = 0.5 * draught + bm - 0.5;
    let heel = (-2.0 * gm / bm).sqrt().atan();
    for start in [0.0, 0.05] {
        let h = run(&format!(
            r#"
            [run]
            analysis = "statics"
            [water]
            density = 1000
            level = 0
            [[elements]]
            type = "rigid_body"
            name = "it"
            position = [0, 0, 0]
            angles = [0, {start}, 0]
            mass = {mass}
            volume = {volume}
            inertia = [125.4, 125.4, 140.2]
            hull = {{ from = [0, 0, -0.5], to = [0, 0, 0.5], diameter = {diameter} }}
            [[constraints]]
            type = "coordinate"
            name = "x"
            marker = "it"
            direction = [1, 0, 0]
            [[constraints]]
            type = "coordinate"
            name = "y"
            marker = "it"
            direction = [0, 1, 0]
            [[constraints]]
            type = "perpendicular"
            name = "yaw"
            marker = "it"
            axis = [0, 1, 0]
            axis_to = [1, 0, 0]
            [[constraints]]
            type = "perpendicular"
            name = "roll"
            marker = "it"
            axis = [0, 1, 0]
            axis_to = [0, 0, 1]
            [[forces]]
            type = "gravity"
            [[forces]]
            type = "buoyancy"
            [[records]]
            type = "orientation"
            of = "it"
            "#,
            mass = 1000.0 * PI / 4.0 * diameter * diameter * draught,
            volume = PI / 4.0 * diameter * diameter,
        ));
        let found = h.last("it.phi2").expect("a row");
        assert!((found.abs() - heel).abs() < 1e-4, "from {start}: {found} instead of {heel}");
    }
}
