//! The checkpoint of a run: a file from which it goes on after it was interrupted or killed.
//!
//! The file is replaced as a whole, so that there is always one that can be read. It holds the simulation and everything
//! recorded so far, with every bit of every number, behind a line that says which program wrote it.

use super::leave::Leaves;
use super::ranges::Range;
use super::recorder::Recorder;
use super::shapes::Shape;
use super::steps::StepCourse;
use super::summary::{Happened, Status, Summary};
use crate::error::Error;
use ropewalk_core::{Checkpoint, Remeshed};
use ropewalk_report::{Elapsed, OutputError, RunFolder, Stopwatch, Table};
use ropewalk_scene::{Fault, quantity};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::path::{Path, PathBuf};
use std::str::FromStr;
use std::time::{Duration, Instant};

/// When checkpoints are written.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Every {
    /// After so much wall time, and when the run is interrupted.
    Time(Duration),
    /// After so many steps: the same checkpoints whatever else the machine does.
    Steps(u64),
}

impl FromStr for Every {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || {
            format!("expected a time such as `60s`, or a number of steps such as `500 steps`, not `{text}`")
        };
        let text_ = text.trim();
        if let Some(count) = text_.strip_suffix("steps").or_else(|| text_.strip_suffix("step")) {
            return match count.trim().parse() {
                Ok(0) | Err(_) => Err(wrong()),
                Ok(n) => Ok(Every::Steps(n)),
            };
        }
        let seconds = quantity::kind::TIME.parse(text_).map_err(|_| wrong())?;
        match Duration::try_from_secs_f64(seconds) {
            Ok(time) if !time.is_zero() => Ok(Every::Time(time)),
            _ => Err(wrong()),
        }
    }
}

/// What was asked of a run, and is asked of it still when it goes on.
#[derive(Clone, Copy, Serialize, Deserialize)]
pub(crate) struct Wishes {
    pub every: Every,
    pub leaves: Leaves,
    pub profile: bool,
}

/// What a checkpoint file holds.
#[derive(Serialize, Deserialize)]
pub(crate) struct Saved<'a> {
    /// The checksum of `scene.toml`.
    pub scene: u32,
    /// What the scene was called.
    pub name: Cow<'a, str>,
    pub wishes: Wishes,
    pub simulation: Checkpoint,
    pub table: Cow<'a, Table>,
    pub shapes: Cow<'a, [Shape]>,
    pub due: Cow<'a, [f64]>,
    pub field_due: Cow<'a, [f64]>,
    pub course: Cow<'a, Option<StepCourse>>,
    pub events: Cow<'a, [Happened]>,
    pub remeshed: Cow<'a, [Remeshed]>,
    pub ranges: Cow<'a, [Range]>,
    pub warnings: Cow<'a, [String]>,
    pub flutter: f64,
    pub cpu_s: f64,
    pub wall_s: f64,
}

/// Writes the checkpoints of a run.
pub(crate) struct Saver {
    path: PathBuf,
    scene: u32,
    name: String,
    wishes: Wishes,
    pub warnings: Vec<String>,
    flutter: f64,
    /// Time spent before this process.
    before: Elapsed,
    stopwatch: Stopwatch,
    last: Instant,
    steps: u64,
    /// Why checkpoints couldn't be written; said at the end.
    pub trouble: Option<OutputError>,
}

const MAGIC: &str = concat!("ropewalk checkpoint ", env!("CARGO_PKG_VERSION"), "\n");
const CRC: crc::Crc<u32> = crc::Crc::<u32>::new(&crc::CRC_32_ISCSI);

impl Saver {
    /// Prepares checkpoints of a run in this folder that has made so many `steps`.
    pub(crate) fn new(
        folder: &RunFolder,
        name: &str,
        wishes: Wishes,
        (flutter, steps): (f64, u64),
        warnings: &[String],
        (before, stopwatch): (Elapsed, Stopwatch),
    ) -> Result<Self, Error> {
        Ok(Saver {
            path: folder.checkpoint_file(),
            scene: scene_checksum(folder)?,
            name: name.to_string(),
            wishes,
            warnings: warnings.to_vec(),
            flutter,
            before,
            stopwatch,
            last: Instant::now(),
            steps,
            trouble: None,
        })
    }

    /// Tells of an accepted step.
    pub(crate) fn step(&mut self) {
        self.steps += 1;
    }

    /// Whether one is due; `ending` says that the run is about to be interrupted. Those by steps come at the same steps
    /// whatever happens.
    pub(crate) fn is_due(&self, ending: bool) -> bool {
        match self.wishes.every {
            Every::Time(time) => ending || self.last.elapsed() >= time,
            Every::Steps(n) => self.steps.is_multiple_of(n),
        }
    }

