//! Equilibria against references: cantilevers of every variant, catenaries from bad guesses, tows; what is no equilibrium.

use crate::common::{cantilever, data, hose, law, models, number, place, reaction, size, towed};
use ropewalk_constraints::SphericalSpec;
use ropewalk_core::statics::{Found, Statics, StaticsOptions};
use ropewalk_core::{BuildError, V3};
use ropewalk_core::{Model, State, SteadyFrame};
use ropewalk_elements::{CableSpec, Section};
use ropewalk_forces::{DragLaw, DragSpec, FunctionSpec, GravitySpec};
use ropewalk_scene::functions::{Function, Parameters, Reads, Seen, Trouble, Written, register_function};
use ropewalk_scene::{Format, Scene, SceneFile, Water};
use std::sync::Arc;

/// Follows the load factor from 0 to 1 in equal steps.
fn follow(model: &Model, steps: usize) -> (State, Vec<Found>) {
    let mut statics = Statics::new(model, &StaticsOptions::default()).expect("statics");
    let mut state = model.state();
    let mut found = Vec::new();
    for k in 1..=steps {
        state.t = k as f64 / steps as f64;
        found.push(statics.find(&mut state, k == 1).unwrap_or_else(|e| panic!("step {k}: {e}")));
    }
    (state, found)
}

#[test]
fn cantilever_reproduces_the_tabulated_error_of_every_variant() {
    let all = data("cantilever.json");
    let mut worst: f64 = 0.0;
    for (case, c) in all.as_object().expect("cases") {
        if number(&c["EA"]) > 1e6 {
            continue;
        }
        let exact = number(&c["elastica_ext"][1]);
        for (variant, rows) in c["rows"].as_object().expect("rows") {
            let Some(m) = models(variant) else { continue };
            for n in [4, 8, 16, 32, 64] {
                let Some(tip) = rows[n.to_string()].as_array() else { continue };
                let model = cantilever(n, number(&c["EA"]), number(&c["F"]), m).build().expect("model");
                let (state, _) = follow(&model, 10);
                let y = place(&model, &state, "beam", 1.0)[1];
                let (error, tabulated) = ((y - exact) / exact, (number(&tip[1]) - exact) / exact);
                let off = (error - tabulated).abs();
                worst = worst.max(off);
                assert!(
                    off <= (0.02 * tabulated.abs()).max(1e-9),
                    "{case} {variant} n={n}: {error:e} {tabulated:e}"
                );
            }
        }
    }
    println!("largest difference from the table: {worst:.1e}");
}

#[test]
fn newton_needs_few_iterations_however_stiff_the_cable() {
    let (mut most, mut mean_most) = (0, 0.0f64);
    for force in [3.0, 10.0] {
        for ea in [1.6e5, 1e8, 1e12] {
            for n in [4, 16, 64, 256] {
                for variant in ["L2+T1", "L4(lob3)+T3(2)", "L4+T3", "L3(lob3)+T2(2)", "L1+T1", "L3+T1"] {
                    // few elements of the full rule lock so hard that the plane shape is unstable out of its plane
                    let locks = variant.starts_with("L4+") || variant.starts_with("L3+");
                    if locks && n < 16 && ea > 1e8 {
                        continue;
                    }
                    let m = models(variant).expect("variant");
                    let model = cantilever(n, ea, force, m).build().expect("model");
                    let (state, found) = follow(&model, 10);
                    let iterations: Vec<u32> = found.iter().map(|f| f.iterations).collect();
                    let mean = f64::from(iterations.iter().sum::<u32>()) / 10.0;
                    let max = *iterations.iter().max().expect("ten");
                    println!("{force} {ea:.0e} {n} {variant}: mean {mean} max {max}");
                    most = most.max(max);
                    mean_most = mean_most.max(mean);
                    if n >= 64 {
                        let exact = if force == 3.0 { 0.603_253_44 } else { 0.810_609_02 };
                        let y = place(&model, &state, "beam", 1.0)[1];
                        assert!((y - exact).abs() < 3e-2 * exact, "{variant} n={n} EA={ea:e}: {y}");
                    }
                    assert!(mean <= 6.0 && max <= 8, "{variant} n={n} EA={ea:e} F={force}: {iterations:?}");
                }
            }
        }
    }
    println!("mean at most {mean_most}, never above {most}");
}

