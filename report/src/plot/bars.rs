//! Quantities side by side, each a bar with its name.

use std::path::Path;

use super::axis::Axis;
use super::canvas::{Align, Pen, draw, fitted, text_width, wrapped};
use super::colour::{self, Colour};
use crate::{OutputError, write_atomic};

const TITLE_SIZE: f64 = 15.0;
const TEXT_SIZE: f64 = 12.0;
const MARGIN: f64 = 12.0;
const ROW: f64 = 22.0;
const BAR: f64 = 13.0;
/// Width of the area in which bars grow, and most that names take.
const WIDTH: f64 = 380.0;
const MOST_NAME: f64 = 330.0;
/// Decades of a logarithmic axis; what is smaller has no bar.
const DECADES: i32 = 6;

/// One bar of a [`BarPlot`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Bar {
    /// What it is.
    pub label: String,
    /// Its length; nothing is drawn for a value that isn't positive.
    pub value: f64,
    /// What stands behind it, such as the number.
    pub note: String,
    /// Its group, 0, 1, …: bars of a group have one colour.
    pub group: usize,
}

/// Quantities side by side as an SVG picture: a bar for each, from left to right, with its name in front.
///
/// ```
/// # use ropewalk_report::{Bar, BarPlot, OutputError};
/// let drag = Bar { label: "drag".into(), value: 0.4, note: "40 %".into(), group: 0 };
/// let plot = BarPlot { title: "Time".into(), axis: "share".into(), bars: vec![drag], ..BarPlot::default() };
/// assert!(plot.svg()?.contains("40 %"));
/// # Ok::<(), OutputError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub struct BarPlot {
    /// Title above the plot; may be empty.
    pub title: String,
    /// Quantity and unit along the axis.
    pub axis: String,
    /// The bars, from above.
    pub bars: Vec<Bar>,
    /// Names of the groups; with more than one there is a legend.
    pub groups: Vec<String>,
    /// Whether the axis is logarithmic, over the last few decades below the largest value.
    pub log: bool,
    /// A value that is marked by a line across all bars, and its name.
    pub mark: Option<(f64, String)>,
}

impl BarPlot {
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
    /// [`OutputError::EmptyPlot`] without a positive value.
    pub fn svg(&self) -> Result<String, OutputError> {
        let axis = self.scale().ok_or_else(|| OutputError::EmptyPlot { title: self.title.clone() })?;
        let widest = |texts: &mut dyn Iterator<Item = &String>| {
            texts.map(|t| text_width(t, TEXT_SIZE)).fold(0.0, f64::max)
        };
        let names = widest(&mut self.bars.iter().map(|b| &b.label)).min(MOST_NAME);
        let notes = widest(&mut self.bars.iter().map(|b| &b.note)).min(MOST_NAME);
        let (left, right) = (MARGIN + names + 8.0, MARGIN + names + 8.0 + WIDTH);
        let width = right + 8.0 + notes + MARGIN;
        let title = wrapped(&self.title, TITLE_SIZE * 1.08, width - 2.0 * MARGIN);
        let legend = self.groups.len() > 1;
        let marked = self.mark.is_some();
        let top = MARGIN + (title.len() + usize::from(legend) + usize::from(marked)) as f64 * 20.0 + 6.0;
        let bottom = top + self.bars.len() as f64 * ROW;
        let x = |value: f64| axis.place(value).map(|p| left + p.clamp(0.0, 1.0) * WIDTH);
        Ok(draw(width, bottom + 48.0, |c| {
            for (i, line) in title.iter().enumerate() {
                c.text(line, (MARGIN, MARGIN + 8.0 + 20.0 * i as f64), TITLE_SIZE, Align::Left, true);
            }
            let mut pen = MARGIN;
            for (g, name) in self.groups.iter().enumerate().filter(|_| legend) {
                let y = MARGIN + 8.0 + 20.0 * title.len() as f64;
                c.rectangle((pen, y - 6.0), (pen + 12.0, y + 6.0), self.colour(g));
                c.text(name, (pen + 18.0, y), TEXT_SIZE, Align::Left, false);
                pen += 18.0 + text_width(name, TEXT_SIZE) + 18.0;
            }
            for tick in &axis.ticks(5).major {
                let at = left + tick.at * WIDTH;
                c.line([(at, top), (at, bottom)], Pen::solid(0.8, colour::GRID));
                c.text(&tick.label, (at, bottom + 12.0), TEXT_SIZE, Align::Centre, false);
            }
            if let Some((value, name)) = &self.mark
                && let Some(at) = x(*value)
            {
                c.line([(at, top - 3.0), (at, bottom)], Pen::solid(1.5, colour::AXIS));
                c.text(name, (at, top - 11.0), TEXT_SIZE, Align::Centre, false);
            }
            c.text(&self.axis, (0.5 * (left + right), bottom + 32.0), TEXT_SIZE, Align::Centre, false);
            for (i, bar) in self.bars.iter().enumerate() {
                let y = top + (i as f64 + 0.5) * ROW;
                let label = fitted(&bar.label, TEXT_SIZE, MOST_NAME);
                c.text(&label, (left - 8.0, y), TEXT_SIZE, Align::Right, false);
                let end = x(bar.value).filter(|_| bar.value > 0.0).unwrap_or(left);
                if end > left {
                    c.rectangle((left, y - 0.5 * BAR), (end, y + 0.5 * BAR), self.colour(bar.group));
                }
                let note = fitted(&bar.note, TEXT_SIZE, MOST_NAME);
                if let Some(at) = self.mark.as_ref().and_then(|m| x(m.0))
                    && end < at
                {
                    // the line of the mark doesn't run through words
                    let wide = text_width(&note, TEXT_SIZE);
                    c.rectangle((end + 3.0, y - 8.0), (end + 9.0 + wide, y + 8.0), colour::PAPER);
                }
                c.text(&note, (end + 6.0, y), TEXT_SIZE, Align::Left, false);
            }
            c.line([(left, top), (left, bottom), (right, bottom)], Pen::solid(1.0, colour::AXIS));
        }))
    }

    fn colour(&self, group: usize) -> Colour {
        colour::of_series(group, self.groups.len().max(1))
    }

    fn scale(&self) -> Option<Axis> {
        let values = || self.bars.iter().map(|b| b.value).filter(|v| *v > 0.0 && v.is_finite());
        let most = values().chain(self.mark.iter().map(|m| m.0)).reduce(f64::max)?;
        values().next()?;
        let least = if self.log { most * 10_f64.powi(-DECADES) } else { 0.0 };
        Axis::covering([least, most].into_iter(), self.log, 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plot(values: &[f64]) -> BarPlot {
        let bar = |(k, &value): (usize, &f64)| Bar { label: format!("bar {k}"), value, ..Bar::default() };
        BarPlot { bars: values.iter().enumerate().map(bar).collect(), ..BarPlot::default() }
    }

    #[test]
    fn every_bar_has_its_name_and_only_positive_values_a_length() {
        for log in [false, true] {
            let svg = BarPlot { log, ..plot(&[1.0, 0.5, 0.0, -1.0, f64::NAN, f64::INFINITY, 1e-20]) }.svg();
            let svg = svg.unwrap();
            for k in 0..7 {
                assert!(svg.contains(&format!("bar {k}")), "{k}");
            }
            assert!(!svg.contains("NaN") && !svg.contains("inf"));
        }
    }

    #[test]
    fn nothing_to_show_is_an_error() {
        for values in [&[][..], &[0.0, -1.0, f64::NAN]] {
            assert!(matches!(plot(values).svg(), Err(OutputError::EmptyPlot { .. })));
        }
    }
}
