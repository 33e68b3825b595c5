//! Models that are chosen at run time: one kernel serves all of them, and looks at each point which it is.

use super::l1n::Frozen;
use super::longitudinal::{Longitudinal, MeanGreen, Strain, Stretch};
use super::model::{Integration, LongitudinalModel, TransverseModel};
use super::quadrature::{Point, Points, Quadrature, Rule};
use super::reduced::Reduced;
use super::shape::Natural;
use super::transverse::{Invariants, Square, Transverse, add_bending};
use super::{Full, L1, L1n, L2, L3, L4, LockingFree, T1, T2, T3};
use ropewalk_core::{Real, Share};

/// The strain of any model.
#[derive(Clone, Copy, Debug)]
pub enum AnyStrain<R> {
    /// Of L1, L3 and L4.
    Stretch(Stretch<R>),
    /// Of L2.
    Mean(MeanGreen<R>),
    /// Of L1n.
    Frozen(Frozen<R>),
}

macro_rules! of_strain {
    ($self:ident, $strain:ident => $does:expr) => {
        match $self {
            AnyStrain::Stretch($strain) => $does,
            AnyStrain::Mean($strain) => $does,
            AnyStrain::Frozen($strain) => $does,
        }
    };
}

impl<R: Real> Strain<R> for AnyStrain<R> {
    #[inline(always)]
    fn eps(&self) -> R {
        of_strain!(self, s => s.eps())
    }
    #[inline(always)]
    fn gradient(&self) -> Natural<R> {
        of_strain!(self, s => s.gradient())
    }
    #[inline(always)]
    fn rate(&self, v: &Natural<R>) -> R {
        of_strain!(self, s => s.rate(v))
    }
    #[inline(always)]
    fn turn(&self, v: &Natural<R>) -> Natural<R> {
        of_strain!(self, s => s.turn(v))
    }
    #[inline(always)]
    fn add_hessian(&self, s: R, out: &mut Reduced<R>) {
        of_strain!(self, strain => strain.add_hessian(s, out))
    }
    #[inline(always)]
    fn add_stiffness(&self, material: R, stress: R, out: &mut Reduced<R>) {
        of_strain!(self, s => s.add_stiffness(material, stress, out))
    }
}

macro_rules! of_longitudinal {
    ($self:ident, $model:ident => $does:expr) => {
        match $self {
            LongitudinalModel::L1 => {
                let $model = L1;
                $does
            }
            LongitudinalModel::L1n => {
                let $model = L1n;
                $does
            }
            LongitudinalModel::L2 => {
                let $model = L2;
                $does
            }
            LongitudinalModel::L3 => {
                let $model = L3;
                $does
            }
            LongitudinalModel::L4 => {
                let $model = L4;
                $does
            }
        }
    };
}

impl Longitudinal for LongitudinalModel {
    const KNOWN: bool = false;
    type Strain<R: Real> = AnyStrain<R>;
    fn label(self) -> &'static str {
        of_longitudinal!(self, m => m.label())
    }
    fn symmetric(self) -> bool {
        of_longitudinal!(self, m => m.symmetric())
    }
    fn lever(self, eps: f64) -> f64 {
        of_longitudinal!(self, m => m.lever(eps))
    }
    #[inline(always)]
    fn points<Q: Quadrature>(self, rule: Q) -> &'static [Point] {
        of_longitudinal!(self, m => m.points(rule))
    }
    #[inline(always)]
    fn strain<R: Real>(self, q: &Natural<R>, at: &Point) -> AnyStrain<R> {
        match self {
            LongitudinalModel::L1 => AnyStrain::Stretch(L1.strain(q, at)),
            LongitudinalModel::L1n => AnyStrain::Frozen(L1n.strain(q, at)),
            LongitudinalModel::L2 => AnyStrain::Mean(L2.strain(q, at)),
            LongitudinalModel::L3 => AnyStrain::Stretch(L3.strain(q, at)),
            LongitudinalModel::L4 => AnyStrain::Stretch(L4.strain(q, at)),
        }
    }
    #[inline(always)]
    fn add_unsymmetric<R: Real>(self, material: R, q: &Natural<R>, il: R, out: &mut Share<R, 12>) {
        if self == LongitudinalModel::L1n {
            L1n.add_unsymmetric(material, q, il, out);
        }
    }
}

impl Transverse for TransverseModel {
    const KNOWN: bool = false;
    fn label(self) -> &'static str {
        match self {
            TransverseModel::T1 => T1.label(),
            TransverseModel::T2 => T2.label(),
            TransverseModel::T3 => T3.label(),
        }
    }
    #[inline(always)]
    fn square<R: Real>(self, i: &Invariants<R>) -> Square<R> {
        match self {
            TransverseModel::T1 => T1.square(i),
            TransverseModel::T2 => T2.square(i),
            TransverseModel::T3 => T3.square(i),
        }
    }
    #[inline(always)]
    fn add<Q: Quadrature, R: Real, const TANGENT: bool>(
        self,
        rule: Q,
        ei: R,
        l: R,
        il: R,
        q: &Natural<R>,
        out: &mut Reduced<R>,
    ) {
        match self {
            TransverseModel::T1 => T1.add::<Q, R, TANGENT>(rule, ei, l, il, q, out),
            _ => add_bending::<Self, Q, R, TANGENT>(self, rule, ei, l, il, q, out),
        }
    }
}

impl Rule for Integration {
    type Axial = Points;
    type Bending = Points;
    fn label(self) -> &'static str {
        match self {
            Integration::Full => Full.label(),
            Integration::LockingFree => LockingFree.label(),
        }
    }
    fn axial(self) -> Points {
        match self {
            Integration::Full => Points::of(Full.axial()),
            Integration::LockingFree => Points::of(LockingFree.axial()),
        }
    }
    fn bending(self) -> Points {
        match self {
            Integration::Full => Points::of(Full.bending()),
            Integration::LockingFree => Points::of(LockingFree.bending()),
        }
    }
}
