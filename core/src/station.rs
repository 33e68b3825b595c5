//! Stations: the points of a body where distributed loads act.
//!
//! Elements offer stations, laws load them, and neither knows the other: N elements and M laws are N + M pieces of
//! code. A law never sees an unknown; an element never sees what kind of load it carries.

use crate::lane::{LaneTask, Real, V3, Width, dot, run};
use crate::node::{Node, NodeId};
use crate::pattern::Pattern;
use crate::pool::{Batch, Blocks, Local, Seat, Share};
use crate::state::At;
use crate::term::{Assembly, Power, Term, Weights};
use std::cell::RefCell;
use std::sync::Arc;

/// A point of a body and its motion.
#[derive(Clone, Copy, Debug)]
pub struct Station<R> {
    /// Position [m].
    pub x: V3<R>,
    /// Velocity of the material [m/s].
    pub v: V3<R>,
    /// Acceleration of the material [m/s²].
    pub a: V3<R>,
    /// Slope r' = dr/ds along the body, `|r'|` being the stretch.
    pub slope: V3<R>,
    /// Velocity of the curve that the body draws in space; differs from `v` where material flows along it [m/s].
    pub curve_v: V3<R>,
    /// Arc length from the body's start, unstretched [m].
    pub s: R,
    /// Unstretched length that the station stands for [m].
    pub weight: R,
    /// Hydrodynamic diameter [m].
    pub diameter: R,
    /// Area of the displaced volume per length [m²].
    pub area: R,
}

/// Force per unstretched length on a station [N/m], with its derivatives; `d_x[i][j] = ∂f_i/∂x_j`.
#[derive(Clone, Copy, Debug)]
pub struct Load<R> {
    /// Force per unstretched length [N/m].
    pub f: V3<R>,
    /// By position.
    pub d_x: [V3<R>; 3],
    /// By slope.
    pub d_slope: [V3<R>; 3],
    /// By velocity.
    pub d_v: [V3<R>; 3],
    /// By acceleration: minus the added mass.
    pub d_a: [V3<R>; 3],
}

impl<R: Real> Load<R> {
    /// Nothing.
    #[inline(always)]
    pub fn zero() -> Self {
        let m = [[R::zero(); 3]; 3];
        Load { f: m[0], d_x: m, d_slope: m, d_v: m, d_a: m }
    }
}

/// Which derivatives of a [`Load`] are there; the others are zero.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Gives {
    /// By position.
    pub x: bool,
    /// By slope.
    pub slope: bool,
    /// By velocity.
    pub v: bool,
    /// By acceleration.
    pub a: bool,
}

impl Gives {
    /// None of them.
    pub const NOTHING: Gives = Gives { x: false, slope: false, v: false, a: false };
    /// All of them.
    pub const ALL: Gives = Gives { x: true, slope: true, v: true, a: true };

    #[inline(always)]
    fn and(self, other: Gives) -> Gives {
        Gives {
            x: self.x || other.x,
            slope: self.slope || other.slope,
            v: self.v || other.v,
            a: self.a || other.a,
        }
    }
}

/// A law of distributed load, such as drag. Write it once over the carrier; add to `out`, don't set it.
pub trait Law: Send + Sync + 'static {
    /// Whether it means nothing for a part without a diameter.
    const NEEDS_DIAMETER: bool = false;
    /// What it is called in manifests and profiles.
    fn label(&self) -> String;
    /// Which derivatives it has; what is left out here is never read. [`check_law`](crate::testing::check_law) tells
    /// if one is missing.
    fn gives(&self) -> Gives {
        Gives::ALL
    }
    /// Adds the force per unstretched length at a station, and its derivatives if `TANGENT`.
    fn load<R: Real, const TANGENT: bool>(&self, t: f64, at: &Station<R>, out: &mut Load<R>);
    /// The power of the load `f` per unstretched length [W/m]. By default all of it is supplied from outside.
    #[inline(always)]
    fn power<R: Real>(&self, _t: f64, at: &Station<R>, f: &V3<R>) -> Power<R> {
        Power { supplied: dot(f, &at.v), ..Power::zero() }
    }
}

