//! A cable with torsion: how its sections are laid, what is added to its elements, and what can be observed of it.

use super::directed::{Directed, DirectedParams, curvature};
use super::flow::{FlowDirected, FlowSpin, FlowTorqueTension, FlowTorsion, Line};
use super::layout::Layout;
use super::quadrature::{MOST, Point, Points, Quadrature, Rule};
use super::rest::STRAIGHT;
use super::section::Section;
use super::section_damping::SectionDamping;
use super::shape::{combine, natural, second};
use super::spin::SpinInertia;
use super::torque_tension::TorqueTension;
use super::torsion::{Torsion, TorsionDamping, TorsionParams};
use super::{BendingStiffness, CableSpec, Integration, StressFree, TransverseModel};
use ropewalk_core::error::{finite, positive};
use ropewalk_core::model::twist::{FOLDS, across, carried, folds, laid, section};
use ropewalk_core::rotation::{IDENTITY, around, cross};
use ropewalk_core::{At, BuildError, Element, Local, NodeId, NodeKind, Share, V3, Weights, dot};
use ropewalk_scene::{Builder, Torsional};

/// A node with torsion as it is laid.
type Laid = [f64; 10];

/// The torsion of a cable.
pub(crate) struct Twisted {
    /// What each element is made of.
    bars: Vec<Bar>,
    integration: Integration,
    /// Twist of each element when free of stress [rad].
    twist0: Vec<f64>,
    /// Where the strain of a laid rope is taken, and its mean in each element when free of stress.
    points: &'static [Point],
    strain0: Vec<f64>,
    /// The nodes without twist, in whose shape the cable is free of stress if `as_laid`.
    straight: Vec<Laid>,
    as_laid: bool,
    /// Stress-free curvature about the first director on top of that [1/m].
    curvature: f64,
    /// How material flows through it, if an end feeds, and its twist per length when free of stress then [rad/m].
    flow: Option<Line>,
    per_length: f64,
    /// The bubble of each element whose bending has a direction: node, coordinate and velocity.
    bubbles: Vec<Option<(NodeId, usize, usize)>>,
    /// What the bubbles begin with, element by element, and their rates; empty: at rest.
    pub(super) inner: Vec<[f64; 2]>,
}

/// What an element with torsion is made of.
#[derive(Clone, Copy)]
struct Bar {
    /// Torsional stiffness [N m²], its damping [N m² s], polar moment of inertia per length [kg m].
    gj: f64,
    eta_gj: f64,
    rho_j: f64,
    gyroscopic: bool,
    ei: BendingStiffness,
    /// Its damping about both directors, `η EI` [N m² s].
    eta_ei: [f64; 2],
    /// Torque and tension of a laid rope: `C/GJ` [1/m].
    lay: f64,
    /// Whether bending has a direction.
    directed: bool,
}

impl Bar {
    /// Of a section; `field` is where the scene has it.
    fn of(s: &Section, field: &str) -> Result<Self, BuildError> {
        let gj = positive("gj", s.gj.unwrap_or(s.ei.mean()))
            .map_err(|e| BuildError::at(format!("{field}.gj"), e.message))?;
        let rho_j = rotary_inertia(s).map_err(|e| e.of(format!("{field}.rotary_inertia")))?;
        let eta_gj = s.torsional_retardation_time * gj;
        let (lay, directed) = (s.torque_tension / gj, s.ei.has_direction());
        let eta_ei = [s.ei.about_normal, s.ei.across].map(|ei| s.bending_retardation_time * ei);
        Ok(Bar { gj, eta_gj, rho_j, gyroscopic: s.gyroscopic, ei: s.ei, eta_ei, lay, directed })
    }
    /// Whether its bending is damped.
    fn damps_bending(&self) -> bool {
        self.eta_ei.iter().any(|eta| *eta > 0.0)
    }
}

/// The torsion of a cable of this section that runs over wheels, if it has any; `free` is its twist per length when free of
/// stress [rad/m].
pub(super) fn torsional(s: &Section, free: f64) -> Result<Option<Torsional>, BuildError> {
    if s.gj.is_none() {
        return Ok(None);
    }
    let Bar { gj, eta_gj, rho_j, .. } = Bar::of(s, "section")?;
    Ok(Some(Torsional { gj, damping: eta_gj, inertia: rho_j, free, lay: s.torque_tension }))
}

