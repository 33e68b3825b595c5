//! Elements that are born and swallowed at a winch: tension and mesh on the way out and back.

use super::winch::{fixed, go, hang, hanging, hung};
use ropewalk_constraints::WinchSpec;
use ropewalk_core::integrator::Options;
use ropewalk_core::{End, Simulation};
use ropewalk_elements::{CableSpec, Section};

/// Watches the mesh change.
#[derive(Default)]
struct Meshes(Vec<ropewalk_core::Remeshed>, f64);

impl ropewalk_core::Observer for Meshes {
    fn remeshed(&mut self, report: &ropewalk_core::Remeshed) {
        self.0.push(report.clone());
    }
    fn needs_forces(&self) -> bool {
        true
    }
    fn sample(&mut self, s: &ropewalk_core::Sample<'_>) -> std::ops::ControlFlow<()> {
        let all = s.model.constraints();
        let c = all.iter().position(|c| c.name() == "eyelet").expect("the eyelet");
        self.1 = s.model.reaction(c, all[c].nodes()[0], &s.at, s.lambda)[2];
        std::ops::ControlFlow::Continue(())
    }
}

/// Feeds out by `way` at 1 m/s and back again: a table of lengths with smooth ramps of 2 s.
fn haul(way: f64) -> ropewalk_constraints::motion::SpeedTableSpec {
    let turn = way + 2.0;
    ropewalk_constraints::motion::SpeedTableSpec {
        name: "haul".into(),
        direction: [1.0, 0.0, 0.0],
        file: None,
        t: vec![0.0, 2.0, way, turn, turn + 2.0, turn + 4.0, turn + 2.0 + way, 2.0 * way + 6.0],
        v: vec![0.0, 1.0, 1.0, 0.0, 0.0, -1.0, -1.0, 0.0],
        join: ropewalk_core::Join::Monotone,
    }
}

/// What a hanging cable was found to do on its way out and back.
#[derive(Debug)]
struct Hauled {
    /// Largest error of the tension at the top, relative.
    tension: f64,
    /// Largest error of the end's height [m].
    tip: f64,
    /// Largest jump of the tension at a change of the mesh, relative, and of momentum [kg m/s].
    jump: f64,
    impulse: f64,
    changes: usize,
    /// Steps in all, those on earlier meshes included.
    steps: u64,
    /// Imbalance of energy over the largest term.
    imbalance: f64,
}

/// Hangs in air, or in water which slows the ends of ramps a little.
fn out_and_back(way: f64, element: Option<f64>, eta: f64, elements: usize, water: bool) -> Hauled {
    hauled(way, element, eta, Divided::Evenly(elements), water)
}

/// How a cable is divided.
enum Divided {
    Evenly(usize),
    Into(Vec<f64>),
}

fn hauled(way: f64, element: Option<f64>, eta: f64, divided: Divided, water: bool) -> Hauled {
    let (l0, ea, m) = (1.0, 1e6, 1.0);
    let mut section = Section::new(m, ea, 0.0);
    (section.axial_retardation_time, section.diameter) = (eta, 0.02);
    let winch = WinchSpec { element_length: element, ..WinchSpec::motion("winch", "rope.start", "haul") };
    let mut scene = match divided {
        Divided::Evenly(elements) => hanging(l0, elements, section, winch, 9.81),
        Divided::Into(lengths) => {
            let mesh = Some(ropewalk_elements::cable::MeshSpec::Lengths(lengths));
            let rope = CableSpec::straight("rope", [0.0; 3], [0.0, 0.0, -l0], 0, section);
            hung(CableSpec { mesh, ..rope }, winch, 9.81)
        }
    };
    scene.motion(haul(way));
    let mut w = m * 9.81;
    let (rho, ct) = (1025.0, 0.01);
    if water {
        scene.water = Some(ropewalk_scene::Water { density: rho, ..Default::default() });
        scene
            .force(ropewalk_forces::BuoyancySpec::default())
            .force(ropewalk_forces::DragSpec { cn: 1.2, ct, ..Default::default() })
            .force(ropewalk_forces::AddedMassSpec::default());
        w -= rho * std::f64::consts::FRAC_PI_4 * 0.02 * 0.02 * 9.81;
    }
    let scheme = ropewalk_core::integrator::Scheme::GeneralizedAlpha { rho_inf: 0.5 };
    let options = Options { scheme, ..fixed(0.01) };
    let mut s = hang(&scene, &options, ea, w, l0);
    let motion = ropewalk_scene::MotionSpec::build(&haul(way), &[]).expect("motion");
    let mut seen = Meshes::default();
    let mut out =
        Hauled { tension: 0.0, tip: 0.0, jump: 0.0, impulse: 0.0, changes: 0, steps: 0, imbalance: 0.0 };
    let end = 2.0 * way + 6.0;
    for k in 1..=(10.0 * end) as usize {
        let t = 0.1 * k as f64;
        let ended = s.advance(t, f64::INFINITY, &mut seen).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(ended, End::Done, "at {} s", s.state.t);
        let now = motion.at(t);
        let l = l0 + now.x[0];
        // drag along the cable, which moves down at the speed of feeding
        let drag = if water {
            0.5 * rho * std::f64::consts::PI * 0.02 * ct * now.v[0] * now.v[0].abs()
        } else {
            0.0
        };
        let top = (w - drag - m * now.a[0]) * l;
        out.tension = out.tension.max(((seen.1 - top) / top).abs());
        let part = s.model.part("rope").expect("rope");
        let at = s.state.at();
        let length = part.length_now(&at);
        assert!((length - l).abs() < 1e-12 * l, "length at {t} s: {length} for {l}");
        let (x, _) = part.point(length, &at).expect("the end");
        out.tip = out.tip.max((x[2] + l + w * l * l / (2.0 * ea)).abs());
        // a NaN is no small error
        assert!(seen.1.is_finite() && x[2].is_finite());
    }
    for m in &seen.0 {
        out.jump = out.jump.max((m.jump() / m.tension[0]).abs());
        out.impulse = out.impulse.max(m.impulse());
    }
    out.changes = seen.0.len();
    out.steps = s.work.counts.steps;
    out.imbalance = s.audit.imbalance() / s.audit.scale;
    out
}

