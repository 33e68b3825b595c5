//! What is said on the terminal when a run has ended.

use super::Recorder;
use crate::output::{RunFolder, Summary};
use crate::read::SceneFile;
use ropewalk_core::Analysis;
use std::fmt::Write;

/// A number in six significant digits, without trailing zeros.
fn number(x: f64) -> String {
    let size = x.abs();
    if x == 0.0 || !x.is_finite() {
        return format!("{}", x + 0.0);
    }
    if !(1e-4..1e7).contains(&size) {
        let text = format!("{x:.4e}");
        let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
        return format!("{}e{exponent}", mantissa.trim_end_matches('0').trim_end_matches('.'));
    }
    let decimals = (5.0 - size.log10().floor()).clamp(0.0, 9.0) as usize;
    let text = format!("{x:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_string() } else { text }
}

/// A number in three digits, for what is known no better.
fn rough(x: f64) -> String {
    if (0.01..1e5).contains(&x.abs()) {
        let decimals = (2.0 - x.abs().log10().floor()).clamp(0.0, 4.0) as usize;
        format!("{x:.decimals$}")
    } else if x == 0.0 {
        "0".into()
    } else {
        format!("{x:.1e}")
    }
}

/// The whole report: status, work, energy, records, files.
pub(crate) fn report(
    file: &SceneFile,
    summary: &Summary,
    recorder: &Recorder<'_>,
    folder: &RunFolder,
    pictures: &[String],
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
    if file.scene().run.audit && !statics {
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
    if !pictures.is_empty() {
        line("pictures", pictures.iter().map(|p| format!("plots/{p}.svg")).collect::<Vec<_>>().join(", "));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_readable() {
        for (x, text) in [
            (0.0, "0"),
            (-0.0, "0"),
            (1.0, "1"),
            (-29.98765432, "-29.9877"),
            (1234567.0, "1234567"),
            (0.00012345678, "0.000123457"),
            (1.5e-9, "1.5e-9"),
            (-2e12, "-2e12"),
            (f64::NAN, "NaN"),
        ] {
            assert_eq!(number(x), text);
        }
        assert_eq!([rough(0.0), rough(1.234), rough(123.4), rough(1e-9)], ["0", "1.23", "123", "1.0e-9"]);
    }
}
