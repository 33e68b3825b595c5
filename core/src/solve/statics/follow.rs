//! One equilibrium from a guess, and the path of equilibria along the load.

use super::outcome::{Found, StaticsError};
use super::problem::Statics;
use super::search::FOLD;
use crate::model::state::State;

/// How often lines are unfolded.
const UNFOLDINGS: u32 = 3;
/// How often the arc of a path is tried before shorter steps are.
const ARCS: u32 = 3;

impl Statics<'_> {
    /// Moves `state` to the equilibrium at its time. `cold` says that no equilibrium nearby is known: the first of a
    /// path, or a guess.
    ///
    /// # Errors
    /// None was found, or there is none since the length of a cable changes; the state is as it was.
    pub fn find(&mut self, state: &mut State, cold: bool) -> Result<Found, StaticsError> {
        self.model.relabel(&mut state.q);
        self.run_material(state)?;
        let before = state.clone();
        let found = match self.seek(state, cold).and_then(|found| self.unfold(state, found)) {
            Err(e) if cold && !e.interrupted => self.find_hanging(state, &before, e),
            found => found,
        };
        let found = found.inspect_err(|_| state.clone_from(&before))?;
        self.refuse_unsteady(state).inspect_err(|_| state.clone_from(&before))?;
        let mut found = found;
        if self.model.settle(state) {
            let more = self.search(state, false, false, true).or_else(|_| self.seek(state, true));
            found.add(&more.inspect_err(|_| state.clone_from(&before))?);
            self.model.settle(state);
            // dry friction has no linear motion about it that could be told to swing ever wider
            found.flutter = 0.0;
        }
        Ok(found)
    }

    fn seek(&mut self, state: &mut State, cold: bool) -> Result<Found, StaticsError> {
        let before = state.clone();
        self.free.clear();
        let mut first = self.search(state, cold, cold, true);
        if first.is_err() && !cold {
            // from a neighbouring equilibrium the bare iteration nearly always gets there, and faster
            state.clone_from(&before);
            first = self.search(state, false, true, true);
        }
        let suspicious = match &first {
            Ok(_) => cold && self.options.stable && self.folded(state) < FOLD,
            Err(_) => cold,
        };
        if suspicious {
            first = self.find_straight(state, &before, first);
        }
        first.or_else(|e| self.find_otherwise(state, before, cold, e))
    }

    /// Unfolds what an iteration has folded within elements, which no equation forbids where a line hardly resists bending, and
    /// finds the equilibrium beside it.
    fn unfold(&mut self, state: &mut State, mut found: Found) -> Result<Found, StaticsError> {
        for k in 0..UNFOLDINGS {
            if !self.turn_back(state, k == 0) {
                return Ok(found);
            }
            found.add(&self.search(state, false, true, true)?);
        }
        if self.turn_back(&mut state.clone(), false) {
            let why = "a line lies folded within its elements, where its tangent looks back; take more elements there";
            return Err(self.fail(state, why, found.iterations));
        }
        Ok(found)
    }

    fn turn_back(&self, state: &mut State, ends: bool) -> bool {
        let lines = self.model.parts().iter().filter_map(|p| p.line());
        lines.fold(false, |folded, line| line.unfold(&mut state.q, ends) || folded)
    }

    /// A guess can lead into a fold or nowhere; straight cables between their ends rarely do.
    fn find_straight(
        &mut self,
        state: &mut State,
        before: &State,
        first: Result<Found, StaticsError>,
    ) -> Result<Found, StaticsError> {
        let (neutral, doubt) = (self.neutral.clone(), self.doubt.clone());
        let mut other = before.clone();
        other.lambda.fill(0.0);
        for part in self.model.parts() {
            if let Some(line) = part.line() {
                line.straighten(&mut other.q);
            }
        }
        let second = self.search(&mut other, true, true, true);
        match (first, second) {
            (Ok(found), Ok(again)) if self.folded(&other) <= self.folded(state) => {
                _ = again;
                (self.neutral, self.doubt) = (neutral, doubt);
                Ok(found)
            }
            (_, Ok(again)) => {
                *state = other;
                Ok(Found { straightened: true, ..again })
            }
            (Ok(found), Err(_)) => {
                (self.neutral, self.doubt) = (neutral, doubt);
                Ok(found)
            }
            (Err(e), Err(_)) => Err(e),
        }
    }

    /// Where lines are longer than the way between their ends, straight ones are compressed, and any small disturbance folds
    /// them: the search starts as they would sag. It comes last, for it takes no care of what lines lie on.
    fn find_hanging(
        &mut self,
        state: &mut State,
        before: &State,
        first: StaticsError,
    ) -> Result<Found, StaticsError> {
        let Some(hanging) = self.hung(before) else { return Err(first) };
        let mut found = Found { straightened: true, ..Found::default() };
        for (cold, careful) in [(true, true), (false, true), (false, false)] {
            let mut there = hanging.clone();
            if let Ok(more) = self.search(&mut there, cold, careful, true)
                && self.folded(&there) >= FOLD
            {
                *state = there;
                found.add(&more);
                return Ok(found);
            }
        }
        let mut there = hanging;
        if self.options.stable
            && self.creep(&mut there, &mut found, false).is_ok()
            && self.folded(&there) >= FOLD
        {
            *state = there;
            return Ok(found);
        }
        Err(first)
    }

    /// A guess with all lines hung up by their ends as their loads pull; `None` if none of them is slack.
    fn hung(&mut self, guess: &State) -> Option<State> {
        let mut state = guess.clone();
        state.lambda.fill(0.0);
        for line in self.model.parts().iter().filter_map(|part| part.line()) {
            line.straighten(&mut state.q);
        }
        self.assemble(&state, &state.q, &state.lambda, None, false);
        let mut sags = false;
        for (part, line) in self.model.parts().iter().filter_map(|part| Some((part, part.line()?))) {
            // forces within a line have no sum
            let seats = part.seats();
            let load = |i: usize, v: usize| -self.system.residual[self.structure.position[v + i]];
            let pull = std::array::from_fn(|i| seats.iter().map(|&(_, v)| load(i, v)).sum());
            sags |= line.hang(&mut state.q, &pull);
        }
        sags.then_some(state)
    }

    /// Where Newton's method finds nothing from a guess: something may be free to move, or the guess is far away.
    fn find_otherwise(
        &mut self,
        state: &mut State,
        before: State,
        cold: bool,
        first: StaticsError,
    ) -> Result<Found, StaticsError> {
        if first.interrupted {
            *state = before;
            return Err(first);
        }
        let mut found = Found { iterations: first.iterations, ..Found::default() };
        state.clone_from(&before);
        if self.set_free(state)
            && let Ok(more) = self.search(state, cold, cold, true)
        {
            found.add(&more);
            return Ok(found);
        }
        self.free.clear();
        if cold && self.options.stable {
            state.clone_from(&before);
            if self.creep(state, &mut found, true).is_ok() {
                return Ok(found);
            }
        }
        *state = before;
        Err(self.explain(state, first))
    }

    /// Moves the state from one equilibrium to that at time `t`: in one step if that converges, else in as many smaller
    /// ones as it needs, along the arc of the path where the load can't be raised. Critical loads are passed to where the
    /// path is stable again, and kept in [`Statics::critical`]. Returns the work of all of them.
    ///
    /// # Errors
    /// The path could not be followed; the state is the last equilibrium that was found.
    pub fn follow(&mut self, state: &mut State, t: f64) -> Result<Found, StaticsError> {
        let (mut h, mut sum) = (t - state.t, Found::default());
        self.span = self.span.max(h.abs());
        let least = h.abs() / 256.0;
        // shorter steps of the load come before the arc, which costs more
        let short = h.abs() / 4.5;
        let mut arcs = 0;
        while state.t != t {
            self.model.relabel(&mut state.q);
            let before = state.clone();
            let swings = self.judged.flutter > 0.0;
            state.t = if (t - before.t).abs() <= 1.001 * h.abs() { t } else { before.t + h };
            let to = state.t;
            self.run_on(state, to - before.t);
            if self.stays(&before, state) {
                continue;
            }
            let e = match self.step_on(state) {
                Ok(found) => {
                    sum.add(&found);
                    if self.judged.flutter > 0.0 && !swings {
                        self.locate_by_load(&before, state, &mut sum);
                    } else if self.leapt(&before, state) {
                        self.go_round(&before, state, &mut sum)?;
                    }
                    self.model.settle(state);
                    h *= 2.0;
                    continue;
                }
                // what was refused isn't found by smaller steps either
                Err(e) if e.iterations == 0 || e.interrupted => {
                    *state = before;
                    return Err(StaticsError { on_path: true, ..e });
                }
                Err(e) => e,
            };
            let unstable = self.unstable > 0;
            let beyond = state.clone();
            state.clone_from(&before);
            if self.options.stable && unstable && !self.judged.potential {
                self.locate_by_load(&before, &beyond, &mut sum);
                self.leave_last(state, to, &mut sum)?;
                continue;
            }
            if self.options.stable && (h.abs() <= short || unstable) && arcs < ARCS {
                arcs += 1;
                let known = self.critical.len();
                match self.trace(state, to, &mut sum) {
                    Ok(()) => {
                        arcs = 0;
                        continue;
                    }
                    // a critical load is an answer, if not the one that was hoped for
                    Err(e) if self.critical.len() > known => return Err(e),
                    Err(_) => state.clone_from(&before),
                }
            }
            h *= 0.5;
            if h.abs() < least {
                return Err(e);
            }
        }
        Ok(sum)
    }

    /// Whether an equilibrium that was judged is the one of a later time too, since nothing has changed. Asked only where
    /// judging is dear, which is where loads have no potential.
    fn stays(&mut self, judged: &State, later: &State) -> bool {
        let known = self.judged.of.as_ref().is_some_and(|(t, q)| *t == judged.t && *q == judged.q);
        if self.judged.potential || !known || judged.q != later.q || judged.internal != later.internal {
            return false;
        }
        self.assemble(later, &later.q, &later.lambda, None, false);
        let (residual, values) = (self.system.residual.clone(), self.system.values.clone());
        self.assemble(judged, &judged.q, &judged.lambda, None, false);
        let same = residual == self.system.residual && values == self.system.values;
        if same {
            self.judged.of = Some((later.t, later.q.clone()));
        }
        same
    }

    /// One step of [`Statics::follow`]: a stable equilibrium at the time of the state.
    fn step_on(&mut self, state: &mut State) -> Result<Found, StaticsError> {
        let before = state.clone();
        let mut first = self.search(state, false, false, false);
        if first.is_err() {
            state.clone_from(&before);
            first = self.search(state, false, true, false);
        }
        let found = first?;
        if self.unstable > 0 {
            let why = format!("it is unstable in {} directions", self.unstable);
            return Err(StaticsError { why, ..self.fail(state, "", found.iterations) });
        }
        Ok(found)
    }
}
