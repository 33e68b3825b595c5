use crate::document::{Format, Migrated, migrate};

fn toml(text: &str) -> Migrated {
    migrate(text, "old.toml", Format::Toml).unwrap_or_else(|e| panic!("{e}"))
}

fn lines(m: &Migrated) -> Vec<String> {
    m.changes.iter().map(|c| format!("{} {} -> {}", c.line, c.was, c.now)).collect()
}

/// Some of everything that version 0.1 called otherwise.
const OLD: &str = r##"# a winch
title = "old" # here
[parameters]
kind = "feeding"
eta = { default = "1 ms", description = "slip, pace and stock" }
ring = { default = { choose = "$eta", "1 ms" = { kelvin_voigt = { time = "$eta" } }, otherwise = "none" } }

[[elements]]
type = "cable"
name  =  "hose"   # two spaces
section = { mass = 1, 'axial_damping' = "$eta", bending_damping = "1 ms" }
[[elements]]
type = "point_mass"
name = "at"
at = "hose.end"

[[constraints]]
name = "root"
marker = "hose.end"
type = 'clamp'
[[constraints]]
type = "spherical"
marker = "hose.end"
[[constraints]]
type = "winch"
pace = "pace"
stock = 3
slip = 1
element.unit = 4
[[constraints]]
type = "lift_off"
package.bend_limit = 3
peel = 0.1

[[forces]]
type = "gravity"
g = [0, 0, -1.62] # on the moon
[[forces]]
type = "contact"
damping = "$ring"

[[records]]
type = "$kind"
of = "hose.start"
[[records]]
type = "feeding"
of = "hose.end"
name = "off"

[[run.tables]]
name = "winch"
columns = ["hose.start.fed", "off.speed", "off.pull", "hose.speed"]
"##;

const NEW: &str = r##"# a winch
title = "old" # here
gravity = [0, 0, -1.62]
[parameters]
kind = "payout"
eta = { default = "1 ms", description = "slip, pace and stock" }
ring = { default = { choose = "$eta", "1 ms" = { kelvin_voigt = { retardation_time = "$eta" } }, otherwise = "none" } }

[[elements]]
type = "cable"
name  =  "hose"   # two spaces
section = { mass = 1, 'axial_retardation_time' = "$eta", bending_retardation_time = "1 ms" }
[[elements]]
type = "point_mass"
name = "at"
marker = "hose.end"

[[constraints]]
name = "root"
marker = "hose.end"
type = 'direction'
[[constraints]]
type = "spherical"
marker = "hose.end"
[[constraints]]
type = "winch"
reference_speed = "pace"
stored_length = 3
slip_speed = 1
element_length.unit = 4
[[constraints]]
type = "lift_off"
package.min_bend_radius = 3
adhesion_energy = 0.1

[[forces]]
type = "gravity"
# on the moon
[[forces]]
type = "contact"
damping = "$ring"

[[records]]
type = "$kind"
of = "hose.start"
[[records]]
type = "payout"
of = "hose.end"
name = "off"

[[run.tables]]
name = "winch"
columns = ["hose.start.payout", "off.payout_rate", "off.pull", "hose.speed"]
"##;

#[test]
fn names_change_and_nothing_else_does() {
    let m = toml(OLD);
    assert_eq!(m.text, NEW);
    assert_eq!(m.left, []);
    assert!(lines(&m).contains(&"26 pace -> reference_speed".to_string()), "{:?}", lines(&m));
    assert!(lines(&m).contains(&"4 feeding -> payout".to_string()), "{:?}", lines(&m));
    let again = toml(NEW);
    assert_eq!((again.text.as_str(), again.changes.len()), (NEW, 0));
    // ends of lines and an editor's mark stay as well
    let (old, new) = (OLD.replace('\n', "\r\n"), NEW.replace('\n', "\r\n"));
    assert_eq!(toml(&format!("\u{feff}{old}")).text, format!("\u{feff}{new}"));
}

