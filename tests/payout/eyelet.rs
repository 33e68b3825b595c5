//! Cables that feed at an eyelet: a point and a winch in one, fixed, moving or on a body.

use super::winch::{fixed, go, steadily};
use ropewalk_constraints::motion::{HarmonicSpec, StraightSpec};
use ropewalk_constraints::{DrivingSpec, EyeletSpec, SphericalSpec, WinchSpec};
use ropewalk_core::{End, Simulation};
use ropewalk_elements::{CableSpec, PointMassSpec, Section};
use ropewalk_forces::GravitySpec;
use ropewalk_scene::Scene;

/// A cable in water that hangs from a moving point, with bending stiffness, damping and drag.
fn wet() -> Scene {
    let section = Section {
        diameter: 0.02,
        axial_retardation_time: 0.01,
        bending_retardation_time: 0.01,
        ..Section::new(0.8, 1e4, 2.0)
    };
    let mut scene = Scene::new();
    scene.water = Some(ropewalk_scene::Water::default());
    scene
        .element(CableSpec::straight("rope", [0.0; 3], [0.0, 0.0, -6.0], 8, section))
        .element(PointMassSpec::new("bob", "rope.end", 3.0))
        .motion(StraightSpec {
            name: "course".into(),
            speed: 1.0,
            direction: [1.0, 0.0, 0.0],
            start: 0.0,
            ramp: 0.5,
        })
        .force(GravitySpec::default())
        .force(ropewalk_forces::BuoyancySpec::default())
        .force(ropewalk_forces::DragSpec::default());
    scene
}

/// What changes of a scene.
type Add<'a> = &'a dyn Fn(&mut Scene);

#[test]
fn an_eyelet_is_a_point_and_a_winch_in_one() {
    let feed = |w: WinchSpec| WinchSpec { name: "eyelet.feed".into(), ..w };
    let cases: [(Add<'_>, Add<'_>); 4] = [
        (&|s| _ = s.constraint(EyeletSpec::speed("eyelet", "rope.start", -0.8)), &|s| {
            s.constraint(SphericalSpec::pin("eyelet", "rope.start")).constraint(feed(WinchSpec::speed(
                "",
                "rope.start",
                -0.8,
            )));
        }),
        (
            &|s| {
                s.constraint(EyeletSpec {
                    path: Some("course".into()),
                    per_speed2: 0.5.into(),
                    damping: 2.0.into(),
                    ..EyeletSpec::tension("eyelet", "rope.start", 20.0)
                });
            },
            &|s| {
                let winch = WinchSpec::tension("", "rope.start", 20.0);
                s.constraint(DrivingSpec::new("eyelet", "rope.start", "course"))
                    .constraint(feed(WinchSpec { per_speed2: 0.5.into(), damping: 2.0.into(), ..winch }));
            },
        ),
        (
            &|s| {
                s.motion(steadily("in", 1.5)).constraint(EyeletSpec {
                    element_length: Some(0.5),
                    ..EyeletSpec::motion("eyelet", "rope.start", "in")
                });
            },
            &|s| {
                let winch = WinchSpec::motion("", "rope.start", "in");
                s.motion(steadily("in", 1.5))
                    .constraint(SphericalSpec::pin("eyelet", "rope.start"))
                    .constraint(feed(WinchSpec { element_length: Some(0.5), ..winch }));
            },
        ),
        // on a cart that runs by itself
        (
            &|s| {
                cart(s);
                s.constraint(EyeletSpec {
                    to: Some("cart".into()),
                    ..EyeletSpec::speed("eyelet", "rope.start", 0.8)
                });
            },
            &|s| {
                cart(s);
                s.constraint(SphericalSpec::new("eyelet", "rope.start", "cart"))
                    .constraint(feed(WinchSpec::speed("", "rope.start", 0.8)));
            },
        ),
    ];
    for (k, (one, two)) in cases.into_iter().enumerate() {
        let [one, two] = [one, two].map(|add| {
            let mut scene = wet();
            add(&mut scene);
            let model = scene.build().unwrap_or_else(|e| panic!("{k}: {e}"));
            let mut s = Simulation::new(model, &fixed(2e-3), 1.0).unwrap_or_else(|e| panic!("{k}: {e}"));
            go(&mut s, 1.0);
            let length = s.model.part("rope").expect("rope").length_now(&s.state.at());
            (s.state, s.audit, length)
        });
        assert!((one.2 - 6.0).abs() > 0.1, "{k}: nothing was fed, {} m", one.2);
        assert_eq!(one, two, "{k}");
    }
}

/// Something that an eyelet can be on.
fn cart(scene: &mut Scene) {
    scene
        .element(ropewalk_elements::RigidBodySpec::new("cart", [0.0; 3], 50.0, [1.0, 1.0, 1.0]))
        .constraint(DrivingSpec::new("wheels", "cart", "course"));
}

