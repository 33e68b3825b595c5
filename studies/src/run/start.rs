//! The analyses: motion in time, and a path of equilibria.

use super::recorder::Recorder;
use super::scenery::Scenery;
use super::summary::{Counts, CriticalLoad, Ending, ProfileEntry};
use crate::error::{Error, caught};
use ropewalk_core::integrator::{Limit, Options, Scheme, StepError, StepReport, Stepping};
use ropewalk_core::statics::{Critical, Statics};
use ropewalk_core::{
    Audit, Checkpoint, End, Model, Observer, Sample, Simulation, SolveError, State, Unfit, shock,
};
use ropewalk_report::Watch;
use ropewalk_scene::{Analysis, Fault, Process, Scene, SceneFile};
use std::ops::ControlFlow;
use std::sync::Arc;
use std::time::Duration;

/// Rate at which disturbances of an equilibrium grow [1/s]; 0 if they don't.
type Flutter = f64;

/// The tolerance of positions, in parts of that of forces, up to which forces that follow it alone are as exact as asked: a chain of
/// ten links is off by 1.4 % at 1e-4, and by 8 % at 1e-3.
const FOLLOW: f64 = 1e-2;

/// What an analysis leaves behind.
pub(crate) struct Done {
    pub model: Arc<Model>,
    pub state: State,
    pub audit: Audit,
    pub counts: Counts,
    pub flutter: Flutter,
    /// Loads at which equilibria lost their stability.
    critical: Vec<Critical>,
    /// What else is to be said about the equilibria.
    remarks: Vec<String>,
    /// Where the time of statics went, if that was asked for.
    times: Option<Vec<Spent>>,
    /// What may stop a search.
    watch: Watch,
}

/// A label with calls and time.
type Spent = (String, u64, Duration);

/// An analysis that is ready to go.
pub enum Started {
    /// Motion in time, and what is to be said about the equilibrium that it starts from.
    Dynamics(Box<Simulation>, Flutter, Vec<String>),
    /// Equilibria while time runs as the load factor.
    Statics(Box<Done>),
    /// A problem of its own, beside a model without anything in it.
    Process(Box<dyn Process>, Box<Done>),
}

/// The model in which a scene that runs in time has its equilibria, where it isn't the one that runs: a flow that starts or
/// stops pushes its hose along, which is no equilibrium, but at rest it is steady.
pub(crate) fn steady(scene: &Scene) -> Result<Option<Model>, Error> {
    let flows = scene.forces.iter().any(|f| f.typetag_name() == "internal_flow");
    let changes = flows && scene.run.analysis == Analysis::Dynamics;
    Ok(if changes { Some(scene.build_at_rest()?) } else { None })
}

impl Started {
    /// Brings the model to its start, unless that is stopped.
    pub(crate) fn new(scene: &Scene, model: Model, watch: Watch) -> Result<Self, Error> {
        let run = &scene.run;
        if let Some(process) = scene.start_process()? {
            return Ok(Started::Process(process, Box::new(Done::at_rest(model, watch))));
        }
        if run.analysis == Analysis::Statics {
            return Ok(Started::Statics(Box::new(Done::at_rest(model, watch))));
        }
        // an unsuitable scheme should not have to wait for the equilibrium
        scene.solver.integrator(&model, run.duration)?;
        let (mut state, mut flutter, mut remarks) = (model.state(), 0.0, Vec::new());
        if run.from_equilibrium {
            state.v.fill(0.0);
            let steady = steady(scene)?;
            let mut search =
                Statics::new(steady.as_ref().unwrap_or(&model), &scene.statics).map_err(no_memory)?;
            search.stop_if(move || watch.is_over());
            flutter = search.find(&mut state, true)?.flutter;
            remarks = remarks_on(&search);
            remarks.dedup();
            remarks.extend(by_friction(&model));
            remarks.extend(model.remarks_at_rest(&state.at()));
        }
        let mut simulation = Simulation::from(model, state, &scene.solver, run.duration)?;
        simulation.keep_audit(run.audit);
        Ok(Started::Dynamics(Box::new(simulation), flutter, remarks))
    }

