//! The Python module `ropewalk._native`: thin, whatever isn't computing is written in Python.
//!
//! Arrays go over as bytes, texts as JSON. Python's interpreter is free for other threads while anything computes, and no
//! signal handler is installed: Ctrl-C stays Python's.

mod functions;
mod linearise;
mod scene;
mod simulation;
mod studies;
mod watch;

use pyo3::prelude::*;
use pyo3::types::{PyByteArray, PyTuple};
use ropewalk::core::modes::Mode;
use ropewalk::report::{ProgressMode, Table};
use ropewalk::scene::{SECTIONS, lists, registered};
use ropewalk::studies::run::Manifest;
use ropewalk::{ModesOptions, RunOptions, Status};
use scene::{Source, raise};
use serde_json::json;
use std::ffi::OsString;
use std::path::PathBuf;
use watch::{Stop, watched};

/// Everything of a run: its columns as one array, the rest as JSON, and the exception that ended it early.
type Ran<'py> = (Bound<'py, PyByteArray>, String, Option<PyErr>);

/// Numbers as the bytes of one array, column after column.
fn bytes<'py, 'a>(py: Python<'py>, columns: impl IntoIterator<Item = &'a [f64]>) -> Bound<'py, PyByteArray> {
    let all: Vec<u8> = columns.into_iter().flatten().flat_map(|x| x.to_ne_bytes()).collect();
    PyByteArray::new(py, &all)
}

/// A table, and names and units of its columns.
fn columns<'py>(py: Python<'py>, table: &Table) -> (Bound<'py, PyByteArray>, serde_json::Value) {
    let heads: Vec<_> = table.columns.iter().map(|c| [&c.name, &c.unit]).collect();
    (bytes(py, table.columns.iter().map(|c| c.values.as_slice())), json!(heads))
}

/// Runs a scene in memory, or into the folder `out`.
#[pyfunction]
#[pyo3(signature = (source, set, out=None, stop=None))]
fn run<'py>(
    py: Python<'py>,
    source: &Source,
    set: Vec<String>,
    out: Option<PathBuf>,
    stop: Option<&Stop>,
) -> PyResult<Ran<'py>> {
    let (done, exception) = watched(py, stop, |watch| {
        let file = source.open(&set)?;
        let (table, summary, folder, cause) = match out {
            Some(out) => {
                let options = RunOptions {
                    out: Some(out),
                    progress: ProgressMode::Quiet,
                    watch,
                    ..RunOptions::default()
                };
                let outcome = ropewalk::run(&file, &options, &mut |_| {})?;
                let folder = outcome.folder.path().to_path_buf();
                (outcome.history, outcome.summary, Some(folder), functions::cause(outcome.error.as_ref()))
            }
            None => {
                let history = ropewalk::simulate_with(file.scene(), watch).map_err(|e| e.in_file(&file))?;
                let unused = file.document().unused_parameters().into_iter();
                let unused = unused.map(|name| format!("parameter `{name}` is not used by the scene"));
                let mut summary = history.summary();
                summary.warnings.splice(0..0, unused);
                let cause = functions::cause(history.error());
                (history.table, summary, None, cause)
            }
        };
        let about = json!({
            "title": file.title(), "name": file.name(), "scene": file.document().to_toml(), "folder": folder,
            "failed": summary.status == Status::Failed, "summary": summary,
        });
        Ok((table, about, cause))
    })?;
    let (table, mut about, cause) = done.map_err(|e| raise(py, &e))?;
    let (data, heads) = columns(py, &table);
    about["columns"] = heads;
    let exception = exception.or_else(|| cause.map(|broken| functions::raise(py, &broken)));
    Ok((data, about.to_string(), exception))
}

/// Reads the history of a run folder.
#[pyfunction]
fn read_history(py: Python<'_>, path: PathBuf) -> PyResult<(Bound<'_, PyByteArray>, String)> {
    let table = Table::read(&path).map_err(|e| raise(py, &e.into()))?;
    let (data, heads) = columns(py, &table);
    Ok((data, heads.to_string()))
}

/// Builds a scene without running it: what it consists of, as JSON and as text.
#[pyfunction]
fn check(py: Python<'_>, source: &Source, set: Vec<String>) -> PyResult<(String, String)> {
    let (done, exception) = watched(py, None, |_| {
        let file = source.open(&set)?;
        let model = file.build()?;
        let manifest = Manifest::new(&file, &model)?;
        let mut about = json!(manifest);
        about["unused"] = json!(file.document().unused_parameters());
        Ok((about.to_string(), manifest.to_string()))
    })?;
    exception.map_or(Ok(()), Err)?;
    done.map_err(|e| raise(py, &e))
}

