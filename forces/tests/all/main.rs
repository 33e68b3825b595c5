//! Forces against closed forms and differences.

#[cfg(feature = "contact")]
mod bed;
#[cfg(feature = "contact")]
mod contact;
mod drag;
mod free_vessel;
mod functions;
#[cfg(feature = "contact")]
mod level;
#[cfg(feature = "contact")]
mod lines;
mod mounts;
mod on_sections;
mod random;
mod surface;
mod terms;
mod time;
