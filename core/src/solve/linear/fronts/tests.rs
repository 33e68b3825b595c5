use super::*;
use crate::solve::linear::samples::Sample;

/// Multiplications of a factorisation, and entries of the factors.
fn cost(sample: &Sample) -> [f64; 2] {
    let (s, _) = sample.build::<f64>(false, 0.0, 0.0);
    let plan = Plan::new(&s).unwrap();
    let operations = plan.fronts.iter().map(|f| f.own * f.stride * f.stride).sum::<usize>();
    [operations as f64, 2.0 * plan.factors as f64]
}

#[test]
fn cost_grows_little_more_than_the_number_of_cables() {
    let tree = |depth| (f64::from(2 << depth), Sample::tree(depth));
    let net = |n: usize| ((2 * n * (n + 1)) as f64, Sample::net(n));
    let hub = |legs: usize| (legs as f64, Sample::hub(legs));
    for (what, power, [few, many]) in [
        ("tree", 1.05, [tree(3), tree(7)]),
        ("net", 1.2, [net(3), net(14)]),
        ("hub", 1.02, [hub(10), hub(400)]),
    ] {
        let (a, b) = (cost(&few.1), cost(&many.1));
        for k in 0..2 {
            let grown = (b[k] / a[k]).ln() / (many.0 / few.0).ln();
            assert!(grown <= power, "{what}: n^{grown:.3}");
        }
    }
}

#[test]
fn factors_are_made_anew_without_memory_being_asked_for() {
    let (s, values) = Sample::net(3).build::<f64>(false, 0.0, 0.1);
    let mut fronts = Fronts::default();
    fronts.analyse(&s).unwrap();
    let places =
        |f: &Fronts<f64>| [&f.upper, &f.lower, &f.inverse, &f.local].map(|v| (v.as_ptr(), v.capacity()));
    fronts.factor(&s, &values).unwrap();
    let before = places(&fronts);
    let mut x = vec![1.0; s.n];
    fronts.factor(&s, &values).unwrap();
    fronts.solve(&mut x);
    assert_eq!(places(&fronts), before);
}
