//! Parts: what a scene names, and what forces, constraints and records ask of it.

use crate::algebra::lane::V3;
use crate::model::feed::Front;
use crate::model::held::Held;
use crate::model::marker::Marker;
use crate::model::node::{Node, NodeId};
use crate::model::remesh::{Change, Mesh};
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

/// What can be observed along a part, besides the motion of its markers.
///
/// ```
/// use ropewalk_core::Quantity;
/// assert_eq!(Quantity::Moment.unit(), "N m");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize, schemars::JsonSchema))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Quantity {
    /// Axial force [N].
    Tension,
    /// Axial strain [1].
    Strain,
    /// Curvature [1/m].
    Curvature,
    /// Bending moment [N m].
    Moment,
}

impl Quantity {
    /// Its SI unit.
    pub fn unit(self) -> &'static str {
        match self {
            Quantity::Tension => "N",
            Quantity::Strain => "1",
            Quantity::Curvature => "1/m",
            Quantity::Moment => "N m",
        }
    }
}

/// A ball by which a compact part touches shapes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactPoint {
    /// Its centre. On a rigid body always [`Held::Beside`], so that it turns with it.
    pub held: Held,
    /// Its radius [m]; 0 if the part has none.
    pub radius: f64,
}

/// An element of a slender part and what it is made of.
///
/// ```
/// use ropewalk_core::Slender;
/// let rope = Slender { element: 0.5, mass: 0.4, ea: 1e5, ei: 0.1 };
/// // sound passes an element in a millisecond, bending in a quarter of a second
/// assert!((rope.axial_time() - 1e-3).abs() < 1e-9 && (rope.bending_time() - 0.5).abs() < 1e-9);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slender {
    /// Its length [m].
    pub element: f64,
    /// Its mass per length, of the water that it is flooded with too [kg/m].
    pub mass: f64,
    /// Its axial stiffness [N].
    pub ea: f64,
    /// Its bending stiffness [N m²].
    pub ei: f64,
}

impl Slender {
    /// Time in which bending runs along the element, `l² √(ρA/EI)` [s]; infinite without bending stiffness.
    pub fn bending_time(&self) -> f64 {
        self.element.powi(2) * (self.mass / self.ei).sqrt()
    }

    /// Time in which sound runs along it, `l √(ρA/EA)` [s].
    pub fn axial_time(&self) -> f64 {
        self.element * (self.mass / self.ea).sqrt()
    }
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
    /// Something along the part, at unstretched arc length `s`.
    fn observe(&self, _what: Quantity, _s: f64, _at: &At<'_>) -> Option<f64> {
        None
    }
    /// Size of the axial force at unstretched arc length `s` [N], by which Newton's method judges residuals: as
    /// [`Quantity::Tension`], or what is cheaper and of its order.
    fn pulls(&self, s: f64, at: &At<'_>) -> Option<f64> {
        self.observe(Quantity::Tension, s, at)
    }
    /// Position and velocity at unstretched arc length `s`.
    fn point(&self, _s: f64, _at: &At<'_>) -> Option<(V3<f64>, V3<f64>)> {
        None
    }
    /// Interpolates coordinates (or velocities) `x` of its nodes at arc length `s`: position and slope, for remeshing.
    fn slope(&self, _s: f64, _x: &[f64], _coordinates: bool) -> Option<(V3<f64>, V3<f64>)> {
        None
    }
    /// Points of its centre line, for pictures.
    fn line(&self, _at: &At<'_>) -> Vec<V3<f64>> {
        Vec::new()
    }
    /// Unstretched arc lengths of these points [m], one for each; empty if it has no length to go along.
    fn arc_lengths(&self, _at: &At<'_>) -> Vec<f64> {
        Vec::new()
    }
    /// Unstretched length, or size [m].
    fn length(&self) -> f64;
    /// Its mass [kg]; 0 if it doesn't tell.
    fn mass(&self) -> f64 {
        0.0
    }
    /// Unstretched length now [m]: what winches have fed out included.
    fn length_now(&self, _at: &At<'_>) -> f64 {
        self.length()
    }
    /// What its elements are like on average, if it is a cable.
    fn slender(&self) -> Option<Slender> {
        None
    }
    /// The front at an end that feeds: 0 the start, 1 the end.
    fn front(&self, _end: usize) -> Option<Front> {
        None
    }
    /// Whether elements are born and swallowed at an end, instead of growing and shrinking together.
    fn makes_elements(&self, _end: usize) -> bool {
        false
    }
    /// Sets velocities `v` such that an end feeds at this rate of its material coordinate [m/s] while the material keeps
    /// the velocity that it has.
    fn start_feeding(&self, _end: usize, _rate: f64, _q: &[f64], _v: &mut [f64]) {}
    /// Where on the part a node is, for messages; `None` if it isn't on it.
    fn place_of(&self, node: NodeId) -> Option<String>;
    /// Its material points where nodes are, by unstretched arc length.
    fn mesh(&self) -> &[f64] {
        &[]
    }
    /// Unstretched arc length of each node from the start as it is now [m]: of a cable that feeds, other than its mesh.
    fn mesh_now(&self, _at: &At<'_>) -> Vec<f64> {
        self.mesh().to_vec()
    }
    /// Lays its nodes evenly along the straight line between its ends, as the start of another search for
    /// equilibrium. Parts that can't be laid wrong do nothing.
    fn straighten(&self, _q: &mut [f64]) {}
    /// First coordinate and velocity of each of its own nodes, in order.
    fn seats(&self) -> Vec<(usize, usize)> {
        Vec::new()
    }
    /// The node, three numbers, that tells which way the section at a node of a cable looks; `None` where it doesn't know.
    fn director(&self, _node: NodeId) -> Option<NodeId> {
        None
    }
    /// Interpolates the numbers of those nodes, or their rates, at arc length `s`.
    fn looks(&self, _s: f64, _x: &[f64], _coordinates: bool) -> Option<V3<f64>> {
        None
    }
    /// Length of the element at an end that others are born of [m]: 0 the start, 1 the end.
    fn end_element(&self, _end: usize, _at: &At<'_>) -> Option<f64> {
        None
    }
    /// Length of the elements between that one and the end, which keep their lengths [m].
    fn riding(&self, _end: usize) -> f64 {
        0.0
    }
    /// Its mesh after a change, with the state that it goes on from; nothing where the mesh of its spec does.
    ///
    /// # Errors
    /// The change can't be made.
    fn remesh(&self, _change: Change, _at: &At<'_>) -> Result<Option<Mesh>, String> {
        Ok(None)
    }
    /// Its state carried over to this part of another model, where the mesh may differ: sets the coordinates and
    /// velocities of this part's nodes by interpolation of `old`.
    fn carry(&self, _nodes: &[Node], _old: &dyn Part, _at: &At<'_>, _q: &mut [f64], _v: &mut [f64]) {}
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
