//! Inputs: named channels that are set from outside while a run goes on.
//!
//! An input is a function of time that grows as it is set: what is before the present is known, and from there on it
//! stays what it was set to. The model only reads it; a [`Simulation`](crate::Simulation) sets it, between steps.

use crate::error::{BuildError, finite, need};
use std::sync::{Arc, PoisonError, RwLock};

/// How the values that an input is set to are joined.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize, schemars::JsonSchema))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Hold {
    /// It jumps to a value when it is set, and stays there.
    #[default]
    Hold,
    /// It goes to a value in a straight line, and reaches it at the end of the next advance.
    Linear,
    /// The same without a kink: by a polynomial of fifth degree, with two continuous derivatives.
    Smooth,
}

/// A straight piece: value and integral at its start, and its slope up to its end; constant from there on.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Piece {
    start: f64,
    end: f64,
    value: f64,
    slope: f64,
    integral: f64,
    /// Of one without kinks: its derivatives at the start over the first three powers of its duration, and where it goes.
    smooth: Option<[f64; 3]>,
}

impl Piece {
    /// A piece without kinks at its place, 0 to 1.
    fn smoothly(&self, [slope, bend, target]: [f64; 3], t: f64) -> Driven {
        let span = self.end - self.start;
        let u = (t - self.start) / span;
        let (v, d, b, c) = (self.value, slope * span, bend * span * span, target - self.value);
        // Hermite's polynomial through value, slope and bend at the start, and the target at rest at the end
        let (c3, c4, c5) =
            (10.0 * c - 6.0 * d - 1.5 * b, -15.0 * c + 8.0 * d + 1.5 * b, 6.0 * c - 3.0 * d - 0.5 * b);
        let at = |u: f64| v + u * (d + u * (0.5 * b + u * (c3 + u * (c4 + u * c5))));
        let sum =
            |u: f64| u * (v + u * (d / 2.0 + u * (b / 6.0 + u * (c3 / 4.0 + u * (c4 / 5.0 + u * c5 / 6.0)))));
        if u >= 1.0 {
            let integral = self.integral + span * sum(1.0) + (t - self.end) * target;
            return Driven { integral, value: target, rate: 0.0, second: 0.0 };
        }
        let u = u.max(0.0);
        Driven {
            integral: self.integral + span * sum(u) + (t - self.start).min(0.0) * v,
            value: at(u),
            rate: (d + u * (b + u * (3.0 * c3 + u * (4.0 * c4 + u * 5.0 * c5)))) / span,
            second: (b + u * (6.0 * c3 + u * (12.0 * c4 + u * 20.0 * c5))) / (span * span),
        }
    }

    fn at(&self, t: f64) -> Driven {
        if let Some(smooth) = self.smooth {
            return self.smoothly(smooth, t);
        }
        let rising = (t.min(self.end) - self.start).max(0.0);
        let level = (t - self.end).max(0.0);
        let before = (t - self.start).min(0.0);
        let value = self.value + self.slope * rising;
        Driven {
            integral: self.integral
                + rising * (self.value + 0.5 * self.slope * rising)
                + level * value
                + before * self.value,
            value,
            rate: if t >= self.start && t < self.end { self.slope } else { 0.0 },
            second: 0.0,
        }
    }
}

/// An input at an instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Driven {
    /// Its integral over time since t = 0.
    pub integral: f64,
    /// Its value.
    pub value: f64,
    /// Its slope; at a kink the one that follows.
    pub rate: f64,
    /// The slope of that; 0 unless it is joined smoothly.
    pub second: f64,
}

/// What an input is at present and was just before: all of it that changes.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Course {
    /// What holds up to the start of `now`.
    before: Piece,
    now: Piece,
    /// Where it is to go in the next advance.
    target: Option<f64>,
}

