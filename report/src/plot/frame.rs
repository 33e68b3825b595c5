//! What surrounds the data of a plot: title, legend, axes, grid, colour bar; and where they go.

use super::axis::{Axis, Ticks};
use super::canvas::{Align, Canvas, Pen, draw, fitted, text_width, wrapped};
use super::colour::{self, Colour};
use super::line::Mark;
use super::thin::Pixel;

pub(super) const TITLE_SIZE: f64 = 15.0;
/// Titles of panels, below that of the picture.
const PANEL_SIZE: f64 = 13.0;
const LABEL_SIZE: f64 = 13.0;
const TICK_SIZE: f64 = 12.0;
/// Bold letters are this much wider.
pub(super) const BOLD: f64 = 1.08;
/// The plotting area: its size, and its limits where both axes have one scale.
pub(super) const AREA: (f64, f64) = (600.0, 330.0);
const LEAST_AREA: (f64, f64) = (220.0, 110.0);
const MOST_AREA: (f64, f64) = (600.0, 520.0);
pub(super) const MARGIN: f64 = 12.0;
pub(super) const ROW: f64 = 19.0;
const TICK_LENGTH: f64 = 4.0;
const SWATCH: f64 = 26.0;
const BAR_WIDTH: f64 = 12.0;
const BAR_GAP: f64 = 18.0;

/// An entry of the legend.
#[derive(PartialEq)]
pub(super) struct Entry {
    pub(super) label: String,
    pub(super) colour: Colour,
    pub(super) mark: Mark,
    /// Lengths of dashes and gaps; none for a solid line.
    pub(super) dashes: &'static [f64],
}

/// A scale of colours at the right-hand side.
pub(super) struct Bar {
    pub(super) label: String,
    pub(super) axis: Axis,
}

/// A plot but for its data.
pub(super) struct Frame<'p> {
    pub(super) title: &'p str,
    pub(super) x_label: &'p str,
    pub(super) y_label: &'p str,
    pub(super) x: Axis,
    pub(super) y: Axis,
    /// Whether a unit has the same length on both axes.
    pub(super) equal: bool,
    pub(super) legend: Vec<Entry>,
    pub(super) bar: Option<Bar>,
    /// Size of the plotting area; where both axes have one scale, the most it may have across.
    pub(super) area: (f64, f64),
    /// Whether its title is that of the picture.
    pub(super) heads_page: bool,
}

/// The rectangle in which data are drawn.
pub(super) struct Area {
    left: f64,
    top: f64,
    width: f64,
    height: f64,
    x: Axis,
    y: Axis,
}

impl Area {
    /// A data point in pixels; `None` if it can't be shown.
    pub(super) fn pixel(&self, point: (f64, f64)) -> Option<Pixel> {
        let (x, y) = (self.x.place(point.0)?, self.y.place(point.1)?);
        Some((self.across(x), self.down(y)))
    }

    /// A point in pixels at this distance from the left and from below.
    pub(super) fn corner(&self, distance: f64) -> Pixel {
        (self.left + distance, self.bottom() - distance)
    }

    /// Left, top, right, bottom.
    pub(super) fn edges(&self) -> [f64; 4] {
        [self.left, self.top, self.right(), self.bottom()]
    }

    fn across(&self, place: f64) -> f64 {
        self.left + place * self.width
    }

    fn down(&self, place: f64) -> f64 {
        self.top + (1.0 - place) * self.height
    }

    fn right(&self) -> f64 {
        self.left + self.width
    }

    fn bottom(&self) -> f64 {
        self.top + self.height
    }
}

/// All that the sizes depend on.
struct Layout {
    area: Area,
    size: (f64, f64),
    title: Vec<String>,
    /// Where each entry of the legend begins.
    legend: Vec<Pixel>,
    x_ticks: Ticks,
    y_ticks: Ticks,
    bar_ticks: Ticks,
}

/// A frame laid out.
pub(super) struct Sheet<'p> {
    frame: Frame<'p>,
    layout: Layout,
}

impl<'p> Sheet<'p> {
    pub(super) fn new(frame: Frame<'p>) -> Self {
        Self { layout: frame.layout(), frame }
    }

    /// Width and height.
    pub(super) fn size(&self) -> (f64, f64) {
        self.layout.size
    }

    /// Where the plotting area begins.
    pub(super) fn left(&self) -> f64 {
        self.layout.area.left
    }

    /// Draws the frame, and the data by `paint`.
    pub(super) fn put(&self, canvas: &mut Canvas, paint: impl FnOnce(&mut Canvas, &Area)) {
        let Self { frame, layout } = self;
        layout.draw_grid(canvas);
        paint(canvas, &layout.area);
        layout.draw_axes(canvas);
        frame.draw_labels(canvas, layout);
        frame.draw_legend(canvas, layout);
        frame.draw_bar(canvas, layout);
    }
}

