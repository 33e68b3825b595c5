//! Elements that are folded inside themselves: what the quadrature doesn't see.
//!
//! The axial force is integrated from the strain at a few points. A slope that points backwards, or a chord, strains none of
//! them, although the curve between runs to and fro through `r' = 0`, a strain of -1. A search for equilibrium can be caught by
//! such a shape, which no cable has, and nothing in its equations tells.

use super::shape::{combine, natural};
use ropewalk_core::{V3, dot};

/// Positions and slopes of nodes.
pub type Places = [[f64; 6]];

/// Less than this share of its length is left of a curve where it is folded.
const CUSP: f64 = 0.25;
/// Places in an element where the slope is looked at.
const LOOKS: u32 = 32;
/// Cosine below which two directions are opposite.
const OPPOSITE: f64 = -0.5;

/// The element between two nodes.
#[derive(Clone, Copy, Debug)]
pub struct Between {
    /// Its nodes are this and the next one.
    pub first: usize,
    /// Its unstretched length [m].
    pub length: f64,
}

impl Between {
    fn slope(self, nodes: &Places, xi: f64) -> V3<f64> {
        let (a, b) = (&nodes[self.first], &nodes[self.first + 1]);
        let e: [f64; 12] = std::array::from_fn(|i| if i < 6 { a[i] } else { b[i - 6] });
        let phi = [1.0, (1.0 - xi) * (1.0 - 3.0 * xi), xi * (3.0 * xi - 2.0)];
        combine(&phi, &natural(&e, 1.0 / self.length))
    }

    /// Whether its curve turns back inside it.
    pub fn is_folded(self, nodes: &Places) -> bool {
        let looks = (1..LOOKS).map(|i| f64::from(i) / f64::from(LOOKS));
        looks.map(|xi| self.slope(nodes, xi)).any(|p| dot(&p, &p) < CUSP * CUSP)
    }

    fn chord(self, nodes: &Places) -> V3<f64> {
        let (a, b) = (&nodes[self.first], &nodes[self.first + 1]);
        std::array::from_fn(|i| (b[i] - a[i]) / self.length)
    }
}

/// Turns round what points backwards in and beside these folded elements, all of them in order along the line: chords, whose
/// length the others make up for between the ends of the line, and slopes.
pub fn unfold(nodes: &mut Places, elements: &[Between], folded: &[bool]) {
    let chords: Vec<V3<f64>> = elements.iter().map(|e| e.chord(nodes)).collect();
    let mut ways: Vec<V3<f64>> = chords.iter().map(unit).collect();
    let near = |e: usize| (e.saturating_sub(1)..(e + 2).min(elements.len())).any(|i| folded[i]);
    let beside = |e: usize| {
        let around = [e.checked_sub(1), Some(e + 1).filter(|e| *e < elements.len())];
        let all = around.iter().flatten();
        unit(&all.fold([0.0; 3], |sum: V3<f64>, &i| std::array::from_fn(|c| sum[c] + unit(&chords[i])[c])))
    };
    let mut excess = [0.0; 3];
    for e in (0..elements.len()).filter(|&e| near(e)) {
        let onwards = beside(e);
        if dot(&onwards, &ways[e]) < OPPOSITE {
            ways[e] = onwards;
            for c in 0..3 {
                excess[c] += elements[e].length * (onwards[c] - chords[e][c]);
            }
        }
    }
    if excess != [0.0; 3] {
        lay(nodes, elements, &chords, &ways, &excess);
    }
    for k in 0..nodes.len() {
        let own = elements.iter().enumerate().filter(|(_, e)| e.first == k || e.first + 1 == k);
        let own: Vec<usize> = own.map(|(e, _)| e).filter(|&e| near(e)).collect();
        let sum = own.iter().fold([0.0; 3], |sum: V3<f64>, &e| std::array::from_fn(|c| sum[c] + ways[e][c]));
        let p = [nodes[k][3], nodes[k][4], nodes[k][5]];
        let onwards = unit(&sum);
        if dot(&onwards, &unit(&p)) < OPPOSITE {
            nodes[k][3..].copy_from_slice(&onwards);
        }
    }
}

/// Moves the nodes such that chords that were turned round have their length, and the ends stay.
fn lay(nodes: &mut Places, elements: &[Between], chords: &[V3<f64>], ways: &[V3<f64>], excess: &V3<f64>) {
    let total: f64 = elements.iter().map(|e| e.length).sum();
    let mut at: V3<f64> = [nodes[0][0], nodes[0][1], nodes[0][2]];
    for (e, element) in elements.iter().enumerate() {
        // both nodes of a splice are at one place
        nodes[element.first][..3].copy_from_slice(&at);
        let turned = dot(&unit(&chords[e]), &ways[e]) < 0.0;
        let chord = if turned { ways[e] } else { chords[e] };
        for c in 0..3 {
            at[c] += element.length * (chord[c] - excess[c] / total);
        }
        nodes[element.first + 1][..3].copy_from_slice(&at);
    }
}

fn unit(x: &V3<f64>) -> V3<f64> {
    let size = dot(x, x).sqrt();
    if size > 0.0 { x.map(|x| x / size) } else { [0.0; 3] }
}
