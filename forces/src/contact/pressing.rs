//! What touches, and the forces with which it presses.

use super::block::{Block, MOST, Slopes, weights};
use super::friction::Pressed;
use super::group::{Ball, Group, Scratch};
use super::level::{Level, Lies};
use super::seat::{Frame, Seat, minus, rotation};
use super::term::Contact;
use super::touch::{Pair, Touch};
use ropewalk_core::held::{Held, three};
use ropewalk_core::rotation::transposed_times;
use ropewalk_core::{At, Relaxed, V3, Weights, dot};
use std::ops::Range;

impl Contact {
    /// A ball on what touches, and how it moves against the shape's body.
    #[inline]
    pub(super) fn pair(&self, held: &Held, radius: f64, frame: &Frame, at: &At<'_>) -> Pair {
        let s = self.fixed.place(frame, &held.x(at));
        let (v, carrier) = match *held {
            Held::Beside { q, v, arm } => {
                let omega = three(at.v, v + 3);
                (three(at.v, v), Some(Pair::carried(&frame.r, &rotation(at, q), &arm, &omega, radius)))
            }
            held => (held.velocity(at), None),
        };
        let g = match self.fixed.seat {
            Seat::Ground => v,
            Seat::Body { .. } => transposed_times(&frame.r, &minus(&v, &frame.v)),
        };
        Pair { r: frame.r, omega: frame.omega, s, g, carrier }
    }

    #[inline]
    pub(super) fn touch(&self, ball: &Ball, frame: &Frame, at: &At<'_>) -> Option<(Touch, Pair)> {
        let gap = self.fixed.gap(&self.fixed.place(frame, &ball.held.x(at)), ball.radius)?;
        let pair = self.pair(&ball.held, ball.radius, frame, at);
        let u = pair.velocity(&gap.normal);
        let k = self.softened(ball, at);
        Some((Touch::new(&self.law, gap, ball.radius, k, &u), pair))
    }

    /// The stiffness of a ball; on the way to an equilibrium hardly more than the load can use where the last iteration
    /// has moved it by more than its radius, so that what still comes down isn't thrown up again.
    fn softened(&self, ball: &Ball, at: &At<'_>) -> f64 {
        const SHARE: f64 = 10.0;
        let Some(Relaxed { last: Some(last), how }) = at.relaxed else { return ball.k };
        let d = ball.held.velocity(&At { v: last, ..*at });
        let moved = dot(&d, &d).sqrt();
        if !(moved > ball.radius) {
            return ball.k;
        }
        let share = if self.per_length > 0.0 { ball.k / self.per_length } else { 1.0 };
        let most = SHARE * how.load * share / (moved - ball.radius).powf(self.law.exponent);
        // without a load to speak of, as in a taut cable, it has to hold all the same
        ball.k.min(most.max(ball.k * (ball.radius / moved).powi(3)))
    }

    /// Unknowns of the body that carries the shape.
    pub(super) fn body(&self) -> Range<usize> {
        match self.fixed.seat {
            Seat::Ground => 0..0,
            Seat::Body { v, .. } => v..v + 6,
        }
    }

    /// Sees the stiffness of all that touches, and how it does.
    pub(super) fn each(&self, at: &At<'_>, mut see: impl FnMut(f64, &Touch, &Frame)) {
        let frame = self.fixed.frame(at);
        let mut scratch = Scratch::default();
        let level = self.level_in(at);
        for group in &self.groups {
            self.each_of(level.as_ref(), group, (&frame, at), &mut scratch, |k, _, touch| {
                see(k, touch, &frame)
            });
        }
        self.each_flowing_ball(at, |ball, touch| see(ball.k, touch, &frame));
    }

