//! A JSON schema in words: what can be written, with units, defaults and the doc comments of the source.

use super::wrapped;
use ropewalk_scene::quantity::unit_of;
use ropewalk_scene::schemars::Schema;
use serde_json::Value;

/// One line of an explanation: a field, or something that can be chosen for one.
struct Item {
    /// How deep it lies in the type.
    level: usize,
    /// Its name, as it is written.
    name: String,
    /// What stands there and whether it has to; nothing for a choice.
    kind: Option<String>,
    /// Its doc comment.
    doc: String,
}

/// Description and fields of a type, for a terminal.
pub(super) fn explain(schema: &Schema) -> String {
    let (about, items) = items(schema);
    let mut out = about.map_or_else(String::new, |text| format!("{}\n", wrapped(&text, 0)));
    for item in items {
        let indent = 2 + 4 * item.level;
        match (item.kind, item.doc.is_empty()) {
            (Some(kind), _) => {
                out += &format!("{:indent$}{}: {kind}\n", "", item.name);
                out += &wrapped(&item.doc, indent + 4);
            }
            (None, true) => out += &wrapped(&item.name, indent),
            (None, false) => out += &wrapped(&format!("{}: {}", item.name, item.doc), indent),
        }
    }
    out
}

/// The same as Markdown: a paragraph or more, then a list.
pub(super) fn markdown(schema: &Schema) -> String {
    let (about, items) = items(schema);
    let mut out = about.map_or_else(String::new, |text| format!("{}\n\n", text.trim_end()));
    for item in items {
        let indent = 2 * item.level;
        let doc = item.doc.split_whitespace().collect::<Vec<_>>().join(" ");
        let head = format!("{:indent$}- `{}`", "", item.name);
        out += &match (item.kind, doc.is_empty()) {
            (Some(kind), true) => format!("{head}: {kind}\n"),
            (Some(kind), false) => format!("{head}: {kind}. {doc}\n"),
            (None, true) => format!("{head}\n"),
            (None, false) => format!("{head}: {doc}\n"),
        };
    }
    out
}

fn items(schema: &Schema) -> (Option<String>, Vec<Item>) {
    let root = schema.as_value();
    let mut out = Vec::new();
    Words { root }.fields(&mut out, root, 0, 0);
    (description(root).map(plain), out)
}

struct Words<'a> {
    root: &'a Value,
}

impl<'a> Words<'a> {
    /// The fields of a table, each with those of the tables inside.
    fn fields(&self, out: &mut Vec<Item>, schema: &'a Value, level: usize, depth: usize) {
        let Some(fields) = schema.get("properties").and_then(Value::as_object) else { return };
        let required = |name: &str| {
            let list = schema.get("required").and_then(Value::as_array);
            list.is_some_and(|list| list.iter().any(|r| r == name))
        };
        for (name, field) in fields {
            let inner = self.resolved(field);
            let doc = description(field).or_else(|| description(inner)).unwrap_or_default();
            let mut kind = self.kind(field, doc);
            match field.get("default").filter(|d| !d.is_null()).and_then(short) {
                Some(default) => kind += &format!(", default {default}"),
                None if required(name) => kind += ", required",
                None => kind += ", optional",
            }
            out.push(Item { level, name: name.clone(), kind: Some(kind), doc: plain(doc) });
            if depth < 3 {
                // of a list, what each of its entries holds
                let inner = inner.get("items").map_or(inner, |one| self.resolved(one));
                self.fields(out, inner, level + 1, depth + 1);
                self.choices(out, inner, level + 1, depth + 1);
            }
        }
    }

    /// The variants of an enum that have a doc comment or fields.
    fn choices(&self, out: &mut Vec<Item>, schema: &'a Value, level: usize, depth: usize) {
        for variant in variants(schema) {
            let doc = plain(description(variant).unwrap_or_default());
            for name in names(variant) {
                out.push(Item { level, name: format!("\"{name}\""), kind: None, doc: doc.clone() });
                if let Some(fields) = variant.get("properties").and_then(|p| p.get(&name)) {
                    self.fields(out, self.resolved(fields), level + 1, depth + 1);
                }
            }
        }
    }

