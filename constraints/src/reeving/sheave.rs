//! A wheel that cables run over, as a term of a model.

use super::arc::{Arc, End, Grip, Instant, Lay, Residual, Wheel};
use super::at_rest::{self, Sliding};
use super::hold::Mode;
use super::inline::{each, three, two};
use super::local::{Local, from};
use super::piece::Piece;
use super::seat::{Seat, turned};
use super::twist::Twist;
use num_dual::Dual64;
use ropewalk_core::rotation::{along, cross, times, transposed_times};
use ropewalk_core::{
    Assembly, At, Energy, Jet, MovingBoundary, Pattern, Power, Remembers, Residuals, Seeds, Shows, Signal,
    Solid, Term, Timed, V3, Weights, dot, tangent,
};

/// One cable on the wheel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Groove {
    /// Its numbers.
    pub arc: Arc,
    /// Unstretched length on the wheel where both material coordinates are 0 [m].
    pub stored: f64,
    /// The end of the span before, the start of the span behind.
    pub ends: [MovingBoundary; 2],
    /// Whether the axis of this cable is that of the wheel turned round.
    pub back: bool,
    /// Which way the cable goes at an equilibrium with friction: 1 to its start, -1 to its end.
    pub way: f64,
    /// Of several turns: the wrap at the start, and place of the internal variable by how much it differs since [rad].
    pub turns: Option<(f64, usize)>,
    /// Place of the internal variable with its [`Mode`].
    pub mode: usize,
    /// Of a cable with torsion.
    pub twist: Option<Twist>,
}

impl Groove {
    /// Of a cable that has this length on the wheel at the start.
    pub fn new(arc: Arc, stored: f64, ends: [MovingBoundary; 2], back: bool, mode: usize) -> Self {
        let stored = stored - ends[1].home + ends[0].home;
        Groove { arc, stored, ends, back, way: 0.0, turns: None, mode, twist: None }
    }

    /// Whether the cable turns about the axis of the wheel, 1, or about that turned round, -1.
    pub fn side(&self) -> f64 {
        if self.back { -1.0 } else { 1.0 }
    }

    /// Tension that the twist of a laid rope adds to that of its stretch [N]: that of the last state.
    pub fn pull(&self, at: &At<'_>) -> f64 {
        let [a, b] = self.ends.map(|end| at.q[end.q]);
        self.twist.map_or(0.0, |twist| twist.pull(b - a + self.stored, at))
    }

    /// The angle of a kink between both spans, as the cable turns about the axis of the wheel in space [rad].
    pub fn kink(&self, axis: &V3<f64>, at: &At<'_>) -> f64 {
        let [a, b]: [V3<f64>; 2] = self.ends.map(|end| std::array::from_fn(|i| at.q[end.end_q + 3 + i]));
        let flat = dot(&a, &b) - dot(axis, &a) * dot(axis, &b);
        let angle = dot(axis, &cross(&a, &b)).atan2(flat);
        angle * self.side()
    }
}

/// The angle of a wheel that doesn't just turn with its cable.
#[derive(Clone, Debug)]
pub(super) struct Angle {
    /// Place of the angle and of its rate.
    pub place: (usize, usize),
    /// Moment of inertia about the axis [kg m²].
    pub inertia: f64,
    /// Moment that drives it [N m].
    pub torque: Signal,
}

/// A wheel with the cables on it.
#[derive(Clone, Debug)]
pub(super) struct Sheave {
    pub name: String,
    pub seat: Seat,
    pub grooves: Vec<Groove>,
    pub angle: Option<Angle>,
    /// What friction does at equilibria, and place of the internal variable that says whether it does.
    pub at_rest: (Sliding, Option<usize>),
    pub solid: Solid,
}

/// Power with which material passes these ends of two spans into what lies between them [W]: its kinetic energy and that of
/// its weight, of which each span says that it is carried over its end.
pub(super) fn passes(ends: &[MovingBoundary; 2], gravity: &V3<f64>, at: &At<'_>) -> f64 {
    let leaves = |end: &MovingBoundary| {
        let (place, slope) = (&at.q[end.end_q..end.end_q + 3], &at.q[end.end_q + 3..end.end_q + 6]);
        let (rate, velocity) = (at.v[end.v], &at.v[end.end_v..end.end_v + 3]);
        let square: f64 = velocity.iter().zip(slope).map(|(v, s)| (v - s * rate).powi(2)).sum();
        let weight: f64 = place.iter().zip(gravity).map(|(x, g)| x * g).sum();
        end.rho_a * rate * (weight - 0.5 * square)
    };
    leaves(&ends[0]) - leaves(&ends[1])
}