    /// The same of one group, with the cell that is touched.
    pub(super) fn each_of(
        &self,
        level: Option<&Level>,
        group: &Group,
        (frame, at): (&Frame, &At<'_>),
        scratch: &mut Scratch,
        mut see: impl FnMut(f64, usize, &Touch),
    ) {
        match (Self::lies(level, group, at), level) {
            (Lies::Above, _) => return,
            (Lies::Touches(lying), Some(level)) => {
                lying.each_point(|p| {
                    let normal = self.law.normal(p.k, p.depth, p.rate);
                    see(p.k, p.cell, &Touch::lying(level.n, &normal, p.depth, p.rate));
                });
                for tip in lying.tips() {
                    if let Some((touch, _)) = self.touch(tip, frame, at) {
                        see(tip.k, 0, &touch);
                    }
                }
                return;
            }
            _ => {}
        }
        group.gather(&self.fixed, frame, at, scratch);
        for ball in &scratch.balls {
            if let Some((touch, _)) = self.touch(ball, frame, at) {
                see(ball.k, ball.cell, &touch);
            }
        }
    }

    /// Sees all that touches of cables that feed.
    pub(super) fn each_flowing_ball(&self, at: &At<'_>, mut see: impl FnMut(&Ball, &Touch)) {
        let (frame, mut scratch) = (self.fixed.frame(at), Scratch::default());
        for flowing in &self.flowing {
            let now = flowing.now(at);
            now.group.gather(&self.fixed, &frame, &now.at(at), &mut scratch);
            for ball in &scratch.balls {
                if let Some((touch, _)) = self.touch(ball, &frame, &now.at(at)) {
                    see(ball, &touch);
                }
            }
        }
    }

    /// Adds the force on one ball, and its derivative to the block of its group; notes how it presses its cell.
    pub(super) fn add_ball(
        &self,
        ball: &Ball,
        frame: &Frame,
        at: &At<'_>,
        tangent: Option<Weights>,
        block: &mut Block,
        cells: &mut [Pressed],
    ) {
        let Some((mut touch, pair)) = self.touch(ball, frame, at) else { return };
        let way = self.bears(at.internal).map(|up| self.upright(&up, &touch.gap.normal));
        if let Some(way) = &way {
            touch.f = way.map(|x| touch.normal * x);
        }
        let slopes = || way.as_ref().map_or_else(|| touch.slopes(), |way| touch.slopes_along(way));
        self.add_force(&ball.held, &pair, &touch, slopes, tangent, block);
        let Some(cell) = cells.get_mut(ball.cell) else { return };
        cell.add(touch.normal, &touch.gap.normal);
        if let Some(w) = tangent {
            let by = -(w.q * touch.by_depth + w.v * touch.by_rate);
            let n = &touch.gap.normal;
            if self.fixed.seat == Seat::Ground && pair.carrier.is_none() {
                for (sum, weight) in cell.by.chunks_exact_mut(3).zip(weights(&ball.held)) {
                    (0..3).for_each(|i| sum[i] += by * weight * n[i]);
                }
            } else {
                let force = self.spread(&ball.held, &pair, n, n);
                cell.by.iter_mut().zip(&force).for_each(|(sum, f)| *sum += by * f);
            }
        }
    }

    /// Adds a force at a point, and its derivative.
    pub(super) fn add_force(
        &self,
        held: &Held,
        pair: &Pair,
        touch: &Touch,
        slopes: impl FnOnce() -> Slopes,
        tangent: Option<Weights>,
        block: &mut Block,
    ) {
        if self.fixed.seat == Seat::Ground && pair.carrier.is_none() {
            for (a, w) in weights(held).iter().enumerate().filter(|w| *w.1 != 0.0) {
                (0..3).for_each(|i| block.add(3 * a + i, -w * touch.f[i]));
            }
            if let Some(w) = tangent {
                let Slopes { by_s, by_x, by_u } = slopes();
                let entry = |i: usize, j: usize| w.q * (by_s[i][j] + by_x[i][j]) + w.v * by_u[i][j];
                let d = std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j)));
                block.add_point(held, &d);
            }
            return;
        }
        let force = self.spread(held, pair, &touch.gap.normal, &touch.f);
        let body = if self.fixed.seat == Seat::Ground { 0 } else { 6 };
        (0..held.size() + body).for_each(|i| block.add(i, -force[i]));
        if let Some(w) = tangent {
            block.add_pair(held, &pair.derivative(touch, &slopes(), w));
        }
    }

    /// The generalised force of `f` at a point on all unknowns of its group, where the normal is `n`.
    pub(super) fn spread(&self, held: &Held, pair: &Pair, n: &V3<f64>, f: &V3<f64>) -> [f64; MOST] {
        let (all, size) = (pair.forces(n, f), held.size());
        let mut force = [0.0; MOST];
        if pair.carrier.is_some() {
            force[..6].copy_from_slice(&all[..6]);
        } else {
            for (a, w) in weights(held).iter().enumerate() {
                (0..3).for_each(|i| force[3 * a + i] = w * all[i]);
            }
        }
        if self.fixed.seat != Seat::Ground {
            force[size..size + 6].copy_from_slice(&all[6..]);
        }
        force
    }
}
