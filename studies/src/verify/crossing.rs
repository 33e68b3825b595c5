//! Where a sampled history passes zero, and values between samples.

use serde::Deserialize;

/// Which way a history passes zero.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Direction {
    /// From below.
    Up,
    /// From above.
    Down,
    /// Any.
    #[default]
    Either,
}

/// The times at which `x` passes zero. A zero at the first sample is none.
pub(super) fn crossings(t: &[f64], x: &[f64], direction: Direction) -> Vec<f64> {
    let mut found = Vec::new();
    for k in 1..x.len() {
        let (a, b) = (x[k - 1], x[k]);
        let up = a < 0.0 && b >= 0.0;
        let down = a > 0.0 && b <= 0.0;
        let wanted = match direction {
            Direction::Up => up,
            Direction::Down => down,
            Direction::Either => up || down,
        };
        if wanted {
            found.push(between(t, x, k));
        }
    }
    found
}

/// The zero between the samples `k - 1` and `k`, by bisection of the interpolation.
fn between(t: &[f64], x: &[f64], k: usize) -> f64 {
    let (mut low, mut high) = (t[k - 1], t[k]);
    let below = x[k - 1] < 0.0;
    for _ in 0..80 {
        let mid = 0.5 * (low + high);
        if (interpolated(t, x, mid) < 0.0) == below { low = mid } else { high = mid }
    }
    high
}

/// The value at a time, by the cubic through the four samples around it: of fourth order in their distance.
pub(super) fn interpolated(t: &[f64], x: &[f64], at: f64) -> f64 {
    let n = t.len();
    let after = t.partition_point(|t| *t <= at);
    let first = after.saturating_sub(2).min(n.saturating_sub(4));
    let some = first..(first + 4).min(n);
    some.clone()
        .map(|i| {
            let weight: f64 = some.clone().filter(|j| *j != i).map(|j| (at - t[j]) / (t[i] - t[j])).product();
            weight * x[i]
        })
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zeros_of_a_sine_are_found_to_the_fourth_order() {
        let error = |n: usize| {
            let t: Vec<f64> = (0..=n).map(|k| 7.0 * k as f64 / n as f64).collect();
            let x: Vec<f64> = t.iter().map(|t| t.sin()).collect();
            let all = crossings(&t, &x, Direction::Either);
            assert_eq!(all.len(), 2, "the zero at the start doesn't count");
            assert_eq!(crossings(&t, &x, Direction::Up).len(), 1);
            (all[0] - std::f64::consts::PI).abs().max((interpolated(&t, &x, 1.0) - 1f64.sin()).abs())
        };
        let (coarse, fine) = (error(50), error(100));
        assert!(fine < 1e-6 && coarse / fine > 8.0, "{coarse:e} {fine:e}");
    }
}
