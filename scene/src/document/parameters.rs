//! Named values that a scene uses in several places or that change from run to run.
//!
//! ```toml
//! [parameters]
//! speed = { default = "25 kn", description = "towing speed" }
//! length = "30 m"                     # short for { default = "30 m" }
//!
//! [water]
//! current = ["$speed", 0, 0]
//! ```
//!
//! A text that is `$` and a name stands for the parameter's value, whatever that is: a number, a list, a table. `$$` at
//! the beginning of a text is a literal dollar sign. Formulas calculate with units: `"-$load"`, `"2 * $length / 3"`.
//!
//! A table with `choose` stands for one of its other values, that under the name that `choose` has; for a
//! quantity in any unit, and for a number without unit in SI:
//!
//! ```toml
//! duration = { choose = "$speed", "25 kn" = "4 s", "15 kn" = "6 s", otherwise = "20 s" }
//! ```

use super::fault::{Fault, did_you_mean, expected, quoted};
use super::formula;
use super::source::{Sources, Span};
use super::toml;
use super::value::{DEEPEST, Key, Kind, Table, Value};
use ropewalk_quantity::Written;
use std::collections::HashMap;
use std::fmt::Write;

/// The table that declares parameters.
pub(super) const TABLE: &str = "parameters";

/// What makes a table stand for one of its values, and the one that it stands for if no other fits.
const CHOOSE: &str = "choose";
const OTHERWISE: &str = "otherwise";

/// Fields of a parameter that is written as a table.
const FIELDS: [&str; 2] = ["default", "description"];

/// A parameter of a scene, with the value that it has in this run.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Name, as in `"$name"`.
    pub name: String,
    /// What it is, for people.
    pub description: Option<String>,
    /// Its value: the default or what it was set to.
    pub value: Value,
    /// Whether the value was set from outside.
    pub set: bool,
    /// Whether the scene uses it, directly or by way of other parameters. One that it would use if it had chosen otherwise
    /// counts too, unless it was set, which then has no effect.
    pub used: bool,
}

/// Takes the declarations out of the document, applies the overrides (`name=value`) and replaces every use.
pub(super) fn resolve(
    root: &mut Table,
    overrides: &[String],
    sources: &mut Sources,
) -> Result<Vec<Parameter>, Fault> {
    let mut definitions = match root.remove(TABLE) {
        Some((_, value)) => definitions(value, sources)?,
        None => Vec::new(),
    };
    for text in overrides {
        set(&mut definitions, text, sources)?;
    }
    let index = definitions.iter().enumerate().map(|(i, d)| (d.key.name.clone(), i)).collect();
    let mut r = Resolver {
        definitions,
        index,
        path: String::new(),
        busy: Vec::new(),
        level: 0,
        room: LARGEST,
        sources,
    };
    r.table(root)?;
    for definition in &mut r.definitions {
        definition.used = definition.done.is_some() || definition.passed_over && !definition.set;
    }
    // the others have to make sense as well
    for i in 0..r.definitions.len() {
        let span = r.definitions[i].key.span;
        r.definition(i, span)?;
    }
    let parameter = |d: Definition| {
        let value = d.done?.value;
        Some(Parameter { name: d.key.name, description: d.description, value, set: d.set, used: d.used })
    };
    Ok(r.definitions.into_iter().filter_map(parameter).collect())
}

#[derive(Debug)]
struct Definition {
    key: Key,
    description: Option<String>,
    written: Option<Value>,
    set: bool,
    /// Whether it stands in what `choose` didn't take.
    passed_over: bool,
    used: bool,
    done: Option<Done>,
}

/// A value with all parameters replaced, and what a copy of it costs.
#[derive(Debug)]
struct Done {
    value: Value,
    depth: usize,
    size: usize,
}

