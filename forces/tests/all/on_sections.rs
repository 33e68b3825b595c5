//! Bushings and torsion springs on the sections of cables with torsion.

use crate::random::Random;
use ropewalk_core::model::twist::{laid, moment};
use ropewalk_core::rotation::{IDENTITY, cross, matrix, times};
use ropewalk_core::testing::{check_tangent, dense, difference};
use ropewalk_core::{At, Marker, Node, NodeId, NodeKind, Signal, Term, V3, Weights, Width, retract};
use ropewalk_forces::{Bushing, RotationalSpring};

/// The ends of two cables with torsion, and a body.
fn nodes() -> Vec<Node> {
    let node = |kind, q, v| Node { kind, q, v, shared: false };
    vec![node(NodeKind::Twist, 0, 0), node(NodeKind::Twist, 10, 7), node(NodeKind::Frame, 20, 14)]
}

/// Coordinates and velocities, all different.
fn state(seed: u64) -> (Vec<f64>, Vec<f64>) {
    let mut r = Random(seed);
    let mut q = Vec::new();
    for _ in 0..2 {
        q.extend(laid(&r.vector(1.0), &r.vector(1.0), &r.vector(1.0), r.number(3.0)));
    }
    q.extend(r.vector(1.0));
    let turn = r.list(4, 1.0);
    let size = turn.iter().map(|x| x * x).sum::<f64>().sqrt();
    q.extend(turn.iter().map(|x| x / size));
    (q, r.list(20, 1.0))
}

fn at<'a>(q: &'a [f64], v: &'a [f64]) -> At<'a> {
    At { t: 0.0, q, v, a: &[0.0; 20], internal: &[], relaxed: None }
}

fn pairs() -> Vec<[Marker; 2]> {
    let tilted = [[0.6, 0.8, 0.0], [-0.8, 0.6, 0.0], [0.0, 0.0, 1.0]];
    let end = |k, axes| Marker::Node { node: NodeId(k), point: [0.0; 3], axes };
    let ground = Marker::Ground { point: [0.2, 0.1, -0.3], axes: tilted };
    let body = Marker::Node { node: NodeId(2), point: [0.3, -0.4, 0.2], axes: tilted };
    vec![
        [ground, end(0, IDENTITY)],
        [end(1, tilted), ground],
        [body, end(0, tilted)],
        [end(0, tilted), body],
        [end(0, tilted), end(1, IDENTITY)],
    ]
}

fn bushing(pair: [Marker; 2]) -> Bushing {
    let mut b = Bushing::new("mount", &nodes(), pair).unwrap();
    b.stiffness = [100.0, 200.0, 50.0].map(Signal::from);
    b.rotational_stiffness = [10.0, 30.0, 20.0].map(Signal::from);
    b.damping = [5.0, 7.0, 1.0].map(Signal::from);
    b.rotational_damping = [2.0, 0.5, 3.0].map(Signal::from);
    b
}

#[test]
fn tangents_are_exact_as_all_tangents_of_sections_are() {
    for seed in 1..=8 {
        let (q, v) = state(seed);
        for (k, pair) in pairs().into_iter().enumerate() {
            let mut spring = RotationalSpring::new("spring", &nodes(), pair, 30.0, 0.4).unwrap();
            spring.damping = 2.0.into();
            for term in [&bushing(pair) as &dyn Term, &spring] {
                let error = check_tangent(term, &nodes(), &at(&q, &v), Width::One);
                assert!(error < 1e-7, "{} ({k}) at state {seed}: {error}", term.label());
            }
        }
    }
}

#[test]
fn what_is_taken_is_stored_or_dissipated() {
    for seed in 1..=8 {
        let (q, v) = state(seed);
        for (k, pair) in pairs().into_iter().enumerate() {
            let term = bushing(pair);
            let (r, _) = dense(&term, &nodes(), &at(&q, &v), Weights::default(), Width::One);
            let taken: f64 = r.iter().zip(&v).map(|(r, v)| r * v).sum();
            let stored = difference(|dt| {
                let step: Vec<f64> = v.iter().map(|v| v * dt).collect();
                let mut moved = q.clone();
                retract(&nodes(), &q, &step, &mut moved);
                vec![term.energy(&at(&moved, &v)).potential]
            })[0];
            let lost = term.power(&at(&q, &v)).dissipated;
            let size = taken.abs() + stored.abs() + lost.abs();
            assert!((taken - stored - lost).abs() < 1e-7 * size, "{k}: {taken} {stored} {lost}");
        }
    }
}

#[test]
fn momentum_and_angular_momentum_are_kept() {
    let (q, v) = state(3);
    for pair in pairs().into_iter().skip(2) {
        let (r, _) = dense(&bushing(pair), &nodes(), &at(&q, &v), Weights::default(), Width::One);
        let three = |x: &[f64], i: usize| -> V3<f64> { [x[i], x[i + 1], x[i + 2]] };
        let (mut force, mut whole) = ([0.0; 3], [0.0; 3]);
        for node in nodes() {
            let (f, own) = (three(&r, node.v), three(&r, node.v + 3));
            let turning = match node.kind {
                NodeKind::Twist => moment(&q[node.q..], &own, r[node.v + 6]),
                _ => times(&matrix(&[q[23], q[24], q[25], q[26]]), &own),
            };
            let lever = cross(&three(&q, node.q), &f);
            for i in 0..3 {
                force[i] += f[i];
                whole[i] += turning[i] + lever[i];
            }
        }
        let size = r.iter().map(|x| x.abs()).fold(0.0, f64::max);
        assert!(force.iter().chain(&whole).all(|x| x.abs() < 1e-13 * size), "{force:?} {whole:?}");
    }
}

#[test]
fn cables_without_torsion_have_no_axes_to_hold() {
    let slope = [Node { kind: NodeKind::Slope, q: 0, v: 0, shared: false }];
    let ends = [Marker::ground([0.0; 3]), Marker::node(NodeId(0))];
    let e = RotationalSpring::new("spring", &slope, ends, 1.0, 0.0).unwrap_err();
    assert!(e.message.contains("section.gj"), "{}", e.message);
}
