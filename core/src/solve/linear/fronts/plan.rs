//! Which fronts there are, and what goes where: all that depends on the structure alone.

use super::dense::COLUMNS;
use crate::model::structure::{Block, Structure};
use std::ops::Range;

/// Blocks are eliminated together, where that costs nothing, up to so many unknowns.
const MOST_OWN: usize = 32;

/// One front.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Front {
    /// How many unknowns it eliminates, and how many the fronts before it.
    pub own: usize,
    pub first: usize,
    /// Its unknowns in [`Plan::unknowns`]: its own first.
    at: usize,
    all: usize,
    /// How many it passes on, rounded up, and the length of its rows of `U`.
    pub wide: usize,
    pub stride: usize,
    /// Where its factors begin, and what it passes on.
    at_factors: usize,
    at_passed: usize,
    /// Distance from the root of its tree.
    pub depth: usize,
    /// Ranges of [`Plan::rows`], [`Plan::columns`], [`Plan::children`] and [`Plan::moves`].
    pub rows: (usize, usize),
    pub columns: (usize, usize),
    pub children: (usize, usize),
    pub moves: (usize, usize),
}

impl Front {
    pub fn unknowns(&self) -> Range<usize> {
        self.at..self.at + self.all
    }
    pub fn factors(&self) -> Range<usize> {
        self.at_factors..self.at_factors + self.own * self.stride
    }
    pub fn passed(&self) -> Range<usize> {
        self.at_passed..self.at_passed + self.wide * self.wide
    }
}

/// A rectangle of the matrix, and where it goes in the front's rows or columns.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rectangle {
    pub at: u32,
    pub stride: u32,
    pub rows: u32,
    pub columns: u32,
    pub to: u32,
}

/// Unknowns `from..from + count` of what a front passes on are `to..to + count` of its parent.
#[derive(Clone, Copy, Debug)]
pub(super) struct Move {
    pub from: u32,
    pub to: u32,
    pub count: u32,
}

/// Fronts in the order in which they are eliminated: each after its children, and with little in between.
#[derive(Debug, Default)]
pub(super) struct Plan {
    pub symmetric: bool,
    pub fronts: Vec<Front>,
    pub unknowns: Vec<u32>,
    /// Entries in a front's own rows, and of unsymmetric matrices those below them in its own columns.
    pub rows: Vec<Rectangle>,
    pub columns: Vec<Rectangle>,
    pub children: Vec<u32>,
    pub moves: Vec<Move>,
    /// Sizes of the factors, of what waits to be summed up at even and odd depths, and of the largest front.
    pub factors: usize,
    pub passed: [usize; 2],
    pub widest: usize,
}

/// Blocks that are eliminated together, and the unknowns that they are coupled with by then.
#[derive(Default)]
struct Group {
    blocks: Vec<usize>,
    own: usize,
    others: Vec<u32>,
    children: Vec<usize>,
}

impl Plan {
    /// `None` where the factors would be too large.
    pub fn new(s: &Structure) -> Option<Self> {
        let (groups, roots) = groups(s);
        let mut plan = Plan { symmetric: s.symmetric, ..Plan::default() };
        let mut number = vec![0; groups.len()];
        // depth first, children before parents; what is passed on lies on one of two stacks
        let mut top = [0, 0];
        for root in roots {
            let mut path = vec![(root, 0)];
            while let Some((group, next)) = path.last_mut() {
                if let Some(&child) = groups[*group].children.get(*next) {
                    *next += 1;
                    path.push((child, 0));
                    continue;
                }
                let (group, depth) = (*group, path.len() - 1);
                number[group] = plan.fronts.len();
                let children: Vec<u32> = groups[group].children.iter().map(|&c| number[c] as u32).collect();
                if let Some(&first) = children.first() {
                    top[1 - depth % 2] = plan.fronts[first as usize].at_passed;
                }
                plan.add(s, &groups[group], &children, depth, &mut top[depth % 2]);
                path.pop();
            }
        }
        let fits = |n: usize| u32::try_from(n).is_ok();
        if !fits(plan.factors) || !plan.passed.into_iter().all(fits) {
            return None;
        }
        plan.find_entries(s, &groups, &number);
        Some(plan)
    }

    /// Adds a front whose children are there.
    fn add(&mut self, s: &Structure, group: &Group, children: &[u32], depth: usize, top: &mut usize) {
        let at = self.unknowns.len();
        let own = group.blocks.iter().flat_map(|&b| range(&s.blocks[b]));
        self.unknowns.extend(own.map(|p| p as u32).chain(group.others.iter().copied()));
        let wide = group.others.len().next_multiple_of(COLUMNS);
        let front = Front {
            own: group.own,
            first: self.fronts.last().map_or(0, |f| f.first + f.own),
            at,
            all: self.unknowns.len() - at,
            wide,
            stride: group.own + wide,
            at_factors: self.factors,
            at_passed: *top,
            depth,
            children: (self.children.len(), self.children.len() + children.len()),
            ..Front::default()
        };
        self.children.extend_from_slice(children);
        self.factors += front.own * front.stride;
        *top += wide * wide;
        self.passed[depth % 2] = self.passed[depth % 2].max(*top);
        self.widest = self.widest.max(front.all);
        for &c in children {
            let begin = self.moves.len();
            let child = self.fronts[c as usize];
            let passed = &self.unknowns[child.at + child.own..child.at + child.all];
            let mine = &self.unknowns[at..];
            let mut place = 0;
            for (from, unknown) in passed.iter().enumerate() {
                // both ascend, and what a child passes on is there
                place += mine[place..].partition_point(|u| u < unknown);
                match self.moves[begin..].last_mut() {
                    Some(m) if (m.to + m.count) as usize == place && place != front.own => m.count += 1,
                    _ => self.moves.push(Move { from: from as u32, to: place as u32, count: 1 }),
                }
            }
            self.fronts[c as usize].moves = (begin, self.moves.len());
        }
        self.fronts.push(front);
    }

