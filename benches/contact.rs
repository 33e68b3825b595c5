//! What contact costs: a cable of 200 elements wound on a drum, with contact and without.
//!
//! `cargo bench --bench contact` measures all; `-- CASE STEPS` only steps through one, for a counter of instructions.

use ropewalk::constraints::{RevoluteSpec, SphericalSpec};
use ropewalk::core::integrator::{Options, Stepping};
use ropewalk::core::{Model, Simulation};
use ropewalk::elements::{CableSpec, RigidBodySpec, Section};
use ropewalk::forces::GravitySpec;
use ropewalk::forces::contact::{ContactSpec, Damping, Friction, ShapeSpec};
use ropewalk::{MarkerRef, Scene};
use std::error::Error;
use std::f64::consts::TAU;
use std::time::Instant;

type Result<T> = std::result::Result<T, Box<dyn Error>>;

const ELEMENTS: usize = 200;
const RADIUS: f64 = 0.5;
const DIAMETER: f64 = 0.02;
const TURNS: f64 = 4.0;
const PITCH: f64 = 1.2 * DIAMETER;
const CASES: [&str; 6] = ["without", "far", "smooth", "damped", "rough", "turning"];

/// A cable in a helix around the drum, held at both ends and tight: all of it presses on the drum.
fn scene(case: &str) -> Result<Scene> {
    let n = 400;
    let (ea, stiffness, tension) = (1e5, 1e6, 100.0);
    let length = TURNS * (TAU * RADIUS).hypot(PITCH);
    let section = Section { diameter: DIAMETER, axial_retardation_time: 1e-3, ..Section::new(0.5, ea, 0.1) };
    let mut cable = CableSpec::straight("cable", [0.0; 3], [1.0, 0.0, 0.0], ELEMENTS, section)
        .unstretched(length / (1.0 + tension / ea));
    cable.points = Vec::new();
    cable.curve = (0..=n)
        .map(|k| TURNS * f64::from(k) / f64::from(n))
        .map(|t| [RADIUS * (TAU * t).cos(), PITCH * t, RADIUS * (TAU * t).sin()])
        .collect();
    let mut scene = Scene::new();
    scene
        .element(cable)
        .constraint(SphericalSpec::pin("first", "cable.start"))
        .constraint(SphericalSpec::pin("last", "cable.end"))
        .force(GravitySpec::default());
    let shape = ShapeSpec::Cylinder { axis: [0.0, 1.0, 0.0], radius: RADIUS - 0.5 * DIAMETER, length: None };
    let mut contact = ContactSpec {
        on: vec!["cable".into()],
        stiffness_per_length: stiffness,
        damping: Damping::HuntCrossley(0.3),
        ..ContactSpec::new("drum", shape)
    };
    match case {
        "without" => return Ok(scene),
        "smooth" => contact.damping = Damping::None,
        "far" => contact.marker = MarkerRef::Point([0.0, 0.0, -100.0]),
        "damped" => {}
        "rough" => contact.friction = Some(Friction::new(0.3)),
        "turning" => {
            contact.friction = Some(Friction::new(0.3));
            contact.marker = "wheel".into();
            scene.element(RigidBodySpec::new("wheel", [0.0; 3], 20.0, [2.0; 3])).constraint(RevoluteSpec {
                name: "axle".into(),
                marker: "wheel".into(),
                to: None,
                axis: [0.0, 1.0, 0.0],
            });
        }
        _ => return Err(format!("there is no case {case}; there are {CASES:?}").into()),
    }
    scene.force(contact);
    Ok(scene)
}

fn model(case: &str) -> Result<Model> {
    Ok(scene(case)?.build()?)
}

fn started(case: &str) -> Result<Simulation> {
    let options = Options { stepping: Stepping::Fixed { h: 1e-3 }, ..Options::default() };
    let mut s = Simulation::new(model(case)?, &options, 1.0)?;
    s.keep_audit(false);
    Ok(s)
}

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|a| a != "--bench").collect();
    if let [case, steps] = &arguments[..] {
        let mut s = started(case)?;
        s.advance(1e-3 * steps.parse::<f64>()?, f64::INFINITY, &mut ())?;
        println!("{:?}", s.work.counts);
        return Ok(());
    }
    for case in CASES {
        let mut s = started(case)?;
        let begin = Instant::now();
        s.advance(0.2, f64::INFINITY, &mut ())?;
        let (time, counts) = (begin.elapsed().as_secs_f64(), s.work.counts);
        let per = |n: u64| 1e6 * time / n as f64;
        let (step, iteration) = (per(counts.steps), per(counts.newton_iterations));
        println!("{case:>8}: {step:7.1} µs per step, {iteration:7.1} µs per iteration, {counts:?}");
    }
    // one evaluation of all elements
    for case in ["far", "rough"] {
        let model = model(case)?;
        let state = model.state();
        let Some(term) = model.terms().iter().find(|t| t.label() == "drum") else { continue };
        let (mut sum, repeats) = (0.0, 2000);
        let begin = Instant::now();
        for _ in 0..repeats {
            sum += term.energy(&std::hint::black_box(&state).at()).potential;
        }
        let look = begin.elapsed().as_secs_f64() / (repeats * ELEMENTS) as f64;
        let begin = Instant::now();
        for _ in 0..repeats {
            let ahead = term.foresees().map_or(1.0, |t| t.step_limit(&std::hint::black_box(&state).at()));
            sum += ahead.min(1.0);
        }
        let ahead = begin.elapsed().as_secs_f64() / (repeats * ELEMENTS) as f64;
        std::hint::black_box(sum);
        println!("{case:>8}: {:.1} ns per element, {:.1} ns to see ahead", 1e9 * look, 1e9 * ahead);
    }
    Ok(())
}
