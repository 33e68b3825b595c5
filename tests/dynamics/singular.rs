//! A crank and a rod of the same length: twice in every turn they lie on each other, and the slider's constraint says nothing
//! of which way it goes on. And steps of mechanisms when their size changes.

use crate::mechanisms::{Stand, fixed, for_output, slider_crank, start};
use ropewalk::scene::Format;
use ropewalk::{Error, History, SceneFile, simulate};

const GRAVITY: f64 = 9.81;
/// Where it starts [rad], and how fast [rad/s].
const START: [f64; 2] = [std::f64::consts::FRAC_PI_4, 4.0];

/// Crank and rod of 1 m and 1 kg in a plane, with a part of their weight across it. Gravity differs in the thirteenth digit: enough for rounding to go
/// another way.
fn crank(solver: &str, duration: f64, differently: u32) -> Result<History, Error> {
    let half = 0.5 * std::f64::consts::SQRT_2;
    let (angle, rate, speed) = (START[0], START[1], START[1] * half);
    let g = GRAVITY * (1.0 + 1e-13 * f64::from(differently));
    let text = format!(
        r#"
        gravity = [0, {}, -5]
        [run]
        duration = "{duration} s"
        output = "0.01 s"
        [solver]
        {solver}
        [[elements]]
        type = "rigid_body"
        name = "crank"
        position = [0, 0, 0]
        angles = [0, 0, {angle}]
        angular_velocity = [0, 0, {rate}]
        mass = 1
        inertia = [1e-4, {inertia}, {inertia}]
        centre = [0.5, 0, 0]
        points = {{ end = [1, 0, 0] }}
        [[elements]]
        type = "rigid_body"
        name = "rod"
        position = [{half}, {half}, 0]
        angles = [0, 0, {}]
        angular_velocity = [0, 0, {}]
        velocity = [{}, {speed}, 0]
        mass = 1
        inertia = [1e-4, {inertia}, {inertia}]
        centre = [0.5, 0, 0]
        points = {{ end = [1, 0, 0] }}
        [[constraints]]
        type = "revolute"
        name = "hinge"
        marker = "crank"
        to = [0, 0, 0]
        axis = [0, 0, 1]
        [[constraints]]
        type = "revolute"
        name = "pin"
        marker = "rod"
        to = "crank.end"
        axis = [0, 0, 1]
        [[constraints]]
        type = "point_on_line"
        name = "slider"
        marker = "rod.end"
        axis = [1, 0, 0]
        [[forces]]
        type = "gravity"
        [[records]]
        type = "position"
        of = "rod.end"
        [[records]]
        type = "reaction"
        of = "hinge"
        "#,
        -g,
        -angle,
        -rate,
        -speed,
        inertia = 1.0 / 12.0,
    );
    let file = SceneFile::parse(&text, "crank", Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}"));
    simulate(file.scene())
}

/// The angle of the crank, of which the whole motion is one equation: `(2/3 + 2 sin²θ) θ'' + sin 2θ θ'² + g cos θ = 0`, by the
/// classical Runge-Kutta method.
fn angles(times: &[f64]) -> Vec<f64> {
    let rate = |[angle, omega]: [f64; 2]| {
        let (sine, cosine) = angle.sin_cos();
        let force = 2.0 * sine * cosine * omega * omega + GRAVITY * cosine;
        [omega, -force / (2.0 / 3.0 + 2.0 * sine * sine)]
    };
    let h: f64 = 1e-4;
    let step = |y: [f64; 2], h: f64| {
        let by = |k: [f64; 2], h: f64| [y[0] + h * k[0], y[1] + h * k[1]];
        let a = rate(y);
        let b = rate(by(a, 0.5 * h));
        let c = rate(by(b, 0.5 * h));
        let d = rate(by(c, h));
        [0, 1].map(|i| y[i] + h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]))
    };
    let (mut y, mut t) = (START, 0.0);
    let to = |time: f64| {
        while t < time - 1e-12 {
            let h = h.min(time - t);
            y = step(y, h);
            t += h;
        }
        y[0]
    };
    times.iter().copied().map(to).collect()
}

/// The largest error of where the slider is, over the tolerance.
fn error(run: &History, tolerance: f64) -> f64 {
    let [times, x] = ["t", "rod.end.x"].map(|name| run.column(name).unwrap_or_else(|| panic!("no {name}")));
    let off = angles(times).into_iter().zip(x).map(|(angle, x)| (x - 2.0 * angle.cos()).abs());
    // a NaN counts as the largest
    off.fold(0.0, |most, off| if off <= most { most } else { off }) / tolerance
}

