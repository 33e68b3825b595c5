//! The pictures of a run: every record over time, and the shape of all parts.

use super::recorder::{Figure, Recorder};
use super::summary::CriticalLoad;
use ropewalk_core::V3;
use ropewalk_report::{LinePlot, Mark, Plane, RunFolder, Series, ShapePlot};
use ropewalk_scene::ShapeTitles;

/// All ways to look at shapes.
pub const PLANES: [Plane; 5] = [Plane::SideX, Plane::Top, Plane::SideY, Plane::Oblique, Plane::Radial];

/// Draws everything and says what was drawn. A picture that can't be drawn is no reason to fail.
pub(crate) fn draw(
    folder: &RunFolder,
    title: &str,
    recorder: &Recorder<'_>,
    critical: &[CriticalLoad],
    warn: &mut dyn FnMut(&str),
) -> Vec<String> {
    let mut drawn = Vec::new();
    for (name, plot) in recorder.figures.iter().flat_map(|figure| histories(figure, recorder, critical)) {
        if folder.draw(&name, |path| plot.write(path), warn) {
            drawn.push(name);
        }
    }
    let titles = &recorder.scene.run.shape_titles;
    let asked = [(Plane::Oblique, &titles.space), (Plane::Radial, &titles.radial)];
    let asked = asked.into_iter().filter(|(_, title)| title.is_some()).map(|(plane, _)| plane);
    let drawn_shapes: Vec<_> = recorder.kept.drawn().collect();
    let shapes: Vec<_> = drawn_shapes.iter().map(|shape| (shape.t, shape.points())).collect();
    let t_label = match recorder.table.columns.first() {
        Some(t) if t.name != "t" => t.heading(),
        _ => String::new(),
    };
    for plane in planes(&shapes).into_iter().chain(asked) {
        let (name, from) = view(plane);
        let title = shape_title(titles, plane).cloned().unwrap_or_else(|| format!("{title}, {from}"));
        let plot = ShapePlot::of_positions(title, plane, &shapes);
        let plot = match &recorder.kept.scenery {
            Some(scenery) => scenery.with_wheels(plot, plane, &drawn_shapes),
            None => plot,
        };
        let plot = ShapePlot { t_label: t_label.clone(), ..plot };
        if folder.draw(name, |path| plot.write(path), warn) {
            drawn.push(name.to_string());
        }
    }
    drawn
}

/// The name of a picture of shapes, and from where they are seen.
pub fn view(plane: Plane) -> (&'static str, &'static str) {
    match plane {
        Plane::Top => ("shape_top", "from above"),
        Plane::SideX => ("shape_side", "from the side"),
        Plane::SideY => ("shape_end", "from the end"),
        Plane::Oblique => ("shape_space", "in space"),
        Plane::Radial => ("shape_radial", "z over the distance from the axis"),
    }
}

/// The pictures of shapes that a scene gives titles to, by name.
pub(super) fn shape_titles(titles: &ShapeTitles) -> impl Iterator<Item = (String, String)> {
    let all = PLANES.into_iter().filter_map(|plane| Some((view(plane).0, shape_title(titles, plane)?)));
    all.map(|(name, title)| (name.to_string(), title.clone()))
}

/// The title that a scene gives to a picture of shapes.
fn shape_title(titles: &ShapeTitles, plane: Plane) -> Option<&String> {
    match plane {
        Plane::Top => titles.top.as_ref(),
        Plane::SideX => titles.side.as_ref(),
        Plane::SideY => titles.end.as_ref(),
        Plane::Oblique => titles.space.as_ref(),
        Plane::Radial => titles.radial.as_ref(),
    }
}

