//! Chains of rigid links against references that solve them otherwise.

use crate::common::{data, law, number};
use ropewalk::simulate;
use ropewalk_constraints::motion::{CircleSpec, Towards};
use ropewalk_constraints::{DrivingSpec, RevoluteSpec, SphericalSpec};
use ropewalk_core::integrator::{NewtonPolicy, Options, Scheme, Stepping};
use ropewalk_core::{BuildError, Motion, Moving, Quantity};
use ropewalk_elements::rigid_chain::LinkSection;
use ropewalk_elements::{PointMassSpec, RigidChainSpec};
use ropewalk_forces::{AddedMassSpec, BuoyancySpec, DragSpec, GravitySpec, Theory};
use ropewalk_scene::records::{AlongSpec, PositionSpec, ReactionPart, ReactionSpec, RecordPlace};
use ropewalk_scene::{MotionSpec, Scene, Water};
use serde_json::Value;
use std::sync::Arc;

/// The way of the upper end of the reference: `(Ax (1 - cos wx t), Ay (1 - cos wy t) sin wx t, 0)`.
#[derive(Debug, serde::Serialize, serde::Deserialize)]
struct Sway {
    a: [f64; 2],
    w: [f64; 2],
}

#[typetag::serde(name = "sway")]
impl MotionSpec for Sway {
    fn name(&self) -> &str {
        "sway"
    }
    fn build(&self, _: &[Arc<dyn Motion>]) -> Result<Arc<dyn Motion>, BuildError> {
        Ok(Arc::new(Sway { ..*self }))
    }
}

impl Motion for Sway {
    fn at(&self, t: f64) -> Moving {
        let ([ax, ay], [p, q]) = (self.a, self.w);
        let ((sp, cp), (sq, cq)) = ((p * t).sin_cos(), (q * t).sin_cos());
        Moving {
            x: [ax * (1.0 - cp), ay * (1.0 - cq) * sp, 0.0],
            v: [ax * p * sp, ay * (q * sq * sp + (1.0 - cq) * p * cp), 0.0],
            a: [
                ax * p * p * cp,
                ay * (q * q * cq * sp + 2.0 * q * sq * p * cp - (1.0 - cq) * p * p * sp),
                0.0,
            ],
        }
    }
}

fn positions(of: &str) -> PositionSpec {
    PositionSpec::new(of)
}

/// The chain of the reference, in vacuum or in water.
fn swaying(reference: &Value, case: &Value) -> Scene {
    let p = |name: &str| number(&reference["params"][name]);
    let (n, l, m) = (p("N") as usize, p("l"), p("m"));
    let mut points = vec![[0.0; 3]];
    for i in 0..n {
        let (th, ph) = ((35.0 * (0.25 * i as f64).cos()).to_radians(), (12.0 * i as f64).to_radians());
        let d = [th.sin() * ph.cos(), th.sin() * ph.sin(), -th.cos()];
        let last = points[i];
        points.push(std::array::from_fn(|k| last[k] + l * d[k]));
    }
    // a rod without thickness, but for its drag
    let mut section = LinkSection { gyration: Some(1e-5), ..LinkSection::new(m / l, 0.0) };
    let mut scene = Scene::new();
    let weight = number(&case["weight_factor"]);
    scene.set_gravity([0.0, 0.0, -weight * p("g")]).force(GravitySpec::default());
    if let Some(drag) = case["drag"].as_object() {
        section.diameter = number(&drag["dia"]);
        scene.water = Some(Water { density: number(&drag["rho"]), ..Water::default() });
        scene.force(DragSpec { cn: number(&drag["Cn"]), ct: number(&drag["Ct"]), ..DragSpec::default() });
    }
    scene
        .element(RigidChainSpec::new("chain", points, n, section))
        .motion(Sway { a: [p("Ax"), p("Ay")], w: [p("wx"), p("wy")] })
        .constraint(DrivingSpec::new("drive", "chain.start", "sway"))
        .record(positions("chain.end"))
        .record(positions("chain@2.5m"))
        .record(ReactionSpec { of: "drive".into(), what: ReactionPart::Force, name: None, title: None });
    scene.run.duration = p("T");
    scene.run.output = 0.2;
    scene.solver = Options {
        scheme: Scheme::RadauIia5,
        stepping: Stepping::Controlled { tolerance: 1e-9 },
        ..Options::default()
    };
    scene
}

