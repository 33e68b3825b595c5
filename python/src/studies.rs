//! What is asked of many runs of a scene: what accuracy costs, what effects do, how far a run can be trusted; and sweeps of
//! the command line whose runs workers compute.

use crate::scene::{Source, raise};
use crate::watch::{Stop, watched};
use pyo3::exceptions::PySystemExit;
use pyo3::prelude::*;
use ropewalk::report::ProgressMode;
use ropewalk::scene::{Fault, Sampling};
use ropewalk::{CostOptions, EffectsOptions, Error};
use serde_json::json;
use std::path::PathBuf;
use std::time::Duration;

/// What accuracy costs, into the folder `out`: advice and more as JSON.
#[pyfunction]
pub fn cost(
    py: Python<'_>,
    source: &Source,
    set: Vec<String>,
    of: String,
    budget: f64,
    out: PathBuf,
    fresh: bool,
) -> PyResult<String> {
    let (done, exception) = watched(py, None, |watch| {
        let budget = Duration::try_from_secs_f64(budget)
            .map_err(|_| Fault::new(format!("{budget} s is no time to spend")))?;
        let progress = ProgressMode::Quiet;
        let options = CostOptions { of, set, out: Some(out), fresh, budget, progress, watch };
        ropewalk::cost_of(source.scene_text(), &options)
    })?;
    exception.map_or(Ok(()), Err)?;
    let outcome = done.map_err(|e| raise(py, &e))?;
    let about =
        json!({ "advice": outcome.advice, "uncertainty": outcome.uncertainty, "report": outcome.report });
    Ok(about.to_string())
}

/// What the effects of a scene cost and do, as JSON.
#[pyfunction]
pub fn effects(
    py: Python<'_>,
    source: &Source,
    set: Vec<String>,
    of: String,
    accuracy: f64,
) -> PyResult<String> {
    let (done, exception) = watched(py, None, |watch| {
        let file = source.open(&set)?;
        let options = EffectsOptions { accuracy, watch, ..EffectsOptions::default() };
        ropewalk::effects(file.scene(), &of, &options).map_err(|e| e.in_file(&file))
    })?;
    exception.map_or(Ok(()), Err)?;
    Ok(json!(done.map_err(|e| raise(py, &e))?).to_string())
}

/// How far a run can be trusted, as JSON.
#[pyfunction]
#[pyo3(signature = (source, set, of=None))]
pub fn certify(py: Python<'_>, source: &Source, set: Vec<String>, of: Option<String>) -> PyResult<String> {
    let (done, exception) = watched(py, None, |watch| {
        ropewalk::certify_scene(source.scene_text(), &set, of.as_deref(), watch)?.ok_or(Error::Interrupted)
    })?;
    exception.map_or(Ok(()), Err)?;
    let certificate = done.map_err(|e| raise(py, &e))?;
    let mut about = json!(certificate);
    (about["holds"], about["text"]) = (json!(certificate.holds()), json!(certificate.text()));
    Ok(about.to_string())
}

/// Values drawn from a range, as `--vary NAME=FROM..TO` draws them; none if the text is no range.
#[pyfunction]
pub fn samples(
    py: Python<'_>,
    name: &str,
    range: &str,
    count: usize,
    seed: u64,
    latin: bool,
) -> PyResult<Option<Vec<String>>> {
    let drawn = Sampling { count, seed, latin }.draw(&format!("{name}={range}"));
    Ok(drawn.map_err(|e| raise(py, &e.into()))?.map(|varied| varied.values))
}

/// A sweep of the command line whose runs are computed elsewhere.
#[pyclass(module = "ropewalk._native", frozen)]
pub struct SharedSweep(ropewalk::cli::SharedSweep);

#[pymethods]
impl SharedSweep {
    /// Reads the arguments of the command; what is wrong with them is said on standard error.
    #[new]
    fn new(arguments: Vec<String>) -> PyResult<Self> {
        let read = ropewalk::cli::SharedSweep::parse(&arguments, ropewalk::scenes());
        read.map(SharedSweep).map_err(PySystemExit::new_err)
    }
    /// The scheduler.
    #[getter]
    fn address(&self) -> Option<&str> {
        self.0.address()
    }
    /// Prepares the folder: its path, the number of runs, those that are missing, and the arguments for workers.
    fn plan(&self, py: Python<'_>) -> PyResult<(PathBuf, usize, Vec<usize>, Vec<String>)> {
        let (planned, words) = py.detach(|| self.0.plan()).map_err(|e| raise(py, &e))?;
        Ok((planned.folder, planned.runs, planned.missing, words))
    }
    /// Computes some of the runs: how many of them are complete, and how many failed.
    fn compute(&self, py: Python<'_>, runs: Vec<usize>, stop: &Stop) -> PyResult<(usize, usize)> {
        let (done, _) = watched(py, Some(stop), |watch| self.0.compute(&runs, watch))?;
        let done = done.map_err(|e| raise(py, &e))?;
        Ok((done.runs.1, done.failed))
    }
}
