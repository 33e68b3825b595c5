//! The sections that a scene gives a cable: whether they can be, and where each of them lies.

use super::mesh::{counted, even, pinned};
use super::model::{LongitudinalModel, TransverseModel};
use super::section::{Section, SectionAlong};
use super::spec::{CableSpec, StressFree};
use ropewalk_core::BuildError;
use ropewalk_core::error::positive;

/// The same error, of a field of one of several sections.
fn inside(i: usize) -> impl Fn(BuildError) -> BuildError {
    move |e| {
        let field = e.field.clone().unwrap_or_default();
        e.of(format!("sections[{i}].{field}"))
    }
}

impl CableSpec {
    /// Checks what the cable is made of.
    pub(super) fn check_sections(&self) -> Result<(), BuildError> {
        if self.sections.is_empty() {
            if self.section.is_missing() {
                let message =
                    "a cable needs a `section`: what is it made of? Or give several `sections` along it";
                return Err(BuildError::new(message));
            }
            self.section.check()?;
            return self.check_laws(&self.section);
        }
        if !self.section.is_missing() {
            let message =
                "give `section` or `sections`, not both: the last of several sections goes on to the end";
            return Err(BuildError::at("section", message));
        }
        for (i, along) in self.sections.iter().enumerate() {
            self.check_one(&along.section).map_err(|e| {
                let field = e.field.clone().unwrap_or_default();
                inside(i)(e.of(format!("section.{field}")))
            })?;
            if let Some(end) = &along.end_section {
                self.check_one(end).map_err(|e| {
                    let field = e.field.clone().unwrap_or_default();
                    inside(i)(e.of(format!("end_section.{field}")))
                })?;
                self.check_taper(&along.section, end).map_err(inside(i))?;
            }
            if self.stress_free == StressFree::AsLaid && along.section.ei.largest() > 0.0 {
                let message = "a cable of several sections that resists bending is straight when free of stress: leave \
                               `stress_free` out, or make it several cables with welded ends";
                return Err(BuildError::at("stress_free", message));
            }
        }
        self.check_torsion_of_sections()?;
        if self.tension.is_some() {
            let message = "sections of different stiffness stretch differently: give `length`, or `to` of the last of them";
            return Err(BuildError::at("tension", message));
        }
        Ok(())
    }

    /// Checks that either all sections have torsion or none.
    fn check_torsion_of_sections(&self) -> Result<(), BuildError> {
        let ends =
            |along: &'_ SectionAlong| [Some(along.section.gj), along.end_section.as_ref().map(|e| e.gj)];
        let given = |along: &SectionAlong| ends(along).into_iter().flatten().any(|gj| gj.is_some());
        let lacks = |along: &SectionAlong| ends(along).into_iter().flatten().any(|gj| gj.is_none());
        if !self.sections.iter().any(given) {
            return Ok(());
        }
        if let Some(i) = self.sections.iter().position(lacks) {
            let message =
                "other sections of this cable have torsion: give this one a torsional stiffness, `gj`, too";
            return Err(BuildError::at(format!("sections[{i}].section"), message));
        }
        Ok(())
    }

    /// Checks one of several sections.
    fn check_one(&self, s: &Section) -> Result<(), BuildError> {
        s.check()?;
        self.check_laws(s)?;
        let Some(field) = s.asks_for_torsion() else { return Ok(()) };
        if s.gj.is_none() {
            let message = "this asks for torsion: give the section a torsional stiffness, `gj`";
            return Err(BuildError::at(field, message));
        }
        Ok(())
    }

    /// Checks that tables go with the rest of the cable.
    fn check_laws(&self, s: &Section) -> Result<(), BuildError> {
        let nonlinear = [
            ("axial_force", s.axial_force.is_some(), self.longitudinal == LongitudinalModel::L4, "L4"),
            ("tension_only", s.tension_only, self.longitudinal == LongitudinalModel::L4, "L4"),
            ("torque_tension", s.torque_tension != 0.0, self.longitudinal == LongitudinalModel::L4, "L4"),
            ("bending_moment", s.bending_moment.is_some(), self.transverse == TransverseModel::T3, "T3"),
        ];
        for (field, _, fits, needs) in nonlinear.into_iter().filter(|(_, is, ..)| *is) {
            if !fits {
                let message = format!(
                    "`{field}` goes with {needs}: other models measure something else than the table"
                );
                return Err(BuildError::at(field, message));
            }
            self.check_straight(field)?;
        }
        Ok(())
    }

    /// Checks that a section may change linearly into another.
    fn check_taper(&self, from: &Section, to: &Section) -> Result<(), BuildError> {
        let table = |s: &Section| s.axial_force.is_some() || s.bending_moment.is_some();
        let limp = |s: &Section| s.ei.largest() == 0.0;
        let wrong = [
            (
                table(from) || table(to),
                "EA and EI change linearly, and tables don't: give both ends `ea` and `ei`",
            ),
            (from.tension_only != to.tension_only, "`tension_only` is the same at both ends of a section"),
            (
                [from, to].iter().any(|s| s.asks_for_direction().is_some()),
                "what changes linearly along a section bends alike to all sides and doesn't couple torque with tension: leave \
                 `torque_tension` out and give one `ei`, or give several sections",
            ),
            (
                limp(from) != limp(to),
                "`ei` is 0 at one end only: give a small number there, or 0 at both ends",
            ),
            (
                self.longitudinal == LongitudinalModel::L1n,
                "L1n goes with the same section all along: take L4",
            ),
        ];
        match wrong.into_iter().find(|(is, _)| *is) {
            Some((_, message)) => Err(BuildError::at("end_section", message)),
            None => self.check_straight("end_section"),
        }
    }