#[test]
fn json_keeps_its_layout() {
    let old = r#"{
  "title": "x",
  "forces": [ {"type": "gravity", "g": [0, 0, -1]}, {"g": [0, 0, -1], "type": "buoyancy"} ],
  "motions": [{"type": "sum", "name": "of", "of": ["a"]}],
  "processes": [{"type": "unwound_cable", "gravity": [0, 0, -1], "rule": {"peel": {"energy": 1, "start": 2}},
    "segments": 3}, {"type": "unwound_cable", "rule": {"type": "peel", "energy": 1}}]
}"#;
    let new = r#"{
  "title": "x",
  "gravity": [0, 0, -1],
  "forces": [ {"type": "gravity"}, {"type": "buoyancy"} ],
  "motions": [{"type": "sum", "name": "of", "motions": ["a"]}],
  "processes": [{"type": "unwound_cable", "weight": true, "rule": {"adhesion": {"adhesion_energy": 1, "tension": 2}},
    "elements": 3}, {"type": "unwound_cable", "rule": {"type": "adhesion", "adhesion_energy": 1}}]
}"#;
    let m = migrate(old, "old.json", Format::Json).unwrap();
    assert_eq!(m.text, new);
    assert_eq!(migrate(new, "new.json", Format::Json).unwrap().text, new);
}

#[test]
fn what_is_not_certain_is_left_and_told() {
    // two gravities, and one that is silent
    for forces in [
        "[[forces]]\ntype = \"gravity\"\ng = [0, 0, -1]\n[[forces]]\ntype = \"buoyancy\"\ng = [0, 0, -2]\n",
        "[[forces]]\ntype = \"gravity\"\ng = [0, 0, -1]\n[[forces]]\ntype = \"buoyancy\"\n",
        "gravity = [0, 0, -3]\n[[forces]]\ntype = \"gravity\"\ng = [0, 0, -1]\n",
    ] {
        let m = toml(forces);
        assert_eq!(m.text, forces);
        assert!(m.left[0].message.contains("don't all give the same"), "{}", m.left[0]);
    }
    // a clamp of today stays one; in a scene of yesterday it is named
    let clamp = "[[constraints]]\ntype = \"clamp\"\nmarker = \"a.end\"\n";
    assert_eq!(toml(clamp).left, []);
    let old = format!("{clamp}[[records]]\ntype = \"feeding\"\nof = \"a.end\"\n");
    let m = toml(&old);
    assert!(m.text.contains("\"clamp\"") && m.text.contains("\"payout\""), "{}", m.text);
    assert!(m.left[0].help.as_deref().is_some_and(|h| h.contains("write `direction`")), "{:?}", m.left);
    let gone = "[[forces]]\ntype = \"contact\"\nper_element = 3\n";
    assert!(toml(gone).left[0].message.contains("is gone"));
    // dotted keys of a table that has another name
    let pieces = "[[processes]]\ntype = \"unwound_cable\"\nrule.peel.energy = 1\nrule.peel.start = 2\n";
    let fault = migrate(pieces, "old.toml", Format::Toml).unwrap_err();
    assert!(fault.message.contains("can't be rewritten with certainty"), "{fault}");
    assert!(migrate("a = ", "old.toml", Format::Toml).is_err());
    assert!(migrate("[1]", "old.json", Format::Json).is_err());
}

#[test]
fn clamps_of_version_0_1_are_known_by_what_holds_their_position() {
    let scene = |to: &str, other: &str| {
        format!("constraints = [{{ type = \"clamp\", marker = \"c.end\"{to} }}, {{ {other} }}]\n")
    };
    for (to, other, old) in [
        ("", "type = \"driving\", marker = \"c.end\"", true),
        ("", "type = \"coordinate\", marker = \"c.end\"", true),
        ("", "type = \"spherical\", marker = \"c.start\"", false),
        ("", "type = \"winch\", marker = \"c.end\"", false),
        ("", "type = \"spherical\", marker = \"bob\", to = \"c.end\"", false),
        (", to = \"bob\"", "type = \"spherical\", marker = \"bob.eye\", to = \"c.end\"", true),
    ] {
        assert_eq!(toml(&scene(to, other)).text.contains("direction"), old, "{to} {other}");
    }
}
