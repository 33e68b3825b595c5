//! Vibration modes against closed forms; those of strings, chains and beams are cases of the verification suite.

use ropewalk::{Modal, ModesOptions, modes};
use ropewalk_constraints::motion::{SpeedTableSpec, SpinSpec};
use ropewalk_constraints::{
    DirectionSpec, DistanceSpec, PointOnLineSpec, RevoluteSpec, RotationSpec, SphericalSpec, WeldSpec,
    WinchSpec,
};
use ropewalk_core::SteadyFrame;
use ropewalk_core::modes::Mode;
use ropewalk_elements::{CableSpec, PointMassSpec, RigidBodySpec, Section};
use ropewalk_forces::{GravitySpec, PointForceSpec, SpringSpec, TimeFunction};
use ropewalk_scene::{Analysis, Format, Scene, SceneFile};
use std::f64::consts::PI;

#[track_caller]
fn find(scene: &Scene, count: usize) -> Vec<Mode> {
    let options = ModesOptions { count, ..ModesOptions::default() };
    let found = modes(scene, &options).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(found.warnings, Vec::<String>::new());
    found.modes
}

#[track_caller]
pub(crate) fn close(what: &str, found: f64, exact: f64, tolerance: f64) {
    let off = (found / exact - 1.0).abs();
    println!("{what}: {found:.9}, exact {exact:.9}, off by {off:.1e}");
    assert!(off <= tolerance, "{what}: {found} instead of {exact}, off by {off:e}");
}

#[test]
fn steady_rotation_splits_the_frequency_of_a_mass_on_springs() {
    // seen from a frame that turns at Ω, ω becomes ω ± Ω
    let (mass, stiffness, turn) = (2.0_f64, 50.0, 3.0);
    let mut scene = Scene::new();
    scene.element(PointMassSpec::new("mass", [0.0; 3], mass));
    for (k, at) in [
        [1.0, 0.0, 0.0],
        [-1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, -1.0, 0.0],
        [0.0, 0.0, 1.0],
        [0.0, 0.0, -1.0],
    ]
    .into_iter()
    .enumerate()
    {
        scene.force(SpringSpec {
            name: format!("spring-{k}"),
            marker: "mass".into(),
            to: at.into(),
            stiffness: f64::into(stiffness),
            damping: 0.0.into(),
            length: Some(1.0.into()),
            tension_only: false,
        });
    }
    let own = (2.0 * stiffness / mass).sqrt();
    for m in find(&scene, 3) {
        close("at rest", m.omega, own, 1e-12);
    }
    scene.run.analysis = Analysis::Statics;
    scene.run.frame = Some(SteadyFrame { omega: [0.0, 0.0, turn], ..SteadyFrame::default() });
    let found: Vec<f64> = find(&scene, 3).iter().map(|m| m.omega).collect();
    for (found, exact) in found.iter().zip([own - turn, own, own + turn]) {
        close("turning", *found, exact, 1e-10);
    }
}

#[test]
fn pendulum_on_a_revolute_swings_with_its_period() {
    let (mass, arm, inertia, g) = (3.0_f64, 0.7, 0.2, 9.81);
    let mut scene = Scene::new();
    scene
        .element(
            RigidBodySpec::new("bob", [0.0, 0.0, -arm], mass, [0.1, inertia, 0.3])
                .with_point("eye", [0.0, 0.0, arm]),
        )
        .constraint(RevoluteSpec {
            name: "axle".into(),
            marker: "bob.eye".into(),
            to: None,
            axis: [0.0, 1.0, 0.0],
        })
        .force(GravitySpec::default());
    let found = modes(&scene, &ModesOptions { count: 5, ..ModesOptions::default() }).unwrap();
    assert_eq!(found.modes.len(), 1);
    assert!(found.warnings[0].contains("only one mode"), "{:?}", found.warnings);
    let exact = (mass * g * arm / (inertia + mass * arm * arm)).sqrt();
    close("pendulum", found.modes[0].omega, exact, 1e-9);
}

