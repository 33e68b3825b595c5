//! Lists, tables and choices of the tree, as serde walks through them.

use super::{Form, Node, Problem, Step, TYPE, Trace};
use crate::document::source::Span;
use crate::document::value::{Key, Kind, Table, Value};
use serde::de::{DeserializeSeed, Deserializer, EnumAccess, MapAccess, SeqAccess, VariantAccess, Visitor};
use serde::de::{Error as _, value::StrDeserializer};
use serde::forward_to_deserialize_any;

/// The entries of a list.
pub(super) struct Items<'a> {
    list: &'a [Value],
    next: usize,
    trace: &'a Trace,
}

impl<'a> Items<'a> {
    pub(super) fn new(list: &'a [Value], trace: &'a Trace) -> Self {
        Self { list, next: 0, trace }
    }

    /// Fails if entries are left: a point has three coordinates, not four.
    pub(super) fn finish(&self) -> Result<(), Problem> {
        if self.next == self.list.len() {
            return Ok(());
        }
        Err(Problem::custom(format_args!("expected a list of {}, found {}", self.next, self.list.len())))
    }
}

impl<'a> SeqAccess<'a> for &mut Items<'a> {
    type Error = Problem;

    fn next_element_seed<S: DeserializeSeed<'a>>(&mut self, seed: S) -> Result<Option<S::Value>, Problem> {
        let Some(value) = self.list.get(self.next) else { return Ok(None) };
        self.next += 1;
        Node::new(value, self.trace).enter(seed, Some(Step::Index(self.next - 1))).map(Some)
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.list.len() - self.next)
    }
}

/// The keys and values of a table.
pub(super) struct Entries<'a> {
    rest: std::slice::Iter<'a, (Key, Value)>,
    value: Option<&'a (Key, Value)>,
    node: Node<'a>,
    fields: &'static [&'static str],
}

impl<'a> Entries<'a> {
    pub(super) fn new(table: &'a Table, node: Node<'a>, fields: &'static [&'static str]) -> Self {
        Self { rest: table.0.iter(), value: None, node, fields }
    }

    fn next(&mut self) -> Option<&'a (Key, Value)> {
        let (skip, fields) = (self.node.skip, self.fields);
        self.rest.find(|(key, value)| {
            let name = key.name.as_str();
            // null is as good as nothing, but for a key that could not be there anyway
            let absent = value.kind == Kind::Null && (fields.is_empty() || fields.contains(&name));
            skip != Some(name) && !absent
        })
    }

    /// Fails if keys are left.
    pub(super) fn finish(&mut self) -> Result<(), Problem> {
        let Some((key, _)) = self.next() else { return Ok(()) };
        let problem = Problem::unknown_field(&key.name, self.fields);
        self.node.trace.note(problem.clone(), key.span);
        Err(problem)
    }
}

impl<'a> MapAccess<'a> for &mut Entries<'a> {
    type Error = Problem;

    fn next_key_seed<S: DeserializeSeed<'a>>(&mut self, seed: S) -> Result<Option<S::Value>, Problem> {
        self.value = self.next();
        let Some((key, _)) = self.value else { return Ok(None) };
        seed.deserialize(Name { name: &key.name, span: key.span, trace: self.node.trace, role: Role::Key })
            .map(Some)
    }

    fn next_value_seed<S: DeserializeSeed<'a>>(&mut self, seed: S) -> Result<S::Value, Problem> {
        let Some((key, value)) = self.value.take() else {
            return Err(Problem::custom("a value without a key"));
        };
        let node = Node { field: Some((key, self.fields)), ..Node::new(value, self.node.trace) };
        node.enter(seed, Some(Step::Key(&key.name)))
    }
}

/// A table with a `type`, as a map of one entry: `{ type: all the rest }`.
pub(super) struct Tagged<'a> {
    tag: Option<&'a (Key, Value)>,
    node: Node<'a>,
    read: bool,
}

impl<'a> Tagged<'a> {
    pub(super) fn new(table: &'a Table, node: Node<'a>) -> Self {
        Self { tag: table.entry(TYPE), node, read: false }
    }
}

impl<'a> MapAccess<'a> for Tagged<'a> {
    type Error = Problem;

    fn next_key_seed<S: DeserializeSeed<'a>>(&mut self, seed: S) -> Result<Option<S::Value>, Problem> {
        if self.read {
            return Ok(None);
        }
        self.read = true;
        let trace = self.node.trace;
        let name = match self.tag {
            Some((_, tag)) => {
                Name { name: type_name(tag, trace)?, span: tag.span, trace, role: Role::Type(tag.used) }
            }
            // asking for a type that can't exist is how to learn which ones do
            None => Name { name: "", span: self.node.value.span, trace, role: Role::NoType },
        };
        seed.deserialize(name).map(Some)
    }

    fn next_value_seed<S: DeserializeSeed<'a>>(&mut self, seed: S) -> Result<S::Value, Problem> {
        Node { form: Form::Plain, skip: Some(TYPE), field: None, ..self.node }.enter(seed, None)
    }
}

fn type_name<'a>(tag: &'a Value, trace: &Trace) -> Result<&'a str, Problem> {
    tag.as_str().ok_or_else(|| {
        let problem = Problem::custom(format_args!("expected the name of a type, found {}", tag.describe()));
        trace.note(problem.clone(), tag.span);
        trace.leave(Some(Step::Key(TYPE)), tag.used);
        problem
    })
}

