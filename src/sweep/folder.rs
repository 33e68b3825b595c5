//! The folder of a sweep: where its runs are, and how the same sweep is known again.

use crate::output::{OutputError, RUNS, RunFolder, cannot_create, plain, write_json};
use serde::{Deserialize, Serialize};
use std::fs::{self, File, TryLockError};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// What a sweep is, as `sweep.json` holds it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct SweepManifest {
    /// Version of Ropewalk.
    pub ropewalk: String,
    /// Number of combinations.
    pub runs: usize,
    /// Parameters that all runs have, each `name=value`.
    pub set: Vec<String>,
    /// Parameters that vary, the last one fastest.
    pub vary: Vec<VariedCopy>,
    /// The scenes, as they were.
    pub scenes: Vec<SceneCopy>,
}

/// A parameter that varies.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct VariedCopy {
    pub name: String,
    pub values: Vec<String>,
}

/// A scene with its text.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct SceneCopy {
    pub name: String,
    pub text: String,
}

impl SweepManifest {
    /// In what another one differs, most important first; none if it is the same.
    fn difference(&self, there: &Self) -> Option<String> {
        let names = |m: &Self| m.scenes.iter().map(|s| s.name.clone()).collect::<Vec<_>>().join(" and ");
        let varied = |m: &Self| {
            m.vary.iter().map(|v| format!("{}={}", v.name, v.values.join(","))).collect::<Vec<_>>().join(" ")
        };
        if names(self) != names(there) {
            Some(format!("of {}", names(there)))
        } else if self.scenes != there.scenes {
            Some(format!("of {} before the scene was changed", names(there)))
        } else if self.vary != there.vary {
            Some(format!("of {}", shortened(&varied(there))))
        } else if self.set != there.set {
            let set = if there.set.is_empty() { "no".into() } else { shortened(&there.set.join(" ")) };
            Some(format!("with {set} set parameters"))
        } else if self.ropewalk != there.ropewalk {
            Some(format!("by version {}", there.ropewalk))
        } else {
            (self != there).then(|| "of another kind".into())
        }
    }
}

fn shortened(text: &str) -> String {
    const LONGEST: usize = 80;
    match text.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_string(),
    }
}

/// The folder of a sweep:
///
/// ```text
/// runs/hose-turn-sweep/
///   sweep.json                 scenes and parameters
///   table.csv                  a row for each run
///   plots/*.svg                pictures over all runs
///   tables/*.csv               last values by the first parameter
///   runs/speed=5kn,start=40/   a run, as `ropewalk run` leaves it
/// ```
pub(super) struct SweepFolder {
    path: PathBuf,
    /// Locked as long as the sweep is at work, and by the system unlocked however it ends.
    _lock: File,
}

/// What is found where a sweep shall go.
enum Found {
    Nothing,
    /// The same sweep.
    Same,
    /// Another sweep, and in what it differs.
    Other(String),
    /// Files that no sweep has left.
    Files,
}

impl SweepFolder {
    /// Makes the folder or goes on in that of the same sweep; `fresh` deletes first what a sweep has left there.
    ///
    /// Without `out` it is `runs/<scenes>-sweep`, or with the first number that is free or holds the same sweep.
    ///
    /// # Errors
    /// The folder holds something else, belongs to a sweep that is at work, or can't be written.
    pub(super) fn open(
        out: Option<PathBuf>,
        fresh: bool,
        manifest: &SweepManifest,
    ) -> Result<Self, OutputError> {
        let path = match out {
            Some(path) => match look(&path, manifest) {
                Found::Files => return Err(OutputError::FolderInUse { path }),
                Found::Other(difference) if !fresh => {
                    return Err(OutputError::OtherSweep { path, difference });
                }
                _ => path,
            },
            None => {
                let names: Vec<String> = manifest.scenes.iter().map(|s| plain(&s.name)).collect();
                let name: String = names.join("+").chars().take(60).collect();
                let numbered = (1_u64..).map(|n| match n {
                    1 => Path::new(RUNS).join(format!("{name}-sweep")),
                    n => Path::new(RUNS).join(format!("{name}-sweep-{n}")),
                });
                let mut fitting =
                    numbered.filter(|p| matches!(look(p, manifest), Found::Nothing | Found::Same));
                fitting.next().unwrap_or_default()
            }
        };
        fs::create_dir_all(&path).map_err(|e| cannot_create(&path, e))?;
        let lock = path.join(".lock");
        let file = File::options().create(true).append(true).open(&lock);
        let file = file.map_err(OutputError::io("write into", &path))?;
        // where files can't be locked, two sweeps at a time are the user's own affair
        if let Err(TryLockError::WouldBlock) = file.try_lock() {
            return Err(OutputError::Busy { path });
        }
        let folder = Self { path, _lock: file };
        if fresh {
            folder.clear()?;
        }
        write_json(&folder.manifest_file(), manifest)?;
        Ok(folder)
    }

    /// The folder itself.
    pub(super) fn path(&self) -> &Path {
        &self.path
    }
    fn manifest_file(&self) -> PathBuf {
        self.path.join("sweep.json")
    }
    /// `table.csv`: a row for each run.
    pub(super) fn table_file(&self) -> PathBuf {
        self.path.join("table.csv")
    }
    /// The folder of a run.
    pub(super) fn run(&self, name: &str) -> PathBuf {
        self.path.join("runs").join(name)
    }
    /// `plots/<name>.svg`
    ///
    /// # Errors
    /// A folder `plots` that can't be made.
    pub(super) fn plot_file(&self, name: &str) -> Result<PathBuf, OutputError> {
        RunFolder::earlier(self.path.clone()).plot_file(name)
    }

    /// `tables/<record>-final.csv`
    ///
    /// # Errors
    /// A folder `tables` that can't be made.
    pub(super) fn final_file(&self, record: &str) -> Result<PathBuf, OutputError> {
        RunFolder::earlier(self.path.clone()).table_file(&format!("{record}-final"))
    }

    /// Deletes what a sweep leaves; that it was a sweep is forgotten last, so that this may be interrupted.
    fn clear(&self) -> Result<(), OutputError> {
        let gone = |path: PathBuf, result: std::io::Result<()>| match result {
            Err(e) if e.kind() != ErrorKind::NotFound => Err(OutputError::io("delete", &path)(e)),
            _ => Ok(()),
        };
        for folder in ["runs", "plots", "tables"] {
            let path = self.path.join(folder);
            gone(path.clone(), fs::remove_dir_all(&path))?;
        }
        for path in [self.table_file(), self.manifest_file()] {
            gone(path.clone(), fs::remove_file(&path))?;
        }
        Ok(())
    }
}

fn look(path: &Path, manifest: &SweepManifest) -> Found {
    if let Ok(text) = fs::read_to_string(path.join("sweep.json")) {
        return match serde_json::from_str::<SweepManifest>(&text) {
            Ok(there) => manifest.difference(&there).map_or(Found::Same, Found::Other),
            Err(_) => Found::Other("whose sweep.json is damaged".into()),
        };
    }
    // a lock is all that a sweep leaves that was killed at once
    let is_lock = |e: std::io::Result<fs::DirEntry>| e.is_ok_and(|e| e.file_name() == ".lock");
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
