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
//! The cable is free to roll in its groove: what twists it is the same before and behind, and twist goes along with the material.

use super::arc::angle;
use super::hold::Mode;
use super::sheave::{Groove, Sheave};
use num_dual::Dual64;
use ropewalk_core::model::twist::{between, section};
use ropewalk_core::rotation::{cross, matrix, times, transposed_times};
use ropewalk_core::{
    Assembly, At, Column, Energy, Jet, MovingBoundary, Pattern, Place, Power, Relation, Remembers, RowKind,
    Shows, Term, V3, dot,
};
use ropewalk_scene::Torsional;
use std::f64::consts::TAU;
use std::sync::Arc;

/// The section at the end of a span and that at the start of the next look alike, one carried to the other by the smallest rotation:
/// of a cable that turns sharply in between, as in a ring. The markers are those of [`end`](super::tangent::end).
pub(super) struct Welded;

impl Relation for Welded {
    fn rows(&self) -> Vec<RowKind> {
        vec![RowKind::Direction]
    }
    fn g<S: Jet>(&self, _t: S, at: &[Place<S>], g: &mut [S]) {
        let ([t1, d1, n1], [t2, d2, n2]) = (&at[0].axes, &at[1].axes);
        let across = along(n1, d2) - along(d1, n2);
        g[0] = angle(across, along(d1, d2) + along(n1, n2) + along(t1, t2) + 1.0) * 2.0;
    }
}

/// Unknowns: of each end its place, slope, spin and material coordinate; what carries the wheel.
const MOST: usize = 22;
/// First of those of the second end, and of what carries the wheel.
const SECOND: usize = 8;
const CARRIER: usize = 16;

