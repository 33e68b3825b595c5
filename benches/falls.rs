//! What a tackle of many falls costs, and how exact its tension is: a block of 2 t goes up by 6 m in a minute, on a rail or
//! free to swing, each fall one element, with an efficiency of 0.98 at every sheave.
//! `cargo bench --bench falls`, or `-- 12` for twelve falls alone. The reference, at a tolerance of 1e-6, takes most of the time.

#[path = "../tests/common/hoist.rs"]
mod hoist;

use hoist::Hoist;
use ropewalk::scene::Format;
use ropewalk::{History, SceneFile, simulate};
use std::time::Instant;

const DURATION: f64 = 60.0;
const TENSION: &str = "head.1.in.tension";

/// Tolerances of positions and of forces.
const TOLERANCES: [[f64; 2]; 4] = [[1e-2, 1e-2], [1e-2, 3e-3], [1e-3, 3e-3], [1e-4, 1e-3]];

fn run(
    hoist: &Hoist<'_>,
    [tolerance, force]: [f64; 2],
) -> Result<(History, f64), Box<dyn std::error::Error>> {
    let text = format!(
        "solver = {{ stepping = {{ controlled = {{ tolerance = {tolerance} }} }}, force_tolerance = {force} }}\n{}",
        hoist.text()
    );
    let scene = SceneFile::parse(&text, "tackle", Format::Toml, &[])?.into_scene();
    let begin = Instant::now();
    let history = simulate(&scene)?;
    Ok((history, begin.elapsed().as_secs_f64()))
}

/// Root mean square and largest of the differences of tension, in parts of the largest.
fn errors(history: &History, exact: &History) -> Option<[f64; 2]> {
    let (got, exact) = (history.column(TENSION)?, exact.column(TENSION)?);
    let largest = exact.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let off: Vec<f64> = got.iter().zip(exact).map(|(a, b)| (a - b).abs() / largest).collect();
    let square = off.iter().map(|x| x * x).sum::<f64>() / off.len() as f64;
    Some([square.sqrt(), off.iter().fold(0.0, |m, x| m.max(*x))])
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let asked: Vec<usize> = std::env::args().filter_map(|a| a.parse().ok()).collect();
    println!(
        "falls  block    tolerance  of forces    steps  rejected  times real time  error of tension, rms / largest"
    );
    for falls in [4, 8, 12].into_iter().filter(|n| asked.is_empty() || asked.contains(n)) {
        for guided in [true, false] {
            let hoist = Hoist {
                falls,
                wheel: "efficiency = 0.98",
                speed: 0.1,
                ramp: 3.0,
                duration: DURATION,
                guided,
                ..Hoist::default()
            };
            let (exact, _) = run(&hoist, [1e-6, 1e-3])?;
            for [tolerance, force] in TOLERANCES {
                let (history, time) = run(&hoist, [tolerance, force])?;
                let [rms, most] = errors(&history, &exact).ok_or("no record of tension")?;
                println!(
                    "{falls:5}  {}  {tolerance:9.0e}  {force:9.0e}  {:7}  {:8}  {:15.0}  {:.2} % / {:.2} %",
                    if guided { "on rail" } else { "swings " },
                    history.counts.steps,
                    history.counts.rejected,
                    DURATION / time,
                    100.0 * rms,
                    100.0 * most
                );
            }
        }
    }
    Ok(())
}
