//! The page of a run that is over, or still goes on: made anew of what its folder holds.

use super::page;
use super::recorder::{Figure, Recorder};
use super::scenery::Scenery;
use super::statistics::Told;
use super::summary::Summary;
use crate::error::Error;
use ropewalk_report::{FieldRecord, Page, RunFolder, Steps, Table};
use ropewalk_scene::{Fault, SceneFile};
use std::path::{Path, PathBuf};

/// The page of the run in a folder: the one that is there, or if there is none, one made of what else is there. Of a sweep
/// or an atlas its `index.html`.
///
/// # Errors
/// The folder doesn't exist or holds no run; a file in it that can't be read.
pub fn report_of(folder: &Path) -> Result<PathBuf, Error> {
    let run = RunFolder::earlier(folder.to_path_buf());
    let path = run.report_file();
    // a study of many runs has a page of its own
    let index = folder.join("index.html");
    if !path.is_file() && !run.history_file().is_file() && index.is_file() {
        return Ok(index);
    }
    if !path.is_file() {
        page_of(folder)?.write(&path)?;
    }
    Ok(path)
}

/// The page of the run in a folder, made of what is there; it says what is missing.
///
/// # Errors
/// As [`report_of`].
pub fn page_of(folder: &Path) -> Result<Page, Error> {
    let mut run = Held::open(folder)?;
    let missing = std::mem::take(&mut run.missing);
    let (file, summary) = (run.file, run.summary);
    let told = match &file {
        Some(file) => Told::of_folder(&RunFolder::earlier(folder.to_path_buf()), file, &run.history),
        None => Told::default(),
    };
    let mut page = match &file {
        Some(file) => page::page(file, &summary, run.history, &run.figures, run.field, run.steps),
        None => Page {
            title: run.name.clone(),
            status: summary.status.to_string(),
            warnings: summary.warnings,
            notes: summary.notes,
            history: run.history,
            field: run.field,
            steps: run.steps,
            ..Page::default()
        },
    };
    told.onto(&mut page);
    page::without(&mut page, &missing);
    Ok(page)
}

/// What the folder of a run holds.
pub(super) struct Held {
    /// Name of the folder.
    pub name: String,
    pub file: Option<SceneFile>,
    pub summary: Summary,
    pub history: Table,
    pub figures: Vec<Figure>,
    pub field: FieldRecord,
    pub steps: Option<Steps>,
    /// Names of files that aren't there.
    pub missing: Vec<&'static str>,
}

impl Held {
    pub fn open(folder: &Path) -> Result<Self, Error> {
        let shown = folder.display();
        let no_run = |what: &str| {
            let fault = Fault::new(format!("there is no run to see in {shown}: it {what}"));
            Error::from(fault.with_help("name a folder that `ropewalk run` left behind"))
        };
        if !folder.exists() {
            return Err(no_run("doesn't exist"));
        }
        if !folder.is_dir() {
            return Err(no_run("is a file"));
        }
        let run = RunFolder::earlier(folder.to_path_buf());
        let there = |path: PathBuf| path.is_file().then_some(path);
        let history = there(run.history_file()).map(|path| Table::read(&path)).transpose()?;
        let has_field = run.field_file().is_file() || run.bodies_file().is_file();
        if history.is_none() && !has_field {
            let sweep = ["sweep.json", "table.csv"].iter().any(|name| folder.join(name).is_file());
            return Err(no_run(match sweep {
                true => "is of a study of many runs, whose folders are in `runs`",
                false => "holds neither history.csv nor field.npy",
            }));
        }
        // a scene of another version may not be understood any more: then there are numbers without shapes
        let file = there(run.scene_file())
            .and_then(|path| SceneFile::open(&path.display().to_string(), &[], &[]).ok());
        let name = folder.canonicalize().unwrap_or_else(|_| folder.to_path_buf());
        let name = name.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
        let file = file.map(|file| file.named(&name));
        let mut missing = Vec::new();
        let mut field = FieldRecord::read_npy(&run.field_file(), &run.bodies_file())?;
        field.read_forces_npy(&run.forces_file())?;
        let mut steps: Option<Steps> = there(run.steps_file()).map(|path| Steps::read(&path)).transpose()?;
        let mut drawn = Vec::new();
        let model = file.as_ref().and_then(|file| Some((file, file.build().ok()?)));
        match &model {
            Some((file, model)) => {
                let process = file.scene().start_process().ok().flatten();
                field = Scenery::new(file, model, process.as_deref()).dress(field);
                if let (Ok(records), Some(history)) = (file.records(model), &history) {
                    let recorder = Recorder::new(file.scene(), records);
                    // those of another version may have other columns
                    let same = recorder
                        .table
                        .columns
                        .iter()
                        .map(|c| &c.name)
                        .eq(history.columns.iter().map(|c| &c.name));
                    drawn = if same { recorder.figures } else { Vec::new() };
                }
            }
            None => missing.push("scene.toml, or one that this version can build"),
        }
        let summary: Option<Summary> = there(run.summary_file()).map(|_| run.read_summary()).transpose()?;
        let checks = [
            ("history.csv", history.is_some()),
            ("field.npy", has_field),
            ("summary.json", summary.is_some()),
        ];
        missing.extend(checks.iter().filter(|(_, is)| !is).map(|(name, _)| *name));
        let (history, summary) = (history.unwrap_or_default(), summary.unwrap_or_default());
        if let Some(steps) = &mut steps {
            let counts = steps.causes.iter().map(|cause| summary.limits.get(cause).copied());
            steps.counts = counts.zip(&steps.counts).map(|(all, some)| all.unwrap_or(*some)).collect();
        }
        Ok(Held { name, file, summary, history, figures: drawn, field, steps, missing })
    }
}
