//! Statistics that a scene asks for, of its own run.

use super::ranges::on_pages;
use crate::statistics::{Asked, Set};
use ropewalk_core::BuildError;
use ropewalk_report::{Listing, Page, RangeGraph, RunFolder, Sheet, Table};
use ropewalk_scene::{Analysis, Fault, Scene, SceneFile};

/// What a run tells of its records in few numbers.
#[derive(Default)]
pub(crate) struct Told {
    pub listings: Vec<Listing>,
    pub ranges: Vec<RangeGraph>,
}

/// What is wrong with the statistics that a scene asks for, if anything, pointing at its line.
pub(crate) fn check(file: &SceneFile, history: &Table) -> Result<(), Fault> {
    let scene = file.scene();
    let all = &scene.run.statistics;
    for (k, spec) in all.iter().enumerate() {
        let at = |e: BuildError| {
            let field = e.field.map_or(String::new(), |field| format!(".{field}"));
            file.document().fault_at(&format!("run.statistics[{k}]{field}"), e.message)
        };
        if scene.run.analysis != Analysis::Dynamics {
            return Err(at(BuildError::new("statistics are of runs in time, not of equilibria")));
        }
        spec.check(scene.run.duration).map_err(at)?;
        let name = spec.name();
        if all[..k].iter().any(|other| other.name() == name) {
            let message = format!("two tables of statistics are named `{name}`: give one of them a `name`");
            return Err(at(BuildError::at("name", message)));
        }
        let columns = crate::statistics::chosen(history, &spec.of).map_err(|fault| {
            let there = at(BuildError::at("of", fault.message));
            Fault { help: fault.help, notes: fault.notes, ..there }
        })?;
        let Some(Ok((_, unit))) = spec.fatigue.map(|fatigue| fatigue.strength()) else { continue };
        if columns.iter().all(|c| c.unit != unit) {
            let message =
                format!("none of these records is in {unit}, so that no cycles of it can be counted");
            return Err(at(BuildError::at("fatigue", message)));
        }
    }
    Ok(())
}

/// The statistics that a scene asks for, of its history; those of a time that a run didn't reach are left out.
pub(crate) fn sets<'a>(scene: &Scene, history: &'a Table) -> Vec<Set<'a>> {
    let end = history.columns.first().and_then(|c| c.values.last()).copied().unwrap_or(0.0);
    scene.run.statistics.iter().filter_map(|spec| Set::new(Asked::of(spec, end), history).ok()).collect()
}

/// Writes them, tells of them, and gives the names of tables and pictures.
pub(crate) fn write(
    folder: &RunFolder,
    sets: &[Set<'_>],
    plots: bool,
    warn: &mut dyn FnMut(&str),
) -> (Vec<String>, Vec<String>) {
    let mut all = (Vec::new(), Vec::new());
    for set in sets {
        match set.write(folder, plots, warn) {
            Ok((tables, pictures)) => {
                all.0.extend(tables);
                all.1.extend(pictures);
            }
            Err(e) => warn(&e.to_string()),
        }
    }
    all
}

/// Tables for the terminal.
pub(crate) fn text(listings: &[Listing]) -> String {
    let mut text = String::new();
    for listing in listings {
        let mut sheet = Sheet::new(format!("{} {}", listing.title, listing.note));
        crate::statistics::tables(&mut sheet, &listing.headings, &listing.rows);
        text += &sheet.to_string();
    }
    text
}

impl Told {
    /// What a folder has of them.
    pub fn of_folder(folder: &RunFolder, file: &SceneFile, history: &Table) -> Self {
        let listings = sets(file.scene(), history).iter().map(Set::listing).collect();
        Told { listings, ranges: on_pages(folder, file.scene()) }
    }

    /// Puts them onto a page.
    pub fn onto(self, page: &mut Page) {
        (page.listings, page.ranges) = (self.listings, self.ranges);
    }
}
