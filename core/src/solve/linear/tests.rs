use super::*;
use crate::model::node::{Node, NodeId, NodeKind};
use crate::model::order::Rows;
use crate::model::pattern::Pattern;
use samples::{Rng, Sample};

/// A chain of slope nodes, held at both ends, with slopes `stiff` times stiffer than positions, and so many unknowns
/// that all elements share.
fn chain_with(n: usize, shared: usize, stiff: f64, symmetric: bool) -> (Structure, Vec<f64>) {
    let node = |kind, v, shared| Node { kind, q: v, v, shared };
    let mut nodes: Vec<Node> = (0..n).map(|k| node(NodeKind::Slope, 6 * k, false)).collect();
    if shared > 0 {
        nodes.push(node(NodeKind::Scalars(shared), 6 * n, true));
    }
    let nv = 6 * n + shared;
    let mut p = Pattern::default();
    for k in 0..n - 1 {
        p.clique((6 * k..6 * k + 12).chain(6 * n..nv));
    }
    p.clique((0..3).chain(nv..nv + 3));
    p.clique((6 * n - 6..6 * n - 3).chain(nv + 3..nv + 6));
    let rows =
        |k: usize| Rows { count: 3, nodes: vec![NodeId(k as u32)], jacobian: Vec::new(), behind: Vec::new() };
    let rows = [rows(0), rows(n - 1)];
    let s = Structure::new(&nodes, &rows, &p, symmetric);
    assert!(s.chain && s.border == shared);
    let mut values = vec![0.0; s.entries()];
    let mut rng = Rng(0x9E37_79B9_7F4A_7C15);
    let scale = |i: usize| if i % 6 < 3 { 1.0 } else { stiff };
    let mut add = |clique: usize, i: usize, j: usize, v: f64| {
        let (i, j) = (p.get(clique)[i] as usize, p.get(clique)[j] as usize);
        values[s.slot(s.position[i], s.position[j])] += v;
    };
    let size = 12 + shared;
    for e in 0..n - 1 {
        let a: Vec<f64> = (0..size * size).map(|_| rng.next()).collect();
        for i in 0..size {
            for j in 0..if symmetric { i + 1 } else { size } {
                let dot: f64 = (0..size).map(|k| a[size * i + k] * a[size * j + k]).sum();
                let twist = if symmetric { 0.0 } else { 0.2 * (i as f64 - j as f64).sin() };
                let v = dot + twist + if i == j { 0.5 } else { 0.0 };
                add(e, i, j, v * scale(i) * scale(j));
            }
        }
    }
    for clique in [n - 1, n] {
        for i in 0..3 {
            add(clique, 3 + i, i, 1.0);
            if !symmetric {
                add(clique, i, 3 + i, 1.0);
            }
        }
    }
    (s, values)
}

fn chain(n: usize, stiff: f64, symmetric: bool) -> (Structure, Vec<f64>) {
    chain_with(n, 0, stiff, symmetric)
}

#[test]
fn sparse_solvers_agree_with_the_dense_oracle() {
    for symmetric in [true, false] {
        for (stiff, shared) in [(1.0, 0), (1e3, 0), (1.0, 1), (1e3, 3)] {
            let (s, values) = chain_with(12, shared, stiff, symmetric);
            let b: Vec<f64> = (0..s.n).map(|i| 1.0 + (i % 7) as f64).collect();
            let mut exact = b.clone();
            let mut dense = Guard::with(&s, Box::new(Dense::default())).unwrap();
            dense.factor(&s, &values).unwrap();
            dense.solve(&s, &values, &mut exact).unwrap();
            let solvers: Vec<Box<dyn LinearSolver>> = vec![
                Box::new(Lu::default()),
                Box::new(Fronts::<f64>::default()),
                Box::new(Chain::<f64>::default()),
            ];
            for solver in solvers {
                let mut guard = Guard::with(&s, solver).unwrap();
                // twice: the second solve goes without the check
                guard.factor(&s, &values).unwrap();
                for _ in 0..2 {
                    let mut x = b.clone();
                    guard.solve(&s, &values, &mut x).unwrap();
                    assert_eq!(guard.fallbacks, 0, "{}", guard.name());
                    for i in 0..s.n {
                        approx::assert_relative_eq!(x[i], exact[i], max_relative = 1e-7, epsilon = 1e-9);
                    }
                }
                if let Some(negative) = guard.negative_pivots().filter(|_| symmetric) {
                    assert_eq!(negative, 6, "one negative pivot for each constraint row: {}", guard.name());
                }
            }
        }
    }
}

