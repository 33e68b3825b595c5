//! Equilibria of reeved systems, with friction that hoists or lowers, of belts, of several turns, of cables with bending
//! stiffness, and of a platform on eight cables: against closed forms and balances that are evaluated here.

use super::reeving::{reference, run, values};
use crate::common::number;
use ropewalk::History;
use ropewalk::scene::Format;
use ropewalk::{SceneFile, simulate};
use std::f64::consts::{PI, TAU};

const GRAVITY: &str = "[[forces]]\ntype = \"gravity\"\n";

fn last(history: &History, column: &str) -> f64 {
    history.last(column).unwrap_or_else(|| panic!("no {column}"))
}

fn refused(text: &str) -> String {
    SceneFile::parse(text, "scene", Format::Toml, &[])
        .map_err(|e| e.to_string())
        .and_then(|file| file.into_scene().build().map(drop).map_err(|e| e.to_string()))
        .expect_err("it builds")
}

fn off(got: f64, exact: f64, tolerance: f64, what: &str) {
    let off = got / exact - 1.0;
    assert!(off.abs() <= tolerance, "{what}: {got} for {exact}, off by {off:e}");
}

/// A tackle of four falls, from its reeving table alone: no tension and no length. `sheave` tells the losses of each.
fn tackle(sheave: &str, mass: f64) -> String {
    let wheel = |name: &str, marker: &str| {
        format!(
            "[[constraints]]\ntype = \"sheave\"\nname = \"{name}\"\nmarker = {marker}\naxis = [0, 1, 0]\nradius = 0.1\n{sheave}\n"
        )
    };
    let record = |name: &str| format!("[[records]]\ntype = \"sheave\"\nof = \"{name}\"\n");
    let names = ["h1", "b1", "h2", "b2"];
    let wheels: String =
        names.iter().map(|n| wheel(n, if n.starts_with('h') { "[0, 0, 10]" } else { "\"block\"" })).collect();
    let records: String = names.iter().map(|n| record(n)).collect();
    format!(
        r#"
        run = {{ analysis = "statics" }}
        [[elements]]
        type = "rigid_body"
        name = "block"
        position = [0, 0, 4]
        mass = {}
        inertia = [1, 1, 1]
        [[elements]]
        type = "cable"
        name = "hoist"
        section = {{ mass = {mass}, ea = "20 MN" }}
        route = [
            {{ end = [-0.1, 0, 4] }}, {{ over = "h1" }}, {{ under = "b1" }}, {{ over = "h2" }},
            {{ under = "b2" }}, {{ end = [-0.1, 0, 10] }},
        ]
        [[constraints]]
        type = "prismatic"
        name = "rail"
        marker = "block"
        to = [0, 0, 0]
        axis = [0, 0, 1]
        [[constraints]]
        type = "spherical"
        name = "start"
        marker = "hoist.start"
        [[constraints]]
        type = "spherical"
        name = "dead end"
        marker = "hoist.end"
        [[constraints]]
        type = "winch"
        name = "winch"
        marker = "hoist.start"
        speed = -0.5
        start = 5
        {wheels}
        {GRAVITY}
        {records}
        "#,
        10_000.0 / 9.81
    )
}

/// The tension of the lead and of the falls, from the dead end on.
fn falls(history: &History) -> [f64; 5] {
    let lead = last(history, "h1.in.tension");
    [
        lead,
        last(history, "b2.out.tension"),
        last(history, "b2.in.tension"),
        last(history, "b1.out.tension"),
        last(history, "b1.in.tension"),
    ]
}

#[test]
fn a_tackle_stands_as_if_it_hoisted_or_lowered_or_had_no_friction() {
    let exact = reference("tackle_4");
    let efficiency = (-0.05_f64).exp();
    for (way, word) in [(1.0, "hoisting"), (-1.0, "lowering"), (0.0, "none")] {
        let sheave = format!("efficiency = {efficiency}\nequilibrium = \"{word}\"");
        let history = run(&tackle(&sheave, 1e-9));
        let got = falls(&history);
        let mut wanted = [2500.0; 5];
        if way != 0.0 {
            wanted[0] = number(&exact[format!("lead_{word}")]);
            wanted[1..].copy_from_slice(&values(&exact[format!("falls_{word}")]));
            // from the dead end on the tension grows where it hoists
            wanted[1..].sort_by(f64::total_cmp);
            if way < 0.0 {
                wanted[1..].reverse();
            }
        }
        for (k, (got, wanted)) in got.iter().zip(wanted).enumerate() {
            off(*got, wanted, 1e-8, &format!("{word}, {k}"));
        }
    }
}

