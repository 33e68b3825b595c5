//! What a deck says as a scene: a text that people read and go on with.

use super::deck::{Deck, Row, Word};
use ropewalk_scene::Fault;
use std::collections::BTreeMap;
use std::f64::consts::{FRAC_PI_2, TAU};
use std::fmt::Write as _;
use std::path::Path;

/// A scene, and what of the deck it leaves out.
pub(super) struct Imported {
    pub text: String,
    pub notes: Vec<String>,
}

/// A type of line.
struct LineType<'a> {
    row: &'a Row,
    diameter: f64,
    mass: f64,
    ea: f64,
    /// Damping BA [N s], or a damping ratio below zero.
    damping: f64,
    ei: f64,
    /// Cd, Ca, CdAx, CaAx.
    fluid: [f64; 4],
}

/// A line between two markers.
struct Line<'a> {
    name: String,
    kind: &'a LineType<'a>,
    /// Its section, as the scene calls it.
    section: String,
    ends: [String; 2],
    length: f64,
    segments: f64,
    row: &'a Row,
}

/// What a point is.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Held {
    Ground,
    Vessel,
    Body,
    Free,
}

struct Point<'a> {
    id: String,
    held: Held,
    /// In space, or on its body.
    at: [f64; 3],
    body: String,
    /// Mass, volume, CdA, Ca.
    own: [f64; 4],
    row: &'a Row,
}

/// What an option stands for in a scene, if anything.
const IGNORED: [&str; 26] = [
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
    let density = deck.option_number(&["rho", "wtrdnsty"], 1025.0)?;
    let types = deck.types.iter().map(|row| line_type(deck, row)).collect::<Result<Vec<_>, _>>()?;
    let points = deck.points.iter().map(|row| point(deck, row)).collect::<Result<Vec<_>, _>>()?;
    let mut sections = BTreeMap::new();
    let lines = deck
        .lines
        .iter()
        .map(|row| line(deck, row, &types, &points, &mut sections))
        .collect::<Result<Vec<_>, _>>()?;

    for kind in types.iter().filter(|t| t.fluid[3] != 0.0 && lines.iter().any(|l| std::ptr::eq(l.kind, *t))) {
        notes.push(format!(
            "added mass along `{}` (CaAx = {}) is left out",
            kind.row.words[0].text, kind.fluid[3]
        ));
    }

    let mut out = String::new();
    head(deck, name, density, folder, &mut out)?;
    for row in &deck.bodies {
        body(deck, row, &mut notes, &mut out)?;
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
    for point in &points {
        fasten(point, &lines, density, &mut out);
    }
    forces(deck, &lines, folder, &mut out)?;
    records(deck, &lines, &points, &mut notes, &mut out);
    Ok(Imported { text: out, notes })
}

/// The run, gravity and the water.
fn head(deck: &Deck<'_>, name: &str, density: f64, folder: &Path, out: &mut String) -> Result<(), Fault> {
    let g = deck.option_number(&["g", "gravity"], 9.80665)?;
    let output = deck.option_number(&["dtout"], 0.0)?;
    let output = if output > 0.0 { output } else { 0.1 };
    let depth = deck.option_number(&["wtrdpth"], 0.0)?;
    let title = deck.title.replace(['"', '\\'], "'");
    let _ = write!(
        out,
        "# {name}, a MoorDyn deck, as a scene.\ntitle = \"{title}\"\ngravity = [0, 0, {:?}]\n\n[run]\n\
         # the deck doesn't say how long\nduration = \"60 s\"\noutput = {output:?}\nfrom_equilibrium = true\n\n[water]\n\
         density = {density:?}\nlevel = 0\n",
        0.0 - g
    );
    match deck.option_number(&["currents"], 0.0)? {
        0.0 => {}
        1.0 => {
            let profile = table(folder, "current_profile.txt", 4, 3)?;
            out.push_str("profile = [\n");
            for z in profile {
                let _ = writeln!(
                    out,
                    "    {{ z = {:?}, velocity = [{:?}, {:?}, {:?}] }},",
                    z[0], z[1], z[2], z[3]
                );
            }
            out.push_str("]\n");
        }
        _ => {
            return Err(unknown(
                deck,
                "currents",
                "currents of this kind aren't taken over: only 0 and 1, a profile over depth, are",
            ));
        }
    }
    match deck.option_number(&["wavekin"], 0.0)? {
        0.0 => {}
        7.0 => {
            let _ = write!(
                out,
                "\n[water.waves]\ndepth = {depth:?}\nramp = 20.0                      # from the equilibrium in still water\ncomponents = [\n"
            );
            for w in table(folder, "wave_frequencies.txt", 3, 0)? {
                // the deck's sum is of |A| sin(ωt - kx + arg A), the scene's of cos(kx - ωt + φ)
                let [omega, re, im] = [w[0], w[1], w[2]];
                let (amplitude, phase) = (re.hypot(im), FRAC_PI_2 - im.atan2(re));
                if omega > 0.0 && amplitude > 0.0 {
                    let _ = writeln!(
                        out,
                        "    {{ amplitude = {amplitude:?}, period = {:?}, phase = {phase:?} }},",
                        TAU / omega
                    );
                }
            }
            out.push_str("]\n");
        }
        _ => {
            return Err(unknown(
                deck,
                "wavekin",
                "waves of this kind aren't taken over: only 0 and 7, a sum of components, are",
            ));
        }
    }
    Ok(())
}

/// An option with a value that has no counterpart.
fn unknown(deck: &Deck<'_>, option: &str, message: &str) -> Fault {
    let word = deck.option(&[option]).and_then(|row| row.words.first());
    word.map_or_else(|| Fault::new(message), |word| deck.word_fault(message, word))
}

/// Rows of numbers of a file beside the deck.
fn table(folder: &Path, file: &str, columns: usize, heads: usize) -> Result<Vec<Vec<f64>>, Fault> {
    let path = folder.join(file);
    let shown = path.display().to_string();
    let text = std::fs::read_to_string(&path)
        .map_err(|e| Fault::new(format!("`{shown}`, which the deck needs, can't be read: {e}")))?;
    let mut start = 0;
    let mut rows = Vec::new();
    for (k, line) in text.split_inclusive('\n').enumerate() {
        let bytes = start..start + line.trim_end().len();
        start += line.len();
        if k < heads || line.trim().is_empty() {
            continue;
        }
        let row: Option<Vec<f64>> =
            line.split_whitespace().map(|x| x.parse().ok().filter(|x: &f64| x.is_finite())).collect();
        let Some(row) = row.filter(|row| row.len() >= columns) else {
            return Err(Fault::in_text(format!("{columns} numbers are expected here"), &shown, &text, bytes));
        };
        rows.push(row);
    }
    Ok(rows)
}

fn line_type<'a>(deck: &Deck<'_>, row: &'a Row) -> Result<LineType<'a>, Fault> {
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
        diameter: number(1, "diameter")?,
        mass: number(2, "mass per length")?,
        ea: number(3, "stiffness EA")?,
        damping: number(4, "damping BA or -zeta")?,
        ei: number(5, "bending stiffness EI")?,
        fluid,
    })
}

