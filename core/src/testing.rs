//! What the author of a term, law or constraint tests it with: dense matrices, and central differences of what was
//! written by hand.
//!
//! The checks return the worst error relative to the largest number in the same column, so a test reads
//! `assert!(check_tangent(&term, &nodes, &at, Width::One) < 1e-8)`.

use crate::algebra::lane::{LaneTask, Pack, Real, V3, Width, run};
use crate::model::constraint::Constraint;
use crate::model::node::{Node, NodeKind, retract};
use crate::model::pattern::Pattern;
use crate::model::state::At;
use crate::model::station::{Law, Load, Station};
use crate::model::structure::Structure;
use crate::model::term::{Assembly, Term, Weights};

/// Residual and weighted tangent of one term as plain vectors over all unknowns of `nodes`, rows first.
/// The whole tangent is formed, also where the term says that it is symmetric.
pub fn dense(
    term: &dyn Term,
    nodes: &[Node],
    at: &At<'_>,
    w: Weights,
    width: Width,
) -> (Vec<f64>, Vec<Vec<f64>>) {
    let n = nodes.iter().map(|n| n.kind.velocities()).sum::<usize>();
    let mut pattern = Pattern::default();
    term.pattern(&mut pattern);
    let structure = Structure::new(nodes, &[], &pattern, false);
    let (mut residual, mut values) = (vec![0.0; n], vec![0.0; structure.entries()]);
    term.add(
        at,
        &mut Assembly {
            residual: &mut residual,
            values: Some(&mut values),
            weights: w,
            width,
            structure: &structure,
            clique: 0,
            scratch: &mut Vec::new(),
            leap: None,
            approximate: &mut false,
        },
    );
    let mut unknown = vec![0; n];
    for (i, &p) in structure.position.iter().enumerate() {
        unknown[p] = i;
    }
    let mut tangent = vec![vec![0.0; n]; n];
    for (r, columns, at) in structure.rows() {
        for (k, v) in values[at].iter().enumerate() {
            tangent[unknown[r]][unknown[columns.get(k)]] = *v;
        }
    }
    (residual, tangent)
}

/// The worst relative error of a term's stiffness, damping and mass against differences of its residual, and of
/// its symmetry if it claims that.
///
/// Orientations are moved by increments in the body's own axes, as Newton's method does. Of the slopes of cables with
/// torsion the symmetric part counts: the other, half the term's own torque over the square of the slope, belongs to a sum
/// over all terms that is zero in equilibrium, and every term leaves it out. Choose a state away from
/// the term's kinks: differences reach about 2e-4 to either side.
pub fn check_tangent(term: &dyn Term, nodes: &[Node], at: &At<'_>, width: Width) -> f64 {
    let n = nodes.iter().map(|n| n.kind.velocities()).sum::<usize>();
    let pick = |q, v, a| Weights { q, v, a };
    let residual = |at: &At<'_>| dense(term, nodes, at, Weights::default(), width).0;
    let size = largest(&residual(at));
    let mut worst = 0.0_f64;
    for (kind, w) in [pick(1.0, 0.0, 0.0), pick(0.0, 1.0, 0.0), pick(0.0, 0.0, 1.0)].into_iter().enumerate() {
        let exact = dense(term, nodes, at, w, width).1;
        if !term.has_tangent(&w) && exact.iter().flatten().any(|&x| x != 0.0) {
            // nobody would ask for it
            return f64::INFINITY;
        }
        let moved = |j: usize, h: f64| {
            let add =
                |x: &[f64]| x.iter().enumerate().map(|(i, x)| x + if i == j { h } else { 0.0 }).collect();
            let (mut q, v, a): (_, Vec<f64>, Vec<f64>) = (at.q.to_vec(), add(at.v), add(at.a));
            retract(nodes, at.q, &add(&vec![0.0; n]), &mut q);
            residual(&match kind {
                0 => At { q: &q, ..*at },
                1 => At { v: &v, ..*at },
                _ => At { a: &a, ..*at },
            })
        };
        let columns: Vec<Vec<f64>> = (0..n).map(|j| exact.iter().map(|row| row[j]).collect()).collect();
        let mut numeric: Vec<Vec<f64>> = (0..n).map(|j| difference(|h| moved(j, h))).collect();
        if kind == 0 {
            // inertia has no part in it: its share isn't a force of the state alone
            let still = vec![0.0; n];
            let force = residual(&At { a: &still, ..*at });
            leave_out(nodes.iter().map(|n| (n, n.v)), at, &force, &mut numeric);
        }
        worst = worst.max(column_error(&columns, &numeric, size));
        if term.symmetric() {
            worst = worst.max(column_error(&columns, &exact, size));
        }
    }
    worst
}

