//! Loads of water on bodies that may lie across its surface.

use crate::in_water::InWater;
use crate::{InWaves, Surface, Wet};
use ropewalk_core::{Gives, Joined, Law, Load, Power, Real, Station, V3};
use ropewalk_scene::{Sea, Swell};
use ropewalk_sea::Top;
use std::any::Any;
use std::sync::Arc;

/// A law of a fluid that may have waves, to which their motion at a station may be told: it is found once for all that asks.
///
/// What a load changes by with the place on their account is left with them, to be [put](InWaves::put) into the load.
pub trait Immersed: Law {
    /// Its waves.
    fn sea(&self) -> Option<&Arc<Sea>>;
    /// As [`Law::load`], in these waves.
    fn load_in<R: Real, const TANGENT: bool, const D: usize>(
        &self,
        at: &Station<R>,
        waves: Option<&mut InWaves<R, D>>,
        out: &mut Load<R>,
    );
}

/// A law of a fluid, by the share of each station that is in it: of water below a surface, or of air above.
///
/// A body that goes through the surface moves no other water than before: added mass that it meets has its motion already, and
/// what it leaves takes that along. Slamming isn't part of it, and the energy of that water counts as supplied.
#[derive(Clone, Debug, PartialEq)]
pub struct Wetted<L> {
    /// The law of the fluid.
    pub law: L,
    /// The surface.
    pub surface: Surface,
    /// Whether the fluid is the air above it.
    pub above: bool,
}

impl<L: Immersed> Wetted<L> {
    /// A law of water below a surface.
    pub fn below(surface: Surface, law: L) -> Self {
        Wetted { law, surface, above: false }
    }

    /// A law of air above a surface.
    pub fn above(surface: Surface, law: L) -> Self {
        Wetted { law, surface, above: true }
    }

    /// How much of a station is in the fluid, in place of how much is wet; and the waves there.
    #[inline(always)]
    fn share<R: Real>(&self, t: f64, at: &Station<R>) -> (Wet<R>, Option<Swell<R>>) {
        let swell = self.surface.swell(t, at);
        let mut wet = self.surface.share(at, swell.as_ref().map(|swell| &swell.top));
        if self.above {
            wet.share = R::of(1.0) - wet.share;
            wet.share_by_z = -wet.share_by_z;
            wet.share_by_slope = wet.share_by_slope.map(|x| -x);
        }
        (wet, swell)
    }

    #[inline(always)]
    fn whole<R: Real, const TANGENT: bool>(
        &self,
        t: f64,
        at: &Station<R>,
        swell: Option<&Swell<R>>,
    ) -> Load<R> {
        let mut whole = Load::zero();
        match (self.law.sea(), &self.surface.sea) {
            (Some(own), Some(sea)) if Arc::ptr_eq(own, sea) => {
                add_in_waves::<R, TANGENT, 3>(&self.law, at, swell, &mut whole);
            }
            (None, _) => self.law.load_in::<R, TANGENT, 3>(at, None, &mut whole),
            _ => self.law.load::<R, TANGENT>(t, at, &mut whole),
        }
        whole
    }
}

/// Adds the load of a law at a station where its waves do this, if it has some.
#[inline(always)]
pub(crate) fn add_in_waves<R: Real, const TANGENT: bool, const D: usize>(
    law: &impl Immersed,
    at: &Station<R>,
    swell: Option<&Swell<R, D>>,
    out: &mut Load<R>,
) {
    match swell {
        None => law.load_in::<R, TANGENT, D>(at, None, out),
        Some(swell) => {
            let mut waves = InWaves::of(*swell);
            law.load_in::<R, TANGENT, D>(at, Some(&mut waves), out);
            if TANGENT {
                waves.put(out);
            }
        }
    }
}

#[inline(always)]
fn add_scaled<R: Real>(share: R, whole: &[V3<R>; 3], out: &mut [V3<R>; 3]) {
    for i in 0..3 {
        for j in 0..3 {
            out[i][j] = share.fma(whole[i][j], out[i][j]);
        }
    }
}

