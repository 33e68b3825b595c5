//! The energy of the water that slender bodies push aside.

use faer::prelude::Solve;
use faer::{Mat, c64};
use ropewalk::scene::Format;
use ropewalk::{About, History, LineariseOptions, ModesOptions, SceneFile, linearise, modes, simulate};
use ropewalk_core::{At, Model, System};

fn scene(text: &str) -> SceneFile {
    SceneFile::parse(text, "fluid", Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}"))
}

fn run(text: &str) -> History {
    simulate(scene(text).scene()).unwrap_or_else(|e| panic!("{e}"))
}

fn last(h: &History, name: &str) -> f64 {
    *h.column(name).unwrap_or_else(|| panic!("no {name}")).last().expect("a row")
}

/// Numbers that look random and are the same every time.
fn noise(n: usize, seed: u64, size: f64) -> Vec<f64> {
    let mut x = 0x9E37_79B9_7F4A_7C15u64.wrapping_mul(seed);
    let mut next = || {
        x ^= x << 13;
        x ^= x >> 7;
        x ^= x << 17;
        size * ((x >> 11) as f64 / (1u64 << 53) as f64 - 0.5)
    };
    (0..n).map(|_| next()).collect()
}

fn kinetic(model: &Model, q: &[f64], v: &[f64]) -> f64 {
    let a = vec![0.0; v.len()];
    model.energy(&At { t: 0.0, q, v, a: &a, internal: &[], relaxed: None }).kinetic
}

/// Lagrange's equations of the kinetic energy, by differences, are what the forces are: for a cable that moves in any way in
/// water that flows evenly.
#[test]
fn forces_are_those_of_the_energy() {
    for current in ["[0, 0, 0]", "[0.7, -0.4, 0.2]"] {
        let text = format!(
            r#"
            [water]
            current = {current}
            [[elements]]
            type = "cable"
            name = "cable"
            points = [[0, 0, 0], [2, 0, 0]]
            elements = 2
            section = {{ mass = 1.0, ea = 1.0, ei = 0.0, diameter = 0.1 }}
            [[forces]]
            type = "added_mass"
            tail = 1
            "#
        );
        let model = scene(&text).scene().build().unwrap_or_else(|e| panic!("{e}"));
        let n = model.velocities();
        let q: Vec<f64> = model.state().q.iter().zip(noise(n, 1, 0.5)).map(|(q, d)| q + d).collect();
        let (v, a) = (noise(n, 2, 2.0), noise(n, 3, 5.0));
        let moved = |x: &[f64], i: usize, h: f64| {
            let mut x = x.to_vec();
            x[i] += h;
            x
        };
        // quadratic in velocities: any step is exact
        let momentum = |q: &[f64], v: &[f64], i: usize| {
            0.5 * (kinetic(&model, q, &moved(v, i, 1.0)) - kinetic(&model, q, &moved(v, i, -1.0)))
        };
        let later = |h: f64| -> (Vec<f64>, Vec<f64>) {
            let q = (0..n).map(|i| q[i] + h * v[i] + 0.5 * h * h * a[i]).collect();
            (q, (0..n).map(|i| v[i] + h * a[i]).collect())
        };
        let fourth = |f: &dyn Fn(f64) -> f64| {
            let h = 1e-3;
            (8.0 * (f(h) - f(-h)) - (f(2.0 * h) - f(-2.0 * h))) / (12.0 * h)
        };
        let mut sys = System::default();
        let rest = vec![0.0; n];
        let mut residual = |v: &[f64], a: &[f64]| {
            let at = At { t: 0.0, q: &q, v, a, internal: &[], relaxed: None };
            model.assemble(&at, &[], None, &mut sys);
            sys.residual.clone()
        };
        let moving = residual(&v, &a);
        // the elastic forces alone: what is left where everything moves along with the water
        let u: Vec<f64> = match current {
            "[0, 0, 0]" => rest.clone(),
            _ => (0..n).map(|i| if i % 6 < 3 { [0.7, -0.4, 0.2][i % 6] } else { 0.0 }).collect(),
        };
        let elastic = residual(&u, &rest);
        let scale = moving.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        for i in 0..n {
            let rate = fourth(&|h| {
                let (q, v) = later(h);
                momentum(&q, &v, i)
            });
            let slope = fourth(&|h| kinetic(&model, &moved(&q, i, h), &v));
            let off = (rate - slope + elastic[i] - moving[i]).abs();
            assert!(off < 1e-8 * scale, "{current}: equation {i} is off by {off:e} of {scale:e}");
        }
    }
}

