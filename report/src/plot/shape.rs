//! A cable in a plane at several times.

use std::path::Path;

use super::axis::Axis;
use super::canvas::{Align, Canvas, Pen};
use super::colour::{self, Colour};
use super::frame::{AREA, Area, Bar, Entry, Frame};
use super::line::Mark;
use super::outline::outline;
use super::thin;
use crate::field::{Pose, Shape as FieldShape};
use crate::{OutputError, write_atomic};

/// Points of all snapshots together, as in a line plot.
const BUDGET: usize = 16_000;
/// More snapshots than this are not drawn but an even choice of them.
const MOST_SNAPSHOTS: usize = 200;
/// With more snapshots than this a colour bar takes the place of the legend.
const MOST_ENTRIES: usize = 8;
const LINE_WIDTH: f64 = 1.5;
const OUTLINE_WIDTH: f64 = 0.8;

/// A cable at one time.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Snapshot {
    /// Time, in seconds, or what else [`ShapePlot::t_label`] says.
    pub t: f64,
    /// Points along the cable in the plane, in metres and in order. One that isn't finite breaks the
    /// line.
    pub points: Vec<(f64, f64)>,
    /// Outlines of wheels and drums that move, each closed by a line to its first point.
    pub outlines: Vec<Vec<(f64, f64)>>,
}

/// From where a cable is looked at; z is up.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Plane {
    /// From above: y over x.
    Top,
    /// From the side: z over x.
    SideX,
    /// From the end: z over y.
    SideY,
    /// From far away, obliquely from above: x towards the left and the front, y towards the right.
    Oblique,
    /// z over the distance from the z axis.
    Radial,
}

/// Where the oblique view is seen from: turned from the x axis by an azimuth, above the ground by an elevation.
const AZIMUTH: f64 = 35.0;
const ELEVATION: f64 = 25.0;

impl Plane {
    /// The point as it is seen in this plane.
    pub fn project(self, point: [f64; 3]) -> (f64, f64) {
        let [x, y, z] = point;
        match self {
            Self::Top => (x, y),
            Self::SideX => (x, z),
            Self::SideY => (y, z),
            Self::Oblique => {
                let (sin, cos) = AZIMUTH.to_radians().sin_cos();
                let (sunk, up) = ELEVATION.to_radians().sin_cos();
                (cos * y - sin * x, up * z - sunk * (cos * x + sin * y))
            }
            Self::Radial => (x.hypot(y), z),
        }
    }

    /// Labels of the horizontal and the vertical axis.
    pub fn labels(self) -> (&'static str, &'static str) {
        match self {
            Self::Top => ("x [m]", "y [m]"),
            Self::SideX => ("x [m]", "z [m]"),
            Self::SideY => ("y [m]", "z [m]"),
            Self::Oblique => ("to the right [m]", "upwards [m]"),
            Self::Radial => ("r [m]", "z [m]"),
        }
    }
}

/// A cable in a plane at several times, coloured from early (dark) to late (light), with the same
/// scale on both axes.
///
/// Use it to show how a hose swings or a line is paid out.
///
/// ```
/// # use ropewalk_report::{OutputError, Plane, ShapePlot};
/// let hanging = (0.0, vec![[0.0, 0.0, 0.0], [0.0, 0.0, -30.0]]);
/// let swung_out = (2.5, vec![[0.0, 0.0, 0.0], [10.0, 0.0, -28.0]]);
/// let plot = ShapePlot::of_positions("Free swing", Plane::SideX, &[hanging, swung_out]);
/// assert!(plot.svg()?.contains("2.5 s"));
/// # Ok::<(), OutputError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ShapePlot {
    /// Title above the plot; may be empty.
    pub title: String,
    /// Horizontal axis, such as `x [m]`.
    pub x_label: String,
    /// Vertical axis, such as `z [m]`.
    pub y_label: String,
    /// The cable at several times, in order.
    pub snapshots: Vec<Snapshot>,
    /// What goes on from one snapshot to the next, such as `load factor [-]`; left empty, time.
    pub t_label: String,
    /// What the legend calls the snapshots; left empty, their times.
    pub names: Vec<String>,
    /// Directions of x, y and z in the plane, drawn as a small cross of axes if there are any.
    pub directions: Vec<(f64, f64)>,
    /// Outlines of wheels and drums that stand, each closed by a line to its first point.
    pub outlines: Vec<Vec<(f64, f64)>>,
}