impl Frame<'_> {
    /// Draws the frame, and the data by `paint`, and returns the SVG text.
    pub(super) fn draw(self, paint: impl FnOnce(&mut Canvas, &Area)) -> String {
        let sheet = Sheet::new(self);
        draw(sheet.size().0, sheet.size().1, |canvas| sheet.put(canvas, paint))
    }

    fn title_size(&self) -> f64 {
        if self.heads_page { TITLE_SIZE } else { PANEL_SIZE }
    }

    fn layout(&self) -> Layout {
        let (mut x, mut y) = (self.x, self.y);
        let (mut width, mut height) = self.area;
        if self.equal {
            let scale = (self.area.0 / x.span()).min(MOST_AREA.1 * self.area.0 / MOST_AREA.0 / y.span());
            width = (x.span() * scale).max(LEAST_AREA.0);
            height = (y.span() * scale).max(LEAST_AREA.1);
            x.widen_to(width / scale);
            y.widen_to(height / scale);
        }
        let x_ticks = ticks_across(&x, width);
        let y_ticks = y.ticks((height / 45.0) as usize);
        let bar_ticks =
            self.bar.as_ref().map_or_else(Ticks::default, |bar| bar.axis.ticks((height / 45.0) as usize));

        let label_row = if self.y_label.is_empty() { 0.0 } else { ROW };
        let left = MARGIN + label_row + y_ticks.label_width(TICK_SIZE) + TICK_LENGTH + 8.0;
        let right = match self.bar {
            Some(_) => BAR_GAP + BAR_WIDTH + 8.0 + bar_ticks.label_width(TICK_SIZE) + MARGIN,
            None => (0.5 * x_ticks.label_width(TICK_SIZE)).max(MARGIN) + 4.0,
        };
        let total_width = left + width + right;

        let room = total_width - left - MARGIN;
        let title = wrapped(self.title, self.title_size() * BOLD, room);
        let mut top = MARGIN + title.len() as f64 * (ROW + 1.0);
        let mut legend = Vec::new();
        let mut pen = left;
        for entry in &self.legend {
            let wide = entry_width(entry, room);
            if pen > left && pen + wide > left + room {
                pen = left;
                top += ROW;
            }
            legend.push((pen, top + 0.5 * ROW));
            pen += wide;
        }
        if !legend.is_empty() {
            top += ROW;
        }
        top += if y_ticks.factor.is_some() || self.bar.is_some() { ROW + 4.0 } else { 7.0 };
        let named = !self.x_label.is_empty() || x_ticks.factor.is_some();
        let bottom = TICK_LENGTH + ROW + MARGIN + if named { ROW } else { 0.0 };
        Layout {
            size: (total_width, top + height + bottom),
            area: Area { left, top, width, height, x, y },
            title,
            legend,
            x_ticks,
            y_ticks,
            bar_ticks,
        }
    }

    fn draw_labels(&self, canvas: &mut Canvas, layout: &Layout) {
        let area = &layout.area;
        for (i, line) in layout.title.iter().enumerate() {
            let at = (area.left, MARGIN + 8.0 + i as f64 * (ROW + 1.0));
            canvas.text(line, at, self.title_size(), Align::Left, true);
        }
        let below = area.bottom() + TICK_LENGTH + ROW + 0.6 * ROW;
        let mut room = layout.size.0 - 2.0 * MARGIN;
        let middle = area.left + 0.5 * area.width;
        if let Some(factor) = &layout.x_ticks.factor {
            let at = (area.right(), below);
            canvas.text(factor, at, TICK_SIZE, Align::Right, false);
            room = area.width - 2.0 * text_width(factor, TICK_SIZE) - MARGIN;
        }
        room = room.min(2.0 * (layout.size.0 - middle - 4.0));
        let label = fitted(self.x_label, LABEL_SIZE, room);
        canvas.text(&label, (middle, below), LABEL_SIZE, Align::Centre, false);

        let middle = area.top + 0.5 * area.height;
        let room = 2.0 * (middle - 4.0).min(layout.size.1 - middle - 4.0);
        let label = fitted(self.y_label, LABEL_SIZE, room);
        let at = (MARGIN + 0.4 * ROW, middle);
        canvas.text(&label, at, LABEL_SIZE, Align::Upwards, false);
        if let Some(factor) = &layout.y_ticks.factor {
            let at = (area.left, area.top - 10.0);
            canvas.text(factor, at, TICK_SIZE, Align::Left, false);
        }
    }

    fn draw_legend(&self, canvas: &mut Canvas, layout: &Layout) {
        for (entry, (x, y)) in self.legend.iter().zip(&layout.legend) {
            let width = if entry.mark == Mark::Guide { 1.0 } else { 2.0 };
            if entry.mark != Mark::Dots {
                let pen = Pen { width, colour: entry.colour, dashes: entry.dashes };
                canvas.line([(*x, *y), (x + SWATCH, *y)], pen);
            }
            if matches!(entry.mark, Mark::Dots | Mark::LineAndDots) {
                canvas.dot((x + 0.5 * SWATCH, *y), 3.0, entry.colour);
            }
            let room = layout.size.0 - x - SWATCH - 6.0 - MARGIN;
            let label = fitted(&entry.label, TICK_SIZE, room);
            canvas.text(&label, (x + SWATCH + 6.0, *y), TICK_SIZE, Align::Left, false);
        }
    }

    fn draw_bar(&self, canvas: &mut Canvas, layout: &Layout) {
        const SHADES: u32 = 64;
        let Some(bar) = &self.bar else {
            return;
        };
        let area = &layout.area;
        let left = area.right() + BAR_GAP;
        let right = left + BAR_WIDTH;
        for i in 0..SHADES {
            let low = f64::from(i) / f64::from(SHADES);
            // Each shade reaches up to the end, under the next, so that no seam shows.
            canvas.rectangle(
                (left, area.top),
                (right, area.down(low)),
                colour::ramp(low + 0.5 / f64::from(SHADES)),
            );
        }
        for tick in &layout.bar_ticks.major {
            let y = area.down(tick.at);
            canvas.line([(right, y), (right + TICK_LENGTH, y)], Pen::solid(1.0, colour::AXIS));
            let at = (right + 8.0, y);
            canvas.text(&tick.label, at, TICK_SIZE, Align::Left, false);
        }
        let label = match &layout.bar_ticks.factor {
            Some(factor) => format!("{factor} {}", bar.label),
            None => bar.label.clone(),
        };
        let at = (layout.size.0 - MARGIN, area.top - 14.0);
        canvas.text(&label, at, TICK_SIZE, Align::Right, false);
    }
}

