//! `ropewalk variants`

use super::{Exit, say};
use crate::bench::models;
use crate::error::Error;
use crate::output::{Interrupt, OutputError, RunFolder, new_bar, write_atomic};
use crate::scene::Fault;
use crate::variants::scaling::{self, DRAWN, MESHES};
use crate::variants::{Form, Problem, Variants, pictures, stiffness};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// What is compared, and where it goes.
#[derive(Debug, clap::Args)]
pub(crate) struct VariantsArgs {
    /// Only one of the two studies
    #[arg(long, value_enum)]
    only: Option<Study>,
    /// Finest mesh of the study of scaling
    #[arg(long, value_name = "N", default_value_t = 64, value_parser = clap::value_parser!(u32).range(1..=64))]
    finest: u32,
    /// The absolute stopping test: norm of the residual in the units of each form
    #[arg(long, value_name = "NUMBER", default_value_t = 1e-7)]
    absolute: f64,
    /// About how long to time the kernels [s]
    #[arg(long, value_name = "TIME", default_value_t = 5.0)]
    seconds: f64,
    /// Folder for tables and pictures, new or empty [default: runs/variants, numbered]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Say nothing but errors
    #[arg(long, short)]
    quiet: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum Study {
    /// The stiffness models
    Stiffness,
    /// Equations with and without dimensions
    Scaling,
}

pub(crate) fn variants(args: &VariantsArgs) -> Result<Exit, Error> {
    for (name, x) in [("--absolute", args.absolute), ("--seconds", args.seconds)] {
        if !(x > 0.0 && x <= 1e5) {
            return Err(Fault::new(format!("`{name}` must be positive and at most 100000, not {x}")).into());
        }
    }
    let interrupt = Interrupt::install()?;
    let folder = match &args.out {
        Some(path) => RunFolder::at(path.clone())?,
        None => RunFolder::numbered(Path::new("runs"), "variants")?,
    };
    let meshes: Vec<usize> = MESHES.into_iter().filter(|n| *n <= args.finest as usize).collect();
    let models = if args.only == Some(Study::Scaling) { Vec::new() } else { models() };
    let problems = if args.only == Some(Study::Stiffness) { &[][..] } else { &Problem::ALL[..] };
    // each problem: every mesh in four forms and with two tests, then its histories
    let bar = match args.quiet {
        true => indicatif::ProgressBar::hidden(),
        false => new_bar((4 * models.len() + problems.len() * (7 * meshes.len() + 1)) as u64),
    };
    let mut found = Variants {
        ropewalk: env!("CARGO_PKG_VERSION"),
        stiffness: Vec::new(),
        forbidden: if models.is_empty() { Vec::new() } else { stiffness::forbidden() },
        scaling: Vec::new(),
    };
    for m in models {
        bar.set_message(format!("{:?}+{:?}: errors", m.longitudinal, m.transverse));
        found.stiffness.push(stiffness::measure(m)?);
        bar.inc(1);
        if interrupt.requested() {
            return Ok(Exit::Interrupted);
        }
    }
    bar.set_message("stiffness models: times");
    stiffness::time(&mut found.stiffness, Duration::from_secs_f64(args.seconds), &|| bar.inc(1))?;

    let mut plots = Vec::new();
    for &problem in problems {
        let mut traces = Vec::new();
        for &n in &meshes {
            bar.set_message(format!("{}: {n} elements", problem.title()));
            let plain = scaling::run(problem, n, Form::Si, None, None)?;
            bar.inc(1);
            for form in Form::ALL {
                for absolute in [None, Some(args.absolute)] {
                    // the factor β h² changes neither iterations nor the test: only its condition number is asked for
                    if absolute.is_none() && form == Form::Si || absolute.is_some() && form == Form::Scaled {
                        continue;
                    }
                    let run = scaling::run(problem, n, form, absolute, Some(&plain))?;
                    if absolute.is_some() && n == DRAWN {
                        traces.push((form, run.iterations));
                    }
                    found.scaling.push(run.row);
                    bar.inc(1);
                    if interrupt.requested() {
                        return Ok(Exit::Interrupted);
                    }
                }
            }
            found.scaling.push(plain.row);
        }
        if !traces.is_empty() {
            plots.push((format!("{}-newton", problem.name()), pictures::iterations(problem, &traces)));
        }
        bar.set_message(format!("{}: histories", problem.title()));
        plots.extend(pictures::histories(&scaling::histories(problem)?));
        bar.inc(1);
    }
    bar.finish_and_clear();

    plots.extend(found.pictures());
    let path = folder.path();
    let text = found.text();
    let json = serde_json::to_string_pretty(&found).map_err(|e| Fault::new(e.to_string()))?;
    write_atomic(&path.join("variants.txt"), &text)?;
    write_atomic(&path.join("variants.json"), &(json + "\n"))?;
    if !found.stiffness.is_empty() {
        write_atomic(&folder.table_file("stiffness")?, &found.stiffness_csv())?;
    }
    if !found.scaling.is_empty() {
        write_atomic(&folder.table_file("scaling")?, &found.scaling_csv())?;
    }
    let mut drawn = 0;
    for (name, plot) in &plots {
        match plot.write(&folder.plot_file(name)?) {
            Ok(()) => drawn += 1,
            Err(OutputError::EmptyPlot { .. } | OutputError::LogAxis { .. }) => {}
            Err(e) => return Err(e.into()),
        }
    }
    if !args.quiet {
        say(text.trim_end());
        say(format!("\n{drawn} pictures, tables and variants.json are in {}", path.display()));
    }
    Ok(Exit::Done)
}
