//! What keeps steps from being longer.

/// What kept an accepted step from being longer.
///
/// ```
/// use ropewalk_core::integrator::Limit;
/// assert_eq!(Limit::ALL[Limit::Force as usize].word(), "force error");
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Limit {
    /// It is the first one, of the size that runs begin with.
    #[default]
    Start,
    /// All steps are as long as this.
    Fixed,
    /// The estimated error of positions and velocities, or how far a body turns.
    Position,
    /// The estimated error of tensions.
    Force,
    /// Newton's method, which failed on a longer one here or shortly before.
    Newton,
    /// Steps don't grow faster from one to the next.
    Growth,
    /// The longest step allowed.
    Longest,
    /// Something ahead that no step may leap over: a kink or jump of a load or motion, a shape.
    Ahead,
    /// The period with which a motion, a load or waves go to and fro.
    Period,
    /// An event: the step ends there, or it is the first after one.
    Event,
    /// An instant at which the run has to stand: of a controller, or its end.
    Instant,
}

impl Limit {
    /// All of them, in the order of their numbers.
    pub const ALL: [Limit; 11] = [
        Limit::Start,
        Limit::Fixed,
        Limit::Position,
        Limit::Force,
        Limit::Newton,
        Limit::Growth,
        Limit::Longest,
        Limit::Ahead,
        Limit::Period,
        Limit::Event,
        Limit::Instant,
    ];

    /// In a word or two.
    pub fn word(self) -> &'static str {
        match self {
            Limit::Start => "start",
            Limit::Fixed => "fixed step",
            Limit::Position => "position error",
            Limit::Force => "force error",
            Limit::Newton => "Newton",
            Limit::Growth => "growth",
            Limit::Longest => "h_max",
            Limit::Ahead => "kink or contact ahead",
            Limit::Period => "period of what swings",
            Limit::Event => "event",
            Limit::Instant => "instant",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_stands_at_its_number() {
        assert!(Limit::ALL.iter().enumerate().all(|(k, limit)| *limit as usize == k));
    }
}