/// A named channel, in SI units.
///
/// ```
/// use ropewalk_core::{Hold, Input};
/// let input = Input::new("winch", "m/s", 0.5, [-1.0, 1.0], Hold::Hold)?;
/// assert_eq!(input.at(4.0).integral, 2.0);
/// # Ok::<(), ropewalk_core::BuildError>(())
/// ```
#[derive(Debug)]
pub struct Input {
    name: String,
    unit: String,
    limits: [f64; 2],
    join: Hold,
    course: RwLock<Course>,
}

/// Why an input can't be set.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum InputError {
    /// There is no such input.
    #[error("there is no input `{name}`; the inputs are {known}")]
    Unknown {
        /// The name that was asked for.
        name: String,
        /// Those that there are.
        known: String,
    },
    /// The value is outside of its limits, or no number.
    #[error("input `{name}` can't be {value} {unit}: its limits are {least} and {most} {unit}")]
    Outside {
        /// The input.
        name: String,
        /// Its unit.
        unit: String,
        /// What it was to be.
        value: f64,
        /// Its lower limit.
        least: f64,
        /// Its upper limit.
        most: f64,
    },
    /// A controller of the scene sets it.
    #[error(
        "input `{name}` is set by the controller `{controller}` of the scene: take that out to set it from outside"
    )]
    Controlled {
        /// The input.
        name: String,
        /// The controller.
        controller: String,
    },
}

impl Input {
    /// An input that has the value `default` until it is set.
    ///
    /// # Errors
    /// A default that isn't finite or is outside of the limits; limits that aren't in order. Infinite limits are none.
    pub fn new(
        name: impl Into<String>,
        unit: impl Into<String>,
        default: f64,
        limits: [f64; 2],
        join: Hold,
    ) -> Result<Self, BuildError> {
        let [least, most] = limits;
        finite("default", &[default])?;
        need(least <= most, || format!("`min` must not be above `max`, but they are {least} and {most}"))
            .map_err(|e| e.of("min"))?;
        need((least..=most).contains(&default), || {
            format!("`default` is {default}, outside of the limits {least} and {most}")
        })
        .map_err(|e| e.of("default"))?;
        let piece = Piece { value: default, ..Piece::default() };
        let course = RwLock::new(Course { before: piece, now: piece, target: None });
        Ok(Input { name: name.into(), unit: unit.into(), limits, join, course })
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.name
    }
    /// Its SI unit; empty for a plain number.
    pub fn unit(&self) -> &str {
        &self.unit
    }
    /// Its least and its largest value; infinite without limit.
    pub fn limits(&self) -> [f64; 2] {
        self.limits
    }
    /// How the values that it is set to are joined.
    pub fn join(&self) -> Hold {
        self.join
    }

    /// The input at a time `t` [s] that isn't before the last step.
    pub fn at(&self, t: f64) -> Driven {
        let course = self.course.read().unwrap_or_else(PoisonError::into_inner);
        if t < course.now.start { course.before.at(t) } else { course.now.at(t) }
    }

    /// Its value at a time [s].
    #[inline]
    pub fn value(&self, t: f64) -> f64 {
        self.at(t).value
    }

    /// What it is set to at last: its value now, if it holds.
    pub fn latest(&self) -> f64 {
        let course = self.course.read().unwrap_or_else(PoisonError::into_inner);
        match course.now.smooth {
            Some([.., target]) => target,
            None => course.now.value + course.now.slope * (course.now.end - course.now.start),
        }
    }

    /// How much of a step `h` from `t` leads over no kink [s].
    pub fn reach(&self, t: f64, h: f64) -> f64 {
        let course = self.course.read().unwrap_or_else(PoisonError::into_inner);
        let ahead = course.now.end - t;
        if course.now.smooth.is_some() {
            return crate::model::reach::rise(course.now.start, course.now.end, t, h);
        }
        if course.now.slope != 0.0 && ahead > 0.0 { h.min(ahead) } else { h }
    }

