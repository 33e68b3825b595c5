//! Linkages at the end of the way that their constraints leave, and at dead points, are told of as what they are.

use crate::mechanisms::{Angle, controlled, drive, hinge, radau, rod, start};
use ropewalk::constraints::{DistanceSpec, PrismaticSpec};
use ropewalk::elements::RigidBodySpec;
use ropewalk::scene::Scene;
use std::f64::consts::FRAC_PI_2;

/// A bar of 1 m on two cranks or more of 0.2 m that stand at an angle, of which the first is driven.
fn cranks(count: usize, angle: f64) -> Scene {
    let (mut scene, way) = (Scene::new(), [0.2 * angle.cos(), 0.2 * angle.sin(), 0.0]);
    let places: Vec<f64> = (0..count).map(|k| k as f64 / (count - 1) as f64).collect();
    let mut bar = rod("bar", way, [way[0] + 1.0, way[1], 0.0], 1.0);
    for (k, &x) in places.iter().enumerate() {
        bar = bar.with_point(&format!("p{k}"), [x, 0.0, 0.0]);
    }
    scene.element(bar);
    for (k, &x) in places.iter().enumerate() {
        let crank = format!("crank{k}");
        scene.element(rod(&crank, [x, 0.0, 0.0], [x + way[0], way[1], 0.0], 1.0));
        scene.constraint(hinge(&format!("ground{k}"), &crank, [x, 0.0, 0.0]));
        let end = format!("{crank}.end");
        scene.constraint(hinge(&format!("pin{k}"), &format!("bar.p{k}"), end.as_str()));
    }
    drive(&mut scene, "crank0", [0.0, 0.0, 1.0], Angle::SpinUp(6.0, 1.0));
    scene
}

fn starts_dead(scene: &Scene) -> bool {
    let model = scene.build().unwrap_or_else(|e| panic!("{e}"));
    model.redundancy().expect("it is held more often than need be").dead_point
}

/// A table on two rails goes straight: what its motion bends by is rounding, and no dead point.
#[test]
fn what_slides_on_two_rails_is_at_no_dead_point() {
    for (size, axis) in [(1.0, [0.6, 0.7, 0.39]), (1e3, [0.6, 0.7, 0.39]), (1e-3, [1.0, 0.0, 0.0])] {
        let at = |p: [f64; 3]| p.map(|x| size * x);
        let table =
            RigidBodySpec::new("table", at([0.3, 0.2, 0.1]), 1.0, [0.1, 0.2, 0.3].map(|j| size * size * j))
                .with_point("a", at([0.1, 0.3, 0.0]))
                .with_point("b", at([0.13, -0.37, 0.05]));
        let mut scene = Scene::new();
        scene.element(table);
        for (name, marker) in [("left", "table.a"), ("right", "table.b")] {
            scene.constraint(PrismaticSpec { name: name.into(), marker: marker.into(), to: None, axis });
        }
        assert!(!starts_dead(&scene), "{size} m along {axis:?}");
    }
}

/// Where all cranks point along the bar they may go on alike or against each other; elsewhere a bar with many cranks is but held
/// more often than need be, driven or not.
#[test]
fn a_dead_point_at_the_start_is_told_from_constraints_that_repeat_others() {
    for count in [2, 3] {
        for (angle, is) in [(0.0, true), (0.3, false), (FRAC_PI_2, false)] {
            assert_eq!(starts_dead(&cranks(count, angle)), is, "{count} cranks at {angle}");
            let mut idle = cranks(count, angle);
            idle.constraints.retain(|c| c.name() != "drive");
            assert_eq!(starts_dead(&idle), is, "{count} cranks at {angle}, not driven");
        }
    }
}

/// Crank and lever of 1 m, two metres apart, with a rod between them that was laid across: the crank can't go round.
#[test]
fn what_is_driven_to_the_end_of_its_way_says_so() {
    let mut scene = Scene::new();
    let lever = [2.0 + 2.0_f64.cos(), 2.0_f64.sin(), 0.0];
    scene
        .element(rod("crank", [0.0; 3], [1.0, 0.0, 0.0], 1.0))
        .element(rod("lever", [2.0, 0.0, 0.0], lever, 1.0))
        .constraint(hinge("left", "crank", [0.0; 3]))
        .constraint(hinge("right", "lever", [2.0, 0.0, 0.0]))
        .constraint(DistanceSpec {
            name: "coupler".into(),
            marker: "crank.end".into(),
            to: "lever.end".into(),
            length: None,
        });
    drive(&mut scene, "crank", [0.0, 0.0, 1.0], Angle::SpinUp(1.5, 1.0));
    for options in [controlled(1e-4), radau(1e-4)] {
        let mut s = start(&scene, &options, 3.0);
        let e = s.advance(3.0, f64::INFINITY, &mut ()).expect_err("it goes on").to_string();
        let names =
            "`left`, `right`, `coupler`, `drive` at a dead point, or at the end of the way that they leave";
        assert!(e.contains(names), "{e}");
        assert!((s.state.t - 1.4348).abs() < 1e-3, "{}", s.state.t);
    }
}
