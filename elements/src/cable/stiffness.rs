//! Bending stiffness, the same in all directions or not.

use ropewalk_scene::quantity::kind;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{Deserializer, Error, SeqAccess, Visitor};
use serde::{Deserialize, Serialize, Serializer};
use std::borrow::Cow;
use std::fmt;

/// Bending stiffness of a section [N m²]: one number, or one for bending about the normal of the section and one for
/// bending about the axis across it.
///
/// ```
/// use ropewalk_elements::cable::BendingStiffness;
/// let strip: BendingStiffness = serde_json::from_str(r#"["2 N m^2", 30]"#)?;
/// assert_eq!((strip.about_normal, strip.across), (2.0, 30.0));
/// assert_eq!(serde_json::from_str::<BendingStiffness>("0.5")?, BendingStiffness::from(0.5));
/// # Ok::<(), serde_json::Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BendingStiffness {
    /// About the first director of the section, its normal.
    pub about_normal: f64,
    /// About the second, at right angles to it.
    pub across: f64,
}

impl BendingStiffness {
    /// Whether both differ, so that the section has to know which way it looks.
    pub fn has_direction(self) -> bool {
        self.about_normal != self.across
    }
    /// The larger of both.
    pub fn largest(self) -> f64 {
        self.about_normal.max(self.across)
    }
    /// Their mean.
    pub fn mean(self) -> f64 {
        0.5 * (self.about_normal + self.across)
    }
}

impl From<f64> for BendingStiffness {
    fn from(ei: f64) -> Self {
        BendingStiffness { about_normal: ei, across: ei }
    }
}

impl Serialize for BendingStiffness {
    fn serialize<S: Serializer>(&self, s: S) -> Result<S::Ok, S::Error> {
        if self.has_direction() {
            [self.about_normal, self.across].serialize(s)
        } else {
            self.across.serialize(s)
        }
    }
}

impl<'de> Deserialize<'de> for BendingStiffness {
    fn deserialize<D: Deserializer<'de>>(d: D) -> Result<Self, D::Error> {
        struct One;
        impl Visitor<'_> for One {
            type Value = f64;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "{}", kind::BENDING_STIFFNESS)
            }
            fn visit_f64<E: Error>(self, x: f64) -> Result<f64, E> {
                if x.is_finite() { Ok(x) } else { Err(E::custom(format!("{x} is no bending stiffness"))) }
            }
            fn visit_i64<E: Error>(self, x: i64) -> Result<f64, E> {
                Ok(x as f64)
            }
            fn visit_u64<E: Error>(self, x: u64) -> Result<f64, E> {
                Ok(x as f64)
            }
            fn visit_str<E: Error>(self, text: &str) -> Result<f64, E> {
                kind::BENDING_STIFFNESS.parse(text).map_err(E::custom)
            }
        }
        struct Number(f64);
        impl<'de> Deserialize<'de> for Number {
            fn deserialize<D: Deserializer<'de>>(d: D) -> Result<Self, D::Error> {
                d.deserialize_any(One).map(Number)
            }
        }
        struct Either;
        impl<'de> Visitor<'de> for Either {
            type Value = BendingStiffness;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "{}, or a list of two: about the normal, and across it", kind::BENDING_STIFFNESS)
            }
            fn visit_f64<E: Error>(self, x: f64) -> Result<Self::Value, E> {
                One.visit_f64(x).map(BendingStiffness::from)
            }
            fn visit_i64<E: Error>(self, x: i64) -> Result<Self::Value, E> {
                One.visit_i64(x).map(BendingStiffness::from)
            }
            fn visit_u64<E: Error>(self, x: u64) -> Result<Self::Value, E> {
                One.visit_u64(x).map(BendingStiffness::from)
            }
            fn visit_str<E: Error>(self, text: &str) -> Result<Self::Value, E> {
                One.visit_str(text).map(BendingStiffness::from)
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Self::Value, A::Error> {
                let mut next = |k: usize| {
                    let number: Option<Number> = seq.next_element()?;
                    number.map(|n| n.0).ok_or_else(|| A::Error::invalid_length(k, &Either))
                };
                let (about_normal, across) = (next(0)?, next(1)?);
                if seq.next_element::<serde::de::IgnoredAny>()?.is_some() {
                    return Err(A::Error::invalid_length(3, &Either));
                }
                Ok(BendingStiffness { about_normal, across })
            }
        }
        d.deserialize_any(Either)
    }
}

impl JsonSchema for BendingStiffness {
    fn schema_name() -> Cow<'static, str> {
        "BendingStiffness".into()
    }
    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "One number, or a list of two: about the normal of the section, and across it [N m²].",
            "anyOf": [
                { "type": ["number", "string"] },
                { "type": "array", "items": { "type": ["number", "string"] }, "minItems": 2, "maxItems": 2 }
            ]
        })
    }
}
