//! Lines that hold on to each other where they touch: what sticks stays, what slips loses what it should.

use ropewalk::scene::Format;
use ropewalk::{SceneFile, simulate};
use ropewalk_constraints::SphericalSpec;
use ropewalk_core::dot;
use ropewalk_core::integrator::{Options, StepReport, Stepping};
use ropewalk_core::rotation::{cross, matrix, times};
use ropewalk_core::{Checkpoint, End, Model, Observer, Simulation, State};
use ropewalk_elements::rigid_body::HullSpec;
use ropewalk_elements::{CableSpec, RigidBodySpec, Section};
use ropewalk_forces::contact::{Damping, Friction, LineContactSpec};
use ropewalk_forces::{DragSpec, GravitySpec, PointForceSpec, TimeFunction};
use ropewalk_scene::Scene;
use std::ops::ControlFlow;

const THICK: f64 = 0.02;
const MU: f64 = 0.3;
const STIFF: f64 = 1e7;

fn contact(friction: Friction) -> LineContactSpec {
    LineContactSpec {
        friction: Some(friction),
        damping: Damping::HuntCrossley(0.5),
        ..LineContactSpec::new("touch", STIFF)
    }
}

fn start(scene: &Scene, stepping: Stepping, duration: f64) -> Simulation {
    let options = Options { stepping, ..Options::default() };
    let model = scene.build().unwrap_or_else(|e| panic!("{e}"));
    Simulation::new(model, &options, duration).unwrap_or_else(|e| panic!("{e}"))
}

fn go(s: &mut Simulation, t: f64, observer: &mut dyn Observer) {
    assert_eq!(s.advance(t, f64::INFINITY, observer).unwrap_or_else(|e| panic!("{e}")), End::Done);
}

/// What presses, how deep, over which length, what holds, and which part slips.
fn shown(model: &Model, state: &State) -> [f64; 5] {
    let term = model.terms().iter().find(|t| t.label() == "touch").expect("touch");
    let mut out = Vec::new();
    term.shows().unwrap().observe(&state.at(), &mut out);
    out.try_into().unwrap()
}

/// A rod, a stiff cable along y, that lies on two rails, stiff cables along x that are held at their ends; it is drawn this way.
fn rod_on_rails(pull: [f64; 3], time: &TimeFunction, friction: Friction) -> Scene {
    let stiff = |mass, ea, ei| Section {
        diameter: THICK,
        bending_retardation_time: 2e-3,
        axial_retardation_time: 1e-3,
        ..Section::new(mass, ea, ei)
    };
    let mut scene = Scene::new();
    for (name, y) in [("left", -0.31), ("right", 0.32)] {
        let rail = CableSpec::straight(name, [-0.9, y, 0.0], [1.1, y, 0.0], 5, stiff(5.0, 1e6, 1e4));
        scene
            .element(rail)
            .constraint(SphericalSpec::pin(&format!("{name} start"), format!("{name}.start").as_str()))
            .constraint(SphericalSpec::pin(&format!("{name} end"), format!("{name}.end").as_str()));
    }
    let rod = CableSpec::straight(
        "rod",
        [0.013, -0.5, THICK - 1.4e-4],
        [0.013, 0.5, THICK - 1.4e-4],
        4,
        stiff(1.0, 1e6, 1e3),
    );
    scene.element(rod).force(GravitySpec { on: vec!["rod".into()] });
    for end in ["rod.start", "rod.end"] {
        let half = pull.map(|x| 0.5 * x);
        scene.force(PointForceSpec::new(end, half, time.clone()));
    }
    scene.force(contact(friction));
    scene
}

/// How far the middle of the rod is from where it was.
fn moved(s: &Simulation) -> [f64; 3] {
    let x = s.model.part("rod").unwrap().point(0.5, &s.state.at()).unwrap().0;
    [x[0] - 0.013, x[1], x[2] - THICK]
}

