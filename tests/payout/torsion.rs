//! Cables with torsion that run over sheaves, through rings and onto drums.

use super::reeving::{at, refused, run};
use ropewalk::scene::Format;
use ropewalk::{History, ModesOptions, SceneFile, Simulation, modes};
use ropewalk_core::model::twist::{between, section};
use ropewalk_core::rotation::{cross, exp, matrix, times};
use ropewalk_core::testing::{check_constraint, check_tangent, dense, difference};
use ropewalk_core::{At, Model, Spot, Term, Weights, Width, dot, retract};
use std::f64::consts::{FRAC_PI_2, PI};

pub(super) fn build(text: &str) -> Model {
    let file = SceneFile::parse(text, "scene", Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}"));
    file.into_scene().build().unwrap_or_else(|e| panic!("{e}"))
}

pub(super) fn term<'a>(model: &'a Model, label: &str) -> &'a dyn Term {
    model.terms().iter().find(|t| t.label() == label).unwrap_or_else(|| panic!("no {label}")).as_ref()
}

/// Numbers between -1 and 1, always the same.
pub(super) fn random(seed: f64) -> impl FnMut() -> f64 {
    let mut seed = seed;
    move || {
        seed = (seed * 16_807.0) % 2_147_483_647.0;
        seed / 1_073_741_823.5 - 1.0
    }
}

/// A rope over a wheel on a body, with all that torsion has.
pub(super) const BLOCK: &str = r#"
    run = { duration = 1 }
    [[elements]]
    type = "rigid_body"
    name = "block"
    position = [1.22, 0.7, -3.4]
    angles = [0.2, -0.3, 0.4]
    points = { axle = [0.1, -0.05, 0.5] }
    mass = 200
    inertia = [2, 3, 4]
    [[elements]]
    type = "cable"
    name = "rope"
    section = { mass = 1.5, ea = 1e5, gj = 30, rotary_inertia = 0.02, torsional_retardation_time = 0.1, torque_tension = 200 }
    twist = 0.3
    laid_twist = 1.5
    length = 8
    route = [{ end = [0, 0, 0] }, { under = "wheel" }, { end = [2.6, 1.5, 0.5] }]
    [[constraints]]
    type = "sheave"
    name = "wheel"
    marker = "block.axle"
    axis = [-0.5, 0.8660254037844387, 0]
    radius = 0.25
"#;

#[test]
fn forces_of_twist_on_a_wheel_are_derivatives_of_its_energy_and_tangents_of_them() {
    let model = build(BLOCK);
    let (torsion, state) = (term(&model, "wheel: torsion"), model.state());
    let nodes = model.nodes();
    for mode in [0.0, 1.0, 2.0] {
        let mut next = random(1.0 + mode);
        let d: Vec<f64> = state.v.iter().map(|_| 0.02 * next()).collect();
        let v: Vec<f64> = state.v.iter().map(|_| next()).collect();
        let a: Vec<f64> = state.v.iter().map(|_| 5.0 * next()).collect();
        let mut q = state.q.clone();
        retract(nodes, &state.q, &d, &mut q);
        let internal = vec![mode; state.internal.len()];
        let now = At { t: 0.0, q: &q, v: &v, a: &a, internal: &internal, relaxed: None };
        let off = check_tangent(torsion, nodes, &now, Width::One);
        assert!(off < 1e-7, "mode {mode}: {off}");

        let zero = vec![0.0; v.len()];
        let still = At { v: &zero, a: &zero, ..now };
        let (force, k) = dense(torsion, nodes, &still, Weights { q: 1.0, v: 0.0, a: 0.0 }, Width::One);
        let size = force.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        for j in 0..d.len() {
            let energy = |h: f64| {
                let (mut d, mut q) = (zero.clone(), still.q.to_vec());
                d[j] = h;
                retract(nodes, still.q, &d, &mut q);
                vec![torsion.energy(&At { q: &q, ..still }).potential]
            };
            let exact = difference(energy)[0];
            assert!((force[j] - exact).abs() < 1e-7 * size, "mode {mode}, {j}: {} {exact}", force[j]);
        }
        // symmetric but for rotations of the body
        let body = nodes[0].v + 3..nodes[0].v + 6;
        let most = k.iter().flatten().fold(0.0_f64, |m, x| m.max(x.abs()));
        for i in 0..k.len() {
            for j in (0..i).filter(|j| !(body.contains(&i) && body.contains(j))) {
                assert!(
                    (k[i][j] - k[j][i]).abs() < 1e-8 * most,
                    "mode {mode}: {i} {j}: {} {}",
                    k[i][j],
                    k[j][i]
                );
            }
        }
    }
}

/// A rotation about a skew axis.
fn turned(by: f64, x: [f64; 3]) -> [f64; 3] {
    times(&matrix(&exp([0.3 * by, -0.5 * by, 0.8 * by])), &x)
}

