//! The twist of what lies on a wheel, as it is remembered from state to state.

use ropewalk_core::At;
use ropewalk_scene::Torsional;

/// The twist of one cable on a wheel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Twist {
    pub torsion: Torsional,
    /// Twist at the start, and that less the angle by which the spins of both ends are labelled [rad].
    pub laid: [f64; 2],
    /// Place of the internal variables by how much both differ since at the last state [rad]. The second one counts whole turns: it
    /// changes little where the cable is wrung, by however many turns.
    pub memory: usize,
}

impl Twist {
    /// Twist at the last state [rad].
    pub fn last(&self, at: &At<'_>) -> f64 {
        self.recalls(0, at.internal)
    }

    /// What is remembered of the first or the second of them [rad].
    pub fn recalls(&self, which: usize, internal: &[f64]) -> f64 {
        self.laid[which] + internal.get(self.memory + which).copied().unwrap_or(0.0)
    }

    /// Tension that it makes in a laid rope of this unstretched length [N], with the twist of the last state: friction is a step
    /// behind where twist changes, by an error of first order in the step; an equilibrium is found anew until it fits.
    pub fn pull(&self, length: f64, at: &At<'_>) -> f64 {
        self.torsion.lay * (self.last(at) / length - self.torsion.free)
    }
}
