//! Counts instructions under valgrind: exact where times are noisy.
//!
//! `cargo bench --bench instructions` counts and compares
//! - a step of the same scene in this program and in one without water, drag and the like, which must be equal: what
//!   a scene doesn't ask for costs nothing, not even where the program could do it;
//! - an iteration of a cable with torsion with that of one without, of which it must not take more than 1.8;
//! - a full iteration with everything in water with what it took in version 0.1, of which it must not take more than 1.3;
//! - iterations and steps with those in `benches/instructions.csv`, which must not be exceeded by more than 5 %.
//!
//! `cargo bench --bench instructions -- --record` writes that file anew; what 0.1 took stays in it.

mod free_fall;

use free_fall::{ELEMENTS, G, STEPS, count_steps, counted_by_valgrind};
use ropewalk::bench::{FullIteration, Pendulum, Steps};
use ropewalk::core::Width;
use ropewalk::elements::{CableSpec, Section};
use ropewalk::forces::GravitySpec;
use ropewalk::{Scene, Water};
use std::collections::BTreeMap;
use std::error::Error;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Stdio};

type Result<T> = std::result::Result<T, Box<dyn Error>>;

const RECORD: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/benches/instructions.csv");
/// Growth that is no noise any more; other versions of the C library and compiler differ by less.
const TOLERANCE: f64 = 0.05;
/// How far equal programs may be apart: where memory lies makes a difference to the C library when it clears it.
const EQUAL: f64 = 1e-4;
/// Most instructions of an iteration with torsion, in those of one without.
const TORSION: f64 = 1.8;
/// Most instructions of a full iteration in water, in those of 0.1, whose water had no energy and no surface.
const WATER: f64 = 1.3;
/// Repetitions that are counted.
const REPEATS: usize = 5;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|a| a != "--bench").collect();
    let done = match &arguments[..] {
        [case, name] if case == "--case" => run(name).map(|()| true),
        [record] if record == "--record" => all(true),
        [] => all(false),
        _ => Err("usage: cargo bench --bench instructions [-- --record]".into()),
    };
    match done {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(e) => {
            eprintln!("error: {e}");
            ExitCode::from(2)
        }
    }
}

/// The scenes of which a full iteration is counted.
fn problem(name: &str, elements: usize) -> Option<Pendulum> {
    let dry = Pendulum::new(elements);
    Some(match name {
        "dry" => dry,
        "damped" => dry.damped(),
        "twisted" => dry.twisted(),
        "water" => dry.in_water(),
        _ => return None,
    })
}

/// Does what a case names, between marks for valgrind.
fn run(case: &str) -> Result<()> {
    let words: Vec<&str> = case.split('-').collect();
    let unknown = || format!("there is no case {case}");
    match words[..] {
        ["iteration", scene, elements, width] => {
            let width = width_of(width).ok_or_else(unknown)?;
            let problem = problem(scene, elements.parse()?).ok_or_else(unknown)?;
            let mut iteration = FullIteration::new(&problem, width)?;
            iteration.run()?;
            let mut done = Ok(());
            counted_by_valgrind(&mut || {
                for _ in 0..REPEATS {
                    if let Err(e) = iteration.run() {
                        done = Err(e);
                    }
                }
            });
            Ok(done?)
        }
        ["step", scene, elements, width] => {
            let width = width_of(width).ok_or_else(unknown)?;
            let mut steps = Steps::new(&problem(scene, elements.parse()?).ok_or_else(unknown)?, width)?;
            steps.run(STEPS)?;
            let mut done = Ok(());
            counted_by_valgrind(&mut || done = steps.run(STEPS));
            Ok(done?)
        }
        ["fall", surroundings] => {
            let mut scene = Scene::new();
            let section = Section::new(0.5, 5000.0, 0.1);
            scene
                .element(CableSpec::straight("cable", [0.0; 3], [1.0, 0.0, 0.0], ELEMENTS, section))
                .set_gravity(G)
                .force(GravitySpec::default());
            scene.water = (surroundings == "water").then(Water::default);
            count_steps(&scene.build()?)
        }
        _ => Err(unknown().into()),
    }
}

fn width_of(name: &str) -> Option<Width> {
    [("one", Width::One), ("four", Width::Four)].into_iter().find(|w| w.0 == name).map(|w| w.1)
}

