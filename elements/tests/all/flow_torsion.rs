//! Torsion of cables through which material flows: derivatives, the balance of energy, what is at rest.

use crate::torsion::states;
use ropewalk_core::testing::{check_tangent, dense, difference};
use ropewalk_core::{At, Element, Node, NodeId, NodeKind, Pool, Term, Weights, Width, retract};
use ropewalk_elements::cable::flow::{Embedding, FlowTorsion};
use ropewalk_elements::cable::{Torsion, TorsionDamping, TorsionParams};

pub fn nodes(boundaries: usize) -> Vec<Node> {
    let mut all: Vec<Node> = Vec::new();
    for kind in [NodeKind::Twist, NodeKind::Twist, NodeKind::Scalars(1), NodeKind::Scalars(1)] {
        let (q, v) = all.last().map_or((0, 0), |n| (n.coords().end, n.dofs().end));
        all.push(Node { kind, q, v, shared: matches!(kind, NodeKind::Scalars(_)) });
    }
    all.truncate(2 + boundaries);
    all
}

pub fn pool<E: Element<Q, N>, const Q: usize, const N: usize>(
    element: E,
    boundaries: usize,
) -> Box<dyn Term> {
    let mut pool = Pool::new();
    let on: Vec<NodeId> = (0..2 + boundaries as u32).map(NodeId).collect();
    for _ in 0..3 {
        assert!(pool.push(&nodes(boundaries), element.clone(), &on));
    }
    Box::new(pool)
}

pub const ONE: Embedding<1> = Embedding { fixed: [0.4, 1.3], by: [[0.8, 0.35]] };
pub const TWO: Embedding<2> = Embedding { fixed: [0.02, 0.1], by: [[0.8, 0.35], [0.2, 0.65]] };
/// What comes in twisted at the start, and at both ends.
pub const COIL: Embedding<1> = Embedding { fixed: [0.3, 0.0], by: [[1.7, 0.0]] };
pub const COILS: Embedding<2> = Embedding { fixed: [0.3, -0.1], by: [[1.7, 0.0], [0.0, -2.1]] };

/// Wound up at its ends, with inertia and grip, or with elasticity and damping alone.
fn terms(rho_j: f64) -> Vec<(usize, Box<dyn Term>)> {
    let g = 0.6 * rho_j;
    let one = FlowTorsion {
        gj: 0.8,
        eta_gj: 0.3,
        rho_j,
        twist0: 0.4,
        by: ONE,
        turns: COIL,
        wound: [1.0, 0.0],
        grip: [g, 0.0],
    };
    let two = FlowTorsion {
        gj: 0.8,
        eta_gj: 0.3,
        rho_j,
        twist0: 0.4,
        by: TWO,
        turns: COILS,
        wound: [1.0, 1.0],
        grip: [g, 1.5 * g],
    };
    vec![(1, pool(one, 1)), (2, pool(two, 2))]
}

/// Coordinates, velocities and accelerations of an element in motion.
pub fn motion(q: &[f64], boundaries: usize) -> [Vec<f64>; 3] {
    let mut q = q[..20].to_vec();
    q.extend_from_slice(&[-0.3, 0.9][..boundaries]);
    let wave = |k: f64| (0..14 + boundaries).map(|i| (k * i as f64 + 0.3).sin()).collect::<Vec<f64>>();
    [q, wave(1.7), wave(2.9)]
}

pub fn at(x: &[Vec<f64>; 3]) -> At<'_> {
    At { t: 0.0, q: &x[0], v: &x[1], a: &x[2], internal: &[], relaxed: None }
}

#[test]
fn tangents_are_derivatives() {
    for q in states() {
        for (boundaries, term) in terms(0.0) {
            for width in [Width::One, Width::Eight] {
                let error =
                    check_tangent(term.as_ref(), &nodes(boundaries), &at(&motion(&q, boundaries)), width);
                println!("{boundaries}: {error:.1e}");
                assert!(error < 1e-7, "{boundaries}: {error}");
            }
        }
    }
}

/// Inertia and grip apart: they don't follow from a potential, and have no part in what tangents leave out.
#[test]
fn tangents_of_inertia_are_derivatives() {
    for q in states() {
        for ((boundaries, heavy), (_, light)) in terms(0.7).into_iter().zip(terms(0.0)) {
            let (x, nodes) = (motion(&q, boundaries), nodes(boundaries));
            let both = |x: &[Vec<f64>; 3], w: Weights| {
                [&heavy, &light].map(|term| dense(term.as_ref(), &nodes, &at(x), w, Width::One))
            };
            for (w, kind) in [([1.0, 0.0, 0.0], 0), ([0.0, 1.0, 0.0], 1), ([0.0, 0.0, 1.0], 2)] {
                let [(_, a), (_, b)] = both(&x, Weights { q: w[0], v: w[1], a: w[2] });
                for j in 0..14 + boundaries {
                    let exact = difference(|h| {
                        let mut moved = x.clone();
                        let d: Vec<f64> =
                            (0..14 + boundaries).map(|i| if i == j { h } else { 0.0 }).collect();
                        match kind {
                            0 => retract(&nodes, &x[0], &d, &mut moved[0]),
                            kind => moved[kind][j] += h,
                        }
                        let [(a, _), (b, _)] = both(&moved, Weights::default());
                        a.iter().zip(&b).map(|(a, b)| a - b).collect()
                    });
                    for i in 0..14 + boundaries {
                        let own = a[i][j] - b[i][j];
                        assert!(
                            (own - exact[i]).abs() < 1e-7 * (1.0 + own.abs()),
                            "{kind} {i} {j}: {own} {}",
                            exact[i]
                        );
                    }
                }
            }
        }
    }
}

/// What the forces do to the velocities is the change of the energy, less what is carried over the ends, and what is damped.
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
            assert!(off.abs() < 1e-8 * (1.0 + work.abs()), "{boundaries}: {off}");
            assert!(power.carried != 0.0 && power.dissipated > 0.0);
        }
    }
}

/// With boundaries that stay where they are it is the torsion of a cable that doesn't feed.
#[test]
fn what_does_not_feed_is_plain_torsion() {
    for q in states() {
        let still =
            [Embedding { by: [[0.0; 2]], fixed: [0.2, 0.9] }, Embedding { by: [[0.0; 2]], fixed: [0.0; 2] }];
        let flow = FlowTorsion {
            gj: 0.8,
            eta_gj: 0.3,
            rho_j: 0.7,
            twist0: 0.4,
            by: still[0],
            turns: still[1],
            wound: [0.0; 2],
            grip: [0.0; 2],
        };
        let l = 0.7;
        let plain = TorsionParams { l, gj: 0.8, rho_j: 0.7, twist0: 0.4 * l };
        let damping = TorsionDamping { l, eta_gj: 0.3 };
        let x = motion(&q, 1);
        let residual = |term: Box<dyn Term>| {
            dense(term.as_ref(), &nodes(1), &at(&x), Weights { q: 1.0, v: 0.5, a: 0.2 }, Width::One)
        };
        let (a, ka) = residual(pool(flow, 1));
        let (b, kb) = residual(pool::<_, 20, 14>(Torsion::new(plain), 0));
        let (c, kc) = residual(pool::<_, 20, 14>(damping, 0));
        for i in 0..14 {
            assert!((a[i] - b[i] - c[i]).abs() < 1e-12, "{i}: {} {}", a[i], b[i] + c[i]);
            for j in 0..14 {
                assert!((ka[i][j] - kb[i][j] - kc[i][j]).abs() < 1e-11, "{i} {j}");
            }
        }
    }
}
