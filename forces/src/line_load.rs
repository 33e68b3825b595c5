//! A load spread evenly along a body.

use crate::drag::PerLength;
use crate::time::{TimeFunction, apart};
use ropewalk_core::error::finite;
use ropewalk_core::{BuildError, Gives, Law, Load, Real, Station, V3, dot, scaled};
use ropewalk_scene::quantity::{Setting, kind};
use ropewalk_scene::{Builder, ForceSpec, quantity, register_spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A force per length that keeps its direction in space, times a function of time.
///
/// Use it for: weight of ice, wind in tests, the loads of textbook cables and beams.
#[derive(Clone, Debug, PartialEq)]
pub struct LineLoad {
    /// Force per length [N/m].
    pub force: V3<f64>,
    /// Which length it is per.
    pub per: PerLength,
    /// Factor as a function of time.
    pub time: TimeFunction,
}

impl LineLoad {
    /// A load per length.
    ///
    /// # Errors
    /// A force that isn't finite, a bad function of time.
    pub fn new(force: V3<f64>, per: PerLength, time: TimeFunction) -> Result<Self, BuildError> {
        finite("force per length", &force)?;
        time.check()?;
        Ok(LineLoad { force, per, time })
    }
}

impl Law for LineLoad {
    fn label(&self) -> String {
        "line load".into()
    }
    fn timed(&self) -> bool {
        self.time.changes()
    }
    fn reach(&self, t: f64, h: f64) -> Option<f64> {
        Some(self.time.reach(t, h))
    }
    fn period(&self, _t: f64) -> f64 {
        self.time.period()
    }
    fn gives(&self) -> Gives {
        Gives { slope: self.per == PerLength::Stretched, ..Gives::NOTHING }
    }

    #[inline(always)]
    fn load<R: Real, const TANGENT: bool>(&self, t: f64, at: &Station<R>, out: &mut Load<R>) {
        let factor = self.time.at(t);
        let f = scaled(R::of(factor), &[R::of(self.force[0]), R::of(self.force[1]), R::of(self.force[2])]);
        match self.per {
            PerLength::Unstretched => {
                for i in 0..3 {
                    out.f[i] += f[i];
                }
            }
            PerLength::Stretched => {
                let stretch = dot(&at.slope, &at.slope).sqrt();
                let t = scaled(R::of(1.0) / stretch, &at.slope);
                for i in 0..3 {
                    out.f[i] += stretch * f[i];
                    if TANGENT {
                        for j in 0..3 {
                            out.d_slope[i][j] += f[i] * t[j];
                        }
                    }
                }
            }
        }
    }
}

/// A distributed force in a constant direction.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LineLoadSpec {
    /// Force per length [N/m].
    #[serde(deserialize_with = "quantity::setting::vec3::force_per_length")]
    pub force: [Setting; 3],
    /// Whether it acts per stretched length instead of unstretched length.
    #[serde(default)]
    pub stretched: bool,
    /// Factor as a function of time.
    #[serde(default)]
    pub time: TimeFunction,
    /// Cables it acts on. Default: all.
    #[serde(default)]
    pub on: Vec<String>,
}
register_spec!(Force, "line_load", LineLoadSpec);

#[typetag::serde(name = "line_load")]
impl ForceSpec for LineLoadSpec {
    fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
        let per = if self.stretched { PerLength::Stretched } else { PerLength::Unstretched };
        for (force, time) in apart(b, "force", &self.force, &kind::FORCE_PER_LENGTH, &self.time)? {
            b.load(&self.on, LineLoad::new(force, per, time)?)?;
        }
        Ok(())
    }
}
