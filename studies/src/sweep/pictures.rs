//! The pictures of a sweep: every record over time with a line for each run, and its last value over the parameter.

use super::axis::Axis;
use super::finals::finals;
use super::grid::Grid;
use super::results::{Recorded, Results, Row};
use super::tail::Report;
use crate::run::{PLANES, last_shape, planes, view};
use crate::study::StudyFolder;
use ropewalk_report::{LinePlot, Mark, Plane, RunFolder, Series, Table};
use std::collections::HashMap;

/// More lines than this can't be told apart.
const MOST_LINES: usize = 24;
/// Points of a line beyond which it is thinned at once, long histories of many runs being too much for the memory.
const MOST_POINTS: usize = 20_000;

/// Draws everything and gives the number of pictures. A picture that can't be drawn is no reason to fail.
pub(super) fn draw(
    folder: &StudyFolder,
    grid: &Grid,
    axes: &[Axis],
    results: &Results,
    what: Report,
    warn: &mut dyn FnMut(&str),
) -> usize {
    let recorded = results.recorded();
    let Some((time, records)) = recorded.split_first() else { return 0 };
    let mut plots: Vec<(String, LinePlot)> = Vec::new();
    let with_history: Vec<(usize, &Row)> = results
        .rows()
        .filter(|(_, row)| Results::values(row, time).is_some_and(|v| v.last.is_finite()))
        .collect();
    let lines = chosen(&with_history);
    let titles = Titles::read(folder, grid, lines.iter().map(|(k, _)| *k));
    let mut histories: HashMap<&str, Vec<Series>> = HashMap::new();
    for (k, _) in &lines {
        let run = RunFolder::earlier(folder.run(grid.name(*k)));
        let table = match Table::read(&run.history_file()) {
            Ok(table) => table,
            Err(e) => {
                warn(&e.to_string());
                continue;
            }
        };
        for c in records {
            let Some(column) = table.columns.iter().find(|have| have.heading() == c.heading) else {
                continue;
            };
            let points = table.columns[0].values.iter().copied().zip(column.values.iter().copied()).collect();
            let line = Series::new(grid.label(*k), thinned(points));
            histories.entry(&c.heading).or_default().push(line);
        }
    }
    for c in records {
        let series = histories.remove(c.heading.as_str()).unwrap_or_default();
        let plot = LinePlot {
            title: titles.of(&c.name, &c.name, lines.len(), with_history.len()),
            x_label: time.heading.clone(),
            y_label: c.heading.clone(),
            series,
            ..LinePlot::default()
        };
        plots.push((c.name.clone(), plot));
    }

    for (c, axis) in records.iter().flat_map(|c| Some((c, axes.get(grid.main())?))) {
        let all = final_series(c, grid, axis, results, what);
        let series = chosen(&all);
        let plot = LinePlot {
            title: titles.of(&c.name, &format!("{} {}", c.name, what.words()), series.len(), all.len()),
            x_label: axis.label(),
            y_label: c.heading.clone(),
            series,
            ..LinePlot::default()
        };
        plots.push((format!("{}-{}", c.name, what.ending()), plot));
    }

    plots.extend(shapes(folder, grid, &lines, with_history.len(), &titles));

    let files = folder.files();
    plots.iter().filter(|(name, plot)| files.draw(name, |path| plot.write(path), warn)).count()
}

/// The shapes in which the runs ended, one over the other.
fn shapes(
    folder: &StudyFolder,
    grid: &Grid,
    lines: &[(usize, &Row)],
    all: usize,
    titles: &Titles,
) -> Vec<(String, LinePlot)> {
    let run = |k: usize| RunFolder::earlier(folder.run(grid.name(k)));
    let ends: Vec<_> =
        lines.iter().filter_map(|(k, _)| Some((*k, last_shape(&run(*k)).ok()?.points()))).collect();
    let together = [(0.0, ends.iter().flat_map(|(_, line)| line.iter().copied()).collect())];
    let seen = planes(&together);
    let asked = |plane: &Plane| seen.contains(plane) || titles.has(view(*plane).0);
    let plot = |plane: Plane| {
        let (name, from) = view(plane);
        let of = |(k, line): &(usize, Vec<_>)| {
            Series::new(grid.label(*k), line.iter().map(|x| plane.project(*x)).collect())
        };
        let (x_label, y_label) = plane.labels();
        let plot = LinePlot {
            title: titles.of(name, &format!("Shapes at the end, {from}"), ends.len(), all),
            x_label: x_label.into(),
            y_label: y_label.into(),
            series: ends.iter().map(of).collect(),
            equal_axes: true,
            ..LinePlot::default()
        };
        (name.to_string(), plot)
    };
    PLANES.into_iter().filter(asked).map(plot).collect()
}

