//! Numbers that may be read from an input while a run goes on.

use super::{Dimension, Expression, Kind, One};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Serialize;
use serde::de::value::MapAccessDeserializer;
use serde::de::{DeserializeSeed, Deserializer, Error, IgnoredAny, MapAccess, SeqAccess, Visitor};
use serde::ser::{SerializeMap, Serializer};
use std::borrow::Cow;
use std::fmt;

/// A number in SI units, or the input that it is read from: `2.5`, `"25 kn"`, `{ input = "winch" }`.
///
/// ```
/// # use ropewalk_quantity as quantity;
/// #[derive(serde::Deserialize)]
/// struct Winch {
///     #[serde(deserialize_with = "quantity::setting::speed")]
///     speed: quantity::Setting,
/// }
/// let read = |text| serde_json::from_str::<Winch>(text).unwrap().speed;
/// assert_eq!(read(r#"{ "speed": "36 km/h" }"#), quantity::Setting::Number(10.0));
/// assert_eq!(read(r#"{ "speed": { "input": "winch" } }"#), quantity::Setting::Input("winch".into()));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub enum Setting {
    /// Always the same, in SI units.
    Number(f64),
    /// What the input of this name is set to.
    Input(String),
}

impl Setting {
    /// The number, if it always is the same.
    pub fn number(&self) -> Option<f64> {
        match self {
            Setting::Number(x) => Some(*x),
            Setting::Input(_) => None,
        }
    }
    /// Whether it is this number at all times.
    pub fn is(&self, x: f64) -> bool {
        self.number() == Some(x)
    }
}

impl Default for Setting {
    fn default() -> Self {
        Setting::Number(0.0)
    }
}

impl From<f64> for Setting {
    fn from(x: f64) -> Self {
        Setting::Number(x)
    }
}

impl Serialize for Setting {
    fn serialize<S: Serializer>(&self, s: S) -> Result<S::Ok, S::Error> {
        match self {
            Setting::Number(x) => s.serialize_f64(*x),
            Setting::Input(name) => {
                let mut map = s.serialize_map(Some(1))?;
                map.serialize_entry("input", name)?;
                map.end()
            }
        }
    }
}

impl JsonSchema for Setting {
    fn inline_schema() -> bool {
        true
    }
    fn schema_name() -> Cow<'static, str> {
        "Setting".into()
    }
    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "anyOf": [
                { "type": "number" },
                {
                    "type": "object",
                    "description": "The name of an input that the number is read from while the run goes on.",
                    "properties": { "input": { "type": "string" } },
                    "required": ["input"],
                    "additionalProperties": false
                }
            ]
        })
    }
}

/// Reads a setting of a kind.
#[derive(Clone, Copy)]
pub(super) struct Set(pub &'static Kind);

impl<'de> DeserializeSeed<'de> for Set {
    type Value = Setting;
    fn deserialize<D: Deserializer<'de>>(self, d: D) -> Result<Setting, D::Error> {
        d.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for Set {
    type Value = Setting;
    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}, or `{{ input = \"name\" }}`", self.0)
    }
    fn visit_f64<E: Error>(self, x: f64) -> Result<Setting, E> {
        One(self.0).visit_f64(x).map(Setting::Number)
    }
    fn visit_i64<E: Error>(self, x: i64) -> Result<Setting, E> {
        Ok(Setting::Number(x as f64))
    }
    fn visit_u64<E: Error>(self, x: u64) -> Result<Setting, E> {
        Ok(Setting::Number(x as f64))
    }
    fn visit_str<E: Error>(self, x: &str) -> Result<Setting, E> {
        One(self.0).visit_str(x).map(Setting::Number)
    }
    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Setting, A::Error> {
        #[derive(serde::Deserialize)]
        #[serde(deny_unknown_fields)]
        struct Read {
            input: String,
        }
        let read: Read = serde::Deserialize::deserialize(MapAccessDeserializer::new(map))?;
        Ok(Setting::Input(read.input))
    }
}

/// Reads a setting that may be left out.
pub(super) struct MaybeSet(pub Set);

