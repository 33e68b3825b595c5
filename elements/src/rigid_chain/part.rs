//! A chain of rigid links as a part of a model.

use ropewalk_core::held::three;
use ropewalk_core::rotation::{cross, matrix, times};
use ropewalk_core::{
    At, ContactSpan, DeadEntry, DeadLoad, Marker, Node, NodeId, Part, Per, SpanLine, Spot, Stations, Term,
    Tip, V3,
};
use std::sync::Arc;

/// A chain of rigid links of a model.
pub struct ChainPart {
    pub(crate) name: String,
    pub(crate) nodes: Vec<NodeId>,
    /// First coordinate and first velocity of each link.
    pub(crate) seats: Vec<(usize, usize)>,
    /// Length of a link [m].
    pub(crate) link: f64,
    /// Its diameter; 0 if it has none [m].
    pub(crate) diameter: f64,
    /// Mass that gravity pulls at, and displaced volume, of a link [kg, m³].
    pub(crate) mass: f64,
    pub(crate) volume: f64,
    pub(crate) stations: Option<Arc<dyn Stations>>,
}

impl ChainPart {
    /// The link that holds arc length `s`, and how far from its centre that is.
    fn locate(&self, s: f64) -> Option<(usize, f64)> {
        let end = self.length();
        // records at the ends shouldn't fail for rounding
        if !(s >= -1e-9 * end && s <= end * (1.0 + 1e-9)) {
            return None;
        }
        let k = ((s / self.link) as usize).min(self.seats.len() - 1);
        let half = 0.5 * self.link;
        Some((k, (s - (k as f64 + 0.5) * self.link).clamp(-half, half)))
    }
    fn place(&self, k: usize, ahead: f64, at: &At<'_>) -> V3<f64> {
        let q = self.seats[k].0;
        let r = matrix(&[at.q[q + 3], at.q[q + 4], at.q[q + 5], at.q[q + 6]]);
        std::array::from_fn(|i| at.q[q + i] + ahead * r[i][0])
    }
    fn places(&self) -> String {
        let (name, links) = (&self.name, self.seats.len());
        format!(
            "`{name}.start`, `{name}.end`, the centres `{name}.link1` to `{name}.link{links}`, and `{name}@s` with s from \
             0 to {} m",
            self.length()
        )
    }
}

impl Part for ChainPart {
    fn name(&self) -> &str {
        &self.name
    }
    fn kind(&self) -> &'static str {
        "rigid_chain"
    }
    fn length(&self) -> f64 {
        self.link * self.seats.len() as f64
    }
    fn mass(&self) -> f64 {
        self.mass * self.seats.len() as f64
    }
    fn marker(&self, spot: &Spot) -> Result<Marker, String> {
        let (first, last) = (self.nodes[0], self.nodes[self.nodes.len() - 1]);
        let half = 0.5 * self.link;
        let found = match spot {
            Spot::Named(n) if n == "start" => Some(Marker::beside(first, [-half, 0.0, 0.0])),
            Spot::Named(n) if n == "end" => Some(Marker::beside(last, [half, 0.0, 0.0])),
            Spot::Named(n) => n
                .strip_prefix("link")
                .and_then(|k| k.parse::<usize>().ok())
                .and_then(|k| self.nodes.get(k.checked_sub(1)?))
                .map(|&node| Marker::node(node)),
            Spot::Share(share) => return self.marker(&Spot::Along(share * self.length())),
            Spot::Along(s) => {
                self.locate(*s).map(|(k, ahead)| Marker::beside(self.nodes[k], [ahead, 0.0, 0.0]))
            }
        };
        found.ok_or_else(|| format!("there is no such place on the chain; it has {}", self.places()))
    }
    fn stations(&self) -> Option<Arc<dyn Stations>> {
        self.stations.clone()
    }
    fn contact_spans(&self) -> Vec<ContactSpan> {
        let (half, last) = (0.5 * self.link, self.seats.len() - 1);
        let ends = [[-half, 0.0, 0.0], [half, 0.0, 0.0]];
        let seats = self.seats.iter().enumerate();
        let span = |(k, &(q, v)): (usize, &(usize, usize))| ContactSpan {
            line: SpanLine::Straight { q, v, ends, along: [1.0, 0.0, 0.0] },
            radius: 0.5 * self.diameter,
            length: self.link,
            s: k as f64 * self.link,
            tips: [k == 0, k == last],
            flow: None,
        };
        seats.map(span).collect()
    }
    fn dead_load(&self, per: Per, load: V3<f64>) -> Option<Box<dyn Term>> {
        let (what, amount) = match per {
            Per::Mass => ("weight", self.mass),
            Per::Volume => ("buoyancy", self.volume),
        };
        if amount == 0.0 {
            return None;
        }
        let entries = self.seats.iter().flat_map(|&(q, v)| {
            (0..3).filter(|&i| load[i] != 0.0).map(move |i| DeadEntry {
                dof: v + i,
                coordinate: q + i,
                value: amount * load[i],
            })
        });
        Some(Box::new(DeadLoad::new(format!("{}: {what}", self.name), entries.collect()).ok()?))
    }
    fn tips(&self) -> Vec<Tip> {
        if self.diameter == 0.0 {
            return Vec::new();
        }
        let (half, diameter, axis) = (0.5 * self.link, self.diameter, [1.0, 0.0, 0.0]);
        let tip = |node: NodeId, along: f64, first: bool| {
            let marker = Marker::beside(node, [along, 0.0, 0.0]);
            Tip { marker, axis, diameter, first, sheds: true }
        };
        vec![tip(self.nodes[0], -half, true), tip(self.nodes[self.nodes.len() - 1], half, false)]
    }
    fn point(&self, s: f64, at: &At<'_>) -> Option<(V3<f64>, V3<f64>)> {
        let (k, ahead) = self.locate(s)?;
        let (q, v) = self.seats[k];
        let r = matrix(&[at.q[q + 3], at.q[q + 4], at.q[q + 5], at.q[q + 6]]);
        let swing = times(&r, &cross(&three(at.v, v + 3), &[ahead, 0.0, 0.0]));
        let own = three(at.v, v);
        Some((self.place(k, ahead, at), std::array::from_fn(|i| own[i] + swing[i])))
    }
    fn links(&self) -> &[NodeId] {
        &self.nodes
    }
    fn centre_line(&self, at: &At<'_>) -> Vec<V3<f64>> {
        let half = 0.5 * self.link;
        let starts = (0..self.seats.len()).map(|k| self.place(k, -half, at));
        starts.chain([self.place(self.seats.len() - 1, half, at)]).collect()
    }
    fn arc_lengths(&self, _: &At<'_>) -> Vec<f64> {
        (0..=self.seats.len()).map(|k| k as f64 * self.link).collect()
    }
    fn place_of(&self, node: NodeId) -> Option<String> {
        self.nodes.iter().position(|&n| n == node).map(|k| format!("link {}", k + 1))
    }
    fn seats(&self) -> Vec<(usize, usize)> {
        self.seats.clone()
    }
    fn carry(&self, _: &[Node], old: &dyn Part, at: &At<'_>, q: &mut [f64], v: &mut [f64]) {
        for (&(to_q, to_v), (from_q, from_v)) in self.seats.iter().zip(old.seats()) {
            q[to_q..to_q + 7].copy_from_slice(&at.q[from_q..from_q + 7]);
            v[to_v..to_v + 6].copy_from_slice(&at.v[from_v..from_v + 6]);
        }
    }
}
