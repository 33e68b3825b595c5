//! The motion of the water in waves, as drag, inertia and buoyancy ask for it.

mod memory;
mod swell;

use crate::waves::{Evaluation, WavesSpec};
use memory::{Found, Key, MOST, Memory, Places, key_of};
use ropewalk_core::{BuildError, LaneTask, Real, Station, V3, Width, reach, run};
use ropewalk_sea::{Axes, Lattice, SplitMix64, Stations, Top, Waves};
use std::f64::consts::TAU;
use std::fmt;
use std::sync::Arc;
pub use swell::Swell;

/// Waves on the water of a scene, beside its [`Current`](crate::Current): the two add up.
///
/// Many laws ask for the motion at the same stations, so that the latest answers are kept. What it answers depends on
/// place and time alone.
pub struct Sea {
    waves: Waves,
    /// The shortest and the mean period of those [s].
    periods: [f64; 2],
    /// Height of the surface without waves [m].
    level: f64,
    about: String,
    /// The table that stands for them, of which each thread fills its own.
    lattice: Option<Lattice>,
    /// Tells its memories from those of others, and that there still is a sea.
    alive: Arc<()>,
}

/// Up to so many waves are summed up unless asked otherwise.
const FEW: usize = 8;
/// Places at which a table is compared with the sum.
const PROBES: usize = 200;
/// How much finer than at first a table may become.
const FINEST: f64 = 4.0;

impl Sea {
    /// The sea of a spec: under gravity `g` [m/s²], with its surface at `level` [m] when it is still. `drift` is the velocity of
    /// the current there [m/s], which the waves may be told to feel.
    ///
    /// # Errors
    /// Numbers that make no sense; a table that can't be as exact as asked for.
    pub fn new(spec: &WavesSpec, level: f64, g: f64, drift: V3<f64>) -> Result<Self, BuildError> {
        let waves = spec.waves(g, drift)?;
        let (lattice, how) = Self::lattice(spec, &waves)?;
        let [slowest, fastest] =
            waves.iter().fold([f64::INFINITY, 0.0_f64], |[slow, fast], (.., omega, _)| {
                [omega.min(slow), omega.max(fast)]
            });
        let about = format!(
            "waves: {} of {:.3} to {:.3} s, {}, in water {}; {how}",
            waves.len(),
            TAU / fastest,
            TAU / slowest,
            match waves.len() {
                0..=FEW => format!("up to {:.4} m high", waves.height()),
                _ => format!("significant height {:.4} m", waves.height()),
            },
            spec.depth.map_or_else(|| "that is deep".into(), |h| format!("{h} m deep")),
        );
        let periods = [TAU / waves.fastest(), waves.period()];
        Ok(Sea { waves, periods, level, about, lattice, alive: Arc::new(()) })
    }

    /// The table that stands for many waves, if there is to be one, and how the sum is found in words.
    fn lattice(spec: &WavesSpec, waves: &Waves) -> Result<(Option<Lattice>, String), BuildError> {
        let at = |field: &str, message: String| BuildError::at(format!("water.waves.{field}"), message);
        let exact = || Ok((None, "summed exactly".to_string()));
        match spec.evaluation {
            Some(Evaluation::Exact) => return exact(),
            None if waves.len() <= FEW => return exact(),
            _ => {}
        }
        let mut finer = 1.0;
        loop {
            let Some(mut lattice) = Lattice::new(waves.clone(), finer) else {
                return match spec.evaluation {
                    None => exact(),
                    Some(_) => {
                        let message = "a lattice is for waves of one direction: take `evaluation = \"exact\"`, or no \
                                       `spreading`";
                        Err(at("evaluation", message.into()))
                    }
                };
            };
            let error = off(waves, &mut lattice);
            if error <= spec.lattice_error {
                // without what was looked at
                let lattice = Lattice::new(waves.clone(), finer);
                let how = format!(
                    "from a lattice, whose velocities are off by {error:.1e} of their deviation at most"
                );
                return Ok((lattice, how));
            }
            finer *= 1.5;
            if finer > FINEST {
                let message = format!(
                    "the finest lattice is off by {error:.1e}: take `evaluation = \"exact\"`, or a larger \
                     `lattice_error` than {:e}",
                    spec.lattice_error
                );
                return Err(at("lattice_error", message));
            }
        }
    }

