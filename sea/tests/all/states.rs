//! Lengths of waves, spectra, and sea states from seeds.

use crate::table::{close, list, number, read};
use ropewalk_sea::{
    Sampling, Spectrum, SplitMix64, Spreading, Stretching, Waves, group_velocity, sample, wavenumber,
    wavenumber_on_current,
};
use std::f64::consts::{PI, TAU};

#[test]
fn wavenumbers_agree_with_those_of_twenty_digits() {
    for case in read("dispersion")["cases"].as_array().unwrap() {
        let (omega, depth, g) = (TAU / number(&case["T"]), number(&case["h"]), number(&case["g"]));
        let k = wavenumber(omega, depth, g);
        close(k / number(&case["k"]), 1.0, 1e-15);
        close(group_velocity(k, depth, g) / number(&case["group_velocity"]), 1.0, 1e-12);
    }
    // of any period and depth the equation holds to rounding
    for a in 0..60 {
        for b in 0..40 {
            let (period, depth) = (1.3 * 1.11_f64.powi(a), 2.0 * 1.18_f64.powi(b));
            let omega = TAU / period;
            let k = wavenumber(omega, depth, 9.81);
            let left = 9.81 * k * (k * depth).tanh() / (omega * omega) - 1.0;
            assert!(left.abs() < 2e-15, "{period} s, {depth} m: {left:e}");
        }
    }
    assert_eq!(wavenumber(0.0, 10.0, 9.81), 0.0);
    assert_eq!(wavenumber(2.0, f64::INFINITY, 9.81), 4.0 / 9.81);
}

#[test]
fn a_current_lengthens_what_it_carries_and_stops_what_it_opposes() {
    for (omega, depth, along) in [(1.0, 20.0, 1.0), (0.6, f64::INFINITY, 2.0), (0.8, 50.0, -1.5)] {
        let k = wavenumber_on_current(omega, depth, 9.81, along).expect("waves");
        let sigma = omega - k * along;
        let tanh = if depth.is_finite() { (k * depth).tanh() } else { 1.0 };
        close(9.81 * k * tanh / (sigma * sigma), 1.0, 1e-13);
        assert_eq!(k < wavenumber(omega, depth, 9.81), along > 0.0);
    }
    // deep water: waves are stopped by a quarter of their celerity without current, g/4ω
    let limit = 9.81 / (4.0 * 1.2);
    assert!(wavenumber_on_current(1.2, f64::INFINITY, 9.81, -0.999 * limit).is_some());
    assert!(wavenumber_on_current(1.2, f64::INFINITY, 9.81, -1.001 * limit).is_none());
}

#[test]
fn spectra_have_their_densities_and_moments() {
    for case in read("spectra")["cases"].as_array().unwrap() {
        let [hs, tp, gamma] = ["Hs", "Tp", "gamma"].map(|k| number(&case[k]));
        let spectrum = Spectrum::Jonswap { hs, tp, gamma };
        spectrum.check().expect("spectrum");
        for at in case["S_at"].as_array().unwrap() {
            let right = number(&at["S"]);
            close(spectrum.density(number(&at["omega"])) / right, 1.0, 1e-12);
        }
        // moments of the band by Simpson's rule
        let [from, to] = spectrum.band();
        let n = 20_000;
        for power in [0, 1, 2, 4] {
            let f = |k: usize| {
                let omega = from + (to - from) * k as f64 / n as f64;
                omega.powi(power) * spectrum.density(omega)
            };
            let inner: f64 = (1..n).map(|k| if k % 2 == 1 { 4.0 } else { 2.0 } * f(k)).sum();
            let moment = (f(0) + inner + f(n)) * (to - from) / (3.0 * n as f64);
            let right = number(&case["moments_band_0p5_to_4_wp"][power.to_string()]);
            close(moment / right, 1.0, 1e-8);
        }
    }
}

#[test]
fn the_same_seed_gives_the_same_sea_everywhere() {
    for case in read("irregular_seas")["cases"].as_array().unwrap() {
        let [hs, tp, gamma, depth] = ["Hs", "Tp", "gamma", "h"].map(|k| number(&case[k]));
        let count = case["n"].as_u64().unwrap() as usize;
        let sampling = if case["kind"] == "jitter" { Sampling::Jitter } else { Sampling::EqualEnergy };
        let spectrum = Spectrum::Jonswap { hs, tp, gamma };
        let waves =
            sample(&spectrum, count, case["seed"].as_u64().unwrap(), sampling, 0.0, None).expect("sea");
        for (k, right) in list(&case["first5"]["a"]).into_iter().enumerate() {
            close(waves[k].amplitude / right, 1.0, 1e-11);
            close(waves[k].omega / list(&case["first5"]["omega"])[k], 1.0, 1e-12);
            close(waves[k].phase, list(&case["first5"]["phase"])[k], 1e-14);
        }
        close(waves[count - 1].omega / number(&case["last"]["omega"]), 1.0, 1e-12);
        let energy: f64 = waves.iter().map(|w| 0.5 * w.amplitude * w.amplitude).sum();
        close(energy / (hs * hs / 16.0), 1.0, 1e-14);
        let waves = Waves::new(&waves, depth, 9.81, Stretching::Wheeler).expect("waves");
        for at in case["eta_x0"].as_array().unwrap() {
            close(waves.elevation(0.0, 0.0, number(&at["t"])).0, number(&at["eta"]), 1e-9 * hs);
        }
        close(waves.elevation(50.0, 20.0, 100.0).0, number(&case["eta_x50_y20_t100"]), 1e-9 * hs);
    }
}

