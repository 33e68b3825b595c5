//! Scenes from input files of other codes.

use crate::program::run;
use std::fs;

const DECK: &str = include_str!("../data/moordyn.txt");

#[test]
fn a_deck_of_moordyn_becomes_a_scene_that_runs() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("deck.txt"), DECK).unwrap();
    let said = run(folder.path(), &["import", "deck.txt", "--out", "scene.toml"]);
    assert_eq!(said.code, Some(0), "{}", said.stderr);
    for note in ["dtM, TmaxIC left out", "point 3 is coupled", "outputs left out: L1N5px"] {
        assert!(said.stderr.contains(note), "{note} isn't in {}", said.stderr);
    }
    let scene = fs::read_to_string(folder.path().join("scene.toml")).unwrap();
    // the ratio of a segment of 8.75 m: ζ l √(m/EA)
    assert!(scene.contains("tension_only = true") && scene.contains("of a segment of 8.75 m"), "{scene}");
    fs::write(folder.path().join("scene.toml"), scene.replace("duration = \"60 s\"", "duration = \"0.2 s\""))
        .unwrap();
    let ran = run(folder.path(), &["run", "scene.toml", "--out", "out", "--no-report", "--no-plots"]);
    assert_eq!(ran.code, Some(0), "{}", ran.stderr);
    let history = fs::read_to_string(folder.path().join("out/history.csv")).unwrap();
    let cell = |name: &str| -> f64 {
        let mut lines = history.lines();
        let k = lines.next().unwrap().split(',').position(|c| c.starts_with(name)).unwrap();
        lines.next().unwrap().split(',').nth(k).unwrap().parse().unwrap()
    };
    // what hangs below the vessel pulls at both ends of the rope, by its weight in water more at its upper one
    let (top, anchor) = (cell("FairTen2"), cell("AnchTen1"));
    assert!(top > 1e4 && anchor > 0.5 * top && anchor < top, "{top} {anchor}");
}

#[test]
fn what_cannot_be_mapped_is_refused_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let refused = |was: &str, now: &str, holds: &[&str]| {
        assert!(DECK.contains(was));
        fs::write(folder.path().join("deck.txt"), DECK.replace(was, now)).unwrap();
        run(folder.path(), &["import", "deck.txt"]).refused(holds);
    };
    refused("1.674e9  -1.0", "1e9|2e9  -1.0", &["deck.txt:6", "EA `1e9|2e9`"]);
    refused("50      WtrDpth", "3 WaveKin", &["WaveKin 3", "[water.waves]"]);
    refused("3   Vessel", "3   Body1", &["deck.txt:13", "`Body1`"]);
    refused("2   rope      2", "2   rope      R2", &["`R2` is no point"]);
    refused("2   rope      2        3", "2   silk      2        3", &["no line type `silk`"]);
    refused("1.20  1.0   0.10", "1.20  x     0.10", &["Ca should be a number, not `x`"]);
    fs::write(folder.path().join("deck.txt"), "title = 1\n").unwrap();
    run(folder.path(), &["import", "deck.txt"]).refused(&["LINE TYPES", "MoorDyn"]);
    run(folder.path(), &["import", "none.txt"]).refused(&["none.txt"]);
}
