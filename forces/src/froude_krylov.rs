//! The pressure of waves on what is in them.

use crate::{Immersed, Theory};
use ropewalk_core::{Gives, Law, Load, Real, Station};
use ropewalk_scene::{Current, Sea, Swell};
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
    #[inline(always)]
    fn load<R: Real, const TANGENT: bool>(&self, t: f64, at: &Station<R>, out: &mut Load<R>) {
        let swell = self.sea.along(t, at);
        self.load_in::<R, TANGENT>(at, Some(&swell), out);
    }
}

impl Immersed for FroudeKrylov {
    #[inline(always)]
    fn sea(&self) -> Option<&Arc<Sea>> {
        Some(&self.sea)
    }
    #[inline(always)]
    fn load_in<R: Real, const TANGENT: bool>(
        &self,
        at: &Station<R>,
        swell: Option<&Swell<R>>,
        out: &mut Load<R>,
    ) {
        let Some(swell) = swell else { return };
        let mass = R::of(self.density) * at.area;
        let (a, by_x) = match self.theory {
            Theory::Energy => swell.along_path(&self.current, at.x[2]),
            Theory::Morison => (swell.acceleration, swell.acceleration_by_x),
        };
        for i in 0..3 {
            out.f[i] = mass.fma(a[i], out.f[i]);
            if TANGENT {
                for j in 0..3 {
                    out.d_x[i][j] = mass.fma(by_x[i][j], out.d_x[i][j]);
                }
            }
        }
    }
}
