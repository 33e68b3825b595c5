//! What is done with scenes: single runs and many, and the questions that many runs answer.
//!
//! [`run`] runs a scene into a folder, [`simulate`] into memory. On these stand [`sweep`] (parameters varied), [`cost`]
//! (what accuracy costs in time), [`effects`] (what each effect of a scene changes), [`certificate`] (how far results can
//! be trusted), [`statistics`] (what a long run says), [`modes`], [`linearise`], [`variants`], [`verify`], [`bench`] and [`atlas`].

pub mod atlas;
pub mod bench;
pub mod certificate;
pub mod cost;
pub mod effects;
mod error;
pub mod figure;
pub mod fmu;
pub mod linearise;
pub mod modes;
pub mod run;
mod session;
pub mod simulate;
pub mod statistics;
pub mod study;
pub mod sweep;
pub mod variants;
pub mod verify;

pub use error::Error;
pub use session::{Session, Snapshot};
