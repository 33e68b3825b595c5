//! Pipes that carry a flow: frequencies, buckling, flutter, thrust, motion, against an independent Galerkin solution and
//! closed forms.

use crate::common::{data, number, place, reaction, size};
use ropewalk::{ModesOptions, modes};
use ropewalk_core::integrator::{Options, Scheme, Stepping};
use ropewalk_core::testing::check_tangent;
use ropewalk_core::{At, Model, Simulation, State, Width};
use ropewalk_forces::InternalFlow;
use ropewalk_scene::{Format, Scene, SceneFile};

/// A pipe of length 1 and EI = 1 along x whose mass and that of the fluid are 1 together; `u` without dimension, as all
/// times. Fluid of density `4/π β` fills a bore of 1 m.
fn pipe(elements: usize, ea: f64, beta: f64, u: f64, ends: &str, more: &str) -> Scene {
    let held = |end: &str, x: f64, kind: &str| match kind {
        "clamped" => format!(
            "[[constraints]]\ntype = \"spherical\"\nname = \"{end}\"\nmarker = \"pipe.{end}\"\nto = [{x}, 0, 0]\n\
             [[constraints]]\ntype = \"direction\"\nname = \"{end}-clamp\"\nmarker = \"pipe.{end}\"\n"
        ),
        "pinned" => format!(
            "[[constraints]]\ntype = \"spherical\"\nname = \"{end}\"\nmarker = \"pipe.{end}\"\nto = [{x}, 0, 0]\n"
        ),
        _ => String::new(),
    };
    let (start, end) = ends.split_once('-').expect("two ends");
    let text = format!(
        r#"
        [run]
        duration = 10
        output = 10
        [[elements]]
        type = "cable"
        name = "pipe"
        points = [[0, 0, 0], [1, 0, 0]]
        elements = {elements}
        section = {{ mass = {}, ea = {ea}, ei = 1 }}
        {}{}
        [[forces]]
        type = "internal_flow"
        cable = "pipe"
        density = {}
        bore = 1
        speed = {}
        weight = false
        {more}
        "#,
        1.0 - beta,
        held("start", 0.0, start),
        held("end", 1.0, end),
        4.0 / std::f64::consts::PI * beta,
        u / beta.sqrt(),
    );
    scene(&text)
}

#[track_caller]
fn scene(text: &str) -> Scene {
    SceneFile::parse(text, "scene.toml", Format::Toml, &[])
        .unwrap_or_else(|e| panic!("{e}\n{text}"))
        .into_scene()
}

/// Transverse modes as growth and frequency; each is there twice, in y and in z.
fn spectrum(scene: &Scene, count: usize) -> (Vec<[f64; 2]>, bool) {
    let options = ModesOptions { count: 2 * count, ..ModesOptions::default() };
    let found = modes(scene, &options).unwrap_or_else(|e| panic!("{e}"));
    (found.modes.iter().map(|m| [m.growth, m.omega]).collect(), found.unstable)
}

#[test]
fn frequencies_are_those_of_the_galerkin_solution() {
    let all = data("internal_flow.json");
    let mut looked = 0;
    for (ends, name, tolerance) in [
        ("clamped-clamped", "clamped-clamped", 3e-4),
        ("pinned-pinned", "pinned-pinned", 1e-4),
        ("clamped-free", "cantilever", 1e-3),
    ] {
        for case in all[name].as_array().expect("cases") {
            let (beta, u) = (number(&case["beta"]), number(&case["u"]));
            let exact: Vec<[f64; 2]> = case["lambda"]
                .as_array()
                .expect("λ")
                .iter()
                .map(|l| [number(&l[0]), number(&l[1])])
                .collect();
            // beyond the first loss of stability no equilibrium vibrates, and near it the speed's error counts most
            if exact.iter().any(|l| l[0] > 0.0 || l[1] < 3.0) || u == 0.0 || u > 5.0 {
                continue;
            }
            let (found, unstable) = spectrum(&pipe(16, 1e6, beta, u, ends, ""), 2);
            assert!(!unstable, "{name}, β = {beta}, u = {u}");
            for l in &exact[..2] {
                let off =
                    found.iter().map(|f| (f[0] - l[0]).hypot(f[1] - l[1])).fold(f64::INFINITY, f64::min);
                let off = off / l[0].hypot(l[1]);
                assert!(off < tolerance, "{name}, β = {beta}, u = {u}: {l:?} is off by {off:e} in {found:?}");
                looked += 1;
            }
        }
    }
    assert!(looked >= 60, "{looked}");
}