/// Whether two texts are the same value: but for spaces, or as quantities, where a bare number is in SI.
fn same(a: &str, b: &str) -> bool {
    let plain = |text: &str| text.chars().filter(|c| !c.is_whitespace()).collect::<String>();
    let quantities = Written::parse(a).zip(Written::parse(b));
    plain(a) == plain(b)
        || quantities.is_some_and(|(a, b)| {
            let fits = a.unit.is_empty() || b.unit.is_empty() || a.dimension == b.dimension;
            // units cost a digit or two
            fits && (a.si - b.si).abs() <= 1e-12 * a.si.abs()
        })
}

fn is_name(name: &str) -> bool {
    super::write::is_bare(name) && !name.starts_with(|c: char| c.is_ascii_digit() || c == '-')
}

fn definitions(declared: Value, sources: &Sources) -> Result<Vec<Definition>, Fault> {
    let span = declared.span;
    let Kind::Table(table) = declared.kind else {
        return Err(Fault::at("`parameters` has to be a table", span, sources).with_path(TABLE));
    };
    table.0.into_iter().map(|(key, value)| definition(key, value, sources)).collect()
}

fn definition(key: Key, value: Value, sources: &Sources) -> Result<Definition, Fault> {
    let path = format!("{TABLE}.{}", key.name);
    let fault = |message: String, span| Fault::at(message, span, sources).with_path(&path);
    if !is_name(&key.name) {
        return Err(fault(format!("{} is no name for a parameter", quoted(&key.name)), key.span)
            .with_path(TABLE)
            .with_help("a name consists of letters, digits, `_` and `-`, and begins with a letter or `_`"));
    }
    let mut d = Definition {
        key,
        description: None,
        written: None,
        set: false,
        passed_over: false,
        used: false,
        done: None,
    };
    let Kind::Table(mut table) = value.kind else {
        d.written = Some(value).filter(|v| v.kind != Kind::Null);
        return Ok(d);
    };
    d.written = table.remove("default").map(|(_, value)| value).filter(|v| v.kind != Kind::Null);
    match table.remove("description").map(|(_, value)| (value.span, value.kind)) {
        Some((_, Kind::String(text))) => d.description = Some(text),
        Some((span, kind)) if kind != Kind::Null => {
            return Err(fault("a description is a text in quotes".into(), span));
        }
        _ => {}
    }
    match table.0.first() {
        Some((key, _)) => {
            Err(fault(format!("unknown field {}, {}", quoted(&key.name), expected(&FIELDS)), key.span)
                .with_help(did_you_mean(&key.name, &FIELDS).unwrap_or_else(|| {
                    "a parameter that is a table itself stands in `default = { ... }`".into()
                })))
        }
        None => Ok(d),
    }
}

/// Gives a parameter another value: `speed=30 kn`, `count=3`, `from=[0, 0, "2 m"]`.
fn set(definitions: &mut [Definition], text: &str, sources: &mut Sources) -> Result<(), Fault> {
    let source = sources.add("--set", text);
    let span = |start, end| Span::new(source, start..end);
    let Some(at) = text.find('=').filter(|at| !text[at + 1..].trim().is_empty()) else {
        return Err(Fault::at("expected `name=value`", span(0, text.len()), sources));
    };
    let name = text[..at].trim();
    let names: Vec<String> = definitions.iter().map(|d| d.key.name.clone()).collect();
    let Some(definition) = definitions.iter_mut().find(|d| d.key.name == name) else {
        let known = if names.is_empty() { "the scene has none".to_string() } else { expected(&names) };
        let mut fault =
            Fault::at(format!("unknown parameter {}, {known}", quoted(name)), span(0, at), sources);
        fault.help = did_you_mean(name, &names);
        return Err(fault);
    };
    let start = text.len() - text[at + 1..].trim_start().len();
    let end = text.trim_end().len();
    let value = match toml::parse_value(&text[..end], start, source, sources) {
        Some(value) => value.map_err(|fault| fault.with_path(format!("{TABLE}.{name}")))?,
        None => Value::new(Kind::String(text[start..end].to_string()), span(start, end)),
    };
    definition.written = Some(value);
    definition.set = true;
    Ok(())
}

/// Bytes that all copies of parameters may take together: lists of lists of lists multiply.
const LARGEST: usize = 64 << 20;