    /// Its waves.
    pub fn waves(&self) -> &Waves {
        &self.waves
    }

    /// What it is like, in a sentence.
    pub fn about(&self) -> &str {
        &self.about
    }

    /// How much of a step `h` [s] may be taken that follows the shortest of its waves.
    pub fn reach(&self, h: f64) -> f64 {
        reach::period(self.periods[0], h)
    }

    /// The shortest and the mean period of its waves [s].
    pub fn periods(&self) -> [f64; 2] {
        self.periods
    }

    /// The period of its waves [s]: of many the mean time between those that rise through the still level.
    pub fn period(&self) -> f64 {
        self.periods[1]
    }

    /// The motion of the water at time `t` [s] at places.
    #[inline(always)]
    pub fn at<R: Real>(&self, t: f64, x: &V3<R>) -> Swell<R> {
        let [x0, y0, z0] = x.map(|x| x.lane(0).to_bits() >> 42);
        self.from((x0, y0, z0), t, x)
    }

    /// The motion of the water at time `t` [s] at stations.
    #[inline(always)]
    pub fn along<R: Real>(&self, t: f64, at: &Station<R>) -> Swell<R> {
        self.from(key_of(at), t, &at.x)
    }

    /// Its table, if it has one, for who asks once for all laws at one station after the other.
    #[inline(always)]
    pub fn table(&self) -> Option<SeaTable> {
        self.lattice.as_ref()?;
        Some(SeaTable { memory: Some(Memory::of(self)), level: self.level })
    }

    /// The motion at places from the slot of a key.
    #[inline(always)]
    fn from<R: Real>(&self, key: Key, t: f64, x: &V3<R>) -> Swell<R> {
        let mut places = [[0.0_f64; MOST]; 3];
        for i in 0..3 {
            x[i].write(&mut places[i]);
        }
        let mut memory = Memory::of(self);
        let slot = memory.slot(key);
        if !memory.packs[slot].is(t, R::LANES, &places) {
            self.find(t, &places, R::LANES, slot, &mut memory);
        }
        let Found { at, rows, .. } = &memory.packs[slot];
        let mut swell = Swell::<R>::read(rows);
        if R::LANES == 1 {
            // numbers that know their derivative get it from here; of all others the distance is nothing
            let off = [x[0] - R::read(&at[0]), x[1] - R::read(&at[1]), x[2] - R::read(&at[2])];
            let Swell { by_x, acceleration_by_x, top: Top { slope: [sx, sy], .. }, .. } = swell;
            swell.u = moved(&by_x, &off, swell.u);
            for by in [&mut swell.acceleration, &mut swell.rate, &mut swell.by_t] {
                *by = moved(&acceleration_by_x, &off, *by);
            }
            swell.top.elevation = sx.fma(off[0], sy.fma(off[1], swell.top.elevation));
        }
        memory.keep();
        swell
    }

    /// Finds the motion at some places and puts it into a slot of the memory.
    #[inline(never)]
    fn find(&self, t: f64, places: &Places, lanes: usize, slot: usize, memory: &mut Memory) {
        let Memory { lattice, packs, stations, .. } = memory;
        let found = &mut packs[slot];
        (found.t, found.lanes, found.at) = (t, lanes, *places);
        match lattice {
            Some(lattice) => {
                let width = match lanes {
                    8 => Width::Eight,
                    4 => Width::Four,
                    _ => Width::One,
                };
                run(width, Look { lattice, stations: &mut stations[slot], level: self.level, found });
            }
            None => (0..lanes).for_each(|lane| {
                let [x, y, z] = places.map(|row| row[lane]);
                let up = z - self.level;
                let flow = self.waves.at([x, y, up], t);
                let above = up > flow.elevation;
                let flow = if above { self.waves.at([x, y, flow.elevation], t) } else { flow };
                let above = f64::from(u8::from(above));
                Swell::new(Axes::space(), &flow.motion(), flow.top(), above).write(&mut found.rows, lane);
            }),
        }
    }
}

