//! What is the same for the whole scene: gravity, water and air, motions and inputs.

use super::Builder;
use crate::inputs::Inputs;
use crate::motions::{Motions, no_motion};
use crate::scene::GRAVITY;
use crate::water::{Air, Water};
use ropewalk_core::{BuildError, Motion, Signal, V3};
use ropewalk_quantity::{Kind, Setting};
use std::sync::Arc;

impl Builder {
    /// The acceleration of gravity [m/s²].
    pub fn gravity(&self) -> V3<f64> {
        self.gravity.unwrap_or(GRAVITY)
    }

    /// Notes that the scene is a sequence of equilibria.
    pub(crate) fn set_statics(&mut self, statics: bool) {
        self.statics = statics;
    }

    /// Whether the scene is a sequence of equilibria, where time is a load factor: what changes with it changes slowly.
    pub fn is_statics(&self) -> bool {
        self.statics
    }

    /// The water, which the scene must have for what acts in it.
    pub fn water(&self) -> Result<&Water, BuildError> {
        self.water.as_ref().ok_or_else(|| {
            BuildError::new("this needs water: add a [water] section, such as `density = \"1025 kg/m^3\"`")
        })
    }

    /// The air, if the scene has some.
    pub fn air(&self) -> Option<&Air> {
        self.air.as_ref()
    }

    pub(crate) fn set_world(&mut self, gravity: V3<f64>, water: Option<Water>, air: Option<Air>) {
        (self.gravity, self.water, self.air) = (Some(gravity), water, air);
    }

    pub(crate) fn set_motions(&mut self, motions: Motions) {
        self.motions = motions;
    }

    pub(crate) fn set_inputs(&mut self, inputs: Inputs) {
        self.inputs = inputs;
    }

    /// The inputs of the scene.
    pub fn inputs(&self) -> &Inputs {
        &self.inputs
    }

    /// What a `field` of a spec reads, a number or an input of this kind.
    ///
    /// # Errors
    /// There is no such input, or it has another unit.
    pub fn signal(&self, field: &str, setting: &Setting, kind: &Kind) -> Result<Signal, BuildError> {
        self.inputs.signal(field, setting, kind)
    }

    /// The motion of this name.
    pub fn motion(&self, name: &str) -> Result<Arc<dyn Motion>, BuildError> {
        let there = self.motions.keys().map(String::as_str);
        let missing = || BuildError::at("motion", no_motion(name, there));
        self.motions.get(name).cloned().ok_or_else(missing)
    }
}
