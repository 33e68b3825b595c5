//! A process in a scene: the bundled `unwinding-paper`, and what is wrong with others.

use ropewalk::scene::Format;
use ropewalk::{SceneFile, Session, Watch, bundled, simulate};

fn open(overrides: &[&str]) -> SceneFile {
    let overrides: Vec<String> = overrides.iter().map(ToString::to_string).collect();
    SceneFile::open("unwinding-paper", &overrides, bundled()).unwrap()
}

#[test]
fn the_bundled_scene_unwinds() {
    let file = open(&["speed=15 kn", "duration=0.2 s", "elements=20"]);
    let history = simulate(file.scene()).unwrap();
    assert!(history.stopped_by.is_none());
    let last = |name: &str| history.last(name).unwrap();
    let speed = 15.0 * 1852.0 / 3600.0;
    assert!((last("cable.speed.drawn") / speed - 1.0).abs() < 1e-12);
    // what the scene prescribes at the eyelet
    assert!((last("cable.tension.eyelet") - (0.02 + 0.0227 * speed * speed)).abs() < 1e-9);
    assert!(last("cable.tension.lift") < last("cable.tension.eyelet"));
    // what was drawn has been peeled or has shortened the free cable
    let drawn = speed * (0.2 - 0.05);
    let free = history.column("cable.length.free").unwrap();
    assert!((last("cable.length.peeled") - drawn - (free[free.len() - 1] - free[0])).abs() < 1e-9);
    assert!(history.counts.steps >= 1000 && history.times().len() == 101);
    assert!((1.1..1.3).contains(&last("cable.drag.half")));
}

/// A bundled scene run with some parameters.
fn history(scene: &str, speed: &str, traverse: &str, more: &[&str]) -> ropewalk::History {
    let mut set = vec![format!("speed={speed}"), format!("traverse={traverse}")];
    set.extend(more.iter().map(ToString::to_string));
    let file = SceneFile::open(scene, &set, bundled()).unwrap_or_else(|e| panic!("{e}"));
    simulate(file.scene()).unwrap_or_else(|e| panic!("{scene} {set:?}: {e}"))
}

#[test]
fn predictions_at_25_knots_are_those_of_both_formulations_and_follow_the_trend() {
    let mut trend = Vec::new();
    for (traverse, more) in [("forward", "elements=16"), ("backward", "elements=24")] {
        for speed in ["15 kn", "25 kn"] {
            let elements = history("unwinding", speed, traverse, &["duration=0.3 s", more]);
            let paper = history("unwinding-paper", speed, traverse, &["duration=0.3 s"]);
            let of = |h: &ropewalk::History, name: &str| h.last(name).unwrap_or_else(|| panic!("no {name}"));
            let v = of(&paper, "cable.speed.drawn");
            let tension = [of(&elements, "eyelet.tension"), of(&paper, "cable.tension.eyelet")];
            let length = [of(&elements, "cable.length"), of(&paper, "cable.length.free")];
            let centre = |h: &ropewalk::History, x: &str, y: &str| of(h, x).hypot(of(h, y));
            let radius = [
                centre(&elements, "centre.x", "centre.y"),
                centre(&paper, "cable.centre.x", "cable.centre.y"),
            ];
            let middle = "cable.cn@50%";
            let cn = [of(&elements, middle), of(&paper, "cable.drag.half")];
            println!(
                "{speed} {traverse}: tension {tension:?}, length {length:?}, centre {radius:?}, Cn {cn:?}"
            );
            for ([a, b], scale) in [(tension, tension[1]), (length, length[1]), (radius, 0.06), (cn, cn[1])] {
                assert!((a - b).abs() < 0.01 * scale, "{speed} {traverse}: {a}, not {b}");
            }
            trend.push((traverse, v, length[0], tension[0]));
        }
    }
    // tension by the square of the speed keeps the shape, but for the drag coefficient, which still falls a little, and for
    // how far the lift-off point has walked
    for pair in trend.chunks(2) {
        let [(_, slow, short, low), (_, fast, long, high)] = pair else { panic!("pairs") };
        let similar = ((high - 0.02) / (low - 0.02)) / (fast / slow).powi(2);
        assert!((similar - 1.0).abs() < 0.01 && (long / short - 1.0).abs() < 0.03, "{trend:?}");
    }
}