impl ShapePlot {
    /// The plot of positions in space: for each time, in seconds, the points along the cable, in
    /// metres.
    pub fn of_positions(title: impl Into<String>, plane: Plane, positions: &[(f64, Vec<[f64; 3]>)]) -> Self {
        let (x_label, y_label) = plane.labels();
        let snapshot = |(t, points): &(f64, Vec<[f64; 3]>)| Snapshot {
            t: *t,
            points: points.iter().map(|p| plane.project(*p)).collect(),
            outlines: Vec::new(),
        };
        Self {
            title: title.into(),
            x_label: x_label.into(),
            y_label: y_label.into(),
            snapshots: positions.iter().map(snapshot).collect(),
            t_label: String::new(),
            names: Vec::new(),
            directions: match plane {
                Plane::Oblique => {
                    [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|e| plane.project(e)).to_vec()
                }
                _ => Vec::new(),
            },
            outlines: Vec::new(),
        }
    }

    /// The same with the outlines of cylinders such as wheels and drums, as they are seen in this plane: those `on` the
    /// ground, and those on bodies. `of` tells for each snapshot which there are, and where the body of each is. What isn't
    /// a cylinder is left out.
    #[must_use]
    pub fn with_wheels<'a>(
        mut self,
        plane: Plane,
        on: impl IntoIterator<Item = &'a FieldShape>,
        of: impl Fn(usize) -> Vec<(&'a FieldShape, Pose)>,
    ) -> Self {
        let ground = Pose::default();
        self.outlines = on.into_iter().filter_map(|shape| outline(shape, &ground, plane)).collect();
        for (k, snapshot) in self.snapshots.iter_mut().enumerate() {
            let wheels = of(k);
            let outlines = wheels.iter().filter_map(|(shape, carrier)| outline(shape, carrier, plane));
            snapshot.outlines = outlines.collect();
        }
        self
    }

    /// Writes the picture to a file.
    ///
    /// # Errors
    /// As [`svg`](Self::svg), or a file that can't be written.
    pub fn write(&self, path: &Path) -> Result<(), OutputError> {
        write_atomic(path, &self.svg()?)
    }

    /// The picture as SVG text.
    ///
    /// # Errors
    /// [`OutputError::EmptyPlot`] without a finite point.
    pub fn svg(&self) -> Result<String, OutputError> {
        let shown = self.shown();
        let points = || {
            let moving = shown.iter().flat_map(|s| s.points.iter().chain(s.outlines.iter().flatten()));
            let points = moving.chain(self.outlines.iter().flatten());
            points.filter(|(x, y)| x.is_finite() && y.is_finite())
        };
        let x = Axis::covering(points().map(|p| p.0), false, 0.05);
        let y = Axis::covering(points().map(|p| p.1), false, 0.05);
        let (Some(x), Some(y)) = (x, y) else {
            return Err(OutputError::EmptyPlot { title: self.title.clone() });
        };
        let frame = Frame {
            title: &self.title,
            x_label: &self.x_label,
            y_label: &self.y_label,
            x,
            y,
            equal: true,
            legend: legend(&shown, &self.names, &self.t_label),
            bar: bar(&shown, &self.t_label),
            area: AREA,
            heads_page: true,
        };
        Ok(frame.draw(|canvas, area| {
            for outline in &self.outlines {
                draw_outline(canvas, area, outline, colour::AXIS);
            }
            for snapshot in &shown {
                let colour = colour::ramp(age(snapshot, &shown));
                draw_snapshot(canvas, area, snapshot, BUDGET / shown.len(), colour);
            }
            draw_directions(canvas, area, &self.directions);
        }))
    }

