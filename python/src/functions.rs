//! Functions written in Python that scenes call. `ropewalk/_functions.py` makes arrays of what goes over here as bytes.

use crate::scene::new_error;
use pyo3::exceptions::PyException;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use ropewalk::Error;
use ropewalk::core::broken::Broken;
use ropewalk::core::{BuildError, Station, V3};
use ropewalk::scene::functions::{
    Displaced, Function, Parameters, Reads, Seen, Trouble, Written, forget_function, register_function,
};
use std::sync::Arc;

/// Numbers of a station, as `_functions.py` takes them apart.
const STATION: usize = 11;

/// A function before it has its parameters.
struct Unbound(Py<PyAny>);

/// A function with its parameters: an instance of `_functions.Bound`.
#[derive(Debug)]
struct Bound {
    function: Py<PyAny>,
    reads: Reads,
}

/// Registers what makes a `Bound` of parameters, which it gets as JSON.
#[pyfunction]
pub fn register(name: &str, bind: Py<PyAny>) {
    register_function(name, Arc::new(Unbound(bind)));
}

/// Forgets it again; what was bound stays as it is.
#[pyfunction]
pub fn forget(name: &str) {
    forget_function(name);
}

impl Written for Unbound {
    fn bind(&self, parameters: &Parameters) -> Result<Arc<dyn Function>, BuildError> {
        let json =
            serde_json::to_string(parameters).map_err(|e| BuildError::at("parameters", e.to_string()))?;
        Python::attach(|py| {
            let function = self.0.call1(py, (json,))?;
            let reads: [bool; 6] = function.getattr(py, "reads")?.extract(py)?;
            let [time, position, velocity, slope, attitude, angular_velocity] = reads;
            let reads = Reads { time, position, velocity, slope, attitude, angular_velocity };
            Ok(Arc::new(Bound { function, reads }) as Arc<dyn Function>)
        })
        .map_err(|e: PyErr| BuildError::at("parameters", Python::attach(|py| e.value(py).to_string())))
    }
}

/// Numbers as bytes.
fn packed<'py>(py: Python<'py>, numbers: &[f64]) -> pyo3::Bound<'py, PyBytes> {
    let all: Vec<u8> = numbers.iter().flat_map(|x| x.to_ne_bytes()).collect();
    PyBytes::new(py, &all)
}

impl Bound {
    /// Calls a method that gives numbers as bytes.
    fn call(&self, method: &str, t: f64, state: &[f64]) -> Result<Vec<f64>, Trouble> {
        Python::attach(|py| {
            let done = self.function.call_method1(py, method, (t, packed(py, state)))?;
            let bytes = done.cast_bound::<PyBytes>(py)?.as_bytes();
            Ok(bytes.as_chunks::<8>().0.iter().map(|x| f64::from_ne_bytes(*x)).collect())
        })
        .map_err(trouble)
    }
}

/// What an exception says of a function, with its place; the exception itself goes along.
fn trouble(e: PyErr) -> Trouble {
    let why = Python::attach(|py| {
        let said = py
            .import("ropewalk._functions")
            .and_then(|m| m.call_method1("said", (e.value(py), e.traceback(py))));
        said.map_or_else(|_| format!("raised {e}"), |text| text.to_string())
    });
    Trouble { why, source: Some(Arc::new(e)) }
}

fn three(x: &[f64]) -> V3<f64> {
    [x[0], x[1], x[2]]
}

impl Function for Bound {
    fn reads(&self) -> Reads {
        self.reads
    }
    fn force(&self, t: f64, at: &Seen) -> Result<[V3<f64>; 2], Trouble> {
        let mut state = Vec::with_capacity(18);
        state.extend(at.position);
        state.extend(at.velocity);
        state.extend(at.attitude.as_flattened());
        state.extend(at.angular_velocity);
        let f = self.call("force", t, &state)?;
        match f.len() {
            6 => Ok([three(&f), three(&f[3..])]),
            n => Err(Trouble::new(format!("gave {n} numbers"))),
        }
    }
    fn load(&self, t: f64, at: &[Station<f64>]) -> Result<Vec<V3<f64>>, Trouble> {
        let mut state = Vec::with_capacity(STATION * at.len());
        for s in at {
            state.extend([s.s, s.diameter]);
            state.extend(s.x);
            state.extend(s.v);
            state.extend(s.slope);
        }
        Ok(self.call("load", t, &state)?.as_chunks::<3>().0.to_vec())
    }
    fn motion(&self, t: f64) -> Result<Displaced, Trouble> {
        let x = self.call("motion", t, &[])?;
        let part = |k: usize| x.get(3 * k..3 * k + 3).map(three);
        Ok((part(0).unwrap_or([f64::NAN; 3]), [part(1), part(2)]))
    }
}

/// The function that an error is about, if it is about one.
pub fn cause(error: Option<&Error>) -> Option<Broken> {
    match error {
        Some(Error::Function(broken)) => Some(broken.clone()),
        _ => None,
    }
}

/// The exception for a function that failed: its own is the cause of it. Ctrl-C and the like stay what they are.
pub fn raise(py: Python<'_>, broken: &Broken) -> PyErr {
    let e = new_error(py, "FunctionError", &broken.to_string());
    let Some(source) = broken.source.as_ref().and_then(|s| s.downcast_ref::<PyErr>()) else { return e };
    let source = source.clone_ref(py);
    if !source.is_instance_of::<PyException>(py) {
        return source;
    }
    e.set_cause(py, Some(source));
    e
}
