//! What ends a run of a winch.

use ropewalk_core::{Action, Event, Model, MovingBoundary, State};

/// Which limit it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The spool is empty.
    Empty,
    /// Hardly any cable is out.
    Short,
}

/// Ends the run where a winch has paid out all that it has, or reeled in all that may be.
#[derive(Clone, Debug)]
pub struct Limit {
    /// Name of the winch.
    pub name: String,
    /// The end that feeds.
    pub boundary: MovingBoundary,
    /// The part that feeds, for its length.
    pub part: String,
    /// Which limit.
    pub side: Side,
    /// Length fed out at which the spool is empty, or length of cable that stays out [m], besides what another section has
    /// been fed at the other end.
    pub length: f64,
}

impl Event for Limit {
    fn name(&self) -> String {
        match self.side {
            Side::Empty => format!("`{}` has paid out all of its {} m", self.name, self.length),
            Side::Short => {
                format!("`{}` has reeled in `{}` to its shortest, {} m", self.name, self.part, self.length)
            }
        }
    }
    fn value(&self, model: &Model, state: &State) -> f64 {
        let at = state.at();
        match self.side {
            Side::Empty => self.length - self.boundary.fed(&at),
            Side::Short => model.part(&self.part).map_or(1.0, |part| {
                let end = usize::from(self.boundary.sign > 0.0);
                let more = part.line().map_or(0.0, |line| line.kept_more(end, &at));
                part.length_now(&at) - more - self.length
            }),
        }
    }
    fn direction(&self) -> i8 {
        -1
    }
    fn act(&self, _: &Model, _: &mut State) -> Action {
        Action::Stop
    }
}