fn list(x: [f64; 3]) -> String {
    format!("[{:?}, {:?}, {:?}]", x[0], x[1], x[2])
}

/// Both ends of a rope held, and the end turned about its own axis by a motion.
fn wrung(along: [f64; 3], angle: f64) -> String {
    format!(
        r#"
        [[motions]]
        type = "table"
        name = "turn"
        t = [0, 1]
        angle = [0, {angle}]
        [[constraints]]
        type = "clamp"
        name = "a"
        marker = "rope.start"
        [[constraints]]
        type = "clamp"
        name = "b"
        marker = "rope.end"
        twist = false
        [[constraints]]
        type = "rotation"
        name = "drive"
        marker = "rope.end"
        axis = {}
        motion = "turn"
        "#,
        list(along)
    )
}

/// Twist at both ends of each span, and on a wheel.
fn observed(spans: usize, wheels: &[&str]) -> (String, Vec<String>) {
    let (mut text, mut columns) = (String::new(), Vec::new());
    for k in 1..=spans {
        for place in ["start", "end"] {
            text += &format!(
                "[[records]]\ntype = \"along\"\nof = \"rope.{k}\"\nwhat = \"twist\"\nat = \"{place}\"\n"
            );
            columns.push(format!("rope.{k}.{place}.twist"));
        }
    }
    for wheel in wheels {
        text += &format!("[[records]]\ntype = \"sheave\"\nof = \"{wheel}\"\n");
        columns.push(format!("{wheel}.twist"));
    }
    (text, columns)
}

pub(super) fn last(history: &History, column: &str) -> f64 {
    history.last(column).unwrap_or_else(|| panic!("no {column}"))
}

#[test]
fn twist_of_a_turned_end_is_the_same_before_on_and_behind_a_wheel() {
    let (records, columns) = observed(2, &["wheel"]);
    for tilt in [0.0, 0.9] {
        for elements in [1, 4] {
            let place = |x, z| list(turned(tilt, [x, 0.0, z]));
            let scene = format!(
                r#"
                run = {{ analysis = "statics", duration = 1 }}
                statics = {{ steps = 10 }}
                [[elements]]
                type = "cable"
                name = "rope"
                section = {{ mass = 1, ea = 1e6, gj = 5, rotary_inertia = 1e-3 }}
                length = 5
                elements = {elements}
                route = [{{ end = {} }}, {{ round = "wheel" }}, {{ end = {} }}]
                [[constraints]]
                type = "sheave"
                name = "wheel"
                marker = [0, 0, 0]
                axis = {}
                radius = 0.3
                {}
                {records}
                "#,
                place(-0.3, -2.0),
                place(0.3, -2.06),
                list(turned(tilt, [0.0, 1.0, 0.0])),
                wrung(turned(tilt, [0.0, 0.0, -1.0]), 3.0),
            );
            let history = run(&scene);
            for column in &columns {
                let found = last(&history, column);
                assert!((found - 0.6).abs() < 1e-6 * 0.6, "{tilt}, {elements}, {column}: {found}");
            }
        }
    }
}

/// Along x, over a wheel down, and under another one along y: the direction of the rope goes round an eighth of the sphere.
fn octant(elements: usize, more: &str) -> String {
    format!(
        r#"
        run = {{ analysis = "statics", duration = 1 }}
        statics = {{ steps = 10 }}
        [[elements]]
        type = "cable"
        name = "rope"
        section = {{ mass = 1, ea = 1e6, gj = 5, rotary_inertia = 1e-3 }}
        tension = 1000
        elements = {elements}
        route = [{{ end = [-2, 0, 0] }}, {{ round = "first" }}, {{ round = "second" }}, {{ end = [0.3, 2.2, -3.5] }}]
        [[constraints]]
        type = "sheave"
        name = "first"
        marker = [0, 0, -0.3]
        axis = [0, 1, 0]
        radius = 0.3
        [[constraints]]
        type = "sheave"
        name = "second"
        marker = [0.3, 0.2, -3.3]
        axis = [1, 0, 0]
        radius = 0.2
        {more}
        "#
    )
}

#[test]
fn wheels_in_different_planes_turn_the_section_by_the_angle_on_the_sphere() {
    let model = build(&octant(2, ""));
    let q = &model.state().q;
    let [start, end] = ["start", "end"].map(|place| {
        let marker = model.part("rope").expect("a rope").marker(&Spot::Named(place.into())).expect("an end");
        let s = section(&q[model.nodes()[marker.on().expect("a node").0 as usize].q..]);
        [0, 2].map(|c| [s[0][c], s[1][c], s[2][c]])
    });
    // no twist: but the directors are turned by the area of an eighth of the sphere
    let angle = between([&start[1], &start[0]], [&end[1], &end[0]]);
    assert!((angle - FRAC_PI_2).abs() < 1e-12, "{angle}");

    let (records, columns) = observed(3, &["first", "second"]);
    let history = run(&octant(2, &(wrung([0.0, 1.0, 0.0], 1.0) + &records)));
    let length = (2.0 + 3.0 + 2.0 + 0.5 * FRAC_PI_2) / 1.001;
    for column in &columns {
        let found = last(&history, column) * length;
        assert!((found - 1.0).abs() < 1e-6, "{column}: {found}");
    }
}

