//! What acts where cable is fed: derivatives against differences.

use ropewalk_constraints::motion::Straight;
use ropewalk_constraints::package::PackageSpec;
use ropewalk_constraints::winch::{LiftOff, Peel, Pull};
use ropewalk_core::testing::{check_constraint, check_tangent};
use ropewalk_core::{At, Motion, MovingBoundary, Node, NodeId, NodeKind, Width};
use std::sync::Arc;

/// The end of a cable, and the boundary by which it is fed.
const NODES: [Node; 2] = [
    Node { kind: NodeKind::Slope, q: 0, v: 0, shared: false },
    Node { kind: NodeKind::Scalars(1), q: 6, v: 6, shared: true },
];

fn boundary(sign: f64) -> MovingBoundary {
    MovingBoundary {
        node: NodeId(1),
        q: 6,
        v: 6,
        sign,
        home: 0.0,
        end: NodeId(0),
        end_q: 0,
        end_v: 0,
        rho_a: 1.3,
    }
}

#[test]
fn tangent_agrees_with_differences_within_a_layer_and_between_two() {
    let spec = PackageSpec { layers: 2, ..PackageSpec::new(0.06, 0.02, 0.009) };
    let package = Arc::new(spec.build().expect("package"));
    for (sign, peeled, u) in [(1.0, 0.1, 0.4), (-1.0, 0.75, 0.4), (1.0, 0.8, -0.2)] {
        let boundary = boundary(sign);
        let (energy, slip_speed, ei) = (0.3, 0.2, 0.002);
        let peel = Peel { name: "off".into(), boundary, package: package.clone(), energy, slip_speed, ei };
        let q = [0.1, 0.2, 0.3, 0.9, 0.5, -0.4, sign * peeled];
        let v = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, sign * u];
        let at = At { t: 0.0, q: &q, v: &v, a: &[0.0; 7], internal: &[], relaxed: None };
        assert!(check_tangent(&peel, &NODES, &at, Width::One) < 1e-6, "{peeled}");
    }
}

#[test]
fn derivatives_agree_with_differences() {
    let package = Arc::new(PackageSpec::new(0.06, 0.2, 0.009).build().unwrap());
    for (sign, p) in [(-1.0, -0.9), (1.0, 1.3), (1.0, 0.2)] {
        let boundary = MovingBoundary { home: 0.2 * sign, ..boundary(sign) };
        let q = [0.1, 0.05, 0.3, 0.9, 0.5, -0.4, p];
        let v = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7];
        let at = At { t: 0.0, q: &q, v: &v, a: &[0.0; 7], internal: &[], relaxed: None };
        for tangent in [false, true] {
            let off = LiftOff::new("off", boundary, package.clone(), tangent);
            let error = check_constraint(&off, &NODES, &at);
            assert!(error < 1e-5, "{sign}, tangent {tangent}: {error:e}");
        }
    }
}

#[test]
fn tangent_agrees_with_differences_for_both_directions() {
    let steady = Straight::new([1.0, 0.0, 0.0], 3.0, -1.0, 0.1).expect("a speed");
    for (sign, rate, reference) in
        [(-1.0, 0.7, None), (-1.0, -0.4, Some(Arc::new(steady) as Arc<dyn Motion>)), (1.0, 0.3, None)]
    {
        let boundary = boundary(sign);
        let pull = Pull {
            name: "drum".into(),
            boundary,
            tension: 4.0.into(),
            brake: 3.0.into(),
            slip_speed: 0.5,
            damping: 0.7.into(),
            per_speed2: 0.4.into(),
            reference,
            inertia: 2.0,
            pile: true,
        };
        let q = [0.1, 0.2, 0.3, 0.9, 0.5, -0.4, 0.8];
        let (v, a) = ([0.1, 0.2, 0.3, 0.4, 0.5, 0.6, rate], [0.3; 7]);
        let at = At { t: 0.0, q: &q, v: &v, a: &a, internal: &[], relaxed: None };
        assert!(check_tangent(&pull, &NODES, &at, Width::One) < 1e-8);
    }
}