    /// Follows a reference, and looks through the `null` of an option.
    fn resolved(&self, schema: &'a Value) -> &'a Value {
        let mut here = schema;
        for _ in 0..8 {
            let target = here.get("$ref").and_then(Value::as_str).and_then(|r| r.strip_prefix('#'));
            if let Some(target) = target.and_then(|path| self.root.pointer(path)) {
                here = target;
            } else if let Some(all) = here.get("allOf").and_then(Value::as_array).and_then(|a| a.first()) {
                here = all;
            } else if let Some(one) = optional(here) {
                here = one;
            } else {
                break;
            }
        }
        here
    }

    /// What stands there, in words.
    fn kind(&self, field: &'a Value, doc: &str) -> String {
        let s = self.resolved(field);
        let unit = unit_of(doc);
        if let Some(number) = or_input(s) {
            return format!("{}, or an input", self.kind(number, doc));
        }
        let names: Vec<String> =
            variants(s).into_iter().flat_map(names).map(|n| format!("\"{n}\"")).collect();
        if !names.is_empty() {
            // an enum may also take what isn't a name
            let other =
                |v: &&'a Value| self::names(v).is_empty() && !type_of(v).is_empty() && type_of(v) != "null";
            let others = s.get("anyOf").and_then(Value::as_array).into_iter().flatten().filter(other);
            let others: String =
                others.map(|v| format!(" or {}", self.kind(v, description(v).unwrap_or(doc)))).collect();
            return format!("one of {}{others}", names.join(", "));
        }
        match type_of(s) {
            "number" => match unit {
                Some(unit) => format!("number in {unit}, or text with a unit"),
                None => "number".into(),
            },
            "integer" => "whole number".into(),
            "string" => "text".into(),
            "boolean" => "true or false".into(),
            "array" => {
                let list = |key| s.get(key).and_then(Value::as_u64);
                let items = s.get("items").or_else(|| s.get("prefixItems").and_then(|p| p.get(0)));
                let items = items.map_or("any".into(), |i| self.kind(i, doc));
                match (list("minItems"), list("maxItems")) {
                    (Some(n), Some(m)) if n == m => format!("list of {n}, each {items}"),
                    _ => format!("list, each {items}"),
                }
            }
            "object" => "table".into(),
            _ => match s.get("anyOf").and_then(Value::as_array) {
                Some(any) => any.iter().map(|one| self.kind(one, doc)).collect::<Vec<_>>().join(" or "),
                None => "any".into(),
            },
        }
    }
}

fn description(schema: &Value) -> Option<&str> {
    schema.get("description").and_then(Value::as_str)
}

/// The type, or the one of two that isn't `null`.
fn type_of(schema: &Value) -> &str {
    match schema.get("type") {
        Some(Value::String(one)) => one,
        Some(Value::Array(many)) => {
            many.iter().filter_map(Value::as_str).find(|t| *t != "null").unwrap_or("")
        }
        _ => "",
    }
}

/// The number of what may be an input instead.
fn or_input(schema: &Value) -> Option<&Value> {
    let any = schema.get("anyOf")?.as_array()?;
    let input = any.iter().any(|one| one.pointer("/properties/input").is_some());
    any.iter().find(|one| type_of(one) == "number").filter(|_| input)
}

/// What an option holds.
fn optional(schema: &Value) -> Option<&Value> {
    let any = schema.get("anyOf")?.as_array()?;
    let mut some = any.iter().filter(|one| type_of(one) != "null" && one.get("type") != Some(&"null".into()));
    match (some.next(), some.next(), any.len()) {
        (Some(one), None, 2) => Some(one),
        _ => None,
    }
}

/// The variants of an enum.
fn variants(schema: &Value) -> Vec<&Value> {
    if or_input(schema).is_some() {
        return Vec::new();
    }
    let list = schema.get("oneOf").or_else(|| schema.get("anyOf")).and_then(Value::as_array);
    match list {
        Some(list) => list.iter().filter(|v| !names(v).is_empty()).collect(),
        None if schema.get("enum").is_some() => vec![schema],
        None => Vec::new(),
    }
}

/// What a variant is called in a scene; one without fields and doc comment may share its entry with others.
fn names(variant: &Value) -> Vec<String> {
    let text = |v: &Value| v.as_str().map(str::to_string);
    if let Some(one) = variant.get("const").and_then(text) {
        return vec![one];
    }
    if let Some(many) = variant.get("enum").and_then(Value::as_array) {
        return many.iter().filter_map(text).collect();
    }
    match (variant.get("properties").and_then(Value::as_object), variant.get("required")) {
        (Some(fields), Some(_)) if fields.len() == 1 => fields.keys().cloned().collect(),
        _ => Vec::new(),
    }
}

/// A default, if it is short enough to be said.
fn short(default: &Value) -> Option<String> {
    let text = match default {
        Value::Array(list) if list.is_empty() => return Some("none".into()),
        Value::Object(table) if table.is_empty() => return None,
        other => toml(other),
    };
    (text.len() <= 60).then_some(text)
}

/// A value as one writes it in a scene.
fn toml(value: &Value) -> String {
    match value {
        Value::Array(list) => format!("[{}]", list.iter().map(toml).collect::<Vec<_>>().join(", ")),
        Value::Object(table) => {
            let entries: Vec<String> = table.iter().map(|(k, v)| format!("{k} = {}", toml(v))).collect();
            format!("{{ {} }}", entries.join(", "))
        }
        other => other.to_string(),
    }
}

/// A doc comment without what is for programmers: links that only rustdoc can follow, ``[`Name`]`` and
/// ``[`Name`](path)``, and programs between fences.
pub(super) fn plain(doc: &str) -> String {
    let prose: String = doc.split("```").step_by(2).map(str::trim_end).collect();
    let mut out = String::new();
    let mut rest = prose.as_str();
    while let Some((before, link)) = rest.split_once("[`") {
        let Some((name, after)) = link.split_once("`]") else { break };
        out += &format!("{before}`{name}`");
        let target = after.strip_prefix('(').and_then(|a| a.split_once(')'));
        rest = target.map_or(after, |(_, after)| after);
    }
    out + rest
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn links_of_rustdoc_become_names() {
        let doc = "Sum [N], see [`Term`], [`Drag`](crate::Drag) and [`open.";
        assert_eq!(plain(doc), "Sum [N], see `Term`, `Drag` and [`open.");
        assert_eq!(plain("A run.\n\n```\nlet a = 1;\n```\n\nMore."), "A run.\n\nMore.");
    }

    /// Values for a field, each with one quantity that is written as `describe` promises.
    fn tried(words: &Words<'_>, field: &Value, doc: &str) -> Vec<Value> {
        let s = words.resolved(field);
        let mut all = Vec::new();
        for variant in variants(s) {
            for name in names(variant) {
                if let Some(inner) = variant.get("properties").and_then(|p| p.get(&name)) {
                    all.extend(tried(words, inner, doc).into_iter().map(|t| json!({ &name: t })));
                }
            }
        }
        if !all.is_empty() || !variants(s).is_empty() {
            return all;
        }
        match (type_of(s), unit_of(doc)) {
            ("number", Some(unit)) => all.push(json!(format!("0.25 {unit}"))),
            ("array", _) => {
                let items = s.get("items").or_else(|| s.get("prefixItems").and_then(|p| p.get(0)));
                let n = s.get("minItems").and_then(Value::as_u64).unwrap_or(1) as usize;
                let list = |t| Value::Array(vec![t; n.max(1)]);
                all.extend(items.map_or(Vec::new(), |i| tried(words, i, doc)).into_iter().map(list));
            }
            ("object", _) => {
                for (name, field) in s.get("properties").and_then(Value::as_object).into_iter().flatten() {
                    let inner = words.resolved(field);
                    let doc = description(field).or_else(|| description(inner)).unwrap_or_default();
                    all.extend(tried(words, field, doc).into_iter().map(|t| json!({ name: t })));
                }
                if let Some(of) = s.get("additionalProperties").filter(|of| of.is_object()) {
                    let doc = description(words.resolved(of)).unwrap_or(doc);
                    all.extend(tried(words, of, doc).into_iter().map(|t| json!({ "a": t })));
                }
            }
            _ => {
                let any = s.get("anyOf").and_then(Value::as_array);
                all.extend(any.into_iter().flatten().flat_map(|one| tried(words, one, doc)));
            }
        }
        all
    }

    #[test]
    fn every_quantity_may_be_a_text_with_its_unit() {
        use ropewalk_scene::Format;
        use ropewalk_scene::SceneFile;
        let types = ropewalk_scene::registered().into_iter().map(|s| (Some(s), s.name, (s.schema)()));
        let sections = ropewalk_scene::SECTIONS.iter().map(|(name, schema)| (None, *name, schema()));
        let (mut count, mut wrong) = (0, Vec::new());
        for (spec, name, schema) in types.chain(sections) {
            let root = schema.as_value();
            for mut value in tried(&Words { root }, root, "") {
                let scene = match spec {
                    Some(s) => {
                        value["type"] = json!(name);
                        json!({ s.kind.list(): [value] })
                    }
                    None => json!({ name: value }),
                };
                count += 1;
                let text = scene.to_string();
                // what else is missing doesn't matter
                let refused = SceneFile::parse(&text, "s", Format::Json, &[]).err().map(|f| f.message);
                let refused = refused.filter(|m| m.contains("0.25 ") || m.contains("did not match"));
                wrong.extend(refused.map(|message| format!("{text}: {message}")));
            }
        }
        assert!(wrong.is_empty(), "{}", wrong.join("\n"));
        assert!(count > 200, "{count}");
    }

    #[test]
    fn defaults_are_toml() {
        let value = json!({ "fixed": { "h": 0.001, "on": ["a", 1] } });
        assert_eq!(short(&value).unwrap(), "{ fixed = { h = 0.001, on = [\"a\", 1] } }");
    }
}
