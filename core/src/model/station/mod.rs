//! Stations: the points of a body where distributed loads act.
//!
//! Elements offer stations, laws load them, and neither knows the other: N elements and M laws are N + M pieces of
//! code. A law never sees an unknown; an element never sees what kind of load it carries.

mod exchange;
mod pool;

pub use pool::StationPool;

use crate::algebra::lane::{Real, V3, dot};
use crate::model::capability::{Shows, Timed};
use crate::model::pattern::Pattern;
use crate::model::pool::{Batch, Local, Share};
use crate::model::state::At;
use crate::model::term::{Assembly, Energy, Power, Term, Weights};
use exchange::ErasedLaw;
use std::any::Any;
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
    /// Its rate `dv/ds` [1/s].
    pub slope_rate: V3<R>,
    /// Arc length from the body's start, unstretched [m].
    pub s: R,
    /// Unstretched length that the station stands for: its cell [m].
    pub weight: R,
    /// How much of its cell lies before it, towards the body's start [m].
    pub before: R,
    /// Unstretched length of the flexible element that it belongs to [m]; 0 of what is rigid.
    pub element: R,
    /// Hydrodynamic diameter [m].
    pub diameter: R,
    /// Area of the displaced volume per length [m²].
    pub area: R,
    /// A number that only this station of the model has, and those beside it in lanes, for laws that remember what they found; 0 if
    /// it has none.
    pub who: usize,
}

impl<R: Real> Station<R> {
    /// A place for one that is to come.
    fn nowhere() -> Self {
        let (zero, none) = (R::zero(), [R::zero(); 3]);
        Station {
            x: none,
            v: none,
            a: none,
            slope: none,
            slope_rate: none,
            s: zero,
            weight: zero,
            before: zero,
            element: zero,
            diameter: zero,
            area: zero,
            who: 0,
        }
    }
}

/// Force per unstretched length on a station [N/m] and what is conjugate to its slope [N], with their derivatives;
/// `d_x[i][j] = ∂f_i/∂x_j`. Their work is `∫ (f·δr + g·δr') ds`.
#[derive(Clone, Copy, Debug)]
pub struct Load<R> {
    /// Force per unstretched length [N/m].
    pub f: V3<R>,
    /// Force conjugate to the slope [N]: across the axis it is a moment per length.
    pub g: V3<R>,
    /// By position.
    pub d_x: [V3<R>; 3],
    /// By slope.
    pub d_slope: [V3<R>; 3],
    /// By velocity.
    pub d_v: [V3<R>; 3],
    /// By acceleration: minus the added mass.
    pub d_a: [V3<R>; 3],
    /// By the rate of the slope.
    pub d_rate: [V3<R>; 3],
    /// Derivatives of `g` by position.
    pub g_x: [V3<R>; 3],
    /// By slope.
    pub g_slope: [V3<R>; 3],
    /// By velocity.
    pub g_v: [V3<R>; 3],
}

impl<R: Real> Load<R> {
    /// Nothing.
    #[inline(always)]
    pub fn zero() -> Self {
        let m = [[R::zero(); 3]; 3];
        Load { f: m[0], g: m[0], d_x: m, d_slope: m, d_v: m, d_a: m, d_rate: m, g_x: m, g_slope: m, g_v: m }
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
    /// By the rate of the slope; and `g` with all of its derivatives.
    pub couple: bool,
}

impl Gives {
    /// None of them.
    pub const NOTHING: Gives = Gives { x: false, slope: false, v: false, a: false, couple: false };
    /// All of them.
    pub const ALL: Gives = Gives { x: true, slope: true, v: true, a: true, couple: true };

    /// Those that a tangent with these weights has a share of.
    #[inline(always)]
    #[must_use]
    fn with(self, w: &Weights) -> Gives {
        let moves = w.q != 0.0 || w.v != 0.0;
        Gives { x: self.x && w.q != 0.0, slope: self.slope && w.q != 0.0, v: self.v && moves, ..self }
    }

    /// Those that the other hasn't.
    #[inline(always)]
    #[must_use]
    fn without(self, other: Gives) -> Gives {
        Gives {
            x: self.x && !other.x,
            slope: self.slope && !other.slope,
            v: self.v && !other.v,
            a: self.a && !other.a,
            couple: self.couple && !other.couple,
        }
    }

