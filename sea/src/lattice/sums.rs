//! Exact sums at the corners of the table.
//!
//! The phases of a line of the table are the same at all heights, and what is left of a wave at a height the same at all lines
//! and instants: each is found once, and a corner is a sum of their products. Of the corners themselves the sums alone are
//! kept: phases of each would fill the caches. A place keeps its slot from instant to instant, so that who stays there needn't
//! look for it.

use super::cell::{Corner, Top};
use super::phases::{Phases, Row, Steps, filled};
use crate::waves::{Component, Waves};
use ropewalk_core::{LaneTask, Real, Width, run};
use rustc_hash::FxHashMap;
use std::hash::Hash;

/// Lines and heights of which phases and amplitudes are remembered, and places of which sums are.
const LINES: usize = 4096;
const PLACES: usize = 1 << 15;
/// Instants whose sums are kept, a power of two.
const KEPT: usize = 4;
/// Of no place.
const NEVER: i64 = i64::MIN;
/// Waves of which less than this part of the largest is left count no more.
const NOTHING: f64 = 1e-5;

/// All places that have been looked at.
#[derive(Clone, Debug)]
pub(super) struct Sums {
    all: Vec<Component>,
    depth: f64,
    /// Width of the smallest cells [m].
    size: f64,
    k: Row,
    omega: Row,
    a: Row,
    /// Phases that each line adds, and that each instant takes off: those of a corner are their differences.
    lines: Steps,
    instants: Steps,
    /// Of each height what is left of the waves there: the amplitudes of their velocities along them and upwards [m/s].
    heights: FxHashMap<i64, [Row; 2]>,
    tops: Slots<i64, 6>,
    corners: Slots<(i64, i64), 16>,
    latest: i64,
    /// How often all was forgotten.
    generation: u64,
}

/// `N` numbers for each place, at the latest instants.
#[derive(Clone, Debug)]
struct Slots<K, const N: usize> {
    slots: FxHashMap<K, u32>,
    places: Vec<K>,
    numbers: Vec<[[f64; N]; KEPT]>,
    instants: Vec<[i64; KEPT]>,
}

impl<K: Copy + Eq + Hash, const N: usize> Slots<K, N> {
    fn new() -> Self {
        Slots { slots: FxHashMap::default(), places: Vec::new(), numbers: Vec::new(), instants: Vec::new() }
    }

    /// The slot of a place.
    #[inline(always)]
    fn of(&mut self, place: K) -> u32 {
        let Slots { slots, places, numbers, instants } = self;
        *slots.entry(place).or_insert_with(|| {
            places.push(place);
            numbers.push([[0.0; N]; KEPT]);
            instants.push([NEVER; KEPT]);
            (places.len() - 1) as u32
        })
    }

    /// Where an instant has its numbers in a slot, and whether they are there already.
    #[inline(always)]
    fn at(&mut self, slot: u32, n: i64) -> (usize, bool) {
        let place = (n & (KEPT as i64 - 1)) as usize;
        let instant = &mut self.instants[slot as usize][place];
        let known = *instant == n;
        *instant = n;
        (place, known)
    }
}

impl Sums {
    pub fn new(waves: &Waves, [size, time]: [f64; 2]) -> Self {
        let mut all = waves.all.clone();
        all.sort_by(|a, b| a.k.total_cmp(&b.k));
        let row = |of: fn(&Component) -> f64| filled(all.iter().map(of).collect());
        Sums {
            size,
            k: row(|c| c.k),
            omega: row(|c| c.omega),
            a: row(|c| c.a),
            lines: Steps::new(
                all.iter().map(|c| c.phase).collect(),
                all.iter().map(|c| c.k * size).collect(),
            ),
            instants: Steps::new(vec![0.0; all.len()], all.iter().map(|c| c.omega * time).collect()),
            heights: FxHashMap::default(),
            tops: Slots::new(),
            corners: Slots::new(),
            latest: NEVER,
            generation: 0,
            depth: waves.depth(),
            all,
        }
    }

