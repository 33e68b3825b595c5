//! `type = "ring"`: a small eyelet that a cable runs through somewhere on its way.

use super::arc::direction;
use super::at_rest::{self, Sliding};
use super::events::Short;
use super::sheave::passes;
use super::tangent::end;
use super::torsion;
use num_dual::Dual64;
use ropewalk_core::error::{not_negative, positive};
use ropewalk_core::{
    Action, Assembly, At, BuildError, Column, Constraint, Equation, Event, Jet, Joint, Marker, Model,
    MovingBoundary, Node, NodeId, Part, Pattern, Power, Quantity, Related, Remembers, RowKind, Shows, State,
    Term, V3,
};
use ropewalk_scene::{Builder, ConstraintSpec, Guide, MarkerRef, Strand, quantity, register_spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// A ring through which a cable runs that names it in its `route`: a shackle, a fairlead, a thimble, small beside the
/// spans. For a wheel whose size counts take a `sheave`.
///
/// The cable turns sharply there; its bending stiffness doesn't resist that. A cable with torsion carries its twist through; its
/// torque turns it out of the plane of the spans there, as far as its bending stiffness lets it, which it needs. With `friction` the tensions
/// before and behind differ by the capstan equation with the angle of deflection.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RingSpec {
    /// Name; routes and records refer to it.
    pub name: String,
    /// Where it is: a point in space, or of a part that stands above the cable in the scene.
    pub marker: MarkerRef,
    /// Coefficient of friction. Default: none.
    #[serde(default, deserialize_with = "quantity::number", skip_serializing_if = "is_nought")]
    pub friction: f64,
    /// Speed of sliding below which friction fades, so that a held cable creeps at a part of it [m/s].
    #[serde(default = "slip_speed", deserialize_with = "quantity::speed")]
    pub slip_speed: f64,
    /// What friction does at equilibria, which aren't unique with it.
    #[serde(default, skip_serializing_if = "Sliding::is_none")]
    pub equilibrium: Sliding,
}
register_spec!(Constraint, "ring", RingSpec);

fn is_nought(x: &f64) -> bool {
    *x == 0.0
}

fn slip_speed() -> f64 {
    1e-3
}

#[typetag::serde(name = "ring")]
impl ConstraintSpec for RingSpec {
    fn name(&self) -> &str {
        &self.name
    }
    fn markers(&self) -> Vec<&MarkerRef> {
        vec![&self.marker]
    }
    fn guides(&self) -> Vec<Guide> {
        let (name, marker) = (self.name.clone(), self.marker.clone());
        let axis = [0.0, 0.0, 1.0];
        vec![Guide { name, marker, beside: 0.0, axis, radius: 0.0, turns: 0.0, winds: false }]
    }
    fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
        not_negative("friction", self.friction)?;
        positive("slip_speed", self.slip_speed)?;
        let passages = b.passages(&self.name);
        let [passage] = passages.as_slice() else {
            let message = match passages.len() {
                0 => format!(
                    "no cable runs through `{0}`: name it in the `route` of one, as `{{ through = \"{0}\" }}`",
                    self.name
                ),
                n => format!("{n} cables run through `{}`: give each a ring of its own", self.name),
            };
            return Err(BuildError::at("name", message));
        };
        for (end, which) in passage.boundaries.iter().zip(["in", "out"]) {
            let markers = [passage.marker, Marker::node(end.end)];
            let name = format!("{}.{which}", self.name);
            b.constraint(Joint::new(name, b.nodes(), markers, Equation::coincide())?)?;
        }
        let ends = passage.boundaries;
        b.constraint(Joined { name: self.name.clone(), ends, nodes: [ends[0].node, ends[1].node] })?;
        if self.friction > 0.0 && passage.strand.torsion.is_some_and(|torsion| torsion.lay != 0.0) {
            let message = "what tension a rope with `torque_tension` has in a ring isn't known by its stretch alone: leave `friction` out";
            return Err(BuildError::at("friction", message));
        }
        if passage.strand.torsion.is_some() {
            if passage.strand.ei == 0.0 {
                let message = "a cable with torsion is turned out of its plane in a ring as far as its bending stiffness lets it: give it \
                               `section.ei`, or let it run over a `sheave`";
                return Err(BuildError::at("name", message));
            }
            b.event(Folded { name: self.name.clone(), ends });
            let markers = ends.map(|boundary| end(b.nodes(), boundary.end)).to_vec();
            b.constraint(Related::new(torsion::label(&self.name), torsion::Welded, markers))?;
        }
        if self.equilibrium != Sliding::None && self.friction == 0.0 {
            let message = "it says what friction does, and this ring has none: give its `friction`";
            return Err(BuildError::at("equilibrium", message));
        }
        let way = self.equilibrium.way(passage)?;
        let twisted = passage.strand.torsion.filter(|torsion| torsion.lay != 0.0);
        let spans = twisted.map(|_| b.parts(&passage.spans)).transpose()?.unwrap_or_default();
        let memory = (way != 0.0).then(|| b.memory(&format!("{}: equilibrium", self.name), 1));
        for span in &passage.spans {
            let length = 0.05 * b.parts(std::slice::from_ref(span))?[0].1.length();
            b.event(Short { span: span.clone(), length });
        }
        b.term(Box::new(Kink {
            name: self.name.clone(),
            ends,
            strand: passage.strand,
            spans: spans.into_iter().map(|(_, part)| part.clone()).collect(),
            friction: self.friction,
            slip_speed: self.slip_speed,
            equilibrium: self.equilibrium,
            way,
            memory,
        }));
        Ok(())
    }
}

