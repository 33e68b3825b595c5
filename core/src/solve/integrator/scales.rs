//! Equations without dimensions, and the stopping test that depends on them.
//!
//! Newton's method doesn't notice a scaling of its unknowns and equations; only rounding and absolute stopping tests do.
//! So the model stays in SI units, and what its equations are divided by enters where they are solved and judged.

use crate::error::{BuildError, positive};
use crate::model::Model;
use crate::model::node::NodeKind;

/// Scales that make the equations of motion dimensionless.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize, schemars::JsonSchema))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case", deny_unknown_fields))]
pub enum Scales {
    /// Of the first cable: the length `l` of an element, the time `l² √(ρA/EI)` in which bending runs along it, the force
    /// `ρA l²/T²`. Its bending stiffness becomes one, its axial stiffness the square of the element's slenderness.
    Bending,
    /// The same with the time `l √(ρA/EA)` in which sound runs along an element: its axial stiffness becomes one.
    Axial,
    /// As given.
    Given {
        /// Length [m].
        #[cfg_attr(feature = "serde", serde(deserialize_with = "ropewalk_quantity::length"))]
        length: f64,
        /// Time [s].
        #[cfg_attr(feature = "serde", serde(deserialize_with = "ropewalk_quantity::time"))]
        time: f64,
        /// Force [N].
        #[cfg_attr(feature = "serde", serde(deserialize_with = "ropewalk_quantity::force"))]
        force: f64,
    },
}

/// Stopping test of Newton's method.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize, schemars::JsonSchema))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case", deny_unknown_fields))]
pub enum Stopping {
    /// Positions have converged to a fraction of the error that a step may have. Independent of units and scales.
    #[default]
    Relative,
    /// Euclidean norms are below fixed numbers, in SI units or in those of [`Options::scales`](super::Options::scales).
    /// For comparisons with codes that stop like this. If rounding leaves more than such a number, every step takes
    /// `max_iterations`.
    Absolute {
        /// Largest norm of the residual of all equations, constraints included.
        #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
        residual: Option<f64>,
        /// Largest norm of the correction of the coordinates.
        #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
        increment: Option<f64>,
    },
}

impl Stopping {
    pub(super) fn check(&self) -> Result<(), BuildError> {
        let Stopping::Absolute { residual, increment } = self else { return Ok(()) };
        if residual.is_none() && increment.is_none() {
            return Err(BuildError::at("absolute", "`absolute` needs a `residual`, an `increment`, or both"));
        }
        for (name, x) in [("residual", residual), ("increment", increment)] {
            x.map_or(Ok(()), |x| positive(name, x).map(drop))?;
        }
        Ok(())
    }
}

/// What the equations of motion are divided by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Units {
    /// Length [m].
    pub length: f64,
    /// Time [s].
    pub time: f64,
    /// Force [N].
    pub force: f64,
}

impl Units {
    /// Those of the SI.
    pub const SI: Units = Units { length: 1.0, time: 1.0, force: 1.0 };

    /// Those that scales mean for a model.
    ///
    /// # Errors
    /// Numbers that aren't positive; a preset where no cable bends.
    pub fn of(scales: Scales, model: &Model) -> Result<Self, BuildError> {
        let fault = |message: String| BuildError::at("scales", message);
        let cable = |time: fn(&crate::Slender) -> f64, what: &str| {
            let slender = model.parts().iter().find_map(|p| p.slender());
            let slender = slender
                .ok_or_else(|| fault("these `scales` are those of a cable, but the scene has none".into()))?;
            let (length, time) = (slender.element, time(&slender));
            if !(time > 0.0 && time.is_finite()) {
                return Err(fault(format!(
                    "these `scales` need a cable with {what}; give length, time and force instead"
                )));
            }
            Ok(Units { length, time, force: slender.mass * (length / time).powi(2) })
        };
        match scales {
            Scales::Bending => cable(crate::Slender::bending_time, "bending stiffness"),
            Scales::Axial => cable(crate::Slender::axial_time, "axial stiffness"),
            Scales::Given { length, time, force } => {
                for (name, x) in [("length", length), ("time", time), ("force", force)] {
                    positive(name, x)?;
                }
                Ok(Units { length, time, force })
            }
        }
    }

