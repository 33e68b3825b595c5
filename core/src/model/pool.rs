//! All elements of one type, evaluated over lanes: gather, compute, scatter.

use crate::algebra::lane::{LaneTask, Real, Width, run};
use crate::model::node::{Node, NodeId, NodeKind};
use crate::model::pattern::Pattern;
use crate::model::room;
use crate::model::state::{At, Relaxation, Relaxed};
use crate::model::term::{Assembly, Energy, Power, Term, Weights};
use crate::model::twist::PREFIX;
use std::ops::Range;

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
    /// How a search for equilibrium wants stiffness to be relaxed; see [`Relaxed`].
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

impl<'a, E> Batch<'a, E> {
    /// These elements, as many as there are lanes.
    pub fn of(elements: &'a [E]) -> Self {
        Batch(elements)
    }
    /// The element in the first lane, for what all elements of a pool have in common.
    #[inline(always)]
    pub fn first(&self) -> &E {
        &self.0[0]
    }
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
///     fn label(&self) -> String { "spring".into() }
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
///     #[inline(always)]
///     fn energy<R: Real>(p: &[R; 2], x: &Local<R, 6, 6>) -> Energy<R> {
///         let d: [R; 3] = std::array::from_fn(|i| x.q[3 + i] - x.q[i]);
///         let stretch = dot(&d, &d).sqrt() - p[1];
///         Energy { potential: R::of(0.5) * p[0] * stretch * stretch, ..Energy::zero() }
///     }
/// }
/// ```
pub trait Element<const Q: usize, const N: usize>: Clone + Send + Sync + 'static {
    /// The element's numbers over lanes.
    type Lanes<R: Real>;
    /// Whether it is worth compiling for several lanes; an element that is rare can do without.
    const WIDE: bool = true;
    /// Whether it sets every entry of its share, so that the pool needn't clear it for each batch.
    const SETS: bool = false;
    /// What its pool is called in manifests and profiles; elements with other names go into another pool.
    fn label(&self) -> String;
    /// Whether the tangent is symmetric for every choice of weights.
    fn symmetric(&self) -> bool {
        true
    }
    /// Whether its tangent has more than noughts with these weights: else it is asked for its residual alone.
    fn has_tangent(_: &Weights) -> bool {
        true
    }
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
    #[inline(always)]
    fn energy<R: Real>(_p: &Self::Lanes<R>, _x: &Local<R, Q, N>) -> Energy<R> {
        Energy::zero()
    }
    /// Power dissipated and supplied.
    #[inline(always)]
    fn power<R: Real>(_p: &Self::Lanes<R>, _x: &Local<R, Q, N>) -> Power<R> {
        Power::zero()
    }
}

/// Where the numbers of one element stand in the vectors of the model.
#[derive(Clone, Debug)]
pub(crate) struct Seat<const Q: usize, const N: usize> {
    q: Places<Q>,
    pub v: Places<N>,
}

/// Places of `M` numbers in a vector.
#[derive(Clone, Debug)]
pub(crate) enum Places<const M: usize> {
    /// One after the other, as those of two neighbours along a cable.
    From(u32),
    /// Half of them from the first place on, the others from the second: those of two neighbours along a cable whose nodes
    /// have others besides.
    Two(u32, u32),
    /// Anywhere.
    List(Box<[u32; M]>),
}

