//! The sparse structure of the iteration matrix, by blocks, and the way of every clique into it.
//!
//! A block is a node with the rows of the constraints behind it. All rows of a block share one list of columns, so
//! that what an element adds goes in rectangles (tiles) instead of entry by entry, and along a chain every row is
//! one run of neighbours.

pub(crate) mod product;

use crate::algebra::scalar::Scalar;
use crate::model::node::Node;
use crate::model::order::{Order, Rows};
use crate::model::pattern::Pattern;
use std::ops::Range;

/// Rows that share their columns.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Block {
    /// Position of its first row.
    pub first: usize,
    /// Number of rows.
    pub size: usize,
    /// Storage of its first row.
    pub base: usize,
    /// Its columns in [`Structure::columns`].
    columns: Range<usize>,
    /// Its first column, if the columns follow each other without a gap.
    run: Option<usize>,
}

impl Block {
    /// Entries stored for each of its rows.
    pub fn width(&self) -> usize {
        self.columns.len()
    }
}

/// The columns of a row.
#[derive(Clone, Copy, Debug)]
pub enum Columns<'a> {
    /// From this one on, one after the other.
    From(usize),
    /// These.
    List(&'a [u32]),
}

impl Columns<'_> {
    /// The column of the entry number `k`.
    pub fn get(&self, k: usize) -> usize {
        match self {
            Columns::From(first) => first + k,
            Columns::List(list) => list[k] as usize,
        }
    }
}

/// A rectangle of a clique's square block: row `row + i`, column `column + j` of the clique go to storage
/// `at + i stride + j`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Tile {
    pub at: u32,
    pub stride: u32,
    pub row: u16,
    pub column: u16,
    pub rows: u16,
    pub columns: u16,
}

/// Unknowns `unknown..unknown + count` stand at `position..position + count`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Move {
    unknown: usize,
    position: usize,
    count: usize,
}

/// The sparse structure of the iteration matrix in elimination order, row by row.
///
/// Of a symmetric matrix the upper triangle counts. Its diagonal blocks are stored whole all the same; what stands
/// below the diagonal in them is never read.
#[derive(Clone, Debug)]
pub struct Structure {
    /// Number of unknowns: velocities and multipliers.
    pub n: usize,
    /// Only the upper triangle counts.
    pub symmetric: bool,
    /// Position of each unknown (velocities first, then multipliers) in the elimination order.
    pub position: Vec<usize>,
    /// For each position whether it is a multiplier.
    pub is_multiplier: Vec<bool>,
    /// Its rows, block by block.
    pub blocks: Vec<Block>,
    /// Storage of the diagonal entry of each unknown.
    pub diagonal: Vec<u32>,
    /// The same for each position.
    pub(crate) diagonal_at: Vec<u32>,
    /// Whether every block is coupled with the one before and the one behind it only, and with shared unknowns.
    pub chain: bool,
    /// How many shared unknowns stand behind a chain.
    pub border: usize,
    /// Runs of unknowns that follow each other in the elimination order too.
    moves: Vec<Move>,
    columns: Vec<u32>,
    entries: usize,
    tiles: Vec<Tile>,
    /// Where the tiles of each clique end.
    ends: Vec<u32>,
}

/// Largest block, and largest block with its successor, of what is solved as a chain; both with the shared unknowns.
pub(crate) const LARGEST: usize = 24;
const WIDEST: usize = 32;

