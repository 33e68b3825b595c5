//! Torsion: the elastic twist of a cable element, the inertia of its sections about the tangent, and the damping of twist.

use super::twisting::{
    Blocks, COORDINATES, SECOND, Twisting, VELOCITIES, add_outer, nought, on_dofs, set, spread, three, times,
};
use ropewalk_core::rotation::cross;
use ropewalk_core::{Batch, Element, Energy, Local, Power, Real, Share, V3, Weights};

/// What the torsion of an element is made of; over lanes with `R` other than `f64`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TorsionParams<R = f64> {
    /// Unstretched length `L` [m].
    pub l: R,
    /// Torsional stiffness `GJ` [N m²].
    pub gj: R,
    /// Polar moment of inertia per length `ρJ` [kg m].
    pub rho_j: R,
    /// Twist `Φ₀` of the whole element when free of stress [rad].
    pub twist0: R,
}

/// The torsion of a cable element: the energy `GJ (Φ - Φ₀)²/2L` of its twist, and `½ wᵀ S w` of the spins of its nodes with
/// `S = ρJ L/12 [[5, 1], [1, 5]]`, the mean of consistent and lumped inertia, whose frequencies are of fourth order.
///
/// It stands beside the elements that stretch and bend, on the same two nodes of kind
/// [`Twist`](ropewalk_core::NodeKind::Twist). The second derivatives of `Φ` in its tangent are symmetric; see
/// [`check_tangent`](ropewalk_core::testing::check_tangent).
#[derive(Clone, Copy, Debug)]
pub struct Torsion {
    /// What it is made of.
    pub params: TorsionParams,
}

impl Torsion {
    /// An element of these properties.
    pub fn new(params: TorsionParams) -> Self {
        Torsion { params }
    }
    /// The twist of an element with these coordinates of its nodes [rad].
    pub fn twist(q: &[f64; COORDINATES], l: f64) -> f64 {
        Twisting::new(q, 1.0 / l).twist
    }
}

impl Element<COORDINATES, VELOCITIES> for Torsion {
    type Lanes<R: Real> = TorsionParams<R>;
    const SETS: bool = true;

    fn label(&self) -> String {
        "torsion".into()
    }
    #[inline(always)]
    fn lanes<R: Real>(batch: &Batch<'_, Self>) -> TorsionParams<R> {
        TorsionParams {
            l: batch.get(|e| e.params.l),
            gj: batch.get(|e| e.params.gj),
            rho_j: batch.get(|e| e.params.rho_j),
            twist0: batch.get(|e| e.params.twist0),
        }
    }
    #[inline(always)]
    fn add<R: Real, const TANGENT: bool>(
        p: &TorsionParams<R>,
        x: &Local<R, COORDINATES, VELOCITIES>,
        w: &Weights,
        out: &mut Share<R, VELOCITIES>,
    ) {
        let il = R::of(1.0) / p.l;
        let twisting = Twisting::new(&x.q, il);
        let stiffness = p.gj * il;
        let moment = stiffness * (twisting.twist - p.twist0);
        let one = R::of(1.0);
        let by = twisting.gradient(one, one);
        let g = on_dofs(&by, il);
        for i in 0..VELOCITIES {
            out.r[i] = moment * g[i];
        }
        let [own, other] = inertia(p.rho_j * p.l);
        let (a, b) = (x.a[6], x.a[SECOND + 6]);
        out.r[6] += own.fma(a, other * b);
        out.r[SECOND + 6] += own.fma(b, other * a);
        if TANGENT {
            // of slopes and chord, of which blocks on the diagonal and above it are looked at
            let mut h: Blocks<R> = [[nought(); 3]; 3];
            for i in 0..3 {
                for j in i..3 {
                    add_outer(&mut h[i][j], stiffness, &by[i], &by[j]);
                }
            }
            twisting.add_hessian(moment, moment, &mut h);
            let wq = R::of(w.q);
            set(&h, il, wq, &mut out.k);
            // what both angles have to do with it
            let s = wq * stiffness;
            for i in 0..VELOCITIES {
                let x = s * g[i];
                (out.k[6][i], out.k[SECOND + 6][i]) = (-x, x);
                (out.k[i][6], out.k[i][SECOND + 6]) = (-x, x);
            }
            let wa = R::of(w.a);
            for (i, j, m) in [(6, 6, own), (13, 13, own), (6, 13, other), (13, 6, other)] {
                out.k[i][j] += wa * m;
            }
        }
    }
    #[inline(always)]
    fn energy<R: Real>(p: &TorsionParams<R>, x: &Local<R, COORDINATES, VELOCITIES>) -> Energy<R> {
        let il = R::of(1.0) / p.l;
        let (half, off) = (R::of(0.5), Twisting::new(&x.q, il).twist - p.twist0);
        let ([own, other], a, b) = (inertia(p.rho_j * p.l), x.v[6], x.v[SECOND + 6]);
        Energy {
            kinetic: half * (own * (a * a + b * b) + R::of(2.0) * other * a * b),
            potential: half * p.gj * il * off * off,
        }
    }
}