/// How many numbers make a station, and a load.
const STATION: usize = 19;
const LOAD: usize = 39;
/// Where the derivatives stand in a load.
const D_X: usize = 3;
const D_SLOPE: usize = 12;
const D_V: usize = 21;
const D_A: usize = 30;

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
    fn write(&self, row: &mut [f64]) {
        put(row, 0, &self.x);
        put(row, 3, &self.v);
        put(row, 6, &self.a);
        put(row, 9, &self.slope);
        put(row, 12, &self.curve_v);
        put(row, 15, &[self.s, self.weight, self.diameter, self.area]);
    }
    #[inline(always)]
    fn read(row: &[f64]) -> Self {
        Station {
            x: vector(row, 0),
            v: vector(row, 3),
            a: vector(row, 6),
            slope: vector(row, 9),
            curve_v: vector(row, 12),
            s: number(row, 15),
            weight: number(row, 16),
            diameter: number(row, 17),
            area: number(row, 18),
        }
    }
}

impl<R: Real> Load<R> {
    #[inline(always)]
    fn read(&mut self, row: &[f64], gives: Gives) {
        self.f = vector(row, 0);
        let matrix = |from: usize| [vector(row, from), vector(row, from + 3), vector(row, from + 6)];
        if gives.x {
            self.d_x = matrix(D_X);
        }
        if gives.slope {
            self.d_slope = matrix(D_SLOPE);
        }
        if gives.v {
            self.d_v = matrix(D_V);
        }
        if gives.a {
            self.d_a = matrix(D_A);
        }
    }
}

/// Stations and loads of a batch in memory, a row for each station of an element: how they pass between elements and
/// laws, which are compiled apart.
struct Exchange {
    stations: Vec<f64>,
    loads: Vec<f64>,
    /// Whether a law has been there, and which derivatives have been given so far.
    loaded: bool,
    given: Gives,
}

impl Exchange {
    /// Makes room for elements of `count` stations.
    fn resize<R: Real>(&mut self, count: usize) {
        self.stations.resize(count * STATION * R::LANES, 0.0);
        self.loads.resize(count * LOAD * R::LANES, 0.0);
    }
}

thread_local! {
    // kept between calls, so that no step allocates
    static EXCHANGE: RefCell<Exchange> = const {
        RefCell::new(Exchange { stations: Vec::new(), loads: Vec::new(), loaded: false, given: Gives::NOTHING })
    };
}

