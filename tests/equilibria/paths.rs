//! Which equilibrium a path of loads leads to: buckling, limit points, guesses that are far off.

use crate::common::{data, number, size};
use ropewalk::scene::Format;
use ropewalk::studies::run::CriticalLoad;
use ropewalk::{Error, History, SceneFile, simulate};
use ropewalk_core::V3;
use ropewalk_core::statics::{CriticalKind, Statics, StaticsOptions};

/// Runs a scene with other parameters.
pub(crate) fn run(text: &str, set: &[String]) -> Result<History, Error> {
    let file = SceneFile::parse(text, "test", Format::Toml, set).unwrap_or_else(|e| panic!("{e}"));
    simulate(file.scene())
}

pub(crate) fn set(all: &[(&str, f64)]) -> Vec<String> {
    all.iter().map(|(name, value)| format!("{name}={value:e}")).collect()
}

pub(crate) fn tip(h: &History, part: &str) -> [f64; 3] {
    ["x", "y", "z"].map(|c| h.last(&format!("{part}.end.{c}")).expect("recorded"))
}

/// A round column of EI = 1 and length 1, clamped at its foot. `MORE` holds further loads.
pub(crate) const COLUMN: &str = r#"
[parameters]
load = -2.4
side = 0.0
steps = 10
[run]
analysis = "statics"
[statics]
steps = "$steps"
[water]
[[elements]]
type = "cable"
name = "column"
points = [[0, 0, 0], [0, 0, 1]]
elements = 16
section = { mass = 1, ea = 1e8, ei = 1, diameter = 0.01 }
[[constraints]]
type = "spherical"
name = "root"
marker = "column.start"
[[constraints]]
type = "direction"
name = "clamp"
marker = "column.start"
[[records]]
type = "position"
of = "column.end"
"#;

/// Both loads grow.
const PRESSED: &str = r#"
[[forces]]
type = "point_force"
marker = "column.end"
force = ["$side", 0, "$load"]
time = { table = { t = [0, 1], value = [0, 1] } }
"#;

/// Tip of a clamped, inextensible column of EI = L = 1 under `p` along it and `side` across: lateral and axial place.
fn elastica(p: f64, side: f64) -> [f64; 2] {
    let shoot = |alpha: f64| {
        let n = 2000;
        let (h, mut y) = (1.0 / f64::from(n), [alpha, 0.0, 0.0, 0.0]);
        let f = |y: &[f64; 4]| [y[1], -p * y[0].sin() - side * y[0].cos(), y[0].sin(), y[0].cos()];
        for _ in 0..n {
            let ahead = |k: &[f64; 4], h: f64| std::array::from_fn(|i| y[i] + h * k[i]);
            let a = f(&y);
            let b = f(&ahead(&a, 0.5 * h));
            let c = f(&ahead(&b, 0.5 * h));
            let d = f(&ahead(&c, h));
            y = std::array::from_fn(|i| y[i] + h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]));
        }
        y
    };
    // straight columns below the critical load have no other root
    let (mut low, mut high) = (1e-12, std::f64::consts::PI);
    if shoot(low)[0] >= 0.0 {
        return [0.0, 1.0];
    }
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if shoot(middle)[0] < 0.0 { low = middle } else { high = middle }
    }
    let [_, _, x, z] = shoot(low);
    [x, z]
}

#[test]
fn the_shooting_agrees_with_the_tabulated_elastica() {
    for case in data("control.json").as_array().expect("cases") {
        let get = |k: &str| number(&case[k]);
        let (p, side) = match case["case"].as_str() {
            Some("column_clamped_free_by_load") => (get("P_EI_L2"), 0.0),
            Some("column_clamped_free_imperfect") => (get("P"), get("S")),
            _ => continue,
        };
        let [x, z] = elastica(p, side);
        assert!((x - get("tip_lateral")).abs() < 1e-6 && (z - get("tip_axial")).abs() < 1e-6, "{case}");
    }
}

const CRITICAL: f64 = 2.467_401_100_272_339_5;

/// Checks a column's tip, however it leans.
fn check(h: &History, p: f64, side: f64, what: &str) {
    let ([x, y, z], [lateral, axial]) = (tip(h, "column"), elastica(p, side));
    let off = (x.hypot(y) - lateral).hypot(z - axial);
    println!(
        "{what}: lateral {:.5}, off by {off:.1e}, {} iterations",
        x.hypot(y),
        h.counts.newton_iterations
    );
    // next to the critical load the amplitude answers to the mesh's own critical load
    let near = if (p / CRITICAL - 1.0).abs() < 0.01 { 2e-2 } else { 2e-3 };
    assert!(off <= near, "{what}: {x} {y} {z}, not {lateral} {axial}");
    if side != 0.0 && lateral > 1e-4 {
        assert!(y.abs() <= 1e-3 * lateral && x * side > 0.0, "{what}: leans to {x} {y}");
    }
}

