//! Stiffness that isn't constant: tables of force over strain and of moment over curvature.
//!
//! Between the points of a table stands the monotone cubic of Fritsch & Carlson (SIAM J. Numer. Anal. 17, 1980) with the
//! slopes of Fritsch & Butland (SIAM J. Sci. Stat. Comput. 5, 1984): it has a continuous slope and no hump that the table
//! hasn't. It is integrated in closed form, so that the energy is that of the force to rounding.

use ropewalk_core::BuildError;
use ropewalk_scene::quantity;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Axial force over strain, such as of a fibre rope: `{ strain = [0, 0.01, 0.03], force = ["0 kN", "10 kN", "60 kN"] }`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AxialForce {
    /// Engineering strains, ascending, 0 among them [1].
    #[serde(deserialize_with = "quantity::list::number")]
    pub strain: Vec<f64>,
    /// The force at each of them [N], 0 at strain 0; it mustn't fall.
    #[serde(deserialize_with = "quantity::list::force")]
    pub force: Vec<f64>,
}

/// Bending moment over curvature, such as of a pipe whose layers slip:
/// `{ curvature = [0, 0.01, 0.1], moment = ["0 N m", "50 N m", "80 N m"] }`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BendingMoment {
    /// Curvatures from 0 on, ascending [1/m].
    #[serde(deserialize_with = "quantity::list::curvature")]
    pub curvature: Vec<f64>,
    /// The moment at each of them [N m], from 0 on; it mustn't fall.
    #[serde(deserialize_with = "quantity::list::moment")]
    pub moment: Vec<f64>,
}

/// A monotone cubic through the points of a table, straight beyond them.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    x: Vec<f64>,
    y: Vec<f64>,
    /// Slopes at the points.
    slope: Vec<f64>,
    /// Integrals from 0 to the points.
    area: Vec<f64>,
}

impl AxialForce {
    /// The curve of the table.
    ///
    /// # Errors
    /// A table that isn't one, or that has a force without strain.
    pub fn curve(&self) -> Result<Curve, BuildError> {
        let curve = Curve::through(&self.strain, &self.force, ["strain", "force"])?;
        let nought = self.strain.iter().position(|x| *x == 0.0);
        if nought.is_none_or(|k| self.force[k] != 0.0) {
            let message = "the table of the axial force needs a strain of 0, where the force is 0";
            return Err(BuildError::at("strain", message));
        }
        if self.strain[0] <= -1.0 {
            return Err(BuildError::at("strain", "a strain of -1 is a cable pressed to nothing"));
        }
        Ok(curve)
    }
}

impl BendingMoment {
    /// The curve of the table, which goes on to negative curvatures with the same stiffness: without a bend at 0.
    ///
    /// # Errors
    /// A table that isn't one, or that doesn't begin with nothing.
    pub fn curve(&self) -> Result<Curve, BuildError> {
        let curve = Curve::through(&self.curvature, &self.moment, ["curvature", "moment"])?;
        if self.curvature[0] != 0.0 || self.moment[0] != 0.0 {
            let message =
                "the table of the bending moment begins with a curvature of 0, where the moment is 0";
            return Err(BuildError::at("curvature", message));
        }
        Ok(curve.odd())
    }
}

impl Curve {
    fn through(x: &[f64], y: &[f64], names: [&str; 2]) -> Result<Self, BuildError> {
        let fault = |k: usize, message: String| Err(BuildError::at(names[k], message));
        if x.len() < 2 || x.len() != y.len() {
            let message = format!(
                "a table has two points or more: `{}` has {} numbers, `{}` has {}",
                names[0],
                x.len(),
                names[1],
                y.len()
            );
            return fault(1, message);
        }
        if x.windows(2).any(|w| !(w[1] > w[0])) {
            return fault(0, format!("each `{}` of the table must be larger than the one before", names[0]));
        }
        if y.windows(2).any(|w| !(w[1] >= w[0])) {
            let message = format!("the `{}` of the table falls: nothing would hold what is there", names[1]);
            return fault(1, message);
        }
        if !(y[y.len() - 1] > y[0]) {
            return fault(1, format!("the `{}` of the table is the same everywhere", names[1]));
        }
        let slope = slopes(x, y);
        Ok(Curve { x: x.to_vec(), y: y.to_vec(), slope, area: Vec::new() }.integrated())
    }

