//! The scene that a deck of MoorDyn stands for.

use super::deck::{Deck, Row, Wrong};
use std::fmt::Write;

/// Options that say nothing about the physics, or what equilibria replace.
const DROPPED: &[&str] = &[
    "dtM",
    "dtOut",
    "dtIC",
    "TmaxIC",
    "CdScaleIC",
    "threshIC",
    "ICgenDynamic",
    "tScheme",
    "CFL",
    "writeLog",
    "WriteUnits",
    "disableOutput",
    "disableOutTime",
    "ICDfac",
    "ICdt",
    "ICTmax",
    "ICthresh",
    "FricDamp",
    "StatDynFricScale",
    "inertialF",
    "inertialF_rampT",
];

/// A type of line.
struct Kind {
    name: String,
    diameter: f64,
    cn: f64,
    ca: f64,
    ct: f64,
}

/// A point to which lines are fixed.
struct Point {
    id: String,
    how: How,
    x: [f64; 3],
    mass: f64,
    volume: f64,
    drag: f64,
    added: f64,
}

#[derive(Clone, Copy, PartialEq)]
enum How {
    Fixed,
    Coupled,
    Free,
}

/// A line: its name, the type, and the numbers of its points from its start to its end.
struct Line {
    name: String,
    kind: usize,
    ends: [usize; 2],
}

/// Writes the scene, and what one should know of it.
pub(super) fn write(deck: &Deck, title: &str) -> Result<(String, Vec<String>), Wrong> {
    let mut notes = Vec::new();
    let mut text = format!("title = \"{}\"\n", title.replace(['"', '\\'], " "));
    let depth = deck.number(&["WtrDpth", "depth", "WaterDepth"], 0.0)?;
    let (density, gravity) = (
        deck.number(&["rhoW", "rho", "WtrDnsty", "WtrDens"], 1025.0)?,
        deck.number(&["g", "gravity"], 9.80665)?,
    );
    for (option, what) in [("WaveKin", "[water.waves]"), ("Currents", "`current` or `profile` of [water]")] {
        if let Some((value, line)) = deck.option(&[option]).filter(|(v, _)| *v != "0") {
            let why = format!(
                "{option} {value} reads files of its own, which aren't imported: set it to 0, and give the scene {what}"
            );
            return Err((line, why));
        }
    }
    let dropped: Vec<&str> = DROPPED.iter().copied().filter(|name| deck.option(&[name]).is_some()).collect();
    if !dropped.is_empty() {
        notes.push(format!(
            "{} left out: steps are controlled by their error, and runs begin at an equilibrium",
            dropped.join(", ")
        ));
    }
    let _ = write!(
        text,
        "gravity = [0, 0, {}]\n\n[run]\nduration = \"60 s\"\noutput = \"0.1 s\"\nfrom_equilibrium = true\n\n[water]\ndensity = {density}\nlevel = 0\n",
        -gravity
    );
    let kinds = kinds(deck, &mut text, &mut notes)?;
    let points = points(deck)?;
    let lines = lines(deck, &kinds, &points, &mut text)?;
    joints(&points, &lines, density, &mut text, &mut notes);
    forces(deck, &kinds, &lines, depth, &mut text)?;
    records(deck, &points, &lines, &mut text, &mut notes);
    Ok((text, notes))
}

