//! How the sections of a cable lie along it: what each element is made of, and where two sections are spliced.
//!
//! Neighbours of an ANCF cable share the slope `r'`, and with it the strain. Where the axial stiffness changes, equal strains
//! would be unequal tensions, so two sections that stretch differently have a node each, at the same arc length, and a
//! splice joins them: their points coincide and their tangents are parallel, the stretch of each is its own.

use super::elastic::{Bending, Elastic, Stretching};
use super::element::CableParams;
use super::mesh::{counted, even, pinned};
use super::model::{CableModel, LongitudinalModel, TransverseModel};
use super::section::{Section, SectionAlong};
use super::spec::{CableSpec, StressFree};
use ropewalk_core::error::positive;
use ropewalk_core::rotation::{around, cross};
use ropewalk_core::{
    BuildError, Equation, Jet, Joint, Marker, NodeId, Place, Related, Relation, RowKind, V3,
};
use ropewalk_scene::Builder;
use std::sync::Arc;

/// What an element is made of.
#[derive(Clone, Debug)]
struct Made {
    /// Its section: the mean of one that changes along it, with the largest slopes of tables for EA and EI.
    section: Section,
    /// How it stretches and bends, where that isn't told by EA and EI.
    elastic: Option<(Stretching, Bending)>,
}

impl Made {
    /// Of a section that is the same all along it.
    fn of(section: &Section) -> Result<Self, BuildError> {
        let mut made = Made { section: section.clone(), elastic: None };
        // what is left of EA where the rope can turn; the rest comes with its torsion
        made.section.ea -= section.gj.map_or(0.0, |gj| section.torque_tension.powi(2) / gj);
        let Section { axial_force, bending_moment, tension_only, .. } = section;
        let axial_force = axial_force.as_ref().map(|table| table.curve()).transpose()?;
        let bending_moment = bending_moment.as_ref().map(|table| table.curve()).transpose()?;
        if axial_force.is_none() && bending_moment.is_none() && !tension_only {
            return Ok(made);
        }
        let (mut ea, mut ei) = ([made.section.ea; 2], [section.ei.across; 2]);
        if let Some(curve) = &axial_force {
            (made.section.ea, ea) = (curve.stiffness(), [1.0; 2]);
        }
        if let Some(curve) = &bending_moment {
            (made.section.ei, ei) = (curve.stiffness().into(), [1.0; 2]);
        }
        let (axial_force, tension_only) = (axial_force.map(Arc::new), *tension_only);
        let stretching = Stretching { ends: ea, table: axial_force, tension_only };
        made.elastic = Some((stretching, Bending { ends: ei, table: bending_moment.map(Arc::new) }));
        Ok(made)
    }

    /// Of a section that changes linearly from one to another, between two places of the way from 0 to 1.
    fn between([a, b]: [&Section; 2], [from, to]: [f64; 2]) -> Self {
        let linear = |of: fn(&Section) -> f64| [from, to].map(|x| of(a) + x * (of(b) - of(a)));
        let (ea, ei) = (linear(|s| s.ea), linear(|s| s.ei.across));
        let section = Section {
            displaced: Some(mean(linear(Section::displaced_area))),
            tension_only: a.tension_only,
            mass: mean(linear(|s| s.mass)),
            flooded: mean(linear(|s| s.flooded)),
            diameter: mean(linear(|s| s.diameter)),
            axial_retardation_time: mean(linear(|s| s.axial_retardation_time)),
            bending_retardation_time: mean(linear(|s| s.bending_retardation_time)),
            torsional_retardation_time: mean(linear(|s| s.torsional_retardation_time)),
            gj: a.gj.and(b.gj).map(|_| as_one(linear(|s| s.gj.unwrap_or(0.0)))),
            rotary_inertia: a
                .rotary_inertia
                .and(b.rotary_inertia)
                .map(|_| mean(linear(|s| s.rotary_inertia.unwrap_or(0.0)))),
            gyroscopic: a.gyroscopic,
            ..Section::new(0.0, mean(ea), mean(ei))
        };
        let stretching = Stretching { ends: ea, table: None, tension_only: a.tension_only };
        let plain = ea[0] == ea[1] && ei[0] == ei[1] && !a.tension_only;
        Made { section, elastic: (!plain).then_some((stretching, Bending { ends: ei, table: None })) }
    }
}