/// Short elements at the end that feeds stay there, with their lengths, while others are born and swallowed behind them.
#[test]
fn a_graded_end_stays_graded_while_it_feeds() {
    let lengths = vec![0.02, 0.03, 0.05, 0.5, 0.4];
    let hauled = hauled(6.0, Some(0.4), 0.01, Divided::Into(lengths.clone()), false);
    eprintln!("{hauled:?}");
    assert!(hauled.changes > 10 && hauled.tension < 5e-3 && hauled.tip < 1e-2, "{hauled:?}");
    assert!(hauled.jump < 5e-3 && hauled.impulse < 1e-4 && hauled.imbalance.abs() < 1e-5, "{hauled:?}");

    let section = Section { axial_retardation_time: 0.01, ..Section::new(1.0, 1e6, 0.0) };
    let rope = CableSpec {
        mesh: Some(ropewalk_elements::cable::MeshSpec::Lengths(lengths)),
        ..CableSpec::straight("rope", [0.0; 3], [0.0, 0.0, -1.0], 0, section)
    };
    let winch = WinchSpec { element_length: Some(0.4), ..WinchSpec::speed("winch", "rope.start", 1.0) };
    let scene = hung(rope.clone(), winch.clone(), 9.81);
    let mut s = Simulation::new(scene.build().expect("model"), &fixed(0.01), 4.0).expect("start");
    go(&mut s, 4.0);
    let mesh = s.model.part("rope").expect("rope").line().expect("a line").mesh_now(&s.state.at());
    assert!(mesh.len() > 9);
    for (k, l) in [0.02, 0.03, 0.05].into_iter().enumerate() {
        assert!((mesh[k + 1] - mesh[k] - l).abs() < 1e-9, "{mesh:?}");
    }
    let too_fine = WinchSpec { element_length: Some(0.49), ..winch };
    let rope = CableSpec { mesh: Some(ropewalk_elements::cable::MeshSpec::Lengths(vec![0.2; 5])), ..rope };
    let refused = hung(rope, too_fine, 9.81).build().err().expect("all elements are short").error;
    assert!(refused.message.contains("grade it less"), "{}", refused.message);
}

#[test]
fn cable_is_paid_out_and_reeled_in_with_the_right_tension() {
    for (element, elements, water) in [(None, 10, false), (Some(0.4), 3, false), (Some(0.4), 3, true)] {
        let hauled = out_and_back(6.0, element, 0.01, elements, water);
        eprintln!("{element:?} {water}: {hauled:?}");
        assert!(hauled.tension < 5e-3 && hauled.tip < 1e-2, "{element:?}, water {water}: {hauled:?}");
        assert!(hauled.jump < 5e-3 && hauled.impulse < 1e-4, "{element:?}, water {water}: {hauled:?}");
        assert!(hauled.imbalance.abs() < 1e-5, "{element:?}, water {water}: {hauled:?}");
        assert_eq!(hauled.changes > 10, element.is_some());
        assert!(hauled.steps >= 1800, "{hauled:?}");
    }
}

#[test]
#[ignore = "the whole way from 1 m to 50 m and back, eight times: half a minute"]
fn cable_is_paid_out_to_fifty_metres_and_back() {
    for water in [false, true] {
        for (element, elements, eta) in
            [(None, 20, 0.01), (Some(0.45), 2, 0.01), (Some(0.45), 2, 0.001), (Some(0.45), 2, 0.1)]
        {
            let begin = std::time::Instant::now();
            let hauled = out_and_back(49.0, element, eta, elements, water);
            let ms = 1e3 * begin.elapsed().as_secs_f64() / 104.0;
            eprintln!("{element:?}, eta {eta} s, water {water}: {hauled:?}, {ms:.1} ms per second");
            assert!(hauled.tension < 5e-3 && hauled.tip < 1e-2, "{hauled:?}");
            assert!(hauled.jump < 5e-3 && hauled.imbalance.abs() < 1e-5, "{hauled:?}");
        }
    }
}
