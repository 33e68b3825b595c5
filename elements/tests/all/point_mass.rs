//! The point mass: tangent, balance of energy, weight, limits.

use ropewalk_core::testing::{check_tangent, dense, difference};
use ropewalk_core::{At, Marker, Node, NodeId, NodeKind, Term, Weights, Width, retract};
use ropewalk_elements::{Across, PointMass};
use ropewalk_scene::Current;

const CABLE: NodeId = NodeId(1);

/// A point, a cable node, a body and a plain number.
fn nodes() -> Vec<Node> {
    let mut all: Vec<Node> = Vec::new();
    for kind in [NodeKind::Point, NodeKind::Slope, NodeKind::Frame, NodeKind::Scalars(1)] {
        let (q, v) = all.last().map_or((0, 0), |n| (n.coords().end, n.dofs().end));
        all.push(Node { kind, q, v, shared: false });
    }
    all
}

fn numbers(n: usize, seed: f64) -> Vec<f64> {
    (1..=n).map(|k| 2.0 * (seed * (k * k) as f64).sin()).collect()
}

/// Configuration, velocities and accelerations that repeat.
fn state(seed: f64) -> [Vec<f64>; 3] {
    let mut q = numbers(17, seed);
    let norm = q[12..16].iter().map(|x| x * x).sum::<f64>().sqrt();
    q[12..16].iter_mut().for_each(|x| *x /= norm);
    [q, numbers(16, seed + 0.1), numbers(16, seed + 0.2)]
}

fn masses() -> Vec<PointMass> {
    let sheared = Current::Linear { z0: 0.0, velocity: [0.4, 0.1, 0.0], gradient: [0.1, -0.3, 0.05] };
    let mut all = Vec::new();
    let beside = Marker::beside(NodeId(2), [0.3, -0.2, 0.5]);
    for marker in [Marker::node(NodeId(0)), Marker::node(CABLE), Marker::node(NodeId(2)), beside] {
        let mass = PointMass::new("sinker", &nodes(), &marker, 5.0).unwrap();
        all.push(mass.clone());
        for current in [Current::Still, Current::Uniform([0.5, 0.0, 0.1]), sheared.clone()] {
            all.push(mass.clone().in_fluid(1025.0, 2.0, 0.01, current).unwrap());
        }
    }
    all
}

#[test]
fn tangent_is_exact() {
    for seed in [0.3, 0.7, 1.1, 1.9] {
        let [q, v, a] = state(seed);
        let at = At { t: 0.0, q: &q, v: &v, a: &a, internal: &[], relaxed: None };
        for mass in masses() {
            assert!(check_tangent(&mass, &nodes(), &at, Width::One) < 1e-8);
            // and where it lies across the surface
            for depth in [-0.15, 0.02, 0.18] {
                let surface = Some(Across { level: mass.held.x(&at)[2] + depth, radius: 0.2 });
                let error = check_tangent(&PointMass { surface, ..mass.clone() }, &nodes(), &at, Width::One);
                assert!(error < 1e-7, "{error:e}");
            }
        }
    }
}

#[test]
fn energy_balances_power() {
    // dE/dt, less what is supplied and plus what is lost, is the work of the residual
    for seed in [0.3, 0.7, 1.1, 1.9] {
        let [q, v, a] = state(seed);
        let at = At { t: 0.0, q: &q, v: &v, a: &a, internal: &[], relaxed: None };
        for mass in masses() {
            let rate = difference(|h| {
                let v: Vec<f64> = v.iter().zip(&a).map(|(v, a)| v + h * a).collect();
                let mut turned = q.clone();
                let step: Vec<f64> = at.v.iter().map(|v| h * v).collect();
                retract(&nodes(), &q, &step, &mut turned);
                vec![mass.energy(&At { q: &turned, v: &v, ..at }).kinetic]
            })[0];
            let p = mass.power(&at);
            assert!(p.dissipated >= 0.0);
            let (r, _) = dense(&mass, &nodes(), &at, Weights::default(), Width::One);
            let work: f64 = r.iter().zip(&v).map(|(r, v)| r * v).sum();
            let balance = rate + p.dissipated - p.supplied;
            assert!((balance - work).abs() < 1e-8 * (1.0 + work.abs()), "{balance} {work}");
        }
    }
}

#[test]
fn weight_is_less_buoyancy() {
    let mass = PointMass::new("sinker", &nodes(), &Marker::node(CABLE), 5.0).unwrap();
    let mass = mass.in_fluid(1000.0, 1.0, 0.0, Current::Still).unwrap();
    let weight = mass.weight(0.001, [0.0, 0.0, -10.0]).unwrap();
    assert_eq!((weight.held, weight.force), (mass.held, [0.0, 0.0, -40.0]));
}

#[test]
fn tangent_is_finite_at_rest() {
    let (q, v) = ([0.0; 17], [0.0; 16]);
    let at = At { t: 0.0, q: &q, v: &v, a: &v, internal: &[], relaxed: None };
    let w = Weights { q: 1.0, v: 1.0, a: 1.0 };
    for mass in masses() {
        let (r, k) = dense(&mass, &nodes(), &at, w, Width::One);
        assert!(r.iter().chain(k.iter().flatten()).all(|x| x.is_finite()));
    }
}

#[test]
fn bad_masses_are_refused() {
    let on = |node: u32| Marker::node(NodeId(node));
    assert!(PointMass::new("m", &nodes(), &on(3), 1.0).is_err());
    assert!(PointMass::new("m", &nodes(), &on(9), 1.0).is_err());
    assert!(PointMass::new("m", &nodes(), &on(1), -1.0).is_err());
    let mass = PointMass::new("m", &nodes(), &on(1), 1.0).unwrap();
    assert!(mass.in_fluid(1025.0, f64::NAN, 0.0, Current::Still).is_err());
}
