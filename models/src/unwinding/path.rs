//! Where the lift-off point is.

use ropewalk_constraints::package::{Lay, Package};
use ropewalk_core::V3;
use std::fmt::Debug;

/// The curve on which wound cable lies at rest, by the length `σ` that has been peeled from it.
pub trait Path: Send + Sync + Debug {
    /// The lift-off point and its derivatives by `σ`; nothing where no cable is left.
    fn at(&self, sigma: f64) -> Option<Lay>;
    /// Direction in which the cable is held where it lifts off.
    fn clamp(&self, lay: &Lay) -> V3<f64> {
        lay.tangent
    }
    /// Unit vector along the axis that the lift-off point runs round.
    fn axis(&self) -> V3<f64>;
    /// Distance of a point from the axis, and its way along it [m].
    fn cylindrical(&self, x: &V3<f64>) -> [f64; 2];
    /// How deep a point lies in the wound cable [m] while the cable lifts off at a point; below zero outside.
    fn depth(&self, _x: &V3<f64>, _lift_off: &V3<f64>) -> f64 {
        f64::NEG_INFINITY
    }
    /// Length that can be peeled [m].
    fn wound(&self) -> f64 {
        f64::INFINITY
    }
}

impl Path for Package {
    fn at(&self, sigma: f64) -> Option<Lay> {
        self.at(sigma)
    }
    fn axis(&self) -> V3<f64> {
        self.axis()
    }
    fn cylindrical(&self, x: &V3<f64>) -> [f64; 2] {
        self.cylindrical(x)
    }
    fn depth(&self, x: &V3<f64>, lift_off: &V3<f64>) -> f64 {
        self.depth(x, lift_off)
    }
    fn wound(&self) -> f64 {
        self.wound()
    }
}

/// A lift-off point that runs round the z axis and stays at its height: the idealisation of a steady balloon.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ring {
    /// Radius [m].
    pub radius: f64,
    /// Height of the lift-off point over the origin [m].
    pub height: f64,
    /// Angle by which the cable climbs where it is held [rad].
    pub climb: f64,
    /// Whether it lies inside of a wall, which a free cable can touch.
    pub inner: bool,
}

impl Path for Ring {
    fn at(&self, sigma: f64) -> Option<Lay> {
        let (sin, cos) = (sigma / self.radius).sin_cos();
        sigma.is_finite().then_some(Lay {
            x: [self.radius * cos, self.radius * sin, self.height],
            tangent: [-sin, cos, 0.0],
            curvature: [-cos / self.radius, -sin / self.radius, 0.0],
        })
    }
    fn clamp(&self, lay: &Lay) -> V3<f64> {
        let (sin, cos) = self.climb.sin_cos();
        [cos * lay.tangent[0], cos * lay.tangent[1], sin]
    }
    fn axis(&self) -> V3<f64> {
        [0.0, 0.0, 1.0]
    }
    fn cylindrical(&self, x: &V3<f64>) -> [f64; 2] {
        [x[0].hypot(x[1]), x[2]]
    }
    fn depth(&self, x: &V3<f64>, _lift_off: &V3<f64>) -> f64 {
        if self.inner { x[0].hypot(x[1]) - self.radius } else { f64::NEG_INFINITY }
    }
}

/// A fixed guide through which the cable is fed: between it and the eyelet runs an axially moving string or beam.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Guide {
    /// Where it is [m].
    pub x: V3<f64>,
    /// Direction of the cable in it, away from the eyelet; matters only if the cable is held in it.
    pub direction: V3<f64>,
}

impl Path for Guide {
    fn at(&self, sigma: f64) -> Option<Lay> {
        sigma.is_finite().then_some(Lay { x: self.x, tangent: [0.0; 3], curvature: [0.0; 3] })
    }
    fn clamp(&self, _lay: &Lay) -> V3<f64> {
        self.direction
    }
    fn axis(&self) -> V3<f64> {
        self.direction
    }
    fn cylindrical(&self, x: &V3<f64>) -> [f64; 2] {
        let d = [0, 1, 2].map(|i| x[i] - self.x[i]);
        let along = (0..3).map(|i| d[i] * self.direction[i]).sum::<f64>();
        let across = (0..3).map(|i| (d[i] - along * self.direction[i]).powi(2)).sum::<f64>();
        [across.sqrt(), along]
    }
}