#[test]
fn a_swaying_chain_goes_where_the_reference_goes() {
    let reference = data("chain10.json");
    for (name, place, force) in [("vacuum", 1e-6, 1e-4), ("water", 1e-6, 1e-4)] {
        let case = &reference[name];
        let history = simulate(&swaying(&reference, case)).unwrap_or_else(|e| panic!("{e}"));
        let rows = case["rows"].as_array().expect("rows");
        assert_eq!(history.times().len(), rows.len());
        let (mut tip, mut pull, mut size) = (0.0_f64, 0.0_f64, 0.0_f64);
        for (k, row) in rows.iter().enumerate() {
            let mut compare = |column: &str, exact: &Value, worst: &mut f64| {
                let got = history.column(column).expect(column)[k];
                let error = (got - number(exact)).abs();
                *worst = if error.is_nan() { f64::INFINITY } else { worst.max(error) };
                size = size.max(if column.starts_with("drive") { got.abs() } else { 0.0 });
            };
            for (i, axis) in ["x", "y", "z"].iter().enumerate() {
                compare(&format!("chain.end.{axis}"), &row["tip"][i], &mut tip);
                compare(&format!("chain@2.5m.{axis}"), &row["joint5"][i], &mut tip);
                compare(&format!("drive.f{axis}"), &row["F_driven_end"][i], &mut pull);
            }
        }
        println!(
            "{name}: places to {tip:.1e} m, reactions to {pull:.1e} N of {size:.0} N, {:?}",
            history.counts
        );
        assert!(tip < place && pull < force * size, "{name}: {tip:e} {pull:e}");
    }
}

#[test]
fn the_joints_of_a_hanging_chain_carry_what_hangs_below() {
    let (mass, length, load, g) = (0.8, 2.0, 3.0, 9.81);
    for hangs in [false, true] {
        let mut scene = Scene::new();
        let section = LinkSection { gyration: Some(1e-3), ..LinkSection::new(mass, 0.0) };
        scene.set_gravity([0.0, 0.0, -g]).force(GravitySpec::default());
        scene.element(RigidChainSpec::new("chain", vec![[0.0; 3], [0.0, 0.0, -length]], 5, section));
        scene.constraint(SphericalSpec::pin("top", "chain.start"));
        if hangs {
            scene.element(PointMassSpec::new("load", [0.0, 0.0, -length], load));
            scene.constraint(SphericalSpec::new("hook", "load", "chain.end"));
        }
        for at in [RecordPlace::Start, RecordPlace::At(0.8), RecordPlace::At(1.0), RecordPlace::End] {
            scene.record(AlongSpec::new("chain", Quantity::Tension, at));
        }
        (scene.run.duration, scene.run.output) = (0.1, 0.05);
        let history = simulate(&scene).unwrap_or_else(|e| panic!("{e}"));
        let below = if hangs { load * g } else { 0.0 };
        for (name, s) in [("chain.start", 0.0), ("chain@0.8m", 0.8), ("chain@1m", 1.0), ("chain.end", 2.0)] {
            // between two joints it changes along a line
            let exact = mass * g * (length - s) + below;
            for got in history.column(&format!("{name}.tension")).expect(name) {
                assert!((got - exact).abs() < 1e-9 * mass * g * length, "{name}: {got} {exact}");
            }
        }
    }
    // a place beside it, and what it doesn't know
    let section = LinkSection { gyration: Some(1e-3), ..LinkSection::new(mass, 0.0) };
    for (what, at, words) in
        [(Quantity::Tension, 2.5, "chain"), (Quantity::Curvature, 1.0, "rigid_chain, which has no curvature")]
    {
        let mut scene = Scene::new();
        scene.element(RigidChainSpec::new("chain", vec![[0.0; 3], [2.0, 0.0, 0.0]], 5, section.clone()));
        scene.record(AlongSpec::new("chain", what, RecordPlace::At(at)));
        let refused = simulate(&scene).err().expect("refused").to_string();
        assert!(refused.contains(words), "{refused}");
    }
}

