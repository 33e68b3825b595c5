//! Runs of both sides in turn, so that what the machine does meanwhile hits them alike.

use crate::own;
use crate::peer::Peers;
use crate::report::{Report, Row};
use serde::{Deserialize, Serialize};
use serde_json::Value;

/// What a run gives: that of a peer's script, and of Ropewalk's side as well.
#[derive(Clone, Debug, Default, Deserialize, Serialize)]
#[serde(default)]
pub struct Answer {
    /// CPU time of the steps [s].
    pub cpu: f64,
    pub steps: u64,
    pub iterations: u64,
    pub factorizations: u64,
    /// Where the tip is at the end.
    pub tip: Vec<f64>,
    /// Force that the ship has to pull with, interval by interval [N].
    pub reaction: Vec<f64>,
    /// Tension that a peer itself gives out for the upper end [N].
    pub tension: Vec<f64>,
    /// Steps that went on although their iteration had not converged.
    pub not_converged: u64,
}

impl Answer {
    /// Times and counts of a run of Ropewalk.
    pub fn of(run: &own::Run) -> Self {
        let c = run.simulation.work.counts;
        Answer {
            cpu: run.cpu,
            steps: c.steps,
            iterations: c.newton_iterations,
            factorizations: c.factorizations,
            ..Answer::default()
        }
    }
}

/// A run to be timed.
pub struct Job<'a> {
    /// What it is; times, counts and error are filled in later.
    pub row: Row,
    /// Does it once.
    pub once: Box<dyn Fn() -> Result<Answer, String> + 'a>,
}

impl<'a> Job<'a> {
    /// A run of Ropewalk.
    pub fn own(row: Row, once: impl Fn() -> Result<Answer, String> + 'a) -> Self {
        Job {
            row: Row { code: format!("Ropewalk {}", env!("CARGO_PKG_VERSION")), ..row },
            once: Box::new(once),
        }
    }
    /// A run of a peer's script.
    pub fn peer(row: Row, peers: &'a Peers, name: &str, script: &'static str, case: Value) -> Self {
        Job { row: Row { code: peers.label(name), ..row }, once: Box::new(move || peers.run(script, &case)) }
    }
}

/// What came of a job.
pub struct Done {
    pub row: Row,
    pub answer: Answer,
}

/// So much CPU time needs no repeat [s].
const LONG: f64 = 2.0;

/// Does all jobs in turn, and again; what fails is done no more, and each reason is a line of the
/// report.
pub fn in_turn(jobs: &[Job<'_>], repeats: usize, report: &mut Report) -> Vec<Option<Done>> {
    let mut answers: Vec<Result<Vec<Answer>, String>> = jobs.iter().map(|_| Ok(Vec::new())).collect();
    for _ in 0..repeats {
        for (job, all) in jobs.iter().zip(&mut answers) {
            let Ok(so_far) = all else { continue };
            if so_far.iter().any(|a| a.cpu > LONG) {
                continue;
            }
            eprintln!(
                "{}, {}, {} elements, {}",
                job.row.case, job.row.code, job.row.elements, job.row.setting
            );
            match (job.once)() {
                Ok(answer) => so_far.push(answer),
                Err(why) => *all = Err(why),
            }
        }
    }
    let mut said = Vec::new();
    let done = jobs.iter().zip(answers).map(|(job, all)| {
        let row = &job.row;
        if let Err(why) = &all
            && !said.contains(&(&row.code, why.clone()))
        {
            report.say(format!(
                "{}, {} elements, {}, {}: {why}\n",
                row.code, row.elements, row.case, row.setting
            ));
            said.push((&row.code, why.clone()));
        }
        let all = all.ok()?;
        let mut times: Vec<f64> = all.iter().map(|a| a.cpu).collect();
        times.sort_by(f64::total_cmp);
        let answer = all.last()?.clone();
        let row = Row {
            cpu: times[times.len() / 2],
            cpu_least: times[0],
            steps: answer.steps,
            iterations: answer.iterations,
            factorizations: answer.factorizations,
            ..row.clone()
        };
        Some(Done { row, answer })
    });
    done.collect()
}
