//! Vortex-induced vibration of slender bodies: a wake that oscillates behind each station.

mod spec;
mod wake;

pub use spec::VortexSheddingSpec;
pub use wake::WakeOscillator;

use crate::Surface;
use crate::drag::velocity;
use ropewalk_core::rotation::cross;
use ropewalk_core::{
    Assembly, At, Column, Foresees, Gives, Load, Pattern, Power, Remembers, Shows, Station, Stations, Term,
    Timed, V3, dot, scaled,
};
use ropewalk_scene::{Current, Sea};
use std::f64::consts::TAU;
use std::sync::Arc;

/// How many numbers a station remembers.
pub(crate) const MEMORY: usize = 19;
/// Over how many periods of shedding the velocity of a station counts as its way through the water; what it does faster is
/// vibration.
const PERIODS: f64 = 5.0;
/// How many steps a period of shedding has at least.
const STEPS: f64 = 16.0;
/// Growth of the drag coefficient with the amplitude over the diameter (Blevins, *Flow-Induced Vibration*, 2nd ed., 1990).
const STRUMMING: f64 = 2.1;
/// What wakes begin with: enough to grow from.
const NOISE: f64 = 0.02;

/// Lift of vortices on a slender body, and the growth of its drag as it strums.
///
/// Each station has a wake of its own, which it remembers: within a step the lift is that of the wake as it goes on by itself,
/// and with each step that is accepted the wake follows the acceleration that the station had. So the lift depends on time alone
/// in a step. The flow is that of the water past the station's mean way, over five periods of shedding.
pub struct VortexShedding {
    part: String,
    stations: Arc<dyn Stations>,
    /// Where its memory begins, and how many stations share it.
    memory: usize,
    count: usize,
    fluid: Fluid,
    wake: WakeOscillator,
    /// Drag coefficient across at rest, if drag grows with the vibration.
    strumming: Option<f64>,
}

/// What flows past.
pub(crate) struct Fluid {
    pub density: f64,
    pub current: Current,
    pub sea: Option<Arc<Sea>>,
    pub surface: Option<Surface>,
}

/// What a station remembers of its wake, from the latest accepted step.
#[derive(Clone, Copy, Debug, Default)]
struct Wake {
    /// 0 before its first step.
    begun: f64,
    /// When that was [s].
    t: f64,
    /// The oscillator and its rate.
    q: [f64; 2],
    /// Acceleration across over the diameter, and its rate.
    drive: [f64; 2],
    /// Mean velocity [m/s].
    way: V3<f64>,
    /// Mean squares of velocity and acceleration across.
    square: [f64; 2],
    /// Frequency of shedding [rad/s].
    omega: f64,
    /// Direction across, and lift for `q = 1` along it [N/m].
    across: V3<f64>,
    lift: f64,
    /// What strumming adds to drag [N/m].
    drag: V3<f64>,
}

impl Wake {
    fn read(m: &[f64]) -> Self {
        Wake {
            begun: m[0],
            t: m[1],
            q: [m[2], m[3]],
            drive: [m[4], m[5]],
            way: [m[6], m[7], m[8]],
            square: [m[9], m[10]],
            omega: m[11],
            across: [m[12], m[13], m[14]],
            lift: m[15],
            drag: [m[16], m[17], m[18]],
        }
    }
    fn write(&self, m: &mut [f64]) {
        let [q, drive, square] = [self.q, self.drive, self.square];
        let head = [self.begun, self.t, q[0], q[1], drive[0], drive[1]];
        let all = head.into_iter().chain(self.way).chain(square).chain([self.omega]);
        let all = all.chain(self.across).chain([self.lift]).chain(self.drag);
        m.iter_mut().zip(all).for_each(|(m, x)| *m = x);
    }

    /// Amplitude of the vibration across [m], as of a harmonic one.
    fn amplitude(&self) -> f64 {
        let [v, a] = self.square;
        if a > 0.0 { std::f64::consts::SQRT_2 * v / a.sqrt() } else { 0.0 }
    }
}

