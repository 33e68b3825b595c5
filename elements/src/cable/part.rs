//! A cable as a part of a model: its markers, its stations, what can be observed along it.

mod coarse;
mod readings;

use super::CableModel;
use super::flow::{self, Grid, Transport, push};
use super::layout::Layout;
use super::section::Section;
use super::shape::{hermite, hermite_slope, natural, second};
use super::twisted::{self, Twisted};
use super::unfold::{Between, unfold};
use ropewalk_core::model::twist::tangent;
use ropewalk_core::{
    At, Change, ContactSpan, DeadEntry, DeadLoad, Line, Marker, Mesh, MovingBoundary, Node, NodeId, Part,
    Per, Prestrain, Quantity, Slender, SpanLine, Spot, Stations, Term, Tip, V3,
};
use std::borrow::Cow;
use std::sync::Arc;

/// A cable of a model.
pub struct CablePart {
    pub(crate) name: String,
    pub(crate) nodes: Vec<NodeId>,
    /// First coordinate and first velocity of each node.
    pub(crate) seats: Vec<(usize, usize)>,
    /// Unstretched arc length of each node [m].
    pub(crate) along: Vec<f64>,
    /// The same with each place but once: as others know the mesh: both nodes of a splice are at one.
    pub(crate) mesh: Vec<f64>,
    /// What its elements are made of.
    pub(crate) layout: Layout,
    pub(crate) stations: Arc<dyn Stations>,
    /// The nodes between which the force in the cable is smooth, ascending: its ends, and where something holds it.
    pub(crate) breaks: Vec<usize>,
    /// How its nodes move along its material, if an end feeds.
    pub(crate) line: Option<flow::Line>,
    /// Length at the start of the run [m], where an end feeds.
    pub(crate) laid: f64,
    /// Whether it goes on from a state that it was given.
    pub(crate) carried: bool,
    /// Strain that fades out, of elements that were born.
    pub(crate) prestrain: Vec<Prestrain>,
    /// The nodes of the model up to its own.
    pub(crate) all: Vec<Node>,
    pub(crate) model: CableModel,
    /// The stress-free shape of each element, where it isn't straight and unstretched.
    pub(crate) rest: Option<Vec<[f64; 12]>>,
    /// Stress-free strain and curvature on top of that.
    pub(crate) offset: (f64, f64),
    /// Its torsion, if it has any.
    pub(crate) twisted: Option<Twisted>,
    /// Points that its sections carry along, by name.
    pub(crate) levers: Vec<(String, Marker)>,
}

impl CablePart {
    /// The element that holds arc length `s` in a mesh, and the place inside it.
    fn locate(mesh: &[f64], s: f64) -> Option<(usize, f64, f64)> {
        let (start, end) = (mesh[0], mesh[mesh.len() - 1]);
        let slack = 1e-9 * (end - start);
        // records at the ends shouldn't fail for rounding
        if !(s >= start - slack && s <= end + slack) {
            return None;
        }
        let k = mesh.partition_point(|&x| x <= s).clamp(1, mesh.len() - 1) - 1;
        let l = mesh[k + 1] - mesh[k];
        Some((k, l, ((s - mesh[k]) / l).clamp(0.0, 1.0)))
    }

