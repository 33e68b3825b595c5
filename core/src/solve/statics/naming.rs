//! What a direction is called: who moves, and how.

use crate::algebra::lane::V3;
use crate::algebra::rotation::cross;
use crate::model::Model;
use crate::model::marker::frame;
use crate::model::node::{Node, NodeId, NodeKind};
use crate::model::part::Part;
use crate::model::twist::tangent;
use nalgebra::{DMatrix, DVector};

/// Part of a direction that the rigid motion that fits it best may miss.
const RIGID: f64 = 1e-2;

/// The nodes that a direction moves.
fn moved<'a>(model: &'a Model, shape: &[f64]) -> Vec<(usize, &'a Node)> {
    let length = model.length();
    let nodes: Vec<_> = model.nodes().iter().enumerate().collect();
    let largest = nodes.iter().map(|(_, n)| size_of(n, shape, length)).fold(0.0, f64::max);
    let moves =
        |n: &Node| !matches!(n.kind, NodeKind::Scalars(_)) && size_of(n, shape, length) > 1e-3 * largest;
    nodes.into_iter().filter(|(_, n)| moves(n)).collect()
}

/// The line without bending stiffness whose shape changes in a direction, if nothing else moves.
pub(super) fn reshaped(model: &Model, q: &[f64], shape: &[f64]) -> Option<String> {
    let moving = moved(model, shape);
    // what only scalars do, such as the angle of a wheel, changes no shape
    let first = moving.first()?.1.q;
    let origin: V3<f64> = std::array::from_fn(|i| q[first + i]);
    let (.., left) = rigid_motion(q, shape, &moving, origin, model.length())?;
    let on = |part: &dyn Part| moving.iter().all(|(k, _)| part.place_of(NodeId(*k as u32)).is_some());
    let limp = |part: &dyn Part| part.slender().is_some_and(|line| line.ei == 0.0);
    let line = model.parts().iter().find(|part| limp(part.as_ref()) && on(part.as_ref()))?;
    (left > RIGID).then(|| line.name().to_string())
}

/// What moves in a direction, and how.
pub(super) fn describe(model: &Model, q: &[f64], shape: &[f64]) -> String {
    let (length, moving) = (model.length(), moved(model, shape));
    let who = names(model, &moving);
    if moving.is_empty() {
        return format!("{who} moves");
    }
    if moving.iter().all(|(_, n)| spins(n, shape, length)) {
        return format!("{who} turns about its own axis");
    }
    let origin: V3<f64> = std::array::from_fn(|i| q[moving[0].1.q + i]);
    let Some((u, omega, left)) = rigid_motion(q, shape, &moving, origin, length) else {
        return format!("{who} moves");
    };
    if !(left < RIGID) {
        // what turns most needn't move
        let way = |n: &Node| -> V3<f64> { std::array::from_fn(|i| shape[n.v + i]) };
        let farthest = moving.iter().max_by(|a, b| norm(&way(a.1)).total_cmp(&norm(&way(b.1))));
        let Some((k, n)) = farthest else { return format!("{who} moves") };
        let d = way(n);
        let part = model.parts().iter().find_map(|p| {
            p.place_of(NodeId(*k as u32))
                .map(|place| format!("`{}` {place}", p.name()).trim_end().to_string())
        });
        let at = part.unwrap_or_else(|| format!("node {k}"));
        return format!("{who} changes its shape, most of all {at} along {}", spoken(&d));
    }
    if norm(&omega) * length < 1e-3 * norm(&u) {
        return format!("{who} moves along {}", spoken(&u));
    }
    let square = norm(&omega).powi(2);
    let arm = cross(&omega, &u);
    let through: V3<f64> = std::array::from_fn(|i| rounded_to(origin[i] + arm[i] / square, 1e-3 * length));
    format!(
        "{who} turns about the axis {} through ({}, {}, {}) m",
        spoken(&omega),
        through[0],
        through[1],
        through[2]
    )
}

/// How far a node moves, in parts of the reference length.
fn size_of(n: &Node, shape: &[f64], length: f64) -> f64 {
    let d = &shape[n.dofs()];
    let size = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
    match n.kind {
        NodeKind::Scalars(_) => size(d) / length,
        _ => f64::max(size(&d[..3]) / length, size(&d[3..])),
    }
}