/// A plot of each unit that the record has: one axis can't show metres and newtons. Dots mark critical loads.
fn histories(figure: &Figure, recorder: &Recorder<'_>, critical: &[CriticalLoad]) -> Vec<(String, LinePlot)> {
    let columns = &recorder.table.columns;
    let Some(time) = columns.first() else { return Vec::new() };
    let mut units: Vec<&str> = Vec::new();
    for k in figure.columns.clone() {
        if !units.contains(&columns[k].unit.as_str()) {
            units.push(&columns[k].unit);
        }
    }
    let plot = |unit: &&str| {
        let shown: Vec<_> = figure.columns.clone().map(|k| &columns[k]).filter(|c| c.unit == *unit).collect();
        // `hose.end.x` is `x` where the title says of what
        let short = |name: &str| name.rsplit_once('.').map_or(name, |(_, last)| last).to_string();
        let labels: Vec<String> = shown.iter().map(|c| short(&c.name)).collect();
        let series = shown.iter().zip(&labels).map(|(c, label)| {
            Series::new(label, time.values.iter().copied().zip(c.values.iter().copied()).collect())
        });
        let at_critical = |x: f64| critical.iter().any(|c| (c.load_factor - x).abs() <= 1e-9 * x.abs());
        let dots: Vec<(f64, f64)> = shown
            .iter()
            .flat_map(|c| time.values.iter().copied().zip(c.values.iter().copied()))
            .filter(|(x, _)| at_critical(*x))
            .collect();
        let dots = (!dots.is_empty()).then(|| Series::new("critical", dots).with_mark(Mark::Dots));
        let name = match units.as_slice() {
            [_] => figure.name.clone(),
            _ => format!("{}.{}", figure.name, labels.join("-")),
        };
        let plot = LinePlot {
            title: figure.title.clone(),
            x_label: time.heading(),
            y_label: format!("{} [{}]", labels.join(", "), if unit.is_empty() { "-" } else { unit }),
            series: series.chain(dots).collect(),
            ..LinePlot::default()
        };
        (name, plot)
    };
    units.iter().map(plot).collect()
}

/// The planes in which there is anything to see: both directions are moved or extended in.
pub fn planes(shapes: &[(f64, Vec<V3<f64>>)]) -> Vec<Plane> {
    let points = || shapes.iter().flat_map(|(_, line)| line).filter(|p| p.iter().all(|x| x.is_finite()));
    if points().next().is_none() {
        return Vec::new();
    }
    let extent = [0, 1, 2].map(|i| {
        let (low, high) = points()
            .map(|p| p[i])
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
        high - low
    });
    let largest = extent.iter().fold(0.0_f64, |a, b| a.max(*b));
    let shows = |i: usize, j: usize| extent[i].min(extent[j]) > 1e-3 * largest;
    let all = [(Plane::SideX, 0, 2), (Plane::Top, 0, 1), (Plane::SideY, 1, 2)];
    let seen: Vec<Plane> = all.iter().filter(|(_, i, j)| shows(*i, *j)).map(|(plane, ..)| *plane).collect();
    match (seen.is_empty(), extent[1] > extent[0]) {
        (false, _) => seen,
        // a straight line along an axis, or points at rest
        (true, false) => vec![Plane::SideX],
        (true, true) => vec![Plane::SideY],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_planes_with_something_to_see_are_drawn() {
        let line = |end: V3<f64>| vec![(0.0, vec![[0.0; 3], [f64::NAN; 3], end])];
        assert_eq!(planes(&line([1.0, 0.0, 2.0])), [Plane::SideX]);
        assert_eq!(planes(&line([1.0, 1e-9, 2.0])), [Plane::SideX]);
        assert_eq!(planes(&line([1.0, 3.0, 0.0])), [Plane::Top]);
        assert_eq!(planes(&line([1.0, 3.0, 2.0])), [Plane::SideX, Plane::Top, Plane::SideY]);
        assert_eq!(planes(&line([0.0, 3.0, 0.0])), [Plane::SideY]);
        assert_eq!(planes(&line([0.0; 3])), [Plane::SideX]);
        assert!(planes(&[]).is_empty());
    }
}