#[test]
fn what_no_eyelet_can_do_is_refused() {
    let speed = || EyeletSpec::speed("eyelet", "rope.start", -0.8);
    let tension = || EyeletSpec::tension("eyelet", "rope.start", 5.0);
    let cases: [(EyeletSpec, &str, &str); 14] = [
        (EyeletSpec { speed: None, ..speed() }, "name", "needs one of"),
        (EyeletSpec { motion: Some("course".into()), ..speed() }, "motion", "not both"),
        (
            EyeletSpec { tension: Some(5.0.into()), ..speed() },
            "tension",
            "the tension at this eyelet is a result",
        ),
        (EyeletSpec { damping: 5.0.into(), ..speed() }, "damping", "goes with `tension`"),
        (EyeletSpec { per_speed2: 5.0.into(), ..speed() }, "per_speed2", "goes with `tension`"),
        (
            EyeletSpec { to: Some([0.0; 3].into()), path: Some("course".into()), ..speed() },
            "path",
            "not both",
        ),
        (EyeletSpec { path: Some("corse".into()), ..speed() }, "path", "there is no motion `corse`"),
        (EyeletSpec { ramp: 0.0, ..speed() }, "ramp", "jump of velocity"),
        (EyeletSpec { stop: Some(0.5), ..speed() }, "stop", "before its speed has risen"),
        (EyeletSpec { element_length: Some(4.0), ..speed() }, "element_length", "less than half of that"),
        (EyeletSpec { shortest: Some(7.0), ..speed() }, "shortest", "must be less"),
        (EyeletSpec { marker: "rope@2m".into(), ..speed() }, "marker", "end of a cable"),
        (
            EyeletSpec { reference_speed: Some("corse".into()), ..tension() },
            "reference_speed",
            "there is no motion `corse`",
        ),
        (
            EyeletSpec { reference_speed: Some("in".into()), ..tension() },
            "reference_speed",
            "not defined for ever",
        ),
    ];
    for (spec, field, message) in cases {
        let mut scene = wet();
        scene.motion(steadily("in", 1.0)).constraint(spec);
        let e = scene.build().err().unwrap_or_else(|| panic!("{message}: it builds")).error;
        assert!(
            e.field.as_deref() == Some(field) && e.message.contains(message),
            "{:?} {}: not {field}, {message}",
            e.field,
            e.message
        );
    }
}

/// Energy of a cable with everything that takes or brings some, while elements are born or swallowed at an eyelet that
/// moves: the imbalance over the largest term, and how many changes of the mesh there were.
fn balance(speed: f64, h: f64) -> (f64, usize) {
    #[derive(Default)]
    struct Changes(usize);
    impl ropewalk_core::Observer for Changes {
        fn remeshed(&mut self, _: &ropewalk_core::Remeshed) {
            self.0 += 1;
        }
    }
    let mut scene = wet();
    scene
        .motion(HarmonicSpec {
            name: "heave".into(),
            amplitude: [0.3, 0.2, 0.4].map(Into::into),
            frequency: 0.5.into(),
            phase: 0.0,
            start: 0.0,
            ramp: 0.5,
        })
        .constraint(EyeletSpec {
            path: Some("heave".into()),
            element_length: Some(0.7),
            start: 0.1,
            ramp: 0.5,
            stop: Some(2.6),
            ..EyeletSpec::speed("eyelet", "rope.start", speed)
        });
    let model = scene.build().unwrap_or_else(|e| panic!("{e}"));
    let mut s = Simulation::new(model, &fixed(h), 3.5).unwrap_or_else(|e| panic!("{e}"));
    let mut changes = Changes::default();
    let end = s.advance(3.5, f64::INFINITY, &mut changes).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(end, End::Done);
    let a = &s.audit;
    let largest = [a.kinetic, a.potential, a.supplied, a.carried, a.dissipated];
    let largest = largest.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    println!("{speed} m/s, h = {h}: {:e} J of {largest} J, {} changes, {a:?}", a.imbalance(), changes.0);
    (a.imbalance().abs() / largest, changes.0)
}

#[test]
fn energy_closes_over_events_at_a_moving_eyelet() {
    for speed in [1.2, -1.2] {
        let all = [2e-3, 1e-3, 5e-4].map(|h| balance(speed, h));
        let ratios: Vec<f64> = all.windows(2).map(|w| w[0].0 / w[1].0).collect();
        assert!(all.iter().all(|(_, changes)| *changes >= 3), "{all:?}");
        assert!(all[2].0 < 1e-5, "{speed}: {all:?}");
        assert!(ratios.iter().all(|r| *r > 3.0), "{speed}: {ratios:?}");
    }
}

#[test]
fn an_eyelet_that_moves_stays_on_its_path_over_changes_of_the_mesh() {
    for speed in [1.2, -1.2] {
        let mut scene = wet();
        scene.constraint(EyeletSpec {
            path: Some("course".into()),
            element_length: Some(0.5),
            ..EyeletSpec::speed("eyelet", "rope.start", speed)
        });
        let mut s = Simulation::new(scene.build().unwrap_or_else(|e| panic!("{e}")), &fixed(2e-3), 2.0)
            .unwrap_or_else(|e| panic!("{e}"));
        go(&mut s, 2.0);
        // a ramp of 0.5 s and 1.5 s at 1 m/s
        let x = crate::common::place(&s.model, &s.state, "rope", 0.0);
        assert!((x[0] - 1.75).abs() < 1e-9 && x[2].abs() < 1e-9, "{speed}: {x:?}");
    }
}
