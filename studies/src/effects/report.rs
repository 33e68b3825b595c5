//! The ledger as tables, for people and as CSV, and what follows from it.

use super::{Ledger, Tried, Verdict};
use ropewalk_report::{
    Elapsed, Interrupt, OutputError, RunFolder, number, push_cell, push_number, rough, write_atomic,
};
use ropewalk_scene::SceneFile;
use std::fmt::Write as _;

/// A line of the ledger: a term, a phase of the solution, or one of the effects of a term.
struct Line {
    label: String,
    /// The effect, where the term has several.
    effect: Option<String>,
    /// Calls, time and share; of effects inside of a term they are not told apart.
    cost: Option<(u64, f64, f64)>,
    /// Work and peak force.
    deed: Option<(f64, f64)>,
}

/// The largest first, the effects of a term below it.
fn lines(ledger: &Ledger) -> Vec<Line> {
    let mut costs: Vec<_> = ledger.costs.iter().collect();
    costs.sort_by(|a, b| b.seconds.total_cmp(&a.seconds));
    let mut all = Vec::new();
    for c in costs {
        let deeds: Vec<_> = ledger.deeds.iter().filter(|d| d.term == c.label).collect();
        let (cost, label) = (Some((c.calls, c.seconds, c.share)), c.label.clone());
        match deeds.as_slice() {
            [one] if one.effect == one.term => {
                all.push(Line { label, effect: None, cost, deed: Some((one.work, one.peak)) });
            }
            several => {
                all.push(Line { label, effect: None, cost, deed: None });
                all.extend(several.iter().map(|d| Line {
                    label: d.term.clone(),
                    effect: Some(d.effect.clone()),
                    cost: None,
                    deed: Some((d.work, d.peak)),
                }));
            }
        }
    }
    all
}

/// Writes `tables/ledger.csv` and `tables/effects.csv`.
pub(super) fn write(folder: &RunFolder, ledger: &Ledger) -> Result<(), OutputError> {
    let mut out = String::from("term,effect,calls,time [s],share,work [J],peak force [N]\n");
    for l in lines(ledger) {
        push_cell(&mut out, &l.label);
        out.push(',');
        push_cell(&mut out, l.effect.as_deref().unwrap_or_default());
        let (calls, cost) = (l.cost.map(|c| c.0), l.cost.map(|c| [c.1, c.2]));
        out.push(',');
        _ = calls.map(|calls| write!(out, "{calls}"));
        for x in [cost.map(|c| c[0]), cost.map(|c| c[1]), l.deed.map(|d| d.0), l.deed.map(|d| d.1)] {
            out.push(',');
            x.into_iter().for_each(|x| push_number(&mut out, x));
        }
        out.push('\n');
    }
    write_atomic(&folder.table_file("ledger")?, &out)?;

    let mut out = String::from("way,effect,change,cpu [s],saved,steps,iterations,note\n");
    for (way, tried) in [("without", &ledger.without), ("with", &ledger.with)] {
        for t in tried {
            out += way;
            out.push(',');
            push_cell(&mut out, &t.name);
            out.push(',');
            let mut notes = vec![t.note.as_str()];
            match &t.verdict {
                Verdict::Ran { change, cpu_s, counts, note } => {
                    for x in [*change, *cpu_s, 1.0 - cpu_s / ledger.cpu_s] {
                        push_number(&mut out, x);
                        out.push(',');
                    }
                    _ = write!(out, "{},{},", counts.steps, counts.newton_iterations);
                    notes.push(note);
                }
                Verdict::Failed(why) => {
                    out += ",,,,,";
                    notes.push(why);
                }
            }
            notes.retain(|n| !n.is_empty());
            push_cell(&mut out, &notes.join("; "));
            out.push('\n');
        }
    }
    write_atomic(&folder.table_file("effects")?, &out)
}