    /// Those that either has.
    #[inline(always)]
    #[must_use]
    pub fn and(self, other: Gives) -> Gives {
        Gives {
            x: self.x || other.x,
            slope: self.slope || other.slope,
            v: self.v || other.v,
            a: self.a || other.a,
            couple: self.couple || other.couple,
        }
    }
}

/// A law of distributed load, such as drag. Write it once over the carrier; add to `out`, don't set it.
pub trait Law: Send + Sync + 'static {
    /// Whether it means nothing for a part without a diameter.
    const NEEDS_DIAMETER: bool = false;
    /// What it is called in manifests and profiles.
    fn label(&self) -> String;
    /// Whether it depends on time otherwise than through the state: only then [`Law::reach`] is asked.
    fn timed(&self) -> bool {
        false
    }
    /// How much of a step `h` from `t` may be taken that leaps over nothing, as [`Term::reach`].
    fn reach(&self, _t: f64, _h: f64) -> Option<f64> {
        None
    }
    /// The period with which time makes it go to and fro [s], as [`Timed::period`].
    fn period(&self, _t: f64) -> f64 {
        f64::INFINITY
    }
    /// Whether it asks for the acceleration of the material where that runs along the curve, as on a cable that feeds; else it
    /// is that of the curve, at a fixed distance from the end that feeds.
    fn follows_material(&self) -> bool {
        false
    }
    /// Which derivatives it has; what is left out here is never read. [`check_law`](crate::testing::check_law) tells
    /// if one is missing.
    fn gives(&self) -> Gives {
        Gives::ALL
    }
    /// Adds the force per unstretched length at a station, and its derivatives if `TANGENT`.
    fn load<R: Real, const TANGENT: bool>(&self, t: f64, at: &Station<R>, out: &mut Load<R>);
    /// The same at stations one after the other, for laws that have something to find once for all of them.
    #[inline(always)]
    fn load_all<'a, R: Real, const TANGENT: bool>(
        &self,
        t: f64,
        stations: impl Iterator<Item = (Station<R>, &'a mut Load<R>)>,
    ) {
        for (at, out) in stations {
            self.load::<R, TANGENT>(t, &at, out);
        }
    }
    /// The power of a load per unstretched length [W/m]. By default all of it is supplied from outside.
    #[inline(always)]
    fn power<R: Real>(&self, _t: f64, at: &Station<R>, load: &Load<R>) -> Power<R> {
        Power { supplied: dot(&load.f, &at.v), ..Power::zero() }
    }
    /// The kinetic energy of what it moves besides the body, per unstretched length [J/m]; asked of laws with a couple.
    #[inline(always)]
    fn kinetic<R: Real>(&self, _t: f64, _at: &Station<R>) -> R {
        R::zero()
    }
    /// Its potential energy per unstretched length [J/m], whose forces are then none of its power; asked of laws with a
    /// couple.
    #[inline(always)]
    fn potential<R: Real>(&self, _t: f64, _at: &Station<R>) -> R {
        R::zero()
    }
    /// A quantity of its own there, such as a coefficient that depends on the flow; `None` if it has none of this name. NaN
    /// where it means nothing.
    fn local(&self, _quantity: &str, _t: f64, _at: &Station<f64>) -> Option<f64> {
        None
    }
    /// A law whose loads are those of both, found with less work than one after the other; `None` if it knows none. Asked of the
    /// loads alone: work and energy stay with each.
    fn join(&self, _other: &dyn Any) -> Option<Joined> {
        None
    }
}

/// A law that stands for several, see [`Law::join`].
pub struct Joined(Arc<dyn ErasedLaw>);

impl Joined {
    /// A law in place of those that it has joined.
    pub fn new(law: impl Law) -> Self {
        Joined(Arc::new(law))
    }
}

