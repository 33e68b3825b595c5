//! Splices, and what a cable is without them.

use crate::{run, scene};
use ropewalk_core::Simulation;
use ropewalk_scene::{Format, SceneFile};

/// A line that swings, of a section or of several.
fn swinging(made_of: &str) -> String {
    format!(
        r#"
        run = {{ duration = 0.5, output = 0.05 }}
        [[sections]]
        name = "rope"
        mass = 0.5
        ea = 2e4
        ei = 0.5
        diameter = 0.02
        axial_retardation_time = 1e-3
        [[elements]]
        type = "cable"
        name = "line"
        points = [[0, 0, 0], [4, 0, 0]]
        elements = 8
        {made_of}
        [[constraints]]
        type = "spherical"
        name = "pin"
        marker = "line.start"
        [[forces]]
        type = "gravity"
        [[records]]
        type = "position"
        of = "line.end"
        [[records]]
        type = "along"
        of = "line"
        what = "tension"
        at = "50 %"
        name = "pull"
        "#
    )
}

#[test]
fn sections_that_stretch_alike_share_a_node() {
    let whole = run(&swinging("section = \"rope\""));
    let parts = run(&swinging("sections = [{ to = 2, section = \"rope\" }, { section = \"rope\" }]"));
    for name in ["line.end.x", "line.end.z", "pull"] {
        assert!(whole.column(name).is_some_and(|c| c.len() > 5), "{name}");
        assert_eq!(whole.column(name), parts.column(name), "{name}");
    }
    let [one, two] = ["section = \"rope\"", "sections = [{ section = \"rope\" }]"]
        .map(|made_of| scene(&swinging(made_of)).build().expect("model"));
    assert_eq!((one.velocities(), one.multipliers()), (two.velocities(), two.multipliers()));
    assert_eq!(one.multipliers(), 3);
    let labels = |m: &ropewalk_core::Model| m.terms().iter().map(|t| t.label()).collect::<Vec<_>>();
    assert_eq!(labels(&one), labels(&two));
}

#[test]
fn what_is_wrong_with_sections_is_said_where_it_stands() {
    let cases = [
        ("", "a cable needs a `section`", ""),
        ("section = \"rpoe\"", "there is no section `rpoe`", "did you mean `rope`?"),
        ("section = \"rope\"\nsections = [{ section = \"rope\" }]", "give `section` or `sections`", ""),
        ("sections = [{ section = \"rope\" }, { section = \"rope\" }]", "where does this section end?", ""),
        (
            "sections = [{ to = 3, section = \"rope\" }, { to = 2, section = \"rope\" }]",
            "section 1 would reach from 0 m to 3 m of a cable of 2 m",
            "",
        ),
        (
            "sections = [{ to = 5, section = \"rope\" }, { section = \"rope\" }]\nlength = 4",
            "section 1 would reach",
            "",
        ),
        ("sections = [{ to = 3, section = \"rope\" }]\nlength = 4", "ends at 3 m, but `length` is 4 m", ""),
        ("sections = [{ section = \"rope\", elements = 3 }]", "leave `elements` of the cable out", ""),
        ("sections = [{ section = { mass = 1, ea = 0 } }]", "`ea` must be positive", ""),
        (
            "sections = [{ section = { mass = 1, ea = 1, ei = [1, 2], gj = 1 } }]",
            "which way does the section look?",
            "",
        ),
        ("sections = [{ section = \"rope\" }]\ntension = 5", "stretch differently", ""),
    ];
    for (made_of, message, help) in cases {
        let text = swinging(made_of);
        let fault = match SceneFile::parse(&text, "x", Format::Toml, &[]) {
            Err(fault) => fault,
            Ok(file) => file.build().err().unwrap_or_else(|| panic!("{made_of}")),
        };
        assert!(fault.message.contains(message), "{made_of}: {fault}");
        assert!(fault.to_string().contains(help) && fault.place.is_some(), "{fault}");
    }
    // messages about what is in a section lead to it
    let text = swinging("sections = [{ to = 1, section = \"rope\" }, { section = { mass = 1, ea = 0 } }]");
    let fault =
        SceneFile::parse(&text, "x", Format::Toml, &[]).expect("read").build().err().expect("refused");
    assert_eq!(fault.path, "elements[0].sections[1].section.ea");
}

/// A line of two sections that falls from the horizontal and swings over to the other side.
fn falling(ea: [f64; 2], ei: [f64; 2], duration: f64) -> String {
    format!(
        r#"
        run = {{ duration = {duration}, output = 0.02 }}
        solver = {{ stepping = {{ controlled = {{ tolerance = 1e-5 }} }} }}
        [[elements]]
        type = "cable"
        name = "line"
        points = [[0, 0, 0], [2, 0, 0]]
        sections = [
            {{ to = 1.2, section = {{ mass = 0.5, ea = {}, ei = {} }}, elements = 6 }},
            {{ section = {{ mass = 0.5, ea = {}, ei = {} }}, elements = 4 }},
        ]
        [[constraints]]
        type = "spherical"
        name = "pin"
        marker = "line.start"
        [[forces]]
        type = "gravity"
        [[records]]
        type = "position"
        of = "line.end"
        "#,
        ea[0], ei[0], ea[1], ei[1]
    )
}