fn hull(angle: f64, spin: f64, solver: &str) -> History {
    run(&format!(
        r#"
        [run]
        duration = "4 s"
        output = "0.5 s"
        [solver]
        {solver}
        [water]
        [[elements]]
        type = "rigid_body"
        name = "hull"
        position = [0, 0, 0]
        angles = [0, "{angle} deg", 0]
        angular_velocity = [0, {spin}, 0]
        velocity = [1, 0, 0]
        mass = 64.4
        inertia = [0.32, 21.5, 21.5]
        hull = {{ from = [-1, 0, 0], to = [1, 0, 0], diameter = 0.2 }}
        [[forces]]
        type = "added_mass"
        [[records]]
        type = "orientation"
        of = "hull"
        [[records]]
        type = "energy"
        "#
    ))
}

/// A hull at an angle to its way turns across it (Munk's moment). Reference: Kirchhoff's equations with the closed added
/// mass of the cylinder, by another integrator.
#[test]
fn a_hull_turns_as_kirchhoff_says() {
    for (solver, tolerance) in
        [("", 1e-4), ("scheme = \"radau-iia-5\"\nstepping = { controlled = { tolerance = 1e-8 } }", 1e-5)]
    {
        let h = hull(10.0, 0.0, solver);
        let angles = h.column("hull.phi2").expect("angles").to_vec();
        let t =
            h.column("t").map_or_else(|| (0..angles.len()).map(|k| 0.5 * k as f64).collect(), |t| t.to_vec());
        for (at, exact) in [(2.0, 0.77785), (4.0, std::f64::consts::PI - 2.26976)] {
            let k = t.iter().position(|t: &f64| (t - at).abs() < 1e-6).expect("a sample");
            println!("{at} s: {} instead of {exact}", angles[k]);
            assert!((angles[k] - exact).abs() < tolerance + 1e-5, "{solver} {at} s: {}", angles[k]);
        }
    }
    let h = hull(0.0, 1.0, "scheme = \"radau-iia-5\"\nstepping = { controlled = { tolerance = 1e-9 } }");
    for e in h.column("energy.kinetic").expect("energy") {
        assert!((e / 53.6838 - 1.0).abs() < 2e-6, "{e} J");
    }
}

/// A free cable that bends and whips through still water: what its ends shed is all that it loses.
#[test]
fn a_free_cable_keeps_what_its_ends_do_not_shed() {
    for tail in [0.0, 0.5, 1.0] {
        let h = run(&format!(
            r#"
            [run]
            duration = "2 s"
            output = "0.1 s"
            [solver]
            scheme = "radau-iia-5"
            stepping = {{ controlled = {{ tolerance = 1e-8 }} }}
            [water]
            current = [0.3, 0.2, 0]
            [[elements]]
            type = "cable"
            name = "cable"
            curve = [[0, 0, 0], [0.5, 0.2, 0], [1, 0, 0.1], [1.5, 0, 0]]
            elements = 6
            velocity = [1, 0.5, 0]
            section = {{ mass = 2.0, ea = 1e3, ei = 0.5, diameter = 0.05 }}
            [[forces]]
            type = "added_mass"
            tail = {tail}
            [[records]]
            type = "energy"
            "#
        ));
        let (lost, imbalance) = (last(&h, "energy.dissipated"), last(&h, "energy.imbalance"));
        let kinetic = last(&h, "energy.kinetic");
        println!("tail {tail}: {kinetic:.4} J left, {lost:.4} J shed, imbalance {imbalance:.1e} J");
        assert!(imbalance.abs() < 1e-5 * kinetic, "{imbalance} J");
        assert!(if tail < 1.0 { lost > 1e-3 } else { lost.abs() < 1e-9 }, "{lost} J");
    }
}

