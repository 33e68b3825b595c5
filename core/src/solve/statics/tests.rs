use super::*;
use crate::algebra::jet::Jet;
use crate::model::constraint::{Constraint, RowKind};
use crate::model::marker::{Marker, Place};
use crate::model::node::{Node, NodeId, NodeKind};
use crate::model::pattern::Pattern;
use crate::model::relation::{Related, Relation};
use crate::model::state::{At, State};
use crate::model::term::{Assembly, Term};
use crate::model::{Model, Start};

/// A column of rigid links, joined by springs that bend, clamped at its foot: `EI = L = 1`, mass 1. Loads grow with time.
#[derive(Clone, Copy)]
struct Column {
    links: usize,
    /// Load at the top: along the axis, across, and along the last link [N].
    dead: f64,
    side: f64,
    follower: f64,
}

impl Column {
    fn link(&self) -> f64 {
        1.0 / self.links as f64
    }
    /// The mass that sits at the end of a link.
    fn mass(&self, k: usize) -> f64 {
        if k + 1 == self.links { 0.5 * self.link() } else { self.link() }
    }
    fn model(self) -> Model {
        let (n, l) = (self.links, self.link());
        let nodes: Vec<Node> =
            (0..n).map(|k| Node { kind: NodeKind::Point, q: 3 * k, v: 3 * k, shared: false }).collect();
        let mut q = vec![0.0; 3 * n];
        (0..n).for_each(|k| q[3 * k + 2] = (k + 1) as f64 * l);
        let at = |k: usize| match k {
            0 => Marker::ground([0.0; 3]),
            k => Marker::node(NodeId(k as u32 - 1)),
        };
        let rod = |k: usize| -> Box<dyn Constraint> {
            Box::new(Related::new(format!("link {}", k + 1), Rod(l), vec![at(k), at(k + 1)]))
        };
        let start = Start { q, v: vec![0.0; 3 * n], internal: vec![] };
        Model::new(nodes, vec![Box::new(self)], (0..n).map(rod).collect(), vec![], start, 1.0)
    }
}

struct Rod(f64);

impl Relation for Rod {
    fn rows(&self) -> Vec<RowKind> {
        vec![RowKind::Position]
    }
    fn g<S: Jet>(&self, _t: S, at: &[Place<S>], g: &mut [S]) {
        let d: [S; 3] = std::array::from_fn(|i| at[1].x[i] - at[0].x[i]);
        g[0] = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2] - self.0 * self.0) * (0.5 / self.0);
    }
}

impl Term for Column {
    fn label(&self) -> String {
        "column".into()
    }
    fn pattern(&self, p: &mut Pattern) {
        // each spring joins three nodes; the foot and a point below it are fixed
        for k in 0..self.links {
            p.clique(3 * k.saturating_sub(2)..3 * k + 3);
        }
    }
    fn symmetric(&self) -> bool {
        self.follower == 0.0
    }
    fn add(&self, at: &At<'_>, out: &mut Assembly<'_>) {
        let (n, l) = (self.links, self.link());
        let x = |k: isize, i: usize| match k {
            k if k < 0 => {
                if i == 2 {
                    (k + 1) as f64 * l
                } else {
                    0.0
                }
            }
            k => at.q[3 * k as usize + i],
        };
        let w = out.weights();
        for k in 0..n {
            // the spring between the links that end at nodes k - 1 and k: -c d·d'
            let c = if k == 0 { 2.0 } else { 1.0 } / l / (l * l);
            let first = k.saturating_sub(2);
            let size = 3 * (k - first) + 3;
            for i in 0..3 {
                let (a, b, e) = (x(k as isize - 2, i), x(k as isize - 1, i), x(k as isize, i));
                let mut push = |k: isize, r: f64| {
                    if k >= 0 {
                        out.add(3 * k as usize + i, r);
                    }
                };
                push(k as isize - 2, c * (e - b));
                push(k as isize - 1, -c * (e - b) + c * (b - a));
                push(k as isize, -c * (b - a));
                out.add(3 * k + i, self.mass(k) * at.a[3 * k + i]);
            }
            // -c (b - a)·(e - b)
            let by = [[0.0, -c, c], [-c, 2.0 * c, -c], [c, -c, 0.0]];
            let missing = 2 - (k - first);
            out.add_block(k, size, |i, j| {
                let mut v = if i % 3 == j % 3 { w.q * by[missing + i / 3][missing + j / 3] } else { 0.0 };
                if i == j && i / 3 == k - first {
                    v += w.a * self.mass(k);
                }
                if k + 1 == n && self.follower != 0.0 && i / 3 == k - first {
                    // the direction of the last link turns
                    let d: [f64; 3] = std::array::from_fn(|c| x(k as isize, c) - x(k as isize - 1, c));
                    let square: f64 = d.iter().map(|d| d * d).sum();
                    let along = self.follower * at.t / square.sqrt();
                    let turn = f64::from(u8::from(i % 3 == j % 3)) - d[i % 3] * d[j % 3] / square;
                    let sign = if j / 3 == k - first {
                        1.0
                    } else if j / 3 + 1 == k - first {
                        -1.0
                    } else {
                        0.0
                    };
                    v -= w.q * sign * along * turn;
                }
                v
            });
        }
        let top = 3 * (n - 1);
        out.add(top, -self.side * at.t);
        out.add(top + 2, -self.dead * at.t);
        if self.follower != 0.0 {
            let d: [f64; 3] = std::array::from_fn(|c| x(n as isize - 1, c) - x(n as isize - 2, c));
            let size = d.iter().map(|d| d * d).sum::<f64>().sqrt();
            (0..3).for_each(|i| out.add(top + i, -self.follower * at.t * d[i] / size));
        }
    }
}

