//! One equilibrium from a guess, and the path of equilibria along the load.

use super::critical::Crossing;
use super::leap::UNEXPLAINED;
use super::outcome::{Found, StaticsError};
use super::problem::Statics;
use super::search::FOLD;
use crate::model::state::State;

/// How often an equilibrium is searched again with what its memory has become.
const SETTLED: u32 = 4;
/// A step that may have leapt is halved down to so many of the shortest before the way between is gone round.
const SHORT_ENOUGH: f64 = 16.0;
/// What a step may leave unexplained, in parts of what it may leave at most, so that the next is longer.
const EASY: f64 = 0.5;
/// How often the arc of a path is tried before shorter steps are.
const ARCS: u32 = 3;

/// Most that a motion may turn something by in a step of the load [rad]: a joint that tells an angle by directions has another
/// branch half a turn away, and twist counts whole turns by the least change.
const MOST_TURN: f64 = 1.0;
/// How often a step is halved for that: what turns faster turns about at once.
const HALVED: u32 = 40;

impl Statics<'_> {
    /// Moves `state` to the equilibrium at its time. `cold` says that no equilibrium nearby is known: the first of a
    /// path, or a guess.
    ///
    /// # Errors
    /// None was found, or there is none since the length of a cable changes; the state is as it was.
    pub fn find(&mut self, state: &mut State, cold: bool) -> Result<Found, StaticsError> {
        self.model.relabel(state);
        self.run_material(state)?;
        let before = state.clone();
        if cold {
            self.model.let_go(state);
        }
        let found = self.seek(state, cold).map_err(|e| {
            state.clone_from(&before);
            if cold { self.without_friction(e) } else { e }
        })?;
        self.refuse_unsteady(state).inspect_err(|_| state.clone_from(&before))?;
        let mut found = found;
        if let Some(why) = self.model.lost(&state.at()) {
            let e = self.fail(state, &why, found.iterations);
            state.clone_from(&before);
            return Err(e);
        }
        for _ in 0..SETTLED {
            if !self.model.settle(state) {
                break;
            }
            let settled = state.clone();
            let more = self.search(state, false, false, true).and_then(|more| self.unfold(state, more));
            let more =
                more.or_else(|_| self.search_rubbing(state, &settled)).or_else(|_| self.seek(state, true));
            let more = more.map_err(|e| {
                let why = format!(
                    "{}, now that friction has taken hold as its `equilibrium` says: on a bed, what nothing pulls lies as it was `laid`",
                    e.why
                );
                StaticsError { why, ..e }
            });
            found.add(&more.inspect_err(|_| state.clone_from(&before))?);
            // dry friction has no linear motion about it that could be told to swing ever wider
            found.flutter = 0.0;
        }
        Ok(found)
    }

    /// The equilibrium next to one that friction has taken hold of, whether it seems to be stable or not: what rubs has no linear
    /// motion that could tell.
    fn search_rubbing(&mut self, state: &mut State, settled: &State) -> Result<Found, StaticsError> {
        state.clone_from(settled);
        let found = self.search(state, false, false, false)?;
        if std::mem::take(&mut self.unstable) > 0 {
            let doubt =
                "whether it is stable can't be told by linear motions, now that friction has taken hold";
            self.doubt.get_or_insert_with(|| doubt.into());
        }
        match self.unfolded(&mut state.q.clone()) {
            Some(_) => Err(self.fail(state, "what was found is folded inside elements", found.iterations)),
            None => Ok(found),
        }
    }

    /// Why nothing was found, where dry friction would have come later: on a slope a slack line may slide and fold without it.
    fn without_friction(&self, e: StaticsError) -> StaticsError {
        let dry = self
            .model
            .terms()
            .iter()
            .filter(|term| term.remembers().is_some_and(|r| !r.rests() || r.takes_hold()));
        let labels: Vec<String> = dry.map(|term| format!("`{}`", term.label())).collect();
        if labels.is_empty() || e.iterations == 0 || e.interrupted {
            return e;
        }
        let why = format!(
            "{}, without the friction of {}, which takes hold of an equilibrium that was found",
            e.why,
            labels.join(", ")
        );
        StaticsError { why, ..e }
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
        first = first.and_then(|found| self.unfold(state, found));
        let suspicious = match &first {
            Ok(_) => cold && self.options.stable && self.folded(state) < FOLD,
            Err(_) => cold,
        };
        if suspicious {
            first = self.find_straight(state, &before, first);
        }
        first.or_else(|e| self.find_otherwise(state, before, cold, e))
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
            && let Ok(more) = self.search_unfolded(state, cold)
        {
            found.add(&more);
            return Ok(found);
        }
        self.free.clear();
        if !self.loose {
            state.clone_from(&before);
            self.loose = true;
            if let Ok(more) = self.search_unfolded(state, cold) {
                found.add(&more);
                return Ok(found);
            }
            self.loose = false;
        }
        // what has nothing to hold it in some directions may still fall over in others
        let loose = std::mem::replace(&mut self.loose, true);
        if cold && self.options.stable {
            let crept = self.creep_down(state, &before, found);
            if let Some(found) = crept.or_else(|| self.find_bowed(state, &before, found)) {
                return Ok(found);
            }
        }
        self.loose = loose;
        *state = before;
        Err(self.explain(state, first))
    }

    fn search_unfolded(&mut self, state: &mut State, cold: bool) -> Result<Found, StaticsError> {
        let found = self.search(state, cold, cold, true)?;
        self.unfold(state, found)
    }

    /// Creeps from a guess to a stable equilibrium that is folded nowhere.
    pub(super) fn creep_down(&mut self, state: &mut State, from: &State, mut found: Found) -> Option<Found> {
        state.clone_from(from);
        self.creep(state, &mut found, true).ok()?;
        let mut found = self.unfold(state, found).ok()?;
        let (judged, load) = (std::mem::take(&mut self.judged), self.load(from));
        if let Ok(Some(growth)) = self.grows(state, &judged, load) {
            found.flutter = found.flutter.max(growth.rate);
        }
        self.judged = judged;
        Some(found)
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
        let (mut arcs, mut bent) = (0, false);
        while state.t != t {
            self.model.relabel(state);
            let before = state.clone();
            let swings = self.judged.flutter > 0.0 || self.swung && self.unstable > 0;
            state.t = if (t - before.t).abs() <= 1.001 * h.abs() { t } else { before.t + h };
            state.t = self.within_a_turn(before.t, state.t);
            let to = state.t;
            h = to - before.t;
            self.run_on(state, to - before.t);
            if self.stays(&before, state) {
                continue;
            }
            let e = match self.step_on(state) {
                Ok(found) => {
                    sum.add(&found);
                    self.swung = false;
                    if self.judged.flutter > 0.0 && !swings {
                        let _ = self.locate_by_load(&before, state, &mut sum);
                    } else {
                        let left = self.unexplained(&before, state);
                        if left > UNEXPLAINED {
                            if h.abs() > SHORT_ENOUGH * least {
                                // nearer by the way may be seen
                                state.clone_from(&before);
                                h *= 0.5;
                                continue;
                            }
                            self.go_round(&before, state, &mut sum)?;
                        }
                        bent = left > EASY * UNEXPLAINED;
                    }
                    self.model.settle(state);
                    if !bent {
                        h *= 2.0;
                    }
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
                self.swung = swings;
                match self.locate_by_load(&before, &beyond, &mut sum) {
                    Crossing::Here => {
                        self.leave_last(state, to, &mut sum)?;
                        continue;
                    }
                    // it goes on as it is, unstable as it was
                    Crossing::Swung => {
                        self.swung = true;
                        (*state, sum.flutter) = (beyond, self.judged.growth());
                        self.model.settle(state);
                        h *= 2.0;
                        continue;
                    }
                    Crossing::Leapt => {}
                }
                if let Some(back) = self.leave_leapt(&before, &beyond, &mut sum) {
                    *state = back;
                    continue;
                }
            } else if self.options.stable && (h.abs() <= short || unstable) && arcs < ARCS {
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

    /// The time until which motions turn nothing too far, on the way from one time to another.
    fn within_a_turn(&self, from: f64, mut to: f64) -> f64 {
        let quarter = |k: u32, to: f64| from + 0.25 * f64::from(k) * (to - from);
        let far = |to: f64| (1..=4).any(|k| self.model.turned(from, quarter(k, to)) > MOST_TURN);
        for _ in 0..HALVED {
            if !far(to) {
                break;
            }
            to = quarter(2, to);
        }
        to
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
        match self.model.lost(&state.at()) {
            Some(why) => Err(self.fail(state, &why, found.iterations)),
            None => Ok(found),
        }
    }
}