    /// Material coordinates of the nodes [m].
    pub(super) fn material(&self, q: &[f64]) -> Cow<'_, [f64]> {
        match &self.line {
            None => Cow::Borrowed(&self.along),
            Some(line) => Cow::Owned((0..self.along.len()).map(|k| line.p(k, q)).collect()),
        }
    }

    /// The points that are drawn: their elements, and the places inside them.
    fn drawn(&self) -> impl Iterator<Item = (usize, f64)> {
        let per = (200 / self.layout.elements().count()).clamp(1, 8);
        let of = move |k| (0..per).map(move |i| (k, i as f64 / per as f64));
        self.layout.elements().flat_map(of).chain([(self.along.len() - 2, 1.0)])
    }

    /// The element at arc length `s` from the start, and the place inside it.
    fn find(&self, s: f64, q: &[f64]) -> Option<(usize, f64, f64)> {
        let mesh = self.material(q);
        Self::locate(&mesh, mesh[0] + s)
    }

    fn dofs(&self, k: usize, q: &[f64]) -> [f64; 12] {
        let (a, b) = (self.seats[k].0, self.seats[k + 1].0);
        std::array::from_fn(|i| if i < 6 { q[a + i] } else { q[b + i - 6] })
    }

    /// First coordinates of the nodes of an element.
    fn around(&self, k: usize) -> [usize; 2] {
        [self.seats[k].0, self.seats[k + 1].0]
    }

    /// Velocity and acceleration of the material in element `k` of length `l`; `None` if none flows through it.
    fn transported(&self, k: usize, l: f64, at: &At<'_>) -> Option<Transport<f64>> {
        let line = self.line.as_ref().filter(|line| line.flows(k))?;
        let [pd, pdd] = [at.v, at.a].map(|v| [line.rate(k, v), line.rate(k + 1, v)]);
        let grid = Grid { l, il: 1.0 / l, p: line.p(k, at.q), ld: pd[1] - pd[0], pd, pdd };
        let [e, ed, edd] = [self.dofs(k, at.q), self.velocities(k, at.v), self.velocities(k, at.a)]
            .map(|x| std::array::from_fn(|i| [x[3 * i], x[3 * i + 1], x[3 * i + 2]]));
        Some(Transport::new(&grid, &e, &ed, &edd))
    }

    fn velocities(&self, k: usize, v: &[f64]) -> [f64; 12] {
        let (a, b) = (self.seats[k].1, self.seats[k + 1].1);
        std::array::from_fn(|i| if i < 6 { v[a + i] } else { v[b + i - 6] })
    }

    /// Second derivative of the curve at an end of element `k`: at its start, or at its end.
    fn bend(&self, k: usize, at_start: bool, q: &[f64]) -> Option<V3<f64>> {
        if k + 1 >= self.along.len() {
            return None;
        }
        let mesh = self.material(q);
        let (l, e) = (mesh[k + 1] - mesh[k], natural(&self.dofs(k, q), 1.0 / (mesh[k + 1] - mesh[k])));
        Some(second(if at_start { &[-4.0, -2.0] } else { &[2.0, 4.0] }, 1.0 / l, &e))
    }

    fn places(&self) -> String {
        let levers: String =
            self.levers.iter().map(|(name, _)| format!("`{}.{name}`, ", self.name)).collect();
        format!("`{0}.start`, `{0}.end`, {levers}or `{0}@s` with s from 0 to {1} m", self.name, self.length())
    }
}

fn interpolate(c: [f64; 4], e: &[f64; 12]) -> V3<f64> {
    std::array::from_fn(|i| (0..4).map(|n| c[n] * e[3 * n + i]).sum())
}

/// The same of nodal vectors.
fn blend(c: [f64; 4], e: &[V3<f64>; 4]) -> V3<f64> {
    std::array::from_fn(|i| (0..4).map(|n| c[n] * e[n][i]).sum())
}

