//! What tolerances come to: true errors of positions and forces, measured scene by scene for the page on accuracy.

use ropewalk::report::Table;
use ropewalk::scene::Format;
use ropewalk::{History, RunOptions, SceneFile, simulate};
use std::fmt::Write;

const TOLERANCES: [f64; 3] = [1e-3, 1e-4, 1e-5];
const SCHEMES: [&str; 2] = ["", "scheme = \"radau-iia-5\"\n"];
/// Where the table stands.
const PAGE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/book/src/accuracy.md");
const BEGIN: &str = "| scene | scheme |";
const END: &str = "\n\n";
/// Errors of positions are at most so many times the tolerance …
const MOST: f64 = 3.0;
/// … but for lines of which the end cracks like a whip: there they grow, which the page and the run say.
const GROWS: [(&str, f64); 2] = [("chain of 60 links, falls", 4.0), ("soft cable, cracks like a whip", 30.0)];

/// A scene to be measured: its name, its text, its duration [s], and the length that errors are relative to [m].
struct Case {
    name: &'static str,
    text: String,
    duration: f64,
    length: f64,
}

const GRAVITY: &str = "[[forces]]\ntype = \"gravity\"\n";

fn pendulum(ea: f64, ei: f64, elements: usize) -> String {
    format!(
        r#"
        [[elements]]
        type = "cable"
        name = "c"
        points = [[0, 0, 0], [1.2, 0, 0]]
        elements = {elements}
        section = {{ mass = 9.972, ea = {ea}, ei = {ei} }}
        [[constraints]]
        type = "spherical"
        name = "h"
        marker = "c.start"
        {GRAVITY}
        [[records]]
        type = "position"
        of = "c.end"
        [[records]]
        type = "along"
        of = "c"
        what = "tension"
        at = "start"
        "#
    )
}

fn chain(links: usize) -> String {
    format!(
        r#"
        [[elements]]
        type = "rigid_chain"
        name = "c"
        links = {links}
        points = [[0, 0, 0], [1, 0, 0]]
        section = {{ mass = 1, diameter = 0.02 }}
        [[constraints]]
        type = "spherical"
        name = "h"
        marker = "c.start"
        {GRAVITY}
        [[records]]
        type = "position"
        of = "c.end"
        [[records]]
        type = "reaction"
        of = "h"
        "#
    )
}

/// Six bars in a closed loop that hangs from one of its corners.
fn loop_of_bars() -> String {
    let corner = |i: usize| (std::f64::consts::FRAC_PI_3 * i as f64).sin_cos();
    let mut text = String::new();
    for i in 0..6 {
        let ((y, x), (y1, x1)) = (corner(i), corner(i + 1));
        let angle = (y1 - y).atan2(x1 - x);
        writeln!(
            text,
            "[[elements]]\ntype = \"rigid_body\"\nname = \"b{i}\"\nposition = [{x}, 0, {y}]\nangles = [0, {}, 0]\nmass = 1\n\
             inertia = [1e-4, 0.08333333, 0.08333333]\ncentre = [0.5, 0, 0]\npoints = {{ end = [1, 0, 0] }}",
            -angle
        )
        .expect("a string");
        let joint = match i {
            5 => "type = \"spherical\"\nmarker = \"b5.end\"\nto = \"b0\"".to_string(),
            _ => format!("type = \"revolute\"\nmarker = \"b{}\"\nto = \"b{i}.end\"\naxis = [0, 1, 0]", i + 1),
        };
        writeln!(text, "[[constraints]]\nname = \"j{i}\"\n{joint}").expect("a string");
    }
    text + "[[constraints]]\ntype = \"revolute\"\nname = \"g\"\nmarker = \"b0\"\nto = [1, 0, 0]\naxis = [0, 1, 0]\n"
        + GRAVITY
        + "[[records]]\ntype = \"position\"\nof = \"b2.end\"\n[[records]]\ntype = \"reaction\"\nof = \"g\"\n"
}