/// Bodies at both ends of a rope over a wheel, which runs to the heavier one.
fn running(inertia: f64) -> String {
    let body = |name: &str, end: &str, x: f64, z: f64, mass: f64| {
        format!(
            r#"
            [[elements]]
            type = "rigid_body"
            name = "{name}"
            position = [{x}, 0, {z}]
            mass = {mass}
            inertia = [{inertia}, {inertia}, {inertia}]
            [[constraints]]
            type = "weld"
            name = "{name}.tie"
            marker = "rope.{end}"
            to = "{name}"
            "#
        )
    };
    format!(
        r#"
        run = {{ duration = 1, output = 0.05 }}
        [[elements]]
        type = "cable"
        name = "rope"
        section = {{ mass = 1, ea = 1e6, gj = 5, rotary_inertia = 1e-3 }}
        tension = 330
        laid_twist = 2
        elements = 2
        route = [{{ end = [-0.3, 0, -3] }}, {{ over = "wheel" }}, {{ end = [0.3, 0, -2] }}]
        [[constraints]]
        type = "sheave"
        name = "wheel"
        marker = [0, 0, 0]
        axis = [0, 1, 0]
        radius = 0.3
        inertia = 0.05
        {}
        {}
        {}
        [[forces]]
        type = "gravity"
        [[records]]
        type = "position"
        of = "right"
        [[records]]
        type = "energy"
        "#,
        body("left", "start", -0.3, -3.0, 30.0),
        body("right", "end", 0.3, -2.0, 40.0),
        observed(2, &["wheel"]).0,
    )
}

#[test]
fn twist_runs_over_a_wheel_with_the_rope() {
    // nothing at the ends turns
    let history = run(&running(1e9));
    assert!(last(&history, "right.z") < -2.4);
    for column in &observed(2, &["wheel"]).1 {
        let off =
            history.column(column).expect("a column").iter().fold(0.0_f64, |m, x| m.max((x - 2.0).abs()));
        assert!(off < 1e-6, "{column}: {off}");
    }
}

#[test]
fn bodies_that_swing_about_a_running_rope_keep_their_energy() {
    let imbalance = |tolerance: f64| {
        let text = running(0.05)
            + &format!("[solver]\nstepping = {{ controlled = {{ tolerance = {tolerance} }} }}\n");
        let history = run(&text);
        let twist = history.column("wheel.twist").expect("a twist");
        assert!(twist.iter().any(|k| *k < 0.0), "it swings: {twist:?}");
        // 60 J of twist at the start
        history.column("energy.imbalance").expect("energy").iter().fold(0.0_f64, |m, x| m.max(x.abs()))
    };
    let off = [1e-4, 1e-6].map(imbalance);
    assert!(off[1] < 1e-3 && off[0] < 0.1, "{off:?}");
}