/// Once the rod lies still.
const LATER: TimeFunction = TimeFunction::Ramp { from: 0.0, to: 1.0, t0: 1.0, t1: 2.0 };
const WEIGHT: f64 = 9.81;
const WAYS: [[f64; 2]; 3] = [[1.0, 0.0], [0.0, 1.0], [0.8, -0.6]];

#[test]
fn a_line_that_is_pulled_a_little_stays_on_others_for_ever() {
    for way in WAYS {
        let pull = 0.6 * MU * WEIGHT;
        let scene = rod_on_rails([pull * way[0], pull * way[1], 0.0], &LATER, Friction::new(MU));
        let mut s = start(&scene, Stepping::Controlled { tolerance: 1e-5 }, 1e3);
        go(&mut s, 1.0, &mut ());
        let before = moved(&s);
        go(&mut s, 5.0, &mut ());
        let first = moved(&s);
        go(&mut s, 1e3, &mut ());
        let last = moved(&s);
        let along = (last[0] - before[0]) * way[0] + (last[1] - before[1]) * way[1];
        println!("{way:?}: {first:?}, {last:?}, {:?}, {:?}", s.work.counts, shown(&s.model, &s.state));
        // it bends by more than its bristles do
        assert!(along.abs() < 1e-4, "{along}");
        for i in 0..2 {
            assert!((first[i] - last[i]).abs() <= 1e-7, "{first:?}, {last:?}");
        }
        // bristles of both rails hold a little against each other too
        let [normal, _, _, held, slipping] = shown(&s.model, &s.state);
        assert!((held - pull).abs() <= 5e-3 * pull && slipping == 0.0, "{held} N of {normal} N");
    }
}

#[test]
fn a_line_that_slips_on_others_is_held_by_coulombs_force_and_loses_its_work() {
    for way in WAYS {
        let pull = 1.5 * MU * WEIGHT;
        let scene =
            rod_on_rails([pull * way[0], pull * way[1], 0.0], &TimeFunction::Constant, Friction::new(MU));
        let mut s = start(&scene, Stepping::Controlled { tolerance: 1e-6 }, 0.4);
        go(&mut s, 0.4, &mut ());
        let [x, y, _] = moved(&s);
        let along = x * way[0] + y * way[1];
        let (wanted, across) = (0.5 * (pull - MU * WEIGHT) * 0.16, x * way[1] - y * way[0]);
        let [normal, _, _, held, slipping] = shown(&s.model, &s.state);
        let share = s.audit.imbalance().abs() / s.audit.scale;
        let heat = s.audit.dissipated / (MU * WEIGHT * along) - 1.0;
        println!(
            "{way:?}: {along:.5} m, {:.1e} off, {across:.1e} m across, {held:.6} N of {normal:.5} N, heat {heat:.1e} off, \
             energy {share:.1e}, {:?}",
            along / wanted - 1.0,
            s.work.counts
        );
        assert!((along / wanted - 1.0).abs() <= 1e-2, "{along} m instead of {wanted} m");
        assert!(across.abs() <= 1e-2 * along, "{across}");
        assert!(slipping == 1.0 && (held / (MU * normal) - 1.0).abs() <= 1e-9, "{held} N of {normal} N");
        assert!(heat.abs() <= 1e-2 && share <= 2e-4, "heat {heat}, energy {share}");
    }
}

#[test]
fn elastic_slip_is_as_told() {
    // bristles that are softer by as much let the rod give way by as much more
    let pulled = |slip: f64| {
        let friction = Friction { elastic_slip: Some(slip), ..Friction::new(MU) };
        let scene = rod_on_rails([0.4 * MU * WEIGHT, 0.0, 0.0], &LATER, friction);
        let mut s = start(&scene, Stepping::Controlled { tolerance: 1e-5 }, 3.0);
        go(&mut s, 1.0, &mut ());
        let before = moved(&s)[0];
        go(&mut s, 3.0, &mut ());
        moved(&s)[0] - before
    };
    let way = [1e-2, 2e-2, 4e-2].map(pulled);
    println!("{way:?}");
    // and the rails bend
    let [first, second] = [way[1] - way[0], way[2] - way[1]];
    assert!(first > 1e-5 && (second / first - 2.0).abs() <= 2e-2, "{way:?}");
}

