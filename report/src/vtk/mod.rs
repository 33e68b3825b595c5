//! A field record as files for ParaView and other programs that read VTK's formats.
//!
//! ```text
//! run.pvd            the times, each with its file: open this one
//! run/00000.vtp      lines, bodies and points at the first snapshot, with all quantities; forces as vectors of points
//! run/00001.vtp      …
//! run/ground.vtp     shapes that stand on the ground, if there are any
//! ```
//!
//! Formats: [VTK XML](https://docs.vtk.org/en/latest/vtk_file_formats/vtkxml_file_format.html), `PolyData` with
//! appended raw data.

mod poly;

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use crate::{FieldRecord, Mesh, OutputError, cannot_create, write_atomic};
use poly::Poly;

/// Writes `name.pvd` and the folder `name` with a file for each snapshot into `folder`.
///
/// ```
/// # use ropewalk_report::{BodyRecord, FieldRecord, OutputError, Pose, vtk};
/// let ball = BodyRecord { poses: vec![Pose::at([0.0, 0.0, 5.0])], ..BodyRecord::new("ball", "point mass") };
/// let field = FieldRecord { times: vec![0.0], bodies: vec![ball], ..FieldRecord::default() };
/// # let folder = tempfile::tempdir().unwrap();
/// # let folder = folder.path();
/// vtk::write(&field, folder, "run")?;
/// assert!(folder.join("run.pvd").exists() && folder.join("run/00000.vtp").exists());
/// # Ok::<(), OutputError>(())
/// ```
///
/// # Errors
/// [`OutputError::Field`] for a record with a hole, [`OutputError::Io`] for what can't be written.
pub fn write(field: &FieldRecord, folder: &Path, name: &str) -> Result<(), OutputError> {
    field.check()?;
    let inner = folder.join(name);
    fs::create_dir_all(&inner).map_err(|error| cannot_create(&inner, error))?;
    let mut ground = Poly::default();
    let reach = reach(field);
    for shape in &field.shapes {
        add_mesh(&mut ground, &shape.triangles(reach), &shape.name, 0);
    }
    if !field.shapes.is_empty() {
        save(&inner.join("ground.vtp"), &ground)?;
    }
    let mut list = String::from(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n",
    );
    let path = escaped(name);
    for (k, t) in field.times.iter().enumerate() {
        let file = format!("{k:05}.vtp");
        save(&inner.join(&file), &snapshot(field, k, reach))?;
        let _ = writeln!(list, "<DataSet timestep=\"{t:?}\" part=\"0\" file=\"{path}/{file}\"/>");
        if !field.shapes.is_empty() {
            let _ = writeln!(list, "<DataSet timestep=\"{t:?}\" part=\"1\" file=\"{path}/ground.vtp\"/>");
        }
    }
    list += "</Collection>\n</VTKFile>\n";
    write_atomic(&folder.join(format!("{name}.pvd")), &list)
}

fn save(path: &Path, poly: &Poly) -> Result<(), OutputError> {
    fs::write(path, poly.bytes()).map_err(OutputError::io("write", path))
}

/// How far shapes without end are drawn.
fn reach(field: &FieldRecord) -> f64 {
    let [low, high] = field.bounds().unwrap_or_default();
    (0..3).map(|i| high[i] - low[i]).fold(1.0, f64::max)
}

/// Lines, bodies and points at snapshot `k`.
fn snapshot(field: &FieldRecord, k: usize, reach: f64) -> Poly {
    let mut poly = Poly::default();
    let mut names: Vec<(&str, &str)> = Vec::new();
    for quantity in field.lines.iter().flat_map(|line| &line.quantities) {
        let name = (quantity.name.as_str(), quantity.unit.as_str());
        if !names.contains(&name) {
            names.push(name);
        }
    }
    let (mut s, mut velocity): (Vec<f64>, Vec<f64>) = (Vec::new(), Vec::new());
    let mut values: Vec<Vec<f64>> = vec![Vec::new(); names.len()];
    let mut part = 0;
    for line in &field.lines {
        let at = &line.snapshots[k];
        // a line that isn't there yet has no cell
        if !at.position.is_empty() {
            poly.add_line(&at.position, &line.name, part);
            s.extend(&at.s);
            let v = |i: usize| at.velocity.get(i).copied().unwrap_or([f64::NAN; 3]);
            velocity.extend((0..at.position.len()).flat_map(v));
            for (name, column) in names.iter().zip(&mut values) {
                let own = line.quantities.iter().position(|q| (q.name.as_str(), q.unit.as_str()) == *name);
                match own {
                    Some(i) => column.extend(&at.values[i]),
                    None => column.extend(at.position.iter().map(|_| f64::NAN)),
                }
            }
        }
        part += 1;
    }
    for body in &field.bodies {
        let pose = &body.poses[k];
        if body.shapes.is_empty() {
            poly.add_point(pose.position, &body.name, part);
        }
        for shape in &body.shapes {
            let mut mesh = shape.triangles(reach);
            mesh.points.iter_mut().for_each(|x| *x = pose.apply(x));
            add_mesh(&mut poly, &mesh, &body.name, part);
        }
        part += 1;
    }
    // where nothing is there is no point, but parts keep their numbers
    let mut forces = Vec::new();
    for force in &field.forces {
        if force.points[k].iter().all(|x| x.is_finite()) {
            forces.push((poly.points(), force.forces[k]));
            poly.add_point(force.points[k], &force.name, part);
        }
        part += 1;
    }
    let heading = |name: &str, unit: &str| format!("{name} [{}]", if unit.is_empty() { "-" } else { unit });
    for (column, (name, unit)) in
        std::iter::once(s).chain(values).zip(std::iter::once(("s", "m")).chain(names))
    {
        poly.add_values(heading(name, unit), 1, column);
    }
    if velocity.iter().any(|x| x.is_finite()) {
        poly.add_values(heading("velocity", "m/s"), 3, velocity);
    }
    if !field.forces.is_empty() {
        poly.add_vectors(heading("force", "N"), &forces);
    }
    poly
}

fn add_mesh(poly: &mut Poly, mesh: &Mesh, name: &str, part: i32) {
    poly.add_triangles(&mesh.points, &mesh.triangles, name, part);
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;")
}
