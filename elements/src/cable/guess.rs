//! Shapes between its ends from which a search for equilibrium begins anew.

use super::part::CablePart;
use super::twisted;
use ropewalk_core::model::twist::tangent;
use ropewalk_core::rotation::cross;
use ropewalk_core::{V3, dot};
use std::f64::consts::PI;

/// Ends nearer than this share of the length give no direction.
const APART: f64 = 1e-3;
/// What is longer than its chord by less than this is as good as straight.
const SLACK: f64 = 1e-3;

impl CablePart {
    /// Its ends and its length [m].
    fn ends(&self, q: &[f64]) -> ([V3<f64>; 2], f64) {
        let at = |k: usize| -> V3<f64> { std::array::from_fn(|i| q[self.seats[k].0 + i]) };
        let mesh = self.material(q);
        ([at(0), at(self.seats.len() - 1)], mesh[mesh.len() - 1] - mesh[0])
    }

    /// Lays its nodes to places and slopes, by the share of its length.
    fn lay(&self, q: &mut [f64], place: impl Fn(f64) -> [V3<f64>; 2]) {
        let mesh = self.material(q).into_owned();
        let length = mesh[mesh.len() - 1] - mesh[0];
        let tangents: Vec<V3<f64>> = self.seats.iter().map(|s| tangent(&q[s.0..])).collect();
        for (s, &(at, _)) in mesh.iter().zip(&self.seats) {
            let [x, slope] = place((s - mesh[0]) / length);
            q[at..at + 3].copy_from_slice(&x);
            q[at + 3..at + 6].copy_from_slice(&slope);
        }
        if self.twisted.is_some() {
            let seats: Vec<usize> = self.seats.iter().map(|s| s.0).collect();
            twisted::follow(q, &seats, &tangents);
        }
    }

    /// Lays it straight, stretched or pressed as evenly as that takes.
    pub(super) fn lay_straight(&self, q: &mut [f64]) {
        let ([from, to], length) = self.ends(q);
        let mut way: V3<f64> = std::array::from_fn(|i| to[i] - from[i]);
        if way.iter().all(|x| x.abs() < APART * length) {
            // any direction will do
            way = [APART * length, 0.0, 0.0];
        }
        self.lay(q, |u| [std::array::from_fn(|i| from[i] + way[i] * u), way.map(|x| x / length)]);
    }

    /// Lays it unstretched along an arc across `down`; whether it is long enough for one.
    pub(super) fn lay_bowed(&self, q: &mut [f64], down: &V3<f64>) -> bool {
        let ([from, to], length) = self.ends(q);
        let way: V3<f64> = std::array::from_fn(|i| to[i] - from[i]);
        let chord = dot(&way, &way).sqrt();
        if !(chord < (1.0 - SLACK) * length) {
            return false;
        }
        let way = if chord > APART * length { way } else { across(down) };
        let along = unit(&way);
        let side = cross(down, &along);
        let side = if dot(&side, &side) > APART * APART { unit(&side) } else { across(&along) };
        let half = half_angle(chord / length);
        let radius = 0.5 * length / half;
        self.lay(q, |u| {
            let (sin, cos) = (half * (2.0 * u - 1.0)).sin_cos();
            let (ahead, aside) = (0.5 * chord + radius * sin, radius * (cos - half.cos()));
            [
                std::array::from_fn(|i| from[i] + ahead * along[i] + aside * side[i]),
                std::array::from_fn(|i| cos * along[i] - sin * side[i]),
            ]
        });
        true
    }
}

/// Half of the angle of an arc whose chord is this share of its length: `sin θ/θ`, which falls from 1 to 0.
fn half_angle(share: f64) -> f64 {
    let (mut low, mut high) = (0.0, PI);
    for _ in 0..60 {
        let middle: f64 = 0.5 * (low + high);
        if middle.sin() > share * middle {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

fn unit(x: &V3<f64>) -> V3<f64> {
    let size = dot(x, x).sqrt();
    x.map(|x| x / size)
}

/// A direction across another: the cross product with the axis that is farthest from it.
fn across(x: &V3<f64>) -> V3<f64> {
    let least = (0..3).fold(0, |k, i| if x[i].abs() < x[k].abs() { i } else { k });
    let mut axis = [0.0; 3];
    axis[least] = 1.0;
    unit(&cross(x, &axis))
}
