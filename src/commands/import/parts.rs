//! Types of line, points and lines of a deck.

use super::deck::{Deck, Row, Word};
use super::rod::rod_end;
use ropewalk_scene::Fault;
use std::collections::BTreeMap;

/// A type of line.
pub(super) struct LineType<'a> {
    pub row: &'a Row,
    pub diameter: f64,
    pub mass: f64,
    pub ea: f64,
    /// Damping BA [N s], or a damping ratio below zero.
    pub damping: f64,
    pub ei: f64,
    /// Cd, Ca, CdAx, CaAx.
    pub fluid: [f64; 4],
}

/// A line between two markers.
pub(super) struct Line<'a> {
    pub name: String,
    pub kind: &'a LineType<'a>,
    /// Its section, as the scene calls it.
    pub section: String,
    pub ends: [String; 2],
    pub length: f64,
    pub segments: f64,
    pub row: &'a Row,
}

/// What a point is.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Held {
    Ground,
    Vessel,
    Body,
    Free,
}

pub(super) struct Point<'a> {
    pub id: String,
    pub held: Held,
    /// In space, or on its body.
    pub at: [f64; 3],
    pub body: String,
    /// Mass, volume, CdA, Ca.
    pub own: [f64; 4],
    pub row: &'a Row,
}

pub(super) fn line_type<'a>(deck: &Deck<'_>, row: &'a Row) -> Result<LineType<'a>, Fault> {
    let number = |k, what| deck.number(row, k, what);
    for (k, what) in [(3, "stiffness EA"), (4, "damping BA"), (5, "bending stiffness EI")] {
        let word = deck.word(row, k, what)?;
        if word.text.parse::<f64>().is_err() {
            let message = format!(
                "a {what} that isn't one number, such as one that depends on load or rate, isn't taken over"
            );
            return Err(deck
                .word_fault(&message, word)
                .with_help("give a number, or `axial_force` in the scene"));
        }
    }
    if let Some(lift) = row.words.get(10).filter(|w| w.text.parse() != Ok(0.0)) {
        let fault = deck.word_fault("lift by shed vortices isn't taken over", lift);
        return Err(fault.with_help("a lift coefficient of 0 goes"));
    }
    let fluid = [number(6, "drag coefficient Cd")?, number(7, "Ca")?, number(8, "CdAx")?, number(9, "CaAx")?];
    Ok(LineType {
        row,
        diameter: deck.positive(row, 1, "diameter")?,
        mass: deck.positive(row, 2, "mass per length")?,
        ea: deck.positive(row, 3, "stiffness EA")?,
        damping: number(4, "damping BA or -zeta")?,
        ei: number(5, "bending stiffness EI")?,
        fluid,
    })
}

pub(super) fn point<'a>(deck: &Deck<'_>, row: &'a Row) -> Result<Point<'a>, Fault> {
    let number = |k, what| deck.number(row, k, what);
    let (id, kind) = (deck.word(row, 0, "number")?, deck.word(row, 1, "type")?);
    let (held, body) = match kind.text.to_lowercase().as_str() {
        "fixed" | "fix" | "anchor" => (Held::Ground, String::new()),
        "coupled" | "vessel" | "fairlead" => (Held::Vessel, String::new()),
        "free" | "connect" | "point" => (Held::Free, String::new()),
        body if body.strip_prefix("body").is_some_and(|n| n.parse::<u32>().is_ok()) => {
            (Held::Body, body.to_string())
        }
        _ => {
            let fault = deck.word_fault(&format!("a point of type `{}` isn't taken over", kind.text), kind);
            return Err(fault.with_help("`Fixed`, `Coupled`, `Free` and `Body1` are"));
        }
    };
    let known = |row: &Row| row.words.first().is_some_and(|id| format!("body{}", id.text) == body);
    if held == Held::Body && !deck.bodies.iter().any(known) {
        return Err(deck.word_fault(&format!("there is no body for `{}`", kind.text), kind));
    }
    Ok(Point {
        id: id.text.clone(),
        held,
        at: [number(2, "X")?, number(3, "Y")?, number(4, "Z")?],
        body,
        own: [number(5, "mass")?, number(6, "volume")?, number(7, "CdA")?, number(8, "Ca")?],
        row,
    })
}