impl Part for CablePart {
    fn name(&self) -> &str {
        &self.name
    }
    fn kind(&self) -> &'static str {
        "cable"
    }
    fn length(&self) -> f64 {
        // tolerances go by it, so that it doesn't change with the mesh
        if self.line.is_some() { self.laid } else { self.along[self.along.len() - 1] }
    }
    fn mass(&self) -> f64 {
        self.layout.mean(&self.along, |s| s.mass) * self.length()
    }

    fn marker(&self, spot: &Spot) -> Result<Marker, String> {
        let end = self.nodes.len() - 1;
        match spot {
            Spot::Named(n) if n == "start" => Ok(Marker::node(self.nodes[0])),
            Spot::Named(n) if n == "end" => Ok(Marker::node(self.nodes[end])),
            Spot::Named(n) if n.is_empty() => Err(format!("say where on the cable: {}", self.places())),
            Spot::Named(n) => match self.levers.iter().find(|(name, _)| name == n) {
                Some((_, marker)) => Ok(*marker),
                None => Err(format!("a cable has no place `{n}`; it has {}", self.places())),
            },
            Spot::Along(_) | Spot::Share(_) if self.line.is_some() => Err(format!(
                "material flows past this place of `{}`: hold on to `{0}.start` or `{0}.end`",
                self.name
            )),
            Spot::Share(s) => self.marker(&Spot::Along(s * self.length())),
            Spot::Along(s) => {
                let k = self.along.iter().position(|x| (x - s).abs() <= 1e-9 * self.length());
                match k {
                    Some(k) => Ok(Marker::node(self.nodes[k])),
                    None if *s >= 0.0 && *s <= self.length() => {
                        let next = self.mesh.partition_point(|x| x < s).clamp(1, self.mesh.len() - 1);
                        let [a, b] = [self.mesh[next - 1], self.mesh[next]];
                        Err(format!(
                            "no node of `{}` is at {s} m; the nearest are at {a} m and {b} m",
                            self.name
                        ))
                    }
                    None => Err(format!("{s} m is not on the cable; it has {}", self.places())),
                }
            }
        }
    }

    fn watched(&self, spot: &Spot) -> Result<Marker, String> {
        if let (Some(_), Spot::Share(share)) = (&self.line, spot) {
            let (from, to) = (self.along[0], self.along[self.along.len() - 1]);
            let s = from + share * (to - from);
            let evenly = self.line.as_ref().is_some_and(|line| line.zone == [false; 2]);
            let k = self.along.iter().position(|x| evenly && (x - s).abs() <= 1e-9 * (to - from));
            return k.map(|k| Marker::node(self.nodes[k])).ok_or_else(|| "there is no node".into());
        }
        self.marker(spot)
    }

    fn stations(&self) -> Option<Arc<dyn Stations>> {
        Some(self.stations.clone())
    }

    fn material_stations(&self) -> Option<Arc<dyn Stations>> {
        match &self.line {
            Some(line) => push::stations(&self.all, line, &self.nodes, &self.layout, true).ok(),
            None => self.stations(),
        }
    }

    fn contact_spans(&self) -> Vec<ContactSpan> {
        let last = self.along.len() - 2;
        self.layout
            .elements()
            .map(|k| {
                let radius = 0.5 * self.layout.section(k).diameter;
                let ((q0, v0), (q1, v1)) = (self.seats[k], self.seats[k + 1]);
                let l = self.along[k + 1] - self.along[k];
                let line = SpanLine::Cubic { q: [q0, q0 + 3, q1, q1 + 3], v: [v0, v0 + 3, v1, v1 + 3], l };
                let flow = self.line.as_ref().filter(|line| line.flows(k)).map(|line| line.span(k));
                ContactSpan { line, radius, length: l, s: self.along[k], tips: [k == 0, k == last], flow }
            })
            .collect()
    }

    fn dead_load(&self, per: Per, load: V3<f64>) -> Option<Box<dyn Term>> {
        let what = match per {
            Per::Mass => "weight",
            Per::Volume => "buoyancy",
        };
        let density = |s: &Section| match per {
            Per::Mass => s.mass,
            Per::Volume => s.displaced_area(),
        };
        if self.layout.largest(density) == 0.0 {
            return None;
        }
        let flows = |k: usize| self.line.as_ref().is_some_and(|line| line.flows(k));
        let mut entries = Vec::new();
        for k in self.layout.elements().filter(|&k| !flows(k)) {
            let l = self.along[k + 1] - self.along[k];
            let density = density(self.layout.section(k));
            let share = [0.5 * l, l * l / 12.0, 0.5 * l, -l * l / 12.0];
            for (n, share) in share.iter().enumerate() {
                let (q, v) = self.seats[k + n / 2];
                for i in (0..3).filter(|&i| load[i] != 0.0) {
                    let at = 3 * (n % 2) + i;
                    entries.push(DeadEntry {
                        dof: v + at,
                        coordinate: q + at,
                        value: density * load[i] * share,
                    });
                }
            }
        }
        let dead = DeadLoad::new(format!("{}: {what}", self.name), entries).ok()?;
        let Some(line) = &self.line else { return Some(Box::new(dead)) };
        let own = |k: usize| load.map(|x| density(self.layout.section(k)) * x);
        let flowing = push::weight(&self.all, line, &self.nodes, own)?;
        Some(Box::new(push::Weight { dead, flowing }))
    }

    fn tips(&self) -> Vec<Tip> {
        let last = self.nodes.len() - 1;
        let tip = |(k, element): (usize, usize)| {
            let (marker, diameter) = (Marker::node(self.nodes[k]), self.layout.section(element).diameter);
            Tip { marker, axis: [0.0; 3], diameter, first: k == 0, sheds: true }
        };
        [(0, 0), (last, last - 1)].map(tip).into_iter().filter(|tip| tip.diameter > 0.0).collect()
    }

    fn point(&self, s: f64, at: &At<'_>) -> Option<(V3<f64>, V3<f64>)> {
        let (k, l, xi) = self.find(s, at.q)?;
        let c = hermite::<f64>(xi, l);
        let velocity = match self.transported(k, l, at) {
            Some(material) => blend(c, &material.v),
            None => interpolate(c, &self.velocities(k, at.v)),
        };
        Some((interpolate(c, &self.dofs(k, at.q)), velocity))
    }

    fn accelerates(&self, s: f64, at: &At<'_>) -> Option<V3<f64>> {
        let (k, l, xi) = self.find(s, at.q)?;
        let c = hermite::<f64>(xi, l);
        Some(match self.transported(k, l, at) {
            Some(material) => blend(c, &material.a),
            None => interpolate(c, &self.velocities(k, at.a)),
        })
    }

    fn centre_line(&self, at: &At<'_>) -> Vec<V3<f64>> {
        let mesh = self.material(at.q);
        let point = |(k, xi): (usize, f64)| {
            interpolate(hermite::<f64>(xi, mesh[k + 1] - mesh[k]), &self.dofs(k, at.q))
        };
        self.drawn().map(point).collect()
    }

    fn arc_lengths(&self, at: &At<'_>) -> Vec<f64> {
        let mesh = self.material(at.q);
        self.drawn().map(|(k, xi)| mesh[k] - mesh[0] + xi * (mesh[k + 1] - mesh[k])).collect()
    }

    fn place_of(&self, node: NodeId) -> Option<String> {
        if let Some(line) = &self.line
            && let Some((end, _)) = line.boundaries.iter().find(|(_, f)| f.node == node)
        {
            return Some(format!("what is fed at its {}", ["start", "end"][*end]));
        }
        if let Some(k) = self.twisted.as_ref().and_then(|twisted| twisted.bubble(node)) {
            return Some(format!("twist within the element at {:.4} m", self.along[k]));
        }
        let k = self.nodes.iter().position(|&n| n == node)?;
        Some(format!("at {:.4} m", self.along[k]))
    }

    fn seats(&self) -> Vec<(usize, usize)> {
        self.layout.once(&self.seats)
    }

    fn carry(&self, nodes: &[Node], old: &dyn Part, at: &At<'_>, q: &mut [f64], v: &mut [f64]) {
        let Some(old) = old.line().filter(|_| !self.carried) else { return };
        for (k, &id) in self.nodes.iter().enumerate() {
            let node = &nodes[id.0 as usize];
            // the slope at the end of a section that is spliced to the next is that just before
            let spliced = self.layout.splices().iter().any(|s| s.node == k);
            let s = self.along[k] - if spliced { 1e-9 * self.length() } else { 0.0 };
            let there = |x: &[f64], coordinates| {
                Some((old.slope(self.along[k], x, coordinates)?.0, old.slope(s, x, coordinates)?.1))
            };
            if let Some((x, dx)) = there(at.q, true) {
                q[node.q..node.q + 3].copy_from_slice(&x);
                q[node.q + 3..node.q + 6].copy_from_slice(&dx);
            }
            if let Some((x, dx)) = there(at.v, false) {
                v[node.v..node.v + 3].copy_from_slice(&x);
                v[node.v + 3..node.v + 6].copy_from_slice(&dx);
            }
        }
        for (s, &(own_q, own_v)) in self.along.iter().zip(&self.seats).filter(|_| self.twisted.is_some()) {
            let three = |i: usize| [q[own_q + i], q[own_q + i + 1], q[own_q + i + 2]];
            if let Some((d, angle)) = old.looks(*s, at.q) {
                let node = twisted::node_at(&three(0), &three(3), &d, angle);
                q[own_q..own_q + 10].copy_from_slice(&node);
            }
            if let Some(spin) = old.observe(Quantity::Spin, *s, at) {
                v[own_v + 6] = spin;
            }
        }
    }

    fn line(&self) -> Option<&dyn Line> {
        Some(self)
    }
}

