//! Quantities over time, or one over another.

use std::path::Path;

use super::axis::Axis;
use super::canvas::{Canvas, Pen};
use super::colour::Colour;
use super::frame::{AREA, Area, Entry, Frame};
use super::shape::draw_directions;
use super::{clip, colour, thin};
use crate::{OutputError, write_atomic};

/// Points of all series together; at some ten bytes each a file stays below 300 kB.
const BUDGET: usize = 18_000;
/// Dots of all series together; they are more text each.
const DOT_BUDGET: usize = 1_500;
const LINE_WIDTH: f64 = 1.6;
const GUIDE_WIDTH: f64 = 1.0;
const DOT_RADIUS: f64 = 3.0;
/// Dashes and gaps of the curves of a plot, in pixels, one after the other; the first curve is solid.
const PATTERNS: [&[f64]; 8] = [
    &[],
    &[9.0, 4.0],
    &[2.5, 3.5],
    &[11.0, 3.5, 2.5, 3.5],
    &[16.0, 5.0],
    &[5.0, 3.0],
    &[11.0, 3.5, 2.5, 3.5, 2.5, 3.5],
    &[1.5, 6.0],
];

/// How the points of a series are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Mark {
    /// A line through the points: for what was computed.
    #[default]
    Line,
    /// A dot at each point: for what was measured or published.
    Dots,
    /// Both: for few points, such as those of a convergence study.
    LineAndDots,
    /// A thin grey line: for what stands around, such as a drum or a limit.
    Guide,
}

/// One curve of a [`LinePlot`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Series {
    /// Its name in the legend.
    pub label: String,
    /// Its points in order. One that isn't finite breaks the line.
    pub points: Vec<(f64, f64)>,
    /// How they are drawn.
    pub mark: Mark,
}

impl Series {
    /// A line through `points`.
    pub fn new(label: impl Into<String>, points: Vec<(f64, f64)>) -> Self {
        Self { label: label.into(), points, mark: Mark::Line }
    }

    /// The same points, drawn in another way.
    #[must_use]
    pub fn with_mark(mut self, mark: Mark) -> Self {
        self.mark = mark;
        self
    }
}

/// Quantities over time, or one over another, as an SVG picture.
///
/// Use it for histories of a run, paths in a plane (`equal_axes`) and convergence studies
/// (`log_x`, `log_y`). A million points are no problem: what can't be seen is left out.
///
/// ```
/// # use ropewalk_report::{LinePlot, OutputError, Series};
/// let plot = LinePlot {
///     title: "Tension at the upper end".into(),
///     x_label: "t [s]".into(),
///     y_label: "tension [N]".into(),
///     series: vec![Series::new("hose", vec![(0.0, 250.0), (0.1, 252.5)])],
///     ..LinePlot::default()
/// };
/// assert!(plot.svg()?.starts_with("<svg"));
/// # Ok::<(), OutputError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LinePlot {
    /// Title above the plot; may be empty.
    pub title: String,
    /// Quantity and unit along the horizontal axis, such as `t [s]`.
    pub x_label: String,
    /// Quantity and unit along the vertical axis, such as `tension [N]`.
    pub y_label: String,
    /// The curves; with more than one there is a legend.
    pub series: Vec<Series>,
    /// Whether a unit has the same length on both axes; for paths in space. Has no effect where
    /// only one of the axes is logarithmic.
    pub equal_axes: bool,
    /// Whether the horizontal axis is logarithmic; points at x ≤ 0 are then left out.
    pub log_x: bool,
    /// Whether the vertical axis is logarithmic; points at y ≤ 0 are then left out.
    pub log_y: bool,
    /// Least and largest value of the vertical axis; without it all points are shown. What lies beyond is cut off.
    pub y_range: Option<(f64, f64)>,
    /// Whether the curves are ordered, as shapes at one time after the other: coloured from dark to light.
    pub ordered: bool,
    /// Whether curves differ by dashes as well as by colour, for print in grey.
    pub dashed: bool,
    /// How many curves that follow each other share a colour, and then differ by their dashes; 0 for none.
    pub together: usize,
    /// Directions of x, y and z in the plane, drawn as a small cross of axes if there are any.
    pub directions: Vec<(f64, f64)>,
}

impl LinePlot {
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
    /// [`OutputError::EmptyPlot`] without a finite point; [`OutputError::LogAxis`] without a
    /// positive value on a logarithmic axis.
    pub fn svg(&self) -> Result<String, OutputError> {
        Ok(self.frame()?.draw(|canvas, area| self.paint(canvas, area)))
    }