fn point<'a>(deck: &Deck<'_>, row: &'a Row) -> Result<Point<'a>, Fault> {
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
fn ends(deck: &Deck<'_>, word: &Word, points: &[Point<'_>]) -> Result<String, Fault> {
    let id = word.text.to_lowercase();
    let id = ["point", "connection", "con", "p", "c"].iter().find_map(|p| id.strip_prefix(p)).unwrap_or(&id);
    if points.iter().any(|p| p.id == id) {
        return Ok(id.into());
    }
    Err(deck
        .word_fault(&format!("there is no point `{}`", word.text), word)
        .with_help("lines end at points of the deck; at rods they aren't taken over"))
}

/// A line; `sections` gets what it is made of, once for each damping.
fn line<'a>(
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
    let (length, segments) =
        (deck.number(row, 4, "unstretched length")?, deck.number(row, 5, "number of segments")?);
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
fn place(deck: &Deck<'_>, points: &[Point<'_>], id: &str) -> Result<[f64; 3], Fault> {
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

fn body(deck: &Deck<'_>, row: &Row, notes: &mut Vec<String>, out: &mut String) -> Result<(), Fault> {
    let (id, kind) = (deck.word(row, 0, "number")?, deck.word(row, 1, "attachment")?);
    let free = match kind.text.to_lowercase().as_str() {
        "free" => true,
        "coupled" | "vessel" | "fixed" | "anchor" => false,
        _ => return Err(deck.word_fault(&format!("a body of type `{}` isn't taken over", kind.text), kind)),
    };
    // numbers that may be three, parted by bars
    let several = |k: usize, what: &str| -> Result<Vec<f64>, Fault> {
        let word = deck.word(row, k, what)?;
        let all: Option<Vec<f64>> = word.text.split('|').map(|x| x.parse().ok()).collect();
        all.ok_or_else(|| {
            deck.word_fault(&format!("`{}` is no number: the {what} is expected here", word.text), word)
        })
    };
    let three = |x: Vec<f64>, one: fn(f64) -> [f64; 3]| match x[..] {
        [x] => one(x),
        [a, b, c] => [a, b, c],
        _ => [f64::NAN; 3],
    };
    let mut at = [0.0; 6];
    for (k, x) in at.iter_mut().enumerate() {
        *x = deck.number(row, 2 + k, "position or angle")?;
    }
    if at[3..].iter().any(|x| *x != 0.0) {
        let fault = deck.fault("a body that starts turned isn't taken over", row);
        return Err(fault.with_help("turn its points instead, or add `angles` to the scene"));
    }
    let mass = deck.number(row, 8, "mass")?;
    let centre = three(several(9, "centre of mass")?, |z| [0.0, 0.0, z]);
    let inertia = three(several(10, "inertia")?, |x| [x; 3]);
    let volume = deck.number(row, 11, "volume")?;
    if [12, 13].iter().any(|k| several(*k, "coefficient").is_ok_and(|all| all.iter().any(|x| *x != 0.0))) {
        notes.push(format!("drag and added mass of body {} are left out: a `hull` would have them", id.text));
    }
    let _ = write!(
        out,
        "\n# {}\n[[elements]]\ntype = \"rigid_body\"\nname = \"body{}\"\nposition = {:?}\nmass = {mass:?}\ninertia = {inertia:?}\n\
         centre = {centre:?}\nvolume = {volume:?}\n",
        row.line,
        id.text,
        &at[..3]
    );
    let own: Vec<&Row> = deck
        .points
        .iter()
        .filter(|p| p.words.get(1).is_some_and(|w| w.text.to_lowercase() == format!("body{}", id.text)))
        .collect();
    if !own.is_empty() {
        out.push_str("points = {");
        for (k, p) in own.iter().enumerate() {
            let at = [deck.number(p, 2, "X")?, deck.number(p, 3, "Y")?, deck.number(p, 4, "Z")?];
            let _ = write!(out, "{} point{} = {at:?}", if k > 0 { "," } else { "" }, p.words[0].text);
        }
        out.push_str(" }\n");
    }
    if !free {
        let _ = write!(
            out,
            "\n# moved from outside in the deck: give it a `vessel` or `driving` instead\n[[constraints]]\ntype = \"weld\"\n\
             name = \"body{0}\"\nmarker = \"body{0}\"\n",
            id.text
        );
    }
    Ok(())
}

/// Joins the ends of lines at a point.
fn fasten(point: &Point<'_>, lines: &[Line<'_>], density: f64, out: &mut String) {
    let at = |l: &Line<'_>, k: usize| format!("{}.{}", l.name, ["start", "end"][k]);
    let mut ends = lines.iter().flat_map(|l| [(l, 0), (l, 1)]).filter(|(l, k)| l.ends[*k] == point.id);
    let spherical = |name: &str, marker: &str, to: &str, out: &mut String| {
        let _ = write!(
            out,
            "\n[[constraints]]\ntype = \"spherical\"\nname = \"{name}\"\nmarker = \"{marker}\"\n{to}"
        );
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
                spherical(&name, &at(l, end), "", out);
            }
        }
        Held::Body => {
            for (l, end) in ends {
                let to = format!("to = \"{}.point{id}\"\n", point.body);
                spherical(&format!("point{id}-{}", l.name), &at(l, end), &to, out);
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
                spherical(&format!("point{id}-{}", l.name), &at(l, end), &to, out);
            }
        }
    }
}

