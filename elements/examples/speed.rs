//! How long one cable element takes: force, exact tangent and mass, for several models and widths.
//! `cargo run --release -p ropewalk-elements --example speed`

use ropewalk_core::{Element, LaneTask, Local, Real, Share, Weights, Width, run};
use ropewalk_elements::cable::longitudinal::Longitudinal;
use ropewalk_elements::cable::quadrature::Rule;
use ropewalk_elements::cable::transverse::Transverse;
use ropewalk_elements::cable::*;
use std::hint::black_box;
use std::marker::PhantomData;
use std::time::Instant;

/// Evaluates `count` elements, each lane with numbers of its own, and adds up a checksum.
struct Many<'a, E> {
    p: &'a CableParams,
    q: &'a [[f64; 12]],
    tangent: bool,
    sum: &'a mut f64,
    element: PhantomData<E>,
}

impl<L: Longitudinal, T: Transverse, Q: Rule> LaneTask for Many<'_, Cable<L, T, Q>> {
    #[inline(always)]
    fn go<R: Real>(self) {
        let p = self.p.lanes::<R>();
        let w = Weights { q: 1.0, v: 0.0, a: 3.0 };
        for q in self.q.chunks_exact(R::LANES) {
            let q = std::array::from_fn(|i| R::each(|l| q[l][i]));
            let x = Local { q, v: q, a: q, last: q, relaxed: black_box(None) };
            let mut out = Share::zero();
            if self.tangent {
                Cable::<L, T, Q>::add::<R, true>(&p, &x, &w, &mut out);
            } else {
                Cable::<L, T, Q>::add::<R, false>(&p, &x, &w, &mut out);
            }
            let out = black_box(&out);
            *self.sum += out.r[0].lane(0) + out.k[0][0].lane(0);
        }
    }
}

fn measure<L: Longitudinal, T: Transverse, Q: Rule>() {
    let p = CableParams { l: 0.7, ea: 1234.5, ei: 6.78, rho_a: 2.5 };
    let q: Vec<[f64; 12]> = (0..256)
        .map(|k| {
            let s = 1e-3 * f64::from(k);
            [0.01, -0.02, 0.03, 0.93, 0.11, -0.17, 0.66, 0.08 + s, -0.05, 0.98, -0.21 + s, 0.19]
        })
        .collect();
    print!("{:32}", <Cable<L, T, Q> as Element<12, 12>>::label());
    for (width, tangent) in
        [(Width::One, true), (Width::Four, true), (Width::best(), true), (Width::best(), false)]
    {
        let mut best = f64::INFINITY;
        let mut sum = 0.0;
        for _ in 0..400 {
            let start = Instant::now();
            run(width, Many::<Cable<L, T, Q>> { p: &p, q: &q, tangent, sum: &mut sum, element: PhantomData });
            best = best.min(start.elapsed().as_secs_f64());
        }
        black_box(sum);
        print!("{:10.3}", best * 1e6 / q.len() as f64);
    }
    println!();
}

fn main() {
    println!("µs per element, minimum of many short samples; best width: {:?}", Width::best());
    println!("{:32}{:>10}{:>10}{:>10}{:>10}", "", "one", "four", "best", "best, force");
    measure::<L4, T3, LockingFree>();
    measure::<L4, T3, Full>();
    measure::<L3, T2, Full>();
    measure::<L2, T1, LockingFree>();
    measure::<L1n, T1, LockingFree>();
}