impl Structure {
    /// `pattern` holds the cliques of terms and then one per constraint, whose unknowns are velocities followed by
    /// its rows (`nv + row`).
    pub(crate) fn new(nodes: &[Node], constraints: &[Rows], pattern: &Pattern, symmetric: bool) -> Self {
        let Order { position, starts, own } = Order::new(nodes, constraints, pattern);
        let n = position.len();
        let nv = nodes.iter().map(|n| n.kind.velocities()).sum::<usize>();
        let mut is_multiplier = vec![false; n];
        for &p in &position[nv..] {
            is_multiplier[p] = true;
        }
        let mut moves: Vec<Move> = Vec::new();
        for (unknown, &position) in position.iter().enumerate() {
            match moves.last_mut() {
                Some(m) if m.position + m.count == position => m.count += 1,
                _ => moves.push(Move { unknown, position, count: 1 }),
            }
        }
        let mut s = Structure {
            n,
            symmetric,
            position,
            is_multiplier,
            blocks: Vec::with_capacity(starts.len()),
            diagonal: Vec::new(),
            diagonal_at: Vec::new(),
            chain: false,
            border: 0,
            moves,
            columns: Vec::new(),
            entries: 0,
            tiles: Vec::new(),
            ends: Vec::with_capacity(pattern.len()),
        };
        s.add_blocks(&starts, own, pattern);
        for k in 0..pattern.len() {
            s.add_tiles(pattern.get(k));
        }
        s.diagonal_at = (0..n).map(|p| s.slot(p, p) as u32).collect();
        s.diagonal = s.position.iter().map(|&p| s.diagonal_at[p]).collect();
        s
    }

    fn add_blocks(&mut self, starts: &[usize], own: usize, pattern: &Pattern) {
        let mut block_of = vec![0; self.n];
        for (k, w) in starts.windows(2).enumerate() {
            block_of[w[0]..w[1]].fill(k);
        }
        let mut couplings: Vec<(u32, u32)> = Vec::new();
        let mut rows = Vec::new();
        for k in 0..pattern.len() {
            let columns = pattern.get(k).iter().map(|&d| self.position[d as usize]);
            rows.clear();
            rows.extend(columns.clone().map(|p| block_of[p]));
            rows.sort_unstable();
            rows.dedup();
            for &b in &rows {
                let below = |c: &usize| !self.symmetric || *c >= starts[b];
                couplings.extend(columns.clone().filter(below).map(|c| (b as u32, c as u32)));
            }
        }
        couplings.sort_unstable();
        couplings.dedup();

        let count = starts.len() - 1;
        let border = starts[own];
        // the whole window of each block: from the one before, or from its own start, to the end of the next; shared
        // unknowns are coupled with everything
        let window = |b: usize| match (b < own, self.symmetric) {
            (true, true) => starts[b]..starts[(b + 2).min(own)],
            (true, false) => starts[b.saturating_sub(1)]..starts[(b + 2).min(own)],
            (false, true) => starts[b]..self.n,
            (false, false) => 0..self.n,
        };
        let within =
            |&(b, c): &(u32, u32)| c as usize >= border || window(b as usize).contains(&(c as usize));
        let width = |b: usize| starts[(b + 2).min(own)] - starts[b] + self.n - border;
        self.chain = couplings.iter().all(within)
            && (0..own).all(|b| starts[b + 1] - starts[b] + self.n - border <= LARGEST)
            && (0..own).all(|b| width(b) <= WIDEST);
        self.border = if self.chain { self.n - border } else { 0 };
        let mut rest = couplings.iter().peekable();
        for b in 0..count {
            let begin = self.columns.len();
            if self.chain {
                self.columns.extend(window(b).map(|c| c as u32));
                if b < own {
                    self.columns.extend((border..self.n).map(|c| c as u32));
                }
            } else {
                while let Some(&(_, c)) = rest.next_if(|&&(row, _)| row as usize == b) {
                    self.columns.push(c);
                }
                self.columns.extend(starts[b] as u32..starts[b + 1] as u32);
                self.columns[begin..].sort_unstable();
                let mut kept = begin;
                for k in begin..self.columns.len() {
                    if k == begin || self.columns[k] != self.columns[k - 1] {
                        self.columns[kept] = self.columns[k];
                        kept += 1;
                    }
                }
                self.columns.truncate(kept);
            }
            let columns = &self.columns[begin..];
            let run = match (columns.first(), columns.last()) {
                (Some(&a), Some(&b)) if (b - a) as usize + 1 == columns.len() => Some(a as usize),
                _ => None,
            };
            let size = starts[b + 1] - starts[b];
            let columns = begin..self.columns.len();
            self.blocks.push(Block { first: starts[b], size, base: self.entries, columns, run });
            self.entries += size * (self.columns.len() - begin);
        }
    }

