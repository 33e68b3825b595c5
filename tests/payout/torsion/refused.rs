//! What can't be twisted.

use super::drums::DRUM;
use super::wheels::belted;
use super::{BLOCK, ringed};
use crate::reeving::refused;

#[test]
fn what_leads_a_cable_is_not_to_break() {
    let broken = |of: &str| {
        format!("[[constraints]]\ntype = \"break\"\nname = \"pin\"\nconstraint = \"{of}\"\nforce = 1000\n")
    };
    let ring = ringed(BLOCK, "[2, 1, 0.2]");
    for (text, of) in [
        (&*ring, "ring.in"),
        (&*ring, "ring"),
        (&*ring, "ring: torsion"),
        (&*ring, "wheel"),
        (DRUM, "drum.rope"),
    ] {
        let message = refused(&(text.to_string() + &broken(of)));
        assert!(message.contains("break what carries"), "{of}: {message}");
    }
}

#[test]
fn what_cannot_be_twisted_over_wheels_is_refused_with_its_reason() {
    let cases = [
        (BLOCK.replace("mass = 1.5,", "mass = 1.5, ei = [1, 2],"), "give one stiffness"),
        (BLOCK.replace("mass = 1.5,", "mass = 1.5, gyroscopic = true,"), "turns nothing aside"),
        (BLOCK.replace("gj = 30, ", ""), "a torsional stiffness, `gj`"),
        (ringed(BLOCK, "[2, 1, 0.2]") + "friction = 0.1\n", "leave `friction` out"),
        (ringed(BLOCK, "[2, 1, 0.2]").replace("ei = 2,", ""), "give it `section.ei`"),
        (ringed(BLOCK, "[5, 3, 3]"), "the cable doubles back at `ring`"),
        (DRUM.replace("gj = 5,", "gj = 5, torque_tension = 10,"), "can't be wound on a drum"),
        (belted("laid_twist = 1"), "a closed belt is joined"),
        (
            belted("").replace("{ round = \"c\" }", "{ through = \"ring\" }")
                + "[[constraints]]\ntype = \"ring\"\nname = \"ring\"\nmarker = [1, 0, -2]\n",
            "which a ring at a point can't hold",
        ),
    ];
    for (text, reason) in cases {
        let message = refused(&text);
        assert!(message.contains(reason), "{message}\nbut not: {reason}");
    }
}