/// A hose that a ship takes along on a circle, from rest, with damping along it.
fn tow() -> String {
    format!(
        r#"
        [water]
        [[elements]]
        type = "cable"
        name = "hose"
        points = [[0, 0, 0], [-3, 0, 0]]
        elements = 20
        section = {{ mass = 0.5, flooded = 0.361, diameter = 0.023, ea = 1e6, ei = 2, axial_retardation_time = 0.01 }}
        [[motions]]
        type = "turn"
        name = "course"
        speed = "5 kn"
        radius = 25
        ramp = 5
        [[constraints]]
        type = "driving"
        name = "ship"
        marker = "hose.start"
        motion = "course"
        {GRAVITY}
        [[forces]]
        type = "drag"
        [[forces]]
        type = "added_mass"
        [[records]]
        type = "position"
        of = "hose.end"
        [[records]]
        type = "reaction"
        of = "ship"
        "#
    )
}

/// An umbilical of 10 km in a current, heaved by 2 m.
pub(crate) fn umbilical() -> String {
    format!(
        r#"
        [water]
        profile = [{{ z = -12000, velocity = [0, 0, 0] }}, {{ z = -1000, velocity = [0.2, 0, 0] }}, {{ z = 0, velocity = [1, 0, 0] }}]
        [[elements]]
        type = "cable"
        name = "u"
        points = [[0, 0, 0], [0, 0, -10000]]
        elements = 100
        section = {{ mass = 3, ea = 2e7, ei = 100, diameter = 0.04, axial_retardation_time = 0.01 }}
        [[motions]]
        type = "harmonic"
        name = "heave"
        amplitude = [0, 0, 2]
        frequency = 0.1
        [[constraints]]
        type = "driving"
        name = "top"
        marker = "u.start"
        motion = "heave"
        {GRAVITY}
        [[forces]]
        type = "buoyancy"
        [[forces]]
        type = "drag"
        [[forces]]
        type = "added_mass"
        [[records]]
        type = "position"
        of = "u.end"
        [[records]]
        type = "along"
        of = "u"
        what = "tension"
        at = "start"
        "#
    )
}

/// A weight on a cable of 50 m in water, let go to the side.
fn weight() -> String {
    "[water]\n".to_string()
        + &weight_in_air(0.01).replace("mass = 20", "mass = 20\nvolume = 0.002\ndrag_area = 0.02")
        + "[[forces]]\ntype = \"buoyancy\"\n[[forces]]\ntype = \"drag\"\n[[forces]]\ntype = \"added_mass\"\n"
}

/// The same in air, with axial damping of this retardation time [s].
fn weight_in_air(time: f64) -> String {
    format!(
        r#"
        [[elements]]
        type = "cable"
        name = "c"
        points = [[0, 0, 0], [30, 0, -40]]
        elements = 20
        section = {{ mass = 1, ea = 1e6, ei = 1, diameter = 0.02, axial_retardation_time = {time} }}
        [[elements]]
        type = "point_mass"
        name = "w"
        marker = "c.end"
        mass = 20
        [[constraints]]
        type = "spherical"
        name = "top"
        marker = "c.start"
        {GRAVITY}
        [[records]]
        type = "position"
        of = "w"
        [[records]]
        type = "along"
        of = "c"
        what = "tension"
        at = "start"
        "#
    )
}

fn cases() -> Vec<Case> {
    let case = |name, text, duration, length| Case { name, text, duration, length };
    vec![
        case("stiff cable, swings", pendulum(25_200.0, 1.701, 8), 1.0, 1.2),
        case("chain of 10 links, falls", chain(10), 1.0, 1.0),
        case("chain of 60 links, falls", chain(60), 1.0, 1.0),
        case("loop of six bars", loop_of_bars(), 2.0, 1.0),
        case("hose, tow starts", tow(), 20.0, 3.0),
        case("umbilical of 10 km, heaved", umbilical(), 60.0, 1e4),
        case("weight on 50 m of cable, swings in water", weight(), 20.0, 50.0),
        case("soft cable, cracks like a whip", pendulum(1260.0, 0.008_505, 16), 1.0, 1.2),
    ]
}