#[test]
fn a_splice_holds_point_and_tangent_while_the_line_turns_over() {
    for (ei, parallel) in [([2.0, 0.5], true), ([2.0, 0.0], false)] {
        let scene = scene(&falling([4e3, 400.0], ei, 2.0));
        let model = scene.build().expect("model");
        assert_eq!(model.multipliers(), if parallel { 8 } else { 6 });
        // the last node of the first section, and the first of the second
        let [a, b] = [6, 7].map(|k| model.nodes()[k].q);
        let mut s = Simulation::new(model, &scene.solver, 2.0).expect("start");
        let (mut gap, mut angle, mut least, mut stretched) = (0.0f64, 0.0f64, 1.0f64, 0.0f64);
        for k in 1..=100 {
            s.advance(0.02 * f64::from(k), f64::INFINITY, &mut ()).expect("step");
            let three = |i: usize| [0, 1, 2].map(|c| s.state.q[i + c]);
            let size = |x: [f64; 3]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
            let apart = |x: [f64; 3], y: [f64; 3]| size([0, 1, 2].map(|i| x[i] - y[i]));
            let unit = |x: [f64; 3]| x.map(|c| c / size(x));
            let (p, q) = (three(a + 3), three(b + 3));
            gap = gap.max(apart(three(a), three(b)));
            angle = angle.max(apart(unit(p), unit(q)));
            least = least.min(unit(p)[0]);
            stretched = stretched.max((size(p) - size(q)).abs());
        }
        println!(
            "gap {gap:.1e}, angle {angle:.1e}, turned to {least:.3}, stretches apart by {stretched:.1e}"
        );
        assert!(gap < 1e-7 && stretched > 1e-3 && least < -0.6);
        assert_eq!(angle < 1e-6, parallel);
        let missed = s.audit.imbalance() / s.audit.scale;
        println!("energy {missed:.1e}");
        assert!(missed.abs() < 1e-3, "{missed:e}");
    }
}

#[test]
fn a_splice_of_nearly_equal_sections_is_as_none() {
    let whole = run(&falling([1e4; 2], [0.5; 2], 1.5));
    let spliced = run(&falling([1e4, 1.0001e4], [0.5; 2], 1.5));
    for c in ["line.end.x", "line.end.z"] {
        let (a, b) = (whole.column(c).expect("column"), spliced.column(c).expect("column"));
        let apart = a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        println!("{c}: {apart:.1e}");
        assert!(apart < 1e-4, "{c}: {apart:e}");
    }
}

#[test]
fn sections_of_files_are_read_with_those_of_the_scene() {
    let folder = std::env::temp_dir().join(format!("sections-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("folder");
    let file = |name: &str, text: &str| {
        let path = folder.join(name);
        std::fs::write(&path, text).expect("written");
        path.display().to_string()
    };
    let wires = file("wires.toml", "[[sections]]\nname = \"wire\"\nmass = 2\nea = \"40 MN\"\n");
    let odd = file("odd.toml", "[[sections]]\nname = \"odd\"\nmass = 2\nea = 1\n[run]\nduration = 1\n");
    let text = |sections: &str, section: &str| {
        format!(
            "{sections}\n[[elements]]\ntype = \"cable\"\nname = \"line\"\npoints = [[0, 0, 0], [4, 0, 0]]\nelements = 4\n\
             section = {section}\n"
        )
    };
    let asks = |path: &str| format!("[[sections]]\nfile = {path:?}");
    let own = "[[sections]]\nname = \"wire\"\nmass = 1\nea = 1";
    let model = scene(&text(&asks(&wires), "\"wire\"")).build().expect("model");
    assert!((model.part("line").expect("line").mass() - 8.0).abs() < 1e-12);
    let none = folder.join("none.toml").display().to_string();
    for (sections, section, message) in [
        (asks(&wires), "\"rope\"", "there is no section `rope`"),
        (asks(&none), "\"wire\"", "there is no file"),
        (asks(&odd), "\"odd\"", "holds nothing but `[[sections]]`, not `run`"),
        (format!("{}\n{own}", asks(&wires)), "\"wire\"", "two sections named `wire`"),
        (format!("{}\nmass = 1", asks(&wires)), "\"wire\"", "a file of sections stands alone"),
        ("[[sections]]\nmass = 1".into(), "\"wire\"", "this section has no name"),
        ("[sections]\nmass = 1".into(), "\"wire\"", "`sections` is a list"),
        ("[[sections]]\nname = \"wire\"\nmass = 1\nee = 1".into(), "\"wire\"", "unknown field `ee`"),
    ] {
        let fault = SceneFile::parse(&text(&sections, section), "x", Format::Toml, &[]).err();
        let fault = fault.unwrap_or_else(|| panic!("{sections}"));
        assert!(fault.message.contains(message) && fault.place.is_some(), "{sections}: {fault}");
    }
    std::fs::remove_dir_all(&folder).expect("removed");
}
