//! Equilibria against references: cantilever, elastica, roll-up, catenaries from bad guesses.

mod common;

use common::{cantilever, data, models, number, place};
use ropewalk_core::statics::{Found, Statics, StaticsOptions};
use ropewalk_core::{Model, State};

/// Follows the load factor from 0 to 1 in equal steps.
fn follow(model: &Model, steps: usize) -> (State, Vec<Found>) {
    let mut statics = Statics::new(model, &StaticsOptions::default()).expect("statics");
    let mut state = model.state();
    let mut found = Vec::new();
    for k in 1..=steps {
        state.t = k as f64 / steps as f64;
        found.push(statics.find(&mut state, k == 1).unwrap_or_else(|e| panic!("step {k}: {e}")));
    }
    (state, found)
}

#[test]
fn cantilever_reproduces_the_tabulated_error_of_every_variant() {
    let all = data("cantilever.json");
    let mut worst: f64 = 0.0;
    for (case, c) in all.as_object().expect("cases") {
        if number(&c["EA"]) > 1e6 {
            continue;
        }
        let exact = number(&c["elastica_ext"][1]);
        for (variant, rows) in c["rows"].as_object().expect("rows") {
            let Some(m) = models(variant) else { continue };
            for n in [4, 8, 16, 32, 64] {
                let Some(tip) = rows[n.to_string()].as_array() else { continue };
                let model = cantilever(n, number(&c["EA"]), number(&c["F"]), m).build().expect("model");
                let (state, _) = follow(&model, 10);
                let y = place(&model, &state, "beam", 1.0)[1];
                let (error, tabulated) = ((y - exact) / exact, (number(&tip[1]) - exact) / exact);
                let off = (error - tabulated).abs();
                worst = worst.max(off);
                assert!(off <= (0.02 * tabulated.abs()).max(1e-9), "{case} {variant} n={n}: {error:e} {tabulated:e}");
            }
        }
    }
    println!("largest difference from the table: {worst:.1e}");
}

#[test]
fn newton_needs_few_iterations_however_stiff_the_cable() {
    let (mut most, mut mean_most) = (0, 0.0f64);
    for force in [3.0, 10.0] {
        for ea in [1.6e5, 1e8, 1e12] {
            for n in [4, 16, 64, 256] {
                for variant in ["L2+T1", "L4(lob3)+T3(2)", "L4+T3", "L3(lob3)+T2(2)", "L1+T1", "L3+T1"] {
                    // few elements of the full rule lock so hard that the plane shape is unstable out of its plane
                    let locks = variant.starts_with("L4+") || variant.starts_with("L3+");
                    if locks && n < 16 && ea > 1e8 {
                        continue;
                    }
                    let m = models(variant).expect("variant");
                    let model = cantilever(n, ea, force, m).build().expect("model");
                    let (state, found) = follow(&model, 10);
                    let iterations: Vec<u32> = found.iter().map(|f| f.iterations).collect();
                    let mean = f64::from(iterations.iter().sum::<u32>()) / 10.0;
                    let max = *iterations.iter().max().expect("ten");
                    println!("{force} {ea:.0e} {n} {variant}: mean {mean} max {max}");
                    most = most.max(max);
                    mean_most = mean_most.max(mean);
                    if n >= 64 {
                        let exact = if force == 3.0 { 0.603_253_44 } else { 0.810_609_02 };
                        let y = place(&model, &state, "beam", 1.0)[1];
                        assert!((y - exact).abs() < 3e-2 * exact, "{variant} n={n} EA={ea:e}: {y}");
                    }
                    assert!(mean <= 6.0 && max <= 8, "{variant} n={n} EA={ea:e} F={force}: {iterations:?}");
                }
            }
        }
    }
    println!("mean at most {mean_most}, never above {most}");
}
