//! What belongs to the whole scene is there once, and masses are where they were put.

use ropewalk::scene::Format;
use ropewalk::{History, SceneFile, simulate};

fn run(text: &str) -> History {
    let file = SceneFile::parse(text, "world", Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}"));
    simulate(file.scene()).unwrap_or_else(|e| panic!("{e}"))
}

#[track_caller]
fn refused(text: &str) -> String {
    match SceneFile::parse(text, "world", Format::Toml, &[]) {
        Err(e) => e.to_string(),
        Ok(file) => match file.build() {
            Ok(_) => panic!("was accepted"),
            Err(e) => e.to_string(),
        },
    }
}

/// A rod that swings about an axis at an angle, with a mass at its side.
fn rod(body: &str, more: &str) -> History {
    run(&format!(
        r#"
        [run]
        duration = "1 s"
        output = "0.1 s"
        [solver]
        scheme = "radau-iia-5"
        stepping = {{ controlled = {{ tolerance = 1e-9 }} }}
        [[elements]]
        type = "rigid_body"
        name = "rod"
        position = [0, 0, 0]
        {body}
        points = {{ end = [1, 0, 0], side = [0.8, 0.3, -0.2] }}
        {more}
        [[constraints]]
        type = "spherical"
        name = "pivot"
        marker = "rod"
        to = [0, 0, 0]
        [[forces]]
        type = "gravity"
        [[records]]
        type = "position"
        of = "rod.end"
        [[records]]
        type = "reaction"
        of = "pivot"
        "#
    ))
}

/// A mass at a point of a body is the same as a body that has it built in: with the inertia about the common centre.
#[test]
fn a_mass_on_a_body_is_where_it_was_put() {
    let (rod_mass, mass) = (1.0, 5.0);
    let (own, place) = ([0.5, 0.0, 0.0], [0.8, 0.3, -0.2]);
    let inertia = [1e-3, 0.08333, 0.08333];
    let apart = rod(
        "mass = 1\ninertia = [1e-3, 0.08333, 0.08333]\ncentre = [0.5, 0, 0]",
        "[[elements]]\ntype = \"point_mass\"\nname = \"lump\"\nmarker = \"rod.side\"\nmass = 5\n",
    );
    let total = rod_mass + mass;
    let centre: [f64; 3] = std::array::from_fn(|i| (rod_mass * own[i] + mass * place[i]) / total);
    let mut j = [[0.0; 3]; 3];
    for (m, at) in [(rod_mass, own), (mass, place)] {
        let d: [f64; 3] = std::array::from_fn(|i| at[i] - centre[i]);
        let square: f64 = d.iter().map(|x| x * x).sum();
        for i in 0..3 {
            for k in 0..3 {
                j[i][k] += m * (if i == k { square } else { 0.0 } - d[i] * d[k]);
            }
        }
    }
    (0..3).for_each(|i| j[i][i] += inertia[i]);
    let together = rod(
        &format!(
            "mass = {total}\ninertia = [{}, {}, {}]\nproducts = [{}, {}, {}]\ncentre = {centre:?}",
            j[0][0], j[1][1], j[2][2], j[0][1], j[0][2], j[1][2]
        ),
        "",
    );
    for (column, size) in
        [("rod.end.x", 1.0), ("rod.end.y", 1.0), ("rod.end.z", 1.0), ("pivot.magnitude", 60.0)]
    {
        let (a, b) = (apart.column(column).expect(column), together.column(column).expect(column));
        for (a, b) in a.iter().zip(b) {
            assert!((a - b).abs() < 1e-6 * size, "{column}: {a} instead of {b}");
        }
    }
}

#[test]
fn gravity_counts_once_and_is_one() {
    let ball = r#"
        [water]
        [[elements]]
        type = "point_mass"
        name = "ball"
        marker = [0, 0, 0]
        mass = 1
        volume = 1e-3
        [[forces]]
        type = "gravity"
        "#;
    for kind in ["gravity", "buoyancy"] {
        let twice = refused(&format!("{ball}{}", format!("\n[[forces]]\ntype = \"{kind}\"\n").repeat(2)));
        assert!(twice.contains(&format!("`{kind}` acts on `ball` twice")), "{twice}");
    }
    let cable = r#"
        [water]
        [[elements]]
        type = "cable"
        name = "rope"
        points = [[0, 0, 0], [1, 0, 0]]
        elements = 2
        section = { mass = 1, ea = 1e4, diameter = 0.1 }
        "#;
    let twice = refused(&format!("{cable}{}", "[[forces]]\ntype = \"drag\"\n".repeat(2)));
    assert!(twice.contains("`drag` acts on `rope` twice"), "{twice}");
    // where older scenes had it
    for kind in ["gravity", "buoyancy"] {
        let old = format!(
            "[[elements]]\ntype = \"point_mass\"\nname = \"b\"\nmarker = [0, 0, 0]\nmass = 1\n[[forces]]\ntype = \"{kind}\"\ng = [0, 0, -1.62]\n"
        );
        let moved = refused(&old);
        assert!(moved.contains("gravity belongs to the scene"), "{moved}");
        assert!(moved.contains("`ropewalk migrate world` rewrites the scene"), "{moved}");
        assert!(moved.contains("world:8:1"), "{moved}");
    }
    // one for each part is fine
    let apart = format!("{ball}\non = [\"ball\"]\n[[forces]]\ntype = \"buoyancy\"\n");
    SceneFile::parse(&apart, "world", Format::Toml, &[]).unwrap().build().unwrap_or_else(|e| panic!("{e}"));
}
