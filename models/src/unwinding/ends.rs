//! The cable at its ends: tensions, curvatures, and the equation that finds the lift-off point.

use super::bordered::Bordered;
use super::problem::{Eyelet, LiftOff, Rule, Unwinding};
use super::state::{Column, Now, Rates, State, length, minus, plus};
use ropewalk_core::{V3, dot};

/// Curvature vector at an end where the cable is held along the unit vector `d`, which points inwards: the second
/// difference with the node beyond that the fourth difference uses. With it the bending moment at the end is of second
/// order (a one-sided difference of the nodes would be of first only, as these obey the fourth difference).
fn held(end: &V3<f64>, next: &V3<f64>, d: &V3<f64>, ell: f64) -> V3<f64> {
    plus(&minus(next, end), -ell, d).map(|k| 2.0 * k / (ell * ell))
}

impl Unwinding {
    /// Curvature vector at node `j` [1/m].
    pub(super) fn curvature(&self, y: &State, now: &Now, j: usize) -> V3<f64> {
        let n = y.segments();
        let ell = y.length[0] / n as f64;
        match (j, self.through, self.lift_off) {
            (0, Eyelet::Hinged, _) => [0.0; 3],
            (0, Eyelet::Guided(d), _) => held(&y.x[0], &y.x[1], &d, ell),
            (j, _, LiftOff::Free) if j == n => [0.0; 3],
            (j, _, LiftOff::Tangent) if j == n => held(&y.x[n], &y.x[n - 1], &now.clamp.map(|d| -d), ell),
            _ => [0, 1, 2].map(|i| (y.x[j + 1][i] - 2.0 * y.x[j][i] + y.x[j - 1][i]) / (ell * ell)),
        }
    }

    fn bend2(&self, y: &State, now: &Now, j: usize) -> f64 {
        let k = self.curvature(y, now, j);
        self.cable.ei * dot(&k, &k)
    }

    /// Rate of `T + EI κ²/2` along the cable at an end, by the tangential part of the equation of motion.
    fn slope_of_tension(&self, y: &State, now: &Now, j: usize) -> f64 {
        let n = y.segments();
        let [len, rate, rise] = y.length;
        let zeta = if j == 0 { 0.0 } else { 1.0 };
        let last = if j == 0 { 1 } else { n };
        let slope = minus(&y.x[last], &y.x[last - 1]).map(|d| d * n as f64 / len);
        let t = slope.map(|d| d / length(&slope));
        let v = plus(&y.v[j], -(now.speed[0] + zeta * rate), &t);
        let f = self.load(now.t, &self.station(y.x[j], v, slope)).f;
        self.cable.mass * (dot(&y.a[j], &t) - now.speed[1] - zeta * rise) - dot(&f, &t)
    }

    /// Tension at the eyelet and at the lift-off point [N]: from the segment next to it by half a segment of the
    /// tension's own equation, `(T + EI κ²/2)' = m a·t - f·t`.
    pub(super) fn tensions(&self, y: &State, now: &Now) -> [f64; 2] {
        let n = y.segments();
        let half = 0.5 * y.length[0] / n as f64;
        // T + EI κ²/2 at the middle of the segment, with the mean of κ², less EI κ²/2 at the end and `surplus`: the end's
        // own curvature drops out
        let end = |lambda: f64, j: usize, next: usize, way: f64| {
            lambda + 0.75 * self.bend2(y, now, next) + way * self.slope_of_tension(y, now, j)
        };
        [end(y.lambda[0], 0, 1, -half), end(y.lambda[n - 1], n, n - 1, half)]
    }

    /// What a held end adds to the multiplier of its segment: the node beyond the end is off the curve by `κ² ℓ³/4` along
    /// the cable, so that the fourth difference has a part `EI κ²/4ℓ` along it, which nothing else feels.
    fn surplus(&self, y: &State, now: &Now, j: usize) -> f64 {
        0.25 * self.bend2(y, now, j)
    }

    /// Whether the rule needs the peeled length as an unknown.
    pub(super) fn scalar(&self) -> bool {
        self.rule != Rule::Length
    }

