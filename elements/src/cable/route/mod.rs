//! Cables with a route: over wheels and through rings, from end to end.
//!
//! Such a cable is several spans, which are cables of their own whose inner ends feed, and a [`Passage`] between each two
//! of them, whose equations the constraint of the wheel or ring makes. Without ends it is a closed belt: the last span goes
//! on in the first.

mod geometry;
mod part;
mod torsion;

use geometry::Fault;
pub use geometry::{Side, Stop, lay, lay_closed};

use super::spec::CableSpec;
use part::RoutePart;
use ropewalk_core::error::finite;
use ropewalk_core::{BuildError, Equation, Feed, Joint, Marker, MovingBoundary, Spot, V3, dot};
use ropewalk_scene::{Builder, ElementSpec, Guide, MarkerRef, Passage, Strand, Winding};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;
use std::sync::Arc;

/// An entry of a route, in the order in which the cable comes by from its start.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Waypoint {
    /// An end of the cable: a marker on a part, to which it is tied, or a point in space, where it is laid and left free.
    End(MarkerRef),
    /// Name of a sheave that the cable runs over: it lies on the upper side.
    Over(String),
    /// Name of a sheave that the cable runs under.
    Under(String),
    /// Name of a sheave about whose axis the cable turns by the right-hand rule, such as one with a vertical axis.
    Round(String),
    /// Name of a ring that the cable runs through.
    Through(String),
    /// Name of a drum on which the cable is wound, at an end of it.
    Wound(String),
}

impl Waypoint {
    /// The name of its guide; none of an end.
    fn guide(&self) -> Option<&str> {
        match self {
            Waypoint::End(_) => None,
            Waypoint::Over(name)
            | Waypoint::Under(name)
            | Waypoint::Round(name)
            | Waypoint::Through(name)
            | Waypoint::Wound(name) => Some(name),
        }
    }
}

fn at<T>(k: usize, message: impl Into<String>) -> Result<T, BuildError> {
    Err(BuildError::at(format!("route[{k}]"), message.into()))
}

/// Where the guides of a route are.
struct Guided {
    guide: Guide,
    marker: Marker,
}

impl CableSpec {
    /// Refuses what a cable with a route can't have.
    fn check_route(&self, b: &Builder) -> Result<(), BuildError> {
        let own = "the route says where the cable is laid: leave it out";
        let straight =
            "a cable that runs over wheels is straight and unstretched when free of stress: leave it out";
        let alike = "a cable that runs over wheels is the same all along: give it one `section`";
        let flows = "material flows past all places of a cable that runs over wheels: leave them out";
        let round = "a cable that runs over wheels bends alike in all directions: give one stiffness";
        let slow = "the spin of a cable that runs over wheels turns nothing aside: leave it out";
        let refused = [
            ("points", !self.points.is_empty(), own),
            ("curve", !self.curve.is_empty(), own),
            ("radius", self.radius.is_some(), own),
            ("velocity", self.velocity != [0.0; 3], "give `speed`, with which it runs along its route"),
            ("mesh", self.mesh.is_some(), "give `elements`, the number of each span"),
            ("sections", !self.sections.is_empty(), alike),
            ("stress_free", self.stress_free != Default::default(), straight),
            ("strain", self.strain != 0.0, straight),
            ("curvature", self.curvature != 0.0, straight),
            ("section.ei", self.section.ei.has_direction(), round),
            ("section.gyroscopic", self.section.gyroscopic, slow),
            ("levers", !self.levers.is_empty(), flows),
        ];
        if let Some((field, _, message)) = refused.into_iter().find(|(_, is, _)| *is) {
            return Err(BuildError::at(field, message));
        }
        if b.feeding(&self.name).iter().flatten().any(|feed| feed.element.is_some()) {
            let message = format!(
                "the spans of `{}` grow and shrink as a whole: leave `element_length` of its winch out",
                self.name
            );
            return Err(BuildError::at("route", message));
        }
        let ends = |w: Option<&Waypoint>| matches!(w, Some(Waypoint::End(_) | Waypoint::Wound(_)));
        if self.closed() {
            let fed = b.feeding(&self.name).iter().any(Option::is_some);
            return match fed {
                true => {
                    let message = "a closed belt has no end at which cable could be fed: leave the winch out";
                    Err(BuildError::at("route", message))
                }
                false => Ok(()),
            };
        }
        let inner = self.route.len().max(2) - 1;
        let wound = self.route.iter().any(|w| matches!(w, Waypoint::Wound(_)));
        let least = if wound { 2 } else { 3 };
        if !ends(self.route.first()) || !ends(self.route.last()) || self.route.len() < least {
            let message = "a route begins and ends with `end` or `wound`, like [{ end = [0, 0, 0] }, { over = \"wheel\" }, \
                           { end = \"load\" }]; a closed belt has none, like [{ round = \"driver\" }, { round = \"driven\" }]";
            return Err(BuildError::at("route", message));
        }
        if wound && self.speed != 0.0 {
            let message = "a cable that is wound on a drum starts at rest, as the drum does: leave it out";
            return Err(BuildError::at("speed", message));
        }
        match (1..inner).find(|&k| ends(self.route.get(k))) {
            Some(k) => at(k, "only the first and the last of a route are ends, `end` or `wound`"),
            None => Ok(()),
        }
    }