fn mean([a, b]: [f64; 2]) -> f64 {
    0.5 * (a + b)
}

/// The stiffness of a bar as a whole that changes linearly along it: the logarithmic mean.
fn as_one([a, b]: [f64; 2]) -> f64 {
    let off = b / a - 1.0;
    // by its series where both are alike
    if off.abs() < 1e-4 { a * (1.0 + off / 2.0 - off * off / 12.0) } else { a * off / off.ln_1p() }
}

/// What the elements of a cable are made of.
#[derive(Clone, Debug)]
pub(crate) struct Layout {
    made: Vec<Made>,
    /// Which of these each element is; of the nothing between the two nodes of a splice, that of the element before.
    of: Vec<usize>,
    /// The first node of each section that isn't like the one before.
    starts: Vec<usize>,
    splices: Vec<Splice>,
}

/// Where two sections are joined that each have a node of their own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Splice {
    /// The node at the end of the section before; the next one is at the start of the section behind.
    pub node: usize,
    /// Whether the sections turn freely against each other, since one of them resists no bending.
    pub hinged: bool,
}

impl Layout {
    /// The same section all along.
    ///
    /// # Errors
    /// A table that is none.
    pub fn uniform(section: &Section, elements: usize) -> Result<Self, BuildError> {
        Ok(Layout {
            made: vec![Made::of(section)?],
            of: vec![0; elements],
            starts: Vec::new(),
            splices: Vec::new(),
        })
    }

    /// What element `k` is made of.
    pub fn section(&self, k: usize) -> &Section {
        &self.made[self.of[k]].section
    }

    /// EA and EI of element `k` as far as they tell how it stretches and bends; else 0.
    pub fn stiffness(&self, k: usize) -> [f64; 2] {
        let Made { section, elastic } = &self.made[self.of[k]];
        if elastic.is_some() { [0.0; 2] } else { [section.ea, section.ei.across] }
    }

    /// How element `k` of length `l` stretches and bends, where EA and EI don't tell it.
    pub fn elastic(&self, k: usize, l: f64, model: CableModel) -> Option<Elastic> {
        let Made { section, elastic } = &self.made[self.of[k]];
        let (stretching, bending) = elastic.clone()?;
        let params = CableParams { l, ea: section.ea, ei: section.ei.across, rho_a: 0.0 };
        Some(Elastic { params, stretching, bending, models: model.models().ok()? })
    }

    /// The force in element `k` at a place and strain, where that isn't `EA ε` [N].
    pub fn force(&self, k: usize, xi: f64, eps: f64) -> Option<f64> {
        Some(self.made[self.of[k]].elastic.as_ref()?.0.at(xi, eps)[1])
    }

    /// The bending moment of element `k` at a place and curvature, where that isn't `EI κ` [N m].
    pub fn moment(&self, k: usize, xi: f64, kappa: f64) -> Option<f64> {
        Some(self.made[self.of[k]].elastic.as_ref()?.1.moment(xi, kappa))
    }

    /// Whether another section begins at node `k`, or one ends there that is spliced.
    pub fn changes_at(&self, k: usize) -> bool {
        self.starts.contains(&k) || self.splices.iter().any(|s| s.node == k)
    }

    /// Whether it isn't the same all along.
    pub fn changes(&self) -> bool {
        self.made.len() > 1
    }

    /// Where the first section ends and where the last one begins, by nodes: the last node and the first of a cable that is
    /// the same all along.
    pub fn holds(&self) -> [usize; 2] {
        let all = || (1..self.of.len()).filter(|&k| self.changes_at(k));
        [all().next().unwrap_or(self.of.len()), all().next_back().unwrap_or(0)]
    }