/// The hose of the towing references as a chain of `n` links, on a ship that goes round.
fn turning(case: &Value, n: usize) -> Scene {
    let section = LinkSection {
        flooded: 0.361,
        displaced: Some((0.5 - 4.271 / 9.81) / 1025.0),
        joint_damping: 0.01,
        ..LinkSection::new(0.5, 0.023)
    };
    let law = law(&case["model"]);
    let mut scene = Scene::new();
    scene.water = Some(Water::default());
    scene
        .element(RigidChainSpec::new("hose", vec![[0.0; 3], [-30.0, 0.0, 0.0]], n, section))
        .motion(CircleSpec {
            name: "course".into(),
            speed: number(&case["U"]),
            radius: number(&case["R"]),
            heading: [1.0, 0.0, 0.0],
            towards: Towards::Port,
            start: 0.0,
            ramp: 5.0,
        })
        .constraint(DrivingSpec::new("ship", "hose.start", "course"))
        .force(GravitySpec::default())
        .force(BuoyancySpec::default())
        .force(DragSpec { normal: law, tangential: law, ..DragSpec::default() })
        // as the reference has it
        .force(AddedMassSpec { theory: Some(Theory::Morison), ..AddedMassSpec::default() })
        .record(positions("hose.end"))
        .record(ReactionSpec { of: "ship".into(), what: ReactionPart::Magnitude, name: None, title: None });
    scene.run.duration = 60.0;
    scene.run.output = 60.0;
    scene.run.audit = false;
    scene.solver = Options {
        scheme: Scheme::GeneralizedAlpha { rho_inf: 0.0 },
        stepping: Stepping::Controlled { tolerance: 1e-5 },
        ..Options::default()
    };
    scene
}

#[test]
fn links_converge_to_the_steady_tow_of_the_hose() {
    let all = data("tow_turn.json");
    let case =
        all["cases"].as_array().expect("cases").iter().find(|c| c["kn"] == 15 && c["model"] == "const");
    let case = case.expect("15 kn");
    let exact = &case["solutions"][0];
    let mut errors = Vec::new();
    for n in [4, 8, 16] {
        let history = simulate(&turning(case, n)).unwrap_or_else(|e| panic!("{e}"));
        let height = history.last("hose.end.z").expect("height") - number(&exact["end_height"]);
        let pull = history.last("ship.magnitude").expect("pull") / number(&exact["T_top"]) - 1.0;
        println!("{n} links: height {height:.2e} m, tension {pull:.2e}, {:?}", history.counts);
        errors.push([height.abs(), pull.abs()]);
    }
    for k in 0..2 {
        let order = (errors[1][k] / errors[2][k]).log2();
        println!("order {order:.2}");
        assert!(order > 1.7, "{errors:?}");
    }
    assert!(errors[2][0] < 1e-2 && errors[2][1] < 5e-3, "{errors:?}");
}

#[test]
fn a_hinge_holds_a_chain_in_its_plane() {
    // a revolute joint beside spherical ones: what the connection of a hose is made of
    let mut scene = Scene::new();
    let section = LinkSection::new(1.0, 0.05);
    scene
        .element(RigidChainSpec::new("chain", vec![[0.0; 3], [1.0, 0.0, 0.0]], 1, section))
        .constraint(RevoluteSpec {
            name: "hinge".into(),
            marker: "chain.start".into(),
            to: None,
            axis: [0.0, 1.0, 0.0],
        })
        .force(GravitySpec::default())
        .record(positions("chain.end"));
    scene.run.duration = 0.4;
    let history = simulate(&scene).unwrap_or_else(|e| panic!("{e}"));
    let y = history.column("chain.end.y").expect("y");
    assert!(y.iter().all(|y| y.abs() < 1e-12));
    assert!(history.last("chain.end.z").expect("z") < -0.5);
}

/// Matrices are made for rotations from where a link is, and its increment counts from the start of the step: where the one is
/// taken for the other, a step has five iterations here, and twice as many where links turn twice as far.
#[test]
fn full_newton_converges_fast_however_far_links_turn_in_a_step() {
    let points: Vec<[f64; 3]> = (0..=10).map(|k| [0.1 * k as f64, 0.03 * (k % 3) as f64, 0.0]).collect();
    let mut scene = Scene::new();
    scene
        .element(RigidChainSpec::new("chain", points, 10, LinkSection::new(1.0, 0.02)))
        .constraint(SphericalSpec::new("hinge", "chain.start", [0.0; 3]))
        .force(GravitySpec::default());
    scene.run.duration = 0.4;
    scene.solver =
        Options { stepping: Stepping::Fixed { h: 0.01 }, newton: NewtonPolicy::Full, ..Options::default() };
    let counts = simulate(&scene).unwrap_or_else(|e| panic!("{e}")).counts;
    let each = counts.newton_iterations as f64 / counts.steps as f64;
    println!("{each} iterations a step");
    assert!(each < 4.5, "{each}");
}
