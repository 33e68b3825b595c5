//! Where the joints of a chain stand on a path.

use crate::path::Path;
use ropewalk_core::V3;

/// Ends of `links` links of this length [m] that all lie on the path, from its start on.
///
/// From a joint on, the next is the first point of the path that far away as the crow flies. An arc is never shorter
/// than its chord, so going on by what the chord still lacks never goes too far.
///
/// # Errors
/// The path ends before the chain does: the number of links that fit.
pub fn joints(path: &Path, links: usize, length: f64) -> Result<Vec<V3<f64>>, usize> {
    trace(path, links, length).map(|(joints, _)| joints)
}

/// The same, and the arc length that the last joint stands at.
fn trace(path: &Path, links: usize, length: f64) -> Result<(Vec<V3<f64>>, f64), usize> {
    let (mut s, end) = (0.0_f64, path.length());
    let mut joints = vec![path.at(0.0).0];
    for k in 0..links {
        let from = joints[k];
        loop {
            let to = path.at(s.min(end)).0;
            let chord = (0..3).map(|i| (to[i] - from[i]).powi(2)).sum::<f64>().sqrt();
            let left = length - chord;
            if left <= 1e-13 * length {
                joints.push(to);
                break;
            }
            // a chain that fills the path may miss its end by rounding
            if s >= end && left <= 1e-9 * length {
                joints.push(to);
                break;
            }
            if s >= end {
                return Err(k);
            }
            s += left;
        }
    }
    Ok((joints, s.min(end)))
}

/// The length of equal links [m] with which a chain fills a path from start to end.
///
/// # Errors
/// There is none: at a sharp corner the end jumps past.
pub(crate) fn filling(path: &Path, links: usize) -> Result<f64, String> {
    let arc = path.length();
    // no chord is longer than its arc
    let mut high = arc / links as f64;
    if joints(path, links, high).is_ok() {
        return Ok(high);
    }
    let mut low = 0.0;
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if trace(path, links, middle).is_ok() { low = middle } else { high = middle }
    }
    match trace(path, links, low) {
        Ok((_, s)) if low > 0.0 && arc - s <= 1e-6 * low => Ok(low),
        _ => Err(format!(
            "{links} links of one length don't fill the path from start to end; give the chain's `length`, up to \
             {:.6} m, and it ends on the path where it ends",
            low * links as f64
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sizes(joints: &[V3<f64>]) -> Vec<f64> {
        joints.windows(2).map(|w| (0..3).map(|i| (w[1][i] - w[0][i]).powi(2)).sum::<f64>().sqrt()).collect()
    }

    #[test]
    fn a_straight_chain_fills_its_path() {
        let path = Path::polyline(&[[0.0; 3], [3.0, 4.0, 0.0]]).unwrap();
        assert_eq!(filling(&path, 10), Ok(0.5));
        let joints = joints(&path, 10, 0.5).unwrap();
        approx::assert_relative_eq!(joints[10][..], [3.0, 4.0, 0.0][..], epsilon = 1e-12);
    }

    #[test]
    fn links_are_equal_around_corners_and_on_spools() {
        let path = Path::polyline(&[[1.0, 0.0, 0.3], [0.0, 0.0, 0.3]]).unwrap();
        let path = path.wind([0.0; 3], [-1.0, 0.0, 0.0], 0.025, 5.0).unwrap();
        let joints = joints(&path, 100, 0.1).unwrap();
        for size in sizes(&joints) {
            approx::assert_relative_eq!(size, 0.1, max_relative = 1e-12);
        }
        for x in &joints[11..] {
            approx::assert_relative_eq!(x[1].hypot(x[2]), 0.3, max_relative = 1e-7);
        }
        let length = filling(&path, 60).unwrap();
        let joints = super::joints(&path, 60, length).unwrap();
        let end = path.at(path.length()).0;
        assert!((0..3).all(|i| (joints[60][i] - end[i]).abs() < 1e-6), "{:?} {end:?}", joints[60]);
    }

    #[test]
    fn a_path_that_is_too_short_is_told() {
        let path = Path::polyline(&[[0.0; 3], [1.0, 0.0, 0.0]]).unwrap();
        assert_eq!(joints(&path, 3, 0.4), Err(2));
    }
}
