//! When the iteration matrix is assembled and factored anew, and when kept factors are good enough.

use super::convergence::Convergence;
use super::options::NewtonPolicy;
use crate::model::state::Control;

/// Rate from which on the next step gets a new matrix.
const WORN: f64 = 0.1;
/// Rate from which on kept factors are given up within a step.
const SLOW: f64 = 0.5;
/// Iterations with kept factors that are cheaper than new factors.
const PATIENCE: i32 = 3;
/// An iteration that still diverges after so many new matrices is given up.
const MOST_RENEWALS: u32 = 3;
/// The same where forces were approximated at kinks, which renews the matrix every time.
const MOST_AT_KINKS: u32 = 10;
/// For how many steps kept factors aren't tried after they failed, first and at most.
const WITHOUT: [u32; 2] = [4, 64];

/// The policy of one iteration: what has become of its factors.
pub(super) struct Factors {
    /// Whether every correction has a new matrix.
    pub always: bool,
    /// New matrices so far.
    renewals: u32,
    /// Whether kept factors had to be replaced.
    pub kept_failed: bool,
}

/// What to do about an iteration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Remedy {
    GoOn,
    /// With a new matrix.
    Renew,
    GiveUp,
}

impl Factors {
    pub fn new(policy: NewtonPolicy) -> Self {
        Factors { always: policy == NewtonPolicy::Full, renewals: 0, kept_failed: false }
    }

    /// Whether the factors were made within this iteration.
    pub fn fresh(&self) -> bool {
        self.renewals > 0
    }

    /// Whether an iteration that would go on for long with its matrix gets a new one.
    pub fn slow(&self, convergence: &Convergence) -> bool {
        convergence.takes_longer(PATIENCE)
    }

    /// Notes a new matrix, after corrections that were slow or not.
    pub fn renewed(&mut self, convergence: &Convergence, slow: bool) {
        self.kept_failed |= slow && !self.fresh() && convergence.theta > SLOW;
        self.renewals += 1;
    }

    /// Once corrections grow, for an iteration that renews its matrix by itself where it is slow.
    pub fn diverged(&self, at_kinks: bool) -> Remedy {
        match self.renewals {
            0 => Remedy::Renew,
            1..=MOST_RENEWALS => Remedy::GoOn,
            ..MOST_AT_KINKS if at_kinks => Remedy::GoOn,
            _ => Remedy::GiveUp,
        }
    }

    /// After a correction that isn't the last, with so many left.
    pub fn judge(&self, convergence: &Convergence, left: u32) -> Remedy {
        match (convergence.hopeless(left), self.fresh()) {
            (true, true) => Remedy::GiveUp,
            (false, true) => Remedy::GoOn,
            (hopeless, false) if hopeless || convergence.theta > SLOW => Remedy::Renew,
            (_, false) => Remedy::GoOn,
        }
    }
}

/// What integrators remember of factors from step to step.
impl Control {
    /// Whether kept factors served badly in the last step.
    pub(super) fn worn(&self) -> bool {
        self.theta > WORN
    }

    /// Whether kept factors failed of late, so that the matrix is made anew at every correction.
    pub(super) fn without_kept(&self) -> bool {
        self.renew > 0
    }

    /// Notes whether kept factors failed in an accepted step: each failure makes it twice as many without them.
    pub(super) fn note_factors(&mut self, kept_failed: bool) {
        if kept_failed {
            self.renew_next = (2 * self.renew_next).clamp(WITHOUT[0], WITHOUT[1]);
            self.renew = self.renew_next;
        } else {
            self.renew_next = if self.renew == 0 { 0 } else { self.renew_next };
            self.renew = self.renew.saturating_sub(1);
        }
    }
}
