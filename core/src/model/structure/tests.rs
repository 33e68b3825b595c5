use super::*;
use crate::model::node::{NodeId, NodeKind};

fn points(n: usize) -> Vec<Node> {
    (0..n).map(|k| Node { kind: NodeKind::Point, q: 3 * k, v: 3 * k, shared: false }).collect()
}

#[test]
fn chain_keeps_its_order_and_rows_follow_their_last_node() {
    let nodes = points(4);
    let mut p = Pattern::default();
    for k in 0..3 {
        p.clique(3 * k..3 * k + 6);
    }
    p.clique((3..6).chain(12..15));
    let rows = vec![Rows { count: 3, nodes: vec![NodeId(1)], jacobian: Vec::new(), behind: Vec::new() }];
    let s = Structure::new(&nodes, &rows, &p, true);
    assert!(s.chain);
    assert_eq!(&s.position[..6], &[0, 1, 2, 3, 4, 5]);
    assert_eq!(&s.position[6..9], &[9, 10, 11]);
    assert_eq!(&s.position[12..15], &[6, 7, 8]);
    assert!(s.is_multiplier[6] && !s.is_multiplier[9]);

    let x: Vec<f64> = (1..=15).map(f64::from).collect();
    let (mut ordered, mut back) = (vec![0.0; 15], vec![0.0; 15]);
    s.order(&x, &mut ordered);
    for (i, &p) in s.position.iter().enumerate() {
        assert_eq!(ordered[p], x[i]);
    }
    s.restore(&ordered, &mut back);
    assert_eq!(back, x);
}

#[test]
fn chain_is_found_in_whatever_order_its_nodes_were_made() {
    let order = [3, 0, 4, 1, 2];
    let mut p = Pattern::default();
    for pair in order.windows(2) {
        p.clique((3 * pair[0]..3 * pair[0] + 3).chain(3 * pair[1]..3 * pair[1] + 3));
    }
    for symmetric in [true, false] {
        let s = Structure::new(&points(5), &[], &p, symmetric);
        assert!(s.chain);
        let place: Vec<usize> = order.iter().map(|k| s.position[3 * k]).collect();
        assert!(place == [0, 3, 6, 9, 12] || place == [12, 9, 6, 3, 0], "{place:?}");
    }
}

#[test]
fn star_eliminates_its_leaves_first_and_shared_nodes_last() {
    let mut nodes = points(5);
    let mut p = Pattern::default();
    for leaf in 1..5 {
        p.clique((0..3).chain(3 * leaf..3 * leaf + 3));
    }
    let s = Structure::new(&nodes, &[], &p, true);
    assert!(!s.chain);
    // with the hub in the middle or first there would be fill
    assert!(s.position[0] >= 3 * 3);
    nodes[2].shared = true;
    let s = Structure::new(&nodes, &[], &p, true);
    assert_eq!(&s.position[6..9], &[12, 13, 14]);
}

#[test]
fn joints_of_a_hub_follow_its_lines_and_what_they_hold_already_does_not_count() {
    // a hub, four lines, and each line's joint with the hub; the first line is pinned as well
    let nodes = points(5);
    let mut p = Pattern::default();
    let rows: Vec<Rows> = (1..6)
        .map(|line| {
            let own = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
            if line == 5 {
                return Rows { count: 3, nodes: vec![NodeId(1)], jacobian: own.to_vec(), behind: Vec::new() };
            }
            let both = own.chunks(3).flat_map(|row| row.iter().map(|x| -x).chain(row.iter().copied()));
            Rows {
                count: 3,
                nodes: vec![NodeId(0), NodeId(line)],
                jacobian: both.collect(),
                behind: Vec::new(),
            }
        })
        .collect();
    let multiplier = |c: usize| 15 + 3 * c..18 + 3 * c;
    for c in 0..4 {
        p.clique((0..3).chain(3 * c + 3..3 * c + 6).chain(multiplier(c)));
    }
    p.clique((3..6).chain(multiplier(4)));
    let s = Structure::new(&nodes, &rows, &p, false);
    assert!(!s.chain);
    let behind = |c: usize, node: usize| (s.position[multiplier(c).start] - s.position[3 * node]) / 3;
    assert_eq!([behind(1, 2), behind(2, 3), behind(3, 4)], [1, 1, 1]);
    assert_eq!([behind(4, 1), behind(0, 0)], [1, 1]);
}

/// Nodes in a row, coupled with the next, and with one a long way off where it isn't to be a chain.
fn row(chain: bool) -> Pattern {
    let mut p = Pattern::default();
    p.clique(0..6);
    p.clique((6..9).chain(3..6));
    p.clique(6..12);
    if !chain {
        p.clique([0, 2, 9, 10]);
        p.clique([4, 7, 11]);
    }
    p
}

#[test]
fn tiles_and_products_are_those_of_the_dense_matrix() {
    for chain in [true, false] {
        for symmetric in [true, false] {
            let p = row(chain);
            let s = Structure::new(&points(4), &[], &p, symmetric);
            assert_eq!(s.chain, chain);
            let entry = |i: u32, j: u32| {
                let (i, j) = if symmetric { (i.min(j), i.max(j)) } else { (i, j) };
                f64::from(1 + i * i + 3 * j)
            };
            let mut values = vec![0.0; s.entries()];
            let mut dense = vec![vec![0.0; 12]; 12];
            for k in 0..p.len() {
                let c = p.get(k);
                for &i in c {
                    for &j in c {
                        dense[s.position[i as usize]][s.position[j as usize]] += entry(i, j);
                    }
                }
                for t in s.tiles(k) {
                    for i in 0..t.rows {
                        for j in 0..t.columns {
                            values[t.at as usize + i as usize * t.stride as usize + j as usize] +=
                                entry(c[(t.row + i) as usize], c[(t.column + j) as usize]);
                        }
                    }
                }
            }
            for (r, columns, at) in s.rows() {
                for (k, v) in values[at].iter().enumerate() {
                    assert_eq!(*v, dense[r][columns.get(k)], "row {r}, column {}", columns.get(k));
                }
            }
            let x: Vec<f64> = (0..12).map(|i| f64::from(i) - 4.5).collect();
            let exact: Vec<f64> =
                dense.iter().map(|row| row.iter().zip(&x).map(|(a, x)| a * x).sum()).collect();
            let mut y = vec![0.0; 12];
            s.multiply(&values, &x, &mut y);
            assert_eq!(y, exact);
        }
    }
}
