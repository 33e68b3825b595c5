//! Form drag of the ends of slender bodies.

use super::TipLaw;
use crate::Surface;
use crate::drag::velocity;
use ropewalk_core::{Real, V3, dot, scaled};
use ropewalk_scene::{Current, Sea};
use std::f64::consts::PI;
use std::sync::Arc;

/// Form drag of an end that is cut off, in flow along the axis: `F = -½ ρ C π d²/4 |w_t| w_t t`, with the axial part
/// `w_t = (v - u)·t` of the velocity relative to the fluid.
#[derive(Clone, Debug, PartialEq)]
pub struct EndDrag {
    /// Density of the fluid `ρ` [kg/m³].
    pub density: f64,
    /// Velocity of the fluid.
    pub current: Current,
    /// Waves, whose velocity adds to it.
    pub sea: Option<Arc<Sea>>,
    /// Coefficient `C` of this end on the area of its face. Both ends of a long blunt cylinder have about 0.8 together.
    pub coefficient: f64,
    /// Diameter `d` [m].
    pub diameter: f64,
    /// The surface of the fluid if it has one, and whether the fluid is above it.
    pub surface: Option<(Surface, bool)>,
}

impl TipLaw for EndDrag {
    fn label(&self) -> &'static str {
        "form drag of an end"
    }
    fn sea(&self) -> Option<&Sea> {
        self.sea.as_deref()
    }
    fn fluid<R: Real>(&self, t: f64, x: &V3<R>) -> V3<R> {
        velocity(&self.current, self.sea().map(|sea| sea.at(t, x)).as_ref(), x)
    }
    fn force<R: Real>(&self, time: f64, x: &V3<R>, v: &V3<R>, slope: &V3<R>) -> V3<R> {
        let u = self.fluid(time, x);
        let w: V3<R> = std::array::from_fn(|i| v[i] - u[i]);
        let t = scaled(R::of(1.0) / dot(slope, slope).sqrt(), slope);
        let along = dot(&w, &t);
        let share = match &self.surface {
            None => R::of(1.0),
            Some((surface, above)) => {
                let (wet, _) = surface.ball(time, x, 0.5 * self.diameter);
                if *above { R::of(1.0) - wet } else { wet }
            }
        };
        let k = R::of(-0.125 * PI * self.density * self.coefficient * self.diameter * self.diameter);
        scaled(share * k * along.abs() * along, &t)
    }
}
