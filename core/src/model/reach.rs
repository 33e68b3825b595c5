//! How far a step may go that doesn't leap over what changes with time of its own accord.
//!
//! Loads, motions and what else is a given function of time say it before every step of error control: a pulse of a
//! millisecond after an hour at rest is then as sure to be seen as a slow ramp. Who asks names the step that he would
//! like to take, and is told how much of it may be taken.

use crate::algebra::lane::V3;

/// Steps for each period of what goes to and fro.
const PER_PERIOD: f64 = 12.0;
/// Steps for each smooth rise.
const PER_RISE: f64 = 8.0;
/// By how much, in parts of the whole range of its values, a table may stray within a step from the straight line between
/// the ends of the step: kinks that are leapt over strike what is driven, at 2 % with a tension larger than all of its swing.
const STRAY: f64 = 0.005;
/// The same for functions that only show their values, and at the quarter points of the step.
const STRAY_SHOWN: f64 = 0.03;
/// From which part of the whole range on values that turn round go to and fro …
const TURNS: f64 = 0.1;
/// … and how many knots a half wave has at least to be smooth.
const SMOOTH: usize = 6;
/// How often a step is halved at most since a function looks rough.
const HALVINGS: u32 = 6;
/// Instants that are nearer to each other than this many units in the last place are the same.
pub(crate) const SAME: f64 = 16.0 * f64::EPSILON;

/// The part of a step `h` from `t` that follows what goes to and fro in this period.
///
/// ```
/// use ropewalk_core::reach;
/// // twelve steps for each period, at least
/// assert_eq!(reach::period(24.0, 60.0), 2.0);
/// ```
pub fn period(period: f64, h: f64) -> f64 {
    h.min(period.abs() / PER_PERIOD)
}

/// The part of a step `h` from `t` that doesn't leap over a smooth change between `start` and `end`.
///
/// ```
/// use ropewalk_core::reach;
/// // a ramp from 10 s to 14 s: a step from 9 s ends where it begins, one from there or just before goes an eighth of it
/// // beyond its start, and one from 14 s as far as it likes
/// assert_eq!(reach::rise(10.0, 14.0, 9.0, 60.0), 1.0);
/// assert_eq!(reach::rise(10.0, 14.0, 10.0, 60.0), 0.5);
/// assert_eq!(reach::rise(10.0, 14.0, 14.0, 60.0), 60.0);
/// ```
pub fn rise(start: f64, end: f64, t: f64, h: f64) -> f64 {
    if t >= end { h } else { after(start, t, h, (end - start) / PER_RISE) }
}

/// The part of a step `h` from `t` where steps end at a `start`, unless that is nearer than `most`, and may go no further than `most` beyond it.
pub fn after(start: f64, t: f64, h: f64, most: f64) -> f64 {
    let ahead = start - t;
    h.min(if ahead > most { ahead } else { ahead.max(0.0) + most })
}

/// The part of a step `h` from `t` that doesn't leap over the knots of a table, whose values are joined by straight lines
/// and stay what they are beyond its ends. `value` gives those at knot `k`, `size` is the range that all of them have.
///
/// A step ends at the next knot, or at the last one of many up to which the table hardly strays from a straight line: a
/// table that is finer than the steps doesn't hold them up.
///
/// ```
/// use ropewalk_core::reach;
/// let (times, values) = ([0.0, 10.0, 10.5, 60.0], [0.0, 0.0, 1.0, 1.0]);
/// // a step from rest ends where the values begin to rise
/// assert_eq!(reach::knots(&times, |k| [values[k], 0.0, 0.0], 1.0, 0.0, 100.0), 10.0);
/// ```
pub fn knots(times: &[f64], value: impl Fn(usize) -> V3<f64>, size: f64, t: f64, h: f64) -> f64 {
    // a knot that the last step ended at, but for rounding, is passed
    let first = times.partition_point(|&x| x <= t + SAME * t.abs());
    let ahead = &times[first.min(times.len())..];
    let count = ahead.iter().take_while(|&&x| x - t < h).count();
    if count == 0 {
        return h;
    }
    let now = between(times, &value, first, t);
    // slopes of the lines from here that pass all knots near enough
    let (mut least, mut most) = ([f64::NEG_INFINITY; 3], [f64::INFINITY; 3]);
    let mut reached = ahead[0] - t;
    for (k, &x) in ahead[..count].iter().enumerate() {
        let (far, v) = (x - t, value(first + k));
        let slope = |i: usize, off: f64| (v[i] + off - now[i]) / far;
        if (0..3).all(|i| slope(i, 0.0) >= least[i] && slope(i, 0.0) <= most[i]) {
            reached = far;
        }
        for i in 0..3 {
            least[i] = least[i].max(slope(i, -STRAY * size));
            most[i] = most[i].min(slope(i, STRAY * size));
        }
        if (0..3).any(|i| least[i] > most[i]) {
            break;
        }
    }
    reached
}

