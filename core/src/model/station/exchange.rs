//! How stations and loads pass between elements and laws, which are compiled apart: through memory, a batch at a time.

use super::{Gives, Joined, Law, Load, Station};
use crate::algebra::lane::{LaneTask, Real, Width, run};
use crate::model::term::{Energy, Power};
use std::any::Any;

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

/// Stations and loads of a batch, one of each for every station of an element. Laws, which are asked by virtual calls, get it without
/// its type, and know that from the width.
pub(super) struct Exchange<R> {
    pub stations: Vec<Station<R>>,
    /// What laws have put on them.
    pub loads: Vec<Load<R>>,
    /// Whether a law has been there, and which derivatives have been given so far.
    pub loaded: bool,
    pub given: Gives,
}

impl<R: Real> Exchange<R> {
    pub fn new() -> Self {
        Exchange { stations: Vec::new(), loads: Vec::new(), loaded: false, given: Gives::NOTHING }
    }

    /// With room for so many stations, on which there is no load yet.
    #[inline(always)]
    pub fn start(&mut self, count: usize) {
        if self.loads.len() != count {
            self.stations.resize(count, Station::nowhere());
            self.loads.resize(count, Load::zero());
        }
        (self.loaded, self.given) = (false, Gives::NOTHING);
    }

    /// That of a caller whose lanes are the same.
    #[inline(always)]
    fn of(any: &mut dyn Any) -> &mut Self {
        match any.downcast_mut() {
            Some(own) => own,
            None => unreachable!("laws and elements go by the same width"),
        }
    }
}

/// A [`Law`] behind a virtual call that serves a whole batch.
pub(super) trait ErasedLaw: Send + Sync {
    fn label(&self) -> String;
    fn gives(&self) -> Gives;
    /// Loads a batch; `width` must be that of the element's own code.
    fn load(&self, width: Width, t: f64, tangent: bool, x: &mut dyn Any);
    /// The power of the loads in the first `lanes` lanes of a batch.
    fn power(&self, width: Width, t: f64, x: &mut dyn Any, lanes: usize) -> Power;
    /// The kinetic and potential energy of the stations in the first `lanes` lanes of a batch.
    fn energy(&self, width: Width, t: f64, x: &mut dyn Any, lanes: usize) -> Energy;
    fn local(&self, quantity: &str, t: f64, at: &Station<f64>) -> Option<f64>;
    fn timed(&self) -> bool;
    fn reach(&self, t: f64, h: f64) -> Option<f64>;
    fn period(&self, t: f64) -> f64;
    fn join(&self, other: &dyn Any) -> Option<Joined>;
    fn as_any(&self) -> &dyn Any;
}

struct LoadAll<'a, L> {
    law: &'a L,
    t: f64,
    tangent: bool,
    x: &'a mut dyn Any,
}

impl<L: Law> LoadAll<'_, L> {
    #[inline(always)]
    fn all<R: Real, const TANGENT: bool>(self) {
        let (law, all) = (self.law, self.law.gives());
        let Exchange::<R> { stations, loads, loaded, given } = Exchange::of(self.x);
        let gives = if TANGENT { all } else { Gives { couple: all.couple, ..Gives::NOTHING } };
        let (first, fresh) = (!*loaded, gives.without(*given));
        let stations = stations.iter().zip(loads.iter_mut());
        law.load_all::<R, TANGENT>(self.t, Cleared::<_, TANGENT> { stations, first, fresh });
        (*loaded, *given) = (true, given.and(gives));
    }
}

/// Stations and what is to be added to, cleared of what nobody has added to yet.
struct Cleared<I, const TANGENT: bool> {
    stations: I,
    first: bool,
    fresh: Gives,
}

impl<'a, R: Real, I, const TANGENT: bool> Iterator for Cleared<I, TANGENT>
where
    I: Iterator<Item = (&'a Station<R>, &'a mut Load<R>)>,
{
    type Item = (Station<R>, &'a mut Load<R>);
    #[inline(always)]
    fn next(&mut self) -> Option<Self::Item> {
        let (station, out) = self.stations.next()?;
        out.clear::<TANGENT>(self.first, self.fresh);
        // a copy, which what is put on it can't change
        Some((*station, out))
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
    fn load(&self, width: Width, t: f64, tangent: bool, x: &mut dyn Any) {
        run(width, LoadAll { law: self, t, tangent, x });
    }
    fn power(&self, width: Width, t: f64, x: &mut dyn Any, lanes: usize) -> Power {
        let mut out = Power::default();
        run(width, PowerOf { law: self, t, x, lanes, out: &mut out });
        out
    }
    fn energy(&self, width: Width, t: f64, x: &mut dyn Any, lanes: usize) -> Energy {
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
    fn period(&self, t: f64) -> f64 {
        Law::period(self, t)
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
    x: &'a mut dyn Any,
    lanes: usize,
    out: &'a mut Power,
}

impl<L: Law> LaneTask for PowerOf<'_, L> {
    #[inline(always)]
    fn go<R: Real>(self) {
        let (mut sum, mut load) = (Power::<R>::zero(), Load::zero());
        for at in &Exchange::<R>::of(self.x).stations {
            load.clear::<false>(true, Gives { couple: true, ..Gives::NOTHING });
            self.law.load::<R, false>(self.t, at, &mut load);
            let power = self.law.power(self.t, at, &load);
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
    x: &'a mut dyn Any,
    lanes: usize,
    out: &'a mut Energy,
}

impl<L: Law> LaneTask for EnergyOf<'_, L> {
    #[inline(always)]
    fn go<R: Real>(self) {
        let (mut kinetic, mut potential) = (R::zero(), R::zero());
        for at in &Exchange::<R>::of(self.x).stations {
            kinetic = at.weight.fma(self.law.kinetic(self.t, at), kinetic);
            potential = at.weight.fma(self.law.potential(self.t, at), potential);
        }
        for l in 0..self.lanes {
            self.out.kinetic += kinetic.lane(l);
            self.out.potential += potential.lane(l);
        }
    }
}
