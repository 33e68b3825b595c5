//! What may stop a computation from outside: a signal, a flag, or a deadline.

use super::Interrupt;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// What may stop a computation: Ctrl-C and other signals, a flag, and the end of the time that it is given. It is asked
/// after every step; without any it never stops anything, and no signal handler is installed.
#[derive(Clone, Copy, Debug, Default)]
pub struct Watch {
    interrupt: Option<Interrupt>,
    flag: Option<&'static AtomicBool>,
    deadline: Option<Instant>,
}

impl Watch {
    /// Listens to signals, which takes them from the process for good: for programs, not for libraries. If the system
    /// refuses, `warn` is told and the computation can't be stopped by them.
    pub fn signals(warn: impl FnOnce(&str)) -> Self {
        let interrupt = Interrupt::install().map_err(|e| warn(&e.to_string())).ok();
        Watch { interrupt, ..Watch::default() }
    }
    /// Stops when the flag is set, from whichever thread. The same as Ctrl-C to what is stopped; for programs with
    /// signal handlers, windows or requests of their own.
    pub fn flag(flag: &'static AtomicBool) -> Self {
        Watch { flag: Some(flag), ..Watch::default() }
    }
    /// The same with this deadline, unless there is an earlier one.
    #[must_use]
    pub fn until(self, deadline: Option<Instant>) -> Self {
        Watch { deadline: [self.deadline, deadline].into_iter().flatten().min(), ..self }
    }
    /// Time that is left until the deadline [s]; infinite without one.
    pub fn left(self) -> f64 {
        self.deadline.map_or(f64::INFINITY, |d| d.saturating_duration_since(Instant::now()).as_secs_f64())
    }
    /// Whether a signal came or the flag is set.
    pub fn is_interrupted(self) -> bool {
        self.interrupt.is_some_and(Interrupt::requested)
            || self.flag.is_some_and(|f| f.load(Ordering::Relaxed))
    }
    /// Whether a signal came, the flag is set, or the time is up.
    pub fn is_over(self) -> bool {
        self.is_interrupted() || self.deadline.is_some_and(|d| Instant::now() >= d)
    }
    /// The same for observers: break if it is time to stop.
    pub fn check(self) -> ControlFlow<()> {
        if self.is_over() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn the_earlier_deadline_counts() {
        let never = Watch::default();
        assert!(!never.is_over() && never.left() == f64::INFINITY && never.check().is_continue());
        let now = Instant::now();
        let later = never.until(now.checked_add(Duration::from_secs(1000)));
        assert!(!later.is_over() && later.left() > 900.0);
        let over = later.until(Some(now)).until(None);
        assert!(over.is_over() && !over.is_interrupted() && over.left() == 0.0 && over.check().is_break());
    }

    #[test]
    fn a_flag_interrupts() {
        static FLAG: AtomicBool = AtomicBool::new(false);
        let watch = Watch::flag(&FLAG);
        assert!(!watch.is_over());
        FLAG.store(true, Ordering::Relaxed);
        assert!(watch.is_interrupted() && watch.check().is_break() && !Watch::default().is_over());
    }
}
