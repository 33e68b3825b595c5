//! The page of a run, `report.html`: what its folder says, put together for the browser.

use super::recorder::Figure;
use super::report::{by_name, critical, finals};
use super::summary::{ProfileEntry, Status, Summary};
use ropewalk_core::integrator::Options;
use ropewalk_report::{Entry, Event, FieldRecord, Page, Panel, Section, Steps, Table, number, rough};
use ropewalk_scene::{Analysis, SceneFile};
use serde_json::Value;

/// The page of a run that ended as the summary says.
pub(crate) fn page(
    file: &SceneFile,
    summary: &Summary,
    history: Table,
    figures: &[Figure],
    field: FieldRecord,
    steps: Option<Steps>,
) -> Page {
    let panel = |figure: &Figure| Panel {
        title: figure.title.clone(),
        columns: history.columns[figure.columns.clone()].iter().map(|c| c.name.clone()).collect(),
    };
    let panels = figures.iter().map(panel).collect();
    let failed = summary.status.is_failure().then(|| summary.message.clone()).flatten();
    let notes = summary.notes.iter().cloned().chain(trust(summary));
    Page {
        title: file.title().to_string(),
        subtitle: format!("{} · Ropewalk {}", file.name(), env!("CARGO_PKG_VERSION")),
        status: summary.status.to_string(),
        scene: file.document().to_toml(),
        summary: entries(file, summary, &history),
        sections: vec![last_values(&history, figures), profile(summary)],
        warnings: failed.into_iter().chain(summary.warnings.iter().cloned()).collect(),
        notes: notes.collect(),
        events: events(summary),
        settings: settings(file),
        energy: energy(file, summary),
        history,
        panels,
        steps,
        field,
        ..Page::default()
    }
}

/// The last values of all records.
fn last_values(history: &Table, figures: &[Figure]) -> Section {
    let finals = figures.iter().flat_map(|f| finals(&history.columns[f.columns.clone()]));
    let entries = finals.map(|(name, value)| Entry::new(name, value)).collect();
    Section { title: "Last values".into(), entries }
}

/// Where the time went, if that was measured.
fn profile(summary: &Summary) -> Section {
    let mut profile: Vec<_> = summary.profile.iter().flatten().collect();
    profile.sort_by(|a, b| b.seconds.total_cmp(&a.seconds));
    let value = |e: &ProfileEntry| format!("{:.1} %, {} s", 100.0 * e.share, rough(e.seconds));
    let entries = profile.into_iter().map(|e| Entry::new(&e.label, value(e))).collect();
    Section { title: "Profile".into(), entries }
}

/// How the run ended, and how much work it was.
fn entries(file: &SceneFile, summary: &Summary, history: &Table) -> Vec<Entry> {
    let statics = file.scene().run.analysis == Analysis::Statics;
    let c = &summary.counts;
    let t = history.columns.first().and_then(|c| c.values.last()).copied();
    let mut all = Vec::new();
    let mut add = |name: &str, value: String| all.push(Entry::new(name, value));
    if let Some(t) = t {
        let at = if statics { format!("load factor {}", number(t)) } else { format!("t = {} s", number(t)) };
        let why = summary.message.as_deref().filter(|_| !summary.status.is_failure());
        add("ended", format!("at {at}{}", why.map_or(String::new(), |why| format!(", {why}"))));
    }
    let rejected = if c.rejected > 0 { format!(" ({} rejected)", c.rejected) } else { String::new() };
    add(if statics { "equilibria" } else { "steps" }, format!("{}{rejected}", c.steps));
    if let Some(limits) = summary.limits_told() {
        add("limited by", limits);
    }
    add("Newton iterations", c.newton_iterations.to_string());
    add("factorizations", c.factorizations.to_string());
    add("wall time", format!("{} s", rough(summary.wall_s)));
    add("CPU time", format!("{} s", rough(summary.cpu_s)));
    if let Some(t) = t.filter(|_| !statics && summary.wall_s > 0.0) {
        add("speed", format!("{} × real time", rough(t / summary.wall_s)));
    }
    for load in &summary.critical {
        add("critical", critical(load));
    }
    all
}

/// Of events of one name more than these are told by the first and the last.
const MOST_ALIKE: usize = 12;

