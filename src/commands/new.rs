//! `ropewalk new NAME --from SCENE`

use super::shell::in_shell;
use super::{Exit, say, scene_schema};
use ropewalk_models::Bundled;
use ropewalk_report::{OutputError, write_atomic};
use ropewalk_scene::{Fault, Format, SceneText, quoted};
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
    /// Write the scene alone: no first line that names the schema for editors, and no `scene.schema.json` beside it
    #[arg(long)]
    no_schema: bool,
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
    let extension = text.format().extension();
    if path.extension().is_none_or(|own| !own.eq_ignore_ascii_case(extension)) {
        let message = format!("{} is written in the format of .{extension} files", quoted(&args.from));
        let other = path.with_extension(extension);
        return Err(Fault::new(message)
            .with_help(format!("name the new scene `{}`", other.display()))
            .into());
    }
    let mut file = File::create_new(&path).map_err(|e| match e.kind() {
        ErrorKind::AlreadyExists => Error::from(
            Fault::new(format!("there is `{}` already", path.display()))
                .with_help("choose another name, or move it away"),
        ),
        _ => OutputError::io("create", &path)(e).into(),
    })?;
    let schema = !args.no_schema && text.format() == Format::Toml;
    let own = if schema { with_schema(&text.text) } else { text.text.clone() };
    file.write_all(own.as_bytes()).map_err(OutputError::io("write", &path))?;
    let beside = path.with_file_name(scene_schema::FILE);
    // one of an earlier version is replaced, a file of somebody else's stays
    let ours = schema && std::fs::read_to_string(&beside).map_or(true, |old| scene_schema::is_one(&old));
    if ours {
        write_atomic(&beside, &scene_schema::text())?;
    }
    let (word, path) = (in_shell(&path.to_string_lossy()), path.display());
    let mut said = format!("{path}: {} to begin with\n", text.name);
    if ours {
        said += &format!("{}: what editors know of scenes (see `ropewalk book editors`)\n", beside.display());
    }
    say(format!("{said}  ropewalk describe {word}    what it consists of\n  ropewalk run {word}"));
    Ok(Exit::Done)
}

/// The scene with a first line by which editors find the schema beside it.
fn with_schema(text: &str) -> String {
    let rest = match text.split_once('\n') {
        Some((first, rest)) if first.starts_with("#:schema") => rest,
        _ => text,
    };
    format!("#:schema ./{}\n{rest}", scene_schema::FILE)
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
