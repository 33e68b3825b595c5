//! The tree as a serde data source whose failures know their place.
//!
//! A part of a scene is a `Box<dyn Trait>` read through typetag, hence through erased-serde, which reduces an error to
//! its text as soon as it leaves a value. So the place is not kept in the error but beside it: the deepest value whose
//! reading fails notes itself in a [`Trace`], and every list and table on the way out adds its step to the path.
//!
//! Two rules are added to serde's own. A key that nothing reads is an error, whether or not the struct says
//! `deny_unknown_fields`. And a trait object or an enum may be written with a `type` beside its fields,
//! `{ type = "cable", length = 3 }`, which serde sees as `{ cable = { length = 3 } }`.

mod access;
mod problem;

use super::fault::Fault;
use super::source::{Sources, Span};
use super::value::{Key, Kind, Table, Value};
use access::{Entries, Items, Tagged, Variant};
use problem::Problem;
use serde::de::{DeserializeOwned, DeserializeSeed, Deserializer, Error as _, Expected, Unexpected, Visitor};
use serde::forward_to_deserialize_any;
use std::cell::RefCell;

/// The key that says which type of part a table describes.
const TYPE: &str = "type";

/// Whether a table is one thing or a choice by its `type`.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Form {
    Plain,
    Tagged,
}

/// Reads a value as a `T`; `path` is what the value is called in messages.
pub(super) fn read<T: DeserializeOwned>(
    value: &Value,
    form: Form,
    path: &str,
    sources: &Sources,
) -> Result<T, Fault> {
    let trace = Trace::default();
    let node = Node { form, ..Node::new(value, &trace) };
    T::deserialize(node).map_err(|problem| {
        trace.note(problem, value.span);
        trace.leave(None, value.used);
        let found = trace.0.take().unwrap_or_default();
        let path = found.path(path);
        let mut fault = Fault::at(found.problem.message, found.span, sources).with_path(path);
        fault.help = found.problem.help;
        if let Some(p) = found.used.and_then(|span| sources.place(span)) {
            let name: String = p.excerpt.chars().skip(p.mark).take(p.width).collect();
            fault = fault.with_note(format!("used as {name} at {}:{}:{}", p.file, p.line, p.column));
        }
        fault
    })
}

/// A step from a value to one inside.
enum Step<'a> {
    Key(&'a str),
    Index(usize),
}

/// The first failure, while it travels outwards.
#[derive(Default)]
struct Found {
    problem: Problem,
    span: Span,
    used: Option<Span>,
    /// Steps from the inside to the outside.
    steps: Vec<String>,
    /// It is about a key, which is said of the key's table: the step to its value is left out.
    about_key: bool,
}

impl Found {
    fn path(&self, start: &str) -> String {
        let path = self.steps.iter().rev().fold(start.to_string(), |path, step| path + step);
        path.strip_prefix('.').map(str::to_string).unwrap_or(path)
    }
}

#[derive(Default)]
struct Trace(RefCell<Option<Found>>);

impl Trace {
    /// Notes a failure unless one further inside is noted already.
    fn note(&self, problem: Problem, span: Span) {
        self.0.borrow_mut().get_or_insert_with(|| Found { problem, span, ..Found::default() });
    }

    /// Notes that nothing wants this key.
    fn note_key(&self, problem: Problem, key: &Key) {
        let mut found = self.0.borrow_mut();
        found.get_or_insert_with(|| Found { problem, span: key.span, about_key: true, ..Found::default() });
    }

    /// Something was read after all: what failed inside was only tried.
    fn clear(&self) {
        *self.0.borrow_mut() = None;
    }

    /// The failure leaves a value that is found by this step from outside, and that came in at `used`.
    fn leave(&self, step: Option<Step<'_>>, used: Option<Span>) {
        if let Some(found) = self.0.borrow_mut().as_mut() {
            if std::mem::take(&mut found.about_key) {
                return;
            }
            found.used = found.used.or(used);
            match step {
                Some(Step::Key(name)) if super::write::is_bare(name) => found.steps.push(format!(".{name}")),
                Some(Step::Key(name)) => found.steps.push(format!(".{}", super::write::text(name))),
                Some(Step::Index(i)) => found.steps.push(format!("[{i}]")),
                None => {}
            }
        }
    }
}

