//! The lines of all parts at the times of the snapshots: what pictures are drawn of, and `shapes.csv`.

use ropewalk_core::{At, Model, V3};
use ropewalk_report::{Column, Csv, OutputError, RunFolder, cells, write_atomic};
use ropewalk_scene::Process;
use serde::{Deserialize, Serialize};

/// All parts at one time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Shape {
    /// The time, or the load factor.
    pub t: f64,
    pub lines: Vec<Line>,
}

/// One part.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Line {
    pub part: String,
    /// Unstretched arc lengths of its points [m]; NaN where it has none.
    pub s: Vec<f64>,
    /// Its points [m].
    pub x: Vec<V3<f64>>,
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
        Line { part: part.to_string(), s: s.collect(), x }
    }
}

impl Shape {
    /// All parts of a model that have a line.
    pub(super) fn of(model: &Model, at: &At<'_>) -> Self {
        let line = |part: &std::sync::Arc<dyn ropewalk_core::Part>| {
            let (x, mut s) = (part.centre_line(at), part.arc_lengths(at));
            s.resize(x.len(), f64::NAN);
            Line { part: part.name().to_string(), s, x }
        };
        let lines = model.parts().iter().map(line).filter(|line| !line.x.is_empty());
        Shape { t: at.t, lines: lines.collect() }
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

/// Writes them: a row for each point, with the part that it is on. `first` is the first column of the history.
pub(crate) fn write(folder: &RunFolder, first: &Column, shapes: &[Shape]) -> Result<(), OutputError> {
    if shapes.is_empty() {
        return Ok(());
    }
    let mut csv = Csv::new([first.heading().as_str(), "part", "s [m]", "x [m]", "y [m]", "z [m]"]);
    for shape in shapes {
        for line in &shape.lines {
            for (s, x) in line.s.iter().zip(&line.x) {
                csv.number(shape.t).cell(&line.part);
                csv.number(*s).number(x[0]).number(x[1]).number(x[2]).end();
            }
        }
    }
    write_atomic(&folder.shapes_file(), &csv.text())
}

/// Reads them back.
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
        let numbers = numbers.iter().map(number).collect::<Result<Vec<_>, _>>()?;
        let [s, x, y, z] = numbers[..] else { return Err(fail("not a row of shapes")) };
        if shapes.last().is_none_or(|shape| shape.t != t) {
            shapes.push(Shape { t, lines: Vec::new() });
        }
        let lines = &mut shapes.last_mut().ok_or_else(|| fail("no shape"))?.lines;
        match lines.last_mut().filter(|line| line.part == *part) {
            Some(line) => {
                line.s.push(s);
                line.x.push([x, y, z]);
            }
            None => lines.push(Line { part: part.clone(), s: vec![s], x: vec![[x, y, z]] }),
        }
    }
    Ok(shapes)
}

/// The last of them; empty if there is none.
pub fn last(folder: &RunFolder) -> Result<Shape, OutputError> {
    let nothing = Shape { t: f64::NAN, lines: Vec::new() };
    Ok(read(folder)?.pop().unwrap_or(nothing))
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
        };
        let shape = |t| Shape { t, lines: vec![line("hose, \"old\"", t), line("buoy", 5.0)] };
        write(&folder, &Column::new("load factor", ""), &[shape(0.0), shape(0.7)]).unwrap();
        let text = std::fs::read_to_string(folder.shapes_file()).unwrap();
        assert!(
            text.starts_with(
                "load factor [-],part,s [m],x [m],y [m],z [m]\n0,\"hose, \"\"old\"\"\",0,1,2,0\n"
            )
        );
        assert_eq!(last(&folder).unwrap(), shape(0.7));
        assert_eq!(read(&folder).unwrap(), [shape(0.0), shape(0.7)]);
        let points = shape(0.7).points();
        assert_eq!((points.len(), points[2][0].is_nan(), points[3]), (5, true, [1.0, 2.0, 5.0]));
    }
}
