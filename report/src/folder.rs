//! The folder of a run: where results go, so that no run ever overwrites another.

use std::fs;
use std::hash::{BuildHasher, RandomState};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::process;
use std::sync::LazyLock;

use super::{FolderLock, OutputError};
use serde::Serialize;
use serde::de::DeserializeOwned;

/// Folder under which runs are kept unless the user names another.
pub const RUNS: &str = "runs";

/// A new, writable folder that holds all that one run leaves behind:
///
/// ```text
/// runs/moored_hose-2/
///   scene.toml      the scene as it was read
///   manifest.json   what was built from it
///   history.csv     time histories, written while the run goes on
///   shapes.csv      lines of all parts at several times
///   field.npy       lines of all parts at many times
///   bodies.npy      where bodies are at those times
///   summary.json    how the run ended
///   report.html     all of it as a page for the browser
///   plots/*.svg     pictures
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RunFolder {
    path: PathBuf,
}

impl RunFolder {
    /// Makes the folder of a run.
    ///
    /// Without `base`: `runs/<scene_name>` below the working directory, or with the first number
    /// that is free, `runs/<scene_name>-2`, `-3`, … With `base` (the user's `--out DIR`): exactly
    /// that folder, which must be new or empty.
    ///
    /// # Errors
    /// [`OutputError::FolderInUse`] for a `base` that holds files; [`OutputError::Io`] for a
    /// folder that can't be made or written. Nothing has been computed yet when they come.
    pub fn create(base: Option<PathBuf>, scene_name: &str) -> Result<Self, OutputError> {
        match base {
            Some(path) => Self::at(path),
            None => Self::numbered(Path::new(RUNS), scene_name),
        }
    }

    /// Uses this very folder, which must be new or empty.
    ///
    /// # Errors
    /// As [`create`](Self::create).
    pub fn at(path: PathBuf) -> Result<Self, OutputError> {
        fs::create_dir_all(&path).map_err(|error| cannot_create(&path, error))?;
        let mut entries = fs::read_dir(&path).map_err(OutputError::io("read folder", &path))?;
        // a lock may be one's own, or that of one that was killed
        if entries.any(|e| e.is_ok_and(|e| !FolderLock::is_named(&e.file_name()))) {
            return Err(OutputError::FolderInUse { path });
        }
        Self { path }.tried()
    }

    /// The folder of an earlier run, to read what is in it; whether it is there is not asked.
    pub fn earlier(path: PathBuf) -> Self {
        Self { path }
    }

    /// Makes `parent/name`, or `parent/name-2`, `-3`, … if that exists.
    ///
    /// # Errors
    /// [`OutputError::Io`] for a folder that can't be made or written.
    pub fn numbered(parent: &Path, name: &str) -> Result<Self, OutputError> {
        fs::create_dir_all(parent).map_err(|error| cannot_create(parent, error))?;
        let name = file_name(name);
        let mut number = 1_u64;
        loop {
            let path = match number {
                1 => parent.join(&name),
                n => parent.join(format!("{name}-{n}")),
            };
            // Creating is the test for existence, so that two runs started together don't share.
            match fs::create_dir(&path) {
                Ok(()) => return Self { path }.tried(),
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => number += 1,
                Err(error) => return Err(cannot_create(&path, error)),
            }
        }
    }

    /// The folder itself.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// `scene.toml`: the scene as it was read.
    pub fn scene_file(&self) -> PathBuf {
        self.path.join("scene.toml")
    }

    /// `manifest.json`: what was built from the scene.
    pub fn manifest_file(&self) -> PathBuf {
        self.path.join("manifest.json")
    }

    /// `history.csv`: the time histories, for a [`TableWriter`](super::TableWriter).
    pub fn history_file(&self) -> PathBuf {
        self.path.join("history.csv")
    }

    /// `shapes.csv`: the lines of all parts at the times of the snapshots.
    pub fn shapes_file(&self) -> PathBuf {
        self.path.join("shapes.csv")
    }

    /// `field.npy`: the lines of all parts at the times of the field record.
    pub fn field_file(&self) -> PathBuf {
        self.path.join("field.npy")
    }

    /// `bodies.npy`: where bodies are at these times.
    pub fn bodies_file(&self) -> PathBuf {
        self.path.join("bodies.npy")
    }

    /// `forces.npy`: forces at points at these times, for arrows.
    pub fn forces_file(&self) -> PathBuf {
        self.path.join("forces.npy")
    }

    /// `steps.csv`: how long steps were and what limited them.
    pub fn steps_file(&self) -> PathBuf {
        self.path.join("steps.csv")
    }

    /// `report.html`: all of the run as a page.
    pub fn report_file(&self) -> PathBuf {
        self.path.join("report.html")
    }

    /// `summary.json`: how the run ended.
    pub fn summary_file(&self) -> PathBuf {
        self.path.join("summary.json")
    }

