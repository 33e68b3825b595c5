//! Scenes and seas against the reference sets of `tests/data/sea`: made by independent Python programs, by quadrature, closed
//! forms and refined integration (`about` in each file says how).

use super::{run, scene};
use ropewalk::History;
use ropewalk_scene::{Evaluation, Jonswap, Sea, WaveComponent, WaveSampling, WaveStretching, WavesSpec};
use serde_json::Value;
use std::f64::consts::TAU;

fn read(name: &str) -> Value {
    let path = format!("{}/tests/data/sea/{name}.json", env!("CARGO_MANIFEST_DIR"));
    serde_json::from_str(&std::fs::read_to_string(path).expect("file")).expect("JSON")
}

fn number(v: &Value) -> f64 {
    v.as_f64().unwrap_or_else(|| panic!("{v} is no number"))
}

fn list(v: &Value) -> Vec<f64> {
    v.as_array().expect("a list").iter().map(number).collect()
}

fn rows<'a>(v: &'a Value, name: &str) -> &'a [Value] {
    v[name].as_array().expect("a list")
}

/// A cylinder that is held.
fn held(from: [f64; 3], to: [f64; 3], diameter: f64) -> String {
    format!(
        r#"
        [[elements]]
        type = "rigid_body"
        name = "pile"
        position = [0, 0, 0]
        mass = 100
        inertia = [10, 10, 10]
        hull = {{ from = {from:?}, to = {to:?}, diameter = {diameter} }}
        [[constraints]]
        type = "weld"
        name = "hold"
        marker = "pile"
        [[records]]
        type = "reaction"
        of = "hold"
        "#
    )
}

/// What the water does to it, at every row: force and moment about the origin.
fn load(h: &History, column: &str) -> Vec<f64> {
    h.column(&format!("hold.{column}")).expect("a column").iter().map(|x| -x).collect()
}

/// A pile in regular waves, up to the surface, with the default stretching: force and overturning moment.
#[test]
fn a_pile_in_waves_has_the_force_of_morison() {
    for case in rows(&read("morison_pile"), "cases") {
        let [h, height, period, d, cm, cd] =
            ["h", "H", "T", "D", "CM", "CD"].map(|k| number(&case["case"][k]));
        let history = rows(case, "history");
        let step = number(&history[1]["t"]) - number(&history[0]["t"]);
        let h_run = run(&format!(
            r#"
            [run]
            duration = {}
            output = {step}
            audit = false
            [water]
            density = 1025
            level = 0
            [water.waves]
            regular = {{ height = {height}, period = {period} }}
            depth = {h}
            {}
            [[forces]]
            type = "drag"
            cn = {cd}
            ct = 0
            [[forces]]
            type = "added_mass"
            ca = {}
            theory = "morison"
            "#,
            step * (history.len() - 1) as f64,
            held([0.0, 0.0, -h], [0.0, 0.0, height], d),
            cm - 1.0,
        ));
        let (force, moment) = (load(&h_run, "fx"), load(&h_run, "my"));
        let most = |name: &str| history.iter().map(|r| number(&r[name]).abs()).fold(0.0, f64::max);
        let (mut worst, mut worst_moment) = (0.0_f64, 0.0_f64);
        for (k, row) in history.iter().enumerate() {
            worst = worst.max((force[k] - number(&row["F_wheeler"])).abs() / most("F_wheeler"));
            // about the bed
            let found = moment[k] + h * force[k];
            worst_moment =
                worst_moment.max((found - number(&row["M_seabed_wheeler"])).abs() / most("M_seabed_wheeler"));
        }
        println!("pile of {d} m in {period} s: force off by {worst:.1e}, moment by {worst_moment:.1e}");
        assert!(worst < 1e-3 && worst_moment < 1e-3, "{worst:e} {worst_moment:e}");
    }
}

/// A cylinder at an angle in waves and a current, deep enough to be wet.
#[test]
fn an_inclined_cylinder_in_waves_and_current_has_the_force_of_morison() {
    for case in rows(&read("morison_inclined"), "cases") {
        let c = &case["case"];
        let [h, height, period, beta, d, ca, cn, ct] =
            ["h", "H", "T", "beta_deg", "D", "Ca", "Cn", "Ct"].map(|k| number(&c[k]));
        let ends = ["p", "q"].map(|k| <[f64; 3]>::try_from(list(&c[k])).expect("a point"));
        let history = rows(case, "history");
        let step = number(&history[1]["t"]) - number(&history[0]["t"]);
        let h_run = run(&format!(
            r#"
            [run]
            duration = {}
            output = {step}
            audit = false
            [water]
            density = 1025
            level = 0
            current = {:?}
            [water.waves]
            regular = {{ height = {height}, period = {period} }}
            direction = "{beta} deg"
            depth = {h}
            stretching = "none"
            {}
            [[forces]]
            type = "drag"
            cn = {cn}
            ct = {ct}
            [[forces]]
            type = "added_mass"
            ca = {ca}
            theory = "morison"
            "#,
            step * (history.len() - 1) as f64,
            list(&c["current"]),
            held(ends[0], ends[1], d),
        ));
        let force = ["fx", "fy", "fz"].map(|column| load(&h_run, column));
        let most = history.iter().flat_map(|r| list(&r["F"])).fold(0.0, |m: f64, f| m.max(f.abs()));
        let worst = history.iter().enumerate().fold(0.0_f64, |worst, (k, row)| {
            (0..3).fold(worst, |worst, i| worst.max((force[i][k] - list(&row["F"])[i]).abs() / most))
        });
        println!("inclined cylinder, {beta} deg: off by {worst:.1e}");
        assert!(worst < 1e-5, "{worst:e}");
    }
}

