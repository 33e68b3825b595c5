//! `ropewalk export SCENE`: a deck of MoorDyn

use super::{Exit, say, warn};
use crate::cli::SceneArgs;
use ropewalk_elements::{CableSpec, PointMassSpec};
use ropewalk_forces::{AddedMassSpec, DragLaw, DragSpec};
use ropewalk_models::Bundled;
use ropewalk_scene::{Fault, MarkerRef, Scene, SceneText};
use ropewalk_studies::Error;
use serde::de::DeserializeOwned;
use serde_json::Value;
use std::fmt::Write as _;
use std::path::PathBuf;

/// A scene, and where its deck goes.
#[derive(Debug, clap::Args)]
pub(crate) struct ExportArgs {
    #[command(flatten)]
    scene: SceneArgs,
    /// Write the deck here instead of on standard output
    #[arg(long, short, value_name = "FILE")]
    out: Option<PathBuf>,
}

pub(crate) fn run(args: &ExportArgs, bundled: &[Bundled]) -> Result<Exit, Error> {
    let file = SceneText::open(&args.scene.scene, bundled)?.with(&args.scene.overrides)?;
    let mut notes = Vec::new();
    let text = deck(file.scene(), &mut notes)?;
    for note in &notes {
        warn(note);
    }
    match &args.out {
        None => say(text.trim_end()),
        Some(out) => {
            std::fs::write(out, &text)
                .map_err(|e| Fault::new(format!("`{}` can't be written: {e}", out.display())))?;
            say(out.display().to_string());
        }
    }
    Ok(Exit::Done)
}

fn refuse<T>(what: &str, help: &str) -> Result<T, Fault> {
    Err(Fault::new(format!("{what} has no counterpart in a deck of MoorDyn")).with_help(help))
}

/// A spec by its type, as data.
fn tagged(value: &Value) -> (String, Value) {
    let one = value.as_object().and_then(|o| o.iter().next());
    one.map_or_else(|| (String::new(), Value::Null), |(name, fields)| (name.clone(), fields.clone()))
}

fn typed<T: DeserializeOwned>(fields: Value) -> Result<T, Fault> {
    serde_json::from_value(fields).map_err(|e| Fault::new(e.to_string()))
}

/// What a point of the deck is: its type, place, and mass, volume, CdA and Ca.
struct Point {
    kind: &'static str,
    at: [f64; 3],
    own: [f64; 4],
}

/// What is known of the deck so far.
struct Deck {
    points: Vec<Point>,
    /// Ends of cables, by name, and the points that they are at.
    ends: Vec<(String, usize)>,
}

impl Deck {
    fn end(&self, marker: &MarkerRef) -> Option<usize> {
        let MarkerRef::Name(name) = marker else { return None };
        self.ends.iter().find(|(end, _)| end == name.trim()).map(|(_, point)| *point)
    }

    /// Two ends become one point: all of the second moves to the first.
    fn join(&mut self, a: usize, b: usize) {
        self.ends.iter_mut().filter(|(_, point)| *point == b).for_each(|(_, point)| *point = a);
    }
}

/// What the water does to a cable: Cd, CdAx, Ca, CaAx.
fn fluid(forces: &[(String, Value)], cable: &str) -> Result<[f64; 4], Fault> {
    let mut all = [0.0; 4];
    let on = |names: &[String]| names.is_empty() || names.iter().any(|name| name == cable);
    for (kind, fields) in forces {
        if kind == "drag" {
            let drag: DragSpec = typed(fields.clone())?;
            if on(&drag.on) && [drag.normal, drag.tangential] != [DragLaw::Constant; 2] {
                return refuse("drag by Reynolds number", "take `normal = \"constant\"` and a `cn`");
            }
            if on(&drag.on) {
                (all[0], all[1]) = (drag.cn, drag.ct);
            }
        }
        if kind == "added_mass" {
            let mass: AddedMassSpec = typed(fields.clone())?;
            if on(&mass.on) {
                (all[2], all[3]) = (mass.ca, mass.ca_axial);
            }
        }
    }
    Ok(all)
}

