//! The path along which a cable or a chain is laid: straight lines, a smooth curve through points, turns on a spool.

use ropewalk_core::rotation::cross;
use ropewalk_core::{EndSlope, Interpolation, Join, V3, dot};
use std::f64::consts::TAU;

/// A path in space by arc length.
#[derive(Clone, Debug)]
pub struct Path {
    /// Arc length, position and tangent of densely spaced points; corners appear twice, once for each side.
    samples: Vec<(f64, V3<f64>, V3<f64>)>,
    /// Corners that are sharp.
    corners: Vec<Corner>,
    /// Arc lengths at which arcs begin and end, and where in between nodes of a mesh have to be.
    bends: Vec<f64>,
}

/// Where straight lines meet at an angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corner {
    /// Arc length [m].
    pub s: f64,
    /// The point.
    pub at: V3<f64>,
    /// By how much the direction turns [rad].
    pub angle: f64,
}

/// An element that turns by no more than this [rad] is strained by less than 1e-5: with slopes of unit length a cubic is too
/// short by `5.2e-4` times the fourth power of the angle.
const TURN: f64 = 1.0 / 3.0;
/// Directions that differ by less are the same [rad].
const STRAIGHT: f64 = 1e-9;

impl Path {
    /// Straight lines from point to point.
    ///
    /// # Errors
    /// Fewer than two points, two equal neighbours, or a number that isn't finite.
    pub fn polyline(points: &[V3<f64>]) -> Result<Self, String> {
        check(points)?;
        let (mut samples, mut corners, mut s) = (Vec::new(), Vec::new(), 0.0);
        let mut before: Option<V3<f64>> = None;
        for w in points.windows(2) {
            let (length, t) = direction(w[0], w[1]);
            if let Some(before) = before {
                corners.push(Corner { s, at: w[0], angle: angle(&before, &t) });
            }
            before = Some(t);
            samples.push((s, w[0], t));
            s += length;
            samples.push((s, w[1], t));
        }
        Ok(Path { samples, corners, bends: Vec::new() })
    }

    /// Straight lines from point to point, with arcs of this radius [m] for corners.
    ///
    /// # Errors
    /// As [`Path::polyline`]; an arc that is longer than the lines beside it leave room for, or a path that turns back.
    pub fn rounded(points: &[V3<f64>], radius: f64) -> Result<Self, String> {
        check(points)?;
        let sides: Vec<(f64, V3<f64>)> = points.windows(2).map(|w| direction(w[0], w[1])).collect();
        let turn = |k: usize| angle(&sides[k - 1].1, &sides[k].1);
        // how much of the lines beside a point its arc takes
        let takes: Vec<f64> = (0..points.len())
            .map(|k| if k == 0 || k == sides.len() { 0.0 } else { radius * (0.5 * turn(k)).tan() })
            .collect();
        for (k, (length, _)) in sides.iter().enumerate() {
            if !(takes[k] + takes[k + 1] <= length * (1.0 + 1e-12)) {
                return Err(format!(
                    "corners of radius {radius} m take {} m of the line from point {} to point {}, which is {length} m \
                     long: take a smaller `radius`",
                    takes[k] + takes[k + 1],
                    k + 1,
                    k + 2
                ));
            }
        }
        let (mut samples, mut bends, mut s) = (Vec::new(), Vec::new(), 0.0);
        for (k, (length, t)) in sides.iter().enumerate() {
            let along = |x: f64| std::array::from_fn(|i| points[k][i] + x * t[i]);
            let straight = (length - takes[k] - takes[k + 1]).max(0.0);
            samples.push((s, along(takes[k]), *t));
            s += straight;
            samples.push((s, along(takes[k] + straight), *t));
            let Some((_, next)) = sides.get(k + 1) else { continue };
            let angle = turn(k + 1);
            if angle <= STRAIGHT {
                continue;
            }
            // towards the centre of the arc
            let inward = unit(std::array::from_fn(|i| next[i] - angle.cos() * t[i]));
            let from = along(length - takes[k + 1]);
            let elements = (angle / TURN).ceil();
            bends.extend((0..=elements as usize).map(|i| s + radius * angle * i as f64 / elements));
            const FINE: usize = 16;
            let steps = FINE * elements as usize;
            for i in 1..=steps {
                let a = angle * i as f64 / steps as f64;
                let (sin, cos) = a.sin_cos();
                let half = (0.5 * a).sin();
                let point =
                    std::array::from_fn(|c| from[c] + radius * (sin * t[c] + 2.0 * half * half * inward[c]));
                let tangent = std::array::from_fn(|c| cos * t[c] + sin * inward[c]);
                samples.push((s + radius * a, point, tangent));
            }
            s += radius * angle;
        }
        Ok(Path { samples, corners: Vec::new(), bends })
    }

