//! What is doubtful about a scene although it can be computed.

use crate::{RaoSpec, Scene};
use ropewalk_core::{At, Model, Part};
use ropewalk_sea::Waves;
use std::f64::consts::TAU;

/// What counts as being in the bed, as a share of the depth: lines are laid on it.
const IN_THE_BED: f64 = 0.01;
/// By what share of the depth a bed may lie elsewhere.
const OFF: f64 = 0.1;
/// A share of the waves' energy that responses may leave out.
const LEFT_OUT: f64 = 0.1;

impl Scene {
    /// What one should know of waves, vessels and the depth of the water before trusting what the scene gives in this state.
    pub fn doubts(&self, model: &Model, at: &At<'_>) -> Vec<String> {
        let Some(water) = &self.water else { return Vec::new() };
        let mut all: Vec<String> = water.steep(self.gravity).into_iter().collect();
        let (Some(waves), Some(level)) = (water.swell(self.gravity), water.level) else { return all };
        let vessels = self.constraints.iter().filter_map(|c| Some((c.name(), c.responses()?)));
        let floats = self.forces.iter().filter_map(|f| f.responses());
        all.extend(vessels.chain(floats).filter_map(|(name, rao)| beyond(name, rao, &waves)));
        all.extend(
            self.forces.iter().filter_map(|f| f.bed()).filter_map(|bed| elsewhere(bed, level, waves.depth())),
        );
        all.extend(water.repeats(self.run.duration));
        all.extend(model.parts().iter().filter_map(|part| below(part.as_ref(), at, level, waves.depth())));
        all
    }
}

/// That much of the waves' energy lies where a table of responses only has its ends.
fn beyond(name: &str, rao: &RaoSpec, waves: &Waves) -> Option<String> {
    let [low, high] = [*rao.omegas.first()?, *rao.omegas.last()?];
    let energy = |inside: &dyn Fn(f64) -> bool| -> f64 {
        waves.iter().filter(|(.., omega, _)| inside(*omega)).map(|(a, ..)| a * a).sum()
    };
    let near = 1e-6;
    let share = 1.0
        - energy(&|omega| omega >= low * (1.0 - near) && omega <= high * (1.0 + near)) / energy(&|_| true);
    (share > LEFT_OUT).then(|| {
        format!(
            "`{name}` has responses to waves of {:.2} to {:.2} s, and {:.0} % of the energy of these waves lies outside: there it \
             answers as at the ends of its table. Give it more `omegas`",
            TAU / high,
            TAU / low,
            100.0 * share
        )
    })
}

/// That the bed lies elsewhere than waves feel it.
fn elsewhere((name, height): (&str, f64), level: f64, depth: f64) -> Option<String> {
    let down = level - height;
    (depth.is_finite() && (down - depth).abs() > OFF * depth).then(|| {
        format!(
            "`{name}` lies {down} m under the surface, and waves are those of water {depth} m deep: let [water.waves] have the \
             `depth` of the bed"
        )
    })
}

/// That a part which the water acts on is below the bed.
fn below(part: &dyn Part, at: &At<'_>, level: f64, depth: f64) -> Option<String> {
    let mut lowest = f64::INFINITY;
    if let Some(stations) = part.stations() {
        stations.each(at, &mut |station| lowest = lowest.min(station.x[2]));
    }
    let down = level - lowest;
    (down.is_finite() && down > (1.0 + IN_THE_BED) * depth).then(|| {
        format!(
            "`{}` reaches down to {down:.3} m under the surface, and the water is {depth} m deep: what waves do there is \
             meaningless. Give [water.waves] the right `depth`",
            part.name()
        )
    })
}
