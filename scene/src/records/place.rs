//! Where a record looks: a marker, or any arc length of a part.

use super::listed;
use crate::marker::split_marker;
use ropewalk_core::{At, BuildError, Marker, Model, NodeId, Part, Sample, Spot, V3};
use schemars::JsonSchema;
use serde::de::{self, Deserializer, Visitor};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::sync::Arc;

/// A point of a part whose motion is watched.
pub(super) enum Spotted {
    /// A named place, which is a point of a node.
    Marker(Marker),
    /// A place along a part, whether there is a node or not.
    Along(Arc<dyn Part>, Station),
}

impl Spotted {
    /// Finds `hose.end` or `hose@12.5m`.
    pub(super) fn find(model: &Model, of: &str) -> Result<Self, BuildError> {
        let (name, spot) = split_marker(of).map_err(|e| BuildError::at("of", format!("`{of}`: {e}")))?;
        let part = part(model, name)?;
        match spot {
            // where there is a node or a body, its acceleration is known to the last term
            Spot::Along(_) | Spot::Share(_) if part.watched(&spot).is_ok() => {
                part.watched(&spot).map(Self::Marker).map_err(|e| BuildError::at("of", e))
            }
            Spot::Along(s) if part.point(s, &model.state().at()).is_some() => {
                Ok(Self::Along(part, Station::At(s)))
            }
            Spot::Along(s) => Err(off(part.as_ref(), "of", s)),
            Spot::Share(s) if part.point(0.0, &model.state().at()).is_some() => {
                Ok(Self::Along(part, Station::Share(s)))
            }
            named => part
                .marker(&named)
                .map(Self::Marker)
                .map_err(|e| BuildError::at("of", format!("`{of}`: {e}"))),
        }
    }

    /// Position [m].
    pub(super) fn position(&self, s: &Sample<'_>) -> V3<f64> {
        match self {
            Self::Marker(m) => m.now(s.model.nodes(), &s.at).x,
            Self::Along(part, place) => {
                part.point(place.now(part.as_ref(), &s.at), &s.at).map_or([f64::NAN; 3], |(x, _)| x)
            }
        }
    }

    /// Velocity [m/s].
    pub(super) fn velocity(&self, s: &Sample<'_>) -> V3<f64> {
        match self {
            Self::Marker(m) => m.velocity(s.model.nodes(), &s.at),
            Self::Along(part, place) => {
                part.point(place.now(part.as_ref(), &s.at), &s.at).map_or([f64::NAN; 3], |(_, v)| v)
            }
        }
    }

    /// Acceleration [m/s²].
    pub(super) fn acceleration(&self, s: &Sample<'_>) -> V3<f64> {
        match self {
            Self::Marker(m) => m.acceleration(s.model.nodes(), &s.at),
            Self::Along(part, place) => {
                part.accelerates(place.now(part.as_ref(), &s.at), &s.at).unwrap_or([f64::NAN; 3])
            }
        }
    }
}

/// The rigid body of a marker, or the section of a cable with torsion: its node, and what it is called.
pub(super) fn body(model: &Model, field: &'static str, of: &str) -> Result<(NodeId, String), BuildError> {
    let (name, spot) = split_marker(of).map_err(|e| BuildError::at(field, format!("`{of}`: {e}")))?;
    let part = part(model, name).map_err(|e| e.of(field))?;
    let marker = part.marker(&spot).map_err(|e| BuildError::at(field, format!("`{of}`: {e}")))?;
    match marker.on() {
        Some(node) if model.node(node).kind.turns() => {
            Ok((node, of.chars().filter(|c| !c.is_whitespace()).collect()))
        }
        _ => Err(BuildError::at(
            field,
            format!("`{of}` is not on a rigid body, nor on a cable with torsion: it doesn't turn"),
        )),
    }
}

/// An axis of space or of a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, serde::Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SpaceAxis {
    /// x
    X,
    /// y
    Y,
    /// z
    Z,
}

impl SpaceAxis {
    pub(super) fn letter(self) -> &'static str {
        ["x", "y", "z"][self as usize]
    }
}

pub(super) fn all_axes() -> Vec<SpaceAxis> {
    vec![SpaceAxis::X, SpaceAxis::Y, SpaceAxis::Z]
}

/// Refuses no axes, and the same one twice.
pub(super) fn check_axes(axes: &[SpaceAxis]) -> Result<(), BuildError> {
    if axes.is_empty() || (1..axes.len()).any(|k| axes[..k].contains(&axes[k])) {
        return Err(BuildError::at("axes", "`axes` must name one to three different axes"));
    }
    Ok(())
}

