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

    /// Begins it with the scene and what it consists of, with copies of the files that the scene names if they are asked for.
    pub(crate) fn keep(
        mut self,
        file: &SceneFile,
        manifest: &Manifest,
        copies: bool,
    ) -> Result<(RunFolder, Option<FolderLock>), OutputError> {
        let scene = if copies { self.with_copies(file)? } else { file.document().to_toml() };
        self.folder.write_scene(&scene)?;
        self.folder.write_manifest(manifest)?;
        Ok((self.folder.clone(), self.lock.take()))
    }

    /// Copies the files that a scene names into `inputs/`; the scene with their new paths.
    fn with_copies(&self, file: &SceneFile) -> Result<String, OutputError> {
        let mut known: Vec<(String, String)> = Vec::new();
        let mut trouble = None;
        let scene = file.document().to_toml_with_files(&mut |path| {
            if let Some((_, name)) = known.iter().find(|(old, _)| old == path) {
                return name.clone();
            }
            // a pipe was read already; names differ by more than case, for file systems that don't tell it
            let from = Path::new(path);
            let Some(own) = from.file_name().filter(|_| from.is_file()) else { return path.into() };
            let own = own.to_string_lossy();
            let free = |name: &String| known.iter().all(|(_, other)| !other.eq_ignore_ascii_case(name));
            let numbered = (2..).map(|k| format!("inputs/{k}-{own}"));
            let name =
                std::iter::once(format!("inputs/{own}")).chain(numbered).find(free).unwrap_or_default();
            let to = self.folder.path().join(&name);
            let copied =
                to.parent().map_or(Ok(()), std::fs::create_dir_all).and_then(|()| std::fs::copy(from, &to));
            if let Err(e) = copied {
                trouble = Some(OutputError::io("write", &to)(e));
            }
            known.push((path.into(), name.clone()));
            name
        });
        trouble.map_or(Ok(scene), Err)
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
