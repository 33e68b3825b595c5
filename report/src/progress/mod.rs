//! What a run shows while it computes: a bar on a terminal, a few lines elsewhere, or nothing.

mod spark;
mod sweep;

use std::fmt;
use std::io::{self, IsTerminal, Write};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use super::{Elapsed, Stopwatch};
use spark::Spark;
pub use sweep::SweepProgress;

/// Steps between two looks at the clock while steps are short: a look costs tens of ns.
const STRIDE: u32 = 64;
/// Steps longer than this on average are each looked at.
const SLOW_STEP: Duration = Duration::from_millis(1);
/// The bar is redrawn at most this often.
const BAR_PERIOD: Duration = Duration::from_millis(100);
/// Lines never follow each other faster than this …
const LINE_PERIOD: Duration = Duration::from_secs(5);
/// … and after this time one is due even if the run has hardly advanced.
const LONGEST_SILENCE: Duration = Duration::from_secs(60);
/// Share of the run after which a line is due.
const LINE_SHARE: f64 = 0.1;
/// Units of a full bar.
const BAR_LENGTH: u64 = 1000;

/// How a run reports its progress.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ProgressMode {
    /// A bar if standard error is a terminal, lines if not.
    #[default]
    Auto,
    /// A bar that is redrawn in place.
    Bar,
    /// Plain lines for a log file: one for each tenth of the run, at most one in 5 s.
    Lines,
    /// Nothing at all (`--quiet`).
    Quiet,
}

/// Shows how far a run has come, on standard error.
///
/// [`step`](Self::step) is cheap enough for every accepted step: a few ns on average.
///
/// ```
/// # use ropewalk_report::{Progress, ProgressMode};
/// let mut progress = Progress::new(0.0, 10.0, ProgressMode::Quiet);
/// progress.step(0.1, 0.1, 0);
/// let elapsed = progress.finish("finished at t = 10 s");
/// assert!(elapsed.wall_s < 10.0);
/// ```
pub struct Progress {
    t_start: f64,
    t_end: f64,
    shown: Shown,
    stopwatch: Stopwatch,
    steps: u64,
    rejected: u64,
    /// What limited the last step, if that is told.
    limit: &'static str,
    stride: u32,
    until_look: u32,
    last_look: Instant,
    last_shown: Instant,
    last_share: f64,
    rate: Rate,
    /// The record whose course is shown, if one is.
    spark: Option<Spark>,
}

enum Shown {
    Bar(ProgressBar),
    Lines(Box<dyn Write + Send>),
    Nothing,
}

impl Progress {
    /// Begins to show a run from `t_start` to `t_end`, in seconds.
    pub fn new(t_start: f64, t_end: f64, mode: ProgressMode) -> Self {
        let on_terminal = io::stderr().is_terminal();
        let shown = match mode {
            ProgressMode::Quiet => Shown::Nothing,
            ProgressMode::Auto if !on_terminal => Shown::Lines(Box::new(io::stderr())),
            ProgressMode::Lines => Shown::Lines(Box::new(io::stderr())),
            ProgressMode::Auto | ProgressMode::Bar => Shown::Bar(new_bar(BAR_LENGTH)),
        };
        Self::showing(t_start, t_end, shown)
    }

    /// Writes lines as [`ProgressMode::Lines`] does, but to `writer`.
    pub fn to_writer(t_start: f64, t_end: f64, writer: Box<dyn Write + Send>) -> Self {
        Self::showing(t_start, t_end, Shown::Lines(writer))
    }

    fn showing(t_start: f64, t_end: f64, shown: Shown) -> Self {
        let now = Instant::now();
        Self {
            t_start,
            t_end,
            shown,
            stopwatch: Stopwatch::start(),
            steps: 0,
            rejected: 0,
            limit: "",
            stride: 1,
            until_look: 1,
            last_look: now,
            last_shown: now,
            last_share: 0.0,
            rate: Rate::new(t_start, now),
            spark: None,
        }
    }

    /// Shows the course of a record of this name and unit besides, whose values [`value`](Self::value) takes.
    pub fn follow(&mut self, name: &str, unit: &str) {
        self.spark = Some(Spark::new(name, unit));
    }

    /// Takes the value of the followed record at time `t` [s].
    pub fn value(&mut self, t: f64, value: f64) {
        let share = self.share(t);
        if let Some(spark) = &mut self.spark {
            spark.push(share, value);
        }
    }

    /// How much of the run is done at a time, 0 … 1.
    fn share(&self, t: f64) -> f64 {
        ((t - self.t_start) / (self.t_end - self.t_start)).clamp(0.0, 1.0)
    }

    /// Tells of an accepted step of size `h` that has reached time `t` (both in seconds) after
    /// `rejected` tries that were thrown away.
    #[inline]
    pub fn step(&mut self, t: f64, h: f64, rejected: u32) {
        self.steps += 1;
        self.rejected += u64::from(rejected);
        self.until_look -= 1;
        if self.until_look == 0 {
            self.look(t, h);
        }
    }