/// The part of this name.
///
/// # Errors
/// There is none.
pub fn part(model: &Model, name: &str) -> Result<Arc<dyn Part>, BuildError> {
    model.part(name).cloned().ok_or_else(|| {
        let parts = listed(model.parts().iter().map(|p| p.name()), "none");
        BuildError::at("of", format!("there is no part `{name}`; the parts are {parts}"))
    })
}

/// An arc length that a part doesn't have.
pub fn off(part: &dyn Part, field: &'static str, s: f64) -> BuildError {
    let (name, length) = (part.name(), part.length());
    BuildError::at(field, format!("`{name}` has no point at arc length {s} m: it goes from 0 to {length} m"))
}

/// A place along a cable: `"start"`, `"end"`, an unstretched arc length from the start like `"12.5 m"`, or a share of the
/// length like `"50 %"`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Station {
    /// Where it starts.
    Start,
    /// Where it ends.
    End,
    /// At an unstretched arc length [m].
    #[serde(untagged)]
    At(f64),
    /// At a share of the length.
    #[serde(untagged, serialize_with = "percent")]
    Share(f64),
}

fn percent<S: serde::Serializer>(share: &f64, s: S) -> Result<S::Ok, S::Error> {
    s.collect_str(&format_args!("{} %", 100.0 * share))
}

/// Checks the places of a record along a part: one at least, and all of them on the part as it is laid.
///
/// # Errors
/// There is none, or one is beyond the part's ends; of the field `at`.
pub fn check_places(part: &dyn Part, at: &[Station]) -> Result<(), BuildError> {
    let length = part.length();
    if at.is_empty() {
        return Err(BuildError::at("at", "`at` must name one place at least"));
    }
    match at.iter().map(|place| place.on(length)).find(|s| !(0.0..=length).contains(s)) {
        Some(s) => Err(off(part, "at", s)),
        None => Ok(()),
    }
}

impl Station {
    /// Its arc length on a part of this length [m].
    pub fn on(self, length: f64) -> f64 {
        match self {
            Station::Start => 0.0,
            Station::End => length,
            Station::At(s) => s,
            Station::Share(share) => share * length,
        }
    }
    /// Its arc length on a part as that is now [m].
    pub fn now(self, part: &dyn Part, at: &At<'_>) -> f64 {
        self.on(part.length_now(at))
    }
}

impl fmt::Display for Station {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Station::Start => f.write_str(".start"),
            Station::End => f.write_str(".end"),
            Station::At(s) => write!(f, "@{s}m"),
            Station::Share(share) => write!(f, "@{}%", 100.0 * share),
        }
    }
}

impl<'de> Deserialize<'de> for Station {
    fn deserialize<D: Deserializer<'de>>(d: D) -> Result<Self, D::Error> {
        struct Either;
        impl Visitor<'_> for Either {
            type Value = Station;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("\"start\", \"end\", an arc length like \"12.5 m\" or a share like \"50 %\"")
            }
            fn visit_str<E: de::Error>(self, text: &str) -> Result<Station, E> {
                match text.trim() {
                    "start" => Ok(Station::Start),
                    "end" => Ok(Station::End),
                    s if s.ends_with('%') => match s.trim_end_matches('%').trim().parse::<f64>() {
                        Ok(share) if (0.0..=100.0).contains(&share) => Ok(Station::Share(share / 100.0)),
                        _ => Err(E::custom(format!("`{s}` is not a share between 0 % and 100 %"))),
                    },
                    s if s.starts_with(|c: char| c.is_alphabetic()) => {
                        Err(E::invalid_value(de::Unexpected::Str(s), &self))
                    }
                    s => ropewalk_quantity::kind::LENGTH.parse(s).map(Station::At).map_err(E::custom),
                }
            }
            fn visit_f64<E: de::Error>(self, s: f64) -> Result<Station, E> {
                if s.is_finite() {
                    Ok(Station::At(s))
                } else {
                    Err(E::invalid_value(de::Unexpected::Float(s), &self))
                }
            }
            fn visit_i64<E: de::Error>(self, s: i64) -> Result<Station, E> {
                Ok(Station::At(s as f64))
            }
            fn visit_u64<E: de::Error>(self, s: u64) -> Result<Station, E> {
                Ok(Station::At(s as f64))
            }
        }
        d.deserialize_any(Either)
    }
}
