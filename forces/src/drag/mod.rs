//! Drag of water on slender bodies: normal and tangential part, each with its own law.
//!
//! With `v` the velocity of the material relative to the water, `t = r'/|r'|`, `v_t = (v·t) t` and `v_n = v - v_t`,
//! the cross-flow principle gives the normal force from `v_n` alone. Reynolds numbers are those of the normal flow,
//! `Re = ρ d |v_n| / μ`.

mod spec;

pub(crate) use spec::free_tips;
pub use spec::{DragLaw, DragSpec};

use crate::wetted::add_in_waves;
use crate::{Immersed, InWaves};
use ropewalk_core::error::{need, not_negative};
use ropewalk_core::{BuildError, Gives, Law, Load, Power, Real, Station, V3, dot, scaled};
use ropewalk_scene::{Current, Sea, Swell};
use std::f64::consts::PI;
use std::sync::Arc;

/// What [`Law::local`] calls the coefficient of the flow across; NaN in flow so slow that it is of no use.
pub(crate) const COEFFICIENT: &str = "drag coefficient across";

/// Law of the normal force `f_n = -½ ρ d Cn |v_n| v_n` per length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NormalLaw {
    /// The same `Cn` at every speed; about 1.2 for a smooth cylinder.
    Constant(f64),
    /// `Cn(Re)` of Choo & Casarella (1971), see [`choo_casarella_cn`].
    ChooCasarella,
}

/// Law of the tangential force per length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TangentialLaw {
    /// `f_t = -½ ρ π d Ct |v_t| v_t`; `Ct` about 0.003 to 0.015.
    Quadratic(f64),
    /// `f_t = -π μ (0.55 Re^½ + 0.084 Re^⅔) v_t` of Choo & Casarella (1971), linear in `v_t`. As `Re` is that of the
    /// normal flow, drag vanishes in purely axial flow: a laminar fit, low for fast tows.
    ChooCasarella,
}

/// Along which length a distributed load counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PerLength {
    /// The length of the body before it is stretched.
    #[default]
    Unstretched,
    /// The present length: the load per unstretched length grows with `|r'|`.
    Stretched,
}

/// Drag per length on a slender body.
///
/// Use it for: cables, hoses and lines in water or air, with any normal law beside any tangential law.
#[derive(Clone, Debug, PartialEq)]
pub struct Drag {
    /// Density of the fluid `ρ` [kg/m³].
    pub density: f64,
    /// Dynamic viscosity of the fluid `μ` [Pa s]; used by the laws that depend on the Reynolds number.
    pub viscosity: f64,
    /// Law of the normal force.
    pub normal: NormalLaw,
    /// Law of the tangential force.
    pub tangential: TangentialLaw,
    /// Velocity of the fluid.
    pub current: Current,
    /// Waves, whose velocity adds to it.
    pub sea: Option<Arc<Sea>>,
    /// Which length the forces are per.
    pub per: PerLength,
    /// Where `Cn(Re)` jumps (+1.75 % at `Re` = 1, -1.09 % at 30), goes over smoothly within this part of the edge
    /// to either side: 0.1 blends from 27 to 33. `None` leaves the published jumps.
    pub blend: Option<f64>,
}

impl Drag {
    /// Drag in still water, per unstretched length, without blending; set the other fields afterwards.
    ///
    /// # Errors
    /// Negative or infinite numbers, and a viscosity of zero for a law that needs it.
    pub fn new(
        density: f64,
        viscosity: f64,
        normal: NormalLaw,
        tangential: TangentialLaw,
    ) -> Result<Self, BuildError> {
        let drag = Drag {
            density,
            viscosity,
            normal,
            tangential,
            current: Current::Still,
            sea: None,
            per: PerLength::Unstretched,
            blend: None,
        };
        drag.check().map(|()| drag)
    }

    /// Whether its numbers make sense.
    ///
    /// # Errors
    /// As [`Drag::new`]; a bad current; a blend outside (0, 0.5].
    pub fn check(&self) -> Result<(), BuildError> {
        not_negative("density of the fluid", self.density)?;
        not_negative("viscosity of the fluid", self.viscosity)?;
        if let NormalLaw::Constant(c) = self.normal {
            not_negative("normal drag coefficient", c)?;
        }
        if let TangentialLaw::Quadratic(c) = self.tangential {
            not_negative("tangential drag coefficient", c)?;
        }
        let viscous =
            self.normal == NormalLaw::ChooCasarella || self.tangential == TangentialLaw::ChooCasarella;
        need(!viscous || self.viscosity > 0.0, || {
            "drag by Choo and Casarella needs a viscosity above zero (sea water: 1.07e-3 Pa s)".into()
        })?;
        if let Some(b) = self.blend.filter(|b| !(*b > 0.0 && *b <= 0.5)) {
            let message = format!("`blend` must be above 0 and at most 0.5, not {b}");
            return Err(BuildError::at("blend", message));
        }
        self.current.check()
    }