#[test]
fn a_hook_block_is_turned_by_a_rope_that_unlays() {
    let (radius, height, weight, coupling, gj, ea) = (0.3, 10.0, 2000.0, 2500.0, 20.0, 1e6);
    let mut text = format!(
        r#"
        run = {{ analysis = "statics", duration = 1 }}
        statics = {{ steps = 20 }}
        [[elements]]
        type = "rigid_body"
        name = "block"
        position = [0, 0, -10.5]
        points = {{ axle = [0, 0, 0.5], mark = [1, 0, 0.5] }}
        mass = {}
        inertia = [2, 2, 2]
        [[elements]]
        type = "cable"
        name = "rope"
        section = {{ mass = 1e-4, ea = {ea}, gj = {gj}, rotary_inertia = 1e-3, torque_tension = {coupling} }}
        tension = 1000
        elements = 1
        route = [{{ end = [-{radius}, 0, 0] }}, {{ under = "wheel" }}, {{ end = [{radius}, 0, 0] }}]
        [[constraints]]
        type = "sheave"
        name = "wheel"
        marker = "block.axle"
        axis = [0, 1, 0]
        radius = {radius}
        [[forces]]
        type = "gravity"
        [[records]]
        type = "position"
        of = "block.mark"
        [[records]]
        type = "position"
        of = "block.axle"
        [[records]]
        type = "sheave"
        of = "wheel"
        "#,
        weight / 9.81
    );
    for end in ["start", "end"] {
        text += &format!(
            "[[constraints]]\ntype = \"universal\"\nname = \"{end}\"\nmarker = \"rope.{end}\"\naxis = [0, 1, 0]\naxis_to = [1, 0, 0]\n"
        );
    }
    let history = run(&text);
    let length = (2.0 * height + PI * radius) / (1.0 + 1000.0 / ea);
    // two falls turn the block by their moment, less by what unlays; hung apart, their tension turns it back
    let left = |angle: f64| {
        let fall = -last(&history, "block.axle.z");
        let lean = 2.0 * radius * (0.5 * angle).sin() / fall;
        let (tension, twist) = (0.5 * weight * (1.0 + lean * lean).sqrt(), -2.0 * angle / length);
        let moment = coupling * (tension - coupling * twist) / ea + gj * twist;
        2.0 * moment - weight * radius * radius * angle.sin() / fall
    };
    let (mut low, mut high) = (0.0, 1.5);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if left(middle) > 0.0 { low = middle } else { high = middle }
    }
    let found = (last(&history, "block.mark.y") / 1.0).asin().abs();
    println!("{found} {low}, torque {}", last(&history, "wheel.torque"));
    let tension = 0.5 * weight * (1.0 + (radius * found / height).powi(2)).sqrt();
    let shown = last(&history, "wheel.in.tension");
    assert!((shown / tension - 1.0).abs() < 1e-3, "{shown} {tension}");
    assert!((found / low - 1.0).abs() < 3e-3, "{found} {low}");
}

#[test]
fn torsion_swings_over_a_wheel_as_in_a_straight_rope() {
    let scene = |radius: f64| {
        format!(
            r#"
            run = {{ duration = 1 }}
            [[elements]]
            type = "cable"
            name = "rope"
            section = {{ mass = 1, ea = 1e6, gj = 5, rotary_inertia = 1e-3 }}
            tension = 1000
            elements = 8
            route = [{{ end = [-{radius}, 0, -2] }}, {{ over = "wheel" }}, {{ end = [{radius}, 0, -1.5] }}]
            [[constraints]]
            type = "sheave"
            name = "wheel"
            marker = [0, 0, 0]
            axis = [0, 1, 0]
            radius = {radius}
            [[constraints]]
            type = "clamp"
            name = "a"
            marker = "rope.start"
            [[constraints]]
            type = "clamp"
            name = "b"
            marker = "rope.end"
            "#
        )
    };
    // what lies on the wheel is one element: the error goes by its size squared, about (π A/L)²/12 of its share in the middle
    for (radius, most) in [(0.3, 8e-3), (0.1, 4e-4)] {
        let length = (3.5 + radius * PI) / 1.001;
        let file =
            SceneFile::parse(&scene(radius), "scene", Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}"));
        let options = ModesOptions { count: 60, ..ModesOptions::default() };
        let found = modes(&file.into_scene(), &options).unwrap_or_else(|e| panic!("{e}"));
        let exact = PI / length * (5.0_f64 / 1e-3).sqrt();
        let off = found.modes.iter().map(|m| (m.omega / exact - 1.0).abs()).fold(f64::INFINITY, f64::min);
        println!("radius {radius}: {off:e}");
        assert!(off < most, "radius {radius}: {off}");
    }
}

/// Its torque turns a rope that is bent in a ring out of the plane, as far as its bending stiffness lets it: by `β = M tan(φ/2)/√(EI T)` on
/// each side for a deflection `φ`. That takes `2 β tan(φ/2)` of the twist.
#[test]
fn a_ring_lets_twist_through() {
    let (records, columns) = observed(2, &[]);
    let scene = format!(
        r#"
            run = {{ analysis = "statics", duration = 1 }}
            statics = {{ steps = 10 }}
            [[elements]]
            type = "cable"
            name = "rope"
            section = {{ mass = 1, ea = 1e6, ei = 2, gj = 5, rotary_inertia = 1e-3 }}
            tension = 1000
            elements = 60
            route = [{{ end = [-2, 0, 0] }}, {{ through = "ring" }}, {{ end = [0, 0, -2] }}]
            [[constraints]]
            type = "ring"
            name = "ring"
            marker = [0, 0, 0]
            {}
            {records}
            "#,
        wrung([0.0, 0.0, -1.0], 1.0)
    );
    let history = run(&scene);
    let length = 4.0 / 1.001;
    let exact = 1.0 / (1.0 + 2.0 * 5.0 / (length * (2.0 * 1000.0_f64).sqrt()));
    for column in &columns {
        let found = last(&history, column) * length;
        println!("{column} {found} {exact}");
        assert!((found - exact).abs() < 2e-3, "{column}: {found} {exact}");
    }
}

