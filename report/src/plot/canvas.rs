//! A sheet of paper in pixels, over the SVG backend of `plotters`.

use plotters::prelude::{DrawingBackend, SVGBackend};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{
    Color, FontDesc, FontFamily, FontStyle, FontTransform, RGBColor, ShapeStyle, TextStyle,
};

use super::colour;
use crate::OutputError;

/// The backend counts in whole units: a pixel is divided, or curves would look like stairs.
const FINE: f64 = 10.0;
/// The backend divides font sizes by this.
const FONT_FACTOR: f64 = 1.24;
/// What a reader's machine has of these; drawing itself needs no font.
const FONT: &str = "Helvetica, Arial, DejaVu Sans, sans-serif";

/// Where a text stands from its anchor; it is centred vertically on it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Align {
    Left,
    Centre,
    Right,
    /// Centred and turned by a quarter, reading upwards.
    Upwards,
}

pub(super) struct Canvas<'a> {
    backend: SVGBackend<'a>,
    /// Where the upper left corner of what is drawn comes to lie.
    pub(super) origin: (f64, f64),
}

/// Draws on a white sheet of `width` by `height` pixels and returns the SVG text.
pub(super) fn draw(
    width: f64,
    height: f64,
    paint: impl FnOnce(&mut Canvas<'_>) -> Result<(), OutputError>,
) -> Result<String, OutputError> {
    let (width, height) = (width.ceil(), height.ceil());
    let mut text = String::new();
    let size = ((width * FINE) as u32, (height * FINE) as u32);
    let mut canvas = Canvas { backend: SVGBackend::with_string(&mut text, size), origin: (0.0, 0.0) };
    canvas.rectangle((0.0, 0.0), (width, height), colour::PAPER)?;
    paint(&mut canvas)?;
    canvas.backend.present().map_err(failed)?;
    drop(canvas);
    // The backend knows neither sizes other than its own units nor round joins.
    let body = text.split_once("viewBox").map_or("", |(_, body)| body);
    Ok(format!(
        "<svg width=\"{width}\" height=\"{height}\" stroke-linejoin=\"round\" \
         stroke-linecap=\"round\" viewBox{body}"
    ))
}

impl Canvas<'_> {
    fn moved(&self, (x, y): (f64, f64)) -> (f64, f64) {
        (x + self.origin.0, y + self.origin.1)
    }

    pub(super) fn line(
        &mut self,
        points: impl IntoIterator<Item = (f64, f64)>,
        width: f64,
        colour: RGBColor,
    ) -> Result<(), OutputError> {
        let style = ShapeStyle {
            color: colour.to_rgba(),
            filled: false,
            stroke_width: (width * FINE).round() as u32,
        };
        let (x, y) = self.origin;
        let path = points.into_iter().map(|p| fine((p.0 + x, p.1 + y)));
        self.backend.draw_path(path, &style).map_err(failed)
    }

    pub(super) fn dot(&mut self, at: (f64, f64), radius: f64, colour: RGBColor) -> Result<(), OutputError> {
        let radius = (radius * FINE).round() as u32;
        let at = self.moved(at);
        self.backend.draw_circle(fine(at), radius, &colour.filled(), true).map_err(failed)
    }

    pub(super) fn rectangle(
        &mut self,
        top_left: (f64, f64),
        bottom_right: (f64, f64),
        colour: RGBColor,
    ) -> Result<(), OutputError> {
        let (top_left, bottom_right) = (self.moved(top_left), self.moved(bottom_right));
        self.backend.draw_rect(fine(top_left), fine(bottom_right), &colour.filled(), true).map_err(failed)
    }

    pub(super) fn text(
        &mut self,
        text: &str,
        at: (f64, f64),
        size: f64,
        align: Align,
        bold: bool,
    ) -> Result<(), OutputError> {
        let style = if bold { FontStyle::Bold } else { FontStyle::Normal };
        let font = FontDesc::new(FontFamily::Name(FONT), size * FINE * FONT_FACTOR, style);
        let (h_pos, transform) = match align {
            Align::Left => (HPos::Left, FontTransform::None),
            Align::Centre => (HPos::Center, FontTransform::None),
            Align::Right => (HPos::Right, FontTransform::None),
            Align::Upwards => (HPos::Center, FontTransform::Rotate270),
        };
        let style = TextStyle::from(font.transform(transform))
            .color(&colour::TEXT)
            .pos(Pos::new(h_pos, VPos::Center));
        let text: String = text.chars().filter(|c| !c.is_control()).collect();
        let at = self.moved(at);
        self.backend.draw_text(&text, &style, fine(at)).map_err(failed)
    }
}