#[test]
fn columns_buckle_whatever_the_steps() {
    let scene = format!("{COLUMN}{PRESSED}");
    for (p, sides) in [
        (1.0, [0.0, 1e-6]),
        (2.4, [0.0, 1e-6]),
        (2.5, [0.0, 1e-6]),
        (2.6, [0.0, 1e-6]),
        (3.0, [1e-6, 1e-2]),
        (5.0, [0.0, 1e-6]),
        (10.0, [1e-6, 1e-4]),
    ] {
        for side in sides.map(|s| s * p) {
            for steps in [1, 5, 20, 100] {
                let what = format!("load {p}, side {side:e}, {steps} steps");
                let h = run(&scene, &set(&[("load", -p), ("side", side), ("steps", f64::from(steps))]));
                let h = h.unwrap_or_else(|e| panic!("{what}: {e}"));
                check(&h, p, side, &what);
                let expected = usize::from(side == 0.0 && p > CRITICAL);
                assert_eq!(h.critical.len(), expected, "{what}: {:?}", h.critical);
                for c in &h.critical {
                    let CriticalLoad { load_factor, kind, directions, .. } = c;
                    assert!((load_factor * p / CRITICAL - 1.0).abs() < 1e-4, "{what}: {c:?}");
                    assert_eq!((*kind, *directions), (CriticalKind::Bifurcation, 2), "{what}: {c:?}");
                }
            }
        }
    }
}

/// In directions of no axis rounding bends the straight path towards the one that branches off: the critical load was lost, and the
/// run failed.
#[test]
fn columns_buckle_in_whatever_direction_they_stand() {
    let mut first = None;
    for [x, y, z] in
        [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [1e-3, 0.0, 1.0], [0.37, 0.31, 0.88], [-0.6, 0.2, 0.5]]
    {
        let length = size([x, y, z]);
        let way: V3<f64> = [x / length, y / length, z / length];
        let force = way.map(|x| -3.0 * x);
        let text = format!(
            r#"
            gravity = [0, 0, 0]
            [[elements]]
            type = "cable"
            name = "c"
            points = [[0, 0, 0], {way:?}]
            elements = 16
            section = {{ mass = 1, ea = 1e6, ei = 1 }}
            [[constraints]]
            type = "clamp"
            name = "s"
            marker = "c.start"
            [[forces]]
            type = "point_force"
            marker = "c.end"
            force = {force:?}
            time = {{ table = {{ t = [0, 2], value = [0, 2] }} }}
            "#
        );
        let file = SceneFile::parse(&text, "column", Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}"));
        let model = file.build().expect("model");
        let mut state = model.state();
        let mut statics = Statics::new(&model, &StaticsOptions::default()).expect("memory");
        statics.find(&mut state, true).unwrap_or_else(|e| panic!("{e}"));
        for step in 1..=12 {
            statics.follow(&mut state, 0.1 * f64::from(step)).unwrap_or_else(|e| panic!("{way:?}: {e}"));
        }
        let loads: Vec<f64> = statics.critical().iter().map(|c| c.t).collect();
        let end = model.parts()[0].point(1.0, &state.at()).expect("its end").0;
        let along: f64 = (0..3).map(|i| end[i] * way[i]).sum();
        let aside = size(std::array::from_fn(|i| end[i] - along * way[i]));
        println!("{way:?}: {loads:?}, end at {along} along and {aside} aside");
        // clamped and free: π²/4 EI/l²
        let exact = std::f64::consts::PI.powi(2) / 12.0;
        assert!(loads.len() == 1 && (loads[0] / exact - 1.0).abs() < 2e-5, "{loads:?}");
        let [one, two] = *first.get_or_insert([along, aside]);
        assert!((along - one).abs() < 1e-6 && (aside - two).abs() < 1e-6);
    }
}

