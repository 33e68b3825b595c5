//! Cable elements in the absolute nodal coordinate formulation (ANCF).
//!
//! - [`shape`], [`quadrature`], [`reduced`]: the curve, and the nine natural variables in which kernels work.
//! - [`longitudinal`] with L1 … L4 and [`transverse`] with T1 … T3: the strain measures, a file for each.
//! - [`Cable`]: elastic force and mass. [`CableModel`] chooses its models at run time, [`push_cable`] makes it.
//! - [`Torsion`] and [`Directed`]: twist, and bending with a direction, beside it on nodes that know them.

mod bending_damping;
mod building;
mod chosen;
mod damping;
mod directed;
mod elastic;
mod element;
pub mod flow;
mod guess;
mod l1;
mod l1n;
mod l2;
mod l3;
mod l4;
pub(crate) mod law;
mod layout;
mod lever;
pub mod longitudinal;
mod loops;
pub(crate) mod mesh;
mod model;
mod output;
mod part;
pub mod quadrature;
pub mod reduced;
mod relaxed;
mod remesh;
mod rest;
pub(crate) mod route;
mod section;
mod section_damping;
mod sections;
pub mod shape;
mod spec;
mod spin;
mod splice;
mod stations;
mod stiffness;
mod t1;
mod t2;
mod t3;
mod torque_tension;
mod torsion;
pub(crate) mod transmitted;
pub mod transverse;
mod twisted;
mod twisting;
pub(crate) mod unfold;

pub use bending_damping::{BendingDamping, BendingDampingLanes};
pub use damping::{AxialDamping, AxialDampingLanes};
pub use directed::{Directed, DirectedLanes, DirectedParams};
pub use element::{Cable, CableLanes, CableParams, mass};
pub use l1::L1;
pub use l1n::L1n;
pub use l2::L2;
pub use l3::L3;
pub use l4::L4;
pub use law::{AxialForce, BendingMoment};
pub use lever::LeverSpec;
pub use mesh::{Grading, MeshSpec};
pub use model::{
    CableModel, ChosenModels, Integration, LongitudinalModel, Models, Sink, TransverseModel, WithModels,
    legal, push_cable, with_models,
};
pub use output::{Reading, read};
pub use part::CablePart;
pub use quadrature::{Full, LockingFree};
pub use rest::{AxialRest, BendingRest, Rest, RestLanes, push_rest};
pub use route::Waypoint;
pub use section::{Section, SectionAlong};
pub use section_damping::{SectionDamping, SectionDampingLanes};
pub use spec::{CableSpec, StressFree};
pub use spin::{SpinInertia, SpinInertiaLanes};
pub use stations::CableStations;
pub use stiffness::BendingStiffness;
pub use t1::T1;
pub use t2::T2;
pub use t3::T3;
pub use torque_tension::{TorqueTension, TorqueTensionLanes};
pub use torsion::{Torsion, TorsionDamping, TorsionDampingLanes, TorsionParams};
