//! What a deck says as a scene: a text that people read and go on with.

use super::body::body;
use super::deck::Deck;
use super::joints::{Joints, fasten, records};
use super::parts::{LineType, line, line_type, place, point};
use super::rod::{hold, meet, rod};
use super::water::{forces, head};
use ropewalk_scene::Fault;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

/// A scene, and what of the deck it leaves out.
pub(super) struct Imported {
    pub text: String,
    pub notes: Vec<String>,
}

/// What an option stands for in a scene, if anything.
const IGNORED: [&str; 27] = [
    "dtm",
    "dt",
    "cfl",
    "tscheme",
    "writelog",
    "writeunits",
    "dtic",
    "icdt",
    "tmaxic",
    "ictmax",
    "cdscaleic",
    "icdfac",
    "threshic",
    "icthresh",
    "icgendynamic",
    "gendynamicic",
    "fileic",
    "icfile",
    "dtwave",
    "outswitch",
    "disableoutput",
    "disableouttime",
    "fricdamp",
    "statdynfricscale",
    "inertialf",
    "inertialf_rampt",
    "unifycurrentgrid",
];
const KNOWN: [&str; 14] = [
    "g",
    "gravity",
    "rho",
    "wtrdnsty",
    "wtrdpth",
    "kbot",
    "kb",
    "cbot",
    "cb",
    "frictioncoefficient",
    "wavekin",
    "currents",
    "dtout",
    "seafloorfile",
];

/// Makes a scene of a deck whose files lie in a folder.
pub(super) fn scene(deck: &Deck<'_>, name: &str, folder: &Path) -> Result<Imported, Fault> {
    let mut notes = Vec::new();
    for row in &deck.options {
        let word = deck.word(row, 1, "name of the option")?;
        let known = word.text.to_lowercase();
        if !IGNORED.contains(&known.as_str()) && !KNOWN.contains(&known.as_str()) {
            return Err(deck
                .word_fault(&format!("the option `{}` has no counterpart", word.text), word)
                .with_help("take it out of the deck if the scene can do without"));
        }
    }
    for (rows, what) in
        [(&deck.points, "point"), (&deck.lines, "line"), (&deck.rods, "rod"), (&deck.bodies, "body")]
    {
        for (k, row) in rows.iter().enumerate() {
            let id = deck.word(row, 0, "number")?;
            if rows[..k].iter().any(|other| other.words[0].text == id.text) {
                return Err(deck
                    .word_fault(&format!("another {what} of the deck has the number {} too", id.text), id));
            }
        }
    }
    let density = deck.option_number(&["rho", "wtrdnsty"], 1025.0)?;
    let types = deck.types.iter().map(|row| line_type(deck, row)).collect::<Result<Vec<_>, _>>()?;
    let points = deck.points.iter().map(|row| point(deck, row)).collect::<Result<Vec<_>, _>>()?;
    let mut sections = BTreeMap::new();
    let lines = deck
        .lines
        .iter()
        .map(|row| line(deck, row, &types, &points, &mut sections))
        .collect::<Result<Vec<_>, _>>()?;

    let used = |t: &&LineType<'_>| lines.iter().any(|l| std::ptr::eq(l.kind, *t));
    for kind in types.iter().filter(|t| t.fluid[3] > t.fluid[1]).filter(used) {
        notes.push(format!(
            "added mass along `{}` (CaAx = {}) is more than across: it is taken as Ca = {}",
            kind.row.words[0].text, kind.fluid[3], kind.fluid[1]
        ));
    }

    let mut out = String::new();
    head(deck, name, density, folder, &mut out)?;
    for row in &deck.bodies {
        body(deck, row, &mut notes, &mut out)?;
    }
    for row in &deck.rods {
        rod(deck, row, &mut notes, &mut out)?;
    }
    for (section, (kind, time)) in &sections {
        let _ = write!(
            out,
            "\n# {}\n[[sections]]\nname = \"{section}\"\nmass = {:?}\nea = {:?}\nei = {:?}\ndiameter = {:?}\n\
             axial_retardation_time = {time:?}\n{}",
            kind.row.line,
            kind.mass,
            kind.ea,
            kind.ei,
            kind.diameter,
            // as segments there
            if kind.ei == 0.0 { "tension_only = true\n" } else { "" }
        );
    }
    for line in &lines {
        let places = line.ends.each_ref().map(|id| place(deck, &points, id));
        let [a, b] = places;
        let _ = write!(
            out,
            "\n# {}\n[[elements]]\ntype = \"cable\"\nname = \"{}\"\npoints = [{:?}, {:?}]\nlength = {:?}\nelements = {}\n\
             section = \"{}\"\n",
            line.row.line,
            line.name,
            a?,
            b?,
            line.length,
            ((line.segments / 2.0).ceil() as usize).max(2),
            line.section
        );
    }
    let mut joints = Joints::new();
    for point in &points {
        fasten(point, &lines, density, &mut joints, &mut out);
    }
    for row in &deck.rods {
        hold(deck, row, &lines, &mut out)?;
    }
    forces(deck, &lines, folder, &mut out)?;
    for row in &deck.rods {
        meet(deck, row, &mut out)?;
    }
    records(deck, &lines, &points, &joints, &mut notes, &mut out);
    Ok(Imported { text: out, notes })
}
