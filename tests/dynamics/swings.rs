//! What goes to and fro with a period: the tensions that answer to it are right to `force_tolerance`, part of their swing. And
//! what comes in a table: long and short steps in turn make nothing of their own.

use super::tolerance::umbilical;
use ropewalk::core::integrator::StepReport;
use ropewalk::core::{Model, Observer, State};
use ropewalk::scene::Format;
use ropewalk::{History, SceneFile, Watch, simulate, start};
use ropewalk_core::BuildError;
use ropewalk_scene::functions::{
    Displaced, Function, Parameters, Reads, Trouble, Written, register_function,
};
use std::f64::consts::{PI, TAU};
use std::fmt::Write;
use std::ops::ControlFlow;
use std::sync::Arc;

const HEAVE: &str = r#"type = "harmonic"
        name = "heave"
        amplitude = [0, 0, 2]
        frequency = 0.1
"#;
/// The harmonic rises in so long [s].
const RAMP: f64 = 5.0;

fn run(name: &str, text: &str) -> History {
    let file =
        SceneFile::parse(text, name, Format::Toml, &[]).unwrap_or_else(|e| panic!("{name}: {e}\n{text}"));
    simulate(file.scene()).unwrap_or_else(|e| panic!("{name}: {e}"))
}

/// What 1.26 m/s of heave make the tension at the top of 10 km of umbilical swing by, about 168 kN of its weight: `√(EA μ) v` [N].
fn swing() -> f64 {
    (2e7_f64 * 3.0).sqrt() * TAU * 0.1 * 2.0
}

/// That tension, with a heave and a solver.
fn tension(heave: &str, solver: &str) -> Vec<f64> {
    let scene = umbilical();
    assert!(scene.contains(HEAVE));
    let text =
        format!("[run]\nduration = 60\noutput = 0.2\n[solver]\n{solver}\n{}", scene.replace(HEAVE, heave));
    run("umbilical", &text).column("u.start.tension").expect("tension").to_vec()
}

/// By how much two tensions differ at most, in parts of the swing. A NaN counts as the most.
fn apart(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(a, b)| (a - b).abs() / swing()).fold(0.0, |m, x| if x <= m { m } else { x })
}

fn exact(heave: &str) -> Vec<f64> {
    tension(heave, "scheme = \"radau-iia-5\"\nstepping = { controlled = { tolerance = 1e-8 } }")
}

#[test]
fn an_umbilical_that_heaves_swings_as_it_should() {
    let exact = exact(HEAVE);
    for (asked, most, solver) in [
        (1e-2, 1.0, ""),
        (1e-2, 1.0, "stepping = { controlled = { tolerance = 1e-3 } }"),
        (1e-3, 3.0, "force_tolerance = 1e-3"),
    ] {
        let off = apart(&tension(HEAVE, solver), &exact);
        println!("{solver}: {off:.2e} of the swing");
        // no more, and not next to nothing
        assert!(
            off < most * asked && off > 0.1 * asked,
            "{solver}: off by {off:e} of the swing, {asked} asked"
        );
    }
}

/// How far the heave has risen.
fn risen(t: f64) -> f64 {
    let u = (t / RAMP).min(1.0);
    u * u * u * (10.0 - 15.0 * u + 6.0 * u * u)
}

/// The same heave as a table with four rows a second.
fn table(join: &str) -> String {
    let (mut times, mut heights) = (String::new(), String::new());
    for k in 0..=240 {
        let t = 0.25 * f64::from(k);
        write!(times, "{t}, ").expect("a string");
        write!(heights, "{:.9}, ", 2.0 * risen(t) * (TAU * 0.1 * t).sin()).expect("a string");
    }
    format!("type = \"table\"\nname = \"heave\"\njoin = \"{join}\"\nt = [{times}]\nz = [{heights}]\n")
}

#[test]
fn the_same_heave_from_a_table_swings_alike() {
    let heave = table("cubic");
    let exact = exact(&heave);
    // with Radau steps follow the tolerance of positions alone
    for (most, solver) in [(1e-2, ""), (3e-2, "scheme = \"radau-iia-5\"")] {
        let off = apart(&tension(&heave, solver), &exact);
        println!("{solver}: {off:.2e} of the swing");
        assert!(off < most, "{solver}: off by {off:e} of the swing");
    }
}

