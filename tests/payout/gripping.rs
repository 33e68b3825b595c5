//! A wheel that grips its rope while the load sinks and swings: sticking, creeping and slipping at once, on default settings,
//! against a chain of 1600 masses with contact on a real wheel (`tests/data/reeving/chain_grip.json`).

use super::reeving::{at, reference, run, values};
use crate::common::number;
use ropewalk::{SceneFile, scene::Format, simulate};

#[test]
fn a_wheel_turns_with_a_rope_whose_load_sinks_and_swings() {
    let exact = reference("chain_grip");
    let history = run(include_str!("grip.toml"));
    let columns = [
        ("rope.start.z", "m1_z", 1e-3),
        ("rope.end.x", "m2_x", 1e-3),
        ("rope.end.z", "m2_z", 1e-3),
        ("wheel.angle", "wheel_angle", 3e-3),
    ];
    for (column, name, bound) in columns {
        for (k, t) in values(&exact["t"]).into_iter().enumerate() {
            let off = at(&history, column, t) - number(&exact[name][k]);
            assert!(off.abs() <= bound, "{column}: {off} at {t} s");
        }
    }
}

/// A heavy rope with equal masses runs off to either side of its wheel: no search may take its balance for an equilibrium that
/// stays, with whatever mesh.
#[test]
fn the_balance_of_a_heavy_rope_over_a_wheel_is_never_called_stable() {
    let text = include_str!("grip.toml");
    let find = |what: &str| text.find(what).expect("a part of the scene");
    let (pull, records) = (find("[[forces]]\ntype = \"point_force\""), find("[[records]]"));
    let still = text[..pull].to_owned() + &text[records..];
    let still = still.replace("duration = 1\noutput = 0.1", "analysis = \"statics\"");
    for elements in [1, 2, 3, 4, 6, 8] {
        let text = still.replace("elements = 2", &format!("elements = {elements}"));
        let scene = SceneFile::parse(&text, "scene", Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}"));
        let error = simulate(&scene.into_scene()).err().unwrap_or_else(|| panic!("{elements}: it stays"));
        assert!(error.to_string().contains("only unstable equilibria"), "{elements}: {error}");
    }
}
