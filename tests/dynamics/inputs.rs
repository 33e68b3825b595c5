//! Inputs that are set while a run goes on, and the controllers that set them.

use ropewalk_core::integrator::{StepError, Stepping};
use ropewalk_core::{Checkpoint, End, InputError, Simulation, Unfit};
use ropewalk_scene::{Format, Scene, SceneFile};

/// A mass of 2 kg that only an input pulls, along x.
fn pulled(join: &str, solver: &str) -> Scene {
    scene(&format!(
        r#"
        [run]
        duration = "4 s"
        [solver]
        {solver}
        [[inputs]]
        name = "pull"
        unit = "N"
        min = "-1 kN"
        max = "1 kN"
        join = "{join}"
        [[elements]]
        type = "point_mass"
        name = "ball"
        marker = [0, 0, 0]
        mass = "2 kg"
        [[forces]]
        type = "point_force"
        marker = "ball"
        force = [{{ input = "pull" }}, 0, 0]
        [[records]]
        type = "position"
        of = "ball"
        [[records]]
        type = "input"
        of = "pull"
        "#
    ))
}

#[track_caller]
fn scene(text: &str) -> Scene {
    SceneFile::parse(text, "scene.toml", Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}")).into_scene()
}

#[track_caller]
fn refused(text: &str) -> String {
    match SceneFile::parse(text, "scene.toml", Format::Toml, &[]).and_then(|file| file.build().map(drop)) {
        Ok(()) => panic!("it builds"),
        Err(fault) => fault.to_string(),
    }
}

fn started(scene: &Scene) -> Simulation {
    let mut s =
        Simulation::new(scene.build().expect("model"), &scene.solver, scene.run.duration).expect("start");
    s.keep_audit(true);
    s
}

const FORCES: [f64; 4] = [6.0, -14.0, 0.0, 9.0];

#[test]
fn mass_follows_forces_that_are_held_or_joined() {
    for (join, solver) in [
        ("hold", "stepping = { type = \"controlled\", tolerance = 1e-9 }"),
        ("linear", "stepping = { type = \"controlled\", tolerance = 1e-9 }"),
        ("hold", "stepping = { type = \"fixed\", h = 0.01 }"),
        ("linear", "stepping = { type = \"fixed\", h = 0.01 }"),
    ] {
        let mut s = started(&pulled(join, solver));
        let (mut x, mut v, mut a) = (0.0, 0.0, 0.0);
        for (k, force) in FORCES.into_iter().enumerate() {
            s.set_input("pull", force).expect("within its limits");
            assert_eq!(s.input("pull"), Ok(if join == "hold" { force } else { 2.0 * a }));
            assert_eq!(s.advance(k as f64 + 1.0, 0.5, &mut ()), Ok(End::Done));
            // exact over a second: acceleration constant, or linear from what it was
            let next = force / 2.0;
            let from = if join == "hold" { next } else { a };
            x += v + 0.5 * from + (next - from) / 6.0;
            v += 0.5 * (from + next);
            a = next;
            let off = [(s.state.q[0] - x).abs(), (s.state.v[0] - v).abs()];
            println!("{join}, {solver}: {off:?}");
            // Newmark's average acceleration is off by h²/12 of the jerk
            let most = if join == "linear" && solver.contains("fixed") { 3e-4 } else { 2e-8 };
            assert!(off.iter().all(|x| *x < most), "{join}, {solver}: {off:?}");
            assert!((s.state.a[0] - a).abs() < 1e-6, "{}", s.state.a[0]);
        }
        assert!(s.audit.imbalance().abs() < 1e-3 * s.audit.scale, "{:?}", s.audit);
    }
}

#[test]
fn wrong_values_are_refused_by_name_and_change_nothing() {
    let mut s = started(&pulled("hold", ""));
    for wrong in [f64::NAN, f64::INFINITY, 1000.5, -2e3] {
        assert!(matches!(s.set_input("pull", wrong), Err(InputError::Outside { .. })), "{wrong}");
    }
    let e = s.set_inputs(&[("pull", 5.0), ("pol", 1.0)]).expect_err("there is no such input");
    assert_eq!(e.to_string(), "there is no input `pol`; the inputs are `pull`");
    assert_eq!(s.input("pull"), Ok(0.0));
    s.set_input("pull", 1000.0).expect("the limit");
}

