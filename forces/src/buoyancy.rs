//! Buoyancy at the surface of water: at rest a potential, so that energy is kept.

use crate::gravity::dead_loads;
use crate::in_water::InWater;
use crate::{Surface, Wet};
use ropewalk_core::error::{not_negative, positive};
use ropewalk_core::held::{Held, Pull, pull};
use ropewalk_core::{
    Assembly, At, BuildError, Energy, Gives, Joined, Law, Load, Pattern, Per, Power, Real, Station, Term,
    Timed, V3,
};
use ropewalk_scene::{Builder, ForceSpec, register_spec};
use ropewalk_sea::Top;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::any::Any;
use std::f64::consts::PI;

/// Buoyancy of a slender body that may lie across the surface, `ρ g A φ` per length upwards.
///
/// Its potential is `ρ g A W` per length, see [`Surface::wet`]: besides lifting it rights a body whose waterplane tilts. All
/// under water it is the buoyancy of the whole volume. Waves change the potential, and so give and take energy, by how they
/// raise the surface; their pressure is another law, [`FroudeKrylov`](crate::FroudeKrylov).
#[derive(Clone, Debug, PartialEq)]
pub struct Buoyancy {
    /// `ρ g` [N/m³].
    pub specific_weight: f64,
    /// The surface.
    pub surface: Surface,
    /// Whether the body can carry the couple of a tilted waterplane. Without, as on cables that change their length, it
    /// counts as a load from outside.
    pub couple: bool,
}

impl Buoyancy {
    /// The load of a station that lies so in the water, whose surface stands so in waves.
    #[inline(always)]
    pub(crate) fn lift<R: Real, const TANGENT: bool>(
        &self,
        at: &Station<R>,
        wet: &Wet<R>,
        top: Option<&Top<R>>,
        out: &mut Load<R>,
    ) {
        let k = R::of(self.specific_weight) * at.area;
        out.f[2] += k * wet.lift;
        for i in 0..3 {
            if self.couple {
                out.g[i] -= k * wet.depth_by_slope[i];
            }
            if TANGENT {
                out.d_slope[2][i] += k * wet.lift_by_slope[i];
            }
        }
        if !TANGENT {
            return;
        }
        out.d_x[2][2] += k * wet.lift_by_z;
        if self.couple {
            for i in 0..3 {
                out.g_x[i][2] += k * wet.lift_by_slope[i];
                for j in 0..3 {
                    out.g_slope[i][j] -= k * wet.depth_by_slopes[i][j];
                }
            }
        }
        let Some(top) = top else { return };
        for j in 0..2 {
            let by_x = k * top.slope[j];
            out.d_x[2][j] -= by_x * wet.lift_by_z;
            if self.couple {
                for i in 0..3 {
                    out.g_x[i][j] -= by_x * wet.lift_by_slope[i];
                }
            }
        }
    }
}

impl Law for Buoyancy {
    fn label(&self) -> String {
        "buoyancy".into()
    }
    fn gives(&self) -> Gives {
        Gives { x: true, slope: true, couple: self.couple, ..Gives::NOTHING }
    }
    fn timed(&self) -> bool {
        self.surface.sea.is_some()
    }
    fn reach(&self, _t: f64, h: f64) -> Option<f64> {
        Some(self.surface.reach(h))
    }
    fn period(&self, _t: f64) -> f64 {
        self.surface.period()
    }
    #[inline(always)]
    fn load<R: Real, const TANGENT: bool>(&self, t: f64, at: &Station<R>, out: &mut Load<R>) {
        let top = self.surface.top(t, at);
        let wet = self.surface.wet(at, top.as_ref());
        self.lift::<R, TANGENT>(at, &wet, top.as_ref(), out);
    }
    #[inline(always)]
    fn power<R: Real>(&self, t: f64, at: &Station<R>, load: &Load<R>) -> Power<R> {
        let supplied = match self.surface.top(t, at) {
            _ if !self.couple => load.f[2] * at.v[2],
            None => R::zero(),
            // what lies deeper under a surface that has risen has more potential energy
            Some(top) => load.f[2] * top.rise(&at.v),
        };
        Power { supplied, ..Power::zero() }
    }
    #[inline(always)]
    fn potential<R: Real>(&self, t: f64, at: &Station<R>) -> R {
        if self.couple {
            let top = self.surface.top(t, at);
            R::of(self.specific_weight) * at.area * self.surface.wet(at, top.as_ref()).depth
        } else {
            R::zero()
        }
    }
    fn join(&self, other: &dyn Any) -> Option<Joined> {
        InWater::join(&self.surface, self, other)
    }
    fn local(&self, quantity: &str, _: f64, at: &Station<f64>) -> Option<f64> {
        match quantity {
            SPECIFIC_WEIGHT => Some(self.specific_weight),
            LEVEL => Some(self.surface.level),
            AREA => Some(at.area),
            _ => None,
        }
    }
}

