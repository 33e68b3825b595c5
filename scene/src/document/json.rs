//! JSON text to a tree of values.

use super::fault::{Fault, one_line, quoted};
use super::source::{Sources, Span, boundary};
use super::value::{DEEPEST, Key, Kind, Table, Value};
use jsonc_parser::ast::Value as Ast;
use jsonc_parser::common::{Range, Ranged};
use jsonc_parser::{CollectOptions, ParseOptions, parse_to_ast};
use std::collections::HashMap;

/// Parses a whole file, which already is source number `source`.
pub(super) fn parse(text: &str, source: usize, sources: &Sources) -> Result<Value, Fault> {
    let fault =
        |message: &str, start, end| Fault::at(one_line(message), Span::new(source, start..end), sources);
    // serde_json knows what is JSON and says what isn't; the other parser is laxer, but knows where things stand
    if let Err(e) = serde_json::from_str::<serde::de::IgnoredAny>(text) {
        let message = e.to_string();
        let message = message.split(" at line ").next().unwrap_or_default();
        let start = offset(text, e.line(), e.column());
        return Err(fault(message, start, start + 1));
    }
    let ast = parse_to_ast(text, &CollectOptions::default(), &ParseOptions::default());
    let ast = ast.map_err(|e| fault(&e.kind().to_string(), e.range().start, e.range().end))?;
    let Some(root) = ast.value else { return Err(fault("no value", 0, 0)) };
    if !matches!(root, Ast::Object(_)) {
        return Err(fault("a scene is a JSON object: `{ ... }`", root.range().start, root.range().end));
    }
    Reader { source, sources }.value(root, 0)
}

/// Byte offset of a line and column, both from 1, the column in bytes.
fn offset(text: &str, line: usize, column: usize) -> usize {
    let before: usize = text.split_inclusive('\n').take(line.saturating_sub(1)).map(str::len).sum();
    boundary(text, before + column.saturating_sub(1))
}

struct Reader<'a> {
    source: usize,
    sources: &'a Sources,
}

impl Reader<'_> {
    fn span(&self, range: Range) -> Span {
        Span::new(self.source, range.start..range.end)
    }

    fn value(&self, ast: Ast<'_>, depth: usize) -> Result<Value, Fault> {
        let span = self.span(ast.range());
        if depth > DEEPEST {
            return Err(Fault::at("nested too deeply", span, self.sources));
        }
        let kind = match ast {
            Ast::NullKeyword(_) => Kind::Null,
            Ast::BooleanLit(b) => Kind::Bool(b.value),
            Ast::StringLit(s) => Kind::String(s.value.into_owned()),
            Ast::NumberLit(n) => match (n.value.parse::<i64>(), n.value.parse::<f64>()) {
                (Ok(i), _) => Kind::Integer(i),
                (_, Ok(x)) if x.is_finite() => Kind::Float(x),
                _ => {
                    return Err(Fault::at(
                        format!("{} is not a finite number", quoted(n.value)),
                        span,
                        self.sources,
                    ));
                }
            },
            Ast::Array(list) => {
                let mut values = Vec::with_capacity(list.elements.len());
                for element in list.elements {
                    let value = self.value(element, depth + 1)?;
                    // TOML can't say it, and no list of a scene has holes
                    if value.kind == Kind::Null {
                        return Err(Fault::at("`null` has no meaning in a list", value.span, self.sources));
                    }
                    values.push(value);
                }
                Kind::Array(values)
            }
            Ast::Object(object) => {
                let (mut entries, mut seen) = (Vec::with_capacity(object.properties.len()), HashMap::new());
                for property in object.properties {
                    let span = self.span(property.name.range());
                    let name = property.name.into_string();
                    if let Some(first) = seen.insert(name.clone(), span) {
                        let fault = Fault::at(format!("duplicate key {}", quoted(&name)), span, self.sources);
                        return Err(match self.sources.place(first) {
                            Some(p) => {
                                fault.with_note(format!("first at {}:{}:{}", p.file, p.line, p.column))
                            }
                            None => fault,
                        });
                    }
                    entries.push((Key { name, span }, self.value(property.value, depth + 1)?));
                }
                Kind::Table(Table(entries))
            }
        };
        Ok(Value::new(kind, span))
    }
}
