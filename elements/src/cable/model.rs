//! The choice of models at run time, and the way from it to an element type of its own.

use super::element::{Cable, CableParams};
use super::longitudinal::Longitudinal;
use super::quadrature::{LockingFree, Point, Rule};
use super::transverse::Transverse;
use super::{L4, T3};
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

/// The models of an element: types that make a kernel of their own, or the choices of a [`CableModel`].
#[derive(Clone, Copy, Debug)]
pub struct Models<L, T, Q> {
    /// Axial strain.
    pub longitudinal: L,
    /// Curvature.
    pub transverse: T,
    /// Quadrature.
    pub rule: Q,
}

/// Models that are looked up while the kernel runs.
pub type ChosenModels = Models<LongitudinalModel, TransverseModel, Integration>;

impl<L: Longitudinal, T: Transverse, Q: Rule> Models<L, T, Q> {
    /// These models.
    pub fn new(longitudinal: L, transverse: T, rule: Q) -> Self {
        Models { longitudinal, transverse, rule }
    }
    /// Whether they are known while compiling.
    pub const KNOWN: bool = L::KNOWN && T::KNOWN;
    /// Where the strain is taken.
    #[inline(always)]
    pub fn points(self) -> &'static [Point] {
        self.longitudinal.points(self.rule.axial())
    }
}

impl CableModel {
    /// Its models, if they go together.
    pub fn models(self) -> Result<ChosenModels, String> {
        use LongitudinalModel::{L1, L1n, L2};
        let CableModel { longitudinal, transverse, integration } = self;
        legal(longitudinal, transverse)?;
        // the quadrature of closed forms makes no difference
        let closed = matches!(longitudinal, L1 | L1n | L2);
        let rule = if closed { Integration::LockingFree } else { integration };
        Ok(Models::new(longitudinal, transverse, rule))
    }
}

/// Work to be done with models.
pub trait WithModels {
    /// What comes of it.
    type Output;
    /// Does it.
    fn go<L: Longitudinal, T: Transverse, Q: Rule>(self, models: Models<L, T, Q>) -> Self::Output;
}

/// Does work with the chosen models: the default ones as types, for which fast kernels are compiled, any others as values.
pub fn with_models<W: WithModels>(model: CableModel, work: W) -> Result<W::Output, String> {
    Ok(if model == CableModel::default() {
        work.go(Models::new(L4, T3, LockingFree))
    } else {
        work.go(model.models()?)
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
        fn go<L: Longitudinal, T: Transverse, Q: Rule>(self, models: Models<L, T, Q>) {
            self.0.push(Cable::new(self.1, models), self.2);
        }
    }
    params.check()?;
    with_models(model, Push(sink, params, nodes))
}
