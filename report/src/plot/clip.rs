//! Lines cut at the edges of the plotting area, and lines cut into dashes.

use super::thin::Pixel;

/// Dashes and gaps of the curves of a plot, in pixels, one after the other; the first curve is solid.
const PATTERNS: [&[f64]; 8] = [
    &[],
    &[9.0, 4.0],
    &[2.5, 3.5],
    &[11.0, 3.5, 2.5, 3.5],
    &[16.0, 5.0],
    &[5.0, 3.0],
    &[11.0, 3.5, 2.5, 3.5, 2.5, 3.5],
    &[1.5, 6.0],
];
/// A line longer than this is one that oscillates from column to column: its dashes could not be seen.
const LONGEST: f64 = 20_000.0;

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

/// The dashes of a line, by the number of its curve.
pub(super) fn dashes(line: &[Pixel], curve: usize) -> Vec<Vec<Pixel>> {
    let pattern = PATTERNS[curve % PATTERNS.len()];
    let length = |w: &[Pixel]| (w[1].0 - w[0].0).hypot(w[1].1 - w[0].1);
    if pattern.is_empty() || line.windows(2).map(length).sum::<f64>() > LONGEST {
        return vec![line.to_vec()];
    }
    let mut all = Vec::new();
    let mut dash = vec![line[0]];
    let (mut piece, mut left) = (0, pattern[0]);
    for w in line.windows(2) {
        let (mut from, mut rest) = (w[0], length(w));
        while rest > left {
            let share = left / rest;
            from = (from.0 + share * (w[1].0 - from.0), from.1 + share * (w[1].1 - from.1));
            rest -= left;
            dash.push(from);
            if piece % 2 == 0 {
                all.push(std::mem::take(&mut dash));
            }
            dash = vec![from];
            piece = (piece + 1) % pattern.len();
            left = pattern[piece];
        }
        left -= rest;
        dash.push(w[1]);
    }
    if piece % 2 == 0 {
        all.push(dash);
    }
    all
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

    #[test]
    fn dashes_have_their_length_whatever_the_points() {
        let line: Vec<Pixel> = (0..=300).map(|i| (f64::from(i) / 3.0, 0.0)).collect();
        let all = dashes(&line, 1);
        assert_eq!(all.len(), 8);
        for (k, dash) in all.iter().enumerate() {
            let (from, to) = (dash[0].0, dash[dash.len() - 1].0);
            assert!((from - 13.0 * k as f64).abs() < 1e-9 && (to - from - 9.0).abs() < 1e-9, "{from} {to}");
        }
        assert_eq!(dashes(&line, 0), [line]);
    }
}
