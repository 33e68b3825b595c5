//! `ropewalk statistics DIR`

use super::{Exit, say};
use ropewalk_report::statistics::Life;
use ropewalk_scene::{Fault, quantity};
pub use ropewalk_studies::Error;
use ropewalk_studies::statistics::{StatisticsOptions, statistics as of};
use std::path::PathBuf;

/// Of which part of which results.
#[derive(Debug, clap::Args)]
pub(crate) struct StatisticsArgs {
    /// Folder of a run
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// Column of history.csv, or what some of them begin with; may be given several times [default: all]
    #[arg(long = "of", value_name = "RECORD")]
    records: Vec<String>,
    /// Look at what comes after this time, such as the ramp of the sea
    #[arg(long, value_name = "TIME", default_value = "0 s")]
    from: String,
    /// Look at what comes before this time [default: the end]
    #[arg(long, value_name = "TIME")]
    to: Option<String>,
    /// Count cycles by rainflow, and their damage by Miner: `K,m` of N = K (range/strength)^-m, or `K,m,N2,m2` where the slope is
    /// m2 beyond N2 cycles
    #[arg(long, value_name = "K,m")]
    fatigue: Option<String>,
    /// What ranges are divided by, in the unit of the record: the breaking load
    #[arg(long, value_name = "NUMBER", requires = "fatigue", default_value_t = 1.0)]
    strength: f64,
    /// Let the mean of a cycle count, by Goodman
    #[arg(long, requires = "fatigue")]
    mean_load: bool,
    /// Say nothing but errors and warnings
    #[arg(long, short)]
    quiet: bool,
}

impl StatisticsArgs {
    fn life(&self) -> Result<Option<Life>, Fault> {
        let Some(text) = &self.fatigue else { return Ok(None) };
        let numbers: Vec<Option<f64>> = text
            .split(',')
            .map(|x| x.trim().parse().ok().filter(|x: &f64| *x > 0.0 && x.is_finite()))
            .collect();
        if !(self.strength > 0.0 && self.strength.is_finite()) {
            return Err(Fault::new(format!("`--strength` must be positive, not {}", self.strength)));
        }
        let (k, m, beyond) = match numbers[..] {
            [Some(k), Some(m)] => (k, m, None),
            [Some(k), Some(m), Some(knee), Some(second)] => (k, m, Some((knee, second))),
            _ => {
                let wrong =
                    format!("`--fatigue {text}` isn't two or four positive numbers: K,m or K,m,N2,m2");
                return Err(
                    Fault::new(wrong).with_help("for studless chain, API RP 2SK has `--fatigue 316,3`")
                );
            }
        };
        Ok(Some(Life { strength: self.strength, k, m, beyond, mean_load: self.mean_load }))
    }
}

fn time(name: &str, text: &str) -> Result<f64, Fault> {
    let wrong = |e| Fault::new(format!("`--{name} {text}`: {e}"));
    text.parse().or_else(|_| quantity::kind::TIME.parse(text)).map_err(wrong)
}

pub(crate) fn statistics(args: &StatisticsArgs) -> Result<Exit, Error> {
    let options = StatisticsOptions {
        from: time("from", &args.from)?,
        to: args.to.as_deref().map(|text| time("to", text)).transpose()?,
        records: args.records.clone(),
        life: args.life()?,
    };
    let report = of(&args.folder, &options)?;
    if !args.quiet {
        say(report.trim_end());
    }
    Ok(Exit::Done)
}
