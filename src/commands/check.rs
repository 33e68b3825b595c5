//! `ropewalk check SCENE`

use super::{Exit, say, warn};
use crate::cli::SceneArgs;
use ropewalk_models::Bundled;
use ropewalk_scene::SceneFile;
pub use ropewalk_studies::Error;
use ropewalk_studies::run::Manifest;

pub(crate) fn check(args: &SceneArgs, bundled: &[Bundled]) -> Result<Exit, Error> {
    let file = SceneFile::open(&args.scene, &args.overrides, bundled)?;
    let model = file.build()?;
    let manifest = Manifest::new(&file, &model)?;
    for name in file.document().unused_parameters() {
        warn(&format!("parameter `{name}` is not used by the scene"));
    }
    say(manifest);
    Ok(Exit::Done)
}
