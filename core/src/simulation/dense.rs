//! The motion inside a step: quintic Hermite interpolation of positions, velocities and accelerations.
//!
//! Velocities are the derivative of that where the end of a step is exact enough. Of the generalized-α family it is off
//! by a multiple of `h³`, which the derivative would make one of `h²` in the midst of the step: there they are the
//! cubic of velocities and accelerations.

use crate::model::Model;
use crate::model::node::{difference, retract, velocity};
use crate::model::state::State;

/// Two states at the ends of a step, and the motion between them.
pub struct Dense<'a> {
    model: &'a Model,
    from: &'a State,
    to: &'a State,
    /// The increment over the step, and its first and second time derivatives at the end. At the start they are the
    /// velocities and accelerations.
    d: Vec<f64>,
    v: Vec<f64>,
    a: Vec<f64>,
    /// Whether velocities are the derivative of positions.
    derived: bool,
}

impl<'a> Dense<'a> {
    /// Interpolates from one state to a later one.
    pub fn new(model: &'a Model, from: &'a State, to: &'a State) -> Self {
        let mut d = vec![0.0; model.velocities()];
        difference(model.nodes(), &from.q, &to.q, &mut d);
        let (mut v, mut a) = (vec![0.0; d.len()], vec![0.0; d.len()]);
        for n in model.nodes() {
            let k = n.dofs();
            let (first, second) = (&mut v[k.clone()], &mut a[k.clone()]);
            n.kind.rates(&from.q[n.coords()], &d[k.clone()], &to.v[k.clone()], &to.a[k], first, second);
        }
        // only Radau IIA leaves stages
        let derived = !to.control.stages[0].is_empty();
        Dense { model, from, to, d, v, a, derived }
    }

