//! The choice of models at run time, and the way from it to an element type of its own.

use super::element::{Cable, CableParams};
use super::longitudinal::Longitudinal;
use super::quadrature::{Full, LockingFree, Rule};
use super::transverse::Transverse;
use super::{L1, L1n, L2, L3, L4, T1, T2, T3};
use ropewalk_core::{Element, NodeId};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Which axial strain; see the type of the same name.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
pub enum LongitudinalModel {
    /// Strain of the chord.
    L1,
    /// The same with the strain frozen; not conservative.
    L1n,
    /// Mean Green strain.
    L2,
    /// Green strain.
    L3,
    /// Engineering strain.
    #[default]
    L4,
}

/// Which curvature; see the type of the same name.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
pub enum TransverseModel {
    /// Second derivative.
    T1,
    /// Curvature of geometry.
    T2,
    /// Turning of the tangent along the material.
    #[default]
    T3,
}

/// Which quadrature. Makes no difference to the closed forms L1, L1n, L2 and T1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Integration {
    /// Five Gauss points for each part.
    Full,
    /// Three Lobatto points for the strain, two Gauss points for the curvature.
    #[default]
    LockingFree,
}

/// The models of a cable. The default, L4 + T3 locking-free, suits nearly everything.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct CableModel {
    /// Axial strain.
    pub longitudinal: LongitudinalModel,
    /// Curvature.
    pub transverse: TransverseModel,
    /// Quadrature.
    pub integration: Integration,
}

/// Whether two models go together, and if not, why.
pub fn legal(l: LongitudinalModel, t: TransverseModel) -> Result<(), String> {
    use LongitudinalModel::{L1, L1n, L2};
    if matches!(l, L1 | L1n | L2) && t != TransverseModel::T1 {
        return Err(format!(
            "{l:?} with {t:?} leaves a straight cable of n elements with n + 1 modes that cost no energy: {l:?} has \
             one strain per element, {t:?} doesn't resist a stretch that varies along it, so nothing holds the \
             lengths of the slopes; use {l:?} with T1, or L3 or L4 with {t:?}"
        ));
    }
    Ok(())
}

/// Takes elements of whatever type, one pool for each type.
pub trait Sink {
    /// Puts an element on these nodes.
    fn push<E: Element<12, 12>>(&mut self, element: E, nodes: &[NodeId]);
}

/// Work to be done with the models as types.
pub trait WithModels {
    /// What comes of it.
    type Output;
    /// Does it.
    fn go<L: Longitudinal, T: Transverse, Q: Rule>(self) -> Self::Output;
}

/// Does work with the chosen models as types. Only legal pairs exist as types.
pub fn with_models<W: WithModels>(model: CableModel, work: W) -> Result<W::Output, String> {
    use {LongitudinalModel as L, TransverseModel as T};
    legal(model.longitudinal, model.transverse)?;
    let full = model.integration == Integration::Full;
    Ok(match (model.longitudinal, model.transverse, full) {
        // closed forms: the rule would only double the code
        (L::L1, ..) => work.go::<L1, T1, LockingFree>(),
        (L::L1n, ..) => work.go::<L1n, T1, LockingFree>(),
        (L::L2, ..) => work.go::<L2, T1, LockingFree>(),
        (L::L3, T::T1, true) => work.go::<L3, T1, Full>(),
        (L::L3, T::T2, true) => work.go::<L3, T2, Full>(),
        (L::L3, T::T3, true) => work.go::<L3, T3, Full>(),
        (L::L4, T::T1, true) => work.go::<L4, T1, Full>(),
        (L::L4, T::T2, true) => work.go::<L4, T2, Full>(),
        (L::L4, T::T3, true) => work.go::<L4, T3, Full>(),
        (L::L3, T::T1, false) => work.go::<L3, T1, LockingFree>(),
        (L::L3, T::T2, false) => work.go::<L3, T2, LockingFree>(),
        (L::L3, T::T3, false) => work.go::<L3, T3, LockingFree>(),
        (L::L4, T::T1, false) => work.go::<L4, T1, LockingFree>(),
        (L::L4, T::T2, false) => work.go::<L4, T2, LockingFree>(),
        (L::L4, T::T3, false) => work.go::<L4, T3, LockingFree>(),
    })
}

/// Pushes a cable element of the chosen models; refuses illegal pairs and impossible properties.
pub fn push_cable(
    sink: &mut impl Sink,
    model: CableModel,
    params: CableParams,
    nodes: &[NodeId],
) -> Result<(), String> {
    struct Push<'a, S>(&'a mut S, CableParams, &'a [NodeId]);
    impl<S: Sink> WithModels for Push<'_, S> {
        type Output = ();
        fn go<L: Longitudinal, T: Transverse, Q: Rule>(self) {
            self.0.push(Cable::<L, T, Q>::new(self.1), self.2);
        }
    }
    params.check()?;
    with_models(model, Push(sink, params, nodes))
}
