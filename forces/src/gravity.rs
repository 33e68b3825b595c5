//! Weight.

use ropewalk_core::{BuildError, Per, V3};
use ropewalk_scene::{Builder, ForceSpec, register_spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Weight: the scene's `gravity` acts on the structural mass of every part.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GravitySpec {
    /// Parts it acts on. Default: all.
    #[serde(default)]
    pub on: Vec<String>,
}
register_spec!(Force, "gravity", GravitySpec);

/// Adds a load in a constant direction to parts, once to each.
pub(crate) fn dead_loads(
    b: &mut Builder,
    kind: &'static str,
    on: &[String],
    per: Per,
    load: V3<f64>,
) -> Result<(), BuildError> {
    for part in b.parts(on)? {
        b.acts_once(kind, &part)?;
        if let Some(term) = part.1.dead_load(per, load) {
            b.term(term);
        }
    }
    Ok(())
}

#[typetag::serde(name = "gravity")]
impl ForceSpec for GravitySpec {
    fn weighs(&self) -> Option<&[String]> {
        Some(&self.on)
    }
    fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
        dead_loads(b, "gravity", &self.on, Per::Mass, b.gravity())
    }
}
