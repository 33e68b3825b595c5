//! Bending with a direction, of a cable through which material flows.

use super::embedding::{Embedding, Grid};
use crate::cable::directed::{
    ANGLES, BUBBLE, BUBBLE_ENERGY, BUBBLE_MASS, COORDINATES, Section, VARIABLES, VELOCITIES, count, dofs,
    twisting,
};
use crate::cable::quadrature::{Point, Points, Quadrature};
use crate::cable::twisting::Twisting;
use ropewalk_core::{Batch, Element, Energy, Local, Power, Real, Share, Weights};

/// What makes the bending of an element like [`FlowCable`](super::FlowCable), which resists it by `EI_e` in every direction, one by
/// `EI_d` about the first director: as [`Directed`](crate::cable::Directed), of a cable that is straight when free of stress.
///
/// Its energy `U = Ĝ(z)/l`, with the slopes, the chord per length and the angles of the material `z` at the nodes, changes with the
/// boundaries by the length and by what they do to `z`. Where strain goes along over an end
/// ([`FlowEnd`](super::FlowEnd)), `(EI_d - EI_e) K_d²/2` per length goes with it. The bubble stays with the element: its inertia
/// `8/15 ρJ l` has a part of its own in the kinetic energy and none that flows.
#[derive(Clone, Copy, Debug)]
pub struct FlowDirected<const F: usize> {
    /// `EI_d - EI_e` [N m²].
    pub more: f64,
    /// Torsional stiffness `GJ` [N m²].
    pub gj: f64,
    /// Its damping of twist, `η GJ` [N m² s].
    pub eta_gj: f64,
    /// Polar moment of inertia per length `ρJ` [kg m].
    pub rho_j: f64,
    /// Where its nodes stand on the material.
    pub by: Embedding<F>,
    /// As of [`FlowTorsion`](super::FlowTorsion).
    pub turns: Embedding<F>,
    /// Whether its start and its end are ends of the line at which strain goes along: 1, else 0.
    pub open: [f64; 2],
    /// Where the curvature is taken.
    pub rule: Points,
}

/// The same over lanes.
#[derive(Clone, Copy, Debug)]
pub struct FlowDirectedLanes<const F: usize, R> {
    more: R,
    gj: R,
    eta_gj: R,
    rho_j: R,
    by: Embedding<F, R>,
    turns: Embedding<F, R>,
    open: [R; 2],
    rule: Points,
}

/// The state of an element of which the material at both nodes is turned against them.
struct Now<R> {
    grid: Grid<R>,
    x: [R; COORDINATES],
    twisting: Twisting<R>,
}

impl<R: Real> Now<R> {
    #[inline(always)]
    fn new(grid: Grid<R>, turns: &Grid<R>, q: &[R]) -> Self {
        let mut x = [R::zero(); COORDINATES];
        x.copy_from_slice(&q[..COORDINATES]);
        x[9] += turns.p;
        x[19] += turns.p + turns.l;
        let twisting = twisting(&x, grid.il);
        Now { grid, x, twisting }
    }

    #[inline(always)]
    fn section(&self, at: &Point) -> Section<R> {
        Section::new(&self.x, &self.twisting, at, self.grid.il)
    }

    #[inline(always)]
    fn potential<const F: usize>(&self, p: &FlowDirectedLanes<F, R>) -> R {
        let mut sum = R::of(BUBBLE_ENERGY) * p.gj * self.grid.il * self.x[20] * self.x[20];
        for at in p.rule.points() {
            let [kd, _] = self.section(at).k;
            sum += R::of(0.5 * at.w) * self.grid.l * p.more * kd * kd;
        }
        sum
    }
}

const ENDS: [Point; 2] = [Point::new(0.0, 1.0), Point::new(1.0, 1.0)];

macro_rules! now {
    ($boundaries:literal, $p:ident, $x:ident) => {{
        let of = |x: &[R], from: usize| -> [R; $boundaries] { std::array::from_fn(|f| x[from + f]) };
        let at = |by: &Embedding<$boundaries, R>| {
            Grid::of(by, of(&$x.q, COORDINATES), of(&$x.v, VELOCITIES), of(&$x.a, VELOCITIES))
        };
        Now::new(at(&$p.by), &at(&$p.turns), &$x.q)
    }};
}