    /// Number of places whose surface is known.
    pub fn columns(&self) -> usize {
        self.tops.places.len()
    }

    /// Makes room for some more places, and for an instant. Slots are those of the generation that is returned.
    pub fn make_room(&mut self, n: i64) -> u64 {
        if self.corners.places.len() + 64 > PLACES || self.tops.places.len() + 64 > PLACES {
            (self.corners, self.tops) = (Slots::new(), Slots::new());
            self.generation += 1;
        }
        if self.lines.len() > LINES {
            self.lines.clear();
        }
        if self.heights.len() > LINES {
            self.heights.clear();
        }
        if n != self.latest {
            self.instants.retain(|instant| instant.abs_diff(n) <= KEPT as u64);
            self.latest = n;
        }
        self.generation
    }

    /// The slot of a line's surface.
    #[inline(always)]
    pub fn line(&mut self, i: i64) -> u32 {
        self.tops.of(i)
    }

    /// The slot of the corner of line `i` at the height that is `j` times the width of the smallest cells below still water.
    #[inline(always)]
    pub fn place(&mut self, i: i64, j: i64) -> u32 {
        self.corners.of((i, j))
    }

    /// The surface of both lines at an instant.
    #[inline(always)]
    pub fn tops(&mut self, slots: [u32; 2], n: i64) -> [&Top; 2] {
        let [a, b] = [self.top(slots[0], n), self.top(slots[1], n)];
        let at = |(slot, place): (usize, usize)| &self.tops.numbers[slot][place];
        [at(a), at(b)]
    }

    /// Where a line has its surface.
    fn top(&mut self, slot: u32, n: i64) -> (usize, usize) {
        let (place, known) = self.tops.at(slot, n);
        if !known {
            let i = self.tops.places[slot as usize];
            self.meet(i, n);
            let waves = [&self.k, &self.omega, &self.a].map(Vec::as_slice);
            let (line, instant) = (self.lines.at(i), self.instants.at(n));
            let sums = &mut self.tops.numbers[slot as usize][place];
            run(Width::best(), Tops { line, instant, waves, sums });
        }
        (slot as usize, place)
    }

    /// The water at four corners at an instant.
    #[inline(always)]
    pub fn corners(&mut self, slots: [u32; 4], n: i64) -> [&Corner; 4] {
        let [a, b] = [self.corner(slots[0], n), self.corner(slots[1], n)];
        let [c, d] = [self.corner(slots[2], n), self.corner(slots[3], n)];
        let at = |(slot, place): (usize, usize)| &self.corners.numbers[slot][place];
        [at(a), at(b), at(c), at(d)]
    }

    /// Where a corner has its numbers.
    fn corner(&mut self, slot: u32, n: i64) -> (usize, usize) {
        let (place, known) = self.corners.at(slot, n);
        if !known {
            let (i, j) = self.corners.places[slot as usize];
            self.meet(i, n);
            let height = self.heights.entry(j);
            let left = height.or_insert_with(|| left(&self.all, j as f64 * self.size, self.depth));
            let waves = [&self.k, &self.omega].map(Vec::as_slice);
            let (line, instant) = (self.lines.at(i), self.instants.at(n));
            let sums = &mut self.corners.numbers[slot as usize][place];
            run(Width::best(), Corners { line, instant, left, waves, sums });
        }
        (slot as usize, place)
    }

    /// Finds the phases of a line and of an instant.
    fn meet(&mut self, i: i64, n: i64) {
        self.lines.meet(i);
        self.instants.meet(n);
    }
}

