//! Added mass that is the same in all directions.

use crate::froude_krylov::carry;
use crate::wetted::add_in_waves;
use crate::{AddedMass, Immersed, InWaves, Theory};
use ropewalk_core::{Gives, Law, Load, Real, Station};
use ropewalk_scene::Sea;
use std::f64::consts::PI;
use std::sync::Arc;

/// Added mass of a slender body that is the same along and across: `f = -m (a - u̇)` per unstretched length, `m = Ca ρ π d²/4`.
///
/// Beside [`AddedMass`] of the difference, whose energy is `½ (m_a - m) |P w|²`, it makes the water's energy `½ m_a |P w|² + ½ m (w·t)²`
/// with the velocity `w` relative to the water: that is `½ (m_a - m) |P w|² + ½ m |w|²`. So Munk's moment goes by the difference. `u̇` is the
/// acceleration along the path of the water with [`Theory::Energy`] (Taylor 1928), that at a fixed place with [`Theory::Morison`]. As of
/// point masses, the water's energy isn't counted: its power is supplied.
#[derive(Clone, Debug, PartialEq)]
pub struct AllRound {
    density: f64,
    coefficient: f64,
    current: ropewalk_scene::Current,
    sea: Option<Arc<Sea>>,
    theory: Theory,
}

impl AllRound {
    /// With this coefficient, in the water of another law and by its theory.
    pub fn new(law: &AddedMass, coefficient: f64) -> Self {
        AllRound {
            density: law.density,
            coefficient,
            current: law.current.clone(),
            sea: law.sea.clone(),
            theory: law.theory,
        }
    }
}

impl Law for AllRound {
    const NEEDS_DIAMETER: bool = true;
    fn label(&self) -> String {
        "added mass along".into()
    }
    fn follows_material(&self) -> bool {
        true
    }
    fn gives(&self) -> Gives {
        Gives { x: self.sea.is_some(), a: true, ..Gives::NOTHING }
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
}

impl Immersed for AllRound {
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
        let mass = R::of(self.coefficient * self.density * PI / 4.0) * at.diameter * at.diameter;
        for i in 0..3 {
            out.f[i] -= mass * at.a[i];
            if TANGENT {
                out.d_a[i][i] -= mass;
            }
        }
        if let Some(waves) = waves {
            carry::<R, TANGENT, D>(mass, self.theory, &self.current, at, waves, out);
        }
    }
}
