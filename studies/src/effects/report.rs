//! The ledger as tables, for people and as CSV, and what follows from it.

use super::ledger::{Advice, EffectTrial, Ledger, Verdict};
use ropewalk_report::{Csv, Elapsed, Interrupt, OutputError, RunFolder, Sheet, number, rough, write_atomic};
use ropewalk_scene::SceneFile;

/// A line of the ledger: a term, a phase of the solution, or one of the effects of a term.
struct Line {
    label: String,
    /// The effect, where the term has several.
    effect: Option<String>,
    /// Calls, time and share; of effects inside of a term they are not told apart.
    cost: Option<(u64, f64, f64)>,
    /// Work and peak force.
    work: Option<(f64, f64)>,
}

/// The largest first, the effects of a term below it.
fn lines(ledger: &Ledger) -> Vec<Line> {
    let mut costs: Vec<_> = ledger.costs.iter().collect();
    costs.sort_by(|a, b| b.seconds.total_cmp(&a.seconds));
    let mut all = Vec::new();
    for c in costs {
        let effects: Vec<_> = ledger.work.iter().filter(|d| d.term == c.label).collect();
        let (cost, label) = (Some((c.calls, c.seconds, c.share)), c.label.clone());
        match effects.as_slice() {
            [one] if one.effect == one.term => {
                all.push(Line { label, effect: None, cost, work: Some((one.work, one.peak)) });
            }
            several => {
                all.push(Line { label, effect: None, cost, work: None });
                all.extend(several.iter().map(|d| Line {
                    label: d.term.clone(),
                    effect: Some(d.effect.clone()),
                    cost: None,
                    work: Some((d.work, d.peak)),
                }));
            }
        }
    }
    all
}

/// Writes `tables/ledger.csv` and `tables/effects.csv`.
pub(super) fn write(folder: &RunFolder, ledger: &Ledger) -> Result<(), OutputError> {
    let mut csv = Csv::new(["term", "effect", "calls", "time [s]", "share", "work [J]", "peak force [N]"]);
    for l in lines(ledger) {
        csv.cell(&l.label).cell(l.effect.as_deref().unwrap_or_default());
        csv.cell(l.cost.map_or(String::new(), |c| c.0.to_string()));
        for x in [l.cost.map(|c| c.1), l.cost.map(|c| c.2), l.work.map(|w| w.0), l.work.map(|w| w.1)] {
            csv.number_or_none(x);
        }
        csv.end();
    }
    write_atomic(&folder.table_file("ledger")?, &csv.text())?;

    let mut csv = Csv::new(["way", "effect", "change", "cpu [s]", "saved", "steps", "iterations", "note"]);
    let trials = [("without", &ledger.without), ("with", &ledger.with)];
    for (way, t) in trials.iter().flat_map(|(way, all)| all.iter().map(move |t| (way, t))) {
        csv.cell(way).cell(&t.name);
        let note = match &t.verdict {
            Verdict::Ran { change, cpu_s, counts, note } => {
                csv.number(*change).number(*cpu_s).number(1.0 - cpu_s / ledger.cpu_s);
                csv.cell(counts.steps.to_string()).cell(counts.newton_iterations.to_string());
                note
            }
            Verdict::Failed(why) => {
                (0..5).for_each(|_| _ = csv.cell(""));
                why
            }
        };
        csv.cell(both(&t.note, note)).end();
    }
    write_atomic(&folder.table_file("effects")?, &csv.text())
}

/// Two notes, of which either may be empty.
fn both(one: &str, other: &str) -> String {
    [one, other].into_iter().filter(|n| !n.is_empty()).collect::<Vec<_>>().join("; ")
}

fn percent(x: f64) -> String {
    format!("{:.1} %", 100.0 * x)
}

/// What a run saves or costs of the time of the scene itself; of much longer ones how many times that.
fn time(cpu_s: f64, ledger: &Ledger, saves: bool) -> String {
    let ratio = cpu_s / ledger.cpu_s;
    match (ratio > 2.0, saves) {
        (true, _) => format!("{} times as long", rough(ratio)),
        (false, true) => percent(1.0 - ratio),
        (false, false) => percent(ratio - 1.0),
    }
}

/// A number in three digits, or that there is none.
fn or_none(x: f64) -> String {
    if x.is_nan() { "-".into() } else { rough(x) }
}