/// What the wall of a cable asks of the water around: its specific weight [N/m³], the height of its surface at rest [m], and the area
/// displaced per unstretched length [m²].
pub(crate) const SPECIFIC_WEIGHT: &str = "specific weight of the water around";
pub(crate) const LEVEL: &str = "level of the water around";
pub(crate) const AREA: &str = "area displaced";

/// Buoyancy of a ball: of a compact body that may lie across the surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Float {
    /// A name, such as `buoy: buoyancy`.
    pub label: String,
    /// Its middle.
    pub held: Held,
    /// Its volume [m³].
    pub volume: f64,
    /// `ρ g` [N/m³].
    pub specific_weight: f64,
    /// The surface.
    pub surface: Surface,
}

/// The radius of a ball of this volume.
pub fn ball_radius(volume: f64) -> f64 {
    (0.75 * volume / PI).cbrt()
}

impl Float {
    /// A ball of a volume [m³] in water of specific weight `ρ g` [N/m³].
    ///
    /// # Errors
    /// A volume that isn't positive, a negative weight.
    pub fn new(
        label: impl Into<String>,
        held: Held,
        volume: f64,
        specific_weight: f64,
        surface: Surface,
    ) -> Result<Self, BuildError> {
        positive("volume", volume)?;
        not_negative("specific weight of the water", specific_weight)?;
        Ok(Float { label: label.into(), held, volume, specific_weight, surface })
    }

    /// Wet share, and what it changes by with height.
    fn share(&self, at: &At<'_>) -> (f64, f64) {
        self.surface.ball(at.t, &self.held.x(at), ball_radius(self.volume))
    }
    /// How the surface stands in waves above it.
    fn top(&self, at: &At<'_>) -> Option<Top<f64>> {
        self.surface.top_at(at.t, &self.held.x(at))
    }
}

impl Term for Float {
    fn label(&self) -> String {
        self.label.clone()
    }
    fn pattern(&self, p: &mut Pattern) {
        p.clique(self.held.dofs());
    }
    fn symmetric(&self) -> bool {
        !matches!(self.held, Held::Beside { .. }) && self.surface.sea.is_none()
    }
    fn is_load(&self) -> bool {
        true
    }
    fn add(&self, at: &At<'_>, out: &mut Assembly<'_>) {
        let (lift, (share, by_z)) = (self.specific_weight * self.volume, self.share(at));
        let mut force = Pull { f: [0.0, 0.0, lift * share], ..Pull::default() };
        force.by_x[2][2] = lift * by_z;
        if let Some(top) = self.top(at) {
            (force.by_x[2][0], force.by_x[2][1]) = (-lift * by_z * top.slope[0], -lift * by_z * top.slope[1]);
        }
        pull(&[Held::Ground([0.0; 3]), self.held], at, &force, 0, out);
    }
    fn energy(&self, at: &At<'_>) -> Energy {
        let r = ball_radius(self.volume);
        let risen = self.top(at).map_or(0.0, |top| top.elevation);
        let s = self.surface.level + risen - self.held.x(at)[2];
        let u = (s / r).clamp(-1.0, 1.0);
        // ∫ (½ + ¾ u - ¼ u³) du, from where the ball is dry; below the surface it grows by the depth
        let mean = 0.5 * u + 0.375 * u * u - 0.0625 * u.powi(4) + 0.1875 + (s / r - u).max(0.0);
        Energy { potential: self.specific_weight * self.volume * r * mean, ..Energy::default() }
    }
    fn power(&self, at: &At<'_>) -> Power {
        let lift = self.specific_weight * self.volume * self.share(at).0;
        let rise = self.top(at).map_or(0.0, |top| top.rise(&self.held.velocity(at)));
        Power { supplied: lift * rise, ..Power::default() }
    }
    fn timed(&self) -> Option<&dyn Timed> {
        self.surface.sea.as_ref().map(|_| self as &dyn Timed)
    }
}