    /// Fits it to another mesh of the same cable, whose ends have more elements or fewer than those of `old`.
    pub fn refit(&mut self, old: &[f64], new: &[f64]) {
        let [behind, _] = self.holds();
        // what doesn't feed stands where it stood, in numbers that are the same to the last bit
        let stands = |node: usize| new.iter().position(|&p| p == old[node]);
        let moved = if self.changes() { stands(behind).unwrap_or(behind) } else { behind };
        let mut of = vec![self.of[0]; moved];
        of.extend_from_slice(&self.of[behind..]);
        of.resize(new.len() - 1, *self.of.last().unwrap_or(&0));
        let shift = |node: usize| node + moved - behind;
        self.of = of;
        self.starts.iter_mut().for_each(|start| *start = shift(*start));
        self.splices.iter_mut().for_each(|splice| splice.node = shift(splice.node));
    }

    /// Where it is spliced.
    pub fn splices(&self) -> &[Splice] {
        &self.splices
    }

    /// Numbers of the elements: all but the nothing at splices.
    pub fn elements(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.of.len()).filter(|&k| !self.splices.iter().any(|s| s.node == k))
    }

    /// What there is at each place of the nodes: of both nodes of a splice at the first.
    pub fn once<T: Clone>(&self, nodes: &[T]) -> Vec<T> {
        let second = |k: usize| self.splices.iter().any(|s| s.node + 1 == k);
        nodes.iter().enumerate().filter(|(k, _)| !second(*k)).map(|(_, x)| x.clone()).collect()
    }

    /// Whether element `k` begins or ends where nothing holds its direction: at an end of the cable, or at a hinge.
    pub fn is_tip(&self, k: usize) -> bool {
        let hinge = |s: &Splice| s.hinged && (k + 1 == s.node || k == s.node + 1);
        k == 0 || k + 1 == self.of.len() || self.splices.iter().any(hinge)
    }

    /// The mean along a cable with these nodes of what its sections have.
    pub fn mean(&self, mesh: &[f64], of: impl Fn(&Section) -> f64) -> f64 {
        if let [only] = self.made.as_slice() {
            return of(&only.section);
        }
        let sum: f64 = self.elements().map(|k| (mesh[k + 1] - mesh[k]) * of(self.section(k))).sum();
        sum / (mesh[mesh.len() - 1] - mesh[0])
    }

    /// The largest of what its sections have.
    pub fn largest(&self, of: impl Fn(&Section) -> f64) -> f64 {
        self.made.iter().map(|made| of(&made.section)).fold(0.0, f64::max)
    }
}

