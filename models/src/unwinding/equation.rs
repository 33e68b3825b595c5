//! The equation of motion on the grid: residual and tangent.
//!
//! With `c = V + ζ L̇` the speed at which the material runs over the nodes, the acceleration of the material is
//!
//! `a = ẍ - 2c ẋ' + c² x'' + (2c L̇/L - V̇ - ζ L̈) x'`,
//!
//! dots being derivatives at fixed `ζ` and primes those by arc length, which are central differences here; and
//!
//! `m a = (λ x')' - EI x'''' + f`, `|x'| = 1`.
//!
//! `λ` lives in the segments and holds each at its length `L/N`. The constraint stands in the system as
//! `g̈ + 2ω ġ + ω² g = 0` (Baumgarte 1972): its first term is the differentiated constraint, hence the elliptic equation
//! of the tension in discrete form; the others let no error build up.

use super::bordered::Bordered;
use super::problem::{Eyelet, LiftOff, Unwinding};
use super::state::{Column, M3, Now, Rates, State, identity, length, minus, plus, times};
use ropewalk_core::{Law, Load, V3, dot};

/// The differences about one node.
pub(super) struct Stencil {
    pub zeta: f64,
    /// Speed of the material over the node, and the factor of `x'` in the acceleration.
    pub over: f64,
    pub slip: f64,
    pub d1x: V3<f64>,
    pub d1v: V3<f64>,
    pub d2x: V3<f64>,
    /// Acceleration of the material.
    pub a: V3<f64>,
}

impl Unwinding {
    /// The differences about an inner node.
    pub(super) fn stencil(&self, y: &State, now: &Now, j: usize) -> Stencil {
        let n = y.segments();
        let [len, rate, rise] = y.length;
        let (zeta, ell) = (j as f64 / n as f64, len / n as f64);
        let (s1, s2) = (0.5 / ell, 1.0 / (ell * ell));
        let over = now.speed[0] + zeta * rate;
        let slip = 2.0 * over * rate / len - now.speed[1] - zeta * rise;
        let d1x = minus(&y.x[j + 1], &y.x[j - 1]).map(|d| s1 * d);
        let d1v = minus(&y.v[j + 1], &y.v[j - 1]).map(|d| s1 * d);
        let d2x = [0, 1, 2].map(|i| s2 * (y.x[j + 1][i] - 2.0 * y.x[j][i] + y.x[j - 1][i]));
        let a = [0, 1, 2]
            .map(|i| y.a[j][i] + self.coriolis * over * d1v[i] + over * over * d2x[i] + slip * d1x[i]);
        Stencil { zeta, over, slip, d1x, d1v, d2x, a }
    }
}

impl Stencil {
    /// Velocity of the material.
    pub fn v(&self, y: &State, j: usize) -> V3<f64> {
        plus(&y.v[j], -self.over, &self.d1x)
    }
}

/// Weights of the constraint, of its first and of its second derivative.
pub(super) type Form = [f64; 3];

impl Unwinding {
    /// Reach of the band: the bending stiffness couples nodes over two segments.
    pub(super) fn system(&self, scalar: bool) -> Bordered {
        let reach = if self.cable.ei > 0.0 { 10 } else { 6 };
        Bordered::new(4 * self.elements - 3, reach, usize::from(scalar))
    }

    /// Sets the system up at a state: its tangent, and minus its residual on the right. The unknowns are `λ` of every
    /// segment followed by the node at its end, and the scalar of `column` last, whose own row is not set here.
    pub(super) fn assemble(
        &self,
        y: &State,
        now: &Now,
        rates: &Rates,
        column: Option<&Column>,
        form: Form,
        out: &mut Bordered,
    ) {
        out.clear();
        for j in 1..self.elements {
            self.momentum(y, now, rates, column, j, out);
        }
        for j in 1..=self.elements {
            constrain(y, rates, column, form, self.cable.mass, j, out);
        }
    }

