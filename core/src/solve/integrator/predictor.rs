//! The prediction of accelerations: polynomials through those of the last steps.

use super::workspace::Workspace;
use crate::model::state::State;

/// The times of the accelerations that are kept, before the present one.
pub(super) struct Past {
    h: f64,
    one: f64,
    two: f64,
}

impl Past {
    pub fn new(state: &State, h: f64) -> Self {
        let c = &state.control;
        // without a past any time will do: its weight isn't used
        let one = if c.h_last > 0.0 { c.h_last } else { h };
        Past { h, one, two: one + if c.h_before > 0.0 { c.h_before } else { h } }
    }
    /// Weights of the present acceleration and of those one and two steps back, to continue the polynomial of this
    /// order by a step `h`.
    pub fn continued(&self, order: usize) -> [f64; 3] {
        let Past { h, one, two } = *self;
        match order {
            0 => [1.0, 0.0, 0.0],
            1 => [1.0 + h / one, -h / one, 0.0],
            _ => [
                (h + one) * (h + two) / (one * two),
                -h * (h + two) / (one * (two - one)),
                h * (h + one) / (two * (two - one)),
            ],
        }
    }
}

/// The order of the polynomial that would have predicted the accelerations of the trial best.
pub(super) fn best_order(state: &State, h: f64, work: &Workspace) -> usize {
    let n = state.a.len();
    let past = Past::new(state, h);
    let [one, two] = &state.control.a_back;
    let a = &state.a[..n];
    // where there is no past yet, its weight is zero
    let one = if state.control.backs > 0 { &one[..n] } else { a };
    let two = if state.control.backs > 1 { &two[..n] } else { a };
    let (new, mass) = (&work.trial.a[..n], &work.norms.weights()[..n]);
    let ([x1, y1, _], [x2, y2, z2]) = (past.continued(1), past.continued(2));
    let mut miss = [0.0; 3];
    for i in 0..n {
        let constant = new[i] - a[i];
        let linear = new[i] - (x1 * a[i] + y1 * one[i]);
        let quadratic = new[i] - (x2 * a[i] + y2 * one[i] + z2 * two[i]);
        miss[0] += mass[i] * constant * constant;
        miss[1] += mass[i] * linear * linear;
        miss[2] += mass[i] * quadratic * quadratic;
    }
    let backs = (state.control.backs + 1).min(2);
    (1..=backs).fold(0, |best, k| if miss[k] < miss[best] { k } else { best })
}
