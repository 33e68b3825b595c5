//! Cables through whose elements material flows: cables that grow and shrink at their ends.
//!
//! The nodes of such a cable aren't fixed to its material. A node stands at the material coordinate `p` (unstretched
//! length along the line), and these coordinates follow the ends of the line, its *boundaries* `π`: `p = c + B π` with a
//! constant `B` ([`Embedding`]). A boundary is an unknown of the model like any other, so that a winch is a constraint
//! on it and a brake a force on it; what is fed out has moved the boundary back.
//!
//! The curve of an element is the same cubic as always. Material velocity and acceleration are cubics too, given by
//! their values at the nodes ([`Transport`]), and so is the virtual displacement of the material: a force on the
//! material with the consistent nodal vector `F` acts on the boundary by a [rule](close) that is the same for all.
//!
//! The equations are d'Alembert's principle at fixed material points, so no flux stands at the ends; the elastic
//! energy of what passes an open end does ([`FlowEnd`]), unless it is free of strain outside. There is no `m V²` in the tension of a hanging cable.

mod axial_damping;
pub(super) mod change;
mod damping;
mod directed;
mod element;
mod embedding;
mod end;
mod line;
pub(super) mod prestrain;
pub(super) mod push;
mod rule;
mod spin;
mod stations;
mod torque_tension;
mod torsion;
mod transport;
pub(super) mod turning;
mod weight;

pub use axial_damping::FlowAxialDamping;
pub use damping::{FlowDamping, Material};
pub use directed::FlowDirected;
pub use element::FlowCable;
pub use embedding::{Embedding, Grid};
pub use end::FlowEnd;
pub use line::{Follows, Line};
pub use rule::close;
pub use spin::FlowSpin;
pub use stations::FlowStations;
pub use torque_tension::FlowTorqueTension;
pub use torsion::FlowTorsion;
pub use transport::Transport;
pub use weight::FlowWeight;

/// Implements `Element` for a type with `F` boundaries, once for each number of boundaries that a line can have: constants
/// can't be computed from each other in the types of a trait.
macro_rules! for_fronts {
    ($(($boundaries:literal, $size:literal)),+; $body:ident) => {
        $($body!($boundaries, $size);)+
    };
}
pub(crate) use for_fronts;
