//! The path along which a cable or a chain is laid: straight lines, a smooth curve through points, turns on a spool.

use ropewalk_core::V3;
use ropewalk_core::rotation::cross;
use std::f64::consts::TAU;

/// A path in space by arc length.
#[derive(Clone, Debug)]
pub struct Path {
    /// Arc length, position and tangent of densely spaced points; corners appear twice, once for each side.
    samples: Vec<(f64, V3<f64>, V3<f64>)>,
    /// Arc lengths of corners.
    corners: Vec<f64>,
}

impl Path {
    /// Straight lines from point to point.
    ///
    /// # Errors
    /// Fewer than two points, two equal neighbours, or a number that isn't finite.
    pub fn polyline(points: &[V3<f64>]) -> Result<Self, String> {
        check(points)?;
        let (mut samples, mut corners, mut s) = (Vec::new(), Vec::new(), 0.0);
        for w in points.windows(2) {
            let d = sub(w[1], w[0]);
            let length = norm(d);
            let t = d.map(|x| x / length);
            samples.push((s, w[0], t));
            s += length;
            samples.push((s, w[1], t));
            corners.push(s);
        }
        corners.pop();
        Ok(Path { samples, corners })
    }

    /// A smooth curve through points: a natural cubic spline over the length of the chords.
    ///
    /// # Errors
    /// As [`Path::polyline`].
    pub fn spline(points: &[V3<f64>]) -> Result<Self, String> {
        check(points)?;
        let n = points.len();
        let mut u = vec![0.0];
        for w in points.windows(2) {
            u.push(u[u.len() - 1] + norm(sub(w[1], w[0])));
        }
        let second: [Vec<f64>; 3] =
            std::array::from_fn(|c| natural_spline(&u, &points.iter().map(|p| p[c]).collect::<Vec<_>>()));
        let at = |k: usize, x: f64| -> (V3<f64>, V3<f64>) {
            let h = u[k + 1] - u[k];
            let (a, b) = ((u[k + 1] - x) / h, (x - u[k]) / h);
            let position = std::array::from_fn(|c| {
                a * points[k][c]
                    + b * points[k + 1][c]
                    + ((a * a * a - a) * second[c][k] + (b * b * b - b) * second[c][k + 1]) * h * h / 6.0
            });
            let slope = std::array::from_fn(|c| {
                (points[k + 1][c] - points[k][c]) / h
                    + ((1.0 - 3.0 * a * a) * second[c][k] + (3.0 * b * b - 1.0) * second[c][k + 1]) * h / 6.0
            });
            (position, slope)
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
                let (p, d) = at(k, x);
                let speed = norm(d);
                if speed < 1e-9 {
                    return Err("the curve turns back on itself between its points: give more points".into());
                }
                samples.push((s, p, d.map(|x| x / speed)));
                s += gauss.iter().map(|(g, w)| w * h * norm(at(k, x + g * h).1)).sum::<f64>();
            }
        }
        let (p, d) = at(n - 2, u[n - 1]);
        let speed = norm(d);
        samples.push((s, p, d.map(|x| x / speed)));
        Ok(Path { samples, corners: Vec::new() })
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
        self.corners.push(s0);
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

    /// Arc lengths of its corners.
    pub fn corners(&self) -> &[f64] {
        &self.corners
    }