impl Line for CablePart {
    fn slender(&self) -> Slender {
        let element = self.laid / self.layout.elements().count() as f64;
        let mass = self.layout.mean(&self.along, |s| s.mass + s.flooded);
        Slender { element, mass, ea: self.layout.largest(|s| s.ea), ei: self.layout.largest(|s| s.ei.mean()) }
    }

    fn mesh(&self) -> &[f64] {
        &self.mesh
    }

    fn mesh_now(&self, at: &At<'_>) -> Vec<f64> {
        if self.line.is_none() {
            return self.mesh.clone();
        }
        let mesh = self.layout.once(&self.material(at.q));
        mesh.iter().map(|p| p - mesh[0]).collect()
    }

    fn axial_rule(&self) -> Vec<[f64; 2]> {
        let points = self.model.models().map_or(&[][..], |models| models.points());
        // one is that of an average over the element
        points.iter().filter(|_| points.len() > 1).map(|p| [p.xi, p.w]).collect()
    }

    fn length_now(&self, at: &At<'_>) -> f64 {
        match &self.line {
            None => self.length(),
            Some(line) => line.p(self.along.len() - 1, at.q) - line.p(0, at.q),
        }
    }

    fn observe(&self, what: Quantity, s: f64, at: &At<'_>) -> Option<f64> {
        let (k, l, xi) = self.find(s, at.q)?;
        let r = self.reading(k, l, xi, at)?;
        Some(match what {
            Quantity::Tension => self.tension(k, xi, &r.slope, at, &mut |k, l| self.transmits(k, l, at))?,
            Quantity::Strain => r.strain,
            Quantity::Curvature => r.curvature,
            Quantity::Moment => self.moment(k, l, xi, r.moment, at),
            _ => return self.twist(what, k, l, xi, at),
        })
    }