#[test]
fn pipes_buckle_and_flutter_at_the_known_speeds() {
    let all = data("internal_flow.json");
    let pi = std::f64::consts::PI;
    // at the critical speed, to one part in a thousand on both sides; both ends held, or the outlet free
    for (ends, beta, critical) in [
        ("clamped-clamped", 0.3, 2.0 * pi),
        ("pinned-pinned", 0.5, pi),
        ("clamped-pinned", 0.5, 4.493_409_458),
    ] {
        for (share, unstable) in [(0.999, false), (1.001, true)] {
            assert_eq!(
                spectrum(&pipe(16, 1e6, beta, share * critical, ends, ""), 2).1,
                unstable,
                "{ends}, {share}"
            );
        }
    }
    let flutter = all["cantilever_flutter"].as_array().expect("flutter");
    let at = |beta: f64| {
        let case = flutter.iter().find(|c| number(&c["beta"]) == beta).unwrap_or_else(|| panic!("{beta}"));
        (number(&case["u_c"]), number(&case["omega_c"]))
    };
    for beta in [0.1, 0.2, 0.5, 0.65] {
        let (critical, omega) = at(beta);
        for (share, unstable) in [(0.999, false), (1.001, true)] {
            let (found, is) = spectrum(&pipe(24, 1e6, beta, share * critical, "clamped-free", ""), 4);
            assert_eq!(is, unstable, "β = {beta}, {share}");
            if is {
                let [growth, found] = found[0];
                assert!(
                    (found / omega - 1.0).abs() < 5e-3 && growth < 0.1 * omega,
                    "β = {beta}: {found}, {growth}"
                );
            }
        }
    }
    // a nozzle of half the area
    let nozzle = &all["nozzle"];
    let more = format!("nozzle = {}", 0.5_f64.sqrt());
    for (share, unstable) in [(0.998, false), (1.002, true)] {
        let u = share * number(&nozzle["u_c"]);
        assert_eq!(spectrum(&pipe(24, 1e6, 0.4, u, "clamped-free", &more), 4).1, unstable, "nozzle, {share}");
    }
}

fn term(model: &Model) -> &dyn ropewalk_core::Term {
    model.terms().iter().find(|t| t.label().ends_with("internal flow")).expect("the flow").as_ref()
}

#[test]
fn tangents_are_the_derivatives_of_the_forces() {
    for more in [
        "",
        "nozzle = 0.8",
        "closed = true",
        "time = { harmonic = { mean = 1, amplitude = 0.3, frequency = 2, phase = 0.4 } }",
    ] {
        for speed in [3.0, -2.0] {
            let model =
                pipe(3, 1e3, 0.4, speed, "clamped-free", more).build().unwrap_or_else(|e| panic!("{e}"));
            let state = disturbed(&model);
            let off = check_tangent(term(&model), model.nodes(), &At { t: 0.37, ..state.at() }, Width::One);
            assert!(off < 1e-6, "{more}, {speed}: {off:e}");
        }
    }
}

/// A state far from equilibrium.
fn disturbed(model: &Model) -> State {
    let mut state = model.state();
    let wave = |k: usize, a: f64| a * (1.3 * k as f64 + 0.7).sin();
    (0..state.q.len()).for_each(|k| state.q[k] += wave(k, 0.2));
    (0..state.v.len()).for_each(|k| {
        state.v[k] = wave(k, 1.5);
        state.a[k] = wave(2 * k, 4.0);
    });
    state
}

