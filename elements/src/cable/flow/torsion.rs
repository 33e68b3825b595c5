//! Torsion of a cable through which material flows: its twist travels with the material.

use super::embedding::{Embedding, Grid};
use crate::cable::torsion::{change, inertia, rate};
use crate::cable::twisting::{COORDINATES, SECOND, Twisting, VELOCITIES, on_dofs, spread};
use ropewalk_core::{Batch, Dual, Element, Energy, Local, Power, Real, Share, Weights};

/// The torsion of an element like [`Torsion`](crate::cable::Torsion) whose nodes move along the material.
///
/// With the twist per length `K = Φ/l`, which is the same all over the element, and the rates `ṗ` of the nodes' material
/// coordinates, the section of the material at a node spins at `ν = w - ṗ K`, linear in between, and that changes by
/// `A = ẇ - p̈ K - ṗ (K̇ + ν')`. The slope `ν'` is other than `K̇` where a curved cable moves out of its plane. So on the
/// spins act `F = S(l) A`, and on the boundaries, as of all forces on the material, `-K F` at each node besides the derivative
/// of the strain energy by the length, `-GJ K²/2`.
///
/// Outside of its ends the cable isn't twisted, and what it is strained by there (`GJ K₀²/2` per length, of one whose stress-free
/// twist isn't zero) is the level that its potential energy is counted from. What is wound on a drum keeps its twist, and takes
/// `GJ K (K/2 - K₀)` per length along. Cable that is pulled over the end of a coil comes with
/// twist all the same, as the section at the end turns against the node while it feeds: `turns`.
#[derive(Clone, Copy, Debug)]
pub struct FlowTorsion<const F: usize> {
    /// Torsional stiffness `GJ` [N m²].
    pub gj: f64,
    /// `η GJ` of its damping [N m² s].
    pub eta_gj: f64,
    /// Polar moment of inertia per length `ρJ` [kg m].
    pub rho_j: f64,
    /// Twist per length when free of stress `K₀` [rad/m].
    pub twist0: f64,
    /// Where its nodes stand on the material.
    pub by: Embedding<F>,
    /// By how much the section of the material at each node is turned about the tangent against that of the node [rad], and how
    /// that changes with the boundaries [rad/m].
    pub turns: Embedding<F>,
    /// Whether material takes the energy of its twist along over each node, as on to a drum: 1, else 0.
    pub wound: [f64; 2],
    /// What resists the spin of the material at each node, where that is at an end that feeds: torque over spin [N m s].
    pub grip: [f64; 2],
}

/// The same over lanes.
#[derive(Clone, Copy, Debug)]
pub struct FlowTorsionLanes<const F: usize, R> {
    gj: R,
    eta_gj: R,
    rho_j: R,
    twist0: R,
    by: Embedding<F, R>,
    turns: Embedding<F, R>,
    wound: [R; 2],
    grip: [R; 2],
}

/// What twist, spin and their rates are at an instant.
#[derive(Clone, Copy)]
struct Motion<R> {
    /// Twist between the nodes, and its rate.
    twist: R,
    rate: R,
    /// Spin of the nodes, and its rate.
    w: [R; 2],
    wd: [R; 2],
    /// The material between them.
    grid: Grid<R>,
    /// What it is turned by against the nodes.
    turns: Grid<R>,
}

impl<R: Real> Motion<R> {
    #[inline(always)]
    fn lifted(&self) -> Motion<Dual<R>> {
        let c = Dual::constant;
        Motion {
            twist: c(self.twist),
            rate: c(self.rate),
            w: self.w.map(c),
            wd: self.wd.map(c),
            grid: self.grid.lifted(),
            turns: self.turns.lifted(),
        }
    }

    /// Twist per length and its rate.
    #[inline(always)]
    fn per_length(&self) -> [R; 2] {
        let k = (self.twist + self.turns.l) * self.grid.il;
        [k, (self.rate + self.turns.ld - k * self.grid.ld) * self.grid.il]
    }

    /// Spin of the material at both nodes.
    #[inline(always)]
    fn spin(&self, k: R) -> [R; 2] {
        let at = |i: usize| self.w[i] + self.turns.pd[i] - self.grid.pd[i] * k;
        [at(0), at(1)]
    }
}

/// Forces on the twist, on the spin of both nodes, and on the boundaries.
struct Forces<const F: usize, R> {
    moment: R,
    spin: [R; 2],
    boundary: [R; F],
}

