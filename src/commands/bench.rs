//! `ropewalk bench`

use super::{Exit, say};
use indicatif::ProgressBar;
use ropewalk_core::Width;
use ropewalk_elements::cable::CableModel;
use ropewalk_report::{OutputError, RunFolder, new_bar, write_atomic};
use ropewalk_scene::Fault;
pub use ropewalk_studies::Error;
use ropewalk_studies::bench::measure::{Meter, VariantMeter, memory};
pub use ropewalk_studies::bench::{Cost, Links, Pendulum, Report, VariantCost, models, report};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// What is measured, and where it goes.
#[derive(Debug, clap::Args)]
pub(crate) struct BenchArgs {
    /// Numbers of elements
    #[arg(long, value_name = "N,N,…", value_delimiter = ',', default_value = "8,32,128,512,2048,8192",
          value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    elements: Vec<u32>,
    /// Elements that are evaluated at once [default: the most that the processor can do]
    #[arg(long, value_enum)]
    lanes: Option<Lanes>,
    /// About how long to measure [s]; the longer, the less other work on the machine is felt
    #[arg(long, value_name = "TIME", default_value_t = 10.0)]
    seconds: f64,
    /// Print JSON instead of tables
    #[arg(long)]
    json: bool,
    /// Write all times to a new CSV file
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Folder for a picture, CSV and JSON, new or empty
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, clap::ValueEnum)]
enum Lanes {
    One,
    Four,
    Eight,
}

/// Everything is measured this often, each time in its turn.
const ROUNDS: u32 = 4;
/// Elements of the mesh on which stiffness models are compared.
const COMPARED: usize = 512;

pub(crate) fn bench(args: &BenchArgs) -> Result<Exit, Error> {
    let width = width(args.lanes)?;
    let mut meshes: Vec<usize> = args.elements.iter().map(|n| *n as usize).collect();
    meshes.sort_unstable();
    meshes.dedup();
    if !(args.seconds >= 0.0 && args.seconds <= 1e5) {
        let fault = Fault::new(format!("`--seconds` must be between 0 and 100000, not {}", args.seconds));
        return Err(fault.into());
    }
    // what can't be written should not have to wait for the numbers
    if let Some(path) = &args.csv {
        free(path)?;
    }
    let folder = args.out.clone().map(RunFolder::at).transpose()?;

    let models = models();
    // a stiffness model has fewer numbers than a mesh
    let share = args.seconds / ((3.0 * meshes.len() as f64 + 0.3 * models.len() as f64) * f64::from(ROUNDS));
    let bench = Bench {
        width,
        budget: Duration::from_secs_f64(share),
        bar: new_bar(u64::from(ROUNDS) * (3 * meshes.len() + models.len()) as u64),
        meshes,
        is_silent: args.json,
    };
    let report = bench.run(models)?;
    let json = serde_json::to_string_pretty(&report).map_err(|e| Fault::new(e.to_string()))?;
    if args.json {
        say(&json);
    }
    if let Some(path) = &args.csv {
        free(path)?;
        write_atomic(path, &report.csv())?;
    }
    if let Some(folder) = &folder {
        let path = folder.path();
        write_atomic(&path.join("bench.csv"), &report.csv())?;
        write_atomic(&path.join("bench.json"), &(json + "\n"))?;
        report.plot().write(&path.join("bench.svg"))?;
        if !args.json {
            say(format!("\nbench.svg, bench.csv and bench.json are in {}", path.display()));
        }
    }
    Ok(Exit::Done)
}

/// Everything that is measured, in rounds.
struct Bench {
    meshes: Vec<usize>,
    width: Width,
    /// Time for one mesh in one round.
    budget: Duration,
    bar: ProgressBar,
    /// Whether tables are left out.
    is_silent: bool,
}