    fn measure(&self, places: &[f64], at: &At<'_>) -> Vec<[f64; 3]> {
        // an element transmits one force, which several places ask for
        let mut known = vec![None; self.seats.len() - 1];
        let mut transmits = |k: usize, l: f64| *known[k].get_or_insert_with(|| self.transmits(k, l, at));
        let mut one = |s: f64| {
            let (k, l, xi) = self.find(s, at.q)?;
            let r = self.reading(k, l, xi, at)?;
            let tension = self.tension(k, xi, &r.slope, at, &mut transmits).unwrap_or(f64::NAN);
            Some([tension, r.curvature, self.moment(k, l, xi, r.moment, at)])
        };
        places.iter().map(|s| one(*s).unwrap_or([f64::NAN; 3])).collect()
    }

    fn remark(&self, at: &At<'_>) -> Option<String> {
        self.coarse(at)
    }

    fn pulls(&self, s: f64, at: &At<'_>) -> Option<f64> {
        let (k, l, xi) = self.find(s, at.q)?;
        self.by_strain(k, l, xi, at)
    }

    fn straighten(&self, q: &mut [f64]) {
        self.lay_straight(q);
    }

    fn bow(&self, q: &mut [f64], down: &V3<f64>) -> bool {
        self.lay_bowed(q, down)
    }

    fn unfold(&self, q: &mut [f64]) -> Option<f64> {
        let mesh = self.material(q).into_owned();
        let of = |k: usize| Between { first: k, length: mesh[k + 1] - mesh[k] };
        let elements: Vec<Between> = self.layout.elements().map(of).collect();
        let seat = |s: &(usize, usize)| -> [f64; 6] { std::array::from_fn(|i| q[s.0 + i]) };
        let mut places: Vec<[f64; 6]> = self.seats.iter().map(seat).collect();
        // what pushes by no force has no strain of its own where it is slack
        let stiff = |e: &Between| {
            let section = self.layout.section(e.first);
            !section.tension_only && section.axial_force.is_none()
        };
        let folded: Vec<bool> = elements.iter().map(|e| stiff(e) && e.is_folded(&places)).collect();
        let first = elements[folded.iter().position(|is| *is)?].first;
        unfold(&mut places, &elements, &folded);
        let tangents: Vec<V3<f64>> = self.seats.iter().map(|s| tangent(&q[s.0..])).collect();
        for (place, seat) in places.iter().zip(&self.seats) {
            q[seat.0..seat.0 + 6].copy_from_slice(place);
        }
        if self.twisted.is_some() {
            let seats: Vec<usize> = self.seats.iter().map(|s| s.0).collect();
            twisted::follow(q, &seats, &tangents);
        }
        Some(mesh[first] - mesh[0])
    }

