//! The balance of energy where rope passes wheels and rings: what leaves a span is on the wheel or in the next one, and
//! counts once, however high the wheel is, however it moves, and until the rope lifts off.

use ropewalk::scene::Format;
use ropewalk::{History, SceneFile, simulate};

fn history(text: &str) -> Result<History, String> {
    let file = SceneFile::parse(text, "scene", Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}"));
    simulate(&file.into_scene()).map_err(|e| e.to_string())
}

fn run(text: &str) -> History {
    history(text).unwrap_or_else(|e| panic!("{e}"))
}

/// Largest imbalance of energy of a run, and largest energy or work of it [J].
fn balance(history: &History) -> [f64; 2] {
    let column =
        |name: &str| history.column(&format!("energy.{name}")).unwrap_or_else(|| panic!("no {name}"));
    let most = |name: &str| {
        let all = column(name);
        assert!(all.iter().all(|x| x.is_finite()), "{name}: {all:?}");
        all.iter().fold(0.0_f64, |most, x| most.max(x.abs()))
    };
    let [potential, kinetic] = ["potential", "kinetic"].map(column);
    let moved = potential.iter().map(|x| (x - potential[0]).abs()).chain(kinetic.iter().copied());
    [most("imbalance"), moved.fold(most("supplied"), f64::max)]
}

/// A heavy rope, held at both ends, bends over what is in its middle at this height; `passage` names that.
fn bent(height: f64, passage: &str, more: &str) -> String {
    format!(
        r#"
        [[elements]]
        type = "cable"
        name = "rope"
        section = {{ mass = 5, ea = "20 kN", axial_retardation_time = "2 ms" }}
        elements = 2
        tension = 4000
        route = [{{ end = [-2, 0, {low}] }}, {{ {passage} = "guide" }}, {{ end = [2, 0, {low}] }}]
        [[constraints]]
        type = "spherical"
        name = "start"
        marker = "rope.start"
        [[constraints]]
        type = "spherical"
        name = "end"
        marker = "rope.end"
        [[forces]]
        type = "gravity"
        [[records]]
        type = "energy"
        {more}
        "#,
        low = height - 0.6,
    )
}

/// A body that carries the guide and is led by a table of places.
fn led(way: &str) -> String {
    format!(
        r#"
        [[elements]]
        type = "rigid_body"
        name = "carrier"
        position = [0, 0, 0.6]
        mass = 10
        inertia = [1, 5, 5]
        [[constraints]]
        type = "driving"
        name = "led"
        marker = "carrier"
        motion = "way"
        [[motions]]
        type = "table"
        name = "way"
        ends = "at-rest"
        {way}
        "#
    )
}

#[test]
fn rope_that_comes_and_goes_on_a_wheel_counts_once_at_any_height() {
    // it shakes as its weight sets in: what lies on the wheel becomes more and less
    for height in [0.0, 0.6, 500.0] {
        let wheel = format!(
            "[[constraints]]\ntype = \"sheave\"\nname = \"guide\"\nmarker = [0, 0, {height}]\naxis = [0, 1, 0]\nradius = 0.5\n"
        );
        let text = bent(height, "over", &wheel);
        let history = run(&format!("run = {{ duration = 1, output = 0.05 }}\n{text}"));
        let [off, all] = balance(&history);
        println!("{height} m: {off} J of {all} J");
        assert!(off <= 0.01 * all, "{height} m: {off} J of {all} J");
    }
}

#[test]
fn friction_of_a_sheave_on_a_driven_body_balances_until_the_rope_lifts_off() {
    let wheel = "[[constraints]]\ntype = \"sheave\"\nname = \"guide\"\nmarker = \"carrier\"\naxis = [0, 1, 0]\nradius = 0.5\n\
                 friction = 0.3\nlocked = true\n";
    let body = led("t = [0, 1, 2, 2.5, 4]\nx = [0, 0.8, 0.4, 0, 0]\nz = [0, -0.4, -0.8, -1.2, -1.2]");
    let text = bent(0.6, "over", wheel).replace("[[elements]]", &format!("{body}\n[[elements]]"));
    // just before, and beyond
    let history_before = run(&format!("run = {{ duration = 2.3, output = 0.05 }}\n{text}"));
    let [off, all] = balance(&history_before);
    println!("{off} J of {all} J");
    assert!(off <= 1e-3 * all, "{off} J of {all} J");
    let message =
        history(&format!("run = {{ duration = 4, output = 0.05 }}\n{text}")).err().expect("it lifts off");
    println!("{message}");
    assert_eq!(message.matches("leaves `guide`").count(), 1, "{message}");
    assert!(message.contains("comes back isn't known"), "{message}");
}

#[test]
fn rope_through_a_ring_that_moves_balances() {
    let ring = "[[constraints]]\ntype = \"ring\"\nname = \"guide\"\nmarker = \"carrier\"\n";
    let body = led("t = [0, 0.5, 1, 1.5, 2]\nx = [0, 0.9, -0.9, 0.9, 0]\nz = [0, 0.2, 0.4, 0, 0]");
    let text = bent(0.6, "through", ring).replace("[[elements]]", &format!("{body}\n[[elements]]"));
    let history = run(&format!("run = {{ duration = 2, output = 0.02 }}\n{text}"));
    let [off, all] = balance(&history);
    println!("{off} J of {all} J");
    assert!(off <= 1e-3 * all, "{off} J of {all} J");
}