    /// The guides of the route, in its order.
    fn guided(&self, b: &Builder) -> Result<Vec<Option<Guided>>, BuildError> {
        let one = |(k, waypoint): (usize, &Waypoint)| {
            let Some(name) = waypoint.guide() else { return Ok(None) };
            let guide = b.guide(name).map_err(|e| e.of(format!("route[{k}]")))?;
            if !(guide.radius >= 0.0 && guide.radius.is_finite()) {
                return at(
                    k,
                    format!("the `radius` of `{name}` is a positive length, not {} m", guide.radius),
                );
            }
            if !(dot(&guide.axis, &guide.axis) > 0.0) {
                return at(
                    k,
                    format!("the `axis` of `{name}` is a direction, such as [0, 1, 0]: it needs a length"),
                );
            }
            match (matches!(waypoint, Waypoint::Wound(_)), guide.winds) {
                (true, false) => {
                    return at(k, format!("`{name}` is no drum, so nothing can be `wound` on it"));
                }
                (false, true) => {
                    return at(
                        k,
                        format!("`{name}` is a drum: the cable ends there, `{{ wound = \"{name}\" }}`"),
                    );
                }
                _ => {}
            }
            let ring = matches!(waypoint, Waypoint::Through(_));
            match (ring, guide.radius > 0.0) {
                (true, true) => {
                    return at(k, format!("`{name}` is a sheave: run `over`, `under` or `round` it"));
                }
                (false, false) => {
                    return at(k, format!("`{name}` has no radius, as a ring: run `through` it"));
                }
                _ => {}
            }
            let marker = b.marker("route", &guide.marker).map_err(|e| {
                let message = format!("{}. What carries `{name}` stands above the cable", e.message);
                BuildError::at(format!("route[{k}]"), message)
            })?;
            Ok(Some(Guided { guide, marker }))
        };
        self.route.iter().enumerate().map(one).collect()
    }

    /// The stops of the route as they are at the start.
    fn stops(&self, b: &Builder, guided: &[Option<Guided>]) -> Result<Vec<Stop>, BuildError> {
        let gravity = b.gravity();
        let heavy = dot(&gravity, &gravity) > 0.0;
        let up = if heavy { gravity.map(|g| -g) } else { [0.0, 0.0, 1.0] };
        let one = |(k, (waypoint, guided)): (usize, (&Waypoint, &Option<Guided>))| {
            let side = match waypoint {
                Waypoint::End(marker) => {
                    let marker = b.marker("route", marker).map_err(|e| e.of(format!("route[{k}]")))?;
                    return Ok(Stop::Point(b.place(&marker).x));
                }
                Waypoint::Over(_) => Side::Towards(up),
                Waypoint::Under(_) => Side::Towards(up.map(|x| -x)),
                Waypoint::Round(_) | Waypoint::Through(_) | Waypoint::Wound(_) => Side::About,
            };
            let Some(Guided { guide, marker }) = guided else { return at(k, "it leads nowhere") };
            let place = b.place(marker).x;
            let size = dot(&guide.axis, &guide.axis).sqrt();
            if guide.radius == 0.0 {
                return Ok(Stop::Point(place));
            }
            let axis = guide.axis.map(|x| x / size);
            if let Side::Towards(up) = side
                && dot(&axis, &up).abs() > 0.9 * dot(&up, &up).sqrt()
            {
                let message = format!(
                    "the axis of `{}` is nearly vertical: say `round`, by the right-hand rule about its axis",
                    guide.name
                );
                return at(k, message);
            }
            let centre = std::array::from_fn(|i| place[i] + guide.beside * axis[i]);
            // a drum turns about its axis to pay out: the cable arrives at one the other way round
            let axis = if guide.winds && k > 0 { axis.map(|x| -x) } else { axis };
            Ok(Stop::Wheel { centre, axis, radius: guide.radius, side })
        };
        self.route.iter().zip(guided).enumerate().map(one).collect()
    }

