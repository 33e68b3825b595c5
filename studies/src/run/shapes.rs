//! The lines of all parts at several times: what pictures are drawn of, `shapes.csv`, and the field record.

use super::forces::Acting;
use super::scenery::Scenery;
use ropewalk_core::{At, Model, Part, Quantity, V3};
use ropewalk_report::{Column, Csv, OutputError, Pose, RunFolder, cells, write_atomic};
use ropewalk_scene::Process;
use serde::{Deserialize, Serialize};

/// What is measured along lines, where they know it, in the order of [`ropewalk_core::Line::measure`].
pub(super) const MEASURED: [(Quantity, &str); 3] = [
    (Quantity::Tension, "tension"),
    (Quantity::Curvature, "curvature"),
    (Quantity::Moment, "bending moment"),
];

/// All parts at one time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Shape {
    /// The time, or the load factor.
    pub t: f64,
    /// Whether it is one of the snapshots that pictures show.
    pub is_drawn: bool,
    pub lines: Vec<Line>,
    /// Where bodies are, in the order of the scenery.
    pub bodies: Vec<Pose>,
    /// Forces at points, for a scenery.
    pub forces: Vec<Acting>,
}

/// One part.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Line {
    pub part: String,
    /// Unstretched arc lengths of its points [m]; NaN where it has none.
    pub s: Vec<f64>,
    /// Its points [m].
    pub x: Vec<V3<f64>>,
    /// Velocities of the material there [m/s]; empty if they aren't measured.
    pub v: Vec<V3<f64>>,
    /// What is [`MEASURED`]; empty where it isn't.
    pub values: [Vec<f64>; MEASURED.len()],
}

impl Line {
    /// The line of a process: the length along it, since it tells of no other.
    pub(super) fn of_process(part: &str, process: &dyn Process) -> Self {
        let x = process.line();
        let step = |k: usize| (0..3).map(|i| (x[k][i] - x[k - 1][i]).powi(2)).sum::<f64>().sqrt();
        let mut along = 0.0;
        let s = (0..x.len()).map(|k| {
            along += if k == 0 { 0.0 } else { step(k) };
            along
        });
        let mut tensions = process.tensions();
        if tensions.len() != x.len() {
            tensions.clear();
        }
        let s = s.collect();
        let mut curvatures = process.curvatures();
        if curvatures.len() != x.len() {
            curvatures.clear();
        }
        Line { part: part.to_string(), s, x, v: Vec::new(), values: [tensions, curvatures, Vec::new()] }
    }

    /// The line of a part, with what is measured along it.
    fn of_part(model: &Model, part: &dyn Part, at: &At<'_>, lambda: &[f64]) -> Self {
        let (x, mut s) = (part.centre_line(at), part.arc_lengths(at));
        let mut line = Line { part: part.name().to_string(), x, ..Line::default() };
        if s.len() == line.x.len() {
            let v = |s: &f64| part.point(*s, at).map_or([f64::NAN; 3], |(_, v)| v);
            line.v = s.iter().map(v).collect();
            if let Some(known) = part.line() {
                for there in known.measure(&s, at) {
                    line.values.iter_mut().zip(there).for_each(|(all, x)| all.push(x));
                }
                // a cable without bending stiffness has no moment to tell of
                if !(known.slender().ei > 0.0) {
                    line.values[2].fill(f64::NAN);
                }
            } else if lambda.len() == model.multipliers() {
                line.values[0] = model.axial_forces(part, at, lambda, 0..=part.links().len());
            }
        }
        s.resize(line.x.len(), f64::NAN);
        Line { s, ..line }
    }

    /// Speeds of its points [m/s].
    pub(super) fn speeds(&self) -> Vec<f64> {
        self.v.iter().map(|v| v.iter().map(|x| x * x).sum::<f64>().sqrt()).collect()
    }
}

impl Shape {
    /// Nothing at a time.
    pub(crate) fn bare(t: f64) -> Self {
        Shape { t, is_drawn: true, lines: Vec::new(), bodies: Vec::new(), forces: Vec::new() }
    }

    /// All parts of a model that have a line, with what is measured along them; with a scenery all bodies too, and all forces, with
    /// the multipliers `lambda` of constraints; without those neither forces nor what joints carry.
    pub(crate) fn of(model: &Model, at: &At<'_>, lambda: &[f64], scenery: Option<&Scenery>) -> Self {
        let line = |part: &std::sync::Arc<dyn Part>| Line::of_part(model, part.as_ref(), at, lambda);
        let lines = model.parts().iter().map(line).filter(|line| !line.x.is_empty()).collect();
        let bodies = scenery.map_or_else(Vec::new, |scenery| scenery.poses(model, at));
        let known = scenery.filter(|_| lambda.len() == model.multipliers());
        let forces = known.map_or_else(Vec::new, |scenery| scenery.forces(model, at, lambda));
        Shape { t: at.t, is_drawn: true, lines, bodies, forces }
    }

    /// The points of all parts; those of one are parted from those of the next by one that isn't finite.
    pub(crate) fn points(&self) -> Vec<V3<f64>> {
        let mut all = Vec::new();
        for line in &self.lines {
            if !all.is_empty() {
                all.push([f64::NAN; 3]);
            }
            all.extend(&line.x);
        }
        all
    }
}

