//! Points held at their seats until they are pulled off.

mod spec;

pub use spec::{FloorSpec, LatchSpec};

use crate::gauss::gauss;
use ropewalk_core::held::{Held, Pull, delta, dofs, pull};
use ropewalk_core::rotation::M3;
use ropewalk_core::{
    Action, Assembly, At, Depends, Energy, Event, Foresees, Model, Pattern, Power, State, Term, V3, dot,
};

/// A plane that pushes back what has left its seat, [`Latch::floor`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Floor {
    /// A point of the plane [m].
    pub point: V3<f64>,
    /// Its normal, of length 1; what is behind the plane is pushed along it.
    pub normal: V3<f64>,
    /// Contact stiffness [N/m].
    pub stiffness: f64,
}

/// One point at its seat.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seat {
    /// The seat: fixed in space or on a rigid body. And the point that is held there.
    pub ends: [Held; 2],
    /// Place of its internal variable in [`State::internal`]: 0 while it is held, then the time of its release [s].
    pub variable: usize,
}

/// Many points, each held at a seat by a spring and damper, `F = -k (x - x_0) - c v`, until the force reaches a limit;
/// then it lets go for good.
///
/// From the moment of release the force fades within `fade` seconds by the quintic smooth step, so that it has two
/// continuous derivatives; error control takes no step over it. What is stored in the spring goes with it and counts as
/// dissipated. Use it for: a hose on its spool, a cable tied up with tape, a load that is dropped.
#[derive(Clone, Debug, PartialEq)]
pub struct Latch {
    /// A name, such as `reel`.
    pub label: String,
    /// Stiffness `k` [N/m].
    pub stiffness: f64,
    /// Damping `c` [N s/m].
    pub damping: f64,
    /// Force at which a seat lets go [N].
    pub hold: f64,
    /// Counts only the pull in this direction, of length 1; without one, the magnitude.
    pub direction: Option<V3<f64>>,
    /// Time in which the force fades [s].
    pub fade: f64,
    /// What pushes back released points.
    pub floor: Option<Floor>,
    /// The points.
    pub seats: Vec<Seat>,
}

/// The state of one seat.
struct Moment {
    /// Place and velocity of the point as seen from its seat.
    d: V3<f64>,
    w: V3<f64>,
    /// What is left of the hold, and its rate.
    left: f64,
    rate: f64,
}

impl Latch {
    /// Force on a point that is held in full [N].
    fn hold_force(&self, d: &V3<f64>, w: &V3<f64>) -> V3<f64> {
        std::array::from_fn(|i| -self.stiffness * d[i] - self.damping * w[i])
    }

    fn moment(&self, seat: &Seat, at: &At<'_>) -> Moment {
        let [x0, x1] = [seat.ends[0].x(at), seat.ends[1].x(at)];
        let [v0, v1] = [seat.ends[0].velocity(at), seat.ends[1].velocity(at)];
        let released = at.internal[seat.variable];
        let (left, rate) = if released == 0.0 { (1.0, 0.0) } else { self.left(at.t - released) };
        let minus = |a: V3<f64>, b: V3<f64>| std::array::from_fn(|i| a[i] - b[i]);
        Moment { d: minus(x1, x0), w: minus(v1, v0), left, rate }
    }

    /// What is left of a hold so long after its release, and its rate.
    fn left(&self, since: f64) -> (f64, f64) {
        let u = (since / self.fade).clamp(0.0, 1.0);
        let step = u * u * u * (10.0 + u * (6.0 * u - 15.0));
        (1.0 - step, -30.0 * u * u * (1.0 - u) * (1.0 - u) / self.fade)
    }

    /// The energy that a whole hold has more than the floor in its place, which goes as the hold fades; and its rate.
    fn at_stake(&self, seat: &Seat, at: &At<'_>) -> [f64; 2] {
        let (m, depth) = (self.moment(seat, at), self.depth(seat, at));
        let (spring, its_rate) = (self.stiffness * dot(&m.d, &m.d), self.stiffness * dot(&m.d, &m.w));
        let Some(floor) = self.floor.filter(|_| depth > 0.0) else { return [0.5 * spring, its_rate] };
        let deeper = -dot(&floor.normal, &seat.ends[1].velocity(at));
        [0.5 * (spring - floor.stiffness * depth * depth), its_rate - floor.stiffness * depth * deeper]
    }

    /// The energy that the fading of a hold takes between two states: what is at stake follows the cubic through its ends,
    /// and Gauss's rule of four points is exact for that times the rate of the fading.
    fn faded(&self, seat: &Seat, before: &At<'_>, after: &At<'_>) -> f64 {
        let released = after.internal[seat.variable];
        let [from, to] = [before.t.max(released), after.t.min(released + self.fade)];
        if released == 0.0 || !(from < to) {
            return 0.0;
        }
        let [[e0, r0], [e1, r1]] = [before, after].map(|at| self.at_stake(seat, at));
        let h = after.t - before.t;
        let pieces = gauss(4).iter().map(|&(x, weight)| {
            let t = from + x * (to - from);
            let (y, z) = ((t - before.t) / h, (after.t - t) / h);
            let stake =
                z * z * ((1.0 + 2.0 * y) * e0 + h * y * r0) + y * y * ((1.0 + 2.0 * z) * e1 - h * z * r1);
            -weight * (to - from) * self.left(t - released).1 * stake
        });
        pieces.sum()
    }

    /// How deep a point is behind the floor [m].
    fn depth(&self, seat: &Seat, at: &At<'_>) -> f64 {
        let Some(floor) = &self.floor else { return 0.0 };
        let x = seat.ends[1].x(at);
        let below: f64 = (0..3).map(|i| floor.normal[i] * (floor.point[i] - x[i])).sum();
        below.max(0.0)
    }