fn run(case: &Case, solver: &str) -> History {
    let d = case.duration;
    let text = format!("[run]\nduration = {d}\noutput = {}\n[solver]\n{solver}\n{}", 0.01 * d, case.text);
    let file = SceneFile::parse(&text, "tolerance", Format::Toml, &[])
        .unwrap_or_else(|e| panic!("{}: {e}", case.name));
    simulate(file.scene()).unwrap_or_else(|e| panic!("{}: {e}", case.name))
}

/// The largest difference of positions [m], and of forces in parts of the largest.
fn apart(a: &History, b: &History) -> [f64; 2] {
    let (mut places, mut forces, mut largest) = (0.0, 0.0, 0.0);
    // a NaN counts as the largest
    let most = |m: &mut f64, x: f64| *m = if x <= *m { *m } else { x };
    for name in b.table.columns.iter().map(|c| c.name.as_str()) {
        let [x, y] = [a, b].map(|h| h.column(name).unwrap_or_else(|| panic!("no column {name}")));
        assert_eq!(x.len(), y.len());
        let place = [".x", ".y", ".z"].iter().any(|end| name.ends_with(end));
        let force = name.ends_with(".magnitude") || name.ends_with(".tension");
        for (x, y) in x.iter().zip(y) {
            if place {
                most(&mut places, (x - y).abs());
            } else if force {
                most(&mut forces, (x - y).abs());
                most(&mut largest, y.abs());
            }
        }
    }
    [places, forces / largest]
}

fn controlled(tolerance: f64) -> String {
    format!("stepping = {{ controlled = {{ tolerance = {tolerance} }} }}\n")
}

/// The table of the page on accuracy: with `UPDATE` set it is written, otherwise its numbers are compared.
#[test]
fn true_errors_are_those_of_the_page() {
    let mut table = String::from(
        "| scene | scheme | 1e-3 | 1e-4 | 1e-5 | forces at 1e-4 |\n| --- | --- | ---: | ---: | ---: | ---: |\n",
    );
    let mut all = Vec::new();
    for case in cases() {
        let exact = run(&case, &(SCHEMES[1].to_string() + "force_tolerance = 1e-5\n" + &controlled(1e-8)));
        for (scheme, name) in SCHEMES.iter().zip(["generalized-α", "Radau IIA 5"]) {
            let [a, b, c] = TOLERANCES.map(|t| {
                let got = run(&case, &(scheme.to_string() + &controlled(t)));
                let warned = got.summary().warnings.iter().any(|w| w.contains("times as fast as the line"));
                let off = apart(&got, &exact);
                // never a silent miss, nor an alarm where nothing whips
                let whips = GROWS.iter().any(|(name, _)| *name == case.name);
                assert!(whips || !warned, "{} {name} {t:e}: a false alarm", case.name);
                let missed = off[0] > MOST * t * case.length;
                assert!(warned || !missed, "{} {name} {t:e}: off by {off:?}", case.name);
                off
            });
            let errors = [a, b, c];
            let ratios = errors.iter().zip(TOLERANCES).map(|(e, t)| e[0] / case.length / t);
            let most = GROWS.iter().find(|(name, _)| *name == case.name).map_or(MOST, |(_, most)| *most);
            let ratios: Vec<f64> = ratios.collect();
            println!("{} {name}: {ratios:.3?}, forces {:.1e}", case.name, b[1]);
            assert!(ratios.iter().all(|r| *r <= most), "{} {name}: {ratios:?}", case.name);
            assert!(b[1] <= 0.05, "{} {name}: forces {:e}", case.name, b[1]);
            writeln!(
                table,
                "| {} | {name} | {:.2} | {:.2} | {:.2} | {:.1} % |",
                case.name,
                ratios[0],
                ratios[1],
                ratios[2],
                100.0 * b[1]
            )
            .expect("a string");
            all.extend(ratios);
            all.push(100.0 * b[1]);
        }
    }
    let page = std::fs::read_to_string(PAGE).expect(PAGE);
    let begin = page.find(BEGIN).expect("the page has the table");
    let end = begin + page[begin..].find(END).expect("the table ends");
    if std::env::var_os("UPDATE").is_some() {
        std::fs::write(PAGE, page[..begin].to_owned() + table.trim_end() + &page[end..]).expect(PAGE);
        return;
    }
    let cells = page[begin..end].lines().skip(2).flat_map(|line| line.split('|').skip(3));
    let there: Vec<f64> = cells.filter_map(|cell| cell.trim().trim_end_matches(" %").parse().ok()).collect();
    assert_eq!(there.len(), all.len(), "UPDATE=1 cargo test --test dynamics");
    for (there, now) in there.iter().zip(&all) {
        // what a machine rounds otherwise chooses other steps
        assert!(
            (there - now).abs() <= 0.3 * now + 0.05,
            "{there} on the page, now {now}: UPDATE=1 cargo test --test dynamics"
        );
    }
}