#[test]
fn bearings_hold_back_a_tackle_that_moves_slowly() {
    // of half a turn: (1 + k)/(1 - k) with k = mu r/R; whether the wheel has an angle of its own doesn't matter
    let k = 0.15 * 0.02 / 0.1;
    let ratio = (1.0 + k) / (1.0 - k);
    let sum: f64 = (0..4).map(|n| f64::powi(ratio, n)).sum();
    for more in ["", "inertia = 0.02", "inertia = 0.02\nfriction = 0.3"] {
        let sheave =
            format!("{more}\nbearing = {{ friction = 0.15, radius = 0.02 }}\nequilibrium = \"hoisting\"");
        let got = falls(&run(&tackle(&sheave, 1e-9)));
        off(got[1], 10_000.0 / sum, 1e-7, &format!("dead end with `{more}`"));
        off(got[0], 10_000.0 / sum * ratio.powi(4), 1e-7, &format!("lead with `{more}`"));
    }
}

#[test]
fn the_summary_says_which_equilibrium_it_is() {
    for (sheave, words) in [
        ("efficiency = 0.98\nequilibrium = \"hoisting\"", "the equilibrium is that of hoisting"),
        ("efficiency = 0.98\nequilibrium = \"lowering\"", "the equilibrium is that of lowering"),
        ("efficiency = 0.98", "the equilibrium is that without the friction of `h1`"),
    ] {
        let file = SceneFile::parse(&tackle(sheave, 1e-9), "scene", Format::Toml, &[]).expect("scene");
        let history = simulate(&file.into_scene()).expect("equilibrium");
        let notes = history.warnings.join("\n");
        assert!(notes.contains(words), "{notes}\nbut not: {words}");
    }
}

#[test]
fn a_way_that_is_not_told_is_refused_with_its_reason() {
    let good = tackle("efficiency = 0.98\nequilibrium = \"hoisting\"", 0.1);
    let winch = "[[constraints]]\n        type = \"winch\"\n        name = \"winch\"\n        marker = \"hoist.start\"\n        speed = -0.5\n        start = 5\n";
    assert!(good.contains(winch));
    for (text, reason) in [
        (good.replace(winch, ""), "say `to_start` or `to_end`"),
        (good.replace("efficiency = 0.98", "inertia = 1"), "this wheel turns without"),
        (good.replace("\"hoisting\"", "\"hoist\""), "hoist"),
    ] {
        let message = refused(&text);
        assert!(message.contains(reason), "{message}\nbut not: {reason}");
    }
}

/// A rope about a bollard that lies in the plane of its ends, so many whole turns more than it needs.
fn bollard(turns: &str, more: &str, pull: &str) -> String {
    format!(
        r#"
        {more}
        [[elements]]
        type = "cable"
        name = "rope"
        section = {{ mass = 1e-6, ea = "1 MN", axial_retardation_time = "5 ms" }}
        tension = 100
        route = [{{ end = [-2, 0, 0.1] }}, {{ over = "bollard" }}, {{ end = [0.1, 0, -2] }}]
        {pull}
        [[elements]]
        type = "point_mass"
        name = "load"
        marker = "rope.end"
        mass = 10
        [[constraints]]
        type = "sheave"
        name = "bollard"
        marker = [0, 0, 0]
        axis = [0, 1, 0]
        radius = 0.1
        friction = 0.2
        locked = true
        {turns}
        {GRAVITY}
        [[records]]
        type = "sheave"
        of = "bollard"
        [[records]]
        type = "energy"
        "#
    )
}

const HELD: &str = "[[constraints]]\ntype = \"spherical\"\nname = \"held\"\nmarker = \"rope.start\"\n";

