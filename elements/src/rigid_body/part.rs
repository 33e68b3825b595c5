//! A rigid body as a part of a model.

use super::Shape;
use ropewalk_core::held::{Held, three};
use ropewalk_core::rotation::{cross, matrix, times};
use ropewalk_core::{
    At, Attitude, ContactSpan, DeadEntry, DeadLoad, DeadPull, Marker, Node, NodeId, Part, Per, Solid,
    SpanLine, Spot, Stations, Term, Tip, V3,
};
use std::collections::BTreeMap;
use std::sync::Arc;

/// A rigid body of a model. Places are from the centre of mass in the body's axes [m].
pub struct BodyPart {
    pub(crate) name: String,
    pub(crate) node: NodeId,
    /// First coordinate and velocity of its node.
    pub(crate) q: usize,
    pub(crate) v: usize,
    pub(crate) mass: f64,
    pub(crate) volume: f64,
    pub(crate) origin: V3<f64>,
    pub(crate) centre_of_volume: V3<f64>,
    pub(crate) points: BTreeMap<String, V3<f64>>,
    /// Ends of its hull.
    pub(crate) hull: Option<[V3<f64>; 2]>,
    /// Diameter of its hull [m].
    pub(crate) diameter: f64,
    /// Ends and diameter [m] of the cylinder that it is drawn as, if it is nothing else.
    pub(crate) drawn: Option<([V3<f64>; 2], f64)>,
    /// Its shape, if it is homogeneous.
    pub(crate) shape: Option<Shape>,
    pub(crate) stations: Option<Arc<dyn Stations>>,
}

impl BodyPart {
    fn rotation(&self, at: &At<'_>) -> [V3<f64>; 3] {
        matrix(&[at.q[self.q + 3], at.q[self.q + 4], at.q[self.q + 5], at.q[self.q + 6]])
    }
    fn place(&self, arm: &V3<f64>, at: &At<'_>) -> V3<f64> {
        let (x, arm) = (three(at.q, self.q), times(&self.rotation(at), arm));
        [x[0] + arm[0], x[1] + arm[1], x[2] + arm[2]]
    }
}

