//! The contact of many points with one shape.

use super::block::Block;
use super::flowing::Flowing;
use super::friction::{AtRest, CELLS, Pressed};
use super::group::{Ball, Group, Place, Scratch, Span, What};
use super::law::ContactLaw;
use super::level::Lies;
use super::rest::Resting;
use super::seat::{Fixed, Seat};
use super::shape::Shape;
use super::stiffness::Stiffness;
use ropewalk_core::error::{need, positive};
use ropewalk_core::held::Held;
use ropewalk_core::{
    Assembly, At, BuildError, ContactPoint, ContactSpan, Energy, Foresees, Marker, Node, NodeKind, Pattern,
    Power, Remembers, Shows, SpanLine, Term, Weights,
};

/// Cables, links, hulls and points that touch a shape, which is fixed in space or on a rigid body and feels the opposite
/// force.
///
/// Use it for: sea floors, drums, sheaves, guide tubes, decks. A ball of radius `r` whose centre is at the distance `s`
/// from the surface is pushed out with `k d^p`, `d = r - s`, is damped by the [`ContactLaw`] and, where it slips, held
/// back by friction. What is slender is pushed so per length, wherever along it `d` is above zero: the places are
/// searched for at every evaluation, and the force is integrated over them, so that it follows from an energy and doesn't
/// depend on where nodes are. On a body the force acts where the ball touches, so that a ball rolls; on a cable, which
/// doesn't know twist, and a point mass it acts at the centre.
#[derive(Clone, Debug)]
pub struct Contact {
    /// A name, such as `drum`.
    pub label: String,
    /// Elasticity, damping and friction.
    pub law: ContactLaw,
    pub(super) fixed: Fixed,
    /// Stiffness of all that is slender together, per depth.
    pub(super) per_length: f64,
    pub(super) groups: Vec<Group>,
    /// Pieces of cables that feed.
    pub(super) flowing: Vec<Flowing>,
    /// What friction does at equilibria, if it takes part in them.
    pub(super) resting: Option<Resting>,
}

impl Contact {
    /// Contact of points and slender pieces with a shape whose origin and axes are those of a marker on the ground or on a
    /// rigid body.
    ///
    /// # Errors
    /// A marker on something else, nothing that could touch, something without radius or on the shape's own body, bad
    /// numbers.
    pub fn new(
        label: impl Into<String>,
        nodes: &[Node],
        shape: Shape,
        marker: &Marker,
        touching: (&[ContactPoint], &[ContactSpan]),
        stiffness: Stiffness,
        law: ContactLaw,
    ) -> Result<Self, BuildError> {
        let label = label.into();
        law.check()?;
        let (seat, origin, axes) = match *marker {
            Marker::Ground { point, axes } => (Seat::Ground, point, axes),
            Marker::Node { node, point, axes } => {
                let n = ropewalk_core::held::find(nodes, node, &label)?;
                need(n.kind == NodeKind::Frame, || {
                    format!("{label}: a shape can only be on the ground or on a rigid body")
                })?;
                (Seat::Body { q: n.q, v: n.v }, point, axes)
            }
        };
        let (points, spans) = touching;
        need(!points.is_empty() || !spans.is_empty(), || {
            format!("{label}: there is nothing that could touch the shape")
        })?;
        let mut groups = Vec::with_capacity(points.len() + spans.len());
        let mut flowing = Vec::new();
        for p in points {
            need(!matches!(p.held, Held::Lever { .. }), || {
                format!("{label}: a lever on a cable touches nothing: weld a rigid body there")
            })?;
            let (radius, k) =
                (positive("radius", p.radius)?, positive("stiffness", stiffness.of_point(p.radius))?);
            groups.push(What::Ball(Ball { held: p.held, radius, k, cell: 0 }));
        }
        for s in spans {
            let radius = positive("radius", s.radius)?;
            let per_length = positive("stiffness_per_length", stiffness.of_length(radius))?;
            let end = match stiffness.end {
                None => per_length * 2.0 * radius,
                Some(k) => k,
            };
            let tip = |end_of: usize| {
                let held = s.line.beyond(end_of, radius);
                (s.tips[end_of] && end > 0.0).then_some(Ball { held, radius: 0.0, k: end, cell: end_of })
            };
            let span = Span {
                line: s.line,
                radius,
                length: s.length,
                k: per_length * s.length,
                tips: [tip(0), tip(1)],
                points: shape.points(s.length, law.exponent == 1.0),
            };
            match s.flow {
                None => groups.push(What::Span(Box::new(span))),
                Some(flow) => flowing.extend(Flowing::new(flow, span)),
            }
        }
        let groups: Vec<Group> =
            groups.into_iter().map(|what| Group { what, bristles: None, place: None }).collect();
        for group in &groups {
            let own = matches!((seat, group.held()), (Seat::Body { v, .. }, Held::Beside { v: w, .. } | Held::Moves { v: w, .. }) if v == w);
            need(!own, || format!("{label}: a body can't touch a shape of its own"))?;
        }
        let fixed = Fixed { shape, seat, origin, axes };
        let per_length = spans.iter().map(|s| stiffness.of_length(s.radius) * s.length).sum();
        Ok(Contact { label, law, fixed, per_length, groups, flowing, resting: None })
    }

    /// Says where the slender pieces are on parts of these names, one for each in the order of [`Contact::new`]; what material
    /// flows through comes last there and has no place.
    #[must_use]
    pub fn with_places(mut self, parts: &[String], spans: &[ContactSpan]) -> Self {
        let slender = self.groups.iter_mut().filter(|g| matches!(g.what, What::Span(_)));
        for (group, (part, span)) in slender.zip(parts.iter().zip(spans)) {
            group.place = Some(Place { part: part.as_str().into(), s: span.s });
        }
        self
    }
}