#[test]
fn columns_buckle_among_loads_on_stations_too() {
    let side = "[[forces]]\ntype = \"point_force\"\nmarker = \"column.end\"\nforce = [\"$side\", 0, 0]\n";
    let load = PRESSED.replace("\"$side\"", "0");
    for (more, what) in [
        ("[[forces]]\ntype = \"drag\"\n", "drag"),
        ("[[forces]]\ntype = \"line_load\"\nforce = [0, 0, 1e-9]\n", "line load"),
    ] {
        let scene = format!("{COLUMN}{load}{side}{more}");
        for (p, side) in [(2.4, 2.4e-6), (2.6, 2.6e-6), (5.0, 5e-6), (8.0, 0.0)] {
            let what = format!("{what}, load {p}");
            let h = run(&scene, &set(&[("load", -p), ("side", side)]));
            check(&h.unwrap_or_else(|e| panic!("{what}: {e}")), p, side, &what);
        }
    }
}

#[test]
fn a_heavy_column_buckles_at_greenhills_load() {
    let load = "[[forces]]\ntype = \"line_load\"\nforce = [0, 0, \"$load\"]\n\
                time = { table = { t = [0, 1], value = [0, 1] } }\n";
    let h = run(&format!("{COLUMN}{load}"), &set(&[("load", -10.0)])).unwrap_or_else(|e| panic!("{e}"));
    println!("{:?}", h.critical);
    assert_eq!(h.critical.len(), 1);
    let c = &h.critical[0];
    assert!((c.load_factor * 10.0 / 7.837_347_438_943_48 - 1.0).abs() < 1e-4);
    assert_eq!((c.kind, c.directions), (CriticalKind::Bifurcation, 2));
    assert!(tip(&h, "column")[2] < 0.9);
}

/// Two bars of EA = 1 that lean against each other, pressed down where they meet.
const TRUSS: &str = r#"
[parameters]
load = -0.06
steps = 10
stiffness = 0.8944271909999159
[run]
analysis = "statics"
[statics]
steps = "$steps"
[[elements]]
type = "point_mass"
name = "top"
marker = [0, 0, 0.5]
mass = 1
[[constraints]]
type = "coordinate"
name = "x"
marker = "top"
direction = [1, 0, 0]
[[constraints]]
type = "coordinate"
name = "y"
marker = "top"
direction = [0, 1, 0]
[[forces]]
type = "spring"
name = "left"
marker = [-1, 0, 0]
to = "top"
stiffness = "$stiffness"
[[forces]]
type = "spring"
name = "right"
marker = [1, 0, 0]
to = "top"
stiffness = "$stiffness"
[[forces]]
type = "point_force"
marker = "top"
force = [0, 0, "$load"]
time = { table = { t = [0, 1], value = [0, 1] } }
[[records]]
type = "position"
of = "top"
"#;

#[test]
fn the_truss_of_von_mises_snaps_through_at_its_limit_load() {
    let all = data("control.json");
    let reference = all.as_array().expect("cases").iter().find(|c| {
        c["case"] == "von_mises_truss" && number(&c["height"]) == 0.5 && number(&c["half_span"]) == 1.0
    });
    let reference = reference.expect("truss");
    let limit = number(&reference["limit_P_over_EA"]);
    for steps in [1, 3, 10, 40, 200] {
        let h = run(TRUSS, &set(&[("steps", f64::from(steps))])).unwrap_or_else(|e| panic!("{steps}: {e}"));
        println!("{steps} steps: {:?}, {} iterations", h.critical, h.counts.newton_iterations);
        assert_eq!(h.critical.len(), 1, "{steps} steps: {:?}", h.critical);
        let c = &h.critical[0];
        assert_eq!((c.kind, c.directions), (CriticalKind::Limit, 1));
        assert!((c.load_factor * 0.06 / limit - 1.0).abs() < 1e-6, "{c:?}");
        // hangs below its supports: 2 EA (l - l₀)/l₀ z/l = P
        let z = -h.last("top.z").expect("recorded");
        let (l, rest) = (z.hypot(1.0), 1.25f64.sqrt());
        assert!(z > 0.5 && (2.0 * (l - rest) / rest * z / l - 0.06).abs() < 1e-9, "{z}");
    }
}

/// A chain on a flat floor, laid straight from the anchor to the fairlead.
const LAID: &str = r#"
[parameters]
x = 118
elements = 200
[run]
analysis = "statics"
[statics]
steps = 1
[[elements]]
type = "cable"
name = "chain"
points = [[0, 0, 0], ["$x", 0, 40]]
length = 130
elements = "$elements"
section = { mass = 30, ea = 2e8, diameter = 0.1 }
[[constraints]]
type = "spherical"
name = "anchor"
marker = "chain.start"
[[constraints]]
type = "spherical"
name = "fairlead"
marker = "chain.end"
[[forces]]
type = "gravity"
[[forces]]
type = "contact"
name = "floor"
shape = { plane = {} }
marker = [0, 0, -0.05]
stiffness_per_length = 1e7
overlap = "allow"
[[records]]
type = "reaction"
of = "fairlead"
"#;