impl Timed for Float {
    fn reach(&self, _t: f64, h: f64) -> Option<f64> {
        Some(self.surface.reach(h))
    }
    fn period(&self, _t: f64) -> f64 {
        self.surface.period()
    }
}

/// Buoyancy of the displaced volume; if the water has a `level`, of the volume under water.
///
/// At the surface, cables, hulls and chains are cylinders; other bodies and point masses are spheres. In waves it is that
/// below the surface at each instant; what the pressure of the waves adds comes with `added_mass`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BuoyancySpec {
    /// Parts it acts on. Default: all.
    #[serde(default)]
    pub on: Vec<String>,
}
register_spec!(Force, "buoyancy", BuoyancySpec);

#[typetag::serde(name = "buoyancy")]
impl ForceSpec for BuoyancySpec {
    fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
        let (density, surface) = (b.water()?.density, surface(b)?);
        let lift = b.gravity().map(|g| -density * g);
        match surface {
            None => dead_loads(b, "buoyancy", &self.on, Per::Volume, lift),
            Some(surface) => self.floating(b, lift, surface),
        }
    }
}

impl BuoyancySpec {
    /// Parts that may lie across the surface.
    fn floating(&self, b: &mut Builder, lift: V3<f64>, surface: Surface) -> Result<(), BuildError> {
        let mut slender = Vec::new();
        for part in b.parts(&self.on)? {
            b.acts_once("buoyancy", &part)?;
            let (_, part) = part;
            if part.dead_load(Per::Volume, lift).is_none() {
                continue;
            }
            match part.ball() {
                Some((held, volume)) => {
                    let label = format!("{}: buoyancy", part.name());
                    b.term(Box::new(Float::new(label, held, volume, lift[2], surface.clone())?));
                }
                None => slender.push(part.name().to_string()),
            }
        }
        if slender.is_empty() {
            return Ok(());
        }
        let stiff: Vec<bool> =
            slender.iter().map(|name| b.feeding(name).iter().all(Option::is_none)).collect();
        b.load_by(&slender, |part| {
            let couple = slender.iter().zip(&stiff).any(|(name, stiff)| *stiff && name == part.name());
            Buoyancy { specific_weight: lift[2], surface: surface.clone(), couple }
        })
    }
}

/// The surface of the scene's water, if it has one.
///
/// # Errors
/// Gravity doesn't point down: water at rest isn't level then.
pub(crate) fn surface(b: &Builder) -> Result<Option<Surface>, BuildError> {
    let Some(level) = b.water()?.level else { return Ok(None) };
    let g = b.gravity();
    if g[0] != 0.0 || g[1] != 0.0 || g[2] > 0.0 {
        let message = format!(
            "the water has a `level`, but gravity {g:?} m/s² isn't across it: make it point down, along -z"
        );
        return Err(BuildError::at("gravity", message));
    }
    Ok(Some(Surface { level, sea: b.water()?.sea.clone() }))
}
