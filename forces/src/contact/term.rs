//! The contact of many points with one shape.

use super::block::{Block, MOST, Slopes, weights};
use super::flowing::Flowing;
use super::friction::{AtRest, CELLS, Pressed};
use super::group::{Ball, Group, Place, Scratch, Span, What};
use super::law::ContactLaw;
use super::level::{Level, Lies};
use super::search::{Depth, Search};
use super::seat::{Fixed, Frame, Seat, minus, rotation};
use super::shape::Shape;
use super::touch::{Pair, Touch};
use ropewalk_core::error::{need, positive};
use ropewalk_core::held::{Held, three};
use ropewalk_core::rotation::{times, transposed_times};
use ropewalk_core::{
    Assembly, At, Attitude, BuildError, Column, ContactPoint, ContactSpan, Energy, Foresees, Marker, Node,
    NodeKind, Pattern, Power, Relaxed, Remembers, Shows, Solid, SpanLine, Term, V3, Weights, dot,
};
use std::ops::Range;

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
    per_length: f64,
    pub(super) groups: Vec<Group>,
    /// Pieces of cables that feed.
    flowing: Vec<Flowing>,
    /// Where the memory says that time runs, if friction is used up at equilibria.
    pub(super) begun: Option<usize>,
}

/// How stiff a contact is, with an exponent `p` other than 1 at a depth of 1 m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stiffness {
    /// Of a single point [N/m^p].
    pub point: f64,
    /// Of what is slender, per length [N/m^p/m].
    pub per_length: f64,
    /// Of the tip of what is slender [N/m^p]; if none is told, that of a length as long as it is thick.
    pub end: Option<f64>,
    /// Instead of these, per area of what lies on a plane, as thick as it is [N/m^p/m²].
    pub area: Option<f64>,
}

impl Stiffness {
    /// Of a ball of this radius.
    pub(super) fn of_point(&self, radius: f64) -> f64 {
        self.area.map_or(self.point, |k| k * std::f64::consts::PI * radius * radius)
    }
    /// Per length of what is slender with this radius.
    pub(super) fn of_length(&self, radius: f64) -> f64 {
        self.area.map_or(self.per_length, |k| k * 2.0 * radius)
    }
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
        Ok(Contact { label, law, fixed, per_length, groups, flowing, begun: None })
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

