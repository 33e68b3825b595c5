//! An atlas: the figures and tables of a paper, a report or a thesis, each by its number, computed from scenes.
//!
//! 1. `read` takes the file apart (`spec` says what it may hold);
//! 2. `plan` finds the runs that the entries need, each once, and `check` whether every entry goes with its runs;
//! 3. the runner of sweeps computes what is missing, and `data` reads what the runs left;
//! 4. `curves` and `figure` make pictures of it, `table` tables, `page` the page that shows all.

mod check;
mod curves;
mod data;
mod figure;
mod frame;
mod known;
mod number;
mod overlay;
mod page;
mod plan;
mod read;
mod spec;
mod table;

pub use overlay::Laid;
pub use read::AtlasFile;

use crate::error::Error;
use crate::run::Status;
use crate::study::{Runner, Study, StudyFolder, lock};
use overlay::Measured;
use page::Outcome;
use plan::Plan;
use ropewalk_models::Bundled;
use ropewalk_report::{OutputError, ProgressMode, RunFolder, Sheet, Stopwatch, Watch, write_atomic};
use ropewalk_scene::Fault;
use serde::{Deserialize, Serialize};
use spec::{Entry, Overlay};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// Options of [`atlas`].
pub struct AtlasOptions {
    /// Names of entries, such as `4.43` and `table-4.11`; all without it.
    pub only: Vec<String>,
    /// The folder: new, empty, or that of the same atlas. Without it `runs/<atlas>-atlas`, numbered.
    pub out: Option<PathBuf>,
    /// Whether to delete what an earlier call left in the folder.
    pub fresh: bool,
    /// Whether to take the coarser or shorter runs that the atlas has for a first look.
    pub quick: bool,
    /// Runs at the same time; without it as many as there are cores.
    pub jobs: Option<usize>,
    /// Files to be laid over figures.
    pub overlay: Vec<Laid>,
    /// How to show the progress.
    pub progress: ProgressMode,
    /// What may stop it; by default nothing, and the process keeps its signals.
    pub watch: Watch,
}

/// How an atlas ended.
pub struct AtlasOutcome {
    /// Whether Ctrl-C ended it.
    pub interrupted: bool,
    /// Runs that failed or could not begin.
    pub failed: usize,
    /// Entries that could not be made although their runs are there.
    pub broken: usize,
    /// All runs there should be, and those that are complete.
    pub runs: (usize, usize),
    /// A summary for people, several lines.
    pub report: String,
}

/// What an atlas is, as `atlas.json` holds it: runs are known again by their scenes, so entries may change.
#[derive(Serialize, Deserialize)]
struct Manifest {
    ropewalk: String,
    atlas: String,
    title: String,
    quick: bool,
}

impl Study for Manifest {
    const KIND: &'static str = "atlas";
    fn name(&self) -> String {
        format!("{}{}", self.atlas, if self.quick { "-quick" } else { "" })
    }
    fn difference(&self, there: &Self) -> Option<String> {
        if (&self.atlas, &self.title) != (&there.atlas, &there.title) {
            Some(format!("of {}", there.title))
        } else if self.quick != there.quick {
            Some(if there.quick { "made with --quick" } else { "made without --quick" }.into())
        } else {
            None
        }
    }
}

