//! Loops that pop out of slack, twisted cables, with contact of the cable with itself.

use super::{last, run};

/// The scene of the gallery, with damping of twist.
fn hockle(twist: f64, elements: usize) -> ropewalk::History {
    let text = include_str!("../../models/gallery/hockle.toml")
        .replace("elements = 64", &format!("elements = {elements}"))
        .replace(
            "bending_retardation_time",
            "torsional_retardation_time = \"0.1 s\", bending_retardation_time",
        );
    assert!(text.contains("line_contact") && text.contains("torsional"));
    run(&text, &[format!("twist={twist} rad/m")])
}

/// As the loop touches itself, the end of the rope, 17 m from the origin, is moved to and fro by tens of roundings: iterations
/// that couldn't find a better place for it were called a failure, and five of eight tolerances ended there.
#[test]
fn a_driven_end_far_from_the_origin_is_met_to_what_rounding_leaves() {
    let text = include_str!("../../models/gallery/hockle.toml").replace(
        "bending_retardation_time",
        "torsional_retardation_time = \"0.1 s\", bending_retardation_time",
    );
    for solver in ["5e-5 } }", "5e-5 } }\nscheme = \"radau-iia-5\""] {
        let h = run(&text.replace("1e-4 } }", solver), &["twist=2 rad/m".to_string()]);
        let counts = h.summary().counts;
        println!("{solver}: {counts:?}");
        assert!(last(&h, "itself.normal") > 0.0 && counts.rejected < 100, "{solver}: {counts:?}");
    }
}

/// Angles between reference directors add up along the loop to more than half a turn. Where one of them was taken for
/// another by a whole turn, an element was twisted by one: 56 J.
#[test]
fn a_loop_keeps_its_balance_of_energy_as_it_closes() {
    let h = hockle(2.0, 64);
    let energy = h.summary().energy;
    println!("{energy:?}, touching over {} m", last(&h, "itself.length"));
    assert!(energy.imbalance.abs() < 2e-3 && energy.initial > 30.0, "{energy:?}");
    assert!(h.warnings.iter().all(|w| !w.contains("from nowhere")), "{:?}", h.warnings);
    let torque = h.column("rope.start.torque").expect("a torque");
    // nothing turns its ends: the twist that is laid in goes into the loop, and never comes back by a whole turn
    assert!(torque.iter().all(|m| *m > 0.5 && *m < 1.61), "{torque:?}");
}