/// Without memory of the error before, and with accelerations that ring, it was 0.35 to 3.9 times the tolerance.
#[test]
fn accuracy_is_no_luck() {
    for scheme in ["", "scheme = \"radau-iia-5\"\n"] {
        for tolerance in [1e-3, 1e-4, 1e-5, 1e-6] {
            let solver = format!("{scheme}stepping = {{ controlled = {{ tolerance = {tolerance} }} }}");
            for differently in 0..3 {
                let run = crank(&solver, 2.0, differently).unwrap_or_else(|e| panic!("{solver}: {e}"));
                let error = error(&run, tolerance);
                println!("{scheme:?} {tolerance:e}: {error:.2}, {:?}", run.counts);
                assert!((0.01..=2.0).contains(&error), "{solver}: {error}");
            }
        }
    }
}

/// What iterations leave, and steps that grow and shrink with every turn, added up with the square of time: it was 4 to 15 times
/// the tolerance.
#[test]
fn a_long_run_is_as_exact_as_a_short_one() {
    for (scheme, tolerance) in [("", 1e-3), ("", 1e-4), ("scheme = \"radau-iia-5\"\n", 1e-5)] {
        let solver = format!("{scheme}stepping = {{ controlled = {{ tolerance = {tolerance} }} }}");
        let run = crank(&solver, 10.0, 0).unwrap_or_else(|e| panic!("{solver}: {e}"));
        let error = error(&run, tolerance);
        println!("{scheme:?} {tolerance:e}: {error:.2}, {:?}", run.counts);
        assert!((0.01..=3.0).contains(&error), "{solver}: {error}");
    }
}

/// Shorter steps would only end nearer to where the constraints say nothing: they got so short that the run ended.
#[test]
fn fine_steps_lead_across_a_singular_position() {
    for (scheme, tolerance) in [("", 1e-7), ("scheme = \"radau-iia-5\"\n", 1e-7)] {
        let solver =
            format!("{scheme}horizon = 2\nstepping = {{ controlled = {{ tolerance = {tolerance} }} }}");
        for differently in 0..8 {
            let run = crank(&solver, 0.35, differently).unwrap_or_else(|e| panic!("{solver}: {e}"));
            let error = error(&run, tolerance);
            println!("{scheme:?} {error:.2}, {:?}", run.counts);
            assert!(error <= 3.0, "{solver}: {error}");
        }
    }
}

/// Of forces that could be shared out in many ways those across the plane are the same for every tolerance. Where positions agree
/// only to 1e-12 m they differ by a tenth.
#[test]
fn redundant_constraints_share_forces_out_alike() {
    let across = |scheme: &str, tolerance: f64| {
        let solver = format!("{scheme}stepping = {{ controlled = {{ tolerance = {tolerance} }} }}");
        let run = crank(&solver, 0.85, 0).unwrap_or_else(|e| panic!("{solver}: {e}"));
        run.column("hinge.fz").unwrap_or_else(|| panic!("no force")).to_vec()
    };
    let fine = across("scheme = \"radau-iia-5\"\n", 1e-6);
    for tolerance in [1e-3, 3e-4, 1e-4, 1e-5] {
        let most = across("", tolerance)
            .iter()
            .zip(&fine)
            .map(|(a, b)| (a / b - 1.0).abs())
            .fold(0.0, |most, off| if off <= most { most } else { off });
        println!("{tolerance:e}: {most:.1e}");
        assert!(most <= 2e-3, "{tolerance:e}: {most:e}");
    }
}

/// Another size of steps finds velocities across the constraints that aren't its own: accelerations rang by a tenth of
/// themselves.
#[test]
fn accelerations_do_not_ring_when_steps_change() {
    let mut s = start(&slider_crank(4e-4, &Stand::UPRIGHT, false), &fixed(2e-3), 1.0);
    let (mut t, mut before, mut after) = (0.0, 0.0f64, 0.0f64);
    for k in 0..60 {
        t += if k < 30 { 2e-3 } else { 1e-3 };
        s.advance(t, f64::INFINITY, &mut ()).unwrap_or_else(|e| panic!("{e}"));
        let out = for_output(&mut s);
        let size = out.a.iter().fold(0.0f64, |m, a| m.max(a.abs()));
        let off = out.a.iter().zip(&s.state.a).map(|(a, b)| (a - b).abs()).fold(0.0f64, f64::max) / size;
        assert!(off.is_finite());
        match k {
            20..30 => before = before.max(off),
            30.. => after = after.max(off),
            _ => {}
        }
    }
    println!("{before:.1e} {after:.1e}");
    assert!(after <= 1.5 * before, "{before:e} {after:e}");
}
