//! What is said on the terminal when a run has ended.

use super::Recorder;
use crate::run::{Happened, Summary};
use ropewalk_report::{Column, RunFolder, number, rough};
use ropewalk_scene::{Analysis, SceneFile};
use std::fmt::Write;

/// The whole report: status, work, energy, records, files.
pub(crate) fn report(
    file: &SceneFile,
    summary: &Summary,
    recorder: &Recorder<'_>,
    folder: &RunFolder,
    pictures: &[String],
    tables: &[String],
) -> String {
    let mut out = format!("{}\n", file.title());
    let mut line = |what: &str, text: String| _ = writeln!(out, "  {what:<9} {text}");
    let statics = file.scene().run.analysis == Analysis::Statics;
    let t = recorder.t();
    let at =
        if statics { format!("at load factor {}", number(t)) } else { format!("at t = {} s", number(t)) };
    match &summary.message {
        Some(message) => line(&summary.status, format!("{at}: {message}")),
        None => line(&summary.status, at),
    }
    let c = &summary.counts;
    let steps = if statics { "equilibria" } else { "steps" };
    line(
        steps,
        format!(
            "{}{}, {} Newton iterations, {} factorizations",
            c.steps,
            if c.rejected > 0 { format!(" ({} rejected)", c.rejected) } else { String::new() },
            c.newton_iterations,
            c.factorizations
        ),
    );
    let mut time = format!("{} s on the clock, {} s of CPU", rough(summary.wall_s), rough(summary.cpu_s));
    if !statics && summary.wall_s > 0.0 {
        _ = write!(time, ": {} x real time", rough(t / summary.wall_s));
    }
    line("time", time);
    if file.scene().run.audit && !statics && file.scene().processes.is_empty() {
        let e = &summary.energy;
        line(
            "energy",
            format!(
                "kinetic {} J, potential {} J; supplied {} J, dissipated {} J, imbalance {} J",
                rough(e.kinetic),
                rough(e.potential),
                rough(e.supplied + e.carried),
                rough(e.dissipated),
                rough(e.imbalance)
            ),
        );
    }
    for (k, note) in summary.notes.iter().enumerate() {
        line(if k == 0 { "notes" } else { "" }, note.clone());
    }
    for (k, c) in summary.critical.iter().enumerate() {
        let many = if c.directions > 1 { format!(" in {} directions", c.directions) } else { String::new() };
        let text = format!("load factor {}, {}{many}: {}", number(c.load_factor), c.kind, c.what);
        line(if k == 0 { "critical" } else { "" }, text);
    }
    for (k, (name, times)) in by_name(&summary.events).into_iter().enumerate() {
        let when = match times.as_slice() {
            [one] => format!("at t = {} s", number(*one)),
            [first, .., last] => {
                format!("{} times from t = {} s to {} s", times.len(), number(*first), number(*last))
            }
            [] => continue,
        };
        line(if k == 0 { "events" } else { "" }, format!("{name} {when}"));
    }
    let finals: Vec<_> =
        recorder.figures.iter().flat_map(|f| finals(&recorder.table.columns[f.columns.clone()])).collect();
    let wide = finals.iter().map(|(name, _)| name.chars().count()).max().unwrap_or(0);
    for (k, (name, values)) in finals.iter().enumerate() {
        line(if k == 0 { "final" } else { "" }, format!("{name:<wide$}  {values}"));
    }
    if let Some(profile) = &summary.profile {
        let mut entries: Vec<_> = profile.iter().collect();
        entries.sort_by(|a, b| b.seconds.total_cmp(&a.seconds));
        for (k, e) in entries.iter().enumerate() {
            let text = format!("{:5.1} %  {} s  {}", 100.0 * e.share, rough(e.seconds), e.label);
            line(if k == 0 { "profile" } else { "" }, text);
        }
    }
    line("folder", folder.path().display().to_string());
    if !tables.is_empty() {
        line("tables", tables.iter().map(|t| format!("tables/{t}.csv")).collect::<Vec<_>>().join(", "));
    }
    if !pictures.is_empty() {
        line("pictures", pictures.iter().map(|p| format!("plots/{p}.svg")).collect::<Vec<_>>().join(", "));
    }
    out
}

/// The last values of a record, under the names that its columns have in the history: those that differ only behind
/// their last point, as `hose.end.x` and `hose.end.y`, on one line, and each unit once.
fn finals(columns: &[Column]) -> Vec<(String, String)> {
    let value = |c: &Column| c.values.last().map_or("-".to_string(), |x| number(*x));
    let stem = |c: &Column| c.name.rsplit_once('.').map(|(stem, _)| stem.to_string());
    let shared = columns
        .first()
        .and_then(stem)
        .filter(|first| columns.len() > 1 && columns.iter().all(|c| stem(c).as_ref() == Some(first)));
    let Some(stem) = shared else {
        let alone = |c: &Column| (c.name.clone(), format!("{} {}", value(c), c.unit).trim_end().to_string());
        return columns.iter().map(alone).collect();
    };
    let of = |k: usize| {
        let c = &columns[k];
        let unit = if columns.get(k + 1).is_some_and(|next| next.unit == c.unit) { "" } else { &c.unit };
        format!("{} {} {unit}", &c.name[stem.len() + 1..], value(c)).trim_end().to_string()
    };
    let values: Vec<String> = (0..columns.len()).map(of).collect();
    vec![(stem, values.join(", "))]
}

/// The times of each kind of event, in the order in which they came first.
fn by_name(events: &[Happened]) -> Vec<(&str, Vec<f64>)> {
    let mut all: Vec<(&str, Vec<f64>)> = Vec::new();
    for e in events {
        match all.iter_mut().find(|(name, _)| *name == e.name) {
            Some((_, times)) => times.push(e.t),
            None => all.push((&e.name, vec![e.t])),
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_last_value_has_its_name_and_its_unit() {
        let column = |name: &str, unit: &str| Column { values: vec![2.5], ..Column::new(name, unit) };
        let reaction = [column("ship.fx", "N"), column("ship.magnitude", "N"), column("ship.mx", "N m")];
        assert_eq!(finals(&reaction), [("ship".into(), "fx 2.5, magnitude 2.5 N, mx 2.5 N m".into())]);
        assert_eq!(finals(&[column("hose.end.x", "m")]), [("hose.end.x".into(), "2.5 m".into())]);
        let apart = [column("drag.cd", ""), column("lift", "N")];
        assert_eq!(finals(&apart), [("drag.cd".into(), "2.5".into()), ("lift".into(), "2.5 N".into())]);
    }
}