impl<'de> Visitor<'de> for MaybeSet {
    type Value = Option<Setting>;
    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.expecting(f)
    }
    fn visit_none<E: Error>(self) -> Result<Self::Value, E> {
        Ok(None)
    }
    fn visit_unit<E: Error>(self) -> Result<Self::Value, E> {
        Ok(None)
    }
    fn visit_some<D: Deserializer<'de>>(self, d: D) -> Result<Self::Value, D::Error> {
        self.0.deserialize(d).map(Some)
    }
}

/// Reads three settings.
pub(super) struct ThreeSets(pub Set);

impl<'de> Visitor<'de> for ThreeSets {
    type Value = [Setting; 3];
    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "three entries, each {}, or `{{ input = \"name\" }}`", self.0.0)
    }
    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Self::Value, A::Error> {
        let mut v: [Setting; 3] = Default::default();
        for (i, x) in v.iter_mut().enumerate() {
            *x = seq.next_element_seed(self.0)?.ok_or_else(|| A::Error::invalid_length(i, &self))?;
        }
        let mut n = 3;
        while seq.size_hint() != Some(0) && seq.next_element::<IgnoredAny>()?.is_some() {
            n += 1;
        }
        if n == 3 { Ok(v) } else { Err(A::Error::invalid_length(n, &self)) }
    }
}

/// A number in SI units, or a text that says more: a number with a unit, or a formula. Of what kind it has to be is said
/// where it is used.
///
/// ```
/// # use ropewalk_quantity::Formula;
/// assert_eq!(Formula::from("25 kn").in_unit("m/s").map(f64::round), Ok(13.0));
/// assert_eq!(Formula::from(2.0).in_unit("m/s"), Ok(2.0));
/// assert!(Formula::from("25 kg").in_unit("m/s").is_err());
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
#[schemars(inline)]
pub enum Formula {
    /// A number in SI units.
    Number(f64),
    /// A number with a unit, or a formula.
    Text(String),
}

impl Formula {
    /// It as a number in a coherent unit, if it is a constant.
    ///
    /// # Errors
    /// It is no formula, holds names, is of another dimension, or no number.
    pub fn in_unit(&self, unit: &str) -> Result<f64, String> {
        let text = match self {
            Formula::Number(x) => return Ok(*x),
            Formula::Text(text) => text,
        };
        let e = Expression::parse(text, &|_| true).map_err(|e| format!("\"{text}\": {}", e.message))?;
        if let Some(name) = e.names().first() {
            return Err(format!("\"{text}\" is to be a number, and holds `{name}`"));
        }
        let of = e.dimension(&[]).map_err(|e| format!("\"{text}\": {}", e.message))?;
        let wanted = Dimension::of(unit).map_err(|what| format!("the unit \"{unit}\" {what}"))?;
        if of != wanted {
            let [of, wanted] = [of, wanted].map(|d| d.unit());
            let said = |u: &str| if u.is_empty() { "a plain number".into() } else { format!("in {u}") };
            return Err(format!("\"{text}\" is {}, and has to be {}", said(&of), said(&wanted)));
        }
        match e.value(&[]) {
            x if x.is_finite() => Ok(x),
            x => Err(format!("\"{text}\" is {x}, which is no finite number")),
        }
    }
}

impl Default for Formula {
    fn default() -> Self {
        Formula::Number(0.0)
    }
}
impl From<f64> for Formula {
    fn from(x: f64) -> Self {
        Formula::Number(x)
    }
}
impl From<&str> for Formula {
    fn from(text: &str) -> Self {
        Formula::Text(text.into())
    }
}

impl<'de> serde::Deserialize<'de> for Formula {
    fn deserialize<D: Deserializer<'de>>(d: D) -> Result<Self, D::Error> {
        struct Either;
        impl Visitor<'_> for Either {
            type Value = Formula;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "a number, or a text such as \"2 kN\" or a formula")
            }
            fn visit_f64<E: Error>(self, x: f64) -> Result<Formula, E> {
                super::kind::NUMBER.finite(x).map(Formula::Number).map_err(E::custom)
            }
            fn visit_i64<E: Error>(self, x: i64) -> Result<Formula, E> {
                Ok(Formula::Number(x as f64))
            }
            fn visit_u64<E: Error>(self, x: u64) -> Result<Formula, E> {
                Ok(Formula::Number(x as f64))
            }
            fn visit_str<E: Error>(self, x: &str) -> Result<Formula, E> {
                Ok(Formula::Text(x.into()))
            }
        }
        d.deserialize_any(Either)
    }
}
