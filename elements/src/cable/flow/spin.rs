//! Gyroscopic forces of sections that spin about their tangent, of a cable through which material flows.

use super::element::nodal_dual;
use super::embedding::{Embedding, Grid};
use super::transport::Transport;
use crate::cable::torsion::inertia;
use crate::cable::twisting::{COORDINATES, SECOND, Twisting, VELOCITIES, on_dofs, three};
use ropewalk_core::rotation::cross;
use ropewalk_core::{Batch, Dual, Element, Local, Real, Share, V3, Weights, dot};

/// Gyroscopic forces like [`SpinInertia`](crate::cable::SpinInertia) in an element whose nodes move along the material, beside
/// [`FlowTorsion`](super::FlowTorsion).
///
/// They are those of the material at the nodes: with its spin `ν = w - ṗ K` and the rate `ṙ' - ṗ r''` of its slope. Like all forces
/// `F'` on the slope of the material they act on the boundaries by `-r''·F'`. They do no work.
#[derive(Clone, Copy, Debug)]
pub struct FlowSpin<const F: usize> {
    /// Polar moment of inertia per length `ρJ` [kg m].
    pub rho_j: f64,
    /// Where its nodes stand on the material.
    pub by: Embedding<F>,
    /// As of [`FlowTorsion`](super::FlowTorsion).
    pub turns: Embedding<F>,
}

/// The same over lanes.
#[derive(Clone, Copy, Debug)]
pub struct FlowSpinLanes<const F: usize, R> {
    rho_j: R,
    by: Embedding<F, R>,
    turns: Embedding<F, R>,
}

/// What the element does at an instant.
#[derive(Clone, Copy)]
struct Motion<R> {
    e: [V3<R>; 4],
    rate: [V3<R>; 4],
    twist: R,
    w: [R; 2],
    grid: Grid<R>,
    turns: Grid<R>,
}

impl<R: Real> Motion<R> {
    #[inline(always)]
    fn lifted(&self) -> Motion<Dual<R>> {
        Motion {
            e: nodal_dual(&self.e),
            rate: nodal_dual(&self.rate),
            twist: Dual::constant(self.twist),
            w: self.w.map(Dual::constant),
            grid: self.grid.lifted(),
            turns: self.turns.lifted(),
        }
    }

    /// Forces on both slopes, and `r''` there.
    #[inline(always)]
    fn forces(&self, rho_j: R) -> [[V3<R>; 2]; 2] {
        let Motion { e, rate, grid, turns, .. } = self;
        let k = (self.twist + turns.l) * grid.il;
        let spin = [0, 1].map(|i| self.w[i] + turns.pd[i] - grid.pd[i] * k);
        let [own, other] = inertia(rho_j * grid.l);
        let all = Transport::new(grid, e, rate, &[[R::zero(); 3]; 4]);
        let force = [0, 1].map(|i| {
            let momentum = own.fma(spin[i], other * spin[1 - i]);
            let p = &e[2 * i + 1];
            let square = dot(p, p);
            cross(&all.v[2 * i + 1], p).map(|x| momentum * x / (square * square.sqrt()))
        });
        [force, all.bend]
    }
}

macro_rules! element {
    ($boundaries:literal, $coordinates:literal, $velocities:literal) => {
        impl Element<$coordinates, $velocities> for FlowSpin<$boundaries> {
            type Lanes<R: Real> = FlowSpinLanes<$boundaries, R>;
            const WIDE: bool = false;

            fn label(&self) -> String {
                "flowing gyroscopic forces of spin".into()
            }
            fn symmetric(&self) -> bool {
                false
            }
            #[inline(always)]
            fn lanes<R: Real>(batch: &Batch<'_, Self>) -> Self::Lanes<R> {
                FlowSpinLanes {
                    rho_j: batch.get(|e| e.rho_j),
                    by: Embedding::lanes(|f, j| batch.get(|e| f(&e.by, j))),
                    turns: Embedding::lanes(|f, j| batch.get(|e| f(&e.turns, j))),
                }
            }
            #[inline(always)]
            fn add<R: Real, const TANGENT: bool>(
                p: &Self::Lanes<R>,
                x: &Local<R, $coordinates, $velocities>,
                w: &Weights,
                out: &mut Share<R, $velocities>,
            ) {
                let (grid, turns) = (Grid::behind(&p.by, x), Grid::behind(&p.turns, x));
                let mut q = [R::zero(); COORDINATES];
                q.copy_from_slice(&x.q[..COORDINATES]);
                let twisting = Twisting::new(&q, grid.il);
                let m = Motion {
                    e: [0, 3, 10, 13].map(|i| three(&x.q, i)),
                    rate: [0, 3, SECOND, SECOND + 3].map(|i| three(&x.v, i)),
                    twist: twisting.twist,
                    w: [x.v[6], x.v[SECOND + 6]],
                    grid,
                    turns,
                };
                let [force, bend] = m.forces(p.rho_j);
                for i in 0..2 {
                    for c in 0..3 {
                        out.r[SECOND * i + 3 + c] += force[i][c];
                    }
                    for f in 0..$boundaries {
                        out.r[VELOCITIES + f] -= p.by.by[f][i] * dot(&bend[i], &force[i]);
                    }
                }
                if !TANGENT {
                    return;
                }
                let (wq, wv, one) = (R::of(w.q), R::of(w.v), R::of(1.0));
                let g = on_dofs(&twisting.gradient(one, one), grid.il);
                for j in 0..$velocities {
                    let mut seen = m.lifted();
                    if j < VELOCITIES {
                        let (node, i) = (j / SECOND, j % SECOND);
                        seen.twist.eps = wq * g[j];
                        if i == 6 {
                            seen.w[node].eps = wv;
                        } else {
                            seen.e[2 * node + i / 3][i % 3].eps = wq;
                            seen.rate[2 * node + i / 3][i % 3].eps = wv;
                        }
                    } else {
                        seen.grid = grid.towards(&p.by, j - VELOCITIES, w);
                        seen.turns = turns.towards(&p.turns, j - VELOCITIES, w);
                    }
                    let [force, bend] = seen.forces(Dual::constant(p.rho_j));
                    for i in 0..2 {
                        for c in 0..3 {
                            out.k[SECOND * i + 3 + c][j] += force[i][c].eps;
                        }
                        let along = dot(&bend[i], &force[i]).eps;
                        for f in 0..$boundaries {
                            out.k[VELOCITIES + f][j] -= p.by.by[f][i] * along;
                        }
                    }
                }
            }
        }
    };
}

element!(1, 21, 15);
element!(2, 22, 16);
