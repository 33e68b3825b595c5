//! What is said on the terminal when a run has ended.

use super::recorder::{Figure, Recorder};
use super::summary::{CriticalLoad, Happened, ProfileEntry, Summary};
use ropewalk_report::{Column, RunFolder, Sheet, number, rough};
use ropewalk_scene::{Analysis, SceneFile};

/// Names of the files that a run left.
pub(crate) struct Files<'a> {
    pub pictures: &'a [String],
    pub tables: &'a [String],
    pub pages: &'a [&'a str],
}

/// The whole report: status, work, energy, records, files.
pub(crate) fn report(
    file: &SceneFile,
    summary: &Summary,
    recorder: &Recorder<'_>,
    folder: &RunFolder,
    files: Files<'_>,
) -> String {
    let Files { pictures, tables, pages } = files;
    let mut sheet = Sheet::new(file.title());
    let scene = file.scene();
    let statics = scene.run.analysis == Analysis::Statics;
    let t = recorder.t();
    let at = if statics { format!("load factor {}", number(t)) } else { format!("t = {} s", number(t)) };
    let why = summary.message.as_ref().map_or(String::new(), |message| format!(": {message}"));
    sheet.entry(&summary.status.to_string(), format!("at {at}{why}"));
    work(&mut sheet, summary, (!statics).then_some(t));
    if scene.run.audit && !statics && scene.processes.is_empty() {
        let e = &summary.energy;
        let [kinetic, potential, supplied, dissipated, imbalance] =
            [e.kinetic, e.potential, e.supplied + e.carried, e.dissipated, e.imbalance].map(rough);
        sheet.entry(
            "energy",
            format!(
                "kinetic {kinetic} J, potential {potential} J; supplied {supplied} J, dissipated {dissipated} J, \
                 imbalance {imbalance} J"
            ),
        );
    }
    sheet.entries("notes", &summary.notes);
    sheet.entries("critical", summary.critical.iter().map(critical));
    sheet.entries("events", by_name(&summary.events).iter().map(|(name, times)| event(name, times)));
    let columns = |f: &Figure| finals(&recorder.table.columns[f.columns.clone()]);
    let finals: Vec<_> = recorder.figures.iter().flat_map(columns).collect();
    let wide = finals.iter().map(|(name, _)| name.chars().count()).max().unwrap_or(0);
    sheet.entries("final", finals.iter().map(|(name, values)| format!("{name:<wide$}  {values}")));
    let mut profile: Vec<_> = summary.profile.iter().flatten().collect();
    profile.sort_by(|a, b| b.seconds.total_cmp(&a.seconds));
    let time = |e: &&ProfileEntry| format!("{:5.1} %  {} s  {}", 100.0 * e.share, rough(e.seconds), e.label);
    sheet.entries("profile", profile.iter().map(time));
    sheet.entry("folder", folder.path().display());
    let list = |names: &[String], folder: &str, ending: &str| {
        names.iter().map(|name| format!("{folder}/{name}.{ending}")).collect::<Vec<_>>().join(", ")
    };
    sheet.entries("tables", (!tables.is_empty()).then(|| list(tables, "tables", "csv")));
    sheet.entries("pictures", (!pictures.is_empty()).then(|| list(pictures, "plots", "svg")));
    sheet.entries("page", (!pages.is_empty()).then(|| pages.join(", ")));
    sheet.to_string()
}

/// Steps and time; of a run in time, up to `t`, also how fast it was.
fn work(sheet: &mut Sheet, summary: &Summary, t: Option<f64>) {
    let c = &summary.counts;
    let rejected = if c.rejected > 0 { format!(" ({} rejected)", c.rejected) } else { String::new() };
    let (steps, iterations, factorizations) = (c.steps, c.newton_iterations, c.factorizations);
    sheet.entry(
        if t.is_some() { "steps" } else { "equilibria" },
        format!("{steps}{rejected}, {iterations} Newton iterations, {factorizations} factorizations"),
    );
    let speed =
        t.filter(|_| summary.wall_s > 0.0).map(|t| format!(": {} x real time", rough(t / summary.wall_s)));
    let (wall, cpu) = (rough(summary.wall_s), rough(summary.cpu_s));
    sheet.entry("time", format!("wall time {wall} s, CPU time {cpu} s{}", speed.unwrap_or_default()));
}

pub(super) fn critical(c: &CriticalLoad) -> String {
    let many = if c.directions > 1 { format!(" in {} directions", c.directions) } else { String::new() };
    format!("load factor {}, {}{many}: {}", number(c.load_factor), c.kind, c.what)
}

fn event(name: &str, times: &[f64]) -> String {
    match times {
        [first, .., last] => {
            format!("{name} {} times from t = {} s to {} s", times.len(), number(*first), number(*last))
        }
        _ => format!("{name} at t = {} s", times.first().map_or("-".into(), |t| number(*t))),
    }
}

/// A part of other numbers that rounding makes.
const ROUNDING: f64 = 1e-15;

/// The last values of a record, under the names that its columns have in the history: those that differ only behind
/// their last point, as `hose.end.x` and `hose.end.y`, on one line, and each unit once.
pub(super) fn finals(columns: &[Column]) -> Vec<(String, String)> {
    // beside others of its unit, what is nothing but their rounding is nought
    let largest = |unit: &str| {
        let last = columns.iter().filter(|c| c.unit == unit).filter_map(|c| c.values.last());
        last.fold(0.0, |m: f64, x| m.max(x.abs()))
    };
    let shown = |c: &Column, x: f64| if x.abs() <= ROUNDING * largest(&c.unit) { 0.0 } else { x };
    let value = |c: &Column| c.values.last().map_or("-".to_string(), |x| number(shown(c, *x)));
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
pub(super) fn by_name(events: &[Happened]) -> Vec<(&str, Vec<f64>)> {
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
        let beside = |x: f64| Column { values: vec![x], ..Column::new("end.z", "m") };
        assert_eq!(finals(&[column("end.x", "m"), beside(-2e-16)]), [("end".into(), "x 2.5, z 0 m".into())]);
        assert_eq!(
            finals(&[column("end.x", "m"), beside(2e-13)]),
            [("end".into(), "x 2.5, z 2e-13 m".into())]
        );
        let apart = [column("drag.cd", ""), column("lift", "N")];
        assert_eq!(finals(&apart), [("drag.cd".into(), "2.5".into()), ("lift".into(), "2.5 N".into())]);
    }
}
