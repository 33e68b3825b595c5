//! Differences of functions that programs give as motions.

use ropewalk_constraints::testing::{best_step, differences};

#[test]
fn differences_are_derivatives_also_at_the_start() {
    let f = |t: f64| [(2.0 * t).sin(), t.exp(), 3.0 * t * t];
    for t in [0.0_f64, 0.004, 0.7] {
        let h = best_step(f, 2.0);
        let [v, a] = differences(f, t, h);
        let (first, second) =
            ([2.0 * (2.0 * t).cos(), t.exp(), 6.0 * t], [-4.0 * (2.0 * t).sin(), t.exp(), 6.0]);
        for i in 0..3 {
            assert!((v[i] - first[i]).abs() < 1e-8, "{t} {i}: {} {}", v[i], first[i]);
            assert!((a[i] - second[i]).abs() < 1e-5, "{t} {i}: {} {}", a[i], second[i]);
        }
    }
}

#[test]
fn the_step_follows_what_the_function_does() {
    // where the error of fourth order, ω⁶ h⁴, is that of rounding, ε/h²; steps are tried three times apart
    for omega in [50.0, 0.05] {
        let h = best_step(|t| [(omega * t).sin(), 0.0, 0.0], 100.0);
        let best = f64::EPSILON.powf(1.0 / 6.0) / omega;
        assert!((0.25..4.0).contains(&(h / best)), "{omega} rad/s: {h} s, best {best}");
    }
    assert!(best_step(|_| [1.0; 3], 100.0) > 0.0);
}
