//! Controllers that set inputs while a run goes on.

use super::inputs::{scene, started};
use ropewalk_core::integrator::{StepError, Stepping};
use ropewalk_core::{Checkpoint, InputError, Simulation};
use ropewalk_scene::{Format, Scene, SceneFile};

/// A mass on which a PID controller of the position acts, against a steady force.
pub fn positioned(every: &str, more: &str) -> Scene {
    scene(&format!(
        r#"
        [run]
        duration = "20 s"
        output = "1 s"
        [solver]
        stepping = {{ type = "controlled", tolerance = 1e-9 }}
        [[inputs]]
        name = "thrust"
        unit = "N"
        min = -6
        max = 6
        [[controllers]]
        type = "pid"
        input = "thrust"
        measures = "ball.x"
        setpoint = "1 m + 0.1 m * sin(0.5 rad/s * t)"
        kp = "3 N/m"
        ki = "0.4 N/(m s)"
        kd = "5 N s/m"
        filter = "0.1 s"
        every = "{every}"
        {more}
        [[elements]]
        type = "point_mass"
        name = "ball"
        marker = [0, 0, 0]
        mass = "2 kg"
        [[forces]]
        type = "point_force"
        marker = "ball"
        force = [{{ input = "thrust" }}, 0, 0]
        [[forces]]
        type = "point_force"
        marker = "ball"
        force = [-1, 0, 0]
        [[records]]
        type = "position"
        of = "ball"
        [[records]]
        type = "input"
        of = "thrust"
        "#
    ))
}

#[test]
fn sampled_pid_moves_a_mass_as_its_difference_equation_says() {
    let (every, mass): (f64, f64) = (0.25, 2.0);
    let scene = positioned("0.25 s", "");
    let mut s = started(&scene);
    let (mut x, mut v): (f64, f64) = (0.0, 0.0);
    let (mut integral, mut rate, mut last) = (0.0, 0.0, 0.0);
    let mut limited = 0;
    for k in 0..80 {
        let t = f64::from(k) * every;
        let error = 1.0 + 0.1 * (0.5 * t).sin() - x;
        rate = (0.1 * rate + x - last) / (0.1 + every);
        last = x;
        let grown = integral + 0.4 * error * every;
        let u = 3.0 * error + grown - 5.0 * rate;
        // at a limit the integral doesn't grow further into it
        let held = (u > 6.0 && grown > integral) || (u < -6.0 && grown < integral);
        limited += i32::from(held);
        let u = if held { u - grown + integral } else { u };
        integral = if held { integral } else { grown };
        let a = (u.clamp(-6.0, 6.0) - 1.0) / mass;
        x += v * every + 0.5 * a * every * every;
        v += a * every;
        s.advance(t + every, every, &mut ()).expect("run");
        let off = (s.state.q[0] - x).abs().max((s.state.v[0] - v).abs());
        assert!(off < 1e-7, "at {t}: {off:e}");
    }
    assert!((x - 1.0).abs() < 0.2, "{x}");
    println!("{limited} instants at a limit, x = {x}");
    // in one go, and with samples where they aren't instants
    let mut whole = started(&scene);
    whole.advance(20.0, 0.7, &mut ()).expect("run");
    assert!((whole.state.q[0] - x).abs() < 1e-7);
}

#[test]
fn integral_does_not_wind_up() {
    let far = |text: &str| {
        let mut scene = positioned("0.05 s", text);
        scene.run.duration = 60.0;
        scene
    };
    let mut s = started(&far("min = -1.5\nmax = 1.5"));
    s.advance(60.0, 1.0, &mut ()).expect("run");
    let off = s.state.q[0] - 1.0;
    assert!(off.abs() < 0.2, "{off}");
}