/// What happened: events, and critical loads of a load path.
fn events(summary: &Summary) -> Vec<Event> {
    let happened = by_name(&summary.events).into_iter().flat_map(|(name, times)| {
        let event = |t: f64, which: &str| Event { t, text: format!("{name}{which}") };
        match times.as_slice() {
            [first, .., last] if times.len() > MOST_ALIKE => {
                vec![
                    event(*first, &format!(", the first of {}", times.len())),
                    event(*last, ", the last of them"),
                ]
            }
            all => all.iter().map(|t| event(*t, "")).collect(),
        }
    });
    let loads =
        summary.critical.iter().map(|c| Event { t: c.load_factor, text: format!("{}: {}", c.kind, c.what) });
    let mut all: Vec<Event> = happened.chain(loads).collect();
    all.sort_by(|a, b| a.t.total_cmp(&b.t));
    all
}

/// Analysis and solver, as the scene has them.
fn settings(file: &SceneFile) -> Vec<Entry> {
    let scene = file.scene();
    let run = &scene.run;
    let mut all = Vec::new();
    if run.analysis == Analysis::Statics {
        all.push(Entry::new("analysis", "statics"));
        all.push(Entry::new("load factor", format!("0 to {}", number(run.duration))));
        all.push(Entry::new("steps of the load", scene.statics.steps.to_string()));
        return all;
    }
    all.push(Entry::new("duration", format!("{} s", number(run.duration))));
    all.push(Entry::new("output", format!("every {} s", number(run.interval()))));
    if let Some(process) = scene.processes.first() {
        all.push(Entry::new("method", process.typetag_name().replace('_', " ")));
        return all;
    }
    let options = |options: &Options| serde_json::to_value(options).unwrap_or_default();
    let (solver, usual) = (options(&scene.solver), options(&Options::default()));
    // what is as usual isn't worth a line, but for scheme and steps
    let told = |name: &str, value: &Value| {
        matches!(name, "scheme" | "stepping") || (!value.is_null() && usual.get(name) != Some(value))
    };
    for (name, value) in solver.as_object().into_iter().flatten().filter(|(name, value)| told(name, value)) {
        all.push(Entry::new(name.replace('_', " "), words(value)));
    }
    all
}

/// A setting as people would say it.
fn words(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        Value::Bool(is) => if *is { "yes" } else { "no" }.into(),
        Value::Number(x) => x.as_f64().map_or_else(|| x.to_string(), number),
        Value::Object(map) => {
            map.iter().map(|(name, value)| format!("{name} {}", words(value))).collect::<Vec<_>>().join(", ")
        }
        Value::Array(all) => all.iter().map(words).collect::<Vec<_>>().join(", "),
        Value::Null => "-".into(),
    }
}

/// The balance of energy, where there is one.
fn energy(file: &SceneFile, summary: &Summary) -> Vec<Entry> {
    let scene = file.scene();
    if !scene.run.audit || scene.run.analysis == Analysis::Statics || !scene.processes.is_empty() {
        return Vec::new();
    }
    let e = &summary.energy;
    let mut all = vec![("at the start", e.initial), ("kinetic", e.kinetic), ("potential", e.potential)];
    all.push(("supplied", e.supplied));
    if e.carried != 0.0 {
        all.push(("carried in by material", e.carried));
    }
    all.extend([("dissipated", e.dissipated), ("imbalance", e.imbalance)]);
    all.into_iter().map(|(name, joules)| Entry::new(name, format!("{} J", rough(joules)))).collect()
}

/// What the certificate says, line by line.
fn trust(summary: &Summary) -> Vec<String> {
    lines(&summary.certificate.as_ref().map(|c| c.text()).unwrap_or_default())
}

/// The lines of a report, without its indentation.
pub(super) fn lines(text: &str) -> Vec<String> {
    text.lines().map(|line| line.trim().to_string()).filter(|line| !line.is_empty()).collect()
}

/// What one should know of a page that was made of what a folder has, without some of it.
pub(crate) fn without(page: &mut Page, missing: &[&str]) {
    if missing.is_empty() {
        return;
    }
    let text = format!("this page was made anew, without what isn't in the folder: {}", missing.join(", "));
    page.warnings.push(text);
    if page.status == Status::Failed.to_string() && missing.contains(&"summary.json") {
        page.status = "unfinished".into();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn settings_are_said_in_words() {
        assert_eq!(words(&json!({"controlled": {"tolerance": 1e-4}})), "controlled tolerance 0.0001");
        assert_eq!(words(&json!(["a", true, 2, null])), "a, yes, 2, -");
    }
}