    fn twisted(&self) -> Vec<Vec<(usize, usize)>> {
        if self.twisted.is_none() {
            return Vec::new();
        }
        let ends = self.layout.splices().iter().map(|s| s.node + 1).chain([self.seats.len()]);
        let mut start = 0;
        ends.map(|end| self.seats[std::mem::replace(&mut start, end)..end].to_vec()).collect()
    }

    fn looks(&self, s: f64, q: &[f64]) -> Option<(V3<f64>, f64)> {
        let (twisted, (k, l, xi)) = (self.twisted.as_ref()?, Self::locate(&self.along, s)?);
        let before = self.turns_before(k, twisted, q);
        let slope = interpolate(hermite_slope::<f64>(xi, 1.0 / l), &self.dofs(k, q));
        let (d, turn) = twisted.looks(k, [l, xi], &slope, q, self.around(k));
        Some((d, before + turn))
    }

    fn slope(&self, s: f64, x: &[f64], coordinates: bool) -> Option<(V3<f64>, V3<f64>)> {
        let (k, l, xi) = Self::locate(&self.along, s)?;
        let e = if coordinates { self.dofs(k, x) } else { self.velocities(k, x) };
        Some((interpolate(hermite::<f64>(xi, l), &e), interpolate(hermite_slope::<f64>(xi, 1.0 / l), &e)))
    }

    fn boundary(&self, end: usize) -> Option<MovingBoundary> {
        self.line.as_ref()?.boundaries.iter().find(|(at, _)| *at == end).map(|(_, boundary)| *boundary)
    }

    fn makes_elements(&self, end: usize) -> bool {
        self.line.as_ref().is_some_and(|line| line.zone[end])
    }

    fn start_feeding(&self, end: usize, rate: f64, q: &[f64], v: &mut [f64]) {
        let (Some(line), Some(boundary)) = (&self.line, self.boundary(end)) else { return };
        if self.carried {
            return;
        }
        let before: Vec<f64> = (0..self.along.len()).map(|k| line.rate(k, v)).collect();
        v[boundary.v] = rate;
        for (k, before) in before.into_iter().enumerate() {
            let change = line.rate(k, v) - before;
            let (q0, v0) = self.seats[k];
            // the slope's own rate is that of the curve on both sides of the node
            let sides = [k.checked_sub(1), Some(k)];
            let bends: Vec<V3<f64>> =
                sides.iter().flatten().filter_map(|&e| self.bend(e, e == k, q)).collect();
            if let Some(twisted) = &self.twisted {
                let twist = |e: &usize| {
                    let l = self.along.get(e + 1)? - self.along[*e];
                    Some(twisted.twist(*e, l, q, self.around(*e))[0])
                };
                let twists: Vec<f64> = sides.iter().flatten().filter_map(twist).collect();
                v[v0 + 6] += change * twists.iter().sum::<f64>() / twists.len().max(1) as f64;
            }
            for i in 0..3 {
                v[v0 + i] += change * q[q0 + 3 + i];
                v[v0 + 3 + i] += change * bends.iter().map(|b| b[i]).sum::<f64>() / bends.len().max(1) as f64;
            }
        }
    }

    fn end_element(&self, end: usize, at: &At<'_>) -> Option<f64> {
        let line = self.line.as_ref()?;
        let k = line.grows(end);
        Some(line.p(k + 1, at.q) - line.p(k, at.q))
    }

    fn riding(&self, end: usize) -> f64 {
        let Some(line) = &self.line else { return 0.0 };
        let (k, last) = (line.grows(end), self.along.len() - 1);
        if end == 0 { self.along[k] - self.along[0] } else { self.along[last] - self.along[k + 1] }
    }

    fn kept(&self, end: usize) -> f64 {
        let holds = self.layout.holds();
        match (self.layout.changes(), end) {
            (false, _) => 0.0,
            (true, 0) => self.laid - self.along[holds[0]],
            (true, _) => self.along[holds[1]],
        }
    }

    fn kept_more(&self, end: usize, at: &At<'_>) -> f64 {
        if !self.layout.changes() {
            return 0.0;
        }
        self.boundary(1 - end).map_or(0.0, |other| other.fed(at))
    }

    fn remesh(&self, what: Change, at: &At<'_>) -> Result<Option<Mesh>, String> {
        self.remeshed(what, at)
    }
}
