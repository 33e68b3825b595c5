//! Lines on meshes too coarse for how sharply they bend, against the closed form of a catenary on a level bed.

use super::common::{reaction, size};
use ropewalk::scene::{Format, SceneFile};
use ropewalk_core::statics::Statics;
use ropewalk_core::{Model, State};

const LENGTH: f64 = 750.0;
const DEPTH: f64 = 100.0;
const EA: f64 = 5.4e8;
/// Weight in water [N/m].
const WEIGHT: f64 = 985.27;
const STIFFNESS: f64 = 1e6;

/// A studless chain of 76 mm between an anchor and a fairlead that is `across` away and [`DEPTH`] above it.
fn chain(across: f64, elements: usize) -> (Model, State) {
    let bed = -DEPTH - 0.06 - WEIGHT / STIFFNESS;
    let text = format!(
        r#"
        gravity = [0, 0, -9.81]
        run = {{ analysis = "statics" }}
        [[elements]]
        type = "cable"
        name = "line"
        points = [[0, 0, {}], [{across}, 0, 0]]
        length = {LENGTH}
        elements = {elements}
        section = {{ mass = {}, ea = {EA}, diameter = 0.12 }}
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
        type = "bed"
        point = [0, 0, {bed}]
        stiffness = {STIFFNESS}
        "#,
        -DEPTH,
        WEIGHT / 9.81
    );
    let scene = SceneFile::parse(&text, "chain", Format::Toml, &[]).expect("a scene").into_scene();
    let model = scene.build().expect("a model");
    let mut state = model.state();
    let mut statics = Statics::new(&model, &scene.statics).expect("memory");
    statics.find(&mut state, true).unwrap_or_else(|e| panic!("{e}"));
    drop(statics);
    (model, state)
}

fn root(mut from: f64, mut to: f64, f: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..200 {
        let middle = 0.5 * (from + to);
        if f(middle) > 0.0 { to = middle } else { from = middle }
    }
    from
}

/// Its tension at the fairlead [N]: of length `s` hangs free, which rises by `H/w (√(1 + (ws/H)²) - 1) + ws²/2EA` and reaches
/// `H/w asinh(ws/H) + Hs/EA` far.
fn tension(across: f64) -> f64 {
    let hanging = |h: f64| {
        let rise = |s: f64| h / WEIGHT * ((WEIGHT * s / h).hypot(1.0) - 1.0) + WEIGHT * s * s / (2.0 * EA);
        root(0.0, 2.0 * LENGTH, |s| rise(s) - DEPTH)
    };
    let reach = |h: f64| {
        let s = hanging(h);
        (LENGTH - s) * (1.0 + h / EA) + h / WEIGHT * (WEIGHT * s / h).asinh() + h * s / EA
    };
    let h = root(1.0, 1e7, |h| reach(h) - across);
    h.hypot(WEIGHT * hanging(h))
}

/// By how much the tension at the fairlead is off, and what is said of the mesh.
fn off(across: f64, elements: usize) -> (f64, Option<String>) {
    let (model, state) = chain(across, elements);
    let said =
        model.remarks_at_rest(&state.at()).into_iter().find(|text| text.contains("too long for how sharply"));
    (size(reaction(&model, &state, "fairlead")) / tension(across) - 1.0, said)
}

#[test]
fn a_mesh_too_coarse_for_a_touchdown_or_a_steep_end_is_told() {
    // nothing that is off by more than a per cent goes without a word
    for across in [660.0, 675.0, 690.0, 720.0, 740.0] {
        for elements in [8, 12, 20, 30, 60] {
            let (off, said) = off(across, elements);
            println!("{across} m, {elements} elements: {:+.2} %, {said:?}", 100.0 * off);
            assert!(off.abs() < 0.01 || said.is_some(), "{across} m, {elements} elements: {off}");
        }
    }
}

#[test]
fn what_is_told_of_a_mesh_helps_and_good_meshes_hear_nothing() {
    for across in [660.0, 690.0] {
        let (mut elements, mut rounds) = (8, 0);
        let last = loop {
            let (off, said) = off(across, elements);
            println!("{across} m, {elements} elements: {off:+.2e}");
            let Some(said) = said else { break off };
            let finer = said.split("at most ").nth(1).and_then(|rest| rest.split(' ').next()?.parse().ok());
            elements = (LENGTH / finer.unwrap_or(f64::NAN)).ceil() as usize;
            rounds += 1;
            assert!((1..=5).contains(&rounds) && elements < 400, "{across} m: {elements} elements");
        };
        assert!(rounds > 0 && last.abs() < 0.005, "{across} m: {last} after {rounds} rounds");
    }
    for (across, elements) in [(660.0, 200), (690.0, 40), (720.0, 12), (740.0, 8)] {
        let (off, said) = off(across, elements);
        assert!(off.abs() < 0.005 && said.is_none(), "{across} m, {elements}: {off}, {said:?}");
    }
}