/// One of several things: a bare name, `{ name = content }`, or a table with a `type`.
pub(super) struct Variant<'a> {
    name: &'a str,
    span: Span,
    node: Node<'a>,
    content: Content,
}

#[derive(PartialEq, Eq)]
enum Content {
    /// `"name"`: nothing beside the name.
    Nothing,
    /// `{ type = "name", ... }`: the node itself.
    Rest,
    /// `{ name = content }`: the node is the content.
    Inside,
}

impl<'a> Variant<'a> {
    pub(super) fn unit(name: &'a str, node: Node<'a>) -> Self {
        Self { name, span: node.value.span, node, content: Content::Nothing }
    }

    pub(super) fn of_table(
        table: &'a Table,
        node: Node<'a>,
        names: &'static [&'static str],
    ) -> Result<Self, Problem> {
        match (table.entry(TYPE), table.0.as_slice()) {
            (Some((_, tag)), _) => {
                let name = type_name(tag, node.trace)?;
                let node = Node { form: Form::Plain, skip: Some(TYPE), field: None, ..node };
                Ok(Self { name, span: tag.span, node, content: Content::Rest })
            }
            (None, [(key, value)]) if names.contains(&key.name.as_str()) => {
                let node = Node::new(value, node.trace);
                Ok(Self { name: &key.name, span: key.span, node, content: Content::Inside })
            }
            _ => Err(Problem::missing_type(names)),
        }
    }

    /// Notes what went wrong inside before somebody forgets half of it.
    fn leave<T>(&self, result: Result<T, Problem>) -> Result<T, Problem> {
        result.inspect_err(|problem| {
            self.node.trace.note(problem.clone(), self.node.value.span);
            if self.content == Content::Inside {
                self.node.trace.leave(Some(Step::Key(self.name)), self.node.value.used);
            }
        })
    }

    fn filled(&self) -> Result<(), Problem> {
        let result =
            if self.content == Content::Nothing { Err(Problem::needs_fields(self.name)) } else { Ok(()) };
        self.leave(result)
    }
}

impl<'a> EnumAccess<'a> for Variant<'a> {
    type Error = Problem;
    type Variant = Self;

    fn variant_seed<S: DeserializeSeed<'a>>(self, seed: S) -> Result<(S::Value, Self), Problem> {
        let role = if self.content == Content::Rest { Role::Type(None) } else { Role::Key };
        let name =
            seed.deserialize(Name { name: self.name, span: self.span, trace: self.node.trace, role })?;
        Ok((name, self))
    }
}

impl<'a> VariantAccess<'a> for Variant<'a> {
    type Error = Problem;

    fn unit_variant(self) -> Result<(), Problem> {
        let result = match (&self.content, &self.node.value.kind) {
            (Content::Nothing, _) => Ok(()),
            (_, Kind::Table(table)) => Entries::new(table, self.node, &[]).finish(),
            _ => Err(Problem::custom(format_args!("`{}` has no values of its own", self.name))),
        };
        self.leave(result)
    }

    fn newtype_variant_seed<S: DeserializeSeed<'a>>(self, seed: S) -> Result<S::Value, Problem> {
        self.filled()?;
        self.leave(seed.deserialize(self.node))
    }

    fn tuple_variant<V: Visitor<'a>>(self, length: usize, visitor: V) -> Result<V::Value, Problem> {
        self.filled()?;
        self.leave(self.node.deserialize_tuple(length, visitor))
    }

    fn struct_variant<V: Visitor<'a>>(
        self,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Problem> {
        self.filled()?;
        self.leave(self.node.deserialize_struct("", fields, visitor))
    }
}

/// A key, or the name of one of several things.
struct Name<'a> {
    name: &'a str,
    span: Span,
    trace: &'a Trace,
    role: Role,
}

/// What a name is, for complaints about it.
#[derive(Clone, Copy)]
enum Role {
    Key,
    /// The value of the key `type`, and where it came in if from a parameter.
    Type(Option<Span>),
    /// A stand-in for a missing `type`.
    NoType,
}

impl Name<'_> {
    /// Notes a complaint here, because erased-serde takes its details away as soon as it returns.
    fn noting<T>(trace: &Trace, span: Span, role: Role, result: Result<T, Problem>) -> Result<T, Problem> {
        result.inspect_err(|problem| {
            let problem = problem.clone();
            match role {
                Role::Key => trace.note(problem, span),
                Role::Type(used) => {
                    trace.note(problem.of_type(), span);
                    trace.leave(Some(Step::Key(TYPE)), used);
                }
                Role::NoType => {
                    trace.note(Problem::missing_type(problem.variant.map_or(&[], |(_, names)| names)), span);
                }
            }
        })
    }
}

impl<'de> Deserializer<'de> for Name<'de> {
    type Error = Problem;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Problem> {
        Self::noting(self.trace, self.span, self.role, visitor.visit_borrowed_str(self.name))
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        _name: &'static str,
        visitor: V,
    ) -> Result<V::Value, Problem> {
        visitor.visit_newtype_struct(self)
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _name: &'static str,
        _variants: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Problem> {
        let variant = StrDeserializer::<Problem>::new(self.name);
        Self::noting(self.trace, self.span, self.role, visitor.visit_enum(variant))
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf option unit unit_struct
        seq tuple tuple_struct map struct identifier ignored_any
    }
}
