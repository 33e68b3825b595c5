//! Cables with torsion whose elements are born and swallowed at a winch: their twist goes on.

use super::feeding::damped;
use super::{case, number, run, scene};
use ropewalk::{History, Simulation};
use ropewalk_core::{Observer, Remeshed};
use std::f64::consts::TAU;

const FED: &str = include_str!("fed.toml");
const BORN: &str = "wrap = \"$wrap\"\nelement_length = 0.4\nfade = 0.2";

/// Counts changes of the mesh, and sums up the energy that they bring.
#[derive(Default)]
struct Changes(Vec<Remeshed>);
impl Observer for Changes {
    fn remeshed(&mut self, report: &Remeshed) {
        self.0.push(report.clone());
    }
}

fn born() -> String {
    FED.replace("wrap = \"$wrap\"", BORN)
}

/// What happens to the mesh of such a scene until a time.
fn changes(text: &str, set: &[String], until: f64) -> Vec<Remeshed> {
    let scene = scene(text, set);
    let model = scene.build().unwrap_or_else(|e| panic!("{e}"));
    let mut seen = Changes::default();
    let mut s = Simulation::new(model, &scene.solver, until).unwrap_or_else(|e| panic!("{e}"));
    s.advance(until, 0.5, &mut seen).unwrap_or_else(|e| panic!("{e}"));
    seen.0
}

/// A body turns on a cable that grows (Bessel functions): however often elements are born.
#[test]
fn a_torsional_pendulum_keeps_its_frequency_as_elements_are_born() {
    let case = case("feeding_torsional_pendulum");
    let set = ["n=3".to_string()];
    let h = run(&born(), &set);
    let angle = h.column("wire.end.angle").expect("an angle");
    for row in case["results"]["t_theta"].as_array().expect("rows") {
        let [t, theta] = [number(&row[0]), number(&row[1])];
        let k = h.times().iter().position(|x| (x - t).abs() < 1e-9).expect("a time");
        println!("{t} s: {} {theta}, {:.1e}", angle[k], angle[k] - theta);
        assert!((angle[k] - theta).abs() < 1e-5, "{t} s: {} {theta}", angle[k]);
    }
    let seen = changes(&born(), &set, 10.0);
    let lost: f64 = seen.iter().map(|r| (r.kinetic + r.potential).abs()).sum();
    println!("{} changes, {lost:.1e} J", seen.len());
    assert!(seen.len() >= 10 && lost <= 1e-7, "{} changes, {lost} J", seen.len());
}

/// Each wrap of a coil brings its turn, whichever element is at the end.
#[test]
fn a_coil_brings_a_turn_per_wrap_as_elements_are_born() {
    for wrap in [2.0, -1.5] {
        let set = [format!("wrap={wrap} m"), "disc=1e9".into(), "n=3".into(), "tol=1e-7".into()];
        let h = run(&damped(&born()), &set);
        let (angle, torque) =
            (h.column("wire.end.angle").expect("angle"), h.column("wire.start.torque").expect("torque"));
        for (k, t) in h.times().iter().enumerate() {
            let exact = 2.0 + TAU * 0.5 * t / wrap;
            let moment = 0.05 * exact / (1.0 + 0.5 * t);
            assert!((angle[k] - exact).abs() < 1e-6, "{wrap} {t}: {} {exact}", angle[k]);
            assert!((torque[k] - moment).abs() < 3e-5, "{wrap} {t}: {} {moment}", torque[k]);
        }
    }
}

