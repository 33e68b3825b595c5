//! Reeling a towed hose in: against its quasi-steady shape, the steady tows of the references, its own limit of no speed
//! and the balance of energy; and what can't be reeled.

use crate::common::{data, hose, number, place, tow_start, towed};
use ropewalk::{History, SceneFile, bundled, simulate};
use ropewalk_constraints::{SphericalSpec, WinchSpec};
use ropewalk_core::integrator::{Options, Stepping};
use ropewalk_core::statics::{Statics, StaticsOptions};
use ropewalk_core::{End, Simulation};
use ropewalk_elements::Section;
use ropewalk_forces::DragLaw;
use ropewalk_scene::records::{LengthSpec, PositionSpec};
use ropewalk_scene::{ConstraintSpec, Scene};

fn winch(speed: f64) -> WinchSpec {
    WinchSpec::speed("winch", "hose.start", speed)
}

/// A bundled scene with some parameters set, run to its end.
fn bundled_run(scene: &str, set: &[String]) -> History {
    let file = SceneFile::open(scene, set, bundled()).unwrap_or_else(|e| panic!("{e}"));
    simulate(file.scene()).unwrap_or_else(|e| panic!("{scene} {set:?}: {e}"))
}

#[test]
fn a_winch_without_speed_costs_nothing_and_changes_no_bit() {
    let without = tow_start();
    let mut with = tow_start();
    with.constraint(WinchSpec { final_length: Some(3.0), element_length: Some(0.5), ..winch(0.0) });
    let results = [without, with].map(|scene| {
        let model = scene.build().unwrap_or_else(|e| panic!("{e}"));
        let size = (model.velocities(), model.multipliers(), model.events().len(), model.terms().len());
        let options = Options { stepping: Stepping::Controlled { tolerance: 1e-3 }, ..Options::default() };
        let mut s = Simulation::new(model, &options, 2.0).unwrap_or_else(|e| panic!("{e}"));
        s.advance(2.0, f64::INFINITY, &mut ()).unwrap_or_else(|e| panic!("{e}"));
        (size, s.state.q.clone(), s.state.v.clone(), s.state.lambda.clone())
    });
    assert_eq!(results[0], results[1]);
}

/// A hose that streams steadily in water that comes at it, and is reeled in from one length to another.
fn streaming(speed: f64, angle: f64, elements: usize) -> Scene {
    let end = [-30.0 * angle.cos(), 0.0, -30.0 * angle.sin()];
    let section = Section { axial_retardation_time: 0.01, ..hose(1e6, 2.0) };
    let mut scene = towed([0.0; 3], end, elements, section, DragLaw::Constant);
    scene.water.as_mut().expect("water").current = [-speed, 0.0, 0.0];
    scene
        .constraint(SphericalSpec::new("ship", "hose.start", [0.0; 3]))
        .record(PositionSpec::new("hose.end"))
        .record(PositionSpec::new("hose@50%"))
        .record(LengthSpec::new("hose"));
    scene.run.output = 0.5;
    scene.solver.stepping = Stepping::Controlled { tolerance: 1e-4 };
    scene
}

#[test]
fn the_end_rises_quasi_steadily_while_a_straight_tow_is_reeled_in() {
    for c in data("tow_straight.json")["free_end"].as_array().expect("cases") {
        if c["model"] == "choo" {
            continue;
        }
        let (speed, angle) = (number(&c["U"]), number(&c["phi_c_rad"]));
        let mut scene = streaming(speed, angle, 6);
        scene.constraint(WinchSpec { start: 2.0, final_length: Some(20.0), ..winch(0.4) });
        scene.run.duration = 29.0;
        let history = simulate(&scene).unwrap_or_else(|e| panic!("{e}"));
        let of = |name: &str| history.column(name).unwrap_or_else(|| panic!("no {name}"));
        let (end, centre, length) = (of("hose.end.z"), of("hose@50%.z"), of("hose.length"));
        let mut worst = [0.0_f64; 2];
        for k in 0..length.len() {
            let exact = -length[k] * angle.sin();
            for (worst, z) in worst.iter_mut().zip([end[k] / exact, 2.0 * centre[k] / exact]) {
                let error = (z - 1.0).abs();
                *worst = if error.is_nan() { f64::INFINITY } else { worst.max(error) };
            }
        }
        let last = length[length.len() - 1];
        println!("{} kn: end {:.1e}, centre {:.1e}, {:?}", c["kn"], worst[0], worst[1], history.counts);
        assert!((last - 20.0).abs() < 1e-9, "{last}");
        assert!(worst[0] < 0.01 && worst[1] < 0.01, "{} kn: {worst:?}", c["kn"]);
    }
}

/// Heights of the end that the references tell, by course and speed.
fn reference(course: &str, kn: u32) -> f64 {
    let all = match course {
        "straight" => data("tow_straight.json")["free_end"].clone(),
        _ => data("tow_turn.json")["cases"].clone(),
    };
    let own = all.as_array().expect("cases").iter().find(|c| {
        let free = course == "straight" || (c["body"].is_null() && number(&c["R"]) == 25.0);
        c["model"] == "const" && c["kn"] == kn && free
    });
    let own = own.expect("a reference");
    number(if course == "straight" { &own["end_height"] } else { &own["solutions"][0]["end_height"] })
}