    /// `checkpoint`: from where a run that didn't come to its end can be resumed.
    pub fn checkpoint_file(&self) -> PathBuf {
        self.path.join("checkpoint")
    }

    /// `plots/<name>.svg`; the name may be that of a record, and the folder is made if needed.
    ///
    /// # Errors
    /// A folder `plots` that can't be made.
    pub fn plot_file(&self, name: &str) -> Result<PathBuf, OutputError> {
        let plots = self.path.join("plots");
        fs::create_dir_all(&plots).map_err(|error| cannot_create(&plots, error))?;
        Ok(plots.join(format!("{}.svg", file_name(name))))
    }

    /// Draws `plots/<name>.svg` and tells whether it is there. A picture that can't be drawn is no reason to fail: `warn`
    /// is told. One with nothing to show is left out.
    pub fn draw(
        &self,
        name: &str,
        write: impl FnOnce(&Path) -> Result<(), OutputError>,
        warn: &mut dyn FnMut(&str),
    ) -> bool {
        match self.plot_file(name).and_then(|path| write(&path)) {
            Ok(()) => return true,
            Err(OutputError::EmptyPlot { .. } | OutputError::LogAxis { .. }) => {}
            Err(e) => warn(&e.to_string()),
        }
        false
    }

    /// `tables/<name>.csv`; the folder is made if needed.
    ///
    /// # Errors
    /// A folder `tables` that can't be made.
    pub fn table_file(&self, name: &str) -> Result<PathBuf, OutputError> {
        let tables = self.path.join("tables");
        fs::create_dir_all(&tables).map_err(|error| cannot_create(&tables, error))?;
        Ok(tables.join(format!("{}.csv", file_name(name))))
    }

    /// Writes the scene text.
    ///
    /// # Errors
    /// A file that can't be written.
    pub fn write_scene(&self, toml: &str) -> Result<(), OutputError> {
        write_atomic(&self.scene_file(), toml)
    }

    /// Writes the manifest as indented JSON.
    ///
    /// # Errors
    /// A file that can't be written, or a value that has no JSON form.
    pub fn write_manifest(&self, manifest: &impl serde::Serialize) -> Result<(), OutputError> {
        write_json(&self.manifest_file(), manifest)
    }

    /// Writes the summary as indented JSON.
    ///
    /// # Errors
    /// A file that can't be written.
    pub fn write_summary(&self, summary: &impl Serialize) -> Result<(), OutputError> {
        write_json(&self.summary_file(), summary)
    }

    /// Reads a run's summary back.
    ///
    /// # Errors
    /// A file that can't be read or isn't a summary.
    pub fn read_summary<T: DeserializeOwned>(&self) -> Result<T, OutputError> {
        let path = self.summary_file();
        let text = fs::read_to_string(&path).map_err(OutputError::io("read", &path))?;
        serde_json::from_str(&text).map_err(|error| OutputError::Json { path, message: error.to_string() })
    }

    /// Finds out before the run, not after it, whether files can be written here.
    fn tried(self) -> Result<Self, OutputError> {
        let probe = self.path.join(temporary_name("probe"));
        fs::write(&probe, b"")
            .and_then(|()| fs::remove_file(&probe))
            .map_err(OutputError::io("write into", &self.path))?;
        Ok(self)
    }
}

/// Writes a text file all or nothing: who reads `path` sees the old or the new text, never a part.
///
/// # Errors
/// A file that can't be written; whatever was at `path` is then untouched.
pub fn write_atomic(path: &Path, text: &str) -> Result<(), OutputError> {
    write_atomic_bytes(path, text.as_bytes())
}

/// As [`write_atomic`], for what is no text.
pub(crate) fn write_atomic_bytes(path: &Path, bytes: &[u8]) -> Result<(), OutputError> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let temporary = path.with_file_name(temporary_name(&name));
    fs::write(&temporary, bytes).and_then(|()| fs::rename(&temporary, path)).map_err(|error| {
        // Best effort: the write error is what the user must hear of.
        let _ = fs::remove_file(&temporary);
        OutputError::io("write", path)(error)
    })
}

/// As [`write_atomic`], and on the disk when it returns: neither a killed program nor a power cut leaves a part.
pub fn write_durable(path: &Path, bytes: &[u8]) -> Result<(), OutputError> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    // one name, so that what a killed program leaves behind is written over by the next
    let temporary = path.with_file_name(format!(".{name}.tmp"));
    let written = fs::File::create(&temporary).and_then(|mut file| {
        file.write_all(bytes)?;
        file.sync_all()?;
        fs::rename(&temporary, path)
    });
    written.map_err(|error| {
        let _ = fs::remove_file(&temporary);
        OutputError::io("write", path)(error)
    })?;
    // the name is on the disk once the folder is; not every system lets a folder be opened for that
    if let Some(Ok(folder)) = path.parent().map(fs::File::open) {
        let _ = folder.sync_all();
    }
    Ok(())
}

