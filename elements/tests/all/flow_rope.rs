//! Ropes and shafts through which material flows: torque with tension, gyroscopic forces.

use crate::flow_torsion::{COIL, COILS, ONE, TWO, at, motion, nodes, pool};
use crate::torsion::states;
use ropewalk_core::testing::{check_tangent, dense, difference};
use ropewalk_core::{Node, Term, V3, Weights, Width, retract};
use ropewalk_elements::cable::flow::{Embedding, FlowSpin, FlowTorqueTension, Grid, Transport};
use ropewalk_elements::cable::quadrature::{Lobatto3, Quadrature};
use ropewalk_elements::cable::{SpinInertia, TorqueTension, Torsion, TorsionParams};

const GJ: f64 = 0.8;
const LAY: f64 = 1.3;
const RHO_J: f64 = 0.7;

fn ropes() -> Vec<(usize, Box<dyn Term>)> {
    let points = Lobatto3.points();
    let one =
        FlowTorqueTension { gj: GJ, lay: LAY, twist0: 0.4, by: ONE, turns: COIL, open: [1.0, 0.0], points };
    let two =
        FlowTorqueTension { gj: GJ, lay: LAY, twist0: 0.4, by: TWO, turns: COILS, open: [0.0, 1.0], points };
    vec![(1, pool(one, 1)), (2, pool(two, 2))]
}

fn shafts() -> Vec<(usize, Box<dyn Term>)> {
    let one = FlowSpin { rho_j: RHO_J, by: ONE, turns: COIL };
    let two = FlowSpin { rho_j: RHO_J, by: TWO, turns: COILS };
    vec![(1, pool(one, 1)), (2, pool(two, 2))]
}

fn work(term: &dyn Term, nodes: &[Node], x: &[Vec<f64>; 3]) -> f64 {
    let (f, _) = dense(term, nodes, &at(x), Weights::default(), Width::One);
    f.iter().zip(&x[1]).map(|(f, v)| f * v).sum()
}

#[test]
fn tangents_of_ropes_are_derivatives() {
    for q in states() {
        for (boundaries, term) in ropes() {
            let error =
                check_tangent(term.as_ref(), &nodes(boundaries), &at(&motion(&q, boundaries)), Width::One);
            assert!(error <= 1e-7, "{boundaries}: {error}");
        }
    }
}

#[test]
fn a_rope_keeps_its_energy_but_for_what_passes_the_ends() {
    for q in states() {
        for (boundaries, term) in ropes() {
            let (x, nodes) = (motion(&q, boundaries), nodes(boundaries));
            let work = work(term.as_ref(), &nodes, &x);
            let grows = difference(|h| {
                let d: Vec<f64> = x[1].iter().map(|v| h * v).collect();
                let mut moved = x.clone();
                retract(&nodes, &x[0], &d, &mut moved[0]);
                vec![term.energy(&at(&moved)).potential]
            })[0];
            let carried = term.power(&at(&x)).carried;
            let off = work - (grows - carried);
            println!("{boundaries}: {work} {grows} {carried}: {off:.1e}");
            assert!(off.abs() <= 1e-8 * (1.0 + work.abs()) && carried != 0.0, "{boundaries}: {off}");
        }
    }
}

/// At an instant the forces on the nodes are those of a rope of that length, less those of its torsion.
#[test]
fn a_rope_that_feeds_is_at_each_instant_one_of_that_length() {
    for q in states() {
        let (fixed, l) = ([0.2, 0.9], 0.7);
        let (by, turns) =
            (Embedding { by: [[0.0; 2]], fixed }, Embedding { by: [[0.0; 2]], fixed: [0.0; 2] });
        let points = Lobatto3.points();
        let flow = FlowTorqueTension { gj: GJ, lay: LAY, twist0: 0.4, by, turns, open: [0.0; 2], points };
        let params = TorsionParams { l, gj: GJ, rho_j: RHO_J, twist0: 0.4 * l };
        let x = motion(&q, 1);
        let w = Weights { q: 1.0, v: 0.5, a: 0.2 };
        let of = |term: Box<dyn Term>, n: usize| dense(term.as_ref(), &nodes(n), &at(&x), w, Width::One);
        let (a, ka) = of(pool(flow, 1), 1);
        let (b, kb) = of(pool::<_, 20, 14>(TorqueTension { params, lay: LAY, strain0: 0.0, points }, 0), 0);
        let (c, kc) = of(pool::<_, 20, 14>(Torsion::new(params), 0), 0);
        for i in 0..14 {
            assert!(
                (a[i] - (b[i] - c[i])).abs() <= 1e-11 * (1.0 + b[i].abs()),
                "{i}: {} {}",
                a[i],
                b[i] - c[i]
            );
            for j in 0..14 {
                let own = kb[i][j] - kc[i][j];
                assert!((ka[i][j] - own).abs() <= 1e-10 * (1.0 + own.abs()), "{i} {j}");
            }
        }
    }
}

