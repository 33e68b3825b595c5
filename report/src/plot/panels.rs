//! Several plots as one picture.

use std::path::Path;

use super::canvas::{Align, draw, wrapped};
use super::frame::{BOLD, MARGIN, ROW, Sheet, TITLE_SIZE};
use super::line::LinePlot;
use crate::{OutputError, write_atomic};

/// Widths of the plotting area by number of panels side by side, and heights by number of panels.
const WIDTHS: [f64; 3] = [600.0, 360.0, 270.0];
const HEIGHTS: [f64; 3] = [330.0, 240.0, 190.0];
/// Space between panels.
const GAP: f64 = 10.0;

/// Several plots as one SVG picture, side by side and below each other, with a title over all of them.
///
/// Use it for: components of a vector that differ by orders of magnitude, and more curves than one plot can hold. A legend
/// that all of them share is drawn once.
///
/// ```
/// # use ropewalk_report::{LinePlot, OutputError, Panels, Series};
/// let plot = |name: &str, y: f64| LinePlot {
///     x_label: "t [s]".into(),
///     y_label: name.into(),
///     series: vec![Series::new("hose", vec![(0.0, 0.0), (1.0, y)])],
///     ..LinePlot::default()
/// };
/// let both = vec![plot("x [m]", 1.0), plot("z [m]", 1e3)];
/// let panels = Panels { title: "End of the hose".into(), columns: 1, panels: both };
/// assert!(panels.svg()?.contains("z [m]"));
/// # Ok::<(), OutputError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Panels {
    /// Title above all; may be empty.
    pub title: String,
    /// Panels side by side.
    pub columns: usize,
    /// The plots, row by row.
    pub panels: Vec<LinePlot>,
}

impl Panels {
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
    /// [`OutputError::EmptyPlot`] without a panel, or where one has no finite point; [`OutputError::LogAxis`] as a plot.
    pub fn svg(&self) -> Result<String, OutputError> {
        let columns = self.columns.clamp(1, self.panels.len().max(1));
        let rows = self.panels.len().div_ceil(columns);
        if rows == 0 {
            return Err(OutputError::EmptyPlot { title: self.title.clone() });
        }
        let size = (WIDTHS[columns.min(3) - 1], HEIGHTS[rows.min(3) - 1]);
        let sheets: Vec<Sheet<'_>> = self.sheets(size)?;

        // axes of a column begin at the same place, those of a row end at the same height
        let of_column = |j: usize| sheets.iter().skip(j).step_by(columns);
        let of_row = |i: usize| sheets.iter().skip(i * columns).take(columns);
        let largest = |all: &mut dyn Iterator<Item = f64>| all.fold(0.0, f64::max);
        let lefts: Vec<f64> = (0..columns).map(|j| largest(&mut of_column(j).map(Sheet::left))).collect();
        let widths: Vec<f64> = (0..columns)
            .map(|j| lefts[j] + largest(&mut of_column(j).map(|s| s.size().0 - s.left())))
            .collect();
        let heights: Vec<f64> = (0..rows).map(|i| largest(&mut of_row(i).map(|s| s.size().1))).collect();
        let width = widths.iter().sum::<f64>() + GAP * (columns - 1) as f64;
        let title = wrapped(&self.title, TITLE_SIZE * BOLD, width - 2.0 * MARGIN);
        let top = if title.is_empty() { 0.0 } else { 0.5 * MARGIN + title.len() as f64 * (ROW + 1.0) };
        let height = top + heights.iter().sum::<f64>() + GAP * (rows - 1) as f64;

        Ok(draw(width, height, |canvas| {
            for (i, line) in title.iter().enumerate() {
                let at = (MARGIN, MARGIN + 8.0 + i as f64 * (ROW + 1.0));
                canvas.text(line, at, TITLE_SIZE, Align::Left, true);
            }
            let mut y = top;
            for (i, height) in heights.iter().enumerate() {
                let mut x = 0.0;
                for (j, sheet) in of_row(i).enumerate() {
                    canvas.origin = (x + lefts[j] - sheet.left(), y + height - sheet.size().1);
                    let plot = &self.panels[i * columns + j];
                    sheet.put(canvas, |canvas, area| plot.paint(canvas, area));
                    x += widths[j] + GAP;
                }
                y += height + GAP;
            }
            canvas.origin = (0.0, 0.0);
        }))
    }

    /// The frames of all panels.
    fn sheets(&self, size: (f64, f64)) -> Result<Vec<Sheet<'_>>, OutputError> {
        let mut frames = Vec::new();
        for plot in &self.panels {
            let mut frame = plot.frame()?;
            frame.area = size;
            frame.heads_page = self.title.is_empty();
            frames.push(frame);
        }
        let shared = frames.len() > 1 && frames.iter().all(|f| f.legend == frames[0].legend);
        if shared {
            frames.iter_mut().skip(1).for_each(|f| f.legend.clear());
        }
        Ok(frames.into_iter().map(Sheet::new).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Series;

    fn plot(y_label: &str, labels: &[&str]) -> LinePlot {
        let series = |l: &&str| Series::new(*l, vec![(0.0, 1.0), (1.0, 2.0)]);
        LinePlot {
            x_label: "t [s]".into(),
            y_label: y_label.into(),
            series: labels.iter().map(series).collect(),
            ..LinePlot::default()
        }
    }

    fn panels(all: Vec<LinePlot>, columns: usize) -> String {
        Panels { title: "All".into(), columns, panels: all }.svg().unwrap()
    }

    #[test]
    fn a_legend_that_all_share_stands_once() {
        let svg = panels(vec![plot("x [m]", &["one", "two"]), plot("y [m]", &["one", "two"])], 1);
        assert_eq!(svg.matches(">\ntwo\n<").count(), 1);
        let svg = panels(vec![plot("x [m]", &["one", "two"]), plot("y [m]", &["one", "three"])], 1);
        assert_eq!((svg.matches(">\none\n<").count(), svg.matches(">\nthree\n<").count()), (2, 1));
    }

    #[test]
    fn panels_lie_side_by_side_and_below_each_other() {
        let size = |svg: &str| {
            let number = |name: &str| -> f64 {
                let rest = svg.split_once(&format!("{name}=\"")).unwrap().1;
                rest.split_once('"').unwrap().0.parse().unwrap()
            };
            (number("width"), number("height"))
        };
        let all = || vec![plot("x [m]", &["one"]), plot("y [m]", &["one"])];
        let (below, beside) = (size(&panels(all(), 1)), size(&panels(all(), 2)));
        assert!(below.1 > below.0 * 0.7 && beside.0 > 2.0 * beside.1, "{below:?} {beside:?}");
        assert!(Panels::default().svg().is_err());
    }
}