#[test]
fn a_run_with_friction_is_resumed_to_the_last_bit() {
    struct Taken(f64, Option<Checkpoint>);
    impl Observer for Taken {
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
    let scene = rod_on_rails([2.0 * WEIGHT * MU, 0.0, 0.0], &TimeFunction::Constant, Friction::new(MU));
    let options = Options { stepping: Stepping::Controlled { tolerance: 1e-4 }, ..Options::default() };
    let mut s = start(&scene, options.stepping, 0.3);
    let mut taken = Taken(0.15, None);
    go(&mut s, 0.3, &mut taken);
    let kept = taken.1.expect("a checkpoint");
    assert!(kept.state.internal.iter().any(|m| *m != 0.0));
    let mut again = Simulation::restore(scene.build().unwrap(), &options, 0.3, kept).unwrap();
    assert_eq!(again.go_on(0.3, f64::INFINITY, &mut ()).unwrap(), End::Done);
    assert_eq!(s.state, again.state);
    assert!(shown(&s.model, &s.state)[3] > 0.0);
}

#[test]
fn rods_that_rub_keep_their_momentum_and_its_moment() {
    // both float freely; one hits the other askew and is slowed down on it
    let masses = [1.0, 2.0];
    let inertia = [[0.1, 1e-3, 0.1], [2e-3, 0.2, 0.2]];
    let rod = |name: &str, x: [f64; 3], half: [f64; 3], n: usize| {
        let mut rod = RigidBodySpec::new(name, x, masses[n], inertia[n]);
        rod.hull = Some(HullSpec { from: half.map(|x: f64| -x), to: half, diameter: THICK });
        rod
    };
    let mut scene = Scene::new();
    let mut upper = rod("upper", [0.05, 0.1, THICK + 1e-4], [0.0, 0.5, 0.0], 0);
    upper.velocity = [1.0, 0.3, -0.5];
    scene
        .element(upper)
        .element(rod("lower", [0.0; 3], [0.5, 0.0, 0.0], 1))
        .force(contact(Friction::new(MU)));
    let mut s = start(&scene, Stepping::Controlled { tolerance: 1e-7 }, 0.05);
    let momentum = |s: &Simulation| {
        let mut all = [0.0; 6];
        for n in 0..2 {
            let (q, v) = (&s.state.q[7 * n..], &s.state.v[6 * n..]);
            let p = [0, 1, 2].map(|i| masses[n] * v[i]);
            let spin =
                times(&matrix(&[q[3], q[4], q[5], q[6]]), &[0, 1, 2].map(|i| inertia[n][i] * v[3 + i]));
            let moment = cross(&[q[0], q[1], q[2]], &p);
            for i in 0..3 {
                all[i] += p[i];
                all[3 + i] += moment[i] + spin[i];
            }
        }
        all
    };
    let before = momentum(&s);
    go(&mut s, 0.05, &mut ());
    let after = momentum(&s);
    let share = s.audit.imbalance().abs() / s.audit.scale;
    println!("{before:?}\n{after:?}, {:.3e} J lost, energy {share:.1e}, {:?}", s.audit.dissipated, s.state.v);
    // the lower one is taken along by friction
    assert!(s.state.v[6] > 1e-3 && s.state.v[7] > 1e-3 && s.audit.dissipated > 1e-3);
    let size = dot(&[before[0], before[1], before[2]], &[before[0], before[1], before[2]]).sqrt();
    for (a, b) in before.iter().zip(&after) {
        assert!((a - b).abs() <= 1e-6 * size, "{before:?}, {after:?}");
    }
    assert!(share <= 1e-4, "{share}");
}

/// A scene in which a line hangs across another, from an equilibrium on.
fn laid(friction: &str) -> Result<Vec<String>, String> {
    let text = format!(
        r#"
run = {{ duration = 0.05, from_equilibrium = true }}
forces = [{{ type = "gravity" }}, {{ type = "line_contact", name = "touch", stiffness_per_length = 1e6, {friction} }}]
constraints = [
  {{ type = "spherical", name = "a", marker = "low.start" }},
  {{ type = "spherical", name = "b", marker = "low.end" }},
  {{ type = "spherical", name = "c", marker = "high.start" }},
  {{ type = "spherical", name = "d", marker = "high.end" }},
]
elements = [
  {{ type = "cable", name = "low", points = [[-1, 0, 0], [1, 0, 0]], length = 2.0, elements = 8, section = {{ mass = 0.3, ea = 1e4, ei = 0.02, diameter = 0.02 }} }},
  {{ type = "cable", name = "high", points = [[0.1, -1, 0.1], [0.1, 1, 0.1]], length = 2.4, elements = 8, section = {{ mass = 0.3, ea = 1e4, ei = 0.02, diameter = 0.02 }} }},
]
"#
    );
    let file = SceneFile::parse(&text, "laid.toml", Format::Toml, &[]).map_err(|e| e.to_string())?;
    simulate(file.scene()).map(|h| h.warnings).map_err(|e| e.to_string())
}

#[test]
fn equilibria_take_friction_between_lines_when_asked_and_say_so_when_not() {
    let told = |friction: &str| {
        let warnings = laid(friction).unwrap_or_else(|e| panic!("{friction}: {e}"));
        println!("{friction}: {warnings:?}");
        warnings.iter().any(|w| w.contains("without the friction of `touch`"))
    };
    assert!(told("friction = 0.3"));
    assert!(!told("friction = { mu = 0.3, equilibrium = \"laid\" }"));
    assert!(!told("friction = 0"));
    for (friction, wanted) in [
        ("friction = { mu = 0.3, equilibrium = \"pulled\" }", "laid"),
        ("friction = { mu = 0.3, across = 0.2 }", "across"),
        ("friction = -1", "friction"),
    ] {
        let error = laid(friction).expect_err(friction);
        println!("{error}");
        assert!(error.contains(wanted), "{wanted}: {error}");
    }
}

/// A line with an open overhand knot, whose ends are drawn apart in water.
fn knot(friction: Option<Friction>) -> Scene {
    let section = Section {
        diameter: 0.004,
        bending_retardation_time: 0.1,
        axial_retardation_time: 0.01,
        ..Section::new(0.05, 1e3, 0.02)
    };
    let line = CableSpec {
        points: Vec::new(),
        curve: super::lines::knotted(0.15, 0.6),
        elements: 64,
        ..CableSpec::straight("line", [0.0; 3], [1.0, 0.0, 0.0], 1, section)
    };
    let pull = |marker: &str, f: f64| PointForceSpec::new(marker, [f, 0.0, 0.0], TimeFunction::Constant);
    let mut scene = Scene::new();
    scene
        .element(line)
        .force(pull("line.start", 0.25))
        .force(pull("line.end", -0.25))
        .force(DragSpec::default())
        .force(LineContactSpec { friction, ..LineContactSpec::new("touch", 1e6) });
    scene.water = Some(Default::default());
    scene
}

#[test]
fn a_knot_with_friction_is_drawn_tight_less_far() {
    // F R²/EI = 1/2 without friction; with it the knot holds before it is as tight (Audoly, Clauvelin, Neukirch 2007)
    let apart = |friction: Option<Friction>| {
        let mut s = start(&knot(friction), Stepping::Controlled { tolerance: 1e-2 }, 6.0);
        go(&mut s, 6.0, &mut ());
        let (line, at) = (s.model.part("line").unwrap(), s.state.at());
        let [a, b] = [0.0, line.length()].map(|x| line.point(x, &at).unwrap().0);
        let apart = (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt();
        let radius = (line.length() - apart) / (2.0 * std::f64::consts::PI);
        let share = s.audit.imbalance().abs() / s.audit.scale;
        println!("{friction:?}: R = {radius:.4} m, energy {share:.1e}, {:?}", s.work.counts);
        assert!(share <= 2e-2, "{share}");
        if friction.is_some() {
            let [normal, _, _, held, _] = shown(&s.model, &s.state);
            println!("{held:.4} N of {normal:.4} N");
            assert!(held > 0.0 && held <= MU * normal * (1.0 + 1e-9), "{held} N of {normal} N");
        }
        radius
    };
    let (smooth, rough) = (apart(None), apart(Some(Friction::new(MU))));
    assert!(rough > 1.02 * smooth && rough < 2.0 * smooth, "{rough} m with friction, {smooth} m without");
}

/// What a line says that is bent to a loop as tight as this, and touches itself or doesn't.
fn told_of_loop(radius: f64, itself: bool) -> Option<String> {
    let n = 24;
    let curve = (0..=n).map(|k| {
        let phi = std::f64::consts::PI * k as f64 / n as f64;
        [radius * phi.sin(), radius * phi.cos(), 0.0]
    });
    let line = CableSpec {
        points: Vec::new(),
        curve: curve.collect(),
        elements: 24,
        ..CableSpec::straight(
            "line",
            [0.0; 3],
            [1.0, 0.0, 0.0],
            1,
            Section { diameter: THICK, ..Section::new(0.3, 1e4, 0.02) },
        )
    };
    let mut scene = Scene::new();
    scene
        .element(line)
        .element(CableSpec::straight(
            "far",
            [0.0, 0.0, 5.0],
            [1.0, 0.0, 5.0],
            2,
            Section { diameter: THICK, ..Section::new(0.3, 1e4, 0.02) },
        ))
        .force(LineContactSpec { itself, ..LineContactSpec::new("touch", STIFF) });
    let model = scene.build().unwrap_or_else(|e| panic!("{e}"));
    let (state, term) = (model.state(), model.terms().iter().find(|t| t.label() == "touch").unwrap().clone());
    term.shows().unwrap().remark(&state.at())
}

#[test]
fn a_line_bent_tighter_than_its_own_radius_is_remarked() {
    let told = told_of_loop(0.4 * THICK, true).expect("a remark");
    println!("{told}");
    // a spline through its points is a little more bent at its end
    let radius: f64 = told.split("a radius of ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
    assert!((radius / (0.4 * THICK) - 1.0).abs() <= 2e-2, "{told}");
    assert!(told.contains("`line`") && told.contains("its own radius of 1.00e-2 m"), "{told}");
    assert_eq!(told_of_loop(0.6 * THICK, true), None);
    assert_eq!(told_of_loop(0.4 * THICK, false), None);
}

#[test]
fn a_line_that_slips_over_nodes_of_others_is_held_all_the_same() {
    // nodes of the rod pass over the rails; where they do nothing is let go
    struct Least(f64);
    impl Observer for Least {
        fn step(&mut self, m: &Model, s: &State, _: &StepReport) -> ControlFlow<()> {
            let [normal, _, _, held, slipping] = shown(m, s);
            if s.t > 0.05 && slipping > 0.99 {
                self.0 = self.0.min(held / (MU * normal));
            }
            ControlFlow::Continue(())
        }
    }
    let pull = 1.5 * MU * WEIGHT;
    let scene = rod_on_rails([0.0, pull, 0.0], &TimeFunction::Constant, Friction::new(MU));
    let mut s = start(&scene, Stepping::Controlled { tolerance: 1e-5 }, 0.5);
    let mut least = Least(f64::INFINITY);
    go(&mut s, 0.5, &mut least);
    assert!(least.0 >= 1.0 - 1e-9 && least.0.is_finite(), "{}", least.0);
}
