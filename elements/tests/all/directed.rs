//! Bending with a direction: what it adds to the elastic element.

use crate::torsion::{L, nodes, states};
use ropewalk_core::{At, NodeId, Pool, Term};
use ropewalk_elements::cable::quadrature::Gauss2;
use ropewalk_elements::cable::{Cable, CableParams, Directed, DirectedParams, L4, LockingFree, Models, T3};

const EI: f64 = 6.78;
const ALL: [NodeId; 3] = [NodeId(0), NodeId(1), NodeId(2)];

fn elastic(nodes: &[ropewalk_core::Node]) -> impl Term {
    let mut pool = Pool::new();
    let params = CableParams { l: L, ea: 0.0, ei: EI, rho_a: 1.0 };
    // it sits on position and slope of nodes that know twist
    assert!(pool.push(nodes, Cable::new(params, Models::new(L4, T3, LockingFree)), &ALL[..2]));
    pool
}

fn directed(nodes: &[ropewalk_core::Node], ei_d: f64, kappa0: [[f64; 2]; 5]) -> impl Term {
    let mut pool = Pool::new();
    let params = DirectedParams { l: L, ei_d, ei_e: EI, gj: 0.8 * EI, eta_gj: 0.0, rho_j: 1e-3 };
    assert!(pool.push(nodes, Directed::new(params, kappa0, Gauss2), &ALL));
    pool
}

fn at(q: &[f64]) -> At<'_> {
    const STILL: [f64; 15] = [0.0; 15];
    At { t: 0.0, q, v: &STILL, a: &STILL, internal: &[], relaxed: None }
}

fn forces(term: &dyn Term, q: &[f64]) -> Vec<f64> {
    ropewalk_core::testing::dense(
        term,
        &nodes(),
        &at(q),
        ropewalk_core::Weights::default(),
        ropewalk_core::Width::One,
    )
    .0
}

#[test]
fn the_shape_as_laid_is_free_of_stress_and_the_sum_is_the_energy_of_both_curvatures() {
    let nodes = nodes();
    for (q, other) in states().into_iter().zip(states().into_iter().rev()) {
        let mut laid: [f64; 21] = std::array::from_fn(|i| q[i]);
        laid[20] = 0.0;
        let kappa0 = Directed::curvature(&laid, L, Gauss2);
        for ei_d in [EI, 3.0 * EI] {
            let both: [Box<dyn Term>; 2] =
                [Box::new(elastic(&nodes)), Box::new(directed(&nodes, ei_d, kappa0))];
            let energy = |q: &[f64]| both.iter().map(|t| t.energy(&at(q)).potential).sum::<f64>();
            // of another shape
            let mut now: [f64; 21] = std::array::from_fn(|i| other[i]);
            now[20] = 0.0;
            let kappa = Directed::curvature(&now, L, Gauss2);
            let exact: f64 = (0..2)
                .map(|k| {
                    let [d, e] = [0, 1].map(|i| kappa[k][i] - kappa0[k][i]);
                    0.5 * 0.5 * L * (ei_d * d * d + EI * e * e)
                })
                .sum();
            assert!((energy(&now) - exact).abs() < 1e-12 * exact, "{} {exact}", energy(&now));
            assert!(energy(&laid).abs() < 1e-12 * exact);
            let [one, two] = both.each_ref().map(|t| forces(t.as_ref(), &laid));
            let size = one.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            for (a, b) in one.iter().zip(&two) {
                assert!((a + b).abs() < 1e-12 * size, "{a} {b}");
            }
        }
    }
}
