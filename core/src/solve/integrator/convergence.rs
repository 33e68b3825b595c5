//! Whether Newton's method converges, how fast, and when what it leaves is small enough.

use super::forces::left_of;
use crate::solve::linear::SolveError;

/// How Newton's method converged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rate {
    pub iterations: u32,
    /// Expected remaining error in parts of the last correction.
    pub eta: f64,
    /// Ratio of the last two corrections with the same matrix; `None` if the kept one showed none.
    pub theta: Option<f64>,
    /// Whether kept factors had to be replaced on the way.
    pub kept_failed: bool,
    /// Whether the stopping test was given up, since only rounding is left.
    pub unmet: bool,
}

/// Why it didn't converge.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub(crate) enum Failure {
    #[error("{0}")]
    Newton(String),
    #[error(transparent)]
    Linear(#[from] SolveError),
}

impl Failure {
    pub fn newton(why: &str) -> Self {
        Failure::Newton(why.into())
    }
}

/// What rounding leaves of corrections, in parts of that of positions.
pub(super) const FLOOR: f64 = 4.0;
/// Below so many times the floor of rounding corrections wander instead of falling.
const NOISE: f64 = 30.0;
/// Corrections with the same matrix after which what rounding hides is left at that.
const MOST_UNSEEN: u32 = 3;
/// Largest expected rest that counts, in parts of the last correction: beyond, the iteration diverges.
const MOST_REST: f64 = 1e3;

/// The convergence of an iteration, from the sizes of its corrections and from what forces were off.
pub(super) struct Convergence {
    /// What may be left of positions, relative to the length of each part.
    pub stop: f64,
    /// The same below which an iteration is not given up.
    pub enough: f64,
    /// What rounding leaves of corrections.
    pub floor: f64,
    /// Largest expected rest that is believed where the present matrix has made only one correction.
    trust: f64,
    /// Expected remaining error in parts of the last correction.
    pub eta: f64,
    /// Ratio of the last two corrections with the same matrix.
    pub theta: f64,
    /// Size of the last correction, and of the one before.
    pub size: f64,
    before: f64,
    /// Corrections with the present matrix.
    pub since: u32,
    /// By how much forces were off before the last correction, over their tolerance.
    force: Option<f64>,
    /// What the last correction is expected to leave of that.
    pub force_left: f64,
    /// What may be left of positions if that is less than what rounding leaves, and what is.
    deep: Option<f64>,
    left: f64,
}

impl Convergence {
    /// Stops at `tolerance`, or where rounding of positions leaves more.
    pub fn new(tolerance: f64, rounding: f64, trust: f64, eta: f64, theta: f64) -> Self {
        let floor = FLOOR * rounding;
        let (stop, force_left) = (tolerance.max(floor), f64::INFINITY);
        Convergence {
            stop,
            enough: stop,
            floor,
            trust,
            eta,
            theta,
            size: 0.0,
            before: 0.0,
            since: 0,
            force: None,
            force_left,
            deep: (tolerance < floor).then_some(tolerance),
            left: f64::INFINITY,
        }
    }

    /// The next correction says nothing of the rate: it has a new matrix, or stands behind a kink.
    pub fn restart(&mut self) {
        self.since = 0;
    }

    /// Notes a correction of this size, made where forces were off by `force` times their tolerance.
    pub fn corrected(&mut self, size: f64, force: f64) {
        self.before = std::mem::replace(&mut self.size, size);
        self.since += 1;
        // rounding has no rate: what is left goes on falling by that of the corrections before
        let unseen = self.deep.is_some() && self.since > 1 && self.before <= NOISE * self.floor;
        if self.since > 1 && !unseen {
            self.theta = size / self.before;
            self.eta = self.theta / (1.0 - self.theta).max(1e-3);
        }
        self.left = if unseen { self.theta.min(0.5) * self.left } else { size * self.eta.min(MOST_REST) };
        self.force_left = left_of(force, self.force.replace(force).filter(|_| self.since > 1));
    }

    /// Whether positions are right: what the last correction leaves is small enough, or rounding.
    pub fn positions_right(&self) -> bool {
        // a rate that wasn't seen for some steps has to be seen again before it is trusted
        let trusted = self.since > 1 || self.eta <= self.trust;
        if let Some(deep) = self.deep
            && self.since < MOST_UNSEEN
        {
            return trusted && self.left <= deep;
        }
        trusted && self.size * self.eta.min(MOST_REST) <= self.stop || self.size <= self.floor
    }

    /// Whether the last correction says nothing but rounding.
    pub fn is_noise(&self) -> bool {
        self.size <= NOISE * self.floor
    }

    /// Whether corrections grow.
    pub fn grows(&self) -> bool {
        self.theta >= 1.0
    }

    /// Whether rounding keeps forces where they are: a further correction left more than half of them.
    pub fn stuck(&self, force: f64) -> bool {
        self.is_noise() && self.force.is_some_and(|before| force > 0.5 * before)
    }

    /// Whether so many more corrections with the same matrix won't do.
    pub fn hopeless(&self, left: u32) -> bool {
        let theta = self.theta;
        theta >= 2.0
            || (theta > 0.9 && self.since > 4)
            || (theta < 1.0 && self.size * theta.powi(left as i32) / (1.0 - theta) > self.enough)
    }

    /// Whether the last correction is too large to be met by so many more with the same matrix.
    pub fn takes_longer(&self, corrections: i32) -> bool {
        self.since > 1 && !self.is_noise() && self.size * self.theta.powi(corrections) > self.stop
    }

    /// The rate that the present matrix showed above the noise; for a new one that wasn't seen at work zero.
    pub fn seen(&self, fresh: bool) -> Option<f64> {
        let seen = self.since > 1 && self.before > NOISE * self.floor;
        if seen { Some(self.theta) } else { fresh.then_some(0.0) }
    }
}