impl<const M: usize> Places<M> {
    fn new(places: impl Iterator<Item = usize>) -> Option<Self> {
        let list: Vec<u32> = places.map(|i| i as u32).collect();
        let list: Box<[u32; M]> = list.try_into().ok()?;
        let first = list.first().copied().unwrap_or(0);
        let run = |list: &[u32]| list.iter().zip(list[0]..).all(|(&i, k)| i == k);
        let (one, two) = list.split_at(M / 2);
        Some(if M == 0 || run(&list[..]) {
            Places::From(first)
        } else if M.is_multiple_of(2) && run(one) && run(two) {
            Places::Two(one[0], two[0])
        } else {
            Places::List(list)
        })
    }
    /// The place of number `i`.
    #[inline(always)]
    fn at(&self, i: usize) -> usize {
        match self {
            Places::From(first) => *first as usize + i,
            Places::Two(one, _) if i < M / 2 => *one as usize + i,
            Places::Two(_, two) => *two as usize + i - M / 2,
            Places::List(list) => list[i] as usize,
        }
    }
    /// Each of them.
    pub fn iter(&self) -> impl Iterator<Item = usize> + '_ {
        (0..M).map(move |i| self.at(i))
    }
    /// The numbers at the places of each lane, side by side.
    #[inline(always)]
    fn gather<'a, R: Real>(x: &[f64], of: impl Fn(usize) -> &'a Self) -> [R; M] {
        let mut out = [R::zero(); M];
        if let Places::Two(..) = of(0)
            && (0..R::LANES).all(|l| matches!(of(l), Places::Two(..)))
        {
            // two runs, each of them several at a time
            let half = M / 2;
            for second in [false, true] {
                let mut rows: [&[f64]; MOST_LANES] = [&[]; MOST_LANES];
                for l in 0..R::LANES {
                    if let Places::Two(one, two) = of(l) {
                        let first = *(if second { two } else { one }) as usize;
                        rows[l] = &x[first..first + half];
                    }
                }
                let (from, whole) = (if second { half } else { 0 }, half / 4 * 4);
                for j in (0..whole).step_by(4) {
                    let four = R::from_rows(|l| [rows[l][j], rows[l][j + 1], rows[l][j + 2], rows[l][j + 3]]);
                    out[from + j..from + j + 4].copy_from_slice(&four);
                }
                for j in whole..half {
                    out[from + j] = R::each(|l| rows[l][j]);
                }
            }
            return out;
        }
        let mut rows: [&[f64; M]; MOST_LANES] = [&[0.0; M]; MOST_LANES];
        let mut neighbours = true;
        for l in 0..R::LANES {
            match of(l) {
                Places::From(first) => match x[*first as usize..].first_chunk() {
                    Some(row) => rows[l] = row,
                    None => neighbours = false,
                },
                Places::Two(..) | Places::List(_) => neighbours = false,
            }
        }
        if neighbours {
            let whole = M / 4 * 4;
            for j in (0..whole).step_by(4) {
                let four = R::from_rows(|l| [rows[l][j], rows[l][j + 1], rows[l][j + 2], rows[l][j + 3]]);
                out[j..j + 4].copy_from_slice(&four);
            }
            for j in whole..M {
                out[j] = R::each(|l| rows[l][j]);
            }
        } else {
            for (i, out) in out.iter_mut().enumerate() {
                *out = R::each(|l| x[of(l).at(i)]);
            }
        }
        out
    }
}

/// More lanes than this has no processor.
const MOST_LANES: usize = 8;

/// Blocks of tangents on their way out of lanes, one element after the other; kept from call to call.
pub(crate) struct Blocks<const N: usize>(Vec<f64>);

impl<const N: usize> Blocks<N> {
    pub fn take(out: &mut Assembly<'_>) -> Self {
        let mut room = std::mem::take(out.scratch);
        room.resize((MOST_LANES * N * N).max(room.len()), 0.0);
        Blocks(room)
    }
    pub fn give_back(self, out: &mut Assembly<'_>) {
        *out.scratch = self.0;
    }
}

/// Hands out the numbers of each lane, several at a time: `put(lane, first index, numbers)`.
#[inline(always)]
fn unpack<R: Real, const N: usize>(values: &[R; N], mut put: impl FnMut(usize, usize, &[f64])) {
    let whole = N / 4 * 4;
    for j in (0..whole).step_by(4) {
        let four = [values[j], values[j + 1], values[j + 2], values[j + 3]];
        R::to_rows(four, |l, row| put(l, j, &row));
    }
    for j in whole..N {
        for l in 0..R::LANES {
            put(l, j, &[values[j].lane(l)]);
        }
    }
}