#[test]
fn wrong_scenes_are_refused_with_a_remedy() {
    let rope = r#"
        [[elements]]
        type = "cable"
        name = "rope"
        points = [[0, 0, 0], ["10 m", 0, 0]]
        elements = 4
        section = { mass = "1 kg/m", ea = "20 kN" }
        [[constraints]]
        type = "spherical"
        name = "hook"
        marker = "rope.start"
        "#;
    let winch = "[[constraints]]\ntype = \"winch\"\nname = \"winch\"\nmarker = \"rope.start\"\n";
    for (text, expected) in [
        ("[[inputs]]\nname = \"u\"\nunit = \"kn\"\n".into(), "write `unit = \"m/s\"` instead of \"kn\""),
        ("[[inputs]]\nname = \"u\"\nunit = \"m/s\"\ndefault = \"2 kg\"\n".into(), "\"2 kg\" is in kg, and has to be in m/s"),
        ("[[inputs]]\nname = \"u\"\nmin = 1\n".into(), "outside of the limits"),
        ("[[inputs]]\nname = \"u\"\n[[inputs]]\nname = \"u\"\n".into(), "two inputs named `u`"),
        (format!("{winch}speed = {{ input = \"u\" }}\n"), "there is no input `u`"),
        (
            format!("[[inputs]]\nname = \"u\"\nunit = \"N\"\n{winch}speed = {{ input = \"u\" }}\n"),
            "`speed` is a speed, in m/s, but the input `u` is in N",
        ),
        (
            format!("[[inputs]]\nname = \"u\"\nunit = \"m/s\"\n{winch}speed = {{ input = \"u\" }}\n"),
            "give it `join = \"linear\"`",
        ),
        (
            format!("[[inputs]]\nname = \"u\"\nunit = \"N\"\n{winch}brake = {{ input = \"u\" }}\n"),
            "give the input `u` a `min` of 0",
        ),
        (
            format!("{winch}speed = {{ inptu = \"u\" }}\n"),
            "inptu",
        ),
        (
            "[[inputs]]\nname = \"u\"\n[[controllers]]\ntype = \"expression\"\ninput = \"u\"\nvalue = \"rope.end.z\"\nevery = 1\n".into(),
            "no record",
        ),
        (
            "[[records]]\ntype = \"position\"\nof = \"rope.end\"\n[[inputs]]\nname = \"u\"\n[[controllers]]\ntype = \"expression\"\n\
             input = \"u\"\nvalue = \"2 * rope.end.z\"\nevery = 1\n"
                .into(),
            "it is in m, and has to be a plain number",
        ),
        (
            "[[inputs]]\nname = \"u\"\n[[controllers]]\ntype = \"expression\"\ninput = \"u\"\nvalue = \"t / 1 s\"\nevery = 1e-300\n"
                .into(),
            "take a longer interval",
        ),
        (
            "[[inputs]]\nname = \"u\"\n[[controllers]]\ntype = \"pid\"\ninput = \"u\"\nmeasures = \"t\"\nsetpoint = 0\nkp = \"1 1/m\"\n\
             every = 1\n"
                .into(),
            "`kp`",
        ),
    ] {
        let text = format!("{rope}{text}");
        let fault = refused(&text);
        assert!(fault.contains(expected) && fault.contains("scene.toml:"), "{fault}\ninstead of {expected}");
    }
}

/// A winch whose speed is an input, on a rope whose elements are born and swallowed.
fn winch(element: &str) -> Scene {
    scene(&format!(
        r#"
        [run]
        duration = "8 s"
        [[inputs]]
        name = "speed"
        unit = "m/s"
        join = "linear"
        min = -2
        max = 2
        [[elements]]
        type = "cable"
        name = "rope"
        points = [[0, 0, 0], [0, 0, "-10 m"]]
        elements = 10
        section = {{ mass = "1 kg/m", ea = "20 kN", ei = "1 N m^2" }}
        [[constraints]]
        type = "spherical"
        name = "hook"
        marker = "rope.start"
        [[constraints]]
        type = "winch"
        name = "winch"
        marker = "rope.start"
        speed = {{ input = "speed" }}
        {element}
        [[forces]]
        type = "gravity"
        [[records]]
        type = "payout"
        of = "rope.start"
        "#
    ))
}