/// A cable between two supports, from a straight line or from a folded guess.
fn hung(n: usize, length: f64, to: [f64; 3], section: Section, folded: bool) -> Scene {
    let mut spec = CableSpec::straight("cable", [0.0; 3], to, n, section).unstretched(length);
    if folded {
        let (x, up) = (to[0], 0.2 * length);
        spec.points = vec![[0.0; 3], [0.8 * x, 0.0, up], [0.2 * x, 0.0, up + 0.1 * length], to];
        spec.radius = Some(1e-3 * length);
    }
    let mut scene = Scene::new();
    scene
        .element(spec)
        .constraint(SphericalSpec::pin("left", "cable.start"))
        .constraint(SphericalSpec::pin("right", "cable.end"))
        .set_gravity([0.0, 0.0, -9.81])
        .force(GravitySpec::default());
    scene
}

fn equilibrium(scene: &Scene) -> (Model, State, Found) {
    let model = scene.build().expect("model");
    let mut state = model.state();
    let mut statics = Statics::new(&model, &StaticsOptions::default()).expect("statics");
    let found = statics.find(&mut state, true).unwrap_or_else(|e| panic!("{e}"));
    (model, state, found)
}

/// A slope that points backwards strains none of the points at which an element is asked, if a third of its length is missing:
/// an equilibrium of the equations, and of no cable.
#[test]
fn a_search_leaves_what_is_folded_inside_elements() {
    for (turned, back) in [(7, false), (0, false), (19, true), (3, true)] {
        let model =
            hung(20, 12.0, [10.0, 0.0, -1.0], Section::new(2.0, 1e5, 0.0), false).build().expect("model");
        let mut statics = Statics::new(&model, &StaticsOptions::default()).expect("statics");
        let mut sound = model.state();
        statics.find(&mut sound, true).unwrap_or_else(|e| panic!("{e}"));
        let mut state = sound.clone();
        let seats = model.part("cable").expect("cable").seats();
        let seat = |k: usize| seats[k].0;
        if back {
            // a chord of a third of its length backwards, both slopes as they were
            let chord: [f64; 3] =
                std::array::from_fn(|i| sound.q[seat(turned + 1) + i] - sound.q[seat(turned) + i]);
            for k in turned + 1..seats.len() - 1 {
                (0..3).for_each(|i| state.q[seat(k) + i] -= 4.0 / 3.0 * chord[i]);
            }
            if turned + 2 == seats.len() {
                (0..3).for_each(|i| state.q[seat(turned) + i] += 4.0 / 3.0 * chord[i]);
            }
        } else {
            (3..6).for_each(|i| state.q[seat(turned) + i] *= -1.0);
        }
        for cold in [false, true] {
            let mut state = state.clone();
            let found =
                statics.find(&mut state, cold).unwrap_or_else(|e| panic!("{turned} {back} {cold}: {e}"));
            let off = state.q.iter().zip(&sound.q).map(|(a, b)| (a - b).abs());
            let worst = off.fold(0.0_f64, |m, x| if x <= m { m } else { x });
            println!("{turned} {back} {cold}: {worst:e} {found:?}");
            assert!(state.q.iter().zip(&sound.q).all(|(a, b)| (a - b).abs() <= 1e-7));
        }
    }
}

