//! Added mass: the water that a slender body pushes aside.

use crate::all_round::AllRound;
use crate::buoyancy::surface;
use crate::drag::{add, free_tips, velocity};
use crate::wetted::add_in_waves;
use crate::{BluntEnd, FeedingEnd, FroudeKrylov, Immersed, InWaves, Surface, Wetted, at_tip};
use ropewalk_core::error::not_negative;
use ropewalk_core::{BuildError, Gives, Law, Load, Part, Power, Real, Station, V3, dot, scaled};
use ropewalk_scene::{Builder, Current, ForceSpec, Sea, Swell, quantity, register_spec};
use ropewalk_sea::transposed_times;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;
use std::sync::Arc;

/// What the water that a body pushes aside answers with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Theory {
    /// All that follows from the kinetic energy of the water: inertia, and what flow along a body does that turns or
    /// bends (Munk's moment on a hull; the terms of Lighthill and Païdoussis on a cable, which act like compression).
    #[default]
    Energy,
    /// Morison's inertia term alone, as most codes have it: for comparison, and for cables that change their length.
    Morison,
}

/// Added mass of a slender body: the kinetic energy of the water is `½ m_a |P (v - u)|²` per unstretched length, with
/// `m_a = Ca ρ π d²/4`, `P = I - t tᵀ` and `t = r'/|r'|` (slender-body theory after Munk and Lighthill; `Ca` = 1 for a
/// circular cylinder).
///
/// Lagrange's equations give, with `w = v - u`, `n = P w`, `λ = |r'|` and `θ = P ∂v/∂s / λ`, the rate at which the tangent
/// turns,
///
/// `f = -m_a [P a - (w·t) θ - (θ·n) t]` and `g = -m_a (w·t)/λ n`, conjugate to `r'`;
///
/// [`Theory::Morison`] leaves `f = -m_a P a`. How the current changes from place to place acts through `u` alone: what
/// a shear does to the added mass itself is outside the theory. Waves, whose flow is a potential's, are within: with their
/// gradient `G` and rate `u_t`, `a` becomes `a - u_t - G v`, and `f` has `-m_a Gᵀ n` besides; after Morison `a` becomes
/// `a - u_t`, as most codes have it. `d` is the hydrodynamic diameter of the station, so a
/// hollow or flooded section is counted by its outside. Use it beside [`Drag`](crate::Drag). With the energy the water's
/// share is part of the kinetic energy; without, its power `f·v` is given by the water to the body.
#[derive(Clone, Debug, PartialEq)]
pub struct AddedMass {
    /// Density of the fluid `ρ` [kg/m³].
    pub density: f64,
    /// Added mass coefficient `Ca`.
    pub coefficient: f64,
    /// Velocity of the fluid.
    pub current: Current,
    /// Waves, whose velocity adds to it.
    pub sea: Option<Arc<Sea>>,
    /// What the water answers with.
    pub theory: Theory,
}

impl AddedMass {
    /// Added mass in still fluid of the given density.
    ///
    /// # Errors
    /// Negative or infinite numbers.
    pub fn new(density: f64, coefficient: f64) -> Result<Self, BuildError> {
        not_negative("density of the fluid", density)?;
        not_negative("added mass coefficient", coefficient)?;
        Ok(AddedMass { density, coefficient, current: Current::Still, sea: None, theory: Theory::Energy })
    }

    /// The same in a current.
    ///
    /// # Errors
    /// A bad current.
    pub fn in_current(self, current: Current) -> Result<Self, BuildError> {
        current.check()?;
        Ok(AddedMass { current, ..self })
    }

    /// The same in waves.
    #[must_use]
    pub fn in_waves(self, sea: Option<Arc<Sea>>) -> Self {
        AddedMass { sea, ..self }
    }

    /// The same by another theory.
    #[must_use]
    pub fn by(self, theory: Theory) -> Self {
        AddedMass { theory, ..self }
    }

    /// `m_a` [kg/m].
    #[inline(always)]
    pub(crate) fn mass<R: Real>(&self, diameter: R) -> R {
        R::of(self.coefficient * self.density * PI / 4.0) * diameter * diameter
    }

    /// Velocity of the fluid at a place [m/s].
    #[inline(always)]
    pub(crate) fn fluid<R: Real>(&self, t: f64, x: &V3<R>) -> V3<R> {
        velocity(&self.current, self.sea.as_ref().map(|sea| sea.at(t, x)).as_ref(), x)
    }

