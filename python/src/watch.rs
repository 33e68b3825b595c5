//! Ctrl-C while something computes: Python's handlers decide, and what computes is asked to stop.

use pyo3::prelude::*;
use ropewalk::{Error, Watch};
use std::panic::resume_unwind;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread::{self, Thread};
use std::time::Duration;

/// How often Python is asked whether it has caught a signal.
pub const LOOK: Duration = Duration::from_millis(5);
/// Stack of a thread that computes: as large as that of the main thread usually is.
const STACK: usize = 8 << 20;

/// Flags that nobody watches at present. There are never more of them than runs were going on at the same time.
static FREE: Mutex<Vec<&'static AtomicBool>> = Mutex::new(Vec::new());

/// A flag of one's own.
struct Flag(&'static AtomicBool);

impl Flag {
    fn take() -> Self {
        let free = FREE.lock().unwrap_or_else(PoisonError::into_inner).pop();
        let flag = free.unwrap_or_else(|| Box::leak(Box::default()));
        flag.store(false, Ordering::Relaxed);
        Flag(flag)
    }
}

impl Drop for Flag {
    fn drop(&mut self) {
        FREE.lock().unwrap_or_else(PoisonError::into_inner).push(self.0);
    }
}

/// Stops runs in other threads.
#[pyclass(module = "ropewalk._native", frozen)]
pub struct Stop(Flag);

#[pymethods]
impl Stop {
    #[new]
    fn new() -> Self {
        Stop(Flag::take())
    }
    /// Stops all runs that were given this.
    fn set(&self) {
        self.0.0.store(true, Ordering::Relaxed);
    }
    #[getter]
    fn is_set(&self) -> bool {
        self.0.0.load(Ordering::Relaxed)
    }
}

/// Computes on a thread of its own while this one waits for Ctrl-C and other signals, which only Python's main thread
/// gets. The result, and the exception that a signal raised: then the result is what there was until then. With `stop` it
/// is computed here, until that stops it.
pub fn watched<T: Send>(
    py: Python<'_>,
    stop: Option<&Stop>,
    work: impl FnOnce(Watch) -> Result<T, Error> + Send,
) -> PyResult<(Result<T, Error>, Option<PyErr>)> {
    if let Some(Stop(flag)) = stop {
        let flag = flag.0;
        return Ok((py.detach(|| work(Watch::flag(flag))), None));
    }
    let flag = Flag::take();
    let (mut raised, over) = (None, AtomicBool::new(false));
    let done = py.detach(|| {
        thread::scope(|scope| {
            let watch = Watch::flag(flag.0);
            let ended = Ended { is: &over, waiting: thread::current() };
            let work = move || {
                let _ended = ended;
                // known to Python from the start: functions that are called from here would make it so each time
                Python::attach(|py| py.detach(|| work(watch)))
            };
            let worker =
                thread::Builder::new().name("ropewalk".into()).stack_size(STACK).spawn_scoped(scope, work)?;
            wait(&over, flag.0, &mut raised);
            Ok::<_, std::io::Error>(worker.join().unwrap_or_else(|panic| resume_unwind(panic)))
        })
    })?;
    match (done, raised) {
        (Err(Error::Interrupted), Some(e)) => Err(e),
        (done, raised) => Ok((done, raised)),
    }
}

/// Tells who waits that the work is over, also if it panics. A thread itself has not finished when it says so, and who
/// asked it would wait once more.
struct Ended<'a> {
    is: &'a AtomicBool,
    waiting: Thread,
}

impl Drop for Ended<'_> {
    fn drop(&mut self) {
        self.is.store(true, Ordering::Release);
        self.waiting.unpark();
    }
}

fn wait(over: &AtomicBool, flag: &AtomicBool, raised: &mut Option<PyErr>) {
    while !over.load(Ordering::Acquire) {
        thread::park_timeout(LOOK);
        // of several signals the first one counts, the others have nothing left to stop
        if let Err(e) = Python::attach(|py| py.check_signals()) {
            flag.store(true, Ordering::Relaxed);
            raised.get_or_insert(e);
        }
    }
}