/// Sections of cables.
fn kinds(deck: &Deck, text: &mut String, notes: &mut Vec<String>) -> Result<Vec<Kind>, Wrong> {
    let segments = |name: &str| {
        let of = |row: &&Row| row.words.get(1).is_some_and(|w| w == name);
        let row = deck.lines.iter().find(of)?;
        Some(row.number(4, "UnstrLen").ok()? / row.number(5, "NumSegs").ok()?.max(1.0))
    };
    let mut all = Vec::new();
    for row in &deck.types {
        let name = row.word(0, "name")?.to_string();
        let [diameter, mass] = [row.number(1, "Diam")?, row.number(2, "Mass/m")?];
        let stiff = row.word(3, "EA")?;
        if stiff.contains('|') || stiff.parse::<f64>().is_err() {
            let why =
                format!("EA `{stiff}`: viscoelastic and tabulated stiffness isn't imported; give a number");
            return Err((row.line, why));
        }
        let (ea, damping, ei) = (row.number(3, "EA")?, row.number(4, "BA/-zeta")?, row.number(5, "EI")?);
        let [cn, ca, ct, along] =
            [(6, "Cd"), (7, "Ca"), (8, "CdAx"), (9, "CaAx")].map(|(k, what)| row.number(k, what));
        let (cn, ca, ct, along) = (cn?, ca?, ct?, along?);
        if row.words.get(10).is_some_and(|w| w.parse::<f64>().is_ok_and(|cl| cl != 0.0)) {
            return Err((row.line, "Cl: vortex-induced vibration isn't known here; set it to 0".into()));
        }
        if along != 0.0 {
            notes.push(format!("`{name}`: CaAx = {along} left out: cables have added mass across alone"));
        }
        // MoorDyn's ratio is one of each segment: it depends on the mesh there
        let (damping, comment) = match (damping < 0.0, segments(&name)) {
            (true, Some(l)) => (
                -damping * l * (ea * mass).sqrt(),
                format!("   # {} of the critical damping of a segment of {l} m", -damping),
            ),
            (true, None) => (0.0, String::new()),
            _ => (damping, String::new()),
        };
        let _ = writeln!(
            text,
            "\n[[sections]]                     # line {} of the deck\nname = {name:?}",
            row.line
        );
        let _ = writeln!(text, "mass = {mass}\nea = {ea:e}\ndiameter = {diameter}");
        let _ = writeln!(
            text,
            "{}",
            if ei > 0.0 { format!("ei = {ei:e}") } else { "tension_only = true".into() }
        );
        if damping > 0.0 {
            let _ = writeln!(text, "axial_retardation_time = {:e}{comment}", damping / ea);
        }
        all.push(Kind { name, diameter, cn, ca, ct });
    }
    Ok(all)
}

fn points(deck: &Deck) -> Result<Vec<Point>, Wrong> {
    let mut all = Vec::new();
    for row in &deck.points {
        let how = match row.word(1, "attachment")?.to_lowercase().as_str() {
            "fixed" | "fix" | "anchor" => How::Fixed,
            "coupled" | "vessel" | "ves" | "cpl" => How::Coupled,
            "free" | "connect" | "con" => How::Free,
            other => {
                let why = format!("a point on `{other}` isn't imported: Fixed, Coupled and Free are");
                return Err((row.line, why));
            }
        };
        let optional = |k: usize, what: &str| if row.words.len() > k { row.number(k, what) } else { Ok(0.0) };
        all.push(Point {
            id: row.word(0, "ID")?.to_string(),
            how,
            x: [row.number(2, "X")?, row.number(3, "Y")?, row.number(4, "Z")?],
            mass: optional(5, "Mass")?,
            volume: optional(6, "Volume")?,
            drag: optional(7, "CdA")?,
            added: optional(8, "Ca")?,
        });
    }
    Ok(all)
}

/// Cables: half as many elements as MoorDyn has segments, each of which is of higher order.
fn lines(deck: &Deck, kinds: &[Kind], points: &[Point], text: &mut String) -> Result<Vec<Line>, Wrong> {
    let mut all = Vec::new();
    for row in &deck.lines {
        let (id, kind) = (row.word(0, "ID")?, row.word(1, "LineType")?);
        let Some(kind) = kinds.iter().position(|k| k.name == kind) else {
            return Err((row.line, format!("there is no line type `{kind}`")));
        };
        let end = |k: usize, what: &str| {
            let word = row.word(k, what)?;
            let id = word.trim_start_matches(|c: char| c.is_alphabetic());
            let found = points.iter().position(|p| p.id == id && !word.to_lowercase().starts_with('r'));
            found.ok_or_else(|| {
                (row.line, format!("{what} `{word}` is no point: rods and bodies aren't imported yet"))
            })
        };
        let ends = [end(2, "AttachA")?, end(3, "AttachB")?];
        let (length, segments) = (row.number(4, "UnstrLen")?, row.number(5, "NumSegs")?);
        if !(length > 0.0 && segments >= 1.0) {
            return Err((row.line, "a line needs a length and segments".into()));
        }
        let name = format!("line{id}");
        let [a, b] = ends.map(|k| points[k].x);
        let _ = writeln!(
            text,
            "\n[[elements]]                     # line {} of the deck\ntype = \"cable\"\nname = {name:?}\npoints = [{a:?}, {b:?}]\nlength = {length}\nelements = {}\nsection = {:?}",
            row.line,
            (0.5 * segments).ceil().max(4.0) as usize,
            kinds[kind].name
        );
        all.push(Line { name, kind, ends });
    }
    Ok(all)
}