    /// Says what limited the step that [`step`](Self::step) is told of next: `position error`.
    #[inline]
    pub fn limited(&mut self, by: &'static str) {
        self.limit = by;
    }

    /// Takes the bar away, writes `message` (unless it is empty or all is quiet), and returns how
    /// long the run took.
    pub fn finish(mut self, message: &str) -> Elapsed {
        if let Shown::Bar(bar) = &self.shown {
            bar.finish_and_clear();
        }
        if !message.is_empty() {
            match &mut self.shown {
                Shown::Bar(_) => put_line(&mut io::stderr(), message),
                Shown::Lines(writer) => put_line(writer, message),
                Shown::Nothing => {}
            }
        }
        self.stopwatch.elapsed()
    }

    #[cold]
    fn look(&mut self, t: f64, h: f64) {
        let now = Instant::now();
        let slow = now.duration_since(self.last_look) > SLOW_STEP * self.stride;
        self.last_look = now;
        self.stride = if slow { 1 } else { STRIDE };
        self.until_look = self.stride;
        if matches!(self.shown, Shown::Nothing) {
            return;
        }
        let share = self.share(t);
        let silence = now.duration_since(self.last_shown);
        let due = match self.shown {
            Shown::Bar(_) => silence >= BAR_PERIOD,
            _ => line_due(share - self.last_share, silence),
        };
        if !due {
            return;
        }
        self.rate.update(t, now);
        self.last_shown = now;
        self.last_share = share;
        let (t_end, rejected, limit) = (self.t_end, self.rejected, self.limit);
        let (speed, spark) = (self.rate.value, self.spark.as_ref());
        let report = Report { t, t_end, h, limit, rejected, speed, spark };
        match &mut self.shown {
            Shown::Bar(bar) => {
                bar.set_message(report.to_string());
                bar.set_position((share * BAR_LENGTH as f64) as u64);
            }
            Shown::Lines(writer) => {
                put_line(writer, &format!("{:3.0} %  {report}", share * 100.0));
            }
            Shown::Nothing => {}
        }
    }
}

impl fmt::Debug for Progress {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Progress")
            .field("t_start", &self.t_start)
            .field("t_end", &self.t_end)
            .field("steps", &self.steps)
            .finish_non_exhaustive()
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        // A run that fails leaves no half bar above the error message.
        if let Shown::Bar(bar) = &self.shown {
            bar.finish_and_clear();
        }
    }
}

/// Whether a log file should have another line after an advance by this share of the whole.
fn line_due(advanced: f64, silence: Duration) -> bool {
    silence >= LONGEST_SILENCE || (advanced >= LINE_SHARE && silence >= LINE_PERIOD)
}

/// Simulated time per real time: the mean over the last ten seconds or so, so that the remaining
/// time follows a run that becomes slower.
#[derive(Debug)]
struct Rate {
    t: f64,
    at: Instant,
    value: Option<f64>,
}

impl Rate {
    const MEMORY_S: f64 = 10.0;

    fn new(t: f64, at: Instant) -> Self {
        Self { t, at, value: None }
    }

    fn update(&mut self, t: f64, now: Instant) {
        let wall = now.duration_since(self.at).as_secs_f64();
        if wall <= 0.0 {
            return;
        }
        let fresh = (t - self.t) / wall;
        let kept = (-wall / Self::MEMORY_S).exp();
        self.value = Some(self.value.map_or(fresh, |old| old * kept + fresh * (1.0 - kept)));
        self.t = t;
        self.at = now;
    }
}

/// What is said about a run on its way.
struct Report<'a> {
    t: f64,
    t_end: f64,
    h: f64,
    limit: &'static str,
    rejected: u64,
    speed: Option<f64>,
    spark: Option<&'a Spark>,
}

impl fmt::Display for Report<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // What matters most first: a narrow terminal cuts the end off.
        write!(f, "t {}/{} s", Short(self.t), Short(self.t_end))?;
        let speed = self.speed.filter(|speed| *speed > 0.0);
        let left = speed.map(|speed| (self.t_end - self.t).max(0.0) / speed);
        if let Some(left) = left.filter(|left| left.is_finite()) {
            write!(f, ", {} left", Clock(left))?;
        }
        if let Some(spark) = self.spark {
            write!(f, ", {spark}")?;
        }
        write!(f, ", h {} s", Short(self.h))?;
        if !self.limit.is_empty() {
            write!(f, " by {}", self.limit)?;
        }
        if let Some(speed) = speed {
            write!(f, ", {} x real time", Short(speed))?;
        }
        if self.rejected > 0 {
            write!(f, ", {} rejected", self.rejected)?;
        }
        Ok(())
    }
}

/// A number in three significant digits, or all those before the point.
struct Short(f64);

impl fmt::Display for Short {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = self.0.abs();
        if size == 0.0 {
            write!(f, "0")
        } else if !(1e-3..1e6).contains(&size) {
            write!(f, "{:.2e}", self.0)
        } else {
            let decimals = (2.0 - size.log10().floor()).max(0.0) as usize;
            let text = format!("{:.decimals$}", self.0);
            let text = match text.contains('.') {
                true => text.trim_end_matches('0').trim_end_matches('.'),
                false => &text,
            };
            write!(f, "{text}")
        }
    }
}