/// What steps must not leap over in a table: values that straight lines between these times follow.
///
/// ```
/// use ropewalk_core::reach::Knots;
/// let ramp = |t: f64| [t.clamp(0.0, 1.0), 0.0, 0.0];
/// let knots = Knots::at_rows(&[0.0, 1.0, 5.0], ramp);
/// assert_eq!(knots.reach(0.0, 10.0), 1.0);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Knots {
    times: Vec<f64>,
    value: Vec<V3<f64>>,
    size: f64,
    /// Of each coordinate the first and last times of its half waves.
    swings: [Vec<[f64; 2]>; 3],
}

impl Knots {
    /// At the rows of a table.
    pub fn at_rows(rows: &[f64], value: impl Fn(f64) -> V3<f64>) -> Self {
        Self::new(rows.to_vec(), value)
    }
    /// At the rows and half way between them, for what is curved there.
    pub fn halfway(rows: &[f64], value: impl Fn(f64) -> V3<f64>) -> Self {
        let both = rows.windows(2).flat_map(|t| [t[0], 0.5 * (t[0] + t[1])]);
        Self::new(both.chain(rows.last().copied()).collect(), value)
    }
    fn new(times: Vec<f64>, value: impl Fn(f64) -> V3<f64>) -> Self {
        let value: Vec<V3<f64>> = times.iter().map(|t| value(*t)).collect();
        let size = (0..3).fold(0.0, |size: f64, i| {
            let of = |pick: fn(f64, f64) -> f64| value.iter().map(|v| v[i]).reduce(pick).unwrap_or(0.0);
            let (least, most) = (of(f64::min), of(f64::max));
            // a constant isn't made of its rounding errors
            size.max(most - least + 1e-9 * most.abs().max(least.abs()))
        });
        let swings = std::array::from_fn(|i| half_waves(&times, |k| value[k][i], TURNS * size));
        Knots { times, value, size, swings }
    }
    /// How much of a step `h` from `t` leaps over none of them.
    pub fn reach(&self, t: f64, h: f64) -> f64 {
        knots(&self.times, |k| self.value[k], self.size, t, h)
    }
    /// The period with which they go to and fro at time `t` [s], smoothly: twice the shortest half wave there or next to it,
    /// infinite if there is none.
    pub fn period(&self, t: f64) -> f64 {
        let near = |waves: &Vec<[f64; 2]>| {
            let next = waves.partition_point(|wave| wave[1] <= t);
            let beside = waves[next.saturating_sub(1)..]
                .iter()
                .take(3)
                .map(|[from, to]| (from - t, t - to, to - from));
            // what comes before the first turning point and after the last is part of a wave, too
            let there = beside.filter(|(before, after, long)| before.max(*after) <= 1.5 * long);
            there.map(|(.., long)| 2.0 * long).fold(f64::INFINITY, f64::min)
        };
        self.swings.iter().map(near).fold(f64::INFINITY, f64::min)
    }
}

/// First and last times of the half waves between turning points, of values that turn round by more than `least`.
fn half_waves(times: &[f64], value: impl Fn(usize) -> f64, least: f64) -> Vec<[f64; 2]> {
    // the farthest knot the way that the values go, which way that is, and where they turned last
    let (mut far, mut up, mut turned) = (0, None, None);
    let mut waves = Vec::new();
    for k in 1..times.len() {
        let back = value(k) - value(far);
        let goes_on = up.is_some_and(|up| back == 0.0 || (back > 0.0) == up);
        let turns = !goes_on && back.abs() > least;
        if turns
            && up.is_some()
            && let Some(begin) = turned.replace(far)
            && far - begin >= SMOOTH
        {
            waves.push([times[begin], times[far]]);
        }
        if turns {
            up = Some(back > 0.0);
        }
        if turns || goes_on {
            far = k;
        }
    }
    waves
}