    /// What one stands for of each coordinate: a length, or 1 for slopes, rotations and plain numbers.
    fn coordinates(&self, model: &Model) -> impl Iterator<Item = f64> {
        let lengths = |kind| match kind {
            NodeKind::Scalars(_) => 0,
            _ => 3,
        };
        let nodes = model.nodes().iter();
        nodes
            .flat_map(move |n| {
                (0..n.kind.velocities()).map(move |k| (k < lengths(n.kind)).then_some(self.length))
            })
            .map(|length| length.unwrap_or(1.0))
    }

    /// The same of each constraint equation.
    fn equations(&self, model: &Model) -> impl Iterator<Item = f64> {
        model.lengthlike().map(|length| if length { self.length } else { 1.0 })
    }

    /// What multiplies the unknowns of the iteration (accelerations, then multipliers) without dimensions.
    pub fn unknowns(&self, model: &Model) -> Vec<f64> {
        let energy = self.force * self.length;
        let accelerations = self.coordinates(model).map(|u| u / self.time.powi(2));
        accelerations.chain(self.equations(model).map(|u| energy / u)).collect()
    }

    /// The square that stands between unknowns and equations: both are scaled by the same numbers but for this.
    pub fn square(&self) -> f64 {
        self.force * self.length / self.time.powi(2)
    }

    /// Norm of the residual of all equations.
    pub fn residual(&self, model: &Model, residual: &[f64]) -> f64 {
        let energy = self.force * self.length;
        let forces = self.coordinates(model).map(|u| energy / u);
        norm(residual.iter().zip(forces.chain(self.equations(model))).map(|(r, unit)| r / unit))
    }

    /// Norm of a change of the coordinates.
    pub fn increment(&self, model: &Model, change: impl Iterator<Item = f64>) -> f64 {
        norm(change.zip(self.coordinates(model)).map(|(d, unit)| d / unit))
    }
}

fn norm(x: impl Iterator<Item = f64>) -> f64 {
    x.map(|x| x * x).sum::<f64>().sqrt()
}

/// The iteration matrix without dimensions.
pub(crate) struct Scaled {
    /// What multiplies each unknown, in elimination order.
    unknown: Vec<f64>,
    /// What multiplies each entry.
    entry: Vec<f64>,
    square: f64,
    pub values: Vec<f64>,
}

impl Scaled {
    pub fn new(model: &Model, units: Units) -> Self {
        let s = model.structure();
        let (mut unknown, square) = (vec![1.0; s.n], units.square());
        s.order(&units.unknowns(model), &mut unknown);
        let mut entry = vec![1.0; s.entries()];
        for (row, columns, values) in s.rows() {
            for (k, value) in values.enumerate() {
                entry[value] = unknown[row] * unknown[columns.get(k)] / square;
            }
        }
        Scaled { unknown, entry, square, values: Vec::new() }
    }

    /// Takes over a matrix.
    pub fn take(&mut self, values: &[f64]) {
        self.values.clear();
        self.values.extend(values.iter().zip(&self.entry).map(|(v, scale)| v * scale));
    }

    /// Makes a right-hand side dimensionless.
    pub fn enter(&self, x: &mut [f64]) {
        let scale = 1.0 / self.square;
        x.iter_mut().zip(&self.unknown).for_each(|(x, u)| *x *= u * scale);
    }

    /// Gives a solution its dimensions back.
    pub fn leave(&self, x: &mut [f64]) {
        x.iter_mut().zip(&self.unknown).for_each(|(x, u)| *x *= u);
    }
}