/// Makes the figures and tables of an atlas. What one should know meanwhile is said on standard error.
///
/// # Errors
/// It could not even begin: the file is wrong, or the folder can't be used.
pub fn atlas(file: &AtlasFile, options: &AtlasOptions, scenes: &[Bundled]) -> Result<AtlasOutcome, Error> {
    let stopwatch = Stopwatch::start();
    let chosen = file.chosen(&options.only)?;
    let plan = Plan::new(file, &chosen, options.quick, scenes)?;
    chosen.iter().try_for_each(|k| file.check(*k, &plan))?;
    let overlays = overlays(file, &chosen, &options.overlay)?;
    let manifest = Manifest {
        ropewalk: env!("CARGO_PKG_VERSION").into(),
        atlas: file.name.clone(),
        title: file.atlas.title.clone(),
        quick: options.quick,
    };
    let folder = StudyFolder::open(options.out.clone(), options.fresh, &manifest)?;

    let needed = plan.needed(file);
    let runner = Runner::new(needed.len(), options.progress, options.watch);
    let state = Mutex::new((vec![None::<Status>; plan.cases.len()], 0));
    runner.for_each(needed.len(), options.jobs, |i| {
        let k = needed[i];
        let case = &plan.cases[k];
        let ran = runner.run(Ok(&case.file), &case.title, &RunFolder::earlier(folder.run(&case.name)));
        let mut state = lock(&state);
        state.0[k] = Some(ran.summary.status);
        state.1 += usize::from(ran.earlier);
        Ok(())
    })?;
    let (status, earlier) = state.into_inner().unwrap_or_else(PoisonError::into_inner);
    let complete = |case: usize| status[case].is_some_and(Status::is_complete);
    let waits = |k: usize| {
        let all = plan.uses[k].iter().filter(|u| !complete(u.case)).count();
        if file.atlas.entries[k].needs_results() { all } else { 0 }
    };

    let maker = Maker { file, plan: &plan, folder: &folder };
    let mut outcomes = vec![Outcome::NotAsked; file.atlas.entries.len()];
    for &k in &chosen {
        outcomes[k] = match waits(k) {
            0 => maker.make(k, &overlays[k]).unwrap_or_else(|e| Outcome::Missing(e.to_string())),
            n => Outcome::Missing(format!("{n} of {} runs have no result", plan.uses[k].len())),
        };
    }
    let index = folder.path().join("index.html");
    write_atomic(&index, &page::page(file, &outcomes))?;
    for (k, outcome) in outcomes.iter().enumerate() {
        if let Outcome::Missing(why) = outcome {
            runner.progress.say(&format!("warning: {}: {why}", file.atlas.entries[k].caption()));
        }
    }
    runner.progress.finish();

    let runs = (needed.len(), needed.iter().filter(|k| complete(**k)).count());
    let failed = status.iter().flatten().filter(|s| s.is_failure()).count();
    let interrupted = runs.1 + failed < runs.0;
    let count = |of: fn(&Outcome) -> bool| outcomes.iter().filter(|o| of(o)).count();
    let figures = count(|o| matches!(o, Outcome::Figure(_)));
    let tables = count(|o| matches!(o, Outcome::Table(_)));
    let others = count(|o| matches!(o, Outcome::NotComputed));
    let missing = count(|o| matches!(o, Outcome::Missing(_)));
    let broken = missing - chosen.iter().filter(|k| waits(**k) > 0).count();
    let mut sheet = Sheet::new(&file.atlas.title).with_labels(11);
    sheet.entry("figures", figures);
    sheet.entry("tables", tables);
    sheet.entry("others", format!("{others}, not computed"));
    sheet.entry("missing", missing);
    sheet.entry("runs", format!("{} of {}, {earlier} of them from an earlier call", runs.1, runs.0));
    sheet.entry("time", format!("{:.0} s", stopwatch.elapsed().wall_s));
    sheet.entry("results", index.display());
    Ok(AtlasOutcome { interrupted, failed, broken, runs, report: sheet.to_string() })
}

/// Makes entries of what the runs left.
struct Maker<'a> {
    file: &'a AtlasFile,
    plan: &'a Plan,
    folder: &'a StudyFolder,
}

impl Maker<'_> {
    /// Draws or tabulates an entry.
    ///
    /// # Errors
    /// Nothing to show, or files that can't be read or written.
    fn make(&self, entry: usize, overlays: &[Measured]) -> Result<Outcome, Error> {
        let e = &self.file.atlas.entries[entry];
        match e {
            Entry::Other(_) => Ok(Outcome::NotComputed),
            Entry::Figure(figure) => {
                let with_shapes = self.file.panels(entry, figure).iter().any(|(_, p)| p.shapes.is_some());
                let runs = data::read(self.plan, entry, self.folder, with_shapes)?;
                let drawn = figure::draw(self.file, self.plan, entry, figure, &runs, overlays);
                drawn.picture.write(&self.path("figures", &e.name(), "svg")?)?;
                write_atomic(&self.path("figures", &e.name(), "csv")?, &figure::csv(&drawn.picture))?;
                Ok(Outcome::Figure(drawn.notes))
            }
            Entry::Table(sheet) => {
                let runs = match e.needs_results() {
                    true => data::read(self.plan, entry, self.folder, false)?,
                    false => Vec::new(),
                };
                let printed = table::table(sheet, self.plan, entry, &runs);
                write_atomic(&self.path("tables", &e.name(), "csv")?, &printed.csv())?;
                let html = printed.html();
                write_atomic(&self.path("tables", &e.name(), "html")?, &html)?;
                Ok(Outcome::Table(html))
            }
        }
    }

    /// `figures/4.43.svg`; the folder is made if needed.
    fn path(&self, kind: &str, name: &str, ending: &str) -> Result<PathBuf, OutputError> {
        let folder = self.folder.path().join(kind);
        std::fs::create_dir_all(&folder).map_err(|e| ropewalk_report::cannot_create(&folder, e))?;
        Ok(folder.join(format!("{}.{ending}", ropewalk_report::plain(name))))
    }
}