#[test]
fn trees_nets_and_hubs_agree_with_the_dense_oracle() {
    for sample in [Sample::tree(2), Sample::net(2), Sample::hub(4)] {
        for (symmetric, twist) in [(true, 0.0), (false, 0.0), (false, 0.3)] {
            let (s, values) = sample.build::<f64>(symmetric, 0.0, twist);
            assert!(!s.chain);
            let b: Vec<f64> = (0..s.n).map(|i| 1.0 + (i % 7) as f64).collect();
            let mut exact = b.clone();
            let mut dense = Guard::with(&s, Box::new(Dense::default())).unwrap();
            dense.factor(&s, &values).unwrap();
            dense.solve(&s, &values, &mut exact).unwrap();
            let mut guard = Guard::new(&s).unwrap();
            // factors of another matrix leave nothing behind
            let other: Vec<f64> = values.iter().map(|v| 3.0 * v).collect();
            for values in [&other, &values] {
                guard.factor(&s, values).unwrap();
            }
            let mut x = b.clone();
            guard.solve(&s, &values, &mut x).unwrap();
            assert_eq!(guard.fallbacks, 0);
            for i in 0..s.n {
                approx::assert_relative_eq!(x[i], exact[i], max_relative = 1e-8, epsilon = 1e-10);
            }
            if twist == 0.0 {
                assert_eq!(guard.negative_pivots(), Some(sample.multipliers()));
            }
        }
    }
}

#[test]
fn complex_elimination_agrees_with_the_real_system_of_twice_the_size() {
    for symmetric in [true, false] {
        let net = Sample::net(2).build(symmetric, 0.0, if symmetric { 0.0 } else { 0.2 });
        for (s, re) in [chain(5, 1.0, symmetric), net] {
            let im: Vec<f64> = re.iter().enumerate().map(|(k, v)| 0.3 * v * (k as f64).cos()).collect();
            let values: Vec<c64> = re.iter().zip(&im).map(|(&re, &im)| c64 { re, im }).collect();
            let b: Vec<c64> =
                (0..s.n).map(|i| c64 { re: 1.0 + (i % 7) as f64, im: (i % 3) as f64 }).collect();
            let mut solvers: Vec<Box<dyn LinearSolver<c64>>> = vec![Box::new(Fronts::default())];
            if s.chain {
                solvers.push(Box::new(Chain::default()));
            }
            for mut solver in solvers {
                solver.analyse(&s).unwrap();
                solver.factor(&s, &values).unwrap();
                let mut x = b.clone();
                solver.solve(&mut x);
                // (A + iB)(x + iy) by the real product
                let part = |f: fn(&c64) -> f64| x.iter().map(f).collect::<Vec<f64>>();
                let (xr, xi) = (part(|z| z.re), part(|z| z.im));
                let product = |a: &[f64], x: &[f64]| {
                    let mut y = vec![0.0; s.n];
                    s.multiply(a, x, &mut y);
                    y
                };
                let (rr, ii) = (product(&re, &xr), product(&im, &xi));
                let (ri, ir) = (product(&re, &xi), product(&im, &xr));
                for i in 0..s.n {
                    approx::assert_relative_eq!(rr[i] - ii[i], b[i].re, epsilon = 1e-9);
                    approx::assert_relative_eq!(ri[i] + ir[i], b[i].im, epsilon = 1e-9);
                }
            }
        }
    }
}

/// Factors and solves with some right-hand side. Gives the growth (infinite where a pivot vanishes), what the check says of the solution without it, and
/// what it says of the one that the guard lets through.
fn errors<T: Scalar>(s: &Structure, values: &[T]) -> (f64, f64, f64) {
    let b: Vec<T> = (0..s.n).map(|i| T::from((i as f64).sin())).collect();
    let mut check = Check::new(s.n);
    let mut guard = Guard::suiting(s).unwrap();
    guard.factor(s, values).unwrap();
    let (mut growth, mut raw) = (f64::INFINITY, f64::INFINITY);
    if !guard.use_fallback {
        growth = guard.primary.growth();
        let mut x = b.clone();
        guard.primary.solve(&mut x);
        raw = check.error(s, values, &x, &b, 0.0);
    }
    let mut x = b.clone();
    guard.solve(s, values, &mut x).unwrap();
    (growth, raw, check.error(s, values, &x, &b, 0.0))
}

