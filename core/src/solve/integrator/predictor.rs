//! The prediction of accelerations: polynomials through those of the last steps.

use super::workspace::Workspace;
use crate::algebra::lane::{LaneTask, Real, Width, run};
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
    let ([x1, y1, _], quadratic) = (past.continued(1), past.continued(2));
    let (mut miss, linear) = ([0.0; 3], [x1, y1]);
    run(Width::best(), Misses { new, past: [a, one, two], mass, linear, quadratic, miss: &mut miss });
    let backs = (state.control.backs + 1).min(2);
    (1..=backs).fold(0, |best, k| if miss[k] < miss[best] { k } else { best })
}

/// By how much polynomials of each order would have missed the new accelerations: weighted squares.
struct Misses<'a> {
    new: &'a [f64],
    past: [&'a [f64]; 3],
    mass: &'a [f64],
    linear: [f64; 2],
    quadratic: [f64; 3],
    miss: &'a mut [f64; 3],
}

impl Misses<'_> {
    /// Of as many numbers as there are lanes, from one on.
    #[inline(always)]
    fn of<R: Real>(&self, i: usize) -> [R; 3] {
        let ([x1, y1], [x2, y2, z2]) = (self.linear, self.quadratic);
        let (new, mass) = (R::read(&self.new[i..]), R::read(&self.mass[i..]));
        let [a, one, two] =
            [R::read(&self.past[0][i..]), R::read(&self.past[1][i..]), R::read(&self.past[2][i..])];
        let constant = new - a;
        let linear = new - R::of(x1).fma(a, R::of(y1) * one);
        let quadratic = new - R::of(x2).fma(a, R::of(y2).fma(one, R::of(z2) * two));
        [mass * constant * constant, mass * linear * linear, mass * quadratic * quadratic]
    }
}

impl LaneTask for Misses<'_> {
    #[inline(always)]
    fn go<R: Real>(self) {
        let (n, mut sums) = (self.new.len(), [R::zero(); 3]);
        let whole = n - n % R::LANES;
        for i in (0..whole).step_by(R::LANES) {
            let miss = self.of::<R>(i);
            for k in 0..3 {
                sums[k] += miss[k];
            }
        }
        for k in 0..3 {
            for lane in 0..R::LANES {
                self.miss[k] += sums[k].lane(lane);
            }
        }
        for i in whole..n {
            let miss = self.of::<f64>(i);
            for k in 0..3 {
                self.miss[k] += miss[k];
            }
        }
    }
}
