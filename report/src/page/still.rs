//! Pages of tables and pictures in the look of the page of a run: of sweeps, atlases, verification, costs.

use super::escaped;
use std::fmt::Write;

const STYLE: &str = include_str!("still.css");

/// A page that is written piece by piece.
///
/// ```
/// # use ropewalk_report::StillPage;
/// let mut page = StillPage::new("Three runs", "sweep · Ropewalk");
/// page.paragraph("Of each record the last value.");
/// page.table("Runs", &["run", "z [m]"], [vec!["a <b>".to_string(), "-1.5".to_string()]]);
/// let html = page.html();
/// assert!(html.contains("<td class=\"number\">-1.5</td>") && html.contains("a &lt;b&gt;"));
/// ```
#[derive(Clone, Debug)]
pub struct StillPage {
    title: String,
    subtitle: String,
    status: Option<(String, String)>,
    body: String,
}

impl StillPage {
    /// A page without anything but its title; `subtitle` says what kind of page it is.
    pub fn new(title: impl Into<String>, subtitle: impl Into<String>) -> Self {
        StillPage { title: title.into(), subtitle: subtitle.into(), status: None, body: String::new() }
    }

    /// How it ended, in a word; `class` is `outside` or `failed` for what isn't well, else empty.
    pub fn status(&mut self, word: &str, class: &str) {
        self.status = Some((word.into(), class.into()));
    }

    /// A text.
    pub fn paragraph(&mut self, text: &str) {
        _ = writeln!(self.body, "<p>{}</p>", escaped(text));
    }

    /// A heading with a name that links lead to.
    pub fn heading(&mut self, id: &str, text: &str) {
        _ = writeln!(self.body, "<h2 id=\"{}\">{}</h2>", escaped(id), escaped(text));
    }

    /// HTML as it is.
    pub fn raw(&mut self, html: &str) {
        self.body += html;
    }

    /// A picture beside the page, with what it shows.
    pub fn picture(&mut self, address: &str, text: &str) {
        let (address, text) = (escaped(address), escaped(text));
        _ = writeln!(self.body, "<figure><img src=\"{address}\" alt=\"{text}\"></figure>");
    }

    /// A table; cells that are numbers stand to the right.
    pub fn table(
        &mut self,
        name: &str,
        headings: &[impl AsRef<str>],
        rows: impl IntoIterator<Item = Vec<String>>,
    ) {
        let rows: Vec<Vec<String>> = rows.into_iter().collect();
        let number = |c: usize| {
            let mut cells =
                rows.iter().filter_map(|row| row.get(c)).filter(|text| !text.is_empty()).peekable();
            cells.peek().is_some() && cells.all(|text| begins_as_number(text))
        };
        let classes: Vec<&str> =
            (0..headings.len()).map(|c| if number(c) { " class=\"number\"" } else { "" }).collect();
        self.begin_table(name);
        for (heading, class) in headings.iter().zip(&classes) {
            _ = match heading.as_ref() {
                // a heading that says nothing is none
                "" => write!(self.body, "<td></td>"),
                text => write!(self.body, "<th scope=\"col\"{class}>{}</th>", escaped(text)),
            };
        }
        self.body += "</tr></thead>\n<tbody>\n";
        for row in &rows {
            self.body += "<tr>";
            for (cell, class) in row.iter().zip(&classes) {
                _ = write!(self.body, "<td{class}>{}</td>", escaped(cell));
            }
            self.body += "</tr>\n";
        }
        self.end_table();
    }

    /// Begins a table of one's own, up to the cells of its heading.
    pub fn begin_table(&mut self, name: &str) {
        // what is wider than the screen is moved by keys
        let name = escaped(name);
        _ = write!(
            self.body,
            "<div class=\"table\" tabindex=\"0\" role=\"region\" aria-label=\"{name}\"><table>\n<thead><tr>"
        );
    }

    /// Ends it, behind its last row.
    pub fn end_table(&mut self) {
        self.body += "</tbody>\n</table></div>\n";
    }

    /// The whole page.
    pub fn html(&self) -> String {
        let (title, subtitle) = (escaped(&self.title), escaped(&self.subtitle));
        let status = self.status.as_ref().map_or_else(String::new, |(word, class)| {
            format!("<span class=\"status {}\">{}</span>\n", escaped(class), escaped(word))
        });
        format!(
            "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{title}</title>\n\
             <style>\n{STYLE}</style>\n</head>\n<body>\n<header>\n<div><h1>{title}</h1><p>{subtitle}</p></div>\n{status}\
             <label class=\"toggle\"><input id=\"theme\" type=\"checkbox\"> Light or dark</label>\n</header>\n<main>\n{}\
             </main>\n</body>\n</html>\n",
            self.body
        )
    }
}

/// Whether a cell belongs to a column of numbers: one with or without its unit, or a word in its place.
fn begins_as_number(text: &str) -> bool {
    let mut words = text.trim_start_matches(['-', '−', '<']).split_whitespace();
    let (first, unit) = (words.next().unwrap_or(""), words.next().unwrap_or(""));
    let begins = first.starts_with(|c: char| c.is_ascii_digit());
    // what goes on is a sentence
    let short = words.next().is_none() && unit.chars().count() <= 5;
    (begins && short) || matches!(text, "NaN" | "inf" | "failed" | "–")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_of_words_stand_to_the_left_and_texts_stay_texts() {
        let mut page = StillPage::new("<b>", "a & b");
        page.status("outside", "outside");
        let row = |a: &str, b: &str| vec![a.to_string(), b.to_string()];
        page.table("x", &["case", "error"], [row("1 hose towed", "0.5 m"), row("hose", "failed")]);
        let html = page.html();
        assert!(html.contains("<title>&lt;b&gt;</title>") && html.contains("<p>a &amp; b</p>"));
        assert!(html.contains("<td>1 hose towed</td><td class=\"number\">0.5 m</td>"), "{html}");
        assert!(html.contains("<span class=\"status outside\">outside</span>"));
    }
}