/// The worst relative error of a law's derivatives against differences of its load, and of its load and derivatives
/// at the other widths against those at width one.
pub fn check_law(law: &impl Law, t: f64, at: &Station<f64>) -> f64 {
    let mut load = Load::zero();
    law.load::<f64, true>(t, at, &mut load);
    let mut plain = Load::zero();
    law.load::<f64, false>(t, at, &mut plain);
    let force = |at: &Station<f64>| {
        let mut load = Load::zero();
        law.load::<f64, false>(t, at, &mut load);
        [load.f, load.g].concat()
    };
    let size = largest(&[load.f, load.g].concat());
    let mut worst = column_error(&[[load.f, load.g].concat()], &[[plain.f, plain.g].concat()], size);
    let (gives, nought) = (law.gives(), [[0.0; 3]; 3]);
    let kept = [
        (gives.x, load.d_x),
        (gives.slope, load.d_slope),
        (gives.v, load.d_v),
        (gives.a, load.d_a),
        (gives.couple, load.d_rate),
        (gives.couple, [load.g, nought[0], nought[0]]),
    ];
    if kept.iter().any(|(given, d)| !given && d.iter().flatten().any(|&x| x != 0.0)) {
        // nobody would read it
        return f64::INFINITY;
    }
    type Field = fn(&mut Station<f64>) -> &mut V3<f64>;
    type By = [V3<f64>; 3];
    let fields: [(Field, By, By); 5] = [
        (|s| &mut s.x, load.d_x, load.g_x),
        (|s| &mut s.slope, load.d_slope, load.g_slope),
        (|s| &mut s.v, load.d_v, load.g_v),
        (|s| &mut s.a, load.d_a, nought),
        (|s| &mut s.slope_rate, load.d_rate, nought),
    ];
    for (field, of_f, of_g) in fields {
        let columns: Vec<Vec<f64>> =
            (0..3).map(|j| of_f.iter().chain(&of_g).map(|row| row[j]).collect()).collect();
        let numeric: Vec<Vec<f64>> = (0..3)
            .map(|j| {
                difference(|h| {
                    let mut moved = *at;
                    field(&mut moved)[j] += h;
                    force(&moved)
                })
            })
            .collect();
        worst = worst.max(column_error(&columns, &numeric, size));
    }
    for width in [Width::One, Width::Four, Width::Eight] {
        let mut wide = Vec::new();
        run(width, OneLaw { law, t, at, out: &mut wide });
        for lane in wide {
            worst = worst.max(column_error(&[numbers(&load, 0)], &[lane], size));
        }
    }
    let mut pack = Load::zero();
    law.load::<Pack<2>, true>(t, &spread(at), &mut pack);
    worst.max(column_error(&[numbers(&load, 0)], &[numbers(&pack, 1)], size))
}