    /// The tiles of a clique: pairs of runs that are neighbours in the matrix.
    fn add_tiles(&mut self, clique: &[u32]) {
        let place = |d: u32| self.position[d as usize];
        // runs of the clique inside of one block
        let mut runs: Vec<(usize, usize, usize)> = Vec::new();
        for (k, &d) in clique.iter().enumerate() {
            let (p, block) = (place(d), self.block_of(place(d)));
            match runs.last_mut() {
                Some((b, from, count)) if *b == block && place(clique[*from]) + *count == p => *count += 1,
                _ => runs.push((block, k, 1)),
            }
        }
        for &(block, row, rows) in &runs {
            let b = &self.blocks[block];
            let inside = place(clique[row]) - b.first;
            let mut tiles: Vec<Tile> = Vec::new();
            for &(other, column, columns) in &runs {
                if self.symmetric && other < block {
                    continue;
                }
                // every clique was entered above, so the column is there
                let at = b.base + inside * b.width() + self.index_in(b, place(clique[column])).unwrap_or(0);
                match tiles.last_mut() {
                    Some(t)
                        if t.at as usize + t.columns as usize == at
                            && (t.column + t.columns) as usize == column =>
                    {
                        t.columns += columns as u16;
                    }
                    _ => tiles.push(Tile {
                        at: at as u32,
                        stride: b.width() as u32,
                        row: row as u16,
                        column: column as u16,
                        rows: rows as u16,
                        columns: columns as u16,
                    }),
                }
            }
            self.tiles.extend(tiles);
        }
        self.ends.push(self.tiles.len() as u32);
    }

    fn block_of(&self, position: usize) -> usize {
        self.blocks.partition_point(|b| b.first <= position) - 1
    }

    fn index_in(&self, b: &Block, column: usize) -> Option<usize> {
        self.columns[b.columns.clone()].binary_search(&(column as u32)).ok()
    }

    /// Brings a vector (velocities, then multipliers; or velocities alone) into elimination order.
    pub fn order<T: Copy>(&self, x: &[T], out: &mut [T]) {
        for m in self.moves.iter().take_while(|m| m.unknown < x.len()) {
            let count = m.count.min(x.len() - m.unknown);
            out[m.position..m.position + count].copy_from_slice(&x[m.unknown..m.unknown + count]);
        }
    }

    /// Brings a vector in elimination order back; `out` may hold velocities alone.
    pub fn restore<T: Copy>(&self, x: &[T], out: &mut [T]) {
        let len = out.len();
        for m in self.moves.iter().take_while(|m| m.unknown < len) {
            let count = m.count.min(len - m.unknown);
            out[m.unknown..m.unknown + count].copy_from_slice(&x[m.position..m.position + count]);
        }
    }

    /// Adds a vector in elimination order to velocities and to multipliers.
    pub(crate) fn add_restored(&self, x: &[f64], velocities: &mut [f64], multipliers: &mut [f64]) {
        let nv = velocities.len();
        for m in &self.moves {
            let own = m.count.min(nv.saturating_sub(m.unknown));
            let (x, begin) = (&x[m.position..m.position + m.count], m.unknown.min(nv));
            velocities[begin..begin + own].iter_mut().zip(x).for_each(|(v, x)| *v += x);
            let begin = (m.unknown + own).saturating_sub(nv);
            multipliers[begin..begin + m.count - own].iter_mut().zip(&x[own..]).for_each(|(l, x)| *l += x);
        }
    }

    /// Number of stored values.
    pub fn entries(&self) -> usize {
        self.entries
    }

    /// Where the entry of these positions is stored; it must be coupled.
    pub(crate) fn slot(&self, row: usize, column: usize) -> usize {
        let (row, column) = if self.symmetric && row > column { (column, row) } else { (row, column) };
        let b = &self.blocks[self.block_of(row)];
        let index = self.index_in(b, column);
        debug_assert!(index.is_some(), "no entry at {row}, {column}");
        b.base + (row - b.first) * b.width() + index.unwrap_or(0)
    }

