//! The observer of a run: it evaluates the records, writes the history, shows the progress and keeps shapes.

use super::checkpoint::{Saved, Saver};
use super::kept::Kept;
use super::leave::Leaves;
use super::ranges::Range;
use super::shapes::{Line, Shape};
use super::start::Started;
use super::steps::StepCourse;
use super::summary::{Ending, Happened, Summary};
use super::surfacing::Surfacing;
use crate::error::Error;
use ropewalk_core::integrator::{StepReport, Stepping};
use ropewalk_core::{At, Checkpoint, Layers, Model, NodeKind, Observer, Record, Remeshed, Sample, State, V3};
use ropewalk_report as output;
use ropewalk_report::{Progress, Table, TableWriter, Watch};
use ropewalk_scene::{Analysis, Channel, Fault, Process, Scene, did_you_mean};
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

/// About how many rows keep the positions of all nodes, where they are tracked.
const TRACKED: f64 = 200.0;

/// A record in the table: its name, its title, and its columns.
pub(crate) struct Figure {
    pub name: String,
    pub title: String,
    pub columns: std::ops::Range<usize>,
}

/// Sees every step and sample of a run.
pub struct Recorder<'a> {
    pub(super) scene: &'a Scene,
    records: Vec<Box<dyn Record>>,
    needs_forces: bool,
    needs_strains: bool,
    /// Address of the model that the records are bound to.
    bound: Option<usize>,
    row: Vec<f64>,
    /// All samples so far.
    pub table: Table,
    /// Which columns belong to which record.
    pub figures: Vec<Figure>,
    /// Where the samples go at once.
    pub writer: Option<TableWriter>,
    /// Where the progress is shown.
    pub progress: Option<Progress>,
    /// The column whose course it shows, if one is asked for.
    followed: Option<usize>,
    /// What may stop the run.
    pub watch: Watch,
    /// How often samples were taken and how long that took, if it is to be measured.
    pub spent: Option<(u64, Duration)>,
    /// Positions of all nodes at some hundred rows, if they are wanted.
    pub track: Option<Vec<Vec<V3<f64>>>>,
    /// Lines of all parts at several times.
    pub kept: Kept,
    /// Whether the sizes of steps follow from what happens.
    adaptive: bool,
    /// Whether to look for what leaves water without a surface.
    surfacing: Option<Surfacing>,
    /// How long steps were, if that is to be told, …
    pub course: Option<StepCourse>,
    /// … and the same for pages, at the end.
    pub steps: Option<output::Steps>,
    /// Why it stopped the run.
    pub stop: Option<Ending>,
    /// What happened and when.
    pub events: Vec<Happened>,
    /// How the mesh has changed.
    pub remeshed: Vec<Remeshed>,
    /// Range graphs of lines.
    pub ranges: Vec<Range>,
    /// Where checkpoints go, if any are wanted.
    pub saver: Option<Saver>,
    /// Where warnings go while the run goes on.
    pub warnings: Warnings<'a>,
    /// Bending layers, looked at now and then.
    layers: Option<Layers>,
}

/// Warnings are said at once and kept for the summary.
#[derive(Default)]
pub(crate) struct Warnings<'w> {
    pub all: Vec<String>,
    /// Who is told, if anybody is.
    pub tell: Option<&'w mut dyn FnMut(&str)>,
}

impl Warnings<'_> {
    pub(crate) fn say(&mut self, text: &str) {
        self.all.push(text.to_string());
        if let Some(tell) = &mut self.tell {
            tell(text);
        }
    }
}

impl<'a> Recorder<'a> {
    /// A recorder that keeps everything in memory.
    pub(crate) fn new(scene: &'a Scene, records: Vec<Box<dyn Record>>) -> Self {
        let mut table = Table::new([]);
        if scene.run.analysis == Analysis::Statics {
            table.columns = vec![output::Column::new("load factor", "")];
        }
        let of_records =
            records.iter().map(|r| Channel { name: r.name(), title: r.title(), columns: r.columns() });
        let channels = of_records.chain(scene.processes.iter().flat_map(|p| p.channels()));
        let mut figures = Vec::new();
        for Channel { name, title, columns } in channels {
            let first = table.columns.len();
            for c in columns {
                let unit = if c.unit == "1" { String::new() } else { c.unit };
                table.columns.push(output::Column::new(c.name, unit));
            }
            let columns = first..table.columns.len();
            figures.push(Figure { name, title, columns });
        }
        Recorder {
            scene,
            needs_forces: records.iter().any(|r| r.needs_forces()),
            needs_strains: records.iter().any(|r| r.needs_strains()),
            records,
            bound: None,
            row: Vec::new(),
            table,
            figures,
            writer: None,
            progress: None,
            followed: None,
            watch: Watch::default(),
            spent: None,
            track: None,
            kept: Kept::new(&scene.run),
            adaptive: scene.run.analysis != Analysis::Statics
                && matches!(scene.solver.stepping, Stepping::Controlled { .. }),
            surfacing: Surfacing::of(scene),
            course: None,
            steps: None,
            stop: None,
            events: Vec::new(),
            remeshed: Vec::new(),
            ranges: Vec::new(),
            saver: None,
            warnings: Warnings::default(),
            layers: None,
        }
    }