/// Polar moment of inertia per length [kg m]: that of a round bar, of the diameter of the cable or of the one that its
/// stiffnesses have.
fn rotary_inertia(s: &Section) -> Result<f64, BuildError> {
    let mass = s.mass + s.flooded;
    let round = match (s.rotary_inertia, s.diameter > 0.0) {
        (Some(given), _) => given,
        (None, true) => mass * s.diameter * s.diameter / 8.0,
        (None, false) => 2.0 * mass * s.ei.mean() / s.ea,
    };
    positive("rotary_inertia", round).map_err(|_| {
        let message = "a cable with torsion needs an inertia about its axis: give `rotary_inertia` [kg m], which must be \
                       positive, or a `diameter`, of which a round bar has mass × diameter² / 8";
        BuildError::at("rotary_inertia", message)
    })
}

/// The nodes of an element as it is laid, with its bubble.
fn element(nodes: &[Laid], k: usize) -> [f64; 21] {
    std::array::from_fn(|i| match i {
        0..10 => nodes[k][i],
        10..20 => nodes[k + 1][i - 10],
        _ => 0.0,
    })
}

fn pair(x: &[f64; 21]) -> [f64; 20] {
    std::array::from_fn(|i| x[i])
}

fn unit(x: &V3<f64>) -> V3<f64> {
    let size = dot(x, x).sqrt();
    x.map(|x| x / size)
}

/// The normal of the plane in which a cable that is laid like this bends most, and the element where it does; `None` where
/// it is straight.
fn most_bent(shapes: &[(usize, [f64; 12])], mesh: &[f64]) -> Option<(V3<f64>, usize)> {
    let mut most = (STRAIGHT, None);
    for &(k, ref shape) in shapes {
        let l = mesh[k + 1] - mesh[k];
        let nat = natural(shape, 1.0 / l);
        for xi in [0.0, 0.5, 1.0] {
            let at = Point::new(xi, 1.0);
            let turn = cross(&combine(&at.phi, &nat), &second(&at.psi, 1.0 / l, &nat));
            let size = dot(&turn, &turn).sqrt() * l;
            if size > most.0 {
                most = (size, Some((turn, k)));
            }
        }
    }
    most.1
}

/// Directors at the nodes of a cable, carried from node to node, from one that looks like `normal` at node `k`.
fn directors(tangents: &[V3<f64>], normal: &V3<f64>, k: usize) -> Vec<V3<f64>> {
    let mut all = vec![[0.0; 3]; tangents.len()];
    all[k] = across(normal, &tangents[k]);
    for i in k + 1..all.len() {
        all[i] = across(&carried(&all[i - 1], &tangents[i - 1], &tangents[i]), &tangents[i]);
    }
    for i in (0..k).rev() {
        all[i] = across(&carried(&all[i + 1], &tangents[i + 1], &tangents[i]), &tangents[i]);
    }
    all
}

/// Angles of the nodes at which elements between them have no twist: from node to node directors are carried along great
/// circles, while the tangent of the cable takes another way.
fn untwisting(nodes: &[Laid], mesh: &[f64], elements: &[usize], from: usize) -> Vec<f64> {
    let mut angles = vec![0.0; nodes.len()];
    for k in 0..nodes.len() - 1 {
        // between the two nodes of a splice there is nothing
        let is = elements.binary_search(&k).is_ok();
        let own = || Torsion::twist(&pair(&element(nodes, k)), mesh[k + 1] - mesh[k]);
        angles[k + 1] = angles[k] - if is { own() } else { 0.0 };
    }
    let there = angles[from];
    angles.iter().map(|a| a - there).collect()
}

