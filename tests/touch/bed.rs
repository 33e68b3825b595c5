//! The sea floor: lines of catenaries that come to lie on it, with the friction that a pull has used up or that the ground takes
//! hold with; heights on a grid; where lines touch down.

use ropewalk::scene::{Format, SceneFile};
use ropewalk::{History, simulate};
use serde_json::Value;
use std::fmt::Write;

pub(crate) fn run(text: &str) -> History {
    let file = SceneFile::parse(text, "bed", Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}\n{text}"));
    simulate(&file.into_scene()).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

fn last(h: &History, name: &str) -> f64 {
    h.last(name).unwrap_or_else(|| panic!("no column {name}"))
}

pub(crate) fn number(v: &Value) -> f64 {
    v.as_f64().expect("number")
}

pub(crate) fn reference(text: &str) -> Vec<Value> {
    let all: Value = serde_json::from_str(text).expect("JSON");
    all["cases"].as_array().expect("cases").clone()
}

const G: f64 = 9.81;
/// Diameter of what lies [m].
const D: f64 = 0.1;

/// A line of sections between its two ends, begun as a straight line, in statics; the bed lies so that its axis does where it sinks in.
fn line(case: &Value, elements: usize, stiffness: f64, equilibrium: &str) -> String {
    let (mut sections, mut loads) = (String::new(), String::new());
    let mut s = 0.0;
    let all = case["sections"].as_array().expect("sections");
    let load = |k: usize| case["load_after_section"].get(k).map_or(0.0, number);
    for (k, q) in all.iter().enumerate() {
        let [length, weight, ea] = ["L", "w", "EA"].map(|f| number(&q[f]));
        // what floats displaces more water than it weighs
        let displaced = if weight < 0.0 { -2.0 * weight / (G * 1000.0) } else { 0.0 };
        let _ = writeln!(
            sections,
            "{{ to = {}, elements = {elements}, hinged = {}, section = {{ mass = {:e}, ea = {ea:e}, diameter = {D}, displaced = {displaced:e} }} }},",
            s + length,
            k > 0 && load(k - 1) != 0.0,
            weight.abs() / G,
        );
        s += length;
        if load(k) != 0.0 {
            let _ = writeln!(
                loads,
                "[[forces]]\ntype = \"point_force\"\nmarker = \"line@{s}\"\nforce = [0, 0, {}]",
                -load(k)
            );
        }
    }
    let slope = number(&case["bed_slope_deg"]).to_radians();
    let sinks = number(&all[0]["w"]) * slope.cos() / (stiffness * D);
    let down = 0.5 * D - sinks;
    let point = [slope.sin() * down, 0.0, -slope.cos() * down];
    let [x, z] = [0, 1].map(|i| number(&case["fairlead"][i]));
    format!(
        r#"
        run = {{ analysis = "statics" }}
        statics = {{ steps = 1 }}
        water = {{ density = 1000 }}
        [[elements]]
        type = "cable"
        name = "line"
        points = [[0, 0, 0], [{x}, 0, {z}]]
        sections = [
        {sections}]
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
        type = "buoyancy"
        [[forces]]
        type = "bed"
        point = {point:?}
        slope = {slope}
        stiffness = {stiffness:e}
        friction = {{ mu = {}, equilibrium = "{equilibrium}" }}
        [[records]]
        type = "reaction"
        of = "anchor"
        what = "magnitude"
        [[records]]
        type = "reaction"
        of = "fairlead"
        what = "magnitude"
        [[records]]
        type = "touchdown"
        of = "line"
        on = "bed"
        {loads}"#,
        number(&case["mu"]),
    )
}

#[test]
fn lines_come_to_lie_as_their_catenaries_from_two_end_points() {
    for case in reference(include_str!("../data/sea/catenaries.json")) {
        let result = &case["result"];
        let h = run(&line(&case, 60, 3e8, "pulled"));
        let [fairlead, anchor] = ["fairlead.magnitude", "anchor.magnitude"].map(|n| last(&h, n));
        let grounded = last(&h, "line.touchdown.grounded");
        let right = ["tension_fairlead", "anchor_tension", "grounded_length"].map(|n| number(&result[n]));
        println!(
            "{}: fairlead {fairlead:.0} ({:.1e}), anchor {anchor:.0} (off {:.1e} of the fairlead's), grounded {grounded:.2} instead of {:.2}",
            case["name"],
            fairlead / right[0] - 1.0,
            (anchor - right[1]) / right[0],
            right[2],
        );
        assert!((fairlead / right[0] - 1.0).abs() < 1e-3, "{}", case["name"]);
        assert!((anchor - right[1]).abs() < 5e-3 * right[0], "{}", case["name"]);
    }
}

/// A line that lies and is pulled along its bed: the load rises and falls along the path of a statics run.
fn dragged(case: &Value, elements: usize, equilibrium: &str, course: [f64; 3]) -> String {
    let q = &case["section"];
    let [length, weight, ea] = ["L", "w", "EA"].map(|f| number(&q[f]));
    let (pull, mu) = (number(&case["pull"]), number(&case["mu"]));
    let slope = number(&case["bed_slope_deg"]).to_radians();
    let stiffness = 1e7;
    let up = 0.5 * D - weight * slope.cos() / (stiffness * D);
    let normal = [-slope.sin(), slope.cos()];
    let along = [slope.cos(), slope.sin()];
    let [from, to] =
        [0.0, length].map(|s| [s * along[0] + up * normal[0], 0.0, s * along[1] + up * normal[1]]);
    let force = along.map(|c| c * pull);
    format!(
        r#"
        run = {{ analysis = "statics", duration = 2 }}
        statics = {{ steps = 20 }}
        [[elements]]
        type = "cable"
        name = "line"
        points = [{from:?}, {to:?}]
        elements = {elements}
        section = {{ mass = {:e}, ea = {ea:e}, diameter = {D} }}
        [[constraints]]
        type = "spherical"
        name = "anchor"
        marker = "line.start"
        [[forces]]
        type = "gravity"
        [[forces]]
        type = "bed"
        slope = {slope}
        stiffness = {stiffness:e}
        friction = {{ mu = {mu}, equilibrium = "{equilibrium}" }}
        [[forces]]
        type = "point_force"
        marker = "line.end"
        force = [{}, 0, {}]
        time = {{ table = {{ t = [0, 1, 2], value = {course:?} }} }}
        [[records]]
        type = "position"
        of = "line.end"
        [[records]]
        type = "reaction"
        of = "anchor"
        what = "magnitude"
        "#,
        weight / G,
        force[0],
        force[1],
    )
}

#[test]
fn a_line_dragged_along_its_bed_stretches_and_lets_go_as_the_closed_form() {
    for case in reference(include_str!("../data/sea/grounded_friction.json")) {
        if number(&case["bed_slope_deg"]) != 0.0 {
            // it lies there, and a little of the load holds it straight, or it was pulled before
            let laid = run(&dragged(&case, 60, "laid", [0.002, 1.0, 1.0]));
            let pulled = run(&dragged(&case, 60, "pulled", [1.0; 3]));
            let slope = number(&case["bed_slope_deg"]).to_radians();
            for (how, h) in [("laid", laid), ("pulled", pulled)] {
                let [x, z] = ["x", "z"].map(|k| last(&h, &format!("line.end.{k}")));
                let moved = x * slope.cos() + z * slope.sin() - number(&case["section"]["L"]);
                let (right, anchor) = (number(&case["end_displacement"]), last(&h, "anchor.magnitude"));
                println!("{}, {how}: {moved} instead of {right}, anchor {anchor} N", case["name"]);
                assert!((moved / right - 1.0).abs() < 0.01 && anchor < 0.01 * number(&case["pull"]));
            }
            continue;
        }
        // the load rises to the pull and falls to half of it; a little of it holds the line straight before friction does
        let h = run(&dragged(&case, 40, "laid", [0.002, 1.0, 0.5]));
        let (t, x) = (h.times(), h.column("line.end.x").expect("column"));
        let moved = |at: f64| {
            let k = t.iter().position(|t| (t - at).abs() < 1e-9).expect("row");
            x[k] - x[0]
        };
        let right = number(&case["end_displacement"]);
        println!("{}: {} instead of {right}", case["name"], moved(1.0));
        assert!((moved(1.0) / right - 1.0).abs() < 0.01);
        for back in case["unload_to"].as_array().into_iter().flatten() {
            let share = number(&back["pull"]) / number(&case["pull"]);
            let (found, right) = (moved(3.0 - 2.0 * share), number(&back["end_displacement"]));
            println!("{} back to {share}: {found} instead of {right}", case["name"]);
            assert!((found / right - 1.0).abs() < 0.01);
        }
    }
}

/// A line with bending stiffness between two points, floats in its middle or not, begun straight.
fn bent(case: &Value, elements: usize) -> String {
    let (mut sections, mut s) = (String::new(), 0.0);
    for q in case["sections"].as_array().expect("sections") {
        let [length, weight, ea, ei, d] = ["L", "w", "EA", "EI", "D"].map(|f| number(&q[f]));
        s += length;
        let mass = weight / G + 1025.0 * std::f64::consts::FRAC_PI_4 * d * d;
        let _ = writeln!(
            sections,
            "{{ to = {s}, elements = {elements}, section = {{ mass = {mass:e}, ea = {ea:e}, ei = {ei:e}, diameter = {d} }} }},"
        );
    }
    let upper = match case["upper"].as_str() {
        Some("clamped") => {
            let (sin, cos) = number(&case["upper_angle_deg"]).to_radians().sin_cos();
            format!("type = \"clamp\"\ndirection = [{cos}, 0, {sin}]")
        }
        _ => "type = \"spherical\"".to_string(),
    };
    let bed = match case["bed"].as_bool() {
        Some(true) => "[[forces]]\ntype = \"bed\"\npoint = [0, 0, -0.08]\nstiffness = 1e8\n",
        _ => "",
    };
    let [x, z] = [0, 1].map(|i| number(&case["end"][i]));
    let current = number(&case["current"]);
    let drag = if current == 0.0 { "" } else { "[[forces]]\ntype = \"drag\"\ncn = 1.2\nct = 0.1\n" };
    format!(
        r#"
        run = {{ analysis = "statics" }}
        statics = {{ steps = 1 }}
        water = {{ density = 1025, current = [{current}, 0, 0] }}
        [[elements]]
        type = "cable"
        name = "line"
        points = [[0, 0, 0], [{x}, 0, {z}]]
        sections = [
        {sections}]
        [[constraints]]
        type = "spherical"
        name = "lower"
        marker = "line.start"
        [[constraints]]
        name = "upper"
        marker = "line.end"
        {upper}
        [[forces]]
        type = "gravity"
        [[forces]]
        type = "buoyancy"
        {drag}{bed}
        [[records]]
        type = "reaction"
        of = "upper"
        "#
    )
}

#[test]
fn bent_lines_find_their_waves_from_two_end_points() {
    for case in reference(include_str!("../data/sea/bending_statics.json")) {
        let (of, result) = (&case["case"], &case["result"]);
        // the clamped end has a layer that these elements don't resolve
        let limit = if of["upper"].as_str() == Some("clamped") { 6e-4 } else { 1e-5 };
        let mut scene = bent(of, 40);
        let bends = result["extrema"].as_array().expect("extrema");
        for (k, at) in bends.iter().enumerate() {
            let s = number(&at["s"]);
            let _ = writeln!(
                scene,
                "[[records]]\ntype = \"along\"\nof = \"line\"\nwhat = \"curvature\"\nat = {s}\nname = \"k{k}\"\n\
                 [[records]]\ntype = \"position\"\nof = \"line@{s}m\"\nname = \"p{k}\""
            );
        }
        let h = run(&scene);
        let [sideways, up] = ["H", "V"].map(|f| number(&result["upper"][f]));
        let size = sideways.hypot(up);
        let off = (last(&h, "upper.fx").abs() - sideways.abs()).hypot(last(&h, "upper.fz") - up) / size;
        println!("{}: pull off by {off:.1e}", of["name"]);
        assert!(off < limit, "{}", of["name"]);
        for (k, at) in bends.iter().enumerate() {
            let (found, right) = (last(&h, &format!("k{k}")), number(&at["curvature"]).abs());
            let [x, z] = ["x", "z"].map(|c| last(&h, &format!("p{k}.{c}")) - number(&at[c]));
            println!("  curvature {found:.5} instead of {right:.5}, place off by {:.1e} m", x.hypot(z));
            assert!((found / right - 1.0).abs() < 0.01 && x.hypot(z) < 0.015, "{}", of["name"]);
        }
    }
}

/// Waves feel the bed that lines lie on, and a grid reaches as far as they do: else it is told.
#[test]
fn beds_where_no_wave_feels_them_and_grids_that_end_too_soon_are_told() {
    let text = |bed: &str, depth: f64| {
        format!(
            r#"
            run = {{ duration = 0.1, output = 0.1 }}
            [water]
            level = 0
            waves = {{ regular = {{ height = 1, period = 6 }}, depth = {depth}, ramp = 10 }}
            [[elements]]
            type = "cable"
            name = "line"
            points = [[0, 0, -29.951], [6, 0, -29.951]]
            elements = 6
            section = {{ mass = 10, ea = 1e6, diameter = 0.1, axial_retardation_time = 0.01 }}
            [[forces]]
            type = "gravity"
            [[forces]]
            type = "buoyancy"
            [[forces]]
            type = "bed"
            stiffness = 1e5
            {bed}
            "#
        )
    };
    let told =
        |bed: &str, depth: f64, what: &str| run(&text(bed, depth)).warnings.iter().any(|w| w.contains(what));
    let level = "point = [0, 0, -30]";
    let elsewhere = "`bed` lies 30 m under the surface, and waves are those of water 45 m deep";
    assert!(told(level, 45.0, elsewhere) && !told(level, 31.0, "waves are those of water"));
    let grid = |x: f64| format!("grid = {{ x = [-10, {x}], y = [-10, 10], z = [[-30, -30], [-30, -30]] }}");
    // the middle of the last element lies at 5.5 m
    let beyond = "beyond the borders of the grid";
    assert!(told(&grid(3.0), 30.0, "up to 2.5") && told(&grid(3.0), 30.0, beyond));
    assert!(!told(&grid(10.0), 30.0, beyond));
}

/// A line of 158 m between an anchor on a bed that slopes and a fairlead 150 m away and 50 m above the anchor.
fn on_slope(slope: f64, ratio: f64) -> Value {
    serde_json::json!({
        "sections": [{ "L": ratio * f64::hypot(150.0, 50.0), "w": 100.0, "EA": 5e8 }],
        "load_after_section": [],
        "bed_slope_deg": slope.to_degrees(),
        "fairlead": [150.0, 50.0],
        "mu": 0.5,
    })
}

/// Tension of such a line at its fairlead and where it leaves the bed, without stretch: a straight line along the bed, and a
/// catenary that begins as steep.
fn catenary_from_slope(case: &Value) -> [f64; 2] {
    let (length, weight) = (number(&case["sections"][0]["L"]), number(&case["sections"][0]["w"]));
    let slope = number(&case["bed_slope_deg"]).to_radians();
    let [x, z] = [0, 1].map(|i| number(&case["fairlead"][i]));
    let root = |mut low: f64, mut high: f64, above: &dyn Fn(f64) -> bool| {
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            if above(middle) { high = middle } else { low = middle }
        }
        0.5 * (low + high)
    };
    let ends = |h: f64, lies: f64| {
        let [from, to] = [h * slope.tan(), h * slope.tan() + weight * (length - lies)];
        let ahead = h / weight * ((to / h).asinh() - (from / h).asinh());
        [lies * slope.cos() + ahead, lies * slope.sin() + (to.hypot(h) - from.hypot(h)) / weight, to]
    };
    let lies = |h: f64| root(0.0, length, &|lies| ends(h, lies)[1] < z);
    let h = root(1e-3 * weight, 1e4 * weight, &|h| ends(h, lies(h))[0] > x);
    [h.hypot(ends(h, lies(h))[2]), h / slope.cos()]
}

