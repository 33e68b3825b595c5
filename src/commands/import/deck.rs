//! MoorDyn's input file, version 2: sections of rows under dashed lines.

/// A row: its words, and its line in the file.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Row {
    pub words: Vec<String>,
    pub line: usize,
}

/// What is wrong, and in which line.
pub(super) type Wrong = (usize, String);

impl Row {
    /// A word.
    pub(super) fn word(&self, k: usize, what: &str) -> Result<&str, Wrong> {
        self.words.get(k).map(String::as_str).ok_or_else(|| (self.line, format!("the row has no {what}")))
    }
    /// A number.
    pub(super) fn number(&self, k: usize, what: &str) -> Result<f64, Wrong> {
        let word = self.word(k, what)?;
        let read = word.replace(['d', 'D'], "e").parse::<f64>().ok().filter(|x| x.is_finite());
        read.ok_or_else(|| (self.line, format!("{what} should be a number, not `{word}`")))
    }
}

/// The rows of all sections.
#[derive(Clone, Debug, Default)]
pub(super) struct Deck {
    pub types: Vec<Row>,
    pub points: Vec<Row>,
    pub lines: Vec<Row>,
    pub options: Vec<Row>,
    pub outputs: Vec<Row>,
}

#[derive(Clone, Copy, PartialEq)]
enum Section {
    Head,
    Types,
    Points,
    Lines,
    Options,
    Outputs,
    /// Known, and not to be mapped if there is anything in it.
    Refused(&'static str),
    End,
}

/// Words that begin sections; those that hold others come first.
const NAMES: &[(&str, Section)] = &[
    ("LINE TYPE", Section::Types),
    ("LINE DICTIONARY", Section::Types),
    ("ROD TYPE", Section::Head),
    ("ROD DICTIONARY", Section::Head),
    ("BODIES", Section::Refused("bodies")),
    ("BODY", Section::Refused("bodies")),
    ("ROD", Section::Refused("rods")),
    ("POINT", Section::Points),
    ("CONNECTION PROP", Section::Points),
    ("NODE PROP", Section::Points),
    ("FAILURE", Section::Refused("failures")),
    ("CONTROL", Section::Refused("controls")),
    ("USER", Section::Refused("loads of users")),
    ("EXTERNAL LOAD", Section::Refused("external loads")),
    ("LINE", Section::Lines),
    ("OPTION", Section::Options),
    ("SOLVER", Section::Options),
    ("OUTPUT", Section::Outputs),
    ("END", Section::End),
];

impl Deck {
    /// Reads a file.
    pub(super) fn read(text: &str) -> Result<Self, Wrong> {
        let mut deck = Deck::default();
        let (mut section, mut heads) = (Section::Head, 0);
        for (k, whole) in text.lines().enumerate() {
            let line = whole.split('#').next().unwrap_or_default().trim();
            if line.starts_with("--") {
                let title = line.trim_matches(['-', ' ', '=']).to_uppercase();
                if let Some((_, found)) = NAMES.iter().find(|(name, _)| title.contains(name)) {
                    let table = !matches!(found, Section::Options | Section::Outputs | Section::End);
                    (section, heads) = (*found, if table { 2 } else { 0 });
                }
                continue;
            }
            let words: Vec<String> = line.split_whitespace().map(String::from).collect();
            if words.is_empty() {
                continue;
            }
            if heads > 0 {
                heads -= 1;
                continue;
            }
            let row = Row { words, line: k + 1 };
            match section {
                Section::Types => deck.types.push(row),
                Section::Points => deck.points.push(row),
                Section::Lines => deck.lines.push(row),
                Section::Options => deck.options.push(row),
                Section::Outputs => {
                    deck.outputs
                        .extend(row.words.iter().map(|w| Row { words: vec![w.clone()], line: row.line }));
                }
                Section::Refused(what) => {
                    let why = format!(
                        "{what} aren't imported yet: build them in the scene, and take them out of the deck"
                    );
                    return Err((row.line, why));
                }
                Section::Head | Section::End => {}
            }
        }
        for (rows, what) in [(&deck.types, "LINE TYPES"), (&deck.points, "POINTS"), (&deck.lines, "LINES")] {
            if rows.is_empty() {
                return Err((
                    1,
                    format!("there is no section {what} with a row: is this a deck of MoorDyn, version 2?"),
                ));
            }
        }
        Ok(deck)
    }

    /// An option: its value as it is written, and its line.
    pub(super) fn option(&self, names: &[&str]) -> Option<(&str, usize)> {
        let of =
            |row: &&Row| row.words.get(1).is_some_and(|w| names.iter().any(|n| n.eq_ignore_ascii_case(w)));
        self.options.iter().find(of).map(|row| (row.words[0].as_str(), row.line))
    }

    /// The same as a number.
    pub(super) fn number(&self, names: &[&str], otherwise: f64) -> Result<f64, Wrong> {
        let Some((word, line)) = self.option(names) else { return Ok(otherwise) };
        let read = word.parse::<f64>().ok().filter(|x| x.is_finite());
        read.ok_or_else(|| (line, format!("{} should be a number, not `{word}`", names[0])))
    }
}
