//! The motion of the water at stations, over lanes.

use super::cell::Spot;
use super::stations::{Ends, Kept, Known, LANES, Row, Stations, place_of};
use super::{Lattice, SPOTS};
use crate::axes::Axes;
use crate::motion::{Motion, Top};
use crate::waves::Flow;
use ropewalk_core::{LaneTask, Real, Width, run};

/// Within this part of the distance of spots a station is surely next to its own; beyond, it is asked to the last bit.
const NEAR: f64 = 0.5 * (1.0 - 1e-9);

/// A time and the instant before it.
#[derive(Clone, Copy, Debug)]
pub struct Instant {
    t: f64,
    /// Its number, which is whole.
    n: f64,
    /// How far it is from it to the time, in parts of the distance to the next.
    late: f64,
}

impl Lattice {
    /// The motion of the water, as [`Waves::at`](crate::Waves::at) gives it, but for the pressure, which is left out.
    pub fn at(&mut self, [x, y, z]: [f64; 3], t: f64) -> Flow {
        let (mut stations, now) = (Stations::default(), self.instant(t));
        let top = self.surface(now, [x, y], &mut stations);
        let motion = self.within(now, [x, y, z], &top, &mut stations);
        Flow::of(top, motion.spread(&self.axes()), 0.0)
    }

    /// Where time `t` [s] is among the instants of the table.
    #[inline(always)]
    pub fn instant(&self, t: f64) -> Instant {
        let instant = t * self.per_time;
        let n = instant.floor();
        Instant { t, n, late: instant - n }
    }

    /// The axes of the plane of its waves.
    #[inline(always)]
    pub fn axes<R: Real>(&self) -> Axes<R, 2> {
        Axes::plane(self.way)
    }

    /// How far places are along the waves [m].
    #[inline(always)]
    fn along<R: Real>(&self, [x, y]: [R; 2]) -> R {
        x.fma(R::of(self.way[0]), y * R::of(self.way[1]))
    }

    /// The surface above places.
    #[inline(always)]
    pub fn surface<R: Real>(&mut self, now: Instant, place: [R; 2], stations: &mut Stations) -> Top<R> {
        if stations.lanes != R::LANES {
            *stations = Stations::of(R::LANES);
        }
        let Instant { t, n, late } = now;
        let along = self.along(place);
        let Stations { surface: known, kept, .. } = stations;
        let mut off = along - R::read(&known.places[0]);
        if known.n != n || !R::of(NEAR * self.size / SPOTS as f64).all_gt(off.abs()) {
            let mut x = Row([0.0; LANES]);
            along.write(&mut x);
            let ends = &mut kept.surface;
            run(Width::best(), MeetSurface { lattice: self, along: &x, n, lanes: R::LANES, known, ends });
            off = along - R::read(&known.places[0]);
        }
        if known.t != t {
            known.go_to::<R>(kept.surface.about(n), t, late, self.time);
        }
        let ([elevation, steep, bend], [rising, steepening, bending]) =
            (known.read::<R, 3>(0), known.read::<R, 3>(3));
        let half = R::of(0.5) * off;
        let elevation = off.fma(half.fma(bend, steep), elevation);
        let rate = off.fma(half.fma(bending, steepening), rising);
        let steep = off.fma(bend, steep);
        let [risen, rises] = self.waves.risen(t);
        let (risen, rises, [cx, cy]) = (R::of(risen), R::of(rises), self.way);
        Top {
            elevation: risen * elevation,
            slope: [risen * steep * R::of(cx), risen * steep * R::of(cy)],
            rising: risen.fma(rate, rises * elevation),
        }
    }

    /// The motion of the water at places under a surface, along the [axes](Lattice::axes) of the waves: under still water if
    /// stretched so.
    #[inline(always)]
    pub fn within<R: Real>(
        &mut self,
        now: Instant,
        [x, y, z]: [R; 3],
        top: &Top<R>,
        stations: &mut Stations,
    ) -> Motion<R, 2> {
        let Instant { t, n, late } = now;
        let along = self.along([x, y]);
        let [up, by_z, by_eta] = self.waves.stretched(z, top.elevation);
        let (depth, near) = (-up, R::read(&stations.near));
        let known = &stations.water;
        let mut off = [along - R::read(&known.places[0]), R::read(&known.places[1]) - depth];
        if known.n != n
            || !(near.all_gt(off[0].abs()) && near.all_gt(off[1].abs()))
            || !(depth.all_gt(R::read(&stations.from)) && R::read(&stations.to).all_gt(depth))
        {
            let (mut x, mut down) = (Row([0.0; LANES]), Row([0.0; LANES]));
            along.write(&mut x);
            depth.write(&mut down);
            // a corner has four numbers of each kind
            run(Width::Four, Meet { lattice: self, along: &x, depth: &down, n, lanes: R::LANES, stations });
            let known = &stations.water;
            off = [along - R::read(&known.places[0]), R::read(&known.places[1]) - depth];
        }
        let Stations { water: known, kept, .. } = stations;
        if known.t != t {
            known.go_to::<R>(kept.water.about(n), t, late, self.time);
        }
        // f, its first and its second derivative, and their rates
        let (now, rates) = (
            [known.read::<R, 2>(0), known.read::<R, 2>(2), known.read::<R, 2>(4)],
            [known.read::<R, 2>(6), known.read::<R, 2>(8), known.read::<R, 2>(10)],
        );
        let ([f, by], [df, dby]) = (around(now, off), around(rates, off));
        let current = R::of(self.current);
        let mut motion = Motion::<R, 2> {
            velocity: [f[0], -f[1]],
            // as one sees it who drifts with the current
            acceleration: [current.fma(by[0], df[0]), -current.fma(by[1], df[1])],
            gradient: gradient(by),
            // of what drifting adds to the acceleration the change from place to place is left out
            acceleration_gradient: gradient(dby),
            ..Motion::still()
        };
        let (steep, none) = (self.along(top.slope), R::zero());
        motion.stretch([by_z, by_eta], [steep, none], top.rising, [current, none]);
        motion.rise(self.waves.risen(t));
        motion
    }
}

