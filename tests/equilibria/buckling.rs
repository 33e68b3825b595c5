//! How far loads may grow until an equilibrium gives way, against closed forms.

use crate::modes::{close, modal};
use ropewalk::{ModesOptions, modes, simulate};
use ropewalk_constraints::{DirectionSpec, PointOnLineSpec, SphericalSpec};
use ropewalk_core::modes::Mode;
use ropewalk_core::statics::CriticalKind;
use ropewalk_elements::{CableSpec, Section};
use ropewalk_forces::{GravitySpec, PointForceSpec, TimeFunction};
use ropewalk_scene::{Analysis, Format, Scene, SceneFile};
use std::f64::consts::{FRAC_PI_2, PI};
use std::fmt::Write;

/// A column of `EI = 1 N m²` and 1 m under a load, straight.
fn column(load: f64, foot: bool, head: [bool; 2]) -> Scene {
    let mut scene = Scene::new();
    scene
        .element(CableSpec::straight("column", [0.0; 3], [0.0, 0.0, 1.0], 32, Section::new(1.0, 1e8, 1.0)))
        .constraint(SphericalSpec::pin("foot", "column.start"));
    if foot {
        scene.constraint(DirectionSpec::new("foot-clamp", "column.start"));
    }
    let [guided, clamped] = head;
    if guided {
        scene.constraint(PointOnLineSpec {
            name: "head".into(),
            marker: "column.end".into(),
            to: None,
            axis: [0.0, 0.0, 1.0],
        });
    }
    if clamped {
        scene.constraint(DirectionSpec::new("head-clamp", "column.end"));
    }
    if load != 0.0 {
        scene.force(PointForceSpec::new("column.end", [0.0, 0.0, -load], TimeFunction::default()));
    }
    scene.run.analysis = Analysis::Statics;
    scene.statics.stable = false;
    scene
}

#[test]
fn columns_buckle_at_the_critical_factor_of_their_loads() {
    let cases = [
        ("clamped, free", true, [false, false], 0.25 * PI * PI),
        ("pinned", false, [true, false], PI * PI),
        ("clamped, pinned", true, [true, false], 20.190_728_556_426_63),
        ("clamped", true, [true, true], 4.0 * PI * PI),
    ];
    for (name, foot, head, exact) in cases {
        for share in [1e-3, 0.4, 0.95] {
            let found = modal(&column(share * exact, foot, head), 4);
            assert!(!found.unstable && found.warnings.is_empty(), "{:?}", found.warnings);
            let critical = found.critical.expect("a load");
            assert_eq!(critical.loads, ["force at `column.end`"]);
            close(name, critical.factor.expect("it buckles"), 1.0 / share, 1e-4);
            let shape = critical.shape.expect("a shape");
            assert!(shape.directions[0] + shape.directions[1] > 0.999, "{:?}", shape.directions);
        }
        // beyond it nothing vibrates: the ways in which it falls, and from which load on it does
        let found = modal(&column(1.5 * exact, foot, head), 6);
        assert!(found.unstable && found.modes.len() == 2 && found.modes.iter().all(Mode::is_unstable));
        assert!(found.warnings[0].contains("grows in 2 modes"), "{:?}", found.warnings);
        close(name, found.critical.and_then(|c| c.factor).expect("lost before"), 1.0 / 1.5, 1e-4);
    }
    // Greenhill: a column under its own weight
    let mut heavy = column(0.0, true, [false, false]);
    heavy.set_gravity([0.0, 0.0, -2.0]).force(GravitySpec::default());
    let critical = modal(&heavy, 4).critical.expect("a load");
    close("Greenhill", critical.factor.expect("it buckles"), 7.837_347_438_943_38 / 2.0, 1e-4);
    // hung up, it never buckles
    let mut hung = column(0.0, true, [false, false]);
    hung.set_gravity([0.0, 0.0, 2.0]).force(GravitySpec::default());
    assert_eq!(modal(&hung, 4).critical.expect("a load").factor, None);
    assert!(modal(&column(0.0, true, [false, false]), 4).critical.is_none(), "no load, no factor");
}

/// A beam that a force bends has no critical load: its stiffness along the cable turns with it, which linear buckling took for one.
#[test]
fn what_is_bent_has_no_critical_factor_for_that() {
    for load in [0.2, 1.0, 3.0] {
        let mut scene = column(0.0, true, [false, false]);
        scene.force(PointForceSpec::new("column.end", [load, 0.0, 0.0], TimeFunction::default()));
        let found = modal(&scene, 4);
        assert_eq!(found.critical.expect("a load").factor, None, "{load}");
    }
}

