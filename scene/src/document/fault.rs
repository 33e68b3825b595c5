//! What is wrong with a scene, said so that the user can put it right, and guesses at what was meant.

use super::source::{Place, Sources, Span};
use std::fmt;
use std::ops::Range;

/// One thing that is wrong with a scene, and where.
///
/// Displayed, it is all that a user needs to see; the command line puts `error: ` in front.
///
/// ```text
/// unknown field `eI`, expected `ea` or `ei`
///   --> scene.toml:12:1 (elements[0].section)
///    |
/// 12 | eI = 3
///    | ^^
///    = help: did you mean `ei`?
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// What is wrong, in one sentence.
    pub message: String,
    /// What to do about it, if that can be said.
    pub help: Option<String>,
    /// The part of the scene, like `elements[0].section.ea`; empty for the whole.
    pub path: String,
    /// Where it was written; none if the file could not be read at all.
    pub place: Option<Box<Place>>,
    /// What else is worth knowing, such as where a parameter is used.
    pub notes: Vec<String>,
}

impl Fault {
    /// A fault of the scene as a whole.
    pub fn new(message: impl Into<String>) -> Self {
        Self { message: message.into(), help: None, path: String::new(), place: None, notes: Vec::new() }
    }

    /// A fault at some bytes of a text of this name that isn't a scene.
    #[must_use]
    pub fn in_text(message: impl Into<String>, name: &str, text: &str, bytes: Range<usize>) -> Self {
        let mut sources = Sources::default();
        let source = sources.add(name, text);
        Self::at(message, Span::new(source, bytes), &sources)
    }

    pub(super) fn at(message: impl Into<String>, span: Span, sources: &Sources) -> Self {
        Self { place: sources.place(span).map(Box::new), ..Self::new(message) }
    }

    /// Adds what to do about it.
    #[must_use]
    pub fn with_help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// Adds the part of the scene that it is about, like `elements[0]`.
    #[must_use]
    pub fn with_path(mut self, path: impl Into<String>) -> Self {
        self.path = path.into();
        self
    }

    /// Adds something else worth knowing.
    #[must_use]
    pub fn with_note(mut self, note: impl Into<String>) -> Self {
        self.notes.push(note.into());
        self
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)?;
        let mut margin = String::from(" ");
        if let Some(p) = &self.place {
            let number = p.line.to_string();
            margin = " ".repeat(number.len());
            write!(f, "\n{margin}--> {}:{}:{}", p.file, p.line, p.column)?;
            if !self.path.is_empty() {
                write!(f, " ({})", self.path)?;
            }
            write!(f, "\n{margin} |\n{number} | {}", p.excerpt)?;
            write!(f, "\n{margin} | {}{}", " ".repeat(p.mark), "^".repeat(p.width))?;
        } else if !self.path.is_empty() {
            write!(f, "\n{margin}--> ({})", self.path)?;
        }
        for note in &self.notes {
            write!(f, "\n{margin} = note: {note}")?;
        }
        match &self.help {
            Some(help) => write!(f, "\n{margin} = help: {help}"),
            None => Ok(()),
        }
    }
}

impl std::error::Error for Fault {}

/// Makes one line of what may be anything: messages quote the user's text.
pub(super) fn one_line(text: &str) -> String {
    const LONGEST: usize = 400;
    let mut line: String = text.chars().map(|c| if c.is_control() { ' ' } else { c }).take(LONGEST).collect();
    if text.chars().nth(LONGEST).is_some() {
        line.push('…');
    }
    line
}

/// A name as a message quotes it: in backticks, on one line, and not longer than a name should be.
pub fn quoted(name: &str) -> String {
    let short: String = name.chars().take(60).map(|c| if c.is_control() { ' ' } else { c }).collect();
    format!("`{short}{}`", if name.chars().nth(60).is_some() { "…" } else { "" })
}

/// ``expected `a` or `b` ``, whatever the number of names.
pub(super) fn expected<S: AsRef<str>>(names: &[S]) -> String {
    let names: Vec<String> = names.iter().map(|n| format!("`{}`", n.as_ref())).collect();
    match names.as_slice() {
        [] => "expected nothing here".to_string(),
        [one] => format!("expected {one}"),
        [one, other] => format!("expected {one} or {other}"),
        many => format!("expected one of {}", many.join(", ")),
    }
}

/// ``did you mean `b`?`` if one of the names is close to what was written.
pub fn did_you_mean<S: AsRef<str>>(written: &str, names: &[S]) -> Option<String> {
    let plain = |s: &str| s.to_lowercase().replace(['-', ' '], "_");
    let written = plain(written);
    let length = written.chars().count();
    if length > 60 {
        return None;
    }
    let close = names.iter().map(AsRef::as_ref).filter_map(|name| {
        let distance = strsim::damerau_levenshtein(&written, &plain(name));
        let longest = length.max(name.chars().count());
        // a name that begins with what was written is one that was cut short
        let begun = length >= 3 && plain(name).starts_with(&written);
        (distance * 3 <= longest.max(3) && distance < longest || begun).then_some((distance, name))
    });
    close.min_by_key(|(distance, _)| *distance).map(|(_, name)| format!("did you mean `{name}`?"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn guesses_are_close_or_not_made() {
        let names = ["ea", "ei", "length", "drag_normal", "cable"];
        for (written, guess) in [
            ("eI", "ei"),
            ("lenght", "length"),
            ("drag-normal", "drag_normal"),
            ("Cabel", "cable"),
            ("len", "length"),
        ] {
            assert_eq!(did_you_mean(written, &names), Some(format!("did you mean `{guess}`?")), "{written}");
        }
        for written in ["", "x", "gx", "mass", "anchor", &"long".repeat(1000)] {
            assert_eq!(did_you_mean(written, &names), None, "{written}");
        }
        assert_eq!(did_you_mean::<&str>("x", &[]), None);
    }

    #[test]
    fn a_fault_shows_message_place_path_note_and_help() {
        let mut sources = Sources::default();
        let text = "\n".repeat(11) + "eI = 3\n";
        let source = sources.add("scene.toml", &text);
        let fault =
            Fault::at("unknown field `eI`, expected `ea` or `ei`", Span::new(source, 11..13), &sources)
                .with_path("elements[0].section")
                .with_note("used at scene.toml:1:1")
                .with_help("did you mean `ei`?");
        let shown = "\
unknown field `eI`, expected `ea` or `ei`
  --> scene.toml:12:1 (elements[0].section)
   |
12 | eI = 3
   | ^^
   = note: used at scene.toml:1:1
   = help: did you mean `ei`?";
        assert_eq!(fault.to_string(), shown);
        assert_eq!(Fault::new("no file").to_string(), "no file");
    }
}
