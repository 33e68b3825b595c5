//! Prescribed functions of time: what ships, vehicles and winches do.

use crate::algebra::lane::V3;
use std::fmt::Debug;

/// A displacement and its first two time derivatives.
///
/// ```
/// use ropewalk_core::Moving;
/// // at 3 m/s along x for two seconds
/// let moving = Moving { x: [6.0, 0.0, 0.0], v: [3.0, 0.0, 0.0], ..Moving::default() };
/// assert_eq!(moving.a, [0.0; 3]);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Moving {
    /// Displacement from where the driven marker starts [m].
    pub x: V3<f64>,
    /// Velocity [m/s].
    pub v: V3<f64>,
    /// Acceleration [m/s²].
    pub a: V3<f64>,
}

/// A frame that moves steadily: it translates with `velocity` and turns at `omega` about `centre`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize, schemars::JsonSchema))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
pub struct SteadyFrame {
    /// Velocity of the centre [m/s].
    #[cfg_attr(feature = "serde", serde(deserialize_with = "ropewalk_quantity::vec3::speed"))]
    pub velocity: V3<f64>,
    /// Angular velocity [rad/s].
    #[cfg_attr(feature = "serde", serde(deserialize_with = "ropewalk_quantity::vec3::angular_velocity"))]
    pub omega: V3<f64>,
    /// A point on the axis of rotation [m]: in space, or of a motion's frame relative to where the motion starts.
    #[cfg_attr(feature = "serde", serde(deserialize_with = "ropewalk_quantity::vec3::length"))]
    pub centre: V3<f64>,
}

/// A prescribed displacement with a continuous velocity. Drives constraints and winches.
///
/// It is relative to where the driven marker starts, so that a motion fits any scene. Discontinuous motions make
/// accelerations and reactions infinite: ramp them.
pub trait Motion: Send + Sync + Debug {
    /// Displacement, velocity and acceleration at time `t`.
    fn at(&self, t: f64) -> Moving;
    /// First and last time for which it is defined; a run beyond is refused.
    fn range(&self) -> (f64, f64) {
        (f64::NEG_INFINITY, f64::INFINITY)
    }
    /// How much of a step `h` from `t` may be taken that leaps over nothing of the motion [s], as the functions of
    /// [`reach`](crate::model::reach) tell for its rises, periods and knots. `None` if it doesn't know: error control then looks
    /// at the motion at the quarter points of every step, between which a short one may hide.
    fn reach(&self, _t: f64, _h: f64) -> Option<f64> {
        None
    }
    /// The period with which it goes to and fro at time `t` [s], infinite if it doesn't: error control takes so many steps for each
    /// that the tensions which answer to it are right.
    fn period(&self, _t: f64) -> f64 {
        f64::INFINITY
    }
    /// The frame in which the motion is at rest from `t` on, if it is steady then: a straight run, a steady turn.
    fn steady(&self, _t: f64) -> Option<SteadyFrame> {
        None
    }
}
