//! Functions of time.

use ropewalk_core::Join;
use ropewalk_forces::{TimeFunction, TimeTable};

#[test]
fn values_between_and_beyond() {
    let ramp = TimeFunction::Ramp { from: 2.0, to: 4.0, t0: 1.0, t1: 3.0 };
    assert_eq!([0.0, 1.0, 2.0, 3.0, 9.0].map(|t| ramp.at(t)), [2.0, 2.0, 3.0, 4.0, 4.0]);
    let triangle = TimeFunction::Triangle { t0: 1.0, peak: 2.0, t1: 4.0 };
    assert_eq!([0.0, 1.5, 2.0, 3.0, 4.0, 5.0].map(|t| triangle.at(t)), [0.0, 0.5, 1.0, 0.5, 0.0, 0.0]);
    let harmonic = TimeFunction::Harmonic { mean: 1.0, amplitude: 2.0, frequency: 0.25, phase: 0.0 };
    assert_eq!(harmonic.at(1.0), 3.0);
    assert_eq!(TimeFunction::default().at(7.0), 1.0);
}

#[test]
fn tables_are_joined_as_they_say() {
    let table = |join| {
        let (t, value) = (vec![0.0, 1.0, 2.0, 3.0], vec![0.0, 0.0, 1.5, 1.5]);
        TimeFunction::Table(TimeTable::new(t, value, join))
    };
    let all = [Join::Linear, Join::Monotone, Join::Cubic].map(table);
    for f in &all {
        assert_eq!([-1.0, 0.0, 3.0, 9.0].map(|t| f.at(t)), [0.0, 0.0, 1.5, 1.5]);
        let halfway = f.at(1.5);
        assert!((halfway - 0.75).abs() < 1e-15, "{halfway}");
    }
    let largest = |f: &TimeFunction| (0..300).map(|k| f.at(0.01 * f64::from(k))).fold(0.0, f64::max);
    assert_eq!(largest(&all[0]), 1.5);
    assert_eq!(largest(&all[1]), 1.5);
    assert!(largest(&all[2]) > 1.55);
    assert_eq!(all[0].at(1.25), 0.375);
    // a rise between two rows without slope is not leapt over
    assert!(all.iter().all(|f| f.reach(0.0, 10.0) <= 1.5 && f.reach(1.0, 10.0) <= 1.0));
}

#[test]
fn bad_functions_are_refused() {
    let bad = [
        TimeFunction::Ramp { from: 0.0, to: 1.0, t0: 1.0, t1: 1.0 },
        TimeFunction::table(vec![], vec![]),
        TimeFunction::table(vec![0.0, 0.0], vec![1.0, 2.0]),
        TimeFunction::table(vec![0.0], vec![f64::NAN]),
        TimeFunction::Triangle { t0: 0.0, peak: 3.0, t1: 2.0 },
    ];
    assert!(bad.iter().all(|f| f.check().is_err()));
}

#[test]
fn rates_are_the_slopes_of_the_factors() {
    let all = [
        TimeFunction::Constant,
        TimeFunction::Ramp { from: 0.4, to: 1.7, t0: 0.5, t1: 2.5 },
        TimeFunction::table(vec![0.3, 1.1, 2.9], vec![1.0, -2.0, 0.5]),
        TimeFunction::Triangle { t0: 0.2, peak: 1.4, t1: 2.6 },
        TimeFunction::Harmonic { mean: 1.0, amplitude: 0.3, frequency: 0.7, phase: 0.4 },
    ];
    for f in &all {
        // away from kinks, before, between and after them
        for t in [0.1, 0.45, 0.9, 1.2, 1.9, 2.75, 3.5] {
            let h = 1e-5;
            let slope = (f.at(t + h) - f.at(t - h)) / (2.0 * h);
            assert!((f.rate(t) - slope).abs() < 1e-8, "{f:?} at {t}: {} instead of {slope}", f.rate(t));
        }
    }
}
