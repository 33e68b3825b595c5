//! What scene files can't say: parts by the dozen, and a motion by a formula.

use ropewalk_constraints::{PointOnLineSpec, RevoluteSpec};
use ropewalk_core::build::BuildError;
use ropewalk_core::{MarkerRef, Motion, MotionSpec, Moving, Scene, V3};
use ropewalk_elements::RigidBodySpec;
use serde::{Deserialize, Serialize};
use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

/// Completes a scene.
pub(super) fn complete(by: &str, scene: &mut Scene) -> Result<(), String> {
    match by {
        "forty four-bars" => four_bars(scene, 40),
        other => return Err(format!("there is no builder `{other}`")),
    }
    Ok(())
}

/// A homogeneous slender rod of 1 m and 1 kg in the plane; what it resists turning about itself is as good as nothing.
fn rod(name: String, at: V3<f64>, angle: f64) -> RigidBodySpec {
    let j = 1.0 / 12.0;
    let spec = RigidBodySpec {
        angles: [0.0, 0.0, angle],
        centre: [0.5, 0.0, 0.0],
        ..RigidBodySpec::new(&name, at, 1.0, [1e-6 * j, j, j])
    };
    spec.with_point("end", [1.0, 0.0, 0.0])
}

fn hinge(name: String, marker: &str, to: impl Into<MarkerRef>) -> RevoluteSpec {
    RevoluteSpec { name, marker: marker.into(), to: Some(to.into()), axis: [0.0, 0.0, 1.0] }
}

/// `n + 1` cranks in a row, joined by `n` couplers; loops are closed by the two equations that a plane needs.
fn four_bars(scene: &mut Scene, n: usize) {
    for k in 0..=n {
        let (crank, foot) = (format!("crank{k}"), [k as f64, 0.0, 0.0]);
        let body =
            RigidBodySpec { angular_velocity: [0.0, 0.0, -1.0], ..rod(crank.clone(), foot, FRAC_PI_2) };
        scene.element(body).constraint(hinge(format!("ground{k}"), &crank, foot));
    }
    for k in 0..n {
        let (coupler, left) = (format!("coupler{k}"), [k as f64, 1.0, 0.0]);
        let right = PointOnLineSpec {
            name: format!("right{k}"),
            marker: format!("{coupler}.end").as_str().into(),
            to: Some(format!("crank{}.end", k + 1).as_str().into()),
            axis: [0.0, 0.0, 1.0],
        };
        scene
            .element(RigidBodySpec { velocity: [1.0, 0.0, 0.0], ..rod(coupler.clone(), left, 0.0) })
            .constraint(hinge(format!("left{k}"), &coupler, format!("crank{k}.end").as_str()))
            .constraint(right);
    }
}

/// The angle `0.8 t² exp(-t) + 0.3 sin 5t - 1.5 t` of the driven rod. A type of scenes, but for that one only: it isn't listed.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct DrivenRodSpec {
    name: String,
}

#[derive(Debug)]
struct DrivenRod;

impl Motion for DrivenRod {
    fn at(&self, t: f64) -> Moving {
        let (e, (sin, cos)) = ((-t).exp(), (5.0 * t).sin_cos());
        Moving {
            x: [0.8 * t * t * e + 0.3 * sin - 1.5 * t, 0.0, 0.0],
            v: [0.8 * (2.0 * t - t * t) * e + 1.5 * cos - 1.5, 0.0, 0.0],
            a: [0.8 * (2.0 - 4.0 * t + t * t) * e - 7.5 * sin, 0.0, 0.0],
        }
    }
}

#[typetag::serde(name = "driven_rod")]
impl MotionSpec for DrivenRodSpec {
    fn name(&self) -> &str {
        &self.name
    }
    fn build(&self) -> Result<Arc<dyn Motion>, BuildError> {
        Ok(Arc::new(DrivenRod))
    }
}
