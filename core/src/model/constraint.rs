//! Constraints `g(q, t) = 0` between markers, as the model sees them.

use crate::model::marker::Marker;
use crate::model::motion::Motion;
use crate::model::node::{Node, NodeId};
use crate::model::solid::Solid;
use crate::model::state::At;

/// What an equation measures; decides its tolerance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RowKind {
    /// A length [m].
    Position,
    /// A direction or ratio.
    Direction,
}

/// A constraint as the model sees it: a [`Joint`](crate::Joint), a [`Related`](crate::Related), or one of its own kind.
pub trait Constraint: Send + Sync {
    /// Its name in the scene.
    fn name(&self) -> &str;
    /// What each of its equations measures.
    fn rows(&self) -> &[RowKind];
    /// The markers that it holds.
    fn markers(&self) -> &[Marker];
    /// The nodes that it touches, each once.
    fn nodes(&self) -> &[NodeId];
    /// What tells of its force, if its multipliers alone don't: they are shared by many.
    fn told_by(&self) -> Option<&str> {
        None
    }
    /// The nodes behind which its rows can be eliminated whatever it becomes during a run. Left out, that is judged by its
    /// Jacobian at the start.
    fn behind(&self) -> &[NodeId] {
        &[]
    }
    /// Whether it has no geometric stiffness.
    fn linear(&self) -> bool;
    /// Whether one of its equations has none.
    fn linear_row(&self, _row: usize) -> bool {
        self.linear()
    }
    /// Sets `g` and, row by row, its Jacobian by the velocities of [`Constraint::nodes`].
    fn jacobian(&self, nodes: &[Node], at: &At<'_>, g: &mut [f64], jac: &mut [f64]);
    /// Sets `g` alone; `room` is as large as the Jacobian, for those who know no shorter way.
    fn violation(&self, nodes: &[Node], at: &At<'_>, g: &mut [f64], room: &mut [f64]) {
        self.jacobian(nodes, at, g, room);
    }
    /// Sets `h = ∂(Gᵀλ)/∂q`, a square matrix over the velocities of its nodes: row by equation, column by increment. It
    /// isn't symmetric where nodes have orientations.
    fn geometric(&self, nodes: &[Node], at: &At<'_>, lambda: &[f64], h: &mut [f64]);
    /// Sets `∂g/∂t` and the bias `(G v)_q v + 2 G_t v + g_tt`: the parts of ġ and g̈ that hold no unknown.
    fn rates(&self, nodes: &[Node], at: &At<'_>, rate: &mut [f64], bias: &mut [f64]);
    /// The displacement that it imposes on its last marker as seen from its first, if it does that.
    fn imposes(&self) -> Option<&dyn Motion> {
        None
    }
    /// Whether it changes with time: only then [`Constraint::reach`] is asked.
    fn moves(&self) -> bool {
        self.imposes().is_some()
    }
    /// Whether its `∂g/∂t` is nought whatever happens, so that its power needn't be asked for.
    fn is_steady(&self) -> bool {
        false
    }
    /// How much of a step `h` from `t` may be taken that leaps over nothing of its motion, as [`Motion::reach`].
    fn reach(&self, t: f64, h: f64) -> Option<f64> {
        self.imposes().map_or(Some(h), |m| m.reach(t, h))
    }
    /// The period with which its motion goes to and fro [s], as [`Motion::period`].
    fn period(&self, t: f64) -> f64 {
        self.imposes().map_or(f64::INFINITY, |m| m.period(t))
    }
    /// The angle by which its motion turns what it holds between two times [rad]: another by a whole turn, of a joint by half
    /// of one, can't be told from it where both meet its equations.
    fn turned(&self, _from: f64, _to: f64) -> f64 {
        0.0
    }
    /// The coordinate that it prescribes, if it does nothing else: its place and that of its velocity. Integrators then
    /// take coordinate, velocity and acceleration from [`Constraint::prescribed`] instead of following the coordinate,
    /// which would make accelerations ring.
    fn prescribes(&self) -> Option<(usize, usize)> {
        None
    }
    /// That coordinate, its velocity and its acceleration at time `t`.
    fn prescribed(&self, _t: f64) -> [f64; 3] {
        [f64::NAN; 3]
    }
    /// What there is to be seen of it, such as a package that cable lifts off from.
    fn solids(&self) -> Vec<Solid> {
        Vec::new()
    }
    /// First and last time for which it is defined.
    fn range(&self) -> (f64, f64) {
        (f64::NEG_INFINITY, f64::INFINITY)
    }
}

/// More rows than any constraint has.
pub(crate) const MOST_ROWS: usize = 16;
