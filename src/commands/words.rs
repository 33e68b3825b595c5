//! Words of the field that are no types of scenes, and the types that stand for them.

/// Each word with what to look at, the nearest first.
const WORDS: &[(&str, &[&str])] = &[
    ("anchor", &["spherical", "clamp"]),
    ("ball-joint", &["spherical"]),
    ("bar", &["cable", "rigid_body", "distance"]),
    ("beam", &["cable"]),
    ("bend-stiffener", &["cable"]),
    ("body", &["rigid_body"]),
    ("buoy", &["point_mass", "rigid_body", "buoyancy", "free_vessel"]),
    ("chain", &["rigid_chain", "cable"]),
    ("clump", &["attachments", "point_mass"]),
    ("current", &["water"]),
    ("damper", &["spring"]),
    ("encoder", &["payout", "length"]),
    ("feeding", &["payout"]),
    ("fixed", &["weld", "clamp"]),
    ("float", &["attachments", "point_mass", "buoyancy"]),
    ("floor", &["bed", "contact"]),
    ("flow", &["internal_flow", "water"]),
    ("frame", &["rigid_body", "run", "turn"]),
    ("friction", &["contact"]),
    ("hinge", &["revolute"]),
    ("hose", &["cable", "rigid_chain"]),
    ("hull", &["rigid_body"]),
    ("joint", &["spherical", "revolute", "universal", "prismatic"]),
    ("line", &["cable"]),
    ("load", &["point_force", "line_load", "gravity"]),
    ("marker", &["position", "spherical", "rigid_body"]),
    ("moment", &["point_moment"]),
    ("mooring", &["cable", "contact"]),
    ("morison", &["drag", "added_mass", "buoyancy"]),
    ("motor", &["driving", "rotation", "winch"]),
    ("peel", &["lift_off"]),
    ("pin", &["revolute", "break"]),
    ("pipe", &["cable", "internal_flow"]),
    ("pulley", &["sheave"]),
    ("rao", &["vessel", "free_vessel"]),
    ("reeving", &["sheave", "ring", "drum", "cable"]),
    ("riser", &["cable"]),
    ("rod", &["cable", "distance"]),
    ("rope", &["cable"]),
    ("seabed", &["bed", "touchdown"]),
    ("section", &["cable"]),
    ("sensor", &["position", "reaction", "along"]),
    ("shaft", &["cable", "rigid_body"]),
    ("ship", &["vessel", "free_vessel", "driving", "rigid_body"]),
    ("slider", &["prismatic"]),
    ("spool", &["winch", "lift_off"]),
    ("stock", &["winch"]),
    ("string", &["cable"]),
    ("strumming", &["vortex_shedding"]),
    ("strut", &["distance", "rigid_body"]),
    ("swivel", &["clamp"]),
    ("tackle", &["sheave"]),
    ("tendon", &["cable"]),
    ("tension", &["along", "winch"]),
    ("tether", &["cable"]),
    ("thruster", &["point_force"]),
    ("torque", &["point_moment"]),
    ("torsion", &["cable", "point_moment", "along"]),
    ("twist", &["cable", "along"]),
    ("umbilical", &["cable"]),
    ("viv", &["vortex_shedding"]),
    ("weight", &["gravity", "point_mass"]),
    ("wheel", &["sheave"]),
    ("wind", &["air", "drag"]),
    ("wire", &["cable"]),
];

/// What some of them are called here, and where they are written.
const NOTES: &[(&str, &str)] = &[
    ("feeding", "The record `feeding` of older scenes is `payout`: `ropewalk migrate SCENE` rewrites them."),
    (
        "frame",
        "A rigid body has a frame of its own: `position` and `angles` say where it starts, and all data of the body are in \
         it. An equilibrium may be that in a moving frame: `frame = { velocity = …, omega = … }` in `[run]`.",
    ),
    (
        "marker",
        "A marker is a point that constraints, forces and records hold on to: `line.start`, `line@2.5m`, `line@50%`, \
         `body`, `body.com` or one of the `points` of a body; in most places also a position such as `[0, 0, \"-5 m\"]`.",
    ),
    (
        "mooring",
        "A mooring is a cable that hangs from a fairlead to an anchor, on a `bed`. \
         `from_equilibrium = true` in `[run]` starts it at rest: `ropewalk book mooring`.",
    ),
    ("peel", "What older scenes call `peel` is `adhesion_energy`: `ropewalk migrate SCENE` rewrites them."),
    (
        "section",
        "The cross-section of a cable is its table `section = { mass = …, ea = …, ei = … }`, or the name of one of `[[sections]]`; \
         `sections` gives it several. Sections of a scene file are `run`, `solver`, `statics`, `water` and `air`.",
    ),
    ("stock", "What older scenes call `stock` is `stored_length`: `ropewalk migrate SCENE` rewrites them."),
];

/// A word of the field as it stands in the lists: small, in the singular.
fn entry<T: Copy>(list: &'static [(&'static str, T)], word: &str) -> Option<T> {
    let word = word.trim().to_lowercase().replace([' ', '_'], "-");
    let singular = word.strip_suffix('s').unwrap_or(&word);
    list.iter().find(|(w, _)| *w == word || *w == singular).map(|(_, entry)| *entry)
}

/// What there is to say about a word of the field beyond the types that stand for it.
pub(super) fn note_on(word: &str) -> Option<&'static str> {
    entry(NOTES, word)
}

/// The types that a word of the field stands for, the nearest first; none for other words.
pub(super) fn types_for(word: &str) -> &'static [&'static str] {
    entry(WORDS, word).unwrap_or(&[])
}

#[cfg(test)]
mod tests {
    use super::*;
    use ropewalk_scene::{SECTIONS, registered};

    #[test]
    fn words_are_sorted_no_types_themselves_and_lead_to_what_there_is() {
        assert!(WORDS.is_sorted_by_key(|w| w.0));
        let types: Vec<&str> =
            registered().iter().map(|s| s.name).chain(SECTIONS.iter().map(|s| s.0)).collect();
        for (word, see) in WORDS {
            assert!(!types.contains(word), "{word} is a type");
            assert!(!see.is_empty());
            for one in *see {
                // contact is a feature
                assert!(
                    types.contains(one)
                        || (["bed", "contact"].contains(one) && cfg!(not(feature = "contact"))),
                    "{word}: no {one}"
                );
            }
        }
        assert!(NOTES.is_sorted_by_key(|n| n.0));
        assert!(NOTES.iter().all(|(word, _)| !types_for(word).is_empty()));
        assert_eq!(types_for("Moorings"), ["cable", "contact"]);
        assert!(types_for("cable").is_empty());
    }
}