    /// The answer to the acceleration relative to the water.
    #[inline(always)]
    fn inertia<R: Real, const TANGENT: bool, const D: usize>(
        &self,
        at: &Station<R>,
        waves: Option<&mut InWaves<R, D>>,
        out: &mut Load<R>,
    ) {
        let mass = self.mass(at.diameter);
        let inverse = R::of(1.0) / dot(&at.slope, &at.slope).sqrt();
        let t = scaled(inverse, &at.slope);
        let mut a = at.a;
        if let Some(waves) = &waves {
            let (swell, carried) = (&waves.swell, waves.swell.carried(&at.v));
            for i in 0..3 {
                a[i] -= match self.theory {
                    Theory::Morison => swell.acceleration[i],
                    Theory::Energy => swell.rate[i] + carried[i],
                };
            }
        }
        let axial = dot(&a, &t);
        let mut normal = a;
        for i in 0..3 {
            normal[i] -= axial * t[i];
            out.f[i] -= mass * normal[i];
        }
        if TANGENT {
            let turn = mass * inverse;
            for i in 0..3 {
                for j in 0..3 {
                    let tt = t[i] * t[j];
                    let p = if i == j { R::of(1.0) - tt } else { -tt };
                    out.d_a[i][j] -= mass * p;
                    out.d_slope[i][j] += turn * axial.fma(p, t[i] * normal[j]);
                }
            }
            if let Some(waves) = waves {
                // P times what the acceleration of the water changes by
                let by_x = waves.swell.acceleration_by_x;
                let along = transposed_times(&by_x, &waves.swell.axes.along(&t));
                waves.add(mass, &by_x);
                waves.add_outer(&scaled(-mass, &t), &along);
            }
        }
    }

    #[inline(always)]
    fn flow<R: Real, const TANGENT: bool, const D: usize>(
        &self,
        at: &Station<R>,
        waves: Option<&mut InWaves<R, D>>,
        out: &mut Load<R>,
    ) {
        let mass = self.mass(at.diameter);
        let inverse = R::of(1.0) / dot(&at.slope, &at.slope).sqrt();
        let t = scaled(inverse, &at.slope);
        let (mut u, du) = self.current.at(at.x[2]);
        if let Some(waves) = &waves {
            add(&mut u, &waves.swell.u);
        }
        let mut w = at.v;
        for i in 0..3 {
            w[i] -= u[i];
        }
        let (along, spread) = (dot(&w, &t), dot(&at.slope_rate, &t) * inverse);
        let (mut n, mut theta) = (w, scaled(inverse, &at.slope_rate));
        for i in 0..3 {
            n[i] -= along * t[i];
            theta[i] -= spread * t[i];
        }
        let both = dot(&theta, &n);
        let per = mass * inverse;
        for i in 0..3 {
            out.f[i] += mass * along.fma(theta[i], both * t[i]);
            out.g[i] -= per * along * n[i];
        }
        // what the gradient takes from the flow across
        if let Some(waves) = &waves {
            let Swell { axes, gradient, .. } = &waves.swell;
            let taken = axes.vector(&transposed_times(gradient, &axes.along(&n)));
            for i in 0..3 {
                out.f[i] -= mass * taken[i];
            }
        }
        if !TANGENT {
            return;
        }
        let (mut by_w, mut g_by_w) = ([[R::zero(); 3]; 3], [[R::zero(); 3]; 3]);
        for i in 0..3 {
            for j in 0..3 {
                let p = if i == j { R::of(1.0) - t[i] * t[j] } else { -(t[i] * t[j]) };
                by_w[i][j] = mass * theta[i].fma(t[j], t[i] * theta[j]);
                g_by_w[i][j] = -(per * along.fma(p, n[i] * t[j]));
                out.d_v[i][j] += by_w[i][j];
                out.g_v[i][j] += g_by_w[i][j];
                out.d_rate[i][j] += per * along.fma(p, t[i] * n[j]);
                let turned = along.fma(theta[i], both * t[i]);
                let stretched = (along + along).fma(theta[j], spread * n[j]);
                let still = (both - along * spread).fma(p, theta[i] * n[j]);
                out.d_slope[i][j] += per * (still - turned * t[j] - t[i] * stretched);
                let normal = n[i] * n[j] - along * along * p;
                out.g_slope[i][j] -= per * inverse * (normal - along * t[i].fma(n[j], n[i] * t[j]));
            }
        }
        if let Some(waves) = waves {
            let Swell { axes, gradient, .. } = waves.swell;
            let (g, lean) = (axes.matrix(&gradient), transposed_times(&gradient, &axes.along(&t)));
            let lean = axes.vector(&lean);
            for i in 0..3 {
                for j in 0..3 {
                    // Gᵀ P, and beside it P G of the acceleration relative to the water
                    let (taken, given) = (g[j][i] - lean[i] * t[j], g[i][j] - t[i] * lean[j]);
                    out.d_slope[i][j] += per * along.fma(taken, lean[i] * n[j]);
                    out.d_v[i][j] += mass * (given - taken);
                    by_w[i][j] -= mass * taken;
                }
            }
            // how the gradient itself changes is left out: iterations don't need it
            waves.drift(&by_w);
            waves.drift_couple(&g_by_w);
        }
        if !self.current.is_uniform() {
            // the current changes with height alone
            for i in 0..3 {
                out.d_x[i][2] -= dot(&by_w[i], &du);
                out.g_x[i][2] -= dot(&g_by_w[i], &du);
            }
        }
    }

