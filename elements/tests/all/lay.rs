//! Chains laid along paths.

use ropewalk_core::V3;
use ropewalk_core::rotation::{matrix, transposed_times};
use ropewalk_elements::Path;
use ropewalk_elements::rigid_chain::joints;
use ropewalk_elements::testing::{filling, orientations};

fn sizes(joints: &[V3<f64>]) -> Vec<f64> {
    joints.windows(2).map(|w| (0..3).map(|i| (w[1][i] - w[0][i]).powi(2)).sum::<f64>().sqrt()).collect()
}

#[test]
fn a_straight_chain_fills_its_path() {
    let path = Path::polyline(&[[0.0; 3], [3.0, 4.0, 0.0]]).unwrap();
    assert_eq!(filling(&path, 10), Ok(0.5));
    let laid = joints(&path, 10, 0.5).unwrap();
    approx::assert_relative_eq!(laid[10][..], [3.0, 4.0, 0.0][..], epsilon = 1e-12);
}

#[test]
fn links_are_equal_around_corners_and_on_spools() {
    let path = Path::polyline(&[[1.0, 0.0, 0.3], [0.0, 0.0, 0.3]]).unwrap();
    let path = path.wind([0.0; 3], [-1.0, 0.0, 0.0], 0.025, 5.0).unwrap();
    let laid = joints(&path, 100, 0.1).unwrap();
    for size in sizes(&laid) {
        approx::assert_relative_eq!(size, 0.1, max_relative = 1e-12);
    }
    for x in &laid[11..] {
        approx::assert_relative_eq!(x[1].hypot(x[2]), 0.3, max_relative = 1e-7);
    }
    let length = filling(&path, 60).unwrap();
    let laid = joints(&path, 60, length).unwrap();
    let end = path.at(path.length()).0;
    assert!((0..3).all(|i| (laid[60][i] - end[i]).abs() < 1e-6), "{:?} {end:?}", laid[60]);
}

#[test]
fn a_path_that_is_too_short_is_told() {
    let path = Path::polyline(&[[0.0; 3], [1.0, 0.0, 0.0]]).unwrap();
    assert_eq!(joints(&path, 3, 0.4), Err(2));
}

#[test]
fn links_point_ahead_and_turn_the_shortest_way() {
    let directions = [[0.0, 0.6, 0.8], [0.0, 0.8, 0.6], [0.0, -0.8, -0.6], [1.0, 0.0, 0.0]];
    let all = orientations(&directions);
    for (q, d) in all.iter().zip(&directions) {
        let r = matrix(q);
        assert!((0..3).all(|i| (r[i][0] - d[i]).abs() < 1e-12), "{r:?} {d:?}");
    }
    // the first two lie in a plane: what is normal to it doesn't turn
    let [a, b] = [matrix(&all[0]), matrix(&all[1])];
    let normal = transposed_times(&a, &[1.0, 0.0, 0.0]);
    let same = transposed_times(&b, &[1.0, 0.0, 0.0]);
    assert!((0..3).all(|i| (normal[i] - same[i]).abs() < 1e-12));
}