/// A value to be read.
#[derive(Clone, Copy)]
struct Node<'a> {
    value: &'a Value,
    trace: &'a Trace,
    form: Form,
    /// A key of the table that has been read already: its `type`.
    skip: Option<&'static str>,
    /// The key that leads here and the fields that its table may have, to be said if nobody wants the value.
    field: Option<(&'a Key, &'static [&'static str])>,
}

impl<'a> Node<'a> {
    fn new(value: &'a Value, trace: &'a Trace) -> Self {
        Self { value, trace, form: Form::Plain, skip: None, field: None }
    }

    /// Every way out of a value leads through here.
    fn done<T>(self, result: Result<T, Problem>) -> Result<T, Problem> {
        match result {
            Ok(x) => {
                self.trace.clear();
                Ok(x)
            }
            Err(problem) => {
                // from a flattened or buffered struct the complaint about a key comes late
                let key =
                    self.value.as_table().zip(problem.field.as_deref()).and_then(|(t, name)| t.entry(name));
                self.trace.note(problem.clone(), key.map_or(self.value.span, |(key, _)| key.span));
                Err(problem)
            }
        }
    }

    /// Reads this value by a seed, one step inside of another value.
    fn enter<S: DeserializeSeed<'a>>(self, seed: S, step: Option<Step<'_>>) -> Result<S::Value, Problem> {
        let result = self.done(seed.deserialize(self));
        if result.is_err() {
            self.trace.leave(step, self.value.used);
        }
        result
    }

    fn any<V: Visitor<'a>>(self, visitor: V, fields: &'static [&'static str]) -> Result<V::Value, Problem> {
        match &self.value.kind {
            Kind::Null => visitor.visit_unit(),
            Kind::Bool(b) => visitor.visit_bool(*b),
            Kind::Integer(i) => visitor.visit_i64(*i),
            Kind::Float(x) => visitor.visit_f64(*x),
            Kind::String(s) => visitor.visit_borrowed_str(s),
            Kind::Array(list) => {
                let mut items = Items::new(list, self.trace);
                let x = visitor.visit_seq(&mut items)?;
                items.finish().map(|()| x)
            }
            Kind::Table(table) => {
                let mut entries = Entries::new(table, self, fields);
                let x = visitor.visit_map(&mut entries)?;
                entries.finish().map(|()| x)
            }
        }
    }

    /// The table as `{ type: rest }`.
    fn tagged<V: Visitor<'a>>(self, table: &'a Table, visitor: V) -> Result<V::Value, Problem> {
        visitor.visit_map(Tagged::new(table, self))
    }

    fn whole<V: Visitor<'a>>(self, visitor: V) -> Result<V::Value, Problem> {
        match self.value.kind {
            // JSON writers turn 20 into 20.0; beyond 2^53 a float is no exact count
            Kind::Float(x) if x.fract() == 0.0 && x.abs() <= 9_007_199_254_740_992.0 => {
                self.done(visitor.visit_i64(x as i64))
            }
            _ => self.deserialize_any(visitor),
        }
    }
}

/// typetag reads a trait object by `deserialize_map` and calls it `dyn Trait`; nothing else tells it from a map.
fn is_trait_object<'de, V: Visitor<'de>>(visitor: &V) -> bool {
    (visitor as &dyn Expected).to_string().starts_with("dyn ")
}

macro_rules! whole_numbers {
    ($($method:ident)*) => { $(
        fn $method<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Problem> {
            self.whole(visitor)
        }
    )* };
}

impl<'de> Deserializer<'de> for Node<'de> {
    type Error = Problem;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Problem> {
        self.done(self.any(visitor, &[]))
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _name: &'static str,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Problem> {
        self.done(match &self.value.kind {
            // serde would take the fields in order from a list, which nobody means
            Kind::Array(_) => Err(Problem::invalid_type(Unexpected::Seq, &visitor)),
            _ => self.any(visitor, fields),
        })
    }

    fn deserialize_map<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Problem> {
        match &self.value.kind {
            Kind::Table(table) if self.form == Form::Tagged || is_trait_object(&visitor) => {
                self.done(self.tagged(table, visitor))
            }
            _ => self.deserialize_any(visitor),
        }
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _name: &'static str,
        names: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Problem> {
        let result = match &self.value.kind {
            Kind::String(name) => Ok(Variant::unit(name, self)),
            Kind::Table(table) => Variant::of_table(table, self, names),
            _ => Err(Problem::unfit(self.value.describe(), names)),
        };
        self.done(result.and_then(|variant| visitor.visit_enum(variant)))
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Problem> {
        self.done(if self.value.kind == Kind::Null { visitor.visit_none() } else { visitor.visit_some(self) })
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        _name: &'static str,
        visitor: V,
    ) -> Result<V::Value, Problem> {
        self.done(visitor.visit_newtype_struct(self))
    }

    fn deserialize_unit_struct<V: Visitor<'de>>(
        self,
        _name: &'static str,
        visitor: V,
    ) -> Result<V::Value, Problem> {
        match &self.value.kind {
            // `type = "gravity"` and nothing else
            Kind::Table(table) => {
                self.done(Entries::new(table, self, &[]).finish().and_then(|()| visitor.visit_unit()))
            }
            _ => self.deserialize_any(visitor),
        }
    }

    fn deserialize_ignored_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Problem> {
        match self.field {
            Some((key, fields)) => {
                let problem = Problem::unknown_field(&key.name, fields);
                self.trace.note_key(problem.clone(), key);
                Err(problem)
            }
            None => self.done(visitor.visit_unit()),
        }
    }

    whole_numbers! {
        deserialize_i8 deserialize_i16 deserialize_i32 deserialize_i64 deserialize_i128
        deserialize_u8 deserialize_u16 deserialize_u32 deserialize_u64 deserialize_u128
    }

    forward_to_deserialize_any! {
        bool f32 f64 char str string bytes byte_buf unit seq tuple tuple_struct identifier
    }
}
