//! Vortex-induced vibration: a cylinder on a spring in a stream, against the two equations of its motion and its wake, solved by
//! another integrator and by harmonic balance.

use ropewalk::scene::Format;
use ropewalk::{History, SceneFile, simulate};
use std::f64::consts::{PI, TAU};

const DENSITY: f64 = 1025.0;
const DIAMETER: f64 = 0.1;
const LENGTH: f64 = 2.0;
const MASS: f64 = 51.25;
/// 1 Hz in the water.
const STIFFNESS: f64 = MASS * TAU * TAU;

/// Damping of the water by a drag coefficient of 2, as in the paper, and half a percent of its own.
fn damping(speed: f64) -> f64 {
    0.5 * DENSITY * DIAMETER * LENGTH * 2.0 * speed + 2.0 * 0.005 * f64::sqrt(STIFFNESS * MASS)
}

fn parse(text: &str) -> SceneFile {
    SceneFile::parse(text, "vortices", Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}"))
}

/// A cylinder across the stream that can move up and down alone.
fn cylinder(speed: f64, duration: f64, more: &str) -> History {
    let text = format!(
        r#"
        [run]
        duration = {duration}
        output = 0.02
        [water]
        density = {DENSITY}
        current = [{speed}, 0, 0]
        [[elements]]
        type = "rigid_body"
        name = "cylinder"
        position = [0, 0, 0]
        mass = {MASS}
        inertia = [1, 1, 1]
        hull = {{ from = [0, {}, 0], to = [0, {}, 0], diameter = {DIAMETER} }}
        [[constraints]]
        type = "prismatic"
        name = "rails"
        marker = "cylinder"
        to = [0, 0, 0]
        axis = [0, 0, 1]
        [[forces]]
        type = "bushing"
        name = "mount"
        marker = "cylinder"
        stiffness = [0, 0, {STIFFNESS}]
        damping = [0, 0, {}]
        [[forces]]
        type = "vortex_shedding"
        {more}
        [[records]]
        type = "position"
        of = "cylinder"
        [[records]]
        type = "force"
        of = "cylinder: vortex shedding"
        [[records]]
        type = "energy"
        "#,
        -0.5 * LENGTH,
        0.5 * LENGTH,
        damping(speed)
    );
    simulate(parse(&text).scene()).unwrap_or_else(|e| panic!("{e}"))
}

/// Amplitude and frequency over the last periods: from the extremes and the crossings of zero upwards.
fn steady(t: &[f64], x: &[f64]) -> (f64, f64) {
    let from = t.len() / 2;
    let (t, x) = (&t[from..], &x[from..]);
    let high = x.iter().copied().fold(f64::MIN, f64::max);
    let low = x.iter().copied().fold(f64::MAX, f64::min);
    let ups: Vec<f64> = (1..x.len())
        .filter(|&k| x[k - 1] < 0.0 && x[k] >= 0.0)
        .map(|k| t[k - 1] - x[k - 1] * (t[k] - t[k - 1]) / (x[k] - x[k - 1]))
        .collect();
    let frequency = (ups.len() - 1) as f64 / (ups[ups.len() - 1] - ups[0]);
    (0.5 * (high - low), frequency)
}

/// The same of the two equations of the paper, by the method of Runge and Kutta with small steps.
fn of_equations(speed: f64) -> (f64, f64) {
    let omega = TAU * 0.2 * speed / DIAMETER;
    let lift = 0.5 * DENSITY * speed * speed * DIAMETER * LENGTH * 0.3 / 2.0;
    let rate = |[y, v, q, p]: [f64; 4]| {
        let a = (lift * q - damping(speed) * v - STIFFNESS * y) / MASS;
        [v, a, p, 12.0 / DIAMETER * a - 0.3 * omega * (q * q - 1.0) * p - omega * omega * q]
    };
    let along = |x: [f64; 4], h: f64, k: [f64; 4]| -> [f64; 4] { std::array::from_fn(|i| x[i] + h * k[i]) };
    let (mut x, h) = ([0.0, 0.0, 0.01, 0.0], 1e-3);
    let (mut t, mut y) = (Vec::new(), Vec::new());
    for k in 0..80_000 {
        let a = rate(x);
        let b = rate(along(x, 0.5 * h, a));
        let c = rate(along(x, 0.5 * h, b));
        let d = rate(along(x, h, c));
        x = std::array::from_fn(|i| x[i] + h / 6.0 * (a[i] + 2.0 * (b[i] + c[i]) + d[i]));
        t.push(h * f64::from(k));
        y.push(x[0]);
    }
    steady(&t, &y)
}

