//! Vectors and rotations in space.
//!
//! An orientation is a unit quaternion `(w, x, y, z)` whose matrix `R` turns vectors of the body into space. A small
//! rotation is a vector `θ` in the body's own axes: `R ← R exp(θ̃)`.

use crate::algebra::lane::V3;
use std::ops::{Add, Mul, Sub};

/// A 3×3 matrix, row by row.
pub type M3<R = f64> = [V3<R>; 3];

/// The matrix of no rotation.
pub const IDENTITY: M3 = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// Vector product.
///
/// ```
/// use ropewalk_core::rotation::cross;
/// assert_eq!(cross(&[1.0, 0.0, 0.0], &[0.0, 1.0, 0.0]), [0.0, 0.0, 1.0]);
/// ```
#[inline(always)]
pub fn cross<T: Copy + Mul<Output = T> + Sub<Output = T>>(a: &V3<T>, b: &V3<T>) -> V3<T> {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// `ã`, the matrix with `ã b = a × b`.
///
/// ```
/// use ropewalk_core::rotation::{cross, skew, times};
/// let (a, b) = ([1.0, 2.0, 3.0], [-1.0, 0.5, 4.0]);
/// assert_eq!(times(&skew(&a), &b), cross(&a, &b));
/// ```
pub fn skew(a: &V3<f64>) -> M3 {
    [[0.0, -a[2], a[1]], [a[2], 0.0, -a[0]], [-a[1], a[0], 0.0]]
}

/// `A b`
#[inline(always)]
pub fn times<T: Copy + Mul<Output = T> + Add<Output = T>>(a: &M3<T>, b: &V3<T>) -> V3<T> {
    [along(&a[0], b), along(&a[1], b), along(&a[2], b)]
}

/// Scalar product over any carrier: how far `b` goes along a unit vector `a`.
#[inline(always)]
pub fn along<T: Copy + Mul<Output = T> + Add<Output = T>>(a: &V3<T>, b: &V3<T>) -> T {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// `Aᵀ b`
#[inline(always)]
pub fn transposed_times<T: Copy + Mul<Output = T> + Add<Output = T>>(a: &M3<T>, b: &V3<T>) -> V3<T> {
    let [x, y, z] = a;
    times(&[[x[0], y[0], z[0]], [x[1], y[1], z[1]], [x[2], y[2], z[2]]], b)
}

/// `A B`
pub fn product(a: &M3, b: &M3) -> M3 {
    a.map(|row| transposed_times(b, &row))
}

/// The rate of a rotation vector `θ`, by less than a whole turn, in a motion with angular velocity `ω` in the body's own
/// axes: `ω + ½ θ×ω + c θ×(θ×ω)` with `c = (1 - ½φ cot ½φ)/φ²` (Iserles, Munthe-Kaas, Nørsett & Zanna 2000, the inverse
/// of "dexp").
///
/// ```
/// use ropewalk_core::rotation::vector_rate;
/// // about the axis that it turns about already
/// assert_eq!(vector_rate(&[0.0, 0.0, 1.0], &[0.0, 0.0, 2.0]), [0.0, 0.0, 2.0]);
/// ```
pub fn vector_rate(theta: &V3<f64>, omega: &V3<f64>) -> V3<f64> {
    let square = along(theta, theta);
    let angle = square.sqrt();
    let c = if angle < 1e-2 {
        1.0 / 12.0 + square / 720.0
    } else {
        (1.0 - 0.5 * angle / (0.5 * angle).tan()) / square
    };
    let once = cross(theta, omega);
    let twice = cross(theta, &once);
    std::array::from_fn(|i| omega[i] + 0.5 * once[i] + c * twice[i])
}

/// The rotation matrix of a unit quaternion, over any carrier.
#[inline(always)]
pub fn matrix<T>(q: &[T; 4]) -> M3<T>
where
    T: Copy + Mul<Output = T> + Add<Output = T> + Sub<Output = T>,
{
    let [w, x, y, z] = *q;
    let twice = |t: T| t + t;
    let (xx, yy, zz, ww) = (x * x, y * y, z * z, w * w);
    [
        [ww + xx - yy - zz, twice(x * y - w * z), twice(x * z + w * y)],
        [twice(x * y + w * z), ww - xx + yy - zz, twice(y * z - w * x)],
        [twice(x * z - w * y), twice(y * z + w * x), ww - xx - yy + zz],
    ]
}

/// The quaternion of the rotation by the vector `θ`.
///
/// ```
/// use ropewalk_core::rotation::{exp, matrix, times};
/// // a quarter turn about z takes x to y
/// let turned = times(&matrix(&exp([0.0, 0.0, std::f64::consts::FRAC_PI_2])), &[1.0, 0.0, 0.0]);
/// assert!((turned[1] - 1.0).abs() < 1e-15 && turned[0].abs() < 1e-15);
/// ```
pub fn exp(theta: V3<f64>) -> [f64; 4] {
    let angle = theta.iter().map(|x| x * x).sum::<f64>().sqrt();
    // sin(x/2)/x, by its series where the quotient would be 0/0
    let s = if angle < 1e-4 { 0.5 - angle * angle / 48.0 } else { (0.5 * angle).sin() / angle };
    [(0.5 * angle).cos(), s * theta[0], s * theta[1], s * theta[2]]
}

/// The vector of a unit quaternion's rotation, the shorter way round: undoes [`exp`].
///
/// ```
/// use ropewalk_core::rotation::{exp, log};
/// let theta = [0.3, -0.2, 1.1];
/// assert!(log(exp(theta)).iter().zip(theta).all(|(a, b)| (a - b).abs() < 1e-15));
/// ```
pub fn log(p: [f64; 4]) -> V3<f64> {
    let sign = if p[0] < 0.0 { -1.0 } else { 1.0 };
    let sine = (p[1] * p[1] + p[2] * p[2] + p[3] * p[3]).sqrt();
    let scale = if sine < 1e-8 { 2.0 } else { 2.0 * sine.atan2(sign * p[0]) / sine };
    [sign * scale * p[1], sign * scale * p[2], sign * scale * p[3]]
}

/// The quaternion of two rotations, the second in the axes that the first has turned.
///
/// ```
/// use ropewalk_core::rotation::{exp, log, then};
/// let about_z = |angle: f64| exp([0.0, 0.0, angle]);
/// assert!((log(then(about_z(0.5), about_z(0.25)))[2] - 0.75).abs() < 1e-15);
/// ```
pub fn then(a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
    [
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
        a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
        a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
    ]
}

/// The quaternion of a rotation matrix (Shepperd 1978: by its largest component, so never singular).
///
/// ```
/// use ropewalk_core::rotation::{exp, from_matrix, matrix};
/// let q = exp([0.4, 0.1, -0.7]);
/// assert!(from_matrix(&matrix(&q)).iter().zip(q).all(|(a, b)| (a - b).abs() < 1e-15));
/// ```
pub fn from_matrix(r: &M3) -> [f64; 4] {
    let trace = r[0][0] + r[1][1] + r[2][2];
    let squares = [trace, r[0][0], r[1][1], r[2][2]];
    let largest = (0..4).max_by(|&i, &j| squares[i].total_cmp(&squares[j])).unwrap_or(0);
    let mut q = [0.0; 4];
    if largest == 0 {
        q = [1.0 + trace, r[2][1] - r[1][2], r[0][2] - r[2][0], r[1][0] - r[0][1]];
    } else {
        let (i, j, k) = (largest - 1, largest % 3, (largest + 1) % 3);
        q[0] = r[k][j] - r[j][k];
        q[1 + i] = 1.0 + r[i][i] - r[j][j] - r[k][k];
        q[1 + j] = r[j][i] + r[i][j];
        q[1 + k] = r[k][i] + r[i][k];
    }
    let norm = q.iter().map(|x| x * x).sum::<f64>().sqrt();
    q.map(|x| x / norm)
}

/// The quaternion of Bryant angles: turns about the body's x, then its new y, then its new z [rad].
pub fn from_bryant(angles: V3<f64>) -> [f64; 4] {
    let [x, y, z] = angles;
    then(then(exp([x, 0.0, 0.0]), exp([0.0, y, 0.0])), exp([0.0, 0.0, z]))
}

/// Bryant angles 1-2-3 of a unit quaternion [rad]; the second is between -90° and 90°. Where it reaches them the first
/// and the third can't be told apart, and the third is given as 0.
///
/// ```
/// use ropewalk_core::rotation::{bryant, from_bryant};
/// let angles = [0.1, -0.4, 2.0];
/// assert!(bryant(&from_bryant(angles)).iter().zip(angles).all(|(a, b)| (a - b).abs() < 1e-14));
/// ```
pub fn bryant(q: &[f64; 4]) -> V3<f64> {
    let r = matrix(q);
    let sine = r[0][2].clamp(-1.0, 1.0);
    let cosine = (r[0][0] * r[0][0] + r[0][1] * r[0][1]).sqrt();
    if cosine > 1e-9 {
        [(-r[1][2]).atan2(r[2][2]), sine.atan2(cosine), (-r[0][1]).atan2(r[0][0])]
    } else {
        [r[2][1].atan2(r[1][1]), sine.atan2(cosine), 0.0]
    }
}

/// Three unit vectors at right angles, the third along `d` (of any length but zero), as rows.
pub fn around(d: V3<f64>) -> M3 {
    let length = d.iter().map(|x| x * x).sum::<f64>().sqrt();
    let d = d.map(|x| x / length);
    // starts from the axis that is farthest from d
    let least = (0..3).min_by(|&i, &j| d[i].abs().total_cmp(&d[j].abs())).unwrap_or(0);
    let n = cross(&d, &IDENTITY[least]);
    let length = n.iter().map(|x| x * x).sum::<f64>().sqrt();
    let n = n.map(|x| x / length);
    [n, cross(&d, &n), d]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(a: &[f64], b: &[f64]) {
        for (a, b) in a.iter().zip(b) {
            approx::assert_abs_diff_eq!(a, b, epsilon = 1e-13);
        }
    }

    #[test]
    fn bryant_angles_come_back_and_are_turns_one_after_the_other() {
        for angles in [[0.3, -0.7, 2.5], [-3.0, 1.5, -1.0], [0.0; 3], [1.0, -1.57, 0.2]] {
            close(&bryant(&from_bryant(angles)), &angles);
        }
        // by hand: a quarter turn about x, then one about the new y, which is the old z
        close(
            &times(&matrix(&from_bryant([0.5f64.acos() * 1.5, 0.0, 0.0])), &[0.0, 1.0, 0.0]),
            &[0.0, 0.0, 1.0],
        );
        let two = matrix(&from_bryant([std::f64::consts::FRAC_PI_2, std::f64::consts::FRAC_PI_2, 0.0]));
        close(&times(&two, &[1.0, 0.0, 0.0]), &[0.0, 1.0, 0.0]);
    }

    #[test]
    fn the_singular_bryant_angle_still_gives_the_rotation() {
        let q = from_bryant([0.4, std::f64::consts::FRAC_PI_2, 0.9]);
        let back = matrix(&from_bryant(bryant(&q)));
        for (a, b) in back.iter().zip(&matrix(&q)) {
            close(a, b);
        }
    }

    #[test]
    fn quaternions_come_back_from_their_matrices() {
        for theta in [[0.1, 0.2, 0.3], [3.1, 0.1, -0.2], [-0.3, 3.0, 0.5], [0.2, -0.1, 3.12], [0.0; 3]] {
            let q = exp(theta);
            let back = from_matrix(&matrix(&q));
            let sign = if q[0] * back[0] + q[1] * back[1] + q[2] * back[2] + q[3] * back[3] < 0.0 {
                -1.0
            } else {
                1.0
            };
            close(&back.map(|x| sign * x), &q);
            close(&log(q), &theta);
        }
    }

    #[test]
    fn axes_around_a_direction_are_a_right_handed_frame() {
        let a = around([1.0, -2.0, 0.5]);
        close(&cross(&a[0], &a[1]), &a[2]);
        close(&times(&a, &a[0]), &[1.0, 0.0, 0.0]);
    }
}
