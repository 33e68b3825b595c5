//! What is in a sea, as scenes: what floats and drifts in it, balances, invariances, mistakes.

use super::{refused, run, scene};
use ropewalk::History;
use ropewalk_scene::Sea;
use std::f64::consts::PI;
use std::sync::Arc;

fn last(h: &History, name: &str) -> f64 {
    h.last(name).unwrap_or_else(|| panic!("no {name}"))
}

fn sea(text: &str) -> Arc<Sea> {
    let file = scene(text);
    let water = file.scene().water.as_ref().expect("water");
    water.raised(file.scene().gravity).expect("a sea").expect("waves")
}

/// Where a particle of the water is after a time, by the method of Runge and Kutta.
fn drifted(sea: &Sea, mut x: [f64; 3], end: f64) -> [f64; 3] {
    let n = 5_000;
    let h = end / f64::from(n);
    let moved = |x: [f64; 3], u: [f64; 3], h: f64| [0, 1, 2].map(|i| x[i] + h * u[i]);
    for k in 0..n {
        let t = h * f64::from(k);
        let u0 = sea.at(t, &x).u;
        let u1 = sea.at(t + 0.5 * h, &moved(x, u0, 0.5 * h)).u;
        let u2 = sea.at(t + 0.5 * h, &moved(x, u1, 0.5 * h)).u;
        let u3 = sea.at(t + h, &moved(x, u2, h)).u;
        x = [0, 1, 2].map(|i| x[i] + h / 6.0 * (u0[i] + 2.0 * u1[i] + 2.0 * u2[i] + u3[i]));
    }
    x
}

