//! Relations between markers that are differentiated automatically: what no joint of closed-form equations says.
//!
//! A relation is written once, over any carrier; Jacobian, geometric stiffness, time derivatives and the bias of the
//! acceleration equation come from forward differentiation of it and are exact. The closed forms of joints are tested
//! against it.

use crate::algebra::jet::Jet;
use crate::model::constraint::{Constraint, MOST_ROWS, RowKind};
use crate::model::marker::{Marker, Place};
use crate::model::motion::Motion;
use crate::model::node::{Node, NodeId, NodeKind};
use crate::model::state::At;
use num_dual::{Dual2_64, Dual64, HyperDual64};

/// A relation between markers that isn't made of the [`Equation`](crate::Equation)s of a joint.
///
/// # Example: two points stay at a given distance
/// ```
/// use ropewalk_core::{Jet, Place, Relation, RowKind};
///
/// struct Rod(f64);
/// impl Relation for Rod {
///     fn rows(&self) -> Vec<RowKind> { vec![RowKind::Position] }
///     fn g<S: Jet>(&self, _t: S, at: &[Place<S>], g: &mut [S]) {
///         let d: [S; 3] = std::array::from_fn(|i| at[1].x[i] - at[0].x[i]);
///         g[0] = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt() - self.0;
///     }
/// }
/// ```
pub trait Relation: Send + Sync + 'static {
    /// What each of its equations measures.
    fn rows(&self) -> Vec<RowKind>;
    /// Whether `g` is linear in the increments of its nodes, so that it has no geometric stiffness.
    fn linear(&self) -> bool {
        false
    }
    /// The motion that it follows, if it depends on time.
    fn follows(&self) -> Option<&dyn Motion> {
        None
    }
    /// The angle by which its motion turns its last marker between two times [rad], as [`Constraint::turned`].
    fn turned(&self, _from: f64, _to: f64) -> f64 {
        0.0
    }
    /// Sets the value of each equation, given where the markers are. A time-dependent relation evaluates its
    /// motion with [`lift`], and tells it as [`Relation::follows`].
    fn g<S: Jet>(&self, t: S, at: &[Place<S>], g: &mut [S]);
    /// The same where it depends on what terms of the model remember: [`State::internal`](crate::State::internal), which may
    /// be empty.
    fn recall<S: Jet>(&self, _internal: &[f64], t: S, at: &[Place<S>], g: &mut [S]) {
        self.g(t, at, g);
    }
}

/// A function of time known by value and two derivatives, continued over the carrier of `t`.
pub fn lift<S: Jet>(t: S, [x, v, a]: [f64; 3]) -> S {
    let dt = t - t.re();
    (dt * 0.5 * a + v) * dt + x
}

/// A [`Relation`] between markers of a model.
pub struct Related<R> {
    name: String,
    relation: R,
    markers: Vec<Marker>,
    nodes: Vec<NodeId>,
    rows: Vec<RowKind>,
    range: (f64, f64),
}

/// More markers than any relation has.
const MOST_MARKERS: usize = 4;

impl<R: Relation> Related<R> {
    /// Holds markers by a relation.
    pub fn new(name: impl Into<String>, relation: R, markers: Vec<Marker>) -> Self {
        let mut nodes: Vec<NodeId> = markers.iter().filter_map(Marker::on).collect();
        nodes.sort_unstable();
        nodes.dedup();
        let rows = relation.rows();
        assert!(markers.len() <= MOST_MARKERS, "a relation has at most {MOST_MARKERS} markers");
        assert!(rows.len() <= MOST_ROWS, "a relation has at most {MOST_ROWS} equations");
        Related {
            name: name.into(),
            relation,
            markers,
            nodes,
            rows,
            range: (f64::NEG_INFINITY, f64::INFINITY),
        }
    }
    /// What it holds.
    pub fn relation(&self) -> &R {
        &self.relation
    }
    /// Restricts the time for which it is defined, to that of its motion.
    pub fn within(mut self, range: (f64, f64)) -> Self {
        self.range = range;
        self
    }

    /// Evaluates with increment `d(local dof)` of the nodes.
    fn eval<S: Jet>(
        &self,
        nodes: &[Node],
        at: &At<'_>,
        t: S,
        d: impl Fn(usize) -> S,
        out: &mut [S; MOST_ROWS],
    ) {
        let mut places = [Place { x: [S::zero(); 3], axes: [[S::zero(); 3]; 3] }; MOST_MARKERS];
        for (place, marker) in places.iter_mut().zip(&self.markers) {
            let start = marker.on().map_or(0, |n| self.local_start(nodes, n));
            *place = marker.place(nodes, at.q, |i| d(start + i));
        }
        let places = &places[..self.markers.len().min(MOST_MARKERS)];
        self.relation.recall(at.internal, t, places, &mut out[..self.rows.len()]);
    }