#[test]
fn a_support_that_only_begins_to_move_is_held() {
    // at rest at t = 0, but accelerated from then on
    let (mass, inertia, l, g) = (3.0_f64, 0.1, 2.0, 9.81);
    let text = r#"
        [run]
        duration = 3
        [[elements]]
        type = "rigid_body"
        name = "bob"
        position = [0, 0, -2]
        mass = 3
        inertia = [0.1, 0.1, 0.1]
        points = { eye = [0, 0, 2] }
        [[motions]]
        type = "table"
        name = "quake"
        t = [0, 1, 2, 3]
        x = [0, 0.1, -0.1, 0]
        join = "cubic"
        ends = "from-rest"
        [[constraints]]
        type = "driving"
        name = "pivot"
        marker = "bob.eye"
        motion = "quake"
        [[forces]]
        type = "gravity"
        "#;
    let scene = SceneFile::parse(text, "scene.toml", Format::Toml, &[])
        .unwrap_or_else(|e| panic!("{e}"))
        .into_scene();
    let found = modes(&scene, &ModesOptions { count: 3, ..ModesOptions::default() }).expect("modes").modes;
    let exact = (mass * g * l / (inertia + mass * l * l)).sqrt();
    println!("{:?}", found.iter().map(|m| m.omega).collect::<Vec<_>>());
    // it swings both ways, and spins
    assert_eq!(found.iter().filter(|m| (m.omega / exact - 1.0).abs() < 1e-6).count(), 2);
    // while it moves there is no equilibrium
    let later = ModesOptions { time: Some(0.5), ..ModesOptions::default() };
    let message = modes(&scene, &later).err().map(|e| e.to_string()).expect("refused");
    assert!(message.contains("`pivot` moves at t = 0.5 s") && message.contains("frame"), "{message}");
}

#[test]
fn damped_oscillator_has_its_ratio_and_creeps_beyond_the_critical_one() {
    let (mass, stiffness) = (2.0_f64, 72.0);
    let own = (stiffness / mass).sqrt();
    for ratio in [0.05, 0.6, 1.25] {
        let mut scene = Scene::new();
        scene.element(PointMassSpec::new("mass", [1.0, 0.0, 0.0], mass)).force(SpringSpec {
            name: "spring".into(),
            marker: "mass".into(),
            to: [0.0; 3].into(),
            stiffness: f64::into(stiffness),
            damping: (2.0 * ratio * (stiffness * mass).sqrt()).into(),
            length: Some(1.0.into()),
            tension_only: false,
        });
        let found = find_all(&scene);
        let moving: Vec<&Mode> = found.iter().filter(|m| !m.rigid).collect();
        // across the spring nothing holds it
        assert_eq!(found.len() - moving.len(), 2, "{found:?}");
        if ratio < 1.0 {
            assert_eq!(moving.len(), 1);
            close("damped frequency", moving[0].omega, own * (1.0 - ratio * ratio).sqrt(), 1e-9);
            close("damping ratio", moving[0].damping_ratio(), ratio, 1e-9);
        } else {
            let root = (ratio * ratio - 1.0).sqrt();
            for (m, rate) in moving.iter().zip([ratio - root, ratio + root]) {
                assert!(m.omega == 0.0 && m.damping_ratio() == 1.0);
                close("rate of creeping", -m.growth, own * rate, 1e-9);
            }
        }
    }
}

/// Kelvin–Voigt damping of bending: `ζ = ηω/2` in both planes, on every mesh.
#[test]
fn bending_is_damped_in_proportion_to_the_frequency() {
    let eta = 2e-4;
    for elements in [8, 16, 64] {
        let section = Section { bending_retardation_time: eta, ..Section::new(1.0, 1e7, 1.0) };
        let mut scene = Scene::new();
        scene
            .element(CableSpec::straight("beam", [0.0; 3], [1.0, 0.0, 0.0], elements, section))
            .constraint(SphericalSpec::pin("pin", "beam.start"))
            .constraint(DirectionSpec::new("clamp", "beam.start"));
        let found = find(&scene, 10);
        for (k, exact) in [3.516_015, 22.034_492, 61.697_214, 120.901_916, 199.859_530].iter().enumerate() {
            for m in &found[2 * k..2 * k + 2] {
                let own = m.omega / (1.0 - m.damping_ratio().powi(2)).sqrt();
                if elements >= 16 {
                    close("frequency", own, *exact, 1e-3);
                }
                close("damping ratio", m.damping_ratio(), 0.5 * eta * own, 1e-6);
            }
        }
    }
}

