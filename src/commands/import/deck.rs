//! A MoorDyn deck as it is written: sections behind dashed rows, tables under two rows of heads, options with their names
//! behind. The format is that of MoorDyn's own documentation (version 2).

use ropewalk_scene::Fault;
use std::ops::Range;

/// A word of a deck, and where it stands.
#[derive(Clone, Debug)]
pub(super) struct Word {
    pub text: String,
    pub bytes: Range<usize>,
}

/// A row of words; the last ones may be missing.
#[derive(Clone, Debug)]
pub(super) struct Row {
    pub words: Vec<Word>,
    /// The row as it was written.
    pub line: String,
}

/// What a dashed row begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Section {
    Title,
    LineTypes,
    RodTypes,
    Bodies,
    Rods,
    Points,
    Lines,
    Options,
    Outputs,
    /// What has no counterpart: failures, control.
    Other(&'static str),
    End,
}

/// The rows of a deck.
pub(super) struct Deck<'a> {
    name: &'a str,
    text: &'a str,
    pub title: String,
    pub types: Vec<Row>,
    pub rod_types: Vec<Row>,
    pub bodies: Vec<Row>,
    pub rods: Vec<Row>,
    pub points: Vec<Row>,
    pub lines: Vec<Row>,
    pub options: Vec<Row>,
    pub outputs: Vec<Row>,
}

/// Rows of names and units above a table.
const HEADS: usize = 2;

impl<'a> Deck<'a> {
    /// Reads a deck.
    pub fn read(name: &'a str, text: &'a str) -> Result<Self, Fault> {
        let none = Vec::new;
        let mut deck = Deck {
            name,
            text,
            title: String::new(),
            types: none(),
            rod_types: none(),
            bodies: none(),
            rods: none(),
            points: none(),
            lines: none(),
            options: none(),
            outputs: none(),
        };
        let (mut section, mut heads, mut start) = (Section::Title, 0, 0);
        for line in text.split_inclusive('\n') {
            let row = row(line, start);
            start += line.len();
            let bare = line.trim();
            if bare.starts_with("---") {
                match Section::of(bare) {
                    Some(next) => (section, heads) = (next, next.heads()),
                    None if section == Section::Title => {}
                    None => return Err(deck.fault("no section of a MoorDyn deck has this name", &row)),
                }
                continue;
            }
            if heads > 0 && !bare.is_empty() {
                heads -= 1;
                deck.check_heads(section, &row)?;
                continue;
            }
            if row.words.is_empty() {
                continue;
            }
            match section {
                Section::Title if deck.title.is_empty() => deck.title = bare.into(),
                Section::Title | Section::End => {}
                Section::LineTypes => deck.types.push(row),
                Section::RodTypes => deck.rod_types.push(row),
                Section::Bodies => deck.bodies.push(row),
                Section::Rods => deck.rods.push(row),
                Section::Points => deck.points.push(row),
                Section::Lines => deck.lines.push(row),
                Section::Options => deck.options.push(row),
                Section::Outputs if row.words[0].text.eq_ignore_ascii_case("end") => section = Section::End,
                Section::Outputs => deck.outputs.push(row),
                Section::Other(what) => {
                    let fault = deck.fault(&format!("{what} of a deck aren't taken over"), &row);
                    return Err(fault
                        .with_help("take them out of the deck, and add what they stand for to the scene"));
                }
            }
        }
        if deck.lines.is_empty() && deck.rods.is_empty() {
            let fault = Fault::new(format!("`{name}` has no lines: it isn't a MoorDyn deck"));
            return Err(fault.with_help("sections begin with dashed rows, such as `--- LINES ---`"));
        }
        Ok(deck)
    }

    /// Heads aren't numbers; those of version 1 are in another order.
    fn check_heads(&self, section: Section, row: &Row) -> Result<(), Fault> {
        let third = row.words.get(2).map(|w| w.text.to_lowercase());
        let number = |k: usize| row.words.get(k).is_some_and(|w| w.text.parse::<f64>().is_ok());
        if number(if matches!(section, Section::LineTypes | Section::RodTypes) { 1 } else { 0 }) {
            let fault = self.fault("this row would be skipped as heads, and is none", row);
            return Err(fault.with_help(
                "a table of a deck begins with a row of names and a row of units: add what is missing, such as a row of `(-)`",
            ));
        }
        if section == Section::Lines && third.is_some_and(|head| head.starts_with("unstrlen")) {
            let fault = self.fault("this is a deck of MoorDyn's version 1", row);
            return Err(fault
                .with_help("version 2 has the columns ID, LineType, AttachA, AttachB, UnstrLen, NumSegs"));
        }
        Ok(())
    }