impl<const F: usize, R: Real> FlowTorsionLanes<F, R> {
    /// At a motion, over the carrier of that.
    #[inline(always)]
    fn forces<S: Real>(&self, m: &Motion<S>, c: impl Fn(R) -> S) -> Forces<F, S> {
        let (gj, eta, rho_j) = (c(self.gj), c(self.eta_gj), c(self.rho_j));
        let [k, kd] = m.per_length();
        let moment = gj * (k - c(self.twist0)) + eta * kd;
        let along = -(k * (S::of(0.5) * gj * k + eta * kd));
        let [va, vb] = m.spin(k);
        let slope = (vb - va) * m.grid.il;
        let at = |i: usize| m.wd[i] + m.turns.pdd[i] - m.grid.pd[i] * (kd + slope) - m.grid.pdd[i] * k;
        let ([own, other], a, b) = (inertia(rho_j * m.grid.l), at(0), at(1));
        // what of this inertia isn't consistent grows with the element too, which keeps the energy
        let grows = S::of(0.125) * rho_j * m.grid.ld * (vb - va);
        let (grip, wound) = (self.grip.map(&c), self.wound.map(&c));
        let taken = k * gj * (S::of(0.5) * k - c(self.twist0));
        let spin = [own * a + other * b - grows + grip[0] * va, own * b + other * a + grows + grip[1] * vb];
        let mut boundary = [S::zero(); F];
        for f in 0..F {
            let (by, turn) = (self.by.by[f].map(&c), self.turns.by[f].map(&c));
            boundary[f] = (by[1] - by[0]) * along
                + (wound[0] * by[0] - wound[1] * by[1]) * taken
                + (turn[1] - turn[0]) * moment
                + spin[0] * (turn[0] - k * by[0])
                + spin[1] * (turn[1] - k * by[1]);
        }
        Forces { moment, spin, boundary }
    }
}

