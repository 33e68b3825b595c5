//! Added mass along lines and hulls, and of bodies that are balls to the water.

use ropewalk::scene::Format;
use ropewalk::{History, SceneFile, simulate};
use std::f64::consts::PI;

fn parse(text: &str) -> SceneFile {
    SceneFile::parse(text, "all-round", Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}"))
}

fn run(text: &str) -> History {
    simulate(parse(text).scene()).unwrap_or_else(|e| panic!("{e}"))
}

fn refused(text: &str) -> String {
    match SceneFile::parse(text, "all-round", Format::Toml, &[]) {
        Err(e) => e.to_string(),
        Ok(file) => file.build().err().expect("is refused").to_string(),
    }
}

const SOLVER: &str = "[solver]\nscheme = \"radau-iia-5\"\nstepping = { controlled = { tolerance = 1e-9 } }";

/// A line that falls along itself falls as its mass with that of the water along it: `m g/(m + Ca_t ρ A)`, by either theory.
#[test]
fn a_line_falls_along_itself_with_the_water_along_it() {
    for theory in ["energy", "morison"] {
        let h = run(&format!(
            r#"
            run = {{ duration = 1, output = 0.5 }}
            {SOLVER}
            [water]
            density = 1000
            [[elements]]
            type = "cable"
            name = "line"
            points = [[0, 0, 0], [0, 0, -4]]
            elements = 3
            section = {{ mass = 2, ea = 1e6, diameter = 0.05 }}
            [[forces]]
            type = "gravity"
            [[forces]]
            type = "added_mass"
            ca = 1
            ca_axial = 0.4
            theory = "{theory}"
            [[records]]
            type = "position"
            of = "line.start"
            "#
        ));
        let heavy = 2.0 + 0.4 * 1000.0 * PI / 4.0 * 0.05 * 0.05;
        let wanted = -0.5 * 2.0 * 9.81 / heavy;
        let z = h.last("line.start.z").expect("z");
        assert!((z - wanted).abs() <= 1e-7 * wanted.abs(), "{theory}: {z} {wanted}");
    }
}

/// A hull turns as Kirchhoff's equations have it, with the matrix of the same added mass: Munk's moment goes by the difference of that
/// across and along.
#[test]
fn a_hull_moves_as_its_matrix_of_added_mass() {
    let (density, diameter, length, ca, along) = (1025.0, 0.2, 2.0, 1.0, 0.3);
    let per = density * PI / 4.0 * diameter * diameter;
    let (n, t) = (ca * per * length, along * per * length);
    let turn = ca * per * length * length * length / 12.0;
    let text = |hull: &str, force: &str| {
        format!(
            r#"
            run = {{ duration = 4, output = 0.5 }}
            {SOLVER}
            [water]
            density = {density}
            [[elements]]
            type = "rigid_body"
            name = "hull"
            position = [0, 0, 0]
            velocity = [0.98, 0.17, 0.1]
            mass = 64
            inertia = [0.32, 21.6, 21.6]
            {hull}
            [[forces]]
            {force}
            [[records]]
            type = "position"
            of = "hull"
            [[records]]
            type = "orientation"
            of = "hull"
            "#
        )
    };
    let stations = run(&text(
        &format!("hull = {{ from = [-1, 0, 0], to = [1, 0, 0], diameter = {diameter} }}"),
        &format!("type = \"added_mass\"\nca = {ca}\nca_axial = {along}"),
    ));
    let matrix = run(&text(
        "",
        &format!(
            "type = \"free_vessel\"\nname = \"float\"\nmarker = \"hull\"\nstiffness = [0, 0, 0, 0, 0, 0]\nadded_mass = [{t}, {n}, {n}, 0, {turn}, \
             {turn}]"
        ),
    ));
    for name in ["hull.x", "hull.y", "hull.z", "hull.phi2", "hull.phi3"] {
        let (a, b) = (stations.last(name).expect("a column"), matrix.last(name).expect("a column"));
        assert!((a - b).abs() <= 1e-6, "{name}: {a} {b}");
    }
    assert!(stations.last("hull.phi3").expect("a column").abs() > 0.5);
}

/// A ball as heavy as water, as a rigid body and as a point mass, goes with the waves as the water does.
#[test]
fn a_body_without_hull_is_a_ball_to_waves() {
    let text = |element: &str| {
        format!(
            r#"
            run = {{ duration = 12, output = 1 }}
            {SOLVER}
            [water]
            density = 1000
            level = 1
            [water.waves]
            components = [{{ amplitude = 0.8, period = 6 }}, {{ amplitude = 0.3, period = 4, phase = 1, direction = "50 deg" }}]
            depth = 30
            ramp = 6
            [[elements]]
            {element}
            [[forces]]
            type = "gravity"
            [[forces]]
            type = "buoyancy"
            [[records]]
            type = "position"
            of = "ball"
            "#
        )
    };
    let water = "volume = 0.02\nadded_mass = 10\ndrag_area = 0.05";
    let body = run(&text(&format!(
        "type = \"rigid_body\"\nname = \"ball\"\nposition = [0, 0, -3]\nmass = 20\ninertia = [0.1, 0.1, 0.1]\n{water}"
    )));
    let point = run(&text(&format!(
        "type = \"point_mass\"\nname = \"ball\"\nmarker = [0, 0, -3]\nmass = 20\n{water}"
    )));
    for name in ["ball.x", "ball.y", "ball.z"] {
        let columns = [&body, &point].map(|h| h.column(name).expect("a column").to_vec());
        for (a, b) in columns[0].iter().zip(&columns[1]) {
            assert!((a - b).abs() <= 1e-7, "{name}: {a} {b}");
        }
        assert!(columns[0].iter().any(|x| (x - columns[0][0]).abs() > 0.05), "{name} moves");
    }
}

#[test]
fn what_is_wrong_is_said() {
    let text = |body: &str, mass: &str| {
        format!(
            "[run]\nduration = 1\n[water]\n[[elements]]\ntype = \"rigid_body\"\nname = \"b\"\nposition = [0, 0, 0]\nmass = 1\ninertia = [1, 1, \
             1]\nhull = {{ from = [0, 0, 0], to = [1, 0, 0], diameter = 0.1 }}\n{body}\n[[forces]]\ntype = \"added_mass\"\n{mass}"
        )
    };
    for (body, mass, said) in [
        ("drag_area = 1", "", "the hull has drag and added mass of its own"),
        ("added_mass = 1", "", "the hull has drag and added mass of its own"),
        ("", "ca = 0.5\nca_axial = 0.6", "`ca_axial` must be between 0 and `ca`"),
        ("", "ca_axial = -0.1", "`ca_axial` must be between 0 and `ca`"),
    ] {
        let error = refused(&text(body, mass));
        assert!(error.contains(said), "{said}: {error}");
    }
}
