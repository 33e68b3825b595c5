//! The tension between stations, from means over elements.

use ropewalk_elements::testing::weights;

/// Mean with the weight of an element, by Simpson's rule on a fine grid.
fn mean(f: impl Fn(f64) -> f64, from: f64, l: f64) -> f64 {
    let n = 2000;
    (0..=n)
        .map(|k| {
            let xi = f64::from(k) / f64::from(n);
            let simpson = if k == 0 || k == n {
                1.0
            } else if k % 2 == 1 {
                4.0
            } else {
                2.0
            };
            simpson / (3.0 * f64::from(n)) * 6.0 * xi * (1.0 - xi) * f(from + l * xi)
        })
        .sum()
}

#[test]
fn polynomials_are_found_from_their_means() {
    let (ends, f) = ([0.2, 0.5, 1.4, 1.6], |s: f64| 2.0 - 3.0 * s + 0.7 * s * s);
    let length = [0.3, 0.9, 0.2];
    let means: Vec<f64> = (0..3).map(|k| mean(f, ends[k], length[k])).collect();
    for at in [0.2, 0.7, 1.6] {
        let middle = [0, 1, 2].map(|k| ends[k] + 0.5 * length[k] - at);
        let w = weights(&middle, &length);
        let found: f64 = (0..3).map(|k| w[k] * means[k]).sum();
        assert!((found - f(at)).abs() < 1e-9, "{found} {}", f(at));
        let (line, two) = (|s: f64| 1.0 + s, weights(&middle[..2], &length[..2]));
        let found: f64 = (0..2).map(|k| two[k] * mean(line, ends[k], length[k])).sum();
        assert!((found - line(at)).abs() < 1e-9);
    }
}
