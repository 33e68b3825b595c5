use super::*;
use crate::model::Start;
use crate::model::node::{Node, NodeKind};
use crate::model::pattern::Pattern;
use crate::model::state::At;
use crate::model::term::{Assembly, Term};
use crate::solve::integrator::{Scheme, prepare};

/// A free rigid body without forces, of three different moments of inertia.
struct Body;

const INERTIA: [f64; 3] = [1.0, 2.0, 3.5];

impl Term for Body {
    fn label(&self) -> String {
        "body".into()
    }
    fn pattern(&self, p: &mut Pattern) {
        p.clique(0..6);
    }
    fn symmetric(&self) -> bool {
        false
    }
    fn add(&self, at: &At<'_>, out: &mut Assembly<'_>) {
        let w = [at.v[3], at.v[4], at.v[5]];
        for i in 0..3 {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            out.add(i, at.a[i]);
            out.add(3 + i, INERTIA[i] * at.a[3 + i] + (INERTIA[k] - INERTIA[j]) * w[j] * w[k]);
        }
        let weights = out.weights();
        out.add_block(0, 6, |r, c| match (r, c) {
            (r, c) if r == c => weights.a * if r < 3 { 1.0 } else { INERTIA[r - 3] },
            (r, c) if r >= 3 && c >= 3 => {
                // the third axis beside those of row and column
                let (r, c) = (r - 3, c - 3);
                let other = 3 - r - c;
                let (j, k) = ((r + 1) % 3, (r + 2) % 3);
                weights.v * (INERTIA[k] - INERTIA[j]) * w[other]
            }
            _ => 0.0,
        });
    }
}

fn tumble(h: f64) -> Vec<f64> {
    let nodes = vec![Node { kind: NodeKind::Frame, q: 0, v: 0, shared: false }];
    let start = Start {
        q: vec![0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0],
        v: vec![1.0, 0.0, 0.0, 0.5, 0.7, 3.0],
        internal: vec![],
    };
    let model = Model::new(nodes, vec![Box::new(Body)], vec![], vec![], start, 1.0);
    let options = Options {
        scheme: Scheme::RadauIia5,
        stepping: Stepping::Fixed { h },
        newton_tolerance: 1e-4,
        ..Options::default()
    };
    let mut radau = Radau::new(&options, 2.0).unwrap();
    let mut work = Workspace::new(&model).unwrap();
    let mut state = model.state();
    prepare(&model, &mut state, &mut work, &radau).unwrap();
    while state.t < 2.0 - 1e-9 {
        let left = 2.0 - state.t;
        radau.step(&model, &mut state, &mut work, left).unwrap();
    }
    assert_eq!(work.counts.rejected, 0);
    // energy and momentum in space tell of errors without a reference
    let energy: f64 = (0..3).map(|i| 0.5 * INERTIA[i] * state.v[3 + i].powi(2)).sum();
    let start: f64 = (0..3).map(|i| 0.5 * INERTIA[i] * [0.5f64, 0.7, 3.0][i].powi(2)).sum();
    assert!((energy / start - 1.0).abs() < 1e3 * h.powi(5), "{energy} instead of {start}");
    [&state.q[3..], &state.v[3..]].concat()
}

#[test]
fn a_tumbling_body_is_followed_to_fifth_order() {
    let runs: Vec<Vec<f64>> = (0..4).map(|k| tumble(0.05 / 1.5f64.powi(k))).collect();
    let change = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    let changes: Vec<f64> = runs.windows(2).map(|w| change(&w[0], &w[1])).collect();
    let orders: Vec<f64> = changes.windows(2).map(|w| (w[0] / w[1]).ln() / 1.5f64.ln()).collect();
    println!("changes {changes:?}, orders {orders:.2?}");
    assert!(orders.iter().all(|o| *o > 4.5), "{orders:?}");
}
