//! What waves cost a line that hangs from a ship: its hydrodynamics in still water, in a sea of 200 waves from a lattice, and summed exactly.
//! `cargo bench --bench waves`, or `-- lattice` for those alone that are named so; microseconds per element and iteration with its tangent.

use ropewalk::core::Simulation;
use ropewalk::core::integrator::{NewtonPolicy, Options, Stepping};
use ropewalk::core::statics::{Statics, StaticsOptions};
use ropewalk::scene::{Format, SceneFile};
use std::collections::BTreeMap;
use std::time::Instant;

const ELEMENTS: usize = 100;
const STEPS: f64 = 500.0;
const H: f64 = 0.02;
/// Of so many runs the fastest counts.
const ROUNDS: usize = 9;

fn scene(theory: &str, waves: &str) -> String {
    format!(
        r#"
        [water]
        level = 0
        {waves}
        [[elements]]
        type = "cable"
        name = "line"
        points = [[450, 0, -148], [0, 0, -4]]
        length = 480
        elements = {ELEMENTS}
        stress_free = "as-laid"
        section = {{ mass = 120, ea = 6e8, diameter = 0.15, axial_retardation_time = 0.005 }}
        [[constraints]]
        type = "spherical"
        name = "anchor"
        marker = "line.start"
        [[constraints]]
        type = "driving"
        name = "fairlead"
        marker = "line.end"
        motion = "ship"
        [[motions]]
        type = "harmonic"
        name = "ship"
        amplitude = [2, 0, 2]
        frequency = 0.1
        [[forces]]
        type = "gravity"
        [[forces]]
        type = "buoyancy"
        [[forces]]
        type = "drag"
        [[forces]]
        type = "added_mass"
        theory = "{theory}"
        "#
    )
}

/// Time of a run by its terms, and its iterations.
fn run(theory: &str, waves: &str) -> Result<(BTreeMap<String, f64>, f64), Box<dyn std::error::Error>> {
    let file = SceneFile::parse(&scene(theory, waves), "waves", Format::Toml, &[])?;
    // a tangent with each iteration
    let stepping = Stepping::Fixed { h: H };
    let options = Options { stepping, newton: NewtonPolicy::Full, ..Options::default() };
    let model = file.build()?;
    let mut state = model.state();
    Statics::new(&model, &StaticsOptions::default())?.find(&mut state, true)?;
    let mut simulation = Simulation::from(model, state, &options, STEPS * H)?;
    simulation.keep_audit(false);
    simulation.work.profile();
    let begin = Instant::now();
    simulation.advance(STEPS * H, STEPS * H, &mut ())?;
    let all = begin.elapsed().as_secs_f64();
    let times = simulation.work.times(&simulation.model);
    let mut by: BTreeMap<String, f64> =
        times.into_iter().map(|(label, _, time)| (label, time.as_secs_f64())).collect();
    by.insert("all".into(), all);
    Ok((by, simulation.work.counts.newton_iterations as f64))
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let sea = |how: &str, count: usize| {
        format!(
            "[water.waves]\njonswap = {{ hs = 4, tp = 10 }}\ndepth = 150\ncount = {count}\nevaluation = \"{how}\""
        )
    };
    // each beside still water in the theory of added mass that it takes: by energy, as it is by default, or as Morison has it
    let cases = [
        ("energy", "still water", String::new()),
        ("energy", "200 waves, lattice", sea("lattice", 200)),
        ("morison", "still water", String::new()),
        ("morison", "200 waves, lattice", sea("lattice", 200)),
        ("morison", "100 waves, lattice", sea("lattice", 100)),
        ("morison", "200 waves, exact", sea("exact", 200)),
    ];
    let asked = std::env::args().skip(1).find(|arg| !arg.starts_with('-'));
    let chosen: Vec<_> = cases
        .iter()
        .filter(|(_, name, _)| asked.as_ref().is_none_or(|asked| name.contains(asked.as_str())))
        .collect();
    // in turns, so that all of them meet the machine in the same moods
    let mut least = vec![f64::INFINITY; chosen.len()];
    for _ in 0..ROUNDS {
        for (least, (theory, _, waves)) in least.iter_mut().zip(&chosen) {
            let (by, iterations) = run(theory, waves)?;
            let water: f64 = by.iter().filter(|(label, _)| label.contains("drag")).map(|(_, t)| t).sum();
            *least = least.min(1e6 * water / iterations / ELEMENTS as f64);
        }
    }
    let (mut of, mut first) = ("", 0);
    for (row, (time, (theory, name, _))) in least.iter().zip(&chosen).enumerate() {
        if *theory != of {
            (of, first) = (theory, row);
        }
        let (base, more) = (chosen[first].1, 100.0 * (time / least[first] - 1.0));
        println!("{theory:8} {name:20} {time:8.3} us, {more:6.1} % on top of {base}");
    }
    Ok(())
}
