//! What a sweep shows: how many runs are done, and where those are that compute just now.

use super::{
    BAR_LENGTH, BAR_PERIOD, Clock, Progress, ProgressMode, Shown, line_due, new_bar, put_line, with_style,
};
use indicatif::{MultiProgress, ProgressBar, ProgressDrawTarget};
use std::io::{self, IsTerminal};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

/// Shows how far a sweep has come, on standard error: a bar for each run that computes and one for the whole, or now
/// and then a line where there is no terminal. All threads share one.
pub struct SweepProgress {
    bars: Option<(MultiProgress, ProgressBar)>,
    quiet: bool,
    state: Mutex<State>,
}

struct State {
    total: usize,
    done: usize,
    /// Of those, runs of an earlier call, which cost nothing.
    earlier: usize,
    start: Instant,
    last_line: Instant,
    last_share: f64,
}

impl SweepProgress {
    /// Begins to show a sweep of `total` runs.
    pub fn new(total: usize, mode: ProgressMode) -> Self {
        let on_terminal = io::stderr().is_terminal();
        let with_bars = mode == ProgressMode::Bar || mode == ProgressMode::Auto && on_terminal;
        let bars = with_bars.then(|| {
            let all = MultiProgress::with_draw_target(ProgressDrawTarget::stderr());
            let whole = ProgressBar::new(total as u64);
            let whole = all.add(with_style(whole, "{bar:40.green/dim} {pos}/{len} runs  {wide_msg}"));
            whole.tick();
            (all, whole)
        });
        let now = Instant::now();
        let state = State { total, done: 0, earlier: 0, start: now, last_line: now, last_share: 0.0 };
        Self { bars, quiet: mode == ProgressMode::Quiet, state: Mutex::new(state) }
    }

    /// Raises the number of runs, where one run tells which the next ones are.
    pub fn plan(&self, more: usize) {
        let mut s = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        s.total += more;
        if let Some((_, whole)) = &self.bars {
            whole.set_length(s.total as u64);
        }
    }

    /// The progress of one run up to `t_end`, in seconds.
    pub fn begin(&self, name: &str, t_end: f64) -> Progress {
        let shown = match &self.bars {
            Some((all, whole)) => {
                // above the whole, since what has ended is forgotten from above
                let bar = with_style(
                    all.insert_before(whole, new_bar(BAR_LENGTH)),
                    "  {prefix:30!} {bar:18.cyan/dim} {percent:>3} %  {wide_msg}",
                );
                bar.set_prefix(name.to_string());
                Shown::Bar(bar)
            }
            None => Shown::Nothing,
        };
        Progress::showing(0.0, t_end, shown)
    }

    /// Tells of a run that has ended, or that had ended in an `earlier` call.
    pub fn done(&self, earlier: bool) {
        let mut s = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        s.done += 1;
        s.earlier += usize::from(earlier);
        let now = Instant::now();
        let silence = now.duration_since(s.last_line);
        match &self.bars {
            Some((_, whole)) if silence >= BAR_PERIOD || !earlier => {
                s.last_line = now;
                whole.set_message(s.left(now));
                whole.set_position(s.done as u64);
            }
            Some(_) => {}
            None if self.quiet => {}
            None => {
                let share = s.done as f64 / s.total.max(1) as f64;
                if s.done < s.total && line_due(share - s.last_share, silence) {
                    (s.last_line, s.last_share) = (now, share);
                    let text =
                        format!("{:3.0} %  {} of {} runs {}", 100.0 * share, s.done, s.total, s.left(now));
                    put_line(&mut io::stderr(), text.trim_end());
                }
            }
        }
    }

    /// Writes lines to standard error without harm to the bars.
    pub fn say(&self, text: &str) {
        match &self.bars {
            Some((all, _)) => all.suspend(|| put_line(&mut io::stderr(), text)),
            None => put_line(&mut io::stderr(), text),
        }
    }

    /// Takes the bars away.
    pub fn finish(self) {
        if let Some((all, whole)) = &self.bars {
            whole.finish_and_clear();
            // a bar that could not be cleared does no harm
            let _ = all.clear();
        }
    }
}

impl State {
    /// What is left, if it can be told.
    fn left(&self, now: Instant) -> String {
        let computed = self.done - self.earlier;
        if computed == 0 {
            return String::new();
        }
        let each = now.duration_since(self.start).as_secs_f64() / computed as f64;
        format!("{} left", Clock(each * (self.total - self.done) as f64))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn what_is_left_is_told_from_what_was_computed() {
        let progress = SweepProgress::new(10, ProgressMode::Quiet);
        for earlier in [true, true, true, true, false, false] {
            progress.done(earlier);
        }
        let s = progress.state.lock().unwrap();
        assert_eq!((s.done, s.earlier), (6, 4));
        assert_eq!(s.left(s.start + Duration::from_secs(30)), "1:00 left");
    }

    #[test]
    fn many_threads_share_it() {
        let progress = SweepProgress::new(40, ProgressMode::Bar);
        std::thread::scope(|scope| {
            for _ in 0..4 {
                scope.spawn(|| {
                    for _ in 0..10 {
                        let mut one = progress.begin("a=1", 1.0);
                        one.step(1.0, 1.0, 0);
                        one.finish("");
                        progress.done(false);
                    }
                });
            }
        });
        assert_eq!(progress.state.lock().unwrap().done, 40);
        progress.finish();
    }
}