/// On a slope a slack line slides down and folds below its anchor where nothing holds it. Laid there it keeps the tension with
/// which it leaves the bed, and pulled before it has lost what lies and what friction takes.
#[test]
fn slack_lines_on_slopes_are_found_where_friction_holds_them() {
    for (slope, ratio) in [(-0.2, 1.05), (-0.1, 1.1), (0.05, 1.1), (0.1, 1.05), (0.15, 1.1), (0.2, 1.05)] {
        let case = on_slope(slope, ratio);
        let [top, leaves] = catenary_from_slope(&case);
        for equilibrium in ["laid", "pulled"] {
            let h = run(&line(&case, 60, 1e6, equilibrium));
            let [fairlead, anchor] = ["fairlead.magnitude", "anchor.magnitude"].map(|n| last(&h, n));
            println!(
                "{slope} {ratio} {equilibrium}: {fairlead:.0} N instead of {top:.0}, anchor {anchor:.0} of {leaves:.0}"
            );
            assert!((fairlead / top - 1.0).abs() < 5e-3, "{slope} {ratio} {equilibrium}");
            match equilibrium {
                "laid" => assert!((anchor - leaves).abs() < 5e-3 * top, "{slope} {ratio}"),
                _ => assert!(anchor < leaves, "{slope} {ratio}"),
            }
        }
    }
}