/// Stiffness that keeps a free wheel in an equilibrium, as a share of `EA R`.
const STILL: f64 = 1e-9;

/// Most unknowns of a groove: two points, two material coordinates, a body, the angle of the wheel.
const MOST: usize = 15;

/// Where the ends of a cable and the wheel are, and how they move.
struct Posed<S> {
    ends: [End<S>; 2],
    wheel: Wheel<S>,
    /// Rotation matrix of what carries it, and its angular velocity in its own axes [rad/s].
    turn: [V3<S>; 3],
    omega: V3<S>,
    /// Angular velocity and acceleration of what carries it about the axis [rad/s, rad/s²].
    carried: [S; 2],
}

impl Sheave {
    /// The unknowns of a groove, in the order of [`Local`](super::local::Local).
    fn dofs(&self, groove: &Groove) -> Vec<usize> {
        let mut dofs = Vec::with_capacity(MOST);
        for end in &groove.ends {
            dofs.extend(end.end_v..end.end_v + 3);
            dofs.push(end.v);
        }
        dofs.extend(self.seat.on.into_iter().flat_map(|(_, v, _)| v..v + self.seat.size()));
        dofs.extend(self.angle.as_ref().map(|angle| angle.place.1));
        dofs
    }

    /// Where the ends of a groove and the wheel are, and how they move.
    #[inline(always)]
    fn posed<S: Jet>(&self, k: usize, at: &At<'_>, x: &Local<S, MOST>) -> Posed<S> {
        let groove = &self.grooves[k];
        let zero = [S::zero(); 3];
        let ends = two!(|end| {
            let (boundary, i) = (&groove.ends[end], 4 * end);
            End {
                r: [three!(|j| x.d[i + j] + at.q[boundary.end_q + j]), from(&x.v, i), from(&x.a, i)],
                p: [x.d[i + 3] + at.q[boundary.q], x.v[i + 3], x.a[i + 3]],
            }
        });
        let (arm, own) = (each!(self.seat.point, |x| S::from(x)), each!(self.seat.axis, |x| S::from(x)));
        let (mut turn, mut omega, mut alpha) = ([[S::zero(); 3]; 3], zero, zero);
        let (c, axis) = match self.seat.on {
            None => ([arm, zero, zero], own),
            Some((q, _, false)) => {
                let place = three!(|i| x.d[8 + i] + at.q[q + i]);
                ([place, from(&x.v, 8), from(&x.a, 8)], own)
            }
            Some((q, _, true)) => {
                turn = turned(at, q, &from(&x.d, 11));
                (omega, alpha) = (from(&x.v, 11), from(&x.a, 11));
                let (swings, spins) = (cross(&omega, &arm), cross(&alpha, &arm));
                let inwards = cross(&omega, &swings);
                let [out, swing] = [times(&turn, &arm), times(&turn, &swings)];
                let bend = times(&turn, &three!(|i| spins[i] + inwards[i]));
                let place = three!(|i| x.d[8 + i] + at.q[q + i] + out[i]);
                let velocity = three!(|i| x.v[8 + i] + swing[i]);
                let acceleration = three!(|i| x.a[8 + i] + bend[i]);
                ([place, velocity, acceleration], times(&turn, &own))
            }
        };
        let size = self.seat.size();
        let (carried, carried_rate) = (along(&omega, &own), along(&alpha, &own));
        let own_spin = if self.angle.is_some() { x.v[8 + size] } else { S::zero() };
        let side = groove.side();
        let wheel = Wheel {
            c,
            axis: each!(axis, |x| x * side),
            spin: (own_spin + carried) * side,
            carrier: carried * side,
        };
        Posed { ends, wheel, turn, omega, carried: [carried, carried_rate] }
    }

