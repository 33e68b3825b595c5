//! Forces and moments at a point.

use crate::time::TimeFunction;
use ropewalk_core::build::{BuildError, finite, need};
use ropewalk_core::held::{Held, cross, delta, find, three};
use ropewalk_core::{Assembly, At, Marker, Node, NodeId, NodeKind, Pattern, Power, Term, V3, dot};

/// How a point force is directed.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Aim {
    /// This force, fixed in space [N].
    Dead(V3<f64>),
    /// This magnitude [N] along the slope at this coordinate.
    Follower { magnitude: f64, slope: usize },
}

/// A force on a marker, times a function of time.
///
/// Use it for: the load at a beam's tip, a pull on a hose, the thrust of a propeller (follower).
#[derive(Clone, Debug, PartialEq)]
pub struct PointForce {
    /// A name, such as `tip load`.
    pub label: String,
    /// Factor that changes with time.
    pub time: TimeFunction,
    aim: Aim,
    /// Indices of its first coordinate and velocity.
    q: usize,
    v: usize,
}

impl PointForce {
    /// A force that keeps its direction in space [N].
    ///
    /// # Errors
    /// A marker on ground, beside the point of a rigid body or on a node without position; a force that isn't
    /// finite; a bad function of time.
    pub fn dead(
        label: impl Into<String>,
        nodes: &[Node],
        marker: &Marker,
        force: V3<f64>,
        time: TimeFunction,
    ) -> Result<Self, BuildError> {
        let label = label.into();
        finite(&label, &force)?;
        time.check()?;
        match Held::new(nodes, marker, &label)? {
            Held::Ground(_) => Err(BuildError::new(format!("{label}: a force on the ground moves nothing"))),
            Held::Moves { q, v } => Ok(PointForce { label, time, aim: Aim::Dead(force), q, v }),
        }
    }

    /// A force of given magnitude [N] along the tangent `r'/|r'|` of a cable node, whichever way it turns.
    ///
    /// # Errors
    /// A node without slope; a magnitude that isn't finite; a bad function of time.
    pub fn follower(
        label: impl Into<String>,
        nodes: &[Node],
        node: NodeId,
        magnitude: f64,
        time: TimeFunction,
    ) -> Result<Self, BuildError> {
        let label = label.into();
        finite(&label, &[magnitude])?;
        time.check()?;
        let n = slope_node(nodes, node, &label)?;
        Ok(PointForce { label, time, aim: Aim::Follower { magnitude, slope: n.q + 3 }, q: n.q, v: n.v })
    }

    /// The force at a state [N].
    pub fn force(&self, at: &At<'_>) -> V3<f64> {
        let factor = self.time.at(at.t);
        match self.aim {
            Aim::Dead(f) => f.map(|f| factor * f),
            Aim::Follower { magnitude, slope } => {
                let p = three(at.q, slope);
                let scale = factor * magnitude / dot(&p, &p).sqrt();
                p.map(|p| scale * p)
            }
        }
    }
}

fn slope_node<'a>(nodes: &'a [Node], node: NodeId, what: &str) -> Result<&'a Node, BuildError> {
    let n = find(nodes, node, what)?;
    need(n.kind == NodeKind::Slope, || {
        format!("{what}: needs a cable node (position and slope), but node {} is {:?}", node.0, n.kind)
    })?;
    Ok(n)
}

impl Term for PointForce {
    fn label(&self) -> String {
        self.label.clone()
    }
    fn pattern(&self, p: &mut Pattern) {
        if matches!(self.aim, Aim::Follower { .. }) {
            p.clique(self.v..self.v + 6);
        }
    }
    fn symmetric(&self) -> bool {
        matches!(self.aim, Aim::Dead(_))
    }
    fn add(&self, at: &At<'_>, out: &mut Assembly<'_>) {
        let f = self.force(at);
        for i in 0..3 {
            out.add(self.v + i, -f[i]);
        }
        if let Aim::Follower { magnitude, slope } = self.aim
            && out.wants_tangent()
        {
            let p = three(at.q, slope);
            let squared = dot(&p, &p);
            let turn = out.weights().q * self.time.at(at.t) * magnitude / squared.sqrt();
            out.add_block(0, 6, |i, j| {
                if i < 3 && j >= 3 { -turn * (delta(i, j - 3) - p[i] * p[j - 3] / squared) } else { 0.0 }
            });
        }
    }
    fn power(&self, at: &At<'_>) -> Power {
        Power { supplied: dot(&self.force(at), &three(at.v, self.v)), ..Power::default() }
    }
}

/// A moment on the cross-section of a cable, fixed in space, times a function of time.
///
/// The section turns with `r'`: its virtual rotation is `r' × δr' / |r'|²`, so the generalised force on `r'` is
/// `m × r' / |r'|²`. The part of `m` along `r'` does no work: the cable has no twist. Use it for: rolling up a
/// cantilever, a motor at a hose's end. Such a moment isn't conservative, its tangent not symmetric.
#[derive(Clone, Debug, PartialEq)]
pub struct PointMoment {
    /// A name, such as `tip moment`.
    pub label: String,
    /// Moment [N m].
    pub moment: V3<f64>,
    /// Factor that changes with time.
    pub time: TimeFunction,
    /// Indices of the slope's first coordinate and velocity.
    q: usize,
    v: usize,
}

impl PointMoment {
    /// A moment [N m] on a cable node.
    ///
    /// # Errors
    /// A node without slope; a moment that isn't finite; a bad function of time.
    pub fn new(
        label: impl Into<String>,
        nodes: &[Node],
        node: NodeId,
        moment: V3<f64>,
        time: TimeFunction,
    ) -> Result<Self, BuildError> {
        let label = label.into();
        finite(&label, &moment)?;
        time.check()?;
        let n = slope_node(nodes, node, &label)?;
        Ok(PointMoment { label, moment, time, q: n.q + 3, v: n.v + 3 })
    }

    /// The moment now, `r'`, and the generalised force on it.
    fn now(&self, at: &At<'_>) -> (V3<f64>, V3<f64>, V3<f64>) {
        let factor = self.time.at(at.t);
        let m = self.moment.map(|m| factor * m);
        let p = three(at.q, self.q);
        let squared = dot(&p, &p);
        (m, p, cross(&m, &p).map(|x| x / squared))
    }
}

impl Term for PointMoment {
    fn label(&self) -> String {
        self.label.clone()
    }
    fn pattern(&self, p: &mut Pattern) {
        p.clique(self.v..self.v + 3);
    }
    fn symmetric(&self) -> bool {
        false
    }
    fn add(&self, at: &At<'_>, out: &mut Assembly<'_>) {
        let (m, p, force) = self.now(at);
        for i in 0..3 {
            out.add(self.v + i, -force[i]);
        }
        if out.wants_tangent() {
            let squared = dot(&p, &p);
            let w = out.weights().q / squared;
            let spin = [[0.0, -m[2], m[1]], [m[2], 0.0, -m[0]], [-m[1], m[0], 0.0]];
            out.add_block(0, 3, |i, j| w * (2.0 * force[i] * p[j] - spin[i][j]));
        }
    }
    fn power(&self, at: &At<'_>) -> Power {
        let (_, _, force) = self.now(at);
        Power { supplied: dot(&force, &three(at.v, self.v)), ..Power::default() }
    }
}
