//! The motion of the water in waves, as drag, inertia and buoyancy ask for it.

use crate::current::Current;
use crate::waves::{Evaluation, WavesSpec};
use ropewalk_core::{BuildError, LaneTask, Real, Station, V3, Width, dot, reach, run};
use ropewalk_sea::{Flow, Lattice, SplitMix64, Stations, Waves};
use rustc_hash::FxHashMap;
use std::f64::consts::TAU;
use std::fmt;
use std::sync::{Mutex, PoisonError};

/// Waves on the water of a scene, beside its [`Current`]: the two add up.
///
/// Many laws ask for the motion at the same stations, so that the latest answers are kept. What it answers depends on
/// place and time alone.
pub struct Sea {
    waves: Waves,
    /// Height of the surface without waves [m].
    level: f64,
    about: String,
    /// Whether a table stands for them.
    has_lattice: bool,
    memory: Mutex<Memory>,
}

/// What was found lately, and the table that stands for many waves.
struct Memory {
    lattice: Option<Lattice>,
    /// The slot of each pack: the same as the last time, if what asks has moved little.
    slots: FxHashMap<Key, usize>,
    keys: Vec<Key>,
    /// The slot of who asked last.
    last: usize,
    packs: Vec<Found>,
    /// What is known of the table at each of them.
    stations: Vec<Stations>,
}

/// What packs are told apart by.
type Key = (u64, u64, u64);

impl Memory {
    /// The slot of a pack.
    #[inline(always)]
    fn slot(&mut self, key: Key) -> usize {
        // they mostly ask in the order in which they came
        let next = if self.last + 1 < self.keys.len() { self.last + 1 } else { 0 };
        self.last = if self.keys.get(next) == Some(&key) { next } else { self.slot_of(key) };
        self.last
    }

    #[inline(never)]
    fn slot_of(&mut self, key: Key) -> usize {
        if let Some(&slot) = self.slots.get(&key) { slot } else { self.new_slot(key) }
    }

    fn new_slot(&mut self, key: Key) -> usize {
        if self.packs.len() >= PACKS {
            self.slots.clear();
            self.keys.clear();
            self.packs.clear();
            self.stations.clear();
        }
        let slot = self.packs.len();
        self.slots.insert(key, slot);
        self.keys.push(key);
        let nowhere = [[f64::NAN; MOST]; 3];
        self.packs.push(Found { t: f64::NAN, lanes: 0, at: nowhere, rows: [[0.0; MOST]; ROWS] });
        self.stations.push(Stations::default());
        slot
    }
}

/// The motion at places side by side, number by number over all of them: several laws ask for the same, one after the other.
#[derive(Clone)]
struct Found {
    t: f64,
    lanes: usize,
    at: Places,
    rows: [[f64; MOST]; ROWS],
}

type Places = [[f64; MOST]; 3];

/// Most packs that are remembered.
const PACKS: usize = 4096;
/// As many lanes as the widest carrier has.
const MOST: usize = 8;
/// Numbers that tell the motion at a place, in the order of [`Swell`].
const ROWS: usize = 43;
/// Up to so many waves are summed up unless asked otherwise.
const FEW: usize = 8;
/// Places at which a table is compared with the sum.
const PROBES: usize = 200;
/// A station's pack keeps its slot while its first place stays in a cell of this size [m].
const CELL: f64 = 16.0;
/// Numbers about as large as this have no places for fractions.
const WHOLE: f64 = (3_u64 << 51) as f64;
/// How much finer than at first a table may become.
const FINEST: f64 = 4.0;

/// The motion of the water in waves at a place, over lanes. Above the surface it is that at the surface.
#[derive(Clone, Copy, Debug)]
pub struct Swell<R> {
    /// Velocity [m/s].
    pub u: V3<R>,
    /// What it changes by with the place [1/s].
    pub by_x: [V3<R>; 3],
    /// What it changes by with time at a fixed place [m/s²].
    pub by_t: V3<R>,
    /// `∂u/∂t` in the water; other than `by_t` above the surface [m/s²].
    pub rate: V3<R>,
    /// `G_ij = ∂u_i/∂x_j` in the water; other than `by_x` above the surface [1/s].
    pub gradient: [V3<R>; 3],
    /// The acceleration that Morison's equation takes: `∂u/∂t` as one sees it who drifts with the current that carries the waves,
    /// without what the stretching of the column adds [m/s²].
    pub acceleration: V3<R>,
    /// What it changes by with the place, and the rate nearly so [1/s²].
    pub acceleration_by_x: [V3<R>; 3],
    /// Elevation `η` of the surface above its level [m].
    pub elevation: R,
    /// `∂η/∂x` and `∂η/∂y`.
    pub slope: [R; 2],
    /// `∂η/∂t` [m/s].
    pub rising: R,
}

