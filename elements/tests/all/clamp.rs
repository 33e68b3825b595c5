//! Built-in ends: what a clamp holds of cables and bodies.

use ropewalk_constraints::{ClampSpec, DirectionSpec, SphericalSpec};
use ropewalk_elements::{CableSpec, PointMassSpec, RigidBodySpec, Section};
use ropewalk_scene::Scene;

fn cable() -> Scene {
    let mut scene = Scene::new();
    scene
        .element(CableSpec::straight(
            "line",
            [1.0, 0.0, 0.0],
            [2.0, 2.0, 1.0],
            3,
            Section::new(1.0, 1e3, 1.0),
        ))
        .element(RigidBodySpec::new("hub", [0.0; 3], 2.0, [1.0; 3]).with_point("eye", [1.0, 0.0, 0.0]));
    scene
}

/// Errors and Jacobians of all constraints, one below the other, and the rows of each.
fn rows(scene: &Scene) -> (Vec<f64>, Vec<f64>, Vec<usize>) {
    let model = scene.build().unwrap_or_else(|e| panic!("{e}"));
    let mut state = model.state();
    // off its start
    for (k, q) in state.q.iter_mut().enumerate() {
        *q += 0.01 * (k as f64).sin();
    }
    let (mut errors, mut jacobians, mut counts) = (Vec::new(), Vec::new(), Vec::new());
    for c in model.constraints() {
        let columns: usize = c.nodes().iter().map(|n| model.nodes()[n.0 as usize].dofs().len()).sum();
        let (mut g, mut jac) = (vec![0.0; c.rows().len()], vec![0.0; c.rows().len() * columns]);
        c.jacobian(model.nodes(), &state.at(), &mut g, &mut jac);
        counts.push(g.len());
        errors.extend(g);
        jacobians.extend(jac);
    }
    (errors, jacobians, counts)
}

#[test]
fn a_cable_is_held_at_its_point_and_along_its_tangent() {
    let to = |on: Option<&str>| on.map(Into::into);
    for (on, given) in [(None, None), (Some("hub.eye"), None), (None, Some([1.0, 2.0, 1.5]))] {
        let (mut one, mut two) = (cable(), cable());
        one.constraint(ClampSpec { to: to(on), direction: given, ..ClampSpec::new("root", "line.start") });
        two.constraint(SphericalSpec { to: to(on), ..SphericalSpec::pin("pin", "line.start") }).constraint(
            DirectionSpec { to: to(on), direction: given, ..DirectionSpec::new("root", "line.start") },
        );
        let (one, two) = (rows(&one), rows(&two));
        assert_eq!((one.2.as_slice(), two.2.as_slice()), ([5].as_slice(), [3, 2].as_slice()));
        assert!(one.0.iter().any(|g| *g != 0.0));
        assert_eq!((one.0, one.1), (two.0, two.1), "{on:?} {given:?}");
    }
}

#[test]
fn a_body_is_held_as_it_stands() {
    for marker in ["hub", "hub.eye"] {
        let mut scene = cable();
        scene.constraint(ClampSpec::new("root", marker));
        let model = scene.build().unwrap_or_else(|e| panic!("{e}"));
        let state = model.state();
        let c = &model.constraints()[0];
        let (mut g, mut jac) = (vec![1.0; 6], vec![0.0; 36]);
        assert_eq!(c.rows().len(), 6);
        c.jacobian(model.nodes(), &state.at(), &mut g, &mut jac);
        assert!(g.iter().all(|g| g.abs() < 1e-15), "{g:?}");
        let jac = nalgebra::DMatrix::from_row_slice(6, 6, &jac);
        assert!(jac.determinant().abs() > 1e-3, "{jac}");
    }
}

#[test]
fn what_can_not_be_clamped_is_refused() {
    let refused = |spec: ClampSpec| {
        let mut scene = cable();
        scene.element(PointMassSpec::new("bob", [5.0, 0.0, 0.0], 1.0)).constraint(spec);
        scene.build().err().map_or_else(String::new, |e| e.to_string())
    };
    let direction = Some([1.0, 0.0, 0.0]);
    let on_body = refused(ClampSpec { direction, ..ClampSpec::new("root", "hub") });
    assert!(on_body.contains("leave `direction` out"), "{on_body}");
    assert!(!refused(ClampSpec::new("root", "bob")).is_empty());
    let zero = refused(ClampSpec { direction: Some([0.0; 3]), ..ClampSpec::new("root", "line.end") });
    assert!(zero.contains("`direction`"), "{zero}");
    println!("{}", refused(ClampSpec::new("root", "bob")));
}
