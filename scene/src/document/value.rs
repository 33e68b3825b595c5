//! The tree that a scene file is read into: values and keys that know where they were written.

use super::source::Span;

/// Nesting beyond this is refused: nobody writes it, deep trees exhaust the stack, and TOML's parser ends at 80.
pub(super) const DEEPEST: usize = 64;

/// A value in a scene file.
#[derive(Clone, Debug, PartialEq)]
pub struct Value {
    /// What it is.
    pub kind: Kind,
    /// Where it was written. A table made of several lines has the place of its header.
    pub span: Span,
    /// If it came in for a `"$name"`, where that stands.
    pub used: Option<Span>,
}

/// What a value is.
#[derive(Clone, Debug, PartialEq)]
pub enum Kind {
    /// JSON's `null`: as if the key were absent.
    Null,
    /// `true` or `false`.
    Bool(bool),
    /// A whole number, as written: without point and exponent.
    Integer(i64),
    /// Any other number; always finite.
    Float(f64),
    /// A text.
    String(String),
    /// A list.
    Array(Vec<Value>),
    /// Keys with values.
    Table(Table),
}

/// A key and where it was written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Key {
    /// The key itself, unquoted.
    pub name: String,
    /// Where it was written first.
    pub span: Span,
}

/// Keys with values, in the order of the file; no key occurs twice.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table(pub(super) Vec<(Key, Value)>);

impl Value {
    pub(super) fn new(kind: Kind, span: Span) -> Self {
        Self { kind, span, used: None }
    }

    /// The table, if it is one.
    #[must_use]
    pub fn as_table(&self) -> Option<&Table> {
        if let Kind::Table(table) = &self.kind { Some(table) } else { None }
    }

    /// The text, if it is one.
    #[must_use]
    pub fn as_str(&self) -> Option<&str> {
        if let Kind::String(text) = &self.kind { Some(text) } else { None }
    }

    /// What it is, in words with article.
    #[must_use]
    pub fn describe(&self) -> &'static str {
        match self.kind {
            Kind::Null => "null",
            Kind::Bool(_) => "a boolean",
            Kind::Integer(_) | Kind::Float(_) => "a number",
            Kind::String(_) => "a text",
            Kind::Array(_) => "a list",
            Kind::Table(_) => "a table",
        }
    }

    /// The value at a path below this one, or the nearest one above it that exists: `[0].section.ea`.
    pub(super) fn nearest(&self, path: &str) -> &Self {
        let mut here = self;
        for step in steps(path) {
            match here.step(step) {
                Some(value) => here = value,
                None => break,
            }
        }
        here
    }

    /// The value at a path below this one.
    pub(super) fn find(&self, path: &str) -> Option<&Self> {
        steps(path).try_fold(self, |here, step| here.step(step))
    }

    /// Puts a value at a path below this one, and makes the tables on the way that aren't there. Says whether there
    /// was a way: lists are never made longer.
    pub(super) fn put(&mut self, path: &str, value: Self) -> bool {
        let mut here = self;
        for step in steps(path) {
            let span = here.span;
            here = match (&mut here.kind, step.strip_suffix(']').map(str::parse::<usize>)) {
                (Kind::Array(list), Some(Ok(i))) if i < list.len() => &mut list[i],
                (Kind::Table(table), None) => {
                    let at = table.0.iter().position(|(key, _)| key.name == step).unwrap_or_else(|| {
                        let key = Key { name: step.to_string(), span };
                        table.0.push((key, Self::new(Kind::Table(Table::default()), span)));
                        table.0.len() - 1
                    });
                    &mut table.0[at].1
                }
                _ => return false,
            };
        }
        *here = value;
        true
    }

    /// The value one step below this one: `section`, or `0]`.
    fn step(&self, step: &str) -> Option<&Self> {
        match (&self.kind, step.strip_suffix(']').map(str::parse::<usize>)) {
            (Kind::Array(list), Some(Ok(i))) => list.get(i),
            (Kind::Table(table), None) => table.get(step),
            _ => None,
        }
    }

    /// Levels below and including this one, and a measure of the memory that a copy would take.
    pub(super) fn depth_and_size(&self) -> (usize, usize) {
        const EACH: usize = size_of::<Value>();
        let fold = |(depth, size): (usize, usize), (d, s): (usize, usize)| (depth.max(d + 1), size + s);
        match &self.kind {
            Kind::String(text) => (1, EACH + text.len()),
            Kind::Array(list) => list.iter().map(Self::depth_and_size).fold((1, EACH), fold),
            Kind::Table(table) => {
                let entries =
                    table.iter().map(|(k, v)| (k.name.len() + size_of::<Key>(), v.depth_and_size()));
                entries.map(|(k, (d, s))| (d, s + k)).fold((1, EACH), fold)
            }
            _ => (1, EACH),
        }
    }
}

fn steps(path: &str) -> impl Iterator<Item = &str> {
    path.split(['.', '[']).filter(|s| !s.is_empty())
}

impl Table {
    /// The value of a key.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<&Value> {
        self.entry(name).map(|(_, value)| value)
    }

    pub(super) fn entry(&self, name: &str) -> Option<&(Key, Value)> {
        self.0.iter().find(|(key, _)| key.name == name)
    }

    /// Keys and values in the order of the file.
    #[must_use]
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &(Key, Value)> {
        self.0.iter()
    }

    pub(super) fn remove(&mut self, name: &str) -> Option<(Key, Value)> {
        let at = self.0.iter().position(|(key, _)| key.name == name)?;
        Some(self.0.remove(at))
    }
}
