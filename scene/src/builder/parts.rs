//! Parts and their meshes, by name, and the places on them that markers mean.

use super::{Builder, Numbered};
use crate::marker::{MarkerRef, split_marker};
use ropewalk_core::error::finite;
use ropewalk_core::{BuildError, Marker, Mesh, Part, Place, Spot};
use std::sync::Arc;

impl Builder {
    /// Adds a named part.
    pub fn part(&mut self, part: Arc<dyn Part>) -> Result<(), BuildError> {
        let name = part.name();
        let span = name.rsplit_once('.').filter(|(route, _)| self.routes.contains(*route));
        if name.is_empty() || span.map_or(name, |(_, number)| number).contains(['.', '@']) {
            return Err(BuildError::at(
                "name",
                format!("`{name}` can't be a name: it is empty or holds `.` or `@`"),
            ));
        }
        if self.parts.iter().any(|p| p.name() == name) {
            return Err(BuildError::at("name", format!("there are two parts named `{name}`")));
        }
        self.length = self.length.max(part.length());
        self.parts.push(part);
        Ok(())
    }

    /// The parts so far, or those of these names, each with its number.
    pub fn parts(&self, names: &[String]) -> Result<Vec<Numbered>, BuildError> {
        if names.is_empty() {
            return Ok(self.parts.iter().cloned().enumerate().collect());
        }
        let mut all = Vec::new();
        for name in names {
            let (k, part) = self.find(name, "on")?;
            for span in part.spans() {
                all.push(self.find(span.name(), "on")?);
            }
            // what lies on wheels is no place for a load
            if part.spans().is_empty() {
                all.push((k, part));
            }
        }
        Ok(all)
    }

    pub(super) fn find(&self, name: &str, field: &'static str) -> Result<(usize, Arc<dyn Part>), BuildError> {
        match self.parts.iter().position(|p| p.name() == name) {
            Some(k) => Ok((k, self.parts[k].clone())),
            None => Err(BuildError::at(
                field,
                format!("there is no part `{name}`; the parts are {}", self.part_names()),
            )),
        }
    }

    fn part_names(&self) -> String {
        let names: Vec<String> = self.parts.iter().map(|p| format!("`{}`", p.name())).collect();
        if names.is_empty() { "none".into() } else { names.join(", ") }
    }

    /// Finds a marker.
    pub fn marker(&self, field: &'static str, marker: &MarkerRef) -> Result<Marker, BuildError> {
        let name = match marker {
            MarkerRef::Point(p) => {
                finite(field, p)?;
                return Ok(Marker::ground(*p));
            }
            MarkerRef::Name(name) => name,
        };
        let (part, spot) =
            split_marker(name).map_err(|e| BuildError::at(field, format!("marker `{name}`: {e}")))?;
        let (_, part) = self.find(part, field)?;
        part.marker(&spot).map_err(|e| BuildError::at(field, format!("marker `{name}`: {e}")))
    }

    /// Where a marker was when the run began; what holds on to that place does so over all changes of the mesh.
    pub fn place(&self, marker: &Marker) -> Place<f64> {
        marker.place(&self.nodes, &self.laid, |_| 0.0)
    }

    /// Notes the markers that constraints and forces hold, so that cables put nodes there.
    pub(crate) fn pin(&mut self, markers: &[&MarkerRef]) {
        for m in markers {
            if let MarkerRef::Name(name) = m
                && let Ok((part, spot @ (Spot::Along(_) | Spot::Share(_)))) = split_marker(name)
            {
                self.pins.entry(part.to_string()).or_default().push(spot);
            }
        }
    }

    /// Arc lengths at which a part of this length needs nodes, ascending.
    pub fn pins(&self, part: &str, length: f64) -> Vec<f64> {
        let place = |spot: &Spot| match spot {
            Spot::Along(s) => Some(*s),
            Spot::Share(share) => Some(share * length),
            Spot::Named(_) => None,
        };
        let mut pins: Vec<f64> = self.pins.get(part).into_iter().flatten().filter_map(place).collect();
        pins.sort_by(f64::total_cmp);
        pins.dedup();
        pins
    }

    /// Replaces the mesh of a part.
    pub(crate) fn remesh(&mut self, part: &str, mesh: Mesh) {
        self.meshes.insert(part.to_string(), mesh);
    }

    /// The mesh that replaces that of a part's spec, if there is one.
    pub fn mesh(&self, part: &str) -> Option<&Mesh> {
        self.meshes.get(part)
    }
}
