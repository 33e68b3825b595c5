//! Scenes as Python hands them over, and errors as Python's.

use crate::functions;
use pyo3::prelude::*;
use ropewalk::scene::{Fault, Format, SceneText};
use ropewalk::{Error, SceneFile};
use std::path::PathBuf;

/// The text of a scene: of a file, a bundled one, or put together in Python.
#[pyclass(module = "ropewalk._native", frozen)]
pub struct Source(SceneText);

#[pymethods]
impl Source {
    /// A scene by its bundled name or its path.
    #[staticmethod]
    fn open_scene(py: Python<'_>, scene: &str) -> PyResult<Self> {
        SceneText::open(scene, ropewalk::scenes()).map(Source).map_err(|e| raise(py, &e.into()))
    }
    /// A scene by its text, which is JSON or TOML; files that it names are in `folder`.
    #[staticmethod]
    #[pyo3(signature = (name, text, json, folder=None))]
    fn parse(name: &str, text: String, json: bool, folder: Option<PathBuf>) -> Self {
        let format = if json { Format::Json } else { Format::Toml };
        Source(SceneText::new(name, text, format, folder))
    }
    #[getter]
    fn name(&self) -> &str {
        &self.0.name
    }
    #[getter]
    fn text(&self) -> &str {
        &self.0.text
    }
    /// The scene with these parameters, as TOML.
    fn toml(&self, py: Python<'_>, set: Vec<String>) -> PyResult<String> {
        let file = self.open(&set).map_err(|e| raise(py, &e.into()))?;
        Ok(file.document().to_toml())
    }
}

impl Source {
    /// The text itself.
    pub fn scene_text(&self) -> &SceneText {
        &self.0
    }
    /// The scene with these parameters, each `name=value`.
    pub fn open(&self, set: &[String]) -> Result<SceneFile, Fault> {
        self.0.with(set)
    }
}

/// An error as an instance of the Python class that it belongs to.
pub fn raise(py: Python<'_>, e: &Error) -> PyErr {
    if let Error::Function(broken) = e {
        return functions::raise(py, broken);
    }
    let class = match e {
        Error::Output(_) => "OutputError",
        e if e.is_input() => "SceneError",
        _ => "SolverError",
    };
    new_error(py, class, &e.to_string())
}

/// An error of a class of this package.
pub fn new_error(py: Python<'_>, class: &str, message: &str) -> PyErr {
    let value =
        py.import("ropewalk._errors").and_then(|m| m.getattr(class)).and_then(|c| c.call1((message,)));
    value.map_or_else(|e| e, PyErr::from_value)
}