/// What is left of the waves so far below still water [m], without the short ones that don't get there.
fn left(all: &[Component], down: f64, depth: f64) -> [Row; 2] {
    let at = |k: usize| -> Row { all.iter().map(|c| c.a * c.sigma * c.depths(-down, depth)[k]).collect() };
    let [mut u, mut w] = [at(0), at(1)];
    let most = u.iter().fold(0.0_f64, |m, u| u.abs().max(m));
    let counts = u.iter().rposition(|u| u.abs() > NOTHING * most).map_or(0, |last| last + 1);
    u.truncate(counts);
    w.truncate(counts);
    [filled(u), filled(w)]
}

/// The sine and cosine of the phase at a line and an instant, of the waves from one on.
#[inline(always)]
fn phase<R: Real>(line: &Phases, instant: &Phases, c: usize) -> [R; 2] {
    let [s, co] = [R::read(&line[0][c..]), R::read(&line[1][c..])];
    let [si, ci] = [R::read(&instant[0][c..]), R::read(&instant[1][c..])];
    [s.fma(ci, -(co * si)), co.fma(ci, s * si)]
}

/// The sums of the surface.
struct Tops<'a> {
    line: &'a Phases,
    instant: &'a Phases,
    /// Wavenumbers, frequencies and amplitudes.
    waves: [&'a [f64]; 3],
    sums: &'a mut Top,
}

impl LaneTask for Tops<'_> {
    #[inline(always)]
    fn go<R: Real>(self) {
        let Tops { line, instant, waves: [k, omega, a], sums } = self;
        let mut all = [R::zero(); 6];
        for c in (0..k.len()).step_by(R::LANES) {
            let [sin, cos] = phase::<R>(line, instant, c);
            let [k, omega, a] = [R::read(&k[c..]), R::read(&omega[c..]), R::read(&a[c..])];
            let (cos, sin) = (a * cos, a * sin);
            let (kc, ks) = (k * cos, k * sin);
            all[0] += cos;
            all[1] -= ks;
            all[2] = (-k).fma(kc, all[2]);
            all[3] = omega.fma(sin, all[3]);
            all[4] = omega.fma(kc, all[4]);
            all[5] = (-omega).fma(k * ks, all[5]);
        }
        for i in 0..6 {
            sums[i] = total(all[i]);
        }
    }
}

/// The sums of a corner: of `f = u - i w`, its rate, and the derivatives of both.
struct Corners<'a> {
    line: &'a Phases,
    instant: &'a Phases,
    left: &'a [Row; 2],
    waves: [&'a [f64]; 2],
    sums: &'a mut Corner,
}

impl LaneTask for Corners<'_> {
    #[inline(always)]
    fn go<R: Real>(self) {
        let Corners { line, instant, left: [u, w], waves: [k, omega], sums } = self;
        let mut all = [R::zero(); 8];
        for c in (0..u.len()).step_by(R::LANES) {
            let [sin, cos] = phase::<R>(line, instant, c);
            let (u, w) = (R::read(&u[c..]), R::read(&w[c..]));
            let (k, omega) = (R::read(&k[c..]), R::read(&omega[c..]));
            let (cu, su, cw, sw) = (u * cos, u * sin, w * cos, w * sin);
            all[0] += cu;
            all[1] -= sw;
            all[2] = omega.fma(su, all[2]);
            all[3] = omega.fma(cw, all[3]);
            all[4] = (-k).fma(su, all[4]);
            all[5] = (-k).fma(cw, all[5]);
            all[6] = omega.fma(k * cu, all[6]);
            all[7] = (-omega).fma(k * sw, all[7]);
        }
        for (all, sums) in all.chunks_exact(4).zip(sums.as_chunks_mut::<8>().0) {
            let [f, g, df, dg] = [total(all[0]), total(all[1]), total(all[2]), total(all[3])];
            *sums = [f, g, df, dg, -g, f, -dg, df];
        }
    }
}

/// The sum of all lanes.
#[inline(always)]
fn total<R: Real>(x: R) -> f64 {
    let mut all = [0.0; 8];
    x.write(&mut all);
    ((all[0] + all[1]) + (all[2] + all[3])) + ((all[4] + all[5]) + (all[6] + all[7]))
}
