//! Cables with torsion that feed at a winch: twist travels with the material.

use super::{case, number, run, scene};
use ropewalk::{Options, RunOptions, Simulation};
use ropewalk_core::integrator::{Scheme, Stepping};
use ropewalk_core::statics::{Statics, StaticsOptions};
use ropewalk_core::{Observer, Quantity, dot};
use ropewalk_scene::{Format, SceneFile};
use std::f64::consts::TAU;

const FED: &str = include_str!("fed.toml");

/// A body turns on a cable that is fed from an end that is held: its frequency falls as the cable grows (Bessel functions).
#[test]
fn a_torsional_pendulum_on_a_cable_that_grows() {
    let case = case("feeding_torsional_pendulum");
    let exact: Vec<[f64; 2]> = case["results"]["t_theta"]
        .as_array()
        .expect("rows")
        .iter()
        .map(|row| [number(&row[0]), number(&row[1])])
        .collect();
    for elements in [1, 4] {
        let h = run(FED, &[format!("n={elements}")]);
        let angle = h.column("wire.end.angle").expect("an angle");
        for [t, theta] in &exact {
            let row = h.times().iter().position(|x| (x - t).abs() < 1e-9).expect("a time");
            println!("{elements} elements, {t} s: {} {theta}, {:.1e}", angle[row], angle[row] - theta);
            assert!((angle[row] - theta).abs() < 1e-5, "{elements} elements, {t} s: {} {theta}", angle[row]);
        }
    }
    // the balance of energy has the power at the steps alone
    let imbalance = ["1e-6", "1e-8"]
        .map(|tol| run(FED, &[format!("tol={tol}"), "n=1".into()]).summary().energy.imbalance.abs());
    println!("{imbalance:?}");
    assert!(imbalance[0] < 1e-4 && imbalance[1] < 1e-5, "{imbalance:?}");
}

/// Lets the wave of √(GJ ρJ) times the spin that a coil's cable comes with, 1.5e-5 N m, die out: errors below it would ask for
/// steps of a part of its period for ever. While it does, torque is `GJ` times this times the rate of twist off.
pub fn damped(text: &str) -> String {
    text.replace("gj = 0.05", "gj = 0.05, torsional_retardation_time = 1e-4")
}

/// Cable that is pulled over the end of a coil brings a turn per wrap: against a disc that doesn't turn, all of them stay in it.
#[test]
fn a_coil_brings_a_turn_per_wrap() {
    let fed = damped(FED);
    for (wrap, elements) in [(2.0, 1), (-1.5, 4)] {
        let set = [format!("wrap={wrap} m"), "disc=1e9".into(), format!("n={elements}"), "tol=1e-8".into()];
        let h = run(&fed, &set);
        let (angle, torque) =
            (h.column("wire.end.angle").expect("angle"), h.column("wire.start.torque").expect("torque"));
        for (k, t) in h.times().iter().enumerate() {
            let exact = 2.0 + TAU * 0.5 * t / wrap;
            let moment = 0.05 * exact / (1.0 + 0.5 * t);
            assert!((angle[k] - exact).abs() < 1e-6, "{wrap} {t}: {} {exact}", angle[k]);
            assert!((torque[k] - moment).abs() < 3e-5, "{wrap} {t}: {} {moment}", torque[k]);
        }
        let lost = [0.1, 0.025].map(|h| {
            let text =
                fed.replace("controlled = { tolerance = \"$tol\" }", &format!("fixed = {{ h = {h} }}"));
            run(&text, &set).summary().energy.imbalance.abs()
        });
        println!("{wrap}: {lost:?}");
        assert!(lost[1] < 3e-5 && lost[0] > 14.0 * lost[1], "{lost:?}");
    }
}

