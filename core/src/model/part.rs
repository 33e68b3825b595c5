//! Parts: what a scene names, and what forces, constraints and records ask of it.

use crate::algebra::lane::V3;
use crate::model::feed::MovingBoundary;
use crate::model::held::Held;
use crate::model::line::{Line, Quantity, Slender};
use crate::model::marker::Marker;
use crate::model::node::{Node, NodeId};
use crate::model::solid::{Attitude, Solid};
use crate::model::span::ContactSpan;
use crate::model::state::At;
use crate::model::station::Stations;
use crate::model::term::Term;
use std::sync::Arc;

/// What a dead load is proportional to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Per {
    /// Structural mass: the load is a force per kilogram, such as gravity [N/kg].
    Mass,
    /// Displaced volume: the load is a force per cubic metre, such as buoyancy [N/m³].
    Volume,
}

/// A ball by which a compact part touches shapes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactPoint {
    /// Its centre. On a rigid body always [`Held::Beside`], so that it turns with it.
    pub held: Held,
    /// Its radius [m]; 0 if the part has none.
    pub radius: f64,
}

/// An end of a slender part, where a fluid may meet or leave it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tip {
    /// Where it is.
    pub marker: Marker,
    /// Direction of the axis there, from the first end to the last, in the axes of the body that it is on; that of a cable is
    /// the slope of its node.
    pub axis: V3<f64>,
    /// Hydrodynamic diameter [m].
    pub diameter: f64,
    /// Whether it is the first end, whose axis leads inwards.
    pub first: bool,
    /// Whether the water beside the part leaves it there in a wake: not at hulls of single bodies, as Kirchhoff's equations
    /// have it.
    pub sheds: bool,
}

/// A named part of a model: a cable, a point mass, a rigid body.
pub trait Part: Send + Sync {
    /// Its name in the scene.
    fn name(&self) -> &str;
    /// Its type, as in the scene file.
    fn kind(&self) -> &'static str;
    /// A marker at a named place: `start`, `end`, an arc length like `12.5`. The error says which places there are.
    fn marker(&self, place: &Spot) -> Result<Marker, String>;
    /// The point that a record watches there; more than can be held, where material flows past.
    fn watched(&self, place: &Spot) -> Result<Marker, String> {
        self.marker(place)
    }
    /// The points where distributed loads act, if it has any.
    fn stations(&self) -> Option<Arc<dyn Stations>> {
        None
    }
    /// The same with the acceleration of the material, where that runs along the curve.
    fn material_stations(&self) -> Option<Arc<dyn Stations>> {
        self.stations()
    }
    /// The balls by which it touches shapes, if it is compact.
    fn contact_points(&self) -> Vec<ContactPoint> {
        Vec::new()
    }
    /// The pieces by which it touches shapes all along, if it is slender.
    fn contact_spans(&self) -> Vec<ContactSpan> {
        Vec::new()
    }
    /// The term of a load in a constant direction, proportional to mass or displaced volume.
    fn dead_load(&self, per: Per, load: V3<f64>) -> Option<Box<dyn Term>>;
    /// The middle and the volume [m³] of what it displaces, if that isn't a slender body along its stations: taken for a
    /// ball where it matters how it lies in the water.
    fn ball(&self) -> Option<(Held, f64)> {
        None
    }
    /// Its two ends, if it is slender and has a diameter.
    fn tips(&self) -> Vec<Tip> {
        Vec::new()
    }
    /// Position at unstretched arc length `s` from the start, and the velocity of the material there.
    fn point(&self, _s: f64, _at: &At<'_>) -> Option<(V3<f64>, V3<f64>)> {
        None
    }
    /// Acceleration of the material at unstretched arc length `s` from the start [m/s²]. Where material doesn't flow, a point is
    /// a linear function of its nodes' coordinates: accelerations go the way of velocities.
    fn accelerates(&self, s: f64, at: &At<'_>) -> Option<V3<f64>> {
        self.point(s, &At { v: at.a, ..*at }).map(|(_, a)| a)
    }
    /// The parts that it is made of, from start to end, if it is a cable that runs over wheels or through rings.
    fn spans(&self) -> &[Arc<dyn Part>] {
        &[]
    }
    /// What only a line is asked, if it is one.
    fn line(&self) -> Option<&dyn Line> {
        None
    }
    /// The links of a chain, in order; each reaches from its start to its end along the x axis of its frame.
    fn links(&self) -> &[NodeId] {
        &[]
    }
    /// Points of its centre line.
    fn centre_line(&self, _at: &At<'_>) -> Vec<V3<f64>> {
        Vec::new()
    }
    /// Unstretched arc lengths of these points [m], one for each; empty if it has no length to go along.
    fn arc_lengths(&self, _at: &At<'_>) -> Vec<f64> {
        Vec::new()
    }
    /// Where it is and how it is turned, if it is compact: its marker without a place.
    fn attitude(&self, _at: &At<'_>) -> Option<Attitude> {
        None
    }
    /// What it looks like, if it is compact; seats are from its attitude and in its axes.
    fn solids(&self) -> Vec<Solid> {
        Vec::new()
    }
    /// Unstretched length, or size [m].
    fn length(&self) -> f64;
    /// Its mass [kg]; 0 if it doesn't tell.
    fn mass(&self) -> f64 {
        0.0
    }
    /// Where on the part a node is, for messages; `None` if it isn't on it.
    fn place_of(&self, node: NodeId) -> Option<String>;
    /// First coordinate and velocity of each of its own nodes, in order.
    fn seats(&self) -> Vec<(usize, usize)> {
        Vec::new()
    }
    /// Its state carried over to this part of another model, where the mesh may differ: sets the coordinates and
    /// velocities of this part's nodes by interpolation of `old`.
    fn carry(&self, _nodes: &[Node], _old: &dyn Part, _at: &At<'_>, _q: &mut [f64], _v: &mut [f64]) {}
}

/// What is asked of any part and told by lines alone.
impl dyn Part + '_ {
    /// Something along a line, at unstretched arc length `s`.
    pub fn observe(&self, what: Quantity, s: f64, at: &At<'_>) -> Option<f64> {
        self.line()?.observe(what, s, at)
    }
    /// Unstretched length now [m]: what has been fed out included.
    pub fn length_now(&self, at: &At<'_>) -> f64 {
        self.line().map_or_else(|| self.length(), |line| line.length_now(at))
    }
    /// Material points where nodes of a line are, by unstretched arc length; none of other parts.
    pub fn mesh(&self) -> &[f64] {
        self.line().map_or(&[], |line| line.mesh())
    }
    /// What the elements of a line are like on average.
    pub fn slender(&self) -> Option<Slender> {
        self.line().map(|line| line.slender())
    }
    /// The boundary at an end that feeds: 0 the start, 1 the end.
    pub fn boundary(&self, end: usize) -> Option<MovingBoundary> {
        self.line()?.boundary(end)
    }
}

/// A place on a part, as written in a scene behind the part's name.
#[derive(Clone, Debug, PartialEq)]
pub enum Spot {
    /// `hose.end`: a name.
    Named(String),
    /// `hose@12.5m`: an unstretched arc length [m].
    Along(f64),
    /// `hose@50%`: a share of its unstretched length.
    Share(f64),
}
