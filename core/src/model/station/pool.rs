//! All stations of one part: evaluated over lanes, loaded by every law, and carried back to the nodes.

use super::exchange::Exchange;
use super::{Gives, Laws, Load, Station, StationElement, Stations};
use crate::algebra::lane::{LaneTask, Real, Width, run};
use crate::model::node::{Node, NodeId};
use crate::model::pattern::Pattern;
use crate::model::pool::{Batch, Blocks, Local, Seat, Share};
use crate::model::room;
use crate::model::state::At;
use crate::model::term::{Assembly, Energy, Power};

/// All stations of one part, element by element.
pub struct StationPool<E, const Q: usize, const N: usize, const S: usize> {
    elements: Vec<E>,
    seats: Vec<Seat<Q, N>>,
}

impl<E: StationElement<Q, N, S>, const Q: usize, const N: usize, const S: usize> StationPool<E, Q, N, S> {
    /// An empty pool.
    pub fn new() -> Self {
        StationPool { elements: Vec::new(), seats: Vec::new() }
    }
    /// Adds up what is asked for.
    fn work(&self, laws: &Laws, at: &At<'_>, power: Option<&mut Power>, energy: Option<&mut Energy>) {
        let width = self.width(Width::best());
        run(width, WorkAll { pool: self, laws, at, width, power, energy });
    }
    /// The width that is worth while for its elements.
    fn width(&self, most: Width) -> Width {
        most.enough_for(self.elements.len())
    }
    /// Adds an element on these nodes. `false` if their coordinates don't add up to `Q` and `N`.
    #[must_use]
    pub fn push(&mut self, nodes: &[Node], element: E, on: &[NodeId]) -> bool {
        let Some(seat) = Seat::new(nodes, on) else { return false };
        self.elements.push(element);
        self.seats.push(seat);
        true
    }
}

impl<E: StationElement<Q, N, S>, const Q: usize, const N: usize, const S: usize> Default
    for StationPool<E, Q, N, S>
{
    fn default() -> Self {
        Self::new()
    }
}

/// Puts the stations of elements side by side into an exchange.
#[inline(always)]
fn meet<E: StationElement<Q, N, S>, R: Real, const Q: usize, const N: usize, const S: usize>(
    p: &E::Lanes<R>,
    x: &Local<R, Q, N>,
    seats: &[Seat<Q, N>],
    exchange: &mut Exchange<R>,
) {
    exchange.start(S);
    for (k, station) in exchange.stations.iter_mut().enumerate().take(S) {
        *station = E::station(p, x, k);
        station.who = who(seats, k);
    }
}

/// What tells a station from all others: its number, and where the seat of its element is in memory; two pools may have one on the
/// same nodes.
#[inline(always)]
fn who<const Q: usize, const N: usize>(seats: &[Seat<Q, N>], k: usize) -> usize {
    seats.as_ptr() as usize + k
}

struct SpreadAll<'a, 'b, 'c, E, const Q: usize, const N: usize, const S: usize> {
    pool: &'a StationPool<E, Q, N, S>,
    laws: &'a Laws,
    at: &'a At<'a>,
    width: Width,
    out: &'b mut Assembly<'c>,
}

impl<E: StationElement<Q, N, S>, const Q: usize, const N: usize, const S: usize> LaneTask
    for SpreadAll<'_, '_, '_, E, Q, N, S>
{
    #[inline(always)]
    fn go<R: Real>(self) {
        if self.out.wants_tangent() {
            self.spread_all::<R, true>();
        } else {
            self.spread_all::<R, false>();
        }
    }
}

impl<E: StationElement<Q, N, S>, const Q: usize, const N: usize, const S: usize>
    SpreadAll<'_, '_, '_, E, Q, N, S>
{
    #[inline(always)]
    fn spread_all<R: Real, const TANGENT: bool>(self) {
        let w = self.out.weights();
        let mut blocks = Blocks::take(self.out);
        let (mut share, mut exchange) = (room::take(Share::zero), room::take(Exchange::<R>::new));
        let batches = self.pool.elements.chunks(R::LANES).zip(self.pool.seats.chunks(R::LANES));
        for (b, (elements, seats)) in batches.enumerate() {
            let p = E::lanes::<R>(&Batch(elements));
            let x = Seat::gather::<R>(seats, self.at);
            meet::<E, R, Q, N, S>(&p, &x, seats, &mut exchange);
            for law in &self.laws.loads {
                law.load(self.width, self.at.t, TANGENT, &mut *exchange);
            }
            let gives = exchange.given.with(&w);
            if let Some(loads) = exchange.loads.first_chunk() {
                E::spread::<R, TANGENT>(&p, &x, loads, gives, &w, &mut share);
            }
            Seat::scatter::<R, TANGENT>(seats, b * R::LANES, &share, &mut blocks, self.out);
        }
        room::give_back(share);
        room::give_back(exchange);
        blocks.give_back(self.out);
    }
}

