//! Scenes as files: reading, checking and writing them, with messages that point at the place in the file.
//!
//! A scene file goes through these stations, one module each:
//!
//! 1. `toml` or `json` parses the text into a tree of [`Value`]s that know where they were written ([`Span`]);
//! 2. `parameters` replaces every `"$name"` by the parameter's value, `formula` calculates with them;
//! 3. `library` puts sections in place of their names;
//! 4. `deserialize` hands parts of the tree to serde, and turns whatever goes wrong into a [`Fault`];
//! 5. `write` makes TOML of the tree again.
//!
//! [`migrate`](migrate()) rewrites the text of a scene of an older version; `moved` knows its names.
//!
//! [`Document`] leads through all of them:
//!
//! ```
//! use ropewalk_scene::{Document, Format};
//! #[derive(serde::Deserialize)]
//! struct Solver {
//!     step: f64,
//! }
//! let text = "[parameters]\nh = 0.1\n\n[solver]\nstep = \"$h\"\n";
//! let mut document = Document::parse(text, "scene.toml", Format::Toml, &["h=0.05".to_string()])?;
//! let solver: Solver = document.require("solver")?;
//! document.finish()?;
//! assert_eq!(solver.step, 0.05);
//! # Ok::<(), ropewalk_scene::Fault>(())
//! ```

mod deserialize;
mod fault;
mod formula;
mod json;
mod library;
mod migrate;
mod moved;
mod parameters;
mod read;
mod sample;
mod source;
#[cfg(test)]
mod tests;
mod toml;
mod value;
mod vary;
mod write;

pub use fault::Fault;
pub use fault::{did_you_mean, quoted};
pub use migrate::{Migrated, Rewrite, migrate};
pub use parameters::Parameter;
pub use read::read_text;
pub use read::{Document, Format};
pub use sample::Sampling;
pub use source::{Place, Span};
pub use value::{Key, Kind, Table, Value};
pub use vary::Varied;
