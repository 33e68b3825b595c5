//! What cables run over, and where they do.

use super::Builder;
use crate::reeving::{Guide, Passage, Winding};
use ropewalk_core::{BuildError, Feed};

impl Builder {
    /// Notes what cables can run over.
    ///
    /// # Errors
    /// Two of one name.
    pub(crate) fn guides(&mut self, guides: Vec<Guide>) -> Result<(), BuildError> {
        for guide in guides {
            let name = guide.name.clone();
            if self.guides.insert(name.clone(), guide).is_some() {
                return Err(BuildError::at("name", format!("two guides of cables are named `{name}`")));
            }
        }
        Ok(())
    }

    /// What a route runs over or through.
    ///
    /// # Errors
    /// There is nothing of this name.
    pub fn guide(&self, name: &str) -> Result<Guide, BuildError> {
        self.guides.get(name).cloned().ok_or_else(|| {
            let names: Vec<String> = self.guides.keys().map(|n| format!("`{n}`")).collect();
            let names = if names.is_empty() { "none".into() } else { names.join(", ") };
            let message =
                format!("there is no sheave, ring or drum `{name}`; those of the scene are {names}");
            BuildError::at("route", message)
        })
    }

    /// Notes that a cable has a route, so that its spans can be named after it; material flows through all of their inner
    /// ends, which all are those of one that is `closed`.
    ///
    /// # Errors
    /// Something else feeds at an end of a span.
    pub fn route(&mut self, name: &str, spans: &[String], closed: bool) -> Result<(), BuildError> {
        if let Some(span) = spans.iter().find(|span| self.feeds.contains_key(*span)) {
            let message = format!(
                "`{span}` feeds at wheels and rings by itself: put a winch at `{name}.start` or `{name}.end`"
            );
            return Err(BuildError::at("route", message));
        }
        self.routes.insert(name.to_string());
        let outer = self.feeds.get(name).cloned().unwrap_or_default();
        let passing = Some((Feed { unstrained: true, passes: true, ..Feed::default() }, name.to_string()));
        for (k, span) in spans.iter().enumerate() {
            let first = if k == 0 && !closed { outer[0].clone() } else { passing.clone() };
            let last = if k + 1 == spans.len() && !closed { outer[1].clone() } else { passing.clone() };
            self.feeds.insert(span.clone(), [first, last]);
        }
        Ok(())
    }

    /// Notes that a cable passes a guide.
    pub fn passage(&mut self, passage: Passage) {
        self.passages.push(passage);
    }

    /// Where cables pass a guide.
    pub fn passages(&self, guide: &str) -> Vec<Passage> {
        self.passages.iter().filter(|p| p.guide == guide).cloned().collect()
    }

    /// Notes that an end of a cable is wound on a drum.
    pub fn winding(&mut self, winding: Winding) {
        self.windings.push(winding);
    }

    /// The ends of cables that are wound on a drum.
    pub fn windings(&self, guide: &str) -> Vec<Winding> {
        self.windings.iter().filter(|w| w.guide == guide).cloned().collect()
    }
}
