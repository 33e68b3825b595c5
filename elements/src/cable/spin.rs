//! Gyroscopic forces of sections that spin about their tangent.

use super::torsion::inertia;
use super::twisting::{COORDINATES, SECOND, VELOCITIES, add_outer, add_skew, nought, three, times};
use ropewalk_core::rotation::cross;
use ropewalk_core::{Batch, Element, Local, Real, Share, Weights, dot};

/// What turns a cable aside that spins about its tangent while that turns: with the spin momentum `W = (S w)` of a node, the
/// force `W (ṫ × t)/|p|` on its slope `p` in the equations of motion. It does no work. Of ropes it is nothing beside other
/// forces; of shafts it keeps their angular momentum.
///
/// It stands beside [`Torsion`](super::Torsion), of which it takes the inertia `S`.
#[derive(Clone, Copy, Debug)]
pub struct SpinInertia {
    /// Unstretched length [m].
    pub l: f64,
    /// Polar moment of inertia per length [kg m].
    pub rho_j: f64,
}

/// The same over lanes.
#[derive(Clone, Copy, Debug)]
pub struct SpinInertiaLanes<R> {
    /// Unstretched length.
    pub l: R,
    /// Polar moment of inertia per length.
    pub rho_j: R,
}

impl Element<COORDINATES, VELOCITIES> for SpinInertia {
    type Lanes<R: Real> = SpinInertiaLanes<R>;
    const WIDE: bool = false;

    fn label(&self) -> String {
        "gyroscopic forces of spin".into()
    }
    fn symmetric(&self) -> bool {
        false
    }
    #[inline(always)]
    fn lanes<R: Real>(batch: &Batch<'_, Self>) -> SpinInertiaLanes<R> {
        SpinInertiaLanes { l: batch.get(|e| e.l), rho_j: batch.get(|e| e.rho_j) }
    }
    #[inline(always)]
    fn add<R: Real, const TANGENT: bool>(
        &SpinInertiaLanes { l, rho_j }: &SpinInertiaLanes<R>,
        x: &Local<R, COORDINATES, VELOCITIES>,
        w: &Weights,
        out: &mut Share<R, VELOCITIES>,
    ) {
        let [own, other] = inertia(rho_j * l);
        let (wq, wv) = (R::of(w.q), R::of(w.v));
        for (q, v, beside) in [(3, 3, SECOND + 6), (13, SECOND + 3, 6)] {
            let (p, rate) = (three(&x.q, q), three(&x.v, v));
            let momentum = own.fma(x.v[v + 3], other * x.v[beside]);
            let square = dot(&p, &p);
            let cube = R::of(1.0) / (square * square.sqrt());
            let side = times(cube, &cross(&rate, &p));
            for i in 0..3 {
                out.r[v + i] = momentum.fma(side[i], out.r[v + i]);
            }
            if !TANGENT {
                continue;
            }
            let mut by_slope = nought();
            add_skew(&mut by_slope, wq * momentum * cube, &rate);
            add_outer(&mut by_slope, R::of(-3.0) * wq * momentum / square, &side, &p);
            add_skew(&mut by_slope, -(wv * momentum * cube), &p);
            for i in 0..3 {
                for j in 0..3 {
                    out.k[v + i][v + j] += by_slope[i][j];
                }
                out.k[v + i][v + 3] += wv * own * side[i];
                out.k[v + i][beside] += wv * other * side[i];
            }
        }
    }
}