    /// How deep each point and then each slender piece is at a state [m]; `None` where it doesn't touch.
    pub fn depths<'a>(&'a self, at: &'a At<'_>) -> impl Iterator<Item = Option<f64>> + 'a {
        let frame = self.fixed.frame(at);
        let mut scratch = Scratch::default();
        let fixed = self.groups.iter().map(move |group| self.depth(group, &frame, at, &mut scratch));
        fixed.chain(self.flowing.iter().map(move |f| {
            let (now, mut scratch) = (f.now(at), Scratch::default());
            self.depth(&now.group, &self.fixed.frame(at), &now.at(at), &mut scratch)
        }))
    }

    fn depth(&self, group: &Group, frame: &Frame, at: &At<'_>, scratch: &mut Scratch) -> Option<f64> {
        group.gather(&self.fixed, frame, at, scratch);
        match &group.what {
            What::Ball(b) => {
                let s = self.fixed.place(frame, &b.held.x(at));
                self.fixed.gap(&s, b.radius).map(|g| b.radius - g.distance)
            }
            What::Span(span) => {
                let curve = span.curve(&self.fixed, frame, at);
                let search = Search::new(&self.fixed.shape, &curve, span.radius);
                scratch.found.iter().map(|piece| search.deepest(*piece)).reduce(f64::max)
            }
        }
    }

    /// A ball on what touches, and how it moves against the shape's body.
    #[inline]
    pub(super) fn pair(&self, held: &Held, radius: f64, frame: &Frame, at: &At<'_>) -> Pair {
        let s = self.fixed.place(frame, &held.x(at));
        let (v, carrier) = match *held {
            Held::Beside { q, v, arm } => {
                let omega = three(at.v, v + 3);
                (three(at.v, v), Some(Pair::carried(&frame.r, &rotation(at, q), &arm, &omega, radius)))
            }
            held => (held.velocity(at), None),
        };
        let g = match self.fixed.seat {
            Seat::Ground => v,
            Seat::Body { .. } => transposed_times(&frame.r, &minus(&v, &frame.v)),
        };
        Pair { r: frame.r, omega: frame.omega, s, g, carrier }
    }

    #[inline]
    pub(super) fn touch(&self, ball: &Ball, frame: &Frame, at: &At<'_>) -> Option<(Touch, Pair)> {
        let gap = self.fixed.gap(&self.fixed.place(frame, &ball.held.x(at)), ball.radius)?;
        let pair = self.pair(&ball.held, ball.radius, frame, at);
        let u = pair.velocity(&gap.normal);
        let k = self.softened(ball, at);
        Some((Touch::new(&self.law, gap, ball.radius, k, &u), pair))
    }

    /// The stiffness of a ball; on the way to an equilibrium hardly more than the load can use where the last iteration
    /// has moved it by more than its radius, so that what still comes down isn't thrown up again.
    fn softened(&self, ball: &Ball, at: &At<'_>) -> f64 {
        const SHARE: f64 = 10.0;
        let Some(Relaxed { last: Some(last), how }) = at.relaxed else { return ball.k };
        let d = ball.held.velocity(&At { v: last, ..*at });
        let moved = dot(&d, &d).sqrt();
        if !(moved > ball.radius) {
            return ball.k;
        }
        let share = if self.per_length > 0.0 { ball.k / self.per_length } else { 1.0 };
        let most = SHARE * how.load * share / (moved - ball.radius).powf(self.law.exponent);
        // without a load to speak of, as in a taut cable, it has to hold all the same
        ball.k.min(most.max(ball.k * (ball.radius / moved).powi(3)))
    }

    /// What to say where cables lie around a shape on elements too long for it. A cubic isn't quite an arc: with the
    /// curvature `κ` on a length `h` it is off by `h⁴ κ³/384` from peak to peak, by which the depth, and with it the
    /// pressure, swings to and fro.
    fn coarse(&self, at: &At<'_>) -> Option<String> {
        const SWING: f64 = 0.1;
        let (frame, mut scratch) = (self.fixed.frame(at), Scratch::default());
        let (mut many, mut worst, mut finer) = (0, 0.0_f64, f64::INFINITY);
        for group in &self.groups {
            let What::Span(span) = &group.what else { continue };
            group.gather(&self.fixed, &frame, at, &mut scratch);
            let &[[from, to]] = &scratch.found[..] else { continue };
            if !matches!(span.line, SpanLine::Cubic { .. }) || to - from < 1.0 {
                continue;
            }
            let depths = scratch.balls.iter().filter(|b| b.radius > 0.0).map(|b| {
                let s = self.fixed.place(&frame, &b.held.x(at));
                (self.fixed.gap(&s, b.radius).map_or(0.0, |g| b.radius - g.distance), b.k)
            });
            let (sum, k) = depths.fold((0.0, 0.0), |(sum, all), (d, k)| (sum + d * k, all + k));
            // the normal part of its curvature
            let curve = span.curve(&self.fixed, &frame, at);
            let Some(gap) = self.fixed.shape.gap(&curve.at(0.5), f64::INFINITY) else { continue };
            let curvature = curve.curvature(&gap.normal).max(0.0);
            let (h, mean) = (span.length, sum / k);
            let off = h.powi(4) * curvature.powi(3) / 384.0;
            if off > SWING * mean {
                many += 1;
                worst = worst.max(off / mean);
                finer = finer.min((384.0 * SWING * mean / curvature.powi(3)).powf(0.25));
            }
        }
        (many > 0).then(|| {
            format!(
                "`{}`: {many} elements that lie around it are too long to be arcs: along them the pressure swings by up \
                 to {:.0} % from peak to peak. Take elements of at most {finer:.2e} m there, or a softer contact. What the \
                 ends and the shape feel is right all the same",
                self.label,
                100.0 * worst.min(9.99)
            )
        })
    }

    /// Unknowns of the body that carries the shape.
    pub(super) fn body(&self) -> Range<usize> {
        match self.fixed.seat {
            Seat::Ground => 0..0,
            Seat::Body { v, .. } => v..v + 6,
        }
    }

    /// Sees the stiffness of all that touches, and how it does.
    fn each(&self, at: &At<'_>, mut see: impl FnMut(f64, &Touch, &Frame)) {
        let frame = self.fixed.frame(at);
        let mut scratch = Scratch::default();
        let level = self.level_in(at);
        for group in &self.groups {
            self.each_of(level.as_ref(), group, (&frame, at), &mut scratch, |k, _, touch| {
                see(k, touch, &frame)
            });
        }
        self.each_flowing_ball(at, |ball, touch| see(ball.k, touch, &frame));
    }

    /// The same of one group, with the cell that is touched.
    pub(super) fn each_of(
        &self,
        level: Option<&Level>,
        group: &Group,
        (frame, at): (&Frame, &At<'_>),
        scratch: &mut Scratch,
        mut see: impl FnMut(f64, usize, &Touch),
    ) {
        match (Self::lies(level, group, at), level) {
            (Lies::Above, _) => return,
            (Lies::Touches(lying), Some(level)) => {
                lying.each_point(|p| {
                    let normal = self.law.normal(p.k, p.depth, p.rate);
                    see(p.k, p.cell, &Touch::lying(level.n, &normal, p.depth, p.rate));
                });
                for tip in lying.tips() {
                    if let Some((touch, _)) = self.touch(tip, frame, at) {
                        see(tip.k, 0, &touch);
                    }
                }
                return;
            }
            _ => {}
        }
        group.gather(&self.fixed, frame, at, scratch);
        for ball in &scratch.balls {
            if let Some((touch, _)) = self.touch(ball, frame, at) {
                see(ball.k, ball.cell, &touch);
            }
        }
    }

    /// Sees all that touches of cables that feed.
    pub(super) fn each_flowing_ball(&self, at: &At<'_>, mut see: impl FnMut(&Ball, &Touch)) {
        let (frame, mut scratch) = (self.fixed.frame(at), Scratch::default());
        for flowing in &self.flowing {
            let now = flowing.now(at);
            now.group.gather(&self.fixed, &frame, &now.at(at), &mut scratch);
            for ball in &scratch.balls {
                if let Some((touch, _)) = self.touch(ball, &frame, &now.at(at)) {
                    see(ball, &touch);
                }
            }
        }
    }

    /// Adds the force on one ball, and its derivative to the block of its group; notes how it presses its cell.
    pub(super) fn add_ball(
        &self,
        ball: &Ball,
        frame: &Frame,
        at: &At<'_>,
        tangent: Option<Weights>,
        block: &mut Block,
        cells: &mut [Pressed],
    ) {
        let Some((touch, pair)) = self.touch(ball, frame, at) else { return };
        self.add_force(&ball.held, &pair, &touch, || touch.slopes(), tangent, block);
        let Some(cell) = cells.get_mut(ball.cell) else { return };
        cell.add(touch.normal, &touch.gap.normal);
        if let Some(w) = tangent {
            let by = -(w.q * touch.by_depth + w.v * touch.by_rate);
            let n = &touch.gap.normal;
            if self.fixed.seat == Seat::Ground && pair.carrier.is_none() {
                for (sum, weight) in cell.by.chunks_exact_mut(3).zip(weights(&ball.held)) {
                    (0..3).for_each(|i| sum[i] += by * weight * n[i]);
                }
            } else {
                let force = self.spread(&ball.held, &pair, n, n);
                cell.by.iter_mut().zip(&force).for_each(|(sum, f)| *sum += by * f);
            }
        }
    }

    /// Adds a force at a point, and its derivative.
    pub(super) fn add_force(
        &self,
        held: &Held,
        pair: &Pair,
        touch: &Touch,
        slopes: impl FnOnce() -> Slopes,
        tangent: Option<Weights>,
        block: &mut Block,
    ) {
        if self.fixed.seat == Seat::Ground && pair.carrier.is_none() {
            for (a, w) in weights(held).iter().enumerate().filter(|w| *w.1 != 0.0) {
                (0..3).for_each(|i| block.add(3 * a + i, -w * touch.f[i]));
            }
            if let Some(w) = tangent {
                let Slopes { by_s, by_x, by_u } = slopes();
                let entry = |i: usize, j: usize| w.q * (by_s[i][j] + by_x[i][j]) + w.v * by_u[i][j];
                let d = std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j)));
                block.add_point(held, &d);
            }
            return;
        }
        let force = self.spread(held, pair, &touch.gap.normal, &touch.f);
        let body = if self.fixed.seat == Seat::Ground { 0 } else { 6 };
        (0..held.size() + body).for_each(|i| block.add(i, -force[i]));
        if let Some(w) = tangent {
            block.add_pair(held, &pair.derivative(touch, &slopes(), w));
        }
    }

    /// The generalised force of `f` at a point on all unknowns of its group, where the normal is `n`.
    pub(super) fn spread(&self, held: &Held, pair: &Pair, n: &V3<f64>, f: &V3<f64>) -> [f64; MOST] {
        let (all, size) = (pair.forces(n, f), held.size());
        let mut force = [0.0; MOST];
        if pair.carrier.is_some() {
            force[..6].copy_from_slice(&all[..6]);
        } else {
            for (a, w) in weights(held).iter().enumerate() {
                (0..3).for_each(|i| force[3 * a + i] = w * all[i]);
            }
        }
        if self.fixed.seat != Seat::Ground {
            force[size..size + 6].copy_from_slice(&all[6..]);
        }
        force
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
        let level = self.level_in(at).filter(|_| !self.brakes(at.internal));
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
    fn rests(&self) -> bool {
        self.law.friction.is_some_and(|f| f.equilibrium != AtRest::None)
    }
    fn settle(&self, at: &At<'_>, memory: &mut [f64]) -> bool {
        match self.law.friction.map(|f| f.equilibrium) {
            None | Some(AtRest::None) => return false,
            Some(AtRest::Laid) => self.move_anchors(at, memory),
            Some(AtRest::Pulled) => return self.begin_to_brake(at, memory),
        }
        false
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

impl Shows for Contact {
    fn columns(&self) -> Vec<Column> {
        let force = |name: &str| Column::new(name, "N");
        let mut all = ["fx", "fy", "fz", "normal"].map(force).to_vec();
        all.extend([Column::new("depth", "m"), Column::new("points", "1"), Column::new("length", "m")]);
        if self.law.friction.is_some() {
            all.push(Column::new("slipping", "1"));
        }
        all
    }
    fn observe(&self, at: &At<'_>, out: &mut Vec<f64>) {
        let (mut sum, mut normal, mut deepest): (V3<f64>, f64, f64) = ([0.0; 3], 0.0, 0.0);
        self.each(at, |_, touch, frame| {
            let f = times(&frame.r, &touch.f);
            (0..3).for_each(|i| sum[i] += f[i]);
            normal += touch.normal;
        });
        let (mut points, mut length) = (0.0, 0.0);
        let (frame, mut scratch) = (self.fixed.frame(at), Scratch::default());
        for group in &self.groups {
            let Some(depth) = self.depth(group, &frame, at, &mut scratch) else { continue };
            deepest = deepest.max(depth);
            match &group.what {
                What::Ball(_) => points += 1.0,
                What::Span(s) => length += scratch.found.iter().map(|[a, b]| s.length * (b - a)).sum::<f64>(),
            }
        }
        for flowing in &self.flowing {
            let now = flowing.now(at);
            let Some(depth) = self.depth(&now.group, &frame, &now.at(at), &mut scratch) else { continue };
            deepest = deepest.max(depth);
            length += scratch.found.iter().map(|[a, b]| now.l * (b - a)).sum::<f64>();
        }
        let (mut slipping, mut all) = (0.0, 0.0);
        self.each_braked(at, |f| {
            let f = times(&frame.r, f);
            (0..3).for_each(|i| sum[i] += f[i]);
        });
        self.each_bristle(at, |hold, pressed| {
            let f = times(&frame.r, &hold.f);
            (0..3).for_each(|i| sum[i] += f[i]);
            all += pressed;
            slipping += if hold.slips { pressed } else { 0.0 };
        });
        out.extend(sum);
        out.extend([normal, deepest, points, length]);
        if self.law.friction.is_some() {
            out.push(if all > 0.0 { slipping / all } else { 0.0 });
        }
    }
    fn solids(&self) -> Vec<Solid> {
        let fixed = &self.fixed;
        let carrier = match fixed.seat {
            Seat::Ground => None,
            Seat::Body { q, .. } => Some(q),
        };
        let seat = Attitude::new(fixed.origin, &fixed.axes);
        vec![Solid { name: self.label.clone(), surface: fixed.shape.surface(), carrier, seat }]
    }
    fn remark(&self, at: &At<'_>) -> Option<String> {
        self.coarse(at)
    }
    fn local(&self, quantity: &str, part: &str, s: f64, at: &At<'_>) -> Option<f64> {
        if quantity == "clearance" { self.clearance(part, s, at) } else { None }
    }
}
