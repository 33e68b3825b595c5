//! What of a scene may touch a shape, and the friction that it gets.

use super::friction::{Brake, Friction, Grip};
use super::spec::ContactSpec;
use super::stiffness::Stiffness;
use super::term::Contact;
use ropewalk_core::held::Held;
use ropewalk_core::{At, BuildError, ContactPoint, ContactSpan, NodeKind, SpanLine, V3, dot};
use ropewalk_scene::Builder;

/// What may touch, with names for messages.
#[derive(Default)]
pub(super) struct Candidates {
    pub(super) points: Vec<(String, ContactPoint)>,
    pub(super) spans: Vec<(String, ContactSpan)>,
    /// What the friction of each has to hold.
    weights: Vec<Weight>,
    span_weights: Vec<Weight>,
}

/// What friction has to hold, as far as the part tells.
struct Weight {
    /// Mass, of the piece that touches [kg].
    mass: f64,
    /// Length of the piece, and of the whole part [m].
    length: f64,
    whole: f64,
    /// Axial stiffness [N].
    ea: f64,
}

/// Slip along a cable is smeared out over no more than this part of its length.
const SMEARED: f64 = 0.05;
/// Elastic slip, in parts of the thickness.
const SLIP: f64 = 0.01;
/// Damping ratio of bristles that hold.
const RATIO: f64 = 0.5;

impl Candidates {
    /// Puts what material flows through behind the rest, as the term keeps it.
    fn part_flowing(&mut self) {
        let spans = std::mem::take(&mut self.spans).into_iter().zip(std::mem::take(&mut self.span_weights));
        let (flowing, fixed): (Vec<_>, Vec<_>) = spans.partition(|((_, s), _)| s.flow.is_some());
        (self.spans, self.span_weights) = fixed.into_iter().chain(flowing).unzip();
    }
    pub(super) fn len(&self) -> usize {
        self.points.len() + self.spans.len()
    }

    /// How the friction of each point and slender piece is used up at equilibria: by the pull on that end of its cable which is
    /// farther away from the shape at the start.
    pub(super) fn brakes(
        &self,
        friction: &Friction,
        contact: &Contact,
        q: &[f64],
        down: V3<f64>,
    ) -> Result<Vec<Option<Brake>>, BuildError> {
        let gravity = dot(&down, &down).sqrt();
        let still = vec![0.0; q.len()];
        let at = At { t: 0.0, q, v: &still, a: &still, internal: &[], relaxed: None };
        let mut all = vec![None; self.points.len()];
        for ((name, span), w) in self.spans.iter().zip(&self.span_weights) {
            let away = |s: f64| contact.clearance(name, s, &at);
            let (Some(start), Some(end), SpanLine::Cubic { .. }) = (away(0.0), away(w.whole), span.line)
            else {
                let message = format!(
                    "`{name}` is no cable of which both ends can touch: friction that a pull uses up is known of cables alone. \
                     Leave it out by `on`, or take `equilibrium = \"laid\"`"
                );
                return Err(BuildError::at("friction", message));
            };
            // as much as friction takes up on one element
            let strain = 2.0 * friction.mu * w.mass * gravity / w.ea;
            let way = if end >= start { 1.0 } else { -1.0 };
            all.push((strain > 0.0 && strain.is_finite()).then_some(Brake {
                way,
                strain,
                up: down.map(|g| -g / gravity),
            }));
        }
        Ok(all)
    }
}

fn needs(name: &str, what: &str, field: &str, k: f64) -> Result<(), BuildError> {
    if k != 0.0 {
        return Ok(());
    }
    let message = format!("{name} touches {what}, which needs a `{field}` above zero");
    Err(BuildError::at(field, message))
}

