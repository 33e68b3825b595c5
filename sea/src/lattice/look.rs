//! The motion of the water at stations, over lanes.

use super::cell::Spot;
use super::{Lattice, SPOTS};
use crate::motion::Motion;
use crate::waves::Flow;
use ropewalk_core::{LaneTask, Real, Width, run};

/// As many lanes as the widest carrier has.
const LANES: usize = 8;

type Row = [f64; LANES];

/// A generation of slots that never was.
const NEVER: u64 = u64::MAX;

/// What is known of the table around stations side by side: it stays the same until one of them gets to another spot, or the
/// time to another instant.
#[derive(Clone, Debug)]
pub struct Stations {
    /// How many there are: as many others know nothing of these.
    lanes: usize,
    surface: Known<2, 6>,
    water: Known<4, 12>,
    /// Spots of the cells in which they are are so far apart, and their number per metre.
    apart: Row,
    per: Row,
    /// The depths between which such cells are [m].
    from: Row,
    to: Row,
}

/// Numbers at the spots next to stations, at both instants about a time.
#[derive(Clone, Debug)]
struct Known<const CORNERS: usize, const N: usize> {
    /// The first of the instants.
    n: i64,
    /// Of what is known of slots.
    generation: u64,
    /// Numbers of the spots along the waves and downwards, and where these are [m].
    spots: [Row; 2],
    places: [Row; 2],
    /// Slots of the corners around them.
    slots: [[u32; CORNERS]; LANES],
    /// What is there, number by number.
    rows: [[Row; N]; 2],
}

impl<const CORNERS: usize, const N: usize> Known<CORNERS, N> {
    /// Of nothing.
    fn nothing() -> Self {
        let nowhere = [[f64::NAN; LANES]; 2];
        let (slots, rows) = ([[0; CORNERS]; LANES], [[[0.0; LANES]; N]; 2]);
        Known { n: 0, generation: NEVER, spots: nowhere, places: nowhere, slots, rows }
    }

    /// Number `k` and its rate at both instants, where rates are so much farther on.
    #[inline(always)]
    fn four<R: Real>(&self, k: usize, rate: usize) -> [R; 4] {
        let [a, b] = &self.rows;
        [R::read(&a[k]), R::read(&a[k + rate]), R::read(&b[k]), R::read(&b[k + rate])]
    }
}

impl Default for Stations {
    /// Of nothing.
    fn default() -> Self {
        let nowhere = [f64::NAN; LANES];
        Stations {
            lanes: 0,
            surface: Known::nothing(),
            water: Known::nothing(),
            apart: nowhere,
            per: nowhere,
            from: nowhere,
            to: nowhere,
        }
    }
}

/// An instant and how far it is from it to the next, in parts of their distance.
#[derive(Clone, Copy)]
struct Instant {
    n: i64,
    late: f64,
}

/// Polynomials in time of values and rates at both instants, and their derivatives [1/s].
struct Blend {
    value: [f64; 4],
    rate: [f64; 4],
}

impl Blend {
    #[inline(always)]
    fn of<R: Real>(weights: &[f64; 4], [a, da, b, db]: [R; 4]) -> R {
        let [h, dh, g, dg] = *weights;
        R::of(h).fma(a, R::of(dh).fma(da, R::of(g).fma(b, R::of(dg) * db)))
    }
}

impl Lattice {
    /// The motion of the water, as [`Waves::at`](crate::Waves::at) gives it, but for the pressure, which is left out.
    pub fn at(&mut self, [x, y, z]: [f64; 3], t: f64) -> Flow {
        let mut stations = Stations::default();
        let mut flow = self.surface(t, [x, y], &mut stations);
        self.within(t, [x, y, z], &mut stations, &mut flow);
        flow
    }

    fn instant(&self, t: f64) -> Instant {
        let instant = t / self.time;
        let n = instant.floor();
        Instant { n: n as i64, late: instant - n }
    }