    /// The forces that error control doesn't hold to a tolerance of their own, where that of positions alone may leave more of
    /// them than is asked.
    fn uncontrolled_forces(&self, scene: &Scene) -> Option<&'static str> {
        let (solver, usual) = (&scene.solver, Options::default().force_tolerance);
        let Stepping::Controlled { tolerance } = solver.stepping else { return None };
        let Started::Dynamics(s, ..) = self else { return None };
        let slender = s.model.parts().iter().any(|part| part.slender().is_some());
        let bodies = !slender && s.model.multipliers() > 0;
        match solver.scheme {
            _ if tolerance <= 1.001 * FOLLOW * solver.force_tolerance => None,
            // of cables it leaves less than is asked by default
            Scheme::RadauIia5 if bodies || solver.force_tolerance < usual => Some("them with Radau IIA 5"),
            Scheme::RadauIia5 => None,
            _ => bodies.then_some("reactions of bodies"),
        }
    }

    /// What one should know although the run goes on.
    pub(crate) fn warnings(&self, scene: &Scene) -> Vec<String> {
        let mut all = Vec::new();
        if let Started::Dynamics(s, _, remarks) = self {
            all.extend(remarks.iter().cloned());
            all.extend(s.integrator.warning().map(str::to_string));
            if let Some(r) = s.model.redundancy() {
                all.push(format!(
                    "redundant constraints: {r}. The motion is that without them; forces that could be shared out in \
                     many ways are given with the least norm"
                ));
                if r.dead_point {
                    all.push(format!(
                        "{} start at a dead point: from there more ways than one lead on, or none, and rounding chooses. \
                         Begin a little beyond it",
                        r.names()
                    ));
                }
            }
            if let Some(of) = self.uncontrolled_forces(scene) {
                all.push(format!(
                    "`force_tolerance = {:e}` is what iterations leave of forces here; what steps leave of {of} follows \
                     `tolerance`. Take one of {:e}, or compare with a smaller one; `run --certify` measures it",
                    scene.solver.force_tolerance,
                    FOLLOW * scene.solver.force_tolerance
                ));
            }
            if let Stepping::Fixed { h } = scene.solver.stepping {
                all.extend(s.faster_than(h, scene.run.duration).into_iter().map(|(name, t)| {
                    format!(
                        "`{name}` changes at t = {t:.6} s faster than steps of {h:e} s follow: what it does between two of \
                         them isn't seen. Take a smaller `h`, or error control"
                    )
                }));
            }
            let c = s.correction;
            if c.position > 1e-8 * s.model.length() || c.velocity > 1e-6 {
                all.push(format!(
                    "the start was moved onto the constraints: positions by {:.1e} m, velocities by {:.1e} m/s \
                     (root mean square along the part that is moved most)",
                    c.position, c.velocity
                ));
            }
        }
        all.extend(self.doubts(scene));
        if !scene.run.audit && scene.records.iter().any(|r| r.typetag_name() == "energy") {
            all.push("energy is recorded but not followed: set `audit = true` in [run]".into());
        }
        all
    }

    /// What is doubtful of the scene as it is now.
    fn doubts(&self, scene: &Scene) -> Vec<String> {
        match self {
            Started::Dynamics(s, ..) => scene.doubts(&s.model, &s.state.at()),
            Started::Statics(done) | Started::Process(_, done) => scene.doubts(&done.model, &done.state.at()),
        }
    }

    /// What there is to be seen.
    pub(crate) fn scenery(&self, file: &SceneFile) -> Scenery {
        match self {
            Started::Dynamics(s, ..) => Scenery::new(file, &s.model, None),
            Started::Statics(done) => Scenery::new(file, &done.model, None),
            Started::Process(process, done) => Scenery::new(file, &done.model, Some(process.as_ref())),
        }
    }

    /// What only the run could tell: equilibria that aren't stable, multipliers that ring.
    pub(crate) fn remarks(&self) -> Vec<String> {
        let unstable = |flutter: f64| {
            (flutter > 0.0).then(|| {
                format!(
                    "the equilibrium is not stable: small disturbances grow, e-fold in {:.2} s. In motion it will \
                     flutter",
                    1.0 / flutter
                )
            })
        };
        let mut all = Vec::new();
        match self {
            Started::Process(process, _) => return process.warnings(),
            Started::Statics(done) => {
                all.extend(unstable(done.flutter));
                all.extend(done.remarks.iter().cloned().chain(by_friction(&done.model)));
                all.extend(done.model.remarks(&done.state.at()));
                all.extend(done.model.remarks_at_rest(&done.state.at()));
            }
            Started::Dynamics(s, flutter, _) => {
                let c = s.work.counts;
                if s.ringing > 0.0 {
                    let size = s.ringing;
                    all.push(format!(
                        "the multipliers rang: from step to step they swung by up to {size:.1e} of their size"
                    ));
                } else {
                    all.extend(unstable(*flutter));
                    all.extend((c.unmet > 0).then(|| {
                        format!(
                            "{} steps never met the stopping test of Newton's method: rounding leaves more than it allows. \
                             They are as good as they get",
                            c.unmet
                        )
                    }));
                }
                if c.cut > 0 {
                    all.push(format!(
                        "{} of {} steps are shorter than `h`, since longer ones failed: they didn't converge, or the motion \
                         jumped. Take a smaller `h`, or error control",
                        c.cut, c.steps
                    ));
                }
                all.extend(s.model.remarks(&s.state.at()));
            }
        }
        all
    }

    /// How many steps were limited by what, in the order of [`Limit::ALL`].
    pub(crate) fn limits(&self) -> [u64; Limit::ALL.len()] {
        match self {
            Started::Dynamics(s, ..) => s.work.counts.limits,
            Started::Statics(_) | Started::Process(..) => [0; Limit::ALL.len()],
        }
    }

    /// Measures the time of every term from now on.
    pub(crate) fn profile(&mut self) {
        match self {
            Started::Dynamics(s, ..) => s.work.profile(),
            Started::Statics(done) => done.times = Some(Vec::new()),
            Started::Process(..) => {}
        }
    }

    /// The measured times, and what is left of `wall_s`, with `recording` as it was measured.
    pub(crate) fn times(&self, recording: Option<(u64, Duration)>, wall_s: f64) -> Vec<ProfileEntry> {
        let times = match self {
            Started::Dynamics(s, ..) => s.work.times(&s.model),
            Started::Statics(done) => done.times.clone().unwrap_or_default(),
            Started::Process(..) => Vec::new(),
        };
        let recording =
            recording.filter(|r| r.0 > 0).map(|(calls, time)| ("recording".to_string(), calls, time));
        let entry = |(label, calls, time): Spent| ProfileEntry::new(label, calls, time.as_secs_f64());
        let mut all: Vec<ProfileEntry> = times.into_iter().chain(recording).map(entry).collect();
        let known: f64 = all.iter().map(|e| e.seconds).sum();
        all.push(ProfileEntry::new("Newton's method and step control", 1, (wall_s - known).max(0.0)));
        all
    }

    /// A run in time as it was at a checkpoint.
    pub(crate) fn restored(file: &SceneFile, checkpoint: Checkpoint, flutter: f64) -> Result<Self, Error> {
        let scene = file.scene();
        let mut model = file.build()?;
        if !checkpoint.meshes.is_empty() {
            model = scene.build_on(&checkpoint.meshes)?;
        }
        match Simulation::restore(model, &scene.solver, scene.run.duration, checkpoint) {
            Ok(simulation) => Ok(Started::Dynamics(Box::new(simulation), flutter, Vec::new())),
            Err(Unfit::Step(e)) => Err(e.into()),
            Err(e) => Err(Fault::new(e.to_string()).into()),
        }
    }

    /// Computes until the end, or until something stops it, and takes the progress away; `resumed` says that it goes on
    /// from a checkpoint. What only the run could tell is said at the end.
    pub(crate) fn go(&mut self, recorder: &mut Recorder<'_>, resumed: bool) -> Ending {
        let scene = recorder.scene;
        let (duration, interval) = (scene.run.duration, scene.run.interval());
        if let (Started::Dynamics(s, ..), false) = (&*self, resumed) {
            for text in shock::remarks(&s.model, &s.state) {
                recorder.warnings.say(&text);
            }
        }
        // a defect must not take what was computed with it
        let end = caught(|| match self {
            Started::Dynamics(s, ..) if resumed => Ok(s.go_on(duration, interval, recorder)?),
            Started::Process(process, _) => through(process.as_mut(), scene, recorder),
            _ => self.drive(scene, recorder),
        });
        if let Some(progress) = recorder.progress.take() {
            progress.finish("");
        }
        for text in self.remarks().into_iter().chain(recorder.remarks()) {
            recorder.warnings.say(&text);
        }
        // what has sunk below the bed since, once for each part
        let part = |text: &str| text.split(" reaches down").next().unwrap_or_default().to_string();
        for text in self.doubts(scene) {
            if !recorder.warnings.all.iter().any(|old| part(old) == part(&text)) {
                recorder.warnings.say(&text);
            }
        }
        match (end, recorder.stop.take()) {
            (_, Some(ending)) => ending,
            (Ok(End::Done), None) => Ending::Finished,
            (Ok(End::Stopped { by }), None) => Ending::Stopped(by),
            (Err(error), None) => error.into(),
        }
    }

    /// Moves a model to its end under the eyes of an observer. A process has no model to look at: it stays as it is.
    pub(crate) fn drive(&mut self, scene: &Scene, observer: &mut dyn Observer) -> Result<End, Error> {
        match self {
            Started::Dynamics(s, ..) => {
                s.advance(scene.run.duration, scene.run.interval(), observer).map_err(Error::from)
            }
            Started::Statics(path) => path.go(scene, observer),
            Started::Process(..) => Ok(End::Done),
        }
    }

    /// What is left.
    pub(crate) fn done(self) -> Done {
        match self {
            Started::Statics(done) => *done,
            Started::Process(process, done) => Done { counts: process.counts().into(), ..*done },
            Started::Dynamics(s, ..) => {
                let counts = s.work.counts.into();
                let (critical, remarks) = (Vec::new(), Vec::new());
                let (model, state, audit) = (s.model, s.state, s.audit);
                let watch = Watch::default();
                Done { model, state, audit, counts, flutter: 0.0, critical, remarks, times: None, watch }
            }
        }
    }
}

