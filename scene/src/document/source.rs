//! Where things were written: sources, spans of bytes in them, and the places (line and column) that people read.

use std::ops::Range;

/// Where a value or a key was written: which source, and which bytes of it.
///
/// It means something to the [`Document`](super::Document) that made it, which turns it into a [`Place`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Span {
    pub(super) source: usize,
    pub(super) start: usize,
    pub(super) end: usize,
}

impl Span {
    pub(super) fn new(source: usize, range: Range<usize>) -> Self {
        Self { source, start: range.start, end: range.end }
    }

    /// Which of the document's sources: 0 is the file, the others are overrides in the order given.
    #[must_use]
    pub fn source(&self) -> usize {
        self.source
    }

    /// The bytes of the source.
    #[must_use]
    pub fn range(&self) -> Range<usize> {
        self.start..self.end
    }
}

/// A place in a source as people count it, with the line that stands there.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// Name of the source: the file's path, or `--set`.
    pub file: String,
    /// The bytes meant.
    pub span: Span,
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// What stands there: the line, or its part around the place if it is long.
    pub excerpt: String,
    /// First marked character of the excerpt, from 0.
    pub mark: usize,
    /// Number of marked characters, at least 1.
    pub width: usize,
}

/// The beginning of the character at a byte, or the text's end.
pub(super) fn boundary(text: &str, at: usize) -> usize {
    (0..=at.min(text.len())).rev().find(|i| text.is_char_boundary(*i)).unwrap_or(0)
}

/// A text that values came from.
#[derive(Debug)]
struct Source {
    name: String,
    text: String,
}

/// All texts that contribute to a document.
#[derive(Debug, Default)]
pub(super) struct Sources(Vec<Source>);

impl Sources {
    /// Keeps a text and gives the number that its spans carry.
    pub(super) fn add(&mut self, name: &str, text: &str) -> usize {
        self.0.push(Source { name: name.to_string(), text: text.to_string() });
        self.0.len() - 1
    }

    pub(super) fn name(&self, source: usize) -> &str {
        self.0.get(source).map_or("", |s| &s.name)
    }

    /// What stands at a span.
    pub(super) fn text(&self, span: Span) -> &str {
        self.0.get(span.source).and_then(|s| s.text.get(span.start..span.end)).unwrap_or_default()
    }

    pub(super) fn place(&self, span: Span) -> Option<Place> {
        const LONGEST: usize = 100;
        const BEFORE: usize = 40;
        let source = self.0.get(span.source)?;
        let text = &source.text;
        let start = boundary(text, span.start);
        // an end of file after the last newline is shown on the last line that has something
        let start = if start == text.len() { text.trim_end().len() } else { start };
        let end = boundary(text, span.end.max(start));
        let from = text[..start].rfind('\n').map_or(0, |i| i + 1);
        let to = text[start..].find('\n').map_or(text.len(), |i| start + i);
        let line = text[..from].matches('\n').count() + 1;
        let column = text[from..start].chars().count();
        let skipped = if column > LONGEST - BEFORE { column - BEFORE } else { 0 };
        let shown = |c: char| if c.is_control() { ' ' } else { c };
        let excerpt: String =
            text[from..to].trim_end().chars().skip(skipped).take(LONGEST).map(shown).collect();
        let mark = column - skipped;
        let room = excerpt.chars().count().saturating_sub(mark).max(1);
        let width = text[start..end.min(to)].trim_end().chars().count().clamp(1, room);
        Some(Place { file: source.name.clone(), span, line, column: column + 1, excerpt, mark, width })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn place(text: &str, range: Range<usize>) -> Place {
        let mut sources = Sources::default();
        let id = sources.add("s", text);
        sources.place(Span::new(id, range)).unwrap()
    }

    #[test]
    fn lines_and_columns_are_counted_in_characters_from_one() {
        let p = place("a = 1\r\nß = \"x\"\r\n", 12..15);
        assert_eq!((p.line, p.column, p.excerpt.as_str(), p.mark, p.width), (2, 5, "ß = \"x\"", 4, 3));
        let p = place("a = 1\nb =\n\n", 11..11);
        assert_eq!((p.line, p.column, p.excerpt.as_str(), p.width), (2, 4, "b =", 1));
        let p = place("a = [\n1,\n2]\n", 4..11);
        assert_eq!((p.line, p.column, p.width), (1, 5, 1));
        assert_eq!(place("", 0..0).line, 1);
        assert_eq!(place("äöü", 1..2).column, 1);
        assert_eq!(place("a", 7..9).line, 1);
    }

    #[test]
    fn long_lines_are_shown_around_the_place() {
        let text = format!("{}HERE{}", "x".repeat(5000), "y".repeat(5000));
        let p = place(&text, 5000..5004);
        assert_eq!((p.line, p.column, p.mark, p.width), (1, 5001, 40, 4));
        assert_eq!(&p.excerpt[40..46], "HEREyy");
        assert_eq!(p.excerpt.len(), 100);
    }
}
