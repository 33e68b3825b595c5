//! Stations: the points of a body where distributed loads act.
//!
//! Elements offer stations, laws load them, and neither knows the other: N elements and M laws are N + M pieces of
//! code. A law never sees an unknown; an element never sees what kind of load it carries.

use crate::lane::{LaneTask, Pack, Real, V3, Width, run};
use crate::node::{Node, NodeId};
use crate::pattern::Pattern;
use crate::pool::{Batch, Blocks, Local, Seat, Share};
use crate::state::At;
use crate::term::{Assembly, Power, Term, Weights};
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

/// A law of distributed load, such as drag. Write it once over the carrier; add to `out`, don't set it.
pub trait Law: Send + Sync + 'static {
    /// Whether it means nothing for a part without a diameter.
    const NEEDS_DIAMETER: bool = false;
    /// What it is called in manifests and profiles.
    fn label(&self) -> String;
    /// Adds the force per unstretched length at a station, and its derivatives if `TANGENT`.
    fn load<R: Real, const TANGENT: bool>(&self, t: f64, at: &Station<R>, out: &mut Load<R>);
    /// The power of the load `f` per unstretched length [W/m]. By default all of it is supplied from outside.
    fn power(&self, _t: f64, at: &Station<f64>, f: V3<f64>) -> Power {
        Power { supplied: crate::lane::dot(&f, &at.v), ..Power::default() }
    }
}

/// Eight numbers in memory: how stations and loads pass between elements and laws that are compiled apart.
type Wide = Pack<8>;
const STATION: usize = 19;
const LOAD: usize = 39;

impl<R: Real> Station<R> {
    /// A station with every number zero, to be filled.
    #[inline(always)]
    pub fn zero() -> Self {
        Self::of([R::zero(); STATION])
    }
    #[inline(always)]
    fn numbers(&self) -> [R; STATION] {
        let (x, v, a, p, c) = (self.x, self.v, self.a, self.slope, self.curve_v);
        [
            x[0],
            x[1],
            x[2],
            v[0],
            v[1],
            v[2],
            a[0],
            a[1],
            a[2],
            p[0],
            p[1],
            p[2],
            c[0],
            c[1],
            c[2],
            self.s,
            self.weight,
            self.diameter,
            self.area,
        ]
    }
    #[inline(always)]
    fn of(n: [R; STATION]) -> Self {
        Station {
            x: [n[0], n[1], n[2]],
            v: [n[3], n[4], n[5]],
            a: [n[6], n[7], n[8]],
            slope: [n[9], n[10], n[11]],
            curve_v: [n[12], n[13], n[14]],
            s: n[15],
            weight: n[16],
            diameter: n[17],
            area: n[18],
        }
    }
}

/// Stations and loads of a batch, eight lanes to a row.
struct Exchange {
    stations: Vec<[Wide; STATION]>,
    loads: Vec<[Wide; LOAD]>,
}

/// A [`Law`] behind a virtual call that serves a whole batch.
trait ErasedLaw: Send + Sync {
    fn label(&self) -> String;
    fn load(&self, width: Width, t: f64, tangent: bool, x: &mut Exchange, count: usize);
    fn power(&self, t: f64, at: &Station<f64>) -> Power;
}

struct LoadAll<'a, L> {
    law: &'a L,
    t: f64,
    tangent: bool,
    x: &'a mut Exchange,
    count: usize,
}

impl<L: Law> LaneTask for LoadAll<'_, L> {
    #[inline(always)]
    fn go<R: Real>(self) {
        for k in (0..self.count).step_by(R::LANES) {
            let (row, from) = (k / 8, k % 8);
            let n = &self.x.stations[row];
            let at = Station::of(std::array::from_fn(|i| R::each(|l| n[i].0[from + l])));
            let mut load = Load::zero();
            if self.tangent {
                self.law.load::<R, true>(self.t, &at, &mut load);
            } else {
                self.law.load::<R, false>(self.t, &at, &mut load);
            }
            let out = &mut self.x.loads[row];
            let mut put = |i: usize, value: R| {
                for l in 0..R::LANES {
                    out[i].0[from + l] += value.lane(l);
                }
            };
            for i in 0..3 {
                put(i, load.f[i]);
                if self.tangent {
                    for j in 0..3 {
                        put(3 + 3 * i + j, load.d_x[i][j]);
                        put(12 + 3 * i + j, load.d_slope[i][j]);
                        put(21 + 3 * i + j, load.d_v[i][j]);
                        put(30 + 3 * i + j, load.d_a[i][j]);
                    }
                }
            }
        }
    }
}

