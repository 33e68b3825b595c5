//! Position, velocity and acceleration of a point.

use super::named;
use super::place::{SpaceAxis, Spotted, all_axes, check_axes};
use crate::register_spec;
use crate::spec::RecordSpec;
use ropewalk_core::{BuildError, Column, Model, Record, Sample, V3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Position of a point: columns `hose.end.x`, `.y` and `.z` in m, or some of them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PositionSpec {
    /// The point: a marker like `hose.end`, or an arc length like `hose@12.5m`.
    pub of: String,
    /// Recorded axes of space. Default: all three.
    #[serde(default = "all_axes")]
    pub axes: Vec<SpaceAxis>,
    /// Name in results. Default: that of the point.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Title of its plots. Default: the quantity.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub title: Option<String>,
}

/// Velocity of a point: columns `hose.end.vx`, `.vy` and `.vz` in m/s. Along a cable that a winch feeds, of the material there.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct VelocitySpec {
    /// The point: a marker like `hose.end`, or an arc length like `hose@12.5m`.
    pub of: String,
    /// Name in results. Default: that of the point and `.velocity`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Title of its plots. Default: the quantity.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub title: Option<String>,
}

/// Acceleration of a point: columns `hose.end.ax`, `.ay` and `.az` in m/s². Along a cable that a winch feeds, of the material
/// there.
///
/// It satisfies the equations of motion at the given positions and velocities, and is less noisy than the
/// integrator's own.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AccelerationSpec {
    /// The point: a marker like `hose.end`, or an arc length like `hose@12.5m`.
    pub of: String,
    /// Name in results. Default: that of the point and `.acceleration`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Title of its plots. Default: the quantity.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub title: Option<String>,
}

impl PositionSpec {
    /// The position of a point, under its own name.
    pub fn new(of: &str) -> Self {
        PositionSpec { of: of.into(), axes: all_axes(), name: None, title: None }
    }
}

register_spec!(Record, "position", PositionSpec);
register_spec!(Record, "velocity", VelocitySpec);
register_spec!(Record, "acceleration", AccelerationSpec);

#[derive(Clone, Copy, PartialEq, Eq)]
enum Order {
    Position,
    Velocity,
    Acceleration,
}

struct Motion {
    point: Spotted,
    order: Order,
    axes: Vec<SpaceAxis>,
    name: String,
    /// What columns begin with.
    stem: String,
    title: String,
}

impl Motion {
    fn boxed(
        model: &Model,
        of: &str,
        (name, title): (&Option<String>, &Option<String>),
        order: Order,
        axes: &[SpaceAxis],
    ) -> Result<Box<dyn Record>, BuildError> {
        check_axes(axes)?;
        let point = Spotted::find(model, of)?;
        let of: String = of.chars().filter(|c| !c.is_whitespace()).collect();
        let stem = named(name, || of.clone());
        let name = named(name, || match order {
            Order::Position => of.clone(),
            Order::Velocity => format!("{of}.velocity"),
            Order::Acceleration => format!("{of}.acceleration"),
        });
        let title = named(title, || {
            let what = match order {
                Order::Position => "Position",
                Order::Velocity => "Velocity",
                Order::Acceleration => "Acceleration",
            };
            format!("{what} of {of}")
        });
        Ok(Box::new(Motion { point, order, axes: axes.to_vec(), name, stem, title }))
    }

    fn value(&self, s: &Sample<'_>) -> V3<f64> {
        match self.order {
            Order::Position => self.point.position(s),
            Order::Velocity => self.point.velocity(s),
            Order::Acceleration => self.point.acceleration(s),
        }
    }
}

impl Record for Motion {
    fn title(&self) -> String {
        self.title.clone()
    }
    fn name(&self) -> String {
        self.name.clone()
    }
    fn columns(&self) -> Vec<Column> {
        let (prefix, unit) = match self.order {
            Order::Position => ("", "m"),
            Order::Velocity => ("v", "m/s"),
            Order::Acceleration => ("a", "m/s^2"),
        };
        let column = |i: &SpaceAxis| Column::new(format!("{}.{prefix}{}", self.stem, i.letter()), unit);
        self.axes.iter().map(column).collect()
    }
    fn needs_forces(&self) -> bool {
        self.order == Order::Acceleration
    }
    fn sample(&self, s: &Sample<'_>, out: &mut Vec<f64>) {
        let value = self.value(s);
        out.extend(self.axes.iter().map(|&i| value[i as usize]));
    }
}

#[typetag::serde(name = "position")]
impl RecordSpec for PositionSpec {
    fn build(&self, model: &Model) -> Result<Box<dyn Record>, BuildError> {
        Motion::boxed(model, &self.of, (&self.name, &self.title), Order::Position, &self.axes)
    }
}

#[typetag::serde(name = "velocity")]
impl RecordSpec for VelocitySpec {
    fn build(&self, model: &Model) -> Result<Box<dyn Record>, BuildError> {
        Motion::boxed(model, &self.of, (&self.name, &self.title), Order::Velocity, &all_axes())
    }
}

#[typetag::serde(name = "acceleration")]
impl RecordSpec for AccelerationSpec {
    fn build(&self, model: &Model) -> Result<Box<dyn Record>, BuildError> {
        Motion::boxed(model, &self.of, (&self.name, &self.title), Order::Acceleration, &all_axes())
    }
}