impl Layout {
    fn draw_grid(&self, canvas: &mut Canvas) {
        let a = &self.area;
        let across = |x: f64| [(a.across(x), a.top), (a.across(x), a.bottom())];
        let down = |y: f64| [(a.left, a.down(y)), (a.right(), a.down(y))];
        for x in &self.x_ticks.minor {
            canvas.line(across(*x), Pen::solid(0.8, colour::FINE_GRID));
        }
        for y in &self.y_ticks.minor {
            canvas.line(down(*y), Pen::solid(0.8, colour::FINE_GRID));
        }
        for tick in &self.x_ticks.major {
            canvas.line(across(tick.at), Pen::solid(0.8, colour::GRID));
        }
        for tick in &self.y_ticks.major {
            canvas.line(down(tick.at), Pen::solid(0.8, colour::GRID));
        }
    }

    fn draw_axes(&self, canvas: &mut Canvas) {
        let a = &self.area;
        let corner = [(a.left, a.top), (a.left, a.bottom()), (a.right(), a.bottom())];
        canvas.line(corner, Pen::solid(1.0, colour::AXIS));
        for tick in &self.x_ticks.major {
            let (x, y) = (a.across(tick.at), a.bottom() + TICK_LENGTH);
            canvas.line([(x, a.bottom()), (x, y)], Pen::solid(1.0, colour::AXIS));
            let at = (x, y + 0.5 * ROW);
            canvas.text(&tick.label, at, TICK_SIZE, Align::Centre, false);
        }
        for tick in &self.y_ticks.major {
            let (x, y) = (a.left - TICK_LENGTH, a.down(tick.at));
            canvas.line([(x, y), (a.left, y)], Pen::solid(1.0, colour::AXIS));
            canvas.text(&tick.label, (x - 4.0, y), TICK_SIZE, Align::Right, false);
        }
    }
}

/// As many numbers as fit side by side.
fn ticks_across(axis: &Axis, width: f64) -> Ticks {
    let mut count = (width / 75.0) as usize;
    loop {
        let ticks = axis.ticks(count);
        let wide = (ticks.label_width(TICK_SIZE) + 12.0) * ticks.major.len() as f64;
        if wide <= width || count <= 2 {
            return ticks;
        }
        count -= 1;
    }
}

fn entry_width(entry: &Entry, room: f64) -> f64 {
    (SWATCH + 6.0 + text_width(&entry.label, TICK_SIZE) + 16.0).min(room)
}
