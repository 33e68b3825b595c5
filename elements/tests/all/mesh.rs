//! Meshes of cables: even, graded, with nodes at pins.

use ropewalk_elements::cable::{Grading, MeshSpec};
use ropewalk_elements::testing::{even, pinned};

fn lengths(mesh: &[f64]) -> Vec<f64> {
    mesh.windows(2).map(|w| w[1] - w[0]).collect()
}
fn graded(elements: usize, first: Option<f64>, last: Option<f64>) -> MeshSpec {
    MeshSpec::Graded(Grading { elements, first, last })
}

#[test]
fn even_meshes_hold_their_pins() {
    assert_eq!(even(10.0, 5, &[]), vec![0.0, 2.0, 4.0, 6.0, 8.0, 10.0]);
    let m = even(10.0, 4, &[3.0, 3.0, 10.0]);
    assert_eq!(m, vec![0.0, 3.0, 3.0 + 7.0 / 3.0, 3.0 + 14.0 / 3.0, 10.0]);
    assert_eq!(even(10.0, 4, &[-1.0, 11.0, f64::NAN]), even(10.0, 4, &[]));
}

#[test]
fn a_grading_to_one_end_is_a_geometric_series() {
    for mesh in [graded(7, None, Some(0.01)), graded(7, Some(0.01), None)] {
        let nodes = mesh.nodes(3.0).expect("mesh");
        let mut l = lengths(&nodes);
        if l[0] > l[6] {
            l.reverse();
        }
        assert!((l[0] - 0.01).abs() < 1e-12 && (nodes[7], nodes[0]) == (3.0, 0.0));
        let q = l[1] / l[0];
        assert!(l.windows(2).all(|w| (w[1] / w[0] / q - 1.0).abs() < 1e-9));
        assert!((0.01 * (q.powi(7) - 1.0) / (q - 1.0) - 3.0).abs() < 1e-9);
    }
    assert_eq!(graded(4, None, None).nodes(2.0).expect("mesh"), vec![0.0, 0.5, 1.0, 1.5, 2.0]);
}

#[test]
fn a_grading_to_both_ends_has_both_lengths_and_the_sum() {
    for (n, a, b) in [(9, 0.01, 0.01), (9, 0.01, 0.2), (3, 0.3, 0.1), (40, 0.1, 0.1)] {
        let l = lengths(&graded(n, Some(a), Some(b)).nodes(3.0).expect("mesh"));
        assert!((l[0] - a).abs() < 1e-9 && (l[n - 1] - b).abs() < 1e-9, "{l:?}");
        assert!((l.iter().sum::<f64>() - 3.0).abs() < 1e-12);
    }
    // what is a geometric series stays one
    let q = 1.3_f64;
    let sum: f64 = (0..8).map(|k| q.powi(k)).sum();
    let l = lengths(&graded(8, Some(1.0), Some(q.powi(7))).nodes(sum).expect("mesh"));
    assert!(l.iter().zip(0..).all(|(l, k)| (l / q.powi(k) - 1.0).abs() < 1e-9), "{l:?}");
}

#[test]
fn a_graded_mesh_keeps_its_grading_between_pins() {
    let nodes = graded(12, None, Some(0.02)).nodes(4.0).expect("mesh");
    assert_eq!(pinned(&nodes, &[]), nodes);
    let mesh = pinned(&nodes, &[1.0, 3.3]);
    assert!(mesh.contains(&1.0) && mesh.contains(&3.3) && mesh.len().abs_diff(13) < 2);
    let l = lengths(&mesh);
    assert!(l.windows(2).all(|w| w[1] < 1.1 * w[0]) && l[l.len() - 1] < 0.03, "{l:?}");
}

#[test]
fn wrong_meshes_are_refused_with_a_remedy() {
    let says = |mesh: MeshSpec, what: &str| {
        let e = mesh.nodes(2.0).expect_err(what);
        assert!(e.message.contains(what) && e.field.as_deref() == Some("mesh"), "{e}");
    };
    says(MeshSpec::Lengths(vec![1.0, 0.9]), "the cable is 2 m long");
    says(MeshSpec::Lengths(vec![]), "between 1 and");
    says(MeshSpec::Lengths(vec![1.0, -1.0, 2.0]), "element 2 of `mesh` must have a positive length");
    says(MeshSpec::Lengths(vec![1.0, f64::NAN]), "element 2");
    says(graded(0, None, None), "between 1 and");
    says(graded(8, Some(-1.0), None), "must be positive");
    says(graded(8, None, Some(f64::NAN)), "must be positive");
    says(graded(1, None, Some(0.5)), "`elements = 2` or more");
    says(graded(2, Some(0.5), Some(0.5)), "`elements = 3` or more");
    says(graded(8, Some(1.5), Some(0.6)), "longer than the cable");
    says(graded(2, None, Some(1e-300)), "vanish");
    assert!(MeshSpec::Lengths(vec![1.0, 1.0 + 1e-7]).nodes(2.0).is_ok());
}