struct Resolver<'a> {
    definitions: Vec<Definition>,
    index: HashMap<String, usize>,
    path: String,
    /// Parameters whose values are being worked out, each used by the one before.
    busy: Vec<usize>,
    /// Values inside of values, through parameters as well: how deep the recursion is.
    level: usize,
    room: usize,
    sources: &'a Sources,
}

impl Resolver<'_> {
    fn fault(&self, message: impl Into<String>, span: Span) -> Fault {
        Fault::at(message, span, self.sources).with_path(self.path.clone())
    }

    fn table(&mut self, table: &mut Table) -> Result<(), Fault> {
        for (key, value) in &mut table.0 {
            let length = self.path.len();
            if length > 0 {
                self.path.push('.');
            }
            self.path.push_str(&key.name);
            self.value(value)?;
            self.path.truncate(length);
        }
        Ok(())
    }

    fn value(&mut self, value: &mut Value) -> Result<(), Fault> {
        self.level += 1;
        if self.level > 2 * DEEPEST {
            return Err(self.fault("parameters refer to parameters too deeply", value.span));
        }
        self.inside(value)?;
        self.level -= 1;
        Ok(())
    }

    fn inside(&mut self, value: &mut Value) -> Result<(), Fault> {
        match &mut value.kind {
            Kind::Table(table) if table.get(CHOOSE).is_some() => {
                *value = self.chosen(std::mem::take(table), value.span)?;
                Ok(())
            }
            Kind::Table(table) => self.table(table),
            Kind::Array(list) => {
                for (i, value) in list.iter_mut().enumerate() {
                    let length = self.path.len();
                    // writing to a string can't fail
                    _ = write!(self.path, "[{i}]");
                    self.value(value)?;
                    self.path.truncate(length);
                }
                Ok(())
            }
            Kind::String(text) if text.starts_with("$$") => {
                text.remove(0);
                Ok(())
            }
            Kind::String(text) if text.contains('$') => {
                if let Some(found) = self.replaced(text, value.span)? {
                    *value = found;
                }
                Ok(())
            }
            _ => Ok(()),
        }
    }

    /// What stands in place of a text that holds a dollar sign; nothing if it is just a text.
    fn replaced(&mut self, text: &str, span: Span) -> Result<Option<Value>, Fault> {
        let name = text.strip_prefix('$').filter(|name| is_name(name));
        if let Some(name) = name.filter(|name| self.index.contains_key(*name)) {
            return self.used(name, span).map(Some);
        }
        let found = formula::of(text, &|name| self.index.contains_key(name));
        let found =
            found.filter(|f| name.is_none() || formula::parameters(f).all(|n| self.index.contains_key(n)));
        let Some(found) = found else {
            return text.strip_prefix('$').map(|name| self.used(name, span)).transpose();
        };
        let values = formula::parameters(&found).map(|name| self.used(name, span));
        let values = values.collect::<Result<Vec<_>, _>>()?;
        let kind = formula::value(text, &found, &values).map_err(|message| self.fault(message, span))?;
        Ok(Some(Value::new(kind, span)))
    }

    /// The value of a table with `choose`.
    fn chosen(&mut self, mut table: Table, span: Span) -> Result<Value, Fault> {
        let Some((key, mut by)) = table.remove(CHOOSE) else {
            return Err(self.fault("nothing to choose", span));
        };
        self.value(&mut by)?;
        let wanted = match &by.kind {
            Kind::String(text) => text.clone(),
            Kind::Integer(x) => x.to_string(),
            Kind::Float(x) => x.to_string(),
            Kind::Bool(x) => x.to_string(),
            _ => return Err(self.fault("`choose` takes a text or a number", key.span)),
        };
        let names: Vec<String> = table.iter().map(|(key, _)| key.name.clone()).collect();
        let fits = names.iter().find(|n| same(n, &wanted)).map_or(OTHERWISE, String::as_str);
        let Some((_, mut value)) = table.remove(fits) else {
            let message = format!("there is nothing to choose for {}, {}", quoted(&wanted), expected(&names));
            let help = format!("add it, or `{OTHERWISE}` for all that isn't named");
            return Err(self.fault(message, key.span).with_help(help));
        };
        self.pass_over(Value::new(Kind::Table(table), span));
        self.value(&mut value)?;
        Ok(value)
    }

    /// Notes the parameters in a value that isn't taken, and those in their values.
    fn pass_over(&mut self, value: Value) {
        let mut values = vec![value];
        while let Some(value) = values.pop() {
            match value.kind {
                Kind::Table(table) => values.extend(table.0.into_iter().map(|(_, value)| value)),
                Kind::Array(list) => values.extend(list),
                Kind::String(text) => {
                    let own = text.strip_prefix('$').filter(|name| self.index.contains_key(*name));
                    let found = formula::of(&text, &|name| self.index.contains_key(name));
                    let names = found.iter().flat_map(formula::parameters);
                    for name in own.into_iter().chain(names.filter(|_| own.is_none())) {
                        let i = self.index.get(name).copied();
                        let definition = i.map(|i| &mut self.definitions[i]).filter(|d| !d.passed_over);
                        if let Some(definition) = definition {
                            definition.passed_over = true;
                            values.extend(definition.written.clone());
                        }
                    }
                }
                _ => {}
            }
        }
    }

    fn used(&mut self, name: &str, span: Span) -> Result<Value, Fault> {
        if !is_name(name) {
            return Err(self.fault(format!("{} is no name of a parameter", quoted(&format!("${name}"))), span).with_help(
                "`$name` stands for a value, also in a formula such as `2 * $name`, and can't be part of another text; a \
                 literal `$` at the beginning is `$$`",
            ));
        }
        let Some(&i) = self.index.get(name) else {
            let mut names: Vec<&str> = self.definitions.iter().map(|d| d.key.name.as_str()).collect();
            names.sort_unstable();
            let known = if names.is_empty() { "the scene has none".to_string() } else { expected(&names) };
            let help = did_you_mean(name, &names).unwrap_or_else(|| {
                format!("declare it in `[{TABLE}]`, or write `$$` for a literal dollar sign")
            });
            return Err(self
                .fault(format!("unknown parameter {}, {known}", quoted(name)), span)
                .with_help(help));
        };
        self.definition(i, span)?;
        let Some(done) = &self.definitions[i].done else {
            return Err(self.fault("a parameter without value", span));
        };
        if self.room < done.size || done.depth > DEEPEST {
            return Err(self.fault("parameters in parameters grow beyond all measure", span));
        }
        self.room -= done.size;
        Ok(Value { used: Some(span), ..done.value.clone() })
    }

    /// Works out the value of a parameter that is used at `span`.
    fn definition(&mut self, i: usize, span: Span) -> Result<(), Fault> {
        if self.definitions[i].done.is_some() {
            return Ok(());
        }
        let name = self.definitions[i].key.name.clone();
        if let Some(from) = self.busy.iter().position(|b| *b == i) {
            let round = self.busy[from..].iter().chain([&i]).map(|b| self.definitions[*b].key.name.as_str());
            let round = round.collect::<Vec<_>>().join(" -> ");
            return Err(self.fault(format!("parameter {} refers to itself: {round}", quoted(&name)), span));
        }
        let Some(mut value) = self.definitions[i].written.clone() else {
            let key = self.definitions[i].key.span;
            let path = format!("{TABLE}.{name}");
            return Err(Fault::at(format!("parameter {} has no value", quoted(&name)), key, self.sources)
                .with_path(path)
                .with_help(format!("give it a `default`, or set it with `--set {name}=...`")));
        };
        self.busy.push(i);
        let path = std::mem::replace(&mut self.path, format!("{TABLE}.{name}"));
        self.value(&mut value)?;
        self.path = path;
        self.busy.pop();
        let (depth, size) = value.depth_and_size();
        self.definitions[i].done = Some(Done { value, depth, size });
        Ok(())
    }
}
