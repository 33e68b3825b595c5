//! Which unknowns are coupled, in which order they are eliminated, and where each block of a tangent goes.
//!
//! Both are fixed once per model. Nodes are eliminated in the order in which they were made (along the cable) or,
//! where that fills in more, in an approximate minimum degree order of the *nodes*; the rows of a constraint
//! follow the last node that they touch, which keeps LDLᵀ without pivoting stable; shared nodes come last.

use crate::node::{Node, NodeId};
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::SymbolicSparseColMatRef;
use faer::sparse::linalg::amd;

/// Collects the couplings of all terms, each as a clique of unknowns.
#[derive(Debug, Default)]
pub struct Pattern {
    /// Unknowns of all cliques, one after the other.
    dofs: Vec<u32>,
    /// Where each clique ends in `dofs`.
    ends: Vec<usize>,
}

impl Pattern {
    /// Declares that these unknowns (indices of velocities) are coupled with each other.
    pub fn clique(&mut self, dofs: impl IntoIterator<Item = usize>) {
        self.dofs.extend(dofs.into_iter().map(|d| d as u32));
        self.ends.push(self.dofs.len());
    }
    /// Number of cliques so far.
    pub fn len(&self) -> usize {
        self.ends.len()
    }
    /// Whether there is no clique.
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }
    /// The unknowns of one clique.
    pub fn get(&self, k: usize) -> &[u32] {
        &self.dofs[if k == 0 { 0 } else { self.ends[k - 1] }..self.ends[k]]
    }
}

/// The sparse structure of the iteration matrix in elimination order, and the way of every clique into it.
#[derive(Clone, Debug)]
pub struct Structure {
    /// Number of unknowns: velocities and multipliers.
    pub n: usize,
    /// Only the upper triangle is stored.
    pub symmetric: bool,
    /// Position of each unknown (velocities first, then multipliers) in the elimination order.
    pub position: Vec<usize>,
    /// Start of each column in `rows`.
    pub columns: Vec<usize>,
    /// Row of each stored entry, ascending in each column.
    pub rows: Vec<usize>,
    /// For each position whether it is a multiplier.
    pub is_multiplier: Vec<bool>,
    /// Start of each clique in `slots`.
    pub cliques: Vec<usize>,
    /// Where each entry of each clique's square block is stored.
    pub slots: Vec<u32>,
    /// Storage of the diagonal entry of each unknown.
    pub diagonal: Vec<u32>,
}

/// The rows of one constraint and the nodes that they touch.
#[derive(Clone, Debug)]
pub(crate) struct Rows {
    pub count: usize,
    pub nodes: Vec<NodeId>,
}

impl Structure {
    /// `pattern` holds the cliques of terms and then one per constraint, whose unknowns are velocities followed by
    /// its rows (`nv + row`).
    pub(crate) fn new(nodes: &[Node], constraints: &[Rows], pattern: &Pattern, symmetric: bool) -> Self {
        let nv = nodes.iter().map(|n| n.kind.velocities()).sum::<usize>();
        let n = nv + constraints.iter().map(|c| c.count).sum::<usize>();
        let node_of = node_of_dof(nodes, nv);
        let graph = node_graph(nodes.len(), constraints, pattern, &node_of, nv);

        let natural: Vec<usize> = shared_last(nodes, (0..nodes.len()).collect());
        let degree = shared_last(nodes, minimum_degree(&graph));
        // the chain is nearly always best; nets and trees are not chains
        let order = if fill(&graph, &degree) < fill(&graph, &natural) { degree } else { natural };
        let position = positions(nodes, constraints, &order, n, nv);

        let mut entries: Vec<(u32, u32)> = Vec::new();
        for k in 0..pattern.len() {
            let clique = pattern.get(k);
            for &i in clique {
                for &j in clique {
                    let (r, c) = (position[i as usize] as u32, position[j as usize] as u32);
                    if r <= c || !symmetric {
                        entries.push((c, r));
                    }
                }
            }
        }
        entries.extend((0..n as u32).map(|i| (i, i)));
        entries.sort_unstable();
        entries.dedup();
        let mut columns = vec![0; n + 1];
        for &(c, _) in &entries {
            columns[c as usize + 1] += 1;
        }
        for c in 0..n {
            columns[c + 1] += columns[c];
        }
        let rows: Vec<usize> = entries.iter().map(|&(_, r)| r as usize).collect();

        let mut structure = Structure {
            n,
            symmetric,
            is_multiplier: vec![false; n],
            position,
            columns,
            rows,
            cliques: Vec::with_capacity(pattern.len()),
            slots: Vec::new(),
            diagonal: Vec::new(),
        };
        for i in nv..n {
            let p = structure.position[i];
            structure.is_multiplier[p] = true;
        }
        for k in 0..pattern.len() {
            structure.cliques.push(structure.slots.len());
            let clique = pattern.get(k);
            for &i in clique {
                for &j in clique {
                    let slot = structure.slot(i as usize, j as usize);
                    structure.slots.push(slot);
                }
            }
        }
        structure.diagonal = (0..n).map(|i| structure.slot(i, i)).collect();
        structure
    }

