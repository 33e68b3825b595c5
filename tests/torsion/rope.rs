//! Laid ropes: pulled they turn, held they twist what holds them.

use super::{last, run, scene};
use ropewalk::{ModesOptions, modes};
use ropewalk_core::Quantity;
use ropewalk_core::statics::{Statics, StaticsOptions};

const EA: f64 = 900.0;
const GJ: f64 = 0.4;
const C: f64 = 7.0;
const L: f64 = 1.6;

/// A rope along x, clamped at its start; what holds its end, and what acts on it.
fn rope(elements: usize, end: &str, more: &str) -> String {
    format!(
        r#"
        [run]
        analysis = "statics"
        [[elements]]
        type = "cable"
        name = "rope"
        points = [[0, 0, 0], [{L}, 0, 0]]
        elements = {elements}
        section = {{ mass = 0.8, ea = {EA}, ei = 1, gj = {GJ}, torque_tension = {C}, rotary_inertia = 2e-4 }}
        [[constraints]]
        type = "clamp"
        name = "root"
        marker = "rope.start"
        {end}
        {more}
        [[records]]
        type = "along"
        of = "rope"
        what = "strain"
        at = "50 %"
        [[records]]
        type = "along"
        of = "rope"
        what = "twist"
        at = "50 %"
        [[records]]
        type = "along"
        of = "rope"
        what = "torque"
        at = "start"
        [[records]]
        type = "along"
        of = "rope"
        what = "tension"
        at = "50 %"
        [[records]]
        type = "along"
        of = "rope"
        what = "angle"
        at = "50 %"
        "#
    )
}

/// A block at the end that slides along x and doesn't turn.
const SLIDER: &str = r#"
    [[elements]]
    type = "rigid_body"
    name = "block"
    position = [1.6, 0, 0]
    mass = 1
    inertia = [1, 1, 1]
    [[constraints]]
    type = "weld"
    name = "end"
    marker = "rope.end"
    to = "block"
    [[constraints]]
    type = "prismatic"
    name = "rail"
    marker = "block"
    axis = [1, 0, 0]
"#;

fn pull(of: &str) -> String {
    format!(
        "[[forces]]\ntype = \"point_force\"\nmarker = \"{of}\"\nforce = [40, 0, 0]\ntime = {{ table = {{ t = [0, 1], value = [0, 1] }} }}"
    )
}

#[track_caller]
fn close(what: &str, found: f64, exact: f64, tolerance: f64) {
    println!("{what}: {found}, exact {exact}");
    assert!((found - exact).abs() <= tolerance * exact.abs().max(1e-3), "{what}: {found} instead of {exact}");
}

#[test]
fn a_rope_that_is_pulled_turns_and_stretches_more() {
    let h = run(&rope(4, "", &pull("rope.end")), &[]);
    let strain = 40.0 / (EA - C * C / GJ);
    close("strain", last(&h, "rope@50%.strain"), strain, 1e-8);
    close("twist", last(&h, "rope@50%.twist"), -C * strain / GJ, 1e-8);
    close("torque", last(&h, "rope.start.torque"), 0.0, 1e-6);
    close("tension", last(&h, "rope@50%.tension"), 40.0, 1e-8);
}

#[test]
fn a_rope_that_is_held_twists_what_holds_it() {
    let h = run(&rope(4, SLIDER, &pull("block")), &[]);
    close("strain", last(&h, "rope@50%.strain"), 40.0 / EA, 1e-8);
    close("torque", last(&h, "rope.start.torque"), C * 40.0 / EA, 1e-8);
    close("tension", last(&h, "rope@50%.tension"), 40.0, 1e-8);
    close("twist", last(&h, "rope@50%.twist"), 0.0, 1e-9);
}

