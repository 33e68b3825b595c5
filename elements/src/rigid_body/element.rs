//! The inertia of rigid bodies, over lanes.

use ropewalk_core::rotation::{cross, times};
use ropewalk_core::{Batch, Element, Energy, Local, Real, Share, V3, Weights, dot};

/// Inertia of a rigid body whose node stands at its centre of mass: `m r̈` and `J ω̇ + ω × J ω`, the rotation in the
/// body's own axes (Newton–Euler). It doesn't depend on where the body is, so only `ω × J ω` makes it nonlinear.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inertia<R = f64> {
    /// Mass `m` [kg].
    pub mass: R,
    /// Moments of inertia `J` about the centre of mass in the body's axes [kg m²], row by row.
    pub inertia: [V3<R>; 3],
}

/// `ã J`, one column after the other.
#[inline(always)]
fn spin<R: Real>(a: &V3<R>, j: &[V3<R>; 3]) -> [V3<R>; 3] {
    // J is symmetric: its rows are its columns
    [cross(a, &j[0]), cross(a, &j[1]), cross(a, &j[2])]
}

impl Element<7, 6> for Inertia {
    type Lanes<R: Real> = Inertia<R>;

    fn label(&self) -> String {
        "rigid bodies".into()
    }
    // ω × J ω takes no energy but has no symmetric derivative
    fn symmetric(&self) -> bool {
        false
    }

    #[inline(always)]
    fn lanes<R: Real>(b: &Batch<'_, Self>) -> Inertia<R> {
        let mut inertia = [[R::zero(); 3]; 3];
        for i in 0..3 {
            for k in 0..3 {
                inertia[i][k] = b.get(|e| e.inertia[i][k]);
            }
        }
        Inertia { mass: b.get(|e| e.mass), inertia }
    }

    #[inline(always)]
    fn add<R: Real, const TANGENT: bool>(
        p: &Inertia<R>,
        x: &Local<R, 7, 6>,
        w: &Weights,
        out: &mut Share<R, 6>,
    ) {
        let (omega, alpha) = ([x.v[3], x.v[4], x.v[5]], [x.a[3], x.a[4], x.a[5]]);
        let momentum = times(&p.inertia, &omega);
        let (change, turn) = (times(&p.inertia, &alpha), cross(&omega, &momentum));
        for i in 0..3 {
            out.r[i] += p.mass * x.a[i];
            out.r[3 + i] += change[i] + turn[i];
        }
        if TANGENT {
            let (wa, wv) = (R::of(w.a), R::of(w.v));
            let column = spin(&omega, &p.inertia);
            let l = &momentum;
            let tilde = [[R::zero(), -l[2], l[1]], [l[2], R::zero(), -l[0]], [-l[1], l[0], R::zero()]];
            for i in 0..3 {
                out.k[i][i] += wa * p.mass;
                for j in 0..3 {
                    out.k[3 + i][3 + j] += wa * p.inertia[i][j] + wv * (column[j][i] - tilde[i][j]);
                }
            }
        }
    }

    #[inline(always)]
    fn energy<R: Real>(p: &Inertia<R>, x: &Local<R, 7, 6>) -> Energy<R> {
        let (v, omega) = ([x.v[0], x.v[1], x.v[2]], [x.v[3], x.v[4], x.v[5]]);
        let turning = dot(&omega, &times(&p.inertia, &omega));
        Energy { kinetic: R::of(0.5) * (p.mass * dot(&v, &v) + turning), ..Energy::zero() }
    }
}
