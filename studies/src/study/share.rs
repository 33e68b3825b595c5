//! Runs that several processes compute for the same study: each is computed beside its folder and becomes that by one
//! rename, so that nobody ever sees half a run, and two that compute the same one do no harm.

use std::fs;
use std::hash::{BuildHasher, RandomState};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

/// Ending of folders that are nobody's results yet.
const PART: &str = ".part";

/// A folder that is hidden, beside another one, and nobody else's, on this machine or another.
pub(super) fn beside(folder: &Path) -> PathBuf {
    // keys of hash maps are random, and different each time
    let own = RandomState::new().hash_one(std::process::id());
    folder.with_file_name(format!(".{own:016x}{PART}"))
}

/// Makes a folder that was computed beside it the folder of the run. If `complete` finds there what another process has
/// computed meanwhile, that is given back and stays; what isn't complete is replaced.
pub(super) fn publish<T>(
    own: &Path,
    folder: &Path,
    complete: impl Fn(&Path) -> Option<T>,
) -> io::Result<Option<T>> {
    loop {
        let Err(e) = fs::rename(own, folder) else { return Ok(None) };
        if !folder.exists() {
            return Err(e);
        }
        if let Some(there) = complete(folder) {
            remove(own)?;
            return Ok(Some(there));
        }
        let aside = beside(folder);
        match fs::rename(folder, &aside) {
            Err(e) if e.kind() == ErrorKind::NotFound => continue,
            moved => moved?,
        }
        // another one may have come between the look and the move
        if complete(&aside).is_none() || fs::rename(&aside, folder).is_err() {
            remove(&aside)?;
        }
    }
}

/// Deletes what processes that were killed have left among the runs; best effort.
pub(super) fn sweep_up(runs: &Path) {
    for entry in fs::read_dir(runs).into_iter().flatten().flatten() {
        let name = entry.file_name();
        let name = name.to_string_lossy();
        if name.starts_with('.') && name.ends_with(PART) {
            let _ = fs::remove_dir_all(entry.path());
        }
    }
}

fn remove(folder: &Path) -> io::Result<()> {
    match fs::remove_dir_all(folder) {
        Err(e) if e.kind() != ErrorKind::NotFound => Err(e),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A run is complete if it has a file of that name, and what is in it came of it.
    fn complete(folder: &Path) -> Option<String> {
        fs::read_to_string(folder.join("done")).ok()
    }

    fn run(folder: &Path, file: &str, text: &str) -> PathBuf {
        let own = beside(folder);
        fs::create_dir(&own).unwrap();
        fs::write(own.join(file), text).unwrap();
        own
    }

    #[test]
    fn the_first_complete_run_stays_and_an_incomplete_one_is_replaced() {
        let parent = tempfile::tempdir().unwrap();
        let folder = parent.path().join("a");
        let publish = |file: &str, text: &str| publish(&run(&folder, file, text), &folder, complete).unwrap();
        assert_eq!(publish("half", "0"), None);
        assert_eq!(publish("done", "1"), None);
        assert!(!folder.join("half").exists());
        assert_eq!(publish("done", "2").as_deref(), Some("1"));
        assert_eq!(publish("half", "3").as_deref(), Some("1"));
        assert_eq!(complete(&folder).as_deref(), Some("1"));
        assert_eq!(fs::read_dir(parent.path()).unwrap().count(), 1);
        // and what was killed before it came so far is swept up
        run(&folder, "done", "4");
        fs::create_dir(parent.path().join("b.part")).unwrap();
        sweep_up(parent.path());
        assert_eq!(fs::read_dir(parent.path()).unwrap().count(), 2);
    }

    #[test]
    fn many_at_once_leave_one() {
        let parent = tempfile::tempdir().unwrap();
        let folder = parent.path().join("a");
        std::thread::scope(|scope| {
            for k in 0..16 {
                let folder = &folder;
                let file = if k % 4 == 0 { "half" } else { "done" };
                scope.spawn(move || publish(&run(folder, file, &k.to_string()), folder, complete).unwrap());
            }
        });
        assert!(complete(&folder).is_some());
        assert_eq!(fs::read_dir(parent.path()).unwrap().count(), 1);
    }
}
