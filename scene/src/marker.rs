//! Places as a scene writes them: `"hose.end"`, `"hose@12.5m"`, `"hose@50%"`, `[0, 0, 0]`.

use ropewalk_core::{Spot, V3};
use schemars::JsonSchema;
use serde::de::{self, Deserializer, SeqAccess, Visitor};
use serde::{Deserialize, Serialize};
use std::fmt;

/// A marker in a scene: `"hose.end"`, `"hose@12.5m"`, or a point in space `[0, 0, 0]`.
///
/// ```
/// use ropewalk_scene::MarkerRef;
/// assert_eq!(MarkerRef::from("hose.end").to_string(), "`hose.end`");
/// assert_eq!(MarkerRef::from([0.0, 1.0, 2.0]).to_string(), "[0, 1, 2]");
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum MarkerRef {
    /// On a part.
    Name(String),
    /// Fixed in space [m].
    Point(V3<f64>),
}

impl From<&str> for MarkerRef {
    fn from(name: &str) -> Self {
        MarkerRef::Name(name.to_string())
    }
}
impl From<V3<f64>> for MarkerRef {
    fn from(point: V3<f64>) -> Self {
        MarkerRef::Point(point)
    }
}

impl fmt::Display for MarkerRef {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            MarkerRef::Name(n) => write!(f, "`{n}`"),
            MarkerRef::Point([x, y, z]) => write!(f, "[{x}, {y}, {z}]"),
        }
    }
}

impl<'de> Deserialize<'de> for MarkerRef {
    fn deserialize<D: Deserializer<'de>>(d: D) -> Result<Self, D::Error> {
        struct Either;
        impl<'de> Visitor<'de> for Either {
            type Value = MarkerRef;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "a marker like \"hose.end\" or \"hose@12.5m\", or a point [x, y, z] in m")
            }
            fn visit_str<E: de::Error>(self, s: &str) -> Result<MarkerRef, E> {
                Ok(MarkerRef::Name(s.to_string()))
            }
            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<MarkerRef, A::Error> {
                ropewalk_quantity::vec3::length(de::value::SeqAccessDeserializer::new(seq))
                    .map(MarkerRef::Point)
            }
        }
        d.deserialize_any(Either)
    }
}

/// Splits `hose.end`, `hose@12.5 m` or `hose` into part and place.
///
/// ```
/// use ropewalk_core::Spot;
/// use ropewalk_scene::split_marker;
/// assert_eq!(split_marker("hose@50%"), Ok(("hose", Spot::Share(0.5))));
/// assert_eq!(split_marker("hose@2 km"), Ok(("hose", Spot::Along(2000.0))));
/// ```
pub fn split_marker(text: &str) -> Result<(&str, Spot), String> {
    if let Some((part, along)) = text.split_once('@') {
        let along = along.trim();
        if let Some(share) = along.strip_suffix('%') {
            return match share.trim().parse::<f64>() {
                Ok(share) if (0.0..=100.0).contains(&share) => Ok((part.trim(), Spot::Share(share / 100.0))),
                _ => Err(format!("`{along}` is not a share between 0% and 100%")),
            };
        }
        let s = along.parse().or_else(|_| ropewalk_quantity::kind::LENGTH.parse(along))?;
        return Ok((part.trim(), Spot::Along(s)));
    }
    Ok(match text.split_once('.') {
        Some((part, place)) => (part.trim(), Spot::Named(place.trim().to_string())),
        None => (text.trim(), Spot::Named(String::new())),
    })
}