#[test]
fn follower_forces_flutter_and_never_buckle() {
    // Beck's column flutters at 20.051 without damping
    for (load, flutters) in [(10.0, false), (19.5, false), (20.6, true)] {
        let mut scene = column(0.0, true, [false, false]);
        scene.force(PointForceSpec {
            follower: Some((-load).into()),
            ..PointForceSpec::new("column.end", [0.0; 3], TimeFunction::default())
        });
        let found = modal(&scene, 8);
        assert_eq!(found.unstable, flutters, "{load}: {:?}", found.warnings);
        assert_eq!(found.critical.expect("a load").factor, None, "{load}");
        if flutters {
            assert!(found.modes.iter().all(|m| m.is_unstable() && m.omega > 1.0));
        }
    }
}

/// The critical factor of the loads of a scene.
#[track_caller]
fn factor(text: &str) -> f64 {
    let file = SceneFile::parse(text, "scene", Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}"));
    modal(file.scene(), 4).critical.and_then(|c| c.factor).expect("it gives way")
}

/// A half circle of 1 m and 1 N m² on two hinges, pressed towards its middle by forces that keep their directions, of `load`
/// per length in all. What is bent by `φ` meets `φ'' + q φ = a cos θ + b sin θ`, is as long as it was, so that `φ cos θ`
/// sums up to nothing, and free of moments at its ends: `tan(k π/2) = 4/(π k (1 - k²))`, `q = k²`.
#[test]
fn an_arch_gives_way_at_its_load_however_stiff_it_is_along() {
    let mut k = [1.5, 2.0];
    let off = |k: f64| (k * FRAC_PI_2).tan() - 4.0 / (PI * k * (1.0 - k * k));
    for _ in 0..60 {
        let middle = 0.5 * (k[0] + k[1]);
        k[usize::from(off(middle).signum() == off(k[1]).signum())] = middle;
    }
    let exact = k[0] * k[0];
    let arch = |elements: usize, ea: f64, load: f64| {
        let at = |i: usize| PI * (1.0 - i as f64 / elements as f64);
        let curve: Vec<[f64; 3]> = (0..=elements).map(|i| [at(i).cos(), 0.0, at(i).sin()]).collect();
        let mut text = format!(
            r#"
            run = {{ analysis = "statics" }}
            [[elements]]
            type = "cable"
            name = "arch"
            curve = {curve:?}
            start_direction = [0, 0, 1]
            end_direction = [0, 0, -1]
            elements = {elements}
            stress_free = "as-laid"
            section = {{ mass = 1, ea = {ea:e}, ei = [1, 100], gj = 100 }}
            normal = [0, 1, 0]
            "#
        );
        for end in ["start", "end"] {
            let hinge = "type = \"revolute\"\naxis = [0, 1, 0]";
            writeln!(text, "[[constraints]]\n{hinge}\nname = \"{end}\"\nmarker = \"arch.{end}\"")
                .expect("text");
        }
        for i in 1..elements {
            let (share, force) = (100.0 * i as f64 / elements as f64, load * PI / elements as f64);
            let (x, z) = (-force * at(i).cos(), -force * at(i).sin());
            let force = format!("marker = \"arch@{share}%\"\nforce = [{x:?}, 0, {z:?}]");
            writeln!(text, "[[forces]]\ntype = \"point_force\"\n{force}").expect("text");
        }
        text
    };
    for (elements, ea, load, tolerance) in
        [(12, 1e6, 1.0, 2e-3), (24, 1e6, 1e-3, 5e-4), (24, 1e8, 3.0, 5e-4), (48, 1e6, 1.0, 1e-4)]
    {
        close("arch", load * factor(&arch(elements, ea, load)), exact, tolerance);
    }
}

