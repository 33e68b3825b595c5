//! Torque and tension of a laid rope through which material flows.

use super::embedding::{Embedding, Grid};
use crate::cable::quadrature::Point;
use crate::cable::torque_tension::{AT, slope};
use crate::cable::twisting::{COORDINATES, Twisting, VELOCITIES, on_dofs, spread, three};
use ropewalk_core::{Batch, Element, Energy, Local, Power, Real, Share, V3, Weights, dot};

/// What couples torque and tension in an element like [`TorqueTension`](crate::cable::TorqueTension) whose nodes move along the
/// material. It stands beside [`FlowTorsion`](super::FlowTorsion) and elements of axial stiffness `EA - C²/GJ`.
///
/// With `λ = C/GJ`, the twist `Φ` of the material and its mean strain `ε̄` the energy of both is that of the torsion and
/// `U = C (ε̄ (Φ - K₀ l) + λ l ε̄²/2)`, whose derivatives by increments and boundaries are the forces. Outside of its ends the rope
/// isn't twisted. Where it takes its strain along ([`FlowEnd`](super::FlowEnd)) it takes `W = C (λ ε²/2 - K₀ ε)` per length with it,
/// with the strain `ε` at the end.
#[derive(Clone, Copy, Debug)]
pub struct FlowTorqueTension<const F: usize> {
    /// Torsional stiffness `GJ` [N m²].
    pub gj: f64,
    /// `C/GJ` [1/m].
    pub lay: f64,
    /// Twist per length when free of stress `K₀` [rad/m].
    pub twist0: f64,
    /// Where its nodes stand on the material.
    pub by: Embedding<F>,
    /// As of [`FlowTorsion`](super::FlowTorsion).
    pub turns: Embedding<F>,
    /// Whether its start and its end are ends of the line at which strain goes along: 1, else 0.
    pub open: [f64; 2],
    /// Where the strain is taken.
    pub points: &'static [Point],
}

/// The same over lanes.
#[derive(Clone, Copy, Debug)]
pub struct FlowTorqueTensionLanes<const F: usize, R> {
    gj: R,
    lay: R,
    twist0: R,
    by: Embedding<F, R>,
    turns: Embedding<F, R>,
    open: [R; 2],
    points: &'static [Point],
}

/// Slope at a point of an element: its direction, one over its size, its shares of the four vectors, and how it changes with
/// the length of the element.
struct Stretch<R> {
    t: V3<R>,
    inverse: R,
    by: [R; 4],
    by_l: V3<R>,
}

impl<R: Real> Stretch<R> {
    #[inline(always)]
    fn new(q: &[R; COORDINATES], at: &Point, il: R) -> Self {
        let (p, inverse, by) = slope(q, at, il);
        let by_l = std::array::from_fn(|c| -(il * by[2] * (q[10 + c] - q[c])));
        Stretch { t: p.map(|p| inverse * p), inverse, by, by_l }
    }
}

/// Strain at either end.
#[inline(always)]
fn at_ends<R: Real>(q: &[R; COORDINATES]) -> [(V3<R>, R); 2] {
    [3, 13].map(|at| {
        let p = three(q, at);
        let size = dot(&p, &p).sqrt();
        (p.map(|p| p / size), size - R::of(1.0))
    })
}

impl<const F: usize, R: Real> FlowTorqueTensionLanes<F, R> {
    /// What goes along over an end with this strain, per length.
    #[inline(always)]
    fn density(&self, strain: R) -> R {
        self.gj * self.lay * strain * (R::of(0.5) * self.lay * strain - self.twist0)
    }
}

/// Twist beyond the stress-free one, mean strain, and the nodes' coordinates.
macro_rules! strained {
    ($boundaries:literal, $p:ident, $x:ident) => {{
        let (grid, turns) = (Grid::behind(&$p.by, $x), Grid::behind(&$p.turns, $x));
        let mut q = [R::zero(); COORDINATES];
        q.copy_from_slice(&$x.q[..COORDINATES]);
        let twisting = Twisting::new(&q, grid.il);
        let twist = twisting.twist + turns.l - $p.twist0 * grid.l;
        let mut strain = R::zero();
        for at in $p.points {
            let (_, inverse, _) = slope(&q, at, grid.il);
            strain += R::of(at.w) * (R::of(1.0) / inverse - R::of(1.0));
        }
        (grid, q, twisting, twist, strain)
    }};
}

