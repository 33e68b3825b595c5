//! Dry friction between lines: the bristles of all cells, and how their places move.
//!
//! Each cell of a piece that another presses is tied to it by a [`Bristle`]; where both face each other both have theirs,
//! with the half of the normal force that is theirs. A bristle is remembered by its pair of pieces and its cell: the places that
//! it ties, and what `α` was there when it took hold. Accepted steps alone move them.

use super::super::friction::{AtRest, Friction};
use super::bristle::{Bristle, Hold};
use super::curve::{Curve, size};
use super::facing::{Facing, Scratch};
use super::pieces::{Piece, Pieces};
use super::push::{Pressed, Sum};
use super::term::LineContact;
use ropewalk_core::error::{need, positive};
use ropewalk_core::rotation::cross;
use ropewalk_core::{Assembly, At, BuildError, Leap, Remembers};
use std::sync::Arc;

/// Cells on each piece.
pub(crate) const CELLS: usize = 4;
/// How many others may press a cell at once, in the mean over all cells.
const PARTNERS: usize = 4;
/// Numbers that are remembered of a bristle: which it is, both places, and `α` there when it took hold.
const MEMORY: usize = 5;
/// Elastic slip, and the depth at which bristles of that slip are at their limit, in parts of the thickness.
const SLIP: f64 = 0.01;
/// Damping ratio of bristles that hold.
const RATIO: f64 = 0.5;

/// What holds lines that would slip.
#[derive(Debug)]
pub(crate) struct Rubs {
    friction: Friction,
    /// Mass per length of the line of each piece [kg/m].
    density: Vec<f64>,
    /// Where the number of those left out is among the internal variables; what is remembered follows.
    memory: usize,
    room: usize,
}

/// What is remembered of a bristle.
struct Anchor {
    xi: [f64; 2],
    from: [f64; 2],
}

impl Rubs {
    /// The cell of a place.
    pub fn cell(xi: f64) -> usize {
        ((xi * CELLS as f64) as usize).min(CELLS - 1)
    }

    /// What all bristles remember.
    fn entries<'a>(&self, memory: &'a [f64]) -> &'a [f64] {
        let first = self.memory + 1;
        memory.get(first..first + MEMORY * self.room).unwrap_or(&[])
    }

    fn anchor(&self, key: f64, memory: &[f64]) -> Option<Anchor> {
        let all = self.entries(memory).as_chunks::<MEMORY>().0;
        // in order, and room that is empty behind them
        let own = all.get(all.partition_point(|own| own[0] != 0.0 && own[0] < key))?;
        (own[0] == key).then(|| Anchor { xi: [own[1], own[2]], from: [own[3], own[4]] })
    }
}

/// Which bristle one is: of a cell of the first of two pieces.
#[derive(Clone, Copy)]
struct Which {
    pair: [usize; 2],
    /// Of a piece that faces itself, whether it faces what is behind.
    behind: bool,
    cell: usize,
}

impl Which {
    fn new(pair: [usize; 2], facing: &Facing<'_>, cell: usize) -> Self {
        let behind = pair[0] == pair[1] && facing.window.is_some_and(|w| !w.ahead);
        Which { pair, behind, cell }
    }

    /// Its number, above zero.
    fn key(self, pieces: &Pieces) -> f64 {
        let [i, j] = self.pair;
        let pair = (i * pieces.all.len() + j) * 2 + usize::from(self.behind);
        (pair * CELLS + self.cell + 1) as f64
    }
}

/// How far beyond a node a place is still told by the piece before it, in parts of the piece.
const BEYOND: f64 = 1.0 / CELLS as f64;

impl LineContact {
    /// How many numbers friction between the pieces remembers.
    pub fn memory(&self) -> usize {
        1 + MEMORY * PARTNERS * CELLS * self.pieces.all.len()
    }

    /// Lines hold on to each other by the [`Friction`] of the law; `densities` are the masses per length of the lines [kg/m],
    /// what is remembered is at `memory` of the internal variables, [`LineContact::memory`] numbers.
    ///
    /// # Errors
    /// No friction, or what is known of surfaces alone: a coefficient across, braking against a pull.
    pub fn with_friction(mut self, densities: &[f64], memory: usize) -> Result<Self, BuildError> {
        let Some(friction) = self.law.friction else {
            return Err(BuildError::at("friction", "there is no friction to hold by"));
        };
        need(friction.across.is_none(), || {
            "lines that touch each other have one coefficient of friction: leave `across` out".to_string()
        })
        .map_err(|e| BuildError::at("friction", e.message))?;
        need(friction.equilibrium != AtRest::Pulled, || {
            "friction between lines isn't known to be used up by a pull: take `equilibrium = \"laid\"`"
                .to_string()
        })
        .map_err(|e| BuildError::at("friction", e.message))?;
        positive("friction", friction.mu)?;
        let density = self.pieces.all.iter().map(|p| densities.get(p.line).copied().unwrap_or(0.0)).collect();
        let room = PARTNERS * CELLS * self.pieces.all.len();
        self.rubs = Some(Arc::new(Rubs { friction, density, memory, room }));
        Ok(self)
    }

