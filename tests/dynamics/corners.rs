//! Cables laid round corners and along curves: free of strain from the start, or refused where they would not be.

use ropewalk::SceneFile;
use ropewalk::scene::Format;
use ropewalk_core::{Model, dot};

/// An L of 100 m laid at rest, with what its cable says besides.
fn laid(points: &str, more: &str) -> Result<Model, ropewalk::scene::Fault> {
    let text = format!(
        "[[elements]]\ntype = \"cable\"\nname = \"c\"\n{points}\nelements = 50\n{more}\n\
         section = {{ mass = 1.0, ea = 5e6, ei = 10.0, diameter = 0.025 }}\n"
    );
    SceneFile::parse(&text, "laid", Format::Toml, &[])?.build()
}

const CORNER: &str = "points = [[0, 0, 0], [50, 0, 0], [50, 0, -50]]";
const EA: f64 = 5e6;

/// The largest tension [N] and the energy [J] with which a cable starts.
fn strained(model: &Model) -> (f64, f64) {
    let state = model.state();
    let part = model.part("c").expect("the cable");
    let at = state.at();
    let length = part.length();
    let tension = (1..200).map(|k| {
        let s = length * f64::from(k) / 200.0;
        part.observe(ropewalk_core::Quantity::Tension, s, &at).expect("tension").abs()
    });
    (tension.fold(0.0, f64::max), model.energy(&at).potential)
}

#[test]
fn a_sharp_corner_is_refused_with_its_place_and_what_to_do() {
    let fault = laid(CORNER, "").err().expect("a corner");
    let said = fault.to_string();
    for words in ["90 degrees", "(50, 0, 0) m", "50 m along it", "`radius`", "`curve`", "as-laid"] {
        assert!(said.contains(words), "no {words}: {said}");
    }
    assert_eq!(fault.place.map(|p| p.line), Some(4));
    // a polygon that is hardly bent, and what is free of stress as it is laid, may have corners
    assert!(laid("points = [[0, 0, 0], [50, 0, 0], [100, 0, -1]]", "").is_ok());
    assert!(laid(CORNER, "stress_free = \"as-laid\"").is_ok());
}

#[test]
fn a_corner_with_a_radius_starts_free_of_strain() {
    for radius in [0.5, 2.0, 20.0] {
        let model = laid(CORNER, &format!("radius = {radius}")).unwrap_or_else(|e| panic!("{e}"));
        let (tension, energy) = strained(&model);
        // what is left is the bending of the arc
        let bending = 0.5 * 10.0 * std::f64::consts::FRAC_PI_2 / radius;
        println!("radius {radius} m: {tension} N, {energy} J of which {bending} J in bending");
        assert!(tension < 1e-5 * EA, "{tension} N");
        assert!((energy - bending).abs() < 0.02 * bending + 1e-3, "{energy} J");
        let length = model.part("c").unwrap().length();
        let exact = 100.0 - 2.0 * radius + radius * std::f64::consts::FRAC_PI_2;
        assert!((length - exact).abs() < 1e-9, "{length} m");
    }
}

#[test]
fn radius_and_directions_are_refused_where_they_make_no_sense() {
    for (points, more, line, words) in [
        (CORNER, "radius = 60", 6, "take a smaller `radius`"),
        (CORNER, "radius = 0", 6, "`radius` must be positive"),
        (CORNER, "start_direction = [1, 0, 0]", 6, "lay it along a `curve`"),
        ("curve = [[0, 0, 0], [1, 0, 0]]", "radius = 1", 6, "no corners to round"),
        ("curve = [[0, 0, 0], [1, 0, 0]]", "end_direction = [0, 0, 0]", 6, "must have a length"),
        ("points = [[0, 0, 0], [5, 0, 0], [2, 0, 0]]", "radius = 1", 6, "take a smaller `radius`"),
    ] {
        let fault = laid(points, more).err().unwrap_or_else(|| panic!("{points} {more}"));
        assert!(fault.message.contains(words), "{fault}");
        assert_eq!(fault.place.as_ref().map(|p| p.line), Some(line), "{fault}");
    }
}

/// A quarter of a circle through nine points: its ends are as curved as its middle, and go where they are told to.
#[test]
fn a_curve_keeps_its_curvature_and_takes_directions_at_its_ends() {
    let points: Vec<String> = (0..=8)
        .map(|k| {
            let (sin, cos) = (std::f64::consts::FRAC_PI_2 * f64::from(k) / 8.0).sin_cos();
            format!("[{}, 0, {}]", 10.0 * sin, 10.0 * (1.0 - cos))
        })
        .collect();
    let curve = format!("curve = [{}]", points.join(", "));
    let curvature = |model: &Model, s: f64| {
        let state = model.state();
        let part = model.part("c").expect("the cable");
        part.observe(ropewalk_core::Quantity::Curvature, s, &state.at()).expect("curvature")
    };
    for more in ["", "start_direction = [2, 0, 0]\nend_direction = [0, 0, 1]"] {
        let model = laid(&curve, more).unwrap_or_else(|e| panic!("{e}"));
        for s in [0.0, 0.1, 7.0, 15.6] {
            let k = curvature(&model, s);
            assert!((k - 0.1).abs() < 4e-3, "{k} 1/m at {s} m with `{more}`");
        }
    }
    let model = laid(&curve, "start_direction = [1, 0, 1]").unwrap_or_else(|e| panic!("{e}"));
    let state = model.state();
    let slope = [state.q[3], state.q[4], state.q[5]];
    assert!((dot(&slope, &[0.5f64.sqrt(), 0.0, 0.5f64.sqrt()]) - 1.0).abs() < 1e-4, "{slope:?}");
}