/// Whether a node of a cable does little else than turn about its tangent.
fn spins(n: &Node, shape: &[f64], length: f64) -> bool {
    let d = &shape[n.dofs()];
    let most = |x: &[f64]| x.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    n.kind == NodeKind::Twist
        && most(&d[..3]) / length <= RIGID * d[6].abs()
        && most(&d[3..6]) <= RIGID * d[6].abs()
}

/// The parts that these nodes belong to.
fn names(model: &Model, moving: &[(usize, &Node)]) -> String {
    let mut names: Vec<String> = Vec::new();
    for (k, _) in moving {
        let part = model.parts().iter().find(|p| p.place_of(NodeId(*k as u32)).is_some());
        if let Some(name) = part.map(|p| format!("`{}`", p.name())).filter(|n| !names.contains(n)) {
            names.push(name);
        }
    }
    match names.as_slice() {
        [] => "the model".to_string(),
        [one] => one.clone(),
        [first, .., last] if names.len() > 3 => format!("{first} to {last}"),
        more => more.join(", "),
    }
}

/// The rigid motion `u + ω × (x - x₀)` that fits a direction best, and the part of the direction that it misses.
fn rigid_motion(
    q: &[f64],
    shape: &[f64],
    moving: &[(usize, &Node)],
    origin: V3<f64>,
    length: f64,
) -> Option<(V3<f64>, V3<f64>, f64)> {
    let unit = |j: usize| -> V3<f64> { std::array::from_fn(|i| if i == j { 1.0 } else { 0.0 }) };
    // translations in parts of the reference length
    let mut rows: Vec<([f64; 6], f64)> = Vec::new();
    for (_, n) in moving {
        let arm: V3<f64> = std::array::from_fn(|i| (q[n.q + i] - origin[i]) / length);
        let d = &shape[n.dofs()];
        for i in 0..3 {
            let mut row = [0.0; 6];
            row[i] = 1.0;
            for j in 0..3 {
                row[3 + j] = cross(&unit(j), &arm)[i];
            }
            rows.push((row, d[i] / length));
        }
        let turned: Option<[V3<f64>; 3]> = match n.kind {
            NodeKind::Slope | NodeKind::Twist => {
                let slope: V3<f64> = std::array::from_fn(|i| q[n.q + 3 + i]);
                Some(std::array::from_fn(|j| cross(&unit(j), &slope)))
            }
            NodeKind::Frame => {
                let r = frame(&q[n.coords()]);
                Some(std::array::from_fn(|j| std::array::from_fn(|i| r[j][i])))
            }
            _ => None,
        };
        if let Some(columns) = turned {
            for i in 0..3 {
                let mut row = [0.0; 6];
                for j in 0..3 {
                    row[3 + j] = columns[j][i];
                }
                rows.push((row, d[3 + i]));
            }
        }
        if n.kind == NodeKind::Twist {
            let t = tangent(&q[n.coords()]);
            rows.push(([0.0, 0.0, 0.0, t[0], t[1], t[2]], d[6]));
        }
    }
    let a = DMatrix::from_fn(rows.len(), 6, |i, j| rows[i].0[j]);
    let b = DVector::from_fn(rows.len(), |i, _| rows[i].1);
    let fit = a.clone().svd(true, true).solve(&b, 1e-9).ok()?;
    let left = (&a * &fit - &b).norm() / b.norm();
    Some((std::array::from_fn(|i| length * fit[i]), std::array::from_fn(|i| fit[3 + i]), left))
}

fn norm(x: &V3<f64>) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// A direction in words; its sign means nothing, so that the largest part is positive.
fn spoken(x: &V3<f64>) -> String {
    let size = norm(x);
    let k = (0..3).max_by(|&a, &b| x[a].abs().total_cmp(&x[b].abs())).unwrap_or(0);
    let unit = x.map(|c| rounded(c / size * x[k].signum()));
    format!("({}, {}, {})", unit[0], unit[1], unit[2])
}

fn rounded(x: f64) -> f64 {
    rounded_to(x, 1e-3)
}

/// `0.0 +` leaves no minus before a zero.
fn rounded_to(x: f64, unit: f64) -> f64 {
    let unit = 10f64.powf(unit.log10().floor());
    let digits = (x / unit).round() * unit;
    0.0 + format!("{digits:.6}").parse::<f64>().unwrap_or(digits)
}
