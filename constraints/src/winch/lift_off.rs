//! Where a cable lifts off from a package.

use super::{Limit, Peel, Side};
use crate::check::unit;
use crate::package::{Lay, Package, PackageSpec};
use crate::pair::kind;
use ropewalk_core::error::{not_negative, positive};
use ropewalk_core::rotation::{around, cross};
use ropewalk_core::{
    Arrow, At, BuildError, Constraint, Equation, Feed, Joint, Marker, MovingBoundary, Node, NodeId, NodeKind,
    RowKind, Solid, V3, dot,
};
use ropewalk_scene::{Builder, ConstraintSpec, MarkerRef, quantity, register_spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// The end of a cable is where its package has it: `r - H(σ) = 0`, with the length `σ` that has been fed out there; three
/// equations. With `tangent` the cable goes on along the wound layer, `r' ∥ H'(σ)`, two more.
///
/// Cable that is wound is at rest. What peels it is told by the winch at the same end: a speed, or a force; or by a [`Peel`].
#[derive(Clone, Debug)]
pub struct LiftOff {
    name: String,
    boundary: MovingBoundary,
    marker: [Marker; 1],
    nodes: [NodeId; 2],
    package: Arc<Package>,
    tangent: bool,
}

const ROWS: [RowKind; 5] =
    [RowKind::Position, RowKind::Position, RowKind::Position, RowKind::Direction, RowKind::Direction];

impl LiftOff {
    /// Lifts off at this end.
    pub fn new(
        name: impl Into<String>,
        boundary: MovingBoundary,
        package: Arc<Package>,
        tangent: bool,
    ) -> Self {
        let (marker, nodes) = ([Marker::node(boundary.end)], [boundary.end, boundary.node]);
        LiftOff { name: name.into(), boundary, marker, nodes, package, tangent }
    }

    /// The lift-off point now; beyond the end of the cable it goes straight on, so that the run gets to see the end.
    fn lay(&self, sigma: f64) -> Lay {
        let end = self.package.wound();
        let at = |sigma: f64| {
            let none = [f64::NAN; 3];
            self.package.at(sigma).unwrap_or(Lay { x: none, tangent: none, curvature: none })
        };
        if sigma > end {
            let last = at(end);
            let x = std::array::from_fn(|i| last.x[i] + (sigma - end) * last.tangent[i]);
            return Lay { x, curvature: [0.0; 3], ..last };
        }
        at(sigma)
    }

    /// Which of the velocities of its nodes is that of the boundary, behind those of the cable's node.
    fn last(&self, nodes: &[Node]) -> usize {
        nodes[self.nodes[0].0 as usize].kind.velocities()
    }

    /// How the curvature changes; by differences, since a package has two continuous derivatives only.
    fn twist(&self, sigma: f64) -> V3<f64> {
        let h = 1e-4 * self.package.spec().radius;
        let (a, b) = (self.lay(sigma - h).curvature, self.lay(sigma + h).curvature);
        std::array::from_fn(|i| (b[i] - a[i]) / (2.0 * h))
    }

    fn slope(&self, x: &[f64], at: usize) -> V3<f64> {
        std::array::from_fn(|i| x[at + 3 + i])
    }

    /// Derivatives of the two equations of direction, by `r'`, and by `σ` of that: `d_1 = a - (a·h) h`, `d_2 = h × a` for the
    /// axis `a`.
    fn directions(&self, lay: &Lay) -> [[V3<f64>; 2]; 2] {
        let (a, h, k) = (self.package.axis(), lay.tangent, lay.curvature);
        let (along, change) = (dot(&a, &h), dot(&a, &k));
        [
            [std::array::from_fn(|i| a[i] - along * h[i]), cross(&h, &a)],
            [std::array::from_fn(|i| -change * h[i] - along * k[i]), cross(&k, &a)],
        ]
    }

    /// Second derivatives of all equations by `σ`.
    fn seconds(&self, sigma: f64, lay: &Lay, slope: &V3<f64>) -> [f64; 5] {
        let mut out = [0.0; 5];
        for i in 0..3 {
            out[i] = -lay.curvature[i];
        }
        if self.tangent {
            let (a, h, k, t) = (self.package.axis(), lay.tangent, lay.curvature, self.twist(sigma));
            out[3] = -dot(&a, &t) * dot(&h, slope)
                - 2.0 * dot(&a, &k) * dot(&k, slope)
                - dot(&a, &h) * dot(&t, slope);
            out[4] = dot(&cross(&t, &a), slope);
        }
        out
    }
}

impl Constraint for LiftOff {
    fn name(&self) -> &str {
        &self.name
    }
    fn rows(&self) -> &[RowKind] {
        if self.tangent { &ROWS } else { &ROWS[..3] }
    }
    fn markers(&self) -> &[Marker] {
        &self.marker
    }
    fn nodes(&self) -> &[NodeId] {
        &self.nodes
    }
    fn linear(&self) -> bool {
        false
    }
    fn jacobian(&self, nodes: &[Node], at: &At<'_>, g: &mut [f64], jac: &mut [f64]) {
        let (sigma, sign) = (self.boundary.fed(at), self.boundary.sign);
        let (lay, last) = (self.lay(sigma), self.last(nodes));
        let width = last + 1;
        jac.fill(0.0);
        for i in 0..3 {
            g[i] = at.q[self.boundary.end_q + i] - lay.x[i];
            jac[width * i + i] = 1.0;
            jac[width * i + last] = -sign * lay.tangent[i];
        }
        if self.tangent {
            let slope = self.slope(at.q, self.boundary.end_q);
            let [d, by_sigma] = self.directions(&lay);
            for r in 0..2 {
                g[3 + r] = dot(&d[r], &slope);
                jac[width * (3 + r) + 3..width * (3 + r) + 6].copy_from_slice(&d[r]);
                jac[width * (3 + r) + last] = sign * dot(&by_sigma[r], &slope);
            }
        }
    }
    fn solids(&self) -> Vec<Solid> {
        vec![self.package.solid(&self.name)]
    }
    fn geometric(&self, nodes: &[Node], at: &At<'_>, lambda: &[f64], h: &mut [f64]) {
        let (sigma, sign) = (self.boundary.fed(at), self.boundary.sign);
        let (lay, slope) = (self.lay(sigma), self.slope(at.q, self.boundary.end_q));
        let last = self.last(nodes);
        let width = last + 1;
        h.fill(0.0);
        let seconds = self.seconds(sigma, &lay, &slope);
        h[width * last + last] = seconds.iter().zip(lambda).map(|(s, l)| s * l).sum();
        if self.tangent {
            let [_, by_sigma] = self.directions(&lay);
            for i in 0..3 {
                let mixed = sign * (lambda[3] * by_sigma[0][i] + lambda[4] * by_sigma[1][i]);
                h[width * (3 + i) + last] = mixed;
                h[width * last + 3 + i] = mixed;
            }
        }
    }
    fn rates(&self, _: &[Node], at: &At<'_>, rate: &mut [f64], bias: &mut [f64]) {
        let (sigma, u) = (self.boundary.fed(at), self.boundary.rate(at));
        let (lay, slope) = (self.lay(sigma), self.slope(at.q, self.boundary.end_q));
        rate.fill(0.0);
        let seconds = self.seconds(sigma, &lay, &slope);
        for (bias, second) in bias.iter_mut().zip(seconds) {
            *bias = second * u * u;
        }
        if self.tangent {
            let (turning, [_, by_sigma]) = (self.slope(at.v, self.boundary.end_v), self.directions(&lay));
            for r in 0..2 {
                bias[3 + r] += 2.0 * u * dot(&by_sigma[r], &turning);
            }
        }
    }
}

/// The lift-off point of a cable from a package. It runs round the package as the cable unwinds.
///
/// A `winch` at the same end drives the unwinding: by `speed` or `motion`, or by the `tension` at the package. Or,
/// without a winch, the cable sticks to the package with `adhesion_energy`. The other end needs an `eyelet`. A cable
/// with torsion leaves the layer as it lies there: each wrap that is pulled off over the end of the package brings it a turn. Events
/// are reported on the way: a tension too low to keep the cable taut, contact with the package, too much bending.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LiftOffSpec {
    /// Name; records of the reaction refer to it.
    pub name: String,
    /// The wound end of the cable: `fibre.end` or `fibre.start`.
    pub marker: MarkerRef,
    /// The package.
    pub package: PackageSpec,
    /// Whether the cable is tangent to the wound layer at the lift-off point. Needs bending stiffness.
    #[serde(default)]
    pub tangent: bool,
    /// Adhesion energy `Γ` per length [J/m], instead of a winch at this end. A `tangent` cable lifts off where
    /// `EI (κ - κ_w)²/2 = Γ`, with the curvature `κ_w` of the wound cable; another one at the angle `D` with
    /// `T (1 - cos D) = Γ`.
    #[serde(
        default,
        deserialize_with = "quantity::optional::force",
        skip_serializing_if = "Option::is_none"
    )]
    pub adhesion_energy: Option<f64>,
    /// Slip speed [m/s]: below it the adhesion creeps instead of sticking. Goes with `adhesion_energy`.
    #[serde(default = "slip_speed", deserialize_with = "quantity::speed")]
    pub slip_speed: f64,
}
register_spec!(Constraint, "lift_off", LiftOffSpec);

