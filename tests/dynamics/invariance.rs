//! What must not matter: where a scene stands and how it is turned, in which order its parts are listed, which marker of
//! a joint comes first, which end a cable begins at.

use crate::common::{models, place};
use crate::mechanisms::{
    Stand, attitude, dzhanibekov, go, largest, minus, pointing, slider_crank, squeezer, squeezer_angles,
    start, tight, whereabouts,
};
use ropewalk_constraints::{DirectionSpec, RevoluteSpec, SphericalSpec};
use ropewalk_core::V3;
use ropewalk_core::rotation::{bryant, exp, then};
use ropewalk_core::statics::{Statics, StaticsOptions};
use ropewalk_elements::{CableSpec, RigidBodySpec, Section};
use ropewalk_forces::{GravitySpec, PointForceSpec, PointMomentSpec, TimeFunction};
use ropewalk_scene::Scene;
use std::f64::consts::PI;

const FAR: V3<f64> = [1e3, -2e3, 5e2];

/// Two turns about odd axes, and half a turn about a skew one.
fn turns() -> [[f64; 4]; 3] {
    let skew = [1.0, 2.0, 3.0].map(|x: f64| PI * x / 14.0_f64.sqrt());
    [exp([0.3, -1.1, 0.7]), then(exp([0.0, 2.0, 0.4]), exp([-1.3, 0.0, 0.5])), exp(skew)]
}

/// Runs a scene as it is, turned, and turned and moved far away, and compares what `look` sees of it in its own axes.
fn stands(name: &str, run: impl Fn(&Stand) -> (Vec<V3<f64>>, u64, u64)) {
    let (plain, steps, iterations) = run(&Stand::UPRIGHT);
    let size = largest(plain.iter().flatten().copied());
    for (shift, limit) in [([0.0; 3], 1e-9), (FAR, 1e-7)] {
        for turn in turns() {
            let (seen, n, k) = run(&Stand { turn, shift });
            let off = largest(plain.iter().zip(&seen).flat_map(|(a, b)| minus(*a, *b))) / size;
            println!(
                "{name}, moved by {shift:?}: {off:.1e}, {n} and {k} instead of {steps} and {iterations}"
            );
            assert!(off < limit, "{name}, {turn:?}, {shift:?}: {off:e}");
            assert!(n.abs_diff(steps) <= 1 && k.abs_diff(iterations) <= 1 + steps, "{name}: {n} {k}");
        }
    }
}

#[test]
fn flipping_body_does_not_care_how_it_stands() {
    stands("free body", |stand| {
        let mut s = start(&dzhanibekov(stand), &tight(5e-3), 5.0);
        let mut seen = Vec::new();
        for k in 1..=5 {
            go(&mut s, f64::from(k));
            seen.push(attitude(&s.model, &s.state, "wing nut").1);
        }
        (seen, s.work.counts.steps, s.work.counts.newton_iterations)
    });
}

#[test]
fn slider_crank_does_not_care_how_it_stands() {
    stands("slider crank", |stand| {
        let mut s = start(&slider_crank(4e-4, stand, false), &tight(1e-3), 1.0);
        let mut seen = Vec::new();
        for k in 1..=10 {
            go(&mut s, 0.1 * f64::from(k));
            let [x, v] = whereabouts(&s.model, &s.state, "crank.pin");
            seen.extend([stand.point_back(x), stand.vector_back(v)]);
            seen.push(stand.point_back(whereabouts(&s.model, &s.state, "slider")[0]));
        }
        (seen, s.work.counts.steps, s.work.counts.newton_iterations)
    });
}

#[test]
fn flying_cable_does_not_care_how_it_stands() {
    stands("spaghetti", |stand| {
        let pull = || TimeFunction::Triangle { t0: 0.0, peak: 2.5, t1: 5.0 };
        let (from, to) = (stand.point([6.0, 0.0, 0.0]), stand.point([0.0, 8.0, 0.0]));
        let (l, t, i) = models("L4(lob3)+T3(2)").expect("legal");
        let mut scene = Scene::new();
        scene
            .element(CableSpec::straight("rod", from, to, 16, Section::new(1.0, 1e4, 500.0)).models(l, t, i))
            .force(PointForceSpec::new("rod.start", stand.vector([8.0, 0.0, 0.0]), pull()))
            .force(PointMomentSpec {
                marker: "rod.start".into(),
                local: false,
                moment: stand.vector([0.0, 0.0, -80.0]).map(Into::into),
                torque: None,
                time: pull(),
            });
        let mut s = start(&scene, &tight(5e-3), 2.0);
        let mut seen = Vec::new();
        for k in 1..=4 {
            go(&mut s, 0.5 * f64::from(k));
            seen.extend([0.0, 5.0, 10.0].map(|x| stand.point_back(place(&s.model, &s.state, "rod", x))));
        }
        (seen, s.work.counts.steps, s.work.counts.newton_iterations)
    });
}

