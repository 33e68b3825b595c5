//! Forces at a point.

use crate::time::{TimeFunction, apart};
use ropewalk_core::error::{finite, need};
use ropewalk_core::held::{Held, Pull, cross, delta, dofs, find, pull, three};
use ropewalk_core::rotation::{matrix, product, skew, times};
use ropewalk_core::{
    Assembly, At, BuildError, Marker, Node, NodeId, NodeKind, Pattern, Power, Term, Timed, V3, dot,
};
use ropewalk_scene::quantity::{Setting, kind};
use ropewalk_scene::{Builder, ForceSpec, MarkerRef, quantity, register_spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How a point force is directed.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Aim {
    /// This force, fixed in space [N].
    Dead(V3<f64>),
    /// This magnitude [N] along the slope at this coordinate.
    Follower { magnitude: f64, slope: usize },
    /// This force [N] in the axes of a body with these first coordinate and velocity, and its moment about its node.
    OnBody { force: V3<f64>, moment: V3<f64>, q: usize, v: usize },
}

/// A force on a marker, times a function of time.
///
/// Use it for: the load at a beam's tip, a pull on a hose, the thrust of a propeller (follower, on a body).
#[derive(Clone, Debug, PartialEq)]
pub struct PointForce {
    /// A name, such as `tip load`.
    pub label: String,
    /// Factor as a function of time.
    pub time: TimeFunction,
    aim: Aim,
    ends: [Held; 2],
}

impl PointForce {
    /// A force that keeps its direction in space [N].
    ///
    /// # Errors
    /// A marker on ground or on a node without position; a force that isn't finite; a bad function of time.
    pub fn dead(
        label: impl Into<String>,
        nodes: &[Node],
        marker: &Marker,
        force: V3<f64>,
        time: TimeFunction,
    ) -> Result<Self, BuildError> {
        PointForce::new(label.into(), nodes, marker, Aim::Dead(force), &force, time)
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
        let n = slope_node(nodes, node, &label)?;
        let aim = Aim::Follower { magnitude, slope: n.q + 3 };
        PointForce::new(label, nodes, &Marker::node(node), aim, &[magnitude], time)
    }

    /// A force [N] in the axes of a rigid body, that turns with it.
    ///
    /// # Errors
    /// A marker that isn't on a rigid body; a force that isn't finite; a bad function of time.
    pub fn on_body(
        label: impl Into<String>,
        nodes: &[Node],
        marker: &Marker,
        force: V3<f64>,
        time: TimeFunction,
    ) -> Result<Self, BuildError> {
        let label = label.into();
        let (n, point) = body(nodes, marker, &label)?;
        let aim = Aim::OnBody { force, moment: cross(&point, &force), q: n.q, v: n.v };
        PointForce::new(label, nodes, marker, aim, &force, time)
    }

    fn new(
        label: String,
        nodes: &[Node],
        marker: &Marker,
        aim: Aim,
        numbers: &[f64],
        time: TimeFunction,
    ) -> Result<Self, BuildError> {
        finite(&label, numbers)?;
        time.check()?;
        let held = Held::new(nodes, marker, &label)?;
        need(held.size() > 0, || format!("{label}: a force on the ground moves nothing"))?;
        Ok(PointForce { label, time, aim, ends: [Held::Ground([0.0; 3]), held] })
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
            Aim::OnBody { force, q, .. } => times(&matrix(&orientation(at, q)), &force).map(|f| factor * f),
        }
    }
}

pub(crate) fn orientation(at: &At<'_>, q: usize) -> [f64; 4] {
    [at.q[q + 3], at.q[q + 4], at.q[q + 5], at.q[q + 6]]
}

pub(crate) fn slope_node<'a>(nodes: &'a [Node], node: NodeId, what: &str) -> Result<&'a Node, BuildError> {
    let n = find(nodes, node, what)?;
    need(n.kind.has_slope(), || {
        format!("{what}: needs a cable node (position and slope), but node {} is {:?}", node.0, n.kind)
    })?;
    Ok(n)
}

/// The node of a marker on a rigid body, and the marker's place on it.
pub(crate) fn body<'a>(
    nodes: &'a [Node],
    marker: &Marker,
    what: &str,
) -> Result<(&'a Node, V3<f64>), BuildError> {
    if let Marker::Node { node, point, .. } = *marker
        && let n = find(nodes, node, what)?
        && n.kind == NodeKind::Frame
    {
        return Ok((n, point));
    }
    Err(BuildError::new(format!("{what}: needs a marker on a rigid body")))
}

