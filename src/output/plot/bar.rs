//! Bars on a logarithmic scale.

use super::axis::Axis;
use super::canvas::{Align, Canvas, draw, text_width};
use super::colour;
use crate::output::OutputError;

const TITLE_SIZE: f64 = 15.0;
const LABEL_SIZE: f64 = 13.0;
const NAME_SIZE: f64 = 12.0;
const MARGIN: f64 = 12.0;
const ROW: f64 = 19.0;
const WIDTH: f64 = 520.0;

/// A bar and its name.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct NamedBar {
    /// What it stands for.
    pub name: String,
    /// Its value; what isn't a positive number has a name but no bar.
    pub value: f64,
}

/// One positive number for each of several things, one below the other, on a logarithmic scale.
///
/// ```
/// # use ropewalk::output::{BarPlot, NamedBar, OutputError};
/// let plot = BarPlot {
///     label: "error / tolerance".into(),
///     limit: Some(1.0),
///     bars: vec![NamedBar { name: "pendulum".into(), value: 0.03 }],
///     ..BarPlot::default()
/// };
/// assert!(plot.svg()?.contains("pendulum"));
/// # Ok::<(), OutputError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub struct BarPlot {
    /// Title above the plot; may be empty.
    pub title: String,
    /// Quantity and unit along the scale.
    pub label: String,
    /// A value that no bar should pass: it is marked by a line, and bars that do are shown in another colour.
    pub limit: Option<f64>,
    /// The bars, from the top down.
    pub bars: Vec<NamedBar>,
}

impl BarPlot {
    /// The picture as SVG text.
    ///
    /// # Errors
    /// [`OutputError::EmptyPlot`] if there is no bar.
    pub fn svg(&self) -> Result<String, OutputError> {
        let values = self.bars.iter().map(|b| b.value).filter(|v| v.is_finite() && *v > 0.0);
        let scale = Axis::covering(values.chain(self.limit), true, 0.05)
            .filter(|_| !self.bars.is_empty())
            .ok_or_else(|| OutputError::EmptyPlot { title: self.title.clone() })?;
        let names = self.bars.iter().map(|b| text_width(&b.name, NAME_SIZE)).fold(0.0, f64::max);
        let left = MARGIN + names + 8.0;
        let top = MARGIN + if self.title.is_empty() { 0.0 } else { ROW + 4.0 };
        let bottom = top + ROW * self.bars.len() as f64;
        let size = (left + WIDTH + 3.0 * MARGIN, bottom + 2.5 * ROW);
        draw(size.0, size.1, |canvas| {
            canvas.text(&self.title, (MARGIN, MARGIN + 6.0), TITLE_SIZE, Align::Left, true)?;
            for tick in scale.ticks(8).major {
                let x = left + tick.at * WIDTH;
                canvas.line([(x, top), (x, bottom)], 0.8, colour::GRID)?;
                canvas.text(&tick.label, (x, bottom + 0.6 * ROW), NAME_SIZE, Align::Centre, false)?;
            }
            self.draw_bars(canvas, &scale, left, top)?;
            if let Some(x) = self.limit.and_then(|l| scale.place(l)) {
                let x = left + x * WIDTH;
                canvas.line([(x, top), (x, bottom)], 1.6, colour::AXIS)?;
            }
            canvas.line([(left, top), (left, bottom), (left + WIDTH, bottom)], 1.0, colour::AXIS)?;
            let below = (left + 0.5 * WIDTH, bottom + 1.7 * ROW);
            canvas.text(&self.label, below, LABEL_SIZE, Align::Centre, false)
        })
    }

    fn draw_bars(
        &self,
        canvas: &mut Canvas<'_>,
        scale: &Axis,
        left: f64,
        top: f64,
    ) -> Result<(), OutputError> {
        for (k, bar) in self.bars.iter().enumerate() {
            let middle = top + (k as f64 + 0.5) * ROW;
            canvas.text(&bar.name, (left - 6.0, middle), NAME_SIZE, Align::Right, false)?;
            let passes = self.limit.is_some_and(|limit| !(bar.value <= limit));
            let place = if bar.value == f64::INFINITY { Some(1.0) } else { scale.place(bar.value) };
            if let Some(place) = place {
                let (high, low) = ((left, middle - 0.33 * ROW), (left + place * WIDTH, middle + 0.33 * ROW));
                canvas.rectangle(high, low, colour::of_series(usize::from(passes), 2))?;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bars_are_shown_as_far_as_they_have_a_value() {
        let bar = |name: &str, value| NamedBar { name: name.into(), value };
        let mut plot = BarPlot {
            title: "Title".into(),
            limit: Some(1.0),
            bars: vec![
                bar("small", 1e-4),
                bar("none", 0.0),
                bar("failed", f64::INFINITY),
                bar("odd", f64::NAN),
            ],
            ..BarPlot::default()
        };
        let svg = plot.svg().unwrap();
        assert!(["small", "none", "failed", "odd"].iter().all(|n| svg.contains(n)));
        // the paper and two bars
        assert_eq!(svg.matches("<rect").count(), 3, "{svg}");
        plot.bars.clear();
        assert!(plot.svg().is_err());
    }
}