#[test]
fn catenary_does_not_care_how_it_stands() {
    stands("catenary", |stand| {
        let (from, to) = (stand.point([0.0; 3]), stand.point([8.0, 0.0, -1.0]));
        let cable = CableSpec::straight("chain", from, to, 16, Section::new(2.0, 1e5, 0.5)).unstretched(10.0);
        let mut scene = Scene::new();
        scene
            .element(cable)
            .constraint(SphericalSpec::pin("left", "chain.start"))
            .constraint(SphericalSpec::pin("right", "chain.end"))
            .set_gravity(stand.vector([0.0, 0.0, -9.81]))
            .force(GravitySpec::default());
        let model = scene.build().expect("model");
        let mut state = model.state();
        let options = StaticsOptions { tolerance: 1e-12, ..StaticsOptions::default() };
        let mut statics = Statics::new(&model, &options).expect("statics");
        statics.find(&mut state, true).unwrap_or_else(|e| panic!("{e}"));
        let seen = (0..=10).map(|k| stand.point_back(place(&model, &state, "chain", f64::from(k))));
        (seen.collect(), 0, 0)
    });
}

#[test]
fn squeezer_does_not_care_in_which_order_it_is_listed() {
    let run = |order: &[usize; 7], redundant: bool| {
        let mut s = start(&squeezer(order, redundant), &tight(5e-6), 0.01);
        go(&mut s, 0.01);
        squeezer_angles(&s.model, &s.state).0
    };
    let plain = run(&[0, 1, 2, 3, 4, 5, 6], false);
    for order in [[6, 5, 4, 3, 2, 1, 0], [3, 0, 5, 1, 6, 2, 4]] {
        let off = largest(plain.iter().zip(run(&order, false)).map(|(a, b)| a - b));
        println!("{order:?}: {off:.1e}");
        assert!(off < 1e-9, "{order:?}: {off:e}");
    }
}

#[test]
fn slider_crank_does_not_care_which_marker_comes_first() {
    let run = |swapped: bool| {
        let mut s = start(&slider_crank(4e-4, &Stand::UPRIGHT, swapped), &tight(1e-3), 1.0);
        go(&mut s, 1.0);
        [whereabouts(&s.model, &s.state, "crank.pin"), whereabouts(&s.model, &s.state, "slider")].concat()
    };
    let (a, b) = (run(false), run(true));
    let off = largest(a.iter().zip(&b).flat_map(|(a, b)| minus(*a, *b)));
    println!("{off:.1e}");
    assert!(off < 1e-9, "{off:e}");
}

/// A body on a hinge, a cable built into it, and a second body at the cable's other end.
fn mixed(swapped: bool) -> Scene {
    let section = Section { axial_retardation_time: 1e-3, ..Section::new(0.8, 2e3, 0.3) };
    let (from, to) = ([0.5, 0.0, 0.0], [1.5, 0.0, 0.0]);
    let (first, last) = if swapped { (to, from) } else { (from, to) };
    let (near, far) = if swapped { ("cable.end", "cable.start") } else { ("cable.start", "cable.end") };
    let cable = CableSpec::straight("cable", first, last, 6, section);
    let arm = RigidBodySpec::new("arm", [0.25, 0.0, 0.0], 1.5, [0.02, 0.05, 0.06]);
    let bob = RigidBodySpec {
        angles: bryant(&pointing([1.0, 0.0, 0.0])),
        ..RigidBodySpec::new("bob", [1.6, 0.0, 0.0], 0.7, [0.004, 0.003, 0.005])
    };
    let arm = arm.with_point("root", [-0.25, 0.0, 0.0]).with_point("tip", [0.25, 0.0, 0.0]);
    let bob = bob.with_point("eye", [-0.1, 0.0, 0.0]);
    let hinge = RevoluteSpec {
        name: "hinge".into(),
        marker: "arm.root".into(),
        to: Some([0.0; 3].into()),
        axis: [0.2, 1.0, 0.1],
    };
    let clamp = DirectionSpec { to: Some("arm".into()), ..DirectionSpec::new("clamp", near) };
    let mut scene = Scene::new();
    if swapped {
        scene
            .element(bob)
            .element(cable)
            .element(arm)
            .constraint(SphericalSpec::new("eye", far, "bob.eye"))
            .constraint(clamp)
            .constraint(SphericalSpec::new("root", "arm.tip", near))
            .constraint(hinge);
    } else {
        scene
            .element(arm)
            .element(cable)
            .element(bob)
            .constraint(hinge)
            .constraint(SphericalSpec::new("root", near, "arm.tip"))
            .constraint(clamp)
            .constraint(SphericalSpec::new("eye", "bob.eye", far));
    }
    scene.set_gravity([0.0, 0.0, -9.81]).force(GravitySpec::default());
    scene
}

#[test]
fn cable_between_bodies_does_not_care_which_end_it_begins_at() {
    let run = |swapped: bool| {
        let mut s = start(&mixed(swapped), &tight(5e-4), 0.5);
        go(&mut s, 0.5);
        let middle = place(&s.model, &s.state, "cable", 0.5);
        [whereabouts(&s.model, &s.state, "arm.tip"), whereabouts(&s.model, &s.state, "bob"), [middle; 2]]
            .concat()
    };
    let (a, b) = (run(false), run(true));
    let off = largest(a.iter().zip(&b).flat_map(|(a, b)| minus(*a, *b)));
    println!("{off:.1e}");
    assert!(off < 1e-9, "{off:e}");
}
