//! The command line, as a function: programs with types and scenes of their own offer the same one.
//!
//! A crate that adds an element registers it (see `ropewalk::core::register_spec`); a program that names that crate
//! and calls [`main_with`] then knows it in scene files, in `list` and in `describe`:
//!
//! ```no_run
//! // use my_elements as _; links the crate, and with it the types that it registers
//! use ropewalk::Bundled;
//! use std::process::ExitCode;
//!
//! fn main() -> ExitCode {
//!     let mut scenes = ropewalk::bundled().to_vec();
//!     scenes.push(Bundled { name: "kite", text: "title = \"A kite\"\n" });
//!     ropewalk::cli::main_with(&scenes)
//! }
//! ```

pub use crate::commands::export_fmu::export as export_fmu;
pub use crate::commands::shared::SharedSweep;
use crate::commands::{self, Exit};
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{CommandFactory, Parser, Subcommand};
use ropewalk_models::Bundled;
pub use ropewalk_studies::Error;
use ropewalk_studies::run::Every;
use ropewalk_studies::sweep::{Over, Part, Report};
use std::ffi::OsString;
use std::path::PathBuf;
use std::process::ExitCode;

/// Flexible multibody dynamics: cables, hoses and tethers, bodies, joints and water
#[derive(Debug, Parser)]
#[command(
    name = "ropewalk",
    version,
    after_help = "Examples:\n  \
        ropewalk list                           what there is (--gallery: small examples)\n  \
        ropewalk run scene.toml                 results go to runs/scene\n  \
        ropewalk run scene.toml --set n=40      the same with another parameter\n  \
        ropewalk sweep scene.toml --vary n=10,20,40 --vary speed=5:25:10kn\n  \
        ropewalk describe cable                 the fields of a type\n\n\
        Exit codes: 0 done, 1 a case of `verify` is off, 2 wrong scene or usage, 3 the solver gave up, 130 Ctrl-C\n\
        (143 SIGTERM, 129 SIGHUP, which end a run as Ctrl-C does).",
    disable_help_subcommand = true
)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Command,
    /// How progress is shown: a bar on a terminal and lines elsewhere, or one of these, or nothing
    #[arg(long, global = true, value_name = "HOW", env = "ROPEWALK_PROGRESS", default_value = "auto")]
    pub(crate) progress: commands::Shown,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Run a scene; history, summary and pictures go into a folder of their own
    #[command(after_help = "Examples:\n  \
        ropewalk run scene.toml\n  \
        ropewalk run scene.toml --set speed='25 kn' --set n=40 --out results\n  \
        ropewalk run runs/scene/scene.toml      again, from what a run left behind\n  \
        ropewalk run scene.toml --certify       how far it can be trusted\n  \
        ropewalk run scene.toml --accuracy 1e-3 --of hose.end\n\n\
        The folder holds scene.toml (as it was run), manifest.json, history.csv, summary.json, report.html (all of it as a\n\
        page with the motion in 3D), field.npy and plots/*.svg.\n\
        Ctrl-C, SIGTERM and SIGHUP end the run in good order; what was computed is kept.")]
    Run(commands::run::RunArgs),
    /// Go on with a run that was interrupted or killed, from its last checkpoint
    #[command(after_help = "Examples:\n  \
        ropewalk run scene.toml --checkpoint 60s\n  \
        ropewalk resume runs/scene\n\n\
        The results are those of a run with the same checkpoints that was never stopped, to the last digit. A checkpoint\n\
        makes the run drop kept factors, so one without any may differ in rounding. `--checkpoint '500 steps'` writes\n\
        the same ones on every run, `60s` when the clock says so and when the run is interrupted.")]
    Resume {
        /// Folder of the run
        #[arg(value_name = "DIR")]
        folder: PathBuf,
        /// Write checkpoints at another interval from now on
        #[arg(long, value_name = "EVERY")]
        checkpoint: Option<Every>,
        /// Say nothing but errors and warnings
        #[arg(long, short)]
        quiet: bool,
    },
    /// Show a run in the browser, or two side by side
    #[command(after_help = "Examples:\n  \
        ropewalk view runs/scene                its report.html, made anew if it isn't there\n  \
        ropewalk view runs/scene runs/scene-2   both motions, histories over each other, summaries side by side\n  \
        ropewalk view runs/scene --serve        while the run goes on: the page follows it\n\n\
        The page is one file that needs no network. It is opened if this is a terminal; its place is printed.")]
    View(commands::view::ViewArgs),
    /// Draw columns of a history, or of the table of a sweep, as a figure of one's own
    #[command(after_help = "Examples:\n  \
        ropewalk plot runs/hose-turn hose.end\n  \
        ropewalk plot runs/hose-turn hose.end.z --against hose.end.x --style paper -o path.svg\n  \
        ropewalk plot runs/hose-turn-sweep height.z --against speed\n\n\
        There is a plot for each unit. In a sweep runs that differ in other parameters are curves of their own.")]
    Plot(commands::plot::PlotArgs),
    /// Run a scene with all combinations of parameters, on all cores; what is there already is not computed again
    #[command(after_help = "Examples:\n  \
        ropewalk sweep hose-turn --vary speed=5kn,15kn,25kn --vary start=40,80,120\n  \
        ropewalk sweep hose-turn hose-straight --vary speed=5:25:10kn --set drag=choo-casarella\n  \
        ropewalk sweep scene.toml --vary law=constant,choo-casarella --vary 'end=[\"1 m\",0,0],[\"2 m\",0,0]'\n\n\
        A range is FROM:TO:STEP and includes its ends. The folder holds sweep.json (scenes and parameters), index.html, table.csv\n\
        (a row for each run), plots/*.svg (over all runs) and runs/NAME (what `ropewalk run` leaves behind).\n\
        Last values that aren't steady are named: `--report mean` takes the mean over the last tenth of each run instead.\n\
        The same command again computes only what is missing, failed or was interrupted.\n\n\
        With --samples 200 values are drawn from ranges: --vary 'speed=5..25 kn' --vary n=4..64:1 (whole numbers); --latin\n\
        spreads them evenly. The same seed draws the same values everywhere.\n\
        Beyond one machine: --plan lists the runs and prints what a batch array has to call, --part 3/40 computes a share\n\
        into the folder, which all machines have to see, and the command without both collects them into the same table.")]
    Sweep(SweepArgs),
    /// Moments, waves, spectra and fatigue of what a run has recorded
    #[command(after_help = "Examples:\n  \
        ropewalk statistics runs/mooring --from '100 s'\n  \
        ropewalk statistics runs/mooring --of fairlead.magnitude --fatigue 316,3 --strength 5e6\n  \
        ropewalk statistics runs/riser --of stress --fatigue 1.6e12,3,1e7,5\n\n\
        tables/statistics.csv in the folder holds mean, deviation, extremes, crossings of the mean and the significant range;\n\
        tables/spectrum-*.csv and plots/spectrum-*.svg the spectra (Welch: Hann's window, pieces over each other by half);\n\
        with --fatigue cycles by rainflow counting (ASTM E1049), Miner's damage and the range that does the same at 1 Hz.\n\
        Range graphs along a line are asked for by `ranges` in [run]; extremes over seeds by `sweep --extremes`.")]
    Statistics(commands::statistics::StatisticsArgs),
    /// Make the figures and tables of a paper, a report or a thesis, each by its number
    #[command(after_help = "Examples:\n  \
        ropewalk atlas thesis --list            what there is\n  \
        ropewalk atlas thesis --only 4.43,table-4.11\n  \
        ropewalk atlas thesis --only 3.10 --overlay 3.10=measured.csv\n  \
        ropewalk atlas my-paper.toml --out atlas\n\n\
        The folder holds index.html with all entries by chapter, figures/*.svg and *.csv, tables/*.csv and *.html, and in\n\
        runs/ what `ropewalk run` leaves behind. Runs that entries share are computed once, on all cores; the same command\n\
        again, or after Ctrl-C, computes only what is missing. `examples/atlas` shows how an atlas is written.")]
    Atlas(commands::atlas::AtlasArgs),
    /// Vibration modes about the equilibrium of a scene: frequencies, damping, and a picture of each shape
    #[command(after_help = "Examples:\n  \
        ropewalk modes scene.toml               the 20 lowest\n  \
        ropewalk modes scene.toml --count 6 --set tension='2 kN'\n\n\
        A scene in balance as it is laid vibrates about that; else the equilibrium is searched: of a run in time the one\n\
        at its start, of a statics scene the end of its load path, relative to its frame if it names one. Unstable\n\
        equilibria are left for stable ones unless the scene says `stable = false` in [statics].\n\
        The folder holds scene.toml, manifest.json, tables/modes.csv, plots/mode-NN.svg and report.html, where they swing.")]
    Modes(commands::modes::ModesArgs),
    /// Mass, damping, stiffness and gyroscopic matrices about a state, what inputs do and what records see, as sparse files
    #[command(after_help = "Examples:\n  \
        ropewalk linearise scene.toml           about its equilibrium\n  \
        ropewalk linearise scene.toml --at start\n  \
        ropewalk linearise scene.toml --at '20 s' --out linearised\n\n\
        The folder holds scene.toml, manifest.json, a Matrix Market file for each matrix (`scipy.io.mmread` reads them), and\n\
        linearised.json with the equations and the names of unknowns, constraints, inputs and outputs.")]
    Linearise(commands::linearise::LineariseArgs),
    /// What accuracy costs: the cheapest mesh, models, scheme and step for errors of a record from 1 % to 1e-6
    #[command(after_help = "Examples:\n  \
        ropewalk cost cantilever --of beam.end          over the whole load path\n  \
        ropewalk cost hose-turn --of height@60s         at one time\n  \
        ropewalk cost pendulum --of cable.end --set duration='0.4 s' --budget 5min\n\n\
        Errors are relative to the largest magnitude of the record over the run; without @TIME the largest one over the\n\
        run counts. The reference is computed first, on all cores: steps and mesh are refined until they make no\n\
        difference, a second integrator has to agree, the mesh is extrapolated. Then runs are timed one by one.\n\
        The folder holds index.html, table.csv, advice.json, advice/*.toml (the scene with the settings for each error), plots/cost.svg\n\
        (error over CPU time) and runs/. Ctrl-C stops; the same command goes on.")]
    Cost(commands::cost::CostArgs),
    /// What each effect costs and does, what its absence would change, and what absent effects would add
    #[command(after_help = "Examples:\n  \
        ropewalk effects hose-turn --of height@60s\n  \
        ropewalk effects pendulum --of cable.end --accuracy 1e-3 --set elements=16\n\n\
        A record of several columns counts as a vector; with @TIME it is looked at at that time, else over the whole run.\n\
        Changes are relative to the largest size of the record in the run. The scene is run once without each of its\n\
        effects, and once with each effect that it lacks and that can be guessed from it; then without all those together\n\
        that change the record by less than the accuracy. Runs are timed one after the other.\n\
        The folder holds scene.toml, manifest.json, tables/ledger.csv, tables/effects.csv and plots/*.svg.")]
    Effects(commands::effects::EffectsArgs),
    /// Run cases with known results, and compare: measured values, references, tolerances, CPU time
    #[command(after_help = "Examples:\n  \
        ropewalk verify                         all cases\n  \
        ropewalk verify elastica flying         those whose names begin so\n  \
        ropewalk verify --list                  what there is\n  \
        ropewalk verify -o docs/verification.md a page of the results, with a picture beside it; also .html\n\n\
        Exit codes: 0 all within their tolerances, 1 something outside, 2 wrong usage, 130 Ctrl-C. CPU time beyond the\n\
        suggested limit is reported, no failure. Cases are scenes: `--scenes DIR` writes them, to be run and changed.")]
    Verify(commands::verify::VerifyArgs),
    /// List the bundled scenes and the types that a scene can use
    List {
        /// The scenes of the gallery instead: small ones, each of which shows one thing
        #[arg(long)]
        gallery: bool,
    },
    /// Begin a scene of one's own with a copy of another
    #[command(after_help = "Examples:\n  \
        ropewalk new swing                      from the scene `simple-pendulum`\n  \
        ropewalk new my-mooring --from mooring-line\n\n\
        `ropewalk list` and `ropewalk list --gallery` name the scenes to begin with.")]
    New(commands::new::NewArgs),
    /// Explain a scene, a type, or a section of a scene file
    #[command(after_help = "Examples:\n  \
        ropewalk describe scene.toml            title, parameters, parts\n  \
        ropewalk describe cable                 fields with units and defaults\n  \
        ropewalk describe solver                also: water, run, statics, inputs\n  \
        ropewalk describe riser                 the types that stand for a word of the field\n  \
        ropewalk describe cable --json          the JSON schema and the example; without a name those of all types\n\n\
        `ropewalk book` has pages that show types in use, `ropewalk schema` is for editors.")]
    Describe {
        /// A scene, a type, or one of: water, air, run, solver, statics, inputs
        #[arg(value_name = "SCENE|TYPE", required_unless_present = "json")]
        what: Option<String>,
        /// Print the JSON schema of a type or section, and its example, for programs
        #[arg(long)]
        json: bool,
    },
    /// Print a page of the book in the terminal, or what pages there are
    #[command(after_help = "Examples:\n  \
        ropewalk book                           the pages\n  \
        ropewalk book mooring | less\n  \
        ropewalk book tension                   a word: the pages that speak of it")]
    Book {
        /// A page, or a word to look for
        #[arg(value_name = "PAGE")]
        page: Option<String>,
    },
    /// Print the JSON schema of scene files, by which editors explain, complete and check them
    #[command(after_help = "Examples:\n  \
        ropewalk schema                         to standard output\n  \
        ropewalk schema --out scene.schema.json\n\n\
        Editors with a TOML language server (Taplo, Tombi, Even Better TOML) read the first line of a scene:\n  \
        #:schema ./scene.schema.json\n\
        `ropewalk new NAME` writes it, and the file.")]
    Schema(commands::scene_schema::SchemaArgs),
    /// Measure what an element costs on this machine, by phase and by stiffness model
    #[command(after_help = "Examples:\n  \
        ropewalk bench\n  \
        ropewalk bench --elements 8,64,512 --lanes four\n  \
        ropewalk bench --out cost               with a picture, CSV and JSON")]
    Bench(commands::bench::BenchArgs),
    /// Compare the stiffness models of cables, and equations with and without dimensions
    #[command(after_help = "Examples:\n  \
        ropewalk variants\n  \
        ropewalk variants --only stiffness\n  \
        ropewalk variants --only scaling --finest 16 --absolute 1e-5")]
    Variants(commands::variants::VariantsArgs),
    /// Read and build a scene without running it, and show what it consists of
    #[command(after_help = "Example:\n  ropewalk check scene.toml --set n=200")]
    Check {
        #[command(flatten)]
        scene: SceneArgs,
    },
    /// Rewrite a scene of version 0.1 with the names of this version
    #[command(after_help = "Examples:\n  \
        ropewalk migrate scene.toml             in place; each change is printed\n  \
        ropewalk migrate scene.toml --check     only prints; exit code 1 if something is to be rewritten\n  \
        ropewalk migrate scene.toml --out new.toml\n\n\
        Comments, order and layout stay as they are. A scene that uses the names of this version is not touched.")]
    Migrate(commands::migrate::MigrateArgs),
    /// Make a scene of an input file of MoorDyn
    #[command(after_help = "Examples:\n  \
        ropewalk import lines.txt > scene.toml\n  \
        ropewalk import lines.txt --out scene.toml\n\n\
        Takes line types, points, lines, bodies, rods, options, a current profile, wave components and a sea floor over, and says by\n\
        name what it can't: failures, control, stiffness by rate or load, lift.")]
    Import(commands::import::ImportArgs),
    /// Write a scene of lines as an input file of MoorDyn
    #[command(after_help = "Examples:\n  \
        ropewalk export mooring.toml > lines.txt\n  \
        ropewalk export mooring.toml --set depth='80 m' --out lines.txt\n\n\
        Writes cables with their sections, ends that are fixed, driven or joined, point masses at ends, drag, added mass and a level\n\
        bed, and says by name what it can't: bodies, winches, other contact, currents and waves.")]
    Export(commands::export::ExportArgs),
    /// Write what a shell has to read to complete commands
    #[command(after_help = "Examples:\n  \
        ropewalk completions bash > ~/.local/share/bash-completion/completions/ropewalk\n  \
        ropewalk completions zsh > ~/.zfunc/_ropewalk\n  \
        ropewalk completions fish > ~/.config/fish/completions/ropewalk.fish")]
    Completions {
        /// The shell
        shell: clap_complete::Shell,
    },
    /// Write the pages of the manual, one for each command
    #[command(after_help = "Example:\n  ropewalk man ~/.local/share/man/man1")]
    Man {
        /// The folder, which is made if it isn't there
        #[arg(value_name = "DIR")]
        folder: PathBuf,
    },
    /// Write a scene as an FMU, for co-simulation with other programs (FMI 3.0)
    #[command(after_help = "Examples:\n  \
        cargo build --release -p ropewalk-fmu   the shared library that goes into the file\n  \
        ropewalk export-fmu crane.toml\n  \
        ropewalk export-fmu crane.toml --set length='30 m' --out crane-30.fmu\n\n\
        Parameters of the scene are parameters of the FMU (texts, as `--set` takes them), its inputs are inputs, the\n\
        columns of its records are outputs.")]
    ExportFmu(commands::export_fmu::ExportArgs),
}

/// A scene and its parameters.
#[derive(Debug, clap::Args)]
pub(crate) struct SceneArgs {
    /// A bundled scene, or a .toml or .json file
    #[arg(value_name = "SCENE")]
    pub(crate) scene: String,
    /// Set a parameter of the scene; may be given several times
    #[arg(long = "set", value_name = "NAME=VALUE")]
    pub(crate) overrides: Vec<String>,
}

/// Scenes, the values of their parameters, and how to run them.
#[derive(Debug, clap::Args)]
pub(crate) struct SweepArgs {
    /// Bundled scenes, or .toml or .json files
    #[arg(value_name = "SCENE", required = true)]
    pub(crate) scenes: Vec<String>,
    /// Vary a parameter over values separated by commas, over FROM:TO:STEP, or with --samples over FROM..TO; may be given
    /// several times
    #[arg(long, value_name = "NAME=V1,V2,...")]
    pub(crate) vary: Vec<String>,
    /// Draw so many values from each range FROM..TO; these parameters change together
    #[arg(long, value_name = "N", value_parser = at_least_one)]
    pub(crate) samples: Option<usize>,
    /// Draw others: the same seed gives the same values on every machine
    #[arg(long, value_name = "NUMBER", default_value_t = 1, requires = "samples")]
    pub(crate) seed: u64,
    /// Draw a Latin hypercube: as many equal parts of each range as there are samples, one value from each
    #[arg(long, requires = "samples")]
    pub(crate) latin: bool,
    /// Set a parameter in all runs; may be given several times
    #[arg(long = "set", value_name = "NAME=VALUE")]
    pub(crate) overrides: Vec<String>,
    /// Folder for the results: new, empty, or that of the same sweep [default: runs/SCENE-sweep, numbered]
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Delete what an earlier sweep left in the folder, and compute everything
    #[arg(long)]
    pub(crate) fresh: bool,
    /// Runs at the same time [default: as many as there are cores]
    #[arg(long, short, value_name = "N", value_parser = at_least_one)]
    pub(crate) jobs: Option<usize>,
    /// Compute nothing: check the sweep, list its runs in plan.csv, and say how to compute it in parts
    #[arg(long, conflicts_with = "part")]
    pub(crate) plan: bool,
    /// Compute one of N equal parts, on whichever machine sees the folder; the command without this collects them
    #[arg(long, value_name = "K/N", conflicts_with = "fresh")]
    pub(crate) part: Option<Part>,
    /// Compute on the workers of a Dask scheduler, such as tcp://node1:8786; done by the command of the Python package
    #[arg(long, value_name = "ADDRESS", conflicts_with_all = ["plan", "part"])]
    pub(crate) dask: Option<String>,
    /// Value that stands for a run in the report, in tables/ and in pictures over a parameter
    #[arg(long, default_value = "last", value_parser = tail_value())]
    pub(crate) report: Report,
    /// Last part of a run that mean, least and largest are taken over, and that tells whether last values are steady
    #[arg(long, value_name = "SHARE", default_value = "10 %")]
    pub(crate) over: Over,
    /// Tell of the extremes of every record over the first parameter, which is a seed: `--vary seed=1:10:1 --extremes`
    #[arg(long)]
    pub(crate) extremes: bool,
    /// Say nothing but errors and warnings
    #[arg(long, short)]
    pub(crate) quiet: bool,
}

/// Last, mean, least or largest, by name.
fn tail_value() -> impl TypedValueParser<Value = Report> {
    let names = PossibleValuesParser::new(Report::ALL.map(|r| PossibleValue::new(r.name()).help(r.about())));
    names.map(|name| Report::ALL.into_iter().find(|r| r.name() == name).unwrap_or_default())
}

pub(crate) fn at_least_one(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(0) | Err(_) => Err("expected a whole number, at least 1".into()),
        Ok(n) => Ok(n),
    }
}

/// The whole command line with these bundled scenes, on the arguments of the program.
///
/// Exit codes: 0 done; 1 a case of `verify` is outside its tolerances; 2 something is wrong with the scene or the
/// command; 3 the solver gave up, all results until then are kept; 130 interrupted by Ctrl-C, 143 by SIGTERM, 129 by
/// SIGHUP, all results until then are kept.
pub fn main_with(bundled: &[Bundled]) -> ExitCode {
    main_from(bundled, std::env::args_os())
}

/// As [`main_with`], on other arguments, the first of which is the name of the program.
pub fn main_from(
    bundled: &[Bundled],
    arguments: impl IntoIterator<Item = impl Into<OsString> + Clone>,
) -> ExitCode {
    ExitCode::from(exit_from(bundled, arguments))
}

/// As [`main_from`], with the exit code as a number: for programs that do more than this, or that aren't Rust's `main`.
pub fn exit_from(
    bundled: &[Bundled],
    arguments: impl IntoIterator<Item = impl Into<OsString> + Clone>,
) -> u8 {
    let cli = match Cli::try_parse_from(arguments) {
        Ok(cli) => cli,
        Err(e) => {
            // a closed pipe is nobody's business
            let _ = e.print();
            return if e.use_stderr() { Exit::Input as u8 } else { 0 };
        }
    };
    commands::show(cli.progress);
    let done = match cli.command {
        Command::Run(args) => commands::run::run(&args, bundled),
        Command::Resume { folder, checkpoint, quiet } => commands::resume::resume(folder, checkpoint, quiet),
        Command::Plot(args) => commands::plot::plot(&args),
        Command::View(args) => commands::view::view(&args),
        Command::Sweep(args) => commands::sweep::sweep(&args, bundled),
        Command::Statistics(args) => commands::statistics::statistics(&args),
        Command::Atlas(args) => commands::atlas::atlas(args, bundled),
        Command::Modes(args) => commands::modes::modes(&args, bundled),
        Command::Linearise(args) => commands::linearise::linearise(&args, bundled),
        Command::Cost(args) => commands::cost::cost(args, bundled),
        Command::Effects(args) => commands::effects::effects(&args, bundled),
        Command::Verify(args) => commands::verify::verify(&args),
        Command::List { gallery } => commands::list::list(bundled, gallery),
        Command::New(args) => commands::new::new(&args, bundled),
        Command::Completions { shell } => commands::completions::completions(Cli::command(), shell),
        Command::Man { folder } => commands::completions::man(Cli::command(), &folder),
        Command::Describe { what, json } if json => commands::describe::schemas(what.as_deref(), bundled),
        Command::Describe { what, .. } => commands::describe::describe(&what.unwrap_or_default(), bundled),
        Command::Book { page } => commands::book::book(page.as_deref()),
        Command::Schema(args) => commands::scene_schema::schema(&args),
        Command::Bench(args) => commands::bench::bench(&args),
        Command::Variants(args) => commands::variants::variants(&args),
        Command::Check { scene } => commands::check::check(&scene, bundled),
        Command::Import(args) => commands::import::run(&args),
        Command::Migrate(args) => commands::migrate::run(&args),
        Command::Export(args) => commands::export::run(&args, bundled),
        Command::ExportFmu(args) => commands::export_fmu::run(&args, bundled),
    };
    match done {
        Ok(exit) => commands::ended(exit).code(),
        Err(e @ Error::Interrupted) => {
            commands::complain(e);
            Exit::Interrupted.code()
        }
        Err(e) => {
            match commands::remedy::see(&e) {
                Some(see) => commands::error(format!("{e}\n  = see: {see}")),
                None => commands::error(&e),
            }
            if e.is_input() { Exit::Input as u8 } else { Exit::Solver as u8 }
        }
    }
}

/// What `ropewalk describe` says of a scene, a type, or a section of a scene file.
///
/// # Errors
/// There is no such thing, or the scene is wrong.
pub fn explain(what: &str, bundled: &[Bundled]) -> Result<String, Error> {
    match commands::describe::explain(what, bundled)? {
        (text, None) => Ok(text),
        (_, Some(fault)) => Err(fault.into()),
    }
}

/// The pages of the book's reference of all types, each with its path in `book/src` and its text as Markdown.
pub fn reference(bundled: &[Bundled]) -> Vec<(String, String)> {
    commands::reference::pages(bundled)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_is_sound() {
        use clap::CommandFactory;
        Cli::command().debug_assert();
    }
}