    /// Checks that the cable is straight and unstretched when free of stress.
    fn check_straight(&self, field: &str) -> Result<(), BuildError> {
        if self.stress_free == StressFree::Straight && self.strain == 0.0 && self.curvature == 0.0 {
            return Ok(());
        }
        let message = format!(
            "with `{field}` a cable is straight and unstretched when free of stress: leave out `stress_free`, `strain` and \
             `curvature`"
        );
        Err(BuildError::at(field, message))
    }

    /// The length that several sections have together, where the last of them says so [m].
    pub(super) fn length_of_sections(&self) -> Result<Option<f64>, BuildError> {
        let (last, given) = (self.sections.last().and_then(|s| s.to), self.length);
        if let (Some(last), Some(given)) = (last, given)
            && (last - given).abs() > 1e-9 * given.abs()
        {
            let message = format!(
                "the last of the `sections` ends at {last} m, but `length` is {given} m: leave one of them out"
            );
            return Err(BuildError::at("length", message));
        }
        if let Some(last) = last {
            positive("to", last).map_err(inside(self.sections.len() - 1))?;
        }
        Ok(last.or(given))
    }

    /// Where each of several sections ends, in a cable of this length [m].
    pub(super) fn section_ends(&self, length: f64) -> Result<Vec<f64>, BuildError> {
        let count = self.sections.len();
        let mut ends = Vec::with_capacity(count);
        for (i, along) in self.sections.iter().enumerate() {
            let before = ends.last().copied().unwrap_or(0.0);
            let end = match along.to {
                None if i + 1 == count => length,
                None => {
                    let message =
                        "where does this section end? Give `to`; only the last section can do without";
                    return Err(BuildError::at(format!("sections[{i}].section"), message));
                }
                Some(to) => to,
            };
            let least = 1e-6 * length;
            if !(end > before + least && end <= length + least) || i + 1 < count && end > length - least {
                let message = format!(
                    "section {} would reach from {before} m to {end} m of a cable of {length} m: sections follow each other \
                     from its start to its end",
                    i + 1
                );
                return Err(BuildError::at(format!("sections[{i}].to"), message));
            }
            ends.push(if i + 1 == count { length } else { end });
        }
        Ok(ends)
    }

    /// The nodes of each section but its first, in a cable of sections with these ends.
    pub(super) fn nodes_of_sections(&self, ends: &[f64], pins: &[f64]) -> Result<Vec<Vec<f64>>, BuildError> {
        let length = ends[ends.len() - 1];
        let starts = || std::iter::once(0.0).chain(ends.iter().copied());
        let divides = |s: &SectionAlong| s.elements.is_some() || s.mesh.is_some();
        if !self.sections.iter().any(divides) {
            let mut pins = [pins, &ends[..ends.len() - 1]].concat();
            pins.sort_by(f64::total_cmp);
            let mesh = self.divided(length, &pins)?;
            let within = |(a, b): (f64, &f64)| {
                let near = 1e-9 * length;
                let mut own: Vec<f64> =
                    mesh.iter().copied().filter(|s| *s > a + near && *s < b - near).collect();
                own.push(*b);
                own
            };
            return Ok(starts().zip(ends).map(within).collect());
        }
        if self.elements > 0 || self.mesh.is_some() {
            let field = if self.elements > 0 { "elements" } else { "mesh" };
            let message =
                format!("its sections have elements of their own: leave `{field}` of the cable out");
            return Err(BuildError::at(field, message));
        }
        let own = |(i, (a, (along, &b))): (usize, (f64, (&SectionAlong, &f64)))| {
            let pins: Vec<f64> = pins.iter().filter(|s| **s > a && **s < b).map(|s| s - a).collect();
            let nodes = match (&along.mesh, along.elements) {
                (Some(_), Some(_)) => {
                    let message =
                        "give `elements` or `mesh`, not both: a mesh has its own number of elements";
                    Err(BuildError::at("mesh", message))
                }
                (Some(mesh), None) => mesh.nodes(b - a).map(|nodes| pinned(&nodes, &pins)),
                (None, Some(n)) => counted("elements", n).map(|n| even(b - a, n, &pins)),
                (None, None) => {
                    let message = "other sections of this cable have elements of their own: give this one `elements` or `mesh`";
                    Err(BuildError::at("section", message))
                }
            };
            let nodes = nodes.map_err(inside(i))?;
            let last = nodes.len() - 1;
            Ok(nodes.iter().enumerate().skip(1).map(|(k, s)| if k == last { b } else { a + s }).collect())
        };
        starts().zip(self.sections.iter().zip(ends)).enumerate().map(own).collect()
    }
}