/// Tension alone is recorded, up to five times in a step: between its ends it is as good as there, and not what interpolated
/// positions make of `EA` (4 % here).
#[test]
fn tension_between_steps_is_as_good_as_at_their_ends() {
    let case = Case { name: "weight", text: weight(), duration: 20.0, length: 50.0 };
    let exact = run(&case, &(SCHEMES[1].to_string() + "force_tolerance = 1e-5\n" + &controlled(1e-8)));
    for scheme in SCHEMES {
        let got = run(&case, scheme);
        let [place, force] = apart(&got, &exact);
        println!("`{scheme}`: {:?}, {place:.1e} m, tension {force:.1e}", got.counts);
        assert!(place < 1e-4 * 50.0 && force < 0.015, "`{scheme}`: {place:e} m, {force:e}");
    }
}

/// Positions alone are recorded: whether a folder is written, with shapes and range graphs for which the strains of the motion
/// are looked for, changes nothing of them; and range graphs show the tension of the motion (7 % off without).
#[test]
fn what_is_recorded_does_not_depend_on_who_looks() {
    let (positions, _) =
        weight().rsplit_once("[[records]]").map(|(a, b)| (a.to_string(), b.to_string())).expect("two");
    let folder = tempfile::tempdir().expect("a folder");
    let ranges = "[[run.ranges]]\nof = \"c\"\nfrom = 10\n";
    let look = |solver: &str, name: &str| {
        let text = format!("[solver]\n{solver}[run]\nduration = 20\noutput = 0.02\n{ranges}{positions}");
        let file = SceneFile::parse(&text, "looked-at", Format::Toml, &[]).expect("a scene");
        let options = RunOptions { out: Some(folder.path().join(name)), ..RunOptions::default() };
        let outcome = ropewalk::run(&file, &options, &mut |_| {}).expect("a run");
        let range = Table::read(&outcome.folder.table_file("range-c").expect("a name")).expect("a table");
        let largest = range
            .columns
            .iter()
            .find(|c| c.name.ends_with("tension.largest"))
            .expect("a column")
            .values
            .clone();
        (file, outcome.history, largest)
    };
    let (file, history, tension) = look("", "default");
    let alone = simulate(file.scene()).expect("a run").table;
    for (a, b) in history.columns.iter().zip(&alone.columns) {
        assert!(a.values.len() > 900 && a.values == b.values, "{}", a.name);
    }
    let (_, _, exact) =
        look(&(SCHEMES[1].to_string() + "force_tolerance = 1e-5\n" + &controlled(1e-8)), "exact");
    let off = tension.iter().zip(&exact).map(|(a, b)| (a - b).abs() / b).collect::<Vec<_>>();
    println!(
        "largest tensions from the top on off by {:.1e}, {:.1e} .. {:.1e}",
        off[0],
        off[1],
        off[off.len() - 1]
    );
    assert!(off.iter().all(|off| *off < 0.015), "{off:?}");
}

