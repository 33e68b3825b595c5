//! Weight and buoyancy of a flowing cable: a constant force per length of an element whose length changes.

use super::embedding::{Embedding, Grid};
use super::for_fronts;
use super::rule::close;
use super::transport::nodal;
use ropewalk_core::{Batch, Element, Energy, Local, Power, Real, Share, V3, Weights, dot};

/// A constant force per unstretched length, `F = w l [1/2, l/12, 1/2, -l/12]` on the nodes.
#[derive(Clone, Copy, Debug)]
pub struct FlowWeight<const F: usize> {
    /// Force per length [N/m].
    pub load: V3<f64>,
    /// Embedding of the element.
    pub by: Embedding<F>,
}

/// The consistent nodal vector per unit load, and its derivative by the length.
#[inline(always)]
fn shares<R: Real>(l: R) -> ([R; 4], [R; 4]) {
    let (half, sixth) = (R::of(0.5), R::of(1.0 / 6.0) * l);
    let (force, moment) = (half * l, half * sixth * l);
    ([force, moment, force, -moment], [half, sixth, half, -sixth])
}

macro_rules! element {
    ($boundaries:literal, $size:literal) => {
        impl Element<$size, $size> for FlowWeight<$boundaries> {
            type Lanes<R: Real> = (V3<R>, Embedding<$boundaries, R>);

            fn label(&self) -> String {
                "weight of a flowing cable".into()
            }
            fn symmetric(&self) -> bool {
                false
            }
            #[inline(always)]
            fn lanes<R: Real>(b: &Batch<'_, Self>) -> Self::Lanes<R> {
                let load = [b.get(|e| e.load[0]), b.get(|e| e.load[1]), b.get(|e| e.load[2])];
                (load, Embedding::lanes(|f, j| b.get(|e| f(&e.by, j))))
            }
            #[inline(always)]
            fn add<R: Real, const TANGENT: bool>(
                (load, by): &Self::Lanes<R>,
                x: &Local<R, $size, $size>,
                w: &Weights,
                out: &mut Share<R, $size>,
            ) {
                let g = Grid::new(by, x);
                let (s, s_l) = shares(g.l);
                let (mut f, mut f_l) = ([[R::zero(); 3]; 4], [[R::zero(); 3]; 4]);
                for i in 0..4 {
                    for c in 0..3 {
                        f[i][c] = -(s[i] * load[c]);
                        f_l[i][c] = -(s_l[i] * load[c]);
                        out.r[3 * i + c] += f[i][c];
                    }
                }
                let mut d_f = [f_l; $boundaries];
                for k in 0..$boundaries {
                    let grows = R::of(w.q) * (by.by[k][1] - by.by[k][0]);
                    for i in 0..4 {
                        for c in 0..3 {
                            d_f[k][i][c] = grows * f_l[i][c];
                        }
                    }
                }
                close::<R, $boundaries, $size, TANGENT>(by, &g, &x.q, &f, &d_f, w, out);
            }
            #[inline(always)]
            fn energy<R: Real>((load, by): &Self::Lanes<R>, x: &Local<R, $size, $size>) -> Energy<R> {
                let (e, s) = (nodal(&x.q), shares(Grid::new(by, x).l).0);
                let mut work = R::zero();
                for i in 0..4 {
                    work = s[i].fma(dot(load, &e[i]), work);
                }
                Energy { potential: -work, ..Energy::zero() }
            }
            /// Potential that material carries over the ends; it cancels between neighbours.
            #[inline(always)]
            fn power<R: Real>((load, by): &Self::Lanes<R>, x: &Local<R, $size, $size>) -> Power<R> {
                let (e, g) = (nodal(&x.q), Grid::new(by, x));
                let carried = g.pd[0] * dot(load, &e[0]) - g.pd[1] * dot(load, &e[2]);
                Power { carried, ..Power::zero() }
            }
        }
    };
}
for_fronts!((1, 13), (2, 14); element);