/// Adds the share of a load that is in the fluid.
#[inline(always)]
pub(crate) fn add_share<R: Real, const TANGENT: bool>(
    wet: &Wet<R>,
    top: Option<&Top<R>>,
    whole: &Load<R>,
    out: &mut Load<R>,
) {
    let (share, by_z, by_slope) = (wet.share, wet.share_by_z, wet.share_by_slope);
    for i in 0..3 {
        out.f[i] = share.fma(whole.f[i], out.f[i]);
        out.g[i] = share.fma(whole.g[i], out.g[i]);
    }
    if !TANGENT {
        return;
    }
    add_scaled(share, &whole.d_x, &mut out.d_x);
    add_scaled(share, &whole.d_slope, &mut out.d_slope);
    add_scaled(share, &whole.d_v, &mut out.d_v);
    add_scaled(share, &whole.d_a, &mut out.d_a);
    add_scaled(share, &whole.d_rate, &mut out.d_rate);
    add_scaled(share, &whole.g_x, &mut out.g_x);
    add_scaled(share, &whole.g_slope, &mut out.g_slope);
    add_scaled(share, &whole.g_v, &mut out.g_v);
    for i in 0..3 {
        out.d_x[i][2] += whole.f[i] * by_z;
        out.g_x[i][2] += whole.g[i] * by_z;
        for j in 0..3 {
            out.d_slope[i][j] += whole.f[i] * by_slope[j];
            out.g_slope[i][j] += whole.g[i] * by_slope[j];
        }
    }
    let Some(top) = top else { return };
    for i in 0..3 {
        for j in 0..2 {
            let by_x = by_z * top.slope[j];
            out.d_x[i][j] -= whole.f[i] * by_x;
            out.g_x[i][j] -= whole.g[i] * by_x;
        }
    }
}

impl<L: Immersed> Law for Wetted<L> {
    const NEEDS_DIAMETER: bool = L::NEEDS_DIAMETER;
    fn label(&self) -> String {
        if self.above { format!("{} in air", self.law.label()) } else { self.law.label() }
    }
    fn timed(&self) -> bool {
        self.law.timed() || self.surface.sea.is_some()
    }
    fn reach(&self, t: f64, h: f64) -> Option<f64> {
        let h = self.surface.reach(h);
        if self.law.timed() { self.law.reach(t, h) } else { Some(h) }
    }
    fn period(&self, t: f64) -> f64 {
        self.surface.period().min(self.law.period(t))
    }
    fn follows_material(&self) -> bool {
        self.law.follows_material()
    }
    fn gives(&self) -> Gives {
        Gives { x: true, slope: true, ..self.law.gives() }
    }

    #[inline(always)]
    fn load<R: Real, const TANGENT: bool>(&self, t: f64, at: &Station<R>, out: &mut Load<R>) {
        let (wet, swell) = self.share(t, at);
        let whole = self.whole::<R, TANGENT>(t, at, swell.as_ref());
        add_share::<R, TANGENT>(&wet, swell.as_ref().map(|swell| &swell.top), &whole, out);
    }

    fn join(&self, other: &dyn Any) -> Option<Joined> {
        InWater::join(&self.surface, self, other)
    }

    #[inline(always)]
    fn power<R: Real>(&self, t: f64, at: &Station<R>, _: &Load<R>) -> Power<R> {
        let (wet, swell) = self.share(t, at);
        let share = wet.share;
        let power = self.law.power(t, at, &self.whole::<R, false>(t, at, swell.as_ref()));
        let met = wet.share_rate(at, swell.as_ref().map(|swell| &swell.top)) * self.law.kinetic(t, at);
        Power {
            dissipated: share * power.dissipated,
            supplied: share.fma(power.supplied, met),
            carried: share * power.carried,
        }
    }

    #[inline(always)]
    fn kinetic<R: Real>(&self, t: f64, at: &Station<R>) -> R {
        self.share(t, at).0.share * self.law.kinetic(t, at)
    }

    #[inline(always)]
    fn potential<R: Real>(&self, t: f64, at: &Station<R>) -> R {
        self.share(t, at).0.share * self.law.potential(t, at)
    }

    fn local(&self, quantity: &str, t: f64, at: &Station<f64>) -> Option<f64> {
        self.law.local(quantity, t, at).filter(|_| self.share(t, at).0.share > 0.5)
    }
}
