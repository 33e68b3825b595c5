//! A cable with a route as a part: its ends, and its spans by number.

use ropewalk_core::{At, Marker, NodeId, Part, Per, Spot, Term, V3};
use ropewalk_scene::Passage;
use std::sync::Arc;

/// A cable that runs over wheels or through rings. What acts on cables acts on its spans.
pub(super) struct RoutePart {
    name: String,
    spans: Vec<Arc<dyn Part>>,
    /// Unstretched length and mass of what lies between the spans at the start.
    between: [f64; 2],
    /// Whether the last span goes on in the first.
    closed: bool,
}

impl RoutePart {
    pub fn new(name: &str, spans: Vec<Arc<dyn Part>>, passages: Vec<Passage>, closed: bool) -> Self {
        let length = passages.iter().map(|p| p.stored).sum();
        let mass = passages.iter().map(|p| p.stored * p.strand.mass).sum();
        RoutePart { name: name.into(), spans, between: [length, mass], closed }
    }

    fn places(&self) -> String {
        let (name, last) = (&self.name, self.spans.len());
        if self.closed {
            return format!("no ends, being closed; its spans have, `{name}.1.start` to `{name}.{last}.end`");
        }
        format!(
            "`{name}.start`, `{name}.end`, and those of its spans, `{name}.1.start` to `{name}.{last}.end`"
        )
    }
}

impl Part for RoutePart {
    fn name(&self) -> &str {
        &self.name
    }
    fn kind(&self) -> &'static str {
        "cable with a route"
    }
    fn marker(&self, spot: &Spot) -> Result<Marker, String> {
        let last = self.spans.len() - 1;
        let Spot::Named(place) = spot else {
            return Err(format!("material flows past places of `{}`; it has {}", self.name, self.places()));
        };
        let (span, place) = match (place.as_str(), place.split_once('.')) {
            ("start", _) if !self.closed => (0, "start"),
            ("end", _) if !self.closed => (last, "end"),
            (_, Some((number, place))) => match number.parse::<usize>() {
                Ok(k) if (1..=last + 1).contains(&k) => (k - 1, place),
                _ => return Err(format!("it has no span {number}; it has {}", self.places())),
            },
            _ => return Err(format!("it has {}", self.places())),
        };
        self.spans[span].marker(&Spot::Named(place.into()))
    }
    fn spans(&self) -> &[Arc<dyn Part>] {
        &self.spans
    }
    // the spans have their own weight, and wheels know what lies on them
    fn dead_load(&self, _: Per, _: V3<f64>) -> Option<Box<dyn Term>> {
        None
    }
    fn length(&self) -> f64 {
        self.spans.iter().map(|span| span.length()).sum::<f64>() + self.between[0]
    }
    fn mass(&self) -> f64 {
        self.between[1]
    }
    fn point(&self, _: f64, _: &At<'_>) -> Option<(V3<f64>, V3<f64>)> {
        None
    }
    fn place_of(&self, _: NodeId) -> Option<String> {
        None
    }
}
