//! Lines that touch each other, in motion and at rest.

use ropewalk_constraints::SphericalSpec;
use ropewalk_core::integrator::{Options, StepReport, Stepping};
use ropewalk_core::modes::modes;
use ropewalk_core::statics::{Statics, StaticsOptions};
use ropewalk_core::{Checkpoint, End, Model, Observer, Simulation, State};
use ropewalk_elements::rigid_chain::LinkSection;
use ropewalk_elements::{CableSpec, RigidChainSpec, Section};
use ropewalk_forces::contact::{ClearanceSpec, Damping, Friction, LineContactSpec};
use ropewalk_forces::{DragSpec, GravitySpec, PointForceSpec, TimeFunction};
use ropewalk_scene::{Format, Scene, SceneFile};
use std::f64::consts::PI;
use std::ops::ControlFlow;

const THICK: f64 = 0.02;

fn section() -> Section {
    Section { diameter: THICK, ..Section::new(0.3, 1e4, 0.02) }
}

/// A taut line along x, held at both ends, and one that is laid across it at this height.
fn crossing(height: f64, contact: LineContactSpec) -> Scene {
    crossing_at(height, 0.0, contact)
}

/// The same with a velocity upwards.
fn crossing_at(height: f64, speed: f64, contact: LineContactSpec) -> Scene {
    let mut scene = Scene::new();
    scene
        .element(CableSpec {
            length: Some(1.998),
            ..CableSpec::straight("low", [-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], 9, section())
        })
        .element(CableSpec {
            velocity: [0.0, 0.0, speed],
            ..CableSpec::straight("high", [0.15, -0.8, height], [0.15, 0.7, height], 8, section())
        })
        .constraint(SphericalSpec::pin("left", "low.start"))
        .constraint(SphericalSpec::pin("right", "low.end"))
        .force(GravitySpec::default())
        .force(contact);
    scene
}

fn contact() -> LineContactSpec {
    LineContactSpec::new("touch", 1e6)
}

fn start(scene: &Scene, stepping: Stepping, duration: f64) -> Simulation {
    let options = Options { stepping, ..Options::default() };
    let model = scene.build().unwrap_or_else(|e| panic!("{e}"));
    Simulation::new(model, &options, duration).unwrap_or_else(|e| panic!("{e}"))
}

fn go(s: &mut Simulation, t: f64, observer: &mut dyn Observer) {
    assert_eq!(s.advance(t, f64::INFINITY, observer).unwrap_or_else(|e| panic!("{e}")), End::Done);
}

/// What presses, how deep, over which length.
fn shown(model: &Model, state: &State) -> [f64; 3] {
    let term = model.terms().iter().find(|t| t.label() == "touch").expect("touch");
    let mut out = Vec::new();
    term.shows().unwrap().observe(&state.at(), &mut out);
    out[..3].try_into().unwrap()
}

/// The greatest depth on the way, and how often what is near was listed anew.
#[derive(Default)]
struct Most {
    depth: f64,
    steps: usize,
}

impl Observer for Most {
    fn step(&mut self, m: &Model, s: &State, _: &StepReport) -> ControlFlow<()> {
        self.depth = self.depth.max(shown(m, s)[1]);
        self.steps += 1;
        ControlFlow::Continue(())
    }
}

#[test]
fn a_line_that_falls_across_another_is_caught_and_keeps_its_energy() {
    let mut off = Vec::new();
    for tolerance in [1e-3, 1e-4] {
        let mut s = start(&crossing(0.3, contact()), Stepping::Controlled { tolerance }, 0.45);
        let mut most = Most::default();
        go(&mut s, 0.45, &mut most);
        let share = s.audit.imbalance().abs() / s.audit.scale;
        println!("{tolerance:e}: {:.3e} m deep, {} steps, energy off by {share:.1e}", most.depth, most.steps);
        assert!(most.depth > 1e-4 && most.depth < 0.5 * THICK, "{}", most.depth);
        off.push(share);
    }
    assert!(off[1] < 1e-3, "{off:?}");
}

