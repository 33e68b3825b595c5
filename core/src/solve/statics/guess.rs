//! Other shapes that a search begins from, where the guess of the scene leads nowhere.

use super::outcome::{Found, StaticsError};
use super::problem::Statics;
use crate::algebra::lane::V3;
use crate::model::state::State;

/// How often a search goes on from what was folded.
const UNFOLDED: u32 = 8;

impl Statics<'_> {
    /// A guess can lead into a fold or nowhere; straight cables between their ends rarely do.
    pub(super) fn find_straight(
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
        let second =
            self.search(&mut other, true, true, true).and_then(|found| self.unfold(&mut other, found));
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

    /// Turns round what is folded inside elements, and says where the first of that was.
    pub(super) fn unfolded(&self, q: &mut [f64]) -> Option<(&str, f64)> {
        let lines = self.model.parts().iter().filter_map(|part| Some((part.name(), part.line()?)));
        let folds = lines.filter_map(|(name, line)| Some((name, line.unfold(q)?)));
        folds.collect::<Vec<_>>().into_iter().next()
    }

    /// Searches on from what was found for as long as it is folded inside elements, which no cable is.
    pub(super) fn unfold(&mut self, state: &mut State, mut found: Found) -> Result<Found, StaticsError> {
        for _ in 0..UNFOLDED {
            if !self.options.stable {
                return Ok(found);
            }
            let mut other = state.clone();
            let Some((name, s)) = self.unfolded(&mut other.q) else { return Ok(found) };
            let why = format!("`{name}` is folded at {s:.4} m, inside an element");
            other.lambda.fill(0.0);
            let mut more = self.search(&mut other, false, true, true);
            if more.is_err() {
                // stiff lines that were laid anew are far from their length
                let mut cold = State { lambda: vec![0.0; other.lambda.len()], ..other.clone() };
                more = self.search(&mut cold, true, true, true);
                other = cold;
            }
            found.add(&more.map_err(|e| StaticsError { why, ..e })?);
            *state = other;
        }
        let why = "what was found is folded inside elements again and again";
        Err(self.fail(state, why, found.iterations))
    }

    /// What is longer than its way down and along the ground has to lie somewhere: slack lines begin along arcs to the side.
    pub(super) fn find_bowed(
        &mut self,
        state: &mut State,
        before: &State,
        mut found: Found,
    ) -> Option<Found> {
        let down = self.down(before)?;
        let mut bowed = State { lambda: vec![0.0; before.lambda.len()], ..before.clone() };
        let mut any = false;
        for line in self.model.parts().iter().filter_map(|part| part.line()) {
            any |= line.bow(&mut bowed.q, &down);
        }
        if !any {
            return None;
        }
        state.clone_from(&bowed);
        let direct = self.search(state, true, true, true);
        found.straightened = true;
        match direct.and_then(|more| self.unfold(state, more)) {
            Ok(more) => {
                found.add(&more);
                Some(found)
            }
            Err(_) => self.creep_down(state, &bowed, found),
        }
    }

    /// The direction of all loads together.
    fn down(&mut self, state: &State) -> Option<V3<f64>> {
        self.load(state);
        let mut sum = [0.0; 3];
        for n in self.model.nodes().iter().filter(|n| n.kind.has_position()) {
            (0..3).for_each(|i| sum[i] -= self.system.residual[n.v + i]);
        }
        let size = sum.iter().map(|x| x * x).sum::<f64>().sqrt();
        (size > 0.0 && size.is_finite()).then(|| sum.map(|x| x / size))
    }
}
