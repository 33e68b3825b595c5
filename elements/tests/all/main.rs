//! Elements against references that are not this code.

mod axial_damping;
mod clamp;
mod common;
mod directed;
mod flow;
mod flow_directed;
mod flow_rope;
mod flow_torsion;
mod law;
mod lay;
mod mesh;
mod oracle;
mod path;
mod point_mass;
mod pools;
mod rigid_body;
mod rigid_chain;
mod torsion;
mod transmitted;
mod unfold;
