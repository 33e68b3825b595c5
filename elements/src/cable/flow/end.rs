//! Open ends of a flowing cable: the strain energy of what passes them.

use super::element::last_step;
use super::embedding::{Embedding, Grid};
use super::for_fronts;
use crate::cable::element::CableParams;
use crate::cable::longitudinal::{Longitudinal, Strain, axial_energy};
use crate::cable::model::Models;
use crate::cable::quadrature::{Point, Quadrature};
use crate::cable::relaxed::capped;
use crate::cable::shape::natural;
use crate::cable::transverse::{Transverse, bending_energy};
use ropewalk_core::{Batch, Dual, Element, Local, Power, Real, Share, Weights};

/// The "rule" of one point at the start of an element.
#[derive(Clone, Copy, Debug)]
struct AtStart;
impl Quadrature for AtStart {
    fn label(self) -> &'static str {
        "start"
    }
    #[inline(always)]
    fn points(self) -> &'static [Point] {
        const { &[Point::new(0.0, 1.0)] }
    }
}
/// The same at its end.
#[derive(Clone, Copy, Debug)]
struct AtEnd;
impl Quadrature for AtEnd {
    fn label(self) -> &'static str {
        "end"
    }
    #[inline(always)]
    fn points(self) -> &'static [Point] {
        const { &[Point::new(1.0, 1.0)] }
    }
}

/// An open end of a line: material that passes it takes its strain energy `W` per length along, so `+W` acts on the
/// boundary at the start, `-W` on that at the end. What is left then on the boundary is `T |r'|`.
#[derive(Clone, Copy, Debug)]
pub struct FlowEnd<L, T, const F: usize> {
    /// What the cable is made of.
    pub params: CableParams,
    /// Embedding of the element at the end.
    pub by: Embedding<F>,
    /// Which end of the line it is: 0 its start, 1 its end.
    pub end: usize,
    /// The boundary there, among those of the line.
    pub boundary: usize,
    /// Axial strain.
    pub longitudinal: L,
    /// Curvature.
    pub transverse: T,
}

impl<L: Longitudinal, T: Transverse, const F: usize> FlowEnd<L, T, F> {
    /// The open end of this element.
    pub fn new<Q>(
        params: CableParams,
        models: Models<L, T, Q>,
        by: Embedding<F>,
        end: usize,
        boundary: usize,
    ) -> Self {
        let Models { longitudinal, transverse, .. } = models;
        FlowEnd { params, by, end, boundary, longitudinal, transverse }
    }
}

/// Strain energy per length at an end.
#[inline(always)]
fn density<L: Longitudinal, T: Transverse, R: Real>(
    (longitudinal, transverse): (L, T),
    ea: R,
    ei: R,
    e: &[R; 12],
    l: R,
    end: usize,
) -> R {
    let il = R::of(1.0) / l;
    let (q, one) = (natural(e, il), R::of(1.0));
    if end == 0 {
        axial_energy(longitudinal, AtStart, ea, &q) + bending_energy(transverse, AtStart, ei, one, il, &q)
    } else {
        axial_energy(longitudinal, AtEnd, ea, &q) + bending_energy(transverse, AtEnd, ei, one, il, &q)
    }
}

/// Dofs and length as they change with one of the dofs, or behind these with the length.
#[inline(always)]
fn towards<R: Real>(e: &[R; 12], l: R, j: usize) -> ([Dual<R>; 12], Dual<R>) {
    let (mut e, mut l) = (Dual::constants(e), Dual::constant(l));
    match e.get_mut(j) {
        Some(e) => e.eps = R::of(1.0),
        None => l.eps = R::of(1.0),
    }
    (e, l)
}

macro_rules! element {
    ($boundaries:literal, $size:literal) => {
        impl<L: Longitudinal, T: Transverse> Element<$size, $size> for FlowEnd<L, T, $boundaries> {
            /// One at each end of a line.
            type Lanes<R: Real> = Self;
            const WIDE: bool = false;

            fn label(&self) -> String {
                format!("open end {}+{}", self.longitudinal.label(), self.transverse.label())
            }
            fn symmetric(&self) -> bool {
                false
            }
            #[inline(always)]
            fn lanes<R: Real>(batch: &Batch<'_, Self>) -> Self {
                *batch.first()
            }
            #[inline(always)]
            fn add<R: Real, const TANGENT: bool>(
                p: &Self,
                x: &Local<R, $size, $size>,
                w: &Weights,
                out: &mut Share<R, $size>,
            ) {
                let by = p.by.spread::<R>();
                let (g, row) = (Grid::new(&by, x), 12 + p.boundary);
                let sign = R::of(if p.end == 0 { 1.0 } else { -1.0 });
                let (mut ea, ei) = (R::of(p.params.ea), R::of(p.params.ei));
                let mut e = [R::zero(); 12];
                e.copy_from_slice(&x.q[..12]);
                // of the stress for the geometric stiffness, what that of the strain here hasn't
                let mut apart = [R::zero(); 13];
                if R::LANES == 1
                    && let Some(how) = &x.relaxed
                {
                    // as soft as the element inside
                    let inside = CableParams { l: g.l, ea, ei, rho_a: R::of(p.params.rho_a) };
                    ea = capped(&inside, how.ramp, how.load);
                    if TANGENT {
                        let step = last_step(&by, &g, x);
                        let points = if p.end == 0 {
                            p.longitudinal.points(AtStart)
                        } else {
                            p.longitudinal.points(AtEnd)
                        };
                        for at in points {
                            let eps = |j: usize| {
                                let (e, l) = towards(&e, g.l, j);
                                p.longitudinal.strain(&natural(&e, Dual::of(1.0) / l), at).eps()
                            };
                            let here = eps(12).re;
                            let more = step.stress(p.longitudinal, &inside, how, at, here) - ea * here;
                            for j in 0..13 {
                                apart[j] += R::of(at.w) * more * eps(j).eps;
                            }
                        }
                    }
                }
                out.r[row] += sign * density((p.longitudinal, p.transverse), ea, ei, &e, g.l, p.end);
                if !TANGENT {
                    return;
                }
                let s = sign * R::of(w.q);
                let derivative = |j: usize| {
                    let (e, l) = towards(&e, g.l, j);
                    let (ea, ei) = (Dual::constant(ea), Dual::constant(ei));
                    density((p.longitudinal, p.transverse), ea, ei, &e, l, p.end).eps + apart[j]
                };
                for j in 0..12 {
                    out.k[row][j] += s * derivative(j);
                }
                let by_l = derivative(12);
                for m in 0..$boundaries {
                    out.k[row][12 + m] += s * by_l * (by.by[m][1] - by.by[m][0]);
                }
            }
            #[inline(always)]
            fn power<R: Real>(p: &Self, x: &Local<R, $size, $size>) -> Power<R> {
                let g = Grid::new(&p.by.spread::<R>(), x);
                let mut e = [R::zero(); 12];
                e.copy_from_slice(&x.q[..12]);
                let (ea, ei) = (R::of(p.params.ea), R::of(p.params.ei));
                let w = density((p.longitudinal, p.transverse), ea, ei, &e, g.l, p.end);
                let carried = if p.end == 0 { -(w * g.pd[0]) } else { w * g.pd[1] };
                Power { carried, ..Power::zero() }
            }
        }
    };
}
for_fronts!((1, 13), (2, 14); element);