/// A rope whose torque and tension are coupled, and a shaft that swings while it spins, from a coil: what comes and goes over the
/// end is all that changes their energy.
#[test]
fn ropes_and_shafts_that_feed_keep_their_energy() {
    let forces = "\n[[forces]]\ntype = \"gravity\"\n[[forces]]\ntype = \"point_force\"\nmarker = \"disc\"\nforce = [1, 0.5, 0]";
    for more in ["torque_tension = 2", "gyroscopic = true", "torque_tension = -3, gyroscopic = true", "FLAT"]
    {
        let damped = format!("axial_retardation_time = 1e-2, rotary_inertia = \"$inertia\", {more}");
        let text = FED
            .replace("rotary_inertia = \"$inertia\"", &damped)
            .replace("ea = 1e4, ei = 5", "ea = 300, ei = 0.02")
            .replace("duration = 10", "duration = 3")
            + forces;
        // a strip instead of a round bar
        let text = text.replace(", FLAT", "").replace(
            "laid_twist = 2",
            if more == "FLAT" { "laid_twist = 2\nnormal = [1, 0, 0]" } else { "laid_twist = 2" },
        );
        let text = if more == "FLAT" { text.replace("ei = 0.02", "ei = [0.02, 0.06]") } else { text };
        for wrap in ["2 m", "1e9 m"] {
            let set = [format!("wrap={wrap}"), "inertia=1e-4".into(), "disc=2e-4".into(), "n=4".into()];
            let lost = [0.005, 0.00125].map(|h| {
                let fixed = format!("fixed = {{ h = {h} }}");
                let text = text.replace("controlled = { tolerance = \"$tol\" }", &fixed);
                let energy = run(&text, &set).summary().energy;
                println!("{energy:?}");
                energy.imbalance.abs()
            });
            println!("{more} {wrap}: {lost:?}");
            assert!(lost[1] <= 2e-5 && lost[0] >= 4.0 * lost[1], "{more} {wrap}: {lost:?}");
        }
    }
}

/// A flat bar that a winch has paid out bends as one that was laid as long, with the same elements.
#[test]
fn a_flat_bar_that_is_paid_out_bends_as_one_that_was_laid_so() {
    let out = 0.7;
    let bar = |length: f64, more: &str| {
        format!(
            r#"
            run = {{ duration = 1000 }}
            [[elements]]
            type = "cable"
            name = "bar"
            points = [[0, 0, 0], [{length}, 0, 0]]
            elements = 4
            normal = [0, 0.6, 0.8]
            section = {{ mass = 1, ea = 1e4, ei = [1, 4], gj = 0.8, rotary_inertia = 0.02 }}
            [[constraints]]
            type = "clamp"
            name = "root"
            marker = "bar.start"
            [[forces]]
            type = "point_force"
            marker = "bar.end"
            force = [0.1, 0.3, -0.5]
            {more}
            "#
        )
    };
    let winch = format!(
        "[[constraints]]\ntype = \"winch\"\nname = \"winch\"\nmarker = \"bar.start\"\nspeed = 1\npayout = {out}\nramp = 1e-3"
    );
    let rest = |text: &str, out: f64| {
        let model = scene(text, &[]).build().unwrap_or_else(|e| panic!("{e}"));
        let (part, mut state) = (model.part("bar").expect("bar"), model.state());
        if let Some(boundary) = part.boundary(0) {
            state.q[boundary.q] += boundary.sign * out;
        }
        state.t = 500.0;
        let mut statics = Statics::new(&model, &StaticsOptions::default()).expect("statics");
        statics.find(&mut state, true).unwrap_or_else(|e| panic!("{e}"));
        [1.0, 1.4, 2.0].map(|s| {
            let at = state.at();
            let [a, b] = [Quantity::MomentNormal, Quantity::Angle]
                .map(|what| part.observe(what, s, &at).expect("a value"));
            let (r, _) = part.point(s, &at).expect("a place");
            [r[0], r[1], r[2], a, b]
        })
    };
    let (laid, fed) = (rest(&bar(2.0, ""), 0.0), rest(&bar(2.0 - out, &winch), out));
    println!("{laid:?} {fed:?}");
    assert!(laid[2][4].abs() > 1e-3 && laid[2][2] < -0.1);
    for (a, b) in laid.iter().flatten().zip(fed.iter().flatten()) {
        assert!((a - b).abs() <= 1e-8, "{a} {b}");
    }
}

