//! Elevation, velocity, acceleration and gradients.

use crate::table::{close, list, number, read};
use ropewalk_sea::{Flow, Regular, Stretching, Waves};
use serde_json::Value;

const ALL: [(Stretching, &str); 3] =
    [(Stretching::None, "none"), (Stretching::Wheeler, "wheeler"), (Stretching::Constant, "constant")];

fn regular(sea: &Value) -> Vec<Regular> {
    let [a, period, phase, direction] = ["a", "T", "phase", "beta_deg"].map(|k| list(&sea[k]));
    (0..a.len())
        .map(|k| Regular {
            amplitude: a[k],
            omega: std::f64::consts::TAU / period[k],
            phase: phase[k],
            direction: direction[k].to_radians(),
        })
        .collect()
}

/// The seas of the reference, with one stretching.
fn seas(stretching: Stretching) -> Vec<(Waves, Value)> {
    let all = read("airy_points");
    let sea = |v: &Value| {
        let s = &v["sea"];
        let waves = Waves::new(&regular(s), number(&s["h"]), 9.81, stretching).expect("waves");
        (waves.with_ramp(s["ramp"].as_f64().unwrap_or(0.0)).expect("ramp"), v["points"].clone())
    };
    all["seas"].as_array().unwrap().iter().map(sea).collect()
}

#[test]
fn motion_of_the_water_agrees_with_the_reference() {
    for (stretching, name) in ALL {
        for (waves, points) in seas(stretching) {
            // points above the water have no other motion than that of constant stretching
            for p in points.as_array().unwrap().iter().filter(|p| !p[name].is_null()) {
                let [x, y, z, t] = ["x", "y", "z", "t"].map(|k| number(&p[k]));
                let flow = waves.at([x, y, z], t);
                close(flow.elevation, number(&p["eta"]), 1e-13);
                let (u, du) = (list(&p[name]["u"]), list(&p[name]["du_dt"]));
                for i in 0..3 {
                    close(flow.velocity[i], u[i], 1e-13);
                    close(flow.acceleration[i], du[i], 1e-13);
                    if stretching == Stretching::None {
                        let row = list(&p["grad_u"][i]);
                        (0..3).for_each(|j| close(flow.gradient[i][j], row[j], 1e-14));
                    }
                }
                close(flow.pressure, number(&p[name]["p_over_rho"]), 1e-12);
            }
        }
    }
}

fn shifted(x: [f64; 3], i: usize, by: f64) -> [f64; 3] {
    let mut y = x;
    y[i] += by;
    y
}

#[test]
fn gradients_and_accelerations_are_those_of_differences() {
    let e = 1e-5;
    for (stretching, name) in ALL {
        for (waves, _) in seas(stretching) {
            for (x, t) in [([3.0, -2.0, -1.5], 17.0), ([40.0, 7.0, -12.0], 41.0), ([-5.0, 1.0, 0.3], 33.0)] {
                let flow = waves.at(x, t);
                for j in 0..3 {
                    let [a, b] = [-e, e].map(|e| waves.at(shifted(x, j, e), t));
                    for i in 0..3 {
                        let slope = (b.velocity[i] - a.velocity[i]) / (2.0 * e);
                        assert!((slope - flow.gradient[i][j]).abs() < 1e-9, "{name}: {i} {j} {slope}");
                        let slope = (b.acceleration[i] - a.acceleration[i]) / (2.0 * e);
                        let exact = flow.acceleration_gradient[i][j];
                        assert!(
                            (slope - exact).abs() < 1e-8,
                            "{name}: of the acceleration {i} {j} {slope} {exact}"
                        );
                    }
                    if j < 2 {
                        close((b.elevation - a.elevation) / (2.0 * e), flow.slope[j], 1e-9);
                    }
                }
                let [a, b] = [-e, e].map(|e| waves.elevation(x[0], x[1], t + e).0);
                close((b - a) / (2.0 * e), flow.rising, 1e-9);
                let [a, b] = [-e, e].map(|e| waves.at(x, t + e).velocity);
                (0..3).for_each(|i| {
                    close((b[i] - a[i]) / (2.0 * e), flow.rate[i], 1e-9);
                });
                // only Wheeler's column is stretched as the surface rises
                assert_eq!(flow.rate == flow.acceleration, stretching != Stretching::Wheeler);
            }
        }
    }
}

#[test]
fn water_is_neither_made_nor_turned_and_stays_above_the_bed() {
    for (waves, _) in seas(Stretching::None) {
        for (x, t) in [([3.0, -2.0, -1.5], 37.0), ([40.0, 7.0, -12.0], 41.0)] {
            let Flow { gradient: g, .. } = waves.at(x, t);
            close(g[0][0] + g[1][1] + g[2][2], 0.0, 1e-15);
            (0..3).for_each(|i| (0..3).for_each(|j| assert_eq!(g[i][j], g[j][i])));
            assert_eq!(waves.at([x[0], x[1], -waves.depth()], t).velocity[2], 0.0);
        }
    }
}

#[test]
fn bernoulli_and_the_surface_hold_to_first_order() {
    // p/ρ = -∂φ/∂t and u = ∇φ: ∂p/∂x = -∂u/∂t
    let e = 1e-5;
    for (waves, _) in seas(Stretching::None) {
        let (x, t) = ([12.0, 4.0, -3.0], 50.0);
        let flow = waves.at(x, t);
        for i in 0..3 {
            let [a, b] = [-e, e].map(|e| waves.at(shifted(x, i, e), t).pressure);
            close((b - a) / (2.0 * e), -flow.acceleration[i], 1e-8);
        }
        // at still water the surface moves with the water: ∂η/∂t = w
        let [a, b] = [-e, e].map(|e| waves.elevation(x[0], x[1], t + e).0);
        close((b - a) / (2.0 * e), waves.at([x[0], x[1], 0.0], t).velocity[2], 1e-9);
    }
}

#[test]
fn who_drifts_with_the_current_sees_waves_on_water_at_rest() {
    let wave = Regular { amplitude: 0.7, omega: 1.1, phase: 0.4, direction: 0.5 };
    let drift = [1.2, -0.3];
    let on =
        Waves::new(&[wave], 30.0, 9.81, Stretching::None).expect("waves").on_current(drift).expect("current");
    let along = drift[0] * 0.5_f64.cos() + drift[1] * 0.5_f64.sin();
    // the frequency that it has for whoever drifts
    let k = ropewalk_sea::wavenumber_on_current(1.1, 30.0, 9.81, along).expect("waves");
    let own = Regular { omega: 1.1 - k * along, ..wave };
    let still = Waves::new(&[own], 30.0, 9.81, Stretching::None).expect("waves");
    for t in [0.0, 3.3, 20.0] {
        let here = [2.0 + drift[0] * t, 5.0 + drift[1] * t, -1.0];
        let (a, b) = (on.at(here, t), still.at([2.0, 5.0, -1.0], t));
        close(a.elevation, b.elevation, 1e-10);
        for i in 0..3 {
            close(a.velocity[i], b.velocity[i], 1e-10);
            close(a.acceleration[i], b.acceleration[i], 1e-10);
            let carried = a.gradient[i][0] * drift[0] + a.gradient[i][1] * drift[1];
            close(a.rate[i], b.acceleration[i] - carried, 1e-10);
        }
        close(a.pressure, b.pressure, 1e-9);
    }
}