impl CableSpec {
    /// The torsion of the cable, if it has any, and its nodes as they are laid: with these places and slopes.
    pub(super) fn twisted(
        &self,
        mesh: &[f64],
        places: &[[f64; 6]],
        layout: &Layout,
        length: f64,
        feeds: bool,
    ) -> Result<Option<(Twisted, Vec<Laid>)>, BuildError> {
        let s = &self.section;
        let elements: Vec<usize> = layout.elements().collect();
        let shape = |k: usize| -> [f64; 12] {
            std::array::from_fn(|i| if i < 6 { places[k][i] } else { places[k + 1][i - 6] })
        };
        let shapes: Vec<(usize, [f64; 12])> = elements.iter().map(|&k| (k, shape(k))).collect();
        let bent = most_bent(&shapes, mesh);
        let as_laid = self.stress_free == StressFree::AsLaid;
        let springy = as_laid && s.ei.largest() > 0.0 && bent.is_some();
        let sections = self.sections.iter().any(|along| along.section.gj.is_some());
        if s.gj.is_none() && !sections && !springy {
            self.refuse_twist()?;
            return Ok(None);
        }
        let bar = |k: usize| {
            let own = if sections { Bar::of(layout.section(k), "sections") } else { Bar::of(s, "section") };
            own.map(|bar| Bar { directed: bar.directed || springy || self.curvature != 0.0, ..bar })
        };
        let bars = (0..mesh.len() - 1).map(bar).collect::<Result<Vec<_>, _>>()?;
        let tangents: Vec<V3<f64>> = places.iter().map(|x| unit(&[x[3], x[4], x[5]])).collect();
        let (normal, from) = self.first_director(&tangents, bent)?;
        let u = directors(&tangents, &normal, from);
        let node = |k: usize, theta: f64| {
            let x = &places[k];
            laid(&[x[0], x[1], x[2]], &[x[3], x[4], x[5]], &u[k], theta)
        };
        let bare: Vec<Laid> = (0..mesh.len()).map(|k| node(k, 0.0)).collect();
        if elements.iter().any(|&k| folds([&bare[k], &bare[k + 1]])) {
            return Err(BuildError::at("elements", FOLDS));
        }
        // a cable that has fed since it was laid has the turns that it was laid with at its ends
        let there = |k: usize| match mesh.len() - 1 {
            last if feeds => length * (mesh[k] - mesh[0]) / (mesh[last] - mesh[0]),
            _ => mesh[k],
        };
        let untwist = untwisting(&bare, mesh, &elements, from);
        let straight: Vec<Laid> = (0..mesh.len()).map(|k| node(k, untwist[k])).collect();
        let nodes = (0..mesh.len()).map(|k| node(k, untwist[k] + self.laid_twist * there(k))).collect();
        let twist0 = |k: usize| {
            let l = mesh[k + 1] - mesh[k];
            let own = if as_laid && l > 0.0 { Torsion::twist(&pair(&element(&straight, k)), l) } else { 0.0 };
            own + self.twist * l
        };
        let points = self.integration.axial().points();
        let strain0 = |k: usize| {
            let l = mesh[k + 1] - mesh[k];
            let own = || TorqueTension::mean_strain(&pair(&element(&straight, k)), l, points);
            self.strain + if as_laid && l > 0.0 { own() } else { 0.0 }
        };
        let twisted = Twisted {
            points,
            strain0: (0..mesh.len() - 1).map(strain0).collect(),
            bars,
            integration: self.integration,
            twist0: (0..mesh.len() - 1).map(twist0).collect(),
            straight,
            as_laid,
            curvature: self.curvature,
            flow: None,
            per_length: self.twist,
            bubbles: Vec::new(),
            inner: Vec::new(),
        };
        let directed = |bar: &Bar| bar.directed;
        if twisted.bars.iter().any(directed) && self.transverse != TransverseModel::T3 {
            let message = format!(
                "the curvature of {:?} has no direction: a cable that is bent when free of stress, or that has two bending \
                 stiffnesses, needs T3",
                self.transverse
            );
            return Err(BuildError::at("transverse", message));
        }
        if twisted.bars.iter().any(|bar| bar.directed && bar.lay != 0.0) {
            let message = "a cable whose bending has a direction can't couple torque and tension: leave `torque_tension` out, or \
                           let it be straight when free of stress, with one `ei`";
            let field = if sections { "sections" } else { "section.torque_tension" };
            return Err(BuildError::at(field, message));
        }
        Ok(Some((twisted, nodes)))
    }