/// The worst relative error of a constraint's Jacobian, geometric stiffness (with multipliers 1, 1/2, 1/3, …), rate
/// and bias against differences of its equations.
pub fn check_constraint(constraint: &dyn Constraint, nodes: &[Node], at: &At<'_>) -> f64 {
    let dofs: Vec<usize> = constraint.nodes().iter().flat_map(|k| nodes[k.0 as usize].dofs()).collect();
    let (rows, n) = (constraint.rows().len(), dofs.len());
    let all = nodes.iter().map(|n| n.kind.velocities()).sum::<usize>();
    // equations after the increment d and the time dt
    let moved = |dt: f64, d: &[f64]| {
        let mut step = vec![0.0; all];
        dofs.iter().zip(d).for_each(|(&i, &d)| step[i] += d);
        let mut q = at.q.to_vec();
        retract(nodes, at.q, &step, &mut q);
        let (mut g, mut jac) = (vec![0.0; rows], vec![0.0; rows * n]);
        constraint.jacobian(nodes, &At { t: at.t + dt, q: &q, ..*at }, &mut g, &mut jac);
        g
    };
    let unit = |j: usize, h: f64| -> Vec<f64> { (0..n).map(|i| if i == j { h } else { 0.0 }).collect() };
    let lambda: Vec<f64> = (0..rows).map(|r| 1.0 / (r + 1) as f64).collect();
    let (mut g, mut jac, mut h) = (vec![0.0; rows], vec![0.0; rows * n], vec![0.0; n * n]);
    let (mut rate, mut bias) = (vec![0.0; rows], vec![0.0; rows]);
    constraint.jacobian(nodes, at, &mut g, &mut jac);
    constraint.geometric(nodes, at, &lambda, &mut h);
    constraint.rates(nodes, at, &mut rate, &mut bias);
    let mut alone = vec![0.0; rows];
    constraint.violation(nodes, at, &mut alone, &mut vec![0.0; rows * n]);

    let columns: Vec<Vec<f64>> = (0..n).map(|j| (0..rows).map(|r| jac[r * n + j]).collect()).collect();
    let numeric: Vec<Vec<f64>> = (0..n).map(|j| difference(|h| moved(0.0, &unit(j, h)))).collect();
    let mut worst = column_error(&columns, &numeric, 1.0).max(column_error(&[alone], &[g.clone()], 1.0));
    if constraint.is_steady() {
        worst = worst.max(largest(&rate));
    }

    let pull = |d: &[f64]| -> Vec<f64> {
        let mut step = vec![0.0; all];
        dofs.iter().zip(d).for_each(|(&i, &d)| step[i] += d);
        let mut q = at.q.to_vec();
        retract(nodes, at.q, &step, &mut q);
        let (mut g, mut jac) = (vec![0.0; rows], vec![0.0; rows * n]);
        constraint.jacobian(nodes, &At { q: &q, ..*at }, &mut g, &mut jac);
        (0..n).map(|j| (0..rows).map(|r| jac[r * n + j] * lambda[r]).sum()).collect()
    };
    let mut numeric: Vec<Vec<f64>> = (0..n).map(|j| difference(|h| pull(&unit(j, h)))).collect();
    let own = constraint.nodes().iter().map(|k| &nodes[k.0 as usize]);
    let firsts = own.scan(0, |next, n| {
        let first = *next;
        *next += n.kind.velocities();
        Some((n, first))
    });
    leave_out(firsts, at, &pull(&vec![0.0; n]), &mut numeric);
    let columns: Vec<Vec<f64>> = (0..n).map(|j| (0..n).map(|i| h[i * n + j]).collect()).collect();
    worst = worst.max(column_error(&columns, &numeric, 1.0));
    if constraint.linear() {
        worst = worst.max(largest(&h));
    }
    worst = worst.max(column_error(&[rate], &[difference(|dt| moved(dt, &[]))], 1.0));
    let path = |dt: f64| moved(dt, &dofs.iter().map(|&i| at.v[i] * dt).collect::<Vec<_>>());
    // second differences carry more noise than first ones
    worst.max(column_error(&[bias], &[second(path)], 1e3 * largest(&g).max(0.1)))
}

/// Takes from differences of forces, column by column, what tangents leave out of them: `½ (f_w/|p|²) [t]×` of the slope
/// `p` of each node with torsion, where `f_w` is the torque. Each node comes with its first unknown.
fn leave_out<'a>(
    nodes: impl Iterator<Item = (&'a Node, usize)>,
    at: &At<'_>,
    force: &[f64],
    columns: &mut [Vec<f64>],
) {
    for (n, first) in nodes.filter(|(n, _)| n.kind == NodeKind::Twist) {
        let p = &at.q[n.q + 3..n.q + 6];
        let square: f64 = p.iter().map(|x| x * x).sum();
        for (i, j, k) in [(0, 1, 2), (1, 2, 0), (2, 0, 1)] {
            // [t]× has -t_k in row i and column j
            let x = 0.5 * force[first + 6] / square * p[k] / square.sqrt();
            columns[first + 3 + j][first + 3 + i] += x;
            columns[first + 3 + i][first + 3 + j] -= x;
        }
    }
}

