//! Tension of a mooring in an irregular sea: from a lattice and from the exact sum, and how it converges.

use super::run;

/// A chain of 500 m in 150 m of water whose upper end is held 4 m below the surface, in waves; its tension there every 0.1 s.
fn tension(elements: usize, tolerance: f64, waves: &str, seed: u64, end: f64) -> Vec<f64> {
    let h = run(&format!(
        r#"
        [run]
        duration = {end}
        output = 0.1
        from_equilibrium = true
        [solver]
        stepping = {{ controlled = {{ tolerance = {tolerance:e} }} }}
        [water]
        level = 0
        [water.waves]
        jonswap = {{ hs = 6, tp = 10 }}
        depth = 150
        ramp = 10
        seed = {seed}
        {waves}
        [[elements]]
        type = "cable"
        name = "line"
        points = [[450, 0, -150], [0, 0, -4]]
        length = 490
        elements = {elements}
        section = {{ mass = 120, ea = 6e8, diameter = 0.15, displaced = 0.0177, axial_retardation_time = 0.005, tension_only = true }}
        [[constraints]]
        type = "spherical"
        name = "anchor"
        marker = "line.start"
        [[constraints]]
        type = "spherical"
        name = "fairlead"
        marker = "line.end"
        [[forces]]
        type = "gravity"
        [[forces]]
        type = "buoyancy"
        [[forces]]
        type = "drag"
        cn = 2.4
        ct = 0.5
        [[forces]]
        type = "added_mass"
        ca = 1
        theory = "morison"
        [[records]]
        type = "reaction"
        of = "fairlead"
        what = "magnitude"
        "#
    ));
    let all = h.column("fairlead.magnitude").expect("column");
    // once the sea has risen
    all.iter().zip(h.times()).filter(|(_, t)| **t > 15.0).map(|(x, _)| *x).collect()
}

/// Deviation, and largest value less the mean.
fn spread(all: &[f64]) -> [f64; 2] {
    let n = all.len() as f64;
    let mean = all.iter().sum::<f64>() / n;
    let most = all.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    [(all.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / n).sqrt(), most - mean]
}

/// By how much the deviation and the largest value are off others.
fn apart(a: &[f64], b: &[f64]) -> [f64; 2] {
    let (a, b) = (spread(a), spread(b));
    std::array::from_fn(|i| (a[i] / b[i] - 1.0).abs())
}

#[test]
fn a_lattice_pulls_as_the_exact_sum() {
    // steps so short that the largest value doesn't hang on them
    let [lattice, exact] =
        ["lattice", "exact"].map(|how| tension(20, 1e-5, &format!("evaluation = \"{how}\""), 4, 60.0));
    let [deviation, most] = apart(&lattice, &exact);
    println!("deviation {:.1} N, off by {deviation:.1e}; largest off by {most:.1e}", spread(&exact)[0]);
    assert!(spread(&exact)[0] > 1e3 && deviation < 2e-3 && most < 5e-3, "{deviation} {most}");
}

/// Prints how tension converges with mesh, step and number of waves.
#[test]
#[ignore = "minutes: a table for the documentation"]
fn tension_in_waves_converges() {
    const END: f64 = 300.0;
    let fine = tension(80, 1e-5, "", 4, END);
    let row = |what: &str, found: &[f64], right: &[f64]| {
        let [deviation, most] = apart(found, right);
        let off: f64 =
            found.iter().zip(right).map(|(a, b)| (a - b).powi(2)).sum::<f64>() / right.len() as f64;
        let rms = off.sqrt() / spread(right)[0];
        println!("| {what} | {:.2} % | {:.2} % | {:.2} % |", 100.0 * rms, 100.0 * deviation, 100.0 * most);
        [deviation, most]
    };
    println!("| | difference | of deviation | of largest |\n| --- | --- | --- | --- |");
    let meshes: Vec<[f64; 2]> = [10, 20, 40]
        .iter()
        .map(|&n| row(&format!("{n} elements"), &tension(n, 1e-5, "", 4, END), &fine))
        .collect();
    assert!(meshes[2][0] < 1e-2 && meshes[2][0] < meshes[0][0], "{meshes:?}");
    for tolerance in [3e-4, 1e-4, 3e-5] {
        row(&format!("tolerance {tolerance:e}"), &tension(80, tolerance, "", 4, END), &fine);
    }
    let [deviation, most] = row("exact sum", &tension(80, 1e-5, "evaluation = \"exact\"", 4, END), &fine);
    assert!(deviation < 2e-3 && most < 5e-3, "{deviation} {most}");
    // other numbers of waves are other seas of the same spectrum: of some seeds the mean deviation
    let mean = |count: usize| {
        let seeds = 11_u64..17;
        let one = |seed| spread(&tension(20, 1e-4, &format!("count = {count}"), seed, END))[0];
        seeds.clone().map(one).sum::<f64>() / seeds.count() as f64
    };
    let many = mean(800);
    for count in [50, 100, 200, 400] {
        println!("| {count} waves | | {:.2} % | |", 100.0 * (mean(count) / many - 1.0).abs());
    }
}