impl<const Q: usize, const N: usize> Seat<Q, N> {
    /// The seat of an element on these nodes, or `None` if their kinds don't add up to `Q` and `N`. What knows no twist
    /// sits on position and slope of a node that does.
    pub fn new(nodes: &[Node], on: &[NodeId]) -> Option<Self> {
        let nodes = || on.iter().map(|k| &nodes[k.0 as usize]);
        let whole = || {
            Some(Seat {
                q: Places::new(nodes().flat_map(Node::coords))?,
                v: Places::new(nodes().flat_map(Node::dofs))?,
            })
        };
        let front = |n: &Node, first: usize, all: Range<usize>| match n.kind {
            NodeKind::Twist => first..first + PREFIX,
            _ => all,
        };
        let prefix = || {
            Some(Seat {
                q: Places::new(nodes().flat_map(|n| front(n, n.q, n.coords())))?,
                v: Places::new(nodes().flat_map(|n| front(n, n.v, n.dofs())))?,
            })
        };
        whole().or_else(prefix)
    }
    /// Gathers the local state of a batch.
    #[inline(always)]
    pub fn gather<R: Real>(seats: &[Self], at: &At<'_>) -> Local<R, Q, N> {
        let last = seats.len() - 1;
        Local {
            q: Places::gather(at.q, |l| &seats[l.min(last)].q),
            v: Places::gather(at.v, |l| &seats[l.min(last)].v),
            a: Places::gather(at.a, |l| &seats[l.min(last)].v),
            last: match at.relaxed {
                Some(Relaxed { last: Some(d), .. }) => Places::gather(d, |l| &seats[l.min(last)].v),
                _ => [R::zero(); N],
            },
            relaxed: at.relaxed.map(|r| r.how).filter(Relaxation::relaxes),
        }
    }
    /// Scatters what a batch computed; `first` is the clique of its first element.
    #[inline(always)]
    pub fn scatter<R: Real, const TANGENT: bool>(
        seats: &[Self],
        first: usize,
        share: &Share<R, N>,
        blocks: &mut Blocks<N>,
        out: &mut Assembly<'_>,
    ) {
        let rows = blocks.0.as_chunks_mut::<N>().0;
        unpack(&share.r, |l, j, r| rows[l][j..j + r.len()].copy_from_slice(r));
        for (row, seat) in rows.iter().zip(seats) {
            match &seat.v {
                Places::From(first) => out.add_run(*first as usize, row),
                Places::Two(one, two) => {
                    out.add_slice(*one as usize, &row[..N / 2]);
                    out.add_slice(*two as usize, &row[N / 2..]);
                }
                Places::List(list) => {
                    for i in 0..N {
                        out.add(list[i] as usize, row[i]);
                    }
                }
            }
        }
        if !TANGENT {
            return;
        }
        for i in 0..N {
            unpack(&share.k[i], |l, j, k| rows[l * N + i][j..j + k.len()].copy_from_slice(k));
        }
        for l in 0..seats.len() {
            if let Some(k) = rows[l * N..].first_chunk::<N>() {
                out.add_square(first + l, k);
            }
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
        if self.out.wants_tangent() && E::has_tangent(&self.out.weights()) {
            self.add_all::<R, true>();
        } else {
            self.add_all::<R, false>();
        }
    }
}

impl<E: Element<Q, N>, const Q: usize, const N: usize> AddAll<'_, '_, '_, E, Q, N> {
    #[inline(always)]
    fn add_all<R: Real, const TANGENT: bool>(self) {
        let w = self.out.weights();
        let mut blocks = Blocks::take(self.out);
        let batches = self.pool.elements.chunks(R::LANES).zip(self.pool.seats.chunks(R::LANES));
        let mut share = room::take(Share::zero);
        for (b, (elements, seats)) in batches.enumerate() {
            let p = E::lanes::<R>(&Batch(elements));
            let x = Seat::gather::<R>(seats, self.at);
            if !E::SETS {
                share.r = [R::zero(); N];
            }
            if !E::SETS && TANGENT {
                share.k = [[R::zero(); N]; N];
            }
            E::add::<R, TANGENT>(&p, &x, &w, &mut share);
            Seat::scatter::<R, TANGENT>(seats, b * R::LANES, &share, &mut blocks, self.out);
        }
        room::give_back(share);
        blocks.give_back(self.out);
    }
}

/// Energy and power of all elements, for the audit.
struct Sum<'a, E, const Q: usize, const N: usize> {
    pool: &'a Pool<E, Q, N>,
    at: &'a At<'a>,
    energy: Option<&'a mut Energy>,
    power: Option<&'a mut Power>,
}

impl<E: Element<Q, N>, const Q: usize, const N: usize> LaneTask for Sum<'_, E, Q, N> {
    const WIDE: bool = E::WIDE;
    #[inline(always)]
    fn go<R: Real>(mut self) {
        for (elements, seats) in self.pool.elements.chunks(R::LANES).zip(self.pool.seats.chunks(R::LANES)) {
            let p = E::lanes::<R>(&Batch(elements));
            let x = Seat::gather::<R>(seats, self.at);
            if let Some(total) = self.energy.as_deref_mut() {
                let energy = E::energy(&p, &x);
                for l in 0..seats.len() {
                    *total += energy.lane(l);
                }
            }
            if let Some(total) = self.power.as_deref_mut() {
                let power = E::power(&p, &x);
                for l in 0..seats.len() {
                    *total += power.lane(l);
                }
            }
        }
    }
}

impl<E: Element<Q, N>, const Q: usize, const N: usize> Pool<E, Q, N> {
    fn sum(&self, at: &At<'_>, energy: Option<&mut Energy>, power: Option<&mut Power>) {
        run(Width::best().enough_for(self.elements.len()), Sum { pool: self, at, energy, power });
    }
}

impl<E: Element<Q, N>, const Q: usize, const N: usize> Term for Pool<E, Q, N> {
    fn label(&self) -> String {
        self.elements.first().map_or_else(String::new, E::label)
    }
    fn pattern(&self, p: &mut Pattern) {
        for seat in &self.seats {
            p.clique(seat.v.iter());
        }
    }
    fn symmetric(&self) -> bool {
        self.elements.iter().all(E::symmetric)
    }
    fn has_tangent(&self, w: &Weights) -> bool {
        E::has_tangent(w)
    }
    fn add(&self, at: &At<'_>, out: &mut Assembly<'_>) {
        // the search for equilibrium isn't worth wide copies of what it relaxes
        let relaxes = at.relaxed.is_some_and(|r| r.how.relaxes());
        let width = if relaxes { Width::One } else { out.width().enough_for(self.elements.len()) };
        run(width, AddAll { pool: self, at, out });
    }
    fn energy(&self, at: &At<'_>) -> Energy {
        let mut energy = Energy::default();
        self.sum(at, Some(&mut energy), None);
        energy
    }
    fn power(&self, at: &At<'_>) -> Power {
        let mut power = Power::default();
        self.sum(at, None, Some(&mut power));
        power
    }
}