    /// Lets the progress show the course of a column; says which there are if there is none of this name.
    pub(super) fn follow(&mut self, name: &str) -> Result<(), Fault> {
        let names: Vec<&str> = self.table.columns.iter().skip(1).map(|c| c.name.as_str()).collect();
        let Some(k) = names.iter().position(|own| *own == name) else {
            let fault = Fault::new(format!("there is no record `{name}` whose course could be shown"));
            let fault = fault.with_note(format!("there are {}", names.join(", ")));
            return Err(match did_you_mean(name, &names) {
                Some(guess) => fault.with_help(guess),
                None => fault,
            });
        };
        self.followed = Some(k + 1);
        Ok(())
    }

    /// Keeps the sizes of steps, if a page tells of them.
    pub(super) fn watch_steps(&mut self, leaves: Leaves, started: &Started) {
        let counts = leaves.report && matches!(started, Started::Dynamics(..));
        self.course = counts.then(StepCourse::default);
    }

    /// Begins to show the progress.
    pub(super) fn show(&mut self, mut progress: Progress) {
        if let Some(column) = self.followed.map(|k| &self.table.columns[k]) {
            progress.follow(&column.name, &column.unit);
        }
        self.progress = Some(progress);
    }

    /// Takes up what was recorded until a checkpoint; says which column differs if the records are others.
    pub(super) fn take_up(&mut self, saved: &Saved<'_>) -> Result<(), String> {
        let heads = |t: &Table| t.columns.iter().map(|c| c.heading()).collect::<Vec<_>>();
        if heads(&self.table) != heads(&saved.table) {
            return Err("the checkpoint belongs to other records".into());
        }
        self.table = saved.table.clone().into_owned();
        self.kept.shapes = saved.shapes.clone().into_owned();
        self.kept.due = saved.due.clone().into_owned();
        if self.kept.has_field() {
            self.kept.field_due = saved.field_due.clone().into_owned();
        }
        self.course = self.course.take().map(|_| saved.course.clone().into_owned().unwrap_or_default());
        self.events = saved.events.clone().into_owned();
        self.remeshed = saved.remeshed.clone().into_owned();
        self.ranges = saved.ranges.clone().into_owned();
        Ok(())
    }

    /// Binds the records to the model if it is another one than before: node numbers change with the mesh.
    fn bind(&mut self, model: &Model) -> Result<(), Error> {
        let address = std::ptr::from_ref(model) as usize;
        if self.bound.is_some_and(|bound| bound != address) {
            self.records = self.scene.records(model)?;
            self.kept.follow(model);
        }
        if self.bound != Some(address) {
            match &mut self.layers {
                Some(layers) => layers.follow(model),
                None => self.layers = Some(Layers::new(model)),
            }
        }
        self.bound = Some(address);
        Ok(())
    }

    fn record(&mut self, s: &Sample<'_>) -> Result<(), Error> {
        self.bind(s.model)?;
        self.row.clear();
        self.row.push(s.at.t);
        for record in &self.records {
            record.sample(s, &mut self.row);
        }
        let rows = match self.scene.run.analysis {
            Analysis::Statics => 0.0,
            _ => self.scene.run.duration / self.scene.run.interval(),
        };
        if self.table.rows().is_multiple_of((rows / TRACKED).ceil().max(1.0) as usize) {
            if let Some(track) = &mut self.track {
                track.push(positions(s.model, &s.at));
            }
            if let Some(layers) = &mut self.layers {
                layers.look(s.model, &s.at);
            }
        }
        self.keep()
    }

    /// Takes a row of a process, which made a step of `h` since the last.
    pub(crate) fn process(&mut self, process: &dyn Process, h: f64) -> ControlFlow<()> {
        let t = process.t();
        if let Some(progress) = &mut self.progress {
            progress.step(t, h, 0);
        }
        self.row.clear();
        self.row.push(t);
        process.sample(&mut self.row);
        let name = self.scene.processes.first().map_or("", |p| p.name());
        let row = self.keep();
        self.kept.look(t, |_| {
            let lines = vec![Line::of_process(name, process)];
            Shape { lines, ..Shape::bare(t) }
        });
        self.go_on(row)?;
        self.look_for_end()
    }

    /// Keeps the row.
    fn keep(&mut self) -> Result<(), Error> {
        self.table.push_row(&self.row)?;
        if let Some(writer) = &mut self.writer {
            writer.push(&self.row)?;
        }
        if let (Some(k), Some(progress)) = (self.followed, &mut self.progress) {
            progress.value(self.row[0], self.row[k]);
        }
        Ok(())
    }

