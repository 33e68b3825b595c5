//! What comes before the computing in a folder of its own.

use super::manifest::Manifest;
use crate::error::Error;
use ropewalk_core::Model;
use ropewalk_report::{FolderLock, OutputError, RunFolder, cannot_create};
use ropewalk_scene::SceneFile;
use std::path::{Path, PathBuf};

/// Builds a scene and looks at what it consists of; `warn` is told of parameters without use.
pub(crate) fn prepare(file: &SceneFile, warn: &mut dyn FnMut(&str)) -> Result<(Model, Manifest), Error> {
    let model = file.build()?;
    let manifest = Manifest::new(file, &model)?;
    for name in file.document().unused_parameters() {
        warn(&format!("parameter `{name}` is not used by the scene"));
    }
    Ok((model, manifest))
}

/// A folder for results, locked. It is removed again, if it was made here, unless it is kept.
pub(crate) struct NewFolder {
    folder: RunFolder,
    lock: Option<FolderLock>,
    is_new: bool,
}

impl NewFolder {
    /// The folder `out`, or without it `runs/<name>`, numbered.
    pub(crate) fn create(out: Option<PathBuf>, name: &str) -> Result<Self, OutputError> {
        let is_new = out.as_ref().is_none_or(|out| !out.exists());
        let Some(out) = out else {
            let folder = RunFolder::create(None, name)?;
            let lock = Some(locked(folder.path())?);
            return Ok(NewFolder { folder, lock, is_new });
        };
        std::fs::create_dir_all(&out).map_err(|e| cannot_create(&out, e))?;
        // that it is empty is true as long as it is locked
        let lock = Some(locked(&out)?);
        Ok(NewFolder { folder: RunFolder::at(out)?, lock, is_new })
    }

    /// Begins it with the scene and what it consists of.
    pub(crate) fn keep(
        mut self,
        file: &SceneFile,
        manifest: &Manifest,
    ) -> Result<(RunFolder, Option<FolderLock>), OutputError> {
        self.folder.write_scene(&file.document().to_toml())?;
        self.folder.write_manifest(manifest)?;
        Ok((self.folder.clone(), self.lock.take()))
    }
}

/// The lock of a run on its folder.
pub(crate) fn locked(folder: &Path) -> Result<FolderLock, OutputError> {
    FolderLock::of_run(folder)?.ok_or_else(|| OutputError::Busy { kind: "run", path: folder.to_path_buf() })
}

impl Drop for NewFolder {
    fn drop(&mut self) {
        self.lock = None;
        if self.is_new {
            // best effort, and it only removes a folder that is empty
            let _ = std::fs::remove_dir(self.folder.path());
        }
    }
}
