//! Other shapes of a cable from which a search for equilibrium may start.

use super::part::CablePart;
use super::twisted;
use ropewalk_core::model::twist::tangent;
use ropewalk_core::{V3, dot};

/// A cable that is longer than the way between its ends by less than this part of it hardly sags.
const TAUT: f64 = 1e-4;
/// Halvings by which the sag and the places along it are found: guesses need no more.
const HALVINGS: u32 = 50;

/// Lays the nodes evenly along the straight line between the ends.
pub(super) fn straighten(cable: &CablePart, q: &mut [f64]) {
    let (from, way) = ends(cable, q);
    let length = cable.along[cable.along.len() - 1];
    lay(cable, q, |s| (std::array::from_fn(|i| from[i] + way[i] * s / length), way.map(|x| x / length)));
}

/// Lays the nodes along a parabola that is as long as the cable is now, unstretched; `false` if it doesn't sag.
pub(super) fn hang(cable: &CablePart, q: &mut [f64], pull: &V3<f64>) -> bool {
    let (from, way) = ends(cable, q);
    let material = cable.material(q).into_owned();
    let (first, length) = (material[0], material[material.len() - 1] - material[0]);
    let chord = size(&way);
    let across = across(&way, pull);
    if !(length > (1.0 + TAUT) * chord) {
        return false;
    }
    // as long as the cable: with the sag f, |dr/du| = (c² + (4 f (1 - 2 u))²)^½
    let sag = halved(2.0 * length, |f| arc(chord, f, 1.0) < length);
    let laid = cable.along[cable.along.len() - 1];
    lay(cable, q, |s| {
        // the share of material up to a node that was laid at s
        let k = cable.along.partition_point(|&x| x < s).min(material.len() - 1);
        let out = (material[k] - first).min(length);
        let u = halved(1.0, |u| arc(chord, sag, u) < out);
        let (x, rate): (V3<f64>, V3<f64>) = (
            std::array::from_fn(|i| from[i] + u * way[i] + 4.0 * sag * u * (1.0 - u) * across[i]),
            std::array::from_fn(|i| way[i] + 4.0 * sag * (1.0 - 2.0 * u) * across[i]),
        );
        let stretch = length / laid / size(&rate);
        (x, rate.map(|x| x * stretch))
    });
    true
}

/// Turns back what is folded, see [`Line::unfold`](ropewalk_core::Line::unfold).
pub(super) fn unfold(cable: &CablePart, q: &mut [f64], ends: bool) -> bool {
    let tangents = tangents(cable, q);
    let last = cable.seats.len() - 1;
    let place = |q: &[f64], k: usize| -> V3<f64> { std::array::from_fn(|i| q[cable.seats[k].0 + i]) };
    let chord = |q: &[f64], k: usize| -> V3<f64> {
        let (a, b) = (place(q, k), place(q, k + 1));
        std::array::from_fn(|i| b[i] - a[i])
    };
    // between the two nodes of a splice there is nothing
    let is_element = |k: usize| k < last && !cable.layout.splices().iter().any(|s| s.node == k);
    let mut folded = false;
    for k in (1..last.saturating_sub(1)).filter(|&k| (k - 1..=k + 1).all(is_element)) {
        let along = chord(q, k);
        if dot(&tangents[k], &along) < 0.0 && dot(&tangents[k + 1], &along) < 0.0 {
            let (from, to) = (place(q, k - 1), place(q, k + 2));
            for (node, x) in [(k, 1.0 / 3.0), (k + 1, 2.0 / 3.0)] {
                (0..3).for_each(|i| q[cable.seats[node].0 + i] = from[i] + x * (to[i] - from[i]));
            }
            folded = true;
        }
    }
    for k in (0..=last).filter(|&k| ends || (k > 0 && k < last)) {
        let beside = [k.checked_sub(1), Some(k)].into_iter().flatten().filter(|&k| is_element(k));
        let chords: Vec<V3<f64>> = beside.map(|k| chord(q, k)).collect();
        if chords.iter().all(|chord| dot(&tangents[k], chord) < 0.0) {
            let at = cable.seats[k].0 + 3;
            let along: V3<f64> = std::array::from_fn(|i| chords.iter().map(|c| c[i]).sum());
            let scale = size(&[q[at], q[at + 1], q[at + 2]]) / size(&along);
            (0..3).for_each(|i| q[at + i] = scale * along[i]);
            folded = true;
        }
    }
    if folded {
        turn_sections(cable, q, &tangents);
    }
    folded
}

/// The start, and the way from there to the end.
fn ends(cable: &CablePart, q: &[f64]) -> (V3<f64>, V3<f64>) {
    let (first, last) = (cable.seats[0].0, cable.seats[cable.seats.len() - 1].0);
    let length = cable.along[cable.along.len() - 1];
    let from: V3<f64> = std::array::from_fn(|i| q[first + i]);
    let way: V3<f64> = std::array::from_fn(|i| q[last + i] - from[i]);
    // ends that coincide give no direction; any will do
    let apart = way.iter().any(|x| x.abs() >= 1e-3 * length);
    (from, if apart { way } else { [1e-3 * length, 0.0, 0.0] })
}

/// Lays each node at the place and with the slope of its arc length.
fn lay(cable: &CablePart, q: &mut [f64], at: impl Fn(f64) -> (V3<f64>, V3<f64>)) {
    let before = tangents(cable, q);
    for (&(seat, _), &s) in cable.seats.iter().zip(&cable.along) {
        let (x, slope) = at(s);
        for i in 0..3 {
            (q[seat + i], q[seat + 3 + i]) = (x[i], slope[i]);
        }
    }
    turn_sections(cable, q, &before);
}

fn turn_sections(cable: &CablePart, q: &mut [f64], before: &[V3<f64>]) {
    if cable.twisted.is_some() {
        let seats: Vec<usize> = cable.seats.iter().map(|s| s.0).collect();
        twisted::follow(q, &seats, before);
    }
}

fn tangents(cable: &CablePart, q: &[f64]) -> Vec<V3<f64>> {
    cable.seats.iter().map(|s| tangent(&q[s.0..])).collect()
}

/// A unit vector across the way, towards where loads pull if they don't pull along it.
fn across(way: &V3<f64>, pull: &V3<f64>) -> V3<f64> {
    let along = |x: &V3<f64>| -> V3<f64> {
        let share = dot(x, way) / dot(way, way);
        std::array::from_fn(|i| x[i] - share * way[i])
    };
    let d = along(pull);
    let d = if size(&d) > 1e-3 * size(pull) {
        d
    } else {
        let least = (0..3).min_by(|&i, &j| way[i].abs().total_cmp(&way[j].abs())).unwrap_or(0);
        along(&std::array::from_fn(|i| f64::from(u8::from(i == least))))
    };
    let unit = size(&d);
    d.map(|x| x / unit)
}

/// Length of the parabola with this chord and sag up to the part `u` of its chord.
fn arc(chord: f64, sag: f64, u: f64) -> f64 {
    let steep = 4.0 * sag / chord;
    if steep < 1e-6 {
        return chord * u;
    }
    let primitive = |w: f64| (w * (steep * w).hypot(1.0) + (steep * w).asinh() / steep) / 2.0;
    0.5 * chord * (primitive(2.0 * u - 1.0) - primitive(-1.0))
}

/// The largest number up to `most` of which `below` holds, that holds of all smaller ones.
fn halved(most: f64, below: impl Fn(f64) -> bool) -> f64 {
    let (mut low, mut high) = (0.0, most);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if below(middle) { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

fn size(x: &V3<f64>) -> f64 {
    dot(x, x).sqrt()
}