#[test]
fn fixed_steps_lose_energy_to_second_order() {
    let error = |h: f64| {
        let mut s = start(&crossing_at(0.03, -1.0, contact()), Stepping::Fixed { h }, 0.12);
        let mut most = Most::default();
        go(&mut s, 0.12, &mut most);
        println!("{h:e}: {:.2e} J of {:.2e}, {:.2e} m", s.audit.imbalance(), s.audit.scale, most.depth);
        assert!(most.depth > 1e-5);
        s.audit.imbalance().abs()
    };
    let (coarse, fine) = (error(2e-4), error(5e-5));
    assert!(fine < coarse / 8.0 || fine < 1e-9, "{coarse:e} J, {fine:e} J");
}

#[test]
fn nothing_goes_through_however_fast_it_is() {
    let fast = |speed: f64| {
        let mut scene = Scene::new();
        scene
            .element(CableSpec::straight("low", [-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], 4, section()))
            .element(CableSpec {
                velocity: [0.0, 0.0, -speed],
                ..CableSpec::straight("high", [0.1, -0.5, 0.5], [0.1, 0.5, 0.5], 3, section())
            })
            .constraint(SphericalSpec::pin("left", "low.start"))
            .constraint(SphericalSpec::pin("right", "low.end"))
            .force(LineContactSpec::new("touch", 1e8));
        let mut s = start(&scene, Stepping::Controlled { tolerance: 1e-2 }, 0.7 / speed);
        let mut most = Most::default();
        go(&mut s, 0.7 / speed, &mut most);
        println!("{speed} m/s: {:.2e} m deep, {:?}", most.depth, s.work.counts);
        assert!(most.depth > 0.0 && most.depth < THICK, "{speed}: {}", most.depth);
    };
    fast(1.0);
    fast(20.0);
}

#[test]
fn a_run_that_is_resumed_goes_on_to_the_last_bit() {
    struct At(f64, Option<Checkpoint>);
    impl Observer for At {
        fn step(&mut self, _: &Model, s: &State, _: &StepReport) -> ControlFlow<()> {
            self.0 -= s.control.h_last;
            ControlFlow::Continue(())
        }
        fn wants_checkpoint(&mut self) -> bool {
            self.0 <= 0.0 && self.1.is_none()
        }
        fn checkpoint(&mut self, c: Checkpoint) -> ControlFlow<()> {
            self.1 = Some(c);
            ControlFlow::Continue(())
        }
    }
    let scene = crossing(0.1, contact());
    let options = Options { stepping: Stepping::Controlled { tolerance: 1e-3 }, ..Options::default() };
    let mut s = start(&scene, options.stepping, 0.25);
    let mut at = At(0.16, None);
    go(&mut s, 0.25, &mut at);
    let taken = at.1.expect("a checkpoint");
    assert!(taken.state.t > 0.1 && taken.state.t < 0.25);
    let mut again = Simulation::restore(scene.build().unwrap(), &options, 0.25, taken).unwrap();
    assert_eq!(again.go_on(0.25, f64::INFINITY, &mut ()).unwrap(), End::Done);
    assert_eq!(s.state, again.state);
    assert!(shown(&s.model, &s.state)[0] > 0.0, "nothing touches at the end");
}

#[test]
fn a_line_lies_on_another_in_equilibrium() {
    // both are held at their ends; the upper one hangs across the lower one
    let mut scene = Scene::new();
    let cable = |name: &str, from, to, length| CableSpec {
        length: Some(length),
        ..CableSpec::straight(name, from, to, 8, section())
    };
    scene
        .element(cable("low", [-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], 2.0))
        .element(cable("high", [0.1, -1.0, 0.1], [0.1, 1.0, 0.1], 2.4))
        .constraint(SphericalSpec::pin("a", "low.start"))
        .constraint(SphericalSpec::pin("b", "low.end"))
        .constraint(SphericalSpec::pin("c", "high.start"))
        .constraint(SphericalSpec::pin("d", "high.end"))
        .force(GravitySpec::default())
        .force(contact());
    let model = scene.build().unwrap_or_else(|e| panic!("{e}"));
    let mut state = model.state();
    let options = StaticsOptions::default();
    let found = Statics::new(&model, &options).unwrap().find(&mut state, true);
    let found = found.unwrap_or_else(|e| panic!("{e}"));
    let model = model.renewed(&state.at(), true).unwrap();
    let [normal, depth, length] = shown(&model, &state);
    println!("{found:?}: {normal:.4} N, {depth:.3e} m, {length:.4} m");
    // it carries part of the upper line's weight of 7 N
    assert!(normal > 1.0 && normal < 7.1 && depth > 1e-6 && depth < 0.2 * THICK, "{normal} N, {depth} m");
    let found = modes(&model, &state, &options, None, 4, &mut |_, _, _| ControlFlow::Continue(())).unwrap();
    assert!(found.modes.iter().all(|m| m.growth.abs() < 1e-6 * m.omega), "{:?}", found.modes.len());
}