    /// Refuses what only a cable with torsion can have.
    fn refuse_twist(&self) -> Result<(), BuildError> {
        let own = [
            ("normal", self.normal.is_some()),
            ("twist", self.twist != 0.0),
            ("laid_twist", self.laid_twist != 0.0),
        ];
        let own = own.into_iter().find(|(_, asked)| *asked).map(|(field, _)| field.to_string());
        let asked = self.section.asks_for_torsion().map(|field| format!("section.{field}"));
        let Some(field) = asked.or(own) else { return Ok(()) };
        let what = if field == "section.ei" { "two bending stiffnesses" } else { "this" };
        Err(BuildError::at(
            field,
            format!(
                "a cable without torsion can't have {what}: give its section a torsional stiffness, `gj`"
            ),
        ))
    }

    /// The direction that the first director of the section has, and the node where.
    fn first_director(
        &self,
        tangents: &[V3<f64>],
        bent: Option<(V3<f64>, usize)>,
    ) -> Result<(V3<f64>, usize), BuildError> {
        let Some(normal) = self.normal else {
            if let Some(bent) = bent {
                return Ok(bent);
            }
            let directed = |s: &Section| s.ei.has_direction();
            let any = directed(&self.section) || self.sections.iter().any(|along| directed(&along.section));
            if any || self.curvature != 0.0 {
                let message = "which way does the section look? Give the direction in space, at the start of the cable, of \
                               the axis that the first of both bending stiffnesses is about";
                return Err(BuildError::at("normal", message));
            }
            return Ok((around(tangents[0])[0], 0));
        };
        finite("normal", &normal)?;
        let t = &tangents[0];
        let (along, size) = (dot(&normal, t), dot(&normal, &normal).sqrt());
        if !((size * size - along * along).max(0.0).sqrt() > 1e-3 * size) {
            let message =
                "the normal of a section must not lie along the cable: give one at right angles to it";
            return Err(BuildError::at("normal", message));
        }
        Ok((normal, 0))
    }
}

impl Twisted {
    /// Adds torsion, and bending with a direction, to a cable with these nodes.
    pub(super) fn push(
        &mut self,
        b: &mut Builder,
        mesh: &[f64],
        nodes: &[NodeId],
        layout: &Layout,
        line: Option<&Line>,
    ) -> Result<(), BuildError> {
        self.flow = line.cloned();
        let flows = |k: usize| line.filter(|line| line.flows(k));
        for k in layout.elements() {
            if let Some(line) = flows(k) {
                let boundaries = line.boundaries.iter().map(|(_, boundary)| boundary.node);
                let on: Vec<NodeId> = [nodes[k], nodes[k + 1]].into_iter().chain(boundaries).collect();
                let one = line.boundaries.len() == 1;
                if one {
                    b.element(self.flowing::<1>(k, line), &on)?;
                } else {
                    b.element(self.flowing::<2>(k, line), &on)?;
                }
                match (self.bars[k].lay != 0.0, one) {
                    (true, true) => b.element(self.flowing_coupled::<1>(k, line), &on)?,
                    (true, false) => b.element(self.flowing_coupled::<2>(k, line), &on)?,
                    _ => {}
                }
                let rho_j = self.bars[k].rho_j;
                match (self.bars[k].gyroscopic, one) {
                    (true, true) => {
                        let (by, turns) = (line.embedding(k), line.turns(k));
                        b.element(FlowSpin::<1> { rho_j, by, turns }, &on)?;
                    }
                    (true, false) => {
                        let (by, turns) = (line.embedding(k), line.turns(k));
                        b.element(FlowSpin::<2> { rho_j, by, turns }, &on)?;
                    }
                    _ => {}
                }
                continue;
            }
            let Bar { eta_gj, rho_j, gyroscopic, .. } = self.bars[k];
            let on = [nodes[k], nodes[k + 1]];
            let l = mesh[k + 1] - mesh[k];
            match self.coupled(k, l) {
                Some(coupled) => b.element(coupled, &on)?,
                None => b.element(Torsion::new(self.params(k, l)), &on)?,
            }
            if eta_gj > 0.0 {
                b.element(TorsionDamping { l, eta_gj }, &on)?;
            }
            if gyroscopic {
                b.element(SpinInertia { l, rho_j }, &on)?;
            }
            if !self.bars[k].directed && self.bars[k].damps_bending() {
                b.element::<_, 20, 14>(self.damping(k, l), &on)?;
            }
        }
        self.bubbles = vec![None; mesh.len() - 1];
        for k in layout.elements().filter(|&k| self.bars[k].directed) {
            let [q, v] = self.inner.get(k).copied().unwrap_or_default();
            let bubble = b.node(NodeKind::Scalars(1), &[q], &[v])?;
            let own = b.nodes()[bubble.0 as usize];
            self.bubbles[k] = Some((bubble, own.q, own.v));
            let on = [nodes[k], nodes[k + 1], bubble];
            let Some(line) = flows(k) else {
                let l = mesh[k + 1] - mesh[k];
                b.element(self.bending(k, l), &on)?;
                if self.bars[k].damps_bending() {
                    b.element::<_, 21, 15>(self.damping(k, l), &on)?;
                }
                continue;
            };
            let boundaries = line.boundaries.iter().map(|(_, boundary)| boundary.node);
            let on: Vec<NodeId> = on.into_iter().chain(boundaries).collect();
            match line.boundaries.len() {
                1 => b.element(self.flowing_directed::<1>(k, line), &on)?,
                _ => b.element(self.flowing_directed::<2>(k, line), &on)?,
            }
        }
        Ok(())
    }