    /// Number of stored entries.
    pub fn entries(&self) -> usize {
        self.rows.len()
    }

    fn slot(&self, i: usize, j: usize) -> u32 {
        let (mut r, mut c) = (self.position[i], self.position[j]);
        if self.symmetric && r > c {
            std::mem::swap(&mut r, &mut c);
        }
        let column = &self.rows[self.columns[c]..self.columns[c + 1]];
        // every clique was entered above, so the entry is there
        (self.columns[c] + column.partition_point(|&x| x < r)) as u32
    }

    /// `y = A x` in elimination order.
    pub fn multiply(&self, values: &[f64], x: &[f64], y: &mut [f64]) {
        y.fill(0.0);
        for c in 0..self.n {
            let (rows, values) = self.column(c, values);
            // the entries above the diagonal stand for those on its left as well
            let mirrored = if self.symmetric { rows.len() - 1 } else { 0 };
            if let Some(run) = consecutive(rows) {
                for (y, a) in y[run.clone()].iter_mut().zip(values) {
                    *y += a * x[c];
                }
                y[c] += values[..mirrored].iter().zip(&x[run]).map(|(a, x)| a * x).sum::<f64>();
            } else {
                for (&r, a) in rows.iter().zip(values) {
                    y[r] += a * x[c];
                }
                y[c] += values[..mirrored].iter().zip(rows).map(|(a, &r)| a * x[r]).sum::<f64>();
            }
        }
    }

    /// Rows and values of a column.
    pub(crate) fn column<'a>(&'a self, c: usize, values: &'a [f64]) -> (&'a [usize], &'a [f64]) {
        let range = self.columns[c]..self.columns[c + 1];
        (&self.rows[range.clone()], &values[range])
    }
}

/// The rows as a range, if they follow each other without a gap: along a chain nearly all do.
pub(crate) fn consecutive(rows: &[usize]) -> Option<std::ops::Range<usize>> {
    let (&first, &last) = (rows.first()?, rows.last()?);
    (last + 1 - first == rows.len()).then_some(first..last + 1)
}

fn node_of_dof(nodes: &[Node], nv: usize) -> Vec<u32> {
    let mut of = vec![0; nv];
    for (k, n) in nodes.iter().enumerate() {
        of[n.dofs()].fill(k as u32);
    }
    of
}

fn node_graph(
    count: usize,
    constraints: &[Rows],
    pattern: &Pattern,
    node_of: &[u32],
    nv: usize,
) -> Vec<Vec<u32>> {
    let mut graph: Vec<Vec<u32>> = vec![Vec::new(); count];
    let mut join = |members: &mut Vec<u32>| {
        members.sort_unstable();
        members.dedup();
        for &a in members.iter() {
            graph[a as usize].extend(members.iter().filter(|&&b| b != a));
        }
    };
    for k in 0..pattern.len() {
        let mut m: Vec<u32> =
            pattern.get(k).iter().filter(|&&d| (d as usize) < nv).map(|&d| node_of[d as usize]).collect();
        join(&mut m);
    }
    for c in constraints {
        join(&mut c.nodes.iter().map(|n| n.0).collect());
    }
    for g in &mut graph {
        g.sort_unstable();
        g.dedup();
    }
    graph
}

fn shared_last(nodes: &[Node], order: Vec<usize>) -> Vec<usize> {
    let (shared, own): (Vec<usize>, Vec<usize>) = order.into_iter().partition(|&k| nodes[k].shared);
    own.into_iter().chain(shared).collect()
}

/// Approximate minimum degree order of the node graph, by faer.
fn minimum_degree(graph: &[Vec<u32>]) -> Vec<usize> {
    let n = graph.len();
    let natural: Vec<usize> = (0..n).collect();
    let mut columns = vec![0];
    let mut rows: Vec<usize> = Vec::new();
    for g in graph {
        rows.extend(g.iter().map(|&r| r as usize));
        columns.push(rows.len());
    }
    let a = SymbolicSparseColMatRef::new_checked(n, n, &columns, None, &rows);
    let (mut order, mut inverse) = (vec![0usize; n], vec![0usize; n]);
    let mut memory = MemBuffer::new(amd::order_scratch::<usize>(n, rows.len()));
    match amd::order(&mut order, &mut inverse, a, amd::Control::default(), MemStack::new(&mut memory)) {
        Ok(_) => order,
        Err(_) => natural,
    }
}

