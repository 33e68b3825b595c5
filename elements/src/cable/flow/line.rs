//! A cable whose ends feed, as a whole: its boundaries, and how its nodes follow them.

use super::embedding::Embedding;
use ropewalk_core::{MovingBoundary, SpanFlow};

/// How one node follows the boundaries of its line: `p = fixed + Σ by_k π_k`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Follows {
    /// What doesn't move [m].
    pub fixed: f64,
    /// Share of each boundary.
    pub by: [f64; 2],
}

/// The material coordinates of a cable whose ends feed.
#[derive(Clone, Debug)]
pub struct Line {
    /// Its boundaries, with the end of the cable at which each is: 0 the start, 1 the end.
    pub boundaries: Vec<(usize, MovingBoundary)>,
    /// Its nodes.
    pub nodes: Vec<Follows>,
    /// Whether elements are born and swallowed at the ends, the rest staying on its material.
    pub zone: [bool; 2],
    /// How many elements at each end with a zone keep their lengths and go with the end: those that are born stand behind
    /// them.
    pub rides: [usize; 2],
    /// Where the middle of each element is, as a share of the line.
    pub middle: Vec<f64>,
    /// Whether what passes the ends is free of strain energy outside; else it takes along what it has inside.
    pub unstrained: [bool; 2],
    /// Whether the energy of twist goes along there.
    pub wound: [bool; 2],
    /// Twist with which cable with torsion comes in at the ends, per length [rad/m].
    pub twist: [f64; 2],
    /// What resists its turning about its own axis as it passes them: torque over spin [N m s].
    pub grip: [f64; 2],
}

impl Line {
    /// A line with these material coordinates at the nodes. Where an end has a zone, only its own node moves with its
    /// boundary, and the elements that ride with it; else the nodes between it and that where its section begins, `holds`, share the
    /// movement evenly.
    pub fn new(
        mesh: &[f64],
        boundaries: Vec<(usize, MovingBoundary)>,
        zone: [bool; 2],
        rides: [usize; 2],
        holds: [usize; 2],
    ) -> Self {
        let (first, last) = (mesh[0], mesh[mesh.len() - 1]);
        let end = mesh.len() - 1;
        let nodes = (0..mesh.len())
            .map(|i| {
                let (behind, before) = (mesh[holds[0]], mesh[holds[1]]);
                let share = [(mesh[i] - first) / (behind - first), (mesh[i] - before) / (last - before)];
                let mut node = Follows { fixed: 0.0, by: [0.0; 2] };
                let mut moved = 0.0;
                for (k, (at, boundary)) in boundaries.iter().enumerate() {
                    let own = if *at == 0 { 0 } else { end };
                    node.by[k] = match zone[*at] {
                        true if i.abs_diff(own) <= rides[*at] => 1.0,
                        true => 0.0,
                        false if *at == 0 => {
                            if i < holds[0] || holds[0] == end {
                                1.0 - share[0]
                            } else {
                                0.0
                            }
                        }
                        false => {
                            if i > holds[1] || holds[1] == 0 {
                                share[1]
                            } else {
                                0.0
                            }
                        }
                    };
                    // a node at an end that doesn't feed, or that has a zone, doesn't follow the other
                    if i != own && (i == 0 || i == end) {
                        node.by[k] = 0.0;
                    }
                    moved += node.by[k] * if *at == 0 { first } else { last };
                    debug_assert!(boundary.sign == if *at == 0 { -1.0 } else { 1.0 });
                }
                // what is a boundary's alone follows it to the last bit
                let alone = (i == 0 || i == end) && node.by[..boundaries.len()].contains(&1.0);
                node.fixed = if alone { 0.0 } else { mesh[i] - moved };
                node
            })
            .collect();
        let middle = mesh.windows(2).map(|w| (0.5 * (w[0] + w[1]) - first) / (last - first)).collect();
        Line {
            boundaries,
            nodes,
            zone,
            rides,
            middle,
            unstrained: [false; 2],
            wound: [false; 2],
            twist: [0.0; 2],
            grip: [0.0; 2],
        }
    }

