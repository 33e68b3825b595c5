//! How long something takes, in wall time and in CPU time of its thread.

use std::time::Instant;

use cpu_time::ThreadTime;

/// How long something took.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Elapsed {
    /// Wall time, in seconds.
    pub wall_s: f64,
    /// CPU time of the thread, in seconds; NaN where the system can't tell.
    pub cpu_s: f64,
}

impl Elapsed {
    /// CPU time, or wall time where the system can't tell [s].
    pub fn cpu_or_wall_s(&self) -> f64 {
        if self.cpu_s.is_finite() { self.cpu_s } else { self.wall_s }
    }
}

/// Measures wall time and the CPU time of its thread from its start.
///
/// A run computes on one thread, so this is the CPU time of the run, whatever else the process does.
#[derive(Debug, Clone, Copy)]
pub struct Stopwatch {
    wall: Instant,
    cpu: Option<ThreadTime>,
}

impl Stopwatch {
    /// Starts now.
    pub fn start() -> Self {
        Self { wall: Instant::now(), cpu: ThreadTime::try_now().ok() }
    }

    /// Time since the start.
    pub fn elapsed(&self) -> Elapsed {
        let cpu = self.cpu.and_then(|start| start.try_elapsed().ok());
        Elapsed {
            wall_s: self.wall.elapsed().as_secs_f64(),
            cpu_s: cpu.map_or(f64::NAN, |time| time.as_secs_f64()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn sleeping_takes_time_but_no_work() {
        let stopwatch = Stopwatch::start();
        std::thread::sleep(Duration::from_millis(30));
        let elapsed = stopwatch.elapsed();
        assert!(elapsed.wall_s >= 0.03);
        assert!(elapsed.cpu_s.is_finite() && elapsed.cpu_s >= 0.0);
    }

    #[test]
    fn work_is_counted_as_cpu_time() {
        let stopwatch = Stopwatch::start();
        while stopwatch.wall.elapsed() < Duration::from_millis(30) {}
        assert!(stopwatch.elapsed().cpu_s > 0.0);
    }

    #[test]
    fn work_of_other_threads_is_not_counted() {
        let stopwatch = Stopwatch::start();
        let work = std::thread::spawn(|| {
            let own = Stopwatch::start();
            while own.elapsed().cpu_s < 0.02 {}
        });
        work.join().unwrap();
        assert!(stopwatch.elapsed().cpu_s < 0.02);
    }
}
