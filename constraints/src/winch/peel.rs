//! Peeling at a given energy: cable that sticks to its package.

use crate::package::Package;
use ropewalk_core::{Assembly, At, Energy, Front, Pattern, Power, Term, dot};
use std::sync::Arc;

/// Holds back an end that lifts off by what peeling costs: the energy of the bond, less that of the bending which the
/// wound cable gives free; as force on the front `Γ - EI κ_w²/2`.
///
/// With a cable that goes on along the wound layer its equation says what fracture mechanics does,
/// `EI |κ - κ_w|²/2 = Γ` up to the strain energy of stretching, with the curvatures `κ` of the free and `κ_w` of the wound
/// cable at the lift-off point, as vectors: variation of the lift-off point in the energy of both. It holds while cable is peeled; cable
/// that is laid on again is taken to stick as well.
#[derive(Clone, Debug)]
pub struct Peel {
    /// Name of the lift-off.
    pub name: String,
    /// The end that lifts off.
    pub front: Front,
    /// What it lifts off from.
    pub package: Arc<Package>,
    /// Energy of the bond per length `Γ` [J/m].
    pub energy: f64,
    /// Bending stiffness [N m²].
    pub ei: f64,
}

impl Peel {
    /// The force that holds back, where a length has been peeled.
    fn pull(&self, peeled: f64) -> f64 {
        // beyond the end of the package the run ends
        let wound = self
            .package
            .at(peeled.min(self.package.wound()))
            .map_or(f64::NAN, |lay| dot(&lay.curvature, &lay.curvature));
        self.energy - 0.5 * self.ei * wound
    }
    fn slope(&self, peeled: f64) -> f64 {
        let h = 1e-4 * self.package.spec().radius;
        (self.pull(peeled + h) - self.pull(peeled - h)) / (2.0 * h)
    }
}

impl Term for Peel {
    fn label(&self) -> String {
        format!("{}.peel", self.name)
    }
    fn pattern(&self, p: &mut Pattern) {
        p.clique([self.front.v]);
    }
    fn add(&self, at: &At<'_>, out: &mut Assembly<'_>) {
        let peeled = self.front.fed(at);
        out.add(self.front.v, self.front.sign * self.pull(peeled));
        if out.wants_tangent() {
            let w = out.weights().q * self.slope(peeled);
            out.add_block(0, 1, |_, _| w);
        }
    }
    fn energy(&self, _: &At<'_>) -> Energy {
        Energy::default()
    }
    fn power(&self, at: &At<'_>) -> Power {
        let (peeled, u) = (self.front.fed(at), self.front.rate(at));
        // the bond takes its energy; the wound cable brings that of its bending along
        let brought = self.energy - self.pull(peeled);
        Power { dissipated: self.energy * u, supplied: brought * u, ..Power::default() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::package::PackageSpec;
    use ropewalk_core::testing::check_tangent;
    use ropewalk_core::{Node, NodeId, NodeKind, Width};

    #[test]
    fn tangent_agrees_with_differences_within_a_layer_and_between_two() {
        let nodes = [Node { kind: NodeKind::Scalars(1), q: 0, v: 0, shared: true }];
        let package = Arc::new(
            PackageSpec { layers: 2, ..PackageSpec::new(0.06, 0.02, 0.009) }.build().expect("package"),
        );
        for (sign, peeled) in [(1.0, 0.1), (-1.0, 0.75), (1.0, 0.8)] {
            let front = Front {
                node: NodeId(0),
                q: 0,
                v: 0,
                sign,
                home: 0.0,
                end: NodeId(0),
                end_q: 0,
                end_v: 0,
                rho_a: 1.0,
            };
            let peel = Peel { name: "off".into(), front, package: package.clone(), energy: 0.3, ei: 0.002 };
            let (q, v) = ([sign * peeled], [0.4 * sign]);
            let at = At { t: 0.0, q: &q, v: &v, a: &[0.0], modes: &[], relaxed: None };
            assert!(check_tangent(&peel, &nodes, &at, Width::One) < 1e-6, "{peeled}");
        }
    }
}