#[test]
fn elastic_catenaries_of_irvine_from_straight_and_folded_guesses() {
    // L0, span, h, EA; H, tension at the upper support, midpoint
    let cases = [
        (
            120.0,
            100.0,
            0.0,
            1e6,
            917.361_173_808_266_9,
            1_492.431_359_631_283_4,
            [50.0, 29.345_723_024_618_58],
        ),
        (
            200.0,
            60.0,
            30.0,
            1e6,
            197.292_849_656_625_38,
            2_265.841_642_033_317_4,
            [19.522_507_056, 97.515_591_647],
        ),
        (99.9, 100.0, 0.0, 1e6, 5_761.496_855_494_502, 5_844.252_155_428_788, [50.0, 4.242_381_169_952_421]),
        (100.0, 100.0, 10.0, 5e3, 799.739_129_465, 1_345.559_948_982, [48.119_363_481, 33.411_213_367]),
    ];
    for (length, span, h, ea, horizontal, tension, [x, drop]) in cases {
        for folded in [false, true] {
            let section = Section::new(2.0, ea, 0.0);
            let (model, state, found) = equilibrium(&hung(80, length, [span, 0.0, -h], section, folded));
            let (r, mid) = (reaction(&model, &state, "left"), place(&model, &state, "cable", 0.5 * length));
            println!("L0 {length} folded {folded}: {found:?}");
            println!(
                "   H {:.1e} T {:.1e} x {:.1e} drop {:.1e}",
                r[0].abs() / horizontal - 1.0,
                size(r) / tension - 1.0,
                mid[0] - x,
                -mid[2] - drop
            );
            assert!((r[0].abs() / horizontal - 1.0).abs() < 1e-4, "L0 {length}, folded {folded}: {r:?}");
            assert!((size(r) / tension - 1.0).abs() < 1e-4, "L0 {length}, folded {folded}: {r:?}");
            assert!((mid[0] - x).abs() < 1e-3 && (mid[2] + drop).abs() < 1e-3, "L0 {length}: {mid:?}");
        }
    }
}

#[test]
fn catenaries_of_the_reference_have_its_shape_and_tension() {
    for c in data("catenary.json")["cases"].as_array().expect("cases") {
        let get = |k: &str| number(&c[k]);
        for folded in [false, true] {
            let section = Section::new(get("w") / 9.81, get("EA"), 0.0);
            // its bend has a radius of 3 mm
            let n = if c["name"] == "vertical_like" { 1000 } else { 100 };
            let scene = hung(n, get("L0"), [get("l"), 0.0, get("h")], section, folded);
            let (model, state, _) = equilibrium(&scene);
            let r = reaction(&model, &state, "left");
            let h_off = (r[0].abs() - get("H")) / get("T1").max(get("T0"));
            let mut worst = 0.0f64;
            for row in c["rows"].as_array().expect("rows") {
                let (s, x, z) = (number(&row[0]), number(&row[1]), number(&row[2]));
                let p = place(&model, &state, "cable", s);
                let off = ((p[0] - x).powi(2) + (p[2] - z).powi(2)).sqrt() / get("L0");
                worst = if off.is_nan() { f64::INFINITY } else { worst.max(off) };
            }
            println!("{} folded {folded}: shape {worst:.1e} of the length, H {h_off:.1e}", c["name"]);
            assert!(worst < 1e-4 && h_off.abs() < 1e-4, "{} folded {folded}: {worst:e} {h_off:e}", c["name"]);
            let t0 = (size(r) - get("T0")) / get("T0");
            assert!(t0.abs() < 1e-4, "{}: {t0:e}", c["name"]);
        }
    }
}

#[test]
fn a_cable_that_stands_on_its_end_is_no_equilibrium() {
    // exactly upright nothing tips it over, with a symmetric tangent and, in a current along it, without
    for current in [0.0, -0.3] {
        let section = Section { diameter: 0.02, ..Section::new(0.6, 1e5, 1.0) };
        let mut scene = Scene::new();
        scene.water = Some(Water { current: [0.0, 0.0, current].map(Into::into), ..Water::default() });
        scene
            .element(CableSpec::straight("cable", [0.0; 3], [0.0, 0.0, 10.0], 12, section))
            .constraint(SphericalSpec::pin("pin", "cable.start"))
            .force(GravitySpec::default());
        if current != 0.0 {
            scene.force(DragSpec::default());
        }
        let (model, state, found) = equilibrium(&scene);
        let end = place(&model, &state, "cable", 10.0);
        println!("current {current}: {found:?}, end {end:?}");
        assert!(end[2] < -9.9, "{end:?}");
    }
}

