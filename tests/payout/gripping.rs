//! A wheel that grips its rope while the load sinks and swings: sticking, creeping and slipping at once, on default settings,
//! against a chain of 1600 masses with contact on a real wheel (`tests/data/reeving/chain_grip.json`).

use super::reeving::{at, reference, run, values};
use crate::common::number;

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