#[test]
fn energy_closes_while_the_flow_changes() {
    let more = "time = { harmonic = { mean = 1, amplitude = 0.4, frequency = 0.5, phase = 0 } }";
    let lost = |h: f64| {
        let scene = pipe(6, 2000.0, 0.4, 6.0, "clamped-free", more);
        let model = scene.build().unwrap_or_else(|e| panic!("{e}"));
        let mut state = model.state();
        for node in 1..=6 {
            let x = node as f64 / 6.0;
            for (c, speed) in [(1, 0.3), (2, -0.2)] {
                state.v[6 * node + c] = speed * x * x;
                state.v[6 * node + 3 + c] = 2.0 * speed * x;
            }
        }
        let options =
            Options { scheme: Scheme::RadauIia5, stepping: Stepping::Fixed { h }, ..Options::default() };
        let mut s = Simulation::from(model, state, &options, 1.5).unwrap_or_else(|e| panic!("{e}"));
        s.advance(1.5, f64::INFINITY, &mut ()).unwrap_or_else(|e| panic!("{e}"));
        let a = &s.audit;
        println!("h = {h}: {:e} J, {a:?}", a.imbalance());
        assert!(a.supplied.abs() > 1e-3, "the flow did nothing: {a:?}");
        a.imbalance().abs() / a.scale
    };
    // the audit adds powers up by the trapezoidal rule, of second order
    let [coarse, fine] = [2e-3, 1e-3].map(lost);
    assert!(fine < 2e-4 && coarse / fine > 3.5, "{coarse:e}, {fine:e}");
}

#[test]
fn a_pipe_swings_as_the_galerkin_solution_while_its_flow_starts() {
    // let go in its first mode, with u = 3 (1 - cos 2πt)
    let all = data("internal_flow.json");
    for case in
        all["tip_history"].as_array().expect("histories").iter().filter(|c| c["u"] == "3 (1 - cos 2 pi t)")
    {
        let beta = number(&case["beta"]);
        let phase = -0.5 * std::f64::consts::PI;
        let more =
            format!("time = {{ harmonic = {{ mean = 1, amplitude = 1, frequency = 1, phase = {phase} }} }}");
        let model = pipe(16, 1e6, beta, 3.0, "clamped-free", &more).build().unwrap_or_else(|e| panic!("{e}"));
        let (k, small) = (1.875_104_068_711_961_f64, 1e-5);
        let c = (k.cosh() + k.cos()) / (k.sinh() + k.sin());
        let mode = |x: f64| (k * x).cosh() - (k * x).cos() - c * ((k * x).sinh() - (k * x).sin());
        let slope = |x: f64| k * ((k * x).sinh() + (k * x).sin() - c * ((k * x).cosh() - (k * x).cos()));
        let mut state = model.state();
        for node in 0..=16 {
            let x = node as f64 / 16.0;
            state.q[6 * node + 1] = small * mode(x) / mode(1.0);
            state.q[6 * node + 4] = small * slope(x) / mode(1.0);
        }
        let options = Options {
            stepping: Stepping::Fixed { h: 1e-3 },
            scheme: Scheme::RadauIia5,
            ..Options::default()
        };
        let mut s = Simulation::from(model, state, &options, 1.0).unwrap_or_else(|e| panic!("{e}"));
        for (t, exact) in case["t"].as_array().expect("t").iter().zip(case["w_tip"].as_array().expect("w")) {
            s.advance(number(t), f64::INFINITY, &mut ()).unwrap_or_else(|e| panic!("{e}"));
            let w = place(&s.model, &s.state, "pipe", 1.0)[1] / small;
            assert!((w - number(exact)).abs() < 3e-4, "β = {beta}, t = {t}: {w} instead of {exact}");
        }
    }
}

#[test]
fn a_bent_pipe_is_pushed_by_what_turns_in_it() {
    // a cantilever under a load: at its root stand the load and the change of the fluid's momentum
    let (beta, u) = (0.4_f64, 1.5);
    let more = "[[forces]]\ntype = \"point_force\"\nmarker = \"pipe.end\"\nforce = [0, 1, 0]\n";
    let mut scene = pipe(8, 1e4, beta, u, "clamped-free", more);
    scene.run.analysis = ropewalk_scene::Analysis::Statics;
    let model = scene.build().unwrap_or_else(|e| panic!("{e}"));
    let mut state = model.state();
    ropewalk_core::statics::Statics::new(&model, &scene.statics)
        .and_then(|mut s| s.find(&mut state, true).map_err(|e| panic!("{e}")))
        .unwrap_or_else(|e| panic!("{e}"));
    let root = reaction(&model, &state, "start");
    let line = model.part("pipe").and_then(|p| p.line()).expect("a line");
    let slope = |s: f64| line.slope(s, &state.q, true).expect("a slope").1;
    let (first, last) = (slope(0.0), slope(1.0));
    // m u² with m = β and u √β
    let thrust = |i: usize| u * u * (last[i] - first[i]) - [0.0, 1.0, 0.0][i];
    let off = size(std::array::from_fn(|i| root[i] - thrust(i)));
    assert!(last[1] > 0.2 && off < 1e-7, "{root:?}, {last:?}: {off:e}");
}