impl<L: Law> ErasedLaw for L {
    fn label(&self) -> String {
        Law::label(self)
    }
    fn load(&self, width: Width, t: f64, tangent: bool, x: &mut Exchange, count: usize) {
        run(width, LoadAll { law: self, t, tangent, x, count });
    }
    fn power(&self, t: f64, at: &Station<f64>) -> Power {
        let mut load = Load::zero();
        Law::load::<f64, false>(self, t, at, &mut load);
        Law::power(self, t, at, load.f)
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
    /// The stations of an element.
    fn stations<R: Real>(p: &Self::Lanes<R>, x: &Local<R, Q, N>) -> [Station<R>; S];
    /// Subtracts the loads from the residual and, with `TANGENT`, their derivatives from the tangent, each
    /// multiplied by its station's weight; with the geometric part where the way back depends on the coordinates.
    fn spread<R: Real, const TANGENT: bool>(
        p: &Self::Lanes<R>,
        x: &Local<R, Q, N>,
        loads: &[Load<R>; S],
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
        let count = S * R::LANES;
        let mut blocks = Blocks::new();
        let batches = self.pool.elements.chunks(R::LANES).zip(self.pool.seats.chunks(R::LANES));
        for (b, (elements, seats)) in batches.enumerate() {
            let p = E::lanes::<R>(&Batch(elements));
            let x = Seat::gather::<R>(seats, self.at);
            let stations = E::stations(&p, &x);
            for (k, s) in stations.iter().enumerate() {
                let (row, from) = (k * R::LANES / 8, k * R::LANES % 8);
                for (i, n) in s.numbers().into_iter().enumerate() {
                    for l in 0..R::LANES {
                        self.exchange.stations[row][i].0[from + l] = n.lane(l);
                    }
                }
            }
            for row in &mut self.exchange.loads {
                row[..if tangent { LOAD } else { 3 }].fill(Pack([0.0; 8]));
            }
            for law in &self.laws.0 {
                law.load(width, self.at.t, tangent, self.exchange, count);
            }
            // loops: what is inside of array::from_fn would not be compiled for the lanes
            let mut loads = [Load::<R>::zero(); S];
            for (k, load) in loads.iter_mut().enumerate() {
                let (row, from) = (k * R::LANES / 8, k * R::LANES % 8);
                let n = &self.exchange.loads[row];
                for i in 0..3 {
                    load.f[i] = R::each(|l| n[i].0[from + l]);
                }
                if !tangent {
                    continue;
                }
                let matrices = [&mut load.d_x, &mut load.d_slope, &mut load.d_v, &mut load.d_a];
                for (m, matrix) in matrices.into_iter().enumerate() {
                    for i in 0..3 {
                        for j in 0..3 {
                            matrix[i][j] = R::each(|l| n[3 + 9 * m + 3 * i + j].0[from + l]);
                        }
                    }
                }
            }
            let mut share = Share::zero();
            if tangent {
                E::spread::<R, true>(&p, &x, &loads, &w, &mut share);
            } else {
                E::spread::<R, false>(&p, &x, &loads, &w, &mut share);
            }
            Seat::scatter(seats, b * R::LANES, &share, &mut blocks, self.out);
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
            for s in E::stations(&p, &x) {
                f(&s);
            }
        }
    }
    fn add(&self, laws: &Laws, at: &At<'_>, out: &mut Assembly<'_>) {
        thread_local! {
            // kept between calls, so that no step allocates
            static EXCHANGE: std::cell::RefCell<Exchange> =
                const { std::cell::RefCell::new(Exchange { stations: Vec::new(), loads: Vec::new() }) };
        }
        EXCHANGE.with_borrow_mut(|exchange| {
            if exchange.stations.len() < S {
                exchange.stations.resize(S, [Pack([1.0; 8]); STATION]);
                exchange.loads.resize(S, [Pack([0.0; 8]); LOAD]);
            }
            run(out.width(), SpreadAll { pool: self, laws, at, out, exchange });
        });
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
        let mut total = Power::default();
        self.stations.each(at, &mut |s| {
            for law in &self.laws.0 {
                let p = law.power(at.t, s);
                total.dissipated += s.weight * p.dissipated;
                total.supplied += s.weight * p.supplied;
                total.carried += s.weight * p.carried;
            }
        });
        total
    }
}