    /// Writes a checkpoint in place of the one before. The run goes on if that fails.
    pub(crate) fn write(&mut self, simulation: Checkpoint, recorder: &Recorder<'_>) {
        let elapsed = self.stopwatch.elapsed();
        let saved = Saved {
            scene: self.scene,
            name: Cow::Borrowed(&self.name),
            wishes: self.wishes,
            simulation,
            table: Cow::Borrowed(&recorder.table),
            shapes: Cow::Borrowed(&recorder.kept.shapes),
            due: Cow::Borrowed(&recorder.kept.due),
            field_due: Cow::Borrowed(&recorder.kept.field_due),
            course: Cow::Borrowed(&recorder.course),
            events: Cow::Borrowed(&recorder.events),
            remeshed: Cow::Borrowed(&recorder.remeshed),
            ranges: Cow::Borrowed(&recorder.ranges),
            warnings: Cow::Borrowed(&self.warnings),
            flutter: self.flutter,
            cpu_s: self.before.cpu_s + elapsed.cpu_s,
            wall_s: self.before.wall_s + elapsed.wall_s,
        };
        let written = postcard::to_extend(&saved, MAGIC.as_bytes().to_vec())
            .map_err(|e| OutputError::Checkpoint { path: self.path.clone(), message: e.to_string() })
            .and_then(|mut bytes| {
                bytes.extend_from_slice(&CRC.checksum(&bytes).to_le_bytes());
                ropewalk_report::write_durable(&self.path, &bytes)
            });
        self.trouble = written.err();
        self.last = Instant::now();
    }
}

/// Reads the checkpoint of a folder.
pub fn read(folder: &RunFolder) -> Result<Saved<'static>, Error> {
    let (path, shown) = (folder.checkpoint_file(), folder.path().display());
    if !path.exists() {
        return Err(without_checkpoint(folder).into());
    }
    let bytes = std::fs::read(&path).map_err(OutputError::io("read", &path))?;
    let damaged = |why: &str| -> Error {
        OutputError::Checkpoint { path: path.clone(), message: format!("{why}; the run has to begin anew") }
            .into()
    };
    let Some(body) = bytes.strip_prefix(MAGIC.as_bytes()) else {
        let end = bytes.iter().take(60).position(|b| *b == b'\n').unwrap_or(0);
        let line = String::from_utf8_lossy(&bytes[..end]);
        return Err(match line.strip_prefix("ropewalk checkpoint ") {
            Some(version) => damaged(&format!(
                "it was written by version {version} of this program, which is {}",
                env!("CARGO_PKG_VERSION")
            )),
            None => damaged("this is not a checkpoint"),
        });
    };
    let Some((whole, sum)) = bytes.split_last_chunk::<4>() else { return Err(damaged("it is cut off")) };
    if CRC.checksum(whole) != u32::from_le_bytes(*sum) || body.len() < 4 {
        return Err(damaged("it is damaged"));
    }
    let saved: Saved<'static> = postcard::from_bytes(&body[..body.len() - 4])
        .map_err(|e| damaged(&format!("it can't be read by this program ({e})")))?;
    if saved.scene != scene_checksum(folder)? {
        let message = format!(
            "scene.toml or a file of inputs/ in {shown} was changed after the checkpoint, which belongs to the old one"
        );
        return Err(Fault::new(message).with_help("run the new scene with `ropewalk run`").into());
    }
    Ok(saved)
}

/// Why there is nothing to go on from in a folder, and what to do.
fn without_checkpoint(folder: &RunFolder) -> Fault {
    let shown = folder.path().display();
    let again = "its results so far stay where they are; `ropewalk run` with `--checkpoint 60s` and another folder runs \
                 it again such that it can be resumed";
    match folder.read_summary().map(|summary: Summary| summary.status) {
        Ok(status) if status.is_complete() => {
            Fault::new(format!("there is nothing to resume in {shown}: that run came to its end"))
        }
        Ok(status) => {
            let how = if status == Status::Failed { "failed" } else { "was interrupted" };
            Fault::new(format!("there is no checkpoint in {shown}: that run {how} before it wrote one"))
                .with_help(again)
        }
        Err(_) if folder.scene_file().exists() => {
            let message = format!(
                "there is no checkpoint in {shown}: that run is still at work, or was killed before it wrote one"
            );
            Fault::new(message).with_help(again)
        }
        Err(_) => {
            let what = if folder.path().exists() { "holds no run" } else { "doesn't exist" };
            Fault::new(format!("there is no checkpoint in {shown}: it {what}"))
                .with_help("name a folder that `ropewalk run --checkpoint 60s` left behind")
        }
    }
}

fn scene_checksum(folder: &RunFolder) -> Result<u32, Error> {
    let read = |path: &Path| std::fs::read(path).map_err(OutputError::io("read", path));
    let mut digest = CRC.digest();
    digest.update(&read(&folder.scene_file())?);
    // with the copies of what it names, in an order of their own
    let inputs = std::fs::read_dir(folder.path().join("inputs")).into_iter().flatten().flatten();
    let mut inputs: Vec<PathBuf> = inputs.map(|entry| entry.path()).collect();
    inputs.sort();
    for path in &inputs {
        digest.update(&read(path)?);
    }
    Ok(digest.finalize())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn schedules_are_times_or_steps() {
        assert_eq!("60s".parse(), Ok(Every::Time(Duration::from_secs(60))));
        assert_eq!("2 min".parse(), Ok(Every::Time(Duration::from_secs(120))));
        assert_eq!("500 steps".parse(), Ok(Every::Steps(500)));
        for wrong in ["", "0 s", "-1 s", "0 steps", "5 m", "steps", "nan s"] {
            assert!(wrong.parse::<Every>().is_err(), "{wrong}");
        }
    }
}