/// The bundled scene as it is, against finite differences of which the limit was taken (`data/flow/lift_off.json`).
#[test]
fn lift_off_with_bending_stiffness_is_that_of_finite_differences() {
    let all = crate::common::data("flow/lift_off.json");
    for case in all["cases"].as_array().expect("cases") {
        let text = |key: &str| case[key].as_str().expect(key);
        let [tension, curvature, length] =
            ["tension", "curvature", "length"].map(|key| case[key].as_f64().expect(key));
        let (speed, traverse) = (text("speed"), text("traverse"));
        let h = history("unwinding", speed, traverse, &["rigidity=tangent"]);
        let last = |name: &str| h.last(name).unwrap_or_else(|| panic!("no {name}"));
        let found = [last("lift_off.tension"), last("lift_off.curvature"), last("cable.length")];
        println!("{speed} {traverse}: {found:?} for {tension} N, {curvature} 1/m, {length} m");
        assert!((found[0] / tension - 1.0).abs() < 0.02, "{speed} {traverse}: {found:?}");
        assert!((found[1] / curvature - 1.0).abs() < 0.01, "{speed} {traverse}: {found:?}");
        assert!((found[2] / length - 1.0).abs() < 0.005, "{speed} {traverse}: {found:?}");
        assert!(!h.warnings.iter().any(|w| w.contains("√(EI/T)")), "{:?}", h.warnings);
        let knots: f64 = speed.trim_end_matches(" kn").parse().expect("a speed");
        let given = 0.02 + 0.0227 * (knots * 1852.0 / 3600.0).powi(2);
        let pull = last("eyelet.tension");
        assert!((pull / given - 1.0).abs() < 2e-3, "{speed} {traverse}: {pull} N for {given}");
    }
}

#[test]
fn a_mesh_that_misses_its_layer_is_named_with_the_one_that_would_do() {
    let set = ["rigidity=tangent", "duration=0.12 s"];
    let even = [&set[..], &["mesh={ elements = 16 }"]].concat();
    let h = history("unwinding", "15 kn", "forward", &even);
    let said = h.warnings.iter().find(|w| w.contains("√(EI/T)")).expect("a warning");
    assert!(said.contains("`cable`") && said.contains("at its end, held by `package`"), "{said}");
    let mesh = said.split('`').find(|s| s.starts_with("mesh = ")).expect(said);
    let mesh = mesh.replacen(" = ", "=", 1);
    let better = [&set[..], &[mesh.as_str()]].concat();
    let h = history("unwinding", "15 kn", "forward", &better);
    assert!(!h.warnings.iter().any(|w| w.contains("√(EI/T)")), "{:?}", h.warnings);
}

#[test]
fn a_coarse_stiff_cable_keeps_the_tension_of_its_eyelet() {
    let set = ["rigidity=tangent", "duration=0.2 s", "ea=13.7 kN", "mesh={ elements = 20 }"];
    let h = history("unwinding", "15 kn", "backward", &set);
    let given = 0.02 + 0.0227 * (15.0 * 1852.0 / 3600.0_f64).powi(2);
    let found = h.last("eyelet.tension").expect("tension");
    assert!((found / given - 1.0).abs() < 5e-3, "{found} N for {given}");
}

