//! Joints: Jacobian, geometric stiffness, rates and bias against differences.

use ropewalk_constraints::motion::{Circle, Harmonic, Side, Table};
use ropewalk_constraints::{
    coordinate, cylindrical, direction, distance, driving, perpendicular, point_on_line, point_on_plane,
    prismatic, revolute, rotation, slide, spherical, universal, weld,
};
use ropewalk_core::rotation::around;
use ropewalk_core::testing::check_constraint;
use ropewalk_core::{
    At, BuildError, Constraint, Jet, Joint, Marker, Motion, Node, NodeId, NodeKind, Place, Related, Relation,
    RowKind,
};
use std::sync::Arc;

const POINT: NodeId = NodeId(0);
const CABLE: NodeId = NodeId(1);
const BODY: NodeId = NodeId(2);
const OTHER: NodeId = NodeId(3);
const NUMBER: NodeId = NodeId(4);
/// Cables with torsion.
const WIRE: NodeId = NodeId(5);
const ROD: NodeId = NodeId(6);
const VELOCITIES: usize = 36;

fn nodes() -> Vec<Node> {
    let mut all: Vec<Node> = Vec::new();
    for kind in [
        NodeKind::Point,
        NodeKind::Slope,
        NodeKind::Frame,
        NodeKind::Frame,
        NodeKind::Scalars(1),
        NodeKind::Twist,
        NodeKind::Twist,
    ] {
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
    let mut s = Numbers { q: list(44), v: list(VELOCITIES) };
    for body in [12, 19] {
        let norm: f64 = s.q[body..body + 4].iter().map(|x| x * x).sum::<f64>().sqrt();
        s.q[body..body + 4].iter_mut().for_each(|x| *x /= norm);
    }
    for cable in [24, 34] {
        let three = |i: usize| [s.q[cable + i], s.q[cable + i + 1], s.q[cable + i + 2]];
        let node = ropewalk_core::model::twist::laid(&three(0), &three(3), &three(6), s.q[cable + 9]);
        s.q[cable..cable + 10].copy_from_slice(&node);
    }
    s
}

fn on(node: NodeId) -> Marker {
    Marker::Node { node, point: [0.3, -0.4, 0.6], axes: around([0.2, 1.0, -0.7]) }
}

fn ground() -> Marker {
    Marker::Ground { point: [0.3, -4.0, 0.5], axes: around([1.0, 2.0, -3.0]) }
}

fn ship() -> Arc<dyn Motion> {
    Arc::new(Circle::new([1.0, 0.0, 0.0], Side::Left, 25.0, 7.7, 0.0, 5.0).unwrap())
}

fn heave() -> Arc<dyn Motion> {
    Arc::new(Harmonic::new([0.4, 0.1, 0.5], 0.2, 0.3, 0.0, 2.0).unwrap())
}

type Make = fn(&'static str, &[Node], [Marker; 2]) -> Result<Joint, BuildError>;

/// Every joint between every kind of marker that it can hold, and whether it is linear.
fn joints() -> Vec<(Joint, bool)> {
    let n = nodes();
    let node = Marker::node;
    let mut all = vec![
        (spherical("pin", &n, [node(POINT), node(CABLE)]), true),
        (spherical("pin", &n, [ground(), node(CABLE)]), true),
        (spherical("pin", &n, [node(BODY), node(CABLE)]), true),
        (spherical("hinge", &n, [on(BODY), node(CABLE)]), false),
        (spherical("link", &n, [on(OTHER), on(BODY)]), false),
        (distance("rod", &n, [node(POINT), node(CABLE)], 2.0), false),
        (distance("rod", &n, [on(BODY), ground()], 2.0), false),
        (distance("rod", &n, [on(BODY), on(OTHER)], 2.0), false),
        (direction("direction", &n, CABLE, ground()), true),
        (direction("direction", &n, CABLE, on(BODY)), false),
        (driving("ship", &n, [ground(), node(CABLE)], ship()), true),
        (driving("ship", &n, [ground(), on(BODY)], heave()), false),
        (coordinate("plane", &n, [ground(), node(POINT)], [1.0, 1.0, 0.0], None), true),
        (coordinate("heave", &n, [ground(), on(BODY)], [0.0, 1.0, 1.0], Some(heave())), false),
        (slide("ram", &n, [on(OTHER), on(BODY)], 0.3, heave()), false),
        (slide("ram", &n, [ground(), node(CABLE)], 0.3, heave()), true),
        (rotation("crank", &n, [on(OTHER), on(BODY)], heave()), false),
        (rotation("crank", &n, [ground(), on(BODY)], heave()), false),
        (rotation("crank", &n, [ground(), node(CABLE)], heave()), true),
    ];
    let free: [Make; 4] = [
        |name, n, m| revolute(name, n, m),
        |name, n, m| universal(name, n, m),
        |name, n, m| weld(name, n, m),
        |name, n, m| perpendicular(name, n, m),
    ];
    for make in free {
        all.push((make("bodies", &n, [on(OTHER), on(BODY)]), false));
        all.push((make("body on ground", &n, [ground(), on(BODY)]), false));
        all.push((make("cable on body", &n, [on(BODY), node(CABLE)]), false));
        all.push((make("body on cable", &n, [node(CABLE), on(BODY)]), false));
        all.push((make("cable on ground", &n, [ground(), node(CABLE)]), true));
        all.push((make("section on body", &n, [on(BODY), on(WIRE)]), false));
        all.push((make("body on section", &n, [on(WIRE), on(BODY)]), false));
        all.push((make("section on ground", &n, [ground(), on(WIRE)]), false));
        all.push((make("two sections", &n, [on(WIRE), on(ROD)]), false));
    }
    let sliding: [Make; 4] = [
        |name, n, m| prismatic(name, n, m),
        |name, n, m| cylindrical(name, n, m),
        |name, n, m| point_on_line(name, n, m),
        |name, n, m| point_on_plane(name, n, m),
    ];
    for make in sliding {
        all.push((make("slider", &n, [on(OTHER), on(BODY)]), false));
        all.push((make("slider on ground", &n, [ground(), on(BODY)]), false));
    }
    all.push((direction("swivel", &n, WIRE, ground()), true));
    all.push((direction("swivel", &n, WIRE, on(BODY)), false));
    all.push((rotation("turn", &n, [ground(), on(WIRE)], heave()), false));
    all.push((rotation("turn", &n, [on(ROD), on(WIRE)], heave()), false));
    all.push((distance("lever", &n, [on(ROD), on(WIRE)], 2.0), false));
    all.push((spherical("pin", &n, [ground(), node(WIRE)]), true));
    all.push((point_on_line("bead", &n, [ground(), node(CABLE)]), true));
    all.into_iter().map(|(joint, linear)| (joint.unwrap(), linear)).collect()
}

#[test]
fn derivatives_are_exact() {
    let mut worst = 0.0_f64;
    for seed in 1..=6 {
        let s = numbers(seed);
        let at = At { t: 1.3, q: &s.q, v: &s.v, a: &[0.0; VELOCITIES], internal: &[], relaxed: None };
        for (joint, linear) in joints() {
            assert_eq!(joint.linear(), linear, "{}", joint.name());
            let error = check_constraint(&joint, &nodes(), &at);
            assert!(error < 1e-7, "{} at state {seed}: {error}", joint.name());
            worst = worst.max(error);
        }
    }
    println!("joints: {worst:.1e}");
}

/// A hinge written as a relation, whose derivatives come from forward differentiation.
struct Hinge;
impl Relation for Hinge {
    fn rows(&self) -> Vec<RowKind> {
        [vec![RowKind::Position; 3], vec![RowKind::Direction; 2]].concat()
    }
    fn g<S: Jet>(&self, _: S, at: &[Place<S>], g: &mut [S]) {
        for i in 0..3 {
            g[i] = at[1].x[i] - at[0].x[i];
        }
        for k in 0..2 {
            g[3 + k] = (0..3).map(|i| at[0].axes[2][i] * at[1].axes[k][i]).fold(S::zero(), |a, b| a + b);
        }
    }
}

#[test]
fn closed_forms_agree_with_forward_differentiation() {
    let n = nodes();
    // the relation orders its nodes by number
    for (markers, columns) in [([on(BODY), on(OTHER)], 12), ([on(WIRE), on(ROD)], 14)] {
        let (closed, dual) =
            (revolute("hinge", &n, markers).unwrap(), Related::new("hinge", Hinge, markers.to_vec()));
        for seed in 1..=6 {
            let s = numbers(seed);
            let at = At { t: 1.3, q: &s.q, v: &s.v, a: &[0.0; VELOCITIES], internal: &[], relaxed: None };
            let all = |c: &dyn Constraint| {
                let (mut jac, mut h) = (vec![0.0; 5 * columns], vec![0.0; columns * columns]);
                let (mut g, mut rate, mut bias) = ([0.0; 5], [0.0; 5], [0.0; 5]);
                c.jacobian(&n, &at, &mut g, &mut jac);
                c.geometric(&n, &at, &[1.0, -2.0, 0.5, 3.0, -1.5], &mut h);
                c.rates(&n, &at, &mut rate, &mut bias);
                [&g[..], &jac, &h, &rate, &bias].concat()
            };
            for (a, b) in all(&closed).iter().zip(all(&dual)) {
                assert!((a - b).abs() < 1e-13 * (1.0 + b.abs()), "{a} {b}");
            }
        }
    }
}

#[test]
fn the_direction_is_held_and_the_stretch_is_free() {
    let nodes = nodes();
    let mut s = numbers(1);
    let tangent = direction("direction", &nodes, CABLE, ground()).unwrap();
    for (slope, held) in [([1.0, 2.0, -3.0], true), ([0.1, 0.2, -0.3], true), ([1.0, 2.0, -2.9], false)] {
        s.q[6..9].copy_from_slice(&slope);
        let at = At { t: 0.0, q: &s.q, v: &s.v, a: &s.v, internal: &[], relaxed: None };
        let (mut g, mut jac) = ([0.0; 2], [0.0; 12]);
        tangent.jacobian(&nodes, &at, &mut g, &mut jac);
        assert_eq!(g.iter().all(|g| g.abs() < 1e-14), held);
    }
}

#[test]
fn driven_joint_is_defined_for_as_long_as_its_motion() {
    let rows = [[0.0; 4], [1.0, 0.1, 0.0, 0.0], [3.0, 0.2, 0.0, 0.0]];
    let table: Arc<dyn Motion> =
        Arc::new(Table::new(&rows, ropewalk_core::Join::Cubic, Default::default()).unwrap());
    let joint = driving("ship", &nodes(), [ground(), Marker::node(POINT)], table.clone()).unwrap();
    assert_eq!(joint.range(), (0.0, 3.0));
    let plane = coordinate("x", &nodes(), [ground(), Marker::node(POINT)], [1.0, 0.0, 0.0], Some(table));
    assert_eq!(plane.unwrap().range(), (0.0, 3.0));
}

#[test]
fn what_holds_nothing_is_refused() {
    let n = nodes();
    let node = Marker::node;
    let joints: [Make; 5] = [
        |a, b, c| spherical(a, b, c),
        |a, b, c| revolute(a, b, c),
        |a, b, c| weld(a, b, c),
        |a, b, c| universal(a, b, c),
        |a, b, c| prismatic(a, b, c),
    ];
    for make in joints {
        assert!(make("j", &n, [ground(), ground()]).is_err());
        assert!(make("j", &n, [on(BODY), node(BODY)]).unwrap_err().to_string().contains("same body"));
        assert!(make("j", &n, [on(BODY), node(NUMBER)]).is_err());
        assert!(make("j", &n, [on(BODY), node(NodeId(77))]).is_err());
    }
    for make in &joints[1..] {
        assert!(make("j", &n, [on(BODY), node(POINT)]).unwrap_err().to_string().contains("no axis"));
    }
    assert!(distance("j", &n, [node(POINT), node(CABLE)], 0.0).is_err());
    assert!(distance("j", &n, [node(POINT), node(CABLE)], f64::NAN).is_err());
    assert!(direction("j", &n, POINT, ground()).is_err());
    assert!(direction("j", &n, CABLE, node(POINT)).is_err());
    assert!(driving("j", &n, [ground(), ground()], ship()).is_err());
    assert!(driving("j", &n, [Marker::ground([f64::NAN; 3]), node(POINT)], ship()).is_err());
    assert!(coordinate("j", &n, [ground(), node(POINT)], [0.0; 3], None).is_err());
}