/// Number of off-diagonal blocks of the factor if nodes are eliminated in this order.
fn fill(graph: &[Vec<u32>], order: &[usize]) -> usize {
    let n = order.len();
    let mut place = vec![0; n];
    for (p, &k) in order.iter().enumerate() {
        place[k] = p;
    }
    // elimination tree and column counts by merging the rows of children
    let mut columns: Vec<Vec<usize>> = vec![Vec::new(); n];
    let mut total = 0;
    for p in 0..n {
        let mut mine = std::mem::take(&mut columns[p]);
        mine.extend(graph[order[p]].iter().map(|&b| place[b as usize]).filter(|&b| b > p));
        mine.sort_unstable();
        mine.dedup();
        total += mine.len();
        if let Some(&parent) = mine.first() {
            columns[parent].extend(mine.into_iter().skip(1));
        }
    }
    total
}

fn positions(nodes: &[Node], constraints: &[Rows], order: &[usize], n: usize, nv: usize) -> Vec<usize> {
    let mut place = vec![0; nodes.len()];
    for (p, &k) in order.iter().enumerate() {
        place[k] = p;
    }
    let mut behind: Vec<Vec<usize>> = vec![Vec::new(); nodes.len()];
    let mut row = nv;
    let mut position = vec![usize::MAX; n];
    let mut next = 0;
    for c in constraints {
        let rows = row..row + c.count;
        row += c.count;
        match c.nodes.iter().map(|k| place[k.0 as usize]).max() {
            Some(last) => behind[last].extend(rows),
            // a constraint between fixed things only; the model refuses it, its place doesn't matter
            None => behind.last_mut().map_or((), |b| b.extend(rows)),
        }
    }
    for (p, &k) in order.iter().enumerate() {
        for d in nodes[k].dofs().chain(behind[p].iter().copied()) {
            position[d] = next;
            next += 1;
        }
    }
    position
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::node::NodeKind;

    fn points(n: usize) -> Vec<Node> {
        (0..n).map(|k| Node { kind: NodeKind::Point, q: 3 * k, v: 3 * k, shared: false }).collect()
    }

    #[test]
    fn chain_keeps_its_order_and_rows_follow_their_last_node() {
        let nodes = points(4);
        let mut p = Pattern::default();
        for k in 0..3 {
            p.clique(3 * k..3 * k + 6);
        }
        p.clique((3..6).chain(12..15));
        let rows = vec![Rows { count: 3, nodes: vec![NodeId(1)] }];
        let s = Structure::new(&nodes, &rows, &p, true);
        assert_eq!(&s.position[..6], &[0, 1, 2, 3, 4, 5]);
        assert_eq!(&s.position[6..9], &[9, 10, 11]);
        assert_eq!(&s.position[12..15], &[6, 7, 8]);
        assert!(s.is_multiplier[6] && !s.is_multiplier[9]);
    }

    #[test]
    fn star_eliminates_its_leaves_first_and_shared_nodes_last() {
        let mut nodes = points(5);
        let mut p = Pattern::default();
        for leaf in 1..5 {
            p.clique((0..3).chain(3 * leaf..3 * leaf + 3));
        }
        let s = Structure::new(&nodes, &[], &p, true);
        // with the hub in the middle or first there would be fill
        assert!(s.position[0] >= 3 * 3);
        nodes[2].shared = true;
        let s = Structure::new(&nodes, &[], &p, true);
        assert_eq!(&s.position[6..9], &[12, 13, 14]);
    }

    #[test]
    fn product_is_that_of_the_dense_matrix() {
        let nodes = points(3);
        let mut p = Pattern::default();
        p.clique(0..6);
        p.clique(3..9);
        for symmetric in [true, false] {
            let s = Structure::new(&nodes, &[], &p, symmetric);
            let mut values = vec![0.0; s.entries()];
            for k in 0..2 {
                let c = p.get(k);
                for i in 0..6 {
                    for j in 0..if symmetric { i + 1 } else { 6 } {
                        values[s.slots[s.cliques[k] + 6 * i + j] as usize] += (1 + c[i] * c[j]) as f64;
                    }
                }
            }
            let x: Vec<f64> = (0..9).map(|i| f64::from(i) - 4.0).collect();
            let mut y = vec![0.0; 9];
            s.multiply(&values, &x, &mut y);
            let entry = |i: usize, j: usize| {
                f64::from(
                    [(0, 6), (3, 9)]
                        .iter()
                        .map(|&(a, b)| u32::from(i >= a && i < b && j >= a && j < b))
                        .sum::<u32>(),
                ) * (1 + i * j) as f64
            };
            for i in 0..9 {
                let exact: f64 = (0..9).map(|j| entry(i, j) * x[j]).sum();
                assert_eq!(y[i], exact);
            }
        }
    }
}
