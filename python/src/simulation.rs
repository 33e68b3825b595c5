//! A scene in motion.

use crate::scene::{Source, raise};
use crate::watch::{LOOK, watched};
use pyo3::prelude::*;
use pyo3::sync::MutexExt;
use pyo3::types::{PyByteArray, PyBytes};
use ropewalk::core::integrator::StepReport;
use ropewalk::core::{Checkpoint, End, Model, Observer, Record, Sample, Unfit};
use ropewalk::scene::Fault;
use ropewalk::{Error, SceneFile, State};
use std::ops::ControlFlow;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

/// A run in time that is moved from outside.
#[pyclass(module = "ropewalk._native", frozen)]
pub struct Simulation(Mutex<Inner>);

struct Inner {
    file: SceneFile,
    simulation: ropewalk::Simulation,
    records: Vec<Box<dyn Record>>,
    /// The model that the records are bound to.
    bound: Option<Arc<Model>>,
    /// The records at the present instant, once they were asked for.
    row: Option<Vec<f64>>,
    stopped_by: Option<String>,
    warnings: Vec<String>,
}

/// Looks at every step, and stops for signals or after one step; takes no samples.
struct Steps<'a> {
    once: bool,
    looked: Instant,
    raised: Option<PyErr>,
    warnings: &'a mut Vec<String>,
}

impl Observer for Steps<'_> {
    fn step(&mut self, _: &Model, _: &State, _: &StepReport) -> ControlFlow<()> {
        if self.looked.elapsed() >= LOOK {
            self.looked = Instant::now();
            self.raised = Python::attach(|py| py.check_signals()).err();
        }
        if self.once || self.raised.is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
    fn warn(&mut self, text: &str) {
        self.warnings.push(text.into());
    }
}

/// Evaluates the records.
struct Look<'a> {
    records: &'a [Box<dyn Record>],
    row: Vec<f64>,
}

impl Observer for Look<'_> {
    fn needs_forces(&self) -> bool {
        self.records.iter().any(|r| r.needs_forces())
    }
    fn sample(&mut self, s: &Sample<'_>) -> ControlFlow<()> {
        self.row.clear();
        self.records.iter().for_each(|r| r.sample(s, &mut self.row));
        ControlFlow::Continue(())
    }
}

impl Inner {
    /// The records, which are bound to a model: another one if the mesh has changed.
    fn bind(&mut self) -> Result<(), Error> {
        let model = &self.simulation.model;
        if !self.bound.as_ref().is_some_and(|bound| Arc::ptr_eq(bound, model)) {
            self.records = self.file.records(model)?;
            self.bound = Some(model.clone());
        }
        Ok(())
    }

    /// Moves on to `end`, or by one step; the exception of a signal that came meanwhile.
    fn advance(&mut self, end: f64, once: bool) -> Result<Option<PyErr>, Error> {
        let span = end - self.simulation.state.t;
        if self.stopped_by.is_some() || !(span > 0.0) {
            return Ok(None);
        }
        self.row = None;
        let mut steps = Steps { once, looked: Instant::now(), raised: None, warnings: &mut self.warnings };
        let done = self.simulation.advance(end, span, &mut steps);
        let raised = steps.raised.take();
        if let End::Stopped { by } = done?
            && raised.is_none()
            && !(once && by == "interrupt")
        {
            self.stopped_by = Some(by);
        }
        Ok(raised)
    }

    /// The records at the present instant.
    fn look(&mut self) -> Result<&[f64], Error> {
        if self.row.is_none() {
            self.bind()?;
            let mut look = Look { records: &self.records, row: Vec::new() };
            // an advance that goes nowhere takes one sample
            self.simulation.advance(self.simulation.state.t, 1.0, &mut look)?;
            self.row = Some(look.row);
        }
        Ok(self.row.as_deref().unwrap_or_default())
    }
}

impl Simulation {
    fn forward(
        &self,
        py: Python<'_>,
        go: impl FnOnce(&mut Inner) -> Result<Option<PyErr>, Error> + Send,
    ) -> PyResult<()> {
        let done = py.detach(|| go(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner)));
        done.map_err(|e| raise(py, &e))?.map_or(Ok(()), Err)
    }

    fn lock(&self, py: Python<'_>) -> MutexGuard<'_, Inner> {
        // whoever holds it may wait for the interpreter
        self.0.lock_py_attached(py).unwrap_or_else(PoisonError::into_inner)
    }
}

