//! Range graphs: between what tension and the like were along a line, over all accepted steps.

use super::recorder::Recorder;
use crate::error::Error;
use ropewalk_core::{At, BuildError, Model, Part, V3};
use ropewalk_forces::{Outside, Wall};
use ropewalk_report::{Column, LinePlot, RangeGraph, RunFolder, Series, Table};
use ropewalk_scene::records::tangent;
use ropewalk_scene::{Analysis, RangeSpec, Scene};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::sync::Arc;

/// What is looked at, with its unit.
const QUANTITIES: [(&str, &str); 10] = [
    ("tension", "N"),
    ("wall_tension", "N"),
    ("curvature", "1/m"),
    ("moment", "N m"),
    ("declination", "rad"),
    ("azimuth", "rad"),
    ("clearance", "m"),
    ("x", "m"),
    ("y", "m"),
    ("z", "m"),
];
const COUNT: usize = QUANTITIES.len();
type Values = [f64; COUNT];

/// What one quantity at one place has been so far: means and squares are weighted by time (West, 1979).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Course {
    start: f64,
    weight: f64,
    mean: f64,
    squares: f64,
    /// Extremes and their instants.
    least: [f64; 2],
    largest: [f64; 2],
}

impl Course {
    fn at(start: f64) -> Self {
        let [least, largest] = [f64::INFINITY, f64::NEG_INFINITY].map(|x| [x, f64::NAN]);
        Course { start, weight: 0.0, mean: 0.0, squares: 0.0, least, largest }
    }
    fn add(&mut self, x: f64, weight: f64) {
        if weight > 0.0 {
            self.weight += weight;
            let off = x - self.mean;
            self.mean += weight * off / self.weight;
            self.squares += weight * off * (x - self.mean);
        }
    }
    fn look(&mut self, x: f64, t: f64) {
        if x < self.least[0] {
            self.least = [x, t];
        }
        if x > self.largest[0] {
            self.largest = [x, t];
        }
    }
    fn deviation(&self) -> f64 {
        (self.squares / self.weight).max(0.0).sqrt()
    }
}

/// A range graph in the making.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Range {
    of: String,
    name: String,
    window: [f64; 2],
    /// Unstretched arc lengths: nodes, and the middles between them.
    places: Vec<f64>,
    courses: Vec<[Course; COUNT]>,
    /// What was there at the step before, and when.
    before: Option<(f64, Vec<Values>)>,
    /// What is known of the surroundings, which stay as they are.
    #[serde(skip)]
    around: Option<Around>,
}

/// What presses on a line and lies below it, in one model.
#[derive(Clone)]
struct Around {
    /// Address of the model: another one has other terms.
    model: usize,
    wall: Wall,
    /// The water at each place; none where there is none, or a fluid flows in it.
    water: Vec<Option<Outside>>,
    /// Numbers of the beds and contact shapes.
    grounds: Vec<usize>,
}

impl Around {
    fn of(part: &Arc<dyn Part>, places: &[f64], model: &Model, at: &At<'_>) -> Self {
        let wall = Wall::new(model, part.clone());
        let tells = |k: &usize| clearance(model, *k, part.name(), places[0], at).is_some();
        let water = |s: &f64| if wall.flows() { None } else { wall.outside(*s, model, at) };
        Around {
            model: address(model),
            water: places.iter().map(water).collect(),
            grounds: (0..model.terms().len()).filter(tells).collect(),
            wall,
        }
    }
}

/// It follows from the model.
impl PartialEq for Around {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl fmt::Debug for Around {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Around").field("grounds", &self.grounds).finish_non_exhaustive()
    }
}

fn address(model: &Model) -> usize {
    std::ptr::from_ref(model) as usize
}

fn clearance(model: &Model, term: usize, part: &str, s: f64, at: &At<'_>) -> Option<f64> {
    model.terms()[term].shows()?.local("clearance", part, s, at)
}

/// Angle from upright, and from x to y.
fn direction([x, y, z]: &V3<f64>) -> [f64; 2] {
    [x.hypot(*y).atan2(*z), y.atan2(*x)]
}

