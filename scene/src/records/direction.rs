//! The direction of a line at places of it: the angles at its ends.

use super::named;
use super::place::{Station, body, check_places, part};
use super::turning::quaternion;
use crate::register_spec;
use crate::spec::RecordSpec;
use ropewalk_core::error::finite;
use ropewalk_core::rotation::{cross, matrix, times};
use ropewalk_core::{At, BuildError, Column, Model, NodeId, Part, Record, Sample, V3, dot};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

fn ends() -> Vec<Station> {
    vec![Station::Start, Station::End]
}

/// Direction of a line at places of it, from its start towards its end: columns `riser.start.declination`, the angle from upright (0 up,
/// 90 level, 180 down), and `riser.start.azimuth`, from x to y, in rad. With an `axis` also `riser.start.angle`, between the line and
/// that axis, such as that of the fitting that holds its end.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DirectionSpec {
    /// The cable, or the chain.
    pub of: String,
    /// Where: as for `along`. Default: at both ends.
    #[serde(default = "ends")]
    pub at: Vec<Station>,
    /// A direction to which the angle is told. Default: none is told.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axis: Option<V3<f64>>,
    /// The body that the axis turns with, in whose axes it is given. Default: it stands still.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub body: Option<String>,
    /// Whether the angles are in degrees.
    #[serde(default)]
    pub degrees: bool,
    /// Name in results. Default: that of the cable.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Title of its plots. Default: the quantity.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub title: Option<String>,
}

register_spec!(Record, "direction", DirectionSpec);

struct Direction {
    part: Arc<dyn Part>,
    at: Vec<Station>,
    axis: Option<V3<f64>>,
    body: Option<NodeId>,
    degrees: bool,
    name: String,
    title: String,
}

/// Part of an element over which differences stand for the tangent.
const NEAR: f64 = 1e-3;

/// The tangent of a line at an arc length, not of unit length; from the element around it alone.
pub fn tangent(part: &dyn Part, s: f64, at: &At<'_>) -> Option<V3<f64>> {
    let mut mesh = part.line().map_or_else(|| part.mesh().to_vec(), |line| line.mesh_now(at));
    if mesh.len() < 2 {
        mesh = vec![0.0, part.length()];
    }
    let after = mesh.partition_point(|x| *x <= s).clamp(1, mesh.len() - 1);
    let (a, b) = (*mesh.get(after - 1)?, *mesh.get(after)?);
    let step = NEAR * (b - a);
    // the derivative of the parabola through three points near it, of which the ends of the element are some
    let first = (s - step).clamp(a, b - 2.0 * step);
    let u = (s - first) / step;
    let weights = [u - 1.5, 2.0 - 2.0 * u, u - 0.5];
    let mut sum = [0.0; 3];
    for (k, weight) in weights.iter().enumerate() {
        let x = part.point(first + k as f64 * step, at)?.0;
        (0..3).for_each(|i| sum[i] += weight * x[i] / step);
    }
    Some(sum)
}

impl Record for Direction {
    fn title(&self) -> String {
        self.title.clone()
    }
    fn name(&self) -> String {
        format!("{}.direction", self.name)
    }
    fn columns(&self) -> Vec<Column> {
        let unit = if self.degrees { "deg" } else { "rad" };
        let what = ["declination", "azimuth"].into_iter().chain(self.axis.map(|_| "angle"));
        let what: Vec<&str> = what.collect();
        let at = |place: &Station| {
            let of = |what: &&str| Column::new(format!("{}{place}.{what}", self.name), unit);
            what.iter().map(of).collect::<Vec<_>>()
        };
        self.at.iter().flat_map(at).collect()
    }
    fn sample(&self, s: &Sample<'_>, out: &mut Vec<f64>) {
        let turn = |angle: f64| if self.degrees { angle.to_degrees() } else { angle };
        let axis = self.axis.map(|axis| match self.body {
            Some(node) => times(&matrix(&quaternion(s, node)), &axis),
            None => axis,
        });
        for place in &self.at {
            let there = place.now(self.part.as_ref(), &s.at);
            let [x, y, z] = tangent(self.part.as_ref(), there, &s.at).unwrap_or([f64::NAN; 3]);
            out.extend([x.hypot(y).atan2(z), y.atan2(x)].map(turn));
            if let Some(axis) = axis {
                let side = cross(&[x, y, z], &axis);
                out.push(turn(dot(&side, &side).sqrt().atan2(dot(&[x, y, z], &axis))));
            }
        }
    }
}

#[typetag::serde(name = "direction")]
impl RecordSpec for DirectionSpec {
    fn build(&self, model: &Model) -> Result<Box<dyn Record>, BuildError> {
        let part = part(model, self.of.trim())?;
        let state = model.state();
        if !(part.length() > 0.0) || tangent(part.as_ref(), 0.0, &state.at()).is_none() {
            return Err(BuildError::at("of", format!("`{}` is a {}, not a line", part.name(), part.kind())));
        }
        check_places(part.as_ref(), &self.at)?;
        if let Some(axis) = &self.axis {
            finite("axis", axis)?;
            if *axis == [0.0; 3] {
                return Err(BuildError::at(
                    "axis",
                    "`axis` is no direction: one of its numbers must not be 0",
                ));
            }
        }
        if self.body.is_some() && self.axis.is_none() {
            return Err(BuildError::at("body", "`body` is what the `axis` turns with, and there is none"));
        }
        let body = self.body.as_deref().map(|of| body(model, "body", of)).transpose()?.map(|(node, _)| node);
        let name = named(&self.name, || part.name().to_string());
        let title = named(&self.title, || format!("Direction of {}", part.name()));
        let (at, axis, degrees) = (self.at.clone(), self.axis, self.degrees);
        Ok(Box::new(Direction { part, at, axis, body, degrees, name, title }))
    }
}