/// What holds the ends of the lines.
fn joints(points: &[Point], lines: &[Line], density: f64, text: &mut String, notes: &mut Vec<String>) {
    for (k, point) in points.iter().enumerate() {
        let ends: Vec<String> = lines
            .iter()
            .flat_map(|line| {
                line.ends
                    .iter()
                    .zip(["start", "end"])
                    .filter(|(e, _)| **e == k)
                    .map(|(_, end)| format!("{}.{end}", line.name))
            })
            .collect();
        let Some((first, others)) = ends.split_first() else { continue };
        if point.how == How::Free {
            if point.mass > 0.0 {
                let _ = writeln!(
                    text,
                    "\n[[elements]]\ntype = \"point_mass\"\nname = \"point{}\"\nmarker = {first:?}\nmass = {}\nvolume = {}\ndrag_area = {}\nadded_mass = {}",
                    point.id,
                    point.mass,
                    point.volume,
                    point.drag,
                    point.added * point.volume * density
                );
            } else if point.volume > 0.0 {
                notes.push(format!(
                    "point {} has a volume without mass, which is left out: give it a mass",
                    point.id
                ));
            }
            for (j, other) in others.iter().enumerate() {
                let _ = writeln!(
                    text,
                    "\n[[constraints]]\ntype = \"spherical\"\nname = \"point{}-{}\"\nmarker = {other:?}\nto = {first:?}",
                    point.id,
                    j + 1
                );
            }
            continue;
        }
        if point.how == How::Coupled {
            notes.push(format!(
                "point {} is coupled: `point{}-1` holds it where it is; make it `driving` with a motion, or fix it to a body with a `vessel`",
                point.id, point.id
            ));
        }
        for (j, end) in ends.iter().enumerate() {
            let _ = writeln!(
                text,
                "\n[[constraints]]\ntype = \"spherical\"\nname = \"point{}-{}\"\nmarker = {end:?}",
                point.id,
                j + 1
            );
        }
    }
}

fn forces(deck: &Deck, kinds: &[Kind], lines: &[Line], depth: f64, text: &mut String) -> Result<(), Wrong> {
    text.push_str("\n[[forces]]\ntype = \"gravity\"\n\n[[forces]]\ntype = \"buoyancy\"\n");
    let (k, c) = (deck.number(&["kBot", "kb"], 3e6)?, deck.number(&["cBot", "cb"], 3e5)?);
    let mu = deck.number(&["FrictionCoefficient", "FricCoeff", "mu_kT", "mu"], 0.0)?;
    for (i, kind) in kinds.iter().enumerate() {
        let on: Vec<&str> = lines.iter().filter(|l| l.kind == i).map(|l| l.name.as_str()).collect();
        if on.is_empty() {
            continue;
        }
        let _ =
            writeln!(text, "\n[[forces]]\ntype = \"drag\"\ncn = {}\nct = {}\non = {on:?}", kind.cn, kind.ct);
        let _ = writeln!(text, "\n[[forces]]\ntype = \"added_mass\"\nca = {}\non = {on:?}", kind.ca);
        if depth > 0.0 {
            let _ = writeln!(
                text,
                "\n[[forces]]\ntype = \"bed\"\nname = \"bed under {}\"\non = {on:?}\npoint = [0, 0, {}]    # lines lie with their axes on the bed, as in MoorDyn\nstiffness = {k:e}\ndamping = {c:e}",
                kind.name,
                -depth - 0.5 * kind.diameter
            );
            if mu > 0.0 {
                let _ = writeln!(text, "friction = {mu}");
            }
        }
    }
    Ok(())
}

/// Reactions at points, and what outputs ask for.
fn records(deck: &Deck, points: &[Point], lines: &[Line], text: &mut String, notes: &mut Vec<String>) {
    for point in points.iter().filter(|p| p.how != How::Free) {
        let k = points.iter().position(|p| p.id == point.id);
        let count = lines.iter().flat_map(|l| l.ends).filter(|e| Some(*e) == k).count();
        for j in 1..=count {
            let _ = writeln!(
                text,
                "\n[[records]]\ntype = \"reaction\"\nof = \"point{}-{j}\"\nwhat = \"magnitude\"",
                point.id
            );
        }
    }
    let mut left = Vec::new();
    for row in &deck.outputs {
        let word = row.words[0].trim_matches(['"', ',', '\'']);
        let lower = word.to_lowercase();
        let of = |prefix: &str, end: &str| {
            let line = lines.iter().find(|l| Some(&l.name[4..]) == lower.strip_prefix(prefix))?;
            Some(format!(
                "type = \"along\"\nof = {:?}\nwhat = \"tension\"\nat = {end:?}\nname = {word:?}",
                line.name
            ))
        };
        match of("fairten", "end").or_else(|| of("anchten", "start")) {
            Some(record) => _ = writeln!(text, "\n[[records]]\n{record}"),
            None => left.push(word.to_string()),
        }
    }
    if !left.is_empty() {
        notes.push(format!(
            "outputs left out: {}; `ropewalk describe position` and `along` have the like",
            left.join(", ")
        ));
    }
}