#[test]
fn random_numbers_are_those_of_the_published_generator() {
    // the first of seed 1234567, as its authors give them
    let mut random = SplitMix64::new(1_234_567);
    let first = [6_457_827_717_110_365_317, 3_203_168_211_198_807_973, 9_817_491_932_198_370_423];
    assert_eq!([0; 3].map(|_: u64| random.bits()), first);
}

#[test]
fn directions_spread_about_the_mean() {
    let spectrum = Spectrum::Jonswap { hs: 3.0, tp: 9.0, gamma: 3.3 };
    for (s, mean) in [(2.0, 0.4), (15.0, -1.0)] {
        let spreading = Spreading { s, directions: 100 };
        let waves = sample(&spectrum, 400, 3, Sampling::EqualEnergy, mean, Some(spreading)).expect("sea");
        let sums = waves.iter().fold([0.0; 2], |[c, d], w| {
            let e = w.amplitude * w.amplitude;
            [c + e * (w.direction - mean).cos(), d + e * (w.direction - mean).sin()]
        });
        let all: f64 = waves.iter().map(|w| w.amplitude * w.amplitude).sum();
        // the first circular moment of cos^2s(β/2) is s/(s + 1)
        close(sums[0] / all, s / (s + 1.0), 2e-3);
        close(sums[1] / all, 0.0, 1e-6);
        assert!(waves.iter().all(|w| (w.direction - mean).abs() < PI));
    }
}

/// The highest waves, which make most of the accelerations, come from all sides.
#[test]
fn accelerations_have_the_mean_direction_too() {
    let spectrum = Spectrum::Jonswap { hs: 3.0, tp: 9.0, gamma: 3.3 };
    let spreading = Spreading { s: 4.0, directions: 20 };
    let mean: f64 = (0..40)
        .map(|seed| {
            let waves =
                sample(&spectrum, 400, seed, Sampling::EqualEnergy, 0.3, Some(spreading)).expect("sea");
            let sums = waves.iter().fold([0.0; 2], |[c, s], w| {
                let e = w.amplitude.powi(2) * w.omega.powi(4);
                [c + e * w.direction.cos(), s + e * w.direction.sin()]
            });
            sums[1].atan2(sums[0]) - 0.3
        })
        .sum::<f64>()
        / 40.0;
    assert!(mean.abs() < 0.08, "{mean}");
}

#[test]
fn what_makes_no_sea_is_refused_with_its_field() {
    let fine = Spectrum::Jonswap { hs: 2.0, tp: 8.0, gamma: 3.3 };
    let field = |spectrum: &Spectrum, count, spreading| {
        sample(spectrum, count, 1, Sampling::EqualEnergy, 0.0, spreading).expect_err("refused").field
    };
    assert_eq!(field(&Spectrum::Jonswap { hs: -1.0, tp: 8.0, gamma: 3.3 }, 10, None), "hs");
    assert_eq!(field(&Spectrum::Jonswap { hs: 1.0, tp: f64::NAN, gamma: 3.3 }, 10, None), "tp");
    assert_eq!(field(&Spectrum::Jonswap { hs: 1.0, tp: 8.0, gamma: 0.5 }, 10, None), "gamma");
    assert_eq!(field(&Spectrum::White { hs: 1.0, from: 1.0, to: 1.0 }, 10, None), "to");
    assert_eq!(field(&fine, 0, None), "components");
    assert_eq!(field(&fine, 10, Some(Spreading { s: 4.0, directions: 11 })), "directions");
    assert_eq!(field(&fine, 10, Some(Spreading { s: 0.0, directions: 3 })), "s");
    let waves = sample(&fine, 10, 1, Sampling::Jitter, 0.0, None).expect("sea");
    let refused = |depth, g| Waves::new(&waves, depth, g, Stretching::None).expect_err("refused").field;
    assert_eq!(
        (refused(0.0, 9.81), refused(f64::NAN, 9.81), refused(5.0, 0.0)),
        ("depth", "depth", "gravity")
    );
    let slow = Waves::new(&waves, 50.0, 9.81, Stretching::None).expect("waves").on_current([-9.0, 0.0]);
    assert!(slow.expect_err("refused").message.contains("against a current of 9.000 m/s"));
}