/// The message of an equilibrium that isn't found.
fn error(text: &str) -> String {
    let file = SceneFile::parse(text, "bed", Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}"));
    simulate(&file.into_scene()).err().expect("must fail").to_string()
}

#[test]
fn what_friction_had_to_do_with_an_equilibrium_that_is_not_found_is_told() {
    // nothing holds it but friction
    let case = on_slope(0.15, 1.0);
    let free = |equilibrium: &str| {
        let text = line(&case, 20, 1e6, equilibrium);
        let (from, to) =
            (text.find("[[constraints]]").expect("text"), text.find("[[forces]]").expect("text"));
        let records = text.find("[[records]]").expect("text");
        let lies = [0.0, f64::hypot(150.0, 50.0)].map(|s| [s * f64::cos(0.15), 0.0, s * f64::sin(0.15)]);
        let text = format!("{}{}", &text[..from], &text[to..records]);
        let points = text.find("points").expect("text");
        let end = points + text[points..].find('\n').expect("text");
        format!(
            "{}points = {lies:?}{}",
            &text[..points],
            &text[end..].replace("ea = 5e8", "ea = 5e8, ei = 1e4")
        )
    };
    let e = error(&free("none"));
    assert!(e.contains("without the friction of `bed`"), "{e}");
    let h = run(&free("laid"));
    assert!(h.warnings.is_empty(), "nothing moves freely that friction holds: {:?}", h.warnings);
    // longer than the way down and along the bed, so that nothing pulls it
    let text = line(&on_slope(0.15, 1.2), 20, 1e6, "pulled").replace("ea = 5e8", "ea = 5e7, ei = 1e4");
    let e = error(&text);
    assert!(e.contains("now that friction has taken hold") && e.contains("`laid`"), "{e}");
    let fairlead = last(&run(&text.replace("pulled", "laid")), "fairlead.magnitude");
    let hangs = 100.0 * (50.0 - 150.0 * f64::tan(0.15));
    assert!((fairlead / hangs - 1.0).abs() < 0.03, "{fairlead} N instead of {hangs}");
}