#[test]
fn controllers_go_through_checkpoints_to_the_last_bit() {
    let scene = positioned("0.3 s", "");
    let mut whole = started(&scene);
    whole.advance(7.0, 7.0, &mut ()).expect("run");
    let bytes = postcard::to_stdvec(&whole.checkpoint().expect("checkpoint")).expect("plain data");
    whole.advance(20.0, 0.5, &mut ()).expect("run");
    let checkpoint: Checkpoint = postcard::from_bytes(&bytes).expect("read back");
    let model = scene.build().expect("model");
    let mut again = Simulation::restore(model, &scene.solver, scene.run.duration, checkpoint).expect("fits");
    again.advance(20.0, 0.5, &mut ()).expect("run");
    assert_eq!((again.state, again.audit), (whole.state, whole.audit));
}

#[test]
fn input_of_a_controller_is_not_set_from_outside() {
    let mut s = started(&positioned("0.3 s", ""));
    assert!(matches!(s.set_input("thrust", 1.0), Err(InputError::Controlled { .. })));
}

#[test]
fn controller_without_a_value_ends_the_run_with_its_name() {
    let text = r#"
        [[inputs]]
        name = "u"
        unit = "N"
        [[controllers]]
        type = "expression"
        input = "u"
        name = "doubtful"
        value = "1 N * sqrt(1 - t / 0.5 s)"
        every = "0.1 s"
        [[elements]]
        type = "point_mass"
        name = "ball"
        marker = [0, 0, 0]
        mass = 1
        [[forces]]
        type = "point_force"
        marker = "ball"
        force = [{ input = "u" }, 0, 0]
        "#;
    let mut s = started(&scene(text));
    let error = s.advance(1.0, 0.1, &mut ()).expect_err("the root of a negative number");
    assert!(matches!(&error, StepError::Control { controller, .. } if controller == "doubtful"), "{error}");
    assert!((s.state.t - 0.6).abs() < 1e-9, "{}", s.state.t);
}

#[test]
fn fixed_steps_end_at_the_instants_of_controllers() {
    let mut scene = positioned("0.25 s", "");
    scene.solver.stepping = Stepping::Fixed { h: 0.1 };
    let mut s = started(&scene);
    s.advance(20.0, 1.0, &mut ()).expect("run");
    let mut exact = started(&positioned("0.25 s", ""));
    exact.advance(20.0, 1.0, &mut ()).expect("run");
    assert!((s.state.q[0] - exact.state.q[0]).abs() < 1e-6, "{} {}", s.state.q[0], exact.state.q[0]);
}

/// The values of a column after a time, of a scene run as a whole.
fn column(text: &str, set: &[&str], name: &str, after: f64) -> Vec<f64> {
    let set: Vec<String> = set.iter().map(|s| (*s).to_string()).collect();
    let file = SceneFile::parse(text, "example", Format::Toml, &set).unwrap_or_else(|e| panic!("{e}"));
    let history = ropewalk::simulate(file.scene()).unwrap_or_else(|e| panic!("{e}"));
    let values = history.column(name).unwrap_or_else(|| panic!("no column {name}"));
    history.times().iter().zip(values).filter(|(t, _)| **t >= after).map(|(_, x)| *x).collect()
}

#[test]
fn constant_tension_winch_holds_its_tension() {
    let text = include_str!("../../examples/control/constant-tension.toml");
    let held = column(text, &[], "rope.start.tension", 15.0);
    let off = held.iter().map(|x| (x / 20e3 - 1.0).abs()).fold(0.0, f64::max);
    // the loop integrates twice: (5 s + 5) / s² with the 10 kN/m of the rope, by which 10 kN of heave at 0.1 Hz become 0.68 kN
    println!("tension within {off:.4} of what it is to be");
    assert!(off < 0.05 && off > 0.02, "{off}");
}

#[test]
fn heave_compensation_keeps_the_load_in_its_place() {
    let text = include_str!("../../examples/control/heave-compensation.toml");
    let z = column(text, &[], "load.z", 15.0);
    let range =
        z.iter().copied().fold(f64::NEG_INFINITY, f64::max) - z.iter().copied().fold(f64::INFINITY, f64::min);
    println!("the load moves by {range:.4} m while the ship heaves by 3 m");
    assert!(range < 0.05 * 3.0, "{range}");
}

