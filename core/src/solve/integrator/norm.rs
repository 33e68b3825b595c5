//! What counts as large: a norm for each part, of which the largest counts.
//!
//! A part (a cable, a chain of links, a body) is judged by itself and relative to its own length, so that nothing that it
//! isn't coupled with changes its accuracy: neither a heavy ship nor a long tether nearby. Along a cable the norm is the
//! root mean square over its length, over the links of a chain that over their masses; rotations of a body count by what
//! they move at its radius of gyration, relative to the body's own size. A point mass has no size: it takes that of
//! what it is joined to.

use crate::model::Model;
use crate::model::node::{Node, NodeKind};
use crate::model::structure::Structure;
use std::ops::Range;

/// A part as norms see it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Group {
    /// Its name in messages.
    pub name: String,
    /// What its positions are relative to [m].
    pub length: f64,
    /// Its size, which its rotations are relative to [m].
    pub size: f64,
    /// Its mass [kg].
    pub mass: f64,
    /// Whether it is a single node: a body, and no chain or cable.
    pub single: bool,
    /// Rounding of its coordinates where it starts, relative to its length.
    pub rounding: f64,
}

/// Speeds in a part [m/s].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Speeds {
    /// Their root mean square over its length.
    pub mean: f64,
    /// That of its fastest node, and which this is.
    pub most: f64,
    pub node: usize,
    /// What all of its nodes weigh.
    weight: f64,
}

/// Norms of increments and of forces, part by part.
#[derive(Clone, Debug, Default)]
pub(crate) struct Norms {
    pub groups: Vec<Group>,
    /// The group of each velocity.
    of: Vec<u32>,
    /// What the square of each velocity or increment weighs [1/m², or 1 for rotations].
    weight: Vec<f64>,
    /// Velocities of one group that follow each other, group by group.
    runs: Vec<(usize, Range<usize>)>,
    /// The same in elimination order, with no weight for multipliers.
    weight_ordered: Vec<f64>,
    runs_ordered: Vec<(usize, Range<usize>)>,
    /// What turns each equation of motion into a force: 1 for positions, one over an arm for slopes and rotations.
    pub arm: Vec<f64>,
    /// What turns an acceleration into a force: the lumped mass of a position [kg], the inertia of a rotation over its arm
    /// [kg m]; nothing for slopes and plain numbers.
    pub mass: Vec<f64>,
    /// For each velocity the square that `dᵀ M d` weighs of it: 1/(m L²).
    energy: Vec<f64>,
}

/// Share of an element's length that the inertia of its slope stands for: `ρA l³ 4/420` beside `ρA l/2` (Hermite).
const SLOPE: f64 = 4.0 / 420.0;

impl Norms {
    /// Norms of a model with this lumped mass: translations weigh what they move, everything else its diagonal entry.
    pub fn new(model: &Model, mass: &[f64]) -> Self {
        let (nodes, nv) = (model.nodes(), model.velocities());
        let owner = owners(model);
        let count = owner.iter().map(|&g| g + 1).max().unwrap_or(0);
        // a part has its own length; what else there is gets one from what it is joined to
        let own = |g: usize| model.parts().get(g).map_or(0.0, |part| part.length());
        let sizes: Vec<f64> = (0..count).map(own).collect();
        let groups: Vec<Group> = (0..count).map(|g| Group::new(model, &owner, &sizes, g, mass)).collect();

        let mut norms =
            Norms { of: vec![0; nv], weight: vec![0.0; nv], arm: vec![1.0; nv], ..Norms::default() };
        (norms.energy, norms.mass) = (vec![0.0; nv], vec![0.0; nv]);
        for (k, n) in nodes.iter().enumerate() {
            let g = &groups[owner[k]];
            let dofs = n.dofs();
            let translation = mass[dofs.start];
            let per = if g.mass > 0.0 { 1.0 / g.mass } else { 0.0 };
            // a body without inertia about one axis is no lever of no length
            let most = mass[dofs.clone()].iter().skip(3).fold(0.0, |m: f64, x| m.max(*x));
            for (i, dof) in dofs.enumerate() {
                let turns = n.kind == NodeKind::Frame && i >= 3;
                let length = if turns { g.size } else { g.length };
                norms.of[dof] = owner[k] as u32;
                norms.weight[dof] = mass[dof] * per / length.powi(2);
                norms.energy[dof] = per / length.powi(2);
                if i >= 3 && most > 0.0 {
                    let inertia = if turns { most } else { mass[dof] };
                    norms.arm[dof] = (translation / inertia).sqrt();
                }
                if turns || i < 3 && n.kind.has_position() {
                    norms.mass[dof] = mass[dof] * norms.arm[dof];
                }
            }
        }
        for (p, part) in model.parts().iter().enumerate() {
            norms.spread(part.mesh(), &part.seats(), groups.get(p).map_or(1.0, |g| g.length));
        }
        norms.groups = groups;
        norms.runs = runs(&norms.of);
        norms
    }