#[test]
fn a_drum_takes_twist_in_and_gives_it_back() {
    let (records, columns) = observed(2, &["wheel"]);
    let history = run(&format!("{DRUM}{records}"));
    assert!((at(&history, "load.z", 4.0) + 3.0).abs() > 1.0);
    for column in &columns {
        let off =
            history.column(column).expect("a column").iter().fold(0.0_f64, |m, x| m.max((x - 2.0).abs()));
        println!("{column}: {off:e}");
        assert!(off < 1e-5, "{column}: {off}");
    }
    let imbalance =
        history.column("energy.imbalance").expect("energy").iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    println!("{imbalance}");
    assert!(imbalance < 0.1, "{imbalance}");
}

/// A load on a twisted rope from a drum, hoisted and lowered.
const DRUM: &str = r#"
        run = { duration = 8, output = 0.5 }
        [[motions]]
        type = "table"
        name = "wind"
        t = [0, 4, 8]
        angle = [0, -4, 0]
        ends = "at-rest"
        [[elements]]
        type = "cable"
        name = "rope"
        section = { mass = 0.1, ea = 1e6, gj = 5, rotary_inertia = 1e-3, axial_retardation_time = 0.01 }
        tension = 1000
        laid_twist = 2
        elements = 2
        route = [{ wound = "drum" }, { over = "wheel" }, { end = [3.3, 0, -3] }]
        [[elements]]
        type = "rigid_body"
        name = "load"
        position = [3.3, 0, -3]
        mass = 101.9
        inertia = [1e9, 1e9, 1e9]
        [[constraints]]
        type = "weld"
        name = "tie"
        marker = "rope.end"
        to = "load"
        [[constraints]]
        type = "drum"
        name = "drum"
        marker = [0, 0, 0]
        axis = [0, 1, 0]
        radius = 0.3
        turn = "wind"
        [[constraints]]
        type = "sheave"
        name = "wheel"
        marker = [3, 0, 0]
        axis = [0, 1, 0]
        radius = 0.3
        [[forces]]
        type = "gravity"
        [[records]]
        type = "position"
        of = "load"
        [[records]]
        type = "energy"
    "#;

#[test]
fn equations_of_ends_with_torsion_are_differentiated() {
    let ring = ringed(BLOCK, "[2, 1, 0.2]");
    for (text, names) in [(&*ring, vec!["wheel", "ring: torsion"]), (DRUM, vec!["drum.rope"])] {
        let model = build(text);
        let (state, nodes) = (model.state(), model.nodes());
        let mut next = random(7.0);
        let d: Vec<f64> = state.v.iter().map(|_| 0.02 * next()).collect();
        let v: Vec<f64> = state.v.iter().map(|_| next()).collect();
        let mut q = state.q.clone();
        retract(nodes, &state.q, &d, &mut q);
        for name in names {
            let mine = model.constraints().iter().filter(|c| c.name() == name);
            assert!(
                mine.clone().count() > 0,
                "no {name}: {:?}",
                model.constraints().iter().map(|c| c.name()).collect::<Vec<_>>()
            );
            for constraint in mine {
                for mode in [0.0, 1.0, 2.0] {
                    let mut internal = state.internal.clone();
                    if name == "wheel" {
                        internal[0] = mode;
                    }
                    let now = At {
                        t: 0.3,
                        q: &q,
                        v: &v,
                        a: &vec![0.0; v.len()],
                        internal: &internal,
                        relaxed: None,
                    };
                    let off = check_constraint(constraint.as_ref(), nodes, &now);
                    assert!(off < 1e-5, "{name}, {mode}: {off}");
                }
            }
        }
    }
}

#[test]
fn a_twisted_rope_lifts_off_and_comes_back() {
    // its end is led over the wheel and to the other side, and back
    let (records, columns) = observed(2, &["wheel"]);
    let scene = format!(
        r#"
        run = {{ duration = 6, output = 0.1 }}
        [[elements]]
        type = "rigid_body"
        name = "load"
        position = [-0.1, 0, -1.8]
        mass = 30
        inertia = [1e9, 1e9, 1e9]
        [[elements]]
        type = "cable"
        name = "rope"
        section = {{ mass = 0.1, ea = 1e5, gj = 0.5, rotary_inertia = 1e-2, torsional_retardation_time = 0.1 }}
        tension = 300
        laid_twist = 1
        elements = 1
        route = [{{ end = "load" }}, {{ over = "wheel" }}, {{ end = [0.1, 0, -1.8] }}]
        [[constraints]]
        type = "direction"
        name = "a"
        marker = "rope.start"
        to = "load"
        [[constraints]]
        type = "sheave"
        name = "wheel"
        marker = [0, 0, 0]
        axis = [0, 1, 0]
        radius = 0.1
        [[constraints]]
        type = "driving"
        name = "led"
        marker = "rope.end"
        motion = "way"
        [[constraints]]
        type = "perpendicular"
        name = "b"
        marker = "rope.end"
        axis = [1, 0, 0]
        axis_to = [0, 1, 0]
        [[motions]]
        type = "table"
        name = "way"
        t = [0, 2, 4, 6]
        x = [0, 1.9, 1.3, -0.4]
        z = [0, 1.84, 3.24, 3.84]
        ends = "at-rest"
        [[forces]]
        type = "gravity"
        [[records]]
        type = "energy"
        {records}
        "#
    );
    let history = run(&scene);
    assert_eq!(last(&history, "wheel.wrap"), 0.0);
    // all of it moves in a plane, and neither end turns: the twist is what it was
    for column in &columns {
        let off =
            history.column(column).expect("a column").iter().fold(0.0_f64, |m, x| m.max((x - 1.0).abs()));
        println!("{column}: {off:e}");
        assert!(off < 1e-3, "{column}: {off}");
    }
    let imbalance =
        history.column("energy.imbalance").expect("energy").iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    println!("{imbalance}");
    assert!(imbalance < 0.01, "{imbalance} J");
}

