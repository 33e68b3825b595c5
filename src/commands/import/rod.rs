//! Rods of a deck: rigid bodies with a hull.

use super::deck::{Deck, Row};
use super::parts::Line;
use ropewalk_scene::Fault;
use std::f64::consts::PI;
use std::fmt::Write as _;

/// The rod whose end a line is fastened to, as `r1a`, and which end it is: 0 for A, 1 for B.
pub(super) fn rod_end<'d>(deck: &'d Deck<'_>, id: &str) -> Option<(&'d Row, usize)> {
    let named = id.strip_prefix("rod").or_else(|| id.strip_prefix('r'))?;
    let (number, end) = match (named.strip_suffix('a'), named.strip_suffix('b')) {
        (Some(number), _) => (number, 0),
        (_, Some(number)) => (number, 1),
        _ => return None,
    };
    deck.rods.iter().find(|row| row.words.first().is_some_and(|w| w.text == number)).map(|row| (row, end))
}

/// Diameter, mass per length, Cd, Ca, CdEnd and CaEnd of a rod's type.
fn kind(deck: &Deck<'_>, row: &Row) -> Result<[f64; 6], Fault> {
    let word = deck.word(row, 1, "type of rod")?;
    let Some(found) = deck.rod_types.iter().find(|t| t.words[0].text == word.text) else {
        return Err(deck.word_fault(&format!("there is no rod type `{}`", word.text), word));
    };
    let names = ["diameter", "mass per length", "drag coefficient Cd", "Ca", "CdEnd", "CaEnd"];
    let mut all = [0.0; 6];
    for (k, name) in names.into_iter().enumerate() {
        all[k] = deck.number(found, 1 + k, name)?;
    }
    Ok(all)
}

/// The way from a rod's end A to its end B, and its length.
fn axis(deck: &Deck<'_>, row: &Row) -> Result<([f64; 3], f64), Fault> {
    let mut axis = [0.0; 3];
    for (k, x) in axis.iter_mut().enumerate() {
        *x = deck.number(row, 6 + k, "place of an end")? - deck.number(row, 3 + k, "place of an end")?;
    }
    Ok((axis, axis.iter().map(|x| x * x).sum::<f64>().sqrt()))
}

/// A rod as an element: its frame is that of space, with the origin at the end A.
pub(super) fn rod(
    deck: &Deck<'_>,
    row: &Row,
    notes: &mut Vec<String>,
    out: &mut String,
) -> Result<(), Fault> {
    let [diameter, mass, .., end] = kind(deck, row)?;
    let id = &deck.word(row, 0, "number")?.text;
    let mut at = [0.0; 3];
    for (k, x) in at.iter_mut().enumerate() {
        *x = deck.number(row, 3 + k, "place of an end")?;
    }
    let (axis, length) = axis(deck, row)?;
    let square = length * length;
    if !(length > 0.0) {
        let fault = deck.fault("a rod without length isn't taken over", row);
        return Err(fault.with_help(
            "it holds the direction of a line: fasten the line to a point, and add a `clamp` to the scene",
        ));
    }
    // a solid cylinder about its middle: m (L²/12 + d²/16) across, m d²/8 along
    let whole = mass * length;
    let across = whole * (square / 12.0 + diameter * diameter / 16.0);
    let along = whole * diameter * diameter / 8.0;
    let entry = |i: usize, j: usize| {
        let own = if i == j { across } else { 0.0 };
        own + (along - across) * axis[i] * axis[j] / square
    };
    let _ = write!(
        out,
        "\n# {}\n[[elements]]\ntype = \"rigid_body\"\nname = \"rod{id}\"\nposition = {:?}\nmass = {whole:?}\ninertia = {:?}\nproducts = \
         {:?}\ncentre = {:?}\nvolume = {:?}\nhull = {{ from = [0, 0, 0], to = {axis:?}, diameter = {diameter:?} }}\npoints = {{ a = [0, 0, 0], \
         b = {axis:?} }}\n",
        row.line,
        at,
        [entry(0, 0), entry(1, 1), entry(2, 2)],
        [entry(0, 1), entry(0, 2), entry(1, 2)],
        axis.map(|x| 0.5 * x),
        PI / 4.0 * diameter * diameter * length,
    );
    if end != 0.0 {
        notes.push(format!("added mass of the ends of rod {id} (CaEnd) is left out"));
    }
    Ok(())
}

