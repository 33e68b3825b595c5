//! Locks on folders: two programs never compute in the same one.

use super::OutputError;
use std::fs::{self, File, TryLockError};
use std::path::{Path, PathBuf};

/// The file in a folder that is locked.
const NAME: &str = ".lock";

/// A lock on a folder, held as long as this lives. The system takes it away however the process ends, so that one that was
/// killed blocks nobody. Where files can't be locked, two at a time are the user's own affair.
#[derive(Debug)]
pub struct FolderLock {
    path: PathBuf,
    _file: File,
    /// Whether the file goes with the lock.
    fleeting: bool,
}

impl FolderLock {
    /// Locks the folder of a run, which has to be there; none if somebody else has it. Nothing is left of it in the end.
    ///
    /// # Errors
    /// The folder can't be written.
    pub fn of_run(folder: &Path) -> Result<Option<Self>, OutputError> {
        Self::take(folder, true, File::try_lock)
    }

    /// Locks a folder for oneself; none if somebody else has it.
    ///
    /// # Errors
    /// The folder can't be written.
    pub fn alone(folder: &Path) -> Result<Option<Self>, OutputError> {
        Self::take(folder, false, File::try_lock)
    }

    /// Locks a folder together with others that do the same; none if somebody has it alone.
    ///
    /// # Errors
    /// The folder can't be written.
    pub fn together(folder: &Path) -> Result<Option<Self>, OutputError> {
        Self::take(folder, false, File::try_lock_shared)
    }

    /// Whether this is the name of the file that is locked.
    pub fn is_named(name: &std::ffi::OsStr) -> bool {
        name == NAME
    }

    fn take(
        folder: &Path,
        fleeting: bool,
        lock: fn(&File) -> Result<(), TryLockError>,
    ) -> Result<Option<Self>, OutputError> {
        let path = folder.join(NAME);
        loop {
            let file = File::options().create(true).append(true).open(&path);
            let file = file.map_err(OutputError::io("write into", folder))?;
            if let Err(TryLockError::WouldBlock) = lock(&file) {
                return Ok(None);
            }
            // who had it before may have deleted it, and then another file is the one that counts
            if is_at(&file, &path) {
                return Ok(Some(FolderLock { path, _file: file, fleeting }));
            }
        }
    }
}

impl Drop for FolderLock {
    fn drop(&mut self) {
        if self.fleeting {
            let _ = fs::remove_file(&self.path);
        }
    }
}

#[cfg(unix)]
fn is_at(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let place = |m: fs::Metadata| (m.dev(), m.ino());
    matches!((file.metadata().map(place), fs::metadata(path).map(place)), (Ok(a), Ok(b)) if a == b)
}

/// A file that is open can't be deleted there.
#[cfg(not(unix))]
fn is_at(_: &File, _: &Path) -> bool {
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_has_a_folder_alone_or_several_have_it_together() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path();
        let alone = FolderLock::alone(path).unwrap();
        assert!(alone.is_some());
        assert!(FolderLock::alone(path).unwrap().is_none() && FolderLock::together(path).unwrap().is_none());
        drop(alone);
        let some = [FolderLock::together(path).unwrap(), FolderLock::together(path).unwrap()];
        assert!(some.iter().all(Option::is_some) && FolderLock::alone(path).unwrap().is_none());
        drop(some);
        assert!(FolderLock::alone(path).unwrap().is_some());
        assert!(FolderLock::alone(&path.join("missing")).is_err());
    }

    #[test]
    fn the_lock_of_a_run_leaves_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let lock = FolderLock::of_run(folder.path()).unwrap();
        assert!(lock.is_some() && FolderLock::of_run(folder.path()).unwrap().is_none());
        drop(lock);
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
        // what one that was killed has left
        fs::write(folder.path().join(NAME), "").unwrap();
        assert!(FolderLock::of_run(folder.path()).unwrap().is_some());
    }
}
