//! Torque and tension of laid ropes: a wire rope that is pulled turns, or twists what holds it.

use super::quadrature::Point;
use super::shape::hermite_slope;
use super::torsion::{TorsionParams, inertia};
use super::twisting::{COORDINATES, SECOND, Twisting, VELOCITIES, on_dofs, spread};
use ropewalk_core::{Batch, Element, Energy, Local, Real, Share, V3, Weights, dot};

/// Torsion of a rope whose twist and stretch are coupled, `[N; M] = [[EA, C], [C, GJ]] [ε; φ']` with the axial force `N`, the
/// torque `M`, the strain `ε` and the twist per length `φ'`. It stands in place of [`Torsion`](super::Torsion), beside elements
/// of axial stiffness `EA - C²/GJ`.
///
/// The torque is the same all along an element, the twist then isn't where the strain changes: what is left of the energy
/// is `GJ (Ψ - Φ₀)²/2L` with `Ψ = Φ + (C L/GJ) ε̄`, the twist `Φ` of the element and its mean strain `ε̄`, taken at the
/// points at which the element itself takes it. A rope that hangs under its own weight is then right at its nodes with
/// a single element.
#[derive(Clone, Copy, Debug)]
pub struct TorqueTension {
    /// What its torsion is made of.
    pub params: TorsionParams,
    /// `C/GJ` [1/m]: by how much it turns per length and strain, if nothing holds it.
    pub lay: f64,
    /// Mean strain when free of stress.
    pub strain0: f64,
    /// Where the strain is taken.
    pub points: &'static [Point],
}

/// The same over lanes.
#[derive(Clone, Copy, Debug)]
pub struct TorqueTensionLanes<R> {
    torsion: TorsionParams<R>,
    lay: R,
    strain0: R,
    points: &'static [Point],
}

/// First coordinate and first velocity of the vectors that the curve depends on: positions and slopes of both nodes.
pub(super) const AT: [[usize; 2]; 4] = [[0, 0], [3, 3], [10, SECOND], [13, SECOND + 3]];

/// Slope at a point of an element, one over its length, and by how much it changes with each of the four vectors.
#[inline(always)]
pub(super) fn slope<R: Real>(q: &[R; COORDINATES], at: &Point, il: R) -> (V3<R>, R, [R; 4]) {
    let by = hermite_slope(at.xi, il);
    let p: V3<R> = std::array::from_fn(|c| {
        let [r1, p1, r2, p2] = AT.map(|[first, _]| q[first + c]);
        by[2].fma(r2 - r1, by[1].fma(p1, by[3] * p2))
    });
    (p, R::of(1.0) / dot(&p, &p).sqrt(), by)
}

impl TorqueTension {
    /// Mean strain of an element with these coordinates.
    pub fn mean_strain(q: &[f64; COORDINATES], l: f64, points: &[Point]) -> f64 {
        mean_strain(q, 1.0 / l, points)
    }
}

#[inline(always)]
fn mean_strain<R: Real>(q: &[R; COORDINATES], il: R, points: &[Point]) -> R {
    let mut strain = R::zero();
    for at in points {
        let (_, inverse, _) = slope(q, at, il);
        strain += R::of(at.w) * (R::of(1.0) / inverse - R::of(1.0));
    }
    strain
}

impl Element<COORDINATES, VELOCITIES> for TorqueTension {
    type Lanes<R: Real> = TorqueTensionLanes<R>;
    const WIDE: bool = false;

    fn label(&self) -> String {
        "torsion with tension".into()
    }
    #[inline(always)]
    fn lanes<R: Real>(batch: &Batch<'_, Self>) -> TorqueTensionLanes<R> {
        TorqueTensionLanes {
            torsion: TorsionParams {
                l: batch.get(|e| e.params.l),
                gj: batch.get(|e| e.params.gj),
                rho_j: batch.get(|e| e.params.rho_j),
                twist0: batch.get(|e| e.params.twist0),
            },
            lay: batch.get(|e| e.lay),
            strain0: batch.get(|e| e.strain0),
            points: batch.first().points,
        }
    }
    #[inline(always)]
    fn add<R: Real, const TANGENT: bool>(
        p: &TorqueTensionLanes<R>,
        x: &Local<R, COORDINATES, VELOCITIES>,
        w: &Weights,
        out: &mut Share<R, VELOCITIES>,
    ) {
        let TorsionParams { l, gj, rho_j, twist0 } = p.torsion;
        let (one, il) = (R::of(1.0), R::of(1.0) / l);
        let twisting = Twisting::new(&x.q, il);
        let lever = p.lay * l;
        let strain = mean_strain(&x.q, il, p.points);
        let stiffness = gj * il;
        let moment = stiffness * (twisting.twist + lever * (strain - p.strain0) - twist0);
        let mut g = on_dofs(&twisting.gradient(one, one), il);
        for at in p.points {
            let (p, inverse, by) = slope(&x.q, at, il);
            let s = lever * R::of(at.w) * inverse;
            for (n, [_, row]) in AT.into_iter().enumerate() {
                for c in 0..3 {
                    g[row + c] = (s * by[n]).fma(p[c], g[row + c]);
                }
            }
        }
        for i in 0..VELOCITIES {
            out.r[i] = moment.fma(g[i], out.r[i]);
        }
        let [own, other] = inertia(rho_j * l);
        let (a, b) = (x.a[6], x.a[SECOND + 6]);
        out.r[6] += own.fma(a, other * b);
        out.r[SECOND + 6] += own.fma(b, other * a);
        if !TANGENT {
            return;
        }
        let wq = R::of(w.q);
        for i in 0..VELOCITIES {
            let s = wq * stiffness * g[i];
            for j in 0..VELOCITIES {
                out.k[i][j] = s.fma(g[j], out.k[i][j]);
            }
        }
        let mut h = [[[[R::zero(); 3]; 3]; 3]; 3];
        twisting.add_hessian(one, one, &mut h);
        spread(&h, il, wq * moment, &mut out.k);
        for at in p.points {
            let (p, inverse, by) = slope(&x.q, at, il);
            let s = wq * moment * lever * R::of(at.w) * inverse;
            for (n, [_, row]) in AT.into_iter().enumerate() {
                for (m, [_, column]) in AT.into_iter().enumerate() {
                    let s = s * by[n] * by[m];
                    for c in 0..3 {
                        out.k[row + c][column + c] += s;
                        for d in 0..3 {
                            out.k[row + c][column + d] -= s * inverse * inverse * p[c] * p[d];
                        }
                    }
                }
            }
        }
        let wa = R::of(w.a);
        for (i, j, m) in [(6, 6, own), (13, 13, own), (6, 13, other), (13, 6, other)] {
            out.k[i][j] += wa * m;
        }
    }
    #[inline(always)]
    fn energy<R: Real>(p: &TorqueTensionLanes<R>, x: &Local<R, COORDINATES, VELOCITIES>) -> Energy<R> {
        let TorsionParams { l, gj, rho_j, twist0 } = p.torsion;
        let (half, il) = (R::of(0.5), R::of(1.0) / l);
        let strain = mean_strain(&x.q, il, p.points) - p.strain0;
        let off = Twisting::new(&x.q, il).twist + p.lay * l * strain - twist0;
        let ([own, other], a, b) = (inertia(rho_j * l), x.v[6], x.v[SECOND + 6]);
        Energy {
            kinetic: half * (own * (a * a + b * b) + R::of(2.0) * other * a * b),
            potential: half * gj * il * off * off,
        }
    }
}
