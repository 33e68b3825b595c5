//! Words of the field that are no types of scenes, and the types that stand for them.

/// Each word with what to look at, the nearest first.
const WORDS: &[(&str, &[&str])] = &[
    ("anchor", &["spherical", "clamp"]),
    ("ball-joint", &["spherical"]),
    ("bar", &["cable", "rigid_body", "distance"]),
    ("beam", &["cable"]),
    ("bed", &["contact"]),
    ("bend-stiffener", &["cable"]),
    ("body", &["rigid_body"]),
    ("buoy", &["point_mass", "rigid_body", "buoyancy"]),
    ("chain", &["rigid_chain", "cable"]),
    ("clump", &["point_mass"]),
    ("current", &["water"]),
    ("damper", &["spring"]),
    ("drum", &["winch", "contact"]),
    ("encoder", &["payout", "length"]),
    ("fixed", &["weld", "clamp"]),
    ("float", &["point_mass", "buoyancy"]),
    ("floor", &["contact"]),
    ("frame", &["straight", "circle", "turn"]),
    ("friction", &["contact"]),
    ("hinge", &["revolute"]),
    ("hose", &["cable", "rigid_chain"]),
    ("hull", &["rigid_body"]),
    ("joint", &["spherical", "revolute", "universal", "prismatic"]),
    ("line", &["cable"]),
    ("load", &["point_force", "line_load", "gravity"]),
    ("marker", &["position"]),
    ("moment", &["point_moment"]),
    ("mooring", &["cable", "contact"]),
    ("morison", &["drag", "added_mass", "buoyancy"]),
    ("motor", &["driving", "rotation", "winch"]),
    ("pin", &["revolute", "break"]),
    ("pipe", &["cable"]),
    ("riser", &["cable"]),
    ("rod", &["cable", "distance"]),
    ("rope", &["cable"]),
    ("seabed", &["contact"]),
    ("section", &["cable"]),
    ("sensor", &["position", "reaction", "along"]),
    ("sheave", &["contact", "eyelet"]),
    ("ship", &["driving", "rigid_body"]),
    ("slider", &["prismatic"]),
    ("spool", &["winch", "lift_off"]),
    ("string", &["cable"]),
    ("strut", &["distance", "rigid_body"]),
    ("tendon", &["cable"]),
    ("tension", &["along", "winch"]),
    ("tether", &["cable"]),
    ("thruster", &["point_force"]),
    ("torque", &["point_moment"]),
    ("umbilical", &["cable"]),
    ("vessel", &["driving", "rigid_body"]),
    ("weight", &["gravity", "point_mass"]),
    ("wind", &["air", "drag"]),
    ("wire", &["cable"]),
];

/// The types that a word of the field stands for, the nearest first; none for other words.
pub(super) fn types_for(word: &str) -> &'static [&'static str] {
    let word = word.trim().to_lowercase().replace([' ', '_'], "-");
    let singular = word.strip_suffix('s').unwrap_or(&word);
    WORDS.iter().find(|(w, _)| *w == word || *w == singular).map_or(&[], |(_, types)| types)
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
                    types.contains(one) || (*one == "contact" && cfg!(not(feature = "contact"))),
                    "{word}: no {one}"
                );
            }
        }
        assert_eq!(types_for("Moorings"), ["cable", "contact"]);
        assert!(types_for("cable").is_empty());
    }
}
