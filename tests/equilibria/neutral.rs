//! Directions in which nothing holds a model: named, and no obstacle.

use crate::paths::{run, tip};

/// A bar on a hinge in a turning frame: its azimuth is free.
const HINGED: &str = r#"
[run]
analysis = "statics"
frame = { omega = [0, 0, 6] }
[[elements]]
type = "cable"
name = "bar"
points = [[0, 0, 0], [10, 0, 0]]
elements = 16
section = { mass = 1.2, ea = 2.8e7, ei = 1.4e4 }
[[constraints]]
type = "spherical"
name = "hinge"
marker = "bar.start"
[[records]]
type = "position"
of = "bar.end"
"#;

#[test]
fn a_free_azimuth_is_named_and_no_obstacle() {
    let h = run(HINGED, &[]).unwrap_or_else(|e| panic!("{e}"));
    println!("{:?}", h.warnings);
    // stretched by its own centrifugal force: ε(s) = m ω² (L² - s²)/2 EA, to first order
    let [x, y, z] = tip(&h, "bar");
    let stretch = 1.2 * 36.0 * 1e3 / 3.0 / 2.8e7;
    assert!((x.hypot(y) - 10.0 - stretch).abs() < 1e-2 * stretch && z.abs() < 1e-9, "{x} {y} {z}");
    assert_eq!(h.warnings.len(), 1, "{:?}", h.warnings);
    assert!(
        h.warnings[0].contains("`bar` turns about the axis (0, 0, 1) through (0, 0, 0) m"),
        "{:?}",
        h.warnings
    );
}

/// Two cables joined by a small body that may spin about them.
const SPINNING: &str = r#"
[run]
analysis = "statics"
[[elements]]
type = "cable"
name = "a"
points = [[0, 0, 0], [1, 0, 0]]
elements = 8
section = { mass = 1, ea = 1e5, ei = 10 }
[[elements]]
type = "cable"
name = "b"
points = [[1, 0, 0], [2, 0, 0]]
elements = 8
section = { mass = 1, ea = 1e5, ei = 10 }
[[elements]]
type = "rigid_body"
name = "j"
position = [1, 0, 0]
mass = 1e-6
inertia = [1e-9, 1e-9, 1e-9]
[[constraints]]
type = "spherical"
name = "p"
marker = "a.start"
[[constraints]]
type = "direction"
name = "c"
marker = "a.start"
[[constraints]]
type = "weld"
name = "k1"
marker = "a.end"
to = "j"
[[constraints]]
type = "weld"
name = "k3"
marker = "b.start"
to = "j"
[[forces]]
type = "gravity"
[[records]]
type = "position"
of = "b.end"
"#;

#[test]
fn a_free_spin_is_named_and_no_obstacle() {
    let h = run(SPINNING, &[]).unwrap_or_else(|e| panic!("{e}"));
    println!("{:?} {:?}", tip(&h, "b"), h.warnings);
    assert_eq!(h.warnings.len(), 1, "{:?}", h.warnings);
    assert!(h.warnings[0].contains("`j` turns about the axis"), "{:?}", h.warnings);
    // without the body between them: one cable of 2 m
    let one = SPINNING.split("[[elements]]").collect::<Vec<_>>();
    let constraints = one[3].split("[[constraints]]").collect::<Vec<_>>();
    let whole = one[1].replace("[1, 0, 0]]", "[2, 0, 0]]").replace("elements = 8", "elements = 16");
    let scene = format!(
        "{}[[elements]]{whole}[[constraints]]{}[[constraints]]{}[[forces]]\ntype = \"gravity\"\n[[records]]\ntype = \"position\"\nof = \"a.end\"\n",
        one[0], constraints[1], constraints[2]
    );
    let other = run(&scene, &[]).unwrap_or_else(|e| panic!("{e}"));
    let (joined, whole) = (tip(&h, "b"), tip(&other, "a"));
    let off = (0..3).map(|i| (joined[i] - whole[i]).powi(2)).sum::<f64>().sqrt();
    assert!(off < 1e-3, "{joined:?} {whole:?}");
}
