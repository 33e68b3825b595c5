//! Vessels by response amplitudes.

use crate::table::{close, list, number, read};
use ropewalk_sea::{MOTIONS, Regular, Responses, Stretching, VesselResponse, Waves};
use serde_json::Value;

fn rows(v: &Value, of: impl Fn(usize, f64) -> f64) -> Vec<Vec<[f64; MOTIONS]>> {
    let six = |v: &Value| {
        let x = list(v);
        std::array::from_fn(|k| of(k, x[k]))
    };
    v.as_array().unwrap().iter().map(|row| row.as_array().unwrap().iter().map(six).collect()).collect()
}

fn responses(case: &Value) -> Responses {
    let rao = &case["rao"];
    let headings = list(&rao["headings_deg"]).iter().map(|x| x.to_radians()).collect();
    let amplitude = rows(&rao["amp"], |k, a| if k < 3 { a } else { a.to_radians() });
    let lag = rows(&rao["lag_deg"], |_, x| x.to_radians());
    Responses::new(headings, list(&rao["omegas"]), &amplitude, &lag).expect("responses")
}

fn waves(case: &Value) -> Waves {
    let sea = &case["sea"];
    let [a, omega, phase, beta] = ["a", "omega", "phase", "beta_deg"].map(|k| list(&sea[k]));
    let wave = |k: usize| Regular {
        amplitude: a[k],
        omega: omega[k],
        phase: phase[k],
        direction: beta[k].to_radians(),
    };
    let all: Vec<Regular> = (0..a.len()).map(wave).collect();
    Waves::new(&all, number(&sea["h"]), 9.81, Stretching::Wheeler).expect("waves")
}

fn vessel(case: &Value, waves: &Waves) -> VesselResponse {
    let place = list(&case["reference"]);
    VesselResponse::new(
        waves,
        &responses(case),
        [place[0], place[1]],
        number(&case["heading_deg"]).to_radians(),
    )
}

#[test]
fn responses_and_motions_are_those_of_the_reference() {
    for case in read("vessel_rao")["cases"].as_array().unwrap() {
        let (spec, waves) = (&case["case"], waves(&case["case"]));
        let (table, heading) = (responses(spec), number(&spec["heading_deg"]));
        let beta = list(&spec["sea"]["beta_deg"]);
        for (row, beta) in case["interpolated_rao"].as_array().unwrap().iter().zip(beta) {
            let found = table.at((beta - heading).to_radians(), number(&row["omega"]));
            let (amplitude, lag) = (list(&row["amp"]), list(&row["lag_deg"]));
            for k in 0..MOTIONS {
                let unit = if k < 3 { 1.0 } else { 1.0_f64.to_radians() };
                close(found[k][0], unit * amplitude[k], 1e-14);
                close((found[k][1] - lag[k].to_radians()).sin(), 0.0, 1e-12);
            }
        }
        let vessel = vessel(spec, &waves);
        for row in case["rows"].as_array().unwrap() {
            let found = vessel.at(number(&row["t"]));
            let (dof, rate) = (list(&row["dof"]), list(&row["dof_rate"]));
            for k in 0..MOTIONS {
                let unit = if k < 3 { 1.0 } else { 1.0_f64.to_radians() };
                close(found[k][0], unit * dof[k], 1e-11);
                close(found[k][1], unit * rate[k], 1e-11);
            }
        }
    }
}

#[test]
fn rates_are_derivatives_also_while_waves_rise() {
    let case = &read("vessel_rao")["cases"][1]["case"];
    let vessel = vessel(case, &waves(case).with_ramp(30.0).expect("ramp"));
    let e = 1e-5;
    for t in [0.0, 3.0, 17.3, 29.0, 41.0] {
        let ([a, b], here) = ([-e, e].map(|e| vessel.at(t + e)), vessel.at(t));
        for k in 0..MOTIONS {
            close((b[k][0] - a[k][0]) / (2.0 * e), here[k][1], 1e-9 + 1e-6 * f64::from(t == 0.0));
            if t > 0.0 {
                close((b[k][1] - a[k][1]) / (2.0 * e), here[k][2], 1e-9);
            }
        }
    }
    assert!(vessel.at(0.0).iter().all(|x| x[0] == 0.0 && x[1] == 0.0));
}

/// A float on very long waves goes with the water at the surface.
#[test]
fn by_the_limits_of_long_waves_a_vessel_goes_with_the_water() {
    let quarter = std::f64::consts::FRAC_PI_2;
    let six = |surge: [f64; 2], sway: [f64; 2]| {
        (vec![[surge[0], sway[0], 1.0, 0.0, 0.0, 0.0]], vec![[surge[1], sway[1], 0.0, 0.0, 0.0, 0.0]])
    };
    // a small ball in deep water: surge lags by a quarter when waves come from astern
    let all = [six([1.0, quarter], [0.0, 0.0]), six([0.0, 0.0], [1.0, quarter])];
    let (amplitude, lag): (Vec<_>, Vec<_>) = all.into_iter().unzip();
    let table = Responses::new(vec![0.0, quarter], vec![0.1], &amplitude, &lag).expect("responses");
    for direction in [0.0, quarter] {
        let wave = Regular { amplitude: 0.5, omega: 0.3, phase: 0.2, direction };
        let waves = Waves::new(&[wave], f64::INFINITY, 9.81, Stretching::Constant).expect("waves");
        let vessel = VesselResponse::new(&waves, &table, [7.0, -3.0], 0.0);
        for t in [0.0, 4.0, 11.0] {
            let (found, flow) = (vessel.at(t), waves.at([7.0, -3.0, 0.0], t));
            for k in 0..3 {
                close(found[k][1], flow.velocity[k], 1e-12);
            }
        }
    }
}

/// Of what a vessel doesn't do at all in head seas the lag means nothing: on both sides of it sway is the same, mirrored.
#[test]
fn responses_to_either_side_of_a_heading_without_one_are_mirrored() {
    use std::f64::consts::{FRAC_PI_4, PI};
    let headings = vec![0.0, FRAC_PI_4, 2.0 * PI - FRAC_PI_4];
    let sway = |amplitude: f64| vec![[1.0, amplitude, 1.0, 0.0, 0.0, 0.0]];
    let lag = |sway: f64| vec![[0.5, sway, 0.0, 0.0, 0.0, 0.0]];
    for meaningless in [0.0, 1.0, 2.5, -3.0] {
        let amplitude = [sway(0.0), sway(0.8), sway(0.8)];
        let lags = [lag(meaningless), lag(1.2), lag(1.2 + PI)];
        let table = Responses::new(headings.clone(), vec![0.5], &amplitude, &lags).expect("responses");
        let [port, starboard] = [0.3, -0.3].map(|relative| table.at(relative, 0.5)[1]);
        let part = |[amplitude, lag]: [f64; 2]| [amplitude * lag.cos(), amplitude * lag.sin()];
        let ([a, b], [c, d]) = (part(port), part(starboard));
        assert!((a + c).abs() < 1e-12 && (b + d).abs() < 1e-12, "{port:?} {starboard:?}");
        assert!((port[0] - 0.8 * 0.3 / FRAC_PI_4).abs() < 1e-12);
    }
}