    /// Whether the route has no ends: it closes on itself.
    fn closed(&self) -> bool {
        self.route.len() > 1 && !self.route.iter().any(|w| matches!(w, Waypoint::End(_) | Waypoint::Wound(_)))
    }

    /// Makes a cable with a route: its spans, and what is between them.
    pub(super) fn build_route(&self, b: &mut Builder) -> Result<(), BuildError> {
        self.check_route(b)?;
        self.section.check()?;
        finite("speed", &[self.speed])?;
        let guided = self.guided(b)?;
        let stops = self.stops(b, &guided)?;
        let closed = self.closed();
        let laid = if closed { lay_closed(&stops) } else { lay(&stops) };
        let mut turns = laid.map_err(|Fault { stop, what }| {
            let message = match self.route[stop].guide() {
                Some(name) => format!("the cable can't run as its route says at `{name}`: {what}"),
                None => what.to_string(),
            };
            BuildError::at(format!("route[{stop}]"), message)
        })?;
        for (turn, guided) in turns.iter_mut().zip(&guided) {
            turn.wrap += guided.as_ref().map_or(0.0, |g| TAU * g.guide.turns);
        }
        let number = turns.len() - usize::from(!closed);
        let next = |k: usize| (k + 1) % turns.len();
        let spans: Vec<[V3<f64>; 2]> = (0..number).map(|k| [turns[k].at[1], turns[next(k)].at[0]]).collect();
        let way = |s: &[V3<f64>; 2]| -> V3<f64> { std::array::from_fn(|i| s[1][i] - s[0][i]) };
        let lengths: Vec<f64> = spans.iter().map(|s| dot(&way(s), &way(s)).sqrt()).collect();
        let radius = |k: usize| guided[k].as_ref().map_or(0.0, |g| g.guide.radius);
        let arcs = turns.iter().enumerate().map(|(k, turn)| radius(k) * turn.wrap);
        let path: f64 = lengths.iter().sum::<f64>() + arcs.sum::<f64>();
        if let Some(k) = lengths.iter().position(|l| *l <= 1e-6 * path) {
            return at(k, "nothing of the cable is free between this and what follows");
        }
        let stretch = path / self.unstretched_length(path)?;
        let names: Vec<String> = (1..=spans.len()).map(|k| format!("{}.{k}", self.name)).collect();
        for (place, k) in [("start", 0), ("end", self.route.len() - 1)] {
            if let Waypoint::Wound(drum) = &self.route[k] {
                let end = MarkerRef::Name(format!("{}.{place}", self.name));
                b.feed(drum, &end, Feed { wound: true, ..Feed::default() })
                    .map_err(|e| e.of(format!("route[{k}]")))?;
            }
        }
        b.route(&self.name, &names, closed)?;
        let torsion = self.route_torsion(closed, &stops)?;
        let stored = |k: usize| radius(k) * turns[k].wrap / stretch;
        let boundary = |b: &Builder, k: usize, end: usize| -> Result<Option<MovingBoundary>, BuildError> {
            Ok(b.parts(std::slice::from_ref(&names[k]))?[0].1.boundary(end))
        };
        for (k, ((name, span), length)) in names.iter().zip(&spans).zip(&lengths).enumerate() {
            let along = way(span).map(|x| self.speed * x / length);
            let normal = match torsion.and(k.checked_sub(1)) {
                Some(before) => {
                    self.check_kink(k, [&way(&spans[before]), &way(span)])?;
                    boundary(b, before, 1)?.map(|end| {
                        let twist = self.laid_twist * stored(k);
                        torsion::behind(b, &end, (&stops[k], &turns[k]), &way(span), twist)
                    })
                }
                None => self.normal,
            };
            let span = CableSpec {
                name: name.clone(),
                points: span.to_vec(),
                length: Some(length / stretch),
                tension: None,
                elements: self.elements.max(1),
                velocity: along,
                speed: 0.0,
                route: Vec::new(),
                normal,
                ..self.clone()
            };
            span.build(b).map_err(|e| match e.field.as_deref() {
                Some("length") if self.tension.is_some() => e.of("tension"),
                _ => e,
            })?;
        }
        let parts = names.iter().map(|name| Ok(b.parts(std::slice::from_ref(name))?[0].1.clone()));
        let parts = parts.collect::<Result<Vec<_>, BuildError>>()?;
        let s = &self.section;
        let strand = Strand {
            mass: s.mass,
            ea: s.ea,
            ei: s.ei.across,
            diameter: s.diameter,
            // as in spans, where torsion brings what is missing of EA without damping
            damping: s.axial_retardation_time * (s.ea - torsion.map_or(0.0, |t| t.lay * t.lay / t.gj)),
            weighs: b.weighs(&self.name),
            torsion,
        };
        let fed = b.feeding(&self.name).map(|feed| feed.is_some());
        let mut passages = Vec::new();
        for (k, turn) in turns.iter().enumerate() {
            let Some(Guided { guide, marker }) = &guided[k] else { continue };
            if guide.winds {
                let (span, end) = if k == 0 { (0, 0) } else { (k - 1, 1) };
                let Some(boundary) = parts[span].boundary(end) else {
                    return at(k, "no material flows there");
                };
                b.winding(Winding {
                    guide: guide.name.clone(),
                    cable: self.name.clone(),
                    span: names[span].clone(),
                    boundary,
                    marker: *marker,
                    stretch,
                    twist: self.laid_twist,
                    strand,
                });
                continue;
            }
            let before = (k + number - 1) % number;
            let (Some(end), Some(start)) = (parts[before].boundary(1), parts[k].boundary(0)) else {
                return at(k, "no material flows there");
            };
            let passage = Passage {
                guide: guide.name.clone(),
                spans: [names[before].clone(), names[k].clone()],
                fed,
                boundaries: [end, start],
                marker: *marker,
                axis: turn.axis,
                radius: guide.radius,
                wrap: turn.wrap,
                stored: stored(k),
                twist: self.laid_twist * stored(k),
                strand,
            };
            b.passage(passage.clone());
            passages.push(passage);
        }
        // running along the route, it stands still in space at the wheels
        let joints = usize::from(!closed)..number;
        let inner = joints.flat_map(|k| [((k + number - 1) % number, "end"), (k, "start")]);
        for (k, end) in inner.filter(|_| self.speed != 0.0) {
            b.start_feeding(&format!("{}.{end}", names[k]).as_str().into(), -self.speed / stretch)?;
        }
        for (end, k) in [(0, 0), (1, self.route.len() - 1)] {
            let Waypoint::End(marker @ MarkerRef::Name(_)) = &self.route[k] else { continue };
            let place = ["start", "end"][end];
            let own = parts[if end == 0 { 0 } else { parts.len() - 1 }]
                .marker(&Spot::Named(place.into()))
                .map_err(BuildError::new)?;
            let to = b.marker("route", marker).map_err(|e| e.of(format!("route[{k}]")))?;
            let name = format!("{}.{place}", self.name);
            b.constraint(Joint::new(name, b.nodes(), [to, own], Equation::coincide())?)?;
        }
        b.part(Arc::new(RoutePart::new(&self.name, parts, passages, closed)))
    }
}