/// The motion of a local state, with the derivatives of the twist.
macro_rules! motion {
    ($boundaries:literal, $p:ident, $x:ident) => {{
        let (grid, turns) = (Grid::behind(&$p.by, $x), Grid::behind(&$p.turns, $x));
        let (mut q, mut v) = ([R::zero(); COORDINATES], [R::zero(); VELOCITIES]);
        q.copy_from_slice(&$x.q[..COORDINATES]);
        v.copy_from_slice(&$x.v[..VELOCITIES]);
        let twisting = Twisting::new(&q, grid.il);
        let g = on_dofs(&twisting.gradient(R::of(1.0), R::of(1.0)), grid.il);
        let (w, wd) = ([v[6], v[SECOND + 6]], [$x.a[6], $x.a[SECOND + 6]]);
        (Motion { twist: twisting.twist, rate: rate(&g, &v), w, wd, grid, turns }, g, twisting)
    }};
}
macro_rules! element {
    ($boundaries:literal, $coordinates:literal, $velocities:literal) => {
        impl Element<$coordinates, $velocities> for FlowTorsion<$boundaries> {
            type Lanes<R: Real> = FlowTorsionLanes<$boundaries, R>;
            const WIDE: bool = false;

            fn label(&self) -> String {
                "flowing torsion".into()
            }
            fn symmetric(&self) -> bool {
                false
            }
            #[inline(always)]
            fn lanes<R: Real>(batch: &Batch<'_, Self>) -> Self::Lanes<R> {
                FlowTorsionLanes {
                    gj: batch.get(|e| e.gj),
                    eta_gj: batch.get(|e| e.eta_gj),
                    rho_j: batch.get(|e| e.rho_j),
                    twist0: batch.get(|e| e.twist0),
                    by: Embedding::lanes(|f, j| batch.get(|e| f(&e.by, j))),
                    turns: Embedding::lanes(|f, j| batch.get(|e| f(&e.turns, j))),
                    wound: [batch.get(|e| e.wound[0]), batch.get(|e| e.wound[1])],
                    grip: [batch.get(|e| e.grip[0]), batch.get(|e| e.grip[1])],
                }
            }
            #[inline(always)]
            fn add<R: Real, const TANGENT: bool>(
                p: &Self::Lanes<R>,
                x: &Local<R, $coordinates, $velocities>,
                w: &Weights,
                out: &mut Share<R, $velocities>,
            ) {
                let (m, g, twisting) = motion!($boundaries, p, x);
                let now = p.forces(&m, |x| x);
                for i in 0..VELOCITIES {
                    out.r[i] = now.moment.fma(g[i], out.r[i]);
                }
                out.r[6] += now.spin[0];
                out.r[SECOND + 6] += now.spin[1];
                for f in 0..$boundaries {
                    out.r[VELOCITIES + f] += now.boundary[f];
                }
                if !TANGENT {
                    return;
                }
                let (wq, wv, wa, one) = (R::of(w.q), R::of(w.v), R::of(w.a), R::of(1.0));
                let mut h = [[[[R::zero(); 3]; 3]; 3]; 3];
                twisting.add_hessian(one, one, &mut h);
                let mut second = [[R::zero(); VELOCITIES]; VELOCITIES];
                spread(&h, m.grid.il, one, &mut second);
                let mut v = [R::zero(); VELOCITIES];
                v.copy_from_slice(&x.v[..VELOCITIES]);
                let by = change(&twisting, &second, &v);
                let seen = |change: &dyn Fn(&mut Motion<Dual<R>>)| {
                    let mut m = m.lifted();
                    change(&mut m);
                    p.forces(&m, Dual::constant)
                };
                let by_twist = seen(&|m| m.twist.eps = one);
                let by_rate = seen(&|m| m.rate.eps = one);
                let by_spin = [0, 1].map(|i| seen(&|m| (m.w[i].eps, m.wd[i].eps) = (wv, wa)));
                // one column after the other: of the increments, then of the boundaries
                for j in 0..$velocities {
                    let mut d = Forces {
                        moment: R::zero(),
                        spin: [R::zero(); 2],
                        boundary: [R::zero(); $boundaries],
                    };
                    let mut add = |by: &Forces<$boundaries, Dual<R>>, s: R| {
                        d.moment += s * by.moment.eps;
                        for i in 0..2 {
                            d.spin[i] += s * by.spin[i].eps;
                        }
                        for f in 0..$boundaries {
                            d.boundary[f] += s * by.boundary[f].eps;
                        }
                    };
                    if j < VELOCITIES {
                        add(&by_twist, wq * g[j]);
                        add(&by_rate, wv.fma(g[j], wq * by[j]));
                        if j % SECOND == 6 {
                            add(&by_spin[j / SECOND], one);
                        }
                    } else {
                        let f = j - VELOCITIES;
                        let moved = |m: &mut Motion<Dual<R>>| {
                            m.grid = Grid::behind(&p.by, x).towards(&p.by, f, w);
                            m.turns = Grid::behind(&p.turns, x).towards(&p.turns, f, w);
                        };
                        add(&seen(&moved), one);
                    }
                    for i in 0..VELOCITIES {
                        out.k[i][j] = d.moment.fma(g[i], out.k[i][j]);
                    }
                    out.k[6][j] += d.spin[0];
                    out.k[SECOND + 6][j] += d.spin[1];
                    for f in 0..$boundaries {
                        out.k[VELOCITIES + f][j] += d.boundary[f];
                    }
                }
                let s = wq * now.moment;
                for i in 0..VELOCITIES {
                    for j in 0..VELOCITIES {
                        out.k[i][j] = s.fma(second[i][j], out.k[i][j]);
                    }
                }
            }
            #[inline(always)]
            fn energy<R: Real>(p: &Self::Lanes<R>, x: &Local<R, $coordinates, $velocities>) -> Energy<R> {
                let (m, _, _) = motion!($boundaries, p, x);
                let (half, [k, _]) = (R::of(0.5), m.per_length());
                let ([own, other], [a, b]) = (inertia(p.rho_j * m.grid.l), m.spin(k));
                Energy {
                    kinetic: half * (own * (a * a + b * b) + R::of(2.0) * other * a * b),
                    potential: p.gj * m.grid.l * k * (half * k - p.twist0),
                }
            }
            /// What is damped, and the energy of spin that material carries over the ends.
            #[inline(always)]
            fn power<R: Real>(p: &Self::Lanes<R>, x: &Local<R, $coordinates, $velocities>) -> Power<R> {
                let (m, _, _) = motion!($boundaries, p, x);
                let [k, kd] = m.per_length();
                let [a, b] = m.spin(k);
                let taken = p.gj * k * (R::of(0.5) * k - p.twist0);
                let carried = R::of(0.5) * p.rho_j * (m.grid.pd[1] * b * b - m.grid.pd[0] * a * a)
                    + taken * (p.wound[1] * m.grid.pd[1] - p.wound[0] * m.grid.pd[0]);
                let slips = p.grip[0] * a * a + p.grip[1] * b * b;
                Power { dissipated: p.eta_gj * m.grid.l * kd * kd + slips, carried, ..Power::zero() }
            }
        }
    };
}

element!(1, 21, 15);
element!(2, 22, 16);
