//! Moments at a point.

use crate::point::{body, orientation, slope_node};
use crate::time::{TimeFunction, apart};
use ropewalk_core::error::finite;
use ropewalk_core::held::{cross, three};
use ropewalk_core::model::twist;
use ropewalk_core::rotation::{matrix, skew, transposed_times};
use ropewalk_core::{
    Assembly, At, BuildError, Marker, Node, NodeId, NodeKind, Pattern, Power, Term, Timed, V3, dot,
};
use ropewalk_scene::quantity::{Setting, kind};
use ropewalk_scene::{Builder, ForceSpec, MarkerRef, quantity, register_spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What a moment acts on.
#[derive(Clone, Copy, Debug, PartialEq)]
enum On {
    /// A slope at these coordinates and velocities.
    Cable { q: usize, v: usize },
    /// The section of a cable with torsion, at these first coordinate and velocity; the moment is in space, or its third
    /// component is along the tangent and stays so.
    Section { q: usize, v: usize, along: bool },
    /// A rigid body with these first coordinate and velocity; the moment is in space, or in the body's axes.
    Body { q: usize, v: usize, local: bool },
}

/// A moment on a rigid body or on the cross-section of a cable, times a function of time.
///
/// On a cable it is fixed in space. The section turns with `r'`: its virtual rotation is `r' × δr' / |r'|²`, so the
/// generalised force on `r'` is `m × r' / |r'|²`. The part of `m` along `r'` twists a cable with torsion, and does no
/// work on another. Use it
/// for: rolling up a cantilever, a motor on a crank. Such a moment isn't conservative, its tangent not symmetric.
#[derive(Clone, Debug, PartialEq)]
pub struct PointMoment {
    /// A name, such as `tip moment`.
    pub label: String,
    /// Moment [N m].
    pub moment: V3<f64>,
    /// Factor as a function of time.
    pub time: TimeFunction,
    on: On,
}

impl PointMoment {
    /// A moment [N m] fixed in space, on a cable node or a rigid body.
    ///
    /// # Errors
    /// A node without slope or orientation; a moment that isn't finite; a bad function of time.
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
        let on = if nodes.get(node.0 as usize).map(|n| n.kind) == Some(NodeKind::Frame) {
            let (n, _) = body(nodes, &Marker::node(node), &label)?;
            On::Body { q: n.q, v: n.v, local: false }
        } else if nodes.get(node.0 as usize).map(|n| n.kind) == Some(NodeKind::Twist) {
            let n = slope_node(nodes, node, &label)?;
            On::Section { q: n.q, v: n.v, along: false }
        } else {
            let n = slope_node(nodes, node, &label)?;
            On::Cable { q: n.q + 3, v: n.v + 3 }
        };
        Ok(PointMoment { label, moment, time, on })
    }

    /// A moment [N m] in the axes of a rigid body, that turns with it.
    ///
    /// # Errors
    /// A node that isn't a rigid body; a moment that isn't finite; a bad function of time.
    pub fn on_body(
        label: impl Into<String>,
        nodes: &[Node],
        node: NodeId,
        moment: V3<f64>,
        time: TimeFunction,
    ) -> Result<Self, BuildError> {
        let label = label.into();
        let (n, _) = body(nodes, &Marker::node(node), &label)?;
        let on = On::Body { q: n.q, v: n.v, local: true };
        Ok(PointMoment { on, ..PointMoment::new(label, nodes, node, moment, time)? })
    }

    /// A moment [N m] along a cable with torsion, towards its end, that turns with it.
    ///
    /// # Errors
    /// A node without torsion; a moment that isn't finite; a bad function of time.
    pub fn along(
        label: impl Into<String>,
        nodes: &[Node],
        node: NodeId,
        torque: f64,
        time: TimeFunction,
    ) -> Result<Self, BuildError> {
        let moment = PointMoment::new(label, nodes, node, [0.0, 0.0, torque], time)?;
        match moment.on {
            On::Section { q, v, .. } => Ok(PointMoment { on: On::Section { q, v, along: true }, ..moment }),
            _ => Err(BuildError::at(
                "torque",
                "a torque along it twists only a cable with torsion: give its section a torsional stiffness, `gj`",
            )),
        }
    }

    /// The moment on the section of a cable: generalised forces on its slope and its spin.
    fn on_section(&self, q: usize, along: bool, at: &At<'_>) -> [f64; 4] {
        let factor = self.time.at(at.t);
        let m = self.moment.map(|m| factor * m);
        if along {
            return [0.0, 0.0, 0.0, m[2]];
        }
        let (p, t) = (three(at.q, q + 3), twist::tangent(&at.q[q..]));
        let by_slope = cross(&m, &p).map(|x| x / dot(&p, &p));
        [by_slope[0], by_slope[1], by_slope[2], dot(&m, &t)]
    }

    /// Adds it to the equations of a section.
    fn add_to_section(&self, [q, v]: [usize; 2], along: bool, at: &At<'_>, out: &mut Assembly<'_>) {
        let force = self.on_section(q, along, at);
        (0..4).for_each(|i| out.add(v + 3 + i, -force[i]));
        if !out.wants_tangent() {
            return;
        }
        let (p, t) = (three(at.q, q + 3), twist::tangent(&at.q[q..]));
        let (square, factor) = (dot(&p, &p), self.time.at(at.t));
        let (m, w) = (self.moment.map(|m| factor * m), out.weights().q);
        // the part that every term leaves out, see `check_tangent`
        let (spin, own) = (skew(&m), skew(&t.map(|t| 0.5 * force[3] * t)));
        out.add_block(0, 4, |i, j| match (i, j) {
            (0..3, 0..3) if along => w * own[i][j] / square,
            (0..3, 0..3) => w * (2.0 * force[i] * p[j] - spin[i][j] + own[i][j]) / square,
            (3, 0..3) if !along => -w * (m[j] - force[3] * t[j]) / square.sqrt(),
            _ => 0.0,
        });
    }

    /// The moment now, and the generalised force.
    fn now(&self, at: &At<'_>) -> (V3<f64>, V3<f64>) {
        let factor = self.time.at(at.t);
        let m = self.moment.map(|m| factor * m);
        let force = match self.on {
            On::Cable { q, .. } => {
                let p = three(at.q, q);
                let squared = dot(&p, &p);
                cross(&m, &p).map(|x| x / squared)
            }
            On::Section { q, along, .. } => {
                let [x, y, z, _] = self.on_section(q, along, at);
                [x, y, z]
            }
            On::Body { local: true, .. } => m,
            On::Body { q, .. } => transposed_times(&matrix(&orientation(at, q)), &m),
        };
        (m, force)
    }

    /// First of the three equations that it stands in.
    fn first(&self) -> usize {
        match self.on {
            On::Cable { v, .. } => v,
            On::Section { v, .. } | On::Body { v, .. } => v + 3,
        }
    }
}