    /// The equation of the lift-off point, in the border's row.
    pub(super) fn find(&self, y: &State, now: &Now, rates: &Rates, column: &Column, out: &mut Bordered) {
        let n = self.elements;
        match &self.rule {
            Rule::Length => {}
            Rule::Tension(pull) => {
                self.pulled(y, now, pull.at(now.t, now.speed[0]), rates, column, out);
            }
            Rule::Peel(energy) => {
                let ell = y.length[0] / n as f64;
                let jump = minus(&self.curvature(y, now, n), &now.lay.curvature);
                let ei = self.cable.ei;
                // over the weight of the momentum rows
                let scale = self.cable.mass / energy;
                out.rhs[4 * n - 3] = -scale * (0.5 * ei * dot(&jump, &jump) - energy);
                let by = jump.map(|k| scale * ei * k * 2.0 / (ell * ell));
                (0..3).for_each(|i| out.add(4 * n - 3, 4 * (n - 2) + 1 + i, rates.x * by[i]));
                // by the length, the lift-off point and the direction there; the path's third derivative is left out
                let d_ell = column.length[0] / n as f64;
                let kappa = self.curvature(y, now, n);
                let change = [0, 1, 2].map(|i| {
                    let moved = d_ell * now.clamp[i] + ell * column.clamp[i] - column.end[0][i];
                    2.0 * (moved / ell - kappa[i] * d_ell) / ell
                });
                out.add(4 * n - 3, 4 * n - 3, scale * ei * dot(&jump, &change));
            }
        }
    }

    /// The row "tension at the eyelet is `tension`".
    pub(super) fn pulled(
        &self,
        y: &State,
        now: &Now,
        tension: f64,
        rates: &Rates,
        column: &Column,
        out: &mut Bordered,
    ) {
        let n = self.elements;
        let row = 4 * n - 3;
        let (len, ei, half) = (y.length[0], self.cable.ei, 0.5 * y.length[0] / n as f64);
        let ell = 2.0 * half;
        out.rhs[row] = tension - self.tensions(y, now)[0];
        out.add(row, 0, 1.0);
        let r = column.length[0] / len;
        let mut by_length = 0.0;
        if ei > 0.0 {
            // by the curvature at the first inner node
            let k = self.curvature(y, now, 1);
            let by = k.map(|k| 1.5 * ei * k / (ell * ell));
            for (node, w) in [-2.0, 1.0].into_iter().enumerate() {
                (0..3).for_each(|i| out.add(row, 4 * node + 1 + i, rates.x * w * by[i]));
            }
            by_length -= 3.0 * ei * dot(&k, &k) * r;
        }
        // half a segment's load: the direction there is that of the first segment
        let slope = minus(&y.x[1], &y.x[0]).map(|d| d / ell);
        let t = slope.map(|d| d / length(&slope));
        let speed = now.speed[0];
        let v = t.map(|t| -speed * t);
        let load = self.load(now.t, &self.station(y.x[0], v, slope));
        let stretch = length(&slope);
        let turn = |d: V3<f64>| {
            // of a change of the slope: the change of t, and of f·t
            let along = dot(&t, &d);
            let dt = [0, 1, 2].map(|i| (d[i] - along * t[i]) / stretch);
            let df: f64 = (0..3)
                .map(|i| {
                    t[i] * (0..3)
                        .map(|k| load.d_slope[i][k] * d[k] - speed * load.d_v[i][k] * dt[k])
                        .sum::<f64>()
                })
                .sum();
            half * (df + dot(&load.f, &dt))
        };
        for k in 0..3 {
            let mut d = [0.0; 3];
            d[k] = 1.0 / ell;
            out.add(row, 1 + k, rates.x * turn(d));
        }
        by_length -= r * half * self.slope_of_tension(y, now, 0);
        by_length += turn(slope.map(|s| -r * s));
        out.add(row, row, by_length);
    }

    /// The tension at the middle of every segment [N] found by marching `(T + EI κ²/2)' = m a·t - f·t` from its value at
    /// the eyelet: a check of the multipliers, which come from the differentiated constraint instead.
    pub(super) fn marched(&self, y: &State, now: &Now) -> Vec<f64> {
        let n = y.segments();
        let ell = y.length[0] / n as f64;
        let mut sum = self.tensions(y, now)[0]
            + 0.5 * self.bend2(y, now, 0)
            + 0.5 * ell * self.slope_of_tension(y, now, 0);
        (0..n)
            .map(|j| {
                if j > 0 {
                    let s = self.stencil(y, now, j);
                    let t = s.d1x.map(|d| d / length(&s.d1x));
                    let f = self.load(now.t, &self.station(y.x[j], s.v(y, j), s.d1x)).f;
                    sum += ell * (self.cable.mass * dot(&s.a, &t) - dot(&f, &t));
                }
                sum - 0.25 * (self.bend2(y, now, j) + self.bend2(y, now, j + 1))
            })
            .collect()
    }

    /// The tension at the middle of every segment [N]: `λ + EI κ²`.
    pub(super) fn tension(&self, y: &State, now: &Now) -> Vec<f64> {
        let n = y.segments();
        (0..n)
            .map(|j| {
                let ends = if j == 0 { self.surplus(y, now, 0) } else { 0.0 }
                    + if j + 1 == n { self.surplus(y, now, n) } else { 0.0 };
                y.lambda[j] + 0.5 * (self.bend2(y, now, j) + self.bend2(y, now, j + 1)) - ends
            })
            .collect()
    }
}
