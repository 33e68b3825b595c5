//! How stations and loads pass between elements and laws, which are compiled apart: through memory, a batch at a time.

use super::{Gives, Joined, Law, Load, Station};
use crate::algebra::lane::{LaneTask, Real, V3, Width, run};
use crate::model::term::{Energy, Power};
use std::any::Any;
use std::cell::RefCell;

/// How many numbers make a station.
pub(super) const STATION: usize = 21;

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
    /// Makes what laws are about to add to zero, derivatives with `TANGENT` alone: what isn't given is never read.
    #[inline(always)]
    fn clear<const TANGENT: bool>(&mut self, force: bool, gives: Gives) {
        let none = [[R::zero(); 3]; 3];
        if force {
            self.f = none[0];
        }
        if gives.couple {
            self.g = none[0];
        }
        if !TANGENT {
            return;
        }
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
            (self.d_rate, self.g_x, self.g_slope, self.g_v) = (none, none, none, none);
        }
    }
}

/// Stations and loads of a batch, one of each for every station of an element: how they pass between elements and laws, which
/// are compiled apart.
pub(super) struct Exchange {
    /// The stations, number by number.
    pub stations: Vec<f64>,
    /// Loads over each of the carriers: lists of [`Load`].
    loads: Vec<Box<dyn Any>>,
    /// Whether a law has been there, and which derivatives have been given so far.
    pub loaded: bool,
    pub given: Gives,
}

/// The list of loads over a carrier.
#[inline(always)]
fn over<R: Real>(loads: &mut Vec<Box<dyn Any>>) -> &mut Vec<Load<R>> {
    let place = loads.iter().position(|list| list.is::<Vec<Load<R>>>()).unwrap_or_else(|| {
        loads.push(Box::new(Vec::<Load<R>>::new()));
        loads.len() - 1
    });
    match loads[place].downcast_mut() {
        Some(list) => list,
        None => unreachable!("it was found by its type"),
    }
}

impl Exchange {
    /// Makes room for elements of `count` stations.
    pub(super) fn resize<R: Real>(&mut self, count: usize) {
        self.stations.resize(count * STATION * R::LANES, 0.0);
        over::<R>(&mut self.loads).resize(count, Load::zero());
    }
    /// What laws have put on the stations of an element.
    #[inline(always)]
    pub(super) fn loads<R: Real>(&mut self) -> &[Load<R>] {
        over(&mut self.loads)
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
        let (law, all) = (self.law, self.law.gives());
        let Exchange { stations, loads, loaded, given } = self.x;
        let gives = if TANGENT { all } else { Gives { couple: all.couple, ..Gives::NOTHING } };
        let (first, fresh) = (!*loaded, gives.without(*given));
        for (station, out) in stations.chunks_exact(STATION * R::LANES).zip(over::<R>(loads)) {
            out.clear::<TANGENT>(first, fresh);
            law.load::<R, TANGENT>(self.t, &Station::read(station), out);
        }
        (*loaded, *given) = (true, given.and(gives));
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
            load.clear::<false>(true, Gives { couple: true, ..Gives::NOTHING });
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
