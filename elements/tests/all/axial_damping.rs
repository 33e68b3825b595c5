//! Damping along a cable whose ends feed.

use ropewalk_core::testing::check_tangent;
use ropewalk_core::{At, Node, NodeId, NodeKind, Pool, Width};
use ropewalk_elements::cable::flow::{Embedding, FlowAxialDamping};
use ropewalk_elements::cable::{L4, LockingFree, quadrature::Rule};

type Damping = FlowAxialDamping<L4, <LockingFree as Rule>::Axial, 2>;

fn nodes() -> [Node; 4] {
    let node = |kind, q, shared| Node { kind, q, v: q, shared };
    [
        node(NodeKind::Slope, 0, false),
        node(NodeKind::Slope, 6, false),
        node(NodeKind::Scalars(1), 12, true),
        node(NodeKind::Scalars(1), 13, true),
    ]
}
fn pool(by: Embedding<2>) -> Pool<Damping, 14, 14> {
    let mut pool = Pool::new();
    assert!(pool.push(&nodes(), Damping::new(3.0, by, L4, LockingFree.axial()), &[0, 1, 2, 3].map(NodeId)));
    pool
}

#[test]
fn tangent_agrees_with_differences() {
    let q = [0.0, 0.1, 0.0, 0.9, 0.3, 0.2, 0.8, 0.3, 0.2, 1.1, -0.2, 0.1, -0.1, 1.2];
    let v = [0.1, -0.2, 0.3, 0.2, 0.1, -0.3, 0.4, 0.1, 0.2, -0.1, 0.3, 0.2, 0.7, -0.4];
    let at = At { t: 0.0, q: &q, v: &v, a: &[0.1; 14], internal: &[], relaxed: None };
    let by = Embedding { fixed: [0.05, -0.1], by: [[0.8, 0.3], [0.2, 0.7]] };
    assert!(check_tangent(&pool(by), &nodes(), &at, Width::One) < 1e-7);
}

/// Material that runs along a curve which stands still and is equally stretched at all points is not strained, though
/// the cubic itself stretches in between.
#[test]
fn a_curve_that_stands_still_strains_nothing_that_runs_along_it() {
    let (l, angle) = (0.6_f64, 0.6_f64);
    let (sin, cos) = angle.sin_cos();
    // symmetric about its middle, where the slope has to be one as at the ends: |1.5 Δ - (s_a + s_b)/4| = 1
    let half = 0.5 * angle;
    let chord = (1.0 + 0.5 * half.cos()) / 1.5;
    let end = [half.cos(), half.sin()].map(|x| x * l * chord);
    let q = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, end[0], end[1], 0.0, cos, sin, 0.0, 0.0, l];
    let mut v = [0.0; 14];
    (v[12], v[13]) = (5.0, 5.0);
    let at = At { t: 0.0, q: &q, v: &v, a: &[0.0; 14], internal: &[], relaxed: None };
    let by = Embedding { fixed: [0.0; 2], by: [[1.0, 0.0], [0.0, 1.0]] };
    let power = ropewalk_core::Term::power(&pool(by), &at).dissipated;
    assert!(power < 1e-24, "{power:e}");
    // and a stretch that changes along it does strain what runs there: ε' = 0.1/l
    let mut longer = q;
    (longer[9], longer[10]) = (1.1 * cos, 1.1 * sin);
    let at = At { q: &longer, ..at };
    assert!(ropewalk_core::Term::power(&pool(by), &at).dissipated > 0.1 * 3.0 * l * (5.0 * 0.1 / l).powi(2));
}
