//! All elements of one type, evaluated over lanes: gather, compute, scatter.

use crate::lane::{LaneTask, Real, Width, run};
use crate::node::{Node, NodeId};
use crate::pattern::Pattern;
use crate::state::{At, Relaxation, Relaxed};
use crate::term::{Assembly, Energy, Power, Term, Weights};

/// What an element sees of the state: its own coordinates, velocities and accelerations.
#[derive(Clone, Copy, Debug)]
pub struct Local<R, const Q: usize, const N: usize> {
    /// Coordinates of its nodes, one node after the other.
    pub q: [R; Q],
    /// Velocities.
    pub v: [R; N],
    /// True accelerations.
    pub a: [R; N],
    /// The last increment of a search for equilibrium; zero in dynamics.
    pub last: [R; N],
    /// How a search for equilibrium wants stiffness to be relaxed; see [`Relaxed`](crate::Relaxed).
    pub relaxed: Option<Relaxation>,
}

/// What an element gives back: its residual and, if wanted, its weighted tangent. Both start at zero.
#[derive(Clone, Copy, Debug)]
pub struct Share<R, const N: usize> {
    /// Residual.
    pub r: [R; N],
    /// `k[i][j]`: row `i`, column `j` of `w.q ∂r/∂q + w.v ∂r/∂v + w.a ∂r/∂v̇`.
    pub k: [[R; N]; N],
}

impl<R: Real, const N: usize> Share<R, N> {
    /// Nothing yet.
    #[inline(always)]
    pub fn zero() -> Self {
        Share { r: [R::zero(); N], k: [[R::zero(); N]; N] }
    }
}

/// Up to one element per lane; a short last batch repeats its last element.
pub struct Batch<'a, E>(pub(crate) &'a [E]);

impl<E> Batch<'_, E> {
    /// The number `f(element)` of each lane's element.
    #[inline(always)]
    pub fn get<R: Real>(&self, f: impl Fn(&E) -> f64) -> R {
        R::each(|l| f(&self.0[l.min(self.0.len() - 1)]))
    }
}

/// An element type: the only trait that a new element writes, unless distributed loads act on it as well
/// ([`StationElement`](crate::StationElement)).
///
/// `Q` coordinates and `N` velocities, over all of its nodes. The source is generic over the carrier [`Real`], so
/// that the same lines run one element or eight; mark the functions `#[inline(always)]`.
///
/// # Example: a spring of rest length `l0` between two points
/// ```
/// use ropewalk_core::{Batch, Element, Energy, Local, Real, Share, Weights, dot};
///
/// #[derive(Clone)]
/// struct Spring { stiffness: f64, l0: f64 }
///
/// impl Element<6, 6> for Spring {
///     type Lanes<R: Real> = [R; 2];
///     fn label() -> String { "spring".into() }
///     #[inline(always)]
///     fn lanes<R: Real>(b: &Batch<'_, Self>) -> [R; 2] { [b.get(|e| e.stiffness), b.get(|e| e.l0)] }
///     #[inline(always)]
///     fn add<R: Real, const TANGENT: bool>(p: &[R; 2], x: &Local<R, 6, 6>, w: &Weights, out: &mut Share<R, 6>) {
///         let d: [R; 3] = std::array::from_fn(|i| x.q[3 + i] - x.q[i]);
///         let length = dot(&d, &d).sqrt();
///         let (force, turn) = (p[0] * (length - p[1]), p[0] * (R::of(1.0) - p[1] / length));
///         for i in 0..3 {
///             out.r[3 + i] += force * d[i] / length;
///             out.r[i] -= force * d[i] / length;
///             for j in 0..3 {
///                 let mut k = (p[0] - turn) * d[i] * d[j] / (length * length);
///                 if i == j { k += turn }
///                 let k = R::of(w.q) * k;
///                 out.k[i][j] += k; out.k[3 + i][3 + j] += k; out.k[i][3 + j] -= k; out.k[3 + i][j] -= k;
///             }
///         }
///     }
///     fn energy(p: &[f64; 2], x: &Local<f64, 6, 6>) -> Energy {
///         let d: [f64; 3] = std::array::from_fn(|i| x.q[3 + i] - x.q[i]);
///         let stretch = dot(&d, &d).sqrt() - p[1];
///         Energy { potential: 0.5 * p[0] * stretch * stretch, ..Energy::default() }
///     }
/// }
/// ```
pub trait Element<const Q: usize, const N: usize>: Clone + Send + Sync + 'static {
    /// The element's numbers over lanes.
    type Lanes<R: Real>;
    /// Whether the tangent is symmetric for every choice of weights.
    const SYMMETRIC: bool = true;
    /// Whether it is worth compiling for several lanes; an element that is rare can do without.
    const WIDE: bool = true;
    /// Whether it sets every entry of its share, so that the pool needn't clear it for each batch.
    const SETS: bool = false;
    /// What the pool is called in manifests and profiles.
    fn label() -> String;
    /// Brings the numbers of a batch of elements side by side.
    fn lanes<R: Real>(batch: &Batch<'_, Self>) -> Self::Lanes<R>;
    /// Adds residual and, with `TANGENT`, the tangent weighted by `w`.
    fn add<R: Real, const TANGENT: bool>(
        p: &Self::Lanes<R>,
        x: &Local<R, Q, N>,
        w: &Weights,
        out: &mut Share<R, N>,
    );
    /// Kinetic and potential energy.
    fn energy(p: &Self::Lanes<f64>, x: &Local<f64, Q, N>) -> Energy;
    /// Power dissipated and supplied.
    fn power(_p: &Self::Lanes<f64>, _x: &Local<f64, Q, N>) -> Power {
        Power::default()
    }
}

