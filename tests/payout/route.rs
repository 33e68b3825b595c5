//! The line along a route, against lines by hand.

use ropewalk_core::V3;
use ropewalk_elements::testing::{Side, Stop, lay};
use std::f64::consts::PI;

const UP: V3<f64> = [0.0, 0.0, 1.0];

fn wheel(centre: V3<f64>, radius: f64, up: f64) -> Stop {
    Stop::Wheel { centre, axis: [0.0, 1.0, 0.0], radius, side: Side::Towards(UP.map(|x| up * x)) }
}

#[test]
fn half_a_turn_over_a_wheel() {
    let ends = [[-0.1, 0.0, -1.0], [0.1, 0.0, -2.0]].map(Stop::Point);
    let line = lay(&[ends[0], wheel([0.0; 3], 0.1, 1.0), ends[1]]).unwrap();
    approx::assert_relative_eq!(line[1].wrap, PI, max_relative = 1e-12);
    approx::assert_abs_diff_eq!(line[1].at[0][0], -0.1, epsilon = 1e-12);
    assert_eq!(line[1].axis, [0.0, 1.0, 0.0]);
    // the other way along it, the axis is the other
    let back = lay(&[ends[1], wheel([0.0; 3], 0.1, 1.0), ends[0]]).unwrap();
    assert_eq!(back[1].axis, [0.0, -1.0, 0.0]);
}

#[test]
fn oblique_line_leaves_as_by_hand() {
    // theory: e.(P - c) = R in the plane of the wheel (reference fleet_angle)
    let stops = [Stop::Point([-3.0, 0.0, 0.5]), wheel([0.0; 3], 0.5, 1.0), Stop::Point([4.0, 0.6, -3.0])];
    let line = lay(&stops).unwrap();
    for (x, exact) in line[1].at[1].iter().zip([0.33849623113198596, 0.0, 0.367994974842648]) {
        approx::assert_abs_diff_eq!(*x, exact, epsilon = 1e-12);
    }
}

#[test]
fn a_tackle_takes_the_open_tangents() {
    let blocks = |z: f64, up: f64, y: f64| wheel([0.0, y, z], 0.25, up);
    let stops = [
        Stop::Point([-2.0, 0.0, 1.0]),
        blocks(10.0, 1.0, 0.0),
        blocks(4.0, -1.0, 0.03),
        blocks(10.0, 1.0, 0.06),
        blocks(4.0, -1.0, 0.09),
        Stop::Point([-0.25, 0.1, 10.0]),
    ];
    let line = lay(&stops).unwrap();
    for turn in &line[2..5] {
        assert!((turn.wrap - PI).abs() < 0.03, "{turn:?}");
        // all turn the same way
        assert_eq!(turn.axis[1], 1.0);
    }
}

#[test]
fn what_cannot_be_is_refused() {
    let ends = [[-1.0, 0.0, 1.0], [1.0, 0.0, 1.0]].map(Stop::Point);
    // the line passes well above the wheel: it isn't touched
    assert_eq!(lay(&[ends[0], wheel([0.0; 3], 0.1, 1.0), ends[1]]).unwrap_err().stop, 1);
    assert_eq!(lay(&[ends[0], wheel([-1.0, 0.0, 0.9], 0.3, 1.0), ends[1]]).unwrap_err().stop, 1);
}
