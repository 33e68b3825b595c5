//! Files that a scene names, read such that nothing hangs and nothing eats the memory.

use std::fs::File;
use std::io::Read;
use std::path::Path;

/// Opens a regular file for reading. Pipes and devices may never begin or never end.
///
/// # Errors
/// What is wrong with it, without its name: it isn't there, it may not be read, or it is something else.
pub fn open(path: &Path) -> Result<File, String> {
    let about = std::fs::metadata(path).map_err(|e| e.to_string())?;
    if about.is_dir() {
        return Err("it is a directory, not a file".into());
    }
    if !about.is_file() {
        return Err("it is a pipe or a device, not a regular file".into());
    }
    File::open(path).map_err(|e| e.to_string())
}

/// The text of a regular file of at most so many bytes.
///
/// # Errors
/// As [`open`]; it is longer, or no text.
pub fn text(path: &Path, most: u64) -> Result<String, String> {
    let mut bytes = Vec::new();
    open(path)?.take(most + 1).read_to_end(&mut bytes).map_err(|e| e.to_string())?;
    if bytes.len() as u64 > most {
        return Err(format!("it is larger than {} MB", most >> 20));
    }
    String::from_utf8(bytes).map_err(|_| "it is not a text file (UTF-8)".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_regular_files_of_some_size_are_read() {
        let fault = |path: &str, most| text(Path::new(path), most).unwrap_err();
        let own = concat!(env!("CARGO_MANIFEST_DIR"), "/src/file.rs");
        assert!(text(Path::new(own), 1 << 20).unwrap().starts_with("//! Files"));
        assert!(fault(own, 100).contains("it is larger than"));
        assert!(fault(env!("CARGO_MANIFEST_DIR"), 100).contains("it is a directory"));
        assert!(!fault("/nowhere/table.csv", 100).is_empty());
        if cfg!(target_os = "linux") {
            assert!(fault("/dev/zero", 100).contains("not a regular file"));
        }
    }
}
