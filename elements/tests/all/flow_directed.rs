//! Bending with a direction of cables through which material flows.

use crate::flow_torsion::{COIL, COILS, ONE, TWO, at};
use crate::torsion::states;
use ropewalk_core::testing::{check_tangent, dense, difference};
use ropewalk_core::{Element, Node, NodeId, NodeKind, Pool, Term, Weights, Width, retract};
use ropewalk_elements::cable::flow::{Embedding, FlowDirected};
use ropewalk_elements::cable::quadrature::{Gauss2, Points};
use ropewalk_elements::cable::{Directed, DirectedParams};

fn nodes(boundaries: usize) -> Vec<Node> {
    let mut all: Vec<Node> = Vec::new();
    for kind in [NodeKind::Twist; 2].into_iter().chain([NodeKind::Scalars(1); 3]) {
        let (q, v) = all.last().map_or((0, 0), |n| (n.coords().end, n.dofs().end));
        all.push(Node { kind, q, v, shared: matches!(kind, NodeKind::Scalars(_)) });
    }
    all.truncate(3 + boundaries);
    all
}

fn pool<E: Element<Q, N>, const Q: usize, const N: usize>(element: E, boundaries: usize) -> Box<dyn Term> {
    let mut pool = Pool::new();
    let on: Vec<NodeId> = (0..3 + boundaries as u32).map(NodeId).collect();
    for _ in 0..3 {
        assert!(pool.push(&nodes(boundaries), element.clone(), &on));
    }
    Box::new(pool)
}

fn one<const F: usize>(by: Embedding<F>, turns: Embedding<F>, open: [f64; 2], rho_j: f64) -> FlowDirected<F> {
    FlowDirected { more: 1.9, gj: 0.8, eta_gj: 0.3, rho_j, by, turns, open, rule: Points::of(Gauss2) }
}

fn terms(rho_j: f64) -> Vec<(usize, Box<dyn Term>)> {
    vec![(1, pool(one(ONE, COIL, [1.0, 0.0], rho_j), 1)), (2, pool(one(TWO, COILS, [0.0, 1.0], rho_j), 2))]
}

fn motion(q: &[f64], boundaries: usize) -> [Vec<f64>; 3] {
    let mut q = q[..21].to_vec();
    q.extend_from_slice(&[-0.3, 0.9][..boundaries]);
    let wave = |k: f64| (0..15 + boundaries).map(|i| (k * i as f64 + 0.3).sin()).collect::<Vec<f64>>();
    [q, wave(1.7), wave(2.9)]
}

#[test]
fn tangents_are_derivatives() {
    for q in states() {
        assert!(q[20] != 0.0, "a bubble");
        for (boundaries, term) in terms(0.7) {
            let x = motion(&q, boundaries);
            let error = check_tangent(term.as_ref(), &nodes(boundaries), &at(&x), Width::One);
            assert!(error <= 1e-7, "{boundaries}: {error}");
        }
    }
}

#[test]
fn energy_is_kept_but_for_what_passes_the_ends() {
    for q in states() {
        for (boundaries, term) in terms(0.7) {
            let (x, nodes) = (motion(&q, boundaries), nodes(boundaries));
            let (f, _) = dense(term.as_ref(), &nodes, &at(&x), Weights::default(), Width::One);
            let work: f64 = f.iter().zip(&x[1]).map(|(f, v)| f * v).sum();
            let grows = difference(|h| {
                let d: Vec<f64> = x[1].iter().map(|v| h * v).collect();
                let mut moved = x.clone();
                retract(&nodes, &x[0], &d, &mut moved[0]);
                moved[1].iter_mut().zip(&x[2]).for_each(|(v, a)| *v += h * a);
                let energy = term.energy(&at(&moved));
                vec![energy.kinetic + energy.potential]
            })[0];
            let power = term.power(&at(&x));
            let off = work - (grows - power.carried + power.dissipated);
            println!("{boundaries}: {work} {grows} {power:?}: {off:.1e}");
            assert!(off.abs() <= 1e-8 * (1.0 + work.abs()), "{boundaries}: {off}");
            assert!(power.carried != 0.0 && power.dissipated > 0.0);
        }
    }
}

/// What doesn't feed has the forces and tangents of an element of that length, but for the bubble's inertia with the nodes.
#[test]
fn what_does_not_feed_is_plain_bending_with_a_direction() {
    for q in states() {
        let (fixed, l) = ([0.2, 0.9], 0.7);
        let (by, turns) =
            (Embedding { by: [[0.0; 2]], fixed }, Embedding { by: [[0.0; 2]], fixed: [0.0; 2] });
        let mut x = motion(&q, 1);
        x[2].fill(0.0);
        let w = Weights { q: 1.0, v: 0.5, a: 0.0 };
        let of = |term: Box<dyn Term>, n: usize| dense(term.as_ref(), &nodes(n), &at(&x), w, Width::One);
        let (a, ka) = of(pool(one(by, turns, [0.0; 2], 0.7), 1), 1);
        let params = DirectedParams { l, ei_d: 2.4, ei_e: 0.5, gj: 0.8, eta_gj: 0.3, rho_j: 0.7 };
        let (b, kb) = of(pool::<_, 21, 15>(Directed::new(params, [[0.0; 2]; 5], Gauss2), 0), 0);
        for i in 0..15 {
            assert!((a[i] - b[i]).abs() <= 1e-11 * (1.0 + b[i].abs()), "{i}: {} {}", a[i], b[i]);
            for j in 0..15 {
                assert!((ka[i][j] - kb[i][j]).abs() <= 1e-10 * (1.0 + kb[i][j].abs()), "{i} {j}");
            }
        }
    }
}
