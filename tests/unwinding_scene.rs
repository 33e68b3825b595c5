//! A process in a scene: the bundled `unwinding-paper`, and what is wrong with others.

use ropewalk::scene::Format;
use ropewalk::{SceneFile, bundled, simulate};

fn open(overrides: &[&str]) -> SceneFile {
    let overrides: Vec<String> = overrides.iter().map(ToString::to_string).collect();
    SceneFile::open("unwinding-paper", &overrides, bundled()).unwrap()
}

#[test]
fn the_bundled_scene_unwinds() {
    let file = open(&["speed=15 kn", "duration=0.2 s", "segments=20"]);
    let history = simulate(file.scene()).unwrap();
    assert!(history.stopped_by.is_none());
    let last = |name: &str| history.last(name).unwrap();
    let speed = 15.0 * 1852.0 / 3600.0;
    assert!((last("cable.speed.drawn") / speed - 1.0).abs() < 1e-12);
    // what the scene prescribes at the eyelet
    assert!((last("cable.tension.eyelet") - (0.02 + 0.0227 * speed * speed)).abs() < 1e-9);
    assert!(last("cable.tension.lift") < last("cable.tension.eyelet"));
    // what was drawn has been peeled or has shortened the free cable
    let drawn = speed * (0.2 - 0.05);
    let free = history.column("cable.length.free").unwrap();
    assert!((last("cable.length.peeled") - drawn - (free[free.len() - 1] - free[0])).abs() < 1e-9);
    assert!(history.counts.steps >= 1000 && history.times().len() == 101);
    assert!((1.1..1.3).contains(&last("cable.drag.half")));
}

/// A bundled scene run with some parameters.
fn history(scene: &str, speed: &str, traverse: &str, more: &[&str]) -> ropewalk::History {
    let mut set = vec![format!("speed={speed}"), format!("traverse={traverse}")];
    set.extend(more.iter().map(ToString::to_string));
    let file = SceneFile::open(scene, &set, bundled()).unwrap_or_else(|e| panic!("{e}"));
    simulate(file.scene()).unwrap_or_else(|e| panic!("{scene} {set:?}: {e}"))
}

#[test]
fn predictions_at_25_knots_are_those_of_both_formulations_and_follow_the_trend() {
    let mut trend = Vec::new();
    for (traverse, more) in [("forward", "elements=16"), ("backward", "elements=24")] {
        for speed in ["15 kn", "25 kn"] {
            let elements = history("unwinding", speed, traverse, &["duration=0.3 s", more]);
            let paper = history("unwinding-paper", speed, traverse, &["duration=0.3 s"]);
            let of = |h: &ropewalk::History, name: &str| h.last(name).unwrap_or_else(|| panic!("no {name}"));
            let v = of(&paper, "cable.speed.drawn");
            let tension = [of(&elements, "eyelet.tension"), of(&paper, "cable.tension.eyelet")];
            let length = [of(&elements, "cable.length"), of(&paper, "cable.length.free")];
            let centre = |h: &ropewalk::History, x: &str, y: &str| of(h, x).hypot(of(h, y));
            let radius = [
                centre(&elements, "centre.x", "centre.y"),
                centre(&paper, "cable.centre.x", "cable.centre.y"),
            ];
            let middle = "cable.cn@50%";
            let cn = [of(&elements, middle), of(&paper, "cable.drag.half")];
            println!(
                "{speed} {traverse}: tension {tension:?}, length {length:?}, centre {radius:?}, Cn {cn:?}"
            );
            for ([a, b], scale) in [(tension, tension[1]), (length, length[1]), (radius, 0.06), (cn, cn[1])] {
                assert!((a - b).abs() < 0.01 * scale, "{speed} {traverse}: {a}, not {b}");
            }
            trend.push((traverse, v, length[0], tension[0]));
        }
    }
    // tension by the square of the speed keeps the shape, but for the drag coefficient, which still falls a little, and for
    // how far the lift-off point has walked
    for pair in trend.chunks(2) {
        let [(_, slow, short, low), (_, fast, long, high)] = pair else { panic!("pairs") };
        let similar = ((high - 0.02) / (low - 0.02)) / (fast / slow).powi(2);
        assert!((similar - 1.0).abs() < 0.01 && (long / short - 1.0).abs() < 0.03, "{trend:?}");
    }
}

#[test]
fn a_package_that_runs_empty_ends_the_run() {
    let file = open(&["layers=1", "length=2 mm", "segments=12", "duration=2 s", "step=1 ms"]);
    let history = simulate(file.scene()).unwrap();
    assert!(history.stopped_by.unwrap().contains("empty"));
    assert!(history.table.rows() > 100);
}

#[test]
fn what_is_wrong_is_said_with_its_place() {
    let scene = |of: &str| {
        format!(
            "title = \"x\"\n[run]\nduration = 0.01\n[[motions]]\ntype = \"rest\"\nname = \"draw\"\n[[processes]]\ntype = \
             \"unwound_cable\"\nname = \"c\"\nmass = 1e-3\nmotion = \"draw\"\nrule = {{ tension = {{ rest = 1 }} }}\n{of}"
        )
    };
    let package = "[processes.package]\nradius = 0.06\nlength = 0.1\ndiameter = 1e-3\norigin = [0, 0, 0.1]\n";
    let cases = [
        (scene(package), ""),
        (scene(&package.replace("radius = 0.06", "radius = -1")), "`radius` must be positive"),
        (scene(&format!("{package}pitch = 1e-4\n")), "below the diameter"),
        (scene(&format!("{package}bend_limit = 0.1\n")), "may not be bent"),
        (scene(package).replace("motion = \"draw\"", "motion = \"pull\""), "there is no motion `pull`"),
        (scene(&format!("tangent = true\n{package}")), "without bending stiffness"),
        (scene(&format!("segments = 2\n{package}")), "too few"),
        (scene(&format!("drag = {{}}\n{package}")), "[water] section"),
        (scene(&format!("step = 0\n{package}")), "`h` must be positive"),
        (
            scene(&format!(
                "{package}[[elements]]\ntype = \"point_mass\"\nname = \"m\"\nmass = 1\nat = [0, 0, 0]\n"
            )),
            "of its own",
        ),
    ];
    for (text, says) in cases {
        let built = SceneFile::parse(&text, "x", Format::Toml, &[]).and_then(|file| file.build());
        match built {
            Ok(_) => assert!(says.is_empty(), "{says}: {text}"),
            Err(fault) => {
                assert!(!says.is_empty() && fault.message.contains(says), "{says}: {fault}");
                assert!(fault.place.is_some(), "{fault}");
            }
        }
    }
}
