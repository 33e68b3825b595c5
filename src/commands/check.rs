//! `ropewalk check SCENE`

use super::{Exit, complain, say};
use crate::cli::SceneArgs;
use crate::error::Error;
use crate::read::SceneFile;
use crate::run::Manifest;
use ropewalk_models::Bundled;

pub(crate) fn check(args: &SceneArgs, bundled: &[Bundled]) -> Result<Exit, Error> {
    let file = SceneFile::open(&args.scene, &args.overrides, bundled)?;
    let model = file.build()?;
    let manifest = Manifest::new(&file, &model)?;
    for name in file.document().unused_parameters() {
        complain(format!("warning: parameter `{name}` is not used by the scene"));
    }
    say(manifest);
    Ok(Exit::Done)
}