#[test]
fn tangents_of_shafts_are_derivatives() {
    for q in states() {
        for (boundaries, term) in shafts() {
            let (x, nodes) = (motion(&q, boundaries), nodes(boundaries));
            for (w, kind) in [([1.0, 0.0, 0.0], 0), ([0.0, 1.0, 0.0], 1), ([0.0, 0.0, 1.0], 2)] {
                let w = Weights { q: w[0], v: w[1], a: w[2] };
                let (_, k) = dense(term.as_ref(), &nodes, &at(&x), w, Width::One);
                for j in 0..14 + boundaries {
                    let exact = difference(|h| {
                        let mut moved = x.clone();
                        let d: Vec<f64> =
                            (0..14 + boundaries).map(|i| if i == j { h } else { 0.0 }).collect();
                        match kind {
                            0 => retract(&nodes, &x[0], &d, &mut moved[0]),
                            kind => moved[kind][j] += h,
                        }
                        dense(term.as_ref(), &nodes, &at(&moved), Weights::default(), Width::One).0
                    });
                    for i in 0..14 + boundaries {
                        let off = k[i][j] - exact[i];
                        assert!(off.abs() <= 1e-7 * (1.0 + k[i][j].abs()), "{kind} {i} {j}: {off}");
                    }
                }
            }
        }
    }
}

/// They do no work, and on the nodes they are those of a shaft that doesn't feed and moves like the material.
#[test]
fn a_shaft_that_feeds_is_turned_aside_as_its_material_is() {
    for q in states() {
        for (boundaries, term) in shafts() {
            let (x, nodes) = (motion(&q, boundaries), nodes(boundaries));
            let (f, _) = dense(term.as_ref(), &nodes, &at(&x), Weights::default(), Width::One);
            let work = work(term.as_ref(), &nodes, &x);
            assert!(work.abs() <= 1e-12 * f.iter().map(|f| f.abs()).sum::<f64>(), "{boundaries}: {work}");
            let of = |k: usize| -> Vec<f64> { x[k][x[k].len() - boundaries..].to_vec() };
            let (p, v, a) = (of(0), of(1), of(2));
            let (grid, turns) = match boundaries {
                1 => (Grid::of(&ONE, [p[0]], [v[0]], [a[0]]), Grid::of(&COIL, [p[0]], [v[0]], [a[0]])),
                _ => (
                    Grid::of(&TWO, [p[0], p[1]], [v[0], v[1]], [a[0], a[1]]),
                    Grid::of(&COILS, [p[0], p[1]], [v[0], v[1]], [a[0], a[1]]),
                ),
            };
            let three = |x: &[f64], i: usize| -> V3<f64> { [x[i], x[i + 1], x[i + 2]] };
            let e = [0, 3, 10, 13].map(|i| three(&x[0], i));
            let rate = [0, 3, 7, 10].map(|i| three(&x[1], i));
            let material = Transport::new(&grid, &e, &rate, &[[0.0; 3]; 4]).v;
            let mut nodes_q = [0.0; 20];
            nodes_q.copy_from_slice(&x[0][..20]);
            let k = (Torsion::twist(&nodes_q, grid.l) + turns.l) / grid.l;
            let mut same = [x[0][..20].to_vec(), x[1][..14].to_vec(), vec![0.0; 14]];
            for i in 0..2 {
                same[1][7 * i..7 * i + 3].copy_from_slice(&material[2 * i]);
                same[1][7 * i + 3..7 * i + 6].copy_from_slice(&material[2 * i + 1]);
                same[1][7 * i + 6] = x[1][7 * i + 6] + turns.pd[i] - grid.pd[i] * k;
            }
            let still = pool::<_, 20, 14>(SpinInertia { l: grid.l, rho_j: RHO_J }, 0);
            let nodes = crate::flow_torsion::nodes(0);
            let (own, _) = dense(still.as_ref(), &nodes, &at(&same), Weights::default(), Width::One);
            for i in 0..14 {
                assert!((f[i] - own[i]).abs() <= 1e-12 * (1.0 + own[i].abs()), "{i}: {} {}", f[i], own[i]);
            }
        }
    }
}
