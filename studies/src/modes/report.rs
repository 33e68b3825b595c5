//! The modes as a table, for people and as CSV.

use super::Modal;
use ropewalk_core::modes::{Critical, Mode};
use ropewalk_core::{Model, NodeId};
use ropewalk_report::{Column, Elapsed, RunFolder, Sheet, Table, number};
use ropewalk_scene::{Analysis, SceneFile};
use std::fmt::Write as _;

const DIRECTIONS: [&str; 4] = ["x", "y", "z", "turning"];

/// Number, frequency, damping and shares of each mode.
pub(super) fn table(modal: &Modal) -> Table {
    let mut columns = vec![
        Column::new("mode", ""),
        Column::new("frequency", "Hz"),
        Column::new("angular frequency", "rad/s"),
        Column::new("damping ratio", ""),
        Column::new("growth", "1/s"),
        Column::new("rigid", ""),
    ];
    columns.extend(DIRECTIONS.iter().map(|d| Column::new(format!("share.{d}"), "")));
    let parts = modal.model.parts();
    columns.extend(parts.iter().map(|p| Column::new(format!("share.{}", p.name()), "")));
    let mut table = Table { columns };
    for (k, m) in modal.modes.iter().enumerate() {
        let mut row = vec![(k + 1) as f64, m.frequency(), m.omega, m.damping_ratio(), m.growth];
        row.push(f64::from(u8::from(m.rigid)));
        row.extend(m.directions);
        row.extend((0..parts.len()).map(|p| part_share(&modal.model, p, m)));
        for (column, value) in table.columns.iter_mut().zip(row) {
            column.values.push(value);
        }
    }
    table
}

/// Share of a part in the kinetic energy; nodes that parts share count for each of them.
fn part_share(model: &Model, part: usize, m: &Mode) -> f64 {
    let part = &model.parts()[part];
    let on = |k: usize| part.place_of(NodeId(k as u32)).is_some();
    (0..m.shares.len()).filter(|&k| on(k)).map(|k| m.shares[k]).sum()
}

/// Where a mode moves: the part with the largest share, the place that goes farthest, the direction.
pub(super) fn where_it_moves(model: &Model, m: &Mode) -> String {
    let best =
        (0..model.parts().len()).map(|p| (p, part_share(model, p, m))).max_by(|a, b| a.1.total_cmp(&b.1));
    let Some((p, share)) = best else { return String::new() };
    let part = &model.parts()[p];
    let way = |k: usize| {
        let n = &model.nodes()[k];
        let own = if n.kind.has_position() { n.v..n.v + 3 } else { n.v..n.v };
        own.map(|i| m.shape[i].powi(2) + m.quadrature[i].powi(2)).sum::<f64>()
    };
    let on = (0..model.nodes().len()).filter_map(|k| Some((k, part.place_of(NodeId(k as u32))?)));
    let farthest = on.max_by(|a, b| way(a.0).total_cmp(&way(b.0)));
    let place = farthest.map_or(String::new(), |(_, place)| place);
    let mut text = match place.as_str() {
        "" => part.name().to_string(),
        place => format!("{} {place}", part.name()),
    };
    if share < 0.995 && model.parts().len() > 1 {
        let _ = write!(text, " ({:.0} %)", 100.0 * share);
    }
    let mut ways: Vec<(usize, f64)> = m.directions.iter().copied().enumerate().collect();
    ways.sort_by(|a, b| b.1.total_cmp(&a.1));
    let shown: Vec<String> = ways.iter().filter(|w| w.1 > 0.1).map(|w| DIRECTIONS[w.0].to_string()).collect();
    let _ = write!(text, ", {}", shown.join(" "));
    text
}

/// What kind of motion it is, in a few words; nothing for a plain vibration.
pub(super) fn kind(m: &Mode) -> &'static str {
    match () {
        () if m.rigid => "rigid",
        () if m.is_unstable() && m.omega == 0.0 => "unstable",
        () if m.is_unstable() => "unstable, oscillating",
        () if m.omega == 0.0 => "creeping",
        () => "",
    }
}

