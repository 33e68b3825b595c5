//! The order in which nodes are eliminated, and which unknowns are eliminated together.
//!
//! Nodes are taken along the chain where they form one, else in the order in which they were made or in an
//! approximate minimum degree order of the *nodes*, whichever fills in less. Shared nodes come last.
//!
//! Rows of constraints follow nodes that they hold, which keeps elimination without pivoting stable: their pivot is
//! `-G A⁻¹ Gᵀ` of what is eliminated by then, and that must not vanish. Behind the last node that they touch it never
//! does. But the rows of all lines of a buoy would follow the buoy, and the factors of that large dense block would grow
//! with the square of the number of lines. So off chains a constraint follows the first node that it holds well, by the
//! Jacobian at the start: then a line goes together with its joint, as if the other side were at rest.

use crate::model::node::{Node, NodeId};
use crate::model::pattern::Pattern;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::SymbolicSparseColMatRef;
use faer::sparse::linalg::amd;

/// The rows of one constraint, the nodes that they touch, and the Jacobian by their velocities, row by row, where the
/// model starts; empty where it isn't known.
#[derive(Clone, Debug)]
pub(crate) struct Rows {
    pub count: usize,
    pub nodes: Vec<NodeId>,
    pub jacobian: Vec<f64>,
    /// Nodes behind which the rows can be eliminated, if that isn't judged by the Jacobian.
    pub behind: Vec<NodeId>,
}

/// How well a node has to be held for rows to follow it before others that they touch: the least that is left of each
/// row besides the other rows, and of its displacement beside those of the other nodes.
const HOLDS: f64 = 0.1;

/// An elimination order.
pub(crate) struct Order {
    /// Position of each unknown: velocities first, then multipliers.
    pub position: Vec<usize>,
    /// First position of each block, a node with the constraint rows behind it, and one past the last.
    pub starts: Vec<usize>,
    /// How many of the blocks are nodes of their own; those of shared nodes follow.
    pub own: usize,
}

impl Order {
    pub fn new(nodes: &[Node], constraints: &[Rows], pattern: &Pattern) -> Self {
        let nv = nodes.iter().map(|n| n.kind.velocities()).sum::<usize>();
        let graph = node_graph(nodes, constraints, pattern, nv);
        let natural: Vec<usize> = shared_last(nodes, (0..nodes.len()).collect());
        if is_chain(nodes, &graph, &natural) {
            positions(nodes, constraints, &natural, last(constraints, &natural), nv)
        } else if let Some(path) = path(nodes, &graph) {
            let order = shared_last(nodes, path);
            positions(nodes, constraints, &order, last(constraints, &order), nv)
        } else {
            let degree = shared_last(nodes, minimum_degree(&graph));
            let order = if fill(&graph, &degree) < fill(&graph, &natural) { degree } else { natural };
            positions(nodes, constraints, &order, first_held(nodes, constraints, &order), nv)
        }
    }
}