impl ContactSpec {
    /// What may touch, each with what it is called in messages.
    pub(super) fn candidates(
        &self,
        b: &Builder,
        own_seat: Option<(usize, usize)>,
        stiffness: &Stiffness,
    ) -> Result<Candidates, BuildError> {
        let mut all = Candidates::default();
        if !self.on.is_empty() || self.points.is_empty() {
            for (_, part) in b.parts(&self.on)? {
                let own = own_seat.is_some_and(|seat| part.seats() == [seat]);
                let before = all.len();
                if !own {
                    let (mass, length) = (part.mass(), part.length());
                    let ea = part.slender().map_or(0.0, |s| s.ea);
                    let whole = format!("`{}`", part.name());
                    // a clump without a size leaves touching to what it sits on
                    let sits = self.on.is_empty() && self.radius.is_none() && part.seats().is_empty();
                    let mut points = part.contact_points();
                    points.retain(|p| !sits || p.radius > 0.0);
                    all.weights.extend(points.iter().map(|_| Weight {
                        mass,
                        length: 0.0,
                        ea: 0.0,
                        whole: 0.0,
                    }));
                    all.points.extend(points.into_iter().map(|p| (whole.clone(), p)));
                    let carries = |s: &ContactSpan| match s.line {
                        SpanLine::Straight { q, v, .. } => own_seat == Some((q, v)),
                        SpanLine::Cubic { .. } => false,
                    };
                    let spans = part.contact_spans().into_iter().filter(|s| !carries(s));
                    for s in spans {
                        let mass = mass * if length > 0.0 { (s.length / length).min(1.0) } else { 1.0 };
                        all.span_weights.push(Weight { mass, length: s.length, ea, whole: length });
                        all.spans.push((part.name().to_string(), s));
                    }
                }
                if all.len() == before && !self.on.is_empty() {
                    let message = if own {
                        format!("`{}` carries the shape itself: leave it out of `on`", part.name())
                    } else {
                        format!(
                            "`{}` has nothing to touch with: give it a `hull`, or name points of it in `points`",
                            part.name()
                        )
                    };
                    return Err(BuildError::at("on", message));
                }
            }
        }
        for name in &self.points {
            let marker = b.marker("points", name)?;
            let Some(node) = marker.on() else {
                return Err(BuildError::at(
                    "points",
                    format!("{name} doesn't move: name a marker on a part"),
                ));
            };
            let n = b.nodes()[node.0 as usize];
            let held = match (Held::new(b.nodes(), &marker, &self.name)?, n.kind) {
                (Held::Moves { q, v }, NodeKind::Frame) => Held::Beside { q, v, arm: [0.0; 3] },
                (held, _) => held,
            };
            all.points.push((format!("{name}"), ContactPoint { held, radius: 0.0 }));
            let carrier = b.parts(&[])?.into_iter().find(|(_, part)| part.place_of(node).is_some());
            let mass = carrier.map_or(0.0, |(_, part)| part.mass());
            all.weights.push(Weight { mass, length: 0.0, ea: 0.0, whole: 0.0 });
        }
        all.part_flowing();
        if let Some((name, _)) = all.spans.iter().find(|(_, s)| s.flow.is_some())
            && self.law().friction.is_some()
        {
            return Err(BuildError::new(format!(
                "`{name}` feeds, and friction on material that runs through isn't known here: leave the cable out by `on`, or \
                 `friction`"
            )));
        }
        if all.len() == 0 {
            return Err(BuildError::new("there is nothing in the scene that could touch this shape"));
        }
        for (name, p) in &mut all.points {
            self.give_size(name, &mut p.radius)?;
            needs(name, "by a single point", "stiffness", stiffness.of_point(p.radius))?;
        }
        for (name, s) in &mut all.spans {
            let name = format!("`{name}`");
            self.give_size(&name, &mut s.radius)?;
            needs(&name, "along its length", "stiffness_per_length", stiffness.of_length(s.radius))?;
        }
        Ok(all)
    }

    /// How stiff the friction of each point and slender piece is: so that it gives way by the elastic slip under its
    /// weight, no softer than the contact itself, and so stiff that slip along a cable begins where it should.
    pub(super) fn grips(
        &self,
        friction: &Friction,
        all: &Candidates,
        gravity: f64,
        how: &Stiffness,
    ) -> Vec<Grip> {
        let points = all.points.iter().map(|p| (p.1.radius, how.of_point(p.1.radius))).zip(&all.weights);
        let spans = all.spans.iter().map(|(_, s)| (s.radius, how.of_length(s.radius) * s.length));
        let grip = |((radius, k), w): ((f64, f64), &Weight)| {
            let slip = friction.elastic_slip.unwrap_or(SLIP * 2.0 * radius);
            let held = friction.mu * w.mass * gravity / slip;
            let stiffness = match friction.elastic_slip {
                Some(_) if held > 0.0 => held,
                _ => {
                    let along =
                        if w.whole > 0.0 { w.ea * w.length / (SMEARED * w.whole).powi(2) } else { 0.0 };
                    held.max(along).max(if self.exponent == 1.0 { k } else { 0.0 })
                }
            };
            let stiffness = if stiffness > 0.0 { stiffness } else { k * slip.powf(self.exponent - 1.0) };
            Grip { stiffness, damping: 2.0 * RATIO * (stiffness * w.mass).sqrt(), brake: None }
        };
        points.chain(spans.zip(&all.span_weights)).map(grip).collect()
    }

    fn give_size(&self, name: &str, radius: &mut f64) -> Result<(), BuildError> {
        *radius = self.radius.unwrap_or(*radius);
        if *radius > 0.0 {
            return Ok(());
        }
        let message = format!(
            "{name} has no size to touch with: give the contact a `radius`, or the cable's section a `diameter`, or name what \
             else touches in `on`"
        );
        Err(BuildError::at("radius", message))
    }
}