/// With a ring behind its wheel, and the bending stiffness that it needs there.
fn ringed(scene: &str, place: &str) -> String {
    scene
        .replace("{ under = \"wheel\" }", "{ under = \"wheel\" }, { through = \"ring\" }")
        .replace("mass = 1.5,", "mass = 1.5, ei = 2,")
        + &format!("[[constraints]]\ntype = \"ring\"\nname = \"ring\"\nmarker = {place}\n")
}

#[test]
fn turns_on_a_wheel_are_counted_however_many_come_at_once() {
    let model = build(BLOCK);
    let (torsion, state) = (term(&model, "wheel: torsion"), model.state());
    let memory = torsion.remembers().expect("a memory");
    let q = &state.q;
    let start = model.part("rope.2").expect("a span").marker(&Spot::Named("start".into())).expect("an end");
    let node = model.nodes()[start.on().expect("a node").0 as usize];
    let zero = vec![0.0; state.v.len()];
    let at = |q: &[f64], internal: &[f64]| {
        let now = At { t: 0.0, q, v: &zero, a: &zero, internal, relaxed: None };
        let mut shown = Vec::new();
        torsion.shows().expect("something to see").observe(&now, &mut shown);
        (shown[0], memory.lost(&now))
    };
    let (laid, _) = at(q, &state.internal);
    let (mut d, mut turned) = (zero.clone(), q.clone());
    let mut per_turn = None;
    for turn in [1.0, 20.0, -50.0] {
        d[node.v + 6] = turn;
        retract(model.nodes(), q, &d, &mut turned);
        let (twist, lost) = at(&turned, &state.internal);
        let one = *per_turn.get_or_insert((twist - laid) / turn);
        assert!(
            lost.is_none() && (twist - laid - one * turn).abs() < 1e-12 * turn.abs(),
            "{turn}: {twist} {laid}"
        );
        // what it is labelled with means nothing, if that is told
        let (place, label) = memory.labels(&turned).expect("a label");
        let (mut relabelled, mut internal) = (turned.clone(), state.internal.clone());
        let [u, t] = [6, 3].map(|k| std::array::from_fn(|i| turned[node.q + k + i]));
        let beside = cross(&t, &u).map(|x: f64| x / dot(&t, &t).sqrt());
        let (sin, cos) = 9.0_f64.sin_cos();
        (0..3).for_each(|i| relabelled[node.q + 6 + i] = cos * u[i] - sin * beside[i]);
        relabelled[node.q + 9] += 9.0;
        internal[place] += label - memory.labels(&relabelled).expect("a label").1;
        let (again, lost) = at(&relabelled, &internal);
        assert!(lost.is_none() && (again - twist).abs() < 1e-12 * twist.abs(), "{turn}: {again} {twist}");
        // and if not, it can't be told how far it turned
        let mut far = turned.clone();
        let (sin, cos) = 2.5_f64.sin_cos();
        (0..3).for_each(|i| far[node.q + 6 + i] = cos * u[i] - sin * beside[i]);
        assert!(at(&far, &state.internal).1.is_some_and(|why| why.contains("turns can't be counted")));
    }
}