/// Horizontal force and vertical force at the fairlead of an inextensible chain that lies on the floor and rises by `z`:
/// `z = a (cosh u - 1)`, `l = a sinh u`, `x = length - l + a u`.
fn laid(x: f64, z: f64, length: f64, weight: f64) -> [f64; 2] {
    let shape = |u: f64| {
        let a = z / (u.cosh() - 1.0);
        (a, a * u.sinh(), length - a * u.sinh() + a * u)
    };
    let (mut low, mut high) = (1e-3, 20.0);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        // long arms reach farther
        if shape(middle).2 > x { low = middle } else { high = middle }
    }
    let (a, hanging, _) = shape(low);
    [weight * a, weight * hanging]
}

#[test]
fn a_chain_on_the_floor_is_found_from_a_straight_line() {
    for x in [100.0, 112.0, 118.0] {
        for elements in [50, 100, 200, 400] {
            let what = format!("x = {x}, {elements} elements");
            let h = run(LAID, &set(&[("x", x), ("elements", f64::from(elements))]));
            let h = h.unwrap_or_else(|e| panic!("{what}: {e}"));
            let pull = ["fx", "fz"].map(|c| h.last(&format!("fairlead.{c}")).expect("recorded"));
            let exact = laid(x, 40.0, 130.0, 30.0 * 9.81);
            println!("{what}: {pull:?}, {exact:?}, {} iterations", h.counts.newton_iterations);
            if exact[1] < 130.0 * 30.0 * 9.81 {
                for (got, exact) in pull.iter().zip(exact) {
                    assert!((got.abs() / exact - 1.0).abs() < 2e-2, "{what}: {pull:?}, not {exact:?}");
                }
            }
        }
    }
}

/// Lee's frame, two beams of length L at a right angle with a load at a fifth of the upper one, leads past the same limit point
/// whatever its size: 120 km, 1.2 m, 1.2 mm.
#[test]
fn a_frame_of_any_size_follows_the_same_path() {
    let found = [1.2e5, 1.2, 1.2e-3].map(|l| {
        // what bends is as 1/1200 of the length to what stretches, the load in EI/L²
        let (ea, ei) = (4.32e9, 4.32e9 * l * l / 4.32e4);
        let load = 1e6 * 120.0 * 120.0 / (l * l) * ei / 1.44e9;
        let beam = |name: &str, from: [f64; 3], to: [f64; 3]| {
            format!(
                r#"
                [[elements]]
                type = "cable"
                name = "{name}"
                points = [{from:?}, {to:?}]
                elements = 10
                section = {{ mass = 1e-6, ea = {ea:e}, ei = [{ei:e}, {:e}], gj = {:e} }}
                normal = [0, 1, 0]
                "#,
                100.0 * ei,
                100.0 * ei
            )
        };
        let text = format!(
            r#"
            gravity = [0, 0, 0]
            run = {{ analysis = "statics", duration = 4 }}
            statics = {{ steps = 40 }}
            {}
            {}
            [[constraints]]
            type = "weld"
            name = "w"
            marker = "b.start"
            to = "c.end"
            [[constraints]]
            type = "revolute"
            name = "l"
            marker = "c.start"
            axis = [0, 1, 0]
            [[constraints]]
            type = "revolute"
            name = "r"
            marker = "b.end"
            axis = [0, 1, 0]
            [[forces]]
            type = "point_force"
            marker = "b@20%"
            force = [0, 0, {}]
            time = {{ table = {{ t = [0, 100], value = [0, 100] }} }}
            [[records]]
            type = "position"
            of = "b@20%"
            "#,
            beam("c", [0.0; 3], [0.0, 0.0, l]),
            beam("b", [0.0, 0.0, l], [l, 0.0, l]),
            -load
        );
        let h = run(&text, &[]).unwrap_or_else(|e| panic!("{l} m: {e}"));
        assert_eq!(h.critical.len(), 1, "{l} m: {:?}", h.critical);
        assert_eq!(h.critical[0].kind, CriticalKind::Limit);
        let [x, z] = ["b@20%.x", "b@20%.z"].map(|name| h.last(name).expect("recorded") / l);
        [h.critical[0].load_factor, x, z]
    });
    println!("{found:?}");
    for other in &found[1..] {
        for (a, b) in found[0].iter().zip(other) {
            assert!((a - b).abs() < 1e-6, "{found:?}");
        }
    }
}
