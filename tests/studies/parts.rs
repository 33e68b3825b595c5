//! Sweeps that several processes compute: plans, parts, kills at any moment, and two of everything at once.

use crate::program::{Said, program, run, signals};
use crate::sweep::{cells, done, folder, table, text, timeless};
use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// `ropewalk` with these arguments, separated by blanks, in the background.
fn start(folder: &Path, arguments: &str) -> Child {
    let mut command = program(folder, &arguments.split_whitespace().collect::<Vec<_>>());
    command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
}

fn call(folder: &Path, arguments: &str) -> Said {
    run(folder, &arguments.split_whitespace().collect::<Vec<_>>())
}

fn wait_until(what: &str, is: impl Fn() -> bool) {
    let start = Instant::now();
    while !is() {
        assert!(start.elapsed() < Duration::from_secs(60), "{what}");
        std::thread::sleep(Duration::from_millis(2));
    }
}

/// Runs in the folder of a sweep that are whole.
fn complete(out: &Path) -> usize {
    let runs = fs::read_dir(out.join("runs")).into_iter().flatten().flatten();
    let hidden = |name: &std::ffi::OsStr| name.to_string_lossy().starts_with('.');
    runs.filter(|e| !hidden(&e.file_name()) && e.path().join("summary.json").exists()).count()
}

const SWEEP: &str = "sweep swing.toml --vary mass=2kg/m,3,4,5 --vary n=2,3,4 --set duration=0.2";

/// The folder holds what one process makes of the same sweep, to the last bit but for clocks.
#[track_caller]
fn same_as_one_process(here: &Path, out: &str) {
    done(call(here, &format!("{SWEEP} --out whole --quiet")));
    let (whole, out) = (here.join("whole"), here.join(out));
    assert_eq!(timeless(whole.join("table.csv")), timeless(out.join("table.csv")));
    let names: Vec<String> = table(whole.join("table.csv")).iter().map(|r| r["run"].clone()).collect();
    for name in &names {
        for file in ["history.csv", "scene.toml", "manifest.json", "shapes.csv"] {
            let at = |folder: &Path| text(folder.join("runs").join(name).join(file));
            assert!(at(&whole) == at(&out), "{name}: {file}");
        }
    }
    assert_eq!(fs::read_dir(out.join("runs")).unwrap().count(), names.len(), "something was left");
    assert_eq!(text(whole.join("sweep.json")), text(out.join("sweep.json")));
    for plot in ["rope.end.z.svg", "rope.end.z-final.svg"] {
        assert!(text(whole.join("plots").join(plot)) == text(out.join("plots").join(plot)), "{plot}");
    }
}

#[test]
fn parts_are_collected_into_the_table_of_one_process() {
    let folder = folder();
    let here = folder.path();
    let plan = done(call(here, &format!("{SWEEP} --out out --plan --jobs 1")));
    for word in [
        "12, 12 of them to be computed",
        "2 would do",
        "--array=1-2",
        "--part $SLURM_ARRAY_TASK_ID/2",
        "plan.csv",
    ] {
        assert!(plan.contains(word), "no {word} in\n{plan}");
    }
    let rows = table(here.join("out/plan.csv"));
    assert_eq!((rows.len(), rows[4]["number"].as_str(), rows[4]["run"].as_str()), (12, "5", "mass=3,n=3"));
    assert_eq!((rows[4]["mass [kg/m]"].as_str(), rows[4]["n"].as_str()), ("3", "3"));
    assert!(!here.join("out/runs").exists() && !here.join("out/table.csv").exists());

    // the shares overlap, and all are at work at the same time
    let shares =
        ["1/2", "2/2", "1/3", "1/2"].map(|k| start(here, &format!("{SWEEP} --out out --part {k} --jobs 1")));
    for share in shares {
        let said = done(Said::of(share.wait_with_output().unwrap()));
        assert!(said.contains(" runs are complete"), "{said}");
    }
    let again = done(call(here, &format!("{SWEEP} --out out --plan")));
    assert!(again.contains("12, 0 of them to be computed"), "{again}");
    let said = done(call(here, &format!("{SWEEP} --out out --part 2/5")));
    assert!(said.contains("part 2/5: 3 of 3 runs are complete, 3 from before"), "{said}");
    let report = done(call(here, &format!("{SWEEP} --out out")));
    assert!(report.contains("12 of them were there already"), "{report}");
    same_as_one_process(here, "out");
}

