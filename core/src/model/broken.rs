//! Functions that a scene calls and that were written elsewhere, such as in Python: what is known of one that failed.
//!
//! Forces and motions give numbers and no errors. One that has failed gives NaN and says why here, for the thread that
//! computes; whoever then finds that a step or a search came to nothing asks here first.

use std::cell::RefCell;
use std::error::Error;
use std::fmt;
use std::sync::Arc;

/// A function that failed.
#[derive(Clone)]
pub struct Broken {
    /// What the scene calls it.
    pub name: String,
    /// The time that it was called for [s].
    pub t: f64,
    /// What went wrong.
    pub why: String,
    /// The error itself, as whoever called the function knows it.
    pub source: Option<Arc<dyn Error + Send + Sync>>,
}

impl fmt::Display for Broken {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "at t = {:.6} s the function `{}` {}", self.t, self.name, self.why)
    }
}

impl fmt::Debug for Broken {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl Error for Broken {}

impl PartialEq for Broken {
    fn eq(&self, other: &Self) -> bool {
        (&self.name, self.t.to_bits(), &self.why) == (&other.name, other.t.to_bits(), &other.why)
    }
}

thread_local! {
    /// What failed, and whether nothing can go on.
    static BROKEN: RefCell<Option<(Broken, bool)>> = const { RefCell::new(None) };
}

/// Says that a function failed and that the computation has to end; the first one counts.
pub fn fail(broken: Broken) {
    BROKEN.with_borrow_mut(|there| {
        if !matches!(there, Some((_, true))) {
            *there = Some((broken, true));
        }
    });
}

/// Says that a function gave no number, which may happen to an iteration that went too far. If the computation comes to
/// nothing, this is why.
pub fn doubt(broken: Broken) {
    BROKEN.with_borrow_mut(|there| {
        if !matches!(there, Some((_, true))) {
            *there = Some((broken, false));
        }
    });
}

/// Whether a function failed for good: none has to be called any more.
pub fn has_failed() -> bool {
    BROKEN.with_borrow(|there| matches!(there, Some((_, true))))
}

/// What failed, or gave no number at last; forgotten from here on.
pub fn take() -> Option<Broken> {
    BROKEN.take().map(|(broken, _)| broken)
}

/// What failed for good; doubts are forgotten.
pub(crate) fn take_failed() -> Option<Broken> {
    BROKEN.take().and_then(|(broken, failed)| failed.then_some(broken))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_failure_counts_and_doubts_give_way() {
        let broken = |name: &str| Broken { name: name.into(), t: 2.0, why: "gave up".into(), source: None };
        assert!(take().is_none() && !has_failed());
        doubt(broken("a"));
        assert!(!has_failed() && take_failed().is_none() && take().is_none());
        doubt(broken("a"));
        fail(broken("b"));
        fail(broken("c"));
        doubt(broken("d"));
        assert!(has_failed());
        let found = take().unwrap();
        assert_eq!(found.to_string(), "at t = 2.000000 s the function `b` gave up");
        assert!(found == broken("b") && found != broken("c") && !has_failed());
    }
}