    /// Position of node `j`, which may be one beyond the ends.
    fn ghost(&self, y: &State, now: &Now, j: isize) -> V3<f64> {
        let n = y.segments();
        let ell = y.length[0] / n as f64;
        match j {
            -1 => match self.through {
                Eyelet::Hinged => minus(&y.x[0].map(|x| 2.0 * x), &y.x[1]),
                Eyelet::Guided(d) => plus(&y.x[1], -2.0 * ell, &d),
            },
            j if j > n as isize => match self.lift_off {
                LiftOff::Free => minus(&y.x[n].map(|x| 2.0 * x), &y.x[n - 1]),
                LiftOff::Tangent => plus(&y.x[n - 1], 2.0 * ell, &now.clamp),
            },
            j => y.x[j as usize],
        }
    }

    fn momentum(
        &self,
        y: &State,
        now: &Now,
        rates: &Rates,
        column: Option<&Column>,
        j: usize,
        out: &mut Bordered,
    ) {
        let n = self.elements;
        let (m, ell) = (self.cable.mass, y.length[0] / n as f64);
        let (s1, s2, s4) = (0.5 / ell, 1.0 / (ell * ell), self.cable.ei / ell.powi(4));
        let s = self.stencil(y, now, j);
        let [before, after] = [y.lambda[j - 1], y.lambda[j]];
        let [back, ahead] = [minus(&y.x[j], &y.x[j - 1]), minus(&y.x[j + 1], &y.x[j])];
        let pull = [0, 1, 2].map(|i| s2 * (after * ahead[i] - before * back[i]));
        let mut bend = [0.0; 3];
        if s4 > 0.0 {
            for (k, w) in FOURTH.iter().enumerate() {
                bend = plus(&bend, s4 * w, &self.ghost(y, now, j as isize + k as isize - 2));
            }
        }
        let load = self.load(now.t, &self.station(y.x[j], s.v(y, j), s.d1x));
        let carried = self.carried(y, now, &s, j);
        let row = 4 * (j - 1) + 1;
        for i in 0..3 {
            out.rhs[row + i] = -(m * s.a[i] - pull[i] + bend[i] - load.f[i] - carried.load.f[i]);
        }
        for i in 0..3 {
            out.add(row + i, row - 1, s2 * back[i]);
            out.add(row + i, row + 3, -s2 * ahead[i]);
        }

        // by the three nodes of the first and second differences
        let tens = [s2 * before, -s2 * (before + after), s2 * after];
        let (e0, e1, e2) = ([0.0, 1.0, 0.0], [-s1, 0.0, s1], [s2, -2.0 * s2, s2]);
        let c = s.over;
        for o in 0..3 {
            let mut block = [identity(0.0); 3];
            let diagonal =
                [m * (c * c * e2[o] + s.slip * e1[o]) - tens[o], m * self.coriolis * c * e1[o], m * e0[o]];
            for i in 0..3 {
                for (b, d) in block.iter_mut().zip(diagonal) {
                    b[i][i] += d;
                }
                for k in 0..3 {
                    block[0][i][k] +=
                        (c * load.d_v[i][k] - load.d_slope[i][k]) * e1[o] - load.d_x[i][k] * e0[o];
                    block[1][i][k] -= load.d_v[i][k] * e0[o];
                }
            }
            carried.tangent(&mut block, e0[o], e1[o], e2[o]);
            match j + o {
                1 => {}
                k if k == n + 1 => {
                    if let Some(column) = column {
                        let by = |b: usize| times(&block[b], &column.end[b]);
                        let [x, v, a] = [by(0), by(1), by(2)];
                        (0..3).for_each(|i| out.add(row + i, 4 * n - 3, x[i] + v[i] + a[i]));
                    }
                }
                k => {
                    let applied = rates.apply(&block);
                    for i in 0..3 {
                        (0..3).for_each(|q| out.add(row + i, 4 * (k - 2) + 1 + q, applied[i][q]));
                    }
                }
            }
        }
        if s4 > 0.0 {
            self.bend(y, now, rates, column, j, s4, out);
        }
        if let Some(column) = column {
            let [dl, dl1, dl2] = column.length;
            let [len, rate, _] = y.length;
            let (r, dc) = (dl / len, s.zeta * dl1);
            let slip = 2.0 * (dc * rate + c * dl1) / len - 2.0 * c * rate * dl / (len * len) - s.zeta * dl2;
            let dv = s.d1x.map(|d| (c * r - dc) * d);
            let dslope = s.d1x.map(|d| -r * d);
            let (by_v, by_slope) = (times(&load.d_v, &dv), times(&load.d_slope, &dslope));
            let by_carried = carried.stretched(&s, r);
            for i in 0..3 {
                let inertia = self.coriolis * (dc - c * r) * s.d1v[i]
                    + 2.0 * c * (dc - c * r) * s.d2x[i]
                    + (slip - s.slip * r) * s.d1x[i];
                let sum = m * inertia + 2.0 * r * pull[i]
                    - 4.0 * r * bend[i]
                    - by_v[i]
                    - by_slope[i]
                    - by_carried[i];
                out.add(row + i, 4 * n - 3, sum);
            }
        }
    }