/// A cable that is fed out or reeled in under water while its eyelet moves: the water beside it is closed, and keeps its balance.
#[test]
fn the_water_beside_a_cable_that_feeds_keeps_its_balance() {
    for (speed, current, element) in [
        (0.8, "[0, 0, 0]", ""),
        (-0.5, "[0.3, 0.2, 0]", ""),
        (0.8, "[0.3, 0.2, 0.1]", "element_length = 0.25"),
    ] {
        let left = |elements: usize| {
            let h = run(&format!(
                r#"
                [run]
                duration = "1 s"
                output = "0.02 s"
                [solver]
                scheme = "radau-iia-5"
                stepping = {{ controlled = {{ tolerance = 1e-7 }} }}
                [water]
                current = {current}
                [[elements]]
                type = "cable"
                name = "cable"
                curve = [[0, 0, 0], [0.5, 0.2, 0], [1, 0, 0.1], [1.5, 0, 0]]
                elements = {elements}
                section = {{ mass = 2.0, ea = 1e3, ei = 0.5, diameter = 0.05 }}
                [[motions]]
                type = "harmonic"
                name = "sway"
                amplitude = [0.1, 0.3, 0]
                frequency = 1
                ramp = 0.5
                [[constraints]]
                type = "driving"
                name = "eyelet"
                marker = "cable.start"
                motion = "sway"
                [[constraints]]
                type = "winch"
                name = "winch"
                marker = "cable.start"
                speed = {speed}
                ramp = 0.2
                {element}
                [[forces]]
                type = "added_mass"
                [[records]]
                type = "energy"
                "#
            ));
            let imbalance = h.column("energy.imbalance").expect("energy");
            let worst =
                imbalance.iter().fold(0.0, |most: f64, x| if x.abs() <= most { most } else { x.abs() });
            (worst, last(&h, "energy.kinetic"))
        };
        let ((coarse, _), (fine, kinetic)) = (left(6), left(12));
        println!("{speed} m/s in {current}: imbalance {coarse:.2e} and {fine:.2e} of {kinetic:.3} J");
        // the end that feeds moves 0.4 to 0.65 J
        assert!(coarse < 1e-3 * kinetic && fine < 1e-3 * kinetic, "{coarse} {fine} of {kinetic} J");
    }
}

/// Cylinders in axial flow, `u = U √(m_a/EI) L`: the largest growth of any mode [1/s].
fn growth(ends: &str, beta: f64, u: f64, tail: f64) -> f64 {
    // EI = L = m + m_a = 1; the tension that keeps it straight is none
    let mass = 1.0 - beta;
    let diameter = (4.0 * beta / (std::f64::consts::PI * 1000.0)).sqrt();
    let speed = u / beta.sqrt();
    let clamp = |end: &str| {
        format!(
            "[[constraints]]\ntype = \"spherical\"\nname = \"pin {end}\"\nmarker = \"cylinder.{end}\"\n\
             [[constraints]]\ntype = \"direction\"\nname = \"clamp {end}\"\nmarker = \"cylinder.{end}\"\n"
        )
    };
    let pin = |end: &str| {
        format!("[[constraints]]\ntype = \"spherical\"\nname = \"pin {end}\"\nmarker = \"cylinder.{end}\"\n")
    };
    let held = match ends {
        "clamped-free" => clamp("start"),
        "pinned-pinned" => pin("start") + &pin("end"),
        _ => clamp("start") + &clamp("end"),
    };
    let text = format!(
        r#"
        [water]
        density = 1000
        current = [{speed}, 0, 0]
        [[elements]]
        type = "cable"
        name = "cylinder"
        points = [[0, 0, 0], [1, 0, 0]]
        elements = 24
        section = {{ mass = {mass}, ea = 1e6, ei = 1, diameter = {diameter} }}
        [[forces]]
        type = "added_mass"
        tail = {tail}
        {held}
        "#
    );
    let found = modes(scene(&text).scene(), &ModesOptions { count: 6, ..ModesOptions::default() });
    let found = found.unwrap_or_else(|e| panic!("{e}"));
    let most = found.modes.iter().map(|m| m.growth).fold(f64::NEG_INFINITY, f64::max);
    println!("{ends} beta {beta} u {u} tail {tail}: {most:.4} {:?}", found.warnings);
    most
}

/// Divergence and flutter of cylinders in axial flow as Païdoussis has them: pinned and clamped at both ends they buckle at
/// π and 2π; cut off at the tail, a cantilever flutters like a pipe that conveys fluid.
#[test]
fn cylinders_in_axial_flow_lose_stability_where_they_should() {
    for (ends, beta, tail, critical) in [
        ("pinned-pinned", 0.48, 0.0, std::f64::consts::PI),
        ("clamped-clamped", 0.48, 0.0, std::f64::consts::TAU),
        ("clamped-free", 0.2, 0.0, 5.591),
        // divergence at cos u = -(1 - f)/f
        ("clamped-free", 0.48, 0.8, f64::acos(-0.25)),
    ] {
        let below = growth(ends, beta, 0.995 * critical, tail);
        let above = growth(ends, beta, 1.005 * critical, tail);
        assert!(below < 1e-4 && above > 1e-2, "{ends}: {below} below and {above} above {critical}");
    }
}