#[test]
fn the_wall_carries_what_friction_and_its_own_weight_ask_for() {
    // a hose that hangs, open below: T_wall = (m g + f m_f u²/2D) (L - s), the pressure is below that of the air unless
    // friction holds the water back
    let (l, d, u, f, own) = (4.0, 0.02, 3.0, 0.03, 0.5);
    let text = format!(
        r#"
        [run]
        analysis = "statics"
        [[elements]]
        type = "cable"
        name = "hose"
        points = [[0, 0, 0], [0, 0, {}]]
        elements = 4
        section = {{ mass = {own}, ea = 1e7, ei = 1 }}
        [[constraints]]
        type = "clamp"
        name = "top"
        marker = "hose.start"
        [[forces]]
        type = "gravity"
        [[forces]]
        type = "internal_flow"
        cable = "hose"
        density = 1000
        bore = {d}
        speed = {u}
        friction = {f}
        [[records]]
        type = "wall_tension"
        of = "hose"
        at = ["start", "25 %", "end"]
        "#,
        -l
    );
    let history = ropewalk::simulate(&scene(&text)).unwrap_or_else(|e| panic!("{e}"));
    let last = |what: &str, at: &str| {
        let name = format!("hose.{what}{at}");
        history.last(&name).unwrap_or_else(|| panic!("no {name}"))
    };
    let inside = 1000.0 * std::f64::consts::PI * d * d / 4.0;
    let drag = f * u * u / (2.0 * d);
    for (at, share) in [(".start", 0.0), ("@25%", 0.25), (".end", 1.0)] {
        let below = l * (1.0 - share);
        let (wall, pressure) = ((own * 9.81 + inside * drag) * below, 1000.0 * (drag - 9.81) * below);
        let found = [last("wall_tension", at), last("pressure", at)];
        println!("{at}: {found:?}, exact {wall} N, {pressure} Pa");
        assert!((found[0] - wall).abs() < 1e-4 * wall.max(1.0), "{at}: {found:?}");
        assert!((found[1] - pressure).abs() < 1e-3 * (1.0 + pressure.abs()), "{at}: {found:?}");
    }
}

/// A hose that hangs from a clamp and carries a flow, such that its inertia would weigh as much as the hose where it speeds up
/// as `FASTER` says.
fn hose(more: &str, time: &str) -> String {
    format!(
        r#"
        run = {{ duration = 1e-3, output = 1e-3, {more} }}
        [[elements]]
        type = "cable"
        name = "hose"
        points = [[0, 0, 0], [0, 0, -4]]
        elements = 4
        section = {{ mass = 0.5, ea = 1e4, ei = 1 }}
        [[constraints]]
        type = "clamp"
        name = "top"
        marker = "hose.start"
        [[forces]]
        type = "gravity"
        [[forces]]
        type = "internal_flow"
        cable = "hose"
        density = 1000
        bore = 0.02
        speed = 3
        {time}
        [[records]]
        type = "position"
        of = "hose.end"
        "#
    )
}

const FASTER: &str = "time = { harmonic = { mean = 1, amplitude = 0.5, frequency = 2, phase = 0 } }";

/// A pump whose flow changes from the first moment on: the hose hangs at first as with the flow that it has then, and what its
/// speeding up pushes along it is felt from then on.
#[test]
fn a_run_starts_from_the_equilibrium_of_its_flow_at_that_instant() {
    let start = |more: &str, time: &str| {
        let history = ropewalk::simulate(&scene(&hose(more, time))).unwrap_or_else(|e| panic!("{e}"));
        history.column("hose.end.z").expect("a position")[0]
    };
    let rest = "analysis = \"statics\"";
    let [still, steady, changing] =
        [(rest, ""), ("from_equilibrium = true", ""), ("from_equilibrium = true", FASTER)]
            .map(|(more, time)| start(more, time));
    // what accelerates it is m u̇ = 5.9 N/m, as much as its weight
    println!("{still} {steady} {changing}");
    assert!(still < -4.0 && (steady - still).abs() < 1e-9 && (changing - still).abs() < 1e-9);
}

