//! Steps of the load that may have leapt from one path of equilibria to another: the tangents at both ends don't explain the move.

use super::outcome::{Found, StaticsError};
use super::path::{LONGEST, Way};
use super::problem::Statics;
use crate::model::node::difference;
use crate::model::state::State;

/// Mean move of a part from which on tangents are compared, relative to its length.
const FAR: f64 = 1e-3;
/// Part of the move that they may leave unexplained.
pub(super) const UNEXPLAINED: f64 = 0.1;
/// Part of the move that they may differ by: two that differ may explain a leap by chance.
const BENT: f64 = 1.0;
/// Longest step on the way that was leapt over, in parts of the leap.
const LEAP_SHARE: f64 = 0.5;

impl Statics<'_> {
    /// The part of a move between two equilibria that the tangents of the path at both ends leave unexplained, of the part of the
    /// model where it is largest, or as much as they differ by; nothing where hardly anything moves, all of it where the path has
    /// no tangent.
    pub(super) fn unexplained(&mut self, from: &State, to: &State) -> f64 {
        let mut moved = vec![0.0; self.model.velocities()];
        difference(self.model.nodes(), &from.q, &to.q, &mut moved);
        let far = self.moves(&moved).iter().any(|x| *x > FAR);
        if !(self.options.stable && self.judged.potential && far) {
            return 0.0;
        }
        let dt = to.t - from.t;
        let way = Way::to(to.t, from.t, self.span.max(dt.abs()));
        let Ok(start) = self.point(from.clone(), None, way) else { return f64::INFINITY };
        // beyond the end loads may be others
        let back = Way { sign: -way.sign, ..way };
        let Ok(end) = self.point(to.clone(), None, back) else { return f64::INFINITY };
        let [first, last] =
            [&start, &end].map(|p| p.slope.iter().map(|s| dt * s / p.rate).collect::<Vec<_>>());
        self.doubt_of(&moved, [&first, &last])
    }

    /// The same of a move by what the tangents at both ends would make of all of it.
    pub(super) fn doubt_of(&self, moved: &[f64], [first, last]: [&[f64]; 2]) -> f64 {
        let both = || first.iter().zip(last);
        let bend: Vec<f64> = both().map(|(a, b)| UNEXPLAINED / BENT * (a - b)).collect();
        // the trapezoidal rule
        let left: Vec<f64> = moved.iter().zip(both()).map(|(m, (a, b))| m - 0.5 * (a + b)).collect();
        let doubts = self.moves(&left).into_iter().zip(self.moves(&bend)).zip(self.moves(moved));
        doubts.filter(|(_, size)| *size > FAR).fold(0.0, |most, ((left, bend), size)| {
            let doubt = left.max(bend) / size;
            // max() would swallow a NaN
            if (left + bend).is_nan() { f64::INFINITY } else { doubt.max(most) }
        })
    }

    /// How far an increment moves the model, in parts of its reference length, and each line in parts of its own.
    fn moves(&self, d: &[f64]) -> Vec<f64> {
        let lines = self.model.parts().iter().filter(|part| part.seats().len() > 1 && part.length() > 0.0);
        let own = lines.map(|part| {
            let seats = part.seats();
            let square: f64 = seats.iter().flat_map(|&(_, v)| &d[v..v + 3]).map(|x| x * x).sum();
            (square / seats.len() as f64).sqrt() / part.length()
        });
        std::iter::once(self.inner(d, d).sqrt()).chain(own).collect()
    }

    /// Goes the way that a step of the load may have leapt over. The state stays where the step led if the arc can't be followed.
    pub(super) fn go_round(
        &mut self,
        from: &State,
        state: &mut State,
        found: &mut Found,
    ) -> Result<(), StaticsError> {
        let (known, mut there) = (self.critical.len(), from.clone());
        let (unstable, neutral, doubt) = (self.unstable, self.neutral.clone(), self.doubt.clone());
        let (judged, free) = (self.judged.clone(), self.free.clone());
        // what was leapt over may be small, both in load and in size
        let way = Way::to(state.t, from.t, (state.t - from.t).abs());
        let longest = (LEAP_SHARE * self.distance(&from.q, &state.q)).min(LONGEST);
        match self.trace_by(&mut there, way, longest, found) {
            Ok(()) => *state = there,
            Err(e) if self.critical.len() > known => return Err(e),
            Err(_) => {
                (self.unstable, self.neutral, self.doubt) = (unstable, neutral, doubt);
                (self.judged, self.free) = (judged, free);
                self.unseen.push([from.t, state.t]);
            }
        }
        Ok(())
    }
}