    fn shown(&self) -> Vec<&Snapshot> {
        let all: Vec<_> = self.snapshots.iter().filter(|s| s.t.is_finite()).collect();
        if all.len() <= MOST_SNAPSHOTS {
            return all;
        }
        let place = |i: usize| i * (all.len() - 1) / (MOST_SNAPSHOTS - 1);
        (0..MOST_SNAPSHOTS).map(|i| all[place(i)]).collect()
    }
}

fn draw_outline(canvas: &mut Canvas, area: &Area, outline: &[(f64, f64)], colour: Colour) {
    let closed = outline.iter().chain(outline.first());
    let pixels: Vec<_> = closed.map(|p| area.pixel(*p)).collect();
    for run in thin::runs(&pixels, BUDGET) {
        canvas.line(run, Pen::solid(OUTLINE_WIDTH, colour));
    }
}

fn draw_snapshot(canvas: &mut Canvas, area: &Area, snapshot: &Snapshot, budget: usize, colour: Colour) {
    for outline in &snapshot.outlines {
        draw_outline(canvas, area, outline, colour);
    }
    let pixels: Vec<_> = snapshot.points.iter().map(|p| area.pixel(*p)).collect();
    for run in thin::runs(&pixels, budget) {
        match run[..] {
            [only] => canvas.dot(only, 2.5, colour),
            _ => canvas.line(run, Pen::solid(LINE_WIDTH, colour)),
        }
    }
}

/// A cross of axes in the lower left corner.
pub(super) fn draw_directions(canvas: &mut Canvas, area: &Area, directions: &[(f64, f64)]) {
    const LENGTH: f64 = 30.0;
    let (x0, y0) = area.corner(50.0);
    for ((x, y), name) in directions.iter().zip(["x", "y", "z"]) {
        let end = (x0 + LENGTH * x, y0 - LENGTH * y);
        canvas.line([(x0, y0), end], Pen::solid(1.0, colour::TEXT));
        let beyond = |from: f64, to: f64| from + 1.35 * (to - from);
        canvas.text(name, (beyond(x0, end.0), beyond(y0, end.1)), 12.0, Align::Centre, false);
    }
}

fn span(shown: &[&Snapshot]) -> (f64, f64) {
    let start = (f64::INFINITY, f64::NEG_INFINITY);
    shown.iter().fold(start, |(low, high), s| (low.min(s.t), high.max(s.t)))
}

/// 0 for the earliest snapshot, 1 for the latest.
fn age(snapshot: &Snapshot, shown: &[&Snapshot]) -> f64 {
    let (first, last) = span(shown);
    if last > first { (snapshot.t - first) / (last - first) } else { 0.0 }
}

fn legend(shown: &[&Snapshot], names: &[String], t_label: &str) -> Vec<Entry> {
    if !(2..=MOST_ENTRIES).contains(&shown.len()) {
        return Vec::new();
    }
    if names.len() == shown.len() {
        let entry = |(snapshot, name): (&&Snapshot, &String)| Entry {
            label: name.clone(),
            colour: colour::ramp(age(snapshot, shown)),
            mark: Mark::Line,
            dashes: &[],
        };
        return shown.iter().zip(names).map(entry).collect();
    }
    let (first, last) = span(shown);
    let digits = (3.0 - (last - first).max(1e-9).log10().floor()).clamp(0.0, 9.0) as usize;
    let entry = |snapshot: &&Snapshot| {
        let text = format!("{:.digits$}", snapshot.t);
        let text = match text.contains('.') {
            true => text.trim_end_matches('0').trim_end_matches('.'),
            false => &text,
        };
        let text = text.replace('-', "−");
        Entry {
            label: match t_label.split_once(" [") {
                None => format!("{text} s"),
                Some((name, "-]")) => format!("{name} {text}"),
                Some((name, unit)) => format!("{name} {text} {}", unit.trim_end_matches(']')),
            },
            colour: colour::ramp(age(snapshot, shown)),
            mark: Mark::Line,
            dashes: &[],
        }
    };
    shown.iter().map(entry).collect()
}