/// What `1 + t·t'` of the tangents before and behind a ring must not fall below, as of those of an element.
const LEAST_OPEN: f64 = 0.1;

/// Ends the run where a cable with torsion doubles back in a ring.
struct Folded {
    name: String,
    ends: [MovingBoundary; 2],
}

impl Event for Folded {
    fn name(&self) -> String {
        format!("the cable doubles back in `{}`", self.name)
    }
    fn value(&self, _: &Model, state: &State) -> f64 {
        let slopes = self.ends.map(|end| &state.q[end.end_q + 3..end.end_q + 6]);
        let [a, b] = slopes;
        let along = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        LEAST_OPEN - 1.0 - along(a, b) / (along(a, a) * along(b, b)).sqrt()
    }
    fn direction(&self) -> i8 {
        1
    }
    fn act(&self, _: &Model, _: &mut State) -> Action {
        Action::Fail("its twist can't be told there: let it run over a `sheave`, or leave `gj` out".into())
    }
}

/// The same material is at the end of a span and at the start of the next.
struct Joined {
    name: String,
    ends: [MovingBoundary; 2],
    nodes: [NodeId; 2],
}

impl Constraint for Joined {
    fn name(&self) -> &str {
        &self.name
    }
    fn rows(&self) -> &[RowKind] {
        &[RowKind::Position]
    }
    fn markers(&self) -> &[Marker] {
        &[]
    }
    fn nodes(&self) -> &[NodeId] {
        &self.nodes
    }
    fn linear(&self) -> bool {
        true
    }
    fn jacobian(&self, _: &[Node], at: &At<'_>, g: &mut [f64], jac: &mut [f64]) {
        let moved = self.ends.map(|end| at.q[end.q] - end.home);
        g[0] = moved[1] - moved[0];
        jac[..2].copy_from_slice(&[-1.0, 1.0]);
    }
    fn geometric(&self, _: &[Node], _: &At<'_>, _: &[f64], h: &mut [f64]) {
        h[..4].fill(0.0);
    }
    fn rates(&self, _: &[Node], _: &At<'_>, rate: &mut [f64], bias: &mut [f64]) {
        (rate[0], bias[0]) = (0.0, 0.0);
    }
}

/// What turns the momentum of a cable in a ring, and its friction there.
struct Kink {
    name: String,
    ends: [MovingBoundary; 2],
    strand: Strand,
    /// Both spans, of a laid rope.
    spans: Vec<Arc<dyn Part>>,
    friction: f64,
    slip_speed: f64,
    equilibrium: Sliding,
    /// Where the cable goes at an equilibrium: 1 to its start, -1 to its end; 0 without friction.
    way: f64,
    /// Place of the internal variable that says whether it does.
    memory: Option<usize>,
}

/// Residual: of both points, and of both material coordinates; with what records show.
struct Turned<S> {
    r: [V3<S>; 2],
    p: [S; 2],
    angle: S,
    tension: [S; 2],
    lost: S,
}

impl Kink {
    /// With the slopes before and behind the ring, the rate of the material coordinate there, and which way the cable goes if
    /// not by that.
    fn eval<S: Jet>(&self, slope: &[V3<S>; 2], rate: S, sliding: f64) -> Turned<S> {
        let Strand { mass, ea, .. } = self.strand;
        let size = slope.each_ref().map(|s| (s[0] * s[0] + s[1] * s[1] + s[2] * s[2]).sqrt());
        let flux = rate * rate * mass;
        let r = [slope[0].map(|s| -(s * flux)), slope[1].map(|s| s * flux)];
        let mut p = [flux * size[0] * size[0] * 0.5, -(flux * size[1] * size[1] * 0.5)];
        // the angle between the tangents, exact where it is small
        let norm = |sign: f64| {
            let x: V3<S> = std::array::from_fn(|i| slope[1][i] / size[1] + slope[0][i] / size[0] * sign);
            (x[0] * x[0] + x[1] * x[1] + x[2] * x[2] + 1e-300).sqrt()
        };
        let angle = norm(-1.0).atan2(norm(1.0)) * 2.0;
        let before = (size[0] - 1.0) * ea;
        // along the cable, from the span before to the one behind
        let speed = -(rate * size[0]);
        let presses = before - speed * speed * mass / size[0];
        let mut friction = S::zero();
        if self.friction > 0.0 && presses.re() > 0.0 {
            let way = if sliding == 0.0 { direction(speed, self.slip_speed) } else { S::from(-sliding) };
            let exponent = way * angle * self.friction;
            friction = presses * (exponent.exp() - 1.0);
        }
        let work = friction * ((before * 2.0 + friction) / (2.0 * ea) + 1.0);
        p[0] -= work * 0.5;
        p[1] -= work * 0.5;
        let after = (size[1] - 1.0) * ea;
        Turned { r, p, angle, tension: [before, after], lost: -(work * rate) }
    }

