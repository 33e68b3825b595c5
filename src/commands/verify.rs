//! `ropewalk verify [NAME...]`

use super::{Exit, complain, interrupted, progress, say, warn};
use ropewalk_report::{OutputError, Watch, write_atomic};
use ropewalk_scene::{Fault, did_you_mean, quoted};
pub use ropewalk_studies::Error;
use ropewalk_studies::verify::{Case, Outcome, cases, heading, html, lines, page, picture};
use std::fs;
use std::path::{Path, PathBuf};

/// Which cases, and where their results go.
#[derive(Debug, clap::Args)]
pub(crate) struct VerifyArgs {
    /// Names of cases, or how they begin [default: all]
    #[arg(value_name = "NAME")]
    names: Vec<String>,
    /// List the cases and run none
    #[arg(long)]
    list: bool,
    /// Write the results as a page of Markdown or HTML, .md or .html, and a picture beside it; replaces an earlier page
    #[arg(long, short, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Write the scenes of the cases into a new or empty folder and run none
    #[arg(long, value_name = "DIR")]
    scenes: Option<PathBuf>,
    /// One line for each case
    #[arg(long, short)]
    brief: bool,
    /// Say nothing but what is outside its tolerance
    #[arg(long, short)]
    quiet: bool,
}

pub(crate) fn verify(args: &VerifyArgs) -> Result<Exit, Error> {
    let chosen = chosen(&args.names)?;
    if args.list {
        for case in &chosen {
            say(format!("{:<41} {:>2} quantities  {}", case.name, case.quantities(), case.title));
        }
        return Ok(Exit::Done);
    }
    if let Some(folder) = &args.scenes {
        return write_scenes(&chosen, folder);
    }
    if let Some(out) = &args.out {
        check_page(out)?;
    }
    let watch = Watch::signals(warn);
    let mut outcomes: Vec<Outcome> = Vec::new();
    for case in chosen {
        let outcome = case.run(progress(args.quiet), watch);
        if outcome.interrupted {
            return Ok(interrupted("no page is written"));
        }
        let runs = outcome.case.quantities() > 0;
        if !args.quiet || (runs && !outcome.is_within()) {
            say(heading(&outcome));
            if !args.brief {
                lines(&outcome).iter().for_each(say);
            }
        }
        outcomes.push(outcome);
    }
    if let Some(out) = &args.out {
        write_page(&outcomes, out)?;
    }
    let run = outcomes.iter().filter(|o| o.case.quantities() > 0);
    let outside: Vec<&str> = run.clone().filter(|o| !o.is_within()).map(|o| o.case.name).collect();
    if !outside.is_empty() {
        complain(format!("outside their tolerances: {}", outside.join(", ")));
        return Ok(Exit::Outside);
    }
    if !args.quiet {
        let cpu: f64 = outcomes.iter().map(|o| o.cpu_s).sum();
        say(format!("{} cases within their tolerances, {cpu:.1} s of CPU time", run.count()));
    }
    Ok(Exit::Done)
}

/// The cases whose names are given or begin so.
fn chosen(names: &[String]) -> Result<Vec<Case>, Error> {
    let all = cases();
    let known: Vec<&str> = all.iter().map(|c| c.name).collect();
    if let Some(name) =
        names.iter().find(|n| n.is_empty() || !known.iter().any(|k| k.starts_with(n.as_str())))
    {
        let near = known.iter().filter(|k| !name.is_empty() && k.contains(name.as_str())).copied();
        let near: Vec<&str> = near.collect();
        let fault = Fault::new(format!("there is no case {}", quoted(name)));
        let fault = match (near.as_slice(), did_you_mean(name, &known)) {
            ([_, ..], _) => fault.with_help(format!("did you mean {}?", near.join(" or "))),
            ([], Some(guess)) => fault.with_help(guess),
            ([], None) => fault.with_help("`ropewalk verify --list` names them all"),
        };
        return Err(fault.into());
    }
    let wanted = |c: &Case| names.is_empty() || names.iter().any(|n| c.name.starts_with(n.as_str()));
    Ok(all.into_iter().filter(wanted).collect())
}

/// Refuses to replace a file that is no page of results, before anything is computed.
fn check_page(out: &Path) -> Result<(), Error> {
    let refuse = |why: &str| {
        let fault = Fault::new(format!("{} {why}", out.display()));
        Err(fault.with_help("name a file of Markdown or HTML, such as docs/verification.md").into())
    };
    if out.is_dir() || out.file_name().is_none() {
        return refuse("is a folder, not a page");
    }
    if !is_html(out) && out.extension().is_none_or(|e| e != "md") {
        return refuse("doesn't end in .md or .html");
    }
    match fs::read_to_string(out) {
        Ok(text) if is_html(out) && text.contains("<title>Verification</title>") => Ok(()),
        Ok(text) if !text.starts_with(ropewalk_studies::verify::TITLE) => {
            refuse("is no page of results: it stays")
        }
        _ => Ok(()),
    }
}

fn is_html(out: &Path) -> bool {
    out.extension().is_some_and(|e| e == "html")
}

fn write_page(outcomes: &[Outcome], out: &Path) -> Result<(), Error> {
    if let Some(folder) = out.parent().filter(|f| !f.as_os_str().is_empty()) {
        fs::create_dir_all(folder).map_err(unwritten(folder))?;
    }
    let drawn = out.with_extension("svg");
    let name = drawn.file_name().unwrap_or_default().to_string_lossy();
    write_atomic(&drawn, &picture(outcomes)?)?;
    let text = if is_html(out) { html(outcomes, &name) } else { page(outcomes, &name) };
    write_atomic(out, &text)?;
    Ok(())
}

fn write_scenes(chosen: &[Case], folder: &Path) -> Result<Exit, Error> {
    fs::create_dir_all(folder).map_err(unwritten(folder))?;
    if fs::read_dir(folder).map_err(unwritten(folder))?.next().is_some() {
        return Err(OutputError::FolderInUse { path: folder.into() }.into());
    }
    let mut count = 0;
    for (name, text) in chosen.iter().flat_map(Case::scenes) {
        write_atomic(&folder.join(format!("{name}.toml")), &text)?;
        count += 1;
    }
    let scenes = if count == 1 { "scene" } else { "scenes" };
    say(format!("{count} {scenes} in {}", folder.display()));
    Ok(Exit::Done)
}

fn unwritten(path: &Path) -> impl FnOnce(std::io::Error) -> Error {
    let path = path.to_path_buf();
    move |source| OutputError::Io { action: "write", path, source }.into()
}