impl Bench {
    fn run(&self, models: Vec<CableModel>) -> Result<Report, Error> {
        let width = self.width;
        self.show(format!(
            "ropewalk {} on {}, {} elements at once, one thread; the shortest of many samples\n\
             full Newton iteration: force, exact tangent, assembly, factors, solution; step: 1 ms, default policy\n",
            env!("CARGO_PKG_VERSION"),
            std::env::consts::ARCH,
            width.lanes()
        ));
        self.bar.set_message("memory");
        let memory = memory(self.meshes.last().copied().unwrap_or(0), width)?;
        let pendulum = |n| Meter::new(&Pendulum::new(n), width);
        let in_water = |n| Meter::new(&Pendulum::new(n).in_water(), width);
        let report = Report {
            ropewalk: env!("CARGO_PKG_VERSION"),
            architecture: std::env::consts::ARCH,
            lanes: width.lanes(),
            dry: self.costs("pendulum in air, gravity", &pendulum)?,
            water: self.costs("pendulum in water, gravity, buoyancy, drag, added mass", &in_water)?,
            links: self
                .costs("chain of rigid links, gravity", &|links| Meter::links(&Links { links }, width))?,
            variants: self.variants(models)?,
            memory,
        };
        if let Some(memory) = &report.memory {
            self.show(memory.line());
        }
        self.bar.finish_and_clear();
        Ok(report)
    }

    fn show(&self, text: String) {
        if !self.is_silent {
            self.bar.suspend(|| say(text));
        }
    }

    /// One problem on all meshes.
    fn costs(&self, title: &str, meter: &dyn Fn(usize) -> Result<Meter, Error>) -> Result<Vec<Cost>, Error> {
        let mut meters = self.meshes.iter().map(|n| meter(*n)).collect::<Result<Vec<_>, _>>()?;
        for _ in 0..ROUNDS {
            for (meter, n) in meters.iter_mut().zip(&self.meshes) {
                self.bar.set_message(format!("{title}: {n} elements"));
                meter.round(self.budget)?;
                self.bar.inc(1);
            }
        }
        let costs: Vec<Cost> = meters.iter().map(Meter::cost).collect();
        self.show(report::costs(title, &costs));
        Ok(costs)
    }

    /// The stiffness models on one mesh.
    fn variants(&self, models: Vec<CableModel>) -> Result<Vec<VariantCost>, Error> {
        let mesh = self.meshes.iter().copied().filter(|n| *n <= COMPARED).max().unwrap_or(COMPARED);
        let meters = models.into_iter().map(|m| VariantMeter::new(m, mesh, self.width));
        let mut meters = meters.collect::<Result<Vec<_>, _>>()?;
        self.bar.set_message("stiffness models");
        for _ in 0..ROUNDS {
            for meter in &mut meters {
                meter.round(self.budget.mul_f64(0.3))?;
                self.bar.inc(1);
            }
        }
        let variants: Vec<_> = meters.iter().map(VariantMeter::cost).collect();
        self.show(report::variants(&variants));
        Ok(variants)
    }
}

/// The width asked for. One that the processor can't do would silently be measured as another.
fn width(lanes: Option<Lanes>) -> Result<Width, Fault> {
    let best = Width::best();
    let wish = match lanes {
        None => best,
        Some(Lanes::One) => Width::One,
        Some(Lanes::Four) => Width::Four,
        Some(Lanes::Eight) => Width::Eight,
    };
    if wish.lanes() <= best.lanes() {
        return Ok(wish);
    }
    let (wish, best) = (wish.lanes(), best.lanes());
    Err(Fault::new(format!("this processor has no instructions for {wish} lanes, at most for {best}"))
        .with_help("leave out `--lanes`, or give a smaller number"))
}

/// Nobody's results are overwritten, and a folder that isn't there is told at once.
fn free(path: &Path) -> Result<(), Error> {
    if path.exists() {
        let fault = Fault::new(format!("{} exists, and results are never overwritten", path.display()));
        return Err(fault.with_help("give another name with `--csv`").into());
    }
    write_atomic(path, "")?;
    std::fs::remove_file(path).map_err(OutputError::io("write", path))?;
    Ok(())
}