#[test]
fn several_turns_on_a_bollard_hold_by_the_capstan_equation() {
    for turns in [0_u32, 1, 3] {
        let wrap = 0.5 * PI + TAU * f64::from(turns);
        for (way, word) in [(1.0, "to_start"), (-1.0, "to_end")] {
            let told = format!("turns = {turns}\nequilibrium = \"{word}\"");
            let history = run(&bollard(&told, "run = { analysis = \"statics\" }", HELD));
            off(last(&history, "bollard.wrap"), wrap, 1e-6, "wrap");
            off(last(&history, "bollard.out.tension"), 98.1, 1e-6, "load");
            let ratio = last(&history, "bollard.in.tension") / last(&history, "bollard.out.tension");
            off(ratio, (way * 0.2 * wrap).exp(), 1e-6, &format!("{turns} turns, {word}"));
        }
    }
    // and while it is drawn over
    let winch = format!(
        "{HELD}[[constraints]]\ntype = \"winch\"\nname = \"winch\"\nmarker = \"rope.start\"\nspeed = -0.5\nramp = 0.5\n"
    );
    for turns in [0_u32, 1, 3] {
        let wrap = 0.5 * PI + TAU * f64::from(turns);
        let history =
            run(&bollard(&format!("turns = {turns}"), "run = { duration = 1.5, output = 0.1 }", &winch));
        let column =
            |name: &str| history.column(&format!("bollard.{name}")).unwrap_or_else(|| panic!("no {name}"));
        let (tight, slack) = (column("in.tension"), column("out.tension"));
        // steadily, from the end of the ramp on
        for k in 8..=15 {
            off(column("wrap")[k], wrap, 1e-3, "wrap");
            // the rope still trembles a little
            let most = if k == 15 { 1e-4 } else { 2e-3 };
            off(tight[k] / slack[k], (0.2 * wrap).exp(), most, &format!("{turns} turns, drawn"));
        }
        let lost = last(&history, "energy.imbalance").abs() / last(&history, "energy.supplied").abs();
        assert!(lost <= 1e-3, "{turns} turns: {lost} of the work is unaccounted for");
    }
}

#[test]
fn a_wrap_grows_beyond_a_whole_turn_where_turns_are_declared() {
    // the load's rope is led round the bollard, from below to the left, over the top and down again: by a turn
    let n = 24;
    let points = |f: &dyn Fn(f64) -> f64| {
        let all: Vec<String> = (0..=n).map(|k| format!("{}", f(TAU * f64::from(k) / f64::from(n)))).collect();
        all.join(", ")
    };
    let times: Vec<String> = (0..=n).map(|k| format!("{}", 0.5 * f64::from(k))).collect();
    // the end begins at [0.1, 0, -2]; it goes round at the distance that it has, as the rope unwinds from the load's side
    let from = [0.1_f64, -2.0_f64];
    let x = points(&|a| from[0] * (a.cos() - 1.0) + from[1] * a.sin());
    let z = points(&|a| from[1] * (a.cos() - 1.0) - from[0] * a.sin());
    let led = format!(
        "[[constraints]]\ntype = \"driving\"\nname = \"led\"\nmarker = \"rope.end\"\nmotion = \"way\"\n\
         [[motions]]\ntype = \"table\"\nname = \"way\"\nt = [{}]\nx = [{x}]\nz = [{z}]\njoin = \"cubic\"\nends = \"at-rest\"\n",
        times.join(", ")
    );
    let spring = "[[forces]]\ntype = \"point_force\"\nmarker = \"rope.start\"\nforce = [-200, 0, 0]\n\
                  [[elements]]\ntype = \"point_mass\"\nname = \"weight\"\nmarker = \"rope.start\"\nmass = 5\n";
    let text = bollard("turns = 0", "run = { duration = 12, output = 0.5 }", &format!("{led}{spring}"))
        .replace("mass = 1e-6", "mass = 0.01")
        .replace("friction = 0.2\n        locked = true", "")
        .replace(GRAVITY, "");
    let history = run(&text);
    let wrap = history.column("bollard.wrap").expect("wrap");
    let (first, end) = (wrap[0], *wrap.last().expect("rows"));
    assert!((end - first - TAU).abs() <= 0.02, "from {first} to {end} rad");
    // step by step, without a leap
    assert!(wrap.windows(2).all(|w| (w[1] - w[0]).abs() <= 0.6), "{wrap:?}");
}

/// A belt about two pulleys.
fn belt(more: &str, driven: &str, length: f64, axis: &str) -> String {
    format!(
        r#"
        run = {{ analysis = "statics" }}
        {more}
        [[elements]]
        type = "cable"
        name = "belt"
        section = {{ mass = 0.2, ea = 1e4 }}
        elements = 2
        length = {length}
        route = [{{ round = "driver" }}, {{ round = "driven" }}]
        [[constraints]]
        type = "sheave"
        name = "driver"
        marker = [0, 0, 0]
        axis = [0, 1, 0]
        radius = 0.1
        [[constraints]]
        type = "sheave"
        name = "driven"
        marker = {driven}
        axis = {axis}
        radius = 0.1
        [[records]]
        type = "sheave"
        of = "driver"
        [[records]]
        type = "sheave"
        of = "driven"
        "#
    )
}