impl<R: Real> Swell<R> {
    /// Of a flow at places that are below the surface, or at it if they lie `above`: 1 if they do, else 0. There the motion follows
    /// the surface, and doesn't change with height.
    #[inline(always)]
    fn new(flow: &Flow<R>, above: R) -> Self {
        let Flow { velocity, rate, acceleration, gradient, acceleration_gradient, .. } = *flow;
        let mut by_t = rate;
        for i in 0..3 {
            by_t[i] = (above * gradient[i][2]).fma(flow.rising, by_t[i]);
        }
        Swell {
            u: velocity,
            by_x: followed(gradient, flow.slope, above),
            by_t,
            rate,
            gradient,
            acceleration,
            acceleration_by_x: followed(acceleration_gradient, flow.slope, above),
            elevation: flow.elevation,
            slope: flow.slope,
            rising: flow.rising,
        }
    }

    /// From the rows of a pack.
    #[inline(always)]
    fn read(rows: &[[f64; MOST]; ROWS]) -> Self {
        Swell {
            u: three(rows, 0),
            by_x: nine(rows, 3),
            by_t: three(rows, 12),
            rate: three(rows, 15),
            gradient: nine(rows, 18),
            acceleration: three(rows, 27),
            acceleration_by_x: nine(rows, 30),
            elevation: R::read(&rows[39]),
            slope: [R::read(&rows[40]), R::read(&rows[41])],
            rising: R::read(&rows[42]),
        }
    }

    /// Into the rows of a pack, from a lane on.
    #[inline(always)]
    fn write(&self, rows: &mut [[f64; MOST]; ROWS], lane: usize) {
        let Swell { u, by_x, by_t, rate, gradient, acceleration, acceleration_by_x, slope, .. } = self;
        for (first, vector) in [(0, u), (12, by_t), (15, rate), (27, acceleration)] {
            for i in 0..3 {
                vector[i].write(&mut rows[first + i][lane..]);
            }
        }
        for (first, matrix) in [(3, by_x), (18, gradient), (30, acceleration_by_x)] {
            for i in 0..9 {
                matrix[i / 3][i % 3].write(&mut rows[first + i][lane..]);
            }
        }
        for (i, x) in [self.elevation, slope[0], slope[1], self.rising].into_iter().enumerate() {
            x.write(&mut rows[39 + i][lane..]);
        }
    }
    /// How fast the surface rises where one moves with velocity `v`: `∂η/∂t + v·∇η` [m/s].
    #[inline(always)]
    pub fn rise(&self, v: &V3<R>) -> R {
        self.slope[0].fma(v[0], self.slope[1].fma(v[1], self.rising))
    }