    /// The tangent of `EI x''''` at node `j`.
    fn bend(
        &self,
        y: &State,
        now: &Now,
        rates: &Rates,
        column: Option<&Column>,
        j: usize,
        s4: f64,
        out: &mut Bordered,
    ) {
        let n = self.elements;
        let row = 4 * (j - 1) + 1;
        let mut node = |k: usize, w: f64| {
            if k == n {
                if let Some(column) = column {
                    (0..3).for_each(|i| out.add(row + i, 4 * n - 3, w * column.end[0][i]));
                }
            } else if k > 0 {
                (0..3).for_each(|i| out.add(row + i, 4 * (k - 1) + 1 + i, rates.x * w));
            }
        };
        for (k, w) in FOURTH.iter().enumerate() {
            let w = s4 * w;
            match j + k {
                1 => node(1, if self.through == Eyelet::Hinged { -w } else { w }),
                k if k == n + 3 => {
                    let free = self.lift_off == LiftOff::Free;
                    node(n - 1, if free { -w } else { w });
                    if free {
                        node(n, 2.0 * w);
                    }
                }
                k => node(k - 2, w),
            }
        }
        let Some(column) = column else { return };
        let (ell, d_ell) = (y.length[0] / n as f64, column.length[0] / n as f64);
        if let (1, Eyelet::Guided(d)) = (j, self.through) {
            (0..3).for_each(|i| out.add(row + i, 4 * n - 3, -2.0 * s4 * d_ell * d[i]));
        }
        if j == n - 1 && self.lift_off == LiftOff::Tangent {
            for i in 0..3 {
                out.add(row + i, 4 * n - 3, 2.0 * s4 * (d_ell * now.clamp[i] + ell * column.clamp[i]));
            }
        }
    }

    /// The inertia of the water about node `j`: the water sees the curve, not the material that runs along it, so
    /// the curve's acceleration is that seen by a point that moves across it only.
    fn carried(&self, y: &State, now: &Now, s: &Stencil, j: usize) -> Carried {
        let mut load = Load::zero();
        let Some(law) = &self.added_mass else {
            return Carried { load, along: 0.0, by_along: [0.0; 3], t: [0.0; 3], p: [0.0; 3], on: false };
        };
        let stretch = length(&s.d1x);
        let t = s.d1x.map(|d| d / stretch);
        let along = -dot(&y.v[j], &t);
        let p = plus(&y.v[j], along, &t).map(|p| p / stretch);
        let mut at = self.station(y.x[j], y.v[j], s.d1x);
        at.a = [0, 1, 2].map(|i| y.a[j][i] + 2.0 * along * s.d1v[i] + along * along * s.d2x[i]);
        law.load::<f64, true>(now.t, &at, &mut load);
        let q = [0, 1, 2].map(|i| 2.0 * s.d1v[i] + 2.0 * along * s.d2x[i]);
        Carried { by_along: times(&load.d_a, &q), load, along, t, p, on: true }
    }
}