/// What speeds up is left out of what vibrates too: only then is it about an equilibrium.
#[test]
fn modes_and_linearised_equations_are_about_the_equilibrium_that_a_run_starts_from() {
    let scenes =
        [("", ""), ("", FASTER), ("analysis = \"statics\"", "")].map(|(more, time)| scene(&hose(more, time)));
    let options = ModesOptions { count: 6, ..ModesOptions::default() };
    let found = scenes.each_ref().map(|s| modes(s, &options).unwrap_or_else(|e| panic!("{e}")));
    let about = ropewalk::LineariseOptions::default();
    let linear = scenes.each_ref().map(|s| ropewalk::linearise(s, &about).unwrap_or_else(|e| panic!("{e}")));
    let (still, of) = (&found[0], &linear[0]);
    assert!(still.modes.len() == 6 && !still.unstable);
    for (other, equations) in found.iter().zip(&linear).skip(1) {
        let moved = still.state.q.iter().zip(&other.state.q).map(|(a, b)| (a - b).abs());
        let changed = still
            .modes
            .iter()
            .zip(&other.modes)
            .map(|(a, b)| (a.growth - b.growth).hypot(a.omega - b.omega) / a.omega);
        let (moved, changed): (Vec<f64>, Vec<f64>) = (moved.collect(), changed.collect());
        println!("{moved:?} {changed:?}");
        assert!(moved.iter().all(|x| *x <= 1e-9) && changed.iter().all(|x| *x <= 1e-7));
        for (a, b) in [(&of.stiffness, &equations.stiffness), (&of.damping, &equations.damping)] {
            let largest = a.val().iter().fold(0.0, |m: f64, x| m.max(x.abs()));
            let same = a.val().iter().zip(b.val()).all(|(a, b)| (a - b).abs() <= 1e-9 * largest);
            assert!(largest > 0.0 && a.val().len() == b.val().len() && same);
        }
    }
}

/// A hose that hangs in water from 20 m below its surface, which is far enough for no element to feel it, open below: its wall, the pressure in it, and those to be.
fn hanging(speed: f64, expected: impl Fn(f64) -> [f64; 2]) {
    let text = format!(
        r#"
        [run]
        analysis = "statics"
        [water]
        density = 1025
        level = 20
        [[elements]]
        type = "cable"
        name = "hose"
        points = [[0, 0, 0], [0, 0, -4]]
        elements = 4
        section = {{ mass = 1.5, ea = 1e7, ei = 1, diameter = 0.03 }}
        [[constraints]]
        type = "clamp"
        name = "top"
        marker = "hose.start"
        [[forces]]
        type = "gravity"
        [[forces]]
        type = "buoyancy"
        [[forces]]
        type = "internal_flow"
        cable = "hose"
        density = 900
        bore = 0.02
        speed = {speed}
        friction = 0.03
        [[records]]
        type = "wall_tension"
        of = "hose"
        at = ["start", "25 %", "end"]
        "#
    );
    let history = ropewalk::simulate(&scene(&text)).unwrap_or_else(|e| panic!("{e}"));
    for (at, share) in [(".start", 0.0), ("@25%", 0.25), (".end", 1.0)] {
        let [wall, pressure] = expected(4.0 * share);
        let found = ["wall_tension", "pressure"].map(|what| {
            let name = format!("hose.{what}{at}");
            history.last(&name).unwrap_or_else(|| panic!("no {name}"))
        });
        println!("{at}: {found:?}, exact {wall} N, {pressure} Pa");
        assert!((found[0] - wall).abs() < 1e-4 * wall.abs().max(1.0), "{at}: {found:?}");
        assert!((found[1] - pressure).abs() < 1e-3 * (1.0 + pressure.abs()), "{at}: {found:?}");
    }
}

/// Areas of the bore and of the hose [m²], and the friction's gradient of the pressure over the density [m/s²].
fn areas(u: f64) -> [f64; 3] {
    let area = |d: f64| std::f64::consts::PI * d * d / 4.0;
    [area(0.02), area(0.03), 0.03 * u * u / (2.0 * 0.02)]
}

