//! Elevation and motion of the water in linear waves.

use crate::dispersion::{wavenumber, wavenumber_on_current};
use crate::error::{SeaError, finite, positive};
use crate::motion::{Motion, Top};
use ropewalk_core::Real;
use std::f64::consts::{PI, TAU};

/// A regular wave: `η = a cos(k (x cos β + y sin β) - ω t + φ)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Regular {
    /// Amplitude `a`, half of its height [m].
    pub amplitude: f64,
    /// Angular frequency `ω` [rad/s].
    pub omega: f64,
    /// Phase `φ` at the origin at `t = 0` [rad]: 0 is a crest.
    pub phase: f64,
    /// Direction `β` that it travels towards, from x to y [rad].
    pub direction: f64,
}

/// What linear theory, which ends at still water, is taken to say between there and the surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Stretching {
    /// The column of water is stretched or compressed to the surface: `z' = (z - η)/(1 + η/h)` (Wheeler, 1970).
    #[default]
    Wheeler,
    /// Above still water the motion is that at still water.
    Constant,
    /// The formulas as they are, also above still water: short waves grow without bound in crests. For verification.
    None,
}

/// The motion of the water at a place and a time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Flow {
    /// Elevation `η` of the surface above still water there [m].
    pub elevation: f64,
    /// `∂η/∂x` and `∂η/∂y`.
    pub slope: [f64; 2],
    /// `∂η/∂t` [m/s].
    pub rising: f64,
    /// Velocity [m/s].
    pub velocity: [f64; 3],
    /// `∂u/∂t` [m/s²]; of waves on a current as one sees it who drifts with it.
    pub acceleration: [f64; 3],
    /// What the velocity changes by with time at a fixed place [m/s²]: other than the acceleration, it counts how the column is
    /// stretched as the surface rises.
    pub rate: [f64; 3],
    /// `∂u_i/∂x_j` [1/s], stretching included.
    pub gradient: [[f64; 3]; 3],
    /// What the acceleration changes by from place to place [1/s²], stretching included.
    pub acceleration_gradient: [[f64; 3]; 3],
    /// Pressure by the waves over the density of water [m²/s²].
    pub pressure: f64,
}

/// One wave, ready for sums.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Component {
    /// Amplitude [m].
    pub a: f64,
    /// Frequency that an observer at rest sees [rad/s].
    pub omega: f64,
    /// Frequency in water at rest [rad/s].
    pub sigma: f64,
    /// Wavenumber [1/m].
    pub k: f64,
    pub phase: f64,
    /// Direction.
    pub way: [f64; 2],
}

/// Waves on water of constant depth, as many as there are.
#[derive(Clone, Debug)]
pub struct Waves {
    pub(crate) all: Vec<Component>,
    pub(crate) depth: f64,
    g: f64,
    pub(crate) stretching: Stretching,
    /// Time in which they rise from nothing [s].
    ramp: f64,
    /// The current that carries them [m/s].
    pub(crate) current: [f64; 2],
}

/// Up to so many waves are looked at one by one.
const FEW: usize = 8;

/// The least share of the depth that is taken to be left under a trough.
const DRY: f64 = 0.05;

impl Waves {
    /// Waves on water of this depth [m], which may be infinite, under gravity `g` [m/s²].
    ///
    /// # Errors
    /// A frequency, depth or gravity that isn't above zero, numbers that aren't finite.
    pub fn new(waves: &[Regular], depth: f64, g: f64, stretching: Stretching) -> Result<Self, SeaError> {
        if !(depth > 0.0) {
            return Err(SeaError::new("depth", format!("`depth` must be above 0, not {depth}")));
        }
        positive("gravity", g)?;
        let component = |w: &Regular| {
            finite("amplitude", w.amplitude)?;
            positive("omega", w.omega)?;
            finite("phase", w.phase)?;
            finite("direction", w.direction)?;
            let (sin, cos) = w.direction.sin_cos();
            let k = wavenumber(w.omega, depth, g);
            Ok(Component {
                a: w.amplitude,
                omega: w.omega,
                sigma: w.omega,
                k,
                phase: w.phase,
                way: [cos, sin],
            })
        };
        let all = waves.iter().map(component).collect::<Result<_, _>>()?;
        Ok(Waves { all, depth, g, stretching, ramp: 0.0, current: [0.0; 2] })
    }

    /// Lets them rise from nothing in a time [s].
    ///
    /// # Errors
    /// A negative time.
    pub fn with_ramp(mut self, ramp: f64) -> Result<Self, SeaError> {
        if !(ramp.is_finite() && ramp >= 0.0) {
            return Err(SeaError::new("ramp", format!("`ramp` must not be negative, and is {ramp}")));
        }
        self.ramp = ramp;
        Ok(self)
    }

