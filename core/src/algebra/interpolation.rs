//! Values at given times, joined: by straight lines, by cubics that don't overshoot, or by a spline.

/// How the values of a table are joined between its rows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize, schemars::JsonSchema))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Join {
    /// Straight lines: exactly what the rows say, with a kink at each.
    #[default]
    Linear,
    /// Cubics that never overshoot (PCHIP; Fritsch and Carlson 1980, slopes of Fritsch and Butland 1984): between two rows
    /// the curve stays between their values. Its slope is continuous, and zero where the values turn round.
    Monotone,
    /// A cubic spline: slope and curvature are continuous. It overshoots where values change abruptly; the best for what
    /// is smooth and has many rows.
    Cubic,
}

/// What the first or last piece of a spline does at its outer end.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum EndSlope {
    /// Curvature zero: a natural spline.
    #[default]
    Natural,
    /// This slope.
    Given(f64),
    /// The first two pieces are one cubic ("not-a-knot"), so that the end is as curved as the rows near it.
    Smooth,
}

/// A function through values at ascending times: piece by piece a cubic, with its integral and derivatives.
///
/// ```
/// use ropewalk_core::{EndSlope, Interpolation, Join};
/// let speed = Interpolation::new(&[0.0, 1.0, 2.0], &[0.0, 2.0, 2.0], Join::Linear, [EndSlope::default(); 2]);
/// let [_, value, slope, _] = speed.at(0.5);
/// assert_eq!((value, slope), (1.0, 2.0));
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Interpolation {
    t: Vec<f64>,
    y: Vec<f64>,
    /// Slopes at both ends of each piece.
    slopes: Vec<[f64; 2]>,
    /// The integral from the first time to each.
    sum: Vec<f64>,
}

impl Interpolation {
    /// Joins values at ascending times, which the caller has checked. Slopes that are given at the ends hold for cubics and
    /// splines, other `ends` for splines only.
    pub fn new(t: &[f64], y: &[f64], join: Join, ends: [EndSlope; 2]) -> Self {
        let pieces = t.len().saturating_sub(1);
        let h: Vec<f64> = t.windows(2).map(|t| t[1] - t[0]).collect();
        let d: Vec<f64> = (0..pieces).map(|k| (y[k + 1] - y[k]) / h[k]).collect();
        let at_rows = match join {
            Join::Linear => Vec::new(),
            Join::Monotone => monotone(&h, &d, ends),
            Join::Cubic => spline(&h, &d, ends),
        };
        let slopes: Vec<[f64; 2]> = match join {
            Join::Linear => d.iter().map(|d| [*d; 2]).collect(),
            _ => at_rows.windows(2).map(|m| [m[0], m[1]]).collect(),
        };
        let mut sum = vec![0.0];
        for k in 0..pieces {
            let more = 0.5 * h[k] * (y[k] + y[k + 1]) + h[k] * h[k] / 12.0 * (slopes[k][0] - slopes[k][1]);
            sum.push(sum[k] + more);
        }
        Interpolation { t: t.to_vec(), y: y.to_vec(), slopes, sum }
    }

    /// The times.
    pub fn times(&self) -> &[f64] {
        &self.t
    }
    /// The values at the times.
    pub fn values(&self) -> &[f64] {
        &self.y
    }
    /// Slopes at both ends of each piece.
    pub fn slopes(&self) -> &[[f64; 2]] {
        &self.slopes
    }

    /// The integral since the first time, the value, its slope and its second derivative. Beyond its ends the first and
    /// last pieces go on, so that rounding of the last time does no harm.
    pub fn at(&self, t: f64) -> [f64; 4] {
        if self.slopes.is_empty() {
            let y = self.y.first().copied().unwrap_or(0.0);
            return [y * (t - self.t.first().copied().unwrap_or(0.0)), y, 0.0, 0.0];
        }
        let k = self.t.partition_point(|&x| x <= t).clamp(1, self.slopes.len()) - 1;
        let h = self.t[k + 1] - self.t[k];
        let u = (t - self.t[k]) / h;
        let (y0, y1) = (self.y[k], self.y[k + 1]);
        let [m0, m1] = self.slopes[k].map(|m| h * m);
        // y0 + m0 u + b u² + c u³
        let (b, c) = (3.0 * (y1 - y0) - 2.0 * m0 - m1, 2.0 * (y0 - y1) + m0 + m1);
        [
            self.sum[k] + h * u * (y0 + u * (m0 / 2.0 + u * (b / 3.0 + u * c / 4.0))),
            y0 + u * (m0 + u * (b + u * c)),
            (m0 + u * (2.0 * b + 3.0 * u * c)) / h,
            (2.0 * b + 6.0 * u * c) / (h * h),
        ]
    }
}

