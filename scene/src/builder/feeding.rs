//! Ends of cables through which material flows.

use super::Builder;
use crate::marker::{MarkerRef, split_marker};
use ropewalk_core::{BuildError, Feed, MovingBoundary, Part, Spot};
use std::sync::Arc;

/// Part and end of a marker at an end of a cable.
fn end_of(marker: &MarkerRef) -> Result<(&str, usize), BuildError> {
    let ends = "material flows through an end of a cable: name one, like `hose.start` or `hose.end`";
    let MarkerRef::Name(name) = marker else { return Err(BuildError::at("marker", ends)) };
    match split_marker(name).map_err(|e| BuildError::at("marker", format!("marker `{name}`: {e}")))? {
        (part, Spot::Named(end)) if end == "start" => Ok((part, 0)),
        (part, Spot::Named(end)) if end == "end" => Ok((part, 1)),
        // of a span of a cable with a route
        (_, Spot::Named(place)) if place.contains('.') => match name.rsplit_once('.') {
            Some((span, "start")) => Ok((span, 0)),
            Some((span, "end")) => Ok((span, 1)),
            _ => Err(BuildError::at("marker", format!("{marker}: {ends}"))),
        },
        _ => Err(BuildError::at("marker", format!("{marker}: {ends}"))),
    }
}

impl Builder {
    /// Notes that material flows through an end of a part, by a constraint of this name.
    ///
    /// # Errors
    /// The marker is no end of a part, or something else pays out there.
    pub fn feed(&mut self, name: &str, marker: &MarkerRef, feed: Feed) -> Result<(), BuildError> {
        let (part, end) = end_of(marker)?;
        match self.feeds.entry(part.to_string()).or_default()[end].replace((feed, name.to_string())) {
            None => Ok(()),
            Some((_, other)) => {
                let message =
                    format!("two constraints pay out at {marker}, `{other}` and `{name}`: leave out one");
                Err(BuildError::at("marker", message))
            }
        }
    }

    /// What flows through the start and the end of a part.
    pub fn feeding(&self, part: &str) -> [Option<Feed>; 2] {
        let ends = self.feeds.get(part);
        ends.map_or([None; 2], |ends| ends.each_ref().map(|end| end.as_ref().map(|(feed, _)| *feed)))
    }

    /// The boundary at an end of a part that feeds; `remedy` says what to add where nothing does.
    ///
    /// # Errors
    /// The marker isn't an end of a part that material flows through.
    pub fn boundary(&self, marker: &MarkerRef, remedy: &str) -> Result<MovingBoundary, BuildError> {
        let (name, end) = end_of(marker)?;
        let part = self.end_part(name, end)?;
        part.boundary(end).ok_or_else(|| {
            let message = match part.slender() {
                Some(_) => format!("nothing feeds at {marker}: {remedy}"),
                None => {
                    let kind = part.kind();
                    format!("material can flow through the ends of a cable, but `{name}` is a {kind}")
                }
            };
            BuildError::at("marker", message)
        })
    }

    /// The part at an end of which material flows.
    ///
    /// # Errors
    /// As for [`Builder::boundary`].
    pub fn feeding_part(&self, marker: &MarkerRef) -> Result<Arc<dyn Part>, BuildError> {
        let (name, end) = end_of(marker)?;
        self.end_part(name, end)
    }

    /// The part at an end of a part: of a cable with a route, its first or last span.
    fn end_part(&self, name: &str, end: usize) -> Result<Arc<dyn Part>, BuildError> {
        let (_, part) = self.find(name, "marker")?;
        let span = if end == 0 { part.spans().first() } else { part.spans().last() };
        Ok(span.cloned().unwrap_or(part))
    }

    /// Starts the run with an end of a cable feeding at this rate of its material coordinate [m/s].
    pub fn start_feeding(&mut self, marker: &MarkerRef, rate: f64) -> Result<(), BuildError> {
        let (name, end) = end_of(marker)?;
        let part = self.end_part(name, end)?;
        if let Some(line) = part.line() {
            line.start_feeding(end, rate, &self.start.q, &mut self.start.v);
        }
        Ok(())
    }

    /// Whether meshes change while the model runs.
    pub(crate) fn changes(&self) -> bool {
        self.feeds.values().flatten().flatten().any(|(feed, _)| feed.element.is_some())
    }
}