/// A strip on edge tips over sideways: `P l² = 4.0126 √(EI₂ GJ)` where it isn't bent before (Timoshenko & Gere, Theory of
/// Elastic Stability, 1961, 6.3), and more by `1/√((1 - EI₂/EI₁)(1 - GJ/EI₁))` where it is (to first order in both).
#[test]
fn a_strip_tips_over_sideways_however_stiff_it_is_along() {
    let strip = |stiff: f64, ea: f64, load: f64| {
        format!(
            r#"
            run = {{ analysis = "statics" }}
            [[elements]]
            type = "cable"
            name = "strip"
            points = [[0, 0, 0], [1, 0, 0]]
            elements = 16
            section = {{ mass = 1, ea = {ea:e}, ei = [{stiff}, 1], gj = 0.5 }}
            normal = [0, 1, 0]
            [[constraints]]
            type = "clamp"
            name = "wall"
            marker = "strip.start"
            [[forces]]
            type = "point_force"
            marker = "strip.end"
            force = [0, 0, -{load}]
            "#
        )
    };
    for (stiff, ea, load, tolerance) in
        [(1e3, 1e8, 1e-3, 3e-4), (1e3, 1e8, 2.0, 3e-4), (1e2, 1e6, 0.5, 1e-3), (1e2, 1e8, 0.5, 1e-3)]
    {
        let unbent: f64 = (1.0 - 1.0 / stiff) * (1.0 - 0.5 / stiff);
        let exact = 4.0126 * (0.5 / unbent).sqrt();
        close("strip", load * factor(&strip(stiff, ea, load)), exact, tolerance);
    }
}

/// Two bars of a span of 2 m and a height, `EA = 1`, snap through under the largest `P = 2 EA (l₀ - l)/l₀ z/l`: whatever the unit of
/// length, also where the way from one side to the other is short.
#[test]
fn a_truss_gives_way_at_the_limit_of_its_load() {
    for (unit, height) in [(1.0, 0.5_f64), (1e-3, 0.5), (1e3, 0.5), (1.0, 0.05), (1e-3, 0.05)] {
        let rest = (1.0 + height * height).sqrt();
        let held = |z: f64| 2.0 * (rest - z.hypot(1.0)) / rest * z / z.hypot(1.0);
        let limit = (1..500_000).map(|i| held(2e-6 * height * f64::from(i))).fold(0.0, f64::max);
        let load = 0.1 * limit;
        let mut text = format!(
            r#"
            run = {{ analysis = "statics" }}
            [[elements]]
            type = "point_mass"
            name = "top"
            marker = [0, 0, {top}]
            mass = 1
            [[constraints]]
            type = "coordinate"
            name = "plane"
            marker = "top"
            direction = [0, 1, 0]
            [[forces]]
            type = "point_force"
            marker = "top"
            force = [0, 0, -{load}]
            "#,
            top = unit * height
        );
        for x in [-unit, unit] {
            let bar = format!("marker = [{x}, 0, 0]\nto = \"top\"\nstiffness = {}", 1.0 / (unit * rest));
            writeln!(text, "[[forces]]\ntype = \"spring\"\nname = \"bar{x}\"\n{bar}").expect("text");
        }
        close("truss", load * factor(&text), limit, 1e-5);
    }
}

/// What moves freely doesn't fall over: a body that may spin on the cable that it hangs on, a bent column that may turn about its own
/// line. However few modes are asked for.
#[test]
fn what_is_free_is_not_lost() {
    let hung = r#"
        run = { analysis = "statics" }
        [[elements]]
        type = "cable"
        name = "line"
        points = [[0, 0, 0], [0, 0, -1]]
        elements = 12
        section = { mass = 1, ea = 1e5, ei = 1e-3 }
        [[elements]]
        type = "rigid_body"
        name = "load"
        position = [0, 0, -1]
        mass = 1
        inertia = [1, 1, 1]
        centre = [0.1, 0, -0.3]
        [[constraints]]
        type = "spherical"
        name = "hook"
        marker = "line.start"
        [[constraints]]
        type = "weld"
        name = "end"
        marker = "line.end"
        to = "load"
        [[forces]]
        type = "gravity"
        "#;
    let file = SceneFile::parse(hung, "scene", Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}"));
    for count in [2, 6, 20] {
        assert_eq!(modal(file.scene(), count).critical.expect("a load").factor, None, "{count}");
    }
    // beyond its buckling load a column of which both ends turn freely holds until these meet, at (2K/π)² of it where 2E = K
    for elements in [16, 32] {
        let mut bent = column(1.01 * PI * PI, false, [true, false]);
        bent.elements.clear();
        bent.element(CableSpec::straight(
            "column",
            [0.0; 3],
            [0.0, 0.0, 1.0],
            elements,
            Section::new(1.0, 1e6, 1.0),
        ));
        bent.statics.stable = true;
        let critical = modal(&bent, 8).critical.and_then(|c| c.factor).expect("it gives way");
        close("bent column", 1.01 * critical, 2.1834, 2e-3);
    }
}