/// Runs the bundled scene with some windings and compares its end with the reference, and with that of no winding.
fn settles(course: &str, kn: u32, start: u32, more: &[&str]) {
    let exact = reference(course, kn);
    let height = |winding: &str, length: f64| {
        let mut set = vec![
            format!("speed={kn} kn"),
            format!("start={start} s"),
            format!("winding={winding}"),
            // as the references have it
            "theory=morison".into(),
            format!("end=['-{length} m', 0, 0]"),
        ];
        set.extend(more.iter().map(|s| s.to_string()));
        let history = bundled_run(&format!("hose-{course}"), &set);
        assert_eq!(history.stopped_by, None);
        (history.last("height.z").expect("height"), history.last("hose.length").expect("length"))
    };
    let [none, creeping, slow] = ["0", "1e-9", "1e-3"].map(|winding| height(winding, 30.0));
    println!("{course} {kn} kn from {start} s: {exact:.6}, {none:?}, {creeping:?}, {slow:?}");
    assert!((none.0 - exact).abs() < 2e-3, "{course} {kn} kn from {start} s: {none:?}, not {exact}");
    assert!(
        (creeping.0 - none.0).abs() < 1e-3,
        "{course} {kn} kn from {start} s: {creeping:?}, not {none:?}"
    );
    // a little shorter, it ends a little higher: straight in proportion, in a turn as if it had been laid as short
    let laid = if course == "straight" { none.0 * slow.1 / none.1 } else { height("0", slow.1).0 };
    assert!((slow.0 / laid - 1.0).abs() < 1e-3, "{course} {kn} kn from {start} s: {slow:?}, not {laid}");
}

#[test]
fn scenes_settle_at_the_references_with_and_without_a_winch() {
    let quick = ["elements=10", "duration=40 s"];
    settles("straight", 15, 1, &quick);
    settles("turn", 15, 1, &quick);
}

#[test]
#[ignore = "63 runs of three to five minutes each, about two minutes"]
fn every_usual_case_settles_at_its_reference_with_and_without_a_winch() {
    for course in ["straight", "turn"] {
        for kn in [5, 15, 25] {
            for start in [40, 80, 120] {
                settles(course, kn, start, &[]);
            }
        }
    }
}

#[test]
fn a_scene_winds_in_and_says_how_fast() {
    let set =
        ["speed=25 kn", "start=0.5 s", "ramp=2 s", "winding=1", "rest=20 m", "elements=10", "duration=18 s"];
    let set = set.map(String::from);
    let file = SceneFile::open("hose-straight", &set, bundled()).unwrap_or_else(|e| panic!("{e}"));
    let model = file.build().unwrap_or_else(|e| panic!("{e}"));
    let manifest = ropewalk::Manifest::new(&file, &model).unwrap_or_else(|e| panic!("{e}"));
    // v = V l √(ρA/EI)
    let v = 3.0 * (0.861_f64 / 2.0).sqrt();
    assert!(
        manifest.notes[0].contains(&format!("in at V = 1 m/s, v = V T / L = {v:.4}")),
        "{:?}",
        manifest.notes
    );
    let history = simulate(file.scene()).unwrap_or_else(|e| panic!("{e}"));
    let length = history.last("hose.length").expect("length");
    let height = history.last("height.z").expect("height");
    assert!((length - 20.0).abs() < 1e-9, "{length}");
    let exact = reference("straight", 25) * 20.0 / 30.0;
    assert!((height / exact - 1.0).abs() < 0.05, "{height}, not {exact}");
    assert_eq!(
        history.column("hose.centre.z").map(<[f64]>::len),
        history.column("height.z").map(<[f64]>::len)
    );
}

#[test]
fn energy_of_reeling_in_closes_at_second_order() {
    let mut imbalance = Vec::new();
    for h in [4e-3, 2e-3, 1e-3] {
        let section =
            Section { axial_retardation_time: 0.01, bending_retardation_time: 0.01, ..hose(1e5, 2.0) };
        let mut scene = towed([0.0; 3], [0.0, 0.0, -30.0], 8, section, DragLaw::Constant);
        scene.motion(ropewalk_constraints::motion::StraightSpec {
            name: "course".into(),
            speed: 2.0,
            direction: [1.0, 0.0, 0.0],
            start: 0.0,
            ramp: 1.0,
        });
        scene
            .constraint(ropewalk_constraints::DrivingSpec::new("ship", "hose.start", "course"))
            .constraint(WinchSpec { start: 0.2, stop: Some(2.2), ..winch(-1.5) });
        let model = scene.build().unwrap_or_else(|e| panic!("{e}"));
        let mut state = model.state();
        let mut statics = Statics::new(&model, &StaticsOptions::default()).expect("statics");
        statics.find(&mut state, true).unwrap_or_else(|e| panic!("{e}"));
        drop(statics);
        let options = Options { stepping: Stepping::Fixed { h }, ..Options::default() };
        let mut s = Simulation::from(model, state, &options, 4.0).unwrap_or_else(|e| panic!("{e}"));
        s.advance(4.0, f64::INFINITY, &mut ()).unwrap_or_else(|e| panic!("{e}"));
        let a = &s.audit;
        let largest = [a.kinetic, a.potential, a.supplied, a.carried, a.dissipated];
        let largest = largest.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        println!("h = {h}: {:e} J of {largest} J, {a:?}", a.imbalance());
        imbalance.push(a.imbalance().abs() / largest);
    }
    let ratios: Vec<f64> = imbalance.windows(2).map(|w| w[0] / w[1]).collect();
    assert!(imbalance[2] < 1e-5, "{imbalance:?}");
    assert!(ratios.iter().all(|r| *r > 3.5), "{imbalance:?}: {ratios:?}");
}

