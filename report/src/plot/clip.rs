//! Lines cut at the edges of the plotting area.

use super::thin::Pixel;

/// A rectangle: left, top, right, bottom.
pub(super) type Edges = [f64; 4];

/// The parts of a line within the edges.
pub(super) fn within(line: &[Pixel], [left, top, right, bottom]: Edges) -> Vec<Vec<Pixel>> {
    if let [only] = line {
        let inside = (left..=right).contains(&only.0) && (top..=bottom).contains(&only.1);
        return if inside { vec![vec![*only]] } else { Vec::new() };
    }
    let mut parts: Vec<Vec<Pixel>> = Vec::new();
    for w in line.windows(2) {
        let (a, d) = (w[0], (w[1].0 - w[0].0, w[1].1 - w[0].1));
        // Liang and Barsky: the share of the segment that lies inside
        let (mut enters, mut leaves) = (0.0_f64, 1.0_f64);
        for (slope, room) in [(-d.0, a.0 - left), (d.0, right - a.0), (-d.1, a.1 - top), (d.1, bottom - a.1)]
        {
            if slope < 0.0 {
                enters = enters.max(room / slope);
            } else if slope > 0.0 {
                leaves = leaves.min(room / slope);
            } else if room < 0.0 {
                leaves = -1.0;
            }
        }
        if enters > leaves {
            continue;
        }
        let at = |share: f64| (a.0 + share * d.0, a.1 + share * d.1);
        let (from, to) = (at(enters), if leaves < 1.0 { at(leaves) } else { w[1] });
        match parts.last_mut().filter(|part| enters == 0.0 && part.last() == Some(&from)) {
            Some(part) => part.push(to),
            None => parts.push(vec![from, to]),
        }
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_lies_outside_is_cut_off_at_the_edge() {
        let edges = [0.0, 0.0, 10.0, 10.0];
        let spike = [(0.0, 5.0), (2.0, 5.0), (3.0, -5.0), (4.0, 5.0), (12.0, 5.0)];
        let parts = within(&spike, edges);
        assert_eq!(
            parts,
            [vec![(0.0, 5.0), (2.0, 5.0), (2.5, 0.0)], vec![(3.5, 0.0), (4.0, 5.0), (10.0, 5.0)]]
        );
        assert!(within(&[(11.0, 0.0), (11.0, 5.0)], edges).is_empty());
        assert!(within(&[(11.0, 5.0)], edges).is_empty() && within(&[(1.0, 5.0)], edges).len() == 1);
    }
}
