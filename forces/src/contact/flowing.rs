//! Pieces of cables that feed: material runs through them, so that what touches acts on the boundaries of the line as well.
//!
//! Positions, velocities and virtual displacements of the material are cubics with the nodal values `r`, `r'`, for
//! velocities `ν = ṙ - ṗ r'`, `ν' = ṙ' - ṗ r''`, where `p` is the material coordinate of a node. So the contact is that of an
//! ordinary piece of the length `l` that is there now, and a force with the nodal vector `F` acts on a boundary that moves a
//! node by `b` with `-b (r'·F + r''·F')`, as inertia and weight do.

use super::block::{Block, MOST};
use super::group::{Ball, Group, Scratch, Span, What};
use super::seat::Frame;
use super::term::Contact;
use ropewalk_core::held::three;
use ropewalk_core::{Assembly, At, SpanFlow, SpanLine, V3, Weights, dot};

/// Unknowns of the nodes; and of these, two boundaries and a body.
const NODES: usize = 12;
const ALL: usize = 20;
/// Part of the length by which it is changed to see what the force does.
const STEP: f64 = 1e-6;

/// A piece of a cable that feeds.
#[derive(Clone, Debug)]
pub(crate) struct Flowing {
    flow: SpanFlow,
    q: [usize; 4],
    v: [usize; 4],
    /// Stiffness per length.
    k: f64,
    /// As it was at the start.
    span: Span,
}

/// The piece as it is now, as one whose nodes have unknowns of their own.
pub(crate) struct Now {
    pub group: Group,
    pub l: f64,
    q: [f64; NODES],
    v: [f64; NODES],
    a: [f64; NODES],
    rates: [f64; 2],
}

impl Now {
    /// Its own unknowns at the same time.
    pub fn at<'a>(&'a self, at: &At<'a>) -> At<'a> {
        At { t: at.t, q: &self.q, v: &self.v, a: &self.a, internal: &[], relaxed: None }
    }

    fn vectors(&self) -> [V3<f64>; 4] {
        std::array::from_fn(|n| three(&self.q, 3 * n))
    }
}

/// The factors of the nodal vectors in `r''` at both nodes, and their derivatives by the length.
fn bends(l: f64) -> [[[f64; 4]; 2]; 2] {
    let (i1, i2, i3) = (1.0 / l, 1.0 / (l * l), 1.0 / (l * l * l));
    [
        [[-6.0 * i2, -4.0 * i1, 6.0 * i2, -2.0 * i1], [6.0 * i2, 2.0 * i1, -6.0 * i2, 4.0 * i1]],
        [[12.0 * i3, 4.0 * i2, -12.0 * i3, 2.0 * i2], [-12.0 * i3, -2.0 * i2, 12.0 * i3, -4.0 * i2]],
    ]
}

fn sum(weights: &[f64; 4], x: &[V3<f64>; 4]) -> V3<f64> {
    std::array::from_fn(|i| (0..4).map(|n| weights[n] * x[n][i]).sum())
}

impl Flowing {
    /// Nothing for what isn't a cable.
    pub fn new(flow: SpanFlow, span: Span) -> Option<Self> {
        let SpanLine::Cubic { q, v, .. } = span.line else { return None };
        Some(Flowing { flow, q, v, k: span.k / span.length, span })
    }