/// Weights of the fourth difference.
const FOURTH: [f64; 5] = [1.0, -4.0, 6.0, -4.0, 1.0];

/// Force of the water that moves with the curve, and how it changes.
struct Carried {
    load: Load<f64>,
    /// Speed along the cable of a point that moves across it only.
    along: f64,
    by_along: V3<f64>,
    /// The unit tangent and the normal part of the velocity over the stretch: `δw = -t·δv - p·δx'`.
    t: V3<f64>,
    p: V3<f64>,
    on: bool,
}

impl Carried {
    fn tangent(&self, block: &mut [M3; 3], e0: f64, e1: f64, e2: f64) {
        if !self.on {
            return;
        }
        let (w, d_a) = (self.along, &self.load.d_a);
        for i in 0..3 {
            for k in 0..3 {
                block[0][i][k] +=
                    e1 * (self.by_along[i] * self.p[k] - self.load.d_slope[i][k]) - w * w * e2 * d_a[i][k];
                block[1][i][k] += e0 * self.by_along[i] * self.t[k] - 2.0 * w * e1 * d_a[i][k];
                block[2][i][k] -= e0 * d_a[i][k];
            }
        }
    }
    /// How the force changes when all lengths grow by a share `r`.
    fn stretched(&self, s: &Stencil, r: f64) -> V3<f64> {
        let w = self.along;
        let da = [0, 1, 2].map(|i| -2.0 * r * w * (s.d1v[i] + w * s.d2x[i]));
        let dslope = s.d1x.map(|d| -r * d);
        let (a, b) = (times(&self.load.d_a, &da), times(&self.load.d_slope, &dslope));
        [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
    }
}

/// The constraint of segment `j`, from node `j - 1` to node `j`: `g = (|d|² - ℓ²)/2` and its derivatives.
fn constrain(
    y: &State,
    rates: &Rates,
    column: Option<&Column>,
    form: Form,
    mass: f64,
    j: usize,
    out: &mut Bordered,
) {
    let n = y.segments();
    let per = 1.0 / n as f64;
    let [l, l1, l2] = y.length.map(|x| per * x);
    let scale = mass / (l * l);
    let [w0, w1, w2] = form.map(|w| scale * w);
    let [d, dv, da] = [&y.x, &y.v, &y.a].map(|x| minus(&x[j], &x[j - 1]));
    let row = 4 * (j - 1);
    let g = w0 * 0.5 * (dot(&d, &d) - l * l)
        + w1 * (dot(&d, &dv) - l * l1)
        + w2 * (dot(&d, &da) + dot(&dv, &dv) - l * l2 - l1 * l1);
    out.rhs[row] = -g;
    let by =
        [0, 1, 2].map(|i| [w2 * da[i] + w1 * dv[i] + w0 * d[i], 2.0 * w2 * dv[i] + w1 * d[i], w2 * d[i]]);
    // a row vector times the rates
    let applied = [0, 1, 2].map(|k| {
        rates.x * by[k][0] + (0..3).map(|i| by[i][1] * rates.v[i][k] + by[i][2] * rates.a[i][k]).sum::<f64>()
    });
    for k in 0..3 {
        if j > 1 {
            out.add(row, 4 * (j - 2) + 1 + k, -applied[k]);
        }
        if j < n {
            out.add(row, 4 * (j - 1) + 1 + k, applied[k]);
        }
    }
    if let Some(column) = column {
        let [dl, dl1, dl2] = column.length.map(|x| per * x);
        // the first term: the scale of the row
        let mut sum = -2.0 * g * dl / l
            - w2 * (l2 * dl + l * dl2 + 2.0 * l1 * dl1)
            - w1 * (l1 * dl + l * dl1)
            - w0 * l * dl;
        if j == n {
            sum += (0..3).map(|i| (0..3).map(|b| by[i][b] * column.end[b][i]).sum::<f64>()).sum::<f64>();
        }
        out.add(row, 4 * n - 3, sum);
    }
}