#[pymethods]
impl Simulation {
    #[new]
    fn new(py: Python<'_>, source: &Source, set: Vec<String>) -> PyResult<Self> {
        let (made, exception) = watched(py, None, |watch| {
            let file = source.open(&set)?;
            let (simulation, warnings) =
                ropewalk::start(file.scene(), watch).map_err(|e| e.in_file(&file))?;
            let (records, bound, row, stopped_by) = (Vec::new(), None, None, None);
            let mut inner = Inner { file, simulation, records, bound, row, stopped_by, warnings };
            inner.bind()?;
            Ok(inner)
        })?;
        exception.map_or(Ok(()), Err)?;
        Ok(Simulation(Mutex::new(made.map_err(|e| raise(py, &e))?)))
    }

    /// Moves on by `dt`, at most to the end of the run.
    fn advance_by(&self, py: Python<'_>, dt: f64) -> PyResult<()> {
        self.forward(py, |inner| {
            let end = (inner.simulation.state.t + dt).min(inner.file.scene().run.duration);
            inner.advance(end, false)
        })
    }

    /// Moves on to the time `t`, or by one step of the solver towards it.
    fn advance_to(&self, py: Python<'_>, t: f64, once: bool) -> PyResult<()> {
        self.forward(py, |inner| inner.advance(t, once))
    }

    #[getter]
    fn t(&self, py: Python<'_>) -> f64 {
        self.lock(py).simulation.state.t
    }
    #[getter]
    fn duration(&self, py: Python<'_>) -> f64 {
        self.lock(py).file.scene().run.duration
    }
    #[getter]
    fn stopped_by(&self, py: Python<'_>) -> Option<String> {
        self.lock(py).stopped_by.clone()
    }
    #[getter]
    fn warnings(&self, py: Python<'_>) -> Vec<String> {
        self.lock(py).warnings.clone()
    }
    #[getter]
    fn title(&self, py: Python<'_>) -> String {
        self.lock(py).file.title().to_string()
    }
    /// Steps of the solver so far, and those that were repeated with a smaller one.
    #[getter]
    fn steps(&self, py: Python<'_>) -> (u64, u64) {
        let counts = self.lock(py).simulation.work.counts;
        (counts.steps, counts.rejected)
    }
    /// Names and units of the columns.
    fn columns(&self, py: Python<'_>) -> Vec<(String, String)> {
        let inner = self.lock(py);
        let all = inner.records.iter().flat_map(|r| r.columns());
        all.map(|c| (c.name, if c.unit == "1" { String::new() } else { c.unit })).collect()
    }
    /// The records at the present instant.
    fn values<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyByteArray>> {
        let row = py.detach(|| {
            let mut inner = self.0.lock().unwrap_or_else(PoisonError::into_inner);
            inner.look().map(<[f64]>::to_vec)
        });
        Ok(crate::bytes(py, [row.map_err(|e| raise(py, &e))?.as_slice()]))
    }
    /// One column of them.
    fn value(&self, py: Python<'_>, k: usize) -> PyResult<f64> {
        let value = self.lock(py).look().map(|row| row.get(k).copied().unwrap_or(f64::NAN));
        value.map_err(|e| raise(py, &e))
    }

    /// The complete state, to be restored to the last bit. Kept factors are dropped, as restoring does.
    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let made = py.detach(|| -> Result<Vec<u8>, Error> {
            let mut inner = self.0.lock().unwrap_or_else(PoisonError::into_inner);
            let checkpoint = inner.simulation.checkpoint()?;
            let all = (checkpoint, inner.stopped_by.clone());
            postcard::to_stdvec(&all)
                .map_err(|e| Fault::new(format!("the state can't be written: {e}")).into())
        });
        Ok(PyBytes::new(py, &made.map_err(|e| raise(py, &e))?))
    }

    /// Goes back, or on, to a state.
    fn restore(&self, py: Python<'_>, state: &[u8]) -> PyResult<()> {
        let done = py.detach(|| -> Result<(), Error> {
            let unreadable =
                |e: postcard::Error| Fault::new(format!("this is no state of a simulation: {e}"));
            let (checkpoint, stopped_by): (Checkpoint, Option<String>) =
                postcard::from_bytes(state).map_err(unreadable)?;
            let mut inner = self.0.lock().unwrap_or_else(PoisonError::into_inner);
            let scene = inner.file.scene();
            let mut model = inner.file.build()?;
            if !checkpoint.meshes.is_empty() {
                model = scene.build_on(&checkpoint.meshes)?;
            }
            let restored =
                ropewalk::Simulation::restore(model, &scene.solver, scene.run.duration, checkpoint);
            inner.simulation = restored.map_err(|e| match e {
                Unfit::Step(e) => Error::from(e),
                e => Fault::new(e.to_string()).into(),
            })?;
            let audit = inner.file.scene().run.audit;
            inner.simulation.keep_audit(audit);
            inner.stopped_by = stopped_by;
            inner.row = None;
            inner.bind()
        });
        done.map_err(|e| raise(py, &e))
    }
}
