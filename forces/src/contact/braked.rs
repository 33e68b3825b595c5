//! Friction at equilibria that a pull on a line has used up.
//!
//! Along what lies on the ground the friction is `-μ N t` of the normal force `N` and the tangent `t`: fully mobilised, as behind
//! a line that was pulled tight. Where hardly any tension is left it fades with the strain to what holds the line on a slope and
//! where it lay sideways, so that no ground pushes a line. When time begins to run, the bristles take over exactly this force.

use super::block::{Block, MOST, Slopes};
use super::friction::{Friction, MEMORY, Pressed};
use super::group::{Bristles, Group, Scratch, What};
use super::seat::{Frame, Seat, minus};
use super::term::Contact;
use super::touch::Touch;
use ropewalk_core::held::{Held, delta, three};
use ropewalk_core::rotation::{M3, transposed_times};
use ropewalk_core::{Assembly, At, SpanLine, V3, dot};

/// The force on a cell, and its derivatives by the normal force, by the slope of the line and by its place.
struct Braked {
    f: V3<f64>,
    by_normal: V3<f64>,
    by_slope: M3,
    by_place: M3,
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
    fn braked(
        &self,
        friction: &Friction,
        group: &Group,
        cell: usize,
        pressed: &Pressed,
        (frame, at): (&Frame, &At<'_>),
        memory: &[f64],
    ) -> Option<Braked> {
        let (What::Span(span), Some(Bristles { grip, cells, at: first })) = (&group.what, &group.bristles)
        else {
            return None;
        };
        let (brake, SpanLine::Cubic { q, l, .. }) = (grip.brake?, span.line) else { return None };
        let own = memory.get(first + MEMORY * cell..)?.get(..MEMORY)?;
        let weights = slope_weights((cell as f64 + 0.5) / *cells as f64, l);
        let slope: V3<f64> = std::array::from_fn(|i| (0..4).map(|a| weights[a] * at.q[q[a] + i]).sum());
        let seen = |x: &V3<f64>| match self.fixed.seat {
            Seat::Ground => *x,
            Seat::Body { .. } => transposed_times(&frame.r, x),
        };
        let stretch = dot(&slope, &slope).sqrt();
        let (t, n) = (seen(&slope).map(|x| x / stretch), pressed.n);
        let (share, rise) = brake.share(stretch - 1.0);
        // what of its weight a slack line would slide down by
        let up = seen(&brake.up);
        let (rises, steep) = (dot(&n, &up).max(0.1), dot(&t, &up));
        let hold = (steep / rises).clamp(-friction.mu, friction.mu);
        let holds = hold.abs() < friction.mu;
        let most = -brake.way * friction.mu - hold;
        // sideways it lies where it lay, as far as tension doesn't straighten it
        let side = friction.mu / l;
        let loose = 1.0 - share.abs();
        let off = minus(&self.fixed.place(frame, &group.station(cell).x(at)), &three(own, 1));
        let across = |x: &V3<f64>| -> V3<f64> {
            let (along, normal) = (dot(x, &t), dot(x, &n));
            std::array::from_fn(|i| x[i] - along * t[i] - normal * n[i])
        };
        let aside = across(&off).map(|x| if own[0] == 0.0 { 0.0 } else { side * x });
        let pull = hold + most * share;
        let by_normal: V3<f64> = std::array::from_fn(|i| pull * t[i] - loose * aside[i]);
        let force = pressed.normal;
        // rows by components of the slope: what is along it strains, what is across turns
        let by_slope: M3 = std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let turn = (delta(i, j) - t[i] * t[j]) / stretch;
                let tilt = if holds { (up[j] - steep * t[j]) / (rises * stretch) } else { 0.0 };
                let strain = (most * t[i] + share.signum() * aside[i]) * rise * t[j];
                force * (pull * turn + (1.0 - share) * t[i] * tilt + strain)
            })
        });
        let by_place: M3 = std::array::from_fn(|i| {
            let row = across(&std::array::from_fn(|j| delta(i, j)));
            row.map(|x| if own[0] == 0.0 { 0.0 } else { -force * loose * side * x })
        });
        Some(Braked { f: by_normal.map(|f| force * f), by_normal, by_slope, by_place, weights })
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
        let Some(braked) = self.braked(friction, group, cell, pressed, (frame, at), at.internal) else {
            return;
        };
        let held = group.station(cell);
        let pair = self.pair(&held, group.radius(), frame, at);
        let spread = |f: &V3<f64>| self.spread(&held, &pair, &pressed.n, f);
        let touch = Touch::at_point(pressed.n, braked.f);
        let slopes = || Slopes { by_s: [[0.0; 3]; 3], by_x: braked.by_place, by_u: [[0.0; 3]; 3] };
        self.add_force(&held, &pair, &touch, slopes, out.wants_tangent().then(|| out.weights()), block);
        if !out.wants_tangent() {
            return;
        }
        block.add_outer(&spread(&braked.by_normal), &pressed.by);
        for j in 0..3 {
            let column: V3<f64> = std::array::from_fn(|i| braked.by_slope[i][j]);
            let mut by = [0.0; MOST];
            (0..4).for_each(|a| by[3 * a + j] = out.weights().q * braked.weights[a]);
            block.add_outer(&spread(&column), &by);
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
                    && let Some(braked) =
                        self.braked(friction, group, cell, pressed, (&frame, at), at.internal)
                {
                    see(&braked.f);
                }
            }
        }
    }

    /// The force on a cell.
    pub(super) fn braking(
        &self,
        group: &Group,
        cell: usize,
        pressed: &Pressed,
        (frame, at): (&Frame, &At<'_>),
        memory: &[f64],
    ) -> Option<V3<f64>> {
        let friction = self.law.friction.as_ref()?;
        self.braked(friction, group, cell, pressed, (frame, at), memory).map(|braked| braked.f)
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