/// Beams side by side have each frequency as often as there are beams and planes, more often than a search has start vectors.
#[test]
fn damped_modes_of_several_beams_are_all_found() {
    for beams in [2_u32, 3, 4, 6] {
        let section = Section { bending_retardation_time: 2e-4, ..Section::new(1.0, 1e7, 1.0) };
        let mut scene = Scene::new();
        for k in 0..beams {
            let (name, y) = (format!("beam-{k}"), f64::from(k));
            let spec = CableSpec::straight(&name, [0.0, y, 0.0], [1.0, y, 0.0], 8, section.clone());
            scene
                .element(spec)
                .constraint(SphericalSpec::pin(&format!("pin-{k}"), format!("{name}.start").as_str()))
                .constraint(DirectionSpec::new(&format!("clamp-{k}"), format!("{name}.start").as_str()));
        }
        let each = 2 * beams as usize;
        let found = find(&scene, 2 * each);
        for (m, exact) in found.iter().zip([3.516_015, 22.034_492].map(|w| vec![w; each]).concat()) {
            let own = m.omega / (1.0 - m.damping_ratio().powi(2)).sqrt();
            close(&format!("one of {beams} beams"), own, exact, 1e-3);
        }
    }
}

fn find_all(scene: &Scene) -> Vec<Mode> {
    modes(scene, &ModesOptions::default()).unwrap_or_else(|e| panic!("{e}")).modes
}

#[test]
fn free_parts_have_their_rigid_modes_and_then_those_of_a_free_beam() {
    // a straight cable has no twist to turn about itself
    let straight = CableSpec::straight("beam", [0.0; 3], [2.0, 0.0, 0.0], 24, Section::new(1.5, 1e6, 50.0));
    let mut scene = Scene::new();
    scene.element(straight);
    let found = find(&scene, 11);
    assert_eq!(found.iter().filter(|m| m.rigid).count(), 5);
    // cos x cosh x = 1
    for (pair, root) in
        found[5..].chunks(2).zip([4.730_040_744_862_704, 7.853_204_624_095_838, 10.995_607_838_001_67_f64])
    {
        let exact = (root / 2.0).powi(2) * (50.0_f64 / 1.5).sqrt();
        for m in pair {
            close("free beam", m.omega, exact, 1e-3);
        }
    }
    scene.element(RigidBodySpec::new("stone", [5.0, 1.0, 2.0], 3.0, [0.1, 0.2, 0.25]));
    let found = find(&scene, 13);
    assert_eq!(found.iter().filter(|m| m.rigid).count(), 5 + 6);
    close(
        "beam beside a stone",
        found[11].omega,
        (4.730_040_744_862_704_f64 / 2.0).powi(2) * (50.0_f64 / 1.5).sqrt(),
        1e-3,
    );
}

#[test]
fn what_is_buckled_or_upside_down_is_called_unstable() {
    let g = 9.81;
    let mut scene = Scene::new();
    scene
        .element(
            RigidBodySpec::new("rod", [0.0, 0.0, 0.5], 1.0, [1.0 / 12.0, 1.0 / 12.0, 0.01])
                .with_point("foot", [0.0, 0.0, -0.5]),
        )
        .constraint(RevoluteSpec {
            name: "hinge".into(),
            marker: "rod.foot".into(),
            to: None,
            axis: [0.0, 1.0, 0.0],
        })
        .force(GravitySpec::default());
    let found = modes(&scene, &ModesOptions::default()).unwrap();
    close("falling rod", found.modes[0].growth, (1.5_f64 * g).sqrt(), 1e-9);
    assert!(found.modes[0].is_unstable() && found.warnings.iter().any(|w| w.contains("unstable")));

    // Euler's column, pinned at both ends: ω² = (π/L)⁴ EI/ρA (1 - P/P_E)
    let (ei, euler) = (50.0, PI * PI * 50.0);
    for load in [0.5, 1.5] {
        let mut scene = Scene::new();
        scene
            .element(CableSpec::straight("column", [0.0; 3], [0.0, 0.0, 1.0], 32, Section::new(1.5, 1e9, ei)))
            .constraint(SphericalSpec::pin("foot", "column.start"))
            .constraint(PointOnLineSpec {
                name: "head".into(),
                marker: "column.end".into(),
                to: None,
                axis: [0.0, 0.0, 1.0],
            })
            .force(PointForceSpec::new(
                "column.end",
                [0.0, 0.0, -load * euler],
                TimeFunction::table(vec![0.0, 1.0], vec![0.0, 1.0]),
            ));
        scene.run.analysis = Analysis::Statics;
        scene.statics.stable = false;
        let found = modes(&scene, &ModesOptions { count: 4, ..ModesOptions::default() }).unwrap();
        let exact = PI.powi(4) * ei / 1.5 * (1.0 - load);
        let m = &found.modes[0];
        close("column", m.omega.powi(2) - m.growth.powi(2), exact, 1e-3);
        assert_eq!(m.is_unstable(), load > 1.0);
    }
}

