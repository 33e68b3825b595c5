//! A measured or computed motion.

use ropewalk_core::build::{BuildError, finite, need};
use ropewalk_core::{Motion, Moving, V3, reach};

/// What a [`Table`] does at its ends.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Ends {
    /// No acceleration at either end; the usual choice for a record that is cut out of a longer one.
    #[default]
    Natural,
    /// No velocity at either end.
    AtRest,
    /// Starts without velocity and ends without acceleration: a manoeuvre from rest.
    FromRest,
}

/// Displacements at given times, joined by a cubic spline with two continuous derivatives.
///
/// Rows are displacements from where the driven marker starts, so the first one is usually zero. It is defined for the
/// time of its rows only.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    t: Vec<f64>,
    x: Vec<V3<f64>>,
    /// Acceleration at each time.
    a: Vec<V3<f64>>,
}

impl Table {
    /// A spline through rows of time [s] and displacement `x, y, z` [m].
    ///
    /// # Errors
    /// Fewer than two rows, times that don't ascend, numbers that aren't finite.
    pub fn new(rows: &[[f64; 4]], ends: Ends) -> Result<Self, BuildError> {
        need(rows.len() >= 2, || format!("motion table: needs two rows or more, not {}", rows.len()))?;
        for (k, row) in rows.iter().enumerate() {
            finite(&format!("motion table: row {}", k + 1), row)?;
        }
        for (k, w) in rows.windows(2).enumerate() {
            need(w[0][0] < w[1][0], || {
                format!(
                    "motion table: times must ascend, but row {} is at {} s after {} s",
                    k + 2,
                    w[1][0],
                    w[0][0]
                )
            })?;
        }
        let t: Vec<f64> = rows.iter().map(|r| r[0]).collect();
        let x: Vec<V3<f64>> = rows.iter().map(|r| [r[1], r[2], r[3]]).collect();
        let a = accelerations(&t, &x, ends);
        Ok(Table { t, x, a })
    }
}

/// Second derivatives of the spline at its knots, by elimination of the tridiagonal system.
fn accelerations(t: &[f64], x: &[V3<f64>], ends: Ends) -> Vec<V3<f64>> {
    let n = t.len();
    let rest = [ends != Ends::Natural, ends == Ends::AtRest];
    let h = |k: usize| t[k + 1] - t[k];
    let slope = |k: usize, c: usize| (x[k + 1][c] - x[k][c]) / h(k);
    let mut above = vec![0.0; n];
    let mut a = vec![[0.0; 3]; n];
    for k in 0..n {
        // row k: lower a[k-1] + middle a[k] + upper a[k+1] = right
        let (lower, middle, upper, right): (f64, f64, f64, V3<f64>) = if k == 0 && rest[0] {
            (0.0, 2.0 * h(0), h(0), std::array::from_fn(|c| 6.0 * slope(0, c)))
        } else if k == n - 1 && rest[1] {
            (h(k - 1), 2.0 * h(k - 1), 0.0, std::array::from_fn(|c| -6.0 * slope(k - 1, c)))
        } else if k == 0 || k == n - 1 {
            (0.0, 1.0, 0.0, [0.0; 3])
        } else {
            let right = std::array::from_fn(|c| 6.0 * (slope(k, c) - slope(k - 1, c)));
            (h(k - 1), 2.0 * (h(k - 1) + h(k)), h(k), right)
        };
        let (before, above_before) = if k == 0 { ([0.0; 3], 0.0) } else { (a[k - 1], above[k - 1]) };
        let pivot = middle - lower * above_before;
        above[k] = upper / pivot;
        a[k] = std::array::from_fn(|c| (right[c] - lower * before[c]) / pivot);
    }
    for k in (0..n - 1).rev() {
        a[k] = std::array::from_fn(|c| a[k][c] - above[k] * a[k + 1][c]);
    }
    a
}

impl Motion for Table {
    fn at(&self, t: f64) -> Moving {
        // beyond its ends the first and last pieces go on, so that rounding of the last time does no harm
        let k = self.t.partition_point(|&x| x <= t).clamp(1, self.t.len() - 1) - 1;
        let h = self.t[k + 1] - self.t[k];
        let (p, q) = ((self.t[k + 1] - t) / h, (t - self.t[k]) / h);
        let mut m = Moving::default();
        for c in 0..3 {
            let (x0, x1, a0, a1) = (self.x[k][c], self.x[k + 1][c], self.a[k][c], self.a[k + 1][c]);
            m.x[c] = p * x0 + q * x1 + h * h / 6.0 * ((p * p * p - p) * a0 + (q * q * q - q) * a1);
            m.v[c] = (x1 - x0) / h + h / 6.0 * ((3.0 * q * q - 1.0) * a1 - (3.0 * p * p - 1.0) * a0);
            m.a[c] = p * a0 + q * a1;
        }
        m
    }
    /// The accelerations of the rows are joined by straight lines.
    fn reach(&self, t: f64, h: f64) -> Option<f64> {
        let size = self.a.iter().flatten().fold(0.0, |m: f64, a| m.max(a.abs()));
        Some(reach::knots(&self.t, |k| self.a[k], size, t, h))
    }
    fn range(&self) -> (f64, f64) {
        (self.t[0], self.t[self.t.len() - 1])
    }
}