/// A line that hardly stretches, pulled over ground that rises and falls: what friction has taken hold of has no linear motion that could
/// tell whether it is stable, and that is said. The line is found all the same: a hundred times softer it pulls by a thousandth less.
#[test]
fn a_stiff_line_pulled_over_uneven_ground_is_found_and_its_stability_said_to_be_unknown() {
    let pulled = |ea: f64, elements: usize| {
        run(&format!(
            r#"
            run = {{ analysis = "statics" }}
            [[elements]]
            type = "cable"
            name = "line"
            points = [[0, 0, 0], [150, 0, 50]]
            length = 166.02
            elements = {elements}
            section = {{ mass = 10.19368, ea = {ea:e}, diameter = 0.1, displaced = 0 }}
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
            stiffness = 1e6
            friction = {{ mu = 0.3, equilibrium = "pulled" }}
            [forces.grid]
            x = [-50, 0, 50, 100, 150, 200]
            y = [-50, 50]
            z = [[-2, -2], [-0.05, -0.05], [5, 5], [14, 14], [20, 20], [30, 30]]
            [[records]]
            type = "reaction"
            of = "fairlead"
            what = "magnitude"
            "#
        ))
    };
    let (soft, stiff) = (pulled(5e7, 30), pulled(5e9, 60));
    let [soft_force, stiff_force] = [&soft, &stiff].map(|h| last(h, "fairlead.magnitude"));
    assert!((stiff_force / soft_force - 1.0).abs() < 2e-3, "{soft_force} N and {stiff_force} N");
    assert!(soft.warnings.is_empty(), "{:?}", soft.warnings);
    let doubt = "whether it is stable can't be told by linear motions, now that friction has taken hold";
    assert!(stiff.warnings.iter().any(|w| w.contains(doubt)), "{:?}", stiff.warnings);
}