impl Term for PointForce {
    fn label(&self) -> String {
        self.label.clone()
    }
    fn pattern(&self, p: &mut Pattern) {
        match self.aim {
            Aim::Dead(_) if matches!(self.ends[1], Held::Moves { .. }) => {}
            Aim::Dead(_) => p.clique(dofs(&self.ends)),
            Aim::Follower { .. } | Aim::OnBody { .. } => {
                let first = self.ends[1].dof(0);
                p.clique(first..first + 6);
            }
        }
    }
    fn symmetric(&self) -> bool {
        matches!((self.aim, self.ends[1]), (Aim::Dead(_), Held::Moves { .. }))
    }
    fn is_load(&self) -> bool {
        true
    }
    fn add(&self, at: &At<'_>, out: &mut Assembly<'_>) {
        let f = self.force(at);
        let w = out.weights().q * self.time.at(at.t);
        match self.aim {
            Aim::Dead(_) if self.symmetric() => {
                (0..3).for_each(|i| out.add(self.ends[1].dof(i), -f[i]));
            }
            Aim::Dead(_) => pull(&self.ends, at, &Pull { f, ..Pull::default() }, 0, out),
            Aim::Follower { magnitude, slope } => {
                (0..3).for_each(|i| out.add(self.ends[1].dof(i), -f[i]));
                let p = three(at.q, slope);
                let squared = dot(&p, &p);
                let turn = w * magnitude / squared.sqrt();
                out.add_block(0, 6, |i, j| {
                    if i < 3 && j >= 3 { -turn * (delta(i, j - 3) - p[i] * p[j - 3] / squared) } else { 0.0 }
                });
            }
            Aim::OnBody { force, moment, q, v } => {
                let factor = self.time.at(at.t);
                for i in 0..3 {
                    out.add(v + i, -f[i]);
                    out.add(v + 3 + i, -factor * moment[i]);
                }
                if out.wants_tangent() {
                    let turn = product(&matrix(&orientation(at, q)), &skew(&force));
                    out.add_block(0, 6, |i, j| if i < 3 && j >= 3 { w * turn[i][j - 3] } else { 0.0 });
                }
            }
        }
    }
    fn power(&self, at: &At<'_>) -> Power {
        Power { supplied: dot(&self.force(at), &self.ends[1].velocity(at)), ..Power::default() }
    }
    fn timed(&self) -> Option<&dyn Timed> {
        if self.time.changes() { Some(self) } else { None }
    }
}

impl Timed for PointForce {
    fn reach(&self, t: f64, h: f64) -> Option<f64> {
        Some(self.time.reach(t, h))
    }
    fn period(&self, _t: f64) -> f64 {
        self.time.period()
    }
}

/// A force at a marker: in a constant direction, in the axes of a rigid body, or along a cable.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PointForceSpec {
    /// The marker on which it acts.
    pub marker: MarkerRef,
    /// Force in space [N].
    #[serde(default, deserialize_with = "quantity::setting::vec3::force")]
    pub force: [Setting; 3],
    /// Whether `force` is given in the axes of the rigid body and turns with it.
    #[serde(default)]
    pub local: bool,
    /// Follower force along the cable, towards its end [N], instead of `force`. It turns with the cable.
    #[serde(default, deserialize_with = "quantity::setting::optional::force")]
    pub follower: Option<Setting>,
    /// Factor as a function of time.
    #[serde(default)]
    pub time: TimeFunction,
}
register_spec!(Force, "point_force", PointForceSpec);

impl PointForceSpec {
    /// A force in space.
    pub fn new(marker: impl Into<MarkerRef>, force: V3<f64>, time: TimeFunction) -> Self {
        PointForceSpec {
            marker: marker.into(),
            force: force.map(Setting::from),
            local: false,
            follower: None,
            time,
        }
    }
}

#[typetag::serde(name = "point_force")]
impl ForceSpec for PointForceSpec {
    fn markers(&self) -> Vec<&MarkerRef> {
        vec![&self.marker]
    }
    fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
        let marker = b.marker("marker", &self.marker)?;
        let label = format!("force at {}", self.marker);
        let none = self.force.iter().all(|f| f.is(0.0));
        let Some(follower) = &self.follower else {
            let make = if self.local { PointForce::on_body } else { PointForce::dead };
            for (force, time) in apart(b, "force", &self.force, &kind::FORCE, &self.time)? {
                let term = make(label.clone(), b.nodes(), &marker, force, time)?;
                b.term(Box::new(term));
            }
            return Ok(());
        };
        if !none {
            return Err(BuildError::at("follower", "give `force` or `follower`, not both"));
        }
        let Some(node) = marker.on() else {
            return Err(BuildError::at("marker", "a follower force needs a marker on a cable"));
        };
        if matches!(Held::new(b.nodes(), &marker, &label)?, Held::Lever { .. }) {
            let message =
                "a follower force acts on the axis of a cable, not on a lever: name a place on the cable";
            return Err(BuildError::at("marker", message));
        }
        let along = [follower.clone(), 0.0.into(), 0.0.into()];
        for ([along, ..], time) in apart(b, "follower", &along, &kind::FORCE, &self.time)? {
            let term = PointForce::follower(label.clone(), b.nodes(), node, along, time)?;
            b.term(Box::new(term));
        }
        Ok(())
    }
}
