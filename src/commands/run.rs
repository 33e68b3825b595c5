//! `ropewalk run SCENE`

use super::{Exit, complain, error, interrupted, progress, say, warn};
use crate::cli::SceneArgs;
use ropewalk_models::Bundled;
use ropewalk_report::{Interrupt, SweepProgress, Watch, rough};
use ropewalk_scene::{Fault, SceneFile, SceneText};
pub use ropewalk_studies::Error;
pub use ropewalk_studies::certificate::{Certificate, certify, choose, sized};
use ropewalk_studies::run::{Every, Leaves, Outcome, RunOptions, Status, run as run_scene};
use ropewalk_studies::study::{Axes, Runs, Target};
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// What to run, and how far it has to be trusted.
#[derive(Debug, clap::Args)]
pub(crate) struct RunArgs {
    #[command(flatten)]
    scene: SceneArgs,
    /// Folder for the results, new or empty [default: runs/SCENE, numbered]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Measure the time of every term
    #[arg(long)]
    profile: bool,
    /// Write a checkpoint every so often, such as `60s` or `500 steps`, from which `resume` goes on
    #[arg(long, value_name = "EVERY")]
    checkpoint: Option<Every>,
    /// Run again with tighter steps and a finer mesh, and say what that changes
    #[arg(long)]
    certify: bool,
    /// Choose step or tolerance and mesh so that the error of a record, relative to its size, is at most this
    #[arg(long, value_name = "ERROR", requires = "of", allow_negative_numbers = true)]
    accuracy: Option<f64>,
    /// The record that `--accuracy` and `--certify` look at, with @TIME at that time only
    #[arg(long, value_name = "RECORD[@TIME]")]
    of: Option<String>,
    /// Wall time that the search of `--accuracy` may take
    #[arg(long, value_name = "TIME", requires = "accuracy", default_value = "10 min", value_parser = super::cost::time)]
    budget: Duration,
    /// Show the course of a record while it runs, such as hose.end.z
    #[arg(long, value_name = "RECORD")]
    watch: Option<String>,
    /// Leave report.html and field.npy out
    #[arg(long)]
    no_report: bool,
    /// Leave plots/*.svg out
    #[arg(long)]
    no_plots: bool,
    /// Write vtk.pvd and vtk/*.vtp, for ParaView
    #[arg(long)]
    vtk: bool,
    /// Say nothing but errors and warnings
    #[arg(long, short)]
    quiet: bool,
}

pub(crate) fn run(args: &RunArgs, bundled: &[Bundled]) -> Result<Exit, Error> {
    if let Some(accuracy) = args.accuracy.filter(|a| !(*a > 0.0 && *a < 1.0)) {
        let fault = Fault::new(format!("an accuracy is a number above 0 and below 1, not {accuracy}"));
        return Err(fault.with_help("for 0.1 % write `--accuracy 1e-3`").into());
    }
    let trusting = !args.certify && args.accuracy.is_none();
    if trusting && args.of.is_some() {
        let fault = Fault::new("`--of` belongs to `--accuracy` or `--certify`");
        return Err(fault.with_help("leave it out, or add `--certify`").into());
    }
    if trusting {
        let file = SceneFile::open(&args.scene.scene, &args.scene.overrides, bundled)?;
        return Ok(tell(&args.go(&file)?, args.quiet));
    }
    let text = SceneText::open(&args.scene.scene, bundled)?;
    let axes = Axes::new(&text, &args.scene.overrides)?;
    let of = args.of.as_ref().map(|of| Target::parse(of, axes.file())).transpose()?;
    if axes.is_empty() {
        let message =
            "there is nothing to refine: the scene has neither elements nor time steps of the solver";
        return Err(Fault::new(message).with_help("leave `--accuracy` and `--certify` out").into());
    }
    match (args.accuracy, of) {
        (Some(accuracy), Some(of)) => args.accurate(&axes, &of, accuracy),
        (_, of) => args.certified(&axes, of),
    }
}