/// Where the numbers of one element stand in the vectors of the model.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Seat<const Q: usize, const N: usize> {
    pub q: [u32; Q],
    pub v: [u32; N],
}

impl<const Q: usize, const N: usize> Seat<Q, N> {
    /// The seat of an element on these nodes, or `None` if their kinds don't add up to `Q` and `N`.
    pub fn new(nodes: &[Node], on: &[NodeId]) -> Option<Self> {
        let q: Vec<u32> = on.iter().flat_map(|k| nodes[k.0 as usize].coords()).map(|i| i as u32).collect();
        let v: Vec<u32> = on.iter().flat_map(|k| nodes[k.0 as usize].dofs()).map(|i| i as u32).collect();
        Some(Seat { q: q.try_into().ok()?, v: v.try_into().ok()? })
    }
    /// Gathers the local state of a batch.
    #[inline(always)]
    pub fn gather<R: Real>(seats: &[Self], at: &At<'_>) -> Local<R, Q, N> {
        let last = seats.len() - 1;
        let mut local = Local {
            q: [R::zero(); Q],
            v: [R::zero(); N],
            a: [R::zero(); N],
            last: [R::zero(); N],
            relaxed: at.relaxed.map(|r| r.how),
        };
        for i in 0..Q {
            local.q[i] = R::each(|l| at.q[seats[l.min(last)].q[i] as usize]);
        }
        for i in 0..N {
            local.v[i] = R::each(|l| at.v[seats[l.min(last)].v[i] as usize]);
            local.a[i] = R::each(|l| at.a[seats[l.min(last)].v[i] as usize]);
        }
        if let Some(Relaxed { last: Some(d), .. }) = at.relaxed {
            for i in 0..N {
                local.last[i] = R::each(|l| d[seats[l.min(last)].v[i] as usize]);
            }
        }
        local
    }
    /// Scatters what a batch computed; `first` is the clique of its first element.
    #[inline(always)]
    pub fn scatter<R: Real>(seats: &[Self], first: usize, share: &Share<R, N>, out: &mut Assembly<'_>) {
        for (l, seat) in seats.iter().enumerate() {
            for i in 0..N {
                out.add(seat.v[i] as usize, share.r[i].lane(l));
            }
            out.add_block(first + l, N, |i, j| share.k[i][j].lane(l));
        }
    }
}