    fn sum(&self, k: usize, fixed: f64, x: impl Fn(&MovingBoundary) -> f64) -> f64 {
        let by = &self.nodes[k].by;
        self.boundaries.iter().zip(by).fold(fixed, |p, ((_, f), by)| p + by * x(f))
    }
    /// Material coordinate of a node [m].
    pub fn p(&self, k: usize, q: &[f64]) -> f64 {
        self.sum(k, self.nodes[k].fixed, |f| q[f.q])
    }
    /// Its rate [m/s].
    pub fn rate(&self, k: usize, v: &[f64]) -> f64 {
        self.sum(k, 0.0, |f| v[f.v])
    }
    /// The element that grows and shrinks at an end with a zone, where others are born and swallowed.
    pub fn grows(&self, end: usize) -> usize {
        if end == 0 { self.rides[0] } else { self.nodes.len() - 2 - self.rides[1] }
    }
    /// The open end at the element behind node `k`: the end of the line, and the number of the boundary there.
    pub fn opens(&self, k: usize) -> impl Iterator<Item = (usize, usize)> + '_ {
        let last = self.nodes.len() - 2;
        let ends = self.boundaries.iter().enumerate().map(|(boundary, &(end, _))| (end, boundary));
        ends.filter(move |&(end, _)| k == if end == 0 { 0 } else { last } && !self.unstrained[end])
    }
    /// Whether material flows through the element behind node `k`.
    pub fn flows(&self, k: usize) -> bool {
        [k, k + 1].iter().any(|&i| self.nodes[i].by[..self.boundaries.len()].iter().any(|&b| b != 0.0))
    }
    /// Embedding of the element behind node `k`; `F` is the number of boundaries.
    pub fn embedding<const F: usize>(&self, k: usize) -> Embedding<F> {
        let (a, b) = (&self.nodes[k], &self.nodes[k + 1]);
        Embedding { fixed: [a.fixed, b.fixed], by: std::array::from_fn(|f| [a.by[f], b.by[f]]) }
    }
    /// By how much the section of the material at either end of the element behind node `k` is turned against that of the
    /// node, by what has been fed there.
    pub fn turns<const F: usize>(&self, k: usize) -> Embedding<F> {
        let mut turns = Embedding { fixed: [0.0; 2], by: [[0.0; 2]; F] };
        let boundaries = self.boundaries.iter().zip(&mut turns.by);
        for ((end, boundary), by) in boundaries.filter(|((end, _), _)| self.is_at(*end, k)) {
            by[*end] = self.twist[*end];
            turns.fixed[*end] = -self.twist[*end] * boundary.home;
        }
        turns
    }
    /// By how much the section of the material at both nodes is turned against those of the nodes [rad].
    pub fn turned_both(&self, k: usize, q: &[f64]) -> [f64; 2] {
        let mut turned = [0.0; 2];
        for (end, b) in self.boundaries.iter().filter(|(end, _)| self.is_at(*end, k)) {
            turned[*end] = self.twist[*end] * (q[b.q] - b.home);
        }
        turned
    }
    /// What that adds to the twist of the element [rad].
    pub fn turned(&self, k: usize, q: &[f64]) -> f64 {
        let [start, end] = self.turned_both(k, q);
        end - start
    }
    /// The ends of the element behind node `k` that are open ends of the line: 1, else 0.
    pub fn open(&self, k: usize) -> [f64; 2] {
        let mut open = [0.0; 2];
        self.opens(k).for_each(|(end, _)| open[end] = 1.0);
        open
    }
    /// The ends of it over which material takes the energy of its twist along: 1, else 0.
    pub fn winds(&self, k: usize) -> [f64; 2] {
        [0, 1].map(|end| if self.wound[end] && self.is_at(end, k) { 1.0 } else { 0.0 })
    }
    /// What resists the spin of the material at either end of it [N m s].
    pub fn grips(&self, k: usize) -> [f64; 2] {
        [0, 1].map(|end| {
            if self.boundaries.iter().any(|(at, _)| *at == end) && self.is_at(end, k) {
                self.grip[end]
            } else {
                0.0
            }
        })
    }
    /// Whether the element behind node `k` is the one at an end.
    fn is_at(&self, end: usize, k: usize) -> bool {
        k == if end == 0 { 0 } else { self.nodes.len() - 2 }
    }
    /// How the element behind node `k` stands on the material, for what touches it.
    pub fn span(&self, k: usize) -> SpanFlow {
        let (a, b) = (&self.nodes[k], &self.nodes[k + 1]);
        let mut flow = SpanFlow {
            boundaries: [(0, 0); 2],
            count: self.boundaries.len(),
            fixed: [a.fixed, b.fixed],
            by: std::array::from_fn(|f| [a.by[f], b.by[f]]),
        };
        for (place, (_, boundary)) in flow.boundaries.iter_mut().zip(&self.boundaries) {
            *place = (boundary.q, boundary.v);
        }
        flow
    }
    /// By how much the feeding of each boundary makes material run along the element behind node `k`.
    pub fn slip<const F: usize>(&self, k: usize) -> [f64; F] {
        let share = self.middle[k];
        std::array::from_fn(|f| match (F, self.boundaries[f].0) {
            (1, _) => 1.0,
            (_, 0) => 1.0 - share,
            _ => share,
        })
    }
}