macro_rules! element {
    ($boundaries:literal, $coordinates:literal, $velocities:literal) => {
        impl Element<$coordinates, $velocities> for FlowTorqueTension<$boundaries> {
            type Lanes<R: Real> = FlowTorqueTensionLanes<$boundaries, R>;
            const WIDE: bool = false;

            fn label(&self) -> String {
                "flowing torsion with tension".into()
            }
            fn symmetric(&self) -> bool {
                false
            }
            #[inline(always)]
            fn lanes<R: Real>(batch: &Batch<'_, Self>) -> Self::Lanes<R> {
                FlowTorqueTensionLanes {
                    gj: batch.get(|e| e.gj),
                    lay: batch.get(|e| e.lay),
                    twist0: batch.get(|e| e.twist0),
                    by: Embedding::lanes(|f, j| batch.get(|e| f(&e.by, j))),
                    turns: Embedding::lanes(|f, j| batch.get(|e| f(&e.turns, j))),
                    open: [batch.get(|e| e.open[0]), batch.get(|e| e.open[1])],
                    points: batch.first().points,
                }
            }
            #[inline(always)]
            fn add<R: Real, const TANGENT: bool>(
                p: &Self::Lanes<R>,
                x: &Local<R, $coordinates, $velocities>,
                w: &Weights,
                out: &mut Share<R, $velocities>,
            ) {
                let (grid, q, twisting, twist, strain) = strained!($boundaries, p, x);
                let (il, one, half) = (grid.il, R::of(1.0), R::of(0.5));
                let grows: [R; $boundaries] = std::array::from_fn(|f| p.by.by[f][1] - p.by.by[f][0]);
                // derivatives of twist, strain and length
                let (mut of_twist, mut of_strain, mut of_l) =
                    ([R::zero(); $velocities], [R::zero(); $velocities], [R::zero(); $velocities]);
                of_twist[..VELOCITIES].copy_from_slice(&on_dofs(&twisting.gradient(one, one), il));
                for at in p.points {
                    let (s, weight) = (Stretch::new(&q, at, il), R::of(at.w));
                    for (n, [_, row]) in AT.into_iter().enumerate() {
                        for c in 0..3 {
                            of_strain[row + c] += weight * s.by[n] * s.t[c];
                        }
                    }
                    for f in 0..$boundaries {
                        of_strain[VELOCITIES + f] += weight * grows[f] * dot(&s.t, &s.by_l);
                    }
                }
                for f in 0..$boundaries {
                    let turn = p.turns.by[f][1] - p.turns.by[f][0];
                    of_twist[VELOCITIES + f] = turn - p.twist0 * grows[f];
                    of_l[VELOCITIES + f] = grows[f];
                }
                let c = p.gj * p.lay;
                let (by_strain, by_l) = (twist + p.lay * grid.l * strain, half * p.lay * strain * strain);
                for i in 0..$velocities {
                    out.r[i] += c * (by_strain * of_strain[i] + strain * of_twist[i] + by_l * of_l[i]);
                }
                let ends = at_ends(&q);
                let sign = [p.open[0], -p.open[1]];
                for i in 0..2 {
                    let energy = sign[i] * p.density(ends[i].1);
                    for f in 0..$boundaries {
                        out.r[VELOCITIES + f] += energy * p.by.by[f][i];
                    }
                }
                if !TANGENT {
                    return;
                }
                let s = R::of(w.q) * c;
                for i in 0..$velocities {
                    let more = of_twist[i] + p.lay * (grid.l * of_strain[i] + strain * of_l[i]);
                    for j in 0..$velocities {
                        let by = of_twist[j] + p.lay * strain * of_l[j];
                        out.k[i][j] += s * (more * of_strain[j] + of_strain[i] * by);
                    }
                }
                let mut h = [[[[R::zero(); 3]; 3]; 3]; 3];
                twisting.add_hessian(one, one, &mut h);
                spread(&h, il, s * strain, &mut out.k);
                for at in p.points {
                    let own = Stretch::new(&q, at, il);
                    let weight = s * by_strain * R::of(at.w);
                    let along = dot(&own.t, &own.by_l);
                    let side: V3<R> = std::array::from_fn(|c| own.inverse * (own.by_l[c] - along * own.t[c]));
                    for (n, [_, row]) in AT.into_iter().enumerate() {
                        for (m, [_, column]) in AT.into_iter().enumerate() {
                            let both = weight * own.inverse * own.by[n] * own.by[m];
                            for c in 0..3 {
                                out.k[row + c][column + c] += both;
                                for d in 0..3 {
                                    out.k[row + c][column + d] -= both * own.t[c] * own.t[d];
                                }
                            }
                        }
                        // the shares of positions are those per length
                        let less = if n % 2 == 0 { il * own.by[n] } else { R::zero() };
                        for c in 0..3 {
                            let by = weight * (side[c] * own.by[n] - less * own.t[c]);
                            for f in 0..$boundaries {
                                out.k[row + c][VELOCITIES + f] += by * grows[f];
                                out.k[VELOCITIES + f][row + c] += by * grows[f];
                            }
                        }
                    }
                    let twice = weight * (dot(&side, &own.by_l) - R::of(2.0) * il * along);
                    for f in 0..$boundaries {
                        for m in 0..$boundaries {
                            out.k[VELOCITIES + f][VELOCITIES + m] += twice * grows[f] * grows[m];
                        }
                    }
                }
                for (i, column) in [3, 10].into_iter().enumerate() {
                    let (t, strain) = ends[i];
                    let by = s * sign[i] * (p.lay * strain - p.twist0);
                    for f in 0..$boundaries {
                        for c in 0..3 {
                            out.k[VELOCITIES + f][column + c] += by * p.by.by[f][i] * t[c];
                        }
                    }
                }
            }
            #[inline(always)]
            fn energy<R: Real>(p: &Self::Lanes<R>, x: &Local<R, $coordinates, $velocities>) -> Energy<R> {
                let (grid, _, _, twist, strain) = strained!($boundaries, p, x);
                let potential = p.gj * p.lay * strain * (twist + R::of(0.5) * p.lay * grid.l * strain);
                Energy { kinetic: R::zero(), potential }
            }
            /// What is taken along over the ends.
            #[inline(always)]
            fn power<R: Real>(p: &Self::Lanes<R>, x: &Local<R, $coordinates, $velocities>) -> Power<R> {
                let (grid, q, ..) = strained!($boundaries, p, x);
                let [start, end] = at_ends(&q).map(|(_, strain)| p.density(strain));
                let carried = p.open[1] * end * grid.pd[1] - p.open[0] * start * grid.pd[0];
                Power { carried, ..Power::zero() }
            }
        }
    };
}

element!(1, 21, 15);
element!(2, 22, 16);