const PLAIN: Column = Column { links: 24, dead: 0.0, side: 0.0, follower: 0.0 };
/// Of 24 links, by the eigenvalues of its matrices.
const CRITICAL: f64 = 2.466_52;

/// Follows the load in equal steps; the state and the critical loads.
fn press(column: Column, steps: usize) -> (State, Vec<Critical>, u32) {
    let model = column.model();
    let mut statics = Statics::new(&model, &StaticsOptions::default()).expect("statics");
    let mut state = model.state();
    let mut sum = statics.find(&mut state, true).expect("straight");
    for k in 1..=steps {
        let found = statics.follow(&mut state, k as f64 / steps as f64);
        sum.add(&found.unwrap_or_else(|e| panic!("step {k} of {steps}: {e}")));
    }
    assert_eq!(statics.unstable, 0);
    (state, statics.critical().to_vec(), sum.iterations)
}

fn said(critical: &[Critical]) -> String {
    critical.iter().map(|c| format!("[{} {c}]", c.t)).collect()
}

fn tip(state: &State) -> [f64; 2] {
    let q = &state.q[state.q.len() - 3..];
    [q[0].hypot(q[1]), q[2]]
}

#[test]
fn the_test_column_has_the_right_derivatives() {
    let column = Column { links: 4, dead: -1.0, side: 0.3, follower: -0.7 };
    let model = column.model();
    let mut q = model.state().q;
    q.iter_mut().enumerate().for_each(|(i, x)| *x += 0.03 * (i as f64).sin());
    let zero = vec![0.0; q.len()];
    let at = At { t: 0.8, q: &q, v: &zero, a: &zero, internal: &[], relaxed: None };
    let off = crate::testing::check_tangent(&column, model.nodes(), &at, crate::algebra::lane::Width::One);
    assert!(off < 1e-6, "{off:e}");
}

#[test]
fn a_round_column_buckles_in_a_pair_and_takes_the_stable_branch() {
    // tips of the elastica by load, which that of links meets at its own critical load
    for (p, lateral, axial) in
        [(2.636, 0.43631, 0.87239), (3.1617, 0.71251, 0.57286), (9.6615, 0.63249, -0.32903)]
    {
        for steps in [1, 5, 10, 37, 100] {
            let dead = -p * CRITICAL / 2.467_401;
            let (state, critical, iterations) = press(Column { dead, ..PLAIN }, steps);
            let [x, z] = tip(&state);
            println!("{p}, {steps} steps: {x} {z}, {iterations} iterations, {}", said(&critical));
            assert_eq!(critical.len(), 1);
            assert!((critical[0].t * -dead / CRITICAL - 1.0).abs() < 1e-5, "{}", critical[0].t * -dead);
            assert_eq!((critical[0].kind, critical[0].directions), (CriticalKind::Bifurcation, 2));
            assert!((x - lateral).abs() < 2e-3 && (z - axial).abs() < 4e-3, "{p}, {steps} steps: {x} {z}");
        }
    }
}

#[test]
fn an_imperfect_column_bends_round_the_bifurcation() {
    for (p, lateral) in [(2.4, 0.0), (2.6, 0.3922), (3.0, 0.6629), (5.0, 0.7945), (10.0, 0.6227)] {
        for share in [1e-6, 1e-4] {
            for steps in [5, 10, 20, 50, 100, 200] {
                let column = Column { dead: -p, side: p * share, ..PLAIN };
                let (state, critical, iterations) = press(column, steps);
                let [x, z] = tip(&state);
                println!(
                    "{p}, {share:e}, {steps} steps: {x} {z}, {iterations} iterations {}",
                    said(&critical)
                );
                assert!(critical.is_empty());
                assert!((x - lateral).abs() < 1.5e-2, "{p}, {share:e}, {steps} steps: {x} {z}");
                assert!(state.q[state.q.len() - 3] > 0.0);
            }
        }
    }
}

