//! The page of results: Markdown with a picture.

use super::case::Outcome;
use super::quantity::Measured;
use super::report::{list, ratio, spread};
use ropewalk_report::{Bar, BarPlot, OutputError, StillPage, escaped, number, rough};
use std::fmt::Write;

/// The first line of every such page.
pub const TITLE: &str = "# Verification";

/// The results of some cases as a Markdown page; `picture` is the name of its picture, which lies beside it.
pub fn page(outcomes: &[Outcome], picture: &str) -> String {
    let mut out = format!("{TITLE}\n\n");
    let run: Vec<&Outcome> = outcomes.iter().filter(|o| o.case.quantities() > 0).collect();
    let compared: usize = run.iter().map(|o| o.measured.len()).sum();
    let within = run.iter().filter(|o| o.is_within()).count();
    _ = writeln!(
        out,
        "Written by `ropewalk verify`, version {}. {within} of {} cases are within their tolerances; {compared} quantities \
         are compared. Errors are in parts of the tolerance; those of a vector are those of its worst component. CPU time \
         is that of one core of the machine on which the page was written, in a {} build; the limit is only a \
         suggestion.\n",
        env!("CARGO_PKG_VERSION"),
        run.len(),
        if cfg!(debug_assertions) { "development" } else { "release" },
    );
    _ = writeln!(out, "![Largest error of each case in parts of its tolerance]({picture})\n");
    out +=
        "| case | compared | largest error | CPU time | suggested |\n| --- | ---: | ---: | ---: | ---: |\n";
    for o in &run {
        let mark = if o.is_within() { "" } else { " **outside**" };
        _ = writeln!(
            out,
            "| [{}](#{}) | {} | {}{mark} | {} s | {} s |",
            o.case.name,
            o.case.name,
            o.measured.len(),
            ratio(o.worst()),
            rough(o.cpu_s),
            number(o.case.suggested_cpu_s)
        );
    }
    let left: Vec<_> =
        outcomes.iter().flat_map(|o| o.case.left_out.iter().map(|l| (o.case.name, l))).collect();
    if !left.is_empty() {
        out += "\n## What is not run\n\n| case | references | | reason |\n| --- | ---: | --- | --- |\n";
        for (name, l) in left {
            _ = writeln!(out, "| {name} | {} | {} | {} |", l.count, cell(&l.quantity), cell(&l.reason));
        }
    }
    for o in &run {
        _ = writeln!(out, "\n## {}\n\n{}. Source: {}.\n", o.case.name, o.case.title, o.case.source);
        for t in &o.trouble {
            _ = writeln!(out, "Failed: {}\n", t.replace('\n', " "));
        }
        out += "| quantity | measured | reference | tolerance | error |\n| --- | --- | --- | ---: | ---: |\n";
        o.measured.iter().for_each(|m| out += &row(m));
    }
    out
}

fn row(m: &Measured) -> String {
    let unit = if m.unit == "1" { String::new() } else { format!(" {}", m.unit) };
    let mark = if m.ratio() <= 1.0 { "" } else { " **outside**" };
    format!(
        "| {} | {} | {}{unit} | {} | {}{mark} |\n",
        cell(&m.quantity),
        list(&m.measured),
        list(&m.reference),
        spread(&m.tolerance),
        ratio(m.ratio())
    )
}

/// A text that stays in its cell.
fn cell(text: &str) -> String {
    text.replace('|', "\\|").replace('\n', " ")
}

/// The same as HTML in the look of the page of a run.
pub fn html(outcomes: &[Outcome], picture: &str) -> String {
    let run: Vec<&Outcome> = outcomes.iter().filter(|o| o.case.quantities() > 0).collect();
    let compared: usize = run.iter().map(|o| o.measured.len()).sum();
    let within = run.iter().filter(|o| o.is_within()).count();
    let subtitle = format!("ropewalk verify · Ropewalk {}", env!("CARGO_PKG_VERSION"));
    let mut page = StillPage::new("Verification", subtitle);
    match within == run.len() {
        true => page.status("within", ""),
        false => page.status(&format!("{} outside", run.len() - within), "outside"),
    }
    page.paragraph(&format!(
        "{within} of {} cases are within their tolerances; {compared} quantities are compared. Errors are in parts of the \
         tolerance; those of a vector are those of its worst component. CPU time is that of one core; the limit is only a \
         suggestion.",
        run.len()
    ));
    page.picture(picture, "Largest error of each case in parts of its tolerance");
    page.begin_table("Cases");
    for heading in ["case", "compared", "largest error", "verdict", "CPU time", "suggested"] {
        page.raw(&format!("<th scope=\"col\">{heading}</th>"));
    }
    page.raw("</tr></thead>\n<tbody>\n");
    for o in &run {
        let name = escaped(o.case.name);
        let verdict = if o.is_within() { "<td>within</td>" } else { "<td class=\"outside\">outside</td>" };
        page.raw(&format!(
            "<tr><td><a href=\"#{name}\">{name}</a></td><td class=\"number\">{}</td><td class=\"number\">{}</td>{verdict}\
             <td class=\"number\">{} s</td><td class=\"number\">{} s</td></tr>\n",
            o.measured.len(),
            ratio(o.worst()),
            rough(o.cpu_s),
            number(o.case.suggested_cpu_s)
        ));
    }
    page.end_table();
    let left = outcomes.iter().flat_map(|o| o.case.left_out.iter().map(move |l| (o.case.name, l)));
    let left: Vec<Vec<String>> = left
        .map(|(name, l)| vec![name.into(), l.count.to_string(), l.quantity.clone(), l.reason.clone()])
        .collect();
    if !left.is_empty() {
        page.heading("not-run", "What is not run");
        page.table("What is not run", &["case", "references", "quantity", "reason"], left);
    }
    for o in &run {
        page.heading(o.case.name, o.case.name);
        page.paragraph(&format!("{}. Source: {}.", o.case.title, o.case.source));
        o.trouble.iter().for_each(|t| page.paragraph(&format!("Failed: {t}")));
        let rows = o.measured.iter().map(|m| {
            let unit = if m.unit == "1" { String::new() } else { format!(" {}", m.unit) };
            let reference = list(&m.reference) + &unit;
            vec![m.quantity.clone(), list(&m.measured), reference, spread(&m.tolerance), ratio(m.ratio())]
        });
        page.table(o.case.name, &["quantity", "measured", "reference", "tolerance", "error"], rows);
    }
    page.html()
}

/// The largest error of each case as bars.
///
/// # Errors
/// There is nothing to show.
pub fn picture(outcomes: &[Outcome]) -> Result<String, OutputError> {
    let run = outcomes.iter().filter(|o| o.case.quantities() > 0);
    let bars = run.clone().map(|o| Bar {
        label: o.case.name.into(),
        value: o.worst(),
        note: ratio(o.worst()),
        group: usize::from(!o.is_within()),
    });
    let groups = ["within", "outside"].map(str::to_string).to_vec();
    let plot = BarPlot {
        title: "Largest error of each case in parts of its tolerance".into(),
        axis: "error / tolerance".into(),
        bars: bars.collect(),
        groups: if run.clone().all(Outcome::is_within) { Vec::new() } else { groups },
        log: true,
        mark: Some((1.0, "tolerance".into())),
    };
    plot.svg()
}