impl Range {
    fn new(spec: &RangeSpec, model: &Model, duration: f64) -> Result<Self, BuildError> {
        let of = spec.of.trim();
        let part = ropewalk_scene::records::part(model, of)?;
        let Some(line) = part.line().filter(|line| line.mesh().len() > 1) else {
            return Err(BuildError::at("of", format!("`{of}` is a {}, not a line", part.kind())));
        };
        if line.boundary(0).is_some() || line.boundary(1).is_some() {
            let message =
                format!("`{of}` feeds: its places move along the material, so that it has no range graph");
            return Err(BuildError::at("of", message));
        }
        let to = spec.to.unwrap_or(duration);
        if !(spec.from >= 0.0 && spec.from < to) {
            let message = format!("a range graph from {} s to {to} s is over no time", spec.from);
            return Err(BuildError::at("from", message));
        }
        let mesh = line.mesh();
        let places =
            mesh.windows(2).flat_map(|w| [w[0], 0.5 * (w[0] + w[1])]).chain(mesh.last().copied()).collect();
        let name = spec.name.clone().unwrap_or_else(|| of.to_string());
        Ok(Range {
            of: of.into(),
            name,
            window: [spec.from, to],
            places,
            courses: Vec::new(),
            before: None,
            around: None,
        })
    }

    /// What is there now.
    fn values(&mut self, model: &Model, part: &Arc<dyn Part>, at: &At<'_>) -> Vec<Values> {
        let places = &self.places;
        if self.around.as_ref().is_none_or(|around| around.model != address(model)) {
            self.around = Some(Around::of(part, places, model, at));
        }
        let Some(around) = &self.around else { return Vec::new() };
        let points: Vec<V3<f64>> =
            places.iter().map(|&s| part.point(s, at).map_or([f64::NAN; 3], |(x, _)| x)).collect();
        let unknown = || vec![[f64::NAN; 3]; places.len()];
        let inside = part.line().map_or_else(unknown, |line| line.measure(places, at));
        let one = |k: usize| {
            let (s, [tension, curvature, moment]) = (places[k], inside[k]);
            let in_wall = match &around.water[k] {
                Some(outside) => tension + around.wall.pressed(outside, s, at),
                None if around.wall.flows() => around.wall.tension(s, model, at),
                None => f64::NAN,
            };
            let [declination, azimuth] = direction(&tangent(part.as_ref(), s, at).unwrap_or([f64::NAN; 3]));
            let above = |term: &usize| clearance(model, *term, part.name(), s, at);
            let clearance = around.grounds.iter().filter_map(above).fold(f64::NAN, f64::min);
            let [x, y, z] = points[k];
            [tension, in_wall, curvature, moment, declination, azimuth, clearance, x, y, z]
        };
        (0..places.len()).map(one).collect()
    }

    /// Takes up an accepted state, or a row of the history, which may lie within a step: its extremes count alone.
    fn look(&mut self, model: &Model, at: &At<'_>, row: bool) {
        let Some(part) = model.part(&self.of) else { return };
        let [from, to] = self.window;
        let inside = at.t >= from && at.t <= to * (1.0 + 1e-12);
        if !inside && !self.courses.is_empty() {
            return;
        }
        let now = self.values(model, part, at);
        if self.courses.is_empty() {
            self.courses = now.iter().map(|v| v.map(Course::at)).collect();
        }
        if !inside {
            return;
        }
        let first = self.before.is_none();
        let half = self.before.as_ref().map_or(0.0, |(t, _)| 0.5 * (at.t - t));
        for (k, courses) in self.courses.iter_mut().enumerate() {
            for (q, course) in courses.iter_mut().enumerate() {
                course.look(now[k][q], at.t);
                // the trapezoidal rule
                if let (false, Some((_, before))) = (row, &self.before) {
                    course.add(before[k][q], half);
                    course.add(now[k][q], half);
                }
            }
        }
        if !row || first {
            self.before = Some((at.t, now));
        }
    }

    /// The quantities that this line has.
    fn known(&self) -> impl Iterator<Item = (usize, &'static (&'static str, &'static str))> {
        QUANTITIES.iter().enumerate().filter(|(q, _)| self.courses.iter().any(|c| c[*q].start.is_finite()))
    }

    fn table(&self) -> Table {
        let mut columns = vec![Column { values: self.places.clone(), ..Column::new("s", "m") }];
        for (q, (quantity, unit)) in self.known() {
            type Of = fn(&Course) -> f64;
            let all: [(&str, &str, Of); 7] = [
                ("start", unit, |c| c.start),
                ("least", unit, |c| c.least[0]),
                ("mean", unit, |c| c.mean),
                ("largest", unit, |c| c.largest[0]),
                ("deviation", unit, Course::deviation),
                ("t_least", "s", |c| c.least[1]),
                ("t_largest", "s", |c| c.largest[1]),
            ];
            for (what, unit, of) in all {
                let values = self.courses.iter().map(|c| of(&c[q])).collect();
                columns.push(Column { values, ..Column::new(format!("{quantity}.{what}"), unit) });
            }
        }
        Table { columns }
    }

