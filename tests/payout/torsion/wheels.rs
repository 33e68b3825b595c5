//! Twist of a rope that lies on wheels.

use super::{BLOCK, build, last, list, observed, random, term, turned, wrung};
use crate::reeving::run;
use ropewalk_core::model::twist::{between, section};
use ropewalk_core::rotation::cross;
use ropewalk_core::testing::{check_tangent, dense, difference};
use ropewalk_core::{At, Spot, Weights, Width, dot, retract};
use std::f64::consts::{FRAC_PI_2, PI};

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

/// A belt about wheels whose planes cross.
pub(super) fn belted(more: &str) -> String {
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
