//! Dry friction in the equations of motion: the bristles of all cells, and how their places move.

use super::block::Block;
use super::friction::{CELLS, Friction, Grip, Hold, MEMORY, Pressed};
use super::group::{Bristles, Group, Scratch, What};
use super::seat::{Frame, Seat, minus};
use super::term::Contact;
use super::touch::{Pair, Touch};
use ropewalk_core::held::{Held, three};
use ropewalk_core::rotation::{cross, log, then, transposed_times};
use ropewalk_core::{Assembly, At, Leap, V3, dot};

/// How far what slips may come back unseen, in parts of what bristles stretch: they would store as much.
const BACK: f64 = 0.1;

/// A bristle that holds: where it is on what touches, how that moves, and what it does.
pub(super) struct Bristle {
    pub held: Held,
    pub pair: Pair,
    pub hold: Hold,
}

/// The rotation that undoes one.
fn back([w, x, y, z]: [f64; 4]) -> [f64; 4] {
    [w, -x, -y, -z]
}

impl Contact {
    /// Adds dry friction. Each group, points first and then slender pieces, has bristles as its grip says; what they
    /// remember is at `memory` of the internal variables, [`Contact::memory`] numbers.
    #[must_use]
    pub fn with_grips(mut self, grips: &[Grip], memory: usize) -> Self {
        let mut at = memory;
        for (group, grip) in self.groups.iter_mut().zip(grips) {
            let cells = match &group.what {
                What::Ball(_) => 1,
                What::Span(_) => CELLS,
            };
            let share = 1.0 / cells as f64;
            let grip = Grip { stiffness: share * grip.stiffness, damping: share * grip.damping, ..*grip };
            group.bristles = Some(Bristles { grip, at, cells });
            at += MEMORY * cells;
        }
        self
    }

    /// How many numbers the friction of so many points and slender pieces remembers.
    pub fn memory(points: usize, spans: usize) -> usize {
        MEMORY * (points + CELLS * spans)
    }

    /// The direction of what is slender, in the axes of the shape's body.
    fn axis(&self, group: &Group, frame: &Frame, at: &At<'_>) -> Option<V3<f64>> {
        let What::Span(span) = &group.what else { return None };
        let [a, da, b, db] = span.line.place(at);
        // the slope in the middle
        let way: V3<f64> = std::array::from_fn(|i| 1.5 * (b[i] - a[i]) - 0.25 * (da[i] + db[i]));
        Some(match self.fixed.seat {
            Seat::Ground => way,
            Seat::Body { .. } => transposed_times(&frame.r, &way),
        })
    }

    /// The rotation of the body that carries a point, as seen from that of the shape.
    fn turn(&self, held: &Held, at: &At<'_>) -> Option<[f64; 4]> {
        let Held::Beside { q: carrier, .. } = *held else { return None };
        let of = |q: usize| [at.q[q + 3], at.q[q + 4], at.q[q + 5], at.q[q + 6]];
        Some(match self.fixed.seat {
            Seat::Ground => of(carrier),
            Seat::Body { q, .. } => then(back(of(q)), of(carrier)),
        })
    }

    /// The bristle of a cell that something presses, if it has taken hold.
    fn bristle(
        &self,
        group: &Group,
        cell: usize,
        pressed: &Pressed,
        frame: &Frame,
        at: &At<'_>,
        memory: &[f64],
    ) -> Option<Bristle> {
        let (friction, bristles) = (self.law.friction.as_ref()?, group.bristles.as_ref()?);
        let own = memory.get(bristles.at + MEMORY * cell..)?.get(..MEMORY)?;
        if own[0] == 0.0 {
            return None;
        }
        let held = group.station(cell);
        let pair = self.pair(&held, group.radius(), frame, at);
        let mut e = minus(&pair.s, &three(own, 1));
        if let Some(turn) = self.turn(&held, at) {
            // what has rolled off hasn't slipped
            let before = back([own[4], own[5], own[6], own[7]]);
            let rolled = cross(&log(then(turn, before)), &pressed.n);
            (0..3).for_each(|i| e[i] -= group.radius() * rolled[i]);
        }
        let u = pair.velocity(&pressed.n);
        let axis = self.directed(friction, group, frame, at);
        let hold = friction.hold(&bristles.grip, pressed, &e, &u, axis.as_ref());
        Some(Bristle { held, pair, hold })
    }

