//! What a scene file can name: specs of elements, constraints, forces, motions and records.
//!
//! A spec is plain data that serde reads, with a doc comment at each field; `build` turns it into parts of a model.
//! Each type is registered twice: with typetag, so that `type = "…"` finds it in a file, and with
//! [`register_spec!`](crate::register_spec), so that `list` and `describe` can show it.

use crate::builder::Builder;
use crate::controllers::Channels;
use crate::inputs::{InputSpec, Inputs};
use crate::marker::MarkerRef;
use crate::reeving::Guide;
use crate::responses::RaoSpec;
use crate::run::Run;
use crate::water::{Air, Water};
use ropewalk_core::integrator::Options;
use ropewalk_core::statics::StaticsOptions;
use ropewalk_core::{BuildError, Controller, Feed, Motion, Record};
use ropewalk_quantity::TextsWithUnits;
use std::fmt::Debug;
use std::sync::Arc;

/// A part of a scene: a cable, a point mass.
#[typetag::serde]
pub trait ElementSpec: Debug + Send + Sync {
    /// Name; the rest of the scene refers to the part by it.
    fn name(&self) -> &str;
    /// Markers of other elements that it holds on to.
    fn markers(&self) -> Vec<&MarkerRef> {
        Vec::new()
    }
    /// The same, and others that it makes of its fields; a cable puts a node where one is.
    fn pins(&self) -> Vec<MarkerRef> {
        self.markers().into_iter().cloned().collect()
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
    /// What cables can run over by it.
    fn guides(&self) -> Vec<Guide> {
        Vec::new()
    }
    /// How it answers to waves.
    fn responses(&self) -> Option<&RaoSpec> {
        None
    }
    /// What one should know about it, one sentence each, in the model that was built.
    fn notes(&self, _: &ropewalk_core::Model) -> Vec<String> {
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
    /// The parts that it gives the scene's weight; an empty list means all of them.
    fn weighs(&self) -> Option<&[String]> {
        None
    }
    /// How it answers to waves, with its name.
    fn responses(&self) -> Option<(&str, &RaoSpec)> {
        None
    }
    /// The height of the level bed that it is, with its name [m].
    fn bed(&self) -> Option<(&str, f64)> {
        None
    }
    /// What one should know about it, one sentence each.
    fn notes(&self) -> Vec<String> {
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
    /// The same for one that reads inputs.
    fn build_with(&self, of: &[Arc<dyn Motion>], _: &Inputs) -> Result<Arc<dyn Motion>, BuildError> {
        self.build(of)
    }
    /// The same for one that looks at the whole of a run of this `duration` [s].
    fn build_for(
        &self,
        of: &[Arc<dyn Motion>],
        inputs: &Inputs,
        _duration: f64,
    ) -> Result<Arc<dyn Motion>, BuildError> {
        self.build_with(of, inputs)
    }
}

/// What sets an input of a scene by what its records show.
#[typetag::serde]
pub trait ControllerSpec: Debug + Send + Sync {
    /// The input that it sets.
    fn input(&self) -> &str;
    /// Makes the controller for a finished model.
    fn build(&self, channels: &Channels<'_>) -> Result<Arc<dyn Controller>, BuildError>;
}

/// An output of a scene.
#[typetag::serde]
pub trait RecordSpec: Debug + Send + Sync {
    /// Makes the record for a finished model.
    fn build(&self, model: &ropewalk_core::Model) -> Result<Box<dyn Record>, BuildError>;
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
    /// [`InputSpec`], of which there is one type.
    Input,
    /// [`ControllerSpec`].
    Controller,
    /// [`ProcessSpec`](crate::process::ProcessSpec).
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
            SpecKind::Input => "inputs",
            SpecKind::Controller => "controllers",
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
    pub schema: MakeSchema,
}

inventory::collect!(SpecInfo);

/// Makes the schema of a type.
pub type MakeSchema = fn() -> schemars::Schema;

/// Sections of a scene file that are no lists of parts.
pub const SECTIONS: [(&str, MakeSchema); 5] = [
    ("water", TextsWithUnits::schema_for::<Water>),
    ("air", TextsWithUnits::schema_for::<Air>),
    ("run", TextsWithUnits::schema_for::<Run>),
    ("solver", TextsWithUnits::schema_for::<Options>),
    ("statics", TextsWithUnits::schema_for::<StaticsOptions>),
];

/// A list of a scene file whose entries are all of one type.
pub struct ListInfo {
    /// Its name in a scene file.
    pub name: &'static str,
    /// Fields, types and doc comments of an entry.
    pub schema: MakeSchema,
}

inventory::collect!(ListInfo);

crate::register_list!("inputs", InputSpec);

/// Lists of a scene file whose entries are all of one type, by name.
pub fn lists() -> Vec<(&'static str, MakeSchema)> {
    let mut all: Vec<_> = inventory::iter::<ListInfo>.into_iter().map(|l| (l.name, l.schema)).collect();
    all.sort_by_key(|l| l.0);
    all
}

/// All registered types, by kind and name.
pub fn registered() -> Vec<&'static SpecInfo> {
    let mut all: Vec<&SpecInfo> = inventory::iter::<SpecInfo>.into_iter().collect();
    all.sort_by_key(|s| (s.kind, s.name));
    all
}

/// Makes the type of a list's entries known to `describe`: `register_list!("inputs", InputSpec)`.
#[macro_export]
macro_rules! register_list {
    ($name:literal, $type:ty) => {
        $crate::inventory::submit! {
            $crate::ListInfo { name: $name, schema: $crate::quantity::TextsWithUnits::schema_for::<$type> }
        }
    };
}

/// Makes a spec known to `list` and `describe`: `register_spec!(Force, "gravity", Gravity)`.
#[macro_export]
macro_rules! register_spec {
    ($kind:ident, $name:literal, $type:ty) => {
        $crate::inventory::submit! {
            $crate::SpecInfo {
                kind: $crate::SpecKind::$kind,
                name: $name,
                schema: $crate::quantity::TextsWithUnits::schema_for::<$type>,
            }
        }
    };
}