    /// The pull of a point on its seat that counts, in parts of the limit; `None` where it has let go.
    fn load(&self, seat: &Seat, at: &At<'_>) -> Option<f64> {
        if at.internal[seat.variable] != 0.0 {
            return None;
        }
        let m = self.moment(seat, at);
        let f = self.hold_force(&m.d, &m.w);
        let pull = match &self.direction {
            Some(direction) => -dot(direction, &f),
            None => dot(&f, &f).sqrt(),
        };
        Some(pull / self.hold)
    }
}

fn scaled(x: f64) -> M3 {
    std::array::from_fn(|i| std::array::from_fn(|j| x * delta(i, j)))
}

impl Term for Latch {
    fn label(&self) -> String {
        self.label.clone()
    }
    fn acts(&self) -> Option<&'static str> {
        Some("latch")
    }
    fn pattern(&self, p: &mut Pattern) {
        for seat in &self.seats {
            p.clique(dofs(&seat.ends));
        }
        if self.floor.is_some() {
            for seat in &self.seats {
                p.clique(seat.ends[1].dofs());
            }
        }
    }
    fn symmetric(&self) -> bool {
        // springs and dampers of points alone are; what turns with a body isn't
        self.seats.iter().all(|s| s.ends.iter().all(|e| !matches!(e, Held::Beside { .. })))
    }
    fn add(&self, at: &At<'_>, out: &mut Assembly<'_>) {
        for (k, seat) in self.seats.iter().enumerate() {
            let m = self.moment(seat, at);
            if m.left > 0.0 {
                let f = self.hold_force(&m.d, &m.w).map(|f| m.left * f);
                let (by_x, by_v) = (scaled(-m.left * self.stiffness), scaled(-m.left * self.damping));
                pull(&seat.ends, at, &Pull { f, by_x, by_v }, k, out);
            }
            let Some(floor) = &self.floor else { continue };
            let (depth, share) = (self.depth(seat, at), (1.0 - m.left) * floor.stiffness);
            if depth > 0.0 && share > 0.0 {
                let n = floor.normal;
                let force = Pull {
                    f: n.map(|n| share * depth * n),
                    by_x: std::array::from_fn(|i| std::array::from_fn(|j| -share * n[i] * n[j])),
                    ..Pull::default()
                };
                // the plane is fixed in space
                let ends = [Held::Ground(floor.point), seat.ends[1]];
                pull(&ends, at, &force, self.seats.len() + k, out);
            }
        }
    }
    fn energy(&self, at: &At<'_>) -> Energy {
        let stored = |seat: &Seat| {
            let m = self.moment(seat, at);
            let floor = self.floor.map_or(0.0, |f| f.stiffness * self.depth(seat, at).powi(2));
            0.5 * (m.left * self.stiffness * dot(&m.d, &m.d) + (1.0 - m.left) * floor)
        };
        Energy { potential: self.seats.iter().map(stored).sum(), ..Energy::default() }
    }
    fn power(&self, at: &At<'_>) -> Power {
        let lost = |seat: &Seat| {
            let m = self.moment(seat, at);
            m.left * self.damping * dot(&m.w, &m.w) - m.rate * self.at_stake(seat, at)[0]
        };
        Power { dissipated: self.seats.iter().map(lost).sum(), ..Power::default() }
    }
    fn foresees(&self) -> Option<&dyn Foresees> {
        Some(self)
    }
}

impl Foresees for Latch {
    fn step_limit(&self, at: &At<'_>) -> f64 {
        // what fades is not leapt over
        let fades = |s: &Seat| at.internal[s.variable] != 0.0 && at.t < at.internal[s.variable] + self.fade;
        if self.seats.iter().any(fades) { 0.25 * self.fade } else { f64::INFINITY }
    }
    fn missed(&self, before: &At<'_>, after: &At<'_>) -> Power {
        let fading = |s: &&Seat| {
            let released = after.internal[s.variable];
            released != 0.0 && before.t < released + self.fade
        };
        let missed = |s: &Seat| {
            let ends = [before, after].map(|at| -self.moment(s, at).rate * self.at_stake(s, at)[0]);
            self.faded(s, before, after) - 0.5 * (after.t - before.t) * (ends[0] + ends[1])
        };
        Power { dissipated: self.seats.iter().filter(fading).map(missed).sum(), ..Power::default() }
    }
}

/// The release of the points of a [`Latch`], one after the other.
struct Release {
    latch: Latch,
    /// Whether the run ends with the last one.
    stop: bool,
}

impl Event for Release {
    fn name(&self) -> String {
        self.latch.label.clone()
    }
    fn value(&self, _: &Model, state: &State) -> f64 {
        let at = state.at();
        let loads = self.latch.seats.iter().filter_map(|s| self.latch.load(s, &at));
        loads.fold(0.0, f64::max) - 1.0
    }
    fn direction(&self) -> i8 {
        1
    }
    fn depends(&self) -> Depends {
        Depends::OnStrains
    }
    fn act(&self, _: &Model, state: &mut State) -> Action {
        // the located time is right to rounding, and so is the load there
        let due: Vec<usize> = {
            let at = state.at();
            let over = |s: &&Seat| self.latch.load(s, &at).is_some_and(|load| load >= 1.0 - 1e-9);
            self.latch.seats.iter().filter(over).map(|s| s.variable).collect()
        };
        for variable in due {
            state.internal[variable] = state.t.max(f64::MIN_POSITIVE);
        }
        let all = self.latch.seats.iter().all(|s| state.internal[s.variable] != 0.0);
        if all && self.stop { Action::Stop } else { Action::Continue }
    }
}
