//! Momentum and centre of mass of everything that a scene holds.

use super::named;
use crate::register_spec;
use crate::spec::RecordSpec;
use ropewalk_core::model::twist::tangent;
use ropewalk_core::rotation::{cross, matrix, transposed_times};
use ropewalk_core::{At, BuildError, Column, Model, NodeKind, Record, Sample, V3, dot};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Momentum of the whole scene: columns `momentum.px`, `.py`, `.pz` in kg m/s, `.lx`, `.ly`, `.lz`, the angular momentum
/// about the origin, in kg m²/s, and `.x`, `.y`, `.z`, the centre of mass, in m.
///
/// Added mass is included.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MomentumSpec {
    /// Name in results. Default: `momentum`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Title of its plots. Default: the quantity.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub title: Option<String>,
}

register_spec!(Record, "momentum", MomentumSpec);

struct Momentum {
    name: String,
    title: String,
}

const AXES: [V3<f64>; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// Velocities of all nodes in a motion of the whole as one rigid body.
fn as_one(model: &Model, at: &At<'_>, along: V3<f64>, turn: V3<f64>) -> Vec<f64> {
    let mut all = vec![0.0; at.v.len()];
    for n in model.nodes().iter().filter(|n| !matches!(n.kind, NodeKind::Scalars(_))) {
        let q = &at.q[n.coords()];
        let swing = cross(&turn, &[q[0], q[1], q[2]]);
        let v = &mut all[n.dofs()];
        (0..3).for_each(|i| v[i] = along[i] + swing[i]);
        match n.kind {
            NodeKind::Slope => v[3..6].copy_from_slice(&cross(&turn, &[q[3], q[4], q[5]])),
            NodeKind::Twist => {
                v[3..6].copy_from_slice(&cross(&turn, &[q[3], q[4], q[5]]));
                v[6] = dot(&turn, &tangent(q));
            }
            NodeKind::Frame => {
                v[3..6].copy_from_slice(&transposed_times(&matrix(&[q[3], q[4], q[5], q[6]]), &turn));
            }
            _ => {}
        }
    }
    all
}

impl Record for Momentum {
    fn title(&self) -> String {
        self.title.clone()
    }
    fn name(&self) -> String {
        self.name.clone()
    }
    fn columns(&self) -> Vec<Column> {
        let of = |names: [&str; 3], unit| names.map(|n| Column::new(format!("{}.{n}", self.name), unit));
        [of(["px", "py", "pz"], "kg m/s"), of(["lx", "ly", "lz"], "kg m^2/s"), of(["x", "y", "z"], "m")]
            .concat()
    }
    /// A momentum is what the kinetic energy, which is quadratic, changes by with a motion of the whole: `vᵀM w` is half of
    /// `T(v + w) - T(v - w)`.
    fn sample(&self, s: &Sample<'_>, out: &mut Vec<f64>) {
        let kinetic = |v: &[f64]| s.model.energy(&At { v, ..s.at }).kinetic;
        let product = |v: &[f64], w: &[f64]| {
            let moved = |f: f64| kinetic(&v.iter().zip(w).map(|(v, w)| v + f * w).collect::<Vec<_>>());
            0.5 * (moved(1.0) - moved(-1.0))
        };
        let shift = AXES.map(|e| as_one(s.model, &s.at, e, [0.0; 3]));
        let turn = AXES.map(|e| as_one(s.model, &s.at, [0.0; 3], e));
        out.extend(shift.iter().chain(&turn).map(|w| product(s.at.v, w)));
        // turning about an axis moves the centre of mass across it: m x = y · (turn about z), and so on round
        let centre = (0..3).map(|k| {
            let (y, z) = ((k + 1) % 3, (k + 2) % 3);
            product(&shift[y], &turn[z]) / (2.0 * kinetic(&shift[y]))
        });
        out.extend(centre);
    }
}

#[typetag::serde(name = "momentum")]
impl RecordSpec for MomentumSpec {
    fn build(&self, _: &Model) -> Result<Box<dyn Record>, BuildError> {
        let name = named(&self.name, || "momentum".into());
        Ok(Box::new(Momentum { name, title: named(&self.title, || "Momentum".into()) }))
    }
}