impl RunArgs {
    /// Runs a scene into its folder.
    fn go(&self, file: &SceneFile) -> Result<Outcome, Error> {
        let (out, checkpoint) = (self.out.clone(), self.checkpoint);
        let (progress, watch) = (progress(self.quiet), Watch::signals(warn));
        let leaves = Leaves { report: !self.no_report, plots: !self.no_plots, vtk: self.vtk };
        let options = RunOptions {
            out,
            profile: self.profile,
            progress,
            checkpoint,
            watch,
            leaves,
            follow: self.watch.clone(),
            inputs_stay: false,
        };
        run_scene(file, &options, &mut warn)
    }

    /// Further runs, all of which end at the time that is looked at.
    fn runs<'a>(&self, axes: &'a Axes<'a>, until: Option<f64>) -> Runs<'a> {
        Runs::in_memory(axes, until, SweepProgress::new(0, progress(self.quiet)))
    }

    /// Runs with settings that reach the accuracy, or come nearest to it.
    fn accurate(&self, axes: &Axes<'_>, of: &Target, accuracy: f64) -> Result<Exit, Error> {
        let runs = self.runs(axes, of.t);
        let watch = Watch::signals(warn).until(Instant::now().checked_add(self.budget));
        let Some(chosen) = choose(&runs, of, accuracy, watch)? else {
            if watch.is_interrupted() {
                complain(format!("stopped by {}", Interrupt::cause()));
                return Ok(Exit::Interrupted);
            }
            error("no settings were found in the time given\n  = help: raise --budget");
            return Ok(Exit::Solver);
        };
        let spent = format!("{} runs and {} s of CPU", runs.len(), rough(runs.spent()));
        runs.progress.finish();
        if !self.quiet {
            let word = if chosen.reached { "chosen" } else { "nearest" };
            say(format!("{word}: {}, after {spent}", chosen.certificate.settings));
            say(format!("  {}", axes.recipe(&chosen.settings)));
        }
        let outcome = self.go(&axes.with(&chosen.settings, None)?)?;
        let exit = self.keep(outcome, chosen.certificate)?;
        if exit == Exit::Done && !chosen.reached {
            error(format!(
                "the accuracy {accuracy:e} was not reached: the results are those of the nearest settings\n  = \
                 help: allow a larger error or a longer --budget, or look at an earlier time with `--of RECORD@TIME`"
            ));
            return Ok(Exit::Solver);
        }
        Ok(exit)
    }

    /// Runs with the settings as they are, and certifies the record that is asked for, or all.
    fn certified(&self, axes: &Axes<'_>, of: Option<Target>) -> Result<Exit, Error> {
        let outcome = self.go(axes.file())?;
        if !outcome.summary.status.is_complete() {
            return Ok(tell(&outcome, self.quiet));
        }
        let runs = self.runs(axes, of.as_ref().and_then(|of| of.t));
        let records = match of {
            Some(of) => vec![of],
            None => sized(Target::all(axes.file())?, &outcome.history),
        };
        let certificate = certify(&runs, &axes.base, &records, None, Watch::signals(warn));
        runs.progress.finish();
        let certificate = certificate.inspect_err(|_| {
            // the run itself is complete
            tell(&outcome, self.quiet);
        })?;
        match certificate {
            Some(certificate) => self.keep(outcome, certificate),
            None => {
                tell(&outcome, self.quiet);
                Ok(interrupted("the run is complete, the certificate is missing"))
            }
        }
    }

    /// Keeps the certificate with the results and says how all ended.
    fn keep(&self, mut outcome: Outcome, certificate: Certificate) -> Result<Exit, Error> {
        if certificate.sensitive && self.quiet {
            warn("the run is sensitive: see the certificate in summary.json");
        }
        outcome.certified(certificate)?;
        Ok(tell(&outcome, self.quiet))
    }
}

/// Says how a run ended.
pub(super) fn tell(outcome: &Outcome, quiet: bool) -> Exit {
    if !quiet {
        say(outcome.report.trim_end());
    }
    let message = outcome.summary.message.as_deref().unwrap_or_default();
    match outcome.summary.status {
        Status::Failed | Status::Refused => {
            let folder = outcome.folder.path().display();
            error(format!(
                "{message}\n  = note: the results until then are in {folder}\n  = see: `ropewalk book {}`",
                super::remedy::FAILED
            ));
            Exit::Solver
        }
        Status::Interrupted => Exit::Interrupted,
        Status::Finished | Status::Stopped => Exit::Done,
    }
}
