//! How stations and loads pass between elements and laws, which are compiled apart: as numbers in memory, a batch at a
//! time.

use super::{Gives, Joined, Law, Load, Station};
use crate::algebra::lane::{LaneTask, Real, V3, Width, run};
use crate::model::term::{Energy, Power};
use std::any::Any;
use std::cell::RefCell;

/// How many numbers make a station, and a load.
pub(super) const STATION: usize = 21;
pub(super) const LOAD: usize = 78;
/// Where the derivatives stand in a load.
const D_X: usize = 3;
const D_SLOPE: usize = 12;
const D_V: usize = 21;
const D_A: usize = 30;
/// From here on only laws with a couple write and read.
const G: usize = 39;
const D_RATE: usize = 42;
const G_X: usize = 51;
const G_SLOPE: usize = 60;
const G_V: usize = 69;

/// Number `i` of a row of numbers over lanes.
#[inline(always)]
fn number<R: Real>(row: &[f64], i: usize) -> R {
    R::read(&row[i * R::LANES..])
}
#[inline(always)]
fn vector<R: Real>(row: &[f64], i: usize) -> V3<R> {
    [number(row, i), number(row, i + 1), number(row, i + 2)]
}
#[inline(always)]
fn put<R: Real, const K: usize>(row: &mut [f64], i: usize, x: &[R; K]) {
    for k in 0..K {
        x[k].write(&mut row[(i + k) * R::LANES..]);
    }
}
/// Adds to numbers of a row if there are some, else sets them.
#[inline(always)]
fn add<R: Real>(row: &mut [f64], i: usize, there: bool, x: &V3<R>) {
    let mut sum = *x;
    if there {
        for k in 0..3 {
            sum[k] += number(row, i + k);
        }
    }
    put(row, i, &sum);
}

#[inline(always)]
fn add_matrix<R: Real>(row: &mut [f64], from: usize, there: bool, x: &[V3<R>; 3]) {
    add(row, from, there, &x[0]);
    add(row, from + 3, there, &x[1]);
    add(row, from + 6, there, &x[2]);
}

impl<R: Real> Station<R> {
    #[inline(always)]
    pub(super) fn write(&self, row: &mut [f64]) {
        put(row, 0, &self.x);
        put(row, 3, &self.v);
        put(row, 6, &self.a);
        put(row, 9, &self.slope);
        put(row, 12, &self.slope_rate);
        put(row, 15, &[self.s, self.weight, self.before, self.element, self.diameter, self.area]);
    }
    #[inline(always)]
    pub(super) fn read(row: &[f64]) -> Self {
        Station {
            x: vector(row, 0),
            v: vector(row, 3),
            a: vector(row, 6),
            slope: vector(row, 9),
            slope_rate: vector(row, 12),
            s: number(row, 15),
            weight: number(row, 16),
            before: number(row, 17),
            element: number(row, 18),
            diameter: number(row, 19),
            area: number(row, 20),
        }
    }
}

impl<R: Real> Load<R> {
    /// Makes the force and what is given zero again: what else a law may have written is never read.
    #[inline(always)]
    fn clear(&mut self, gives: Gives) {
        let none = [[R::zero(); 3]; 3];
        self.f = none[0];
        if gives.x {
            self.d_x = none;
        }
        if gives.slope {
            self.d_slope = none;
        }
        if gives.v {
            self.d_v = none;
        }
        if gives.a {
            self.d_a = none;
        }
        if gives.couple {
            (self.g, self.d_rate) = (none[0], none);
            (self.g_x, self.g_slope, self.g_v) = (none, none, none);
        }
    }
    /// All of it.
    #[inline(always)]
    fn write(&self, row: &mut [f64]) {
        put(row, 0, &self.f);
        put(row, G, &self.g);
        for (first, matrix) in [
            (D_X, &self.d_x),
            (D_SLOPE, &self.d_slope),
            (D_V, &self.d_v),
            (D_A, &self.d_a),
            (D_RATE, &self.d_rate),
            (G_X, &self.g_x),
            (G_SLOPE, &self.g_slope),
            (G_V, &self.g_v),
        ] {
            for i in 0..3 {
                put(row, first + 3 * i, &matrix[i]);
            }
        }
    }
}

/// What laws have put on the stations of an element, over lanes: as [`Load`] has it, read where it stands in memory. Derivatives
/// that aren't given are not to be read.
#[derive(Clone, Copy, Debug)]
pub struct Loads<'a> {
    rows: &'a [f64],
}

/// The load on one station.
#[derive(Clone, Copy, Debug)]
pub struct LoadAt<'a> {
    row: &'a [f64],
}