fn slip_speed() -> f64 {
    1e-3
}

impl LiftOffSpec {
    /// Holds the section of a cable with torsion as it lies on the package: one of its vectors stays at right angles to the axis.
    /// So the section goes round once with each wrap.
    fn holds(&self, b: &Builder, boundary: MovingBoundary, package: &Package) -> Result<Joint, BuildError> {
        if !self.tangent {
            let message = "a cable with torsion is held against twisting by the wound layer where it goes on along that: give \
                           `tangent = true`, or leave `gj` out";
            return Err(BuildError::at("tangent", message));
        }
        let (axis, node) = (package.axis(), Marker::node(boundary.end));
        let t = b.place(&node).axes[2];
        let across = unit("marker", cross(&t, &axis)).map_err(|_| {
            BuildError::at(
                "marker",
                "it leaves the package along its axis: lay it along the wound layer there",
            )
        })?;
        let held = node.with_axes(b.nodes(), b.coordinates(), [across, cross(&t, &across), t]);
        let ground = Marker::Ground { point: [0.0; 3], axes: around(axis) };
        let (a, b_) = (Arrow::Axis { of: 0, axis: 2 }, Arrow::Axis { of: 1, axis: 0 });
        let equation = Equation::Dot { a, b: b_, value: 0.0, motion: None };
        Joint::new(format!("{}.twist", self.name), b.nodes(), [ground, held], vec![equation])
    }

