//! Elements that are folded inside themselves are found and turned round.

use ropewalk_elements::testing::{Between, unfold};

fn line(n: usize, spliced: Option<usize>) -> (Vec<[f64; 6]>, Vec<Between>) {
    let (mut nodes, mut elements) = (Vec::new(), Vec::new());
    for k in 0..=n {
        nodes.push([k as f64, 0.0, 0.0, 1.0, 0.0, 0.0]);
        if spliced == Some(k) {
            nodes.push(nodes[nodes.len() - 1]);
        }
        if k < n {
            elements.push(Between { first: nodes.len() - 1, length: 1.0 });
        }
    }
    (nodes, elements)
}

#[test]
fn what_points_backwards_is_turned_round() {
    // a slope of the line, of a splice, of an end, and a chord, each with the chords that strain nothing then
    for (turned, spliced) in [(4, None), (5, Some(4)), (4, Some(4)), (0, None)] {
        let (mut nodes, elements) = line(8, spliced);
        nodes[turned][3] = -1.0;
        let folded: Vec<bool> = elements.iter().map(|e| e.is_folded(&nodes)).collect();
        let beside = |e: &Between| e.first == turned || e.first + 1 == turned;
        let expected: Vec<bool> = elements.iter().map(beside).collect();
        assert_eq!(folded, expected, "{turned} {spliced:?}");
        unfold(&mut nodes, &elements, &folded);
        assert!(!elements.iter().any(|e| e.is_folded(&nodes)), "{turned}: {nodes:?}");
    }
    let (mut nodes, elements) = line(8, None);
    let back = 1.0 + 1.0 / 3.0;
    nodes[4..].iter_mut().for_each(|x| x[0] -= back);
    let folded: Vec<bool> = elements.iter().map(|e| e.is_folded(&nodes)).collect();
    assert_eq!(folded.iter().position(|is| *is), Some(3));
    unfold(&mut nodes, &elements, &folded);
    assert!(!elements.iter().any(|e| e.is_folded(&nodes)), "{nodes:?}");
    let ends = (nodes[0][0], nodes[8][0]);
    assert!(ends.0 == 0.0 && (ends.1 - 8.0 + back).abs() < 1e-12, "{ends:?}");
}

#[test]
fn what_is_only_bent_sharply_is_not_folded() {
    // half a turn in one element, stretched by nothing
    let nodes = [[0.0, 0.0, 0.0, 0.0, 0.0, -1.0], [0.66, 0.0, 0.0, 0.0, 0.0, 1.0]];
    assert!(!Between { first: 0, length: 1.0 }.is_folded(&nodes));
}