    /// The velocity of the water and that relative to it, whose part across the axis is `n`.
    #[inline(always)]
    fn relative<R: Real>(&self, t: f64, at: &Station<R>) -> Relative<R> {
        let swell = self.sea.as_ref().map(|sea| sea.along(t, at));
        let u = velocity(&self.current, swell.as_ref(), &at.x);
        let square = dot(&at.slope, &at.slope);
        let mut w = at.v;
        for i in 0..3 {
            w[i] -= u[i];
        }
        let (along, mut n) = (dot(&w, &at.slope) / square, w);
        for i in 0..3 {
            n[i] -= along * at.slope[i];
        }
        Relative { u, w, n }
    }
}

/// How a station moves relative to the water.
struct Relative<R> {
    u: V3<R>,
    w: V3<R>,
    n: V3<R>,
}

impl Law for AddedMass {
    const NEEDS_DIAMETER: bool = true;
    fn label(&self) -> String {
        match self.theory {
            Theory::Energy => "added mass".into(),
            Theory::Morison => "added mass (Morison)".into(),
        }
    }
    fn follows_material(&self) -> bool {
        self.theory == Theory::Energy
    }
    fn gives(&self) -> Gives {
        match self.theory {
            Theory::Energy => Gives { x: self.sea.is_some() || !self.current.is_uniform(), ..Gives::ALL },
            Theory::Morison => Gives { x: self.sea.is_some(), slope: true, a: true, ..Gives::NOTHING },
        }
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

    #[inline(always)]
    fn power<R: Real>(&self, t: f64, at: &Station<R>, load: &Load<R>) -> Power<R> {
        let supplied = match self.theory {
            Theory::Morison => dot(&load.f, &at.v),
            // what a body takes along in a shear isn't part of the theory: nor is its energy
            Theory::Energy => {
                let (Relative { u, w, n }, (_, du)) = (self.relative(t, at), self.current.at(at.x[2]));
                let mut met = at.v[2] * dot(&n, &du);
                if let Some(sea) = &self.sea {
                    let swell = sea.along(t, at);
                    let Swell { gradient, by_x, by_t, rate, .. } = swell;
                    met += dot(&n, &swell.carried(&w));
                    for i in 0..3 {
                        // above the surface the water has the velocity that it has at the surface
                        met += n[i] * (dot(&by_x[i], &at.v) - dot(&gradient[i], &at.v) + by_t[i] - rate[i]);
                    }
                }
                dot(&load.f, &u) - self.mass(at.diameter) * met
            }
        };
        Power { supplied, ..Power::zero() }
    }

    #[inline(always)]
    fn kinetic<R: Real>(&self, t: f64, at: &Station<R>) -> R {
        match self.theory {
            Theory::Morison => R::zero(),
            Theory::Energy => {
                let n = self.relative(t, at).n;
                R::of(0.5) * self.mass(at.diameter) * dot(&n, &n)
            }
        }
    }
}

impl Immersed for AddedMass {
    #[inline(always)]
    fn sea(&self) -> Option<&Arc<Sea>> {
        self.sea.as_ref()
    }
    #[inline(always)]
    fn load_in<R: Real, const TANGENT: bool, const D: usize>(
        &self,
        at: &Station<R>,
        mut waves: Option<&mut InWaves<R, D>>,
        out: &mut Load<R>,
    ) {
        self.inertia::<R, TANGENT, D>(at, waves.as_deref_mut(), out);
        if self.theory == Theory::Energy {
            self.flow::<R, TANGENT, D>(at, waves, out);
        }
    }
}

fn one() -> f64 {
    1.0
}

/// Added mass of cables and hulls: inertia of the water, and its forces in flow along the body. In waves also the force of their
/// pressure on the volume displaced (Froude-Krylov), in all directions.
///
/// It follows from the kinetic energy of the water: a hull at an angle to the flow has Munk's moment, and flow along
/// a cable acts like compression and can cause flutter. `theory = "morison"` keeps the inertia only, for comparison
/// with codes that have no more. In waves `morison` takes the acceleration of the water at a fixed place, as most codes do;
/// otherwise it is that along the path of the water, and a line as heavy as water goes with it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AddedMassSpec {
    /// Coefficient: added mass over the mass of water in a cylinder of the hydrodynamic diameter.
    #[serde(default = "one", deserialize_with = "quantity::number")]
    pub ca: f64,
    /// The same along the axis: 0 for smooth cables, about 0.1 for rough ropes, up to 0.5 for chains. At most `ca`.
    #[serde(default, deserialize_with = "quantity::number")]
    pub ca_axial: f64,
    /// `energy` or `morison`. Default: `energy`.
    #[serde(default)]
    pub theory: Option<Theory>,
    /// Fraction of its momentum that the water returns at free ends of cables: 0 for cut ends, about 0.8 for tapered
    /// ends, 1 for an ideal tail.
    #[serde(default, deserialize_with = "quantity::number")]
    pub tail: f64,
    /// Parts it acts on. Default: all.
    #[serde(default)]
    pub on: Vec<String>,
}
register_spec!(Force, "added_mass", AddedMassSpec);