impl Term for Contact {
    fn label(&self) -> String {
        self.label.clone()
    }
    fn acts(&self) -> Option<&'static str> {
        Some("contact")
    }
    fn pattern(&self, p: &mut Pattern) {
        let body = self.body();
        for g in &self.groups {
            p.clique(g.held().dofs().chain(body.clone()));
        }
        for f in &self.flowing {
            p.clique(f.dofs().chain(body.clone()));
        }
    }
    fn symmetric(&self) -> bool {
        let turns = |g: &Group| match &g.what {
            What::Ball(b) => matches!(b.held, Held::Beside { .. }),
            What::Span(s) => matches!(s.line, SpanLine::Straight { .. }),
        };
        self.law.conservative()
            && self.fixed.seat == Seat::Ground
            && self.flowing.is_empty()
            && !self.groups.iter().any(turns)
    }
    fn has_tangent(&self, w: &Weights) -> bool {
        w.q != 0.0 || w.v != 0.0
    }
    fn add(&self, at: &At<'_>, out: &mut Assembly<'_>) {
        let frame = self.fixed.frame(at);
        let mut block = Block::new();
        let mut scratch = Scratch::default();
        let mut cells = [Pressed::NONE; CELLS];
        let tangent = out.wants_tangent().then(|| out.weights());
        let body = self.body();
        let level = self.level_in(at).filter(|_| !self.is_at_rest(at.internal));
        for (clique, group) in self.groups.iter().enumerate() {
            match (Self::lies(level.as_ref(), group, at), &level) {
                (Lies::Above, _) => continue,
                (Lies::Touches(lying), Some(level)) => {
                    self.add_lying(level, (group, &lying), (&frame, at), out, &mut block);
                    block.flush(clique, group.held().dofs(), out);
                    continue;
                }
                _ => {}
            }
            group.gather(&self.fixed, &frame, at, &mut scratch);
            let cells = &mut cells[..group.bristles.map_or(0, |b| b.cells)];
            cells.fill(Pressed::NONE);
            for ball in &scratch.balls {
                self.add_ball(ball, &frame, at, tangent, &mut block, cells);
            }
            self.add_friction(group, &frame, at, cells, out, &mut block);
            block.flush(clique, group.held().dofs().chain(body.clone()), out);
        }
        for (k, flowing) in self.flowing.iter().enumerate() {
            flowing.add(self, self.groups.len() + k, &frame, at, out, &mut scratch);
        }
    }
    fn energy(&self, at: &At<'_>) -> Energy {
        let mut potential = 0.0;
        self.each(at, |k, touch, _| potential += self.law.stored(k, touch.depth));
        Energy { potential, ..Energy::default() }
    }
    fn power(&self, at: &At<'_>) -> Power {
        self.balance(at).1
    }
    fn balance(&self, at: &At<'_>) -> (Energy, Power) {
        let (mut potential, mut pushed, mut rubbed) = (0.0, 0.0, 0.0);
        self.each_with_bristles(
            at,
            |k, t| {
                potential += self.law.stored(k, t.depth);
                pushed += (t.normal - t.elastic) * t.rate;
            },
            |hold, _| rubbed += hold.heat,
        );
        let power = Power { dissipated: pushed + rubbed, ..Power::default() };
        (Energy { potential, ..Energy::default() }, power)
    }
    fn kinked(&self) -> bool {
        self.law.friction.is_some()
    }
    fn remembers(&self) -> Option<&dyn Remembers> {
        if self.law.friction.is_some() { Some(self) } else { None }
    }
    fn foresees(&self) -> Option<&dyn Foresees> {
        Some(self)
    }
    fn shows(&self) -> Option<&dyn Shows> {
        Some(self)
    }
}

impl Remembers for Contact {
    fn remember(&self, at: &At<'_>, memory: &mut [f64]) {
        self.move_anchors(at, memory);
    }
    fn overran(&self, before: &At<'_>, after: &At<'_>, far: &dyn Fn(usize, f64) -> bool) -> Option<String> {
        let turned = || {
            format!(
                "{}: what slid has turned round within a step. A smaller `h_min` sees it turn, or a larger `elastic_slip` of its \
                 friction gives way farther, and longer steps follow it",
                self.label
            )
        };
        self.came_back(before, after, far).then(turned)
    }
    fn rests(&self) -> bool {
        self.law.friction.is_some_and(|f| f.equilibrium != AtRest::None)
    }
    fn takes_hold(&self) -> bool {
        self.rests() && !self.slopes()
    }
    fn let_go(&self, memory: &mut [f64]) {
        self.release(memory);
    }
    fn settle(&self, at: &At<'_>, memory: &mut [f64]) -> bool {
        match self.law.friction.map(|f| f.equilibrium) {
            None | Some(AtRest::None) => false,
            Some(AtRest::Laid) => self.lay(at, memory),
            Some(AtRest::Pulled) => self.brake(at, memory),
        }
    }
}

impl Foresees for Contact {
    fn step_limit(&self, at: &At<'_>) -> f64 {
        let frame = self.fixed.frame(at);
        let mut least = f64::INFINITY;
        for group in &self.groups {
            least = least.min(self.free(group, &frame, at, least));
        }
        for flowing in &self.flowing {
            let now = flowing.now(at);
            least = least.min(self.free(&now.group, &frame, &now.at(at), least));
        }
        least
    }
    fn passes(&self, before: &At<'_>, after: &At<'_>) -> Option<String> {
        self.passed(before, after)
    }
}