/// The splice between two sections; none where they can share a node.
fn splice(a: &Section, along: &SectionAlong, node: usize) -> Option<Splice> {
    let b = &along.section;
    let limp = [a, b].map(|s| s.ei.largest() == 0.0 && s.bending_moment.is_none());
    // of ropes that turn when they are pulled, equal strains are equal tensions only if all of this is equal
    let laid = |s: &Section| (s.torque_tension, if s.torque_tension == 0.0 { None } else { s.gj });
    let stretches =
        |s: &Section| (s.ea, s.axial_force.clone(), s.tension_only, s.axial_retardation_time, laid(s));
    let alike = stretches(a) == stretches(b);
    if alike && limp[0] == limp[1] && !along.hinged {
        return None;
    }
    Some(Splice { node, hinged: limp[0] || limp[1] || along.hinged })
}

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
    fn section_ends(&self, length: f64) -> Result<Vec<f64>, BuildError> {
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

    /// The nodes of a cable of this length, with one at each of the pins, and what its elements are made of.
    pub(super) fn laid_out(&self, length: f64, pins: &[f64]) -> Result<(Vec<f64>, Layout), BuildError> {
        if self.sections.is_empty() {
            let mesh = self.divided(length, pins)?;
            let layout = Layout::uniform(&self.section, mesh.len() - 1)?;
            return Ok((mesh, layout));
        }
        let ends = self.section_ends(length)?;
        let nodes = self.nodes_of_sections(&ends, pins)?;
        let mut mesh = vec![0.0];
        let mut layout = Layout { made: Vec::new(), of: Vec::new(), starts: Vec::new(), splices: Vec::new() };
        let mut before: Option<&Section> = None;
        for (along, nodes) in self.sections.iter().zip(nodes) {
            let start = mesh[mesh.len() - 1];
            if let Some(splice) = before.and_then(|before| splice(before, along, mesh.len() - 1)) {
                layout.splices.push(splice);
                layout.of.push(layout.made.len() - 1);
                mesh.push(start);
            }
            if before.is_some_and(|before| *before != along.section) {
                layout.starts.push(mesh.len() - 1);
            }
            before = Some(along.end_section.as_ref().unwrap_or(&along.section));
            match &along.end_section {
                None => {
                    layout.made.push(Made::of(&along.section)?);
                    layout.of.extend(nodes.iter().map(|_| layout.made.len() - 1));
                }
                Some(end) => {
                    let way = |s: f64| (s - start) / (nodes[nodes.len() - 1] - start);
                    for (from, to) in std::iter::once(&start).chain(&nodes).zip(&nodes) {
                        layout.of.push(layout.made.len());
                        layout.made.push(Made::between([&along.section, end], [way(*from), way(*to)]));
                    }
                }
            }
            mesh.extend(nodes);
        }
        Ok((mesh, layout))
    }

    /// The nodes of each section but its first, in a cable of sections with these ends.
    fn nodes_of_sections(&self, ends: &[f64], pins: &[f64]) -> Result<Vec<Vec<f64>>, BuildError> {
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

impl Splice {
    /// Joins its two nodes, where tangents have this direction at the start.
    pub fn join(
        self,
        b: &mut Builder,
        name: String,
        nodes: &[NodeId],
        direction: V3<f64>,
        twists: bool,
    ) -> Result<(), BuildError> {
        let markers = [nodes[self.node], nodes[self.node + 1]].map(Marker::node);
        let mut equations = Equation::coincide();
        if self.hinged {
            return b.constraint(Joint::new(name, b.nodes(), markers, equations)?);
        }
        if twists {
            // both sections look the same way as they are laid
            equations.extend([(0, 1), (1, 2), (2, 0)].map(|(i, k)| Equation::normal(i, k)));
            return b.constraint(Joint::new(name, b.nodes(), markers, equations)?);
        }
        let [across, _, along] = around(direction);
        b.constraint(Related::new(name, Tangents { along, across }, markers.to_vec()))
    }
}

/// Two cables end at the same point with the same tangent, and each has its own stretch there.
///
/// The tangent of the second is normal to two vectors that are normal to the tangent `t` of the first: those which the
/// smallest rotation to `t` makes of two vectors across the first direction. No such pair is continuous for all directions;
/// where `t` has turned far from the first direction, the rotation begins at the opposite one.
#[derive(Clone, Copy, Debug)]
struct Tangents {
    /// The first direction, a unit vector, and one across it.
    along: V3<f64>,
    across: V3<f64>,
}

/// Cosine of the angle from which on the rotation begins at the opposite direction: no angle at which anything comes to rest.
const FAR: f64 = -0.4321;

impl Relation for Tangents {
    fn rows(&self) -> Vec<RowKind> {
        vec![RowKind::Position, RowKind::Position, RowKind::Position, RowKind::Direction, RowKind::Direction]
    }
    fn g<S: Jet>(&self, _t: S, at: &[Place<S>], g: &mut [S]) {
        for i in 0..3 {
            g[i] = at[1].x[i] - at[0].x[i];
        }
        let (p, q) = (at[0].axes[0], at[1].axes[0]);
        let size = (p[0] * p[0] + p[1] * p[1] + p[2] * p[2]).sqrt();
        let t = p.map(|p| p / size);
        let along = |e: &V3<f64>| t[0] * e[0] + t[1] * e[1] + t[2] * e[2];
        let from = if along(&self.along).re() > FAR { self.along } else { self.along.map(|x| -x) };
        let turn = along(&self.across) / (along(&from) + 1.0);
        let u: V3<S> = std::array::from_fn(|i| (t[i] + from[i]) * -turn + self.across[i]);
        let w = cross(&t, &u);
        g[3] = q[0] * u[0] + q[1] * u[1] + q[2] * u[2];
        g[4] = q[0] * w[0] + q[1] * w[1] + q[2] * w[2];
    }
}
