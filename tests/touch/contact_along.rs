//! Contact along slender parts: what it does must not depend on where the nodes are.

use ropewalk_constraints::{CoordinateSpec, DirectionSpec, SphericalSpec};
use ropewalk_core::integrator::{Options, Scheme, StepReport, Stepping};
use ropewalk_core::statics::{Statics, StaticsOptions};
use ropewalk_core::{End, Model, Observer, Quantity, Simulation, State};
use ropewalk_elements::cable::{Integration, LongitudinalModel, TransverseModel};
use ropewalk_elements::{CableSpec, Section};
use ropewalk_forces::contact::{ContactSpec, Overlap, ShapeSpec};
use ropewalk_forces::{GravitySpec, PointForceSpec, TimeFunction};
use ropewalk_scene::Scene;
use std::ops::ControlFlow;

const G: f64 = 9.81;

fn start(scene: &Scene, stepping: Stepping, duration: f64) -> Simulation {
    let options = Options { stepping, ..Options::default() };
    let model = scene.build().unwrap_or_else(|e| panic!("{e}"));
    Simulation::new(model, &options, duration).unwrap_or_else(|e| panic!("{e}"))
}

fn go(s: &mut Simulation, t: f64, observer: &mut dyn Observer) {
    assert_eq!(s.advance(t, f64::INFINITY, observer).unwrap_or_else(|e| panic!("{e}")), End::Done);
}

fn balance(scene: &Scene) -> (Model, State) {
    let model = scene.build().unwrap_or_else(|e| panic!("{e}"));
    let mut state = model.state();
    let found = Statics::new(&model, &StaticsOptions::default()).unwrap().find(&mut state, true);
    found.unwrap_or_else(|e| panic!("{e}"));
    (model, state)
}

#[track_caller]
fn near(got: f64, wanted: f64, relative: f64) {
    println!("{got} instead of {wanted}: {:.1e}", got / wanted - 1.0);
    assert!((got / wanted - 1.0).abs() < relative, "{got} instead of {wanted}");
}

/// What a force shows at a state: three components, normal force, depth, points, length.
fn shown(model: &Model, state: &State, force: &str) -> Vec<f64> {
    let term = model.terms().iter().find(|t| t.label() == force).expect(force);
    let mut out = Vec::new();
    term.shows().unwrap().observe(&state.at(), &mut out);
    out
}

fn plane() -> ContactSpec {
    ContactSpec::new("floor", ShapeSpec::Plane { normal: [0.0, 0.0, 1.0] })
}

fn bar(radius: f64) -> ContactSpec {
    ContactSpec::new("bar", ShapeSpec::Cylinder { axis: [0.0, 1.0, 0.0], radius, length: None })
}

#[test]
fn no_mesh_is_too_coarse_to_be_caught() {
    // a cable of 2 m that falls across a bar of 10 cm
    let section = Section { diameter: 0.01, ..Section::new(0.5, 1e5, 0.05) };
    for elements in [2, 3, 8, 32, 200] {
        let mut scene = Scene::new();
        scene
            .element(CableSpec::straight("c", [-1.07, 0.0, 0.1], [0.93, 0.0, 0.1], elements, section.clone()))
            .force(GravitySpec::default())
            .force(ContactSpec { stiffness_per_length: 1e6, ..bar(0.05) });
        let mut s = start(&scene, Stepping::Controlled { tolerance: 1e-4 }, 0.3);
        struct Most(f64);
        impl Observer for Most {
            fn step(&mut self, m: &Model, s: &State, _: &StepReport) -> ControlFlow<()> {
                self.0 = self.0.max(shown(m, s, "bar")[4]);
                ControlFlow::Continue(())
            }
        }
        let mut most = Most(0.0);
        go(&mut s, 0.3, &mut most);
        println!("{elements}: {:.3e} m deep, {:?}", most.0, s.work.counts);
        assert!(most.0 > 1e-5 && most.0 < 0.005, "{elements}: {}", most.0);
        assert!(s.audit.imbalance().abs() < 2e-2 * s.audit.scale, "{elements}: {:?}", s.audit);
    }
}

