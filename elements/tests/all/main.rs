//! Elements against references that are not this code.

mod clamp;
mod common;
mod directed;
mod flow;
mod oracle;
mod point_mass;
mod pools;
mod rigid_body;
mod rigid_chain;
