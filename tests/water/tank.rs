//! A measured experiment beside a computed one: the chain in a tank of `examples/sea`.

use ropewalk::scene::Format;
use ropewalk::{SceneFile, simulate};

/// Measured means of the largest tensions of each turn [N]: a row for each radius [m], a column for each period [s].
fn measured() -> (Vec<f64>, Vec<(f64, Vec<f64>)>) {
    let mut lines = include_str!("../../examples/sea/tank.csv").lines();
    let heads = lines.next().unwrap_or_default().split(',').skip(1);
    let periods = heads.map(|h| h.split(' ').next().unwrap_or_default().parse().expect("a period")).collect();
    let row = |line: &str| {
        let all: Vec<f64> = line.split(',').map(|x| x.parse().expect("a number")).collect();
        (all[0], all[1..].to_vec())
    };
    (periods, lines.map(row).collect())
}

/// The mean of the largest tensions from the eighth turn on.
fn computed(period: f64, radius: f64, turns: usize, elements: usize) -> f64 {
    let text = include_str!("../../examples/sea/chain.toml");
    let set = [
        format!("period={period} s"),
        format!("radius={radius} m"),
        format!("turns={turns}"),
        format!("elements={elements}"),
    ];
    let file = SceneFile::parse(text, "chain", Format::Toml, &set).unwrap_or_else(|e| panic!("{e}"));
    let history = simulate(file.scene()).unwrap_or_else(|e| panic!("{e}"));
    let pull = history.column("fairlead.magnitude").expect("the tension");
    let largest = |turn: usize| {
        let within = |t: f64| t >= turn as f64 * period && t < (turn + 1) as f64 * period;
        let values = history.times().iter().zip(pull).filter(|(t, _)| within(**t)).map(|(_, x)| *x);
        values.fold(f64::NAN, f64::max)
    };
    (7..turns).map(largest).sum::<f64>() / (turns - 7) as f64
}

#[test]
fn a_chain_in_a_tank_pulls_as_measured() {
    let (periods, rows) = measured();
    let (k, row) = (1, &rows[3]);
    assert_eq!((periods[k], row.0), (2.0, 0.15));
    let pull = computed(2.0, 0.15, 9, 16);
    println!("{pull:.2} N computed, {} N measured", row.1[k]);
    assert!((pull / row.1[k] - 1.0).abs() < 0.06, "{pull} N");
}

#[test]
#[ignore = "20 runs, minutes"]
fn all_chains_in_the_tank_pull_as_measured() {
    let (periods, rows) = measured();
    let (mut squares, mut worst) = (0.0, 0.0_f64);
    for (radius, row) in &rows {
        for (period, there) in periods.iter().zip(row) {
            let off = computed(*period, *radius, 16, 40) / there - 1.0;
            println!(
                "T = {period} s, R = {radius} m: {:.1} N, measured {there} N, {:+.1} %",
                there * (1.0 + off),
                100.0 * off
            );
            squares += off * off / 20.0;
            worst = worst.max(off.abs());
        }
    }
    println!("off by {:.1} % in the mean, {:.1} % at most", 100.0 * squares.sqrt(), 100.0 * worst);
    assert!(squares.sqrt() < 0.045 && worst < 0.08, "{} {worst}", squares.sqrt());
}
