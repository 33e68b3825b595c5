//! What comes before the computing in a folder of its own.

use super::manifest::Manifest;
use crate::error::Error;
use ropewalk_core::Model;
use ropewalk_report::{OutputError, RunFolder};
use ropewalk_scene::SceneFile;
use std::path::PathBuf;

/// Builds a scene and looks at what it consists of; `warn` is told of parameters without use.
pub(crate) fn prepare(file: &SceneFile, warn: &mut dyn FnMut(&str)) -> Result<(Model, Manifest), Error> {
    let model = file.build()?;
    let manifest = Manifest::new(file, &model)?;
    for name in file.document().unused_parameters() {
        warn(&format!("parameter `{name}` is not used by the scene"));
    }
    Ok((model, manifest))
}

/// A folder for results. It is removed again, if it was made here, unless it is kept.
pub(crate) struct NewFolder {
    folder: RunFolder,
    is_new: bool,
}

impl NewFolder {
    /// The folder `out`, or without it `runs/<name>`, numbered.
    pub(crate) fn create(out: Option<PathBuf>, name: &str) -> Result<Self, OutputError> {
        let is_new = out.as_ref().is_none_or(|out| !out.exists());
        Ok(NewFolder { folder: RunFolder::create(out, name)?, is_new })
    }

    /// Begins it with the scene and what it consists of.
    pub(crate) fn keep(self, file: &SceneFile, manifest: &Manifest) -> Result<RunFolder, OutputError> {
        self.folder.write_scene(&file.document().to_toml())?;
        self.folder.write_manifest(manifest)?;
        Ok(self.folder.clone())
    }
}

impl Drop for NewFolder {
    fn drop(&mut self) {
        if self.is_new {
            // best effort, and it only removes a folder that is empty
            let _ = std::fs::remove_dir(self.folder.path());
        }
    }
}