/// A metre of a cylinder on a spring in water that swings evenly: in shallow water under huge gravity waves are endlessly long.
fn swinging(case: &Value, tolerance: &str) -> (f64, f64) {
    let c = &case["case"];
    let [rho, d, ca, m, k, u, period, cd] =
        ["rho", "D", "Ca", "m", "k", "U", "T", "Cd"].map(|k| number(&c[k]));
    let (gravity, depth): (f64, f64) = (1e20, 1000.0);
    let omega = TAU / period;
    let wavenumber = omega / (gravity * depth).sqrt();
    // u = a ω/(k h) cos(k x - ω t + φ) = U sin ω t
    let height = 2.0 * u * wavenumber * depth / omega;
    let history = rows(case, "history_from_rest");
    let step = number(&history[1]["t"]);
    let h = run(&format!(
        r#"
        gravity = [0, 0, -{gravity:e}]
        [run]
        duration = {}
        output = {step}
        [solver]
        {tolerance}
        [water]
        density = {rho}
        level = {depth}
        [water.waves]
        regular = {{ height = {height:e}, period = {period}, phase = "90 deg" }}
        depth = {depth}
        [[elements]]
        type = "rigid_body"
        name = "tube"
        position = [0, 0, 0]
        mass = {m}
        inertia = [10, 10, 10]
        hull = {{ from = [0, -0.5, 0], to = [0, 0.5, 0], diameter = {d} }}
        [[constraints]]
        type = "prismatic"
        name = "guide"
        marker = "tube"
        axis = [1, 0, 0]
        [[forces]]
        type = "drag"
        cn = {cd}
        ct = 0
        [[forces]]
        type = "added_mass"
        ca = {ca}
        [[forces]]
        type = "bushing"
        name = "spring"
        marker = "tube"
        to = [0, 0, 0]
        stiffness = [{k}, 0, 0]
        [[records]]
        type = "position"
        of = "tube.com"
        [[records]]
        type = "energy"
        "#,
        number(&history[history.len() - 1]["t"]),
    ));
    let x = h.column("tube.com.x").expect("a column");
    let most = history.iter().map(|row| number(&row["x"]).abs()).fold(0.0, f64::max);
    let off = |k: usize, row: &Value| (x[k] - number(&row["x"])).abs() / most;
    let worst = history.iter().enumerate().map(|(k, row)| off(k, row)).fold(0.0, f64::max);
    let imbalance = h.last("energy.imbalance").expect("energy").abs() / (m * u * u);
    (worst, imbalance)
}

#[test]
fn a_cylinder_in_swinging_water_moves_as_in_the_reference() {
    for (k, case) in rows(&read("oscillating_flow"), "cases").iter().enumerate() {
        let (worst, imbalance) = swinging(case, "");
        println!("case {k}: off by {worst:.1e}; energy by {imbalance:.1e}");
        assert!(worst < 2e-3 && imbalance < 1e-3, "{k}: {worst:e} {imbalance:e}");
        if k == 0 {
            // as heavy as water, it goes with it
            let exact = "scheme = \"radau-iia-5\"\nstepping = { controlled = { tolerance = 1e-10 } }";
            let (refined, _) = swinging(case, exact);
            println!("refined, it goes with the water to {refined:.1e}");
            assert!(refined < 1e-9, "{refined:e}");
        }
    }
}

