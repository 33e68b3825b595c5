//! The pressure of waves on what is in them.

use crate::wetted::add_in_waves;
use crate::{Immersed, InWaves, Theory};
use ropewalk_core::{Gives, Law, Load, Real, Station};
use ropewalk_scene::{Current, Sea};
use std::sync::Arc;

/// Force of the pressure that waves have without the body: `ρ A u̇` per unstretched length, in all directions, with the
/// area `A` of the displaced volume.
///
/// Along the axis it has the same coefficient: with the effective tension of a cable, the lateral pressure of a curved tube
/// leaves `-A ∇p` in all; of a hull that is what acts on its sides and ends together. With [`Theory::Energy`] `u̇` is the
/// acceleration along the path of the water, `∂u/∂t + G u`; with [`Theory::Morison`] it is `∂u/∂t`. All of its power is supplied.
#[derive(Clone, Debug, PartialEq)]
pub struct FroudeKrylov {
    /// Density of the water `ρ` [kg/m³].
    pub density: f64,
    /// Velocity of the water without waves, which carries them past.
    pub current: Current,
    /// The waves.
    pub sea: Arc<Sea>,
    /// Which acceleration counts.
    pub theory: Theory,
}

impl Law for FroudeKrylov {
    fn label(&self) -> String {
        "pressure of waves".into()
    }
    fn gives(&self) -> Gives {
        Gives { x: true, ..Gives::NOTHING }
    }
    fn timed(&self) -> bool {
        true
    }
    fn reach(&self, _t: f64, h: f64) -> Option<f64> {
        Some(self.sea.reach(h))
    }
    fn period(&self, _t: f64) -> f64 {
        self.sea.period()
    }
    #[inline(always)]
    fn load<R: Real, const TANGENT: bool>(&self, t: f64, at: &Station<R>, out: &mut Load<R>) {
        add_in_waves::<R, TANGENT, 3>(self, at, Some(&self.sea.along(t, at)), out);
    }
}

impl Immersed for FroudeKrylov {
    #[inline(always)]
    fn sea(&self) -> Option<&Arc<Sea>> {
        Some(&self.sea)
    }
    #[inline(always)]
    fn load_in<R: Real, const TANGENT: bool, const D: usize>(
        &self,
        at: &Station<R>,
        waves: Option<&mut InWaves<R, D>>,
        out: &mut Load<R>,
    ) {
        if let Some(waves) = waves {
            carry::<R, TANGENT, D>(R::of(self.density) * at.area, self.theory, &self.current, at, waves, out);
        }
    }
}

/// Adds the force that gives a mass [kg/m] the acceleration of the water.
#[inline(always)]
pub(crate) fn carry<R: Real, const TANGENT: bool, const D: usize>(
    mass: R,
    theory: Theory,
    current: &Current,
    at: &Station<R>,
    waves: &mut InWaves<R, D>,
    out: &mut Load<R>,
) {
    let swell = &waves.swell;
    let (a, by_x, by_z) = match theory {
        Theory::Energy => swell.along_path(current, at.x[2]),
        Theory::Morison => (swell.acceleration, swell.acceleration_by_x, [R::zero(); 3]),
    };
    for i in 0..3 {
        out.f[i] = mass.fma(a[i], out.f[i]);
    }
    if TANGENT {
        waves.add(mass, &by_x);
        if theory == Theory::Energy && !current.is_uniform() {
            for i in 0..3 {
                out.d_x[i][2] = mass.fma(by_z[i], out.d_x[i][2]);
            }
        }
    }
}