/// Amplitude at a frequency by harmonic balance: `q̂² = 4 (1 + A M λ ω²/(ε D))`, `ŷ = M q̂/√D`, the frequency where the balance of the
/// cosines holds; all in parts of the frequency of shedding.
fn by_balance(speed: f64) -> (f64, f64) {
    let omega = TAU * 0.2 * speed / DIAMETER;
    let (own, lambda) = (STIFFNESS / MASS / (omega * omega), damping(speed) / (MASS * omega));
    let m = 0.5 * DENSITY * speed * speed * DIAMETER * LENGTH * 0.15 / (MASS * DIAMETER * omega * omega);
    let d = |w: f64| (own - w * w).powi(2) + (lambda * w).powi(2);
    let off = |w: f64| 1.0 - w * w + 12.0 * m * w * w * (own - w * w) / d(w);
    // the solution with the largest amplitude, if there are several
    let amplitude = |w: f64| m / d(w).sqrt() * 2.0 * (1.0 + 12.0 * m * lambda * w * w / (0.3 * d(w))).sqrt();
    let mut best = (0.0, 0.0);
    let n = 20_000;
    for k in 1..n {
        let (a, b) = (2.0 * f64::from(k) / f64::from(n), 2.0 * f64::from(k + 1) / f64::from(n));
        if off(a) * off(b) <= 0.0 && amplitude(a) > best.0 {
            best = (amplitude(a), a);
        }
    }
    (best.0 * DIAMETER, best.1 * omega / TAU)
}

/// Far from its natural frequency of 1 Hz the cylinder follows the wake, which sheds at Strouhal's frequency; near it the wake follows
/// the cylinder, whose amplitude is many times as large.
#[test]
fn the_wake_locks_in_to_a_cylinder_on_a_spring() {
    let mut found = Vec::new();
    for speed in [0.25, 0.45, 0.55, 0.65, 1.1] {
        // slow wakes of the four stations take long to come together
        let h = cylinder(speed, if speed < 0.4 { 400.0 } else { 80.0 }, "");
        let z = h.column("cylinder.z").expect("z");
        let (amplitude, frequency) = steady(h.times(), z);
        let (wanted, at) = of_equations(speed);
        let (balanced, balanced_at) = by_balance(speed);
        let strouhal = 0.2 * speed / DIAMETER;
        println!(
            "{speed} m/s: {:.4} D at {frequency:.4} Hz; equations {:.4} D at {at:.4} Hz; balance {:.4} D at {balanced_at:.4} Hz; Strouhal \
             {strouhal:.3} Hz",
            amplitude / DIAMETER,
            wanted / DIAMETER,
            balanced / DIAMETER
        );
        assert!((amplitude - wanted).abs() <= 0.02 * wanted + 1e-5, "{speed}: {amplitude} {wanted}");
        assert!((frequency - at).abs() <= 0.005 * at, "{speed}: {frequency} {at}");
        found.push((speed, amplitude / DIAMETER, frequency));
    }
    // locked in: large, and shedding off its own frequency towards the cylinder's
    for &(speed, amplitude, frequency) in &found[1..4] {
        let strouhal = 2.0 * speed;
        assert!(amplitude > 5.0 * found[0].1 && amplitude > 0.1, "{speed}: {amplitude}");
        assert!((frequency - 1.0).abs() <= (strouhal - 1.0).abs() + 1e-3, "{speed}: {frequency}");
    }
}

#[test]
fn wakes_of_a_cylinder_at_rest_have_the_amplitude_of_van_der_pol() {
    let wake = ropewalk_forces::WakeOscillator { epsilon: 0.01, ..Default::default() };
    let omega = wake.omega(0.5, 0.1);
    assert!((omega - TAU).abs() <= 1e-12);
    let mut x = [0.01, 0.0];
    let mut most = 0.0_f64;
    for k in 0..20_000 {
        x = wake.after(0.02, x, omega, [0.0; 2]);
        if k > 19_000 {
            most = most.max(x[0].abs());
        }
    }
    // 2 to the first order of ε, and what lies between looks
    assert!((most - 2.0).abs() <= 2e-3, "{most}");
    // as a spring that is driven: the answer far from resonance is quasi-static
    let still = ropewalk_forces::WakeOscillator { epsilon: 0.0, ..Default::default() };
    let drive = 0.3;
    let half = still.after(PI / omega, [0.0; 2], omega, [drive, 0.0]);
    assert!((half[0] - 2.0 * 12.0 * drive / (omega * omega)).abs() <= 1e-5, "{half:?}");
}

