//! The numbers of Radau IIA with three stages, and of the transformation that decouples its stages
//! (Hairer & Wanner 1996, Solving Ordinary Differential Equations II, section IV.8).

use faer::c64;

/// Where the stages stand in the step.
pub(super) const C: [f64; 3] = [0.155_051_025_721_682_2, 0.644_948_974_278_317_8, 1.0];

/// Inverse of the Runge-Kutta matrix: turns increments over the step size into rates.
pub(super) const INVERSE: [[f64; 3]; 3] = [
    [3.224_744_871_391_589, 1.167_840_084_690_405_5, -0.253_197_264_742_180_84],
    [-3.567_840_084_690_405_5, 0.775_255_128_608_411, 1.053_197_264_742_180_8],
    [5.531_972_647_421_808, -7.531_972_647_421_808, 5.0],
];

/// Real eigenvalue of [`INVERSE`].
pub(super) const GAMMA: f64 = 3.637_834_252_744_496;

/// Its complex eigenvalue, with the positive imaginary part.
pub(super) const ALPHA: c64 = c64 { re: 2.681_082_873_627_752, im: 3.050_430_199_247_410_6 };

/// Columns: the real eigenvector, and real and imaginary part of what goes with [`ALPHA`]:
/// `T⁻¹ A⁻¹ T = diag(γ, [[re, -im], [im, re]])`.
pub(super) const T: [[f64; 3]; 3] = [
    [0.091_232_394_870_892_94, -0.141_255_295_020_954_2, -0.030_029_194_105_147_424],
    [0.241_717_932_707_107, 0.204_129_352_293_799_93, 0.382_942_112_757_262],
    [0.966_048_182_615_093, 1.0, 0.0],
];

/// Inverse of [`T`].
pub(super) const T_INVERSE: [[f64; 3]; 3] = [
    [4.325_579_890_063_155, 0.339_199_251_815_809_87, 0.541_770_539_935_874_9],
    [-4.178_718_591_551_905, -0.327_682_820_761_062_4, 0.476_623_554_500_550_45],
    [-0.502_872_634_945_787, 2.571_926_949_855_605, -0.596_039_204_828_225],
];

/// Weights of the stages in the error estimate; the rate at the start has the weight `1/γ`.
pub(super) const ERROR: [f64; 3] =
    [-2.762_305_454_748_599, 0.379_935_598_252_728_9, -0.091_629_609_865_225_8];

/// Weights that continue a polynomial from its values at the first `N` of `nodes` to `x` (Lagrange).
pub(super) fn continuation<const N: usize>(nodes: [f64; N], x: f64) -> [f64; N] {
    std::array::from_fn(|k| {
        (0..N).filter(|&j| j != k).map(|j| (x - nodes[j]) / (nodes[k] - nodes[j])).product()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    type Square = [[f64; 3]; 3];

    fn product(a: Square, b: Square) -> Square {
        std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum()))
    }

    fn assert_equal(a: Square, b: Square) {
        for (a, b) in a.iter().flatten().zip(b.iter().flatten()) {
            approx::assert_abs_diff_eq!(a, b, epsilon = 2e-14);
        }
    }

    const ONE: Square = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

    #[test]
    fn inverses_and_eigenvalues_belong_to_the_matrix_of_radau_iia() {
        let s = 6f64.sqrt();
        let a = [
            [(88.0 - 7.0 * s) / 360.0, (296.0 - 169.0 * s) / 1800.0, (3.0 * s - 2.0) / 225.0],
            [(296.0 + 169.0 * s) / 1800.0, (88.0 + 7.0 * s) / 360.0, (-2.0 - 3.0 * s) / 225.0],
            [(16.0 - s) / 36.0, (16.0 + s) / 36.0, 1.0 / 9.0],
        ];
        assert_equal(product(a, INVERSE), ONE);
        assert_equal(product(T, T_INVERSE), ONE);
        let block = [[GAMMA, 0.0, 0.0], [0.0, ALPHA.re, -ALPHA.im], [0.0, ALPHA.im, ALPHA.re]];
        assert_equal(product(product(T_INVERSE, INVERSE), T), block);
        for i in 0..3 {
            approx::assert_abs_diff_eq!(a[i].iter().sum::<f64>(), C[i], epsilon = 1e-15);
        }
    }

    #[test]
    fn the_error_estimate_is_of_order_three() {
        // f₀ h/γ + Σ e Z of the motion t^p: nothing for the first three powers
        let estimate = |p: i32| {
            let rate = if p == 1 { 1.0 } else { 0.0 };
            rate / GAMMA + (0..3).map(|i| ERROR[i] * C[i].powi(p)).sum::<f64>()
        };
        for p in 1..=3 {
            approx::assert_abs_diff_eq!(estimate(p), 0.0, epsilon = 1e-14);
        }
        assert!(estimate(4).abs() > 1e-2);
    }

    #[test]
    fn a_polynomial_is_continued_exactly() {
        let nodes = [0.0, C[0], C[1], C[2]];
        let f = |x: f64| 1.0 - 2.0 * x + 3.0 * x * x - 0.5 * x.powi(3);
        let w = continuation(nodes, 2.7);
        approx::assert_relative_eq!(
            nodes.iter().zip(w).map(|(x, w)| f(*x) * w).sum::<f64>(),
            f(2.7),
            max_relative = 1e-12
        );
    }
}