/// Writes something as indented JSON, all or nothing.
///
/// # Errors
/// A file that can't be written; a value that JSON has no words for.
pub fn write_json(path: &Path, value: &impl serde::Serialize) -> Result<(), OutputError> {
    let mut text = serde_json::to_string_pretty(value)
        .map_err(|error| OutputError::Json { path: path.to_path_buf(), message: error.to_string() })?;
    text.push('\n');
    write_atomic(path, &text)
}

/// Hidden, and different for each process that may write the same file, on this machine or another.
fn temporary_name(name: &str) -> String {
    // keys of hash maps are random
    static OWN: LazyLock<u64> = LazyLock::new(|| RandomState::new().hash_one(process::id()));
    format!(".{name}.{:016x}.tmp", *OWN)
}

/// A path through or onto a file fails with various kinds of error; say it in one way.
pub fn cannot_create(path: &Path, error: io::Error) -> OutputError {
    let through_file = path.ancestors().any(Path::is_file);
    let error = if through_file { io::ErrorKind::NotADirectory.into() } else { error };
    OutputError::io("create folder", path)(error)
}

/// A name that is one valid path component on every system.
fn file_name(name: &str) -> String {
    // File systems allow 255 bytes; numbers and endings need some of them.
    let clean: String = plain(name).chars().take(60).collect();
    if clean.is_empty() { "scene".into() } else { clean }
}

/// The same without a limit to its length; it may be empty.
pub fn plain(name: &str) -> String {
    let clean: String = name
        .trim()
        .chars()
        .map(|c| match c {
            '/' | '\\' | ':' | '*' | '?' | '"' | '<' | '>' | '|' => '_',
            c if c.is_control() => '_',
            c => c,
        })
        .collect();
    clean.trim_matches('.').to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_are_numbered_and_never_overwritten() {
        let parent = tempfile::tempdir().unwrap();
        let runs = parent.path().join("runs");
        let names: Vec<String> = (0..3)
            .map(|_| RunFolder::numbered(&runs, "hose").unwrap())
            .map(|f| f.path().file_name().unwrap().to_string_lossy().into_owned())
            .collect();
        assert_eq!(names, ["hose", "hose-2", "hose-3"]);
    }

    #[test]
    fn an_explicit_folder_must_be_empty() {
        let parent = tempfile::tempdir().unwrap();
        let out = parent.path().join("a/b");
        let folder = RunFolder::create(Some(out.clone()), "hose").unwrap();
        assert_eq!(folder.path(), out);
        RunFolder::create(Some(out.clone()), "hose").unwrap();
        folder.write_scene("x = 1\n").unwrap();
        let error = RunFolder::create(Some(out), "hose").unwrap_err();
        assert!(matches!(error, OutputError::FolderInUse { .. }));
        assert!(error.to_string().contains("--out"));
    }

    #[test]
    fn a_file_in_the_way_is_named() {
        let parent = tempfile::tempdir().unwrap();
        let file = parent.path().join("file");
        fs::write(&file, "").unwrap();
        for result in
            [RunFolder::at(file.clone()), RunFolder::at(file.join("sub")), RunFolder::numbered(&file, "hose")]
        {
            let message = result.unwrap_err().to_string();
            assert!(message.contains("file") && message.contains("is a file, not a folder"));
        }
    }

    #[cfg(unix)]
    #[test]
    fn a_read_only_folder_is_refused_before_the_run() {
        use std::os::unix::fs::PermissionsExt;
        let parent = tempfile::tempdir().unwrap();
        let locked = parent.path().join("locked");
        fs::create_dir(&locked).unwrap();
        fs::set_permissions(&locked, fs::Permissions::from_mode(0o555)).unwrap();
        if fs::write(locked.join("probe"), "").is_ok() {
            return; // root may write anywhere
        }
        let message = RunFolder::at(locked).unwrap_err().to_string();
        assert!(message.contains("choose a folder you may write to"));
    }

    #[test]
    fn texts_are_written_whole_and_leave_no_scratch() {
        let parent = tempfile::tempdir().unwrap();
        let folder = RunFolder::at(parent.path().join("out")).unwrap();
        folder.write_scene("a = 1\n").unwrap();
        folder.write_scene("a = 2\n").unwrap();
        folder.write_manifest(&["cable", "gravity"]).unwrap();
        folder.plot_file("hose.end.x").unwrap();
        assert_eq!(fs::read_to_string(folder.scene_file()).unwrap(), "a = 2\n");
        let mut names: Vec<_> = fs::read_dir(folder.path())
            .unwrap()
            .map(|e| e.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        assert_eq!(names, ["manifest.json", "plots", "scene.toml"]);
        assert!(write_atomic(&parent.path().join("no/such/folder"), "").is_err());
    }

    #[test]
    fn any_scene_name_gives_a_folder_inside_the_parent() {
        assert_eq!(file_name("../a/b: c"), "_a_b_ c");
        assert_eq!(file_name(" .. "), "scene");
        assert_eq!(file_name("hose.end.x"), "hose.end.x");
    }
}
