//! What long runs say in few numbers: `statistics`, range graphs, and extremes over seeds.

use crate::program::run;
use serde_json::Value;
use std::fs;
use std::io::Read;
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

[[run.statistics]]
of = ["right", "middle.z"]
from = "5 s"
fatigue = { k = 316, m = 3, breaking_load = "100 kN" }

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

[[records]]
type = "wall_tension"
of = "line"
at = ["50 %"]

[[records]]
type = "direction"
of = "line"
"#;

/// The text of a page's data.
fn page(path: &Path) -> Value {
    let html = fs::read_to_string(path).unwrap();
    let data = html
        .split("<script id=\"data\" type=\"text/plain\">")
        .nth(1)
        .unwrap()
        .split("</script>")
        .next()
        .unwrap();
    let packed: Vec<u8> = {
        let code = |c: u8| match c {
            b'A'..=b'Z' => Some(c - b'A'),
            b'a'..=b'z' => Some(c - b'a' + 26),
            b'0'..=b'9' => Some(c - b'0' + 52),
            b'+' => Some(62),
            b'/' => Some(63),
            _ => None,
        };
        let sextets: Vec<u32> = data.bytes().filter_map(code).map(u32::from).collect();
        let bytes = |four: &[u32]| {
            let word = (0..4).fold(0, |word, k| (word << 6) | four.get(k).copied().unwrap_or(0));
            word.to_be_bytes()[1..four.len()].to_vec()
        };
        sextets.chunks(4).flat_map(bytes).collect()
    };
    let mut bytes = Vec::new();
    flate2::read::ZlibDecoder::new(&packed[..]).read_to_end(&mut bytes).unwrap();
    let length = u32::from_le_bytes(bytes[..4].try_into().unwrap()) as usize;
    serde_json::from_slice(&bytes[4..4 + length]).unwrap()
}

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
    let ran = run(folder.path(), &["run", "sea.toml", "--out", "out"]);
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
    // wall and effective tension at the middle, and the direction there, over the whole run or as at one instant
    let within = |x: f64, a: f64, b: f64| x >= a - 1e-9 && x <= b + 1e-9;
    let wall = column(&history, "line.wall_tension@50%");
    for (t, x) in t.iter().zip(&wall).filter(|(t, _)| **t >= 5.0) {
        assert!(within(*x, of("wall_tension.least"), of("wall_tension.largest")), "{t} {x}");
    }
    let start = column(&range, "declination.start")[0];
    assert!((start - column(&history, "line.start.declination")[0]).abs() < 1e-12, "{start}");
    assert!(column(&range, "azimuth.start").iter().all(|a| a.abs() < 1e-9));
    assert!(range.iter().all(|(name, _)| !name.starts_with("clearance")), "there is no bed");

    // what the scene asks for stands in tables, on the terminal and on the page
    assert!(
        ran.stdout.contains("Statistics From 5 s to 20 s. Fatigue: N = 316 (range/100000)^-3"),
        "{}",
        ran.stdout
    );
    assert!(ran.stdout.contains("damage a year"), "all columns are told, however narrow the terminal");
    let asked = table(&out.join("tables/statistics.csv"));
    assert!(out.join("tables/cycles-right.magnitude.csv").is_file());
    assert!(!out.join("tables/cycles-middle.z.csv").exists(), "heights have no breaking load");
    let text = page(&out.join("report.html"));
    let listing = &text["listings"][0];
    assert_eq!((&listing["title"], listing["rows"].as_array().unwrap().len()), (&"Statistics".into(), 2));
    let mean: f64 = listing["rows"][0][1].as_str().unwrap().parse().unwrap();
    assert!((mean / column(&asked, "mean")[0] - 1.0).abs() < 1e-4);
    let names: Vec<&str> =
        text["ranges"].as_array().unwrap().iter().map(|r| r["quantity"].as_str().unwrap()).collect();
    assert_eq!(
        names,
        ["tension", "wall_tension", "curvature", "moment", "declination", "azimuth", "x", "y", "z"]
    );
    assert_eq!(text["ranges"][0]["window"], serde_json::json!([5.0, 20.0]));
    assert_eq!(text["field"]["waves"]["all"]["rows"], 20);

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
    // the page has the new table in place of the old one
    let text = page(&out.join("report.html"));
    let listings = text["listings"].as_array().unwrap();
    assert_eq!((listings.len(), listings[0]["rows"].as_array().unwrap().len()), (1, 1));
    assert_eq!(text["ranges"].as_array().unwrap().len(), 9);
    run(folder.path(), &["statistics", "out", "--of", "rigt"]).refused(&["no record `rigt`"]);
    run(folder.path(), &["statistics", "out", "--fatigue", "3"]).refused(&["two or four positive numbers"]);
    run(folder.path(), &["statistics", "."]).refused(&["history.csv"]);
}

#[test]
fn statistics_that_can_not_be_are_refused_where_they_stand() {
    let folder = tempfile::tempdir().unwrap();
    let asked = "[[run.statistics]]\nof = [\"right\", \"middle.z\"]\nfrom = \"5 s\"\nfatigue = { k = 316, m = 3, breaking_load = \"100 kN\" }\n";
    assert!(SCENE.contains(asked));
    for (instead, said) in [
        ("of = [\"rigth\"]", "no record `rigth`"),
        ("from = \"30 s\"", "statistics from 30 s to 20 s of a run of 20 s"),
        ("to = \"60 s\"", "statistics from 0 s to 60 s of a run of 20 s"),
        ("fatigue = { k = 316, m = 3 }", "fatigue needs the `breaking_load`"),
        ("fatigue = { k = 316, m = -3, stress = \"1 MPa\" }", "`m` must be positive"),
        ("fatigue = { k = 316, m = 3, stress = \"1 MPa\" }", "none of these records is in Pa"),
        ("fatigue = { k = 316, m = 3, breaking_load = \"1 MPa\" }", "is a pressure"),
        ("[[run.statistics]]\nfrom = \"5 s\"", "two tables of statistics are named `statistics`"),
        ("[[run.ranges]]\nof = \"line\"", "two range graphs are named `line`"),
        ("[[run.ranges]]\nof = \"lime\"", "no part `lime`"),
    ] {
        let text = SCENE.replace(asked, &format!("[[run.statistics]]\n{instead}\n"));
        fs::write(folder.path().join("sea.toml"), text).unwrap();
        run(folder.path(), &["run", "sea.toml", "--out", "out"]).refused(&[said, "--> sea.toml:"]);
    }
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
    let (low, best, high) = (
        column(&all, "most probable 2.5 %")[0],
        column(&all, "most probable")[0],
        column(&all, "most probable 97.5 %")[0],
    );
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