    fn blend(&self, late: f64) -> Blend {
        let tau = self.time;
        let ([a, da, b, db], [ra, rda, rb, rdb]) = (hermite(late), slopes(late));
        Blend { value: [a, tau * da, b, tau * db], rate: [ra / tau, rda, rb / tau, rdb] }
    }

    /// How far places are along the waves [m].
    #[inline(always)]
    fn along<R: Real>(&self, [x, y]: [R; 2]) -> R {
        x.fma(R::of(self.way[0]), y * R::of(self.way[1]))
    }

    /// The surface above places, of a flow of which nothing else is known.
    #[inline(always)]
    pub fn surface<R: Real>(&mut self, t: f64, place: [R; 2], stations: &mut Stations) -> Flow<R> {
        if stations.lanes != R::LANES {
            *stations = Stations { lanes: R::LANES, ..Stations::default() };
        }
        let Instant { n, late } = self.instant(t);
        let along = self.along(place);
        let spots = rounded(along * R::of(SPOTS as f64 / self.size));
        if stations.surface.n != n || !same::<R>(&spots, &stations.surface.spots[0]) {
            run(
                Width::best(),
                MeetSurface {
                    lattice: self,
                    spots: &spots,
                    n,
                    lanes: R::LANES,
                    known: &mut stations.surface,
                },
            );
        }
        let known = &stations.surface;
        let Blend { value, rate } = self.blend(late);
        let (mut now, mut rates) = ([R::zero(); 3], [R::zero(); 3]);
        for k in 0..3 {
            let four = known.four(k, 3);
            now[k] = Blend::of(&value, four);
            rates[k] = Blend::of(&rate, four);
        }
        let off = along - R::read(&known.places[0]);
        let ([elevation, steep, bend], [rising, steepening, bending]) = (now, rates);
        let half = R::of(0.5) * off;
        let elevation = off.fma(half.fma(bend, steep), elevation);
        let rate = off.fma(half.fma(bending, steepening), rising);
        let steep = off.fma(bend, steep);
        let [risen, rises] = self.waves.risen(t);
        let (risen, rises, [cx, cy]) = (R::of(risen), R::of(rises), self.way);
        Flow {
            elevation: risen * elevation,
            slope: [risen * steep * R::of(cx), risen * steep * R::of(cy)],
            rising: risen.fma(rate, rises * elevation),
            ..Flow::still()
        }
    }

    /// Adds to a flow, of which the surface is known, what is under it at places: under still water if stretched so.
    #[inline(always)]
    pub fn within<R: Real>(
        &mut self,
        t: f64,
        [x, y, z]: [R; 3],
        stations: &mut Stations,
        flow: &mut Flow<R>,
    ) {
        let Instant { n, late } = self.instant(t);
        let along = self.along([x, y]);
        let [up, by_z, by_eta] = self.waves.stretched(z, flow.elevation);
        let (depth, per) = (-up, R::read(&stations.per));
        let spots = [rounded(along * per), rounded(depth * per)];
        let known = &stations.water;
        if known.n != n
            || !same::<R>(&spots[0], &known.spots[0])
            || !same::<R>(&spots[1], &known.spots[1])
            || !(depth.all_gt(R::read(&stations.from)) && R::read(&stations.to).all_gt(depth))
        {
            let (mut x, mut down) = ([0.0; LANES], [0.0; LANES]);
            along.write(&mut x);
            depth.write(&mut down);
            // a corner has four numbers of each kind
            run(Width::Four, Meet { lattice: self, along: &x, depth: &down, n, lanes: R::LANES, stations });
        }
        let known = &stations.water;
        let off = [along - R::read(&known.places[0]), R::read(&known.places[1]) - depth];
        let Blend { value, rate } = self.blend(late);
        // f, its first and its second derivative, and their rates
        let (mut now, mut rates) = ([[R::zero(); 2]; 3], [[R::zero(); 2]; 3]);
        for k in 0..3 {
            for i in 0..2 {
                let four = known.four(4 * k + i, 2);
                now[k][i] = Blend::of(&value, four);
                rates[k][i] = Blend::of(&rate, four);
            }
        }
        let ([f, by], [df, dby]) = (around(now, off), around(rates, off));
        let (way, current) = ([R::of(self.way[0]), R::of(self.way[1])], R::of(self.current));
        let mut motion = Motion::<R, 2> {
            velocity: [f[0], -f[1]],
            // as one sees it who drifts with the current
            acceleration: [current.fma(by[0], df[0]), -current.fma(by[1], df[1])],
            gradient: gradient(by),
            // of what drifting adds to the acceleration the change from place to place is left out
            acceleration_gradient: gradient(dby),
            ..Motion::still()
        };
        let (steep, none) = (self.along(flow.slope), R::zero());
        motion.stretch([by_z, by_eta], [steep, none], flow.rising, [current, none]);
        motion.rise(self.waves.risen(t));
        let Motion { velocity, acceleration, rate, gradient, acceleration_gradient } = motion.spread(way);
        (flow.velocity, flow.acceleration, flow.rate) = (velocity, acceleration, rate);
        (flow.gradient, flow.acceleration_gradient) = (gradient, acceleration_gradient);
    }
}

