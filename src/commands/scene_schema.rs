//! `ropewalk schema`: one JSON schema of whole scene files, for editors.
//!
//! Editors see a scene before parameters are put in, so that anything may also be `"$name"`, a formula or a choice.

use super::{Exit, say};
use ropewalk_report::write_atomic;
use ropewalk_scene::schemars::Schema;
use ropewalk_scene::{SECTIONS, lists, registered};
pub use ropewalk_studies::Error;
use serde_json::{Map, Value, json};
use std::path::PathBuf;

/// The name under which [`new`](super::new) puts it beside a scene.
pub(super) const FILE: &str = "scene.schema.json";

/// Where the schema goes.
#[derive(Debug, clap::Args)]
pub(crate) struct SchemaArgs {
    /// The file; replaces an earlier one [default: standard output]
    #[arg(long, short, value_name = "FILE")]
    out: Option<PathBuf>,
}

pub(crate) fn schema(args: &SchemaArgs) -> Result<Exit, Error> {
    match &args.out {
        Some(path) => write_atomic(path, &text())?,
        None => say(text().trim_end()),
    }
    Ok(Exit::Done)
}

/// The schema as a file.
pub(super) fn text() -> String {
    format!("{}\n", whole())
}

/// The title that all of them begin with.
const TITLE: &str = "A scene of Ropewalk";

/// Whether a file is a schema of this program, of whichever version.
pub(super) fn is_one(text: &str) -> bool {
    let schema: Option<Value> = serde_json::from_str(text).ok();
    schema.is_some_and(|s| s.get("title").and_then(Value::as_str).is_some_and(|t| t.starts_with(TITLE)))
}

/// What a list holds.
const ABOUT: [(&str, &str); 7] = [
    ("elements", "What has mass: cables, bodies and chains."),
    ("constraints", "What holds, joins or drives markers, and what feeds cable."),
    ("forces", "What acts on everything or on what `on` names, and between markers."),
    ("motions", "Ways over time that constraints follow, by name."),
    ("records", "What is written down: columns of the history, each with a picture."),
    ("controllers", "What sets an input by what records show, at regular instants."),
    ("processes", "Problems with equations of their own."),
];

/// The schema of a scene.
pub(super) fn whole() -> Value {
    let mut definitions = Map::new();
    let parameter = json!({
        "description": "A parameter, `\"$name\"`; a formula of parameters, `\"2 * $name\"`; or one of several values that a parameter \
                        chooses, `{ choose = \"$name\", a = 1, otherwise = 2 }`.",
        "anyOf": [{"type": "string", "pattern": "\\$"}, {"type": "object", "required": ["choose"]}]
    });
    definitions.insert("parameter".into(), parameter);
    let mut fields = Map::new();
    for (name, field) in heads() {
        fields.insert(name.into(), field);
    }
    for (name, make) in SECTIONS {
        let section = taken(make(), name, &mut definitions);
        let about = section.get("description").cloned().unwrap_or_default();
        definitions.insert(name.into(), section);
        fields.insert(name.into(), json!({"description": about, "$ref": format!("#/$defs/{name}")}));
    }
    for (list, about) in ABOUT {
        let mut types = Vec::new();
        for s in registered().into_iter().filter(|s| s.kind.list() == list) {
            let name = format!("{list}.{}", s.name);
            let one = of_type(s.name, taken((s.schema)(), &name, &mut definitions));
            definitions.insert(name.clone(), one);
            types.push(json!({"$ref": format!("#/$defs/{name}")}));
        }
        // any of them: where one field of a part is wrong, editors still know the others
        fields.insert(list.into(), json!({"description": about, "type": "array", "items": {"anyOf": types}}));
    }
    for (list, make) in lists() {
        let one = taken(make(), list, &mut definitions);
        let about = one.get("description").cloned().unwrap_or_default();
        definitions.insert(list.into(), one);
        let items = json!({"$ref": format!("#/$defs/{list}")});
        fields.insert(list.into(), json!({"description": about, "type": "array", "items": items}));
    }
    json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": format!("{TITLE} {}", env!("CARGO_PKG_VERSION")),
        "type": "object",
        "additionalProperties": false,
        "properties": fields,
        "$defs": definitions
    })
}