    /// The damping of its bending.
    fn damping(&self, k: usize, l: f64) -> SectionDamping {
        SectionDamping::new(l, self.bars[k].eta_ei, self.integration.bending())
    }

    fn params(&self, k: usize, l: f64) -> TorsionParams {
        TorsionParams { l, gj: self.bars[k].gj, rho_j: self.bars[k].rho_j, twist0: self.free(k, l) }
    }

    /// Element `k`, through which material flows.
    fn flowing<const F: usize>(&self, k: usize, line: &Line) -> FlowTorsion<F> {
        let Bar { gj, eta_gj, rho_j, .. } = self.bars[k];
        FlowTorsion {
            gj,
            eta_gj,
            rho_j,
            twist0: self.per_length,
            by: line.embedding(k),
            turns: line.turns(k),
            wound: line.winds(k),
            grip: line.grips(k),
        }
    }

    /// What gives its bending a direction.
    fn flowing_directed<const F: usize>(&self, k: usize, line: &Line) -> FlowDirected<F> {
        let Bar { gj, eta_gj, rho_j, ei, .. } = self.bars[k];
        FlowDirected {
            more: ei.about_normal - ei.across,
            gj,
            eta_gj,
            rho_j,
            by: line.embedding(k),
            turns: line.turns(k),
            open: line.open(k),
            rule: Points::of(self.integration.bending()),
        }
    }

    /// What couples its torque and its tension.
    fn flowing_coupled<const F: usize>(&self, k: usize, line: &Line) -> FlowTorqueTension<F> {
        FlowTorqueTension {
            gj: self.bars[k].gj,
            lay: self.bars[k].lay,
            twist0: self.per_length,
            by: line.embedding(k),
            turns: line.turns(k),
            open: line.open(k),
            points: self.points,
        }
    }

    /// Twist of element `k` of length `l` when free of stress [rad].
    fn free(&self, k: usize, l: f64) -> f64 {
        if self.flow.is_some() { self.per_length * l } else { self.twist0[k] }
    }

    /// What element `k` is twisted by that came in with the material [rad].
    fn turned(&self, k: usize, q: &[f64]) -> f64 {
        self.flow.as_ref().map_or(0.0, |line| line.turned(k, q))
    }

    /// The coordinates of element `k` as the material is turned at its nodes.
    fn turned_both(&self, k: usize, mut x: [f64; 21], q: &[f64]) -> [f64; 21] {
        let turned = self.flow.as_ref().map_or([0.0; 2], |line| line.turned_both(k, q));
        x[9] += turned[0];
        x[19] += turned[1];
        x
    }