/// The whole report.
pub(super) fn report(
    file: &SceneFile,
    ledger: &Ledger,
    accuracy: f64,
    folder: &RunFolder,
    pictures: &[String],
    elapsed: Elapsed,
) -> String {
    let mut sheet = Sheet::new(file.title());
    let (record, scale) = (&ledger.record, number(ledger.scale));
    sheet.line(format!("  {record}: largest value {scale}; changes are in parts of it\n"));
    costs(&mut sheet, ledger);
    let c = &ledger.counts;
    let nothing = ["nothing", "", "", &c.steps.to_string(), &c.newton_iterations.to_string(), ""];
    if !ledger.without.is_empty() {
        let rows = ledger.without.iter().map(|t| row(t, ledger, true));
        let rows: Vec<Vec<String>> =
            std::iter::once(nothing.map(String::from).to_vec()).chain(rows).collect();
        sheet.table(&["without", "change", "saves", "steps", "iterations", ""], &rows);
        sheet.line("");
    }
    if !ledger.with.is_empty() {
        let rows: Vec<Vec<String>> = ledger.with.iter().map(|t| row(t, ledger, false)).collect();
        sheet.table(&["with", "change", "costs", "steps", "iterations", ""], &rows);
        sheet.line("");
    }
    if !ledger.hints.is_empty() {
        sheet.line("  to try what can't be guessed from the scene, write");
        ledger.hints.iter().for_each(|(name, text)| sheet.line(format!("    {name}: {text}")));
        sheet.line("");
    }
    advise(&mut sheet, ledger, accuracy);
    let files = pictures.iter().map(|p| format!(", plots/{p}.svg")).collect::<String>();
    let (path, cpu) = (folder.path().display(), rough(elapsed.cpu_s));
    sheet.line(format!("{path}: tables/ledger.csv, tables/effects.csv{files} ({cpu} s of CPU time)"));
    sheet.to_string()
}

/// Where the time goes, and the work of the effects.
fn costs(sheet: &mut Sheet, ledger: &Ledger) {
    let row = |l: &Line| {
        let name = l.effect.as_ref().map_or(l.label.clone(), |e| format!("  {e}"));
        let cost = l.cost.map_or(Default::default(), |(calls, time, share)| {
            [calls.to_string(), rough(time), percent(share)]
        });
        let work = l.work.map_or(Default::default(), |(work, peak)| [or_none(work), or_none(peak)]);
        [name].into_iter().chain(cost).chain(work).chain([String::new()]).collect()
    };
    let mut rows: Vec<Vec<String>> = lines(ledger).iter().map(row).collect();
    let share = percent(ledger.costs.iter().map(|c| c.share).sum());
    let without_clocks = format!("the run without clocks: {} s", rough(ledger.cpu_s));
    let sum = ["together", "", &rough(ledger.measured_s()), &share, "", "", &without_clocks];
    rows.push(sum.map(String::from).to_vec());
    sheet.table(&["term", "calls", "time [s]", "share", "work [J]", "peak force [N]", ""], &rows);
    sheet.line("");
}

fn row(t: &EffectTrial, ledger: &Ledger, saves: bool) -> Vec<String> {
    match &t.verdict {
        Verdict::Ran { change, cpu_s, counts, note } => vec![
            t.name.clone(),
            rough(*change),
            time(*cpu_s, ledger, saves),
            counts.steps.to_string(),
            counts.newton_iterations.to_string(),
            both(&t.note, note),
        ],
        Verdict::Failed(why) => [t.name.as_str(), "-", "-", "-", "-", why].map(String::from).to_vec(),
    }
}

/// What can be left out, what is missing, and how far that can be believed.
fn advise(sheet: &mut Sheet, ledger: &Ledger, accuracy: f64) {
    if ledger.interrupted {
        sheet.line(format!("  stopped by {} before all effects were tried\n", Interrupt::cause()));
        return;
    }
    let at = format!("  at an accuracy of {}:", rough(accuracy));
    match &ledger.advice {
        Some(Advice { names, verdict: Verdict::Ran { change, cpu_s, .. } }) => {
            let together = if names.len() > 1 { " together" } else { "" };
            let time = match 1.0 - cpu_s / ledger.cpu_s {
                x if x >= 0.005 => format!("and saves {} of the time", percent(x)),
                _ => "and saves no time".into(),
            };
            let (names, change) = (names.join(", "), rough(*change));
            sheet.line(format!(
                "{at} {names} can be left out; that{together} changes the record by {change} {time}"
            ));
        }
        _ => sheet.line(format!("{at} nothing can be left out")),
    }
    let large = |t: &&EffectTrial| t.verdict.change().is_some_and(|change| !(change <= accuracy));
    let missing = ledger.with.iter().filter(large);
    let missing: Vec<String> = missing
        .map(|t| format!("{} ({})", t.name, t.verdict.change().map_or(String::new(), rough)))
        .collect();
    if !missing.is_empty() {
        sheet.line(format!("{at} what the scene lacks but would matter is {}", missing.join(", ")));
    }
    if let Some(own) = ledger.own_error {
        let note = if own > 0.3 * accuracy { ": the steps are too coarse for this accuracy" } else { "" };
        let own = rough(own);
        sheet.line(format!(
            "  finer time steps alone change the record by {own}; smaller changes can't be told from that{note}"
        ));
    }
    if ledger.noise > 0.03 {
        let noise = percent(ledger.noise);
        sheet.line(format!(
            "  the same run took {noise} longer or shorter at the end: smaller savings can't be told here"
        ));
    }
    sheet.line("");
}