    /// Sets time, positions, velocities, both accelerations, multipliers and internal variables of `out` to those at time `t` of the step.
    pub fn at(&self, t: f64, out: &mut State) {
        let (a, b) = (self.from, self.to);
        let h = b.t - a.t;
        let x = if h > 0.0 { ((t - a.t) / h).clamp(0.0, 1.0) } else { 1.0 };
        let (x2, x3) = (x * x, x * x * x);
        // blends of: displacement, v0, v1, a0, a1; and their derivatives
        let p = x3 * (10.0 - 15.0 * x + 6.0 * x2);
        let v0 = x - x3 * (6.0 - 8.0 * x + 3.0 * x2);
        let v1 = x3 * (-4.0 + 7.0 * x - 3.0 * x2);
        let a0 = 0.5 * x2 - x3 * (1.5 - 1.5 * x + 0.5 * x2);
        let a1 = x3 * (0.5 - x + 0.5 * x2);
        let dp = 30.0 * x2 * (1.0 - x) * (1.0 - x);
        let dv0 = 1.0 - x2 * (18.0 - 32.0 * x + 15.0 * x2);
        let dv1 = x2 * (-12.0 + 28.0 * x - 15.0 * x2);
        let da0 = x - x2 * (4.5 - 6.0 * x + 2.5 * x2);
        let da1 = x2 * (1.5 - 4.0 * x + 2.5 * x2);
        let (mut d, mut rate) = (vec![0.0; self.d.len()], vec![0.0; self.d.len()]);
        for i in 0..d.len() {
            let (end, v_end, a_end) = (self.d[i], self.v[i], self.a[i]);
            d[i] = p * end + h * (v0 * a.v[i] + v1 * v_end) + h * h * (a0 * a.a[i] + a1 * a_end);
            rate[i] = if h > 0.0 { dp * end / h } else { 0.0 }
                + dv0 * a.v[i]
                + dv1 * v_end
                + h * (da0 * a.a[i] + da1 * a_end);
            out.a[i] = a.a[i] + x * (b.a[i] - a.a[i]);
            out.aux[i] = a.aux[i] + x * (b.aux[i] - a.aux[i]);
        }
        if self.derived {
            out.v.copy_from_slice(&rate);
            velocity(self.model.nodes(), &a.q, &d, &rate, &mut out.v);
        } else {
            // the angular velocity of a body is a vector in its own axes, as good as any other
            let (y, y2) = (1.0 - x, (1.0 - x) * (1.0 - x));
            for (i, v) in out.v.iter_mut().enumerate() {
                *v = (1.0 + 2.0 * x) * y2 * a.v[i]
                    + (3.0 - 2.0 * x) * x2 * b.v[i]
                    + h * (x * y2 * a.a[i] - x2 * y * b.a[i]);
            }
        }
        for i in 0..out.lambda.len() {
            out.lambda[i] = a.lambda[i] + x * (b.lambda[i] - a.lambda[i]);
        }
        retract(self.model.nodes(), &a.q, &d, &mut out.q);
        // internal variables change at the ends of steps
        out.internal.clone_from(&a.internal);
        out.t = t;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Start;
    use crate::model::node::{Node, NodeKind};

    #[test]
    fn a_quintic_is_met_exactly() {
        let nodes = vec![Node { kind: NodeKind::Scalars(1), q: 0, v: 0, shared: false }];
        let start = Start { q: vec![0.0], v: vec![0.0], internal: vec![] };
        let model = Model::new(nodes, vec![], vec![], vec![], start, 1.0);
        let f = |t: f64| {
            [
                1.0 + t - 2.0 * t.powi(2) + 0.5 * t.powi(3) + 3.0 * t.powi(4) - t.powi(5),
                1.0 - 4.0 * t + 1.5 * t.powi(2) + 12.0 * t.powi(3) - 5.0 * t.powi(4),
                -4.0 + 3.0 * t + 36.0 * t.powi(2) - 20.0 * t.powi(3),
            ]
        };
        let state = |t: f64| {
            let [q, v, a] = f(t);
            let mut state = State { t, q: vec![q], v: vec![v], a: vec![a], ..model.state() };
            state.control.stages[0] = vec![0.0];
            state
        };
        let (from, to) = (state(0.3), state(1.1));
        let dense = Dense::new(&model, &from, &to);
        let mut out = model.state();
        for t in [0.3, 0.5, 0.77, 1.1] {
            dense.at(t, &mut out);
            approx::assert_relative_eq!(out.q[0], f(t)[0], max_relative = 1e-13);
            approx::assert_relative_eq!(out.v[0], f(t)[1], max_relative = 1e-12);
        }
    }

    /// A body that turns about a changing axis: what is interpolated has the order of the polynomial.
    #[test]
    fn turning_is_interpolated_to_sixth_order() {
        let nodes = vec![Node { kind: NodeKind::Frame, q: 0, v: 0, shared: false }];
        let start = Start { q: vec![0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0], v: vec![0.0; 6], internal: vec![] };
        let model = Model::new(nodes, vec![], vec![], vec![], start, 1.0);
        // turned about z by t, then about the new x by 2 t
        let state = |t: f64, derived: bool| {
            let ((sin, cos), (s, c)) = ((0.5 * t).sin_cos(), t.sin_cos());
            let (sx, cx) = (2.0 * t).sin_cos();
            let mut state = State {
                t,
                q: vec![0.0, 0.0, 0.0, cos * c, cos * s, sin * s, sin * c],
                v: vec![0.0, 0.0, 0.0, 2.0, sx, cx],
                a: vec![0.0, 0.0, 0.0, 0.0, 2.0 * cx, -2.0 * sx],
                ..model.state()
            };
            if derived {
                state.control.stages[0] = vec![0.0; 6];
            }
            state
        };
        let error = |h: f64, derived: bool| {
            let [from, to, exact] = [0.4, 0.4 + h, 0.4 + 0.3 * h].map(|t| state(t, derived));
            let mut out = model.state();
            Dense::new(&model, &from, &to).at(exact.t, &mut out);
            let off = |a: &[f64], b: &[f64]| a.iter().zip(b).fold(0.0f64, |m, (a, b)| m.max((a - b).abs()));
            [off(&out.q, &exact.q), off(&out.v, &exact.v)]
        };
        for (derived, order) in [(true, 4.7), (false, 3.7)] {
            let (coarse, fine) = (error(0.4, derived), error(0.2, derived));
            let [q, v] = [0, 1].map(|i| (coarse[i] / fine[i]).log2());
            assert!(coarse[0] < 1e-5 && q > 5.7 && v > order, "{coarse:?} {fine:?}");
        }
    }
}
