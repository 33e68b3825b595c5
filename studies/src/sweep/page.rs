//! `index.html` of a sweep: its table with links into the folders of the runs, and all pictures.

use super::report::shown_value;
use super::results::Results;
use super::tail::{Over, Report};
use crate::study::StudyFolder;
use ropewalk_report::{OutputError, escaped, rough, write_atomic};
use std::path::PathBuf;

const STYLE: &str = "\
body { font: 15px/1.45 system-ui, sans-serif; margin: 1.5rem auto; padding: 0 1rem; max-width: 90rem; color: #16202e; background: #fff }
h1 { font-size: 1.4rem } h2 { font-size: 1.1rem; margin: 2rem 0 .4rem }
.table { overflow-x: auto } table { border-collapse: collapse; font-size: .85rem; font-variant-numeric: tabular-nums }
th, td { padding: .2rem .7rem; border-bottom: 1px solid #dde3ec; text-align: right; white-space: nowrap }
th { vertical-align: bottom; border-bottom: 1px solid #16202e; font-weight: 600 } th:first-child, td:first-child { text-align: left }
.failed, .refused { color: #a31515 } .interrupted { color: #8a4b00 }
.pictures { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(28rem, 100%), 1fr)); gap: .8rem }
figure { margin: 0 } img { width: 100%; height: auto; background: #fff; border: 1px solid #dde3ec; border-radius: 6px } figcaption { font-size: .85rem; color: #566275 }
a { color: #0b63b8 }
@media (prefers-color-scheme: dark) { body { background: #10151d; color: #dde5f0 } th, td { border-color: #2b3546 } a { color: #7db7f0 } .failed, .refused { color: #ff8f8f } figcaption { color: #9aa8bc } }
";

/// Writes it: what a run left is named by its folder, and `ropewalk view` makes a page of that.
pub(super) fn write(
    folder: &StudyFolder,
    results: &Results,
    names: &[String],
    (what, over): (Report, Over),
) -> Result<(), OutputError> {
    let path = folder.path().join("index.html");
    let title = folder.path().file_name().unwrap_or_default().to_string_lossy().into_owned();
    let title = escaped(&title);
    let recorded = results.recorded();
    let shown = || recorded.iter().skip(1);
    let mut out = format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{title}</title>\n\
         <style>\n{STYLE}</style>\n</head>\n<body><main>\n<h1>{title}</h1>\n"
    );
    let value =
        if what == Report::Last { "the last value".into() } else { format!("{} of {over}", what.ending()) };
    out += &format!(
        "<p>{} runs; of each record {value}. <a href=\"table.csv\">table.csv</a> has all of it; \
         <code>ropewalk view runs/NAME</code> shows a run in motion.</p>\n",
        results.len()
    );
    out += "<div class=\"table\"><table>\n<thead><tr><th scope=\"col\">run</th>";
    let fixed = ["status", "CPU [s]", "steps"].map(String::from);
    let headings = results.headings.iter().cloned().chain(fixed).chain(shown().map(|c| c.heading.clone()));
    headings.for_each(|heading| out += &format!("<th scope=\"col\">{}</th>", escaped(&heading)));
    out += "</tr></thead>\n<tbody>\n";
    for (k, row) in results.rows() {
        let (name, status) = (&names[k], row.status.to_string());
        out += &format!("<tr><td><a href=\"runs/{}/\">{}</a></td>", address(name), escaped(name));
        results.cells(k).iter().for_each(|cell| out += &format!("<td>{}</td>", escaped(cell)));
        let message = escaped(row.message.as_deref().unwrap_or_default());
        out += &format!("<td class=\"{status}\" title=\"{message}\">{status}</td>");
        out += &format!("<td>{}</td><td>{}</td>", rough(row.cpu_s), row.counts.steps);
        shown().for_each(|c| out += &format!("<td>{}</td>", shown_value(row, c, what)));
        out += "</tr>\n";
    }
    out += "</tbody>\n</table></div>\n";
    let pictures = pictures(folder);
    if !pictures.is_empty() {
        out += "<h2>Pictures</h2>\n<div class=\"pictures\">\n";
        for name in pictures {
            let (href, text) = (address(&name), escaped(name.trim_end_matches(".svg")));
            out += &format!(
                "<figure><a href=\"plots/{href}\"><img loading=\"lazy\" src=\"plots/{href}\" alt=\"{text}\"></a>\
                 <figcaption>{text}</figcaption></figure>\n"
            );
        }
        out += "</div>\n";
    }
    out += "</main></body>\n</html>\n";
    write_atomic(&path, &out)
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