#[test]
fn without_load_there_is_nothing_to_find_and_nothing_unstable() {
    // drag makes the tangent unsymmetric; neither weight nor current gives a characteristic time
    let section = Section { diameter: 0.02, ..Section::new(0.6, 1e5, 1.0) };
    let mut scene = Scene::new();
    scene.water = Some(Water::default());
    scene
        .element(CableSpec::straight("cable", [0.0; 3], [0.0, 0.0, 10.0], 12, section))
        .constraint(SphericalSpec::pin("pin", "cable.start"))
        .constraint(SphericalSpec::pin("other", "cable.end"))
        .force(DragSpec::default());
    let (model, state, found) = equilibrium(&scene);
    assert_eq!(found.flutter, 0.0);
    assert!((place(&model, &state, "cable", 5.0)[2] - 5.0).abs() < 1e-9);
}

/// A force along the velocity, `c v` [N s/m]: it takes energy with a negative `c`, and brings it with a positive one.
#[derive(Clone, Debug)]
struct AlongVelocity(f64);

impl Function for AlongVelocity {
    fn reads(&self) -> Reads {
        Reads { velocity: true, ..Reads::default() }
    }
    fn force(&self, _t: f64, at: &Seen) -> Result<[V3<f64>; 2], Trouble> {
        Ok([at.velocity.map(|v| self.0 * v), [0.0; 3]])
    }
}

impl Written for AlongVelocity {
    fn bind(&self, _: &Parameters) -> Result<Arc<dyn Function>, BuildError> {
        Ok(Arc::new(self.clone()))
    }
}

#[test]
fn what_brings_energy_by_velocity_flutters_though_its_potential_is_least() {
    // pushed more it doesn't swing any more, and grows one way only
    for (name, c, flutters) in [
        ("brakes", -3.0, false),
        ("barely_pushes", 1e-4, false),
        ("pushes", 1.0, true),
        ("pushes_more", 3.0, true),
        ("pushes_hard", 20.0, true),
    ] {
        register_function(name, Arc::new(AlongVelocity(c)));
        let mut scene = Scene::new();
        scene
            .element(CableSpec::straight(
                "cable",
                [0.0; 3],
                [0.0, 0.0, -10.0],
                12,
                Section::new(0.6, 1e5, 1.0),
            ))
            .constraint(SphericalSpec::pin("pin", "cable.start"))
            .force(GravitySpec::default())
            .force(FunctionSpec {
                function: name.into(),
                name: None,
                marker: Some("cable.end".into()),
                on: Vec::new(),
                parameters: Parameters::default(),
            });
        let (_, _, found) = equilibrium(&scene);
        println!("{name}: {found:?}");
        assert_eq!(found.flutter > 0.0, flutters, "{name}: {}", found.flutter);
    }
}

/// A weight on a spring that is pushed along its velocity: the roots of `m λ² - c λ + k` say how fast it gets away, to and fro or
/// one way.
#[test]
fn what_velocities_feed_grows_by_the_roots_of_its_equation() {
    let (m, k) = (2.0, 50.0);
    for c in [2.0, 15.0, 30.0, 400.0, 6000.0_f64] {
        let name = format!("drives_{c}");
        register_function(&name, Arc::new(AlongVelocity(c)));
        let text = format!(
            r#"
            [run]
            duration = 1
            [[elements]]
            type = "rigid_body"
            name = "weight"
            position = [0, 0, 0]
            mass = {m}
            inertia = [0.1, 0.1, 0.1]
            [[constraints]]
            type = "prismatic"
            name = "guide"
            marker = "weight"
            axis = [0, 0, 1]
            [[forces]]
            type = "spring"
            name = "spring"
            marker = "weight"
            to = [0, 0, 2]
            stiffness = {k}
            [[forces]]
            type = "gravity"
            [[forces]]
            type = "function"
            function = "{name}"
            marker = "weight"
            "#
        );
        let file = SceneFile::parse(&text, "pushed", Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}"));
        let (_, state, found) = equilibrium(file.scene());
        let root = (0.25 * c * c - m * k).max(0.0).sqrt();
        let exact = (0.5 * c + root) / m;
        println!("{c}: {} 1/s, {exact} 1/s, at {}", found.flutter, state.q[2]);
        // the size of what swings tells its growth by so much
        assert!((found.flutter / exact - 1.0).abs() <= 0.05, "{c}: {} {exact}", found.flutter);
        assert!((state.q[2] + m * 9.81 / k).abs() < 1e-6);
    }
}