    /// Velocity of the fluid at a station [m/s].
    #[inline(always)]
    fn velocity<R: Real>(&self, t: f64, at: &Station<R>) -> V3<R> {
        let swell = self.sea.as_ref().map(|sea| sea.along(t, at));
        velocity(&self.current, swell.as_ref(), &at.x)
    }

    /// Resistance `k` of the normal flow, `f_n = -k v_n`, and `s dk/ds` by the speed `s = |v_n|`.
    #[inline(always)]
    fn normal<R: Real>(&self, d: R, s: R) -> (R, R) {
        match self.normal {
            NormalLaw::Constant(cn) => {
                let k = R::of(0.5 * self.density * cn) * d * s;
                (k, k)
            }
            NormalLaw::ChooCasarella => {
                let re = R::of(self.density / self.viscosity) * d * s;
                let half_mu = R::of(0.5 * self.viscosity);
                let (k, by_s) = cn_re(re, self.blend);
                (half_mu * k, half_mu * by_s)
            }
        }
    }

    /// Tangential force `h` (`f_t = -h t`) of axial speed `w` and normal speed `s`, with `∂h/∂w` and `∂h/∂s`.
    #[inline(always)]
    fn tangential<R: Real>(&self, d: R, w: R, s: R) -> (R, R, R) {
        match self.tangential {
            TangentialLaw::Quadratic(ct) => {
                let c = R::of(0.5 * self.density * PI * ct) * d * w.abs();
                (c * w, c + c, R::zero())
            }
            TangentialLaw::ChooCasarella => {
                let re_per_s = R::of(self.density / self.viscosity) * d;
                let re = re_per_s * s;
                let (half, third) = (re.sqrt(), cube_root(re));
                let two_thirds = third * third;
                let mu = R::of(PI * self.viscosity);
                let m = mu * R::of(0.55).fma(half, R::of(0.084) * two_thirds);
                // s dm/ds; the slope itself is infinite at Re = 0
                let rise = mu * R::of(0.275).fma(half, R::of(0.056) * two_thirds);
                let floor = R::of(SMALL_RE);
                let by_s = rise * re_per_s / re.if_gt(floor, re, floor);
                (m * w, m, w * by_s)
            }
        }
    }
}

/// Velocity of water that has a current and waves [m/s].
#[inline(always)]
pub(crate) fn velocity<R: Real>(current: &Current, swell: Option<&Swell<R>>, x: &V3<R>) -> V3<R> {
    let (mut u, _) = current.at(x[2]);
    if let Some(swell) = swell {
        add(&mut u, &swell.u);
    }
    u
}

#[inline(always)]
pub(crate) fn add<R: Real>(to: &mut V3<R>, x: &V3<R>) {
    for i in 0..3 {
        to[i] += x[i];
    }
}

/// Cube root of a number that isn't negative: a third of the exponent for a start, then Halley's method, which triples
/// the digits at each step.
#[inline(always)]
fn cube_root<R: Real>(a: R) -> R {
    let (mut x, two) = (a.map(|a| f64::from_bits(a.to_bits() / 3 + 0x2A9F_7893_0000_0000)), R::of(2.0));
    for _ in 0..3 {
        let cube = x * x * x;
        x = x * (two.fma(a, cube) / two.fma(cube, a));
    }
    a.if_gt(R::zero(), x, R::zero())
}

/// Below this Reynolds number the derivative of Choo and Casarella's tangential force by `v_n` fades to zero instead of
/// growing like `Re^-½`: in axial flow `v_n` is rounding noise and such a tangent only hinders Newton's method. The
/// force itself is never changed.
const SMALL_RE: f64 = 1e-3;

