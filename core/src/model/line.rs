//! Lines: parts that are made of elements along a curve, and what only those are asked.

use crate::algebra::lane::V3;
use crate::model::feed::MovingBoundary;
use crate::model::remesh::{Change, Mesh};
use crate::model::state::At;

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
    /// Curvature about the first director of the section, with its sign [1/m]; of a cable with torsion.
    CurvatureNormal,
    /// The same about the second director.
    CurvatureAcross,
    /// Bending moment about the first director [N m].
    MomentNormal,
    /// The same about the second director.
    MomentAcross,
    /// Twist per unstretched length [rad/m].
    Twist,
    /// Twisting moment [N m].
    Torque,
    /// Angle by which the section is turned about the tangent against that at the start of the cable, whole turns included
    /// [rad].
    Angle,
    /// Angular velocity of the section about the tangent [rad/s].
    Spin,
}

impl Quantity {
    /// Whether it follows from strains, which small errors of positions make large ones of.
    pub fn is_of_strain(self) -> bool {
        !matches!(self, Quantity::Angle | Quantity::Spin)
    }

    /// Its SI unit.
    pub fn unit(self) -> &'static str {
        match self {
            Quantity::Tension => "N",
            Quantity::Strain => "1",
            Quantity::Curvature | Quantity::CurvatureNormal | Quantity::CurvatureAcross => "1/m",
            Quantity::Moment | Quantity::MomentNormal | Quantity::MomentAcross | Quantity::Torque => "N m",
            Quantity::Twist => "rad/m",
            Quantity::Angle => "rad",
            Quantity::Spin => "rad/s",
        }
    }
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

/// What a part can do besides that is made of elements along a curve, such as a cable. Places are unstretched arc lengths
/// `s` from its start as it is now; an end is 0 for the start, 1 for the end.
pub trait Line: Send + Sync {
    /// What its elements are like on average.
    fn slender(&self) -> Slender;
    /// Its material points where nodes are, by unstretched arc length.
    fn mesh(&self) -> &[f64];
    /// Unstretched arc length of each node from the start as it is now [m]: of a line that feeds, other than its mesh.
    fn mesh_now(&self, _at: &At<'_>) -> Vec<f64> {
        self.mesh().to_vec()
    }
    /// Places in each of its elements, from 0 to 1, at which the axial strain is taken, with their weights, which add up to 1;
    /// none where it is an average over the element.
    fn axial_rule(&self) -> Vec<[f64; 2]> {
        Vec::new()
    }
    /// Unstretched length now [m]: what has been fed out included.
    fn length_now(&self, at: &At<'_>) -> f64;
    /// Something along it.
    fn observe(&self, what: Quantity, s: f64, at: &At<'_>) -> Option<f64>;
    /// Tension, curvature and bending moment at each of these places, as [`Line::observe`] tells them: in one go, for records of
    /// whole lines. What isn't known is NaN.
    fn measure(&self, places: &[f64], at: &At<'_>) -> Vec<[f64; 3]> {
        let all = [Quantity::Tension, Quantity::Curvature, Quantity::Moment];
        places.iter().map(|s| all.map(|what| self.observe(what, *s, at).unwrap_or(f64::NAN))).collect()
    }
    /// What one should know of it at an equilibrium, in a sentence: such as that its mesh is too coarse.
    fn remark(&self, _at: &At<'_>) -> Option<String> {
        None
    }
    /// Size of the axial force [N], by which Newton's method judges residuals: as [`Quantity::Tension`], or what is cheaper
    /// and of its order.
    fn pulls(&self, s: f64, at: &At<'_>) -> Option<f64> {
        self.observe(Quantity::Tension, s, at)
    }
    /// Lays its nodes evenly along the straight line between its ends, as the start of another search for equilibrium.
    fn straighten(&self, _q: &mut [f64]) {}
    /// Lays its nodes unstretched along an arc between its ends that is bent across the direction `down`; whether it is slack
    /// enough for one.
    fn bow(&self, _q: &mut [f64], _down: &V3<f64>) -> bool {
        false
    }
    /// Turns round what is folded inside its elements, as no cable is, and tells where the first of that was: unstretched
    /// arc length from the start [m]. Another search for equilibrium begins there.
    fn unfold(&self, _q: &mut [f64]) -> Option<f64> {
        None
    }
    /// First coordinate and velocity of its nodes, if it can be twisted and they are [`NodeKind::Twist`](crate::NodeKind): in
    /// order along each piece of it, between splices.
    fn twisted(&self) -> Vec<Vec<(usize, usize)>> {
        Vec::new()
    }
    /// The first director of the section at a point of the mesh, and the turns it has been twisted by from the start of the
    /// line [rad]; `None` where sections don't know which way they look.
    fn looks(&self, _s: f64, _q: &[f64]) -> Option<(V3<f64>, f64)> {
        None
    }
    /// Interpolates coordinates (or velocities) `x` of its nodes at a point of the mesh: position and slope.
    fn slope(&self, _s: f64, _x: &[f64], _coordinates: bool) -> Option<(V3<f64>, V3<f64>)> {
        None
    }
    /// The boundary at an end that feeds.
    fn boundary(&self, _end: usize) -> Option<MovingBoundary> {
        None
    }
    /// Whether elements are born and swallowed at an end, instead of growing and shrinking together.
    fn makes_elements(&self, _end: usize) -> bool {
        false
    }
    /// Sets velocities `v` such that an end feeds at this rate of its material coordinate [m/s] while the material keeps
    /// the velocity that it has.
    fn start_feeding(&self, _end: usize, _rate: f64, _q: &[f64], _v: &mut [f64]) {}
    /// Length of the element at an end that others are born of [m].
    fn end_element(&self, _end: usize, _at: &At<'_>) -> Option<f64> {
        None
    }
    /// Length of the elements between that one and the end, which keep their lengths [m].
    fn riding(&self, _end: usize) -> f64 {
        0.0
    }
    /// Length that can't be reeled in at an end that feeds [m]: what lies behind the section there, as laid.
    fn kept(&self, _end: usize) -> f64 {
        0.0
    }
    /// By how much that has grown since [m], where another section feeds at the other end.
    fn kept_more(&self, _end: usize, _at: &At<'_>) -> f64 {
        0.0
    }
    /// Its mesh after a change, with the state that it goes on from; nothing where the mesh of its spec does.
    ///
    /// # Errors
    /// The change can't be made.
    fn remesh(&self, _change: Change, _at: &At<'_>) -> Result<Option<Mesh>, String> {
        Ok(None)
    }
}
