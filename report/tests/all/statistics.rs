//! Moments, cycles and extremes against published examples and values that were computed elsewhere.

use ropewalk_report::statistics::{
    Crossings, Cycle, Gumbel, Life, Moments, Spectrum, damage, dirlik, equivalent_range, expected_maximum,
    most_probable_maximum, narrow_band, quantile_of_maximum, rainflow, total,
};
use serde_json::Value;

fn reference() -> Value {
    let path = format!("{}/tests/data/line_results.json", env!("CARGO_MANIFEST_DIR"));
    serde_json::from_str(&std::fs::read_to_string(path).expect("file")).expect("JSON")
}

fn list(v: &Value) -> Vec<f64> {
    v.as_array().expect("list").iter().map(|x| x.as_f64().expect("number")).collect()
}

#[track_caller]
fn close(found: f64, right: &Value, tolerance: f64) {
    let right = right.as_f64().expect("number");
    assert!((found - right).abs() <= tolerance * right.abs(), "{found} instead of {right}");
}

/// A sum of harmonics with a mean, and the interval of its values.
fn series(v: &Value) -> (Vec<f64>, f64) {
    let parts: Vec<Vec<f64>> =
        v["components_amp_omega_phase"].as_array().expect("list").iter().map(list).collect();
    let (n, dt) = (v["n"].as_u64().expect("count"), v["dt"].as_f64().expect("interval"));
    let mean = v["mean"].as_f64().expect("mean");
    let at = |k: u64| {
        let t = dt * k as f64;
        mean + parts.iter().map(|p| p[0] * (p[1] * t + p[2]).cos()).sum::<f64>()
    };
    ((0..n).map(at).collect(), dt)
}

#[test]
fn cycles_of_the_standard_s_example_are_counted_as_there() {
    let example = &reference()["rainflow_astm_example"];
    let cycles = rainflow(&list(&example["series"]));
    for (range, count) in example["counts"].as_object().expect("table") {
        let range: f64 = range.parse().expect("range");
        let found: f64 = cycles.iter().filter(|c| c.range == range).map(|c| c.count).sum();
        close(found, count, 0.0);
    }
    let all: f64 =
        list(&Value::Array(example["counts"].as_object().expect("table").values().cloned().collect()))
            .iter()
            .sum();
    assert_eq!(total(&cycles), all);
}

#[test]
fn a_long_record_has_its_moments_cycles_and_damage() {
    for case in reference()["series"].as_array().expect("list") {
        let (record, dt) = series(&case["series"]);
        let m = Moments::of(&record).expect("moments");
        for (found, name) in [(m.mean, "mean"), (m.deviation, "std"), (m.least, "min"), (m.greatest, "max")] {
            close(found, &case[name], 1e-12);
        }
        close(m.skewness, &case["skew"], 1e-9);
        assert_eq!(Crossings::of(&record, dt).times.len() as u64, case["zero_up"].as_u64().expect("count"));
        let cycles = rainflow(&record);
        close(total(&cycles), &case["cycles_total"], 0.0);
        close(cycles.iter().map(|c| c.range).fold(0.0, f64::max), &case["largest_range"], 1e-12);
        let power = case["m"].as_f64().expect("power");
        let sum: f64 = cycles.iter().map(|c| c.count * c.range.powf(power)).sum();
        close(sum, &case["sum_range_m"], 1e-9);
        let [k, strength] = ["K", "MBL"].map(|n| case[n].as_f64().expect("number"));
        close(damage(&cycles, |c| k * (c.range / strength).powf(-power)), &case["damage"], 1e-9);
        close(
            equivalent_range(&cycles, power, dt * record.len() as f64),
            &case["equivalent_range_1Hz"],
            1e-9,
        );
    }
}

#[test]
fn waves_of_a_harmonic_have_its_period_and_height() {
    let record: Vec<f64> = (0..20_000).map(|k| 3.0 + 2.0 * (0.01 * f64::from(k)).sin()).collect();
    let waves = Crossings::of(&record, 0.05);
    let period = waves.period().expect("waves");
    assert!((period / (0.05 * std::f64::consts::TAU / 0.01) - 1.0).abs() < 1e-3, "{period}");
    assert!((waves.significant_range().expect("waves") - 4.0).abs() < 1e-3);
    assert_eq!(Crossings::of(&[], 0.1).period(), None);
    let m = Moments::of(&record[..6283]).expect("moments");
    assert!((m.kurtosis - 1.5).abs() < 1e-2 && m.skewness.abs() < 1e-2, "{m:?}");
    assert_eq!(Moments::of(&[1.0, f64::NAN]), None);
}

#[test]
fn gaussian_processes_tire_as_published() {
    let data = reference();
    let n = &data["narrow_band"];
    let [deviation, rate, m] = ["sigma", "nu0", "m"].map(|k| n[k].as_f64().expect("number"));
    close(narrow_band(deviation, rate, m), &n["sum_range_m_per_s"], 1e-12);
    let moments =
        ["m0", "m1", "m2", "m4"].map(|k| data["dirlik"]["moments_omega"][k].as_f64().expect("moment"));
    for case in data["dirlik"]["cases"].as_array().expect("list") {
        close(dirlik(moments, case["m"].as_f64().expect("power")), &case["sum_range_m_per_s"], 1e-10);
    }
}