    /// Keeps the shape in which the run ended, unless it is there already.
    pub(crate) fn last_shape(&mut self, model: &Model, state: &State) {
        if self.scene.processes.is_empty() {
            self.kept.last(model, state);
        }
    }

    /// The last value of every column, what happened, and the number of rows.
    pub(crate) fn finals(&self, summary: &mut Summary) {
        summary.events.clone_from(&self.events);
        summary.rows = self.table.rows();
        summary.set_finals(&self.table);
    }

    /// What one should know of the mesh, after all that was recorded.
    pub(crate) fn remarks(&self) -> Vec<String> {
        self.layers.iter().flat_map(Layers::remarks).collect()
    }

    /// The last instant that was sampled [s].
    pub(crate) fn t(&self) -> f64 {
        self.table.columns.first().and_then(|c| c.values.last()).copied().unwrap_or(0.0)
    }

    /// Ends the run if that is asked for.
    fn look_for_end(&mut self) -> ControlFlow<()> {
        let flow = self.watch.check();
        if flow.is_break() {
            self.stop = Some(Ending::Interrupted);
        }
        flow
    }

    fn go_on(&mut self, result: Result<(), Error>) -> ControlFlow<()> {
        match result {
            Ok(()) => ControlFlow::Continue(()),
            Err(error) => {
                self.stop = Some(Ending::Failed(error));
                ControlFlow::Break(())
            }
        }
    }
}

impl Observer for Recorder<'_> {
    fn step(&mut self, model: &Model, state: &State, report: &StepReport) -> ControlFlow<()> {
        if let Some(progress) = &mut self.progress {
            if self.adaptive {
                progress.limited(report.limit.word());
            }
            progress.step(state.t, report.h, report.rejected);
        }
        if let Some(course) = &mut self.course {
            course.push(state.t, report.h, report.limit);
        }
        if let Some(saver) = &mut self.saver {
            saver.step();
        }
        let bound = self.bind(model);
        self.go_on(bound)?;
        self.range(model, &state.at(), false);
        self.look_for_end()
    }
    fn needs_forces(&self) -> bool {
        self.needs_forces
    }
    fn needs_strains(&self) -> bool {
        self.needs_strains
    }
    fn needs_energy(&self) -> bool {
        self.records.iter().any(|r| r.needs_energy())
    }
    fn wants_look(&self, t: f64) -> bool {
        !self.ranges.is_empty() || self.kept.is_due(t)
    }
    fn look(&mut self, s: &Sample<'_>) -> ControlFlow<()> {
        let begin = self.spent.map(|_| Instant::now());
        self.range(s.model, &s.at, true);
        self.kept.sample(s.model, &s.at, s.lambda);
        if let (Some((_, time)), Some(begin)) = (&mut self.spent, begin) {
            *time += begin.elapsed();
        }
        ControlFlow::Continue(())
    }
    fn wants_checkpoint(&mut self) -> bool {
        let ending = matches!(self.stop, Some(Ending::Interrupted));
        self.saver.as_ref().is_some_and(|saver| saver.is_due(ending))
    }
    fn checkpoint(&mut self, checkpoint: Checkpoint) -> ControlFlow<()> {
        if let Some(mut saver) = self.saver.take() {
            saver.write(checkpoint, self);
            self.saver = Some(saver);
        }
        ControlFlow::Continue(())
    }
    fn warn(&mut self, text: &str) {
        self.warnings.say(text);
        if let Some(saver) = &mut self.saver {
            saver.warnings.push(text.to_string());
        }
    }
    fn event(&mut self, name: &str, t: f64) {
        self.events.push(Happened { name: name.into(), t });
    }
    fn remeshed(&mut self, report: &Remeshed) {
        self.remeshed.push(report.clone());
    }
    fn sample(&mut self, sample: &Sample<'_>) -> ControlFlow<()> {
        let begin = self.spent.map(|_| Instant::now());
        let risen = self.surfacing.as_mut().map(|s| s.look(sample.model, &sample.at));
        risen.into_iter().flatten().for_each(|text| self.warn(&text));
        let recorded = self.record(sample);
        if let (Some((calls, time)), Some(begin)) = (&mut self.spent, begin) {
            (*calls, *time) = (*calls + 1, *time + begin.elapsed());
        }
        self.go_on(recorded)
    }
}

fn positions(model: &Model, at: &At<'_>) -> Vec<V3<f64>> {
    let nodes = model.nodes().iter().filter(|n| !matches!(n.kind, NodeKind::Scalars(_)));
    nodes.map(|n| [at.q[n.q], at.q[n.q + 1], at.q[n.q + 2]]).collect()
}
