//! The folder of a study of many runs: where its runs are, and how the same study is known again.

use super::share::sweep_up;
use ropewalk_report::{FolderLock, OutputError, RUNS, RunFolder, cannot_create, write_json};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// What a study is, by which the same one is known again.
pub trait Study: Serialize + DeserializeOwned {
    /// What it is called in messages and in the names of its file and its folder.
    const KIND: &'static str;
    /// What its folder is named after.
    fn name(&self) -> String;
    /// In what another one differs, most important first; none if it is the same.
    fn difference(&self, there: &Self) -> Option<String>;
}

/// A text that isn't too long for a message.
pub fn shortened(text: &str) -> String {
    const LONGEST: usize = 80;
    match text.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_string(),
    }
}

/// The folder of a study:
///
/// ```text
/// runs/hose-turn-sweep/
///   sweep.json                 scenes and parameters
///   table.csv                  a row for each run
///   plots/*.svg                pictures over all runs
///   tables/*.csv               last values by the first parameter
///   runs/speed=5kn,start=40/   a run, as `ropewalk run` leaves it
/// ```
///
/// Parts of a study share it: each run of theirs comes into `runs/` whole.
pub struct StudyFolder {
    path: PathBuf,
    kind: &'static str,
    /// Locked as long as the study is at work, and by the system unlocked however it ends.
    _lock: FolderLock,
}

/// What is found where a study shall go.
enum Found {
    Nothing,
    /// The same study.
    Same,
    /// Another one, and in what it differs.
    Other(String),
    /// Files that no study has left.
    Files,
}

impl StudyFolder {
    /// Makes the folder or goes on in that of the same study; `fresh` deletes first what one has left there.
    ///
    /// Without `out` it is `runs/<name>-<kind>`, or with the first number that is free or holds the same study.
    ///
    /// # Errors
    /// The folder holds something else, belongs to a study that is at work, or can't be written.
    pub(crate) fn open<S: Study>(
        out: Option<PathBuf>,
        fresh: bool,
        manifest: &S,
    ) -> Result<Self, OutputError> {
        let path = Self::find(out, fresh, manifest)?;
        fs::create_dir_all(&path).map_err(|e| cannot_create(&path, e))?;
        let Some(lock) = FolderLock::alone(&path)? else {
            return Err(OutputError::Busy { kind: S::KIND, path });
        };
        let folder = Self { path, kind: S::KIND, _lock: lock };
        if fresh {
            folder.clear()?;
        }
        // who has it alone may do away with what parts that were killed have left
        sweep_up(&folder.run(""));
        write_json(&folder.manifest_file(), manifest)?;
        Ok(folder)
    }

    /// The same for one of several that work at the study at the same time, on this machine or others.
    ///
    /// # Errors
    /// As [`open`](Self::open); others that are at work together are none.
    pub(crate) fn join<S: Study>(out: Option<PathBuf>, manifest: &S) -> Result<Self, OutputError> {
        let path = Self::find(out, false, manifest)?;
        fs::create_dir_all(&path).map_err(|e| cannot_create(&path, e))?;
        let Some(lock) = FolderLock::together(&path)? else {
            return Err(OutputError::Busy { kind: S::KIND, path });
        };
        let folder = Self { path, kind: S::KIND, _lock: lock };
        if !matches!(look(&folder.path, manifest), Found::Same) {
            write_json(&folder.manifest_file(), manifest)?;
        }
        Ok(folder)
    }

    /// Where the study goes.
    fn find<S: Study>(out: Option<PathBuf>, fresh: bool, manifest: &S) -> Result<PathBuf, OutputError> {
        Ok(match out {
            Some(path) => match look(&path, manifest) {
                Found::Files => return Err(OutputError::FolderInUse { path }),
                Found::Other(difference) if !fresh => {
                    return Err(OutputError::OtherStudy { kind: S::KIND, path, difference });
                }
                _ => path,
            },
            None => {
                let name: String = manifest.name().chars().take(60).collect();
                let kind = S::KIND;
                let numbered = (1_u64..).map(|n| match n {
                    1 => Path::new(RUNS).join(format!("{name}-{kind}")),
                    n => Path::new(RUNS).join(format!("{name}-{kind}-{n}")),
                });
                let mut fitting =
                    numbered.filter(|p| matches!(look(p, manifest), Found::Nothing | Found::Same));
                fitting.next().unwrap_or_default()
            }
        })
    }

    /// The folder itself.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }
    fn manifest_file(&self) -> PathBuf {
        self.path.join(format!("{}.json", self.kind))
    }
    /// `table.csv`: a row for each run.
    pub(crate) fn table_file(&self) -> PathBuf {
        self.path.join("table.csv")
    }
    /// The folder of a run.
    pub(crate) fn run(&self, name: &str) -> PathBuf {
        self.path.join("runs").join(name)
    }
    /// The folder itself as one of pictures and tables.
    pub(crate) fn files(&self) -> RunFolder {
        RunFolder::earlier(self.path.clone())
    }

    /// Deletes what a study leaves; that it was one is forgotten last, so that this may be interrupted.
    fn clear(&self) -> Result<(), OutputError> {
        let gone = |path: PathBuf, result: std::io::Result<()>| match result {
            Err(e) if e.kind() != ErrorKind::NotFound => Err(OutputError::io("delete", &path)(e)),
            _ => Ok(()),
        };
        for folder in ["runs", "plots", "tables", "advice", "figures"] {
            let path = self.path.join(folder);
            gone(path.clone(), fs::remove_dir_all(&path))?;
        }
        let files = ["table.csv", "plan.csv", "advice.json", "index.html"].map(|name| self.path.join(name));
        for path in files.into_iter().chain([self.manifest_file()]) {
            gone(path.clone(), fs::remove_file(&path))?;
        }
        Ok(())
    }
}

fn look<S: Study>(path: &Path, manifest: &S) -> Found {
    if let Ok(text) = fs::read_to_string(path.join(format!("{}.json", S::KIND))) {
        return match serde_json::from_str::<S>(&text) {
            Ok(there) => manifest.difference(&there).map_or(Found::Same, Found::Other),
            Err(_) => Found::Other(format!("whose {}.json is damaged", S::KIND)),
        };
    }
    // a lock is all that a study leaves that was killed at once
    let is_lock = |e: std::io::Result<fs::DirEntry>| e.is_ok_and(|e| FolderLock::is_named(&e.file_name()));
    match fs::read_dir(path) {
        Ok(mut entries) => {
            if entries.all(is_lock) {
                Found::Nothing
            } else {
                Found::Files
            }
        }
        // a folder that can't be made or read says so when it is used
        Err(_) => Found::Nothing,
    }
}
