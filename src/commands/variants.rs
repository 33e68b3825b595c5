//! `ropewalk variants`

use super::{Exit, say, warn};
use indicatif::ProgressBar;
use ropewalk_elements::cable::CableModel;
use ropewalk_report::{LinePlot, RunFolder, Watch, new_bar, write_atomic, write_json};
use ropewalk_scene::Fault;
pub use ropewalk_studies::Error;
use ropewalk_studies::bench::models;
use ropewalk_studies::variants::scaling::{self, DRAWN, MESHES};
pub use ropewalk_studies::variants::{Form, Problem, Variants, pictures, stiffness};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// What is compared, and where it goes.
#[derive(Debug, clap::Args)]
pub(crate) struct VariantsArgs {
    /// Only one of the two studies
    #[arg(long, value_enum)]
    only: Option<Study>,
    /// Finest mesh of the study of scaling [default: 64]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=64))]
    finest: Option<u32>,
    /// The absolute stopping test of that study: norm of the residual in the units of each form [default: 1e-7]
    #[arg(long, value_name = "NUMBER")]
    absolute: Option<f64>,
    /// About how long to time the kernels of the stiffness models [s] [default: 5]
    #[arg(long, value_name = "TIME")]
    seconds: Option<f64>,
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
    let given = [
        ("--finest", args.finest.is_some(), Study::Scaling),
        ("--absolute", args.absolute.is_some(), Study::Scaling),
        ("--seconds", args.seconds.is_some(), Study::Stiffness),
    ];
    if let Some((name, ..)) =
        given.iter().find(|(_, given, of)| *given && args.only.is_some_and(|o| o != *of))
    {
        return Err(Fault::new(format!("`{name}` is for the other study: leave it out, or `--only`")).into());
    }
    let finest = args.finest.unwrap_or(64) as usize;
    let (absolute, seconds) = (args.absolute.unwrap_or(1e-7), args.seconds.unwrap_or(5.0));
    for (name, x) in [("--absolute", absolute), ("--seconds", seconds)] {
        if !(x > 0.0 && x <= 1e5) {
            return Err(Fault::new(format!("`{name}` must be positive and at most 100000, not {x}")).into());
        }
    }
    let watch = Watch::signals(warn);
    let folder = match &args.out {
        Some(path) => RunFolder::at(path.clone())?,
        None => RunFolder::numbered(Path::new("runs"), "variants")?,
    };
    let meshes: Vec<usize> = MESHES.into_iter().filter(|n| *n <= finest).collect();
    let models = if args.only == Some(Study::Scaling) { Vec::new() } else { models() };
    let problems = if args.only == Some(Study::Stiffness) { &[][..] } else { &Problem::ALL[..] };
    // each problem: every mesh in four forms and with two tests, then its histories
    let bar = match args.quiet {
        true => ProgressBar::hidden(),
        false => new_bar((4 * models.len() + problems.len() * (7 * meshes.len() + 1)) as u64),
    };
    let mut found = Variants {
        ropewalk: env!("CARGO_PKG_VERSION"),
        stiffness: Vec::new(),
        forbidden: if models.is_empty() { Vec::new() } else { stiffness::forbidden() },
        scaling: Vec::new(),
    };
    let mut plots = Vec::new();
    let budget = Duration::from_secs_f64(seconds);
    let mut compared = compare_models(&mut found, models, budget, &bar, watch);
    for &problem in problems {
        if compared.is_ok() && !watch.is_interrupted() {
            compared = compare_forms(&mut found, problem, &meshes, absolute, &bar, watch)
                .map(|pictures| plots.extend(pictures));
        }
    }
    bar.finish_and_clear();
    // what was found until Ctrl-C or a failure is kept
    leave(&found, &plots, &folder, args.quiet)?;
    compared?;
    Ok(if watch.is_interrupted() { Exit::Interrupted } else { Exit::Done })
}

/// The stiffness models: first what they are, then what they cost.
fn compare_models(
    found: &mut Variants,
    models: Vec<CableModel>,
    budget: Duration,
    bar: &ProgressBar,
    watch: Watch,
) -> Result<(), Error> {
    for m in models {
        if watch.is_interrupted() {
            return Ok(());
        }
        bar.set_message(format!("{:?}+{:?}: errors", m.longitudinal, m.transverse));
        found.stiffness.push(stiffness::measure(m)?);
        bar.inc(1);
    }
    bar.set_message("stiffness models: times");
    stiffness::time(&mut found.stiffness, budget, &|| bar.inc(1))
}

/// One problem on every mesh, in every form and with both stopping tests; gives the pictures of its histories.
fn compare_forms(
    found: &mut Variants,
    problem: Problem,
    meshes: &[usize],
    limit: f64,
    bar: &ProgressBar,
    watch: Watch,
) -> Result<Vec<(String, LinePlot)>, Error> {
    let mut traces = Vec::new();
    for &n in meshes {
        bar.set_message(format!("{}: {n} elements", problem.title()));
        let plain = scaling::run(problem, n, Form::Si, None, None)?;
        bar.inc(1);
        for form in Form::ALL {
            for absolute in [None, Some(limit)] {
                // the factor β h² changes neither iterations nor the test: only its condition number is asked for
                if absolute.is_none() && form == Form::Si || absolute.is_some() && form == Form::Scaled {
                    continue;
                }
                if watch.is_interrupted() {
                    return Ok(Vec::new());
                }
                let run = scaling::run(problem, n, form, absolute, Some(&plain))?;
                if absolute.is_some() && n == DRAWN {
                    traces.push((form, run.iterations));
                }
                found.scaling.push(run.row);
                bar.inc(1);
            }
        }
        found.scaling.push(plain.row);
    }
    let mut plots = Vec::new();
    if !traces.is_empty() {
        plots.push((format!("{}-newton", problem.name()), pictures::iterations(problem, &traces)));
    }
    bar.set_message(format!("{}: histories", problem.title()));
    plots.extend(pictures::histories(&scaling::histories(problem)?));
    bar.inc(1);
    Ok(plots)
}

/// Tables and pictures, in the folder and on the screen.
fn leave(
    found: &Variants,
    histories: &[(String, LinePlot)],
    folder: &RunFolder,
    quiet: bool,
) -> Result<(), Error> {
    let path = folder.path();
    let text = found.text();
    write_atomic(&path.join("variants.txt"), &text)?;
    write_json(&path.join("variants.json"), found)?;
    if !found.stiffness.is_empty() {
        write_atomic(&folder.table_file("stiffness")?, &found.stiffness_csv())?;
    }
    if !found.scaling.is_empty() {
        write_atomic(&folder.table_file("scaling")?, &found.scaling_csv())?;
    }
    let own = found.pictures();
    let plots = histories.iter().chain(&own);
    let drawn = plots.filter(|(name, plot)| folder.draw(name, |path| plot.write(path), &mut warn)).count();
    if !quiet {
        say(text.trim_end());
        say(format!("\n{drawn} pictures, tables and variants.json are in {}", path.display()));
    }
    Ok(())
}