    /// All but the data.
    pub(super) fn frame(&self) -> Result<Frame<'_>, OutputError> {
        let (x, y) = self.axes()?;
        Ok(Frame {
            title: &self.title,
            x_label: &self.x_label,
            y_label: &self.y_label,
            x,
            y,
            equal: self.equal_axes && self.log_x == self.log_y,
            legend: self.legend(),
            bar: None,
            area: AREA,
            heads_page: true,
        })
    }

    /// The data.
    pub(super) fn paint(&self, canvas: &mut Canvas, area: &Area) {
        for (index, series) in self.series.iter().enumerate() {
            self.draw_series(canvas, area, index, series);
        }
        draw_directions(canvas, area, &self.directions);
    }

    fn axes(&self) -> Result<(Axis, Axis), OutputError> {
        let finite = || {
            let points = self.series.iter().flat_map(|s| s.points.iter().copied());
            points.filter(|(x, y)| x.is_finite() && y.is_finite())
        };
        let shown = || finite().filter(|(x, y)| (!self.log_x || *x > 0.0) && (!self.log_y || *y > 0.0));
        let (x_margin, y_margin) = self.margins();
        let x = Axis::covering(shown().map(|p| p.0), self.log_x, x_margin);
        let y = match self.y_range {
            Some((low, high)) => Axis::covering([low, high].into_iter(), self.log_y, 0.0),
            None => Axis::covering(shown().map(|p| p.1), self.log_y, y_margin),
        };
        let title = || self.title.clone();
        match (x, y) {
            (Some(x), Some(y)) => Ok((x, y)),
            _ if finite().next().is_none() || !(self.log_x || self.log_y) => {
                Err(OutputError::EmptyPlot { title: title() })
            }
            _ => Err(OutputError::LogAxis {
                title: title(),
                axis: match self.log_x && !finite().any(|p| p.0 > 0.0) {
                    true => "x",
                    false if self.log_y => "y",
                    false => "x",
                },
            }),
        }
    }

    /// A history fills its time axis; what runs in any direction, or has dots, keeps off the edge.
    fn margins(&self) -> (f64, f64) {
        let is_history = |s: &Series| {
            matches!(s.mark, Mark::Line | Mark::Guide) && !s.points.windows(2).any(|w| w[1].0 < w[0].0)
        };
        let fills = !self.equal_axes && !self.log_x && self.series.iter().all(is_history);
        (if fills { 0.0 } else { 0.04 }, 0.06)
    }

    /// Colour and dashes of a curve. Guides have neither, and don't count.
    fn look(&self, index: usize) -> (Colour, &'static [f64]) {
        let curves = |series: &[Series]| series.iter().filter(|s| s.mark != Mark::Guide).count();
        let (place, count) = (curves(&self.series[..index]), curves(&self.series));
        match self.series[index].mark {
            Mark::Guide => (colour::AXIS, PATTERNS[0]),
            _ if self.ordered => (colour::ramp(place as f64 / (count.max(2) - 1) as f64), PATTERNS[0]),
            _ => {
                let each = self.together.max(1);
                let colour = colour::of_series(place / each, count.div_ceil(each));
                (colour, PATTERNS[if self.dashed { place % PATTERNS.len() } else { 0 }])
            }
        }
    }

    fn legend(&self) -> Vec<Entry> {
        if self.series.len() < 2 {
            return Vec::new();
        }
        let entry = |(index, series): (usize, &Series)| {
            let (colour, dashes) = self.look(index);
            Entry { label: series.label.clone(), colour, mark: series.mark, dashes }
        };
        // what is drawn in several pieces is named once
        self.series.iter().enumerate().filter(|(_, s)| !s.label.is_empty()).map(entry).collect()
    }

    fn draw_series(&self, canvas: &mut Canvas, area: &Area, index: usize, series: &Series) {
        let count = self.series.len();
        let (colour, dashes) = self.look(index);
        let width = if series.mark == Mark::Guide { GUIDE_WIDTH } else { LINE_WIDTH };
        let pixels: Vec<_> = series.points.iter().map(|p| area.pixel(*p)).collect();
        if series.mark != Mark::Dots {
            let mut lonely = Vec::new();
            for run in thin::runs(&pixels, BUDGET / count) {
                let parts = match self.y_range {
                    Some(_) => clip::within(&run, area.edges()),
                    None => vec![run],
                };
                for part in parts {
                    match part[..] {
                        [only] => lonely.push(Some(only)),
                        _ => canvas.line(part, Pen { width, colour, dashes }),
                    }
                }
            }
            for dot in thin::dots(&lonely, DOT_BUDGET / count) {
                canvas.dot(dot, 0.8 * DOT_RADIUS, colour);
            }
        }
        if matches!(series.mark, Mark::Dots | Mark::LineAndDots) {
            let [_, top, _, bottom] = area.edges();
            let inside = |p: &Option<thin::Pixel>| p.is_some_and(|p| (top..=bottom).contains(&p.1));
            let shown: Vec<_> = pixels.into_iter().filter(inside).collect();
            for dot in thin::dots(&shown, DOT_BUDGET / count) {
                canvas.dot(dot, DOT_RADIUS, colour);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plot(series: Vec<Vec<(f64, f64)>>) -> LinePlot {
        LinePlot {
            title: "Title".into(),
            x_label: "t [s]".into(),
            y_label: "x [m]".into(),
            series: series
                .into_iter()
                .enumerate()
                .map(|(i, points)| Series::new(format!("series {i}"), points))
                .collect(),
            ..LinePlot::default()
        }
    }

    fn count(svg: &str, what: &str) -> usize {
        svg.matches(what).count()
    }

    #[test]
    fn a_legend_comes_with_the_second_series() {
        let points = vec![(0.0, 0.0), (1.0, 1.0)];
        assert!(!plot(vec![points.clone()]).svg().unwrap().contains("series 0"));
        let svg = plot(vec![points.clone(), points]).svg().unwrap();
        assert!(svg.contains("series 0") && svg.contains("series 1"));
    }

    #[test]
    fn nothing_to_show_is_an_error() {
        for series in [vec![], vec![vec![]], vec![vec![(f64::NAN, 1.0), (0.0, f64::INFINITY)]]] {
            let error = plot(series).svg().unwrap_err();
            assert!(matches!(error, OutputError::EmptyPlot { .. }));
        }
        let mut negative = plot(vec![vec![(1.0, -1.0)]]);
        negative.log_y = true;
        assert!(matches!(negative.svg().unwrap_err(), OutputError::LogAxis { axis: "y", .. }));
    }

    #[test]
    fn one_point_and_constant_data_are_shown() {
        assert_eq!(count(&plot(vec![vec![(3.0, 4.0)]]).svg().unwrap(), "<circle"), 1);
        let svg = plot(vec![vec![(0.0, 9.81), (1.0, 9.81)]]).svg().unwrap();
        assert!(svg.contains("#0072B2") && !svg.contains("NaN"));
    }

    #[test]
    fn a_gap_breaks_the_line() {
        let mut points: Vec<_> = (0..10).map(|i| (f64::from(i), f64::from(i * i))).collect();
        let lines = |points: &[(f64, f64)]| count(&plot(vec![points.to_vec()]).svg().unwrap(), "#0072B2");
        assert_eq!(lines(&points), 1);
        points[5].1 = f64::NAN;
        assert_eq!(lines(&points), 2);
    }

    #[test]
    fn long_runs_make_small_files() {
        let wild = |k: usize, n: usize| -> Vec<(f64, f64)> {
            (0..n).map(|i| (i as f64, (i as f64 * (1.3 + k as f64)).sin())).collect()
        };
        for (series, points) in [(1, 1_000_000), (8, 20_000), (40, 2_000)] {
            let svg = plot((0..series).map(|k| wild(k, points)).collect()).svg().unwrap();
            assert!(svg.len() < 300_000, "{series} series: {} bytes", svg.len());
        }
        let mut dots = plot(vec![wild(0, 100_000)]);
        dots.series[0].mark = Mark::LineAndDots;
        assert!(dots.svg().unwrap().len() < 300_000);
        let mut gaps = wild(0, 100_000);
        gaps.iter_mut().step_by(3).for_each(|p| p.1 = f64::NAN);
        assert!(plot(vec![gaps]).svg().unwrap().len() < 300_000);
    }

    #[test]
    fn a_plot_is_written_to_its_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("x.svg");
        plot(vec![vec![(0.0, 1.0), (1.0, 2.0)]]).write(&path).unwrap();
        assert!(std::fs::read_to_string(path).unwrap().starts_with("<svg"));
    }
}
