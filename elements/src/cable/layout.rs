//! How the sections of a cable lie along it: what each element is made of, and where two sections are spliced.

use super::elastic::{Bending, Elastic, Stretching};
use super::element::CableParams;
use super::model::CableModel;
use super::section::Section;
use super::spec::CableSpec;
use super::splice::{Splice, splice};
use ropewalk_core::BuildError;
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

impl CableSpec {
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
}
