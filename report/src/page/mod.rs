//! The page of a run: one HTML file with its motion in space, its histories and what one should know about it.
//!
//! The page is a template, built from `viewer/` and kept beside this file, into which [`Page::write`] puts the
//! numbers: deflated, so that they are small, and as text, so that the file opens from a disk without a network.
//! `viewer/README.md` tells the format.

mod block;
mod pack;
mod panel;
mod range;
mod steps;
mod still;
mod thin;

pub use range::RangeGraph;
pub use steps::Steps;
pub use still::StillPage;

use std::path::Path;

use crate::{FieldRecord, OutputError, Table};

/// The template, as `node viewer/build.mjs` makes it.
const TEMPLATE: &str = include_str!("report.html");
const TITLE: &str = "@@TITLE@@";
const DATA: &str = "@@DATA@@";

/// What stands on the page of a run.
///
/// Only [`title`](Self::title) is needed; what is left empty doesn't appear.
///
/// ```
/// # use ropewalk_report::{BodyRecord, Column, Entry, FieldRecord, OutputError, Page, Pose, Table};
/// let mut history = Table::new([Column::new("ball.z", "m")]);
/// let mut ball = BodyRecord::new("ball", "point mass");
/// let mut times = Vec::new();
/// for k in 0..=20 {
///     let t = 0.05 * f64::from(k);
///     let z = 5.0 - 0.5 * 9.81 * t * t;
///     history.push_row(&[t, z])?;
///     times.push(t);
///     ball.poses.push(Pose::at([0.0, 0.0, z]));
/// }
/// let page = Page {
///     title: "A ball falls".into(),
///     status: "finished".into(),
///     summary: vec![Entry::new("steps", "20")],
///     history,
///     field: FieldRecord { times, bodies: vec![ball], ..FieldRecord::default() },
///     ..Page::default()
/// };
/// # let folder = tempfile::tempdir().unwrap();
/// # let path = folder.path().join("report.html");
/// page.write(&path)?;
/// # assert!(std::fs::read_to_string(&path).unwrap().contains("<title>A ball falls</title>"));
/// # Ok::<(), OutputError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Page {
    /// What the run shows, in a few words.
    pub title: String,
    /// Name of the scene, such as `hose-turn`, and of the program with its version.
    pub subtitle: String,
    /// How the run ended, in one word: `finished`, `interrupted`, `failed`.
    pub status: String,
    /// The scene as it was read.
    pub scene: String,
    /// How much work it was and what else is told at the end of a run.
    pub summary: Vec<Entry>,
    /// What one should know although the run went on.
    pub warnings: Vec<String>,
    /// What follows from what the scene says.
    pub notes: Vec<String>,
    /// What broke, let go or touched.
    pub events: Vec<Event>,
    /// Scheme, tolerances and the like.
    pub settings: Vec<Entry>,
    /// The balance of energy, term by term.
    pub energy: Vec<Entry>,
    /// What else is to be told, such as last values: sections of their own.
    pub sections: Vec<Section>,
    /// Tables of texts, such as statistics.
    pub listings: Vec<Listing>,
    /// Range graphs along lines, over all steps of the solver.
    pub ranges: Vec<RangeGraph>,
    /// The histories; the first column is the time [s] or the load factor.
    pub history: Table,
    /// What is drawn together. Columns that are in none get panels of their own, by name and unit.
    pub panels: Vec<Panel>,
    /// The steps of the solver, if they are known.
    pub steps: Option<Steps>,
    /// Times at which another motion begins that has nothing to do with the one before, such as the next mode.
    pub restarts: Vec<f64>,
    /// What moved.
    pub field: FieldRecord,
    /// Size of the file [bytes] above which histories and snapshots are thinned; the page then says so.
    pub budget: usize,
}

impl Default for Page {
    fn default() -> Self {
        Self {
            title: String::new(),
            subtitle: String::new(),
            status: String::new(),
            scene: String::new(),
            summary: Vec::new(),
            warnings: Vec::new(),
            notes: Vec::new(),
            events: Vec::new(),
            settings: Vec::new(),
            sections: Vec::new(),
            listings: Vec::new(),
            ranges: Vec::new(),
            energy: Vec::new(),
            history: Table::default(),
            panels: Vec::new(),
            steps: None,
            restarts: Vec::new(),
            field: FieldRecord::default(),
            budget: 2_000_000,
        }
    }
}

/// Entries under a title of their own.
#[derive(Clone, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct Section {
    /// What they are, such as "Last values".
    pub title: String,
    /// The entries.
    pub entries: Vec<Entry>,
}