#[test]
fn what_has_no_modes_is_refused_with_the_reason() {
    let told =
        |scene: &Scene, options: &ModesOptions| modes(scene, options).err().expect("refused").to_string();
    let mut scene = Scene::new();
    scene
        .element(CableSpec::straight("rope", [0.0; 3], [4.0, 0.0, 0.0], 4, Section::new(0.3, 1e5, 0.1)))
        .constraint(SphericalSpec::pin("hook", "rope.start"))
        .force(GravitySpec::default());
    let options = ModesOptions { count: 0, ..ModesOptions::default() };
    assert!(told(&scene, &options).contains("at least 1"));
    let options = ModesOptions { time: Some(2.0), ..ModesOptions::default() };
    assert!(told(&scene, &options).contains("`--at` must be between 0 and 1 s"));
    let all = modes(&scene, &ModesOptions { count: 1000, ..ModesOptions::default() }).unwrap();
    assert_eq!(all.modes.len(), 27, "five nodes with six unknowns, three held");
    assert!(all.warnings[0].contains("only 27 modes"), "{:?}", all.warnings);

    // a free fall has no equilibrium
    let mut falling = Scene::new();
    falling.element(PointMassSpec::new("stone", [0.0; 3], 1.0)).force(GravitySpec::default());
    assert!(told(&falling, &ModesOptions::default()).contains("no equilibrium"));

    let mut scene = Scene::new();
    scene
        .element(RigidBodySpec::new("wheel", [0.0; 3], 1.0, [0.1; 3]))
        .constraint(RevoluteSpec {
            name: "axle".into(),
            marker: "wheel".into(),
            to: None,
            axis: [0.0, 0.0, 1.0],
        })
        .constraint(RotationSpec {
            name: "motor".into(),
            marker: "wheel".into(),
            to: None,
            axis: [0.0, 0.0, 1.0],
            motion: "spin".into(),
        })
        .motion(SpinSpec { name: "spin".into(), rate: 3.0, start: 0.0, ramp: 0.0, rise: Default::default() });
    let message = told(&scene, &ModesOptions::default());
    assert!(message.contains("`motor` moves at t = 0 s") && message.contains("frame"), "{message}");
    scene.motions.clear();
    scene.constraints.pop();
    scene.constraint(WeldSpec { name: "glue".into(), marker: "wheel".into(), to: None });
    assert!(told(&scene, &ModesOptions::default()).contains("nothing can move"));
}

#[test]
fn conical_pendulums_nod_at_their_frequency() {
    // a small change of the cone's angle: ω² = Ω² (1 + 3 cos²θ), for a slender rod too
    let (turn, g) = (5.0_f64, 9.81);
    let nod = |cos: f64| turn * (1.0 + 3.0 * cos * cos).sqrt();
    let spinning = |mut scene: Scene| {
        scene.force(GravitySpec::default());
        scene.run.analysis = Analysis::Statics;
        scene.run.frame = Some(SteadyFrame { omega: [0.0, 0.0, turn], ..SteadyFrame::default() });
        let options = ModesOptions { count: 4, ..ModesOptions::default() };
        let found = modes(&scene, &options).unwrap_or_else(|e| panic!("{e}"));
        assert!(found.search.is_none(), "as laid it rides with the frame");
        let swinging: Vec<Mode> = found.modes.into_iter().filter(|m| !m.rigid).collect();
        assert_eq!(swinging.len(), 1, "{swinging:?}");
        swinging[0].omega
    };
    let cos = g / (turn * turn);
    let sin = (1.0 - cos * cos).sqrt();
    let mut bob = Scene::new();
    bob.element(PointMassSpec::new("bob", [sin, 0.0, -cos], 2.0)).constraint(DistanceSpec {
        name: "string".into(),
        marker: "bob".into(),
        to: [0.0; 3].into(),
        length: None,
    });
    close("bob on a string", spinning(bob), nod(cos), 1e-8);

    let axial = 1e-4;
    let cos = 0.5 * g / ((1.0 / 3.0 - axial) * turn * turn);
    let sin = (1.0 - cos * cos).sqrt();
    let mut rod = Scene::new();
    let body = RigidBodySpec::new("rod", [0.5 * sin, 0.0, -0.5 * cos], 1.0, [1.0 / 12.0, 1.0 / 12.0, axial]);
    rod.element(
        RigidBodySpec { angles: [0.0, -sin.atan2(cos), 0.0], ..body }.with_point("eye", [0.0, 0.0, 0.5]),
    )
    .constraint(SphericalSpec::pin("hook", "rod.eye"));
    // its own inertia about its axis is left out of the formula
    close("rod", spinning(rod), nod(cos), 1e-3);
}

