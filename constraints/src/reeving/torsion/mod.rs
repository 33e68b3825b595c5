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

use super::local::Local;
use super::sheave::{Groove, Sheave};
use super::twist::Twist;
pub(super) use roll::Rolls;
use ropewalk_core::{
    Assembly, At, Column, Energy, Jet, MovingBoundary, Pattern, Power, Remembers, Residuals, Seeds, Shows,
    Term, V3, Weights, dot, tangent,
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

/// Most by which what counts whole turns may change at once [rad]: half a turn can't be told from the other half.
const MOST_CHANGE: f64 = 2.0;

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

/// The torsion of one cable on a wheel, as a term.
pub(in crate::reeving) struct ArcTorsion {
    pub sheave: Arc<Sheave>,
    /// Number of the groove, which has a [`Twist`].
    pub groove: usize,
}

/// Residual, and what there is to know.
struct Forces<S> {
    r: [S; MOST],
    /// Kinetic and potential energy [J].
    energy: [S; 2],
    dissipated: S,
    carried: S,
    /// Twist per length [rad/m] and elastic torque [N m], as spans show it.
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

    /// The angle by which the spins of both ends are labelled [rad].
    fn label_angle(&self, q: &[f64]) -> f64 {
        let [a, b] = self.at().ends.map(|end| q[end.end_q + 9]);
        b - a
    }

    /// The twist now: what it has besides the labels of the ends is near that at the last state, by which whole turns count.
    fn twist_now(&self, at: &At<'_>) -> f64 {
        let found = self.uncounted(at);
        let near = self.at().twist.map_or(found, |own| own.recalls(1, at.internal) + self.label_angle(at.q));
        found + TAU * ((near - found) / TAU).round()
    }

    /// Twist and stretched length now; the latter only where it matters.
    fn now(&self, at: &At<'_>) -> [f64; 2] {
        let laid = self.at().twist.is_some_and(|own| own.torsion.lay != 0.0);
        [self.twist_now(at), if laid { self.length(at) } else { 0.0 }]
    }

    /// [`Twist::laid`] where it is laid with a twist near this [rad].
    pub fn starts(&self, near: f64, q: &[f64]) -> [f64; 2] {
        let at = At { t: 0.0, q, v: &[], a: &[], internal: &[], relaxed: None };
        let found = self.uncounted(&at);
        let twist = found + TAU * ((near - found) / TAU).round();
        [twist, twist - self.label_angle(q)]
    }

    /// Evaluates all of it, as torsion does in an element through which material flows: with the twist per length `K = Φ/A` the
    /// section of the material at an end spins at `ν = w - Ṗ K`, linear in between.
    #[inline(always)]
    fn eval<S: Jet>(&self, at: &At<'_>, x: &Local<S, MOST>, now: [f64; 2]) -> Forces<S> {
        let Some(Twist { torsion: Torsional { gj, damping, inertia, free, lay }, .. }) = self.at().twist
        else {
            let zero = S::zero();
            let (r, energy, shown) = ([zero; MOST], [zero; 2], [zero; 2]);
            return Forces { r, energy, dissipated: zero, carried: zero, shown };
        };
        let Shape { twist, by_twist, length, by_length } = self.shaped(at, &x.d, now);
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
        let elastic = off * gj + strain * lay;
        let moment = elastic + viscous;
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
            shown: [k, elastic],
        }
    }

    fn forces(&self, at: &At<'_>) -> Forces<f64> {
        self.eval(at, &Local::of(&self.dofs(), at), self.now(at))
    }
}

/// The torsion of a cable on its wheel at an instant.
struct On<'a> {
    torsion: &'a ArcTorsion,
    at: &'a At<'a>,
    x: &'a Local<f64, MOST>,
    w: Weights,
    now: [f64; 2],
}

impl Residuals<MOST> for On<'_> {
    #[inline(always)]
    fn eval<S: Jet>(&self, seeds: &impl Seeds<S>) -> [S; MOST] {
        self.torsion.eval(self.at, &self.x.along(self.w, seeds), self.now).r
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
        let (dofs, w, now) = (self.dofs(), out.weights(), self.now(at));
        let x = Local::of(&dofs, at);
        for (dof, r) in dofs.iter().zip(self.eval(at, &x, now).r) {
            out.add(*dof, r);
        }
        if !out.wants_tangent() {
            return;
        }
        let mut block = [[0.0; MOST]; MOST];
        tangent(&On { torsion: self, at, x: &x, w, now }, dofs.len(), &mut block);
        let still = Local { a: [0.0; MOST], ..x };
        let force = self.eval(at, &still, now).r;
        leave_out(&self.at().ends, at, w.q, [force[6], force[SECOND + 6]], &mut block);
        out.add_square(0, &block);
    }
    fn energy(&self, at: &At<'_>) -> Energy {
        let [kinetic, potential] = self.forces(at).energy;
        Energy { kinetic, potential }
    }
    fn power(&self, at: &At<'_>) -> Power {
        let Forces { dissipated, carried, .. } = self.forces(at);
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
        out.extend(self.forces(at).shown);
    }
}

impl Remembers for ArcTorsion {
    fn remember(&self, at: &At<'_>, memory: &mut [f64]) {
        let Some(own) = self.at().twist else { return };
        let twist = self.twist_now(&At { internal: memory, ..*at });
        let now = [twist, twist - self.label_angle(at.q)];
        for (x, (now, laid)) in memory.iter_mut().skip(own.memory).zip(now.into_iter().zip(own.laid)) {
            *x = now - laid;
        }
    }
    fn rests(&self) -> bool {
        true
    }
    fn settle(&self, at: &At<'_>, memory: &mut [f64]) -> bool {
        let own = self.at().twist;
        let now = |memory: &[f64]| own.map_or(0.0, |own| own.recalls(0, memory));
        let before = now(memory);
        self.remember(at, memory);
        // friction goes by the tension, of which that of twist is known from here on
        own.is_some_and(|own| own.torsion.lay != 0.0)
            && self.sheave.rubs()
            && (now(memory) - before).abs() > 1e-9
    }
    fn lost(&self, at: &At<'_>) -> Option<String> {
        let change = self.twist_now(at) - self.label_angle(at.q) - self.at().twist?.recalls(1, at.internal);
        (!(change.abs() <= MOST_CHANGE)).then(|| {
            format!(
                "a cable with torsion turns so far about `{}` at once that its turns can't be counted",
                self.sheave.name
            )
        })
    }
    fn labels(&self, q: &[f64]) -> Option<(usize, f64)> {
        Some((self.at().twist?.memory + 1, self.label_angle(q)))
    }
}