/// A taut cable of 2 m, pinned at both ends and pushed up by a bar beside its middle: depth, and tension at its start.
fn over_bar(elements: usize, beside: f64, reference: bool) -> [f64; 2] {
    let (ea, r, lift) = (1e5, 0.005, 0.05);
    let section = Section { diameter: 2.0 * r, ..Section::new(0.5, ea, 0.05) };
    let mut cable =
        CableSpec::straight("c", [0.0; 3], [1.0, 0.0, 0.0], elements, section).unstretched(2.0 / 1.001);
    if reference {
        cable = cable.models(LongitudinalModel::L3, TransverseModel::T1, Integration::Full);
    }
    let arch = |k: i32| f64::from(k) / 40.0;
    cable.points = Vec::new();
    cable.curve = (-40..=40).map(|k| [arch(k), 0.0, 1.04 * lift * (1.0 - arch(k).powi(2))]).collect();
    let mut scene = Scene::new();
    scene
        .element(cable)
        .constraint(SphericalSpec::pin("a", "c.start"))
        .constraint(SphericalSpec::pin("b", "c.end"))
        .force(ContactSpec {
            stiffness_per_length: 1e6,
            overlap: Overlap::Allow,
            marker: [beside, 0.0, lift - r - 0.05].into(),
            ..bar(0.05)
        });
    let (model, state) = balance(&scene);
    let tension = model.part("c").unwrap().observe(Quantity::Tension, 0.0, &state.at()).unwrap();
    [shown(&model, &state, "bar")[4], tension]
}

#[test]
fn the_depth_under_a_bar_hardly_depends_on_the_mesh() {
    // the cable's own curvature under the bar, which a coarse mesh smears, takes part in the depth
    for (beside, depth, tension) in
        [(0.0, 1.298_949_644e-3, 220.350_311_5), (0.037, 1.301_125_594e-3, 220.507_788_5)]
    {
        for (elements, within) in [(8, 0.06), (16, 0.06), (32, 0.02), (64, 0.02), (128, 0.002), (200, 0.002)]
        {
            let [d, t] = over_bar(elements, beside, true);
            near(d, depth, within);
            near(t, tension, if elements < 32 { 0.011 } else { 1e-3 });
        }
    }
    let fine = over_bar(400, 0.037, false)[0];
    for (elements, within) in [(8, 0.06), (32, 0.02), (128, 0.002)] {
        near(over_bar(elements, 0.037, false)[0], fine, within);
    }
}

#[test]
fn a_cable_at_rest_sinks_by_its_weight() {
    for elements in [1, 2, 8, 64] {
        let section = Section { diameter: 0.02, ..Section::new(2.0, 1e5, 1.0) };
        let height = 0.01 - 1e-5;
        let held = |name: &str, marker: &str, direction| CoordinateSpec {
            name: name.into(),
            marker: marker.into(),
            direction,
            motion: None,
        };
        let mut scene = Scene::new();
        scene
            .element(CableSpec::straight("c", [0.0, 0.0, height], [3.0, 0.0, height], elements, section))
            .constraint(held("x", "c.start", [1.0, 0.0, 0.0]))
            .constraint(held("y", "c.start", [0.0, 1.0, 0.0]))
            .constraint(held("turn", "c.end", [0.0, 1.0, 0.0]))
            .force(GravitySpec::default())
            .force(ContactSpec { stiffness_per_length: 1e5, ..plane() });
        let (model, state) = balance(&scene);
        let all = shown(&model, &state, "floor");
        near(all[4], 2.0 * G / 1e5, 1e-9);
        near(all[6], 3.0, 1e-12);
    }
}

