//! `ropewalk migrate SCENE`

use super::{Exit, complain, say};
use ropewalk_scene::{Fault, migrate, read_text};
pub use ropewalk_studies::Error;
use std::fs;
use std::path::{Path, PathBuf};

/// A scene file, and what becomes of it.
#[derive(Debug, clap::Args)]
pub(crate) struct MigrateArgs {
    /// A .toml or .json file
    #[arg(value_name = "SCENE")]
    scene: PathBuf,
    /// Write nothing; exit code 1 if there is something to rewrite
    #[arg(long, conflicts_with_all = ["out", "backup"])]
    check: bool,
    /// Write the new scene here instead of over the old one
    #[arg(long, short, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Keep the old scene beside the new one, as SCENE.bak
    #[arg(long, conflicts_with = "out")]
    backup: bool,
}

pub(crate) fn run(args: &MigrateArgs) -> Result<Exit, Error> {
    let (text, format) = read_text(&args.scene)?;
    let name = args.scene.display().to_string();
    let migrated = migrate(&text, &name, format)?;
    for change in &migrated.changes {
        let line = format!("{name}:{}", change.line);
        say(match (change.was.as_str(), change.now.as_str()) {
            ("", now) => format!("{line}: added {now}"),
            (was, "") => format!("{line}: removed {was}"),
            (was, now) => format!("{line}: {was} -> {now}"),
        });
    }
    for left in &migrated.left {
        complain(format!("warning: {left}"));
    }
    let count = migrated.changes.len();
    if count == 0 && migrated.left.is_empty() {
        say(format!("{name} uses the names of this version"));
    }
    if args.check {
        return Ok(if count == 0 && migrated.left.is_empty() { Exit::Done } else { Exit::Outside });
    }
    match &args.out {
        Some(out) => write(out, &migrated.text)?,
        None if count == 0 => {}
        None => {
            if args.backup {
                let mut backup = args.scene.clone().into_os_string();
                backup.push(".bak");
                let backup = PathBuf::from(backup);
                if backup.exists() {
                    let message = format!("there is `{}` already", backup.display());
                    return Err(Fault::new(message)
                        .with_help("move it away, or leave `--backup` out")
                        .into());
                }
                write(&backup, &text)?;
            }
            write(&args.scene, &migrated.text)?;
        }
    }
    Ok(Exit::Done)
}

fn write(path: &Path, text: &str) -> Result<(), Error> {
    fs::write(path, text)
        .map_err(|e| Fault::new(format!("`{}` can't be written: {e}", path.display())).into())
}