/// The value at `t` of a table whose next knot is number `next`.
fn between(times: &[f64], value: &impl Fn(usize) -> V3<f64>, next: usize, t: f64) -> V3<f64> {
    if next == 0 {
        return value(0);
    }
    let (a, b) = (value(next - 1), value(next));
    let x = ((t - times[next - 1]) / (times[next] - times[next - 1])).clamp(0.0, 1.0);
    std::array::from_fn(|i| a[i] + x * (b[i] - a[i]))
}

/// The part of a step `h` within which a function of time looks smooth: `off` says how far, in parts of its change, it is
/// at the quarter points of a step from what its ends promise. What lies between these points isn't seen.
pub(crate) fn shown(h: f64, mut off: impl FnMut(f64) -> f64) -> f64 {
    let mut step = h;
    for _ in 0..HALVINGS {
        if !(off(step) > STRAY_SHOWN) {
            break;
        }
        step *= 0.5;
    }
    step
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_ends_at_the_next_knot_unless_the_table_is_straight_there() {
        let (t, v) = ([1.0, 1.5, 2.0, 4.0, 4.5], [0.0, 0.505, 1.0, 1.0, 0.0]);
        let reach = |from: f64, h: f64| knots(&t, |k| [v[k], 0.0, 0.0], 1.0, from, h);
        assert_eq!(reach(0.0, 0.9), 0.9);
        assert_eq!(reach(0.0, 3600.0), 1.0);
        // nearly straight over the knot at 1.5, then it bends
        assert_eq!(reach(1.0, 0.9), 0.5);
        assert_eq!(reach(1.0, 9.0), 1.0);
        assert_eq!(reach(2.0, 9.0), 2.0);
        assert_eq!(reach(4.0 - 1e-16, 9.0), 0.5);
        assert_eq!(reach(4.5, 9.0), 9.0);
    }

    #[test]
    fn a_spike_in_a_long_fine_table_is_not_passed() {
        let t: Vec<f64> = (0..10_000).map(f64::from).collect();
        let reach = |from: f64| knots(&t, |k| [if k == 7000 { 1.0 } else { 0.0 }, 0.0, 0.0], 1.0, from, 1e9);
        assert_eq!([reach(0.0), reach(6999.0), reach(7000.0), reach(7001.0)], [6999.0, 1.0, 1.0, 2998.0]);
    }

    #[test]
    fn rises_and_periods_get_a_few_steps_each() {
        assert_eq!(
            [0.0, 9.0, 9.75, 10.0, 12.0, 14.0].map(|t| rise(10.0, 14.0, t, 60.0)),
            [10.0, 1.0, 0.75, 0.5, 0.5, 60.0]
        );
        assert_eq!([period(24.0, 60.0), period(24.0, 1.0)], [2.0, 1.0]);
    }

    #[test]
    fn a_table_knows_the_period_of_what_goes_to_and_fro_in_it() {
        // an hour at rest, ten waves of 8 s with noise, a way that doesn't return, one that is too coarse to be a wave
        let value = |t: f64| match t {
            t if t < 3600.0 => 0.0,
            t if t < 3680.0 => (std::f64::consts::TAU * (t - 3600.0) / 8.0).sin() + 0.01 * (9.0 * t).sin(),
            t if t < 3800.0 => 0.02 * (t - 3680.0),
            t => 2.4 - 3.0 * (t - 3800.0).rem_euclid(0.4),
        };
        let rows: Vec<f64> = (0..40_000).map(|k| 0.1 * f64::from(k)).collect();
        let knots = Knots::at_rows(&rows, |t| [0.0, value(t), 0.0]);
        assert_eq!([0.0, 3500.0].map(|t| knots.period(t)), [f64::INFINITY; 2]);
        assert!([3700.0, 3950.0].iter().all(|t| knots.period(*t) > 200.0));
        for t in [3599.0, 3603.0, 3640.0, 3670.0] {
            assert!((knots.period(t) - 8.0).abs() < 0.5, "{} at {t}", knots.period(t));
        }
    }
}