    /// Residual of a groove's unknowns, that of the wheel's own inertia with the first.
    #[inline(always)]
    fn eval<S: Jet>(
        &self,
        k: usize,
        at: &At<'_>,
        x: &Local<S, MOST>,
        stress: Option<f64>,
    ) -> ([S; MOST], Instant<S>) {
        let groove = &self.grooves[k];
        let Posed { ends, wheel, turn, omega, carried: [carried, carried_rate] } = self.posed(k, at, x);
        let [arm, own] = [each!(self.seat.point, |x| S::from(x)), each!(self.seat.axis, |x| S::from(x))];
        let size = self.seat.size();
        let side = groove.side();
        let arc = Arc { stress, ..self.arc(groove, at) };
        let (Residual { r, p, centre, groove: moment }, mut instant) =
            match Mode::of(at.internal, groove.mode) {
                Mode::Wraps => arc.eval(groove.stored, &ends, &wheel),
                // what the wheel does to it then, its constraint does
                Mode::Touches | Mode::Off => Piece { strand: groove.arc.strand, gravity: groove.arc.gravity }
                    .eval(groove.stored, &ends),
            };
        let mut out = [S::zero(); MOST];
        for end in 0..2 {
            out[4 * end..4 * end + 3].copy_from_slice(&r[end]);
            out[4 * end + 3] = p[end];
        }
        if size > 0 {
            out[8..11].copy_from_slice(&centre);
        }
        let mut about = moment * side;
        let mut body = [S::zero(); 3];
        if let Some(angle) = &self.angle {
            let (own_spin, own_rate) = (x.v[8 + size], x.a[8 + size]);
            let pressed = instant.tension - (instant.lift[0] + instant.lift[1]) * 0.5;
            let pressed = pressed * (instant.wrap * 0.5).sin() * 2.0;
            let resists = groove.arc.moment(own_spin, pressed);
            instant.dissipated += resists * own_spin;
            if k == 0 {
                let spin = own_spin + carried;
                about += (own_rate + carried_rate) * angle.inertia;
                let momentum = each!(own, |a| a * spin * angle.inertia);
                body = cross(&omega, &momentum);
                instant.energy[0] += spin * spin * (0.5 * angle.inertia);
                out[8 + size] -= angle.torque.at(at.t);
            }
            // where it turns slowly with its cable, its bearing takes what this leaves to it
            out[8 + size] += if arc.sliding == 0.0 { about + resists } else { S::zero() };
        }
        if size == 6 {
            let lever = cross(&arm, &transposed_times(&turn, &centre));
            for i in 0..3 {
                out[11 + i] = lever[i] + own[i] * about + body[i];
            }
        }
        (out, instant)
    }

    /// The numbers of a groove in this state.
    fn arc(&self, groove: &Groove, at: &At<'_>) -> Arc {
        let mut arc = groove.arc;
        arc.pull = groove.pull(at);
        let recalls = |place: usize| at.internal.get(place).copied().unwrap_or(0.0);
        arc.near = groove.turns.map(|(wrap, place)| wrap + recalls(place));
        if self.at_rest.1.is_some_and(|place| recalls(place) != 0.0) {
            arc.sliding = groove.way;
            if self.angle.is_some() {
                arc.grip = Grip::Turns(0.0);
            }
        }
        arc
    }

    /// Whether it has friction.
    pub fn rubs(&self) -> bool {
        self.grooves.iter().any(|g| match g.arc.grip {
            Grip::Slides(mu) => mu > 0.0,
            Grip::Turns(_) => g.arc.bearing[0] > 0.0 || g.arc.bearing[1] > 0.0,
        })
    }

    fn local(&self, groove: &Groove, at: &At<'_>) -> Local<f64, MOST> {
        Local::of(&self.dofs(groove), at)
    }

    /// How the cable lies in a groove that it wraps.
    pub fn lay(&self, k: usize, at: &At<'_>) -> (Lay<f64>, Wheel<f64>) {
        let groove = &self.grooves[k];
        let Posed { ends, wheel, .. } = self.posed(k, at, &self.local(groove, at));
        (self.arc(groove, at).lay(groove.stored, &ends, &wheel), wheel)
    }