/// A hose that hangs short in still water.
fn short(winch: WinchSpec) -> Scene {
    let section = Section { axial_retardation_time: 0.01, ..hose(1e6, 2.0) };
    let mut scene = towed([0.0; 3], [0.0, 0.0, -30.0], 4, section, DragLaw::Constant);
    scene.constraint(SphericalSpec::new("ship", "hose.start", [0.0; 3])).constraint(winch);
    scene
}

#[test]
fn a_run_ends_where_a_winch_is_at_its_limits() {
    for (winch, end, length) in [
        (winch(-10.0), "`winch` has reeled in `hose` to its shortest, 1.5 m", 1.5),
        (
            WinchSpec { shortest: Some(4.0), ..winch(-10.0) },
            "`winch` has reeled in `hose` to its shortest, 4 m",
            4.0,
        ),
        (WinchSpec { stored_length: 6.0, ..winch(1.0) }, "`winch` has paid out all of its 6 m", 36.0),
    ] {
        let model = short(winch).build().unwrap_or_else(|e| panic!("{e}"));
        let options = Options { stepping: Stepping::Controlled { tolerance: 1e-4 }, ..Options::default() };
        let mut s = Simulation::new(model, &options, 10.0).unwrap_or_else(|e| panic!("{e}"));
        let ended = s.advance(10.0, f64::INFINITY, &mut ()).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(ended, End::Stopped { by: end.into() });
        let out = s.model.part("hose").expect("hose").length_now(&s.state.at());
        assert!((out - length).abs() < 1e-6, "{out}");
        let tip = place(&s.model, &s.state, "hose", out);
        assert!((tip[2] + length).abs() < 0.01, "{tip:?}");
    }
}

/// What a test changes of a winch.
type Change<'a> = &'a dyn Fn(&mut WinchSpec);

#[test]
fn what_cannot_be_reeled_is_refused() {
    let with = |change: &dyn Fn(&mut WinchSpec)| {
        let mut spec = winch(-1.0);
        change(&mut spec);
        let e = short(spec).build().err().unwrap_or_else(|| panic!("it builds"));
        (e.error.field.unwrap_or_default(), e.error.message)
    };
    let cases: [(Change<'_>, &str, &str); 16] = [
        (&|w| w.tension = Some(5.0.into()), "tension", "the speed of this winch is prescribed"),
        (&|w| w.ramp = 0.0, "ramp", "jump of velocity"),
        (&|w| w.payout = Some(5.0), "payout", "their signs must be the same"),
        (&|w| w.payout = Some(0.0), "payout", "never pays out 0 m"),
        (&|w| w.payout = Some(f64::NAN), "payout", "never pays out NaN m"),
        (&|w| w.payout = Some(-0.5), "payout", "over before the speed has risen"),
        (&|w| (w.payout, w.stop) = (Some(-5.0), Some(9.0)), "payout", "not both"),
        (&|w| (w.payout, w.final_length) = (Some(-5.0), Some(9.0)), "final_length", "not both"),
        (&|w| w.final_length = Some(30.0), "final_length", "30 m long already"),
        (&|w| w.final_length = Some(31.0), "final_length", "can't be reeled in to 31 m"),
        (&|w| w.final_length = Some(-1.0), "final_length", "must be positive"),
        (&|w| w.final_length = Some(1.0), "final_length", "the run ends at 1.5 m"),
        (&|w| w.stop = Some(0.5), "stop", "before its speed has risen"),
        (&|w| (w.speed, w.tension, w.payout) = (None, Some(5.0.into()), Some(1.0)), "payout", "has none"),
        (&|w| (w.speed, w.motion, w.stop) = (None, Some("haul".into()), Some(9.0)), "stop", "has none"),
        // of a winch that isn't one, too
        (&|w| (w.speed, w.ramp) = (Some(0.0.into()), 0.0), "ramp", "jump of velocity"),
    ];
    for (change, field, message) in cases {
        let got = with(change);
        assert!(got.0 == field && got.1.contains(message), "{got:?}: not {field}, {message}");
    }
    let spec = WinchSpec { final_length: Some(40.0), ..winch(1.0) };
    assert!(short(spec.clone()).build().is_ok());
    assert!(
        spec.notes(&short(spec.clone()).build().expect("model"))[0].contains("reels `hose` out at V = 1 m/s")
    );
}
