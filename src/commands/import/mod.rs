//! `ropewalk import DECK`

mod body;
mod deck;
mod joints;
mod parts;
mod rod;
mod scene;
mod water;

use super::shell::in_shell;
use super::{Exit, say, warn};
use deck::Deck;
use ropewalk_scene::{Fault, Format, SceneText};
use ropewalk_studies::Error;
use std::path::{Path, PathBuf};

/// A deck, and where its scene goes.
#[derive(Debug, clap::Args)]
pub(crate) struct ImportArgs {
    /// An input file of MoorDyn, version 2; files that it reads lie beside it
    #[arg(value_name = "DECK")]
    deck: PathBuf,
    /// Write the scene here instead of on standard output
    #[arg(long, short, value_name = "FILE")]
    out: Option<PathBuf>,
}

pub(crate) fn run(args: &ImportArgs) -> Result<Exit, Error> {
    let name = args.deck.display().to_string();
    let bytes = std::fs::read(&args.deck).map_err(|e| Fault::new(format!("`{name}` can't be read: {e}")))?;
    // units in other encodings stand in heads, which aren't read
    let text = String::from_utf8_lossy(&bytes).replace('\u{feff}', "");
    let deck = Deck::read(&name, &text)?;
    let folder = args.deck.parent().unwrap_or_else(|| Path::new(""));
    let file = args.deck.file_name().map_or_else(|| name.clone(), |f| f.to_string_lossy().into_owned());
    let imported = scene::scene(&deck, &file, folder)?;
    // what is written can be read
    SceneText::new(&file, imported.text.clone(), Format::Toml, None).with(&[])?;
    for note in &imported.notes {
        warn(note);
    }
    match &args.out {
        None => say(imported.text.trim_end()),
        Some(out) => {
            std::fs::write(out, &imported.text)
                .map_err(|e| Fault::new(format!("`{}` can't be written: {e}", out.display())))?;
            let word = in_shell(&out.to_string_lossy());
            say(format!("{}: {} line(s)\n  ropewalk run {word}", out.display(), deck.lines.len()));
        }
    }
    Ok(Exit::Done)
}