    /// Stiffness and damping of the bristle of a cell that faces another piece. As stiff as half of the contact, so that it
    /// gives way less than that does; with an elastic slip told so stiff that it gives way by that where the cell is
    /// pressed a hundredth of the thickness deep.
    fn grip(&self, rubs: &Rubs, [i, j]: [usize; 2]) -> [f64; 2] {
        let [a, b]: [&Piece; 2] = [i, j].map(|k| &self.pieces.all[k]);
        let thick = a.radius + b.radius;
        let cell = a.length / CELLS as f64;
        let deep = SLIP * thick;
        let secant = 0.5 * self.per_length * cell.max(thick) * deep.powf(self.law.exponent - 1.0);
        let Friction { mu, elastic_slip, .. } = rubs.friction;
        let k = elastic_slip.map_or(secant, |slip| secant * mu * deep / slip);
        let mass = rubs.density[i].min(rubs.density[j]) * cell;
        [k, 2.0 * RATIO * (k * mass).sqrt()]
    }

    /// What is remembered of a bristle; of one whose nearest place has gone over a node, what was remembered of it there.
    fn anchor(&self, rubs: &Rubs, which: Which, memory: &[f64]) -> Option<Anchor> {
        let all = &self.pieces.all;
        let own = rubs.anchor(which.key(&self.pieces), memory);
        let [i, j] = which.pair;
        if own.is_some() || i == j {
            return own;
        }
        let beside = [j.checked_sub(1), Some(j + 1)].into_iter().flatten();
        let beside = beside.filter(|&k| k != i && all.get(k).is_some_and(|p| p.line == all[j].line));
        beside.into_iter().find_map(|k| {
            let mut anchor = rubs.anchor(Which { pair: [i, k], ..which }.key(&self.pieces), memory)?;
            anchor.xi[1] = (all[k].s + anchor.xi[1] * all[k].length - all[j].s) / all[j].length;
            (-BEYOND..=1.0 + BEYOND).contains(&anchor.xi[1]).then_some(anchor)
        })
    }

    /// The bristle of a cell, if it has taken hold, and how far it is stretched.
    fn bristle(
        &self,
        rubs: &Rubs,
        which: Which,
        at: &At<'_>,
        memory: &[f64],
    ) -> Option<(Bristle, [f64; 2], Anchor)> {
        let (anchor, pair) = (self.anchor(rubs, which, memory)?, which.pair);
        let lines = pair.map(|k| &self.pieces.all[k].span);
        let bristle = Bristle::new(lines, anchor.xi, at);
        let stretch = [0, 1].map(|k| bristle.alpha[k] - anchor.from[k]);
        Some((bristle, stretch, anchor))
    }