/// Steps half as long bring the same vibration: the wake follows with the square of the step at least.
#[test]
fn vibration_converges_with_the_step() {
    let with = |h: f64| {
        let h = cylinder(0.55, 30.0, &format!("[solver]\nstepping = {{ fixed = {{ h = {h} }} }}\n"));
        h.column("cylinder.z").expect("z").to_vec()
    };
    let apart = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    let [coarse, middle, fine] = [0.02, 0.01, 0.005].map(with);
    let (first, second) = (apart(&coarse, &middle), apart(&middle, &fine));
    println!("{first:.2e} {second:.2e}");
    assert!(second <= 0.35 * first && first > 0.0, "{first} {second}");
}

/// A line that strums has more drag than one that is held still by its stiffness.
#[test]
fn strumming_adds_to_drag() {
    let line = |shedding: &str| {
        let text = format!(
            r#"
            run = {{ duration = 20, output = 0.05 }}
            [water]
            density = 1025
            current = [0.6, 0, 0]
            [[elements]]
            type = "cable"
            name = "line"
            points = [[0, 0, 0], [0, 0, -5]]
            elements = 10
            section = {{ mass = 0.6, ea = 1e6, ei = 1, diameter = 0.02 }}
            [[constraints]]
            type = "spherical"
            name = "top"
            marker = "line.start"
            [[constraints]]
            type = "spherical"
            name = "bottom"
            marker = "line.end"
            [[forces]]
            type = "drag"
            cn = 1.2
            [[forces]]
            type = "added_mass"
            {shedding}
            [[records]]
            type = "reaction"
            of = "top"
            [[records]]
            type = "position"
            of = "line@50%"
            "#
        );
        simulate(parse(&text).scene()).unwrap_or_else(|e| panic!("{e}"))
    };
    let mean = |h: &History| {
        let x = h.column("line@50%.x").expect("x");
        x[x.len() / 2..].iter().sum::<f64>() / (x.len() - x.len() / 2) as f64
    };
    let still = line("");
    let plain = line("[[forces]]\ntype = \"vortex_shedding\"");
    let grown = line(
        "[[forces]]\ntype = \"vortex_shedding\"\nstrumming = 1.2\n[[records]]\ntype = \"force\"\nof = \"line: vortex shedding\"",
    );
    let y = plain.column("line@50%.y").expect("y");
    let swing = y[y.len() / 2..].iter().fold(0.0_f64, |m, y| m.max(y.abs())) / 0.02;
    let shown = grown.last("line: vortex shedding.amplitude").expect("amplitude") / 0.02;
    println!(
        "swing {swing:.3} D, largest {shown:.3} D; sag {} {} {}",
        mean(&still),
        mean(&plain),
        mean(&grown)
    );
    assert!(swing > 0.1 && shown > 0.1, "{swing} {shown}");
    assert!(mean(&grown) > 1.03 * mean(&still));
}

#[test]
fn what_is_wrong_with_vortices_is_said() {
    let refused = |part: &str, force: &str| {
        let text =
            format!("[run]\nduration = 1\n[water]\n{part}\n[[forces]]\ntype = \"vortex_shedding\"\n{force}");
        match SceneFile::parse(&text, "vortices", Format::Toml, &[]) {
            Err(e) => e.to_string(),
            Ok(file) => file.build().err().expect("is refused").to_string(),
        }
    };
    let bare = "[[elements]]\ntype = \"cable\"\nname = \"line\"\npoints = [[0, 0, 0], [1, 0, 0]]\nelements = 2\nsection = { mass = 1, ea = 1e4 }";
    let mass = "[[elements]]\ntype = \"point_mass\"\nname = \"ball\"\nmarker = [0, 0, 0]\nmass = 1";
    for (part, force, said) in [
        (bare, "on = [\"line\"]", "vortices need a diameter"),
        (mass, "", "the scene has none of them"),
        (bare, "strouhal = -1", "`strouhal` must be"),
        (bare, "epsilon = 0", "`epsilon` must be"),
    ] {
        let error = refused(part, force);
        assert!(error.contains(said), "{said}: {error}");
    }
}

#[test]
fn wakes_at_rest_are_no_friction_that_an_equilibrium_leaves_out() {
    let text = r#"
        run = { duration = 0.1, output = 0.1, from_equilibrium = true }
        water = { current = [0.5, 0, 0] }
        [[elements]]
        type = "cable"
        name = "line"
        points = [[0, 0, -10], [0, 0, -60]]
        elements = 10
        section = { mass = 10, ea = 5e6, diameter = 0.05 }
        [[constraints]]
        type = "spherical"
        name = "top"
        marker = "line.start"
        [[forces]]
        type = "gravity"
        [[forces]]
        type = "drag"
        [[forces]]
        type = "vortex_shedding"
        "#;
    let h = simulate(parse(text).scene()).unwrap_or_else(|e| panic!("{e}"));
    assert!(!h.warnings.iter().any(|w| w.contains("friction")), "{:?}", h.warnings);
}