/// Finds the surface at these spots.
struct MeetSurface<'a> {
    lattice: &'a mut Lattice,
    spots: &'a Row,
    n: i64,
    lanes: usize,
    known: &'a mut Known<2, 6>,
}

impl LaneTask for MeetSurface<'_> {
    #[inline(always)]
    fn go<R: Real>(self) {
        let MeetSurface { lattice, spots, n, lanes, known } = self;
        let Lattice { sums, edge, size, .. } = lattice;
        let generation = sums.make_room(n);
        let anew = known.generation != generation;
        for lane in 0..lanes {
            let moved = anew || known.spots[0][lane] != spots[lane];
            if !moved && known.n == n {
                continue;
            }
            let (i, spot) = cell_of(spots[lane]);
            if moved {
                if anew || cell_of(known.spots[0][lane]).0 != i {
                    known.slots[lane] = [i, i + 1].map(|i| sums.line(i));
                }
                let place = spots[lane] * *size / SPOTS as f64;
                (known.spots[0][lane], known.places[0][lane]) = (spots[lane], place);
            }
            for (rows, n) in known.rows.iter_mut().zip(n..) {
                let numbers = edge.spot(spot, sums.tops(known.slots[lane], n), *size);
                rows.iter_mut().zip(numbers).for_each(|(row, x)| row[lane] = x);
            }
        }
        (known.n, known.generation) = (n, generation);
    }
}

/// Finds the water at the spots next to places along the waves and at these depths [m].
struct Meet<'a> {
    lattice: &'a mut Lattice,
    along: &'a Row,
    depth: &'a Row,
    n: i64,
    lanes: usize,
    stations: &'a mut Stations,
}