const STRING: &str = r#"
title = "A taut string"
[parameters]
n = 12
[[elements]]
type = "cable"
name = "string"
points = [[0, 0, 0], [10.01, 0, 0]]
length = 10
elements = "$n"
section = { mass = 1.5, ea = 1e6, ei = 50, axial_retardation_time = "0.1 ms" }
[[constraints]]
type = "spherical"
name = "left"
marker = "string.start"
[[constraints]]
type = "spherical"
name = "right"
marker = "string.end"
"#;

#[test]
fn program_shows_the_modes_and_leaves_tables_and_pictures() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    std::fs::write(here.join("string.toml"), STRING).unwrap();
    let said = crate::program::run(here, &["modes", "string.toml", "--count", "48", "--set", "n=8"]);
    assert_eq!(said.code, Some(0), "{said:?}");
    assert!(said.stdout.contains("8.12") && said.stdout.contains("string at"), "{}", said.stdout);
    let out = here.join("runs/string-modes");
    let table = std::fs::read_to_string(out.join("tables/modes.csv")).unwrap();
    let column =
        |name: &str| table.split('\n').next().unwrap().split(',').position(|c| c == name).expect(name);
    let (omega, ratio, x) =
        (column("angular frequency [rad/s]"), column("damping ratio [-]"), column("share.x [-]"));
    let rows: Vec<Vec<f64>> =
        table.lines().skip(1).map(|l| l.split(',').map(|x| x.parse().unwrap()).collect()).collect();
    assert_eq!(rows.len(), 48);
    // lengthwise, of every mode that the mesh resolves: ζ = η ω / 2
    for row in rows.iter().filter(|r| r[x] > 0.9).take(3) {
        let own = row[omega] / (1.0 - row[ratio] * row[ratio]).sqrt();
        close("damping ratio", row[ratio], 0.5 * 1e-4 * own, 1e-2);
    }
    // across there is nothing to first order
    assert!(rows.iter().filter(|r| r[x] < 0.1).all(|r| r[ratio].abs() < 1e-9));
    for k in [1, 2, 48] {
        let svg = std::fs::read_to_string(out.join(format!("plots/mode-{k:02}.svg"))).unwrap();
        assert!(svg.contains("equilibrium") && !svg.contains("NaN"), "{svg}");
    }
    assert!(out.join("scene.toml").exists() && out.join("manifest.json").exists());

    let loose = STRING.split("[[constraints]]").next().unwrap();
    std::fs::write(here.join("falling.toml"), format!("{loose}\n[[forces]]\ntype = \"gravity\"\n")).unwrap();
    let said = crate::program::run(here, &["modes", "falling.toml", "--quiet"]);
    assert_eq!(said.code, Some(3), "{said:?}");
    assert!(said.stderr.contains("no equilibrium") && !here.join("runs/falling-modes").exists(), "{said:?}");
    crate::program::run(here, &["modes", "string.toml", "--at", "9 s"])
        .refused(&["`--at` must be between 0 and 1 s"]);
}

#[track_caller]
pub(crate) fn modal(scene: &Scene, count: usize) -> Modal {
    modes(scene, &ModesOptions { count, ..ModesOptions::default() }).unwrap_or_else(|e| panic!("{e}"))
}

