//! The verification suite: cases with known results, each a scene that is run like any user's and a file of references.
//!
//! They are in the folder `verification`: `NAME.json` says which scenes a case runs, what is looked at in their results, and
//! what should come out; the scenes are the `.toml` files beside it. To add a case, write both and name them in
//! `verify/files.rs`.

mod builders;
mod case;
mod crossing;
mod files;
mod page;
mod quantity;
mod report;

pub use case::{Case, LeftOut, Outcome, case, cases};
pub use page::TITLE;
pub use page::{html, page, picture};
pub use quantity::{Measured, Quantity};
pub use report::{heading, lines};