impl Law for Drag {
    const NEEDS_DIAMETER: bool = true;
    fn label(&self) -> String {
        "drag".into()
    }
    fn gives(&self) -> Gives {
        let x = self.sea.is_some() || !self.current.is_uniform();
        Gives { x, slope: true, v: true, ..Gives::NOTHING }
    }
    fn timed(&self) -> bool {
        self.sea.is_some()
    }
    fn reach(&self, _t: f64, h: f64) -> Option<f64> {
        Some(self.sea.as_ref().map_or(h, |sea| sea.reach(h)))
    }
    fn period(&self, _t: f64) -> f64 {
        self.sea.as_ref().map_or(f64::INFINITY, |sea| sea.period())
    }

    #[inline(always)]
    fn load<R: Real, const TANGENT: bool>(&self, t: f64, at: &Station<R>, out: &mut Load<R>) {
        let swell = self.sea.as_ref().map(|sea| sea.along(t, at));
        add_in_waves::<R, TANGENT, 3>(self, at, swell.as_ref(), out);
    }

    fn local(&self, quantity: &str, t: f64, at: &Station<f64>) -> Option<f64> {
        (quantity == COEFFICIENT).then(|| match self.normal {
            NormalLaw::Constant(cn) => cn,
            NormalLaw::ChooCasarella => {
                let u = self.velocity(t, at);
                let v: V3<f64> = [0, 1, 2].map(|i| at.v[i] - u[i]);
                let along = dot(&v, &at.slope) / dot(&at.slope, &at.slope);
                let across: V3<f64> = [0, 1, 2].map(|i| v[i] - along * at.slope[i]);
                let re = self.density * at.diameter * dot(&across, &across).sqrt() / self.viscosity;
                // creeping flow has large coefficients and hardly any force
                if re >= 1.0 { cn_re_one(re, self.blend).0 / re } else { f64::NAN }
            }
        })
    }

    /// What the fluid takes by friction, `-f·(v - u)`, is dissipated; what it carries along, `f·u`, is supplied.
    #[inline(always)]
    fn power<R: Real>(&self, t: f64, at: &Station<R>, load: &Load<R>) -> Power<R> {
        let u = self.velocity(t, at);
        let supplied = dot(&load.f, &u);
        Power { dissipated: supplied - dot(&load.f, &at.v), supplied, carried: R::zero() }
    }
}

impl Immersed for Drag {
    #[inline(always)]
    fn sea(&self) -> Option<&Arc<Sea>> {
        self.sea.as_ref()
    }
    #[inline(always)]
    fn load_in<R: Real, const TANGENT: bool, const D: usize>(
        &self,
        at: &Station<R>,
        waves: Option<&mut InWaves<R, D>>,
        out: &mut Load<R>,
    ) {
        let one = R::of(1.0);
        let (mut u, du) = self.current.at(at.x[2]);
        if let Some(waves) = &waves {
            add(&mut u, &waves.swell.u);
        }
        let v = [at.v[0] - u[0], at.v[1] - u[1], at.v[2] - u[2]];
        let stretch = dot(&at.slope, &at.slope).sqrt();
        let per_stretch = one / stretch;
        let t = scaled(per_stretch, &at.slope);
        let w = dot(&v, &t);
        let mut vn = v;
        for i in 0..3 {
            vn[i] -= w * t[i];
        }
        let s = dot(&vn, &vn).sqrt();
        let (k, ks) = self.normal(at.diameter, s);
        let (h, hw, hs) = self.tangential(at.diameter, w, s);
        // |r'| per stretched length, else 1
        let length = if self.per == PerLength::Stretched { stretch } else { one };
        let mut f = vn;
        for i in 0..3 {
            f[i] = -(k.fma(vn[i], h * t[i]));
            out.f[i] += length * f[i];
        }
        if !TANGENT {
            return;
        }
        let inverse = s.if_gt(R::zero(), one / s, R::zero());
        let n = scaled(inverse, &vn);
        let per_slope = length * per_stretch;
        let tn = s.fma(k - hw, w * hs);
        let side = w.fma(k, -h);
        let mut dv = [[R::zero(); 3]; 3];
        for i in 0..3 {
            for j in 0..3 {
                let (nn, tt, cross) = (n[i] * n[j], t[i] * t[j], t[i] * n[j]);
                let p = if i == j { one - tt } else { -tt };
                dv[i][j] = -(length * k.fma(p, ks.fma(nn, hw.fma(tt, hs * cross))));
                out.d_v[i][j] += dv[i][j];
                out.d_slope[i][j] += per_slope * (w * ks).fma(nn, tn.fma(cross, side * p));
                if self.per == PerLength::Stretched {
                    out.d_slope[i][j] += f[i] * t[j];
                }
            }
        }
        if !self.current.is_uniform() {
            for i in 0..3 {
                out.d_x[i][2] -= dot(&dv[i], &du);
            }
        }
        if let Some(waves) = waves {
            waves.drift(&dv);
        }
    }
}

