//! Dry friction at equilibria, from the first of a path to those behind it, and on into time.
//!
//! The first is found without friction, but for what lies on a slope: there the ground bears weight upright, as far as friction
//! could, so that what is laid down neither slides nor folds. Then bristles take up just that force, or friction brakes what is
//! pulled.

use super::friction::{Brake, MEMORY, Pressed};
use super::group::{Group, Scratch};
use super::seat::{Frame, Seat};
use super::shape::Shape;
use super::term::Contact;
use ropewalk_core::{At, V3, dot};

/// How friction acts, as the memory says: as bristles, as ground that bears, or as a brake.
const HOLDS: f64 = 0.0;
const BEARS: f64 = 1.0;
const BRAKES: f64 = 2.0;

/// What friction at equilibria needs.
#[derive(Clone, Copy, Debug)]
pub(super) struct Resting {
    /// Where the memory says how it acts.
    phase: usize,
    /// The direction against gravity, where ground slopes.
    up: Option<V3<f64>>,
}

impl Contact {
    /// Lets friction take part in equilibria: `up` is the direction against gravity, if there is any, and `phase` the place in
    /// the memory that says how friction acts.
    #[must_use]
    pub fn with_rest(mut self, up: Option<V3<f64>>, phase: usize) -> Self {
        let up = up.filter(|up| match (&self.fixed.shape, self.fixed.seat) {
            (Shape::Plane, Seat::Ground) => self.fixed.axes[2] != *up,
            (Shape::Heights(_), Seat::Ground) => true,
            _ => false,
        });
        self.resting = Some(Resting { phase, up });
        self
    }

    /// Lets friction brake cables at equilibria, one entry for each group.
    #[must_use]
    pub fn with_brakes(mut self, brakes: &[Option<Brake>]) -> Self {
        for (group, brake) in self.groups.iter_mut().zip(brakes) {
            if let Some(bristles) = &mut group.bristles {
                bristles.grip.brake = *brake;
            }
        }
        self
    }

    fn acts_as(&self, phase: f64, memory: &[f64]) -> bool {
        self.resting.is_some_and(|rest| memory.get(rest.phase) == Some(&phase))
    }

    fn act_as(&self, phase: f64, memory: &mut [f64]) {
        if let Some(rest) = self.resting {
            memory[rest.phase] = phase;
        }
    }

    /// Whether equilibria are looked for, with a friction that a pull uses up.
    pub(super) fn brakes(&self, memory: &[f64]) -> bool {
        self.acts_as(BRAKES, memory)
    }

    /// The direction in which the ground bears, while the first equilibrium is looked for.
    pub(super) fn bears(&self, memory: &[f64]) -> Option<V3<f64>> {
        self.resting.filter(|_| self.acts_as(BEARS, memory))?.up
    }

    /// Whether ground slopes, and bears.
    pub(super) fn slopes(&self) -> bool {
        self.resting.is_some_and(|rest| rest.up.is_some())
    }

    /// Forgets what held: an equilibrium is looked for.
    pub(super) fn release(&self, memory: &mut [f64]) {
        for bristles in self.groups.iter().filter_map(|g| g.bristles) {
            (0..bristles.cells).for_each(|cell| memory[bristles.at + MEMORY * cell] = 0.0);
        }
        self.act_as(BEARS, memory);
    }

    /// Friction holds from here on.
    pub(super) fn hold(&self, memory: &mut [f64]) {
        self.act_as(HOLDS, memory);
    }

    /// Takes up an equilibrium, from where on bristles hold. Whether they didn't before: how it can be left is another thing then.
    pub(super) fn lay(&self, at: &At<'_>, memory: &mut [f64]) -> bool {
        let first = self.acts_as(BEARS, memory);
        self.move_anchors(at, memory);
        first
    }

    /// Takes up an equilibrium, from where on friction brakes. Whether it didn't before.
    pub(super) fn brake(&self, at: &At<'_>, memory: &mut [f64]) -> bool {
        let first = !self.brakes(memory);
        let (frame, mut scratch) = (self.fixed.frame(at), Scratch::default());
        for group in &self.groups {
            let Some(bristles) = group.bristles else { continue };
            let mut cells = self.press(group, &frame, at, &mut scratch);
            for (cell, pressed) in cells[..bristles.cells].iter_mut().enumerate() {
                let own = bristles.at + MEMORY * cell;
                memory[own] = f64::from(u8::from(pressed.settle()));
                let place = self.fixed.place(&frame, &group.station(cell).x(at));
                memory[own + 1..own + 4].copy_from_slice(&place);
            }
        }
        self.act_as(BRAKES, memory);
        first
    }

    /// The force along the ground per normal force, with which what is pressed is borne upright, as far as friction could.
    fn borne(&self, up: &V3<f64>, n: &V3<f64>) -> V3<f64> {
        let rises = dot(up, n);
        let (Some(friction), true) = (&self.law.friction, rises > 0.0) else { return [0.0; 3] };
        let force: V3<f64> = std::array::from_fn(|i| up[i] / rises - n[i]);
        let most = friction.across.map_or(friction.mu, |across| across.min(friction.mu));
        let size = dot(&force, &force).sqrt();
        let share = if size > most { most / size } else { 1.0 };
        force.map(|f| share * f)
    }

    /// The force of ground that bears, per normal force: upright, where friction could hold what is along the ground.
    pub(super) fn upright(&self, up: &V3<f64>, n: &V3<f64>) -> V3<f64> {
        let along = self.borne(up, n);
        std::array::from_fn(|i| n[i] + along[i])
    }

    /// Whether friction acts otherwise than by bristles.
    pub(super) fn is_at_rest(&self, memory: &[f64]) -> bool {
        self.brakes(memory) || self.bears(memory).is_some()
    }

    /// How far the bristle of a cell is stretched that holds as hard as friction does at an equilibrium.
    pub(super) fn stretch_at_rest(
        &self,
        (group, cell, pressed): (&Group, usize, &Pressed),
        (frame, at): (&Frame, &At<'_>),
        memory: &[f64],
    ) -> Option<V3<f64>> {
        let force = match self.bears(memory) {
            Some(up) => self.borne(&up, &pressed.n).map(|f| pressed.normal * f),
            None => self.braking(group, cell, pressed, (frame, at), memory)?,
        };
        let stiffness = group.bristles.as_ref()?.grip.stiffness;
        let normal = dot(&force, &pressed.n);
        Some(std::array::from_fn(|i| (normal * pressed.n[i] - force[i]) / stiffness))
    }
}
