//! Ropewalk beside its peers on the same problems: `cargo bench --bench peers -- --quick`, or `--full`.

mod job;
mod own;
mod peer;
mod pendulum;
mod problem;
mod report;
mod tow;
mod towing;
mod workprec;

use clap::Parser;
use peer::Peers;
use report::Report;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Ropewalk beside Exudyn, MoorDyn and CableDyn on the same problems, each at its own error
#[derive(Parser)]
struct Args {
    /// The short way, about a minute; written to `target/peers/results`
    #[arg(long)]
    quick: bool,
    /// Everything, about ten minutes; written to `benches/peers/results`
    #[arg(long, conflicts_with = "quick", required_unless_present = "quick")]
    full: bool,
    /// Only these problems
    #[arg(long, value_delimiter = ',', value_parser = ["pendulum", "workprec", "tow"])]
    only: Vec<String>,
    /// Ropewalk alone: no Python, no network
    #[arg(long)]
    no_peers: bool,
    /// Another folder for the results
    #[arg(long)]
    out: Option<PathBuf>,
    /// What `cargo bench` says to every benchmark
    #[arg(long, hide = true)]
    bench: bool,
}

fn main() -> ExitCode {
    // plain `cargo bench`, with whatever the other benchmarks are told, must neither install nor wait
    let asked = |a: String| ["--quick", "--full", "--help", "-h"].contains(&a.as_str());
    if !std::env::args().any(asked) {
        println!("peers: not run unless asked for: cargo bench --bench peers -- --quick (or --full, --help)");
        return ExitCode::SUCCESS;
    }
    let args = Args::parse();
    match run(&args) {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            eprintln!("{why}");
            ExitCode::FAILURE
        }
    }
}

fn run(args: &Args) -> Result<(), String> {
    let peers = if args.no_peers { Peers::none() } else { Peers::install() };
    let mut report = Report::default();
    report.say("# Ropewalk beside its peers\n");
    report.say(about(&peers, args.quick));
    let wanted = |name: &str| args.only.is_empty() || args.only.iter().any(|n| n == name);
    type Problem = fn(&Peers, bool, &mut Report) -> Result<(), String>;
    let problems: [(&str, Problem); 3] =
        [("pendulum", pendulum::run), ("workprec", workprec::run), ("tow", towing::run)];
    for (_, problem) in problems.into_iter().filter(|(name, _)| wanted(name)) {
        if let Err(why) = problem(&peers, args.quick, &mut report) {
            // what was found so far is kept
            report.say(format!("{why}\n"));
        }
    }
    let usual = if args.quick {
        peer::folder().join("results")
    } else {
        Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/peers/results")
    };
    report.write(args.out.as_ref().unwrap_or(&usual))
}

/// When, where and with what.
fn about(peers: &Peers, quick: bool) -> String {
    let cpu = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let cpu = cpu.lines().find_map(|l| l.strip_prefix("model name")).unwrap_or("an unknown processor");
    let versions: Vec<String> = peers.versions.iter().map(|(name, _)| peers.label(name)).collect();
    format!(
        "Made by `cargo bench --bench peers -- --{}` on {} ({}, {}), with Ropewalk {} and {}. One thread each, CPU \
         time of the steps alone, medians; runs of all codes take turns. See [how it is compared](../README.md).\n",
        if quick { "quick" } else { "full" },
        date(),
        cpu.trim_start_matches([' ', '\t', ':']),
        std::env::consts::ARCH,
        env!("CARGO_PKG_VERSION"),
        if versions.is_empty() { "no peer".into() } else { versions.join(", ") },
    )
}

fn date() -> String {
    let said = std::process::Command::new("date").arg("+%Y-%m-%d").output();
    said.ok().map_or("an unknown day".into(), |o| String::from_utf8_lossy(&o.stdout).trim().to_string())
}
