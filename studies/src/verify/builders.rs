//! What scene files of the suite don't say: parts by the dozen, and a motion by a formula.

use ropewalk_core::{BuildError, Motion, Moving};
use ropewalk_scene::MotionSpec;
use serde::{Deserialize, Serialize};
use std::fmt::Write;
use std::sync::Arc;

/// The text of a scene with what completes it.
pub(super) fn complete(by: &str, text: &str) -> Result<String, String> {
    match by {
        "forty four-bars" => Ok(format!("{text}{}", four_bars(40))),
        other => Err(format!("there is no builder `{other}`")),
    }
}

/// A homogeneous slender rod of 1 m and 1 kg in the plane; what it resists turning about itself is as good as nothing.
fn rod(out: &mut String, name: &str, [x, y]: [usize; 2], angle: &str, velocity: &str) {
    let j = 1.0 / 12.0;
    _ = write!(
        out,
        "
[[elements]]
type = \"rigid_body\"
name = \"{name}\"
position = [{x}, {y}, 0]
angles = [0, 0, \"{angle}\"]
{velocity}
mass = 1
inertia = [{:?}, {j:?}, {j:?}]
centre = [0.5, 0, 0]
points = {{ end = [1, 0, 0] }}
",
        1e-6 * j
    );
}

/// A joint about the z axis.
fn joint(out: &mut String, kind: &str, name: &str, marker: &str, to: &str) {
    _ = write!(
        out,
        "
[[constraints]]
type = \"{kind}\"
name = \"{name}\"
marker = \"{marker}\"
to = {to}
axis = [0, 0, 1]
"
    );
}

/// `n + 1` cranks in a row, joined by `n` couplers; loops are closed by the two equations that a plane needs.
fn four_bars(n: usize) -> String {
    let mut out = String::new();
    for k in 0..=n {
        let crank = format!("crank{k}");
        rod(&mut out, &crank, [k, 0], "90 deg", "angular_velocity = [0, 0, -1]");
        joint(&mut out, "revolute", &format!("ground{k}"), &crank, &format!("[{k}, 0, 0]"));
    }
    for k in 0..n {
        let coupler = format!("coupler{k}");
        rod(&mut out, &coupler, [k, 1], "0 deg", "velocity = [1, 0, 0]");
        joint(&mut out, "revolute", &format!("left{k}"), &coupler, &format!("\"crank{k}.end\""));
        let right = format!("\"crank{}.end\"", k + 1);
        joint(&mut out, "point_on_line", &format!("right{k}"), &format!("{coupler}.end"), &right);
    }
    out
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
    fn build(&self, _: &[Arc<dyn Motion>]) -> Result<Arc<dyn Motion>, BuildError> {
        Ok(Arc::new(DrivenRod))
    }
}