    /// Lifts off from a package, peeled by a winch.
    pub fn new(name: &str, marker: impl Into<MarkerRef>, package: PackageSpec) -> Self {
        let (name, marker) = (name.into(), marker.into());
        LiftOffSpec { name, marker, package, tangent: false, adhesion_energy: None, slip_speed: slip_speed() }
    }
}

#[typetag::serde(name = "lift_off")]
impl ConstraintSpec for LiftOffSpec {
    fn name(&self) -> &str {
        &self.name
    }
    fn markers(&self) -> Vec<&MarkerRef> {
        vec![&self.marker]
    }
    fn feeds(&self) -> Option<(&MarkerRef, Feed)> {
        self.adhesion_energy.map(|_| (&self.marker, Feed { unstrained: true, ..Feed::default() }))
    }
    fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
        let package = Arc::new(self.package.build()?);
        let boundary = b.boundary(&self.marker, "add a `winch` or `eyelet` there, or give `peel`")?;
        let part = b.feeding_part(&self.marker)?;
        positive("slip_speed", self.slip_speed)?;
        if let Some(energy) = self.adhesion_energy {
            let ei = part.slender().map_or(0.0, |s| s.ei);
            if self.tangent && ei == 0.0 {
                let message = "a cable without bending stiffness that goes on along the wound layer has nothing to peel it \
                               off: leave out `tangent`, or give the cable an `ei`";
                return Err(BuildError::at("tangent", message));
            }
            let (name, energy) = (self.name.clone(), not_negative("adhesion_energy", energy)?);
            let package = package.clone();
            b.term(Box::new(Peel { name, boundary, package, energy, slip_speed: self.slip_speed, ei }));
        }
        b.event(Limit {
            name: self.name.clone(),
            boundary,
            part: part.name().to_string(),
            side: Side::Empty,
            length: package.wound(),
        });
        if kind(b, &Marker::node(boundary.end)) == Some(NodeKind::Twist) {
            b.constraint(self.holds(b, boundary, &package)?)?;
        }
        super::conditions::watch(b, &self.name, part.name(), boundary, &package);
        b.constraint(LiftOff::new(&self.name, boundary, package, self.tangent))
    }
}