#[test]
fn a_rope_of_several_turns_is_twisted_all_along_it() {
    let (records, columns) = observed(2, &["wheel"]);
    let scene = format!(
        r#"
        run = {{ analysis = "statics", duration = 1 }}
        statics = {{ steps = 1 }}
        [[elements]]
        type = "cable"
        name = "rope"
        section = {{ mass = 1, ea = 1e6, gj = 0.1, rotary_inertia = 1e-3 }}
        tension = 1000
        elements = 1
        route = [{{ end = [-0.3, 0, -0.4] }}, {{ over = "wheel" }}, {{ end = [0.3, 0, -0.4] }}]
        [[constraints]]
        type = "sheave"
        name = "wheel"
        marker = [0, 0, 0]
        axis = [0, 1, 0]
        radius = 0.3
        turns = 2
        {}
        {records}
        "#,
        wrung([0.0, 0.0, -1.0], 1.0)
    );
    let history = run(&scene);
    let exact = 1.001 / (0.8 + 0.3 * 5.0 * PI);
    for column in &columns {
        let found = last(&history, column);
        assert!((found / exact - 1.0).abs() < 1e-6, "{column}: {found} {exact}");
    }
}

#[test]
fn losses_of_a_sheave_go_by_the_whole_tension_of_a_laid_rope() {
    for (word, way) in [("to_start", 1.0), ("to_end", -1.0)] {
        let scene = format!(
            r#"
            run = {{ analysis = "statics", duration = 1 }}
            statics = {{ steps = 4 }}
            [[elements]]
            type = "cable"
            name = "rope"
            section = {{ mass = 1e-4, ea = 1e6, gj = 50, rotary_inertia = 1e-3, torque_tension = 200 }}
            tension = 2000
            laid_twist = 3
            elements = 2
            route = [{{ end = [-0.3, 0, -2] }}, {{ over = "wheel" }}, {{ end = [0.3, 0, -2] }}]
            [[constraints]]
            type = "sheave"
            name = "wheel"
            marker = [0, 0, 0]
            axis = [0, 1, 0]
            radius = 0.3
            efficiency = 0.9
            equilibrium = "{word}"
            {}
            [[records]]
            type = "along"
            of = "rope.1"
            what = "tension"
            at = "end"
            [[records]]
            type = "along"
            of = "rope.2"
            what = "tension"
            at = "start"
            [[records]]
            type = "sheave"
            of = "wheel"
            "#,
            wrung([0.0, 0.0, -1.0], 0.5)
        );
        let history = run(&scene);
        let tension = ["rope.1.end.tension", "rope.2.start.tension"].map(|column| last(&history, column));
        // 600 N of 2600 come with the twist
        assert!(tension.iter().all(|t| (2300.0..2900.0).contains(t)), "{tension:?}");
        let ratio = tension[0] / tension[1];
        let exact = 0.9_f64.powf(-way);
        println!("{word}: {ratio} {exact}");
        assert!((ratio / exact - 1.0).abs() < 1e-3, "{word}: {ratio} {exact}");
        for (shown, tension) in ["wheel.in.tension", "wheel.out.tension"].iter().zip(tension) {
            let shown = last(&history, shown);
            assert!((shown / tension - 1.0).abs() < 1e-3, "{word}: {shown} {tension}");
        }
    }
}

#[test]
fn a_ring_shows_the_tension_of_a_laid_rope() {
    let scene = format!(
        r#"
        run = {{ analysis = "statics", duration = 1 }}
        statics = {{ steps = 4 }}
        [[elements]]
        type = "cable"
        name = "rope"
        section = {{ mass = 1, ea = 1e6, ei = 2, gj = 50, rotary_inertia = 1e-3, torque_tension = 200 }}
        tension = 2000
        laid_twist = 3
        elements = 10
        route = [{{ end = [-2, 0, 0] }}, {{ through = "ring" }}, {{ end = [0, 0, -2] }}]
        [[constraints]]
        type = "ring"
        name = "ring"
        marker = [0, 0, 0]
        {}
        [[records]]
        type = "along"
        of = "rope.1"
        what = "tension"
        at = "end"
        [[records]]
        type = "force"
        of = "ring"
        "#,
        wrung([0.0, 0.0, -1.0], 0.5)
    );
    let history = run(&scene);
    let tension = last(&history, "rope.1.end.tension");
    for column in ["ring.in.tension", "ring.out.tension"] {
        let shown = last(&history, column);
        assert!((shown / tension - 1.0).abs() < 5e-3, "{column}: {shown} {tension}");
    }
}

#[test]
fn what_turned_on_its_drum_leaves_it_with_its_energy_accounted_for() {
    // wound and paid out with another twist all the time, as its load swings
    let text =
        format!("{DRUM}{}", observed(2, &["wheel"]).0).replace("[1e9, 1e9, 1e9]", "[0.05, 0.05, 0.05]");
    let imbalance = |tolerance: f64| {
        let history =
            run(&format!("{text}[solver]\nstepping = {{ controlled = {{ tolerance = {tolerance} }} }}\n"));
        let twist = history.column("rope.1.start.twist").expect("a twist");
        assert!(twist.iter().any(|k| *k < 0.0), "it swings: {twist:?}");
        // 9 J are lost as twist leaves the drum
        history.column("energy.imbalance").expect("energy").iter().fold(0.0_f64, |m, x| m.max(x.abs()))
    };
    let off = [1e-3, 1e-4].map(imbalance);
    println!("{off:?}");
    assert!(off[1] < 0.01, "{off:?}");
}