    /// Lets a uniform current [m/s] carry them: frequencies stay those that an observer at rest sees, lengths change.
    ///
    /// # Errors
    /// An opposing current that is too fast for one of them.
    pub fn on_current(mut self, current: [f64; 2]) -> Result<Self, SeaError> {
        for c in &mut self.all {
            let along = current[0] * c.way[0] + current[1] * c.way[1];
            let k = wavenumber_on_current(c.omega, self.depth, self.g, along).ok_or_else(|| {
                let message = format!(
                    "waves of {:.3} s can't advance against a current of {:.3} m/s: take slower current or longer waves",
                    2.0 * PI / c.omega,
                    -along
                );
                SeaError::new("doppler", message)
            })?;
            (c.k, c.sigma) = (k, c.omega - k * along);
        }
        self.current = current;
        Ok(self)
    }

    /// Depth of the water [m].
    pub fn depth(&self) -> f64 {
        self.depth
    }
    /// Time in which they rise from nothing [s].
    pub fn ramp(&self) -> f64 {
        self.ramp
    }
    /// Number of waves.
    pub fn len(&self) -> usize {
        self.all.len()
    }
    /// Whether the sea is still.
    pub fn is_empty(&self) -> bool {
        self.all.is_empty()
    }
    /// Its waves, each as amplitude [m], wavenumbers along x and y [1/m], frequency [rad/s] and phase at the origin at `t = 0`
    /// [rad].
    pub fn iter(&self) -> impl Iterator<Item = (f64, [f64; 2], f64, f64)> + '_ {
        self.all.iter().map(|c| (c.a, c.way.map(|w| c.k * w), c.omega, c.phase))
    }
    /// Largest wavenumber [1/m].
    pub fn shortest(&self) -> f64 {
        self.all.iter().fold(0.0, |m, c| c.k.max(m))
    }
    /// Highest frequency that an observer at rest sees [rad/s].
    pub fn fastest(&self) -> f64 {
        self.all.iter().fold(0.0, |m, c| c.omega.max(m))
    }
    /// Mean period between waves that rise through the still level once they have risen [s], `2π √(m₀/m₂)`.
    pub fn period(&self) -> f64 {
        let moment = |of: fn(f64) -> f64| self.all.iter().map(|c| of(c.omega) * c.a * c.a).sum::<f64>();
        TAU * (moment(|_| 1.0) / moment(|omega| omega * omega)).sqrt()
    }
    /// Standard deviation of the elevation once they have risen [m].
    pub fn deviation(&self) -> f64 {
        self.all.iter().map(|c| 0.5 * c.a * c.a).sum::<f64>().sqrt()
    }
    /// Height that single waves reach [m]: the sum of a few, the significant height of many.
    pub fn height(&self) -> f64 {
        let sum: f64 = self.all.iter().map(|c| 2.0 * c.a.abs()).sum();
        if self.all.len() <= FEW { sum } else { sum.min(4.0 * self.deviation()) }
    }
    /// The wavenumber that halves their energy [1/m]; 0 of no waves.
    pub fn median(&self) -> f64 {
        let mut all: Vec<(f64, f64)> = self.all.iter().map(|c| (c.k, c.a * c.a)).collect();
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        let half = 0.5 * all.iter().map(|(_, energy)| energy).sum::<f64>();
        let mut sum = 0.0;
        let median = all.iter().find(|(_, energy)| {
            sum += energy;
            sum >= half
        });
        median.map_or(0.0, |(k, _)| *k)
    }
    /// The height at which waves of their length break, by Miche (1944): `0.142 λ tanh kh` [m].
    pub fn breaking_height(&self) -> f64 {
        let k = self.median();
        if k > 0.0 { 0.142 * 2.0 * PI / k * (k * self.depth).tanh() } else { f64::INFINITY }
    }
    /// The direction of all of them, if they have one.
    pub(crate) fn way(&self) -> Option<[f64; 2]> {
        let first = self.all.first()?.way;
        self.all.iter().all(|c| c.way == first).then_some(first)
    }

    /// How far they have risen, and how fast they do [1/s].
    pub(crate) fn risen(&self, t: f64) -> [f64; 2] {
        if t >= self.ramp {
            return [1.0, 0.0];
        }
        if t <= 0.0 {
            return [0.0, 0.0];
        }
        let u = PI * t / self.ramp;
        [0.5 * (1.0 - u.cos()), 0.5 * PI / self.ramp * u.sin()]
    }

    /// Elevation above still water [m], and its slopes.
    pub fn elevation(&self, x: f64, y: f64, t: f64) -> (f64, [f64; 2]) {
        let surface = self.surface(x, y, t);
        (surface.elevation, surface.slope)
    }

    /// The surface above a place.
    fn surface(&self, x: f64, y: f64, t: f64) -> Top<f64> {
        let [risen, rising] = self.risen(t);
        let (mut eta, mut slope, mut rate) = (0.0, [0.0; 2], 0.0);
        for c in &self.all {
            let (sin, cos) = c.angle(x, y, t).sin_cos();
            eta += c.a * cos;
            rate += c.a * c.omega * sin;
            let steep = -c.a * c.k * sin;
            slope[0] += steep * c.way[0];
            slope[1] += steep * c.way[1];
        }
        Top { elevation: risen * eta, slope: slope.map(|s| risen * s), rising: risen * rate + rising * eta }
    }

    /// The height at which linear theory is asked for what happens at `z` [m], and its derivatives by `z` and by the
    /// elevation.
    #[inline(always)]
    pub(crate) fn stretched<R: Real>(&self, z: R, eta: R) -> [R; 3] {
        let (zero, one) = (R::zero(), R::of(1.0));
        match self.stretching {
            Stretching::None => [z, one, zero],
            Stretching::Constant => [z.if_gt(zero, zero, z), z.if_gt(zero, zero, one), zero],
            Stretching::Wheeler if self.depth.is_infinite() => [z - eta, one, -one],
            Stretching::Wheeler => {
                let (share, dry) = (one + eta * R::of(1.0 / self.depth), R::of(DRY));
                let s = one / share.if_gt(dry, share, dry);
                let up = (z - eta) * s;
                [up, s, -s * (one + up * R::of(1.0 / self.depth))]
            }
        }
    }

    /// The motion of the water at a place, which should be in it, and a time: the sum over all waves.
    pub fn at(&self, [x, y, z]: [f64; 3], t: f64) -> Flow {
        let (top, mut motion, mut pressure) = (self.surface(x, y, t), Motion::<f64, 3>::still(), 0.0);
        let [up, by_z, by_eta] = self.stretched(z, top.elevation);
        for c in &self.all {
            let (sin, cos) = c.angle(x, y, t).sin_cos();
            let [ch, sh, p] = c.depths(up, self.depth);
            let (u, w) = (c.a * c.sigma * ch, c.a * c.sigma * sh);
            let [cx, cy] = c.way;
            motion.velocity[0] += u * cos * cx;
            motion.velocity[1] += u * cos * cy;
            motion.velocity[2] += w * sin;
            motion.acceleration[0] += u * c.sigma * sin * cx;
            motion.acceleration[1] += u * c.sigma * sin * cy;
            motion.acceleration[2] -= w * c.sigma * cos;
            pressure += self.g * c.a * p * cos;
            add_gradient(&mut motion.gradient, c.way, -u * c.k * sin, w * c.k * cos);
            let k = c.k * c.sigma;
            add_gradient(&mut motion.acceleration_gradient, c.way, u * k * cos, w * k * sin);
        }
        let (risen, [cx, cy]) = (self.risen(t), self.current);
        let [sx, sy] = top.slope;
        motion.stretch([by_z, by_eta], [sx, sy, 0.0], top.rising, [cx, cy, 0.0]);
        motion.rise(risen);
        Flow::of(top, motion, risen[0] * pressure)
    }
}