    /// A smooth curve through points, a cubic spline over the length of the chords. It begins and ends in these
    /// directions, of any length; where none is given it is as curved there as the points next to the end are.
    ///
    /// # Errors
    /// As [`Path::polyline`]; a direction without length.
    pub fn spline(points: &[V3<f64>], directions: [Option<V3<f64>>; 2]) -> Result<Self, String> {
        check(points)?;
        let n = points.len();
        let mut u = vec![0.0];
        for w in points.windows(2) {
            u.push(u[u.len() - 1] + direction(w[0], w[1]).0);
        }
        let mut ends = [[EndSlope::Smooth; 2]; 3];
        for (end, direction) in directions.iter().enumerate() {
            let Some(d) = direction else { continue };
            let size = norm(*d);
            if !(size > 0.0 && size.is_finite()) {
                return Err(format!("the direction {d:?} has no length"));
            }
            for (c, ends) in ends.iter_mut().enumerate() {
                ends[end] = EndSlope::Given(d[c] / size);
            }
        }
        let along: [Interpolation; 3] = std::array::from_fn(|c| {
            let x: Vec<f64> = points.iter().map(|p| p[c]).collect();
            Interpolation::new(&u, &x, Join::Cubic, ends[c])
        });
        let at = |x: f64| -> (V3<f64>, V3<f64>) {
            let all = [0, 1, 2].map(|c| along[c].at(x));
            (all.map(|a| a[1]), all.map(|a| a[2]))
        };
        // Gauss quadrature of the arc length, fine enough that linear interpolation of s is far below the mesh
        const STEPS: usize = 64;
        let gauss =
            [(0.5 - 0.15f64.sqrt(), 5.0 / 18.0), (0.5, 8.0 / 18.0), (0.5 + 0.15f64.sqrt(), 5.0 / 18.0)];
        let (mut samples, mut s) = (Vec::new(), 0.0);
        for k in 0..n - 1 {
            let h = (u[k + 1] - u[k]) / STEPS as f64;
            for i in 0..STEPS {
                let x = u[k] + h * i as f64;
                let (p, d) = at(x);
                let speed = norm(d);
                if speed < 1e-9 {
                    return Err("the curve turns back on itself between its points: give more points".into());
                }
                samples.push((s, p, d.map(|x| x / speed)));
                s += gauss.iter().map(|(g, w)| w * h * norm(at(x + g * h).1)).sum::<f64>();
            }
        }
        let (p, d) = at(u[n - 1]);
        let speed = norm(d);
        samples.push((s, p, d.map(|x| x / speed)));
        Ok(Path { samples, corners: Vec::new(), bends: Vec::new() })
    }

    /// Goes on from its end with turns on a spool: a helix about the axis through `centre`, right-handed, that advances
    /// by `pitch` [m] along the axis with each turn. The radius is the distance of the path's end from the axis.
    ///
    /// # Errors
    /// An axis without length or through the end of the path; numbers that aren't finite, or no turns.
    pub fn wind(mut self, centre: V3<f64>, axis: V3<f64>, pitch: f64, turns: f64) -> Result<Self, String> {
        let size = norm(axis);
        if !(size > 0.0 && size.is_finite() && centre.iter().all(|x| x.is_finite())) {
            return Err("the axis of a spool must have a direction".into());
        }
        if !(turns > 0.0 && turns <= 1e4 && pitch.is_finite()) {
            return Err(format!("a spool needs more than 0 and at most 10000 turns, not {turns}"));
        }
        let axis = axis.map(|x| x / size);
        let (s0, from, _) = self.samples[self.samples.len() - 1];
        let arm = sub(from, centre);
        let ahead: f64 = (0..3).map(|i| arm[i] * axis[i]).sum();
        let out: V3<f64> = std::array::from_fn(|i| arm[i] - ahead * axis[i]);
        let radius = norm(out);
        if !(radius > 1e-9 * (1.0 + norm(arm))) {
            return Err("the path must reach the spool beside its axis: the distance is its radius".into());
        }
        let side = cross(&axis, &out);
        let slope = (radius * radius + (pitch / TAU).powi(2)).sqrt();
        // cubics between 128 points a turn are within 2e-8 of the radius
        let steps = (128.0 * turns).ceil();
        let before = self.samples[self.samples.len() - 1].2;
        let start = std::array::from_fn(|i| (side[i] + pitch / TAU * axis[i]) / slope);
        self.corners.push(Corner { s: s0, at: from, angle: angle(&before, &start) });
        for k in 0..=steps as usize {
            let angle = TAU * turns * k as f64 / steps;
            let (sin, cos) = angle.sin_cos();
            let point = std::array::from_fn(|i| {
                centre[i] + cos * out[i] + sin * side[i] + (ahead + pitch * angle / TAU) * axis[i]
            });
            let tangent =
                std::array::from_fn(|i| (cos * side[i] - sin * out[i] + pitch / TAU * axis[i]) / slope);
            self.samples.push((s0 + slope * angle, point, tangent));
        }
        Ok(self)
    }

