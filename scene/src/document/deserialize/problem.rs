//! Serde's complaints in the words of somebody who writes scenes.

use super::super::fault::{did_you_mean, expected, one_line, quoted};
use serde::de::{Error, Expected, Unexpected};
use std::fmt;

/// What went wrong, without the place.
#[derive(Clone, Debug, Default)]
pub(super) struct Problem {
    pub(super) message: String,
    pub(super) help: Option<String>,
    /// The key complained about.
    pub(super) field: Option<String>,
    /// The variant complained about, and those there are.
    pub(super) variant: Option<(String, &'static [&'static str])>,
}

impl Problem {
    fn new(message: String) -> Self {
        Self { message, ..Self::default() }
    }

    /// Neither a name nor a table, where one of several things is to be chosen.
    pub(super) fn unfit(found: &str, names: &'static [&'static str]) -> Self {
        Self::new(format!("{}, found {found}", expected(names)))
    }

    pub(super) fn missing_type(names: &'static [&'static str]) -> Self {
        let example = names.first().copied().unwrap_or("...");
        let help = format!("say what it is, as in `type = \"{example}\"`");
        Self { help: Some(help), ..Self::new(format!("missing `type`, {}", expected(names))) }
    }

    pub(super) fn needs_fields(name: &str) -> Self {
        let help = format!("write a table: {{ type = \"{}\", ... }}", one_line(name));
        Self { help: Some(help), ..Self::new(format!("{} needs values of its own", quoted(name))) }
    }

    /// The same complaint about a name that a `type` key gave.
    pub(super) fn of_type(self) -> Self {
        match self.variant {
            Some((name, names)) => Self::unknown("type", &name, names),
            None => self,
        }
    }

    fn unknown(what: &str, name: &str, names: &'static [&'static str]) -> Self {
        let message = format!("unknown {what} {}, {}", quoted(name), expected(names));
        Self { help: did_you_mean(name, names), ..Self::new(message) }
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for Problem {}

impl Error for Problem {
    fn custom<T: fmt::Display>(message: T) -> Self {
        Self::new(one_line(&message.to_string()))
    }

    fn invalid_type(found: Unexpected<'_>, wanted: &dyn Expected) -> Self {
        Self::new(format!("expected {}, found {}", in_words(&wanted.to_string()), found_in_words(found)))
    }

    fn invalid_value(found: Unexpected<'_>, wanted: &dyn Expected) -> Self {
        Self::invalid_type(found, wanted)
    }

    fn invalid_length(length: usize, wanted: &dyn Expected) -> Self {
        let entries = if length == 1 { "entry" } else { "entries" };
        Self::new(format!("expected {}, found {length} {entries}", in_words(&wanted.to_string())))
    }

    fn unknown_variant(name: &str, names: &'static [&'static str]) -> Self {
        Self { variant: Some((name.to_string(), names)), ..Self::unknown("value", name, names) }
    }

    fn unknown_field(name: &str, names: &'static [&'static str]) -> Self {
        Self { field: Some(name.to_string()), ..Self::unknown("field", name, names) }
    }

    fn missing_field(name: &'static str) -> Self {
        Self::new(format!("missing `{name}`"))
    }
}

/// Serde's names of types as a user knows them; custom texts pass as they are.
fn in_words(wanted: &str) -> String {
    let words = match wanted {
        "f64" | "f32" => "a number",
        "u8" | "u16" | "u32" | "u64" | "u128" | "usize" => "a whole number, 0 or larger",
        "i8" | "i16" | "i32" | "i64" | "i128" | "isize" => "a whole number",
        "a nonzero u8" | "a nonzero u16" | "a nonzero u32" | "a nonzero u64" | "a nonzero usize" => {
            "a whole number, 1 or larger"
        }
        "a string" | "a borrowed string" => "a text in quotes",
        "a boolean" => "true or false",
        "a sequence" => "a list",
        "a map" => "a table",
        _ if wanted.starts_with("dyn ") => "a table with a `type`",
        _ if wanted.starts_with("struct ") => "a table",
        _ => {
            let count =
                wanted.strip_prefix("an array of length ").or(wanted.strip_prefix("a tuple of size "));
            return count.map_or_else(|| one_line(wanted), |n| format!("a list of {n}"));
        }
    };
    words.to_string()
}

fn found_in_words(found: Unexpected<'_>) -> String {
    match found {
        Unexpected::Bool(b) => b.to_string(),
        Unexpected::Unsigned(i) => i.to_string(),
        Unexpected::Signed(i) => i.to_string(),
        Unexpected::Float(x) => format!("{x:?}"),
        Unexpected::Str(s) => format!("\"{}\"", quoted(s).trim_matches('`')),
        Unexpected::Unit | Unexpected::Option => "null".to_string(),
        Unexpected::Seq => "a list".to_string(),
        Unexpected::Map => "a table".to_string(),
        other => one_line(&other.to_string()),
    }
}