/// Fixed steps leave waves in a hose that they don't resolve: its tension is said to swing. Error control takes them away.
#[test]
fn tension_that_swings_from_step_to_step_is_said_to() {
    let case = Case { name: "tow", text: tow(), duration: 20.0, length: 3.0 };
    let warned = |solver: &str| {
        run(&case, solver)
            .summary()
            .warnings
            .iter()
            .any(|w| w.contains("the tension of `hose` swings to and fro from step to step"))
    };
    assert!(warned("stepping = { fixed = { h = 0.5 } }\n"));
    assert!(!warned(&controlled(1e-3)) && !warned("") && !warned(SCHEMES[1]));
    assert!(!warned("stepping = { fixed = { h = 0.02 } }\n"));
    // and what is not told is right
    let [_, off] =
        apart(&run(&case, &controlled(1e-3)), &run(&case, &(SCHEMES[1].to_string() + &controlled(1e-6))));
    assert!(off < 0.03, "forces off by {off:e}");
}

/// In a steady turn the stiff direction of a hose turns with it, and long steps make more and more of what it is strained by: from
/// steps of a quarter of a second on its tension swung ever wilder, to hundreds of kilonewtons. It is calmed before that tells.
#[test]
fn the_tension_of_a_hose_in_a_steady_turn_is_steady() {
    let text = tow() + "[[records]]\ntype = \"along\"\nof = \"hose\"\nwhat = \"tension\"\nat = \"start\"\n";
    let case = Case { name: "steady turn", text, duration: 40.0, length: 3.0 };
    let radau = run(&case, SCHEMES[1]);
    let right = *radau.column("hose.start.tension").expect("tension").last().expect("a sample");
    for (solver, most) in [
        (controlled(1e-3), 0.03),
        (controlled(1e-4) + "horizon = 3\n", 0.03),
        ("newton_tolerance = 0.01\n".to_string() + &controlled(1e-4) + "horizon = 3\n", 0.03),
        (controlled(1e-4), 0.01),
    ] {
        let h = run(&case, &solver);
        let late = h.column("hose.start.tension").expect("tension")[50..].iter();
        let off = late.fold(0.0, |m: f64, t| if (t - right).abs() <= m { m } else { (t - right).abs() });
        println!("{solver}: off by {:.1e}", off / right);
        assert!(off <= most * right, "{solver}: {off} N of {right} N");
    }
}

/// A weight swings on a cable in air: nothing damps the waves along it, and tension is off by more than its tolerance
/// long before positions are. A run says so, and nothing of it where waves fade, where steps are short enough, or where
/// another scheme follows them.
#[test]
fn tensions_that_errors_add_up_in_are_said_to_be_doubtful() {
    let case = |name, text, duration| Case { name, text, duration, length: 1.0 };
    let swings = case("weight in air", weight_in_air(0.0), 5.0);
    let damped = case("the same, damped", weight_in_air(0.01), 5.0);
    let stiff = case("stiff cable", pendulum(25_200.0, 1.701, 8), 1.0);
    // hardly a wave runs along it: its errors don't add up to more than that
    let wire = pendulum(1.5e6, 0.1, 20).replace("[1.2, 0, 0]", "[10, 0, 0]").replace("9.972", "0.14");
    let wire = case("steel wire", wire, 1.0);
    let exact =
        |case: &Case| run(case, &(SCHEMES[1].to_string() + "force_tolerance = 1e-5\n" + &controlled(1e-8)));
    for (case, tolerance, doubtful) in [
        (&swings, 1e-4, true),
        (&stiff, 1e-3, true),
        (&stiff, 1e-5, false),
        (&wire, 1e-5, false),
        (&damped, 1e-4, false),
    ] {
        let got = run(case, &controlled(tolerance));
        let said = got.summary().warnings.iter().any(|w| w.contains("nothing damps the waves along `c`"));
        let [_, off] = apart(&got, &exact(case));
        println!("{} at {tolerance:e}: forces off by {off:.1e}, said {said}", case.name);
        assert_eq!(said, doubtful, "{} at {tolerance:e}: {:?}", case.name, got.summary().warnings);
        // at most three times the tolerance, or said
        assert!(if doubtful { off > 0.03 } else { off < 0.03 }, "{} at {tolerance:e}: {off:e}", case.name);
    }
    let said = |solver: &str| !run(&swings, solver).summary().warnings.is_empty();
    assert!(!said(SCHEMES[1]), "Radau IIA follows the waves");
}