#[test]
fn winch_pays_out_the_integral_of_its_input() {
    for element in ["", "element_length = \"1 m\""] {
        let mut s = started(&winch(element));
        let (mut paid, mut speed) = (0.0, 0.0);
        for (k, next) in [1.0, -0.5, 0.25, 1.5].into_iter().enumerate() {
            s.set_input("speed", next).expect("a speed");
            assert_eq!(s.advance(2.0 * (k as f64 + 1.0), 1.0, &mut ()), Ok(End::Done));
            paid += speed + next;
            speed = next;
            let boundary = s.model.part("rope").and_then(|p| p.boundary(0)).expect("it feeds");
            let off = boundary.fed(&s.state.at()) - paid;
            println!("{element}: {paid} m, off by {off:e}");
            assert!(off.abs() < 1e-12 && (boundary.rate(&s.state.at()) - speed).abs() < 1e-12, "{off:e}");
        }
    }
}

#[test]
fn what_changes_a_spring_does_work() {
    for join in ["hold", "linear"] {
        let text = format!(
            r#"
            [run]
            duration = "6 s"
            [solver]
            stepping = {{ type = "controlled", tolerance = 1e-7 }}
            [[inputs]]
            name = "stiffness"
            unit = "N/m"
            default = 50
            min = 0
            join = "{join}"
            [[inputs]]
            name = "length"
            unit = "m"
            default = 1
            min = 0
            join = "{join}"
            [[elements]]
            type = "point_mass"
            name = "ball"
            marker = ["1.5 m", 0, 0]
            mass = "2 kg"
            [[forces]]
            type = "spring"
            name = "spring"
            marker = "ball"
            to = [0, 0, 0]
            stiffness = {{ input = "stiffness" }}
            length = {{ input = "length" }}
            "#
        );
        let mut s = started(&scene(&text));
        for k in 1..=6 {
            s.set_inputs(&[
                ("stiffness", 50.0 + 20.0 * f64::from(k)),
                ("length", 1.0 - 0.1 * f64::from(k % 3)),
            ])
            .expect("set");
            s.advance(f64::from(k), 0.5, &mut ()).expect("run");
        }
        let off = s.audit.imbalance() / s.audit.scale;
        println!("{join}: imbalance {off:e}, supplied {} J", s.audit.supplied);
        assert!(s.audit.supplied.abs() > 1.0 && off.abs() < 1e-3, "{join}: {off:e}");
    }
}

#[test]
fn what_changes_a_torsion_spring_and_a_bushing_does_work() {
    for join in ["hold", "linear", "smooth"] {
        let input = |name: &str, unit: &str, value: f64| {
            format!(
                "[[inputs]]\nname = \"{name}\"\nunit = \"{unit}\"\ndefault = {value}\nmin = 0\njoin = \"{join}\"\n"
            )
        };
        let text = format!(
            r#"
            [run]
            duration = "6 s"
            [solver]
            stepping = {{ type = "controlled", tolerance = 1e-7 }}
            {}{}{}
            [[elements]]
            type = "rigid_body"
            name = "door"
            position = [0, 0, 0]
            mass = "2 kg"
            inertia = [0.3, 0.3, 0.3]
            angular_velocity = [0, 0, 1]
            velocity = [0.4, 0, 0]
            [[forces]]
            type = "rotational_spring"
            name = "spring"
            marker = "door"
            axis = [0, 0, 1]
            stiffness = {{ input = "torsion" }}
            angle = {{ input = "angle" }}
            damping = 0.01
            [[forces]]
            type = "bushing"
            name = "mount"
            marker = "door"
            stiffness = [{{ input = "stiffness" }}, 40, 40]
            rotational_stiffness = [1, 1, {{ input = "torsion" }}]
            "#,
            input("torsion", "N m/rad", 2.0),
            input("angle", "rad", 0.1),
            input("stiffness", "N/m", 50.0)
        );
        let mut s = started(&scene(&text));
        for k in 1..=6 {
            s.set_inputs(&[
                ("torsion", 2.0 + 0.5 * f64::from(k)),
                ("angle", 0.1 * f64::from(k % 3)),
                ("stiffness", 50.0 + 20.0 * f64::from(k)),
            ])
            .expect("set");
            s.advance(f64::from(k), 0.5, &mut ()).expect("run");
        }
        let off = s.audit.imbalance() / s.audit.scale;
        println!("{join}: imbalance {off:e}, supplied {} J", s.audit.supplied);
        assert!(s.audit.supplied.abs() > 0.1 && off.abs() < 1e-3, "{join}: {off:e}");
        assert!(refused(&text.replace("min = 0", "min = -1")).contains("must not be negative"));
    }
}