impl Term for PointMoment {
    fn label(&self) -> String {
        self.label.clone()
    }
    fn pattern(&self, p: &mut Pattern) {
        let count = if matches!(self.on, On::Section { .. }) { 4 } else { 3 };
        p.clique(self.first()..self.first() + count);
    }
    fn symmetric(&self) -> bool {
        false
    }
    fn is_load(&self) -> bool {
        true
    }
    fn add(&self, at: &At<'_>, out: &mut Assembly<'_>) {
        if let On::Section { q, v, along } = self.on {
            return self.add_to_section([q, v], along, at, out);
        }
        let (m, force) = self.now(at);
        for i in 0..3 {
            out.add(self.first() + i, -force[i]);
        }
        if !out.wants_tangent() {
            return;
        }
        match self.on {
            On::Cable { q, .. } => {
                let p = three(at.q, q);
                let (w, spin) = (out.weights().q / dot(&p, &p), skew(&m));
                out.add_block(0, 3, |i, j| w * (2.0 * force[i] * p[j] - spin[i][j]));
            }
            On::Section { .. } | On::Body { local: true, .. } => {}
            On::Body { .. } => {
                let (w, spin) = (out.weights().q, skew(&force));
                out.add_block(0, 3, |i, j| -w * spin[i][j]);
            }
        }
    }
    fn power(&self, at: &At<'_>) -> Power {
        if let On::Section { q, v, along } = self.on {
            let force = self.on_section(q, along, at);
            let supplied = (0..4).map(|i| force[i] * at.v[v + 3 + i]).sum();
            return Power { supplied, ..Power::default() };
        }
        let (_, force) = self.now(at);
        Power { supplied: dot(&force, &three(at.v, self.first())), ..Power::default() }
    }
    fn timed(&self) -> Option<&dyn Timed> {
        if self.time.changes() { Some(self) } else { None }
    }
}