/// A belt about wheels whose planes cross.
fn belted(more: &str) -> String {
    let (records, _) = observed(3, &["a", "b", "c"]);
    let wheel = |name: &str, place: &str, axis: &str| {
        format!(
            "[[constraints]]\ntype = \"sheave\"\nname = \"{name}\"\nmarker = {place}\naxis = {axis}\nradius = 0.1\n"
        )
    };
    format!(
        r#"
        run = {{ analysis = "statics", duration = 1 }}
        [[elements]]
        type = "cable"
        name = "rope"
        section = {{ mass = 0.1, ea = 1e5, gj = 2, rotary_inertia = 1e-3 }}
        tension = 200
        elements = 2
        route = [{{ round = "a" }}, {{ round = "b" }}, {{ round = "c" }}]
        {more}
        {}{}{}
        {records}
        "#,
        wheel("a", "[0, 0, 0]", "[0, 1, 0]"),
        wheel("b", "[2, 0, 0]", "[0.3, 1, 0.2]"),
        wheel("c", "[1, 0.2, -2]", "[-0.2, 1, 0.3]"),
    )
}

#[test]
fn a_closed_belt_spreads_the_twist_that_its_way_gives_it() {
    let (_, columns) = observed(3, &["a", "b", "c"]);
    let history = run(&belted(""));
    let twist: Vec<f64> = columns.iter().map(|column| last(&history, column)).collect();
    println!("{twist:?}");
    assert!(twist[0].abs() > 1e-3, "{twist:?}");
    assert!(twist.iter().all(|k| (k / twist[0] - 1.0).abs() < 1e-5), "{twist:?}");
}

#[test]
fn torsion_over_wheels_goes_through_checkpoints_to_the_last_bit() {
    let file = SceneFile::parse(&running(0.05), "scene", Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}"));
    let scene = file.into_scene();
    let model = || scene.build().unwrap_or_else(|e| panic!("{e}"));
    let mut whole = Simulation::new(model(), &scene.solver, scene.run.duration).expect("a start");
    whole.advance(0.4, 0.4, &mut ()).expect("run");
    let checkpoint = whole.checkpoint().expect("checkpoint");
    whole.advance(0.8, 0.2, &mut ()).expect("run");
    let mut again =
        Simulation::restore(model(), &scene.solver, scene.run.duration, checkpoint).expect("fits");
    again.advance(0.8, 0.2, &mut ()).expect("run");
    assert_eq!((again.state, again.audit), (whole.state, whole.audit));
}

#[test]
fn what_leads_a_cable_is_not_to_break() {
    let broken = |of: &str| {
        format!("[[constraints]]\ntype = \"break\"\nname = \"pin\"\nconstraint = \"{of}\"\nforce = 1000\n")
    };
    let ring = ringed(BLOCK, "[2, 1, 0.2]");
    for (text, of) in [
        (&*ring, "ring.in"),
        (&*ring, "ring"),
        (&*ring, "ring: torsion"),
        (&*ring, "wheel"),
        (DRUM, "drum.rope"),
    ] {
        let message = refused(&(text.to_string() + &broken(of)));
        assert!(message.contains("break what carries"), "{of}: {message}");
    }
}

#[test]
fn what_cannot_be_twisted_over_wheels_is_refused_with_its_reason() {
    let cases = [
        (BLOCK.replace("mass = 1.5,", "mass = 1.5, ei = [1, 2],"), "give one stiffness"),
        (BLOCK.replace("mass = 1.5,", "mass = 1.5, gyroscopic = true,"), "turns nothing aside"),
        (BLOCK.replace("gj = 30, ", ""), "a torsional stiffness, `gj`"),
        (ringed(BLOCK, "[2, 1, 0.2]") + "friction = 0.1\n", "leave `friction` out"),
        (ringed(BLOCK, "[2, 1, 0.2]").replace("ei = 2,", ""), "give it `section.ei`"),
        (ringed(BLOCK, "[5, 3, 3]"), "the cable doubles back at `ring`"),
        (DRUM.replace("gj = 5,", "gj = 5, torque_tension = 10,"), "can't be wound on a drum"),
        (belted("laid_twist = 1"), "a closed belt is joined"),
        (
            belted("").replace("{ round = \"c\" }", "{ through = \"ring\" }")
                + "[[constraints]]\ntype = \"ring\"\nname = \"ring\"\nmarker = [1, 0, -2]\n",
            "which a ring at a point can't hold",
        ),
    ];
    for (text, reason) in cases {
        let message = refused(&text);
        assert!(message.contains(reason), "{message}\nbut not: {reason}");
    }
}
