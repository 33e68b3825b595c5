//! Processes: problems that bring equations of their own and step themselves through time.

mod steered;

pub(crate) use steered::Steered;

use crate::inputs::Inputs;
use crate::motions::no_motion;
use crate::water::Water;
use ropewalk_core::integrator::Counts;
use ropewalk_core::{BuildError, Column, Input, InputError, Motion, Solid, V3};
use std::collections::BTreeMap;
use std::fmt::Debug;
use std::sync::Arc;

/// What a scene gives to its process.
#[derive(Default)]
pub struct Surroundings {
    /// Acceleration of gravity [m/s²].
    pub gravity: V3<f64>,
    /// The water, if there is any.
    pub water: Option<Water>,
    /// Motions, by name.
    pub motions: BTreeMap<String, Arc<dyn Motion>>,
    /// Inputs, for numbers of its own. Motions and the current read them already.
    pub inputs: Inputs,
    /// Length of the run [s].
    pub duration: f64,
}

impl Surroundings {
    /// The motion of this name, which stands in the field `field` of a spec.
    ///
    /// # Errors
    /// There is none.
    pub fn motion(&self, field: &str, name: &str) -> Result<Arc<dyn Motion>, BuildError> {
        let there = self.motions.keys().map(String::as_str);
        self.motions.get(name).cloned().ok_or_else(|| BuildError::at(field, no_motion(name, there)))
    }
}

/// A problem of its own kind in a scene, instead of elements: a solver that shares nothing with the others but the files,
/// the history and the pictures.
#[typetag::serde]
pub trait ProcessSpec: Debug + Send + Sync {
    /// Its name.
    fn name(&self) -> &str;
    /// What it offers to the history.
    fn channels(&self) -> Vec<Channel>;
    /// Number of unknowns of a step.
    fn unknowns(&self) -> usize;
    /// Brings it to its start.
    fn build(&self, around: &Surroundings) -> Result<Box<dyn Process>, BuildError>;
}

/// Some columns of a history that are shown together, in one picture per unit.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Channel {
    /// Title of the picture.
    pub title: String,
    /// Name in the summary.
    pub name: String,
    /// The columns.
    pub columns: Vec<Column>,
}

/// A process at work.
pub trait Process: Send {
    /// The time that it has come to [s].
    fn t(&self) -> f64;
    /// Goes on to the time `t` [s]. It may end before, by what it then returns.
    ///
    /// # Errors
    /// One message: when and where it failed, and what to try. The state is the last good one.
    fn advance(&mut self, t: f64) -> Result<Option<String>, String>;
    /// Appends the values of all columns of all channels.
    fn sample(&self, row: &mut Vec<f64>);
    /// What it looks like: points along a line [m].
    fn line(&self) -> Vec<V3<f64>>;
    /// Tensions at the points of that line [N], one for each; empty if it doesn't tell.
    fn tensions(&self) -> Vec<f64> {
        Vec::new()
    }
    /// Curvatures at the points of that line [1/m], one for each; empty if it doesn't tell.
    fn curvatures(&self) -> Vec<f64> {
        Vec::new()
    }
    /// What there is to be seen beside it, such as a package.
    fn solids(&self) -> Vec<Solid> {
        Vec::new()
    }
    /// How much work it was.
    fn counts(&self) -> Counts;
    /// What one should know although it goes on.
    fn warnings(&self) -> Vec<String> {
        Vec::new()
    }
    /// The inputs of its scene. The scene sees to them: a process of one's own need not.
    fn inputs(&self) -> &[Arc<Input>] {
        &[]
    }
    /// Sets an input from here on, in SI units, as [`Simulation::set_input`](ropewalk_core::Simulation::set_input) does.
    ///
    /// # Errors
    /// There is no such input, the value is outside of its limits, or a controller of the scene sets it.
    fn set_input(&mut self, name: &str, _value: f64) -> Result<(), InputError> {
        Err(InputError::Unknown { name: name.into(), known: "none".into() })
    }
    /// Lets inputs that don't jump set out for where they are to be at time `end` [s], though it may come there in pieces.
    fn depart(&mut self, _end: f64) {}
}
