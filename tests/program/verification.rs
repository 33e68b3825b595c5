//! The verification suite, a test for each case; `ropewalk verify` runs the same and shows more. And what that command
//! says, writes and refuses.

use crate::program::run;
use ropewalk::report::{ProgressMode, Watch};
use ropewalk::verify::{case, cases, heading, lines};
use std::fs;

#[track_caller]
fn within(name: &str) {
    let outcome = case(name).expect("a case").run(ProgressMode::Quiet, Watch::default());
    println!("{}\n{}", heading(&outcome), lines(&outcome).join("\n"));
    assert!(outcome.is_within(), "{}\n{}", heading(&outcome), lines(&outcome).join("\n"));
}

macro_rules! suite {
    ($($(#[$how:meta])* $name:ident,)*) => {
        $(#[test] $(#[$how])* fn $name() { within(stringify!($name)); })*
        const TESTED: &[&str] = &[$(stringify!($name)),*];
    };
}

suite! {
    a01_simple_pendulum,
    #[ignore = "forty thousand steps of 81 bodies"]
    a02_n_four_bar,
    a03_andrews_squeezer,
    bend45_cantilever,
    cable_in_current_equilibrium,
    contact_bounce_friction_pulley,
    door_two_hinges_redundant,
    double_pendulum_chaotic,
    driven_rod_inverse_dynamics,
    elastic_catenary,
    elastica_cantilever,
    flexible_pendulum_released_horizontally,
    flying_spaghetti_2d,
    free_rigid_body_dzhanibekov,
    hooke_joint_driven,
    inconsistent_initial_conditions_pendulum,
    integrator_signature_linear_oscillator,
    modes_string_chain_beam,
    nlink_chain_10_horizontal_release,
    princeton_beam,
    rod_pendulum_near_separatrix,
    rollup_cantilever,
    rotating_beam_modes,
    sinking_cylinder_drag,
    spatial_slider_crank,
    spinup_flexible_arm,
}

#[test]
fn every_case_has_its_test_and_its_reasons() {
    let all = cases();
    assert_eq!(all.iter().map(|c| c.name).collect::<Vec<_>>(), TESTED);
    for c in &all {
        assert!(c.quantities() > 0 || !c.left_out.is_empty(), "{} says nothing", c.name);
        assert!(c.left_out.iter().all(|l| l.count > 0 && l.reason.len() > 20), "{}", c.name);
        assert!(!c.title.is_empty() && !c.source.is_empty() && c.suggested_cpu_s > 0.0, "{}", c.name);
    }
}

#[test]
fn unknown_cases_are_refused_with_the_near_ones() {
    let folder = tempfile::tempdir().unwrap();
    for (name, near) in [
        ("cantilever", "did you mean bend45_cantilever or elastica_cantilever or rollup_cantilever?"),
        ("elastika_cantilever", "did you mean `elastica_cantilever`?"),
        ("zzz", "`ropewalk verify --list` names them all"),
    ] {
        run(folder.path(), &["verify", "rollup", name]).refused(&[&format!("no case `{name}`"), near]);
    }
}

#[test]
fn the_list_names_all_and_runs_none() {
    let folder = tempfile::tempdir().unwrap();
    let said = run(folder.path(), &["verify", "--list"]);
    assert_eq!((said.code, said.stdout.lines().count()), (Some(0), cases().len()), "{}", said.stderr);
}

#[test]
fn a_page_is_written_with_its_picture_and_replaces_none_but_pages() {
    let folder = tempfile::tempdir().unwrap();
    let verify = |out: &str| run(folder.path(), &["verify", "inconsistent", "bend45", "-o", out]);
    for _ in 0..2 {
        let said = verify("docs/verification.md");
        assert_eq!(said.code, Some(0), "{}", said.stderr);
        assert!(said.stdout.contains("projected position") && said.stdout.contains("tip"), "{}", said.stdout);
    }
    let page = fs::read_to_string(folder.path().join("docs/verification.md")).unwrap();
    assert!(page.contains("](verification.svg)") && page.contains("| rod tension | 8.847466"), "{page}");
    let picture = fs::read_to_string(folder.path().join("docs/verification.svg")).unwrap();
    assert!(picture.contains("inconsistent_initial_conditions_pendulum"));
    fs::write(folder.path().join("notes.md"), "# Notes\n").unwrap();
    verify("notes.md").refused(&["notes.md is no page of results: it stays"]);
    verify("docs").refused(&["docs is a folder"]);
    verify("page.txt").refused(&["doesn't end in .md"]);
}

#[test]
fn the_scenes_of_a_case_run_like_any_others() {
    let folder = tempfile::tempdir().unwrap();
    let said = run(folder.path(), &["verify", "inconsistent", "--scenes", "scenes"]);
    assert_eq!((said.code, said.stdout.as_str()), (Some(0), "1 scene in scenes\n"), "{}", said.stderr);
    let scene = "scenes/inconsistent_initial_conditions_pendulum.toml";
    assert_eq!(run(folder.path(), &["run", scene, "--quiet"]).code, Some(0));
    run(folder.path(), &["verify", "--scenes", "scenes"]).refused(&["is not empty"]);
    // one whose parts are many is written with all of them
    let said = run(folder.path(), &["verify", "a02", "--scenes", "bars"]);
    assert_eq!((said.code, said.stdout.as_str()), (Some(0), "2 scenes in bars\n"), "{}", said.stderr);
    let said = run(folder.path(), &["check", "bars/a02_n_four_bar_40.toml"]);
    assert!(said.code == Some(0) && said.stdout.contains("crank40 (rigid_body)"), "{said:?}");
}