#[test]
fn a_closed_belt_stands_with_the_tension_of_its_length() {
    let (apart, radius, ea, length) = (0.6_f64, 0.1, 1e4, 1.75);
    // open, and crossed with the axis of one pulley turned round
    let lean = (2.0 * radius / apart).asin();
    let crossed = 2.0 * (apart * lean.cos() + radius * (PI + 2.0 * lean));
    let open = 2.0 * apart + TAU * radius;
    for (path, axis) in [(open, "[0, 1, 0]"), (crossed, "[0, -1, 0]")] {
        let history = run(&belt("", "[0.6, 0, 0]", length, axis));
        let tension = ea * (path / length - 1.0);
        for column in ["driver.in.tension", "driver.out.tension", "driven.in.tension", "driven.out.tension"] {
            off(last(&history, column), tension, 1e-9, column);
        }
    }
}

#[test]
fn a_tensioner_tells_the_tension_of_its_belt() {
    // the lower pulley hangs in the belt: each side carries half of its weight, and of the belt what is below
    let body = "[[elements]]\ntype = \"rigid_body\"\nname = \"weight\"\nposition = [0, 0, -0.7]\nmass = 20\ninertia = [1, 1, 1]\n\
                [[constraints]]\ntype = \"prismatic\"\nname = \"rail\"\nmarker = \"weight\"\nto = [0, 0, 0]\naxis = [0, 0, 1]\n";
    let history = run(&format!("{}{GRAVITY}", belt(body, "\"weight\"", 2.0, "[0, 1, 0]")));
    // what lies on the lower pulley hangs from it too
    let arc = last(&history, "driven.length") * 0.2 * 9.81;
    for side in ["in", "out"] {
        off(last(&history, &format!("driven.{side}.tension")), 0.5 * (20.0 * 9.81 + arc), 1e-8, side);
    }
    let lower = last(&history, "driven.in.tension");
    // higher up it carries the belt below: T + T²/2EA by the height that is stretched
    let upper = last(&history, "driver.in.tension");
    let free = 0.5 * (2.0 - last(&history, "driven.length") - last(&history, "driver.length"));
    assert!((upper - lower - 0.2 * 9.81 * free).abs() <= 1e-6, "{upper} and {lower} N");
}

#[test]
fn bending_stiffness_holds_a_rope_off_its_wheel() {
    // a load on each side: about the centre, T d = T₀ R + EI/R with T₀ = T - EI/(2 R²), the tension of the rope where it lies
    // down (T + EI κ²/2 is the same all along). So both falls are R + EI/(2 R T) from the centre
    let (radius, weight) = (0.1_f64, 1000.0_f64);
    // layers are √(EI/T) long: on fewer than 16 elements the stiffer rope's ends too near by 1e-4 m at most
    for (ei, elements, near) in [
        (0.5, 20, 1e-5),
        (2.0, 4, 1e-4),
        (2.0, 6, 5e-5),
        (2.0, 8, 5e-5),
        (2.0, 10, 2e-5),
        (2.0, 12, 1e-5),
        (2.0, 16, 1e-5),
        (2.0, 30, 1e-5),
        (2.0, 40, 1e-5),
        (10.0, 8, 1e-4),
    ] {
        let scene = format!(
            r#"
            run = {{ analysis = "statics" }}
            [[elements]]
            type = "cable"
            name = "rope"
            section = {{ mass = 1e-6, ea = "1 MN", ei = {ei} }}
            elements = {elements}
            tension = {weight}
            route = [{{ end = [-0.1, 0, -0.8] }}, {{ over = "wheel" }}, {{ end = [0.1, 0, -0.8] }}]
            [[elements]]
            type = "point_mass"
            name = "load"
            marker = "rope.end"
            mass = {}
            [[constraints]]
            type = "point_on_plane"
            name = "start"
            marker = "rope.start"
            to = [0, 0, -0.8]
            axis = [0, 0, 1]
            [[constraints]]
            type = "sheave"
            name = "wheel"
            marker = [0, 0, 0]
            axis = [0, 1, 0]
            radius = {radius}
            {GRAVITY}
            [[records]]
            type = "position"
            of = "rope.end"
            "#,
            weight / 9.81
        );
        let history = run(&scene);
        let exact = radius + ei / (2.0 * radius * weight);
        let got = last(&history, "rope.end.x");
        assert!((got - exact).abs() <= near, "EI {ei}, {elements} elements: {got} m for {exact} m");
        let flutter = history.warnings.iter().find(|w| w.contains("stable"));
        assert!(flutter.is_none(), "EI {ei}, {elements} elements: {flutter:?}");
    }
}