    /// Adds the forces of the bristles of one piece that faces another.
    pub(super) fn add_friction(
        &self,
        rubs: &Rubs,
        (pair, facing): ([usize; 2], &Facing<'_>),
        cells: &[Pressed; CELLS],
        (place, n): ([&[usize]; 2], usize),
        at: &At<'_>,
        out: &mut Assembly<'_>,
        sum: &mut Sum,
    ) {
        let tangent = out.wants_tangent().then(|| out.weights());
        for (cell, pressed) in cells.iter().enumerate().filter(|(_, p)| p.normal > 0.0) {
            let which = Which::new(pair, facing, cell);
            let Some((bristle, stretch, anchor)) = self.bristle(rubs, which, at, at.internal) else {
                continue;
            };
            let (grip, mu) = (self.grip(rubs, pair), rubs.friction.mu);
            let mut hold = bristle.hold(grip, stretch, mu * pressed.normal);
            if hold.slips
                && let (Some(weights), Some(leap)) = (tangent, out.leap())
            {
                let turned = |before: &[f64]| {
                    let lines = pair.map(|k| &self.pieces.all[k].span);
                    let was = Bristle::new(lines, anchor.xi, &At { v: before, ..*at }).rate;
                    hold.turned(grip, [0, 1].map(|k| bristle.rate[k] - was[k]), weights)
                };
                // what slips may have stopped on the way, of which the tangent of slip knows nothing
                if match leap {
                    Leap::Predicted => true,
                    Leap::From(before) => turned(before),
                } {
                    hold.stick();
                    out.approximates();
                }
            }
            bristle.add(&hold, (grip, mu), pressed, place, n, tangent, sum);
        }
    }

    /// How each cell of a piece is pressed by another.
    fn press(
        &self,
        pair: [usize; 2],
        facing: &Facing<'_>,
        at: &At<'_>,
        scratch: &mut Scratch,
    ) -> [Pressed; CELLS] {
        let mut cells = [Pressed::NONE; CELLS];
        self.each_of(pair, facing, at, scratch, &mut |push| cells[Rubs::cell(push.xi[0])].add(&push));
        cells
    }

    /// Sees each cell that is pressed, and what presses it.
    fn each_cell(&self, at: &At<'_>, mut see: impl FnMut(Which, &Pressed)) {
        let near = self.near(at);
        let curves: Vec<Option<Curve>> = self.curves(&near, at);
        let mut scratch = Scratch::default();
        for couple in &near.couples {
            for (pair, facing) in self.facings(couple.pieces, &curves) {
                let cells = self.press(pair, &facing, at, &mut scratch);
                for (cell, pressed) in cells.iter().enumerate().filter(|(_, p)| p.normal > 0.0) {
                    see(Which::new(pair, &facing, cell), pressed);
                }
            }
        }
    }

    /// Sees each bristle that holds, with the normal force on its cell.
    pub(super) fn each_bristle(&self, at: &At<'_>, mut see: impl FnMut(&Bristle, &Hold, f64)) {
        let Some(rubs) = &self.rubs else { return };
        self.each_cell(at, |which, pressed| {
            if let Some((bristle, stretch, _)) = self.bristle(rubs, which, at, at.internal) {
                let hold =
                    bristle.hold(self.grip(rubs, which.pair), stretch, rubs.friction.mu * pressed.normal);
                see(&bristle, &hold, pressed.normal);
            }
        });
    }

    /// Moves the places of the bristles after a step: those that slipped to where they touch now, with what stretch is left;
    /// those that touch anew without any. What holds stays as it is.
    fn move_anchors(&self, rubs: &Rubs, at: &At<'_>, memory: &mut [f64]) {
        let mut all: Vec<[f64; MEMORY]> = Vec::new();
        self.each_cell(at, |which, pressed| {
            let (pair, key) = (which.pair, which.key(&self.pieces));
            let Some(xi) = pressed.place() else { return };
            let mut stretch = [0.0; 2];
            if let Some((bristle, whole, anchor)) = self.bristle(rubs, which, at, memory) {
                let limit = rubs.friction.mu * pressed.normal;
                let size = bristle.size(self.grip(rubs, pair)[0], whole);
                if size <= limit {
                    let Anchor { xi: [a, b], from: [c, d] } = anchor;
                    all.push([key, a, b, c, d]);
                    return;
                }
                stretch = whole.map(|x| x * limit / size);
            }
            let here = Bristle::new(pair.map(|k| &self.pieces.all[k].span), xi, at);
            let from = [0, 1].map(|k| here.alpha[k] - stretch[k]);
            all.push([key, xi[0], xi[1], from[0], from[1]]);
        });
        all.sort_unstable_by(|a, b| a[0].total_cmp(&b[0]));
        memory[rubs.memory] = memory[rubs.memory].max(all.len().saturating_sub(rubs.room) as f64);
        let first = rubs.memory + 1;
        let own = &mut memory[first..first + MEMORY * rubs.room];
        own.fill(0.0);
        own.iter_mut().zip(all.as_flattened()).for_each(|(own, x)| *own = *x);
    }

    /// What to say where a line that touches itself is bent tighter than its own radius: what is next to each other there would be
    /// in each other, and isn't looked at.
    pub(super) fn tight(&self, at: &At<'_>) -> Option<String> {
        if !self.pieces.itself {
            return None;
        }
        let bent = |k: usize| {
            let curve = Curve::of(&self.pieces.all[k].span, at);
            [0.0, 0.5, 1.0].map(|xi| {
                let (slope, bend) = (curve.cubic.slope(xi), curve.cubic.second(xi));
                let (speed, turn) = (size(&slope), cross(&slope, &bend));
                (size(&turn) / speed.powi(3), k, xi)
            })
        };
        let all = (0..self.pieces.all.len()).flat_map(bent);
        let tight = all.filter(|(curvature, k, _)| curvature * self.pieces.all[*k].radius > 1.0);
        let (curvature, k, xi) = tight.max_by(|a, b| a.0.total_cmp(&b.0))?;
        let (line, s) = self.place(k, xi);
        Some(format!(
            "`{}`: `{line}` is bent to a radius of {:.2e} m at {s:.4} m, tighter than its own radius of {:.2e} m, so that it is in \
             itself there, which contact doesn't see. More bending stiffness, or a finer mesh, would keep it open",
            self.label,
            1.0 / curvature,
            self.pieces.all[k].radius
        ))
    }

    /// What to say where more cells touch each other than can be remembered.
    pub(super) fn crowded(&self, at: &At<'_>) -> Option<String> {
        let rubs = self.rubs.as_ref()?;
        let left = at.internal.get(rubs.memory).copied().filter(|left| *left > 0.0)?;
        Some(format!(
            "`{}`: at most {left} of the places that touched were without friction: more than {PARTNERS} lines press on each \
             other everywhere. Take fewer lines `on` it, or thinner ones",
            self.label
        ))
    }
}

impl Remembers for LineContact {
    fn remember(&self, at: &At<'_>, memory: &mut [f64]) {
        if let Some(rubs) = &self.rubs {
            self.move_anchors(rubs, at, memory);
        }
    }
    fn rests(&self) -> bool {
        self.law.friction.is_some_and(|f| f.equilibrium != AtRest::None)
    }
    fn takes_hold(&self) -> bool {
        self.rests()
    }
    fn settle(&self, at: &At<'_>, memory: &mut [f64]) -> bool {
        if self.rests() {
            self.remember(at, memory);
        }
        false
    }
}