/// A ball that a harmonic motion shakes along x.
fn shaken(amplitude: &str, frequency: &str, joins: [&str; 2]) -> String {
    format!(
        r#"
        [run]
        duration = "8 s"
        [solver]
        stepping = {{ type = "fixed", h = 1e-3 }}
        [[inputs]]
        name = "a"
        unit = "m"
        default = 1
        join = "{}"
        [[inputs]]
        name = "f"
        unit = "Hz"
        default = 0.5
        join = "{}"
        [[motions]]
        type = "harmonic"
        name = "sway"
        amplitude = [{amplitude}, 0, 0]
        frequency = {frequency}
        ramp = 0
        [[elements]]
        type = "point_mass"
        name = "ball"
        marker = [0, 0, 0]
        mass = 2
        velocity = [{}, 0, 0]
        [[constraints]]
        type = "driving"
        name = "shaker"
        marker = "ball"
        motion = "sway"
        "#,
        joins[0],
        joins[1],
        std::f64::consts::PI,
    )
}

#[test]
fn amplitude_and_frequency_follow_their_inputs_without_a_jump() {
    use std::f64::consts::TAU;
    let (a, f) = ("{ input = \"a\" }", "{ input = \"f\" }");
    let mut s = started(&scene(&shaken(a, f, ["smooth", "linear"])));
    let (mut frequency, mut turns) = (0.5, 0.0);
    for (k, [to, by]) in [[1.0, 0.5], [2.0, 0.5], [2.0, 1.25], [0.5, 0.25]].into_iter().enumerate() {
        s.set_inputs(&[("a", to), ("f", by)]).expect("set");
        s.advance(2.0 * (k as f64 + 1.0), 1.0, &mut ()).expect("run");
        turns += 0.5 * (frequency + by) * 2.0;
        frequency = by;
        let (sin, cos) = (TAU * turns).sin_cos();
        let (x, v) = (to * sin, to * TAU * frequency * cos);
        println!("{x} m, {v} m/s: off by {:e} and {:e}", s.state.q[0] - x, s.state.v[0] - v);
        // velocities meet what moves them to the order of the steps
        assert!((s.state.q[0] - x).abs() < 1e-9 && (s.state.v[0] - v).abs() < 1e-4 * (1.0 + v.abs()));
    }
    // what shakes it does the work
    assert!(s.audit.imbalance().abs() < 1e-4 * s.audit.scale, "{:e}", s.audit.imbalance() / s.audit.scale);
    for (joins, expected) in [
        (["linear", "linear"], "where the amplitude jumps or bends the velocity jumps"),
        (["smooth", "hold"], "where the frequency jumps the velocity jumps"),
    ] {
        let fault = refused(&shaken(a, f, joins));
        assert!(fault.contains(expected) && fault.contains("give it `join = "), "{fault}");
    }
}