/// The same heave as a program writes it, which knows nothing but where it is.
#[derive(Clone, Debug)]
struct Heave;

impl Function for Heave {
    fn reads(&self) -> Reads {
        Reads::default()
    }
    fn motion(&self, t: f64) -> Result<Displaced, Trouble> {
        Ok(([0.0, 0.0, 2.0 * risen(t) * (TAU * 0.1 * t).sin()], [None; 2]))
    }
}

impl Written for Heave {
    fn bind(&self, _: &Parameters) -> Result<Arc<dyn Function>, BuildError> {
        Ok(Arc::new(self.clone()))
    }
}

#[test]
fn the_same_heave_from_a_function_swings_alike() {
    register_function("heaves", Arc::new(Heave));
    let heave = "type = \"function\"\nname = \"heave\"\nfunction = \"heaves\"\n";
    let off = apart(&tension(heave, ""), &exact(HEAVE));
    println!("{off:.2e} of the swing");
    assert!(off < 1e-2, "off by {off:e} of the swing");
}

/// Between rows 0.25 s apart, at which the acceleration jumps, steps of 0.1 s went 0.1, 0.025, 0.1, 0.025 s: tensions swung by five
/// times their swing with generalized-alpha; Radau, with steps that leapt over rows, made as much of it as all of the swing.
#[test]
fn a_table_with_kinks_makes_no_swing_of_its_own() {
    let heave = table("monotone");
    let exact = exact(&heave);
    for (most, solver) in [(0.1, ""), (0.05, "h_max = 0.1"), (0.05, "scheme = \"radau-iia-5\"")] {
        let off = apart(&tension(&heave, solver), &exact);
        println!("{solver}: {off:.2e} of the swing");
        assert!(off < most, "{solver}: off by {off:e} of the swing");
    }
}

/// The longest step [s].
struct Longest(f64);

impl Observer for Longest {
    fn step(&mut self, _: &Model, _: &State, report: &StepReport) -> ControlFlow<()> {
        self.0 = self.0.max(report.h);
        ControlFlow::Continue(())
    }
}