/// What begins above a slope comes to lie below where it began, whichever way is down: ground that bears pushes straight up, to
/// rounding of a force that is a million times its weight where a fall that nothing stops at first has gone deep.
#[test]
fn a_stone_comes_to_lie_below_where_it_began_and_stays() {
    let slope: f64 = 0.3;
    let (sin, cos) = slope.sin_cos();
    let bed = format!("type = \"bed\"\nslope = {slope}");
    let contact = format!(
        "type = \"contact\"\nname = \"bed\"\nshape = {{ plane = {{ normal = [{}, 0, {cos}] }} }}",
        -sin
    );
    for (on, aside) in [(&bed, 0.0), (&contact, 0.0), (&bed, 0.4), (&contact, 0.4)] {
        let down = [9.81 * f64::sin(aside) * 0.8, -9.81 * f64::sin(aside) * 0.6, -9.81 * f64::cos(aside)];
        let h = run(&format!(
            r#"
            run = {{ duration = 5, from_equilibrium = true }}
            gravity = {down:?}
            [[elements]]
            type = "point_mass"
            name = "stone"
            mass = 10
            marker = [0, 0, 0.3]
            [[forces]]
            type = "gravity"
            [[forces]]
            {on}
            stiffness = 1e6
            radius = 0.1
            friction = {{ mu = 1, equilibrium = "laid" }}
            [[records]]
            type = "position"
            of = "stone"
            "#
        ));
        let x = ["x", "y", "z"].map(|k| last(&h, &format!("stone.{k}")));
        // down from where it began until it lies a radius above the slope
        let falls = (0.3 * cos - 0.1) / (sin * down[0] - cos * down[2]);
        let right = [down[0] * falls, down[1] * falls, 0.3 + down[2] * falls];
        println!("{aside}: {x:?} m instead of {right:?} m");
        assert!((0..3).all(|i| (x[i] - right[i]).abs() < 5e-3), "{x:?}");
        for k in ["x", "y", "z"] {
            let all = h.column(&format!("stone.{k}")).expect("column");
            assert!(all.iter().all(|x| (x - all[0]).abs() < 1e-9), "it moves on");
        }
    }
}

