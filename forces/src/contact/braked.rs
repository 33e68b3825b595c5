//! Friction at equilibria that a pull on a line has used up.
//!
//! Along what lies on the ground the friction is `-μ N t` of the normal force `N` and the tangent `t`: fully mobilised, as behind
//! a line that was pulled tight. Where hardly any tension is left it fades with the strain, so that no ground pushes a line.
//! When time begins to run, the bristles take over exactly this force.

use super::block::{Block, MOST};
use super::friction::{Brake, Friction, Pressed};
use super::group::{Bristles, Group, Scratch, What};
use super::seat::{Frame, Seat};
use super::term::Contact;
use ropewalk_core::held::Held;
use ropewalk_core::rotation::transposed_times;
use ropewalk_core::{Assembly, At, SpanLine, V3, dot};

/// The force on a cell, and its derivatives by the normal force and by the slope of the line.
struct Braked {
    f: V3<f64>,
    by_normal: V3<f64>,
    by_slope: [V3<f64>; 3],
    /// By how much each vector of the nodes is in the slope.
    weights: [f64; 4],
}

/// What the vectors of two nodes weigh in `r'` at `ξ` of an element of length `l`.
fn slope_weights(xi: f64, l: f64) -> [f64; 4] {
    let rest = 1.0 - xi;
    let s = 6.0 * xi * rest / l;
    [-s, rest * (1.0 - 3.0 * xi), s, xi * (3.0 * xi - 2.0)]
}

impl Contact {
    /// Whether equilibria are looked for, with a friction that a pull uses up: time hasn't begun to run.
    pub(super) fn brakes(&self, memory: &[f64]) -> bool {
        self.begun.is_some_and(|begun| memory.get(begun).is_some_and(|b| *b == 0.0))
    }

    fn braked(&self, friction: &Friction, group: &Group, cell: usize, pressed: &Pressed, frame: &Frame, at: &At<'_>) -> Option<Braked> {
        let (What::Span(span), Some(Bristles { grip, cells, .. })) = (&group.what, &group.bristles) else {
            return None;
        };
        let (brake, SpanLine::Cubic { q, l, .. }) = (grip.brake?, span.line) else { return None };
        let weights = slope_weights((cell as f64 + 0.5) / *cells as f64, l);
        let slope: V3<f64> = std::array::from_fn(|i| (0..4).map(|a| weights[a] * at.q[q[a] + i]).sum());
        let stretch = dot(&slope, &slope).sqrt();
        let t = slope.map(|x| x / stretch);
        let (share, rise) = brake.share(stretch - 1.0);
        let most = friction.mu * pressed.normal;
        let seen = |x: &V3<f64>| match self.fixed.seat {
            Seat::Ground => *x,
            Seat::Body { .. } => transposed_times(&frame.r, x),
        };
        // a column for each component of the slope: what is along it strains, what is across turns
        let by_slope = std::array::from_fn(|j| {
            let column = std::array::from_fn(|i| {
                let turn = if i == j { 1.0 } else { 0.0 } - t[i] * t[j];
                most * (rise * t[i] * t[j] + share / stretch * turn)
            });
            seen(&column)
        });
        let f = seen(&t.map(|t| most * share * t));
        Some(Braked { f, by_normal: f.map(|f| f / pressed.normal), by_slope, weights })
    }

    /// Adds the force on a cell.
    pub(super) fn add_braked(
        &self,
        group: &Group,
        cell: usize,
        pressed: &Pressed,
        (frame, at): (&Frame, &At<'_>),
        out: &Assembly<'_>,
        block: &mut Block,
    ) {
        let Some(friction) = &self.law.friction else { return };
        let Some(braked) = self.braked(friction, group, cell, pressed, frame, at) else { return };
        let held = group.station(cell);
        let pair = self.pair(&held, group.radius(), frame, at);
        let spread = |f: &V3<f64>| self.spread(&held, &pair, &pressed.n, f);
        for (i, f) in spread(&braked.f).iter().enumerate().filter(|(_, f)| **f != 0.0) {
            block.add(i, -f);
        }
        if !out.wants_tangent() {
            return;
        }
        block.add_outer(&spread(&braked.by_normal), &pressed.by);
        for (j, column) in braked.by_slope.iter().enumerate() {
            let mut by = [0.0; MOST];
            (0..4).for_each(|a| by[3 * a + j] = out.weights().q * braked.weights[a]);
            block.add_outer(&spread(column), &by);
        }
    }

    /// Sees the force on each cell.
    pub(super) fn each_braked(&self, at: &At<'_>, mut see: impl FnMut(&V3<f64>)) {
        let Some(friction) = self.law.friction.as_ref().filter(|_| self.brakes(at.internal)) else { return };
        let (frame, mut scratch) = (self.fixed.frame(at), Scratch::default());
        for group in &self.groups {
            let Some(bristles) = group.bristles else { continue };
            let mut cells = self.press(group, &frame, at, &mut scratch);
            for (cell, pressed) in cells[..bristles.cells].iter_mut().enumerate() {
                if pressed.settle()
                    && let Some(braked) = self.braked(friction, group, cell, pressed, &frame, at)
                {
                    see(&braked.f);
                }
            }
        }
    }

    /// How far the bristle of a cell is stretched that pulls as hard.
    pub(super) fn braked_stretch(
        &self,
        group: &Group,
        cell: usize,
        pressed: &Pressed,
        frame: &Frame,
        at: &At<'_>,
    ) -> Option<V3<f64>> {
        let braked = self.braked(self.law.friction.as_ref()?, group, cell, pressed, frame, at)?;
        let stiffness = group.bristles.as_ref()?.grip.stiffness;
        let normal = dot(&braked.f, &pressed.n);
        Some(std::array::from_fn(|i| (normal * pressed.n[i] - braked.f[i]) / stiffness))
    }

    /// Lets friction brake the cables at equilibria; `begun` is the place in the memory that says that time runs.
    #[must_use]
    pub fn with_brakes(mut self, brakes: &[Option<Brake>], begun: usize) -> Self {
        for (group, brake) in self.groups.iter_mut().zip(brakes) {
            if let Some(bristles) = &mut group.bristles {
                bristles.grip.brake = *brake;
            }
        }
        self.begun = Some(begun);
        self
    }

    /// How far the surface of a part is from the shape at an arc length of it [m], negative where it is pressed in; `None` of what
    /// isn't slender, or where there is nothing of it.
    pub(super) fn clearance(&self, part: &str, s: f64, at: &At<'_>) -> Option<f64> {
        let frame = self.fixed.frame(at);
        let of = |group: &Group| {
            let What::Span(span) = &group.what else { return None };
            let place = group.place.as_ref().filter(|p| *p.part == *part)?;
            let xi = (s - place.s) / span.length;
            (-1e-9..=1.0 + 1e-9).contains(&xi).then(|| (span.line.held(xi.clamp(0.0, 1.0)), span.radius))
        };
        let (held, radius): (Held, f64) = self.groups.iter().find_map(of)?;
        let gap = self.fixed.gap(&self.fixed.place(&frame, &held.x(at)), f64::INFINITY)?;
        Some(gap.distance - radius)
    }
}