    /// Position and unit tangent at an arc length; at a corner the mean of both sides.
    pub fn at(&self, s: f64) -> (V3<f64>, V3<f64>) {
        if self.corners.iter().any(|c| (c - s).abs() <= 1e-12 * self.length()) {
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

/// Second derivatives of the natural cubic spline through `(x, y)`.
fn natural_spline(x: &[f64], y: &[f64]) -> Vec<f64> {
    let n = x.len();
    let (mut second, mut u) = (vec![0.0; n], vec![0.0; n]);
    for i in 1..n - 1 {
        let sig = (x[i] - x[i - 1]) / (x[i + 1] - x[i - 1]);
        let p = sig * second[i - 1] + 2.0;
        let jump = (y[i + 1] - y[i]) / (x[i + 1] - x[i]) - (y[i] - y[i - 1]) / (x[i] - x[i - 1]);
        second[i] = (sig - 1.0) / p;
        u[i] = (6.0 * jump / (x[i + 1] - x[i - 1]) - sig * u[i - 1]) / p;
    }
    second[n - 1] = 0.0;
    for i in (0..n - 1).rev() {
        second[i] = second[i] * second[i + 1] + u[i];
    }
    second[0] = 0.0;
    second
}

fn sub(a: V3<f64>, b: V3<f64>) -> V3<f64> {
    std::array::from_fn(|i| a[i] - b[i])
}
fn norm(a: V3<f64>) -> f64 {
    a.iter().map(|x| x * x).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polyline_has_its_length_and_corners() {
        let p = Path::polyline(&[[0.0; 3], [3.0, 0.0, 0.0], [3.0, 4.0, 0.0]]).unwrap();
        assert_eq!(p.length(), 7.0);
        assert_eq!(p.corners(), &[3.0]);
        let (x, t) = p.at(1.0);
        approx::assert_relative_eq!(x[..], [1.0, 0.0, 0.0][..], epsilon = 1e-12);
        assert_eq!(t, [1.0, 0.0, 0.0]);
        let (x, t) = p.at(3.0);
        assert_eq!(x, [3.0, 0.0, 0.0]);
        approx::assert_relative_eq!(t[0], 0.5f64.sqrt(), epsilon = 1e-12);
        assert_eq!(p.at(7.0).0, [3.0, 4.0, 0.0]);
    }

    #[test]
    fn spline_through_a_circle_is_nearly_one() {
        let points: Vec<V3<f64>> = (0..=32)
            .map(|k| {
                let a = std::f64::consts::PI * f64::from(k) / 32.0;
                [a.cos(), a.sin(), 0.0]
            })
            .collect();
        let p = Path::spline(&points).unwrap();
        approx::assert_relative_eq!(p.length(), std::f64::consts::PI, max_relative = 1e-4);
        for k in 1..10 {
            let s = p.length() * f64::from(k) / 10.0;
            let (x, t) = p.at(s);
            approx::assert_relative_eq!(norm(x), 1.0, max_relative = 1e-3);
            approx::assert_abs_diff_eq!(x[0] * t[0] + x[1] * t[1], 0.0, epsilon = 5e-3);
        }
    }

    #[test]
    fn turns_on_a_spool_keep_their_radius_and_pitch() {
        let path = Path::polyline(&[[1.0, 0.0, 0.3], [0.0, 0.0, 0.3]]).unwrap();
        let path = path.wind([0.0; 3], [-2.0, 0.0, 0.0], 0.025, 3.0).unwrap();
        let turn = (TAU * 0.3).hypot(0.025);
        approx::assert_relative_eq!(path.length(), 1.0 + 3.0 * turn, max_relative = 1e-14);
        for k in 0..30 {
            let s = 0.1 * f64::from(k) * turn + 0.003;
            let (x, t) = path.at(1.0 + s);
            approx::assert_relative_eq!(x[1].hypot(x[2]), 0.3, max_relative = 1e-7);
            approx::assert_relative_eq!(x[0], -0.025 * s / turn, epsilon = 1e-8);
            // right-handed about the axis, which points to negative x
            assert!(x[1] * t[2] - x[2] * t[1] < -0.29);
        }
        let straight = || Path::polyline(&[[1.0, 0.0, 0.0], [0.0; 3]]).unwrap();
        assert!(straight().wind([0.0; 3], [1.0, 0.0, 0.0], 0.1, 2.0).is_err());
        assert!(straight().wind([0.0; 3], [0.0; 3], 0.1, 2.0).is_err());
        assert!(straight().wind([0.0, 0.0, 1.0], [1.0, 0.0, 0.0], 0.1, f64::NAN).is_err());
    }

    #[test]
    fn bad_points_are_refused() {
        assert!(Path::polyline(&[[0.0; 3]]).is_err());
        assert!(Path::polyline(&[[0.0; 3], [0.0; 3]]).is_err());
        assert!(Path::spline(&[[0.0; 3], [f64::NAN, 0.0, 0.0]]).is_err());
    }
}