#[test]
fn steps_of_the_finite_differences_follow_their_mesh() {
    let set = ["rigidity=tangent", "duration=0.12 s", "elements=120"];
    let h = history("unwinding-paper", "15 kn", "forward", &set);
    let tension = h.column("cable.tension.lift").expect("tension");
    // it doesn't tremble from row to row, and is that of a coarser mesh but for the error of both
    let late = &tension[tension.len() - 6..];
    assert!(late.windows(2).all(|w| (w[1] - w[0]).abs() < 0.02), "{late:?}");
    assert!(h.counts.steps > 1500 && h.counts.rejected < 20, "{:?}", h.counts);
    let coarse = history("unwinding-paper", "15 kn", "forward", &[&set[..2], &["elements=60"]].concat());
    let difference = coarse.last("cable.tension.lift").expect("tension") - late[5];
    assert!((0.0..0.03).contains(&difference), "{difference}");

    let long = open(&["speed=15 kn", "rigidity=tangent", "elements=160", "h=0.2 ms", "duration=0.1 s"]);
    let refused = simulate(long.scene()).err().expect("too long a step").to_string();
    assert!(
        refused.contains("too long for 160 segments") && refused.contains("leave the step out"),
        "{refused}"
    );
}

#[test]
fn contact_with_an_outer_package_is_reported_where_it_is() {
    let set = ["side=outer", "traverse=backward", "duration=0.02 s"];
    let file = {
        let mut all = vec!["speed=5 kn".to_string()];
        all.extend(set.iter().map(ToString::to_string));
        SceneFile::open("unwinding", &all, bundled()).unwrap()
    };
    #[derive(Default)]
    struct Said(Vec<String>);
    impl ropewalk_core::Observer for Said {
        fn event(&mut self, name: &str, _: f64) {
            self.0.push(name.to_string());
        }
    }
    let scene = file.scene();
    let mut s = ropewalk_core::Simulation::new(scene.build().unwrap(), &scene.solver, 0.02).unwrap();
    let mut said = Said::default();
    s.advance(0.02, f64::INFINITY, &mut said).unwrap();
    let touches = said.0.iter().find(|s| s.contains("touches the package")).expect("a report");
    assert!(touches.contains("m deep at s = ") && touches.contains("from its start"), "{touches}");
}

#[test]
fn a_package_that_runs_empty_ends_the_run() {
    let file = open(&["layers=1", "length=2 mm", "elements=12", "duration=2 s", "h=1 ms"]);
    let history = simulate(file.scene()).unwrap();
    assert!(history.stopped_by.unwrap().contains("empty"));
    assert!(history.table.rows() > 100);
}

#[test]
fn what_is_wrong_is_said_with_its_place() {
    let scene = |of: &str| {
        format!(
            "title = \"x\"\n[run]\nduration = 0.01\n[[motions]]\ntype = \"rest\"\nname = \"draw\"\n[[processes]]\ntype = \
             \"unwound_cable\"\nname = \"c\"\nmass = 1e-3\nmotion = \"draw\"\nrule = {{ tension = {{ tension = 1 }} }}\n{of}"
        )
    };
    let package = "[processes.package]\nradius = 0.06\nlength = 0.1\ndiameter = 1e-3\norigin = [0, 0, 0.1]\n";
    let cases = [
        (scene(package), ""),
        (scene(&package.replace("radius = 0.06", "radius = -1")), "`radius` must be positive"),
        (scene(&format!("{package}pitch = 1e-4\n")), "below the diameter"),
        (scene(&format!("{package}min_bend_radius = 0.1\n")), "may not be bent"),
        (scene(package).replace("motion = \"draw\"", "motion = \"pull\""), "there is no motion `pull`"),
        (scene(&format!("tangent = true\n{package}")), "without bending stiffness"),
        (scene(&format!("elements = 2\n{package}")), "too few"),
        (scene(&format!("drag = {{}}\n{package}")), "[water] section"),
        (scene(&format!("h = 0\n{package}")), "`h` must be positive"),
        (
            scene(&format!(
                "{package}[[elements]]\ntype = \"point_mass\"\nname = \"m\"\nmass = 1\nmarker = [0, 0, 0]\n"
            )),
            "of its own",
        ),
    ];
    for (text, says) in cases {
        let built = SceneFile::parse(&text, "x", Format::Toml, &[]).and_then(|file| file.build());
        match built {
            Ok(_) => assert!(says.is_empty(), "{says}: {text}"),
            Err(fault) => {
                assert!(!says.is_empty() && fault.message.contains(says), "{says}: {fault}");
                assert!(fault.place.is_some(), "{fault}");
            }
        }
    }
}