/// A number from -1 to 1 that belongs to a station.
fn noise(k: usize) -> f64 {
    let mut x = (k as u64 + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    x = (x ^ (x >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    2.0 * (((x ^ (x >> 31)) >> 11) as f64 * f64::exp2(-53.0)) - 1.0
}

impl VortexShedding {
    pub(crate) fn new(
        part: &str,
        stations: Arc<dyn Stations>,
        [memory, count]: [usize; 2],
        fluid: Fluid,
        wake: WakeOscillator,
        strumming: Option<f64>,
    ) -> Self {
        VortexShedding { part: part.into(), stations, memory, count, fluid, wake, strumming }
    }

    /// The memories of all stations.
    fn wakes<'a>(&self, memory: &'a [f64]) -> impl Iterator<Item = Wake> + use<'a> {
        let own = memory.get(self.memory..self.memory + MEMORY * self.count).unwrap_or_default();
        own.chunks_exact(MEMORY).map(Wake::read)
    }

    /// Force per length on a station with this wake.
    fn force(&self, wake: &Wake, t: f64) -> V3<f64> {
        if wake.begun == 0.0 {
            return [0.0; 3];
        }
        let [q, _] = self.wake.after(t - wake.t, wake.q, wake.omega, wake.drive);
        std::array::from_fn(|i| wake.lift * q * wake.across[i] + wake.drag[i])
    }

    /// Sees each station with the force on it.
    fn each(&self, at: &At<'_>, mut see: impl FnMut(&Station<f64>, V3<f64>)) {
        let mut wakes = self.wakes(at.internal);
        self.stations.each(at, &mut |station| {
            if let Some(wake) = wakes.next() {
                see(station, self.force(&wake, at.t));
            }
        });
    }

    /// What a station remembers after a step, from what it remembered before.
    fn follow(&self, before: &Wake, number: usize, t: f64, at: &Station<f64>) -> Wake {
        let mut now = *before;
        let swell = self.fluid.sea.as_ref().map(|sea| sea.along(t, at));
        let u = velocity(&self.fluid.current, swell.as_ref(), &at.x);
        let inverse = dot(&at.slope, &at.slope).sqrt().recip();
        let tangent = scaled(inverse, &at.slope);
        let across = |v: &V3<f64>| -> V3<f64> {
            let along = dot(v, &tangent);
            std::array::from_fn(|i| v[i] - along * tangent[i])
        };
        let minus = |a: &V3<f64>, b: &V3<f64>| -> V3<f64> { std::array::from_fn(|i| a[i] - b[i]) };
        let size = |v: &V3<f64>| dot(v, v).sqrt();
        let dt = t - before.t;
        if before.begun == 0.0 {
            now.begun = 1.0;
            now.way = at.v;
            now.q = [NOISE * noise(number), 0.0];
        } else {
            // the mean forgets by the periods of shedding that have gone by
            let speed = size(&across(&minus(&u, &at.v)));
            let gone = dt * self.wake.omega(speed, at.diameter) / (TAU * PERIODS);
            let share = -(-gone).exp_m1();
            (0..3).for_each(|i| now.way[i] += share * (at.v[i] - now.way[i]));
            let fast = dot(&minus(&at.v, &now.way), &before.across);
            let pushed = dot(&at.a, &before.across);
            for (mean, x) in now.square.iter_mut().zip([fast, pushed]) {
                *mean += share * (x * x - *mean);
            }
        }
        let flow = across(&minus(&u, &now.way));
        let speed = size(&flow);
        now.omega = self.wake.omega(speed, at.diameter);
        if before.begun != 0.0 && dt > 0.0 {
            let arrived = dot(&at.a, &before.across) / at.diameter;
            let rise = (arrived - before.drive[0]) / dt;
            let omega = 0.5 * (before.omega + now.omega);
            now.q = self.wake.after(dt, before.q, omega, [before.drive[0], rise]);
            now.drive[1] = rise;
        }
        now.t = t;
        let wet = self.fluid.surface.as_ref().map_or(1.0, |surface| {
            let top = surface.top(t, at);
            surface.wet(at, top.as_ref()).share
        });
        if speed > 0.0 {
            now.across = scaled(1.0 / speed, &cross(&tangent, &flow));
        }
        let pressure = 0.5 * self.fluid.density * at.diameter * wet;
        now.lift = pressure * speed * speed * 0.5 * self.wake.lift;
        now.drive[0] = dot(&at.a, &now.across) / at.diameter;
        let grown = self.strumming.map_or(0.0, |cn| STRUMMING * cn * now.amplitude() / at.diameter);
        now.drag = scaled(pressure * grown * speed, &flow);
        now
    }
}

impl Term for VortexShedding {
    fn label(&self) -> String {
        format!("{}: vortex shedding", self.part)
    }
    fn pattern(&self, p: &mut Pattern) {
        self.stations.pattern(p);
    }
    fn symmetric(&self) -> bool {
        self.stations.fixed()
    }
    fn acts(&self) -> Option<&'static str> {
        Some("vortices")
    }
    fn add(&self, at: &At<'_>, out: &mut Assembly<'_>) {
        let mut loads = Vec::new();
        self.each(at, |_, f| loads.push(Load { f, ..Load::zero() }));
        self.stations.spread(&loads, Gives::NOTHING, at, out);
    }
    fn power(&self, at: &At<'_>) -> Power {
        let mut supplied = 0.0;
        self.each(at, |station, f| supplied += station.weight * dot(&f, &station.v));
        Power { supplied, ..Power::default() }
    }
    fn timed(&self) -> Option<&dyn Timed> {
        Some(self)
    }
    fn foresees(&self) -> Option<&dyn Foresees> {
        Some(self)
    }
    fn remembers(&self) -> Option<&dyn Remembers> {
        Some(self)
    }
    fn shows(&self) -> Option<&dyn Shows> {
        Some(self)
    }
}

