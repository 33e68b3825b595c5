//! Statistics of runs: moments, waves, spectra and fatigue of their records, from their histories.

mod course;
mod set;

pub(crate) use set::{Asked, Set, chosen};

use crate::error::Error;
use crate::run::page_of;
use ropewalk_report::statistics::Life;
use ropewalk_report::{RunFolder, Sheet, TERMINAL, Table};
use ropewalk_scene::Fault;
use std::path::Path;

/// What is to be told of which part of a run.
#[derive(Clone, Debug, Default)]
pub struct StatisticsOptions {
    /// From what time on [s]: behind the ramp of the sea.
    pub from: f64,
    /// Up to what time [s]; without it to the end.
    pub to: Option<f64>,
    /// Columns of the history, or what their names begin with; all if there are none.
    pub records: Vec<String>,
    /// How many cycles what they show endures, if that is to be told.
    pub life: Option<Life>,
}

/// A table for the terminal: columns that it has no room for follow below, with the names of the rows again.
pub(crate) fn tables(sheet: &mut Sheet, headings: &[String], rows: &[Vec<String>]) {
    let shown = sheet.table_within(TERMINAL, headings, rows).max(1);
    if shown < headings.len() {
        let rest = |cells: &[String]| [&cells[..1], &cells[shown..]].concat();
        let rows: Vec<Vec<String>> = rows.iter().map(|row| rest(row)).collect();
        sheet.table_within(TERMINAL, &rest(headings), &rows);
    }
}

/// Writes `tables/statistics.csv`, a spectrum of each record as table and picture, and with a life the cycles of each, into the
/// folder of a run; puts the table on its page, if it has one; and tells of them in a table for people.
///
/// # Errors
/// There is no history, no such record, or nothing in that time; files that can't be written.
pub fn statistics(source: &Path, options: &StatisticsOptions) -> Result<String, Error> {
    let folder = RunFolder::earlier(source.to_path_buf());
    let file = folder.history_file();
    if !file.is_file() {
        let fault = Fault::new(format!("{} is no folder of a run: it has no history.csv", source.display()));
        let help = "`ropewalk run` makes one; of many runs `ropewalk sweep … --extremes` tells statistics";
        return Err(fault.with_help(help).into());
    }
    let history = Table::read(&file)?;
    let end = history.columns.first().and_then(|c| c.values.last()).copied().unwrap_or(0.0);
    let window = [options.from, options.to.unwrap_or(end)];
    let asked = Asked {
        name: "statistics".into(),
        records: options.records.clone(),
        window,
        life: options.life.map(|life| (life, String::new())),
    };
    let set = Set::new(asked, &history)?;
    let mut told: Vec<String> = Vec::new();
    set.write(&folder, true, &mut |text| told.push(text.to_string()))?;
    let page = folder.report_file();
    if page.is_file() {
        let mut anew = page_of(source)?;
        let listing = set.listing();
        anew.listings.retain(|own| own.title != listing.title);
        anew.listings.push(listing);
        anew.write(&page)?;
    }
    let mut sheet =
        Sheet::new(format!("Statistics of {} from {} s to {} s", source.display(), window[0], window[1]));
    let (headings, rows) = set.cells();
    tables(&mut sheet, headings, &rows);
    sheet.entries("warning", told);
    sheet.entry("tables", format!("{}/tables/statistics.csv, spectrum-*.csv", source.display()));
    sheet.entry("pictures", format!("{}/plots/spectrum-*.svg", source.display()));
    if page.is_file() {
        sheet.entry("page", page.display());
    }
    Ok(sheet.to_string())
}