#[test]
fn an_end_in_the_floor_is_as_deep_on_every_mesh() {
    let (k, force) = (1e6, 10.0);
    for end in [Some(0.0), Some(1e5), None] {
        for elements in [1, 2, 8, 32] {
            // so stiff that it isn't shortened
            let section = Section { diameter: 0.01, ..Section::new(1.0, 1e9, 1e4) };
            let mut scene = Scene::new();
            let fixed = |name: &str, direction| CoordinateSpec {
                name: name.into(),
                marker: "c.end".into(),
                direction,
                motion: None,
            };
            scene
                .element(CableSpec::straight("c", [0.0, 0.0, 0.0049], [0.0, 0.0, 0.5049], elements, section))
                .constraint(fixed("x", [1.0, 0.0, 0.0]))
                .constraint(fixed("y", [0.0, 1.0, 0.0]))
                .constraint(DirectionSpec::new("clamp", "c.end"))
                .force(PointForceSpec::new("c.end", [0.0, 0.0, -force], TimeFunction::default()))
                .force(ContactSpec { stiffness_per_length: k, end_stiffness: end, ..plane() });
            let (model, state) = balance(&scene);
            let tip = end.unwrap_or(k * 0.01);
            near(shown(&model, &state, "floor")[4], (-tip + (tip * tip + 2.0 * k * force).sqrt()) / k, 1e-3);
        }
    }
}

#[test]
fn what_a_dropped_cable_misses_of_energy_falls_with_the_square_of_the_step() {
    for floor in [false, true] {
        let missing = |h: f64| {
            let section = Section { diameter: 0.01, ..Section::new(0.5, 1e3, 0.05) };
            let contact = if floor { plane() } else { bar(0.05) };
            let z = if floor { 0.006 } else { 0.056 };
            let mut scene = Scene::new();
            scene
                .element(CableSpec::straight("c", [-1.03, 0.0, z], [0.97, 0.0, z + 0.01], 8, section))
                .force(GravitySpec::default())
                .force(ContactSpec { stiffness_per_length: 1e5, ..contact });
            let options = Options {
                scheme: Scheme::Newmark { beta: 0.25, gamma: 0.5 },
                stepping: Stepping::Fixed { h },
                ..Options::default()
            };
            let mut s = Simulation::new(scene.build().unwrap(), &options, 0.1).unwrap();
            struct Worst(f64);
            let mut worst = Worst(0.0);
            struct See<'a>(&'a mut Worst, f64);
            impl Observer for See<'_> {
                fn step(&mut self, m: &Model, s: &State, _: &StepReport) -> ControlFlow<()> {
                    let e = m.energy(&s.at());
                    let off = (e.kinetic + e.potential - self.1).abs();
                    self.0.0 = self.0.0.max(off);
                    ControlFlow::Continue(())
                }
            }
            let e = s.model.energy(&s.state.at());
            let begin = e.kinetic + e.potential;
            go(&mut s, 0.1, &mut See(&mut worst, begin));
            assert!(shown(&s.model, &s.state, if floor { "floor" } else { "bar" }).len() == 7);
            worst.0
        };
        let [a, b, c] = [2e-4, 1e-4, 5e-5].map(missing);
        println!("{a:e} {b:e} {c:e}");
        assert!(a / b > 3.0 && b / c > 3.0, "floor: {floor}: {a:e} {b:e} {c:e}");
    }
}

/// A cable drawn over half of a drum by a weight at each end.
fn around_drum(elements: usize, stiffness: f64) -> Option<String> {
    let (radius, d) = (0.5, 0.01);
    let section = Section { diameter: d, ..Section::new(0.01, 1e5, 0.0) };
    let mut cable = CableSpec::straight("c", [0.0; 3], [1.0, 0.0, 0.0], elements, section);
    cable.points = Vec::new();
    let turn = |k: i32| std::f64::consts::PI * f64::from(k) / 60.0;
    cable.curve = (0..=60).map(|k| [-radius * turn(k).cos(), 0.0, radius * turn(k).sin()]).collect();
    let mut scene = Scene::new();
    scene.element(cable);
    scene.constraint(SphericalSpec::pin("a", "c.start")).constraint(SphericalSpec::pin("b", "c.end")).force(
        ContactSpec {
            stiffness_per_length: stiffness,
            overlap: Overlap::Allow,
            ..bar(radius - d / 2.0 + 1e-3)
        },
    );
    let (model, state) = balance(&scene);
    model.remarks(&state.at()).pop()
}

#[test]
fn a_mesh_too_coarse_for_a_drum_is_remarked() {
    let message = around_drum(8, 1e7).expect("a remark");
    println!("{message}");
    assert!(message.contains("`bar`") && message.contains("elements of at most"), "{message}");
    assert_eq!(around_drum(60, 1e7), None);
    assert_eq!(around_drum(8, 1e3), None);
}