#[test]
fn a_load_that_follows_makes_flutter_and_no_divergence() {
    for (p, flutters) in [(10.0, false), (19.8, false), (21.0, true)] {
        let column = Column { follower: -p, ..PLAIN };
        let model = column.model();
        let mut statics = Statics::new(&model, &StaticsOptions::default()).expect("statics");
        let mut state = model.state();
        let mut sum = statics.find(&mut state, true).expect("straight");
        for k in 1..=10 {
            sum.add(&statics.follow(&mut state, f64::from(k) / 10.0).unwrap_or_else(|e| panic!("{p}: {e}")));
        }
        println!("{p}: {sum:?}, {} {:?}", said(statics.critical()), statics.doubt());
        assert_eq!(sum.flutter > 0.0, flutters, "{p}: {sum:?}");
        assert!(tip(&state)[0] < 1e-9);
        // Beck's load; that of 24 links is a little lower
        for c in statics.critical() {
            assert_eq!(c.kind, CriticalKind::Flutter);
            assert!((c.t * p / 20.051 - 1.0).abs() < 1e-2, "{}", c.t * p);
        }
        assert_eq!(statics.critical().len(), usize::from(flutters));
    }
}

/// Two bars of EA = 1 that lean against each other at a height of 1/2 over a half span of 1.
struct Truss(f64);

impl Truss {
    const REST: f64 = 1.118_033_988_749_895;
    fn model(load: f64) -> Model {
        let nodes = vec![Node { kind: NodeKind::Point, q: 0, v: 0, shared: false }];
        let hold = |i: usize| -> Box<dyn Constraint> {
            let markers = vec![Marker::ground([0.0; 3]), Marker::node(NodeId(0))];
            Box::new(Related::new(format!("guide {i}"), Guide(i), markers))
        };
        let start = Start { q: vec![0.0, 0.0, 0.5], v: vec![0.0; 3], internal: vec![] };
        Model::new(nodes, vec![Box::new(Truss(load))], vec![hold(0), hold(1)], vec![], start, 1.0)
    }
    fn pull(z: f64) -> f64 {
        let l = z.hypot(1.0);
        2.0 * (l - Self::REST) / Self::REST * z / l
    }
}

struct Guide(usize);

impl Relation for Guide {
    fn rows(&self) -> Vec<RowKind> {
        vec![RowKind::Position]
    }
    fn g<S: Jet>(&self, _t: S, at: &[Place<S>], g: &mut [S]) {
        g[0] = at[1].x[self.0];
    }
}

impl Term for Truss {
    fn label(&self) -> String {
        "truss".into()
    }
    fn pattern(&self, p: &mut Pattern) {
        p.clique(0..3);
    }
    fn add(&self, at: &At<'_>, out: &mut Assembly<'_>) {
        let z = at.q[2];
        out.add(2, Truss::pull(z) + self.0 * at.t + at.a[2]);
        let (h, w) = (1e-5, out.weights());
        let slope = (Truss::pull(z + h) - Truss::pull(z - h)) / (2.0 * h);
        out.add_block(0, 3, |i, j| match (i, j) {
            (2, 2) => w.q * slope + w.a,
            (i, j) if i == j => w.q + w.a,
            _ => 0.0,
        });
    }
}

#[test]
fn a_truss_snaps_through_at_its_limit_load() {
    for steps in [1, 2, 5, 10, 40, 200] {
        let model = Truss::model(0.06);
        let mut statics = Statics::new(&model, &StaticsOptions::default()).expect("statics");
        let mut state = model.state();
        let mut sum = statics.find(&mut state, true).expect("unloaded");
        for k in 1..=steps {
            let found = statics.follow(&mut state, f64::from(k) / f64::from(steps));
            sum.add(&found.unwrap_or_else(|e| panic!("step {k} of {steps}: {e}")));
        }
        println!("{steps} steps: z = {}, {sum:?} {}", state.q[2], said(statics.critical()));
        assert!(state.q[2] < -0.5 && (Truss::pull(state.q[2]) + 0.06).abs() < 1e-9);
        let critical = statics.critical();
        assert_eq!(critical.len(), 1, "{}", said(critical));
        assert_eq!((critical[0].kind, critical[0].directions), (CriticalKind::Limit, 1));
        assert!((critical[0].t * 0.06 / 0.038_383_739_817_434_745 - 1.0).abs() < 1e-6, "{}", said(critical));
    }
}
