//! Cables that are bent when free of stress, against closed forms of a quarter of a circle.

use ropewalk::{ModesOptions, modes, simulate};
use ropewalk_constraints::ClampSpec;
use ropewalk_core::statics::{Statics, StaticsOptions};
use ropewalk_core::{Quantity, V3};
use ropewalk_elements::cable::{Integration, LongitudinalModel, StressFree, TransverseModel};
use ropewalk_elements::{CableSpec, Section};
use ropewalk_forces::{PointForceSpec, TimeFunction};
use ropewalk_scene::Scene;
use std::f64::consts::{FRAC_PI_2, PI};

/// From the origin along x up to (1, 0, 1), built in at its foot, of bending stiffness 1 N m².
fn arc(elements: usize, gj: Option<f64>, load: V3<f64>) -> Scene {
    let place = |k: usize| {
        let (sin, cos) = (FRAC_PI_2 * k as f64 / 40.0).sin_cos();
        [sin, 0.0, 1.0 - cos]
    };
    let mut scene = Scene::new();
    let section = Section { gj, ..Section::new(1.0, 1e5, 1.0) };
    let straight = CableSpec::straight("arc", [0.0; 3], [1.0, 0.0, 1.0], elements, section);
    scene
        .element(CableSpec {
            points: vec![],
            curve: (0..=40).map(place).collect(),
            stress_free: StressFree::AsLaid,
            ..straight
        })
        .constraint(ClampSpec::new("foot", "arc.start"));
    if load != [0.0; 3] {
        scene.force(PointForceSpec::new("arc.end", load, TimeFunction::default()));
    }
    scene
}

/// Displacement of the tip, and the bending moment at the foot.
fn bent(scene: &Scene) -> (V3<f64>, f64) {
    let model = scene.build().unwrap_or_else(|e| panic!("{e}"));
    let mut state = model.state();
    let mut search = Statics::new(&model, &StaticsOptions::default()).expect("memory");
    search.find(&mut state, true).unwrap_or_else(|e| panic!("{e}"));
    let part = model.part("arc").expect("arc");
    let tip = part.point(part.length(), &state.at()).expect("its end").0;
    let moment = part.observe(Quantity::Moment, 0.0, &state.at()).expect("a moment");
    ([tip[0] - 1.0, tip[1], tip[2] - 1.0], moment)
}

#[test]
fn a_quarter_of_a_circle_has_its_stiffness_in_and_out_of_its_plane() {
    let load = 1e-3;
    // Castigliano: in the plane the moments are P cos a and P (1 - sin a); out of it P sin a bends and P (1 - cos a) twists
    let squares = [0.25 * PI, 0.75 * PI - 2.0];
    for (axis, exact) in [(0, squares[0]), (2, squares[1])] {
        let mut force = [0.0; 3];
        force[axis] = load;
        let (tip, moment) = bent(&arc(12, None, force));
        let off = tip[axis] / (load * exact) - 1.0;
        println!("in the plane, axis {axis}: {off:.1e}, moment {:.1e}", moment / load - 1.0);
        assert!(off.abs() < 3e-3 && (moment / load - 1.0).abs() < 2e-2, "{tip:?} {moment}");
    }
    for gj in [0.4, 1.0, 1e3] {
        let exact = load * (squares[0] + squares[1] / gj);
        let mut errors = Vec::new();
        for elements in [6, 12] {
            let (tip, _) = bent(&arc(elements, Some(gj), [0.0, load, 0.0]));
            errors.push((tip[1] / exact - 1.0).abs());
        }
        println!("out of the plane, GJ {gj}: {errors:?}");
        assert!(errors[1] < 3e-3, "{gj}: {errors:?}");
    }
    // left out, GJ is EI: 1.1416 mm
    let (tip, _) = bent(&arc(12, None, [0.0, load, 0.0]));
    assert!((tip[1] / 1.141_592_7e-3 - 1.0).abs() < 3e-3, "{tip:?}");
}

#[test]
fn a_bent_cable_vibrates_in_all_directions_and_keeps_its_energy() {
    let found = modes(&arc(12, None, [0.0; 3]), &ModesOptions { count: 6, ..ModesOptions::default() })
        .unwrap_or_else(|e| panic!("{e}"));
    assert!(found.warnings.is_empty() && !found.unstable, "{:?}", found.warnings);
    assert!(found.modes.iter().all(|m| !m.rigid && m.omega > 0.5), "{:?}", found.modes);

    let mut scene = arc(8, None, [0.0, 0.2, 0.1]);
    scene.run.duration = 2.0;
    scene.run.audit = true;
    let out = simulate(&scene).unwrap_or_else(|e| panic!("{e}"));
    let (imbalance, scale) = (out.audit.imbalance(), out.audit.scale);
    println!("{:e} of {scale:e}", imbalance);
    assert!(imbalance.abs() < 1e-2 * scale);
}

#[test]
fn a_curvature_without_a_direction_is_refused() {
    let mut scene = arc(8, None, [0.0; 3]);
    let section = Section::new(1.0, 1e5, 1.0);
    scene.elements.clear();
    scene.element(CableSpec {
        curve: vec![[0.0; 3], [0.7, 0.0, 0.3], [1.0, 0.0, 1.0]],
        points: vec![],
        stress_free: StressFree::AsLaid,
        ..CableSpec::straight("arc", [0.0; 3], [1.0, 0.0, 1.0], 8, section).models(
            LongitudinalModel::L2,
            TransverseModel::T1,
            Integration::Full,
        )
    });
    let told = scene.build().err().expect("refused").to_string();
    assert!(told.contains("T1 has no direction") && told.contains("needs T3"), "{told}");
}
