//! Contact with shapes: penalty, damping, friction.
//!
//! Cables and bodies touch by balls ([`ContactPoint`](ropewalk_core::ContactPoint)s); a [`Shape`] tells how far away
//! its surface is and how it is curved there, the [`ContactLaw`] what force follows, and [`Contact`] puts both into the
//! equations of motion.

mod file;
mod law;
mod mesh;
mod shape;
mod spec;
mod term;
mod touch;

pub use file::read;
pub use law::{ContactLaw, Damping, Leaving};
pub use mesh::{MOST_TRIANGLES, Mesh, Soup};
pub use shape::{Gap, Shape};
pub use spec::{ContactSpec, Overlap, ShapeSpec};
pub use term::Contact;