/// A line with an open overhand knot, a trefoil cut open, with both ends off to one side.
pub fn knotted(size: f64, tail: f64) -> Vec<[f64; 3]> {
    let (gap, n) = (0.6, 36);
    let place = |k: usize| {
        let t = PI + gap + 2.0 * (PI - gap) * k as f64 / n as f64;
        let (x, y) = (t.sin() + 2.0 * (2.0 * t).sin(), t.cos() - 2.0 * (2.0 * t).cos());
        [size * x, size * y, -0.5 * size * (3.0 * t).sin()]
    };
    let knot: Vec<_> = (0..=n).map(place).collect();
    let (a, b) = (knot[0], knot[n]);
    let below = |p: [f64; 3], d: f64| [p[0], p[1] - d, p[2]];
    let tails = [1.0, 0.75, 0.5, 0.25];
    let mut points: Vec<_> = tails.iter().map(|d| below(a, d * tail)).collect();
    points.extend(knot);
    points.extend(tails.iter().rev().map(|d| below(b, d * tail)));
    points
}

#[test]
fn an_overhand_knot_under_tension_has_the_loop_of_the_theory() {
    // thin and without friction, the loop of an overhand knot under the tension T is a circle with T R² = EI/2 (Audoly,
    // Clauvelin, Neukirch 2007), which leaves the ends nearer by its circumference
    let (ei, tension, thick) = (0.02, 0.25, 0.004);
    let section = Section {
        diameter: thick,
        bending_retardation_time: 0.1,
        axial_retardation_time: 0.01,
        ..Section::new(0.05, 1e3, ei)
    };
    let line = CableSpec {
        points: Vec::new(),
        curve: knotted(0.15, 0.6),
        elements: 64,
        ..CableSpec::straight("line", [0.0; 3], [1.0, 0.0, 0.0], 1, section)
    };
    let pull = |marker: &str, f: f64| PointForceSpec::new(marker, [f, 0.0, 0.0], TimeFunction::Constant);
    let mut scene = Scene::new();
    scene
        .element(line)
        .force(pull("line.start", tension))
        .force(pull("line.end", -tension))
        .force(DragSpec::default())
        .force(LineContactSpec { damping: Damping::HuntCrossley(1.0), ..LineContactSpec::new("touch", 1e6) });
    scene.water = Some(Default::default());
    let mut s = start(&scene, Stepping::Controlled { tolerance: 1e-2 }, 8.0);
    let line = s.model.part("line").unwrap().clone();
    let mut radius = 0.0;
    for t in [2.0, 4.0, 8.0] {
        go(&mut s, t, &mut ());
        let at = s.state.at();
        let [a, b] = [0.0, line.length()].map(|x| line.point(x, &at).unwrap().0);
        let apart = (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt();
        radius = (line.length() - apart) / (2.0 * PI);
        println!(
            "{t} s: R = {radius:.4} m, ends {apart:.4} m apart, {:?}, {:?}",
            shown(&s.model, &s.state),
            s.work.counts
        );
    }
    let wanted = (ei / (2.0 * tension)).sqrt();
    assert!((radius / wanted - 1.0).abs() < 0.1, "{radius} m instead of {wanted} m");
    assert!(shown(&s.model, &s.state)[0] > 0.1);
}

#[test]
fn clearances_are_those_between_surfaces() {
    let mut scene = crossing(0.3, contact());
    scene.record(ClearanceSpec::new("low", "high"));
    let model = scene.build().unwrap();
    let records = scene.records(&model).unwrap();
    let mut out = Vec::new();
    let state = model.state();
    let s = Simulation::new(scene.build().unwrap(), &Options::default(), 1.0).unwrap();
    let sample =
        ropewalk_core::Sample { model: &model, at: state.at(), lambda: &state.lambda, audit: &s.audit };
    records[0].sample(&sample, &mut out);
    println!("{out:?}");
    assert!((out[0] - (0.3 - THICK)).abs() < 1e-12);
    assert!((out[2] - 0.8).abs() < 1e-9);
}

/// What a scene is told.
fn refused(change: &str, with: &str) -> String {
    let text = r#"
run = { duration = 1.0 }
elements = [
  { type = "cable", name = "a", points = [[0, 0, 0], [1, 0, 0]], elements = 4, section = { mass = 1.0, ea = 1e4, ei = 0.1, diameter = 0.02 } },
  { type = "cable", name = "b", points = [[0.5, -1, 0.1], [0.5, 1, 0.1]], elements = 4, section = { mass = 1.0, ea = 1e4, ei = 0.1, diameter = 0.02 } },
]
forces = [{ type = "line_contact", name = "touch", stiffness_per_length = 1e6 }]
"#;
    assert!(text.contains(change), "{change}");
    let text = text.replacen(change, with, 1);
    let file = SceneFile::parse(&text, "scene.toml", Format::Toml, &[]).map_err(|e| e.to_string());
    match file.and_then(|f| f.scene().build().map(drop).map_err(|e| e.to_string())) {
        Ok(()) => "fine".into(),
        Err(e) => e,
    }
}

#[test]
fn what_cannot_touch_is_refused_in_words() {
    assert_eq!(refused("run", "run"), "fine");
    let all = [
        ("[0.5, -1, 0.1], [0.5, 1, 0.1]", "[0.5, -1, 0.005], [0.5, 1, 0.005]", "deep in"),
        (
            "name = \"touch\",",
            "name = \"touch\", on = [\"a\"], itself = false,",
            "nothing to touch but itself",
        ),
        ("name = \"touch\",", "name = \"touch\", on = [\"a\", \"c\"],", "there is no part `c`"),
        ("name = \"touch\",", "name = \"touch\", on = [\"a\", \"a\"],", "named twice"),
        ("= 1e6", "= 0", "stiffness_per_length"),
        ("diameter = 0.02 } },\n  {", "diameter = 0 } },\n  {", "fine"),
    ];
    for (change, with, wanted) in all {
        let told = refused(change, with);
        println!("{told}");
        assert!(told.contains(wanted), "{wanted}: {told}");
    }
}

#[test]
fn a_chain_falls_over_a_line_and_keeps_its_energy() {
    // across a taut line; one joint comes down nearly on it, with friction and without
    for friction in [None, Some(Friction::new(0.3))] {
        let mut scene = Scene::new();
        let links = LinkSection { joint_damping: 1e-3, ..LinkSection::new(0.5, THICK) };
        scene
            .element(CableSpec {
                length: Some(1.99),
                ..CableSpec::straight("low", [-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], 8, section())
            })
            .element(RigidChainSpec::new("chain", vec![[0.1, -0.503, 0.06], [0.1, 0.497, 0.06]], 10, links))
            .constraint(SphericalSpec::pin("left", "low.start"))
            .constraint(SphericalSpec::pin("right", "low.end"))
            .force(GravitySpec::default())
            .force(LineContactSpec { friction, ..contact() });
        let duration = 0.35;
        let mut s = start(&scene, Stepping::Controlled { tolerance: 1e-5 }, duration);
        let mut most = Most::default();
        go(&mut s, duration, &mut most);
        let share = s.audit.imbalance().abs() / s.audit.scale;
        println!("{:.3e} m deep, {} steps, energy off by {share:.1e}", most.depth, most.steps);
        assert!(most.depth > 1e-4 && most.depth < 0.5 * THICK, "{}", most.depth);
        assert!(share <= 1e-3, "{share:e}");
        // it hangs over the line: its ends are below, its middle isn't
        let (chain, at) = (s.model.part("chain").unwrap(), s.state.at());
        let height = |x: f64| chain.point(x, &at).unwrap().0[2];
        println!("{:.3} {:.3} {:.3}", height(0.0), height(0.5), height(1.0));
        let fallen = -0.5 * 9.81 * duration * duration;
        assert!(height(0.5) > 0.5 * fallen && height(0.0) < height(0.5) && height(1.0) < height(0.5));
    }
}
