//! Joints: Jacobian, geometric stiffness, rates and bias against differences.

use ropewalk_constraints::motion::{Circle, Harmonic, Side, Table};
use ropewalk_constraints::{BodyClamp, Clamp, Coordinate, Distance, Driving, Spherical};
use ropewalk_core::testing::check_constraint;
use ropewalk_core::{At, Constraint, Marker, Motion, Node, NodeId, NodeKind};
use std::sync::Arc;

const POINT: NodeId = NodeId(0);
const CABLE: NodeId = NodeId(1);
const BODY: NodeId = NodeId(2);
const OTHER: NodeId = NodeId(3);
const NUMBER: NodeId = NodeId(4);

fn nodes() -> Vec<Node> {
    let mut all: Vec<Node> = Vec::new();
    for kind in [NodeKind::Point, NodeKind::Slope, NodeKind::Frame, NodeKind::Frame, NodeKind::Scalars(1)] {
        let (q, v) = all.last().map_or((0, 0), |n| (n.coords().end, n.dofs().end));
        all.push(Node { kind, q, v, shared: false });
    }
    all
}

struct Numbers {
    q: Vec<f64>,
    v: Vec<f64>,
}

fn numbers(seed: u64) -> Numbers {
    let mut x = seed;
    let mut list = |n: usize| -> Vec<f64> {
        (0..n)
            .map(|_| {
                x = x.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                (x >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
            })
            .collect()
    };
    let mut s = Numbers { q: list(24), v: list(22) };
    for body in [12, 19] {
        let norm: f64 = s.q[body..body + 4].iter().map(|x| x * x).sum::<f64>().sqrt();
        s.q[body..body + 4].iter_mut().for_each(|x| *x /= norm);
    }
    s
}

fn on(node: NodeId) -> Marker {
    Marker::Node { node, point: [0.3, -0.4, 0.6], direction: [0.0, 1.0, 0.0] }
}

fn ship() -> Arc<dyn Motion> {
    Arc::new(Circle::new([1.0, 0.0, 0.0], Side::Left, 25.0, 7.7, 0.0, 5.0).unwrap())
}

fn joints() -> Vec<(Box<dyn Constraint>, bool)> {
    let n = nodes();
    let (node, ground) = (Marker::node, Marker::ground([0.3, -4.0, 0.5]));
    let heave: Arc<dyn Motion> = Arc::new(Harmonic::new([0.0, 0.1, 0.5], 0.2, 0.3, 0.0, 2.0).unwrap());
    vec![
        (Box::new(Spherical::joint("pin", &n, [node(POINT), node(CABLE)]).unwrap()), true),
        (Box::new(Spherical::joint("pin", &n, [ground, node(CABLE)]).unwrap()), true),
        (Box::new(Spherical::joint("pin", &n, [node(BODY), node(CABLE)]).unwrap()), true),
        (Box::new(Spherical::joint("hinge", &n, [on(BODY), node(CABLE)]).unwrap()), false),
        (Box::new(Spherical::joint("link", &n, [on(OTHER), on(BODY)]).unwrap()), false),
        (Box::new(Distance::joint("rod", &n, [node(POINT), node(CABLE)], 2.0).unwrap()), false),
        (Box::new(Distance::joint("rod", &n, [on(BODY), ground], 2.0).unwrap()), false),
        (Box::new(Clamp::joint("clamp", &n, CABLE, [1.0, 2.0, -3.0]).unwrap()), true),
        (Box::new(BodyClamp::joint("clamp", &n, CABLE, BODY, [1.0, 2.0, -3.0]).unwrap()), false),
        (Box::new(Driving::joint("ship", &n, node(CABLE), [1.0; 3], ship()).unwrap()), true),
        (Box::new(Driving::joint("ship", &n, on(BODY), [1.0; 3], heave.clone()).unwrap()), false),
        (
            Box::new(Coordinate::joint("plane", &n, node(POINT), [1.0, 1.0, 0.0], [1.0; 3], None).unwrap()),
            true,
        ),
        (
            Box::new(
                Coordinate::joint("heave", &n, on(BODY), [0.0, 1.0, 1.0], [1.0; 3], Some(heave)).unwrap(),
            ),
            false,
        ),
    ]
}

#[test]
fn derivatives_are_exact() {
    let mut worst = 0.0_f64;
    for seed in 1..=6 {
        let s = numbers(seed);
        let at = At { t: 1.3, q: &s.q, v: &s.v, a: &[0.0; 22], modes: &[], relaxed: None };
        for (joint, linear) in joints() {
            assert_eq!(joint.linear(), linear, "{}", joint.name());
            let error = check_constraint(&*joint, &nodes(), &at);
            assert!(error < 1e-7, "{} at state {seed}: {error}", joint.name());
            worst = worst.max(error);
        }
    }
    println!("joints: {worst:.1e}");
}

#[test]
fn clamp_holds_the_direction_and_leaves_the_stretch() {
    let nodes = nodes();
    let mut s = numbers(1);
    let clamp = Clamp::joint("clamp", &nodes, CABLE, [1.0, 2.0, -3.0]).unwrap();
    for (slope, held) in [([1.0, 2.0, -3.0], true), ([0.1, 0.2, -0.3], true), ([1.0, 2.0, -2.9], false)] {
        s.q[6..9].copy_from_slice(&slope);
        let at = At { t: 0.0, q: &s.q, v: &s.v, a: &s.v, modes: &[], relaxed: None };
        let (mut g, mut jac) = ([0.0; 2], [0.0; 12]);
        clamp.jacobian(&nodes, &at, &mut g, &mut jac);
        assert_eq!(g.iter().all(|g| g.abs() < 1e-14), held);
    }
}

#[test]
fn driven_joint_is_defined_for_as_long_as_its_motion() {
    let rows = [[0.0; 4], [1.0, 0.1, 0.0, 0.0], [3.0, 0.2, 0.0, 0.0]];
    let table: Arc<dyn Motion> = Arc::new(Table::new(&rows, Default::default()).unwrap());
    let joint = Driving::joint("ship", &nodes(), Marker::node(POINT), [0.0; 3], table.clone()).unwrap();
    assert_eq!(joint.range(), (0.0, 3.0));
    let plane = Coordinate::joint("x", &nodes(), Marker::node(POINT), [1.0, 0.0, 0.0], [0.0; 3], Some(table));
    assert_eq!(plane.unwrap().range(), (0.0, 3.0));
}

#[test]
fn what_holds_nothing_is_refused() {
    let n = nodes();
    let (node, ground) = (Marker::node, Marker::ground([0.0; 3]));
    assert!(Spherical::joint("j", &n, [ground, ground]).is_err());
    assert!(Spherical::joint("j", &n, [node(POINT), node(POINT)]).is_err());
    assert!(Spherical::joint("j", &n, [node(POINT), node(NUMBER)]).is_err());
    assert!(Spherical::joint("j", &n, [node(POINT), node(NodeId(77))]).is_err());
    assert!(Distance::joint("j", &n, [node(POINT), node(CABLE)], 0.0).is_err());
    assert!(Distance::joint("j", &n, [node(POINT), node(CABLE)], f64::NAN).is_err());
    assert!(Clamp::joint("j", &n, POINT, [1.0, 0.0, 0.0]).is_err());
    assert!(Clamp::joint("j", &n, CABLE, [0.0; 3]).is_err());
    assert!(BodyClamp::joint("j", &n, CABLE, POINT, [1.0, 0.0, 0.0]).is_err());
    assert!(Driving::joint("j", &n, ground, [0.0; 3], ship()).is_err());
    assert!(Driving::joint("j", &n, node(POINT), [f64::NAN; 3], ship()).is_err());
    assert!(Coordinate::joint("j", &n, node(POINT), [0.0; 3], [0.0; 3], None).is_err());
}