    /// Gives the nodes of a cable the weights of its length, whatever masses hang on it.
    fn spread(&mut self, mesh: &[f64], seats: &[(usize, usize)], length: f64) {
        let (Some(first), Some(last)) = (mesh.first(), mesh.last()) else { return };
        if mesh.len() != seats.len() || !(last > first) {
            return;
        }
        let whole = (last - first) * length.powi(2);
        for (k, &(_, v)) in seats.iter().enumerate() {
            let sides = [k.checked_sub(1).map(|j| mesh[k] - mesh[j]), mesh.get(k + 1).map(|s| s - mesh[k])];
            let [half, cube] =
                sides.iter().flatten().fold([0.0; 2], |s, l| [s[0] + 0.5 * l, s[1] + l.powi(3)]);
            let arm = (half / (SLOPE * cube)).sqrt();
            for i in v..v + 3 {
                self.weight[i] = half / whole;
                self.weight[i + 3] = SLOPE * cube / whole;
                self.arm[i + 3] = arm;
            }
        }
    }

    /// Prepares norms of vectors in elimination order.
    pub fn order(&mut self, s: &Structure) {
        self.weight_ordered = vec![0.0; s.n];
        s.order(&self.weight, &mut self.weight_ordered);
        let mut of = vec![u32::MAX; s.n];
        for (g, &p) in self.of.iter().zip(&s.position) {
            of[p] = *g;
        }
        // multipliers weigh nothing and may stand in any run
        for p in 1..s.n {
            if of[p] == u32::MAX {
                of[p] = of[p - 1];
            }
        }
        if let Some(&known) = of.iter().find(|g| **g != u32::MAX) {
            of.iter_mut().take_while(|g| **g == u32::MAX).for_each(|g| *g = known);
        }
        self.runs_ordered = runs(&of);
    }

    /// Size of an increment relative to the part that it moves most.
    pub fn relative(&self, d: &[f64]) -> f64 {
        largest(&self.runs, |run| weighted_square(&self.weight[run.clone()], &d[run.clone()])).1
    }

    /// The length of the part that has this velocity [m].
    pub fn length_of(&self, v: usize) -> f64 {
        self.groups[self.of[v] as usize].length
    }

    /// The same of a vector that is nowhere stored.
    pub fn relative_of(&self, d: impl Fn(usize) -> f64) -> f64 {
        let square = |run: &Range<usize>| run.clone().map(|i| self.weight[i] * d(i).powi(2)).sum();
        largest(&self.runs, square).1
    }

    /// The same with the part.
    pub fn worst(&self, d: &[f64]) -> (usize, f64) {
        largest(&self.runs, |run| weighted_square(&self.weight[run.clone()], &d[run.clone()]))
    }

    /// The same of a solution in elimination order.
    pub fn relative_ordered(&self, x: &[f64]) -> f64 {
        largest(&self.runs_ordered, |run| weighted_square(&self.weight_ordered[run.clone()], &x[run.clone()]))
            .1
    }

    /// The same of an increment `d` by `dᵀ M d`, with the product `md` in the order of velocities.
    pub fn relative_with(&self, d: &[f64], md: impl Fn(usize) -> f64) -> f64 {
        let square = |run: &Range<usize>| run.clone().map(|i| self.energy[i] * d[i] * md(i)).sum();
        largest(&self.runs, square).1
    }