/// The files that are laid over each figure: those of the atlas and those of the command line.
fn overlays(file: &AtlasFile, chosen: &[usize], laid: &[Laid]) -> Result<Vec<Vec<Measured>>, Fault> {
    let mut all: Vec<Vec<Measured>> = file.atlas.entries.iter().map(|_| Vec::new()).collect();
    let mut used: BTreeSet<&str> = BTreeSet::new();
    for &k in chosen {
        let Entry::Figure(figure) = &file.atlas.entries[k] else { continue };
        let panels: Vec<_> = file.panels(k, figure).into_iter().map(|(_, panel)| panel).collect();
        for (i, overlay) in figure.overlay.iter().enumerate() {
            let measured = Measured::read(overlay, &panels).map_err(|message| {
                let at = file.fault(&format!("entries[{k}].overlay[{i}]"), message);
                at.with_help("give a CSV file: a header of names with units, then numbers")
            })?;
            all[k].push(measured);
        }
        for one in laid.iter().filter(|l| l.figure == figure.number) {
            used.insert(&one.figure);
            let stem = |path: &Path| path.file_stem().map(|s| s.to_string_lossy().into_owned());
            let overlay = Overlay { file: one.file.display().to_string(), label: stem(&one.file) };
            let measured = Measured::read(&overlay, &panels).map_err(|message| {
                Fault::new(format!("--overlay {}: {message}", one.figure))
                    .with_help("give a CSV file: a header of names with units, then numbers")
            })?;
            all[k].push(measured);
        }
    }
    match laid.iter().find(|l| !used.contains(l.figure.as_str())) {
        None => Ok(all),
        Some(l) => Err(Fault::new(format!("--overlay: there is no figure {} to lay over", l.figure))
            .with_help(format!("`ropewalk atlas {} --list` shows all figures", file.name))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ropewalk_models::{atlases, bundled};

    /// Every record, parameter, window and part that the bundled atlases name is there, for the runs of `--quick` as well.
    #[test]
    fn bundled_atlases_go_with_their_scenes() {
        for b in atlases() {
            let file = AtlasFile::open(b.name, atlases()).unwrap_or_else(|fault| panic!("{fault}"));
            let all = file.chosen(&[]).unwrap();
            let plan = Plan::new(&file, &all, false, bundled()).unwrap_or_else(|fault| panic!("{fault}"));
            all.iter().try_for_each(|k| file.check(*k, &plan)).unwrap_or_else(|fault| panic!("{fault}"));
            let quick = Plan::new(&file, &all, true, bundled()).unwrap_or_else(|fault| panic!("{fault}"));
            all.iter().try_for_each(|k| file.check(*k, &quick)).unwrap_or_else(|fault| panic!("{fault}"));
            // figures share most of their runs
            let uses: usize = plan.uses.iter().map(Vec::len).sum();
            assert!(2 * plan.cases.len() < uses, "{} runs for {uses} uses", plan.cases.len());
            let chapters: std::collections::HashSet<_> =
                all.iter().map(|k| file.atlas.entries[*k].head().chapter.to_string()).collect();
            assert_eq!(chapters.len(), file.atlas.chapters.len());
        }
    }

    #[test]
    fn the_thesis_has_every_number_of_its_lists() {
        let file = AtlasFile::open("thesis", atlases()).unwrap();
        let names: Vec<String> = file.atlas.entries.iter().map(Entry::name).collect();
        let lists = [("1", 4), ("2", 39), ("3", 26), ("4", 61), ("D", 1), ("G", 2), ("L", 12)];
        let tables = [("2", 2), ("3", 2), ("4", 11), ("E", 1), ("K", 2), ("L", 6)];
        let figures = lists.iter().flat_map(|(c, n)| (1..=*n).map(move |k| format!("{c}.{k}")));
        let tables = tables.iter().flat_map(|(c, n)| (1..=*n).map(move |k| format!("table-{c}.{k}")));
        let all: Vec<String> = figures.chain(tables).collect();
        assert_eq!(all.len(), names.len());
        for name in all {
            assert!(names.contains(&name), "{name}");
        }
    }
}