#[test]
fn what_sits_on_a_line_without_a_size_leaves_the_bed_to_it() {
    let moored = |on: &str| {
        run(&format!(
            r#"
            run = {{ analysis = "statics" }}
            water = {{}}
            [[elements]]
            type = "cable"
            name = "line"
            points = [[0, 0, -60], [180, 0, -60], [300, 0, 0]]
            radius = 20
            length = 315
            elements = 40
            section = {{ mass = 50, ea = 2e8, diameter = 0.09 }}
            [[elements]]
            type = "attachments"
            name = "floats"
            on = "line"
            at = 200
            spacing = 5
            count = 4
            mass = 50
            volume = 0.3
            [[elements]]
            type = "point_mass"
            name = "clump"
            marker = "line@50%"
            mass = 300
            [[constraints]]
            type = "spherical"
            name = "a"
            marker = "line.start"
            [[constraints]]
            type = "spherical"
            name = "b"
            marker = "line.end"
            [[forces]]
            type = "gravity"
            [[forces]]
            type = "buoyancy"
            [[forces]]
            type = "bed"
            point = [0, 0, -60.045]
            {on}
            [[records]]
            type = "touchdown"
            of = "line"
            on = "bed"
            "#
        ))
    };
    let (left_out, named) = (moored(""), moored(r#"on = ["line"]"#));
    let name = "line.touchdown.grounded";
    assert!(
        last(&named, name) > 100.0 && last(&named, name) == last(&left_out, name),
        "{}",
        last(&named, name)
    );
}
