//! What is said on the terminal when a run has ended.

use super::Recorder;
use crate::output::{Happened, RunFolder, Summary, number, rough};
use crate::read::SceneFile;
use ropewalk_core::Analysis;
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
    let wide = recorder.figures.iter().map(|f| f.name.chars().count()).max().unwrap_or(0);
    for (k, f) in recorder.figures.iter().enumerate() {
        let columns = &recorder.table.columns[f.columns.clone()];
        let values: Vec<String> =
            columns.iter().filter_map(|c| c.values.last()).map(|x| number(*x)).collect();
        let unit = columns.first().map_or("", |c| c.unit.as_str());
        line(if k == 0 { "final" } else { "" }, format!("{:<wide$}  {} {unit}", f.name, values.join(", ")));
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