/// From a coil at one end to a drum at the other that takes cable with the twist that it has: the twist of the cable between them
/// goes towards a turn per wrap, as a first-order lag; the grip of the drum tells how much of it slips.
#[test]
fn twist_goes_along_with_what_is_reeled_in() {
    for grip in [0.5, 20.0] {
        let (text, set) = (include_str!("through.toml"), [format!("grip={grip} N m s/rad")]);
        let h = run(text, &set);
        let torque = h.column("wire@50%.torque").expect("torque");
        let (gj, v, l, inflow) = (0.05, 0.5, 1.0, TAU / 2.0);
        let rate = (v + gj / grip) / l;
        let last = v * inflow / (l * rate);
        let mut worst = 0.0_f64;
        for (k, t) in h.times().iter().enumerate() {
            let off = torque[k] / gj - (last + (2.0 - last) * (-rate * t).exp());
            worst = if off.abs() <= worst { worst } else { off.abs() };
        }
        println!("{grip}: {worst:.1e}");
        assert!(worst < 1e-5, "{grip}: {worst}");
        // what slips in the grip is part of the balance; it begins with a jump, which costs an order
        let energy = [0.02, 0.00125].map(|h| {
            let text = text.replace("controlled = { tolerance = 1e-6 }", &format!("fixed = {{ h = {h} }}"));
            run(&text, &set).summary().energy
        });
        println!("{energy:?}");
        let [coarse, fine] = energy.map(|e| e.imbalance.abs());
        assert!(fine < 2e-5 && coarse > 8.0 * fine && energy[1].dissipated > 1e-3, "{energy:?}");
    }
}

/// What happened, and when.
#[derive(Default)]
struct Told(Vec<(String, f64)>);

impl Observer for Told {
    fn event(&mut self, name: &str, t: f64) {
        self.0.push((name.into(), t));
    }
}

fn told(set: &[String]) -> Vec<(String, f64)> {
    let model = scene(include_str!("slack.toml"), set).build().unwrap_or_else(|e| panic!("{e}"));
    let stepping = Stepping::Fixed { h: 0.05 };
    let options = Options { scheme: Scheme::RadauIia5, stepping, ..Options::default() };
    let mut s = Simulation::new(model, &options, 12.0).unwrap_or_else(|e| panic!("{e}"));
    let mut told = Told::default();
    s.advance(12.0, 1.0, &mut told).unwrap_or_else(|e| panic!("{e}"));
    told.0
}

/// A torque of 1 N m on EI = 1 N m² forms loops below 0.25 N, of which bending takes π² EI/L² in a cable of 20 m.
#[test]
fn a_cable_too_slack_for_its_torque_is_told() {
    let limit = 0.25 - std::f64::consts::PI.powi(2) / 400.0;
    let above = told(&[format!("tension={} N", 1.01 * limit)]);
    assert!(above.is_empty(), "{above:?}");
    let below = told(&[format!("tension={} N", 0.99 * limit)]);
    println!("{below:?}");
    let [(text, t)] = below.as_slice() else { panic!("{below:?}") };
    assert!(text.contains("`rope` may form a loop") && text.contains("M^2/4EI = 0.250 N") && *t < 1e-9);
    // let out while it runs: the instant at which tension has fallen to the limit
    let out = told(&["tension=1 N".into(), "out=2 mm/s".into()]);
    // 1 N is a strain of 1e-3, 20 mm less what it is laid with
    let exact = 20.0 * (1.0 - limit) / 1e3 / 2e-3;
    println!("{out:?} {exact}");
    assert!((out[0].1 - exact).abs() < 0.02 && out.len() == 1, "{out:?} {exact}");
}