fn bar(shown: &[&Snapshot], t_label: &str) -> Option<Bar> {
    if shown.len() <= MOST_ENTRIES {
        return None;
    }
    let axis = Axis::covering(shown.iter().map(|s| s.t), false, 0.0)?;
    Some(Bar { label: if t_label.is_empty() { "t [s]" } else { t_label }.into(), axis })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn swing(count: usize, points: usize) -> ShapePlot {
        let snapshot = |i: usize| {
            let t = i as f64 / count as f64;
            let at = |k: usize| {
                let s = 10.0 * k as f64 / points as f64;
                let angle = t + 0.05 * s;
                [s * angle.sin(), 0.0, -s * angle.cos()]
            };
            (t, (0..points).map(at).collect())
        };
        let all: Vec<_> = (0..count).map(snapshot).collect();
        ShapePlot::of_positions("Swing", Plane::SideX, &all)
    }

    #[test]
    fn few_snapshots_are_named_and_many_get_a_colour_bar() {
        let few = swing(4, 30).svg().unwrap();
        assert!(few.contains("0.25 s") && !few.contains("t [s]"));
        let many = swing(30, 30).svg().unwrap();
        assert!(many.contains("t [s]") && !many.contains("0.5 s"));
        let loads =
            |count| ShapePlot { t_label: "load factor [-]".into(), ..swing(count, 30) }.svg().unwrap();
        assert!(loads(4).contains("load factor 0.25") && !loads(4).contains("0.25 s"));
        assert!(loads(30).contains("load factor [-]") && !loads(30).contains("t [s]"));
        let one = swing(1, 30).svg().unwrap();
        assert!(!one.contains("t [s]") && !one.contains("0 s"));
    }

    #[test]
    fn many_snapshots_of_fine_cables_make_small_files() {
        let svg = swing(1000, 1000).svg().unwrap();
        assert!(svg.len() < 300_000, "{} bytes", svg.len());
    }

    #[test]
    fn nothing_to_show_is_an_error() {
        assert!(ShapePlot::default().svg().is_err());
        let mut plot = swing(2, 5);
        plot.snapshots.iter_mut().for_each(|s| s.points.clear());
        assert!(matches!(plot.svg().unwrap_err(), OutputError::EmptyPlot { .. }));
    }

    #[test]
    fn planes_look_along_one_axis() {
        assert_eq!(Plane::Top.project([1.0, 2.0, 3.0]), (1.0, 2.0));
        assert_eq!(Plane::SideX.project([1.0, 2.0, 3.0]), (1.0, 3.0));
        assert_eq!(Plane::SideY.project([1.0, 2.0, 3.0]), (2.0, 3.0));
        assert_eq!(Plane::Radial.project([3.0, -4.0, 7.0]), (5.0, 7.0));
    }

    #[test]
    fn the_oblique_view_is_that_of_a_distant_eye() {
        // the columns of a rotation without its last row: what is lost is the way towards the eye
        let [x, y, z] =
            [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|e| Plane::Oblique.project(e));
        let dot = |a: [f64; 3], b: [f64; 3]| (0..3).map(|i| a[i] * b[i]).sum::<f64>();
        let (right, up) = ([x.0, y.0, z.0], [x.1, y.1, z.1]);
        assert!((dot(right, right) - 1.0).abs() < 1e-15 && (dot(up, up) - 1.0).abs() < 1e-15);
        assert!(dot(right, up).abs() < 1e-15 && z.0 == 0.0 && z.1 > 0.0);
        let plot = ShapePlot::of_positions("", Plane::Oblique, &[(0.0, vec![[0.0; 3], [1.0, 2.0, 3.0]])]);
        assert!(plot.svg().unwrap().contains(">\nx\n<"), "{}", plot.svg().unwrap());
    }

    #[test]
    fn a_straight_or_vertical_cable_still_has_two_axes() {
        for end in [[1000.0, 0.0, 0.0], [0.0, 0.0, -1000.0], [0.0; 3]] {
            let plot = ShapePlot::of_positions("", Plane::SideX, &[(0.0, vec![[0.0; 3], end])]);
            assert!(!plot.svg().unwrap().contains("NaN"));
        }
    }
}
