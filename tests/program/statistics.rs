//! What long runs say in few numbers: `statistics`, range graphs, and extremes over seeds.

use crate::program::run;
use std::fs;
use std::path::Path;

/// A slack line just below a short sea.
const SCENE: &str = r#"
title = "A line in short waves"

[parameters]
seed = { default = 1, description = "of the sea" }

[run]
duration = "20 s"
output = "0.1 s"
from_equilibrium = true

[[run.ranges]]
of = "line"
from = "5 s"

[water]
density = 1025
level = 0

[water.waves]
jonswap = { hs = "0.5 m", tp = "4 s" }
count = 20
seed = "$seed"
ramp = "2 s"

[[elements]]
type = "cable"
name = "line"
points = [[0, 0, "-1 m"], ["4 m", 0, "-1 m"]]
length = "4.2 m"
elements = 4
section = { mass = "5 kg/m", ea = "1 MN", ei = "10 N m^2", diameter = "4 cm", axial_retardation_time = "5 ms" }

[[constraints]]
type = "spherical"
name = "left"
marker = "line.start"

[[constraints]]
type = "spherical"
name = "right"
marker = "line.end"

[[forces]]
type = "gravity"

[[forces]]
type = "buoyancy"

[[forces]]
type = "drag"
cn = 1.2

[[records]]
type = "reaction"
of = "right"
what = "magnitude"

[[records]]
type = "position"
of = "line@2.1m"
name = "middle"
"#;

/// Columns of a table: heading and numbers.
fn table(path: &Path) -> Vec<(String, Vec<f64>)> {
    let text = fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let mut lines = text.lines().map(|l| l.split(',').map(String::from).collect::<Vec<_>>());
    let heads = lines.next().unwrap();
    let rows: Vec<Vec<String>> = lines.collect();
    let values = |k: usize| rows.iter().map(|r| r[k].parse().unwrap_or(f64::NAN)).collect();
    heads.iter().enumerate().map(|(k, h)| (h.clone(), values(k))).collect()
}

fn column(table: &[(String, Vec<f64>)], name: &str) -> Vec<f64> {
    let found = table.iter().find(|(h, _)| h.starts_with(name));
    found
        .unwrap_or_else(|| panic!("no {name} in {:?}", table.iter().map(|t| &t.0).collect::<Vec<_>>()))
        .1
        .clone()
}

#[test]
fn a_run_tells_its_statistics_and_its_ranges() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("sea.toml"), SCENE).unwrap();
    let ran = run(folder.path(), &["run", "sea.toml", "--out", "out", "--no-report"]);
    assert_eq!(ran.code, Some(0), "{}", ran.stderr);
    let out = folder.path().join("out");
    // the range of the middle holds what the history shows of it, and a little more between its rows
    let (range, history) = (table(&out.join("tables/range-line.csv")), table(&out.join("history.csv")));
    let s = column(&range, "s ");
    assert_eq!(s.len(), 9);
    let middle = s.iter().position(|s| (s - 2.1).abs() < 1e-9).unwrap();
    let (t, z) = (column(&history, "t "), column(&history, "middle.z"));
    let seen: Vec<f64> = t.iter().zip(&z).filter(|(t, _)| **t >= 5.0).map(|(_, z)| *z).collect();
    let (low, high) =
        seen.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), z| (a.min(*z), b.max(*z)));
    let mean = seen.iter().sum::<f64>() / seen.len() as f64;
    let deviation = (seen.iter().map(|z| (z - mean).powi(2)).sum::<f64>() / seen.len() as f64).sqrt();
    let of = |name: &str| column(&range, name)[middle];
    let wide = high - low;
    // between rows there may be a little more
    let beyond = |x: f64| (-1e-9..0.05 * wide).contains(&x);
    assert!(beyond(low - of("z.least")) && beyond(of("z.largest") - high), "{low} {high}");
    assert!((of("z.mean") - mean).abs() < 0.02 * wide && (of("z.deviation") - deviation).abs() < 0.02 * wide);
    assert!(out.join("plots/range-line-tension.svg").is_file());

    let told = run(
        folder.path(),
        &["statistics", "out", "--from", "5 s", "--of", "right", "--fatigue", "316,3", "--strength", "1e5"],
    );
    assert_eq!(told.code, Some(0), "{}", told.stderr);
    let all = table(&out.join("tables/statistics.csv"));
    let pull: Vec<f64> = t
        .iter()
        .zip(column(&history, "right.magnitude"))
        .filter(|(t, _)| **t >= 5.0)
        .map(|(_, x)| x)
        .collect();
    let mean = pull.iter().sum::<f64>() / pull.len() as f64;
    assert!((column(&all, "mean")[0] / mean - 1.0).abs() < 1e-9);
    assert!(column(&all, "damage")[0] > 0.0 && column(&all, "cycles")[0] > 2.0);
    let cycles = table(&out.join("tables/cycles-right.magnitude.csv"));
    let damage: f64 = column(&cycles, "range")
        .iter()
        .zip(column(&cycles, "count"))
        .map(|(r, n)| n / (316.0 * (r / 1e5).powi(-3)))
        .sum();
    assert!((column(&all, "damage")[0] / damage - 1.0).abs() < 1e-9);
    assert!(out.join("plots/spectrum-right.magnitude.svg").is_file());
    run(folder.path(), &["statistics", "out", "--of", "rigt"]).refused(&["no record `rigt`"]);
    run(folder.path(), &["statistics", "out", "--fatigue", "3"]).refused(&["two or four positive numbers"]);
    run(folder.path(), &["statistics", "."]).refused(&["history.csv"]);
}

#[test]
fn seeds_tell_extremes_with_their_intervals() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(
        folder.path().join("sea.toml"),
        SCENE.replace("\"20 s\"", "\"6 s\"").replace("\"5 s\"", "\"2 s\""),
    )
    .unwrap();
    let said =
        run(folder.path(), &["sweep", "sea.toml", "--vary", "seed=1:6:1", "--extremes", "--out", "seas"]);
    assert_eq!(said.code, Some(0), "{}", said.stderr);
    assert!(said.stdout.contains("most probable") && said.stdout.contains("6 runs"), "{}", said.stdout);
    let all = table(&folder.path().join("seas/tables/extremes.csv"));
    let (low, best, high) =
        (column(&all, "95 % from")[0], column(&all, "most probable")[0], column(&all, "95 % to")[0]);
    assert!(low < best && best < high, "{low} {best} {high}");
    // the same by hand from the table of the runs
    let runs = table(&folder.path().join("seas/table.csv"));
    let mut largest = column(&runs, "max right.magnitude");
    largest.sort_by(f64::total_cmp);
    let n = largest.len() as f64;
    let mean = largest.iter().sum::<f64>() / n;
    let weighted: f64 = largest.iter().enumerate().map(|(k, x)| k as f64 / (n - 1.0) * x).sum::<f64>() / n;
    let scale = (2.0 * weighted - mean) / 2f64.ln();
    assert!((best / (mean - 0.577_215_664_901_532_9 * scale) - 1.0).abs() < 1e-9, "{best}");
}