/// In statics the same is told of the first equilibrium below the limit, and once.
#[test]
fn a_cable_too_slack_for_its_torque_is_told_in_statics() {
    let limit = 0.25 - std::f64::consts::PI.powi(2) / 400.0;
    let told = |let_out: f64| {
        let text = include_str!("slack.toml")
            .replace("duration = 15\noutput = 0.5", "analysis = \"statics\"\n[statics]\nsteps = 20");
        let set = ["tension=1 N".into(), format!("out={let_out} m/s")];
        let file = SceneFile::parse(&text, "slack", Format::Toml, &set).unwrap_or_else(|e| panic!("{e}"));
        let folder = tempfile::tempdir().expect("a folder");
        let options = RunOptions { out: Some(folder.path().join("run")), ..RunOptions::default() };
        let done = ropewalk::run(&file, &options, &mut |_| {}).unwrap_or_else(|e| panic!("{e}"));
        done.summary.events.iter().map(|e| (e.name.clone(), e.t)).collect::<Vec<_>>()
    };
    // 1 N is a strain of 1e-3, 20 mm less what it is laid with
    let all = 20.0 * (1.0 - limit) / 1e3;
    assert!(told(0.9 * all).is_empty());
    let below = told(1.2 * all);
    println!("{below:?}");
    let [(text, t)] = below.as_slice() else { panic!("{below:?}") };
    // of twenty steps to 1.2 times the way the 17th is the first beyond it
    assert!(text.contains("`rope` may form a loop") && (t - 0.85).abs() < 1e-9, "{below:?}");
}

/// What comes with the wraps of a coil, and what a drum lets through, goes on from a checkpoint to the last bit.
#[test]
fn wraps_and_grips_go_on_from_a_checkpoint_to_the_last_bit() {
    let through = include_str!("through.toml");
    for (text, set) in
        [(FED, vec!["wrap=2 m".to_string(), "n=2".into()]), (through, vec!["grip=0.05".into()])]
    {
        let scene = scene(text, &set);
        let build = || scene.build().unwrap_or_else(|e| panic!("{e}"));
        let mut one = Simulation::new(build(), &scene.solver, 4.0).unwrap_or_else(|e| panic!("{e}"));
        one.advance(2.0, 0.5, &mut ()).unwrap_or_else(|e| panic!("{e}"));
        let kept = one.checkpoint().unwrap_or_else(|e| panic!("{e}"));
        let mut other =
            Simulation::restore(build(), &scene.solver, 4.0, kept).unwrap_or_else(|e| panic!("{e:?}"));
        let before = one.state.q.clone();
        for s in [&mut one, &mut other] {
            s.advance(4.0, 0.5, &mut ()).unwrap_or_else(|e| panic!("{e}"));
        }
        assert!(one.state.t >= 4.0 - 1e-9 && one.state.q != before);
        assert_eq!(one.state.q, other.state.q);
        assert_eq!(one.state.v, other.state.v);
        assert_eq!(one.state.internal, other.state.internal);
    }
}

/// A cable that is unwound over the end of its package: the section goes round once with each wrap, and the eyelet takes the twist
/// along. What the tangent there sweeps out on its cone is no twist, so in the end there are `cos β/R` of it per length.
#[test]
fn a_cable_that_is_unwound_has_a_turn_per_wrap() {
    let (gj, grip, radius) = (2e-5, 1e-3, 0.06);
    let text = include_str!("../../models/scenes/unwinding.toml")
        .replace("\naxial_retardation_time = \"$", &format!("\ngj = {gj}\naxial_retardation_time = \"$"))
        .replace("reference_speed = \"peel\"", &format!("reference_speed = \"peel\"\ngrip = {grip}"));
    let set = ["rigidity=tangent", "duration=0.6 s", "speed=5 kn"].map(String::from);
    let h = run(&text, &set);
    let (part, at) = (h.model.part("cable").expect("cable"), h.state.at());
    let twist = part.observe(Quantity::Twist, 0.0, &at).expect("a twist");
    let eyelet = part.boundary(0).expect("a boundary");
    let slope = [3, 4, 5].map(|i| h.state.q[eyelet.end_q + i]);
    let (cosine, out) = (slope[2] / dot(&slope, &slope).sqrt(), -eyelet.rate(&at));
    let exact = cosine / radius / (1.0 + gj / (grip * out));
    println!("{twist} {exact}, cos {cosine}, {out} m/s, {:?}", h.summary().energy);
    assert!((twist / exact - 1.0).abs() < 0.01 && exact > 10.0, "{twist} {exact}");
    let energy = h.summary().energy;
    assert!(energy.imbalance.abs() < 1e-4 * energy.supplied.abs(), "{energy:?}");
}