/// Slopes with which cubics don't overshoot: the weighted harmonic mean of the slopes on both sides, zero where these
/// differ in sign.
fn monotone(h: &[f64], d: &[f64], ends: [EndSlope; 2]) -> Vec<f64> {
    let n = h.len() + 1;
    let given = |k: usize| match ends[k] {
        EndSlope::Given(slope) => Some(slope),
        EndSlope::Natural | EndSlope::Smooth => None,
    };
    // that of the parabola through three rows, limited
    let end = |a: usize, b: usize| {
        let slope = ((2.0 * h[a] + h[b]) * d[a] - h[a] * d[b]) / (h[a] + h[b]);
        if slope * d[a] <= 0.0 {
            0.0
        } else if d[a] * d[b] <= 0.0 && slope.abs() > 3.0 * d[a].abs() {
            3.0 * d[a]
        } else {
            slope
        }
    };
    let inner = |k: usize| {
        let (before, after) = (d[k - 1], d[k]);
        if before * after <= 0.0 {
            return 0.0;
        }
        let (w1, w2) = (2.0 * h[k] + h[k - 1], h[k] + 2.0 * h[k - 1]);
        (w1 + w2) / (w1 / before + w2 / after)
    };
    match n {
        1 => vec![0.0],
        2 => (0..2).map(|k| given(k).unwrap_or(d[0])).collect(),
        _ => (0..n)
            .map(|k| match k {
                0 => given(0).unwrap_or_else(|| end(0, 1)),
                k if k == n - 1 => given(1).unwrap_or_else(|| end(n - 2, n - 3)),
                k => inner(k),
            })
            .collect(),
    }
}