#[test]
fn water_presses_on_the_open_end_of_the_wall() {
    // the wall hangs on itself and on the fluid's friction, and what it has of the water's pressure is that below its end
    let [bore, outer, drag] = areas(3.0);
    let below = 1025.0 * 9.81 * 24.0;
    hanging(3.0, |s| {
        let own = (1.5 * 9.81 + 900.0 * bore * drag) * (4.0 - s);
        [own - below * (outer - bore), below + 900.0 * (drag - 9.81) * (4.0 - s)]
    });
}

#[test]
fn a_flow_upwards_is_pressed_in_below() {
    // the outlet is above, in water of its own pressure: from there it rises with depth and friction
    let [bore, outer, drag] = areas(3.0);
    let outside = |s: f64| 1025.0 * 9.81 * (20.0 + s);
    hanging(-3.0, |s| {
        let pressure = outside(0.0) + 900.0 * (9.81 + drag) * s;
        let effective = (1.5 + 900.0 * bore - 1025.0 * outer) * 9.81 * (4.0 - s);
        [effective + pressure * bore - outside(s) * outer, pressure]
    });
}

/// In a ring the centrifugal force of the fluid is a tension of m u² times the stretch: the stretch is 1/(1 - m u²/EA),
/// whatever resists bending, since each piece of the wall turns as before.
#[test]
fn a_ring_is_stretched_by_what_runs_round_in_it() {
    let n = 32;
    let around = |k: usize| {
        let (sin, cos) = (std::f64::consts::TAU * k as f64 / n as f64).sin_cos();
        [cos, sin, 0.0]
    };
    let curve: Vec<[f64; 3]> = (0..=n).map(|k| around(k % n)).collect();
    let end = |name: &str, more: &str| {
        format!(
            "[[constraints]]\ntype = \"spherical\"\nname = \"{name}\"\nmarker = \"ring.{name}\"\n{more}\n\
             [[constraints]]\ntype = \"direction\"\nname = \"{name} along\"\nmarker = \"ring.{name}\"\n"
        )
    };
    for (speed, time) in [
        (5.0, ""),
        (-5.0, ""),
        // in statics the flow is steady at every load factor
        (5.0, "time = { table = { t = [0, 1], value = [0, 1] } }"),
    ] {
        let text = format!(
            r#"
            [run]
            analysis = "statics"
            [[elements]]
            type = "cable"
            name = "ring"
            curve = {curve:?}
            start_direction = [0, 1, 0]
            end_direction = [0, 1, 0]
            elements = {n}
            stress_free = "as-laid"
            section = {{ mass = 1, ea = 200, ei = 1, gj = 1 }}
            {}{}
            [[forces]]
            type = "internal_flow"
            cable = "ring"
            density = 100
            bore = 0.1
            speed = {speed}
            closed = true
            weight = false
            {time}
            [[records]]
            type = "along"
            of = "ring"
            what = "strain"
            at = "50 %"
            [[records]]
            type = "position"
            of = "ring@50%"
            "#,
            end("start", ""),
            end("end", "to = \"ring.start\""),
        );
        let history = ropewalk::simulate(&scene(&text)).unwrap_or_else(|e| panic!("{e}"));
        let last = |name: &str| history.last(name).unwrap_or_else(|| panic!("no {name}"));
        let mass = 100.0 * std::f64::consts::PI * 0.01 / 4.0;
        let strain = 1.0 / (1.0 - mass * 25.0 / 200.0) - 1.0;
        let found = last("ring@50%.strain");
        assert!((found / strain - 1.0).abs() < 1e-6, "{speed} {time}: {found}, exact {strain}");
        // opposite the point that is held
        let across = 1.0 - last("ring@50%.x");
        assert!((across / (2.0 * (1.0 + strain)) - 1.0).abs() < 1e-5, "{across}");
    }
}

