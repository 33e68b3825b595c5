//! Seas from records of their elevation.

use ropewalk_sea::{Regular, Sampling, Spectrum, Stretching, Waves, measured, sample};
use std::f64::consts::TAU;

#[test]
fn a_record_of_a_few_waves_gives_them_back() {
    let length = 200.0;
    let wave =
        |k: f64, amplitude, phase| Regular { amplitude, omega: TAU * k / length, phase, direction: 0.4 };
    let right = [wave(13.0, 0.8, 0.3), wave(20.0, 1.5, 5.0), wave(47.0, 0.2, 2.0)];
    let dt = 0.5;
    let eta = |t: f64| 0.7 + right.iter().map(|w| w.amplitude * (w.phase - w.omega * t).cos()).sum::<f64>();
    let record: Vec<f64> = (0..400).map(|j| eta(dt * f64::from(j))).collect();
    let found = measured(&record, dt, 2.0, 0.4).expect("waves");
    assert_eq!(found.len(), 3);
    for (w, r) in found.iter().zip(&right) {
        assert!((w.amplitude - r.amplitude).abs() < 1e-11 && (w.omega - r.omega).abs() < 1e-14);
        assert!((w.phase - r.phase).abs() < 1e-10 && w.direction == 0.4, "{w:?}");
    }
}

#[test]
fn the_sum_over_the_waves_is_the_record_of_an_irregular_sea() {
    let spectrum = Spectrum::Jonswap { hs: 3.0, tp: 9.0, gamma: 3.3 };
    let sea = sample(&spectrum, 150, 5, Sampling::EqualEnergy, 0.0, None).expect("sea");
    let of = |waves: &[Regular]| Waves::new(waves, 60.0, 9.81, Stretching::Wheeler).expect("waves");
    let (dt, n) = (0.4, 3000);
    let elevation = |waves: &Waves, t: f64| waves.at([0.0, 0.0, -5.0], t).elevation;
    let all = of(&sea);
    let record: Vec<f64> = (0..n).map(|j| elevation(&all, dt * f64::from(j))).collect();
    let again = of(&measured(&record, dt, 2.0, 0.0).expect("waves"));
    // what is left out is a ten-thousandth of the energy: a hundredth of the deviation, 0.75 m
    let off = |j: i32| (elevation(&again, dt * f64::from(j)) - record[j as usize]).powi(2);
    let deviation = ((0..n).map(off).sum::<f64>() / f64::from(n)).sqrt();
    let mean = record.iter().sum::<f64>() / f64::from(n);
    println!("off by {deviation:.4} m, mean {mean:.4} m");
    assert!(deviation < 0.75 * 0.011 + mean.abs(), "{deviation}");
}

#[test]
fn records_without_waves_are_refused() {
    assert!(measured(&[0.0, 1.0, 0.0], 0.1, 1.0, 0.0).is_err());
    assert!(measured(&[0.0, f64::NAN, 0.0, 1.0], 0.1, 1.0, 0.0).is_err());
    assert_eq!(measured(&[1.0; 100], 0.1, 1.0, 0.0).expect_err("no waves").field, "shortest");
    assert_eq!(
        measured(&[0.0, 1.0, 0.0, -1.0, 0.0, 1.0], 0.0, 1.0, 0.0).expect_err("no interval").field,
        "dt"
    );
}
