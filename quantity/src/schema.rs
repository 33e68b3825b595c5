//! What JSON schemas say of quantities.

use schemars::transform::Transform;
use schemars::{JsonSchema, Schema, SchemaGenerator, generate::SchemaSettings};
use serde_json::{Value, json};

/// The unit that a doc comment ends its first paragraph with: `Stiffness [N/m].`
///
/// ```
/// use ropewalk_quantity::unit_of;
/// assert_eq!(unit_of("Stiffness [N/m]."), Some("N/m"));
/// assert_eq!((unit_of("Share of it [1]."), unit_of("A name.")), (None, None));
/// ```
pub fn unit_of(doc: &str) -> Option<&str> {
    let first = doc.split("\n\n").next()?;
    let start = first.rfind('[')?;
    let unit = first[start + 1..].split(']').next()?;
    let like_unit = !unit.is_empty() && unit.len() < 24 && !unit.contains([',', '`', '<', '(', '-', ')']);
    (like_unit && unit != "1").then_some(unit)
}

/// Makes a schema accept what is read: where the doc comment of a field names a unit, a number may be a text that brings
/// its own, such as `"25 kn"`.
///
/// Values are those after parameters are put in: what `"$name"` stands for.
#[derive(Clone, Copy, Debug, Default)]
pub struct TextsWithUnits;

impl TextsWithUnits {
    /// The schema of a type, made so.
    pub fn schema_for<T: JsonSchema>() -> Schema {
        let settings = SchemaSettings::draft2020_12().with_transform(TextsWithUnits);
        SchemaGenerator::new(settings).into_root_schema_for::<T>()
    }
}

impl Transform for TextsWithUnits {
    fn transform(&mut self, schema: &mut Schema) {
        let mut root = std::mem::take(schema).to_value();
        let definitions = root.get("$defs").cloned().unwrap_or_default();
        accept(&mut root, "", &definitions);
        for (_, definition) in root.get_mut("$defs").and_then(Value::as_object_mut).into_iter().flatten() {
            accept(definition, "", &definitions);
        }
        *schema = Schema::try_from(root).unwrap_or_default();
    }
}

/// Goes through a schema with the doc comment that holds for it.
fn accept(schema: &mut Value, around: &str, definitions: &Value) {
    let Some(map) = schema.as_object_mut() else { return };
    let own = map.get("description").and_then(Value::as_str).map(str::to_string);
    let doc =
        own.filter(|own| unit_of(own).is_some() || around.is_empty()).unwrap_or_else(|| around.to_string());
    // what a field refers to has doc comments of its own, unless it is a bare number or list of numbers
    if let Some(name) = map.get("$ref").and_then(Value::as_str).and_then(|r| r.strip_prefix("#/$defs/")) {
        let target = definitions.get(name).filter(|d| is_bare(d) && unit_of(&doc).is_some());
        if let Some(mut target) = target.cloned() {
            map.remove("$ref");
            if let Some(target) = target.as_object_mut() {
                target.remove("description");
                map.append(target);
            }
        }
    }
    if unit_of(&doc).is_some() {
        let kind = map.get_mut("type");
        match kind {
            Some(Value::String(one)) if one == "number" => map["type"] = json!(["number", "string"]),
            Some(Value::Array(many))
                if many.contains(&json!("number")) && !many.contains(&json!("string")) =>
            {
                many.insert(1, json!("string"));
            }
            _ => {}
        }
        // formats of binary numbers mean nothing for texts
        if map.get("format") == Some(&json!("double")) {
            map.remove("format");
        }
    }
    for (key, value) in map.iter_mut() {
        match (key.as_str(), value) {
            ("properties", Value::Object(fields)) => {
                fields
                    .values_mut()
                    .for_each(|field| accept(field, &doc_of_variant(field, &doc), definitions));
            }
            ("items" | "additionalProperties", inner) => accept(inner, &doc, definitions),
            ("prefixItems" | "anyOf" | "oneOf" | "allOf", Value::Array(list)) => {
                list.iter_mut().for_each(|one| accept(one, &doc, definitions));
            }
            _ => {}
        }
    }
}

/// A field without doc comment is the value of a variant, whose doc comment holds for it.
fn doc_of_variant(field: &Value, around: &str) -> String {
    if field.get("description").is_some() { String::new() } else { around.to_string() }
}

/// A number, or a list of numbers, without fields.
fn is_bare(schema: &Value) -> bool {
    matches!(schema.get("type").and_then(Value::as_str), Some("number" | "array"))
        && schema.get("properties").is_none()
}
