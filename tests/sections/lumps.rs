//! Clump weights and floats at regular places.

use crate::{last, run, scene};
use ropewalk_scene::{Format, SceneFile};

fn line(lumps: &str) -> String {
    format!(
        r#"
        run = {{ analysis = "statics" }}
        water = {{ density = 1000 }}
        [[elements]]
        type = "cable"
        name = "line"
        points = [[0, 0, 0], [20, 0, 0]]
        length = 24
        elements = 24
        section = {{ mass = 0.5, ea = 1e6 }}
        {lumps}
        [[constraints]]
        type = "spherical"
        name = "a"
        marker = "line.start"
        [[constraints]]
        type = "spherical"
        name = "b"
        marker = "line.end"
        [[forces]]
        type = "gravity"
        [[forces]]
        type = "buoyancy"
        on = [ON]
        [[records]]
        type = "reaction"
        of = "a"
        [[records]]
        type = "position"
        of = "line@6.5"
        name = "p"
        "#
    )
}

#[test]
fn lumps_at_a_spacing_are_as_point_masses_one_by_one() {
    let many = "[[elements]]\ntype = \"attachments\"\nname = \"clump\"\non = \"line\"\nat = 2.5\nspacing = 4\ncount = 3\nmass = 5\nvolume = \
                0.002\n";
    let each = |k: usize, s: f64| {
        format!(
            "[[elements]]\ntype = \"point_mass\"\nname = \"clump{k}\"\nmarker = \"line@{s}\"\nmass = 5\nvolume = 0.002\n"
        )
    };
    let singly = each(1, 2.5) + &each(2, 6.5) + &each(3, 10.5);
    let on = "\"clump1\", \"clump2\", \"clump3\"";
    let [many, singly] = [many, &singly].map(|lumps| run(&line(lumps).replace("ON", on)));
    for c in ["a.fx", "a.fz", "p.x", "p.z"] {
        assert_eq!(last(&many, c), last(&singly, c), "{c}");
    }
    // both ends carry what there is, less what it displaces
    let model = scene(&line("").replace("[[forces]]\n        type = \"buoyancy\"\n        on = [ON]", ""));
    assert!(model.build().is_ok());
    let weight = 9.81 * (0.5 * 24.0 + 3.0 * (5.0 - 2.0));
    assert!(last(&many, "a.fz").abs() < weight && last(&many, "a.fz").abs() > 0.4 * weight);
}

#[test]
fn lumps_that_are_nowhere_are_refused() {
    let cases = [
        ("on = \"lime\"\nat = 1", "there is no part `lime`"),
        ("on = \"line\"\nat = 25", "the last of them would be at 25 m"),
        ("on = \"line\"\nat = 1\nspacing = 5\ncount = 9", "the last of them would be at 41 m"),
        ("on = \"line\"\nat = 1\ncount = 2", "`spacing` must be positive"),
        ("on = \"line\"\nat = 1\ncount = 0", "`count` must be between"),
        ("on = \"line\"\nat = -1", "`at` must not be negative"),
        ("on = \"line\"\nat = 1\nadded_mass = -1", "`added_mass` must not be negative"),
    ];
    for (fields, message) in cases {
        let lumps = format!("[[elements]]\ntype = \"attachments\"\nname = \"c\"\nmass = 1\n{fields}\n");
        let text = line(&lumps).replace("[[forces]]\n        type = \"buoyancy\"\n        on = [ON]", "");
        let fault = SceneFile::parse(&text, "x", Format::Toml, &[]).expect("read").build().err();
        let fault = fault.unwrap_or_else(|| panic!("{fields}"));
        assert!(fault.message.contains(message) && fault.place.is_some(), "{fields}: {fault}");
    }
}