/// Depth, stiffness, damping and friction of the bed.
fn bed(
    forces: &[(String, Value)],
    diameter: impl Fn(&str) -> Option<f64>,
) -> Result<Option<[f64; 4]>, Fault> {
    let mut found: Option<[f64; 4]> = None;
    for (_, fields) in forces.iter().filter(|(kind, _)| kind == "bed") {
        let number = |name: &str| fields[name].as_f64().unwrap_or(0.0);
        if number("slope") != 0.0 || !fields["grid"].is_null() {
            return refuse("a bed that isn't level", "make it level: `slope = 0`, without `grid`");
        }
        let on = fields["on"].as_array().and_then(|on| on.first()).and_then(Value::as_str).unwrap_or("");
        // the axis of a line lies on the deck's bed, here half a diameter above
        let radius = fields["radius"].as_f64().or_else(|| diameter(on).map(|d| 0.5 * d)).unwrap_or(0.0);
        let mu = fields["friction"]["mu"].as_f64().unwrap_or(0.0);
        let one = [
            -fields["point"][2].as_f64().unwrap_or(0.0) - radius,
            number("stiffness"),
            number("damping"),
            mu,
        ];
        let same = |a: &[f64; 4]| a.iter().zip(&one).all(|(a, b)| (a - b).abs() <= 1e-9 * (1.0 + b.abs()));
        if found.is_some_and(|found| !same(&found)) {
            return refuse("a second bed", "a deck has one, on which the axes of lines lie");
        }
        found = Some(one);
    }
    Ok(found)
}

/// The deck of a scene.
fn deck(scene: &Scene, notes: &mut Vec<String>) -> Result<String, Fault> {
    let data = |value: Result<Value, serde_json::Error>| {
        value.map(|v| tagged(&v)).map_err(|e| Fault::new(e.to_string()))
    };
    let elements =
        scene.elements.iter().map(|e| data(serde_json::to_value(&**e))).collect::<Result<Vec<_>, _>>()?;
    let constraints =
        scene.constraints.iter().map(|c| data(serde_json::to_value(&**c))).collect::<Result<Vec<_>, _>>()?;
    let forces =
        scene.forces.iter().map(|f| data(serde_json::to_value(&**f))).collect::<Result<Vec<_>, _>>()?;
    let Some(water) = &scene.water else {
        return refuse("a scene without water", "MoorDyn's lines are in water: add [water]");
    };
    if water.waves.is_some()
        || !water.profile.is_empty()
        || water.current.iter().any(|u| u.number() != Some(0.0))
    {
        return refuse(
            "a current or waves",
            "take them out here, and give the deck files of its own (`Currents`, `WaveKin`)",
        );
    }
    if water.level.is_some_and(|level| level != 0.0) {
        return refuse(
            "a level of the water other than 0",
            "move the scene, so that still water is at z = 0",
        );
    }
    for needed in ["gravity", "buoyancy"] {
        if !forces.iter().any(|(kind, _)| kind == needed) {
            return refuse(
                &format!("a scene without {needed}"),
                "MoorDyn's lines always have weight and buoyancy",
            );
        }
    }
    if let Some((kind, _)) = forces
        .iter()
        .find(|(k, _)| !["gravity", "buoyancy", "drag", "added_mass", "bed"].contains(&k.as_str()))
    {
        return refuse(&format!("the force `{kind}`"), "take it out of the scene if the deck can do without");
    }

    let (mut cables, mut masses) = (Vec::<CableSpec>::new(), Vec::<PointMassSpec>::new());
    for (kind, fields) in elements {
        match kind.as_str() {
            "cable" => cables.push(typed(fields)?),
            "point_mass" => masses.push(typed(fields)?),
            _ => {
                return refuse(
                    &format!("an element of type `{kind}`"),
                    "cables and point masses are written",
                );
            }
        }
    }
    if cables.is_empty() {
        return refuse("a scene without cables", "a deck is one of lines");
    }
    let mut deck = Deck { points: Vec::new(), ends: Vec::new() };
    for cable in &cables {
        let ends = [cable.points.first(), cable.points.last()];
        for (end, at) in ["start", "end"].into_iter().zip(ends) {
            let Some(at) = at.filter(|_| cable.route.is_empty()) else {
                return refuse(&format!("the path of `{}`", cable.name), "give it two `points`");
            };
            deck.ends.push((format!("{}.{end}", cable.name), deck.points.len()));
            deck.points.push(Point { kind: "Free", at: *at, own: [0.0; 4] });
        }
    }
    for mass in &masses {
        let Some(point) = deck.end(&mass.marker) else {
            return refuse(
                &format!("the mass `{}`, which isn't at an end of a cable,", mass.name),
                "put it there",
            );
        };
        let displaced = water.density * mass.volume;
        if mass.added_mass > 0.0 && displaced == 0.0 {
            return refuse(
                &format!("added mass of `{}` without volume", mass.name),
                "a deck has it as a coefficient on the volume",
            );
        }
        let ca = if displaced > 0.0 { mass.added_mass / displaced } else { 0.0 };
        deck.points[point].own = [mass.mass, mass.volume, mass.drag_area, ca];
        deck.ends.push((mass.name.clone(), point));
    }
    for (kind, fields) in &constraints {
        let name = fields["name"].as_str().unwrap_or("");
        let marker =
            |field: &str| fields.get(field).filter(|v| !v.is_null()).map(|v| typed::<MarkerRef>(v.clone()));
        let point = marker("marker").transpose()?.and_then(|m| deck.end(&m));
        let to = marker("to").transpose()?;
        let other = to.as_ref().and_then(|to| deck.end(to));
        match (kind.as_str(), point, to.is_some(), other) {
            ("spherical", Some(point), false, _) => deck.points[point].kind = "Fixed",
            ("spherical", Some(point), true, Some(other)) => {
                if deck.points[other].own == [0.0; 4] {
                    deck.points[other].own = deck.points[point].own;
                }
                deck.join(other, point);
            }
            ("driving", Some(point), false, _) => {
                deck.points[point].kind = "Coupled";
                notes.push(format!("`{name}` moves a point: its motion isn't in the deck, but comes from the program that calls MoorDyn"));
            }
            _ => {
                return refuse(
                    &format!("the constraint `{name}` of type `{kind}`"),
                    "ends of cables that are `spherical` on the ground or at each other, and `driving`, are written",
                );
            }
        }
    }
    write(scene, deck, &cables, &forces, water.density)
}