/// Finds the surface at the spots next to places along the waves [m].
struct MeetSurface<'a> {
    lattice: &'a mut Lattice,
    along: &'a Row,
    n: f64,
    lanes: usize,
    known: &'a mut Known<1, 6>,
    ends: &'a mut Ends<2, 6>,
}

impl LaneTask for MeetSurface<'_> {
    #[inline(always)]
    fn go<R: Real>(self) {
        let MeetSurface { lattice, along, n, lanes, known, ends } = self;
        let Lattice { sums, edge, size, .. } = lattice;
        let first = n as i64;
        let generation = sums.make_room(first);
        let anew = ends.generation != generation;
        for lane in 0..lanes {
            let next = (along[lane] / (*size / SPOTS as f64) + 0.5).floor();
            let moved = anew || ends.spots[0][lane] != next;
            if !moved && known.n == n {
                continue;
            }
            let (i, spot) = cell_of(next);
            if moved {
                if anew || cell_of(ends.spots[0][lane]).0 != i {
                    ends.slots[lane] = [i, i + 1].map(|i| sums.line(i));
                }
                (ends.spots[0][lane], known.places[0][lane]) = (next, next * *size / SPOTS as f64);
            }
            // who stays has met the first instant as the second one
            let stays = !moved && known.n + 1.0 == n;
            for instant in first + i64::from(stays)..first + 2 {
                let numbers = edge.spot(spot, sums.tops(ends.slots[lane], instant), *size);
                ends.rows[place_of(instant)].iter_mut().zip(numbers).for_each(|(row, x)| row[lane] = x);
            }
        }
        (known.n, known.t, ends.generation) = (n, f64::NAN, generation);
    }
}

/// Finds the water at the spots next to places along the waves and at these depths [m].
struct Meet<'a> {
    lattice: &'a mut Lattice,
    along: &'a Row,
    depth: &'a Row,
    n: f64,
    lanes: usize,
    stations: &'a mut Stations,
}

impl LaneTask for Meet<'_> {
    #[inline(always)]
    fn go<R: Real>(self) {
        let Meet { lattice, along, depth, n, lanes, stations } = self;
        let Lattice { sums, cell, levels, size, bottom, waves, .. } = lattice;
        let first = n as i64;
        let generation = sums.make_room(first);
        let Stations { water: known, near, from, to, kept, .. } = stations;
        let Kept { water: ends, apart, .. } = &mut **kept;
        let anew = ends.generation != generation;
        for lane in 0..lanes {
            let level = levels.partition_point(|from| *from <= depth[lane]).max(1) - 1;
            let width = *size * f64::from(1_u32 << level);
            let spot = width / SPOTS as f64;
            let spots = [along[lane], depth[lane]].map(|x| (x / spot + 0.5).floor());
            let old = ends.spots.map(|row| row[lane]);
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
                    let (right, below) = (i.wrapping_add(step), j.wrapping_add(step));
                    ends.slots[lane] = [
                        sums.place(i, j),
                        sums.place(right, j),
                        sums.place(i, below),
                        sums.place(right, below),
                    ];
                }
                let places = [spots[0], spots[1].min(deepest)];
                for k in 0..2 {
                    (ends.spots[k][lane], known.places[k][lane]) = (spots[k], places[k] * spot);
                }
            }
            if other {
                (apart[lane], near[lane]) = (spot, NEAR * spot);
                from[lane] = if level == 0 { f64::NEG_INFINITY } else { levels[level] };
                to[lane] = levels.get(level + 1).copied().unwrap_or(f64::INFINITY);
            }
            let stays = !moved && known.n + 1.0 == n;
            // nothing moves far down
            let still = spots[1] > deepest && waves.depth().is_infinite();
            for instant in first + i64::from(stays)..first + 2 {
                let numbers: Spot = if still {
                    Spot::default()
                } else {
                    let corners = sums.corners(ends.slots[lane], instant);
                    cell.spot::<R>([across, down], corners, width)
                };
                let rows = &mut ends.rows[place_of(instant)];
                for (k, [re, im, rate_re, rate_im]) in numbers.into_iter().enumerate() {
                    (rows[2 * k][lane], rows[2 * k + 1][lane]) = (re, im);
                    (rows[2 * k + 6][lane], rows[2 * k + 7][lane]) = (rate_re, rate_im);
                }
            }
        }
        (known.n, known.t, ends.generation) = (n, f64::NAN, generation);
    }
}

/// The cell of a spot, and its number in it.
#[inline(always)]
fn cell_of(spot: f64) -> (i64, usize) {
    let (spot, spots) = (spot as i64, SPOTS as i64);
    (spot.div_euclid(spots), spot.rem_euclid(spots) as usize)
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