/// Width of a text in pixels, on the safe side for the usual sans-serif fonts.
pub(super) fn text_width(text: &str, size: f64) -> f64 {
    let ems: f64 = text
        .chars()
        .map(|c| match c {
            'i' | 'j' | 'l' | 'I' | '.' | ',' | ':' | ';' | '\'' | '|' | ' ' => 0.32,
            't' | 'f' | 'r' | '(' | ')' | '[' | ']' | '/' | '-' => 0.42,
            '⁰' | '¹' | '²' | '³' | '⁴'..='⁹' | '⁻' => 0.45,
            'm' | 'w' | 'M' | 'W' | '%' => 0.98,
            '−' | '×' | '=' | '<' | '>' | '+' => 0.84,
            'A'..='Z' => 0.74,
            c if c as u32 >= 0x2E80 => 1.0,
            _ => 0.63,
        })
        .sum();
    ems * size
}

/// The text, or as much of it as fits into `room` pixels, with "…" for what doesn't.
pub(super) fn fitted(text: &str, size: f64, room: f64) -> String {
    if text_width(text, size) <= room {
        return text.into();
    }
    let mut kept = String::new();
    for c in text.chars() {
        kept.push(c);
        if text_width(&kept, size) + text_width("…", size) > room {
            kept.pop();
            break;
        }
    }
    kept.push('…');
    kept
}

/// The text in lines that fit into `room` pixels, broken between words where it can be.
pub(super) fn wrapped(text: &str, size: f64, room: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if text_width(line, size) + text_width(word, size) + 0.4 * size <= room => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(fitted(word, size, room)),
        }
    }
    lines
}

fn fine((x, y): (f64, f64)) -> (i32, i32) {
    ((x * FINE).round() as i32, (y * FINE).round() as i32)
}

fn failed(error: impl std::fmt::Display) -> OutputError {
    OutputError::Draw { message: error.to_string() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sheet_has_the_size_in_pixels_and_escapes_text() {
        let svg =
            draw(100.0, 50.0, |c| c.text("a < b & \"c\"\u{7}", (50.0, 25.0), 12.0, Align::Centre, true))
                .unwrap();
        assert!(svg.starts_with("<svg width=\"100\" height=\"50\" "));
        assert!(svg.contains("viewBox=\"0 0 1000 500\" xmlns="));
        assert!(svg.contains("a &lt; b &amp; &quot;c&quot;\n"));
        assert!(svg.contains("font-size=\"1") && svg.contains("font-weight=\"bold\""));
        assert!(svg.trim_end().ends_with("</svg>"));
    }

    #[test]
    fn long_texts_are_cut_or_wrapped_into_their_room() {
        let long = "tension at the upper end of the hose over the time of the tow";
        assert_eq!(fitted("short", 12.0, 100.0), "short");
        let cut = fitted(long, 12.0, 100.0);
        assert!(cut.ends_with('…') && text_width(&cut, 12.0) <= 100.0);
        let lines = wrapped(long, 12.0, 120.0);
        assert!(lines.len() > 1 && lines.iter().all(|l| text_width(l, 12.0) <= 120.0));
        assert_eq!(lines.join(" "), long);
    }
}