/// Whatever brings a period of 2 s into a scene, for ten of them.
#[test]
fn every_period_has_its_steps() {
    let held = "[[constraints]]\ntype = \"clamp\"\nname = \"held\"\nmarker = \"c.start\"\n";
    let time = "time = { harmonic = { mean = 0, amplitude = 1, frequency = 0.5, phase = 0 } }\n";
    let sea = "[water]\ndensity = 1000\nlevel = 0\nwaves = { regular = { height = 0.1, period = 2 }, depth = 100, ramp = 2 }\n";
    let motion = "[[motions]]\ntype = \"harmonic\"\nname = \"m\"\namplitude = [0.1, 0, 0]\nfrequency = 0.5\n";
    let rao = "heading = 0\n[constraints.rao]\nheadings = [0]\nomegas = [3]\namplitude = [[[1, 0, 1, 0, 0, 0]]]\nlag = [[[90, 0, 0, 0, 0, 0]]]\n";
    let body = "[[elements]]\ntype = \"rigid_body\"\nname = \"b\"\nposition = [0, 0, 0]\nmass = 100\ninertia = [9, 9, 9]\n";
    let force = |kind: &str, of: &str| format!("{held}[[forces]]\ntype = \"{kind}\"\n{of}\n");
    let driven = |of: &str, name: &str| {
        format!(
            "{of}[[constraints]]\ntype = \"driving\"\nname = \"top\"\nmarker = \"c.start\"\nmotion = \"{name}\"\n"
        )
    };
    let table: Vec<[f64; 2]> =
        (0..=134).map(|k| 0.15 * f64::from(k)).map(|t| [t, 0.1 - 0.1 * (PI * t).cos()]).collect();
    let [t, x] =
        [0, 1].map(|c| table.iter().map(|row| format!("{:.9}", row[c])).collect::<Vec<_>>().join(", "));
    let all = [
        ("force", force("point_force", &format!("marker = \"c.end\"\nforce = [0, 0, 1]\n{time}"))),
        ("moment", force("point_moment", &format!("marker = \"c.end\"\nmoment = [0, 1, 0]\n{time}"))),
        ("line load", force("line_load", &format!("force = [0, 0, 1]\n{time}"))),
        ("motion", driven(motion, "m")),
        (
            "sum",
            driven(&format!("{motion}[[motions]]\ntype = \"sum\"\nname = \"s\"\nmotions = [\"m\"]\n"), "s"),
        ),
        (
            "table",
            driven(
                &format!(
                    "[[motions]]\ntype = \"table\"\nname = \"t\"\nt = [{t}]\nx = [{x}]\njoin = \"cubic\"\n"
                ),
                "t",
            ),
        ),
        (
            "speeds",
            driven(
                &format!(
                    "[[motions]]\ntype = \"speed_table\"\nname = \"t\"\ndirection = [1, 0, 0]\nt = [{t}]\nv = [{x}]\njoin = \"cubic\"\n"
                ),
                "t",
            ),
        ),
        (
            "internal flow",
            force(
                "internal_flow",
                &format!("cable = \"c\"\ndensity = 1000\nbore = 0.02\nspeed = 0.1\n{time}"),
            ),
        ),
        ("drag in waves", format!("{sea}{}", force("drag", ""))),
        ("added mass in waves", format!("{sea}{}", force("added_mass", ""))),
        ("buoyancy in waves", format!("{sea}{}", force("buoyancy", ""))),
        (
            "vessel",
            format!(
                "{sea}{body}{held}[[constraints]]\ntype = \"vessel\"\nname = \"v\"\nmarker = \"b\"\n{rao}"
            ),
        ),
        (
            "input",
            driven(
                "[[inputs]]\nname = \"f\"\nunit = \"Hz\"\ndefault = 0.5\njoin = \"smooth\"\n[[motions]]\ntype = \"harmonic\"\nname = \"m\"\namplitude = [0.1, 0, 0]\nfrequency = { input = \"f\" }\n",
                "m",
            ),
        ),
        (
            "winch",
            format!(
                "{motion}{held}[[constraints]]\ntype = \"winch\"\nname = \"w\"\nmarker = \"c.start\"\nmotion = \"m\"\n"
            ),
        ),
    ];
    for (name, of) in all {
        let longest = |scheme: &str| {
            let text = format!(
                r#"
                run = {{ duration = 20, output = 1 }}
                solver = {{ {scheme} h_start = 0.01 }}
                [[elements]]
                type = "cable"
                name = "c"
                points = [[0, 0, -1], [2, 0, -1]]
                elements = 2
                section = {{ mass = 5, ea = 1e5, ei = 100, diameter = 0.05, axial_retardation_time = 0.1, bending_retardation_time = 0.1 }}
                {of}"#
            );
            let file = SceneFile::parse(&text, name, Format::Toml, &[])
                .unwrap_or_else(|e| panic!("{name}: {e}\n{text}"));
            let (mut simulation, _) =
                start(file.scene(), Watch::default()).unwrap_or_else(|e| panic!("{name}: {e}"));
            let mut longest = Longest(0.0);
            simulation.advance(20.0, f64::INFINITY, &mut longest).unwrap_or_else(|e| panic!("{name}: {e}"));
            longest.0
        };
        let [alpha, radau] = ["", "scheme = \"radau-iia-5\","].map(longest);
        println!("{name}: {:.1} and {:.1} steps", 2.0 / alpha, 2.0 / radau);
        // those of a table end at its rows, which turn round a little before or after its waves
        let [least, most] = if ["table", "speeds"].contains(&name) { [53.0, 90.0] } else { [58.0, 59.0] };
        assert!((least..most).contains(&(2.0 / alpha)), "{name}: steps of up to {alpha} s");
        assert!(2.0 / radau < 40.0, "{name}: steps of up to {radau} s with Radau");
    }
}