/// Cells under their headings: the first column to the left, and what stands behind the others.
fn table(out: &mut String, head: &[&str], rows: &[(Vec<String>, String)]) {
    let wide = |c: usize| {
        let cells = rows.iter().map(|(cells, _)| cells[c].chars().count());
        cells.chain([head[c].chars().count()]).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..head.len()).map(wide).collect();
    let head: Vec<String> = head.iter().map(|h| (*h).to_string()).collect();
    for (cells, note) in [(head, String::new())].iter().chain(rows) {
        let mut line = format!("  {:<w$}", cells[0], w = widths[0]);
        for (cell, w) in cells.iter().zip(&widths).skip(1) {
            _ = write!(line, "  {cell:>w$}");
        }
        _ = writeln!(out, "{}", format!("{line}  {note}").trim_end());
    }
    out.push('\n');
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
    let mut out = format!(
        "{}\n  {}: largest value {}; changes are in parts of it\n\n",
        file.title(),
        ledger.record,
        number(ledger.scale)
    );
    let mut rows: Vec<(Vec<String>, String)> = lines(ledger)
        .iter()
        .map(|l| {
            let name = l.effect.as_ref().map_or(l.label.clone(), |e| format!("  {e}"));
            let cost = l.cost.map_or(Default::default(), |(calls, time, share)| {
                [calls.to_string(), rough(time), percent(share)]
            });
            let deed = l.deed.map_or(Default::default(), |(work, peak)| [or_none(work), or_none(peak)]);
            let cells: Vec<String> = [name].into_iter().chain(cost).chain(deed).collect();
            (cells, String::new())
        })
        .collect();
    let sum = ledger.measured_s();
    let share = ledger.costs.iter().map(|c| c.share).sum();
    let all = ["together", "", &rough(sum), &percent(share), "", ""].map(String::from);
    rows.push((all.to_vec(), format!("the run without clocks: {} s", rough(ledger.cpu_s))));
    table(&mut out, &["term", "calls", "time [s]", "share", "work [J]", "peak force [N]"], &rows);

    let tried = |out: &mut String, head: &str, all: &[Tried], saves: bool| {
        if all.is_empty() {
            return;
        }
        let mut rows: Vec<_> = all.iter().map(|t| row(t, ledger, saves)).collect();
        if saves {
            let c = &ledger.counts;
            let cells = ["nothing", "", "", &c.steps.to_string(), &c.newton_iterations.to_string()];
            rows.insert(0, (cells.map(String::from).to_vec(), String::new()));
        }
        table(out, &[head, "change", if saves { "saves" } else { "costs" }, "steps", "iterations"], &rows);
    };
    tried(&mut out, "without", &ledger.without, true);
    tried(&mut out, "with", &ledger.with, false);
    if !ledger.hints.is_empty() {
        out += "  to try what can't be guessed from the scene, write\n";
        for (name, text) in &ledger.hints {
            _ = writeln!(out, "    {name}: {text}");
        }
        out.push('\n');
    }
    advise(&mut out, ledger, accuracy);
    let files = pictures.iter().map(|p| format!(", plots/{p}.svg")).collect::<String>();
    _ = writeln!(
        out,
        "{}: tables/ledger.csv, tables/effects.csv{files} ({} s of CPU time)",
        folder.path().display(),
        rough(elapsed.cpu_s)
    );
    out
}

fn row(t: &Tried, ledger: &Ledger, saves: bool) -> (Vec<String>, String) {
    match &t.verdict {
        Verdict::Ran { change, cpu_s, counts, note } => {
            let cells = vec![
                t.name.clone(),
                rough(*change),
                time(*cpu_s, ledger, saves),
                counts.steps.to_string(),
                counts.newton_iterations.to_string(),
            ];
            let both: Vec<&str> = [t.note.as_str(), note].into_iter().filter(|n| !n.is_empty()).collect();
            (cells, both.join("; "))
        }
        Verdict::Failed(why) => {
            let none = || "-".to_string();
            (vec![t.name.clone(), none(), none(), none(), none()], why.clone())
        }
    }
}

/// What can be left out, what is missing, and how far that can be believed.
fn advise(out: &mut String, ledger: &Ledger, accuracy: f64) {
    let at = format!("  at an accuracy of {}:", rough(accuracy));
    if ledger.interrupted {
        _ = writeln!(out, "  stopped by {} before all effects were tried\n", Interrupt::cause());
        return;
    }
    match &ledger.advice {
        None => _ = writeln!(out, "{at} nothing can be left out"),
        Some(a) => {
            let names = a.names.join(", ");
            if let Verdict::Ran { change, cpu_s, .. } = &a.verdict {
                let together = if a.names.len() > 1 { " together" } else { "" };
                let saved = 1.0 - cpu_s / ledger.cpu_s;
                let time = match saved {
                    x if x >= 0.005 => format!("and saves {} of the time", percent(x)),
                    _ => "and saves no time".into(),
                };
                let change = rough(*change);
                _ = writeln!(
                    out,
                    "{at} {names} can be left out; that{together} changes the record by {change} {time}"
                );
            }
        }
    }
    let large = |t: &&Tried| t.verdict.change().is_some_and(|change| !(change <= accuracy));
    let missing: Vec<String> = ledger
        .with
        .iter()
        .filter(large)
        .map(|t| format!("{} ({})", t.name, t.verdict.change().map_or(String::new(), rough)))
        .collect();
    if !missing.is_empty() {
        _ = writeln!(out, "{at} what the scene lacks but would matter is {}", missing.join(", "));
    }
    if let Some(own) = ledger.own_error {
        let note = if own > 0.3 * accuracy { ": the steps are too coarse for this accuracy" } else { "" };
        _ = writeln!(
            out,
            "  finer time steps alone change the record by {}; smaller changes can't be told from that{note}",
            rough(own)
        );
    }
    if ledger.noise > 0.03 {
        let noise = percent(ledger.noise);
        _ = writeln!(
            out,
            "  the same run took {noise} longer or shorter at the end: smaller savings can't be told here"
        );
    }
    out.push('\n');
}