/// First derivative at 0, by central differences of fourth order.
pub fn difference(f: impl Fn(f64) -> Vec<f64>) -> Vec<f64> {
    let h = 1e-4;
    let [a, b, c, d] = [f(-2.0 * h), f(-h), f(h), f(2.0 * h)];
    (0..a.len()).map(|i| (a[i] - d[i] + 8.0 * (c[i] - b[i])) / (12.0 * h)).collect()
}

/// Second derivative at 0, by central differences of fourth order.
pub fn second(f: impl Fn(f64) -> Vec<f64>) -> Vec<f64> {
    let h = 1e-3;
    let [a, b, o, c, d] = [f(-2.0 * h), f(-h), f(0.0), f(h), f(2.0 * h)];
    (0..a.len()).map(|i| (16.0 * (b[i] + c[i]) - a[i] - d[i] - 30.0 * o[i]) / (12.0 * h * h)).collect()
}

/// Largest difference in each column, relative to the largest number of that column; numbers below a thousandth of
/// the largest of all, or 1e-4 of `size`, count as that: differences of something of that size can't see them.
fn column_error(exact: &[Vec<f64>], numeric: &[Vec<f64>], size: f64) -> f64 {
    let all = exact.iter().chain(numeric).map(|c| largest(c)).fold(0.0, f64::max);
    let floor = (1e-3 * all).max(1e-4 * size).max(f64::MIN_POSITIVE);
    let mut worst = 0.0_f64;
    for (e, n) in exact.iter().zip(numeric) {
        let scale = largest(e).max(largest(n)).max(floor);
        for (e, n) in e.iter().zip(n) {
            let error = (e - n).abs() / scale;
            worst = if error.is_finite() { worst.max(error) } else { f64::INFINITY };
        }
    }
    worst
}

fn largest(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |m, x| m.max(x.abs()))
}

/// All numbers of one lane of a load.
fn numbers<R: Real>(load: &Load<R>, lane: usize) -> Vec<f64> {
    let forces = [&load.f, &load.g];
    let by =
        [&load.d_x, &load.d_slope, &load.d_v, &load.d_a, &load.d_rate, &load.g_x, &load.g_slope, &load.g_v];
    let all = forces.into_iter().flatten().chain(by.into_iter().flatten().flatten());
    all.map(|x| x.lane(lane)).collect()
}

/// The same station in every lane.
fn spread<R: Real>(at: &Station<f64>) -> Station<R> {
    Station {
        x: at.x.map(R::of),
        v: at.v.map(R::of),
        a: at.a.map(R::of),
        slope: at.slope.map(R::of),
        slope_rate: at.slope_rate.map(R::of),
        s: R::of(at.s),
        weight: R::of(at.weight),
        before: R::of(at.before),
        element: R::of(at.element),
        diameter: R::of(at.diameter),
        area: R::of(at.area),
        who: at.who,
    }
}

struct OneLaw<'a, L> {
    law: &'a L,
    t: f64,
    at: &'a Station<f64>,
    out: &'a mut Vec<Vec<f64>>,
}