    /// The same with a slope at 0 that makes the first piece odd.
    fn odd(mut self) -> Self {
        let secant = self.y[1] / self.x[1];
        self.slope[0] = if self.x.len() == 2 { secant } else { 0.5 * (3.0 * secant - self.slope[1]) };
        self.integrated()
    }

    fn integrated(mut self) -> Self {
        let mut area = vec![0.0];
        for k in 0..self.x.len() - 1 {
            let h = self.x[k + 1] - self.x[k];
            let mean = 0.5 * (self.y[k] + self.y[k + 1]) + h / 12.0 * (self.slope[k] - self.slope[k + 1]);
            area.push(area[k] + h * mean);
        }
        self.area = area;
        let [nought, ..] = self.at(0.0);
        self.area.iter_mut().for_each(|a| *a -= nought);
        self
    }

    /// The largest slope at its points.
    pub fn stiffness(&self) -> f64 {
        self.slope.iter().copied().fold(0.0, f64::max)
    }

    /// Integral from 0, value and slope at `x`.
    pub fn at(&self, x: f64) -> [f64; 3] {
        let last = self.x.len() - 1;
        let end = if x < self.x[0] {
            Some(0)
        } else if x >= self.x[last] {
            Some(last)
        } else {
            None
        };
        if let Some(k) = end {
            let (d, slope) = (x - self.x[k], self.slope[k]);
            return [self.area[k] + d * (self.y[k] + 0.5 * slope * d), self.y[k] + slope * d, slope];
        }
        // a NaN ends up here, and goes on as one
        let k = self.x.partition_point(|p| *p <= x).clamp(1, last) - 1;
        let (h, d) = (self.x[k + 1] - self.x[k], x - self.x[k]);
        let secant = (self.y[k + 1] - self.y[k]) / h;
        let (m0, m1) = (self.slope[k], self.slope[k + 1]);
        let (b, c) = ((3.0 * secant - 2.0 * m0 - m1) / h, (m0 + m1 - 2.0 * secant) / (h * h));
        [
            self.area[k] + d * (self.y[k] + d * (0.5 * m0 + d * (b / 3.0 + 0.25 * d * c))),
            self.y[k] + d * (m0 + d * (b + d * c)),
            m0 + d * (2.0 * b + 3.0 * d * c),
        ]
    }

    /// Of a moment over curvature: energy and its first and second derivative by the square of the curvature.
    pub fn by_square(&self, square: f64) -> [f64; 3] {
        let first = self.x[1];
        if square < first * first || self.x.len() == 2 {
            // `M = a κ + c κ³`
            let (a, m1) = (self.slope[0], self.slope[1]);
            let c = if self.x.len() == 2 { 0.0 } else { (m1 * first - self.y[1]) / (2.0 * first.powi(3)) };
            return [square * (0.5 * a + 0.25 * c * square), 0.5 * (a + c * square), 0.5 * c];
        }
        let kappa = square.sqrt();
        let [energy, moment, slope] = self.at(kappa);
        let secant = moment / kappa;
        [energy, 0.5 * secant, 0.25 * (slope - secant) / square]
    }
}

/// Slopes of the monotone cubic at the points of a table.
fn slopes(x: &[f64], y: &[f64]) -> Vec<f64> {
    let n = x.len();
    let h: Vec<f64> = x.windows(2).map(|w| w[1] - w[0]).collect();
    let d: Vec<f64> = (0..n - 1).map(|k| (y[k + 1] - y[k]) / h[k]).collect();
    if n == 2 {
        return vec![d[0]; 2];
    }
    // the slope at an end, of the parabola through three points as far as that is monotone and something is left beyond
    let end = |h0: f64, h1: f64, d0: f64, d1: f64| {
        let slope = ((2.0 * h0 + h1) * d0 - h0 * d1) / (h0 + h1);
        slope.clamp(0.5 * d0, 3.0 * d0)
    };
    let inner = |k: usize| {
        let (a, b) = (d[k - 1], d[k]);
        if a * b == 0.0 {
            return 0.0;
        }
        let (wa, wb) = (2.0 * h[k] + h[k - 1], h[k] + 2.0 * h[k - 1]);
        (wa + wb) / (wa / a + wb / b)
    };
    let first = end(h[0], h[1], d[0], d[1]);
    let last = end(h[n - 2], h[n - 3], d[n - 2], d[n - 3]);
    std::iter::once(first).chain((1..n - 1).map(inner)).chain([last]).collect()
}