#[test]
fn straight_tow_is_one_relative_equilibrium() {
    for c in data("tow_straight.json")["free_end"].as_array().expect("cases") {
        let mut scene = towed([0.0; 3], [-29.9, 0.0, -2.0], 20, hose(1e9, 1e-6), law(&c["model"]));
        scene.constraint(SphericalSpec::pin("tow", "hose.start"));
        let model = scene.build().expect("model");
        let frame = SteadyFrame { velocity: [number(&c["U"]), 0.0, 0.0], omega: [0.0; 3], centre: [0.0; 3] };
        let mut statics =
            Statics::relative(&model, &StaticsOptions::default(), Some(frame)).expect("statics");
        let mut state = model.state();
        let found = statics.find(&mut state, true).unwrap_or_else(|e| panic!("{c}: {e}"));
        let (end, r) = (place(&model, &state, "hose", 30.0), reaction(&model, &state, "tow"));
        let (height, tension) = (end[2] - number(&c["end_height"]), size(r) / number(&c["T_top"]) - 1.0);
        println!("{} {} kn: height {height:.1e}, tension {tension:.1e}, {found:?}", c["model"], c["kn"]);
        assert!(
            height.abs() < 1e-4 && tension.abs() < 1e-3,
            "{} {} kn: {height:e} {tension:e}",
            c["model"],
            c["kn"]
        );
    }
}

#[test]
fn turning_tow_is_one_relative_equilibrium() {
    for c in data("tow_turn.json")["cases"].as_array().expect("cases") {
        let Some(exact) = c["solutions"].get(0) else { continue };
        let radius = number(&c["R"]);
        let mut scene =
            towed([radius, 0.0, 0.0], [radius, -29.5, -5.0], 20, hose(1e9, 1e-6), law(&c["model"]));
        scene.constraint(SphericalSpec::pin("tow", "hose.start"));
        let model = scene.build().expect("model");
        let frame =
            SteadyFrame { velocity: [0.0; 3], omega: [0.0, 0.0, number(&c["Omega"])], centre: [0.0; 3] };
        let mut statics =
            Statics::relative(&model, &StaticsOptions::default(), Some(frame)).expect("statics");
        let mut state = model.state();
        let found = statics.find(&mut state, true).unwrap_or_else(|e| panic!("{}: {e}", c["kn"]));
        let (end, r) = (place(&model, &state, "hose", 30.0), reaction(&model, &state, "tow"));
        let (height, tension) =
            (end[2] - number(&exact["end_height"]), size(r) / number(&exact["T_top"]) - 1.0);
        println!("turn {} kn: height {height:.1e}, tension {tension:.1e}, {found:?}", c["kn"]);
        assert!(height.abs() < 1e-3 && tension.abs() < 1e-3, "{} kn: {height:e} {tension:e}", c["kn"]);
    }
}