/// Counts every case; `false` if one is too expensive.
fn all(record: bool) -> Result<bool> {
    if Command::new("valgrind").arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status().is_err()
    {
        eprintln!("valgrind is not installed, so instructions can't be counted: nothing was compared");
        return Ok(true);
    }
    let me = std::env::current_exe()?;
    let mut fine = true;

    println!("a step of a falling cable of {ELEMENTS} elements, instructions");
    let bare = count(&bare_program()?, None)? / STEPS as f64;
    println!("  {:<44}{bare:>12.0}", "program with cables and weight only");
    for (case, what) in
        [("fall-air", "this program"), ("fall-water", "this program, water in the scene, no effect")]
    {
        let here = count(&me, Some(case))? / STEPS as f64;
        let equal = (here / bare - 1.0).abs() <= EQUAL;
        println!("  {what:<44}{here:>12.0}{}", if equal { "" } else { "  differs" });
        fine &= equal;
    }

    let known = read(Path::new(RECORD))?;
    let of_first = |case: &str| known.get(case).and_then(|k| k.first);
    let mut counts = BTreeMap::new();
    println!("\ninstructions per element, in parts of those of 0.1, and against the record");
    let lanes: &[&str] = if Width::best() == Width::One { &["one"] } else { &["one", "four"] };
    for work in ["iteration", "step"] {
        for scene in ["dry", "damped", "twisted", "water"] {
            for elements in [64, 512] {
                for width in lanes {
                    let case = format!("{work}-{scene}-{elements}-{width}");
                    let times = if work == "step" { STEPS } else { REPEATS };
                    let each = count(&me, Some(&case))? / (times * elements) as f64;
                    let change = known.get(&case).map(|before| each / before.now - 1.0);
                    let share = of_first(&case).map_or(String::new(), |first| format!("{:.2}", each / first));
                    let verdict = match change {
                        None => "  new".to_string(),
                        Some(c) if c > TOLERANCE => format!("{:+7.1} %  too expensive", 100.0 * c),
                        Some(c) => format!("{:+7.1} %", 100.0 * c),
                    };
                    fine &= record || change.is_none_or(|c| c <= TOLERANCE);
                    println!("  {case:<44}{each:>12.1}{share:>8}{verdict}");
                    counts.insert(case, each);
                }
            }
        }
    }
    for width in lanes {
        let of = |scene: &str| counts[&format!("iteration-{scene}-64-{width}")];
        let times = of("twisted") / of("dry");
        println!("  an iteration with torsion, {width} at a time, takes {times:.2} of one without");
        fine &= times <= TORSION;
        for elements in [64, 512] {
            let case = format!("iteration-water-{elements}-{width}");
            let Some(first) = of_first(&case) else { continue };
            let times = counts[&case] / first;
            println!("  {case} takes {times:.2} of what it took in 0.1");
            fine &= times <= WATER;
        }
    }
    if record {
        let mut text = String::from("case,instructions per element,those of 0.1\n");
        for (case, each) in &counts {
            let first = of_first(case).map_or(String::new(), |first| format!("{first:.1}"));
            _ = writeln!(text, "{case},{each:.1},{first}");
        }
        std::fs::write(RECORD, text)?;
        println!("\nwritten to {RECORD}");
    }
    Ok(fine)
}

/// What is recorded of a case: its count, and that of version 0.1 if it could do it.
struct Known {
    now: f64,
    first: Option<f64>,
}

/// The recorded counts; none where nothing was recorded yet.
fn read(path: &Path) -> Result<BTreeMap<String, Known>> {
    let Ok(text) = std::fs::read_to_string(path) else { return Ok(BTreeMap::new()) };
    let line = |line: &str| -> Result<(String, Known)> {
        let bad = || format!("{RECORD}: three columns are needed in {line}");
        let [case, now, first] = line.split(',').collect::<Vec<_>>()[..] else { return Err(bad().into()) };
        let first = if first.is_empty() { None } else { Some(first.parse()?) };
        Ok((case.into(), Known { now: now.parse()?, first }))
    };
    text.lines().skip(1).map(line).collect()
}

/// Instructions that a program needs between its marks.
fn count(program: &Path, case: Option<&str>) -> Result<f64> {
    let mut command = Command::new("valgrind");
    command.args([
        "--tool=callgrind",
        "--callgrind-out-file=/dev/null",
        "--toggle-collect=*counted_by_valgrind*",
    ]);
    command.arg(program);
    if let Some(case) = case {
        command.args(["--case", case]);
    }
    let out = command.output()?;
    let said = String::from_utf8_lossy(&out.stderr);
    if !out.status.success() {
        return Err(format!("{}: {said}", case.unwrap_or("bare")).into());
    }
    let number =
        said.lines().find_map(|l| l.split_once("Collected : ")).map(|(_, n)| n.trim().parse::<f64>());
    match number {
        Some(Ok(n)) if n > 0.0 => Ok(n),
        _ => Err(format!("valgrind counted nothing: {said}").into()),
    }
}

/// Builds the program that has nothing else, and says where it is.
fn bare_program() -> Result<PathBuf> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let build = ["bench", "--bench", "bare", "--no-run", "--message-format=json"];
    let out = Command::new(cargo)
        .args(build)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .stderr(Stdio::inherit())
        .output()?;
    let text = String::from_utf8_lossy(&out.stdout);
    let message = |l: &str| serde_json::from_str::<serde_json::Value>(l).ok();
    // cargo names every program that it has at hand
    let bare = |m: &serde_json::Value| m["target"]["name"] == "bare";
    let mut messages = text.lines().filter_map(message).filter(bare);
    let path = messages.find_map(|m| Some(PathBuf::from(m["executable"].as_str()?)));
    Ok(path.ok_or("cargo did not build the program `bare`")?)
}