/// Adds the gradient of a field without sources and vortices, of which it is known how the part along a direction changes
/// along it and upwards.
fn add_gradient(g: &mut [[f64; 3]; 3], [cx, cy]: [f64; 2], along: f64, up: f64) {
    let rows = [
        [along * cx * cx, along * cx * cy, up * cx],
        [along * cx * cy, along * cy * cy, up * cy],
        [up * cx, up * cy, -along],
    ];
    for (row, more) in g.iter_mut().zip(rows) {
        row.iter_mut().zip(more).for_each(|(x, more)| *x += more);
    }
}

impl Flow {
    pub(crate) fn of(top: Top<f64>, motion: Motion<f64, 3>, pressure: f64) -> Self {
        let (Top { elevation, slope, rising }, Motion { velocity, acceleration, rate, .. }) = (top, motion);
        let Motion { gradient, acceleration_gradient, .. } = motion;
        Flow {
            elevation,
            slope,
            rising,
            velocity,
            acceleration,
            rate,
            gradient,
            acceleration_gradient,
            pressure,
        }
    }

    /// The surface above the place.
    pub fn top(&self) -> Top<f64> {
        Top { elevation: self.elevation, slope: self.slope, rising: self.rising }
    }

    /// The motion of the water there.
    pub fn motion(&self) -> Motion<f64, 3> {
        Motion {
            velocity: self.velocity,
            acceleration: self.acceleration,
            rate: self.rate,
            gradient: self.gradient,
            acceleration_gradient: self.acceleration_gradient,
        }
    }
}

impl Component {
    pub fn angle(&self, x: f64, y: f64, t: f64) -> f64 {
        self.k * (x * self.way[0] + y * self.way[1]) - self.omega * t + self.phase
    }

    /// `cosh k(z + h)/sinh kh`, `sinh k(z + h)/sinh kh` and `cosh k(z + h)/cosh kh`, without overflow at any depth.
    pub fn depths(&self, z: f64, depth: f64) -> [f64; 3] {
        let down = (self.k * z).exp();
        if depth.is_infinite() {
            return [down; 3];
        }
        // 1 - exp(-2k(z + h)) and 1 - exp(-2kh), also where both are nearly nothing
        let (here, whole) = (-(-2.0 * self.k * (z + depth)).exp_m1(), -(-2.0 * self.k * depth).exp_m1());
        [down * (2.0 - here) / whole, down * here / whole, down * (2.0 - here) / (2.0 - whole)]
    }
}
