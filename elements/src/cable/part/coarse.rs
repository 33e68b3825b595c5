//! Whether elements are too long for how a cable bends.
//!
//! Where bending is weak the force in a cable lies along it: an element's chord is the mean of the force's direction. A
//! cubic can't turn as sharply as forces do where a line leaves the bed or hangs steeply down; what its chord is off by
//! then shortens or lengthens the line, as much as a wrong length would.

use super::CablePart;
use super::readings::means;
use crate::cable::shape::{hermite_slope, natural};
use crate::path::{angle, norm};
use ropewalk_core::algebra::lane::dot;
use ropewalk_core::{At, Line, Part, V3};

/// Elements that turn by less are short enough [rad].
const TURN: f64 = 0.25;
/// Below this an element counts as straight [rad].
const STRAIGHT: f64 = 0.1;
/// What the chords may be off by in all, as a share of the length.
const OFF: f64 = 1e-3;
/// Below this share of the largest force in the cable its direction is that of rounding.
const SLACK: f64 = 1e-3;
/// What its size changes by at least along an element, in parts of it, where a line hangs or comes off the ground; around a drum
/// it hardly does, and what presses there swings to and fro.
const EVEN: f64 = 0.05;
/// Where `EI κ²` is more than this share of the force, bending holds the element, and its force isn't along it.
const STIFF: f64 = 0.1;

/// By how much an element turns from end to end, by way of its chord [rad].
fn turn(e: &[f64; 12]) -> f64 {
    let [start, end]: [V3<f64>; 2] = [3, 9].map(|i| std::array::from_fn(|c| e[i + c]));
    let chord = std::array::from_fn(|c| e[6 + c] - e[c]);
    angle(&start, &chord) + angle(&chord, &end)
}

/// Its mean stretch, by Simpson's rule.
fn stretch(e: &[f64; 12], l: f64) -> f64 {
    let size = |xi: f64| {
        let c = hermite_slope(xi, 1.0 / l);
        let slope: V3<f64> = std::array::from_fn(|i| (0..4).map(|n| c[n] * e[3 * n + i]).sum());
        norm(slope)
    };
    (size(0.0) + 4.0 * size(0.5) + size(1.0)) / 6.0
}

impl CablePart {
    /// What to say where its elements are too long for how it bends.
    pub(super) fn coarse(&self, at: &At<'_>) -> Option<String> {
        if (0..2).any(|end| self.makes_elements(end)) {
            return None;
        }
        let mesh = self.material(at.q);
        let length = |k: usize| mesh[k + 1] - mesh[k];
        let bent = |k: &usize| turn(&self.dofs(*k, at.q)) - self.rest_of(*k).map_or(0.0, turn);
        if !self.layout.elements().any(|k| bent(&k) > TURN) {
            return None;
        }
        let forces = (0..self.seats.len() - 1).map(|k| self.transmits(k, length(k), at));
        let forces: Vec<V3<f64>> = forces.map(|f| f.unwrap_or_default()).collect();
        let most = forces.iter().copied().map(norm).fold(0.0, f64::max);
        let (mut off, mut worst, mut finest) = ([0.0; 3], (0.0, 0), f64::INFINITY);
        for k in self.layout.elements().filter(|k| bent(k) > STRAIGHT) {
            let (l, e, turn) = (length(k), self.dofs(k, at.q), bent(&k));
            let (direction, [least, largest]) = self.directed(k, &mesh, &forces);
            let bends = self.layout.section(k).ei.across * (turn / l).powi(2);
            if largest <= SLACK * most || bends > STIFF * largest || largest - least < EVEN * largest {
                continue;
            }
            let (chord, stretch) = (natural(&e, 1.0 / l)[0], stretch(&e, l));
            // where it goes slack within the element its force points anywhere: at most straight on
            let size = norm(chord);
            let direction = if dot(&chord, &direction) > 0.0 { direction } else { chord.map(|x| x / size) };
            (0..3).for_each(|c| off[c] += l * (chord[c] - stretch * direction[c]));
            finest = finest.min(l * TURN / turn);
            if turn > worst.0 {
                worst = (turn, k);
            }
        }
        let off = norm(off) / self.length();
        (off > OFF && worst.0 > TURN).then(|| {
            format!(
                "`{}`: its elements are too long for how sharply it bends: near {:.4} m one turns by {:.0} degrees, and the \
                 line fits its own forces only to {:.1} % of its length. Tensions, and small forces still more, may be off by \
                 several times as much. Take elements of at most {} m there",
                self.name,
                mesh[worst.1] - mesh[0],
                worst.0.to_degrees(),
                100.0 * off,
                rounded(finest)
            )
        })
    }

    /// The mean direction of the force in element `k`, and its least and largest size there [N].
    fn directed(&self, k: usize, mesh: &[f64], forces: &[V3<f64>]) -> (V3<f64>, [f64; 2]) {
        const POINTS: usize = 16;
        let around = self.smooth(k);
        let (mut mean, mut least, mut largest) = ([0.0; 3], f64::INFINITY, 0.0_f64);
        for j in 0..POINTS {
            let xi = (j as f64 + 0.5) / POINTS as f64;
            let weights = means(around.clone(), mesh[k] + xi * (mesh[k + 1] - mesh[k]), mesh);
            let of =
                |c: usize| weights.iter().zip(&forces[around.clone()]).map(|(w, f)| w * f[c]).sum::<f64>();
            let force = [of(0), of(1), of(2)];
            let size = norm(force);
            (least, largest) = (least.min(size), largest.max(size));
            if size > 0.0 {
                (0..3).for_each(|c| mean[c] += force[c] / (size * POINTS as f64));
            }
        }
        (mean, [least, largest])
    }
}

/// A number of two digits, not in powers of ten.
fn rounded(x: f64) -> f64 {
    format!("{x:.1e}").parse().unwrap_or(x)
}
