//! The torsion of what lies on a wheel between two spans of a cable.
//!
//! Along an arc the frame of the wheel, its axis and the direction away from it, turns about no tangent: it is the frame without
//! spin (Bishop, Am. Math. Mon. 82, 1975). So with the angle `α` at which the direction `ρ` from the axis to an end is seen in the
//! section there, `tan α = ρ·d / ρ·(t × d)`, the twist of the arc is `Φ = α_s - α_e`: of both ends alone, whatever the wrap. Where
//! the cable comes by a fleet angle its tangent turns about `ρ`, which leaves `α` as it is.
//!
//! Where it only touches the wheel or is off there is a straight piece, and its twist is that between both ends with the
//! directors carried over the direction of the piece.
//!
//! The cable is free to roll in its groove: what twists it is the same before and behind, and twist goes along with the material. What
//! comes by a fleet angle is rolled by the flank if the scene says so: [`Rolls`].

mod roll;
mod shape;
mod welded;

use super::sheave::{Groove, Sheave};
use num_dual::Dual64;
pub(super) use roll::Rolls;
use ropewalk_core::{
    Assembly, At, Column, Energy, Jet, MovingBoundary, Pattern, Power, Remembers, Shows, Term, V3, dot,
};
use ropewalk_scene::Torsional;
use shape::Shape;
use std::f64::consts::TAU;
use std::sync::Arc;
pub(super) use welded::Welded;

/// Unknowns: of each end its place, slope, spin and material coordinate; what carries the wheel.
const MOST: usize = 22;
/// First of those of the second end, and of what carries the wheel.
const SECOND: usize = 8;
const CARRIER: usize = 16;

/// What the torsion on a wheel of this name is called.
pub(super) fn label(wheel: &str) -> String {
    format!("{wheel}: torsion")
}

/// What is shown besides of a wheel of this name: terms that are called so.
pub(super) fn shown(wheel: &str) -> [String; 2] {
    [label(wheel), roll::label(wheel)]
}

/// What stands before the names of columns of a groove.
fn of_groove(sheave: &Sheave, groove: usize) -> String {
    if sheave.grooves.len() == 1 { String::new() } else { format!("{}.", groove + 1) }
}

/// What every term leaves out of its tangent, by its residuals on the spins of both ends, as it sums up to nothing where the spins are
/// balanced.
fn leave_out(
    ends: &[MovingBoundary; 2],
    at: &At<'_>,
    weight: f64,
    spin: [f64; 2],
    block: &mut [[f64; MOST]; MOST],
) {
    for (k, end) in ends.iter().enumerate() {
        let p: V3<f64> = std::array::from_fn(|i| at.q[end.end_q + 3 + i]);
        let square = dot(&p, &p);
        let by = 0.5 * weight * spin[k] / (square * square.sqrt());
        let first = SECOND * k + 3;
        for (i, j, c) in [(0, 1, 2), (1, 2, 0), (2, 0, 1)] {
            block[first + i][first + j] += by * p[c];
            block[first + j][first + i] -= by * p[c];
        }
    }
}

/// The twist of one cable on a wheel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::reeving) struct Twist {
    pub torsion: Torsional,
    /// Twist at the start [rad].
    pub laid: f64,
    /// Place of the internal variable by how much it differs since at the last state [rad]: it counts whole turns.
    pub memory: usize,
}

impl Twist {
    /// Twist at the last state [rad].
    pub fn last(&self, at: &At<'_>) -> f64 {
        self.laid + at.internal.get(self.memory).copied().unwrap_or(0.0)
    }

    /// Tension that it makes in a laid rope of this unstretched length [N].
    pub fn pull(&self, length: f64, at: &At<'_>) -> f64 {
        self.torsion.lay * (self.last(at) / length - self.torsion.free)
    }
}

/// The torsion of one cable on a wheel, as a term.
pub(in crate::reeving) struct ArcTorsion {
    pub sheave: Arc<Sheave>,
    /// Number of the groove, which has a [`Twist`].
    pub groove: usize,
}

