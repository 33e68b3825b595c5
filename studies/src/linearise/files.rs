//! Linearised equations as files: a Matrix Market file for each matrix, and their names.

use crate::error::Error;
use ropewalk_core::{Column, Linearised, Sparse};
use ropewalk_report::{RunFolder, write_atomic, write_json};
use serde_json::{Map, Value, json};
use std::fmt::Write;

/// A basis of the null space is dense: beyond so many unknowns it isn't written.
const LARGEST: usize = 3000;

/// Writes all of it, and says what there is.
pub(super) fn write(
    folder: &RunFolder,
    title: &str,
    l: &Linearised,
    warn: &mut dyn FnMut(&str),
) -> Result<String, Error> {
    let [of_q, of_v, of_a, of_lambda] = &l.output;
    let matrices = [
        ("mass", "M, dr/da", &l.mass),
        ("damping", "C, dr/dv", &l.damping),
        ("gyroscopic", "skew part of C", &l.gyroscopic),
        ("stiffness", "K, dr/dq with the forces of constraints", &l.stiffness),
        ("jacobian", "G, constraints by velocities", &l.jacobian),
        ("kinematic", "N, dq' = dv + N dq", &l.kinematic),
        ("forces", "B, generalised forces per unit of each input", &l.forces),
        ("drives", "D, G dv = D du", &l.drives),
        ("output_q", "outputs by dq", of_q),
        ("output_v", "outputs by dv", of_v),
        ("output_a", "outputs by da", of_a),
        ("output_lambda", "outputs by dlambda", of_lambda),
        ("feedthrough", "outputs by du", &l.feedthrough),
    ];
    let mut files = Map::new();
    let mut report = format!(
        "{title}\n  about the state at t = {} s: {} unknowns, {} equations of constraints, {} inputs, {} outputs\n",
        l.t,
        l.unknowns.len(),
        l.constraints.len(),
        l.inputs.len(),
        l.outputs.len()
    );
    for (name, about, matrix) in matrices {
        let path = folder.path().join(format!("{name}.mtx"));
        write_atomic(&path, &sparse(about, matrix))?;
        files.insert(name.into(), json!({ "file": format!("{name}.mtx"), "about": about }));
        let (rows, columns) = (matrix.nrows(), matrix.ncols());
        _ = writeln!(
            report,
            "  {:<18}{rows} x {columns}, {} entries: {about}",
            format!("{name}.mtx"),
            matrix.compute_nnz()
        );
    }
    if l.unknowns.len() <= LARGEST {
        let z = l.null_space();
        let mut text =
            format!("%%MatrixMarket matrix array real general\n% Z, G Z = 0\n{} {}\n", z.nrows(), z.ncols());
        for j in 0..z.ncols() {
            (0..z.nrows()).for_each(|i| _ = writeln!(text, "{:e}", z[(i, j)]));
        }
        write_atomic(&folder.path().join("null_space.mtx"), &text)?;
        files.insert(
            "null_space".into(),
            json!({ "file": "null_space.mtx", "about": "Z, orthonormal, G Z = 0" }),
        );
        _ = writeln!(report, "  {:<18}{} x {}, dense: Z, G Z = 0", "null_space.mtx", z.nrows(), z.ncols());
    } else {
        warn(&format!(
            "the null space of the constraints is not written: it is dense, with {} rows",
            l.unknowns.len()
        ));
    }
    let columns =
        |all: &[Column]| -> Value { all.iter().map(|c| json!({ "name": c.name, "unit": c.unit })).collect() };
    let names = json!({
        "equations": "M da + C dv + K dq + G' dlambda = B du, G dv = D du, dq' = dv + N dq, \
                      dy = output_q dq + output_v dv + output_a da + output_lambda dlambda + feedthrough du; in SI units",
        "t": l.t,
        "unknowns": l.unknowns,
        "constraints": l.constraints,
        "inputs": columns(&l.inputs),
        "outputs": columns(&l.outputs),
        "matrices": files,
    });
    write_json(&folder.path().join("linearised.json"), &names)?;
    _ = writeln!(report, "  names in linearised.json; results in {}", folder.path().display());
    Ok(report)
}

/// A matrix in the format of the Matrix Market (Boisvert, Pozo and Remington, NISTIR 5935, 1996), column by column.
fn sparse(about: &str, a: &Sparse) -> String {
    let mut text = format!("%%MatrixMarket matrix coordinate real general\n% {about}\n");
    _ = writeln!(text, "{} {} {}", a.nrows(), a.ncols(), a.compute_nnz());
    for e in a.triplet_iter() {
        _ = writeln!(text, "{} {} {:e}", e.row + 1, e.col + 1, e.val);
    }
    text
}