/// A line along the crests, a body and a mass, all as heavy as water, go where the water goes: also what drag they have.
#[test]
fn what_is_as_heavy_as_water_goes_with_it() {
    let (diameter, depth) = (0.2, 4.0);
    let area = PI * diameter * diameter / 4.0;
    let water = |stretching: &str| {
        format!(
            r#"
            [run]
            duration = "15 s"
            output = "1 s"
            [water]
            density = 1000
            level = 1
            [water.waves]
            components = [
                {{ amplitude = 0.8, period = 6 }},
                {{ amplitude = 0.4, period = 4, phase = 1 }},
            ]
            depth = 30
            ramp = 8
            stretching = "{stretching}"
            "#
        )
    };
    let mut wrong = Vec::new();
    for stretching in ["wheeler", "constant"] {
        for (solver, near) in
            [("", 1e-3), ("scheme = \"radau-iia-5\"\nstepping = { controlled = { tolerance = 1e-9 } }", 1e-7)]
        {
            let text = format!(
                r#"
                {}
                [solver]
                {solver}
                [[elements]]
                type = "cable"
                name = "line"
                points = [[0, 0, {z}], [0, 2, {z}]]
                elements = 2
                section = {{ mass = {}, ea = 1e3, diameter = {diameter} }}
                [[elements]]
                type = "rigid_body"
                name = "tube"
                position = [0, 4, {z}]
                mass = {}
                inertia = [10, 1, 10]
                volume = {area}
                hull = {{ from = [0, -0.5, 0], to = [0, 0.5, 0], diameter = {diameter} }}
                [[elements]]
                type = "point_mass"
                name = "ball"
                marker = [0, 8, {z}]
                mass = 50
                volume = 0.05
                added_mass = 25
                drag_area = 0.1
                [[forces]]
                type = "gravity"
                on = ["tube", "ball"]
                [[forces]]
                type = "buoyancy"
                on = ["tube", "ball"]
                [[forces]]
                type = "drag"
                cn = 1.2
                ct = 0.1
                [[forces]]
                type = "added_mass"
                [[records]]
                type = "position"
                of = "line.end"
                [[records]]
                type = "position"
                of = "tube.com"
                [[records]]
                type = "position"
                of = "ball"
                [[records]]
                type = "energy"
                "#,
                water(stretching),
                1000.0 * area,
                1000.0 * area,
                z = 1.0 - depth,
            );
            let h = run(&text);
            let particle = drifted(&sea(&text), [0.0, 0.0, 1.0 - depth], 15.0);
            for name in ["line.end", "tube.com", "ball"] {
                let off =
                    ["x", "z"].iter().zip([particle[0], particle[2]]).fold(0.0_f64, |worst, (axis, x)| {
                        worst.max((last(&h, &format!("{name}.{axis}")) - x).abs())
                    });
                println!("{stretching}: {name} is {off:.1e} m from the water");
                if !(off < near) {
                    wrong.push(format!("{stretching}: {name} by {off:e} m"));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:?}");
}

/// A floating line, a spar and a buoy in a sea, moored.
fn afloat(turn: f64, length: &dyn Fn(f64) -> String, waves: &str) -> String {
    let (sin, cos) = turn.sin_cos();
    let at = |x: f64, y: f64, z: f64| {
        format!("[{}, {}, {}]", length(cos * x - sin * y), length(sin * x + cos * y), length(z))
    };
    format!(
        r#"
        [run]
        duration = "25 s"
        output = "0.25 s"
        [water]
        density = 1025
        level = {level}
        current = [{}, {}, 0]
        [water.waves]
        {waves}
        direction = "{} deg"
        depth = {depth}
        ramp = "5 s"
        [[elements]]
        type = "cable"
        name = "line"
        points = [{}, {}]
        elements = 8
        section = {{ mass = "5 kg/m", ea = "200 kN", ei = "20 N m^2", diameter = {d} }}
        [[elements]]
        type = "rigid_body"
        name = "spar"
        position = {}
        mass = "500 kg"
        inertia = [300, 300, 20]
        centre = [0, 0, {low}]
        volume = 0.7853981633974483
        hull = {{ from = [0, 0, {down}], to = [0, 0, {up}], diameter = {hull} }}
        points = {{ eye = [0, 0, {down}] }}
        [[elements]]
        type = "point_mass"
        name = "buoy"
        marker = "line.end"
        mass = "100 kg"
        volume = 0.2
        added_mass = "50 kg"
        drag_area = 0.5
        [[constraints]]
        type = "spherical"
        name = "eye"
        marker = "line.start"
        to = "spar.eye"
        [[forces]]
        type = "spring"
        name = "mooring"
        marker = "spar.eye"
        to = {}
        stiffness = "200 N/m"
        damping = "50 N s/m"
        length = {rest}
        [[forces]]
        type = "gravity"
        [[forces]]
        type = "buoyancy"
        [[forces]]
        type = "drag"
        end = 0.4
        [[forces]]
        type = "added_mass"
        [[records]]
        type = "position"
        of = "buoy"
        [[records]]
        type = "position"
        of = "spar.eye"
        [[records]]
        type = "energy"
        "#,
        0.3 * cos,
        0.3 * sin,
        turn.to_degrees() + 20.0,
        at(0.0, 0.0, -2.2),
        at(12.0, 3.0, 0.1),
        at(0.0, 0.0, -0.2),
        at(-15.0, 0.0, -8.0),
        level = length(0.1),
        depth = length(30.0),
        d = length(0.08),
        low = length(-0.8),
        down = length(-2.0),
        up = length(2.0),
        hull = length(0.5),
        rest = length(16.0),
    )
}

const SEA: &str = "jonswap = { hs = \"1.2 m\", tp = \"5 s\" }\nseed = 4\ncount = 60";

fn metres(x: f64) -> String {
    format!("{x}")
}

/// All that waves do is accounted for, in a scene that has everything at the surface.
#[test]
fn the_work_of_waves_is_balanced() {
    let h = run(&afloat(0.4, &metres, SEA));
    let most = |name: &str| {
        let column = h.column(name).expect("energy");
        column.iter().fold(0.0_f64, |most, x| if x.abs() <= most { most } else { x.abs() })
    };
    let (work, imbalance) = (most("energy.supplied"), most("energy.imbalance"));
    println!("imbalance {imbalance:.2e} J of {work:.2e} J");
    assert!(imbalance < 2e-3 * work, "{imbalance} {work}");
    assert!(h.warnings.is_empty(), "{:?}", h.warnings);
}

/// A scene that is turned about the vertical, and one in other units, run alike.
#[test]
fn a_turned_scene_and_one_in_other_units_run_alike() {
    let waves = "regular = { height = \"0.8 m\", period = \"4 s\", phase = \"30 deg\" }";
    let own = run(&afloat(0.0, &metres, waves));
    let turned = run(&afloat(1.1, &metres, waves));
    let feet = run(&afloat(0.0, &|x| format!("\"{:e} km\"", 1e-3 * x), waves));
    let (sin, cos) = 1.1_f64.sin_cos();
    for name in ["buoy", "spar.eye"] {
        let [x, y, z] = ["x", "y", "z"].map(|axis| last(&own, &format!("{name}.{axis}")));
        let of = |h: &History| ["x", "y", "z"].map(|axis| last(h, &format!("{name}.{axis}")));
        let apart = |a: [f64; 3], b: [f64; 3]| (0..3).fold(0.0_f64, |m, i| m.max((a[i] - b[i]).abs()));
        let off =
            [apart(of(&turned), [cos * x - sin * y, sin * x + cos * y, z]), apart(of(&feet), [x, y, z])];
        println!("{name}: turned by {:.1e} m, in kilometres by {:.1e} m", off[0], off[1]);
        assert!(off[0] < 1e-2 && off[1] < 1e-3, "{off:?}");
    }
}

/// A small buoy rides on long waves: its draught is that of still water.
#[test]
fn a_buoy_rides_on_long_waves() {
    let text = r#"
        [run]
        duration = "60 s"
        output = "0.5 s"
        [water]
        level = 2
        [water.waves]
        regular = { height = "3 m", period = "12 s" }
        ramp = "24 s"
        [[elements]]
        type = "point_mass"
        name = "buoy"
        marker = [0, 0, 2]
        mass = "102.5 kg"
        volume = 0.2
        added_mass = "60 kg"
        drag_area = 0.5
        [[forces]]
        type = "gravity"
        [[forces]]
        type = "buoyancy"
        [[records]]
        type = "position"
        of = "buoy"
        "#;
    let (h, sea) = (run(text), sea(text));
    let place = ["x", "y", "z"].map(|axis| h.column(&format!("buoy.{axis}")).expect("a column"));
    let mut worst = 0.0_f64;
    for (k, t) in h.times().iter().enumerate() {
        let x = [0, 1, 2].map(|i| place[i][k]);
        worst = worst.max((x[2] - 2.0 - sea.at(*t, &x).top.elevation).abs());
    }
    println!("off the surface by {worst:.3} m of 1.5 m");
    assert!(worst < 0.05, "{worst}");
}

/// Steps follow waves that nothing feels yet: a long step from rest would leap over them.
#[test]
fn steps_are_shorter_than_the_shortest_wave() {
    let text = r#"
        [run]
        duration = "40 s"
        output = "10 s"
        [water]
        level = 0
        [water.waves]
        regular = { height = 1, period = 3 }
        [[elements]]
        type = "point_mass"
        name = "ball"
        marker = [0, 0, -3]
        mass = 1e6
        volume = 1e-3
        drag_area = 1e-3
        "#;
    let h = run(text);
    assert!(h.counts.steps >= 160, "{}", h.counts.steps);
}

/// What a scene without waves computes has none of their terms.
#[test]
fn still_water_has_no_terms_of_waves() {
    let labels = |waves: &str| {
        let text = afloat(0.0, &metres, SEA);
        let (before, after) = text.split_once("[water.waves]").expect("waves");
        let rest = after.split_once("[[elements]]").expect("elements").1;
        let model = scene(&format!("{before}{waves}[[elements]]{rest}")).build().expect("a model");
        (
            model.terms().iter().map(|t| t.label()).collect::<Vec<_>>(),
            model.terms().iter().filter(|t| t.timed().is_some()).count(),
        )
    };
    let (still, timed) = labels("");
    assert_eq!(timed, 0);
    assert!(still.iter().all(|l| !l.contains("waves")), "{still:?}");
    let (moving, timed) = labels("[water.waves]\nregular = { height = 1, period = 5 }\n");
    assert!(moving.iter().any(|l| l.contains("pressure of waves")) && timed > 0, "{moving:?}");
}

#[test]
fn seas_that_make_no_sense_are_refused_by_name() {
    let with = |level: &str, waves: &str, more: &str| {
        refused(&format!(
            "{more}\n[water]\n{level}\n[water.waves]\n{waves}\n[[elements]]\ntype = \"point_mass\"\nname = \"ball\"\n\
             marker = [0, 0, -3]\nmass = 1\n"
        ))
    };
    let jonswap = "jonswap = { hs = 2, tp = 8 }";
    for (level, waves, more, said) in [
        ("", jonswap, "", "give the water its `level`"),
        ("level = 0", "", "", "has no sea state"),
        (
            "level = 0",
            "jonswap = { hs = 2, tp = 8 }\nregular = { height = 1, period = 5 }",
            "",
            "more than one sea state",
        ),
        ("level = 0", "jonswap = { hs = -2, tp = 8 }", "", "`hs` must be above 0"),
        ("level = 0", "jonswap = { hs = 2, tp = 8, gamma = 90 }", "", "`gamma` must be between"),
        ("level = 0", "regular = { height = 1, period = 0 }", "", "`period` must be positive"),
        ("level = 0", &format!("{jonswap}\ndepth = 0"), "", "`depth` must be above 0"),
        ("level = 0", &format!("{jonswap}\nramp = -1"), "", "`ramp` must not be negative"),
        ("level = 0", "regular = { height = -1, period = 5 }", "", "`height` must not be negative"),
        ("level = 0", "regular = { height = 8, period = 8 }\ndepth = 3", "", "the water is only 3 m"),
        ("level = 0", &format!("{jonswap}\ncount = 0"), "", "at least one component"),
        (
            "level = 0",
            &format!("{jonswap}\nspreading = {{ s = 4, directions = 0 }}"),
            "",
            "`directions` must be between",
        ),
        (
            "level = 0",
            &format!("{jonswap}\nspreading = {{ s = 4, directions = 5 }}\nevaluation = \"lattice\""),
            "",
            "a lattice is for waves of one direction",
        ),
        ("level = 0", &format!("{jonswap}\nlattice_error = 1e-9"), "", "the finest lattice is off by"),
        (
            "level = 0\ncurrent = [-5, 0, 0]",
            &format!("{jonswap}\ndoppler = true"),
            "",
            "can't advance against a current",
        ),
        ("level = 0", jonswap, "gravity = [0, 0, 0]", "waves need gravity that points down"),
        ("level = 0", jonswap, "[run]\nanalysis = \"statics\"", "there is no equilibrium in waves"),
        ("level = 0", jonswap, "[run]\nfrom_equilibrium = true", "let the waves rise from it"),
        ("level = 0", &format!("{jonswap}\nheight = 3"), "", "height"),
    ] {
        let error = with(level, waves, more);
        assert!(error.contains(said), "{said}: {error}");
    }
}