    /// Acceleration of the water along its path, `∂u/∂t + G u` with the velocity of waves and current at height `z` [m/s²];
    /// and what it changes by with the place, but for the change of `G`.
    #[inline(always)]
    pub fn along_path(&self, current: &Current, z: R) -> (V3<R>, [V3<R>; 3]) {
        let (mut u, du) = current.at(z);
        for i in 0..3 {
            u[i] += self.u[i];
        }
        let (mut a, mut by_x) = (self.rate, self.acceleration_by_x);
        for i in 0..3 {
            a[i] += dot(&self.gradient[i], &u);
            for j in 0..3 {
                for k in 0..3 {
                    by_x[i][j] += self.gradient[i][k] * self.by_x[k][j];
                }
            }
            by_x[i][2] += dot(&self.gradient[i], &du);
        }
        (a, by_x)
    }
}

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
            "waves: {} of {:.3} to {:.3} s, significant height {:.4} m, in water {}; {how}",
            waves.len(),
            TAU / fastest,
            TAU / slowest,
            4.0 * waves.deviation(),
            spec.depth.map_or_else(|| "that is deep".into(), |h| format!("{h} m deep")),
        );
        let has_lattice = lattice.is_some();
        let memory = Memory {
            lattice,
            slots: FxHashMap::default(),
            keys: Vec::new(),
            last: 0,
            packs: Vec::new(),
            stations: Vec::new(),
        };
        Ok(Sea { waves, level, about, has_lattice, memory: Mutex::new(memory) })
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
        reach::period(TAU / self.waves.fastest(), h)
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

    /// The same for who asks once for all: it isn't kept.
    #[inline(always)]
    pub fn along_once<R: Real>(&self, t: f64, at: &Station<R>) -> Swell<R> {
        if R::LANES > 1 && self.has_lattice {
            let mut memory = self.memory.lock().unwrap_or_else(PoisonError::into_inner);
            let slot = memory.slot(key_of(at));
            if let Memory { lattice: Some(lattice), stations, .. } = &mut *memory {
                return looked_up(lattice, &mut stations[slot], self.level, t, &at.x);
            }
        }
        self.along(t, at)
    }

    /// The motion at places from the slot of a key.
    #[inline(always)]
    fn from<R: Real>(&self, key: Key, t: f64, x: &V3<R>) -> Swell<R> {
        let mut places = [[0.0_f64; MOST]; 3];
        for i in 0..3 {
            x[i].write(&mut places[i]);
        }
        let mut memory = self.memory.lock().unwrap_or_else(PoisonError::into_inner);
        let slot = memory.slot(key);
        let found = &memory.packs[slot];
        // what is no number is never found
        if (found.t, found.lanes) != (t, R::LANES) || !same(&found.at, &places) {
            self.find(t, &places, R::LANES, slot, &mut memory);
        }
        let Found { at, rows, .. } = &memory.packs[slot];
        let mut swell = Swell::<R>::read(rows);
        if R::LANES == 1 {
            // numbers that know their derivative get it from here; of all others the distance is nothing
            let off = [x[0] - R::read(&at[0]), x[1] - R::read(&at[1]), x[2] - R::read(&at[2])];
            let Swell { by_x, acceleration_by_x, slope: [sx, sy], .. } = swell;
            swell.u = moved(&by_x, &off, swell.u);
            for by in [&mut swell.acceleration, &mut swell.rate, &mut swell.by_t] {
                *by = moved(&acceleration_by_x, &off, *by);
            }
            swell.elevation = sx.fma(off[0], sy.fma(off[1], swell.elevation));
        }
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
                Swell::new(&flow, f64::from(u8::from(above))).write(&mut found.rows, lane);
            }),
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
        looked_up(lattice, stations, level, found.t, &x).write(&mut found.rows, 0);
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
) -> Swell<R> {
    let now = lattice.instant(t);
    let mut flow = lattice.surface(now, [*x, *y], stations);
    let (up, top) = (*z - R::of(level), flow.elevation);
    lattice.within(now, [*x, *y, up.if_gt(top, top, up)], stations, &mut flow);
    Swell::new(&flow, up.if_gt(top, R::of(1.0), R::zero()))
}

/// What tells stations apart: those of a body have other arc lengths, and bodies are elsewhere.
#[inline(always)]
fn key_of<R: Real>(at: &Station<R>) -> Key {
    // what is added leaves the number of the cell in the last bits
    let [x, y] = [at.x[0], at.x[1]].map(|x| (x.lane(0) / CELL + WHOLE).to_bits());
    let place = x.rotate_left(32) ^ y;
    (at.s.lane(0).to_bits(), at.diameter.lane(0).to_bits(), place)
}

/// What changes from place to place, of what follows the surface and doesn't change with height where it lies `above`.
#[inline(always)]
fn followed<R: Real>(of: [V3<R>; 3], [sx, sy]: [R; 2], above: R) -> [V3<R>; 3] {
    // most stations are under water
    if R::of(0.5).all_gt(above) {
        return of;
    }
    let (mut by_x, below) = (of, R::of(1.0) - above);
    for row in &mut by_x {
        let follows = above * row[2];
        *row = [follows.fma(sx, row[0]), follows.fma(sy, row[1]), below * row[2]];
    }
    by_x
}

/// Three numbers from the rows of a pack, and nine.
#[inline(always)]
fn three<R: Real>(rows: &[[f64; MOST]; ROWS], row: usize) -> V3<R> {
    [R::read(&rows[row]), R::read(&rows[row + 1]), R::read(&rows[row + 2])]
}
#[inline(always)]
fn nine<R: Real>(rows: &[[f64; MOST]; ROWS], row: usize) -> [V3<R>; 3] {
    [three(rows, row), three(rows, row + 3), three(rows, row + 6)]
}

/// A vector a little farther on.
#[inline(always)]
fn moved<R: Real>(by: &[V3<R>; 3], off: &V3<R>, mut x: V3<R>) -> V3<R> {
    for i in 0..3 {
        x[i] = by[i][0].fma(off[0], by[i][1].fma(off[1], by[i][2].fma(off[2], x[i])));
    }
    x
}

/// Whether places are the same in all lanes, none of which is no number.
#[inline(always)]
fn same(a: &Places, b: &Places) -> bool {
    let mut same = true;
    for i in 0..3 {
        for lane in 0..MOST {
            same &= a[i][lane] == b[i][lane];
        }
    }
    same
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