    /// `Σ (s x)²` over each group.
    pub fn squares(&self, s: &[f64], x: &[f64], out: &mut Vec<f64>) {
        out.clear();
        out.resize(self.groups.len(), 0.0);
        for (g, run) in &self.runs {
            out[*g] += scaled_square(&s[run.clone()], &x[run.clone()]);
        }
    }

    /// Sums over each group of what a function gives for each velocity.
    pub fn sums(&self, of: impl Fn(usize) -> f64, out: &mut Vec<f64>) {
        out.clear();
        out.resize(self.groups.len(), 0.0);
        for (g, run) in &self.runs {
            out[*g] += run.clone().map(&of).sum::<f64>();
        }
    }

    /// How fast each cable or chain moves.
    pub fn speeds(&self, nodes: &[Node], v: &[f64], out: &mut Vec<Speeds>) {
        let lines = || {
            let nodes = nodes.iter().enumerate().filter(|(_, n)| n.kind.has_position());
            nodes.map(|(k, n)| (self.of(n.v), k, n.v)).filter(|(g, ..)| !self.groups[*g].single)
        };
        out.clear();
        if self.groups.iter().all(|g| g.single) {
            return;
        }
        out.resize(self.groups.len(), Speeds::default());
        for (g, node, i) in lines() {
            let (part, w) = (&mut out[g], self.weight[i]);
            let square: f64 = v[i..i + 3].iter().map(|v| v * v).sum();
            part.weight += w;
            part.mean += w * square;
            if square > part.most {
                (part.most, part.node) = (square, node);
            }
        }
        for part in out {
            (part.mean, part.most) = ((part.mean / part.weight).sqrt(), part.most.sqrt());
        }
    }

    /// The group of a velocity.
    pub fn of(&self, dof: usize) -> usize {
        self.of[dof] as usize
    }

    /// What the square of a velocity weighs.
    pub fn weights(&self) -> &[f64] {
        &self.weight
    }

    /// Rounding of positions, relative to the part where it is largest.
    pub fn rounding(&self) -> f64 {
        self.groups.iter().fold(0.0, |m, g| g.rounding.max(m))
    }
}

/// The group of each node: the number of its part; nodes of no part are groups of their own.
fn owners(model: &Model) -> Vec<usize> {
    let nodes = model.nodes();
    let mut owner = vec![usize::MAX; nodes.len()];
    for (p, part) in model.parts().iter().enumerate() {
        for (_, v) in part.seats() {
            if let Ok(k) = nodes.binary_search_by_key(&v, |n| n.v) {
                owner[k] = p;
            }
        }
    }
    let mut next = model.parts().len();
    for (k, owner) in owner.iter_mut().enumerate().filter(|(_, o)| **o == usize::MAX) {
        let id = crate::model::node::NodeId(k as u32);
        *owner = match model.parts().iter().position(|p| p.place_of(id).is_some()) {
            Some(p) => p,
            None => {
                next += 1;
                next - 1
            }
        };
    }
    owner
}

impl Group {
    /// Group `g`, where the nodes have these owners and the groups these own sizes.
    fn new(model: &Model, owner: &[usize], sizes: &[f64], g: usize, mass: &[f64]) -> Self {
        let own = || model.nodes().iter().zip(owner).filter(|(_, o)| **o == g).map(|(n, _)| n);
        let moving = || own().filter(|n| n.kind.has_position());
        let total: f64 = moving().map(|n| mass[n.v..n.v + 3].iter().sum::<f64>() / 3.0).sum();
        // plain numbers alone weigh themselves
        let total = if total > 0.0 { total } else { own().flat_map(|n| &mass[n.dofs()]).sum() };
        let farthest =
            moving().flat_map(|n| &model.start.q[n.q..n.q + 3]).fold(0.0, |m: f64, x| m.max(x.abs()));
        let name = match model.parts().get(g) {
            Some(part) => part.name().to_string(),
            None => own().next().map_or(String::new(), |n| model.unknown_name(n.v)),
        };
        let (length, size) = lengths(model, owner, sizes, g);
        let rounding = 0.5 * f64::EPSILON * (farthest / length).max(1.0);
        Group { name, length, size, mass: total, single: moving().count() == 1, rounding }
    }
}