/// A [`Law`] behind a virtual call that serves a whole batch.
trait ErasedLaw: Send + Sync {
    fn label(&self) -> String;
    /// Loads a batch; `width` must be that of the element's own code.
    fn load(&self, width: Width, t: f64, tangent: bool, x: &mut Exchange);
    /// The power of the loads in the first `lanes` lanes of a batch.
    fn power(&self, width: Width, t: f64, x: &Exchange, lanes: usize) -> Power;
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
        let (x, gives) = (self.x, if TANGENT { self.law.gives() } else { Gives::NOTHING });
        let rows = x.stations.chunks_exact(STATION * R::LANES).zip(x.loads.chunks_exact_mut(LOAD * R::LANES));
        for (station, out) in rows {
            let mut load = Load::zero();
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
    fn load(&self, width: Width, t: f64, tangent: bool, x: &mut Exchange) {
        run(width, LoadAll { law: self, t, tangent, x });
    }
    fn power(&self, width: Width, t: f64, x: &Exchange, lanes: usize) -> Power {
        let mut out = Power::default();
        run(width, PowerOf { law: self, t, x, lanes, out: &mut out });
        out
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
        let mut sum = Power::<R>::zero();
        for row in self.x.stations.chunks_exact(STATION * R::LANES) {
            let (at, mut load) = (Station::read(row), Load::zero());
            self.law.load::<R, false>(self.t, &at, &mut load);
            let power = self.law.power(self.t, &at, &load.f);
            sum.dissipated = at.weight.fma(power.dissipated, sum.dissipated);
            sum.supplied = at.weight.fma(power.supplied, sum.supplied);
            sum.carried = at.weight.fma(power.carried, sum.carried);
        }
        (0..self.lanes).for_each(|l| *self.out += sum.lane(l));
    }
}

/// An element that distributed loads can act on: it offers `S` stations and carries their loads back to its nodes.
pub trait StationElement<const Q: usize, const N: usize, const S: usize>:
    Clone + Send + Sync + 'static
{
    /// The element's numbers over lanes.
    type Lanes<R: Real>;
    /// Brings the numbers of a batch of elements side by side.
    fn lanes<R: Real>(batch: &Batch<'_, Self>) -> Self::Lanes<R>;
    /// Station `k` of an element, `k < S`.
    fn station<R: Real>(p: &Self::Lanes<R>, x: &Local<R, Q, N>, k: usize) -> Station<R>;
    /// Sets the residual to minus the loads and, with `TANGENT`, the whole of the tangent to minus their derivatives,
    /// each multiplied by its station's weight; with the geometric part where the way back depends on the
    /// coordinates. Derivatives that aren't given are zero and best passed over.
    fn spread<R: Real, const TANGENT: bool>(
        p: &Self::Lanes<R>,
        x: &Local<R, Q, N>,
        loads: &[Load<R>; S],
        gives: Gives,
        w: &Weights,
        out: &mut Share<R, N>,
    );
}

/// The stations of one part of a model, ready to be loaded.
pub trait Stations: Send + Sync {
    /// One clique for each element.
    fn pattern(&self, p: &mut Pattern);
    /// Whether there is anything to load.
    fn is_empty(&self) -> bool;
    /// Calls `f` with every station.
    fn each(&self, at: &At<'_>, f: &mut dyn FnMut(&Station<f64>));
    /// The power of all laws.
    fn power(&self, laws: &Laws, at: &At<'_>) -> Power;
    /// Applies all laws and adds what comes of it.
    fn add(&self, laws: &Laws, at: &At<'_>, out: &mut Assembly<'_>);
}

/// The laws that act together on the same stations.
#[derive(Clone, Default)]
pub struct Laws(Vec<Arc<dyn ErasedLaw>>);

impl Laws {
    /// Adds a law.
    pub fn push(&mut self, law: impl Law) {
        self.0.push(Arc::new(law));
    }
    /// Adds the laws of another list.
    pub fn append(&mut self, other: &Laws) {
        self.0.extend(other.0.iter().cloned());
    }
}

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

#[inline(always)]
fn write_stations<E: StationElement<Q, N, S>, R: Real, const Q: usize, const N: usize, const S: usize>(
    p: &E::Lanes<R>,
    x: &Local<R, Q, N>,
    exchange: &mut Exchange,
) {
    for (k, row) in exchange.stations.chunks_exact_mut(STATION * R::LANES).enumerate() {
        E::station(p, x, k).write(row);
    }
}

struct SpreadAll<'a, 'b, 'c, E, const Q: usize, const N: usize, const S: usize> {
    pool: &'a StationPool<E, Q, N, S>,
    laws: &'a Laws,
    at: &'a At<'a>,
    out: &'b mut Assembly<'c>,
    exchange: &'b mut Exchange,
}

impl<E: StationElement<Q, N, S>, const Q: usize, const N: usize, const S: usize> LaneTask
    for SpreadAll<'_, '_, '_, E, Q, N, S>
{
    #[inline(always)]
    fn go<R: Real>(self) {
        let w = self.out.weights();
        let (tangent, width) = (self.out.wants_tangent(), self.out.width());
        let mut blocks = Blocks::take(self.out);
        self.exchange.resize::<R>(S);
        // derivatives that no law gives stay zero throughout
        let (mut loads, mut share) = ([Load::<R>::zero(); S], Share::zero());
        let batches = self.pool.elements.chunks(R::LANES).zip(self.pool.seats.chunks(R::LANES));
        for (b, (elements, seats)) in batches.enumerate() {
            let p = E::lanes::<R>(&Batch(elements));
            let x = Seat::gather::<R>(seats, self.at);
            write_stations::<E, R, Q, N, S>(&p, &x, self.exchange);
            (self.exchange.loaded, self.exchange.given) = (false, Gives::NOTHING);
            for law in &self.laws.0 {
                law.load(width, self.at.t, tangent, self.exchange);
            }
            let gives = self.exchange.given;
            for (load, row) in loads.iter_mut().zip(self.exchange.loads.chunks_exact(LOAD * R::LANES)) {
                load.read(row, gives);
            }
            if tangent {
                E::spread::<R, true>(&p, &x, &loads, gives, &w, &mut share);
            } else {
                E::spread::<R, false>(&p, &x, &loads, gives, &w, &mut share);
            }
            Seat::scatter(seats, b * R::LANES, &share, &mut blocks, self.out);
        }
        blocks.give_back(self.out);
    }
}

struct PowerAll<'a, E, const Q: usize, const N: usize, const S: usize> {
    pool: &'a StationPool<E, Q, N, S>,
    laws: &'a Laws,
    at: &'a At<'a>,
    total: &'a mut Power,
    exchange: &'a mut Exchange,
}

impl<E: StationElement<Q, N, S>, const Q: usize, const N: usize, const S: usize> LaneTask
    for PowerAll<'_, E, Q, N, S>
{
    #[inline(always)]
    fn go<R: Real>(self) {
        self.exchange.resize::<R>(S);
        for (elements, seats) in self.pool.elements.chunks(R::LANES).zip(self.pool.seats.chunks(R::LANES)) {
            let (p, x) = (E::lanes::<R>(&Batch(elements)), Seat::gather::<R>(seats, self.at));
            write_stations::<E, R, Q, N, S>(&p, &x, self.exchange);
            for law in &self.laws.0 {
                *self.total += law.power(Width::best(), self.at.t, self.exchange, seats.len());
            }
        }
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
    fn each(&self, at: &At<'_>, f: &mut dyn FnMut(&Station<f64>)) {
        for (e, seat) in self.elements.iter().zip(&self.seats) {
            let p = E::lanes::<f64>(&Batch(std::slice::from_ref(e)));
            let x = Seat::gather::<f64>(std::slice::from_ref(seat), at);
            for k in 0..S {
                f(&E::station(&p, &x, k));
            }
        }
    }
    fn add(&self, laws: &Laws, at: &At<'_>, out: &mut Assembly<'_>) {
        if !laws.0.is_empty() {
            EXCHANGE.with_borrow_mut(|exchange| {
                run(out.width(), SpreadAll { pool: self, laws, at, out, exchange });
            });
        }
    }
    fn power(&self, laws: &Laws, at: &At<'_>) -> Power {
        let mut total = Power::default();
        EXCHANGE.with_borrow_mut(|exchange| {
            run(Width::best(), PowerAll { pool: self, laws, at, total: &mut total, exchange });
        });
        total
    }
}

/// The term that applies laws to the stations of a part.
pub struct FieldTerm {
    /// Name of the part.
    pub part: String,
    /// Where the laws act.
    pub stations: Arc<dyn Stations>,
    /// What acts.
    pub laws: Laws,
}

impl Term for FieldTerm {
    fn label(&self) -> String {
        let laws: Vec<String> = self.laws.0.iter().map(|l| l.label()).collect();
        format!("{}: {}", self.part, laws.join(", "))
    }
    fn pattern(&self, p: &mut Pattern) {
        self.stations.pattern(p);
    }
    fn symmetric(&self) -> bool {
        false
    }
    fn add(&self, at: &At<'_>, out: &mut Assembly<'_>) {
        self.stations.add(&self.laws, at, out);
    }
    fn power(&self, at: &At<'_>) -> Power {
        self.stations.power(&self.laws, at)
    }
}