#[test]
fn a_platform_on_eight_cables_stands_where_forces_and_moments_balance() {
    let eyes = [[3.0, 2.0, 3.0], [-3.0, 2.0, 3.0], [-3.0, -2.0, 3.0], [3.0, -2.0, 3.0]];
    let low = eyes.map(|[x, y, _]| [x, y, 0.0]);
    let arms = [
        [0.3, 0.15, -0.2],
        [-0.3, 0.15, -0.2],
        [-0.3, -0.15, -0.2],
        [0.3, -0.15, -0.2],
        [0.2, 0.3, 0.2],
        [-0.2, 0.3, 0.2],
        [-0.2, -0.3, 0.2],
        [0.2, -0.3, 0.2],
    ];
    let (ea, weight) = (4e4, 30.0 * 9.81);
    let eye = |k: usize| if k < 4 { eyes[k] } else { low[k - 4] };
    let wheel = |k: usize| {
        let [x, y, z] = eye(k);
        [x * 1.2, y, z + 0.5]
    };
    // cables of lengths that turn the platform and move it out of the middle
    let slack = [0.98, 0.985, 0.99, 0.975, 0.97, 0.98, 0.985, 0.98];
    let distance = |a: &[f64; 3], b: &[f64; 3]| (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt();
    let middle = [0.3, 0.1, 1.5];
    let lengths: Vec<f64> = (0..8)
        .map(|k| {
            let p: [f64; 3] = std::array::from_fn(|i| middle[i] + arms[k][i]);
            slack[k] * (distance(&wheel(k), &eye(k)) + distance(&eye(k), &p))
        })
        .collect();
    let mut text = format!(
        "run = {{ analysis = \"statics\" }}\n[[elements]]\ntype = \"rigid_body\"\nname = \"platform\"\nposition = {middle:?}\n\
         mass = 30\ninertia = [1, 1, 1]\n[elements.points]\n"
    );
    for (k, arm) in arms.iter().enumerate() {
        text += &format!("p{k} = {arm:?}\n");
    }
    for (k, length) in lengths.iter().enumerate() {
        text += &format!(
            "[[elements]]\ntype = \"cable\"\nname = \"c{k}\"\nsection = {{ mass = 1e-7, ea = {ea} }}\nelements = 1\nlength = {length}\n\
             route = [{{ end = {:?} }}, {{ through = \"e{k}\" }}, {{ end = \"platform.p{k}\" }}]\n\
             [[constraints]]\ntype = \"ring\"\nname = \"e{k}\"\nmarker = {:?}\n\
             [[constraints]]\ntype = \"spherical\"\nname = \"s{k}\"\nmarker = \"c{k}.start\"\n\
             [[records]]\ntype = \"position\"\nof = \"platform.p{k}\"\nname = \"p{k}\"\n",
            wheel(k),
            eye(k)
        );
    }
    text += &format!("[[records]]\ntype = \"position\"\nof = \"platform\"\n{GRAVITY}");
    let history = run(&text);
    let place = |name: &str| -> [f64; 3] { ["x", "y", "z"].map(|x| last(&history, &format!("{name}.{x}"))) };
    let centre = place("platform");
    let (mut force, mut moment, mut pulls) = ([0.0, 0.0, -weight], [0.0; 3], 0.0);
    for k in 0..8 {
        let p = place(&format!("p{k}"));
        let span = distance(&eye(k), &p);
        let tension = ea * ((distance(&wheel(k), &eye(k)) + span) / lengths[k] - 1.0);
        assert!(tension > 0.0, "cable {k} is slack");
        let pull: [f64; 3] = std::array::from_fn(|i| tension * (eye(k)[i] - p[i]) / span);
        let arm: [f64; 3] = std::array::from_fn(|i| p[i] - centre[i]);
        for i in 0..3 {
            force[i] += pull[i];
            let [j, l] = [(i + 1) % 3, (i + 2) % 3];
            moment[i] += arm[j] * pull[l] - arm[l] * pull[j];
        }
        pulls += tension;
    }
    let left = force.iter().chain(&moment).fold(0.0, |worst: f64, x| worst.max(x.abs()));
    assert!(left <= 1e-7 * pulls, "{left} N are left of {pulls} N");
    // it did move and turn
    assert!(distance(&centre, &middle) > 1e-3, "{centre:?}");
}