    /// What is wrong with a row.
    pub fn fault(&self, message: &str, row: &Row) -> Fault {
        let ends = row.words.first().zip(row.words.last());
        let bytes = ends.map_or(0..0, |(a, b)| a.bytes.start..b.bytes.end);
        Fault::in_text(message, self.name, self.text, bytes)
    }

    /// What is wrong with a word.
    pub fn word_fault(&self, message: &str, word: &Word) -> Fault {
        Fault::in_text(message, self.name, self.text, word.bytes.clone())
    }

    /// A word of a row; `what` says what it should be.
    pub fn word<'r>(&self, row: &'r Row, k: usize, what: &str) -> Result<&'r Word, Fault> {
        row.words
            .get(k)
            .ok_or_else(|| self.fault(&format!("this row ends before its {what} (column {})", k + 1), row))
    }

    /// A number of a row.
    pub fn number(&self, row: &Row, k: usize, what: &str) -> Result<f64, Fault> {
        let word = self.word(row, k, what)?;
        match word.text.parse::<f64>() {
            Ok(x) if x.is_finite() => Ok(x),
            _ => {
                Err(self
                    .word_fault(&format!("`{}` is no number: the {what} is expected here", word.text), word))
            }
        }
    }

    /// A number of a row that must be above zero.
    pub fn positive(&self, row: &Row, k: usize, what: &str) -> Result<f64, Fault> {
        let x = self.number(row, k, what)?;
        if x > 0.0 {
            return Ok(x);
        }
        let message = format!("the {what} must be above 0, not {x}");
        Err(self.word_fault(&message, self.word(row, k, what)?))
    }

    /// An option by one of its names, the last one if it is given several times.
    pub fn option(&self, names: &[&str]) -> Option<&Row> {
        let named =
            |row: &&Row| row.words.get(1).is_some_and(|w| names.contains(&w.text.to_lowercase().as_str()));
        self.options.iter().rev().find(named)
    }

    /// An option that is a number.
    pub fn option_number(&self, names: &[&str], default: f64) -> Result<f64, Fault> {
        self.option(names).map_or(Ok(default), |row| self.number(row, 0, names[0]))
    }
}

/// The words of a line that begins at a byte of the text.
fn row(line: &str, start: usize) -> Row {
    let said = line.split(['#', '!']).next().unwrap_or("");
    let mut words = Vec::new();
    let mut rest = said;
    while let Some(at) = rest.find(|c: char| !c.is_whitespace()) {
        let from = said.len() - rest.len() + at;
        let word = &said[from..];
        let length = word.find(char::is_whitespace).unwrap_or(word.len());
        words.push(Word { text: word[..length].into(), bytes: start + from..start + from + length });
        rest = &word[length..];
    }
    Row { words, line: line.trim().into() }
}

impl Section {
    fn of(dashed: &str) -> Option<Section> {
        let name = dashed.trim_matches(|c: char| c == '-' || c.is_whitespace()).to_uppercase();
        let has = |all: &[&str]| all.iter().any(|part| name.contains(part));
        let list = |what: &str| has(&[&format!("{what} PROP"), &format!("{what} LIST")]);
        Some(match () {
            () if has(&["LINE TYPE", "LINE DICT"]) => Section::LineTypes,
            () if has(&["ROD TYPE", "ROD DICT"]) => Section::RodTypes,
            () if name == "RODS" || list("ROD") => Section::Rods,
            () if has(&["BODIES"]) || list("BODY") => Section::Bodies,
            () if has(&["POINTS", "CONNECT", "NODE PROP"]) || list("POINT") => Section::Points,
            () if has(&["FAILURE"]) => Section::Other("failures"),
            () if has(&["CONTROL"]) => Section::Other("controls"),
            () if has(&["OPTION"]) => Section::Options,
            () if has(&["OUTPUT"]) => Section::Outputs,
            () if name == "LINES" || list("LINE") => Section::Lines,
            () if name.is_empty() || has(&["NEED THIS LINE", "END"]) => Section::End,
            () => return None,
        })
    }

    fn heads(self) -> usize {
        match self {
            Section::Title | Section::Options | Section::Outputs | Section::End => 0,
            _ => HEADS,
        }
    }
}