    /// The tension that geometric stiffness takes in a search for equilibrium, linearised at the iterate before as that of the
    /// spans: what turns the end of one and that of the other has to be the same.
    fn stress(&self, k: usize, at: &At<'_>) -> Option<f64> {
        let groove = &self.grooves[k];
        let relaxed =
            at.relaxed.filter(|r| r.how.smooth && Mode::of(at.internal, groove.mode) == Mode::Wraps)?;
        let last = relaxed.last?;
        let mut d = [Dual64::from(0.0); MOST];
        for (d, dof) in d.iter_mut().zip(self.dofs(groove)) {
            *d = Dual64::new(-last[dof], last[dof]);
        }
        let Local { v, a, .. } = self.local(groove, at);
        let before = Local { d, v: v.map(Dual64::from), a: a.map(Dual64::from) };
        let Posed { ends, wheel, .. } = self.posed(k, at, &before);
        let tension = self.arc(groove, at).lay(groove.stored, &ends, &wheel).tension;
        Some(tension.re + tension.eps)
    }

    /// What there is to know of a groove now.
    pub fn instant(&self, k: usize, at: &At<'_>) -> Instant<f64> {
        let groove = &self.grooves[k];
        let mut now = self.eval(k, at, &self.local(groove, at), None).1;
        if Mode::of(at.internal, groove.mode) != Mode::Wraps {
            let pull = groove.pull(at);
            now.tension += pull;
            now.beside = now.beside.map(|x| x + pull);
        }
        if Mode::of(at.internal, groove.mode) == Mode::Touches {
            now.wrap = groove.kink(&self.seat.axis_now(at), at);
            // presses on the axle by the kink
            let inwards = cross(&self.seat.axis_now(at), &self.chord(groove, at));
            now.axle = inwards.map(|x| groove.side() * 2.0 * now.tension * (0.5 * now.wrap).sin() * x);
        }
        now
    }

    /// Direction from one end to the other.
    fn chord(&self, groove: &Groove, at: &At<'_>) -> V3<f64> {
        let [a, b] = groove.ends;
        let c: V3<f64> = std::array::from_fn(|i| at.q[b.end_q + i] - at.q[a.end_q + i]);
        let size = dot(&c, &c).sqrt();
        c.map(|x| x / size)
    }

    /// Where the middle between both ends of a groove is, as seen from the centre: along the axis, and how far from it [m].
    pub fn middle(&self, groove: &Groove, at: &At<'_>) -> [f64; 2] {
        let ([a, b], c, axis) = (groove.ends, self.seat.centre_now(at), self.seat.axis_now(at));
        let d: V3<f64> = std::array::from_fn(|i| 0.5 * (at.q[a.end_q + i] + at.q[b.end_q + i]) - c[i]);
        let beside = dot(&d, &axis);
        [beside, (dot(&d, &d) - beside * beside).sqrt()]
    }

    /// What the cable does to the axle besides, since it comes and goes by a fleet angle [N].
    pub fn aside(&self, groove: &Groove, at: &At<'_>, x: &Instant<f64>) -> V3<f64> {
        let (axis, mut sum) = (self.seat.axis_now(at), [0.0; 3]);
        // what is off its groove isn't turned into it
        if Mode::of(at.internal, groove.mode) != Mode::Wraps {
            return sum;
        }
        for (end, boundary) in groove.ends.iter().enumerate() {
            let q = boundary.end_q + 3;
            let slope: V3<f64> = std::array::from_fn(|i| at.q[q + i]);
            let [beside, size] = [dot(&axis, &slope), dot(&slope, &slope).sqrt()];
            let flat: V3<f64> = std::array::from_fn(|i| slope[i] - axis[i] * beside);
            let straight = dot(&flat, &flat).sqrt();
            let pull = x.beside[end] - groove.arc.strand.mass * size * at.v[boundary.v].powi(2);
            (0..3).for_each(|i| sum[i] -= boundary.sign * pull * (slope[i] / size - flat[i] / straight));
        }
        sum
    }

    /// Speed of the groove at its bottom, as the cable runs [m/s].
    pub fn rim(&self, groove: &Groove, at: &At<'_>) -> f64 {
        let carried = match self.seat.on {
            Some((_, v, true)) => (0..3).map(|i| at.v[v + 3 + i] * self.seat.axis[i]).sum(),
            _ => 0.0,
        };
        let own = self.angle.as_ref().map_or(0.0, |angle| at.v[angle.place.1]);
        (own + carried) * groove.arc.radius * groove.side()
    }
}

/// A groove of a sheave at an instant.
struct On<'a> {
    sheave: &'a Sheave,
    k: usize,
    at: &'a At<'a>,
    x: &'a Local<f64, MOST>,
    w: Weights,
    stress: Option<f64>,
}