/// What the positions and the rotations of a group are relative to.
fn lengths(model: &Model, owner: &[usize], sizes: &[f64], g: usize) -> (f64, f64) {
    // a marker that is off by rounding is no lever
    let least = 1e-9 * model.length();
    let whole = |x: f64| if x > least { x } else { model.length() };
    let slender = |g: usize| model.parts().get(g).is_some_and(|p| p.mesh().len() > 1 || p.seats().len() > 1);
    if slender(g) {
        return (whole(sizes[g]), whole(sizes[g]));
    }
    let q = &model.start.q;
    let (mut arm, mut line, mut neighbour) = (sizes[g], 0.0f64, 0.0f64);
    for c in model.constraints() {
        let Some(&own) = c.nodes().iter().find(|k| owner[k.0 as usize] == g) else { continue };
        let n = model.node(own);
        if n.kind.has_position() {
            let x = &q[n.q..n.q + 3];
            for marker in c.markers() {
                let place = marker.place(model.nodes(), q, |_| 0.0).x;
                arm = arm.max((0..3).map(|i| (place[i] - x[i]).powi(2)).sum::<f64>().sqrt());
            }
        }
        for other in c.nodes().iter().map(|k| owner[k.0 as usize]).filter(|&o| o != g) {
            if slender(other) {
                line = line.max(sizes[other]);
            }
            neighbour = neighbour.max(sizes[other]);
        }
    }
    let size = if arm > least { arm } else { neighbour };
    // what hangs on a line is placed by the line
    (whole(size.max(line)), whole(size))
}

/// Neighbours of one group, sorted by group.
fn runs(of: &[u32]) -> Vec<(usize, Range<usize>)> {
    let mut all: Vec<(usize, Range<usize>)> = Vec::new();
    for (i, &g) in of.iter().enumerate() {
        match all.last_mut() {
            Some((last, run)) if *last == g as usize => run.end = i + 1,
            _ => all.push((g as usize, i..i + 1)),
        }
    }
    all.sort_by_key(|(g, run)| (*g, run.start));
    all
}

/// The largest root of the sums of a square over the runs of each group, and the group. A NaN counts as the largest.
fn largest(runs: &[(usize, Range<usize>)], square: impl Fn(&Range<usize>) -> f64) -> (usize, f64) {
    let (mut worst, mut sum) = ((0, 0.0), 0.0);
    for (k, (g, run)) in runs.iter().enumerate() {
        sum += square(run);
        if runs.get(k + 1).is_none_or(|(next, _)| next != g) {
            if !(sum <= worst.1) {
                worst = (*g, sum);
                if sum.is_nan() {
                    return worst;
                }
            }
            sum = 0.0;
        }
    }
    (worst.0, worst.1.sqrt())
}

/// `Σ w x²`; in four sums, which don't wait for each other. A NaN stays a NaN.
fn weighted_square(w: &[f64], x: &[f64]) -> f64 {
    in_four(w, x, |w, x| w * (x * x))
}

/// `Σ (s x)²`.
fn scaled_square(s: &[f64], x: &[f64]) -> f64 {
    in_four(s, x, |s, x| (s * x) * (s * x))
}

#[inline(always)]
fn in_four(a: &[f64], b: &[f64], of: impl Fn(f64, f64) -> f64) -> f64 {
    let ((a, a_rest), (b, b_rest)) = (a.as_chunks::<4>(), b.as_chunks::<4>());
    let mut sums = [0.0; 4];
    for (a, b) in a.iter().zip(b) {
        for i in 0..4 {
            sums[i] += of(a[i], b[i]);
        }
    }
    let rest: f64 = a_rest.iter().zip(b_rest).map(|(a, b)| of(*a, *b)).sum();
    sums.iter().sum::<f64>() + rest
}