fn node_graph(nodes: &[Node], constraints: &[Rows], pattern: &Pattern, nv: usize) -> Vec<Vec<u32>> {
    let mut node_of = vec![0; nv];
    for (k, n) in nodes.iter().enumerate() {
        node_of[n.dofs()].fill(k as u32);
    }
    let mut graph: Vec<Vec<u32>> = vec![Vec::new(); nodes.len()];
    let mut join = |members: &mut Vec<u32>| {
        members.sort_unstable();
        members.dedup();
        for &a in members.iter() {
            graph[a as usize].extend(members.iter().filter(|&&b| b != a));
        }
    };
    for k in 0..pattern.len() {
        let own = pattern.get(k).iter().filter(|&&d| (d as usize) < nv);
        join(&mut own.map(|&d| node_of[d as usize]).collect());
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

/// Whether each node is coupled with no other than the one before and the one behind it, and with shared ones.
fn is_chain(nodes: &[Node], graph: &[Vec<u32>], order: &[usize]) -> bool {
    let place = places(order);
    let neighbours = |a: usize, b: usize| nodes[b].shared || place[a].abs_diff(place[b]) <= 1;
    (0..nodes.len())
        .filter(|&a| !nodes[a].shared)
        .all(|a| graph[a].iter().all(|&b| neighbours(a, b as usize)))
}

/// Walks along every path of the graph from one of its ends, then over the shared nodes; `None` if there are branches
/// or rings.
fn path(nodes: &[Node], graph: &[Vec<u32>]) -> Option<Vec<usize>> {
    let others = |k: usize| graph[k].iter().map(|&b| b as usize).filter(|&b| !nodes[b].shared);
    let mut order = Vec::with_capacity(graph.len());
    let mut seen: Vec<bool> = nodes.iter().map(|n| n.shared).collect();
    for end in (0..graph.len()).filter(|&k| others(k).count() <= 1) {
        let mut next = (!seen[end]).then_some(end);
        while let Some(k) = next {
            seen[k] = true;
            order.push(k);
            next = others(k).find(|&b| !seen[b]);
        }
    }
    order.extend((0..nodes.len()).filter(|&k| nodes[k].shared));
    (order.len() == nodes.len() && is_chain(nodes, graph, &order)).then_some(order)
}

fn places(order: &[usize]) -> Vec<usize> {
    let mut place = vec![0; order.len()];
    for (p, &k) in order.iter().enumerate() {
        place[k] = p;
    }
    place
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
    let place = places(order);
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

/// For each constraint the place of the last node that it touches, or of the last that it says it can follow.
fn last(constraints: &[Rows], order: &[usize]) -> Vec<usize> {
    let place = places(order);
    // a constraint between fixed things only is refused by the model; its place doesn't matter
    let of = |nodes: &[NodeId]| nodes.iter().map(|k| place[k.0 as usize]).max();
    let last = |c: &Rows| of(&c.behind).or_else(|| of(&c.nodes));
    constraints.iter().map(|c| last(c).unwrap_or(order.len().saturating_sub(1))).collect()
}

/// For each constraint the place of the first node that it holds well, together with the constraints that follow that
/// node already; or of the last.
fn first_held(nodes: &[Node], constraints: &[Rows], order: &[usize]) -> Vec<usize> {
    let last = last(constraints, order);
    let mut touching: Vec<Vec<usize>> = vec![Vec::new(); nodes.len()];
    for (c, rows) in constraints.iter().enumerate() {
        for k in &rows.nodes {
            touching[k.0 as usize].push(c);
        }
    }
    let mut follows: Vec<Option<usize>> = vec![None; constraints.len()];
    for (p, &k) in order.iter().enumerate() {
        let mut held: Vec<Vec<f64>> = Vec::new();
        // those that can't wait come first
        let (now, later): (Vec<usize>, Vec<usize>) =
            touching[k].iter().filter(|&&c| follows[c].is_none()).partition(|&&c| last[c] == p);
        for c in now {
            follows[c] = Some(p);
            for row in constraints[c].of_node(nodes, k) {
                hold(&mut held, row);
            }
        }
        for c in later {
            let before = held.len();
            let rows = constraints[c].of_node(nodes, k);
            let well = !rows.is_empty()
                && constraints[c].behind.is_empty()
                && constraints[c].moves_well(nodes, k)
                && rows.into_iter().all(|row| hold(&mut held, row));
            if well {
                follows[c] = Some(p);
            } else {
                held.truncate(before);
            }
        }
    }
    follows.iter().zip(last).map(|(f, last)| f.unwrap_or(last)).collect()
}

/// Adds a row to an orthonormal basis, unless too little of it is left besides that.
fn hold(basis: &mut Vec<Vec<f64>>, mut row: Vec<f64>) -> bool {
    let norm = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
    let before = norm(&row);
    for b in basis.iter() {
        let along: f64 = b.iter().zip(&row).map(|(b, x)| b * x).sum();
        row.iter_mut().zip(b).for_each(|(x, b)| *x -= along * b);
    }
    let left = norm(&row);
    // a row that is zero or NaN holds nothing
    let well = left > HOLDS * before;
    if well {
        row.iter_mut().for_each(|x| *x /= left);
        basis.push(row);
    }
    well
}

impl Rows {
    /// The Jacobian by the velocities of one node, row by row.
    fn of_node(&self, nodes: &[Node], node: usize) -> Vec<Vec<f64>> {
        let sizes = || self.nodes.iter().map(|k| (k.0 as usize, nodes[k.0 as usize].kind.velocities()));
        let n = sizes().map(|(_, size)| size).sum::<usize>().max(1);
        let before: usize = sizes().take_while(|&(k, _)| k != node).map(|(_, size)| size).sum();
        let size = nodes[node].kind.velocities();
        self.jacobian.chunks_exact(n).map(|row| row[before..before + size].to_vec()).collect()
    }

    /// Whether each row feels this node about as much as any other: compared by how their points move, so that lever
    /// arms don't count.
    fn moves_well(&self, nodes: &[Node], node: usize) -> bool {
        let norm = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
        let felt = |k: usize| -> Vec<f64> {
            let rows = self.of_node(nodes, k).into_iter();
            rows.map(|row| match norm(&row[..row.len().min(3)]) {
                0.0 => norm(&row),
                point => point,
            })
            .collect()
        };
        let own = felt(node);
        self.nodes
            .iter()
            .all(|k| felt(k.0 as usize).iter().zip(&own).all(|(other, own)| *own >= HOLDS * other))
    }
}

fn positions(nodes: &[Node], constraints: &[Rows], order: &[usize], follows: Vec<usize>, nv: usize) -> Order {
    let n = nv + constraints.iter().map(|c| c.count).sum::<usize>();
    let mut behind: Vec<Vec<usize>> = vec![Vec::new(); nodes.len()];
    let mut row = nv;
    for (c, place) in constraints.iter().zip(follows) {
        if let Some(behind) = behind.get_mut(place) {
            behind.extend(row..row + c.count);
        }
        row += c.count;
    }
    let mut position = vec![usize::MAX; n];
    let (mut next, mut starts) = (0, vec![0]);
    for (p, &k) in order.iter().enumerate() {
        for d in nodes[k].dofs().chain(behind[p].iter().copied()) {
            position[d] = next;
            next += 1;
        }
        starts.push(next);
    }
    Order { position, starts, own: nodes.iter().filter(|n| !n.shared).count() }
}
