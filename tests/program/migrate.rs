//! Scenes of version 0.1, as that version came with them, in the words of today.

use crate::program::run;
use std::fs;
use std::path::Path;

#[test]
fn bundled_scenes_of_version_0_1_are_rewritten_and_built() {
    let folder = tempfile::tempdir().unwrap();
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/version-0.1");
    let mut names: Vec<_> = fs::read_dir(data).unwrap().map(|entry| entry.unwrap().path()).collect();
    names.sort();
    assert_eq!(names.len(), 8);
    for old in names {
        let name = old.file_name().unwrap().to_str().unwrap();
        fs::copy(&old, folder.path().join(name)).unwrap();
        let told = run(folder.path(), &["migrate", name]);
        assert_eq!(told.code, Some(0), "{name}: {}", told.stderr);
        let check = run(folder.path(), &["check", name]);
        assert_eq!((check.code, check.stderr.as_str()), (Some(0), ""), "{name}");
    }
}