    /// Element `k` of a rope that turns when it is pulled.
    fn coupled(&self, k: usize, l: f64) -> Option<TorqueTension> {
        let (lay, points) = (self.bars[k].lay, self.points);
        let params = self.params(k, l);
        (lay != 0.0).then(|| TorqueTension { params, lay, strain0: self.strain0[k], points })
    }

    fn bending(&self, k: usize, l: f64) -> Directed {
        let (rule, mut kappa0) = (self.integration.bending(), [[0.0; 2]; MOST]);
        if self.as_laid {
            kappa0 = Directed::curvature(&element(&self.straight, k), l, rule);
        }
        kappa0.iter_mut().take(rule.points().len()).for_each(|k| k[0] += self.curvature);
        let Bar { gj, eta_gj, rho_j, ei, .. } = self.bars[k];
        let params = DirectedParams { l, ei_d: ei.about_normal, ei_e: ei.across, gj, eta_gj, rho_j };
        Directed::new(params, kappa0, rule)
    }

    /// The coordinates (or velocities) of an element with its bubble: 10 (or 7) of each node.
    fn gather<const N: usize>(&self, k: usize, x: &[f64], seats: [usize; 2], rates: bool) -> [f64; N] {
        let half = N / 2;
        let bubble = self.bubbles.get(k).copied().flatten().map(|(_, q, v)| x[if rates { v } else { q }]);
        std::array::from_fn(|i| match i {
            i if i < half => x[seats[0] + i],
            i if i < 2 * half => x[seats[1] + i - half],
            _ => bubble.unwrap_or(0.0),
        })
    }

    /// What twist and bending with a direction add to the force that element `k` transmits [N].
    pub(super) fn transmits(&self, k: usize, l: f64, q: &[f64], seats: [usize; 2]) -> V3<f64> {
        let w = Weights { q: 0.0, v: 0.0, a: 0.0 };
        let x: [f64; 21] = self.gather(k, q, seats, false);
        let mut twist = Share::<f64, 14>::zero();
        let local = Local { q: pair(&x), v: [0.0; 14], a: [0.0; 14], last: [0.0; 14], relaxed: None };
        match self.coupled(k, l) {
            Some(mut own) => {
                own.params.twist0 -= self.turned(k, q);
                let lanes =
                    TorqueTension::lanes::<f64>(&ropewalk_core::Batch::of(std::slice::from_ref(&own)));
                TorqueTension::add::<f64, false>(&lanes, &local, &w, &mut twist);
            }
            None => {
                let mut params = self.params(k, l);
                params.twist0 -= self.turned(k, q);
                Torsion::add::<f64, false>(&params, &local, &w, &mut twist);
            }
        }
        let mut bent = Share::<f64, 15>::zero();
        if self.bars[k].directed {
            let q = self.turned_both(k, x, q);
            let local = Local { q, v: [0.0; 15], a: [0.0; 15], last: [0.0; 15], relaxed: None };
            let own = self.bending(k, l);
            let lanes = Directed::lanes::<f64>(&ropewalk_core::Batch::of(std::slice::from_ref(&own)));
            Directed::add::<f64, false>(&lanes, &local, &w, &mut bent);
        }
        std::array::from_fn(|i| twist.r[7 + i] + bent.r[7 + i])
    }

    /// Twist of element `k` per length [rad/m], and the moment that it transmits [N m].
    pub(super) fn twist(&self, k: usize, l: f64, q: &[f64], seats: [usize; 2]) -> [f64; 2] {
        let x = pair(&self.gather(k, q, seats, false));
        let twist = Torsion::twist(&x, l) + self.turned(k, q);
        let pulled = match self.coupled(k, l) {
            Some(own) => own.lay * l * (TorqueTension::mean_strain(&x, l, own.points) - own.strain0),
            None => 0.0,
        };
        [twist / l, self.bars[k].gj * (twist + pulled - self.free(k, l)) / l]
    }