    fn now(&self, at: &At<'_>) -> Turned<f64> {
        let slope = self.ends.map(|end| std::array::from_fn(|i| at.q[end.end_q + 3 + i]));
        self.eval(&slope, self.rate(at), self.way_now(at))
    }

    /// Which way the cable goes, at an equilibrium with friction.
    fn way_now(&self, at: &At<'_>) -> f64 {
        let on = self.memory.and_then(|place| at.internal.get(place)).is_some_and(|x| *x != 0.0);
        if on { self.way } else { 0.0 }
    }

    /// Tension before and behind that the twist of a laid rope adds to that of its stretch [N].
    fn pulls(&self, at: &At<'_>) -> [f64; 2] {
        let (Some(torsion), [before, behind]) = (self.strand.torsion, self.spans.as_slice()) else {
            return [0.0; 2];
        };
        [(before, before.length_now(at)), (behind, 0.0)].map(|(span, s)| {
            let twist = span.observe(Quantity::Twist, s, at).unwrap_or(torsion.free);
            torsion.lay * (twist - torsion.free)
        })
    }

    /// Both material coordinates move alike; each is asked for its half.
    fn rate(&self, at: &At<'_>) -> f64 {
        0.5 * (at.v[self.ends[0].v] + at.v[self.ends[1].v])
    }

    /// Both points, both slopes, both material coordinates.
    fn dofs(&self) -> [usize; 14] {
        let [a, b] = self.ends;
        std::array::from_fn(|i| match i {
            0..6 => a.end_v + i,
            6..12 => b.end_v + i - 6,
            12 => a.v,
            _ => b.v,
        })
    }
}

impl Term for Kink {
    fn label(&self) -> String {
        self.name.clone()
    }
    fn pattern(&self, p: &mut Pattern) {
        p.clique(self.dofs());
    }
    fn symmetric(&self) -> bool {
        false
    }
    fn add(&self, at: &At<'_>, out: &mut Assembly<'_>) {
        let (dofs, w) = (self.dofs(), out.weights());
        let row = |i: usize, x: &Turned<f64>| match i {
            0..3 => x.r[0][i],
            6..9 => x.r[1][i - 6],
            12 | 13 => x.p[i - 12],
            _ => 0.0,
        };
        let now = self.now(at);
        for (i, dof) in dofs.iter().enumerate() {
            out.add(*dof, row(i, &now));
        }
        if !out.wants_tangent() {
            return;
        }
        let mut block = [[0.0; 14]; 14];
        for j in (3..6).chain(9..14) {
            let one = |is: bool, w: f64| if is { w } else { 0.0 };
            let slope = [0, 1].map(|end| {
                std::array::from_fn(|i| {
                    Dual64::new(at.q[self.ends[end].end_q + 3 + i], one(j == 6 * end + 3 + i, w.q))
                })
            });
            let rate = Dual64::new(self.rate(at), one(j >= 12, 0.5 * w.v));
            let x = self.eval(&slope, rate, self.way_now(at));
            for i in 0..3 {
                (block[i][j], block[6 + i][j]) = (x.r[0][i].eps, x.r[1][i].eps);
            }
            (block[12][j], block[13][j]) = (x.p[0].eps, x.p[1].eps);
        }
        out.add_square(0, &block);
    }
    fn power(&self, at: &At<'_>) -> Power {
        // the turn at the ring changes the speed of the material, but nothing of the cable is outside
        let carried = passes(&self.ends, &[0.0; 3], at);
        Power { dissipated: self.now(at).lost, carried, ..Power::default() }
    }
    fn remembers(&self) -> Option<&dyn Remembers> {
        if self.friction > 0.0 { Some(self) } else { None }
    }
    fn shows(&self) -> Option<&dyn Shows> {
        Some(self)
    }
}

impl Remembers for Kink {
    fn remember(&self, _: &At<'_>, memory: &mut [f64]) {
        at_rest::set(self.memory, memory, 0.0);
    }
    fn rests(&self) -> bool {
        self.memory.is_some()
    }
    fn sliding(&self) -> Option<&'static str> {
        self.equilibrium.name()
    }
    fn settle(&self, _: &At<'_>, memory: &mut [f64]) -> bool {
        at_rest::set(self.memory, memory, 1.0)
    }
}

impl Shows for Kink {
    fn columns(&self) -> Vec<Column> {
        let all = [("angle", "rad"), ("in.tension", "N"), ("out.tension", "N"), ("speed", "m/s")];
        all.map(|(name, unit)| Column::new(name, unit)).to_vec()
    }
    fn observe(&self, at: &At<'_>, out: &mut Vec<f64>) {
        let x = self.now(at);
        let stretch = 1.0 + x.tension[0] / self.strand.ea;
        let [before, behind] = self.pulls(at);
        out.extend([x.angle, x.tension[0] + before, x.tension[1] + behind, -self.rate(at) * stretch]);
    }
}
