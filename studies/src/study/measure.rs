//! A run in memory whose time is measured.

use crate::error::Error;
use crate::run::{Counts, Ending, Recorder, Started};
use ropewalk_core::V3;
use ropewalk_report::{Interrupt, Progress, Stopwatch, Table};
use ropewalk_scene::{Fault, SceneFile};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::Instant;

/// Stack of a thread that runs scenes: as large as that of the main thread usually is.
const STACK: usize = 8 << 20;

/// What may stop a run.
#[derive(Clone, Copy, Default)]
pub struct Watch {
    /// Ctrl-C.
    pub interrupt: Option<Interrupt>,
    /// When the time is up.
    pub deadline: Option<Instant>,
}

impl Watch {
    /// Whether it is time to stop.
    pub(crate) fn is_over(&self) -> bool {
        self.is_interrupted() || self.deadline.is_some_and(|d| Instant::now() >= d)
    }
    /// Whether Ctrl-C was pressed.
    pub fn is_interrupted(&self) -> bool {
        self.interrupt.is_some_and(Interrupt::requested)
    }
}

/// What a run came to.
pub struct Measured {
    /// The history, as far as it was computed.
    pub history: Table,
    /// Positions of all nodes at some rows of the history, if they were asked for.
    pub positions: Vec<Vec<V3<f64>>>,
    /// Length by which positions are measured [m].
    pub length: f64,
    /// CPU time of building and running, without output to files [s].
    pub cpu_s: f64,
    /// How much work it was.
    pub counts: Counts,
    /// Why there is no result, if so.
    pub failure: Option<String>,
    /// Whether it was stopped from outside before its end.
    pub stopped: bool,
}

/// Runs a scene; a run that fails is a result too.
pub fn measure(file: &SceneFile, with_positions: bool, watch: Watch, progress: Progress) -> Measured {
    let stopwatch = Stopwatch::start();
    // a defect that shows in one run must not take the others with it
    let done = catch_unwind(AssertUnwindSafe(|| go(file, with_positions, watch, progress)));
    let mut measured = match done {
        Ok(Ok(measured)) => measured,
        Ok(Err(e)) => Measured::failed(match e {
            Error::File(fault) => fault.message,
            e => e.to_string(),
        }),
        Err(_) => Measured::failed("an internal error, see above: please report it".into()),
    };
    measured.cpu_s = stopwatch.elapsed().cpu_s;
    measured
}

fn go(file: &SceneFile, with_positions: bool, watch: Watch, progress: Progress) -> Result<Measured, Error> {
    let scene = file.scene();
    let model = file.build()?;
    let length = model.length();
    let mut recorder = Recorder::new(scene, file.records(&model)?);
    (recorder.interrupt, recorder.deadline) = (watch.interrupt, watch.deadline);
    recorder.progress = Some(progress);
    recorder.track = with_positions.then(Vec::new);
    let mut started = Started::new(scene, model)?;
    let ending = started.go(scene, &mut recorder, false);
    if let Some(progress) = recorder.progress.take() {
        progress.finish("");
    }
    let failure = match &ending {
        Ending::Failed(e) => Some(e.to_string()),
        _ => None,
    };
    let positions = recorder.track.take().unwrap_or_default();
    let (history, counts) = (recorder.table, started.done().counts);
    let stopped = matches!(ending, Ending::Interrupted);
    Ok(Measured { history, positions, length, cpu_s: f64::NAN, counts, failure, stopped })
}

impl Measured {
    pub(crate) fn failed(message: String) -> Self {
        Measured {
            history: Table::default(),
            positions: Vec::new(),
            length: f64::NAN,
            cpu_s: f64::NAN,
            counts: Counts::default(),
            failure: Some(message),
            stopped: false,
        }
    }
}

/// Does this on a pool of as many threads as there are cores.
///
/// # Errors
/// The system gives no threads.
pub fn on_all_cores<T: Send>(work: impl FnOnce() -> T + Send) -> Result<T, Fault> {
    let pool = rayon::ThreadPoolBuilder::new().stack_size(STACK).build();
    Ok(pool.map_err(|e| Fault::new(format!("no threads to compute on: {e}")))?.install(work))
}
