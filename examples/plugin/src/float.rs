//! A body that makes waves: an element of one coordinate triple, with its part.

use ropewalk::core::BuildError;
use ropewalk::core::error::{not_negative, positive};
use ropewalk::core::{
    At, Batch, DeadEntry, DeadLoad, Element, Energy, Local, Marker, Node, NodeId, NodeKind, Part, Per, Power,
    Real, Share, Spot, Term, V3, Weights, dot,
};
use ropewalk::scene::Builder;
use ropewalk::scene::{ElementSpec, quantity, register_spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Inertia and a resistance proportional to velocity: `m a + c v`.
#[derive(Clone, Copy, Debug)]
pub struct Float {
    /// Mass [kg].
    pub mass: f64,
    /// Force per velocity [N s/m].
    pub resistance: f64,
}

impl Element<3, 3> for Float {
    type Lanes<R: Real> = [R; 2];
    fn label(&self) -> String {
        "float".into()
    }
    #[inline(always)]
    fn lanes<R: Real>(b: &Batch<'_, Self>) -> [R; 2] {
        [b.get(|e| e.mass), b.get(|e| e.resistance)]
    }
    #[inline(always)]
    fn add<R: Real, const TANGENT: bool>(
        &[mass, c]: &[R; 2],
        x: &Local<R, 3, 3>,
        w: &Weights,
        out: &mut Share<R, 3>,
    ) {
        for i in 0..3 {
            out.r[i] += mass * x.a[i] + c * x.v[i];
            if TANGENT {
                out.k[i][i] += R::of(w.a) * mass + R::of(w.v) * c;
            }
        }
    }
    #[inline(always)]
    fn energy<R: Real>(&[mass, _]: &[R; 2], x: &Local<R, 3, 3>) -> Energy<R> {
        Energy { kinetic: R::of(0.5) * mass * dot(&x.v, &x.v), ..Energy::zero() }
    }
    #[inline(always)]
    fn power<R: Real>(&[_, c]: &[R; 2], x: &Local<R, 3, 3>) -> Power<R> {
        Power { dissipated: c * dot(&x.v, &x.v), ..Power::zero() }
    }
}

/// A float that loses energy to the waves that it makes. Marker: `name`, at its keel.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FloatSpec {
    /// Name by which the rest of the scene refers to it.
    pub name: String,
    /// Where its keel starts [m].
    #[serde(deserialize_with = "quantity::vec3::length")]
    pub at: V3<f64>,
    /// Mass, with the water that moves along [kg].
    #[serde(deserialize_with = "quantity::mass")]
    pub mass: f64,
    /// Resistance: force per velocity [N s/m].
    #[serde(default, deserialize_with = "quantity::damping")]
    pub resistance: f64,
}
register_spec!(Element, "float", FloatSpec);

#[typetag::serde(name = "float")]
impl ElementSpec for FloatSpec {
    fn name(&self) -> &str {
        &self.name
    }
    fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
        positive("mass", self.mass)?;
        not_negative("resistance", self.resistance)?;
        let id = b.node(NodeKind::Point, &self.at, &[0.0; 3])?;
        b.element(Float { mass: self.mass, resistance: self.resistance }, &[id])?;
        let node = b.nodes()[id.0 as usize];
        b.part(Arc::new(FloatPart { name: self.name.clone(), id, node, mass: self.mass }))
    }
}

/// A float as a part of a model: what markers, weight and pictures ask of it.
struct FloatPart {
    name: String,
    id: NodeId,
    node: Node,
    mass: f64,
}

impl FloatPart {
    fn three(&self, x: &[f64], from: usize) -> V3<f64> {
        std::array::from_fn(|i| x[from + i])
    }
}

impl Part for FloatPart {
    fn name(&self) -> &str {
        &self.name
    }
    fn kind(&self) -> &'static str {
        "float"
    }
    fn marker(&self, spot: &Spot) -> Result<Marker, String> {
        match spot {
            Spot::Named(n) if n.is_empty() => Ok(Marker::node(self.id)),
            _ => Err(format!("a float has only one place: `{}`", self.name)),
        }
    }
    fn dead_load(&self, per: Per, load: V3<f64>) -> Option<Box<dyn Term>> {
        // what it displaces changes as it moves: not a dead load
        let Per::Mass = per else { return None };
        let entry =
            |i| DeadEntry { dof: self.node.v + i, coordinate: self.node.q + i, value: self.mass * load[i] };
        let load = DeadLoad::new(format!("{}: weight", self.name), (0..3).map(entry).collect()).ok()?;
        Some(Box::new(load))
    }
    fn point(&self, _: f64, at: &At<'_>) -> Option<(V3<f64>, V3<f64>)> {
        Some((self.three(at.q, self.node.q), self.three(at.v, self.node.v)))
    }
    fn length(&self) -> f64 {
        0.0
    }
    fn place_of(&self, node: NodeId) -> Option<String> {
        (node == self.id).then(String::new)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ropewalk::core::testing::check_tangent;
    use ropewalk::core::{Pool, Width};

    #[test]
    fn tangent_is_that_of_the_residual_at_every_width() {
        let nodes = [Node { kind: NodeKind::Point, q: 0, v: 0, shared: false }];
        let (q, v, a) = ([1.0, 2.0, -0.4], [0.3, -0.7, 0.2], [2.0, 0.5, -1.0]);
        let at = At { t: 0.0, q: &q, v: &v, a: &a, internal: &[], relaxed: None };
        let mut pool = Pool::new();
        assert!(pool.push(&nodes, Float { mass: 2.0, resistance: 0.3 }, &[NodeId(0)]));
        for width in [Width::One, Width::Four, Width::Eight] {
            assert!(check_tangent(&pool, &nodes, &at, width) < 1e-8);
        }
    }
}