/// A column on few elements, very stiff along, of which nearly all modes are asked for: what is slow isn't taken for free.
#[test]
fn a_stiff_column_has_its_factor_whatever_is_asked_for() {
    let mut stiff = column(0.5 * 0.25 * PI * PI, true, [false, false]);
    stiff.elements.clear();
    let section = Section::new(1.0, 1e9, 1.0);
    stiff.element(CableSpec::straight("column", [0.0; 3], [0.0, 0.0, 1.0], 4, section));
    for count in [2, 12, 20] {
        close("column", modal(&stiff, count).critical.and_then(|c| c.factor).expect("it buckles"), 2.0, 1e-3);
    }
}

/// What falls over by itself on its way is counted though stiffness and constraints are alike: a bar on a spring.
#[test]
fn a_bar_on_a_spring_falls_over_at_its_weight() {
    for stiffness in [10.0, 25.0, 1e3, 8e4] {
        let text = format!(
            r#"
            gravity = [0, 0, -10]
            run = {{ analysis = "statics" }}
            [[elements]]
            type = "rigid_body"
            name = "bar"
            position = [0, 0, 0]
            mass = 0.9
            centre = [0, 0, 1]
            inertia = [0.1, 0.1, 0.01]
            [[constraints]]
            type = "revolute"
            name = "pin"
            marker = "bar"
            axis = [0, 1, 0]
            [[forces]]
            type = "rotational_spring"
            name = "spring"
            marker = "bar"
            axis = [0, 1, 0]
            stiffness = {stiffness}
            [[forces]]
            type = "gravity"
            "#
        );
        close("bar", factor(&text), stiffness / 9.0, 1e-6);
    }
}

/// An arch between two hinges with a rise over half of its span, 1 m: `ea` and what loads it.
fn arch(rise: f64, ea: f64, steps: usize, load: &str, besides: &str) -> String {
    let radius: f64 = (1.0 + rise * rise) / (2.0 * rise);
    let end = (1.0 / radius).asin();
    let at = |i: i32| end * f64::from(i) / 12.0;
    let curve: Vec<[f64; 3]> =
        (-12..=12).map(|i| [radius * at(i).sin(), 0.0, radius * (at(i).cos() - end.cos())]).collect();
    let (along, up) = (end.cos(), end.sin());
    let mut text = format!(
        r#"
        run = {{ analysis = "statics", duration = 1 }}
        statics = {{ steps = {steps} }}
        gravity = [0, 0, 0]
        [[elements]]
        type = "cable"
        name = "arch"
        curve = {curve:?}
        start_direction = [{along}, 0, {up}]
        end_direction = [{along}, 0, -{up}]
        elements = 24
        stress_free = "as-laid"
        section = {{ mass = 1, ea = {ea:e}, ei = [1, 100], gj = 100 }}
        normal = [0, 1, 0]
        {besides}
        [[forces]]
        {load}
        "#
    );
    for end in ["start", "end"] {
        let hinge = "type = \"revolute\"\naxis = [0, 1, 0]";
        writeln!(text, "[[constraints]]\n{hinge}\nname = \"{end}\"\nmarker = \"arch.{end}\"").expect("text");
    }
    text
}

/// A line beside it that nothing loads.
fn long_line(length: u32, elements: u32, ea: f64) -> String {
    format!(
        "[[elements]]\ntype = \"cable\"\nname = \"long\"\npoints = [[0, 0, -5], [{length}, 0, -5]]\n\
         elements = {elements}\nsection = {{ mass = 1, ea = {ea:e}, ei = 1 }}\n\
         [[constraints]]\ntype = \"spherical\"\nname = \"c\"\nmarker = \"long.start\"\n\
         [[constraints]]\ntype = \"spherical\"\nname = \"d\"\nmarker = \"long.end\""
    )
}

/// A force on its top, or on all of it, that grows with time from one share of itself.
fn on_top(load: f64, from: f64) -> String {
    let time = format!("time = {{ table = {{ t = [0, 1], value = [{from}, 1] }} }}");
    format!("type = \"point_force\"\nmarker = \"arch@50%\"\nforce = [0, 0, -{load}]\n{time}")
}