impl Residuals<MOST> for On<'_> {
    #[inline(always)]
    fn eval<S: Jet>(&self, seeds: &impl Seeds<S>) -> [S; MOST] {
        self.sheave.eval(self.k, self.at, &self.x.along(self.w, seeds), self.stress).0
    }
}

impl Term for Sheave {
    fn label(&self) -> String {
        self.name.clone()
    }
    fn pattern(&self, p: &mut Pattern) {
        for groove in &self.grooves {
            p.clique(self.dofs(groove));
        }
    }
    fn symmetric(&self) -> bool {
        false
    }
    fn add(&self, at: &At<'_>, out: &mut Assembly<'_>) {
        let w = out.weights();
        for (k, groove) in self.grooves.iter().enumerate() {
            let (dofs, x) = (self.dofs(groove), self.local(groove, at));
            let (residual, _) = self.eval(k, at, &x, None);
            for (dof, r) in dofs.iter().zip(residual) {
                out.add(*dof, r);
            }
            if !out.wants_tangent() {
                continue;
            }
            let mut block = [[0.0; MOST]; MOST];
            let stress = self.stress(k, at);
            tangent(&On { sheave: self, k, at, x: &x, w, stress }, dofs.len(), &mut block);
            // in an equilibrium nothing turns a wheel: a share of the stiffness of its arc keeps the angle where it is
            if let Some(i) = self.angle.as_ref().map(|_| dofs.len() - 1).filter(|_| w.v == 0.0 && w.a == 0.0)
            {
                let arc = &groove.arc;
                block[i][i] += w.q * STILL * arc.strand.ea * arc.radius;
            }
            out.add_square(k, &block);
        }
    }
    fn energy(&self, at: &At<'_>) -> Energy {
        let mut sum = Energy::default();
        for k in 0..self.grooves.len() {
            let [kinetic, potential] = self.instant(k, at).energy;
            sum += Energy { kinetic, potential };
        }
        sum
    }
    fn power(&self, at: &At<'_>) -> Power {
        let dissipated = (0..self.grooves.len()).map(|k| self.instant(k, at).dissipated).sum();
        let supplied = self.angle.as_ref().map_or(0.0, |a| a.torque.at(at.t) * at.v[a.place.1]);
        // what leaves a span is on the wheel, whose energy counts: nothing comes from outside or goes there
        let carried = self.grooves.iter().map(|g| passes(&g.ends, &g.arc.gravity, at)).sum();
        Power { dissipated, supplied, carried }
    }
    fn timed(&self) -> Option<&dyn Timed> {
        let driven = self.angle.as_ref().is_some_and(|angle| !angle.torque.is_constant());
        if driven { Some(self) } else { None }
    }
    fn remembers(&self) -> Option<&dyn Remembers> {
        let turns = self.grooves.iter().any(|g| g.turns.is_some());
        if turns || self.rubs() { Some(self) } else { None }
    }
    fn shows(&self) -> Option<&dyn Shows> {
        Some(self)
    }
}

impl Remembers for Sheave {
    fn remember(&self, at: &At<'_>, memory: &mut [f64]) {
        for (k, groove) in self.grooves.iter().enumerate() {
            let Some((wrap, place)) = groove.turns else { continue };
            let at = At { internal: memory, ..*at };
            let now = self.instant(k, &at).wrap;
            if let Some(x) = memory.get_mut(place) {
                *x = now - wrap;
            }
        }
        at_rest::set(self.at_rest.1, memory, 0.0);
    }
    fn rests(&self) -> bool {
        self.at_rest.1.is_some() || !self.rubs()
    }
    fn sliding(&self) -> Option<&'static str> {
        self.at_rest.0.name()
    }
    fn settle(&self, at: &At<'_>, memory: &mut [f64]) -> bool {
        let before = self.at_rest.1.and_then(|place| memory.get(place)).is_some_and(|x| *x != 0.0);
        self.remember(at, memory);
        at_rest::set(self.at_rest.1, memory, 1.0) && !before
    }
}

impl Timed for Sheave {
    fn reach(&self, t: f64, h: f64) -> Option<f64> {
        self.angle.as_ref().map_or(Some(h), |angle| Some(angle.torque.reach(t, h)))
    }
}
