//! Puts the elements of a flowing cable into a model.

use super::embedding::Embedding;
use super::line::Line;
use super::prestrain::{self, Place};
use super::{FlowAxialDamping, FlowCable, FlowDamping, FlowEnd, FlowStations, FlowWeight};
use crate::cable::layout::Layout;
use crate::cable::longitudinal::Longitudinal;
use crate::cable::model::{CableModel, LongitudinalModel, Models, WithModels, with_models};
use crate::cable::quadrature::Rule;
use crate::cable::section::Section;
use crate::cable::transverse::Transverse;
use crate::cable::{AxialDamping, BendingDamping, CableParams};
use ropewalk_core::{
    Assembly, At, BuildError, DeadLoad, Energy, Node, NodeId, Pattern, Pool, Power, Prestrain, StationPool,
    Stations, Term, V3,
};
use ropewalk_scene::Builder;
use std::sync::Arc;

/// Refuses what material can't flow through.
pub(crate) fn check(model: CableModel) -> Result<(), BuildError> {
    if model.longitudinal == LongitudinalModel::L1n {
        let message = "L1n has no strain energy that material could carry along: take L1, L2, L3 or L4 where a cable \
                       feeds";
        return Err(BuildError::at("longitudinal", message));
    }
    Ok(())
}

/// An element of a line and the nodes on which it stands.
pub(crate) struct Piece<'a> {
    /// The line.
    pub line: &'a Line,
    /// The node before the element.
    pub k: usize,
    /// The element's own nodes; those of the boundaries follow.
    pub on: [NodeId; 2],
}

impl Piece<'_> {
    fn nodes(&self) -> Vec<NodeId> {
        self.on.iter().copied().chain(self.line.boundaries.iter().map(|(_, f)| f.node)).collect()
    }
}

struct Push<'a, 'b> {
    b: &'a mut Builder,
    params: CableParams,
    section: &'a Section,
    piece: &'a Piece<'b>,
}

macro_rules! push {
    ($self:ident, $boundaries:literal, $models:ident) => {{
        let (line, k) = ($self.piece.line, $self.piece.k);
        let (nodes, by, s) = ($self.piece.nodes(), line.embedding::<$boundaries>(k), $self.section);
        let Models { longitudinal, rule, .. } = $models;
        $self.b.element(FlowCable::new($self.params, $models, by), &nodes)?;
        for (end, boundary) in line.opens(k) {
            $self.b.element(FlowEnd::new($self.params, $models, by, end, boundary), &nodes)?;
        }
        if s.axial_retardation_time > 0.0 {
            let eta_ea = s.axial_retardation_time * s.ea;
            // what bends in a layer that the element hardly resolves stretches between the points of its rule; elements that
            // are born and swallowed keep the other form, which is continuous over that
            let bends = s.ei.across > 0.0 && $models.points().len() > 1 && line.zone == [false; 2];
            if bends {
                $self.b.element(FlowAxialDamping::new(eta_ea, by, longitudinal, rule.axial()), &nodes)?;
            } else {
                let damping = AxialDamping::new($self.params.l, eta_ea, longitudinal, rule.axial());
                $self.b.element(FlowDamping { damping, by }, &nodes)?;
            }
        }
        if s.bending_retardation_time > 0.0 && s.ei.across > 0.0 {
            let damping = BendingDamping::new($self.params.l, s.bending_retardation_time * s.ei.across, rule.bending());
            $self.b.element(FlowDamping { damping, by }, &nodes)?;
        }
        Ok(())
    }};
}

impl WithModels for Push<'_, '_> {
    type Output = Result<(), BuildError>;
    fn go<L: Longitudinal, T: Transverse, Q: Rule>(self, models: Models<L, T, Q>) -> Self::Output {
        if self.piece.line.boundaries.len() == 1 { push!(self, 1, models) } else { push!(self, 2, models) }
    }
}

/// Pushes elasticity, inertia and damping of an element through which material flows.
pub(crate) fn push(
    b: &mut Builder,
    model: CableModel,
    params: CableParams,
    section: &Section,
    piece: &Piece<'_>,
) -> Result<(), BuildError> {
    with_models(model, Push { b, params, section, piece }).map_err(BuildError::new)?
}

