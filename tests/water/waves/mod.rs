//! Waves: laws against differences and balances, reference sets, scenes.

mod free;
mod laws;
mod measured;
mod reference;
mod scenes;
mod tension;
mod together;
mod vessels;

use ropewalk::scene::Format;
use ropewalk::{History, SceneFile, simulate};

fn scene(text: &str) -> SceneFile {
    SceneFile::parse(text, "waves", Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}"))
}

fn run(text: &str) -> History {
    simulate(scene(text).scene()).unwrap_or_else(|e| panic!("{e}"))
}

fn refused(text: &str) -> String {
    match SceneFile::parse(text, "waves", Format::Toml, &[]) {
        Err(e) => e.to_string(),
        Ok(file) => file.build().err().expect("is refused").to_string(),
    }
}
