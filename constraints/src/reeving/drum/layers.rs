//! How rope lies on a drum: where it winds, on which radius, and how much of it.

use ropewalk_core::Jet;
use std::f64::consts::{PI, TAU};

/// More layers than any drum has.
pub(super) const MOST: f64 = 1000.0;

/// The helix of the rope on a drum, by the angle that is wound, from the end that is fixed to it.
///
/// A layer is `turns` turns of one radius, from one flange to the other. Over its last half turn the rope climbs to the next
/// layer and turns back; both are smooth to the second derivative. No `turns`: one layer of any width.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layers {
    /// Radius of the first layer to the middle of the rope [m].
    pub radius: f64,
    /// Way along the axis in a turn [m].
    pub pitch: f64,
    /// From the middle of one layer to that of the next [m].
    pub rise: f64,
    /// Turns of a layer, if it ends.
    pub turns: Option<f64>,
}

/// Where the rope arrives when an angle is wound.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wound<S> {
    /// Place along the axis [m].
    pub x: S,
    /// Radius to its middle [m].
    pub radius: S,
    /// Length wound so far [m].
    pub length: S,
}

impl Layers {
    /// Angle of a layer, and length of rope in this one, counted from 0.
    fn layer(&self, k: f64) -> (f64, f64) {
        let angle = TAU * self.turns.unwrap_or(f64::INFINITY);
        (angle, angle * (self.radius + k * self.rise) + 0.5 * PI * self.rise)
    }

    /// The number of the layer in which this angle ends, counted from 0.
    pub fn number(&self, angle: f64) -> f64 {
        self.turns.map_or(0.0, |turns| (angle / (TAU * turns)).floor().max(0.0))
    }

    /// Where the rope arrives.
    pub fn at<S: Jet>(&self, angle: S) -> Wound<S> {
        let travel = self.pitch / TAU;
        let Some(turns) = self.turns else {
            return Wound { x: angle * travel, radius: S::from(self.radius), length: angle * self.radius };
        };
        let k = self.number(angle.re());
        let (whole, _) = self.layer(k);
        let radius = self.radius + k * self.rise;
        // the layers below: their radii are in arithmetic progression
        let below = whole * (k * self.radius + 0.5 * k * (k - 1.0) * self.rise) + 0.5 * PI * self.rise * k;
        let here = angle - whole * k;
        let t = (here - (whole - PI)) / PI;
        let t = if t.re() > 0.0 { t } else { S::zero() };
        // smoothstep and its integral
        let step = t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
        let sum = t * t * t * t * (t * (t - 3.0) + 2.5);
        let side = if k % 2.0 == 0.0 { 1.0 } else { -1.0 };
        let way = here - sum * TAU;
        Wound {
            x: (way * travel - 0.5 * self.pitch * (turns - 0.5)) * side,
            radius: step * self.rise + radius,
            length: here * radius + sum * (PI * self.rise) + below,
        }
    }

    /// The angle in which this length is wound: the inverse of [`Wound::length`].
    pub fn angle(&self, length: f64) -> f64 {
        let (mut k, mut below) = (0.0, 0.0);
        if self.turns.is_some() {
            while length > below + self.layer(k).1 && k < MOST {
                below += self.layer(k).1;
                k += 1.0;
            }
        }
        let start = if k > 0.0 { k * self.layer(k).0 } else { 0.0 };
        let mut angle = start + (length - below) / (self.radius + k * self.rise);
        for _ in 0..20 {
            let wound = self.at(angle);
            let step = (length - wound.length) / wound.radius;
            angle += step;
            if step.abs() <= 1e-15 * angle.abs() {
                break;
            }
        }
        angle
    }

    /// `∫ R³ dθ` over what is wound: moment of inertia by mass per length as it lies [m⁴].
    pub fn inertia(&self, angle: f64) -> f64 {
        let whole = self.layer(0.0).0;
        let end = self.number(angle);
        let mut sum = 0.0;
        let mut k = 0.0;
        while k <= end {
            let start = if k > 0.0 { whole * k } else { 0.0 };
            let stop = if k < end { start + whole } else { angle };
            let bend = (start + whole - PI).min(stop);
            sum += (self.radius + k * self.rise).powi(3) * (bend - start);
            // Simpson's rule over the climb
            let (n, climb) = (32, stop - bend);
            for i in 0..=n {
                let weight = if i == 0 || i == n { 1.0 } else { f64::from(2 + 2 * (i % 2)) };
                let r =
                    self.at((bend + climb * f64::from(i) / f64::from(n)).min(start + whole * (1.0 - 1e-14)));
                sum += weight * r.radius.powi(3) * climb / (3.0 * f64::from(n));
            }
            k += 1.0;
        }
        sum
    }
}
