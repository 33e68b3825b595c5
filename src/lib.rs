//! Ropewalk: flexible multibody dynamics of cables, hoses and tethers.
//!
//! A [`Scene`] says what there is: elements, constraints, forces, motions, and what is recorded. It is written as a
//! TOML or JSON file or put together in Rust; [`simulate`] runs it:
//!
//! ```no_run
//! let scene = ropewalk::read("scene.toml")?;
//! let history = ropewalk::simulate(&scene)?;
//! println!("the tension at the end is {:?} N", history.last("hose.end.tension"));
//! # Ok::<(), ropewalk::Error>(())
//! ```
//!
//! The same with more control: [`Scene::build`] makes a [`Model`], and a [`Simulation`] moves it.
//!
//! The parts are crates of their own, and naming them here is what makes their types known to scene files:
//! [`core`] (model, solvers, integrators), [`elements`], [`constraints`], [`forces`], [`models`] (bundled scenes). A
//! crate that adds types of its own offers them with [`cli::main_with`] in the same command line.

mod atlas;
pub mod bench;
mod certificate;
pub mod cli;
mod commands;
mod cost;
mod effects;
mod error;
mod modes;
pub mod output;
mod read;
mod run;
pub mod scene;
mod simulate;
mod study;
mod sweep;
pub mod variants;
pub mod verify;

pub use ropewalk_constraints as constraints;
pub use ropewalk_core as core;
pub use ropewalk_elements as elements;
pub use ropewalk_forces as forces;
pub use ropewalk_models as models;

pub use certificate::{Cause, Certificate, Change};
pub use cost::{CostAdvice, CostOptions, CostOutcome, cost};
pub use effects::{
    Advice, Deed, EffectsOptions, EffectsOutcome, Ledger, Tried, Verdict, effects, write_effects,
};
pub use error::Error;
pub use modes::{Modal, ModesOptions, ModesOutcome, modes, write_modes};
pub use read::{SceneFile, read};
pub use ropewalk_core::integrator::Options;
pub use ropewalk_core::{BuildError, Model, Simulation, State};
pub use ropewalk_models::{Bundled, bundled};
pub use ropewalk_scene::{Air, Builder, MarkerRef, Run, Scene, SceneError, Water};
pub use run::{Every, Manifest, Outcome, RunOptions, resume, run};
pub use simulate::{History, simulate};

/// The program of the README must compile and run.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