    fn plot(&self, q: usize) -> LinePlot {
        let (quantity, unit) = QUANTITIES[q];
        let over = |of: &dyn Fn(&Course) -> f64| {
            self.places.iter().copied().zip(self.courses.iter().map(|c| of(&c[q]))).collect::<Vec<_>>()
        };
        let [from, to] = self.window;
        LinePlot {
            title: format!("Range of the {quantity} of {} from {from} s to {to} s", self.of),
            x_label: "s [m]".into(),
            y_label: format!("{quantity} [{unit}]"),
            series: vec![
                Series::new("largest", over(&|c| c.largest[0])),
                Series::new("mean", over(&|c| c.mean)),
                Series::new("least", over(&|c| c.least[0])),
                Series::new("start", over(&|c| c.start)),
            ],
            ..LinePlot::default()
        }
    }
}

/// The range graphs that a scene asks for.
///
/// # Errors
/// A part that is no line, or feeds; a time that isn't in the run; two of one name; a run that isn't one in time.
pub(crate) fn all(scene: &Scene, model: &Model) -> Result<Vec<Range>, BuildError> {
    let wanted = &scene.run.ranges;
    if wanted.is_empty() {
        return Ok(Vec::new());
    }
    if scene.run.analysis != Analysis::Dynamics || !scene.processes.is_empty() {
        return Err(BuildError::at("run.ranges", "range graphs are of runs in time of lines"));
    }
    let mut all: Vec<Range> = Vec::new();
    for (k, spec) in wanted.iter().enumerate() {
        // so that a message points at its line
        let at = |e: BuildError| {
            let field = e.field.as_deref().map_or(String::new(), |field| format!(".{field}"));
            e.of(format!("run.ranges[{k}]{field}"))
        };
        let range = Range::new(spec, model, scene.run.duration).map_err(at)?;
        if all.iter().any(|other| other.name == range.name) {
            let message = format!("two range graphs are named `{}`: give one of them a `name`", range.name);
            return Err(at(BuildError::at("name", message)));
        }
        all.push(range);
    }
    Ok(all)
}

/// The range graphs that a folder has, for its page.
pub(crate) fn on_pages(folder: &RunFolder, scene: &Scene) -> Vec<RangeGraph> {
    let graphs = |spec: &RangeSpec| {
        let name = spec.name.as_deref().unwrap_or(spec.of.trim());
        let table =
            Table::read(&folder.table_file(&format!("range-{name}")).ok().filter(|p| p.is_file())?).ok()?;
        Some(RangeGraph::of_table(name, [spec.from, spec.to.unwrap_or(scene.run.duration)], &table))
    };
    scene.run.ranges.iter().filter_map(graphs).flatten().collect()
}

impl Recorder<'_> {
    /// Range graphs take up an accepted state, or a row of the history.
    pub(super) fn range(&mut self, model: &Model, at: &At<'_>, row: bool) {
        self.ranges.iter_mut().for_each(|range| range.look(model, at, row));
    }
}

/// Writes tables and pictures, and says what was written. One that can't be written is no reason to fail.
pub(crate) fn write(
    folder: &RunFolder,
    ranges: &[Range],
    plots: bool,
    warn: &mut dyn FnMut(&str),
) -> (Vec<String>, Vec<String>) {
    let (mut tables, mut pictures) = (Vec::new(), Vec::new());
    for range in ranges.iter().filter(|range| range.before.is_some()) {
        let name = format!("range-{}", range.name);
        let written = folder.table_file(&name).map_err(Error::from);
        match written.and_then(|path| Ok(range.table().write(&path)?)) {
            Ok(()) => tables.push(name.clone()),
            Err(e) => warn(&e.to_string()),
        }
        for (q, (quantity, _)) in range.known().filter(|_| plots) {
            let picture = format!("{name}-{quantity}");
            if folder.draw(&picture, |path| range.plot(q).write(path), warn) {
                pictures.push(picture);
            }
        }
    }
    (tables, pictures)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_and_deviations_are_those_over_time() {
        // a sine over whole periods, in uneven steps: mean 3, deviation 2/√2
        let mut course = Course::at(3.0);
        let (mut t, mut before) = (0.0, None::<(f64, f64)>);
        let end = 4.0 * std::f64::consts::TAU;
        for k in 0.. {
            let x = 3.0 + 2.0 * f64::sin(t);
            if let Some((then, y)) = before {
                course.add(y, 0.5 * (t - then));
                course.add(x, 0.5 * (t - then));
            }
            course.look(x, t);
            before = Some((t, x));
            if t >= end {
                break;
            }
            t = f64::min(t + 1e-3 * (1.0 + f64::from(k % 7)), end);
        }
        assert!((course.mean - 3.0).abs() < 1e-5 && (course.deviation() - 2f64.sqrt()).abs() < 1e-5);
        assert!((course.largest[0] - 5.0).abs() < 1e-5 && (course.least[0] - 1.0).abs() < 1e-5);
    }
}