    /// Curvature about both directors at a point of element `k` [1/m], and the moments [N m].
    pub(super) fn bends(&self, k: usize, l: f64, xi: f64, q: &[f64], seats: [usize; 2]) -> [[f64; 2]; 2] {
        let at = Point::new(xi, 1.0);
        let now = curvature(&self.turned_both(k, self.gather(k, q, seats, false), q), l, &at);
        let mut then = if self.as_laid { curvature(&element(&self.straight, k), l, &at) } else { [0.0; 2] };
        then[0] += self.curvature;
        let ei = [self.bars[k].ei.about_normal, self.bars[k].ei.across];
        [now, std::array::from_fn(|i| ei[i] * (now[i] - then[i]))]
    }

    /// Whether the bending of element `k` has a direction.
    pub(super) fn is_directed(&self, k: usize) -> bool {
        self.bars[k].directed
    }

    /// The bubble of element `k` and its rate; zero where it has none.
    pub(super) fn within(&self, k: usize, at: &At<'_>) -> [f64; 2] {
        let bubble = self.bubbles.get(k).copied().flatten();
        bubble.map_or([0.0; 2], |(_, q, v)| [at.q[q], at.v[v]])
    }

    /// The element that a node is the bubble of.
    pub(super) fn bubble(&self, node: NodeId) -> Option<usize> {
        self.bubbles.iter().position(|b| b.is_some_and(|b| b.0 == node))
    }

    /// First director of the section at a place of element `k` with this tangent, and the angle that it has been turned by
    /// relative to the start of the cable [rad], where that of the element's start is `before`.
    pub(super) fn looks(
        &self,
        k: usize,
        [l, xi]: [f64; 2],
        tangent: &V3<f64>,
        q: &[f64],
        seats: [usize; 2],
    ) -> (V3<f64>, f64) {
        let [rate, _] = self.twist(k, l, q, seats);
        let start = &q[seats[0]..seats[0] + 10];
        let s = section(start);
        let (d, t) = ([s[0][0], s[1][0], s[2][0]], [s[0][2], s[1][2], s[2][2]]);
        let (here, turn) = (unit(tangent), rate * l * xi);
        let own = across(&carried(&d, &t, &here), &here);
        let (beside, (sin, cos)) = (cross(&here, &own), turn.sin_cos());
        (std::array::from_fn(|i| cos * own[i] + sin * beside[i]), turn)
    }
}

/// Lays the sections of a cable along other tangents: each director rides with the tangent of its node, and the twist of each
/// element stays as far as the way allows.
pub(super) fn follow(q: &mut [f64], seats: &[usize], before: &[V3<f64>]) {
    for (&at, old) in seats.iter().zip(before) {
        let t = unit(&[q[at + 3], q[at + 4], q[at + 5]]);
        let u = [q[at + 6], q[at + 7], q[at + 8]];
        // a tangent that is turned round has no way to go by
        let u = if dot(old, &t) > -0.99 { carried(&u, old, &t) } else { u };
        let along = dot(&u, &t).abs();
        let u = if along < 0.9 {
            u
        } else {
            *IDENTITY
                .iter()
                .min_by(|a, b| dot(a, &t).abs().total_cmp(&dot(b, &t).abs()))
                .unwrap_or(&IDENTITY[0])
        };
        q[at + 6..at + 9].copy_from_slice(&across(&u, &t));
    }
}

/// The reference director and angle of a node where a section with director `d` has been turned by `angle` from that of the
/// node before, or of the first node: the angle counts turns that directors don't see.
pub(super) fn node_at(r: &V3<f64>, slope: &V3<f64>, d: &V3<f64>, angle: f64) -> Laid {
    let t = unit(slope);
    let own = across(d, &t);
    // u such that d is u turned by the angle
    let (beside, (sin, cos)) = (cross(&t, &own), angle.sin_cos());
    let u: V3<f64> = std::array::from_fn(|i| cos * own[i] - sin * beside[i]);
    laid(r, slope, &u, angle)
}

/// Velocity of an element's section about its tangent at a place [rad/s].
pub(super) fn spin(at: &At<'_>, seats: [usize; 2], xi: f64) -> f64 {
    (1.0 - xi) * at.v[seats[0] + 6] + xi * at.v[seats[1] + 6]
}