    fn directed(&self, friction: &Friction, group: &Group, frame: &Frame, at: &At<'_>) -> Option<V3<f64>> {
        friction.across.and_then(|_| self.axis(group, frame, at))
    }

    /// The bristle of a cell that something presses, as an iteration has to see it.
    pub(super) fn holding(
        &self,
        group: &Group,
        cell: usize,
        pressed: &Pressed,
        (frame, at): (&Frame, &At<'_>),
        out: &mut Assembly<'_>,
    ) -> Option<Bristle> {
        let mut bristle = self.bristle(group, cell, pressed, frame, at, at.internal)?;
        let Bristle { held, pair, hold } = &mut bristle;
        if hold.slips
            && out.wants_tangent()
            && let Some(leap) = out.leap()
            && let Some(bristles) = &group.bristles
        {
            let grip = &bristles.grip;
            let turned = |before: &[f64]| {
                let before = At { v: before, ..*at };
                let was =
                    self.pair(held, group.radius(), &self.fixed.frame(&before), &before).velocity(&pressed.n);
                hold.turned(grip, &minus(&pair.velocity(&pressed.n), &was), out.weights())
            };
            // what slips may have stopped on the way, of which the tangent of slip knows nothing
            if match leap {
                Leap::Predicted => true,
                Leap::From(before) => turned(before),
            } {
                hold.stick(grip, &pressed.n);
                out.approximates();
            }
        }
        Some(bristle)
    }

    /// Adds the forces of the bristles of a group.
    pub(super) fn add_friction(
        &self,
        group: &Group,
        frame: &Frame,
        at: &At<'_>,
        cells: &mut [Pressed],
        out: &mut Assembly<'_>,
        block: &mut Block,
    ) {
        let tangent = out.wants_tangent().then(|| out.weights());
        for (cell, pressed) in cells.iter_mut().enumerate() {
            if !pressed.settle() {
                continue;
            }
            if self.brakes(at.internal) {
                self.add_braked(group, cell, pressed, (frame, at), out, block);
                continue;
            }
            let Some(Bristle { held, pair, hold }) = self.holding(group, cell, pressed, (frame, at), out)
            else {
                continue;
            };
            let touch = Touch::at_point(pressed.n, hold.f);
            self.add_force(&held, &pair, &touch, || hold.slopes(), tangent, block);
            if out.wants_tangent() && hold.by_normal != [0.0; 3] {
                block.add_outer(&self.spread(&held, &pair, &pressed.n, &hold.by_normal), &pressed.by);
            }
        }
    }

    /// How each cell of a group is pressed.
    pub(super) fn press(
        &self,
        group: &Group,
        frame: &Frame,
        at: &At<'_>,
        scratch: &mut Scratch,
    ) -> [Pressed; CELLS] {
        let mut cells = [Pressed::NONE; CELLS];
        self.each_of(self.level_in(at).as_ref(), group, (frame, at), scratch, |_, cell, touch| {
            cells[cell].add(touch.normal, &touch.gap.normal);
        });
        cells
    }

    /// Sees each bristle that holds, with the normal force on its cell.
    pub(super) fn each_bristle(&self, at: &At<'_>, mut see: impl FnMut(&Hold, f64)) {
        if self.law.friction.is_none() || self.brakes(at.internal) {
            return;
        }
        let (frame, mut scratch) = (self.fixed.frame(at), Scratch::default());
        for group in &self.groups {
            let mut cells = self.press(group, &frame, at, &mut scratch);
            self.bristles_of(group, &mut cells, &frame, at, &mut see);
        }
    }

    /// Sees all that touches, and each bristle that holds, in one go.
    pub(super) fn each_with_bristles(
        &self,
        at: &At<'_>,
        mut see: impl FnMut(f64, &Touch),
        mut see_bristle: impl FnMut(&Hold, f64),
    ) {
        let rubs = self.law.friction.is_some() && !self.brakes(at.internal);
        let (frame, mut scratch) = (self.fixed.frame(at), Scratch::default());
        let level = self.level_in(at);
        for group in &self.groups {
            let mut cells = [Pressed::NONE; CELLS];
            self.each_of(level.as_ref(), group, (&frame, at), &mut scratch, |k, cell, touch| {
                see(k, touch);
                if rubs {
                    cells[cell].add(touch.normal, &touch.gap.normal);
                }
            });
            if rubs {
                self.bristles_of(group, &mut cells, &frame, at, &mut see_bristle);
            }
        }
        self.each_flowing_ball(at, |ball, touch| see(ball.k, touch));
    }

    /// Sees the bristles of a group, whose cells are pressed so.
    fn bristles_of(
        &self,
        group: &Group,
        cells: &mut [Pressed; CELLS],
        frame: &Frame,
        at: &At<'_>,
        see: &mut impl FnMut(&Hold, f64),
    ) {
        let Some(bristles) = group.bristles else { return };
        for (cell, pressed) in cells[..bristles.cells].iter_mut().enumerate() {
            if pressed.settle()
                && let Some(b) = self.bristle(group, cell, pressed, frame, at, at.internal)
            {
                see(&b.hold, pressed.normal);
            }
        }
    }

    /// Whether something that slips has turned round in a step, and come back farther than `far` allows and than bristles stretch:
    /// these are moved at the ends of steps, and went on pulling it the way it went.
    pub(super) fn came_back(
        &self,
        before: &At<'_>,
        after: &At<'_>,
        far: &dyn Fn(usize, f64) -> bool,
    ) -> bool {
        let (frame, mut scratch) = (self.fixed.frame(after), Scratch::default());
        let from = self.fixed.frame(before);
        for group in &self.groups {
            let Some(Bristles { grip, cells: count, .. }) = group.bristles else { continue };
            let mut cells = self.press(group, &frame, after, &mut scratch);
            for (cell, pressed) in cells[..count].iter_mut().enumerate() {
                if !pressed.settle() {
                    continue;
                }
                let Some(b) = self.bristle(group, cell, pressed, &frame, after, after.internal) else {
                    continue;
                };
                let n = &pressed.n;
                let along = |u: V3<f64>| -> V3<f64> {
                    let normal = dot(&u, n);
                    std::array::from_fn(|i| u[i] - normal * n[i])
                };
                let u = along(b.pair.velocity(n));
                if !b.hold.comes_back(&grip, &u) {
                    continue;
                }
                let was = along(self.pair(&b.held, group.radius(), &from, before).velocity(n));
                // what came back before needn't turn: its limit falls
                if dot(&u, &was) > 0.0 {
                    continue;
                }
                let (speed, change) = (dot(&u, &u).sqrt(), minus(&u, &was));
                // by a constant acceleration
                let way = 0.5 * speed * speed * (after.t - before.t) / dot(&change, &change).sqrt();
                let gives = BACK * dot(&b.hold.stretch, &b.hold.stretch).sqrt();
                if !(way <= gives) && self.velocity_of(&b.held).is_some_and(|v| far(v, way)) {
                    return true;
                }
            }
        }
        false
    }

    /// A velocity of what touches, or of the shape where that stands still.
    fn velocity_of(&self, held: &Held) -> Option<usize> {
        match (held, self.fixed.seat) {
            (Held::Moves { v, .. } | Held::Beside { v, .. } | Held::Lever { v, .. }, _) => Some(*v),
            (Held::Between { v, .. }, _) => Some(v[0]),
            (Held::Ground(_), Seat::Body { v, .. }) => Some(v),
            (Held::Ground(_), Seat::Ground) => None,
        }
    }

    /// Moves the places of the bristles after a step: those that slipped by what they slipped, those that touch anew to
    /// where they touch.
    pub(super) fn move_anchors(&self, at: &At<'_>, memory: &mut [f64]) {
        let (frame, mut scratch) = (self.fixed.frame(at), Scratch::default());
        let rests = self.is_at_rest(memory);
        for group in &self.groups {
            let Some(bristles) = group.bristles else { continue };
            let mut cells = self.press(group, &frame, at, &mut scratch);
            for (cell, pressed) in cells[..bristles.cells].iter_mut().enumerate() {
                let own = bristles.at + MEMORY * cell;
                if !pressed.settle() {
                    memory[own] = 0.0;
                    continue;
                }
                let stretch = match rests {
                    true => self.stretch_at_rest((group, cell, pressed), (&frame, at), memory),
                    false => self.bristle(group, cell, pressed, &frame, at, memory).map(|b| b.hold.stretch),
                };
                let held = group.station(cell);
                let s = self.fixed.place(&frame, &held.x(at));
                if let Some(turn) = self.turn(&held, at) {
                    memory[own + 4..own + 8].copy_from_slice(&turn);
                }
                let stretch = stretch.unwrap_or([0.0; 3]);
                memory[own] = 1.0;
                (0..3).for_each(|i| memory[own + 1 + i] = s[i] - stretch[i]);
            }
        }
        self.hold(memory);
    }
}
