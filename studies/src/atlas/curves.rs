//! From results to curves: what the panels of a figure show.

use super::data::Run;
use super::frame::{Frame, component};
use super::number::printed;
use super::plan::Plan;
use super::spec::{Guide, Panel, View};
use crate::run::Shape;
use crate::sweep::{Over, Report};
use ropewalk_core::V3;
use ropewalk_report::{Column, LinePlot, Mark, Plane, Series};

/// More curves than this can't be told apart in one panel.
pub(super) const MOST_CURVES: usize = 8;
/// Shapes of a panel that doesn't say how many.
const SHAPES: usize = 7;
/// Points of a function, and of a circle.
const POINTS: usize = 400;

impl View {
    pub(super) fn plane(self) -> Plane {
        match self {
            View::Side => Plane::SideX,
            View::Top => Plane::Top,
            View::End => Plane::SideY,
            View::Space => Plane::Oblique,
            View::Radial => Plane::Radial,
        }
    }
}

/// What a panel shows, in as many plots as its curves need, and what is to be said of them.
pub(super) fn plots(
    panel: &Panel,
    plan: &Plan,
    entry: usize,
    runs: &[Run<'_>],
    notes: &mut Vec<String>,
) -> Vec<LinePlot> {
    let mut all = match panel {
        Panel { shapes: Some(view), .. } => shapes(panel, *view, runs),
        Panel { over: Some(name), .. } => vec![over(panel, name, plan, entry, runs)],
        Panel { functions, .. } if !functions.is_empty() => vec![functions_of(panel)],
        _ => histories(panel, runs),
    };
    for plot in &mut all {
        plot.equal_axes = panel.equal.unwrap_or(plot.equal_axes);
        (plot.log_x, plot.log_y) = (panel.log_x, panel.log_y);
        plot.dashed = !plot.ordered;
        if plot.title.is_empty() {
            plot.title.clone_from(&panel.title);
        }
        let or = |given: &str, own: &str| printed(if given.is_empty() { own } else { given });
        plot.x_label = or(&panel.x_label, &plot.x_label);
        plot.y_label = or(&panel.y_label, &plot.y_label);
        plot.y_range = panel.y_range.map(|[low, high]| (low, high)).or_else(|| settled(panel, plot, notes));
        let guides: Vec<Series> = panel.guides.iter().map(|g| guide(g, panel, plot)).collect();
        plot.series.splice(0..0, guides);
    }
    all
}

/// Records of the runs over time, or over another record.
fn histories(panel: &Panel, runs: &[Run<'_>]) -> Vec<LinePlot> {
    let mut curves = Vec::new();
    for run in runs {
        let frame = Frame::of(panel, &run.history);
        let time = run.history.columns.first().map_or(&[][..], |c| &c.values);
        let column = |name: &str| values(name, run, frame.as_ref());
        let x = panel.x.as_deref().map_or_else(|| time.to_vec(), column);
        for (k, name) in panel.y.iter().enumerate() {
            let points = time.iter().zip(x.iter().copied().zip(column(name)));
            let points = points.filter(|(t, _)| inside(panel, **t)).map(|(_, p)| p).collect();
            curves.push(Series::new(label(panel, k, run, runs.len()), points));
        }
    }
    let heading = |name: &str| {
        let found = runs.iter().find_map(|run| run.history.columns.iter().find(|c| c.name == name));
        found.map_or_else(|| name.to_string(), Column::heading)
    };
    let time =
        runs.first().and_then(|run| run.history.columns.first()).map_or_else(String::new, Column::heading);
    let plot = LinePlot {
        x_label: panel.x.as_deref().map_or(time, heading),
        y_label: panel.y.first().map_or_else(String::new, |y| heading(y)),
        together: if runs.len() > 1 { panel.y.len() } else { 0 },
        ..LinePlot::default()
    };
    // runs stay together, and so do those that differ only in what varies fastest
    let each = (MOST_CURVES / panel.y.len().max(1)).max(1) * panel.y.len().max(1);
    let each = if curves.len() <= MOST_CURVES { curves.len().max(1) } else { each };
    curves.chunks(each).map(|some| LinePlot { series: some.to_vec(), ..plot.clone() }).collect()
}

/// The values of a column, of a position in the frame of the panel.
fn values(name: &str, run: &Run<'_>, frame: Option<&Frame>) -> Vec<f64> {
    let plain = || run.history.column(name).map_or_else(Vec::new, |c| c.values.clone());
    let Some((frame, (point, axis))) = frame.zip(component(name)) else { return plain() };
    let [x, y, z] = super::frame::columns(point).map(|n| run.history.column(&n).map(|c| &c.values));
    let (Some(x), Some(y), Some(z)) = (x, y, z) else { return plain() };
    (0..x.len()).map(|row| frame.at(row, [x[row], y[row], z[row]])[axis]).collect()
}

/// Which record of which run.
fn label(panel: &Panel, k: usize, run: &Run<'_>, runs: usize) -> String {
    let record = panel.labels.get(k).unwrap_or(&panel.y[k]);
    match (panel.y.len(), runs) {
        (1, 2..) => run.used.label.clone(),
        (_, 2..) if !run.used.label.is_empty() => format!("{record}, {}", run.used.label),
        _ => record.clone(),
    }
}

fn inside(panel: &Panel, t: f64) -> bool {
    panel.window.is_none_or(|[from, to]| {
        let rounding = 1e-9 * to.0.abs();
        (from.0 - rounding..=to.0 + rounding).contains(&t)
    })
}

/// One value of each run over a parameter; runs that differ in nothing else are a curve.
fn over(panel: &Panel, name: &str, plan: &Plan, entry: usize, runs: &[Run<'_>]) -> LinePlot {
    let Some((axis, places)) = plan.axis(entry, name) else { return LinePlot::default() };
    let mut series: Vec<Series> = Vec::new();
    let names: Vec<Option<&str>> = match panel.quantity {
        Some(_) => vec![None],
        None => panel.y.iter().map(|y| Some(y.as_str())).collect(),
    };
    for (k, record) in names.iter().enumerate() {
        for (run, place) in runs.iter().zip(&places) {
            let frame = Frame::of(panel, &run.history);
            let value = match (record, panel.quantity) {
                (Some(record), _) => one(panel, record, run, frame.as_ref()),
                (None, Some(quantity)) => quantity.of(run),
                (None, None) => f64::NAN,
            };
            let rest = run.used.label_without(name);
            let label = match (names.len(), record) {
                (2.., Some(_)) if rest.is_empty() => panel.labels.get(k).unwrap_or(&panel.y[k]).clone(),
                (2.., Some(_)) => format!("{}, {rest}", panel.labels.get(k).unwrap_or(&panel.y[k])),
                _ => rest,
            };
            let point = (axis.numbers[*place], value);
            match series.iter_mut().find(|s| s.label == label) {
                Some(s) => s.points.push(point),
                None => series.push(Series::new(label, vec![point]).with_mark(Mark::LineAndDots)),
            }
        }
    }
    series.iter_mut().for_each(|s| s.points.sort_by(|a, b| a.0.total_cmp(&b.0)));
    let heading = panel.y.first().and_then(|y| {
        runs.iter().find_map(|run| run.history.columns.iter().find(|c| c.name == *y)).map(Column::heading)
    });
    let quantity = panel.quantity.map(|q| q.heading().to_string());
    LinePlot {
        x_label: axis.label(),
        y_label: quantity.or(heading).unwrap_or_default(),
        series,
        ..LinePlot::default()
    }
}

/// The value of a record that stands for the run.
fn one(panel: &Panel, record: &str, run: &Run<'_>, frame: Option<&Frame>) -> f64 {
    let mut history = run.history.clone();
    if let Some(column) = history.columns.iter_mut().find(|c| c.name == record) {
        column.values = values(record, run, frame);
    }
    reported(&history, record, panel.value, panel.share).map_or(f64::NAN, |(value, _)| value)
}

/// The value of a column that stands for a run, and whether the column is unsteady in the end.
pub(super) fn reported(
    history: &ropewalk_report::Table,
    record: &str,
    value: Report,
    share: Option<f64>,
) -> Option<(f64, bool)> {
    let k = history.columns.iter().position(|c| c.name == record)?;
    let over = share.and_then(Over::share).unwrap_or_default();
    let tail = over.tails(history).into_iter().nth(k)?;
    let last = history.columns[k].values.last().copied()?;
    Some((value.of(last, &tail), tail.is_unsteady()))
}

/// Shapes at several times, a plot for each run; or the last shapes of all runs in one.
fn shapes(panel: &Panel, view: View, runs: &[Run<'_>]) -> Vec<LinePlot> {
    let count = panel.count.unwrap_or(SHAPES);
    let plane = view.plane();
    let (x_label, y_label) = plane.labels();
    let directions = match view {
        View::Space => [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|e| plane.project(e)).to_vec(),
        _ => Vec::new(),
    };
    let plot = LinePlot {
        x_label: x_label.into(),
        y_label: y_label.into(),
        equal_axes: true,
        directions,
        ..LinePlot::default()
    };
    let curve = |run: &Run<'_>, shape: &Shape, label: String| {
        let frame = Frame::of(panel, &run.history);
        let seen = points(panel, shape, frame.as_ref());
        Series::new(label, seen.into_iter().map(|x| plane.project(x)).collect())
    };
    if count == 1 && runs.len() > 1 {
        let last = |run: &Run<'_>| Some(curve(run, chosen(panel, run, 1).first()?, run.used.label.clone()));
        let all: Vec<Series> = runs.iter().filter_map(last).collect();
        return all
            .chunks(MOST_CURVES)
            .map(|some| LinePlot { series: some.to_vec(), ..plot.clone() })
            .collect();
    }
    let of = |run: &Run<'_>| {
        let shapes = chosen(panel, run, count);
        let step = shapes.windows(2).map(|w| w[1].t - w[0].t).fold(f64::INFINITY, f64::min);
        let series = shapes.iter().map(|s| curve(run, s, format!("{} s", time(s.t, step))));
        let title = if runs.len() > 1 { run.used.label.clone() } else { String::new() };
        LinePlot { title, series: series.collect(), ordered: true, ..plot.clone() }
    };
    runs.iter().map(of).collect()
}

/// So many shapes in the window, evenly.
fn chosen<'a>(panel: &Panel, run: &'a Run<'_>, count: usize) -> Vec<&'a Shape> {
    let all: Vec<&Shape> = run.shapes.iter().filter(|s| inside(panel, s.t)).collect();
    let count = count.min(all.len());
    match count {
        0 => Vec::new(),
        1 => all.last().copied().into_iter().collect(),
        _ => (0..count).map(|i| all[(i * (all.len() - 1) + (count - 1) / 2) / (count - 1)]).collect(),
    }
}

/// The points of the parts that are shown, those of one parted from those of the next.
fn points(panel: &Panel, shape: &Shape, frame: Option<&Frame>) -> Vec<V3<f64>> {
    let mut all: Vec<V3<f64>> = Vec::new();
    for line in shape.lines.iter().filter(|l| panel.parts.is_empty() || panel.parts.contains(&l.part)) {
        if !all.is_empty() {
            all.push([f64::NAN; 3]);
        }
        all.extend(line.x.iter().map(|x| frame.map_or(*x, |f| f.at(f.row(shape.t), *x))));
    }
    all
}

/// A time with as many digits as tell it from its neighbours.
fn time(t: f64, step: f64) -> String {
    let digits =
        if step > 0.0 && step.is_finite() { (1.0 - step.log10().floor()).clamp(0.0, 9.0) } else { 3.0 };
    let text = format!("{t:.*}", digits as usize);
    match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_string(),
        false => text,
    }
}

fn functions_of(panel: &Panel) -> LinePlot {
    let [from, to] = panel.range.unwrap_or([0.0, 1.0]);
    let at = |k: usize| {
        let share = k as f64 / (POINTS - 1) as f64;
        if panel.log_x { from * (to / from).powf(share) } else { from + share * (to - from) }
    };
    let curve = |f: &super::spec::Function| {
        Series::new(f.label(), (0..POINTS).map(|k| (at(k), f.at(at(k)))).collect())
    };
    LinePlot { series: panel.functions.iter().map(curve).collect(), ..LinePlot::default() }
}

/// The vertical axis of what comes after a start-up, if the start-up would hide it.
fn settled(panel: &Panel, plot: &LinePlot, notes: &mut Vec<String>) -> Option<(f64, f64)> {
    const MARGIN: f64 = 0.06;
    // what leaves half of the axis to the rest hides nothing
    const HIDES: f64 = 2.0;
    let after = panel.after?;
    let all = || plot.series.iter().flat_map(|s| &s.points).filter(|p| p.1.is_finite());
    let within = all().filter(|p| p.0 >= after).map(|p| p.1);
    let (low, high) = within.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), y| (l.min(y), h.max(y)));
    let beyond = all().filter(|p| p.0 < after).max_by(|a, b| {
        let excess = |p: &(f64, f64)| (p.1 - high).max(low - p.1);
        excess(a).total_cmp(&excess(b))
    })?;
    let whole = high.max(beyond.1) - low.min(beyond.1);
    if low > high || (low..=high).contains(&beyond.1) || whole <= HIDES * (high - low) {
        return None;
    }
    let margin = if high > low { MARGIN * (high - low) } else { 0.1 * high.abs().max(1.0) };
    let value = |x: f64, label: &str| {
        let unit = label.rsplit_once(" [").map_or("", |(_, unit)| unit.trim_end_matches(']'));
        let number = ropewalk_report::rough(x).replace('-', "−");
        format!("{number} {unit}").trim_end().to_string()
    };
    let name = plot.y_label.split(" [").next().unwrap_or_default();
    notes.push(format!(
        "The axis of the {name} leaves out a start-up that reaches {} at {}.",
        value(beyond.1, &plot.y_label),
        value(beyond.0, &plot.x_label)
    ));
    Some((low - margin, high + margin))
}

fn guide(guide: &Guide, panel: &Panel, plot: &LinePlot) -> Series {
    let seen = |x: &[f64]| match (panel.shapes, x) {
        (Some(view), [x, y, z]) => view.plane().project([*x, *y, *z]),
        (_, [x, y, ..]) => (*x, *y),
        _ => (f64::NAN, f64::NAN),
    };
    let mut points: Vec<(f64, f64)> = guide.points.iter().map(|p| seen(p)).collect();
    if let Some(level) = guide.level {
        let x = || plot.series.iter().flat_map(|s| &s.points).map(|p| p.0).filter(|x| x.is_finite());
        let (low, high) = x().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
        points.extend([(low, level), (high, level)]);
    }
    if !guide.centre.is_empty() {
        let at = |k: usize| {
            let (sin, cos) = (std::f64::consts::TAU * k as f64 / 72.0).sin_cos();
            let mut p = guide.centre.clone();
            p[0] += guide.radius * cos;
            p[1] += guide.radius * sin;
            seen(&p)
        };
        points.extend((0..=72).map(at));
    }
    Series::new(guide.label.clone(), points).with_mark(Mark::Guide)
}
