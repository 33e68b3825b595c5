//! A compact body at the end of a line.

use ropewalk_core::build::{BuildError, need, not_negative};
use ropewalk_core::held::{delta, find, three};
use ropewalk_core::{
    Assembly, At, Current, DeadEntry, DeadLoad, Energy, Marker, Node, NodeId, NodeKind, Pattern, Power, Term,
    V3, dot,
};

/// A point mass on a node, with added mass and drag that are the same in all directions.
///
/// Use it for: sinkers, buoys, tow bodies, clump weights. Inertia is `(m + m_a) a`, drag
/// `-½ ρ CdA |v - u| (v - u)`. Weight and buoyancy are dead loads, see [`PointMass::weight`]. As with
/// added mass along a cable the water's kinetic energy isn't counted: added mass takes and gives power.
#[derive(Clone, Debug, PartialEq)]
pub struct PointMass {
    /// A name, such as `tow body`.
    pub label: String,
    /// Mass [kg].
    pub mass: f64,
    /// Added mass [kg].
    pub added_mass: f64,
    /// Density of the fluid [kg/m³].
    pub density: f64,
    /// Drag coefficient times area [m²].
    pub drag_area: f64,
    /// Velocity of the fluid.
    pub current: Current,
    node: NodeId,
    /// Indices of the position's first coordinate and velocity.
    q: usize,
    v: usize,
}

impl PointMass {
    /// A mass [kg] on a node, in a vacuum.
    ///
    /// # Errors
    /// A node without position; a negative or infinite mass.
    pub fn new(
        label: impl Into<String>,
        nodes: &[Node],
        node: NodeId,
        mass: f64,
    ) -> Result<Self, BuildError> {
        let label = label.into();
        not_negative(&format!("{label}: mass"), mass)?;
        let n = find(nodes, node, &label)?;
        need(!matches!(n.kind, NodeKind::Scalars(_)), || {
            format!("{label}: node {} has no position", node.0)
        })?;
        let (q, v) = (n.q, n.v);
        let (added_mass, density, drag_area) = (0.0, 0.0, 0.0);
        Ok(PointMass { label, mass, added_mass, density, drag_area, current: Current::Still, node, q, v })
    }

    /// Puts it into a fluid of this density [kg/m³]: added mass [kg], drag coefficient times area [m²], current.
    ///
    /// # Errors
    /// Negative or infinite numbers, a bad current.
    pub fn in_fluid(
        mut self,
        density: f64,
        added_mass: f64,
        drag_area: f64,
        current: Current,
    ) -> Result<Self, BuildError> {
        not_negative(&format!("{}: density of the fluid", self.label), density)?;
        not_negative(&format!("{}: added mass", self.label), added_mass)?;
        not_negative(&format!("{}: drag area", self.label), drag_area)?;
        current.check()?;
        (self.density, self.added_mass, self.drag_area, self.current) =
            (density, added_mass, drag_area, current);
        Ok(self)
    }

    /// Components of its weight less its buoyancy, for a [`DeadLoad`]: `(m - ρ volume) gravity`, with the volume that
    /// it displaces [m³] and the vector of gravity [m/s²].
    ///
    /// # Errors
    /// A negative or infinite volume, a gravity that isn't finite.
    pub fn weight(
        &self,
        nodes: &[Node],
        volume: f64,
        gravity: V3<f64>,
    ) -> Result<Vec<DeadEntry>, BuildError> {
        not_negative(&format!("{}: volume", self.label), volume)?;
        ropewalk_core::build::finite("gravity", &gravity)?;
        let heavy = self.mass - self.density * volume;
        DeadLoad::at_marker(nodes, &Marker::node(self.node), gravity.map(|g| heavy * g))
    }

    /// Velocity relative to the water, its magnitude, the current's gradient, and `½ ρ CdA`.
    fn flow(&self, at: &At<'_>) -> (V3<f64>, f64, V3<f64>, f64) {
        let (u, du) = self.current.at(at.q[self.q + 2]);
        let v: V3<f64> = std::array::from_fn(|i| at.v[self.v + i] - u[i]);
        (v, dot(&v, &v).sqrt(), du, 0.5 * self.density * self.drag_area)
    }
}

impl Term for PointMass {
    fn label(&self) -> String {
        self.label.clone()
    }
    fn pattern(&self, p: &mut Pattern) {
        p.clique(self.v..self.v + 3);
    }
    fn symmetric(&self) -> bool {
        self.current.is_uniform() || self.density * self.drag_area == 0.0
    }
    fn add(&self, at: &At<'_>, out: &mut Assembly<'_>) {
        let inertia = self.mass + self.added_mass;
        let (v, speed, du, c) = self.flow(at);
        for i in 0..3 {
            out.add(self.v + i, inertia * at.a[self.v + i] + c * speed * v[i]);
        }
        if out.wants_tangent() {
            let w = out.weights();
            let inverse = if speed > 0.0 { 1.0 / speed } else { 0.0 };
            let damping = |i: usize, j: usize| c * (speed * delta(i, j) + v[i] * v[j] * inverse);
            let shear: V3<f64> = std::array::from_fn(|i| (0..3).map(|j| damping(i, j) * du[j]).sum());
            out.add_block(0, 3, |i, j| {
                w.a * inertia * delta(i, j) + w.v * damping(i, j) - w.q * shear[i] * delta(2, j)
            });
        }
    }
    fn energy(&self, at: &At<'_>) -> Energy {
        let v = three(at.v, self.v);
        Energy { kinetic: 0.5 * self.mass * dot(&v, &v), ..Energy::default() }
    }
    fn power(&self, at: &At<'_>) -> Power {
        let (relative, speed, _, c) = self.flow(at);
        let (v, a) = (three(at.v, self.v), three(at.a, self.v));
        let dissipated = c * speed * speed * speed;
        // drag gives f·v in all, of which the current brings in f·u = f·v + dissipated
        let drag = -c * speed * dot(&relative, &v);
        Power { dissipated, supplied: drag + dissipated - self.added_mass * dot(&a, &v), carried: 0.0 }
    }
}