/// Moves a process on from row to row of the history.
fn through(process: &mut dyn Process, scene: &Scene, recorder: &mut Recorder<'_>) -> Result<End, Error> {
    let rows = (scene.run.duration / scene.run.interval() * (1.0 - 1e-12)).ceil();
    for k in 0..=rows as u64 {
        let t = (k as f64 * scene.run.interval()).min(scene.run.duration);
        let (before, done) = (process.t(), process.advance(t));
        // what could be computed on the way is kept
        if recorder.process(process, process.t() - before).is_break() {
            return Ok(End::Stopped { by: "observer".into() });
        }
        if let Some(by) = done.map_err(Error::Process)? {
            return Ok(End::Stopped { by });
        }
    }
    Ok(End::Done)
}

impl From<ropewalk_core::integrator::Counts> for Counts {
    fn from(c: ropewalk_core::integrator::Counts) -> Self {
        Counts {
            steps: c.steps,
            rejected: c.rejected,
            newton_iterations: c.newton_iterations,
            factorizations: c.factorizations,
        }
    }
}

impl Done {
    /// A model that doesn't move, as it was laid.
    fn at_rest(model: Model, watch: Watch) -> Self {
        let mut state = model.state();
        state.v.fill(0.0);
        let audit = Audit::start(model.energy(&state.at()));
        let (critical, remarks) = (Vec::new(), Vec::new());
        let (model, counts) = (Arc::new(model), Counts::default());
        Done { model, state, audit, counts, flutter: 0.0, critical, remarks, times: None, watch }
    }

