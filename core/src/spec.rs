//! What a scene file can name: specs of elements, constraints, forces, motions and records.
//!
//! A spec is plain data that serde reads, with a doc comment at each field; `build` turns it into parts of a model.
//! Each type is registered twice: with typetag, so that `type = "…"` finds it in a file, and with
//! [`register_spec!`](crate::register_spec), so that `list` and `describe` can show it.

use crate::build::{BuildError, Builder};
use crate::feed::Feed;
use crate::lane::V3;
use crate::motion::Motion;
use crate::record::Record;
use schemars::JsonSchema;
use serde::de::{self, Deserializer, SeqAccess, Visitor};
use serde::{Deserialize, Serialize};
use std::fmt::{self, Debug};
use std::sync::Arc;

/// A part of a scene: a cable, a point mass.
#[typetag::serde]
pub trait ElementSpec: Debug + Send + Sync {
    /// Name by which the rest of the scene refers to it.
    fn name(&self) -> &str;
    /// Markers of other elements that it holds on to; a cable puts a node where one is.
    fn markers(&self) -> Vec<&MarkerRef> {
        Vec::new()
    }
    /// Adds its nodes and terms.
    fn build(&self, b: &mut Builder) -> Result<(), BuildError>;
}

/// A constraint of a scene.
#[typetag::serde]
pub trait ConstraintSpec: Debug + Send + Sync {
    /// Its name.
    fn name(&self) -> &str;
    /// The markers that it holds; a cable puts a node where one is.
    fn markers(&self) -> Vec<&MarkerRef>;
    /// The end of a cable that material flows through by it, and how.
    fn feeds(&self) -> Option<(&MarkerRef, Feed)> {
        None
    }
    /// What one should know about it, one sentence each, in the model that was built.
    fn notes(&self, _: &crate::Model) -> Vec<String> {
        Vec::new()
    }
    /// Adds its equations.
    fn build(&self, b: &mut Builder) -> Result<(), BuildError>;
}

/// A force of a scene.
#[typetag::serde]
pub trait ForceSpec: Debug + Send + Sync {
    /// The markers that it acts on; a cable puts a node where one is.
    fn markers(&self) -> Vec<&MarkerRef> {
        Vec::new()
    }
    /// Adds its terms.
    fn build(&self, b: &mut Builder) -> Result<(), BuildError>;
}

/// A prescribed motion of a scene.
#[typetag::serde]
pub trait MotionSpec: Debug + Send + Sync {
    /// Its name.
    fn name(&self) -> &str;
    /// Names of other motions that it is made of.
    fn of(&self) -> &[String] {
        &[]
    }
    /// Makes the motion; `of` are those that it is made of, in their order.
    fn build(&self, of: &[Arc<dyn Motion>]) -> Result<Arc<dyn Motion>, BuildError>;
}

/// An output of a scene.
#[typetag::serde]
pub trait RecordSpec: Debug + Send + Sync {
    /// Makes the record for a finished model.
    fn build(&self, model: &crate::Model) -> Result<Box<dyn Record>, BuildError>;
}

/// What kind of spec a type is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum SpecKind {
    /// [`ElementSpec`].
    Element,
    /// [`ConstraintSpec`].
    Constraint,
    /// [`ForceSpec`].
    Force,
    /// [`MotionSpec`].
    Motion,
    /// [`RecordSpec`].
    Record,
    /// [`ProcessSpec`](crate::ProcessSpec).
    Process,
}

impl SpecKind {
    /// The list in a scene file that holds it.
    pub fn list(self) -> &'static str {
        match self {
            SpecKind::Element => "elements",
            SpecKind::Constraint => "constraints",
            SpecKind::Force => "forces",
            SpecKind::Motion => "motions",
            SpecKind::Record => "records",
            SpecKind::Process => "processes",
        }
    }
}

/// A registered type and its documentation.
pub struct SpecInfo {
    /// What it is.
    pub kind: SpecKind,
    /// Its name in a scene file.
    pub name: &'static str,
    /// Its fields, types and doc comments.
    pub schema: fn() -> schemars::Schema,
}

inventory::collect!(SpecInfo);

/// All registered types, by kind and name.
pub fn registered() -> Vec<&'static SpecInfo> {
    let mut all: Vec<&SpecInfo> = inventory::iter::<SpecInfo>.into_iter().collect();
    all.sort_by_key(|s| (s.kind, s.name));
    all
}

/// Makes a spec known to `list` and `describe`: `register_spec!(Force, "gravity", Gravity)`.
#[macro_export]
macro_rules! register_spec {
    ($kind:ident, $name:literal, $type:ty) => {
        $crate::inventory::submit! {
            $crate::SpecInfo {
                kind: $crate::SpecKind::$kind,
                name: $name,
                schema: || $crate::schemars::schema_for!($type),
            }
        }
    };
}

/// A marker in a scene: `"hose.end"`, `"hose@12.5m"`, or a point in space `[0, 0, 0]`.
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
                crate::quantity::vec3::length(de::value::SeqAccessDeserializer::new(seq))
                    .map(MarkerRef::Point)
            }
        }
        d.deserialize_any(Either)
    }
}
