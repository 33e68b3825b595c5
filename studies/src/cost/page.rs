//! `index.html` of a study of cost: what is advised, the picture, all runs that are shown.

use super::front::front;
use super::report::Report;
use ropewalk_report::{StillPage, rough};

/// The page; the picture lies beside it.
pub(super) fn page(report: &Report<'_>, scene: &str) -> String {
    let (target, reference) = (report.target, report.reference);
    let title = format!("What accuracy costs: {} of {scene}", target.text);
    let mut page = StillPage::new(title, format!("ropewalk cost · Ropewalk {}", env!("CARGO_PKG_VERSION")));
    let when = target.t.map_or_else(|| "the largest one over the run".into(), |t| format!("that at {t}"));
    page.paragraph(&format!(
        "Errors are relative to {} {}, the largest magnitude of {} over the run; {when} counts. The reference has an uncertainty \
         of {}: {} of steps, {} of the mesh.",
        rough(reference.size),
        target.unit,
        target.name,
        rough(reference.uncertainty()),
        rough(reference.step),
        rough(reference.mesh)
    ));
    reference.notes.iter().for_each(|note| page.paragraph(note));
    page.heading("advice", "The cheapest settings for an accuracy");
    let rows = report.advice().into_iter().map(|a| {
        let [settings, recipe] = [a.settings, a.recipe].map(|text| text.unwrap_or_else(|| "–".into()));
        let error = a.error.map_or_else(|| "–".into(), |e| format!("{e:.1e}"));
        let cpu = a.cpu_s.map_or_else(|| "–".into(), rough);
        vec![format!("{:e}", a.accuracy), settings, error, cpu, recipe]
    });
    page.table("Advice", &["accuracy", "settings", "error", "CPU time [s]", "how to get them"], rows);
    page.picture("plots/cost.svg", "Error over CPU time");
    page.heading("runs", "Runs");
    let (headings, rows, left_out) = report.rows(&front(&report.points));
    page.table("Runs", &headings, rows);
    let more = if left_out > 0 { format!(" {left_out} more are in table.csv.") } else { String::new() };
    page.paragraph(&format!(
        "No other run is both faster and more accurate than those with a star.{more} advice/*.toml are the scene with these \
         settings."
    ));
    page.html()
}
