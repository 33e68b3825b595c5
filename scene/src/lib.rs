//! The language of Ropewalk's scenes: what a file can name, and how a model is built of it.
//!
//! A scene lists [specs](spec): plain data that serde reads, each registered under the name that `type = "…"` finds it by.
//! The [`Builder`] makes a [`Model`](ropewalk_core::Model) of them; [`records`] are what a run writes down. Numbers may
//! carry [units](quantity), places are [markers](MarkerRef), gravity, water and air belong to the scene as a whole.

mod builder;
pub mod controllers;
mod current;
pub mod document;
mod doubts;
mod elsewhere;
pub mod file;
pub mod functions;
mod inputs;
mod marker;
mod motions;
mod process;
pub mod records;
mod reeving;
mod responses;
mod run;
mod scene;
mod scene_file;
mod sea;
pub mod spec;
mod statistics;
mod water;
mod waves;

pub use builder::{Builder, Numbered};
pub use controllers::{Bound, Channels};
pub use current::Current;
pub use document::{
    Document, Fault, Format, Key, Kind, Migrated, Parameter, Place, Rewrite, Sampling, Span, Table, Value,
    Varied, did_you_mean, migrate, quoted, read_text,
};
pub use inputs::{InputSpec, Inputs};
pub use marker::{MarkerRef, split_marker};
pub use process::{Channel, Process, ProcessSpec, Surroundings};
pub use reeving::{Guide, Passage, Strand, Torsional, Winding};
pub use responses::{RaoAngles, RaoPer, RaoPhase, RaoSpec, RaoSymmetry, RaoWaves};
pub use ropewalk_quantity as quantity;
pub use run::{Analysis, RangeSpec, Run, ShapeTitles, TableSpec};
pub use scene::{GRAVITY, Scene, SceneError};
pub use scene_file::{Bundled, SceneFile, SceneText};
pub use sea::{Sea, SeaTable, Swell};
pub use spec::{
    ConstraintSpec, ControllerSpec, ElementSpec, ForceSpec, ListInfo, MotionSpec, RecordSpec, SECTIONS,
    SpecInfo, SpecKind, lists, registered,
};
pub use statistics::{FatigueSpec, SecondSlope, StatisticsSpec};
pub use water::{Air, Level, Water, ball_below};
pub use waves::{
    Evaluation, Jonswap, MeasuredSea, PiersonMoskowitz, RegularWave, SpreadingSpec, WaveComponent,
    WaveSampling, WaveStretching, WavesSpec, WhiteSea,
};

#[doc(hidden)]
pub use inventory;
#[doc(hidden)]
pub use schemars;