/// A table of texts under a title.
#[derive(Clone, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct Listing {
    /// What it is, such as "Statistics".
    pub title: String,
    /// One for each column.
    pub headings: Vec<String>,
    /// As many cells each; the first of them names the row.
    pub rows: Vec<Vec<String>>,
    /// What is said below it, such as of which time it is.
    pub note: String,
}

/// A name and a value with its unit, such as "CPU time" and "0.52 s".
#[derive(Clone, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct Entry {
    /// What it is.
    pub name: String,
    /// Its value as text.
    pub value: String,
}

impl Entry {
    /// An entry.
    pub fn new(name: impl Into<String>, value: impl Into<String>) -> Self {
        Self { name: name.into(), value: value.into() }
    }
}

/// Something that happened at a time.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize)]
pub struct Event {
    /// When it was [s], or at which load factor.
    pub t: f64,
    /// What it was.
    pub text: String,
}

/// Columns of the history that are drawn together. Those of different units get axes of their own.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Panel {
    /// What they are, such as "End of the hose".
    pub title: String,
    /// Names of the columns.
    pub columns: Vec<String>,
}

impl Page {
    /// Writes the page, all or nothing.
    ///
    /// # Errors
    /// [`OutputError::Field`] for a field record with a hole, [`OutputError::RowWidth`] for columns of different
    /// lengths, [`OutputError::Io`] for a file that can't be written.
    pub fn write(&self, path: &Path) -> Result<(), OutputError> {
        crate::write_atomic(path, &self.html()?)
    }

    /// The page as text.
    ///
    /// # Errors
    /// As [`write`](Self::write), but for files.
    pub fn html(&self) -> Result<String, OutputError> {
        self.field.check()?;
        let rows = self.history.rows();
        if let Some(column) = self.history.columns.iter().find(|c| c.values.len() != rows) {
            return Err(OutputError::RowWidth { expected: rows, found: column.values.len() });
        }
        let title = escaped(&self.title);
        let room = self.budget.saturating_sub(TEMPLATE.len() + title.len());
        let data = pack::base64(&thin::within(self, room / 4 * 3));
        let (head, tail) = TEMPLATE.split_once(DATA).unwrap_or((TEMPLATE, ""));
        // only the head has the title's place; data and script may hold anything
        Ok([&head.replacen(TITLE, &title, 1), data.as_str(), tail].concat())
    }
}

/// Text that HTML shows as it is.
pub fn escaped(text: &str) -> String {
    let mut out = String::new();
    for c in text.chars() {
        match c {
            '&' => out += "&amp;",
            '<' => out += "&lt;",
            '>' => out += "&gt;",
            '"' => out += "&quot;",
            c => out.push(c),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Column;

    /// What stands between the tags of the data.
    fn data(html: &str) -> &str {
        let start = html.find("id=\"data\"").unwrap();
        let start = start + html[start..].find('>').unwrap() + 1;
        &html[start..start + html[start..].find('<').unwrap()]
    }

    #[test]
    fn the_template_has_a_place_for_title_and_data_and_loads_nothing() {
        assert_eq!(TEMPLATE.matches(TITLE).count(), 1);
        assert_eq!(TEMPLATE.matches(DATA).count(), 1);
        assert!(TEMPLATE.contains("default-src 'none'"));
        // a script that held its own end would be cut off there
        assert_eq!(TEMPLATE.matches("<script").count(), TEMPLATE.matches("</script").count());
        assert!(TEMPLATE.contains("three.js") && TEMPLATE.contains("uPlot") && TEMPLATE.contains("MIT"));
        assert!(!TEMPLATE.contains(" src=\"") && !TEMPLATE.contains("<link"));
    }

    #[test]
    fn texts_can_not_break_out_of_the_page() {
        let nasty = "</script><script>alert(1)</script> & \"@@DATA@@\"";
        let page = Page {
            title: nasty.into(),
            scene: nasty.into(),
            warnings: vec![nasty.into()],
            status: nasty.into(),
            ..Page::default()
        };
        let html = page.html().unwrap();
        assert_eq!(html.matches("</script").count(), TEMPLATE.matches("</script").count());
        assert!(html.contains(
            "<title>&lt;/script&gt;&lt;script&gt;alert(1)&lt;/script&gt; &amp; &quot;@@DATA@@&quot;</title>"
        ));
        let (text, _) = block::tests::open(data(&html));
        assert_eq!(text["title"], nasty);
        assert_eq!(text["scene"], nasty);
        assert_eq!(text["warnings"][0], nasty);
    }

    #[test]
    fn columns_of_different_lengths_are_refused() {
        let mut page = Page { history: Table::new([Column::new("a", "m")]), ..Page::default() };
        page.history.columns[0].values.push(1.0);
        assert!(matches!(page.html(), Err(OutputError::RowWidth { expected: 1, found: 0 })));
    }
}