/// A slack bar that is pulled out and back: laid rope, spinning shaft or strip, it does what it does where its elements only
/// grow and shrink, and its energy balances.
#[test]
fn ropes_shafts_and_strips_go_out_and_back() {
    let forces = "\n[[forces]]\ntype = \"gravity\"\n[[forces]]\ntype = \"point_force\"\nmarker = \"disc\"\nforce = [0.05, 0.02, 0]\n\
                  [[records]]\ntype = \"position\"\nof = \"disc\"\n[[records]]\ntype = \"along\"\nof = \"wire\"\nwhat = \"torque\"\nat = \"end\"";
    let table = "t = [0, 1, 2, 4]\nv = [1, 1, -1, -1]";
    for more in ["torque_tension = 2", "gyroscopic = true", "FLAT"] {
        let section = format!(
            "ea = 300, ei = 0.05, gj = 0.05, axial_retardation_time = 1e-2, torsional_retardation_time = 1e-2, rotary_inertia = 1e-4, {more}"
        );
        let text = FED
            .replace("ea = 1e4, ei = 5, gj = 0.05, rotary_inertia = \"$inertia\"", &section)
            .replace("duration = 10", "duration = 2.6")
            .replace("output = 0.5", "output = 0.1")
            .replace("t = [0, 100]\nv = [0.5, 0.5]", table)
            .replace("[0,0,-1]", "[0,0,-2]")
            .replace("velocity = [0,0,-0.5]", "velocity = [0,0,-1]")
            .replace("mass = 1\ninertia", "mass = 0.2\ninertia")
            + forces;
        let text = match more {
            "FLAT" => text
                .replace(", FLAT", "")
                .replace("laid_twist = 2", "laid_twist = 2\nnormal = [1, 0, 0]")
                .replace("ei = 0.05", "ei = [0.05, 0.12]"),
            _ => text,
        };
        let set = ["wrap=4 m".to_string(), "n=8".into(), "disc=2e-4".into(), "tol=1e-6".into()];
        let elements = "wrap = \"$wrap\"\nelement_length = 0.25\nfade = 0.1";
        let short = text.replace("wrap = \"$wrap\"", elements);
        let (whole, parts) = (run(&text, &set), run(&short, &set));
        let seen = changes(&short, &set, 2.6);
        let last = |h: &History, name: &str| *h.column(name).expect(name).last().expect("a row");
        let of = |h: &History| ["disc.x", "disc.y", "disc.z", "wire.end.torque"].map(|name| last(h, name));
        let (a, b) = (of(&whole), of(&parts));
        let energy = parts.summary().energy;
        println!("{:?}", whole.summary().energy);
        println!("{more}: {a:?} {b:?} {} changes, {energy:?}", seen.len());
        assert!(seen.len() >= 4, "{more}: {}", seen.len());
        for i in 0..3 {
            assert!((a[i] - b[i]).abs() <= 1e-2, "{more}: {a:?} {b:?}");
        }
        assert!((a[3] - b[3]).abs() <= 2e-3, "{more}: {a:?} {b:?}");
        assert!(energy.imbalance.abs() <= 5e-3, "{more}: {energy:?}");
    }
}

/// A run whose mesh has changed goes on from a checkpoint to the last bit, twist within its elements included.
#[test]
fn births_of_twisted_elements_go_on_from_a_checkpoint_to_the_last_bit() {
    let strip = born()
        .replace("ei = 5", "ei = [0.05, 0.12]")
        .replace("laid_twist = 2", "laid_twist = 2\nnormal = [1, 0, 0]")
        + "\n[[forces]]\ntype = \"point_force\"\nmarker = \"disc\"\nforce = [0.2, 0.1, -2]";
    for text in [born(), strip] {
        let scene = scene(&text, &["wrap=2 m".to_string(), "n=3".into()]);
        let build = || scene.build().unwrap_or_else(|e| panic!("{e}"));
        let mut one = Simulation::new(build(), &scene.solver, 6.0).unwrap_or_else(|e| panic!("{e}"));
        one.advance(3.0, 0.5, &mut ()).unwrap_or_else(|e| panic!("{e}"));
        let kept = one.checkpoint().unwrap_or_else(|e| panic!("{e}"));
        assert!(!kept.meshes.is_empty(), "no element was born");
        let model = build().remesh(&kept.meshes).unwrap_or_else(|e| panic!("{e}"));
        let mut other =
            Simulation::restore(model, &scene.solver, 6.0, kept).unwrap_or_else(|e| panic!("{e:?}"));
        for s in [&mut one, &mut other] {
            s.advance(6.0, 0.5, &mut ()).unwrap_or_else(|e| panic!("{e}"));
        }
        assert_eq!(one.state.q, other.state.q);
        assert_eq!(one.state.v, other.state.v);
    }
}