/// All elements of one type in a model: the unit of virtual dispatch.
pub struct Pool<E, const Q: usize, const N: usize> {
    elements: Vec<E>,
    seats: Vec<Seat<Q, N>>,
}

impl<E: Element<Q, N>, const Q: usize, const N: usize> Pool<E, Q, N> {
    /// An empty pool.
    pub fn new() -> Self {
        Pool { elements: Vec::new(), seats: Vec::new() }
    }
    /// Adds an element on these nodes. `false` if their coordinates don't add up to `Q` and `N`.
    #[must_use]
    pub fn push(&mut self, nodes: &[Node], element: E, on: &[NodeId]) -> bool {
        let Some(seat) = Seat::new(nodes, on) else { return false };
        self.elements.push(element);
        self.seats.push(seat);
        true
    }
    /// Its elements.
    pub fn elements(&self) -> &[E] {
        &self.elements
    }
    fn sum<T: Default + std::ops::AddAssign>(
        &self,
        at: &At<'_>,
        f: impl Fn(&E::Lanes<f64>, &Local<f64, Q, N>) -> T,
    ) -> T {
        let mut total = T::default();
        for (e, seat) in self.elements.iter().zip(&self.seats) {
            let p = E::lanes::<f64>(&Batch(std::slice::from_ref(e)));
            total += f(&p, &Seat::gather(std::slice::from_ref(seat), at));
        }
        total
    }
}

impl<E: Element<Q, N>, const Q: usize, const N: usize> Default for Pool<E, Q, N> {
    fn default() -> Self {
        Self::new()
    }
}

struct AddAll<'a, 'b, 'c, E, const Q: usize, const N: usize> {
    pool: &'a Pool<E, Q, N>,
    at: &'a At<'a>,
    out: &'b mut Assembly<'c>,
}

impl<E: Element<Q, N>, const Q: usize, const N: usize> LaneTask for AddAll<'_, '_, '_, E, Q, N> {
    const WIDE: bool = E::WIDE;
    #[inline(always)]
    fn go<R: Real>(self) {
        let w = self.out.weights();
        let tangent = self.out.wants_tangent();
        let batches = self.pool.elements.chunks(R::LANES).zip(self.pool.seats.chunks(R::LANES));
        let mut share = Share::zero();
        for (b, (elements, seats)) in batches.enumerate() {
            let p = E::lanes::<R>(&Batch(elements));
            let x = Seat::gather::<R>(seats, self.at);
            if !E::SETS {
                share = Share::zero();
            }
            if tangent {
                E::add::<R, true>(&p, &x, &w, &mut share);
            } else {
                E::add::<R, false>(&p, &x, &w, &mut share);
            }
            Seat::scatter(seats, b * R::LANES, &share, self.out);
        }
    }
}

impl<E: Element<Q, N>, const Q: usize, const N: usize> Term for Pool<E, Q, N> {
    fn label(&self) -> String {
        E::label()
    }
    fn pattern(&self, p: &mut Pattern) {
        for seat in &self.seats {
            p.clique(seat.v.iter().map(|&d| d as usize));
        }
    }
    fn symmetric(&self) -> bool {
        E::SYMMETRIC
    }
    fn add(&self, at: &At<'_>, out: &mut Assembly<'_>) {
        // the search for equilibrium isn't worth wide copies of what it relaxes
        let width = if at.relaxed.is_some() { Width::One } else { out.width() };
        run(width, AddAll { pool: self, at, out });
    }
    fn energy(&self, at: &At<'_>) -> Energy {
        self.sum(at, E::energy)
    }
    fn power(&self, at: &At<'_>) -> Power {
        self.sum(at, E::power)
    }
}
