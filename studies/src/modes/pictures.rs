//! A picture of each mode: the equilibrium and the shape, drawn large.

use super::{Modal, report};
use ropewalk_core::modes::Mode;
use ropewalk_core::{At, V3};
use ropewalk_report::{Plane, RunFolder, ShapePlot};
use std::f64::consts::FRAC_PI_2;

/// How large the motion is drawn, in parts of the size of the scene.
const SIZE: f64 = 0.12;
/// So many points of each part are marked, to show motion along the line.
const MARKS: usize = 17;

/// Draws all modes and says how many pictures there are. One that can't be drawn is no reason to fail.
pub(super) fn draw(folder: &RunFolder, modal: &Modal, warn: &mut dyn FnMut(&str)) -> usize {
    let rest = points(modal, &modal.state.q);
    let extent = extents(&rest);
    let drawn = modal.modes.iter().zip(1..).filter(|(mode, number)| {
        let plot = picture(modal, *number, mode, &rest, extent);
        folder.draw(&format!("mode-{number:02}"), |path| plot.write(path), warn)
    });
    drawn.count()
}

fn picture(modal: &Modal, number: usize, mode: &Mode, rest: &[V3<f64>], extent: V3<f64>) -> ShapePlot {
    let scale = scale(modal, mode, extent);
    let standing = mode.quadrature.iter().all(|x| x.abs() < 0.02 * largest_of(&mode.shape));
    let phases: &[(f64, &str)] = match standing {
        true => &[(0.0, "phase 0°"), (2.0, "phase 180°")],
        false => &[(0.0, "0°"), (1.0, "90°"), (2.0, "180°"), (3.0, "270°")],
    };
    let mut shapes = vec![(0.0, rest.to_vec())];
    let mut names = vec!["equilibrium".to_string()];
    let mut q = modal.state.q.clone();
    for (turn, name) in phases {
        swing(modal, mode, scale, turn * FRAC_PI_2, &mut q);
        shapes.push((1.0 + turn, points(modal, &q)));
        names.push((*name).to_string());
    }
    let plot = ShapePlot::of_positions(title(number, mode), plane(mode, extent), &shapes);
    ShapePlot { names, ..plot }
}

/// What a mode is called.
pub(super) fn title(number: usize, mode: &Mode) -> String {
    let what = match report::kind(mode) {
        "" => format!("{:.4} Hz", mode.frequency()),
        kind => kind.to_string(),
    };
    let damping = match mode.damping_ratio() {
        z if z.abs() > 5e-5 && mode.omega > 0.0 => format!(", damping ratio {z:.4}"),
        _ => String::new(),
    };
    format!("Mode {number}: {what}{damping}")
}

/// How many times as large as a mode of size 1 its motion is drawn.
fn scale(modal: &Modal, mode: &Mode, extent: V3<f64>) -> f64 {
    let largest = extent.iter().fold(0.0_f64, |a, b| a.max(*b));
    SIZE * if largest > 0.0 { largest } else { modal.model.length() } / amplitude(modal, mode)
}

/// The same for all modes.
pub(super) fn scales(modal: &Modal) -> Vec<f64> {
    let extent = extents(&points(modal, &modal.state.q));
    modal.modes.iter().map(|mode| scale(modal, mode, extent)).collect()
}

/// Coordinates at a phase of a mode [rad].
pub(super) fn swing(modal: &Modal, mode: &Mode, scale: f64, phase: f64, q: &mut [f64]) {
    let (sin, cos) = phase.sin_cos();
    let both = mode.shape.iter().zip(&mode.quadrature);
    let d: Vec<f64> = both.map(|(a, b)| scale * (cos * a - sin * b)).collect();
    modal.model.retract(&modal.state.q, &d, q);
}

/// Points of all parts, with marks along them; breaks are points that aren't finite.
fn points(modal: &Modal, q: &[f64]) -> Vec<V3<f64>> {
    const BREAK: V3<f64> = [f64::NAN; 3];
    let at = At { q, ..modal.state.at() };
    let mut all = Vec::new();
    for part in modal.model.parts() {
        all.extend(part.centre_line(&at));
        all.push(BREAK);
        let mesh = part.mesh();
        let stride = mesh.len().div_ceil(MARKS).max(1);
        for s in mesh.iter().step_by(stride) {
            if let Some((x, _)) = part.point(*s, &at) {
                all.extend([x, BREAK]);
            }
        }
    }
    all
}

fn extents(points: &[V3<f64>]) -> V3<f64> {
    std::array::from_fn(|i| {
        let finite = points.iter().map(|p| p[i]).filter(|x| x.is_finite());
        let (low, high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
        (high - low).max(0.0)
    })
}

fn largest_of(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |m: f64, x| m.max(x.abs()))
}

/// How far the points of the model go in a mode of size 1 [m]; of bodies that only turn, what their size makes of it.
fn amplitude(modal: &Modal, mode: &Mode) -> f64 {
    let size = |n: &ropewalk_core::Node, first: usize, count: usize| {
        let own = n.v + first..n.v + (first + count).min(n.kind.velocities());
        own.map(|i| mode.shape[i].powi(2) + mode.quadrature[i].powi(2)).sum::<f64>().sqrt()
    };
    let turns = |n: &ropewalk_core::Node| match n.kind {
        ropewalk_core::NodeKind::Frame => 0.25 * modal.model.length() * size(n, 3, 3),
        // a cable that only twists
        ropewalk_core::NodeKind::Twist => 0.25 * modal.model.length() * size(n, 6, 1),
        _ => 0.0,
    };
    let farthest = modal.model.nodes().iter().map(|n| size(n, 0, 3).max(turns(n))).fold(0.0, f64::max);
    farthest.max(f64::MIN_POSITIVE)
}

/// The plane that shows most: the direction of motion, and the longest of the others.
fn plane(mode: &Mode, extent: V3<f64>) -> Plane {
    let d = mode.directions;
    let moves = (0..3).max_by(|&a, &b| d[a].total_cmp(&d[b])).unwrap_or(2);
    let beside = (0..3).filter(|&i| i != moves).max_by(|&a, &b| extent[a].total_cmp(&extent[b])).unwrap_or(0);
    match (moves.min(beside), moves.max(beside)) {
        (0, 1) => Plane::Top,
        (0, 2) => Plane::SideX,
        _ => Plane::SideY,
    }
}