impl Default for AddedMassSpec {
    fn default() -> Self {
        AddedMassSpec { ca: 1.0, ca_axial: 0.0, theory: None, tail: 0.0, on: Vec::new() }
    }
}

#[typetag::serde(name = "added_mass")]
impl ForceSpec for AddedMassSpec {
    fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
        not_negative("ca", self.ca)?;
        if !(0.0..=1.0).contains(&self.tail) {
            return Err(BuildError::at("tail", format!("`tail` must be between 0 and 1, not {}", self.tail)));
        }
        let surface = surface(b)?;
        let water = b.water()?;
        if !(0.0..=self.ca).contains(&self.ca_axial) {
            let message =
                format!("`ca_axial` must be between 0 and `ca` = {}, not {}", self.ca, self.ca_axial);
            return Err(BuildError::at("ca_axial", message));
        }
        // what is the same along and across goes as of a ball, the rest across alone
        let law = AddedMass::new(water.density, self.ca - self.ca_axial)?.in_current(water.current()?)?;
        let law = law.in_waves(water.sea.clone());
        let theory = self.theory.unwrap_or_default();
        for numbered in b.parts(&self.on)? {
            b.acts_once("added_mass", &numbered)?;
            if theory == Theory::Energy {
                self.add_ends(b, numbered.1.as_ref(), &law, surface.as_ref());
            }
        }
        let law = law.by(theory);
        if self.ca_axial > 0.0 {
            let all_round = AllRound::new(&law, self.ca_axial);
            match surface.clone() {
                None => b.load(&self.on, all_round)?,
                Some(surface) => b.load(&self.on, Wetted::below(surface, all_round))?,
            }
        }
        match surface {
            None => b.load(&self.on, law),
            Some(surface) => {
                if let Some(sea) = law.sea.clone() {
                    let waves =
                        FroudeKrylov { density: law.density, current: law.current.clone(), sea, theory };
                    b.load(&self.on, Wetted::below(surface.clone(), waves))?;
                }
                b.load(&self.on, Wetted::below(surface, law))
            }
        }
    }
}

impl AddedMassSpec {
    /// Water leaves at the ends of a cable or a chain that nothing holds. Hulls of single bodies keep what it has, as
    /// Kirchhoff's equations have it. Where an end feeds, more or less of the cable has water beside it.
    fn add_ends(&self, b: &mut Builder, part: &dyn Part, law: &AddedMass, surface: Option<&Surface>) {
        for tip in free_tips(b, part).into_iter().filter(|tip| tip.sheds) {
            let (added_mass, taper) = (law.clone(), self.tail);
            let surface = surface.cloned();
            let end = BluntEnd { added_mass, diameter: tip.diameter, taper, first: tip.first, surface };
            if let Some(term) = at_tip(end, part.name(), b.nodes(), &tip) {
                b.term(term);
            }
        }
        let diameter = part.tips().first().map_or(0.0, |tip| tip.diameter);
        for (end, name) in [(0, "start"), (1, "end")] {
            if let Some(boundary) = part.boundary(end).filter(|_| diameter > 0.0) {
                let label = format!("{}: water at its {name}", part.name());
                let (added_mass, surface) = (law.clone(), surface.cloned());
                b.term(Box::new(FeedingEnd { label, added_mass, diameter, surface, boundary }));
            }
        }
    }
}