/// Slopes of the cubic spline, by elimination of the tridiagonal system.
fn spline(h: &[f64], d: &[f64], ends: [EndSlope; 2]) -> Vec<f64> {
    let n = h.len() + 1;
    if n == 1 {
        return vec![0.0];
    }
    // `beyond` is the piece next to the one at the end, `this`: middle, off the diagonal, right side
    let end = |of: EndSlope, this: usize, beyond: Option<usize>| match (of, beyond) {
        (EndSlope::Given(slope), _) => (1.0, 0.0, slope),
        (EndSlope::Smooth, Some(b)) if n > 3 => {
            let both = h[this] + h[b];
            let right = (h[this] + 2.0 * both) * h[b] * d[this] + h[this] * h[this] * d[b];
            (h[b], both, right / both)
        }
        // three rows make one parabola
        (EndSlope::Smooth, Some(_)) => (1.0, 1.0, 2.0 * d[this]),
        _ => (2.0, 1.0, 3.0 * d[this]),
    };
    let (mut above, mut m) = (vec![0.0; n], vec![0.0; n]);
    for k in 0..n {
        let (lower, middle, upper, right) = if k == 0 {
            let (middle, upper, right) = end(ends[0], 0, (n > 2).then_some(1));
            (0.0, middle, upper, right)
        } else if k == n - 1 {
            let (middle, lower, right) = end(ends[1], n - 2, n.checked_sub(3));
            (lower, middle, 0.0, right)
        } else {
            let (a, b) = (h[k - 1], h[k]);
            (b, 2.0 * (a + b), a, 3.0 * (b * d[k - 1] + a * d[k]))
        };
        let (before, above_before) = if k == 0 { (0.0, 0.0) } else { (m[k - 1], above[k - 1]) };
        let pivot = middle - lower * above_before;
        above[k] = upper / pivot;
        m[k] = (right - lower * before) / pivot;
    }
    for k in (0..n - 1).rev() {
        m[k] -= above[k] * m[k + 1];
    }
    m
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    const NATURAL: [EndSlope; 2] = [EndSlope::Natural; 2];
    const T: [f64; 6] = [0.0, 0.3, 1.0, 1.2, 2.0, 3.1];

    fn of(f: impl Fn(f64) -> f64, join: Join, ends: [EndSlope; 2]) -> Interpolation {
        Interpolation::new(&T, &T.map(f), join, ends)
    }

    #[test]
    fn integral_and_derivatives_are_those_of_the_value() {
        let d = 1e-5;
        for join in [Join::Linear, Join::Monotone, Join::Cubic] {
            let i = of(f64::sin, join, [EndSlope::Smooth, EndSlope::Natural]);
            for t in [0.1, 0.5, 1.1, 1.9, 2.5, 3.4] {
                let ([s0, y0, m0, _], [s1, y1, m1, _]) = (i.at(t - d), i.at(t + d));
                let [_, y, slope, second] = i.at(t);
                let differences = [(s1 - s0) / (2.0 * d), (y1 - y0) / (2.0 * d), (m1 - m0) / (2.0 * d)];
                assert_relative_eq!(differences[..], [y, slope, second][..], epsilon = 1e-8);
            }
        }
    }

    #[test]
    fn rows_are_kept_and_what_should_be_continuous_is() {
        for (join, continuous) in [(Join::Linear, 2), (Join::Monotone, 3), (Join::Cubic, 4)] {
            let i = of(|t| (2.0 * t).sin(), join, NATURAL);
            for (t, y) in i.times().iter().zip(i.values()) {
                assert_relative_eq!(i.at(*t)[1], *y, epsilon = 1e-14);
            }
            for t in &T[1..5] {
                let (before, after) = (i.at(t - 1e-12), i.at(*t));
                assert_relative_eq!(before[..continuous], after[..continuous], epsilon = 1e-9);
            }
        }
    }

    #[test]
    fn monotone_stays_between_its_rows() {
        let y = [0.0, 0.0, 1.5, 1.5, -1.0, -1.1];
        let i = Interpolation::new(&T, &y, Join::Monotone, NATURAL);
        for k in 0..310 {
            let t = 0.01 * f64::from(k);
            let n = T.partition_point(|x| *x <= t).clamp(1, 5);
            let (a, b) = (y[n - 1].min(y[n]), y[n - 1].max(y[n]));
            let x = i.at(t)[1];
            assert!(x >= a - 1e-15 && x <= b + 1e-15, "{x} at {t}");
        }
    }

    #[test]
    fn splines_reproduce_the_cubics_that_their_ends_allow() {
        let cubic = |t: f64| t * t * (3.0 - t);
        let clamped =
            of(cubic, Join::Cubic, [EndSlope::Given(0.0), EndSlope::Given(3.1 * (6.0 - 3.0 * 3.1))]);
        let smooth = of(cubic, Join::Cubic, [EndSlope::Smooth; 2]);
        let mixed = of(cubic, Join::Cubic, [EndSlope::Given(0.0), EndSlope::Smooth]);
        let line = of(|t| 1.0 + 2.0 * t, Join::Cubic, NATURAL);
        for t in [0.1, 0.7, 1.9, 3.0] {
            for i in [&clamped, &smooth, &mixed] {
                assert_relative_eq!(i.at(t)[1], cubic(t), epsilon = 1e-13);
            }
            assert_relative_eq!(line.at(t)[1], 1.0 + 2.0 * t, epsilon = 1e-13);
        }
        let three = Interpolation::new(&T[..3], &T.map(|t| t * t)[..3], Join::Cubic, [EndSlope::Smooth; 2]);
        assert_relative_eq!(three.at(0.7)[1], 0.49, epsilon = 1e-14);
        let natural = of(f64::cos, Join::Cubic, NATURAL);
        assert_relative_eq!(natural.at(0.0)[3], 0.0, epsilon = 1e-12);
        assert_relative_eq!(natural.at(3.1)[3], 0.0, epsilon = 1e-12);
    }

    #[test]
    fn one_row_is_a_constant_and_two_are_a_line() {
        for join in [Join::Linear, Join::Monotone, Join::Cubic] {
            assert_eq!(Interpolation::new(&[1.0], &[2.0], join, NATURAL).at(3.0), [4.0, 2.0, 0.0, 0.0]);
            let two = Interpolation::new(&[0.0, 2.0], &[0.0, 1.0], join, NATURAL);
            assert_relative_eq!(two.at(2.0)[..], [1.0, 1.0, 0.5, 0.0][..], epsilon = 1e-15);
        }
    }
}