/// Increments, velocities and accelerations of the unknowns.
struct Local<S> {
    d: [S; MOST],
    v: [S; MOST],
    a: [S; MOST],
}

/// Residual, and what there is to know.
struct Forces<S> {
    r: [S; MOST],
    /// Kinetic and potential energy [J].
    energy: [S; 2],
    dissipated: S,
    carried: S,
    /// Twist per length [rad/m] and torque [N m].
    shown: [S; 2],
}

impl ArcTorsion {
    fn at(&self) -> &Groove {
        &self.sheave.grooves[self.groove]
    }

    fn dofs(&self) -> Vec<usize> {
        let of = |end: &MovingBoundary| (end.end_v..end.end_v + 7).chain([end.v]);
        let [a, b] = &self.at().ends;
        let seat = &self.sheave.seat;
        of(a).chain(of(b)).chain(seat.on.into_iter().flat_map(|(_, v, _)| v..v + seat.size())).collect()
    }

    fn local(&self, at: &At<'_>) -> Local<f64> {
        let mut x = Local { d: [0.0; MOST], v: [0.0; MOST], a: [0.0; MOST] };
        for (i, dof) in self.dofs().into_iter().enumerate() {
            (x.v[i], x.a[i]) = (at.v[dof], at.a[dof]);
        }
        x
    }

    /// The whole turns of an angle are those of the last state.
    fn counted(&self, twist: f64, at: &At<'_>) -> f64 {
        let near = self.at().twist.map_or(twist, |own| own.last(at));
        twist + TAU * ((near - twist) / TAU).round()
    }

    /// Evaluates all of it, as torsion does in an element through which material flows: with the twist per length `K = Φ/A` the
    /// section of the material at an end spins at `ν = w - Ṗ K`, linear in between.
    fn eval<S: Jet>(&self, at: &At<'_>, x: &Local<S>) -> Forces<S> {
        let Some(Twist { torsion: Torsional { gj, damping, inertia, free, lay }, .. }) = self.at().twist
        else {
            let zero = S::zero();
            let (r, energy, shown) = ([zero; MOST], [zero; 2], [zero; 2]);
            return Forces { r, energy, dissipated: zero, carried: zero, shown };
        };
        let Shape { twist, by_twist, length, by_length } = self.shaped(at, &x.d);
        let groove = self.at();
        let p = |k: usize| x.d[SECOND * k + 7] + at.q[groove.ends[k].q];
        let (pd, pdd) = ([0, 1].map(|k| x.v[SECOND * k + 7]), [0, 1].map(|k| x.a[SECOND * k + 7]));
        let stored = p(1) - p(0) + groove.stored;
        let grows = pd[1] - pd[0];
        let rate = by_twist.iter().zip(&x.v).fold(S::zero(), |sum, (g, v)| sum + *g * *v);
        let k = twist / stored;
        let kd = (rate - k * grows) / stored;
        let strain = length / stored - 1.0;
        let (off, viscous) = (k - free, kd * damping);
        let moment = off * gj + viscous + strain * lay;
        let by_stored = -(k * (k * (0.5 * gj) + viscous)) - (length / stored * off + strain * free) * lay;
        let nu = [0, 1].map(|i| x.v[SECOND * i + 6] - pd[i] * k);
        let slope = (nu[1] - nu[0]) / stored;
        let turns = [0, 1].map(|i| x.a[SECOND * i + 6] - pd[i] * (kd + slope) - pdd[i] * k);
        let one = stored * (inertia / 12.0);
        let more = grows * (nu[1] - nu[0]) * (0.125 * inertia);
        let spin = [one * (turns[0] * 5.0 + turns[1]) - more, one * (turns[1] * 5.0 + turns[0]) + more];
        let mut r = [S::zero(); MOST];
        for i in 0..MOST {
            r[i] = by_twist[i] * moment;
            if lay != 0.0 {
                r[i] += by_length[i] * off * lay;
            }
        }
        for i in 0..2 {
            r[SECOND * i + 6] += spin[i];
            let sign = if i == 0 { -1.0 } else { 1.0 };
            r[SECOND * i + 7] += by_stored * sign - k * spin[i];
        }
        let kinetic = one * (nu[0] * nu[0] * 2.5 + nu[1] * nu[1] * 2.5 + nu[0] * nu[1]);
        let potential = stored * (k * (k * 0.5 - free) * gj + strain * off * lay);
        let carried = (pd[1] * nu[1] * nu[1] - pd[0] * nu[0] * nu[0]) * (0.5 * inertia);
        Forces {
            r,
            energy: [kinetic, potential],
            dissipated: stored * viscous * kd,
            carried,
            shown: [k, moment],
        }
    }
}

