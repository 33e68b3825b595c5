//! Added mass: the water that a slender body pushes aside.

use ropewalk_core::build::{BuildError, not_negative};
use ropewalk_core::{Gives, Law, Load, Real, Station, dot, scaled};
use std::f64::consts::PI;

/// Added mass of a slender body in still water, `f = -m_a (I - t tᵀ) a` per unstretched length, with
/// `m_a = Ca ρ π d²/4` and `t = r'/|r'|` (Morison's inertia term; `Ca` = 1 for a circular cylinder).
///
/// Use it beside [`Drag`](crate::Drag) for cables and hoses in water. `d` is the hydrodynamic diameter of the station,
/// so a hollow or flooded section is counted by its outside. Its power is `f·v`, given by the water to the body: the
/// kinetic energy of the water is not part of the energy balance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AddedMass {
    /// Density of the fluid `ρ` [kg/m³].
    pub density: f64,
    /// Added mass coefficient `Ca`.
    pub coefficient: f64,
}

impl AddedMass {
    /// Added mass in a fluid of the given density.
    ///
    /// # Errors
    /// Negative or infinite numbers.
    pub fn new(density: f64, coefficient: f64) -> Result<Self, BuildError> {
        not_negative("density of the fluid", density)?;
        not_negative("added mass coefficient", coefficient)?;
        Ok(AddedMass { density, coefficient })
    }
}

impl Law for AddedMass {
    const NEEDS_DIAMETER: bool = true;
    fn label(&self) -> String {
        "added mass".into()
    }
    fn gives(&self) -> Gives {
        Gives { slope: true, a: true, ..Gives::NOTHING }
    }

    #[inline(always)]
    fn load<R: Real, const TANGENT: bool>(&self, _t: f64, at: &Station<R>, out: &mut Load<R>) {
        let mass = R::of(self.coefficient * self.density * PI / 4.0) * at.diameter * at.diameter;
        let stretch = dot(&at.slope, &at.slope).sqrt();
        let inverse = R::of(1.0) / stretch;
        let t = scaled(inverse, &at.slope);
        let axial = dot(&at.a, &t);
        let mut normal = at.a;
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
        }
    }
}