#[test]
fn dynamic_positioning_holds_place_and_heading() {
    let text = include_str!("../../examples/control/dynamic-positioning.toml");
    for (name, goal) in [("vessel.x", 10.0), ("vessel.y", 0.0), ("vessel.phi3", 0.0)] {
        let off = column(text, &[], name, 500.0).iter().map(|x| (x - goal).abs()).fold(0.0, f64::max);
        println!("{name}: off by {off:.4}");
        assert!(off < 0.1, "{name}: {off}");
    }
    // the thrusters carry the wind, and its moment
    let last = |name| column(text, &[], name, 599.0).last().copied().unwrap_or(f64::NAN);
    assert!((last("sway") + 30e3).abs() < 600.0, "{}", last("sway"));
    assert!((last("yaw") + 600e3).abs() < 12e3, "{}", last("yaw"));
}

#[test]
fn steps_get_over_the_kinks_of_a_winch_that_is_controlled() {
    let text = |tolerance: f64| {
        format!(
            r#"
            [run]
            duration = "3 s"
            [solver]
            stepping = {{ controlled = {{ tolerance = {tolerance:e} }} }}
            [[inputs]]
            name = "hoist"
            unit = "m/s"
            min = -1
            max = 1
            join = "linear"
            [[controllers]]
            type = "expression"
            input = "hoist"
            value = "rope.start.vz - (-8 m - load.z) / 1 s"
            every = "0.1 s"
            [[elements]]
            type = "cable"
            name = "rope"
            points = [[0, 0, 0], [0, 0, "-8 m"]]
            tension = "4.95 kN"
            elements = 4
            section = {{ mass = "1 kg/m", ea = "2 MN", ei = "1 N m^2", axial_retardation_time = "10 ms" }}
            [[elements]]
            type = "point_mass"
            name = "load"
            marker = "rope.end"
            mass = "500 kg"
            [[motions]]
            type = "harmonic"
            name = "waves"
            amplitude = [0, 0, "0.5 m"]
            frequency = "0.1 Hz"
            [[constraints]]
            type = "driving"
            name = "boom"
            marker = "rope.start"
            motion = "waves"
            [[constraints]]
            type = "winch"
            name = "winch"
            marker = "rope.start"
            speed = {{ input = "hoist" }}
            [[forces]]
            type = "gravity"
            [[records]]
            type = "position"
            of = "load"
            [[records]]
            type = "velocity"
            of = "rope.start"
            "#
        )
    };
    let run = |tolerance: f64| {
        let mut s = started(&scene(&text(tolerance)));
        s.advance(3.0, 1.0, &mut ()).unwrap_or_else(|e| panic!("{e}"));
        let counts = s.work.counts;
        let last = s.model.nodes().iter().rfind(|n| n.kind.has_position()).expect("the load's node");
        println!("tolerance {tolerance:e}: {counts:?}, imbalance {:e} J", s.audit.imbalance());
        (counts.steps + counts.rejected, s.audit.imbalance().abs(), s.state.q[last.q + 2])
    };
    // thirty kinks, each of which takes shorter steps, and no collapse: tens of thousands of them once
    let [loose, fine, finer, exact] = [1e-4, 1e-5, 1e-6, 1e-8].map(run);
    for ((tries, imbalance, _), most, lost) in
        [(loose, 100, 2.0), (fine, 400, 2.0), (finer, 600, 0.2), (exact, 8000, 0.02)]
    {
        assert!(tries < most, "{tries}");
        assert!(imbalance < lost, "{imbalance} J");
    }
    for ((.., z), tolerance) in [(loose, 1e-4), (fine, 1e-5), (finer, 1e-6)] {
        let off = (z - exact.2).abs() / 8.0 / tolerance;
        println!("{off:.2} tolerances");
        assert!(off < 3.0, "the load is off by {off} tolerances at {tolerance:e}");
    }
}