/// Vibration modes: the table, shapes in space at the nodes, and what else is to be said.
#[pyfunction]
#[pyo3(signature = (source, set, count, at=None))]
fn modes<'py>(
    py: Python<'py>,
    source: &Source,
    set: Vec<String>,
    count: usize,
    at: Option<f64>,
) -> PyResult<(Bound<'py, PyByteArray>, Bound<'py, PyByteArray>, String)> {
    let (done, exception) = watched(py, None, |watch| {
        let file = source.open(&set)?;
        let options = ModesOptions { count, time: at, watch, ..ModesOptions::default() };
        ropewalk::modes(file.scene(), &options)
            .map(|m| (m, file.title().to_string()))
            .map_err(|e| e.in_file(&file))
    })?;
    exception.map_or(Ok(()), Err)?;
    let (modal, title) = done.map_err(|e| raise(py, &e))?;
    let (data, heads) = columns(py, &modal.table());
    let nodes: Vec<_> = modal.model.nodes().iter().filter(|n| n.kind.has_position()).collect();
    let shape = |m: &Mode| nodes.iter().flat_map(|n| m.shape[n.v..n.v + 3].to_vec()).collect::<Vec<f64>>();
    let at_rest = nodes.iter().flat_map(|n| modal.state.q[n.q..n.q + 3].to_vec()).collect::<Vec<f64>>();
    let shapes: Vec<Vec<f64>> = std::iter::once(at_rest).chain(modal.modes.iter().map(shape)).collect();
    let about = json!({
        "title": title, "columns": heads, "nodes": nodes.len(), "unstable": modal.unstable, "warnings": modal.warnings,
        "critical": modal.critical.as_ref().and_then(|c| c.factor),
    });
    Ok((data, bytes(py, shapes.iter().map(Vec::as_slice)), about.to_string()))
}

/// Writes a scene as an FMU with this shared library: its path.
#[pyfunction]
#[pyo3(signature = (source, set, out, library))]
fn export_fmu(
    py: Python<'_>,
    source: &Source,
    set: Vec<String>,
    out: Option<PathBuf>,
    library: PathBuf,
) -> PyResult<PathBuf> {
    let text = source.scene_text().clone();
    let done = py.detach(|| ropewalk::cli::export_fmu(text, set, out, Some(&library)));
    done.map(|(path, _)| path).map_err(|e| raise(py, &e))
}

/// A number with a unit in SI units, of a text that is one.
#[pyfunction]
fn si(text: &str) -> Option<f64> {
    ropewalk::scene::quantity::Written::parse(text).filter(|w| !w.unit.is_empty()).map(|w| w.si)
}

/// Names and titles of the bundled scenes.
#[pyfunction]
fn bundled() -> PyResult<Vec<(String, String)>> {
    let title = |b: &ropewalk::Bundled| ropewalk::read(b.name).map(|s| s.title).unwrap_or_default();
    Ok(ropewalk::bundled().iter().map(|b| (b.name.to_string(), title(b))).collect())
}

/// What `ropewalk describe` says.
#[pyfunction]
fn describe(py: Python<'_>, what: &str) -> PyResult<String> {
    ropewalk::cli::explain(what, ropewalk::scenes()).map_err(|e| raise(py, &e))
}

/// JSON schemas of all types, sections and lists without types (`inputs[]`) of scenes.
#[pyfunction]
fn schemas() -> String {
    let types = registered();
    let types = types.iter().map(|s| json!({"list": s.kind.list(), "type": s.name, "schema": (s.schema)()}));
    let sections = SECTIONS.iter().map(|(name, schema)| json!({"section": name, "schema": schema()}));
    let lists =
        lists().into_iter().map(|(name, schema)| json!({"section": format!("{name}[]"), "schema": schema()}));
    serde_json::Value::Array(types.chain(sections).chain(lists).collect()).to_string()
}

/// The command line; its exit code.
#[pyfunction]
#[pyo3(signature = (*arguments))]
fn main(py: Python<'_>, arguments: &Bound<'_, PyTuple>) -> PyResult<u8> {
    let arguments: Vec<OsString> = arguments.extract()?;
    Ok(py.detach(|| ropewalk::cli::exit_from(ropewalk::scenes(), arguments)))
}

#[pymodule]
fn _native(m: &Bound<'_, PyModule>) -> PyResult<()> {
    m.add("__version__", env!("CARGO_PKG_VERSION"))?;
    m.add_class::<Source>()?;
    m.add_class::<Stop>()?;
    m.add_class::<simulation::Simulation>()?;
    m.add_class::<studies::SharedSweep>()?;
    m.add_function(wrap_pyfunction!(run, m)?)?;
    m.add_function(wrap_pyfunction!(read_history, m)?)?;
    m.add_function(wrap_pyfunction!(check, m)?)?;
    m.add_function(wrap_pyfunction!(modes, m)?)?;
    m.add_function(wrap_pyfunction!(linearise::linearise, m)?)?;
    m.add_function(wrap_pyfunction!(studies::cost, m)?)?;
    m.add_function(wrap_pyfunction!(studies::effects, m)?)?;
    m.add_function(wrap_pyfunction!(studies::certify, m)?)?;
    m.add_function(wrap_pyfunction!(studies::samples, m)?)?;
    m.add_function(wrap_pyfunction!(functions::register, m)?)?;
    m.add_function(wrap_pyfunction!(functions::forget, m)?)?;
    m.add_function(wrap_pyfunction!(export_fmu, m)?)?;
    m.add_function(wrap_pyfunction!(si, m)?)?;
    m.add_function(wrap_pyfunction!(bundled, m)?)?;
    m.add_function(wrap_pyfunction!(describe, m)?)?;
    m.add_function(wrap_pyfunction!(schemas, m)?)?;
    m.add_function(wrap_pyfunction!(main, m)?)
}