#[test]
fn a_rope_that_hangs_is_exact_at_its_nodes() {
    // its own weight, as a load along it; both ends held from turning
    let w = 5.0;
    let load = format!(
        "[[forces]]\ntype = \"line_load\"\non = [\"rope\"]\nforce = [{w}, 0, 0]\ntime = {{ table = {{ t = [0, 1], value = [0, 1] }} }}"
    );
    for n in [2, 4, 8] {
        let h = run(&rope(n, SLIDER, &load), &[]);
        let middle = -C * w * L * L / 8.0 / (EA * GJ - C * C);
        close("angle", last(&h, "rope@50%.angle"), middle, 1e-9);
        close("torque", last(&h, "rope.start.torque"), C * w * L / (2.0 * EA), 1e-8);
    }
}

#[test]
fn its_waves_run_at_the_speeds_of_the_coupled_bar() {
    let mut errors = Vec::new();
    for n in [8, 16] {
        let scene = scene(&rope(n, "", ""), &[]);
        let found = modes(&scene, &ModesOptions { count: 30, ..ModesOptions::default() }).expect("modes");
        let off = |exact: f64| {
            found.modes.iter().map(|m| (m.omega / exact - 1.0).abs()).fold(f64::INFINITY, f64::min)
        };
        // those of the first wave number, π/2L: the slow one turns, the fast one stretches
        errors.push([off(28.741_113_781), off(46.753_744_366)]);
    }
    println!("{errors:?}");
    for k in 0..2 {
        assert!(errors[1][k] < 6e-5 && errors[0][k] / errors[1][k] > 3.5, "{errors:?}");
    }
}

#[test]
fn couplings_that_no_rope_has_are_refused() {
    let build = |from: &str, to: &str| {
        let text = rope(2, "", "").replace(from, to);
        ropewalk_scene::SceneFile::parse(&text, "scene", ropewalk_scene::Format::Toml, &[])
            .map_err(|e| e.to_string())
            .and_then(|f| f.scene().build().map(|_| ()).map_err(|e| e.to_string()))
            .expect_err("refused")
    };
    let says = build("torque_tension = 7", "torque_tension = 19");
    assert!(says.contains("√(EA GJ)"), "{says}");
    let says = build("gj = 0.4, ", "");
    assert!(says.contains("gj"), "{says}");
    let says = build("elements = 2", "elements = 2\nlongitudinal = \"L3\"");
    assert!(says.contains("L4"), "{says}");
    let says = build("ei = 1", "ei = [1, 2]");
    assert!(says.contains("direction") || says.contains("normal"), "{says}");
}

/// The same for a rope that a winch has paid out: what is fed is coupled as what was laid is.
#[test]
fn a_rope_that_is_paid_out_is_exact_at_its_nodes() {
    let (w, out) = (5.0, 0.6);
    for n in [2, 4] {
        let text = rope(
            n,
            SLIDER,
            &format!("[[forces]]\ntype = \"line_load\"\non = [\"rope\"]\nforce = [{w}, 0, 0]"),
        )
        .replace("analysis = \"statics\"", "duration = 1000")
        .replace("[1.6, 0, 0]", &format!("[{}, 0, 0]", L - out))
            + &format!(
                "[[constraints]]\ntype = \"winch\"\nname = \"winch\"\nmarker = \"rope.start\"\nspeed = 1\npayout = {out}\nramp = 1e-3"
            );
        let model = scene(&text, &[]).build().unwrap_or_else(|e| panic!("{e}"));
        let (part, mut state) = (model.part("rope").expect("rope"), model.state());
        let boundary = part.boundary(0).expect("a boundary");
        state.q[boundary.q] += boundary.sign * out;
        state.t = 500.0;
        Statics::new(&model, &StaticsOptions::default())
            .expect("statics")
            .find(&mut state, true)
            .unwrap_or_else(|e| panic!("{e}"));
        let see = |what: Quantity, s: f64| part.observe(what, s, &state.at()).expect("a value");
        let middle = -C * w * L * L / 8.0 / (EA * GJ - C * C);
        close("angle", see(Quantity::Angle, 0.5 * L), middle, 1e-8);
        close("torque", see(Quantity::Torque, 0.0), C * w * L / (2.0 * EA), 1e-8);
    }
}