/// The titles that the pictures of the runs have.
struct Titles {
    scenes: String,
    runs: Vec<HashMap<String, String>>,
}

impl Titles {
    fn read(folder: &StudyFolder, grid: &Grid, runs: impl Iterator<Item = usize>) -> Self {
        let read = |k: usize| {
            let manifest = RunFolder::earlier(folder.run(grid.name(k))).manifest_file();
            let text = std::fs::read_to_string(manifest).ok()?;
            let all: serde_json::Value = serde_json::from_str(&text).ok()?;
            serde_json::from_value(all["titles"].clone()).ok()
        };
        Titles { scenes: grid.scenes().join(" and "), runs: runs.filter_map(read).collect() }
    }

    /// Whether a run has a title for this picture.
    fn has(&self, picture: &str) -> bool {
        self.runs.iter().any(|titles| titles.contains_key(picture))
    }

    /// The title of a picture over some of the runs: what it shows, or the title that all of them have.
    fn of(&self, picture: &str, what: &str, shown: usize, all: usize) -> String {
        let own: Vec<&str> =
            self.runs.iter().filter_map(|titles| titles.get(picture).map(String::as_str)).collect();
        let what = match own.as_slice() {
            [first, rest @ ..] if rest.iter().all(|title| title == first) => {
                // what is shown at the end only says so
                let end = match what.strip_suffix(" at the end") {
                    Some(what) => format!(",{} at the end", what.strip_prefix(picture).unwrap_or_default()),
                    None => String::new(),
                };
                format!("{first}{end}")
            }
            _ => what.to_string(),
        };
        let scenes = &self.scenes;
        if shown < all { format!("{what}, {scenes}: {shown} of {all}") } else { format!("{what}, {scenes}") }
    }
}

/// Reported values over the first parameter; runs that differ in nothing else are a line.
fn final_series(column: &Recorded, grid: &Grid, axis: &Axis, results: &Results, what: Report) -> Vec<Series> {
    let mark = if grid.is_scattered() { Mark::Dots } else { Mark::LineAndDots };
    let lines = finals(column, grid, results, what).into_iter().map(|line| {
        let mut points: Vec<_> = line.values.iter().map(|&(i, value)| (axis.numbers[i], value)).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        Series::new(line.name, points).with_mark(mark)
    });
    lines.collect()
}

/// All of them, or some at equal distances if there are too many.
fn chosen<T: Clone>(all: &[T]) -> Vec<T> {
    let n = all.len();
    match n <= MOST_LINES {
        true => all.to_vec(),
        false => (0..MOST_LINES).map(|i| all[i * (n - 1) / (MOST_LINES - 1)].clone()).collect(),
    }
}

/// The least and the largest of so many neighbours that not too many points are left.
fn thinned(points: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    if points.len() <= MOST_POINTS {
        return points;
    }
    let each = points.len().div_ceil(MOST_POINTS / 2);
    let extremes = |some: &[(f64, f64)]| {
        let low = some.iter().copied().min_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((f64::NAN, f64::NAN));
        let high = some.iter().copied().max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((f64::NAN, f64::NAN));
        if low.0 <= high.0 { [low, high] } else { [high, low] }
    };
    points.chunks(each).flat_map(extremes).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn first_and_last_are_among_the_chosen() {
        let all: Vec<usize> = (0..1000).collect();
        let some = chosen(&all);
        assert_eq!((some.len(), some[0], some[MOST_LINES - 1]), (MOST_LINES, 0, 999));
        assert!(some.windows(2).all(|w| w[0] < w[1]));
        assert_eq!(chosen(&all[..5]), all[..5]);
    }

    #[test]
    fn a_title_that_all_runs_have_is_that_of_their_sweep() {
        let titles = |all: &[&str]| Titles {
            scenes: "hose".into(),
            runs: all.iter().map(|t| HashMap::from([("z".to_string(), t.to_string())])).collect(),
        };
        assert_eq!(titles(&["End", "End"]).of("z", "z at the end", 2, 3), "End, at the end, hose: 2 of 3");
        assert_eq!(titles(&["End", "Start"]).of("z", "z", 2, 2), "z, hose");
        assert_eq!(titles(&[]).of("z", "z", 0, 0), "z, hose");
    }

    #[test]
    fn peaks_survive_thinning() {
        let mut points: Vec<(f64, f64)> = (0..1_000_000).map(|i| (f64::from(i), 0.0)).collect();
        points[123_456].1 = 7.0;
        points[654_321].1 = -7.0;
        let few = thinned(points);
        assert!(few.len() <= MOST_POINTS);
        assert!(few.contains(&(123_456.0, 7.0)) && few.contains(&(654_321.0, -7.0)));
        assert!(few.windows(2).all(|w| w[0].0 <= w[1].0));
    }
}
