//! A scene in motion.

use crate::scene::{Source, raise};
use crate::watch::{LOOK, watched};
use pyo3::prelude::*;
use pyo3::sync::MutexExt;
use pyo3::types::{PyByteArray, PyBytes};
use ropewalk::scene::Fault;
use ropewalk::{Error, Session, Snapshot};
use std::ops::ControlFlow;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Instant;

/// A run in time that is moved from outside.
#[pyclass(module = "ropewalk._native", frozen)]
pub struct Simulation(Mutex<Session>);

/// Moves on to `end`, or by one step; the exception of a signal that came meanwhile.
fn advance(session: &mut Session, end: f64, once: bool) -> Result<Option<PyErr>, Error> {
    let (mut looked, mut raised) = (Instant::now(), None);
    session.advance_while(end, &mut || {
        if looked.elapsed() >= LOOK {
            looked = Instant::now();
            raised = Python::attach(|py| py.check_signals()).err();
        }
        if once || raised.is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    })?;
    Ok(raised)
}

impl Simulation {
    /// Does something that takes its time, while Python's interpreter is free for others.
    fn detached<T: Send>(
        &self,
        py: Python<'_>,
        act: impl FnOnce(&mut Session) -> Result<T, Error> + Send,
    ) -> PyResult<T> {
        let done = py.detach(|| act(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner)));
        done.map_err(|e| raise(py, &e))
    }

    fn lock(&self, py: Python<'_>) -> MutexGuard<'_, Session> {
        // whoever holds it may wait for the interpreter
        self.0.lock_py_attached(py).unwrap_or_else(PoisonError::into_inner)
    }
}

#[pymethods]
impl Simulation {
    #[new]
    fn new(py: Python<'_>, source: &Source, set: Vec<String>) -> PyResult<Self> {
        let (made, exception) = watched(py, None, |watch| Session::start(source.open(&set)?, watch))?;
        exception.map_or(Ok(()), Err)?;
        Ok(Simulation(Mutex::new(made.map_err(|e| raise(py, &e))?)))
    }

    /// Moves on by `dt`, at most to the end of the run.
    fn advance_by(&self, py: Python<'_>, dt: f64) -> PyResult<()> {
        let raised = self.detached(py, |session| {
            let end = (session.t() + dt).min(session.duration());
            advance(session, end, false)
        })?;
        raised.map_or(Ok(()), Err)
    }

    /// Moves on to the time `t`, or by one step of the solver towards it; not if that has passed.
    fn advance_to(&self, py: Python<'_>, t: f64, once: bool) -> PyResult<bool> {
        let act = |session: &mut Session| match session.t() <= t {
            true => advance(session, t, once).map(Some),
            false => Ok(None),
        };
        self.detached(py, act)?.map_or(Ok(false), |raised| raised.map_or(Ok(true), Err))
    }

    #[getter]
    fn t(&self, py: Python<'_>) -> f64 {
        self.lock(py).t()
    }
    #[getter]
    fn duration(&self, py: Python<'_>) -> f64 {
        self.lock(py).duration()
    }
    #[getter]
    fn stopped_by(&self, py: Python<'_>) -> Option<String> {
        self.lock(py).stopped_by().map(String::from)
    }
    #[getter]
    fn warnings(&self, py: Python<'_>) -> Vec<String> {
        self.lock(py).warnings().to_vec()
    }
    #[getter]
    fn title(&self, py: Python<'_>) -> String {
        self.lock(py).file().title().to_string()
    }
    /// Steps of the solver so far, and those that were repeated with a smaller one.
    #[getter]
    fn steps(&self, py: Python<'_>) -> (u64, u64) {
        let counts = self.lock(py).counts();
        (counts.steps, counts.rejected)
    }
    /// Names and units of the columns.
    fn columns(&self, py: Python<'_>) -> Vec<(String, String)> {
        self.lock(py).columns().iter().map(|c| (c.name.clone(), c.unit.clone())).collect()
    }
    /// The records at the present instant.
    fn values<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyByteArray>> {
        let row = self.detached(py, |session| session.values().map(<[f64]>::to_vec))?;
        Ok(crate::bytes(py, [row.as_slice()]))
    }
    /// One column of them.
    fn value(&self, py: Python<'_>, k: usize) -> PyResult<f64> {
        let value = self.lock(py).values().map(|row| row.get(k).copied().unwrap_or(f64::NAN));
        value.map_err(|e| raise(py, &e))
    }

    /// Name, unit, present value, least and greatest value of each input.
    fn inputs(&self, py: Python<'_>) -> Vec<(String, String, f64, f64, f64)> {
        let session = self.lock(py);
        let describe = |i: &std::sync::Arc<ropewalk::core::Input>| {
            let [least, most] = i.limits();
            (i.name().to_string(), i.unit().to_string(), i.value(session.t()), least, most)
        };
        session.inputs().iter().map(describe).collect()
    }
    /// Sets an input from here on.
    fn set_input(&self, py: Python<'_>, name: &str, value: f64) -> PyResult<()> {
        self.lock(py).set_input(name, value).map_err(|e| raise(py, &e))
    }

    /// The complete state, to be restored to the last bit. Kept factors are dropped, as restoring does.
    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let made = self.detached(py, |session| {
            let unwritten = |e: postcard::Error| Fault::new(format!("the state can't be written: {e}"));
            Ok(postcard::to_stdvec(&session.snapshot()?).map_err(unwritten)?)
        })?;
        Ok(PyBytes::new(py, &made))
    }

    /// Goes back, or on, to a state.
    fn restore(&self, py: Python<'_>, state: &[u8]) -> PyResult<()> {
        self.detached(py, |session| {
            let unreadable =
                |e: postcard::Error| Fault::new(format!("this is no state of a simulation: {e}"));
            let snapshot: Snapshot = postcard::from_bytes(state).map_err(unreadable)?;
            session.restore(snapshot)
        })
    }
}
