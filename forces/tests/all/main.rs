//! Forces against closed forms and differences.

#[cfg(feature = "contact")]
mod contact;
mod drag;
mod mounts;
mod random;
mod surface;
mod terms;