    /// Its length [m].
    pub fn length(&self) -> f64 {
        self.samples[self.samples.len() - 1].0
    }

    /// Its sharp corners.
    pub fn corners(&self) -> &[Corner] {
        &self.corners
    }

    /// Arc lengths at which a mesh needs nodes: at corners, and along arcs often enough that no element turns far.
    pub fn stops(&self) -> impl Iterator<Item = f64> {
        self.corners.iter().map(|c| c.s).chain(self.bends.iter().copied())
    }

    /// Position and unit tangent at an arc length; at a corner the mean of both sides.
    pub fn at(&self, s: f64) -> (V3<f64>, V3<f64>) {
        if self.corners.iter().any(|c| (c.s - s).abs() <= 1e-12 * self.length()) {
            let k = self.samples.partition_point(|x| x.0 < s - 1e-12 * self.length());
            let (before, after) = (self.samples[k], self.samples[(k + 1).min(self.samples.len() - 1)]);
            let sum: V3<f64> = std::array::from_fn(|c| before.2[c] + after.2[c]);
            let size = norm(sum);
            let t = if size > 1e-9 { sum.map(|x| x / size) } else { after.2 };
            return (before.1, t);
        }
        let k = self.samples.partition_point(|x| x.0 <= s).clamp(1, self.samples.len() - 1);
        let ((s0, p0, t0), (s1, p1, t1)) = (self.samples[k - 1], self.samples[k]);
        let h = s1 - s0;
        if h <= 0.0 {
            return (p1, t1);
        }
        // cubic Hermite between samples: exact on lines, fourth order on curves
        let x = ((s - s0) / h).clamp(0.0, 1.0);
        let (x2, x3) = (x * x, x * x * x);
        let f = [2.0 * x3 - 3.0 * x2 + 1.0, x3 - 2.0 * x2 + x, 3.0 * x2 - 2.0 * x3, x3 - x2];
        let d = [6.0 * x2 - 6.0 * x, 3.0 * x2 - 4.0 * x + 1.0, 6.0 * x - 6.0 * x2, 3.0 * x2 - 2.0 * x];
        let p = std::array::from_fn(|c| f[0] * p0[c] + f[2] * p1[c] + h * (f[1] * t0[c] + f[3] * t1[c]));
        let t: V3<f64> =
            std::array::from_fn(|c| (d[0] * p0[c] + d[2] * p1[c]) / h + d[1] * t0[c] + d[3] * t1[c]);
        let size = norm(t);
        (p, t.map(|x| x / size))
    }
}

fn check(points: &[V3<f64>]) -> Result<(), String> {
    if points.len() < 2 {
        return Err("a path needs at least two points".into());
    }
    if let Some(p) = points.iter().flatten().find(|x| !x.is_finite()) {
        return Err(format!("a point holds {p}, which is not a finite number"));
    }
    match points.windows(2).position(|w| w[0] == w[1]) {
        Some(k) => Err(format!("points {} and {} are the same: the cable has no length there", k + 1, k + 2)),
        None => Ok(()),
    }
}

/// Distance from one point to another, and the direction.
fn direction(from: V3<f64>, to: V3<f64>) -> (f64, V3<f64>) {
    let d = sub(to, from);
    (norm(d), unit(d))
}

/// The angle between two vectors, well also where it is small.
pub(crate) fn angle(a: &V3<f64>, b: &V3<f64>) -> f64 {
    norm(cross(a, b)).atan2(dot(a, b))
}

fn unit(a: V3<f64>) -> V3<f64> {
    let size = norm(a);
    a.map(|x| x / size)
}

fn sub(a: V3<f64>, b: V3<f64>) -> V3<f64> {
    std::array::from_fn(|i| a[i] - b[i])
}
pub(crate) fn norm(a: V3<f64>) -> f64 {
    a.iter().map(|x| x * x).sum::<f64>().sqrt()
}