/// An element that distributed loads can act on: it offers `S` stations and carries their loads back to its nodes.
pub trait StationElement<const Q: usize, const N: usize, const S: usize>:
    Clone + Send + Sync + 'static
{
    /// Whether loads go back to the nodes in the same way whatever the shape: then a load without derivatives has no
    /// tangent.
    const FIXED: bool = false;
    /// Whether it carries what is conjugate to the slope, [`Load::g`].
    const COUPLES: bool = false;
    /// The element's numbers over lanes.
    type Lanes<R: Real>;
    /// Brings the numbers of a batch of elements side by side.
    fn lanes<R: Real>(batch: &Batch<'_, Self>) -> Self::Lanes<R>;
    /// Station `k` of an element, `k < S`.
    fn station<R: Real>(p: &Self::Lanes<R>, x: &Local<R, Q, N>, k: usize) -> Station<R>;
    /// Sets the residual to minus the loads and, with `TANGENT`, the whole of the tangent to minus their derivatives,
    /// each multiplied by its station's weight; with the geometric part where the way back depends on the
    /// coordinates. Derivatives that aren't given are zero, and not to be read.
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
    /// Whether loads go back to the nodes in the same way whatever the shape, see [`StationElement::FIXED`].
    fn fixed(&self) -> bool {
        false
    }
    /// Whether it carries what is conjugate to the slope, see [`StationElement::COUPLES`].
    fn couples(&self) -> bool {
        false
    }
    /// Calls `f` with every station.
    fn each(&self, at: &At<'_>, f: &mut dyn FnMut(&Station<f64>));
    /// The power of all laws.
    fn power(&self, laws: &Laws, at: &At<'_>) -> Power;
    /// The energy of all laws.
    fn energy(&self, laws: &Laws, at: &At<'_>) -> Energy;
    /// Both at once.
    fn balance(&self, laws: &Laws, at: &At<'_>) -> (Energy, Power);
    /// Applies all laws and adds what comes of it.
    fn add(&self, laws: &Laws, at: &At<'_>, out: &mut Assembly<'_>);
    /// Adds what comes of loads that were found elsewhere, one for each station in the order of [`Stations::each`].
    fn spread(&self, loads: &[Load<f64>], gives: Gives, at: &At<'_>, out: &mut Assembly<'_>);
}

/// The laws that act together on the same stations.
#[derive(Clone, Default)]
pub struct Laws {
    all: Vec<Arc<dyn ErasedLaw>>,
    /// What their loads are found by: some of them are joined.
    loads: Vec<Arc<dyn ErasedLaw>>,
}

impl Laws {
    /// Adds a law.
    pub fn push(&mut self, law: impl Law) {
        self.add(Arc::new(law));
    }
    /// Adds the laws of another list.
    pub fn append(&mut self, other: &Laws) {
        other.all.iter().for_each(|law| self.add(law.clone()));
    }
    /// Whether any of them stores energy: most store nothing.
    fn store(&self) -> bool {
        self.all.iter().any(|law| law.gives().couple)
    }
    fn add(&mut self, law: Arc<dyn ErasedLaw>) {
        self.all.push(law.clone());
        for one in &mut self.loads {
            if let Some(Joined(both)) = one.join(law.as_any()) {
                *one = both;
                return;
            }
        }
        self.loads.push(law);
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
        let laws: Vec<String> = self.laws.all.iter().map(|l| l.label()).collect();
        format!("{}: {}", self.part, laws.join(", "))
    }
    fn pattern(&self, p: &mut Pattern) {
        self.stations.pattern(p);
    }
    fn symmetric(&self) -> bool {
        // a dead load has no derivatives at all
        self.stations.fixed() && self.laws.all.iter().all(|l| l.gives() == Gives::NOTHING)
    }
    fn has_tangent(&self, w: &Weights) -> bool {
        let by_acceleration = |gives: Gives| gives.a || gives.couple;
        w.q != 0.0 || w.v != 0.0 || self.laws.all.iter().any(|l| by_acceleration(l.gives()))
    }
    fn is_load(&self) -> bool {
        true
    }
    fn add(&self, at: &At<'_>, out: &mut Assembly<'_>) {
        self.stations.add(&self.laws, at, out);
    }
    fn power(&self, at: &At<'_>) -> Power {
        self.stations.power(&self.laws, at)
    }
    fn energy(&self, at: &At<'_>) -> Energy {
        self.stations.energy(&self.laws, at)
    }
    fn balance(&self, at: &At<'_>) -> (Energy, Power) {
        self.stations.balance(&self.laws, at)
    }
    fn effects(&self) -> Vec<Box<dyn Term>> {
        let one = |law: &Arc<dyn ErasedLaw>| -> Box<dyn Term> {
            let (part, stations) = (self.part.clone(), self.stations.clone());
            Box::new(FieldTerm {
                part,
                stations,
                laws: Laws { all: vec![law.clone()], loads: vec![law.clone()] },
            })
        };
        if self.laws.all.len() > 1 { self.laws.all.iter().map(one).collect() } else { Vec::new() }
    }
    fn timed(&self) -> Option<&dyn Timed> {
        if self.laws.all.iter().any(|l| l.timed()) { Some(self) } else { None }
    }
    fn shows(&self) -> Option<&dyn Shows> {
        Some(self)
    }
}

impl Timed for FieldTerm {
    fn reach(&self, t: f64, h: f64) -> Option<f64> {
        self.laws.all.iter().filter(|l| l.timed()).try_fold(h, |h, l| l.reach(t, h))
    }
    fn period(&self, t: f64) -> f64 {
        self.laws.all.iter().filter(|l| l.timed()).fold(f64::INFINITY, |least, l| least.min(l.period(t)))
    }
}

impl Shows for FieldTerm {
    fn local(&self, quantity: &str, part: &str, s: f64, at: &At<'_>) -> Option<f64> {
        if part != self.part {
            return None;
        }
        // the stations on either side of the place
        let mut beside: [Option<(f64, f64)>; 2] = [None; 2];
        self.stations.each(at, &mut |station| {
            let side = usize::from(station.s > s);
            let nearer = beside[side].is_none_or(|(there, _)| (station.s - s).abs() < (there - s).abs());
            if let Some(c) =
                self.laws.all.iter().find_map(|l| l.local(quantity, at.t, station)).filter(|_| nearer)
            {
                beside[side] = Some((station.s, c));
            }
        });
        match beside {
            [Some((a, low)), Some((b, high))] => Some(low + (high - low) * (s - a) / (b - a)),
            [one, other] => one.or(other).map(|(_, c)| c),
        }
    }
}
