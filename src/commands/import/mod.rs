//! `ropewalk import DECK`: scenes from the input files of other codes.

mod deck;
mod scene;

use super::{Exit, complain, say};
use ropewalk_scene::{Fault, file};
pub use ropewalk_studies::Error;
use std::fs;
use std::io::Read;
use std::path::PathBuf;

/// A file of another code.
#[derive(Debug, clap::Args)]
pub(crate) struct ImportArgs {
    /// An input file of MoorDyn version 2
    #[arg(value_name = "DECK")]
    deck: PathBuf,
    /// Write the scene here instead of to standard output
    #[arg(long, short, value_name = "FILE")]
    out: Option<PathBuf>,
}

pub(crate) fn run(args: &ImportArgs) -> Result<Exit, Error> {
    let name = args.deck.display().to_string();
    let mut bytes = Vec::new();
    let read = file::open(&args.deck).and_then(|mut f| f.read_to_end(&mut bytes).map_err(|e| e.to_string()));
    read.map_err(|e| Fault::new(format!("`{name}` can't be read: {e}")))?;
    let text = String::from_utf8_lossy(&bytes);
    let deck = deck::Deck::read(&text).map_err(|(line, why)| Fault::new(format!("{name}:{line}: {why}")))?;
    let title = args.deck.file_stem().map_or_else(|| name.clone(), |s| s.to_string_lossy().into_owned());
    let (scene, notes) =
        scene::write(&deck, &title).map_err(|(line, why)| Fault::new(format!("{name}:{line}: {why}")))?;
    for note in notes {
        complain(format!("note: {note}"));
    }
    match &args.out {
        Some(out) => fs::write(out, &scene)
            .map_err(|e| Fault::new(format!("`{}` can't be written: {e}", out.display())))?,
        None => say(scene.trim_end()),
    }
    Ok(Exit::Done)
}