/// Gravity, water and the bed.
fn forces(deck: &Deck<'_>, lines: &[Line<'_>], folder: &Path, out: &mut String) -> Result<(), Fault> {
    out.push_str("\n[[forces]]\ntype = \"gravity\"\n\n[[forces]]\ntype = \"buoyancy\"\n");
    let kinds = |same: &dyn Fn(&Line<'_>) -> Vec<u64>| {
        let mut groups: Vec<(Vec<u64>, Vec<&Line<'_>>)> = Vec::new();
        for l in lines {
            let key = same(l);
            match groups.iter_mut().find(|(k, _)| *k == key) {
                Some((_, all)) => all.push(l),
                None => groups.push((key, vec![l])),
            }
        }
        groups.into_iter().map(|(_, all)| all).collect::<Vec<_>>()
    };
    let names =
        |all: &[&Line<'_>]| all.iter().map(|l| format!("\"{}\"", l.name)).collect::<Vec<_>>().join(", ");
    for all in kinds(&|l| vec![l.kind.fluid[0].to_bits(), l.kind.fluid[2].to_bits()]) {
        let [cd, _, along, _] = all[0].kind.fluid;
        if cd != 0.0 || along != 0.0 {
            let _ = write!(
                out,
                "\n[[forces]]\ntype = \"drag\"\ncn = {cd:?}\nct = {along:?}\non = [{}]\n",
                names(&all)
            );
        }
    }
    for all in kinds(&|l| vec![l.kind.fluid[1].to_bits()]) {
        let ca = all[0].kind.fluid[1];
        if ca != 0.0 {
            let _ = write!(out, "\n[[forces]]\ntype = \"added_mass\"\nca = {ca:?}\non = [{}]\n", names(&all));
        }
    }
    let depth = deck.option_number(&["wtrdpth"], 0.0)?;
    let floor = deck.option(&["seafloorfile"]).map(|row| deck.word(row, 0, "file")).transpose()?;
    let (stiffness, damping) =
        (deck.option_number(&["kbot", "kb"], 3e6)?, deck.option_number(&["cbot", "cb"], 3e5)?);
    if stiffness == 0.0 || depth == 0.0 && floor.is_none() {
        return Ok(());
    }
    let friction = deck.option_number(&["frictioncoefficient"], 0.0)?;
    let grid = floor.map(|file| grid(&file.text, folder)).transpose()?;
    for (k, all) in kinds(&|l| vec![l.kind.diameter.to_bits()]).into_iter().enumerate() {
        let name = if k == 0 { "bed".to_string() } else { format!("bed-{}", k + 1) };
        let radius = 0.5 * all[0].kind.diameter;
        let below = if grid.is_some() { 0.0 } else { 0.0 - depth };
        let _ = write!(
            out,
            "\n# the axis of a line lies on the deck's bed, here half a diameter above\n[[forces]]\ntype = \"bed\"\n\
             name = \"{name}\"\npoint = [0, 0, {:?}]\nstiffness = {stiffness:?}\ndamping = {damping:?}\non = [{}]\n",
            below - radius,
            names(&all)
        );
        if friction > 0.0 {
            let _ = writeln!(out, "friction = {friction:?}");
        }
        out.push_str(grid.as_deref().unwrap_or(""));
    }
    Ok(())
}

/// The heights of a sea floor: numbers of lines, the lines along x and y, and rows `x y z`.
fn grid(file: &str, folder: &Path) -> Result<String, Fault> {
    let name = Path::new(file).file_name().map_or(file, |f| f.to_str().unwrap_or(file));
    let file = if folder.join(file).exists() { file } else { name };
    let rows = table(folder, file, 2, 0)?;
    let bad = |why: &str| Fault::new(format!("`{file}` is no sea floor: {why}"));
    let [_, x, y, heights @ ..] = &rows[..] else {
        return Err(bad("it needs the lines along x and y, and heights"));
    };
    let mut z = vec![vec![f64::NAN; y.len()]; x.len()];
    for row in heights {
        let near = |all: &[f64], at: f64| all.iter().position(|x| (x - at).abs() <= 1e-6 * (1.0 + at.abs()));
        let ([i, j], height) = match row[..] {
            [a, b, c] => ([near(x, a), near(y, b)], c),
            _ => return Err(bad("each height is a row `x y z`")),
        };
        match (i, j) {
            (Some(i), Some(j)) => z[i][j] = height,
            _ => return Err(bad("a height isn't on its lines")),
        }
    }
    if z.iter().flatten().any(|z| z.is_nan()) {
        return Err(bad("a crossing of its lines has no height"));
    }
    Ok(format!("grid = {{ x = {x:?}, y = {y:?}, z = {z:?} }}\n"))
}

/// Tensions at both ends of each line, and what the deck asks for besides.
fn records(
    deck: &Deck<'_>,
    lines: &[Line<'_>],
    points: &[Point<'_>],
    notes: &mut Vec<String>,
    out: &mut String,
) {
    for line in lines {
        let number = line.name.trim_start_matches("line");
        for (name, at) in [("FairTen", "end"), ("AnchTen", "start")] {
            let _ = write!(
                out,
                "\n[[records]]\ntype = \"along\"\nof = \"{}\"\nwhat = \"tension\"\nat = \"{at}\"\nname = \"{name}{number}\"\n",
                line.name
            );
        }
    }
    let mut left = Vec::new();
    let mut places = Vec::new();
    for word in deck.outputs.iter().flat_map(|row| &row.words) {
        let said = word.text.to_lowercase();
        if said.starts_with("fairten") || said.starts_with("anchten") {
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
            _ => left.push(word.text.clone()),
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
