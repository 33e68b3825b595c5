//! What forces ask of numbers that may be read from inputs.

use ropewalk_core::Signal;

/// The least value that a signal can have.
pub(crate) fn least(signal: &Signal) -> f64 {
    match signal {
        Signal::Constant(x) => *x,
        Signal::Input(input) => input.limits()[0],
    }
}

/// How fast it changes at a time.
pub(crate) fn rate(signal: &Signal, t: f64) -> f64 {
    match signal {
        Signal::Constant(_) => 0.0,
        Signal::Input(input) => input.at(t).rate,
    }
}

/// Whether one of them changes.
pub(crate) fn change<'a>(mut signals: impl Iterator<Item = &'a Signal>) -> bool {
    signals.any(|s| !s.is_constant())
}

/// How much of a step `h` from `t` leads over no kink of any of them [s].
pub(crate) fn reach<'a>(signals: impl Iterator<Item = &'a Signal>, t: f64, h: f64) -> f64 {
    signals.fold(h, |h, s| s.reach(t, h))
}

/// Three of them at a time.
pub(crate) fn now(signals: &[Signal; 3], t: f64) -> [f64; 3] {
    signals.each_ref().map(|s| s.at(t))
}