#[test]
fn extremes_follow_their_distributions() {
    for case in reference()["extremes"].as_array().expect("list") {
        let r = &case["rayleigh"];
        let [deviation, n] = ["sigma", "N"].map(|k| r[k].as_f64().expect("number"));
        close(most_probable_maximum(deviation, n), &r["mpm"], 1e-12);
        close(expected_maximum(deviation, n), &r["mean_max"], 1e-9);
        // the reference has the limit of many peaks
        close(quantile_of_maximum(deviation, n, 0.9), &r["p90"], 1e-5);
        let (g, maxima) = (&case["gumbel"], list(&case["maxima"]));
        for (found, name) in [
            (Gumbel::by_moments(&maxima), "moments"),
            (Gumbel::by_l_moments(&maxima), "l_moments"),
            (Gumbel::by_likelihood(&maxima), "max_likelihood"),
        ] {
            let found = found.expect("distribution");
            close(found.location, &g[name][0], 1e-6);
            close(found.scale, &g[name][1], 1e-5);
        }
        close(Gumbel::by_likelihood(&maxima).expect("distribution").quantile(0.9), &g["p90_ml"], 1e-6);
        let interval = Gumbel::bootstrap(&maxima, 0.9, 0.95).expect("interval");
        assert!(interval.low < interval.value && interval.value < interval.high, "{interval:?}");
        assert!(interval.high - interval.low < 300.0, "{interval:?}");
    }
    assert_eq!(Gumbel::by_l_moments(&[1.0]), None);
    assert_eq!(Gumbel::by_moments(&[1.0, f64::NAN]), None);
}

#[test]
fn spectra_by_welch_are_those_of_another_program() {
    // scipy.signal.welch
    for case in reference()["series"].as_array().expect("list") {
        let (record, dt) = series(&case["series"]);
        let welch = &case["welch"];
        let length = welch["nperseg"].as_u64().expect("length") as usize;
        let s = Spectrum::welch(&record, dt, length).expect("spectrum");
        let largest = s.densities.iter().fold(0.0_f64, |a, b| a.max(*b));
        for (f, p) in list(&welch["f"]).iter().zip(list(&welch["P"])) {
            let k = s.frequencies.iter().position(|x| (x - f).abs() < 1e-9).expect("frequency");
            assert!((s.densities[k] - p).abs() < 1e-12 * largest, "{} instead of {p}", s.densities[k]);
        }
        close(s.moment(0), &welch["integral"], 1e-9);
        close(s.peak(), &welch["peak_f"], 1e-12);
    }
}

#[test]
fn a_narrow_band_does_the_damage_of_its_closed_form() {
    // a harmonic whose amplitude is Rayleigh-distributed: cycle by cycle
    let (sigma, m, n) = (2.0, 3.0, 20_000);
    let per_cycle = 24;
    let mut record = Vec::new();
    for k in 0..n {
        // amplitudes at equal steps of their probability, in an order that mixes them
        let p = ((k * 7919) % n) as f64 / n as f64 + 0.5 / n as f64;
        let amplitude = sigma * (-2.0 * (1.0 - p).ln()).sqrt();
        record.extend(
            (0..per_cycle)
                .map(|i| amplitude * (std::f64::consts::TAU * f64::from(i) / f64::from(per_cycle)).sin()),
        );
    }
    let cycles = rainflow(&record);
    let sum: f64 = cycles.iter().map(|c| c.count * c.range.powf(m)).sum::<f64>() / f64::from(n);
    let closed = narrow_band(sigma, 1.0, m);
    // neighbouring amplitudes differ: ranges from the crest of one to the trough of the next even out
    assert!((sum / closed - 1.0).abs() < 0.15, "{sum} instead of {closed}");
    let life = Life { strength: 50.0, k: 1e3, m, beyond: None, mean_load: false };
    let damage = damage(&cycles, |c| life.cycles(c));
    assert!((damage / (sum * f64::from(n) / (1e3 * 50f64.powf(m))) - 1.0).abs() < 1e-12);
}

#[test]
fn lives_bend_and_mind_the_mean() {
    let plain = Life { strength: 100.0, k: 10.0, m: 3.0, beyond: None, mean_load: false };
    let of = |life: &Life, range: f64, mean: f64| life.cycles(&Cycle { range, mean, count: 1.0 });
    assert!((of(&plain, 10.0, 50.0) - 1e4).abs() < 1e-8);
    // about half of the strength every range counts twice
    let goodman = Life { mean_load: true, ..plain };
    assert!((of(&goodman, 10.0, 50.0) - of(&plain, 20.0, 0.0)).abs() < 1e-8);
    assert_eq!(of(&goodman, 1.0, 100.0), 0.0);
    // beyond the knee, 8 times less range is 8^5 times more life
    let bent = Life { beyond: Some((1e4, 5.0)), ..plain };
    assert!((of(&bent, 1.25, 0.0) / (1e4 * 8f64.powi(5)) - 1.0).abs() < 1e-12);
    assert_eq!(of(&bent, 20.0, 0.0), of(&plain, 20.0, 0.0));
}
