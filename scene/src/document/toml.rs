//! TOML text to a tree of values.

use super::fault::{Fault, one_line, quoted};
use super::source::{Sources, Span, boundary};
use super::value::{DEEPEST, Key, Kind, Table, Value};
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue, Error};

/// Parses a whole file, which already is source number `source`.
pub(super) fn parse(text: &str, source: usize, sources: &Sources) -> Result<Value, Fault> {
    let reader = Reader { text, source, shift: 0, sources };
    let root = DeTable::parse(text).map_err(|e| reader.syntax(&e))?;
    reader.value(Spanned::new(0..0, DeValue::Table(root.into_inner())), 0)
}

/// Parses the single value that begins at byte `shift` of a source and goes to its end; none if it isn't TOML.
pub(super) fn parse_value(
    text: &str,
    shift: usize,
    source: usize,
    sources: &Sources,
) -> Option<Result<Value, Fault>> {
    let value = DeValue::parse(&text[shift..]).ok()?;
    if matches!(value.get_ref(), DeValue::Datetime(_)) {
        return None;
    }
    Some(Reader { text, source, shift, sources }.value(value, 0))
}

struct Reader<'a> {
    text: &'a str,
    source: usize,
    shift: usize,
    sources: &'a Sources,
}

impl Reader<'_> {
    fn span(&self, range: &Range<usize>) -> Span {
        Span::new(self.source, range.start + self.shift..range.end + self.shift)
    }

    fn fault(&self, message: impl Into<String>, range: &Range<usize>) -> Fault {
        Fault::at(message, self.span(range), self.sources)
    }

    fn value(&self, value: Spanned<DeValue<'_>>, depth: usize) -> Result<Value, Fault> {
        let range = value.span();
        if depth > DEEPEST {
            return Err(self.fault("nested too deeply", &range));
        }
        let kind = match value.into_inner() {
            DeValue::Boolean(b) => Kind::Bool(b),
            DeValue::String(s) => Kind::String(s.into_owned()),
            DeValue::Integer(i) => match i64::from_str_radix(i.as_str(), i.radix()) {
                Ok(i) => Kind::Integer(i),
                Err(_) => {
                    return Err(self
                        .fault("a whole number too large to be kept exactly", &range)
                        .with_help("write it with a decimal point or an exponent if it need not be exact"));
                }
            },
            DeValue::Float(x) => match x.as_str().parse::<f64>() {
                Ok(x) if x.is_finite() => Kind::Float(x),
                _ => {
                    return Err(
                        self.fault(format!("{} is not a finite number", one_line(x.as_str())), &range)
                    );
                }
            },
            DeValue::Datetime(_) => {
                return Err(self
                    .fault("a date or time of day has no meaning in a scene", &range)
                    .with_help("write a text in quotes, or a time as in \"20 s\""));
            }
            DeValue::Array(list) => {
                Kind::Array(list.into_iter().map(|v| self.value(v, depth + 1)).collect::<Result<_, _>>()?)
            }
            DeValue::Table(table) => {
                let entry = |(key, value): (Spanned<_>, _)| {
                    let span = self.span(&key.span());
                    let key: std::borrow::Cow<'_, str> = key.into_inner();
                    Ok((Key { name: key.into_owned(), span }, self.value(value, depth + 1)?))
                };
                let mut entries = table.into_iter().map(entry).collect::<Result<Vec<_>, Fault>>()?;
                // the parser sorts by name, we want the order of the file
                entries.sort_by_key(|(key, _)| key.span.start);
                Kind::Table(Table(entries))
            }
        };
        Ok(Value::new(kind, self.span(&range)))
    }

    fn syntax(&self, error: &Error) -> Fault {
        let range = error.span().unwrap_or(0..0);
        let at = self.text.get(range.clone()).unwrap_or_default();
        // where the parser's own words would puzzle
        let message = match error.message() {
            "duplicate key" => format!("duplicate key {}", quoted(at)),
            m if m.starts_with("string values must be quoted") && at.is_empty() => {
                "missing value after `=`".into()
            }
            m if m.starts_with("string values must be quoted") => "a text has to stand in quotes".into(),
            m => one_line(m.trim_end_matches(", expected nothing")),
        };
        let mut fault = self.fault(message, &range);
        fault.help = self.unquoted_quantity(range.start);
        fault
    }

    /// `length = 30 m` is what everybody writes first.
    fn unquoted_quantity(&self, at: usize) -> Option<String> {
        let at = boundary(self.text, at);
        let from = self.text[..at].rfind('\n').map_or(0, |i| i + 1);
        let line = self.text[from..].lines().next()?;
        let (_, right) = line.split_once('=')?;
        let quantity = right.split('#').next()?.trim();
        let number = quantity.find(|c: char| !(c.is_ascii_digit() || "+-.eE_".contains(c)))?;
        let (number, unit) = quantity.split_at(number);
        let unit_like = |c: char| c.is_alphabetic() || " ^*/()·²³°%-0123456789".contains(c);
        let named = unit.trim_start().starts_with(|c: char| c.is_alphabetic() || "°%".contains(c));
        let fits = named
            && number.trim_end_matches(['e', 'E']).parse::<f64>().is_ok()
            && unit.chars().all(unit_like);
        fits.then(|| format!("a quantity with a unit stands in quotes: \"{quantity}\""))
    }
}