/// Headings of the columns behind part and place.
const MORE: [&str; 7] = [
    "vx [m/s]",
    "vy [m/s]",
    "vz [m/s]",
    "speed [m/s]",
    "tension [N]",
    "curvature [1/m]",
    "bending moment [N m]",
];

/// Writes those that are drawn: a row for each point, with the part that it is on, and what is measured there. `first` is
/// the first column of the history.
pub(crate) fn write(folder: &RunFolder, first: &Column, shapes: &[Shape]) -> Result<(), OutputError> {
    if !shapes.iter().any(|shape| shape.is_drawn) {
        return Ok(());
    }
    let of = |name: &'static str| name.to_string();
    let place = ["part", "s [m]", "x [m]", "y [m]", "z [m]"].map(of);
    let mut csv = Csv::new([first.heading()].into_iter().chain(place).chain(MORE.map(of)));
    for shape in shapes.iter().filter(|shape| shape.is_drawn) {
        for line in &shape.lines {
            let speeds = line.speeds();
            for (k, (s, x)) in line.s.iter().zip(&line.x).enumerate() {
                csv.number(shape.t).cell(&line.part);
                csv.number(*s).number(x[0]).number(x[1]).number(x[2]);
                let v = line.v.get(k).copied().unwrap_or([f64::NAN; 3]);
                csv.number(v[0]).number(v[1]).number(v[2]);
                csv.number(speeds.get(k).copied().unwrap_or(f64::NAN));
                for values in &line.values {
                    csv.number(values.get(k).copied().unwrap_or(f64::NAN));
                }
                csv.end();
            }
        }
    }
    write_atomic(&folder.shapes_file(), &csv.text())
}

/// Reads back places and arc lengths.
pub fn read(folder: &RunFolder) -> Result<Vec<Shape>, OutputError> {
    let path = folder.shapes_file();
    let text = std::fs::read_to_string(&path).map_err(OutputError::io("read", &path))?;
    let mut shapes: Vec<Shape> = Vec::new();
    for (row, line) in text.lines().enumerate().skip(1) {
        let fail =
            |message: &str| OutputError::Csv { path: path.clone(), line: row + 1, message: message.into() };
        let fields = cells(line);
        let [t, part, numbers @ ..] = fields.as_slice() else { return Err(fail("not a row of shapes")) };
        let number =
            |text: &String| text.parse::<f64>().map_err(|_| fail(&format!("'{text}' is not a number")));
        let t = number(t)?;
        let numbers = numbers.iter().take(4).map(number).collect::<Result<Vec<_>, _>>()?;
        let [s, x, y, z] = numbers[..] else { return Err(fail("not a row of shapes")) };
        if shapes.last().is_none_or(|shape| shape.t != t) {
            shapes.push(Shape::bare(t));
        }
        let lines = &mut shapes.last_mut().ok_or_else(|| fail("no shape"))?.lines;
        match lines.last_mut().filter(|line| line.part == *part) {
            Some(line) => {
                line.s.push(s);
                line.x.push([x, y, z]);
            }
            None => {
                lines.push(Line { part: part.clone(), s: vec![s], x: vec![[x, y, z]], ..Line::default() })
            }
        }
    }
    Ok(shapes)
}

/// The last of them; empty if there is none.
pub fn last(folder: &RunFolder) -> Result<Shape, OutputError> {
    Ok(read(folder)?.pop().unwrap_or_else(|| Shape::bare(f64::NAN)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_are_read_back_part_by_part() {
        let folder = tempfile::tempdir().unwrap();
        let folder = RunFolder::at(folder.path().join("out")).unwrap();
        let line = |part: &str, z: f64| Line {
            part: part.into(),
            s: vec![0.0, 0.1],
            x: vec![[1.0, 2.0, z], [1.0 / 3.0, -1e-300, z]],
            ..Line::default()
        };
        let lines = |t| vec![line("hose, \"old\"", t), line("buoy", 5.0)];
        let shape = |t| Shape { lines: lines(t), ..Shape::bare(t) };
        let between = Shape { is_drawn: false, ..shape(0.3) };
        write(&folder, &Column::new("load factor", ""), &[shape(0.0), between, shape(0.7)]).unwrap();
        let text = std::fs::read_to_string(folder.shapes_file()).unwrap();
        let head = format!("load factor [-],part,s [m],x [m],y [m],z [m],{}\n", MORE.join(","));
        assert!(text.starts_with(&format!("{head}0,\"hose, \"\"old\"\"\",0,1,2,0,NaN,")), "{text}");
        assert_eq!(last(&folder).unwrap(), shape(0.7));
        assert_eq!(read(&folder).unwrap(), [shape(0.0), shape(0.7)]);
        let points = shape(0.7).points();
        assert_eq!((points.len(), points[2][0].is_nan(), points[3]), (5, true, [1.0, 2.0, 5.0]));
    }

    #[test]
    fn a_line_knows_how_fast_its_points_are() {
        let line = Line { v: vec![[3.0, 0.0, 4.0], [f64::NAN; 3]], ..Line::default() };
        assert_eq!(line.speeds()[0], 5.0);
        assert!(line.speeds()[1].is_nan());
    }
}
