//! The lift of what floats: a force at a marker, as a term.

use ropewalk::core::BuildError;
use ropewalk::core::error::positive;
use ropewalk::core::held::Held;
use ropewalk::core::{Assembly, At, Energy, Pattern, Term};
use ropewalk::scene::Builder;
use ropewalk::scene::{ForceSpec, MarkerRef, quantity, register_spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// Lift of an upright cylinder that stands in the water: `k s` with the depth `s` of its keel, from 0 where it is out
/// of the water to `k height` where it is under it.
#[derive(Clone, Debug)]
pub struct Waterplane {
    /// A name, such as `float: lift`.
    pub label: String,
    /// Lift per depth `k = ρ g A` [N/m].
    pub k: f64,
    /// Height of the cylinder [m].
    pub height: f64,
    /// Height of the water's surface [m].
    pub surface: f64,
    /// Indices of the keel's vertical coordinate and velocity.
    pub z: (usize, usize),
}

impl Waterplane {
    /// Depth of the keel, and how much of the cylinder is under water [m].
    fn depth(&self, at: &At<'_>) -> (f64, f64) {
        let depth = self.surface - at.q[self.z.0];
        (depth, depth.clamp(0.0, self.height))
    }
}

impl Term for Waterplane {
    fn label(&self) -> String {
        self.label.clone()
    }
    fn pattern(&self, p: &mut Pattern) {
        p.clique([self.z.1]);
    }
    fn add(&self, at: &At<'_>, out: &mut Assembly<'_>) {
        let (depth, wet) = self.depth(at);
        // the residual is inertia less forces, so a lift counts as negative
        out.add(self.z.1, -self.k * wet);
        if out.wants_tangent() && wet == depth {
            let k = out.weights().q * self.k;
            out.add_block(0, 1, |_, _| k);
        }
    }
    fn energy(&self, at: &At<'_>) -> Energy {
        let (depth, wet) = self.depth(at);
        Energy { kinetic: 0.0, potential: self.k * wet * (depth - 0.5 * wet) }
    }
}

/// Lift of an upright cylinder that stands in the water, in proportion to how deep it is in.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WaterplaneSpec {
    /// The marker at its keel.
    pub marker: MarkerRef,
    /// Diameter of the cylinder [m].
    #[serde(deserialize_with = "quantity::length")]
    pub diameter: f64,
    /// Height of the cylinder [m].
    #[serde(deserialize_with = "quantity::length")]
    pub height: f64,
}
register_spec!(Force, "waterplane", WaterplaneSpec);

#[typetag::serde(name = "waterplane")]
impl ForceSpec for WaterplaneSpec {
    fn markers(&self) -> Vec<&MarkerRef> {
        vec![&self.marker]
    }
    fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
        for (name, x) in [("diameter", self.diameter), ("height", self.height)] {
            positive(name, x)?;
        }
        let marker = b.marker("marker", &self.marker)?;
        let Held::Moves { q, v } = Held::new(b.nodes(), &marker, "waterplane")? else {
            return Err(BuildError::at("marker", "a waterplane needs a marker on something that can float"));
        };
        let (water, [_, _, g]) = (b.water()?, b.gravity());
        let Some(surface) = water.level else {
            return Err(BuildError::at("type", "a waterplane needs a surface: give [water] a `level`"));
        };
        let k = -water.density * g * PI * self.diameter * self.diameter / 4.0;
        let label = format!("{}: lift", self.marker);
        b.term(Box::new(Waterplane { label, k, height: self.height, surface, z: (q + 2, v + 2) }));
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ropewalk::core::testing::check_tangent;
    use ropewalk::core::{Node, NodeKind, Width};

    #[test]
    fn tangent_is_that_of_the_lift_in_under_and_above_the_water() {
        let nodes = [Node { kind: NodeKind::Point, q: 0, v: 0, shared: false }];
        let term = Waterplane { label: "lift".into(), k: 30.0, height: 2.0, surface: 0.5, z: (2, 2) };
        for (z, lift) in [(-0.7, 36.0), (-3.0, 60.0), (0.9, 0.0)] {
            let q = [1.0, 2.0, z];
            let at = At { t: 0.0, q: &q, v: &[0.0; 3], a: &[0.0; 3], internal: &[], relaxed: None };
            assert!(check_tangent(&term, &nodes, &at, Width::One) < 1e-8);
            // and the lift is what the energy falls by
            let energy = |dz: f64| term.energy(&At { q: &[1.0, 2.0, z + dz], ..at }).potential;
            let slope = (energy(1e-6) - energy(-1e-6)) / 2e-6;
            assert!((slope + lift).abs() < 1e-6, "{slope} at {z}");
        }
    }
}
