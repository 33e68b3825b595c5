//! Cables whose ends begin to move with a jump.
//!
//! A motion that starts at full speed, such as a sine, strikes what it moves: a shock of `√(EA μ) v` runs along a cable with
//! the speed of sound and is reflected at its other end. No mesh resolves its front, and no step is short enough for it, so that
//! tensions are not as exact behind it as asked for.

use crate::model::Model;
use crate::model::line::Quantity;
use crate::model::part::Part;
use crate::model::state::{At, State};
use crate::simulation::layers::short;
use crate::{V3, dot};
use std::sync::Arc;

/// Shocks below this part of the largest tension are nothing to speak of, and those that strain the cable by less than that.
const SHARE: f64 = 0.1;
const STRAIN: f64 = 1e-6;
/// So many nodes from the end the rest begins: velocities that were made to meet the constraints carry a little of it on.
const NEAR: usize = 4;
/// The rest of a cable moves alike if its velocities differ by this part of the jump.
const ALIKE: f64 = 0.05;

/// What is struck at the start of a run, and how hard.
pub fn remarks(model: &Model, state: &State) -> Vec<String> {
    let at = state.at();
    let slopes = |q: usize| model.nodes().iter().any(|n| n.q == q && n.kind.has_slope());
    let bends = |part: &&Arc<dyn Part>| part.seats().first().is_some_and(|(q, _)| slopes(*q));
    model.parts().iter().filter(bends).filter_map(|part| remark(part.as_ref(), &at)).collect()
}

fn remark(part: &dyn Part, at: &At<'_>) -> Option<String> {
    let line = part.line()?;
    let mesh = line.mesh_now(at);
    let last = mesh.len().checked_sub(1).filter(|last| *last >= NEAR)?;
    // of the material: the nodes of what feeds move against it
    let points: Vec<(V3<f64>, V3<f64>)> = mesh.iter().map(|s| part.point(*s, at)).collect::<Option<_>>()?;
    let along = |k: usize, i: usize| -> f64 {
        let (from, to) = (points[k.saturating_sub(1)].0, points[(k + 1).min(last)].0);
        let chord: V3<f64> = std::array::from_fn(|c| to[c] - from[c]);
        let v: V3<f64> = std::array::from_fn(|c| points[k].1[c] - points[i].1[c]);
        dot(&chord, &v) / dot(&chord, &chord).sqrt()
    };
    let tension = mesh.iter().filter_map(|s| line.observe(Quantity::Tension, *s, at));
    let largest = tension.fold(0.0_f64, f64::max);
    let of = line.slender();
    let middle = last / 2;
    let ends = [(0, NEAR.min(middle), "start"), (last, (last - NEAR).max(middle), "end")];
    let struck = |(end, near, word): (usize, usize, &'static str)| {
        let (jump, rest) = (along(end, middle).abs(), along(near, middle).abs());
        let shock = (of.ea * of.mass).sqrt() * jump;
        let counts = shock > SHARE * largest && shock > STRAIN * of.ea;
        (rest <= ALIKE * jump && counts).then_some((word, jump, shock))
    };
    let (word, jump, shock) = ends.into_iter().find_map(struck)?;
    Some(format!(
        "`{}` is struck at its {word}: that begins to move at {} m/s along it, and the rest doesn't yet. A shock of √(EA μ) v = {} N \
         runs along it, behind which tensions are less exact than `force_tolerance` asks. A motion that begins gently has none: \
         give it a `ramp`, or let it begin at rest",
        part.name(),
        short(jump),
        short(shock)
    ))
}