/// A long limp line in flow along it, between pins: the largest growth of any wave [1/s], by Bloch's theorem from the
/// equations of a node in its middle.
fn limp(theory: &str, tension: f64, speed: f64) -> f64 {
    let (mass, water, ea) = (0.861f64, 0.4259f64, 1e9);
    let diameter = (4.0 * water / (std::f64::consts::PI * 1025.0)).sqrt();
    let text = format!(
        r#"
        [water]
        density = 1025
        current = [{speed}, 0, 0]
        [[elements]]
        type = "cable"
        name = "line"
        points = [[0, 0, 0], [8, 0, 0]]
        tension = {tension}
        elements = 8
        section = {{ mass = {mass}, ea = {ea}, diameter = {diameter} }}
        [[forces]]
        type = "added_mass"
        theory = "{theory}"
        [[constraints]]
        type = "spherical"
        name = "first"
        marker = "line.start"
        [[constraints]]
        type = "spherical"
        name = "last"
        marker = "line.end"
        "#
    );
    let options = LineariseOptions { about: About::Start, ..LineariseOptions::default() };
    let l = linearise(scene(&text).scene(), &options).unwrap_or_else(|e| panic!("{e}"));
    // across the line: position and slope along y, of the node in the middle and its neighbours
    let seat = |node: usize, slope: usize| 6 * node + 1 + 3 * slope;
    let [m, c, k] = [&l.mass, &l.damping, &l.stiffness].map(|a| a.to_dense());
    let wave = |matrix: &Mat<f64>, phase: f64, i: usize, j: usize| {
        (3..=5).fold(c64::new(0.0, 0.0), |sum, node| {
            let turn = phase * (node as f64 - 4.0);
            sum + matrix[(seat(4, i), seat(node, j))] * c64::new(turn.cos(), turn.sin())
        })
    };
    // of waves that elements resolve
    (1..=20).fold(f64::NEG_INFINITY, |most, step| {
        let phase = f64::from(step) / 20.0;
        let [m, c, k] = [&m, &c, &k].map(|a| Mat::from_fn(2, 2, |i, j| wave(a, phase, i, j)));
        let lu = m.partial_piv_lu();
        let (k, c) = (lu.solve(&k), lu.solve(&c));
        let a = Mat::from_fn(4, 4, |i, j| match (i < 2, j < 2) {
            (true, false) if i == j - 2 => c64::new(1.0, 0.0),
            (true, _) => c64::new(0.0, 0.0),
            (false, true) => -k[(i - 2, j)],
            (false, false) => -c[(i - 2, j - 2)],
        });
        let values = a.eigenvalues().expect("eigenvalues");
        values.iter().fold(most, |most: f64, value| if value.re <= most { most } else { value.re })
    })
}

/// Waves on a limp line in flow `U` along it grow below the tension `m m_a/(m + m_a) U²`; Morison's inertia alone lets none
/// grow.
#[test]
fn a_limp_line_in_flow_along_it_needs_tension() {
    for speed in [5.0, 12.86111] {
        let critical = 0.861 * 0.4259 / (0.861 + 0.4259) * speed * speed;
        let (below, above) = (limp("energy", 0.99 * critical, speed), limp("energy", 1.01 * critical, speed));
        println!("{speed} m/s: {below:.3e} below {critical:.3} N, {above:.3e} above");
        assert!(below > 0.1 && above < 1e-2, "{below} {above}");
        assert!(limp("morison", 0.1 * critical, speed) < 1e-3);
    }
}

/// The far end of a fine mesh begins to move with less than the smallest numbers.
#[test]
fn cables_on_fine_meshes_begin_to_move() {
    for elements in [300, 512, 513] {
        let h = run(&format!(
            r#"
            gravity = [0, -9.81, 0]
            [run]
            duration = "3 ms"
            output = "1 ms"
            [water]
            [solver]
            stepping = {{ fixed = {{ h = "1 ms" }} }}
            [[elements]]
            type = "cable"
            name = "cable"
            points = [[0, 0, 0], [1, 0, 0]]
            elements = {elements}
            section = {{ mass = 0.5, ea = 5000, ei = 0.1, diameter = 0.02 }}
            [[constraints]]
            type = "spherical"
            name = "pin"
            marker = "cable.start"
            [[forces]]
            type = "gravity"
            [[forces]]
            type = "buoyancy"
            [[forces]]
            type = "added_mass"
            [[records]]
            type = "position"
            of = "cable.end"
            "#
        ));
        // the tip falls with the net weight over the mass that moves with it
        let (mass, water) = (0.5, 1025.0 * std::f64::consts::PI * 0.01 * 0.01);
        let fallen = 0.5 * 9.81 * (mass - water) / (mass + water) * 9e-6;
        let found = -last(&h, "cable.end.y");
        assert!((found / fallen - 1.0).abs() < 1e-3, "{elements}: {found:e} instead of {fallen:e}");
    }
}