/// Normal drag coefficient of a cable at the Reynolds number `re` of the normal flow.
///
/// Choo & Casarella, *Hydrodynamic resistance of towed cables*, J. Hydronautics 5 (1971):
/// `8π/(Re s) (1 - 0.87 s⁻²)` with `s = ln(8/Re) - 0.077215665` for `Re ≤ 1`; `1.45 + 8.55 Re^-0.9` up to 30;
/// `1.1 + 4 Re^-½` above. The last one was published up to 10⁵ and is kept beyond. Infinite at `Re = 0`, where the
/// force is zero all the same.
pub fn choo_casarella_cn(re: f64) -> f64 {
    if re > 0.0 { cn_re_one(re, None).0 / re } else { f64::INFINITY }
}

/// Tangential coefficient by viscosity, `π (0.55 Re^½ + 0.084 Re^⅔)`: the force per length is `-μ` times this times
/// `v_t`. `re` is the Reynolds number of the *normal* flow. Source as for [`choo_casarella_cn`].
pub fn choo_casarella_ct_over_mu(re: f64) -> f64 {
    let third = re.cbrt();
    PI * (0.55 * re.sqrt() + 0.084 * third * third)
}

/// A formula of `Cn Re` and its derivative by `ln Re`.
type Branch = fn(f64) -> (f64, f64);

fn low(re: f64) -> (f64, f64) {
    // infinite at Re = 0, where both results are zero
    let i = 1.0 / (8.0_f64.ln() - 0.077215665 - re.ln());
    (8.0 * PI * i * (1.0 - 0.87 * i * i), 8.0 * PI * i * i * (1.0 - 2.61 * i * i))
}
fn middle(re: f64) -> (f64, f64) {
    let p = 8.55 * re.powf(0.1);
    (1.45 * re + p, 1.45 * re + 0.1 * p)
}
fn high(re: f64) -> (f64, f64) {
    let p = re.sqrt();
    (1.1 * re + 4.0 * p, 1.1 * re + 2.0 * p)
}

/// `Cn Re` and its derivative by `ln Re`: both are finite and zero at `Re = 0`.
#[inline(always)]
fn cn_re<R: Real>(re: R, blend: Option<f64>) -> (R, R) {
    let root = re.sqrt();
    let mut y = (R::of(1.1).fma(re, R::of(4.0) * root), R::of(1.1).fma(re, R::of(2.0) * root));
    // cables are nearly always above the last edge; logarithms and powers are for those that aren't
    let last = 30.0 * (1.0 + blend.unwrap_or(0.0));
    if !re.all_gt(R::of(last)) {
        y = (re.map(|re| cn_re_one(re, blend).0), re.map(|re| cn_re_one(re, blend).1));
    }
    y
}

fn cn_re_one(re: f64, blend: Option<f64>) -> (f64, f64) {
    let edges: [(f64, Branch, Branch); 2] = [(1.0, low, middle), (30.0, middle, high)];
    for (edge, below, above) in edges {
        if let Some(b) = blend
            && (re - edge).abs() < b * edge
        {
            return blended(re, edge, b, below, above);
        }
        if re <= edge {
            return below(re);
        }
    }
    high(re)
}

/// Goes from one formula to the next by a smooth step. Each formula is continued beyond its edge by its tangent,
/// never evaluated there: the first one has a pole at `Re` = 7.4.
fn blended(re: f64, edge: f64, b: f64, below: Branch, above: Branch) -> (f64, f64) {
    let tangent = |f: Branch| {
        let (y, slope) = f(edge);
        (y + slope * (re - edge) / edge, slope * re / edge)
    };
    let (y0, d0) = if re <= edge { below(re) } else { tangent(below) };
    let (y1, d1) = if re > edge { above(re) } else { tangent(above) };
    let u = 0.5 + 0.5 * (re - edge) / (b * edge);
    let step = u * u * (3.0 - 2.0 * u);
    let rise = 6.0 * u * (1.0 - u) * 0.5 * re / (b * edge);
    (y0 + step * (y1 - y0), d0 + step * (d1 - d0) + rise * (y1 - y0))
}