    /// Where the entries of the matrix go.
    fn find_entries(&mut self, s: &Structure, groups: &[Group], number: &[usize]) {
        let mut front_of = vec![0; s.n];
        for (group, &front) in groups.iter().zip(number) {
            for &b in &group.blocks {
                front_of[range(&s.blocks[b])].fill(front);
            }
        }
        // blocks with entries below each front
        let mut below: Vec<(usize, usize)> = Vec::new();
        for (k, b) in s.blocks.iter().enumerate().filter(|_| !s.symmetric) {
            let fronts = s.columns_of(b).iter().map(|&c| front_of[c as usize]);
            below.extend(fronts.filter(|&f| f < front_of[b.first]).map(|f| (f, k)));
        }
        below.sort_unstable();
        below.dedup();
        let mut below = below.into_iter().peekable();

        let mut groups_in_order: Vec<usize> = (0..groups.len()).collect();
        groups_in_order.sort_unstable_by_key(|&g| number[g]);
        let mut local: Vec<(usize, usize)> = vec![(usize::MAX, 0); s.n];
        for (k, g) in groups_in_order.into_iter().enumerate() {
            let f = self.fronts[k];
            for (i, &u) in self.unknowns[f.unknowns()].iter().enumerate() {
                local[u as usize] = (k, i);
            }
            let place = |c: &u32| Some(local[*c as usize]).filter(|l| l.0 == k).map(|l| l.1);
            let begin = self.rows.len();
            for b in groups[g].blocks.iter().map(|&b| &s.blocks[b]) {
                let row = local[b.first].1;
                for run in runs(s.columns_of(b).iter().map(place)) {
                    self.rows.push(Rectangle {
                        at: (b.base + run.from) as u32,
                        stride: b.width() as u32,
                        rows: b.size as u32,
                        columns: run.count as u32,
                        to: (row * f.stride + run.to) as u32,
                    });
                }
            }
            self.fronts[k].rows = (begin, self.rows.len());
            let begin = self.columns.len();
            while let Some((_, b)) = below.next_if(|&(front, _)| front == k) {
                let (b, all) = (&s.blocks[b], s.columns_of(&s.blocks[b]));
                // of the columns of a hub few are this front's
                let own = &self.unknowns[f.at..f.at + f.own];
                let skip = all.partition_point(|c| own.first().is_some_and(|first| c < first));
                let mine = all[skip..].iter().take_while(|c| own.last().is_some_and(|last| *c <= last));
                let columns = runs(mine.map(|c| place(c).filter(|&i| i < f.own)));
                let own_rows: Vec<u32> = range(b).map(|r| r as u32).collect();
                for rows in runs(own_rows.iter().map(place)) {
                    for run in &columns {
                        self.columns.push(Rectangle {
                            at: (b.base + rows.from * b.width() + skip + run.from) as u32,
                            stride: b.width() as u32,
                            rows: rows.count as u32,
                            columns: run.count as u32,
                            to: (run.to * f.stride + rows.to) as u32,
                        });
                    }
                }
            }
            self.fronts[k].columns = (begin, self.columns.len());
        }
    }
}

/// The elimination tree of the blocks: its groups, and which of them are roots.
fn groups(s: &Structure) -> (Vec<Group>, Vec<usize>) {
    let mut block_of = vec![0; s.n];
    for (k, b) in s.blocks.iter().enumerate() {
        block_of[range(b)].fill(k);
    }
    let mut groups: Vec<Group> = Vec::new();
    let (mut waiting, mut roots) = (vec![Vec::new(); s.blocks.len()], Vec::new());
    for (k, b) in s.blocks.iter().enumerate() {
        let behind = b.first + b.size;
        let mut others: Vec<u32> =
            s.columns_of(b).iter().copied().filter(|&c| c as usize >= behind).collect();
        let mut children: Vec<usize> = std::mem::take(&mut waiting[k]);
        for &c in &children {
            others.extend(groups[c].others.iter().filter(|&&u| u as usize >= behind));
        }
        others.sort_unstable();
        others.dedup();
        // one whose unknowns are all here may as well be eliminated here
        let whole = |&c: &usize| {
            groups[c].others.len() == b.size + others.len() && groups[c].own + b.size <= MOST_OWN
        };
        let mut group = Group { blocks: vec![k], own: b.size, ..Group::default() };
        let mut at = groups.len();
        if let Some(place) = children.iter().rposition(whole) {
            at = children.remove(place);
            let child = std::mem::take(&mut groups[at]);
            children.extend(child.children);
            group.blocks = child.blocks;
            group.blocks.push(k);
            group.own += child.own;
        }
        match others.first() {
            Some(&parent) => waiting[block_of[parent as usize]].push(at),
            None => roots.push(at),
        }
        (group.others, group.children) = (others, children);
        if at == groups.len() {
            groups.push(group);
        } else {
            groups[at] = group;
        }
    }
    (groups, roots)
}

fn range(b: &Block) -> Range<usize> {
    b.first..b.first + b.size
}

struct Run {
    from: usize,
    to: usize,
    count: usize,
}

/// Runs of neighbours among places, of which some are none.
fn runs(places: impl Iterator<Item = Option<usize>>) -> Vec<Run> {
    let mut all: Vec<Run> = Vec::new();
    for (from, to) in places.enumerate() {
        let Some(to) = to else { continue };
        match all.last_mut() {
            Some(r) if r.from + r.count == from && r.to + r.count == to => r.count += 1,
            _ => all.push(Run { from, to, count: 1 }),
        }
    }
    all
}