impl Part for BodyPart {
    fn name(&self) -> &str {
        &self.name
    }
    fn kind(&self) -> &'static str {
        "rigid_body"
    }
    fn mass(&self) -> f64 {
        self.mass
    }
    fn marker(&self, spot: &Spot) -> Result<Marker, String> {
        let named = match spot {
            Spot::Named(n) if n.is_empty() => return Ok(Marker::beside(self.node, self.origin)),
            Spot::Named(n) if n == "com" => return Ok(Marker::node(self.node)),
            Spot::Named(n) => self.points.get(n),
            Spot::Along(_) | Spot::Share(_) => None,
        };
        named.map(|&point| Marker::beside(self.node, point)).ok_or_else(|| {
            let name = &self.name;
            let more: String = self.points.keys().map(|p| format!(", `{name}.{p}`")).collect();
            format!("there is no such place on the body; it has `{name}`, `{name}.com`{more}; add more in `points`")
        })
    }
    fn stations(&self) -> Option<Arc<dyn Stations>> {
        self.stations.clone()
    }
    /// The hull with round ends: its line ends a radius before them.
    fn contact_spans(&self) -> Vec<ContactSpan> {
        let (Some([from, to]), radius) = (self.hull, 0.5 * self.diameter) else { return Vec::new() };
        let axis = [to[0] - from[0], to[1] - from[1], to[2] - from[2]];
        let length = axis.iter().map(|x| x * x).sum::<f64>().sqrt();
        let inset = (radius / length).min(0.5);
        let ends = [inset, 1.0 - inset].map(|x| std::array::from_fn(|i| from[i] + x * axis[i]));
        let line = SpanLine::Straight { q: self.q, v: self.v, ends, along: axis.map(|x| x / length) };
        vec![ContactSpan { line, radius, length, s: 0.0, tips: [true; 2], flow: None }]
    }
    fn dead_load(&self, per: Per, load: V3<f64>) -> Option<Box<dyn Term>> {
        let (what, amount, arm) = match per {
            Per::Mass => ("weight", self.mass, [0.0; 3]),
            Per::Volume => ("buoyancy", self.volume, self.centre_of_volume),
        };
        if amount == 0.0 {
            return None;
        }
        let (label, force) = (format!("{}: {what}", self.name), load.map(|x| amount * x));
        if arm != [0.0; 3] {
            let held = Held::Beside { q: self.q, v: self.v, arm };
            return Some(Box::new(DeadPull { label, held, force }));
        }
        let entries = (0..3)
            .filter(|&i| load[i] != 0.0)
            .map(|i| DeadEntry { dof: self.v + i, coordinate: self.q + i, value: force[i] })
            .collect();
        Some(Box::new(DeadLoad::new(label, entries).ok()?))
    }
    fn tips(&self) -> Vec<Tip> {
        let Some(ends) = self.hull else { return Vec::new() };
        let axis: V3<f64> = std::array::from_fn(|i| ends[1][i] - ends[0][i]);
        let length = axis.iter().map(|x| x * x).sum::<f64>().sqrt();
        let (axis, diameter) = (axis.map(|x| x / length), self.diameter);
        let tip = |k: usize| {
            let marker = Marker::beside(self.node, ends[k]);
            Tip { marker, axis, diameter, first: k == 0, sheds: false }
        };
        vec![tip(0), tip(1)]
    }
    fn ball(&self) -> Option<(Held, f64)> {
        let held = Held::Beside { q: self.q, v: self.v, arm: self.centre_of_volume };
        self.hull.is_none().then_some((held, self.volume))
    }
    fn point(&self, _: f64, at: &At<'_>) -> Option<(V3<f64>, V3<f64>)> {
        let swing = times(&self.rotation(at), &cross(&three(at.v, self.v + 3), &self.origin));
        let v = three(at.v, self.v);
        Some((self.place(&self.origin, at), [v[0] + swing[0], v[1] + swing[1], v[2] + swing[2]]))
    }
    fn centre_line(&self, at: &At<'_>) -> Vec<V3<f64>> {
        match &self.hull {
            Some(ends) => ends.iter().map(|e| self.place(e, at)).collect(),
            None if self.points.is_empty() => Vec::new(),
            // its points seen from its centre of mass
            None => {
                let centre = three(at.q, self.q);
                std::iter::once(centre)
                    .chain(self.points.values().flat_map(|p| [self.place(p, at), centre]))
                    .collect()
            }
        }
    }
    fn attitude(&self, at: &At<'_>) -> Option<Attitude> {
        let turn = std::array::from_fn(|i| at.q[self.q + 3 + i]);
        Some(Attitude { x: self.place(&self.origin, at), turn })
    }
    /// Its hull and its shape, from the origin of its frame.
    fn solids(&self) -> Vec<Solid> {
        let from_origin = |x: &V3<f64>| std::array::from_fn(|i| x[i] - self.origin[i]);
        let hull = self
            .hull
            .map(|ends| Solid::between(&self.name, None, ends.each_ref().map(from_origin), self.diameter));
        let shape = self.shape.as_ref().map(|shape| {
            let (surface, axes) = shape.surface();
            let seat = Attitude::new(from_origin(&[0.0; 3]), &axes);
            Solid { name: self.name.clone(), surface, carrier: None, seat }
        });
        let seen: Vec<Solid> = hull.into_iter().chain(shape).collect();
        let drawn = self.drawn.filter(|_| seen.is_empty());
        let drawn =
            drawn.map(|(ends, d)| Solid::between(&self.name, None, ends.each_ref().map(from_origin), d));
        seen.into_iter().chain(drawn).collect()
    }
    fn length(&self) -> f64 {
        let reach = |p: &V3<f64>| p.iter().map(|x| x * x).sum::<f64>().sqrt();
        let ends = self.hull.iter().flatten().chain(self.points.values()).chain([&self.origin]);
        ends.map(reach).fold(0.0, f64::max)
    }
    fn place_of(&self, node: NodeId) -> Option<String> {
        (node == self.node).then(String::new)
    }
    fn carry(&self, nodes: &[Node], old: &dyn Part, at: &At<'_>, q: &mut [f64], v: &mut [f64]) {
        if let Some(&(from_q, from_v)) = old.seats().first() {
            let node = &nodes[self.node.0 as usize];
            q[node.coords()].copy_from_slice(&at.q[from_q..from_q + 7]);
            v[node.dofs()].copy_from_slice(&at.v[from_v..from_v + 6]);
        }
    }
    fn seats(&self) -> Vec<(usize, usize)> {
        vec![(self.q, self.v)]
    }
}