fn along<S: Jet>(a: &V3<S>, b: &V3<S>) -> S {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn less<S: Jet>(a: &V3<S>, s: S, b: &V3<S>) -> V3<S> {
    std::array::from_fn(|i| a[i] - b[i] * s)
}

/// What the torsion on a wheel of this name is called.
pub(super) fn label(wheel: &str) -> String {
    format!("{wheel}: torsion")
}

/// The twist of one cable on a wheel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Twist {
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
pub(super) struct ArcTorsion {
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

/// How twist and stretched length change with the unknowns, and what they are.
struct Shape<S> {
    twist: S,
    by_twist: [S; MOST],
    length: S,
    by_length: [S; MOST],
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

/// Where the wheel is and how it stands, over any carrier.
struct Hub<S> {
    centre: V3<S>,
    axis: V3<S>,
    /// From the origin of what carries it to the centre, and its rotation, if it turns.
    arm: V3<S>,
    turn: Option<[V3<S>; 3]>,
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

    fn hub<S: Jet>(&self, at: &At<'_>, d: &[S; MOST]) -> Hub<S> {
        let seat = &self.sheave.seat;
        let (point, axis) = (seat.point.map(S::from), seat.axis.map(S::from));
        let moved = |q: usize| -> V3<S> { std::array::from_fn(|i| d[CARRIER + i] + at.q[q + i]) };
        match seat.on {
            None => Hub { centre: point, axis, arm: point, turn: None },
            Some((q, _, false)) => Hub { centre: moved(q), axis, arm: point, turn: None },
            Some((q, _, true)) => {
                let still = matrix(&[at.q[q + 3], at.q[q + 4], at.q[q + 5], at.q[q + 6]]);
                let small = std::array::from_fn(|i| d[CARRIER + 3 + i]);
                // to first order, all that a first derivative needs
                let turn: [V3<S>; 3] = std::array::from_fn(|i| {
                    let row = still[i].map(S::from);
                    let more = cross(&row, &small);
                    std::array::from_fn(|j| row[j] + more[j])
                });
                let (foot, arm) = (moved(q), times(&turn, &point));
                let centre = std::array::from_fn(|i| foot[i] + arm[i]);
                Hub { centre, axis: times(&turn, &axis), arm, turn: Some(turn) }
            }
        }
    }

    /// Place and slope of an end.
    fn end<S: Jet>(&self, k: usize, at: &At<'_>, d: &[S; MOST]) -> [V3<S>; 2] {
        let (q, i) = (self.at().ends[k].end_q, SECOND * k);
        [0, 3].map(|n| std::array::from_fn(|c| d[i + n + c] + at.q[q + n + c]))
    }

    /// The whole turns of an angle are those of the last state.
    fn counted(&self, twist: f64, at: &At<'_>) -> f64 {
        let near = self.at().twist.map_or(twist, |own| own.last(at));
        twist + TAU * ((near - twist) / TAU).round()
    }

    /// Where it wraps the wheel.
    fn wraps<S: Jet>(&self, at: &At<'_>, d: &[S; MOST]) -> Shape<S> {
        let (hub, groove) = (self.hub(at, d), self.at());
        let (a, zero) = (&hub.axis, S::zero());
        let (mut by_twist, mut by_length) = ([zero; MOST], [zero; MOST]);
        let (mut place, mut turning, mut pulls) = ([zero; 3], [zero; 3], [zero; 3]);
        let mut seen = [0.0; 2];
        let mut outs = [[zero; 3]; 2];
        for k in 0..2 {
            let sign = if k == 0 { -1.0 } else { 1.0 };
            let [r, p] = self.end(k, at, d);
            let out: V3<S> = std::array::from_fn(|i| r[i] - hub.centre[i]);
            outs[k] = out;
            let beside = along(a, &out);
            let rho = less(&out, beside, a);
            let square = along(&rho, &rho);
            let size = along(&p, &p).sqrt();
            let t = p.map(|x| x / size);
            let lean = along(&rho, &t);
            let b = cross(&rho, &t).map(|x| x * sign / (square - lean * lean));
            let axial = along(&b, a);
            let across = less(&b, axial, a);
            let i = SECOND * k;
            for c in 0..3 {
                by_twist[i + c] = across[c];
                by_twist[i + 3 + c] = -(b[c] * lean / size);
                place[c] -= across[c];
            }
            by_twist[i + 6] = S::from(sign);
            let (tilt, swing) = (cross(a, &b), cross(a, &out));
            for c in 0..3 {
                turning[c] -= tilt[c] * beside + swing[c] * axial;
            }
            let radius = groove.arc.radius;
            let f = cross(a, &rho).map(|x| x * (radius * groove.side() * sign) / square);
            by_length[i..i + 3].copy_from_slice(&f);
            pulls = less(&pulls, S::one(), &f);
            let own = section(&at.q[groove.ends[k].end_q..]);
            let along = |c: usize| (0..3).map(|i| rho[i].re() * own[i][c]).sum::<f64>();
            seen[k] = along(0).atan2(along(1));
        }
        self.carry(&hub, &place, &turning, &mut by_twist);
        // of an end beside the plane of the wheel the wrap changes as the axis tilts
        let beside = outs.map(|out| along(a, &out));
        let (y, x) =
            (along(a, &cross(&outs[0], &outs[1])), along(&outs[0], &outs[1]) - beside[0] * beside[1]);
        let normal = cross(&outs[0], &outs[1]);
        let share = S::from(groove.arc.radius * groove.side()) / (x * x + y * y);
        let by_axis = std::array::from_fn(|i| {
            share * (x * normal[i] + y * (outs[0][i] * beside[1] + outs[1][i] * beside[0]))
        });
        self.carry(&hub, &pulls, &cross(a, &by_axis), &mut by_length);
        let length = groove.arc.radius * self.sheave.lay(self.groove, at).0.wrap;
        self.shape(self.counted(seen[1] - seen[0], at), length, by_twist, by_length, d)
    }

    /// Spreads what the centre and the rotation of the wheel do over what carries it.
    fn carry<S: Jet>(&self, hub: &Hub<S>, place: &V3<S>, turning: &V3<S>, by: &mut [S; MOST]) {
        let size = self.sheave.seat.size();
        if size > 0 {
            by[CARRIER..CARRIER + 3].copy_from_slice(place);
        }
        if let Some(turn) = &hub.turn {
            let lever = cross(&hub.arm, place);
            let all = std::array::from_fn(|i| lever[i] + turning[i]);
            by[CARRIER + 3..].copy_from_slice(&transposed_times(turn, &all));
        }
    }

    /// Both as they are, with their derivatives.
    fn shape<S: Jet>(
        &self,
        twist: f64,
        length: f64,
        by_twist: [S; MOST],
        by_length: [S; MOST],
        d: &[S; MOST],
    ) -> Shape<S> {
        let moved =
            |now: f64, by: &[S; MOST]| by.iter().zip(d).fold(S::from(now), |sum, (b, d)| sum + *b * *d);
        Shape { twist: moved(twist, &by_twist), by_twist, length: moved(length, &by_length), by_length }
    }

    /// Where a straight piece lies between both ends. The directors go from the tangent of one over the direction `D` of the piece
    /// to that of the other: that is twice the area of their triangle besides the smallest rotation between both.
    fn straight<S: Jet>(&self, at: &At<'_>, d: &[S; MOST]) -> Shape<S> {
        let zero = S::zero();
        let [[r1, p1], [r2, p2]] = [0, 1].map(|k| self.end(k, at, d));
        let chord = less(&r2, S::one(), &r1);
        let unit = |x: &V3<S>| {
            let size = along(x, x).sqrt();
            (x.map(|x| x / size), size)
        };
        let ((t1, n1), (t2, n2), (way, size)) = (unit(&p1), unit(&p2), unit(&chord));
        let c = along(&t1, &t2);
        let turn = cross(&t1, &t2);
        let volume = along(&way, &turn);
        let open = c + along(&t1, &way) + along(&way, &t2) + 1.0;
        let b = turn.map(|x| x / (c + 1.0));
        // derivative by a unit vector, from that of the volume and that of the opening
        let area = |volume_by: &V3<S>, open_by: [&V3<S>; 2], own: &V3<S>| -> V3<S> {
            let g: V3<S> = std::array::from_fn(|i| {
                (volume_by[i] - (open_by[0][i] + open_by[1][i]) * volume / open) * 4.0 / open
            });
            less(&g, along(&g, own), own)
        };
        let g1 = area(&cross(&t2, &way), [&way, &t2], &t1);
        let g2 = area(&cross(&way, &t1), [&way, &t1], &t2);
        let middle = area(&turn, [&t1, &t2], &way);
        let (mut by_twist, mut by_length) = ([zero; MOST], [zero; MOST]);
        for i in 0..3 {
            by_twist[i] = -(middle[i] / size);
            by_twist[SECOND + i] = middle[i] / size;
            by_twist[3 + i] = (b[i] + g1[i]) / n1;
            by_twist[SECOND + 3 + i] = (b[i] + g2[i]) / n2;
            by_length[i] = -way[i];
            by_length[SECOND + i] = way[i];
        }
        by_twist[6] = S::from(-1.0);
        by_twist[SECOND + 6] = S::one();
        let [m1, m2] = self.at().ends.map(|end| section(&at.q[end.end_q..]));
        let column = |m: &[V3<f64>; 3], c: usize| -> V3<f64> { [m[0][c], m[1][c], m[2][c]] };
        let now = between([&column(&m1, 2), &column(&m1, 0)], [&column(&m2, 2), &column(&m2, 0)]);
        let now = now + 4.0 * volume.re() / open.re();
        self.shape(self.counted(now, at), size.re(), by_twist, by_length, d)
    }

    fn shaped<S: Jet>(&self, at: &At<'_>, d: &[S; MOST]) -> Shape<S> {
        match Mode::of(at.internal, self.at().mode) {
            Mode::Wraps => self.wraps(at, d),
            Mode::Touches | Mode::Off => self.straight(at, d),
        }
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
        // what every term leaves out, as it sums up to nothing where the spins are balanced
        let still = Local { a: [0.0; MOST], ..x };
        let force = self.eval(at, &still).r;
        for (k, end) in self.at().ends.iter().enumerate() {
            let p: V3<f64> = std::array::from_fn(|i| at.q[end.end_q + 3 + i]);
            let square = dot(&p, &p);
            let by = 0.5 * w.q * force[SECOND * k + 6] / (square * square.sqrt());
            let first = SECOND * k + 3;
            for (i, j, c) in [(0, 1, 2), (1, 2, 0), (2, 0, 1)] {
                block[first + i][first + j] += by * p[c];
                block[first + j][first + i] -= by * p[c];
            }
        }
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
        let prefix =
            if self.sheave.grooves.len() == 1 { String::new() } else { format!("{}.", self.groove + 1) };
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