/// A sea as its table has it, along the axes of its waves. What it finds isn't kept.
pub struct SeaTable {
    /// This thread's, until it is given back.
    memory: Option<Box<Memory>>,
    level: f64,
}

impl SeaTable {
    /// The motion of the water at time `t` [s] at stations.
    #[inline(always)]
    pub fn along<R: Real>(&mut self, t: f64, at: &Station<R>) -> Swell<R, 2> {
        let Some(memory) = &mut self.memory else { unreachable!("it has it until it is dropped") };
        let slot = memory.slot(key_of(at));
        let Memory { lattice: Some(lattice), stations, .. } = &mut **memory else {
            unreachable!("a sea with a table is remembered with it")
        };
        looked_up(lattice, &mut stations[slot], self.level, t, &at.x)
    }
}

impl Drop for SeaTable {
    #[inline(always)]
    fn drop(&mut self) {
        if let Some(memory) = self.memory.take() {
            memory.keep();
        }
    }
}

/// Looks up places in a table.
struct Look<'a> {
    lattice: &'a mut Lattice,
    stations: &'a mut Stations,
    level: f64,
    found: &'a mut Found,
}

impl LaneTask for Look<'_> {
    #[inline(always)]
    fn go<R: Real>(self) {
        let Look { lattice, stations, level, found } = self;
        let x = [R::read(&found.at[0]), R::read(&found.at[1]), R::read(&found.at[2])];
        looked_up(lattice, stations, level, found.t, &x).spread().write(&mut found.rows, 0);
    }
}

/// The motion at places from a table of water with its surface at `level` when it is still.
#[inline(always)]
fn looked_up<R: Real>(
    lattice: &mut Lattice,
    stations: &mut Stations,
    level: f64,
    t: f64,
    [x, y, z]: &V3<R>,
) -> Swell<R, 2> {
    let now = lattice.instant(t);
    let top = lattice.surface(now, [*x, *y], stations);
    let (up, eta) = (*z - R::of(level), top.elevation);
    let motion = lattice.within(now, [*x, *y, up.if_gt(eta, eta, up)], &top, stations);
    Swell::new(lattice.axes(), &motion, top, up.if_gt(eta, R::of(1.0), R::zero()))
}

/// A vector a little farther on.
#[inline(always)]
fn moved<R: Real>(by: &[V3<R>; 3], off: &V3<R>, mut x: V3<R>) -> V3<R> {
    for i in 0..3 {
        x[i] = by[i][0].fma(off[0], by[i][1].fma(off[1], by[i][2].fma(off[2], x[i])));
    }
    x
}

/// The largest difference of velocities between a table and the sum, in parts of their deviation at still water, at places
/// down to where long waves end.
fn off(waves: &Waves, lattice: &mut Lattice) -> f64 {
    let mut random = SplitMix64::new(1);
    let (mut worst, mut square) = (0.0_f64, 0.0);
    let length = TAU / waves.shortest();
    let longest = TAU / waves.iter().map(|(_, k, ..)| k[0].hypot(k[1])).fold(f64::INFINITY, f64::min);
    for _ in 0..PROBES {
        let mut between = |a: f64, b: f64| a + (b - a) * random.unit();
        let place = [between(-50.0, 50.0) * length, between(-50.0, 50.0) * length];
        // most of them near the surface
        let down = -between(0.0, 1.0).powi(3) * longest.min(waves.depth());
        let t = between(0.0, 1000.0) * TAU / waves.fastest() + 1e3;
        // below the surface, or below still water where the column isn't stretched
        let down = down + waves.elevation(place[0], place[1], t).0.min(0.0);
        let (there, still) = ([place[0], place[1], down], [place[0], place[1], 0.0]);
        let (a, b, top) = (waves.at(there, t), lattice.at(there, t), waves.at(still, t));
        let apart: f64 = (0..3).map(|i| (a.velocity[i] - b.velocity[i]).powi(2)).sum();
        worst = worst.max(apart.sqrt());
        square += top.velocity.iter().map(|u| u * u).sum::<f64>() / PROBES as f64;
    }
    if square > 0.0 { worst / square.sqrt() } else { 0.0 }
}

impl fmt::Debug for Sea {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.about)
    }
}

impl PartialEq for Sea {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self, other)
    }
}