macro_rules! element {
    ($boundaries:literal, $coordinates:literal, $velocities:literal) => {
        impl Element<$coordinates, $velocities> for FlowDirected<$boundaries> {
            type Lanes<R: Real> = FlowDirectedLanes<$boundaries, R>;
            const WIDE: bool = false;

            fn label(&self) -> String {
                format!("flowing bending with a direction {}", self.rule.label())
            }
            fn symmetric(&self) -> bool {
                false
            }
            #[inline(always)]
            fn lanes<R: Real>(batch: &Batch<'_, Self>) -> Self::Lanes<R> {
                FlowDirectedLanes {
                    more: batch.get(|e| e.more),
                    gj: batch.get(|e| e.gj),
                    eta_gj: batch.get(|e| e.eta_gj),
                    rho_j: batch.get(|e| e.rho_j),
                    by: Embedding::lanes(|f, j| batch.get(|e| f(&e.by, j))),
                    turns: Embedding::lanes(|f, j| batch.get(|e| f(&e.turns, j))),
                    open: [batch.get(|e| e.open[0]), batch.get(|e| e.open[1])],
                    rule: batch.first().rule,
                }
            }
            #[inline(always)]
            fn add<R: Real, const TANGENT: bool>(
                p: &Self::Lanes<R>,
                x: &Local<R, $coordinates, $velocities>,
                w: &Weights,
                out: &mut Share<R, $velocities>,
            ) {
                let now = now!($boundaries, p, x);
                let Grid { l, il, ld, .. } = now.grid;
                let (mut f, mut h) = ([R::zero(); VARIABLES], [[R::zero(); VARIABLES]; VARIABLES]);
                for at in p.rule.points() {
                    let section = now.section(at);
                    let m = [p.more * section.k[0], R::zero()];
                    section.add::<TANGENT>(&now.twisting, R::of(at.w) * l, m, p.more, il, &mut f, &mut h);
                }
                let stiff = R::of(2.0 * BUBBLE_ENERGY) * p.gj * il;
                f[BUBBLE] += stiff * x.q[20];
                h[BUBBLE][BUBBLE] += stiff;
                let energy = now.potential(p);
                // what the boundaries do to the variables and to the length
                let (mut by, mut grows) = ([[R::zero(); VARIABLES]; $boundaries], [R::zero(); $boundaries]);
                let delta: [R; 3] = std::array::from_fn(|c| il * (now.x[10 + c] - now.x[c]));
                for k in 0..$boundaries {
                    grows[k] = p.by.by[k][1] - p.by.by[k][0];
                    for c in 0..3 {
                        by[k][3 + c] = -(il * grows[k] * delta[c]);
                    }
                    (by[k][ANGLES], by[k][ANGLES + 1]) = (p.turns.by[k][0], p.turns.by[k][1]);
                }
                let times = |a: &[R; VARIABLES], b: &[R; VARIABLES]| {
                    let mut sum = R::zero();
                    for i in 0..VARIABLES {
                        sum = a[i].fma(b[i], sum);
                    }
                    sum
                };
                for i in 0..VARIABLES {
                    for &(row, share) in &dofs(i, il)[..count(i)] {
                        out.r[row] = share.fma(f[i], out.r[row]);
                    }
                }
                for k in 0..$boundaries {
                    out.r[VELOCITIES + k] += times(&by[k], &f) - energy * il * grows[k];
                }
                // the bubble: damping, and inertia that grows with the element
                let mass = R::of(BUBBLE_MASS[0]) * p.rho_j;
                let damping = R::of(2.0 * BUBBLE_ENERGY) * p.eta_gj;
                let rate = x.v[14];
                let half = R::of(0.5) * mass * ld;
                out.r[14] += mass * l * x.a[14] + (half + damping * il) * rate;
                // what goes along over the ends
                let sign = [p.open[0], -p.open[1]];
                let ends = ENDS.map(|at| {
                    let section = now.section(&at);
                    let (kd, mut f) = (section.k[0], [R::zero(); VARIABLES]);
                    let mut unused = [[R::zero(); VARIABLES]; VARIABLES];
                    let m = [p.more * kd, R::zero()];
                    section.add::<false>(&now.twisting, R::of(1.0), m, p.more, il, &mut f, &mut unused);
                    (R::of(0.5) * p.more * kd * kd, f)
                });
                for (i, (energy, _)) in ends.iter().enumerate() {
                    for k in 0..$boundaries {
                        out.r[VELOCITIES + k] += sign[i] * p.by.by[k][i] * *energy;
                    }
                }
                if !TANGENT {
                    return;
                }
                let (wq, wv, wa) = (R::of(w.q), R::of(w.v), R::of(w.a));
                out.k[14][14] += wa * mass * l + wv * (half + damping * il);
                for k in 0..$boundaries {
                    let more = mass * (wq * x.a[14] + R::of(0.5) * wv * rate) - wq * damping * il * il * rate;
                    out.k[14][VELOCITIES + k] += grows[k] * more;
                }
                for i in 0..VARIABLES {
                    for &(row, share) in &dofs(i, il)[..count(i)] {
                        for j in 0..VARIABLES {
                            for &(column, other) in &dofs(j, il)[..count(j)] {
                                let x = wq * share * other;
                                out.k[row][column] = x.fma(h[i][j], out.k[row][column]);
                            }
                        }
                        for k in 0..$boundaries {
                            let mut more = times(&h[i], &by[k]) - il * grows[k] * f[i];
                            // the shares of positions are those per length
                            if (3..6).contains(&i) {
                                more -= il * grows[k] * f[i];
                            }
                            let x = wq * share * more;
                            out.k[row][VELOCITIES + k] += x;
                            out.k[VELOCITIES + k][row] += x;
                        }
                        for (end, (_, f)) in ends.iter().enumerate() {
                            for k in 0..$boundaries {
                                out.k[VELOCITIES + k][row] += wq * sign[end] * p.by.by[k][end] * share * f[i];
                            }
                        }
                    }
                }
                for k in 0..$boundaries {
                    let mut bent = [R::zero(); VARIABLES];
                    for i in 0..VARIABLES {
                        bent[i] = times(&h[i], &by[k]);
                    }
                    for m in 0..$boundaries {
                        let both = grows[k] * grows[m] * il * il;
                        let mut sum = times(&by[m], &bent) + R::of(2.0) * energy * both;
                        sum -= il * (grows[m] * times(&by[k], &f) + grows[k] * times(&by[m], &f));
                        for c in 0..3 {
                            sum += R::of(2.0) * both * delta[c] * f[3 + c];
                        }
                        for (end, (energy, f)) in ends.iter().enumerate() {
                            let change = times(f, &by[m]) - R::of(2.0) * *energy * il * grows[m];
                            sum += sign[end] * p.by.by[k][end] * change;
                        }
                        out.k[VELOCITIES + k][VELOCITIES + m] += wq * sum;
                    }
                }
            }
            #[inline(always)]
            fn energy<R: Real>(p: &Self::Lanes<R>, x: &Local<R, $coordinates, $velocities>) -> Energy<R> {
                let now = now!($boundaries, p, x);
                let mass = R::of(0.5 * BUBBLE_MASS[0]) * p.rho_j * now.grid.l;
                Energy { kinetic: mass * x.v[14] * x.v[14], potential: now.potential(p) }
            }
            /// What is damped, and what is taken along over the ends.
            #[inline(always)]
            fn power<R: Real>(p: &Self::Lanes<R>, x: &Local<R, $coordinates, $velocities>) -> Power<R> {
                let now = now!($boundaries, p, x);
                let [start, end] = ENDS.map(|at| {
                    let [kd, _] = now.section(&at).k;
                    R::of(0.5) * p.more * kd * kd
                });
                let carried = p.open[1] * end * now.grid.pd[1] - p.open[0] * start * now.grid.pd[0];
                let damping = R::of(2.0 * BUBBLE_ENERGY) * p.eta_gj * now.grid.il;
                Power { dissipated: damping * x.v[14] * x.v[14], carried, ..Power::zero() }
            }
        }
    };
}

element!(1, 22, 16);
element!(2, 23, 17);