/// A process whose cable is drawn at the speed of an input.
fn drawn(controllers: &str) -> SceneFile {
    let text = format!(
        r#"
        [run]
        duration = "50 ms"
        output = "10 ms"
        [[inputs]]
        name = "speed"
        unit = "m/s"
        max = 5
        join = "linear"
        {controllers}
        [[motions]]
        type = "input"
        name = "draw"
        speed = "speed"
        [[processes]]
        type = "unwound_cable"
        name = "c"
        mass = "1 g/m"
        motion = "draw"
        rule = {{ tension = {{ tension = "1 N" }} }}
        package = {{ radius = "60 mm", length = "0.1 m", diameter = "1 mm", origin = [0, 0, "0.1 m"] }}
        "#
    );
    SceneFile::parse(&text, "drawn", Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn a_process_reads_inputs_that_controllers_or_programs_set() {
    // each speed from the one that is seen: u' = u/2 + 0.1 m/s, reached an interval later
    let controller = r#"
        [[controllers]]
        type = "expression"
        input = "speed"
        value = "0.5 * c.speed.drawn + 0.1 m/s"
        every = "10 ms"
        "#;
    let file = drawn(controller);
    let history = simulate(file.scene()).unwrap_or_else(|e| panic!("{e}"));
    let speed = history.column("c.speed.drawn").expect("speed");
    let set = [0.1, 0.15, 0.175, 0.1875, 0.19375];
    assert_eq!(speed.len(), 6);
    for (k, (u, wanted)) in speed.iter().zip([0.0].iter().chain(&set)).enumerate() {
        assert!((u - wanted).abs() < 1e-12, "{k}: {u} {wanted}");
    }
    // the way is the integral of the speed, in straight pieces, and it is drawn off the package or the free cable
    let way: f64 = speed.windows(2).map(|u| 0.005 * (u[0] + u[1])).sum();
    let free = history.column("c.length.free").expect("free length");
    let peeled = history.last("c.length.peeled").expect("peeled");
    assert!((peeled - way - (free[5] - free[0])).abs() < 1e-9, "{peeled} {way}");

    // the same from outside, to the last bit
    let mut session = Session::start(drawn(""), Watch::default()).unwrap_or_else(|e| panic!("{e}"));
    for (k, u) in set.into_iter().enumerate() {
        session.set_input("speed", u).unwrap_or_else(|e| panic!("{e}"));
        session.advance((k + 1) as f64 * 0.01).unwrap_or_else(|e| panic!("{e}"));
        for name in ["c.speed.drawn", "c.length.free", "c.tension.lift"] {
            let there = history.column(name).expect(name)[k + 1];
            let off = (session.value(name).unwrap_or_else(|e| panic!("{e}")) - there).abs();
            assert!(off <= 1e-9 * there.abs(), "{name}: {off:e} of {there}");
        }
    }
    assert_eq!((session.t(), session.inputs().len()), (0.05, 1));
    assert!(session.counts().steps > 50 && session.simulation().is_none());
    // what can't be is said
    assert!(session.set_input("speed", 6.0).unwrap_err().to_string().contains("its limits are"));
    assert!(session.set_input("sped", 1.0).unwrap_err().to_string().contains("the inputs are `speed`"));
    assert!(session.snapshot().unwrap_err().to_string().contains("keeps no state"));
    let mut session = Session::start(file, Watch::default()).unwrap_or_else(|e| panic!("{e}"));
    assert!(
        session.set_input("speed", 1.0).unwrap_err().to_string().contains("set by the controller `speed`")
    );
    let wrong = drawn(&controller.replace("c.speed.drawn", "c.speed.draw")).build().err().expect("refused");
    assert!(wrong.to_string().contains("`c.speed.drawn`"), "{wrong}");
    let wrong = drawn(&controller.replace("0.5 *", "(0 / 0) *"));
    let history = simulate(wrong.scene());
    assert!(history.err().is_some_and(|e| e.to_string().contains("sets `speed` to what is no number")));
}