#[test]
fn parts_that_are_killed_lose_nothing() {
    let folder = folder();
    let here = folder.path();
    let out = here.join("out");
    let command = format!("{SWEEP} --out out --jobs 1");
    for (k, from) in [(1, 1), (2, 3), (1, 5)] {
        let mut share = start(here, &format!("{command} --part {k}/2"));
        wait_until("no run was computed", || complete(&out) >= from);
        share.kill().unwrap();
        share.wait().unwrap();
    }
    let before = complete(&out);
    assert!((1..12).contains(&before), "{before}");
    // one part begins again, the command that collects computes the rest
    done(call(here, &format!("{command} --part 1/2")));
    done(call(here, &command));
    same_as_one_process(here, "out");
}

#[test]
fn parts_and_the_whole_are_not_at_work_together() {
    let folder = folder();
    let here = folder.path();
    let endless = "sweep swing.toml --vary duration=0.02,10000 --out out";
    let mut share = start(here, &format!("{endless} --part 2/2"));
    wait_until("it doesn't begin", || here.join("out/runs").exists());
    call(here, endless).refused(&["another sweep is at work in out", "wait for its end"]);
    call(here, &format!("{endless} --fresh")).refused(&["another sweep is at work in out"]);
    // but another part is welcome
    done(call(here, &format!("{endless} --part 1/2")));
    share.kill().unwrap();
    share.wait().unwrap();
    let mut whole = start(here, endless);
    wait_until("it doesn't begin", || here.join("out/runs/duration=10000/history.csv").exists());
    call(here, &format!("{endless} --part 1/2")).refused(&["another sweep is at work in out"]);
    whole.kill().unwrap();
    whole.wait().unwrap();
    for (arguments, holds) in [
        ("--part 3/2", "there is no part 3 of 2"),
        ("--part 1", "like `3/40`"),
        ("--part 1/2 --fresh", "cannot be used with"),
        ("--part 1/2 --plan", "cannot be used with"),
        ("--dask tcp://a:1", "python -m ropewalk"),
    ] {
        let said = call(here, &format!("{endless} {arguments}"));
        assert!(said.code == Some(2) && said.stderr.contains(holds), "{}", said.stderr);
    }
}

#[cfg(unix)]
#[test]
fn signals_end_a_part_as_they_end_a_run() {
    let folder = folder();
    let here = folder.path();
    for (signal, name, code) in signals() {
        let arguments =
            format!("sweep swing.toml --vary duration=0.02,10000 --out {signal} --part 1/1 --jobs 2");
        let child = start(here, &arguments);
        let out = here.join(signal);
        let computes = || {
            let runs = fs::read_dir(out.join("runs")).into_iter().flatten().flatten();
            let sizes = runs.filter_map(|e| Some(fs::metadata(e.path().join("history.csv")).ok()?.len()));
            sizes.max() > Some(1000)
        };
        wait_until("it doesn't begin", || complete(&out) == 1 && computes());
        let kill = format!("kill -{signal} {}", child.id());
        assert!(Command::new("sh").args(["-c", &kill]).status().unwrap().success());
        let said = Said::of(child.wait_with_output().unwrap());
        assert_eq!(said.code, Some(code), "{}", said.stderr);
        assert!(said.stderr.contains(&format!("stopped by {name}: 1 of 2 runs")), "{}", said.stderr);
        // what was computed of the other run is there too
        let summary = text(out.join("runs/duration=10000/summary.json"));
        assert!(summary.contains("\"interrupted\""), "{summary}");
    }
}