/// The table for a terminal, and where the rest is.
pub(super) fn report(
    file: &SceneFile,
    modal: &Modal,
    folder: &RunFolder,
    pictures: usize,
    elapsed: Elapsed,
) -> String {
    let mut sheet = Sheet::new(file.title());
    let about = match &modal.search {
        None => "in balance as laid".to_string(),
        Some(found) => format!("equilibrium after {} iterations", found.iterations),
    };
    let when = match file.scene().run.analysis {
        Analysis::Dynamics => format!("t = {} s", number(modal.state.t)),
        Analysis::Statics => format!("load factor {}", number(modal.state.t)),
    };
    sheet.line(format!("{about}, {when}\n"));
    let (row, head): (Row, _) = match modal.unstable {
        false => (vibrating, ["", "Hz", "rad/s", "damping", "moves", ""]),
        true => (growing, ["", "growth 1/s", "e-fold s", "oscillates Hz", "moves", ""]),
    };
    let rows = modal.modes.iter().enumerate().map(|(k, m)| row(&modal.model, k, m).to_vec());
    sheet.table(&head, &rows.collect::<Vec<_>>());
    if let Some(critical) = &modal.critical {
        sheet.line(format!("\n{}", buckling(&modal.model, critical)));
    }
    let (path, cpu) = (folder.path().display(), elapsed.cpu_s);
    sheet.line(format!("\n{path}: tables/modes.csv, {pictures} pictures in plots/ ({cpu:.2} s of CPU time)"));
    sheet.to_string()
}

/// Makes the row of a mode.
type Row = fn(&Model, usize, &Mode) -> [String; 6];

/// The row of a mode of vibration.
fn vibrating(model: &Model, k: usize, m: &Mode) -> [String; 6] {
    // a ratio that rounds to nothing has no sign
    let four = (1e4 * m.damping_ratio()).round() / 1e4 + 0.0;
    let ratio = if m.rigid { String::new() } else { format!("{four:.4}") };
    [
        (k + 1).to_string(),
        Short(m.frequency()).to_string(),
        Short(m.omega).to_string(),
        ratio,
        where_it_moves(model, m),
        kind(m).to_string(),
    ]
}

/// The row of a mode of an unstable equilibrium, of which its growth counts.
fn growing(model: &Model, k: usize, m: &Mode) -> [String; 6] {
    let swings = if m.omega > 0.0 { Short(m.frequency()).to_string() } else { String::new() };
    [
        (k + 1).to_string(),
        Short(m.growth).to_string(),
        Short(1.0 / m.growth).to_string(),
        swings,
        where_it_moves(model, m),
        kind(m).to_string(),
    ]
}

/// The critical factor in a sentence.
fn buckling(model: &Model, critical: &Critical) -> String {
    let loads = critical.loads.join(", ");
    let loads = format!("all loads together ({loads})");
    match (&critical.factor, &critical.shape, critical.safe) {
        (Some(factor), Some(shape), followed) => format!(
            "Critical factor of {loads}: {}{}; moves {}",
            Short(*factor),
            if followed.is_some() { "" } else { ", by linear buckling" },
            where_it_moves(model, shape)
        ),
        (.., Some(safe)) if safe >= 1.0 => {
            let stuck = if safe < Critical::MOST { ", as far as its path could be followed" } else { "" };
            format!("No critical factor of {loads}: nothing gives way up to {}{stuck}", Short(safe))
        }
        (.., Some(safe)) => {
            format!("No critical factor of {loads}: it falls over at {} of them as well", Short(safe))
        }
        _ => format!(
            "Linear buckling finds no critical factor of {loads}; a path of equilibria under loads that grow, \
             `analysis = \"statics\"`, tells for sure"
        ),
    }
}

/// A number with six digits that count.
struct Short(f64);

impl std::fmt::Display for Short {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let x = self.0;
        let digits = if x == 0.0 { 0 } else { (5.0 - x.abs().log10().floor()).clamp(0.0, 9.0) as usize };
        if x != 0.0 && !(1e-4..1e7).contains(&x.abs()) {
            write!(f, "{x:.5e}")
        } else {
            write!(f, "{x:.digits$}")
        }
    }
}