fn all_along(load: f64, from: f64) -> String {
    let time = format!("time = {{ table = {{ t = [0, 1], value = [{from}, 1] }} }}");
    format!("type = \"line_load\"\non = [\"arch\"]\nforce = [0, 0, -{load}]\n{time}")
}

fn parse(text: &str) -> SceneFile {
    SceneFile::parse(text, "arch", Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}"))
}

/// An arch that is nearly flat snaps through by little, under a fiftieth of the load: a path sees that however few its steps are, at
/// the load that linear stability about a small one leads to.
#[test]
fn a_path_does_not_leap_over_a_small_snap() {
    let mut critical = None;
    for steps in [1, 2, 3, 10, 40] {
        let h = simulate(parse(&arch(0.05, 1e6, steps, &on_top(60.0, 0.0), "")).scene())
            .unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(h.critical.len(), 1, "{steps} steps: {:?}", h.critical);
        let load = 60.0 * h.critical[0].load_factor;
        close("snap", load, *critical.get_or_insert(load), 1e-5);
    }
    // as `modes` has it
    let options = ModesOptions { time: Some(1.0), ..ModesOptions::default() };
    let found = modes(parse(&arch(0.05, 1e6, 1, &on_top(0.5, 0.0), "")).scene(), &options)
        .unwrap_or_else(|e| panic!("{e}"));
    let factor = found.critical.and_then(|c| c.factor).expect("it snaps");
    close("by modes", 0.5 * factor, critical.expect("found"), 1e-4);
}

/// What gives way is told with its load and its kind, however many steps the load takes: also where it is pulled up first, beside
/// a line a hundred times as long, and where it snaps through soon after it would have swayed.
#[test]
fn what_gives_way_does_not_hang_on_the_steps() {
    let long = long_line(200, 8, 1e6);
    let cases = [
        ("pulled up first", 0.05, 2.5e3, all_along(5.0, -1.0), "", 1e-6),
        ("beside a long line", 0.05, 1e6, on_top(60.0, 0.0), &long, 1e-6),
        ("sways", 0.1, 2.5e3, all_along(10.0, -1.0), "", 1e-6),
        ("sways at once", 0.1, 2.5e5, all_along(10.0, 0.0), "", 1e-6),
        // the path goes over to the one that branches off, which is stable, and is told by where that has been seen
        ("sways little by little", 1.0, 1e3, on_top(6.1, 0.0), "", 1e-4),
    ];
    for (what, rise, ea, load, besides, tolerance) in cases {
        let mut first: Option<(f64, CriticalKind)> = None;
        for steps in [1, 2, 3, 10, 40] {
            let h = simulate(parse(&arch(rise, ea, steps, &load, besides)).scene())
                .unwrap_or_else(|e| panic!("{what}, {steps} steps: {e}"));
            println!(
                "{what}, {steps} steps: {:?}",
                h.critical.iter().map(|c| (c.load_factor, c.kind)).collect::<Vec<_>>()
            );
            assert_eq!(h.critical.len(), 1, "{what}, {steps} steps: {:?}", h.critical);
            let found = (h.critical[0].load_factor, h.critical[0].kind);
            let known = *first.get_or_insert(found);
            close(what, found.0, known.0, tolerance);
            assert_eq!(found.1, known.1, "{what}, {steps} steps");
        }
    }
}

/// Beside a line a thousand times as long a path can't be followed through what the small arch does: that is said, at its place.
#[test]
fn what_can_not_be_followed_is_said() {
    let long = long_line(1000, 20, 1e4);
    for (besides, said) in [("", 0), (long.as_str(), 1)] {
        let file = parse(&arch(0.1, 2467.06, 1, &on_top(1.584, 0.0), besides));
        let h = simulate(file.scene()).unwrap_or_else(|e| panic!("{e}"));
        let unseen = |w: &&String| w.contains("couldn't be followed");
        assert_eq!(h.warnings.iter().filter(unseen).count(), said, "{:?}", h.warnings);
        assert!(h.critical.is_empty(), "{:?}", h.critical);
        // modes are those of the same path
        let options = ModesOptions { count: 2, ..ModesOptions::default() };
        let modal = modes(file.scene(), &options).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(modal.warnings.iter().filter(unseen).count(), said, "{:?}", modal.warnings);
    }
}
