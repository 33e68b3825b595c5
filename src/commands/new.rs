//! `ropewalk new NAME --from SCENE`

use super::{Exit, say};
use ropewalk_models::Bundled;
use ropewalk_report::OutputError;
use ropewalk_scene::{Fault, SceneText, quoted};
pub use ropewalk_studies::Error;
use std::fs::File;
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

/// Where a scene of one's own begins.
#[derive(Debug, clap::Args)]
pub(crate) struct NewArgs {
    /// Name of the new scene, or its path
    #[arg(value_name = "NAME")]
    name: PathBuf,
    /// A bundled scene, one of the gallery, or a .toml or .json file
    #[arg(long, value_name = "SCENE", default_value = "simple-pendulum")]
    from: String,
}

pub(crate) fn new(args: &NewArgs, bundled: &[Bundled]) -> Result<Exit, Error> {
    let text = SceneText::open(&args.from, bundled)?;
    // a scene that can't be built is no beginning
    text.with(&[])?.build()?;
    let path = path(&args.name, text.format().extension());
    if args.name.file_name().is_none() {
        let name = args.name.display().to_string();
        return Err(Fault::new(format!("{} is no name for a scene", quoted(&name))).into());
    }
    let mut file = File::create_new(&path).map_err(|e| match e.kind() {
        ErrorKind::AlreadyExists => Error::from(
            Fault::new(format!("there is `{}` already", path.display()))
                .with_help("choose another name, or move it away"),
        ),
        _ => OutputError::io("create", &path)(e).into(),
    })?;
    file.write_all(text.text.as_bytes()).map_err(OutputError::io("write", &path))?;
    let path = path.display();
    say(format!(
        "{path}: {} to begin with\n  ropewalk describe {path}    what it consists of\n  ropewalk run {path}",
        text.name
    ));
    Ok(Exit::Done)
}

/// The file of a new scene; files that the old one names are found from where it is.
fn path(name: &Path, extension: &str) -> PathBuf {
    let known =
        name.extension().is_some_and(|e| e.eq_ignore_ascii_case("toml") || e.eq_ignore_ascii_case("json"));
    if known {
        return name.to_path_buf();
    }
    let mut path = name.as_os_str().to_os_string();
    path.push(".");
    path.push(extension);
    path.into()
}