/// Adds the strain of an element that fades out.
pub(crate) fn fading(
    b: &mut Builder,
    model: CableModel,
    strain: &Prestrain,
    section: &Section,
    name: &str,
    piece: &Piece<'_>,
) -> Result<(), BuildError> {
    let (line, k) = (piece.line, piece.k);
    let nodes: Vec<Node> = piece.nodes().iter().map(|n| b.nodes()[n.0 as usize]).collect();
    let mut by = Embedding { fixed: [line.nodes[k].fixed, line.nodes[k + 1].fixed], by: [[0.0; 2]; 2] };
    for f in 0..line.boundaries.len() {
        by.by[f] = [line.nodes[k].by[f], line.nodes[k + 1].by[f]];
    }
    let place = Place {
        label: format!("{name}: prestrain"),
        ea: section.ea,
        // of nodes with torsion, those of the curve
        q: nodes.iter().flat_map(|node| node.coords().take(6)).collect(),
        v: nodes.iter().flat_map(|node| node.dofs().take(6)).collect(),
        by,
        end: line.opens(k).next(),
    };
    b.term(prestrain::fading(model, strain.clone(), place).map_err(BuildError::new)?);
    Ok(())
}

/// The stations of all elements of a line, which follow the curve or the material.
pub(crate) fn stations(
    all: &[Node],
    line: &Line,
    nodes: &[NodeId],
    layout: &Layout,
    of_material: bool,
) -> Result<Arc<dyn Stations>, BuildError> {
    macro_rules! stations {
        ($boundaries:literal, $size:literal) => {{
            let mut pool = StationPool::<FlowStations<$boundaries>, $size, $size, 4>::new();
            for k in layout.elements() {
                let (section, by, slip) = (layout.section(k), line.embedding(k), line.slip(k));
                let slip = if of_material { [0.0; $boundaries] } else { slip };
                let (diameter, area) = (section.diameter, section.displaced_area());
                let piece = Piece { line, k, on: [nodes[k], nodes[k + 1]] };
                if !pool.push(all, FlowStations { by, slip, diameter, area }, &piece.nodes()) {
                    return Err(BuildError::new("the stations of the cable don't fit its nodes"));
                }
            }
            Ok(Arc::new(pool))
        }};
    }
    if line.boundaries.len() == 1 { stations!(1, 13) } else { stations!(2, 14) }
}

/// Weight or buoyancy of a cable of which some elements only are at rest on their material.
pub(crate) struct Weight {
    /// Of those that are, worked out once.
    pub dead: DeadLoad,
    /// Of those that material flows through.
    pub flowing: Box<dyn Term>,
}

impl Term for Weight {
    fn label(&self) -> String {
        self.dead.label()
    }
    fn pattern(&self, p: &mut Pattern) {
        self.flowing.pattern(p);
    }
    fn symmetric(&self) -> bool {
        false
    }
    fn is_load(&self) -> bool {
        true
    }
    fn add(&self, at: &At<'_>, out: &mut Assembly<'_>) {
        self.dead.add(at, out);
        self.flowing.add(at, out);
    }
    fn energy(&self, at: &At<'_>) -> Energy {
        let mut energy = self.dead.energy(at);
        energy += self.flowing.energy(at);
        energy
    }
    fn power(&self, at: &At<'_>) -> Power {
        self.flowing.power(at)
    }
}

/// The weight of the elements of a line through which material flows, `load` being the force per length of each [N/m].
pub(crate) fn weight(
    all: &[Node],
    line: &Line,
    nodes: &[NodeId],
    load: impl Fn(usize) -> V3<f64>,
) -> Option<Box<dyn Term>> {
    macro_rules! weight {
        ($boundaries:literal, $size:literal) => {{
            let mut pool = Pool::<FlowWeight<$boundaries>, $size, $size>::new();
            for k in (0..nodes.len() - 1).filter(|&k| line.flows(k)) {
                let piece = Piece { line, k, on: [nodes[k], nodes[k + 1]] };
                if !pool.push(all, FlowWeight { load: load(k), by: line.embedding(k) }, &piece.nodes()) {
                    return None;
                }
            }
            Some(Box::new(pool))
        }};
    }
    if line.boundaries.len() == 1 { weight!(1, 13) } else { weight!(2, 14) }
}
