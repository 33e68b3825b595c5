//! Paths along which cables and chains are laid.

use ropewalk_core::V3;
use ropewalk_elements::Path;
use std::f64::consts::TAU;

fn sub(a: V3<f64>, b: V3<f64>) -> V3<f64> {
    std::array::from_fn(|i| a[i] - b[i])
}

fn norm(a: V3<f64>) -> f64 {
    ropewalk_core::dot(&a, &a).sqrt()
}

#[test]
fn polyline_has_its_length_and_corners() {
    let p = Path::polyline(&[[0.0; 3], [3.0, 0.0, 0.0], [3.0, 4.0, 0.0]]).unwrap();
    assert_eq!(p.length(), 7.0);
    assert_eq!(p.corners().len(), 1);
    assert_eq!((p.corners()[0].s, p.corners()[0].at), (3.0, [3.0, 0.0, 0.0]));
    approx::assert_relative_eq!(p.corners()[0].angle, TAU / 4.0, epsilon = 1e-15);
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
    let p = Path::spline(&points, [None; 2]).unwrap();
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

/// Curvature by differences of the tangent.
fn curvature(p: &Path, s: f64) -> f64 {
    let d = 1e-3;
    norm(sub(p.at(s + d).1, p.at(s - d).1)) / (2.0 * d)
}

#[test]
fn spline_through_a_circle_is_as_curved_at_its_ends() {
    let circle = |k: i32| {
        let a = 0.5 * std::f64::consts::PI * f64::from(k) / 8.0;
        [a.sin(), 1.0 - a.cos(), 0.0]
    };
    let points: Vec<V3<f64>> = (0..=8).map(circle).collect();
    for directions in
        [[None; 2], [Some([2.0, 0.0, 0.0]), None], [Some([1.0, 0.0, 0.0]), Some([0.0, 3.0, 0.0])]]
    {
        let p = Path::spline(&points, directions).unwrap();
        for s in [0.01, 0.1, p.length() - 0.1, p.length() - 0.01] {
            let k = curvature(&p, s);
            assert!((k - 1.0).abs() < 0.03, "{k} at {s} with {directions:?}");
        }
    }
    let p = Path::spline(&points, [Some([1.0, 1.0, 0.0]), None]).unwrap();
    approx::assert_relative_eq!(p.at(0.0).1[..], [0.5f64.sqrt(), 0.5f64.sqrt(), 0.0][..], epsilon = 1e-12);
    assert!(Path::spline(&points, [Some([0.0; 3]), None]).unwrap_err().contains("no length"));
}

#[test]
fn corners_are_rounded_by_arcs() {
    let p = Path::rounded(&[[0.0; 3], [3.0, 0.0, 0.0], [3.0, 4.0, 0.0]], 0.5).unwrap();
    approx::assert_relative_eq!(p.length(), 7.0 - 1.0 + TAU / 8.0, epsilon = 1e-14);
    assert!(p.corners().is_empty());
    let arc: Vec<f64> = p.stops().collect();
    approx::assert_relative_eq!(arc[0], 2.5, epsilon = 1e-14);
    approx::assert_relative_eq!(arc[arc.len() - 1], 2.5 + TAU / 8.0, epsilon = 1e-14);
    assert!(arc.windows(2).all(|s| (s[1] - s[0]) / 0.5 <= 1.0 / 3.0 + 1e-12));
    for s in [2.5, 2.6, 3.0, 3.2] {
        let x = p.at(s).0;
        approx::assert_relative_eq!((x[0] - 2.5).hypot(x[1] - 0.5), 0.5, epsilon = 1e-8);
    }
    approx::assert_relative_eq!(p.at(p.length()).0[..], [3.0, 4.0, 0.0][..], epsilon = 1e-14);
    let corner = [[0.0; 3], [3.0, 0.0, 0.0], [3.0, 4.0, 0.0]];
    assert!(Path::rounded(&corner, 3.0).is_ok());
    assert!(Path::rounded(&corner, 3.1).unwrap_err().contains("from point 1 to point 2, which is 3 m long"));
    assert!(Path::rounded(&[[0.0; 3], [3.0, 0.0, 0.0], [1.0, 0.0, 0.0]], 0.1).is_err());
}

#[test]
fn bad_points_are_refused() {
    assert!(Path::polyline(&[[0.0; 3]]).is_err());
    assert!(Path::polyline(&[[0.0; 3], [0.0; 3]]).is_err());
    assert!(Path::spline(&[[0.0; 3], [f64::NAN, 0.0, 0.0]], [None; 2]).is_err());
}