    /// The critical loads for summaries.
    pub(crate) fn critical_loads(&self) -> Vec<CriticalLoad> {
        let load = |c: &Critical| CriticalLoad {
            load_factor: c.t,
            kind: c.kind,
            directions: c.directions,
            what: c.what.clone(),
        };
        self.critical.iter().map(load).collect()
    }

    /// One equilibrium after the other; each starts from the one before.
    fn go(&mut self, scene: &Scene, observer: &mut dyn Observer) -> Result<End, Error> {
        let model = self.model.clone();
        let mut search = Statics::relative(&model, &scene.statics, scene.run.frame).map_err(no_memory)?;
        let watch = self.watch;
        search.stop_if(move || watch.is_over());
        if self.times.is_some() {
            search.profile();
        }
        let end = self.follow(&mut search, scene, observer);
        if let Some(times) = &mut self.times {
            *times = search.times();
        }
        end
    }

    fn follow(
        &mut self,
        search: &mut Statics<'_>,
        scene: &Scene,
        observer: &mut dyn Observer,
    ) -> Result<End, Error> {
        let steps = scene.statics.steps.max(1);
        let model = self.model.clone();
        let telling: Vec<_> = model.events().iter().filter(|e| e.only_tells()).collect();
        let mut levels = vec![None; telling.len()];
        let mut free = 0;
        for k in 0..=steps {
            let before = self.state.t;
            let found = match k {
                0 => search.find(&mut self.state, true),
                _ => search.follow(&mut self.state, scene.run.duration * k as f64 / steps as f64),
            };
            // what was met on the way is part of the path, also of one that ends there
            for critical in search.critical().iter().skip(self.critical.len()) {
                if self.show(&critical.state, observer).is_break() {
                    return Ok(End::Stopped { by: "observer".into() });
                }
            }
            self.critical = search.critical().to_vec();
            unseen_by(search).into_iter().for_each(|remark| self.remark(remark));
            let found = found?;
            // of several free directions of bodies another mixture is found at every load: once is enough
            let count = search.neutral().len();
            remarks_on(search).into_iter().skip(free.min(count)).for_each(|remark| self.remark(remark));
            free = free.max(count);
            for (event, level) in telling.iter().zip(&mut levels) {
                let now = event.value(&model, &self.state);
                if crossed(*level, now, event.direction()) {
                    observer.event(&event.report(&model, &self.state), self.state.t);
                }
                *level = Some(now);
            }
            self.flutter = self.flutter.max(found.flutter);
            self.counts.steps += 1;
            self.counts.newton_iterations += u64::from(found.iterations);
            self.counts.factorizations += u64::from(found.iterations);
            // work isn't followed along the path: the balance begins anew at every equilibrium
            self.audit = Audit::start(self.model.energy(&self.state.at()));
            let report = StepReport {
                h: self.state.t - before,
                iterations: found.iterations,
                ..StepReport::default()
            };
            let flow = [self.show(&self.state, observer), observer.step(&self.model, &self.state, &report)];
            if flow.iter().any(ControlFlow::is_break) {
                return Ok(End::Stopped { by: "observer".into() });
            }
        }
        Ok(End::Done)
    }