/// A pipe of two sections that stretch differently, and whose nodes don't share a slope where they meet.
#[test]
fn a_flow_goes_on_over_a_splice() {
    let all = data("internal_flow.json");
    let spliced = |beta: f64, u: f64, ends: &str| {
        let whole = pipe(16, 1e6, beta, u, ends, "");
        let mut spec = serde_json::to_value(&*whole.elements[0]).expect("a spec");
        let fields = spec["cable"].as_object_mut().expect("fields");
        let mut section = fields.remove("section").expect("a section");
        let first = serde_json::json!({ "to": 0.5, "section": section });
        section["ea"] = 2e6.into();
        fields.insert("sections".into(), serde_json::json!([first, { "section": section }]));
        let mut scene = whole.clone();
        let spec: Box<dyn ropewalk_scene::ElementSpec> = serde_json::from_value(spec).expect("read again");
        scene.elements[0] = spec.into();
        scene
    };
    for (ends, name, tolerance) in
        [("clamped-clamped", "clamped-clamped", 3e-4), ("clamped-free", "cantilever", 1e-3)]
    {
        for case in all[name].as_array().expect("cases") {
            let (beta, u) = (number(&case["beta"]), number(&case["u"]));
            let exact = [0, 1].map(|i| number(&case["lambda"][0][i]));
            if exact[0] > 0.0 || exact[1] < 3.0 || u == 0.0 || u > 4.0 {
                continue;
            }
            let (found, unstable) = spectrum(&spliced(beta, u, ends), 2);
            let off = |f: &[f64; 2]| (f[0] - exact[0]).hypot(f[1] - exact[1]) / exact[0].hypot(exact[1]);
            let off = found.iter().map(off).fold(f64::INFINITY, f64::min);
            assert!(!unstable && off < tolerance, "{name}, β = {beta}, u = {u}: {off:e}, {found:?}");
        }
    }
    for (share, unstable) in [(0.999, false), (1.001, true)] {
        let u = share * std::f64::consts::TAU;
        assert_eq!(spectrum(&spliced(0.3, u, "clamped-clamped"), 2).1, unstable, "{share}");
    }
}

#[test]
fn what_no_flow_can_be_is_refused_with_a_remedy() {
    let refused = |more: &str, change: &dyn Fn(String) -> String, says: &str| {
        let text = format!(
            r#"
            [run]
            duration = 1
            output = 1
            [[inputs]]
            name = "pump"
            unit = "m/s"
            [[elements]]
            type = "cable"
            name = "pipe"
            points = [[0, 0, 0], [1, 0, 0]]
            elements = 4
            section = {{ mass = 1, ea = 100, ei = 1 }}
            [[elements]]
            type = "point_mass"
            name = "ball"
            marker = [0, 0, 1]
            mass = 1
            [[constraints]]
            type = "spherical"
            name = "hold"
            marker = "pipe.start"
            [[forces]]
            type = "internal_flow"
            cable = "pipe"
            density = 1000
            bore = 0.1
            speed = 2
            {more}
            "#
        );
        let error = SceneFile::parse(&change(text), "scene.toml", Format::Toml, &[])
            .map_err(|e| e.to_string())
            .and_then(|f| f.scene().build().map(|_| ()).map_err(|e| e.to_string()))
            .expect_err(says);
        assert!(error.contains(says), "{error}");
    };
    refused("", &|t| t.replace("speed = 2", "speed = { input = \"pump\" }"), "join");
    refused("", &|t| t.replace("cable = \"pipe\"", "cable = \"ball\""), "isn't a cable");
    refused("", &|t| t.replace("cable = \"pipe\"", "cable = \"hose\""), "no part `hose`");
    refused("", &|t| t.replace("bore = 0.1", "bore = 0"), "bore");
    refused("closed = true\nnozzle = 0.05", &|t| t, "nothing leaves");
    let again = "[[forces]]\ntype = \"internal_flow\"\ncable = \"pipe\"\ndensity = 1\nbore = 0.1\nspeed = 1";
    refused(again, &|t| t, "twice");
    let winch = "[[constraints]]\ntype = \"winch\"\nname = \"w\"\nmarker = \"pipe.start\"\nspeed = 0.1";
    refused(winch, &|t| t, "changes");
}

/// The term is public for scenes that are built in Rust.
#[test]
fn flows_are_built_in_rust() {
    let model = pipe(4, 1e3, 0.4, 1.0, "clamped-free", "").build().unwrap_or_else(|e| panic!("{e}"));
    let part = model.part("pipe").expect("pipe");
    let flow = InternalFlow::new(part.as_ref(), 0.4, ropewalk_core::Signal::Constant(1.0)).expect("a flow");
    assert_eq!((flow.nozzle, flow.closed), (1.0, false));
}
