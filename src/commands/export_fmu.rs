//! `ropewalk export-fmu SCENE`

use super::{Exit, say};
use crate::cli::SceneArgs;
use ropewalk_models::Bundled;
use ropewalk_report::OutputError;
use ropewalk_scene::{Fault, SceneText};
pub use ropewalk_studies::Error;
use ropewalk_studies::fmu::{Interface, Kind, LIBRARY, Resources};
use std::env::consts::{ARCH, DLL_PREFIX, DLL_SUFFIX, OS};
use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

/// A function that every such library has, by its name.
const ENTRY: &[u8] = b"fmi3InstantiateCoSimulation";
const REMEDY: &str = "build it by `cargo build --release -p ropewalk-fmu`, or name it by `--library`";

/// A scene, and where its FMU goes.
#[derive(Debug, clap::Args)]
pub(crate) struct ExportArgs {
    #[command(flatten)]
    scene: SceneArgs,
    /// The file to write [default: SCENE.fmu]
    #[arg(long, short, value_name = "FILE")]
    out: Option<PathBuf>,
    /// The shared library of the crate ropewalk-fmu [default: beside this program]
    #[arg(long, value_name = "FILE")]
    library: Option<PathBuf>,
}

pub(crate) fn run(args: &ExportArgs, bundled: &[Bundled]) -> Result<Exit, Error> {
    let text = SceneText::open(&args.scene.scene, bundled)?;
    let set = args.scene.overrides.clone();
    let (out, interface) = export(text, set, args.out.clone(), args.library.as_deref())?;
    let count = |is: fn(&Kind) -> bool| interface.variables().iter().filter(|v| is(&v.kind)).count();
    say(format!(
        "{}: FMI 3.0 for co-simulation, {} parameters, {} inputs, {} outputs, for {}",
        out.display(),
        count(|k| matches!(k, Kind::Parameter { .. })),
        count(|k| matches!(k, Kind::Input { .. })),
        count(|k| *k == Kind::Output),
        platform(),
    ));
    Ok(Exit::Done)
}

/// Writes a scene with these parameters as an FMU, by default `SCENE.fmu`, with the shared library of the crate ropewalk-fmu,
/// by default the one beside this program: where it is, and its variables.
///
/// # Errors
/// The scene is wrong, or is no run in time; there is no library; the file can't be written.
pub fn export(
    text: SceneText,
    set: Vec<String>,
    out: Option<PathBuf>,
    given: Option<&Path>,
) -> Result<(PathBuf, Interface), Error> {
    let interface = Interface::new(&text, &set)?;
    let library = library(given)?;
    let out = out.unwrap_or_else(|| PathBuf::from(format!("{}.fmu", text.name)));
    let resources = Resources { text, set };
    pack(&out, &interface, &resources, &library).map_err(OutputError::io("write", &out))?;
    Ok((out, interface))
}

/// The platform by the words of FMI.
fn platform() -> String {
    let os = if OS == "macos" { "darwin" } else { OS };
    format!("{ARCH}-{os}")
}

/// The shared library that the FMU takes along.
fn library(given: Option<&Path>) -> Result<Vec<u8>, Fault> {
    let name = format!("{DLL_PREFIX}{LIBRARY}{DLL_SUFFIX}");
    let beside = || Some(std::env::current_exe().ok()?.parent()?.join(&name));
    match given.map(Path::to_path_buf).or_else(beside) {
        Some(path) if path.is_file() => match fs::read(&path) {
            Ok(bytes) if bytes.windows(ENTRY.len()).any(|name| name == ENTRY) => Ok(bytes),
            read => {
                let why = read.map_or_else(|e| e.to_string(), |_| "it has no function of FMI".into());
                let message = format!("`{}` is not the shared library of the FMU: {why}", path.display());
                Err(Fault::new(message).with_help(REMEDY))
            }
        },
        found => {
            let place = found.map_or(name, |path| path.display().to_string());
            let fault =
                Fault::new(format!("the shared library of the FMU is missing: there is no `{place}`"));
            Err(fault.with_help(REMEDY))
        }
    }
}

fn pack(out: &Path, interface: &Interface, resources: &Resources, library: &[u8]) -> std::io::Result<()> {
    let mut zip = ZipWriter::new(File::create(out)?);
    let options = SimpleFileOptions::default();
    zip.start_file("modelDescription.xml", options)?;
    zip.write_all(interface.description().as_bytes())?;
    for (name, content) in resources.files().map_err(|e| std::io::Error::other(e.to_string()))? {
        zip.start_file(format!("resources/{name}"), options)?;
        zip.write_all(&content)?;
    }
    zip.start_file(
        format!("binaries/{}/{LIBRARY}{DLL_SUFFIX}", platform()),
        options.unix_permissions(0o755),
    )?;
    zip.write_all(library)?;
    zip.finish()?;
    Ok(())
}
