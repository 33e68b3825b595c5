//! Linearised equations as sparse matrices.

use crate::bytes;
use crate::scene::{Source, raise};
use crate::watch::watched;
use pyo3::prelude::*;
use pyo3::types::PyByteArray;
use ropewalk::studies::linearise::{About, LineariseOptions};
use serde_json::json;

/// A matrix by compressed columns: name, rows, columns, values, and as 64-bit integers row indices and column pointers.
type Matrix<'py> =
    (&'static str, usize, usize, Bound<'py, PyByteArray>, Bound<'py, PyByteArray>, Bound<'py, PyByteArray>);

fn integers<'py>(py: Python<'py>, all: &[usize]) -> Bound<'py, PyByteArray> {
    let all: Vec<u8> = all.iter().flat_map(|k| (*k as i64).to_ne_bytes()).collect();
    PyByteArray::new(py, &all)
}

/// The equations linearised about the start, the equilibrium (neither is given), or the state at a time: matrices, and their
/// names as JSON.
#[pyfunction]
#[pyo3(signature = (source, set, start, at=None))]
pub fn linearise<'py>(
    py: Python<'py>,
    source: &Source,
    set: Vec<String>,
    start: bool,
    at: Option<f64>,
) -> PyResult<(Vec<Matrix<'py>>, String)> {
    let (done, exception) = watched(py, None, |watch| {
        let file = source.open(&set)?;
        let about = match (start, at) {
            (true, _) => About::Start,
            (false, Some(t)) => About::Time(t),
            (false, None) => About::Equilibrium,
        };
        let options = LineariseOptions { about, watch, ..LineariseOptions::default() };
        ropewalk::linearise(file.scene(), &options).map_err(|e| e.in_file(&file))
    })?;
    exception.map_or(Ok(()), Err)?;
    let l = done.map_err(|e| raise(py, &e))?;
    let [yq, yv, ya, yl] = &l.output;
    let all = [
        ("M", &l.mass),
        ("C", &l.damping),
        ("Gyro", &l.gyroscopic),
        ("K", &l.stiffness),
        ("G", &l.jacobian),
        ("N", &l.kinematic),
        ("B", &l.forces),
        ("D", &l.drives),
        ("Yq", yq),
        ("Yv", yv),
        ("Ya", ya),
        ("Yl", yl),
        ("Yu", &l.feedthrough),
    ];
    let matrices = all.map(|(name, m)| {
        let (data, rows, pointers) =
            (bytes(py, [m.val()]), integers(py, m.row_idx()), integers(py, m.col_ptr()));
        (name, m.nrows(), m.ncols(), data, rows, pointers)
    });
    let named = |columns: &[ropewalk::core::Column]| {
        columns.iter().map(|c| [c.name.clone(), c.unit.clone()]).collect::<Vec<_>>()
    };
    let about = json!({
        "t": l.t, "unknowns": l.unknowns, "constraints": l.constraints,
        "inputs": named(&l.inputs), "outputs": named(&l.outputs),
    });
    Ok((matrices.into(), about.to_string()))
}