#[test]
fn what_goes_unchecked_is_right_and_the_rest_is_mended() {
    let (mut unchecked, mut checked, mut bad) = (0, 0, 0);
    for seed in 0..40 {
        // from definite to compressed far beyond buckling
        for soft in [0.0, 0.6, 1.0, 1.5, 3.0] {
            for (symmetric, twist) in [(true, 0.0), (false, 0.5)] {
                let mut sample = [Sample::line(12), Sample::tree(2), Sample::net(1), Sample::hub(3)]
                    [seed as usize % 4]
                    .clone();
                sample.seed = seed;
                let (s, values) = sample.build::<f64>(symmetric, soft, twist);
                let (growth, raw, error) = errors(&s, &values);
                assert!(error < 1e-9, "seed {seed}, soft {soft}: {error:e} is let through");
                if growth <= HARMLESS {
                    unchecked += 1;
                    assert!(raw < 1e-12, "seed {seed}, soft {soft}: growth {growth:e}, but error {raw:e}");
                } else {
                    checked += 1;
                    bad += usize::from(raw > 1e-12);
                }
            }
        }
    }
    assert!(unchecked > 50 && checked > 50 && bad > 0, "{unchecked} unchecked, {checked} checked, {bad} bad");
}

/// A dense matrix over plain numbers, of which the last are multipliers.
fn small<const N: usize>(multipliers: usize, a: [[f64; N]; N], symmetric: bool) -> (Structure, Vec<f64>) {
    let free = N - multipliers;
    let nodes = [Node { kind: NodeKind::Scalars(free), q: 0, v: 0, shared: false }];
    let rows =
        [Rows { count: multipliers, nodes: vec![NodeId(0)], jacobian: Vec::new(), behind: Vec::new() }];
    let mut p = Pattern::default();
    p.clique(0..N);
    let s = Structure::new(&nodes, &rows[..multipliers.min(1)], &p, symmetric);
    let mut values = vec![0.0; s.entries()];
    for i in 0..N {
        for j in if symmetric { i } else { 0 }..N {
            values[s.slot(i, j)] = a[i][j];
        }
    }
    (s, values)
}

#[test]
fn tiny_pivots_are_seen_whatever_they_spoil() {
    for symmetric in [true, false] {
        for k in 1..18 {
            let tiny = 0.1_f64.powi(k);
            for a in [
                [[tiny, 1.0, 0.5], [1.0, 1.0, 0.3], [0.5, 0.3, 2.0]],
                [[-tiny, 2.0, 0.5], [2.0, 1.0, 1.0], [0.5, 1.0, 1.0]],
                // one by cancellation
                [[1.0, 1.0, 1.0], [1.0, 1.0 + tiny, 2.0], [1.0, 2.0, 1.0]],
            ] {
                let (s, values) = small(0, a, symmetric);
                let (growth, _, error) = errors(&s, &values);
                assert!(growth > 0.1 / tiny, "{a:?}: growth {growth:e}");
                assert!(error < 1e-9, "{a:?}: {error:e}");
            }
            // a constraint that says nearly the same as another
            let a = [[1.0, 1.0, 1.0], [1.0, -tiny, 0.0], [1.0, 0.0, -tiny]];
            let (s, values) = small(2, a, symmetric);
            let (growth, _, error) = errors(&s, &values);
            assert!(growth > 0.1 / tiny && error < 1e-9, "{growth:e}, {error:e}");
        }
    }
}

#[test]
fn definite_matrices_do_not_grow_however_stiff_they_are() {
    for symmetric in [true, false] {
        for stiff in [1.0, 1e3, 1e6] {
            let (s, values) = chain(12, stiff, symmetric);
            let (growth, _, error) = errors(&s, &values);
            assert!(growth < HARMLESS && error < 1e-9, "growth {growth:e}, error {error:e}");
        }
    }
    let (s, values) = small(0, [[1e12, 1.0, 0.0], [1.0, 1.0, 1e-7], [0.0, 1e-7, 1e-12]], true);
    assert!(errors(&s, &values).0 < 1.0 + 1e-9);
}

#[test]
fn zero_pivot_falls_back_to_pivoting() {
    // [0 1; 1 0] has no LU without pivoting
    let nodes = [Node { kind: NodeKind::Scalars(2), q: 0, v: 0, shared: false }];
    let mut p = Pattern::default();
    p.clique(0..2);
    let s = Structure::new(&nodes, &[], &p, true);
    let mut values = vec![0.0; s.entries()];
    values[s.slot(0, 1)] = 1.0;
    let mut guard = Guard::new(&s).unwrap();
    guard.factor(&s, &values).unwrap();
    let mut x = vec![3.0, 5.0];
    guard.solve(&s, &values, &mut x).unwrap();
    assert_eq!(x, vec![5.0, 3.0]);
    assert_eq!(guard.fallbacks, 1);
}

#[test]
fn singular_and_nan_are_errors() {
    let (s, mut values) = chain(4, 1.0, false);
    values.fill(0.0);
    let mut guard = Guard::new(&s).unwrap();
    let mut x = vec![1.0; s.n];
    assert!(guard.factor(&s, &values).is_err() || guard.solve(&s, &values, &mut x).is_err());
    values.fill(f64::NAN);
    assert!(guard.factor(&s, &values).is_err() || guard.solve(&s, &values, &mut x).is_err());
}