/// What stands at the top of a scene.
fn heads() -> [(&'static str, Value); 4] {
    let parameter = json!({
        "description": "Its default, or `{ default = …, description = \"…\" }`.",
        "anyOf": [
            {
                "type": "object",
                "required": ["default"],
                "properties": {
                    "default": {"description": "Value unless it is set: a number, a text, a list, a table."},
                    "description": {"description": "What it means, for `ropewalk describe`.", "type": "string"}
                },
                "additionalProperties": false
            },
            true
        ]
    });
    let gravity = json!({
        "description": "Acceleration of free fall [m/s²]. Default: 9.81 m/s² downwards, along z.",
        "type": "array", "minItems": 3, "maxItems": 3, "items": {"type": ["number", "string"]}
    });
    [
        ("title", json!({"description": "Title, on one line.", "type": "string"})),
        (
            "description",
            json!({"description": "What the scene shows, for `ropewalk describe`.", "type": "string"}),
        ),
        (
            "parameters",
            json!({
                "description": "What `--set NAME=VALUE` and sweeps change; `\"$name\"` stands for it anywhere in the scene.",
                "type": "object",
                "additionalProperties": parameter
            }),
        ),
        ("gravity", or_parameter(gravity)),
    ]
}

/// A type with the field that names it.
fn of_type(name: &str, mut schema: Value) -> Value {
    let about = schema.get("description").cloned().unwrap_or_default();
    let mut fields = Map::new();
    fields.insert("type".into(), json!({"const": name, "description": about}));
    if let Some(Value::Object(own)) = schema.get("properties") {
        fields.extend(own.clone());
    }
    let mut required = vec![json!("type")];
    required.extend(schema.get("required").and_then(Value::as_array).into_iter().flatten().cloned());
    schema["properties"] = fields.into();
    schema["required"] = required.into();
    schema
}

/// A schema without its definitions, which go among the others under names of their own.
fn taken(schema: Schema, name: &str, definitions: &mut Map<String, Value>) -> Value {
    let mut schema = schema.to_value();
    let Some(map) = schema.as_object_mut() else { return schema };
    map.remove("$schema");
    map.remove("title");
    let own = map.remove("$defs");
    for (key, value) in own.as_ref().and_then(Value::as_object).into_iter().flatten() {
        definitions.insert(format!("{name}.{key}"), opened(renamed(value, name)));
    }
    opened(renamed(&schema, name))
}

/// With references to definitions under their new names.
fn renamed(value: &Value, name: &str) -> Value {
    match value {
        Value::Object(map) => {
            let of = |(key, value): (&String, &Value)| match (key.as_str(), value.as_str()) {
                ("$ref", Some(path)) => {
                    (key.clone(), json!(path.replacen("#/$defs/", &format!("#/$defs/{name}."), 1)))
                }
                _ => (key.clone(), renamed(value, name)),
            };
            Value::Object(map.iter().map(of).collect())
        }
        Value::Array(list) => list.iter().map(|one| renamed(one, name)).collect(),
        other => other.clone(),
    }
}

/// A schema whose fields and entries may be parameters.
fn opened(mut schema: Value) -> Value {
    let Some(map) = schema.as_object_mut() else { return schema };
    // formats of binary numbers are nothing that editors know
    map.remove("format");
    for (key, value) in map.iter_mut() {
        match (key.as_str(), &mut *value) {
            ("properties", Value::Object(fields)) => {
                fields.values_mut().for_each(|field| *field = or_parameter(opened(field.take())));
            }
            ("items" | "additionalProperties", Value::Object(_)) => {
                *value = or_parameter(opened(value.take()))
            }
            ("prefixItems", Value::Array(list)) => {
                list.iter_mut().for_each(|one| *one = or_parameter(opened(one.take())));
            }
            ("anyOf" | "oneOf" | "allOf", Value::Array(list)) => {
                list.iter_mut().for_each(|one| *one = opened(one.take()));
            }
            _ => {}
        }
    }
    schema
}

/// What may stand there, or a parameter.
fn or_parameter(schema: Value) -> Value {
    let Value::Object(mut map) = schema else { return schema };
    let parameter = json!({"$ref": "#/$defs/parameter"});
    let mut out = Map::new();
    for key in ["description", "default"] {
        if let Some(value) = map.remove(key) {
            out.insert(key.into(), value);
        }
    }
    let any = match map.remove("anyOf") {
        Some(Value::Array(mut list)) if map.is_empty() => {
            list.push(parameter);
            list
        }
        // what has other conditions besides stays one
        Some(any) => {
            map.insert("anyOf".into(), any);
            vec![map.into(), parameter]
        }
        None => vec![map.into(), parameter],
    };
    out.insert("anyOf".into(), any.into());
    out.into()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Follows all references and counts the fields that say nothing.
    fn visit(at: &str, value: &Value, root: &Value, silent: &mut Vec<String>) {
        if let Some(path) = value.get("$ref").and_then(Value::as_str) {
            assert!(root.pointer(path.trim_start_matches('#')).is_some(), "{at}: no {path}");
        }
        for (name, field) in value.get("properties").and_then(Value::as_object).into_iter().flatten() {
            let of = |v: &Value| v.get("description").and_then(Value::as_str).is_some_and(|d| !d.is_empty());
            let target = |v: &Value| {
                let path =
                    v.get("$ref").and_then(Value::as_str).map(|p| p.trim_start_matches('#').to_string());
                path.and_then(|p| root.pointer(&p)).is_some_and(of)
            };
            let inner = field.get("anyOf").and_then(Value::as_array).into_iter().flatten();
            let inside = inner.filter(|v| v.get("$ref") != Some(&json!("#/$defs/parameter"))).any(target);
            if !of(field) && !inside {
                silent.push(format!("{at}.{name}"));
            }
        }
        match value {
            Value::Object(map) => map.iter().for_each(|(k, v)| visit(&format!("{at}.{k}"), v, root, silent)),
            Value::Array(list) => list.iter().for_each(|v| visit(at, v, root, silent)),
            _ => {}
        }
    }

    #[test]
    fn every_reference_leads_somewhere_and_fields_are_explained() {
        let schema = whole();
        let mut silent = Vec::new();
        visit("", &schema, &schema, &mut silent);
        // the variants of an enum are explained as such
        silent.retain(|at| !at.contains("oneOf") && !at.contains("anyOf"));
        assert!(silent.is_empty(), "{silent:?}");
        for s in registered() {
            let path = format!("/$defs/{}.{}/properties/type/const", s.kind.list(), s.name);
            assert_eq!(schema.pointer(&path), Some(&json!(s.name)));
        }
        assert!(registered().iter().all(|s| ABOUT.iter().any(|a| a.0 == s.kind.list())));
    }

    #[test]
    fn what_may_stand_somewhere_may_be_a_parameter() {
        let schema = whole();
        let elements = schema.pointer("/$defs/elements.cable/properties/elements/anyOf").unwrap();
        assert_eq!(elements.as_array().unwrap().last().unwrap(), &json!({"$ref": "#/$defs/parameter"}));
    }
}