/// What holds a rod, and the lines that end at it.
pub(super) fn hold(deck: &Deck<'_>, row: &Row, lines: &[Line<'_>], out: &mut String) -> Result<(), Fault> {
    let (id, how) = (&deck.word(row, 0, "number")?.text, deck.word(row, 2, "attachment")?);
    let joint = |kind: &str, moved: bool, out: &mut String| {
        if moved {
            let _ = write!(
                out,
                "\n# rod {id} is moved from outside in the deck: here it is held; `driving` or `vessel` moves it"
            );
        }
        let marker = if kind == "weld" { format!("rod{id}") } else { format!("rod{id}.a") };
        let _ =
            write!(out, "\n[[constraints]]\ntype = \"{kind}\"\nname = \"rod{id}\"\nmarker = \"{marker}\"\n");
    };
    match how.text.to_lowercase().as_str() {
        "free" => {}
        "fixed" | "fix" | "anchor" => joint("weld", false, out),
        "pinned" | "pin" => joint("spherical", false, out),
        "coupled" | "vessel" => joint("weld", true, out),
        "coupledpinned" | "vesselpinned" | "vespin" | "couplepin" => joint("spherical", true, out),
        _ => {
            let fault = deck.word_fault(&format!("a rod of type `{}` isn't taken over", how.text), how);
            return Err(fault.with_help("`Free`, `Fixed`, `Pinned`, `Coupled` and `CoupledPinned` are"));
        }
    }
    if matches!(how.text.to_lowercase().as_str(), "fixed" | "fix" | "anchor" | "coupled" | "vessel") {
        return fasten(deck, row, lines, out);
    }
    let ([_, mass, ..], (axis, length)) = (kind(deck, row)?, axis(deck, row)?);
    // hardly more than nothing beside what turns it across
    let stiffness = 1e-6 * mass * length * length * 9.81;
    let _ = write!(
        out,
        "\n# how a rod turns about its own axis means nothing: a weak spring keeps it\n[[forces]]\ntype = \"rotational_spring\"\nname = \
         \"rod{id}-spin\"\nmarker = \"rod{id}\"\naxis = {axis:?}\nstiffness = {stiffness:?}\n"
    );
    fasten(deck, row, lines, out)
}

/// The lines that end at a rod.
fn fasten(deck: &Deck<'_>, row: &Row, lines: &[Line<'_>], out: &mut String) -> Result<(), Fault> {
    let id = &deck.word(row, 0, "number")?.text;
    for (line, end) in lines.iter().flat_map(|l| [(l, 0), (l, 1)]) {
        let Some((there, side)) = rod_end(deck, &line.ends[end]) else { continue };
        if std::ptr::eq(there, row) {
            let (side, end) = (["a", "b"][side], ["start", "end"][end]);
            let _ = write!(
                out,
                "\n[[constraints]]\ntype = \"spherical\"\nname = \"rod{id}{side}-{0}\"\nmarker = \"{0}.{end}\"\nto = \"rod{id}.{side}\"\n",
                line.name
            );
        }
    }
    Ok(())
}

/// What the water does to a rod.
pub(super) fn meet(deck: &Deck<'_>, row: &Row, out: &mut String) -> Result<(), Fault> {
    let [_, _, cd, ca, cd_end, _] = kind(deck, row)?;
    let id = &deck.word(row, 0, "number")?.text;
    if cd != 0.0 || cd_end != 0.0 {
        let _ = write!(
            out,
            "\n[[forces]]\ntype = \"drag\"\ncn = {cd:?}\nct = 0.0\nend = {cd_end:?}\non = [\"rod{id}\"]\n"
        );
    }
    if ca != 0.0 {
        let _ = write!(out, "\n[[forces]]\ntype = \"added_mass\"\nca = {ca:?}\non = [\"rod{id}\"]\n");
    }
    Ok(())
}