impl Timed for VortexShedding {
    // what it has ahead is known to `step_limit`
    fn reach(&self, _t: f64, h: f64) -> Option<f64> {
        Some(h)
    }
}

impl Foresees for VortexShedding {
    fn step_limit(&self, at: &At<'_>) -> f64 {
        let fastest = self.wakes(at.internal).map(|wake| wake.omega).fold(0.0, f64::max);
        if fastest > 0.0 { TAU / (STEPS * fastest) } else { f64::INFINITY }
    }
}

impl Remembers for VortexShedding {
    /// Wakes of what is at rest don't swing.
    fn rests(&self) -> bool {
        true
    }
    fn remember(&self, at: &At<'_>, memory: &mut [f64]) {
        let Some(own) = memory.get_mut(self.memory..) else { return };
        let mut own = own.chunks_exact_mut(MEMORY).enumerate();
        self.stations.each(at, &mut |station| {
            if let Some((k, m)) = own.next() {
                self.follow(&Wake::read(m), k, at.t, station).write(m);
            }
        });
    }
}

impl Shows for VortexShedding {
    fn columns(&self) -> Vec<Column> {
        vec![Column::new("q", "1"), Column::new("amplitude", "m"), Column::new("frequency", "Hz")]
    }
    fn observe(&self, at: &At<'_>, out: &mut Vec<f64>) {
        let mut most = [0.0_f64; 3];
        let mut wakes = self.wakes(at.internal);
        self.stations.each(at, &mut |_| {
            if let Some(wake) = wakes.next() {
                let q = self.wake.after(at.t - wake.t, wake.q, wake.omega, wake.drive)[0];
                for (most, x) in most.iter_mut().zip([q.abs(), wake.amplitude(), wake.omega / TAU]) {
                    *most = most.max(x);
                }
            }
        });
        out.extend(most);
    }
}