/// A mass on which a PID controller of the position acts, against a steady force.
fn positioned(every: &str, more: &str) -> Scene {
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
fn inputs_go_through_checkpoints_to_the_last_bit() {
    for (scene, name) in [
        (pulled("hold", ""), "pull"),
        (pulled("linear", ""), "pull"),
        (winch("element_length = \"1 m\""), "speed"),
    ] {
        let mut whole = started(&scene);
        whole.set_input(name, 1.5).expect("set");
        whole.advance(1.5, 0.5, &mut ()).expect("run");
        // set, but not yet on its way
        whole.set_input(name, -1.0).expect("set");
        let checkpoint = whole.checkpoint().expect("checkpoint");
        let on = |s: &mut Simulation| {
            s.advance(2.5, 0.5, &mut ()).expect("run");
            s.set_input(name, 0.5).expect("set");
            s.advance(4.0, 0.5, &mut ()).expect("run");
        };
        on(&mut whole);
        let model = scene.build_on(&checkpoint.meshes).expect("model");
        let mut again =
            Simulation::restore(model, &scene.solver, scene.run.duration, checkpoint).expect("fits");
        on(&mut again);
        assert_eq!((again.state, again.audit), (whole.state, whole.audit));
    }
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
fn simulation_takes_any_argument_without_harm() {
    let scene = pulled("hold", "");
    let mut s = started(&scene);
    s.set_input("pull", 4.0).expect("set");
    s.advance(1.0, 0.5, &mut ()).expect("run");
    for end in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1.0, 0.5] {
        let before = s.state.clone();
        assert!(s.advance(end, 0.1, &mut ()).is_err(), "{end}");
        assert!(s.step(end).is_err(), "{end}");
        assert_eq!(s.state, before);
    }
    for interval in [f64::NAN, 0.0, -1.0, 1e-300] {
        assert!(s.advance(2.0, interval, &mut ()).is_err(), "{interval}");
    }
    // now: nothing happens
    assert_eq!((s.advance(1.0, 0.1, &mut ()), s.step(1.0)), (Ok(End::Done), Ok(End::Done)));
    assert_eq!(s.state.t, 1.0);
    assert_eq!(s.step(2.0), Ok(End::Done));
    assert!(s.state.t > 1.0 && s.state.t <= 2.0 && s.work.counts.steps > 0);
}

#[test]
fn states_are_read_and_set_and_those_of_other_models_refused() {
    let mut s = started(&pulled("hold", ""));
    s.set_input("pull", 4.0).expect("set");
    s.advance(1.0, 0.5, &mut ()).expect("run");
    let state = s.state.clone();
    s.advance(2.0, 0.5, &mut ()).expect("run");
    let later = s.state.clone();
    s.set_state(state).expect("its own");
    s.advance(2.0, 0.5, &mut ()).expect("run");
    assert!((s.state.q[0] - later.q[0]).abs() < 1e-9 && (s.state.v[0] - later.v[0]).abs() < 1e-9);
    let other = started(&winch(""));
    assert!(matches!(s.set_state(other.state.clone()), Err(StepError::Foreign(_))));
    let mut broken = later.clone();
    broken.q[1] = f64::NAN;
    assert!(matches!(s.set_state(broken.clone()), Err(StepError::Foreign(_))));
    s.state = broken;
    assert!(matches!(s.advance(3.0, 0.5, &mut ()), Err(StepError::Foreign(_))));
    let checkpoint = started(&winch("")).checkpoint().expect("checkpoint");
    let scene = pulled("hold", "");
    let refused = Simulation::restore(scene.build().expect("model"), &scene.solver, 4.0, checkpoint);
    assert!(matches!(refused.err(), Some(Unfit::Other(_))));
}

#[test]
fn simulations_run_in_threads_of_their_own() {
    let scene = positioned("0.3 s", "");
    let alone = {
        let mut s = started(&scene);
        s.advance(5.0, 1.0, &mut ()).expect("run");
        s.state
    };
    let handles: Vec<_> = (0..4)
        .map(|_| {
            let mut s = started(&scene);
            std::thread::spawn(move || s.advance(5.0, 1.0, &mut ()).map(|_| s.state))
        })
        .collect();
    for h in handles {
        assert_eq!(h.join().expect("no panic").expect("run"), alone);
    }
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
        println!("tolerance {tolerance:e}: {counts:?}, imbalance {:e} J", s.audit.imbalance());
        (counts.steps + counts.rejected, s.audit.imbalance().abs())
    };
    // thirty kinks, each of which takes shorter steps, and no collapse: tens of thousands of them once
    for (tolerance, most, lost) in [(1e-4, 100, 2.0), (1e-5, 400, 0.8), (1e-6, 600, 0.2), (1e-8, 8000, 0.02)]
    {
        let (tries, imbalance) = run(tolerance);
        assert!(tries < most, "{tries}");
        assert!(imbalance < lost, "{imbalance} J");
    }
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
fn current_that_is_an_input_drags_as_one_that_is_given() {
    let text = |current: &str| {
        format!(
            r#"
            [run]
            duration = "4 s"
            [solver]
            stepping = {{ type = "controlled", tolerance = 1e-8 }}
            [[inputs]]
            name = "tide"
            unit = "m/s"
            join = "hold"
            [water]
            current = [{current}, 0, 0]
            [[elements]]
            type = "point_mass"
            name = "buoy"
            marker = [0, 0, 0]
            mass = "20 kg"
            volume = "0.02 m^3"
            drag_area = "0.1 m^2"
            "#
        )
    };
    let mut driven = started(&scene(&text("{ input = \"tide\" }")));
    driven.advance(1.0, 1.0, &mut ()).expect("run");
    assert_eq!(driven.state.v[0], 0.0);
    driven.set_input("tide", 0.8).expect("set");
    driven.advance(3.0, 1.0, &mut ()).expect("run");
    let mut given = started(&scene(&text("0.8")));
    given.advance(2.0, 1.0, &mut ()).expect("run");
    let off = (driven.state.q[0] - given.state.q[0]).abs();
    println!("{} m, off by {off:e}", given.state.q[0]);
    assert!(given.state.q[0] > 0.2 && off < 1e-6, "{off:e}");
    let linear = text("{ input = \"tide\" }").replace("\"hold\"", "\"linear\"");
    assert!(refused(&linear).contains("`join = \"hold\"`"), "{}", refused(&linear));
}

#[test]
fn profile_with_a_factor_drags_as_one_that_is_given() {
    let text = |factor: &str, speed: f64| {
        format!(
            r#"
            [run]
            duration = "4 s"
            [solver]
            stepping = {{ type = "controlled", tolerance = 1e-8 }}
            [[inputs]]
            name = "tide"
            join = "hold"
            [water]
            profile = [{{ z = -10, velocity = [0, 0, 0] }}, {{ z = 10, velocity = [{speed}, 0, 0] }}]
            profile_factor = {factor}
            [[elements]]
            type = "point_mass"
            name = "buoy"
            marker = [0, 0, 0]
            mass = "20 kg"
            volume = "0.02 m^3"
            drag_area = "0.1 m^2"
            "#
        )
    };
    let mut driven = started(&scene(&text("{ input = \"tide\" }", 2.0)));
    driven.advance(1.0, 1.0, &mut ()).expect("run");
    assert_eq!(driven.state.v[0], 0.0);
    driven.set_input("tide", 0.8).expect("set");
    driven.advance(3.0, 1.0, &mut ()).expect("run");
    let run = |factor, speed| {
        let mut given = started(&scene(&text(factor, speed)));
        given.advance(2.0, 1.0, &mut ()).expect("run");
        given.state.q[0]
    };
    let (given, factor) = (run("1", 1.6), run("0.8", 2.0));
    println!("{given} m, off by {:e} and {:e}", driven.state.q[0] - given, factor - given);
    assert!(given > 0.2 && (driven.state.q[0] - given).abs() < 1e-6 && (factor - given).abs() < 1e-12);
    let linear = text("{ input = \"tide\" }", 1.0).replace("\"hold\"", "\"linear\"");
    assert!(refused(&linear).contains("`join = \"hold\"`"), "{}", refused(&linear));
    let none = refused(&text("2", 1.0).replace("profile = [", "# ["));
    assert!(none.contains("there is none"), "{none}");
}

#[test]
fn tension_by_the_speed_squared_is_read_from_an_input() {
    let run = |k: &str| {
        let text = format!(
            r#"
            [run]
            duration = "2 s"
            [[inputs]]
            name = "k"
            unit = "kg/m"
            default = 0.4
            [[elements]]
            type = "cable"
            name = "rope"
            points = [[0, 0, 0], [0, 0, "-10 m"]]
            elements = 6
            section = {{ mass = "1 kg/m", ea = "20 kN", ei = "1 N m^2" }}
            [[constraints]]
            type = "spherical"
            name = "hook"
            marker = "rope.start"
            [[constraints]]
            type = "winch"
            name = "winch"
            marker = "rope.start"
            tension = "80 N"
            damping = "20 N s/m"
            per_speed2 = {k}
            [[forces]]
            type = "gravity"
            "#
        );
        let mut s = started(&scene(&text));
        s.advance(1.0, 1.0, &mut ()).expect("run");
        if k.contains("input") {
            s.set_input("k", 5.0).expect("set");
        }
        s.advance(2.0, 1.0, &mut ()).expect("run");
        let boundary = s.model.part("rope").and_then(|p| p.boundary(0)).expect("it feeds");
        boundary.fed(&s.state.at())
    };
    let (driven, constant, none) = (run("{ input = \"k\" }"), run("0.4"), run("0"));
    println!("{driven} m, {constant} m, {none} m");
    assert!((driven - constant).abs() > 1e-2 && (none - constant).abs() > 1e-2);
}