/// Seconds as `m:ss` or `h:mm:ss`.
struct Clock(f64);

impl fmt::Display for Clock {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let s = self.0.ceil() as u64;
        match s {
            0..3600 => write!(f, "{}:{:02}", s / 60, s % 60),
            3600..360_000 => write!(f, "{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60),
            _ => write!(f, "{} days", s / 86_400),
        }
    }
}

/// A bar on standard error that is full at `length`; nothing is seen where that is no terminal.
pub fn new_bar(length: u64) -> ProgressBar {
    // This module limits the rate itself, before the message is even written.
    let bar = ProgressBar::with_draw_target(Some(length), ProgressDrawTarget::stderr());
    with_style(bar, "{bar:18.cyan/dim} {percent:>3} %  {wide_msg}")
}

fn with_style(bar: ProgressBar, template: &str) -> ProgressBar {
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style.progress_chars("━╸─"));
    }
    bar
}

/// A closed terminal or log must not stop a run.
fn put_line(writer: &mut dyn Write, line: &str) {
    let _ = writeln!(writer, "{line}").and_then(|()| writer.flush());
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::{Arc, Mutex};

    #[derive(Clone, Default)]
    struct Log(Arc<Mutex<Vec<u8>>>);

    impl Write for Log {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            self.0.lock().unwrap().write(bytes)
        }
        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    impl Log {
        fn text(&self) -> String {
            String::from_utf8(self.0.lock().unwrap().clone()).unwrap()
        }
    }

    #[test]
    fn a_short_run_says_only_how_it_ended() {
        let log = Log::default();
        let mut progress = Progress::to_writer(0.0, 1.0, Box::new(log.clone()));
        for i in 1..=10_000 {
            progress.step(f64::from(i) * 1e-4, 1e-4, 0);
        }
        let elapsed = progress.finish("finished at t = 1 s");
        assert_eq!(log.text(), "finished at t = 1 s\n");
        assert!(elapsed.wall_s > 0.0 && elapsed.cpu_s >= 0.0);
    }

    #[test]
    fn a_long_run_says_where_it_is_and_how_long_it_will_take() {
        let log = Log::default();
        let mut progress = Progress::to_writer(0.0, 10.0, Box::new(log.clone()));
        let past = Instant::now().checked_sub(Duration::from_secs(8)).unwrap();
        (progress.last_shown, progress.rate.at) = (past, past);
        progress.step(2.0, 0.0125, 3);
        let text = log.text();
        let lines = ["0:32", "0:33"]
            .map(|left| format!(" 20 %  t 2/10 s, {left} left, h 0.0125 s, 0.25 x real time, 3 rejected\n"));
        assert!(lines.contains(&text), "{text}");
        progress.last_look = past;
        progress.step(5.0, 0.0125, 0);
        assert_eq!(log.text(), text, "no second line within 5 s");
        (progress.until_look, progress.last_shown) = (1, past);
        progress.limited("force error");
        progress.step(6.0, 0.0125, 0);
        assert!(log.text().contains(", h 0.0125 s by force error, "), "{}", log.text());
    }

    #[test]
    fn slow_steps_are_each_looked_at() {
        let mut progress = Progress::to_writer(0.0, 1.0, Box::new(io::sink()));
        progress.last_look = Instant::now().checked_sub(Duration::from_secs(1)).unwrap();
        progress.step(0.1, 0.1, 0);
        assert_eq!(progress.until_look, 1);
        progress.step(0.2, 0.1, 0);
        assert_eq!(progress.until_look, STRIDE);
    }

    #[test]
    fn a_step_costs_little() {
        let mut progress = Progress::to_writer(0.0, 1.0, Box::new(io::sink()));
        let start = Instant::now();
        for i in 0..1_000_000 {
            progress.step(f64::from(i) * 1e-6, 1e-6, 0);
        }
        // Generous: unoptimised, on a loaded machine.
        assert!(start.elapsed() < Duration::from_secs(1));
    }

    #[test]
    fn a_backward_or_empty_span_does_no_harm() {
        for (t_start, t_end) in [(0.0, 0.0), (1.0, 0.0), (0.0, f64::INFINITY)] {
            let mut progress = Progress::to_writer(t_start, t_end, Box::new(io::sink()));
            progress.last_shown = Instant::now().checked_sub(Duration::from_secs(99)).unwrap();
            progress.step(0.5, f64::NAN, 0);
            progress.finish("");
        }
    }

    #[test]
    fn numbers_and_times_are_short() {
        let texts: Vec<_> =
            [0.0, 1.0, 0.0125, 123.456, 98_765.4, 1.5e-5, 2e7].map(|v| Short(v).to_string()).into();
        assert_eq!(texts, ["0", "1", "0.0125", "123", "98765", "1.50e-5", "2.00e7"]);
        let times = [0.0, 59.2, 3599.0, 3601.0, 1e6].map(|v| Clock(v).to_string());
        assert_eq!(times, ["0:00", "1:00", "59:59", "1:00:01", "11 days"]);
    }
}