/// Elevation, velocity and acceleration at points, through what a scene asks.
#[test]
fn points_of_a_sea_move_as_in_the_reference() {
    let level = 3.5;
    let all = [
        ("none", WaveStretching::None),
        ("wheeler", WaveStretching::Wheeler),
        ("constant", WaveStretching::Constant),
    ];
    for (name, stretching) in all {
        for v in rows(&read("airy_points"), "seas") {
            let s = &v["sea"];
            let [a, t, phase, beta] = ["a", "T", "phase", "beta_deg"].map(|k| list(&s[k]));
            let wave = |k: usize| WaveComponent {
                amplitude: a[k],
                period: t[k],
                phase: phase[k],
                direction: Some(beta[k].to_radians()),
            };
            let spec = WavesSpec {
                components: (0..a.len()).map(wave).collect(),
                depth: Some(number(&s["h"])),
                ramp: s["ramp"].as_f64().unwrap_or(0.0),
                stretching,
                ..WavesSpec::default()
            };
            let sea = Sea::new(&spec, level, 9.81, [0.0; 3]).expect("a sea");
            // above the surface there is no water
            let wet = |p: &&Value| !p[name].is_null() && number(&p["z"]) <= number(&p["eta"]);
            for p in rows(v, "points").iter().filter(wet) {
                let [x, y, z, t] = ["x", "y", "z", "t"].map(|k| number(&p[k]));
                let found = sea.at(t, &[x, y, z + level]);
                assert!((found.top.elevation - number(&p["eta"])).abs() < 1e-12);
                for i in 0..3 {
                    assert!((found.u[i] - list(&p[name]["u"])[i]).abs() < 1e-12);
                    assert!((found.acceleration[i] - list(&p[name]["du_dt"])[i]).abs() < 1e-12);
                }
            }
        }
    }
}

/// The seas of three seeds: elevations, exact and from the lattice.
#[test]
fn seeds_make_the_seas_of_the_reference() {
    for case in rows(&read("irregular_seas"), "cases") {
        let [hs, tp, gamma, seed, n, h] = ["Hs", "Tp", "gamma", "seed", "n", "h"].map(|k| number(&case[k]));
        let jitter = case["kind"] == "jitter";
        let spec = |evaluation| WavesSpec {
            jonswap: Some(Jonswap { hs, tp, gamma }),
            count: n as usize,
            seed: seed as u64,
            sampling: if jitter { WaveSampling::Jitter } else { WaveSampling::EqualEnergy },
            depth: Some(h),
            evaluation,
            ..WavesSpec::default()
        };
        for (evaluation, near) in [(Some(Evaluation::Exact), 1e-10), (None, 1e-3 * hs)] {
            let sea = Sea::new(&spec(evaluation), 0.0, 9.81, [0.0; 3]).expect("a sea");
            let eta = |x: f64, y: f64, t: f64| sea.at(t, &[x, y, -h]).top.elevation;
            for row in rows(case, "eta_x0") {
                let off = eta(0.0, 0.0, number(&row["t"])) - number(&row["eta"]);
                assert!(off.abs() < near, "{} {off:e}", sea.about());
            }
            let off = eta(50.0, 20.0, 100.0) - number(&case["eta_x50_y20_t100"]);
            assert!(off.abs() < near, "{off:e}");
        }
        assert!((hs / 4.0).powi(2) - number(&case["m0_components"]) < 1e-12);
    }
    // the model knows which it took
    let notes =
        scene("[run]\nduration = 1\n[water]\nlevel = 0\n[water.waves]\njonswap = { hs = 2, tp = 8 }\n");
    let sea = notes.scene().water.as_ref().and_then(|w| w.raised(notes.scene().gravity).ok().flatten());
    assert!(sea.is_some_and(|sea| sea.about().starts_with("waves: 200 of ")));
}

/// Seas that are asked by turns, and by several threads at once, answer as one that is alone.
#[test]
fn seas_do_not_get_in_each_others_way() {
    let sea = |seed| {
        let jonswap = Some(Jonswap { hs: 3.0, tp: 9.0, gamma: 3.3 });
        let spec = WavesSpec { jonswap, seed, depth: Some(80.0), ..WavesSpec::default() };
        Sea::new(&spec, 0.0, 9.81, [0.0; 3]).expect("a sea")
    };
    let ask = |sea: &Sea, k: u32| {
        let k = f64::from(k);
        let swell = sea.at(0.7 * k, &[3.0 * k, -k, -2.0 - 0.3 * k]);
        [swell.u, swell.acceleration, [swell.top.elevation, swell.top.slope[0], swell.top.rising]]
    };
    let seeds = [1, 2, 3];
    let alone = seeds.map(|seed| {
        let sea = sea(seed);
        (0..40).map(|k| ask(&sea, k)).collect::<Vec<_>>()
    });
    let seas = seeds.map(sea);
    let by_turns = || {
        for k in 0..40 {
            for (sea, alone) in seas.iter().zip(&alone) {
                assert_eq!(ask(sea, k), alone[k as usize]);
            }
        }
    };
    std::thread::scope(|scope| (0..3).for_each(|_| drop(scope.spawn(by_turns))));
    by_turns();
    assert_ne!(alone[0], alone[1]);
}