#[test]
fn a_folder_has_one_run_at_a_time() {
    let folder = folder();
    let here = folder.path();
    let endless = "run swing.toml --set duration=10000 --out out --checkpoint";
    let mut first = start(here, &format!("{endless} 0.05s"));
    wait_until("it doesn't begin", || here.join("out/checkpoint").exists());
    for second in [format!("{endless} 1h"), "resume out".into()] {
        call(here, &second)
            .refused(&["another run is at work in out: wait for its end, or take another folder"]);
    }
    first.kill().unwrap();
    first.wait().unwrap();
    // a lock of the dead holds nobody up
    let mut resumed = start(here, "resume out");
    wait_until("it doesn't go on", || !text_or_nothing(&here.join("out/history.csv")).is_empty());
    std::thread::sleep(Duration::from_millis(100));
    assert!(resumed.try_wait().unwrap().is_none());
    call(here, "resume out").refused(&["another run is at work in out"]);
    resumed.kill().unwrap();
    resumed.wait().unwrap();
    done(call(here, "run swing.toml --set duration=0.02 --out short -q"));
    assert!(!here.join("short/.lock").exists());
}

fn text_or_nothing(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_default()
}

#[test]
fn samples_are_drawn_beside_lists() {
    let folder = folder();
    let here = folder.path();
    let samples = "sweep swing.toml --vary mass=1..3kg/m --vary law=L4,L3 --vary n=2..5:1 --set duration=0.02 --samples 6 --seed 4";
    let report = done(call(here, &format!("{samples} --out a")));
    assert!(report.contains("12 finished"), "{report}");
    done(call(here, &format!("{samples} --out b -q")));
    assert_eq!(timeless(here.join("a/table.csv")), timeless(here.join("b/table.csv")));
    let rows = table(here.join("a/table.csv"));
    assert_eq!(rows.len(), 12);
    for (k, row) in rows.iter().enumerate() {
        let mass: f64 = row["mass [kg/m]"].parse().unwrap();
        assert!((1.0..3.0).contains(&mass) && ["2", "3", "4", "5"].contains(&row["n"].as_str()));
        // both laws have the same samples
        assert_eq!(
            (row["law"].as_str(), &row["mass [kg/m]"]),
            (["L4", "L3"][k / 6], &rows[k % 6]["mass [kg/m]"])
        );
    }
    // a row for each sample, a line for each law
    let finals = text(here.join("a/tables/rope.end.z-final.csv"));
    let lines: Vec<Vec<String>> = finals.lines().map(cells).collect();
    assert_eq!(lines[0], ["mass [kg/m]", "rope.end.z [m]: law=L4", "rope.end.z [m]: law=L3"]);
    assert!(lines.len() == 7 && lines.iter().flatten().all(|cell| !cell.is_empty()), "{finals}");
    assert!(here.join("a/plots/rope.end.z-final.svg").exists());
    let more = samples.replace("--seed 4", "--seed 5");
    call(here, &format!("{more} --out a")).refused(&["of 6 samples of mass and n with the seed 4"]);
    call(here, &format!("{samples} --latin --out a")).refused(&["of 6 samples of mass"]);
    for (arguments, holds) in [
        ("--vary mass=1..3", "`1..3` is a range to draw from, which takes `--samples`"),
        ("--vary mass=3..1 --samples 3", "is a range that ends before it begins"),
        ("--vary mass=1,2 --samples 3", "there is no range to draw samples from"),
        ("--vary mass=1..2s --samples 3", "expected a mass per length"),
        ("--vary n=-4..-2:1 --samples 3", "elements"),
        ("--vary n=1..2 --samples 200000", "200000 samples are more than 100000"),
    ] {
        call(here, &format!("sweep swing.toml {arguments}")).refused(&[holds]);
    }
    assert_eq!(call(here, "sweep swing.toml --vary mass=1,2 --latin").code, Some(2));
}