/// Inertia of a node about the tangent, and of both together, of that of the whole element [kg m²].
#[inline(always)]
pub(super) fn inertia<R: Real>(whole: R) -> [R; 2] {
    let m = whole * R::of(1.0 / 12.0);
    [R::of(5.0) * m, m]
}

/// Kelvin–Voigt damping of twist: the moment `η GJ Φ̇/L` besides the elastic one.
#[derive(Clone, Copy, Debug)]
pub struct TorsionDamping {
    /// Unstretched length [m].
    pub l: f64,
    /// `η GJ` [N m² s].
    pub eta_gj: f64,
}

/// The same over lanes.
#[derive(Clone, Copy, Debug)]
pub struct TorsionDampingLanes<R> {
    /// Unstretched length.
    pub l: R,
    /// `η GJ`.
    pub eta_gj: R,
}

impl Element<COORDINATES, VELOCITIES> for TorsionDamping {
    type Lanes<R: Real> = TorsionDampingLanes<R>;
    const WIDE: bool = false;

    fn label(&self) -> String {
        "torsion damping".into()
    }
    fn symmetric(&self) -> bool {
        false
    }
    fn has_tangent(w: &Weights) -> bool {
        w.q != 0.0 || w.v != 0.0
    }
    #[inline(always)]
    fn lanes<R: Real>(batch: &Batch<'_, Self>) -> TorsionDampingLanes<R> {
        TorsionDampingLanes { l: batch.get(|e| e.l), eta_gj: batch.get(|e| e.eta_gj) }
    }
    #[inline(always)]
    fn add<R: Real, const TANGENT: bool>(
        &TorsionDampingLanes { l, eta_gj }: &TorsionDampingLanes<R>,
        x: &Local<R, COORDINATES, VELOCITIES>,
        w: &Weights,
        out: &mut Share<R, VELOCITIES>,
    ) {
        let (il, one) = (R::of(1.0) / l, R::of(1.0));
        let twisting = Twisting::derivatives(&x.q, il);
        let g = on_dofs(&twisting.gradient(one, one), il);
        let (c, rate) = (eta_gj * il, rate(&g, &x.v));
        for i in 0..VELOCITIES {
            out.r[i] = (c * rate).fma(g[i], out.r[i]);
        }
        if !TANGENT {
            return;
        }
        let mut h = [[[[R::zero(); 3]; 3]; 3]; 3];
        twisting.add_hessian(one, one, &mut h);
        let mut k = [[R::zero(); VELOCITIES]; VELOCITIES];
        spread(&h, il, one, &mut k);
        let by = change(&twisting, &k, &x.v);
        let (wq, wv) = (R::of(w.q), R::of(w.v));
        for i in 0..VELOCITIES {
            let s = c * g[i];
            for j in 0..VELOCITIES {
                let row = s * wv.fma(g[j], wq * by[j]);
                out.k[i][j] += (wq * c * rate).fma(k[i][j], row);
            }
        }
    }
    #[inline(always)]
    fn power<R: Real>(
        &TorsionDampingLanes { l, eta_gj }: &TorsionDampingLanes<R>,
        x: &Local<R, COORDINATES, VELOCITIES>,
    ) -> Power<R> {
        let (il, one) = (R::of(1.0) / l, R::of(1.0));
        let g = on_dofs(&Twisting::derivatives(&x.q, il).gradient(one, one), il);
        let rate = rate(&g, &x.v);
        Power { dissipated: eta_gj * il * rate * rate, ..Power::zero() }
    }
}

/// `Φ̇`
#[inline(always)]
pub(super) fn rate<R: Real>(g: &[R; VELOCITIES], v: &[R; VELOCITIES]) -> R {
    let mut sum = R::zero();
    for i in 0..VELOCITIES {
        sum = g[i].fma(v[i], sum);
    }
    sum
}

/// How `Φ̇` changes with increments while velocities stay: the symmetric second derivative times the velocities, and what
/// two rotations one after the other add to it.
#[inline(always)]
pub(super) fn change<R: Real>(
    twisting: &Twisting<R>,
    k: &[[R; VELOCITIES]; VELOCITIES],
    v: &[R; VELOCITIES],
) -> [R; VELOCITIES] {
    let mut by = [R::zero(); VELOCITIES];
    for i in 0..VELOCITIES {
        for j in 0..VELOCITIES {
            by[i] = k[i][j].fma(v[j], by[i]);
        }
    }
    for (end, at, half) in [(0, 3, 0.5), (2, SECOND + 3, -0.5)] {
        let i = twisting.inverse[end];
        let turn: V3<R> = times(R::of(half) * i * i, &cross(&twisting.e[end], &three(v, at)));
        for c in 0..3 {
            by[at + c] += turn[c];
        }
    }
    by
}