    /// Its unknowns.
    pub fn dofs(&self) -> impl Iterator<Item = usize> + '_ {
        let nodes = self.v.iter().flat_map(|&v| v..v + 3);
        nodes.chain(self.flow.boundaries[..self.flow.count].iter().map(|f| f.1))
    }

    /// The piece with the length `l` on unknowns of its own.
    fn piece(&self, l: f64) -> Group {
        let own = [0, 3, 6, 9];
        let line = SpanLine::Cubic { q: own, v: own, l };
        let tip = |end: usize| {
            let tip = self.span.tips[end]?;
            Some(Ball { held: line.beyond(end, self.span.radius), ..tip })
        };
        let span = Span { line, length: l, k: self.k * l, tips: [tip(0), tip(1)], ..self.span.clone() };
        Group { what: What::Span(Box::new(span)), bristles: None, place: None }
    }

    /// The piece as it is at a state.
    pub fn now(&self, at: &At<'_>) -> Now {
        let [first, last] = self.flow.places(at.q);
        let (l, rates) = (last - first, self.flow.rates(at.v));
        let read = |x: &[f64], places: &[usize; 4]| -> [f64; NODES] {
            std::array::from_fn(|i| x[places[i / 3] + i % 3])
        };
        let (q, mut v, a) = (read(at.q, &self.q), read(at.v, &self.v), read(at.a, &self.v));
        let e: [V3<f64>; 4] = std::array::from_fn(|n| three(&q, 3 * n));
        let [by, _] = bends(l);
        for node in 0..2 {
            let bend = sum(&by[node], &e);
            for i in 0..3 {
                v[6 * node + i] -= rates[node] * e[2 * node + 1][i];
                v[6 * node + 3 + i] -= rates[node] * bend[i];
            }
        }
        Now { group: self.piece(l), l, q, v, a, rates }
    }

    /// Residual of the piece, and with `tangent` its derivative, by its own unknowns and those of the shape's body.
    fn local(
        &self,
        contact: &Contact,
        group: &Group,
        frame: &Frame,
        at: &At<'_>,
        tangent: Option<Weights>,
        scratch: &mut Scratch,
    ) -> Block {
        let mut block = Block::new();
        group.gather(&contact.fixed, frame, at, scratch);
        for ball in &scratch.balls {
            contact.add_ball(ball, frame, at, tangent, &mut block, &mut []);
        }
        block
    }

    /// Adds the force on it.
    pub fn add(
        &self,
        contact: &Contact,
        clique: usize,
        frame: &Frame,
        at: &At<'_>,
        out: &mut Assembly<'_>,
        scratch: &mut Scratch,
    ) {
        let now = self.now(at);
        let own = now.at(at);
        let f = self.local(contact, &now.group, frame, &own, None, scratch).r;
        if f.iter().all(|f| *f == 0.0) {
            return;
        }
        let (body, boundaries) = (contact.body(), self.flow.count);
        let (e, [by, by_l]) = (now.vectors(), bends(now.l));
        // what the material at each node is displaced by, where the node moves along it
        let slide = [e[1], sum(&by[0], &e), e[3], sum(&by[1], &e)];
        let nodal = |n: usize| -> V3<f64> { three(&f, 3 * n) };
        let share = |k: usize, n: usize| self.flow.by[k][n / 2];
        for (i, dof) in self.dofs().take(NODES).enumerate() {
            out.add(dof, f[i]);
        }
        for k in 0..boundaries {
            let q = (0..4).map(|n| share(k, n) * dot(&slide[n], &nodal(n))).sum::<f64>();
            out.add(self.flow.boundaries[k].1, -q);
        }
        for (i, dof) in body.clone().enumerate() {
            out.add(dof, f[NODES + i]);
        }
        if !out.wants_tangent() {
            return;
        }
        let w = out.weights();
        let one = |q: f64, v: f64| Some(Weights { q, v, a: 0.0 });
        let by_q = self.local(contact, &now.group, frame, &own, one(1.0, 0.0), scratch).k;
        let by_v = self.local(contact, &now.group, frame, &own, one(0.0, 1.0), scratch).k;
        let step = STEP * now.l;
        let [less, more] =
            [-step, step].map(|d| self.local(contact, &self.piece(now.l + d), frame, &own, None, scratch).r);
        let by_length: [f64; MOST] = std::array::from_fn(|i| (more[i] - less[i]) / (2.0 * step));
        let of_front = |k: usize| self.flow.by[k][1] - self.flow.by[k][0];
        // how the nodal velocities of the material change: with the vectors of the nodes, and with a boundary
        let velocity_by = |m: usize, j: usize| -> f64 {
            let (n, same) = (m / 3, m % 3 == j % 3);
            let rate = now.rates[n / 2];
            match (same, n % 2) {
                (false, _) => 0.0,
                (true, 0) => {
                    if j / 3 == n + 1 {
                        -rate
                    } else {
                        0.0
                    }
                }
                (true, _) => -rate * by[n / 2][j / 3],
            }
        };
        let bent_by_l = [sum(&by_l[0], &e), sum(&by_l[1], &e)];
        let velocity_by_front = |m: usize, k: usize| -> f64 {
            let n = m / 3;
            if n.is_multiple_of(2) { 0.0 } else { -now.rates[n / 2] * bent_by_l[n / 2][m % 3] * of_front(k) }
        };
        let rows = NODES + body.len();
        let mut d = [[0.0; ALL]; MOST];
        for (i, row) in d.iter_mut().enumerate().take(rows) {
            for j in 0..NODES {
                let flows: f64 = (0..NODES).map(|m| by_v[i][m] * velocity_by(m, j)).sum();
                row[j] = w.q * (by_q[i][j] + flows) + w.v * by_v[i][j];
            }
            for k in 0..boundaries {
                let flows: f64 = (0..NODES).map(|m| by_v[i][m] * velocity_by_front(m, k)).sum();
                let slid: f64 = (0..NODES).map(|m| by_v[i][m] * share(k, m / 3) * slide[m / 3][m % 3]).sum();
                row[NODES + k] = w.q * (by_length[i] * of_front(k) + flows) - w.v * slid;
            }
            for j in 0..body.len() {
                row[NODES + boundaries + j] = w.q * by_q[i][NODES + j] + w.v * by_v[i][NODES + j];
            }
        }
        let mut all = [[0.0; ALL]; ALL];
        all[..NODES].copy_from_slice(&d[..NODES]);
        for j in 0..body.len() {
            all[NODES + boundaries + j] = d[NODES + j];
        }
        for k in 0..boundaries {
            let row = &mut all[NODES + k];
            for n in 0..4 {
                let (b, force) = (share(k, n), nodal(n));
                for i in 0..3 {
                    for (sum, d) in row.iter_mut().zip(&d[3 * n + i]) {
                        *sum -= b * slide[n][i] * d;
                    }
                    // the slide itself changes with the nodes and the length
                    if n % 2 == 0 {
                        row[3 * (n + 1) + i] -= w.q * b * force[i];
                    } else {
                        for j in 0..4 {
                            row[3 * j + i] -= w.q * b * by[n / 2][j] * force[i];
                        }
                        for m in 0..boundaries {
                            row[NODES + m] -= w.q * b * bent_by_l[n / 2][i] * of_front(m) * force[i];
                        }
                    }
                }
            }
        }
        out.add_square(clique, &all);
    }
}