impl<'a> Loads<'a> {
    /// Those of the rows of a batch.
    pub(super) fn new(rows: &'a [f64]) -> Self {
        Loads { rows }
    }
    /// These loads, written into a room of their own.
    pub fn of<R: Real>(loads: &[Load<R>], room: &'a mut Vec<f64>) -> Self {
        room.resize(loads.len() * LOAD * R::LANES, 0.0);
        for (load, row) in loads.iter().zip(room.chunks_exact_mut(LOAD * R::LANES)) {
            load.write(row);
        }
        Loads { rows: room }
    }
    /// That on station `k`.
    #[inline(always)]
    pub fn at<R: Real>(&self, k: usize) -> LoadAt<'a> {
        LoadAt { row: &self.rows[k * LOAD * R::LANES..(k + 1) * LOAD * R::LANES] }
    }
}

macro_rules! rows_of_matrices {
    ($($(#[$doc:meta])* $name:ident $first:ident)*) => {
        $(
            $(#[$doc])*
            #[inline(always)]
            pub fn $name<R: Real>(&self, i: usize) -> V3<R> {
                vector(self.row, $first + 3 * i)
            }
        )*
    };
}

impl LoadAt<'_> {
    /// [`Load::f`].
    #[inline(always)]
    pub fn f<R: Real>(&self) -> V3<R> {
        vector(self.row, 0)
    }
    /// [`Load::g`].
    #[inline(always)]
    pub fn g<R: Real>(&self) -> V3<R> {
        vector(self.row, G)
    }
    rows_of_matrices! {
        /// A row of [`Load::d_x`].
        d_x D_X
        /// A row of [`Load::d_slope`].
        d_slope D_SLOPE
        /// A row of [`Load::d_v`].
        d_v D_V
        /// A row of [`Load::d_a`].
        d_a D_A
        /// A row of [`Load::d_rate`].
        d_rate D_RATE
        /// A row of [`Load::g_x`].
        g_x G_X
        /// A row of [`Load::g_slope`].
        g_slope G_SLOPE
        /// A row of [`Load::g_v`].
        g_v G_V
    }
}

/// Stations and loads of a batch in memory, a row for each station of an element: how they pass between elements and
/// laws, which are compiled apart.
pub(super) struct Exchange {
    pub stations: Vec<f64>,
    pub loads: Vec<f64>,
    /// Whether a law has been there, and which derivatives have been given so far.
    pub loaded: bool,
    pub given: Gives,
}

impl Exchange {
    /// Makes room for elements of `count` stations.
    pub(super) fn resize<R: Real>(&mut self, count: usize) {
        self.stations.resize(count * STATION * R::LANES, 0.0);
        self.loads.resize(count * LOAD * R::LANES, 0.0);
    }
}

thread_local! {
    // kept between calls, so that no step allocates
    pub(super) static EXCHANGE: RefCell<Exchange> = const {
        RefCell::new(Exchange { stations: Vec::new(), loads: Vec::new(), loaded: false, given: Gives::NOTHING })
    };
}

/// A [`Law`] behind a virtual call that serves a whole batch.
pub(super) trait ErasedLaw: Send + Sync {
    fn label(&self) -> String;
    fn gives(&self) -> Gives;
    /// Loads a batch; `width` must be that of the element's own code.
    fn load(&self, width: Width, t: f64, tangent: bool, x: &mut Exchange);
    /// The power of the loads in the first `lanes` lanes of a batch.
    fn power(&self, width: Width, t: f64, x: &Exchange, lanes: usize) -> Power;
    /// The kinetic and potential energy of the stations in the first `lanes` lanes of a batch.
    fn energy(&self, width: Width, t: f64, x: &Exchange, lanes: usize) -> Energy;
    fn local(&self, quantity: &str, t: f64, at: &Station<f64>) -> Option<f64>;
    fn timed(&self) -> bool;
    fn reach(&self, t: f64, h: f64) -> Option<f64>;
    fn join(&self, other: &dyn Any) -> Option<Joined>;
    fn as_any(&self) -> &dyn Any;
}

struct LoadAll<'a, L> {
    law: &'a L,
    t: f64,
    tangent: bool,
    x: &'a mut Exchange,
}

impl<L: Law> LoadAll<'_, L> {
    #[inline(always)]
    fn all<R: Real, const TANGENT: bool>(self) {
        let (x, all) = (self.x, self.law.gives());
        let gives = if TANGENT { all } else { Gives { couple: all.couple, ..Gives::NOTHING } };
        let rows = x.stations.chunks_exact(STATION * R::LANES).zip(x.loads.chunks_exact_mut(LOAD * R::LANES));
        let mut load = Load::zero();
        for (station, out) in rows {
            load.clear(gives);
            self.law.load::<R, TANGENT>(self.t, &Station::read(station), &mut load);
            add(out, 0, x.loaded, &load.f);
            if gives.x {
                add_matrix(out, D_X, x.given.x, &load.d_x);
            }
            if gives.slope {
                add_matrix(out, D_SLOPE, x.given.slope, &load.d_slope);
            }
            if gives.v {
                add_matrix(out, D_V, x.given.v, &load.d_v);
            }
            if gives.a {
                add_matrix(out, D_A, x.given.a, &load.d_a);
            }
            if gives.couple {
                add(out, G, x.given.couple, &load.g);
            }
            if gives.couple && TANGENT {
                add_matrix(out, D_RATE, x.given.couple, &load.d_rate);
                add_matrix(out, G_X, x.given.couple, &load.g_x);
                add_matrix(out, G_SLOPE, x.given.couple, &load.g_slope);
                add_matrix(out, G_V, x.given.couple, &load.g_v);
            }
        }
        (x.loaded, x.given) = (true, x.given.and(gives));
    }
}