/// Where a tolerance of forces that is asked for isn't one of steps, a run says so.
#[test]
fn a_tolerance_of_forces_that_steps_are_not_held_to_is_said_to_be_one_of_iterations() {
    let said = |case: &Case, solver: &str| {
        run(case, solver).summary().warnings.iter().any(|w| w.contains("follows `tolerance`"))
    };
    let links = Case { name: "links", text: chain(3), duration: 0.1, length: 1.0 };
    let cable = Case { name: "cable", text: pendulum(25_200.0, 1.701, 8), duration: 0.1, length: 1.2 };
    let (usual, asked) = (controlled(1e-4), "force_tolerance = 1e-3\n".to_string() + &controlled(1e-4));
    let radau = SCHEMES[1].to_string() + &asked;
    assert!(said(&links, &asked) && said(&links, &radau) && said(&cable, &radau));
    assert!(!said(&links, &usual) && !said(&cable, &asked) && !said(&cable, SCHEMES[1]));
    // what follows that of positions is as exact as asked if this is tight enough, and isn't at 1e-3
    let loose = SCHEMES.map(|scheme| scheme.to_string() + &controlled(1e-3));
    assert!(loose.iter().all(|solver| said(&links, solver) && !said(&cable, solver)));
    assert!(!said(&links, &("force_tolerance = 1e-3\n".to_string() + &controlled(1e-5))));
}

/// A body that tumbles about its middle axis flips again and again: whatever an iteration leaves of its spin moves the next flip. A
/// cable beside it that it isn't coupled with changes nothing.
#[test]
fn a_tumbling_body_is_followed_within_the_tolerance() {
    let body = r#"
        [[elements]]
        type = "rigid_body"
        name = "b"
        position = [0, 0, 5]
        mass = 1
        inertia = [1e-3, 2e-3, 3e-3]
        angular_velocity = [0.01, 5, 0.01]
        points = { tip = [0, 0, 0.1] }
        [[records]]
        type = "position"
        of = "b.tip"
        "#;
    let cable = r#"
        [[elements]]
        type = "cable"
        name = "c"
        points = [[0, 0, 0], [0, 0, -100]]
        elements = 20
        section = { mass = 1.0, ea = 1e6, ei = 1.0 }
        [[constraints]]
        type = "spherical"
        name = "p"
        marker = "c.start"
        "#;
    let case = |text: String| Case { name: "tumbling", text, duration: 20.0, length: 0.1 };
    let [alone, beside] = [String::new(), cable.to_string()].map(|more| case(body.to_string() + &more));
    // with another scheme, whose steps are 200 times as many
    let exact = run(&alone, &controlled(1e-5));
    for case in [&alone, &beside] {
        let ratio = apart(&run(case, &(SCHEMES[1].to_string() + &controlled(1e-4))), &exact)[0] / 0.1 / 1e-4;
        println!("{ratio:.2} of the tolerance");
        assert!(ratio <= MOST, "{ratio} times the tolerance");
    }
}

/// A swing of 200,000 steps, of which Newton's method leaves a little in each: it adds up to less than the tolerance.
#[test]
fn what_newton_leaves_in_very_many_steps_stays_within_the_tolerance() {
    let text = r#"
        [[elements]]
        type = "rigid_body"
        name = "b"
        position = [0, 0, 0]
        mass = 1
        inertia = [1e-4, 0.0833333, 0.0833333]
        centre = [0.5, 0, 0]
        points = { end = [1, 0, 0] }
        [[constraints]]
        type = "revolute"
        name = "j"
        marker = "b"
        to = [0, 0, 0]
        axis = [0, 1, 0]
        [[forces]]
        type = "gravity"
        [[records]]
        type = "position"
        of = "b.end"
        "#;
    let case = Case { name: "swing", text: text.into(), duration: 10.0, length: 1.0 };
    let exact = run(&case, &(SCHEMES[1].to_string() + "force_tolerance = 1e-5\n" + &controlled(1e-9)));
    let ratio = apart(&run(&case, &controlled(1e-6)), &exact)[0] / 1e-6;
    println!("{ratio:.2} of the tolerance");
    assert!(ratio <= 1.5, "{ratio} times the tolerance");
}