impl LaneTask for Meet<'_> {
    #[inline(always)]
    fn go<R: Real>(self) {
        let Meet { lattice, along, depth, n, lanes, stations } = self;
        let Lattice { sums, cell, levels, size, bottom, waves, .. } = lattice;
        let generation = sums.make_room(n);
        let Stations { water: known, apart, per, from, to, .. } = stations;
        let anew = known.generation != generation;
        for lane in 0..lanes {
            let level = levels.partition_point(|from| *from <= depth[lane]).max(1) - 1;
            let width = *size * f64::from(1_u32 << level);
            let spot = width / SPOTS as f64;
            // just as it is asked whether they stay
            let inverse = 1.0 / spot;
            let spots = [along[lane], depth[lane]].map(|x| (x * inverse + 0.5).floor());
            let old = known.spots.map(|row| row[lane]);
            let other = anew || apart[lane] != spot;
            let moved = other || old != spots;
            if !moved && known.n == n {
                continue;
            }
            // no deeper than the bed
            let deepest = (*bottom / spot + 0.5).floor();
            let cells = |[along, down]: [f64; 2]| [cell_of(along), cell_of(down.min(deepest))];
            let [(i, across), (j, down)] = cells(spots);
            if moved {
                let [(old_i, _), (old_j, _)] = cells(old);
                if other || [old_i, old_j] != [i, j] {
                    let step = 1 << level;
                    let (i, j) = (i.wrapping_mul(step), j.wrapping_mul(step));
                    let place = |(right, down)| sums.place(i.wrapping_add(right), j.wrapping_add(down));
                    known.slots[lane] = [(0, 0), (step, 0), (0, step), (step, step)].map(place);
                }
                let places = [spots[0], spots[1].min(deepest)];
                for k in 0..2 {
                    (known.spots[k][lane], known.places[k][lane]) = (spots[k], places[k] * spot);
                }
            }
            if other {
                (apart[lane], per[lane]) = (spot, inverse);
                from[lane] = if level == 0 { f64::NEG_INFINITY } else { levels[level] };
                to[lane] = levels.get(level + 1).copied().unwrap_or(f64::INFINITY);
            }
            // nothing moves far down
            let still = depth[lane] > *bottom && waves.depth().is_infinite();
            let numbers: Spot = if still {
                [[[0.0; 4]; 2]; 3]
            } else {
                cell.spot::<R>([across, down], sums.corners(known.slots[lane], n), width)
            };
            for (k, both) in numbers.iter().enumerate() {
                for (rows, four) in known.rows.iter_mut().zip(both) {
                    rows[4 * k..].iter_mut().zip(four).for_each(|(row, x)| row[lane] = *x);
                }
            }
        }
        (known.n, known.generation) = (n, generation);
    }
}

/// The cell of a spot, and its number in it.
fn cell_of(spot: f64) -> (i64, usize) {
    let (spot, spots) = (spot as i64, SPOTS as i64);
    (spot.div_euclid(spots), spot.rem_euclid(spots) as usize)
}

/// Cubic Hermite polynomials on 0 … 1: value and derivative at the start, value and derivative at the end.
fn hermite(x: f64) -> [f64; 4] {
    let (x2, rest) = (x * x, 1.0 - x);
    let s = x2 * (3.0 - 2.0 * x);
    [1.0 - s, x * rest * rest, s, -x2 * rest]
}

/// Their derivatives.
fn slopes(x: f64) -> [f64; 4] {
    let s = 6.0 * x * (1.0 - x);
    [-s, (1.0 - x) * (1.0 - 3.0 * x), s, x * (3.0 * x - 2.0)]
}

/// Whole numbers next to these.
#[inline(always)]
fn rounded<R: Real>(x: R) -> Row {
    let mut numbers = [0.0; LANES];
    x.write(&mut numbers);
    for x in &mut numbers[..R::LANES] {
        *x = (*x + 0.5).floor();
    }
    numbers
}

/// Whether they are the same in all lanes; what is no number never is.
#[inline(always)]
fn same<R: Real>(a: &Row, b: &Row) -> bool {
    let mut same = true;
    for lane in 0..R::LANES {
        same &= a[lane] == b[lane];
    }
    same
}

/// `f` so far from a spot, and its derivative, of which value, first and second derivative are known there.
#[inline(always)]
fn around<R: Real>([f, by, bend]: [[R; 2]; 3], [x, z]: [R; 2]) -> [[R; 2]; 2] {
    let (square, both) = (R::of(0.5) * (x * x - z * z), x * z);
    [
        [
            x.fma(by[0], square.fma(bend[0], f[0])) - z.fma(by[1], both * bend[1]),
            x.fma(by[1], square.fma(bend[1], f[1])) + z.fma(by[0], both * bend[0]),
        ],
        [x.fma(bend[0], by[0]) - z * bend[1], x.fma(bend[1], by[1]) + z * bend[0]],
    ]
}

/// What `u` along the waves and `w` change by from place to place: `f' = u_x - i w_x`, and `u_z = w_x`, `w_z = -u_x`.
#[inline(always)]
fn gradient<R: Real>([ux, minus_wx]: [R; 2]) -> [[R; 2]; 2] {
    [[ux, -minus_wx], [-minus_wx, -ux]]
}