    /// All of it that changes.
    pub fn course(&self) -> Course {
        self.course.read().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Makes it what it was, or what another one of this name is.
    pub fn follow(&self, course: Course) {
        *self.course.write().unwrap_or_else(PoisonError::into_inner) = course;
    }

    /// Whether a value is within its limits.
    ///
    /// # Errors
    /// It isn't, or is no number.
    pub(crate) fn check(&self, value: f64) -> Result<(), InputError> {
        let [least, most] = self.limits;
        if value.is_finite() && (least..=most).contains(&value) {
            return Ok(());
        }
        let (name, unit) = (self.name.clone(), self.unit.clone());
        Err(InputError::Outside { name, unit, value, least, most })
    }

    /// Sets it at time `t` [s], and says whether it jumps there. Whoever moves a model by hand does so between steps; a
    /// [`Simulation`](crate::Simulation) has `set_input`, which knows what a jump asks for.
    pub fn set(&self, t: f64, value: f64) -> bool {
        let mut course = self.course.write().unwrap_or_else(PoisonError::into_inner);
        match self.join {
            Hold::Linear | Hold::Smooth => {
                course.target = Some(value);
                false
            }
            Hold::Hold => {
                let here = course.now.at(t);
                if here.value == value {
                    return false;
                }
                course.turn(Piece { start: t, end: t, value, integral: here.integral, ..Piece::default() });
                true
            }
        }
    }

    /// Begins to go where it is to be at time `end` [s], if it was set and doesn't jump.
    pub fn depart(&self, t: f64, end: f64) {
        let mut course = self.course.write().unwrap_or_else(PoisonError::into_inner);
        if !(end > t) {
            return;
        }
        if let Some(target) = course.target.take() {
            let here = course.now.at(t);
            let piece =
                Piece { start: t, end, value: here.value, integral: here.integral, ..Piece::default() };
            course.turn(match self.join {
                Hold::Smooth => Piece { smooth: Some([here.rate, here.second, target]), ..piece },
                _ => Piece { slope: (target - here.value) / (end - t), ..piece },
            });
        }
    }
}

impl Course {
    /// The same with another value from time `t` on, and the integral that it has there.
    pub(crate) fn moved(&self, t: f64, by: f64) -> Self {
        let here = if t < self.now.start { self.before.at(t) } else { self.now.at(t) };
        let (value, integral) = (here.value + by, here.integral);
        let now = Piece { start: t, end: t, value, integral, ..Piece::default() };
        Course { before: self.now, now, target: None }
    }
    fn turn(&mut self, next: Piece) {
        // what is set twice at an instant was never what it was set to first
        if next.start > self.now.start {
            self.before = self.now;
        }
        self.now = next;
    }
}

/// A number of a term or a motion: constant, or that of an input.
#[derive(Clone, Debug)]
pub enum Signal {
    /// Always the same.
    Constant(f64),
    /// What an input is set to.
    Input(Arc<Input>),
}

impl Signal {
    /// Its value at a time [s].
    #[inline]
    pub fn at(&self, t: f64) -> f64 {
        match self {
            Signal::Constant(x) => *x,
            Signal::Input(input) => input.value(t),
        }
    }
    /// It at a time [s] with its integral since t = 0 and its derivatives.
    pub fn course(&self, t: f64) -> Driven {
        match self {
            Signal::Constant(x) => Driven { integral: x * t, value: *x, ..Driven::default() },
            Signal::Input(input) => input.at(t),
        }
    }
    /// Whether it is constant.
    pub fn is_constant(&self) -> bool {
        matches!(self, Signal::Constant(_))
    }
    /// How much of a step `h` from `t` leads over no kink [s].
    pub fn reach(&self, t: f64, h: f64) -> f64 {
        match self {
            Signal::Constant(_) => h,
            Signal::Input(input) => input.reach(t, h),
        }
    }
}

impl From<f64> for Signal {
    fn from(x: f64) -> Self {
        Signal::Constant(x)
    }
}

impl PartialEq for Signal {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Signal::Constant(a), Signal::Constant(b)) => a == b,
            (Signal::Input(a), Signal::Input(b)) => Arc::ptr_eq(a, b),
            _ => false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_held_or_joined_and_integrated() {
        let free = [f64::NEG_INFINITY, f64::INFINITY];
        let held = Input::new("u", "m/s", 1.0, free, Hold::Hold).unwrap();
        assert!(held.set(2.0, 3.0) && !held.set(2.0, 3.0));
        assert_eq!([1.0, 2.0, 4.0].map(|t| held.at(t).value), [1.0, 3.0, 3.0]);
        assert_eq!([1.0, 2.0, 4.0].map(|t| held.at(t).integral), [1.0, 2.0, 8.0]);
        let line = Input::new("u", "m/s", 1.0, free, Hold::Linear).unwrap();
        assert!(!line.set(2.0, 3.0));
        assert_eq!(line.at(9.0).value, 1.0);
        line.depart(2.0, 4.0);
        assert_eq!([2.0, 3.0, 4.0, 5.0].map(|t| line.at(t).value), [1.0, 2.0, 3.0, 3.0]);
        assert_eq!([1.0, 2.0, 3.0, 4.0, 5.0].map(|t| line.at(t).integral), [1.0, 2.0, 3.5, 6.0, 9.0]);
        assert_eq!([1.0, 2.0, 4.0].map(|t| line.at(t).rate), [0.0, 1.0, 0.0]);
        assert_eq!((line.reach(2.5, 9.0), line.reach(4.0, 9.0)), (1.5, 9.0));
        // turned round on its way
        line.set(3.0, 0.0);
        line.depart(3.0, 5.0);
        assert_eq!([2.5, 3.0, 4.0, 5.0, 7.0].map(|t| line.at(t).value), [1.5, 2.0, 1.0, 0.0, 0.0]);
    }

