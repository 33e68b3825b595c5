//! How long a step may be in which no line goes through another.

use super::curve::{Closest, Curve, size};
use super::near::within;
use super::term::LineContact;
use ropewalk_core::{At, Foresees, V3, dot};

/// The part of the radius that lines may go on by in a step once they touch.
const PRESS: f64 = 0.25;
/// How much farther apart than they have moved lines may be that are looked at for whether they passed.
const CAREFUL: f64 = 1.5;

/// When the room is used up by what approaches with `w` and gains `b`: `w t + b t²/2` reaches it.
fn time(room: f64, w: f64, b: f64) -> f64 {
    let (w, b) = (w.max(0.0), b.max(0.0));
    2.0 * room / (w + (w * w + 2.0 * b * room).sqrt())
}

fn minus(a: &V3<f64>, b: &V3<f64>) -> V3<f64> {
    std::array::from_fn(|i| a[i] - b[i])
}

/// Position, velocity and acceleration of the control points of a piece. The swing of a body that turns is left out.
type Seen = [[V3<f64>; 3]; 4];

impl LineContact {
    fn seen(&self, piece: usize, at: &At<'_>) -> Seen {
        let span = &self.pieces.all[piece].span;
        let accelerated = At { v: at.a, ..*at };
        span.controls().map(|held| [held.x(at), held.velocity(at), held.velocity(&accelerated)])
    }

    /// The longest step in which the list of what is near stays good.
    fn listed(&self, at: &At<'_>) -> f64 {
        let all: Vec<Seen> = (0..self.pieces.all.len()).map(|k| self.seen(k, at)).collect();
        let count = 4.0 * all.len() as f64;
        let mean = |n: usize| -> V3<f64> {
            std::array::from_fn(|i| all.iter().flatten().map(|p| p[n][i]).sum::<f64>() / count)
        };
        let (v, a) = (mean(1), mean(2));
        let one = |(k, left): (usize, f64)| {
            let most = |n: usize, mean: &V3<f64>| {
                all[k].iter().map(|p| size(&minus(&p[n], mean))).fold(0.0, f64::max)
            };
            time(left, most(1, &v), most(2, &a))
        };
        self.near.left(&self.pieces, at).map(one).fold(f64::INFINITY, f64::min)
    }

    /// Pieces that lie one after the other along a line, or are tied, are always near each other.
    fn apart(&self, [i, j]: [usize; 2]) -> bool {
        let (a, b) = (&self.pieces.all[i], &self.pieces.all[j]);
        let tied = |p: &super::pieces::Piece, line| p.tied.iter().any(|(other, _)| *other == line);
        match a.line == b.line {
            true => b.s - a.s - a.length > self.pieces.apart(i, j),
            false => !tied(a, b.line) && !tied(b, a.line),
        }
    }

    /// The longest step in which two pieces come no deeper into each other than by a part of their radius.
    fn facing_each_other(&self, pair: [usize; 2], curves: &[Option<Curve>], at: &At<'_>) -> f64 {
        let [Some(a), Some(b)] = pair.map(|k| curves[k].as_ref()) else { return f64::INFINITY };
        let closest = a.closest(b);
        if closest.distance == 0.0 {
            return f64::INFINITY;
        }
        let n = closest.way.map(|w| w / closest.distance);
        let [i, j] = pair;
        let press = PRESS * self.pieces.all[i].radius.min(self.pieces.all[j].radius);
        let thick = self.pieces.thick(i, j);
        let [one, other] = pair.map(|k| self.seen(k, at));
        let mut least = f64::INFINITY;
        for p in &one {
            for o in &other {
                let room = dot(&n, &minus(&p[0], &o[0])) - thick;
                let (w, b) = (-dot(&n, &minus(&p[1], &o[1])), -dot(&n, &minus(&p[2], &o[2])));
                least = least.min(time(room.max(press), w, b));
            }
        }
        least
    }

    /// Whether two pieces went through each other.
    fn went_through(&self, [i, j]: [usize; 2], before: &At<'_>, after: &At<'_>) -> Option<[Closest; 2]> {
        let moved = [i, j].map(|k| {
            let controls = self.pieces.all[k].span.controls();
            controls.map(|held| minus(&held.x(after), &held.x(before)))
        });
        let mut reach = 0.0_f64;
        for a in &moved[0] {
            for b in &moved[1] {
                reach = reach.max(size(&minus(a, b)));
            }
        }
        let there = |at: &At<'_>| [i, j].map(|k| Curve::of(&self.pieces.all[k].span, at));
        let [a, b] = there(before);
        if a.is_apart(&b, CAREFUL * reach) {
            return None;
        }
        let was = a.closest(&b);
        if was.distance > CAREFUL * reach {
            return None;
        }
        let [a, b] = there(after);
        let is = a.closest(&b);
        let through = dot(&was.way, &is.way) < 0.0 && was.distance + is.distance <= CAREFUL * reach;
        through.then_some([was, is])
    }
}

impl Foresees for LineContact {
    fn step_limit(&self, at: &At<'_>) -> f64 {
        let curves = self.curves(&self.near, at);
        let pairs = self.near.couples.iter().map(|c| c.pieces).filter(|pair| self.apart(*pair));
        let couples = pairs.map(|pair| self.facing_each_other(pair, &curves, at));
        couples.fold(self.listed(at), f64::min)
    }

    fn passes(&self, before: &At<'_>, after: &At<'_>) -> Option<String> {
        let holds = self.near.holds(&self.pieces, after);
        let through = |pair: [usize; 2]| {
            if !self.apart(pair) {
                return None;
            }
            let [was, _] = self.went_through(pair, before, after)?;
            let [(a, s), (b, t)] = [0, 1].map(|n| self.place(pair[n], was.xi[n]));
            Some(format!(
                "`{}`: `{a}` at {s:.4} m is pushed through `{b}` at {t:.4} m, however short the steps: \
                 `stiffness_per_length` is too soft for what hits. How deep a hit goes falls with its root",
                self.label
            ))
        };
        if holds {
            return self.near.couples.iter().find_map(|c| through(c.pieces));
        }
        // beyond what is listed: nothing may touch there that wasn't seen to come
        let moved = |k: usize| {
            let controls = self.pieces.all[k].span.controls();
            controls.map(|held| size(&minus(&held.x(after), &held.x(before)))).into_iter().fold(0.0, f64::max)
        };
        let most = (0..self.pieces.all.len()).map(moved).fold(0.0, f64::max);
        let unseen = |pair: &[usize; 2]| !self.near.lists(*pair) && self.apart(*pair);
        for pair in within(&self.pieces, after, 0.0).iter().filter(|p| unseen(p)) {
            let [a, b] = pair.map(|k| Curve::of(&self.pieces.all[k].span, after));
            if a.closest(&b).distance < self.pieces.thick(pair[0], pair[1]) {
                let [(a, _), (b, _)] = pair.map(|k| self.place(k, 0.0));
                return Some(format!("`{}`: `{a}` comes to touch `{b}` all at once", self.label));
            }
        }
        within(&self.pieces, after, 2.0 * most).into_iter().find_map(through)
    }
}