impl<L: Law> LaneTask for OneLaw<'_, L> {
    #[inline(always)]
    fn go<R: Real>(self) {
        let mut load = Load::zero();
        self.law.load::<R, true>(self.t, &spread(self.at), &mut load);
        self.out.extend((0..R::LANES).map(|lane| numbers(&load, lane)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::algebra::jet::Jet;
    use crate::model::constraint::RowKind;
    use crate::model::marker::{Marker, Place};
    use crate::model::node::{NodeId, NodeKind};
    use crate::model::relation::{Related, Relation};
    use crate::model::station::Gives;

    /// A spring `r = (1 + v² + a) q³` on one number, with a stiffness that is off by a factor.
    struct Cubic(f64);
    impl Term for Cubic {
        fn label(&self) -> String {
            "cubic".into()
        }
        fn pattern(&self, p: &mut Pattern) {
            p.clique([0]);
        }
        fn add(&self, at: &At<'_>, out: &mut Assembly<'_>) {
            let (w, q, v, s) = (out.weights(), at.q[0], at.v[0], 1.0 + at.v[0] * at.v[0] + at.a[0]);
            out.add(0, s * q * q * q);
            let k = self.0 * w.q * 3.0 * s * q * q + w.v * 2.0 * v * q * q * q + w.a * q * q * q;
            out.add_block(0, 1, |_, _| k);
        }
    }

    #[test]
    fn wrong_tangents_are_seen() {
        let nodes = [Node { kind: NodeKind::Scalars(1), q: 0, v: 0, shared: false }];
        let at = At { t: 0.0, q: &[1.3], v: &[0.7], a: &[-0.2], internal: &[], relaxed: None };
        assert!(check_tangent(&Cubic(1.0), &nodes, &at, Width::One) < 1e-9);
        let error = check_tangent(&Cubic(1.01), &nodes, &at, Width::One);
        assert!((error - 0.01).abs() < 1e-3, "{error}");
    }

    /// Drag `-v² ` along x, with a derivative that is off by a factor, or not declared.
    struct Square(f64, bool);
    impl Law for Square {
        fn label(&self) -> String {
            "square".into()
        }
        fn gives(&self) -> Gives {
            Gives { v: self.1, ..Gives::NOTHING }
        }
        #[inline(always)]
        fn load<R: Real, const TANGENT: bool>(&self, _: f64, at: &Station<R>, out: &mut Load<R>) {
            out.f[0] -= at.v[0] * at.v[0];
            out.d_v[0][0] -= R::of(2.0 * self.0) * at.v[0];
        }
    }

    #[test]
    fn wrong_laws_are_seen() {
        let v = [1.0, 2.0, 3.0];
        let at = Station {
            x: v,
            v,
            a: v,
            slope: v,
            slope_rate: v,
            s: 0.0,
            weight: 1.0,
            before: 0.5,
            element: 2.0,
            diameter: 1.0,
            area: 1.0,
            who: 0,
        };
        assert!(check_law(&Square(1.0, true), 0.0, &at) < 1e-9);
        assert!((check_law(&Square(1.01, true), 0.0, &at) - 0.01).abs() < 1e-3);
        assert_eq!(check_law(&Square(1.0, false), 0.0, &at), f64::INFINITY);
    }

    /// A curve that moves, and one that says that it is straight.
    struct Curve(bool);
    impl Relation for Curve {
        fn rows(&self) -> Vec<RowKind> {
            vec![RowKind::Position]
        }
        fn linear(&self) -> bool {
            self.0
        }
        fn g<S: Jet>(&self, t: S, at: &[Place<S>], g: &mut [S]) {
            g[0] = at[0].x[0] * at[0].x[1] * t.sin() - at[0].axes[0][2];
        }
    }

    #[test]
    fn constraints_are_checked_whole() {
        let nodes = [Node { kind: NodeKind::Frame, q: 0, v: 0, shared: false }];
        let q = [1.0, 2.0, 3.0, 0.8, 0.0, 0.6, 0.0];
        let at = At {
            t: 0.4,
            q: &q,
            v: &[0.5, -1.0, 0.3, 1.0, 2.0, -1.0],
            a: &[0.0; 6],
            internal: &[],
            relaxed: None,
        };
        let axes = crate::algebra::rotation::around([1.0, 0.5, 0.0]);
        let marker = Marker::Node { node: NodeId(0), point: [0.1, 0.5, 0.2], axes };
        assert!(check_constraint(&Related::new("curve", Curve(false), vec![marker]), &nodes, &at) < 1e-7);
        assert!(check_constraint(&Related::new("curve", Curve(true), vec![marker]), &nodes, &at) > 1e-2);
    }
}
