//! Structures like those of cables to test solvers with: lines, trees, nets and hubs, with joints as constraints.

use crate::algebra::scalar::Scalar;
use crate::model::node::{Node, NodeId, NodeKind};
use crate::model::order::Rows;
use crate::model::pattern::Pattern;
use crate::model::structure::Structure;

/// Numbers between -1/2 and 1/2.
pub struct Rng(pub u64);
impl Rng {
    pub fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 53) as f64 - 0.5
    }
}

/// Cables of slope nodes, whose ends are held together or to the ground.
#[derive(Clone, Default)]
pub struct Sample {
    nodes: usize,
    elements: Vec<[usize; 2]>,
    joints: Vec<(usize, Option<usize>)>,
    /// Of the random numbers.
    pub seed: u64,
}

impl Sample {
    /// A cable; gives its ends.
    fn cable(&mut self, elements: usize) -> [usize; 2] {
        let first = self.nodes;
        self.nodes += elements + 1;
        self.elements.extend((first..first + elements).map(|k| [k, k + 1]));
        [first, first + elements]
    }

    /// A cable, held at one end.
    pub fn line(elements: usize) -> Self {
        let mut s = Sample::default();
        let [a, _] = s.cable(elements);
        s.joints.push((a, None));
        s
    }

    /// A binary tree of cables, whose root is held.
    pub fn tree(depth: u32) -> Self {
        let mut s = Sample::default();
        let mut ends = vec![None];
        for _ in 0..depth {
            let before = std::mem::take(&mut ends);
            for end in before {
                for _ in 0..2 {
                    let [a, b] = s.cable(4);
                    s.joints.push((a, end));
                    ends.push(Some(b));
                }
            }
        }
        s
    }

    /// A net of `n × n` meshes, knotted where its cables end, and held at its corners.
    pub fn net(n: usize) -> Self {
        let (mut s, mut knots) = (Sample::default(), vec![None; (n + 1) * (n + 1)]);
        for i in 0..=n {
            for j in 0..=n {
                for [di, dj] in [[1, 0], [0, 1]] {
                    if i + di > n || j + dj > n {
                        continue;
                    }
                    let ends = s.cable(4);
                    for (at, end) in [(i * (n + 1) + j, ends[0]), ((i + di) * (n + 1) + j + dj, ends[1])] {
                        let corner = [0, n, n * (n + 1), n * (n + 2)].contains(&at);
                        match knots[at] {
                            Some(other) => s.joints.push((end, Some(other))),
                            None if corner => s.joints.push((end, None)),
                            None => {}
                        }
                        knots[at] = knots[at].or(Some(end));
                    }
                }
            }
        }
        s
    }

    /// So many cables from the ground to one node.
    pub fn hub(legs: usize) -> Self {
        let mut s = Sample { nodes: 1, ..Sample::default() };
        for _ in 0..legs {
            let [a, b] = s.cable(8);
            s.joints.extend([(a, Some(0)), (b, None)]);
        }
        // a spring holds it
        s.elements.push([0, 1]);
        s
    }

    pub fn multipliers(&self) -> usize {
        3 * self.joints.len()
    }

    /// Its structure, and a matrix that is definite but for the constraints. `twist` makes it unsymmetric; every element's
    /// share loses `soft` of its diagonal, as that of a compressed cable does, and is no longer definite above 0.5.
    pub fn build<T: Scalar>(&self, symmetric: bool, soft: f64, twist: f64) -> (Structure, Vec<T>) {
        let nodes: Vec<Node> = (0..self.nodes)
            .map(|k| Node { kind: NodeKind::Slope, q: 6 * k, v: 6 * k, shared: false })
            .collect();
        let nv = 6 * self.nodes;
        let dofs = |k: usize| 6 * k..6 * k + 6;
        let mut p = Pattern::default();
        for &[a, b] in &self.elements {
            p.clique(dofs(a).chain(dofs(b)));
        }
        let mut rows = Vec::new();
        for (c, &(a, b)) in self.joints.iter().enumerate() {
            let mut members = vec![a];
            members.extend(b);
            members.sort_unstable();
            p.clique(members.iter().flat_map(|&k| dofs(k)).chain(nv + 3 * c..nv + 3 * c + 3));
            let n = 6 * members.len();
            let mut jacobian = vec![0.0; 3 * n];
            for i in 0..3 {
                for (m, &k) in members.iter().enumerate() {
                    jacobian[i * n + 6 * m + i] = if k == a { 1.0 } else { -1.0 };
                }
            }
            let nodes = members.iter().map(|&k| NodeId(k as u32)).collect();
            rows.push(Rows { count: 3, nodes, jacobian, behind: Vec::new() });
        }
        let s = Structure::new(&nodes, &rows, &p, symmetric);
        let (mut values, mut rng) = (vec![T::default(); s.entries()], Rng(0x9E37_79B9_7F4A_7C15 ^ self.seed));
        let mut add = |i: usize, j: usize, v: T| {
            let (i, j) = (s.position[i], s.position[j]);
            if !symmetric || i <= j {
                values[s.slot(i, j)] += v;
            }
        };
        for &[a, b] in &self.elements {
            let x: Vec<f64> = (0..144).map(|_| rng.next()).collect();
            let d: Vec<usize> = dofs(a).chain(dofs(b)).collect();
            for i in 0..12 {
                for j in 0..12 {
                    let dot: f64 = (0..12).map(|k| x[12 * i + k] * x[12 * j + k]).sum();
                    let v = dot + twist * (i as f64 - j as f64).sin() + if i == j { 0.5 - soft } else { 0.0 };
                    add(d[i], d[j], T::from(v));
                }
            }
        }
        for (c, &(a, b)) in self.joints.iter().enumerate() {
            for i in 0..3 {
                let row = nv + 3 * c + i;
                for (k, sign) in [(Some(a), 1.0), (b, -1.0)] {
                    let Some(k) = k else { continue };
                    add(row, 6 * k + i, T::from(sign));
                    add(6 * k + i, row, T::from(sign));
                }
            }
        }
        (s, values)
    }
}
