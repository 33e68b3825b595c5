//! Which stiffness models go with torsion, and what a cable without it knows of it: nothing.

use super::{apart, place, run, scene};
use ropewalk_core::{NodeKind, System};
use ropewalk_scene::{Format, SceneFile};

/// The helix with other models; errors of its tip with 8, 16 and 32 elements.
fn helix(longitudinal: &str, transverse: &str) -> String {
    let models =
        format!("longitudinal = \"{longitudinal}\"\ntransverse = \"{transverse}\"\nelements = \"$n\"");
    include_str!("helix.toml").replace("ea = 1e6", "ea = 1e5").replace("elements = \"$n\"", &models)
}

fn refused(text: &str) -> String {
    let built = SceneFile::parse(text, "scene", Format::Toml, &[])
        .map_err(|e| e.to_string())
        .and_then(|f| f.scene().build().map(|_| ()).map_err(|e| e.to_string()));
    built.expect_err("refused")
}

/// The table of the specification, whose errors have two digits; L1n isn't in it.
#[test]
fn legal_pairs_wind_a_helix_as_well_as_they_should() {
    for (longitudinal, transverse, errors) in [
        ("L1", "T1", [2.1e-2, 5.5e-3, 1.3e-3]),
        ("L2", "T1", [1.0e-3, 2.5e-4, 2.1e-4]),
        ("L3", "T1", [1.4e-3, 2.8e-4, 2.1e-4]),
        ("L3", "T2", [2.7e-4, 2.0e-4, 2.0e-4]),
        ("L3", "T3", [5.7e-4, 3.6e-5, 2.2e-6]),
        ("L4", "T1", [1.4e-3, 2.8e-4, 2.1e-4]),
        ("L4", "T2", [2.7e-4, 2.0e-4, 2.0e-4]),
        ("L4", "T3", [5.7e-4, 3.6e-5, 2.2e-6]),
    ] {
        let text = helix(longitudinal, transverse).replace("steps = 40", "steps = 80");
        for (n, exact) in [8, 16, 32].into_iter().zip(errors) {
            let h = run(&text, &[format!("n={n}")]);
            let found = apart(place(&h, "rod.end"), [0.64, 0.0, 0.48]);
            assert!(
                (found / exact - 1.0).abs() < 0.06,
                "{longitudinal}+{transverse}, {n}: {found:e} {exact:e}"
            );
        }
    }
}

#[test]
fn pairs_that_leave_modes_without_energy_are_refused_with_torsion_too() {
    for longitudinal in ["L1", "L1n", "L2"] {
        for transverse in ["T2", "T3"] {
            let says = refused(&helix(longitudinal, transverse).replace("\"$n\"", "8"));
            assert!(says.contains("cost no energy"), "{says}");
        }
    }
    // bending with a direction has the measure of T3
    for (longitudinal, transverse) in [("L4", "T1"), ("L4", "T2"), ("L1", "T1"), ("L3", "T2")] {
        let text = helix(longitudinal, transverse).replace("ei = 1,", "ei = [1, 2],");
        let text = text.replace("elements = \"$n\"", "elements = 8\nnormal = [0, 0, 1]");
        let says = refused(&text);
        assert!(says.contains("needs T3"), "{says}");
    }
}

/// A cable without torsion; and one with torsion beside it, which nothing joins to it.
const PLAIN: &str = r#"
    [[elements]]
    type = "cable"
    name = "plain"
    points = [[0, 0, 0], [2, 0, 0]]
    elements = 5
    section = { mass = 0.3, ea = 1e4, ei = 0.2, bending_retardation_time = "1 ms" }
    [[constraints]]
    type = "clamp"
    name = "root"
    marker = "plain.start"
    [[forces]]
    type = "gravity"
"#;
const BESIDE: &str = r#"
    [[elements]]
    type = "cable"
    name = "twisted"
    points = [[0, 3, 0], [2, 3, 0]]
    elements = 5
    section = { mass = 0.3, ea = 1e4, ei = 0.2, gj = 0.1 }
"#;

#[test]
fn a_cable_without_torsion_is_as_it_was() {
    let build = |text: &str| scene(text, &[]).build().unwrap_or_else(|e| panic!("{e}"));
    let alone = build(PLAIN);
    assert!(alone.nodes().iter().all(|n| n.kind == NodeKind::Slope));
    assert_eq!((alone.state().q.len(), alone.velocities()), (36, 36));
    let labels: Vec<String> = alone.terms().iter().map(|t| t.label()).collect();
    assert_eq!(labels, ["cable L4+T3 locking-free", "bending damping g2", "plain: weight"]);
    // nor does what is written of it say anything new
    let plain = scene(PLAIN, &[]);
    let written = serde_json::to_string(&*plain.elements[0]).expect("written");
    for field in ["gj", "twist", "normal", "rotary", "torsion", "gyroscopic", "torque"] {
        assert!(!written.contains(field), "{field} in {written}");
    }
    // the same forces to the last bit if there is another with torsion
    let both = build(&(PLAIN.to_string() + BESIDE));
    assert_eq!((both.state().q.len(), both.velocities()), (36 + 60, 36 + 42));
    let forces = |model: &ropewalk_core::Model| {
        let mut state = model.state();
        for (k, q) in state.q.iter_mut().take(36).enumerate() {
            *q += 0.05 * (1.7 * (k as f64 + 1.0)).sin();
        }
        for (k, v) in state.v.iter_mut().take(36).enumerate() {
            *v += 0.3 * (0.9 * (k as f64 + 1.0)).cos();
        }
        let mut system = System::default();
        model.assemble(&state.at(), &state.lambda, None, &mut system);
        system.residual[..36].to_vec()
    };
    assert_eq!(forces(&alone), forces(&both));
}
