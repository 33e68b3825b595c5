//! Buoyancy at the surface of water at rest: a potential, so that energy is kept.

use crate::Surface;
use ropewalk_core::error::{not_negative, positive};
use ropewalk_core::held::{Held, Pull, pull};
use ropewalk_core::{
    Assembly, At, BuildError, Energy, Gives, Law, Load, Pattern, Power, Real, Station, Term,
};
use std::f64::consts::PI;

/// Buoyancy of a slender body that may lie across the surface, `ρ g A φ` per length upwards.
///
/// Its potential is `ρ g A W` per length, see [`Surface::wet`]: besides lifting it rights a body whose waterplane tilts. All
/// under water it is the buoyancy of the whole volume.
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

impl Law for Buoyancy {
    fn label(&self) -> String {
        "buoyancy".into()
    }
    fn gives(&self) -> Gives {
        Gives { x: true, slope: true, couple: self.couple, ..Gives::NOTHING }
    }
    #[inline(always)]
    fn load<R: Real, const TANGENT: bool>(&self, _t: f64, at: &Station<R>, out: &mut Load<R>) {
        let (wet, k) = (self.surface.wet(at), R::of(self.specific_weight) * at.area);
        out.f[2] += k * wet.share;
        for i in 0..3 {
            if self.couple {
                out.g[i] -= k * wet.depth_by_slope[i];
            }
            if TANGENT {
                out.d_slope[2][i] += k * wet.share_by_slope[i];
            }
        }
        if !TANGENT {
            return;
        }
        out.d_x[2][2] += k * wet.share_by_z;
        if self.couple {
            for i in 0..3 {
                out.g_x[i][2] += k * wet.share_by_slope[i];
                for j in 0..3 {
                    out.g_slope[i][j] -= k * wet.depth_by_slopes[i][j];
                }
            }
        }
    }
    #[inline(always)]
    fn power<R: Real>(&self, _t: f64, at: &Station<R>, load: &Load<R>) -> Power<R> {
        let supplied = if self.couple { R::zero() } else { load.f[2] * at.v[2] };
        Power { supplied, ..Power::zero() }
    }
    #[inline(always)]
    fn potential<R: Real>(&self, _t: f64, at: &Station<R>) -> R {
        if self.couple {
            R::of(self.specific_weight) * at.area * self.surface.wet(at).depth
        } else {
            R::zero()
        }
    }
}

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
        self.surface.ball(self.held.x(at)[2], ball_radius(self.volume))
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
        !matches!(self.held, Held::Beside { .. })
    }
    fn is_load(&self) -> bool {
        true
    }
    fn add(&self, at: &At<'_>, out: &mut Assembly<'_>) {
        let (lift, (share, by_z)) = (self.specific_weight * self.volume, self.share(at));
        let mut force = Pull { f: [0.0, 0.0, lift * share], ..Pull::default() };
        force.by_x[2][2] = lift * by_z;
        pull(&[Held::Ground([0.0; 3]), self.held], at, &force, 0, out);
    }
    fn energy(&self, at: &At<'_>) -> Energy {
        let r = ball_radius(self.volume);
        let s = self.surface.level - self.held.x(at)[2];
        let u = (s / r).clamp(-1.0, 1.0);
        // ∫ (½ + ¾ u - ¼ u³) du, from where the ball is dry; below the surface it grows by the depth
        let mean = 0.5 * u + 0.375 * u * u - 0.0625 * u.powi(4) + 0.1875 + (s / r - u).max(0.0);
        Energy { potential: self.specific_weight * self.volume * r * mean, ..Energy::default() }
    }
}