impl Timed for PointMoment {
    fn reach(&self, t: f64, h: f64) -> Option<f64> {
        Some(self.time.reach(t, h))
    }
    fn period(&self, _t: f64) -> f64 {
        self.time.period()
    }
}

/// A moment on a rigid body or a cable, in space or in the axes of the body. A component along a cable twists it if it has
/// torsion (`section.gj`), else it has no effect.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PointMomentSpec {
    /// The marker on which it acts.
    pub marker: MarkerRef,
    /// Moment [N m].
    #[serde(
        default = "missing",
        deserialize_with = "quantity::setting::vec3::moment",
        skip_serializing_if = "is_missing"
    )]
    pub moment: [Setting; 3],
    /// Moment along a cable with torsion, towards its end [N m], instead of `moment`. It turns with the cable.
    #[serde(
        default,
        deserialize_with = "quantity::setting::optional::moment",
        skip_serializing_if = "Option::is_none"
    )]
    pub torque: Option<Setting>,
    /// Whether `moment` is given in the axes of the rigid body and turns with it.
    #[serde(default)]
    pub local: bool,
    /// Factor as a function of time.
    #[serde(default)]
    pub time: TimeFunction,
}
register_spec!(Force, "point_moment", PointMomentSpec);

/// What stands for a moment that isn't given; no scene can say it.
fn missing() -> [Setting; 3] {
    [f64::NAN; 3].map(Setting::from)
}

fn is_missing(moment: &[Setting; 3]) -> bool {
    moment.iter().all(|m| m.number().is_some_and(f64::is_nan))
}

#[typetag::serde(name = "point_moment")]
impl ForceSpec for PointMomentSpec {
    fn markers(&self) -> Vec<&MarkerRef> {
        vec![&self.marker]
    }
    fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
        let marker = b.marker("marker", &self.marker)?;
        let Some(node) = marker.on() else {
            return Err(BuildError::at("marker", "a moment needs a marker on a rigid body or a cable"));
        };
        let label = format!("moment at {}", self.marker);
        if let Some(torque) = &self.torque {
            if !is_missing(&self.moment) || self.local {
                return Err(BuildError::at("torque", "give `moment` or `torque`, not both"));
            }
            let along = [torque.clone(), 0.0.into(), 0.0.into()];
            for ([torque, ..], time) in apart(b, "torque", &along, &kind::MOMENT, &self.time)? {
                let term = PointMoment::along(label.clone(), b.nodes(), node, torque, time)?;
                b.term(Box::new(term));
            }
            return Ok(());
        }
        if is_missing(&self.moment) {
            return Err(BuildError::at(
                "moment",
                "how large is it? Give `moment`, or `torque` along a cable",
            ));
        }
        let make = if self.local { PointMoment::on_body } else { PointMoment::new };
        for (moment, time) in apart(b, "moment", &self.moment, &kind::MOMENT, &self.time)? {
            let term = make(label.clone(), b.nodes(), node, moment, time)?;
            b.term(Box::new(term));
        }
        Ok(())
    }
}