/// Power and energy of all laws.
struct WorkAll<'a, E, const Q: usize, const N: usize, const S: usize> {
    pool: &'a StationPool<E, Q, N, S>,
    laws: &'a Laws,
    at: &'a At<'a>,
    width: Width,
    power: Option<&'a mut Power>,
    energy: Option<&'a mut Energy>,
}

impl<E: StationElement<Q, N, S>, const Q: usize, const N: usize, const S: usize> LaneTask
    for WorkAll<'_, E, Q, N, S>
{
    #[inline(always)]
    fn go<R: Real>(mut self) {
        let mut exchange = room::take(Exchange::<R>::new);
        for (elements, seats) in self.pool.elements.chunks(R::LANES).zip(self.pool.seats.chunks(R::LANES)) {
            let (p, x) = (E::lanes::<R>(&Batch(elements)), Seat::gather::<R>(seats, self.at));
            meet::<E, R, Q, N, S>(&p, &x, seats, &mut exchange);
            for law in &self.laws.all {
                if let Some(total) = &mut self.power {
                    **total += law.power(self.width, self.at.t, &mut *exchange, seats.len());
                }
                if let Some(total) = &mut self.energy {
                    **total += law.energy(self.width, self.at.t, &mut *exchange, seats.len());
                }
            }
        }
        room::give_back(exchange);
    }
}

impl<E: StationElement<Q, N, S>, const Q: usize, const N: usize, const S: usize> Stations
    for StationPool<E, Q, N, S>
{
    fn pattern(&self, p: &mut Pattern) {
        for seat in &self.seats {
            p.clique(seat.v.iter());
        }
    }
    fn is_empty(&self) -> bool {
        self.elements.is_empty()
    }
    fn fixed(&self) -> bool {
        E::FIXED
    }
    fn couples(&self) -> bool {
        E::COUPLES
    }
    fn each(&self, at: &At<'_>, f: &mut dyn FnMut(&Station<f64>)) {
        for (e, seat) in self.elements.iter().zip(&self.seats) {
            let p = E::lanes::<f64>(&Batch(std::slice::from_ref(e)));
            let x = Seat::gather::<f64>(std::slice::from_ref(seat), at);
            for k in 0..S {
                f(&Station { who: who(std::slice::from_ref(seat), k), ..E::station(&p, &x, k) });
            }
        }
    }
    fn add(&self, laws: &Laws, at: &At<'_>, out: &mut Assembly<'_>) {
        if !laws.all.is_empty() {
            let width = self.width(out.width());
            run(width, SpreadAll { pool: self, laws, at, width, out });
        }
    }
    fn spread(&self, loads: &[Load<f64>], gives: Gives, at: &At<'_>, out: &mut Assembly<'_>) {
        let (w, tangent) = (out.weights(), out.wants_tangent());
        let mut blocks = Blocks::take(out);
        let mut share = Share::zero();
        for (e, (element, loads)) in self.elements.iter().zip(loads.as_chunks::<S>().0).enumerate() {
            let seats = std::slice::from_ref(&self.seats[e]);
            let p = E::lanes::<f64>(&Batch(std::slice::from_ref(element)));
            let x = Seat::gather::<f64>(seats, at);
            if tangent {
                E::spread::<f64, true>(&p, &x, loads, gives, &w, &mut share);
                Seat::scatter::<f64, true>(seats, e, &share, &mut blocks, out);
            } else {
                E::spread::<f64, false>(&p, &x, loads, gives, &w, &mut share);
                Seat::scatter::<f64, false>(seats, e, &share, &mut blocks, out);
            }
        }
        blocks.give_back(out);
    }
    fn power(&self, laws: &Laws, at: &At<'_>) -> Power {
        let mut total = Power::default();
        self.work(laws, at, Some(&mut total), None);
        total
    }
    fn energy(&self, laws: &Laws, at: &At<'_>) -> Energy {
        let mut total = Energy::default();
        if laws.store() {
            self.work(laws, at, None, Some(&mut total));
        }
        total
    }
    fn balance(&self, laws: &Laws, at: &At<'_>) -> (Energy, Power) {
        let (mut energy, mut power) = (Energy::default(), Power::default());
        self.work(laws, at, Some(&mut power), laws.store().then_some(&mut energy));
        (energy, power)
    }
}