    fn local_start(&self, nodes: &[Node], node: NodeId) -> usize {
        self.nodes.iter().take_while(|&&n| n != node).map(|n| nodes[n.0 as usize].kind.velocities()).sum()
    }
    fn local_size(&self, nodes: &[Node]) -> usize {
        self.nodes.iter().map(|n| nodes[n.0 as usize].kind.velocities()).sum()
    }
}

impl<R: Relation> Constraint for Related<R> {
    fn name(&self) -> &str {
        &self.name
    }
    fn rows(&self) -> &[RowKind] {
        &self.rows
    }
    fn markers(&self) -> &[Marker] {
        &self.markers
    }
    fn nodes(&self) -> &[NodeId] {
        &self.nodes
    }
    fn linear(&self) -> bool {
        self.relation.linear()
    }
    fn range(&self) -> (f64, f64) {
        self.range
    }
    fn moves(&self) -> bool {
        self.relation.follows().is_some()
    }
    fn reach(&self, t: f64, h: f64) -> Option<f64> {
        self.relation.follows().map_or(Some(h), |m| m.reach(t, h))
    }
    fn period(&self, t: f64) -> f64 {
        self.relation.follows().map_or(f64::INFINITY, |m| m.period(t))
    }

    fn turned(&self, from: f64, to: f64) -> f64 {
        self.relation.turned(from, to)
    }

    fn jacobian(&self, nodes: &[Node], at: &At<'_>, g: &mut [f64], jac: &mut [f64]) {
        let n = self.local_size(nodes);
        let mut out = [Dual64::from(0.0); MOST_ROWS];
        for j in 0..n {
            let seed = |i: usize| Dual64::new(0.0, if i == j { 1.0 } else { 0.0 });
            self.eval(nodes, at, Dual64::from(at.t), seed, &mut out);
            for r in 0..self.rows.len() {
                jac[r * n + j] = out[r].eps;
                g[r] = out[r].re;
            }
        }
    }

    fn geometric(&self, nodes: &[Node], at: &At<'_>, lambda: &[f64], h: &mut [f64]) {
        let n = self.local_size(nodes);
        let mut out = [HyperDual64::from(0.0); MOST_ROWS];
        let mut slope = [0.0; MOST_MARKERS * 7];
        for j in 0..n {
            for k in 0..=j {
                let one = |on: bool| if on { 1.0 } else { 0.0 };
                let seed = |i: usize| HyperDual64::new(0.0, one(i == j), one(i == k), 0.0);
                self.eval(nodes, at, HyperDual64::from(at.t), seed, &mut out);
                let sum = |pick: fn(&HyperDual64) -> f64| -> f64 {
                    (0..self.rows.len()).map(|r| lambda[r] * pick(&out[r])).sum()
                };
                h[j * n + k] = sum(|x| x.eps1eps2);
                h[k * n + j] = h[j * n + k];
                slope[j] = sum(|x| x.eps1);
            }
        }
        // two small rotations one after the other differ from their sum by half their product
        let mut start = 0;
        for node in self.nodes.iter().map(|n| &nodes[n.0 as usize]) {
            if node.kind == NodeKind::Frame {
                for (x, y, z) in
                    [(3, 4, 5), (4, 5, 3), (5, 3, 4)].map(|(x, y, z)| (start + x, start + y, start + z))
                {
                    h[z * n + y] += 0.5 * slope[x];
                    h[y * n + z] -= 0.5 * slope[x];
                }
            }
            start += node.kind.velocities();
        }
    }

    fn rates(&self, nodes: &[Node], at: &At<'_>, rate: &mut [f64], bias: &mut [f64]) {
        let zero = Dual2_64::from(0.0);
        let mut out = [zero; MOST_ROWS];
        let t = Dual2_64::new(at.t, 1.0, 0.0);
        self.eval(nodes, at, t, |_| zero, &mut out);
        for r in 0..self.rows.len() {
            rate[r] = out[r].v1;
        }
        // along the path that goes on with the present velocity and no acceleration
        let velocity = |i: usize| {
            let mut dofs = self.nodes.iter().flat_map(|k| nodes[k.0 as usize].dofs());
            at.v[dofs.nth(i).unwrap_or_default()]
        };
        self.eval(nodes, at, t, |i| Dual2_64::new(0.0, velocity(i), 0.0), &mut out);
        for r in 0..self.rows.len() {
            bias[r] = out[r].v2;
        }
    }
}