    #[test]
    fn smooth_joints_have_two_continuous_derivatives() {
        let free = [f64::NEG_INFINITY, f64::INFINITY];
        let input = Input::new("u", "m", 1.0, free, Hold::Smooth).unwrap();
        input.set(2.0, 3.0);
        input.depart(2.0, 4.0);
        assert_eq!([2.0, 3.0, 4.0, 9.0].map(|t| input.at(t).value), [1.0, 2.0, 3.0, 3.0]);
        assert_eq!([2.0, 4.0, 6.0].map(|t| input.at(t).integral), [2.0, 6.0, 12.0]);
        assert_eq!(input.latest(), 3.0);
        assert!(input.reach(2.0, 9.0) == 0.25 && input.reach(5.0, 9.0) == 9.0);
        // turned round on its way
        let before = input.at(3.3);
        input.set(3.3, 0.0);
        input.depart(3.3, 5.0);
        let after = input.at(3.3);
        for (a, b) in [
            (before.value, after.value),
            (before.rate, after.rate),
            (before.second, after.second),
            (before.integral, after.integral),
            (0.0, input.at(5.0).value),
        ] {
            assert!((a - b).abs() < 1e-12, "{before:?} {after:?}");
        }
        let d = 1e-5;
        for t in [2.5, 3.4, 4.7] {
            let [a, b] = [t - d, t + d].map(|t| input.at(t));
            let now = input.at(t);
            let slope = |a: f64, b: f64| (b - a) / (2.0 * d);
            assert!((slope(a.integral, b.integral) - now.value).abs() < 1e-8);
            assert!((slope(a.value, b.value) - now.rate).abs() < 1e-8);
            assert!((slope(a.rate, b.rate) - now.second).abs() < 1e-7);
        }
    }

    #[test]
    fn bad_numbers_are_refused() {
        for (default, limits) in
            [(f64::NAN, [0.0, 1.0]), (2.0, [0.0, 1.0]), (0.0, [1.0, -1.0]), (0.0, [f64::NAN, 1.0])]
        {
            assert!(Input::new("u", "", default, limits, Hold::Hold).is_err());
        }
        let input = Input::new("u", "N", 0.0, [-1.0, 1.0], Hold::Hold).unwrap();
        assert!(input.check(f64::NAN).is_err() && input.check(1.5).is_err() && input.check(1.0).is_ok());
        assert_eq!(
            input.check(2.0).unwrap_err().to_string(),
            "input `u` can't be 2 N: its limits are -1 and 1 N"
        );
    }
}
