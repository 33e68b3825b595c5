//! Towing: the steady state of a long run against references that solve for it directly.

use crate::common::{data, hose, law, number, place, size, tow_start, towed};
use ropewalk_constraints::DrivingSpec;
use ropewalk_constraints::motion::{CircleSpec, StraightSpec, Towards};
use ropewalk_core::Simulation;
use ropewalk_core::integrator::{Options, Scheme, Stepping};
use ropewalk_core::statics::{Statics, StaticsOptions};
use ropewalk_elements::Section;
use ropewalk_scene::Scene;

/// Nearly inextensible and limp, with a little damping against axial ringing.
fn limp(ea: f64, ei: f64) -> Section {
    Section { axial_retardation_time: 1e-3, ..hose(ea, ei) }
}

/// End relative to the ship's point, and the force on the ship, after a run.
fn steady(scene: &Scene, duration: f64, tolerance: f64) -> ([f64; 3], f64, u64) {
    let model = scene.build().expect("model");
    let options = Options {
        scheme: Scheme::GeneralizedAlpha { rho_inf: 0.0 },
        stepping: Stepping::Controlled { tolerance },
        // tensions are compared to a thousandth
        force_tolerance: 1e-3,
        ..Options::default()
    };
    let mut s = Simulation::new(model, &options, duration).unwrap_or_else(|e| panic!("{e}"));
    s.keep_audit(false);
    s.advance(duration, f64::INFINITY, &mut ()).unwrap_or_else(|e| panic!("{e}"));
    let (start, end) = (place(&s.model, &s.state, "hose", 0.0), place(&s.model, &s.state, "hose", 30.0));
    ropewalk_core::integrator::consistent(&s.model, &mut s.state, &mut s.work).expect("forces");
    let node = s.model.constraints()[0].nodes()[0];
    let r = s.model.reaction(0, node, &s.state.at(), &s.state.lambda);
    (std::array::from_fn(|i| end[i] - start[i]), size([r[0], r[1], r[2]]), s.work.counts.steps)
}

#[test]
fn straight_run_settles_at_the_reference() {
    for c in data("tow_straight.json")["free_end"].as_array().expect("cases") {
        // with little drag along it, the limp hose flutters: its tension is below `m U²`.
        // It is straight in the end, so that bending stiffness changes nothing but the way there
        let ei = if c["model"] == "choo" { 20.0 } else { 0.1 };
        let mut scene = towed([0.0; 3], [-30.0, 0.0, 0.0], 20, limp(1e8, ei), law(&c["model"]));
        scene.motion(StraightSpec {
            name: "course".into(),
            speed: number(&c["U"]),
            direction: [1.0, 0.0, 0.0],
            start: 0.0,
            ramp: 5.0,
        });
        scene.constraint(DrivingSpec::new("ship", "hose.start", "course"));
        let (end, force, steps) = steady(&scene, 60.0, 1e-5);
        let (height, tension) = (end[2] - number(&c["end_height"]), force / number(&c["T_top"]) - 1.0);
        println!("{} {} kn: height {height:.1e}, tension {tension:.1e}, {steps} steps", c["model"], c["kn"]);
        assert!(
            height.abs() < 1e-4 && tension.abs() < 1e-3,
            "{} {} kn: {height:e} {tension:e}",
            c["model"],
            c["kn"]
        );
    }
}

#[test]
fn turn_settles_at_the_reference() {
    for c in data("tow_turn.json")["cases"].as_array().expect("cases") {
        let Some(exact) = c["solutions"].get(0) else { continue };
        let mut scene = towed([0.0; 3], [-30.0, 0.0, 0.0], 20, limp(1e7, 0.1), law(&c["model"]));
        scene.motion(CircleSpec {
            name: "course".into(),
            speed: number(&c["U"]),
            radius: number(&c["R"]),
            heading: [1.0, 0.0, 0.0],
            towards: Towards::Port,
            start: 0.0,
            ramp: 5.0,
        });
        scene.constraint(DrivingSpec::new("ship", "hose.start", "course"));
        let (end, force, steps) = steady(&scene, if c["kn"] == 5 { 120.0 } else { 40.0 }, 1e-5);
        let (height, tension) =
            (end[2] - number(&exact["end_height"]), force / number(&exact["T_top"]) - 1.0);
        println!("turn {} kn: height {height:.1e}, tension {tension:.1e}, {steps} steps", c["kn"]);
        assert!(height.abs() < 1e-3 && tension.abs() < 1e-3, "{} kn: {height:e} {tension:e}", c["kn"]);
    }
}

#[test]
fn error_control_keeps_its_promise_when_a_tow_starts() {
    // from hanging at rest: no shock but that of the ship
    let points = |stepping: Stepping| {
        let scene = tow_start();
        let options = Options { stepping, ..Options::default() };
        let model = scene.build().expect("model");
        let mut state = model.state();
        let mut statics = Statics::new(&model, &StaticsOptions::default()).expect("statics");
        statics.find(&mut state, true).unwrap_or_else(|e| panic!("{e}"));
        drop(statics);
        let mut s = Simulation::from(model, state, &options, 8.0).expect("start");
        s.keep_audit(false);
        let mut all = Vec::new();
        for k in 1..=16 {
            s.advance(0.5 * f64::from(k), f64::INFINITY, &mut ()).unwrap_or_else(|e| panic!("{e}"));
            all.extend((1..=10).map(|j| place(&s.model, &s.state, "hose", 3.0 * f64::from(j))));
        }
        (all, s.work.counts)
    };
    let exact = points(Stepping::Controlled { tolerance: 1e-7 }).0;
    for tolerance in [1e-3, 1e-4, 1e-5, 1e-6] {
        let (got, counts) = points(Stepping::Controlled { tolerance });
        // the mean over the hose, as the tolerance is meant; the worst instant
        let error = got
            .chunks(10)
            .zip(exact.chunks(10))
            .map(|(a, b)| {
                let square =
                    |(a, b): (&[f64; 3], &[f64; 3])| (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>();
                (a.iter().zip(b).map(square).sum::<f64>() / 10.0).sqrt()
            })
            .fold(0.0f64, |m, e| if e.is_nan() { f64::INFINITY } else { m.max(e) });
        let ratio = error / 30.0 / tolerance;
        println!("tolerance {tolerance:e}: true error {ratio:.3} of it, {counts:?}");
        assert!((0.05..5.0).contains(&ratio), "tolerance {tolerance:e}: {ratio}");
    }
}
