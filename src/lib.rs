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
//! A [`Session`] is moved from outside, step by step, with its records by name:
//!
//! ```
//! let file = ropewalk::SceneFile::open("pendulum", &["duration=0.2 s".into()], ropewalk::bundled())?;
//! let mut session = ropewalk::Session::start(file, ropewalk::Watch::default())?;
//! session.advance(0.1)?;
//! let (here, z) = (session.snapshot()?, session.value("cable.end.z")?);
//! session.advance(0.2)?;
//! assert!(session.value("cable.end.z")? < z);
//! session.restore(here)?;
//! assert_eq!((session.t(), session.value("cable.end.z")?), (0.1, z));
//! # Ok::<(), ropewalk::Error>(())
//! ```
//!
//! With still more control [`Scene::build`] makes a [`Model`], and a [`Simulation`] moves it.
//!
//! The parts are crates of their own, and naming them here is what makes their types known to scene files: [`core`]
//! (model, solvers, integrators), [`scene`] (the language of scenes), [`elements`], [`constraints`], [`forces`],
//! [`models`] (bundled scenes), [`studies`] (runs and what is asked of many of them), [`report`] (folders, tables,
//! pictures). A crate that adds types of its own offers them with [`cli::main_with`] in the same command line.

pub mod cli;
mod commands;

pub use ropewalk_constraints as constraints;
pub use ropewalk_core as core;
pub use ropewalk_elements as elements;
pub use ropewalk_forces as forces;
pub use ropewalk_models as models;
pub use ropewalk_report as report;
pub use ropewalk_scene as scene;
pub use ropewalk_studies as studies;

pub use ropewalk_core::integrator::Options;
pub use ropewalk_core::{BuildError, Model, Simulation, State};
pub use ropewalk_models::{bundled, gallery, scenes};
pub use ropewalk_report::Watch;
pub use ropewalk_scene::{Air, Builder, Bundled, MarkerRef, Run, Scene, SceneError, SceneFile, Water};
pub use ropewalk_studies::certificate::{Cause, Certificate, Change, certify_scene};
pub use ropewalk_studies::cost::{CostAdvice, CostOptions, CostOutcome, cost, cost_of};
pub use ropewalk_studies::effects::{
    Advice, EffectTrial, EffectWork, EffectsOptions, EffectsOutcome, Ledger, Verdict, effects, write_effects,
};
pub use ropewalk_studies::linearise::{
    About, LineariseOptions, LineariseOutcome, linearise, write_linearised,
};
pub use ropewalk_studies::modes::{Modal, ModesOptions, ModesOutcome, modes, write_modes};
pub use ropewalk_studies::run::{Every, Leaves, Manifest, Outcome, RunOptions, Status, Summary, resume, run};
pub use ropewalk_studies::simulate::{History, read, simulate, simulate_with, start};
pub use ropewalk_studies::{Error, Session, Snapshot, bench, variants, verify};

/// The programs of the README, of CONTRIBUTING and of the book must compile and run.
#[cfg(doctest)]
mod documents {
    #[doc = include_str!("../README.md")]
    struct Readme;
    #[doc = include_str!("../CONTRIBUTING.md")]
    struct Contributing;
    #[doc = include_str!("../book/src/rust.md")]
    struct Book;
}