/// A point by its number, or what a line is fastened to instead.
pub(super) fn ends(deck: &Deck<'_>, word: &Word, points: &[Point<'_>]) -> Result<String, Fault> {
    let id = word.text.to_lowercase();
    let id = ["point", "connection", "con", "p", "c"].iter().find_map(|p| id.strip_prefix(p)).unwrap_or(&id);
    if points.iter().any(|p| p.id == id) || rod_end(deck, id).is_some() {
        return Ok(id.into());
    }
    Err(deck
        .word_fault(&format!("there is no point `{}`", word.text), word)
        .with_help("lines end at points of the deck, and at ends of its rods, such as `R1A`"))
}

/// A line; `sections` gets what it is made of, once for each damping.
pub(super) fn line<'a>(
    deck: &Deck<'_>,
    row: &'a Row,
    types: &'a [LineType<'a>],
    points: &[Point<'_>],
    sections: &mut BTreeMap<String, (&'a LineType<'a>, f64)>,
) -> Result<Line<'a>, Fault> {
    let (id, kind) = (deck.word(row, 0, "number")?, deck.word(row, 1, "type of line")?);
    let Some(found) = types.iter().find(|t| t.row.words[0].text == kind.text) else {
        return Err(deck.word_fault(&format!("there is no line type `{}`", kind.text), kind));
    };
    let [a, b] = [(2, "point at its end A"), (3, "point at its end B")];
    let ends =
        [ends(deck, deck.word(row, a.0, a.1)?, points)?, ends(deck, deck.word(row, b.0, b.1)?, points)?];
    if ends[0] == ends[1] {
        let message = format!("both ends of this line are at point `{}`", ends[0]);
        return Err(deck.word_fault(&message, deck.word(row, b.0, b.1)?));
    }
    let (length, segments) =
        (deck.positive(row, 4, "unstretched length")?, deck.positive(row, 5, "number of segments")?);
    if segments.fract() != 0.0 {
        let message = format!("the number of segments must be whole, not {segments}");
        return Err(deck.word_fault(&message, deck.word(row, 5, "number of segments")?));
    }
    // a ratio is that of the shortest wave of a segment, as MoorDyn has it
    let damping = match found.damping {
        ratio if ratio < 0.0 => -ratio * length / segments.max(1.0) * (found.ea * found.mass).sqrt(),
        damping => damping,
    };
    let time = damping / found.ea;
    let clean: String = kind
        .text
        .chars()
        .map(|c| if c.is_ascii_alphanumeric() || "_-".contains(c) { c } else { '-' })
        .collect();
    let mut section = clean.clone();
    let mut k = 1;
    while sections.get(&section).is_some_and(|(t, other)| !(std::ptr::eq(*t, found) && *other == time)) {
        k += 1;
        section = format!("{clean}-{k}");
    }
    sections.insert(section.clone(), (found, time));
    Ok(Line { name: format!("line{}", id.text), kind: found, section, ends, length, segments, row })
}

/// Where a point is in space.
pub(super) fn place(deck: &Deck<'_>, points: &[Point<'_>], id: &str) -> Result<[f64; 3], Fault> {
    if let Some((row, end)) = rod_end(deck, id) {
        let mut at = [0.0; 3];
        for (k, x) in at.iter_mut().enumerate() {
            *x = deck.number(row, 3 + 3 * end + k, "place of an end")?;
        }
        return Ok(at);
    }
    let Some(point) = points.iter().find(|p| p.id == id) else { return Ok([0.0; 3]) };
    let body = deck
        .bodies
        .iter()
        .find(|row| row.words.first().is_some_and(|w| format!("body{}", w.text) == point.body));
    let Some(body) = body else { return Ok(point.at) };
    let mut at = point.at;
    for (k, x) in at.iter_mut().enumerate() {
        *x += deck.number(body, 2 + k, "position")?;
    }
    Ok(at)
}
