//! A sheet of paper in pixels, written as SVG.

use std::fmt::Write as _;

use svg::node::Node;
use svg::node::element::{Circle, Polyline, Rectangle, Text};

use super::colour::{self, Colour};
use super::thin::Pixel;

/// What a reader's machine has of these; drawing itself needs no font.
const FONT: &str = "Helvetica, Arial, DejaVu Sans, sans-serif";
/// From the middle of a line of text down to its baseline.
const BASELINE: &str = "0.35em";

/// Where a text stands from its anchor; it is centred vertically on it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Align {
    Left,
    Centre,
    Right,
    /// Centred and turned by a quarter, reading upwards.
    Upwards,
}

/// How a line is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Pen {
    pub(super) width: f64,
    pub(super) colour: Colour,
    /// Lengths of dashes and gaps, one after the other; none for a solid line.
    pub(super) dashes: &'static [f64],
}

impl Pen {
    pub(super) fn solid(width: f64, colour: Colour) -> Self {
        Pen { width, colour, dashes: &[] }
    }
}

pub(super) struct Canvas {
    document: svg::Document,
    /// Where the upper left corner of what is drawn comes to lie.
    pub(super) origin: Pixel,
}

/// Draws on a white sheet of `width` by `height` pixels and returns the SVG text.
pub(super) fn draw(width: f64, height: f64, paint: impl FnOnce(&mut Canvas)) -> String {
    let (width, height) = (width.ceil(), height.ceil());
    let document = svg::Document::new()
        .set("width", width)
        .set("height", height)
        .set("viewBox", (0, 0, width, height))
        .set("font-family", FONT)
        .set("stroke-linejoin", "round")
        .set("stroke-linecap", "round");
    let mut canvas = Canvas { document, origin: (0.0, 0.0) };
    canvas.rectangle((0.0, 0.0), (width, height), colour::PAPER);
    paint(&mut canvas);
    canvas.document.to_string()
}

impl Canvas {
    fn moved(&self, (x, y): Pixel) -> Pixel {
        (x + self.origin.0, y + self.origin.1)
    }

    pub(super) fn line(&mut self, points: impl IntoIterator<Item = Pixel>, pen: Pen) {
        let mut path = String::new();
        for point in points {
            let (x, y) = self.moved(point);
            let gap = if path.is_empty() { "" } else { " " };
            let _ = write!(path, "{gap}{},{}", fine(x), fine(y));
        }
        let mut line = Polyline::new()
            .set("points", path)
            .set("fill", "none")
            .set("stroke", pen.colour.to_string())
            .set("stroke-width", pen.width);
        if !pen.dashes.is_empty() {
            // round ends would fill the gaps
            line = line.set("stroke-dasharray", pen.dashes.to_vec()).set("stroke-linecap", "butt");
        }
        self.document.append(line);
    }

    pub(super) fn dot(&mut self, at: Pixel, radius: f64, colour: Colour) {
        let (x, y) = self.moved(at);
        let dot = Circle::new().set("cx", fine(x)).set("cy", fine(y)).set("r", radius);
        self.document.append(dot.set("fill", colour.to_string()));
    }

    pub(super) fn rectangle(&mut self, top_left: Pixel, bottom_right: Pixel, colour: Colour) {
        let ((x, y), (right, bottom)) = (self.moved(top_left), self.moved(bottom_right));
        let place = Rectangle::new().set("x", fine(x)).set("y", fine(y));
        let size = place.set("width", fine(right - x)).set("height", fine(bottom - y));
        self.document.append(size.set("fill", colour.to_string()));
    }

    pub(super) fn text(&mut self, text: &str, at: Pixel, size: f64, align: Align, bold: bool) {
        let (x, y) = self.moved(at);
        let (x, y) = (fine(x), fine(y));
        let text: String = text.chars().filter(|c| !c.is_control()).collect();
        let mut node = Text::new(text)
            .set("x", x)
            .set("y", y)
            .set("dy", BASELINE)
            .set("font-size", size)
            .set("fill", colour::TEXT.to_string());
        match align {
            Align::Left => {}
            Align::Centre | Align::Upwards => node = node.set("text-anchor", "middle"),
            Align::Right => node = node.set("text-anchor", "end"),
        }
        if align == Align::Upwards {
            node = node.set("transform", format!("rotate(-90 {x} {y})"));
        }
        if bold {
            node = node.set("font-weight", "bold");
        }
        self.document.append(node);
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

/// A tenth of a pixel is as fine as a curve can be seen.
fn fine(x: f64) -> f64 {
    (x * 10.0).round() / 10.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sheet_has_the_size_in_pixels_and_escapes_text() {
        let say = |c: &mut Canvas| c.text("a < b & \"c\"\u{7}", (50.0, 25.04), 12.0, Align::Centre, true);
        let svg = draw(100.0, 49.5, say);
        assert!(svg.contains("width=\"100\"") && svg.contains("viewBox=\"0 0 100 50\""), "{svg}");
        assert!(svg.contains("a &lt; b &amp; \"c\"\n") && svg.contains("y=\"25\""), "{svg}");
        assert!(svg.contains("font-size=\"12\"") && svg.contains("font-weight=\"bold\""), "{svg}");
        assert!(svg.starts_with("<svg ") && svg.trim_end().ends_with("</svg>"), "{svg}");
    }

    #[test]
    fn dashes_are_a_pattern_of_the_line() {
        let pen = Pen { dashes: &[9.0, 4.0], ..Pen::solid(1.8, colour::TEXT) };
        let svg = draw(100.0, 50.0, |c| c.line([(0.0, 1.0), (99.99, 1.0)], pen));
        for part in
            ["points=\"0,1 100,1\"", "stroke-dasharray=\"9 4\"", "stroke=\"#222222\"", "stroke-width=\"1.8\""]
        {
            assert!(svg.contains(part), "no {part} in {svg}");
        }
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