impl<L: Law> LaneTask for LoadAll<'_, L> {
    #[inline(always)]
    fn go<R: Real>(self) {
        if self.tangent { self.all::<R, true>() } else { self.all::<R, false>() }
    }
}

impl<L: Law> ErasedLaw for L {
    fn label(&self) -> String {
        Law::label(self)
    }
    fn gives(&self) -> Gives {
        Law::gives(self)
    }
    fn load(&self, width: Width, t: f64, tangent: bool, x: &mut Exchange) {
        run(width, LoadAll { law: self, t, tangent, x });
    }
    fn power(&self, width: Width, t: f64, x: &Exchange, lanes: usize) -> Power {
        let mut out = Power::default();
        run(width, PowerOf { law: self, t, x, lanes, out: &mut out });
        out
    }
    fn energy(&self, width: Width, t: f64, x: &Exchange, lanes: usize) -> Energy {
        let mut out = Energy::default();
        run(width, EnergyOf { law: self, t, x, lanes, out: &mut out });
        out
    }
    fn local(&self, quantity: &str, t: f64, at: &Station<f64>) -> Option<f64> {
        Law::local(self, quantity, t, at)
    }
    fn timed(&self) -> bool {
        Law::timed(self)
    }
    fn reach(&self, t: f64, h: f64) -> Option<f64> {
        Law::reach(self, t, h)
    }
    fn join(&self, other: &dyn Any) -> Option<Joined> {
        Law::join(self, other)
    }
    fn as_any(&self) -> &dyn Any {
        self
    }
}

struct PowerOf<'a, L> {
    law: &'a L,
    t: f64,
    x: &'a Exchange,
    lanes: usize,
    out: &'a mut Power,
}

impl<L: Law> LaneTask for PowerOf<'_, L> {
    #[inline(always)]
    fn go<R: Real>(self) {
        let (mut sum, mut load) = (Power::<R>::zero(), Load::zero());
        for row in self.x.stations.chunks_exact(STATION * R::LANES) {
            let at = Station::read(row);
            load.clear(Gives::NOTHING);
            load.g = [R::zero(); 3];
            self.law.load::<R, false>(self.t, &at, &mut load);
            let power = self.law.power(self.t, &at, &load);
            sum.dissipated = at.weight.fma(power.dissipated, sum.dissipated);
            sum.supplied = at.weight.fma(power.supplied, sum.supplied);
            sum.carried = at.weight.fma(power.carried, sum.carried);
        }
        for l in 0..self.lanes {
            *self.out += sum.lane(l);
        }
    }
}

struct EnergyOf<'a, L> {
    law: &'a L,
    t: f64,
    x: &'a Exchange,
    lanes: usize,
    out: &'a mut Energy,
}

impl<L: Law> LaneTask for EnergyOf<'_, L> {
    #[inline(always)]
    fn go<R: Real>(self) {
        let (mut kinetic, mut potential) = (R::zero(), R::zero());
        for row in self.x.stations.chunks_exact(STATION * R::LANES) {
            let at = Station::<R>::read(row);
            kinetic = at.weight.fma(self.law.kinetic(self.t, &at), kinetic);
            potential = at.weight.fma(self.law.potential(self.t, &at), potential);
        }
        for l in 0..self.lanes {
            self.out.kinetic += kinetic.lane(l);
            self.out.potential += potential.lane(l);
        }
    }
}