#[test]
fn what_stiffness_changes_in_a_steady_turn() {
    // the reference is inextensible and limp; the default hose is neither
    let c = &data("tow_turn.json")["cases"][2];
    let exact = number(&c["solutions"][0]["end_height"]);
    let height = |ea: f64, ei: f64| {
        let radius = number(&c["R"]);
        let mut scene = towed([radius, 0.0, 0.0], [radius, -29.5, -5.0], 40, hose(ea, ei), DragLaw::Constant);
        scene.constraint(SphericalSpec::pin("tow", "hose.start"));
        let model = scene.build().expect("model");
        let frame = SteadyFrame { omega: [0.0, 0.0, number(&c["Omega"])], ..SteadyFrame::default() };
        let mut statics =
            Statics::relative(&model, &StaticsOptions::default(), Some(frame)).expect("statics");
        let mut state = model.state();
        statics.find(&mut state, true).unwrap_or_else(|e| panic!("{e}"));
        place(&model, &state, "hose", 30.0)[2]
    };
    let limp = height(1e9, 1e-6);
    let (stretches, bends, both) =
        (height(1e6, 1e-6) - limp, height(1e9, 2.0) - limp, height(1e6, 2.0) - limp);
    println!("25 kn: EA {stretches:.2e} m, EI {bends:.2e} m, both {both:.2e} m of {limp:.4} m");
    assert!((limp - exact).abs() < 1e-3);
    assert!((both - stretches - bends).abs() < 0.2 * both.abs(), "{both:e} {stretches:e} {bends:e}");
}

/// A body that is free to spin about its own axis, which isn't that of its equilibrium: tangents are singular on the way.
#[test]
fn bodies_that_may_spin_come_to_rest_from_any_attitude() {
    let find = |text: &str| {
        let file = SceneFile::parse(text, "scene.toml", Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}"));
        let model = file.build().expect("model");
        let mut state = model.state();
        let mut statics = Statics::new(&model, &StaticsOptions::default()).expect("memory");
        statics.find(&mut state, true).unwrap_or_else(|e| panic!("{e}\n{text}"));
        let named = statics.neutral().iter().any(|n| n.what.contains("`b` turns about the axis (0"));
        (state, named)
    };
    // a bob on a ball joint hangs down
    for angle in [3.09, 2.6, 2.0, 0.4] {
        let text = format!(
            r#"
            [[elements]]
            type = "rigid_body"
            name = "b"
            position = [0, 0, 0]
            angles = [0, {angle}, 0]
            mass = 1
            centre = [0, 0, 1]
            inertia = [0.1, 0.1, 0.01]
            [[constraints]]
            type = "spherical"
            name = "pin"
            marker = "b"
            [[forces]]
            type = "gravity"
            "#
        );
        let (state, named) = find(&text);
        // the centre is where its third axis points
        let [w, x, y, z] = [3, 4, 5, 6].map(|i| state.q[i]);
        let axis = [2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)];
        println!("{angle}: {axis:?}, {named}");
        assert!(size([axis[0], axis[1], axis[2] + 1.0]) < 1e-6 && named, "{angle}: {axis:?}");
    }
    // a buoy on a line in a current, where a soft spring against its spin hardly matters
    let buoy = |spring: &str| {
        format!(
            r#"
            [water]
            current = [0.5, 0, 0]
            [[elements]]
            type = "cable"
            name = "l"
            points = [[0, 0, -50], [0, 0, -2]]
            elements = 12
            length = 48
            section = {{ mass = 2, ea = 1e6, ei = 0, diameter = 0.03 }}
            [[elements]]
            type = "rigid_body"
            name = "b"
            position = [0, 0, -2]
            mass = 200
            centre = [0, 0, 0.4]
            inertia = [20, 20, 15]
            volume = 0.4
            centre_of_volume = [0, 0, 0.6]
            drag_area = 0.5
            [[constraints]]
            type = "spherical"
            name = "a"
            marker = "l.start"
            [[constraints]]
            type = "spherical"
            name = "t"
            marker = "b"
            to = "l.end"
            [[forces]]
            type = "gravity"
            [[forces]]
            type = "buoyancy"
            [[forces]]
            type = "drag"
            {spring}
            "#
        )
    };
    let ((free, named), (held, _)) = (find(&buoy("")), find(&buoy(SPRING)));
    let off = (0..free.q.len()).map(|i| (free.q[i] - held.q[i]).abs()).fold(0.0, f64::max);
    println!("{off:.1e} {named}");
    assert!(off < 1e-6 && named);
}

/// Holds the buoy against spinning, and nothing else to speak of.
const SPRING: &str = r#"
    [[forces]]
    type = "bushing"
    name = "yaw"
    marker = "b"
    rotational_stiffness = [0, 0, 1e-3]
    "#;