/// A string that runs at a speed through two eyelets: `ω = n π (c² - V²)/(c L)`.
#[test]
fn a_running_string_has_its_frequencies() {
    let (mass, tension, length) = (1e-3, 2.0_f64, 0.25);
    let wave = (tension / mass).sqrt();
    let steadily = |name: &str, v: f64| SpeedTableSpec {
        name: name.into(),
        direction: [1.0, 0.0, 0.0],
        file: None,
        t: vec![0.0, 1.0],
        v: vec![v; 2],
        join: ropewalk_core::Join::Linear,
    };
    let scene = |out: f64, drawn: f64, elements: usize| {
        let section = Section::new(mass, 1e4 * tension, 0.0);
        let mut scene = Scene::new();
        let string = CableSpec::straight("string", [0.0; 3], [length, 0.0, 0.0], elements, section);
        scene
            .element(CableSpec { tension: Some(tension), ..string })
            .constraint(SphericalSpec::pin("in", "string.start"))
            .constraint(SphericalSpec::pin("out", "string.end"))
            .motion(steadily("out", out))
            .motion(steadily("in", -drawn))
            .constraint(WinchSpec::motion("fed", "string.start", "out"))
            .constraint(WinchSpec::motion("drawn", "string.end", "in"));
        scene.run.analysis = Analysis::Statics;
        scene.run.duration = 1e-3;
        scene.statics.steps = 1;
        scene
    };
    for speed in [7.716_666_666_666_667, 30.0] {
        let found = modal(&scene(speed, speed, 16), 6);
        assert!(!found.unstable && found.warnings.is_empty(), "{:?}", found.warnings);
        let first = PI * (wave * wave - speed * speed) / (wave * length);
        close("running string", found.modes[0].omega, first, 1e-4);
        // up and down as well as to and fro, each with a shape of its own
        for (k, pair) in found.modes.chunks(2).enumerate() {
            let [a, b] = pair else { panic!("an odd number of modes") };
            close("in pairs", a.omega, (k + 1) as f64 * first, 2e-3);
            close("in pairs", b.omega, a.omega, 1e-8);
            let parts = |m: &Mode| [m.shape.clone(), m.quadrature.clone()];
            let dot = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>();
            let ([p, q], [r, s]) = (parts(a), parts(b));
            let common = (dot(&p, &r) + dot(&q, &s)).hypot(dot(&p, &s) - dot(&q, &r));
            let size = ((dot(&p, &p) + dot(&q, &q)) * (dot(&r, &r) + dot(&s, &s))).sqrt();
            assert!(common < 0.5 * size && a.residual.max(b.residual) < 1e-6, "{common} of {size}");
        }
        for m in found.modes.iter().filter(|m| m.omega < 3.5 * first) {
            close("running string", m.omega, (m.omega / first).round() * first, 2e-3);
            assert!(m.growth.abs() < 1e-7 * m.omega);
        }
    }
    let refused = modes(&scene(30.0, 29.0, 8), &ModesOptions::default()).err().expect("it grows").to_string();
    assert!(refused.contains("free length of `string` changes by 1 m/s"), "{refused}");
    let mut growing = scene(30.0, 30.0, 8);
    growing.constraints.pop();
    let refused = modes(&growing, &ModesOptions::default()).err().expect("it grows").to_string();
    assert!(refused.contains("feeds at one end only, at 30 m/s"), "{refused}");
}

/// What is unstable and has no other motion, and what may spin besides: `λ² = g/l` of a bob on a rod that stands upright.
#[test]
fn an_inverted_pendulum_falls_at_its_rate() {
    for hoop in [
        "",
        "[[constraints]]\ntype = \"coordinate\"\nname = \"hoop\"\nmarker = \"bob\"\ndirection = [0, 1, 0]",
    ] {
        let text = format!(
            r#"
            run = {{ analysis = "statics" }}
            [[elements]]
            type = "point_mass"
            name = "bob"
            marker = [0, 0, 2]
            mass = 3
            [[constraints]]
            type = "distance"
            name = "rod"
            marker = "bob"
            to = [0, 0, 0]
            [[forces]]
            type = "gravity"
            {hoop}
            "#
        );
        let file = SceneFile::parse(&text, "bob", Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}"));
        let found = modal(file.scene(), 4);
        let rates: Vec<f64> = found.modes.iter().filter(|m| m.is_unstable()).map(|m| m.growth).collect();
        let right = (ropewalk_scene::GRAVITY[2].abs() / 2.0).sqrt();
        assert_eq!(rates.len(), if hoop.is_empty() { 2 } else { 1 });
        assert!(rates.iter().all(|r| (r / right - 1.0).abs() < 1e-9), "{rates:?} {right}");
    }
}
