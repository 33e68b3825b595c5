//! What rises out of water that has no surface.

use ropewalk_core::{At, Model, Part};
use ropewalk_scene::Scene;

/// Watches for parts that begin below z = 0 and rise above it, in a scene whose water is everywhere.
pub(crate) struct Surfacing {
    /// Of each part whether it began below; empty before the first sample.
    below: Vec<bool>,
}

impl Surfacing {
    /// For a scene that has water without a surface, and something that acts in it.
    pub(crate) fn of(scene: &Scene) -> Option<Self> {
        let endless = scene.water.as_ref().is_some_and(|water| water.level.is_none());
        let acts = |kind: &str| matches!(kind, "buoyancy" | "drag" | "added_mass");
        let wet = scene.forces.iter().any(|force| acts(force.typetag_name()));
        (endless && wet).then(|| Surfacing { below: Vec::new() })
    }

    /// What to say of parts that have risen since the last sample.
    pub(crate) fn look(&mut self, model: &Model, at: &At<'_>) -> Vec<String> {
        // what lies at z = 0 to within rounding neither begins below nor rises
        let slight = 1e-3 * model.length();
        if self.below.is_empty() {
            self.below = model.parts().iter().map(|part| top(part.as_ref(), at) < -slight).collect();
            return Vec::new();
        }
        let mut said = Vec::new();
        for (part, below) in model.parts().iter().zip(&mut self.below) {
            let z = if *below { top(part.as_ref(), at) } else { 0.0 };
            if z > slight {
                *below = false;
                said.push(format!(
                    "`{}` rises above z = 0, where it is {z:.3} m high at t = {:.4} s, but this water has no surface: it is \
                     everywhere. Give it one, such as `level = 0` in [water], or a level far above if there is none near",
                    part.name(),
                    at.t,
                ));
            }
        }
        said
    }
}

/// Height of the highest point of a part.
fn top(part: &dyn Part, at: &At<'_>) -> f64 {
    let line = part.centre_line(at).into_iter().chain(part.point(0.0, at).map(|(x, _)| x));
    line.map(|x| x[2]).fold(f64::NEG_INFINITY, f64::max)
}
