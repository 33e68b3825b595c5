//! Motions that a function gives which a program has written.

use ropewalk_core::reach::Knots;
use ropewalk_core::{BuildError, Motion, Moving, V3, broken};
use ropewalk_scene::functions::{Called, Parameters};
use ropewalk_scene::{Inputs, MotionSpec, register_spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Instants at which a step for differences is chosen.
const LOOKS: usize = 24;
/// Steps that are tried: from this part of the run, each a third of the one before.
const LARGEST: f64 = 0.03;
const STEPS: i32 = 13;
/// Instants at which it is looked at for how it goes to and fro.
const ROWS: u32 = 4096;

/// A displacement that a function gives. What it doesn't know of velocity and acceleration are differences.
#[derive(Clone, Debug)]
pub struct FunctionMotion {
    function: Called,
    /// Step of the differences [s].
    step: f64,
    /// How it goes to and fro in the run.
    looked: Knots,
}

/// Values about an instant as a quartic of the time over the step: its coefficients.
fn quartic(f: [V3<f64>; 5]) -> [V3<f64>; 5] {
    let sum = |w: [f64; 5], over: f64| -> V3<f64> {
        std::array::from_fn(|i| f.iter().zip(w).map(|(f, w)| w * f[i]).sum::<f64>() / over)
    };
    [
        f[2],
        sum([1.0, -8.0, 0.0, 8.0, -1.0], 12.0),
        sum([-1.0, 16.0, -30.0, 16.0, -1.0], 24.0),
        sum([-1.0, 2.0, 0.0, -2.0, 1.0], 12.0),
        sum([1.0, -4.0, 6.0, -4.0, 1.0], 24.0),
    ]
}

/// First and second derivative of a function of time, by differences of fourth order that don't look before t = 0.
pub fn differences(f: impl Fn(f64) -> V3<f64>, t: f64, h: f64) -> [V3<f64>; 2] {
    let middle = if t >= 0.0 { t.max(2.0 * h) } else { t };
    let c = quartic([-2.0, -1.0, 0.0, 1.0, 2.0].map(|k| f(middle + k * h)));
    let u = (t - middle) / h;
    [
        std::array::from_fn(|i| {
            (c[1][i] + u * (2.0 * c[2][i] + u * (3.0 * c[3][i] + u * 4.0 * c[4][i]))) / h
        }),
        std::array::from_fn(|i| (2.0 * c[2][i] + u * (6.0 * c[3][i] + u * 12.0 * c[4][i])) / (h * h)),
    ]
}

/// The step with which second differences agree best with those of one three times as long, over a run of this duration:
/// longer ones miss what the function does, shorter ones see rounding. Kinks, where none agrees, don't count.
pub fn best_step(f: impl Fn(f64) -> V3<f64>, duration: f64) -> f64 {
    let at = |k: i32| LARGEST * duration * 3.0_f64.powi(-k);
    let second = |k: i32| -> Vec<V3<f64>> {
        let time = |j: usize| (j as f64 + 0.5) / LOOKS as f64 * duration;
        (0..LOOKS).map(|j| differences(&f, time(j), at(k))[1]).collect()
    };
    let (mut best, mut before) = ((f64::INFINITY, at(STEPS / 2)), second(0));
    for k in 1..STEPS {
        let now = second(k);
        let off = |(a, b): (&V3<f64>, &V3<f64>)| (0..3).map(|i| (a[i] - b[i]).abs()).fold(0.0, f64::max);
        let mut off: Vec<f64> = now.iter().zip(&before).map(off).collect();
        off.sort_by(f64::total_cmp);
        let sum: f64 = off[..LOOKS * 3 / 4].iter().sum();
        // what doesn't move at all says nothing
        if sum < best.0 && sum > 0.0 {
            best = (sum, at(k));
        }
        before = now;
    }
    best.1
}

impl FunctionMotion {
    /// The motion that a function gives over a run of this duration [s].
    ///
    /// # Errors
    /// A function that looks at the state.
    pub fn new(function: Called, duration: f64) -> Result<Self, BuildError> {
        let reads = function.reads;
        if reads.position || reads.velocity || reads.slope || reads.attitude || reads.angular_velocity {
            let message = "a motion is a function of the time `t` alone: what depends on the state is a force, or an input \
                           that is set between steps";
            return Err(BuildError::at("function", message));
        }
        let duration = if duration > 0.0 && duration.is_finite() { duration } else { 1.0 };
        let step = match function.motion(0.0).1 {
            [Some(_), Some(_)] => 0.0,
            [Some(_), None] => best_step(|t| function.motion(t).1[0].unwrap_or([f64::NAN; 3]), duration),
            _ => best_step(|t| function.motion(t).0, duration),
        };
        let rows: Vec<f64> = (0..=ROWS).map(|k| duration * f64::from(k) / f64::from(ROWS)).collect();
        let looked = Knots::at_rows(&rows, |t| function.motion(t).0);
        // what fails when it is wanted is told then
        let _ = broken::take();
        Ok(FunctionMotion { function, step, looked })
    }
}

impl Motion for FunctionMotion {
    fn at(&self, t: f64) -> Moving {
        let (x, rates) = self.function.motion(t);
        match rates {
            [Some(v), Some(a)] => Moving { x, v, a },
            [Some(v), None] => {
                let velocity = |t| self.function.motion(t).1[0].unwrap_or([f64::NAN; 3]);
                Moving { x, v, a: differences(velocity, t, self.step)[0] }
            }
            _ => {
                let [v, a] = differences(|t| self.function.motion(t).0, t, self.step);
                Moving { x, v, a }
            }
        }
    }
    fn period(&self, t: f64) -> f64 {
        self.looked.period(t)
    }
}

/// A motion that a function of time gives, which the program that runs the scene has written, such as a script in Python.
///
/// To try things out: each call takes microseconds. A function that only knows the displacement has it differentiated, which
/// takes five calls and costs digits; it should be smooth.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FunctionMotionSpec {
    /// Name; constraints refer to it.
    pub name: String,
    /// Name of the function that was registered; in Python the function itself. `type = "name"` says the same, with its
    /// parameters beside it.
    #[schemars(extend("format" = "function"))]
    pub function: String,
    /// What the function is given besides the time, by name. A text that is a number with a unit becomes a number in SI
    /// units.
    #[serde(default, skip_serializing_if = "Parameters::is_empty")]
    pub parameters: Parameters,
}
register_spec!(Motion, "function", FunctionMotionSpec);

#[typetag::serde(name = "function")]
impl MotionSpec for FunctionMotionSpec {
    fn name(&self) -> &str {
        &self.name
    }
    fn build(&self, of: &[Arc<dyn Motion>]) -> Result<Arc<dyn Motion>, BuildError> {
        self.build_for(of, &Inputs::default(), 1.0)
    }
    fn build_for(
        &self,
        _: &[Arc<dyn Motion>],
        _: &Inputs,
        duration: f64,
    ) -> Result<Arc<dyn Motion>, BuildError> {
        let called = Called::find(&self.function, &self.parameters)?;
        Ok(Arc::new(FunctionMotion::new(called, duration)?))
    }
}