    /// The entry of these positions; zero where nothing couples them.
    pub(crate) fn entry(&self, values: &[f64], row: usize, column: usize) -> f64 {
        let b = &self.blocks[self.block_of(row)];
        self.index_in(b, column).map_or(0.0, |k| values[b.base + (row - b.first) * b.width() + k])
    }

    /// The tiles of a clique.
    #[inline(always)]
    pub(crate) fn tiles(&self, clique: usize) -> &[Tile] {
        let begin = if clique == 0 { 0 } else { self.ends[clique - 1] };
        &self.tiles[begin as usize..self.ends[clique] as usize]
    }

    /// Adds the block of a constraint: `[H, Gᵀ; G, 0]` with `n` velocities and `m` multipliers, both matrices row by row.
    pub(crate) fn add_constraint(
        &self,
        clique: usize,
        [n, m]: [usize; 2],
        h: Option<&[f64]>,
        g: &[f64],
        values: &mut [f64],
    ) {
        for t in self.tiles(clique) {
            let (first, columns) = (t.column as usize, t.columns as usize);
            let own = first.min(n)..(first + columns).min(n);
            for i in 0..t.rows as usize {
                let row = t.row as usize + i;
                let to = &mut values[t.at as usize + i * t.stride as usize..][..columns];
                let (velocities, multipliers) = to.split_at_mut(own.len());
                if row >= n {
                    let g = &g[(row - n) * n..][own.clone()];
                    velocities.iter_mut().zip(g).for_each(|(to, g)| *to += g);
                    continue;
                }
                if let Some(h) = h {
                    let h = &h[row * n..][own.clone()];
                    velocities.iter_mut().zip(h).for_each(|(to, h)| *to += h);
                }
                let from = first.max(n) - n;
                for (k, to) in multipliers.iter_mut().enumerate() {
                    debug_assert!(from + k < m);
                    *to += g[(from + k) * n + row];
                }
            }
        }
    }

    /// Every row: its position, its columns, and where its values are stored. Of symmetric matrices from the diagonal
    /// on.
    pub fn rows(&self) -> impl Iterator<Item = (usize, Columns<'_>, Range<usize>)> + '_ {
        self.blocks.iter().flat_map(move |b| (0..b.size).map(move |i| self.row(b, i)))
    }

    /// The same for row number `i` of a block.
    #[inline(always)]
    pub(crate) fn row(&self, b: &Block, i: usize) -> (usize, Columns<'_>, Range<usize>) {
        let skip = if self.symmetric { i } else { 0 };
        let columns = match b.run {
            Some(first) => Columns::From(first + skip),
            None => Columns::List(&self.columns[b.columns.start + skip..b.columns.end]),
        };
        let at = b.base + i * b.width();
        (b.first + i, columns, at + skip..at + b.width())
    }

    /// The columns of a block's rows, all that are stored.
    pub(crate) fn columns_of(&self, b: &Block) -> &[u32] {
        &self.columns[b.columns.clone()]
    }

    /// Sum of the absolute values in one row.
    pub(crate) fn row_sum<T: Scalar>(&self, values: &[T], row: usize) -> f64 {
        let own = self.block_of(row);
        let begin = match (self.symmetric, self.chain) {
            (false, _) => own,
            (true, true) => own.saturating_sub(1),
            (true, false) => 0,
        };
        let mut sum = 0.0;
        for block in &self.blocks[begin..=own] {
            for (r, columns, at) in (0..block.size).map(|i| self.row(block, i)) {
                if r == row {
                    sum += values[at].iter().map(|v| v.size()).sum::<f64>();
                } else if self.symmetric && r < row {
                    let k = match columns {
                        Columns::From(first) => (row - first < at.len()).then_some(row - first),
                        Columns::List(list) => list.binary_search(&(row as u32)).ok(),
                    };
                    sum += k.map_or(0.0, |k| values[at.start + k].size());
                }
            }
        }
        sum
    }
}

#[cfg(test)]
mod tests;