impl Term for ArcTorsion {
    fn label(&self) -> String {
        label(&self.sheave.name)
    }
    fn pattern(&self, p: &mut Pattern) {
        p.clique(self.dofs());
    }
    fn symmetric(&self) -> bool {
        false
    }
    fn add(&self, at: &At<'_>, out: &mut Assembly<'_>) {
        let (dofs, x, w) = (self.dofs(), self.local(at), out.weights());
        for (dof, r) in dofs.iter().zip(self.eval(at, &x).r) {
            out.add(*dof, r);
        }
        if !out.wants_tangent() {
            return;
        }
        let mut block = [[0.0; MOST]; MOST];
        for j in 0..dofs.len() {
            let towards = |x: &[f64; MOST], w: f64| -> [Dual64; MOST] {
                std::array::from_fn(|i| Dual64::new(x[i], if i == j { w } else { 0.0 }))
            };
            let x = Local { d: towards(&x.d, w.q), v: towards(&x.v, w.v), a: towards(&x.a, w.a) };
            let column = self.eval(at, &x).r;
            for i in 0..dofs.len() {
                block[i][j] = column[i].eps;
            }
        }
        let still = Local { a: [0.0; MOST], ..x };
        let force = self.eval(at, &still).r;
        leave_out(&self.at().ends, at, w.q, [force[6], force[SECOND + 6]], &mut block);
        out.add_square(0, &block);
    }
    fn energy(&self, at: &At<'_>) -> Energy {
        let [kinetic, potential] = self.eval(at, &self.local(at)).energy;
        Energy { kinetic, potential }
    }
    fn power(&self, at: &At<'_>) -> Power {
        let Forces { dissipated, carried, .. } = self.eval(at, &self.local(at));
        Power { dissipated, carried, ..Power::default() }
    }
    fn remembers(&self) -> Option<&dyn Remembers> {
        Some(self)
    }
    fn shows(&self) -> Option<&dyn Shows> {
        Some(self)
    }
}

impl Shows for ArcTorsion {
    fn columns(&self) -> Vec<Column> {
        let prefix = of_groove(&self.sheave, self.groove);
        [("twist", "rad/m"), ("torque", "N m")]
            .map(|(name, unit)| Column::new(format!("{prefix}{name}"), unit))
            .to_vec()
    }
    fn observe(&self, at: &At<'_>, out: &mut Vec<f64>) {
        out.extend(self.eval(at, &self.local(at)).shown);
    }
}

impl Remembers for ArcTorsion {
    fn remember(&self, at: &At<'_>, memory: &mut [f64]) {
        let Some(own) = self.at().twist else { return };
        let twist = self.shaped(&At { internal: memory, ..*at }, &[0.0; MOST]).twist;
        if let Some(x) = memory.get_mut(own.memory) {
            *x = twist - own.laid;
        }
    }
    fn rests(&self) -> bool {
        true
    }
    fn settle(&self, at: &At<'_>, memory: &mut [f64]) -> bool {
        let own = self.at().twist;
        let now = |memory: &[f64]| own.and_then(|own| memory.get(own.memory).copied()).unwrap_or(0.0);
        let before = now(memory);
        self.remember(at, memory);
        // friction goes by the tension, of which that of twist is known from here on
        own.is_some_and(|own| own.torsion.lay != 0.0) && (now(memory) - before).abs() > 1e-9
    }
}
