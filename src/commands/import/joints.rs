//! What holds the ends of lines, and what is recorded of them.

use super::deck::Deck;
use super::parts::{Held, Line, Point};
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// The constraints that hold ends of lines: by the name of the line, and 0 for its start or 1 for its end.
pub(super) type Joints = BTreeMap<(String, usize), String>;

/// Joins the ends of lines at a point.
pub(super) fn fasten(
    point: &Point<'_>,
    lines: &[Line<'_>],
    density: f64,
    joints: &mut Joints,
    out: &mut String,
) {
    let at = |l: &Line<'_>, k: usize| format!("{}.{}", l.name, ["start", "end"][k]);
    let mut ends = lines.iter().flat_map(|l| [(l, 0), (l, 1)]).filter(|(l, k)| l.ends[*k] == point.id);
    let mut spherical = |name: &str, l: &Line<'_>, end: usize, to: &str, out: &mut String| {
        let _ = write!(
            out,
            "\n[[constraints]]\ntype = \"spherical\"\nname = \"{name}\"\nmarker = \"{}\"\n{to}",
            at(l, end)
        );
        joints.insert((l.name.clone(), end), name.to_string());
    };
    let id = &point.id;
    match point.held {
        Held::Ground | Held::Vessel => {
            if point.held == Held::Vessel && lines.iter().any(|l| l.ends.contains(id)) {
                let _ = write!(
                    out,
                    "\n# point {id} is moved from outside in the deck: here it is held; `driving` moves it"
                );
            }
            for (k, (l, end)) in ends.enumerate() {
                let name = if k == 0 { format!("point{id}") } else { format!("point{id}-{}", l.name) };
                spherical(&name, l, end, "", out);
            }
        }
        Held::Body => {
            for (l, end) in ends {
                let to = format!("to = \"{}.point{id}\"\n", point.body);
                spherical(&format!("point{id}-{}", l.name), l, end, &to, out);
            }
        }
        Held::Free => {
            let first = ends.next();
            let marker = first.as_ref().map(|(l, end)| at(l, *end));
            let [mass, volume, area, ca] = point.own;
            if point.own != [0.0; 4] && (mass > 0.0 || volume > 0.0 || area > 0.0) {
                let on = marker.as_ref().map_or_else(|| format!("{:?}", point.at), |m| format!("\"{m}\""));
                let _ = write!(
                    out,
                    "\n# {}\n[[elements]]\ntype = \"point_mass\"\nname = \"point{id}\"\nmarker = {on}\nmass = {mass:?}\n\
                     volume = {volume:?}\ndrag_area = {area:?}\nadded_mass = {:?}\n",
                    point.row.line,
                    ca * density * volume
                );
            }
            for (l, end) in ends {
                let to = format!("to = \"{}\"\n", marker.as_deref().unwrap_or(""));
                spherical(&format!("point{id}-{}", l.name), l, end, &to, out);
            }
        }
    }
}

/// Forces on both ends of each line, and what the deck asks for besides.
pub(super) fn records(
    deck: &Deck<'_>,
    lines: &[Line<'_>],
    points: &[Point<'_>],
    joints: &Joints,
    notes: &mut Vec<String>,
    out: &mut String,
) {
    for line in lines {
        let number = line.name.trim_start_matches("line");
        for (name, at, end) in [("FairTen", "end", 1), ("AnchTen", "start", 0)] {
            // the force on the end, where something holds it
            let what = match joints.get(&(line.name.clone(), end)) {
                Some(joint) => format!("type = \"reaction\"\nof = \"{joint}\"\nwhat = \"magnitude\""),
                None => {
                    format!("type = \"along\"\nof = \"{}\"\nwhat = \"tension\"\nat = \"{at}\"", line.name)
                }
            };
            let _ = write!(out, "\n[[records]]\n{what}\nname = \"{name}{number}\"\n");
        }
    }
    let mut left = Vec::new();
    let mut places = Vec::new();
    for word in deck.outputs.iter().flat_map(|row| &row.words) {
        let said = word.text.to_lowercase();
        let end = ["fairten", "anchten"].iter().find_map(|what| said.strip_prefix(what));
        if end.is_some_and(|id| lines.iter().any(|l| l.name == format!("line{id}"))) {
            continue;
        }
        let of =
            ["point", "con"].iter().find_map(|p| said.strip_prefix(p)).and_then(|rest| rest.split_once('p'));
        match of.filter(|(_, axis)| ["x", "y", "z"].contains(axis)) {
            Some((id, _)) if points.iter().any(|p| p.id == id) => {
                if !places.contains(&id.to_string()) {
                    places.push(id.to_string());
                }
            }
            _ => match end {
                Some(id) => left.push(format!("{} (there is no line `{id}`)", word.text)),
                None => left.push(word.text.clone()),
            },
        }
    }
    for id in places {
        let at = lines.iter().find_map(|l| {
            (0..2).find(|k| l.ends[*k] == id).map(|k| format!("{}.{}", l.name, ["start", "end"][k]))
        });
        if let Some(at) = at {
            let _ = write!(out, "\n[[records]]\ntype = \"position\"\nof = \"{at}\"\n");
        }
    }
    if !left.is_empty() {
        notes.push(format!("these outputs are left out: {}", left.join(", ")));
    }
}