    /// Says something once.
    fn remark(&mut self, text: String) {
        if !self.remarks.contains(&text) {
            self.remarks.push(text);
        }
    }

    /// Shows an equilibrium to the observer.
    fn show(&self, state: &State, observer: &mut dyn Observer) -> ControlFlow<()> {
        let sample = Sample { model: &self.model, at: state.at(), lambda: &state.lambda, audit: &self.audit };
        observer.sample(&sample)?;
        if observer.wants_look(state.t) { observer.look(&sample) } else { ControlFlow::Continue(()) }
    }
}

/// Whether the value of an event has changed its sign the way that it tells of, or begins beyond it.
fn crossed(before: Option<f64>, now: f64, direction: i8) -> bool {
    let (up, down) = (before.unwrap_or(-1.0) <= 0.0 && now > 0.0, before.unwrap_or(1.0) >= 0.0 && now < 0.0);
    match direction {
        0 => before.is_some() && (up || down),
        1.. => up,
        _ => down,
    }
}

/// Where the path of equilibria was left for a leap.
pub(crate) fn unseen_by(search: &Statics<'_>) -> Vec<String> {
    let stretch = |[from, to]: &[f64; 2]| {
        format!(
            "between {from:.6} and {to:.6} of the load the equilibrium moved farther than its path explains, and the path there \
             couldn't be followed: a load at which something gives way may have been passed. Look closer: more `steps`, or \
             what is small and what is large in scenes of their own"
        )
    };
    search.unseen().iter().map(stretch).collect()
}

/// What one should know about the last equilibrium of a search.
fn remarks_on(search: &Statics<'_>) -> Vec<String> {
    let free = search.neutral().iter().map(|n| match &n.line {
        // said once of a line, in however many directions it can be laid
        Some(line) => format!(
            "`{line}` could as well lie otherwise: nothing holds its shape where it is slack, or on ground that doesn't rub, and \
             this is one of many. Bending stiffness (`ei` of its section) would hold it, and on ground friction, which takes \
             part in equilibria by `equilibrium = \"laid\"`"
        ),
        None => format!(
            "nothing holds the equilibrium in one direction, and nothing drives it there: {}. A constraint or a spring \
             against this motion would hold it",
            n.what
        ),
    });
    free.chain(search.doubt().map(String::from)).collect()
}

fn no_memory(source: SolveError) -> Error {
    Error::Step(StepError::Linear { t: 0.0, source, unknown: "the structure of the equations".into() })
}

/// What to say of dry friction at an equilibrium: that it takes no part, or which way it acts.
fn by_friction(model: &Model) -> Vec<String> {
    let mut kinds: Vec<(Option<&str>, Vec<String>)> = Vec::new();
    for term in model.terms() {
        let Some(remembers) = term.remembers() else { continue };
        let kind = remembers.sliding();
        if remembers.rests() && kind.is_none() {
            continue;
        }
        let label = format!("`{}`", term.label());
        match kinds.iter_mut().find(|(other, _)| *other == kind) {
            Some((_, labels)) => labels.push(label),
            None => kinds.push((kind, vec![label])),
        }
    }
    let say = |(kind, labels): (Option<&str>, Vec<String>)| match kind {
        None => format!(
            "the equilibrium is that without the friction of {}: with it there are many, and which one is reached depends on \
             the way there. From here on in time friction holds what it can",
            labels.join(", ")
        ),
        Some(kind) => {
            format!("the equilibrium is that of {kind}, with the friction of {}", labels.join(", "))
        }
    };
    kinds.into_iter().map(say).collect()
}
