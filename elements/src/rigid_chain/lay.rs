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
pub fn filling(path: &Path, links: usize) -> Result<f64, String> {
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
