//! `ropewalk plot DIR RECORD…`

use super::{Exit, say};
pub use ropewalk_studies::Error;
use ropewalk_studies::figure::{Style, figure, write_figure};
use std::path::PathBuf;

/// What to draw of which results.
#[derive(Debug, clap::Args)]
pub(crate) struct PlotArgs {
    /// Folder of a run or a sweep, or a CSV file
    #[arg(value_name = "DIR")]
    source: PathBuf,
    /// Columns of history.csv or table.csv, or what some of them begin with, such as `hose.end`
    #[arg(value_name = "RECORD", required = true)]
    records: Vec<String>,
    /// Column for the horizontal axis [default: the time, or the first parameter of a sweep]
    #[arg(long, value_name = "COLUMN")]
    against: Option<String>,
    /// How it looks: `paper` has no title, and dashes besides colours
    #[arg(long, value_enum, default_value = "screen")]
    style: Look,
    /// The picture: .svg, or .png or .pdf if the program was built with the feature `raster` [default: RECORD.svg]
    #[arg(long, short, value_name = "FILE")]
    out: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, clap::ValueEnum)]
enum Look {
    Screen,
    Paper,
}

pub(crate) fn plot(args: &PlotArgs) -> Result<Exit, Error> {
    let style = match args.style {
        Look::Screen => Style::Screen,
        Look::Paper => Style::Paper,
    };
    let name = || PathBuf::from(format!("{}.svg", ropewalk_report::plain(&args.records[0])));
    let out = args.out.clone().unwrap_or_else(name);
    let figure = figure(&args.source, &args.records, args.against.as_deref(), style)?;
    write_figure(&figure, &out)?;
    say(out.display());
    Ok(Exit::Done)
}
