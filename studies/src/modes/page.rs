//! The page of the modes of a scene: each swings through one period, one mode after the other.

use super::{Modal, pictures};
use crate::run::{Scenery, Shape};
use ropewalk_core::At;
use ropewalk_report::{Entry, Event, FieldRecord, LineRecord, Page, Panel, Quantity, number};
use ropewalk_scene::SceneFile;
use std::f64::consts::TAU;

/// Snapshots of a period.
const FRAMES: usize = 24;
/// Where the last of them stands, in parts of the period.
const WHOLE: f64 = 0.9999;
/// Points of all snapshots together.
const MOST_POINTS: usize = 200_000;

/// The page: its axis is the number of the mode, and between two numbers the first one swings through a period.
pub(super) fn page(file: &SceneFile, modal: &Modal) -> Page {
    let mut history = modal.table();
    history.columns.retain(|c| !c.name.starts_with("share.") && c.name != "rigid");
    let modes = modal.modes.iter().enumerate();
    let events =
        modes.map(|(k, mode)| Event { t: (k + 1) as f64, text: pictures::title(k + 1, mode) }).collect();
    let names = ["frequency", "damping ratio", "growth"];
    let panels = names.map(|name| Panel { title: name.into(), columns: vec![name.into()] });
    let mut summary = vec![Entry::new("modes", modal.modes.len().to_string())];
    if let Some(first) = modal.modes.iter().find(|m| m.omega > 0.0) {
        summary.push(Entry::new("lowest frequency", format!("{} Hz", number(first.frequency()))));
    }
    summary.push(Entry::new("unknowns", modal.model.velocities().to_string()));
    Page {
        title: format!("{}: vibration modes", file.title()),
        subtitle: format!("{} · Ropewalk {}", file.name(), env!("CARGO_PKG_VERSION")),
        status: if modal.unstable { "unstable" } else { "" }.into(),
        scene: file.document().to_toml(),
        summary,
        warnings: modal.warnings.clone(),
        notes: vec![
            "The time of this page is the number of the mode: from 1 to 2 the first one swings through a period, and so on. \
             Events lead to each of them. Motion is drawn far larger than it is."
                .into(),
        ],
        events,
        history,
        panels: panels.into(),
        restarts: (1..=modal.modes.len()).map(|k| k as f64).collect(),
        field: field(file, modal),
        ..Page::default()
    }
}

/// Every mode through a period.
fn field(file: &SceneFile, modal: &Modal) -> FieldRecord {
    let scenery = Scenery::new(file, &modal.model, None);
    let shape =
        |t: f64, q: &[f64]| Shape::of(&modal.model, &At { t, q, ..modal.state.at() }, &[], Some(&scenery));
    let scales = pictures::scales(modal);
    let fits = MOST_POINTS / (scenery.points().max(1) * FRAMES);
    let mut shapes = Vec::new();
    let mut q = modal.state.q.clone();
    for (k, (mode, scale)) in modal.modes.iter().zip(scales).enumerate().take(fits.max(1)) {
        for frame in 0..=FRAMES {
            let share = frame as f64 / FRAMES as f64;
            pictures::swing(modal, mode, scale, TAU * share, &mut q);
            // the end of a period is the beginning of the next mode, but for a hair
            shapes.push(shape((k + 1) as f64 + share.min(WHOLE), &q));
        }
    }
    let rest = scenery.field(&[shape(0.0, &modal.state.q)]);
    let mut field = scenery.field(&shapes);
    // a mode has no forces of its own
    field.forces.clear();
    for (line, rest) in field.lines.iter_mut().zip(&rest.lines) {
        displace(line, rest);
    }
    field
}

/// How far each point is from its place at rest, in parts of the farthest one of the line.
fn displace(line: &mut LineRecord, rest: &LineRecord) {
    line.quantities = vec![Quantity::new("displacement", "")];
    let Some(rest) = rest.snapshots.first() else { return };
    let mut largest = 0.0_f64;
    for snapshot in &mut line.snapshots {
        let away = snapshot
            .position
            .iter()
            .zip(&rest.position)
            .map(|(x, home)| (0..3).map(|i| (x[i] - home[i]).powi(2)).sum::<f64>().sqrt());
        let away: Vec<f64> = away.collect();
        largest = away.iter().fold(largest, |m, x| m.max(*x));
        snapshot.values = vec![away];
        snapshot.velocity.clear();
    }
    let all = line.snapshots.iter_mut().flat_map(|s| &mut s.values[0]);
    all.for_each(|x| *x /= largest.max(f64::MIN_POSITIVE));
}
