//! `index.html` of a sweep: its table with links into the folders of the runs, and all pictures.

use super::report::shown_value;
use super::results::Results;
use super::tail::{Over, Report};
use crate::study::StudyFolder;
use ropewalk_report::{OutputError, StillPage, escaped, rough, write_atomic};
use std::path::PathBuf;

/// Writes it: what a run left is named by its folder, and `ropewalk view` makes a page of that.
pub(super) fn write(
    folder: &StudyFolder,
    results: &Results,
    names: &[String],
    (what, over): (Report, Over),
) -> Result<(), OutputError> {
    let path = folder.path().join("index.html");
    let title = folder.path().file_name().unwrap_or_default().to_string_lossy().into_owned();
    let subtitle = format!("sweep · Ropewalk {}", env!("CARGO_PKG_VERSION"));
    let mut page = StillPage::new(title, subtitle);
    let recorded = results.recorded();
    let shown = || recorded.iter().skip(1);
    let value =
        if what == Report::Last { "the last value".into() } else { format!("{} of {over}", what.ending()) };
    page.raw(&format!(
        "<p>{} runs; of each record {value}. <a href=\"table.csv\">table.csv</a> has all of it; \
         <code>ropewalk view runs/NAME</code> shows a run in motion.</p>\n",
        results.len()
    ));
    page.begin_table("Runs");
    page.raw("<th scope=\"col\">run</th>");
    let fixed = ["status", "CPU [s]", "steps"].map(String::from);
    let headings = results.headings.iter().cloned().chain(fixed).chain(shown().map(|c| c.heading.clone()));
    headings.for_each(|h| page.raw(&format!("<th scope=\"col\" class=\"number\">{}</th>", escaped(&h))));
    page.raw("</tr></thead>\n<tbody>\n");
    for (k, row) in results.rows() {
        let (name, status) = (&names[k], row.status.to_string());
        let mut out = format!("<tr><td><a href=\"runs/{}/\">{}</a></td>", address(name), escaped(name));
        let number = |text: &str| format!("<td class=\"number\">{text}</td>");
        out.extend(results.cells(k).iter().map(|cell| number(&escaped(cell))));
        let message = escaped(row.message.as_deref().unwrap_or_default());
        out += &format!("<td class=\"number {status}\" title=\"{message}\">{status}</td>");
        out += &(number(&rough(row.cpu_s)) + &number(&row.counts.steps.to_string()));
        out.extend(shown().map(|c| number(&shown_value(row, c, what))));
        page.raw(&(out + "</tr>\n"));
    }
    page.end_table();
    let pictures = pictures(folder);
    if !pictures.is_empty() {
        page.heading("pictures", "Pictures");
        page.raw("<div class=\"pictures\">\n");
        for name in pictures {
            let (href, text) = (address(&name), escaped(name.trim_end_matches(".svg")));
            page.raw(&format!(
                "<figure><a href=\"plots/{href}\"><img loading=\"lazy\" src=\"plots/{href}\" alt=\"{text}\"></a>\
                 <figcaption>{text}</figcaption></figure>\n"
            ));
        }
        page.raw("</div>\n");
    }
    write_atomic(&path, &page.html())
}

/// Names of the pictures, in order.
fn pictures(folder: &StudyFolder) -> Vec<String> {
    let plots: PathBuf = folder.path().join("plots");
    let entries = std::fs::read_dir(plots).into_iter().flatten().flatten();
    let names = entries.map(|e| e.file_name().to_string_lossy().into_owned());
    let mut names: Vec<String> = names.filter(|name| name.ends_with(".svg")).collect();
    names.sort();
    names
}

/// A name as part of an address.
fn address(name: &str) -> String {
    let mut out = String::new();
    for byte in name.bytes() {
        match byte {
            b'A'..=b'Z' | b'a'..=b'z' | b'0'..=b'9' | b'-' | b'_' | b'.' | b'~' => out.push(byte as char),
            _ => out += &format!("%{byte:02X}"),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_folders_are_addresses() {
        assert_eq!(address("v=5 kn,ü#1.svg"), "v%3D5%20kn%2C%C3%BC%231.svg");
    }
}