/// The rows of the deck.
fn write(
    scene: &Scene,
    mut deck: Deck,
    cables: &[CableSpec],
    forces: &[(String, Value)],
    density: f64,
) -> Result<String, Fault> {
    let (mut types, mut lines) = (Vec::<String>::new(), String::new());
    let mut count = 0;
    let at = |deck: &Deck, name: &str| deck.ends.iter().find(|(end, _)| end == name).map_or(0, |(_, p)| *p);
    for cable in cables {
        let ends = [cable.points[0], cable.points[cable.points.len() - 1]];
        let chord: f64 = cable
            .points
            .windows(2)
            .map(|p| (0..3).map(|i| (p[1][i] - p[0][i]).powi(2)).sum::<f64>().sqrt())
            .sum();
        let length = cable.length.unwrap_or(chord);
        let all = fluid(forces, &cable.name)?;
        let pieces: Vec<_> = match cable.sections.is_empty() {
            true => vec![(length, &cable.section, cable.elements)],
            false => {
                let share = |from: f64, to: f64| {
                    ((to - from) / length * cable.elements as f64).round().max(1.0) as usize
                };
                let mut from = 0.0;
                let along = cable.sections.iter().map(|s| {
                    let to = s.to.unwrap_or(length);
                    let piece = (to, &s.section, s.elements.unwrap_or_else(|| share(from, to)));
                    from = to;
                    (piece, s.end_section.is_some())
                });
                let along: Vec<_> = along.collect();
                if along.iter().any(|(_, tapers)| *tapers) {
                    return refuse(
                        &format!("a section of `{}` that changes along it", cable.name),
                        "leave `end_section` out",
                    );
                }
                along.into_iter().map(|(piece, _)| piece).collect()
            }
        };
        let (mut from, mut before) = (0.0, at(&deck, &format!("{}.start", cable.name)));
        let last = at(&deck, &format!("{}.end", cable.name));
        for (k, (to, section, elements)) in pieces.iter().enumerate() {
            let fields = serde_json::to_value(section).map_err(|e| Fault::new(e.to_string()))?;
            let Some(ei) = fields["ei"]
                .as_f64()
                .filter(|_| section.axial_force.is_none() && section.bending_moment.is_none())
            else {
                return refuse(
                    &format!("the section of `{}`", cable.name),
                    "give it one number for `ea` and one for `ei`",
                );
            };
            if section.displaced.is_some() || section.flooded != 0.0 || section.gj.is_some() {
                return refuse(
                    &format!("`displaced`, `flooded` or `gj` of `{}`", cable.name),
                    "a deck has diameter and mass alone",
                );
            }
            let [cd, along, ca, ca_along] = all;
            let row = format!(
                "{:?} {:?} {:?} {:?} {ei:?} {cd:?} {ca:?} {along:?} {ca_along:?}",
                section.diameter,
                section.mass,
                section.ea,
                section.ea * section.axial_retardation_time,
            );
            let kind = types.iter().position(|t| *t == row).unwrap_or_else(|| {
                types.push(row);
                types.len() - 1
            });
            let next = if k + 1 == pieces.len() {
                last
            } else {
                let share = to / length;
                let at = std::array::from_fn(|i| ends[0][i] + share * (ends[1][i] - ends[0][i]));
                deck.points.push(Point { kind: "Free", at, own: [0.0; 4] });
                deck.points.len() - 1
            };
            count += 1;
            // two segments for each element, whose order is higher
            let _ = writeln!(
                lines,
                "{count} type{} {} {} {:?} {} -",
                kind + 1,
                before + 1,
                next + 1,
                to - from,
                2 * elements
            );
            (from, before) = (*to, next);
        }
    }
    let mut out = format!(
        "--- MoorDyn Input File ---\n{}\n--- LINE TYPES ---\n",
        scene.title.lines().next().unwrap_or("a scene")
    );
    out.push_str("TypeName Diam Mass/m EA BA/-zeta EI Cd Ca CdAx CaAx\n(name) (m) (kg/m) (N) (N-s/-) (N-m^2) (-) (-) (-) (-)\n");
    for (k, row) in types.iter().enumerate() {
        let _ = writeln!(out, "type{} {row}", k + 1);
    }
    out.push_str(
        "--- POINTS ---\nID Type X Y Z Mass Volume CdA Ca\n(#) (-) (m) (m) (m) (kg) (m^3) (m^2) (-)\n",
    );
    let used: Vec<usize> =
        deck.ends.iter().map(|(_, p)| *p).chain(2 * cables.len()..deck.points.len()).collect();
    for (k, p) in deck.points.iter().enumerate().filter(|(k, _)| used.contains(k)) {
        let ([x, y, z], [mass, volume, area, ca]) = (p.at, p.own);
        let _ = writeln!(out, "{} {} {x:?} {y:?} {z:?} {mass:?} {volume:?} {area:?} {ca:?}", k + 1, p.kind);
    }
    out.push_str("--- LINES ---\nID LineType AttachA AttachB UnstrLen NumSegs LineOutputs\n(#) (name) (#) (#) (m) (-) (-)\n");
    out.push_str(&lines);
    let _ = writeln!(out, "--- OPTIONS ---\n{:?} g\n{density:?} WtrDnsty", -scene.gravity[2]);
    let diameter =
        |name: &str| cables.iter().find(|c| c.name == name || name.is_empty()).map(|c| c.section.diameter);
    if let Some([depth, stiffness, damping, mu]) = bed(forces, diameter)? {
        let _ = writeln!(
            out,
            "{depth:?} WtrDpth\n{stiffness:?} kBot\n{damping:?} cBot\n{mu:?} FrictionCoefficient"
        );
    } else {
        // no bed within reach
        let _ = writeln!(out, "0.0 kBot\n0.0 cBot");
    }
    out.push_str("--- OUTPUTS ---\n");
    let names: Vec<String> = (1..=count).map(|k| format!("FairTen{k} AnchTen{k}")).collect();
    let _ = writeln!(out, "{}\n--- need this line ---", names.join("\n"));
    Ok(out)
}
