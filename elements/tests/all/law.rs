//! Tables of force over strain and moment over curvature: the curves through them.

use ropewalk_elements::cable::{AxialForce, BendingMoment};
use ropewalk_elements::testing::Curve;

/// A curve, and the points that it goes through.
type Through = (Curve, Vec<[f64; 2]>);

fn rope() -> Through {
    let points = [[-0.02, -10.0], [0.0, 0.0], [0.01, 100.0], [0.02, 400.0], [0.05, 1000.0]];
    let [strain, force] = [0, 1].map(|i| points.iter().map(|p| p[i]).collect());
    (AxialForce { strain, force }.curve().expect("a curve"), points.to_vec())
}

fn pipe() -> Through {
    let points = [[0.0, 0.0], [0.01, 50.0], [0.1, 80.0], [0.3, 90.0]];
    let [curvature, moment] = [0, 1].map(|i| points.iter().map(|p| p[i]).collect());
    (BendingMoment { curvature, moment }.curve().expect("a curve"), points.to_vec())
}

#[test]
fn the_curve_passes_its_points_and_never_falls() {
    for (curve, points) in [rope(), pipe()] {
        for [x, y] in points {
            assert!((curve.at(x)[1] - y).abs() < 1e-12);
        }
        let steps = (0..4000).map(|k| curve.at(-0.03 + 1e-4 * f64::from(k))[1]).collect::<Vec<_>>();
        assert!(steps.windows(2).all(|w| w[1] >= w[0]));
    }
}

#[test]
fn the_energy_is_the_integral_of_the_force() {
    for (curve, points) in [rope(), pipe()] {
        assert_eq!(curve.at(0.0)[0], 0.0);
        // Gauss's two points are exact for cubics
        for pair in points.windows(2) {
            let [a, b] = [pair[0][0], pair[1][0]];
            let gauss = |s: f64| curve.at(0.5 * (a + b) + 0.5 * (b - a) * s / 3f64.sqrt())[1];
            let area = 0.5 * (b - a) * (gauss(-1.0) + gauss(1.0));
            assert!((curve.at(b)[0] - curve.at(a)[0] - area).abs() < 1e-12 * area.abs().max(1.0));
        }
    }
}

#[test]
fn slopes_are_derivatives_also_by_the_square() {
    let ((curve, _), e) = (pipe(), 1e-6);
    for kappa in [1e-3, 0.005, 0.02, 0.09, 0.2, 0.5] {
        let [_, moment, slope] = curve.at(kappa);
        let d = (curve.at(kappa + e)[1] - curve.at(kappa - e)[1]) / (2.0 * e);
        assert!((d - slope).abs() < 1e-5 * slope, "{kappa}: {d} {slope}");
        let [energy, by, again] = curve.by_square(kappa * kappa);
        assert!((energy - curve.at(kappa)[0]).abs() < 1e-12 && (by - 0.5 * moment / kappa).abs() < 1e-9);
        let e = 1e-5 * kappa * kappa;
        let d = (curve.by_square(kappa * kappa + e)[1] - curve.by_square(kappa * kappa - e)[1]) / (2.0 * e);
        assert!((d - again).abs() < 1e-6 * again.abs() + 1e-3, "{kappa}: {d} {again}");
    }
    // finite where the cable is straight
    assert!(curve.by_square(0.0).iter().all(|x| x.is_finite()));
}

#[test]
fn tables_that_are_none_are_refused() {
    let force = |strain: &[f64], force: &[f64]| {
        let table = AxialForce { strain: strain.to_vec(), force: force.to_vec() };
        table.curve().expect_err("refused").message
    };
    assert!(force(&[0.0], &[0.0]).contains("two points"));
    assert!(force(&[0.0, 0.1], &[0.0]).contains("two points"));
    assert!(force(&[0.0, 0.2, 0.1], &[0.0, 1.0, 2.0]).contains("larger than the one before"));
    assert!(force(&[0.0, 0.1, 0.2], &[0.0, 2.0, 1.0]).contains("falls"));
    assert!(force(&[0.1, 0.2], &[0.0, 2.0]).contains("strain of 0"));
    let late = BendingMoment { curvature: vec![0.1, 0.2], moment: vec![0.0, 1.0] };
    assert!(late.curve().expect_err("refused").message.contains("begins with a curvature of 0"));
}
